//! Dependencies between the project's crates point down, and no reader of input can panic.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use cargo_metadata::{DependencyKind, Metadata, MetadataCommand, Package, Target};

/// Each crate of the project, and the project's crates that it may depend on. The pipelines depend only on
/// the contract, and therefore cannot share code with the simulator.
const ARROWS: [(&str, &str); 40] = [
    ("contract", ""),
    ("config", "contract"),
    ("draws", ""),
    ("navigation", "contract"),
    ("truth", "config contract draws"),
    ("optics", "config contract truth"),
    ("scene", "config contract draws optics truth"),
    ("render", "contract optics scene truth"),
    ("sensor", "config contract draws optics render truth"),
    ("sim", "config contract draws optics render scene sensor truth"),
    ("pipeline", "contract"),
    ("statistics", "draws"),
    ("score", "contract statistics"),
    ("files", "config contract sim"),
    ("flight-dynamics", "config contract files sim"),
    ("labels", "contract files sim"),
    ("scenario", "config contract files"),
    ("run", "config contract files labels pipeline scenario score sim"),
    ("study", "config contract draws files pipeline run scenario score statistics"),
    ("gate", "config files run scenario score statistics study"),
    ("show", "contract"),
    ("view", "contract files run show"),
    ("report", "config contract files gate run scenario score sim study"),
    ("monitor", "contract files run sim"),
    ("mitsuba", "contract files sim"),
    ("docking", "config contract files labels mitsuba pipeline run scenario score sim statistics"),
    ("docking-views", "contract docking files monitor pipeline report run scenario score show sim view"),
    (
        "far-range",
        "config contract draws files flight-dynamics labels pipeline run scenario score sim statistics",
    ),
    (
        "navigate",
        "config contract draws far-range files flight-dynamics navigation pipeline run scenario score sim",
    ),
    ("camera-fit", "contract files pipeline sim"),
    ("twin", "camera-fit far-range files flight-dynamics sim"),
    ("sensor-fit", ""),
    ("visibility", "config contract draws far-range files pipeline run scenario sim statistics"),
    (
        "far-range-views",
        "camera-fit contract far-range files monitor navigate pipeline report run scenario score show sim statistics twin view visibility",
    ),
    ("middle-range", "contract draws files monitor optics render report run scenario score sensor truth"),
    (
        "boresight",
        "camera-fit config contract docking docking-views far-range far-range-views files flight-dynamics gate labels middle-range mitsuba monitor navigate pipeline report run scenario score sensor-fit show sim statistics study twin view visibility",
    ),
    ("examples", "boresight contract"),
    ("python", "boresight config contract pipeline sim"),
    ("fuzz", "boresight contract pipeline sim"),
    ("research", "boresight contract draws pipeline sim"),
];

/// Each crate whose own tests and examples depend on crates that it does not depend on itself. The gates
/// compare figures of real worlds there.
const ARROWS_OF_TESTS: [(&str, &str); 5] = [
    ("boresight", "draws research"),
    ("docking", "draws"),
    ("gate", "docking draws far-range"),
    ("scenario", "draws sim"),
    ("sensor-fit", "draws sim"),
];

/// Returns the packages of the workspace, as declared in their manifests.
pub(crate) fn workspace() -> Metadata {
    MetadataCommand::new()
        .manifest_path(concat!(env!("CARGO_MANIFEST_DIR"), "/Cargo.toml"))
        .no_deps()
        .exec()
        .expect("cargo metadata runs wherever cargo test does")
}

#[test]
fn dependencies_point_down_and_nowhere_else() {
    let packages = workspace().packages;
    let ours: BTreeSet<String> = packages.iter().map(|package| package.name.to_string()).collect();
    let mut found = BTreeMap::new();
    let mut found_in_tests = BTreeMap::new();
    for package in &packages {
        let built = dependencies(package, &ours, |kind| kind != DependencyKind::Development);
        let tested = dependencies(package, &ours, |kind| kind == DependencyKind::Development);
        let only_tested: BTreeSet<String> = tested.difference(&built).cloned().collect();
        found.insert(package.name.to_string(), built);
        if !only_tested.is_empty() {
            found_in_tests.insert(package.name.to_string(), only_tested);
        }
    }
    assert_eq!(found, declared(&ARROWS));
    // A dependency of a test counts as well: a pipeline's test would share mathematics with the simulator.
    assert_eq!(found_in_tests, declared(&ARROWS_OF_TESTS));
}

