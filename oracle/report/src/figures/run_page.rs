//! Report of a run of any world: its figures and its verdicts.

use files::{Checksums, Failure};
use indexmap::IndexMap;
use run::world_of_run;
use serde_json::json;

use super::figure_table;
use super::words::display_name;
use crate::RunFiles;
use crate::page::data_table::DataTable;
use crate::page::{Page, Section};
use crate::verdict::figures::{judge, measured};
use crate::verdict::{Finding, Verdict, causes_sentence};

/// Reads the files of a run and returns its page.
///
/// # Errors
/// A [`Failure`] that names the file which is missing or cannot be read.
pub fn run_page(files: &RunFiles) -> Result<Page, Failure> {
    let path = files.path("run.toml");
    let world = world_of_run(&path)?;
    let run = world.read_run(&path)?;
    files.check(&[])?;
    let evidence = world.facts().evidence_file.and_then(|name| files.beside(name));
    let scored = world.score(&files.directory, &files.measurements, evidence.as_deref(), None)?;
    Checksums::check(&files.directory, |_| true)?;
    let units = scored.units().units;
    let mut counts: IndexMap<(&str, &str), u64> = IndexMap::new();
    for unit in &units {
        *counts.entry((unit.verdict.as_str(), unit.cause.as_deref().unwrap_or("–"))).or_default() += 1;
    }
    let mut verdicts = DataTable::new(["verdict", "cause", "count"]);
    for ((verdict, cause), count) in &counts {
        verdicts.push([display_name(verdict), display_name(cause), count.to_string()]);
    }
    let findings = with_causes(judge(&measured(scored.figures())), &counts);
    Ok(Page {
        title: run.scenario.title().to_owned(),
        kind: "Run",
        version: run.version,
        lead: vec![format!("{} {}s.", units.len(), world.image())],
        warnings: Vec::new(),
        verdict: Verdict::new(findings),
        facts: vec![
            ("Scenario", run.name),
            ("Seed", run.scenario.seed().to_string()),
            ("Configuration", run.hash.chars().take(12).collect()),
        ],
        sections: vec![
            Section::new("figures", "Figures").table(figure_table(scored.figures())),
            Section::new("verdicts", "Verdicts").table(verdicts),
        ],
        names_paper: false,
        data: json!(scored.figures()),
    })
}

/// Adds the causes of wrong and of missing answers to the findings on wrong and on correct answers.
fn with_causes(findings: Vec<Finding>, counts: &IndexMap<(&str, &str), u64>) -> Vec<Finding> {
    let of = |is_wanted: fn(&str) -> bool| -> IndexMap<String, u64> {
        let wanted = counts.iter().filter(|((verdict, cause), _)| is_wanted(verdict) && *cause != "–");
        wanted.map(|((_, cause), count)| ((*cause).to_owned(), *count)).collect()
    };
    let wrong = causes_sentence(&of(|verdict| verdict == "wrong"), display_name);
    let missed = causes_sentence(&of(|verdict| verdict == "missed"), display_name);
    let mut of_missed = Some(missed);
    findings
        .into_iter()
        .map(|finding| match finding.is_about_wrong_answers {
            true => finding.and(&wrong),
            // The first finding on other than wrong answers is that on correct ones.
            false => finding.and(&of_missed.take().unwrap_or_default()),
        })
        .collect()
}
