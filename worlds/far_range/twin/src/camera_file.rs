//! File of a fitted camera: the tables of a camera with the origin of each value.

use std::fmt::Write as _;
use std::path::Path;

use camera_fit::adjustment::Term;
use camera_fit::{CameraFit, ProfileKind};
use files::format_utc;
use hifitime::Epoch;

use crate::TwinCamera;
use crate::twin_camera::HotPixels;

/// Origin of a fit.
#[derive(Debug, Clone, Copy)]
pub struct Origin<'a> {
    /// Directory of the frames.
    pub directory: &'a Path,
    /// Epoch of the star places.
    pub time: Epoch,
    /// Exposure time of the frames, s.
    pub exposure_s: f64,
}

/// Returns the camera file: the tables `[camera]`, `[sensor]`, `[psf]`, `[optics]` and `[radiometry]`.
pub fn camera_toml(fit: &CameraFit, twin: &TwinCamera, origin: &Origin<'_>) -> String {
    let mut text = format!(
        "# Camera fitted to {} frames with {} stars of {}, rms {:.3} px along an axis.\n\
         # Epoch of the star places: {}. Values without ± are assumed, or taken as the comment says.\n",
        fit.frames.len(),
        fit.stars,
        one_line(origin.directory),
        fit.rms_px,
        format_utc(origin.time),
    );
    text.push_str(&geometry_table(fit));
    match &twin.sensor {
        Some(sensor) => text.push_str(&format!("{}\n\n", sensor.tables.trim_end())),
        None => text.push_str(&sensor_table(fit, twin, origin.exposure_s)),
    }
    text.push_str(&optics_tables(twin));
    text.push_str(&radiometry_table(fit, twin, origin.exposure_s));
    text
}

/// Returns a path as text without control characters, which would end a comment.
fn one_line(path: &Path) -> String {
    path.display().to_string().replace(char::is_control, "?")
}

fn geometry_table(fit: &CameraFit) -> String {
    let camera = &fit.camera;
    let sigma_of = |term: Term| match fit.sigmas.iter().find(|(of, _, _)| *of == term) {
        Some((_, sigma, true)) => format!("± {sigma:.2e}"),
        _ => "not determined by the frames".to_owned(),
    };
    let [k1, k2, k3] = camera.radial;
    let [p1, p2] = camera.tangential;
    format!(
        "[camera]\n\
         columns = {}\nrows = {}\n\
         focal_length_mm = {:?} # {}\n\
         pixel_width_um = {:?} # as stated: only its ratio to the focal length is measured\n\
         pixel_height_um = {:?}\n\
         principal_x_px = {:?} # {}\n\
         principal_y_px = {:?} # {}\n\
         radial = [{k1:e}, {k2:e}, {k3:e}] # k1 {}; k2 {}; k3 {}\n\
         tangential = [{p1:e}, {p2:e}] # p1 {}; p2 {}\n\n",
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
    )
}

fn sensor_table(fit: &CameraFit, twin: &TwinCamera, exposure_s: f64) -> String {
    let gain = twin.gain_e_per_dn;
    let corrected = if twin.is_corrected { ", corrected by the twin's frames" } else { "" };
    let read_noise_e = twin.read_noise_dn * gain;
    let mut text = format!(
        "[sensor]\n\
         bit_depth = {} # holds the saturation level\n\
         gain_e_per_dn = {gain:.4} # assumed: {:.0} electrons at full scale; flat fields would determine it\n\
         bias_dn = {:.3} # the background of the frames, with the light of the sky{corrected}\n\
         full_well_e = {:.1} # {:.0} DN, {}\n\
         read_noise_e = {read_noise_e:.4} # the noise of the frames, with that of the sky{corrected}\n\
         dark_current_e_per_s = 0.0 # in the bias; dark frames would determine it\n\
         background_e_per_s = 0.0 # in the bias\n",
        twin.bit_depth,
        gain * fit.saturation_dn,
        twin.bias_dn,
        ((fit.saturation_dn - twin.bias_dn) * gain).max(1.0),
        fit.saturation_dn,
        if fit.saturation_dn < fit.full_scale {
            "the largest value, which several pixels have"
        } else {
            "full scale of the files"
        },
    );
    if twin.row_dn > 0.0 || twin.column_dn > 0.0 {
        let row_e = twin.row_dn * gain;
        let column_e = twin.column_dn * gain;
        let _ = writeln!(
            text,
            "line_noise = {{ row_e = {row_e:.4}, column_e = {column_e:.4} }} # change from frame to frame"
        );
    }
    if twin.fixed_column_dn > 0.0 {
        let offset_e = twin.fixed_column_dn * gain;
        let _ = writeln!(
            text,
            "fixed_pattern = {{ seed = 1, column_offset_e = {offset_e:.4} }} # the same in all frames"
        );
    }
    match &twin.hot_pixels {
        Some(hot) if hot.count > 0 => text.push_str(&hot_pixel_table(hot, gain, exposure_s)),
        Some(_) => text.push_str("# no pixel is above five standard deviations in most frames\n"),
        None => text.push_str("# hot pixels: three frames at different pointings would determine them\n"),
    }
    text.push('\n');
    text
}

