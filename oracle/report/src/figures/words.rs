//! Names from files, in readable form.

/// Returns a name with spaces: `cut by roi`.
pub fn display_name(name: &str) -> String {
    name.replace('_', " ")
}

/// Returns a word with a capital first letter.
pub fn capital(word: &str) -> String {
    let mut letters = word.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}
