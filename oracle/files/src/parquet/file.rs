//! Reading of Parquet files. All readers open files through this module, so none omits a check.

use std::fs::File;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use parquet::column::reader::{ColumnReader, ColumnReaderImpl, get_column_reader};
use parquet::data_type::{ByteArray, ByteArrayType, DataType};
use parquet::file::metadata::{ParquetMetaData, ParquetMetaDataReader};
use parquet::file::serialized_reader::SerializedPageReader;

use super::claims::{check_claims, check_footer};
use super::column_type::column_type;
use crate::FileError;
use crate::error::open_regular;
use crate::table::column::{Cells, Column, ColumnType, ColumnValues, Nanoseconds, TextCells};

/// Largest number of text bytes in a column of a batch: a page of a few kilobytes can repeat a text without
/// limit.
const MAX_TEXT_BYTES: usize = 1 << 25;

/// A Parquet file whose claimed sizes have been checked against its length. Only its headers have been read.
pub struct ParquetFile {
    path: PathBuf,
    file: File,
    metadata: ParquetMetaData,
    columns: Vec<FileColumn>,
}

/// Column of a Parquet file.
#[derive(Debug, Clone)]
pub struct FileColumn {
    /// Name of the column.
    pub name: String,
    /// Type of the column; for a type that Boresight tables do not use, its name as the error.
    pub column_type: Result<ColumnType, String>,
    /// True if the column is declared as nullable.
    is_nullable: bool,
}

impl ParquetFile {
    /// Opens a file.
    ///
    /// # Errors
    /// [`FileError::Io`]; [`FileError::Format`] for a file that is not Parquet, is truncated, claims more
    /// than it can contain, or has nested columns.
    pub fn open(path: &Path) -> Result<Self, FileError> {
        let mut file = open_regular(path)?;
        let length = file.metadata().map_err(|source| FileError::io(path, "read", source))?.len();
        check_footer(path, &mut file, length)?;
        let metadata = guarded(path, || {
            ParquetMetaDataReader::new().parse_and_finish(&file).map_err(|error| damaged(path, error))
        })?;
        check_claims(path, &mut file, length, &metadata)?;
        let columns = guarded(path, || {
            let columns = metadata.file_metadata().schema_descr().columns().iter();
            let column = |column: &Arc<parquet::schema::types::ColumnDescriptor>| FileColumn {
                name: column.name().to_owned(),
                column_type: column_type(column),
                is_nullable: column.max_def_level() > 0,
            };
            Ok(columns.map(column).collect())
        })?;
        Ok(Self { path: path.to_owned(), file, metadata, columns })
    }

    /// Returns the columns of the file.
    pub fn columns(&self) -> &[FileColumn] {
        &self.columns
    }

    /// Returns the column with the given name.
    pub fn column(&self, name: &str) -> Option<&FileColumn> {
        self.columns.iter().find(|column| column.name == name)
    }

    /// Returns the key-value metadata of the file.
    pub fn notes(&self) -> impl Iterator<Item = (&str, &str)> {
        let pairs = self.metadata.file_metadata().key_value_metadata();
        pairs.into_iter().flatten().filter_map(|pair| Some((pair.key.as_str(), pair.value.as_deref()?)))
    }

    /// Returns an iterator over the rows of the columns `names`, in batches of at most `rows` rows.
    ///
    /// # Errors
    /// [`FileError::Format`] for a column that is missing, duplicated, or of a type that Boresight tables do
    /// not use.
    pub fn batches<N: AsRef<str>>(self, names: &[N], rows: usize) -> Result<Batches, FileError> {
        let Self { path, file, metadata, columns } = self;
        let mut wanted = Vec::with_capacity(names.len());
        for name in names {
            let name = name.as_ref();
            let mut found = columns.iter().enumerate().filter(|(_, column)| column.name == name);
            let (index, column) =
                found.next().ok_or_else(|| damaged(&path, format!("it has no column `{name}`")))?;
            if found.next().is_some() {
                return Err(damaged(&path, format!("it has column `{name}` more than once")));
            }
            let column_type = column.column_type.clone().map_err(|other| {
                damaged(&path, format!("column `{name}` has type {other}, which no table of Boresight uses"))
            })?;
            let (name, is_nullable) = (name.to_owned(), column.is_nullable);
            wanted.push(WantedColumn { index, name, column_type, is_nullable });
        }
        Ok(Batches {
            rows_left: u64::try_from(metadata.file_metadata().num_rows()).unwrap_or(0),
            path,
            file: Arc::new(file),
            metadata,
            wanted,
            batch_rows: rows.max(1),
            groups_read: 0,
            group: None,
            scratch: Scratch::default(),
            failed: false,
        })
    }
}

