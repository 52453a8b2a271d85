//! Physics of the states of an orbit: neighbours must lie on one motion under gravity, but for manoeuvres.
//!
//! Two neighbouring states are propagated to the middle of the interval between them, where they differ by δr
//! and δv. A change of velocity within the interval, by an impulse at any time or by thrust, causes |δr| ≤
//! |δv| h/2 for an interval of h. So any larger δr is a position that is not the integral of the velocities.

use std::path::Path;

use files::FileError;
use hifitime::{Duration, Epoch};
use sim::truth::{EARTH_GM_KM3_S2, SampledSegment, State, StateSample};

use super::findings::{Findings, place};
use super::gravity::Gravity;
use super::slip::{Slip, is_missing};

/// Deviation of positions that is accepted, km: the noise of an orbit determination.
const POSITION_KM: f64 = 0.1;
/// Deviation of velocities that is accepted, km/s: the rounding of velocities, and the error of SGP4.
const VELOCITY_KM_S: f64 = 1e-3;
/// Part of the attraction that is accepted as unmodelled: mean elements leave out 1e-3 of it.
const GRAVITY_PART: f64 = 2e-3;
/// Deviation in units of the accepted one above which it is an error instead of a remark.
const ERROR_FACTOR: f64 = 10.0;
/// Change of velocity of a manoeuvre without a remark, km/s.
const MANOEUVRE_KM_S: f64 = 0.1;
/// Acceleration without a remark if it lasts, relative to the attraction.
const LASTING_PART: f64 = 0.02;
/// Smallest perigee distance of a plausible state, km; that of a state without velocity is 0.
const MIN_PERIGEE_KM: f64 = 1_000.0;
/// Largest speed at infinity of a plausible state, km/s.
const MAX_EXCESS_KM_S: f64 = 20.0;
/// Largest number of intervals with which slips are searched for.
const SEARCHED: usize = 32;

/// States that one interpolation uses, with their lines.
#[derive(Debug)]
pub(crate) struct MotionSegment {
    /// States, times in seconds since the epoch of the check.
    pub(crate) samples: SampledSegment,
    /// Lines of the states; empty for a file without lines.
    pub(crate) lines: Vec<u64>,
}

impl MotionSegment {
    fn line(&self, index: usize) -> Option<u64> {
        self.lines.get(index).copied()
    }

    fn states(&self) -> &[StateSample] {
        &self.samples.samples
    }
}

/// Deviations of two neighbouring states in the middle between them.
#[derive(Debug, Clone, Copy)]
struct Deviation {
    /// Duration of the interval, s.
    interval_s: f64,
    /// Part of the difference of the positions that no change of velocity explains, in units of the accepted
    /// one.
    position: f64,
    /// Difference of the positions, km.
    position_km: f64,
    /// Difference of the velocities, km/s.
    velocity_km_s: f64,
    /// Accepted difference of the velocities, km/s.
    accepted_km_s: f64,
    /// Attraction, km/s².
    attraction_km_s2: f64,
    /// Middle of the two propagated states.
    middle: State,
    /// Accepted difference of the positions, km.
    accepted_km: f64,
}

impl Deviation {
    /// Returns the deviation; `None` for states so far apart that the motion between them is not propagated.
    fn new(epoch: Epoch, first: &(f64, State), second: &(f64, State)) -> Option<Self> {
        let interval_s = second.0 - first.0;
        let half_s = 0.5 * interval_s;
        let distance_km = first.1.position_km.norm().max(second.1.position_km.norm());
        let time = epoch + Duration::from_seconds(first.0 + half_s);
        let gravity = Gravity::new(time, distance_km);
        let forward = gravity.propagate(&first.1, half_s)?;
        let backward = gravity.propagate(&second.1, -half_s)?;
        let attraction_km_s2 = gravity.acceleration(&forward.position_km).norm();
        let position_km = (forward.position_km - backward.position_km).norm();
        let velocity_km_s = (forward.velocity_km_s - backward.velocity_km_s).norm();
        let unmodelled_km_s2 = GRAVITY_PART * attraction_km_s2;
        let accepted_km = POSITION_KM + VELOCITY_KM_S * interval_s + unmodelled_km_s2 * half_s * half_s;
        let position = ((position_km - velocity_km_s * half_s) / accepted_km).max(0.0);
        Some(Self {
            interval_s,
            position: if position.is_nan() { f64::INFINITY } else { position },
            position_km,
            velocity_km_s,
            accepted_km_s: 2.0 * VELOCITY_KM_S + 2.0 * unmodelled_km_s2 * half_s,
            attraction_km_s2,
            middle: State {
                position_km: (forward.position_km + backward.position_km) * 0.5,
                velocity_km_s: (forward.velocity_km_s + backward.velocity_km_s) * 0.5,
            },
            accepted_km,
        })
    }

