//! Sources of frames: a live run, or a run directory.
use std::any::Any;
use std::ops::Range;
use std::path::{Path, PathBuf};

use axum::body::Bytes;
use files::{Checksums, Failure, Row, TableReader};
use hifitime::Epoch;
use run::{AnyFactory, AnyMission, DockingMission, FarRangeMission, World};
use serde_json::Value;

use crate::ground::GroundTrack;
use crate::session::picture::Stretch;
use crate::session::{PictureOrder, Session};

/// Maximum number of frames of a monitored run: the data of each are kept, some kilobytes.
pub const MAX_FRAMES: u64 = 50_000;

/// Takes a scenario if it belongs to a certain world.
type WorldCast = fn(Box<dyn Any>) -> Result<Box<dyn MonitoredWorld>, Box<dyn Any>>;

/// Worlds that the page shows, one line each.
const WORLDS: [(&str, WorldCast); 2] = [
    (FarRangeMission::CODE, cast_world::<FarRangeMission>),
    (DockingMission::CODE, cast_world::<DockingMission>),
];

fn cast_world<W: MonitoredWorld + 'static>(
    prepared: Box<dyn Any>,
) -> Result<Box<dyn MonitoredWorld>, Box<dyn Any>> {
    prepared.downcast::<W>().map(|prepared| prepared as Box<dyn MonitoredWorld>)
}

/// A scenario of a world that the page shows.
pub(super) trait MonitoredWorld: Send + Sync {
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
pub(super) type Serve<'a> =
    &'a dyn Fn(&mut dyn FnMut(&PictureOrder) -> Result<Bytes, Failure>) -> Result<(), Failure>;

/// A monitored scenario with its measurements.
pub struct Feed {
    pub(super) world: Box<dyn MonitoredWorld>,
    pub(super) measurements: Measurements,
}

impl Feed {
    /// Creates the feed of a run, with `measurements` that are being made or were made.
    ///
    /// # Errors
    /// [`Failure::Usage`] for a world that the page does not show.
    pub fn new(prepared: Box<dyn AnyMission>, measurements: Measurements) -> Result<Self, Failure> {
        let mut prepared = prepared.into_any();
        for (_, take) in WORLDS {
            match take(prepared) {
                Ok(world) => return Ok(Self { world, measurements }),
                Err(other) => prepared = other,
            }
        }
        let worlds = WORLDS.map(|(code, _)| code).join(" and ");
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
    pub(super) fn mode(&self) -> &'static str {
        match self {
            Self::Live { .. } => "live",
            Self::Replay(_) => "replay",
        }
    }
}

/// Data of a feed that live as long as the monitor.
pub(super) struct MonitorContext {
    pub(super) ground: Option<GroundTrack>,
    pub(super) stretch: Stretch,
    pub(super) frames: Range<u64>,
}

/// Returns the frames of a live run, or those of a run directory. The frames of a directory must be
/// consecutive, as those of a run are.
pub(super) fn frames<R: Row>(measurements: &Measurements, table: &str) -> Result<Range<u64>, Failure> {
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
pub(super) fn optional(path: &Path) -> Option<PathBuf> {
    path.is_file().then(|| path.to_owned())
}
