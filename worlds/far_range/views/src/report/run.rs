//! Results of a far-range run, read from its directory, and its frames as time series.

#![cfg_attr(
    not(test),
    deny(
        clippy::indexing_slicing,
        clippy::string_slice,
        clippy::expect_used,
        clippy::panic,
        clippy::unreachable
    )
)]

use ::report::RunFiles;
use ::report::charts::plotly::Axis;
use ::report::charts::thinning::{bins, summary};
use ::report::page::data_table::DataTable;
use ::report::read::read_json;
use contract::Outcome;
use far_range::rows::{FrameTruthRow, TelemetryRow, read_measurements, read_telemetry};
use far_range::scoring::{FrameVerdict, Score};
use far_range::{FarRangeMission, FarRangeScenario};
use files::{Failure, TableReader, format_utc};
use hifitime::{Epoch, Unit};
use navigate::{NavigationRow, TABLE_FILE, read_navigation};
use run::WorldScore as _;
use scenario::run_file::RunFile;
use score::WARM_UP;
use sim::truth::{FrameTruth, clock};

use super::error_budget::InjectedRun;

/// Number of rows of the table behind a long series.
const TABLE_BINS: usize = 60;

/// Results of a far-range run, read from its directory.
pub struct FarRangeRun {
    /// Content of `run.toml`.
    pub run_file: RunFile<FarRangeScenario>,
    /// Content of `score.json`, or the score of other measurements.
    pub score: Score,
    /// One verdict per frame, from truth and measurements.
    pub verdicts: Vec<FrameVerdict>,
    /// Content of `truth/frames.parquet`, in the order of the verdicts.
    pub truths: Vec<FrameTruth>,
    /// Content of `measurements.csv`, for the same frames; `None` for a frame without a row.
    pub outcomes: Vec<Option<Outcome>>,
    /// Content of `telemetry.csv`, for the same frames.
    pub telemetry: Vec<TelemetryRow>,
    /// Runs on the same frames, each with the truth in place of one stage's result; empty without an error
    /// budget.
    pub budget: Vec<InjectedRun>,
    /// Content of `navigation.csv`; empty if the run has none.
    pub navigation: Vec<NavigationRow>,
}

impl FarRangeRun {
    /// Reads the files of a run.
    ///
    /// # Errors
    /// A [`Failure`] that names the file which is missing, cannot be read, or does not cover the same frames
    /// as the other files.
    pub fn read(files: &RunFiles) -> Result<Self, Failure> {
        files.check(&FILES)?;
        let clusters = files.beside("clusters.parquet");
        let scored =
            FarRangeMission::score_files(&files.directory, &files.measurements, clusters.as_deref(), None)?;
        let score = match files.score() {
            Some(path) => read_json(&path, "score")?,
            None => scored.score,
        };
        Self::with_score(files, score, scored.verdicts)
    }

    /// Reads the files of a run whose verdicts are available. The table of objects, by far the longest, is
    /// then not read.
    ///
    /// # Errors
    /// Those of [`FarRangeRun::read`].
    pub fn with_verdicts(files: &RunFiles, verdicts: Vec<FrameVerdict>) -> Result<Self, Failure> {
        files.check(&["score.json"])?;
        files.check(&FILES)?;
        let score = read_json(&files.path("score.json"), "score")?;
        Self::with_score(files, score, verdicts)
    }

    /// Reads the files of a run whose score is available.
    fn with_score(files: &RunFiles, score: Score, verdicts: Vec<FrameVerdict>) -> Result<Self, Failure> {
        let (directory, measurements) = (&files.directory, &files.measurements);
        let run_file = RunFile::<FarRangeScenario>::read(&directory.join("run.toml"))?;
        let mut truths = Vec::with_capacity(verdicts.len());
        for frame in TableReader::<FrameTruthRow>::open(&directory.join("truth/frames.parquet"))? {
            truths.extend(frame?.1.into_iter().map(|row| row.0));
        }
        let mut answers = read_measurements(measurements, &run_file.scenario.camera)?.into_iter().peekable();
        let mut rows = read_telemetry(&directory.join("telemetry.csv"))?.into_iter().peekable();
        let mut telemetry = Vec::with_capacity(verdicts.len());
        let mut outcomes = Vec::with_capacity(verdicts.len());
        for truth in &truths {
            outcomes.push(answers.next_if(|(frame, _)| *frame == truth.frame).map(|(_, outcome)| outcome));
            telemetry.push(rows.next_if(|row| row.frame == truth.frame).ok_or_else(|| {
                Failure::Usage(format!(
                    "{}: no row for frame {}, expected one for every frame of the truth",
                    directory.join("telemetry.csv").display(),
                    truth.frame
                ))
            })?);
        }
        // The frames of the warm-up are counted in their own group alone.
        let warm_up = score.groups.get(WARM_UP).map_or(0, |group| group.frames);
        let expected = (truths.len() as u64).saturating_sub(warm_up);
        if truths.is_empty() || score.frames != expected || verdicts.len() != truths.len() {
            return Err(Failure::Usage(format!(
                "{}: `frames` is {}, expected {expected} as in truth/frames.parquet without its warm-up, and at \
                 least 1 there",
                directory.join("score.json").display(),
                score.frames
            )));
        }
        let table = directory.join(TABLE_FILE);
        let navigation = if table.is_file() { read_navigation(&table)? } else { Vec::new() };
        Ok(Self { run_file, score, verdicts, truths, outcomes, telemetry, budget: Vec::new(), navigation })
    }

