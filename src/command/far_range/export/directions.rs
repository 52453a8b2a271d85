//! Tracking data message of the measured lines of sight.

use std::path::Path;

use contract::Solution;
use far_range::FarRangeScenario;
use far_range::rows::{CameraFile, read_measurements, read_telemetry};
use files::Failure;
use flight_dynamics::{Observation, ReferenceFrame, Tdm, TdmSegment, TimeSystem};
use scenario::run_file::RunFile;

use super::parts::{CHASER, TARGET, header, telemetry_of};

/// Returns the measured lines of sight with the times of telemetry. The format has no covariance; the comment
/// has the root mean square of the standard deviations.
pub(super) fn tdm(directory: &Path, run: &RunFile<FarRangeScenario>) -> Result<Tdm, Failure> {
    let camera = CameraFile::read(&directory.join("camera.toml"))?;
    let path = directory.join("measurements.csv");
    let telemetry = read_telemetry(&directory.join("telemetry.csv"))?;
    let mut observations = Vec::new();
    let (mut squares, mut known) = ([0.0; 2], 0_u32);
    for (frame, outcome) in read_measurements(&path, &camera.camera)? {
        let Solution::Detected(measurement) = outcome.solution else { continue };
        let Some(line_of_sight) = measurement.line_of_sight else { continue };
        let row = telemetry_of(directory, &telemetry, frame)?;
        observations.push(Observation::from_direction(row.telemetry.time, &line_of_sight));
        if let Some(covariance) = measurement.line_of_sight_covariance {
            let [xx, _, yy] = covariance.matrix();
            squares = [squares[0] + xx, squares[1] + yy];
            known += 1;
        }
    }
    let unique = observations.windows(2).all(|pair| pair.iter().map(|o| o.time).is_sorted_by(|a, b| a < b));
    if observations.is_empty() || !unique {
        let reason = if unique { "no lines of sight" } else { "times that do not ascend" };
        return Err(Failure::Usage(format!(
            "{}: has {reason}, which a tracking data message needs",
            path.display()
        )));
    }
    let mut comments = vec![
        "Measured direction from the observer to the target, without aberration: geometric, as the target moves \
         with the observer."
            .to_owned(),
    ];
    if known > 0 {
        let [across, along] = squares.map(|sum| (sum / f64::from(known)).sqrt().to_degrees());
        comments.push(format!(
            "Standard deviations along the camera's x and y, root mean square of {known}: {across:.3e} {along:.3e} deg"
        ));
        comments.push(
            "The format has no covariance; that of each direction is in measurements.csv of the run."
                .to_owned(),
        );
    }
    let segment = TdmSegment {
        comments,
        observer: CHASER.to_owned(),
        target: TARGET.to_owned(),
        frame: ReferenceFrame::Icrf,
        time_system: TimeSystem::Utc,
        observations,
    };
    Ok(Tdm { header: header(run, Vec::new()), segments: vec![segment] })
}
