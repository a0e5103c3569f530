//! Simulated servo drives with their encoders.

use std::fmt;

use crate::cell::Cell;

/// How one joint follows its command and how its encoder reads. Radians or metres by the joint's kind, seconds.
///
/// The servo loop is a first-order lag with velocity feed-forward k,
///
/// ```text
/// τ ẏ = u + k τ u̇ − y
/// ```
///
/// of gain 1: a constant command is reached, a ramp of speed v is followed at the distance (1 − k) τ v (to half a
/// period's travel, because commands come in steps).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Servo {
    time_constant: f64,
    feed_forward: f64,
    encoder_step: f64,
}

impl Servo {
    /// Follows exactly, reads exactly.
    pub const IDEAL: Self = Self { time_constant: 0.0, feed_forward: 0.0, encoder_step: 0.0 };

    /// A servo by its time constant τ in seconds (0: follows exactly), its velocity feed-forward k from 0 to 1 and
    /// its encoder's step (0: reads exactly).
    ///
    /// # Errors
    /// [`SetupError::Servo`] for a value that is negative, infinite or NaN, or a feed-forward above 1.
    pub fn try_new(time_constant: f64, feed_forward: f64, encoder_step: f64) -> Result<Self, SetupError> {
        let quantities = [
            ("time constant", time_constant),
            ("feed-forward", feed_forward),
            ("encoder step", encoder_step),
        ];
        for (quantity, value) in quantities {
            let bound = if quantity == "feed-forward" { 1.0 } else { f64::MAX };
            if !(0.0..=bound).contains(&value) {
                return Err(SetupError::Servo { quantity, value });
            }
        }
        Ok(Self { time_constant, feed_forward, encoder_step })
    }
}

/// A simulated drive that cannot be as asked for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SetupError {
    /// A servo's value is out of range.
    Servo {
        /// What it is.
        quantity: &'static str,
        /// Its value.
        value: f64,
    },
    /// A fault for a joint that the arm has not.
    NoSuchJoint {
        /// Its index, from 0.
        joint: usize,
        /// How many there are.
        joints: usize,
    },
    /// The cell's robot has another number of joints.
    JointCount {
        /// How many the cell's robot has.
        found: usize,
        /// How many were asked for.
        expected: usize,
    },
}

impl fmt::Display for SetupError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Servo { quantity, value } => write!(f, "servo {quantity} {value} is out of range"),
            Self::NoSuchJoint { joint, joints } => write!(f, "no joint {} among {joints}", joint + 1),
            Self::JointCount { found, expected } => {
                write!(f, "the cell's robot has {found} joints, expected {expected}")
            }
        }
    }
}

impl std::error::Error for SetupError {}

/// Why the drives gave no reading.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum DriveError {
    /// They did not answer.
    Silent,
    /// One of them reports a fault of its own.
    Alarm {
        /// The joint's index, from 0.
        joint: usize,
        /// The drive's code.
        code: u32,
    },
    /// A command was NaN or infinite; none of the joints took its command.
    NotFinite {
        /// The joint's index, from 0.
        joint: usize,
    },
}

impl fmt::Display for DriveError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Silent => write!(f, "drives silent"),
            Self::Alarm { joint, code } => write!(f, "drive of joint {}: alarm {code}", joint + 1),
            Self::NotFinite { joint } => write!(f, "command of joint {} is not a finite number", joint + 1),
        }
    }
}

impl std::error::Error for DriveError {}

/// A fault to try the controller with. Joints are counted from 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum InjectedFault {
    /// The drives no longer answer, and their brakes hold the arm.
    Silent,
    /// One drive reports an alarm, and the brakes hold the arm.
    Alarm {
        /// The joint.
        joint: usize,
        /// The drive's code.
        code: u32,
    },
    /// A joint no longer moves: its following error grows.
    Stuck {
        /// The joint.
        joint: usize,
    },
    /// An encoder reads so much more from now on (added to earlier jumps).
    EncoderJump {
        /// The joint.
        joint: usize,
        /// The jump, in radians or metres.
        offset: f64,
    },
}

