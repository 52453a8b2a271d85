//! Truth tables: exact round trips, damage, and the schema.

use std::fs;
use std::path::{Path, PathBuf};

use boresight::far_range::rows::{FrameTruthRow, ObjectTruthRow};
use boresight::files::{
    Column, Columns, FileError, Row, TableOptions, TableReader, TableWriter, parse_utc, write_table,
};
use contract::{Angle, Direction, PixelPoint, Rotation};
use hifitime::Unit;
use nalgebra::Vector3;
use proptest::prelude::*;
use sim::truth::{FrameTruth, ObjectKind, ObjectTruth, Shadow, Visibility};
use tempfile::{TempDir, tempdir};

/// A number in [0, 1) that uses every bit of its mantissa.
fn fraction(i: u64) -> f64 {
    (i.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 11) as f64 / (1_u64 << 53) as f64
}

fn frame(i: u64) -> FrameTruth {
    let vector = |k: u64| Vector3::new(fraction(i + k) + 0.1, fraction(i + k + 1), fraction(i + k + 2));
    FrameTruth {
        frame: i,
        group: format!("day {}", 1 + i / 100),
        time: parse_utc("2012-04-23T00:00:00.123456789Z").unwrap() + Unit::Second * (15 * i as i64),
        exposure_s: fraction(i),
        body_from_icrs: Rotation::from_rotation_vector(vector(3)),
        camera_from_icrs: Rotation::from_rotation_vector(vector(7)),
        position_km: vector(11) * 7000.0,
        velocity_km_s: vector(13) * -7.5,
        line_of_sight: Direction::from_vector(vector(17)).unwrap(),
        range_km: 30.0 * fraction(i),
        sun: Direction::from_vector(vector(19)).unwrap(),
        phase_deg: 180.0 * fraction(i + 1),
        shadow: [Shadow::Sunlit, Shadow::Penumbra, Shadow::Umbra][i as usize % 3],
        sunlit_fraction: fraction(i + 2),
        background_e_per_s: 100.0 * fraction(i + 3),
        smear_e_per_px: 10.0 * fraction(i + 4),
        target_from_icrs: i.is_multiple_of(2).then(|| Rotation::from_rotation_vector(vector(23))),
        target_position: (!i.is_multiple_of(4))
            .then(|| PixelPoint::new(-fraction(i), 752.0 * fraction(i + 5))),
        target_visibility: Visibility::from_snr(10.0 * fraction(i)),
    }
}

fn object(frame: u64, i: u64) -> ObjectTruth {
    let seed = frame * 1000 + i;
    let kind = [
        ObjectKind::Target,
        ObjectKind::Star,
        ObjectKind::Planet,
        ObjectKind::Moon,
        ObjectKind::HotPixel,
        ObjectKind::CosmicRay,
    ][i as usize % 6];
    let star = !matches!(kind, ObjectKind::HotPixel | ObjectKind::CosmicRay);
    ObjectTruth {
        frame,
        kind,
        id: i as u32,
        position: PixelPoint::new(752.0 * fraction(seed), 580.0 * fraction(seed + 1)),
        astrometric: star.then(|| {
            let degrees = |scale: f64, k| Angle::from_degrees(scale * fraction(i + k));
            Direction::from_ra_dec(degrees(360.0, 0), degrees(90.0, 1))
        }),
        magnitude: star.then(|| 7.0 * fraction(i)),
        electrons: 1e5 * fraction(seed + 2),
        peak_electrons: 1e4 * fraction(seed + 3),
        snr: 100.0 * fraction(seed + 4),
        radius_px: 0.5 + fraction(seed + 5),
        bloom_px: 10.0 * fraction(seed + 7),
        cut: fraction(seed + 6),
    }
}

/// Writes a table with the rows of each frame, frame by frame.
fn write<R: Row>(frames: impl IntoIterator<Item = Vec<R>>) -> (TempDir, PathBuf) {
    let directory = tempdir().unwrap();
    let path = directory.path().join("table.parquet");
    let mut writer = TableWriter::create(&path).unwrap();
    frames.into_iter().for_each(|rows| writer.write(rows).unwrap());
    writer.finish().unwrap();
    (directory, path)
}

fn rows_of(objects: Vec<ObjectTruth>) -> Vec<ObjectTruthRow> {
    objects.into_iter().map(ObjectTruthRow).collect()
}

fn message<R: Row>(path: &Path) -> String {
    let first_error = |reader: TableReader<R>| reader.map(|frame| frame.err()).find_map(|error| error);
    let error = match TableReader::<R>::open(path) {
        Err(error) => Some(error),
        Ok(reader) => first_error(reader),
    };
    error.unwrap().to_string()
}

#[test]
fn frames_round_trip_bit_for_bit() {
    let frames: Vec<_> = (0..300).map(|i| frame(7 * i)).collect();
    let (_directory, path) = write(frames.iter().cloned().map(|frame| vec![FrameTruthRow(frame)]));
    let back: Vec<_> = TableReader::<FrameTruthRow>::open(&path)
        .unwrap()
        .flat_map(|frame| frame.unwrap().1)
        .map(|row| row.0)
        .collect();
    assert_eq!(back, frames);
}

