//! The arc: struck, watched, and struck again where it does not light.

use crate::safety::Fault;

/// How the arc is handled. Seconds, metres, metres per second.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ArcRules {
    /// Nothing is lit: the job runs dry.
    pub dry: bool,
    /// Time that a strike may take.
    pub strike: f64,
    /// How often it is tried.
    pub strikes: u32,
    /// Time without current between two tries.
    pub pause: f64,
    /// Time without arc that counts as its loss.
    pub loss: f64,
    /// After an interruption the torch goes so far back along the bead before the arc is lit again.
    pub overlap: f64,
    /// How fast it goes back.
    pub back_speed: f64,
    /// Time to stand after the arc is lit again.
    pub restart_dwell: f64,
    /// The override stays at 100 % while the arc burns.
    pub lock_override: bool,
}

impl ArcRules {
    /// No delays, no overlap, no lock: a source that is believed.
    pub const PLAIN: Self = Self {
        dry: false,
        strike: 1.0,
        strikes: 1,
        pause: 0.0,
        loss: 0.05,
        overlap: 0.0,
        back_speed: 0.02,
        restart_dwell: 0.0,
        lock_override: false,
    };
}

/// The arc's own state.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Arc {
    /// Out, and to be so.
    Out,
    /// Current is on, and the arc does not burn yet.
    Striking { tries: u32, elapsed: f64 },
    /// Between two tries.
    Pausing { tries: u32, elapsed: f64 },
    /// It burns; so long it has been seen out.
    Burning { out_for: f64 },
}

impl Arc {
    /// One cycle: whether the arc is wanted, and what the source says.
    ///
    /// # Errors
    /// [`Fault::ArcNotLit`] after the last try, [`Fault::ArcLost`] where it went out.
    pub(super) fn step(
        &mut self,
        wanted: bool,
        burning: Option<bool>,
        rules: &ArcRules,
        period: f64,
    ) -> Result<(), Fault> {
        if !wanted {
            *self = Self::Out;
            return Ok(());
        }
        let believed = burning.is_none() || rules.dry;
        let burning = believed || burning == Some(true);
        *self = match *self {
            Self::Out if believed => Self::Burning { out_for: 0.0 },
            Self::Out => Self::Striking { tries: 1, elapsed: 0.0 },
            Self::Striking { .. } if burning => Self::Burning { out_for: 0.0 },
            Self::Striking { tries, elapsed } if elapsed < rules.strike => {
                Self::Striking { tries, elapsed: elapsed + period }
            }
            Self::Striking { tries, .. } if tries < rules.strikes => Self::Pausing { tries, elapsed: 0.0 },
            Self::Striking { tries, .. } => return Err(Fault::ArcNotLit { tries }),
            Self::Pausing { tries, elapsed } if elapsed < rules.pause => {
                Self::Pausing { tries, elapsed: elapsed + period }
            }
            Self::Pausing { tries, .. } => Self::Striking { tries: tries + 1, elapsed: 0.0 },
            Self::Burning { .. } if burning => Self::Burning { out_for: 0.0 },
            Self::Burning { out_for } if out_for < rules.loss => Self::Burning { out_for: out_for + period },
            Self::Burning { out_for } => return Err(Fault::ArcLost { seconds: out_for }),
        };
        Ok(())
    }

    /// The source shall deliver current.
    pub(super) fn has_current(&self) -> bool {
        matches!(self, Self::Striking { .. } | Self::Burning { .. })
    }

    pub(super) fn burns(&self) -> bool {
        matches!(self, Self::Burning { .. })
    }

    /// It burns, and the source says so.
    pub(super) fn is_seen(&self) -> bool {
        matches!(self, Self::Burning { out_for: 0.0 })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const RULES: ArcRules = ArcRules { strike: 0.2, strikes: 3, pause: 0.1, ..ArcRules::PLAIN };

    /// Cycles until something other than `from` happens.
    fn run(arc: &mut Arc, burning: bool, rules: &ArcRules, cycles: u32) -> Result<(), Fault> {
        (0..cycles).try_for_each(|_| arc.step(true, Some(burning), rules, 1e-3))
    }

    #[test]
    fn it_is_struck_as_often_as_the_rules_say() {
        let mut arc = Arc::Out;
        let mut strikes = 0;
        let fault = (0..2_000).find_map(|_| {
            let before = arc.has_current();
            let result = arc.step(true, Some(false), &RULES, 1e-3);
            strikes += u32::from(arc.has_current() && !before);
            result.err()
        });
        assert_eq!((fault, strikes), (Some(Fault::ArcNotLit { tries: 3 }), 3));
    }

    #[test]
    fn a_late_arc_burns_and_a_flicker_is_no_loss() {
        let mut arc = Arc::Out;
        run(&mut arc, false, &RULES, 250).unwrap();
        assert!(!arc.burns());
        run(&mut arc, true, &RULES, 200).unwrap();
        assert!(arc.burns());
        run(&mut arc, false, &RULES, 50).unwrap();
        run(&mut arc, true, &RULES, 1).unwrap();
        let lost = run(&mut arc, false, &RULES, 60).unwrap_err();
        assert!(matches!(lost, Fault::ArcLost { seconds } if (0.05..0.052).contains(&seconds)), "{lost:?}");
    }

    #[test]
    fn a_source_without_signal_is_believed_and_a_dry_run_lights_nothing() {
        let mut arc = Arc::Out;
        for _ in 0..3 {
            arc.step(true, None, &ArcRules::PLAIN, 1e-3).unwrap();
        }
        assert!(arc.burns());
        let dry = ArcRules { dry: true, ..RULES };
        let mut arc = Arc::Out;
        run(&mut arc, false, &dry, 1_000).unwrap();
        assert!(arc.burns());
        arc.step(false, Some(true), &dry, 1e-3).unwrap();
        assert_eq!(arc, Arc::Out);
    }
}
