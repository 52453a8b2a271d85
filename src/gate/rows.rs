//! `rows.parquet` of a baseline: a row a unit, with its block and what it adds to each figure.

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

use std::fs::File;
use std::path::Path;
use std::sync::Arc;

use arrow_array::{Array, ArrayRef, Float32Array, RecordBatch, StringArray, UInt32Array, UInt64Array};
use arrow_schema::{Field, Schema};
use parquet::arrow::ArrowWriter;
use parquet::basic::{Compression, Encoding};
use parquet::file::properties::{EnabledStatistics, WriterProperties};
use parquet::schema::types::ColumnPath;

use crate::files::{FileError, ParquetFile, Place, unwritten};
use crate::score::{FigureTerms, Reduction, Term, UnitTable, UnitVerdict};

/// After the name of a figure of whose values a unit may have several: how many they are.
const OF: &str = ".of";
/// Rows read at a time.
const BATCH_ROWS: usize = 8192;

/// Writes the rows, with the number of each one's block, into a file that will be `path`.
pub(super) fn write(
    file: &File,
    path: &Path,
    table: &UnitTable,
    block_of: impl Fn(usize) -> usize,
) -> Result<(), FileError> {
    let format = |error: &dyn std::fmt::Display| FileError::format(path, "Parquet", error);
    let units = &table.units;
    let mut fields = Vec::new();
    let mut columns: Vec<ArrayRef> = Vec::new();
    let mut add = |name: String, nullable: bool, column: ArrayRef| {
        fields.push(Field::new(name, column.data_type().clone(), nullable));
        columns.push(column);
    };
    add(
        "number".to_owned(),
        false,
        Arc::new(UInt64Array::from_iter_values(units.iter().map(|unit| unit.number))),
    );
    let blocks = (0..units.len()).map(|unit| block_of(unit) as u32);
    add("block".to_owned(), false, Arc::new(UInt32Array::from_iter_values(blocks)));
    let text = |of: fn(&UnitVerdict) -> &str| Arc::new(StringArray::from_iter_values(units.iter().map(of)));
    add("group".to_owned(), false, text(|unit| &unit.group));
    add("verdict".to_owned(), false, text(|unit| &unit.verdict));
    let causes = units.iter().map(|unit| unit.cause.as_deref());
    add("cause".to_owned(), true, Arc::new(StringArray::from_iter(causes)));
    for figure in &table.figures {
        let sums = figure.terms.iter().map(|term| (term.of > 0).then_some(term.sum as f32));
        add(figure.name.clone(), true, Arc::new(Float32Array::from_iter(sums)));
        if figure.terms.iter().any(|term| term.of > 1) {
            let ofs = figure.terms.iter().map(|term| term.of);
            add(format!("{}{OF}", figure.name), false, Arc::new(UInt32Array::from_iter_values(ofs)));
        }
    }
    let schema = Arc::new(Schema::new(fields));
    let mut properties = WriterProperties::builder()
        .set_compression(Compression::SNAPPY)
        .set_statistics_enabled(EnabledStatistics::None);
    // Amounts seldom repeat, and the last of their bytes are nought: byte by byte they are short.
    for figure in table.figures.iter().filter(|figure| figure.reduction != Reduction::Rate) {
        let column = ColumnPath::from(figure.name.as_str());
        properties = properties
            .set_column_dictionary_enabled(column.clone(), false)
            .set_column_encoding(column, Encoding::BYTE_STREAM_SPLIT);
    }
    let properties = properties.build();
    let batch = RecordBatch::try_new(Arc::clone(&schema), columns).map_err(|error| format(&error))?;
    let mut writer =
        ArrowWriter::try_new(file, schema, Some(properties)).map_err(|error| unwritten(path, error))?;
    writer.write(&batch).map_err(|error| unwritten(path, error))?;
    writer.close().map_err(|error| unwritten(path, error))?;
    Ok(())
}

