//! Consistency of docking motion with its σ: random approaches, measured by the built-in pipeline, and their
//! statistics.

pub mod approaches;
pub mod tally;
