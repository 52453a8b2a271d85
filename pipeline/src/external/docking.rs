//! Somebody else's docking pipeline, run as a process.

use std::fmt;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

use contract::ContractError;
use contract::docking::{
    DockingOutcome, DockingPipeline, DockingPipelineFactory, DockingSetup, Field, FieldTelemetry, NoPose,
};

use super::{DEFAULT_MEMORY_MB, Images, Plan, State, docking_protocol, name};

/// Writes the image of a field as grey PNG at a path that does not exist yet; the error is a text for the outcome.
pub type WriteField = dyn Fn(&Field, &Path) -> Result<(), String> + Send + Sync;

/// Builds docking pipelines that are processes, one process a sequence.
#[derive(Clone)]
pub struct ExternalDockingFactory {
    /// The command, words quoted as in a POSIX shell; no shell runs it.
    pub command: String,
    /// Longest time from start to greeting, s, above 0 to 1e6.
    pub start_timeout_s: f64,
    /// Longest time for one field, s, above 0 to 1e6.
    pub timeout_s: f64,
    /// Most memory of the process, and of each one that it starts, MB (10⁶ bytes), 1 to 1e6. Heeded on Linux alone.
    pub memory_mb: u64,
    /// An existing directory for images; each is removed after its answer.
    pub scratch_dir: PathBuf,
    /// Writes an image.
    pub write_field: Arc<WriteField>,
}

impl ExternalDockingFactory {
    /// A factory with 30 s to start, 10 s a field and 4 GB.
    pub fn new(command: impl Into<String>, scratch_dir: PathBuf, write_field: Arc<WriteField>) -> Self {
        Self {
            command: command.into(),
            start_timeout_s: 30.0,
            timeout_s: 10.0,
            memory_mb: DEFAULT_MEMORY_MB,
            scratch_dir,
            write_field,
        }
    }

    /// Checks the command and the limits, before anything is started.
    ///
    /// # Errors
    /// [`ContractError::CannotBuild`] for a command that is empty or ends inside a quotation, a program that is not there, or a limit
    /// outside its range.
    pub fn check(&self) -> Result<(), ContractError> {
        self.plan()?.check_program()
    }

    fn plan(&self) -> Result<Plan, ContractError> {
        Plan::new(&self.command, self.start_timeout_s, self.timeout_s, self.memory_mb)
    }
}

impl fmt::Debug for ExternalDockingFactory {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("ExternalDockingFactory")
            .field("command", &self.command)
            .field("start_timeout_s", &self.start_timeout_s)
            .field("timeout_s", &self.timeout_s)
            .field("memory_mb", &self.memory_mb)
            .field("scratch_dir", &self.scratch_dir)
            .finish_non_exhaustive()
    }
}

impl DockingPipelineFactory for ExternalDockingFactory {
    fn name(&self) -> String {
        name(&self.command)
    }

    /// Starts the process and greets it. A process that does not start or greets wrongly gives a pipeline whose every
    /// answer says so: only a command or a limit that cannot be meant is refused.
    fn build(&self, setup: &DockingSetup) -> Result<Box<dyn DockingPipeline>, ContractError> {
        let plan = self.plan()?;
        Ok(Box::new(ExternalDocking {
            state: plan.start(docking_protocol::greeting(setup)),
            field_limit: plan.frame_limit,
            images: Images::new(&self.scratch_dir, "png"),
            write_field: Arc::clone(&self.write_field),
        }))
    }
}

/// One sequence with one process.
struct ExternalDocking {
    state: State,
    field_limit: Duration,
    images: Images,
    write_field: Arc<WriteField>,
}

impl DockingPipeline for ExternalDocking {
    fn process(&mut self, field: &Field, telemetry: &FieldTelemetry) -> DockingOutcome {
        match self.answer(field, telemetry) {
            Ok(outcome) => outcome,
            Err(reason) => DockingOutcome::none(NoPose::Failed(reason)),
        }
    }
}

impl ExternalDocking {
    fn answer(&mut self, field: &Field, telemetry: &FieldTelemetry) -> Result<DockingOutcome, String> {
        let process = match &mut self.state {
            State::Running(process) => process,
            State::Dead(reason) => return Err(reason.clone()),
        };
        let image = self.images.place(field.number());
        (self.write_field)(field, &image.path)
            .map_err(|error| format!("the image cannot be written: {error}"))?;
        let request = docking_protocol::request(field, telemetry, &image.path)?;
        match process.exchange(request, self.field_limit) {
            Ok(line) => docking_protocol::outcome(&line, field.number()),
            Err(fault) => {
                let reason = format!("at field {}, {}", field.number(), process.end(fault));
                self.state = State::Dead(reason.clone());
                Err(reason)
            }
        }
    }
}
