//! A million cycles of the whole machine without one allocation.
#![allow(unsafe_code, reason = "a global allocator cannot be written otherwise; it only counts")]

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell as Flag;

use crate::bench::{Ar2010, flexible, move_to, on_feedrate};
use crate::seam::{self, Taught, Weld};
use rtrb::RingBuffer;
use seamline::arc::ArcSetting;
use seamline::control::{Command, Event, Mode};
use seamline_cell::cell::{Cell, LostSeam, SensorSource};
use seamline_cell::job::{MovePath, Speed};
use seamline_cell::plan::{Arm, Planner};
use seamline_cell::run::{Devices, Machine, MonotonicClock};
use seamline_cell::sensor::CellSensor;
use seamline_cell::sim::{SimulatedArc, SimulatedDrive};

thread_local! {
    static ARMED: Flag<bool> = const { Flag::new(false) };
    static COUNT: Flag<u64> = const { Flag::new(0) };
}

/// The system's allocator, counting while the thread is armed.
struct Counting;

unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        if ARMED.get() {
            COUNT.set(COUNT.get() + 1);
        }
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        if ARMED.get() {
            COUNT.set(COUNT.get() + 1);
        }
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

const CYCLES: u64 = 1_000_000;
const ENDS: [[f64; 6]; 2] = [[0.0, 0.2, -0.2, 0.1, -1.2, 0.3], [0.35, 0.35, -0.1, 0.3, -1.0, 0.1]];

/// Joint moves and lines to and fro, slow and fast, dwells and the arc: more than a million cycles of it.
fn commands(cell: &Cell, arm: &Ar2010) -> Vec<Command<6>> {
    let mut planner = Planner::new(arm, cell, arm.home).unwrap();
    let mut all = Vec::new();
    let mut planned = 0.0;
    for k in 0.. {
        let joints = &ENDS[(k % 2) as usize];
        let step = match k % 3 {
            0 => move_to(k, MovePath::Joint, Speed::JointPercent(5.0), arm, joints),
            1 => move_to(k, MovePath::Linear, Speed::Linear { mm_s: 5.0 }, arm, joints),
            _ => move_to(k, MovePath::Linear, Speed::Linear { mm_s: 800.0 }, arm, joints),
        };
        let step = planner.plan(&step).unwrap();
        planned += step.duration + 0.05;
        all.push(Command::Arc { on: k % 2 == 0, setting: ArcSetting::NONE });
        all.extend(step.commands);
        all.push(Command::Dwell { line: k, segment: k, duration: 0.05 });
        if planned > 1.1 * CYCLES as f64 * cell.cycle.period {
            return all;
        }
    }
    all
}

#[test]
fn a_million_cycles_allocate_nothing() {
    run(&Cell::default_cell().unwrap());
}

#[test]
fn nor_do_they_with_prefilters_for_two_modes() {
    run(&flexible("fir-zvd", &[6.34, 17.0]));
    run(&on_feedrate("fir-zvd", &[6.34, 17.0]));
}

/// A tracked, weaving weld with the laser, and with an EGM client that sends nothing: the sensor is asked in each cycle.
#[test]
fn nor_does_a_tracked_weld() {
    for source in [SensorSource::Simulated, SensorSource::Egm] {
        let mut cell = seam::cell(0, "");
        cell.sensor.source = source;
        cell.sensor.lost = LostSeam::TaughtPath;
        cell.sensor.egm.listen = "127.0.0.1:0".parse().unwrap();
        let job = Taught::Line.job(20.0, "ARCON ASF#(1)\nWVON WEV#(1)\n", "WVOF\nARCOF AEF#(1)\n");
        let weld = Weld::with(Taught::Line, &job, cell);
        let mut machine = weld.machine();
        let mut tracked = 0;
        ARMED.set(true);
        for k in 0..15_000 {
            match k {
                7_000 => machine.request(Event::Hold),
                7_500 => machine.request(Event::Resume),
                _ => {}
            }
            let (output, _) = machine.cycle();
            tracked += u32::from(output.status.seam.is_some_and(|seam| seam.on_seam));
        }
        ARMED.set(false);
        assert_eq!(COUNT.get(), 0, "allocations and releases");
        assert!(tracked > 8_000, "{tracked}");
    }
}

/// Tracked, weaving welds round an arc behind prefilters for two modes, on the joints and on the feedrate, with overrides and pauses: a million cycles.
#[test]
fn nor_do_a_million_with_everything_on() {
    for prefiltered in [flexible, on_feedrate] {
        let mut cell = seam::cell(0, "");
        cell.vibration = prefiltered("fir-zvd", &[6.34, 17.0]).vibration;
        cell.arc.lock_override = false;
        let job = Taught::Arc.job(50.0, "ARCON ASF#(1)\nWVON WEV#(2)\n", "WVOF\nARCOF AEF#(1)\n");
        let weld = Weld::with(Taught::Arc, &job, cell);
        let (mut cycles, mut tracked, mut slowest) = (0_u64, 0_u64, Vec::new());
        while cycles < CYCLES / 2 {
            let mut machine = weld.machine();
            ARMED.set(true);
            for k in 0_u64.. {
                match k % 4_000 {
                    1_000 => machine.set_override(0.3),
                    1_600 => machine.set_override(1.0),
                    3_000 => machine.request(Event::Hold),
                    3_500 => machine.request(Event::Resume),
                    _ => {}
                }
                let (output, _) = machine.cycle();
                assert_eq!(output.status.fault, None);
                cycles += 1;
                tracked += u64::from(output.status.seam.is_some_and(|seam| seam.on_seam));
                if output.status.mode == Mode::Standstill {
                    break;
                }
            }
            ARMED.set(false);
            slowest.extend(machine.stage_times().pop());
        }
        assert_eq!(COUNT.get(), 0, "allocations and releases in {cycles} cycles");
        assert!(2 * tracked > cycles, "{tracked} of {cycles}");
        println!("computing time of a cycle, µs, of the last weld: {:?}", slowest.last());
    }
}

fn run(cell: &Cell) {
    let arm = Arm::from_cell(cell).unwrap();
    let commands = commands(cell, &arm);
    let (mut producer, consumer) = RingBuffer::new(commands.len());
    commands.into_iter().for_each(|command| producer.push(command).unwrap());
    let drive = SimulatedDrive::<6>::from_cell(cell).unwrap();
    let devices =
        Devices { drive, arc: SimulatedArc::from_cell(cell), seam: CellSensor::from_cell(cell).unwrap() };
    let mut machine = Machine::new(cell, &arm, devices, MonotonicClock::default(), consumer).unwrap();
    machine.request(Event::Enable);
    machine.cycle();
    machine.request(Event::Start);
    let mut modes = [0_u64; 2];
    ARMED.set(true);
    for k in 0..CYCLES {
        match k % 20_000 {
            5_000 => machine.set_override(0.3),
            6_000 => machine.set_override(1.0),
            15_000 => machine.request(Event::Hold),
            15_500 => machine.request(Event::Resume),
            _ => {}
        }
        let (output, _) = machine.cycle();
        modes[usize::from(output.status.mode == Mode::Running)] += 1;
    }
    ARMED.set(false);
    assert_eq!(COUNT.get(), 0, "allocations and releases in {CYCLES} cycles");
    // It did run, pause and go on, which takes longer behind prefilters.
    assert!(modes[1] > 850_000 && modes[0] > 20_000, "{modes:?}");
    let times = machine.stage_times();
    println!("computing time of a cycle, µs: {:?}", times.last());
}
