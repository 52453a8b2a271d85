//! TOML files with explained mistakes: file, line, column, the value found, the expected value, the most
//! similar valid name.

use std::fmt;
use std::ops::Range;
use std::path::Path;

use annotate_snippets::{AnnotationKind, Group, Level, Renderer, Snippet};
use contract::OutOfRange;
use serde::Serialize;
use serde::de::DeserializeOwned;
use toml::de::{DeTable, DeValue};
use toml::{Spanned, Value};

use crate::{exact_toml, regular_file};

/// A mistake in a TOML file, with its location.
#[derive(Debug)]
pub struct TomlError {
    text: String,
    file: String,
    /// Line of the mistake, from 1.
    pub line: usize,
    /// Column of the mistake in characters, from 1.
    pub column: usize,
    span: Range<usize>,
    /// Dotted path of the key; empty if unknown.
    pub path: String,
    /// Description of the mistake, without its location.
    pub message: String,
    help: Option<String>,
}

impl TomlError {
    fn new(file: &Path, text: &str, span: Range<usize>, path: String, message: String) -> Self {
        let before = text.get(..text.floor_char_boundary(span.start)).unwrap_or(text);
        let in_line = before.rsplit('\n').next().unwrap_or(before);
        Self {
            text: text.to_owned(),
            file: file.display().to_string(),
            line: before.matches('\n').count() + 1,
            column: in_line.chars().count() + 1,
            span,
            help: nearest_valid_name(&message),
            message: in_plain_words(&message) + opencv_order(&path, &message),
            path,
        }
    }
}

impl fmt::Display for TomlError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}:{}: ", self.file, self.line, self.column)?;
        if !self.path.is_empty() && !self.message.starts_with(&self.path) {
            write!(f, "{}: ", self.path)?;
        }
        write!(f, "{}", self.message)
    }
}

impl std::error::Error for TomlError {}

impl TomlError {
    /// Returns the mistake with the surrounding lines of the file, as plain text for a terminal or a log.
    pub fn explain(&self) -> String {
        let annotation = AnnotationKind::Primary.span(self.span.clone());
        let snippet = Snippet::source(&self.text).path(&self.file).annotation(annotation);
        let title = self.to_string();
        let mut report = vec![Level::ERROR.primary_title(&title).element(snippet)];
        report.extend(self.help.as_ref().map(|help| Group::with_title(Level::HELP.secondary_title(help))));
        Renderer::plain().render(&report)
    }
}

/// Largest TOML file that is read, bytes.
const MAX_BYTES: u64 = 1 << 24;

/// Reads the text of a TOML file. A pipe or a device is rejected, because it may have no end.
///
/// # Errors
/// Those of the operating system, and for a file that is not regular, larger than 16 MiB, or not UTF-8.
pub fn read_text(file: &Path) -> std::io::Result<String> {
    regular_file::read_text(file, MAX_BYTES)
}

/// Parses `text`, the contents of `file`, as a `T`.
///
/// # Errors
/// A [`TomlError`] for text that is not TOML, an unknown key, a value of the wrong type or a missing key.
pub fn parse<T: DeserializeOwned + Serialize>(file: &Path, text: &str) -> Result<T, Box<TomlError>> {
    let refused = |error: toml::de::Error| {
        let span = error.span().filter(|span| !is_whole(span, text));
        let path = span.as_ref().and_then(|span| path_of(text, span)).unwrap_or_default();
        let message = error.message().trim().to_owned();
        Box::new(TomlError::new(file, text, span.unwrap_or(0..0), path, message))
    };
    let value = exact_toml::from_str(text).map_err(refused)?;
    let found: Value = toml::from_str(text).map(Value::Table).map_err(refused)?;
    let meant = Value::try_from(&value).ok();
    match meant.and_then(|meant| array_for_table(&found, &meant)) {
        None => Ok(value),
        Some(path) => Err(refuse(file, text, &path, "is an array, expected a table".to_owned())),
    }
}

/// Returns the dotted path of the first array that was read as a table, with its values in the order of the
/// keys: serde's tagged enums allow this where [`exact_toml`] cannot detect it.
fn array_for_table(found: &Value, meant: &Value) -> Option<String> {
    match (found, meant) {
        (Value::Array(_), Value::Table(_)) => Some(String::new()),
        (Value::Table(found), Value::Table(meant)) => found.iter().find_map(|(key, value)| {
            let path = array_for_table(value, meant.get(key)?)?;
            let joint = if path.is_empty() || path.starts_with('[') { "" } else { "." };
            Some(format!("{key}{joint}{path}"))
        }),
        (Value::Array(found), Value::Array(meant)) => {
            found.iter().zip(meant).enumerate().find_map(|(index, (found, meant))| {
                let path = array_for_table(found, meant)?;
                let joint = if path.is_empty() || path.starts_with('[') { "" } else { "." };
                Some(format!("[{index}]{joint}{path}"))
            })
        }
        _ => None,
    }
}

