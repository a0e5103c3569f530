//! A convex program put together row by row, and solved.

use clarabel::algebra::CscMatrix;
use clarabel::solver::{DefaultSettings, DefaultSolver, IPSolver as _, SolverStatus, SupportedConeT};

/// Bound of the solver's iterations: 15 to 40 are usual.
const ITERATIONS: u32 = 100;

/// Σ factor × unknown + constant.
#[derive(Debug, Clone, Default)]
pub(super) struct Affine {
    terms: Vec<(usize, f64)>,
    constant: f64,
}

impl Affine {
    pub(super) fn constant(constant: f64) -> Self {
        Self { terms: Vec::new(), constant }
    }

    /// A factor times an unknown.
    pub(super) fn of(factor: f64, unknown: usize) -> Self {
        Self { terms: vec![(unknown, factor)], constant: 0.0 }
    }

    /// This and a factor times another.
    pub(super) fn plus(mut self, factor: f64, other: &Self) -> Self {
        self.add(factor, other);
        self
    }

    pub(super) fn add(&mut self, factor: f64, other: &Self) {
        self.terms.extend(other.terms.iter().map(|(unknown, f)| (*unknown, factor * f)));
        self.constant += factor * other.constant;
    }
}

/// Least cost over unknowns that keep equations, inequalities and bounds of norms.
#[derive(Debug, Default)]
pub(super) struct Program {
    unknowns: usize,
    cost: Vec<(usize, f64)>,
    /// Upper triangle: row, column, value.
    curvature: Vec<(usize, usize, f64)>,
    zero: Vec<Affine>,
    not_negative: Vec<Affine>,
    norms: Vec<Vec<Affine>>,
}

impl Program {
    /// New unknowns, one after the other; gives the first.
    pub(super) fn unknowns(&mut self, count: usize) -> usize {
        self.unknowns += count;
        self.unknowns - count
    }

    /// Adds a factor times an unknown to the cost.
    pub(super) fn cost(&mut self, factor: f64, unknown: usize) {
        self.cost.push((unknown, factor));
    }

    /// Adds a factor times (second − first)² to the cost, where first < second.
    pub(super) fn cost_of_change(&mut self, factor: f64, first: usize, second: usize) {
        // The solver halves the quadratic form.
        let f = 2.0 * factor;
        self.curvature.extend([(first, first, f), (second, second, f), (first, second, -f)]);
    }

    /// Adds a factor times an unknown squared to the cost.
    pub(super) fn cost_of_square(&mut self, factor: f64, unknown: usize) {
        if factor > 0.0 {
            self.curvature.push((unknown, unknown, 2.0 * factor));
        }
    }

    /// An expression is zero.
    pub(super) fn zero(&mut self, expression: Affine) {
        self.zero.push(expression);
    }

    /// An expression is zero or more.
    pub(super) fn not_negative(&mut self, expression: Affine) {
        self.not_negative.push(expression);
    }

    /// The norm of a vector is at most a radius.
    pub(super) fn within(&mut self, radius: f64, vector: impl IntoIterator<Item = Affine>) {
        self.norms.push(std::iter::once(Affine::constant(radius)).chain(vector).collect());
    }

    /// The unknowns at the least cost, or nothing where nothing keeps all of it.
    pub(super) fn solve(&self) -> Option<Vec<f64>> {
        let mut cones = vec![
            SupportedConeT::ZeroConeT(self.zero.len()),
            SupportedConeT::NonnegativeConeT(self.not_negative.len()),
        ];
        cones.extend(self.norms.iter().map(|norm| SupportedConeT::SecondOrderConeT(norm.len())));
        let rows: Vec<&Affine> =
            self.zero.iter().chain(&self.not_negative).chain(self.norms.iter().flatten()).collect();
        let entries = rows
            .iter()
            .enumerate()
            .flat_map(|(row, affine)| affine.terms.iter().map(move |(unknown, f)| (row, *unknown, -f)));
        let matrix = sparse(rows.len(), self.unknowns, entries);
        let constants: Vec<f64> = rows.iter().map(|affine| affine.constant).collect();
        let mut linear = vec![0.0; self.unknowns];
        for (unknown, factor) in &self.cost {
            linear[*unknown] += factor;
        }
        let quadratic = sparse(self.unknowns, self.unknowns, self.curvature.iter().copied());
        let settings = DefaultSettings {
            max_iter: ITERATIONS,
            verbose: false,
            max_threads: 1,
            ..DefaultSettings::default()
        };
        let mut solver =
            DefaultSolver::new(&quadratic, &linear, &matrix, &constants, &cones, settings).ok()?;
        solver.solve();
        let solved = matches!(solver.solution.status, SolverStatus::Solved | SolverStatus::AlmostSolved);
        solved.then_some(solver.solution.x)
    }
}

fn sparse(rows: usize, columns: usize, entries: impl Iterator<Item = (usize, usize, f64)>) -> CscMatrix<f64> {
    let (mut i, mut j, mut values) = (Vec::new(), Vec::new(), Vec::new());
    for (row, column, value) in entries {
        i.push(row);
        j.push(column);
        values.push(value);
    }
    CscMatrix::new_from_triplets(rows, columns, i, j, values)
}
