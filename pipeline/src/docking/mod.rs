//! The monitoring of a docking approach (Boguslavsky, Sazonov, Sokolov, Smirnov, Saigiraev, ICINCO 2004).

pub mod geometry;
pub mod paper_pose;
pub mod portions;
