//! Parts of a scenario that determine its frames, separated from title, seed and pipeline parameters.

use files::Failure;
use files::sha256::sha256_hex;
use toml::{Table, Value};

use crate::run_file::{FileDigests, content};

/// A scenario separated into the parts that determine its frames and the parameters of the pipeline.
#[derive(Debug, Clone, PartialEq)]
pub struct Split {
    /// Parameters of the world's built-in pipeline.
    pub pipeline: Table,
    /// Scenario without pipeline parameters, title and seed.
    pub scenario: Table,
    /// SHA-256 of `scenario`, hexadecimal.
    pub scenario_sha256: String,
}

/// Removes title, seed and the parameters of the pipeline of `world` from a resolved scenario, and replaces
/// the paths of `files` by the digests of their contents.
///
/// # Errors
/// [`Failure::Usage`] for a scenario that cannot be written as TOML.
pub fn split(world: &str, mut scenario: Table, files: &FileDigests) -> Result<Split, Failure> {
    for (role, sha256) in files {
        let mut steps = role.split('.');
        let first = steps.next().and_then(|step| scenario.get_mut(step));
        if let Some(path) = steps.try_fold(first, |table, step| Some(table?.get_mut(step))).flatten() {
            *path = Value::String(content(sha256));
        }
    }
    scenario.remove("title");
    scenario.remove("seed");
    let pipeline = match scenario.remove(world) {
        Some(Value::Table(table)) => table,
        _ => Table::new(),
    };
    let text = toml::to_string(&scenario)
        .map_err(|error| Failure::Usage(format!("the scenario cannot be written: {error}")))?;
    Ok(Split { pipeline, scenario, scenario_sha256: sha256_hex(&text) })
}

/// Returns the first difference of two values: its path, as `.psf.sigma_px` or `.schedule[2].count`, and the
/// two values there.
pub fn first_difference(a: &Value, b: &Value) -> Option<(String, String, String)> {
    let missing = || "none".to_owned();
    match (a, b) {
        (Value::Table(a), Value::Table(b)) => {
            let mut keys: Vec<&String> =
                a.keys().chain(b.keys().filter(|key| !a.contains_key(*key))).collect();
            keys.sort();
            keys.into_iter().find_map(|key| match (a.get(key), b.get(key)) {
                (Some(a), Some(b)) => first_difference(a, b).map(|(at, a, b)| (format!(".{key}{at}"), a, b)),
                (a, b) => {
                    let shown = |value: Option<&Value>| value.map_or_else(missing, ToString::to_string);
                    Some((format!(".{key}"), shown(a), shown(b)))
                }
            })
        }
        (Value::Array(a), Value::Array(b)) => {
            (0..a.len().max(b.len())).find_map(|i| match (a.get(i), b.get(i)) {
                (Some(a), Some(b)) => first_difference(a, b).map(|(at, a, b)| (format!("[{i}]{at}"), a, b)),
                (a, b) => {
                    let shown = |value: Option<&Value>| value.map_or_else(missing, ToString::to_string);
                    Some((format!("[{i}]"), shown(a), shown(b)))
                }
            })
        }
        (a, b) => (a != b).then(|| (String::new(), a.to_string(), b.to_string())),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SCENARIO: &str = "title = \"a\"\nseed = 1\n[psf]\nsigma_px = 0.8\n[far_range]\nthreshold = 4\n[[schedule]]\ncount = 3\n";

    #[test]
    fn the_first_difference_is_named_with_its_position() {
        let value = |text: &str| Value::Table(text.parse().unwrap());
        for (a, b, at, of_a, of_b) in [
            // Each table lacks a key of the other; keys are compared by name, not by position.
            ("b = 1\na = 1", "b = 2\na = 2", ".a", "1", "2"),
            ("a = 1", "a = 1\nb = 2", ".b", "none", "2"),
            ("a = 1\nb = 2", "a = 1", ".b", "2", "none"),
            ("a = [1, 2]", "a = [1, 2, 3]", ".a[2]", "none", "3"),
            ("a = [1, 2, 3]", "a = [1, 2]", ".a[2]", "3", "none"),
            ("a = [{ b = 1 }, { b = 2 }]", "a = [{ b = 1 }, { b = 3 }]", ".a[1].b", "2", "3"),
            ("a = 1", "a = \"1\"", ".a", "1", "\"1\""),
            ("a.b = 1", "a = 1", ".a", "{ b = 1 }", "1"),
        ] {
            let expected = (at.to_owned(), of_a.to_owned(), of_b.to_owned());
            assert_eq!(first_difference(&value(a), &value(b)), Some(expected), "{a} and {b}");
        }
        let table = value("a = [1, { b = 2.5 }]\nc = true");
        assert_eq!(first_difference(&table, &table), None);
    }

    #[test]
    fn the_scenario_is_parted_from_its_title_its_seed_and_its_pipeline() {
        let table: Table = SCENARIO.parse().unwrap();
        let split = split("far_range", table.clone(), &FileDigests::new()).unwrap();
        assert_eq!(split.pipeline, "threshold = 4".parse().unwrap());
        let scenario: Table = "[psf]\nsigma_px = 0.8\n[[schedule]]\ncount = 3\n".parse().unwrap();
        assert_eq!(split.scenario, scenario);
        assert_eq!(split.scenario_sha256, sha256_hex(toml::to_string(&scenario).unwrap()));
        // For the other world the table is not pipeline parameters and stays in the scenario.
        let other = super::split("docking", table, &FileDigests::new()).unwrap();
        assert!(other.pipeline.is_empty() && other.scenario.contains_key("far_range"));
    }

    #[test]
    fn the_content_of_a_file_replaces_its_path() {
        let scenario =
            |path: &str| format!("{SCENARIO}[catalog]\nsource = \"{path}\"\n").parse::<Table>().unwrap();
        let split = |path: &str, sha256: &str| {
            let files = FileDigests::from([("catalog.source".to_owned(), sha256.to_owned())]);
            split("far_range", scenario(path), &files).unwrap()
        };
        let (a, b, other) =
            (split("/a/stars.csv", "ab"), split("/b/stars.csv", "ab"), split("/a/stars.csv", "cd"));
        assert_eq!(a.scenario_sha256, b.scenario_sha256);
        assert_ne!(a.scenario_sha256, other.scenario_sha256);
        assert_eq!(a.scenario["catalog"]["source"].as_str(), Some("sha256:ab"));
    }
}
