//! Report of visibility requirements: the verification table and its curves.

use std::path::Path;

use ::report::charts::chart::{
    BESIDE, Chart, MEASURED, Panel, REFERENCE, WRONG, axes, dashed, intervals, line, log_axis, rounded,
    stacked,
};
use ::report::charts::plotly::{Axis, Layout, Marker, Mode, Symbol};
use ::report::charts::thinning::{bins, summary};
use ::report::figures::{cell, probability, significant};
use ::report::page::data_table::DataTable;
use ::report::page::{Page, Section};
use ::report::read::read_json;
use ::report::verdict::{Finding, Grade, Verdict};
use ::visibility::{SimulatedRate, Status, VisibilityReport, read_sky};
use files::Failure;

use super::sky_map::sky_map;

/// Reads a directory written by `boresight visibility --out`.
///
/// # Errors
/// A [`Failure`] that names the file which is missing or cannot be read.
pub fn read_visibility(directory: &Path) -> Result<VisibilityReport, Failure> {
    let mut report: VisibilityReport = read_json(&directory.join("visibility.json"), "visibility report")?;
    report.sky.map = read_sky(&directory.join("sky.csv"))?;
    Ok(report)
}

/// Returns the page of the results of visibility requirements.
pub fn visibility_page(report: &VisibilityReport) -> Page {
    let camera = &report.camera;
    let met = report.requirements.iter().filter(|verdict| verdict.status.is_met()).count();
    let sections = vec![
        requirements(report),
        detection(report),
        limiting_magnitude(report),
        sky(report),
        exposure_window(report),
        target_range(report),
    ];
    let field = camera.field_deg.map_or_else(|| "–".to_owned(), |[w, h]| format!("{w:.2}° × {h:.2}°"));
    Page {
        title: report.title.clone(),
        kind: "Visibility: requirements",
        version: report.version.clone(),
        lead: vec![format!("{met} of {} requirements are met.", report.requirements.len())],
        warnings: Vec::new(),
        verdict: Verdict::new(report.requirements.iter().map(finding).collect()),
        facts: vec![
            ("File", report.name.clone()),
            ("Field", field),
            ("Nominal exposure", format!("{} s", significant(camera.nominal_s))),
            ("Required stars", camera.n_min.to_string()),
            ("Required probability", probability(camera.probability)),
            ("Star of V = 0", format!("{} e/s", significant(camera.zero_point_e_per_s))),
            ("Saturation", format!("{} e", significant(camera.saturation_e))),
            ("Background", format!("{} e/s per pixel", significant(camera.background_e_per_s))),
            ("Boresight", report.version.clone()),
        ],
        sections,
        names_paper: false,
        data: serde_json::json!({ "visibility": report }),
    }
}

/// Returns the finding on a requirement: good if the model and the simulation show it, fair if only the model
/// does.
fn finding(requirement: &::visibility::Verdict) -> Finding {
    let grade = match requirement.status {
        Status::MetSimulated => Grade::Good,
        Status::MetModel => Grade::Fair,
        Status::NotMet | Status::Impossible => Grade::Poor,
        Status::NotDecided => Grade::NotJudged,
    };
    let subject = format!("{} {}", requirement.id, requirement.status.words());
    let evidence = match &requirement.binds {
        Some(binds) => format!("{}. Binding constraint: {binds}.", requirement.evidence),
        None => format!("{}.", requirement.evidence),
    };
    let doubt = match requirement.status {
        Status::MetModel => "Shown by the model alone; `--frames N` simulates it.",
        _ => "",
    };
    Finding::new(grade, subject, format!("{}: {evidence}", requirement.text)).and(doubt)
}

fn rate_text(simulated: Option<&SimulatedRate>) -> String {
    simulated.map_or_else(
        || "–".to_owned(),
        |s| format!("{} of {} ({:.1}–{:.1}\u{a0}%)", s.count, s.of, 100.0 * s.low, 100.0 * s.high),
    )
}

