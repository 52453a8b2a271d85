//! Monitoring of a docking approach (Boguslavsky, Sazonov, Sokolov, Smirnov, Saigiraev, ICINCO 2004).
//!
//! The target's cross and marks are searched for in a television field. The methods back up each other: a
//! region predicted from previous fields, regions of the binary image, edges, and a structural scan. The
//! cross's bars and the circle of the marks are measured by least squares; pose and motion follow. Each
//! chapter of the paper is a directory here, and each step a file.

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
mod temporal_noise;

pub use config::DockingConfig;
pub use pipeline::{DockingFactory, DockingPipeline};
pub use pose::{geometry, model_fit, paper_pose};
pub use preprocessing::edges::EdgeConfig;
pub use preprocessing::histogram::{AutoContrastConfig, AutoContrastMode};
pub use preprocessing::region::{Rectangle, RegionConfig};
