//! Checks of the sizes that a Parquet file claims against its length, before the crate `parquet` uses them.
//!
//! The crate allocates as much as a header claims: a schema of 2^31 children, a page of 2 GB, a list of 2^60
//! lengths. Most such claims would cause an error later, but some would end the process, because a failed
//! allocation is not a panic. This module therefore reads the headers first, with [`Compact`], which
//! allocates nothing.

use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::path::Path;

use parquet::file::metadata::{ColumnChunkMetaData, ParquetMetaData, RowGroupMetaData};

use super::thrift::{Compact, FieldHead, kind};
use crate::FileError;

/// Largest number of bytes that Snappy unpacks from one byte: a copy of 64 bytes takes three bytes.
const MAX_FROM_ONE_BYTE: u64 = 22;
/// Largest number of rows per byte of a file. Every Boresight table has an ascending column, which needs more
/// bytes per row.
const MAX_ROWS_A_BYTE: u64 = 64;
/// Number of bytes in which a page header is searched, in the first and the last attempt: texts in its
/// statistics may make it long.
const HEADER_BYTES: [u64; 2] = [512, 1 << 16];
/// Encodings whose decoders allocate the sizes that the data themselves claim: DELTA_LENGTH_BYTE_ARRAY and
/// DELTA_BYTE_ARRAY.
const BELIEVING: [i64; 2] = [6, 7];
/// Last bytes of a Parquet file.
const MAGIC: [u8; 4] = *b"PAR1";

/// Checks that the schema in the footer is flat: a root with as many children as there are columns. A file
/// that is not Parquet is left to the crate, which rejects it.
pub(crate) fn check_footer(path: &Path, file: &mut File, length: u64) -> Result<(), FileError> {
    let io = |source| FileError::io(path, "read", source);
    let Some(tail) = length.checked_sub(8) else { return Ok(()) };
    file.seek(SeekFrom::Start(tail)).map_err(io)?;
    let (mut size, mut magic) = ([0; 4], [0; 4]);
    file.read_exact(&mut size).and_then(|()| file.read_exact(&mut magic)).map_err(io)?;
    let size = u64::from(u32::from_le_bytes(size));
    let Some(start) = tail.checked_sub(size).filter(|_| magic == MAGIC) else { return Ok(()) };
    file.seek(SeekFrom::Start(start)).map_err(io)?;
    let mut footer = Vec::new();
    file.by_ref().take(size).read_to_end(&mut footer).map_err(io)?;
    match is_flat(Compact(&footer)) {
        Some(true) => Ok(()),
        Some(false) => {
            Err(FileError::format(path, "Parquet", "its columns are nested; tables of Boresight are flat"))
        }
        None => Err(FileError::format(path, "Parquet", "its footer is damaged")),
    }
}

/// Returns true if the schema of a `FileMetaData` has one level below its root; `None` if it cannot be read.
fn is_flat(mut footer: Compact<'_>) -> Option<bool> {
    let mut flat = None;
    let mut before = 0;
    while let Some(field) = footer.field(before)? {
        match field {
            FieldHead { id: 2, kind: kind::LIST } => {
                let (element, size) = footer.list()?;
                if element != kind::STRUCT {
                    return None;
                }
                let mut children = (0..size).map(|_| children(&mut footer));
                let root = children.next()??;
                let leaves = i64::try_from(size).ok()?.checked_sub(1)?;
                // All elements are read, so that the reader ends behind the list.
                let nested = children.try_fold(false, |nested, count| Some(nested | (count? != 0)))?;
                flat = Some(root == leaves && !nested);
            }
            FieldHead { kind, .. } => footer.skip(kind)?,
        }
        before = field.id;
    }
    flat
}

/// Reads the number of children of a `SchemaElement`.
fn children(footer: &mut Compact<'_>) -> Option<i64> {
    let (mut children, mut before) = (0, 0);
    while let Some(field) = footer.field(before)? {
        match field {
            FieldHead { id: 5, kind: kind::I32 } => children = footer.integer()?,
            FieldHead { kind, .. } => footer.skip(kind)?,
        }
        before = field.id;
    }
    Some(children)
}

