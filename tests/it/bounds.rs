//! Ranges of numbers in users' files: each is declared once, is contained in the schema, and agrees with the
//! documentation.

use boresight::docking::DockingScenario;
use boresight::docking::rows::SetupFile;
use boresight::far_range::FarRangeScenario;
use boresight::far_range::rows::CameraFile;
use boresight::middle_range::MiddleRangeScenario;
use boresight::run::{first_world, json_schema};
use boresight::study::StudyFile;
use boresight::visibility::RequirementFile;
use schemars::schema_for;
use serde_json::Value;
use sim::scene::docking::TargetFile;

/// Every number of a user's file, with its path in the types, such as `SensorConfig.gain_e_per_dn`.
fn numbers() -> Vec<(String, Field)> {
    let schemas = [
        schema_for!(FarRangeScenario),
        schema_for!(DockingScenario),
        schema_for!(MiddleRangeScenario),
        schema_for!(TargetFile),
        schema_for!(CameraFile),
        schema_for!(SetupFile),
        schema_for!(RequirementFile),
        schema_for!(StudyFile),
    ];
    let mut all = Vec::new();
    for schema in schemas.map(schemars::Schema::to_value) {
        collect(schema["title"].as_str().unwrap(), &schema, &mut all);
    }
    all.sort_by(|a: &(String, Field), b| a.0.cmp(&b.0));
    all.dedup();
    all
}

/// A field with a number, or lists of numbers.
#[derive(Debug, PartialEq)]
struct Field {
    description: String,
    /// Limits of the number: at least, above, at most, below.
    limits: [Option<f64>; 4],
}

fn collect(owner: &str, schema: &Value, all: &mut Vec<(String, Field)>) {
    for (name, definition) in schema["$defs"].as_object().into_iter().flatten() {
        collect(name, definition, all);
    }
    for (key, property) in schema["properties"].as_object().into_iter().flatten() {
        if let Some(number) = number(property) {
            let limit = |key: &str| number[key].as_f64();
            let field = Field {
                description: property["description"].as_str().unwrap_or_default().to_owned(),
                limits: ["minimum", "exclusiveMinimum", "maximum", "exclusiveMaximum"].map(limit),
            };
            all.push((format!("{owner}.{key}"), field));
        } else {
            collect(owner, property, all);
        }
    }
    for key in ["oneOf", "anyOf", "allOf", "prefixItems"] {
        schema[key].as_array().into_iter().flatten().for_each(|part| collect(owner, part, all));
    }
    if schema["items"].is_object() {
        collect(owner, &schema["items"], all);
    }
}

fn is_type(schema: &Value, name: &str) -> bool {
    schema["type"] == name || schema["type"].as_array().is_some_and(|types| types.iter().any(|t| t == name))
}

/// Returns the schema of the number in a schema, including inside lists.
fn number(schema: &Value) -> Option<&Value> {
    if is_type(schema, "number") || is_type(schema, "integer") {
        Some(schema)
    } else if schema["items"].is_object() {
        number(&schema["items"])
    } else {
        schema["prefixItems"].get(0).and_then(number)
    }
}

/// Returns the first range in a description, and true if its lower limit is excluded: "0.05 to 1e5", "above 0
/// to 5" or "above 0, at most 5".
fn named_range(description: &str) -> Option<(bool, [f64; 2])> {
    let plain = description.replace('−', "-").replace("10 000", "10000");
    let words: Vec<&str> = plain.split_whitespace().collect();
    let number = |at: usize| words.get(at)?.trim_end_matches([',', ';', '.', ':', ')']).parse::<f64>().ok();
    (0..words.len()).find_map(|at| {
        let is_open = at > 0 && ["above", "than"].contains(&words[at - 1]);
        let to = match words.get(at + 1..)? {
            ["to", ..] => number(at + 2)?,
            ["at", "most", ..] if is_open => number(at + 3)?,
            _ => return None,
        };
        Some((is_open, [number(at)?, to]))
    })
}

#[test]
fn a_range_in_the_documentation_is_the_declared_one() {
    let mut wrong = Vec::new();
    let (mut closed, mut open) = (0, 0);
    for (name, field) in numbers() {
        let [at_least, above, at_most, below] = field.limits;
        let Some((is_open, [from, to])) = named_range(&field.description) else { continue };
        *(if is_open { &mut open } else { &mut closed }) += 1;
        let lower = if is_open { above } else { at_least };
        if lower != Some(from) || below.or(at_most) != Some(to) {
            wrong.push(format!("{name}: {:?}, but: {}", field.limits, field.description));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(closed > 200 && open > 10, "{closed}, {open}");
}

#[test]
fn every_number_has_both_bounds() {
    let lacks_one = |(_, field): &&(String, Field)| {
        let [at_least, above, at_most, below] = field.limits;
        at_least.or(above).is_none() || at_most.or(below).is_none()
    };
    let numbers = numbers();
    let free: Vec<&str> = numbers.iter().filter(lacks_one).map(|(name, _)| name.as_str()).collect();
    assert!(free.is_empty() && numbers.len() > 300, "{free:?}");
}

/// No angle exceeds ten turns: a larger one would have another unit.
#[test]
fn every_angle_is_within_ten_turns() {
    let numbers = numbers();
    let angles = numbers.iter().filter(|(name, _)| name.ends_with("_deg"));
    let mut free = angles.filter(|(_, field)| {
        let [at_least, above, at_most, below] = field.limits;
        let within = |limit: Option<f64>| limit.is_some_and(|limit| limit.abs() <= 3600.0);
        !within(at_least.or(above)) || !within(at_most.or(below))
    });
    assert_eq!(free.next(), None);
}

#[test]
fn the_schema_of_scenarios_has_the_ranges() {
    boresight::register_worlds();
    let schema = json_schema(Some(first_world().unwrap())).to_value();
    let gain = &schema["$defs"]["SensorConfig"]["properties"]["gain_e_per_dn"];
    assert_eq!((gain["minimum"].as_f64(), gain["maximum"].as_f64()), (Some(0.05), Some(1e5)));
    let level = &json_schema(None).to_value()["$defs"]["DriftConfig"]["properties"]["rms_arcsec"];
    assert_eq!(
        (level["items"]["minimum"].as_f64(), level["items"]["maximum"].as_f64()),
        (Some(0.0), Some(36e3))
    );
}
