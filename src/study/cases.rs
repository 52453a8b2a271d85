//! The rows of a study: a case each, with what was drawn and what came of it.

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

use std::io::Write;
use std::path::Path;
use std::sync::Arc;

use arrow_array::{Array, ArrayRef, BooleanArray, Float64Array, RecordBatch, StringArray, UInt64Array};
use arrow_schema::{DataType, Field, Schema};
use indexmap::IndexMap;
use parquet::arrow::ArrowWriter;
use parquet::basic::Compression;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use sha2::{Digest, Sha256};

use crate::files::{FileError, ParquetFile, unwritten};
use crate::sha256::hex;

/// A drawn value.
#[derive(Debug, Clone, PartialEq)]
pub enum Drawn {
    /// A number.
    Number(f64),
    /// Anything else, as JSON.
    Text(String),
}

impl Drawn {
    /// As a person reads it.
    pub fn shown(&self) -> String {
        match self {
            Self::Number(number) => number.to_string(),
            Self::Text(text) => text.clone(),
        }
    }
}

/// A figure of a case.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CaseFigure {
    /// The value; `None` when it is counted over nothing.
    pub value: Option<f64>,
    /// How many count: of a rate, `value` is `count`/`of`.
    pub count: u64,
    /// How many it is counted over.
    pub of: u64,
}

/// A case and what came of it.
#[derive(Debug, Clone, PartialEq)]
pub struct CaseRow {
    /// Number of the case.
    pub case: u64,
    /// Seed of its scenario.
    pub seed: u64,
    /// Whether the pipeline itself failed, at one frame or more: it crashed, gave no answer in time, or none that can be read.
    pub has_failed: bool,
    /// Drawn values, in the order of the table's columns.
    pub drawn: Vec<Drawn>,
    /// Figures, in the order of the table's columns.
    pub figures: Vec<CaseFigure>,
}

/// Rows with their columns.
#[derive(Debug, Clone, PartialEq)]
pub struct CaseTable {
    /// Names of what is drawn, and whether they are numbers.
    pub drawn: IndexMap<String, bool>,
    /// Names of the figures.
    pub figures: Vec<String>,
    /// The rows, by number of the case.
    pub rows: Vec<CaseRow>,
}

/// Before the name of a drawn value's column.
const SET: &str = "set.";
/// Rows read at a time.
const BATCH_ROWS: usize = 8192;

