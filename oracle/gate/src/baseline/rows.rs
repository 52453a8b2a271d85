//! `rows.parquet` of a baseline: one row per unit, with its block and its contribution to each figure.

use std::fs::File;
use std::path::Path;

use files::{
    Cell, Cells, Column, ColumnValues, Columns, FieldDeclaration, FileError, FileLocation, ParquetFile, Row,
    Table, TableOptions, table, write_table,
};
use score::{FigureTerms, Reduction, Term, UnitTable, UnitVerdict};

/// Suffix of the column that counts the values, for a figure that may have several values per unit.
const OF: &str = ".of";
/// Number of rows read at a time.
const BATCH_ROWS: usize = 8192;

table! {
    /// Columns common to the rows of every baseline.
    struct UnitRow: parquet(number) {
        /// number of the frame, field or case; ascending
        number: u64,
        /// number of the unit's block, from 0; ascending by one
        block: u32,
        /// group of the unit: its day, range or lens
        group: String,
        /// verdict: far range `correct`, `wrong`, `missed`; docking `success`, `range_only`, `doubtful`,
        /// `wrong`, `missed`; for a case `37 of 40`, the number of frames that are right
        verdict: String,
        /// cause of the verdict; null if there is none
        cause: Option<String>,
    }
}

/// Returns the columns of `rows.parquet` that every baseline has.
pub fn row_columns() -> Vec<FieldDeclaration> {
    UnitRow::declarations()
}

/// Writes the rows, with the number of the block of each, to a file that will become `path`.
pub(crate) fn write(
    file: &File,
    path: &Path,
    table: &UnitTable,
    block_of: impl Fn(usize) -> usize,
) -> Result<(), FileError> {
    let units = &table.units;
    let row = |(index, unit): (usize, &UnitVerdict)| UnitRow {
        number: unit.number,
        block: block_of(index) as u32,
        group: unit.group.clone(),
        verdict: unit.verdict.clone(),
        cause: unit.cause.clone(),
    };
    let mut columns = UnitRow::columns(&units.iter().enumerate().map(row).collect::<Vec<_>>());
    for figure in &table.figures {
        let sums = figure.terms.iter().map(|term| (term.count > 0).then_some(term.sum as f32));
        let sums = Column::nullable(&figure.name, sums);
        // Amounts seldom repeat, and their last bytes are zero, so byte-by-byte coding makes them short.
        columns.push(if figure.reduction == Reduction::Rate { sums } else { sums.byte_stream_split() });
        if figure.terms.iter().any(|term| term.count > 1) {
            columns.push(Column::new(count_column(&figure.name), figure.terms.iter().map(|term| term.count)));
        }
    }
    write_table(file, path, &columns, TableOptions { has_statistics: false, ..TableOptions::default() })
}

/// Returns the name of the column with the number of values in each amount of a figure.
fn count_column(figure: &str) -> String {
    format!("{figure}{OF}")
}

