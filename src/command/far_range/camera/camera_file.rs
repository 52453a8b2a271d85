//! Camera file of a fit.

use camera_fit::CameraFit;
use camera_fit::adjustment::Term;
use files::format_utc;
use hifitime::Epoch;

use super::fit::FitArguments;

/// Returns the camera file: tables of a camera, with the origin of each value in a comment.
pub(super) fn camera_toml(fit: &CameraFit, arguments: &FitArguments, time: Epoch) -> String {
    let camera = &fit.camera;
    let sigma_of = |term: Term| {
        let found = fit.sigmas.iter().find(|(of, _, _)| *of == term);
        match found {
            Some((_, sigma, true)) => format!("± {sigma:.2e}"),
            _ => "not determined by the frames".to_owned(),
        }
    };
    let bits = if fit.full_scale > 255.0 { 16 } else { 8 };
    let width_px = fit.width_px.unwrap_or(0.8);
    let zero_point =
        fit.photometry.map_or(1e6, |light| libm::pow(10.0, 0.4 * light.zero_point[0])) / arguments.exposure;
    let [k1, k2, k3] = camera.radial;
    let [p1, p2] = camera.tangential;
    format!(
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
         [sensor]\n\
         bit_depth = {bits} # of the files\n\
         gain_e_per_dn = 1.0 # not determined: needs flat fields; \"electrons\" below are DN\n\
         bias_dn = {:.3} # the background of the frames, with the light of the sky\n\
         full_well_e = {:?} # full scale of the files\n\
         read_noise_e = {:.3} # the noise of the frames, with that of the sky\n\
         dark_current_e_per_s = 0.0 # not determined: needs dark frames\n\
         background_e_per_s = 0.0 # in the bias\n\n\
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
        format_utc(time),
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
        fit.background_dn.max(0.0),
        fit.full_scale,
        fit.noise_dn,
        if fit.width_px.is_some() { "median of the stars" } else { "assumed" },
        match &fit.photometry {
            Some(light) => format!("V = {:.2} for 1 DN in {} s", light.zero_point[0], arguments.exposure),
            None => "assumed: too few stars".to_owned(),
        },
    )
}
