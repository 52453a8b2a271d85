//! Tree of a YAML or JSON file, with limits for hostile input. JSON is read as YAML, whose subset it is.

use std::collections::HashMap;
use std::path::Path;

use saphyr_parser::{Event, Parser};

use crate::{FileError, FileLocation};

/// Largest file, bytes: a calibration with the image points of a thousand views has some megabytes.
const MAX_BYTES: u64 = 1 << 24;
/// Largest depth of nested lists and tables.
const MAX_DEPTH: usize = 16;
/// Items kept of each list. No list that describes a camera is longer; lists of image points are.
const MAX_ITEMS: usize = 64;
/// Largest number of keys of one table.
const MAX_KEYS: usize = 1000;
/// Largest number of kept nodes, those that aliases repeat included.
const MAX_NODES: usize = 100_000;

/// Value in a file, with its line.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Node {
    /// Line of the value, or of its key in a table, counted from 1.
    pub(super) line: u64,
    /// Content of the value.
    pub(super) content: Content,
}

/// Content of a value.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Content {
    /// Number, word or text as written, without quotes.
    Scalar(String),
    /// List: its first [`MAX_ITEMS`] items and their number in the file.
    List(Vec<Node>, usize),
    /// Table: keys and values in the order of the file.
    Table(Vec<(String, Node)>),
}

impl Node {
    /// Returns the entries of a table; none for another value.
    pub(super) fn entries(&self) -> &[(String, Node)] {
        match &self.content {
            Content::Table(entries) => entries,
            _ => &[],
        }
    }

    /// Returns the value of a key of a table.
    pub(super) fn get(&self, key: &str) -> Option<&Self> {
        self.entries().iter().find(|(name, _)| name == key).map(|(_, node)| node)
    }

    /// Returns the text of a number or word.
    pub(super) fn scalar(&self) -> Option<&str> {
        match &self.content {
            Content::Scalar(text) => Some(text),
            _ => None,
        }
    }

    /// Returns the value as short text for a message.
    pub(super) fn shown(&self) -> String {
        match &self.content {
            Content::Scalar(text) => text.chars().take(40).collect(),
            Content::List(_, count) => format!("a list of {count}"),
            Content::Table(_) => "a table".to_owned(),
        }
    }

    /// Returns the number of nodes, this one included. The depth is limited by [`MAX_DEPTH`].
    fn count(&self) -> usize {
        match &self.content {
            Content::Scalar(_) => 1,
            Content::List(items, _) => 1 + items.iter().map(Self::count).sum::<usize>(),
            Content::Table(entries) => 1 + entries.iter().map(|(_, node)| node.count()).sum::<usize>(),
        }
    }

    /// Returns the depth of the nested lists and tables.
    fn depth(&self) -> usize {
        match &self.content {
            Content::Scalar(_) => 0,
            Content::List(items, _) => 1 + items.iter().map(Self::depth).max().unwrap_or(0),
            Content::Table(entries) => 1 + entries.iter().map(|(_, node)| node.depth()).max().unwrap_or(0),
        }
    }
}

/// Reads the text of a calibration.
///
/// # Errors
/// [`FileError::Io`]; [`FileError::Format`] for a compressed file and for bytes that are not UTF-8.
pub(super) fn read_text(path: &Path) -> Result<String, FileError> {
    let bytes =
        config::regular_file::read(path, MAX_BYTES).map_err(|source| FileError::io(path, "read", source))?;
    if bytes.starts_with(&[0x1f, 0x8b]) {
        return Err(refused(path, "it is compressed (gzip), expected YAML or JSON as text"));
    }
    String::from_utf8(bytes).map_err(|_| refused(path, "it is not text in UTF-8"))
}

/// Parses a text as a tree.
///
/// # Errors
/// [`FileError::Format`] for XML, for text that is neither YAML nor JSON, for a second document, and beyond
/// the limits of depth and size; [`FileError::Value`] for a key that is stated twice.
pub(super) fn parse(path: &Path, text: &str) -> Result<Node, FileError> {
    let text = text.trim_start_matches('\u{feff}');
    let start = text.trim_start();
    if start.starts_with("<?xml") || start.starts_with("<opencv_storage") {
        return Err(refused(
            path,
            "it is XML, expected YAML or JSON: OpenCV writes them to file names that end in .yaml, .yml or \
             .json",
        ));
    }
    let mut builder = Builder { path, open: Vec::new(), anchors: HashMap::new(), nodes: 0, root: None };
    for event in Parser::new_from_str(without_directive(text)) {
        let (event, span) = event.map_err(|error| {
            refused(path, format!("line {}: {}, as YAML or JSON", error.marker().line(), error.info()))
        })?;
        builder.add(event, span.start.line() as u64)?;
    }
    builder.root.ok_or_else(|| refused(path, "it is empty"))
}

