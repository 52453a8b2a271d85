//! Sequences from independent writers, round trips through the writers of this crate, and damaged files.

use std::fs;
use std::io::{Cursor, Read};
use std::path::{Path, PathBuf};
use std::sync::mpsc;
use std::time::{Duration, Instant};

use contract::docking::{
    Digitiser, DockingSetup, Field, FieldTelemetry, Lines, Outline, StandOffCross, TargetModel,
};
use contract::{Camera, Frame};
use files::FileError;
use proptest::prelude::*;
use tempfile::tempdir;

use super::input::Input;
use super::*;
use crate::rows::{FieldRow, FieldTelemetryLine, FieldTelemetryWriter};

type Item = Result<(Field, FieldTelemetry), FileError>;

fn setup(columns: usize, rows: usize) -> DockingSetup {
    let camera = Camera {
        columns,
        rows,
        focal_length_mm: 10.0,
        pixel_width_um: 10.0,
        pixel_height_um: 10.0,
        principal_x_px: 0.0,
        principal_y_px: 0.0,
        radial: [0.0; 3],
        tangential: [0.0; 2],
    };
    let outline = Outline { centre_m: [0.0; 2], radius_m: 1.0, depth_m: 0.0 };
    let target = TargetModel {
        name: "none".to_owned(),
        plate_radius_m: 0.3,
        mark_circle_radius_m: 0.25,
        marks: Vec::new(),
        cross: StandOffCross {
            height_m: 0.3,
            half_length_m: 0.15,
            width_m: 0.03,
            thickness_m: 0.01,
            post_width_m: 0.020,
        },
        docking_unit: outline,
        station: outline,
    };
    DockingSetup { cameras: vec![camera.clone(), camera], bit_depth: 8, target }
}

fn options(scan: Scan) -> SequenceOptions {
    SequenceOptions {
        scan,
        scan_is_stated: false,
        camera: 0,
        frame_rate_hz: None,
        raw: None,
        digitiser: Digitiser::default(),
    }
}

const TOP: Scan = Scan::Interlaced(FieldOrder::Top);

/// Grey value of the golden files: golden/video/make.py.
fn golden_grey(x: usize, y: usize, frame: usize) -> u16 {
    (20 + 2 * x + 2 * y + 15 * frame) as u16
}

fn golden(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../golden/video").join(name)
}

fn input(bytes: &[u8]) -> Input {
    Input::new(Path::new("tiny"), Cursor::new(bytes.to_vec()))
}

/// Returns the fields before the error, and the error.
fn split(items: impl Iterator<Item = Item>) -> (Vec<(Field, FieldTelemetry)>, Option<String>) {
    let mut fields = Vec::new();
    let mut error = None;
    for item in items {
        assert!(error.is_none(), "an item after the error");
        match item {
            Ok(field) => fields.push(field),
            Err(e) => error = Some(e.to_string()),
        }
    }
    (fields, error)
}

fn opened(result: Result<FieldSource, FileError>) -> (Vec<(Field, FieldTelemetry)>, Option<String>) {
    match result {
        Ok(source) => split(source),
        Err(error) => (Vec::new(), Some(error.to_string())),
    }
}

/// `tolerance` is taken from golden/manifest.toml: 0 for lossless files, 4 grey values for JPEG.
fn check_golden(name: &str, rows: usize, tolerance: u16) {
    let setup = setup(48, rows);
    let (fields, error) = opened(FieldSource::open(&golden(name), &setup, &options(TOP)));
    assert_eq!(error, None, "{name}");
    assert_eq!(fields.len(), 8, "{name}");
    for (k, (field, telemetry)) in fields.iter().enumerate() {
        assert_eq!(field.lines(), [Lines::Even, Lines::Odd][k % 2]);
        assert_eq!((field.number(), telemetry.time_s), (k as u64, k as f64 / 50.0), "{name}");
        for y in 0..field.image().rows() {
            for x in 0..48 {
                let expected = golden_grey(x, field.lines().camera_row(y), k / 2);
                let got = field.image().dn_at(x, y);
                assert!(
                    got.abs_diff(expected) <= tolerance,
                    "{name}, field {k}, ({x}, {y}): {got}, {expected}"
                );
            }
        }
    }
}

