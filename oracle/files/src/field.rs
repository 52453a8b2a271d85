//! What a field of a row is in a table: a cell, or several of a kind that stand together.

use contract::{Angle, Direction, Icrs, PixelPoint, Rotation};
use hifitime::{Duration, Epoch};
use nalgebra::Vector3;

use super::parquet_table::Columns;
use super::table_column::{Cell, Cells, Column, ColumnType, ColumnValues, Nanoseconds, TextCells};
use super::{FileError, unit};

/// What a cell holds, as long as `'a` lives.
pub(crate) trait Atom<'a>: Copy + Default {
    /// Type of its column.
    const TYPE: ColumnType;
    /// What the cell of a CSV must be.
    const EXPECTED: &'static str;
    /// The cells of a column.
    type Cells: 'a;
    /// The values of a column.
    fn values(cells: impl Iterator<Item = Option<Self>>) -> ColumnValues;
    /// The column of a name.
    fn cells(columns: &'a Columns<'_>, name: &str) -> Result<&'a Self::Cells, FileError>;
    /// The cell of a row; `None` if it is null.
    fn get(cells: &'a Self::Cells, row: usize) -> Option<Self>;
    /// As it stands in a CSV and in messages: of a number the shortest text that reads back to the same bits.
    fn text(self) -> String;
    /// Reads the cell of a CSV; `None` when it is not as [`Atom::EXPECTED`].
    fn parse(text: &'a str) -> Option<Self>;
}

impl<'a, T: Cell + 'a> Atom<'a> for T {
    const TYPE: ColumnType = <T as Cell>::TYPE;
    const EXPECTED: &'static str = <T as Cell>::EXPECTED;
    type Cells = Cells<T>;

    fn values(cells: impl Iterator<Item = Option<Self>>) -> ColumnValues {
        <T as Cell>::values(cells.collect())
    }

    fn cells(columns: &'a Columns<'_>, name: &str) -> Result<&'a Cells<T>, FileError> {
        columns.cells(name)
    }

    fn get(cells: &'a Cells<T>, row: usize) -> Option<Self> {
        cells.get(row)
    }

    fn text(self) -> String {
        format!("{self:?}")
    }

    fn parse(text: &'a str) -> Option<Self> {
        text.trim().parse().ok().filter(T::is_sound)
    }
}

impl<'a> Atom<'a> for &'a str {
    const TYPE: ColumnType = ColumnType::Utf8;
    const EXPECTED: &'static str = "text";
    type Cells = TextCells;

    fn values(cells: impl Iterator<Item = Option<Self>>) -> ColumnValues {
        Column::nullable_texts("", cells).into_values()
    }

    fn cells(columns: &'a Columns<'_>, name: &str) -> Result<&'a TextCells, FileError> {
        columns.texts(name)
    }

    fn get(cells: &'a TextCells, row: usize) -> Option<Self> {
        cells.get(row)
    }

    fn text(self) -> String {
        self.to_owned()
    }

    fn parse(text: &'a str) -> Option<Self> {
        Some(text)
    }
}

