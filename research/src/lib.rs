//! Programs that answer questions about Boresight; each is a binary in `src/bin`. Results are in docs/.

pub mod docking_consistency;
pub mod docking_random;
