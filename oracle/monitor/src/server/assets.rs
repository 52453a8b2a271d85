//! Files of the page, which `npm run build --prefix monitor` makes and the tree contains.

/// Returns the content and the media type of a file of the page, by its exact name.
pub(crate) fn asset(name: &str) -> Option<(&'static [u8], &'static str)> {
    let found: (&[u8], &str) = match name {
        "index.html" => (include_bytes!("../../../../monitor/dist/index.html"), "text/html; charset=utf-8"),
        "monitor.js" => {
            (include_bytes!("../../../../monitor/dist/monitor.js"), "text/javascript; charset=utf-8")
        }
        "monitor.css" => (include_bytes!("../../../../monitor/dist/monitor.css"), "text/css; charset=utf-8"),
        "icon.svg" => (include_bytes!("../../../../monitor/dist/icon.svg"), "image/svg+xml"),
        // Licences of the packages in monitor.js.
        "licences.txt" => {
            (include_bytes!("../../../../monitor/dist/licences.txt"), "text/plain; charset=utf-8")
        }
        _ => return None,
    };
    Some(found)
}
