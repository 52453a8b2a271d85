//! Tables with a single declaration: a row is a struct, and its fields define the names and meanings of the
//! columns. The header of a CSV, its reading and writing, the columns of a Parquet file and the tables of
//! `docs/formats.md` are derived from it.

use super::column::Column;
use super::declarations::FieldDeclaration;
use super::field::{Atom, Field, Value};
use crate::csv::table::CsvRow;
use crate::{Columns, FileError};

/// Columns of one field of a row.
#[derive(Debug, Clone, Copy)]
pub struct ColumnNames<const N: usize> {
    pub(crate) names: [&'static str; N],
    is_optional: bool,
    is_nullable: bool,
    is_without_dictionary: bool,
}

impl<const N: usize> From<[&'static str; N]> for ColumnNames<N> {
    fn from(names: [&'static str; N]) -> Self {
        Self { names, is_optional: false, is_nullable: false, is_without_dictionary: false }
    }
}

/// Creates columns that a CSV may omit.
pub fn optional<const N: usize>(names: [&'static str; N]) -> ColumnNames<N> {
    ColumnNames { is_optional: true, ..names.into() }
}

/// Creates columns of a Parquet file that are declared nullable although every row has a value.
pub fn nullable<const N: usize>(names: [&'static str; N]) -> ColumnNames<N> {
    ColumnNames { is_nullable: true, ..names.into() }
}

/// Creates columns of a Parquet file whose values seldom repeat ([`Column::without_dictionary`]).
pub fn without_dictionary<const N: usize>(names: [&'static str; N]) -> ColumnNames<N> {
    ColumnNames { is_without_dictionary: true, ..names.into() }
}

impl<const N: usize> ColumnNames<N> {
    /// Returns the declaration of the field.
    pub fn declarations<F: Field<N>>(&self, meaning: &str) -> FieldDeclaration {
        FieldDeclaration {
            names: self.names.to_vec(),
            column_type: FieldCell::<'static, F, N>::TYPE,
            is_nullable: F::IS_NULLABLE || self.is_nullable,
            is_optional: self.is_optional,
            meaning: meaning.trim().to_owned(),
        }
    }

    /// Returns the columns of a Parquet file.
    pub fn columns<'a, F: Field<N> + 'a>(&self, fields: impl Iterator<Item = &'a F>) -> Vec<Column> {
        let cells: Vec<Option<[FieldCell<'a, F, N>; N]>> =
            fields.map(|field| field.value().map(Value::to_cells)).collect();
        let column = |(i, name)| {
            let cells = cells.iter().map(|cells| cells.as_ref()?.get(i).copied());
            let column = Column::from_values(name, F::IS_NULLABLE || self.is_nullable, Atom::values(cells));
            if self.is_without_dictionary { column.without_dictionary() } else { column }
        };
        self.names.into_iter().enumerate().map(column).collect()
    }

    /// Reads the field of each row of a Parquet file; the field is absent if one of its cells is null.
    ///
    /// # Errors
    /// [`FileError::Value`] for a null where a value is required, or a cell that does not match its
    /// declaration.
    pub fn read_columns<F: Field<N>>(&self, columns: &Columns<'_>) -> Result<Vec<F>, FileError> {
        let mut parts = Vec::with_capacity(N);
        for name in self.names {
            parts.push(FieldCell::<'_, F, N>::cells(columns, name)?);
        }
        let mut fields = Vec::with_capacity(columns.len());
        for row in 0..columns.len() {
            let mut null = None;
            let cells = std::array::from_fn(|i| {
                let cell = parts.get(i).and_then(|cells| Atom::get(*cells, row));
                null = null.or(cell.is_none().then_some(i));
                cell.unwrap_or_default()
            });
            let value = match null {
                None => Some(F::Value::from_cells(cells).map_err(|expected| {
                    let cells = cells.map(|cell| cell.text()).join(", ");
                    let shown = if N == 1 { cells } else { format!("[{cells}]") };
                    columns.error(row, self.name(0), shown, expected)
                })?),
                Some(_) => None,
            };
            let missing =
                || columns.error(row, self.name(null.unwrap_or_default()), "null", "a value in every row");
            fields.push(F::from_value(value).ok_or_else(missing)?);
        }
        Ok(fields)
    }

    /// Returns the cells of the field in a CSV row.
    pub fn texts(&self, field: &impl Field<N>) -> [String; N] {
        field.value().map_or_else(
            || std::array::from_fn(|_| String::new()),
            |value| value.to_cells().map(|cell| cell.text()),
        )
    }

    /// Reads the field from a CSV row: either all of its cells, or none if the field may be absent.
    ///
    /// # Errors
    /// [`FileError::Value`] for a cell that does not match its declaration.
    pub fn read_texts<F: Field<N>>(&self, row: &CsvRow<'_>) -> Result<F, FileError> {
        let is_absent = F::IS_NULLABLE && self.names.iter().all(|name| row.text(name).trim().is_empty());
        let mut cells = [Default::default(); N];
        for (cell, name) in cells.iter_mut().zip(self.names).filter(|_| !is_absent) {
            *cell = row.cell(name)?;
        }
        let value = (!is_absent).then(|| F::Value::from_cells(cells)).transpose();
        let value = value.map_err(|expected| row.error(self.name(0), expected))?;
        F::from_value(value).ok_or_else(|| row.error(self.name(0), "a value"))
    }

    /// Returns the name of a column; errors about the whole field use the first name.
    fn name(&self, i: usize) -> &'static str {
        self.names.get(i).copied().unwrap_or_default()
    }
}

/// Type of the cells of a field.
type FieldCell<'a, F, const N: usize> = <<F as Field<N>>::Value as Value<N>>::Cell<'a>;

/// Declares a table, for a new struct or for an existing one: `for` one of this crate, `struct ROW for` one
/// of another crate, which ROW contains. Each field has its meaning as a doc comment, its type, and the names
/// of its columns if they differ from the name of the field. `csv` makes the struct a row of a CSV,
/// `parquet(FIELD)` a row of a Parquet file that is ordered by the field FIELD, the number of the frame or
/// field.
#[macro_export]
macro_rules! table {
    (@names $field:ident) => {
        $crate::ColumnNames::from([stringify!($field)])
    };
    (@names $field:ident $names:expr) => {
        $crate::ColumnNames::from($names)
    };
    ($(#[$meta:meta])* $vis:vis struct $row:ident: $kind:ident $(($frame:ident))? {
        $($(#[doc = $meaning:literal])+ $field:ident: $type:ty $(= $names:expr)?,)+
    }) => {
        $(#[$meta])*
        $vis struct $row { $($(#[doc = $meaning])+ $vis $field: $type,)+ }
        $crate::table!(for $row: $kind $(($frame))? {
            $($(#[doc = $meaning])+ $field: $type $(= $names)?,)+
        });
    };
    (for $row:ident: $kind:ident $(($frame:ident))? {
        $($(#[doc = $meaning:literal])+ $field:ident: $type:ty $(= $names:expr)?,)+
    }) => {
        impl $crate::Table for $row {
            fn declarations() -> Vec<$crate::FieldDeclaration> {
                vec![$($crate::table!(@names $field $($names)?).declarations::<$type>(concat!($($meaning),+))),+]
            }
        }
        $crate::table!(@$kind $row $($frame)? { $($field: $type = $crate::table!(@names $field $($names)?),)+ });
    };
    ($(#[$meta:meta])* $vis:vis struct $row:ident for $inner:ident: parquet($frame:ident) {
        $($(#[doc = $meaning:literal])+ $field:ident: $type:ty $(= $names:expr)?,)+
    }) => {
        $(#[$meta])*
        #[derive(Debug, Clone, PartialEq)]
        $vis struct $row($vis $inner);

        impl $crate::Table for $row {
            fn declarations() -> Vec<$crate::FieldDeclaration> {
                vec![$($crate::table!(@names $field $($names)?).declarations::<$type>(concat!($($meaning),+))),+]
            }
        }

        impl $crate::Row for $row {
            const FRAME: &'static str = stringify!($frame);

            fn columns(rows: &[Self]) -> Vec<$crate::Column> {
                let mut columns = Vec::new();
                $(columns.extend(
                    $crate::table!(@names $field $($names)?).columns(rows.iter().map(|row| &row.0.$field)),
                );)+
                columns
            }

            fn rows(columns: &$crate::Columns<'_>) -> Result<Vec<Self>, $crate::FileError> {
                $(let mut $field = $crate::table!(@names $field $($names)?).read_columns(columns)?.into_iter();)+
                let mut rows = Vec::with_capacity(columns.len());
                rows.extend(std::iter::from_fn(|| Some(Self($inner { $($field: $field.next()?),+ }))));
                Ok(rows)
            }

            fn frame(&self) -> u64 {
                self.0.$frame
            }
        }
    };
    (@csv $row:ident { $($field:ident: $type:ty = $names:expr,)+ }) => {
        impl $crate::CsvLine for $row {
            fn cells(&self) -> Vec<String> {
                let mut cells = Vec::new();
                $(cells.extend($names.texts(&self.$field));)+
                cells
            }

            fn read(row: &$crate::CsvRow<'_>) -> Result<Self, $crate::FileError> {
                Ok(Self { $($field: $names.read_texts(row)?),+ })
            }
        }
    };
    (@parquet $row:ident $frame:ident { $($field:ident: $type:ty = $names:expr,)+ }) => {
        impl $crate::Row for $row {
            const FRAME: &'static str = stringify!($frame);

            fn columns(rows: &[Self]) -> Vec<$crate::Column> {
                let mut columns = Vec::new();
                $(columns.extend($names.columns(rows.iter().map(|row| &row.$field)));)+
                columns
            }

            fn rows(columns: &$crate::Columns<'_>) -> Result<Vec<Self>, $crate::FileError> {
                $(let mut $field = $names.read_columns(columns)?.into_iter();)+
                let mut rows = Vec::with_capacity(columns.len());
                rows.extend(std::iter::from_fn(|| Some(Self { $($field: $field.next()?),+ })));
                Ok(rows)
            }

            fn frame(&self) -> u64 {
                self.$frame
            }
        }
    };
}

#[cfg(test)]
mod tests {
    use std::fs::File;

    use contract::{Body, Icrs, Rotation};

    use sim::truth::ObjectKind;

    use super::*;
    use crate::{ColumnType, Row, Table, TableOptions, TableReader, write_table};

    table! {
        /// A row with a field of every kind.
        #[derive(Debug, Clone, PartialEq)]
        struct Turn: parquet(frame) {
            /// number of the frame
            frame: u64,
            /// a turn,
            /// of four columns
            turn: Rotation<Body, Icrs> = ["w", "x", "y", "z"],
            /// an object
            kind: ObjectKind,
            /// a position, or none
            place: Option<[f64; 2]> = without_dictionary(["x_px", "y_px"]),
            /// a number
            number: f64 = nullable(["number"]),
        }
    }

    fn rows() -> Vec<Turn> {
        let turn = Rotation::from_wxyz([0.6, 0.0, 0.8, 0.0]).unwrap();
        let row = |frame| {
            let place = (frame == 2).then_some([0.1, 0.2]);
            Turn { frame, turn, kind: ObjectKind::Star, place, number: 1.5 }
        };
        (1..4).map(row).collect()
    }

    /// Reads the rows back, after one column has been replaced by `other`.
    fn read(other: Option<Column>) -> Result<Vec<Turn>, String> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("table.parquet");
        let mut columns = Turn::columns(&rows());
        if let Some(other) = other {
            let place = columns.iter().position(|column| column.name() == other.name()).unwrap();
            columns[place] = other;
        }
        let options = TableOptions { is_checked: false, ..TableOptions::default() };
        write_table(File::create_new(&path).unwrap(), &path, &columns, options).unwrap();
        let frames = TableReader::<Turn>::open(&path).map_err(|error| error.to_string())?;
        let frames: Result<Vec<_>, _> = frames.collect();
        Ok(frames.map_err(|error| error.to_string())?.into_iter().flat_map(|(_, rows)| rows).collect())
    }

    #[test]
    fn a_number_that_is_not_finite_is_not_written() {
        let folder = tempfile::tempdir().unwrap();
        for number in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let path = folder.path().join(format!("{number}.parquet"));
            let mut columns = Turn::columns(&rows());
            columns[2] = Column::new("y", [0.8, number, 0.8]);
            let file = File::create_new(&path).unwrap();
            let error = write_table(file, &path, &columns, TableOptions::default()).unwrap_err();
            assert!(error.to_string().contains("column `y` is not a finite number in row 1"), "{error}");
        }
    }

    #[test]
    fn rows_round_trip_in_columns_of_their_names_and_types() {
        assert_eq!(read(None).unwrap(), rows());
        let columns = Turn::columns(&[]);
        let found: Vec<_> = columns.iter().map(|column| (column.name(), column.is_nullable())).collect();
        let required = ["frame", "w", "x", "y", "z", "kind"].map(|name| (name, false));
        assert_eq!(found[..6], required);
        assert_eq!(found[6..], ["x_px", "y_px", "number"].map(|name| (name, true)));
    }

    #[test]
    fn a_wrong_cell_is_named_by_row_and_column() {
        let one = |name, values: [f64; 3]| Some(Column::new(name, values));
        for (other, message) in [
            (one("w", [0.6, 0.7, 0.6]), "row 1: `w` is `[0.7, 0.0, 0.8, 0.0]`, expected a unit quaternion"),
            (one("y", [0.8, f64::INFINITY, 0.8]), "row 1: `y` is `inf`, expected a finite number"),
            (
                Some(Column::nullable("z", [Some(0.0), Some(0.0), None])),
                "row 2: `z` is `null`, expected a value in every row",
            ),
            (
                Some(Column::texts("kind", ["star", "upper", "star"])),
                "row 1: `kind` is `upper`, expected one of the values that this column allows",
            ),
        ] {
            let error = read(other).unwrap_err();
            assert!(error.contains(message), "{error}");
        }
    }

    #[test]
    fn a_position_with_a_null_coordinate_is_none() {
        let rows = read(Some(Column::nullable("y_px", [None, None, Some(0.2)]))).unwrap();
        assert!(rows.iter().all(|row| row.place.is_none()), "{rows:?}");
    }

    #[test]
    fn a_declaration_defines_the_columns() {
        let [_, turn, _, place, _] = <[FieldDeclaration; 5]>::try_from(Turn::declarations()).unwrap();
        assert_eq!(
            (turn.names, turn.meaning),
            (vec!["w", "x", "y", "z"], "a turn, of four columns".to_owned())
        );
        assert_eq!((place.column_type, place.is_nullable), (ColumnType::Float64, true));
    }
}
