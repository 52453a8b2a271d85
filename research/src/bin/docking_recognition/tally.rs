//! Results of the fields, counted by range and lens.

use std::collections::BTreeMap;
use std::fmt;

use contract::docking::{DockingOutcome, DockingSetup, DockingSolution};
use sim::docking::FieldTruth;

/// Upper limits of the range bins, m.
const LIMITS_M: [f64; 13] = [1.1, 1.5, 2.0, 3.0, 5.0, 10.0, 20.0, 30.0, 50.0, 100.0, 200.0, 350.0, 501.0];

/// Result of one field.
pub(crate) struct Entry {
    range_m: f64,
    focal_px: f64,
    is_whole: bool,
    answer: String,
    is_measured: bool,
    is_wrong: bool,
    /// Largest error in units of its σ; also for a solution with the range only.
    sigmas: f64,
    seconds: f64,
    is_first: bool,
    /// Number of shadowed marks that were used.
    shadowed_used: u32,
}

impl Entry {
    pub(crate) fn new(
        setup: &DockingSetup,
        truth: &FieldTruth,
        outcome: &DockingOutcome,
        seconds: f64,
        is_first: bool,
    ) -> Self {
        let range_m = truth.range_m;
        let (answer, is_wrong, sigmas) = match &outcome.solution {
            DockingSolution::Measured(measurement) => {
                let (best, true_pose) = (&measurement.best.pose, &truth.pose);
                let d = best.position_m - true_pose.position_m;
                let phi = best.phi_rad - true_pose.phi_rad;
                let sigma = measurement.best.covariance.diagonal().map(f64::sqrt);
                let sigmas = d
                    .iter()
                    .chain(phi.iter())
                    .zip(sigma.iter())
                    .map(|(e, s)| e.abs() / s)
                    .fold(0.0, f64::max);
                // Limits of a gross error in the oracle: range by 5 %, roll by 5°, tilt by 5° or by a pixel
                // of the cross, the larger of the two.
                let tilt_limit =
                    (range_m / (setup.cameras[truth.camera].focal_length_px().0 * 0.3)).max(0.087);
                let is_wrong = (best.position_m.norm() / range_m - 1.0).abs() > 0.05
                    || phi.z.abs() > 0.087
                    || libm::hypot(phi.x, phi.y) > tilt_limit;
                let text = format!(
                    "measured d3 {:+.4} %, lateral {:+.4} m, phi {:+.3} {:+.3} {:+.3} deg",
                    100.0 * d.z / range_m,
                    libm::hypot(d.x, d.y),
                    phi.x.to_degrees(),
                    phi.y.to_degrees(),
                    phi.z.to_degrees(),
                );
                (text, is_wrong, sigmas)
            }
            DockingSolution::RangeOnly { range_m: found, sigma_m } => {
                let error = found - truth.pose.position_m.z;
                let is_wrong = error.abs() > 0.2 * range_m;
                (format!("range only {error:+.2} m, sigma {sigma_m:.2} m"), is_wrong, error.abs() / sigma_m)
            }
            DockingSolution::Doubtful { doubt, .. } => (doubt.to_string(), false, 0.0),
            DockingSolution::NoSolution(reason) => (reason.to_string(), false, 0.0),
        };
        let shadowed_used = outcome
            .features
            .marks
            .iter()
            .filter(|mark| {
                mark.usage == contract::docking::MarkUse::Used && truth.marks_shadowed >> mark.index & 1 == 1
            })
            .count() as u32;
        Self {
            range_m,
            focal_px: setup.cameras[truth.camera].focal_length_px().0,
            is_whole: truth.target_in_field,
            is_measured: outcome.measurement().is_some(),
            answer,
            is_wrong,
            sigmas,
            seconds,
            is_first,
            shadowed_used,
        }
    }

    pub(crate) fn is_good(&self) -> bool {
        !self.is_wrong && (self.is_measured || self.answer.starts_with("range"))
    }
}

impl fmt::Display for Entry {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let whole = if self.is_whole { "whole" } else { "cut" };
        let wrong = if self.is_wrong { " WRONG" } else { "" };
        write!(
            f,
            "{:7.2} m {:4.0} px {whole} {} ({:.1} sigma){wrong} {:.1} ms",
            self.range_m,
            self.focal_px,
            self.answer,
            self.sigmas,
            1e3 * self.seconds
        )
    }
}

/// Counts of the fields.
#[derive(Default)]
pub(crate) struct Tally {
    entries: Vec<Entry>,
}

impl Tally {
    pub(crate) fn add(&mut self, entry: Entry) {
        self.entries.push(entry);
    }
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}

impl fmt::Display for Tally {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut groups: BTreeMap<(u32, bool, usize), Vec<&Entry>> = BTreeMap::new();
        for entry in &self.entries {
            let bin = LIMITS_M.iter().position(|limit| entry.range_m <= *limit).unwrap_or(LIMITS_M.len());
            groups.entry((entry.focal_px as u32, !entry.is_whole, bin)).or_default().push(entry);
        }
        writeln!(
            f,
            "lens  to m   field  fields measured  range wrong sigmas shadowed  ms first, next  reasons"
        )?;
        for ((focal_px, is_cut, bin), entries) in groups {
            let count = |what: &dyn Fn(&Entry) -> bool| entries.iter().filter(|e| what(e)).count();
            let mut reasons: BTreeMap<&str, usize> = BTreeMap::new();
            for entry in entries.iter().filter(|e| !e.is_good() && !e.is_wrong) {
                *reasons.entry(&entry.answer).or_default() += 1;
            }
            let time = |first: bool| {
                1e3 * median(entries.iter().filter(|e| e.is_first == first).map(|e| e.seconds).collect())
            };
            writeln!(
                f,
                "{focal_px} {:6.1} {:>7} {:6} {:8} {:6} {:5} {:6.1} {:8}  {:5.1} {:5.1}  {reasons:?}",
                LIMITS_M.get(bin).copied().unwrap_or(f64::INFINITY),
                if is_cut { "cut" } else { "whole" },
                entries.len(),
                count(&|e| e.is_measured),
                count(&|e| e.answer.starts_with("range")),
                count(&|e| e.is_wrong),
                median(entries.iter().filter(|e| e.sigmas > 0.0).map(|e| e.sigmas).collect()),
                entries.iter().map(|e| e.shadowed_used).sum::<u32>(),
                time(true),
                time(false),
            )?;
        }
        Ok(())
    }
}
