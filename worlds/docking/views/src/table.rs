//! Table of a docking score for a user: one row per bin of range and lens, with the paper's formulas beside
//! the pipeline's best estimator.
use comfy_table::{Attribute, Cell};
use contract::docking::FailedCheck;
use docking::scoring::{DockingGroup, DockingScore, GrossError, MissCause, names};
use indexmap::IndexMap;
use score::{Figure, warm_up_note};
use view::terminal::{finish, percent, plain_table, share, wrapped};

/// Returns the score of a docking run as text: single fields, estimates at the end of portions, misses and
/// wrong results by cause. Ends with a line feed.
pub fn docking_table(score: &DockingScore, styled: bool) -> String {
    let rows = rows(score);
    let mut text = if score.renderer == "mitsuba" { "Scene rendered by Mitsuba.\n" } else { "" }.to_owned();
    text.push_str(&fields(&rows, styled));
    text.push_str(&wrapped(
        "Pose: all six parameters reported and none grossly wrong, percent (95 % interval) of the fields with a \
         resolved target or with a reported pose. Of clear: percent of the fields with a resolved target wholly \
         in the image. Range only: measured from the station's outline, percent of the fields (RMS error). \
         Errors: RMS over the poses, best estimator / paper's formulas; across: d1 and d2 together. In 3σ: \
         errors within three standard deviations. NEES: mean 1 if σ is correct. Doubtful: failed the pipeline's \
         own tests.\n",
    ));
    if score.portions > 0 {
        text.push('\n');
        text.push_str(&portions(&rows, styled));
        text.push_str(&wrapped(
            "RMS errors at the end of portions; in 3σ and NEES from the second report on.\n",
        ));
    }
    text.push_str(&latency(score));
    if let Some(note) = warm_up_note(score.warm_up_frames, "fields") {
        text.push_str(&wrapped(&format!("{note}\n")));
    }
    let misses = |row: &Row<'_>| row.misses.clone();
    text.push('\n');
    text.push_str(&causes("Misses by cause", &rows, &MissCause::CODES, misses, styled));
    text.push('\n');
    text.push_str(&causes(
        "Doubtful poses by failed test",
        &rows,
        &FailedCheck::ALL.map(FailedCheck::code),
        |row| row.doubtful.clone(),
        styled,
    ));
    text.push('\n');
    text.push_str(&causes(
        "Wrong measurements by error",
        &rows,
        &GrossError::ALL.map(GrossError::code),
        |row| row.wrong.clone(),
        styled,
    ));
    text
}

/// One row: a group, or all groups.
struct Row<'a> {
    name: &'a str,
    frames: u64,
    portions: u64,
    figures: &'a IndexMap<String, Figure>,
    misses: &'a IndexMap<String, u64>,
    wrong: &'a IndexMap<String, u64>,
    doubtful: &'a IndexMap<String, u64>,
}

impl Row<'_> {
    fn figure(&self, name: &str, format: fn(f64) -> String) -> String {
        self.value(name).map_or("–".to_owned(), format)
    }

    fn value(&self, name: &str) -> Option<f64> {
        self.figures.get(name).and_then(|figure| figure.value)
    }

    /// Formats the value of the best estimator and, after a slash, that of the paper's formulas.
    fn values_of_both(&self, name: &str, format: fn(f64) -> String) -> String {
        let paper = self.figure(&format!("{}{name}", names::PAPER), format);
        match (self.figure(name, format).as_str(), paper.as_str()) {
            ("–", "–") => "–".to_owned(),
            (best, paper) => format!("{best} / {paper}"),
        }
    }

    /// Formats the frequency and the error of outcomes with only a range.
    fn range_only(&self) -> String {
        let error = self.value(names::RANGE_ONLY_RMS_PERCENT);
        let share = self.figure(names::RANGE_ONLY_RATE, percent);
        error.map_or(share.clone(), |error| format!("{share} ({} %)", three_digits(error)))
    }

    fn rate_with_interval(&self, name: &str) -> String {
        let Some(figure) = self.figures.get(name) else { return "–".to_owned() };
        match (figure.value, figure.low, figure.high) {
            (Some(value), Some(low), Some(high)) => {
                format!("{} ({}–{})", percent(value), percent(low), percent(high))
            }
            (Some(value), ..) => percent(value),
            (None, ..) => "–".to_owned(),
        }
    }
}

