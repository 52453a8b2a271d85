//! The page, embedded when it has been built.

/// What builds the page, at the top of the repository.
pub const BUILD_COMMAND: &str = "npm ci --prefix monitor && npm run build --prefix monitor";

/// The files of the page, sorted by name; written by the build script, empty if the page was not built.
const PAGE: &[(&str, &[u8])] = include!(concat!(env!("OUT_DIR"), "/page.rs"));

/// Whether the page is in this executable.
pub fn is_page_built() -> bool {
    file("index.html").is_some()
}

/// A file of the page by its exact name, and its type.
pub(crate) fn asset(name: &str) -> Option<(&'static [u8], &'static str)> {
    let kind = match name.rsplit_once('.')?.1 {
        "html" => "text/html; charset=utf-8",
        "js" => "text/javascript; charset=utf-8",
        "css" => "text/css; charset=utf-8",
        "svg" => "image/svg+xml",
        _ => return None,
    };
    file(name).map(|data| (data, kind))
}

fn file(name: &str) -> Option<&'static [u8]> {
    let index = PAGE.binary_search_by_key(&name, |(name, _)| name).ok()?;
    PAGE.get(index).map(|(_, data)| *data)
}