#[test]
fn uncompressed_avi_of_another_writer_is_read_in_every_layout() {
    for (name, rows) in
        [("grey.avi", 35), ("bgr24.avi", 35), ("yuy2.avi", 35), ("uyvy.avi", 35), ("i420.avi", 36)]
    {
        check_golden(name, rows, 0);
    }
}

#[test]
fn motion_jpeg_of_another_writer_is_read() {
    check_golden("mjpeg.avi", 36, 4);
}

#[test]
fn y4m_of_another_writer_is_read() {
    for name in ["mono.y4m", "420.y4m", "422.y4m"] {
        check_golden(name, 35, 0);
    }
}

/// Returns a field with varying pixels; `step` is small if JPEG must reproduce them.
fn field(number: u64, lines: Lines, columns: usize, rows: usize, step: usize) -> Field {
    let field_rows = lines.rows(rows);
    let value = |i: usize| ((i % columns + i / columns) * step + 3 * number as usize) % 200 + 20;
    let dn = (0..columns * field_rows).map(|i| value(i) as u16).collect();
    Field::new(Frame::new(number, columns, field_rows, 8, dn, None).unwrap(), lines, rows).unwrap()
}

fn sequence(scan: Scan, frames: u64, columns: usize, rows: usize, step: usize) -> Vec<Field> {
    let lines: &[Lines] = match scan {
        Scan::Progressive => &[Lines::All],
        Scan::Interlaced(FieldOrder::Top) => &[Lines::Even, Lines::Odd],
        Scan::Interlaced(FieldOrder::Bottom) => &[Lines::Odd, Lines::Even],
    };
    (0..frames * lines.len() as u64)
        .map(|k| field(k, lines[k as usize % lines.len()], columns, rows, step))
        .collect()
}

fn write_avi(path: &Path, coding: AviCoding, fields: &[Field], size: (usize, usize)) {
    let mut writer = AviWriter::create(path, coding, size, 25.0).unwrap();
    fields.iter().for_each(|field| writer.write(field).unwrap());
    assert!(!path.exists(), "the file has its name before it is complete");
    writer.finish().unwrap();
}

#[test]
fn fields_are_read_back_from_an_uncompressed_avi_in_every_scan() {
    let directory = tempdir().unwrap();
    for (i, scan) in [Scan::Progressive, TOP, Scan::Interlaced(FieldOrder::Bottom)].into_iter().enumerate() {
        for (columns, rows) in [(16, 8), (13, 7), (1, 2)] {
            let path = directory.path().join(format!("{i}-{columns}.avi"));
            let fields = sequence(scan, 3, columns, rows, 7);
            write_avi(&path, AviCoding::Grey, &fields, (columns, rows));
            let (read, error) = opened(FieldSource::open(&path, &setup(columns, rows), &options(scan)));
            assert_eq!(error, None);
            assert_eq!(read.into_iter().map(|(field, _)| field).collect::<Vec<_>>(), fields);
        }
    }
}

#[test]
fn fields_are_read_back_from_motion_jpeg_to_a_few_grey_values() {
    let directory = tempdir().unwrap();
    let path = directory.path().join("a.avi");
    let (columns, rows) = (50, 37);
    let fields = sequence(Scan::Progressive, 3, columns, rows, 1);
    write_avi(&path, AviCoding::MotionJpeg { quality: 95 }, &fields, (columns, rows));
    let (read, error) = opened(FieldSource::open(&path, &setup(columns, rows), &options(Scan::Progressive)));
    assert_eq!((error, read.len()), (None, 3));
    for ((read, _), written) in read.iter().zip(&fields) {
        let pairs = read.image().dn().iter().zip(written.image().dn());
        // A ramp at quality 95 differs by the quantisation of its few coefficients.
        assert!(pairs.map(|(a, b)| a.abs_diff(*b)).max().unwrap() <= 4);
    }
}