/// Servo drives of `N` joints in software: deterministic, without clock, thread or heap.
///
/// Each joint follows by its [`Servo`] law, solved exactly for a command that is held from one exchange to the next.
#[derive(Debug, Clone)]
pub struct SimulatedDrive<const N: usize> {
    axes: [Axis; N],
    /// The period that the axes' gains are for.
    period: f64,
    failure: Option<DriveError>,
}

/// One joint's servo and encoder.
#[derive(Debug, Clone, Copy)]
struct Axis {
    servo: Servo,
    /// 1 − e^(−T/τ) for the period T.
    gain: f64,
    position: f64,
    /// The command before, from which the feed-forward takes its speed.
    command: f64,
    stuck: bool,
    encoder_offset: f64,
}

impl Axis {
    fn at_rest(servo: Servo, position: f64) -> Self {
        Self { servo, gain: 0.0, position, command: position, stuck: false, encoder_offset: 0.0 }
    }

    /// The nearest reading to the position: at most half a step away.
    fn reading(&self) -> f64 {
        let (seen, step) = (self.position + self.encoder_offset, self.servo.encoder_step);
        if step > 0.0 { (seen / step).round() * step } else { seen }
    }

    fn follow(&mut self, command: f64, period: f64) {
        let speed = (command - self.command) / period;
        self.command = command;
        if !self.stuck {
            let driven = command + self.servo.feed_forward * self.servo.time_constant * speed;
            self.position += (driven - self.position) * self.gain;
        }
    }
}

impl<const N: usize> SimulatedDrive<N> {
    /// Drives at rest at a position.
    #[must_use]
    pub fn new(servos: [Servo; N], position: [f64; N]) -> Self {
        let axes = std::array::from_fn(|joint| Axis::at_rest(servos[joint], position[joint]));
        Self { axes, period: 0.0, failure: None }
    }

    /// The drives that a cell describes, at rest at its home position.
    ///
    /// # Errors
    /// [`SetupError::JointCount`] where the cell's robot has not `N` joints.
    pub fn from_cell(cell: &Cell) -> Result<Self, SetupError> {
        let simulation = &cell.simulation;
        let wrong_count = SetupError::JointCount { found: cell.robot.joints.len(), expected: N };
        let home = cell.robot.joint_array(|joint| joint.home).ok_or(wrong_count)?;
        let mut servos = [Servo::IDEAL; N];
        for ((servo, joint), lag) in servos.iter_mut().zip(&cell.robot.joints).zip(&simulation.servo_lag) {
            let encoder_step = simulation.encoder_step_pulses / joint.pulses_per_unit.abs();
            *servo = Servo::try_new(*lag, simulation.velocity_feed_forward, encoder_step)?;
        }
        Ok(Self::new(servos, home))
    }

    /// Where the joints truly are, unlike what their encoders read.
    #[must_use]
    pub fn position(&self) -> [f64; N] {
        self.axes.map(|axis| axis.position)
    }

    /// Puts a fault in force, beside those that are already; a later silence or alarm takes an earlier one's place.
    ///
    /// # Errors
    /// [`SetupError::NoSuchJoint`].
    pub fn inject(&mut self, fault: InjectedFault) -> Result<(), SetupError> {
        match fault {
            InjectedFault::Silent => self.failure = Some(DriveError::Silent),
            InjectedFault::Alarm { joint, code } => {
                self.axis(joint)?;
                self.failure = Some(DriveError::Alarm { joint, code });
            }
            InjectedFault::Stuck { joint } => self.axis(joint)?.stuck = true,
            InjectedFault::EncoderJump { joint, offset } => self.axis(joint)?.encoder_offset += offset,
        }
        Ok(())
    }

    fn axis(&mut self, joint: usize) -> Result<&mut Axis, SetupError> {
        self.axes.get_mut(joint).ok_or(SetupError::NoSuchJoint { joint, joints: N })
    }

    /// Ends all faults: encoders are referenced again, and joints move from where they stand.
    pub fn clear_faults(&mut self) {
        self.failure = None;
        for axis in &mut self.axes {
            (axis.stuck, axis.encoder_offset) = (false, 0.0);
        }
    }

