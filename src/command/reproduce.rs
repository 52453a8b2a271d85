//! `boresight reproduce`: the tables and figures of the papers whose methods are built in.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use files::Failure;

use super::Answer;
use super::options::{FrameRange, Selection, output_path};
use super::output::Output;
use super::run::{RunArguments, run};

#[derive(Debug, Args)]
pub(super) struct ReproduceArguments {
    /// Paper to reproduce
    #[arg(value_enum)]
    paper: Paper,
    /// A new or empty directory for the results; default: the next free `runs/PAPER-001`
    #[arg(short, long, value_name = "DIR", value_parser = output_path())]
    out: Option<PathBuf>,
    /// Only these frames (docking: fields), from A up to, but excluding, B. Published rows are left out if a
    /// day of the paper has no frame
    #[arg(long, value_name = "A..B")]
    frames: Option<FrameRange>,
    /// Threads that make frames; default: all cores. The results do not depend on the number of threads
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    jobs: Option<u16>,
    /// Write no report.html
    #[arg(long)]
    no_report: bool,
}

/// A paper whose method is built in.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Paper {
    /// Benninghoff, Tzschichholz, Boge and Gaias: far-range images of ARGON, 23 to 27 April 2012. Table 2
    /// with its published rows, Figs. 2 to 9
    Argon,
    /// Pose from a docking target on television: the paper's formulas beside the best estimator, Figs. 5
    /// and 6
    Docking,
}

impl Paper {
    /// Returns the scenario of the paper.
    fn scenario(self) -> &'static str {
        match self {
            Self::Argon => "argon",
            Self::Docking => "docking",
        }
    }

    /// Returns the remark on the comparison, printed below the table.
    fn remark(self) -> &'static str {
        match self {
            Self::Argon => {
                "The table is Table 2 of the far-range paper; its `RA` and `Dec` are `columns` and `rows` here. \
                 `published`: values of the paper. Above them: the method of 2012 on simulated images; twelve \
                 parameters of the scene are fitted to this table (docs/evidence/argon.md). `best mode`: today's built-in \
                 method on the same images. The report has the paper's Figs. 2 to 9."
            }
            Self::Docking => {
                "The docking paper prints no table of accuracy, so there are no published rows. Each error: best \
                 estimator / paper's formulas, on the same fields. The report has the paper's Figs. 5 and 6: \
                 parameters of the motion, and their accuracy."
            }
        }
    }
}

pub(super) fn reproduce(arguments: &ReproduceArguments, output: &Output) -> Result<Answer, Failure> {
    let paper = arguments.paper;
    let selection = Selection::for_scenario(paper.scenario(), arguments.frames.clone(), arguments.jobs);
    let note = Some(paper.remark());
    run(&RunArguments::for_paper(selection, arguments.out.clone(), arguments.no_report, note), output)
}
