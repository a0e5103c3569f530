//! Reading of an object's members: whatever is wrong is told with its place, what was found and what was expected.

use std::fmt;

use seamline_cell::cell::nearest;
use serde_json::{Map, Value};

/// What is wrong with a question.
///
/// Displays as `limits.jerk_max[2]: found -1, expected 0 or more, or null for no limit`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Mistake(String);

impl Mistake {
    /// Something that is wrong with no member in particular.
    pub(crate) fn new(text: impl Into<String>) -> Self {
        Self(text.into())
    }

    /// A member with the wrong value.
    pub(crate) fn value(place: &str, found: &Value, expected: &str) -> Self {
        Self(format!("{place}: found {}, expected {expected}", described(found)))
    }

    /// A member that is not there.
    pub(crate) fn missing(place: &str, expected: &str) -> Self {
        Self(format!("{place}: missing, expected {expected}"))
    }
}

impl fmt::Display for Mistake {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

/// Longest text that is shown as it was found.
const SHOWN: usize = 40;

fn described(found: &Value) -> String {
    match found {
        Value::Array(items) => format!("a list of {}", items.len()),
        Value::Object(_) => "an object".to_owned(),
        Value::String(text) if text.chars().count() > SHOWN => "a long text".to_owned(),
        short => short.to_string(),
    }
}

/// What the numbers of a list may be.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Numbers {
    /// Least value.
    pub(crate) min: f64,
    /// Greatest value.
    pub(crate) max: f64,
    /// What a null stands for; none if it may not stand there.
    pub(crate) null: Option<f64>,
    /// One of them in words.
    pub(crate) expected: &'static str,
}

impl Numbers {
    /// Any numbers, none of them null.
    pub(crate) const ANY: Self =
        Self { min: f64::NEG_INFINITY, max: f64::INFINITY, null: None, expected: "a number" };

    fn read(&self, place: impl Fn() -> String, value: &Value) -> Result<f64, Mistake> {
        let number = if value.is_null() { self.null } else { value.as_f64() };
        match number {
            Some(number) if value.is_null() || (self.min <= number && number <= self.max) => Ok(number),
            _ => Err(Mistake::value(&place(), value, self.expected)),
        }
    }
}

/// Shorter names look like anything.
const LONG_ENOUGH: usize = 4;

/// An object on its line.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Object<'a> {
    place: &'static str,
    members: &'a Map<String, Value>,
}

impl<'a> Object<'a> {
    /// The object that a whole line is.
    pub(super) fn of_line(members: &'a Map<String, Value>) -> Self {
        Self { place: "", members }
    }

    /// A member's place from the line's start, such as `current.position`.
    pub(crate) fn place(&self, key: &str) -> String {
        if self.place.is_empty() { key.to_owned() } else { format!("{}.{key}", self.place) }
    }

