//! Readings from elsewhere through the whole cycle: forged ones, and an EGM client on the loopback.

use std::net::UdpSocket;
use std::thread;
use std::time::Duration;

use abbegm::msg::EgmSensorPathCorr;
use prost_of_peer::Message;
use seamline::control::Mode;
use seamline::safety::Fault;
use seamline::seam::Reading;
use seamline_cell::sensor::csv::{Arrival, write};

use crate::bench::{Random, worst_shares};
use crate::seam::{Taught, Weld, cell, tool};

const MM: f64 = 1e-3;

/// Readings at 1 kHz over a whole job: good ones at times, and anything that a sensor could say, or that somebody could send in its name.
fn forged(random: &mut Random, seconds: f64) -> Vec<Arrival> {
    let mut level = [0.0; 2];
    (0..(seconds * 1e3) as u32)
        .map(|k| {
            let time = f64::from(k) * 1e-3;
            // Now and then another level that the readings keep to for a while, so that they are believed.
            if random.unit() < 0.01 {
                level = [random.within(-12.0, 12.0) * MM, random.within(-12.0, 12.0) * MM];
            }
            let noise = if random.unit() < 0.5 { 0.0 } else { random.within(-3.0, 3.0) * MM };
            let wild = random.unit() < 0.02;
            let any = |random: &mut Random| match (random.unit() * 4.0) as u32 {
                0 => f64::NAN,
                1 => f64::INFINITY,
                2 => -1e300,
                _ => random.within(-1.0, 1.0),
            };
            let lateral = if wild { any(random) } else { level[0] + noise };
            let height = if wild { any(random) } else { level[1] - noise };
            let exposure = time - random.within(0.0, if wild { 5.0 } else { 0.02 });
            let gap = (random.unit() < 0.5).then(|| random.within(0.0, 2.0) * MM);
            Arrival { time, reading: Reading { lateral, height, gap, exposure, quality: random.unit() } }
        })
        .collect()
}

/// Eight jobs, lines and arcs, at two speeds, with 1,000 forged readings a second: the joints' limits hold, the torch stays within the bound of
/// the taught path, and where the job stops, it stops for the seam.
#[test]
fn forged_readings_break_no_limit() {
    let folder = std::path::Path::new(env!("CARGO_TARGET_TMPDIR"));
    let mut farthest = 0.0_f64;
    for case in 0..8_u32 {
        let mut random = Random(u64::from(case) + 77);
        let mm_s = if case % 4 < 2 { 20.0 } else { 80.0 };
        let taught = if case % 2 == 0 { Taught::Line } else { Taught::Arc };
        let path = folder.join(format!("forged-{case}.csv"));
        std::fs::write(&path, write(&forged(&mut random, 40.0))).unwrap();
        let sensor = format!(
            "[sensor]\nreplay_file = {path:?}\nlost_seam = \"{}\"\nage_max_ms = 50.0\n",
            if case < 4 { "taught_path" } else { "stop" }
        );
        let mut of = cell(case, &sensor);
        let seamline_cell::cell::SensorSource::Simulated = of.sensor.source else { panic!("as written") };
        of.sensor.source = seamline_cell::cell::SensorSource::Replay(path);
        let weld = Weld::new(taught, mm_s, of);
        let mut machine = weld.machine();
        let (mut joints, mut done) = (Vec::new(), false);
        for _ in 0..60_000 {
            let (output, _) = machine.cycle();
            joints.push(output.command.position);
            let fault = output.status.fault;
            assert!(
                fault.is_none() || matches!(fault, Some(Fault::SeamLost { .. })) && case >= 4,
                "{fault:?}"
            );
            if output.status.seam.is_some_and(|seam| seam.on_seam) {
                let off = taught.offset(&tool(&output.command.position).translation.vector);
                farthest = farthest.max(off[0].abs().max(off[1].abs()));
            }
            done = output.status.mode == Mode::Standstill
                || output.status.mode == Mode::Fault && output.status.at_rest;
            if done {
                break;
            }
        }
        assert!(done, "case {case} does not end");
        let shares = worst_shares(&joints, &weld.arm, weld.cell.cycle.period);
        assert!(shares[0] <= 1.0 && shares[1] <= 1.001 && shares[2] <= 1.01, "{case}: {shares:?}");
    }
    println!("farthest from the taught path: {:.3} mm", farthest / MM);
    assert!(farthest > 2.0 * MM && farthest <= 10.0 * MM + 1e-6, "{farthest}");
}

/// A correction over EGM counts in the first cycle after the datagram is there, hence in the second one at the latest after it came; the client on
/// the loopback that corrects by nothing leaves the job as it is taught.
#[test]
fn a_datagram_counts_in_the_next_cycle() {
    let client = UdpSocket::bind("127.0.0.1:0").unwrap();
    let address = client.local_addr().unwrap();
    let mut of = cell(0, "");
    of.sensor.source = seamline_cell::cell::SensorSource::Egm;
    of.sensor.egm =
        seamline_cell::cell::EgmAddresses { listen: "127.0.0.1:0".parse().unwrap(), client: address };
    of.sensor.age_max = 10.0;
    let weld = Weld::new(Taught::Line, 20.0, of);
    let mut machine = weld.machine();
    let controller = machine.devices_mut().seam.egm().unwrap().address();
    let taken = |machine: &mut crate::seam::SeamMachine| {
        let (output, _) = machine.cycle();
        output.status.seam.map(|seam| seam.counts.taken)
    };
    // Until the seam is tracked.
    let tracks = (0..10_000).any(|_| taken(&mut machine).is_some());
    assert!(tracks);
    for number in 1..=20 {
        let correction = EgmSensorPathCorr::new(number, 0, [0.0; 3], 0).encode_to_vec();
        client.send_to(&correction, controller).unwrap();
        while machine.devices_mut().seam.egm().unwrap().waiting() == 0 {
            thread::sleep(Duration::from_millis(1));
        }
        assert_eq!(taken(&mut machine), Some(u64::from(number)));
        assert_eq!(taken(&mut machine), Some(u64::from(number)), "and no more");
    }
}
