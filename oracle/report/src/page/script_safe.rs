//! Embedding of JSON in a page.

/// Escapes JSON for use between script tags: the same document without the character `<`.
pub fn script_safe(json: &str) -> String {
    json.replace('<', "\\u003c").replace('\u{2028}', "\\u2028").replace('\u{2029}', "\\u2029")
}
