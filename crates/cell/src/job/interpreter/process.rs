//! Inputs, outputs, time, messages; arc and weave.

use super::super::expression::{Expression, Node};
use super::super::instruction::{ArcTags, Io, OutputValue, WeaveTags, Weld};
use super::super::lexer::Fault;
use super::super::step::{Action, ArcCondition, Output, WeaveCondition};
use super::super::world::World;
use super::evaluate::Signals;
use super::moves::in_range;
use super::outputs::bits;
use super::{Interpreter, Outcome};

type Run<T> = Result<T, Fault>;

/// PULSE without a time.
const PULSE_SECONDS: f64 = 0.3;
/// Counts of an integer variable in a second.
const COUNTS_PER_SECOND: f64 = 100.0;
/// Counts of an integer variable in a volt of AOUT.
const COUNTS_PER_VOLT: f64 = 100.0;
/// Numbers of conditions and ports.
const MAX_NUMBER: f64 = 1000.0;

impl Interpreter {
    /// DIN changes a variable and nothing outside; everything else here is something to be done.
    pub(super) fn io(&mut self, io: &Io, world: &mut impl World) -> Run<Outcome> {
        let action = match io {
            Io::Timer { time } => Action::Dwell { seconds: self.seconds(time, world)? },
            Io::Wait { condition, timeout } => Action::Wait {
                condition: self.condition(condition, Signals::Later, world)?,
                timeout_seconds: timeout.as_ref().map(|t| self.seconds(t, world)).transpose()?,
            },
            Io::DigitalOutput { signal, value } => {
                let value = match value {
                    OutputValue::Value(value) => self.number(value, world)?,
                    OutputValue::Invert => f64::from(!self.signal(signal, world)?),
                };
                Action::Output(self.set_output(signal, value, world)?)
            }
            Io::Pulse { signal, value, time } => {
                let value = value.as_ref().map_or(Ok(1.0), |v| self.number(v, world))?;
                let seconds = time.as_ref().map_or(Ok(PULSE_SECONDS), |t| self.seconds(t, world))?;
                let number = self.index(&signal.number, world)?;
                let (kind, value) = (signal.kind, bits(signal.kind, value));
                // The job reads the output as it was before the pulse.
                Action::Output(Output::Pulse { kind, number, value, seconds })
            }
            Io::DigitalInput { variable, signal } => {
                let value = self.signal(signal, world)?;
                self.store(variable, f64::from(value), world)?;
                return Ok(Outcome::Nothing);
            }
            Io::AnalogOutput { port, value } => {
                let number = self.natural(port, "the port", MAX_NUMBER, world)?;
                let volts = self.counted(value, COUNTS_PER_VOLT, world)?;
                in_range(value, "the output (V)", volts, -14.0, 14.0)?;
                Action::Output(Output::Analog { number, volts })
            }
            Io::Message { text } => Action::Message { text: self.text(text, world)? },
            Io::Alarm { code, text, subcode, stop_mode } => {
                let code = self.natural(code, "the alarm code", 8999.0, world)?;
                let text = text.as_ref().map_or(Ok(String::new()), |t| self.text(t, world))?;
                let number = |value: &Option<Expression>, what, world: &mut _| {
                    value.as_ref().map_or(Ok(0), |v| self.natural(v, what, 255.0, world))
                };
                let subcode = number(subcode, "the alarm's subcode", world)?;
                // SMODE: 0 stops all tasks, 2 this one, 1 none.
                let stops = number(stop_mode, "SMODE", world)? != 1;
                if stops {
                    self.calls.clear();
                }
                Action::Alarm { code, text, subcode, stops }
            }
        };
        Ok(action.into())
    }

    pub(super) fn weld(&mut self, weld: &Weld, world: &mut impl World) -> Run<Outcome> {
        let action = match weld {
            Weld::ArcOn(tags) => {
                let condition = self.arc_condition(tags, world)?;
                self.arc = Some(condition);
                Action::ArcOn(condition)
            }
            Weld::ArcSet(tags) => {
                let condition = self.arc_condition(tags, world)?;
                if let Some(arc) = &mut self.arc {
                    arc.file = condition.file.or(arc.file);
                    arc.speed_mm_s = condition.speed_mm_s.or(arc.speed_mm_s);
                }
                Action::ArcSet(condition)
            }
            Weld::ArcOff(tags) => {
                self.arc = None;
                Action::ArcOff(self.arc_condition(tags, world)?)
            }
            Weld::WeaveOn(tags) => Action::WeaveOn(self.weave_condition(tags, world)?),
            Weld::WeaveOff => Action::WeaveOff,
            Weld::TrackOn(_) => Action::TrackOn,
            Weld::TrackOff => Action::TrackOff,
            Weld::MemoryOn { record, file } => {
                let file = self.natural(file, "the file's number", MAX_NUMBER, world)?;
                Action::MemoryOn { record: *record, file }
            }
            Weld::MemoryOff => Action::MemoryOff,
        };
        Ok(action.into())
    }

    fn weave_condition(&self, tags: &WeaveTags, world: &mut impl World) -> Run<WeaveCondition> {
        let value = |tag: &Option<Expression>, counts_per_unit: f64, world: &mut _| {
            tag.as_ref().map(|e| self.counted(e, counts_per_unit, world)).transpose()
        };
        let file = tags.file.as_ref();
        Ok(WeaveCondition {
            file: file.map(|f| self.natural(f, "the condition's number", MAX_NUMBER, world)).transpose()?,
            amplitude_mm: value(&tags.amplitude, 10.0, world)?,
            frequency_hz: value(&tags.frequency, 10.0, world)?,
            angle_deg: value(&tags.angle, 10.0, world)?,
            right_first: value(&tags.direction, 1.0, world)?.map(|direction| direction > 0.0),
        })
    }

    fn arc_condition(&self, tags: &ArcTags, world: &mut impl World) -> Run<ArcCondition> {
        let value = |tag: &Option<Expression>, counts_per_unit: f64, world: &mut _| {
            tag.as_ref().map(|e| self.counted(e, counts_per_unit, world)).transpose()
        };
        let file = tags.file.as_ref();
        let speed_mm_s = match &tags.speed {
            // Counts are always of mm/s; numbers are in the cell's unit.
            Some(e) if !is_literal(e) => Some(self.number(e, world)? / 10.0),
            Some(e) => Some(self.number(e, world)? * self.v_unit.mm_s()),
            None => None,
        };
        Ok(ArcCondition {
            file: file.map(|f| self.natural(f, "the condition's number", MAX_NUMBER, world)).transpose()?,
            current: value(&tags.current, 1.0, world)?,
            voltage: value(&tags.voltage, 10.0, world)?,
            voltage_percent: value(&tags.voltage_percent, 1.0, world)?,
            seconds: tags.time.as_ref().map(|t| self.seconds(t, world)).transpose()?,
            speed_mm_s,
            power_source: tags.power_source,
        })
    }

    fn seconds(&self, time: &Expression, world: &mut impl World) -> Run<f64> {
        let seconds = self.counted(time, COUNTS_PER_SECOND, world)?;
        in_range(time, "T (s)", seconds, 0.0, 655.35)?;
        Ok(seconds)
    }

    /// A written number as it stands; a variable counts so many to the unit.
    fn counted(&self, value: &Expression, counts_per_unit: f64, world: &mut impl World) -> Run<f64> {
        let number = self.number(value, world)?;
        Ok(if is_literal(value) { number } else { number / counts_per_unit })
    }
}

fn is_literal(expression: &Expression) -> bool {
    matches!(expression.node, Node::Number { .. })
}
