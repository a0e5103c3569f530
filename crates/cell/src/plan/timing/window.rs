//! One window of the path: the fastest motion through it.

use super::anchor::{Anchor, anchors, bent};
use super::check::{Check, Load};
use super::coordinate::{Coordinate, End};
use super::course::Limits;
use super::interior_point::InteriorPoint;
use super::motion::{PathState, TimingPiece, duration, joining, paced};
use super::program::{Demand, Program};
use super::{JointPath, TimingError, TimingLimits, crude};

/// Distance of knots in seconds: on the first guess, and on the motion.
const COARSE_STEP: f64 = 16e-3;
const STEP: f64 = 5e-3;
/// How near the optimum the solver goes, as a share of the duration.
const COARSE_ACCURACY: f64 = 5e-2;
const ACCURACY: f64 = 5e-4;
/// Rounds that lower limits where the motion passes them between sites.
const REPAIRS: usize = 8;
/// A motion that has to be stretched by less than this is good enough.
const STRETCH: f64 = 1.0005;
/// A motion that has to be stretched by more than this is not good enough to be eased: its window was too narrow.
const LAST_STRETCH: f64 = 1.003;
/// Rounds of easing, and the time in which it comes and goes at an end in motion.
const EASINGS: usize = 3;
const EASING: f64 = 0.04;
/// What may be left, for the first moments of a cruise that easing does not reach; and what rounding may add.
const LEFT: f64 = 1e-5;
pub(super) const ROUNDING: f64 = 1e-9;
/// Shares of a limit that a repair leaves: what it aims at, and the least.
const AIM: f64 = 0.9995;
const LEAST_SHARE: f64 = 0.2;
/// Slack of the speed limit at a held end; sites next to it whose speed limit is lowered by no more than it is passed by, where its
/// speed is this share of the limit or more.
const AT_LIMIT: f64 = 0.9995;
const HELD_SLACK: f64 = 0.01;
const HELD_SITES: usize = 20;

/// A stretch of the path that is solved by itself.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Window {
    pub(super) from: f64,
    pub(super) to: f64,
    pub(super) ends: [End; 2],
}

/// A motion through a window, and the factor on time that it still needs.
pub(super) struct Passage {
    pub(super) pieces: Vec<TimingPiece>,
    pub(super) stretch: f64,
    /// Places inside where the motion is held without acceleration, and nothing before depends on what comes after.
    pub(super) anchors: Vec<f64>,
}

impl Passage {
    /// No motion was found.
    pub(super) const NONE: Self = Self { pieces: Vec::new(), stretch: f64::INFINITY, anchors: Vec::new() };

    /// Whether it keeps all limits as it is.
    pub(super) fn good(&self) -> bool {
        self.stretch <= 1.0 + LEFT
    }

    /// Takes the stretching upon itself: the motion becomes slower all along, but not at ends in motion.
    fn ease<const N: usize, P: JointPath<N>>(
        &mut self,
        path: &mut P,
        joints: &TimingLimits<N>,
        limits: &Limits,
        window: &Window,
    ) -> Result<(), TimingError<P::Error>> {
        let fast = self.pieces.clone();
        let mut factor = 1.0;
        for _ in 0..EASINGS {
            if self.stretch <= 1.0 + ROUNDING {
                break;
            }
            factor *= self.stretch;
            self.pieces = eased(&fast, factor, window);
            self.stretch = judged(path, joints, limits, &self.pieces)?.1;
        }
        Ok(())
    }

    /// Duration with the stretching.
    pub(super) fn duration(&self) -> f64 {
        if self.pieces.is_empty() { f64::INFINITY } else { duration(&self.pieces) * self.stretch }
    }
}

/// The memory of the solver, reused from window to window.
#[derive(Debug, Default)]
pub(super) struct Workshop {
    solver: InteriorPoint,
    program: Program,
    /// Derivatives with respect to w, per site and axis.
    derivatives: Vec<[f64; 3]>,
    /// Limits of the path per site.
    path_limits: Vec<[f64; 3]>,
    /// Share of each limit that is used, per site, axis and order.
    shares: Vec<[f64; 3]>,
}

