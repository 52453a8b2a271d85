//! Writer of messages, the same calls for both notations.

use std::fmt::Write as _;

use super::kind::{Kind, Notation};

/// A message that is being written.
pub(crate) struct Writer {
    kind: Kind,
    notation: Notation,
    text: String,
}

/// Location of the schema for XML: that of OEM and OPM 2.0, AEM 1.0, TDM 2.0.
const SCHEMA: &str = "https://sanaregistry.org/r/ndmxml_unqualified/ndmxml-2.0.0-master-2.0.xsd";

impl Writer {
    pub(crate) fn new(kind: Kind, notation: Notation, version: &str) -> Self {
        let mut text = String::new();
        match notation {
            Notation::Kvn => text = format!("{} = {version}\n", kind.version_keyword()),
            Notation::Xml => {
                text.push_str("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n");
                let _ = writeln!(
                    text,
                    "<{} xmlns:xsi=\"http://www.w3.org/2001/XMLSchema-instance\" \
                     xsi:noNamespaceSchemaLocation=\"{SCHEMA}\" id=\"{}\" version=\"{version}\">",
                    kind.element(),
                    kind.version_keyword()
                );
            }
        }
        Self { kind, notation, text }
    }

    pub(crate) fn notation(&self) -> Notation {
        self.notation
    }

    /// Opens an element of XML; no text in KVN.
    pub(crate) fn open(&mut self, element: &str) {
        if self.notation == Notation::Xml {
            let _ = writeln!(self.text, "<{element}>");
        }
    }

    /// Closes an element of XML; no text in KVN.
    pub(crate) fn close(&mut self, element: &str) {
        if self.notation == Notation::Xml {
            let _ = writeln!(self.text, "</{element}>");
        }
    }

    /// Writes a line of KVN, such as a mark; no text in XML.
    pub(crate) fn line(&mut self, line: &str) {
        if self.notation == Notation::Kvn {
            let _ = writeln!(self.text, "{line}");
        }
    }

    /// Writes a comment.
    pub(crate) fn comment(&mut self, comment: &str) {
        for line in comment.lines().map(str::trim).filter(|line| !line.is_empty()) {
            match self.notation {
                Notation::Kvn => {
                    let _ = writeln!(self.text, "COMMENT {line}");
                }
                Notation::Xml => {
                    let _ = writeln!(self.text, "<COMMENT>{}</COMMENT>", escaped(line));
                }
            }
        }
    }

    /// Writes a keyword and its value. Line breaks of the value become spaces.
    pub(crate) fn value(&mut self, keyword: &str, value: impl ToString) {
        let value = one_line(&value.to_string());
        let _ = match self.notation {
            Notation::Kvn => writeln!(self.text, "{keyword} = {value}"),
            Notation::Xml => writeln!(self.text, "<{keyword}>{}</{keyword}>", escaped(&value)),
        };
    }

    /// Writes a keyword and its number with a unit.
    pub(crate) fn number(&mut self, keyword: &str, value: f64, unit: &str) {
        let _ = match (self.notation, unit) {
            (Notation::Kvn, "") => writeln!(self.text, "{keyword} = {value}"),
            (Notation::Kvn, unit) => writeln!(self.text, "{keyword} = {value} [{unit}]"),
            (Notation::Xml, "") => writeln!(self.text, "<{keyword}>{value}</{keyword}>"),
            (Notation::Xml, unit) => {
                writeln!(self.text, "<{keyword} units=\"{unit}\">{value}</{keyword}>")
            }
        };
    }

    /// Writes a keyword and its number in exponential form, with a unit.
    pub(crate) fn exponential(&mut self, keyword: &str, value: f64, unit: &str) {
        let _ = match self.notation {
            Notation::Kvn => writeln!(self.text, "{keyword} = {value:e} [{unit}]"),
            Notation::Xml => writeln!(self.text, "<{keyword} units=\"{unit}\">{value:e}</{keyword}>"),
        };
    }

    /// Returns the text of the message.
    pub(crate) fn finish(mut self) -> String {
        let element = self.kind.element();
        self.close(element);
        self.text
    }
}

fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// Escapes the characters of text that XML reserves; others that XML does not allow are left out.
fn escaped(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for character in text.chars() {
        match character {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            character if character.is_control() => {}
            character => escaped.push(character),
        }
    }
    escaped
}
