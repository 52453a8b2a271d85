//! Choice of the pipeline: the built-in one, or an external program.
use std::path::{Path, PathBuf};

use config::toml_file;
use files::Failure;
use pipeline::external::Sandbox;
use sha2::{Digest, Sha256};

const EXEC: &str = "exec:";

/// Maximum size, bytes, up to which a file named in a command is hashed; a larger file is represented only by
/// its name.
const MAX_BYTES: u64 = 1 << 30;

/// A pipeline as chosen on the command line: the name of a world's built-in pipeline, or `exec:COMMAND`.
#[derive(Debug, Clone, PartialEq)]
pub struct PipelineChoice {
    /// Value from the command line; `None`: the built-in pipeline of the scenario's world.
    pub word: Option<String>,
    /// Time limit of a program per frame, s.
    pub timeout_s: f64,
    /// Memory limit of a program, and of each process that it starts, MB (10⁶ bytes).
    pub memory_mb: u64,
    /// Access of a program to the file system and the network; `None`: the access of this process.
    pub sandbox: Option<Sandbox>,
}

impl PipelineChoice {
    /// Returns true for the built-in pipeline of a world.
    pub fn is_built_in(&self, world: &str) -> bool {
        self.word.as_deref().is_none_or(|word| word == world)
    }

    /// Returns the command-line arguments that select this pipeline; none for the built-in pipeline of a
    /// world.
    pub fn arguments(&self, world: &str) -> Vec<String> {
        match &self.word {
            Some(word) if !self.is_built_in(world) => {
                let (timeout_s, memory_mb) = (self.timeout_s.to_string(), self.memory_mb.to_string());
                let mut words = ["--pipeline", word, "--timeout-s", &timeout_s, "--memory-mb", &memory_mb]
                    .map(str::to_owned)
                    .to_vec();
                if let Some(sandbox) = &self.sandbox {
                    words.push("--sandbox".to_owned());
                    for path in &sandbox.readable {
                        words.extend(["--sandbox-read".to_owned(), path.display().to_string()]);
                    }
                }
                words
            }
            _ => Vec::new(),
        }
    }

    /// SHA-256 of the known inputs that determine a program's outcomes: the words of its command, the files
    /// among them, its limits of time and memory, and the use of a sandbox. `None` for the built-in pipeline
    /// of a world, whose parameters are part of the scenario.
    pub fn hash(&self, world: &str) -> Option<[u8; 32]> {
        let word = self.word.as_ref().filter(|_| !self.is_built_in(world))?;
        let mut hash = Sha256::new();
        let mut part = |bytes: &[u8]| {
            hash.update((bytes.len() as u64).to_le_bytes());
            hash.update(bytes);
        };
        part(word.as_bytes());
        part(&self.timeout_s.to_bits().to_le_bytes());
        part(&self.memory_mb.to_le_bytes());
        if self.sandbox.is_some() {
            part(b"sandbox");
        }
        for file in words(word) {
            // A word that is not a file is a program on the search path, or an option.
            if let Ok(bytes) = config::regular_file::read(Path::new(&file), MAX_BYTES) {
                part(&bytes);
            }
        }
        Some(hash.finalize().into())
    }

    /// Returns the files among the words of a program's command, as written; none for the built-in pipeline
    /// of a world.
    pub fn files(&self, world: &str) -> Vec<PathBuf> {
        let word = self.word.as_deref().filter(|_| !self.is_built_in(world));
        word.into_iter().flat_map(words).map(PathBuf::from).filter(|file| file.is_file()).collect()
    }

    /// Returns the command of a program; `None` for the built-in pipeline of the world called `built_in`.
    pub(crate) fn command(&self, built_in: &str) -> Result<Option<&str>, Failure> {
        let Some(word) = self.word.as_deref().filter(|word| *word != built_in) else { return Ok(None) };
        if let Some(command) = word.strip_prefix(EXEC) {
            return Ok(Some(command));
        }
        let hint = toml_file::nearest(word, [built_in, EXEC])
            .map_or(String::new(), |name| format!("; did you mean `{name}`?"));
        Err(Failure::Usage(format!(
            "unknown pipeline `{word}` for the world `{built_in}`; expected `{built_in}` or \
             `exec:COMMAND`{hint}"
        )))
    }
}

/// Splits the command of a program into words.
fn words(word: &str) -> impl Iterator<Item = String> {
    shlex::split(word.strip_prefix(EXEC).unwrap_or(word)).into_iter().flatten()
}