/// Returns the project's crates among the dependencies of the given kinds.
fn dependencies(
    package: &Package,
    ours: &BTreeSet<String>,
    is_wanted: fn(DependencyKind) -> bool,
) -> BTreeSet<String> {
    let wanted = package.dependencies.iter().filter(|dependency| is_wanted(dependency.kind));
    wanted.map(|dependency| dependency.name.clone()).filter(|name| ours.contains(name)).collect()
}

/// Returns a list of arrows with the names of the packages.
fn declared(arrows: &[(&str, &str)]) -> BTreeMap<String, BTreeSet<String>> {
    let package = |name: &str| match name {
        "boresight" => name.to_owned(),
        name => format!("boresight-{name}"),
    };
    let targets = |to: &str| to.split_whitespace().map(package).collect();
    arrows.iter().map(|(from, to)| (package(from), targets(to))).collect()
}

/// Maximum number of modules at the root of a crate of `oracle/` or `worlds/`, or of the package itself:
/// files that share an idea are in a directory.
const MAX_MODULES: usize = 12;

#[test]
fn the_root_of_a_crate_reads_like_a_table_of_contents() {
    let mut crates = 0;
    for package in workspace().packages {
        let root = Path::new(env!("CARGO_MANIFEST_DIR"));
        let is_above = ["oracle", "worlds"].map(|folder| root.join(folder));
        if !is_above.iter().any(|folder| package.manifest_path.starts_with(folder))
            && package.name.as_str() != "boresight"
        {
            continue;
        }
        let library = package.targets.iter().find(|target| target.is_lib()).expect("a library");
        let items = syn::parse_file(&read(library.src_path.as_std_path())).expect("Rust").items;
        let is_test = |module: &syn::ItemMod| module.attrs.iter().any(|a| a.path().is_ident("cfg"));
        let modules = items.iter().filter(|item| matches!(item, syn::Item::Mod(m) if !is_test(m))).count();
        assert!(modules <= MAX_MODULES, "{}: {modules} modules at its root", package.name);
        crates += 1;
    }
    assert_eq!(crates, 25, "crates of the oracle and of the worlds, and the package itself");
}

/// Arrow took a fifth of the release build. The tables are flat; only Python needs Arrow, to pass them on.
#[test]
fn only_the_python_package_depends_on_arrow() {
    for package in workspace().packages {
        for dependency in &package.dependencies {
            let is_arrow = dependency.name.starts_with("arrow");
            assert!(
                !is_arrow || package.name.as_str() == "boresight-python",
                "{} {}",
                package.name,
                dependency.name
            );
            if dependency.name == "parquet" {
                assert!(!dependency.uses_default_features, "{}: they have `arrow`", package.name);
                assert_eq!(dependency.features, ["snap"], "{}", package.name);
            }
        }
    }
}

/// Lints against panics; `unwrap_used` and `todo` are denied everywhere.
const LINTS: [&str; 5] = ["indexing_slicing", "string_slice", "expect_used", "panic", "unreachable"];

/// Calls that read bytes from outside the module.
const READS: [&str; 21] = [
    "File::open(",
    "fs::read(",
    "fs::read_to_string(",
    "regular_file::read",
    "toml_file::parse",
    "serde_json::from_",
    "csv::Reader",
    "ParquetFile::open(",
    "open_regular(",
    "TableReader::",
    "Dataset::open(",
    "FieldSource::open(",
    "read_field_measurements(",
    "read_field_telemetry(",
    "read_measurements(",
    "read_motion(",
    "read_radiance(",
    "read_stars(",
    "read_telemetry(",
    "read_until(",
    "stdin()",
];
/// Files that contain one of these calls but read no input, each with the reason.
const NO_READERS: [(&str, &str); 1] = [("sim/src/docking/simulator.rs", "passes the text to serde")];

/// Crates that compute: their readers of input deny the lints, file by file. The other crates deny them as a
/// whole.
const COMPUTING: [&str; 14] = [
    "boresight-camera-fit",
    "boresight-draws",
    "boresight-navigation",
    "boresight-optics",
    "boresight-pipeline",
    "boresight-render",
    "boresight-scene",
    "boresight-score",
    "boresight-sensor",
    "boresight-sensor-fit",
    "boresight-sim",
    "boresight-statistics",
    "boresight-truth",
    "boresight-twin",
];

/// Developers' programs, which only read their own input.
const TOOLS: [&str; 3] = ["boresight-examples", "boresight-fuzz", "boresight-research"];

