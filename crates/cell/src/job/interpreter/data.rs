//! Variables and computing.

use super::super::error::Mistake;
use super::super::expression::{Expression, Node, SignalReference, Variable, VariableKind};
use super::super::instruction::{Arithmetic, Bitwise, Data, Function};
use super::super::lexer::Fault;
use super::super::position::{Frame, JobPosition};
use super::super::step::{Action, Output, Target};
use super::super::world::World;
use super::evaluate::unavailable;
use super::outputs::bits;
use super::variables::Value;
use super::{Interpreter, Outcome};

type Run<T> = Result<T, Fault>;

/// Elements of a position at most.
const MAX_ELEMENT: f64 = 8.0;
/// Variables of one kind at most.
const MAX_COUNT: f64 = 99_999.0;

impl Interpreter {
    pub(super) fn data(&mut self, data: &Data, world: &mut impl World) -> Run<Outcome> {
        match data {
            Data::SetSignal { signal, value } => {
                let value = self.number(value, world)?;
                return self.set_output(signal, value, world).map(|output| Action::Output(output).into());
            }
            Data::Set { variable, value } => self.set(variable, value, world)?,
            Data::Arithmetic { operation, variable, element, value } => {
                self.arithmetic(*operation, variable, element.as_ref(), value, world)?;
            }
            Data::Step { variable, by } => {
                let index = self.index(&variable.index, world)?;
                let value = self.scope_mut(variable).number(variable.kind, index) + f64::from(*by);
                self.store(variable, value, world)?;
            }
            Data::Clear { variable, count } => {
                let count = count.as_ref();
                let count = count.map(|c| self.natural(c, "the count", MAX_COUNT, world)).transpose()?;
                let index = self.index(&variable.index, world)?;
                self.scope_mut(variable).clear(variable.kind, index, count);
            }
            Data::ClearStack => {
                let kept = self.calls.pop();
                self.calls.clear();
                self.calls.extend(kept);
            }
            Data::Function { function, variable, value } => {
                let result = self.function(*function, value, world)?;
                self.store(variable, result, world)?;
            }
            Data::Bitwise { operation, variable, value } => {
                self.bitwise(*operation, variable, value, world)?;
            }
            Data::SetElement { variable, element, value } => {
                let value = self.number(value, world)?;
                self.change_element(variable, element, world, |_| Ok(value))?;
            }
            Data::SetTool { variable, tool } => {
                let tool = self.natural(tool, "the tool", MAX_COUNT, world)?;
                let mut position = self.position(variable, world)?.position;
                position.tool = tool;
                self.store_position(variable, position, world)?;
            }
            Data::GetElement { variable, source, element } => {
                let target = self.position(source, world)?;
                let (_, count) = self.element(&target, element, world)?;
                self.store(variable, count, world)?;
            }
            Data::GetSystem { variable, source } => self.get_system(variable, source, world)?,
            Data::Convert { variable, source, frame, tool } => {
                let source = self.position(source, world)?.position;
                let frame = self.frame(frame, world)?;
                let tool =
                    tool.as_ref().map(|t| self.natural(t, "the tool", MAX_COUNT, world)).transpose()?;
                let tool = tool.unwrap_or(source.tool);
                let converted = world
                    .convert(&source, frame, tool)
                    .ok_or_else(|| unavailable(variable.column, "the position in that frame"))?;
                self.store_position(variable, converted, world)?;
            }
            Data::GetArgument { variable, number } => self.get_argument(variable, number, world)?,
        }
        Ok(Outcome::Nothing)
    }

    /// Sets an output, and says so.
    pub(super) fn set_output(
        &mut self,
        signal: &SignalReference,
        value: f64,
        world: &mut impl World,
    ) -> Run<Output> {
        let (kind, number) = (signal.kind, self.index(&signal.number, world)?);
        let value = bits(kind, value);
        self.outputs.set(kind, number, value);
        Ok(Output::Digital { kind, number, value })
    }