/// Creates the error of a value that was read but is not allowed: `path` is its dotted path, for example
/// `sensor.gain_e_per_dn` or `schedule[2].count`. The location is that of the longest part of the path that
/// exists in the file.
pub fn refuse(file: &Path, text: &str, path: &str, message: String) -> Box<TomlError> {
    let span = locate(text, path).unwrap_or(0..0);
    Box::new(TomlError::new(file, text, span, path.to_owned(), message))
}

/// Creates the error of a value that a check rejects; see [`refuse`].
pub fn out_of_range(file: &Path, text: &str, error: &OutOfRange) -> Box<TomlError> {
    refuse(file, text, &error.path, format!("is {}, expected {}", error.value, error.expected))
}

/// Returns the location of the value at a dotted path, or of the longest existing part of the path.
fn locate(text: &str, path: &str) -> Option<Range<usize>> {
    let document = DeTable::parse(text).ok()?;
    let mut found = None;
    let mut table = document.get_ref();
    for step in path.split('.') {
        let (name, indices) = step.split_once('[').map_or((step, ""), |(name, rest)| (name, rest));
        let Some((key, mut value)) = table.get_key_value(name) else {
            return found;
        };
        found = Some(if value.get_ref().is_table() { key.span() } else { value.span() });
        for index in indices.split(['[', ']']).filter_map(|i| i.parse::<usize>().ok()) {
            let Some(element) = value.get_ref().as_array().and_then(|array| array.get(index)) else {
                return found;
            };
            value = element;
            found = Some(element.span());
        }
        let DeValue::Table(inner) = value.get_ref() else {
            return found;
        };
        table = inner;
    }
    found
}

/// Returns the dotted path of the key or value whose text includes `span`: the inverse of [`locate`].
fn path_of(text: &str, span: &Range<usize>) -> Option<String> {
    path_in_table(DeTable::parse(text).ok()?.get_ref(), span, "")
}

fn path_in_table(table: &DeTable<'_>, span: &Range<usize>, parent: &str) -> Option<String> {
    table.iter().find_map(|(key, value)| {
        let dot = if parent.is_empty() { "" } else { "." };
        let path = format!("{parent}{dot}{}", key.get_ref());
        if includes(&key.span(), span) { Some(path) } else { path_in_value(value, span, path) }
    })
}

fn path_in_value(value: &Spanned<DeValue<'_>>, span: &Range<usize>, path: String) -> Option<String> {
    // The span of a table is that of its header; its keys may be anywhere below.
    let inner = match value.get_ref() {
        DeValue::Table(table) => path_in_table(table, span, &path),
        DeValue::Array(values) => values
            .iter()
            .enumerate()
            .find_map(|(index, value)| path_in_value(value, span, format!("{path}[{index}]"))),
        _ => None,
    };
    inner.or_else(|| includes(&value.span(), span).then_some(path))
}

/// Returns true if `inner` is non-empty text within `outer`: the empty span of a missing value belongs to no
/// key.
fn includes(outer: &Range<usize>, inner: &Range<usize>) -> bool {
    !inner.is_empty() && outer.start <= inner.start && inner.end <= outer.end
}

/// Returns true if a span covers the whole text and therefore contains no location.
fn is_whole(span: &Range<usize>, text: &str) -> bool {
    span.start == 0 && span.end >= text.trim_end().len()
}

/// Replaces the names of Rust types in messages of serde by their meaning.
fn in_plain_words(message: &str) -> String {
    let types = ["usize", "u64", "u32", "u8"];
    let whole = "an integer from 0";
    types
        .iter()
        .fold(message.to_owned(), |text, name| {
            text.replace(&format!("expected {name}"), &format!("expected {whole}"))
        })
        .replace("expected f64", "expected a number")
}

/// Returns a hint for a radial distortion that is not three numbers: OpenCV lists the tangential coefficients
/// between the radial ones.
fn opencv_order(path: &str, message: &str) -> &'static str {
    if path.ends_with("radial") && message.starts_with("invalid length") {
        ": k1, k2, k3; OpenCV's order is k1, k2, p1, p2, k3, whose p1 and p2 belong to `tangential` here"
    } else {
        ""
    }
}

/// Keys and kinds of earlier versions, with their present names.
const RENAMED: [(&str, &str); 2] = [("law", "distribution"), ("whole", "integer")];

/// Returns a hint with the most similar of the names in serde's "unknown field `x`, expected one of `a`,
/// `b`".
fn nearest_valid_name(message: &str) -> Option<String> {
    if !(message.starts_with("unknown field") || message.starts_with("unknown variant")) {
        return None;
    }
    let mut names = message.split('`').skip(1).step_by(2);
    let met = names.next()?;
    let names: Vec<&str> = names.collect();
    let renamed = |(old, new): &&(&str, &str)| *old == met && names.contains(new);
    if let Some((old, new)) = RENAMED.iter().find(renamed) {
        return Some(format!("`{old}` is now called `{new}`"));
    }
    nearest(met, names).map(|name| format!("did you mean `{name}`?"))
}