/// Reads the rows of the given figures, and the numbers of their blocks, which ascend by one from 0.
pub(crate) fn read(
    path: &Path,
    figures: &[(String, Reduction)],
) -> Result<(UnitTable, Vec<usize>), FileError> {
    let mut table = UnitTable {
        units: Vec::new(),
        figures: figures
            .iter()
            .map(|(name, reduction)| FigureTerms::from_terms(name, *reduction, Vec::new()))
            .collect(),
    };
    let mut blocks = Vec::new();
    let file = ParquetFile::open(path)?;
    for column in UnitRow::columns(&[]) {
        let column_type = Ok(column.values().column_type());
        if file.column(column.name()).is_none_or(|found| found.column_type != column_type) {
            return Err(no_column(path, column.name()));
        }
    }
    // Only existing columns are requested; the checks of types below report the missing ones.
    let names: Vec<String> = names(figures).filter(|name| file.column(name).is_some()).collect();
    let of_other_type = names.iter().find(|name| file.column(name).is_some_and(|c| c.column_type.is_err()));
    if let Some(name) = of_other_type {
        return Err(no_column(path, name));
    }
    for batch in file.batches(&names, BATCH_ROWS)? {
        add(path, &batch?, &mut table, &mut blocks)?;
    }
    let refuse = |row: u64, column: &str, value: &dyn std::fmt::Display, expected: String| {
        FileError::value(path, FileLocation::Row(row), column, value, expected)
    };
    for (row, (before, this)) in (1..).zip(table.units.iter().zip(table.units.iter().skip(1))) {
        if this.number <= before.number {
            let expected = format!("more than {}, the number in the row before", before.number);
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
        Some(first) => {
            Err(FileError::value(path, FileLocation::Row(0), "block", first, "0 in the first row"))
        }
        None => Err(FileError::value(path, FileLocation::Header, "number of rows", 0, "at least 1")),
    }
}

/// Returns the names of the table's columns for the given figures.
fn names(figures: &[(String, Reduction)]) -> impl Iterator<Item = String> {
    let ofs = figures.iter().flat_map(|(name, _)| [name.clone(), count_column(name)]);
    ["number", "block", "group", "verdict", "cause"].map(str::to_owned).into_iter().chain(ofs)
}

/// Creates the error of a missing column. Either file may be damaged, so the message names both.
fn no_column(path: &Path, name: &str) -> FileError {
    let wanted = "of the type that the figures in baseline.toml need";
    FileError::format(path, "Parquet", format!("it has no column `{name}` {wanted}"))
}

fn add(
    path: &Path,
    batch: &[Column],
    table: &mut UnitTable,
    blocks: &mut Vec<usize>,
) -> Result<(), FileError> {
    let find = |name: &str| batch.iter().find(|column| column.name() == name).map(Column::values);
    fn cells<'a, T: Cell>(
        path: &Path,
        found: Option<&'a ColumnValues>,
        name: &str,
    ) -> Result<&'a Cells<T>, FileError> {
        found.and_then(T::cells).ok_or_else(|| no_column(path, name))
    }
    let first_row = table.units.len();
    for row in UnitRow::rows(&Columns::new(path, batch, first_row as u64))? {
        let UnitRow { number, block, group, verdict, cause } = row;
        table.units.push(UnitVerdict { number, group, verdict, cause });
        blocks.push(block as usize);
    }
    for figure in &mut table.figures {
        let sums: &Cells<f32> = cells(path, find(&figure.name), &figure.name)?;
        let of = count_column(&figure.name);
        let ofs: Option<&Cells<u32>> = find(&of).map(|found| cells(path, Some(found), &of)).transpose()?;
        for (row, sum) in sums.iter().enumerate() {
            let Some(sum) = sum.map(f64::from) else {
                figure.terms.push(Term::default());
                continue;
            };
            if !sum.is_finite() {
                let place = FileLocation::Row((first_row + row) as u64);
                return Err(FileError::value(path, place, &figure.name, sum, "a finite number"));
            }
            let of = ofs.map_or(1, |ofs| ofs.values().get(row).copied().unwrap_or_default());
            figure.terms.push(Term { sum, count: of });
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use parquet::basic::Encoding;
    use parquet::file::reader::{FileReader, SerializedFileReader};

    use super::*;
    use crate::hand_made::{figure, sample, unit};

    /// Returns a rate with several values per unit, a rate with one value, and an amount; each has a unit
    /// without a value.
    fn table() -> UnitTable {
        let term = |sum, of| Term { sum, count: of };
        let pooled = vec![term(2.0, 3), Term::default(), term(0.0, 1), term(0.0, 2)];
        let pooled = FigureTerms::from_terms("held_rate", Reduction::Rate, pooled);
        let rate = figure("hit_rate", Reduction::Rate, &[None, Some(1.0), Some(0.0), Some(1.0)]);
        let amount = figure("ra_rms_deg", Reduction::Rms, &[Some(0.5), Some(-0.25), None, Some(0.0)]);
        let mut table = sample(vec![pooled, rate, amount]).table;
        table.units[1] = unit(3, "missed", Some("not_linked"));
        table.units[2] = unit(4, "wrong", Some(""));
        table.units[3] = unit(9, "correct", None);
        table
    }

    /// Writes a table with the numbers of its blocks, and reads it back.
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
    fn rows_round_trip() {
        let table = table();
        assert_eq!(there_and_back(&table, &[0, 0, 1, 2]).unwrap(), (table, vec![0, 0, 1, 2]));
        // Units with two values or none, but none with one.
        let terms = vec![Term { sum: 1.0, count: 2 }, Term::default()];
        let pairs = FigureTerms::from_terms("held_rate", Reduction::Rate, terms);
        let table = sample(vec![pairs]).table;
        assert_eq!(there_and_back(&table, &[0, 1]).unwrap().0, table);
    }

    /// A baseline is the largest part of a gate's repository, so the file contains only necessary data.
    #[test]
    fn counts_are_written_where_they_are_more_than_one_and_amounts_byte_by_byte() {
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
            let parts =
                ["row 2", &format!("`number` is `{number}`"), "more than 3, the number in the row before"];
            assert!(parts.iter().all(|part| message.contains(part)), "{message}");
        }
        let message = refusal(&UnitTable::default(), &[]);
        assert!(message.contains("`number of rows` is `0`, expected at least 1"), "{message}");
    }

    /// Rows are counted from the beginning of the file, not of the batch.
    #[test]
    fn a_value_that_is_no_number_is_reported_with_its_row() {
        let row = BATCH_ROWS + 3;
        let mut values = vec![Some(0.5); row + 2];
        values[row] = Some(f64::NAN);
        let table = sample(vec![figure("ra_rms_deg", Reduction::Rms, &values)]).table;
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("rows.parquet");
        let message = write(&File::create_new(&path).unwrap(), &path, &table, |_| 0).unwrap_err().to_string();
        assert!(message.contains("column `ra_rms_deg` is not a finite number in row 8195"), "{message}");
    }

    #[test]
    fn a_column_that_is_missing_or_of_another_type_is_named() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("rows.parquet");
        write(&File::create_new(&path).unwrap(), &path, &table(), |_| 0).unwrap();
        for name in ["dec_rms_deg", "number"] {
            let message = read(&path, &[(name.to_owned(), Reduction::Rms)]).unwrap_err().to_string();
            assert!(message.contains(&format!("no column `{name}` of the type")), "{message}");
        }
    }
}
