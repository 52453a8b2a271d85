//! Ranges of numbers, declared once as schemars attributes of the fields and checked here against the
//! resulting JSON Schema.

use std::any::TypeId;
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

use schemars::{JsonSchema, schema_for};
use serde::Serialize;
use serde_json::Value;
use thiserror::Error;
use toml::de::{DeTable, DeValue};

/// A value that is not allowed: its path, the value and the expected range or property.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("{path} is {value}, expected {expected}")]
pub struct OutOfRange {
    /// Path of the field with its unit, for example `sensor.gain_e_per_dn` or `schedule[2].count`; list
    /// entries count from 0.
    pub path: String,
    /// The rejected value.
    pub value: String,
    /// The expected range or property.
    pub expected: String,
}

/// Longest number, in characters, that is printed without an exponent.
const MAX_NUMBER_CHARS: usize = 24;

impl OutOfRange {
    /// Creates the error for `value` at `path`.
    pub fn new(path: impl Into<String>, value: impl ToString, expected: impl Into<String>) -> Self {
        let value = value.to_string();
        // Prints 1e300 in exponent form rather than as a line of zeros.
        let long = Some(&value)
            .filter(|text| text.len() > MAX_NUMBER_CHARS)
            .and_then(|text| text.parse::<f64>().ok());
        let value = long.map_or(value, |number| format!("{number:e}"));
        Self { path: path.into(), value, expected: expected.into() }
    }

    /// Returns this error with its path inside `table`.
    #[must_use]
    pub fn under(self, table: &str) -> Self {
        Self { path: format!("{table}.{}", self.path), ..self }
    }

    /// Returns this error with the list index inserted in the first `[]` of its path.
    #[must_use]
    pub fn in_entry(self, index: usize) -> Self {
        Self { path: self.path.replacen("[]", &format!("[{index}]"), 1), ..self }
    }
}

/// Checks that `value` is finite and satisfies `holds`: for conditions that a range of one field cannot
/// express.
///
/// # Errors
/// [`OutOfRange`] with the path and the expected property.
pub fn require(
    path: impl Into<String>,
    value: f64,
    expected: impl Into<String>,
    holds: impl FnOnce(f64) -> bool,
) -> Result<(), OutOfRange> {
    if value.is_finite() && holds(value) { Ok(()) } else { Err(OutOfRange::new(path, value, expected)) }
}

/// Checks that every number of `value`, including nested tables and lists, is finite and in the range that
/// its field declares, and that every list has the length that its field declares. `path` is the path of
/// `value`, "" for the root of a file.
///
/// # Errors
/// [`OutOfRange`] for the first number or list that fails the check.
pub fn check<T: Serialize + JsonSchema + 'static>(value: &T, path: &str) -> Result<(), OutOfRange> {
    // Serialised as TOML, which omits absent values and keeps NaN, infinity and every integer. JSON would
    // turn absent values, NaN and infinity into null.
    let unreadable = |error: &dyn ToString| OutOfRange::new(path, error.to_string(), "a table");
    let text = toml::to_string(value).map_err(|error| unreadable(&error))?;
    let table = DeTable::parse(&text).map_err(|error| unreadable(&error))?;
    let root = schema::<T>();
    SchemaWalk { root: &root }.value(&[&root], &DeValue::Table(table.into_inner()), path)
}

/// Returns the schema of a type, generated once and cached.
fn schema<T: JsonSchema + 'static>() -> Arc<Value> {
    static SCHEMAS: Mutex<BTreeMap<TypeId, Arc<Value>>> = Mutex::new(BTreeMap::new());
    let mut schemas = SCHEMAS.lock().unwrap_or_else(PoisonError::into_inner);
    schemas.entry(TypeId::of::<T>()).or_insert_with(|| Arc::new(schema_for!(T).to_value())).clone()
}

/// A parallel traversal of a value and its schema.
struct SchemaWalk<'a> {
    /// The whole schema, to which references are relative.
    root: &'a Value,
}

