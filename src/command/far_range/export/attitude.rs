//! Attitude ephemeris messages: the true and the measured attitude of the chaser's body or camera.

use std::collections::BTreeMap;
use std::path::Path;

use clap::ValueEnum;
use contract::{AttitudeSource, CameraFrame, Icrs, Rotation};
use far_range::FarRangeScenario;
use far_range::rows::{CameraFile, read_measurements, read_telemetry};
use files::Failure;
use flight_dynamics::{Aem, AemSegment, AttitudeNode, BODY_FRAME, CAMERA_FRAME};
use hifitime::Epoch;
use scenario::run_file::RunFile;
use sim::truth::Schedule;

use super::parts::{CHASER, Export, header, true_frames};

/// Frame whose attitude a message has.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, ValueEnum)]
pub(super) enum AttitudeFrame {
    /// Body of the chaser, SC_BODY_1
    #[default]
    Body,
    /// Camera, INSTRUMENT_1
    Camera,
}

impl AttitudeFrame {
    /// Name in a message.
    fn name(self) -> &'static str {
        match self {
            Self::Body => BODY_FRAME,
            Self::Camera => CAMERA_FRAME,
        }
    }
}

/// Returns the true attitude at the frames, and at the begin of the first and the end of the last exposure of
/// each group; each group is a segment.
pub(super) fn true_attitude(
    directory: &Path,
    run: &RunFile<FarRangeScenario>,
    frame: AttitudeFrame,
) -> Result<Export<Aem>, Failure> {
    let trajectory = run.scenario.trajectory()?;
    let attitude = run.scenario.true_attitude(trajectory.epoch())?;
    let camera_from_body = run.scenario.mounting.actual.camera_from_body();
    let at = |time: Epoch, number: u64| {
        let body_from_icrs = attitude.truth(&trajectory.states_at(time), number);
        match frame {
            AttitudeFrame::Body => AttitudeNode::from_rotation(time, &body_from_icrs),
            AttitudeFrame::Camera => AttitudeNode::from_rotation(time, &(camera_from_body * body_from_icrs)),
        }
    };
    let frames = true_frames(directory, run)?;
    let groups = frames.chunk_by(|a, b| a.group == b.group).filter_map(|group| {
        let (first, last) = group.first().zip(group.last())?;
        let before = at(run.scenario.needed_about(first.time).start, first.frame);
        let after = at(run.scenario.needed_about(last.time).stop, last.frame);
        let during = group.iter().map(|truth| match frame {
            AttitudeFrame::Body => AttitudeNode::from_rotation(truth.time, &truth.body_from_icrs),
            AttitudeFrame::Camera => AttitudeNode::from_rotation(truth.time, &truth.camera_from_icrs),
        });
        Some([before].into_iter().chain(during).chain([after]).collect())
    });
    message(run, frame, groups.collect(), Vec::new())
}

/// Returns the attitude of the camera that the pipeline states, or that of the body by the nominal mounting.
/// A frame without one, and the end of a group, end a segment; an attitude between two such frames is left
/// out, because a segment has a span.
pub(super) fn measured_attitude(
    directory: &Path,
    run: &RunFile<FarRangeScenario>,
    frame: AttitudeFrame,
) -> Result<Export<Aem>, Failure> {
    let camera = CameraFile::read(&directory.join("camera.toml"))?;
    let path = directory.join("measurements.csv");
    let measured: BTreeMap<u64, (Rotation<CameraFrame, Icrs>, Option<AttitudeSource>)> =
        read_measurements(&path, &camera.camera)?
            .into_iter()
            .filter_map(|(number, outcome)| {
                Some((number, (outcome.camera_from_icrs?, outcome.attitude_source)))
            })
            .collect();
    if measured.is_empty() {
        return Err(Failure::Usage(format!(
            "{}: has no attitudes of the camera, which a message of attitudes needs",
            path.display()
        )));
    }
    let body_from_camera = run.scenario.mounting.nominal.camera_from_body().inverse();
    let schedule = Schedule::new(&run.scenario.schedule)?;
    let mut segments: Vec<Vec<AttitudeNode>> = Vec::new();
    // Group of the frame before, if it has an attitude.
    let mut continued = None;
    for row in read_telemetry(&directory.join("telemetry.csv"))? {
        let Some((camera_from_icrs, _)) = measured.get(&row.frame) else {
            continued = None;
            continue;
        };
        let time = row.telemetry.time;
        let node = match frame {
            AttitudeFrame::Body => AttitudeNode::from_rotation(time, &(body_from_camera * *camera_from_icrs)),
            AttitudeFrame::Camera => AttitudeNode::from_rotation(time, camera_from_icrs),
        };
        let group = schedule.group_of(row.frame);
        match segments.last_mut() {
            Some(segment) if continued == Some(group) => segment.push(node),
            _ => segments.push(vec![node]),
        }
        continued = Some(group);
    }
    let by_stars =
        measured.values().filter(|(_, source)| source.is_some_and(AttitudeSource::is_by_stars)).count();
    let mut comments = vec![format!(
        "Attitudes of the camera that the pipeline states: {} by stars of the frame, {} by others or not stated.",
        by_stars,
        measured.len() - by_stars
    )];
    if frame == AttitudeFrame::Body {
        comments.push("The body is that of the camera by its nominal mounting.".to_owned());
    }
    message(run, frame, segments, comments)
}

/// Returns the message of the segments that have a span.
fn message(
    run: &RunFile<FarRangeScenario>,
    frame: AttitudeFrame,
    segments: Vec<Vec<AttitudeNode>>,
    comments: Vec<String>,
) -> Result<Export<Aem>, Failure> {
    let given: usize = segments.iter().map(Vec::len).sum();
    let segments: Vec<AemSegment> = segments
        .into_iter()
        .filter_map(|attitudes| AemSegment::from_attitudes(CHASER, frame.name(), attitudes))
        .collect();
    let aem = Aem { header: header(run, comments), segments };
    let left_out = given - attitude_count(&aem);
    if aem.segments.is_empty() {
        let message = "the run has no two successive attitudes, which a message of attitudes needs";
        return Err(Failure::Usage(message.to_owned()));
    }
    Ok(Export { message: aem, left_out })
}

/// Number of attitudes of a message.
pub(super) fn attitude_count(aem: &Aem) -> usize {
    aem.segments.iter().map(|segment| segment.attitudes.len()).sum()
}