/// The lints apply to the crates that read input, apart from exempt modules of arithmetic, and to the readers
/// of the crates that compute.
#[test]
fn no_reader_can_panic() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut readers = 0;
    for package in workspace().packages.iter().filter(|package| !TOOLS.contains(&package.name.as_str())) {
        let is_library = |target: &&Target| target.is_lib() || target.is_cdylib();
        let library = package.targets.iter().find(is_library).expect("every crate has a library");
        let library = library.src_path.as_std_path();
        let is_computing = COMPUTING.contains(&package.name.as_str());
        assert_eq!(denies_panics(&read(library)), !is_computing, "{}: its lints", library.display());
        let files = sources(library.parent().expect("a folder"));
        let exempt: Vec<PathBuf> =
            files.iter().flat_map(|file| exempt_modules(file)).flat_map(|module| files_of(&module)).collect();
        let unlinted = if is_computing { files } else { exempt };
        for file in unlinted {
            let name = file.strip_prefix(root).expect("inside").to_string_lossy().replace('\\', "/");
            let Some(call) = reading_call(&read(&file)) else { continue };
            readers += 1;
            assert!(
                NO_READERS.iter().any(|(known, _)| *known == name) || is_test(&name) || is_denied(&file),
                "{name} calls {call} in a module that may panic: deny the lints in it"
            );
        }
    }
    assert!(readers >= 5, "{readers} readers were found, expected those of sim and pipeline");
}

/// Returns the first call of a file, outside its tests, that reads input.
fn reading_call(text: &str) -> Option<&'static str> {
    let code = text.split("#[cfg(test)]").next().unwrap_or_default();
    let mut lines = code.lines().filter(|line| !line.trim_start().starts_with("//"));
    lines.find_map(|line| READS.into_iter().find(|call| line.contains(call)))
}

/// Returns true if a file or one of the modules that contain it denies the lints.
fn is_denied(file: &Path) -> bool {
    let modules = file.ancestors().skip(1).map(|folder| folder.join("mod.rs"));
    denies_panics(&read(file))
        || modules.take_while(|path| path.is_file()).any(|path| denies_panics(&read(&path)))
}

#[test]
fn an_exemption_is_found_however_it_is_written() {
    let folder = tempfile::tempdir().expect("a temporary directory");
    let file = folder.path().join("lib.rs");
    let text = "#[allow(\n    clippy::indexing_slicing,\n    reason = \"a\"\n)]\npub mod a;\nmod b;\n#[allow(clippy::panic)]\nmod c;\n";
    std::fs::write(&file, text).expect("written");
    let names: Vec<_> = exempt_modules(&file).iter().map(|p| p.file_name().map(|n| n.to_owned())).collect();
    assert_eq!(names, [Some("a".into()), Some("c".into())]);
    std::fs::write(&file, "#![allow(clippy::panic)]\n").expect("written");
    assert!(std::panic::catch_unwind(|| exempt_modules(&file)).is_err(), "a file cannot exempt itself");
}

/// Folders whose code knows no world: a world is a folder of `worlds/`, its simulator and its pipelines.
const KNOW_NO_WORLD: [&str; 5] = ["config", "contract", "navigation", "oracle", "src"];

/// Files of these folders that may name a world, each with the reason. A file or folder that is named for a
/// world may, too: it holds the world's part of an interface or of the command.
const LISTS_OF_WORLDS: [(&str, &str); 15] = [
    ("contract/src/conformance/mod.rs", "modules of the interfaces of pipelines"),
    ("contract/src/lib.rs", "modules of the interfaces of pipelines"),
    ("oracle/scenario/src/builtin.rs", "names of files in scenarios/"),
    ("oracle/scenario/src/cameras.rs", "names of files in scenarios/cameras/"),
    ("src/command/dataset.rs", "options of sequences and renderers"),
    ("src/command/demo/mod.rs", "parts of the demo"),
    ("src/command/demo/page.rs", "parts of the demo"),
    ("src/command/examples.rs", "names of files in scenarios/"),
    ("src/command/execute.rs", "navigation after a run"),
    ("src/command/mod.rs", "commands that only one world has"),
    ("src/command/reproduce.rs", "names of papers"),
    ("src/command/run.rs", "option --renderer, navigation after a run"),
    ("src/lib.rs", "crates under one name"),
    ("src/tables.rs", "list of the tables"),
    ("src/worlds.rs", "list of the worlds"),
];

