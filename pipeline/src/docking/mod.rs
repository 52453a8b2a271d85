//! The monitoring of a docking approach (Boguslavsky, Sazonov, Sokolov, Smirnov, Saigiraev, ICINCO 2004).
//!
//! A field of television is searched for the target's cross and marks (a region predicted from the fields before,
//! regions of the binary image, edges, and a scan by structure, one backing up the other), the cross's bars and the
//! circle of the marks are measured by least squares, and pose and motion follow. One step of the paper is one file here.

mod binarise;
mod candidates;
mod circle;
mod components;
mod config;
mod contour;
mod cross;
mod docking_unit;
mod edges;
mod evidence;
pub mod geometry;
mod histogram;
mod marks;
pub mod model_fit;
mod observer;
mod orientation;
mod outline;
pub mod paper_pose;
mod paper_sigma;
mod pipeline;
pub mod portions;
mod profile;
mod range_memory;
mod recognise;
mod region;
mod self_check;
#[cfg(test)]
mod synthetic;
mod view;
mod votes;

pub use config::DockingConfig;
pub use edges::EdgeConfig;
pub use histogram::{AutoContrastConfig, AutoContrastMode};
pub use pipeline::{DockingFactory, DockingPipeline};
pub use region::{Rectangle, RegionConfig};