    /// A member; null is as good as missing.
    pub(crate) fn get(&self, key: &str) -> Option<&'a Value> {
        self.members.get(key).filter(|value| !value.is_null())
    }

    /// Refuses a member that looks like a misspelt one of `keys`; all others are the user's own.
    pub(crate) fn check_spelling(&self, keys: &[&str]) -> Result<(), Mistake> {
        let misspelt = |member: &&String| member.len() >= LONG_ENOUGH && !keys.contains(&member.as_str());
        for member in self.members.keys().filter(misspelt) {
            if let Some(meant) = nearest(member, keys.iter().copied()) {
                return Err(Mistake::new(format!("{member}: unknown, did you mean {meant}?")));
            }
        }
        Ok(())
    }

    /// A member that is an object in which only `keys` may stand.
    pub(crate) fn object(&self, key: &'static str, keys: &[&str]) -> Result<Option<Object<'a>>, Mistake> {
        let Some(value) = self.get(key) else { return Ok(None) };
        let Value::Object(members) = value else {
            return Err(Mistake::value(
                &self.place(key),
                value,
                &format!("an object with {}", keys.join(", ")),
            ));
        };
        match members.keys().find(|member| !keys.contains(&member.as_str())) {
            Some(unknown) => {
                Err(Mistake::new(format!("{key}.{unknown}: unknown, expected one of {}", keys.join(", "))))
            }
            None => Ok(Some(Object { place: key, members })),
        }
    }

    /// A member that is a list; `expected` says what of.
    pub(crate) fn list(&self, key: &str, expected: &str) -> Result<Option<&'a [Value]>, Mistake> {
        match self.get(key) {
            None => Ok(None),
            Some(Value::Array(items)) => Ok(Some(items)),
            Some(other) => Err(Mistake::value(&self.place(key), other, expected)),
        }
    }

    /// Fills `into` from a list of as many numbers; nothing happens if it is missing. Says whether it was there.
    pub(crate) fn fill(&self, key: &str, numbers: &Numbers, into: &mut [f64]) -> Result<bool, Mistake> {
        match self.get(key) {
            None => Ok(false),
            Some(Value::Array(items)) if items.len() == into.len() => {
                for (index, (number, item)) in into.iter_mut().zip(items).enumerate() {
                    *number = numbers.read(|| format!("{}[{index}]", self.place(key)), item)?;
                }
                Ok(true)
            }
            Some(other) => {
                let expected = format!("a list of {} numbers", into.len());
                Err(Mistake::value(&self.place(key), other, &expected))
            }
        }
    }

    /// As [`Object::fill`], for a list that must be there.
    pub(crate) fn fill_required(
        &self,
        key: &str,
        numbers: &Numbers,
        into: &mut [f64],
    ) -> Result<(), Mistake> {
        if self.fill(key, numbers, into)? {
            return Ok(());
        }
        Err(Mistake::missing(&self.place(key), &format!("a list of {} numbers", into.len())))
    }

    /// A list of any length.
    pub(crate) fn numbers(&self, key: &str, numbers: &Numbers) -> Result<Option<Vec<f64>>, Mistake> {
        let Some(items) = self.list(key, "a list of numbers")? else { return Ok(None) };
        let mut all = vec![0.0; items.len()];
        self.fill(key, numbers, &mut all)?;
        Ok(Some(all))
    }

    /// A single number.
    pub(crate) fn number(&self, key: &str, numbers: &Numbers) -> Result<Option<f64>, Mistake> {
        self.get(key).map(|value| numbers.read(|| self.place(key), value)).transpose()
    }

    /// True or false.
    pub(crate) fn flag(&self, key: &str) -> Result<Option<bool>, Mistake> {
        let read = |value: &Value| {
            value.as_bool().ok_or_else(|| Mistake::value(&self.place(key), value, "true or false"))
        };
        self.get(key).map(read).transpose()
    }

    /// Fills `into` from true or false for all or a list of one for each; nothing happens if it is missing.
    pub(crate) fn flags(&self, key: &str, into: &mut [bool]) -> Result<(), Mistake> {
        let flag = |place: &str, value: &Value| {
            value.as_bool().ok_or_else(|| Mistake::value(place, value, "true or false"))
        };
        match self.get(key) {
            None => Ok(()),
            Some(Value::Array(items)) if items.len() == into.len() => {
                for (index, (to, item)) in into.iter_mut().zip(items).enumerate() {
                    *to = flag(&format!("{}[{index}]", self.place(key)), item)?;
                }
                Ok(())
            }
            Some(value) if value.is_boolean() => {
                into.fill(flag(&self.place(key), value)?);
                Ok(())
            }
            Some(other) => {
                let expected = format!("true, false or a list of {} of them", into.len());
                Err(Mistake::value(&self.place(key), other, &expected))
            }
        }
    }

    /// Fills `into` from a text for all or a list of one for each; nothing happens if it is missing.
    pub(crate) fn choices<T: Copy>(
        &self,
        key: &str,
        table: &[(&str, T)],
        into: &mut [T],
    ) -> Result<(), Mistake> {
        let Some(value) = self.get(key) else { return Ok(()) };
        let choice = |place: String, value: &Value| {
            let found = table.iter().find(|(name, _)| value.as_str() == Some(name));
            found.map(|(_, choice)| *choice).ok_or_else(|| {
                let names: Vec<String> = table.iter().map(|(name, _)| format!("{name:?}")).collect();
                Mistake::value(&place, value, &names.join(", "))
            })
        };
        let Value::Array(items) = value else {
            into.fill(choice(self.place(key), value)?);
            return Ok(());
        };
        if items.len() != into.len() {
            let expected = format!("one word, or a list of {}", into.len());
            return Err(Mistake::value(&self.place(key), value, &expected));
        }
        for (index, (into, item)) in into.iter_mut().zip(items).enumerate() {
            *into = choice(format!("{}[{index}]", self.place(key)), item)?;
        }
        Ok(())
    }
}