impl CaseTable {
    /// SHA-256 of the rows and the names of their columns, hexadecimal: what a table says, however it is encoded.
    pub fn sha256(&self) -> String {
        let mut hash = Sha256::new();
        let mut text = |text: &str| {
            hash.update((text.len() as u64).to_le_bytes());
            hash.update(text);
        };
        self.drawn.keys().for_each(|name| text(name));
        self.figures.iter().for_each(|name| text(name));
        for row in &self.rows {
            hash.update(row.case.to_le_bytes());
            hash.update(row.seed.to_le_bytes());
            hash.update([u8::from(row.has_failed)]);
            for drawn in &row.drawn {
                match drawn {
                    Drawn::Number(number) => hash.update(number.to_bits().to_le_bytes()),
                    Drawn::Text(text) => {
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
        }
        hex(hash.finalize())
    }

    /// Writes the rows as Parquet: `case`, `seed`, `has_failed`, `set.PATH` for what was drawn, and NAME, NAME.count, NAME.of for each figure.
    ///
    /// # Errors
    /// [`FileError`], of `path`, when the file cannot be written.
    pub fn write(
        &self,
        file: impl Write + Send,
        path: &Path,
        metadata: &[(&str, String)],
    ) -> Result<(), FileError> {
        let (schema, columns) = self.columns();
        let schema = Arc::new(schema);
        let metadata = metadata.iter().map(|(key, value)| KeyValue::new((*key).to_owned(), value.clone()));
        let properties = WriterProperties::builder()
            .set_compression(Compression::SNAPPY)
            .set_key_value_metadata(Some(metadata.collect()))
            .build();
        let format = |error: &dyn std::fmt::Display| FileError::format(path, "Parquet", error);
        let batch = RecordBatch::try_new(Arc::clone(&schema), columns).map_err(|error| format(&error))?;
        let mut writer =
            ArrowWriter::try_new(file, schema, Some(properties)).map_err(|error| unwritten(path, error))?;
        writer.write(&batch).map_err(|error| unwritten(path, error))?;
        writer.close().map(drop).map_err(|error| unwritten(path, error))
    }

    #[expect(clippy::indexing_slicing, reason = "a row has a value for every column of its table")]
    fn columns(&self) -> (Schema, Vec<ArrayRef>) {
        let mut fields = Vec::new();
        let mut columns: Vec<ArrayRef> = Vec::new();
        let mut add = |name: String, nullable: bool, column: ArrayRef| {
            fields.push(Field::new(name, column.data_type().clone(), nullable));
            columns.push(column);
        };
        let whole =
            |of: &dyn Fn(&CaseRow) -> u64| Arc::new(UInt64Array::from_iter_values(self.rows.iter().map(of)));
        add("case".to_owned(), false, whole(&|row| row.case));
        add("seed".to_owned(), false, whole(&|row| row.seed));
        let has_failed = self.rows.iter().map(|row| Some(row.has_failed));
        add("has_failed".to_owned(), false, Arc::new(BooleanArray::from_iter(has_failed)));
        for (index, (name, is_number)) in self.drawn.iter().enumerate() {
            let cells = self.rows.iter().map(|row| &row.drawn[index]);
            let column: ArrayRef = if *is_number {
                Arc::new(Float64Array::from_iter(cells.map(|cell| match cell {
                    Drawn::Number(number) => Some(*number),
                    Drawn::Text(_) => None,
                })))
            } else {
                Arc::new(StringArray::from_iter_values(cells.map(Drawn::shown)))
            };
            add(format!("{SET}{name}"), false, column);
        }
        for (index, name) in self.figures.iter().enumerate() {
            let values = self.rows.iter().map(|row| row.figures[index].value);
            add(name.clone(), true, Arc::new(Float64Array::from_iter(values)));
            add(format!("{name}.count"), false, whole(&|row| row.figures[index].count));
            add(format!("{name}.of"), false, whole(&|row| row.figures[index].of));
        }
        (Schema::new(fields), columns)
    }

    /// The columns of a file of cases, without its rows.
    ///
    /// # Errors
    /// [`FileError`] for a file that cannot be read or is damaged.
    pub fn columns_of(path: &Path) -> Result<Self, FileError> {
        let file = ParquetFile::open(path)?;
        let fields = file.schema().fields();
        let drawn = fields.iter().filter_map(|field| {
            let name = field.name().strip_prefix(SET)?;
            Some((name.to_owned(), *field.data_type() == DataType::Float64))
        });
        let figures = fields.iter().filter_map(|field| field.name().strip_suffix(".of"));
        Ok(Self {
            drawn: drawn.collect(),
            figures: figures.filter(|name| !name.starts_with(SET)).map(str::to_owned).collect(),
            rows: Vec::new(),
        })
    }

    /// Reads a table with these columns, and what was written beside the rows.
    ///
    /// # Errors
    /// [`FileError`] for a file that cannot be read, is damaged, or has other columns.
    pub fn read(&self, path: &Path) -> Result<(Self, IndexMap<String, String>), FileError> {
        let file = ParquetFile::open(path)?;
        let notes = file.notes().map(|(key, value)| (key.to_owned(), value.to_owned())).collect();
        let mut table = self.with_rows(Vec::new());
        for batch in file.batches(None, BATCH_ROWS)? {
            table.add(path, &batch?)?;
        }
        Ok((table, notes))
    }

    fn add(&mut self, path: &Path, batch: &RecordBatch) -> Result<(), FileError> {
        fn column<'a, A: Array + 'static>(
            path: &Path,
            batch: &'a RecordBatch,
            name: &str,
            data_type: &DataType,
        ) -> Result<&'a A, FileError> {
            let found = batch.column_by_name(name).and_then(|column| column.as_any().downcast_ref());
            found.ok_or_else(|| {
                FileError::format(
                    path,
                    "Parquet",
                    format!("it has no column `{name}` of the type {data_type}"),
                )
            })
        }
        let whole = |name: &str| column::<UInt64Array>(path, batch, name, &DataType::UInt64);
        let number = |name: &str| column::<Float64Array>(path, batch, name, &DataType::Float64);
        let text = |name: &str| column::<StringArray>(path, batch, name, &DataType::Utf8);
        let (cases, seeds) = (whole("case")?, whole("seed")?);
        let failed: &BooleanArray = column(path, batch, "has_failed", &DataType::Boolean)?;
        let mut rows: Vec<CaseRow> = (0..batch.num_rows())
            .map(|row| CaseRow {
                case: cases.value(row),
                seed: seeds.value(row),
                has_failed: failed.value(row),
                drawn: Vec::with_capacity(self.drawn.len()),
                figures: Vec::with_capacity(self.figures.len()),
            })
            .collect();
        for (name, is_number) in &self.drawn {
            let name = format!("{SET}{name}");
            if *is_number {
                let column = number(&name)?;
                rows.iter_mut()
                    .enumerate()
                    .for_each(|(i, row)| row.drawn.push(Drawn::Number(column.value(i))));
            } else {
                let column = text(&name)?;
                rows.iter_mut()
                    .enumerate()
                    .for_each(|(i, row)| row.drawn.push(Drawn::Text(column.value(i).to_owned())));
            }
        }
        for name in &self.figures {
            let (values, counts, ofs) =
                (number(name)?, whole(&format!("{name}.count"))?, whole(&format!("{name}.of"))?);
            for (i, row) in rows.iter_mut().enumerate() {
                let value = (!values.is_null(i)).then(|| values.value(i));
                row.figures.push(CaseFigure { value, count: counts.value(i), of: ofs.value(i) });
            }
        }
        self.rows.extend(rows);
        Ok(())
    }

    /// A table of the same columns.
    pub fn with_rows(&self, rows: Vec<CaseRow>) -> Self {
        Self { drawn: self.drawn.clone(), figures: self.figures.clone(), rows }
    }

    /// The numbers of a figure, case by case.
    #[expect(clippy::indexing_slicing, reason = "a row has a value for every column of its table")]
    pub fn figure(&self, name: &str) -> Option<Vec<CaseFigure>> {
        let index = self.figures.iter().position(|figure| figure == name)?;
        Some(self.rows.iter().map(|row| row.figures[index]).collect())
    }

    /// The numbers of a drawn value, case by case; `None` for what is no number.
    #[expect(clippy::indexing_slicing, reason = "a row has a value for every column of its table")]
    pub fn numbers(&self, name: &str) -> Option<Vec<f64>> {
        let index = self.drawn.get_index_of(name)?;
        let number = |row: &CaseRow| match row.drawn[index] {
            Drawn::Number(number) => Some(number),
            Drawn::Text(_) => None,
        };
        self.rows.iter().map(number).collect()
    }
}