/// Iterator over batches of rows: columns of equal length, in the order in which they were requested. It ends
/// after an error.
pub struct Batches {
    path: PathBuf,
    file: Arc<File>,
    metadata: ParquetMetaData,
    wanted: Vec<WantedColumn>,
    batch_rows: usize,
    /// Number of row groups opened so far.
    groups_read: usize,
    group: Option<OpenGroup>,
    scratch: Scratch,
    /// Remaining rows according to the footer.
    rows_left: u64,
    failed: bool,
}

/// A requested column.
struct WantedColumn {
    /// Index of the column in the file.
    index: usize,
    name: String,
    column_type: ColumnType,
    is_nullable: bool,
}

/// The row group that is being read.
struct OpenGroup {
    readers: Vec<ColumnReader>,
    /// Remaining rows of the group.
    rows_left: usize,
}

/// Buffers that are reused from batch to batch.
#[derive(Default)]
struct Scratch {
    levels: Vec<i16>,
    texts: Vec<ByteArray>,
}

/// Reason why a table cannot be read.
type Reason = Box<dyn std::error::Error + Send + Sync>;

impl Batches {
    /// Returns the requested columns without rows.
    pub fn header(&self) -> Vec<Column> {
        let column = |wanted: &WantedColumn| {
            Column::from_values(
                wanted.name.clone(),
                wanted.is_nullable,
                ColumnValues::empty(wanted.column_type),
            )
        };
        self.wanted.iter().map(column).collect()
    }

    fn next_batch(&mut self) -> Result<Option<Vec<Column>>, FileError> {
        let path = self.path.clone();
        let next = || self.read_batch().map_err(|reason| damaged(&path, reason));
        let Some((rows, columns)) = guarded(&path, next)? else { return Ok(None) };
        match self.rows_left.checked_sub(rows as u64) {
            Some(left) => self.rows_left = left,
            None => return Err(damaged(&self.path, MORE_ROWS)),
        }
        Ok(Some(columns))
    }

    /// Reads the next batch and returns it with its number of rows.
    fn read_batch(&mut self) -> Result<Option<(usize, Vec<Column>)>, Reason> {
        loop {
            let Some(group) = &mut self.group else {
                if self.groups_read == self.metadata.num_row_groups() {
                    return Ok(None);
                }
                self.group = Some(self.open_group(self.groups_read)?);
                self.groups_read += 1;
                continue;
            };
            let rows = group.rows_left.min(self.batch_rows);
            if rows == 0 {
                group.check_end(&self.wanted, &mut self.scratch)?;
                self.group = None;
                continue;
            }
            let mut columns = Vec::with_capacity(self.wanted.len());
            for (wanted, reader) in self.wanted.iter().zip(&mut group.readers) {
                let values = read(wanted, reader, rows, &mut self.scratch)?;
                if values.len() != rows {
                    let name = &wanted.name;
                    return Err(format!("column `{name}` has fewer rows than its row group").into());
                }
                columns.push(Column::from_values(wanted.name.clone(), wanted.is_nullable, values));
            }
            group.rows_left -= rows;
            return Ok(Some((rows, columns)));
        }
    }

    fn open_group(&self, group: usize) -> Result<OpenGroup, Reason> {
        let group = self.metadata.row_group(group);
        let rows = usize::try_from(group.num_rows())?;
        let reader = |wanted: &WantedColumn| -> Result<ColumnReader, Reason> {
            let column = group.column(wanted.index);
            let pages = SerializedPageReader::new(Arc::clone(&self.file), column, rows, None)?;
            Ok(get_column_reader(column.column_descr_ptr(), Box::new(pages)))
        };
        let readers = self.wanted.iter().map(reader).collect::<Result<_, _>>()?;
        Ok(OpenGroup { readers, rows_left: rows })
    }
}