#[test]
fn fields_that_are_no_pair_are_not_woven() {
    let directory = tempdir().unwrap();
    let path = directory.path().join("a.avi");
    let mut writer = AviWriter::create(&path, AviCoding::Grey, (4, 4), 25.0).unwrap();
    writer.write(&field(0, Lines::Even, 4, 4, 1)).unwrap();
    let message = writer.write(&field(2, Lines::Even, 4, 4, 1)).unwrap_err().to_string();
    assert!(message.contains("even") && message.contains("odd"), "{message}");
    assert!(writer.write(&field(1, Lines::Odd, 5, 4, 1)).unwrap_err().to_string().contains("5 × 4"));
    let deep = Field::new(Frame::new(1, 4, 2, 10, vec![1000; 8], None).unwrap(), Lines::Odd, 4).unwrap();
    assert!(writer.write(&deep).unwrap_err().to_string().contains("1000"));
    drop(writer);
    assert_eq!(fs::read_dir(directory.path()).unwrap().count(), 0, "an unfinished file is left behind");
    for (size, rate, quality) in [((0, 4), 25.0, 90), ((4, 4), f64::NAN, 90), ((4, 4), 25.0, 0)] {
        assert!(AviWriter::create(&path, AviCoding::MotionJpeg { quality }, size, rate).is_err());
    }
}

#[test]
fn a_folder_with_telemetry_gives_the_fields_that_it_lists() {
    let directory = tempdir().unwrap();
    let fields = sequence(TOP, 2, 6, 5, 3);
    let mut writer = FieldTelemetryWriter::create(&directory.path().join("telemetry.csv")).unwrap();
    let mut expected = Vec::new();
    for (k, field) in fields.iter().enumerate() {
        let file = format!("{}.png", 9 - k);
        write_field(&directory.path().join(&file), field).unwrap();
        let digitiser = Digitiser { contrast: 1.5, brightness: 0.1 };
        let telemetry = FieldTelemetry { time_s: 3.0 + 0.02 * k as f64, camera: k % 2, digitiser };
        expected.push((field.clone(), telemetry));
        writer
            .line(&FieldTelemetryLine::from_row(&FieldRow {
                field: k as u64,
                file: Some(file),
                lines: field.lines(),
                telemetry,
            }))
            .unwrap();
    }
    writer.finish().unwrap();
    let open = || FieldSource::open(directory.path(), &setup(6, 5), &options(TOP));
    assert_eq!(opened(open()), (expected, None));

    let (fields, error) = opened(FieldSource::open(directory.path(), &setup(6, 4), &options(TOP)));
    assert_eq!(fields.len(), 0);
    assert!(error.unwrap().contains("`6 × 3`, expected 6 × 2"));
    fs::remove_file(directory.path().join("7.png")).unwrap();
    let message = opened(open()).1.unwrap();
    assert!(message.contains("line 4") && message.contains("`7.png`"), "{message}");
}

#[test]
fn a_folder_without_telemetry_gives_its_images_by_name_as_whole_frames() {
    let directory = tempdir().unwrap();
    for k in 0..11 {
        let path = directory.path().join(format!("f{k}.png"));
        write_field(&path, &field(k, Lines::All, 4, 3, 1)).unwrap();
    }
    let (fields, error) = opened(FieldSource::open(directory.path(), &setup(4, 3), &options(TOP)));
    assert_eq!((fields.len(), error), (22, None));
    assert_eq!(
        fields[21].0.image().dn()[0],
        20 + 30 + 1,
        "f10.png is the last, and its odd field begins at row 1"
    );
    let (_, error) = opened(FieldSource::open(directory.path(), &setup(4, 6), &options(TOP)));
    let message = error.unwrap();
    assert!(message.contains("f0.png") && message.contains("telemetry.csv"), "{message}");
    let empty = tempdir().unwrap();
    assert!(opened(FieldSource::open(empty.path(), &setup(4, 3), &options(TOP))).1.is_some());
}

