//! Fuzzer: runs the target that `BORESIGHT_TARGET` names, and ends at the first panic. Its arguments are
//! those of libFuzzer.

#![no_main]

use std::panic::{catch_unwind, set_hook, take_hook};
use std::sync::OnceLock;

use boresight_fuzz::{Sandbox, Target};
use libfuzzer_sys::fuzz_target;

static TARGET: OnceLock<(&Target, Sandbox)> = OnceLock::new();

fn prepare() -> (&'static Target, Sandbox) {
    let name = std::env::var("BORESIGHT_TARGET").unwrap_or_default();
    let target = Target::named(&name)
        .unwrap_or_else(|| panic!("BORESIGHT_TARGET is `{name}`, expected the name of a target"));
    // The default hook of the fuzzer ends the process at every panic. Panics inside the crate `parquet` and
    // the buffers that it slices are caught by the reader and turned into errors; a panic that reaches this
    // hook from elsewhere is a fault of the reader.
    let _ = take_hook();
    set_hook(Box::new(|panic| {
        let place = panic.location().map_or("", |location| location.file());
        if !["parquet-", "bytes-"].iter().any(|name| place.contains(name)) {
            eprintln!("{panic}\n{}", std::backtrace::Backtrace::force_capture());
            std::process::abort();
        }
    }));
    let sandbox = Sandbox::new().unwrap_or_else(|error| panic!("the sandbox cannot be created: {error}"));
    // The tests of the corpus compare what is read again. Here a text with control characters would differ:
    // readers of flight dynamics accept them in names, and writers leave them out.
    (target, sandbox.reading_only())
}

fuzz_target!(|bytes: &[u8]| {
    let (target, sandbox) = TARGET.get_or_init(prepare);
    if catch_unwind(std::panic::AssertUnwindSafe(|| target.run(sandbox, bytes))).is_err() {
        eprintln!("the reader did not catch a panic of the crate `parquet`");
        std::process::abort();
    }
});
