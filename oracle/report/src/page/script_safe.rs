//! JSON inside of a page.

/// JSON that can stand between script tags: the same document, without a `<` in it.
pub(crate) fn script_safe(json: &str) -> String {
    json.replace('<', "\\u003c").replace('\u{2028}', "\\u2028").replace('\u{2029}', "\\u2029")
}