#[test]
fn raw_frames_are_read_in_either_field_order() {
    let bytes: Vec<u8> = (0..24).collect();
    let raw = |scan| SequenceOptions { raw: Some(FrameSize { columns: 4, rows: 3 }), ..options(scan) };
    let (fields, error) =
        opened(FieldSource::raw(input(&bytes), &setup(4, 3), &raw(Scan::Interlaced(FieldOrder::Bottom))));
    assert_eq!((fields.len(), error), (4, None));
    assert_eq!(fields[0].0.image().dn(), [4, 5, 6, 7]);
    assert_eq!(fields[3].0.image().dn(), [12, 13, 14, 15, 20, 21, 22, 23]);
    let (fields, error) =
        opened(FieldSource::raw(input(&bytes[..23]), &setup(4, 3), &raw(Scan::Progressive)));
    let message = error.unwrap();
    assert!(fields.len() == 1 && message.contains("frame 1 at byte 12"), "{message}");
    let message = opened(FieldSource::raw(input(&bytes), &setup(4, 4), &raw(TOP))).1.unwrap();
    assert!(message.contains("4 × 3") && message.contains("4 × 4"), "{message}");
    assert!("768*576".parse::<FrameSize>().is_err());
    assert_eq!("768x576".parse(), Ok(FrameSize { columns: 768, rows: 576 }));
}

/// A pipe that returns only the bytes sent so far.
struct Pipe(mpsc::Receiver<u8>);

impl Read for Pipe {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        let first = self.0.recv_timeout(Duration::from_secs(10));
        match (first, buffer.first_mut()) {
            (Ok(byte), Some(to)) => {
                *to = byte;
                Ok(1)
            }
            (Err(mpsc::RecvTimeoutError::Disconnected), _) => Ok(0),
            _ => Err(std::io::Error::other("it waits for more than what was sent")),
        }
    }
}

#[test]
fn a_live_stream_yields_each_frame_on_arrival_and_ends_with_the_pipe() {
    let (sender, receiver) = mpsc::channel();
    let send = |bytes: &[u8]| bytes.iter().for_each(|byte| sender.send(*byte).unwrap());
    send(b"YUV4MPEG2 W2 H2 F50:1 It C420jpeg\nFRAME\n\x01\x02\x03\x04uv");
    let pipe = Input::new(Path::new("standard input"), Pipe(receiver));
    let mut source = FieldSource::y4m(pipe, &setup(2, 2), &options(TOP)).unwrap();
    let (first, _) = source.next().unwrap().unwrap();
    let (second, telemetry) = source.next().unwrap().unwrap();
    assert_eq!((first.image().dn(), second.image().dn()), ([1, 2].as_slice(), [3, 4].as_slice()));
    assert_eq!(telemetry.time_s, 0.01);
    send(b"FRAME Ixyz\n\x05\x06\x07\x08uv");
    assert_eq!(source.next().unwrap().unwrap().0.image().dn(), [5, 6]);
    drop(sender);
    assert!(source.next().unwrap().is_ok());
    assert!(source.next().is_none());
}

#[test]
fn a_y4m_header_does_not_contradict_the_default_order_of_fields() {
    let read = |interlacing: &str, stated: Option<Scan>| {
        let bytes = format!("YUV4MPEG2 W2 H2 F25:1 {interlacing} Cmono\nFRAME\n1234").into_bytes();
        let default = options(TOP);
        let scan = stated.unwrap_or(default.scan);
        let options = SequenceOptions { scan, scan_is_stated: stated.is_some(), ..default };
        opened(FieldSource::y4m(input(&bytes), &setup(2, 2), &options)).1
    };
    for (interlacing, words) in [("Ib", "bottom field first"), ("Im", "mixed frames")] {
        let message = read(interlacing, None).unwrap();
        assert!(message.contains(words) && message.contains("--field-order bottom"), "{message}");
        for stated in [TOP, Scan::Interlaced(FieldOrder::Bottom), Scan::Progressive] {
            assert_eq!(read(interlacing, Some(stated)), None);
        }
    }
    for interlacing in ["It", "Ip", "I?", ""] {
        assert_eq!(read(interlacing, None), None, "{interlacing}");
    }
}

