//! Rows of a study: one per case, with its drawn values and its results.

use std::collections::HashMap;
use std::io::Write;
use std::path::Path;

use files::sha256::hex;
use files::{
    Cell, Cells, Column, ColumnType, ColumnValues, Columns, FieldDeclaration, FileError, ParquetFile, Row,
    Table, TableOptions, TextCells, table, write_table,
};
use indexmap::IndexMap;
use score::{LINE_OF_SIGHT_RATE, attitude_word};
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

/// Drawn value.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum DrawnValue {
    /// A number.
    Number(f64),
    /// Any other value, as JSON.
    Text(String),
}

impl DrawnValue {
    /// Formats the value for display.
    pub fn display_text(&self) -> String {
        match self {
            Self::Number(number) => number.to_string(),
            Self::Text(text) => text.clone(),
        }
    }
}

/// Figure of a case.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct CaseFigure {
    /// Value; `None` if there is nothing to count.
    pub value: Option<f64>,
    /// Numerator of a rate, whose `value` is `count`/`of`.
    pub count: u64,
    /// Number of values that the figure is computed from.
    pub of: u64,
}

/// A case and its results.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CaseRow {
    /// Number of the case.
    pub case: u64,
    /// Seed of the case's scenario.
    pub seed: u64,
    /// True if the pipeline failed at one frame or more: it crashed, exceeded its time limit, or returned an
    /// unreadable outcome.
    pub has_failed: bool,
    /// Reason why the case cannot be run, if its values do not form a valid scenario: it then has no frames,
    /// and counts in no figure.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub error: Option<String>,
    /// Number of frames that count.
    pub frames: u64,
    /// Drawn values, in the order of the table's columns.
    pub drawn: Vec<DrawnValue>,
    /// Figures, in the order of the table's columns.
    pub figures: Vec<CaseFigure>,
    /// Number of frames by cause, in the order of the table's columns.
    pub causes: Vec<u32>,
}

table! {
    /// Columns that every study has.
    struct CaseHead: parquet(case) {
        /// number of the case; ascending
        case: u64,
        /// seed of the case's scenario
        seed: u64,
        /// true if the pipeline failed at one frame or more: it crashed, exceeded its time limit, or returned
        /// an unreadable outcome
        has_failed: bool,
        /// reason why the case cannot be run; null if it can
        error: Option<String>,
        /// number of frames that count
        frames: u64,
    }
}

/// Returns the columns of `cases.parquet` that every study has.
pub fn case_columns() -> Vec<FieldDeclaration> {
    CaseHead::declarations()
}

/// Table of cases: rows and the names of their columns.
#[derive(Debug, Clone, PartialEq)]
pub struct CaseTable {
    /// Names of the drawn values, each with true if its values are numbers.
    pub drawn: IndexMap<String, bool>,
    /// Names of the figures.
    pub figures: Vec<String>,
    /// Names of the causes of misses and wrong measurements, as in `missed.cut_by_roi`.
    pub causes: Vec<String>,
    /// Rows, in ascending order of the case number.
    pub rows: Vec<CaseRow>,
}

/// Prefix of the column name of a drawn value.
pub(super) const SET: &str = "set.";
/// Prefix of the column name of a cause.
pub(super) const CAUSE: &str = "cause.";
/// Number of rows read at a time.
pub(super) const BATCH_ROWS: usize = 8192;

