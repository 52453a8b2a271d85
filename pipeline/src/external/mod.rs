//! Somebody else's pipeline, run as a process.
//!
//! The process is given one JSON line on its standard input for each frame, and answers with one JSON line on its
//! standard output. The lines are described at [`protocol`], those of docking at [`docking_protocol`]. Whatever the process does wrong is an outcome with a
//! reason, never an error of the run:
//!
//! - an answer that cannot be used (garbage, a number that is missing, not finite or off the detector, the wrong
//!   frame) costs its frame; the next one is asked all the same;
//! - a process that does not start, speaks another version or greets wrongly is ended and started again for the next frame, until it has
//!   greeted once; whoever runs the sequence looks at [`contract::Pipeline::failed_starts`] and gives up;
//! - a process that has greeted, and then dies, takes too long, floods its output or speaks out of turn is ended with all its children, and
//!   every later frame of the sequence says why: it has a memory, and a second one would be another;
//! - memory beyond its limit is refused to it, and what it then says or how it ends is its answer.
//!
//! There is no shell: the command is split into words by the rules of POSIX quoting, and run.

pub mod docking_protocol;
mod exchange;
mod group;
mod process;
pub mod protocol;
mod sandbox;

pub use exchange::{Protocol, WriteTime};
pub use group::end_all;
pub use sandbox::Sandbox;

use std::fmt;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

use contract::{ContractError, FailedStarts, Interface, Pipeline, PipelineFactory};

use process::{Fault, Process};

/// Writes an image (far range: FITS of 16 bits, BZERO 32768; docking: grey PNG) at a path that does not exist yet; the error is a text
/// for the outcome.
pub type WriteImage<I> =
    dyn Fn(&<I as Interface>::Image, &<I as Interface>::Telemetry, &Path) -> Result<(), String> + Send + Sync;

/// Memory of a process, MB (10⁶ bytes), where nobody says how much.
pub const DEFAULT_MEMORY_MB: u64 = 4000;

/// Builds pipelines that are processes, one process a sequence.
pub struct ExternalFactory<I: Protocol> {
    /// The command, words quoted as in a POSIX shell; no shell runs it.
    pub command: String,
    /// Longest time from start to greeting, s, above 0 to 1e6.
    pub start_timeout_s: f64,
    /// Longest time for one frame, s, above 0 to 1e6.
    pub timeout_s: f64,
    /// Most memory of the process, and of each one that it starts, MB (10⁶ bytes), 1 to 1e6. Heeded on Linux alone.
    pub memory_mb: u64,
    /// What the process may reach of the file system and the network; none: all that this process may.
    pub sandbox: Option<Sandbox>,
    /// An existing directory for images; each is removed after its answer.
    pub scratch_dir: PathBuf,
    /// Writes an image.
    pub write_image: Arc<WriteImage<I>>,
    /// Writes a time.
    pub write_time: WriteTime,
}

impl<I: Protocol> ExternalFactory<I> {
    /// A factory with 30 s to start, 10 s a frame and 4 GB.
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

    /// Checks the command and the limits, before anything is started.
    ///
    /// # Errors
    /// [`ContractError::CannotBuild`] for a command that is empty or ends inside a quotation, a program that is not there, a limit
    /// outside its range, or a sandbox that the system does not have.
    pub fn check(&self) -> Result<(), ContractError> {
        self.plan()?.check_program()?;
        let cannot_build = |reason| ContractError::CannotBuild { pipeline: name(&self.command), reason };
        self.sandbox.as_ref().map_or(Ok(()), |_| Sandbox::check().map_err(cannot_build))
    }

