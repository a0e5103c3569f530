//! The text of a cell file as a tree that remembers where each key and value stood, laid over the default's.

use std::collections::BTreeMap;

use toml::de::{DeTable, DeValue};

use super::error::{CellError, Problem};

/// The file that a piece of the tree comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Origin {
    Default,
    User,
}

/// A range of bytes in one of the files.
#[derive(Debug, Clone, Copy)]
pub(super) struct Span {
    pub(super) origin: Origin,
    pub(super) start: usize,
    pub(super) end: usize,
}

/// A value and where it stands.
#[derive(Debug)]
pub(super) struct Node {
    pub(super) span: Span,
    pub(super) value: Value,
}

#[derive(Debug)]
pub(super) enum Value {
    Table(Table),
    Array(Vec<Node>),
    Text(String),
    /// A float, or a whole number outside `i64`.
    Float(f64),
    Integer(i64),
    Boolean(bool),
    Datetime,
}

pub(super) type Table = BTreeMap<String, Entry>;

/// A key's place and its value.
#[derive(Debug)]
pub(super) struct Entry {
    pub(super) key: Span,
    pub(super) node: Node,
}

/// Keys of which a table has only one: a file's own choice replaces the default's.
const ALTERNATIVES: [(&str, &str); 2] = [("voltage_v", "voltage_percent"), ("frequency_hz", "wavelength_mm")];

/// A cell file laid over the default.
#[derive(Debug)]
pub(super) struct Document {
    pub(super) sources: Sources,
    pub(super) root: Node,
}

impl Document {
    /// The user's text laid over the default's: tables key by key, arrays of tables by their `number`, anything
    /// else replaced whole.
    pub(super) fn parse(name: &str, text: &str, default: &str) -> Result<Self, CellError> {
        let sources = Sources {
            user: Source { name: name.to_owned(), text: text.to_owned() },
            default: Source { name: "default cell".to_owned(), text: default.to_owned() },
        };
        let mut root = sources.tree(Origin::Default)?;
        let over = sources.tree(Origin::User)?;
        forget_other_robot(&mut root, &over);
        sources.overlay(&mut root, over, "")?;
        let span = Span { origin: Origin::User, start: 0, end: 0 };
        Ok(Self { sources, root: Node { span, value: Value::Table(root) } })
    }
}

/// The texts that errors point into.
#[derive(Debug)]
pub(super) struct Sources {
    user: Source,
    default: Source,
}

#[derive(Debug)]
struct Source {
    name: String,
    text: String,
}

impl Sources {
    fn source(&self, origin: Origin) -> &Source {
        match origin {
            Origin::Default => &self.default,
            Origin::User => &self.user,
        }
    }

    fn tree(&self, origin: Origin) -> Result<Table, CellError> {
        let parsed = DeTable::parse(&self.source(origin).text).map_err(|error| {
            let span = error.span().unwrap_or_default();
            let reason = error.message().to_owned();
            self.error(Span { origin, start: span.start, end: span.end }, "", Problem::Syntax(reason))
        })?;
        Ok(table(parsed.get_ref(), origin))
    }

    /// The text of a span as written: its first line, at most 40 characters.
    pub(super) fn quote(&self, span: Span) -> String {
        let text = self.source(span.origin).text.get(span.start..span.end).unwrap_or_default();
        let line = text.lines().next().unwrap_or_default();
        let mut quote: String = line.chars().take(40).collect();
        if quote.len() < text.len() {
            quote.push('…');
        }
        quote
    }

    /// The line of a span, from 1.
    pub(super) fn line(&self, span: Span) -> usize {
        line_and_column(&self.source(span.origin).text, span.start).0
    }

    pub(super) fn error(&self, span: Span, key: &str, problem: Problem) -> CellError {
        let source = self.source(span.origin);
        CellError {
            file: source.name.clone(),
            place: Some(line_and_column(&source.text, span.start)),
            key: key.to_owned(),
            problem,
        }
    }

    fn overlay(&self, base: &mut Table, over: Table, path: &str) -> Result<(), CellError> {
        for (a, b) in ALTERNATIVES {
            if over.contains_key(a) || over.contains_key(b) {
                base.remove(a);
                base.remove(b);
            }
        }
        for (key, entry) in over {
            let path = if path.is_empty() { key.clone() } else { format!("{path}.{key}") };
            let below = base.remove(&key).map(|entry| entry.node.value);
            let Node { span, value } = entry.node;
            let value = match (below, value) {
                (below, Value::Table(over)) => {
                    let mut table = table_in(below);
                    self.overlay(&mut table, over, &path)?;
                    Value::Table(table)
                }
                // A single table headed by double brackets: the reader says so.
                (Some(Value::Table(_)), over) => over,
                (below, Value::Array(over)) if is_array_of_tables(&over) => {
                    let mut nodes = if let Some(Value::Array(nodes)) = below { nodes } else { Vec::new() };
                    self.overlay_numbered(&mut nodes, over, &path)?;
                    Value::Array(nodes)
                }
                (_, over) => over,
            };
            base.insert(key, Entry { key: entry.key, node: Node { span, value } });
        }
        Ok(())
    }

