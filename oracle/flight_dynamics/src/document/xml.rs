//! XML notation: the navigation data messages of CCSDS 505.0-B.

use std::path::Path;

use files::{FileError, FileLocation};
use roxmltree::{Node, ParsingOptions};

use super::kind::Kind;
use super::message::{Document, Segment};
use super::record::{Entry, Record};

/// Largest number of elements, attributes and texts of a file.
const MAX_NODES: u32 = 1 << 26;

/// Elements nested deeper than this hold no values.
const MAX_DEPTH: u32 = 8;

/// Parses a file.
pub(super) fn tree<'a>(path: &Path, text: &'a str, kind: Kind) -> Result<roxmltree::Document<'a>, FileError> {
    let options = ParsingOptions { nodes_limit: MAX_NODES, ..ParsingOptions::default() };
    roxmltree::Document::parse_with_options(text, options)
        .map_err(|error| malformed(path, text, kind, &error))
}

/// Returns the error of text that is not XML. The library has no position for a text that ends early.
fn malformed(path: &Path, text: &str, kind: Kind, error: &roxmltree::Error) -> FileError {
    use roxmltree::Error;
    let refused = |line: u64, field: &str, value: String, expected: String| {
        FileError::value(path, FileLocation::Line(line), field, value, expected)
    };
    match error {
        Error::UnclosedRootNode | Error::UnexpectedEndOfStream => {
            let expected = format!("</{}> before the end of the file: it is truncated", kind.element());
            refused(text.lines().count().max(1) as u64, "end of file", "missing".to_owned(), expected)
        }
        Error::NoRootNode | Error::DtdDetected | Error::NodesLimitReached => {
            FileError::format(path, kind.name(), format!("XML: {error}"))
        }
        error => {
            let expected = format!("well-formed XML of a complete {}", kind.name());
            refused(u64::from(error.pos().row), "XML", error.to_string(), expected)
        }
    }
}

/// Numbers of lines by position in the text.
struct Lines {
    starts: Vec<usize>,
}

impl Lines {
    fn new(text: &str) -> Self {
        let breaks = text.bytes().enumerate().filter(|(_, byte)| *byte == b'\n');
        Self { starts: breaks.map(|(position, _)| position + 1).collect() }
    }

    fn line(&self, node: Node<'_, '_>) -> u64 {
        1 + self.starts.partition_point(|start| *start <= node.range().start) as u64
    }
}

/// Separates a file into records.
pub(super) fn document<'a>(
    path: &'a Path,
    text: &str,
    tree: &'a roxmltree::Document<'_>,
    kind: Kind,
) -> Result<Document<'a>, FileError> {
    let refused = |reason: String| FileError::format(path, kind.name(), reason);
    let lines = Lines::new(text);
    let mut root = tree.root_element();
    if name(root) == "ndm" {
        let mut messages = elements(root).filter(|node| name(*node) == kind.element());
        root = messages.next().ok_or_else(|| refused(format!("it has no element `{}`", kind.element())))?;
        if messages.next().is_some() {
            return Err(refused(format!("it has several elements `{}`, expected one", kind.element())));
        }
    }
    if name(root) != kind.element() {
        let reason = format!("its root element is `{}`, expected `{}`", name(root), kind.element());
        return Err(refused(reason));
    }
    let mut header = Record::new(path, "header", lines.line(root));
    let version = root.attribute("version").unwrap_or_default();
    header.entries.push(Entry {
        keyword: kind.version_keyword(),
        value: version.trim(),
        unit: None,
        line: lines.line(root),
    });
    for part in elements(root).filter(|node| name(*node) == "header") {
        add_values(&mut header, part, &lines, 0);
    }
    let bodies = elements(root).filter(|node| name(*node) == "body").flat_map(elements);
    let mut segments = Vec::new();
    for segment in bodies.filter(|node| name(*node) == "segment") {
        let mut metadata = Record::new(path, "metadata", lines.line(segment));
        for part in elements(segment).filter(|node| name(*node) == "metadata") {
            metadata.line = lines.line(part);
            add_values(&mut metadata, part, &lines, 0);
        }
        let records = elements(segment).filter(|node| name(*node) == "data").flat_map(elements);
        let records = records.filter(|node| name(*node) != "COMMENT");
        let data = records.map(|node| {
            let mut record = Record::new(path, name(node), lines.line(node));
            add_values(&mut record, node, &lines, 0);
            record
        });
        segments.push(Segment { metadata, data: data.collect() });
    }
    Ok(Document { header, segments })
}

fn name<'a>(node: Node<'a, '_>) -> &'a str {
    node.tag_name().name()
}

fn elements<'a, 'input>(node: Node<'a, 'input>) -> impl Iterator<Item = Node<'a, 'input>> {
    node.children().filter(|child| child.is_element())
}

/// Adds the values of all elements below `node` that contain text only.
fn add_values<'a>(record: &mut Record<'a>, node: Node<'a, '_>, lines: &Lines, depth: u32) {
    for child in elements(node).filter(|child| name(*child) != "COMMENT") {
        if elements(child).next().is_some() {
            if depth < MAX_DEPTH {
                add_values(record, child, lines, depth + 1);
            }
            continue;
        }
        record.entries.push(Entry {
            keyword: name(child),
            value: child.text().unwrap_or_default().trim(),
            unit: child.attribute("units"),
            line: lines.line(child),
        });
    }
}