    /// Returns the times of the given rows in the unit of the time axis.
    #[expect(
        clippy::indexing_slicing,
        reason = "every row of a run has a truth and a verdict, and there is at least one row"
    )]
    pub(super) fn times(&self, rows: &[usize]) -> Vec<f64> {
        rows.iter().map(|&row| axis_time(self.truths[row].time)).collect()
    }
}

/// Files that every run and every rendered dataset contains.
const FILES: [&str; 3] = ["telemetry.csv", "truth/frames.parquet", "truth/objects.parquet"];

/// Returns a line through the given rows of a run, in order, broken where another group begins, since days
/// are not contiguous.
#[expect(
    clippy::indexing_slicing,
    reason = "every row of a run has a truth and a verdict, and there is at least one row"
)]
pub(super) fn broken(run: &FarRangeRun, rows: impl Iterator<Item = (usize, f64)>) -> (Vec<f64>, Vec<f64>) {
    let (mut times, mut values) = (Vec::new(), Vec::new());
    let mut last: Option<usize> = None;
    for (row, value) in rows {
        if last.is_some_and(|last| run.verdicts[last].group != run.verdicts[row].group) {
            times.push(axis_time(run.truths[row].time));
            values.push(f64::NAN);
        }
        times.push(axis_time(run.truths[row].time));
        values.push(value);
        last = Some(row);
    }
    (times, values)
}

/// Formats the time of a frame to the second, for display.
pub(super) fn shown_time(truth: &FrameTruth) -> String {
    cut_time(truth, 19)
}

/// Formats the time of a frame to the millisecond, for display.
pub(super) fn shown_time_ms(truth: &FrameTruth) -> String {
    cut_time(truth, 23)
}

fn cut_time(truth: &FrameTruth, length: usize) -> String {
    format_utc(truth.time).get(..length).unwrap_or_default().replace('T', " ")
}

/// Returns the position of an instant on a time axis, to the millisecond.
pub(super) fn axis_time(time: Epoch) -> f64 {
    clock::unix_ms(time) as f64
}

/// Returns the time axis of a run, which is the same in all of its charts, so that they can be compared one
/// below another.
#[expect(
    clippy::indexing_slicing,
    reason = "every row of a run has a truth and a verdict, and there is at least one row"
)]
pub(super) fn time_axis(run: &FarRangeRun) -> Axis {
    let (first, last) = (run.truths[0].time, run.truths[run.truths.len() - 1].time);
    let room = ((last - first) * 0.02).max(1.0 * Unit::Second);
    Axis::titled("time, UTC").with_time_axis().range([first - room, last + room].map(axis_time))
}

/// A column of a table behind a chart: its name, its value in a row, and its number of decimals.
pub(super) type BinColumn<'a> = (&'a str, &'a dyn Fn(usize) -> f64, usize);

/// Summarises long series by stretches of frames: count, minimum, mean and maximum of each.
#[expect(
    clippy::indexing_slicing,
    reason = "every row of a run has a truth and a verdict, and there is at least one row"
)]
pub(super) fn by_bins(run: &FarRangeRun, columns: &[BinColumn<'_>]) -> DataTable {
    let mut head = vec!["from (UTC)".to_owned(), "frames".to_owned()];
    for (name, _, _) in columns {
        head.extend(["number", "smallest", "mean", "largest"].map(|what| format!("{name}: {what}")));
    }
    let mut table = DataTable::new(head).caption(
        "One row per group of consecutive frames; measurements.csv and truth/frames.parquet have every \
         frame.",
    );
    for bin in bins(run.truths.len(), TABLE_BINS) {
        let first = &run.truths[bin.start];
        let mut cells = vec![shown_time(first), format!("{}–{}", first.frame, run.truths[bin.end - 1].frame)];
        for (_, value, decimals) in columns {
            cells.extend(summary(bin.clone().map(value), *decimals));
        }
        table.push(cells);
    }
    table
}
