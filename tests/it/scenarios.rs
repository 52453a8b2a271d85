//! `boresight scenario`: the built-in scenarios are valid, the schema describes the content of scenarios, and
//! a new scenario runs.

use boresight::far_range::STARTING_POINT;
use boresight::scenario::BUILT_IN;
use serde_json::{Value, json};

use crate::support::Bench;

#[test]
fn every_built_in_scenario_passes_its_check() {
    let bench = Bench::new();
    for scenario in BUILT_IN {
        let check = bench.boresight(&format!("scenario check {} --json", scenario.name)).done().json();
        assert_eq!((&check["scenario"], &check["ok"]), (&json!(scenario.name), &json!(true)));
        assert!(check["frames"].as_u64() > Some(0), "{check}");
        // The file on its own is equivalent to the built-in scenario: a target is built in as well.
        bench.write("copy.toml", scenario.text);
        let copy = bench.boresight("scenario check copy.toml --json").done().json();
        for key in ["world", "frames", "marks", "stars"] {
            assert_eq!(copy[key], check[key], "{key}");
        }
        if check["world"] == "far_range" {
            assert!(check["stars"].as_u64() > Some(1000), "{check}");
            let bytes = |key: &str| check[key].as_u64().unwrap();
            assert!(bytes("frame_bytes_at_most") <= bytes("whole_image_bytes"), "{check}");
        }
    }
}

/// A check prints the quantities that follow from the numbers of a scenario, and the built-in scenarios cause
/// no warning.
#[test]
fn a_check_reports_derived_quantities() {
    let bench = Bench::new();
    for scenario in BUILT_IN {
        let check = bench.boresight(&format!("scenario check {} --json", scenario.name)).done().json();
        assert_eq!(check["warnings"], json!([]), "{}", scenario.name);
    }
    let check = bench.boresight("scenario check starting-point --json").done().json();
    let near = |value: &Value, expected: f64, tolerance: f64| {
        let value = value.as_f64().unwrap();
        assert!((value - expected).abs() < tolerance, "{value}, expected {expected}");
    };
    // 752 × 8.6 µm and 580 × 8.3 µm behind 20.187 mm: 18.2° × 13.6°, 88″ × 85″ per pixel.
    near(&check["field_deg"][0], 18.2, 0.1);
    near(&check["field_deg"][1], 13.6, 0.1);
    near(&check["pixel_arcsec"][0], 87.87, 0.01);
    near(&check["pixel_arcsec"][1], 84.81, 0.01);
    assert_eq!((&check["exposure_s"], &check["duration_s"]), (&json!([0.001, 0.25]), &json!(5985.0)));
    near(&check["limiting_magnitude"], 8.10, 0.05);
    bench.boresight("render starting-point --frames 0..1 --out set").done();
    let bytes = std::fs::metadata(bench.path("set/frames/000000.fits")).unwrap().len();
    near(&check["fits_bytes"], bytes as f64, 2880.5);
    let text = bench.boresight("scenario check starting-point").done().stdout;
    for part in [
        "field of view 18.",
        "exposures of 0.001 s to 0.25 s",
        "SNR 5",
        "400 frames in 5985 s",
        " MB in total",
    ] {
        assert!(text.contains(part), "`{part}` in {text}");
    }
    let check = bench.boresight("scenario check docking --json").done().json();
    near(&check["views"][0]["field_deg"][0], 15.0, 0.1);
    near(&check["views"][1]["field_deg"][0], 40.0, 0.1);
    assert_eq!((&check["frames"], &check["field_bytes"]), (&json!(25_169), &json!(768 * 288)));
    let text = bench.boresight("scenario check docking").done().stdout;
    assert!(
        text.contains("camera TV-1: field of view 14.999° × ") && text.contains("5.6 GB in total"),
        "{text}"
    );
}

/// A scenario that a run would reject does not pass a check.
#[test]
fn a_check_includes_the_pipeline() {
    let bench = Bench::new();
    let suppressed = format!("zero_suppression_dn = 67\n{STARTING_POINT}");
    bench.write("suppressed.toml", &suppressed);
    let answer = bench.boresight("scenario check suppressed.toml --json");
    assert_eq!(answer.status, Some(1), "{}", answer.stderr);
    let check = answer.json();
    let error = check["error"].as_str().unwrap();
    assert!(error.contains("far_range.mode") && error.contains("is best, expected paper"), "{error}");
    bench.boresight("run suppressed.toml --frames 0..1").refused(&["mode is best, expected paper"]);
    bench.write("suppressed.toml", format!("{suppressed}\n[far_range]\nmode = \"paper\"\n"));
    bench.boresight("run suppressed.toml --frames 0..1").refused(&["thresholds.mode is automatic"]);
    // An external program determines its own thresholds.
    bench.boresight("scenario check suppressed.toml --pipeline exec:true").done();
    bench
        .boresight("scenario check suppressed.toml --pipeline nobody")
        .refused(&["unknown pipeline `nobody`"]);
}

