//! Report of a camera that was fitted to frames of the night sky.

use ::report::charts::chart::{
    BESIDE, Chart, MEASURED, REFERENCE, TRUTH, axes, dashed, line, log_axis, points, rounded,
};
use ::report::charts::plotly::{Axis, Layout, Line, Mode, Trace};
use ::report::figures::{cell, significant};
use ::report::page::data_table::DataTable;
use ::report::page::picture::{Mark, Picture, Pixels, RowMapping, Shape, Stretch};
use ::report::page::{Page, Section};
use ::report::verdict::{Finding, Grade, Verdict};
use camera_fit::{CameraFit, MatchedStar, Photometry, ProfileKind};
use contract::Window;
use files::Failure;
use twin::{FrameSet, TwinCamera};

/// Number of frames whose pictures are shown.
const PICTURES: usize = 2;

/// Length on the page of a residual of the root mean square, as a share of the width of the image.
const ARROW_SHARE: f64 = 0.02;

/// Number of bins of the distance from the principal point.
const BINS: usize = 8;

/// Returns the page of a camera fitted to frames.
///
/// # Errors
/// [`Failure::Usage`] when a picture cannot be encoded.
pub fn camera_fit_page(set: &FrameSet, twin: &TwinCamera, directory: &str) -> Result<Page, Failure> {
    let fit = &set.fit;
    let all = fit.frames.len() + fit.unsolved.len();
    let sections = vec![
        parameters(fit),
        frames(set)?,
        residuals(fit),
        brightness(fit),
        widths(fit, twin),
        detector(fit, twin),
    ];
    let (fx, fy) = fit.camera.focal_length_px();
    let angle = |side: usize, focal_px: f64| 2.0 * libm::atan(0.5 * side as f64 / focal_px).to_degrees();
    Ok(Page {
        title: format!("Camera of {directory}"),
        kind: "Camera from frames of the night sky",
        version: env!("CARGO_PKG_VERSION").to_owned(),
        lead: vec![format!(
            "{} of {all} frames have an attitude. Their {} stars agree with the fitted camera to {:.3} px along \
             an axis.",
            fit.frames.len(),
            fit.stars,
            fit.rms_px
        )],
        warnings: if fit.is_colour {
            vec!["Colour images: the mean of the three colours as stored; a gamma changes fluxes.".to_owned()]
        } else {
            Vec::new()
        },
        verdict: Verdict::new(findings(fit)),
        facts: vec![
            ("Size", format!("{} × {} px", fit.camera.columns, fit.camera.rows)),
            ("Field", format!("{:.3}° × {:.3}°", angle(fit.camera.columns, fx), angle(fit.camera.rows, fy))),
            ("Focal length", format!("{fx:.2} px")),
            ("Stars left out of the fit", format!("{} px rms", cell(finite(fit.left_out_rms_px)))),
            ("Boresight", env!("CARGO_PKG_VERSION").to_owned()),
        ],
        sections,
        names_paper: false,
        data: serde_json::json!({ "camera": fit.camera }),
    })
}

fn finite(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}

/// Returns what the fit shows and what it does not.
fn findings(fit: &CameraFit) -> Vec<Finding> {
    let mut findings = Vec::new();
    let undetermined: Vec<String> =
        fit.sigmas.iter().filter(|(_, _, known)| !known).map(|(term, _, _)| term.name().to_owned()).collect();
    findings.push(if undetermined.is_empty() {
        Finding::new(Grade::Good, "Geometry", "All eight parameters are determined by the stars.")
    } else {
        Finding::new(
            Grade::Fair,
            "Geometry",
            format!("Not determined by these frames: {}.", undetermined.join(", ")),
        )
        .and(
            "Frames at other roll angles separate the principal point from the pointing; stars near the corners \
             determine the distortion.",
        )
    });
    if fit.left_out_rms_px.is_finite() {
        let ratio = fit.left_out_rms_px / fit.rms_px;
        let grade = if ratio < 1.2 { Grade::Good } else { Grade::Fair };
        findings.push(Finding::new(
            grade,
            "Prediction",
            format!(
                "Stars that the fit did not use have residuals of {:.3} px, {ratio:.2} times those of the fit.",
                fit.left_out_rms_px
            ),
        ));
    }
    if !fit.unsolved.is_empty() {
        let all = fit.frames.len() + fit.unsolved.len();
        let text =
            format!("Frames without an attitude, which do not take part: {} of {all}.", fit.unsolved.len());
        findings.push(Finding::new(Grade::Fair, "Frames", text));
    }
    findings
}

