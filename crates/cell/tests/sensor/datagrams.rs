//! Random and mutated datagrams against the judge; what is believed is read once more by a decoder that others wrote.

use abbegm::msg::EgmSensorPathCorr;
use prost_of_peer::Message;
use seamline_cell::sensor::egm::{DropReason, EgmGate};

use crate::Random;

const AGE_MAX: f64 = 0.1;
/// Seconds between two datagrams.
const STEP: f64 = 1e-3;

fn encoded(number: u32, position: [f64; 3], age_ms: u32) -> Vec<u8> {
    EgmSensorPathCorr::new(number, 0, position, age_ms).encode_to_vec()
}

/// 1,000,000 datagrams, half of them random bytes of 0 to 600, half good ones with up to four bytes changed, cut, or repeated. Nothing
/// panics, and whatever is believed is a path correction of finite numbers, not too old, with a number above the last one's.
#[test]
fn nothing_bad_passes() {
    let mut random = Random(6510);
    let mut gate = EgmGate::new(AGE_MAX);
    let mut last = None;
    let (mut passed, mut dropped) = (0_u32, [0_u32; DropReason::ALL.len()]);
    for case in 0..1_000_000_u32 {
        let time = f64::from(case) * STEP;
        let datagram = if case % 2 == 0 { noise(&mut random) } else { mutated(&mut random, case) };
        match gate.judge(&datagram, time) {
            Err(reason) => dropped[reason as usize] += 1,
            Ok(correction) => {
                passed += 1;
                let read = EgmSensorPathCorr::decode(&datagram[..]).expect("a path correction");
                let (header, path) = (read.header.expect("a header"), read.path_corr.expect("a correction"));
                assert_eq!(header.mtype, Some(4));
                assert_eq!(header.seqno, Some(correction.number));
                assert!(path.pos.x.is_finite() && path.pos.y.is_finite() && path.pos.z.is_finite());
                assert_eq!(correction.lateral, path.pos.y * 1e-3);
                assert_eq!(correction.height, path.pos.z * 1e-3);
                assert!(path.age <= 100);
                let follows = |(number, at): (u32, f64)| correction.number > number || time - at > 1.0;
                assert!(last.is_none_or(follows), "{} after {last:?}", correction.number);
                last = Some((correction.number, time));
            }
        }
    }
    // Each reason that the judge has came up, and good ones went through.
    assert!(passed > 1_000, "{passed}");
    for reason in [
        DropReason::Malformed,
        DropReason::OtherType,
        DropReason::NotFinite,
        DropReason::Stale,
        DropReason::Replayed,
    ] {
        assert!(dropped[reason as usize] > 100, "{}: {dropped:?}", reason.name());
    }
}

fn noise(random: &mut Random) -> Vec<u8> {
    (0..random.below(600)).map(|_| random.bits() as u8).collect()
}

fn mutated(random: &mut Random, case: u32) -> Vec<u8> {
    let mut position = [(); 3].map(|()| random.within(-10.0, 10.0));
    if random.below(20) == 0 {
        position[random.below(3) as usize] =
            [f64::NAN, f64::INFINITY, -f64::INFINITY][random.below(3) as usize];
    }
    let number = if random.below(4) == 0 { random.below(u64::from(case)) as u32 } else { case };
    let mut datagram = encoded(number, position, random.below(120) as u32);
    for _ in 0..random.below(5) {
        let place = random.below(datagram.len() as u64) as usize;
        datagram[place] = random.bits() as u8;
    }
    match random.below(10) {
        0 => datagram.truncate(random.below(datagram.len() as u64) as usize),
        1 => datagram.extend_from_within(..),
        _ => {}
    }
    datagram
}

#[test]
fn each_mistake_has_its_reason() {
    let mut gate = EgmGate::new(AGE_MAX);
    let good = |number| encoded(number, [0.0, 1.5, -2.0], 10);
    let correction = gate.judge(&good(7), 0.0).expect("a good one");
    assert_eq!((correction.lateral, correction.height, correction.age), (1.5e-3, -2e-3, 10e-3));
    assert_eq!(gate.judge(&good(7), 0.004), Err(DropReason::Replayed));
    assert_eq!(gate.judge(&good(6), 0.008), Err(DropReason::Replayed));
    assert!(gate.judge(&good(9), 0.012).is_ok(), "one was lost");
    assert_eq!(gate.judge(&encoded(10, [0.0; 3], 101), 0.016), Err(DropReason::Stale));
    assert_eq!(gate.judge(&encoded(10, [f64::NAN, 0.0, 0.0], 1), 0.016), Err(DropReason::NotFinite));
    assert_eq!(gate.judge(&[], 0.016), Err(DropReason::Malformed));
    assert_eq!(gate.judge(&good(10)[..20], 0.016), Err(DropReason::Malformed));
    let pose = abbegm::msg::EgmSensor {
        header: Some(abbegm::msg::EgmHeader::correction(10, 0)),
        planned: None,
        speed_ref: None,
    };
    assert_eq!(gate.judge(&pose.encode_to_vec(), 0.016), Err(DropReason::OtherType));
    // Dropped ones use no number up.
    assert!(gate.judge(&good(10), 0.020).is_ok());
    // A forged number locks the client out for a second, and no longer.
    assert!(gate.judge(&good(u32::MAX), 0.024).is_ok());
    assert_eq!(gate.judge(&good(11), 1.0), Err(DropReason::Replayed));
    assert!(gate.judge(&good(12), 1.1).is_ok());
}