#[test]
fn the_list_names_every_built_in_scenario_with_its_frames() {
    let bench = Bench::new();
    let list = bench.boresight("scenario list --json").done().json();
    let list = list.as_array().unwrap();
    let names: Vec<_> = list.iter().map(|entry| entry["name"].as_str().unwrap()).collect();
    assert_eq!(names, BUILT_IN.iter().map(|scenario| scenario.name).collect::<Vec<_>>());
    assert_eq!(list[0], json!({ "name": "argon", "frames": 16_077, "title": list[0]["title"] }));
    let text = bench.boresight("scenario list").done().stdout;
    for entry in list {
        let (name, title) = (entry["name"].as_str().unwrap(), entry["title"].as_str().unwrap());
        let line = text.lines().find(|line| line.starts_with(name)).unwrap();
        assert!(line.contains(title) && line.contains(&entry["frames"].to_string()), "{line}");
    }
}

/// A printed camera replaces that of a scenario.
#[test]
fn a_camera_can_be_pasted_into_a_scenario() {
    let bench = Bench::new();
    let names = bench.boresight("scenario camera --json").done().json();
    let start: toml::Table = STARTING_POINT.parse().unwrap();
    assert!(names.as_array().unwrap().len() >= 3, "{names}");
    for name in names.as_array().unwrap().iter().map(|name| name.as_str().unwrap()) {
        let camera = bench.boresight(&format!("scenario camera {name}")).done().stdout;
        let mut scenario = start.clone();
        scenario.extend(camera.parse::<toml::Table>().unwrap());
        bench.write(&format!("{name}.toml"), scenario.to_string());
        bench.boresight(&format!("scenario check {name}.toml")).done();
    }
    let list = bench.boresight("scenario camera").done().stdout;
    assert_eq!(list.lines().count(), names.as_array().unwrap().len());
    assert!(
        list.contains("rosetta-navcam          The navigation camera of Rosetta (Galileo Avionica)"),
        "{list}"
    );
    bench.boresight("scenario camera kodak").refused(&["kodak", "uasc-far-range"]);
}

/// A JSON Schema, interpreted by the rules of JSON Schema and without the library that made it.
struct Schema(Value);

impl Schema {
    fn read() -> Self {
        Self::for_world("far_range")
    }

    /// Returns the schema of one world.
    fn for_world(world: &str) -> Self {
        Self(Bench::new().boresight(&format!("scenario schema --world {world}")).done().json())
    }

    /// Returns all alternatives of a schema, with its references resolved.
    fn alternatives<'a>(&'a self, schema: &'a Value) -> Vec<&'a Value> {
        let mut all = vec![schema];
        if let Some(reference) = schema["$ref"].as_str() {
            let pointer = reference.strip_prefix('#').unwrap();
            all.extend(self.alternatives(self.0.pointer(pointer).unwrap()));
        }
        for several in ["anyOf", "oneOf", "allOf"] {
            for one in schema[several].as_array().into_iter().flatten() {
                all.extend(self.alternatives(one));
            }
        }
        all
    }

