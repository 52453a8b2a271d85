//! Differences between the pages of `docs/`, which a code host shows as they are, and those of the book.

use std::fs;
use std::path::Path;

/// Mark before the file whose text takes the place of a page.
const INCLUDE: &str = "<!-- include ";
/// Mark in an included file: the rest is not part of the book.
const END_OF_PAGE: &str = "<!-- end of the page -->";

/// Rewrites the pages of a folder of the book: a page with the mark `<!-- include FILE -->` becomes the text
/// of that file, or for source code gets the code in the place of the mark; links out of `docs/` become text.
pub(super) fn complete(docs: &Path, pages: &Path) -> std::io::Result<()> {
    for entry in fs::read_dir(docs)? {
        let source = entry?.path();
        if source.extension().is_none_or(|extension| extension != "md") {
            continue;
        }
        let text = with_include(&fs::read_to_string(&source)?, docs)?;
        let is_inside = |link: &str| link.contains("://") || is_in_docs(docs, link);
        fs::write(pages.join(source.file_name().unwrap_or_default()), with_links(&text, &is_inside))?;
    }
    Ok(())
}

/// Returns a page with the file of its mark, if it has one; paths are relative to the folder of the page.
fn with_include(page: &str, folder: &Path) -> std::io::Result<String> {
    let Some((before, (file, after))) =
        page.split_once(INCLUDE).and_then(|(before, rest)| Some((before, rest.split_once(" -->")?)))
    else {
        return Ok(page.to_owned());
    };
    let text = fs::read_to_string(folder.join(file))?;
    Ok(if file.ends_with(".md") {
        text.split(END_OF_PAGE).next().unwrap_or_default().to_owned()
    } else {
        format!("{before}```rust,ignore\n{text}```\n{after}")
    })
}

/// Returns true if a link of a page in the folder leads to a file below `docs/`.
fn is_in_docs(folder: &Path, link: &str) -> bool {
    let depth = if folder.ends_with("docs") { 0 } else { 1 };
    link.split('/').take_while(|part| *part == "..").count() <= depth
}

/// Returns a page whose links that are not inside the book are replaced by their words.
fn with_links(page: &str, is_inside: &dyn Fn(&str) -> bool) -> String {
    let mut pieces = page.split("](");
    let mut text = pieces.next().unwrap_or_default().to_owned();
    for piece in pieces {
        let (link, rest) = piece.split_once(')').unwrap_or((piece, ""));
        match text.rfind('[') {
            Some(opening) if !is_inside(link) => {
                text.remove(opening);
                text += rest;
            }
            _ => {
                text += "](";
                text += piece;
            }
        }
    }
    text
}
