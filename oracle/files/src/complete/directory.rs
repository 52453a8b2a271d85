//! The directory that a run writes.

use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use crate::{AtomicFile, Checksums, Failure, FileError, ImageFormat};

/// The files of a run that have checksums.
const SEALED: [&str; 13] = [
    "run.toml",
    "camera.toml",
    "setup.toml",
    "stars.csv",
    "telemetry.csv",
    "truth/frames.parquet",
    "truth/objects.parquet",
    "truth/fields.parquet",
    "measurements.csv",
    "clusters.parquet",
    "motion.csv",
    "features.parquet",
    "score.json",
];

/// The file that a run directory has until it is complete.
const UNFINISHED: &str = "UNFINISHED.txt";
const UNFINISHED_TEXT: &str = "\
The run in this directory has not ended: it was interrupted or killed, it failed, or it still goes on.
Tables appear when they are complete, telemetry.csv after the truth, score.json last; images are complete up to the last one.
Nothing here passes for a result, and the run is not continued: remove the directory, and run it again.
";

/// A fresh directory for the output of a run, and the names of the files in it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RunDirectory {
    path: PathBuf,
}

impl RunDirectory {
    /// Makes the directory, with its parents; one that is there and empty is taken as it is.
    ///
    /// # Errors
    /// [`FileError::OutputTaken`] when something is there that is not an empty directory; [`FileError::Io`] when
    /// it cannot be made or written to.
    pub fn create(path: &Path) -> Result<Self, FileError> {
        let taken = |reason| FileError::OutputTaken { path: path.to_owned(), reason };
        if path.as_os_str().is_empty() {
            return Err(taken("an empty name is no directory"));
        }
        match fs::read_dir(path) {
            Ok(mut entries) => {
                if entries.next().is_some() {
                    return Err(taken(if is_unfinished(path) {
                        "holds a run that was killed, failed, or still goes on; nothing is overwritten"
                    } else {
                        "exists and is not empty; nothing is overwritten"
                    }));
                }
            }
            Err(error) if error.kind() == ErrorKind::NotFound => {
                fs::create_dir_all(path).map_err(|source| match source.kind() {
                    ErrorKind::AlreadyExists => taken("exists and is not a directory"),
                    _ => FileError::io(path, "create", source),
                })?;
            }
            // Otherwise something above it is no directory.
            Err(error) if error.kind() == ErrorKind::NotADirectory && path.symlink_metadata().is_ok() => {
                return Err(taken("exists and is not a directory"));
            }
            Err(source) => return Err(FileError::io(path, "create", source)),
        }
        Self::checked(path.to_owned())
    }

    /// Makes `PARENT/NAME-001`, or the next number that is free. Two runs that start together get two numbers.
    ///
    /// # Errors
    /// [`FileError::Io`] when it cannot be made or written to.
    pub fn create_numbered(parent: &Path, name: &str) -> Result<Self, FileError> {
        fs::create_dir_all(parent).map_err(|source| FileError::io(parent, "create", source))?;
        let mut number = last_number(parent, name)?;
        loop {
            number = number.saturating_add(1);
            let path = parent.join(format!("{name}-{number:03}"));
            match fs::create_dir(&path) {
                Ok(()) => return Self::checked(path),
                Err(error) if error.kind() == ErrorKind::AlreadyExists && number < u32::MAX => {}
                Err(source) => return Err(FileError::io(&path, "create", source)),
            }
        }
    }

    /// Makes the inner directories, which also proves that the place can be written to before hours of work.
    fn checked(path: PathBuf) -> Result<Self, FileError> {
        for inner in [path.join("truth"), path.join("frames")] {
            fs::create_dir(&inner).map_err(|source| match source.kind() {
                // It was empty a moment ago.
                ErrorKind::AlreadyExists => FileError::OutputTaken {
                    path: path.clone(),
                    reason: "is being written by another run; nothing is overwritten",
                },
                _ => FileError::io(&inner, "create", source),
            })?;
        }
        AtomicFile::with_text(&path.join(UNFINISHED), UNFINISHED_TEXT)?.commit_new()?;
        Ok(Self { path })
    }

