//! Output directory of a run.

use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use crate::{AtomicFile, Checksums, Failure, FileError, ImageFormat};

/// Files of a run that have checksums.
const SEALED: [&str; 15] = [
    "run.toml",
    "camera.toml",
    "setup.toml",
    "stars.csv",
    "telemetry.csv",
    "truth/frames.parquet",
    "truth/objects.parquet",
    "truth/manoeuvres.csv",
    "truth/fields.parquet",
    "truth/states.jsonl",
    "measurements.csv",
    "clusters.parquet",
    "motion.csv",
    "features.parquet",
    "score.json",
];

/// File that marks a run directory as incomplete.
const UNFINISHED: &str = "UNFINISHED.txt";
const UNFINISHED_TEXT: &str = "\
The run in this directory is incomplete: it is in progress, was interrupted or killed, or failed.
Tables appear when they are complete: telemetry.csv after the truth, score.json last. Images are complete \
up to the last one.
No file here is a result, and the run cannot be continued: remove the directory and start the run again.
";

/// A fresh output directory for a run, with the names of its files.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RunDirectory {
    path: PathBuf,
}

impl RunDirectory {
    /// Creates the directory with its parents; an existing empty directory is used unchanged.
    ///
    /// # Errors
    /// [`FileError::OutputTaken`] if the path exists and is not an empty directory; [`FileError::Io`] if the
    /// directory cannot be created or written to.
    pub fn create(path: &Path) -> Result<Self, FileError> {
        create_empty_directory(path)?;
        Self::checked(path.to_owned())
    }

    /// Creates `PARENT/NAME-001`, or the next free number. Two runs started at the same time get two numbers.
    ///
    /// # Errors
    /// [`FileError::Io`] if the directory cannot be created or written to.
    pub fn create_numbered(parent: &Path, name: &str) -> Result<Self, FileError> {
        Self::checked(create_numbered_directory(parent, name)?)
    }

