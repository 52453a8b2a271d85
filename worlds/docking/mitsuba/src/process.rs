//! Runs a program to its end, within a time limit, together with the processes it starts.

use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};

/// End of a program.
pub(super) enum ProcessEnd {
    /// Exited, with this status.
    Exited(ExitStatus),
    /// Exceeded the time limit, and was killed.
    TimeLimit,
}

/// Interval at which the state of the process is polled; negligible against its run time of seconds.
const POLL: Duration = Duration::from_millis(10);

/// Runs a command; its standard output and standard error go to `log`.
///
/// # Errors
/// The error of the operating system, when the command cannot be started.
pub(super) fn run(command: &mut Command, log: &File, limit: Duration) -> io::Result<ProcessEnd> {
    command.stdin(Stdio::null()).stdout(log.try_clone()?).stderr(log.try_clone()?);
    // The command is often a wrapper around the program: a separate process group ensures that both are
    // killed together.
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

/// A child process that is killed with its whole group when it is dropped.
struct ProcessGroup(Child);

impl Drop for ProcessGroup {
    fn drop(&mut self) {
        // A child that has been waited for has released its process id.
        if matches!(self.0.try_wait(), Ok(None)) {
            #[cfg(unix)]
            {
                use rustix::process::{Pid, Signal, kill_process_group};
                // The only possible failure is a group that has already ended.
                let _ = kill_process_group(Pid::from_child(&self.0), Signal::KILL);
            }
            #[cfg(not(unix))]
            let _ = self.0.kill();
            let _ = self.0.wait();
        }
    }
}

/// Returns the output of a program, at most its last `limit` bytes, without terminal colour codes.
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

/// Returns the last non-empty lines of the output, joined into one.
pub(super) fn last_output(log: &File) -> String {
    let Ok(text) = written(log, 4096) else { return "unreadable".to_owned() };
    let lines: Vec<&str> = text.lines().map(str::trim).filter(|line| !line.is_empty()).collect();
    let last = lines.get(lines.len().saturating_sub(6)..).unwrap_or_default();
    if last.is_empty() { "none".to_owned() } else { last.join(" | ") }
}
