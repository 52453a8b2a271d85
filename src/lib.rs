//! The oracle
