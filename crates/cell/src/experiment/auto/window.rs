//! The motion through one corner, or away from the start, or to the end, in the least time: a convex program.
//!
//! A window begins and ends in cruise (or at rest at the path's ends). In it, the way on the first segment ends and the way on the second
//! begins; both are free functions of time. Feedrates are straight within a step, so that the command's acceleration is constant there and
//! the tool's acceleration is exact at each step. What is lost against cruising through the corner is linear in the feedrates, and all that
//! must be kept is convex. On a curve the directions are those of the solution before; a few rounds settle them.

use nalgebra::Vector2;
use seamline::path::Path;
use seamline::vibration::Mode;

use super::program::{Affine, Program};
use super::tool::ToolStep;

/// Rounds for a curved segment; a straight one needs a single one.
const ROUNDS: usize = 5;
/// Cost of a change of the command's acceleration by the bound from step to step, in steps: enough to keep the command from chattering, and
/// below a millisecond a corner.
const CHATTER: f64 = 1e-3;
/// Where within the drift the tool must be quiet: in between it is quieter, or hardly louder.
const DRIFTS: [f64; 4] = [-1.0, -0.5, 0.5, 1.0];
/// Corner errors below this are a stop in the corner, in metres.
const STOP: f64 = 1e-7;

/// What every window keeps.
#[derive(Debug, Clone, Copy)]
pub(super) struct Kept {
    /// The tool's greatest acceleration, in m/s².
    pub(super) acceleration: f64,
    /// The command's greatest acceleration, in m/s².
    pub(super) command: f64,
    /// Greatest change of that acceleration from step to step, in m/s³; may be infinite.
    pub(super) jerk: f64,
    /// Corner error, in metres.
    pub(super) corner_error: f64,
    /// Amplitude of the vibration that is left at the end, in m/s².
    pub(super) residual: f64,
    /// The mode's frequency may be another, by this fraction up or down.
    pub(super) drift: f64,
    /// Amplitude of the vibration that is left then, in m/s².
    pub(super) drifted_residual: f64,
}

/// One segment's part in a window.
#[derive(Debug, Clone, Copy)]
pub(super) struct Side<'a> {
    pub(super) path: &'a Path,
    /// In cruise, in m/s.
    pub(super) feedrate: f64,
    /// Steps of the window on this side of the corner.
    pub(super) steps: usize,
    /// The way that it may take, in metres.
    pub(super) room: f64,
}

/// A stretch of time around a corner, the start (no first segment), or the end (no second).
#[derive(Debug, Clone, Copy)]
pub(super) struct Window<'a> {
    pub(super) mode: &'a Mode,
    pub(super) kept: Kept,
    /// Cost of the tool's acceleration squared, over the bound, in steps a step.
    pub(super) calm: f64,
    /// In seconds.
    pub(super) step: f64,
    pub(super) first: Option<Side<'a>>,
    pub(super) second: Option<Side<'a>>,
}

/// Feedrate on one segment over its cruise, at each step's ends, and the way since the window's start, in metres.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Course {
    pub(super) feedrates: Vec<f64>,
    pub(super) ways: Vec<f64>,
}

impl Course {
    fn new(feedrates: Vec<f64>, cruise: f64, step: f64) -> Self {
        let mut way = 0.0;
        let mut ways = vec![0.0];
        for pair in feedrates.windows(2) {
            way += 0.5 * step * cruise * (pair[0] + pair[1]);
            ways.push(way);
        }
        Self { feedrates, ways }
    }

    /// The way over the whole window.
    pub(super) fn whole(&self) -> f64 {
        self.ways.last().copied().unwrap_or(0.0)
    }
}

/// Both segments' courses through a window.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Courses {
    pub(super) first: Option<Course>,
    pub(super) second: Option<Course>,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Part {
    First,
    Second,
}

/// A side with its unknowns, and the directions that belong to a course.
struct Laid<'a> {
    part: Part,
    side: Side<'a>,
    course: &'a Course,
    /// First of the unknown feedrates, over the cruise: one more than steps.
    feedrate: usize,
    /// First of the unknown accelerations, over the bound.
    acceleration: usize,
}