#[test]
fn a_y4m_header_has_the_aspect_of_the_pixels() {
    let directory = tempdir().unwrap();
    for (name, width_um, height_um, aspect) in
        [("a.y4m", 8.6, 8.3, "A86:83"), ("b.y4m", 7.4, 7.4, "A1:1"), ("c.y4m", 5.5, 11.0, "A1:2")]
    {
        let path = directory.path().join(name);
        let writer = Y4mWriter::create(&path, (4, 4), 25.0).unwrap();
        let mut writer = writer.with_pixel_size(width_um, height_um);
        writer.write(&field(0, Lines::All, 4, 4, 1)).unwrap();
        writer.finish().unwrap();
        let bytes = fs::read(&path).unwrap();
        let header = bytes.split(|byte| *byte == b'\n').next().unwrap();
        assert!(String::from_utf8_lossy(header).contains(&format!(" {aspect} ")), "{name}");
    }
}

#[test]
fn a_y4m_header_with_false_sizes_is_refused() {
    for (header, part) in [
        ("YUV4MPEG2 W99999999999 H99999999999\n", "99999999999 × 99999999999"),
        ("YUV4MPEG2 W2 H-2\n", "2 × ?"),
        ("YUV4MPEG2 W2\n", "2 × ?"),
        ("YUV4MPEG2 W2 H2 C420p10\n", "`420p10`"),
        ("YUV4MPEG2 W2 H2 F25:0\n", "`25:0`"),
        ("YUV4MPEG2 W2 H2", "ends within the header"),
        ("RIFF\n", "YUV4MPEG2"),
        ("", "empty"),
        ("YUV4MPEG2 W2 H2 Cmono\nframe\n1234", "byte 22"),
        ("YUV4MPEG2 W2 H2 F1:4000000000\n", "frames per second"),
    ] {
        let message =
            opened(FieldSource::y4m(input(header.as_bytes()), &setup(2, 2), &options(TOP))).1.unwrap();
        assert!(message.contains(part), "{header}: {message}");
    }
    let long = [b"YUV4MPEG2 ".as_slice(), &[b'X'; 5000]].concat();
    let message = opened(FieldSource::y4m(input(&long), &setup(2, 2), &options(TOP))).1.unwrap();
    assert!(message.contains("longer than"), "{message}");
}

/// Returns a grey AVI of three frames of 5 × 3 pixels, and the ends of its frame chunks.
fn tiny_avi(coding: AviCoding) -> (Vec<u8>, Vec<usize>) {
    let directory = tempdir().unwrap();
    let path = directory.path().join("a.avi");
    write_avi(&path, coding, &sequence(Scan::Progressive, 3, 5, 3, 7), (5, 3));
    let bytes = fs::read(&path).unwrap();
    let id = if coding == AviCoding::Grey { b"00db" } else { b"00dc" };
    let movi = bytes.windows(4).position(|w| w == b"movi").unwrap();
    let mut ends = Vec::new();
    let mut at = movi + 4;
    while &bytes[at..at + 4] == id {
        let size = u32::from_le_bytes(bytes[at + 4..at + 8].try_into().unwrap()) as usize;
        ends.push(at + 8 + size);
        at += 8 + size + size % 2;
    }
    assert_eq!(ends.len(), 3);
    (bytes, ends)
}

fn read_avi(bytes: &[u8]) -> (Vec<(Field, FieldTelemetry)>, Option<String>) {
    opened(FieldSource::avi(input(bytes), &setup(5, 3), &options(Scan::Progressive)))
}