    fn between(epoch: Epoch, first: &StateSample, second: &StateSample) -> Option<Self> {
        Self::new(epoch, &(first.time_s, first.state), &(second.time_s, second.state))
    }

    fn is_broken(&self) -> bool {
        self.position > ERROR_FACTOR
    }

    /// Returns true for an acceleration that neither gravity nor a weak engine explains.
    fn is_accelerated(&self) -> bool {
        self.velocity_km_s > self.accepted_km_s + LASTING_PART * self.attraction_km_s2 * self.interval_s
    }

    /// Returns true for states of one motion without a manoeuvre.
    fn is_quiet(&self) -> bool {
        self.position_km <= self.accepted_km + self.velocity_km_s * 0.5 * self.interval_s
            && self.velocity_km_s <= self.accepted_km_s
    }
}

/// Checks the states of one spacecraft, times in seconds since `epoch`, ICRS axes: returns remarks.
///
/// # Errors
/// [`FileError::Value`] with the line for a state that no spacecraft has, a state that does not follow from
/// its neighbours, and a jump of kilometres between two segments.
pub(crate) fn check_motion(
    path: &Path,
    epoch: Epoch,
    segments: &[MotionSegment],
) -> Result<Vec<String>, FileError> {
    let mut findings = Findings::default();
    for segment in segments {
        check_states(path, segment, StateFault::is_certain, &mut findings);
        if findings.error.is_none() {
            check_neighbours(path, epoch, segment, &mut findings);
        }
        // The neighbours show the slip, which a single state does not.
        check_states(path, segment, |_| true, &mut findings);
    }
    for pair in segments.windows(2) {
        if let [earlier, later] = pair {
            check_border(path, earlier, later, &mut findings);
        }
    }
    findings.into_result()
}

/// `check_motion` of samples from a file without lines, such as a kernel.
///
/// # Errors
/// [`FileError::Value`] for states that no spacecraft has.
pub fn check_samples(path: &Path, epoch: Epoch, samples: SampledSegment) -> Result<Vec<String>, FileError> {
    check_motion(path, epoch, &[MotionSegment { samples, lines: Vec::new() }])
}

/// Fault of a single state that no spacecraft has.
#[derive(Debug)]
pub(crate) enum StateFault {
    /// The velocity is zero.
    MissingVelocity,
    /// The velocity is too large.
    TooFast {
        /// Speed, km/s.
        speed_km_s: f64,
    },
    /// The orbit falls to the Earth.
    Falling {
        /// Speed, km/s.
        speed_km_s: f64,
        /// Distance of the perigee from the Earth's centre, km.
        perigee_km: f64,
    },
}

impl StateFault {
    /// Returns true for a fault that has no other explanation than a slip of the velocity's unit.
    fn is_certain(&self) -> bool {
        !matches!(self, Self::Falling { .. })
    }

    /// Returns the value for a message.
    pub(crate) fn value(&self) -> String {
        match self {
            Self::MissingVelocity => "0 km/s".to_owned(),
            Self::TooFast { speed_km_s } => format!("{speed_km_s:.6} km/s"),
            Self::Falling { speed_km_s, perigee_km } => {
                format!("{speed_km_s:.6} km/s, a perigee {perigee_km:.3} km from the Earth's centre")
            }
        }
    }

    /// Returns the expected value for a message.
    pub(crate) fn expected(&self) -> &'static str {
        match self {
            Self::MissingVelocity => "the velocity of an orbit: the velocities are missing",
            Self::TooFast { .. } => {
                "a velocity of an orbit about the Earth, in km/s: m/s are 1000 times larger"
            }
            Self::Falling { .. } => {
                "a velocity of an orbit about the Earth, in km/s: velocities in another unit, or with \
                 components in another order, fall to the Earth"
            }
        }
    }
}

/// Returns the fault of a single state, if no spacecraft has the state.
pub(crate) fn implausible_state(state: &State) -> Option<StateFault> {
    let (distance_km, speed_km_s) = (state.position_km.norm(), state.velocity_km_s.norm());
    if is_missing(&state.velocity_km_s) {
        return Some(StateFault::MissingVelocity);
    }
    let energy = 0.5 * speed_km_s * speed_km_s - EARTH_GM_KM3_S2 / distance_km;
    if energy > 0.5 * MAX_EXCESS_KM_S * MAX_EXCESS_KM_S {
        return Some(StateFault::TooFast { speed_km_s });
    }
    let momentum = state.position_km.cross(&state.velocity_km_s).norm_squared() / EARTH_GM_KM3_S2;
    let eccentricity = (1.0 + 2.0 * energy * momentum / EARTH_GM_KM3_S2).max(0.0).sqrt();
    let perigee_km = momentum / (1.0 + eccentricity);
    let is_falling = perigee_km.is_nan() || perigee_km < MIN_PERIGEE_KM;
    is_falling.then_some(StateFault::Falling { speed_km_s, perigee_km })
}