/// Returns the groups and all together; only all if one group contains everything.
fn rows(score: &DockingScore) -> Vec<Row<'_>> {
    let groups = score.groups.iter().map(|(name, group)| {
        let DockingGroup { frames, portions, figures, misses, wrong, doubtful } = group;
        Row { name, frames: *frames, portions: *portions, figures, misses, wrong, doubtful }
    });
    let all = Row {
        name: "all",
        frames: score.frames,
        portions: score.portions,
        figures: &score.figures,
        misses: &score.misses,
        wrong: &score.wrong,
        doubtful: &score.doubtful,
    };
    groups.filter(|_| score.groups.len() > 1 || score.warm_up_frames > 0).chain([all]).collect()
}

fn fields(rows: &[Row<'_>], styled: bool) -> String {
    let header = [
        "range, lens",
        "fields",
        "range error\nbest / paper",
        "across\nbest / paper",
        "attitude\nbest / paper",
        "in 3σ\n%",
        "NEES",
        "doubtful\n%",
        "wrong\n%",
        "pose\n%",
        "of clear\n%",
        "range only\n%",
        "missed\n%",
    ];
    sheet(
        &header,
        rows.iter().map(|row| {
            vec![
                row.name.to_owned(),
                row.frames.to_string(),
                row.values_of_both(names::RANGE_RMS_M, length),
                row.values_of_both(names::LATERAL_RMS_M, length),
                row.values_of_both(names::ATTITUDE_RMS_DEG, degrees),
                row.figure(names::WITHIN_3_SIGMA, percent),
                row.figure(names::NEES_MEAN, plain),
                row.figure(names::DOUBTFUL_RATE, percent),
                row.figure(names::WRONG_RATE, percent),
                row.rate_with_interval(names::SUCCESS_RATE),
                row.figure(names::CLEAR_SUCCESS_RATE, percent),
                row.range_only(),
                row.figure(names::MISS_RATE, percent),
            ]
        }),
        styled,
    )
}

fn portions(rows: &[Row<'_>], styled: bool) -> String {
    let header = [
        "portions",
        "reports",
        "range ρ\nbest / paper",
        "range rate u\nbest / paper",
        "passive pitch α\nbest / paper",
        "passive yaw β\nbest / paper",
        "pitch\nφ1",
        "yaw\nφ2",
        "roll\nφ3",
        "in 3σ\n%",
        "NEES",
    ];
    let name = |name: &str| format!("{}{name}", names::MOTION);
    sheet(
        &header,
        rows.iter().filter(|row| row.portions > 0).map(|row| {
            let mut cells = vec![
                row.name.to_owned(),
                row.portions.to_string(),
                row.values_of_both(&name(names::RANGE_RMS_M), length),
                row.values_of_both(&name("range_rate_rms_m_s"), speed),
            ];
            cells.push(row.values_of_both(&name("alpha_rms_deg"), degrees));
            cells.push(row.values_of_both(&name("beta_rms_deg"), degrees));
            for angle in ["phi1_rms_deg", "phi2_rms_deg", "phi3_rms_deg"] {
                cells.push(row.figure(&name(angle), degrees));
            }
            cells.push(row.figure(&name(names::WITHIN_3_SIGMA), percent));
            cells.push(row.figure(&name(names::NEES_MEAN), plain));
            cells
        }),
        styled,
    )
}

/// Returns a description of latencies.
fn latency(score: &DockingScore) -> String {
    let value = |name: &str| score.figures.get(name).and_then(|figure| figure.value);
    let latency = value(names::LATENCY_FIELDS)
        .map(|n| format!("First pose {n:.0} fields after the target was first clear."));
    let portion = value(names::PORTION_LATENCY_FIELDS)
        .map(|n| format!("A portion takes {n:.1} fields from its first measured field to its report."));
    let renewed = value(names::RENEWED_WITHIN_1S).map(|rate| {
        format!("In {} % of the clear fields, the last report is at most 1 s old.", percent(rate))
    });
    let speed = value(names::SPEED_SCORE_MEAN)
        .map(|score| format!("Mean SPEED pose score of the poses: {score:.4}."));
    let lines: Vec<String> = [latency, portion, renewed, speed].into_iter().flatten().collect();
    if lines.is_empty() { String::new() } else { wrapped(&format!("\n{}\n", lines.join("\n"))) }
}

/// Counts by cause, one column each, with their fraction of the row's fields; a single line if there are
/// none.
fn causes(
    title: &str,
    rows: &[Row<'_>],
    codes: &[&str],
    pick: impl Fn(&Row<'_>) -> IndexMap<String, u64>,
    styled: bool,
) -> String {
    let counts: Vec<IndexMap<String, u64>> = rows.iter().map(pick).collect();
    let occurring: Vec<&str> =
        codes.iter().copied().filter(|code| counts.iter().any(|counts| counts.contains_key(*code))).collect();
    if occurring.is_empty() {
        return format!("{title}: none\n");
    }
    let words: Vec<String> = occurring.iter().map(|code| code.replace('_', " ")).collect();
    let header: Vec<&str> = [title].into_iter().chain(words.iter().map(String::as_str)).collect();
    let lines = rows.iter().zip(&counts).filter(|(_, counts)| !counts.is_empty()).map(|(row, counts)| {
        let cell =
            |code: &&str| counts.get(*code).map_or("–".to_owned(), |count| share(*count, row.frames));
        [row.name.to_owned()].into_iter().chain(occurring.iter().map(cell)).collect()
    });
    sheet(&header, lines, styled)
}

fn sheet(header: &[&str], rows: impl Iterator<Item = Vec<String>>, styled: bool) -> String {
    let mut table = plain_table(styled);
    table.set_header(header.iter().map(|text| Cell::new(text).add_attribute(Attribute::Bold)));
    for row in rows {
        table.add_row(row);
    }
    finish(table)
}

/// Formats a length in metres, or in millimetres below one metre; three digits.
fn length(m: f64) -> String {
    if m < 0.9995 { format!("{} mm", three_digits(1000.0 * m)) } else { format!("{} m", three_digits(m)) }
}

/// Formats a speed in metres per second, or in millimetres per second below one.
fn speed(m_s: f64) -> String {
    format!("{}/s", length(m_s))
}

fn degrees(deg: f64) -> String {
    if deg < 0.01 { format!("{deg:.4}°") } else { format!("{}°", three_digits(deg)) }
}

fn plain(value: f64) -> String {
    three_digits(value)
}

fn three_digits(value: f64) -> String {
    match value.abs() {
        v if v < 0.9995 => format!("{value:.3}"),
        v if v < 9.995 => format!("{value:.2}"),
        v if v < 99.95 => format!("{value:.1}"),
        _ => format!("{value:.0}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn figures(success: u64, of: u64) -> IndexMap<String, Figure> {
        let rate = Figure::rate(&[(0..of).map(|i| i < success).collect()]);
        let rms = |scale: f64| Figure::rms(&[(0..success).map(|i| scale * (i % 7) as f64).collect()]);
        [
            (names::SUCCESS_RATE.to_owned(), rate),
            (names::RANGE_RMS_M.to_owned(), rms(0.002)),
            (format!("{}{}", names::PAPER, names::RANGE_RMS_M), rms(0.4)),
        ]
        .into()
    }

    fn score(groups: &[(&str, u64, u64)]) -> DockingScore {
        let group = |success, frames| DockingGroup {
            frames,
            portions: frames / 10,
            figures: figures(success, frames),
            misses: [("too_far".to_owned(), frames - success)].into_iter().filter(|(_, n)| *n > 0).collect(),
            wrong: IndexMap::new(),
            doubtful: IndexMap::new(),
        };
        let frames = groups.iter().map(|(_, _, frames)| frames).sum();
        let success = groups.iter().map(|(_, success, _)| success).sum();
        let all = group(success, frames);
        DockingScore {
            world: "docking".to_owned(),
            scenario: "docking".to_owned(),
            seed: 1,
            version: "0.1.0".to_owned(),
            renderer: "fast".to_owned(),
            warm_up_frames: 0,
            frames,
            portions: all.portions,
            figures: all.figures,
            groups: groups.iter().map(|(name, s, n)| ((*name).to_owned(), group(*s, *n))).collect(),
            misses: all.misses,
            wrong: all.wrong,
            doubtful: all.doubtful,
        }
    }

    #[test]
    fn a_row_a_group_and_the_paper_beside_the_best() {
        let text = docking_table(&score(&[("50–30 m, 15.0°", 80, 100), ("30–20 m, 15.0°", 100, 100)]), false);
        // A group has a line in each of the tables below each other.
        let lines: String = text.lines().filter(|line| line.starts_with("30–20 m")).collect();
        assert!(lines.contains("100 (") && lines.contains(" mm / "), "{lines}");
        assert!(text.lines().all(|line| line.chars().count() <= view::terminal::WIDTH), "{text}");
        assert!(text.lines().any(|line| line.starts_with("all")), "{text}");
        assert!(text.contains("too far") && text.ends_with("Wrong measurements by error: none\n"), "{text}");
    }

    #[test]
    fn an_empty_score_prints_dashes() {
        let text = docking_table(&score(&[]), false);
        assert!(text.contains('–') && !text.contains("NaN"), "{text}");
    }

    #[test]
    fn lengths_are_in_the_unit_that_suits_them() {
        assert_eq!(
            [0.00012, 0.0037, 0.4, 2.5, 31.0].map(length),
            ["0.120 mm", "3.70 mm", "400 mm", "2.50 m", "31.0 m"]
        );
    }
}