#[test]
fn a_file_cut_at_any_byte_gives_its_whole_frames_and_then_an_error() {
    for coding in [AviCoding::Grey, AviCoding::MotionJpeg { quality: 90 }] {
        let (bytes, ends) = tiny_avi(coding);
        for cut in 0..bytes.len() {
            let (fields, error) = read_avi(&bytes[..cut]);
            assert_eq!(fields.len(), ends.iter().filter(|&&end| end <= cut).count(), "cut at {cut}");
            let message = error.unwrap_or_else(|| panic!("cut at {cut}: no error"));
            assert!(message.starts_with("tiny: not a readable AVI file"), "{message}");
        }
        assert_eq!(read_avi(&bytes).1, None);
    }
    let whole = fs::read(golden("mono.y4m")).unwrap();
    for cut in (0..whole.len()).step_by(13) {
        let (fields, error) =
            opened(FieldSource::y4m(input(&whole[..cut]), &setup(48, 35), &options(Scan::Progressive)));
        let frame = 6 + 48 * 35;
        let (frames, rest) = (cut.saturating_sub(38) / frame, cut.saturating_sub(38) % frame);
        assert_eq!(fields.len(), frames);
        assert_eq!(error.is_none(), cut >= 38 && rest == 0, "cut at {cut}");
    }
}

#[test]
fn an_error_names_the_chunk_and_its_byte() {
    let (bytes, ends) = tiny_avi(AviCoding::Grey);
    let (_, error) = read_avi(&bytes[..ends[2] - 1]);
    let chunk = ends[2] - 24 - 8;
    let message = error.unwrap();
    assert!(
        message.contains(&format!("chunk `00db` at byte {chunk}: the file ends after 23 of its 24 bytes")),
        "{message}"
    );
}

#[test]
fn headers_with_false_sizes_are_refused() {
    let (good, _) = tiny_avi(AviCoding::Grey);
    let at = |what: &[u8]| good.windows(what.len()).position(|w| w == what).unwrap();
    let strf = at(b"strf");
    let check = |offset: usize, value: u32, part: &str| {
        let mut bytes = good.clone();
        bytes[offset..offset + 4].copy_from_slice(&value.to_le_bytes());
        let message = read_avi(&bytes).1.unwrap_or_else(|| panic!("{part}: no error"));
        assert!(message.contains(part), "{message}");
    };
    check(4, 0, "not completed");
    check(4, 100, "but 88 are left in its list");
    check(4, 1 << 30, "is incomplete: the file ends there");
    check(at(b"movi") - 4, u32::MAX, "are left in its list");
    check(at(b"movi") - 4, 0, "not completed");
    check(at(b"00db") + 4, u32::MAX, "chunk `00db`");
    check(at(b"00db") + 4, 20, "20 bytes, expected 15, or 24 with padding");
    check(strf + 4, 8, "8 bytes, expected 40 to 4096");
    check(strf + 12, 1 << 30, "expected 5 × 3, the size of the camera");
    check(strf + 12, u32::MAX, "-1 × 3");
    check(strf + 16, i32::MIN as u32, "× -2147483648");
    check(strf + 20, 1 | 4 << 16, "4 bits per pixel");
    check(strf + 24, u32::from_le_bytes(*b"H264"), "`H264`");
    check(at(b"strh") + 8 + 20, 0, "frames per second");
    check(8, u32::from_le_bytes(*b"WAVE"), "RIFF type");
}

#[test]
fn a_jpeg_of_another_size_is_refused_before_it_is_decoded() {
    let (mut bytes, _) = tiny_avi(AviCoding::MotionJpeg { quality: 90 });
    let sof = bytes.windows(2).position(|w| w == [0xFF, 0xC0]).unwrap();
    bytes[sof + 5..sof + 9].copy_from_slice(&[0xFF; 4]);
    let message = read_avi(&bytes).1.unwrap();
    assert!(message.contains("chunk `00dc`") && message.contains("JPEG"), "{message}");
}

