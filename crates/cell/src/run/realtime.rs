//! The cycle in real time: a thread of its own on absolute deadlines.

use std::thread;
use std::time::Duration;

use rtrb::{Producer, RingBuffer};
use rustix::mm::{MlockAllFlags, mlockall};
use rustix::thread::{ClockId as SleepClock, clock_nanosleep_absolute};
use rustix::time::{ClockId, Timespec, clock_gettime};
use thread_priority::{
    RealtimeThreadSchedulePolicy, ThreadPriority, ThreadPriorityValue, ThreadSchedulePolicy,
    set_thread_priority_and_policy, thread_native_id,
};

use super::beat::{Beat, LoopFigures, Plant};
use super::supervisor::Supervisor;
use crate::plan::PlanningArm;
use crate::record::{SampleSender, TimeHistogram};

/// SCHED_FIFO priority of the cycle: above everything but the kernel's own threads.
const PRIORITY: u8 = 80;
/// Beats between the cycle and its supervisor: a minute at 1 kHz.
const BEATS: usize = 1 << 16;
/// How often the supervisor looks.
const LOOK: Duration = Duration::from_millis(1);
const NANOSECONDS: i64 = 1_000_000_000;

/// Runs the machine on its own thread, once per period of the monotonic clock, while this thread supervises.
///
/// Without the permission for real-time scheduling the run goes on with the ordinary one, and says so.
pub(super) fn run<const N: usize, K: PlanningArm<N> + Send>(
    plant: Plant<N, K>,
    samples: SampleSender,
    supervisor: &mut Supervisor<'_, N, K>,
    settle: u64,
    watch: &mut impl FnMut(&Beat),
) -> (SampleSender, LoopFigures) {
    let (beats, mut seen) = RingBuffer::new(BEATS);
    supervisor.feed(0.0);
    thread::scope(|scope| {
        let cycle = scope.spawn(move || Thread { plant, samples, beats }.run(settle));
        while !cycle.is_finished() {
            while let Ok(beat) = seen.pop() {
                supervisor.observe(&beat);
                watch(&beat);
            }
            thread::sleep(LOOK);
        }
        while let Ok(beat) = seen.pop() {
            supervisor.observe(&beat);
        }
        cycle.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
    })
}

/// What the cycle's thread owns.
struct Thread<const N: usize, K> {
    plant: Plant<N, K>,
    samples: SampleSender,
    beats: Producer<Beat>,
}

impl<const N: usize, K: PlanningArm<N>> Thread<N, K> {
    fn run(mut self, settle: u64) -> (SampleSender, LoopFigures) {
        let mut remarks = prepare();
        let period = (self.plant.machine.period() * NANOSECONDS as f64).round() as i64;
        let mut lateness = TimeHistogram::new();
        let mut overruns = 0;
        let mut deadline = now() + period;
        let (mut cycle, mut left, mut started) = (0, settle, false);
        while left > 0 {
            sleep_until(deadline);
            let late = now() - deadline;
            lateness.record(u64::try_from(late).unwrap_or(0));
            self.plant.machine.set_late(late >= period);
            let (beat, sample) = self.plant.cycle(cycle);
            self.samples.push(sample);
            // A supervisor that is a minute behind misses beats, never the cycle.
            let _ = self.beats.push(beat);
            started |= cycle > 1;
            let over = started && beat.ends_run();
            left -= u64::from(over);
            cycle += 1;
            deadline += period;
            if now() > deadline + period {
                // Whole periods were missed: go on from now, and count them.
                let missed = (now() - deadline) / period;
                overruns += u64::try_from(missed).unwrap_or(0);
                deadline += missed * period;
            }
        }
        let stage_times = self.plant.machine.stage_times();
        remarks.extend(self.plant.machine.seam_remarks());
        let lateness = Some(lateness.figures("lateness"));
        let memory = Box::new(self.plant.machine.memory().clone());
        (self.samples, LoopFigures { stage_times, lateness, overruns, remarks, memory })
    }
}

/// Real-time scheduling and memory that stays: what could not be had is said.
fn prepare() -> Vec<String> {
    let mut remarks = Vec::new();
    let policy = ThreadSchedulePolicy::Realtime(RealtimeThreadSchedulePolicy::Fifo);
    let scheduled =
        ThreadPriorityValue::try_from(PRIORITY).map_err(|reason| reason.to_string()).and_then(|priority| {
            set_thread_priority_and_policy(
                thread_native_id(),
                ThreadPriority::Crossplatform(priority),
                policy,
            )
            .map_err(|error| format!("{error:?}"))
        });
    if let Err(reason) = scheduled {
        remarks.push(format!(
            "no SCHED_FIFO (it needs CAP_SYS_NICE or an rtprio limit): ordinary scheduling; {reason}"
        ));
    }
    if let Err(error) = mlockall(MlockAllFlags::CURRENT | MlockAllFlags::FUTURE) {
        remarks.push(format!("memory is not locked (it needs CAP_IPC_LOCK or a memlock limit): {error}"));
    }
    remarks
}

/// The monotonic clock in nanoseconds.
fn now() -> i64 {
    let time = clock_gettime(ClockId::Monotonic);
    time.tv_sec * NANOSECONDS + time.tv_nsec
}

fn sleep_until(deadline: i64) {
    let request = Timespec { tv_sec: deadline / NANOSECONDS, tv_nsec: deadline % NANOSECONDS };
    // Interrupted by a signal the sleep begins again; the deadline is absolute.
    while clock_nanosleep_absolute(SleepClock::Monotonic, &request)
        .is_err_and(|e| e == rustix::io::Errno::INTR)
    {}
}