/// Pages may contain more rows than the footer states, even without limit: a run of equal values takes a few
/// bytes.
const MORE_ROWS: &str = "it has more rows than its footer states";

impl OpenGroup {
    /// Rejects pages that continue after the last row of the group.
    fn check_end(&mut self, wanted: &[WantedColumn], scratch: &mut Scratch) -> Result<(), Reason> {
        for (wanted, reader) in wanted.iter().zip(&mut self.readers) {
            if !read(wanted, reader, 1, scratch)?.is_empty() {
                return Err(MORE_ROWS.into());
            }
        }
        Ok(())
    }
}

impl Iterator for Batches {
    type Item = Result<Vec<Column>, FileError>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.failed {
            return None;
        }
        let next = self.next_batch();
        self.failed = next.is_err();
        next.transpose()
    }
}

/// Reads the next rows of a column, at most `rows`.
fn read(
    wanted: &WantedColumn,
    reader: &mut ColumnReader,
    rows: usize,
    scratch: &mut Scratch,
) -> Result<ColumnValues, Reason> {
    use ColumnReader::*;
    let levels = wanted.is_nullable.then_some(&mut scratch.levels);
    Ok(match (reader, wanted.column_type) {
        (BoolColumnReader(reader), ColumnType::Boolean) => {
            ColumnValues::Boolean(read_cells(reader, rows, levels, |values| values)?)
        }
        (Int32ColumnReader(reader), ColumnType::UInt32) => {
            let meant = |counts: Vec<i32>| counts.into_iter().map(|count| count as u32).collect();
            ColumnValues::UInt32(read_cells(reader, rows, levels, meant)?)
        }
        (Int64ColumnReader(reader), ColumnType::UInt64) => {
            let meant = |counts: Vec<i64>| counts.into_iter().map(|count| count as u64).collect();
            ColumnValues::UInt64(read_cells(reader, rows, levels, meant)?)
        }
        (Int64ColumnReader(reader), ColumnType::Timestamp) => {
            let meant = |times: Vec<i64>| times.into_iter().map(Nanoseconds).collect();
            ColumnValues::Timestamp(read_cells(reader, rows, levels, meant)?)
        }
        (FloatColumnReader(reader), ColumnType::Float32) => {
            ColumnValues::Float32(read_cells(reader, rows, levels, |values| values)?)
        }
        (DoubleColumnReader(reader), ColumnType::Float64) => {
            ColumnValues::Float64(read_cells(reader, rows, levels, |values| values)?)
        }
        (ByteArrayColumnReader(reader), ColumnType::Utf8) => {
            let texts = read_texts(reader, rows, levels, &mut scratch.texts);
            ColumnValues::Utf8(texts.map_err(|reason| format!("column `{}`: {reason}", wanted.name))?)
        }
        _ => return Err(format!("column `{}` is damaged", wanted.name).into()),
    })
}

/// Reads cells; `convert` maps stored values to those of the table. Only nullable columns have levels.
fn read_cells<T: DataType, V: Copy + Default>(
    reader: &mut ColumnReaderImpl<T>,
    rows: usize,
    levels: Option<&mut Vec<i16>>,
    convert: impl Fn(Vec<T::T>) -> Vec<V>,
) -> Result<Cells<V>, Reason> {
    let mut values = Vec::with_capacity(rows);
    let is_valid = read_values(reader, rows, levels, &mut values)?;
    let values = convert(values);
    match is_valid {
        None => Ok(Cells::new(values)),
        Some(flags) => Cells::spread(values, flags).ok_or_else(|| DISAGREE.into()),
    }
}

