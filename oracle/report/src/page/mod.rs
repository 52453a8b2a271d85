//! The page: sections of text, tables, charts and pictures, as one HTML file that needs no network.

#[allow(clippy::indexing_slicing, reason = "indices are rows of tables that the readers have checked")]
pub mod colours;
pub mod data_table;
#[allow(clippy::indexing_slicing, reason = "indices are rows of tables that the readers have checked")]
pub mod picture;
pub mod plotly_js;
pub mod script_safe;

use askama::Template;
use files::Failure;
use serde_json::Value;

use crate::charts::chart::Chart;
use crate::page::data_table::DataTable;
use crate::page::picture::{Picture, Shape};
use crate::page::plotly_js::plotly_js;
use crate::page::script_safe::script_safe;

/// A report before it is formatted.
#[derive(Debug, Clone)]
pub struct Page {
    /// Title of the page.
    pub title: String,
    /// Kind of result that the page shows.
    pub kind: &'static str,
    /// Version of Boresight that made the result.
    pub version: String,
    /// Opening sentences.
    pub lead: Vec<String>,
    /// Warnings that apply to all results below.
    pub warnings: Vec<String>,
    /// Properties of the result, by name.
    pub facts: Vec<(&'static str, String)>,
    /// Sections in order.
    pub sections: Vec<Section>,
    /// Figures as in the file of the result, for programs that read the page.
    pub data: Value,
}

/// A section with a heading.
#[derive(Debug, Clone)]
pub struct Section {
    /// Anchor of the section.
    pub id: &'static str,
    /// Heading.
    pub title: String,
    /// Content of the section.
    pub blocks: Vec<Block>,
}

impl Section {
    /// Creates an empty section.
    pub fn new(id: &'static str, title: impl Into<String>) -> Self {
        Self { id, title: title.into(), blocks: Vec::new() }
    }

    /// Appends a paragraph.
    pub fn text(mut self, text: impl Into<String>) -> Self {
        self.blocks.push(Block::Text(text.into()));
        self
    }

    /// Appends a table.
    pub fn table(mut self, table: DataTable) -> Self {
        self.blocks.push(Block::Table(table));
        self
    }

    /// Appends a chart.
    pub fn chart(mut self, chart: Chart) -> Self {
        self.blocks.push(Block::Chart(Box::new(chart)));
        self
    }

    /// Appends small charts, two side by side.
    pub fn charts(mut self, charts: Vec<Chart>) -> Self {
        self.blocks.push(Block::Charts(charts));
        self
    }

    /// Appends a collapsed table under the heading `words`.
    pub fn folded(mut self, words: impl Into<String>, table: DataTable) -> Self {
        self.blocks.push(Block::Folded(words.into(), table));
        self
    }

    /// Appends links to other files.
    pub fn links(mut self, links: Vec<Link>) -> Self {
        self.blocks.push(Block::Links(links));
        self
    }

    /// Appends pictures side by side.
    pub fn pictures(mut self, pictures: Vec<Picture>) -> Self {
        self.blocks.push(Block::Pictures(pictures));
        self
    }
}

/// Link to another file.
#[derive(Debug, Clone)]
pub struct Link {
    /// Path of the file, relative to that of the page.
    pub path: String,
    /// Words of the link.
    pub words: String,
}

impl Link {
    /// Creates a link.
    pub fn new(path: impl Into<String>, words: impl Into<String>) -> Self {
        Self { path: path.into(), words: words.into() }
    }
}

/// One element of a section.
#[derive(Debug, Clone)]
pub enum Block {
    /// A paragraph.
    Text(String),
    /// A table.
    Table(DataTable),
    /// A chart and its data table.
    Chart(Box<Chart>),
    /// Small charts, two side by side where there is room.
    Charts(Vec<Chart>),
    /// A collapsed table that the reader can open, and its heading.
    Folded(String, DataTable),
    /// Links to other files, in one line.
    Links(Vec<Link>),
    /// Pictures side by side.
    Pictures(Vec<Picture>),
}

#[derive(Template)]
#[template(path = "report.html")]
struct PageTemplate<'a> {
    page: &'a Page,
    style: &'static str,
    script: &'static str,
    plotly: String,
    data: String,
}

impl Page {
    /// Returns the page as HTML. All text is escaped; the same page gives the same bytes.
    ///
    /// # Errors
    /// [`Failure::Usage`] when the page cannot be composed.
    pub fn html(&self) -> Result<String, Failure> {
        let failure = |error: &dyn std::fmt::Display| {
            Failure::Usage(format!("the report cannot be generated: {error}"))
        };
        let template = PageTemplate {
            page: self,
            style: include_str!("report.css"),
            script: include_str!("report.js"),
            plotly: plotly_js().map_err(|error| failure(&error))?,
            data: script_safe(&self.data.to_string()),
        };
        template.render().map_err(|error| failure(&error))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn page(title: &str) -> Page {
        Page {
            title: title.to_owned(),
            kind: "test",
            version: "0".to_owned(),
            lead: vec![title.to_owned()],
            warnings: Vec::new(),
            facts: vec![("name", title.to_owned())],
            sections: vec![
                Section::new("one", title).text(title).table(DataTable::new([title]).row([title])),
            ],
            data: serde_json::json!({ "title": title }),
        }
    }

    #[test]
    fn hostile_text_is_escaped_wherever_it_stands() {
        let html = page("</script><script>alert(1)</script>&\"'").html().unwrap();
        assert!(!html.contains("<script>alert(1)"), "a script of somebody else's");
        assert!(html.contains("alert(1)"), "the text itself is shown");
    }

    #[test]
    fn the_same_page_gives_the_same_bytes() {
        assert_eq!(page("a").html().unwrap(), page("a").html().unwrap());
    }
}
