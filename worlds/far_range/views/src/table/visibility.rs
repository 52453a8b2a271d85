//! Text output of requirements for a user: the verification table and the curves, for the terminal and as
//! Markdown.
use view::terminal::{finish, plain_table, wrapped};
use visibility::{Status, Verdict, VisibilityReport, digits};

/// Approximate number of points of a curve that are shown.
const CURVE_POINTS: usize = 9;

/// A table with heading, columns and rows.
struct TextTable {
    title: String,
    head: Vec<&'static str>,
    rows: Vec<Vec<String>>,
}

/// Returns the report as text; headings are bold with terminal codes if `styled`. Ends with a line feed.
pub fn visibility_table(report: &VisibilityReport, styled: bool) -> String {
    let mut text = wrapped(&format!("{}: {}\n{}\n", report.name, report.title, in_figures(report)));
    for verdict in &report.requirements {
        let [id, says, status, margin, evidence] = requirement(verdict);
        let heading = format!("\n{id}  {status}  (margin {margin})\n");
        text.push_str(&heading);
        text.push_str(&wrapped(&format!("    {says}\n    {evidence}\n")));
    }
    for sheet in curves(report) {
        text.push_str(&format!("\n{}\n", sheet.title));
        let mut table = plain_table(styled);
        table.set_header(sheet.head);
        for row in sheet.rows {
            table.add_row(row);
        }
        text.push_str(&finish(table));
    }
    for line in remarks(report) {
        text.push_str(&wrapped(&format!("\n{line}\n")));
    }
    text
}

/// Returns the report in Markdown.
pub fn visibility_markdown(report: &VisibilityReport) -> String {
    let mut text = format!("# {}\n\n{}\n", report.title, in_figures(report));
    let requirements = TextTable {
        title: "Requirements".to_owned(),
        head: vec!["ID", "requirement", "", "margin", "evidence"],
        rows: report.requirements.iter().map(|verdict| requirement(verdict).to_vec()).collect(),
    };
    let first = (!report.requirements.is_empty()).then_some(requirements);
    for sheet in first.into_iter().chain(curves(report)) {
        text.push_str(&format!("\n## {}\n\n| {} |\n|", sheet.title, sheet.head.join(" | ")));
        text.push_str(&" --- |".repeat(sheet.head.len()));
        text.push('\n');
        for row in sheet.rows {
            // A vertical bar would end the cell.
            let cells: Vec<_> = row.iter().map(|cell| cell.replace('|', "\\|")).collect();
            text.push_str(&format!("| {} |\n", cells.join(" | ")));
        }
    }
    for line in remarks(report) {
        text.push_str(&format!("\n{line}\n"));
    }
    text
}

fn in_figures(report: &VisibilityReport) -> String {
    let camera = &report.camera;
    let field = camera.field_deg.map_or_else(String::new, |[x, y]| format!("field {x:.1}° × {y:.1}°, "));
    format!(
        "{field}{} e⁻/s from V = 0, threshold {} DN, background {} e⁻/s per pixel, saturation {} e⁻, nominal \
         exposure {} s (stars trail {:.2} px)",
        digits(camera.zero_point_e_per_s),
        camera.threshold_dn,
        digits(camera.background_e_per_s),
        digits(camera.saturation_e),
        digits(camera.nominal_s),
        camera.star_trail_px
    )
}

fn curves(report: &VisibilityReport) -> Vec<TextTable> {
    let mut sheets = Vec::new();
    let asked = format!("{:.0} %", 100.0 * report.camera.probability);
    if !report.detection_simulated.is_empty() {
        let rows = report.detection_simulated.iter().map(|point| {
            vec![
                format!("{:.1}", point.magnitude),
                percent(point.analytic),
                format!("{} of {}", point.count, point.of),
                format!(
                    "{} ({} to {})",
                    percent(point.count as f64 / point.of as f64),
                    percent(point.low),
                    percent(point.high)
                ),
            ]
        });
        sheets.push(TextTable {
            title: "Detection of stars at the nominal exposure".to_owned(),
            head: vec!["V ± 0.05", "analytic, %", "simulated", "% (95 %)"],
            rows: rows.collect(),
        });
    }
    let rows = thinned(&report.limiting_magnitude).map(|point| {
        let magnitude = |value: Option<f64>| value.map_or("–".to_owned(), |v| format!("{v:.2}"));
        vec![
            digits(point.exposure_s),
            magnitude(point.half),
            magnitude(point.asked),
            format!("{:.1}", point.stars),
            percent(point.probability),
        ]
    });
    sheets.push(TextTable {
        title: format!("Exposure: V detected with 50 % and {asked} probability, stars over the sky"),
        head: vec!["exposure, s", "V, 50 %", "V, required", "stars", "enough, %"],
        rows: rows.collect(),
    });
    let rows = report.sky.worst.iter().map(|pointing| {
        vec![
            format!("{:.1}", pointing.ra_deg),
            format!("{:+.1}", pointing.dec_deg),
            pointing.in_field.to_string(),
            format!("{:.1}", pointing.stars),
            percent(pointing.probability),
        ]
    });
    sheets.push(TextTable {
        title: "Worst pointings at the nominal exposure".to_owned(),
        head: vec!["RA, °", "Dec, °", "above limit", "detected", "enough, %"],
        rows: rows.collect(),
    });
    if !report.exposure_window.is_empty() {
        let rows = thinned(&report.exposure_window).map(|point| {
            vec![
                digits(point.range_km),
                digits(point.longest_s),
                point.shortest_s.map_or("–".to_owned(), digits),
                if point.is_open { "open".to_owned() } else { "closed".to_owned() },
                digits(point.median_s),
                format!("{:.1}", point.stars),
                percent(point.probability),
            ]
        });
        sheets.push(TextTable {
            title: "Exposures without over-exposed target and with enough stars".to_owned(),
            head: vec!["range, km", "longest, s", "shortest, s", "", "median, s", "stars", "enough, %"],
            rows: rows.collect(),
        });
    }
    if !report.target_range.is_empty() {
        let km = |value: Option<f64>| value.map_or("–".to_owned(), digits);
        let rows = report.target_range.iter().map(|row| {
            let [low, high] = row.phases_deg;
            let phases = if low == high { format!("{low:.0}") } else { format!("{low:.0} to {high:.0}") };
            vec![phases, km(row.nominal_km), km(row.longest_km)]
        });
        sheets.push(TextTable {
            title: format!("Greatest range of the target, with {asked}"),
            head: vec!["phase, °", "nominal exposure, km", "longest, km"],
            rows: rows.collect(),
        });
    }
    sheets
}

