//! Every variable, signal and expression of an instruction, for checks that look at all of them.

use super::expression::{Expression, Index, Node, SignalReference, Variable};
use super::instruction::{
    ArcTags, Data, Flow, FrameTag, Instruction, Io, MoveInstruction, OutputValue, PositionReference,
    WeaveTags, Weld,
};

/// A part of an instruction that reads or writes something.
#[derive(Debug, Clone, Copy)]
pub(super) enum Part<'a> {
    Variable(&'a Variable),
    Signal(&'a SignalReference),
    Expression(&'a Expression),
}

/// Calls `visit` for each variable that the instruction reads or writes, in computed indices too.
pub(super) fn variables<'a>(instruction: &'a Instruction, visit: &mut impl FnMut(&'a Variable)) {
    nodes(instruction, &mut |part| {
        if let Found::Variable(variable) = part {
            visit(variable);
        }
    });
}

/// Whether the instruction reads a system variable, flag or register in an expression.
pub(super) fn reads_system(instruction: &Instruction) -> bool {
    let mut found = false;
    nodes(instruction, &mut |part| found |= matches!(part, Found::System));
    found
}

/// What the walk reports.
enum Found<'a> {
    Variable(&'a Variable),
    System,
}

fn nodes<'a>(instruction: &'a Instruction, visit: &mut impl FnMut(Found<'a>)) {
    let mut waiting = parts(instruction);
    // Ends: every turn takes one part away, and parts lie strictly inside the one that they replace.
    while let Some(part) = waiting.pop() {
        match part {
            Part::Variable(variable) => {
                visit(Found::Variable(variable));
                waiting.extend(inside(&variable.index));
            }
            Part::Signal(signal) => waiting.extend(inside(&signal.number)),
            Part::Expression(expression) => match &expression.node {
                Node::Number { .. } | Node::State(_) | Node::Text(_) => {}
                Node::Variable(variable) => waiting.push(Part::Variable(variable)),
                Node::Signal(signal) => waiting.push(Part::Signal(signal)),
                Node::System(_) => visit(Found::System),
                Node::Negated(inner) | Node::Not(inner) => waiting.push(Part::Expression(inner)),
                Node::Binary { left, right, .. } => {
                    waiting.extend([Part::Expression(left), Part::Expression(right)]);
                }
            },
        }
    }
}

fn inside(index: &Index) -> Option<Part<'_>> {
    match index {
        Index::Fixed(_) => None,
        Index::Computed(expression) => Some(Part::Expression(expression)),
    }
}

fn parts(instruction: &Instruction) -> Vec<Part<'_>> {
    let mut list = List(Vec::new());
    match instruction {
        Instruction::Nop | Instruction::Label(_) | Instruction::Disabled | Instruction::Other { .. } => {}
        Instruction::Move(step) => list.moves(step),
        Instruction::Speed(tags) => list.expressions(tags.iter().map(|tag| &tag.value)),
        Instruction::Flow(flow) => list.flow(flow),
        Instruction::Data(data) => list.data(data),
        Instruction::Io(io) => list.io(io),
        Instruction::Weld(Weld::ArcOn(tags) | Weld::ArcOff(tags) | Weld::ArcSet(tags)) => list.arc(tags),
        Instruction::Weld(Weld::WeaveOn(tags)) => list.weave(tags),
        Instruction::Weld(Weld::MemoryOn { file, .. }) => list.expressions([file.as_ref()]),
        Instruction::Weld(Weld::WeaveOff | Weld::TrackOn(_) | Weld::TrackOff | Weld::MemoryOff) => {}
    }
    list.0
}

struct List<'a>(Vec<Part<'a>>);

impl<'a> List<'a> {
    fn expressions(&mut self, expressions: impl IntoIterator<Item = &'a Expression>) {
        self.0.extend(expressions.into_iter().map(Part::Expression));
    }

    fn variable(&mut self, variable: &'a Variable) {
        self.0.push(Part::Variable(variable));
    }

    fn frame(&mut self, frame: &'a FrameTag) {
        if let FrameTag::User(index) = frame {
            self.0.extend(inside(index));
        }
    }

