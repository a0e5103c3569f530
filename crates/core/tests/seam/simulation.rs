//! A torch with a laser on a seam in space: written from the definitions, apart from the tracker.
//!
//! The seam is a curve S(σ) = P(σ) + y·c_y(σ) + z·c_z(σ) beside the taught path. The laser is a plane on the torch; what it reads is where
//! the seam crosses that plane, some time ago, with noise. The torch follows its command with a delay.

use std::collections::VecDeque;

use seamline::geometry::{Pose, Vector3};
use seamline::path::SeamFrame;
use seamline::seam::{
    LaneJet, Lost, Offset, Reading, SeamTracker, Sensor, Settings, TaughtPath, corrected, foot, speed_factor,
};

use crate::random::Random;

pub(crate) const PERIOD: f64 = 1e-3;
const MM: f64 = 1e-3;

/// Where the seam runs, and what else a laser sees there.
pub(crate) trait Seam {
    /// Offset of the seam from the taught path.
    fn offset(&self, s: f64) -> Offset;
    /// What stands on the joint: added to what the laser reads, but not to where the weld belongs.
    fn bump(&self, _s: f64) -> f64 {
        0.0
    }
    /// Whether there is a joint to be seen.
    fn visible(&self, _s: f64) -> bool {
        true
    }
    /// Gap of the joint, and the laser's quality.
    fn looks(&self, _s: f64) -> (Option<f64>, f64) {
        (None, 1.0)
    }
}

/// ±5 mm over 200 mm, laterally and in height, each with its own phase.
#[derive(Clone, Copy)]
pub(crate) struct Sine {
    pub(crate) phase: [f64; 2],
}

impl Sine {
    pub(crate) fn random(random: &mut Random) -> Self {
        Self {
            phase: [random.uniform(0.0, std::f64::consts::TAU), random.uniform(0.0, std::f64::consts::TAU)],
        }
    }
}

impl Seam for Sine {
    fn offset(&self, s: f64) -> Offset {
        let wave = |phase: f64| 5.0 * MM * (std::f64::consts::TAU * s / (200.0 * MM) + phase).sin();
        Offset::new(wave(self.phase[0]), wave(self.phase[1]))
    }
}

/// The laser's faults.
#[derive(Clone, Copy)]
pub(crate) struct Laser {
    pub(crate) look_ahead: f64,
    pub(crate) rate: f64,
    pub(crate) latency: f64,
    pub(crate) sigma: f64,
    pub(crate) spikes: f64,
    pub(crate) dropouts: f64,
}

impl Laser {
    /// SPEC 6.6.
    pub(crate) const USUAL: Self = Self {
        look_ahead: 30.0 * MM,
        rate: 100.0,
        latency: 10e-3,
        sigma: 0.05 * MM,
        spikes: 0.01,
        dropouts: 0.02,
    };
}

/// What a run came to, or the worst of several. Errors are those of the torch itself, across the path.
#[derive(Clone, Default)]
pub(crate) struct Figures {
    /// Of this run so far: samples, and the sums of the squares laterally and in height.
    samples: f64,
    squares: [f64; 2],
    /// The worse direction's RMS.
    rms: f64,
    /// The worse direction's maximum.
    max: f64,
    /// Greatest deviation of the speed along the tracked seam, relative.
    pub(crate) speed: f64,
    /// Greatest third difference of the commanded positions over the cube of the period.
    pub(crate) jerk: f64,
}

impl Figures {
    pub(crate) fn rms_mm(&self) -> f64 {
        self.rms / MM
    }

    pub(crate) fn max_mm(&self) -> f64 {
        self.max / MM
    }

    fn add(&mut self, error: Offset) {
        self.samples += 1.0;
        for axis in 0..2 {
            self.squares[axis] += error[axis] * error[axis];
        }
        self.rms = (self.squares[0].max(self.squares[1]) / self.samples).sqrt();
        self.max = self.max.max(error.amax());
    }

    pub(crate) fn keep_worst(&mut self, other: &Self) {
        for (mine, its) in [
            (&mut self.rms, other.rms),
            (&mut self.max, other.max),
            (&mut self.speed, other.speed),
            (&mut self.jerk, other.jerk),
        ] {
            *mine = mine.max(its);
        }
    }
}