/// Returns the verification table.
fn requirements(report: &VisibilityReport) -> Section {
    let mut table = DataTable::new([
        "requirement",
        "text",
        "status",
        "required",
        "reached",
        "margin",
        "simulated",
        "evidence",
    ]);
    let mut found = DataTable::new([
        "requirement",
        "parameter",
        "value that meets the requirement",
        "probability",
        "simulated",
        "value that fails",
        "probability at that value",
    ])
    .caption("Results of the searches.");
    for verdict in &report.requirements {
        let margin = verdict.margin.map(|margin| match verdict.margin_unit.as_ref() {
            "points" => format!("{margin:.1} points"),
            unit => format!("{} {unit}", significant(margin)),
        });
        let evidence = match &verdict.binds {
            Some(binds) => format!("{}. Binding constraint: {binds}.", verdict.evidence),
            None => verdict.evidence.clone(),
        };
        table.push([
            verdict.id.clone(),
            verdict.text.clone(),
            verdict.status.words().to_owned(),
            probability(verdict.asked),
            probability(verdict.reached),
            margin.unwrap_or_else(|| "–".to_owned()),
            rate_text(verdict.simulated.as_ref()),
            evidence,
        ]);
        if let Some(f) = &verdict.found {
            let unit = |value: f64| format!("{} {}", significant(value), f.unit);
            found.push([
                verdict.id.clone(),
                f.parameter.to_string(),
                unit(f.value),
                probability(f.probability),
                rate_text(f.simulated.as_ref()),
                f.failing_value.map_or_else(|| "–".to_owned(), unit),
                f.failing_probability.map_or_else(|| "–".to_owned(), probability),
            ]);
        }
    }
    let section = Section::new("requirements", "Verification table").table(table.wordy());
    if found.rows.is_empty() { section } else { section.table(found.wordy()) }
}

/// Returns the section on the probability of detection against magnitude.
fn detection(report: &VisibilityReport) -> Section {
    let section = Section::new("detection", "Detection against magnitude");
    if report.detection.is_empty() {
        return section.absent("No star is detected with a probability of 50 % at the nominal exposure.");
    }
    let model = &report.detection;
    let seen = &report.detection_simulated;
    let magnitudes: Vec<f64> = model.iter().map(|p| p.magnitude).collect();
    let mut traces = vec![dashed(
        "model, a star of mean colour",
        magnitudes,
        model.iter().map(|p| rounded(p.probability, 6)).collect(),
        REFERENCE,
    )];
    if !seen.is_empty() {
        let x: Vec<f64> = seen.iter().map(|p| p.magnitude).collect();
        let expected = seen.iter().map(|p| rounded(p.analytic, 6)).collect();
        let model = line("model, mean over the simulated stars", x.clone(), expected, MEASURED);
        traces.push(model.mode(Mode::LinesAndMarkers).marker(Marker::new().size(13).symbol(Symbol::Square)));
        let low: Vec<f64> = seen.iter().map(|p| p.low).collect();
        let high: Vec<f64> = seen.iter().map(|p| p.high).collect();
        let rate = seen.iter().map(|p| rounded(p.count as f64 / p.of.max(1) as f64, 6)).collect();
        traces.push(intervals("simulated, the same stars, 95 %", x, rate, &low, &high, BESIDE));
    }
    let mut data = DataTable::new([
        "V",
        "electrons",
        "probability",
        "detected",
        "of",
        "low",
        "high",
        "model, same stars",
    ]);
    for point in model {
        let simulated = seen.iter().find(|s| s.magnitude == point.magnitude);
        let number = |pick: fn(&visibility::SimulatedPoint) -> f64| cell(simulated.map(pick));
        let count = |pick: fn(&visibility::SimulatedPoint) -> u64| {
            simulated.map_or_else(|| "–".to_owned(), |s| pick(s).to_string())
        };
        data.push([
            format!("{:.1}", point.magnitude),
            significant(point.electrons),
            significant(point.probability),
            count(|s| s.count),
            count(|s| s.of),
            number(|s| s.low),
            number(|s| s.high),
            number(|s| s.analytic),
        ]);
    }
    let caption = if seen.is_empty() {
        "Probability that a star of mean colour is detected at the nominal exposure, by the model. No frame was \
         simulated."
    } else {
        "Probability that a star is detected at the nominal exposure. Compare the simulation (orange) with \
         the model averaged over the same stars (blue squares). Both curves are flatter than the model for a \
         star of mean colour (grey), because stars of equal V magnitude but different colour are brighter or \
         fainter in the camera's band."
    };
    section.chart(Chart::new(caption, 400, data, traces, axes("V, mag", "probability").legend(true)))
}

