//! What a tracked seam makes of the program: its rate, its joints, and the way back to the plan.

use super::block::{Block, Command, Motion};
use super::history::History;
use super::instant::{At, joints_of, joints_on};
use super::program::Program;
use super::rate::RateLimits;
use super::seam::{Corrections, Fade, Playing, SeamStatus, Tracking, shown_rate};
use crate::drive::JointCommand;
use crate::geometry::{Pose, PoseJet};
use crate::kinematics::Kinematics;
use crate::safety::Fault;
use crate::seam::{Instant, SeamSensor};

/// Samples of the look-ahead by which a rate lags its goal where that changes steadily.
const LEAD: f64 = 1.5;

impl<const N: usize> Program<N> {
    pub(super) fn corrections(&self) -> Corrections<'_, N> {
        Corrections { seam: self.guide.correction(), fade: self.fade.as_ref() }
    }

    /// How many differences have faded, with the share of the last one, by real time. Prefilters on the feedrate hold it back like the way: what
    /// is a mean of it is within the joints' limits, whatever the rate does in between.
    pub(super) fn gone(&self) -> [f64; 3] {
        let Some(fade) = &self.fade else { return [self.faded, 0.0, 0.0] };
        let (gone, (rate, slope)) = (fade.gone(self.now), self.time_rate());
        let [d1, d2, _] = gone.derivatives();
        [self.faded + gone.value(), d1 * rate, d2 * rate * rate + d1 * slope]
    }

    /// What takes the joints off the paths after a seam was tracked, at a place of the course that has come out of the prefilters with
    /// [`Program::gone`]. Behind the place where the difference came about it counts, and before it not.
    pub(super) fn aside(&self, course: f64, [gone, rate, slope]: [f64; 3]) -> Option<JointCommand<N>> {
        let way = if self.backward.is_some() { -course } else { course };
        let fade = self.fade.as_ref().filter(|_| way >= self.fades_from)?;
        Some(fade.left([gone - self.faded, rate, slope]))
    }

    /// The rate at which a share of full speed is kept: on a tracked seam the torch's own speed along it counts.
    pub(super) fn goal(&self, speed: f64, limits: Option<&RateLimits<N>>) -> f64 {
        let Some((start, block)) = self.under_way(self.now) else { return speed };
        // The rate is there after the look-ahead's next sample.
        let lead = LEAD * self.ahead.spacing() * self.rate.value();
        let full = self.full_rate(block, self.now + lead - start);
        let bearable = match limits {
            Some(limits) if full < 1.0 => self.ahead.bearable(limits),
            _ => 1.0,
        };
        (speed * full).min(bearable)
    }

    fn full_rate(&self, block: &Block<N>, since: f64) -> f64 {
        let fading = self.fade.as_ref().map_or(1.0, |fade| fade.rate(self.now));
        self.guide.rate(block, since).min(fading)
    }

    /// The share of full speed at which the program goes on.
    pub(super) fn shown_rate(&self) -> f64 {
        let full =
            self.under_way(self.now).map_or(1.0, |(start, block)| self.full_rate(block, self.now - start));
        if full < 1.0 { shown_rate(self.rate.value(), full, self.speed) } else { self.rate.value() }
    }

    /// The seam sensor is asked, with the measured tool centre point at the start of the cycle.
    pub(super) fn sense(&mut self, time: f64, measured: Pose, sensor: &mut impl SeamSensor) {
        let s = self.weld_coordinate();
        self.guide.sense(&Instant { time, s, base_from_tcp: measured }, sensor);
    }

    /// Coordinate of the weld at which the program stands.
    fn weld_coordinate(&self) -> f64 {
        let tracked = |block: &Block<N>, since: f64| match &block.motion {
            Motion::Path(motion) => motion.tracked.map(|on| on.start + motion.state(since).position),
            Motion::Joint(_) => None,
        };
        let here = self.under_way(self.now).and_then(|(start, block)| tracked(block, self.now - start));
        let behind = || self.done.at(self.now).and_then(|done| tracked(&done.block, done.block.duration()));
        here.or_else(behind).unwrap_or(self.guide.coordinate())
    }

    /// What is to be told of the tracking.
    pub(super) fn seam_status(&self) -> Option<SeamStatus> {
        self.guide.status(self.weld_coordinate(), self.is_on_seam())
    }

    /// Whether a tracked move is under way.
    pub(super) fn is_on_seam(&self) -> bool {
        self.under_way(self.now).is_some_and(
            |(_, block)| matches!(&block.motion, Motion::Path(motion) if motion.tracked.is_some()),
        )
    }

    /// Tracking begins where the arm stands. What lies behind is forgotten with the lane that led there.
    pub(super) fn track<K: Kinematics<N>>(
        &mut self,
        tracking: &Tracking,
        kinematics: &K,
        limits: &RateLimits<N>,
    ) -> Result<(), Fault> {
        let tcp = kinematics.forward(&self.position) * tracking.flange_from_tcp;
        let seam = self.guide.begin(tracking, &tcp.translation.vector);
        self.enter_seam(&seam, &tracking.flange_from_tcp, kinematics, limits)
    }

    /// A pass begins where the arm stands.
    pub(super) fn play<K: Kinematics<N>>(
        &mut self,
        playing: &Playing,
        kinematics: &K,
        limits: &RateLimits<N>,
    ) -> Result<(), Fault> {
        let seam = self.guide.play(playing)?;
        self.enter_seam(&seam, &playing.flange_from_tcp, kinematics, limits)
    }

    /// From where the arm stands on to the corrected path of another weld.
    fn enter_seam<K: Kinematics<N>>(
        &mut self,
        seam: &PoseJet,
        flange_from_tcp: &Pose,
        kinematics: &K,
        limits: &RateLimits<N>,
    ) -> Result<(), Fault> {
        let flange = seam.attached(&flange_from_tcp.inverse());
        let planned = joints_of(&flange, &self.position, kinematics)?.position;
        self.done = History::new();
        self.fade_from(&planned, limits);
        Ok(())
    }

    /// From where the arm stands on to the next move of the weld: where the taught path bends, the same correction leads elsewhere. False where
    /// that move has yet to come.
    pub(super) fn join_move<K: Kinematics<N>>(
        &mut self,
        kinematics: &K,
        limits: &RateLimits<N>,
    ) -> Result<bool, Fault> {
        let next = (self.count > 1).then(|| self.nth(1));
        let Some(Command::Move(block)) = next else { return Ok(false) };
        let at = At { block, start: self.move_start, since: 0.0 };
        let corrections = Corrections { fade: None, ..self.corrections() };
        let planned = joints_on(&at, &self.position, &corrections, kinematics)?.position;
        self.fade_from(&planned, limits);
        Ok(true)
    }

    /// From the corrected path on to moves as they are planned.
    pub(super) fn leave_seam<K: Kinematics<N>>(
        &mut self,
        kinematics: &K,
        limits: &RateLimits<N>,
    ) -> Result<(), Fault> {
        self.guide.end();
        if let Some(done) = self.done.at(self.now) {
            let at = At { block: &done.block, start: done.start, since: done.block.duration() };
            let none = Corrections { seam: None, fade: None };
            let planned = joints_on(&at, &self.position, &none, kinematics)?.position;
            self.fade_from(&planned, limits);
        }
        Ok(())
    }

    /// The arm stands beside the plan: what is between fades out on the way from here.
    fn fade_from(&mut self, planned: &[f64; N], limits: &RateLimits<N>) {
        let difference = core::array::from_fn(|axis| self.position[axis] - planned[axis]);
        let fade = Fade::new(difference, self.now, limits);
        // What has faded stays for the way back, where nothing takes its place: only one difference can be gone back through.
        if fade.is_some() || self.fade.is_some_and(|fade| !fade.is_over(self.now)) {
            (self.faded, self.fades_from) = (self.gone()[0], self.way_before.path);
            if self.fade.is_some() {
                self.done = History::new();
            }
            self.fade = fade;
        }
        self.look_anew();
    }

    /// Moves from rest have come to the head.
    pub(super) fn begin_to_fade(&mut self) {
        let (time, to_rest) = (self.move_start, self.time_to_rest());
        if self.fade.as_mut().is_some_and(|fade| fade.begin(time, to_rest)) {
            self.look_anew();
        }
    }

    /// The joints ahead are others than they were thought to be.
    fn look_anew(&mut self) {
        self.ahead.forget_after(self.now);
        self.ahead_position = self.position;
    }
}
