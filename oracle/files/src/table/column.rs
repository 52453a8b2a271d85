//! Columns of a flat table in memory: a name, a type, and a vector of values.

use std::fmt;
use std::num::ParseIntError;
use std::str::FromStr;

/// Type of a column. Displayed as its name in Arrow, as used in error messages and documentation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ColumnType {
    /// Boolean values.
    Boolean,
    /// 32-bit counts.
    UInt32,
    /// 64-bit counts.
    UInt64,
    /// 32-bit floating-point numbers.
    Float32,
    /// 64-bit floating-point numbers.
    Float64,
    /// Times, see [`Nanoseconds`].
    Timestamp,
    /// Texts, UTF-8.
    Utf8,
}

impl fmt::Display for ColumnType {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Boolean => "Boolean",
            Self::UInt32 => "UInt32",
            Self::UInt64 => "UInt64",
            Self::Float32 => "Float32",
            Self::Float64 => "Float64",
            Self::Timestamp => "Timestamp(ns, \"UTC\")",
            Self::Utf8 => "Utf8",
        })
    }
}

/// Time of a row: nanoseconds since 1970-01-01 without leap seconds, as every reader of Parquet and Arrow
/// expects of a UTC timestamp.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Nanoseconds(pub i64);

impl FromStr for Nanoseconds {
    type Err = ParseIntError;

    fn from_str(text: &str) -> Result<Self, ParseIntError> {
        text.parse().map(Self)
    }
}

/// Values of a column, one per row.
#[derive(Debug, Clone, PartialEq)]
pub enum ColumnValues {
    /// Boolean values.
    Boolean(Cells<bool>),
    /// 32-bit counts.
    UInt32(Cells<u32>),
    /// 64-bit counts.
    UInt64(Cells<u64>),
    /// 32-bit floating-point numbers.
    Float32(Cells<f32>),
    /// 64-bit floating-point numbers.
    Float64(Cells<f64>),
    /// Times.
    Timestamp(Cells<Nanoseconds>),
    /// Texts.
    Utf8(TextCells),
}

impl ColumnValues {
    /// Returns the type of the column.
    pub fn column_type(&self) -> ColumnType {
        match self {
            Self::Boolean(_) => ColumnType::Boolean,
            Self::UInt32(_) => ColumnType::UInt32,
            Self::UInt64(_) => ColumnType::UInt64,
            Self::Float32(_) => ColumnType::Float32,
            Self::Float64(_) => ColumnType::Float64,
            Self::Timestamp(_) => ColumnType::Timestamp,
            Self::Utf8(_) => ColumnType::Utf8,
        }
    }

    /// Returns the number of rows.
    pub fn len(&self) -> usize {
        match self {
            Self::Boolean(cells) => cells.len(),
            Self::UInt32(cells) => cells.len(),
            Self::UInt64(cells) => cells.len(),
            Self::Float32(cells) => cells.len(),
            Self::Float64(cells) => cells.len(),
            Self::Timestamp(cells) => cells.len(),
            Self::Utf8(cells) => cells.len(),
        }
    }

    /// Returns true if there are no rows.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Creates an empty column of a type.
    pub fn empty(column_type: ColumnType) -> Self {
        match column_type {
            ColumnType::Boolean => Self::Boolean(Cells::default()),
            ColumnType::UInt32 => Self::UInt32(Cells::default()),
            ColumnType::UInt64 => Self::UInt64(Cells::default()),
            ColumnType::Float32 => Self::Float32(Cells::default()),
            ColumnType::Float64 => Self::Float64(Cells::default()),
            ColumnType::Timestamp => Self::Timestamp(Cells::default()),
            ColumnType::Utf8 => Self::Utf8(TextCells::default()),
        }
    }

    /// Returns the row of the first null.
    pub(crate) fn first_null(&self) -> Option<usize> {
        let is_valid = match self {
            Self::Boolean(cells) => cells.is_valid.as_ref(),
            Self::UInt32(cells) => cells.is_valid.as_ref(),
            Self::UInt64(cells) => cells.is_valid.as_ref(),
            Self::Float32(cells) => cells.is_valid.as_ref(),
            Self::Float64(cells) => cells.is_valid.as_ref(),
            Self::Timestamp(cells) => cells.is_valid.as_ref(),
            Self::Utf8(cells) => cells.is_valid.as_ref(),
        };
        is_valid?.iter().position(|is_valid| !is_valid)
    }
}