impl<'a> SchemaWalk<'a> {
    fn value(&self, schemas: &[&'a Value], value: &DeValue<'_>, path: &str) -> Result<(), OutOfRange> {
        let mut parts = Vec::new();
        schemas.iter().for_each(|schema| self.collect(schema, value, &mut parts));
        match value {
            DeValue::Integer(integer) => {
                let number = i128::from_str_radix(integer.as_str(), integer.radix());
                check_number(&parts, number.map_or(f64::NAN, |number| number as f64), integer, path)
            }
            DeValue::Float(float) => {
                let number = float.as_str().parse().unwrap_or(f64::NAN);
                check_number(&parts, number, number, path)
            }
            DeValue::Array(items) => {
                for part in &parts {
                    let range = Range::from_schema_keys(part, ["minItems", "maxItems", "", ""]);
                    if !range.contains(items.len() as f64) {
                        let value = format!("a list of {}", items.len());
                        return Err(OutOfRange::new(
                            path,
                            value,
                            format!("a list of {}", range.description()),
                        ));
                    }
                }
                items.iter().enumerate().try_for_each(|(i, item)| {
                    let schemas: Vec<_> = parts
                        .iter()
                        .filter_map(|part| part.pointer(&format!("/prefixItems/{i}")).or(part.get("items")))
                        .collect();
                    self.value(&schemas, item.get_ref(), &format!("{path}[{i}]"))
                })
            }
            DeValue::Table(table) => table.iter().try_for_each(|(key, value)| {
                let key: &str = key.get_ref();
                let member = |part: &&'a Value| {
                    let properties = part.get("properties").and_then(|properties| properties.get(key));
                    properties.or(part.get("additionalProperties"))
                };
                let schemas: Vec<_> = parts.iter().filter_map(member).collect();
                let path = if path.is_empty() { key.to_owned() } else { format!("{path}.{key}") };
                self.value(&schemas, value.get_ref(), &path)
            }),
            DeValue::String(_) | DeValue::Boolean(_) | DeValue::Datetime(_) => Ok(()),
        }
    }

    /// Collects all parts of a schema that apply to `value`: the schema itself, the schema it refers to, and
    /// those of its alternatives that `value` may match.
    fn collect(&self, schema: &'a Value, value: &DeValue<'_>, parts: &mut Vec<&'a Value>) {
        parts.push(schema);
        if let Some(target) = self.target(schema) {
            self.collect(target, value, parts);
        }
        let alternatives =
            ["oneOf", "anyOf", "allOf"].into_iter().filter_map(|key| schema.get(key)?.as_array());
        for alternative in alternatives.flatten().filter(|schema| self.could_match(schema, value)) {
            self.collect(alternative, value, parts);
        }
    }

    fn target(&self, schema: &Value) -> Option<&'a Value> {
        self.root.pointer(schema.get("$ref")?.as_str()?.strip_prefix('#')?)
    }

    /// Returns true if `value` may match an alternative: by its type and, for a table, by the required keys
    /// and the constant values that mark its kind.
    fn could_match(&self, schema: &Value, value: &DeValue<'_>) -> bool {
        let is_type = |name: &Value| match value {
            DeValue::Integer(_) => name == "integer" || name == "number",
            DeValue::Float(_) => name == "number",
            DeValue::String(_) | DeValue::Datetime(_) => name == "string",
            DeValue::Boolean(_) => name == "boolean",
            DeValue::Array(_) => name == "array",
            DeValue::Table(_) => name == "object",
        };
        let types = match schema.get("type") {
            Some(Value::Array(names)) => names.iter().any(is_type),
            name => name.is_none_or(is_type),
        };
        let word = schema.get("const").is_none_or(|word| value.as_str() == word.as_str());
        let keys = value.as_table().is_none_or(|table| {
            let required = schema.get("required").and_then(Value::as_array).into_iter().flatten();
            let properties = schema.get("properties").and_then(Value::as_object).into_iter().flatten();
            required.filter_map(Value::as_str).all(|key| table.contains_key(key))
                && properties.filter(|(_, schema)| schema.get("const").is_some()).all(|(key, schema)| {
                    table.get(key.as_str()).is_none_or(|value| self.could_match(schema, value.get_ref()))
                })
        });
        types && word && keys && self.target(schema).is_none_or(|target| self.could_match(target, value))
    }
}

fn check_number(parts: &[&Value], number: f64, value: impl ToString, path: &str) -> Result<(), OutOfRange> {
    // A number without a schema must still be finite.
    let mut ranges = parts.iter().copied().chain([&Value::Null]).map(Range::from_schema);
    let refusing = ranges.find(|range| !(number.is_finite() && range.contains(number)));
    refusing.map_or(Ok(()), |range| Err(OutOfRange::new(path, value, range.description())))
}

/// Range of a number that a schema allows.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
struct Range {
    at_least: Option<f64>,
    at_most: Option<f64>,
    more_than: Option<f64>,
    less_than: Option<f64>,
}