    fn plan(&self) -> Result<ProcessPlan, ContractError> {
        let plan = ProcessPlan::new(&self.command, self.start_timeout_s, self.timeout_s, self.memory_mb)?;
        Ok(ProcessPlan {
            sandbox: self.sandbox.clone().map(|sandbox| (sandbox, self.scratch_dir.clone())),
            ..plan
        })
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

/// What a factory's command and limits come to.
struct ProcessPlan {
    program: String,
    arguments: Vec<String>,
    start_limit: Duration,
    frame_limit: Duration,
    memory_bytes: u64,
    /// With the folder of the images.
    sandbox: Option<(Sandbox, PathBuf)>,
}

impl ProcessPlan {
    /// Splits a command and checks the limits.
    fn new(
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

    /// Refuses a program that is not there.
    fn check_program(&self) -> Result<(), ContractError> {
        match which::which(&self.program) {
            Ok(_) => Ok(()),
            Err(_) => Err(ContractError::CannotBuild {
                pipeline: name(
                    &shlex::try_quote(&self.program).unwrap_or_else(|_| self.program.as_str().into()),
                ),
                reason: format!(
                    "there is no program `{}`, expected one of the search path or the path of an executable file",
                    self.program
                ),
            }),
        }
    }

    /// Starts the process and greets it; the reason when either does not succeed.
    fn start(&self, greeting: Result<Vec<u8>, String>) -> Result<Process, String> {
        let mut process =
            Process::start(&self.program, &self.arguments, self.memory_bytes, self.sandbox.as_ref())
                .map_err(|error| format!("`{}` does not start: {error}", self.program))?;
        let greeted = greeting
            .map_err(Fault::Broken)
            .and_then(|line| process.exchange(line, self.start_limit))
            .and_then(|line| protocol::check_greeting(&line).map_err(Fault::Broken));
        match greeted {
            Ok(()) => Ok(process),
            Err(fault) => Err(format!("at its greeting, {}", process.end(fault))),
        }
    }
}

/// The name of the pipeline of a command.
fn name(command: &str) -> String {
    format!("exec:{command}")
}

impl<I: Protocol> PipelineFactory<I> for ExternalFactory<I> {
    fn name(&self) -> String {
        name(&self.command)
    }

    /// Starts the process and greets it. One that does not start or greets wrongly gives a pipeline whose first answer says so: only a
    /// command or a limit that cannot be meant is refused.
    fn build(&self, setup: &I::Setup) -> Result<Box<dyn Pipeline<I>>, ContractError> {
        let plan = self.plan()?;
        Ok(Box::new(ExternalPipeline::<I> {
            first_start: Some(plan.start(I::greeting(setup))),
            process: None,
            failed_starts: None,
            setup: setup.clone(),
            plan,
            images: Images::new(&self.scratch_dir, I::EXTENSION),
            write_image: Arc::clone(&self.write_image),
            write_time: self.write_time,
        }))
    }
}

/// One sequence with one process.
struct ExternalPipeline<I: Protocol> {
    /// Until the first image comes.
    first_start: Option<Result<Process, String>>,
    /// Once it has greeted; or why it was ended since.
    process: Option<Result<Process, String>>,
    failed_starts: Option<FailedStarts>,
    setup: I::Setup,
    plan: ProcessPlan,
    images: Images,
    write_image: Arc<WriteImage<I>>,
    write_time: WriteTime,
}

impl<I: Protocol> Pipeline<I> for ExternalPipeline<I> {
    fn process(&mut self, image: &I::Image, telemetry: &I::Telemetry) -> I::Outcome {
        self.answer(image, telemetry).unwrap_or_else(I::failed)
    }

    fn failed_starts(&self) -> Option<&FailedStarts> {
        self.failed_starts.as_ref()
    }
}

impl<I: Protocol> ExternalPipeline<I> {
    fn answer(&mut self, image: &I::Image, telemetry: &I::Telemetry) -> Result<I::Outcome, String> {
        let state = match &mut self.process {
            Some(state) => state,
            None => {
                match self.first_start.take().unwrap_or_else(|| self.plan.start(I::greeting(&self.setup))) {
                    Ok(process) => {
                        self.failed_starts = None;
                        self.process.insert(Ok(process))
                    }
                    Err(reason) => {
                        let count = self.failed_starts.as_ref().map_or(0, |failed| failed.count) + 1;
                        self.failed_starts = Some(FailedStarts { count, reason: reason.clone() });
                        return Err(reason);
                    }
                }
            }
        };
        let process = state.as_mut().map_err(|reason| reason.clone())?;
        let number = I::number(image);
        let file = self.images.image_file(number);
        (self.write_image)(image, telemetry, &file.path)
            .map_err(|error| format!("the image cannot be written: {error}"))?;
        let request = I::request(image, telemetry, self.write_time, &file.path)?;
        match process.exchange(request, self.plan.frame_limit) {
            Ok(line) => I::outcome(&line, number, &self.setup),
            Err(fault) => {
                let reason = format!("at {} {number}, {}", I::IMAGE, process.end(fault));
                *state = Err(reason.clone());
                Err(reason)
            }
        }
    }
}

/// Number of this sequence in this run: several write their images side by side.
fn next_sequence() -> u64 {
    static NEXT: AtomicU64 = AtomicU64::new(0);
    NEXT.fetch_add(1, Ordering::Relaxed)
}

/// Where the images of a sequence are put.
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

/// A file that is removed when it has served.
struct Image {
    path: PathBuf,
}

impl Drop for Image {
    fn drop(&mut self) {
        // It may never have been written, and the process may have removed it: nothing is lost in either case.
        let _ = std::fs::remove_file(&self.path);
    }
}
