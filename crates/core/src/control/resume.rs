//! What lies between the word to go on and the motion of the job: back to the path, back along the bead, the arc lit again.

use super::cycle::Cycle;
use super::mode::Event;
use super::off_path::OffPath;
use super::prefilter::PrefilterEntry;
use crate::kinematics::Kinematics;
use crate::safety::Fault;

/// Programme time before the beginning of what is remembered at which backing stops, in seconds: longer than a stop takes.
const REMEMBERED: f64 = 0.3;

/// Time constant of the last bit of the way back, in seconds.
const APPROACH: f64 = 0.05;
/// A place of the bead is met to so many metres.
const NEAR: f64 = 10e-6;

/// Where a resumption stands.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Resume {
    /// The arm goes back to the path that it had left.
    Return,
    /// It comes to rest first: what follows begins at rest.
    Settle,
    /// Back along the bead.
    Back,
    /// The arc is lit.
    Strike,
    /// The torch stands until the pool has formed again, for so many seconds more.
    Dwell { left: f64 },
}

impl Resume {
    /// The arc is wanted in this phase.
    pub(super) fn wants_arc(&self) -> bool {
        matches!(self, Self::Strike | Self::Dwell { .. })
    }
}

impl<const N: usize, K, M> Cycle<N, K, M>
where
    K: Kinematics<N>,
    M: AsRef<[PrefilterEntry<N>]> + AsMut<[PrefilterEntry<N>]>,
{
    pub(super) fn begin_to_resume(&mut self) {
        self.off_path = None;
        self.resume = if self.on_path { Resume::Settle } else { Resume::Return };
    }

    /// Without an arc the motion goes on as it is; back along the bead and forward again it begins at rest.
    fn settle(&mut self) {
        let arc = self.program.place().mark.arc;
        if !arc && !self.program.runs_backward() {
            self.apply(Event::Ready);
        } else if self.is_at_rest() {
            let back = arc && self.left_along_the_bead() > NEAR;
            self.turn(back);
            self.resume = match (arc, back) {
                (true, true) => Resume::Back,
                (true, false) => Resume::Strike,
                (false, _) => Resume::Settle,
            };
        }
    }

    /// Before backing up, the arm comes to rest.
    pub(super) fn settle_to_back(&mut self) {
        if self.resume == Resume::Settle && self.is_at_rest() {
            self.turn(true);
            self.resume = Resume::Back;
        }
    }

    /// How far back along the bead the arc is to be lit again, in metres.
    fn left_along_the_bead(&self) -> f64 {
        let behind = self.bead_end - self.program.way().tool;
        (self.config.arc.overlap - behind).min(self.program.bead())
    }

    pub(super) fn back_along_the_bead(&mut self, speed: f64) -> Result<(), Fault> {
        if self.back(self.left_along_the_bead(), speed)? {
            self.turn(false);
            self.resume = Resume::Strike;
        }
        Ok(())
    }

    /// Back along the path for the operator, as far as it is remembered, and not beyond where the arc was lit.
    pub(super) fn back_up(&mut self, speed: f64) -> Result<(), Fault> {
        let bead = self.program.place().mark.arc.then(|| self.program.bead());
        if self.back(bead.unwrap_or(f64::INFINITY), speed)? {
            self.apply(Event::AtRest);
        }
        Ok(())
    }

    /// One cycle back along the path; true when the arm rests, so many metres further back or where the path is no longer known.
    fn back(&mut self, left: f64, speed: f64) -> Result<bool, Fault> {
        let (stopping, planned) = self.program.stopping();
        let enough = left <= stopping.max(NEAR) || self.program.remembered() < REMEMBERED;
        // Slower and slower, so that the end is met.
        let fastest = self.config.arc.back_speed.min(left / APPROACH);
        let fast = if planned > 0.0 { fastest / planned } else { 1.0 };
        self.retreat(if enough { 0.0 } else { speed.min(fast) })?;
        Ok(enough && self.is_at_rest())
    }

    /// One cycle of what lies between the word to go on and the motion of the job.
    pub(super) fn resume(&mut self) -> Result<(), Fault> {
        match &mut self.resume {
            Resume::Return => match self.off_path {
                None => {
                    let path = self.program.joints(&self.kinematics)?.position;
                    self.off_path = Some(OffPath::back_to(path, &self.command, &self.config.limits));
                }
                Some(way) if way.is_done() => {
                    self.come_back();
                    self.resume = Resume::Settle;
                }
                Some(_) => {}
            },
            Resume::Settle => self.settle(),
            Resume::Back => {}
            Resume::Strike if self.arc.burns() => {
                self.resume = Resume::Dwell { left: self.config.arc.restart_dwell };
            }
            Resume::Strike => {}
            Resume::Dwell { left } => {
                *left -= self.config.period;
                if *left <= 0.5 * self.config.period {
                    self.apply(Event::Ready);
                }
            }
        }
        Ok(())
    }
}
