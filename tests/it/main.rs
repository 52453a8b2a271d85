//! End-to-end tests of the command and its library, one module per suite: `cargo test --test it study_dask::`
//! runs one suite.

#![allow(clippy::unwrap_used, reason = "tests and their helpers fail by panicking")]

mod support;

mod architecture;
mod argon;
mod bad_input;
mod best_mode;
mod blinking_dot;
mod bounds;
mod calibration;
mod camera_calibration;
mod camera_fit;
mod camera_sensor;
mod cameras;
mod docking;
mod docking_artefacts;
mod docking_consistency;
mod docking_pose;
mod docking_sequences;
mod docking_vision;
mod docking_warp;
#[cfg(unix)]
mod external_faults;
mod external_pipeline;
#[cfg(unix)]
mod faults;
mod figures;
mod files_astropy;
mod files_by_hand;
mod files_dataset;
mod files_truth;
mod first_minutes;
mod flight_dynamics;
mod frozen;
mod gate;
mod golden_docking;
mod identity;
mod inject;
mod input_mistakes;
mod labels;
#[cfg(unix)]
mod machine_faults;
mod middle_range;
#[cfg(unix)]
mod mitsuba;
mod mitsuba_live;
mod monitor;
mod navigation;
mod real_images;
mod reference_texts;
mod report;
mod round_trip;
mod run;
#[cfg(target_os = "linux")]
mod sandbox;
mod scenarios;
mod shell;
mod show;
mod sky;
#[cfg(unix)]
mod study;
mod study_dask;
mod study_rows;
mod study_scale;
mod supply_chain;
mod twin;
mod visibility;