    /// The number that tells a table of an array from its neighbours.
    fn number(&self, node: &Node, path: &str) -> Result<i64, CellError> {
        let expected = "a whole number in each of these tables".to_owned();
        let written = match &node.value {
            Value::Table(table) => table.get("number").map(|entry| entry.node.span),
            _ => None,
        };
        number_of(node).ok_or_else(|| {
            let problem = match written {
                Some(span) => Problem::Value { found: self.quote(span), expected },
                None => Problem::Missing { expected },
            };
            self.error(written.unwrap_or(node.span), &format!("{path}.number"), problem)
        })
    }

    fn overlay_numbered(&self, base: &mut Vec<Node>, over: Vec<Node>, path: &str) -> Result<(), CellError> {
        let mut seen: BTreeMap<i64, Span> = BTreeMap::new();
        for node in over {
            let number = self.number(&node, path)?;
            let path = format!("{path}[{number}]");
            if let Some(first) = seen.insert(number, node.span) {
                let first_line = self.line(first);
                return Err(self.error(node.span, &path, Problem::DuplicateNumber { first_line }));
            }
            let same = base.iter().position(|other| number_of(other) == Some(number));
            let mut table = table_in(same.map(|index| base.swap_remove(index).value));
            self.overlay(&mut table, table_in(Some(node.value)), &path)?;
            base.push(Node { span: node.span, value: Value::Table(table) });
        }
        Ok(())
    }
}

/// The default's joints belong to the default's robot: a file with another robot brings its own.
fn forget_other_robot(default: &mut Table, user: &Table) {
    let Some(Value::Table(user)) = user.get("robot").map(|entry| &entry.node.value) else { return };
    let Some(Value::Text(model)) = user.get("model").map(|entry| &entry.node.value) else { return };
    let Some(Value::Table(default)) = default.get_mut("robot").map(|entry| &mut entry.node.value) else {
        return;
    };
    if !matches!(default.get("model").map(|entry| &entry.node.value), Some(Value::Text(own)) if own == model)
    {
        default.clear();
    }
}

/// The table that a value is; an empty one if it is none.
fn table_in(value: Option<Value>) -> Table {
    if let Some(Value::Table(table)) = value { table } else { Table::new() }
}

fn is_array_of_tables(nodes: &[Node]) -> bool {
    !nodes.is_empty() && nodes.iter().all(|node| matches!(node.value, Value::Table(_)))
}

/// The `number` of a table, if it has one.
pub(super) fn number_of(node: &Node) -> Option<i64> {
    let Value::Table(table) = &node.value else { return None };
    match table.get("number")?.node.value {
        Value::Integer(number) => Some(number),
        _ => None,
    }
}

fn table(table: &DeTable<'_>, origin: Origin) -> Table {
    table
        .iter()
        .map(|(key, value)| {
            let span = span(key.span(), origin);
            (key.get_ref().to_string(), Entry { key: span, node: node(value, origin) })
        })
        .collect()
}

fn node(spanned: &toml::Spanned<DeValue<'_>>, origin: Origin) -> Node {
    let value = match spanned.get_ref() {
        DeValue::Table(inner) => Value::Table(table(inner, origin)),
        DeValue::Array(inner) => Value::Array(inner.iter().map(|value| node(value, origin)).collect()),
        DeValue::String(text) => Value::Text(text.to_string()),
        DeValue::Float(float) => Value::Float(float.as_str().parse().unwrap_or(f64::NAN)),
        DeValue::Integer(integer) => match i64::from_str_radix(integer.as_str(), integer.radix()) {
            Ok(integer) => Value::Integer(integer),
            Err(_) => Value::Float(integer.as_str().parse().unwrap_or(f64::INFINITY)),
        },
        DeValue::Boolean(boolean) => Value::Boolean(*boolean),
        DeValue::Datetime(_) => Value::Datetime,
    };
    Node { span: span(spanned.span(), origin), value }
}

fn span(range: std::ops::Range<usize>, origin: Origin) -> Span {
    Span { origin, start: range.start, end: range.end }
}

/// Line and column of a byte offset, from 1; columns count characters.
pub(super) fn line_and_column(text: &str, offset: usize) -> (usize, usize) {
    let before = text.get(..offset).unwrap_or(text);
    let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
    (before.matches('\n').count() + 1, before[line_start..].chars().count() + 1)
}