    /// Writes the checksums of everything in it, images and report apart, and says no longer that it is unfinished.
    ///
    /// # Errors
    /// [`FileError::Io`] when a file cannot be read, or the checksums not be written.
    pub fn seal(&self) -> Result<(), FileError> {
        Checksums::write(&self.path, &SEALED)?;
        let path = self.path.join(UNFINISHED);
        fs::remove_file(&path).map_err(|source| FileError::io(&path, "remove", source))
    }

    /// The directory itself.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// `run.toml`: the resolved scenario, seed, version, catalogue hash.
    pub fn run(&self) -> PathBuf {
        self.path.join("run.toml")
    }

    /// `camera.toml`: see [`crate::CameraFile`].
    pub fn camera(&self) -> PathBuf {
        self.path.join("camera.toml")
    }

    /// `stars.csv`: see [`crate::StarRow`].
    pub fn stars(&self) -> PathBuf {
        self.path.join("stars.csv")
    }

    /// `telemetry.csv`: see [`crate::TelemetryRow`].
    pub fn telemetry(&self) -> PathBuf {
        self.path.join("telemetry.csv")
    }

    /// `truth/frames.parquet`: rows of [`sim::truth::FrameTruth`].
    pub fn truth_frames(&self) -> PathBuf {
        self.path.join("truth/frames.parquet")
    }

    /// `truth/objects.parquet`: rows of [`sim::truth::ObjectTruth`].
    pub fn truth_objects(&self) -> PathBuf {
        self.path.join("truth/objects.parquet")
    }

    /// Makes the folder of the noise-free expectations.
    ///
    /// # Errors
    /// [`FileError::Io`] when it cannot be made.
    pub fn create_expected(&self) -> Result<(), FileError> {
        let folder = self.path.join("truth/expected");
        fs::create_dir(&folder).map_err(|source| FileError::io(&folder, "create", source))
    }

    /// The noise-free expectation of a frame, electrons.
    pub fn expected(&self, frame: u64) -> PathBuf {
        self.path.join(format!("truth/expected/{frame:06}.exr"))
    }

    /// `measurements.csv`: a pipeline's answers.
    pub fn measurements(&self) -> PathBuf {
        self.path.join("measurements.csv")
    }

    /// `clusters.parquet`: rows of [`crate::FrameCluster`].
    pub fn clusters(&self) -> PathBuf {
        self.path.join("clusters.parquet")
    }

    /// `setup.toml` of a docking run: see [`crate::docking::SetupFile`].
    pub fn setup(&self) -> PathBuf {
        self.path.join("setup.toml")
    }

    /// `truth/fields.parquet` of a docking run: rows of [`sim::docking::FieldTruth`].
    pub fn truth_fields(&self) -> PathBuf {
        self.path.join("truth/fields.parquet")
    }

    /// `motion.csv` of a docking run: what is said at the end of each portion.
    pub fn motion(&self) -> PathBuf {
        self.path.join("motion.csv")
    }

    /// `features.parquet` of a docking run: rows of [`crate::docking::FeatureRow`].
    pub fn features(&self) -> PathBuf {
        self.path.join("features.parquet")
    }

    /// `score.json`.
    pub fn score(&self) -> PathBuf {
        self.path.join("score.json")
    }

    /// `report.html`.
    pub fn report(&self) -> PathBuf {
        self.path.join("report.html")
    }

    /// The image of a frame, relative to the directory, as `telemetry.csv` names it: `frames/000123.fits`.
    pub fn frame_name(frame: u64, format: ImageFormat) -> String {
        format!("frames/{frame:06}.{format}")
    }

    /// The image of a frame.
    pub fn frame(&self, frame: u64, format: ImageFormat) -> PathBuf {
        self.path.join(Self::frame_name(frame, format))
    }
}

