//! A CSV table with columns identified by name, and with errors that name line and column.

use std::fs::File;
use std::io::Write;
use std::marker::PhantomData;
use std::path::{Path, PathBuf};

use super::lines::Lines;
use crate::error::{FileLocation, open_regular};
use crate::table::column::ColumnType;
use crate::table::declarations::Table;
use crate::table::field::Atom;
use crate::{AtomicFile, FileError};

/// A CSV row, as declared by [`table!`](crate::table!).
pub trait CsvLine: Table {
    /// Returns the cells in the order of the columns.
    fn cells(&self) -> Vec<String>;

    /// Reads a row.
    ///
    /// # Errors
    /// [`FileError::Value`] for a cell that does not match its declaration.
    fn read(row: &CsvRow<'_>) -> Result<Self, FileError>;
}

/// A declared column of a table.
struct CsvColumn {
    name: &'static str,
    is_optional: bool,
    /// Index of the column in the file, if the file contains it.
    position: Option<usize>,
}

/// Reader of a table, row by row.
pub struct CsvReader {
    path: PathBuf,
    columns: Vec<CsvColumn>,
    reader: csv::Reader<Lines<File>>,
    record: csv::StringRecord,
}

impl CsvReader {
    /// Opens a table and checks that its header contains every required column, no unknown column and no
    /// duplicate.
    ///
    /// # Errors
    /// [`FileError`] for a file that cannot be opened, or a header with a missing, unknown or duplicate
    /// column.
    pub fn open<T: Table>(path: &Path) -> Result<Self, FileError> {
        Self::open_with::<T>(path, &[])
    }

    /// Opens a table like [`CsvReader::open`], which may also have the columns `others`.
    ///
    /// # Errors
    /// Those of [`CsvReader::open`].
    pub fn open_with<T: Table>(path: &Path, others: &[&'static str]) -> Result<Self, FileError> {
        let file = Lines::new(open_regular(path)?);
        let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::Headers).from_reader(file);
        let header = reader.headers().map_err(|error| csv_error(path, &error))?.clone();
        let column = |(name, is_optional)| CsvColumn { name, is_optional, position: None };
        let mut columns: Vec<CsvColumn> =
            layout::<T>().chain(others.iter().map(|name| (*name, true))).map(column).collect();
        for (position, name) in header.iter().enumerate() {
            let Some(column) = columns.iter_mut().find(|column| column.name == name) else {
                return Err(unknown_column(path, name, &columns));
            };
            if column.position.replace(position).is_some() {
                return Err(FileError::value(
                    path,
                    FileLocation::Line(1),
                    "header",
                    name,
                    "each column once",
                ));
            }
        }
        if let Some(missing) = columns.iter().find(|column| !column.is_optional && column.position.is_none())
        {
            return Err(FileError::MissingColumn {
                path: path.to_owned(),
                column: missing.name.to_owned(),
                found: header.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", "),
            });
        }
        Ok(Self { path: path.to_owned(), columns, reader, record: csv::StringRecord::new() })
    }

    /// Reads all rows; `parse` also receives the previous row.
    ///
    /// # Errors
    /// [`FileError`] for a row that cannot be read, with its line, and the errors of `parse`.
    pub fn read_rows<T>(
        mut self,
        parse: impl Fn(&CsvRow<'_>, Option<&T>) -> Result<T, FileError>,
    ) -> Result<Vec<T>, FileError> {
        let mut rows = Vec::new();
        while let Some(row) = self.next_row()? {
            rows.push(parse(&row, rows.last())?);
        }
        Ok(rows)
    }

    /// Reads all rows, each with its line in the file; `parse` also receives the previous row. A table
    /// without rows is an error.
    ///
    /// # Errors
    /// Those of [`CsvReader::read_rows`], and [`FileError`] for a table without rows.
    pub fn read_all<T>(
        self,
        parse: impl Fn(&CsvRow<'_>, Option<&T>) -> Result<T, FileError>,
    ) -> Result<Vec<(u64, T)>, FileError> {
        let path = self.path.clone();
        let with_line = |row: &CsvRow<'_>, previous: Option<&(u64, T)>| {
            parse(row, previous.map(|(_, previous)| previous)).map(|parsed| (row.line, parsed))
        };
        let rows = self.read_rows(with_line)?;
        if rows.is_empty() {
            return Err(FileError::value(&path, FileLocation::Header, "number of rows", 0, "at least 1"));
        }
        Ok(rows)
    }

    /// Reads the next row; `None` at the end.
    ///
    /// # Errors
    /// [`FileError`] for a row that cannot be read, with its line.
    pub fn next_row(&mut self) -> Result<Option<CsvRow<'_>>, FileError> {
        let more =
            self.reader.read_record(&mut self.record).map_err(|error| csv_error(&self.path, &error))?;
        let line = self.record.position().map_or(0, csv::Position::line);
        Ok(more.then_some(CsvRow { table: self, line }))
    }
}

