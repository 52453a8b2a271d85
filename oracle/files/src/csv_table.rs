//! A CSV table whose columns are known by name, and whose errors name line and column.

use std::fs::File;
use std::io::Write;
use std::path::{Path, PathBuf};

use super::error::{Place, open_regular};
use super::lines::Lines;
use super::{FileError, WholeFile};

/// Whether a file may lack a column.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Presence {
    Required,
    Optional,
}

/// The columns of a kind of table, in the order in which they are written.
pub(super) type Layout = &'static [(&'static str, Presence)];

/// A table being read, row by row.
pub(super) struct CsvReader {
    path: PathBuf,
    layout: Layout,
    /// For each column of the layout, where the file has it.
    positions: Vec<Option<usize>>,
    reader: csv::Reader<Lines<File>>,
    record: csv::StringRecord,
}

impl CsvReader {
    /// Opens a table and checks its header: every required column, no unknown one, none twice.
    pub(super) fn open(path: &Path, layout: Layout) -> Result<Self, FileError> {
        let file = Lines::new(open_regular(path)?);
        let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::Headers).from_reader(file);
        let header = reader.headers().map_err(|error| csv_error(path, &error))?.clone();
        let mut positions = vec![None; layout.len()];
        for (position, name) in header.iter().enumerate() {
            let mut columns = layout.iter().zip(&mut positions);
            let Some((_, place)) = columns.find(|((known, _), _)| *known == name) else {
                return Err(unknown_column(path, name, layout));
            };
            if place.replace(position).is_some() {
                return Err(FileError::value(path, Place::Line(1), "header", name, "each column once"));
            }
        }
        for ((name, presence), position) in layout.iter().zip(&positions) {
            if *presence == Presence::Required && position.is_none() {
                return Err(FileError::MissingColumn {
                    path: path.to_owned(),
                    column: (*name).to_owned(),
                    found: header.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", "),
                });
            }
        }
        Ok(Self { path: path.to_owned(), layout, positions, reader, record: csv::StringRecord::new() })
    }

    /// All rows, each with its line in the file; `parse` is given the row before too. A table without rows is an error.
    pub(super) fn read_all<T>(
        mut self,
        parse: impl Fn(&CsvRow<'_>, Option<&T>) -> Result<T, FileError>,
    ) -> Result<Vec<(u64, T)>, FileError> {
        let mut rows: Vec<(u64, T)> = Vec::new();
        while let Some(row) = self.next_row()? {
            let parsed = parse(&row, rows.last().map(|(_, row)| row))?;
            rows.push((row.line, parsed));
        }
        if rows.is_empty() {
            return Err(FileError::value(&self.path, Place::Header, "number of rows", 0, "at least 1"));
        }
        Ok(rows)
    }

    /// The next row; `None` at the end.
    pub(super) fn next_row(&mut self) -> Result<Option<CsvRow<'_>>, FileError> {
        let more =
            self.reader.read_record(&mut self.record).map_err(|error| csv_error(&self.path, &error))?;
        let line = self.record.position().map_or(0, csv::Position::line);
        Ok(more.then_some(CsvRow { table: self, line }))
    }
}

/// One row of a table.
pub(super) struct CsvRow<'a> {
    table: &'a CsvReader,
    pub(super) line: u64,
}

