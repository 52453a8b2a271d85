//! Files read and written only by their definitions: a mistake shared by the project's writer and reader
//! would otherwise remain undetected.

use std::collections::BTreeMap;
use std::fs;

use boresight::far_range::rows::{TelemetryLine, TelemetryRow, TelemetryWriter, read_telemetry};
use boresight::files::{FrameHeader, ImageFormat, parse_utc, read_frame, write_frame};
use contract::{Frame, Rotation, Telemetry};
use nalgebra::Vector3;
use tempfile::tempdir;

use crate::support::Bench;

/// Bytes in a block of a FITS file; `CARD` is the bytes in a card of its header (FITS standard 4.0, sections
/// 3.1 and 4.1).
const BLOCK: usize = 2880;
const CARD: usize = 80;

const HALF: f64 = std::f64::consts::FRAC_1_SQRT_2;

/// Telemetry with the published quaternion (docs/conventions.md), which rotates (1, 0, 0) into (0, -1, 0).
fn row() -> TelemetryRow {
    let telemetry = Telemetry {
        time: parse_utc("2012-04-25T12:00:00.25Z").unwrap(),
        exposure_s: 0.5,
        body_from_icrs: Rotation::from_axes(&Vector3::y(), &-Vector3::x(), &Vector3::z()),
        velocity_km_s: Some(Vector3::new(1.25, -2.5, 7.0)),
    };
    TelemetryRow { frame: 3, file: None, telemetry, windows: None }
}

/// v' = q v q*, in components (Hamilton, scalar first).
fn turned([w, x, y, z]: [f64; 4], [a, b, c]: [f64; 3]) -> [f64; 3] {
    [
        (w * w + x * x - y * y - z * z) * a + 2.0 * (x * y - w * z) * b + 2.0 * (x * z + w * y) * c,
        2.0 * (x * y + w * z) * a + (w * w - x * x + y * y - z * z) * b + 2.0 * (y * z - w * x) * c,
        2.0 * (x * z - w * y) * a + 2.0 * (y * z + w * x) * b + (w * w - x * x - y * y + z * z) * c,
    ]
}

#[test]
fn the_telemetry_table_defines_the_measured_frames() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("telemetry.csv");
    let mut writer = TelemetryWriter::create(&path).unwrap();
    writer.line(&TelemetryLine::from(&row())).unwrap();
    writer.finish().unwrap();
    let text = fs::read_to_string(&path).unwrap();
    let lines: Vec<Vec<&str>> = text.lines().map(|line| line.split(',').collect()).collect();
    let cells: BTreeMap<&str, &str> = lines[0].iter().copied().zip(lines[1].iter().copied()).collect();
    let number = |name: &str| cells[name].parse::<f64>().unwrap();
    assert!(cells["time_utc"].starts_with("2012-04-25T12:00:00.25"), "{text}");
    assert_eq!((number("frame"), number("exposure_s")), (3.0, 0.5));
    let velocity = ["x", "y", "z"].map(|axis| number(&format!("v_orbital_j2000_{axis}_km_s")));
    assert_eq!(velocity, [1.25, -2.5, 7.0]);
    let quaternion = ["w", "x", "y", "z"].map(|part| number(&format!("q_sc_j2000_{part}")));
    let seen = turned(quaternion, [1.0, 0.0, 0.0]);
    // Rounding of a product of three numbers of order one.
    assert!(seen.iter().zip([0.0, -1.0, 0.0]).all(|(a, b)| (a - b).abs() < 1e-15), "{seen:?}: {text}");
}

#[test]
fn a_table_of_telemetry_written_by_hand_is_read_as_it_is_meant() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("telemetry.csv");
    let names = "frame,file,time_utc,exposure_s,q_sc_j2000_w,q_sc_j2000_x,q_sc_j2000_y,q_sc_j2000_z,\
                 v_orbital_j2000_x_km_s,v_orbital_j2000_y_km_s,v_orbital_j2000_z_km_s";
    let cells = format!("3,,2012-04-25T12:00:00.25Z,0.5,{HALF},0,0,-{HALF},1.25,-2.5,7");
    fs::write(&path, format!("{names}\n{cells}\n")).unwrap();
    let read = read_telemetry(&path).unwrap();
    let telemetry = read[0].telemetry;
    assert_eq!(telemetry.velocity_km_s, Some(Vector3::new(1.25, -2.5, 7.0)));
    assert_eq!((telemetry.time, telemetry.exposure_s), (row().telemetry.time, 0.5));
    assert!((telemetry.body_from_icrs.rotate(&Vector3::x()) + Vector3::y()).norm() < 1e-15);
}

fn image() -> Frame {
    let dn = (0..7 * 5).map(|i| i * 1000).collect();
    Frame::new(3, 7, 5, 16, dn, None).unwrap()
}

fn header() -> FrameHeader {
    FrameHeader {
        time: row().telemetry.time,
        exposure_s: 0.5,
        gain_e_per_dn: None,
        seed: 1,
        version: "0.1.0".to_owned(),
        configuration_hash: String::new(),
        observer_velocity_km_s: None,
        wcs: None,
    }
}

#[test]
fn the_first_pixels_of_a_fits_file_are_those_of_the_first_row() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("frame.fits");
    write_frame(&path, ImageFormat::Fits, &image(), &header()).unwrap();
    let bytes = fs::read(&path).unwrap();
    let end = bytes.chunks(CARD).position(|card| card.starts_with(b"END ")).unwrap();
    let start = ((end + 1) * CARD).next_multiple_of(BLOCK);
    let samples = bytes[start..].chunks_exact(2).take(7 * 5);
    // BITPIX 16 with BZERO 32768: big-endian, signed, with 32768 subtracted.
    let dn: Vec<u16> =
        samples.map(|b| (i32::from(i16::from_be_bytes([b[0], b[1]])) + 32768) as u16).collect();
    assert_eq!(dn, image().dn());
}

#[test]
fn a_fits_file_written_by_hand_is_read_from_its_first_row_on() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("frame.fits");
    let cards = [
        "SIMPLE  =                    T",
        "BITPIX  =                    8",
        "NAXIS   =                    2",
        "NAXIS1  =                    3",
        "NAXIS2  =                    2",
        "END",
    ];
    let mut bytes: Vec<u8> = cards.iter().flat_map(|card| format!("{card:<CARD$}").into_bytes()).collect();
    bytes.resize(BLOCK, b' ');
    bytes.extend([1, 2, 3, 4, 5, 6]);
    bytes.resize(2 * BLOCK, 0);
    fs::write(&path, bytes).unwrap();
    let read = read_frame(&path, 0, 8, None).unwrap();
    assert_eq!((read.columns(), read.rows(), read.dn()), (3, 2, [1, 2, 3, 4, 5, 6].as_slice()));
}

/// Fifty fields per second, the first at the start and the even rows first (CCIR): time and rows follow from
/// the number.
#[test]
fn a_field_of_docking_has_its_own_time_and_rows() {
    let bench = Bench::new();
    bench.boresight("render docking --frames 24000..24004 --out set").done();
    let rows = bench.csv("set/telemetry.csv");
    assert_eq!(rows.len(), 4);
    for row in rows {
        let field: u32 = row["field"].parse().unwrap();
        assert_eq!(row["time_s"].parse::<f64>().unwrap(), f64::from(field) / 50.0);
        assert_eq!(row["lines"], if field.is_multiple_of(2) { "even" } else { "odd" });
    }
}
