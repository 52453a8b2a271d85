//! Tests of the pipelines through their public interface, one module per suite: `cargo test -p
//! boresight-pipeline --test it external::` runs one suite.

#![allow(clippy::unwrap_used, reason = "tests and their helpers fail by panicking")]

mod table_1;

mod aberration;
#[cfg(unix)]
mod external;
#[cfg(unix)]
mod external_navigator;
mod far_range;
mod lost_in_space;
