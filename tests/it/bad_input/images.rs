//! Images of a dataset.

use std::fs;

use super::{check_refused, dataset, dataset_of};
use crate::support::Bench;

/// Checks the rejection of a dataset whose second image is replaced by the given bytes.
fn check(format: &str, bytes: impl FnOnce(Vec<u8>) -> Vec<u8>, parts: &[&str]) {
    let bench = dataset_of(format);
    let name = format!("set/frames/000021.{format}");
    let image = fs::read(bench.path(&name)).unwrap();
    bench.write(&name, bytes(image));
    check_refused(&bench, "process set", &[&[name.as_str()], parts].concat());
}

fn cut_to(length: usize) -> impl FnOnce(Vec<u8>) -> Vec<u8> {
    move |mut bytes| {
        bytes.truncate(length);
        bytes
    }
}

/// Replaces a header card, and turns the checksum of header and data into a comment; the length of the file
/// stays.
fn with_card(keyword: &'static str, card: &'static str) -> impl FnOnce(Vec<u8>) -> Vec<u8> {
    move |mut bytes| {
        let sum = bytes.chunks_exact(80).position(|old| old.starts_with(b"CHECKSUM")).unwrap() * 80;
        bytes[sum..sum + 10].copy_from_slice(b"COMMENT   ");
        let at = bytes.chunks_exact(80).position(|old| old.starts_with(keyword.as_bytes())).unwrap() * 80;
        bytes[at..at + 80].copy_from_slice(format!("{card:80}").as_bytes());
        bytes
    }
}

#[test]
fn a_fits_file_cut_short_is_refused() {
    check("fits", cut_to(0), &["ends within a header"]);
    check("fits", cut_to(1000), &["ends within a header"]);
    check("fits", cut_to(100_000), &["bytes of data", "the bytes left in the file"]);
}

#[test]
fn a_fits_header_with_a_false_size_is_refused() {
    check(
        "fits",
        with_card("NAXIS1", "NAXIS1  =                75200"),
        &["bytes of data", "the bytes left in the file"],
    );
    check("fits", with_card("NAXIS1", "NAXIS1  =  9223372036854775807"), &["NAXISn", "fits 64 bits"]);
    check("fits", with_card("NAXIS1", "NAXIS1  =                   -1"), &["NAXIS1", "`-1`"]);
    check("fits", with_card("NAXIS2", "NAXIS2  =                  579"), &["752 × 579", "752 × 580"]);
    check("fits", with_card("BITPIX", "BITPIX  =                   12"), &["BITPIX", "`12`"]);
    check("fits", with_card("BITDEPTH", "BITDEPTH=                   14"), &["`14`", "12"]);
}

#[test]
fn a_fits_header_that_contradicts_itself_is_refused() {
    check(
        "fits",
        with_card("EXPTIME", "NAXIS1  =                  751"),
        &["NAXIS1", "present 2 times", "once"],
    );
}

#[test]
fn a_fits_header_that_makes_all_pixels_the_same_is_refused() {
    check("fits", with_card("BSCALE", "BSCALE  =                  0.0"), &["BSCALE", "`0`"]);
}

/// The checksum of the data is used on its own if the checksum of header and data is missing.
#[test]
fn changed_fits_data_are_refused_by_their_checksum() {
    let damaged = |bytes: Vec<u8>| {
        let mut bytes = with_card("SEED", "COMMENT")(bytes);
        let last = bytes.len() - 2880;
        bytes[last - 1] ^= 1;
        bytes
    };
    check("fits", damaged, &["DATASUM", "damaged"]);
}

