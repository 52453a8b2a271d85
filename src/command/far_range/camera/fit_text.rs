//! Words and JSON of a fit.

use camera_fit::adjustment::Term;
use camera_fit::{CameraFit, EpochOffset, FittedFrame, MatchedStar};
use contract::{Angle, Direction, PixelPoint};
use files::format_utc;
use hifitime::Epoch;
use pipeline::CameraModel;
use serde_json::{Value, json};

/// Number of frames that are printed; the JSON lists all.
const PRINTED_FRAMES: usize = 20;

/// Returns a value with its standard deviation, to two digits of the latter.
fn with_sigma(value: f64, sigma: f64) -> String {
    if value.abs() < 1e-2 {
        return format!("{value:.3e} ± {sigma:.1e}");
    }
    let digits = (1 - libm::log10(sigma).floor() as i32).clamp(0, 9) as usize;
    format!("{value:.digits$} ± {sigma:.digits$}")
}

/// Returns the fit as text for a terminal.
pub(super) fn fit_text(fit: &CameraFit) -> String {
    let all = fit.frames.len() + fit.unsolved.len();
    let mut text = format!(
        "{} of {all} frames have an attitude, with {} stars; rms {:.3} px along an axis",
        fit.frames.len(),
        fit.stars,
        fit.rms_px
    );
    if fit.left_out_rms_px.is_finite() {
        text.push_str(&format!(", {:.3} px of stars left out", fit.left_out_rms_px));
    }
    let (focal_px, _) = fit.camera.focal_length_px();
    for (term, sigma, is_determined) in &fit.sigmas {
        let value = with_sigma(term.parameter(&fit.camera), *sigma);
        text.push_str(&format!("\n  {:<22} {value}", term.name()));
        if *term == Term::FocalLength {
            text.push_str(&format!(" ({focal_px:.2} px)"));
        }
        if !is_determined {
            text.push_str("  not determined by these frames");
        }
    }
    if fit.sigmas.iter().any(|(_, _, is_determined)| !is_determined) {
        text.push_str(
            "\n  Frames at other roll angles separate the principal point from the pointing; stars near the corners \
             determine the distortion.",
        );
    }
    text.push_str(&sensor_text(fit));
    for frame in fit.frames.iter().take(PRINTED_FRAMES) {
        let (ra_deg, dec_deg, roll_deg) = pointing(fit, frame);
        text.push_str(&format!(
            "\n  {:<20} RA {ra_deg:9.4}°  Dec {dec_deg:+9.4}°  roll {roll_deg:9.3}°  {} stars, {:.3} px",
            frame.name, frame.stars, frame.rms_px
        ));
    }
    for frame in fit.unsolved.iter().take(PRINTED_FRAMES) {
        text.push_str(&format!("\n  {:<20} no attitude: {}", frame.name, frame.reason));
    }
    text
}

/// Returns doubts about the frames of a fit, for frames of a stated time.
pub(super) fn warnings(fit: &CameraFit, time: Epoch) -> Vec<String> {
    let mut warnings = Vec::new();
    if fit.other_cameras > 0 {
        warnings.push(format!(
            "{} of {} frames with an attitude are of another camera or another setting of the lens and are left out",
            fit.other_cameras,
            fit.other_cameras + fit.frames.len()
        ));
    }
    if let Some(epoch) = fit.epoch.filter(EpochOffset::is_contradiction) {
        warnings.push(format!(
            "the proper motions of the stars are those {:+.1} ± {:.1} years from {}: check --time",
            epoch.years,
            epoch.sigma_years,
            format_utc(time)
        ));
    }
    warnings
}

/// Returns the figures of the sensor and the optics as text.
fn sensor_text(fit: &CameraFit) -> String {
    let mut text =
        format!("\n  background {:.2} DN, noise {:.2} DN per pixel", fit.background_dn, fit.noise_dn);
    if let Some(width_px) = fit.width_px {
        text.push_str(&format!("; stars have σ = {width_px:.2} px"));
    }
    if let Some(light) = &fit.photometry {
        let [zero_point, zero_point_sigma] = light.zero_point;
        let [colour, colour_sigma] = light.colour_term;
        text.push_str(&format!(
            "\n  zero point V = {zero_point:.2} ± {zero_point_sigma:.2} for 1 DN, colour term {colour:+.2} ± \
             {colour_sigma:.2} per mag of B−V, scatter {:.2} mag",
            light.scatter_mag
        ));
        if let Some(limit) = light.limiting_v {
            text.push_str(&format!("; half of the stars of V = {limit:.1} are seen"));
        }
    }
    if fit.is_colour {
        text.push_str("\n  colour images: the mean of the three colours as stored");
    }
    text
}

