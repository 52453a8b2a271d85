//! Writing of columns to a Parquet file: encoded on arrival, written one row group at a time.

use std::borrow::Cow;
use std::io::{self, BufWriter, Write};
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use bytes::Bytes;
use parquet::basic::{Compression, Encoding};
use parquet::column::page::{CompressedPage, PageWriteSpec, PageWriter};
use parquet::column::writer::{ColumnWriter, ColumnWriterImpl, get_column_writer};
use parquet::data_type::{ByteArray, DataType};
use parquet::errors::{ParquetError, Result as ParquetResult};
use parquet::file::metadata::KeyValue;
use parquet::file::properties::{EnabledStatistics, WriterProperties, WriterPropertiesPtr};
use parquet::file::writer::{SerializedFileWriter, SerializedPageWriter, TrackedWrite};
use parquet::schema::types::ColumnPath;

use super::column_type::schema;
use super::file::damaged;
use crate::FileError;
use crate::table::column::{Cells, Coding, Column, ColumnValues, TextCells};

/// RequiredSize of the write buffer, bytes: the crate copies columns to a file 8 KB at a time.
const BUFFER_BYTES: usize = 1 << 18;

/// Largest dictionary of a column in a row group, bytes: the dictionary of a column without repeats would
/// hold all of its values twice.
const DICTIONARY_BYTES: usize = 1 << 16;

/// Options of a Parquet file.
#[derive(Debug, Clone)]
pub struct TableOptions {
    /// Number of rows in a row group, whose encoded bytes are held in memory before they are written.
    pub row_group_rows: usize,
    /// True if the file contains the minimum and maximum of each page.
    pub has_statistics: bool,
    /// Keys and values of the metadata.
    pub notes: Vec<(String, String)>,
    /// True if numbers that are not finite are refused; false only for files that test a reader.
    pub is_checked: bool,
}

impl Default for TableOptions {
    fn default() -> Self {
        Self { row_group_rows: 1 << 20, has_statistics: true, notes: Vec::new(), is_checked: true }
    }
}

/// Writes a whole table, compressed with Snappy.
///
/// # Errors
/// [`FileError`], with `path`, if the file cannot be written.
pub fn write_table(
    out: impl Write + Send,
    path: &Path,
    columns: &[Column],
    options: TableOptions,
) -> Result<(), FileError> {
    let mut writer = ParquetWriter::new(out, path, columns, options)?;
    writer.write(columns)?;
    writer.finish()
}

/// Writer of a Parquet file, to which rows are added in portions.
pub struct ParquetWriter<W: Write + Send> {
    path: PathBuf,
    file: SerializedFileWriter<BufWriter<W>>,
    properties: WriterPropertiesPtr,
    row_group_rows: usize,
    is_checked: bool,
    group: Option<RowGroup>,
}

/// A row group whose columns are being encoded.
struct RowGroup {
    rows: usize,
    columns: Vec<(ColumnWriter<'static>, EncodedPages)>,
}

impl<W: Write + Send> ParquetWriter<W> {
    /// Begins a file with the names, types and codings of these columns, without their rows.
    ///
    /// # Errors
    /// [`FileError`], with `path`, if the file cannot be written.
    pub fn new(out: W, path: &Path, columns: &[Column], options: TableOptions) -> Result<Self, FileError> {
        let properties = Arc::new(properties(columns, &options));
        let out = BufWriter::with_capacity(BUFFER_BYTES, out);
        let file =
            schema(columns).and_then(|schema| SerializedFileWriter::new(out, schema, properties.clone()));
        let file = file.map_err(|error| unwritten(path, error))?;
        let row_group_rows = options.row_group_rows.max(1);
        let is_checked = options.is_checked;
        Ok(Self { path: path.to_owned(), file, properties, row_group_rows, is_checked, group: None })
    }

    /// Adds rows: columns of equal length, with the same names and types as the columns of the file.
    ///
    /// # Errors
    /// [`FileError`] for columns of different lengths, a null in a non-nullable column, a number that is not
    /// finite, and if the file cannot be written.
    pub fn write(&mut self, columns: &[Column]) -> Result<(), FileError> {
        let rows = columns.first().map_or(0, |column| column.values().len());
        check(columns, rows, self.is_checked)
            .and_then(|()| self.encode(columns, rows))
            .map_err(|error| unwritten(&self.path, error))
    }

    /// Completes the file.
    ///
    /// # Errors
    /// [`FileError`] if the file cannot be written.
    pub fn finish(mut self) -> Result<(), FileError> {
        self.end_row_group()
            .and_then(|()| self.file.finish().map(drop))
            .map_err(|error| unwritten(&self.path, error))
    }