impl ColumnValues {
    /// Returns the row of the first number that is not finite.
    pub(crate) fn first_unsound(&self) -> Option<usize> {
        match self {
            Self::Float32(cells) => {
                cells.iter().position(|cell| cell.is_some_and(|number| !number.is_sound()))
            }
            Self::Float64(cells) => {
                cells.iter().position(|cell| cell.is_some_and(|number| !number.is_sound()))
            }
            _ => None,
        }
    }
}

/// A value of fixed size that a column may contain.
pub trait Cell: Copy + Default + fmt::Debug + FromStr {
    /// Type of the column.
    const TYPE: ColumnType;
    /// Description of a valid CSV cell, for messages.
    const EXPECTED: &'static str;
    /// Returns true if a table may contain the value: NaN and infinity are not allowed.
    fn is_sound(&self) -> bool {
        true
    }
    /// Converts cells to the values of a column.
    fn values(cells: Cells<Self>) -> ColumnValues;
    /// Returns the cells if the column has this type.
    fn cells(values: &ColumnValues) -> Option<&Cells<Self>>;
}

macro_rules! cell {
    ($value:ty, $variant:ident, $expected:literal $(, $is_sound:expr)?) => {
        impl Cell for $value {
            const TYPE: ColumnType = ColumnType::$variant;
            const EXPECTED: &'static str = $expected;

            $(fn is_sound(&self) -> bool {
                $is_sound(*self)
            })?

            fn values(cells: Cells<Self>) -> ColumnValues {
                ColumnValues::$variant(cells)
            }

            fn cells(values: &ColumnValues) -> Option<&Cells<Self>> {
                match values {
                    ColumnValues::$variant(cells) => Some(cells),
                    _ => None,
                }
            }
        }
    };
}

cell!(bool, Boolean, "true or false");
cell!(u32, UInt32, "an integer, 0 or greater");
cell!(u64, UInt64, "an integer, 0 or greater");
cell!(f32, Float32, "a finite number", f32::is_finite);
cell!(f64, Float64, "a finite number", f64::is_finite);
cell!(Nanoseconds, Timestamp, "nanoseconds since 1970");

/// Values of fixed size, any of which may be null.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Cells<T> {
    /// One value per row; the default value for a null.
    values: Vec<T>,
    /// Validity flags, one per row; `None` if no value is null.
    is_valid: Option<Vec<bool>>,
}

impl<T: Copy + Default> Cells<T> {
    /// Creates cells without nulls.
    pub(crate) fn new(values: Vec<T>) -> Self {
        Self { values, is_valid: None }
    }

    /// Creates cells from the values that are not null and one validity flag per row. Returns `None` if the
    /// numbers of values and flags disagree.
    pub(crate) fn spread(present: Vec<T>, is_valid: Vec<bool>) -> Option<Self> {
        if present.len() == is_valid.len() {
            return is_valid.iter().all(|&is_valid| is_valid).then(|| Self::new(present));
        }
        let mut rest = present.into_iter();
        let mut values = vec![T::default(); is_valid.len()];
        for (value, _) in values.iter_mut().zip(&is_valid).filter(|(_, is_valid)| **is_valid) {
            *value = rest.next()?;
        }
        rest.next().is_none().then_some(Self { values, is_valid: Some(is_valid) })
    }

    /// Returns the number of rows.
    pub fn len(&self) -> usize {
        self.values.len()
    }

    /// Returns true if there are no rows.
    pub fn is_empty(&self) -> bool {
        self.values.is_empty()
    }

    /// Returns the value of a row; `None` if it is null or there is no such row.
    pub fn get(&self, row: usize) -> Option<T> {
        self.values.get(row).copied().filter(|_| is_valid(self.is_valid.as_ref(), row))
    }

    /// Iterates over the values by row.
    pub fn iter(&self) -> impl Iterator<Item = Option<T>> {
        (0..self.len()).map(|row| self.get(row))
    }

    /// Returns the values by row; the default value for a null.
    pub fn values(&self) -> &[T] {
        &self.values
    }

    /// Returns the number of nulls.
    pub fn null_count(&self) -> usize {
        self.is_valid.iter().flatten().filter(|is_valid| !**is_valid).count()
    }

    /// Returns the values and their validity flags, true if not null (`None` if no value is null).
    pub fn into_parts(self) -> (Vec<T>, Option<Vec<bool>>) {
        (self.values, self.is_valid)
    }

    /// Returns the validity flags of [`Cells::into_parts`].
    pub(crate) fn is_valid(&self) -> Option<&[bool]> {
        self.is_valid.as_deref()
    }
}

