//! Recordings of readings.

use seamline::seam::Reading;
use seamline_cell::sensor::Replay;
use seamline_cell::sensor::csv::{Arrival, HEADER, read, write};

use crate::{Random, ask, torch};

/// 10,000 readings, a tenth of them without a number or a gap: text and replay give them back bit for bit, each in its cycle.
#[test]
fn a_replay_is_what_was_recorded() {
    let mut random = Random(3);
    let mut time = 0.0;
    let recorded: Vec<Arrival> = (0..10_000)
        .map(|_| {
            time += random.within(0.0, 0.02);
            let mut any = |low, high| if random.below(10) == 0 { f64::NAN } else { random.within(low, high) };
            let (lateral, height, gap) = (any(-0.02, 0.02), any(-1e-7, 1e-7), any(0.0, 1e-3));
            let gap = Some(gap).filter(|gap| !gap.is_nan());
            let quality = any(0.0, 1.0);
            let exposure = time - random.within(0.0, 0.1);
            Arrival { time, reading: Reading { lateral, height, gap, exposure, quality } }
        })
        .collect();
    let mut replay = Replay::new(read(&write(&recorded)).expect("what was written"));
    let mut replayed = Vec::new();
    let mut cycle = 0_u32;
    while replay.left() > 0 {
        let now = f64::from(cycle) * 1e-3;
        while let Some(reading) = ask(&mut replay, &torch(now)) {
            let due = recorded[replayed.len()].time;
            assert!(due <= now && due > now - 1.001e-3, "{due} at {now}");
            replayed.push(reading);
        }
        cycle += 1;
    }
    let bits = |reading: &Reading| {
        let Reading { lateral, height, gap, exposure, quality } = *reading;
        let number = |x: f64| if x.is_nan() { None } else { Some(x.to_bits()) };
        ([lateral, height, exposure, quality].map(number), gap.map(f64::to_bits))
    };
    assert_eq!(replayed.len(), recorded.len());
    for (one, other) in replayed.iter().zip(&recorded) {
        assert_eq!(bits(one), bits(&other.reading));
    }
}

#[test]
fn mistakes_have_line_and_column() {
    let header = format!("line 1: `time,y`: expected the columns {HEADER}");
    for (text, message) in [
        ("time,y\n1,2\n", header.as_str()),
        ("", &format!("line 1: ``: expected the columns {HEADER}")),
        (&format!("{HEADER}\n1,1,0,0,,1\n\n1,1,0\n"), &format!("line 4: 3 columns: expected 6, {HEADER}")),
        (
            &format!("{HEADER}\n# a scan\n1,1,zero,0,,1\n"),
            "line 3, column 3 (lateral_mm): `zero`: expected millimetres, or nothing",
        ),
        (&format!("{HEADER}\n,1,0,0,,1\n"), "line 2, column 1 (arrival_s): ``: expected seconds"),
        (&format!("{HEADER}\n1,inf,0,0,,1\n"), "line 2, column 2 (exposure_s): `inf`: expected seconds"),
        (
            &format!("{HEADER}\n1,2,0,0,,1\n"),
            "line 2, column 2 (exposure_s): `2`: expected an exposure before the arrival",
        ),
        (
            &format!("{HEADER}\n2,1,0,0,,1\n1,1,0,0,,1\n"),
            "line 3, column 1 (arrival_s): `1`: expected no earlier arrival than in the row before",
        ),
        (
            &format!("{HEADER}\n1,1,0,0,,good\n"),
            "line 2, column 6 (quality): `good`: expected a number, or nothing",
        ),
    ] {
        assert_eq!(read(text).expect_err(text).to_string(), message);
    }
}
