//! Tests of the simulator's public interface, one module per suite: `cargo test -p boresight-sim --test it
//! pixel_distribution::` runs one suite.

#![allow(clippy::unwrap_used, reason = "tests and their helpers fail by panicking")]

mod argon;
mod small_scene;
mod vector_scene;

mod argon_numerical;
mod argon_plan;
mod detector_effects;
mod determinism;
mod earth_in_field;
mod expectation;
mod golden_manifest;
mod hot_pixels;
mod interlace;
mod moon_in_field;
mod pixel_distribution;
mod planets;
mod registers;
mod rolling_shutter;
mod sparse;
mod switching;
mod target_body;
mod target_in_the_way;
mod truth_table;
mod vector_edges;
mod vector_shadows;
mod vector_witness;
mod vibration;
mod whole_sky;

use boresight_sim::Simulation;
use boresight_sim::truth::TrajectorySource;
