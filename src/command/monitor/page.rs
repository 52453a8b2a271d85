//! Server of the page, with data from a live run or from a run directory.

use std::net::SocketAddr;
use std::path::Path;

use files::Failure;
use monitor::{Feed, Measurements, serve};
use run::{Options, ScenarioSource};
use scenario::BUILT_IN;
use serde_json::json;

use super::MonitorArguments;
use crate::command::Answer;
use crate::command::options::FrameRange;
use crate::command::output::Output;
use crate::command::scratch_directory::ScratchDirectory;

pub(in crate::command) fn monitor(arguments: &MonitorArguments, output: &Output) -> Result<Answer, Failure> {
    let directory = Path::new(&arguments.selection.scenario);
    // The server handles signals itself.
    let scratch = ScratchDirectory::create(&std::env::temp_dir())?;
    // A built-in scenario takes precedence over a directory of the same name, as in `run`: the directory is
    // `./NAME`.
    let is_built_in = BUILT_IN.iter().any(|built_in| built_in.name == arguments.selection.scenario);
    let (name, feed) = if directory.is_dir() && !is_built_in {
        arguments.check_replay()?;
        replay(directory)?
    } else {
        live(arguments, scratch.path())?
    };
    let mut announced = Ok(());
    let ready = |address: SocketAddr| {
        let url = format!("http://{address}/");
        output.note(format!("{name}: {url} (Ctrl-C ends)"));
        announced = output.document(&json!({ "url": url, "scenario": name }));
    };
    serve(&feed, arguments.bind, ready, interrupted())?;
    announced?;
    Ok(Answer::Yes)
}

impl MonitorArguments {
    /// Rejects options that cannot apply to a finished run.
    fn check_replay(&self) -> Result<(), Failure> {
        let given = [
            ("--frames", self.selection.frames.is_some()),
            ("--from", self.from.is_some()),
            ("--seed", self.selection.seed.is_some()),
            ("--pipeline", self.pipeline.pipeline.is_some()),
        ];
        match given.iter().find(|(_, is_given)| *is_given) {
            Some((option, _)) => Err(Failure::Usage(format!(
                "{option} applies only to a scenario: the run directory {} is replayed unchanged",
                self.selection.scenario
            ))),
            None => Ok(()),
        }
    }

    /// Returns the requested frames of a scenario with `count` frames.
    fn frames(&self, count: u64) -> Result<std::ops::Range<u64>, Failure> {
        match self.from {
            Some(from) if from >= count => Err(Failure::Usage(format!(
                "--from is {from}, expected a frame of the scenario, which has {count} (0..{count})"
            ))),
            Some(from) => Ok(FrameRange(from..count).0),
            None => self.selection.frames(count),
        }
    }
}

/// Returns the feed of a run that is simulated and processed while it is displayed.
fn live(arguments: &MonitorArguments, scratch: &Path) -> Result<(String, Feed), Failure> {
    let source = arguments.selection.scenario()?;
    let prepared = source.prepare(Options::default())?;
    let (frames, jobs) = (arguments.frames(prepared.frame_count())?, arguments.selection.jobs());
    let factory =
        prepared.factory(&arguments.pipeline.choice(&[Path::new(&arguments.selection.scenario)]), scratch)?;
    Ok((source.name, Feed::new(prepared, Measurements::Live { factory, frames, jobs })?))
}

/// Returns the feed of a run directory: its measurements and truth are read unchanged, its pictures are drawn
/// again.
fn replay(directory: &Path) -> Result<(String, Feed), Failure> {
    let run = directory.join("run.toml");
    if !run.is_file() {
        return Err(Failure::Usage(format!(
            "{}: no run.toml in it, expected a run directory (boresight run … --out DIR)",
            directory.display()
        )));
    }
    let source = ScenarioSource::read(&run.to_string_lossy())?;
    let truth = source.world().facts().truth_file;
    // A table has its final name only when it is complete.
    if let Some(missing) =
        [truth, "telemetry.csv", "measurements.csv"].iter().find(|name| !directory.join(name).is_file())
    {
        return Err(Failure::Usage(format!(
            "{}: has run.toml but no {missing}, expected the directory of a finished run: this run is still \
             in progress, was killed, or has unprocessed frames. `boresight monitor SCENARIO` shows a run \
             while it is simulated",
            directory.display()
        )));
    }
    Ok((
        source.name.clone(),
        Feed::new(source.prepare(Options::default())?, Measurements::Replay(directory.to_owned()))?,
    ))
}

/// Completes on Ctrl-C and, on systems that have one, on a termination request.
async fn interrupted() {
    let interrupt = async {
        // Without a handler the signal itself ends the process.
        if tokio::signal::ctrl_c().await.is_err() {
            std::future::pending::<()>().await;
        }
    };
    #[cfg(unix)]
    {
        use tokio::signal::unix::{SignalKind, signal};
        if let Ok(mut terminate) = signal(SignalKind::terminate()) {
            tokio::select! {
                () = interrupt => {}
                _ = terminate.recv() => {}
            }
            return;
        }
    }
    interrupt.await;
}