fn hot_pixel_table(hot: &HotPixels, gain: f64, exposure_s: f64) -> String {
    // Of a Pareto distribution, half lie above 2^(1/index) times its lower limit.
    let median_dn = hot.limit_dn * libm::exp2(1.0 / hot.index);
    format!(
        "\n[sensor.hot_pixels] # above {:.1} DN in most frames; fainter ones are in the noise\n\
         count = {}\n\
         seed = 1\n\
         median_e_per_s = {:.4}\n\
         spread = 0.0\n\
         law = {{ kind = \"pareto\", index = {:.3} }}\n",
        hot.limit_dn,
        hot.count,
        (median_dn * gain / exposure_s).min(1e9),
        hot.index
    )
}

fn optics_tables(twin: &TwinCamera) -> String {
    let profile = &twin.profile;
    let origin = if twin.has_profile {
        format!("± {:.1} %, of {} stars", 100.0 * profile.width_error, profile.stars)
    } else {
        "median of the stars, or assumed: too few bright stars for a profile".to_owned()
    };
    let mut text = match profile.kind {
        ProfileKind::Gaussian { sigma_px } => {
            format!("[psf]\nkind = \"gaussian\"\nsigma_px = {:.4} # {origin}\n\n", sigma_px.max(0.1))
        }
        ProfileKind::Moffat { fwhm_px, beta } => format!(
            "[psf]\nkind = \"moffat\"\nfwhm_px = {:.4} # {origin}\nbeta = {beta:.3}\n\n",
            fwhm_px.max(0.1)
        ),
    };
    let [growth, sigma] = profile.growth;
    if growth != 0.0 {
        let _ = write!(
            text,
            "[optics]\npsf_growth = {growth:.4} # ± {sigma:.2}: the width in the farthest corner is 1 + this \
             times that of the principal point\n\n"
        );
    }
    text
}

fn radiometry_table(fit: &CameraFit, twin: &TwinCamera, exposure_s: f64) -> String {
    let (zero_point_dn, origin) = match (&fit.photometry, twin.zero_point_dn) {
        (Some(light), Some([zero_point_dn, _])) => (
            zero_point_dn,
            format!(
                "V = {:.2} ± {:.2} for 1 DN in {exposure_s} s, times the gain",
                light.zero_point[0], light.zero_point[1]
            ),
        ),
        _ => (1e6 / twin.gain_e_per_dn, "assumed: too few stars".to_owned()),
    };
    let zero_point_e_per_s = zero_point_dn * twin.gain_e_per_dn / exposure_s;
    let mut text = format!(
        "[radiometry]\nkind = \"zero_point\"\nzero_point_e_per_s = {zero_point_e_per_s:.5e} # {origin}\n"
    );
    if let (Some(light), Some([_, colour_term])) = (&fit.photometry, twin.zero_point_dn) {
        let _ = writeln!(
            text,
            "colour_term = {:.4} # ± {:.2}, magnitudes per magnitude of B−V",
            colour_term.clamp(-2.0, 2.0),
            light.colour_term[1]
        );
    }
    text
}