impl Range {
    fn from_schema_keys(schema: &Value, keys: [&str; 4]) -> Self {
        let [at_least, at_most, more_than, less_than] =
            keys.map(|key| schema.get(key).and_then(Value::as_f64));
        Self { at_least, at_most, more_than, less_than }
    }

    fn from_schema(schema: &Value) -> Self {
        Self::from_schema_keys(schema, ["minimum", "maximum", "exclusiveMinimum", "exclusiveMaximum"])
    }

    fn contains(&self, number: f64) -> bool {
        self.at_least.is_none_or(|limit| number >= limit)
            && self.at_most.is_none_or(|limit| number <= limit)
            && self.more_than.is_none_or(|limit| number > limit)
            && self.less_than.is_none_or(|limit| number < limit)
    }

    /// Returns the range as text for messages: "0.05 to 1e5", "above 0 to 5", "at least 1".
    fn description(&self) -> String {
        // If both lower limits exist, the exclusive one is narrower: the inclusive limit of an unsigned
        // integer is 0 by its type.
        let low = match (self.more_than, self.at_least) {
            (Some(limit), _) => Some(("above ", "above ", limit)),
            (None, limit) => limit.map(|limit| ("", "at least ", limit)),
        };
        let high = match (self.less_than, self.at_most) {
            (Some(limit), _) => Some(("below ", "below ", limit)),
            (None, limit) => limit.map(|limit| ("", "at most ", limit)),
        };
        match (low, high) {
            (Some((low, _, from)), Some((high, _, to))) => {
                format!("{low}{} to {high}{}", short(from), short(to))
            }
            (Some((_, word, limit)), None) | (None, Some((_, word, limit))) => {
                format!("{word}{}", short(limit))
            }
            (None, None) => "a finite number".to_owned(),
        }
    }
}

/// Formats a number, with powers of ten in exponent form where that is clearly shorter: 1e5, 1e-6, but 1000
/// and 0.001.
fn short(number: f64) -> String {
    let (plain, scientific) = (number.to_string(), format!("{number:e}"));
    let is_power = scientific.trim_start_matches('-').starts_with("1e");
    if is_power && scientific.len() + 2 <= plain.len() { scientific } else { plain }
}

#[cfg(test)]
mod tests {
    use serde::Deserialize;

    use super::*;

    #[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
    #[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
    enum Law {
        Plain,
        Power {
            #[schemars(range(min = 0.3, max = 10))]
            index: f64,
        },
        Other {
            #[schemars(range(min = 100, max = 200))]
            index: f64,
        },
        Cone(Cone),
    }

    #[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
    #[serde(deny_unknown_fields)]
    struct Cone {
        #[schemars(range(min = 0, max = 180))]
        radius_deg: f64,
    }

    #[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
    #[serde(rename_all = "snake_case")]
    enum ExternallyTagged {
        None,
        Some {
            #[schemars(range(max = 5))]
            count: u8,
        },
    }

    #[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
    #[serde(deny_unknown_fields)]
    struct Table {
        free: f64,
        #[schemars(range(min = 0.05, max = 1e5))]
        gain: f64,
        #[schemars(extend("exclusiveMinimum" = 0, "maximum" = 5))]
        open: f64,
        #[schemars(range(max = 1000000))]
        step: Option<f64>,
        seed: u64,
        #[schemars(range(min = 1, max = 16))]
        bits: u8,
        #[schemars(inner(range(min = -1, max = 1)))]
        radial: [f64; 3],
        #[schemars(inner(inner(range(min = -10, max = 10))))]
        corners: Vec<[f64; 2]>,
        pair: (u8, f64),
        #[schemars(length(min = 1, max = 2))]
        cones: Vec<Cone>,
        law: Option<Law>,
        outside: ExternallyTagged,
        named: BTreeMap<String, Cone>,
    }

    fn table() -> Table {
        Table {
            free: -1e300,
            gain: 1.0,
            open: 5.0,
            step: None,
            seed: u64::MAX,
            bits: 12,
            radial: [0.0, -1.0, 1.0],
            corners: vec![[1.0, 2.0]],
            pair: (1, 2.0),
            cones: vec![Cone { radius_deg: 0.0 }],
            law: None,
            outside: ExternallyTagged::None,
            named: BTreeMap::new(),
        }
    }

    fn message(change: impl Fn(&mut Table)) -> String {
        let mut wrong = table();
        change(&mut wrong);
        check(&wrong, "table").unwrap_err().to_string()
    }

