//! Tables of a scene file: checked as a whole against their kind when they are opened, then read without further ado.

use std::path::Path;

use glam::{DVec2, DVec3, Vec3};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::key::{Default, Key, Kind, Value};
use super::value::{check, color, found, integer, nearest, number, numbers};
use crate::error::Error;

/// A scene file's name and text, for messages.
#[derive(Clone, Copy, Debug)]
pub(super) struct Source<'a> {
    pub path: &'a Path,
    pub text: &'a str,
}

/// A table whose keys and values are those of its kind.
#[derive(Clone, Debug)]
pub(super) struct Table<'a> {
    pub source: Source<'a>,
    kind: &'static Kind,
    tag: Option<&'a str>,
    entries: &'a DeTable<'a>,
    /// Where it stands in the text.
    start: usize,
}

impl Source<'_> {
    /// An error at a byte of the text.
    pub(super) fn error(&self, byte: usize, detail: impl Into<String>) -> Error {
        let before = &self.text[..byte.min(self.text.len())];
        let line = before.matches('\n').count() + 1;
        let column = before
            .rsplit('\n')
            .next()
            .map_or(0, |last| last.chars().count())
            + 1;
        Error::Toml {
            path: self.path.to_owned(),
            line,
            column,
            detail: detail.into(),
        }
    }
}

impl<'a> Table<'a> {
    /// Opens a table that begins at the byte `start`.
    ///
    /// # Errors
    /// A key that the kind does not have, with the nearest that it has; one that is missing; a value of another type
    /// or out of range.
    pub(super) fn open(
        source: Source<'a>,
        kind: &'static Kind,
        entries: &'a DeTable<'a>,
        start: usize,
    ) -> Result<Self, Error> {
        let mut table = Self {
            source,
            kind,
            tag: None,
            entries,
            start,
        };
        if let Some(tag) = kind.tag {
            let key = kind.keys.iter().find(|key| key.name == tag);
            if let (Some(key), Some(value)) = (key, entries.get(tag)) {
                table.check_value(key, value)?;
                table.tag = value.get_ref().as_str();
            } else if key.is_some_and(|key| matches!(key.default, Default::Required)) {
                return Err(table.missing(tag));
            }
        }
        for (name, value) in entries {
            let key = kind.key(name.get_ref(), table.tag);
            let key = key.ok_or_else(|| table.unknown(name.get_ref(), name.span().start))?;
            table.check_value(key, value)?;
        }
        for key in kind.keys_of(table.tag) {
            if matches!(key.default, Default::Required) && !table.has(key.name) {
                return Err(table.missing(key.name));
            }
        }
        Ok(table)
    }

    fn missing(&self, key: &str) -> Error {
        let of = self
            .tag
            .map_or(String::new(), |tag| format!(" of kind '{tag}'"));
        self.error(format!(
            "this {}{of} has no '{key}'; it must be given",
            self.kind.name
        ))
    }

    fn unknown(&self, name: &str, byte: usize) -> Error {
        let keys = || self.kind.keys_of(self.tag).map(|key| key.name);
        let of = self
            .tag
            .map_or(String::new(), |tag| format!(" of kind '{tag}'"));
        let elsewhere = self.tag.and_then(|_| self.kind.key(name, None));
        let hint = match (elsewhere, nearest(name, keys())) {
            (Some(key), _) => format!("it belongs to {}", key.of.join(", ")),
            (None, Some(near)) => format!("did you mean '{near}'?"),
            (None, None) => format!("it has {}", keys().collect::<Vec<_>>().join(", ")),
        };
        self.source.error(
            byte,
            format!("a {}{of} has no key '{name}'; {hint}", self.kind.name),
        )
    }

    /// An error at the table.
    pub(super) fn error(&self, detail: impl Into<String>) -> Error {
        self.source.error(self.start, detail)
    }

    /// An error at a key of it.
    pub(super) fn error_at(&self, key: &str, detail: impl Into<String>) -> Error {
        let at = self
            .entries
            .get(key)
            .map_or(self.start, |value| value.span().start);
        self.source.error(at, format!("{key}: {}", detail.into()))
    }

    /// Whether a key is given.
    pub(super) fn has(&self, key: &str) -> bool {
        self.entries.contains_key(key)
    }

    /// Whether its kind has a key.
    pub(super) fn may_have(&self, key: &str) -> bool {
        self.kind.key(key, self.tag).is_some()
    }