fn read_texts(
    reader: &mut ColumnReaderImpl<ByteArrayType>,
    rows: usize,
    levels: Option<&mut Vec<i16>>,
    texts: &mut Vec<ByteArray>,
) -> Result<TextCells, Reason> {
    texts.clear();
    let is_valid = read_values(reader, rows, levels, texts)?;
    let size = texts.iter().try_fold(0_usize, |size, text| size.checked_add(text.len()));
    let size = size.filter(|&size| size <= MAX_TEXT_BYTES);
    let size = size.ok_or_else(|| format!("more than {MAX_TEXT_BYTES} bytes of text in {rows} rows"))?;
    let (mut bytes, mut ends) = (Vec::with_capacity(size), Vec::with_capacity(rows));
    let mut push = |text: Option<&ByteArray>| {
        bytes.extend_from_slice(text.map_or(&[], ByteArray::data));
        ends.push(bytes.len());
    };
    match &is_valid {
        None => texts.iter().for_each(|text| push(Some(text))),
        Some(flags) => {
            let mut texts = texts.iter();
            for &is_valid in flags {
                push(if is_valid { Some(texts.next().ok_or(DISAGREE)?) } else { None });
            }
        }
    }
    TextCells::from_bytes(bytes, ends, is_valid).ok_or_else(|| "a text that is not UTF-8".into())
}

const DISAGREE: &str = "the number of values in a column differs from the number in its levels";

/// Reads the values that are not null; for a nullable column, returns one flag per row.
fn read_values<T: DataType>(
    reader: &mut ColumnReaderImpl<T>,
    rows: usize,
    mut levels: Option<&mut Vec<i16>>,
    values: &mut Vec<T::T>,
) -> Result<Option<Vec<bool>>, Reason> {
    if let Some(levels) = &mut levels {
        levels.clear();
    }
    reader.read_records(rows, levels.as_deref_mut(), None, values)?;
    Ok(levels.map(|levels| levels.iter().map(|&level| level == 1).collect()))
}

/// Runs a call into the crate `parquet`, whose assertions can fail for a damaged file: such a panic is caused
/// by the file and is returned as an error.
fn guarded<T>(path: &Path, call: impl FnOnce() -> Result<T, FileError>) -> Result<T, FileError> {
    catch_unwind(AssertUnwindSafe(call)).unwrap_or_else(|_| Err(damaged(path, "it is damaged")))
}

pub(crate) fn damaged(path: &Path, reason: impl ToString) -> FileError {
    FileError::format(path, "Parquet", reason)
}

#[cfg(test)]
mod tests {
    use parquet::file::metadata::{FileMetaData, ParquetMetaDataBuilder, ParquetMetaDataWriter};
    use parquet::file::reader::{FileReader, SerializedFileReader};

    use super::*;
    use crate::parquet::writer::{TableOptions, write_table};

    /// Writes a table to a file and returns it with its directory.
    fn written(columns: &[Column]) -> (tempfile::TempDir, PathBuf) {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("table.parquet");
        write_table(File::create_new(&path).unwrap(), &path, columns, TableOptions::default()).unwrap();
        (folder, path)
    }

    /// Reads all rows of the columns `names`, in batches of `rows` rows.
    fn all(path: &Path, names: &[&str], rows: usize) -> Result<Vec<Vec<Column>>, FileError> {
        ParquetFile::open(path)?.batches(names, rows)?.collect()
    }

    /// Returns the columns of a table, each type with and without nulls.
    fn columns(rows: std::ops::Range<u64>) -> [Column; 10] {
        let odd = |n: u64| n % 2 == 1;
        [
            Column::new("flag", rows.clone().map(odd)),
            Column::nullable("flag?", rows.clone().map(|n| (n % 3 > 0).then(|| odd(n)))),
            Column::new("u32", rows.clone().map(|n| u32::MAX - n as u32)),
            Column::new("u64", rows.clone().map(|n| u64::MAX - n)),
            Column::new("f32", rows.clone().map(|n| -(n as f32))).byte_stream_split(),
            Column::nullable("f64?", rows.clone().map(|n| odd(n).then(|| 1.0 / n as f64))),
            Column::new("time", rows.clone().map(|n| Nanoseconds(-(n as i64)))),
            Column::texts("text", rows.clone().map(|n| format!("Täxt {}", n % 7))),
            Column::nullable_texts("text?", rows.clone().map(|n| odd(n).then(|| n.to_string()))),
            Column::nullable("none?", rows.map(|_| None::<u32>)),
        ]
    }

    /// Other readers may use either of the two columns.
    #[test]
    fn a_duplicate_column_is_refused() {
        let [x, y] = [1.0, 2.0].map(|value| Column::new("x", [value]));
        let (_folder, path) = written(&[x, y]);
        let refused = ParquetFile::open(&path).unwrap().batches(&["x"], 10).err().unwrap().to_string();
        assert!(refused.contains("column `x` more than once"), "{refused}");
    }