impl CaseTable {
    /// Returns the SHA-256 of the rows and the names of their columns, hexadecimal: a hash of the content,
    /// independent of the encoding.
    pub fn sha256(&self) -> String {
        let mut hash = Sha256::new();
        let mut text = |text: &str| {
            hash.update((text.len() as u64).to_le_bytes());
            hash.update(text);
        };
        self.drawn.keys().for_each(|name| text(name));
        self.figures.iter().chain(&self.causes).for_each(|name| text(name));
        for row in &self.rows {
            hash.update(row.case.to_le_bytes());
            hash.update(row.seed.to_le_bytes());
            hash.update([u8::from(row.has_failed)]);
            hash.update([u8::from(row.error.is_some())]);
            let error = row.error.as_deref().unwrap_or_default();
            hash.update((error.len() as u64).to_le_bytes());
            hash.update(error);
            hash.update(row.frames.to_le_bytes());
            for drawn in &row.drawn {
                match drawn {
                    DrawnValue::Number(number) => hash.update(number.to_bits().to_le_bytes()),
                    DrawnValue::Text(text) => {
                        hash.update((text.len() as u64).to_le_bytes());
                        hash.update(text);
                    }
                }
            }
            for figure in &row.figures {
                hash.update([u8::from(figure.value.is_some())]);
                hash.update(figure.value.unwrap_or(0.0).to_bits().to_le_bytes());
                hash.update(figure.count.to_le_bytes());
                hash.update(figure.of.to_le_bytes());
            }
            row.causes.iter().for_each(|count| hash.update(count.to_le_bytes()));
        }
        hex(hash.finalize())
    }

    /// Writes the rows as Parquet: `case`, `seed`, `has_failed`, `error`, `frames`, `set.PATH` for each drawn
    /// value, NAME, NAME.count, NAME.of for each figure, and `cause.VERDICT.CAUSE` for each cause.
    ///
    /// # Errors
    /// [`FileError`], of `path`, when the file cannot be written.
    pub fn write(
        &self,
        file: impl Write + Send,
        path: &Path,
        metadata: &[(&str, String)],
    ) -> Result<(), FileError> {
        let notes = metadata.iter().map(|(key, value)| ((*key).to_owned(), value.clone())).collect();
        write_table(file, path, &self.columns(), TableOptions { notes, ..TableOptions::default() })
    }

    #[expect(clippy::indexing_slicing, reason = "a row has a value for every column of its table")]
    pub(super) fn columns(&self) -> Vec<Column> {
        let rows = || self.rows.iter();
        let head = |row: &CaseRow| CaseHead {
            case: row.case,
            seed: row.seed,
            has_failed: row.has_failed,
            error: row.error.clone(),
            frames: row.frames,
        };
        let mut columns = CaseHead::columns(&rows().map(head).collect::<Vec<_>>());
        for (index, (name, is_number)) in self.drawn.iter().enumerate() {
            let name = format!("{SET}{name}");
            let cells = rows().map(|row| &row.drawn[index]);
            columns.push(if *is_number {
                let number = |cell: &DrawnValue| match cell {
                    DrawnValue::Number(number) => Some(*number),
                    DrawnValue::Text(_) => None,
                };
                // A text in a column of numbers has no value: the writer then rejects the column.
                Column::from_values(name, false, f64::values(cells.map(number).collect()))
            } else {
                Column::texts(name, cells.map(DrawnValue::display_text))
            });
        }
        for (index, name) in self.figures.iter().enumerate() {
            let figures = || rows().map(|row| row.figures[index]);
            columns.extend([
                Column::nullable(name, figures().map(|figure| figure.value)),
                Column::new(format!("{name}.count"), figures().map(|figure| figure.count)),
                Column::new(format!("{name}.of"), figures().map(|figure| figure.of)),
            ]);
        }
        for (index, name) in self.causes.iter().enumerate() {
            columns.push(Column::new(format!("{CAUSE}{name}"), rows().map(|row| row.causes[index])));
        }
        columns
    }

    /// Reads the columns of a file of cases, without its rows.
    ///
    /// # Errors
    /// [`FileError`] for a file that cannot be read or is damaged.
    pub fn columns_of(path: &Path) -> Result<Self, FileError> {
        let file = ParquetFile::open(path)?;
        let columns = file.columns();
        let drawn = columns.iter().filter_map(|column| {
            let name = column.name.strip_prefix(SET)?;
            Some((name.to_owned(), column.column_type == Ok(ColumnType::Float64)))
        });
        let figures = columns.iter().filter_map(|column| column.name.strip_suffix(".of"));
        Ok(Self {
            drawn: drawn.collect(),
            figures: figures.filter(|name| !name.starts_with(SET)).map(str::to_owned).collect(),
            causes: columns
                .iter()
                .filter_map(|column| column.name.strip_prefix(CAUSE))
                .map(str::to_owned)
                .collect(),
            rows: Vec::new(),
        })
    }

