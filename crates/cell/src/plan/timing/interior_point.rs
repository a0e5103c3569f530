//! A primal-dual interior-point method for [`Program`]: Mehrotra's predictor and corrector, linearised anew
//! at every iteration, infeasible starts allowed.
//!
//! Unknowns are the controls c of β, one a knot and one more at either end; for each row g(c) ≤ 0 a slack s >
//! 0 with g + s = 0, and a dual λ > 0. Each iteration costs one factorization of a banded matrix and three
//! sweeps over the rows.

use super::banded::Banded;
use super::program::{Point, Program, Rows};

/// Bound on iterations.
const ITERATIONS: usize = 50;
/// The dual residual may be so many times the duality gap, which is what the accuracy speaks of; the rows'
/// residual.
const DUAL_RESIDUAL: f64 = 4.0;
const RESIDUAL: f64 = 1e-5;
/// Starts, each tried where those before led nowhere: share of the highest constant β, and knots over which that blends from a held end.
/// Then the least and the greatest β of a start, its least slack, and the product of slack and dual.
const STARTS: [(f64, f64); 3] = [(0.9, 40.0), (0.9, 10.0), (0.05, 20.0)];
const START_RANGE: [f64; 2] = [0.02, 1.0];
const START_SLACK: f64 = 0.1;
const START_PRODUCT: f64 = 0.02;
/// The same from an earlier solution.
const AGAIN_SLACK: f64 = 0.01;
const AGAIN_PRODUCT: f64 = 1e-4;
/// A β below this is none: the method went astray, from rows that a start was too far beyond.
const ASTRAY: f64 = 1e-6;
/// Share of the way to the boundary that a step may go, and the most by which β may shrink in one.
const TO_BOUNDARY: f64 = 0.99;
const SHRINK: f64 = 0.2;
/// Weight of β's slope and bend on the first sites at rest, where no row sees them.
const REST_WEIGHT: f64 = 2.0;
const REST_SITES: usize = 5;

/// The solver and its memory, reused from problem to problem.
#[derive(Debug, Default)]
pub(super) struct InteriorPoint {
    controls: Vec<f64>,
    points: Vec<Point>,
    slack: Vec<Rows>,
    dual: Vec<Rows>,
    slack_step: Vec<Rows>,
    dual_step: Vec<Rows>,
    matrix: Banded,
    /// Right-hand side without centring, and what centring adds for a unit product.
    right: Vec<f64>,
    centring: Vec<f64>,
    direction: Vec<f64>,
}

/// Sums over all rows at the start of an iteration.
struct Progress {
    /// Σ s λ
    gap: f64,
    /// Highest g + s.
    residual: f64,
    /// Σ |(∇F + Gᵀ λ) c|
    dual_residual: f64,
    /// Duration in knots.
    duration: f64,
}

impl InteriorPoint {
    /// Solves a new problem to within `accuracy`, a share of the duration; the controls of β are in
    /// [`InteriorPoint::controls`] afterwards. False where numbers ran out of range, or β to nothing. Running out of
    /// iterations is no failure: what was reached is judged by others.
    pub(super) fn solve(&mut self, program: &Program, accuracy: f64) -> bool {
        STARTS.iter().any(|start| {
            self.start(program, start);
            self.iterate(program, accuracy) && self.points.iter().all(|point| point.x[0] > ASTRAY)
        })
    }

    /// Solves the last problem again after small changes to its demands; as [`InteriorPoint::solve`].
    pub(super) fn solve_again(&mut self, program: &Program, accuracy: f64) -> bool {
        for (index, demand) in program.demands.iter().enumerate() {
            let rows = demand.rows(&self.points[index / program.axes]);
            for (row, g) in rows.into_iter().enumerate() {
                let slack = (-g).max(AGAIN_SLACK);
                self.slack[index][row] = slack;
                self.dual[index][row] = self.dual[index][row].max(AGAIN_PRODUCT / slack);
            }
        }
        self.iterate(program, accuracy)
    }

    /// Controls of β: knot k lies under number k + 1.
    pub(super) fn controls(&self) -> &[f64] {
        &self.controls
    }

    fn iterate(&mut self, program: &Program, accuracy: f64) -> bool {
        for _ in 0..ITERATIONS {
            let progress = self.assemble(program);
            let done = progress.gap <= accuracy * progress.duration
                && progress.dual_residual <= DUAL_RESIDUAL * accuracy * progress.duration
                && progress.residual <= RESIDUAL;
            if done {
                return true;
            }
            if !(progress.duration.is_finite() && progress.gap.is_finite()) {
                return false;
            }
            for index in 0..self.controls.len() {
                if frozen(program, index, self.controls.len()) {
                    self.matrix.freeze(index);
                }
            }
            if !self.matrix.factor() {
                return false;
            }
            self.step(program, &progress);
        }
        true
    }

