//! Common parts of the end-to-end suites: the command in a separate directory, its output, and the truth that
//! it writes.

use std::collections::BTreeMap;
use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Duration;

use boresight::docking::rows::FieldTruthRow;
use boresight::far_range::rows::{FrameTruthRow, ObjectTruthRow};
use boresight::files::{Row, TableReader};
use boresight::scenario::BUILT_IN;
use serde_json::Value;
use sim::docking::FieldTruth;
use sim::truth::{FrameTruth, ObjectTruth};
use tempfile::{TempDir, tempdir};

/// Longer than any command of the suites takes on a busy machine: a command that hangs fails.
const HANGS: Duration = Duration::from_secs(120);

/// A study that takes a second: six cases of two frames.
pub(crate) const STUDY: &str = r#"
title = "two frames of ARGON"
scenario = "argon"
seed = 5
frames = "2000..2002"
[stop]
cases = 6
[[vary]]
path = "psf.sigma_px"
distribution = { kind = "normal", mean = 0.8, sigma = 0.1 }
[[vary]]
path = "sensor.hot_pixels.count"
distribution = { kind = "integer", min = 0, max = 40 }
"#;

/// An empty directory in which the command runs: relative paths in arguments refer to it.
pub(crate) struct Bench {
    directory: TempDir,
    /// Environment variables in addition to those of this process.
    variables: BTreeMap<&'static str, OsString>,
}

impl Bench {
    pub(crate) fn new() -> Self {
        Self { directory: tempdir().unwrap(), variables: BTreeMap::new() }
    }

    /// Sets an environment variable for every command from now on.
    pub(crate) fn set(&mut self, name: &'static str, value: impl Into<OsString>) {
        self.variables.insert(name, value.into());
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.directory.path().join(name)
    }

    /// Writes a file, and creates its parent directories.
    pub(crate) fn write(&self, name: &str, content: impl AsRef<[u8]>) {
        let path = self.path(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, content).unwrap();
    }

    pub(crate) fn read(&self, name: &str) -> String {
        let path = self.path(name);
        fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
    }

    /// Removes the checksums of a directory: changes there are intentional.
    pub(crate) fn unseal(&self, directory: &str) {
        fs::remove_file(self.path(directory).join("SHA256SUMS")).unwrap();
    }

    /// Replaces the single occurrence of `old` in a text file.
    pub(crate) fn edit(&self, name: &str, old: &str, new: &str) {
        let text = self.read(name);
        assert_eq!(text.matches(old).count(), 1, "`{old}` in {name}");
        self.write(name, text.replacen(old, new, 1));
    }

    /// Writes a built-in scenario with a change to a TOML file.
    pub(crate) fn scenario(&self, file: &str, built_in: &str, change: impl FnOnce(&mut toml::Table)) {
        let text = BUILT_IN.iter().find(|scenario| scenario.name == built_in).unwrap().text;
        let mut table = text.parse().unwrap();
        change(&mut table);
        self.write(file, table.to_string());
    }

    /// Runs the command with these words, separated by spaces.
    pub(crate) fn boresight(&self, words: &str) -> Answer {
        self.boresight_words(&words.split_whitespace().collect::<Vec<_>>())
    }

    /// Runs the command with these words.
    pub(crate) fn boresight_words(&self, words: &[&str]) -> Answer {
        let mut command = assert_cmd::cargo::cargo_bin_cmd!("boresight");
        let command = command.args(words).current_dir(self.directory.path()).envs(&self.variables);
        let output = command.timeout(HANGS).output().unwrap();
        Answer {
            words: words.join(" "),
            status: output.status.code(),
            stdout: String::from_utf8(output.stdout).unwrap(),
            stderr: String::from_utf8(output.stderr).unwrap(),
        }
    }

    /// Returns all files of a directory by their relative paths, with their bytes.
    pub(crate) fn tree(&self, name: &str) -> BTreeMap<PathBuf, Vec<u8>> {
        let root = self.path(name);
        let mut files = BTreeMap::new();
        let mut waiting = vec![root.clone()];
        while let Some(directory) = waiting.pop() {
            for entry in fs::read_dir(directory).unwrap() {
                let path = entry.unwrap().path();
                if path.is_dir() {
                    waiting.push(path);
                } else {
                    files.insert(path.strip_prefix(&root).unwrap().to_owned(), fs::read(&path).unwrap());
                }
            }
        }
        files
    }