impl<T: Copy + Default> FromIterator<Option<T>> for Cells<T> {
    fn from_iter<I: IntoIterator<Item = Option<T>>>(cells: I) -> Self {
        let cells = cells.into_iter();
        let (mut values, mut is_valid) = (Vec::with_capacity(cells.size_hint().0), None);
        for cell in cells {
            if cell.is_none() || is_valid.is_some() {
                is_valid.get_or_insert_with(|| vec![true; values.len()]).push(cell.is_some());
            }
            values.push(cell.unwrap_or_default());
        }
        Self { values, is_valid }
    }
}

/// Texts, any of which may be null.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct TextCells {
    /// All texts, concatenated.
    text: String,
    /// End of the text of each row, bytes; a null is empty.
    ends: Vec<usize>,
    /// Validity flags, one per row; `None` if no text is null.
    is_valid: Option<Vec<bool>>,
}

impl TextCells {
    /// Creates texts from their bytes and ends. Returns `None` if they are not UTF-8 or the numbers of texts
    /// and flags disagree.
    pub(crate) fn from_bytes(bytes: Vec<u8>, ends: Vec<usize>, is_valid: Option<Vec<bool>>) -> Option<Self> {
        let text = String::from_utf8(bytes).ok()?;
        let are_texts = ends.iter().all(|&end| text.is_char_boundary(end)) && ends.is_sorted();
        let agree = is_valid.as_ref().is_none_or(|is_valid| is_valid.len() == ends.len());
        let is_valid = is_valid.filter(|is_valid| is_valid.contains(&false));
        (are_texts && agree).then_some(Self { text, ends, is_valid })
    }

    /// Returns the number of rows.
    pub fn len(&self) -> usize {
        self.ends.len()
    }

    /// Returns true if there are no rows.
    pub fn is_empty(&self) -> bool {
        self.ends.is_empty()
    }

    /// Returns the text of a row; `None` if it is null or there is no such row.
    pub fn get(&self, row: usize) -> Option<&str> {
        self.text.get(self.bytes_of(row)?).filter(|_| is_valid(self.is_valid.as_ref(), row))
    }

    /// Returns the text of a row; empty if it is null or there is no such row.
    pub fn value(&self, row: usize) -> &str {
        self.get(row).unwrap_or_default()
    }

    /// Iterates over the texts by row.
    pub fn iter(&self) -> impl Iterator<Item = Option<&str>> {
        (0..self.len()).map(|row| self.get(row))
    }

    /// Returns all texts, concatenated.
    pub(crate) fn text(&self) -> &str {
        &self.text
    }

    /// Returns the byte range of the text of a row.
    pub(crate) fn bytes_of(&self, row: usize) -> Option<std::ops::Range<usize>> {
        let start = match row.checked_sub(1) {
            Some(before) => *self.ends.get(before)?,
            None => 0,
        };
        Some(start..*self.ends.get(row)?)
    }

    /// Returns the validity flags, one per row; `None` if no text is null.
    pub(crate) fn is_valid(&self) -> Option<&[bool]> {
        self.is_valid.as_deref()
    }

    fn push(&mut self, text: &str) {
        self.text.push_str(text);
        self.ends.push(self.text.len());
    }
}

impl<T: AsRef<str>> FromIterator<T> for TextCells {
    fn from_iter<I: IntoIterator<Item = T>>(texts: I) -> Self {
        let texts = texts.into_iter();
        let mut cells = Self { ends: Vec::with_capacity(texts.size_hint().0), ..Self::default() };
        texts.for_each(|text| cells.push(text.as_ref()));
        cells
    }
}

fn is_valid(flags: Option<&Vec<bool>>, row: usize) -> bool {
    flags.is_none_or(|flags| flags.get(row).is_some_and(|is_valid| *is_valid))
}

/// Encoding of a column in a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Coding {
    /// Dictionary, for values that repeat.
    Dictionary,
    /// One value after another.
    Plain,
    /// First bytes of all values, then second bytes, and so on (`BYTE_STREAM_SPLIT`).
    ByteByByte,
}

/// One column of a table.
#[derive(Debug, Clone, PartialEq)]
pub struct Column {
    name: String,
    is_nullable: bool,
    coding: Coding,
    values: ColumnValues,
}

impl Column {
    /// Creates a column with a value in every row.
    pub fn new<T: Cell>(name: impl Into<String>, values: impl IntoIterator<Item = T>) -> Self {
        Self::from_values(name, false, T::values(Cells::new(values.into_iter().collect())))
    }

