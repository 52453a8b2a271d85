//! `cases.parquet` of a study: written a shard at a time and read a column at a time, which keeps only a few
//! columns in memory.

use std::fs::File;
use std::path::{Path, PathBuf};

use files::{Cells, Column, ColumnType, FileError, ParquetFile, ParquetWriter, TableOptions};
use score::{LINE_OF_SIGHT_RATE, attitude_word};

use crate::cases::{BATCH_ROWS, CAUSE, CaseFigure, CaseTable, SET, cells, texts};

/// Number of rows whose encoded bytes are held before they are written.
const ROW_GROUP_ROWS: usize = 1 << 17;
/// Largest number of cases with an error that are listed.
const MAX_ERRORS: usize = 10;

/// Writer of the rows of a study.
pub(crate) struct CaseWriter<'a>(ParquetWriter<&'a File>);

impl<'a> CaseWriter<'a> {
    /// Begins a file with the columns of `empty`.
    pub(crate) fn new(
        file: &'a File,
        path: &Path,
        empty: &CaseTable,
        notes: Vec<(String, String)>,
    ) -> Result<Self, FileError> {
        let options = TableOptions { row_group_rows: ROW_GROUP_ROWS, notes, ..TableOptions::default() };
        ParquetWriter::new(file, path, &empty.columns(), options).map(Self)
    }

    pub(crate) fn add(&mut self, table: &CaseTable) -> Result<(), FileError> {
        self.0.write(&table.columns())
    }

    pub(crate) fn finish(self) -> Result<(), FileError> {
        self.0.finish()
    }
}

/// All cases of a study, from number 0 on, in a Parquet file.
#[derive(Debug)]
pub struct CaseFile {
    path: PathBuf,
    /// Columns of the table, without rows.
    empty: CaseTable,
    /// Number of the independent group (draw or replication) that each case belongs to.
    pub(crate) draws: Vec<usize>,
    /// Number of frames of each case that count.
    pub(crate) frames: Vec<u64>,
    /// True for each case that cannot be run.
    pub(crate) has_error: Vec<bool>,
    /// Numbers of the first cases that cannot be run, each with the reason.
    pub(crate) errors: Vec<(u64, String)>,
    /// True for each case in which the pipeline failed.
    pub(crate) has_failed: Vec<bool>,
}

impl CaseFile {
    /// Opens a file with the columns of `empty`; every `together` successive cases form one group,
    /// independent of the other groups.
    pub(crate) fn open(path: &Path, empty: CaseTable, together: u64) -> Result<Self, FileError> {
        let (draws, frames, has_error, errors, has_failed) = Default::default();
        let mut cases = Self { path: path.to_owned(), empty, draws, frames, has_error, errors, has_failed };
        let mut number = 0;
        for_each_batch(path, &["has_failed", "error", "frames"], |batch| {
            let failed = cells::<bool>(path, batch, "has_failed", ColumnType::Boolean)?.values();
            cases.has_failed.extend_from_slice(failed);
            cases.frames.extend(whole(path, batch, "frames")?);
            for error in texts(path, batch, "error")?.iter() {
                cases.draws.push((number / together) as usize);
                cases.has_error.push(error.is_some());
                if let Some(error) = error.filter(|_| cases.errors.len() < MAX_ERRORS) {
                    cases.errors.push((number, error.to_owned()));
                }
                number += 1;
            }
            Ok(())
        })?;
        Ok(cases)
    }

    /// Returns the number of cases.
    pub fn count(&self) -> u64 {
        self.frames.len() as u64
    }

    /// Returns the names of the figures.
    pub(crate) fn figures(&self) -> &[String] {
        &self.empty.figures
    }

    /// Returns the names of the causes.
    pub(crate) fn causes(&self) -> &[String] {
        &self.empty.causes
    }

    /// Returns the names of the drawn values.
    pub(crate) fn drawn_columns(&self) -> impl Iterator<Item = &String> {
        self.empty.drawn.keys()
    }

