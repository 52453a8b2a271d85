//! `measurements.csv` of a plain world: frame, status, columns of the answer.

use std::path::{Path, PathBuf};

use contract::Interface;
use files::{CsvLine, CsvReader, CsvRow, CsvWriter, FieldDeclaration, FileError, Table, table};

use super::{Answer, Plain, PlainWorld};
use crate::world::{Answers, paths};

/// Status of a frame with an answer; that of a failed pipeline is the reason.
const ANSWERED: &str = "answered";

table! {
    /// Columns before those of the answer.
    struct Head: csv {
        /// number of the frame; ascending, each once
        frame: u64,
        /// `answered`, or the reason of the pipeline's failure
        status: String,
    }
}

/// A row of `measurements.csv`.
struct AnswerLine<A> {
    frame: u64,
    answer: Answer<A>,
}

impl<A: Table> Table for AnswerLine<A> {
    fn declarations() -> Vec<FieldDeclaration> {
        let mut fields = Head::declarations();
        fields.extend(A::declarations());
        fields
    }
}

impl<A: CsvLine> CsvLine for AnswerLine<A> {
    fn cells(&self) -> Vec<String> {
        let status = self.answer.as_ref().err().map_or(ANSWERED, String::as_str).to_owned();
        let mut cells = Head { frame: self.frame, status }.cells();
        match &self.answer {
            Ok(answer) => cells.extend(answer.cells()),
            Err(_) => {
                cells.extend(A::declarations().iter().flat_map(|field| &field.names).map(|_| String::new()))
            }
        }
        cells
    }

    fn read(row: &CsvRow<'_>) -> Result<Self, FileError> {
        let Head { frame, status } = Head::read(row)?;
        let answer = if status == ANSWERED { Ok(A::read(row)?) } else { Err(status) };
        Ok(Self { frame, answer })
    }
}

/// Reads the answer to each frame, in ascending order.
pub(super) fn read_answers<A: CsvLine>(path: &Path) -> Result<Vec<(u64, Answer<A>)>, FileError> {
    CsvReader::open::<AnswerLine<A>>(path)?.read_rows(|row, previous: Option<&(u64, Answer<A>)>| {
        let line = AnswerLine::read(row)?;
        row.check_ascends("frame", line.frame, previous.map(|(frame, _)| *frame))?;
        Ok((line.frame, line.answer))
    })
}

/// Writes the answers of a pipeline.
pub struct PlainAnswers<P: PlainWorld>(CsvWriter<AnswerLine<P::Answer>>);

impl<P: PlainWorld> Answers<Plain<P>> for PlainAnswers<P> {
    const BESIDE: &'static [&'static str] = &[];

    fn create(files: &[PathBuf]) -> Result<Self, FileError> {
        let [measurements] = paths(files)?;
        CsvWriter::create(measurements).map(Self)
    }

    fn add(
        &mut self,
        frame: u64,
        (): &(),
        outcome: &<Plain<P> as Interface>::Outcome,
    ) -> Result<(), FileError> {
        self.0.line(&AnswerLine { frame, answer: outcome.clone() })
    }

    fn finish(self) -> Result<(), FileError> {
        self.0.finish()
    }
}