impl Workshop {
    /// The fastest motion through the window that was found: on the coordinate of the first guess roughly,
    /// then on the coordinate of that motion, from anchor to anchor. `braking`: as for [`anchors`].
    pub(super) fn pass<const N: usize, P: JointPath<N>>(
        &mut self,
        path: &mut P,
        joints: &TimingLimits<N>,
        limits: &Limits,
        window: &Window,
        braking: Option<f64>,
    ) -> Result<Passage, TimingError<P::Error>> {
        let coarse = crude::coordinate(path, joints, limits, window, COARSE_STEP)?;
        self.set_sites(path, limits, window, &coarse)?;
        self.set_demands(joints, window, coarse.step);
        let solved = self.solver.solve(&self.program, COARSE_ACCURACY);
        let Some(rough) = self.pieces(solved, &coarse, window) else {
            return Ok(Passage::NONE);
        };
        let mut cuts = vec![Anchor { piece: 0, place: window.from, speed: window.ends[0].speed() }];
        cuts.extend(anchors(path, joints, limits, &rough, braking)?);
        cuts.push(Anchor { piece: rough.len(), place: window.to, speed: window.ends[1].speed() });
        let mut passages: Vec<Passage> = Vec::new();
        // Each turn finishes a part, or takes one anchor away.
        while let [from, to] = cuts[passages.len()..][..2] {
            let part =
                Window { from: from.place, to: to.place, ends: [End::at(from.speed), End::at(to.speed)] };
            let rough = &rough[from.piece..to.piece];
            let guess = if cuts.len() == 2 { rough.to_vec() } else { bent(rough, part.ends) };
            let passage = self.refined(path, joints, limits, &part, &guess)?;
            let (first, last) = (passages.is_empty(), passages.len() + 2 == cuts.len());
            if passage.good() || (first && last) {
                passages.push(passage);
                if last {
                    break;
                }
            } else if last {
                passages.pop();
                cuts.remove(passages.len() + 1);
            } else {
                cuts.remove(passages.len() + 1);
            }
        }
        let anchors = cuts[1..cuts.len() - 1].iter().map(|anchor| anchor.place).collect();
        let stretch = passages.iter().fold(1.0, |most: f64, passage| most.max(passage.stretch));
        let pieces = passages.into_iter().flat_map(|passage| passage.pieces).collect();
        Ok(Passage { pieces, stretch, anchors })
    }

    /// The fastest motion on the coordinate of a guess, with limits lowered until the judge is content.
    fn refined<const N: usize, P: JointPath<N>>(
        &mut self,
        path: &mut P,
        joints: &TimingLimits<N>,
        limits: &Limits,
        window: &Window,
        guess: &[TimingPiece],
    ) -> Result<Passage, TimingError<P::Error>> {
        let knots = crude::knots(duration(guess), STEP);
        let coordinate = Coordinate::following(guess, knots, window.ends);
        self.set_sites(path, limits, window, &coordinate)?;
        let mut best = Passage::NONE;
        for round in 0..=REPAIRS {
            self.set_demands(joints, window, coordinate.step);
            let solved = match round {
                0 => self.solver.solve(&self.program, ACCURACY),
                _ => self.solver.solve_again(&self.program, ACCURACY),
            };
            let pieces = self.pieces(solved, &coordinate, window);
            let Some(pieces) = pieces.filter(|pieces| pieces.iter().all(goes_on)) else { break };
            let (loads, stretch) = judged(path, joints, limits, &pieces)?;
            let mut passage = Passage { pieces, stretch, anchors: Vec::new() };
            if stretch <= STRETCH {
                passage.ease(path, joints, limits, window)?;
            }
            if passage.good() {
                return Ok(passage);
            }
            if passage.duration() < best.duration() {
                best = passage;
            }
            self.tighten(&loads, window, N + 1);
        }
        if best.stretch > STRETCH && best.stretch <= LAST_STRETCH {
            best.ease(path, joints, limits, window)?;
        }
        Ok(best)
    }

