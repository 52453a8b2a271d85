//! Text with code between backticks, as HTML.

/// Escapes a text for HTML and sets its parts between backticks as code. A single backtick stays as it is.
pub(super) fn with_inline_code(text: &str) -> String {
    let parts: Vec<&str> = text.split('`').collect();
    let pairs = (parts.len() - 1) / 2;
    let mut html = String::with_capacity(text.len() + 16);
    for (place, part) in parts.iter().enumerate() {
        match place {
            0 => {}
            place if place > 2 * pairs => html.push('`'),
            place if place % 2 == 1 => html.push_str("<code>"),
            _ => html.push_str("</code>"),
        }
        push_escaped(&mut html, part);
    }
    html
}

fn push_escaped(html: &mut String, text: &str) {
    for letter in text.chars() {
        match letter {
            '&' => html.push_str("&amp;"),
            '<' => html.push_str("&lt;"),
            '>' => html.push_str("&gt;"),
            '"' => html.push_str("&#34;"),
            '\'' => html.push_str("&#39;"),
            other => html.push(other),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn code_is_marked_and_text_is_escaped() {
        assert_eq!(with_inline_code("run `a <b>` now"), "run <code>a &lt;b&gt;</code> now");
        assert_eq!(with_inline_code("`a` and `b`"), "<code>a</code> and <code>b</code>");
        assert_eq!(with_inline_code("one ` only"), "one ` only");
        assert_eq!(with_inline_code("`a` and ` only"), "<code>a</code> and ` only");
        assert_eq!(with_inline_code(""), "");
    }
}
