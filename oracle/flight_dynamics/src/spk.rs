//! SPICE kernels of positions (SPK), read by the crate `anise`.

use std::collections::BTreeSet;
use std::fmt;
use std::path::Path;
use std::sync::Arc;

use anise::naif::SPK;
use anise::naif::daf::datatypes::{
    HermiteSetType12, HermiteSetType13, LagrangeSetType8, LagrangeSetType9, Type2ChebyshevSet,
    Type3ChebyshevSet,
    modified_diff::{ModifiedDiffType1, ModifiedDiffType21},
};
use anise::naif::daf::{DafDataType, NAIFDataSet, NAIFSummaryRecord};
use anise::naif::spk::summary::SPKSummaryRecord;
use files::{FileError, FileLocation};
use hifitime::Epoch;
use nalgebra::Vector3;
use sim::truth::{State, clock};

use crate::coverage::{BorderRule, Coverage};
use crate::frame::ReferenceFrame;
use crate::time::TimeSystem;

/// Largest file that is read.
const MAX_BYTES: u64 = 1 << 29;

/// NAIF's number of the Earth.
const EARTH: i32 = 399;
/// NAIF's number of the frame J2000, which SPICE treats as ICRF.
const J2000: i32 = 1;

/// Types of segments that are read.
const TYPES: [i32; 8] = [1, 2, 3, 8, 9, 12, 13, 21];

/// Motion of one body relative to the Earth, from a kernel.
///
/// Times are TDB in seconds since J2000.0, which a 64-bit number resolves to 0.06 µs: 0.5 mm along a low
/// orbit, the same for all spacecraft.
#[derive(Clone)]
pub struct Spk {
    kernel: Arc<SPK>,
    target: i32,
    /// Segments in order of time, without overlap but for common ends.
    segments: Arc<[KernelSegment]>,
}

#[derive(Debug, Clone, Copy)]
struct KernelSegment {
    summary: SPKSummaryRecord,
    /// Number of the segment in the file, from 1.
    number: usize,
    /// Record of summaries, and index in it.
    block: Option<usize>,
    index: usize,
    coverage: Coverage,
}

impl fmt::Debug for Spk {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Spk")
            .field("target", &self.target)
            .field("segments", &self.segments)
            .finish_non_exhaustive()
    }
}

impl Spk {
    /// Reads the segments of a body relative to the Earth, NAIF's number 399; without `target`, of the only
    /// body in the file.
    ///
    /// # Errors
    /// [`FileError`] for a file that is not an SPK, does not have the body, or has it relative to another
    /// centre, in another frame, in an unsupported type, or in overlapping segments.
    pub fn read(path: &Path, target: Option<i32>) -> Result<Self, FileError> {
        let bytes = config::regular_file::read(path, MAX_BYTES)
            .map_err(|source| FileError::io(path, "read", source))?;
        Self::parse(path, &bytes, target)
    }

    /// [`Spk::read`] for bytes in memory; `path` is for messages.
    ///
    /// # Errors
    /// See [`Spk::read`].
    pub fn parse(path: &Path, bytes: &[u8], target: Option<i32>) -> Result<Self, FileError> {
        let broken = |reason: String| FileError::format(path, "SPK", reason);
        if bytes.is_empty() {
            return Err(broken("it is empty".to_owned()));
        }
        if !bytes.starts_with(b"DAF/SPK") {
            return Err(broken("it does not begin with `DAF/SPK`".to_owned()));
        }
        let kernel = SPK::parse(bytes).map_err(|error| broken(error.to_string()))?;
        let mut summaries = Vec::new();
        let mut block = None;
        // `parse` has followed the chain of records to its end.
        loop {
            let records = kernel.data_summaries(block).map_err(|error| broken(error.to_string()))?;
            let filled = records.iter().enumerate().filter(|(_, summary)| !summary.is_empty());
            summaries.extend(filled.map(|(index, summary)| (*summary, block, index)));
            let record = kernel.daf_summary(block).map_err(|error| broken(error.to_string()))?;
            if record.is_final_record() || record.is_corrupt() {
                break;
            }
            block = Some(record.next_record());
        }
        let bodies: BTreeSet<i32> = summaries.iter().map(|(summary, ..)| summary.target_id).collect();
        let names = || bodies.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ");
        let target = match (target, bodies.iter().collect::<Vec<_>>().as_slice()) {
            (Some(target), _) if bodies.contains(&target) => target,
            (None, [only]) => **only,
            (stated, _) => {
                let value = stated.map_or_else(|| "not stated".to_owned(), |target| target.to_string());
                let expected = format!("NAIF's number of a body in the file: {}", names());
                return Err(FileError::value(path, FileLocation::Whole, "body", value, expected));
            }
        };
        let mut segments = Vec::with_capacity(summaries.len());
        for (number, (summary, block, index)) in (1..).zip(summaries) {
            if summary.target_id == target {
                segments.push(KernelSegment::new(path, summary, number, (block, index))?);
            }
        }
        segments.sort_by_key(|segment: &KernelSegment| segment.coverage.start);
        check_borders(path, &segments, BorderRule::NoOverlap)?;
        let spk = Self { kernel: Arc::new(kernel), target, segments: segments.into() };
        for segment in spk.segments.iter() {
            for time in [segment.coverage.start, segment.coverage.stop] {
                spk.evaluate(segment, time)
                    .map_err(|reason| broken(format!("{}: {reason}", segment.name())))?;
            }
        }
        Ok(spk)
    }