impl CsvRow<'_> {
    /// The cell of a column as it stands; empty when the file has no such column.
    pub(super) fn text(&self, column: &'static str) -> &str {
        let index = self.table.layout.iter().position(|(name, _)| *name == column);
        debug_assert!(index.is_some(), "`{column}` is not in the layout");
        let position = index.and_then(|i| self.table.positions.get(i).copied().flatten());
        position.and_then(|i| self.table.record.get(i)).unwrap_or("")
    }

    /// The error of a cell that is not what was `expected`.
    pub(super) fn error(&self, column: &'static str, expected: impl Into<String>) -> FileError {
        FileError::value(&self.table.path, Place::Line(self.line), column, self.text(column), expected)
    }

    /// A number, neither NaN nor infinite.
    pub(super) fn number(&self, column: &'static str) -> Result<f64, FileError> {
        match self.text(column).trim().parse::<f64>() {
            Ok(value) if value.is_finite() => Ok(value),
            _ => Err(self.error(column, "a finite number")),
        }
    }

    /// A whole number from 0.
    pub(super) fn count<T: std::str::FromStr>(&self, column: &'static str) -> Result<T, FileError> {
        self.text(column).trim().parse().map_err(|_| self.error(column, "a whole number, 0 or greater"))
    }

    /// Numbers that stand together: all of them, or `None` when every cell is empty.
    pub(super) fn optional_numbers<const N: usize>(
        &self,
        columns: [&'static str; N],
    ) -> Result<Option<[f64; N]>, FileError> {
        if columns.iter().all(|column| self.text(column).trim().is_empty()) {
            Ok(None)
        } else {
            self.numbers(columns).map(Some)
        }
    }

    /// Numbers that stand together.
    pub(super) fn numbers<const N: usize>(&self, columns: [&'static str; N]) -> Result<[f64; N], FileError> {
        let mut numbers = [0.0; N];
        for (number, column) in numbers.iter_mut().zip(columns) {
            *number = self.number(column)?;
        }
        Ok(numbers)
    }

    /// The number of the row's frame, which must be larger than that of the row before.
    pub(super) fn frame_after(&self, previous: Option<u64>) -> Result<u64, FileError> {
        self.number_after("frame", previous)
    }

    /// The number of the row's frame or field, in this column, which must be larger than that of the row before.
    pub(super) fn number_after(&self, column: &'static str, previous: Option<u64>) -> Result<u64, FileError> {
        let number = self.count(column)?;
        match previous {
            Some(previous) if number <= previous => Err(self.error(
                column,
                format!("more than {previous}, that of the row before (each {column} once, ascending)"),
            )),
            _ => Ok(number),
        }
    }
}

/// A table being written: a file that has its name when it is complete, or a stream.
pub(super) struct CsvWriter {
    path: PathBuf,
    writer: csv::Writer<Box<dyn Write>>,
    /// None of a stream.
    file: Option<WholeFile>,
}

impl CsvWriter {
    /// Creates the table and writes its header.
    pub(super) fn create(path: &Path, layout: Layout) -> Result<Self, FileError> {
        let file = WholeFile::create_new(path)?;
        let out = file.file().try_clone().map_err(|source| FileError::io(path, "create", source))?;
        Self::headed(path, Box::new(out), Some(file), layout)
    }

    /// Writes the table to a stream that goes by `name` in messages, header first, each row as soon as it is there.
    pub(super) fn stream(name: &str, out: impl Write + 'static, layout: Layout) -> Result<Self, FileError> {
        Self::headed(Path::new(name), Box::new(out), None, layout)
    }

    fn headed(
        path: &Path,
        out: Box<dyn Write>,
        file: Option<WholeFile>,
        layout: Layout,
    ) -> Result<Self, FileError> {
        let mut writer = Self { path: path.to_owned(), writer: csv::Writer::from_writer(out), file };
        writer.write(layout.iter().map(|(name, _)| (*name).to_owned()))?;
        Ok(writer)
    }

    /// Writes a row of cells.
    pub(super) fn write(&mut self, cells: impl IntoIterator<Item = String>) -> Result<(), FileError> {
        self.writer.write_record(cells).map_err(|error| csv_error(&self.path, &error))?;
        // A row of a stream goes out at once.
        if self.file.is_none() { self.flush() } else { Ok(()) }
    }

    fn flush(&mut self) -> Result<(), FileError> {
        self.writer.flush().map_err(|source| FileError::io(&self.path, "write", source))
    }

    /// Writes what is buffered, and gives the file its name.
    pub(super) fn finish(mut self) -> Result<(), FileError> {
        self.flush()?;
        self.file.take().map_or(Ok(()), WholeFile::commit_new)
    }
}

/// The shortest text that reads back to the same bits.
pub(super) fn cell(value: f64) -> String {
    format!("{value:?}")
}

/// Cells of numbers that may be absent together.
pub(super) fn cells<const N: usize>(values: Option<[f64; N]>) -> [String; N] {
    values.map_or_else(|| std::array::from_fn(|_| String::new()), |values| values.map(cell))
}

fn unknown_column(path: &Path, column: &str, layout: Layout) -> FileError {
    let distance = |known: &str| strsim::damerau_levenshtein(known, column);
    let nearest = layout.iter().map(|(known, _)| *known).min_by_key(|known| distance(known)).unwrap_or("");
    FileError::UnknownColumn { path: path.to_owned(), column: column.to_owned(), nearest: nearest.to_owned() }
}

pub(super) fn csv_error(path: &Path, error: &csv::Error) -> FileError {
    let line =
        |position: &Option<csv::Position>| Place::Line(position.as_ref().map_or(0, csv::Position::line));
    match error.kind() {
        csv::ErrorKind::Io(source) => {
            FileError::io(path, "read or write", std::io::Error::new(source.kind(), source.to_string()))
        }
        csv::ErrorKind::UnequalLengths { pos, expected_len, len } => FileError::value(
            path,
            line(pos),
            "number of cells",
            len,
            format!("{expected_len}, as many as the header has"),
        ),
        csv::ErrorKind::Utf8 { pos, err } => {
            FileError::value(path, line(pos), format!("cell {}", err.field() + 1), "bytes", "text in UTF-8")
        }
        _ => FileError::format(path, "CSV", error),
    }
}
