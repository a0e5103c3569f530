//! Checked reading of one table: every value with its unit and range, every key accounted for.

use std::net::SocketAddr;
use std::ops::RangeInclusive;

use super::document::{Document, Entry, Node, Origin, Sources, Span, Table, Value};
use super::error::{CellError, Problem, Suggestion};
use super::nearest::nearest;

/// The unit of a value in the file, as its key's suffix says.
#[derive(Debug, Clone, Copy)]
pub(super) enum Unit {
    /// SI, or no unit.
    Plain,
    /// Thousandths: mm, ms, mm/s …
    Milli,
    /// Degrees, deg/s …
    Degree,
    /// Hundredths.
    Percent,
    /// Something per degree.
    PerDegree,
    /// Something per millimetre.
    PerMilli,
}

impl Unit {
    fn to_si(self, value: f64) -> f64 {
        match self {
            Self::Plain => value,
            Self::Milli => value / 1000.0,
            Self::Degree => value.to_radians(),
            Self::Percent => value / 100.0,
            Self::PerDegree => value.to_degrees(),
            Self::PerMilli => value * 1000.0,
        }
    }
}

/// One table of the file while it is read. [`finish`](Self::finish) refuses the keys nobody asked for.
#[derive(Debug)]
pub(super) struct Section<'a> {
    sources: &'a Sources,
    path: String,
    span: Span,
    table: &'a Table,
    asked: Vec<&'static str>,
}

impl<'a> Section<'a> {
    /// The whole file.
    pub(super) fn root(document: &'a Document) -> Result<Self, CellError> {
        Self::of(&document.sources, String::new(), &document.root)
    }

    fn of(sources: &'a Sources, path: String, node: &'a Node) -> Result<Self, CellError> {
        match &node.value {
            Value::Table(table) => Ok(Self { sources, path, span: node.span, table, asked: Vec::new() }),
            _ => Err(sources.error(node.span, &path, value_problem(sources, node.span, "a table"))),
        }
    }

    fn key(&self, key: &str) -> String {
        if self.path.is_empty() { key.to_owned() } else { format!("{}.{key}", self.path) }
    }

    /// Whether the key is there; asking makes it a known key.
    pub(super) fn has(&mut self, key: &'static str) -> bool {
        self.ask(key).is_some()
    }

