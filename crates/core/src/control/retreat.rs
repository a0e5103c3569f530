//! Programme time run backward: the arm goes back over the moves that are done.

use super::instant::{At, along_path, joint_motion};
use super::lookahead::{AlongPath, JointMotion, Lookahead};
use super::program::{Arm, Follows, Program};
use super::rate::{Rate, RateLimits};
use crate::kinematics::Kinematics;
use crate::safety::Fault;

impl<const N: usize> Program<N> {
    /// Way that it takes to stop from the present speed, within the limits along the path; and the speed as planned. Metres, metres per
    /// second.
    pub(super) fn stopping(&self) -> (f64, f64) {
        let Some((start, block)) = self.under_way(self.now) else { return (0.0, 0.0) };
        let AlongPath { velocity, acceleration_limit, jerk_limit, .. } = along_path(block, self.now - start);
        let speed = velocity * self.rate.value();
        (0.5 * speed * (speed / acceleration_limit + acceleration_limit / jerk_limit), velocity)
    }

    /// From rest on, programme time runs backward over the moves done, or forward again.
    pub(super) fn turn(&mut self, backward: bool) {
        if self.backward.is_some() == backward {
            return;
        }
        // The look-ahead counts upward from zero at some time from here on.
        self.backward = backward.then_some(self.now + self.ahead.spacing());
        self.ahead = Lookahead::new(self.ahead.spacing());
        self.ahead.forget_before(self.ahead_time(self.now));
        self.ahead_position = self.position;
    }

    pub(super) fn runs_backward(&self) -> bool {
        self.backward.is_some()
    }

    /// Programme time that may still run backward: nothing is known before. Infinite where the moves remembered begin at rest, since the
    /// arm comes to rest there by itself.
    pub(super) fn remembered(&self) -> f64 {
        if self.is_on_seam() && self.guide.is_at_memory_end() {
            return 0.0;
        }
        let oldest = self.done.oldest().map(|done| (done.start, &done.block));
        match oldest.or(self.head_move().map(|block| (self.move_start, block))) {
            Some((start, block)) if block.starts_at_rest && self.now > start => f64::INFINITY,
            Some((start, _)) => self.now - start,
            None => 0.0,
        }
    }

    /// Programme time's rate and its derivative, with their signs.
    pub(super) fn time_rate(&self) -> (f64, f64) {
        let sign = if self.backward.is_some() { -1.0 } else { 1.0 };
        (sign * self.rate.value(), sign * self.rate.slope())
    }

    /// One cycle back at most at the rate `goal`; stops where the first move that is remembered begins.
    ///
    /// # Errors
    /// [`Fault::NoInverse`] where the path has no joints.
    pub(super) fn retreat<K: Kinematics<N>>(
        &mut self,
        goal: f64,
        kinematics: &K,
        limits: &RateLimits<N>,
        period: f64,
        arm: Arm,
    ) -> Result<(), Fault> {
        self.look_ahead(kinematics)?;
        if self.arriving {
            if arm.motion == Follows::Behind {
                return Ok(());
            }
            self.arriving = false;
            self.rate = Rate::constant(goal);
        }
        // The move that the arm runs back through: at rest between two moves, the earlier one.
        let head =
            self.head_move().filter(|_| self.now > self.move_start).map(|block| (self.move_start, block));
        let here = head.or_else(|| self.done.before(self.now).map(|done| (done.start, &done.block)));
        let stops = here.filter(|(_, block)| block.starts_at_rest).map(|(start, _)| start);
        let first = self.done.oldest().map_or(self.move_start, |done| done.start);
        let at = self.ahead_time(self.now);
        self.now -= self.rate.advance(goal, at, &self.ahead, limits, period);
        if self.now <= first {
            self.now = first;
            self.rate = Rate::constant(0.0);
        }
        if let Some(stop) = stops.filter(|stop| self.now <= *stop)
            && arm.motion != Follows::AtOnce
        {
            (self.now, self.arriving) = (stop, true);
        }
        self.find_place();
        Ok(())
    }

    /// The joints' motion at a programme time of the moves done or under way, as time runs backward; `None` where it is not
    /// remembered.
    pub(super) fn sample_back<K: Kinematics<N>>(
        &mut self,
        time: f64,
        kinematics: &K,
    ) -> Result<Option<JointMotion<N>>, Fault> {
        let Some((start, block)) = self.under_way(time) else {
            // Behind the last move, or before the first.
            let rests = time >= self.move_start || self.remembered() == f64::INFINITY;
            return Ok(rests.then_some(JointMotion::REST));
        };
        let at = At { block, start, since: (time - start).min(block.duration()) };
        let (motion, position) = joint_motion(&at, &self.ahead_position, &self.corrections(), kinematics)?;
        self.ahead_position = position;
        Ok(Some(motion.reversed()))
    }
}
