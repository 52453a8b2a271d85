//! Reading and writing: frames, tables, directories.
//!
//! Every reader takes files of anybody's making. It answers with a [`FileError`] that names the file, the place,
//! the value and what was expected; it does not panic, and it allocates no more than the length of the file and
//! [`contract::Camera::MAX_SIDE_PX`] justify. No writer overwrites.

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

mod batch_columns;
mod checksums;
mod clusters;
mod column;
mod csv_table;
mod dataset;
mod declared;
mod directory;
pub mod docking;
mod error;
mod exr;
pub mod failure;
mod field;
mod field_telemetry;
mod fits;
mod fits_cards;
mod frame_file;
mod frame_header;
mod image16;
mod lines;
mod measurements;
mod origin;
mod parquet_claims;
mod parquet_file;
mod parquet_table;
mod parquet_type;
mod parquet_writer;
mod partial;
mod raw_image;
pub mod sha256;
mod stars;
mod table;
mod table_column;
mod table_digest;
mod tables;
mod telemetry;
mod thrift;
mod time;
pub mod toml_file;
mod toml_table;
mod truth;
mod unit;
mod video;
mod wcs;
mod whole_file;
mod whole_table;
mod windows;

pub use self::exr::{Expected, read_expected, read_radiance, write_expected, write_radiance};
pub use batch_columns::Columns;
pub use checksums::{Checksums, file_sha256};
pub use clusters::FrameCluster;
pub use column::read_column;
pub use dataset::{CameraFile, Dataset, DatasetFrame};
pub use declared::Declared;
pub use directory::{RunDirectory, refuse_unfinished};
pub use error::open_regular;
pub use error::{FileError, Place};
pub use failure::Failure;
pub use field_telemetry::{FieldRow, FieldTelemetryWriter, read_field_telemetry};
pub use frame_file::{ImageFormat, read_frame, write_frame};
pub use frame_header::FrameHeader;
pub use lines::Lines;
pub use measurements::{MeasurementWriter, outcome_as_filed, read_measurements};
pub use origin::{AnswerOrigin, line_of, read_origins};
pub use parquet_file::ParquetFile;
pub use parquet_table::{Row, TableReader, TableWriter};
pub use parquet_writer::{TableOptions, write_table};
pub use partial::PartialFiles;
pub use stars::{StarRow, read_stars, write_stars};
pub use table_column::{Cell, Cells, Column, ColumnType, ColumnValues, Nanoseconds, TextCells};
pub use table_digest::table_sha256;
pub use tables::{csv_tables, parquet_tables};
pub use telemetry::{TelemetryRow, TelemetryWriter, read_telemetry};
pub use time::{format_utc, parse_utc};
pub use video::{
    AviCoding, AviWriter, FieldOrder, FieldSource, FrameSize, Scan, SequenceOptions, Y4mWriter,
    read_listed_field, write_field,
};
pub use wcs::{Sip, SipTerm, TanSip, WcsError};
pub use whole_file::{Earlier, WholeFile};
pub use whole_table::{WholeTable, read_csv_table, read_parquet_table};
