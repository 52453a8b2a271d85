//! Sources of frames: a live run, or a run directory.
use std::any::Any;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::{PoisonError, RwLock};

use axum::body::Bytes;
use files::{Checksums, Failure, Row, TableReader};
use hifitime::Epoch;
use run::{AnyFactory, AnyMission};
use serde_json::Value;

use crate::ground::GroundTrack;
use crate::session::picture::Stretch;
use crate::session::{PictureOrder, Session};

/// Maximum number of frames of a monitored run: the data of each are kept, some kilobytes.
pub const MAX_FRAMES: u64 = 50_000;

/// Takes a mission if it belongs to a certain world.
pub type WorldCast = fn(Box<dyn Any>) -> Result<Box<dyn MonitoredWorld>, Box<dyn Any>>;

/// Worlds that the page shows, by their codes.
static WORLDS: RwLock<Vec<(&str, WorldCast)>> = RwLock::new(Vec::new());

/// Registers a world that the page shows, for the rest of the process.
pub fn register(code: &'static str, cast: WorldCast) {
    let mut worlds = WORLDS.write().unwrap_or_else(PoisonError::into_inner);
    if worlds.iter().all(|(known, _)| *known != code) {
        worlds.push((code, cast));
    }
}

/// A scenario of a world that the page shows.
pub trait MonitoredWorld: Send + Sync {
    /// Returns the data that live as long as the monitor.
    fn context(&self, measurements: &Measurements) -> Result<MonitorContext, Failure>;

    /// Returns the time of a frame, or `None` if the frame does not exist.
    fn time(&self, frame: u64) -> Option<Epoch>;

    /// Returns the data that the page receives once: those of the session, and those of the scene.
    fn overview(&self, measurements: &Measurements, context: &MonitorContext) -> Result<[Value; 2], Failure>;

    /// Processes or reads consecutive frames, up to the session's goal.
    fn feed(
        &self,
        measurements: &Measurements,
        context: &MonitorContext,
        session: &Session,
    ) -> Result<(), Failure>;

    /// Draws frames again by means of `serve`, as grey bytes.
    fn paint(&self, context: &MonitorContext, serve: Serve<'_>) -> Result<(), Failure>;
}

/// Calls a drawing function for each ordered picture in turn.
pub type Serve<'a> =
    &'a dyn Fn(&mut dyn FnMut(&PictureOrder) -> Result<Bytes, Failure>) -> Result<(), Failure>;

/// A monitored scenario with its measurements.
pub struct Feed {
    pub(crate) world: Box<dyn MonitoredWorld>,
    pub(crate) measurements: Measurements,
}

impl Feed {
    /// Creates the feed of a run, with `measurements` that are being made or were made.
    ///
    /// # Errors
    /// [`Failure::Usage`] for a world that the page does not show.
    pub fn new(prepared: Box<dyn AnyMission>, measurements: Measurements) -> Result<Self, Failure> {
        let mut prepared: Box<dyn Any> = prepared;
        let worlds = WORLDS.read().unwrap_or_else(PoisonError::into_inner);
        for (_, cast) in worlds.iter() {
            match cast(prepared) {
                Ok(world) => return Ok(Self { world, measurements }),
                Err(other) => prepared = other,
            }
        }
        let codes: Vec<&str> = worlds.iter().map(|(code, _)| *code).collect();
        let worlds = codes.join(" and ");
        Err(Failure::Usage(format!("the monitor supports only the worlds {worlds}")))
    }
}

/// Source of the measurements.
pub enum Measurements {
    /// A pipeline that runs now, on frames from several threads.
    Live {
        /// Factory of the pipeline.
        factory: AnyFactory,
        /// Range of frames.
        frames: Range<u64>,
        /// Number of threads.
        jobs: usize,
    },
    /// An earlier run, whose files are in this directory.
    Replay(PathBuf),
}

impl Measurements {
    /// Returns the name of the mode on the page.
    pub fn mode(&self) -> &'static str {
        match self {
            Self::Live { .. } => "live",
            Self::Replay(_) => "replay",
        }
    }
}

/// Data of a feed that live as long as the monitor.
pub struct MonitorContext {
    /// Orbit of the spacecraft; `None` if there is none.
    pub ground: Option<GroundTrack>,
    /// Grey levels of the pictures.
    pub stretch: Stretch,
    /// Frames of the session.
    pub frames: Range<u64>,
}

/// Returns the frames of a live run, or those of a run directory. The frames of a directory must be
/// consecutive, as those of a run are.
pub fn frames<R: Row>(measurements: &Measurements, table: &str) -> Result<Range<u64>, Failure> {
    let frames = match measurements {
        Measurements::Live { frames, .. } => frames.clone(),
        Measurements::Replay(directory) => {
            let frames = numbers::<R>(&directory.join(table))?;
            Checksums::check(directory, |_| true)?;
            frames
        }
    };
    let count = frames.end - frames.start;
    if count > MAX_FRAMES {
        return Err(Failure::Usage(format!(
            "{count} frames are selected, expected at most {}, because the monitor stores every report; \
             select fewer with --frames A..B",
            MAX_FRAMES
        )));
    }
    Ok(frames)
}

/// Returns the frame range of a truth table.
fn numbers<R: Row>(path: &Path) -> Result<Range<u64>, Failure> {
    let mut frames: Option<Range<u64>> = None;
    for row in TableReader::<R>::open(path)? {
        let (number, _) = row?;
        let next = frames.as_ref().map_or(number, |frames| frames.end);
        if number != next {
            let message = format!("{}: frame {number} follows, expected {next}", path.display());
            return Err(Failure::Usage(message));
        }
        let after = number.checked_add(1).ok_or_else(|| {
            let message = format!(
                "{}: frame is {number}, the largest integer; expected a smaller number",
                path.display()
            );
            Failure::Usage(message)
        })?;
        frames = Some(frames.map_or(number, |frames| frames.start)..after);
    }
    frames.ok_or_else(|| Failure::Usage(format!("{}: has no frames, expected at least one", path.display())))
}

/// Returns the path if the file exists.
pub fn optional(path: &Path) -> Option<PathBuf> {
    path.is_file().then(|| path.to_owned())
}