    /// Checks that each segment begins where the segment before ends.
    ///
    /// # Errors
    /// [`FileError::Value`] with segment and body; `path` is that of the file.
    pub fn check_no_gaps(&self, path: &Path) -> Result<(), FileError> {
        check_borders(path, &self.segments, BorderRule::NoGap)
    }

    /// NAIF's number of the body.
    pub fn target(&self) -> i32 {
        self.target
    }

    /// Spans that are covered, in order of time.
    pub fn coverage(&self) -> Vec<Coverage> {
        self.segments.iter().map(|segment| segment.coverage).collect()
    }

    /// Returns the state at `time`, ICRS axes; `None` outside the coverage.
    pub(crate) fn state_at(&self, time: Epoch) -> Option<State> {
        let is_inside =
            |segment: &&KernelSegment| segment.coverage.start <= time && time <= segment.coverage.stop;
        let segment = self.segments.iter().rev().find(is_inside)?;
        self.evaluate(segment, time).ok()
    }

    fn evaluate(&self, segment: &KernelSegment, time: Epoch) -> Result<State, String> {
        let summary = &segment.summary;
        let et_s = clock::tdb_j2000_s(time).clamp(summary.start_epoch_et_s, summary.end_epoch_et_s);
        let state = match summary.data_type().map_err(|error| error.to_string())? {
            DafDataType::Type1ModifiedDifferenceArray => self.state::<ModifiedDiffType1<'_>>(segment, et_s),
            DafDataType::Type2ChebyshevTriplet => self.state::<Type2ChebyshevSet<'_>>(segment, et_s),
            DafDataType::Type3ChebyshevSextuplet => self.state::<Type3ChebyshevSet<'_>>(segment, et_s),
            DafDataType::Type8LagrangeEqualStep => self.state::<LagrangeSetType8<'_>>(segment, et_s),
            DafDataType::Type9LagrangeUnequalStep => self.state::<LagrangeSetType9<'_>>(segment, et_s),
            DafDataType::Type12HermiteEqualStep => self.state::<HermiteSetType12<'_>>(segment, et_s),
            DafDataType::Type13HermiteUnequalStep => self.state::<HermiteSetType13<'_>>(segment, et_s),
            DafDataType::Type21ExtendedModifiedDifferenceArray => {
                self.state::<ModifiedDiffType21<'_>>(segment, et_s)
            }
            other => Err(format!("its type {other:?} is not read")),
        }?;
        let is_finite =
            state.position_km.iter().chain(&state.velocity_km_s).all(|component| component.is_finite());
        if is_finite { Ok(state) } else { Err("its states are not finite".to_owned()) }
    }

    fn state<'a, S>(&'a self, segment: &KernelSegment, et_s: f64) -> Result<State, String>
    where
        S: NAIFDataSet<'a, StateKind = (Vector3<f64>, Vector3<f64>)>,
    {
        let data: S =
            self.kernel.nth_data(segment.block, segment.index).map_err(|error| error.to_string())?;
        let (position_km, velocity_km_s) =
            data.evaluate(et_s, &segment.summary).map_err(|error| error.to_string())?;
        Ok(State { position_km, velocity_km_s })
    }
}

/// Checks the start of each segment of a body against the end of the segment before.
fn check_borders(path: &Path, segments: &[KernelSegment], rule: BorderRule) -> Result<(), FileError> {
    for pair in segments.windows(2) {
        let [earlier, later] = pair else { continue };
        if let Some(expected) = rule.broken_by(&earlier.coverage, &later.coverage, TimeSystem::Tdb) {
            let field = format!("start of {}, TDB", later.name());
            let value = TimeSystem::Tdb.format_time(later.coverage.start);
            return Err(FileError::value(path, FileLocation::Whole, field, value, expected));
        }
    }
    Ok(())
}

impl KernelSegment {
    fn new(
        path: &Path,
        summary: SPKSummaryRecord,
        number: usize,
        (block, index): (Option<usize>, usize),
    ) -> Result<Self, FileError> {
        let name = name_of(number, summary.target_id);
        let refused = |property: &str, value: String, expected: String| {
            let field = format!("{property} of {name}");
            Err(FileError::value(path, FileLocation::Whole, field, value, expected))
        };
        if summary.center_id != EARTH {
            return refused("centre", summary.center_id.to_string(), format!("{EARTH}, the Earth"));
        }
        if summary.frame_id != J2000 {
            let expected = format!("{J2000}, J2000 ({})", ReferenceFrame::Icrf.code());
            return refused("frame", summary.frame_id.to_string(), expected);
        }
        if !TYPES.contains(&summary.data_type_i) {
            let types = TYPES.map(|number| number.to_string()).join(", ");
            return refused("type", summary.data_type_i.to_string(), format!("one of {types}"));
        }
        let time = |et_s: f64| {
            // 1e10 s is 317 years: outside the range of times that are read.
            (et_s.abs() < 1e10).then(|| clock::from_tt_j2000_s(et_s - clock::tdb_minus_tt_s(et_s)))
        };
        match (time(summary.start_epoch_et_s), time(summary.end_epoch_et_s)) {
            (Some(start), Some(stop)) if start < stop => {
                Ok(Self { summary, number, block, index, coverage: Coverage { start, stop } })
            }
            _ => refused(
                "span, s of TDB since J2000.0,",
                format!("{} to {}", summary.start_epoch_et_s, summary.end_epoch_et_s),
                "a start before the end, both within 1e10 s".to_owned(),
            ),
        }
    }

    /// Name in messages.
    fn name(&self) -> String {
        name_of(self.number, self.summary.target_id)
    }
}

fn name_of(number: usize, body: i32) -> String {
    format!("segment {number} of the file (body {body})")
}