    /// Reads the encoders at this instant, then hands over the command, which the joints follow for one period in
    /// seconds. A period that is not above zero moves nothing.
    ///
    /// # Errors
    /// [`DriveError`] under an injected silence or alarm and for a command that is not finite. The joints then stand
    /// still.
    pub fn exchange(&mut self, command: &[f64; N], period: f64) -> Result<[f64; N], DriveError> {
        let not_finite = command.iter().position(|value| !value.is_finite());
        let refused = not_finite.map(|joint| DriveError::NotFinite { joint });
        if let Some(error) = self.failure.or(refused) {
            for axis in &mut self.axes {
                axis.command = axis.position;
            }
            return Err(error);
        }
        let reading = self.axes.map(|axis| axis.reading());
        if period > 0.0 {
            if period != self.period {
                self.prepare(period);
            }
            for (axis, command) in self.axes.iter_mut().zip(command) {
                axis.follow(*command, period);
            }
        }
        Ok(reading)
    }

    fn prepare(&mut self, period: f64) {
        self.period = period;
        for axis in &mut self.axes {
            // A time constant of 0 gives e^(−∞), a gain of exactly 1.
            axis.gain = -(-period / axis.servo.time_constant).exp_m1();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn servo(time_constant: f64, feed_forward: f64, encoder_step: f64) -> Servo {
        Servo::try_new(time_constant, feed_forward, encoder_step).unwrap()
    }

    /// A step of the command, against y = 1 − e^(−t/τ), at three periods and on until the step is done.
    #[test]
    fn step_response_is_the_analytic_one_at_every_period() {
        for period in [0.000_25, 0.001, 0.004] {
            let lags = [0.0, 0.005, 0.015, 0.2];
            let mut drive = SimulatedDrive::new(lags.map(|lag| servo(lag, 0.0, 0.0)), [0.0; 4]);
            for cycle in 0..2000 {
                let reading = drive.exchange(&[1.0; 4], period).unwrap();
                let time = f64::from(cycle) * period;
                for (lag, y) in lags.iter().zip(reading) {
                    let analytic = if time == 0.0 { 0.0 } else { 1.0 - (-time / lag).exp() };
                    assert!((y - analytic).abs() < 1e-12, "lag {lag}, t {time}: {y}, {analytic}");
                }
            }
        }
    }

    /// A ramp in steps of v T, each held for T, settles at v T / g − v T − k τ v behind with g = 1 − e^(−T/τ) (from
    /// y + g (u + k τ v − y) = y + v T), which is (1 − k) τ v to half a step.
    #[test]
    fn ramps_are_followed_at_the_stated_distance() {
        let (period, speed, lag) = (0.001, 2.0, 0.015);
        for feed_forward in [0.0, 0.5, 1.0] {
            let mut drive = SimulatedDrive::new([servo(lag, feed_forward, 0.0)], [0.0]);
            let mut behind = 0.0;
            for cycle in 1..=1000 {
                let command = speed * f64::from(cycle) * period;
                drive.exchange(&[command], period).unwrap();
                behind = command - drive.position()[0];
            }
            let step = speed * period;
            let settled = step / (1.0 - (-period / lag).exp()) - step - feed_forward * lag * speed;
            assert!((behind - settled).abs() < 1e-12, "{feed_forward}: {behind}, {settled}");
            assert!(
                (behind - (1.0 - feed_forward) * lag * speed).abs() < 0.5 * step,
                "{feed_forward}: {behind}"
            );
        }
    }

    /// 10 000 random commands: no reading is farther than half a step from the true position, readings are whole
    /// steps, and the quantization does not reach the motion.
    #[test]
    fn readings_are_whole_steps_within_half_a_step() {
        let step: f64 = 1.0 / 1341.380023;
        let mut coarse = SimulatedDrive::new([servo(0.015, 0.0, step)], [0.3]);
        let mut exact = SimulatedDrive::new([servo(0.015, 0.0, 0.0)], [0.3]);
        let mut state = 1_u32;
        for _ in 0..10_000 {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            let command = [f64::from(state) / f64::from(u32::MAX) * 6.0 - 3.0];
            let truth = coarse.position()[0];
            let reading = coarse.exchange(&command, 0.001).unwrap()[0];
            assert!((reading - truth).abs() <= 0.5 * step * (1.0 + 1e-12));
            assert!((reading / step - (reading / step).round()).abs() < 1e-9);
            assert_eq!(exact.exchange(&command, 0.001).unwrap()[0], truth);
        }
    }

    #[test]
    fn equal_commands_give_equal_readings_bit_for_bit() {
        let cell = Cell::default_cell().unwrap();
        let run = || {
            let mut drive = SimulatedDrive::<6>::from_cell(&cell).unwrap();
            let mut bits = Vec::new();
            for cycle in 0..2000 {
                let command =
                    std::array::from_fn(|joint| (f64::from(cycle) * 0.001 * (joint as f64 + 1.0)).sin());
                bits.extend(drive.exchange(&command, 0.001).unwrap().map(f64::to_bits));
            }
            bits
        };
        assert_eq!(run(), run());
    }

    #[test]
    fn the_default_cells_drives_stand_at_home() {
        let cell = Cell::default_cell().unwrap();
        let mut drive = SimulatedDrive::<6>::from_cell(&cell).unwrap();
        let home = cell.robot.joint_array::<6>(|joint| joint.home).unwrap();
        assert_eq!(drive.position(), home);
        let reading = drive.exchange(&home, 0.001).unwrap();
        for ((joint, reading), home) in cell.robot.joints.iter().zip(reading).zip(home) {
            assert!((reading - home).abs() <= 0.5 / joint.pulses_per_unit * (1.0 + 1e-12));
        }
        let error = SimulatedDrive::<4>::from_cell(&cell).unwrap_err();
        assert_eq!(error, SetupError::JointCount { found: 6, expected: 4 });
    }

    #[test]
    fn faults_do_what_they_say_and_end() {
        let mut drive = SimulatedDrive::new([servo(0.01, 0.5, 0.0); 2], [0.0; 2]);
        let exchange = |drive: &mut SimulatedDrive<2>| drive.exchange(&[1.0, 1.0], 0.001);
        exchange(&mut drive).unwrap();

        drive.inject(InjectedFault::Stuck { joint: 0 }).unwrap();
        drive.inject(InjectedFault::EncoderJump { joint: 1, offset: 0.25 }).unwrap();
        let before = drive.position();
        let reading = exchange(&mut drive).unwrap();
        assert_eq!(reading, [before[0], before[1] + 0.25]);
        assert_eq!(drive.position()[0], before[0]);
        assert!(drive.position()[1] > before[1]);

        drive.inject(InjectedFault::Silent).unwrap();
        let before = drive.position();
        assert_eq!(exchange(&mut drive), Err(DriveError::Silent));
        drive.inject(InjectedFault::Alarm { joint: 1, code: 4_320 }).unwrap();
        assert_eq!(exchange(&mut drive), Err(DriveError::Alarm { joint: 1, code: 4_320 }));
        assert_eq!(drive.position(), before);

        drive.clear_faults();
        assert_eq!(exchange(&mut drive), Ok(before));
        assert!(drive.position()[0] > before[0]);
    }

    #[test]
    fn a_command_that_is_not_finite_moves_nothing() {
        let mut drive = SimulatedDrive::new([servo(0.01, 1.0, 0.0); 2], [0.5; 2]);
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            assert_eq!(drive.exchange(&[1.0, bad], 0.001), Err(DriveError::NotFinite { joint: 1 }));
        }
        for period in [0.0, -1.0, f64::NAN] {
            assert_eq!(drive.exchange(&[1.0, 1.0], period), Ok([0.5; 2]));
        }
        assert_eq!(drive.position(), [0.5; 2]);
    }

    #[test]
    fn wrong_set_ups_are_refused() {
        for (time_constant, feed_forward, encoder_step) in
            [(-1.0, 0.0, 0.0), (f64::NAN, 0.0, 0.0), (0.0, 1.1, 0.0), (0.0, 0.0, f64::INFINITY)]
        {
            assert!(matches!(
                Servo::try_new(time_constant, feed_forward, encoder_step),
                Err(SetupError::Servo { .. })
            ));
        }
        let mut drive = SimulatedDrive::new([servo(0.0, 0.0, 0.0); 2], [0.0; 2]);
        let error = drive.inject(InjectedFault::Stuck { joint: 2 });
        assert_eq!(error, Err(SetupError::NoSuchJoint { joint: 2, joints: 2 }));
    }
}
