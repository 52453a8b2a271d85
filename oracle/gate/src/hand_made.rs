//! Hand-made test data: samples of consecutive, all correct frames of one day, and reports.
use std::sync::Once;

use docking::DockingMission;
use far_range::FarRangeMission;
use indexmap::IndexMap;
use run::ErasedWorld;
use score::{FigureTerms, Reduction, Term, UnitTable, UnitVerdict};
use toml::Table;

use crate::baseline::Baseline;
use crate::comparison::compare::compare;
use crate::comparison::options::CompareOptions;
use crate::identity::{Identity, Pairing, SourceKind};
use crate::report::{FigureReport, FigureVerdict, GateReport};
use crate::sample::Sample;

/// Registers the worlds whose figures the tests use, for the rest of the process.
pub(super) fn register_worlds() {
    static REGISTERED: Once = Once::new();
    REGISTERED.call_once(|| {
        run::register(&ErasedWorld::<FarRangeMission>::NEW);
        run::register(&ErasedWorld::<DockingMission>::NEW);
    });
}

pub(super) fn identity() -> Identity {
    register_worlds();
    Identity {
        kind: SourceKind::Run,
        world: "far_range".to_owned(),
        name: "made by hand".to_owned(),
        seed: 1,
        version: "0.1.0".to_owned(),
        catalog_sha256: None,
        inject: None,
        renderer: None,
        warm_up_frames: 0,
        scenario_sha256: "5".to_owned(),
        frames_sha256: "f".to_owned(),
        pipeline: Table::new(),
        scenario: Table::new(),
    }
}

pub(super) fn unit(number: u64, verdict: &str, cause: Option<&str>) -> UnitVerdict {
    UnitVerdict {
        number,
        group: "day 1".to_owned(),
        verdict: verdict.to_owned(),
        cause: cause.map(str::to_owned),
    }
}

/// A figure in which every unit has at most one value.
pub(super) fn figure(name: &str, reduction: Reduction, values: &[Option<f64>]) -> FigureTerms {
    register_worlds();
    let term = |value: &Option<f64>| value.map_or(Term::default(), |sum| Term { sum, count: 1 });
    FigureTerms::from_terms(name, reduction, values.iter().map(term).collect())
}

/// A sample with one frame per term of the figures.
pub(super) fn sample(figures: Vec<FigureTerms>) -> Sample {
    let count = figures.first().map_or(0, |figure| figure.terms.len() as u64);
    let units = (0..count).map(|number| unit(number, "correct", None)).collect();
    Sample { identity: identity(), table: UnitTable { units, figures } }
}

/// A report of figures with the given verdicts; the numbers are the same for every verdict.
pub(super) fn report(figures: &[(&str, FigureVerdict)]) -> GateReport {
    let of = |verdict| FigureReport {
        verdict,
        better: "more".to_owned(),
        baseline: Some(0.75),
        baseline_of: 24,
        result: Some(0.5),
        result_of: 24,
        difference: Some(-0.25),
        low: Some(-0.375),
        high: Some(-0.125),
        worse_by: Some(0.25),
        tolerance: 0.0,
        p: 0.015_625,
        adjusted_p: 0.031_25,
        attainable_p: 0.015_625,
        better_adjusted_p: 1.0,
        smallest_visible: None,
        blocks: 6,
        loss_run: None,
    };
    GateReport {
        verdict: FigureVerdict::Worse,
        accepted: None,
        name: identity().name,
        world: identity().world,
        reason: "a test".to_owned(),
        units: "frames".to_owned(),
        count: 24,
        pairing: Pairing::Frames,
        baseline_seed: 1,
        result_seed: 1,
        baseline_version: "0.1.0".to_owned(),
        result_version: "0.1.0".to_owned(),
        alpha: 0.05,
        blocks: 6,
        block_length: 4.0,
        neighbour_correlation: 0.0,
        notes: Vec::new(),
        figures: figures
            .iter()
            .map(|(name, verdict)| ((*name).to_owned(), of(*verdict)))
            .collect::<IndexMap<_, _>>(),
        flips: None,
    }
}

pub(super) fn rate(name: &str, bits: &[u8]) -> FigureTerms {
    figure(name, Reduction::Rate, &bits.iter().map(|bit| Some(f64::from(*bit))).collect::<Vec<_>>())
}

pub(super) fn hits(bits: &[u8]) -> Sample {
    sample(vec![rate("hit_rate", bits)])
}

/// A baseline with one frame per block.
pub(super) fn baseline(sample: Sample) -> Baseline {
    Baseline::new(sample, "a test", Some(1)).unwrap()
}

pub(super) fn compared(before: Sample, after: &Sample) -> GateReport {
    compare(&baseline(before), after, &CompareOptions::default()).unwrap()
}

pub(super) fn refusal(before: Sample, after: &Sample, options: &CompareOptions) -> String {
    compare(&baseline(before), after, options).unwrap_err().to_string()
}

/// Twelve frames; from `BEFORE` to `AFTER` eight are lost and one is won.
pub(super) const BEFORE: [u8; 12] = [1, 1, 1, 1, 1, 1, 1, 1, 0, 1, 1, 0];
pub(super) const AFTER: [u8; 12] = [0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 0];

/// Units in groups of the given sizes, numbered consecutively, all correct.
pub(super) fn days(groups: &[(&str, u64)]) -> UnitTable {
    register_worlds();
    let mut number = 0;
    let mut units = Vec::new();
    for (group, count) in groups {
        for _ in 0..*count {
            let (verdict, group) = ("correct".to_owned(), (*group).to_owned());
            units.push(UnitVerdict { number, group, verdict, cause: None });
            number += 1;
        }
    }
    UnitTable { units, figures: Vec::new() }
}