impl std::fmt::Display for Figures {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(
            f,
            "RMS {:.4} mm, max {:.3} mm, speed off {:.5} %, jerk {:.0} mm/s3",
            self.rms_mm(),
            self.max_mm(),
            100.0 * self.speed,
            self.jerk / MM
        )
    }
}

pub(crate) struct World<'a, P, S> {
    pub(crate) path: &'a P,
    pub(crate) seam: &'a S,
    pub(crate) laser: Laser,
    pub(crate) sensor: Sensor,
    pub(crate) random: Random,
    /// Cycles by which the torch is behind its command.
    pub(crate) delay: usize,
    in_flight: VecDeque<(f64, Reading)>,
    next_exposure: f64,
    /// Where the torch was when the seam was first lost, and what was seen by then.
    pub(crate) lost: Option<(f64, Lost)>,
    /// All that the tracker was told.
    pub(crate) cycles: Vec<Cycle>,
    /// Where the torch went: path coordinate and offset.
    pub(crate) track: Vec<(f64, Offset)>,
}

/// What the tracker is told in one cycle.
pub(crate) struct Cycle {
    pub(crate) time: f64,
    pub(crate) s: f64,
    pub(crate) measured: Pose,
    pub(crate) arrived: Vec<Reading>,
}

/// The sensor of a laser that sits on the torch as it is posed at the path's start.
pub(crate) fn sensor(path: &impl TaughtPath, laser: &Laser) -> Sensor {
    Sensor {
        tcp_from_sensor: Sensor::mounting(&path.jet(path.span().0), laser.look_ahead).expect("a frame"),
        range: Offset::new(20.0 * MM, 20.0 * MM),
        rate: laser.rate,
        latency: laser.latency,
        age_max: 0.1,
        quality_min: 0.3,
    }
}

impl<'a, P: TaughtPath, S: Seam> World<'a, P, S> {
    pub(crate) fn new(path: &'a P, seam: &'a S, laser: Laser, seed: u64) -> Self {
        let sensor = sensor(path, &laser);
        let mut random = Random(seed);
        let next_exposure = random.uniform(0.0, 1.0 / laser.rate);
        Self {
            path,
            seam,
            laser,
            sensor,
            random,
            delay: 8,
            in_flight: VecDeque::new(),
            next_exposure,
            lost: None,
            cycles: Vec::new(),
            track: Vec::new(),
        }
    }

    fn seam_point(&self, s: f64, seen: bool) -> Vector3 {
        let jet = self.path.jet(s);
        let frame = SeamFrame::of(&jet).expect("a frame");
        let offset = self.seam.offset(s);
        let bump = if seen { self.seam.bump(s) } else { 0.0 };
        jet.pose.translation.vector + frame.y * offset.x + frame.z * (offset.y + bump)
    }

    /// Where the laser's plane cuts the seam: path coordinate, and the point in the sensor's frame.
    fn cut(&self, base_from_tcp: &Pose, near: f64) -> Option<(f64, Vector3)> {
        let sensor_from_base = (base_from_tcp * self.sensor.tcp_from_sensor).inverse();
        let seen = |s: f64| (sensor_from_base * nalgebra::Point3::from(self.seam_point(s, true))).coords;
        let (first, last) = self.path.span();
        let (mut low, mut high) = ((near - 15.0 * MM).max(first), (near + 15.0 * MM).min(last));
        if low >= high || seen(low).x > 0.0 || seen(high).x < 0.0 {
            return None;
        }
        for _ in 0..40 {
            let middle = 0.5 * (low + high);
            *(if seen(middle).x < 0.0 { &mut low } else { &mut high }) = middle;
        }
        Some((low, seen(low)))
    }

    /// Exposes where it is time; gives back what arrives by `time`.
    pub(crate) fn readings(&mut self, time: f64, s: f64, base_from_tcp: &Pose) -> Vec<Reading> {
        if time >= self.next_exposure {
            let exposure = time;
            self.next_exposure += 1.0 / self.laser.rate;
            let dropped = self.random.chance(self.laser.dropouts);
            let spike = self.random.chance(self.laser.spikes);
            let noise = [self.random.normal(self.laser.sigma), self.random.normal(self.laser.sigma)];
            let jump = [5.0 * MM * self.random.sign(), 5.0 * MM * self.random.sign()];
            let cut = self.cut(base_from_tcp, s + self.laser.look_ahead);
            if let Some((at, point)) = cut.filter(|(at, _)| !dropped && self.seam.visible(*at)) {
                let add = |k: usize| noise[k] + if spike { jump[k] } else { 0.0 };
                let (gap, quality) = self.seam.looks(at);
                let reading =
                    Reading { lateral: point.y + add(0), height: point.z + add(1), gap, exposure, quality };
                self.in_flight.push_back((exposure + self.laser.latency, reading));
            }
        }
        let mut arrived = Vec::new();
        while self.in_flight.front().is_some_and(|(at, _)| *at <= time + 1e-9) {
            arrived.extend(self.in_flight.pop_front().map(|(_, reading)| reading));
        }
        arrived
    }