/// Returns the columns of a table in the order in which they are written, each with true if a file may omit
/// it.
fn layout<T: Table>() -> impl Iterator<Item = (&'static str, bool)> {
    let fields = T::declarations().into_iter();
    fields.flat_map(|field| field.names.into_iter().map(move |name| (name, field.is_optional)))
}

/// One row of a table.
pub struct CsvRow<'a> {
    table: &'a CsvReader,
    /// Line of the file at which the row begins, from 1.
    pub line: u64,
}

impl CsvRow<'_> {
    /// Returns the unchanged text of a cell; empty if the file has no such column.
    pub fn text(&self, column: &str) -> &str {
        let declarations = self.table.columns.iter().find(|declarations| declarations.name == column);
        debug_assert!(declarations.is_some(), "`{column}` is not declared");
        let position = declarations.and_then(|declarations| declarations.position);
        position.and_then(|i| self.table.record.get(i)).unwrap_or("")
    }

    /// Parses the cell of a column.
    ///
    /// # Errors
    /// [`FileError::Value`] with the line, the column and the expected value.
    pub fn cell<'r, T: Atom<'r>>(&'r self, column: &'static str) -> Result<T, FileError> {
        T::parse(self.text(column)).ok_or_else(|| self.error(column, T::EXPECTED))
    }

    /// Creates the error of a cell that differs from `expected`.
    pub fn error(&self, column: &'static str, expected: impl Into<String>) -> FileError {
        FileError::value(&self.table.path, FileLocation::Line(self.line), column, self.text(column), expected)
    }

    /// Rejects the frame, field or star number of a row unless it is larger than that of the previous row.
    ///
    /// # Errors
    /// [`FileError::Value`].
    pub fn check_ascends(
        &self,
        column: &'static str,
        number: u64,
        previous: Option<u64>,
    ) -> Result<(), FileError> {
        match previous {
            Some(previous) if number <= previous => Err(self.error(
                column,
                format!(
                    "more than {previous}, the {column} of the previous row (each {column} once, ascending)"
                ),
            )),
            _ => Ok(()),
        }
    }

    /// Rejects a value in columns that must be empty for the row's status: the row would count as a miss, and
    /// the value would be lost silently.
    pub fn check_empty(&self, columns: impl IntoIterator<Item = &'static str>) -> Result<(), FileError> {
        let full = columns.into_iter().find(|column| !self.text(column).trim().is_empty());
        let nothing = || format!("an empty cell, because the status is `{}`", self.text("status"));
        full.map_or(Ok(()), |column| Err(self.error(column, nothing())))
    }

    /// Rejects negative standard deviations.
    pub fn check_sigmas<const N: usize>(
        &self,
        columns: [&'static str; N],
        sigmas: Option<[f64; N]>,
    ) -> Result<(), FileError> {
        let negative = sigmas.iter().flatten().zip(columns).find(|(sigma, _)| **sigma < 0.0);
        negative.map_or(Ok(()), |(_, column)| Err(self.error(column, "0 or greater")))
    }
}

/// Writer of a table to a stream, or to a file that gets its name when it is complete.
pub struct CsvWriter<T> {
    path: PathBuf,
    writer: csv::Writer<Box<dyn Write>>,
    /// Output file; `None` for a stream.
    file: Option<AtomicFile>,
    /// Names of the columns of numbers; `None` for other columns.
    numbers: Vec<Option<&'static str>>,
    row: PhantomData<T>,
}

impl<T: CsvLine> CsvWriter<T> {
    /// Creates the table and writes its header.
    ///
    /// # Errors
    /// [`FileError::Io`] if the file cannot be created, [`FileError::OutputTaken`] if it exists.
    pub fn create(path: &Path) -> Result<Self, FileError> {
        let file = AtomicFile::create_new(path)?;
        let out = file.file().try_clone().map_err(|source| FileError::io(path, "create", source))?;
        Self::headed(path, Box::new(out), Some(file))
    }

    /// Writes the table to a stream, header first and each row immediately. Messages call the stream `name`.
    ///
    /// # Errors
    /// [`FileError::Io`].
    pub fn stream(name: &str, out: impl Write + 'static) -> Result<Self, FileError> {
        Self::headed(Path::new(name), Box::new(out), None)
    }

    fn headed(path: &Path, out: Box<dyn Write>, file: Option<AtomicFile>) -> Result<Self, FileError> {
        let writer = csv::Writer::from_writer(out);
        let numbers = T::declarations().into_iter().flat_map(|field| {
            let is_number = matches!(field.column_type, ColumnType::Float32 | ColumnType::Float64);
            field.names.into_iter().map(move |name| is_number.then_some(name))
        });
        let mut writer =
            Self { path: path.to_owned(), writer, file, numbers: numbers.collect(), row: PhantomData };
        writer.record(layout::<T>().map(|(name, _)| name))?;
        Ok(writer)
    }