/// Returns the section on limiting magnitude and number of stars against exposure time.
fn limiting_magnitude(report: &VisibilityReport) -> Section {
    let curve = &report.limiting_magnitude;
    let section = Section::new("limiting-magnitude", "Limiting magnitude against exposure");
    if curve.is_empty() {
        return section.absent("The result has no curve.");
    }
    let x: Vec<f64> = curve.iter().map(|p| p.exposure_s).collect();
    let y = |pick: &dyn Fn(&visibility::LimitPoint) -> Option<f64>| {
        curve.iter().map(|p| pick(p).map_or(f64::NAN, |value| rounded(value, 5))).collect::<Vec<_>>()
    };
    let asked = format!("detected with {}", probability(report.camera.probability));
    let panels = vec![
        Panel::new(
            "V, mag",
            vec![
                line("detected with 50.0 %", x.clone(), y(&|p| p.half), BESIDE),
                line(&asked, x.clone(), y(&|p| p.asked), MEASURED),
            ],
        ),
        Panel::new("stars", vec![line("stars", x.clone(), y(&|p| Some(p.stars)), MEASURED)]),
        Panel::new("probability", vec![line("enough", x, y(&|p| Some(p.probability)), MEASURED)]),
    ];
    let (traces, layout) = stacked(log_axis("exposure, s"), panels);
    let mut data = DataTable::new([
        "exposure, s",
        "V at 0.5",
        "V at required probability",
        "stars",
        "probability of enough stars",
    ]);
    for p in curve {
        data.push([
            significant(p.exposure_s),
            cell(p.half),
            cell(p.asked),
            significant(p.stars),
            significant(p.probability),
        ]);
    }
    section.chart(Chart::new(
        "Limiting magnitude, mean number of detected stars over the sky, and probability of enough stars.",
        620,
        data,
        traces,
        layout,
    ))
}

/// Returns the section on the number of detected stars over the whole sky.
fn sky(report: &VisibilityReport) -> Section {
    let sky = &report.sky;
    let section = Section::new("sky", "Stars over the sky");
    if sky.map.is_empty() {
        return section.absent("No pointing was evaluated.");
    }
    let counted: Vec<_> = sky.map.iter().filter(|p| p.excluded.is_none()).collect();
    let (traces, layout) = sky_map(&counted, sky.map.len());
    let mut data = DataTable::new(["Dec from, °", "Dec to, °", "pointings", "fewest stars", "mean", "most"])
        .caption("Counted pointings by declination; sky.csv has every pointing.");
    let mut by_declination = counted.clone();
    by_declination.sort_by(|a, b| a.dec_deg.total_cmp(&b.dec_deg));
    for bin in bins(by_declination.len(), 18) {
        let of = by_declination.get(bin).unwrap_or_default();
        let (Some(first), Some(last)) = (of.first(), of.last()) else { continue };
        let mut cells = vec![format!("{:.1}", first.dec_deg), format!("{:.1}", last.dec_deg)];
        cells.extend(summary(of.iter().map(|p| p.stars), 2));
        data.push(cells);
    }
    let [sun, moon, earth] = sky.excluded;
    let mut worst = DataTable::new([
        "RA, °",
        "Dec, °",
        "time (UTC)",
        "stars above the limit",
        "stars detected, expected",
        "probability of enough stars",
    ])
    .caption(format!(
        "The pointings with the fewest stars. The limit is the magnitude at which a star of mean colour is \
         detected with {}; the expected number is the sum of the detection probabilities of all stars of the \
         field, fainter ones included, and can be larger.",
        probability(report.camera.probability)
    ));
    for p in &sky.worst {
        worst.push([
            format!("{:.2}", p.ra_deg),
            format!("{:.2}", p.dec_deg),
            p.time_utc.get(..19).unwrap_or(&p.time_utc).replace('T', " "),
            p.in_field.to_string(),
            significant(p.stars),
            probability(p.probability),
        ]);
    }
    section
        .text(format!(
            "{} of {} pointings count; {sun} are excluded by the Sun, {moon} by the Moon, {earth} by the \
             Earth. Mean {} stars; 1, 10 and 50 % of the pointings have fewer than {}, {} and {}.",
            sky.counted,
            sky.pointings,
            significant(sky.stars),
            significant(sky.quantiles[0]),
            significant(sky.quantiles[1]),
            significant(sky.quantiles[2])
        ))
        .chart(Chart::new(
            "Expected number of detected stars at the nominal exposure. Each direction shows the number of \
             the nearest counted boresight, and none if that is farther than 1.5 times the spacing of the \
             boresights. Mollweide's equal-area projection, as seen from within: right ascension grows to \
             the left, 0 in the middle; a line every 30°.",
            480,
            data,
            traces,
            layout,
        ))
        .table(worst)
}

