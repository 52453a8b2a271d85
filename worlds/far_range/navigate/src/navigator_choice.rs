//! Choice of the navigator: a built-in one, or an external program.

use std::path::Path;

use config::toml_file;
use contract::conformance::Violation;
use contract::conformance::navigation::check;
use contract::navigation::NavigatorFactory;
use files::{Failure, format_utc};
use navigation::{BatchFactory, SequentialFactory};
use pipeline::external::{ExternalNavigatorFactory, Sandbox};

use crate::campaign::Campaign;
use crate::estimator::Estimator;

const EXEC: &str = "exec:";

/// A navigator as chosen on the command line: `batch`, `sequential` or `exec:COMMAND`.
#[derive(Debug, Clone, PartialEq)]
pub struct NavigatorChoice {
    /// Value from the command line.
    pub word: String,
    /// Time limit of a program per request, s.
    pub timeout_s: f64,
    /// Memory limit of a program, and of each process that it starts, MB (10⁶ bytes).
    pub memory_mb: u64,
    /// Access of a program to the file system and the network; `None`: the access of this process.
    pub sandbox: Option<Sandbox>,
}

impl NavigatorChoice {
    /// Returns true if the choice is a program.
    pub fn is_program(&self) -> bool {
        self.word.starts_with(EXEC)
    }

    /// Returns the factory of the program, `None` for a built-in navigator. A program in a sandbox has its
    /// temporary files in `scratch`.
    ///
    /// # Errors
    /// A [`Failure`] for a name that is not a navigator, an invalid command, or a limit outside its range.
    pub fn program(&self, scratch: &Path) -> Result<Option<ExternalNavigatorFactory>, Failure> {
        let Some(command) = self.word.strip_prefix(EXEC) else {
            return self.built_in().map(|_| None);
        };
        let mut factory = ExternalNavigatorFactory::new(command, scratch.to_owned(), format_utc);
        factory.timeout_s = self.timeout_s;
        factory.memory_mb = self.memory_mb;
        factory.sandbox.clone_from(&self.sandbox);
        factory.check()?;
        Ok(Some(factory))
    }

    /// Returns the factory of the navigator for a campaign.
    ///
    /// # Errors
    /// Those of [`NavigatorChoice::program`].
    pub fn factory(&self, campaign: &Campaign, scratch: &Path) -> Result<Box<dyn NavigatorFactory>, Failure> {
        match self.program(scratch)? {
            Some(program) => Ok(Box::new(program)),
            None => Ok(self.built_in()?.factory(campaign)),
        }
    }

    /// Returns the violations of the contract that the conformance checks find; a built-in navigator has its
    /// default configuration.
    ///
    /// # Errors
    /// Those of [`NavigatorChoice::program`].
    pub fn violations(&self, scratch: &Path) -> Result<Vec<Violation>, Failure> {
        let found = match self.program(scratch)? {
            Some(program) => check(&program),
            None => match self.built_in()? {
                Estimator::Batch => check(&BatchFactory::default()),
                Estimator::Sequential => check(&SequentialFactory::default()),
            },
        };
        Ok(found.err().unwrap_or_default())
    }

    fn built_in(&self) -> Result<Estimator, Failure> {
        Estimator::parse(&self.word).ok_or_else(|| {
            let known = [Estimator::Batch.code(), Estimator::Sequential.code(), EXEC];
            let hint = toml_file::nearest(&self.word, known)
                .map_or(String::new(), |name| format!("; did you mean `{name}`?"));
            Failure::Usage(format!(
                "unknown navigator `{}`; expected `batch`, `sequential` or `exec:COMMAND`{hint}",
                self.word
            ))
        })
    }
}