impl Window<'_> {
    /// The courses of least time; nothing where the window is too short for any.
    pub(super) fn solve(&self) -> Option<Courses> {
        let mut courses = self.guess();
        let curved =
            |side: &Option<Side<'_>>| side.is_some_and(|s| s.path.curve().greatest_curvature() > 0.0);
        let rounds = if curved(&self.first) || curved(&self.second) { ROUNDS } else { 1 };
        for _ in 0..rounds {
            courses = self.round(&courses)?;
        }
        Some(courses)
    }

    pub(super) fn steps(&self) -> usize {
        self.corner() + self.second.map_or(0, |side| side.steps)
    }

    /// The step at whose start the command is as near to the corner as it must be.
    fn corner(&self) -> usize {
        self.first.map_or(0, |side| side.steps)
    }

    /// Straight ramps, to know about where on a curve a segment is.
    fn guess(&self) -> Courses {
        let (corner, steps) = (self.corner(), self.steps());
        let ramp = |from: usize, count: usize, at: usize| {
            (at.saturating_sub(from) as f64 / count.max(1) as f64).min(1.0)
        };
        let course = |side: Side<'_>, feedrate: &dyn Fn(usize) -> f64| {
            Course::new((0..=steps).map(feedrate).collect(), side.feedrate, self.step)
        };
        Courses {
            first: self.first.map(|side| course(side, &|at| 1.0 - ramp(0, corner, at))),
            second: self.second.map(|side| course(side, &|at| ramp(corner, steps - corner, at))),
        }
    }

    fn round(&self, courses: &Courses) -> Option<Courses> {
        let mut program = Program::default();
        let steps = self.steps();
        let mut sides = Vec::with_capacity(2);
        let parts = [(Part::First, self.first, &courses.first), (Part::Second, self.second, &courses.second)];
        for (part, side, course) in parts {
            if let (Some(side), Some(course)) = (side, course) {
                let feedrate = program.unknowns(steps + 1);
                let acceleration = program.unknowns(steps);
                sides.push(Laid { part, side, course, feedrate, acceleration });
            }
        }
        for laid in &sides {
            self.drive(&mut program, laid);
        }
        self.tool(&mut program, &sides);
        self.changes(&mut program, &sides);
        self.drifted(&mut program, &sides);
        if let [first, second] = sides.as_slice() {
            self.near(&mut program, first, second);
            self.speed(&mut program, first, second);
        }
        let found = program.solve()?;
        let course = |part: Part| {
            let laid = sides.iter().find(|laid| laid.part == part)?;
            let mut feedrates: Vec<f64> =
                found.get(laid.feedrate..=laid.feedrate + steps)?.iter().map(|v| v.clamp(0.0, 1.0)).collect();
            // The ends hold but for the solver's tolerance.
            let ends = laid.ends();
            feedrates[0] = ends[0];
            feedrates[steps] = ends[1];
            Some(Course::new(feedrates, laid.side.feedrate, self.step))
        };
        Some(Courses { first: course(Part::First), second: course(Part::Second) })
    }

    /// One segment's feedrate: its ends, its limits, its room, and its way as the aim.
    fn drive(&self, program: &mut Program, laid: &Laid<'_>) {
        let steps = self.steps();
        let [begin, end] = laid.ends();
        for (at, value) in [(0, begin), (steps, end)] {
            program.zero(laid.feedrate(at).plus(-1.0, &Affine::constant(value)));
        }
        let gain = self.step * self.kept.acceleration / laid.side.feedrate;
        for step in 0..steps {
            let change = laid.feedrate(step + 1).plus(-1.0, &laid.feedrate(step));
            program.zero(change.plus(-gain, &laid.acceleration(step)));
            program.not_negative(laid.feedrate(step));
            program.not_negative(Affine::constant(1.0).plus(-1.0, &laid.feedrate(step)));
            for at in [step, step + 1] {
                program.cost(-0.5, laid.feedrate + at);
            }
            if step > 0 {
                let at = laid.acceleration + step;
                program.cost_of_change(CHATTER, at - 1, at);
            }
        }
        let room = Affine::constant(laid.side.room / (laid.side.feedrate * self.step));
        program.not_negative(room.plus(-1.0, &laid.steps(0, steps)));
    }

    /// The tool from step to step, its bound and the command's, and how quiet it is at the end.
    fn tool(&self, program: &mut Program, sides: &[Laid<'_>]) {
        let steps = self.steps();
        let [[aa, ab], [ba, bb]] = ToolStep::new(self.mode, self.step).phi();
        let state = program.unknowns(4 * (steps + 1));
        // Acceleration, then its rate, in x and in y.
        let at = |step: usize, part: usize, axis: usize| Affine::of(1.0, state + 4 * step + 2 * part + axis);
        let (begin, end) = (self.cruise(sides, Part::First), self.cruise(sides, Part::Second));
        for (part, values) in begin.iter().enumerate() {
            for (axis, value) in values.iter().enumerate() {
                program.zero(at(0, part, axis).plus(-1.0, &Affine::constant(*value)));
            }
        }
        for axis in 0..2 {
            for step in 0..steps {
                let command = self.command(sides, step, axis);
                let (a, b) = (at(step, 0, axis), at(step, 1, axis));
                let next = |input: f64, from_a: f64, from_b: f64| {
                    Affine::default().plus(input, &command).plus(from_a, &a).plus(from_b, &b)
                };
                program.zero(next(1.0 - aa, aa, ab).plus(-1.0, &at(step + 1, 0, axis)));
                program.zero(next(-ba, ba, bb).plus(-1.0, &at(step + 1, 1, axis)));
            }
        }
        let most = self.kept.command / self.kept.acceleration;
        for step in 0..steps {
            program.within(most, [0, 1].map(|axis| self.command(sides, step, axis)));
        }
        for step in 1..=steps {
            program.within(1.0, [at(step, 0, 0), at(step, 0, 1)]);
            for axis in 0..2 {
                program.cost_of_square(self.calm, state + 4 * step + axis);
            }
        }
        let left =
            |part: usize, axis: usize| at(steps, part, axis).plus(-1.0, &Affine::constant(end[part][axis]));
        let residual = self.kept.residual / self.kept.acceleration;
        program.within(residual, [left(0, 0), left(0, 1), left(1, 0), left(1, 1)]);
    }

    /// The command's acceleration changes no faster than it may, from cruise to cruise.
    fn changes(&self, program: &mut Program, sides: &[Laid<'_>]) {
        if self.kept.jerk.is_infinite() {
            return;
        }
        let most = self.kept.jerk * self.step / self.kept.acceleration;
        let cruise = |part: Part, axis: usize| {
            let [tool, rate] = self.cruise(sides, part);
            Affine::constant(tool[axis] + 2.0 * self.mode.damping() * rate[axis])
        };
        let steps = self.steps();
        for step in 0..=steps {
            let change = |axis: usize| {
                let before = step.checked_sub(1);
                let from = before.map_or_else(|| cruise(Part::First, axis), |n| self.command(sides, n, axis));
                let to =
                    if step < steps { self.command(sides, step, axis) } else { cruise(Part::Second, axis) };
                to.plus(-1.0, &from)
            };
            program.within(most, [change(0), change(1)]);
        }
    }

    /// How quiet a tool of another frequency is at the end.
    fn drifted(&self, program: &mut Program, sides: &[Laid<'_>]) {
        let (begin, end) = (self.cruise(sides, Part::First), self.cruise(sides, Part::Second));
        for part in DRIFTS {
            let factor = 1.0 + part * self.kept.drift;
            let mode = Mode::try_new(factor * self.mode.omega(), self.mode.damping());
            let (true, Ok(mode)) = (self.kept.drift > 0.0, mode) else { continue };
            let tool = ToolStep::new(&mode, self.step);
            let mut left = Vec::with_capacity(4);
            for axis in 0..2 {
                // What the last step adds, then the one before, which has gone on freely for a step more.
                let mut input = tool.input();
                let mut sum = [Affine::default(), Affine::default()];
                for step in (0..self.steps()).rev() {
                    let command = self.command(sides, step, axis);
                    for (expression, factor) in sum.iter_mut().zip(input) {
                        expression.add(factor, &command);
                    }
                    input = tool.free(input);
                }
                let mut start = [begin[0][axis], begin[1][axis]];
                for _ in 0..self.steps() {
                    start = tool.free(start);
                }
                for (part, expression) in sum.into_iter().enumerate() {
                    left.push(expression.plus(1.0, &Affine::constant(start[part] - end[part][axis])));
                }
            }
            program.within(self.kept.drifted_residual / self.kept.acceleration, left);
        }
    }

    /// The corner error: where both segments' ways are, seen from the corner, at the step of the corner.
    fn near(&self, program: &mut Program, first: &Laid<'_>, second: &Laid<'_>) {
        let (corner, steps) = (self.corner(), self.steps());
        if self.kept.corner_error < STOP {
            program.zero(first.steps(corner, steps));
            program.zero(second.steps(0, corner));
            return;
        }
        let left = first.whole() - first.way(corner);
        let done = second.way(corner);
        let place = |axis: usize| {
            let along = |laid: &Laid<'_>, way: f64, steps: Affine, sign: f64| {
                let (at, direction) = laid.seen_from_corner(way);
                let per_step = sign * laid.side.feedrate * self.step * direction[axis];
                Affine::constant(at[axis] - sign * way * direction[axis]).plus(per_step, &steps)
            };
            along(first, left, first.steps(corner, steps), -1.0)
                .plus(1.0, &along(second, done, second.steps(0, corner), 1.0))
        };
        let scaled = |axis: usize| Affine::default().plus(1.0 / self.kept.corner_error, &place(axis));
        program.within(1.0, [scaled(0), scaled(1)]);
    }

    /// The command is nowhere faster than the faster segment.
    fn speed(&self, program: &mut Program, first: &Laid<'_>, second: &Laid<'_>) {
        let fastest = first.side.feedrate.max(second.side.feedrate);
        for step in 1..self.steps() {
            let axis = |axis: usize| {
                let of = |laid: &Laid<'_>| laid.side.feedrate / fastest * laid.tangent(step)[axis];
                Affine::default()
                    .plus(of(first), &first.feedrate(step))
                    .plus(of(second), &second.feedrate(step))
            };
            program.within(1.0, [axis(0), axis(1)]);
        }
    }

    /// The command's acceleration in a step, over the bound: along the segments, and across them where they are curved. The square of the
    /// feedrate is taken straight around the course's.
    fn command(&self, sides: &[Laid<'_>], step: usize, axis: usize) -> Affine {
        let mut sum = Affine::default();
        for laid in sides {
            let (tangent, bend) = laid.middle(step);
            sum.add(tangent[axis], &laid.acceleration(step));
            let across = bend[axis] * laid.side.feedrate * laid.side.feedrate / self.kept.acceleration;
            if across != 0.0 {
                let known = laid.known(step);
                sum.add(across * known, &laid.feedrate(step));
                sum.add(across * known, &laid.feedrate(step + 1));
                sum.add(-across * known * known, &Affine::constant(1.0));
            }
        }
        sum
    }

    /// The tool's acceleration and rate in cruise, over the bound, where the window begins or ends: it follows the curve with a small lag.
    fn cruise(&self, sides: &[Laid<'_>], part: Part) -> [[f64; 2]; 2] {
        let Some(laid) = sides.iter().find(|laid| laid.part == part) else { return [[0.0; 2]; 2] };
        let way = match part {
            Part::First => laid.side.path.length() - laid.whole(),
            Part::Second => laid.whole(),
        };
        let [_, bend, next] = laid.jet(way);
        let feedrate = laid.side.feedrate;
        let command = bend * feedrate * feedrate / self.kept.acceleration;
        let rate = next * feedrate.powi(3) / (self.kept.acceleration * self.mode.omega());
        let tool = command - 2.0 * self.mode.damping() * rate;
        [tool.into(), rate.into()]
    }
}

impl Laid<'_> {
    /// Feedrate over the cruise at the window's two ends.
    fn ends(&self) -> [f64; 2] {
        match self.part {
            Part::First => [1.0, 0.0],
            Part::Second => [0.0, 1.0],
        }
    }

    fn feedrate(&self, at: usize) -> Affine {
        Affine::of(1.0, self.feedrate + at)
    }

    fn acceleration(&self, step: usize) -> Affine {
        Affine::of(1.0, self.acceleration + step)
    }

    /// The way from one step to another, over what cruise does in a step.
    fn steps(&self, from: usize, to: usize) -> Affine {
        let mut sum = Affine::default();
        for step in from..to {
            sum.add(0.5, &self.feedrate(step));
            sum.add(0.5, &self.feedrate(step + 1));
        }
        sum
    }

    fn whole(&self) -> f64 {
        self.course.whole()
    }

    /// Of the course, since the window's start.
    fn way(&self, at: usize) -> f64 {
        self.course.ways.get(at).copied().unwrap_or(0.0)
    }

    /// The course's feedrate in the middle of a step.
    fn known(&self, step: usize) -> f64 {
        let at = |n: usize| self.course.feedrates.get(n).copied().unwrap_or(0.0);
        0.5 * (at(step) + at(step + 1))
    }

    /// Derivatives of the place along the path, to the third.
    fn jet(&self, s: f64) -> [Vector2<f64>; 3] {
        let length = self.side.path.length();
        self.side.path.jet(s.clamp(0.0, length)).linear.map(|v| v.xy())
    }

    /// Where on the path the course is after some way in the window.
    fn coordinate(&self, way: f64) -> f64 {
        match self.part {
            Part::First => self.side.path.length() - (self.whole() - way),
            Part::Second => way,
        }
    }

    fn tangent(&self, at: usize) -> Vector2<f64> {
        self.jet(self.coordinate(self.way(at)))[0]
    }

    /// Tangent and bend in the middle of a step.
    fn middle(&self, step: usize) -> (Vector2<f64>, Vector2<f64>) {
        let way = 0.5 * (self.way(step) + self.way(step + 1));
        let [tangent, bend, _] = self.jet(self.coordinate(way));
        (tangent, bend)
    }

    /// Place and tangent, some way before the end of the first segment or after the start of the second.
    fn seen_from_corner(&self, way: f64) -> (Vector2<f64>, Vector2<f64>) {
        let (corner, s) = match self.part {
            Part::First => (self.side.path.length(), self.side.path.length() - way),
            Part::Second => (0.0, way),
        };
        let at = |s: f64| self.side.path.pose(s.clamp(0.0, self.side.path.length())).translation.vector.xy();
        (at(s) - at(corner), self.jet(s)[0])
    }
}