/// A value that takes `N` cells of a kind.
pub(crate) trait Value<const N: usize>: Sized {
    /// What each of them holds.
    type Cell<'a>: Atom<'a>;
    /// The cells.
    fn to_cells(&self) -> [Self::Cell<'_>; N];
    /// The value of its cells, or what was expected of them.
    fn of_cells(cells: [Self::Cell<'_>; N]) -> Result<Self, String>;
}

/// A field of a row: a value, or one that may be absent; then its cells are empty, or null.
pub(crate) trait Field<const N: usize>: Sized {
    /// The value.
    type Value: Value<N>;
    /// Whether it may be absent.
    const IS_NULLABLE: bool;
    /// The value, if there is one.
    fn value(&self) -> Option<&Self::Value>;
    /// The field that has the value; `None` where it must have one.
    fn of(value: Option<Self::Value>) -> Option<Self>;
}

impl<V: Value<N>, const N: usize> Field<N> for V {
    type Value = V;
    const IS_NULLABLE: bool = false;

    fn value(&self) -> Option<&V> {
        Some(self)
    }

    fn of(value: Option<V>) -> Option<Self> {
        value
    }
}

impl<V: Value<N>, const N: usize> Field<N> for Option<V> {
    type Value = V;
    const IS_NULLABLE: bool = true;

    fn value(&self) -> Option<&V> {
        self.as_ref()
    }

    fn of(value: Self) -> Option<Self> {
        Some(value)
    }
}

/// Types that are what a cell holds.
macro_rules! plain {
    ($($type:ty),+) => {$(
        impl Value<1> for $type {
            type Cell<'a> = Self;

            fn to_cells(&self) -> [Self; 1] {
                [*self]
            }

            fn of_cells([cell]: [Self; 1]) -> Result<Self, String> {
                Ok(cell)
            }
        }
    )+};
}

plain!(bool, u32, u64, f64);

/// Types with a word for each of their values: `code`, and `parse`, which reads it.
macro_rules! words {
    ($($type:ty),+) => {$(
        impl $crate::field::Value<1> for $type {
            type Cell<'a> = &'a str;

            fn to_cells(&self) -> [&str; 1] {
                [self.code()]
            }

            fn of_cells([word]: [&str; 1]) -> Result<Self, String> {
                <$type>::parse(word).ok_or_else(|| "one of the words of this column".to_owned())
            }
        }
    )+};
}

pub(super) use words;

impl Value<1> for String {
    type Cell<'a> = &'a str;

    fn to_cells(&self) -> [&str; 1] {
        [self]
    }

    fn of_cells([text]: [&str; 1]) -> Result<Self, String> {
        Ok(text.to_owned())
    }
}

/// A place in a list, of at most 32 bits.
impl Value<1> for usize {
    type Cell<'a> = u32;

    fn to_cells(&self) -> [u32; 1] {
        [*self as u32]
    }

    fn of_cells([index]: [u32; 1]) -> Result<Self, String> {
        Ok(index as usize)
    }
}

/// UTC; leap seconds are not counted.
impl Value<1> for Epoch {
    type Cell<'a> = Nanoseconds;

    fn to_cells(&self) -> [Nanoseconds; 1] {
        [Nanoseconds(self.to_unix_duration().total_nanoseconds() as i64)]
    }

    fn of_cells([Nanoseconds(since_1970)]: [Nanoseconds; 1]) -> Result<Self, String> {
        Ok(Self::from_unix_duration(Duration::from_total_nanoseconds(i128::from(since_1970))))
    }
}

impl<const N: usize> Value<N> for [f64; N] {
    type Cell<'a> = f64;

    fn to_cells(&self) -> Self {
        *self
    }

    fn of_cells(cells: Self) -> Result<Self, String> {
        Ok(cells)
    }
}

impl Value<3> for Vector3<f64> {
    type Cell<'a> = f64;

    fn to_cells(&self) -> [f64; 3] {
        (*self).into()
    }

    fn of_cells(cells: [f64; 3]) -> Result<Self, String> {
        Ok(cells.into())
    }
}

impl Value<2> for PixelPoint {
    type Cell<'a> = f64;

    fn to_cells(&self) -> [f64; 2] {
        [self.x, self.y]
    }

    fn of_cells([x, y]: [f64; 2]) -> Result<Self, String> {
        Ok(Self::new(x, y))
    }
}

/// Its quaternion, scalar first.
impl<To, From> Value<4> for Rotation<To, From> {
    type Cell<'a> = f64;

    fn to_cells(&self) -> [f64; 4] {
        self.wxyz()
    }

    fn of_cells(wxyz: [f64; 4]) -> Result<Self, String> {
        Self::from_wxyz(wxyz).map_err(|error| format!("a unit quaternion: {error}"))
    }
}

/// Components of its unit vector.
impl<F> Value<3> for Direction<F> {
    type Cell<'a> = f64;

    fn to_cells(&self) -> [f64; 3] {
        (*self.vector()).into()
    }

    fn of_cells(xyz: [f64; 3]) -> Result<Self, String> {
        unit::direction(xyz).ok_or_else(|| unit::EXPECTED.to_owned())
    }
}

/// Right ascension and declination, degrees.
impl Value<2> for Direction<Icrs> {
    type Cell<'a> = f64;

    fn to_cells(&self) -> [f64; 2] {
        [self.ra().degrees(), self.dec().degrees()]
    }

    fn of_cells(cells: [f64; 2]) -> Result<Self, String> {
        let [ra, dec] = cells.map(Angle::from_degrees);
        Ok(Self::from_ra_dec(ra, dec))
    }
}