    /// Reads the values of a figure for every case; `None` if the figure is not recorded.
    pub(crate) fn figure(&self, name: &str) -> Result<Option<Vec<CaseFigure>>, FileError> {
        if !self.empty.figures.iter().any(|figure| figure == name) {
            return Ok(None);
        }
        let path = &self.path;
        let [count, of] = ["count", "of"].map(|part| format!("{name}.{part}"));
        let mut figures = Vec::with_capacity(self.frames.len());
        for_each_batch(path, &[name, &count, &of], |batch| {
            let values = cells::<f64>(path, batch, name, ColumnType::Float64)?;
            let counts = whole(path, batch, &count)?.zip(whole(path, batch, &of)?);
            figures.extend(values.iter().zip(counts).map(|(value, (count, of))| CaseFigure {
                value,
                count,
                of,
            }));
            Ok(())
        })?;
        Ok(Some(figures))
    }

    /// Reads the number of frames with a given cause for every case.
    pub(crate) fn cause(&self, name: &str) -> Result<Vec<CaseFigure>, FileError> {
        let (path, name) = (&self.path, format!("{CAUSE}{name}"));
        let mut counts = Vec::with_capacity(self.frames.len());
        for_each_batch(path, &[&name], |batch| {
            counts.extend_from_slice(cells::<u32>(path, batch, &name, ColumnType::UInt32)?.values());
            Ok(())
        })?;
        let figure = |(count, of): (u32, &u64)| CaseFigure { value: None, count: u64::from(count), of: *of };
        Ok(counts.into_iter().zip(&self.frames).map(figure).collect())
    }

    /// Reads the values of a drawn parameter for every case; `None` if its values are not numbers.
    pub(crate) fn numbers(&self, name: &str) -> Result<Option<Vec<f64>>, FileError> {
        if self.empty.drawn.get(name) != Some(&true) {
            return Ok(None);
        }
        let (path, name) = (&self.path, format!("{SET}{name}"));
        let mut numbers = Vec::with_capacity(self.frames.len());
        for_each_batch(path, &[&name], |batch| {
            numbers.extend_from_slice(cells::<f64>(path, batch, &name, ColumnType::Float64)?.values());
            Ok(())
        })?;
        Ok(Some(numbers))
    }

    /// Reads the drawn values of some cases, formatted for display.
    #[expect(clippy::indexing_slicing, reason = "a row has a value for every column of its table")]
    pub(crate) fn drawn_value_texts(&self, cases: &[usize]) -> Result<Vec<Vec<String>>, FileError> {
        let mut table =
            CaseTable { figures: Vec::new(), causes: Vec::new(), ..self.empty.with_rows(Vec::new()) };
        let names: Vec<String> = table.columns().iter().map(|column| column.name().to_owned()).collect();
        let mut shown = vec![Vec::new(); cases.len()];
        let mut first = 0;
        for_each_batch(&self.path, &names, |batch| {
            table.rows.clear();
            table.add(&self.path, batch)?;
            for (case, shown) in cases.iter().zip(&mut shown) {
                if (first..first + table.rows.len()).contains(case) {
                    *shown =
                        table.rows[case - first].drawn.iter().map(|drawn| drawn.display_text()).collect();
                }
            }
            first += table.rows.len();
            Ok(())
        })?;
        Ok(shown)
    }

    /// Returns the attitude that the lines of sight of the cases depend on, as [`CaseTable::attitude`] does.
    pub(crate) fn attitude(&self, granted: Option<&str>) -> Result<Option<String>, FileError> {
        let Some(figure) = self.figure(LINE_OF_SIGHT_RATE)? else { return Ok(None) };
        let (own, of) = figure.iter().fold((0, 0), |(own, of), figure| (own + figure.count, of + figure.of));
        Ok(attitude_word(own > 0, of > own, granted))
    }
}

fn for_each_batch<N: AsRef<str>>(
    path: &Path,
    names: &[N],
    mut add: impl FnMut(&[Column]) -> Result<(), FileError>,
) -> Result<(), FileError> {
    for batch in ParquetFile::open(path)?.batches(names, BATCH_ROWS)? {
        add(&batch?)?;
    }
    Ok(())
}

fn whole<'a>(
    path: &Path,
    batch: &'a [Column],
    name: &str,
) -> Result<impl Iterator<Item = u64> + 'a, FileError> {
    let cells: &Cells<u64> = cells(path, batch, name, ColumnType::UInt64)?;
    Ok(cells.values().iter().copied())
}