/// Refuses the first state with one of the faults that count.
fn check_states(
    path: &Path,
    segment: &MotionSegment,
    counts: impl Fn(&StateFault) -> bool,
    findings: &mut Findings,
) {
    for (index, sample) in segment.states().iter().enumerate() {
        if let Some(fault) = implausible_state(&sample.state).filter(&counts) {
            let place = place(segment.line(index));
            let (value, expected) = (fault.value(), fault.expected());
            findings.refuse(FileError::value(path, place, "X_DOT, Y_DOT, Z_DOT", value, expected));
            return;
        }
    }
}

/// Checks each state of a segment against the state before, and the interpolation between them.
fn check_neighbours(path: &Path, epoch: Epoch, segment: &MotionSegment, findings: &mut Findings) {
    let samples = segment.states();
    let deviations: Vec<Option<Deviation>> = samples
        .windows(2)
        .map(|pair| match pair {
            [first, second] => Deviation::between(epoch, first, second),
            _ => None,
        })
        .collect();
    if let Some(index) = isolated_state(epoch, segment, &deviations) {
        report_isolated(path, segment, index, &deviations, findings);
        return;
    }
    if let Some(index) = deviations.iter().position(|deviation| deviation.is_some_and(|d| d.is_broken())) {
        report_broken(path, epoch, segment, index, &deviations, findings);
        return;
    }
    report_remarks(path, epoch, segment, &deviations, findings);
}

/// Returns the index of a state that its two neighbours contradict, while they agree with each other.
fn isolated_state(epoch: Epoch, segment: &MotionSegment, deviations: &[Option<Deviation>]) -> Option<usize> {
    let is_off = |deviation: &Deviation| {
        deviation.is_broken() || deviation.velocity_km_s > ERROR_FACTOR * deviation.accepted_km_s
    };
    segment.states().windows(3).zip(deviations.windows(2)).enumerate().find_map(|(index, (states, pair))| {
        let ([before, _, after], [Some(first), Some(second)]) = (states, pair) else { return None };
        let agree = || Deviation::between(epoch, before, after).is_some_and(|skip| skip.is_quiet());
        (is_off(first) && is_off(second) && agree()).then_some(index + 1)
    })
}

fn report_isolated(
    path: &Path,
    segment: &MotionSegment,
    index: usize,
    deviations: &[Option<Deviation>],
    findings: &mut Findings,
) {
    let Some(Some(deviation)) = deviations.get(index.saturating_sub(1)) else { return };
    let value = format!(
        "{:.3} km and {:.6} km/s off the motion under gravity of the states before and after",
        deviation.position_km, deviation.velocity_km_s
    );
    let expected = "a state on the motion of its neighbours, which agree with each other; likely slip: this \
                    state, or its time, is wrong";
    findings.refuse(FileError::value(path, place(segment.line(index)), "state", value, expected));
}

/// Reports a state whose position is not the integral of the velocities, with the likely slip.
fn report_broken(
    path: &Path,
    epoch: Epoch,
    segment: &MotionSegment,
    index: usize,
    deviations: &[Option<Deviation>],
    findings: &mut Findings,
) {
    let Some(Some(deviation)) = deviations.get(index) else { return };
    let before = segment.line(index).map_or(String::new(), |line| format!(" (line {line})"));
    let value = format!(
        "{:.3} km off the motion under gravity of the state{before} {} s earlier",
        deviation.position_km, deviation.interval_s
    );
    let slip = slip_of(epoch, segment).map_or_else(
        || "a jump between two states: a state, a time or a part of another orbit is wrong".to_owned(),
        |slip| slip.in_words().to_owned(),
    );
    let expected = format!(
        "positions that are the integral of the velocities, and accelerations of gravity but for manoeuvres; \
         likely slip: {slip}"
    );
    findings.refuse(FileError::value(path, place(segment.line(index + 1)), "state", value, expected));
}

/// Returns the slip that explains the implausible intervals of a segment.
fn slip_of(epoch: Epoch, segment: &MotionSegment) -> Option<Slip> {
    let states: Vec<(f64, State)> =
        segment.states().iter().take(SEARCHED + 1).map(|sample| (sample.time_s, sample.state)).collect();
    Slip::find(&states, |repaired| {
        repaired.windows(2).all(|pair| match pair {
            [first, second] => {
                Deviation::new(epoch, first, second).is_some_and(|deviation| deviation.is_quiet())
            }
            _ => false,
        })
    })
}

