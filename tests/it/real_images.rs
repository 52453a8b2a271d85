//! Images as an external user has them: TIFF, PNG and FITS from other software, a minimal camera file, a
//! telemetry table with its own column order, no star list.
//!
//! The images are simulated, to have a known content, but none of their files is written by Boresight.

use std::io::Cursor;

use image::{ImageBuffer, Luma};
use nalgebra::Vector3;

use crate::support::{Bench, check_same_files};

type Grey16 = ImageBuffer<Luma<u16>, Vec<u16>>;

/// Content of the external camera.toml: only keys without a default.
const CAMERA: &str = "[camera]
columns = 752
rows = 580
focal_length_mm = 20.187
pixel_width_um = 8.6
pixel_height_um = 8.3
principal_x_px = 395.0
principal_y_px = 288.0

[mounting]
phi_deg = -90.0
theta_deg = 0.0
psi_deg = 0.0
";

/// An external image file: the extension of its name, and its bytes.
type Encode = fn(&Grey16) -> (&'static str, Vec<u8>);

/// Writes a dataset `real` with eight images in the directory `night 1`, made by `encode` from 12-bit values,
/// and their truth in `set`.
fn dataset(bit_depth: u8, encode: impl Fn(u64, &Grey16) -> (&'static str, Vec<u8>)) -> Bench {
    let bench = Bench::new();
    bench.scenario("mine.toml", "starting-point", |scenario| {
        scenario["camera"]["radial"] = vec![0.0, 0.0, 0.0].into();
        // Long exposures, for the stars; and too few frames to learn the hot pixels.
        scenario["shutter"] = toml::Table::from_iter([
            ("mode".to_owned(), "fixed".into()),
            ("exposure_s".to_owned(), 0.25.into()),
        ])
        .into();
        scenario["sensor"]["hot_pixels"]["count"] = 0.into();
    });
    bench.boresight("render mine.toml --frames 100..108 --format png --out set").done();

    bench.write("real/camera.toml", format!("bit_depth = {bit_depth}\n{CAMERA}"));
    let mut table =
        "time_utc,file,q_sc_j2000_x,q_sc_j2000_y,q_sc_j2000_z,q_sc_j2000_w,frame,exposure_s\n".to_owned();
    for row in bench.csv("set/telemetry.csv") {
        let image = image::open(bench.path("set").join(&row["file"])).unwrap().into_luma16();
        let (extension, bytes) = encode(row["frame"].parse().unwrap(), &image);
        let file = format!("night 1/shot-{}.{extension}", row["frame"]);
        bench.write(&format!("real/{file}"), bytes);
        let quaternion =
            ["x", "y", "z", "w"].map(|axis| row[&format!("q_sc_j2000_{axis}")].as_str()).join(",");
        table += &format!("{},{file},{quaternion},{},{}\n", row["time_utc"], row["frame"], row["exposure_s"]);
    }
    bench.write("real/telemetry.csv", table);
    bench
}

/// Checks that the dataset is processed: from the first frame on, the target is at its true position in the
/// image and on the sky.
fn check(bench: &Bench, tolerance_px: f64) {
    let answer = bench.boresight("process real --json").done().json();
    assert_eq!(answer["frames"], 8);
    let rows = bench.csv("real/measurements.csv");
    assert_eq!(rows.len(), 8);
    for (row, truth) in rows.iter().zip(bench.frames("set")) {
        let number = |column: &str| row[column].parse::<f64>().unwrap_or_else(|_| panic!("{row:?}"));
        assert_eq!((row["frame"].as_str(), row["status"].as_str()), (&*truth.frame.to_string(), "detected"));
        let place = truth.target_position.unwrap();
        let off_px = libm::hypot(number("x_px") - place.x, number("y_px") - place.y);
        assert!(off_px < tolerance_px, "frame {}: {off_px} px", truth.frame);
        // The stars of the built-in catalogue were identified. The line of sight is therefore better than
        // from telemetry only, which contains neither the true mounting (0.03 degrees difference) nor its
        // noise (0.015 degrees per axis).
        assert_eq!(row["attitude"], "stars", "{row:?}");
        let los = Vector3::new(number("los_j2000_x"), number("los_j2000_y"), number("los_j2000_z"));
        let off_deg = los.cross(truth.line_of_sight.vector()).norm().to_degrees();
        assert!(off_deg < 0.024, "frame {}: {off_deg} degrees, a pixel", truth.frame);
    }
}

fn encoded(image: impl Into<image::DynamicImage>, format: image::ImageFormat) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    image.into().write_to(&mut bytes, format).unwrap();
    bytes.into_inner()
}

const TIFF_16: Encode = |image| ("tif", encoded(image.clone(), image::ImageFormat::Tiff));
const PNG_16: Encode = |image| ("PNG", encoded(image.clone(), image::ImageFormat::Png));

/// Eight bits, as from a cheaper camera.
fn png_8(image: &Grey16) -> (&'static str, Vec<u8>) {
    let bits: Vec<u8> = image.iter().map(|dn| (dn >> 4) as u8).collect();
    let image = image::GrayImage::from_raw(image.width(), image.height(), bits).unwrap();
    ("png", encoded(image, image::ImageFormat::Png))
}

/// A minimal FITS file, card by card: FITS standard 4.0, Sections 3.3 and 4.4.1.
fn fits(image: &Grey16, bitpix: i64, more: &[&str], data: Vec<u8>) -> Vec<u8> {
    let mut cards = vec![
        format!("SIMPLE  = {:>20}", "T"),
        format!("BITPIX  = {bitpix:>20}"),
        format!("NAXIS   = {:>20}", 2),
        format!("NAXIS1  = {:>20}", image.width()),
        format!("NAXIS2  = {:>20}", image.height()),
    ];
    cards.extend(more.iter().map(|card| (*card).to_owned()));
    cards.push("END".to_owned());
    let mut bytes: Vec<u8> = cards.iter().flat_map(|card| format!("{card:80}").into_bytes()).collect();
    bytes.resize(bytes.len().next_multiple_of(2880), b' ');
    bytes.extend(data);
    bytes.resize(bytes.len().next_multiple_of(2880), 0);
    bytes
}

/// 16 bits unsigned by the BZERO convention.
const FITS_16: Encode = |image| {
    let data = image.iter().flat_map(|dn| ((i32::from(*dn) - 32768) as i16).to_be_bytes()).collect();
    ("fits", fits(image, 16, &["BZERO   =              32768.0", "BSCALE  =                  1.0"], data))
};

/// Floating point, as written by image reduction.
const FITS_FLOAT: Encode = |image| {
    let data = image.iter().flat_map(|dn| f32::from(*dn).to_be_bytes()).collect();
    ("fit", fits(image, -32, &["OBJECT  = 'TANGO   '"], data))
};

#[test]
fn tiff_of_16_bits_is_measured() {
    check(&dataset(12, |_, image| TIFF_16(image)), 0.1);
}

#[test]
fn fits_of_16_bits_is_measured() {
    check(&dataset(12, |_, image| FITS_16(image)), 0.1);
}

#[test]
fn fits_of_floating_point_is_measured() {
    check(&dataset(12, |_, image| FITS_FLOAT(image)), 0.1);
}

#[test]
fn png_of_8_bits_is_measured() {
    check(&dataset(8, |_, image| png_8(image)), 0.2);
}

#[test]
fn the_format_of_the_files_does_not_matter() {
    let kinds = [TIFF_16, PNG_16, FITS_16, FITS_FLOAT];
    let mixed = dataset(12, |frame, image| kinds[frame as usize % kinds.len()](image));
    check(&mixed, 0.1);
    let tiff = dataset(12, |_, image| TIFF_16(image));
    tiff.boresight("process real").done();
    assert_eq!(mixed.read("real/measurements.csv"), tiff.read("real/measurements.csv"));
}

#[test]
fn a_program_may_measure_them_too() {
    let bench = dataset(12, |_, image| TIFF_16(image));
    let command = format!("exec:python3 '{}/examples/brightest.py'", env!("CARGO_MANIFEST_DIR"));
    bench.boresight_words(&["process", "real", "--out", "brightest.csv", "--pipeline", &command]).done();
    let statuses: Vec<_> = bench.csv("brightest.csv").iter().map(|row| row["status"].clone()).collect();
    assert_eq!(statuses[0], "no_previous_frame");
    assert!(statuses[1..].iter().all(|status| status == "detected"), "{statuses:?}");
}

#[test]
fn nothing_is_written_into_the_dataset_if_the_measurements_are_written_elsewhere() {
    let bench = dataset(12, |_, image| TIFF_16(image));
    let before = bench.tree("real");
    bench.write("out/notes.txt", "");
    bench.boresight("process real --out out/mine.csv").done();
    check_same_files(&before, &bench.tree("real"));
    let names: Vec<_> = bench.tree("out").into_keys().collect();
    assert_eq!(names, ["mine.clusters.parquet", "mine.csv", "notes.txt"].map(std::path::PathBuf::from));
}
