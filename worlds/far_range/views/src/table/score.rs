//! Table for a user, in the form of Table 2 of the far-range paper.
use comfy_table::{Attribute, Cell};
use far_range::scoring::{Cause, ConsistencyRow, Score, Table2, Table2Distance, names};
use indexmap::IndexMap;
use score::{Figure, angle, attitude_note, warm_up_note};
use view::terminal::{WIDTH, finish, finish_within, percent, plain_table, share, wrapped};

/// Style of a printed score.
#[derive(Debug, Clone, Copy)]
pub struct TableStyle<'a> {
    /// True if text is set bold and dim with terminal codes; false if the output is not a terminal.
    pub styled: bool,
    /// Width of the terminal, columns. If a line does not fit, the intervals are placed below their values;
    /// if it still does not fit, the columns continue in a table below.
    pub width: usize,
    /// Published figures to print below those of the score; omitted unless the number of groups is the same.
    pub reference: Option<&'a Table2>,
    /// Score of the best mode on the same frames, to print below the score; omitted unless it has the same
    /// columns.
    pub best_mode: Option<&'a Score>,
}

impl Default for TableStyle<'_> {
    /// Returns a plain style with 80 columns, without published figures.
    fn default() -> Self {
        Self { styled: false, width: WIDTH, reference: None, best_mode: None }
    }
}

/// Returns the score of a far-range run as text: figures by group with their 95 % intervals, then the misses
/// and the wrong results by cause, each with its percentage of the column's frames. Ends with a line feed.
pub fn far_range_table(score: &Score, style: TableStyle<'_>) -> String {
    let columns = columns(score);
    let reference = style.reference.filter(|table| table.images.len() == columns.len());
    let best_mode = style.best_mode.map(self::columns).filter(|best_mode| best_mode.len() == columns.len());
    let rows = rows(&columns, reference, best_mode.as_deref());
    let one_line = sheet(&columns, &rows, " ", style.styled, usize::MAX);
    let fits = one_line.lines().next().is_some_and(|line| line.chars().count() <= style.width);
    let mut text = if fits { one_line } else { sheet(&columns, &rows, "\n", style.styled, style.width) };
    text.push_str(&wrapped(&notes(score, &columns, style.reference)));
    for (title, pick) in [
        ("Misses by cause", (|column: &Column<'_>| column.misses) as Counts),
        ("Wrong measurements by cause", |column| column.wrong),
    ] {
        text.push('\n');
        text.push_str(&causes(title, &columns, pick, style.styled));
    }
    if !score.consistency.is_empty() {
        text.push('\n');
        text.push_str(&consistency(&score.consistency, style.styled));
    }
    text
}

/// Returns the explanation of the rows, and notes on the figures. Ends with a line feed.
fn notes(score: &Score, columns: &[Column<'_>], reference: Option<&Table2>) -> String {
    let mut text = String::from(
        "Rates in percent with 95 % intervals. Columns and rows: errors of the direction in the camera system, \
         across columns and across rows. RMS of correct measurements: direction in arcsec, centroid (x, y) in \
         pixels. Start-up: frames before the first 20 correct measurements in a row. Cause of a wrong \
         measurement: reason why the target was not selected.\n",
    );
    if is_counted_in_any(columns, names::FALSE_ALARM_RATE) {
        text.push_str("False alarms: wrong measurements in frames without a visible target.\n");
    }
    if !score.consistency.is_empty() {
        text.push_str(
            "NEES and percent within 1 and 3 σ by the covariances of correct measurements; correct covariances \
             give 1, 68.3 and 99.7.\n",
        );
    }
    if let Some(note) = warm_up_note(score.warm_up_frames, "frames") {
        text.push_str(&format!("{note}\n"));
    }
    if let Some(note) = attitude_note(score.attitude.as_deref()) {
        text.push_str(&format!("{note}\n"));
    }
    if let Some(distance) = reference.and_then(|table| table.distance(score)) {
        let Table2Distance { mean_points, worst_points } = distance;
        text.push_str(&format!(
            "The 30 cells differ from the published values by {mean_points:.1} points on average, \
             {worst_points:.1} at most.\n"
        ));
    }
    text
}

/// One column: a group, or all groups.
struct Column<'a> {
    name: &'a str,
    frames: u64,
    figures: &'a IndexMap<String, Figure>,
    misses: &'a IndexMap<String, u64>,
    wrong: &'a IndexMap<String, u64>,
}

type Counts = for<'a> fn(&Column<'a>) -> &'a IndexMap<String, u64>;

/// Returns the groups and all together; only all if one group contains everything.
fn columns(score: &Score) -> Vec<Column<'_>> {
    let groups = score.groups.iter().map(|(name, group)| Column {
        name,
        frames: group.frames,
        figures: &group.figures,
        misses: &group.misses,
        wrong: &group.wrong,
    });
    let all = Column {
        name: "all",
        frames: score.frames,
        figures: &score.figures,
        misses: &score.misses,
        wrong: &score.wrong,
    };
    groups.filter(|_| score.groups.len() > 1 || score.warm_up_frames > 0).chain([all]).collect()
}

