//! Report of a run: errors over the range, pictures along the approach.

use ::report::charts::chart::{Chart, MEASURED, REFERENCE, axes, band, line, points, rounded};
use ::report::charts::thinning::evenly;
use ::report::figures::run_page::run_page;
use ::report::figures::words::{capital, display_name};
use ::report::page::data_table::DataTable;
use ::report::page::picture::{Mark, Picture, Pixels, RenderedPictures, RowMapping, Shape, Stretch};
use ::report::page::{Page, Section};
use ::report::verdict::rules::{Measured, against_baseline, bias_sentence};
use ::report::verdict::{Finding, Verdict};
use ::report::{RunFiles, WorldReport};
use contract::{PixelPoint, Window};
use files::Failure;
use run::plain::{Plain, PlainWorld, Scored, read_scored};
use run::{AnyJudgement, Options, ScenarioSource, WorldScenario as _};

use crate::world::{MiddleRange, range_error};

/// Number of pictures of a report.
const PICTURES: usize = 6;
/// Number of pictures of the worst frames.
const WORST: usize = 3;
/// Rows of the table behind the chart.
const TABLE_ROWS: usize = 24;

/// Returns the report of the world's runs.
pub(crate) fn world_report() -> WorldReport {
    WorldReport { code: Plain::<MiddleRange>::CODE, page, pictures, budget: None }
}

fn page(files: &RunFiles, _: Option<&mut dyn AnyJudgement>) -> Result<Page, Failure> {
    let mut page = run_page(files)?;
    let scored = read_scored::<MiddleRange>(&files.directory, &files.measurements)?;
    let rows: Vec<usize> = evenly_placed(scored.len(), PICTURES);
    let shown =
        rows.iter().filter_map(|row| scored.get(*row)).map(|scored| scored.truth.frame).collect::<Vec<_>>();
    let (pictures, _) = pictures(files, &shown)?;
    page.kind = "Middle range: a run";
    let findings = page.verdict.findings().iter().cloned().chain([range_finding(&page)]).collect();
    page.verdict = Verdict::new(findings);
    page.sections.insert(0, errors(&scored));
    page.sections.insert(0, Section::new("approach", "The approach in pictures").pictures(pictures));
    page.sections.insert(0, worst_frames(files, &scored)?);
    Ok(page)
}

/// Returns the finding on the error of the range, for which there is no requirement, from the figures.
fn range_finding(page: &Page) -> Finding {
    let value = |name: &str| page.data.get(name)?.get("value")?.as_f64();
    let rms =
        value("range_rms_percent").map(|value| Measured { value, low: None, high: None, count: None, of: 0 });
    let bias = rms.map(|rms| bias_sentence(rms.value, value("range_bias_mean_percent"), "%"));
    against_baseline("range error", rms, None, "% of the range").and(&bias.unwrap_or_default())
}

/// Returns pictures of wrong and missed frames, spread over the run, and of the largest errors of the range.
fn worst_frames(files: &RunFiles, scored: &[Scored<MiddleRange>]) -> Result<Section, Failure> {
    let failed: Vec<u64> = scored
        .iter()
        .filter(|scored| MiddleRange::judge(scored).0 != "correct")
        .map(|scored| scored.truth.frame)
        .collect();
    let mut frames: Vec<u64> = evenly_placed(failed.len(), WORST)
        .into_iter()
        .filter_map(|place| failed.get(place).copied())
        .collect();
    let mut errors: Vec<(f64, u64)> = scored
        .iter()
        .filter_map(|scored| Some((range_error(scored)?.abs(), scored.truth.frame)))
        .filter(|(_, frame)| !failed.contains(frame))
        .collect();
    errors.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
    frames.extend(errors.iter().take(WORST.saturating_sub(frames.len())).map(|(_, frame)| *frame));
    let section = Section::new("worst-frames", "Worst frames");
    if frames.is_empty() {
        return Ok(section.absent("No frame has a measurement."));
    }
    let (shown, _) = pictures(files, &frames)?;
    let text = "Wrong and missed frames, then the largest errors of the range as a part of it. Green: true disk; \
        orange: measured disk.";
    Ok(section.text(text).pictures(shown))
}