    /// Checks that two files contain the same bytes.
    pub(crate) fn check_same(&self, a: &str, b: &str) {
        let bytes = |name| fs::read(self.path(name)).unwrap_or_else(|error| panic!("{name}: {error}"));
        // assert_eq is not used, because it would print both files.
        assert!(bytes(a) == bytes(b), "{a} and {b} differ");
    }

    /// Returns the truth about each frame of a run directory.
    pub(crate) fn frames(&self, run: &str) -> Vec<FrameTruth> {
        self.table(&format!("{run}/truth/frames.parquet"))
            .into_iter()
            .map(|row: FrameTruthRow| row.0)
            .collect()
    }

    /// Returns the truth about each field of a docking run directory.
    pub(crate) fn fields(&self, run: &str) -> Vec<FieldTruth> {
        let rows: Vec<FieldTruthRow> = self.table(&format!("{run}/truth/fields.parquet"));
        rows.into_iter().map(FieldTruth::from).collect()
    }

    /// Returns the truth about each object in each frame of a run directory.
    pub(crate) fn objects(&self, run: &str) -> Vec<ObjectTruth> {
        self.table(&format!("{run}/truth/objects.parquet"))
            .into_iter()
            .map(|row: ObjectTruthRow| row.0)
            .collect()
    }

    fn table<R: Row>(&self, name: &str) -> Vec<R> {
        TableReader::open(&self.path(name)).unwrap().flat_map(|frame| frame.unwrap().1).collect()
    }

    /// Returns the rows of a CSV table, each as a map from column names.
    pub(crate) fn csv(&self, name: &str) -> Vec<BTreeMap<String, String>> {
        csv::Reader::from_path(self.path(name)).unwrap().deserialize().map(Result::unwrap).collect()
    }

    pub(crate) fn json(&self, name: &str) -> Value {
        serde_json::from_str(&self.read(name)).unwrap()
    }
}

/// Checks that two directories contain the same files with the same bytes.
pub(crate) fn check_same_files(a: &BTreeMap<PathBuf, Vec<u8>>, b: &BTreeMap<PathBuf, Vec<u8>>) {
    assert_eq!(a.keys().collect::<Vec<_>>(), b.keys().collect::<Vec<_>>());
    let differing: Vec<&Path> = a.keys().filter(|name| a[*name] != b[*name]).map(PathBuf::as_path).collect();
    assert!(differing.is_empty(), "{differing:?} differ");
}

/// Output and exit status of the command.
pub(crate) struct Answer {
    words: String,
    pub(crate) status: Option<i32>,
    pub(crate) stdout: String,
    pub(crate) stderr: String,
}

impl Answer {
    /// Asserts that the command succeeded.
    pub(crate) fn done(self) -> Self {
        assert_eq!(self.status, Some(0), "boresight {}\n{}", self.words, self.stderr);
        self
    }

    /// Asserts that the command rejected invalid input with a message that contains these parts.
    pub(crate) fn refused(self, parts: &[&str]) -> Self {
        assert_eq!(self.status, Some(2), "boresight {}\n{}", self.words, self.stderr);
        assert!(!self.stderr.contains("panicked"), "{}", self.stderr);
        // Long messages are wrapped.
        let message = self.stderr.replace("\n  | ", " ");
        for part in parts {
            assert!(message.contains(part), "boresight {}: `{part}` in\n{}", self.words, self.stderr);
        }
        self
    }

    /// Asserts that `scenario check` found a mistake, with a message that contains these parts.
    pub(crate) fn found(self, parts: &[&str]) -> Self {
        assert_eq!(self.status, Some(1), "{}", self.stderr);
        let message = self.stdout.replace("\n  | ", " ");
        for part in parts {
            assert!(message.contains(part), "`{part}` in\n{message}");
        }
        self
    }

    /// Returns the JSON document on stdout; fails if stdout contains anything else.
    pub(crate) fn json(&self) -> Value {
        let document = serde_json::from_str(&self.stdout);
        document.unwrap_or_else(|error| panic!("boresight {}: {error} in\n{}", self.words, self.stdout))
    }
}

/// Returns the value of a figure of a score.
pub(crate) fn figure(score: &Value, name: &str) -> f64 {
    score["figures"][name]["value"].as_f64().unwrap_or_else(|| panic!("{name} in {score}"))
}
