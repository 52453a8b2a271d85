//! External pipeline, run as a process.
//!
//! For each frame, the process receives one JSON line on its standard input and answers with one JSON line on
//! its standard output. The lines are described in [`protocol`], those of docking in [`docking_protocol`].
//! Any fault of the process is an outcome with a reason, never an error of the run; a fault of the machine (a
//! full disk) is [`contract::Pipeline::machine_fault`], with which the caller ends the run:
//!
//! - An answer that cannot be used (garbage, a number that is missing, not finite or off the detector, the
//!   wrong frame) costs its frame only; the next frame is sent regardless.
//! - A process that does not start, uses another version or greets incorrectly is ended and started again for
//!   the next frame, until it has greeted once. The caller that runs the sequence checks
//!   [`contract::Pipeline::failed_starts`] and gives up.
//! - A process that has greeted, and then dies, takes too long, floods its output or answers without a
//!   request is ended with all its children, and every later frame of the sequence states the reason. It is
//!   not restarted, because a new process would lack the memory of previous frames.
//! - Memory beyond its limit is refused. The subsequent answer or exit of the process is its result.
//!
//! There is no shell: the command is split into words by the rules of POSIX quoting, and run.

#![cfg_attr(
    not(test),
    deny(
        clippy::indexing_slicing,
        clippy::string_slice,
        clippy::expect_used,
        clippy::panic,
        clippy::unreachable
    )
)]

pub mod docking_protocol;
mod exchange;
mod group;
mod navigator;
mod plan;
mod process;
pub mod protocol;
mod sandbox;

pub use exchange::{Protocol, WriteTime};
pub use group::end_all;
pub use navigator::ExternalNavigatorFactory;
pub use plan::DEFAULT_MEMORY_MB;
pub use sandbox::Sandbox;

use std::fmt;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use contract::{ContractError, FailedStarts, Interface, MachineFault, Pipeline, PipelineFactory};

use plan::{ProcessPlan, StartError, name};
use process::Process;

/// Function that writes an image (far range: FITS of 16 bits, BZERO 32768; docking: grey PNG) to a path that
/// does not exist yet. The error is a text for the outcome.
pub type WriteImage<I> =
    dyn Fn(&<I as Interface>::Image, &<I as Interface>::Telemetry, &Path) -> Result<(), String> + Send + Sync;

/// Factory of pipelines that run as processes, one process per sequence.
pub struct ExternalFactory<I: Protocol> {
    /// Command, with words quoted as in a POSIX shell; no shell runs it.
    pub command: String,
    /// Longest time from start to greeting, s, above 0 to 1e6.
    pub start_timeout_s: f64,
    /// Longest time for one frame, s, above 0 to 1e6.
    pub timeout_s: f64,
    /// Largest memory of the process, and of each process that it starts, MB (10⁶ bytes), 1 to 1e6. Effective
    /// on Linux only.
    pub memory_mb: u64,
    /// Access of the process to file system and network. `None` grants the same access as this process has.
    pub sandbox: Option<Sandbox>,
    /// Existing directory for images; each image is removed after its answer.
    pub scratch_dir: PathBuf,
    /// Function that writes an image.
    pub write_image: Arc<WriteImage<I>>,
    /// Function that writes a time.
    pub write_time: WriteTime,
}

impl<I: Protocol> ExternalFactory<I> {
    /// Creates a factory with 30 s to start, 10 s per frame and 4 GB.
    pub fn new(
        command: impl Into<String>,
        scratch_dir: PathBuf,
        write_image: Arc<WriteImage<I>>,
        write_time: WriteTime,
    ) -> Self {
        let command = command.into();
        let (start_timeout_s, timeout_s, memory_mb) = (30.0, 10.0, DEFAULT_MEMORY_MB);
        let sandbox = None;
        Self { command, start_timeout_s, timeout_s, memory_mb, sandbox, scratch_dir, write_image, write_time }
    }

    /// Checks the command and the limits without starting a process.
    ///
    /// # Errors
    /// [`ContractError::CannotBuild`] for a command that is empty or ends inside a quotation, a program that
    /// does not exist, a limit outside its range, or a sandbox that the system does not support.
    pub fn check(&self) -> Result<(), ContractError> {
        self.plan()?.check_program()?;
        plan::check_sandbox(&self.command, self.sandbox.as_ref())
    }

    fn plan(&self) -> Result<ProcessPlan, ContractError> {
        let plan = ProcessPlan::new(&self.command, self.start_timeout_s, self.timeout_s, self.memory_mb)?;
        Ok(plan.with_sandbox(self.sandbox.as_ref(), &self.scratch_dir))
    }
}

impl<I: Protocol> fmt::Debug for ExternalFactory<I> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("ExternalFactory")
            .field("command", &self.command)
            .field("start_timeout_s", &self.start_timeout_s)
            .field("timeout_s", &self.timeout_s)
            .field("memory_mb", &self.memory_mb)
            .field("sandbox", &self.sandbox)
            .field("scratch_dir", &self.scratch_dir)
            .finish_non_exhaustive()
    }
}

impl<I: Protocol> PipelineFactory<I> for ExternalFactory<I> {
    fn name(&self) -> String {
        name(&self.command)
    }