    #[test]
    fn every_type_round_trips_in_batches_of_any_size() {
        let (_folder, path) = written(&columns(0..100));
        let names = columns(0..0).map(|column| column.name().to_owned());
        let names = names.each_ref().map(String::as_str);
        for rows in [7, 100, 1000] {
            let batches = all(&path, &names, rows).unwrap();
            assert_eq!(batches.len(), 100_usize.div_ceil(rows));
            let mut first = 0;
            for batch in batches {
                let expected = columns(first..(first + rows as u64).min(100));
                for (found, expected) in batch.iter().zip(&expected) {
                    assert_eq!(found.values(), expected.values(), "{}", expected.name());
                    assert_eq!(found.is_nullable(), expected.is_nullable(), "{}", expected.name());
                }
                first += rows as u64;
            }
        }
    }

    /// Replaces the footer of the file by one that claims `rows` rows.
    fn claim(path: &Path, rows: i64) {
        let bytes = std::fs::read(path).unwrap();
        let reader = SerializedFileReader::new(File::open(path).unwrap()).unwrap();
        let metadata = reader.metadata();
        let group = metadata.row_group(0).clone().into_builder().set_num_rows(rows).build().unwrap();
        let (file, schema) = (metadata.file_metadata(), metadata.file_metadata().schema_descr_ptr());
        let file = FileMetaData::new(file.version(), rows, None, None, schema, None);
        let lying = ParquetMetaDataBuilder::new(file).set_row_groups(vec![group]).build();
        let footer = u32::from_le_bytes(bytes[bytes.len() - 8..bytes.len() - 4].try_into().unwrap());
        let mut file = bytes[..bytes.len() - 8 - footer as usize].to_vec();
        ParquetMetaDataWriter::new(&mut file, &lying).finish().unwrap();
        std::fs::write(path, file).unwrap();
    }

    #[test]
    fn pages_have_the_number_of_rows_in_the_footer() {
        for (rows, reason) in
            [(100, None), (99, Some(MORE_ROWS)), (101, Some("column `n` has fewer rows than its row group"))]
        {
            let (_folder, path) = written(&[Column::new("n", 0..100_u64)]);
            claim(&path, rows);
            let found = all(&path, &["n"], 10).map_err(|error| error.to_string());
            match (reason, found) {
                (None, Ok(batches)) => assert_eq!(batches.len(), 10),
                (Some(reason), Err(message)) => assert!(message.contains(reason), "{message}"),
                (_, found) => panic!("{rows}: {found:?}"),
            }
        }
    }

    /// A dictionary contains the text once, and a run of 8192 rows takes a few bytes.
    #[test]
    fn a_long_text_that_repeats_without_end_is_refused() {
        let text = "x".repeat(MAX_TEXT_BYTES / 8192 + 1);
        let (_folder, path) = written(&[Column::texts("word", (0..8192).map(|_| &text))]);
        assert!(std::fs::metadata(&path).unwrap().len() < 8192);
        let message = all(&path, &["word"], 8192).unwrap_err().to_string();
        assert!(
            message.contains("column `word`: more than 33554432 bytes of text in 8192 rows"),
            "{message}"
        );
        assert_eq!(all(&path, &["word"], 4096).unwrap().len(), 2);
    }

    #[test]
    fn missing_columns_and_unknown_types_are_named() {
        let (_folder, path) = written(&[Column::new("n", 0..3_u64)]);
        let message = all(&path, &["m"], 10).unwrap_err().to_string();
        assert!(message.contains("it has no column `m`"), "{message}");
        let schema = "message schema { required int64 n; }";
        let schema = parquet::schema::parser::parse_message_type(schema).unwrap();
        let out = File::create(&path).unwrap();
        let writer =
            parquet::file::writer::SerializedFileWriter::new(out, Arc::new(schema), Default::default());
        writer.unwrap().close().unwrap();
        let message = all(&path, &["n"], 10).unwrap_err().to_string();
        assert!(message.contains("column `n` has type Int64, which no table of Boresight uses"), "{message}");
    }
}