    /// Reads a table with these columns, and the notes that were written beside the rows.
    ///
    /// # Errors
    /// [`FileError`] for a file that cannot be read, is damaged, or has other columns.
    pub fn read(&self, path: &Path) -> Result<(Self, IndexMap<String, String>), FileError> {
        let file = ParquetFile::open(path)?;
        let notes = file.notes().map(|(key, value)| (key.to_owned(), value.to_owned())).collect();
        let mut table = self.with_rows(Vec::new());
        let expected = table.columns();
        for column in &expected {
            let expected = column.values().column_type();
            if file.column(column.name()).is_none_or(|found| found.column_type != Ok(expected)) {
                return Err(no_column(path, column.name(), expected));
            }
        }
        let names: Vec<&str> = expected.iter().map(Column::name).collect();
        for batch in file.batches(&names, BATCH_ROWS)? {
            table.add(path, &batch?)?;
        }
        Ok((table, notes))
    }

    pub(super) fn add(&mut self, path: &Path, batch: &[Column]) -> Result<(), FileError> {
        let whole = |name: &str| cells::<u64>(path, batch, name, ColumnType::UInt64).map(Cells::values);
        let number = |name: &str| cells::<f64>(path, batch, name, ColumnType::Float64);
        let texts = |name: &str| texts(path, batch, name);
        let heads = CaseHead::rows(&Columns::new(path, batch, self.rows.len() as u64))?;
        let row = |head: CaseHead| CaseRow {
            case: head.case,
            seed: head.seed,
            has_failed: head.has_failed,
            error: head.error,
            frames: head.frames,
            drawn: Vec::with_capacity(self.drawn.len()),
            figures: Vec::with_capacity(self.figures.len()),
            causes: Vec::with_capacity(self.causes.len()),
        };
        let mut rows: Vec<CaseRow> = heads.into_iter().map(row).collect();
        for (name, is_number) in &self.drawn {
            let name = format!("{SET}{name}");
            if *is_number {
                let numbers = number(&name)?.values();
                rows.iter_mut()
                    .zip(numbers)
                    .for_each(|(row, &number)| row.drawn.push(DrawnValue::Number(number)));
            } else {
                let texts = texts(&name)?.iter().map(Option::unwrap_or_default);
                rows.iter_mut()
                    .zip(texts)
                    .for_each(|(row, text)| row.drawn.push(DrawnValue::Text(text.to_owned())));
            }
        }
        for name in &self.figures {
            let (values, counts, ofs) =
                (number(name)?, whole(&format!("{name}.count"))?, whole(&format!("{name}.of"))?);
            let figures = values.iter().zip(counts).zip(ofs);
            for (row, ((value, &count), &of)) in rows.iter_mut().zip(figures) {
                row.figures.push(CaseFigure { value, count, of });
            }
        }
        for name in &self.causes {
            let name = format!("{CAUSE}{name}");
            let counts = cells::<u32>(path, batch, &name, ColumnType::UInt32)?.values();
            rows.iter_mut().zip(counts).for_each(|(row, &count)| row.causes.push(count));
        }
        self.rows.extend(rows);
        Ok(())
    }

    /// Returns a table with the same columns and other rows.
    pub fn with_rows(&self, rows: Vec<CaseRow>) -> Self {
        Self { drawn: self.drawn.clone(), figures: self.figures.clone(), causes: self.causes.clone(), rows }
    }

    /// Returns the number of each row's draw, counted from 0 in the order of the rows. The points of a sweep
    /// share the draws of all other values, and the seed that identifies them. Rows of different draws are
    /// independent.
    pub fn draws(&self) -> Vec<usize> {
        let mut known = HashMap::new();
        self.rows
            .iter()
            .map(|row| {
                let next = known.len();
                *known.entry(row.seed).or_insert(next)
            })
            .collect()
    }

    /// Returns the values of a figure for every case.
    #[expect(clippy::indexing_slicing, reason = "a row has a value for every column of its table")]
    pub fn figure(&self, name: &str) -> Option<Vec<CaseFigure>> {
        let index = self.figures.iter().position(|figure| figure == name)?;
        Some(self.rows.iter().map(|row| row.figures[index]).collect())
    }