    fn set(&mut self, variable: &Variable, value: &Expression, world: &mut impl World) -> Run<()> {
        if variable.kind.is_position() {
            let Node::Variable(source) = &value.node else {
                return Err(unavailable(value.column, "the position"));
            };
            let position = self.position(source, world)?.position;
            return self.store_position(variable, position, world);
        }
        match self.value(value, world)? {
            Value::Number(number) => self.store(variable, number, world),
            Value::Text(text) => self.store_text(variable, text, world),
        }
    }

    fn arithmetic(
        &mut self,
        operation: Arithmetic,
        variable: &Variable,
        element: Option<&Expression>,
        value: &Expression,
        world: &mut impl World,
    ) -> Run<()> {
        match element {
            Some(element) => {
                let operand = self.number(value, world)?;
                self.change_element(variable, element, world, |old| {
                    compute(operation, old, operand, value.column)
                })
            }
            None if variable.kind.is_position() => self.add_positions(operation, variable, value, world),
            None => {
                let operand = self.number(value, world)?;
                let index = self.index(&variable.index, world)?;
                let old = self.scope_mut(variable).number(variable.kind, index);
                let result = compute(operation, old, operand, value.column)?;
                self.store(variable, result, world)
            }
        }
    }

    /// ADD and SUB of whole positions, element by element; both must have the same form.
    fn add_positions(
        &mut self,
        operation: Arithmetic,
        variable: &Variable,
        value: &Expression,
        world: &mut impl World,
    ) -> Run<()> {
        let Node::Variable(other) = &value.node else {
            return Err(unavailable(value.column, "the position"));
        };
        let mut target = self.position(variable, world)?;
        let other = self.position(other, world)?;
        let form = target.position.coordinates.form();
        if other.position.coordinates.form() != form {
            let mistake = Mistake::WrongPosition {
                name: other.to_string(),
                found: other.position.coordinates.form(),
                expected: form,
            };
            return Err(Fault { column: value.column, mistake });
        }
        let coordinates = &mut target.position.coordinates;
        for element in 1..=coordinates.elements() {
            let operands = (coordinates.element(element), other.position.coordinates.element(element));
            let (Some(a), Some(b)) = operands else { continue };
            coordinates.set_element(element, compute(operation, a, b, value.column)?);
        }
        self.store_position(variable, target.position, world)
    }

    fn function(&self, function: Function, value: &Expression, world: &mut impl World) -> Run<f64> {
        let x = self.number(value, world)?;
        match function {
            Function::Sqrt if x < 0.0 => {
                Err(Fault { column: value.column, mistake: Mistake::NegativeRoot { value: x } })
            }
            Function::Sqrt => Ok(x.sqrt()),
            Function::Sin => Ok(x.to_radians().sin()),
            Function::Cos => Ok(x.to_radians().cos()),
            Function::Atan => Ok(x.atan().to_degrees()),
        }
    }

    fn bitwise(
        &mut self,
        operation: Bitwise,
        variable: &Variable,
        value: &Expression,
        world: &mut impl World,
    ) -> Run<()> {
        const BYTE: f64 = 255.0;
        let operand = self.natural(value, "the operand", BYTE, world)?;
        let index = self.index(&variable.index, world)?;
        // B variables are bytes: the cast is exact.
        let old = self.scope_mut(variable).number(VariableKind::B, index) as u32;
        let result = match operation {
            Bitwise::And => old & operand,
            Bitwise::Or => old | operand,
            Bitwise::Xor => old ^ operand,
            Bitwise::Not => !operand & 0xff,
        };
        self.store(variable, f64::from(result), world)
    }

    /// Number and value of one element of a position.
    fn element(&self, target: &Target, element: &Expression, world: &mut impl World) -> Run<(usize, f64)> {
        let number = self.natural(element, "the element", MAX_ELEMENT, world)? as usize;
        let coordinates = &target.position.coordinates;
        match coordinates.element(number) {
            Some(value) => Ok((number, value)),
            None => {
                // At most 8 elements: the cast is exact.
                let (value, max) = (number as f64, coordinates.elements() as f64);
                let mistake = Mistake::OutOfRange { what: "the element", value, min: 1.0, max };
                Err(Fault { column: element.column, mistake })
            }
        }
    }