    /// Derivatives of all axes at all sites, and whole limits.
    fn set_sites<const N: usize, P: JointPath<N>>(
        &mut self,
        path: &mut P,
        limits: &Limits,
        window: &Window,
        coordinate: &Coordinate,
    ) -> Result<(), TimingError<P::Error>> {
        self.derivatives.clear();
        self.path_limits.clear();
        let place = |site: usize| coordinate.at(site).s.clamp(window.from, window.to);
        let last = coordinate.sites() - 1;
        for site in 0..coordinate.sites() {
            let w = coordinate.at(site);
            let s = w.s.clamp(window.from, window.to);
            let jet = path.jet(s).map_err(|error| TimingError::Path { position: s, error })?;
            for i in 0..N {
                let (d1, d2, d3) = (jet.velocity[i], jet.acceleration[i], jet.jerk[i]);
                self.derivatives.push([
                    d1 * w.d1,
                    d2 * w.d1 * w.d1 + d1 * w.d2,
                    d3 * w.d1 * w.d1 * w.d1 + 3.0 * d2 * w.d1 * w.d2 + d1 * w.d3,
                ]);
            }
            self.derivatives.push([w.d1, w.d2, w.d3]);
            // What holds between two sites has to be kept at both.
            let around = limits.within(place(site.saturating_sub(1)), place((site + 1).min(last)));
            self.path_limits.push([around.speed, around.acceleration, around.jerk]);
        }
        self.shares.clear();
        self.shares.resize(self.derivatives.len(), [1.0; 3]);
        // At a held end the speed may be the programmed one, and no unknown can change it.
        for (end, site) in window.ends.into_iter().zip([0, last]) {
            if !end.rests() {
                self.shares[site * (N + 1) + N][0] = 1.0 + HELD_SLACK;
            }
        }
        Ok(())
    }

    fn set_demands<const N: usize>(&mut self, joints: &TimingLimits<N>, window: &Window, step: f64) {
        let Program { demands, axes, held } = &mut self.program;
        *axes = N + 1;
        *held = window.ends.map(|end| !end.rests());
        demands.clear();
        for (index, (derivatives, shares)) in self.derivatives.iter().zip(&self.shares).enumerate() {
            let limits = match index % (N + 1) {
                i if i < N => [joints.velocity[i], joints.acceleration[i], joints.jerk[i]],
                _ => self.path_limits[index / (N + 1)],
            };
            demands.push(Demand::new(*derivatives, scaled(limits, *shares), step));
        }
    }

    /// The motion in time that the solution stands for: one piece between two knots. None where it makes no
    /// sense.
    fn pieces(&self, solved: bool, coordinate: &Coordinate, window: &Window) -> Option<Vec<TimingPiece>> {
        if !solved {
            return None;
        }
        let controls = self.solver.controls();
        let step = coordinate.step;
        let last = coordinate.knots() - 1;
        let state = |knot: usize| {
            let w = coordinate.at(2 * knot);
            let [a, b, c] = [controls[knot], controls[knot + 1], controls[knot + 2]];
            let beta = (a + 4.0 * b + c) / 6.0;
            let slope = (c - a) / (2.0 * step);
            let mut state = PathState {
                position: w.s,
                velocity: w.d1 * beta.sqrt(),
                acceleration: w.d2 * beta + w.d1 * slope / 2.0,
                jerk: 0.0,
            };
            if knot == 0 || knot == last {
                let place = if knot == 0 { window.from } else { window.to };
                let end = if knot == 0 { window.ends[0] } else { window.ends[1] };
                state = PathState { position: place, velocity: end.speed(), ..PathState::default() };
            }
            state
        };
        let mut start = state(0);
        (0..last)
            .map(|knot| {
                let end = state(knot + 1);
                let piece = joining(&start, &end, step * time_between(&controls[knot..knot + 4]));
                start = end;
                let sound = piece.duration > 0.0 && piece.duration.is_finite() && start.velocity >= 0.0;
                sound.then_some(piece)
            })
            .collect()
    }