/// Reads the rows of these figures, and the numbers of their blocks, which ascend by one from 0.
pub(super) fn read(
    path: &Path,
    figures: &[(String, Reduction)],
) -> Result<(UnitTable, Vec<usize>), FileError> {
    let mut table = UnitTable {
        units: Vec::new(),
        figures: figures
            .iter()
            .map(|(name, reduction)| FigureTerms {
                name: name.clone(),
                reduction: *reduction,
                terms: Vec::new(),
            })
            .collect(),
    };
    let mut blocks = Vec::new();
    for batch in ParquetFile::open(path)?.batches(None, BATCH_ROWS)? {
        add(path, &batch?, &mut table, &mut blocks)?;
    }
    let refuse = |row: u64, column: &str, value: &dyn std::fmt::Display, expected: String| {
        FileError::value(path, Place::Row(row), column, value, expected)
    };
    for (row, (before, this)) in (1..).zip(table.units.iter().zip(table.units.iter().skip(1))) {
        if this.number <= before.number {
            let expected = format!("more than {}, that of the row before", before.number);
            return Err(refuse(row, "number", &this.number, expected));
        }
    }
    for (row, (before, this)) in (1..).zip(blocks.iter().zip(blocks.iter().skip(1))) {
        if this != before && *this != before + 1 {
            return Err(refuse(row, "block", this, format!("{before} or {}", before + 1)));
        }
    }
    match blocks.first() {
        Some(0) => Ok((table, blocks)),
        Some(first) => Err(FileError::value(path, Place::Row(0), "block", first, "0 in the first row")),
        None => Err(FileError::value(path, Place::Header, "number of rows", 0, "at least 1")),
    }
}

