//! Report of the comparison of a camera with its twin.

use ::report::charts::chart::{
    BESIDE, Chart, MEASURED, REFERENCE, axes, dashed, intervals_across, line, log_axis, points, rounded,
};
use ::report::charts::plotly::{Axis, Layout};
use ::report::page::data_table::DataTable;
use ::report::page::{Page, Section};
use ::report::verdict::{Finding, Grade, Verdict};
use files::Failure;
use twin::FrameSet;
use twin::likeness::{Comparison, LENGTH_PX, Likeness};

use super::camera_fit::frame_picture;
use crate::table::{likeness_cells, whole_words};

/// Differences beyond this many intervals are drawn at this distance.
const MAX_SHOWN: f64 = 6.0;

/// Returns the page of a comparison; `name` is that of the directory of the camera.
///
/// # Errors
/// [`Failure::Usage`] when a picture cannot be encoded.
pub fn likeness_page(
    camera: &FrameSet,
    twin: &FrameSet,
    found: &Comparison,
    name: &str,
) -> Result<Page, Failure> {
    let different = found.figures.iter().filter(|figure| !figure.is_indistinguishable()).count();
    Ok(Page {
        title: format!("{name} and its twin"),
        kind: "Likeness of a camera and its simulated twin",
        version: env!("CARGO_PKG_VERSION").to_owned(),
        lead: vec![format!(
            "{} of {} figures cannot be distinguished with {} frames of the camera and {} of the twin; \
             {different} differ. {}",
            found.figures.len() - different,
            found.figures.len(),
            camera.fit.frames.len(),
            twin.fit.frames.len(),
            whole_words(found)
        )],
        warnings: Vec::new(),
        verdict: Verdict::new(found.figures.iter().map(finding).collect()),
        facts: vec![
            ("Frames of the camera", camera.fit.frames.len().to_string()),
            ("Frames of the twin", twin.fit.frames.len().to_string()),
            ("Stars in both", found.stars.len().to_string()),
            ("Boresight", env!("CARGO_PKG_VERSION").to_owned()),
        ],
        sections: vec![pictures(camera, twin)?, figures(found), pixels(found), spectra(found), stars(found)],
        names_paper: false,
        data: serde_json::json!({ "figures": found.figures, "not_compared": found.missing }),
    })
}

/// Returns the finding on a figure.
fn finding(figure: &Likeness) -> Finding {
    let [name, unit, .., difference, limit, _, visible] = likeness_cells(figure);
    let unit = if unit.is_empty() { unit } else { format!(" {unit}") };
    if figure.is_indistinguishable() {
        return Finding::new(
            Grade::Good,
            capital(&name),
            format!("No difference is seen; one of {visible}{unit} would be."),
        );
    }
    let text = format!("The twin differs by {difference} ± {limit}{unit}.");
    Finding::new(Grade::Poor, capital(&name), text)
}

fn capital(name: &str) -> String {
    ::report::figures::words::capital(name)
}

/// Returns the first frame of the camera and of the twin.
fn pictures(camera: &FrameSet, twin: &FrameSet) -> Result<Section, Failure> {
    let mut shown = Vec::new();
    for (set, words) in [(camera, "Camera"), (twin, "Twin")] {
        if let Some(mut picture) = frame_picture(set, 0)? {
            picture.title = format!("{words}, {}", picture.title);
            picture.marks.clear();
            shown.push(picture);
        }
    }
    Ok(Section::new("pictures", "Frames")
        .text("The first frame of each. The stretch of each is its own, from the median to the brightest pixel.")
        .pictures(shown))
}

/// Returns the table of the figures, and a chart of the differences in units of their intervals.
fn figures(found: &Comparison) -> Section {
    let mut table = DataTable::new([
        "figure",
        "unit",
        "camera",
        "twin",
        "difference",
        "± (95 %)",
        "statement",
        "visible from",
    ]);
    let (mut names, mut values) = (Vec::new(), Vec::new());
    for figure in found.figures.iter().rev() {
        names.push(figure.name.to_owned());
        let share = if figure.limit > 0.0 { figure.difference / figure.limit } else { 0.0 };
        values.push(rounded(share.clamp(-MAX_SHOWN, MAX_SHOWN), 3));
    }
    for figure in &found.figures {
        table.push(likeness_cells(figure));
    }
    let low: Vec<f64> = values.iter().map(|value| value - 1.0).collect();
    let high: Vec<f64> = values.iter().map(|value| value + 1.0).collect();
    let (first, last) = (names.first().cloned(), names.last().cloned());
    let mut traces = vec![intervals_across("difference, 95 %", values, &low, &high, names, MEASURED)];
    if let (Some(first), Some(last)) = (first, last) {
        let ends: Vec<f64> = vec![0.0, 0.0];
        traces.push(dashed_names("no difference", ends, vec![first, last]));
    }
    let layout = axes("difference, in units of its 95 % interval", "");
    let mut missing = DataTable::new(["figure", "reason"]).caption("Figures that the frames do not give.");
    for lack in &found.missing {
        missing.push([lack.name.to_owned(), lack.reason.clone()]);
    }
    let section = Section::new("figures", "Figures").table(table.clone()).chart(Chart::new(
        "Twin minus camera, each figure in units of its own interval: an interval that contains 0 is \
         indistinguishable. Differences beyond six intervals are drawn at six.",
        60 + 24 * found.figures.len() as u32,
        table,
        traces,
        layout,
    ));
    if found.missing.is_empty() { section } else { section.table(missing.wordy()) }
}