/// Returns the candidate that is most similar to `word`, or `None` if none is sufficiently similar.
pub fn nearest<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    candidates
        .into_iter()
        .map(|candidate| (strsim::jaro_winkler(word, candidate), candidate))
        .filter(|(likeness, _)| *likeness > 0.7)
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, candidate)| candidate)
}

#[cfg(test)]
mod tests {
    use serde::{Deserialize, Serialize};

    use super::*;

    #[derive(Debug, Serialize, Deserialize)]
    #[serde(deny_unknown_fields)]
    struct Outer {
        sensor: Sensor,
        mode: Option<Mode>,
    }

    #[derive(Debug, Serialize, Deserialize)]
    #[serde(deny_unknown_fields)]
    struct Sensor {
        gain_e_per_dn: f64,
        bits: Option<u8>,
    }

    #[derive(Debug, Serialize, Deserialize)]
    #[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
    enum Mode {
        Fixed { exposure_s: f64 },
        Automatic { min_s: f64 },
        Lamps { lamps: Vec<Lamp>, spare: Option<Lamp> },
    }

    #[derive(Debug, Serialize, Deserialize)]
    struct Lamp {
        power_w: f64,
    }

    fn fail(text: &str) -> TomlError {
        *parse::<Outer>(Path::new("a.toml"), text).unwrap_err()
    }

    #[test]
    fn an_unknown_key_is_named_with_its_position_and_the_nearest_valid_name() {
        let error = fail("[sensor]\ngain_e_per_dn = 2.0\ngian = 3\n");
        assert_eq!((error.line, error.column), (3, 1), "{error}");
        let error = fail("[sensor]\ngain_e_per_nd = 2.0\n");
        assert_eq!(error.help.as_deref(), Some("did you mean `gain_e_per_dn`?"), "{error}");
    }

    #[test]
    fn a_value_of_the_wrong_type_is_named_with_its_position() {
        let error = fail("# a comment\n[sensor]\ngain_e_per_dn = \"two\"\n");
        assert_eq!((error.line, error.column), (3, 17), "{error}");
        assert!(error.to_string().contains("sensor.gain_e_per_dn"), "{error}");
        assert!(error.to_string().contains("a.toml:3:17"), "{error}");
    }

    #[test]
    fn a_mistake_inside_a_tagged_table_has_a_position_too() {
        let error = fail("[sensor]\ngain_e_per_dn = 2.0\n\n[mode]\nkind = \"fixed\"\nexposure = 1.0\n");
        assert!((4..=6).contains(&error.line), "{error}");
        assert_eq!(error.help.as_deref(), Some("did you mean `exposure_s`?"), "{error}");
    }

    #[test]
    fn an_array_is_no_table_inside_a_tagged_table_either() {
        for (text, place, path) in [
            ("mode = ['fixed', 1.0]", (3, 8), "mode"),
            ("mode = { kind = 'lamps', lamps = [{ power_w = 1 }, [2]] }", (3, 52), "mode.lamps[1]"),
            ("mode = { kind = 'lamps', lamps = [], spare = [2] }", (3, 46), "mode.spare"),
        ] {
            let error = fail(&format!("sensor.gain_e_per_dn = 2.0\n\n{text}\n"));
            assert_eq!(((error.line, error.column), &*error.path), (place, path), "{error}");
            assert_eq!(error.message, "is an array, expected a table");
        }
    }

    #[test]
    fn text_that_is_not_toml_has_a_position() {
        assert_eq!(fail("[sensor\n").line, 1);
    }

    #[test]
    fn a_missing_key_names_the_table() {
        let error = fail("[sensor]\nbits = 8\n");
        assert!(error.to_string().contains("gain_e_per_dn"), "{error}");
        assert_eq!(error.line, 1, "{error}");
    }

    #[test]
    fn a_refused_value_is_found_by_its_path() {
        let text = "[sensor]\ngain_e_per_dn = -1.0\n";
        let error = refuse(Path::new("a.toml"), text, "sensor.gain_e_per_dn", "is -1, expected > 0".into());
        assert_eq!((error.line, error.column), (2, 17));
        let text = "[[group]]\ncount = 3\n[[group]]\ncount = 0\n";
        let error = refuse(Path::new("a.toml"), text, "group[1].count", "is 0".into());
        assert_eq!((error.line, error.column), (4, 9));
    }

    #[test]
    fn hostile_text_does_not_panic() {
        for text in ["\u{feff}", "é = ", "a = 'é\n", "[a]\n[a]\n", "=\n", "\0"] {
            let _ = parse::<Outer>(Path::new("a.toml"), text).unwrap_err().to_string();
        }
    }
}