    /// Starts the process and greets it. If the process does not start or greets incorrectly, the pipeline's
    /// first answer reports this; only an invalid command or limit is an error.
    fn build(&self, setup: &I::Setup) -> Result<Box<dyn Pipeline<I>>, ContractError> {
        let plan = self.plan()?;
        Ok(Box::new(ExternalPipeline::<I> {
            first_start: Some(start::<I>(&plan, setup)),
            process: None,
            failed_starts: None,
            machine_fault: None,
            setup: setup.clone(),
            plan,
            images: Images::new(&self.scratch_dir, I::EXTENSION),
            write_image: Arc::clone(&self.write_image),
            write_time: self.write_time,
        }))
    }
}

/// Starts the process of a sequence and greets it.
fn start<I: Protocol>(plan: &ProcessPlan, setup: &I::Setup) -> Result<Process, StartError> {
    plan.start(I::greeting(setup), protocol::check_greeting).map(|(process, ())| process)
}

/// One sequence processed by one process.
struct ExternalPipeline<I: Protocol> {
    /// Result of the first start, kept until the first image.
    first_start: Option<Result<Process, StartError>>,
    /// Process after its greeting, or the reason why it was ended afterwards.
    process: Option<Result<Process, String>>,
    failed_starts: Option<FailedStarts>,
    machine_fault: Option<MachineFault>,
    setup: I::Setup,
    plan: ProcessPlan,
    images: Images,
    write_image: Arc<WriteImage<I>>,
    write_time: WriteTime,
}

impl<I: Protocol> Pipeline<I> for ExternalPipeline<I> {
    fn process(&mut self, image: &I::Image, telemetry: &I::Telemetry) -> I::Outcome {
        match self.answer(image, telemetry) {
            Ok(outcome) => outcome,
            Err(NoAnswer::Program(reason)) => I::failed(reason),
            Err(NoAnswer::Machine(reason)) => {
                let reason = format!("at {} {}, {reason}", I::IMAGE, I::number(image));
                self.machine_fault = Some(MachineFault { reason: reason.clone() });
                I::failed(reason)
            }
        }
    }

    fn failed_starts(&self) -> Option<&FailedStarts> {
        self.failed_starts.as_ref()
    }

    fn machine_fault(&self) -> Option<&MachineFault> {
        self.machine_fault.as_ref()
    }
}

/// Reason why there is no answer to an image.
enum NoAnswer {
    /// The program is at fault.
    Program(String),
    /// The machine is at fault.
    Machine(String),
}

impl From<String> for NoAnswer {
    fn from(reason: String) -> Self {
        Self::Program(reason)
    }
}

impl<I: Protocol> ExternalPipeline<I> {
    fn answer(&mut self, image: &I::Image, telemetry: &I::Telemetry) -> Result<I::Outcome, NoAnswer> {
        let state = match &mut self.process {
            Some(state) => state,
            None => match self.first_start.take().unwrap_or_else(|| start::<I>(&self.plan, &self.setup)) {
                Ok(process) => {
                    self.failed_starts = None;
                    self.process.insert(Ok(process))
                }
                Err(StartError::Machine(reason)) => return Err(NoAnswer::Machine(reason)),
                Err(StartError::Program(reason)) => {
                    let count = self.failed_starts.as_ref().map_or(0, |failed| failed.count) + 1;
                    self.failed_starts = Some(FailedStarts { count, reason: reason.clone() });
                    return Err(reason.into());
                }
            },
        };
        let process = state.as_mut().map_err(|reason| reason.clone())?;
        let number = I::number(image);
        let file = self.images.image_file(number);
        (self.write_image)(image, telemetry, &file.path)
            .map_err(|error| NoAnswer::Machine(format!("the image cannot be written: {error}")))?;
        let request = I::request(image, telemetry, self.write_time, &file.path).map_err(NoAnswer::Machine)?;
        match process.exchange(request, self.plan.frame_limit) {
            Ok(line) => Ok(I::outcome(&line, number, &self.setup)?),
            Err(fault) => {
                let reason = format!("at {} {number}, {}", I::IMAGE, process.end(fault));
                *state = Err(reason.clone());
                Err(reason.into())
            }
        }
    }
}

/// Returns a sequence number unique within this run, because several sequences write their images to the same
/// directory.
fn next_sequence() -> u64 {
    static NEXT: AtomicU64 = AtomicU64::new(0);
    NEXT.fetch_add(1, Ordering::Relaxed)
}

/// Location of a sequence's images.
struct Images {
    directory: PathBuf,
    sequence: u64,
    extension: &'static str,
}

impl Images {
    fn new(directory: &Path, extension: &'static str) -> Self {
        Self { directory: directory.to_owned(), sequence: next_sequence(), extension }
    }

    fn image_file(&self, frame: u64) -> Image {
        let (sequence, extension) = (self.sequence, self.extension);
        let name = format!("boresight-{}-{sequence}-{frame}.{extension}", std::process::id());
        Image { path: self.directory.join(name) }
    }
}

/// Image file, removed when dropped.
struct Image {
    path: PathBuf,
}

impl Drop for Image {
    fn drop(&mut self) {
        // The file may never have been written, or the process may have removed it; both are harmless.
        let _ = std::fs::remove_file(&self.path);
    }
}