fn report_remarks(
    path: &Path,
    epoch: Epoch,
    segment: &MotionSegment,
    deviations: &[Option<Deviation>],
    findings: &mut Findings,
) {
    let known = || deviations.iter().enumerate().filter_map(|(index, d)| Some((index, d.as_ref()?)));
    if known().count() < deviations.len() {
        let text = "neighbouring states are more than three revolutions apart; the interpolation between them \
                    is no orbit";
        findings.remark(path, segment.line(0), text);
    }
    let accelerated = known().filter(|(_, deviation)| deviation.is_accelerated()).count();
    if accelerated >= 3 && 2 * accelerated > deviations.len() {
        report_lasting(path, epoch, segment, deviations, findings);
        return;
    }
    let by_position =
        |(_, a): &(usize, &Deviation), (_, b): &(usize, &Deviation)| a.position.total_cmp(&b.position);
    if let Some((index, worst)) = known().max_by(by_position).filter(|(_, worst)| worst.position > 1.0) {
        let text = format!(
            "the state is {:.3} km off the motion under gravity of the state before; positions and velocities \
             disagree",
            worst.position_km
        );
        findings.remark(path, segment.line(index + 1), &text);
    }
    let by_velocity = |(_, a): &(usize, &Deviation), (_, b): &(usize, &Deviation)| {
        a.velocity_km_s.total_cmp(&b.velocity_km_s)
    };
    let is_large = |deviation: &Deviation| deviation.velocity_km_s > MANOEUVRE_KM_S + deviation.accepted_km_s;
    if let Some((index, worst)) = known().max_by(by_velocity).filter(|(_, worst)| is_large(worst)) {
        let text = format!(
            "the velocity changes by {:.3} km/s since the state before, beyond gravity; a manoeuvre, or a \
             mistake",
            worst.velocity_km_s
        );
        findings.remark(path, segment.line(index + 1), &text);
    }
    report_interpolation(path, segment, deviations, findings);
}

/// Reports an acceleration in most of the intervals of a segment.
fn report_lasting(
    path: &Path,
    epoch: Epoch,
    segment: &MotionSegment,
    deviations: &[Option<Deviation>],
    findings: &mut Findings,
) {
    let ratio =
        |deviation: &Deviation| deviation.velocity_km_s / (deviation.interval_s * deviation.attraction_km_s2);
    let largest = deviations.iter().flatten().map(ratio).fold(0.0, f64::max);
    let value = format!("{:.1} % of the attraction beyond gravity in most intervals", 100.0 * largest);
    if let Some(slip) = slip_of(epoch, segment) {
        let expected = format!("motion under gravity but for manoeuvres; likely slip: {}", slip.in_words());
        findings.refuse(FileError::value(path, place(segment.line(0)), "acceleration", value, expected));
    } else {
        let text = format!("the acceleration has {value}: thrust all the time, or a mistake");
        findings.remark(path, segment.line(0), &text);
    }
}

/// Reports an interpolation that departs from the motion between two states.
fn report_interpolation(
    path: &Path,
    segment: &MotionSegment,
    deviations: &[Option<Deviation>],
    findings: &mut Findings,
) {
    let mut worst = (0, 0.0, 0.0);
    for (index, (pair, deviation)) in segment.states().windows(2).zip(deviations).enumerate() {
        let ([first, second], Some(deviation)) = (pair, deviation) else { continue };
        let middle_s = 0.5 * (first.time_s + second.time_s);
        let state = segment.samples.state_at(middle_s);
        let off_km = (state.position_km - deviation.middle.position_km).norm();
        let accepted_km = deviation.accepted_km + deviation.velocity_km_s * deviation.interval_s;
        if off_km > accepted_km && off_km > worst.1 {
            worst = (index, off_km, deviation.interval_s);
        }
    }
    let (index, off_km, interval_s) = worst;
    if off_km > 0.0 {
        let text = format!(
            "between this state and the next one, {interval_s} s later, the interpolation of degree {} is \
             {off_km:.3} km off the motion under gravity; states closer in time or a higher degree are needed",
            segment.samples.degree
        );
        findings.remark(path, segment.line(index), &text);
    }
}

/// Checks the jump from one segment to the next one.
fn check_border(path: &Path, earlier: &MotionSegment, later: &MotionSegment, findings: &mut Findings) {
    let ([_, end_s], [start_s, _]) = (earlier.samples.usable_s, later.samples.usable_s);
    if end_s < start_s {
        return;
    }
    let (before, after) = (earlier.samples.state_at(start_s), later.samples.state_at(start_s));
    let jump_km = (after.position_km - before.position_km).norm();
    let line = later.line(0);
    if jump_km > ERROR_FACTOR {
        let value = format!("a jump by {jump_km:.3} km");
        let expected = "the position that the segment before has at the same time";
        findings.refuse(FileError::value(path, place(line), "start of the segment", value, expected));
    } else if jump_km > POSITION_KM {
        let text = format!("at the start of the segment the position jumps by {jump_km:.3} km");
        findings.remark(path, line, &text);
    }
}