/// Returns the table of the parameters.
fn parameters(fit: &CameraFit) -> Section {
    let mut table = DataTable::new(["parameter", "value", "± (1 σ)", "determined by the stars"]);
    for (term, sigma, is_determined) in &fit.sigmas {
        table.push([
            term.name().to_owned(),
            value_text(term.parameter(&fit.camera), *sigma),
            format!("{sigma:.1e}"),
            if *is_determined { "yes" } else { "no" }.to_owned(),
        ]);
    }
    Section::new("parameters", "Parameters").table(table)
}

/// Returns a value to two digits of its error; a small one with its power of ten.
fn value_text(value: f64, sigma: f64) -> String {
    if value.abs() < 1e-2 {
        return format!("{value:.3e}");
    }
    let digits = (1.0 - libm::log10(sigma).floor()).clamp(0.0, 9.0) as usize;
    format!("{value:.digits$}")
}

/// Returns the section of the frames: pictures of the first ones, a table of all.
fn frames(set: &FrameSet) -> Result<Section, Failure> {
    let fit = &set.fit;
    let mut table = DataTable::new(["frame", "stars", "residual, px rms", "reason without an attitude"]);
    for frame in &fit.frames {
        table.push([
            frame.name.clone(),
            frame.stars.to_string(),
            format!("{:.3}", frame.rms_px),
            String::new(),
        ]);
    }
    for frame in &fit.unsolved {
        table.push([frame.name.clone(), String::new(), String::new(), frame.reason.clone()]);
    }
    let mut pictures = Vec::new();
    for index in 0..fit.frames.len().min(PICTURES) {
        pictures.extend(frame_picture(set, index)?);
    }
    Ok(Section::new("frames", "Frames")
        .text("Circles: stars of the catalogue that take part in the fit.")
        .pictures(pictures)
        .table(table))
}

/// Returns the picture of a frame with its stars.
pub(super) fn frame_picture(set: &FrameSet, index: usize) -> Result<Option<Picture>, Failure> {
    let (Some(frame), Some(fitted)) = (set.solved(index), set.fit.frames.get(index)) else { return Ok(None) };
    let image = &frame.image;
    let dn: Vec<u16> =
        image.values.iter().map(|value| value.clamp(0.0, f32::from(u16::MAX)).round() as u16).collect();
    let pixels = Pixels { columns: image.columns, rows: image.rows, dn: &dn };
    let window = Window { x: 0, y: 0, columns: image.columns, rows: image.rows };
    let mut picture = Picture::new(pixels, window, RowMapping::WHOLE, Stretch::Stars)?;
    picture.title = fitted.name.clone();
    picture.caption = format!("{} stars, {:.3} px.", fitted.stars, fitted.rms_px);
    let radius = 0.008 * image.columns as f64;
    for star in set.fit.matched.iter().filter(|star| star.frame == index) {
        picture.marks.push(Mark {
            at: star.position,
            shape: Shape::Circle(radius),
            class: "truth",
            title: format!("HIP {}, V {:.2}", star.id, star.magnitude),
        });
    }
    Ok(Some(picture))
}

/// Returns the residuals over the field and along the radius.
fn residuals(fit: &CameraFit) -> Section {
    let scale = ARROW_SHARE * fit.camera.columns as f64 / fit.rms_px.max(1e-6);
    let (mut x, mut y) = (Vec::new(), Vec::new());
    for star in &fit.matched {
        let [dx, dy] = star.residual_px;
        x.extend([rounded(star.position.x, 1), rounded(star.position.x + scale * dx, 1), f64::NAN]);
        y.extend([rounded(star.position.y, 1), rounded(star.position.y + scale * dy, 1), f64::NAN]);
    }
    let arrows = Trace::scatter(Mode::Lines, x, y)
        .name("measured minus computed".to_owned())
        .line(Line::new(1.2).colour(MEASURED))
        .no_hover();
    let mut table = DataTable::new(["star", "x, px", "y, px", "residual x, px", "residual y, px", "σ, px"])
        .caption("The stars with the largest residuals in units of their standard deviation.");
    for star in largest(&fit.matched) {
        let [dx, dy] = star.residual_px;
        table.push([
            format!("HIP {}", star.id),
            format!("{:.1}", star.position.x),
            format!("{:.1}", star.position.y),
            format!("{dx:+.3}"),
            format!("{dy:+.3}"),
            format!("{:.3}", star.sigma_px),
        ]);
    }
    let rows = fit.camera.rows as f64;
    let layout = Layout::new(
        Axis::titled("column, px").range([0.0, fit.camera.columns as f64]).constrain_domain(),
        Axis::titled("row, px").range([rows, 0.0]).same_scale_as("x").constrain_domain(),
    );
    let field = Chart::new(
        format!(
            "Residuals of all stars over the field, each line {} times as long as its residual. A pattern would \
             be a distortion that the camera model lacks.",
            significant(scale)
        ),
        460,
        table,
        vec![arrows],
        layout,
    );
    Section::new("residuals", "Residuals").chart(field).chart(along_radius(fit))
}

