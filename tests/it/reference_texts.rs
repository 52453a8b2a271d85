//! Every command, option, scenario key and column has a text: the reference pages of the book are made of
//! them.

use boresight::files::FieldDeclaration;
use boresight::gate::row_columns;
use boresight::study::case_columns;
use boresight::{csv_tables, navigate, parquet_tables, visibility};
use serde_json::Value;

use crate::support::Bench;

/// Names of the subcommands that a help text lists.
fn subcommands(help: &str) -> Vec<&str> {
    let listed = help.lines().skip_while(|line| *line != "Commands:").skip(1);
    listed
        .take_while(|line| !line.is_empty())
        .filter_map(|line| line.strip_prefix("  ")?.split(' ').next())
        .filter(|name| !name.is_empty() && *name != "help")
        .collect()
}

/// Collects the options of a help text that have no text: neither on their line nor on the next.
fn collect_undescribed_options(help: &str, command: &str, found: &mut Vec<String>) {
    let lines: Vec<&str> = help.lines().collect();
    for (number, line) in lines.iter().enumerate() {
        let option = line.trim_start();
        let is_option = option.starts_with('-') && line.len() - option.len() <= 6;
        let is_described_beside = option.trim_start_matches(['-', ' ']).contains("  ");
        let is_described_below = lines.get(number + 1).is_some_and(|next| next.starts_with("          "));
        if is_option && !is_described_beside && !is_described_below {
            found.push(format!("{command}: {option}"));
        }
    }
}

/// Collects the undescribed options of a command and its subcommands. Returns the number of commands.
fn walk_commands(bench: &Bench, command: &[&str], found: &mut Vec<String>) -> usize {
    let arguments: Vec<&str> = command.iter().copied().chain(["--help"]).collect();
    let help = bench.boresight_words(&arguments).done().stdout;
    collect_undescribed_options(&help, &command.join(" "), found);
    let mut commands = 1;
    for name in subcommands(&help) {
        let inner: Vec<&str> = command.iter().copied().chain([name]).collect();
        commands += walk_commands(bench, &inner, found);
    }
    commands
}

#[test]
fn every_option_of_every_command_has_a_text() {
    let mut found = Vec::new();
    let commands = walk_commands(&Bench::new(), &[], &mut found);
    assert!(commands > 20, "{commands} commands");
    assert!(found.is_empty(), "without a text: {found:#?}");
}

/// Collects the properties of a schema, and of those within it, that have no description and refer to no
/// definition with one.
fn collect_undescribed_keys(schema: &Value, root: &Value, path: &str, found: &mut Vec<String>) -> usize {
    let mut keys = 0;
    if let Some(Value::Object(properties)) = schema.get("properties") {
        for (key, property) in properties {
            let refers =
                [property.get("$ref"), property.pointer("/anyOf/0/$ref")].into_iter().flatten().next();
            let target =
                refers.and_then(Value::as_str).and_then(|path| root.pointer(path.strip_prefix('#')?));
            let is_tag = property.get("const").is_some();
            let is_described = [Some(property), target]
                .into_iter()
                .flatten()
                .any(|schema| schema.get("description").is_some());
            if !is_tag && !is_described {
                found.push(format!("{path}.{key}"));
            }
            keys += 1 + collect_undescribed_keys(property, root, &format!("{path}.{key}"), found);
        }
    }
    for key in ["oneOf", "anyOf"] {
        for variant in schema.get(key).and_then(Value::as_array).into_iter().flatten() {
            keys += collect_undescribed_keys(variant, root, path, found);
        }
    }
    keys
}

#[test]
fn every_key_of_a_scenario_has_a_text() {
    for world in ["far_range", "docking"] {
        let schema = Bench::new().boresight(&format!("scenario schema --world {world}")).done().json();
        let mut found = Vec::new();
        let mut keys = collect_undescribed_keys(&schema, &schema, world, &mut found);
        for (name, definition) in schema["$defs"].as_object().unwrap() {
            keys += collect_undescribed_keys(definition, &schema, name, &mut found);
        }
        assert!(keys > 50, "{world}: {keys} keys");
        assert!(found.is_empty(), "without a text: {found:#?}");
    }
}

#[test]
fn every_column_has_a_text() {
    let csv = csv_tables().into_iter().chain(visibility::tables()).chain(navigate::tables());
    let others = [("rows.parquet", row_columns()), ("cases.parquet", case_columns())];
    let tables: Vec<(&str, Vec<FieldDeclaration>)> = csv.chain(parquet_tables()).chain(others).collect();
    for (table, fields) in tables {
        assert!(!fields.is_empty(), "{table}");
        for field in fields {
            assert!(!field.meaning.trim().is_empty(), "{table}: {:?} has no text", field.names);
        }
    }
}

#[test]
fn a_missing_text_is_found() {
    let mut found = Vec::new();
    let help = "Options:\n      --bare <X>\n\n      --below\n          A text\n\n  -b, --beside  A text\n";
    collect_undescribed_options(help, "run", &mut found);
    assert_eq!(found, ["run: --bare <X>"]);
    found.clear();
    let schema = serde_json::json!({"properties": {"a": {"type": "number"}, "b": {"description": "A text"}}});
    collect_undescribed_keys(&schema, &schema, "run", &mut found);
    assert_eq!(found, ["run.a"]);
}