fn add(
    path: &Path,
    batch: &RecordBatch,
    table: &mut UnitTable,
    blocks: &mut Vec<usize>,
) -> Result<(), FileError> {
    fn column<'a, A: Array + 'static>(
        path: &Path,
        batch: &'a RecordBatch,
        name: &str,
    ) -> Result<&'a A, FileError> {
        let found = batch.column_by_name(name).and_then(|column| column.as_any().downcast_ref());
        found.ok_or_else(|| {
            FileError::format(path, "Parquet", format!("it has no column `{name}` of its type"))
        })
    }
    let first_row = table.units.len();
    let numbers: &UInt64Array = column(path, batch, "number")?;
    let of_blocks: &UInt32Array = column(path, batch, "block")?;
    let groups: &StringArray = column(path, batch, "group")?;
    let verdicts: &StringArray = column(path, batch, "verdict")?;
    let causes: &StringArray = column(path, batch, "cause")?;
    for row in 0..batch.num_rows() {
        table.units.push(UnitVerdict {
            number: numbers.value(row),
            group: groups.value(row).to_owned(),
            verdict: verdicts.value(row).to_owned(),
            cause: (!causes.is_null(row)).then(|| causes.value(row).to_owned()),
        });
        blocks.push(of_blocks.value(row) as usize);
    }
    for figure in &mut table.figures {
        let sums: &Float32Array = column(path, batch, &figure.name)?;
        let of = format!("{}{OF}", figure.name);
        let ofs: Option<&UInt32Array> =
            batch.column_by_name(&of).map(|_| column(path, batch, &of)).transpose()?;
        for row in 0..batch.num_rows() {
            if sums.is_null(row) {
                figure.terms.push(Term::default());
                continue;
            }
            let sum = f64::from(sums.value(row));
            if !sum.is_finite() {
                let place = Place::Row((first_row + row) as u64);
                return Err(FileError::value(path, place, &figure.name, sum, "a finite number"));
            }
            figure.terms.push(Term { sum, of: ofs.map_or(1, |ofs| ofs.value(row)) });
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use parquet::file::reader::{FileReader, SerializedFileReader};

    use super::super::hand_made::{figure, sample, unit};
    use super::*;

    /// A rate of several values a unit, a rate of one, and an amount; each with a unit that has no value.
    fn table() -> UnitTable {
        let term = |sum, of| Term { sum, of };
        let pooled = vec![term(2.0, 3), Term::default(), term(0.0, 1), term(0.0, 2)];
        let pooled = FigureTerms { name: "held_rate".to_owned(), reduction: Reduction::Rate, terms: pooled };
        let rate = figure("hit_rate", Reduction::Rate, &[None, Some(1.0), Some(0.0), Some(1.0)]);
        let amount = figure("ra_rms_deg", Reduction::Rms, &[Some(0.5), Some(-0.25), None, Some(0.0)]);
        let mut table = sample(vec![pooled, rate, amount]).table;
        table.units[1] = unit(3, "missed", Some("not_linked"));
        table.units[2] = unit(4, "wrong", Some(""));
        table.units[3] = unit(9, "correct", None);
        table
    }

    /// What is read of a table that was written with the numbers of its blocks.
    fn there_and_back(table: &UnitTable, blocks: &[usize]) -> Result<(UnitTable, Vec<usize>), FileError> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("rows.parquet");
        write(&File::create_new(&path).unwrap(), &path, table, |unit| blocks[unit]).unwrap();
        let figures: Vec<_> =
            table.figures.iter().map(|figure| (figure.name.clone(), figure.reduction)).collect();
        read(&path, &figures)
    }

    fn refusal(table: &UnitTable, blocks: &[usize]) -> String {
        there_and_back(table, blocks).unwrap_err().to_string()
    }

    #[test]
    fn what_is_read_is_what_was_written() {
        let table = table();
        assert_eq!(there_and_back(&table, &[0, 0, 1, 2]).unwrap(), (table, vec![0, 0, 1, 2]));
        // Of two values or none, none alone.
        let terms = vec![Term { sum: 1.0, of: 2 }, Term::default()];
        let pairs = FigureTerms { name: "held_rate".to_owned(), reduction: Reduction::Rate, terms };
        let table = sample(vec![pairs]).table;
        assert_eq!(there_and_back(&table, &[0, 1]).unwrap().0, table);
    }

    /// Of a gate's repository, a baseline is the largest part: nothing is in a file that need not be.
    #[test]
    fn counts_are_told_where_they_are_more_than_one_and_amounts_byte_by_byte() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("rows.parquet");
        write(&File::create_new(&path).unwrap(), &path, &table(), |_| 0).unwrap();
        let file = SerializedFileReader::new(File::open(&path).unwrap()).unwrap();
        let columns: Vec<(String, bool)> = file.metadata().row_groups()[0]
            .columns()
            .iter()
            .map(|column| {
                let is_split = column.encodings().any(|encoding| encoding == Encoding::BYTE_STREAM_SPLIT);
                (column.column_path().string(), is_split)
            })
            .collect();
        let split = [
            ("number", false),
            ("block", false),
            ("group", false),
            ("verdict", false),
            ("cause", false),
            ("held_rate", false),
            ("held_rate.of", false),
            ("hit_rate", false),
            ("ra_rms_deg", true),
        ];
        assert_eq!(columns, split.map(|(name, is_split)| (name.to_owned(), is_split)));
    }

    #[test]
    fn units_ascend_and_blocks_ascend_by_one_from_nought() {
        let mut table = table();
        for (blocks, parts) in [
            ([0, 1, 3, 3], ["row 2", "`block` is `3`", "1 or 2"]),
            ([0, 1, 0, 1], ["row 2", "`block` is `0`", "1 or 2"]),
            ([1, 1, 2, 3], ["row 0", "`block` is `1`", "0 in the first row"]),
        ] {
            let message = refusal(&table, &blocks);
            assert!(parts.iter().all(|part| message.contains(part)), "{message}");
        }
        for number in [3, 2] {
            table.units[2].number = number;
            let message = refusal(&table, &[0; 4]);
            let parts = ["row 2", &format!("`number` is `{number}`"), "more than 3, that of the row before"];
            assert!(parts.iter().all(|part| message.contains(part)), "{message}");
        }
        let message = refusal(&UnitTable::default(), &[]);
        assert!(message.contains("`number of rows` is `0`, expected at least 1"), "{message}");
    }

    /// Rows are counted over the whole file, and not over what is read at a time.
    #[test]
    fn a_value_that_is_no_number_is_told_with_its_row() {
        let row = BATCH_ROWS + 3;
        let mut values = vec![Some(0.5); row + 2];
        values[row] = Some(f64::NAN);
        let table = sample(vec![figure("ra_rms_deg", Reduction::Rms, &values)]).table;
        let message = refusal(&table, &vec![0; row + 2]);
        assert!(message.contains("row 8195: `ra_rms_deg` is `NaN`, expected a finite number"), "{message}");
    }

    #[test]
    fn a_column_that_is_missing_or_of_another_type_is_named() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("rows.parquet");
        write(&File::create_new(&path).unwrap(), &path, &table(), |_| 0).unwrap();
        for name in ["dec_rms_deg", "number"] {
            let message = read(&path, &[(name.to_owned(), Reduction::Rms)]).unwrap_err().to_string();
            assert!(message.contains(&format!("no column `{name}` of its type")), "{message}");
        }
    }
}
