//! Fuzz targets for files of flight dynamics. A file that is read is also evaluated and, if it can be,
//! written and read again.

use std::fmt::Debug;
use std::path::Path;

use boresight::files::FileError;
use boresight::flight_dynamics::{
    Aem, Coverage, Epoch, InitialState, Notation, Oem, Opm, OrbitEphemeris, Spk, Tdm, Tle,
};

use crate::{Sandbox, written};

const FILE: &str = "file";

/// Compares a file with what was read again after it was written, unless the sandbox is for reading only.
///
/// # Panics
/// If it could not be read again, or is not what it was.
#[expect(clippy::panic, reason = "a target reports a fault by panicking")]
fn check_again<T: Debug + PartialEq>(sandbox: &Sandbox, first: &T, again: Result<T, FileError>) {
    if !sandbox.writes() {
        return;
    }
    match again {
        Err(error) => panic!("the file was written but cannot be read: {error}"),
        Ok(second) => written::check_same(FILE, first, &second),
    }
}

/// Ends and middle of the spans of a file.
fn times(coverage: &[Coverage]) -> impl Iterator<Item = Epoch> {
    coverage
        .iter()
        .take(8)
        .flat_map(|span| [span.start, span.start + (span.stop - span.start) * 0.5, span.stop])
}

fn evaluate(ephemeris: &OrbitEphemeris) {
    for time in times(&ephemeris.coverage()) {
        let _ = ephemeris.state_at(time);
    }
}

pub(crate) fn oem(sandbox: &Sandbox, bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    let Ok(oem) = Oem::parse(Path::new(FILE), text) else { return };
    evaluate(&oem.ephemeris());
    for notation in [Notation::Kvn, Notation::Xml] {
        check_again(sandbox, &oem, Oem::parse(Path::new(FILE), &oem.to_text(notation)));
    }
}

pub(crate) fn aem(sandbox: &Sandbox, bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    let Ok(aem) = Aem::parse(Path::new(FILE), text) else { return };
    let ephemeris = aem.ephemeris();
    for time in times(&ephemeris.coverage()) {
        let _ = ephemeris.rotation_at(time);
    }
    for notation in [Notation::Kvn, Notation::Xml] {
        check_again(sandbox, &aem, Aem::parse(Path::new(FILE), &aem.to_text(notation)));
    }
}

pub(crate) fn opm(sandbox: &Sandbox, bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    let Ok(opm) = Opm::parse(Path::new(FILE), text) else { return };
    let _ = opm.icrs_state();
    let _ = InitialState::parse(Path::new(FILE), text);
    for notation in [Notation::Kvn, Notation::Xml] {
        check_again(sandbox, &opm, Opm::parse(Path::new(FILE), &opm.to_text(notation)));
    }
}

pub(crate) fn tdm(sandbox: &Sandbox, bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    let Ok(tdm) = Tdm::parse(Path::new(FILE), text) else { return };
    for notation in [Notation::Kvn, Notation::Xml] {
        check_again(sandbox, &tdm, Tdm::parse(Path::new(FILE), &tdm.to_text(notation)));
    }
}

pub(crate) fn tle(_: &Sandbox, bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    if let Ok(tle) = Tle::parse(Path::new(FILE), text) {
        evaluate(&tle.into());
    }
}

pub(crate) fn spk(_: &Sandbox, bytes: &[u8]) {
    if let Ok(spk) = Spk::parse(Path::new(FILE), bytes, None) {
        evaluate(&spk.into());
    }
}
