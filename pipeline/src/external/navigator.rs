//! External navigator, run as a process: lines of [`contract::navigation::lines`].
//!
//! Events are sent with the request that follows them. A fault of the process is an answer with a reason,
//! never an error of the campaign, except at the start: a process that does not start, greets incorrectly or
//! uses another version is an error of [`NavigatorFactory::build`]. An answer that cannot be used costs the
//! epochs of its request only. A process that dies, takes too long, floods its output or answers without a
//! request is ended with all its children, and every later answer states the reason.

use std::fmt;
use std::path::PathBuf;
use std::sync::OnceLock;

use contract::ContractError;
use contract::navigation::lines::{EstimatesLine, GreetingAnswer, Line, SetupLine, VERSION};
use contract::navigation::{Answer, Event, Mode, NavigationSetup, Navigator, NavigatorFactory, NoEstimate};
use hifitime::Epoch;

use super::exchange::WriteTime;
use super::plan::{DEFAULT_MEMORY_MB, ProcessPlan, check_sandbox, name};
use super::process::Process;
use super::protocol::{line, parse};
use super::sandbox::Sandbox;

/// Largest number of epochs of a request: its answer has a third of the longest line.
const MAX_EPOCHS: usize = 100;

/// Factory of navigators that run as processes, one process per campaign.
pub struct ExternalNavigatorFactory {
    /// Command, with words quoted as in a POSIX shell; no shell runs it.
    pub command: String,
    /// Longest time from start to greeting, s, above 0 to 1e6.
    pub start_timeout_s: f64,
    /// Longest time for the answer to a request, s, above 0 to 1e6.
    pub timeout_s: f64,
    /// Largest memory of the process, and of each process that it starts, MB (10⁶ bytes), 1 to 1e6. Effective
    /// on Linux only.
    pub memory_mb: u64,
    /// Access of the process to file system and network. `None` grants the same access as this process has.
    pub sandbox: Option<Sandbox>,
    /// Existing directory for temporary files of a process in a sandbox.
    pub scratch_dir: PathBuf,
    /// Function that writes a time.
    pub write_time: WriteTime,
    mode: OnceLock<Mode>,
}

impl ExternalNavigatorFactory {
    /// Creates a factory with 30 s to start, 60 s per request and 4 GB.
    pub fn new(command: impl Into<String>, scratch_dir: PathBuf, write_time: WriteTime) -> Self {
        Self {
            command: command.into(),
            start_timeout_s: 30.0,
            timeout_s: 60.0,
            memory_mb: DEFAULT_MEMORY_MB,
            sandbox: None,
            scratch_dir,
            write_time,
            mode: OnceLock::new(),
        }
    }

    /// Checks the command and the limits without starting a process.
    ///
    /// # Errors
    /// [`ContractError::CannotBuild`] for a command that is empty or ends inside a quotation, a program that
    /// does not exist, a limit outside its range, or a sandbox that the system does not support.
    pub fn check(&self) -> Result<(), ContractError> {
        self.plan()?.check_program()?;
        check_sandbox(&self.command, self.sandbox.as_ref())
    }

    fn plan(&self) -> Result<ProcessPlan, ContractError> {
        let plan = ProcessPlan::new(&self.command, self.start_timeout_s, self.timeout_s, self.memory_mb)?;
        Ok(plan.with_sandbox(self.sandbox.as_ref(), &self.scratch_dir))
    }
}

impl fmt::Debug for ExternalNavigatorFactory {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("ExternalNavigatorFactory")
            .field("command", &self.command)
            .field("start_timeout_s", &self.start_timeout_s)
            .field("timeout_s", &self.timeout_s)
            .field("memory_mb", &self.memory_mb)
            .field("sandbox", &self.sandbox)
            .field("scratch_dir", &self.scratch_dir)
            .finish_non_exhaustive()
    }
}

impl NavigatorFactory for ExternalNavigatorFactory {
    fn name(&self) -> String {
        name(&self.command)
    }

    /// Returns the mode of the first process's greeting; before the first [`NavigatorFactory::build`], batch.
    fn mode(&self) -> Mode {
        self.mode.get().copied().unwrap_or(Mode::Batch)
    }

    fn build(&self, setup: &NavigationSetup) -> Result<Box<dyn Navigator>, ContractError> {
        setup.check()?;
        let plan = self.plan()?;
        let greeting = line(&Line::Setup(Box::new(SetupLine::new(setup, &self.write_time))));
        let cannot_build = |reason| ContractError::CannotBuild { pipeline: self.name(), reason };
        let (process, mode) =
            plan.start(greeting, check_greeting).map_err(|error| cannot_build(error.to_string()))?;
        let first = *self.mode.get_or_init(|| mode);
        if first != mode {
            return Err(cannot_build(format!("its mode is {mode:?}, and was {first:?} at its first start")));
        }
        Ok(Box::new(ExternalNavigator {
            process: Ok(process),
            pending: Vec::new(),
            plan,
            write_time: self.write_time,
        }))
    }
}

/// Reads the answer to the setup.
fn check_greeting(answer: &[u8]) -> Result<Mode, String> {
    let answer: GreetingAnswer = parse(answer)?;
    if answer.boresight_navigator == VERSION {
        Ok(answer.mode)
    } else {
        Err(format!("it uses version {} of the protocol, expected {VERSION}", answer.boresight_navigator))
    }
}

/// One campaign in one process.
struct ExternalNavigator {
    /// Process after its greeting, or the reason why it was ended.
    process: Result<Process, String>,
    /// Lines of the events since the last request.
    pending: Vec<u8>,
    plan: ProcessPlan,
    write_time: WriteTime,
}

impl Navigator for ExternalNavigator {
    fn receive(&mut self, event: &Event) {
        match line(&Line::from_event(event, &self.write_time)) {
            Ok(line) => self.pending.extend(line),
            Err(reason) => self.process = Err(reason),
        }
    }

    fn estimates(&mut self, epochs: &[Epoch]) -> Vec<Answer> {
        epochs.chunks(MAX_EPOCHS).flat_map(|epochs| self.answers(epochs)).collect()
    }
}

impl ExternalNavigator {
    fn answers(&mut self, epochs: &[Epoch]) -> Vec<Answer> {
        self.exchange(epochs).unwrap_or_else(|reason| vec![Err(NoEstimate::Failed(reason)); epochs.len()])
    }

    fn exchange(&mut self, epochs: &[Epoch]) -> Result<Vec<Answer>, String> {
        let process = self.process.as_mut().map_err(|reason| reason.clone())?;
        let times: Vec<String> = epochs.iter().map(|epoch| (self.write_time)(*epoch)).collect();
        let first = times.first().cloned().unwrap_or_default();
        let mut request = std::mem::take(&mut self.pending);
        request.extend(line(&Line::Estimate(times))?);
        match process.exchange(request, self.plan.frame_limit) {
            Ok(line) => {
                parse::<EstimatesLine>(&line)?.answers(epochs).map_err(|error| format!("its {error}"))
            }
            Err(fault) => {
                let reason = format!("at the request for {first}, {}", process.end(fault));
                self.process = Err(reason.clone());
                Err(reason)
            }
        }
    }
}
