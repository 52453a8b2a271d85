//! Factories of pipelines without their types.

use std::any::Any;
use std::path::Path;
use std::sync::Arc;

use contract::{Interface, PipelineFactory};
use files::{Failure, format_utc};
use pipeline::external::ExternalFactory;

use crate::choice::pipeline_choice::PipelineChoice;
use crate::world::{FactoryOf, World};

/// Factory of a pipeline of any world.
pub struct AnyFactory {
    /// Name of the pipeline in tables and logs.
    pub name: String,
    factory: Box<dyn Any + Send + Sync>,
}

impl AnyFactory {
    /// Creates a factory from that of a world.
    pub fn new<I: Interface>(factory: Box<dyn PipelineFactory<I> + Send>) -> Self {
        Self { name: factory.name(), factory: Box::new(factory) }
    }

    /// Returns the factory of pipelines with the interface `I`.
    ///
    /// # Errors
    /// [`Failure::Usage`] when the factory belongs to another world.
    pub fn downcast<I: Interface>(&self) -> Result<&dyn PipelineFactory<I>, Failure> {
        match self.factory.downcast_ref::<Box<dyn PipelineFactory<I> + Send>>() {
            Some(factory) => Ok(factory.as_ref()),
            None => Err(Failure::Usage("the pipeline belongs to another world than the scenario".to_owned())),
        }
    }
}

impl PipelineChoice {
    /// Returns the factory of a pipeline of the world `W`, whose built-in pipeline has the parameters
    /// `config`. An external program receives its images in `scratch`.
    ///
    /// # Errors
    /// A [`Failure`] for a name that is not a pipeline of that world, an invalid command, or a limit outside
    /// its range.
    pub fn factory<W: World>(&self, config: &W::Config, scratch: &Path) -> Result<FactoryOf<W>, Failure> {
        let Some(command) = self.command(W::CODE)? else { return W::built_in(config) };
        let mut factory = ExternalFactory::<W::Interface>::new(
            command,
            scratch.to_path_buf(),
            Arc::new(W::write_image),
            format_utc,
        );
        factory.timeout_s = self.timeout_s;
        factory.memory_mb = self.memory_mb;
        factory.sandbox.clone_from(&self.sandbox);
        // Checked here, before anything is written for the program.
        factory.check()?;
        Ok(Box::new(factory))
    }
}
