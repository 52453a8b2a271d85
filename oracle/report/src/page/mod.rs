//! The page: sections of text, tables, charts and pictures, as one HTML file that needs no network.

#[allow(clippy::indexing_slicing, reason = "indices are rows of tables that the readers have checked")]
pub mod colours;
pub mod data_table;
mod inline_code;
#[allow(clippy::indexing_slicing, reason = "indices are rows of tables that the readers have checked")]
pub mod picture;
pub mod plotly_js;
pub mod script_safe;

use askama::Template;
use files::Failure;
use serde_json::Value;

use crate::charts::chart::Chart;
use crate::figures::words::capital;
use crate::page::data_table::DataTable;
use crate::page::inline_code::with_inline_code;
use crate::page::picture::{Picture, Shape};
use crate::page::plotly_js::plotly_js;
use crate::page::script_safe::script_safe;
use crate::verdict::Verdict;

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
    /// What is good and what is not; without findings, the page has no verdict.
    pub verdict: Verdict,
    /// Properties of the result, by name.
    pub facts: Vec<(&'static str, String)>,
    /// Sections in order. A section without content is listed at the end with the reason, if it states one.
    pub sections: Vec<Section>,
    /// True if headings name the figure or table of a paper that the section reproduces.
    pub names_paper: bool,
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
    /// Figure or table of a paper that the section reproduces: `Fig. 5`.
    pub in_paper: Option<&'static str>,
    /// Reason why the section has no content.
    pub absent: Option<String>,
}

impl Section {
    /// Creates an empty section.
    pub fn new(id: &'static str, title: impl Into<String>) -> Self {
        Self { id, title: title.into(), blocks: Vec::new(), in_paper: None, absent: None }
    }

    /// Sets the figure or table of a paper that the section reproduces.
    pub fn in_paper(mut self, name: &'static str) -> Self {
        self.in_paper = Some(name);
        self
    }

    /// States why the section has no content. The page lists its title and the reason at the end.
    pub fn absent(mut self, reason: impl Into<String>) -> Self {
        self.absent = Some(reason.into());
        self
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
    sections: Vec<&'a Section>,
    left_out: Vec<(&'a str, &'a str)>,
    style: &'static str,
    script: &'static str,
    plotly: String,
    data: String,
}

impl PageTemplate<'_> {
    /// Returns a text as HTML, with its parts between backticks as code.
    fn rich(&self, text: &str) -> String {
        with_inline_code(text)
    }

    /// Returns a text with a capital first letter.
    fn capitalised(&self, text: &str) -> String {
        capital(text)
    }
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
            sections: self.sections.iter().filter(|section| !section.blocks.is_empty()).collect(),
            left_out: self.left_out(),
            style: include_str!("report.css"),
            script: include_str!("report.js"),
            plotly: plotly_js().map_err(|error| failure(&error))?,
            data: script_safe(&self.data.to_string()),
        };
        template.render().map_err(|error| failure(&error))
    }

    /// Returns title and reason of every section that has no content and states why.
    fn left_out(&self) -> Vec<(&str, &str)> {
        let empty = self.sections.iter().filter(|section| section.blocks.is_empty());
        empty.filter_map(|section| Some((section.title.as_str(), section.absent.as_deref()?))).collect()
    }

    /// Returns the heading of a section, with the paper's name of it if the page reproduces a paper.
    fn heading(&self, section: &Section) -> String {
        match section.in_paper.filter(|_| self.names_paper) {
            Some(name) => format!("{name}: {}", section.title),
            None => capital(&section.title),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::verdict::{Finding, Grade};

    fn page(title: &str) -> Page {
        Page {
            title: title.to_owned(),
            kind: "test",
            version: "0".to_owned(),
            lead: vec![title.to_owned()],
            warnings: Vec::new(),
            verdict: Verdict::new(vec![Finding::new(Grade::Fair, title, title)]),
            facts: vec![("name", title.to_owned())],
            sections: vec![
                Section::new("one", title).text(title).table(DataTable::new([title]).row([title])),
                Section::new("two", title).absent(title),
            ],
            names_paper: false,
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
    fn a_section_without_content_is_listed_with_its_reason() {
        let mut page = page("a");
        page.sections = vec![
            Section::new("full", "full").text("text"),
            Section::new("empty", "pictures").absent("no scenario"),
            Section::new("silent", "nothing"),
        ];
        let html = page.html().unwrap();
        assert!(html.contains("<dt>Pictures</dt><dd>no scenario</dd>"), "{html:.4000}");
        assert!(!html.contains("id=\"empty\"") && !html.contains("nothing"), "no empty section");
    }

    #[test]
    fn only_a_page_that_reproduces_a_paper_names_its_figures() {
        let mut page = page("a");
        page.sections = vec![Section::new("errors", "errors over time").in_paper("Fig. 5").text("text")];
        assert!(page.html().unwrap().contains("<h2>Errors over time</h2>"));
        page.names_paper = true;
        assert!(page.html().unwrap().contains("<h2>Fig. 5: errors over time</h2>"));
    }

    #[test]
    fn the_same_page_gives_the_same_bytes() {
        assert_eq!(page("a").html().unwrap(), page("a").html().unwrap());
    }
}
