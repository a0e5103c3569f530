//! What the operator should know about a motion before it starts: where it is slower than programmed, why, and what would help.

use seamline::path::{Measure, Path};

use super::arm::PlanningArm;
use super::error::{Place, Problem};
use super::planner::Planner;
use super::route::Route;
use super::run::Piece;
use super::smear::{Cap, least};
use super::suggest::Trouble;
use super::timing::{Order, Slowdown, Timing, TimingKind};
use crate::record::SegmentKind;

/// A run that is stretched by more than this is refused.
const STRETCH_MAX: f64 = 50.0;
pub(super) const NO_USEFUL_SPEED: &str =
    "the path passes so near to a singularity that no useful speed is left";

/// Remarks on the pieces of a run.
#[derive(Debug, Clone, Default)]
pub(super) struct Remarks {
    /// Number of the piece, and the text.
    texts: Vec<(usize, Vec<String>)>,
}

impl Remarks {
    /// The remarks on the motion before `end`; `caps` are the speeds that prefilters permit.
    ///
    /// # Errors
    /// The number of a piece and what is refused about it.
    pub(super) fn new<const N: usize, K: PlanningArm<N>>(
        planner: &Planner<'_, N, K>,
        route: &Route,
        timing: &Timing,
        caps: &[Cap],
        end: f64,
    ) -> Result<Self, (usize, Problem)> {
        let mut remarks = Self::default();
        for slowdown in timing.slowdowns().iter().filter(|slowdown| slowdown.from < end) {
            let (index, _) = route.locate(slowdown.place);
            let Some(piece) = planner.run.piece(index) else { continue };
            let on_link = shifted(slowdown, piece.offset - route.start_of(index), &piece.link.path);
            let permitted = piece.limits.speed.min(least(caps, slowdown.place, slowdown.place));
            let text =
                planner.slowdown_text(piece, &on_link, permitted).map_err(|problem| (index, problem))?;
            remarks.add(index, text);
        }
        if timing.kind() == TimingKind::Stretched {
            remarks.add_stretch(planner, route, timing)?;
        }
        Ok(remarks)
    }

    /// The remarks on a piece.
    pub(super) fn of(&self, index: usize) -> &[String] {
        self.texts.iter().find(|(of, _)| *of == index).map_or(&[], |(_, texts)| texts)
    }

    pub(super) fn add(&mut self, index: usize, text: String) {
        match self.texts.iter_mut().find(|(of, _)| *of == index) {
            Some((_, texts)) => texts.push(text),
            None => self.texts.push((index, vec![text])),
        }
    }

    /// No optimum was found: the whole takes longer. Bearable up to a point, and then a problem.
    fn add_stretch<const N: usize, K: PlanningArm<N>>(
        &mut self,
        planner: &Planner<'_, N, K>,
        route: &Route,
        timing: &Timing,
    ) -> Result<(), (usize, Problem)> {
        let nominal = |(index, path): (usize, &Path)| {
            let limits = planner.run.piece(index).map(|piece| piece.limits);
            limits.map_or(0.0, |limits| {
                path.length() / limits.speed
                    + limits.speed / limits.acceleration
                    + limits.acceleration / limits.jerk
            })
        };
        let times = timing.duration() / route.paths().iter().enumerate().map(nominal).sum::<f64>();
        let place = timing.slowdowns().first().map_or(0.0, |slowdown| slowdown.place);
        let (index, local) = route.locate(place);
        if times <= STRETCH_MAX {
            let text = "the whole move takes {times:.1} times as long as programmed: its joints leave no better speed";
            self.add(index, text.replace("{times:.1}", &format!("{times:.1}")));
            return Ok(());
        }
        let Some(piece) = planner.run.piece(index) else { return Ok(()) };
        let trouble = planner.trouble(piece);
        Err((index, path_problem(&piece.link.path, piece.offset + local, NO_USEFUL_SPEED, &trouble)))
    }
}

/// A slowdown in the coordinate of a link.
fn shifted(slowdown: &Slowdown, by: f64, path: &Path) -> Slowdown {
    let on_link = |s: f64| (s + by).clamp(0.0, path.length());
    Slowdown {
        from: on_link(slowdown.from),
        to: on_link(slowdown.to),
        place: on_link(slowdown.place),
        ..*slowdown
    }
}

impl<const N: usize, K: PlanningArm<N>> Planner<'_, N, K> {
    /// A slowdown from a speed in words, with what would keep that. With the arc on it may be refused.
    fn slowdown_text(&self, piece: &Piece<N>, slowdown: &Slowdown, speed: f64) -> Result<String, Problem> {
        let path = &piece.link.path;
        let (unit, speed_unit, factor) = units(path);
        let order = match slowdown.order {
            Order::Velocity => "speed",
            Order::Acceleration => "acceleration",
            Order::Jerk => "jerk",
        };
        let mut text = format!(
            "slows from {:.1} to {:.1} {speed_unit} between {:.1} and {:.1} {unit} (least at {:.1} {unit}){}: \
             joint {} is at its {order} limit",
            speed * factor,
            slowdown.speed * factor,
            slowdown.from * factor,
            slowdown.to * factor,
            slowdown.place * factor,
            if piece.info.arc { " with the arc on" } else { "" },
            self.arm.joint_names[slowdown.joint],
        );
        if slowdown.sustainable < speed {
            let held = slowdown.sustainable * factor;
            text += &format!("; {held:.1} {speed_unit} could be held all along");
            // A corner is the same in any configuration.
            if matches!(piece.info.kind, SegmentKind::Path(_)) {
                text += &self.trouble(piece).remedy();
            }
        }
        if self.refuses_slowdown(piece, slowdown.speed) {
            return Err(Problem::WeldSlowdown(text));
        }
        Ok(text)
    }

    /// Whether the cell refuses a weld that is as slow as this.
    pub(super) fn refuses_slowdown(&self, piece: &Piece<N>, speed: f64) -> bool {
        let policy = &self.cell.arc;
        let matters = speed < piece.limits.speed * (1.0 - policy.speed_tolerance);
        piece.info.arc && policy.refuse_slowdown && matters
    }
}

/// A problem at a place of a path, with what would solve it.
pub(super) fn path_problem<const N: usize, K: PlanningArm<N>>(
    path: &Path,
    s: f64,
    reason: &str,
    trouble: &Trouble<'_, N, K>,
) -> Problem {
    let remedy = trouble.remedy();
    let (unit, _, factor) = units(path);
    let place = Place { at: s.clamp(0.0, path.length()) * factor, of: path.length() * factor, unit };
    Problem::Path { place, reason: format!("{reason}{remedy}") }
}

/// Unit of length, unit of speed, and the factor from SI to them.
pub(super) fn units(path: &Path) -> (&'static str, &'static str, f64) {
    match path.measure() {
        Measure::Length => ("mm", "mm/s", 1000.0),
        Measure::Angle => ("deg", "deg/s", 1_f64.to_degrees()),
    }
}
