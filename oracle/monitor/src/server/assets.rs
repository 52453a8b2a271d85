//! Files of the page, embedded if the page has been built.

/// Command that builds the page, run at the top of the repository.
pub const BUILD_COMMAND: &str = "npm ci --prefix monitor && npm run build --prefix monitor";

/// Files of the page, sorted by name. Written by the build script; empty if the page was not built.
const PAGE: &[(&str, &[u8])] = include!(concat!(env!("OUT_DIR"), "/page.rs"));

/// Returns true if this executable contains the page.
pub fn is_page_built() -> bool {
    file("index.html").is_some()
}

/// Returns the content and the media type of a file of the page, by its exact name.
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
