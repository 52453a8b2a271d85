//! Log of the state that outcomes change: with it, any frame of a run can be made again alone.

use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

use files::{AtomicFile, Failure, FileError, FileLocation, open_regular};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

/// Name of the log in the directory of a run. It is part of the truth: a flown trajectory is in its states.
pub const STATES_FILE: &str = "truth/states.jsonl";

/// Line of the log: the state from a frame on.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Change<S> {
    frame: u64,
    state: S,
}

/// Writer of the log. Without a change from the default state there is no file.
pub(crate) struct StateLogWriter<S> {
    path: PathBuf,
    out: Option<(AtomicFile, BufWriter<File>)>,
    last: S,
}

impl<S: Clone + Default + PartialEq + Serialize> StateLogWriter<S> {
    /// Creates the log of a run before its first frame.
    pub(crate) fn new(directory: &Path) -> Self {
        Self { path: directory.join(STATES_FILE), out: None, last: S::default() }
    }

    /// Writes the state from a frame on, if it is another one.
    ///
    /// # Errors
    /// A [`Failure`] when the file cannot be written, or for a state that JSON cannot express.
    pub(crate) fn note(&mut self, frame: u64, state: &S) -> Result<(), Failure> {
        if *state == self.last {
            return Ok(());
        }
        self.last = state.clone();
        let line = serde_json::to_string(&Change { frame, state })
            .map_err(|error| FileError::format(&self.path, "JSON", error))?;
        let (_, out) = match &mut self.out {
            Some(out) => out,
            None => {
                let file = AtomicFile::create_new(&self.path)?;
                let copy =
                    file.file().try_clone().map_err(|error| FileError::io(&self.path, "create", error))?;
                self.out.insert((file, BufWriter::new(copy)))
            }
        };
        writeln!(out, "{line}").map_err(|error| FileError::io(&self.path, "write", error))?;
        Ok(())
    }

    /// Completes the file.
    ///
    /// # Errors
    /// [`FileError::Io`].
    pub(crate) fn finish(self) -> Result<(), FileError> {
        let Some((file, mut out)) = self.out else { return Ok(()) };
        out.flush().map_err(|error| FileError::io(&self.path, "write", error))?;
        drop(out);
        file.commit_new()
    }
}

/// States of a run, by the frame from which each applies; ascending.
#[derive(Debug, Default)]
pub(crate) struct StateLog<S>(Vec<Change<S>>);

impl<S: Clone + Default + DeserializeOwned> StateLog<S> {
    /// Reads the log of a run; a run without a log has the default state.
    ///
    /// # Errors
    /// [`FileError`] with the line of the first mistake.
    pub(crate) fn read(directory: &Path) -> Result<Self, FileError> {
        let path = directory.join(STATES_FILE);
        if !path.exists() {
            return Ok(Self(Vec::new()));
        }
        let text = std::io::read_to_string(open_regular(&path)?)
            .map_err(|error| FileError::io(&path, "read", error))?;
        let mut changes: Vec<Change<S>> = Vec::new();
        for (line, content) in (1..).zip(text.lines()) {
            let refused = |key: &str, value: String, expected: &str| {
                FileError::value(&path, FileLocation::Line(line), key, value, expected)
            };
            let change: Change<S> = serde_json::from_str(content)
                .map_err(|error| refused("state", error.to_string(), "a state as the run wrote it"))?;
            if changes.last().is_some_and(|last| change.frame <= last.frame) {
                return Err(refused("frame", change.frame.to_string(), "more than in the line before"));
            }
            changes.push(change);
        }
        Ok(Self(changes))
    }

    /// Returns the state at a frame.
    pub(crate) fn at(&self, frame: u64) -> S {
        let after = self.0.partition_point(|change| change.frame <= frame);
        after
            .checked_sub(1)
            .and_then(|index| self.0.get(index))
            .map_or_else(S::default, |change| change.state.clone())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn folder() -> tempfile::TempDir {
        let folder = tempfile::tempdir().unwrap();
        std::fs::create_dir(folder.path().join("truth")).unwrap();
        folder
    }

    #[test]
    fn every_frame_has_the_state_that_it_had() {
        let folder = folder();
        let states = [0.0, 0.0, 0.1, 0.1, 1e-320, 0.0, f64::MAX];
        let mut writer = StateLogWriter::new(folder.path());
        for (frame, state) in (100..).zip(&states) {
            writer.note(frame, state).unwrap();
        }
        writer.finish().unwrap();
        let log = StateLog::<f64>::read(folder.path()).unwrap();
        let read: Vec<f64> = (100..107).map(|frame| log.at(frame)).collect();
        assert_eq!((read.as_slice(), log.at(0), log.at(9999)), (states.as_slice(), 0.0, f64::MAX));
    }

    #[test]
    fn a_run_that_never_leaves_the_default_has_no_file() {
        let folder = folder();
        let mut writer = StateLogWriter::new(folder.path());
        writer.note(3, &0.0).unwrap();
        writer.finish().unwrap();
        assert!(!folder.path().join(STATES_FILE).exists());
        assert_eq!(StateLog::<f64>::read(folder.path()).unwrap().at(3), 0.0);
    }

    #[test]
    fn a_mistake_is_named_with_its_line() {
        let folder = folder();
        let refused = |text: &str| {
            std::fs::write(folder.path().join(STATES_FILE), text).unwrap();
            StateLog::<f64>::read(folder.path()).unwrap_err().to_string()
        };
        let twice = refused("{\"frame\":3,\"state\":1.5}\n{\"frame\":3,\"state\":2.5}\n");
        assert!(twice.contains("line 2") && twice.contains("`frame` is `3`"), "{twice}");
        let word = refused("{\"frame\":3,\"state\":\"a\"}\n");
        assert!(word.contains("line 1") && word.contains("state"), "{word}");
    }
}