    fn encode(&mut self, columns: &[Column], rows: usize) -> ParquetResult<()> {
        let mut done = 0;
        while done < rows {
            let group = match &mut self.group {
                Some(group) => group,
                none => none.insert(RowGroup::new(&self.file, &self.properties)),
            };
            let some = (rows - done).min(self.row_group_rows - group.rows);
            group.encode(columns, done..done + some)?;
            done += some;
            if group.rows == self.row_group_rows {
                self.end_row_group()?;
            }
        }
        Ok(())
    }

    fn end_row_group(&mut self) -> ParquetResult<()> {
        let Some(group) = self.group.take() else { return Ok(()) };
        let mut out = self.file.next_row_group()?;
        for (writer, pages) in group.columns {
            let closed = writer.close()?;
            out.append_column(&Bytes::from(pages.take()), closed)?;
        }
        out.close().map(drop)
    }
}

impl RowGroup {
    fn new<W: Write + Send>(file: &SerializedFileWriter<W>, properties: &WriterPropertiesPtr) -> Self {
        let writer = |column: &Arc<_>| {
            let pages = EncodedPages::default();
            let sink = Box::new(PageSink(TrackedWrite::new(pages.clone())));
            (get_column_writer(Arc::clone(column), Arc::clone(properties), sink), pages)
        };
        Self { rows: 0, columns: file.schema_descr().columns().iter().map(writer).collect() }
    }