/// Returns right ascension and declination of the centre of the image, apparent, and the clockwise angle in
/// the image from up to north there, degrees.
fn pointing(fit: &CameraFit, frame: &FittedFrame) -> (f64, f64, f64) {
    let camera = &fit.camera;
    let centre = PixelPoint::new(0.5 * camera.columns as f64 - 0.5, 0.5 * camera.rows as f64 - 0.5);
    let ahead = CameraModel::new(camera).ok().and_then(|model| model.back_project(centre));
    let ahead = ahead.unwrap_or_else(Direction::z);
    let sky = frame.camera_from_icrs.inverse().rotate(ahead.vector());
    let dec = libm::asin(sky.z.clamp(-1.0, 1.0));
    let ra = libm::atan2(sky.y, sky.x);
    // The direction of north in camera axes: x along columns, y along rows, which count downwards.
    let north = Direction::from_ra_dec(
        Angle::from_radians(ra),
        Angle::from_radians(dec + std::f64::consts::FRAC_PI_2),
    );
    let north = frame.camera_from_icrs.rotate(north.vector());
    let roll = libm::atan2(north.x, -north.y);
    (ra.to_degrees().rem_euclid(360.0), dec.to_degrees(), roll.to_degrees())
}

/// Returns the fit as JSON.
pub(super) fn document(fit: &CameraFit, time: Epoch) -> Value {
    let parameters: Vec<Value> = fit
        .sigmas
        .iter()
        .map(|(term, sigma, is_determined)| {
            let value = term.parameter(&fit.camera);
            json!({ "name": term.name(), "value": value, "sigma": sigma, "determined": is_determined })
        })
        .collect();
    let frames: Vec<Value> = fit
        .frames
        .iter()
        .map(|frame| {
            let (ra_deg, dec_deg, roll_deg) = pointing(fit, frame);
            json!({
                "name": frame.name, "q_cam_j2000": frame.camera_from_icrs.wxyz(), "ra_deg": ra_deg,
                "dec_deg": dec_deg, "roll_deg": roll_deg, "stars": frame.stars, "rms_px": frame.rms_px,
            })
        })
        .collect();
    let unsolved: Vec<Value> = fit
        .unsolved
        .iter()
        .map(|frame| json!({ "name": frame.name, "sources": frame.sources, "reason": frame.reason }))
        .collect();
    let photometry = fit.photometry.map(|light| {
        json!({
            "zero_point_v": light.zero_point[0], "zero_point_sigma": light.zero_point[1],
            "colour_term": light.colour_term[0], "colour_term_sigma": light.colour_term[1],
            "scatter_mag": light.scatter_mag, "stars": light.stars, "limiting_v": light.limiting_v,
        })
    });
    json!({
        "ok": true, "camera": fit.camera, "parameters": parameters, "stars": fit.stars, "rms_px": fit.rms_px,
        "left_out_rms_px": fit.left_out_rms_px.is_finite().then_some(fit.left_out_rms_px),
        "background_dn": fit.background_dn, "noise_dn": fit.noise_dn, "star_sigma_px": fit.width_px,
        "photometry": photometry, "frames": frames, "unsolved": unsolved,
        "matched_stars": fit.matched.iter().map(|star| star_document(fit, star)).collect::<Vec<_>>(),
        "epoch_offset_years": fit.epoch.map(|epoch| epoch.years),
        "epoch_offset_sigma_years": fit.epoch.map(|epoch| epoch.sigma_years),
        "warnings": warnings(fit, time),
    })
}

/// Returns a star of a frame as JSON.
fn star_document(fit: &CameraFit, star: &MatchedStar) -> Value {
    json!({
        "frame": fit.frames.get(star.frame).map(|frame| frame.name.as_str()), "hip": star.id, "v": star.magnitude,
        "x_px": star.position.x, "y_px": star.position.y, "residual_px": star.residual_px,
        "sigma_px": star.sigma_px, "flux_dn": star.flux_dn,
        "width_px": star.width_px.is_finite().then_some(star.width_px),
    })
}