/// Checks the number of rows, that every column lies inside the file, and that its pages do not exceed their
/// largest possible size.
pub(crate) fn check_claims(
    path: &Path,
    file: &mut File,
    length: u64,
    metadata: &ParquetMetaData,
) -> Result<(), FileError> {
    let rows = metadata.row_groups().iter().map(|group| u64::try_from(group.num_rows()).ok());
    let rows = rows.chain([u64::try_from(metadata.file_metadata().num_rows()).ok()]);
    let most = length.saturating_mul(MAX_ROWS_A_BYTE);
    if rows.map(|rows| rows.filter(|&rows| rows <= most)).any(|rows| rows.is_none()) {
        let reason = format!("it states more rows than a file of {length} bytes can contain");
        return Err(FileError::format(path, "Parquet", reason));
    }
    for column in metadata.row_groups().iter().flat_map(RowGroupMetaData::columns) {
        let Some((start, end)) = extent(column).filter(|(_, end)| *end <= length) else {
            return Err(FileError::format(path, "Parquet", "a column lies outside the file"));
        };
        check_pages(path, file, start, end)?;
    }
    Ok(())
}

/// Returns the position of a column's first byte and the position after its last byte.
fn extent(column: &ColumnChunkMetaData) -> Option<(u64, u64)> {
    let start = u64::try_from(column.dictionary_page_offset().unwrap_or(column.data_page_offset())).ok()?;
    let size = u64::try_from(column.compressed_size()).ok()?;
    Some((start, start.checked_add(size)?))
}

fn check_pages(path: &Path, file: &mut File, mut at: u64, end: u64) -> Result<(), FileError> {
    let wrong = |at: u64, reason: &str| {
        Err(FileError::format(path, "Parquet", format!("the page at byte {at} {reason}")))
    };
    let mut bytes = Vec::new();
    while at < end {
        let left = end.saturating_sub(at);
        let mut found = None;
        for most in HEADER_BYTES {
            bytes.clear();
            file.seek(SeekFrom::Start(at))
                .and_then(|_| file.by_ref().take(most.min(left)).read_to_end(&mut bytes))
                .map_err(|source| FileError::io(path, "read", source))?;
            found = page(Compact(&bytes));
            if found.is_some() || most >= left {
                break;
            }
        }
        let Some(Page { header_bytes, packed, unpacked, dictionary_values, believes }) = found else {
            return wrong(at, "has a damaged header");
        };
        if believes {
            return wrong(at, "has an unsupported encoding (DELTA_BYTE_ARRAY, DELTA_LENGTH_BYTE_ARRAY)");
        }
        if unpacked > packed.saturating_mul(MAX_FROM_ONE_BYTE).saturating_add(64) {
            return wrong(at, &format!("states {unpacked} bytes, compressed to {packed}"));
        }
        // Each value takes at least one byte, and the crate allocates memory for all of them.
        if dictionary_values > unpacked {
            return wrong(at, &format!("states {dictionary_values} values in {unpacked} bytes"));
        }
        let size = header_bytes.saturating_add(packed);
        if size > left {
            return wrong(at, "extends beyond its column");
        }
        at = at.saturating_add(size);
    }
    Ok(())
}

/// Data of a page header.
#[derive(Debug, PartialEq)]
struct Page {
    header_bytes: u64,
    packed: u64,
    unpacked: u64,
    /// Number of values in a dictionary; 0 for other pages.
    dictionary_values: u64,
    /// True if the encoding of the page is in [`BELIEVING`].
    believes: bool,
}

/// Reads a `PageHeader`.
fn page(mut header: Compact<'_>) -> Option<Page> {
    let whole = header.0.len();
    let (mut packed, mut unpacked, mut dictionary_values, mut believes) = (None, None, 0, false);
    let mut before = 0;
    while let Some(field) = header.field(before)? {
        match field {
            FieldHead { id: 2, kind: kind::I32 } => unpacked = Some(header.integer()?),
            FieldHead { id: 3, kind: kind::I32 } => packed = Some(header.integer()?),
            // Inner headers of data pages, dictionaries, and data pages of version 2.
            FieldHead { id: 5, kind: kind::STRUCT } => believes |= values(&mut header, 2)?.believes,
            FieldHead { id: 7, kind: kind::STRUCT } => {
                let inner = values(&mut header, 2)?;
                dictionary_values = u64::try_from(inner.count).ok()?;
                believes |= inner.believes;
            }
            FieldHead { id: 8, kind: kind::STRUCT } => believes |= values(&mut header, 4)?.believes,
            FieldHead { kind, .. } => header.skip(kind)?,
        }
        before = field.id;
    }
    let header_bytes = u64::try_from(whole.checked_sub(header.0.len())?).ok()?;
    let size = |claim: Option<i64>| u64::try_from(claim?).ok();
    let (packed, unpacked) = (size(packed)?, size(unpacked)?);
    Some(Page { header_bytes, packed, unpacked, dictionary_values, believes })
}