    fn encode(&mut self, columns: &[Column], rows: Range<usize>) -> ParquetResult<()> {
        for ((writer, _), column) in self.columns.iter_mut().zip(columns) {
            encode(writer, column, &rows)?;
        }
        self.rows += rows.len();
        Ok(())
    }
}

/// Rejects columns of different lengths, nulls in non-nullable columns, and numbers that are not finite,
/// which no reader accepts.
fn check(columns: &[Column], rows: usize, is_checked: bool) -> ParquetResult<()> {
    for column in columns {
        let (name, found) = (column.name(), column.values().len());
        if found != rows {
            return Err(ParquetError::General(format!(
                "column `{name}` has {found} rows, expected {rows} as in the first column"
            )));
        }
        if let Some(row) = column.values().first_null().filter(|_| !column.is_nullable()) {
            return Err(ParquetError::General(format!(
                "column `{name}` has no value in row {row}, expected one in every row"
            )));
        }
        if let Some(row) = column.values().first_unsound().filter(|_| is_checked) {
            return Err(ParquetError::General(format!(
                "column `{name}` is not a finite number in row {row}"
            )));
        }
    }
    Ok(())
}

fn properties(columns: &[Column], options: &TableOptions) -> WriterProperties {
    let notes = options.notes.iter().map(|(key, value)| KeyValue::new(key.clone(), value.clone()));
    let notes: Vec<KeyValue> = notes.collect();
    let mut properties = WriterProperties::builder()
        .set_compression(Compression::SNAPPY)
        .set_dictionary_page_size_limit(DICTIONARY_BYTES)
        .set_key_value_metadata((!notes.is_empty()).then_some(notes));
    if !options.has_statistics {
        properties = properties.set_statistics_enabled(EnabledStatistics::None);
    }
    // Dictionaries, on by default, compress the columns that repeat: frame, kind, a star's number and
    // magnitude.
    for column in columns {
        let path = || ColumnPath::from(column.name());
        properties = match column.coding() {
            Coding::Dictionary => properties,
            Coding::Plain => properties.set_column_dictionary_enabled(path(), false),
            Coding::ByteByByte => properties
                .set_column_dictionary_enabled(path(), false)
                .set_column_encoding(path(), Encoding::BYTE_STREAM_SPLIT),
        };
    }
    properties.build()
}

/// Encodes some rows of a column.
fn encode(writer: &mut ColumnWriter<'_>, column: &Column, rows: &Range<usize>) -> ParquetResult<()> {
    use ColumnWriter::*;
    let is_nullable = column.is_nullable();
    match (writer, column.values()) {
        (BoolColumnWriter(writer), ColumnValues::Boolean(cells)) => {
            encode_cells(writer, cells, rows, is_nullable, |values| Cow::Borrowed(values))
        }
        (Int32ColumnWriter(writer), ColumnValues::UInt32(cells)) => {
            encode_cells(writer, cells, rows, is_nullable, |counts| {
                counts.iter().map(|&count| count as i32).collect()
            })
        }
        (Int64ColumnWriter(writer), ColumnValues::UInt64(cells)) => {
            encode_cells(writer, cells, rows, is_nullable, |counts| {
                counts.iter().map(|&count| count as i64).collect()
            })
        }
        (Int64ColumnWriter(writer), ColumnValues::Timestamp(cells)) => {
            encode_cells(writer, cells, rows, is_nullable, |times| times.iter().map(|time| time.0).collect())
        }
        (FloatColumnWriter(writer), ColumnValues::Float32(cells)) => {
            encode_cells(writer, cells, rows, is_nullable, |values| Cow::Borrowed(values))
        }
        (DoubleColumnWriter(writer), ColumnValues::Float64(cells)) => {
            encode_cells(writer, cells, rows, is_nullable, |values| Cow::Borrowed(values))
        }
        (ByteArrayColumnWriter(writer), ColumnValues::Utf8(cells)) => {
            encode_texts(writer, cells, rows, is_nullable)
        }
        (_, values) => Err(ParquetError::General(format!(
            "column `{}` has type {}, which differs from its type in the file",
            column.name(),
            values.column_type()
        ))),
    }
}

/// Encodes cells; `stored` converts values to those of the file.
fn encode_cells<T: DataType, V: Copy + Default>(
    writer: &mut ColumnWriterImpl<'_, T>,
    cells: &Cells<V>,
    rows: &Range<usize>,
    is_nullable: bool,
    stored: impl Fn(&[V]) -> Cow<'_, [T::T]>,
) -> ParquetResult<()> {
    let flags = flags(cells.is_valid(), rows);
    let values = cells.values().get(rows.clone()).unwrap_or_default();
    let Some(is_valid) = flags else {
        return encode_values(writer, &stored(values), flags, rows.len(), is_nullable);
    };
    let present = values.iter().zip(is_valid).filter(|(_, is_valid)| **is_valid);
    let present: Vec<V> = present.map(|(value, _)| *value).collect();
    encode_values(writer, &stored(&present), flags, rows.len(), is_nullable)
}

fn encode_texts(
    writer: &mut ColumnWriterImpl<'_, parquet::data_type::ByteArrayType>,
    cells: &TextCells,
    rows: &Range<usize>,
    is_nullable: bool,
) -> ParquetResult<()> {
    let flags = flags(cells.is_valid(), rows);
    let start = |row| cells.bytes_of(row).map(|bytes| bytes.start);
    let (Some(first), Some(last)) = (start(rows.start), cells.bytes_of(rows.end.saturating_sub(1))) else {
        return encode_values(writer, &[], flags, 0, is_nullable);
    };
    // All texts share one buffer.
    let text = cells.text().get(first..last.end).unwrap_or_default();
    let text = ByteArray::from(text.as_bytes().to_vec());
    let one = |row| cells.bytes_of(row).map(|bytes| text.slice(bytes.start - first, bytes.len()));
    let is_present = |at: usize| flags.is_none_or(|flags| flags.get(at).is_some_and(|is_valid| *is_valid));
    let present = rows.clone().enumerate().filter(|(at, _)| is_present(*at));
    let values: Vec<ByteArray> = present.filter_map(|(_, row)| one(row)).collect();
    encode_values(writer, &values, flags, rows.len(), is_nullable)
}

/// Returns the validity flags of some rows.
fn flags<'a>(is_valid: Option<&'a [bool]>, rows: &Range<usize>) -> Option<&'a [bool]> {
    is_valid.and_then(|flags| flags.get(rows.clone()))
}

/// Encodes the values that are not null; for a nullable column with one level per row, 1 for a value and 0
/// for a null.
fn encode_values<T: DataType>(
    writer: &mut ColumnWriterImpl<'_, T>,
    values: &[T::T],
    flags: Option<&[bool]>,
    rows: usize,
    is_nullable: bool,
) -> ParquetResult<()> {
    let levels: Option<Vec<i16>> = is_nullable.then(|| match flags {
        Some(flags) => flags.iter().map(|&is_valid| i16::from(is_valid)).collect(),
        None => vec![1; rows],
    });
    writer.write_batch(values, levels.as_deref(), None).map(drop)
}

/// Encoded pages of a column: written by the column's writer, taken at the end of its row group.
#[derive(Clone, Default)]
struct EncodedPages(Arc<Mutex<Vec<u8>>>);

impl EncodedPages {
    fn take(&self) -> Vec<u8> {
        std::mem::take(&mut self.0.lock().unwrap_or_else(PoisonError::into_inner))
    }
}

