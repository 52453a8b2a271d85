//! Camera file of a fit.

use camera_fit::CameraFit;
use camera_fit::adjustment::Term;
use files::{Failure, format_utc};

use super::fit::FitArguments;
use super::sensor_file::SensorSource;

/// Returns the camera file: tables of a camera, with the origin of each value in a comment. Without a
/// measured sensor, "electrons" are DN.
///
/// # Errors
/// [`Failure`] if the tables of the sensor cannot be written.
pub(super) fn camera_toml(
    fit: &CameraFit,
    arguments: &FitArguments,
    sensor: Option<&SensorSource>,
) -> Result<String, Failure> {
    let camera = &fit.camera;
    let sigma_of = |term: Term| {
        let found = fit.sigmas.iter().find(|(of, _, _)| *of == term);
        match found {
            Some((_, sigma, true)) => format!("± {sigma:.2e}"),
            _ => "not determined by the frames".to_owned(),
        }
    };
    let width_px = fit.width_px.unwrap_or(0.8);
    // Electrons of 1 DN: the gain of a measured sensor.
    let gain = sensor.map_or(1.0, |source| source.sensor.gain_e_per_dn);
    let zero_point = match &fit.photometry {
        Some(light) => gain * libm::pow(10.0, 0.4 * light.zero_point[0]) / arguments.exposure,
        None => 1e6 / arguments.exposure,
    };
    let sensor_tables = match sensor {
        Some(source) => measured_sensor(fit, arguments, source)?,
        None => assumed_sensor(fit),
    };
    let [k1, k2, k3] = camera.radial;
    let [p1, p2] = camera.tangential;
    Ok(format!(
        "# Camera fitted to {} frames with {} stars of {}, rms {:.3} px along an axis.\n\
         # Epoch of the star places: {}. Values without ± are assumed, or taken as the comment says.\n\
         [camera]\n\
         columns = {}\nrows = {}\n\
         focal_length_mm = {:?} # {}\n\
         pixel_width_um = {:?} # as stated: only its ratio to the focal length is measured\n\
         pixel_height_um = {:?}\n\
         principal_x_px = {:?} # {}\n\
         principal_y_px = {:?} # {}\n\
         radial = [{k1:e}, {k2:e}, {k3:e}] # k1 {}; k2 {}; k3 {}\n\
         tangential = [{p1:e}, {p2:e}] # p1 {}; p2 {}\n\n\
         {sensor_tables}\n\n\
         [psf]\n\
         kind = \"gaussian\"\n\
         sigma_px = {width_px:.3} # {}\n\n\
         [radiometry]\n\
         kind = \"zero_point\"\n\
         zero_point_e_per_s = {zero_point:.4e} # {}\n",
        fit.frames.len(),
        fit.stars,
        arguments.directory.display(),
        fit.rms_px,
        format_utc(arguments.time),
        camera.columns,
        camera.rows,
        camera.focal_length_mm,
        sigma_of(Term::FocalLength),
        camera.pixel_width_um,
        camera.pixel_height_um,
        camera.principal_x_px,
        sigma_of(Term::PrincipalX),
        camera.principal_y_px,
        sigma_of(Term::PrincipalY),
        sigma_of(Term::Radial1),
        sigma_of(Term::Radial2),
        sigma_of(Term::Radial3),
        sigma_of(Term::Tangential1),
        sigma_of(Term::Tangential2),
        if fit.width_px.is_some() { "median of the stars" } else { "assumed" },
        match &fit.photometry {
            Some(light) => format!("V = {:.2} for 1 DN in {} s", light.zero_point[0], arguments.exposure),
            None => "assumed: too few stars".to_owned(),
        },
    ))
}

/// Tables of a sensor of which only frames of the sky are given.
fn assumed_sensor(fit: &CameraFit) -> String {
    format!(
        "[sensor]\n\
         bit_depth = {} # of the files\n\
         gain_e_per_dn = 1.0 # not determined: needs flat fields; \"electrons\" below are DN\n\
         bias_dn = {:.3} # the background of the frames, with the light of the sky\n\
         full_well_e = {:?} # full scale of the files\n\
         read_noise_e = {:.3} # the noise of the frames, with that of the sky\n\
         dark_current_e_per_s = 0.0 # not determined: needs dark frames\n\
         background_e_per_s = 0.0 # in the bias",
        if fit.full_scale > 255.0 { 16 } else { 8 },
        fit.background_dn.max(0.0),
        fit.full_scale,
        fit.noise_dn,
    )
}

/// Tables of a measured sensor with the light of the sky in the frames: their background above bias and dark
/// current.
fn measured_sensor(
    fit: &CameraFit,
    arguments: &FitArguments,
    source: &SensorSource,
) -> Result<String, Failure> {
    let sensor = &source.sensor;
    let signal_e_per_s = (fit.background_dn - sensor.bias_dn) * sensor.gain_e_per_dn / arguments.exposure;
    let sky_e_per_s = (signal_e_per_s - sensor.dark_current_e_per_s).clamp(0.0, 1e6);
    let origin = format!(
        "the background of the frames, {:.2} DN in {} s, above bias and dark current",
        fit.background_dn, arguments.exposure
    );
    source.tables(sky_e_per_s, &origin)
}
