//! Frames of a simulated twin.

use std::path::Path;

use camera_fit::SkyFrame;
use far_range::FarRangeScenario;
use files::{Failure, GreyImage, PixelConversion};
use rayon::prelude::*;
use sim::{SimulatedCamera, Simulator};

/// Largest number of frames, that of a fit.
const MAX_FRAMES: u64 = 200;

/// Exposes all frames of a scenario, in their order. Relative paths in the scenario refer to `folder`.
///
/// # Errors
/// A [`Failure`] for a scenario that cannot be simulated, keeps regions of interest only, or has more than
/// 200 frames.
pub fn twin_frames(scenario: &FarRangeScenario, folder: &Path) -> Result<Vec<SkyFrame>, Failure> {
    if scenario.roi.is_some() || scenario.zero_suppression_dn.is_some() {
        let message = "the scenario of the twin keeps parts of its images ([roi] or zero_suppression_dn), \
                       expected whole images";
        return Err(Failure::Usage(message.to_owned()));
    }
    let count: u64 = scenario.schedule.iter().map(|group| group.count).sum();
    if count > MAX_FRAMES {
        return Err(Failure::Usage(format!(
            "the scenario of the twin has {count} frames, expected at most {MAX_FRAMES}: all are kept in memory"
        )));
    }
    let simulation = scenario.simulation()?;
    let simulator = Simulator::new(&simulation, folder)?;
    (0..count).into_par_iter().map_init(|| simulator.camera(), expose).collect()
}

fn expose(camera: &mut Result<SimulatedCamera<'_>, sim::SimError>, number: u64) -> Result<SkyFrame, Failure> {
    let camera = camera.as_mut().map_err(|error| Failure::Usage(error.to_string()))?;
    let exposure = camera.expose(number)?;
    let frame = exposure.frame;
    let image = GreyImage {
        columns: frame.columns(),
        rows: frame.rows(),
        values: frame.dn().iter().map(|dn| f32::from(*dn)).collect(),
        full_scale: f64::from(frame.full_scale_dn()),
        conversion: PixelConversion::None,
    };
    Ok(SkyFrame { name: format!("frame {number}"), image })
}