/// Creates the error of a file that is no readable calibration.
pub(super) fn refused(path: &Path, reason: impl ToString) -> FileError {
    FileError::format(path, "calibration", reason)
}

/// Removes the first line's directive, with the line's end kept: OpenCV writes `%YAML:1.0`, which is no YAML.
fn without_directive(text: &str) -> &str {
    if text.starts_with("%YAML") {
        text.find('\n').and_then(|end| text.get(end..)).unwrap_or("")
    } else {
        text
    }
}

/// List or table whose end has not been read.
struct Open {
    node: Node,
    anchor: usize,
    /// Key of a table whose value has not been read, and its line.
    key: Option<(String, u64)>,
}

/// Tree under construction.
struct Builder<'a> {
    path: &'a Path,
    open: Vec<Open>,
    anchors: HashMap<usize, Node>,
    nodes: usize,
    root: Option<Node>,
}

impl Builder<'_> {
    /// Adds an event of the parser.
    fn add(&mut self, event: Event, line: u64) -> Result<(), FileError> {
        match event {
            Event::Scalar(text, _, anchor, _) => {
                // An empty document has no value: dumps of messages end with `---`.
                if self.open.is_empty() && self.root.is_some() && matches!(&*text, "" | "~" | "null") {
                    return Ok(());
                }
                self.close(Node { line, content: Content::Scalar(text.into_owned()) }, anchor)
            }
            Event::SequenceStart(anchor, _) => self.start(line, Content::List(Vec::new(), 0), anchor),
            Event::MappingStart(anchor, _) => self.start(line, Content::Table(Vec::new()), anchor),
            Event::SequenceEnd | Event::MappingEnd => match self.open.pop() {
                Some(open) => self.close(open.node, open.anchor),
                None => Ok(()),
            },
            Event::Alias(anchor) => self.repeat(line, anchor),
            Event::Nothing
            | Event::StreamStart
            | Event::StreamEnd
            | Event::DocumentStart(_)
            | Event::DocumentEnd => Ok(()),
        }
    }

    /// Opens a list or a table.
    fn start(&mut self, line: u64, content: Content, anchor: usize) -> Result<(), FileError> {
        if self.open.len() >= MAX_DEPTH {
            return Err(self.too_deep(line));
        }
        self.open.push(Open { node: Node { line, content }, anchor, key: None });
        Ok(())
    }

    /// Repeats the value of an anchor, within the limit of nodes.
    fn repeat(&mut self, line: u64, anchor: usize) -> Result<(), FileError> {
        let Some(node) = self.anchors.get(&anchor) else {
            return Err(refused(
                self.path,
                format!("line {line}: an alias repeats a value that contains it"),
            ));
        };
        if self.open.len() + node.depth() > MAX_DEPTH {
            return Err(self.too_deep(line));
        }
        let (node, count) = (node.clone(), node.count());
        self.count(line, count - 1)?;
        self.close(Node { line, ..node }, 0)
    }

    fn too_deep(&self, line: u64) -> FileError {
        refused(self.path, format!("line {line}: more than {MAX_DEPTH} nested lists and tables"))
    }

    /// Counts kept nodes.
    fn count(&mut self, line: u64, more: usize) -> Result<(), FileError> {
        self.nodes += more;
        if self.nodes > MAX_NODES {
            return Err(refused(self.path, format!("line {line}: more than {MAX_NODES} values")));
        }
        Ok(())
    }

    /// Adds a complete value to the list or table around it.
    fn close(&mut self, node: Node, anchor: usize) -> Result<(), FileError> {
        let line = node.line;
        self.count(line, 1)?;
        if anchor > 0 {
            self.count(line, node.count())?;
            self.anchors.insert(anchor, node.clone());
        }
        let Some(parent) = self.open.last_mut() else {
            if self.root.is_some() {
                return Err(refused(self.path, format!("line {line}: a second document, expected one")));
            }
            self.root = Some(node);
            return Ok(());
        };
        match &mut parent.node.content {
            Content::List(items, count) => {
                *count += 1;
                if items.len() < MAX_ITEMS {
                    items.push(node);
                } else {
                    // The value is dropped; so are its nodes of the count.
                    self.nodes = self.nodes.saturating_sub(node.count());
                }
                Ok(())
            }
            Content::Table(entries) => match (parent.key.take(), node.content) {
                (Some((key, line)), content) => {
                    entries.push((key, Node { line, content }));
                    Ok(())
                }
                (None, Content::Scalar(key)) => {
                    if entries.iter().any(|(earlier, _)| *earlier == key) {
                        let place = FileLocation::Line(line);
                        return Err(FileError::value(self.path, place, key, "stated twice", "one value"));
                    }
                    if entries.len() >= MAX_KEYS {
                        return Err(refused(self.path, format!("line {line}: more than {MAX_KEYS} keys")));
                    }
                    parent.key = Some((key, line));
                    Ok(())
                }
                (None, _) => Err(refused(self.path, format!("line {line}: a key is a list or a table"))),
            },
            Content::Scalar(_) => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use std::fmt::Write as _;

    use super::*;

    fn read(text: &str) -> Result<Node, String> {
        parse(Path::new("c.yaml"), text).map_err(|error| error.to_string())
    }

    #[test]
    fn opencv_yaml_and_json_are_trees_with_lines() {
        let yaml = "%YAML:1.0\n---\nmatrix: !!opencv-matrix\n   rows: 1\n   dt: \"2f\"\n   data: [ 1., .5,\n       -3e+02 ]\nempty: [ ]\n";
        let root = read(yaml).unwrap();
        let data = root.get("matrix").unwrap().get("data").unwrap();
        assert_eq!(data.line, 6);
        let Content::List(items, 3) = &data.content else { panic!("{data:?}") };
        assert_eq!(
            items.iter().map(|item| item.scalar().unwrap()).collect::<Vec<_>>(),
            ["1.", ".5", "-3e+02"]
        );
        assert_eq!(items[2].line, 7);
        let json = read("{\n\t\"matrix\": { \"type_id\":\"opencv-matrix\", \"rows\":1 } }").unwrap();
        assert_eq!(json.get("matrix").unwrap().get("rows").unwrap().scalar(), Some("1"));
        // Without a mark of the document, as OpenCV 2 writes it.
        assert_eq!(read("%YAML:1.0\na: 1\n").unwrap().get("a").unwrap().line, 2);
    }

    #[test]
    fn long_lists_are_counted_and_not_kept() {
        let root = read(&format!("a: [{}]\nb: 1\n", "[1, 2], ".repeat(200_000))).unwrap();
        let Content::List(items, count) = &root.get("a").unwrap().content else { panic!("no list") };
        assert_eq!((items.len(), *count), (MAX_ITEMS, 200_000));
    }

    #[test]
    fn an_alias_repeats_its_value() {
        let root = read("a: &x [1, 2]\nb: *x\n").unwrap();
        assert_eq!(root.get("a").unwrap().content, root.get("b").unwrap().content);
    }

    #[test]
    fn hostile_input_is_an_error() {
        let mut laughs = "a0: &a0 [ha, ha, ha, ha, ha, ha, ha, ha]\n".to_owned();
        for level in 1..12 {
            let list = format!("*a{}, ", level - 1).repeat(8);
            writeln!(laughs, "a{level}: &a{level} [{list}]").unwrap();
        }
        let check = |text: &str, part: &str| {
            let message = read(text).unwrap_err();
            assert!(message.contains(part) && message.starts_with("c.yaml"), "{part}: {message}");
        };
        check(&laughs, "more than 100000 values");
        check("a: &x [*x]", "line 1");
        check(&"[".repeat(100_000), "recursion limit exceeded");
        check(&"[".repeat(20), "more than 16 nested");
        check(&"- ".repeat(100_000), "more than 16 nested");
        check(&(0..2000).map(|key| format!("k{key}: 1\n")).collect::<String>(), "more than 1000 keys");
        check("a: 1\na: 2\n", "line 2: `a` is `stated twice`");
        check("[1, 2]: 3\n", "a key is a list");
        check("a: 1\n---\nb: 2\n", "a second document");
        check("<?xml version=\"1.0\"?><opencv_storage/>", "it is XML");
        check("", "it is empty");
        check("a: [1, 2\nb: 3\n", "as YAML or JSON");
        read("a: 1\n---\n").unwrap();
    }
}