fn largest(stars: &[MatchedStar]) -> Vec<&MatchedStar> {
    let mut order: Vec<&MatchedStar> = stars.iter().collect();
    let size = |star: &MatchedStar| libm::hypot(star.residual_px[0], star.residual_px[1]) / star.sigma_px;
    order.sort_by(|a, b| size(b).total_cmp(&size(a)));
    order.truncate(10);
    order
}

/// Returns the distance of a star from the principal point, px, and the part of its residual away from it.
fn radial(fit: &CameraFit, star: &MatchedStar) -> [f64; 2] {
    let (x, y) = (star.position.x - fit.camera.principal_x_px, star.position.y - fit.camera.principal_y_px);
    let distance = libm::hypot(x, y);
    [distance, (star.residual_px[0] * x + star.residual_px[1] * y) / distance.max(1e-9)]
}

fn along_radius(fit: &CameraFit) -> Chart {
    let values: Vec<[f64; 2]> = fit.matched.iter().map(|star| radial(fit, star)).collect();
    let farthest = values.iter().map(|value| value[0]).fold(1.0, f64::max);
    let (mut middles, mut means, mut data) =
        (Vec::new(), Vec::new(), DataTable::new(["from, px", "to, px", "stars", "mean, px", "rms, px"]));
    for bin in 0..BINS {
        let [low, high] = [bin, bin + 1].map(|edge| farthest * edge as f64 / BINS as f64);
        let kept: Vec<f64> = values
            .iter()
            .filter(|[distance, _]| (low..=high).contains(distance))
            .map(|[_, part]| *part)
            .collect();
        if kept.is_empty() {
            continue;
        }
        let count = kept.len() as f64;
        let mean = kept.iter().sum::<f64>() / count;
        let rms = (kept.iter().map(|part| part * part).sum::<f64>() / count).sqrt();
        middles.push(rounded(0.5 * (low + high), 1));
        means.push(rounded(mean, 4));
        data.push([
            format!("{low:.0}"),
            format!("{high:.0}"),
            kept.len().to_string(),
            format!("{mean:+.4}"),
            format!("{rms:.4}"),
        ]);
    }
    let traces = vec![
        points(
            "star",
            values.iter().map(|value| rounded(value[0], 1)).collect::<Vec<f64>>(),
            values.iter().map(|value| rounded(value[1], 4)).collect(),
            MEASURED,
        ),
        line("mean", middles, means, BESIDE),
    ];
    Chart::new(
        "Part of the residual away from the principal point, by distance from it: a bend would be a radial \
         distortion that is left.",
        340,
        data,
        traces,
        axes("distance from the principal point, px", "residual outwards, px").legend(true),
    )
}

/// Returns the section on magnitude and flux.
fn brightness(fit: &CameraFit) -> Section {
    let section = Section::new("brightness", "Brightness of the stars");
    let Some(light) = &fit.photometry else {
        return section.absent("Fewer than eight unsaturated stars: no brightness scale.");
    };
    let magnitudes: Vec<f64> = fit.matched.iter().map(|star| reduced_magnitude(light, star)).collect();
    let fluxes: Vec<f64> = fit.matched.iter().map(|star| rounded(star.flux_dn, 2)).collect();
    let least = magnitudes.iter().copied().fold(f64::INFINITY, f64::min);
    let most = magnitudes.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let relation = |magnitude: f64| rounded(libm::pow(10.0, 0.4 * (light.zero_point[0] - magnitude)), 3);
    let mut data = DataTable::new(["figure", "value", "±"]);
    data.push(["V of 1 DN".to_owned(), two(light.zero_point[0]), two(light.zero_point[1])]);
    data.push([
        "colour term, mag per mag of B−V".to_owned(),
        two(light.colour_term[0]),
        two(light.colour_term[1]),
    ]);
    data.push(["scatter, mag".to_owned(), two(light.scatter_mag), String::new()]);
    data.push(["V of which half of the stars are seen".to_owned(), cell(light.limiting_v), String::new()]);
    let traces = vec![
        points("star", magnitudes, fluxes, MEASURED),
        dashed("relation", vec![least, most], vec![relation(least), relation(most)], REFERENCE),
    ];
    section.chart(Chart::new(
        "Flux of the stars against their magnitude in the band of the camera: V less the colour term times B−V.",
        360,
        data,
        traces,
        Layout::new(Axis::titled("magnitude"), log_axis("flux, DN")).legend(true),
    ))
}