    fn change_element(
        &mut self,
        variable: &Variable,
        element: &Expression,
        world: &mut impl World,
        change: impl FnOnce(f64) -> Run<f64>,
    ) -> Run<()> {
        let mut target = self.position(variable, world)?;
        let (number, old) = self.element(&target, element, world)?;
        let value = change(old)?;
        if !target.position.coordinates.set_element(number, value) {
            let (min, max) = (f64::from(i32::MIN), f64::from(i32::MAX));
            let mistake = Mistake::OutOfRange { what: "the pulses", value, min, max };
            return Err(Fault { column: element.column, mistake });
        }
        self.store_position(variable, target.position, world)
    }

    fn get_system(&mut self, variable: &Variable, source: &str, world: &mut impl World) -> Run<()> {
        let missing = |what: &str| unavailable(variable.column, what);
        if source == "$RV" {
            return match self.returned.clone() {
                Some(Value::Number(number)) => self.store(variable, number, world),
                Some(Value::Text(text)) => self.store_text(variable, text, world),
                None => Err(Fault { column: variable.column, mistake: Mistake::NoReturnValue }),
            };
        }
        let current = world.current_position().ok_or_else(|| missing("the robot's position"))?;
        let position = if source == "$PX001" {
            let converted = world.convert(&current, Frame::Base, current.tool);
            converted.ok_or_else(|| missing("the robot's position in the base frame"))?
        } else {
            current
        };
        if !variable.kind.is_position() {
            let expected = position.coordinates.form();
            let mistake =
                Mistake::WrongPosition { name: variable.to_string(), found: "no position", expected };
            return Err(Fault { column: variable.column, mistake });
        }
        self.store_position(variable, position, world)
    }

    fn get_argument(&mut self, variable: &Variable, number: &Expression, world: &mut impl World) -> Run<()> {
        let wanted = self.natural(number, "the argument", MAX_ELEMENT, world)?;
        let arguments = self.calls.last().map_or(&[][..], |call| &call.arguments);
        let value = (wanted as usize).checked_sub(1).and_then(|i| arguments.get(i)).cloned();
        match value {
            Some(Value::Number(value)) => self.store(variable, value, world),
            Some(Value::Text(text)) => self.store_text(variable, text, world),
            None => {
                let mistake = Mistake::MissingArgument { number: wanted, passed: arguments.len() };
                Err(Fault { column: number.column, mistake })
            }
        }
    }

    pub(super) fn store(&mut self, variable: &Variable, value: f64, world: &mut impl World) -> Run<()> {
        let index = self.index(&variable.index, world)?;
        if variable.kind.range().is_none() {
            return Err(wrong_kind(variable, "a number"));
        }
        let set = self.scope_mut(variable).set_number(variable.kind, index, value);
        set.map_err(|mistake| Fault { column: variable.column, mistake })
    }

    fn store_text(&mut self, variable: &Variable, text: Vec<u8>, world: &mut impl World) -> Run<()> {
        let index = self.index(&variable.index, world)?;
        if variable.kind != VariableKind::S {
            return Err(wrong_kind(variable, "a text"));
        }
        self.scope_mut(variable).set_text(index, text);
        Ok(())
    }

    fn store_position(
        &mut self,
        variable: &Variable,
        position: JobPosition,
        world: &mut impl World,
    ) -> Run<()> {
        let index = self.index(&variable.index, world)?;
        self.scope_mut(variable).set_position(variable.kind, index, position);
        Ok(())
    }
}

fn compute(operation: Arithmetic, a: f64, b: f64, column: u32) -> Run<f64> {
    match operation {
        Arithmetic::Add => Ok(a + b),
        Arithmetic::Subtract => Ok(a - b),
        Arithmetic::Multiply => Ok(a * b),
        Arithmetic::Divide if b == 0.0 => Err(Fault { column, mistake: Mistake::DivisionByZero }),
        Arithmetic::Divide => Ok(a / b),
    }
}

fn wrong_kind(variable: &Variable, found: &'static str) -> Fault {
    let expected = match variable.kind {
        VariableKind::S => "a text",
        kind if kind.is_position() => "a position",
        _ => "a number",
    };
    Fault { column: variable.column, mistake: Mistake::WrongType { found, expected } }
}
