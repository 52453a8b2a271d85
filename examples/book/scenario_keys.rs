//! The page of scenario keys, from the JSON Schema of each world.

use std::collections::BTreeSet;

use serde_json::Value;

/// Returns the section of a world: a table of keys for each table of its scenarios.
pub(super) fn section(title: &str, schema: &Value) -> Result<String, String> {
    let Some(Value::Object(definitions)) = schema.get("$defs") else {
        return Err(format!("the schema of {title} has no definitions"));
    };
    let mut section = SchemaPage { definitions, written: BTreeSet::new(), page: format!("\n## {title}\n") };
    section.write_object("Top level", schema, None);
    Ok(section.page)
}

/// A JSON Schema with its definitions, and those of them that the page has already.
struct SchemaPage<'a> {
    definitions: &'a serde_json::Map<String, Value>,
    written: BTreeSet<&'a str>,
    page: String,
}

/// A line of a table cell: no line breaks, no bar.
fn cell(text: &str) -> String {
    text.split_whitespace().collect::<Vec<&str>>().join(" ").replace('|', "\\|")
}

fn text<'a>(schema: &'a Value, key: &str) -> &'a str {
    schema.get(key).and_then(Value::as_str).unwrap_or_default()
}

impl<'a> SchemaPage<'a> {
    /// The definition that a schema refers to, with its name, or the schema itself.
    fn resolve(&self, schema: &'a Value) -> (Option<&'a str>, &'a Value) {
        let refers = [schema.get("$ref"), schema.pointer("/anyOf/0/$ref")].into_iter().flatten().next();
        match refers.and_then(Value::as_str).and_then(|path| path.strip_prefix("#/$defs/")) {
            Some(name) => (Some(name), &self.definitions[name]),
            None => (None, schema),
        }
    }

    /// Type of a value, with the accepted words of an enumeration.
    fn type_of(&self, schema: &'a Value) -> String {
        let (_, resolved) = self.resolve(schema);
        let null = schema.get("anyOf").is_some() || resolved.pointer("/type/1") == Some(&Value::from("null"));
        let variants: Vec<String> = alternatives(resolved)
            .iter()
            .flat_map(|variant| match (variant.get("const"), variant.get("enum")) {
                (Some(word), _) => vec![word.clone()],
                (_, Some(Value::Array(words))) => words.clone(),
                _ => Vec::new(),
            })
            .map(|word| format!("`{word}`"))
            .collect();
        let name = match resolved.get("type") {
            Some(Value::String(name)) => name.as_str(),
            Some(Value::Array(names)) => names.first().and_then(Value::as_str).unwrap_or_default(),
            _ => "",
        };
        let described = match name {
            _ if !variants.is_empty() => variants.join(", "),
            "object" | "" => "table".to_owned(),
            "array" => {
                let items = resolved.get("items").map(|items| self.type_of(items)).unwrap_or_default();
                match resolved.get("maxItems").and_then(Value::as_u64) {
                    Some(count) if resolved.get("minItems").and_then(Value::as_u64) == Some(count) => {
                        format!("{count} × {items}")
                    }
                    _ => format!("list of {items}"),
                }
            }
            other => other.to_owned(),
        };
        if null { format!("{described} or absent") } else { described }
    }

    /// Range of a number, from the schema's bounds.
    fn range(&self, schema: &'a Value) -> String {
        let (_, resolved) = self.resolve(schema);
        let bound = |key: &str| {
            let found = [schema, resolved].into_iter().find_map(|schema| schema.get(key));
            found.filter(|bound| bound.as_f64().is_some_and(|bound| bound.abs() < 4e9)).map(number)
        };
        let (low, open_low) = (bound("minimum"), bound("exclusiveMinimum"));
        let (high, open_high) = (bound("maximum"), bound("exclusiveMaximum"));
        let low = low.map(|low| format!("≥ {low}")).or(open_low.map(|low| format!("> {low}")));
        let high = high.map(|high| format!("≤ {high}")).or(open_high.map(|high| format!("< {high}")));
        [low, high].into_iter().flatten().collect::<Vec<String>>().join(", ")
    }

    /// Writes the table of an object, then those of the objects within it.
    fn write_object(&mut self, title: &str, schema: &'a Value, defaults: Option<&'a Value>) {
        let Some(Value::Object(properties)) = schema.get("properties") else { return };
        let required: Vec<&str> = match schema.get("required") {
            Some(Value::Array(names)) => names.iter().filter_map(Value::as_str).collect(),
            _ => Vec::new(),
        };
        self.page.push_str(&format!("\n### {title}\n"));
        let description = cell(text(schema, "description"));
        if !description.is_empty() {
            self.page.push_str(&format!("\n{description}\n"));
        }
        self.page.push_str("\n| key | type | range | default | meaning |\n| --- | --- | --- | --- | --- |\n");
        for (key, property) in properties {
            let (_, resolved) = self.resolve(property);
            let default = defaults.and_then(|defaults| defaults.get(key)).or_else(|| property.get("default"));
            let default = match default {
                Some(Value::Null) | None if required.contains(&key.as_str()) => "required".to_owned(),
                Some(Value::Null) | None => "absent".to_owned(),
                Some(Value::Object(_)) => "see below".to_owned(),
                Some(value) => format!("`{}`", cell(&value.to_string())),
            };
            let meaning = match text(property, "description") {
                "" => text(resolved, "description"),
                meaning => meaning,
            };
            let (type_of, range) = (self.type_of(property), self.range(property));
            let meaning = cell(meaning);
            self.page.push_str(&format!("| `{key}` | {type_of} | {range} | {default} | {meaning} |\n"));
        }
        for (key, property) in properties {
            let default = defaults.and_then(|defaults| defaults.get(key)).or_else(|| property.get("default"));
            self.write_nested(&format!("{}{key}", prefix(title)), property, default);
        }
    }

    /// Writes the tables of a value that is a table, a choice of tables, or a list of either.
    fn write_nested(&mut self, path: &str, schema: &'a Value, default: Option<&'a Value>) {
        let (name, resolved) = self.resolve(schema);
        if let Some(items) = resolved.get("items") {
            return self.write_nested(&format!("{path}[]"), items, None);
        }
        if let Some(name) = name
            && !self.written.insert(name)
        {
            return;
        }
        self.write_object(&format!("`{path}`"), resolved, default);
        for variant in alternatives(resolved) {
            let Some(Value::Object(properties)) = variant.get("properties") else { continue };
            let tag = properties.iter().find_map(|(key, value)| Some((key, value.get("const")?)));
            if let Some((key, word)) = tag {
                let chosen = default.filter(|default| default.get(key) == Some(word));
                self.write_object(&format!("`{path}`, {key} = {word}"), variant, chosen);
            }
        }
    }
}

/// The variants of an enumeration.
fn alternatives(schema: &Value) -> &[Value] {
    let found = schema.get("oneOf").or_else(|| schema.get("anyOf"));
    found.and_then(Value::as_array).map(Vec::as_slice).unwrap_or_default()
}

/// A bound without trailing zeros.
fn number(value: &Value) -> String {
    let number = value.as_f64().unwrap_or_default();
    if number != 0.0 && !(1e-3..1e5).contains(&number.abs()) {
        format!("{number:e}")
    } else {
        format!("{number}")
    }
}

/// Prefix of the keys within a titled table.
fn prefix(title: &str) -> String {
    match title.split('`').nth(1) {
        Some(path) => format!("{path}."),
        None => String::new(),
    }
}
