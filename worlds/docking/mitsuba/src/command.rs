//! Search for Mitsuba, and check of its version.
use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Duration;

use files::FileError;

use super::process::{self, ProcessEnd};
use super::{MitsubaError, VARIANT, VERSION};

/// Environment variable that names the command of Mitsuba.
const VARIABLE: &str = "BORESIGHT_MITSUBA";

/// A command line that starts Mitsuba.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct MitsubaCommand {
    words: Vec<String>,
}

impl MitsubaCommand {
    /// Finds the command: `asked_for`; otherwise that of `BORESIGHT_MITSUBA`; otherwise `mitsuba` on the
    /// PATH; otherwise `uvx`, which downloads the right version.
    ///
    /// # Errors
    /// [`MitsubaError::NoCommand`] for a text that is not a command, [`MitsubaError::Missing`] when none of
    /// these exists.
    pub(super) fn find(asked_for: Option<&str>) -> Result<Self, MitsubaError> {
        let variable = std::env::var(VARIABLE).ok();
        Self::choose(asked_for, variable.as_deref(), std::env::var_os("PATH").as_deref())
    }

    fn choose(
        asked_for: Option<&str>,
        variable: Option<&str>,
        path: Option<&OsStr>,
    ) -> Result<Self, MitsubaError> {
        let named = asked_for.map(|text| ("--mitsuba", text)).or(variable.map(|text| (VARIABLE, text)));
        if let Some((origin, text)) = named {
            return match shlex::split(text) {
                Some(words) if !words.is_empty() => Ok(Self { words }),
                _ => Err(MitsubaError::NoCommand { origin, text: text.to_owned() }),
            };
        }
        if on_path(path, "mitsuba") {
            return Ok(Self { words: vec!["mitsuba".to_owned()] });
        }
        if on_path(path, "uvx") {
            let package = format!("mitsuba=={VERSION}");
            return Ok(Self { words: ["uvx", "--from", &package, "mitsuba"].map(str::to_owned).to_vec() });
        }
        Err(MitsubaError::Missing)
    }

    /// Returns the command line as one string.
    pub(super) fn text(&self) -> String {
        self.words.join(" ")
    }

    /// Returns the command with `folder` as working directory, without further arguments.
    pub(super) fn in_folder(&self, folder: &Path) -> Command {
        let mut words = self.words.iter();
        let mut command = Command::new(words.next().map_or("", String::as_str));
        command.args(words).current_dir(folder);
        command
    }

    /// Runs Mitsuba with `arguments` in `folder`; returns how the process ended and the log file with its
    /// output.
    pub(super) fn run(
        &self,
        arguments: &[&str],
        folder: &Path,
        limit: Duration,
    ) -> Result<(ProcessEnd, std::fs::File), MitsubaError> {
        let path = folder.join("log.txt");
        let log = std::fs::File::options()
            .read(true)
            .append(true)
            .create(true)
            .open(&path)
            .map_err(|source| FileError::Io { path, doing: "create", source })?;
        let end = process::run(self.in_folder(folder).args(arguments), &log, limit)
            .map_err(|source| MitsubaError::Start { command: self.text(), source })?;
        Ok((end, log))
    }

    /// Queries the version and the variants of Mitsuba.
    ///
    /// # Errors
    /// [`MitsubaError::WrongVersion`], [`MitsubaError::VariantMissing`], and the errors of starting the
    /// command.
    pub(super) fn check(&self, folder: &Path, limit: Duration) -> Result<(), MitsubaError> {
        let (end, log) = self.run(&["--help"], folder, limit)?;
        if let ProcessEnd::TimeLimit = end {
            return Err(MitsubaError::TimeLimit {
                limit_s: limit.as_secs_f64(),
                doing: "reporting its version".to_owned(),
                words: process::last_output(&log),
            });
        }
        let text = process::written(&log, 1 << 16).unwrap_or_default();
        match text.split_once("Mitsuba version ").and_then(|(_, rest)| rest.split_whitespace().next()) {
            Some(VERSION) if text.split_whitespace().any(|word| word == VARIANT) => Ok(()),
            Some(VERSION) => Err(MitsubaError::VariantMissing { command: self.text() }),
            Some(other) => {
                let found = format!("Mitsuba {other}");
                Err(MitsubaError::WrongVersion { command: self.text(), found })
            }
            None => {
                let found = format!("not Mitsuba (output: {})", process::last_output(&log));
                Err(MitsubaError::WrongVersion { command: self.text(), found })
            }
        }
    }
}

fn on_path(path: Option<&OsStr>, program: &str) -> bool {
    let file = format!("{program}{}", std::env::consts::EXE_SUFFIX);
    path.is_some_and(|path| std::env::split_paths(path).any(|folder: PathBuf| folder.join(&file).is_file()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn words(found: Result<MitsubaCommand, MitsubaError>) -> String {
        found.unwrap().text()
    }

    #[test]
    fn the_option_comes_before_the_environment_and_that_before_the_path() {
        let folder = tempfile::tempdir().unwrap();
        let path = Some(folder.path().as_os_str());
        let uvx = format!("uvx{}", std::env::consts::EXE_SUFFIX);
        let mitsuba = format!("mitsuba{}", std::env::consts::EXE_SUFFIX);
        let none = MitsubaCommand::choose(None, None, path).unwrap_err().to_string();
        assert!(none.contains("pip install mitsuba==3.9.1"), "{none}");
        std::fs::write(folder.path().join(uvx), "").unwrap();
        assert_eq!(words(MitsubaCommand::choose(None, None, path)), "uvx --from mitsuba==3.9.1 mitsuba");
        std::fs::write(folder.path().join(mitsuba), "").unwrap();
        assert_eq!(words(MitsubaCommand::choose(None, None, path)), "mitsuba");
        assert_eq!(words(MitsubaCommand::choose(None, Some("a 'b c'"), path)), "a b c");
        assert_eq!(words(MitsubaCommand::choose(Some("x"), Some("a"), path)), "x");
    }

    #[test]
    fn a_text_that_is_no_command_is_refused_with_its_origin() {
        let error = MitsubaCommand::choose(None, Some(" "), None).unwrap_err().to_string();
        assert!(error.contains("BORESIGHT_MITSUBA is ` `"), "{error}");
        let error = MitsubaCommand::choose(Some("a 'b"), None, None).unwrap_err().to_string();
        assert!(error.contains("--mitsuba is `a 'b`"), "{error}");
    }
}
