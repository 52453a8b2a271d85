//! Values with their keyword, unit and line.

use std::path::Path;

use files::{FileError, FileLocation};
use hifitime::Epoch;

use crate::time::{TIME_FORM, TimeSystem};

/// A keyword with its value.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Entry<'a> {
    pub(crate) keyword: &'a str,
    /// Value without surrounding space; in KVN, with the unit in brackets if there is one.
    pub(crate) value: &'a str,
    /// Attribute `units` of XML.
    pub(crate) unit: Option<&'a str>,
    pub(crate) line: u64,
}

/// Entries that belong together: a header, metadata, a state, an observation.
#[derive(Debug)]
pub(crate) struct Record<'a> {
    pub(crate) path: &'a Path,
    /// Name of its XML element; the same for KVN.
    pub(crate) name: &'a str,
    /// Line on which the record begins.
    pub(crate) line: u64,
    pub(crate) entries: Vec<Entry<'a>>,
}

impl<'a> Record<'a> {
    pub(crate) fn new(path: &'a Path, name: &'a str, line: u64) -> Self {
        Self { path, name, line, entries: Vec::new() }
    }

    /// Returns the entry of a keyword, if there is one.
    pub(crate) fn find(&self, keyword: &str) -> Option<&Entry<'a>> {
        self.entries.iter().find(|entry| entry.keyword == keyword)
    }

    /// Returns the entry of a keyword.
    ///
    /// # Errors
    /// [`FileError::Value`] at the line of the record if it is missing.
    pub(crate) fn require(&self, keyword: &str) -> Result<&Entry<'a>, FileError> {
        self.find(keyword).ok_or_else(|| {
            let expected = format!("a value in the {}", self.in_words());
            FileError::value(self.path, FileLocation::Line(self.line), keyword, "missing", expected)
        })
    }

    fn in_words(&self) -> String {
        match self.name {
            "header" | "metadata" => self.name.to_owned(),
            name => format!("record `{name}`"),
        }
    }

    /// Returns the error of an entry's value.
    pub(crate) fn refuse(&self, entry: &Entry<'_>, expected: impl Into<String>) -> FileError {
        let place = FileLocation::Line(entry.line);
        FileError::value(self.path, place, entry.keyword, entry.value, expected)
    }

    /// Parses a time.
    pub(crate) fn time(&self, entry: &Entry<'_>, system: TimeSystem) -> Result<Epoch, FileError> {
        system
            .parse_time(entry.value)
            .ok_or_else(|| self.refuse(entry, format!("{TIME_FORM}, which exists in {}", system.code())))
    }

    /// Parses a finite number in `unit`; a number without a unit is in the unit of the standard.
    pub(crate) fn number(&self, entry: &Entry<'_>, unit: &str) -> Result<f64, FileError> {
        let (number, stated) = match entry.value.split_once('[') {
            Some((number, rest)) => match rest.strip_suffix(']') {
                Some(stated) => (number.trim_end(), Some(stated.trim())),
                None => return Err(self.refuse(entry, "a number with its unit in brackets")),
            },
            None => (entry.value, entry.unit),
        };
        if let Some(stated) = stated
            && !same_unit(stated, unit)
        {
            let expected = if unit.is_empty() { "no unit".into() } else { format!("the unit {unit}") };
            return Err(self.refuse(&Entry { value: &format!("{number} [{stated}]"), ..*entry }, expected));
        }
        // `parse` reads words such as `inf` and `nan`.
        let is_number = number.bytes().all(|byte| byte.is_ascii_digit() || b"+-.eEdD".contains(&byte));
        let value = if number.contains(['d', 'D']) {
            number.replace(['d', 'D'], "e").parse::<f64>()
        } else {
            number.parse::<f64>()
        };
        match value {
            Ok(value) if is_number && value.is_finite() => Ok(value),
            _ => Err(self.refuse(entry, "a finite number")),
        }
    }

    /// Returns the number of a keyword, in `unit`.
    pub(crate) fn require_number(&self, keyword: &str, unit: &str) -> Result<f64, FileError> {
        self.number(self.require(keyword)?, unit)
    }

    /// Returns the numbers of several keywords, in one unit.
    pub(crate) fn require_numbers<const N: usize>(
        &self,
        keywords: [&str; N],
        unit: &str,
    ) -> Result<[f64; N], FileError> {
        let mut values = [0.0; N];
        for (value, keyword) in values.iter_mut().zip(keywords) {
            *value = self.require_number(keyword, unit)?;
        }
        Ok(values)
    }

    /// Checks that every keyword is one of `known`, and none is repeated.
    pub(crate) fn check_keywords(&self, known: &[&str]) -> Result<(), FileError> {
        for (index, entry) in self.entries.iter().enumerate() {
            let place = FileLocation::Line(entry.line);
            if !known.contains(&entry.keyword) {
                let expected = format!("in the {} one of {}", self.in_words(), known.join(", "));
                return Err(FileError::value(self.path, place, "keyword", entry.keyword, expected));
            }
            if self.entries.iter().take(index).any(|earlier| earlier.keyword == entry.keyword) {
                let expected = format!("{} once in the {}", entry.keyword, self.in_words());
                return Err(self.refuse(entry, expected));
            }
        }
        Ok(())
    }
}

/// Returns true if two units are equal: `KM/S` is `km/s`, `**` and `^` are powers.
fn same_unit(a: &str, b: &str) -> bool {
    let plain = |unit: &str| {
        let unit = unit.to_ascii_lowercase().replace("**", "").replace(['^', ' '], "");
        match unit.as_str() {
            "degrees" | "degree" => "deg".to_owned(),
            "n/a" => String::new(),
            _ => unit,
        }
    };
    plain(a) == plain(b)
}