    /// Returns the possible schemas of a value under a key.
    fn under<'a>(&'a self, schemas: &[&'a Value], key: &str) -> Vec<&'a Value> {
        let found = schemas.iter().filter_map(|schema| schema["properties"].get(key));
        found.flat_map(|schema| self.alternatives(schema)).collect()
    }

    fn items<'a>(&'a self, schemas: &[&'a Value]) -> Vec<&'a Value> {
        let found = schemas.iter().filter_map(|schema| schema.get("items").filter(|items| items.is_object()));
        found.flat_map(|schema| self.alternatives(schema)).collect()
    }

    /// Checks that every key of a value, at any depth, is in the schema; returns the number of keys.
    fn check_keys(&self, path: &str, value: &toml::Value, schemas: &[&Value]) -> usize {
        match value {
            toml::Value::Table(table) => table
                .iter()
                .map(|(key, value)| {
                    let path = format!("{path}.{key}");
                    let schemas = self.under(schemas, key);
                    assert!(!schemas.is_empty(), "{path} is not in the schema");
                    1 + self.check_keys(&path, value, &schemas)
                })
                .sum(),
            toml::Value::Array(values) => {
                let schemas = self.items(schemas);
                values.iter().map(|value| self.check_keys(&format!("{path}[]"), value, &schemas)).sum()
            }
            _ => 0,
        }
    }
}

#[test]
fn every_key_of_the_built_in_scenarios_is_in_the_schema() {
    for scenario in BUILT_IN {
        let table: toml::Table = scenario.text.parse().unwrap();
        let schema =
            Schema::for_world(table.get("world").map_or("far_range", |world| world.as_str().unwrap()));
        let keys = schema.check_keys(scenario.name, &table.into(), &[&schema.0]);
        // A traversal that finds nothing must not pass.
        assert!(keys > 20, "{}: {keys} keys", scenario.name);
    }
}

/// Collects every property of a schema and of its definitions, with its path.
fn properties<'a>(path: &str, schema: &'a Value, found: &mut Vec<(String, &'a Value)>) {
    match schema {
        Value::Object(members) => {
            let own = members.get("properties").and_then(Value::as_object).into_iter().flatten();
            found.extend(own.map(|(key, property)| (format!("{path}.{key}"), property)));
            members.iter().for_each(|(key, member)| properties(&format!("{path}/{key}"), member, found));
        }
        Value::Array(members) => members.iter().for_each(|member| properties(path, member, found)),
        _ => {}
    }
}

#[test]
fn every_property_of_the_schema_is_described_and_units_are_in_the_names() {
    for (world, at_least) in [("far_range", 80), ("docking", 80), ("middle_range", 20)] {
        check_descriptions(&Schema::for_world(world), at_least);
    }
}

fn check_descriptions(schema: &Schema, at_least: usize) {
    assert_eq!(schema.0["$schema"], "https://json-schema.org/draft/2020-12/schema");
    let mut found = Vec::new();
    properties("", &schema.0, &mut found);
    assert!(found.len() > at_least, "{} properties", found.len());
    for (path, property) in found {
        // The tag of an enum is described by the alternative that it names.
        let is_tag = property.get("const").is_some();
        let described = |schema: &&Value| schema["description"].as_str().is_some_and(|text| text.len() > 3);
        assert!(is_tag || schema.alternatives(property).iter().any(described), "{path}: {property}");
    }
}

#[test]
fn the_schema_is_the_same_with_and_without_json() {
    let bench = Bench::new();
    let plain = bench.boresight("scenario schema").done();
    assert_eq!(plain.json(), bench.boresight("scenario schema --json").done().json());
}

#[test]
fn unknown_keys_are_errors_in_the_schema_too() {
    let schema = Schema::read();
    assert_eq!(schema.0["additionalProperties"], false);
    for name in ["Camera", "SensorConfig", "OrbitConfig", "FarRangeConfig"] {
        assert_eq!(schema.0["$defs"][name]["additionalProperties"], false, "{name}");
    }
}

#[test]
fn a_new_scenario_passes_its_check_and_runs() {
    let bench = Bench::new();
    let answer = bench.boresight("scenario new mine.toml --json").done().json();
    assert_eq!(answer["file"], "mine.toml");
    let comments = bench.read("mine.toml").matches('#').count();
    assert!(comments > 20, "a commented starting point has {comments} comments");
    let check = bench.boresight("scenario check mine.toml --json").done().json();
    assert_eq!(check["scenario"], "mine");
    let score = bench.boresight("run mine.toml --frames 0..5 --out run --json").done().json();
    assert_eq!((&score["scenario"], &score["frames"]), (&json!("mine"), &json!(5)));
}

/// The next step of a new user: removing the number signs.
#[test]
fn the_commented_out_parts_of_a_new_scenario_are_right_too() {
    let bench = Bench::new();
    bench.boresight("scenario new mine.toml").done();
    let lines: Vec<String> = bench
        .read("mine.toml")
        .lines()
        .map(|line| match line.strip_prefix("# ") {
            // Not together with interlace and frame transfer; see below.
            Some(rest) if rest.starts_with("rolling_shutter") => line.to_owned(),
            Some(rest) if rest.starts_with('[') || rest.split(' ').nth(1) == Some("=") => rest.to_owned(),
            _ => line.to_owned(),
        })
        .collect();
    let text = lines.join("\n");
    let table: toml::Table = text.parse().unwrap();
    assert!(["roi", "far_range"].iter().all(|key| table.contains_key(*key)), "{text}");
    assert!(table["orbit"].as_table().unwrap().contains_key("manoeuvres"), "{text}");
    let sensor = table["sensor"].as_table().unwrap();
    for key in ["blooming", "temperature", "line_noise", "fixed_pattern", "cosmic_rays", "interlace"] {
        assert!(sensor.contains_key(key), "{key}: {text}");
    }
    assert!(sensor["hot_pixels"].as_table().unwrap().contains_key("telegraph"), "{text}");
    bench.write("whole.toml", text);
    bench.boresight("scenario check whole.toml").done();
    bench.boresight("run whole.toml --frames 0..2 --out run").done();

    let rolling = bench.read("mine.toml").replace("# rolling_shutter", "rolling_shutter");
    assert!(rolling.contains("\nrolling_shutter"), "{rolling}");
    bench.write("rolling.toml", rolling);
    bench.boresight("run rolling.toml --frames 0..2 --out rolled").done();
}

/// Each alternative line is tested in place of the two lines of the Gaussian.
#[test]
fn the_other_point_spread_functions_of_a_new_scenario_are_right_too() {
    let bench = Bench::new();
    bench.boresight("scenario new mine.toml").done();
    let text = bench.read("mine.toml");
    let start: toml::Table = text.parse().unwrap();
    bench.write("psf.csv", ["0.1,0.5,0.1", "0.5,1.0,0.5", "0.1,0.5,0.1"].join("\n"));
    let lines: Vec<&str> = text.lines().filter_map(|line| line.strip_prefix("#   ")).collect();
    assert_eq!(lines.len(), 5);
    for line in lines {
        let keys = line.split(" # ").next().unwrap();
        let mut scenario = start.clone();
        scenario.extend(format!("psf = {{ {keys} }}").parse::<toml::Table>().unwrap());
        bench.write("other.toml", scenario.to_string());
        bench.boresight("scenario check other.toml").done();
    }
}

/// 752 × 580 pixels of 12 bits; 40 regions of 20 × 9 with eight bytes each for their position.
#[test]
fn a_check_reports_the_telemetry_of_a_frame() {
    let bench = Bench::new();
    bench.boresight("scenario new whole.toml").done();
    let roi =
        "[roi]\ncount = 40\ncolumns = 20\nrows = 9\nanchor_column = 10\nanchor_row = 2\nthreshold_dn = 60\n";
    bench.write("regions.toml", format!("{}\n{roi}scan = \"columns\"\n", bench.read("whole.toml")));
    for (file, bytes) in [("whole.toml", 654_240), ("regions.toml", 40 * (8 + 270))] {
        let check = bench.boresight(&format!("scenario check {file} --json")).done().json();
        assert_eq!(check["frame_bytes_at_most"], bytes);
        assert_eq!(check["whole_image_bytes"], 654_240);
        let text = bench.boresight(&format!("scenario check {file}")).done().stdout;
        assert!(text.contains(&format!(" {bytes} bytes of telemetry per frame")), "{text}");
    }
}

/// Relative paths in a scenario refer to the scenario's directory, regardless of the directory in which the
/// command runs.
#[test]
fn a_catalogue_beside_the_scenario_is_found() {
    let bench = Bench::new();
    bench.scenario("scenarios/mine.toml", "starting-point", |scenario| {
        scenario["catalog"]["source"] = "stars.csv".into();
    });
    let stars: Vec<String> =
        (1..=500).map(|id| format!("{id},{},{},4.5", id * 7 % 360, id * 11 % 170 - 85)).collect();
    bench.write("scenarios/stars.csv", format!("id,ra_deg,dec_deg,v_mag\n{}\n", stars.join("\n")));
    let check = bench.boresight("scenario check scenarios/mine.toml --json").done().json();
    assert_eq!(check["stars"], 500);
    bench.boresight("run scenarios/mine.toml --frames 0..2 --out run").done();
}

/// Files of a mesh are found beside the scenario, are part of the hash of a run, and must not change before
/// it is repeated.
#[test]
fn a_mesh_beside_the_scenario_is_found_and_is_part_of_the_hash() {
    let bench = Bench::new();
    let files = ["smallsat.obj", "smallsat.mtl"];
    for file in files {
        let path = format!("{}/scenarios/targets/{file}", env!("CARGO_MANIFEST_DIR"));
        bench.write(&format!("scenarios/targets/{file}"), std::fs::read(path).unwrap());
    }
    let fragment: toml::Table = include_str!("../../examples/smallsat.toml").parse().unwrap();
    bench.scenario("scenarios/mine.toml", "starting-point", |scenario| scenario.extend(fragment));
    bench.boresight("scenario check scenarios/mine.toml").done();
    let hash = |run: &str| {
        bench.boresight(&format!("run scenarios/mine.toml --frames 0..1 --out {run}")).done();
        let record: toml::Table = bench.read(&format!("{run}/run.toml")).parse().unwrap();
        assert!(record["files"]["target.path"].is_str() && record["files"]["target.material_path"].is_str());
        record["hash"].as_str().unwrap().to_owned()
    };
    let first = hash("run");
    let library = bench.read("scenarios/targets/smallsat.mtl");
    bench.write("scenarios/targets/smallsat.mtl", library.replace("Kd 0.28 0.28 0.28", "Kd 0.27 0.27 0.27"));
    assert_ne!(hash("darker"), first);
    bench
        .boresight("run run/run.toml --out again")
        .refused(&["target.material_path", "the file has changed"]);
    bench.edit("scenarios/mine.toml", "radius_m = 2.07", "radius_m = 2.2");
    let parts = ["mine.toml", "target.radius_m", "within 1 %", "2.069831"];
    bench.boresight("scenario check scenarios/mine.toml").found(&parts);
}