    /// Runs the weld at the settings' speed from one end to the other; errors count from the coordinate `from` on.
    pub(crate) fn run(&mut self, settings: &Settings, from: f64) -> (Figures, SeamTracker) {
        let (first, last) = self.path.span();
        let mut tracker = SeamTracker::try_new(settings, first, Offset::zeros()).expect("settings");
        let mut torch = Torch::new(first, self.delay);
        let mut figures = Figures::default();
        while torch.s < last {
            let lane = tracker.lane().at(torch.s).unwrap_or_else(|| panic!("lane unknown at {}", torch.s));
            let command = corrected(&self.path.jet(torch.s), &lane).expect("a frame").pose;
            let (near, measured) = torch.follow(&command);
            tracker.step(torch.time, torch.s, &measured, last);
            let arrived = self.readings(torch.time, torch.s, &measured);
            for reading in &arrived {
                let _ = tracker.take(self.path, reading);
            }
            self.cycles.push(Cycle { time: torch.time, s: torch.s, measured, arrived });
            self.lost = self.lost.or(tracker.lost().map(|lost| (torch.s, lost)));
            self.score(&mut figures, &measured, near, from);
            torch.motion_figures(&mut figures, settings.speed);
            torch.s = self.advance(&tracker, torch.s, settings.speed);
            torch.time += PERIOD;
        }
        (figures, tracker)
    }

    /// ṡ = v/g, by the midpoint rule.
    fn advance(&self, tracker: &SeamTracker, s: f64, speed: f64) -> f64 {
        let rate = |s: f64| {
            let lane = tracker.lane().at(s).or_else(|| tracker.lane().expected(s)).unwrap_or(LaneJet::TAUGHT);
            let s = s.min(self.path.span().1);
            corrected(&self.path.jet(s), &lane).map_or(speed, |jet| speed / speed_factor(&jet).0)
        };
        s + PERIOD * rate(s + 0.5 * PERIOD * rate(s))
    }

    pub(crate) fn score(&mut self, figures: &mut Figures, measured: &Pose, near: f64, from: f64) {
        let Some(foot) = foot(self.path, &measured.translation.vector, near) else { return };
        self.track.push((foot.s, foot.offset));
        if foot.s >= from {
            figures.add(foot.offset - self.seam.offset(foot.s));
        }
    }
}

/// Where the torch is on its way, and where it was told to be.
pub(crate) struct Torch {
    pub(crate) s: f64,
    pub(crate) time: f64,
    delay: usize,
    /// Newest first: coordinate and pose.
    commanded: VecDeque<(f64, Pose)>,
}

impl Torch {
    pub(crate) fn new(s: f64, delay: usize) -> Self {
        Self { s, time: 0.0, delay, commanded: VecDeque::new() }
    }

    /// Takes the command; gives where the torch really is by now: coordinate and pose.
    pub(crate) fn follow(&mut self, command: &Pose) -> (f64, Pose) {
        self.commanded.push_front((self.s, *command));
        self.commanded.truncate(4.max(self.delay + 1));
        self.commanded[self.delay.min(self.commanded.len() - 1)]
    }

    /// Speed and jerk of the command by its differences.
    pub(crate) fn motion_figures(&self, figures: &mut Figures, speed: f64) {
        let positions: Vec<_> =
            self.commanded.iter().take(4).map(|(_, pose)| pose.translation.vector).collect();
        if let [p0, p1, p2, p3] = positions[..] {
            let along = (p0 - p1).norm() / PERIOD;
            figures.speed = figures.speed.max((along / speed - 1.0).abs());
            let third = p0 - p1 * 3.0 + p2 * 3.0 - p3;
            figures.jerk = figures.jerk.max(third.norm() / (PERIOD * PERIOD * PERIOD));
        }
    }
}