    fn start(&mut self, program: &Program, &(share, blend): &(f64, f64)) {
        let size = program.intervals() + 3;
        let [low, high] = START_RANGE;
        let level = (share * program.constant_bound()).clamp(low, high);
        self.controls.clear();
        self.controls.extend((0..size).map(|index| {
            let mut value = level;
            for (held, distance) in program.held.into_iter().zip([index, size - 1 - index]) {
                let along = ((distance as f64 - 2.0) / blend).clamp(0.0, 1.0);
                let smooth = along * along * (3.0 - 2.0 * along);
                value = if held { value.max(1.0 + (level - 1.0) * smooth) } else { value };
            }
            value
        }));
        self.set_points(program);
        for memory in [&mut self.slack, &mut self.dual, &mut self.slack_step, &mut self.dual_step] {
            memory.clear();
            memory.resize(program.demands.len(), Rows::default());
        }
        for (index, demand) in program.demands.iter().enumerate() {
            let rows = demand.rows(&self.points[index / program.axes]);
            self.slack[index] = rows.map(|g| (-g).max(START_SLACK));
            self.dual[index] = self.slack[index].map(|s| START_PRODUCT / s);
        }
    }

    fn set_points(&mut self, program: &Program) {
        self.points.clear();
        let sites = (0..program.sites()).map(|site| program.site(site));
        self.points.extend(sites.map(|site| Point::new(site.value(&self.controls))));
    }

    /// Builds the normal matrix and the predictor's right-hand side.
    fn assemble(&mut self, program: &Program) -> Progress {
        let axes = program.axes;
        let size = self.controls.len();
        self.matrix.reset(size);
        self.right.clear();
        self.right.resize(size, 0.0);
        let mut progress = Progress { gap: 0.0, residual: 0.0, dual_residual: 0.0, duration: 0.0 };
        // ∇F + Gᵀλ, held in the memory of the direction.
        self.direction.clear();
        self.direction.resize(size, 0.0);
        for index in 0..program.sites() {
            let (site, point) = (program.site(index), self.points[index]);
            let tangent = point.tangent();
            let (gradient, curvature) = objective(program, index, &point, &mut progress.duration);
            let mut square = [curvature[0], 0.0, 0.0, curvature[1], 0.0, curvature[2]];
            let mut right = gradient.map(|g| -g);
            let mut stationary = gradient;
            for index in index * axes..(index + 1) * axes {
                let demand = &program.demands[index];
                let rows = demand.rows(&point);
                let (slacks, duals) = (&mut self.slack[index], &self.dual[index]);
                let (mut weights, mut pulls) = (Rows::default(), Rows::default());
                for (row, &g) in rows.iter().enumerate() {
                    // The true jerk row lies below its tangent: what it gives is slack at once.
                    let slack = larger(slacks[row], -g);
                    slacks[row] = slack;
                    let residual = g + slack;
                    weights[row] = duals[row] / slack;
                    pulls[row] = -weights[row] * residual;
                    progress.gap += slack * duals[row];
                    progress.residual = larger(residual, progress.residual);
                }
                add(&mut square, &demand.square(tangent, &weights));
                add(&mut right, &demand.gradient(tangent, &pulls));
                add(&mut stationary, &demand.gradient(tangent, duals));
            }
            self.matrix.add(site.interval, &site.square(&square));
            site.spread(&right, &mut self.right);
            site.spread(&stationary, &mut self.direction);
        }
        let products = self.direction.iter().zip(&self.controls).enumerate();
        progress.dual_residual = products
            .filter(|(index, _)| !frozen(program, *index, size))
            .map(|(_, (residual, control))| (residual * control).abs())
            .sum();
        progress
    }

    /// Predictor, corrector, and the step.
    fn step(&mut self, program: &Program, progress: &Progress) {
        let axes = program.axes;
        let count = (program.demands.len() * Rows::default().len()) as f64;
        self.set_direction(program, 0.0);
        self.centring.clear();
        self.centring.resize(self.controls.len(), 0.0);
        // The predictor's steps: the greatest relative losses, and what the products would become.
        let (mut slack_loss, mut dual_loss) = (1.0f64, 1.0f64);
        let (mut by_slack, mut by_dual, mut by_both) = (0.0, 0.0, 0.0);
        for index in 0..program.sites() {
            let (site, point) = (program.site(index), self.points[index]);
            let tangent = point.tangent();
            let direction = site.value(&self.direction);
            let (mut centring, mut second) = ([0.0; 3], [0.0; 3]);
            for index in index * axes..(index + 1) * axes {
                let demand = &program.demands[index];
                let (rows, along) = (demand.rows(&point), demand.along(tangent, &direction));
                let (slacks, duals) = (&self.slack[index], &self.dual[index]);
                let (mut inverses, mut corrections) = (Rows::default(), Rows::default());
                for row in 0..rows.len() {
                    let (slack, dual, inverse) = (slacks[row], duals[row], 1.0 / slacks[row]);
                    let slack_step = -(rows[row] + slack) - along[row];
                    let relative = slack_step * inverse;
                    let dual_step = -dual * (1.0 + relative);
                    slack_loss = larger(-relative, slack_loss);
                    dual_loss = larger(1.0 + relative, dual_loss);
                    let product = slack_step * dual_step;
                    by_slack += slack_step * dual;
                    by_dual += slack * dual_step;
                    by_both += product;
                    inverses[row] = inverse;
                    corrections[row] = product * inverse;
                }
                // Kept for the corrector.
                self.dual_step[index] = corrections;
                self.slack_step[index] = inverses;
                add(&mut centring, &demand.gradient(tangent, &inverses));
                add(&mut second, &demand.gradient(tangent, &corrections));
            }
            site.spread(&centring, &mut self.centring);
            site.spread(&second, &mut self.right);
        }
        let (slack_length, dual_length) = (1.0 / slack_loss, 1.0 / dual_loss);
        let reached = progress.gap
            + slack_length * by_slack
            + dual_length * by_dual
            + slack_length * dual_length * by_both;
        let share = (reached / progress.gap).clamp(0.0, 1.0);
        let product = share * share * share * progress.gap / count;
        self.set_direction(program, product);
        self.advance(program, product);
    }