/// One row: its label, and the value and interval of every column.
struct Row {
    label: String,
    cells: Vec<(String, Option<String>)>,
    is_reference: bool,
}

fn rows(columns: &[Column<'_>], reference: Option<&Table2>, best_mode: Option<&[Column<'_>]>) -> Vec<Row> {
    let images = columns.iter().map(|column| (column.frames.to_string(), None)).collect();
    let mut rows = vec![Row { label: "images".to_owned(), cells: images, is_reference: false }];
    let mut add = |label: &str, name, format: Format, published: Option<[f64; 6]>| {
        let cells = columns.iter().map(|column| figure(column.figures.get(name), format)).collect();
        let limit = columns.last().and_then(|column| column.figures.get(name)?.limit_deg);
        let label = limit.map_or_else(|| label.to_owned(), |limit| format!("{label} < {}", angle(limit)));
        rows.push(Row { label, cells, is_reference: false });
        if let Some(published) = published {
            let cells = published.iter().map(|rate| (format!("{rate:.1}"), None)).collect();
            rows.push(Row { label: "  published".to_owned(), cells, is_reference: true });
        }
        if let Some(best_mode) = best_mode {
            let value = |column: &Column<'_>| (figure(column.figures.get(name), format).0, None);
            let cells = best_mode.iter().map(value).collect();
            rows.push(Row { label: "  best mode".to_owned(), cells, is_reference: true });
        }
    };
    let of = |pick: fn(&Table2) -> [f64; 6]| reference.map(pick);
    add("hit rate", names::HIT_RATE, percent, of(|t| t.hit_rate));
    add("columns", names::RA_WITHIN_1PX, percent, of(|t| t.ra_within_1px));
    add("columns", names::RA_WITHIN_2PX, percent, of(|t| t.ra_within_2px));
    add("rows", names::DEC_WITHIN_1PX, percent, of(|t| t.dec_within_1px));
    add("rows", names::DEC_WITHIN_2PX, percent, of(|t| t.dec_within_2px));
    add("correct", names::CORRECT_RATE, percent, None);
    add("wrong", names::WRONG_RATE, percent, None);
    if is_counted_in_any(columns, names::FALSE_ALARM_RATE) {
        add("false alarms", names::FALSE_ALARM_RATE, percent, None);
    }
    add("columns RMS", names::RA_RMS_DEG, arcsec, None);
    add("rows RMS", names::DEC_RMS_DEG, arcsec, None);
    add("x RMS, px", names::CENTROID_X_RMS_PX, pixels, None);
    add("y RMS, px", names::CENTROID_Y_RMS_PX, pixels, None);
    for (label, name, format) in CONSISTENCY {
        // Most pipelines state no covariance.
        if is_counted_in_any(columns, name) {
            add(label, name, format, None);
        }
    }
    add("start-up", names::FRAMES_UNTIL_SETTLED, integer_text, None);
    rows
}

