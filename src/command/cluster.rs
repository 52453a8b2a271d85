//! Execution of a study on the workers of a Dask cluster: the Rust code only starts the driver.
use std::io::{BufRead, BufReader, Write};
use std::path::Path;
use std::process::{Command, Stdio};
use std::str::FromStr;

use files::Failure;

/// Executor of the shards of a study.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(super) enum Engine {
    /// Threads of this process.
    #[default]
    Local,
    /// Workers of a Dask cluster: of the scheduler at an address, or of a cluster started for this purpose on
    /// this machine.
    Dask(Option<String>),
}

impl FromStr for Engine {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text.split_once('=') {
            None if text == "local" => Ok(Self::Local),
            None if text == "dask" => Ok(Self::Dask(None)),
            Some(("dask", address)) if !address.is_empty() => Ok(Self::Dask(Some(address.to_owned()))),
            _ => Err(format!(
                "engine is `{text}`, expected local, dask, or dask=ADDRESS as in dask=tcp://10.0.0.1:8786"
            )),
        }
    }
}

/// Environment variable with the Python interpreter that runs the driver.
const PYTHON: &str = "BORESIGHT_PYTHON";
/// Environment variable with the path of the program on the workers, if it differs from the path here.
const PROGRAM: &str = "BORESIGHT_PROGRAM";

const INSTALL: &str =
    "install it with `pip install './python[dask]'`, and set BORESIGHT_PYTHON to the interpreter";

/// Returns an error if Python, the package or Dask is missing.
///
/// # Errors
/// [`Failure::Usage`], which states how to install it.
pub(super) fn check_dask() -> Result<(), Failure> {
    let python = python();
    let tried = Command::new(&python).args(["-c", "import boresight.dask_engine, distributed"]).output();
    match tried {
        Ok(output) if output.status.success() => Ok(()),
        Ok(_) => Err(Failure::Usage(format!(
            "--engine dask: `{python}` has no Dask engine of Boresight; {INSTALL}"
        ))),
        Err(error) => {
            Err(Failure::Usage(format!("--engine dask: `{python}` cannot be started ({error}); {INSTALL}")))
        }
    }
}

fn python() -> String {
    std::env::var(PYTHON).unwrap_or_else(|_| "python3".to_owned())
}

/// Makes the workers of a cluster run the shards of a plan (JSON, as `study plan` prints it) below `out`;
/// calls `done` with each finished shard.
///
/// # Errors
/// [`Failure::Usage`] if the driver does not start, or if a shard failed.
pub(super) fn run_on_dask(
    plan: &str,
    out: &Path,
    address: Option<&str>,
    workers: usize,
    mut done: impl FnMut(u64),
) -> Result<(), Failure> {
    let python = python();
    let program = match std::env::var(PROGRAM) {
        Ok(program) => program,
        Err(_) => std::env::current_exe()
            .map_err(|error| {
                Failure::Usage(format!("the path of this program cannot be determined: {error}"))
            })?
            .to_string_lossy()
            .into_owned(),
    };
    let out =
        std::path::absolute(out).map_err(|error| Failure::Usage(format!("{}: {error}", out.display())))?;
    let mut command = Command::new(&python);
    command.args(["-m", "boresight.dask_engine", "--program", &program, "--out"]).arg(&out);
    match address {
        Some(address) => command.args(["--scheduler", address]),
        None => command.args(["--workers", &workers.to_string()]),
    };
    command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().map_err(|error| {
        Failure::Usage(format!("--engine dask: `{python}` cannot be started ({error}); {INSTALL}"))
    })?;
    // Both pipes are read while the driver runs, to keep it from blocking on them.
    let mut errors = child.stderr.take().map(BufReader::new);
    let log = std::thread::spawn(move || {
        let mut text = String::new();
        if let Some(errors) = &mut errors {
            // Output that cannot be read is not reported.
            let _ = std::io::Read::read_to_string(errors, &mut text);
        }
        text
    });
    if let Some(mut input) = child.stdin.take() {
        // A driver that ends immediately reports the reason by its exit status.
        let _ = input.write_all(plan.as_bytes());
    }
    for line in
        child.stdout.take().map(BufReader::new).into_iter().flat_map(BufRead::lines).map_while(Result::ok)
    {
        if let Ok(finished) = serde_json::from_str::<FinishedShard>(&line) {
            done(finished.shard);
        }
    }
    let status = child
        .wait()
        .map_err(|error| Failure::Usage(format!("--engine dask: waiting for `{python}` failed: {error}")))?;
    let log = log.join().unwrap_or_default();
    if status.success() {
        Ok(())
    } else {
        Err(Failure::Usage(format!("--engine dask: the driver failed ({status}):\n{}", log.trim_end())))
    }
}

/// Message from the driver about each shard.
#[derive(serde::Deserialize)]
struct FinishedShard {
    shard: u64,
}
