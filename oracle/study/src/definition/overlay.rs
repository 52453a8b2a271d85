//! Replacement of values in a scenario.
use files::Failure;
use run::ScenarioSource;
use serde_json::Value;

/// Returns a scenario with new values at some paths, as in `sensor.gain_e_per_dn`. The seed stays the same
/// unless one of the values sets it.
///
/// # Errors
/// [`Failure::Usage`] for a path that does not exist, or a value of the wrong type. Whether the scenario can
/// be simulated is checked only when it is simulated.
pub fn with_overlay(source: &ScenarioSource, values: &[(String, Value)]) -> Result<ScenarioSource, Failure> {
    let mut document = source.scenario.to_json()?;
    for (text, value) in values {
        let refuse = |expected: &str| Failure::Usage(format!("`{text}` is given, expected {expected}"));
        let path = ValuePath::parse(text).map_err(refuse)?;
        path.set(&mut document, value.clone()).map_err(|expected| refuse(&expected))?;
    }
    let seed = document.get("seed").and_then(Value::as_u64).filter(|seed| i64::try_from(*seed).is_ok());
    let seed = seed.ok_or_else(|| {
        let found = document.get("seed").unwrap_or(&Value::Null);
        Failure::Usage(format!("`seed` is {found}, expected an integer, 0 to {}", i64::MAX))
    })?;
    source.with_values(&document, seed, source.name.clone())
}

/// Returns the value of a scenario at a path, as in `sensor.gain_e_per_dn`; null for a key that the scenario
/// omits.
///
/// # Errors
/// [`Failure::Usage`] for a path that does not exist.
pub fn value_at(source: &ScenarioSource, path: &str) -> Result<Value, Failure> {
    let refuse = |expected: &str| Failure::Usage(format!("`{path}` is given, expected {expected}"));
    let document = source.scenario.to_json()?;
    let found = ValuePath::parse(path).map_err(refuse)?.get(&document).cloned();
    found.ok_or_else(|| refuse("the path of a value in the scenario; it has none at this path"))
}

/// Step of a path to a value.
#[derive(Debug, Clone, PartialEq, Eq)]
enum Step {
    Key(String),
    Index(usize),
}

/// Path of a value in a scenario, as in `cameras[0].camera.focal_length_mm`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct ValuePath {
    text: String,
    steps: Vec<Step>,
}

impl ValuePath {
    /// Parses a path; the error states the expected form.
    pub(crate) fn parse(text: &str) -> Result<Self, &'static str> {
        const EXPECTED: &str =
            "a path of keys and indices, as in `sensor.gain_e_per_dn` or `schedule[2].count`";
        let mut steps = Vec::new();
        for part in text.split('.') {
            let (name, places) = part.split_once('[').map_or((part, None), |(name, rest)| (name, Some(rest)));
            let is_of_name = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
            if name.is_empty() || !name.chars().all(is_of_name) {
                return Err(EXPECTED);
            }
            steps.push(Step::Key(name.to_owned()));
            let Some(places) = places else { continue };
            for place in places.strip_suffix(']').ok_or(EXPECTED)?.split("][") {
                steps.push(Step::Index(place.parse().map_err(|_| EXPECTED)?));
            }
        }
        Ok(Self { text: text.to_owned(), steps })
    }

    /// Returns the text of the path.
    pub(crate) fn text(&self) -> &str {
        &self.text
    }

    /// Returns true if setting the values at both paths would change a common value.
    pub(crate) fn overlaps(&self, other: &Self) -> bool {
        self.steps.starts_with(&other.steps) || other.steps.starts_with(&self.steps)
    }

    /// Returns the value at the path; `None` if there is none.
    pub(crate) fn get<'a>(&self, document: &'a Value) -> Option<&'a Value> {
        self.steps.iter().try_fold(document, |value, step| match step {
            Step::Key(name) => value.get(name),
            Step::Index(index) => value.get(index),
        })
    }

    /// Sets the value at the path. The last name may be new, which allows setting a value that the scenario
    /// leaves at its default; the scenario's type decides whether the name exists. The error states the part
    /// of the path that is missing.
    pub(crate) fn set(&self, document: &mut Value, new: Value) -> Result<(), String> {
        let Some((last, way)) = self.steps.split_last() else { return Ok(()) };
        let mut at = document;
        for step in way {
            at = match step {
                Step::Key(name) => at
                    .get_mut(name)
                    .filter(|value| !value.is_null())
                    .ok_or_else(|| format!("a path in the scenario; it has no key `{name}` at this path"))?,
                Step::Index(index) => {
                    let count = at.as_array().map_or(0, Vec::len);
                    at.get_mut(index)
                        .ok_or_else(|| format!("a path in the scenario; this list has {count} elements"))?
                }
            };
        }
        match (last, at) {
            (Step::Key(name), Value::Object(table)) => {
                let new = like(table.get(name), new);
                table.insert(name.clone(), new);
                Ok(())
            }
            (Step::Index(index), Value::Array(values)) => {
                let count = values.len();
                let place = values.get_mut(*index);
                let place =
                    place.ok_or_else(|| format!("a path in the scenario; this list has {count} elements"))?;
                *place = like(Some(place), new);
                Ok(())
            }
            _ => Err("the path of a value in a table or list of the scenario".to_owned()),
        }
    }
}

/// Converts the new value to an integer if the old one is an integer.
fn like(old: Option<&Value>, new: Value) -> Value {
    match (old, new.as_f64()) {
        (Some(Value::Number(old)), Some(number))
            if !old.is_f64()
                && number.fract() == 0.0
                && (0.0..=9_007_199_254_740_992.0).contains(&number) =>
        {
            Value::from(number as u64)
        }
        _ => new,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn set(path: &str, new: Value) -> Result<Value, String> {
        let mut document =
            json!({ "a": { "b": 1.5, "n": 3, "none": null }, "list": [[1.0, 2.0], [3.0, 4.0]] });
        ValuePath::parse(path)?.set(&mut document, new)?;
        Ok(document)
    }

    #[test]
    fn a_value_is_written_at_its_path() {
        assert_eq!(set("a.b", json!(2.5)).unwrap()["a"]["b"], json!(2.5));
        assert_eq!(set("list[1][0]", json!(9.0)).unwrap()["list"], json!([[1.0, 2.0], [9.0, 4.0]]));
        assert_eq!(set("a.new", json!("x")).unwrap()["a"]["new"], json!("x"));
        assert_eq!(set("a.n", json!(5.0)).unwrap()["a"]["n"], json!(5));
        assert_eq!(set("a.n", json!(5.5)).unwrap()["a"]["n"], json!(5.5));
    }

    #[test]
    fn a_path_that_leads_nowhere_is_refused() {
        for path in ["", ".", "a..b", "a[", "a[x]", "a[0", "[0]", "a]"] {
            assert!(ValuePath::parse(path).is_err() || set(path, json!(1)).is_err(), "{path}");
        }
        for path in ["b.c", "a.none.x", "list[2]", "list[0][2]", "a[0]", "a.b.c"] {
            assert!(set(path, json!(1)).is_err(), "{path}");
        }
    }

    #[test]
    fn paths_overlap_where_one_holds_the_other() {
        let overlap = |a: &str, b: &str| ValuePath::parse(a).unwrap().overlaps(&ValuePath::parse(b).unwrap());
        assert!(overlap("a.b", "a.b") && overlap("a", "a.b") && overlap("list[0]", "list[0][1]"));
        assert!(!overlap("a.b", "a.bc") && !overlap("list[0]", "list[1]"));
    }
}
