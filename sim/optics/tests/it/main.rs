//! Tests of the crate's public interface, one module per suite: `cargo test -p boresight-optics --test it
//! golden_psf::` runs one suite.

#![allow(clippy::unwrap_used, reason = "tests and their helpers fail by panicking")]

mod golden_psf;
mod golden_radiometry;