    fn moves(&mut self, first: &'a MoveInstruction) {
        for step in std::iter::once(first).chain(&first.others) {
            for reference in step.target.iter().chain(&step.external) {
                if let PositionReference::Variable(variable) = reference {
                    self.variable(variable);
                }
            }
            self.expressions(step.speed.iter().map(|tag| &tag.value));
            self.expressions(&step.position_level);
            self.expressions(&step.corner_radius);
            self.expressions(&step.acceleration);
            self.expressions(&step.deceleration);
            self.expressions(&step.until);
            if let Some(frame) = &step.frame {
                self.frame(frame);
            }
        }
    }

    fn flow(&mut self, flow: &'a Flow) {
        match flow {
            Flow::Jump { condition, .. } | Flow::Pause { condition } | Flow::Abort { condition } => {
                self.expressions(condition);
            }
            Flow::Call { arguments, condition, .. } => self.expressions(arguments.iter().chain(condition)),
            Flow::Return { value, condition } => self.expressions(value.iter().chain(condition)),
            Flow::If(e)
            | Flow::AndIf(e)
            | Flow::OrIf(e)
            | Flow::ElseIf(e)
            | Flow::While(e)
            | Flow::Switch(e) => self.expressions([e]),
            Flow::For { variable, start, end, step } => {
                self.variable(variable);
                self.expressions([start, end].into_iter().chain(step));
            }
            Flow::Next(variable) => self.variable(variable),
            Flow::Case(values) => self.expressions(values),
            Flow::End | Flow::Else | Flow::EndIf | Flow::EndWhile | Flow::Default | Flow::EndSwitch => {}
        }
    }

    fn data(&mut self, data: &'a Data) {
        match data {
            Data::Set { variable, value }
            | Data::Function { variable, value, .. }
            | Data::Bitwise { variable, value, .. } => {
                self.variable(variable);
                self.expressions([value]);
            }
            Data::SetSignal { signal, value } => {
                self.0.push(Part::Signal(signal));
                self.expressions([value]);
            }
            Data::Arithmetic { variable, element, value, .. } => {
                self.variable(variable);
                self.expressions(element.iter().chain([value]));
            }
            Data::Step { variable, .. } | Data::GetSystem { variable, .. } => self.variable(variable),
            Data::Clear { variable, count } => {
                self.variable(variable);
                self.expressions(count);
            }
            Data::ClearStack => {}
            Data::SetElement { variable, element, value } => {
                self.variable(variable);
                self.expressions([element, value]);
            }
            Data::SetTool { variable, tool: value } | Data::GetArgument { variable, number: value } => {
                self.variable(variable);
                self.expressions([value]);
            }
            Data::GetElement { variable, source, element } => {
                self.variable(variable);
                self.variable(source);
                self.expressions([element]);
            }
            Data::Convert { variable, source, frame, tool } => {
                self.variable(variable);
                self.variable(source);
                self.frame(frame);
                self.expressions(tool);
            }
        }
    }

    fn io(&mut self, io: &'a Io) {
        match io {
            Io::Timer { time } => self.expressions([time]),
            Io::Wait { condition, timeout } => self.expressions([condition].into_iter().chain(timeout)),
            Io::DigitalOutput { signal, value } => {
                self.0.push(Part::Signal(signal));
                if let OutputValue::Value(value) = value {
                    self.expressions([value]);
                }
            }
            Io::Pulse { signal, value, time } => {
                self.0.push(Part::Signal(signal));
                self.expressions(value.iter().chain(time));
            }
            Io::DigitalInput { variable, signal } => {
                self.variable(variable);
                self.0.push(Part::Signal(signal));
            }
            Io::AnalogOutput { port, value } => self.expressions([port, value]),
            Io::Message { text } => self.expressions([text]),
            Io::Alarm { code, text, subcode, stop_mode } => {
                self.expressions([code].into_iter().chain(text).chain(subcode).chain(stop_mode));
            }
        }
    }

    fn arc(&mut self, tags: &'a ArcTags) {
        let ArcTags { file, current, voltage, voltage_percent, time, speed, .. } = tags;
        self.expressions([file, current, voltage, voltage_percent, time, speed].into_iter().flatten());
    }

    fn weave(&mut self, tags: &'a WeaveTags) {
        let WeaveTags { file, amplitude, frequency, angle, direction, .. } = tags;
        self.expressions([file, amplitude, frequency, angle, direction].into_iter().flatten());
    }
}