    /// Returns the attitude that the lines of sight of the cases depend on, if it follows from the recorded
    /// figures ([`score::attitude_word`]); `granted` is the attitude that the scenario grants to centroids.
    pub fn attitude(&self, granted: Option<&str>) -> Option<String> {
        let figure = self.figure(LINE_OF_SIGHT_RATE)?;
        let (own, of) = figure.iter().fold((0, 0), |(own, of), figure| (own + figure.count, of + figure.of));
        attitude_word(own > 0, of > own, granted)
    }

    /// Returns the values of a drawn parameter for every case; `None` if they are not numbers.
    #[expect(clippy::indexing_slicing, reason = "a row has a value for every column of its table")]
    pub fn numbers(&self, name: &str) -> Option<Vec<f64>> {
        let index = self.drawn.get_index_of(name)?;
        let number = |row: &CaseRow| match row.drawn[index] {
            DrawnValue::Number(number) => Some(number),
            DrawnValue::Text(_) => None,
        };
        self.rows.iter().map(number).collect()
    }
}

#[cfg(test)]
impl CaseRow {
    /// Creates a case with these figures and without drawn values.
    pub(super) fn from_figures(case: u64, seed: u64, figures: Vec<CaseFigure>) -> Self {
        let (drawn, causes) = (Vec::new(), Vec::new());
        Self { case, seed, has_failed: false, error: None, frames: 1, drawn, figures, causes }
    }
}

#[cfg(test)]
impl CaseTable {
    /// Creates a table of cases with these figures and without drawn values.
    pub(super) fn from_rows(figures: &[&str], rows: Vec<CaseRow>) -> Self {
        let figures = figures.iter().map(|name| (*name).to_owned()).collect();
        Self { drawn: IndexMap::new(), figures, causes: Vec::new(), rows }
    }
}

/// Returns the values of a column of a batch.
pub(super) fn cells<'a, T: Cell>(
    path: &Path,
    batch: &'a [Column],
    name: &str,
    column_type: ColumnType,
) -> Result<&'a Cells<T>, FileError> {
    let found = batch.iter().find(|column| column.name() == name);
    found.and_then(|column| T::cells(column.values())).ok_or_else(|| no_column(path, name, column_type))
}

/// Returns the texts of a column of a batch.
pub(super) fn texts<'a>(path: &Path, batch: &'a [Column], name: &str) -> Result<&'a TextCells, FileError> {
    match batch.iter().find(|column| column.name() == name).map(Column::values) {
        Some(ColumnValues::Utf8(texts)) => Ok(texts),
        _ => Err(no_column(path, name, ColumnType::Utf8)),
    }
}

fn no_column(path: &Path, name: &str, column_type: ColumnType) -> FileError {
    FileError::format(path, "Parquet", format!("it has no column `{name}` of the type {column_type}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_cases_of_a_study_state_the_attitude_of_their_lines_of_sight() {
        let word = |counts: &[(u64, u64)], granted| {
            let row = |&(count, of): &(u64, u64)| CaseRow {
                case: 0,
                seed: 3,
                has_failed: false,
                error: None,
                frames: of,
                drawn: Vec::new(),
                figures: vec![CaseFigure { value: None, count, of }],
                causes: Vec::new(),
            };
            let table = CaseTable {
                drawn: IndexMap::new(),
                figures: vec![LINE_OF_SIGHT_RATE.to_owned()],
                causes: Vec::new(),
                rows: counts.iter().map(row).collect(),
            };
            table.attitude(granted)
        };
        assert_eq!(word(&[(30, 30), (0, 0)], Some("true")).as_deref(), Some("own"));
        assert_eq!(word(&[(0, 30)], Some("true")).as_deref(), Some("true"));
        assert_eq!(word(&[(0, 30)], None).as_deref(), Some("none"));
        assert_eq!(word(&[(30, 30), (0, 30)], Some("true")).as_deref(), Some("own and true"));
        assert_eq!(word(&[(0, 0)], Some("true")), None);
    }
}
