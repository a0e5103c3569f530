//! The motion asked for, at any instant.

use seamline::otg::Sample;
use seamline::timed::{Activity, Command, Planned, TimedMotion, TimedProfile};

use super::Arguments;

/// One axis that gets a target, and perhaps another one.
pub(super) struct Run {
    pub(super) profile: TimedProfile<1>,
    first: TimedMotion<1>,
    pub(super) retarget: Option<Retarget>,
    /// When the axis has reached its last target.
    pub(super) end: f64,
}

/// The new target and what it has led to.
pub(super) struct Retarget {
    pub(super) at: f64,
    pub(super) target: f64,
    pub(super) planned: Planned<1>,
    motion: TimedMotion<1>,
}

impl Run {
    pub(super) fn new(arguments: &Arguments) -> anyhow::Result<Self> {
        let &Arguments { from_mm, to_mm, time, n, retarget_at, retarget_to_mm, mode, .. } = arguments;
        let profile = TimedProfile::new([from_mm], [to_mm], time, n)?;
        let mut first = TimedMotion::new([from_mm], mode.into())?;
        first.set_target(0.0, &Command { target: [to_mm], duration: time, n })?;
        let (mut retarget, mut end) = (None, time);
        if let (Some(at), Some(target)) = (retarget_at, retarget_to_mm) {
            let mut motion = first;
            let planned = motion.set_target(at, &Command { target: [target], duration: time, n })?;
            end = arrival(at, planned.duration);
            retarget = Some(Retarget { at, target, planned, motion });
        }
        Ok(Self { profile, first, retarget, end })
    }

    /// What the axis does at an instant.
    pub(super) fn at(&self, time: f64) -> (Activity, Sample<1>) {
        match &self.retarget {
            Some(retarget) if time >= retarget.at => look(retarget.motion, time),
            _ => look(self.first, time),
        }
    }

    /// What the axis does when the new target comes.
    pub(super) fn before(&self, retarget: &Retarget) -> (Activity, Sample<1>) {
        look(self.first, retarget.at)
    }

    /// `count` instants at equal intervals, from the start to the end.
    pub(super) fn instants(&self, count: u32) -> impl Iterator<Item = f64> + use<> {
        let (end, last) = (self.end, count.saturating_sub(1));
        (0..count)
            .map(move |k| if k == last && k > 0 { end } else { end * f64::from(k) / f64::from(last.max(1)) })
    }
}

/// A look ahead changes nothing: the motion is a copy.
fn look(mut motion: TimedMotion<1>, time: f64) -> (Activity, Sample<1>) {
    let sample = motion.at(time);
    (motion.activity(), sample)
}

/// The first instant that is `duration` after `start` also when `start` is subtracted again.
fn arrival(start: f64, duration: f64) -> f64 {
    let end = start + duration;
    if end - start < duration { end.next_up() } else { end }
}
