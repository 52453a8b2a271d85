//! Command and limits of an external program, checked.

use std::path::{Path, PathBuf};
use std::time::Duration;

use contract::ContractError;
use thiserror::Error;

use super::process::{Fault, Process};
use super::sandbox::Sandbox;

/// Reason why a program does not start or does not greet.
#[derive(Debug, Clone, Error)]
pub(super) enum StartError {
    /// The program is at fault.
    #[error("{0}")]
    Program(String),
    /// The machine is at fault: it lacks memory, processes, open files or space on a disk.
    #[error("{0}")]
    Machine(String),
}

/// Default memory limit of a process, MB (10⁶ bytes).
pub const DEFAULT_MEMORY_MB: u64 = 4000;

/// Command and limits of a factory in checked form.
pub(super) struct ProcessPlan {
    program: String,
    arguments: Vec<String>,
    start_limit: Duration,
    /// Longest time for one answer.
    pub(super) frame_limit: Duration,
    memory_bytes: u64,
    /// Sandbox, with the directory of the images.
    sandbox: Option<(Sandbox, PathBuf)>,
}

impl ProcessPlan {
    /// Splits a command and checks the limits.
    pub(super) fn new(
        command: &str,
        start_timeout_s: f64,
        timeout_s: f64,
        memory_mb: u64,
    ) -> Result<Self, ContractError> {
        let cannot_build = |reason: String| ContractError::CannotBuild { pipeline: name(command), reason };
        let limit = |name: &str, seconds: f64| {
            if seconds > 0.0 && seconds <= 1e6 {
                Ok(Duration::from_secs_f64(seconds))
            } else {
                Err(cannot_build(format!("{name} is {seconds}, expected above 0 to 1e6")))
            }
        };
        if !(1..=1_000_000).contains(&memory_mb) {
            return Err(cannot_build(format!("memory_mb is {memory_mb}, expected 1 to 1e6")));
        }
        let mut words = shlex::split(command)
            .ok_or_else(|| cannot_build("the command ends inside a quotation".to_owned()))?
            .into_iter();
        Ok(Self {
            program: words.next().ok_or_else(|| cannot_build("the command is empty".to_owned()))?,
            arguments: words.collect(),
            start_limit: limit("start_timeout_s", start_timeout_s)?,
            frame_limit: limit("timeout_s", timeout_s)?,
            memory_bytes: memory_mb * 1_000_000,
            sandbox: None,
        })
    }

    /// Sets the sandbox of the process, with its directory for images and temporary files.
    pub(super) fn with_sandbox(self, sandbox: Option<&Sandbox>, scratch: &Path) -> Self {
        Self { sandbox: sandbox.map(|sandbox| (sandbox.clone(), scratch.to_owned())), ..self }
    }

    /// Refuses a program that does not exist.
    pub(super) fn check_program(&self) -> Result<(), ContractError> {
        match which::which(&self.program) {
            Ok(_) => Ok(()),
            Err(_) => Err(ContractError::CannotBuild {
                pipeline: name(
                    &shlex::try_quote(&self.program).unwrap_or_else(|_| self.program.as_str().into()),
                ),
                reason: format!(
                    "program `{}` not found, expected a program on the search path or the path of an \
                     executable file",
                    self.program
                ),
            }),
        }
    }

    /// Starts the process and greets it, and returns what `read` makes of its answer.
    ///
    /// # Errors
    /// [`StartError`] with the reason.
    pub(super) fn start<T>(
        &self,
        greeting: Result<Vec<u8>, String>,
        read: impl FnOnce(&[u8]) -> Result<T, String>,
    ) -> Result<(Process, T), StartError> {
        let mut process =
            Process::start(&self.program, &self.arguments, self.memory_bytes, self.sandbox.as_ref())
                .map_err(|error| self.start_error(&error))?;
        let greeted = greeting
            .map_err(Fault::Broken)
            .and_then(|line| process.exchange(line, self.start_limit))
            .and_then(|line| read(&line).map_err(Fault::Broken));
        match greeted {
            Ok(answer) => Ok((process, answer)),
            Err(fault) => {
                let reason = format!("during the greeting, {}{}", process.end(fault), self.sandbox_hint());
                Err(StartError::Program(reason))
            }
        }
    }

    fn start_error(&self, error: &std::io::Error) -> StartError {
        let reason = format!("`{}` cannot be started: {error}", self.program);
        if is_of_machine(error) {
            return StartError::Machine(reason);
        }
        StartError::Program(reason + self.sandbox_hint())
    }

    /// Returns the remedy for a program whose files the sandbox hides.
    fn sandbox_hint(&self) -> &'static str {
        if self.sandbox.is_none() {
            return "";
        }
        " (if it lacks a file in the sandbox, allow the file or its folder by --sandbox-read PATH)"
    }
}

/// Returns true if the machine lacks what every program needs to start.
fn is_of_machine(error: &std::io::Error) -> bool {
    use std::io::ErrorKind;
    // Numbers of open files of the process and of the system, which have no kind.
    let lacks_files = cfg!(unix) && matches!(error.raw_os_error(), Some(23 | 24));
    let kinds = [
        ErrorKind::StorageFull,
        ErrorKind::QuotaExceeded,
        ErrorKind::FileTooLarge,
        ErrorKind::ReadOnlyFilesystem,
        ErrorKind::OutOfMemory,
        // A limit on the number of processes (EAGAIN).
        ErrorKind::WouldBlock,
    ];
    lacks_files || kinds.contains(&error.kind())
}

/// Refuses a sandbox that the system does not support.
///
/// # Errors
/// [`ContractError::CannotBuild`] with the missing feature.
pub(super) fn check_sandbox(command: &str, sandbox: Option<&Sandbox>) -> Result<(), ContractError> {
    let cannot_build = |reason| ContractError::CannotBuild { pipeline: name(command), reason };
    sandbox.map_or(Ok(()), |_| Sandbox::check().map_err(cannot_build))
}

/// Returns the name of a command's pipeline or navigator.
pub(super) fn name(command: &str) -> String {
    format!("exec:{command}")
}