    fn ask(&mut self, key: &'static str) -> Option<&'a Node> {
        if !self.asked.contains(&key) {
            self.asked.push(key);
        }
        self.table.get(key).map(|entry| &entry.node)
    }

    fn require(&mut self, key: &'static str, expected: &str) -> Result<&'a Node, CellError> {
        self.ask(key).ok_or_else(|| self.missing(key, expected))
    }

    /// The error for a key that is not there. A misspelt key is the likelier mistake: it is named before the one that
    /// is missing for it.
    pub(super) fn missing(&self, key: &'static str, expected: &str) -> CellError {
        let unasked = self.unasked().map(|(name, _)| name.as_str());
        match nearest(key, unasked).and_then(|name| self.table.get_key_value(name)) {
            Some((name, entry)) => {
                let known = Suggestion::Nearest(key.to_owned());
                self.sources.error(entry.key, &self.key(name), Problem::UnknownKey { known })
            }
            None => {
                let problem = Problem::Missing { expected: expected.to_owned() };
                self.sources.error(self.span, &self.key(key), problem)
            }
        }
    }

    fn unasked(&self) -> impl Iterator<Item = (&'a String, &'a Entry)> {
        self.table.iter().filter(|(name, _)| !self.asked.contains(&name.as_str()))
    }

    /// An error if the table holds a key that was not asked for: the first in the file.
    pub(super) fn finish(&self) -> Result<(), CellError> {
        let Some((name, entry)) = self.unasked().min_by_key(|(_, entry)| entry.key.start) else {
            return Ok(());
        };
        let known = match nearest(name, self.asked.iter().copied()) {
            Some(key) => Suggestion::Nearest(key.to_owned()),
            None => Suggestion::All(self.asked.iter().map(|&key| key.to_owned()).collect()),
        };
        Err(self.sources.error(entry.key, &self.key(name), Problem::UnknownKey { known }))
    }

    /// The error for a value that is there but not as expected.
    pub(super) fn unexpected(&self, key: &str, expected: &str) -> CellError {
        let span = self.table.get(key).map_or(self.span, |entry| entry.node.span);
        self.sources.error(span, &self.key(key), value_problem(self.sources, span, expected))
    }

    /// The error for values that contradict each other; it points at the first of them that the file itself gives.
    pub(super) fn contradiction(&self, keys: &[&str], expected: &str) -> CellError {
        let own = |key: &&&str| self.table.get(**key).is_some_and(|entry| entry.key.origin == Origin::User);
        let key = keys.iter().find(own).or(keys.first()).copied().unwrap_or_default();
        self.unexpected(key, expected)
    }

    /// Checks that one number of the table is less than another.
    pub(super) fn ordered(&self, low: (&str, f64), high: (&str, f64)) -> Result<(), CellError> {
        if low.1 < high.1 {
            return Ok(());
        }
        let (low, high) = (low.0, high.0);
        let expected = format!("{low} ({}) less than {high} ({})", self.written(low), self.written(high));
        Err(self.contradiction(&[low, high], &expected))
    }

    /// The value of a key as it is written.
    pub(super) fn written(&self, key: &str) -> String {
        self.table.get(key).map_or_else(String::new, |entry| self.sources.quote(entry.node.span))
    }

    /// A number in its edge unit within a range (also in the edge unit), converted to SI.
    pub(super) fn number(
        &mut self,
        key: &'static str,
        unit: Unit,
        range: RangeInclusive<f64>,
    ) -> Result<f64, CellError> {
        let expected = format!("a number from {} to {}", range.start(), range.end());
        let node = self.require(key, &expected)?;
        number_in(node, &range).map(|value| unit.to_si(value)).ok_or_else(|| self.unexpected(key, &expected))
    }

    /// A list of numbers, each within the range, converted to SI.
    pub(super) fn numbers(
        &mut self,
        key: &'static str,
        unit: Unit,
        range: RangeInclusive<f64>,
        count: RangeInclusive<usize>,
    ) -> Result<Vec<f64>, CellError> {
        let (least, most) = (*count.start(), *count.end());
        let how_many = if least == most { format!("{least}") } else { format!("{least} to {most}") };
        let expected = format!("a list of {how_many} numbers from {} to {}", range.start(), range.end());
        let node = self.require(key, &expected)?;
        let Value::Array(items) = &node.value else { return Err(self.unexpected(key, &expected)) };
        if !count.contains(&items.len()) {
            return Err(self.unexpected(key, &expected));
        }
        items
            .iter()
            .enumerate()
            .map(|(index, item)| {
                number_in(item, &range).map(|value| unit.to_si(value)).ok_or_else(|| {
                    let expected = format!("a number from {} to {}", range.start(), range.end());
                    let path = format!("{}[{}]", self.key(key), index + 1);
                    self.sources.error(item.span, &path, value_problem(self.sources, item.span, &expected))
                })
            })
            .collect()
    }

    /// Exactly `N` numbers.
    pub(super) fn array<const N: usize>(
        &mut self,
        key: &'static str,
        unit: Unit,
        range: RangeInclusive<f64>,
    ) -> Result<[f64; N], CellError> {
        let numbers = self.numbers(key, unit, range, N..=N)?;
        numbers.try_into().map_err(|_| self.unexpected(key, &format!("a list of {N} numbers")))
    }

    /// One number for all of `count` joints, or a list with one for each.
    pub(super) fn per_joint(
        &mut self,
        key: &'static str,
        unit: Unit,
        range: RangeInclusive<f64>,
        count: usize,
    ) -> Result<Vec<f64>, CellError> {
        let is_list = self.table.get(key).is_some_and(|entry| matches!(entry.node.value, Value::Array(_)));
        if is_list {
            self.numbers(key, unit, range, count..=count)
        } else {
            Ok(vec![self.number(key, unit, range)?; count])
        }
    }

    /// A whole number within a range.
    pub(super) fn integer(
        &mut self,
        key: &'static str,
        range: RangeInclusive<u32>,
    ) -> Result<u32, CellError> {
        let expected = format!("a whole number from {} to {}", range.start(), range.end());
        let value = match self.require(key, &expected)?.value {
            Value::Integer(value) => u32::try_from(value).ok().filter(|value| range.contains(value)),
            _ => None,
        };
        value.ok_or_else(|| self.unexpected(key, &expected))
    }

    /// True or false.
    pub(super) fn boolean(&mut self, key: &'static str) -> Result<bool, CellError> {
        let expected = "true or false";
        match self.require(key, expected)?.value {
            Value::Boolean(value) => Ok(value),
            _ => Err(self.unexpected(key, expected)),
        }
    }

    /// A text that is not empty.
    pub(super) fn text(&mut self, key: &'static str) -> Result<String, CellError> {
        let expected = "a text in quotes";
        match &self.require(key, expected)?.value {
            Value::Text(text) if !text.is_empty() => Ok(text.clone()),
            _ => Err(self.unexpected(key, expected)),
        }
    }

    /// An IP address with its port.
    pub(super) fn address(&mut self, key: &'static str) -> Result<SocketAddr, CellError> {
        let expected = "an address with a port, such as \"127.0.0.1:6510\"";
        let address = match &self.require(key, expected)?.value {
            Value::Text(text) => text.parse().ok(),
            _ => None,
        };
        address.ok_or_else(|| self.unexpected(key, expected))
    }

    /// Like [`text`](Self::text), where the key may be absent.
    pub(super) fn optional_text(&mut self, key: &'static str) -> Result<Option<String>, CellError> {
        if self.has(key) { self.text(key).map(Some) } else { Ok(None) }
    }

    /// One of several texts, each with what it stands for.
    pub(super) fn choice<T: Copy>(
        &mut self,
        key: &'static str,
        choices: &[(&str, T)],
    ) -> Result<T, CellError> {
        let names: Vec<String> = choices.iter().map(|(name, _)| format!("\"{name}\"")).collect();
        let expected = match names.as_slice() {
            [others @ .., last] if !others.is_empty() => format!("{} or {last}", others.join(", ")),
            _ => names.concat(),
        };
        let node = self.require(key, &expected)?;
        let chosen = choices
            .iter()
            .find(|(name, _)| matches!(&node.value, Value::Text(text) if text == name))
            .map(|(_, value)| *value);
        chosen.ok_or_else(|| self.unexpected(key, &expected))
    }

    /// Which of a pair of alternative keys the table has: exactly one.
    pub(super) fn alternative(
        &mut self,
        first: &'static str,
        second: &'static str,
    ) -> Result<&'static str, CellError> {
        match (self.has(first), self.has(second)) {
            (true, false) => Ok(first),
            (false, true) => Ok(second),
            (true, true) => Err(self.unexpected(second, &format!("either {first} or {second}, not both"))),
            (false, false) => Err(self.missing(first, &format!("this or {second}"))),
        }
    }

    /// A table inside this one.
    pub(super) fn section(&mut self, key: &'static str) -> Result<Section<'a>, CellError> {
        let path = self.key(key);
        let node = self.require(key, "a table")?;
        Section::of(self.sources, path, node)
    }

    /// The tables of an array, by ascending `number`; none where the key is absent.
    pub(super) fn numbered(
        &mut self,
        key: &'static str,
        range: RangeInclusive<u32>,
    ) -> Result<Vec<(u32, Section<'a>)>, CellError> {
        let Some(node) = self.ask(key) else { return Ok(Vec::new()) };
        let expected = format!("tables, each headed by [[{}]]", self.key(key));
        let Value::Array(nodes) = &node.value else { return Err(self.unexpected(key, &expected)) };
        let mut tables = Vec::with_capacity(nodes.len());
        for node in nodes {
            let number = super::document::number_of(node).ok_or_else(|| self.unexpected(key, &expected))?;
            let path = format!("{}[{number}]", self.key(key));
            let mut table = Section::of(self.sources, path, node)?;
            tables.push((table.integer("number", range.clone())?, table));
        }
        tables.sort_by_key(|(number, _)| *number);
        Ok(tables)
    }
}

fn value_problem(sources: &Sources, span: Span, expected: &str) -> Problem {
    Problem::Value { found: sources.quote(span), expected: expected.to_owned() }
}

fn number_in(node: &Node, range: &RangeInclusive<f64>) -> Option<f64> {
    let value = match node.value {
        Value::Float(value) => value,
        // Exact to 2⁵³, far beyond every range.
        #[allow(clippy::cast_precision_loss)]
        Value::Integer(value) => value as f64,
        _ => return None,
    };
    range.contains(&value).then_some(value)
}