    /// Writes a row. Numbers are written with enough digits to be read back bit for bit.
    ///
    /// # Errors
    /// [`FileError::Io`]; [`FileError::Value`] for a number that is not finite, which no reader accepts.
    pub fn line(&mut self, row: &T) -> Result<(), FileError> {
        let cells = row.cells();
        self.check_finite(&cells)?;
        self.record(cells)
    }

    fn check_finite(&self, cells: &[String]) -> Result<(), FileError> {
        let is_unsound = |cell: &str| matches!(cell, "NaN" | "inf" | "-inf");
        for (cell, column) in cells.iter().zip(&self.numbers) {
            if let Some(name) = column
                && is_unsound(cell)
            {
                return Err(FileError::value(
                    &self.path,
                    FileLocation::Whole,
                    *name,
                    cell,
                    "a finite number",
                ));
            }
        }
        Ok(())
    }

    fn record(&mut self, cells: impl IntoIterator<Item = impl AsRef<[u8]>>) -> Result<(), FileError> {
        self.writer.write_record(cells).map_err(|error| csv_error(&self.path, &error))?;
        // Each row of a stream is flushed immediately.
        if self.file.is_none() { self.flush() } else { Ok(()) }
    }

    fn flush(&mut self) -> Result<(), FileError> {
        self.writer.flush().map_err(|source| FileError::io(&self.path, "write", source))
    }

    /// Flushes the buffer and gives the file its name.
    ///
    /// # Errors
    /// [`FileError::Io`].
    pub fn finish(mut self) -> Result<(), FileError> {
        self.flush()?;
        self.file.take().map_or(Ok(()), AtomicFile::commit_new)
    }
}

/// Reads all rows of a table.
///
/// # Errors
/// [`FileError`] for a file that cannot be read, or a cell that does not match its declaration, with line and
/// column.
pub fn read_csv<T: CsvLine>(path: &Path) -> Result<Vec<T>, FileError> {
    CsvReader::open::<T>(path)?.read_rows(|row, _| T::read(row))
}

/// Writes a table with `rows`.
///
/// # Errors
/// [`FileError::Io`] if the file cannot be written, [`FileError::OutputTaken`] if it exists.
pub fn write_csv<T: CsvLine>(path: &Path, rows: &[T]) -> Result<(), FileError> {
    let mut table = CsvWriter::create(path)?;
    rows.iter().try_for_each(|row| table.line(row))?;
    table.finish()
}

fn unknown_column(path: &Path, column: &str, known: &[CsvColumn]) -> FileError {
    let distance = |known: &&CsvColumn| strsim::damerau_levenshtein(known.name, column);
    let nearest = known.iter().min_by_key(distance).map_or("", |known| known.name);
    FileError::UnknownColumn { path: path.to_owned(), column: column.to_owned(), nearest: nearest.to_owned() }
}

pub(crate) fn csv_error(path: &Path, error: &csv::Error) -> FileError {
    let line = |position: &Option<csv::Position>| {
        FileLocation::Line(position.as_ref().map_or(0, csv::Position::line))
    };
    match error.kind() {
        csv::ErrorKind::Io(source) => {
            FileError::io(path, "read or write", std::io::Error::new(source.kind(), source.to_string()))
        }
        csv::ErrorKind::UnequalLengths { pos, expected_len, len } => FileError::value(
            path,
            line(pos),
            "number of cells",
            len,
            format!("{expected_len}, as in the header"),
        ),
        csv::ErrorKind::Utf8 { pos, err } => {
            FileError::value(path, line(pos), format!("cell {}", err.field() + 1), "bytes", "text in UTF-8")
        }
        _ => FileError::format(path, "CSV", error),
    }
}

#[cfg(test)]
mod tests {
    use tempfile::tempdir;

    use super::*;

    crate::table! {
        /// Row with a number and a text that looks like one.
        struct Measure: csv {
            /// number
            number: f64,
            /// number that may be absent
            other: Option<f64>,
            /// text
            text: String,
        }
    }

    #[test]
    fn a_number_that_is_not_finite_is_not_written() {
        let directory = tempdir().unwrap();
        let row = |number, other| Measure { number, other, text: "NaN".to_owned() };
        write_csv(&directory.path().join("good.csv"), &[row(1.0, Some(2.0)), row(-0.0, None)]).unwrap();
        for (name, rows, column) in [
            ("a.csv", [row(1.0, None), row(f64::NAN, None)], "number"),
            ("b.csv", [row(f64::INFINITY, None), row(1.0, None)], "number"),
            ("c.csv", [row(1.0, None), row(1.0, Some(f64::NEG_INFINITY))], "other"),
        ] {
            let path = directory.path().join(name);
            let message = write_csv(&path, &rows).unwrap_err().to_string();
            assert!(
                message.contains(&format!("`{column}` is")) && message.contains("a finite number"),
                "{message}"
            );
            assert!(!path.exists(), "{name} is written in part");
        }
    }
}
