//! Times at which a process is killed, drawn from a seed.

use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// SplitMix64 (Steele, Lea and Flood 2014): the same times in every run of a test.
pub(crate) struct Dice(u64);

impl Dice {
    pub(crate) fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// Draws an integer below `end`.
    pub(crate) fn below(&mut self, end: u64) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        (z ^ (z >> 31)) % end
    }
}

/// A point in the execution of a process.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum KillTime {
    /// This time after its start.
    After(Duration),
    /// Immediately after it has begun its n-th file, from 0, which still has a temporary name.
    Writing(u64),
}

impl KillTime {
    /// Draws, with equal probability, a time within the duration `life`, or one of `files` files.
    pub(crate) fn draw(dice: &mut Dice, life: Duration, files: u64) -> Self {
        if dice.below(2) == 0 {
            Self::After(Duration::from_micros(dice.below(life.as_micros() as u64)))
        } else {
            Self::Writing(dice.below(files))
        }
    }
}

/// End of a process that was to be killed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum ProcessEnd {
    Killed,
    /// The process ended before its time to be killed.
    Done,
}

/// Starts a process and kills it (SIGKILL) at a given point, unless it has ended by then; `folders` are the
/// directories in which it creates files.
pub(crate) fn kill_at(mut command: Command, kill_time: KillTime, folders: &[PathBuf]) -> ProcessEnd {
    let mut child = command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
    let is_done = match kill_time {
        KillTime::After(wait) => wait_or_done(&mut child, wait),
        KillTime::Writing(count) => watch_or_done(&mut child, count, folders),
    };
    if is_done {
        let status = child.wait().unwrap();
        assert!(status.success(), "it was not killed and failed: {status}");
        return ProcessEnd::Done;
    }
    child.kill().unwrap();
    let status = child.wait().unwrap();
    // The process may have ended between the check and the kill.
    if std::os::unix::process::ExitStatusExt::signal(&status) == Some(9) {
        ProcessEnd::Killed
    } else {
        ProcessEnd::Done
    }
}

fn wait_or_done(child: &mut Child, wait: Duration) -> bool {
    let begun = Instant::now();
    while begun.elapsed() < wait {
        if child.try_wait().unwrap().is_some() {
            return true;
        }
        std::thread::sleep(Duration::from_micros(200).min(wait.saturating_sub(begun.elapsed())));
    }
    false
}

fn watch_or_done(child: &mut Child, count: u64, folders: &[PathBuf]) -> bool {
    let mut seen: Vec<PathBuf> = folders.iter().flat_map(|folder| partial_files(folder)).collect();
    let before = seen.len() as u64;
    loop {
        for path in folders.iter().flat_map(|folder| partial_files(folder)) {
            if !seen.contains(&path) {
                seen.push(path);
            }
        }
        if seen.len() as u64 > before + count {
            return false;
        }
        if child.try_wait().unwrap().is_some() {
            return true;
        }
        std::thread::yield_now();
    }
}

/// Returns the files of a directory that are being written or were left unfinished.
pub(crate) fn partial_files(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let is_partial =
        |path: &PathBuf| path.file_name().is_some_and(|name| name.to_string_lossy().starts_with(".partial-"));
    entries.map(|entry| entry.path()).filter(is_partial).collect()
}