/// Data of the inner header of a page about its values.
struct PageValues {
    count: i64,
    /// True if the encoding of the values is in [`BELIEVING`].
    believes: bool,
}

/// Reads the inner header of a page: field 1 is the number of values, field `encoding` their encoding.
fn values(header: &mut Compact<'_>, encoding: i64) -> Option<PageValues> {
    let mut values = PageValues { count: 0, believes: false };
    let mut before = 0;
    while let Some(field) = header.field(before)? {
        match field {
            FieldHead { id: 1, kind: kind::I32 } => values.count = header.integer()?,
            FieldHead { id, kind: kind::I32 } if id == encoding => {
                values.believes = BELIEVING.contains(&header.integer()?);
            }
            FieldHead { kind, .. } => header.skip(kind)?,
        }
        before = field.id;
    }
    Some(values)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_header_of_a_page_is_read_to_its_end() {
        // {1: DATA_PAGE, 2: 150, 3: 100, 5: {1: 7, 2: PLAIN, 3: RLE, 4: RLE}}, followed by data.
        let header =
            [0x15, 0, 0x15, 0xac, 2, 0x15, 0xc8, 1, 0x2c, 0x15, 14, 0x15, 0, 0x15, 6, 0x15, 6, 0, 0, 9, 9];
        let expected =
            Page { header_bytes: 19, packed: 100, unpacked: 150, dictionary_values: 0, believes: false };
        assert_eq!(page(Compact(&header)), Some(expected));
        let mut delta = header;
        delta[12] = 14;
        assert!(page(Compact(&delta)).is_some_and(|page| page.believes));
        assert_eq!(page(Compact(&header[..18])), None);
    }

    #[test]
    fn a_dictionary_header_states_its_number_of_values() {
        // {1: DICTIONARY_PAGE, 2: 150, 3: 100, 7: {1: 2^31 - 1, 2: PLAIN}}.
        let header = [
            &[0x15, 4, 0x15, 0xac, 2, 0x15, 0xc8, 1, 0x4c, 0x15][..],
            &[0xfe, 0xff, 0xff, 0xff, 0x0f],
            &[0x15, 0, 0, 0],
        ]
        .concat();
        let page = page(Compact(&header)).unwrap();
        assert_eq!((page.dictionary_values, page.unpacked, page.believes), (i32::MAX as u64, 150, false));
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("pages");
        let bytes = [header, vec![0; 100]].concat();
        std::fs::write(&path, &bytes).unwrap();
        let mut file = File::open(&path).unwrap();
        let message = check_pages(&path, &mut file, 0, bytes.len() as u64).unwrap_err().to_string();
        assert!(message.contains("the page at byte 0 states 2147483647 values in 150 bytes"), "{message}");
    }

    #[test]
    fn only_a_flat_schema_is_flat() {
        // {2: [{4: "r", 5: children}, {4: "x"}, {4: "y", 5: nested}]}
        let footer = |children: u8, nested: u8| {
            let root = [0x48, 1, b'r', 0x15, 2 * children, 0];
            let leaves = [0x48, 1, b'x', 0, 0x48, 1, b'y', 0x15, 2 * nested, 0];
            [&[0x29, 0x3c][..], &root, &leaves, &[0]].concat()
        };
        assert_eq!(is_flat(Compact(&footer(2, 0))), Some(true));
        assert_eq!(is_flat(Compact(&footer(63, 0))), Some(false));
        assert_eq!(is_flat(Compact(&footer(2, 1))), Some(false));
        assert_eq!(is_flat(Compact(&[0x29, 0xfc, 0xff, 0xff, 0xff, 0x7f])), None);
    }
}
