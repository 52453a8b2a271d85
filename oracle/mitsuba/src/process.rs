//! A program that runs to its end within a time limit, with all that it starts.

use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};

/// How a program ended.
pub(super) enum ProcessEnd {
    /// By itself, with this status.
    Exited(ExitStatus),
    /// It did not, and was killed.
    TimeLimit,
}

/// Pause between two looks at whether it has ended: nothing beside the seconds that it runs.
const POLL: Duration = Duration::from_millis(10);

/// Runs a command; both its outputs go to `log`.
///
/// # Errors
/// That of the operating system, when it cannot be started.
pub(super) fn run(command: &mut Command, log: &File, limit: Duration) -> io::Result<ProcessEnd> {
    command.stdin(Stdio::null()).stdout(log.try_clone()?).stderr(log.try_clone()?);
    // The command is often a wrapper around the program: a group of its own, so that both end together.
    #[cfg(unix)]
    std::os::unix::process::CommandExt::process_group(command, 0);
    let mut group = ProcessGroup(command.spawn()?);
    let deadline = Instant::now() + limit;
    loop {
        if let Some(status) = group.0.try_wait()? {
            return Ok(ProcessEnd::Exited(status));
        }
        if Instant::now() >= deadline {
            return Ok(ProcessEnd::TimeLimit);
        }
        std::thread::sleep(POLL);
    }
}

/// A child that is ended with its whole group, whatever way it is left.
struct ProcessGroup(Child);

impl Drop for ProcessGroup {
    fn drop(&mut self) {
        // A child that was waited for has given its number back.
        if matches!(self.0.try_wait(), Ok(None)) {
            #[cfg(unix)]
            {
                use rustix::process::{Pid, Signal, kill_process_group};
                // The only failure is a group that is gone already.
                let _ = kill_process_group(Pid::from_child(&self.0), Signal::KILL);
            }
            #[cfg(not(unix))]
            let _ = self.0.kill();
            let _ = self.0.wait();
        }
    }
}

/// All that a program wrote, as far as `limit` bytes from its end, without the colours of a terminal.
pub(super) fn written(mut log: &File, limit: u64) -> io::Result<String> {
    let length = log.seek(SeekFrom::End(0))?;
    log.seek(SeekFrom::Start(length.saturating_sub(limit)))?;
    let mut bytes = Vec::new();
    log.take(limit).read_to_end(&mut bytes)?;
    let text = String::from_utf8_lossy(&bytes).into_owned();
    let mut parts = text.split('\u{1b}');
    let mut plain = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        plain.push_str(part.split_once('m').map_or(part, |(_, rest)| rest));
    }
    Ok(plain)
}

/// The last lines of it that say something, in one.
pub(super) fn last_output(log: &File) -> String {
    let Ok(text) = written(log, 4096) else { return "unreadable".to_owned() };
    let lines: Vec<&str> = text.lines().map(str::trim).filter(|line| !line.is_empty()).collect();
    let last = lines.get(lines.len().saturating_sub(6)..).unwrap_or_default();
    if last.is_empty() { "none".to_owned() } else { last.join(" | ") }
}
