//! Where frames come from: a live run, or a run directory.
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

/// Most frames of a monitored run: what is known of each is kept, some kilobytes.
pub const MAX_FRAMES: u64 = 50_000;

/// Takes a scenario if it is of a certain world.
type WorldCast = fn(Box<dyn Any>) -> Result<Box<dyn MonitoredWorld>, Box<dyn Any>>;

/// The worlds that the page shows: one line each.
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
    /// What lives as long as the monitor.
    fn context(&self, measurements: &Measurements) -> Result<MonitorContext, Failure>;

    /// The moment of a frame; `None` where there is no such frame.
    fn time(&self, frame: u64) -> Option<Epoch>;

    /// What the page is told once: of the session, and of the scene.
    fn overview(&self, measurements: &Measurements, context: &MonitorContext) -> Result<[Value; 2], Failure>;

    /// Processes or reads frame after frame, as far as they are wanted.
    fn feed(
        &self,
        measurements: &Measurements,
        context: &MonitorContext,
        session: &Session,
    ) -> Result<(), Failure>;

    /// Has `serve` draw frames again, as PNG.
    fn paint(&self, context: &MonitorContext, serve: Serve<'_>) -> Result<(), Failure>;
}

/// Draws one picture after the other by a function, as they are ordered.
pub(super) type Serve<'a> =
    &'a dyn Fn(&mut dyn FnMut(&PictureOrder) -> Result<Bytes, Failure>) -> Result<(), Failure>;

/// What is monitored.
pub struct Feed {
    pub(super) world: Box<dyn MonitoredWorld>,
    pub(super) measurements: Measurements,
}

impl Feed {
    /// A run that `measurements` are made or were made of.
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
        Err(Failure::Usage(format!("the monitor shows the worlds {worlds} alone")))
    }
}

/// Who measures.
pub enum Measurements {
    /// A pipeline, now, on frames that so many threads make.
    Live {
        /// Builds the pipeline.
        factory: AnyFactory,
        /// The frames.
        frames: Range<u64>,
        /// Threads.
        jobs: usize,
    },
    /// A pipeline did, in a run whose files are in this directory.
    Replay(PathBuf),
}

impl Measurements {
    /// The word that the page has for it.
    pub(super) fn mode(&self) -> &'static str {
        match self {
            Self::Live { .. } => "live",
            Self::Replay(_) => "replay",
        }
    }
}

/// What a feed needs that lives as long as the monitor.
pub(super) struct MonitorContext {
    pub(super) ground: Option<GroundTrack>,
    pub(super) stretch: Stretch,
    pub(super) frames: Range<u64>,
}

/// The frames of a live run, or those of a run directory, which must be without gaps: a run's are.
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
            "{count} frames are monitored, expected at most {}: what is known of each is kept (--frames A..B)",
            MAX_FRAMES
        )));
    }
    Ok(frames)
}

/// First and last frame of a table of the truth.
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
                "{}: frame {number} is the last number there is, expected a smaller one",
                path.display()
            );
            Failure::Usage(message)
        })?;
        frames = Some(frames.map_or(number, |frames| frames.start)..after);
    }
    frames.ok_or_else(|| Failure::Usage(format!("{}: no frame, expected one or more", path.display())))
}

/// A file, if it is there.
pub(super) fn optional(path: &Path) -> Option<PathBuf> {
    path.is_file().then(|| path.to_owned())
}