fn two(value: f64) -> String {
    format!("{value:.2}")
}

/// Returns the magnitude of a star in the band of the camera; the mean colour for one of unknown colour.
fn reduced_magnitude(light: &Photometry, star: &MatchedStar) -> f64 {
    rounded(star.magnitude - light.colour_term[0] * star.b_v.unwrap_or(0.7), 3)
}

/// Returns the section on the width of the stars.
fn widths(fit: &CameraFit, twin: &TwinCamera) -> Section {
    let mut distances = Vec::new();
    let mut found = Vec::new();
    for star in fit.matched.iter().filter(|star| star.width_px.is_finite() && star.significance > 10.0) {
        distances.push(rounded(radial(fit, star)[0], 1));
        found.push(rounded(star.width_px, 4));
    }
    let section = Section::new("widths", "Width of the stars");
    if found.is_empty() {
        return section.absent("No star is bright enough.");
    }
    let profile = &twin.profile;
    let words = match profile.kind {
        ProfileKind::Gaussian { sigma_px } => format!("a Gaussian with σ = {sigma_px:.3} px"),
        ProfileKind::Moffat { fwhm_px, beta } => {
            format!(
                "a Moffat function with a full width at half maximum of {fwhm_px:.3} px and β = {beta:.2}"
            )
        }
    };
    let [growth, sigma] = profile.growth;
    let text = if !twin.has_profile {
        "Too few bright stars for a profile; the median of the widths is used.".to_owned()
    } else if growth == 0.0 {
        format!(
            "The profile of {} stars is {words}, equal over the field within ± {sigma:.2}.",
            profile.stars
        )
    } else {
        format!(
            "The profile of {} stars is {words} at the principal point, and {:.0} ± {:.0} % wider in the \
             farthest corner.",
            profile.stars,
            100.0 * growth,
            100.0 * sigma
        )
    };
    let mut data = DataTable::new(["stars", "narrowest, px", "median, px", "widest, px"]);
    let mut sorted = found.clone();
    sorted.sort_by(f64::total_cmp);
    let at = |share: f64| sorted.get((share * (sorted.len() - 1) as f64) as usize).copied();
    data.push([sorted.len().to_string(), cell(at(0.0)), cell(at(0.5)), cell(at(1.0))]);
    section.text(text).chart(Chart::new(
        "Width of each star of more than ten standard deviations, as the σ of a Gaussian with the width of a \
         pixel in it, by distance from the principal point.",
        320,
        data,
        vec![points("star", distances, found, TRUTH)],
        axes("distance from the principal point, px", "width, px"),
    ))
}

/// Returns the table of the detector.
fn detector(fit: &CameraFit, twin: &TwinCamera) -> Section {
    let mut table = DataTable::new(["figure", "value", "unit"]);
    let mut add = |name: &str, value: f64, unit: &str| {
        table.push([name.to_owned(), significant(value), unit.to_owned()]);
    };
    add("background", fit.background_dn, "DN");
    add("noise of a pixel", fit.noise_dn, "DN");
    add("offsets of rows that change from frame to frame", twin.row_dn, "DN rms");
    add("offsets of columns that change from frame to frame", twin.column_dn, "DN rms");
    add("offsets of columns that stay", twin.fixed_column_dn, "DN rms");
    if let Some(hot) = &twin.hot_pixels {
        let pixels = (fit.camera.columns * fit.camera.rows) as f64;
        add("hot pixels", hot.count as f64, "");
        add("share of hot pixels", 100.0 * hot.count as f64 / pixels, "%");
        add("limit of a hot pixel above the background", hot.limit_dn, "DN");
    }
    add("saturation", fit.saturation_dn, "DN");
    add("full scale of the files", fit.full_scale, "DN");
    let section = Section::new("detector", "Detector").table(table);
    if twin.hot_pixels.is_some() {
        return section;
    }
    section.text("Hot pixels: three frames at different pointings would separate them from stars.")
}