    /// Lowers the limits of both sites around half a piece by what it takes too much.
    fn tighten<const N: usize>(&mut self, loads: &[Load<N>], window: &Window, axes: usize) {
        let held = window.ends.map(|end| !end.rests());
        let limits = [self.path_limits.first(), self.path_limits.last()];
        let at_limit: [bool; 2] = core::array::from_fn(|end| {
            limits[end].is_some_and(|limits| window.ends[end].speed() > AT_LIMIT * limits[0])
        });
        for (half, load) in loads.iter().enumerate() {
            let near_held =
                (at_limit[0] && half < HELD_SITES) || (at_limit[1] && half + HELD_SITES >= loads.len());
            for axis in 0..axes {
                for order in 0..3 {
                    let share = if axis < N { load.joints[order][axis] } else { load.path[order] };
                    let (passed, aim) =
                        if near_held && axis == N && order == 0 { (1.0 + LEFT, 1.0) } else { (AIM, AIM) };
                    if share <= passed {
                        continue;
                    }
                    for site in [half, half + 1] {
                        if (held[0] && site == 0) || (held[1] && site == loads.len()) {
                            continue;
                        }
                        let used = &mut self.shares[site * axes + axis][order];
                        *used = (*used * aim / share).max(LEAST_SHARE);
                    }
                }
            }
        }
    }
}

/// Whether a piece that goes on at both ends does not turn back between them, where it nearly stops.
fn goes_on(piece: &TimingPiece) -> bool {
    piece.at(piece.duration / 2.0).velocity > 0.0
}

/// The loads of all half pieces, and the factor on time that they ask for.
fn judged<const N: usize, P: JointPath<N>>(
    path: &mut P,
    joints: &TimingLimits<N>,
    limits: &Limits,
    pieces: &[TimingPiece],
) -> Result<(Vec<Load<N>>, f64), TimingError<P::Error>> {
    let mut check = Check::new(path, joints, limits);
    let mut loads = Vec::with_capacity(2 * pieces.len());
    for piece in pieces {
        loads.extend(check.halves(piece)?);
    }
    let load = loads.iter().fold(Load::NONE, |most, load| most.raised(load));
    Ok((loads, load.stretch().max(1.0)))
}

/// The pieces at 1/`factor` of their pace, which comes and goes smoothly at ends in motion.
fn eased(pieces: &[TimingPiece], factor: f64, window: &Window) -> Vec<TimingPiece> {
    let whole = duration(pieces);
    let width = EASING.min(whole / 2.0);
    let [first, last] = window.ends.map(|end| !end.rests());
    paced(pieces, |time| {
        let step = |held: bool, time: f64| {
            let x = if held { (time / width).clamp(0.0, 1.0) } else { 1.0 };
            [x * x * x * (10.0 - 15.0 * x + 6.0 * x * x), 30.0 * x * x * (1.0 - x) * (1.0 - x) / width]
        };
        let ([rise, rising], [fall, falling]) = (step(first, time), step(last, whole - time));
        let loss = 1.0 - 1.0 / factor;
        [1.0 - loss * rise * fall, loss * (rise * falling - rising * fall)]
    })
}

fn scaled(limits: [f64; 3], shares: [f64; 3]) -> [f64; 3] {
    core::array::from_fn(|order| limits[order] * shares[order])
}

/// ∫ β^(−1/2) over one interval between knots, in knots: Gauss's rule with four nodes, of which β sees a
/// cubic.
fn time_between(controls: &[f64]) -> f64 {
    const NODES: [(f64, f64); 4] = [
        (0.069_431_844_202_973_7, 0.173_927_422_568_726_93),
        (0.330_009_478_207_571_87, 0.326_072_577_431_273_07),
        (0.669_990_521_792_428_1, 0.326_072_577_431_273_07),
        (0.930_568_155_797_026_3, 0.173_927_422_568_726_93),
    ];
    NODES
        .iter()
        .map(|&(x, weight)| {
            let y = 1.0 - x;
            let beta = (y * y * y * controls[0]
                + (3.0 * x * x * x - 6.0 * x * x + 4.0) * controls[1]
                + (3.0 * y * y * y - 6.0 * y * y + 4.0) * controls[2]
                + x * x * x * controls[3])
                / 6.0;
            weight / beta.sqrt()
        })
        .sum()
}
