//! The oracle: what simulates, processes and scores, and the command `boresight` over it.

pub mod toml_file;