/// Returns the error of the measured range over the range, with the stated standard deviations.
fn errors(scored: &[Scored<MiddleRange>]) -> Section {
    let mut table =
        DataTable::new(["frame", "range, km", "radius, px", "exposure, ms", "range error, %", "verdict"]);
    let (mut range, mut error, mut sigma) = (Vec::new(), Vec::new(), Vec::new());
    for scored in evenly(scored.len()).into_iter().filter_map(|row| scored.get(row)) {
        let Some((share, answer)) = range_error(scored).zip(scored.answer.as_ref()) else { continue };
        range.push(rounded(scored.truth.range_km, 5));
        error.push(rounded(100.0 * share, 3));
        sigma.push(rounded(300.0 * answer.sigma_range_km.unwrap_or(0.0) / scored.truth.range_km, 3));
    }
    for scored in evenly_placed(scored.len(), TABLE_ROWS).into_iter().filter_map(|row| scored.get(row)) {
        let truth = &scored.truth;
        let shown =
            range_error(scored).map_or_else(|| "–".to_owned(), |share| format!("{:.2}", 100.0 * share));
        table.push([
            truth.frame.to_string(),
            format!("{:.4}", truth.range_km),
            format!("{:.2}", truth.radius_px),
            format!("{:.3}", 1000.0 * truth.exposure_s),
            shown,
            MiddleRange::judge(scored).0.to_owned(),
        ]);
    }
    let below = sigma.iter().map(|three_sigma| -three_sigma).collect();
    let mut traces = band("3 σ", range.clone(), below, sigma, "rgba(54, 134, 201, 0.15)").to_vec();
    traces.push(line("exact", range.clone(), vec![0.0; range.len()], REFERENCE));
    traces.push(points("measured", range, error, MEASURED));
    let caption = "Error of the measured range, and three of its stated standard deviations.";
    let layout = axes("range, km", "range error, %");
    Section::new("errors", "Range error").chart(Chart::new(caption, 380, table, traces, layout))
}

/// Returns up to `count` places of a list, the first and the last among them.
fn evenly_placed(length: usize, count: usize) -> Vec<usize> {
    let shown = count.min(length);
    (0..shown).map(|i| if shown > 1 { i * (length - 1) / (shown - 1) } else { 0 }).collect()
}

/// Draws frames of a run again, each with the exposure time of its truth.
fn pictures(files: &RunFiles, frames: &[u64]) -> Result<RenderedPictures, Failure> {
    let source = ScenarioSource::read(&files.path("run.toml").to_string_lossy())?;
    let mission = Plain::<MiddleRange>::prepare(&source, source.typed("report")?, Options::default())?;
    let scored = read_scored::<MiddleRange>(&files.directory, &files.measurements)?;
    let mut pictures = Vec::new();
    for scored in scored.iter().filter(|scored| frames.contains(&scored.truth.frame)) {
        pictures.push(picture(&mission, scored)?);
    }
    Ok((pictures, None))
}

fn picture(mission: &Plain<MiddleRange>, scored: &Scored<MiddleRange>) -> Result<Picture, Failure> {
    let truth = &scored.truth;
    let (frame, _) = mission.world().expose(truth.frame, &Some(truth.exposure_s))?;
    let (columns, rows) = (frame.columns(), frame.rows());
    let window = around(truth.centre, truth.radius_px, columns, rows);
    let pixels = Pixels { columns, rows, dn: frame.dn() };
    let mut picture = Picture::new(pixels, window, RowMapping::WHOLE, Stretch::Linear)?;
    let (verdict, cause) = MiddleRange::judge(scored);
    let cause = cause.map_or_else(String::new, |cause| format!(": {}", display_name(&cause)));
    picture.title = format!("{}{cause}.", capital(&display_name(verdict)));
    let error = range_error(scored);
    let error = error.map_or_else(String::new, |share| format!(", range error {:.2} %", 100.0 * share));
    picture.caption = format!(
        "Frame {}, {:.3} km, exposure {:.2} ms{error}.",
        truth.frame,
        truth.range_km,
        1000.0 * truth.exposure_s
    );
    let disk = |at, radius_px, class, title: &str| Mark {
        at,
        shape: Shape::Circle(radius_px),
        class,
        title: title.to_owned(),
    };
    if let Some(centre) = truth.centre {
        picture.marks.push(disk(centre, truth.radius_px, "truth", "true disk"));
    }
    if let Some((centre, radius_px)) =
        scored.answer.as_ref().and_then(|answer| answer.centre.zip(answer.radius_px))
    {
        let [x, y] = centre;
        picture.marks.push(disk(PixelPoint::new(x, y), radius_px, "measured", "measured disk"));
    }
    Ok(picture)
}

/// Returns a window of the shape of the image around a disk, within the image.
fn around(centre: Option<PixelPoint>, radius_px: f64, columns: usize, rows: usize) -> Window {
    let side = ((2.6 * radius_px) as usize + 12).min(columns).min(rows);
    let first =
        |at: f64, length: usize| ((at - 0.5 * side as f64).round().max(0.0) as usize).min(length - side);
    let at = centre.unwrap_or(PixelPoint::new(0.5 * columns as f64, 0.5 * rows as f64));
    Window { x: first(at.x, columns), y: first(at.y, rows), columns: side, rows: side }
}
