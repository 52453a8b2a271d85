//! Output files of a pipeline: `measurements.csv` and `clusters.parquet`.

use std::path::PathBuf;

use contract::{AttitudeSource, FarRange, Outcome, Setup, Telemetry};
use files::{FileError, TableWriter};
use indexmap::IndexMap;
use pipeline::far_range::{UnmatchedFrame, find_mistake};
use run::AnswerSummary;
use run::world::{Answers, paths};

use crate::rows::{FrameCluster, MeasurementLine, MeasurementWriter};

/// Writes measurements, and the labels of clusters.
pub struct FrameAnswers {
    measurements: MeasurementWriter,
    clusters: TableWriter<FrameCluster>,
    attitudes: AttitudeCounts,
    /// First frames whose stars do not fit the inputs as stated, among those that have clusters enough.
    unmatched: Vec<UnmatchedFrame>,
}

/// Number of frames kept for the search for a mistake, and smallest number of clusters of such a frame.
const KEPT_FRAMES: usize = 8;
const KEPT_CLUSTERS: usize = 5;

impl Answers<FarRange> for FrameAnswers {
    const BESIDE: &'static [&'static str] = &["clusters.parquet"];

    fn create(files: &[PathBuf]) -> Result<Self, FileError> {
        let [measurements, clusters] = paths(files)?;
        Ok(Self {
            measurements: MeasurementWriter::create(measurements)?,
            clusters: TableWriter::create(clusters)?,
            attitudes: AttitudeCounts::default(),
            unmatched: Vec::new(),
        })
    }

    fn add(&mut self, frame: u64, telemetry: &Telemetry, outcome: &Outcome) -> Result<(), FileError> {
        self.measurements.line(&MeasurementLine::from_outcome(frame, outcome))?;
        self.attitudes.add(outcome.attitude_source);
        self.keep_unmatched(telemetry, outcome);
        self.clusters.write(outcome.clusters.iter().map(|&cluster| FrameCluster { frame, cluster }))
    }

    /// Adds what makes the stars fit, if they fit in fewer than half of the frames.
    fn summary(&self, setup: &Setup) -> Option<AnswerSummary> {
        let mut summary = self.attitudes.summary()?;
        if self.attitudes.are_mostly_unmatched()
            && let Some(mistake) = find_mistake(setup, &self.unmatched)
        {
            summary.text.push_str(&format!("\n{mistake}"));
        }
        Some(summary)
    }

    fn finish(self) -> Result<(), FileError> {
        self.clusters.finish()?;
        self.measurements.finish()
    }
}

impl FrameAnswers {
    fn keep_unmatched(&mut self, telemetry: &Telemetry, outcome: &Outcome) {
        use AttitudeSource::{NoMatch, NoStars, RescaledStars};
        let is_unmatched = matches!(outcome.attitude_source, Some(NoMatch | NoStars | RescaledStars));
        if !is_unmatched || outcome.clusters.len() < KEPT_CLUSTERS || self.unmatched.len() >= KEPT_FRAMES {
            return;
        }
        let sources = outcome.clusters.iter().map(|cluster| (cluster.position, cluster.size)).collect();
        self.unmatched.push(UnmatchedFrame { sources, body_from_icrs: telemetry.body_from_icrs });
    }
}

/// Counts of the sources of attitudes.
#[derive(Default)]
struct AttitudeCounts {
    frames: u64,
    stated: IndexMap<&'static str, u64>,
}

impl AttitudeCounts {
    fn add(&mut self, source: Option<AttitudeSource>) {
        self.frames += 1;
        if let Some(source) = source {
            *self.stated.entry(source.code()).or_default() += 1;
        }
    }

    /// Returns true if stars determine the attitude, with the inputs as stated, in fewer than half of the
    /// frames.
    fn are_mostly_unmatched(&self) -> bool {
        let of_stars = self.stated.get(AttitudeSource::Stars.code()).copied().unwrap_or(0);
        2 * of_stars < self.frames
    }

    /// Summarises the sources, for instance `attitude from stars in 5 of 8 frames; 2 with too few stars, 1
    /// without a match`; `None` if no outcome states a source.
    fn summary(&self) -> Option<AnswerSummary> {
        let count = |source: AttitudeSource| self.stated.get(source.code()).copied().unwrap_or(0);
        let others = AttitudeSource::ALL.into_iter().filter_map(|source| {
            let words = match source {
                AttitudeSource::Stars => return None,
                AttitudeSource::RescaledStars => "at another focal length",
                AttitudeSource::TooFewStars => "with too few stars",
                AttitudeSource::NoStars => "without a star",
                AttitudeSource::NoMatch => "without a match",
            };
            Some((count(source), words))
        });
        let unstated = self.frames - self.stated.values().sum::<u64>();
        let others: Vec<String> = others
            .chain([(unstated, "not stated")])
            .filter(|(count, _)| *count > 0)
            .map(|(count, words)| format!("{count} {words}"))
            .collect();
        let by_stars = count(AttitudeSource::Stars) + count(AttitudeSource::RescaledStars);
        let mut text = format!("attitude from stars in {by_stars} of {} frames", self.frames);
        if !others.is_empty() {
            text.push_str("; ");
            text.push_str(&others.join(", "));
        }
        let counts = AttitudeSource::ALL.map(|source| (source.code(), count(source))).into();
        (!self.stated.is_empty()).then_some(AnswerSummary { key: "attitude", counts, text })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn summary(sources: &[Option<AttitudeSource>]) -> Option<AnswerSummary> {
        let mut counts = AttitudeCounts::default();
        sources.iter().for_each(|source| counts.add(*source));
        counts.summary()
    }

    #[test]
    fn the_sources_of_the_attitude_are_reported_in_a_line() {
        use AttitudeSource::{NoMatch, NoStars, RescaledStars, Stars, TooFewStars};
        let sources = [Stars, TooFewStars, Stars, Stars, NoMatch, Stars, TooFewStars, Stars].map(Some);
        let summary_of_sources = summary(&sources).unwrap();
        assert_eq!(
            summary_of_sources.text,
            "attitude from stars in 5 of 8 frames; 2 with too few stars, 1 without a match"
        );
        assert_eq!(
            summary_of_sources.counts.into_iter().collect::<Vec<_>>(),
            [("stars", 5), ("rescaled_stars", 0), ("too_few_stars", 2), ("no_stars", 0), ("no_match", 1)]
        );
        let rescaled = summary(&[Stars, RescaledStars, NoMatch].map(Some)).unwrap();
        assert_eq!(
            rescaled.text,
            "attitude from stars in 2 of 3 frames; 1 at another focal length, 1 without a match"
        );
        assert_eq!(summary(&[Some(Stars)]).unwrap().text, "attitude from stars in 1 of 1 frames");
        let none = summary(&[Some(NoStars), None]).unwrap();
        assert_eq!(none.text, "attitude from stars in 0 of 2 frames; 1 without a star, 1 not stated");
        assert_eq!(summary(&[None, None]), None);
    }
}
