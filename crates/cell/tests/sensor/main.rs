//! Seam sensors: what a recording gives back, what a simulated laser sees, and what an EGM client can and cannot do.

#![allow(clippy::panic, clippy::unwrap_used, clippy::expect_used, reason = "a failing test says where")]

mod datagrams;
mod egm_client;
mod laser;
mod passes;
mod replay;

use seamline::geometry::{Pose, Vector3};
use seamline::path::Path;
use seamline::seam::{Instant, Offset, Reading, SeamSensor, Sensor};

/// SplitMix64.
struct Random(u64);

impl Random {
    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    fn below(&mut self, count: u64) -> u64 {
        self.bits() % count
    }

    fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * (self.bits() >> 11) as f64 / (1_u64 << 53) as f64
    }
}

fn torch(time: f64) -> Instant {
    Instant { time, s: 0.0, base_from_tcp: Pose::translation(1.0, -0.2, 0.3) }
}

/// What a sensor answers on a straight weld along x.
fn ask(sensor: &mut impl SeamSensor, torch: &Instant) -> Option<Reading> {
    sensor.poll(torch, &mounted(0.03), &line(0.3))
}

/// The wire points down.
fn at(x: f64) -> Pose {
    Pose::new(Vector3::new(x, 0.0, 0.0), Vector3::x() * std::f64::consts::PI)
}

fn line(length: f64) -> Path {
    Path::line(&at(0.0), &at(length))
}

fn mounted(look_ahead: f64) -> Sensor {
    Sensor {
        tcp_from_sensor: Sensor::mounting(&line(1.0).jet(0.0), look_ahead).expect("a frame"),
        range: Offset::repeat(0.01),
        rate: 100.0,
        latency: 0.01,
        age_max: 0.1,
        quality_min: 0.0,
    }
}