/// Returns the first line of code, comments and tests apart, that names a world.
fn line_that_names_a_world(text: &str) -> Option<&str> {
    let code = text.split("#[cfg(test)]").next().unwrap_or_default();
    code.lines().find(|line| {
        let line = line.trim_start().to_lowercase();
        let names =
            ["far_range", "farrange", "far-range", "far range", "docking", "middle_range", "middle-range"];
        !line.starts_with("//") && names.iter().any(|name| line.contains(name))
    })
}

/// Returns true if a file, or a folder that contains it, is named for a world.
fn is_of_a_world(name: &str) -> bool {
    name.split('/')
        .any(|part| matches!(part.trim_end_matches(".rs"), "far_range" | "docking" | "middle_range"))
}

#[test]
fn only_its_own_folders_name_a_world() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut naming = BTreeMap::new();
    for path in KNOW_NO_WORLD.iter().flat_map(|folder| sources(&root.join(folder))) {
        let name = path.strip_prefix(root).expect("a file of ours").to_string_lossy().replace('\\', "/");
        if is_of_a_world(&name) || is_test(&name) || name.ends_with("hand_made.rs") {
            continue;
        }
        if let Some(line) = line_that_names_a_world(&read(&path)) {
            naming.insert(name, line.trim().to_owned());
        }
    }
    let found: Vec<&str> = naming.keys().map(String::as_str).collect();
    assert_eq!(found, LISTS_OF_WORLDS.map(|(name, _)| name), "{naming:#?}");
    assert!(line_that_names_a_world("match world {\n    \"far_range\" => 1,\n}").is_some());
    assert!(line_that_names_a_world("// \"far_range\"\nlet of: Mission;").is_none());
    assert!(is_of_a_world("src/command/docking/mod.rs") && !is_of_a_world("oracle/run/src/world/mod.rs"));
}

fn read(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

fn is_test(name: &str) -> bool {
    name.ends_with("tests.rs") || name.contains("/tests/")
}

/// Returns true if a file denies every lint of [`LINTS`] for itself and the modules below it.
fn denies_panics(text: &str) -> bool {
    let text: String = text.chars().filter(|c| !c.is_whitespace()).collect();
    let list = text.split_once("#![cfg_attr(not(test),deny(").and_then(|(_, rest)| rest.split_once("))]"));
    let list = list.map_or("", |(list, _)| list);
    LINTS.iter().all(|lint| list.split(',').any(|name| name.strip_prefix("clippy::") == Some(lint)))
}

/// Returns the paths, without extension, of the modules that a file declares and exempts from a lint of
/// [`LINTS`].
fn exempt_modules(file: &Path) -> Vec<PathBuf> {
    let text = read(file);
    let is_lint = |attribute: &str| LINTS.iter().any(|lint| attribute.contains(&format!("clippy::{lint}")));
    let is_root = ["lib.rs", "mod.rs"].iter().any(|root| file.ends_with(root));
    let folder = if is_root { file.with_file_name("") } else { file.with_extension("") };
    let mut exempt = Vec::new();
    for attribute in text.split("#![allow(").skip(1) {
        let attribute = attribute.split(")]").next().unwrap_or_default();
        assert!(!is_lint(attribute), "{}: exempt the module where it is declared", file.display());
    }
    for attribute in text.split("#[allow(").skip(1) {
        let Some((attribute, item)) = attribute.split_once(")]") else { continue };
        let item = item.trim_start().lines().next().unwrap_or_default();
        let module = item.strip_suffix(';').and_then(|item| item.rsplit_once("mod "));
        if let Some((_, module)) = module.filter(|_| is_lint(attribute)) {
            exempt.push(folder.join(module));
        }
    }
    exempt
}

/// Returns the files of a module, given by its path without extension.
fn files_of(module: &Path) -> Vec<PathBuf> {
    let file = module.with_extension("rs");
    let mut files = if module.is_dir() { sources(module) } else { Vec::new() };
    files.extend(file.is_file().then_some(file));
    assert!(!files.is_empty(), "{}: no such module", module.display());
    files
}

/// Returns the Rust files in a directory and below it.
fn sources(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).expect("a folder of sources");
    let paths = entries.map(|entry| entry.expect("an entry").path());
    paths
        .flat_map(|path| if path.is_dir() { sources(&path) } else { vec![path] })
        .filter(|path| path.extension().is_some_and(|extension| extension == "rs"))
        .collect()
}