/// Returns true if a figure counts any frame of any column.
fn is_counted_in_any(columns: &[Column<'_>], name: &str) -> bool {
    columns.iter().any(|column| column.figures.get(name).is_some_and(|figure| figure.of > 0))
}

/// Format of a number.
type Format = fn(f64) -> String;

/// Figures of covariance consistency, with their labels.
const CONSISTENCY: [(&str, &str, Format); 6] = [
    ("x/y NEES", names::CENTROID_NEES_MEAN, number),
    ("x/y < 1 σ", names::CENTROID_WITHIN_1SIGMA_RATE, percent),
    ("x/y < 3 σ", names::CENTROID_WITHIN_3SIGMA_RATE, percent),
    ("direction NEES", names::LINE_OF_SIGHT_NEES_MEAN, number),
    ("direction < 1 σ", names::LINE_OF_SIGHT_WITHIN_1SIGMA_RATE, percent),
    ("direction < 3 σ", names::LINE_OF_SIGHT_WITHIN_3SIGMA_RATE, percent),
];

/// Returns the consistency of the covariances, by the state of the image and by the source of the attitude.
fn consistency(rows: &[ConsistencyRow], styled: bool) -> String {
    let mut table = plain_table(styled);
    let labels = CONSISTENCY.map(|(label, ..)| label);
    table.set_header(["Correct measurements with covariance", "images"].into_iter().chain(labels));
    for row in rows {
        let cells = CONSISTENCY.map(|(_, name, format)| figure(row.figures.get(name), format).0);
        let label = format!("{}: {}", row.by, row.value.replace('_', " "));
        table.add_row([label, row.frames.to_string()].into_iter().chain(cells));
    }
    finish(table)
}

/// Returns the value and the interval of a figure in printed form; a dash if there is none.
fn figure(figure: Option<&Figure>, format: Format) -> (String, Option<String>) {
    let value = figure.and_then(|figure| figure.value).map_or("–".to_owned(), format);
    let interval = figure
        .and_then(|figure| figure.low.zip(figure.high))
        .map(|(low, high)| format!("({}–{})", format(low), format(high)));
    (value, interval)
}

/// Formats degrees as seconds of arc, with one decimal below 100.
fn arcsec(degrees: f64) -> String {
    let arcsec = 3600.0 * degrees;
    if arcsec < 99.95 { format!("{arcsec:.1}") } else { format!("{arcsec:.0}") }
}

fn number(value: f64) -> String {
    format!("{value:.2}")
}

/// Formats a count. The interval of a mean count may begin below 0, where no count exists.
fn integer_text(count: f64) -> String {
    format!("{:.0}", count.max(0.0))
}

fn pixels(px: f64) -> String {
    format!("{px:.3}")
}

fn sheet(columns: &[Column<'_>], rows: &[Row], before_interval: &str, styled: bool, width: usize) -> String {
    let mut table = plain_table(styled);
    let heading = |text: &str| Cell::new(text).add_attribute(Attribute::Bold);
    table.set_header([Cell::new("")].into_iter().chain(columns.iter().map(|column| heading(column.name))));
    for row in rows {
        let cells = row.cells.iter().map(|(value, interval)| match interval {
            Some(interval) => format!("{value}{before_interval}{interval}"),
            None => value.clone(),
        });
        let cells = [row.label.clone()].into_iter().chain(cells).map(Cell::new);
        table.add_row(cells.map(
            |cell| {
                if row.is_reference { cell.add_attribute(Attribute::Dim) } else { cell }
            },
        ));
    }
    finish_within(table, width)
}

/// Counts by cause with their fraction of the column's frames, or a single line if there are none.
fn causes(title: &str, columns: &[Column<'_>], pick: Counts, styled: bool) -> String {
    let occurring: Vec<&str> = Cause::ALL
        .iter()
        .map(|cause| cause.code())
        .filter(|code| columns.iter().any(|column| pick(column).contains_key(*code)))
        .collect();
    if occurring.is_empty() {
        return format!("{title}: none\n");
    }
    let mut table = plain_table(styled);
    table.set_header([title].into_iter().chain(columns.iter().map(|column| column.name)));
    for code in occurring {
        let cells = columns.iter().map(|column| {
            let count = pick(column).get(code).copied().unwrap_or(0);
            // A column without frames has neither counts nor fractions.
            if count == 0 { "–".to_owned() } else { share(count, column.frames) }
        });
        table.add_row([code.replace('_', " ")].into_iter().chain(cells));
    }
    finish(table)
}

#[cfg(test)]
mod tests {
    use super::*;
    use far_range::scoring::{ARGON_TABLE_2, GroupScore};

    /// Figures with the magnitude of a real run, each from `frames` independent frames.
    fn figures(frames: u64) -> IndexMap<String, Figure> {
        let rate = |share: f64, of: u64| {
            let hits = (share * of as f64) as u64;
            Figure::rate(&[(0..of).map(|i| i < hits).collect()])
        };
        let detected = frames * 94 / 100;
        let degrees = |scale: f64| Figure::rms(&[(0..detected).map(|i| scale * (i % 7) as f64).collect()]);
        [
            (names::HIT_RATE, rate(0.94, frames)),
            (names::RA_WITHIN_1PX, rate(0.855, detected)),
            (names::RA_WITHIN_2PX, rate(1.0, detected)),
            (names::DEC_WITHIN_1PX, rate(0.449, detected)),
            (names::DEC_WITHIN_2PX, rate(0.63, detected)),
            (names::CORRECT_RATE, rate(0.92, frames)),
            (names::WRONG_RATE, rate(0.02, frames)),
            (names::RA_RMS_DEG, degrees(0.004)),
            (names::DEC_RMS_DEG, degrees(0.04)),
        ]
        .map(|(name, figure)| (name.to_owned(), figure))
        .into()
    }

    fn score(groups: usize, frames: u64) -> Score {
        let misses: IndexMap<String, u64> = [("merged_with_star".to_owned(), frames / 20)].into();
        let group = GroupScore {
            frames,
            figures: figures(frames),
            misses: misses.clone(),
            wrong: IndexMap::new(),
            wrong_taken: IndexMap::new(),
        };
        Score {
            scenario: "argon".to_owned(),
            seed: 1,
            version: "0.1.0".to_owned(),
            inject: None,
            attitude: None,
            warm_up_frames: 0,
            frames: frames * groups as u64,
            figures: figures(frames * groups as u64),
            groups: (1..=groups).map(|day| (format!("day {day}"), group.clone())).collect(),
            misses: [("merged_with_star".to_owned(), frames / 20 * groups as u64)].into(),
            wrong: IndexMap::new(),
            wrong_taken: IndexMap::new(),
            consistency: Vec::new(),
            threshold_curve: Vec::new(),
        }
    }

    fn widest(text: &str) -> usize {
        text.lines().map(|line| line.chars().count()).max().unwrap()
    }

    fn line<'a>(text: &'a str, label: &str) -> &'a str {
        text.lines().find(|line| line.trim_start().starts_with(label)).unwrap()
    }

    #[test]
    fn five_days_and_all_fit_120_columns_on_one_line_each() {
        let text = far_range_table(&score(5, 3000), TableStyle { width: 120, ..TableStyle::default() });
        assert!(widest(&text) <= 120, "{}\n{text}", widest(&text));
        assert_eq!(line(&text, "hit rate").matches("94.0 (").count(), 6, "{text}");
    }

    #[test]
    fn where_it_does_not_fit_the_intervals_go_below() {
        let text = far_range_table(&score(5, 3000), TableStyle { width: 100, ..TableStyle::default() });
        assert!(widest(&text) <= 100, "{}\n{text}", widest(&text));
        assert_eq!(line(&text, "hit rate").matches('(').count(), 0, "{text}");
    }

    #[test]
    fn five_days_with_published_rows_fit_80_columns() {
        let style = TableStyle { reference: Some(&ARGON_TABLE_2), ..TableStyle::default() };
        let text = far_range_table(&score(5, 3000), style);
        assert!(widest(&text) <= WIDTH, "{}\n{text}", widest(&text));
        assert_eq!(text.matches("day 5").count(), 2, "the figures and the misses have each day once: {text}");
    }

    #[test]
    fn the_attitude_behind_the_direction_is_reported() {
        let text = |attitude: Option<&str>| {
            let score = Score { attitude: attitude.map(str::to_owned), ..score(5, 3000) };
            far_range_table(&score, TableStyle { width: 100, ..TableStyle::default() })
        };
        assert!(text(Some("own and telemetry")).contains("by the attitude `own and telemetry`"));
        assert!(text(Some("none")).contains("No measurement has a line of sight"));
        assert_eq!(text(Some("own")), text(None));
        assert!(["own and telemetry", "none"].iter().all(|word| widest(&text(Some(word))) <= 100));
    }

    #[test]
    fn covariances_have_rows_and_a_table_where_an_answer_states_one() {
        let mut score = score(1, 300);
        let text = far_range_table(&score, TableStyle::default());
        assert!(!text.contains('σ') && !text.contains("covariance"), "{text}");
        let nees = Figure::mean(&[vec![0.5, 1.5, 1.75]]);
        score.figures.insert(names::CENTROID_NEES_MEAN.to_owned(), nees);
        let figures: IndexMap<_, _> = [(names::CENTROID_NEES_MEAN.to_owned(), nees)].into();
        let row = |by: &str, value: &str| ConsistencyRow {
            by: by.to_owned(),
            value: value.to_owned(),
            frames: 3,
            figures: figures.clone(),
        };
        score.consistency = vec![row("image", "cut"), row("attitude", "too_few_stars")];
        let text = far_range_table(&score, TableStyle::default());
        assert!(line(&text, "x/y NEES").contains("1.25 ("), "{text}");
        let cells: Vec<&str> = line(&text, "attitude: too few stars").split_whitespace().collect();
        assert_eq!(cells, ["attitude:", "too", "few", "stars", "3", "1.25", "–", "–"]);
        assert!(line(&text, "image: cut").contains("1.25") && widest(&text) <= WIDTH, "{text}");
    }

    #[test]
    fn limits_are_those_of_the_figures() {
        let mut score = score(1, 300);
        score.figures[names::DEC_WITHIN_1PX].limit_deg = Some(0.0236);
        assert!(far_range_table(&score, TableStyle::default()).contains("\nrows < 0.0236°"));
    }

    #[test]
    fn plain_text_has_no_terminal_codes_and_styled_text_has() {
        let reference = Some(&ARGON_TABLE_2);
        let plain = far_range_table(&score(5, 300), TableStyle { reference, ..TableStyle::default() });
        let styled =
            far_range_table(&score(5, 300), TableStyle { reference, styled: true, ..TableStyle::default() });
        assert!(!plain.contains('\u{1b}') && styled.contains('\u{1b}'));
    }

    #[test]
    fn published_figures_stand_below_ours_when_the_groups_are_theirs() {
        let style = TableStyle { reference: Some(&ARGON_TABLE_2), width: 120, ..TableStyle::default() };
        assert!(line(&far_range_table(&score(5, 300), style), "published").contains("93.9"));
        assert!(!far_range_table(&score(4, 300), style).contains("published"));
    }

    #[test]
    fn the_best_mode_is_printed_below_if_its_groups_are_the_same() {
        let mut best = score(5, 300);
        best.figures.insert(names::CORRECT_RATE.to_owned(), Figure::rate(&[vec![true; 300]]));
        let style =
            |best_mode| TableStyle { reference: Some(&ARGON_TABLE_2), best_mode, width: 120, styled: false };
        let text = far_range_table(&score(5, 300), style(Some(&best)));
        let lines: Vec<&str> = text.lines().collect();
        let correct = lines.iter().position(|line| line.starts_with("correct")).unwrap();
        assert!(
            lines[correct + 1].starts_with("  best mode") && lines[correct + 1].ends_with(" 100"),
            "{text}"
        );
        let hit_rate = lines.iter().position(|line| line.starts_with("hit rate")).unwrap();
        assert!(lines[hit_rate + 2].starts_with("  best mode"), "{text}");
        assert!(!far_range_table(&score(4, 300), style(Some(&best))).contains("best mode"));
    }

    #[test]
    fn the_distance_from_the_published_cells_is_that_of_a_sum_by_hand() {
        let score = score(5, 3000);
        let style = TableStyle { reference: Some(&ARGON_TABLE_2), ..TableStyle::default() };
        let ours: Vec<f64> = ARGON_TABLE_2
            .rates()
            .iter()
            .map(|(name, _)| 100.0 * score.figures[*name].value.unwrap())
            .collect();
        // The groups of this score are similar to each other and to the whole.
        let differences: Vec<f64> = ARGON_TABLE_2
            .rates()
            .iter()
            .zip(&ours)
            .flat_map(|((_, rates), ours)| rates.map(|rate| (rate - ours).abs()))
            .collect();
        let mean = differences.iter().sum::<f64>() / 30.0;
        let worst = differences.iter().copied().fold(0.0, f64::max);
        let expected = format!("by {mean:.1} points on average, {worst:.1} at most");
        let text = far_range_table(&score, style);
        // The notes are wrapped.
        let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(text.contains(&expected), "{expected}\n{text}");
    }

    #[test]
    fn one_group_is_shown_once() {
        let text = far_range_table(&score(1, 300), TableStyle::default());
        assert!(!text.contains("day 1") && text.contains("all"), "{text}");
    }

    #[test]
    fn misses_are_counted_and_shared_by_cause_and_no_wrong_answer_is_stated() {
        let text = far_range_table(&score(2, 300), TableStyle::default());
        let misses = line(&text, "merged with star");
        assert!(misses.contains("15 (5.0)") && misses.contains("30 (5.0)"), "{text}");
        assert!(text.ends_with("Wrong measurements by cause: none\n"), "{text}");
    }

    #[test]
    fn an_empty_score_prints_dashes() {
        let mut empty = score(0, 0);
        empty.misses.clear();
        let text = far_range_table(&empty, TableStyle::default());
        assert!(line(&text, "hit rate").contains('–') && !text.contains("NaN"), "{text}");
    }
}
