//! The oracle

pub mod files;