#[test]
fn dropped_frames_leave_their_numbers_and_parts_of_a_large_file_are_read_on() {
    let (one, ends) = tiny_avi(AviCoding::Grey);
    let first = ends[0] - 32;
    // The second frame is empty, which is how a recorder marks a dropped frame.
    let mut bytes = one[..ends[0]].to_vec();
    bytes.extend(b"00db\0\0\0\0");
    bytes.extend(&one[ends[1]..ends[2]]);
    let movi = one.windows(4).position(|w| w == b"movi").unwrap();
    let set = |bytes: &mut Vec<u8>, at: usize, end: usize| {
        let size = (end - at - 4) as u32;
        bytes[at..at + 4].copy_from_slice(&size.to_le_bytes());
    };
    let end = bytes.len();
    set(&mut bytes, movi - 4, end);
    set(&mut bytes, 4, end);
    // A second part, in the form used by OpenDML.
    bytes.extend(b"RIFF\x30\0\0\0AVIXLIST\x24\0\0\0movi");
    bytes.extend(&one[first..ends[0]]);
    let (fields, error) = read_avi(&bytes);
    assert_eq!(error, None);
    assert_eq!(fields.iter().map(|(field, _)| field.number()).collect::<Vec<_>>(), [0, 2, 3]);
    assert_eq!(fields[2].0.image().dn(), fields[0].0.image().dn());
}

#[test]
fn a_video_that_cannot_be_opened_is_reported_with_the_reason() {
    let directory = tempdir().unwrap();
    let set = setup(4, 4);
    let message = |path: &Path, setup: &DockingSetup, options: &SequenceOptions| {
        opened(FieldSource::open(path, setup, options)).1.unwrap()
    };
    assert!(message(&directory.path().join("no.avi"), &set, &options(TOP)).contains("cannot open"));
    let other = directory.path().join("a.mp4");
    fs::write(&other, "x").unwrap();
    assert!(message(&other, &set, &options(TOP)).contains("avi or y4m"));
    let grey = golden("grey.avi");
    let deep = DockingSetup { bit_depth: 10, ..setup(48, 35) };
    assert!(message(&grey, &deep, &options(TOP)).contains("10, the bit depth of the digitiser"));
    assert!(message(&grey, &set, &options(TOP)).contains("48 × 35 pixels, expected 4 × 4"));
    let second = SequenceOptions { camera: 2, ..options(TOP) };
    assert!(message(&grey, &setup(48, 35), &second).contains("0 to 1, the index of a camera"));
    let still = SequenceOptions { frame_rate_hz: Some(0.0), ..options(TOP) };
    assert!(message(&grey, &setup(48, 35), &still).contains("frames per second"));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn garbage_is_an_answer_in_bounded_time(
        seed in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..12),
        jpeg in any::<bool>(),
        cut in any::<prop::sample::Index>(),
    ) {
        let coding = if jpeg { AviCoding::MotionJpeg { quality: 50 } } else { AviCoding::Grey };
        let (mut bytes, _) = tiny_avi(coding);
        for (at, value) in seed {
            let n = bytes.len();
            bytes[at.index(n)] = value;
        }
        bytes.truncate(bytes.len() - cut.index(bytes.len()) / 8);
        let begin = Instant::now();
        let (fields, _) = read_avi(&bytes);
        prop_assert!(fields.len() <= 3);
        // Milliseconds suffice; seconds would indicate a loop whose length depends on the file.
        prop_assert!(begin.elapsed() < Duration::from_secs(2));
    }

    #[test]
    fn noise_is_no_video(bytes in prop::collection::vec(any::<u8>(), 0..400)) {
        prop_assert!(read_avi(&bytes).1.is_some());
        let y4m = FieldSource::y4m(input(&bytes), &setup(5, 3), &options(TOP));
        prop_assert!(opened(y4m).1.is_some());
    }
}