/// Two images of a dataset are swapped: names can be wrong, and the contents of the images are therefore
/// compared with the telemetry.
#[test]
fn an_image_of_another_frame_is_refused_by_its_header() {
    for (format, field) in [("fits", "`FRAMENO` is `22`"), ("exr", "`boresight.frame` is `22`")] {
        let bench = dataset_of(format);
        let path = |name: &str| bench.path(&format!("set/frames/{name}.{format}"));
        for (from, to) in [("000021", "kept"), ("000022", "000021"), ("kept", "000022")] {
            fs::rename(path(from), path(to)).unwrap();
        }
        let name = format!("set/frames/000021.{format}");
        check_refused(&bench, "process set", &[&name, field, "expected 21, the value of frame 21"]);
    }
    check("fits", with_card("EXPTIME", "EXPTIME =                 99.0"), &["`EXPTIME` is `99`", "frame 21"]);
    let time = "DATE-AVG= '2013-01-01T00:00:00'";
    check("fits", with_card("DATE-AVG", time), &["`DATE-AVG` is `2013-01-01T00:00:00.0", "frame 21"]);
    check("fits", with_card("DATE-AVG", "DATE-AVG= 'yesterday'"), &["`DATE-AVG` is `yesterday`", "UTC"]);
}

#[test]
fn an_image_that_belongs_to_two_frames_is_refused() {
    let bench = dataset();
    bench.edit("set/telemetry.csv", "000021.png", "000020.png");
    fs::remove_file(bench.path("set/frames/000021.png")).unwrap();
    check_refused(&bench, "process set", &["telemetry.csv", "frame 21", "frame 20 has the same image"]);
    let bench = Bench::new();
    bench.boresight("render docking --frames 20000..20003 --out set").done();
    bench.unseal("set");
    let first = bench.csv("set/telemetry.csv")[0]["file"].clone();
    let second = bench.csv("set/telemetry.csv")[1]["file"].clone();
    bench.edit("set/telemetry.csv", &second, &first);
    check_refused(&bench, "process set", &["telemetry.csv", "field 20001", "field 20000 has the same image"]);
}

#[test]
fn a_file_that_is_not_of_its_format_is_refused() {
    for format in ["fits", "png", "exr"] {
        check(format, |_| b"GIF89a".repeat(1000), &["not a readable"]);
    }
}

#[test]
fn a_png_file_cut_short_is_refused() {
    check("png", cut_to(0), &["not a readable"]);
    check("png", |bytes| bytes[..bytes.len() / 2].to_vec(), &["not a readable"]);
}

#[test]
fn an_exr_file_cut_short_is_refused() {
    check("exr", |bytes| bytes[..bytes.len() / 2].to_vec(), &["not a readable"]);
}

#[test]
fn an_exr_header_of_another_size_is_refused_before_anything_is_decoded() {
    let claiming = |mut bytes: Vec<u8>| {
        for window in ["dataWindow\0box2i\0", "displayWindow\0box2i\0"] {
            let name = bytes.windows(window.len()).position(|part| part == window.as_bytes()).unwrap();
            // The name is followed by the length of the value, then x and y of the first and the last pixel.
            let last = name + window.len() + 4 + 8;
            bytes[last..last + 8].copy_from_slice(&[16383_i32.to_le_bytes(); 2].concat());
        }
        bytes
    };
    check("exr", claiming, &["16384 × 16384", "752 × 580"]);
}

fn png(image: impl Into<image::DynamicImage>) -> Vec<u8> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    image.into().write_to(&mut bytes, image::ImageFormat::Png).unwrap();
    bytes.into_inner()
}

#[test]
fn a_colour_image_is_refused() {
    check("png", |_| png(image::RgbImage::new(752, 580)), &["Rgb8", "grey"]);
}

#[test]
fn an_image_of_another_size_is_refused() {
    check("png", |_| png(image::GrayImage::new(580, 752)), &["580 × 752", "752 × 580"]);
}

#[test]
fn a_value_above_full_scale_names_its_pixel() {
    let bright = |_| {
        let mut image = image::ImageBuffer::<image::Luma<u16>, _>::new(752, 580);
        image.put_pixel(300, 200, image::Luma([4096]));
        png(image)
    };
    check("png", bright, &["pixel (300, 200)", "`4096`", "4095"]);
}

#[test]
fn an_extension_that_is_no_image_format_is_refused() {
    let bench = dataset();
    fs::rename(bench.path("set/frames/000021.png"), bench.path("set/frames/000021.jpg")).unwrap();
    bench.edit("set/telemetry.csv", "000021.png", "000021.jpg");
    check_refused(&bench, "process set", &["000021.jpg", "`jpg`", "fits"]);
}