#[test]
fn objects_round_trip_bit_for_bit_over_many_batches() {
    // More rows than two batches of the reader; every third frame has no rows.
    let objects = |frame: u64| {
        if frame.is_multiple_of(3) { vec![] } else { (0..200).map(|i| object(frame, i)).collect() }
    };
    let (_directory, path) = write((0..150).map(|frame| rows_of(objects(frame))));
    let mut reader = TableReader::<ObjectTruthRow>::open(&path).unwrap();
    for number in (0..150).filter(|number| number % 5 != 1) {
        let (back, expected) = (reader.rows_of(number).unwrap(), objects(number));
        assert_eq!(back.len(), expected.len());
        for (ObjectTruthRow(back), expected) in back.into_iter().zip(expected) {
            // A direction is converted to degrees and back: a few roundings of 360°, 1e-15 rad each.
            if let (Some(a), Some(b)) = (&back.astrometric, &expected.astrometric) {
                assert!(a.separation(b).radians() < 1e-14);
            }
            let astrometric = expected.astrometric;
            assert_eq!(back.astrometric.is_some(), astrometric.is_some());
            assert_eq!(ObjectTruth { astrometric, ..back }, expected);
        }
    }
}

#[test]
fn an_empty_table_is_a_table() {
    let (_directory, path) = write::<ObjectTruthRow>([]);
    assert_eq!(TableReader::<ObjectTruthRow>::open(&path).unwrap().count(), 0);
}

#[test]
fn a_table_is_never_overwritten() {
    let (_directory, path) = write([vec![FrameTruthRow(frame(1))]]);
    assert!(matches!(TableWriter::<FrameTruthRow>::create(&path), Err(FileError::OutputTaken { .. })));
}

#[test]
fn frames_that_go_back_are_named_by_row() {
    let (_directory, path) = write([rows_of(vec![object(4, 0), object(3, 0)])]);
    let message = message::<ObjectTruthRow>(&path);
    assert!(message.contains("row 1: `frame` is `3`, expected 4 or more"), "{message}");
}

#[test]
fn a_number_that_is_not_one_is_named_by_row() {
    let directory = tempdir().unwrap();
    let path = directory.path().join("table.parquet");
    let columns =
        ObjectTruthRow::columns(&rows_of(vec![object(1, 0), ObjectTruth { snr: f64::NAN, ..object(2, 0) }]));
    let options = TableOptions { is_checked: false, ..TableOptions::default() };
    write_table(fs::File::create_new(&path).unwrap(), &path, &columns, options).unwrap();
    let message = message::<ObjectTruthRow>(&path);
    assert!(message.contains("row 1: `snr` is `NaN`, expected a finite number"), "{message}");
}

#[test]
fn a_number_that_is_not_one_is_not_written() {
    let directory = tempdir().unwrap();
    let path = directory.path().join("table.parquet");
    let mut writer = TableWriter::create(&path).unwrap();
    let rows = rows_of(vec![object(1, 0), ObjectTruth { snr: f64::NAN, ..object(1, 1) }]);
    let written = writer.write(rows).and_then(|()| writer.finish());
    let message = written.unwrap_err().to_string();
    assert!(message.contains("column `snr` is not a finite number"), "{message}");
}

/// A table with a column of the right name and the wrong type.
struct MistypedColumn;

impl Row for MistypedColumn {
    fn columns(rows: &[Self]) -> Vec<Column> {
        vec![Column::new("frame", rows.iter().map(|_| 1.0))]
    }
    fn rows(_: &Columns<'_>) -> Result<Vec<Self>, FileError> {
        Ok(Vec::new())
    }
    fn frame(&self) -> u64 {
        1
    }
}

/// A table with only one column of the truth.
struct SingleColumn;

impl Row for SingleColumn {
    fn columns(rows: &[Self]) -> Vec<Column> {
        vec![Column::new("frame", rows.iter().map(|_| 1_u64))]
    }
    fn rows(columns: &Columns<'_>) -> Result<Vec<Self>, FileError> {
        Ok((0..columns.len()).map(|_| Self).collect())
    }
    fn frame(&self) -> u64 {
        1
    }
}

#[test]
fn a_missing_column_and_one_of_another_type_are_named() {
    let (_directory, path) = write([vec![MistypedColumn]]);
    let wrong_type = message::<FrameTruthRow>(&path);
    assert!(wrong_type.contains("`frame` is `Float64`, expected type UInt64"), "{wrong_type}");
    let (_directory, path) = write([vec![SingleColumn]]);
    let missing = message::<FrameTruthRow>(&path);
    assert!(missing.contains("column `group` is missing; found `frame`"), "{missing}");
}

#[test]
fn unrequested_columns_are_passed_over() {
    let (_directory, path) = write([rows_of(vec![object(1, 0), object(1, 1)])]);
    assert_eq!(TableReader::<SingleColumn>::open(&path).unwrap().next().unwrap().unwrap().1.len(), 2);
}

#[test]
fn a_table_that_is_cut_short_is_an_error() {
    let (_directory, path) = write([rows_of((0..500).map(|i| object(1, i)).collect())]);
    let bytes = fs::read(&path).unwrap();
    for length in [0, 3, 8, bytes.len() / 2, bytes.len() - 1] {
        fs::write(&path, &bytes[..length]).unwrap();
        assert!(message::<ObjectTruthRow>(&path).contains("not a readable Parquet file"));
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(512) })]
    #[test]
    fn no_damage_makes_it_panic(changes in prop::collection::vec((any::<usize>(), any::<u8>()), 1..8), tail: bool) {
        let (_directory, path) = write([rows_of((0..50).map(|i| object(1, i)).collect())]);
        let mut bytes = fs::read(&path).unwrap();
        for (place, value) in changes {
            // The end of the file holds its metadata, where damage has the largest effect.
            let span = if tail { 1200.min(bytes.len()) } else { bytes.len() };
            let place = bytes.len() - 1 - place % span;
            bytes[place] = value;
        }
        fs::write(&path, bytes).unwrap();
        if let Ok(reader) = TableReader::<ObjectTruthRow>::open(&path) {
            let _ = reader.count();
        }
    }
}
