//! Digest of a table's contents, independent of compression and row groups.

use std::path::Path;

use sha2::{Digest, Sha256};

use super::file::ParquetFile;
use crate::FileError;
use crate::complete::sha256::hex;
use crate::table::column::ColumnValues;

/// Number of rows read at a time.
const ROWS: usize = 8192;

/// Computes the SHA-256 over all columns of a Parquet table, hexadecimal: names, types and every value bit
/// for bit. Tables with identical values have identical digests.
///
/// # Errors
/// [`FileError`] for a file that cannot be read, is damaged or not in Parquet format, or has a column of a
/// type that Boresight tables do not use.
pub fn table_sha256(path: &Path) -> Result<String, FileError> {
    let file = ParquetFile::open(path)?;
    let names: Vec<String> = file.columns().iter().map(|column| column.name.clone()).collect();
    let batches = file.batches(&names, ROWS)?;
    // One digest per column, which makes the result independent of batch boundaries.
    let begun = |column: &crate::Column| {
        Sha256::new_with_prefix(format!("{} {:?}\n", column.name(), column.values().column_type()))
    };
    let mut digests: Vec<Sha256> = batches.header().iter().map(begun).collect();
    let mut bytes = Vec::new();
    for columns in batches {
        for (column, digest) in columns?.iter().zip(&mut digests) {
            bytes.clear();
            append(column.values(), &mut bytes);
            digest.update(&bytes);
        }
    }
    let mut whole = Sha256::new();
    digests.into_iter().for_each(|digest| whole.update(digest.finalize()));
    Ok(hex(whole.finalize()))
}

/// Appends every value: 0 for a null, or 1 and the bytes of the value. The bytes of a text follow their
/// number, which is 0 for a null.
fn append(values: &ColumnValues, bytes: &mut Vec<u8>) {
    fn all<const N: usize, T>(
        cells: impl Iterator<Item = Option<T>>,
        raw: impl Fn(T) -> [u8; N],
        bytes: &mut Vec<u8>,
    ) {
        for cell in cells {
            bytes.push(u8::from(cell.is_some()));
            bytes.extend(cell.map(&raw).into_iter().flatten());
        }
    }
    match values {
        ColumnValues::Boolean(cells) => all(cells.iter(), |value| [u8::from(value)], bytes),
        ColumnValues::UInt32(cells) => all(cells.iter(), u32::to_le_bytes, bytes),
        ColumnValues::UInt64(cells) => all(cells.iter(), u64::to_le_bytes, bytes),
        ColumnValues::Float32(cells) => all(cells.iter(), f32::to_le_bytes, bytes),
        ColumnValues::Float64(cells) => all(cells.iter(), f64::to_le_bytes, bytes),
        ColumnValues::Timestamp(cells) => all(cells.iter(), |value| value.0.to_le_bytes(), bytes),
        ColumnValues::Utf8(cells) => {
            for text in cells.iter() {
                bytes.push(u8::from(text.is_some()));
                let text = text.unwrap_or_default();
                bytes.extend((text.len() as u64).to_le_bytes());
                bytes.extend(text.as_bytes());
            }
        }
    }
}
