//! Conversion between the fields of a row and table cells: one cell, or several adjacent cells of one type.

use std::borrow::Cow;

use contract::{Angle, Direction, Icrs, PixelPoint, Rotation};
use hifitime::Epoch;
use nalgebra::Vector3;
use sim::truth::clock;

use super::batch::Columns;
use super::column::{Cell, Cells, Column, ColumnType, ColumnValues, Nanoseconds, TextCells};
use super::unit;
use crate::FileError;

/// Content of a cell, borrowed for `'a`.
pub trait Atom<'a>: Copy + Default {
    /// Type of the column.
    const TYPE: ColumnType;
    /// Description of a valid CSV cell, for messages.
    const EXPECTED: &'static str;
    /// Cells of a column.
    type Cells: 'a;
    /// Converts cells to the values of a column.
    fn values(cells: impl Iterator<Item = Option<Self>>) -> ColumnValues;
    /// Returns the cells of the column with the given name.
    ///
    /// # Errors
    /// [`FileError`] for a column that is missing or has another type.
    fn cells(columns: &'a Columns<'_>, name: &str) -> Result<&'a Self::Cells, FileError>;
    /// Returns the cell of a row; `None` if it is null.
    fn get(cells: &'a Self::Cells, row: usize) -> Option<Self>;
    /// Returns the text in CSV files and messages: for a number the shortest text that reads back to the same
    /// bits.
    fn text(self) -> String;
    /// Parses a CSV cell; `None` if it does not match [`Atom::EXPECTED`].
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

    #[inline]
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

/// A value that takes `N` cells of one type.
pub trait Value<const N: usize>: Sized {
    /// Type of the cells.
    type Cell<'a>: Atom<'a>;
    /// Returns the cells of the value.
    fn to_cells(&self) -> [Self::Cell<'_>; N];
    /// Creates the value from its cells.
    ///
    /// # Errors
    /// Description of the expected cells.
    fn from_cells(cells: [Self::Cell<'_>; N]) -> Result<Self, String>;
}

/// A field of a row: a value, or an optional value whose cells are empty or null when it is absent.
pub trait Field<const N: usize>: Sized {
    /// Type of the value.
    type Value: Value<N>;
    /// True if the value may be absent.
    const IS_NULLABLE: bool;
    /// Returns the value, if present.
    fn value(&self) -> Option<&Self::Value>;
    /// Creates the field from its value; `None` if a required value is absent.
    fn from_value(value: Option<Self::Value>) -> Option<Self>;
}

impl<V: Value<N>, const N: usize> Field<N> for V {
    type Value = V;
    const IS_NULLABLE: bool = false;

    fn value(&self) -> Option<&V> {
        Some(self)
    }

    fn from_value(value: Option<V>) -> Option<Self> {
        value
    }
}

impl<V: Value<N>, const N: usize> Field<N> for Option<V> {
    type Value = V;
    const IS_NULLABLE: bool = true;

    fn value(&self) -> Option<&V> {
        self.as_ref()
    }

    fn from_value(value: Self) -> Option<Self> {
        Some(value)
    }
}

/// Implements the conversion of a type to and from cells: `$to` returns the cells, `$of` the value or a
/// description of the expected cells.
#[macro_export]
macro_rules! value {
    (
        $type:ty: [$cell:ty; $n:literal] $(for<$($parameter:ident),+>)?,
        |$value:ident| $to:expr, |$cells:pat_param| $of:expr
    ) => {
        impl$(<$($parameter),+>)? $crate::Value<$n> for $type {
            type Cell<'a> = $cell;

            fn to_cells(&self) -> [Self::Cell<'_>; $n] {
                let $value = self;
                $to
            }

            fn from_cells($cells: [Self::Cell<'_>; $n]) -> Result<Self, String> {
                $of
            }
        }
    };
}

/// Implements the conversion of types with a name for each value: `code` returns the name, `parse` reads it.
#[macro_export]
macro_rules! words {
    ($($type:ty),+) => {
        $($crate::value!($type: [&'a str; 1], |value| [value.code()], |[word]| {
            <$type>::parse(word).ok_or_else(|| "one of the values that this column allows".to_owned())
        });)+
    };
}

// Words of the simulator's truth.
words!(sim::truth::Shadow, sim::truth::Visibility, sim::truth::ObjectKind);

value!(bool: [bool; 1], |flag| [*flag], |[flag]| Ok(flag));
value!(u32: [u32; 1], |count| [*count], |[count]| Ok(count));
value!(u64: [u64; 1], |count| [*count], |[count]| Ok(count));
value!(f64: [f64; 1], |number| [*number], |[number]| Ok(number));
value!(String: [&'a str; 1], |text| [text], |[text]| Ok(text.to_owned()));
value!(Cow<'static, str>: [&'a str; 1], |text| [text], |[text]| Ok(text.to_owned().into()));
// An index in a list, of at most 32 bits.
value!(usize: [u32; 1], |index| [*index as u32], |[index]| Ok(index as usize));
// UTC without leap seconds.
value!(
    Epoch: [Nanoseconds; 1],
    |time| [Nanoseconds(clock::unix_ns(*time))],
    |[Nanoseconds(since_1970)]| Ok(clock::from_unix_ns(since_1970))
);
value!(Vector3<f64>: [f64; 3], |vector| (*vector).into(), |xyz| Ok(xyz.into()));
value!(PixelPoint: [f64; 2], |point| [point.x, point.y], |[x, y]| Ok(Self::new(x, y)));
// Components of the quaternion, scalar first.
value!(Rotation<To, From>: [f64; 4] for<To, From>, |rotation| rotation.wxyz(), |wxyz| {
    Self::from_wxyz(wxyz).map_err(|error| format!("a unit quaternion: {error}"))
});
// Components of the unit vector.
value!(Direction<F>: [f64; 3] for<F>, |direction| (*direction.vector()).into(), |xyz| {
    unit::direction(xyz).ok_or_else(|| unit::EXPECTED.to_owned())
});
// Right ascension and declination, degrees.
value!(
    Direction<Icrs>: [f64; 2],
    |direction| [direction.ra().degrees(), direction.dec().degrees()],
    |[ra, dec]| Ok(Self::from_ra_dec(Angle::from_degrees(ra), Angle::from_degrees(dec)))
);

impl<const N: usize> Value<N> for [f64; N] {
    type Cell<'a> = f64;

    fn to_cells(&self) -> Self {
        *self
    }

    fn from_cells(cells: Self) -> Result<Self, String> {
        Ok(cells)
    }
}
