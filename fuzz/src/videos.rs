//! Fuzz targets for video of the cameras of `corpus/setup/small.toml`.

use std::path::Path;
use std::sync::OnceLock;

use boresight::docking::rows::SetupFile;
use boresight::docking::video::{
    AviCoding, AviWriter, FieldOrder, FieldSource, FrameSize, Scan, SequenceOptions, Y4mWriter,
};
use boresight::files::FileError;
use contract::docking::{Digitiser, DockingSetup, Field, FieldTelemetry, Lines};

use crate::{Sandbox, written};

pub(crate) fn avi(sandbox: &Sandbox, bytes: &[u8]) {
    read(sandbox, &sandbox.file("a.avi", bytes), None);
}

pub(crate) fn y4m(sandbox: &Sandbox, bytes: &[u8]) {
    read(sandbox, &sandbox.file("a.y4m", bytes), None);
}

pub(crate) fn raw(sandbox: &Sandbox, bytes: &[u8]) {
    let size = setup().cameras.first().map(|camera| FrameSize { columns: camera.columns, rows: camera.rows });
    read(sandbox, &sandbox.file("a.raw", bytes), size);
}

fn read(sandbox: &Sandbox, path: &Path, raw: Option<FrameSize>) {
    let options = SequenceOptions {
        scan: Scan::Interlaced(FieldOrder::Top),
        scan_is_stated: false,
        camera: 0,
        frame_rate_hz: None,
        raw,
        digitiser: Digitiser::default(),
    };
    if let Ok(fields) = FieldSource::open(path, setup(), &options) {
        let all: Result<Vec<_>, _> = fields.collect();
        if let Ok(fields) = all {
            again(sandbox, &fields, &options);
        }
    }
}

/// Pixels of the fields of a sequence, with their lines.
type Pixels = Vec<(Lines, Vec<u16>)>;

/// Writes fields as Y4M and AVI and reads them again. Their numbers and times are not kept: a recorder may
/// have dropped frames.
fn again(sandbox: &Sandbox, fields: &[(Field, FieldTelemetry)], options: &SequenceOptions) {
    let Some(camera) = setup().cameras.first() else { return };
    let (size, rate_hz) = ((camera.columns, camera.rows), 25.0);
    let options = SequenceOptions { raw: None, scan_is_stated: true, ..*options };
    let read = |path: &Path| -> Result<Pixels, FileError> {
        FieldSource::open(path, setup(), &options)?.map(|field| Ok(pixels(&field?.0))).collect()
    };
    let first: Pixels = fields.iter().map(|(field, _)| pixels(field)).collect();
    if first.is_empty() {
        return;
    }
    let y4m = |path: &Path, _: &Pixels| {
        let mut writer = Y4mWriter::create(path, size, rate_hz)?;
        fields.iter().try_for_each(|(field, _)| writer.write(field))?;
        writer.finish()
    };
    written::check(sandbox, "again.y4m", &first, y4m, read);
    let avi = |path: &Path, _: &Pixels| {
        let mut writer = AviWriter::create(path, AviCoding::Grey, size, rate_hz)?;
        fields.iter().try_for_each(|(field, _)| writer.write(field))?;
        writer.finish()
    };
    written::check(sandbox, "again.avi", &first, avi, read);
}

fn pixels(field: &Field) -> (Lines, Vec<u16>) {
    (field.lines(), field.image().dn().to_vec())
}

#[expect(clippy::expect_used, reason = "the file is part of the corpus, independent of the input")]
fn setup() -> &'static DockingSetup {
    static SETUP: OnceLock<DockingSetup> = OnceLock::new();
    SETUP.get_or_init(|| {
        let path = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/corpus/setup/small.toml"));
        SetupFile::read(path).expect("the setup of the corpus is valid").setup()
    })
}