    /// Direction of the controls, for the given product of slack and dual.
    fn set_direction(&mut self, program: &Program, product: f64) {
        let size = self.controls.len();
        self.direction.clear();
        for index in 0..size {
            let centring = if product == 0.0 { 0.0 } else { product * self.centring[index] };
            let value = if frozen(program, index, size) { 0.0 } else { self.right[index] - centring };
            self.direction.push(value);
        }
        self.matrix.solve(&mut self.direction);
    }

    /// Goes along the corrected direction, as far as slacks, duals and β stay positive.
    fn advance(&mut self, program: &Program, product: f64) {
        let axes = program.axes;
        let (mut slack_loss, mut dual_loss) = (1.0f64, 1.0f64);
        for index in 0..program.sites() {
            let (site, point) = (program.site(index), self.points[index]);
            let tangent = point.tangent();
            let direction = site.value(&self.direction);
            slack_loss = slack_loss.max(-direction[0] / ((1.0 - SHRINK) * point.x[0]));
            for index in index * axes..(index + 1) * axes {
                let demand = &program.demands[index];
                let (rows, along) = (demand.rows(&point), demand.along(tangent, &direction));
                let (slacks, duals) = (&self.slack[index], &self.dual[index]);
                let (inverses, corrections) = (self.slack_step[index], self.dual_step[index]);
                let (mut slack_steps, mut dual_steps) = (Rows::default(), Rows::default());
                for row in 0..rows.len() {
                    let (slack, dual, inverse) = (slacks[row], duals[row], inverses[row]);
                    let slack_step = -(rows[row] + slack) - along[row];
                    let dual_step = (product - dual * slack_step) * inverse - corrections[row] - dual;
                    slack_loss = larger(-slack_step * inverse, slack_loss);
                    dual_loss = larger(-dual_step / dual, dual_loss);
                    slack_steps[row] = slack_step;
                    dual_steps[row] = dual_step;
                }
                self.slack_step[index] = slack_steps;
                self.dual_step[index] = dual_steps;
            }
        }
        // A loss of 1 or less lets the whole step stand.
        let (slack_length, dual_length) = (TO_BOUNDARY / slack_loss, TO_BOUNDARY / dual_loss);
        move_along(&mut self.slack, &self.slack_step, slack_length);
        move_along(&mut self.dual, &self.dual_step, dual_length);
        for (control, step) in self.controls.iter_mut().zip(&self.direction) {
            *control += slack_length * step;
        }
        self.set_points(program);
    }
}

/// Whether a control is held: three at a held end.
fn frozen(program: &Program, index: usize, size: usize) -> bool {
    (program.held[0] && index < 3) || (program.held[1] && index + 3 >= size)
}

/// Gradient and diagonal curvature of the duration (in knots) at one site, in terms of β, h β′, h² β″:
/// Simpson's rule.
fn objective(program: &Program, site: usize, point: &Point, duration: &mut f64) -> ([f64; 3], [f64; 3]) {
    let last = program.sites() - 1;
    let weight = if site == 0 || site == last {
        1.0
    } else if site % 2 == 1 {
        4.0
    } else {
        2.0
    } / 6.0;
    let [beta, slope, bend] = point.x;
    *duration += weight * point.root;
    let gradient = -0.5 * weight * point.root / beta;
    let curvature = -1.5 * gradient / beta;
    let at_rest = (site < REST_SITES && !program.held[0]) || (site + REST_SITES > last && !program.held[1]);
    let smooth = if at_rest { REST_WEIGHT } else { 0.0 };
    ([gradient, smooth * slope, smooth * bend], [curvature, smooth, smooth])
}

/// The larger of two numbers; `b` where `a` is none. One instruction, unlike `f64::max`.
#[inline]
fn larger(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

fn add<const K: usize>(to: &mut [f64; K], values: &[f64; K]) {
    for (to, value) in to.iter_mut().zip(values) {
        *to += value;
    }
}

fn move_along(values: &mut [Rows], steps: &[Rows], length: f64) {
    for (values, steps) in values.iter_mut().zip(steps) {
        for (value, step) in values.iter_mut().zip(steps) {
            *value += length * step;
        }
    }
}
