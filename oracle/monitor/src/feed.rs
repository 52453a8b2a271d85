//! Where frames come from: a live run, or a run directory.
use std::ops::Range;
use std::path::{Path, PathBuf};

use contract::docking::Digitiser;
use files::docking::{FeatureRow, read_field_measurements, read_motion};
use files::{Checksums, Failure, FrameCluster, Row, TableReader, read_field_telemetry, read_measurements};
use run::{AnyFactory, AnyPrepared, Prepared, PreparedDocking, SceneTruth, World};
use sim::docking::FieldTruth;
use sim::truth::{FrameTruth, ObjectTruth, Trajectory};

use super::docking_report::DockingReporter;
use super::far_range_report::FarRangeReporter;
use super::ground::GroundTrack;
use super::picture::Stretch;
use super::session::Session;

/// Most frames of a monitored run: what is known of each is kept, some kilobytes.
pub const MOST_FRAMES: u64 = 50_000;

/// What is monitored.
pub enum Feed {
    /// Star fields with a distant spacecraft.
    FarRange(Box<Prepared>, Measurements),
    /// The approach to a docking target.
    Docking(Box<PreparedDocking>, Measurements),
}

impl Feed {
    /// A run that `measurements` are made or were made of.
    ///
    /// # Errors
    /// [`Failure::Usage`] for a world that the page does not show.
    pub fn new(prepared: Box<dyn AnyPrepared>, measurements: Measurements) -> Result<Self, Failure> {
        match prepared.into_any().downcast::<Prepared>() {
            Ok(prepared) => Ok(Self::FarRange(prepared, measurements)),
            Err(other) => match other.downcast() {
                Ok(prepared) => Ok(Self::Docking(prepared, measurements)),
                Err(_) => {
                    Err(Failure::Usage("the monitor shows the worlds far_range and docking alone".to_owned()))
                }
            },
        }
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
pub(super) struct Surroundings {
    pub(super) ground: Option<GroundTrack>,
    pub(super) trajectory: Option<Trajectory>,
    pub(super) stretch: Stretch,
    pub(super) frames: Range<u64>,
}

impl Surroundings {
    pub(super) fn of(feed: &Feed) -> Result<Self, Failure> {
        match feed {
            Feed::FarRange(prepared, measurements) => {
                let scenario = prepared.scenario();
                let trajectory = Trajectory::new(&scenario.orbit)?;
                Ok(Self {
                    ground: Some(GroundTrack::Chaser(Box::new(trajectory.clone()))),
                    trajectory: Some(trajectory),
                    stretch: Stretch::of_sensor(&scenario.sensor),
                    frames: frames(measurements, Prepared::TRUTH_FILE, numbers::<FrameTruth>)?,
                })
            }
            Feed::Docking(prepared, measurements) => Ok(Self {
                ground: GroundTrack::station(prepared.simulator()),
                trajectory: None,
                stretch: Stretch::plain(),
                frames: frames(measurements, PreparedDocking::TRUTH_FILE, numbers::<FieldTruth>)?,
            }),
        }
    }
}

/// The frames of a live run, or those of a run directory, which must be without gaps: a run's are.
fn frames(
    measurements: &Measurements,
    table: &str,
    numbers: fn(&Path) -> Result<Range<u64>, Failure>,
) -> Result<Range<u64>, Failure> {
    let frames = match measurements {
        Measurements::Live { frames, .. } => frames.clone(),
        Measurements::Replay(directory) => {
            let frames = numbers(&directory.join(table))?;
            Checksums::check(directory, |_| true)?;
            frames
        }
    };
    let count = frames.end - frames.start;
    if count > MOST_FRAMES {
        return Err(Failure::Usage(format!(
            "{count} frames are monitored, expected at most {}: what is known of each is kept (--frames A..B)",
            MOST_FRAMES
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

/// Processes or reads frame after frame, as far as they are wanted.
///
/// # Errors
/// The first [`Failure`] in the order of the frames, also that the monitor was closed.
pub(super) fn feed(feed: &Feed, surroundings: &Surroundings, session: &Session) -> Result<(), Failure> {
    match feed {
        Feed::FarRange(prepared, measurements) => {
            let Some((trajectory, ground)) =
                surroundings.trajectory.as_ref().zip(surroundings.ground.as_ref())
            else {
                return Ok(());
            };
            let schedule = prepared.simulator().schedule();
            let Some((_, start)) = schedule.frame(0) else { return Ok(()) };
            let camera = &prepared.scenario().camera;
            let reporter = FarRangeReporter { camera, trajectory, ground, start };
            match measurements {
                Measurements::Live { factory, frames, jobs } => {
                    prepared.follow(frames.clone(), *jobs, factory.of()?, |processed| {
                        let SceneTruth { frame: truth, objects } = &processed.truth;
                        session.wait_for_goal(truth.frame)?;
                        let report = reporter.report(truth, objects, Some(&processed.outcome));
                        let picture = surroundings.stretch.picture(&processed.image);
                        session.publish(&report, Digitiser::default(), Some(picture))
                    })
                }
                Measurements::Replay(directory) => replay_far_range(directory, &reporter, session),
            }
        }
        Feed::Docking(prepared, measurements) => {
            let names = prepared.scenario().cameras.iter().map(|camera| camera.name.clone()).collect();
            let mut reporter = DockingReporter::new(prepared.setup(), names, surroundings.ground.as_ref());
            match measurements {
                Measurements::Live { factory, frames, jobs } => {
                    prepared.follow(frames.clone(), *jobs, factory.of()?, |processed| {
                        let number = processed.image.number();
                        session.wait_for_goal(number)?;
                        let features = FeatureRow::of(number, &processed.outcome.features);
                        let report = reporter.report(&processed.truth, Some(&processed.outcome), &features);
                        let picture = surroundings.stretch.picture(processed.image.image());
                        session.publish(&report, processed.telemetry.digitiser, Some(picture))
                    })
                }
                Measurements::Replay(directory) => replay_docking(directory, &mut reporter, session),
            }
        }
    }
}

fn replay_far_range(
    directory: &Path,
    reporter: &FarRangeReporter<'_>,
    session: &Session,
) -> Result<(), Failure> {
    let mut objects = TableReader::<ObjectTruth>::open(&directory.join("truth/objects.parquet"))?;
    let mut clusters = optional(&directory.join("clusters.parquet"))
        .map(|path| TableReader::<FrameCluster>::open(&path))
        .transpose()?;
    let mut answers =
        read_measurements(&directory.join("measurements.csv"), reporter.camera)?.into_iter().peekable();
    for row in TableReader::<FrameTruth>::open(&directory.join("truth/frames.parquet"))? {
        let (number, truths) = row?;
        session.wait_for_goal(number)?;
        let objects = objects.rows_of(number)?;
        let found = clusters.as_mut().map(|table| table.rows_of(number)).transpose()?.unwrap_or_default();
        let answer = answers.next_if(|(answered, _)| *answered == number).map(|(_, mut outcome)| {
            outcome.clusters = found.into_iter().map(|row| row.cluster).collect();
            outcome
        });
        for truth in truths.iter().take(1) {
            let report = reporter.report(truth, &objects, answer.as_ref());
            session.publish(&report, Digitiser::default(), None)?;
        }
    }
    Ok(())
}

fn replay_docking(
    directory: &Path,
    reporter: &mut DockingReporter<'_>,
    session: &Session,
) -> Result<(), Failure> {
    let mut features = optional(&directory.join("features.parquet"))
        .map(|path| TableReader::<FeatureRow>::open(&path))
        .transpose()?;
    let motion = optional(&directory.join("motion.csv")).map(|path| read_motion(&path)).transpose()?;
    let mut motion = motion.unwrap_or_default().into_iter().peekable();
    let mut answers = read_field_measurements(&directory.join("measurements.csv"))?.into_iter().peekable();
    let mut telemetry = read_field_telemetry(&directory.join("telemetry.csv"))?.into_iter().peekable();
    for row in TableReader::<FieldTruth>::open(&directory.join("truth/fields.parquet"))? {
        let (number, truths) = row?;
        session.wait_for_goal(number)?;
        let features = features.as_mut().map(|table| table.rows_of(number)).transpose()?.unwrap_or_default();
        let said = motion.next_if(|(reported, _)| *reported == number).map(|(_, report)| report);
        let answer = answers.next_if(|(answered, _)| *answered == number).map(|(_, mut outcome)| {
            outcome.motion = said;
            outcome
        });
        let digitiser = telemetry
            .next_if(|row| row.field == number)
            .map_or_else(Digitiser::default, |row| row.telemetry.digitiser);
        for truth in truths.iter().take(1) {
            session.publish(&reporter.report(truth, answer.as_ref(), &features), digitiser, None)?;
        }
    }
    Ok(())
}

fn optional(path: &Path) -> Option<PathBuf> {
    path.is_file().then(|| path.to_owned())
}