impl Write for EncodedPages {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// Destination of a column's pages, in memory, because a file stores its columns one after another.
struct PageSink(TrackedWrite<EncodedPages>);

impl PageWriter for PageSink {
    fn write_page(&mut self, page: CompressedPage) -> ParquetResult<PageWriteSpec> {
        SerializedPageWriter::new(&mut self.0).write_page(page)
    }

    fn close(&mut self) -> ParquetResult<()> {
        self.0.flush()?;
        Ok(())
    }
}

/// Returns the error of a table that cannot be written: the error of the operating system if it was the
/// cause.
fn unwritten(path: &Path, error: ParquetError) -> FileError {
    match error {
        ParquetError::External(source) => match source.downcast::<io::Error>() {
            Ok(source) => FileError::io(path, "write", *source),
            Err(source) => damaged(path, source),
        },
        other => damaged(path, other),
    }
}

#[cfg(test)]
mod tests {
    use parquet::file::reader::{FileReader, SerializedFileReader};

    use super::*;

    fn written(columns: &[Column], options: TableOptions) -> Result<SerializedFileReader<Bytes>, FileError> {
        let mut bytes = Vec::new();
        write_table(&mut bytes, Path::new("a.parquet"), columns, options)?;
        Ok(SerializedFileReader::new(Bytes::from(bytes)).unwrap())
    }

    #[test]
    fn row_groups_have_as_many_rows_as_they_may() {
        let path = Path::new("a.parquet");
        let options = TableOptions { row_group_rows: 10, ..TableOptions::default() };
        let columns = |rows: Range<u64>| {
            [
                Column::new("n", rows.clone()),
                Column::nullable_texts("word", rows.map(|n| (n % 3 > 0).then(|| n.to_string()))),
            ]
        };
        let mut bytes = Vec::new();
        let mut writer = ParquetWriter::new(&mut bytes, path, &columns(0..0), options).unwrap();
        for rows in [0..7, 7..7, 7..8, 8..35] {
            writer.write(&columns(rows)).unwrap();
        }
        writer.finish().unwrap();
        let file = SerializedFileReader::new(Bytes::from(bytes)).unwrap();
        let groups: Vec<_> = file.metadata().row_groups().iter().map(|group| group.num_rows()).collect();
        assert_eq!(groups, [10, 10, 10, 5]);
        let rows = file.get_row_iter(None).unwrap();
        let rows: Vec<String> = rows.map(|row| row.unwrap().to_string()).collect();
        assert_eq!(rows[33], "{n: 33, word: null}");
        assert_eq!(rows[34], "{n: 34, word: \"34\"}");
    }

    #[test]
    fn a_table_has_its_notes_and_its_types() {
        let columns = [Column::new("n", [1_u32]), Column::nullable("x", [Some(0.5)])];
        let notes = vec![("version".to_owned(), "7".to_owned())];
        let file = written(&columns, TableOptions { notes, ..TableOptions::default() }).unwrap();
        let metadata = file.metadata().file_metadata();
        let expected = KeyValue::new("version".to_owned(), "7".to_owned());
        assert_eq!(metadata.key_value_metadata(), Some(&vec![expected]));
        let mut text = Vec::new();
        parquet::schema::printer::print_schema(&mut text, metadata.schema());
        let text = String::from_utf8(text).unwrap();
        assert!(text.contains("REQUIRED INT32 n (INTEGER(32,false));"), "{text}");
        assert!(text.contains("OPTIONAL DOUBLE x;"), "{text}");
    }

    #[test]
    fn columns_that_do_not_agree_are_refused_by_name() {
        let message =
            |columns: &[Column]| written(columns, TableOptions::default()).map(drop).unwrap_err().to_string();
        let uneven = message(&[Column::new("n", [1_u64, 2]), Column::new("x", [0.5])]);
        assert!(uneven.contains("column `x` has 1 rows, expected 2"), "{uneven}");
        let values = Column::nullable("x", [Some(0.5), None]).into_values();
        let null = message(&[Column::from_values("x", false, values)]);
        assert!(null.contains("column `x` has no value in row 1"), "{null}");
        let mut writer =
            ParquetWriter::new(Vec::new(), Path::new("a"), &[Column::new("x", [0.5])], Default::default())
                .unwrap();
        let other = writer.write(&[Column::new("x", [1_u64])]).unwrap_err().to_string();
        assert!(other.contains("column `x` has type UInt64"), "{other}");
    }
}
