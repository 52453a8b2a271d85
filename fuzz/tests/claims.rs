//! Readers do not allocate the size that a file claims: a hundred bytes that claim 60000 × 60000 pixels cost
//! no more memory than a small image.

#![allow(clippy::unwrap_used, reason = "tests and their helpers fail by panicking")]

use std::fs;
use std::path::Path;
use std::sync::{Mutex, PoisonError};

use boresight_fuzz::{Sandbox, Target};
use peak_alloc::PeakAlloc;

#[global_allocator]
static MEMORY: PeakAlloc = PeakAlloc;

/// Peak memory is counted per process, so the tests run one at a time.
static ALONE: Mutex<()> = Mutex::new(());

/// Largest memory that an input of a few kilobytes may use, bytes. For comparison, 60000 × 60000 pixels of 16
/// bits are 7.2 GB.
const MAX_BYTES: usize = 64 << 20;
/// Formats whose headers state the amount of data that follows.
const FORMATS: [&str; 7] = ["avi", "baseline_rows", "exr", "fits", "parquet", "png", "tiff"];

/// Runs a target and returns its peak memory, bytes.
fn cost(sandbox: &Sandbox, target: &str, bytes: &[u8]) -> usize {
    let target = Target::named(target).unwrap();
    MEMORY.reset_peak_usage();
    let before = MEMORY.current_usage();
    target.run(sandbox, bytes);
    MEMORY.peak_usage().saturating_sub(before)
}

fn check(sandbox: &Sandbox, target: &str, what: &str, bytes: &[u8]) {
    let cost = cost(sandbox, target, bytes);
    assert!(cost < MAX_BYTES, "{target}: {what}: {} bytes cost {cost}", bytes.len());
}

fn seed(target: &str, name: &str) -> Vec<u8> {
    fs::read(Path::new(env!("CARGO_MANIFEST_DIR")).join("corpus").join(target).join(name)).unwrap()
}

/// Overwrites the bytes that follow the first occurrence of `after`.
fn overwrite(bytes: &mut [u8], after: &[u8], with: &[u8]) {
    let at = bytes.windows(after.len()).position(|window| window == after).unwrap() + after.len();
    bytes[at..at + with.len()].copy_from_slice(with);
}

/// Returns the beginning of a square PNG of `side` × `side` pixels, 16-bit grey; the fuzz target corrects its
/// checksums.
fn png(side: u32) -> Vec<u8> {
    let header = [side.to_be_bytes().as_slice(), &side.to_be_bytes(), &[16, 0, 0, 0, 0]].concat();
    let chunk =
        |kind: &[u8], data: &[u8]| [&(data.len() as u32).to_be_bytes()[..], kind, data, &[0; 4]].concat();
    [
        b"\x89PNG\r\n\x1a\n".to_vec(),
        chunk(b"IHDR", &header),
        chunk(b"IDAT", &[0x78, 0x9c, 1, 0, 0]),
        chunk(b"IEND", &[]),
    ]
    .concat()
}

/// Returns a TIFF with one strip whose stated length is that of the whole image.
fn tiff(side: u32) -> Vec<u8> {
    let entry = |tag: u16, value: u32| {
        [&tag.to_le_bytes()[..], &4_u16.to_le_bytes(), &1_u32.to_le_bytes(), &value.to_le_bytes()].concat()
    };
    let bytes = side.wrapping_mul(side).wrapping_mul(2);
    let entries = [
        (256, side),
        (257, side),
        (258, 16),
        (259, 1),
        (262, 1),
        (273, 8),
        (277, 1),
        (278, side),
        (279, bytes),
    ];
    let entries: Vec<u8> = entries.into_iter().flat_map(|(tag, value)| entry(tag, value)).collect();
    [&b"II*\0\x08\0\0\0\x09\0"[..], &entries, &[0; 4]].concat()
}

fn fits(side: u32, bytes: usize) -> Vec<u8> {
    let cards = [
        "SIMPLE  =                    T".to_owned(),
        "BITPIX  =                   16".to_owned(),
        "NAXIS   =                    2".to_owned(),
        format!("NAXIS1  = {side:20}"),
        format!("NAXIS2  = {side:20}"),
        "END".to_owned(),
    ];
    let mut file: Vec<u8> = cards.iter().flat_map(|card| format!("{card:80}").into_bytes()).collect();
    file.resize(2880, b' ');
    file.truncate(bytes);
    file
}

