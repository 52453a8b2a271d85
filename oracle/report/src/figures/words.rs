//! Names of files as people read them.

/// A name with blanks: `cut by roi`.
pub(crate) fn display_name(name: &str) -> String {
    name.replace('_', " ")
}

/// With a capital letter at its beginning.
pub(crate) fn capital(word: &str) -> String {
    let mut letters = word.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}
