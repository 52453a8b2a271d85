//! Binding constraint of a requirement that cannot be met: the constraint whose removal would make it
//! possible.
use files::Failure;

use crate::design::{Design, design_with};
use crate::detection_model::detection::{background_e, is_flooded};
use crate::requirement::definition::Requirements;
use crate::requirement::{Demand, DetectionRule, Parameter, SkyStatistic};

/// Number of boresights that are evaluated.
const POINTINGS: usize = 1000;

/// Returns the binding constraint at a value of a parameter, in words. Constraints are removed one by one,
/// and the result is the first whose removal meets the demand: over-exposure of the target, the background,
/// smear, the field, noise; otherwise it is the signal.
///
/// # Errors
/// A [`Failure`] when the camera cannot be created.
pub fn binding(
    requirements: &Requirements,
    demand: &Demand,
    parameter: Parameter,
    value: f64,
    required: f64,
) -> Result<String, Failure> {
    let (design, exposure_s) = design_with(requirements, parameter, value, POINTINGS)?;
    binding_of(&design, requirements, demand, exposure_s, required)
}

/// Returns the binding constraint of a given design; see [`binding`].
///
/// # Errors
/// The errors of [`binding`].
pub fn binding_of(
    design: &Design<'_>,
    requirements: &Requirements,
    demand: &Demand,
    exposure_s: Option<f64>,
    required: f64,
) -> Result<String, Failure> {
    let file = &requirements.file;
    let again = || Design::new(requirements, &design.camera.config, POINTINGS, exposure_s.unwrap_or(0.0));
    if let Demand::ExposureWindow { n_min, .. } = demand {
        let n_min = n_min.unwrap_or(file.n_min);
        if design.stars_chance(file.exposure.max_s, n_min, SkyStatistic::Sky)? >= required {
            return Ok(
                "saturation: the longest exposure without over-exposure of the target is too short for the \
                 stars"
                    .to_owned(),
            );
        }
    }
    let threshold_dn = design.rule.thresholds(&design.camera, 0.0).high_dn;
    let sensor = &design.camera.config.sensor;
    let full_dn = sensor.bias_dn + sensor.full_well_e / sensor.gain_e_per_dn;
    if threshold_dn >= full_dn.min(f64::from(sensor.full_scale_dn())) {
        return Ok(format!(
            "saturation: a full pixel, {full_dn:.0} DN, is not above the threshold, {threshold_dn:.0} DN"
        ));
    }
    let exposed_s = exposure_s.unwrap_or(design.reached(demand, None)?.exposure_s);
    let dark_e = background_e(&design.camera, exposed_s, design.background_e_per_s()?);
    if is_flooded(&design.camera, &design.rule, dark_e) {
        return Ok(format!("background: {dark_e:.0} electrons per pixel raise the empty frame above I1"));
    }
    if again()?.without_smear().reached(demand, exposure_s)?.probability >= required {
        return Ok("smear: the motion during the exposure spreads the signal over too many pixels".to_owned());
    }
    let (Demand::Stars { n_min, .. } | Demand::ExposureWindow { n_min, .. }) = demand else {
        return noise_or_signal(design, requirements, demand, exposure_s, required);
    };
    let n_min = n_min.unwrap_or(file.n_min) as usize;
    let every = crate::sky::Sky::new(&design.camera, &file.motion, &file.sky, POINTINGS, 1e-9)?;
    let (mut counted, mut enough) = (0, 0);
    for field in every.usable_fields() {
        counted += 1;
        enough += usize::from(field.stars.len() >= n_min);
    }
    if counted == 0 {
        return Ok("exclusion: the exclusion angles exclude all pointings".to_owned());
    }
    let everywhere = matches!(demand, Demand::Stars { over: SkyStatistic::EveryPointing, .. });
    let share = enough as f64 / counted as f64;
    if share < required || (everywhere && enough < counted) {
        return Ok(format!(
            "field: too small; only {:.1} % of the pointings have {n_min} catalogue stars in the field, of \
             any magnitude",
            100.0 * share
        ));
    }
    noise_or_signal(design, requirements, demand, exposure_s, required)
}

fn noise_or_signal(
    design: &Design<'_>,
    requirements: &Requirements,
    demand: &Demand,
    exposure_s: Option<f64>,
    required: f64,
) -> Result<String, Failure> {
    let mut quiet = design.camera.config.clone();
    (quiet.sensor.read_noise_e, quiet.sensor.dark_current_e_per_s) = (0.0, 0.0);
    quiet.sensor.line_noise = Default::default();
    quiet.background = Default::default();
    let quiet = Design::new(requirements, &quiet, POINTINGS, exposure_s.unwrap_or(0.0))?;
    if quiet.reached(demand, exposure_s)?.probability >= required {
        return Ok(
            "noise: the requirement would be met without dark current, read noise and background".to_owned()
        );
    }
    Ok(match design.rule {
        DetectionRule::Dn { high_dn, .. } => {
            format!("signal: too few electrons for the threshold of {high_dn} DN")
        }
        DetectionRule::Sigmas { high, .. } => {
            format!("signal: too few electrons for the threshold of {high} standard deviations")
        }
    })
}
