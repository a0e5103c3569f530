//! A client of `abbegm` on the loopback.

use std::net::{SocketAddr, UdpSocket};
use std::thread;
use std::time::Duration;

use abbegm::msg::EgmSensorPathCorr;
use abbegm::sync_peer::EgmPeer;
use prost_of_peer::Message;
use seamline_cell::sensor::egm::{DropReason, EgmSensor, EgmSettings};

use crate::{ask, torch};

const LOOPBACK: &str = "127.0.0.1:0";
const ANSWERS: u32 = 100;

fn open(client: SocketAddr) -> EgmSensor {
    let listen = LOOPBACK.parse().expect("an address");
    EgmSensor::open(&EgmSettings { listen, client, age_max: 10.0 }).expect("a socket")
}

/// The client answers each of 100 messages, which come at 250 Hz, with a correction of its own size: each arrives, in order, and the client reads
/// where the torch is.
#[test]
fn a_client_that_others_wrote_is_understood_and_understands() {
    let mut client = EgmPeer::bind(LOOPBACK).expect("a socket");
    client.socket().set_read_timeout(Some(Duration::from_secs(10))).expect("a timeout");
    let mut sensor = open(client.socket().local_addr().expect("an address"));
    let answering = thread::spawn(move || {
        for number in 1..=ANSWERS {
            let (robot, controller) = client.recv_from().expect("a message of the controller");
            let pose = robot.feedback_pose().expect("a pose").clone();
            let position = pose.pos.expect("a position");
            assert_eq!([position.x, position.y, position.z], [1000.0, -200.0, 300.0]);
            assert_eq!(pose.orient.expect("an orientation").u0, 1.0);
            assert!(robot.sequence_number() >= Some(number), "{robot:?}");
            let correction = EgmSensorPathCorr::new(number, 0, [0.0, f64::from(number), -0.5], 3);
            client.socket().send_to(&correction.encode_to_vec(), controller).expect("sent");
        }
        client
    });
    let mut readings = Vec::new();
    // A cycle a millisecond, for ten seconds at most.
    for cycle in 0..10_000_u32 {
        let now = torch(f64::from(cycle) * 1e-3);
        while let Some(reading) = ask(&mut sensor, &now) {
            // Three milliseconds old when it was sent, and not from the future.
            assert!(reading.exposure <= now.time - 3e-3, "{reading:?} at {}", now.time);
            readings.push(reading);
        }
        if readings.len() == ANSWERS as usize {
            break;
        }
        thread::sleep(Duration::from_millis(1));
    }
    let laterals: Vec<f64> = readings.iter().map(|reading| reading.lateral).collect();
    let expected: Vec<f64> = (1..=ANSWERS).map(|number| f64::from(number) * 1e-3).collect();
    assert_eq!(laterals, expected);
    assert!(readings.iter().all(|reading| reading.height == -0.5e-3 && reading.gap.is_none()));
    assert_eq!((sensor.counts().accepted, sensor.counts().dropped()), (u64::from(ANSWERS), 0));
    answering.join().expect("the client's side");
}

/// What comes from another address than the client's is counted and dropped, and so is what is wrong.
#[test]
fn what_is_wrong_or_foreign_is_counted() {
    let client = UdpSocket::bind(LOOPBACK).expect("a socket");
    let stranger = UdpSocket::bind(LOOPBACK).expect("a socket");
    let mut sensor = open(client.local_addr().expect("an address"));
    let correction = EgmSensorPathCorr::new(1, 0, [0.0; 3], 1).encode_to_vec();
    for (from, datagram) in [
        (&stranger, &correction[..]),
        (&client, &[0xff; 600][..]),
        (&client, &correction[..]),
        (&client, &correction[..]),
    ] {
        from.send_to(datagram, sensor.address()).expect("sent");
        // One after the other.
        thread::sleep(Duration::from_millis(20));
    }
    let mut readings = 0;
    for cycle in 0..10_000_u32 {
        readings += u32::from(ask(&mut sensor, &torch(f64::from(cycle) * 1e-3)).is_some());
        if sensor.counts().dropped() == 3 && readings == 1 {
            break;
        }
        thread::sleep(Duration::from_millis(1));
    }
    let counts = sensor.counts();
    assert_eq!((readings, counts.accepted), (1, 1), "{counts:?}");
    for reason in [DropReason::Foreign, DropReason::Malformed, DropReason::Replayed] {
        assert_eq!(counts.of(reason), 1, "{}: {counts:?}", reason.name());
    }
}

/// The cycle may stop asking: what the ring cannot hold is dropped, and nobody waits.
#[test]
fn a_cycle_that_does_not_ask_loses_readings_only() {
    let client = UdpSocket::bind(LOOPBACK).expect("a socket");
    let mut sensor = open(client.local_addr().expect("an address"));
    for number in 1..=200 {
        let correction = EgmSensorPathCorr::new(number, 0, [0.0; 3], 1).encode_to_vec();
        client.send_to(&correction, sensor.address()).expect("sent");
        thread::sleep(Duration::from_micros(200));
    }
    for _ in 0..1000 {
        if sensor.counts().of(DropReason::RingFull) == 200 - 64 {
            break;
        }
        thread::sleep(Duration::from_millis(5));
    }
    assert_eq!(sensor.counts().of(DropReason::RingFull), 200 - 64);
    let left = std::iter::from_fn(|| ask(&mut sensor, &torch(1.0))).count();
    assert_eq!(left, 64);
}

#[test]
fn an_address_that_cannot_be_had_is_named() {
    let taken = UdpSocket::bind(LOOPBACK).expect("a socket");
    let listen = taken.local_addr().expect("an address");
    let error =
        EgmSensor::open(&EgmSettings { listen, client: listen, age_max: 0.1 }).expect_err("it is taken");
    assert!(error.to_string().starts_with(&format!("EGM at {listen}: ")), "{error}");
}