    /// Creates a column in which values may be null.
    pub fn nullable<T: Cell>(name: impl Into<String>, values: impl IntoIterator<Item = Option<T>>) -> Self {
        Self::from_values(name, true, T::values(values.into_iter().collect()))
    }

    /// Creates a column with a text in every row.
    pub fn texts<T: AsRef<str>>(name: impl Into<String>, texts: impl IntoIterator<Item = T>) -> Self {
        Self::from_values(name, false, ColumnValues::Utf8(texts.into_iter().collect()))
    }

    /// Creates a column in which texts may be null.
    pub fn nullable_texts<T: AsRef<str>>(
        name: impl Into<String>,
        texts: impl IntoIterator<Item = Option<T>>,
    ) -> Self {
        let (mut cells, mut is_valid) = (TextCells::default(), Vec::new());
        for text in texts {
            cells.push(text.as_ref().map_or("", AsRef::as_ref));
            is_valid.push(text.is_some());
        }
        cells.is_valid = is_valid.contains(&false).then_some(is_valid);
        Self::from_values(name, true, ColumnValues::Utf8(cells))
    }

    /// Creates a column of given values, which must not contain nulls unless `is_nullable`.
    pub fn from_values(name: impl Into<String>, is_nullable: bool, values: ColumnValues) -> Self {
        Self { name: name.into(), is_nullable, coding: Coding::Dictionary, values }
    }

    /// Marks the column as having values that seldom repeat: it is written without a dictionary, which would
    /// only enlarge the file.
    pub fn without_dictionary(self) -> Self {
        Self { coding: Coding::Plain, ..self }
    }

    /// Marks the column as having numbers that differ but share bytes: it is written byte by byte, without a
    /// dictionary.
    pub fn byte_stream_split(self) -> Self {
        Self { coding: Coding::ByteByByte, ..self }
    }

    /// Returns the name, including the unit.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Returns true if values may be null.
    pub fn is_nullable(&self) -> bool {
        self.is_nullable
    }

    /// Returns the values.
    pub fn values(&self) -> &ColumnValues {
        &self.values
    }

    /// Returns the values by value, without the column.
    pub fn into_values(self) -> ColumnValues {
        self.values
    }

    pub(crate) fn coding(&self) -> Coding {
        self.coding
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_have_their_values_and_nulls() {
        let cells: Cells<u32> = [Some(7), None, Some(9)].into_iter().collect();
        assert_eq!((cells.get(0), cells.get(1), cells.get(2), cells.get(3)), (Some(7), None, Some(9), None));
        assert_eq!((cells.len(), cells.null_count(), cells.values()), (3, 1, &[7, 0, 9][..]));
        let whole: Cells<u32> = [Some(7)].into_iter().collect();
        assert_eq!(whole, Cells::new(vec![7]));
    }

    #[test]
    fn values_are_spread_over_the_rows_that_are_not_null() {
        let spread = |present: &[u32], flags: &[bool]| Cells::spread(present.to_vec(), flags.to_vec());
        let expected: Cells<u32> = [None, Some(5), None, Some(6)].into_iter().collect();
        assert_eq!(spread(&[5, 6], &[false, true, false, true]), Some(expected));
        assert_eq!(spread(&[5, 6], &[true, true]), Some(Cells::new(vec![5, 6])));
        for (present, flags) in [
            (&[5, 6][..], &[false, true][..]),
            (&[5], &[false, true, true]),
            (&[5, 6], &[false, true, false]),
        ] {
            assert_eq!(spread(present, flags), None, "{present:?} {flags:?}");
        }
    }

    #[test]
    fn texts_have_their_nulls_and_are_utf8_each() {
        let column = Column::nullable_texts("word", [Some("a"), None, Some("äöü"), Some("")]);
        let ColumnValues::Utf8(texts) = column.values() else { panic!("{column:?}") };
        let all: Vec<_> = texts.iter().collect();
        assert_eq!(all, [Some("a"), None, Some("äöü"), Some("")]);
        assert_eq!((column.values().first_null(), texts.get(4), texts.value(1)), (Some(1), None, ""));
        // "ä" split in the middle is not UTF-8, although the two halves together are.
        let bytes = "ä".as_bytes().to_vec();
        assert_eq!(TextCells::from_bytes(bytes.clone(), vec![1, 2], None), None);
        assert_eq!(TextCells::from_bytes(bytes, vec![0, 2], None).map(|texts| texts.len()), Some(2));
        assert_eq!(TextCells::from_bytes(vec![0xff], vec![1], None), None);
    }
}
