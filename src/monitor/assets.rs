//! The page, embedded when it has been built.

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

use std::borrow::Cow;

use rust_embed::RustEmbed;

/// What builds the page, at the top of the repository.
pub const BUILD_COMMAND: &str = "npm ci --prefix monitor && npm run build --prefix monitor";

#[derive(RustEmbed)]
#[folder = "monitor/dist"]
#[allow_missing = true]
struct Dist;

/// Whether the page is in this executable.
pub fn is_page_built() -> bool {
    Dist::get("index.html").is_some()
}

/// A file of the page by its exact name, and its type.
pub(super) fn asset(name: &str) -> Option<(Cow<'static, [u8]>, &'static str)> {
    let kind = match name.rsplit_once('.')?.1 {
        "html" => "text/html; charset=utf-8",
        "js" => "text/javascript; charset=utf-8",
        "css" => "text/css; charset=utf-8",
        "svg" => "image/svg+xml",
        _ => return None,
    };
    Dist::get(name).map(|file| (file.data, kind))
}
