//! Files of the user: strict TOML, mistakes with file, line and column, and reading of regular files only.

#![cfg_attr(
    not(test),
    deny(
        clippy::indexing_slicing,
        clippy::string_slice,
        clippy::expect_used,
        clippy::panic,
        clippy::unreachable
    )
)]

pub mod exact_toml;
pub mod regular_file;
pub mod toml_file;
