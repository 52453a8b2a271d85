//! The monitoring of a docking approach (Boguslavsky, Sazonov, Sokolov, Smirnov, Saigiraev, ICINCO 2004).
//!
//! A field of television is searched for the target's cross and marks (a region predicted from the fields before,
//! regions of the binary image, edges, and a scan by structure, one backing up the other), the cross's bars and the
//! circle of the marks are measured by least squares, and pose and motion follow. A chapter of the paper is a folder
//! here, and a step of it a file.

mod config;
mod cross_and_circle;
mod extraction;
mod observer;
mod pipeline;
pub mod portions;
mod pose;
mod preprocessing;
mod repeats;
#[cfg(test)]
mod synthetic;

pub use config::DockingConfig;
pub use pipeline::{DockingFactory, DockingPipeline};
pub use pose::{geometry, model_fit, paper_pose};
pub use preprocessing::edges::EdgeConfig;
pub use preprocessing::histogram::{AutoContrastConfig, AutoContrastMode};
pub use preprocessing::region::{Rectangle, RegionConfig};
