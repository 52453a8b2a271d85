//! Which pipeline runs: the built-in one, or somebody else's program.
use std::path::{Path, PathBuf};

use files::{Failure, toml_file};
use pipeline::external::Sandbox;
use sha2::{Digest, Sha256};

const EXEC: &str = "exec:";

/// A larger file among a program's words counts by its name alone.
const MAX_BYTES: u64 = 1 << 30;

/// A pipeline by the word of the command line: the name of a world's built-in one, or `exec:COMMAND`.
#[derive(Debug, Clone, PartialEq)]
pub struct PipelineChoice {
    /// The word; none: the built-in pipeline of the scenario's world.
    pub word: Option<String>,
    /// Longest time that a program may take for a frame, s.
    pub timeout_s: f64,
    /// Most memory of a program, and of each process that it starts, MB (10⁶ bytes).
    pub memory_mb: u64,
    /// What a program may reach of the file system and the network; none: all that this process may.
    pub sandbox: Option<Sandbox>,
}

impl PipelineChoice {
    /// Whether it is the built-in one of a world.
    pub fn is_built_in(&self, world: &str) -> bool {
        self.word.as_deref().is_none_or(|word| word == world)
    }

    /// Words of a command line that choose it; none for the built-in one of a world.
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

    /// SHA-256 of what a program's answers depend on, as far as it can be known: its words, the files among them, its limits of time and memory;
    /// none for the built-in pipeline of a world, whose parameters are the scenario's.
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
            // A word that names no file is a program of the search path, or an option.
            if let Ok(bytes) = sim::regular_file::read(Path::new(&file), MAX_BYTES) {
                part(&bytes);
            }
        }
        Some(hash.finalize().into())
    }

    /// The files among a program's words, as they are written; none for the built-in pipeline of a world.
    pub fn files(&self, world: &str) -> Vec<PathBuf> {
        let word = self.word.as_deref().filter(|_| !self.is_built_in(world));
        word.into_iter().flat_map(words).map(PathBuf::from).filter(|file| file.is_file()).collect()
    }

    /// The command of a program; `None` for the built-in pipeline of the world called `built_in`.
    pub(crate) fn command(&self, built_in: &str) -> Result<Option<&str>, Failure> {
        let Some(word) = self.word.as_deref().filter(|word| *word != built_in) else { return Ok(None) };
        if let Some(command) = word.strip_prefix(EXEC) {
            return Ok(Some(command));
        }
        let hint = toml_file::nearest(word, [built_in, EXEC])
            .map_or(String::new(), |name| format!("; did you mean `{name}`?"));
        Err(Failure::Usage(format!(
            "there is no pipeline `{word}` in the world `{built_in}`; expected `{built_in}` or `exec:COMMAND`{hint}"
        )))
    }
}

/// The words of a program's command.
fn words(word: &str) -> impl Iterator<Item = String> {
    shlex::split(word.strip_prefix(EXEC).unwrap_or(word)).into_iter().flatten()
}