    #[test]
    fn an_out_of_range_number_is_reported_with_its_path() {
        check(&table(), "table").unwrap();
        assert_eq!(message(|t| t.gain = 0.0), "table.gain is 0, expected 0.05 to 1e5");
        assert_eq!(message(|t| t.open = 0.0), "table.open is 0, expected above 0 to 5");
        assert_eq!(message(|t| t.open = 5.5), "table.open is 5.5, expected above 0 to 5");
        assert_eq!(message(|t| t.bits = 17), "table.bits is 17, expected 1 to 16");
        let wrong = Table { gain: 1e6, ..table() };
        assert_eq!(check(&wrong, "").unwrap_err().path, "gain");
    }

    #[test]
    fn non_finite_numbers_are_refused_with_and_without_a_range() {
        assert_eq!(message(|t| t.free = f64::NAN), "table.free is NaN, expected a finite number");
        assert_eq!(message(|t| t.free = f64::NEG_INFINITY), "table.free is -inf, expected a finite number");
        assert_eq!(message(|t| t.gain = f64::NAN), "table.gain is NaN, expected 0.05 to 1e5");
        assert_eq!(message(|t| t.step = Some(f64::INFINITY)), "table.step is inf, expected at most 1e6");
    }

    #[test]
    fn lists_are_walked_and_counted() {
        assert_eq!(message(|t| t.radial[1] = 2.0), "table.radial[1] is 2, expected -1 to 1");
        assert_eq!(message(|t| t.corners[0][1] = 11.0), "table.corners[0][1] is 11, expected -10 to 10");
        assert_eq!(message(|t| t.pair.1 = f64::NAN), "table.pair[1] is NaN, expected a finite number");
        let cones = message(|t| t.cones.push(Cone { radius_deg: 181.0 }));
        assert_eq!(cones, "table.cones[1].radius_deg is 181, expected 0 to 180");
        assert_eq!(message(|t| t.cones.clear()), "table.cones is a list of 0, expected a list of 1 to 2");
    }

    #[test]
    fn an_enum_is_checked_against_the_ranges_of_its_variant() {
        let law = |law: Law| move |t: &mut Table| t.law = Some(law.clone());
        check(&Table { law: Some(Law::Other { index: 150.0 }), ..table() }, "").unwrap();
        check(&Table { law: Some(Law::Plain), ..table() }, "").unwrap();
        assert_eq!(message(law(Law::Power { index: 0.0 })), "table.law.index is 0, expected 0.3 to 10");
        assert_eq!(message(law(Law::Other { index: 10.0 })), "table.law.index is 10, expected 100 to 200");
        let cone = law(Law::Cone(Cone { radius_deg: -1.0 }));
        assert_eq!(message(cone), "table.law.radius_deg is -1, expected 0 to 180");
        let outside = message(|t| t.outside = ExternallyTagged::Some { count: 6 });
        assert_eq!(outside, "table.outside.some.count is 6, expected 0 to 5");
        let named = message(|t| {
            t.named.insert("a".to_owned(), Cone { radius_deg: 200.0 });
        });
        assert_eq!(named, "table.named.a.radius_deg is 200, expected 0 to 180");
    }

    #[test]
    fn the_schema_contains_the_range() {
        let gain = schema::<Table>().pointer("/properties/gain").unwrap().clone();
        assert_eq!((gain["minimum"].as_f64(), gain["maximum"].as_f64()), (Some(0.05), Some(1e5)));
    }

    #[test]
    fn a_range_is_printed_briefly() {
        let words = |at_least, at_most, more_than, less_than| {
            Range { at_least, at_most, more_than, less_than }.description()
        };
        assert_eq!(words(Some(-1e5), Some(0.001), None, None), "-1e5 to 0.001");
        assert_eq!(words(Some(1e-6), Some(20_000.0), None, None), "1e-6 to 20000");
        assert_eq!(words(Some(0.0), None, None, Some(1.0)), "0 to below 1");
        assert_eq!(words(Some(0.0), Some(1e9), Some(0.0), None), "above 0 to 1e9");
        assert_eq!(words(Some(1.0), None, None, None), "at least 1");
        assert_eq!(words(None, None, None, Some(36_000.0)), "below 36000");
        assert_eq!(words(None, None, None, None), "a finite number");
    }

    #[test]
    fn a_list_index_fills_the_first_empty_brackets() {
        let error = OutOfRange::new("a[].b[].c", 1, "2").in_entry(3);
        assert_eq!(error.in_entry(4).path, "a[3].b[4].c");
    }
}
