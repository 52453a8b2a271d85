//! Tests of the pipelines through their public interface, one module per suite: `cargo test -p
//! boresight-pipeline --test it external::` runs one suite.

#![allow(clippy::unwrap_used, reason = "a panic is how a test fails, in its helpers too")]

mod table_1;

mod aberration;
#[cfg(unix)]
mod external;
mod far_range;
mod lost_in_space;