    /// Creates the inner directories, which also verifies before hours of work that the location is writable.
    fn checked(path: PathBuf) -> Result<Self, FileError> {
        for inner in [path.join("truth"), path.join("frames")] {
            fs::create_dir(&inner).map_err(|source| match source.kind() {
                // The directory was empty when it was checked, so another run has just created this entry.
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

    /// Writes the checksums of all files except images and report, and removes the marker of an unfinished
    /// run.
    ///
    /// # Errors
    /// [`FileError::Io`] if a file cannot be read or the checksums cannot be written.
    pub fn seal(&self) -> Result<(), FileError> {
        self.seal_with(&[])
    }

    /// Seals the directory as [`RunDirectory::seal`], with the checksums of further files, given by their
    /// paths relative to the directory.
    ///
    /// # Errors
    /// Those of [`RunDirectory::seal`].
    pub fn seal_with(&self, more: &[String]) -> Result<(), FileError> {
        let names: Vec<&str> = SEALED.into_iter().chain(more.iter().map(String::as_str)).collect();
        Checksums::write(&self.path, &names)?;
        let path = self.path.join(UNFINISHED);
        fs::remove_file(&path).map_err(|source| FileError::io(&path, "remove", source))
    }

    /// Returns the path of the directory.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Path of `run.toml`: the resolved scenario, seed, version, catalogue hash.
    pub fn run(&self) -> PathBuf {
        self.path.join("run.toml")
    }

    /// Path of `camera.toml`: the camera of the dataset.
    pub fn camera(&self) -> PathBuf {
        self.path.join("camera.toml")
    }

    /// Path of `stars.csv`: the list of stars.
    pub fn stars(&self) -> PathBuf {
        self.path.join("stars.csv")
    }

    /// Path of `telemetry.csv`: the telemetry of each image.
    pub fn telemetry(&self) -> PathBuf {
        self.path.join("telemetry.csv")
    }

    /// Path of `truth/frames.parquet`: rows of [`sim::truth::FrameTruth`].
    pub fn truth_frames(&self) -> PathBuf {
        self.path.join("truth/frames.parquet")
    }

    /// Path of `truth/objects.parquet`: rows of [`sim::truth::ObjectTruth`].
    pub fn truth_objects(&self) -> PathBuf {
        self.path.join("truth/objects.parquet")
    }

    /// Path of `truth/manoeuvres.csv`, which exists if the chaser has manoeuvres.
    pub fn truth_manoeuvres(&self) -> PathBuf {
        self.path.join("truth/manoeuvres.csv")
    }

    /// Creates the directory of the noise-free expectations.
    ///
    /// # Errors
    /// [`FileError::Io`] if it cannot be created.
    pub fn create_expected(&self) -> Result<(), FileError> {
        let folder = self.path.join("truth/expected");
        fs::create_dir(&folder).map_err(|source| FileError::io(&folder, "create", source))
    }

    /// Path of `truth/labels/`: labels of the images for machine learning.
    pub fn truth_labels(&self) -> PathBuf {
        self.path.join("truth/labels")
    }

    /// Path of the noise-free expectation of a frame, electrons.
    pub fn expected(&self, frame: u64) -> PathBuf {
        self.path.join(format!("truth/expected/{frame:06}.exr"))
    }

    /// Path of `measurements.csv`: the outcomes of a pipeline.
    pub fn measurements(&self) -> PathBuf {
        self.path.join("measurements.csv")
    }

    /// Path of `clusters.parquet`: clusters of each frame.
    pub fn clusters(&self) -> PathBuf {
        self.path.join("clusters.parquet")
    }

    /// Path of `setup.toml`: the data that a pipeline receives before the first field.
    pub fn setup(&self) -> PathBuf {
        self.path.join("setup.toml")
    }

    /// Path of `truth/fields.parquet`: the truth of each field.
    pub fn truth_fields(&self) -> PathBuf {
        self.path.join("truth/fields.parquet")
    }

    /// Path of `motion.csv`: the motion reported at the end of each portion.
    pub fn motion(&self) -> PathBuf {
        self.path.join("motion.csv")
    }

    /// Path of `features.parquet`: features of each field.
    pub fn features(&self) -> PathBuf {
        self.path.join("features.parquet")
    }

    /// Path of `score.json`.
    pub fn score(&self) -> PathBuf {
        self.path.join("score.json")
    }

    /// Path of `report.html`.
    pub fn report(&self) -> PathBuf {
        self.path.join("report.html")
    }

    /// Path of the image of a frame relative to the directory, as written in `telemetry.csv`:
    /// `frames/000123.fits`.
    pub fn frame_name(frame: u64, format: ImageFormat) -> String {
        format!("frames/{frame:06}.{format}")
    }

    /// Path of the image of a frame.
    pub fn frame(&self, frame: u64, format: ImageFormat) -> PathBuf {
        self.path.join(Self::frame_name(frame, format))
    }
}

/// Creates a directory of results with its parents; an existing empty directory is used unchanged.
///
/// # Errors
/// [`FileError::OutputTaken`] if the path exists and is not an empty directory; [`FileError::Io`] if the
/// directory cannot be created.
pub fn create_empty_directory(path: &Path) -> Result<(), FileError> {
    let taken = |reason| FileError::OutputTaken { path: path.to_owned(), reason };
    if path.as_os_str().is_empty() {
        return Err(taken("is an empty name, which is not a directory"));
    }
    match fs::read_dir(path) {
        Ok(mut entries) => match entries.next() {
            None => Ok(()),
            Some(_) if is_unfinished(path) => Err(taken(
                "contains an incomplete run (in progress, killed or failed); nothing is overwritten",
            )),
            Some(_) => Err(taken("exists and is not empty; nothing is overwritten")),
        },
        Err(error) if error.kind() == ErrorKind::NotFound => {
            fs::create_dir_all(path).map_err(|source| match source.kind() {
                ErrorKind::AlreadyExists => taken("exists and is not a directory"),
                _ => FileError::io(path, "create", source),
            })
        }
        // Otherwise, a parent of the path is not a directory.
        Err(error) if error.kind() == ErrorKind::NotADirectory && path.symlink_metadata().is_ok() => {
            Err(taken("exists and is not a directory"))
        }
        Err(source) => Err(FileError::io(path, "create", source)),
    }
}

/// Creates the directory `PARENT/NAME-001`, or the next free number, and returns its path.
///
/// # Errors
/// [`FileError::Io`] if the directory cannot be created.
pub fn create_numbered_directory(parent: &Path, name: &str) -> Result<PathBuf, FileError> {
    fs::create_dir_all(parent).map_err(|source| FileError::io(parent, "create", source))?;
    let mut number = last_number(parent, name)?;
    loop {
        number = number.saturating_add(1);
        let path = parent.join(format!("{name}-{number:03}"));
        match fs::create_dir(&path) {
            Ok(()) => return Ok(path),
            Err(error) if error.kind() == ErrorKind::AlreadyExists && number < u32::MAX => {}
            Err(source) => return Err(FileError::io(&path, "create", source)),
        }
    }
}

/// Returns true if a directory holds an incomplete run, which is marked by the file [`UNFINISHED`].
fn is_unfinished(path: &Path) -> bool {
    path.join(UNFINISHED).is_file()
}

/// Rejects a directory that holds an incomplete run.
///
/// # Errors
/// [`Failure::Usage`] with instructions.
pub fn refuse_unfinished(path: &Path) -> Result<(), Failure> {
    if !is_unfinished(path) {
        return Ok(());
    }
    Err(Failure::Usage(format!(
        "{}: contains an incomplete run (in progress, killed or failed: {UNFINISHED} exists), expected a \
         complete run: if it is not in progress, remove the directory and repeat the command of the run",
        path.display()
    )))
}

/// Returns the largest number of `NAME-…` in the parent directory; 0 if there is none.
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
        assert!(message.contains("contains an incomplete run") && message.contains("--out"), "{message}");
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

    /// Both runs found the directory empty; only one can create its contents.
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