#[test]
fn a_false_size_in_a_header_allocates_nothing() {
    let _alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
    let sandbox = Sandbox::new().unwrap().reading_only();
    // 16384 pixels per side is allowed for a detector: such a file must be rejected by its length.
    for side in [60_000, 16_384] {
        check(&sandbox, "png", "size", &png(side));
        check(&sandbox, "tiff", "size", &tiff(side));
        check(&sandbox, "fits", "size, cut short", &fits(side, 100));
        check(&sandbox, "fits", "size", &fits(side, 2880));
        let last = (side - 1).to_le_bytes();
        let window = [[0; 8].as_slice(), &last, &last].concat();
        let mut exr = seed("exr", "small.exr");
        overwrite(&mut exr, b"dataWindow\0box2i\0\x10\0\0\0", &window);
        overwrite(&mut exr, b"displayWindow\0box2i\0\x10\0\0\0", &window);
        check(&sandbox, "exr", "size", &exr);
        check(&sandbox, "exr", "size, cut short", &exr[..400]);
        let y4m = format!("YUV4MPEG2 W{side} H{side} F25:1 Ip A1:1 Cmono\nFRAME\n");
        check(&sandbox, "y4m", "size", y4m.as_bytes());
        let mut avi = seed("avi", "small-avi.avi");
        overwrite(&mut avi, b"strf(\x04\0\0(\0\0\0", &[side.to_le_bytes(), side.to_le_bytes()].concat());
        check(&sandbox, "avi", "size", &avi[..300]);
        let mut mjpeg = seed("avi", "small-mjpeg.avi");
        let side = u16::try_from(side).unwrap().to_be_bytes();
        overwrite(&mut mjpeg, b"\xff\xc0\x00\x0b\x08", &[side, side].concat());
        check(&sandbox, "avi", "size of its JPEG", &mjpeg);
    }
    // A schema of 2^31 columns, and a footer of the largest length that its field can state.
    let footer = [
        &[0x15, 2, 0x19, 0x1c, 0x48, 1, b'r', 0x15][..],
        &[0xfe, 0xff, 0xff, 0xff, 0x0f],
        &[0, 0x16, 0, 0x19, 0x0c, 0],
    ]
    .concat();
    let file = [&b"PAR1"[..], &footer, &(footer.len() as u32).to_le_bytes(), b"PAR1"].concat();
    check(&sandbox, "parquet", "number of columns", &file);
    check(&sandbox, "parquet", "length of the footer", b"PAR1\0\0\0\0\xff\xff\xff\x7fPAR1");
}

/// Any number in a file may be a size, so every position is overwritten with the largest values.
#[test]
fn no_number_of_a_file_makes_it_costly() {
    let _alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
    let sandbox = Sandbox::new().unwrap().reading_only();
    // Failed assertions of the crate `parquet` are caught by the reader; printing each of them would take
    // longer than reading.
    let tell = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |panic| {
        if panic.location().is_some_and(|place| place.file().ends_with("claims.rs")) {
            tell(panic);
        }
    }));
    let claims: [&[u8]; 4] = [
        &[0xff, 0xff, 0xff, 0x7f],
        &[0x7f, 0xff, 0xff, 0xff],
        // Largest 32-bit and 64-bit values in Thrift encoding.
        &[0xfe, 0xff, 0xff, 0xff, 0x0f],
        &[0xfe, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0x01],
    ];
    for format in FORMATS {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("corpus").join(format);
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            let bytes = fs::read(&path).unwrap();
            // Only the two ends of large files, which contain the headers.
            let near_an_end = |at: usize| at < 160 || bytes.len() - at < 320;
            for at in (0..bytes.len()).filter(|&at| near_an_end(at)) {
                for claim in claims.iter().filter(|claim| at + claim.len() <= bytes.len()) {
                    let mut lying = bytes.clone();
                    lying[at..at + claim.len()].copy_from_slice(claim);
                    let what = format!("{} with {claim:02x?} at byte {at}", path.display());
                    check(&sandbox, format, &what, &lying);
                }
            }
        }
    }
}
