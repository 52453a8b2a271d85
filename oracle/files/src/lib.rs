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

mod all_tables;
mod complete;
mod csv;
mod dataset;
pub mod docking;
mod error;
mod far_range;
mod frame;
mod parquet;
mod table;
mod toml_table;
mod video;

pub use self::csv::{
    AnswerOrigin, CsvLine, CsvReader, CsvRow, CsvWriter, Lines, line_of, read_column, read_csv, read_origins,
    write_csv,
};
pub use self::parquet::{
    ParquetFile, ParquetWriter, Row, TableOptions, TableReader, TableWriter, table_sha256, write_table,
};
pub use all_tables::{LoadedTable, csv_tables, parquet_tables, read_csv_table, read_parquet_table};
pub use complete::{
    AtomicFile, Checksums, PartialFiles, ReplaceableFile, RunDirectory, file_sha256, refuse_unfinished,
    sha256,
};
pub use dataset::{CameraFile, Dataset, DatasetFrame};
pub use docking::{FieldRow, FieldTelemetryWriter, read_field_telemetry};
pub use error::{Failure, FileError, FileLocation, failure, open_regular};
pub use far_range::{
    FrameCluster, MeasurementWriter, StarRow, TelemetryRow, TelemetryWriter, outcome_as_filed,
    read_measurements, read_stars, read_telemetry, write_manoeuvres, write_stars,
};
pub use frame::{
    ExpectedImage, FrameHeader, ImageFormat, Sip, SipTerm, TanSip, WcsError, read_expected, read_frame,
    read_radiance, write_expected, write_frame, write_radiance,
};
pub use table::{
    Atom, Cell, Cells, Column, ColumnNames, ColumnType, ColumnValues, Columns, Field, FieldDeclaration,
    Nanoseconds, Table, TextCells, Value, format_utc, nullable, optional, parse_utc, without_dictionary,
};
pub use video::{
    AviCoding, AviWriter, FieldOrder, FieldSource, FrameSize, Scan, SequenceOptions, Y4mWriter,
    read_listed_field, write_field,
};