fn dashed_names(name: &str, x: Vec<f64>, y: Vec<String>) -> ::report::charts::plotly::Trace {
    use ::report::charts::plotly::{Line, Mode, Trace};
    Trace::scatter(Mode::Lines, x, y)
        .name(name.to_owned())
        .line(Line::new(1.5).colour(REFERENCE).dashed())
        .no_hover()
}

/// Returns the distribution of the pixels.
fn pixels(found: &Comparison) -> Section {
    let histogram = &found.histogram;
    let [camera, twin] = &histogram.share;
    let mut data = DataTable::new(["height above the background, DN", "camera", "twin"]);
    let mut shown: [Vec<f64>; 2] = [Vec::new(), Vec::new()];
    for (index, height) in histogram.height_dn.iter().enumerate() {
        let [first, second] = [camera, twin].map(|shares| shares.get(index).copied().unwrap_or(0.0));
        data.push([format!("{height:.2}"), format!("{first:.3e}"), format!("{second:.3e}")]);
        for (list, share) in shown.iter_mut().zip([first, second]) {
            // An empty bin has no place on a logarithmic axis.
            list.push(if share > 0.0 { share } else { f64::NAN });
        }
    }
    let x: Vec<f64> = histogram.height_dn.iter().map(|height| rounded(*height, 3)).collect();
    let [camera, twin] = shown;
    Section::new("pixels", "Distribution of the pixels").chart(Chart::new(
        "Share of the pixels by their height above the background. The last bin holds all brighter ones.",
        360,
        data,
        vec![line("camera", x.clone(), camera, MEASURED), line("twin", x, twin, BESIDE)],
        Layout::new(Axis::titled("height above the background, DN"), log_axis("share of the pixels"))
            .legend(true),
    ))
}

/// Returns the noise spectra along rows and columns.
fn spectra(found: &Comparison) -> Section {
    let mut section = Section::new("spectra", "Spectra of the noise");
    for (axis, words) in [(0, "rows"), (1, "columns")] {
        let [camera, twin] = [0, 1].map(|set: usize| &found.spectra[set][axis].power);
        let frequency: Vec<f64> =
            (1..=camera.len()).map(|step| rounded(step as f64 / LENGTH_PX as f64, 4)).collect();
        let mut data = DataTable::new(["frequency, per px", "camera, DN²", "twin, DN²"]);
        for (index, frequency) in frequency.iter().enumerate() {
            let of = |power: &Vec<f64>| power.get(index).map_or_else(String::new, |p| format!("{p:.4}"));
            data.push([frequency.to_string(), of(camera), of(twin)]);
        }
        let values = |power: &Vec<f64>| power.iter().map(|p| rounded(*p, 5)).collect();
        let traces = vec![
            line("camera", frequency.clone(), values(camera), MEASURED),
            line("twin", frequency, values(twin), BESIDE),
        ];
        section = section.chart(Chart::new(
            format!("Power of the noise along {words}; white noise of σ has σ² at every frequency."),
            300,
            data,
            traces,
            axes("frequency, per px", "power, DN²").legend(true),
        ));
    }
    section
}

/// Returns the brightness and width of the stars of both.
fn stars(found: &Comparison) -> Section {
    let section = Section::new("stars", "Stars of both");
    if found.stars.is_empty() {
        return section.absent("No star is bright enough in both.");
    }
    let (mut x, mut flux, mut width) = (Vec::new(), Vec::new(), Vec::new());
    for star in &found.stars {
        let [camera, twin] = star.sets;
        x.push(rounded(star.magnitude, 3));
        flux.push(rounded(100.0 * libm::expm1(twin.ln_flux - camera.ln_flux), 3));
        width.push(rounded(100.0 * libm::expm1(twin.ln_width - camera.ln_width), 3));
    }
    let ends = [x.iter().copied().fold(f64::INFINITY, f64::min), x.iter().copied().fold(-9.0, f64::max)];
    let chart = |caption: &str, title: &str, values: Vec<f64>, colour: &str| {
        let mut data = DataTable::new(["V", title]);
        for (magnitude, value) in x.iter().zip(&values).take(200) {
            data.push([format!("{magnitude:.2}"), format!("{value:+.2}")]);
        }
        let traces = vec![
            points("star", x.clone(), values, colour),
            dashed("equal", ends.to_vec(), vec![0.0, 0.0], REFERENCE),
        ];
        Chart::new(caption, 300, data, traces, axes("V, mag", title))
    };
    section
        .chart(chart("Flux of the twin less that of the camera, star by star.", "flux, %", flux, MEASURED))
        .chart(chart("Width of the twin less that of the camera, star by star.", "width, %", width, BESIDE))
}