/// Whether a directory holds the beginning of a run: its tables get their names when they are complete, that of the telemetry last.
fn is_unfinished(path: &Path) -> bool {
    path.join(UNFINISHED).is_file()
}

/// Refuses a directory that holds the beginning of a run.
///
/// # Errors
/// [`Failure::Usage`] with what to do.
pub fn refuse_unfinished(path: &Path) -> Result<(), Failure> {
    if !is_unfinished(path) {
        return Ok(());
    }
    Err(Failure::Usage(format!(
        "{}: holds a run that was killed, failed, or still goes on ({UNFINISHED} is there), expected a finished one: remove it when \
         nothing runs, and run its command again",
        path.display()
    )))
}

/// The largest number that `NAME-…` has in the parent; 0 when there is none.
fn last_number(parent: &Path, name: &str) -> Result<u32, FileError> {
    let error = |source| FileError::io(parent, "open", source);
    let mut last = 0;
    for entry in fs::read_dir(parent).map_err(error)? {
        let file_name = entry.map_err(error)?.file_name();
        let number = file_name
            .to_str()
            .and_then(|text| text.strip_prefix(name)?.strip_prefix('-')?.parse::<u32>().ok());
        last = last.max(number.unwrap_or(0));
    }
    Ok(last)
}

#[cfg(test)]
mod tests {
    use tempfile::tempdir;

    use super::*;

    #[test]
    fn numbers_go_up_and_are_never_used_again() {
        let parent = tempdir().unwrap();
        let runs = parent.path().join("runs");
        let name = |run: &RunDirectory| run.path().file_name().unwrap().to_str().unwrap().to_owned();
        let create = |scenario| name(&RunDirectory::create_numbered(&runs, scenario).unwrap());
        assert_eq!(create("argon"), "argon-001");
        assert_eq!(create("argon"), "argon-002");
        assert_eq!(create("docking"), "docking-001");
        fs::remove_dir_all(runs.join("argon-001")).unwrap();
        fs::create_dir(runs.join("argon-0999")).unwrap();
        fs::create_dir(runs.join("argon-old")).unwrap();
        assert_eq!(create("argon"), "argon-1000");
    }

    #[test]
    fn a_directory_that_is_in_use_is_refused_and_left_alone() {
        let parent = tempdir().unwrap();
        let path = parent.path().join("a/b");
        RunDirectory::create(&path).unwrap();
        fs::write(path.join("run.toml"), "mine").unwrap();
        let message = RunDirectory::create(&path).unwrap_err().to_string();
        assert!(message.contains("holds a run that was killed") && message.contains("--out"), "{message}");
        assert_eq!(fs::read_to_string(path.join("run.toml")).unwrap(), "mine");
        for (inside, reason) in
            [("run.toml", "exists and is not a directory"), ("run.toml/below", "cannot create")]
        {
            let message = RunDirectory::create(&path.join(inside)).unwrap_err().to_string();
            assert!(message.contains(inside) && message.contains(reason), "{message}");
        }
        let empty = tempdir().unwrap();
        assert!(RunDirectory::create(empty.path()).is_ok());
    }

    /// Both found it empty; only one can make what is in it.
    #[test]
    fn of_two_runs_that_find_a_directory_empty_one_is_refused() {
        let path = tempdir().unwrap();
        RunDirectory::checked(path.path().to_owned()).unwrap();
        let message = RunDirectory::checked(path.path().to_owned()).unwrap_err().to_string();
        assert!(
            message.contains("is being written by another run") && message.contains("--out"),
            "{message}"
        );
    }

    #[test]
    fn a_path_that_cannot_be_written_is_an_error() {
        assert!(RunDirectory::create(Path::new("/proc/boresight/run")).is_err());
        assert!(RunDirectory::create_numbered(Path::new("/proc/boresight"), "argon").is_err());
    }
}
