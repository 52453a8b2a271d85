//! Fuzz targets for video of the cameras of `corpus/setup/small.toml`.

use std::path::Path;
use std::sync::OnceLock;

use boresight::files::docking::SetupFile;
use boresight::files::{FieldOrder, FieldSource, FrameSize, Scan, SequenceOptions};
use contract::docking::{Digitiser, DockingSetup};

use crate::Sandbox;

pub(crate) fn avi(sandbox: &Sandbox, bytes: &[u8]) {
    read(&sandbox.file("a.avi", bytes), None);
}

pub(crate) fn y4m(sandbox: &Sandbox, bytes: &[u8]) {
    read(&sandbox.file("a.y4m", bytes), None);
}

pub(crate) fn raw(sandbox: &Sandbox, bytes: &[u8]) {
    let size = setup().cameras.first().map(|camera| FrameSize { columns: camera.columns, rows: camera.rows });
    read(&sandbox.file("a.raw", bytes), size);
}

fn read(path: &Path, raw: Option<FrameSize>) {
    let options = SequenceOptions {
        scan: Scan::Interlaced(FieldOrder::Top),
        scan_is_stated: false,
        camera: 0,
        frame_rate_hz: None,
        raw,
        digitiser: Digitiser::default(),
    };
    if let Ok(fields) = FieldSource::open(path, setup(), &options) {
        fields.for_each(drop);
    }
}

#[expect(clippy::expect_used, reason = "the file is part of the corpus, independent of the input")]
fn setup() -> &'static DockingSetup {
    static SETUP: OnceLock<DockingSetup> = OnceLock::new();
    SETUP.get_or_init(|| {
        let path = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/corpus/setup/small.toml"));
        SetupFile::read(path).expect("the setup of the corpus is valid").setup()
    })
}
