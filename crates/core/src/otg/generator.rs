//! The generator in a control loop: one cycle on at each call, computing anew only where the input changed.

use super::calculate_into;
use super::error::Error;
use super::input::{Input, State};
use super::trajectory::{Sample, Trajectory};

/// Whether the target has been reached.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Status {
    /// On the way.
    Working,
    /// There. Further calls go on at the target's velocity and acceleration.
    Finished,
}

/// What one cycle gives.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Output<const N: usize> {
    /// The motion now: the command of this cycle.
    pub sample: Sample<N>,
    /// Seconds since the trajectory's start.
    pub time: f64,
    /// Whether this cycle computed the trajectory anew.
    pub is_new: bool,
    /// The trajectory that is followed.
    pub trajectory: Trajectory<N>,
}

impl<const N: usize> Output<N> {
    /// Makes this cycle's state the input's current one, for the next cycle.
    pub fn pass_to_input(&self, input: &mut Input<N>) {
        input.current = self.sample.state();
    }
}

impl<const N: usize> Default for Output<N> {
    fn default() -> Self {
        let trajectory = Trajectory::default();
        Self { sample: trajectory.at_time(0.0), time: 0.0, is_new: false, trajectory }
    }
}

/// Follows a target, cycle by cycle.
///
/// ```
/// use seamline::otg::{Generator, Input, Limits, Output, State, Status};
/// let limits = Limits::symmetric([1.0; 2], [5.0; 2], [50.0; 2]);
/// let mut input = Input::new(State::at_rest([0.0, 0.0]), State::at_rest([1.0, -0.5]), limits);
/// let mut generator = Generator::new(0.001);
/// let mut output = Output::default();
/// while generator.update(&input, &mut output)? == Status::Working {
///     // command output.sample here
///     output.pass_to_input(&mut input);
/// }
/// assert_eq!(output.sample.position, [1.0, -0.5]);
/// # Ok::<(), seamline::otg::Error>(())
/// ```
#[derive(Debug, Clone, Copy)]
pub struct Generator<const N: usize> {
    /// Seconds from one cycle to the next.
    cycle: f64,
    /// The input that would mean no change.
    expected: Option<Input<N>>,
    /// Cycles since the trajectory's start.
    count: u64,
}

impl<const N: usize> Generator<N> {
    /// A generator that is called every `cycle` seconds.
    #[must_use]
    pub fn new(cycle: f64) -> Self {
        Self { cycle, expected: None, count: 0 }
    }

    /// One cycle on: plans anew if the input is not the last one moved on by [`Output::pass_to_input`].
    ///
    /// # Errors
    /// Those of [`calculate_into`]; the output then keeps its sample but not its trajectory, and the next call plans anew.
    pub fn update(&mut self, input: &Input<N>, output: &mut Output<N>) -> Result<Status, Error> {
        let is_new = self.expected.as_ref() != Some(input);
        if is_new {
            self.expected = None;
            calculate_into(input, &mut output.trajectory)?;
            self.count = 0;
        }
        self.count += 1;
        output.is_new = is_new;
        output.time = self.count as f64 * self.cycle;
        output.sample = output.trajectory.at_time(output.time);
        let current: State<N> = output.sample.state();
        match &mut self.expected {
            Some(expected) => expected.current = current,
            None => self.expected = Some(Input { current, ..*input }),
        }
        Ok(if output.time >= output.trajectory.duration() { Status::Finished } else { Status::Working })
    }

    /// Forgets the trajectory: the next call plans anew.
    pub fn reset(&mut self) {
        self.expected = None;
    }
}
