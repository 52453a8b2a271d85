//! Reading and writing of frames, tables and directories.
//!
//! Every reader accepts files from untrusted sources. It returns a [`FileError`] that names the file, the
//! location, the value and the expected value. It does not panic, and it allocates no more memory than the
//! length of the file and [`contract::Camera::MAX_SIDE_PX`] justify. Writers do not overwrite files, except
//! for [`AtomicFile::replace`], which replaces an earlier file of the same kind.

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

mod beside;
mod calibration;
mod complete;
mod csv;
mod error;
mod frame;
mod listed_images;
mod loaded_table;
mod parquet;
mod table;
pub mod toml_table;

pub use self::csv::{
    AnswerOrigin, CsvLine, CsvReader, CsvRow, CsvWriter, Lines, line_of, origin, read_column, read_csv,
    read_origins, write_csv,
};
pub use self::parquet::{
    ParquetFile, ParquetWriter, Row, TableOptions, TableReader, TableWriter, table_sha256, write_table,
};
pub use beside::{existing_file_beside, file_beside};
pub use calibration::{
    CalibrationFormat, Conversion, LensCalibration, calibration_text, parse_calibration, read_calibration,
};
pub use complete::{
    AtomicFile, Checksums, PartialFiles, ReplaceableFile, RunDirectory, create_empty_directory,
    create_numbered_directory, file_sha256, refuse_unfinished, sha256,
};
pub use error::{Failure, FileError, FileLocation, create_new, failure, open_regular};
pub use frame::{
    ExpectedImage, FrameHeader, GreyImage, ImageFormat, ImageMetadata, PixelConversion, RawImage,
    RequiredSize, Sip, SipTerm, SkyHeader, TanSip, WcsError, checked_size, fits_header, read_expected,
    read_frame, read_grey_image, read_image, read_radiance, read_sky_header, write_expected, write_frame,
    write_png_of_depth, write_radiance,
};
pub use listed_images::{locate_alone, locate_image, refuse_twice};
pub use loaded_table::{LoadedTable, read_csv_table, read_parquet_table};
pub use table::{
    Atom, Cell, Cells, Column, ColumnNames, ColumnType, ColumnValues, Columns, Field, FieldDeclaration,
    Nanoseconds, Table, TextCells, Value, format_utc, nullable, optional, parse_utc, windows,
    without_dictionary,
};