    /// The value of the key that decides which others there are.
    pub(super) fn tag(&self) -> &'a str {
        self.tag.unwrap_or_default()
    }

    fn value(&self, key: &str) -> Option<&'a DeValue<'a>> {
        self.entries.get(key).map(Spanned::get_ref)
    }

    fn default(&self, key: &str) -> Option<&'static Default> {
        self.kind.key(key, self.tag).map(|key| &key.default)
    }

    /// A number, or its default; `None` if it has none.
    pub(super) fn number(&self, key: &str) -> Option<f64> {
        self.value(key)
            .and_then(number)
            .or(match self.default(key) {
                Some(Default::Number(number)) => Some(*number),
                _ => None,
            })
    }

    /// A number whose key has a default or is required.
    pub(super) fn sure_number(&self, key: &str) -> f64 {
        self.number(key).unwrap_or(0.0)
    }

    /// A whole number, or its default.
    pub(super) fn count(&self, key: &str) -> u32 {
        let given = self.value(key).and_then(integer);
        let default = match self.default(key) {
            Some(Default::Count(count)) => *count,
            _ => 0,
        };
        u32::try_from(given.unwrap_or(default)).unwrap_or(0)
    }

    /// A flag, or its default.
    pub(super) fn flag(&self, key: &str) -> Option<bool> {
        self.value(key)
            .and_then(DeValue::as_bool)
            .or(match self.default(key) {
                Some(Default::Flag(flag)) => Some(*flag),
                _ => None,
            })
    }

    /// Text, or its default.
    pub(super) fn text(&self, key: &str) -> Option<&'a str> {
        self.value(key)
            .and_then(DeValue::as_str)
            .or(match self.default(key) {
                Some(Default::Text(text)) => Some(*text),
                _ => None,
            })
    }

    /// Numbers of a list, or their default.
    pub(super) fn numbers(&self, key: &str) -> Option<Vec<f64>> {
        self.value(key)
            .and_then(numbers)
            .or(match self.default(key) {
                Some(Default::Numbers(numbers)) => Some(numbers.to_vec()),
                _ => None,
            })
    }

    /// Three numbers.
    pub(super) fn vec3(&self, key: &str) -> Option<DVec3> {
        match *self.numbers(key)? {
            [x, y, z] => Some(DVec3::new(x, y, z)),
            _ => None,
        }
    }

    /// Three numbers whose key has a default or is required.
    pub(super) fn sure_vec3(&self, key: &str) -> DVec3 {
        self.vec3(key).unwrap_or(DVec3::ZERO)
    }

    /// Two numbers.
    pub(super) fn vec2(&self, key: &str) -> Option<DVec2> {
        match *self.numbers(key)? {
            [x, y] => Some(DVec2::new(x, y)),
            _ => None,
        }
    }

    /// A number for all axes, or one for each.
    pub(super) fn scale(&self, key: &str) -> DVec3 {
        let one = self.value(key).and_then(number).map(DVec3::splat);
        one.or_else(|| self.vec3(key)).unwrap_or(DVec3::ONE)
    }

    /// A linear colour.
    pub(super) fn color(&self, key: &str) -> Option<Vec3> {
        self.value(key).and_then(color)
    }

    /// Two linear colours.
    pub(super) fn colors(&self, key: &str) -> Option<[Vec3; 2]> {
        match self.value(key)?.as_array()?.iter().collect::<Vec<_>>()[..] {
            [a, b] => Some([color(a.get_ref())?, color(b.get_ref())?]),
            _ => None,
        }
    }

    /// Rows of four numbers.
    pub(super) fn rows(&self, key: &str) -> Option<Vec<Vec<f64>>> {
        let rows = self.value(key)?.as_array()?.iter();
        rows.map(|row| numbers(row.get_ref())).collect()
    }

    /// Texts of a list with their places.
    pub(super) fn texts(&self, key: &str) -> Vec<&'a str> {
        let list = self.value(key).and_then(DeValue::as_array);
        let texts = list.into_iter().flat_map(|list| list.iter());
        texts.filter_map(|text| text.get_ref().as_str()).collect()
    }

    /// The table at a key.
    pub(super) fn table(&self, key: &str) -> Result<Option<Self>, Error> {
        let kind = match self.kind.key(key, self.tag).map(|key| &key.value) {
            Some(Value::Table(kind) | Value::TextureUse(kind)) => kind,
            _ => return Ok(None),
        };
        let Some(value) = self.entries.get(key) else {
            return Ok(None);
        };
        let table = value.get_ref().as_table();
        table
            .map(|table| Self::open(self.source, kind, table, value.span().start))
            .transpose()
    }

    /// The tables at a key, with their names; in the order of the text.
    pub(super) fn named(&self, key: &str) -> Result<Vec<(&'a str, Self)>, Error> {
        let Some(Value::Named(kind)) = self.kind.key(key, self.tag).map(|key| &key.value) else {
            return Ok(Vec::new());
        };
        let Some(tables) = self.value(key).and_then(DeValue::as_table) else {
            return Ok(Vec::new());
        };
        let mut all = Vec::new();
        for (name, value) in tables {
            if let Some(table) = value.get_ref().as_table() {
                let start = name.span().start;
                all.push((
                    name.get_ref().as_ref(),
                    Self::open(self.source, kind, table, start)?,
                ));
            }
        }
        all.sort_by_key(|(_, table)| table.start);
        Ok(all)
    }

    /// The tables of the list at a key.
    pub(super) fn list(&self, key: &str) -> Result<Vec<Self>, Error> {
        let Some(Value::List(kind)) = self.kind.key(key, self.tag).map(|key| &key.value) else {
            return Ok(Vec::new());
        };
        let list = self.value(key).and_then(DeValue::as_array);
        let tables = list.into_iter().flat_map(|list| list.iter());
        tables
            .filter_map(|value| Some((value.get_ref().as_table()?, value.span().start)))
            .map(|(table, start)| Self::open(self.source, kind, table, start))
            .collect()
    }

    fn check_value(&self, key: &Key, value: &Spanned<DeValue<'_>>) -> Result<(), Error> {
        check(&key.value, value.get_ref()).map_err(|expected| {
            let found = found(value.get_ref());
            self.source.error(
                value.span().start,
                format!("{}: expected {expected}, found {found}", key.name),
            )
        })
    }
}
