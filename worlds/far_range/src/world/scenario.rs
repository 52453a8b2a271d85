//! Scenario of the far range: its preparation, the summary of a check, and warnings.

use files::Failure;
use run::any_world::{Options, ScenarioSource};
use run::check::{FieldOfView, size};
use run::world::{WorldFacts, WorldFrames as _, WorldScenario};
use scenario::run_file::RunFile;
use serde_json::{Value, json};
use sim::Simulator;
use sim::onboard::image_bytes;

use super::dataset;
use super::mission::FarRangeMission;
use crate::scenario::FarRangeScenario;
use crate::scoring::names;

/// Signal-to-noise ratio of the faintest star that a check reports.
const LIMITING_SNR: f64 = 5.0;

/// Size of a 16-bit FITS file, bytes, including a header of about three blocks.
fn fits_bytes(columns: usize, rows: usize) -> u64 {
    const BLOCK: u64 = 2880;
    ((columns * rows * size_of::<u16>()) as u64).div_ceil(BLOCK) * BLOCK + 3 * BLOCK
}

/// Relative speed above which chaser and target pass each other, km/s.
const PASSING_KM_S: f64 = 1.0;

/// Returns a remark on spacecraft that pass each other at the first frame: their orbits are unrelated, or one
/// velocity has the wrong sign.
fn passing_speed(simulator: &Simulator) -> Option<String> {
    let (_, time) = simulator.schedule().frame(0)?;
    let states = simulator.trajectory().states_at(time);
    let speed_km_s = (states.target.velocity_km_s - states.chaser.velocity_km_s).norm();
    (speed_km_s > PASSING_KM_S).then(|| {
        format!(
            "trajectory: at the first frame chaser and target pass each other at {speed_km_s:.3} km/s, {:.3} km \
             apart; a velocity with the wrong sign, or two unrelated orbits?",
            states.range_km()
        )
    })
}

impl WorldScenario for FarRangeMission {
    const FACTS: WorldFacts = WorldFacts {
        setup_file: "camera.toml",
        truth_file: "truth/frames.parquet",
        evidence_file: Some("clusters.parquet"),
        headline: names::CORRECT_RATE,
        are_groups_apart: true,
        pictures: "png",
    };

    type Scenario = FarRangeScenario;

    fn prepare(source: &ScenarioSource, _: &FarRangeScenario, options: Options) -> Result<Self, Failure> {
        if let Some(renderer) = options.renderer.word() {
            let message = format!("--renderer {renderer} requires a docking scenario");
            return Err(Failure::Usage(message));
        }
        Self::with_options(source, options.inject, options.attitude)
    }

    fn run_file(&self) -> &RunFile<FarRangeScenario> {
        &self.run_file
    }

    fn summary(&self) -> (Value, String) {
        let (scenario, name) = (self.scenario(), &self.run_file.name);
        let (frames, stars) = (self.frame_count(), self.simulator.catalog().stars().len());
        let bit_depth = scenario.sensor.bit_depth;
        let image = image_bytes(scenario.camera.columns, scenario.camera.rows, bit_depth);
        let (budget, telemetry) = match &scenario.roi {
            None => (image, format!("whole images: {image} bytes of telemetry per frame")),
            Some(roi) => {
                let budget = roi.budget_bytes(bit_depth);
                let regions = format!("{} regions of {} × {} pixels", roi.count, roi.columns, roi.rows);
                (
                    budget,
                    format!(
                        "{regions}: at most {budget} bytes of telemetry per frame (whole image: {image})"
                    ),
                )
            }
        };
        let simulator = &self.simulator;
        let view = FieldOfView::from_projection(simulator.projection());
        let [shortest_s, longest_s] = simulator.exposures_s();
        let limit = simulator.limiting_magnitude(longest_s, LIMITING_SNR);
        let duration_s = simulator.schedule().ends().map_or(0.0, |[first, last]| (last - first).to_seconds());
        let file = fits_bytes(scenario.camera.columns, scenario.camera.rows);
        let document = json!({
            "scenario": name,
            "ok": true,
            "frames": frames,
            "stars": stars,
            "frame_bytes_at_most": budget,
            "whole_image_bytes": image,
            "field_deg": view.field_deg,
            "pixel_arcsec": view.pixel_arcsec,
            "exposure_s": [shortest_s, longest_s],
            "limiting_magnitude": limit,
            "duration_s": duration_s,
            "fits_bytes": file,
        });
        let limit = match limit {
            Some(limit) => format!(
                "the faintest star with SNR {LIMITING_SNR} in the longest exposure has V = {limit:.2}"
            ),
            None => format!("no star has SNR {LIMITING_SNR} in the longest exposure"),
        };
        let text = format!(
            "{name}: {frames} frames, {stars} stars, no mistake found\n{telemetry}\n{}\n\
             exposures of {shortest_s} s to {longest_s} s; {limit}\n\
             {frames} frames in {duration_s:.0} s; as FITS {} each, {} in total",
            view.text(),
            size(file),
            size(file.saturating_mul(frames)),
        );
        (document, text)
    }

    fn warnings(&self) -> Vec<String> {
        let beyond = dataset::sip_reach_px(&self.simulator, &self.scenario().camera).map(|reach_px| {
            format!(
                "camera.radial, camera.tangential: no SIP polynomial fits the distortion beyond \
                 {reach_px:.0} px from the principal point; FITS files are written without world coordinates"
            )
        });
        let mut warnings: Vec<String> = beyond.into_iter().collect();
        warnings.extend(distant_principal_point(&self.scenario().camera));
        warnings.extend(self.scenario().motion_remarks());
        warnings.extend(passing_speed(&self.simulator));
        warnings
    }
}

/// Returns a remark on a principal point farther outside the detector than the detector's side: a value in
/// another unit, or counted from another corner.
fn distant_principal_point(camera: &contract::Camera) -> Option<String> {
    let sides = [
        ("principal_x_px", camera.principal_x_px, camera.columns),
        ("principal_y_px", camera.principal_y_px, camera.rows),
    ];
    let (name, value, count) = sides.into_iter().find(|(_, value, count)| {
        let side = *count as f64;
        *value < -side || *value > 2.0 * side
    })?;
    Some(format!(
        "camera.{name} is {value}, far outside a detector of {count} pixels; pixels are counted from 0 at the \
         first one"
    ))
}
