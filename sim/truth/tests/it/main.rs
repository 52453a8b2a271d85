//! Tests of the crate's public interface, one module per suite: `cargo test -p boresight-truth --test it
//! golden_apparent::` runs one suite.

#![allow(clippy::unwrap_used, reason = "tests and their helpers fail by panicking")]

mod golden_apparent;
mod golden_moon;
mod golden_orbits;