/// Returns the section on exposure time against range.
fn exposure_window(report: &VisibilityReport) -> Section {
    let curve = &report.exposure_window;
    let section = Section::new("exposure-window", "Exposure window against range");
    if curve.is_empty() {
        return section.absent("The file defines no target: no over-exposure limits the exposure.");
    }
    let x: Vec<f64> = curve.iter().map(|p| rounded(p.range_km, 6)).collect();
    let y = |pick: &dyn Fn(&visibility::WindowPoint) -> Option<f64>| {
        curve.iter().map(|p| pick(p).unwrap_or(f64::NAN)).collect::<Vec<_>>()
    };
    let traces = vec![
        line("longest: target not over-exposed", x.clone(), y(&|p| Some(p.longest_s)), WRONG),
        line("longest in half of the aspects", x.clone(), y(&|p| Some(p.median_s)), BESIDE),
        line("shortest: enough stars", x, y(&|p| p.shortest_s), MEASURED),
    ];
    let mut data = DataTable::new([
        "range, km",
        "longest, s",
        "longest in half of the aspects, s",
        "shortest, s",
        "open",
        "stars",
        "probability of enough stars",
    ]);
    for p in curve {
        data.push([
            significant(p.range_km),
            significant(p.longest_s),
            significant(p.median_s),
            cell(p.shortest_s),
            if p.is_open { "yes" } else { "no" }.to_owned(),
            significant(p.stars),
            significant(p.probability),
        ]);
    }
    let closes = report.stars_lost.as_ref().and_then(|lost| lost.window_closes_km);
    let section = match closes {
        Some(range_km) => section.text(format!(
            "The window closes at {} km: at shorter range, no exposure gives enough stars without \
             over-exposing the target.",
            significant(range_km)
        )),
        None => section,
    };
    section.chart(Chart::new(
        "Where the blue line is below the red one, an exposure meets both limits.",
        420,
        data,
        traces,
        Layout::new(log_axis("range, km"), log_axis("exposure, s")),
    ))
}

/// Returns the section on the greatest range by phase angle.
fn target_range(report: &VisibilityReport) -> Section {
    let curve = &report.target_range;
    let section = Section::new("target-range", "Greatest range of the target");
    if curve.is_empty() {
        return section.absent("The file defines no target.");
    }
    let middle: Vec<f64> = curve.iter().map(|p| 0.5 * (p.phases_deg[0] + p.phases_deg[1])).collect();
    let y = |pick: &dyn Fn(&visibility::RangeByPhase) -> Option<f64>| {
        curve.iter().map(|p| pick(p).unwrap_or(f64::NAN)).collect::<Vec<_>>()
    };
    let traces = vec![
        line("nominal exposure", middle.clone(), y(&|p| p.nominal_km), MEASURED).mode(Mode::LinesAndMarkers),
        line("longest exposure", middle, y(&|p| p.longest_km), BESIDE).mode(Mode::LinesAndMarkers),
    ];
    let mut data = DataTable::new(["phase from, °", "to, °", "nominal, km", "longest, km"]);
    for p in curve {
        data.push([
            format!("{:.1}", p.phases_deg[0]),
            format!("{:.1}", p.phases_deg[1]),
            cell(p.nominal_km),
            cell(p.longest_km),
        ]);
    }
    section.chart(Chart::new(
        "Greatest range at which the target is detected with the required probability, by phase angle.",
        360,
        data,
        traces,
        Layout::new(Axis::titled("phase angle, °"), log_axis("range, km")),
    ))
}