/// Returns ID, text, status, margin and evidence.
fn requirement(verdict: &Verdict) -> [String; 5] {
    let margin = verdict.margin.map_or("–".to_owned(), |margin| {
        let sign = if margin >= 0.0 { "+" } else { "" };
        format!("{sign}{} {}", digits(margin), verdict.margin_unit)
    });
    let mut evidence = verdict.evidence.clone();
    if let Some(binds) = &verdict.binds {
        evidence.push_str(&format!("; {binds}"));
    }
    [verdict.id.clone(), verdict.text.clone(), verdict.status.words().to_owned(), margin, evidence]
}

/// Returns the ranges below a limit as words. Without a limit they are none or all of the ranges examined.
fn ranges_below(limit_km: Option<f64>, is_enough_at_nearest: bool) -> String {
    match limit_km {
        Some(km) => format!("nearer than {} km", digits(km)),
        None if is_enough_at_nearest => "at none of the ranges examined".to_owned(),
        None => "at any of the ranges examined".to_owned(),
    }
}

fn remarks(report: &VisibilityReport) -> Vec<String> {
    let sky = &report.sky;
    let [sun, moon, earth] = sky.excluded;
    let mut lines = vec![format!(
        "Sky: {} of {} pointings count ({sun} excluded by the Sun, {moon} by the Moon, {earth} by the \
         Earth). Detected stars: mean {:.1}; 1, 10 and 50 % of the pointings have fewer than {:.1}, {:.1} \
         and {:.1}. The mean probability of enough stars is {} % ({} stars); {} % of the pointings have \
         enough with a probability of {} % or more.",
        sky.counted,
        sky.pointings,
        sky.stars,
        sky.quantiles[0],
        sky.quantiles[1],
        sky.quantiles[2],
        percent(sky.probability),
        report.camera.n_min,
        percent(sky.share),
        percent(report.camera.probability)
    )];
    if let Some(lost) = &report.stars_lost {
        let nearest = report.exposure_window.last();
        let half_at_nearest = nearest.is_some_and(|point| point.probability >= 0.5);
        let open_at_nearest = nearest.is_some_and(|point| point.is_open);
        lines.push(format!(
            "Half of the frames have fewer than {} stars {}. No exposure both spares the target and has as many \
             stars with the required probability {}.",
            lost.n_min,
            ranges_below(lost.half_of_frames_km, half_at_nearest),
            ranges_below(lost.window_closes_km, open_at_nearest)
        ));
    }
    let count = |status| report.requirements.iter().filter(|verdict| verdict.status == status).count();
    if !report.requirements.is_empty() {
        lines.push(format!(
            "{} met (simulated), {} met (model), {} not decided, {} not met, {} impossible. Simulated rates \
             have one-sided bounds; those of stars have two-sided 95 % limits.",
            count(Status::MetSimulated),
            count(Status::MetModel),
            count(Status::NotDecided),
            count(Status::NotMet),
            count(Status::Impossible)
        ));
    }
    lines
}

/// Returns evenly spaced points of a curve, from its first point on.
fn thinned<T>(points: &[T]) -> impl Iterator<Item = &T> {
    let step = points.len().saturating_sub(1).div_ceil(CURVE_POINTS - 1).max(1);
    points.iter().step_by(step)
}

fn percent(share: f64) -> String {
    view::terminal::percent(share)
}
