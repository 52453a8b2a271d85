//! Scenario that flies the pointings of the frames of a camera.

use camera_fit::{CameraFit, FittedFrame};
use files::format_utc;
use flight_dynamics::{Aem, AemSegment, AttitudeNode, BODY_FRAME, Header};
use hifitime::{Epoch, Unit};
use sim::truth::clock;

use crate::{FrameSet, Origin, TwinCamera, camera_toml};

/// Time between the frames of a twin, s: the camera rests about each.
const CADENCE_S: i64 = 60;

/// Time about a frame within which its attitude may be used, s.
const MARGIN_S: i64 = 20;

/// Name of the spacecraft in the message of attitudes.
const OBJECT: &str = "TWIN";

/// Returns the attitudes of the frames of a fit: a segment per frame, in their order, 60 s apart from `time`.
/// The camera is the body.
pub fn pointings(fit: &CameraFit, time: Epoch) -> Aem {
    let mut segments = Vec::with_capacity(fit.frames.len());
    for (index, frame) in fit.frames.iter().enumerate() {
        segments.extend(segment(frame, frame_time(time, index)));
    }
    let comments = vec!["Attitudes of the frames of a camera, by their stars.".to_owned()];
    let now = std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH);
    let seconds = i64::try_from(now.map_or(0, |now| now.as_secs())).unwrap_or(0);
    let creation_time = clock::from_unix_ns(seconds.saturating_mul(1_000_000_000));
    let header = Header { originator: "BORESIGHT".to_owned(), creation_time, message_id: None, comments };
    Aem { header, segments }
}

fn frame_time(time: Epoch, index: usize) -> Epoch {
    time + CADENCE_S * index as i64 * Unit::Second
}

/// Returns the segment of a frame: the same attitude at its begin and end.
fn segment(frame: &FittedFrame, middle: Epoch) -> Option<AemSegment> {
    let margin = MARGIN_S * Unit::Second;
    let attitudes = [middle - margin, middle, middle + margin]
        .map(|time| AttitudeNode::from_rotation(time, &frame.camera_from_icrs));
    AemSegment::from_attitudes(OBJECT, BODY_FRAME, attitudes.to_vec())
}

/// Returns the scenario of a twin: its camera at the pointings of the file `attitudes`, with no target that a
/// camera could see.
pub fn scenario_text(set: &FrameSet, twin: &TwinCamera, origin: &Origin<'_>, attitudes: &str) -> String {
    let camera = camera_toml(&set.fit, twin, origin);
    let exposure_s = origin.exposure_s;
    // The escapes of a JSON string are those of TOML.
    let attitudes = serde_json::Value::from(attitudes);
    format!(
        "# The twin of a camera: the pointings of {count} frames of it, with what was fitted to them.\n\
         # `boresight compare DIR THIS_FILE` states where its frames differ from those of the camera.\n\
         title = \"Twin of a camera: {count} frames\"\n\
         seed = 1\n\
         solar_system = \"on\"\n\n\
         [catalog]\n\
         source = \"hipparcos2\"\n\
         magnitude_limit = 15.0\n\n\
         [star_list]\n\
         magnitude_limit = 10.0\n\n\
         {camera}\n\
         [mounting] # the camera is the body\n\
         nominal = {{ phi_deg = 0.0, theta_deg = 0.0, psi_deg = 0.0 }}\n\
         actual = {{ phi_deg = 0.0, theta_deg = 0.0, psi_deg = 0.0 }}\n\n\
         [attitude]\n\
         guidance = {{ mode = \"aem\", file = {attitudes} }}\n\
         motion_smear = \"off\"\n\n\
         [knowledge]\n\n\
         [shutter]\n\
         mode = \"fixed\"\n\
         exposure_s = {exposure_s:?}\n\n\
         [target] # no camera sees it\n\
         kind = \"beacon\"\n\
         magnitude_at_1_km = 30.0\n\n\
         [orbit] # slow, so that aberration is that of the centre of the Earth, as in the fit, within 1.4\"\n\
         epoch_utc = \"{epoch}\"\n\n\
         [orbit.target]\n\
         semi_major_axis_km = 100000.0\n\
         eccentricity = 0.001\n\
         inclination_deg = 30.0\n\
         raan_deg = 0.0\n\
         argument_of_perigee_deg = 0.0\n\
         mean_anomaly_deg = 0.0\n\n\
         [orbit.relative]\n\
         a_da_m = 0.0\n\
         a_dlambda_m = -10000.0\n\
         a_dex_m = 0.0\n\
         a_dey_m = 0.0\n\
         a_dix_m = 0.0\n\
         a_diy_m = 0.0\n\n\
         [[schedule]]\n\
         name = \"frames\"\n\
         start_utc = \"{epoch}\"\n\
         cadence_s = {CADENCE_S}.0\n\
         count = {count}\n",
        count = set.fit.frames.len(),
        epoch = format_utc(origin.time),
    )
}
