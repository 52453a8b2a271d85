//! Absolute mean orbit of the chaser, to which relative elements are applied.
//!
//! An error of this orbit moves chaser and target together. It enters the relative position only as a
//! rotation and a scale: 100 m along the track are 1.4e-5 rad, 0.4 m at 30 km. So states are fitted piece by
//! piece, and steps between the pieces are accepted.

use contract::navigation::{ChaserOrbit, MeanElements, ReportedState};
use hifitime::Epoch;
use nalgebra::{SMatrix, SVector, Vector3};

use crate::orbit::{Orbit, State, wrap};
use crate::short_period::Osculation;
use crate::time::seconds_between;

/// Longest piece of the fit to reported states, s: errors of the secular model grow with it, the noise of
/// the fit shrinks.
const PIECE_S: f64 = 6.0 * 3600.0;

/// Shortest span of states that determines a piece, s; a shorter one continues its neighbour.
const MIN_SPAN_S: f64 = 600.0;

/// Largest number of states used in one piece.
const MAX_STATES: usize = 200;

/// Time after the first reported state until which states are used from the beginning, s.
const FIRST_S: f64 = 3600.0;

/// Time by which the orbit extends beyond the first and the last reported state, s.
const MARGIN_S: f64 = 3600.0;

/// Gauss–Newton iterations of a piece.
const ITERATIONS: usize = 6;

/// Relative size of truncated terms: about J2² of a low orbit.
const SECOND_ORDER: f64 = 1.0e-6;

/// Parameters of a piece: six elements and the rate of a.
const PARAMETERS: usize = 7;

/// Known impulse of the chaser.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Impulse {
    /// Time, s since the epoch.
    pub seconds: f64,
    /// Change of velocity along the chaser's R, T, N axes, m/s.
    pub dv_m_s: Vector3<f64>,
}

/// Mean orbit that applies from a time on.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Piece {
    /// Start of validity, s; the first piece also extends back.
    from_s: f64,
    /// Time of the elements, s.
    anchor_s: f64,
    orbit: Orbit,
    /// Rate of a due to drag, km/s.
    a_rate_km_s: f64,
    /// Accuracy of the position, relative to a.
    misfit: f64,
}

impl Piece {
    fn at(&self, seconds: f64) -> Orbit {
        let dt = seconds - self.anchor_s;
        let orbit = self.orbit.propagate(dt);
        // n changes by −3/2 (n/a) da; its integral is half the final change times the time.
        let da = self.a_rate_km_s * dt;
        let u = wrap(orbit.u - 0.75 * orbit.mean_motion() / orbit.a_km * da * dt);
        Orbit { a_km: orbit.a_km + da, u, ..orbit }
    }
}

/// Mean orbit of the chaser over time.
#[derive(Debug, Clone, PartialEq)]
pub struct Reference {
    pieces: Vec<Piece>,
    /// Times for which the orbit is known, s.
    known_s: (f64, f64),
    osculation: Osculation,
}

impl Reference {
    /// Builds the orbit from reported states or mean elements; `impulses` in order of time. `None` if there
    /// is no supported orbit.
    pub fn new(
        chaser: &ChaserOrbit,
        epoch: Epoch,
        impulses: &[Impulse],
        osculation: Osculation,
    ) -> Option<Self> {
        let (pieces, known_s) = match chaser {
            ChaserOrbit::Mean(elements) => {
                (of_elements(elements, impulses, osculation)?, (f64::NEG_INFINITY, f64::INFINITY))
            }
            ChaserOrbit::States(states) => {
                let states: Vec<TimedState> =
                    states.iter().map(|state| TimedState::new(state, epoch)).collect();
                let (first, last) = (states.first()?.seconds, states.last()?.seconds);
                (of_states(&states, impulses, osculation)?, (first - MARGIN_S, last + MARGIN_S))
            }
        };
        Some(Self { pieces, known_s, osculation })
    }

    /// Builds the orbit of a time span from the states within it, and at least those of the first hour that
    /// is reported. States after an impulse that is not known yet would bend the orbit before it.
    pub(crate) fn within(
        chaser: &ChaserOrbit,
        epoch: Epoch,
        impulses: &[Impulse],
        osculation: Osculation,
        (from_s, to_s): (f64, f64),
    ) -> Option<Self> {
        let ChaserOrbit::States(states) = chaser else {
            return Self::new(chaser, epoch, impulses, osculation);
        };
        let seconds = |state: &ReportedState| seconds_between(epoch, state.time);
        let to_s = to_s.max(seconds(states.first()?) + FIRST_S);
        let begin = states.partition_point(|state| seconds(state) < from_s).min(states.len() - 1);
        let end = states.partition_point(|state| seconds(state) <= to_s).max(begin + 1);
        let inside = impulses.iter().filter(|impulse| (from_s..=to_s).contains(&impulse.seconds));
        let inside: Vec<Impulse> = inside.copied().collect();
        Self::new(&ChaserOrbit::States(states[begin..end].to_vec()), epoch, &inside, osculation)
    }

    /// Returns the mean orbit at a time; at an impulse, that after it. `None` where it is unknown.
    pub fn orbit(&self, seconds: f64) -> Option<Orbit> {
        self.piece(seconds, |from_s| from_s <= seconds)
    }

    /// Returns the mean orbit just before an impulse at `seconds`.
    pub fn orbit_before(&self, seconds: f64) -> Option<Orbit> {
        self.piece(seconds, |from_s| from_s < seconds)
    }

    /// Returns the relative accuracy of a distance between two orbits near this one: truncated terms of
    /// second order in J2, and the rotation and scale by the misfit of the chaser's states.
    pub fn relative_accuracy(&self, seconds: f64) -> f64 {
        let index = self.pieces.partition_point(|piece| piece.from_s <= seconds).saturating_sub(1);
        let misfit = self.pieces.get(index).map_or(0.0, |piece| piece.misfit);
        libm::hypot(SECOND_ORDER, misfit)
    }

    /// Relation of mean elements and states.
    pub fn osculation(&self) -> Osculation {
        self.osculation
    }

    fn piece(&self, seconds: f64, begun: impl Fn(f64) -> bool) -> Option<Orbit> {
        if !(self.known_s.0..=self.known_s.1).contains(&seconds) {
            return None;
        }
        let index = self.pieces.partition_point(|piece| begun(piece.from_s)).saturating_sub(1);
        let orbit = self.pieces.get(index)?.at(seconds);
        orbit.is_supported().then_some(orbit)
    }
}

/// Returns the mean orbit after an impulse of `dv_m_s` along the R, T, N axes of the orbit itself.
pub(crate) fn kicked(orbit: &Orbit, dv_m_s: &Vector3<f64>, osculation: Osculation) -> Option<Orbit> {
    let state = osculation.state(orbit);
    let [r, t, n] = state.rtn_axes();
    let dv_km_s = (r * dv_m_s.x + t * dv_m_s.y + n * dv_m_s.z) * 1e-3;
    osculation.mean(&State { velocity_km_s: state.velocity_km_s + dv_km_s, ..state })
}

/// Returns the orbit of mean Keplerian elements.
pub fn orbit_of(elements: &MeanElements) -> Orbit {
    let perigee = elements.argument_of_perigee_deg.to_radians();
    let (sin, cos) = libm::sincos(perigee);
    Orbit {
        a_km: elements.semi_major_axis_km,
        u: wrap(perigee + elements.mean_anomaly_deg.to_radians()),
        ex: elements.eccentricity * cos,
        ey: elements.eccentricity * sin,
        i: elements.inclination_deg.to_radians(),
        raan: wrap(elements.raan_deg.to_radians()),
    }
}

fn of_elements(elements: &MeanElements, impulses: &[Impulse], osculation: Osculation) -> Option<Vec<Piece>> {
    let orbit = orbit_of(elements);
    orbit.is_supported().then_some(())?;
    let at_epoch = Piece { from_s: f64::NEG_INFINITY, anchor_s: 0.0, orbit, a_rate_km_s: 0.0, misfit: 0.0 };
    // The elements apply just after an impulse at the epoch.
    let (earlier, later) = impulses.split_at(impulses.partition_point(|impulse| impulse.seconds <= 0.0));
    let mut pieces = vec![at_epoch];
    for impulse in later {
        let before = pieces.last()?.at(impulse.seconds);
        let orbit = kicked(&before, &impulse.dv_m_s, osculation)?;
        pieces.push(Piece {
            from_s: impulse.seconds,
            anchor_s: impulse.seconds,
            orbit,
            a_rate_km_s: 0.0,
            misfit: 0.0,
        });
    }
    for impulse in earlier.iter().rev() {
        let first = pieces.first_mut()?;
        first.from_s = impulse.seconds;
        // The axes before and after differ by Δv/v: a second-order effect of micrometres per second.
        let orbit = kicked(&first.at(impulse.seconds), &-impulse.dv_m_s, osculation)?;
        pieces.insert(
            0,
            Piece {
                from_s: f64::NEG_INFINITY,
                anchor_s: impulse.seconds,
                orbit,
                a_rate_km_s: 0.0,
                misfit: 0.0,
            },
        );
    }
    Some(pieces)
}

/// Reported state with its time as seconds since the epoch.
struct TimedState {
    seconds: f64,
    state: State,
    position_sigma_km: f64,
    velocity_sigma_km_s: f64,
}

impl TimedState {
    fn new(reported: &ReportedState, epoch: Epoch) -> Self {
        Self {
            seconds: seconds_between(epoch, reported.time),
            state: State { position_km: reported.position_km, velocity_km_s: reported.velocity_km_s },
            position_sigma_km: reported.position_sigma_m * 1e-3,
            velocity_sigma_km_s: reported.velocity_sigma_m_s * 1e-3,
        }
    }
}

/// Fits pieces of at most [`PIECE_S`] between impulses.
fn of_states(states: &[TimedState], impulses: &[Impulse], osculation: Osculation) -> Option<Vec<Piece>> {
    let (first, last) = (states.first()?.seconds, states.last()?.seconds);
    let mut bounds: Vec<(f64, Option<Vector3<f64>>)> = vec![(f64::NEG_INFINITY, None)];
    bounds.extend(impulses.iter().map(|impulse| (impulse.seconds, Some(impulse.dv_m_s))));
    let mut pieces: Vec<Option<Piece>> = Vec::new();
    let mut starts = Vec::new();
    for (index, (from_s, dv)) in bounds.iter().enumerate() {
        let to_s = bounds.get(index + 1).map_or(f64::INFINITY, |(next, _)| *next);
        let (low, high) = (from_s.max(first), to_s.min(last));
        let count = ((high - low) / PIECE_S).ceil().max(1.0);
        let length = (high - low) / count;
        for k in 0..count as usize {
            let start = if k == 0 { *from_s } else { low + length * k as f64 };
            let (from, to) = (low + length * k as f64, low + length * (k + 1) as f64);
            starts.push((start, dv.filter(|_| k == 0)));
            // A state at an impulse is that after it; the last state belongs to the last piece.
            let within = |state: &&TimedState| {
                (from..to).contains(&state.seconds) || (to == last && state.seconds == last)
            };
            let inside: Vec<&TimedState> = states.iter().filter(within).collect();
            pieces.push(fit(&inside, start, osculation));
        }
    }
    // A span with too few states continues the nearest fitted piece, through the impulse between them.
    for index in 1..pieces.len() {
        if let (None, Some(before)) = (pieces[index], pieces[index - 1]) {
            pieces[index] = continued(&before, starts[index].0, starts[index].1, osculation);
        }
    }
    for index in (0..pieces.len().saturating_sub(1)).rev() {
        if let (None, Some(after)) = (pieces[index], pieces[index + 1]) {
            let dv = starts[index + 1].1.map(|dv| -dv);
            let from_s = starts[index].0;
            let at_s = starts[index + 1].0;
            pieces[index] = continued(&after, at_s, dv, osculation).map(|piece| Piece { from_s, ..piece });
        }
    }
    pieces.into_iter().collect()
}

fn continued(
    neighbour: &Piece,
    at_s: f64,
    dv: Option<Vector3<f64>>,
    osculation: Osculation,
) -> Option<Piece> {
    let orbit = neighbour.at(at_s);
    let orbit = match dv {
        Some(dv) => kicked(&orbit, &dv, osculation)?,
        None => orbit,
    };
    Some(Piece { from_s: at_s, anchor_s: at_s, orbit, ..*neighbour })
}

/// Fits mean elements and the rate of a to states by weighted least squares; `None` for too few states.
fn fit(states: &[&TimedState], from_s: f64, osculation: Osculation) -> Option<Piece> {
    let (first, last) = (states.first()?.seconds, states.last()?.seconds);
    if last - first < MIN_SPAN_S {
        return None;
    }
    let stride = states.len().div_ceil(MAX_STATES);
    let used: Vec<&&TimedState> = states.iter().step_by(stride).collect();
    let middle = used.get(used.len() / 2)?;
    let anchor_s = middle.seconds;
    let mut piece =
        Piece { from_s, anchor_s, orbit: osculation.mean(&middle.state)?, a_rate_km_s: 0.0, misfit: 0.0 };
    // Steps of the difference quotients, and the scale of the prior of the rate of a: 1 km per day.
    let steps = SVector::<f64, PARAMETERS>::from([1e-4, 1e-8, 1e-8, 1e-8, 1e-8, 1e-8, 1e-10]);
    let rate_sigma_km_s = 1.0 / 86_400.0;
    for _ in 0..ITERATIONS {
        let mut information = SMatrix::<f64, PARAMETERS, PARAMETERS>::zeros();
        let mut gradient = SVector::<f64, PARAMETERS>::zeros();
        information[(6, 6)] = 1.0 / (rate_sigma_km_s * rate_sigma_km_s);
        gradient[6] = -piece.a_rate_km_s * information[(6, 6)];
        for timed in &used {
            let weigh = |state: &State| {
                let position = (state.position_km - timed.state.position_km) / timed.position_sigma_km;
                let velocity = (state.velocity_km_s - timed.state.velocity_km_s) / timed.velocity_sigma_km_s;
                SVector::<f64, 6>::from_iterator(position.iter().chain(velocity.iter()).copied())
            };
            let residual = weigh(&osculation.state(&piece.at(timed.seconds)));
            let mut slopes = SMatrix::<f64, 6, PARAMETERS>::zeros();
            for column in 0..PARAMETERS {
                let mut step = SVector::<f64, PARAMETERS>::zeros();
                step[column] = steps[column];
                let moved = weigh(&osculation.state(&moved_by(&piece, &step).at(timed.seconds)));
                slopes.set_column(column, &((moved - residual) / steps[column]));
            }
            information += slopes.transpose() * slopes;
            gradient -= slopes.transpose() * residual;
        }
        // Scaled to unit diagonal: the units differ by 1e10.
        let scale = information.diagonal().map(|x| 1.0 / x.max(f64::MIN_POSITIVE).sqrt());
        let scaled = SMatrix::from_diagonal(&scale) * information * SMatrix::from_diagonal(&scale);
        let step = scaled.cholesky()?.solve(&gradient.component_mul(&scale)).component_mul(&scale);
        piece = moved_by(&piece, &step);
        if !piece.orbit.is_supported() {
            return None;
        }
        if step.component_div(&steps).abs().max() < 1e-3 {
            break;
        }
    }
    // The mean square residual above the noise is an error of the model. The fit keeps that share of the
    // noise which its parameters absorb.
    let mean_square = |value: &dyn Fn(&TimedState) -> f64| {
        used.iter().map(|timed| value(timed)).sum::<f64>() / used.len() as f64
    };
    let residual = mean_square(&|timed| {
        (osculation.state(&piece.at(timed.seconds)).position_km - timed.state.position_km).norm_squared()
    });
    let noise = mean_square(&|timed| 3.0 * timed.position_sigma_km * timed.position_sigma_km);
    let kept = noise * (PARAMETERS as f64 / (6 * used.len()) as f64);
    let misfit = ((residual - noise).max(0.0) + kept).sqrt() / piece.orbit.a_km;
    Some(Piece { misfit, ..piece })
}

fn moved_by(piece: &Piece, step: &SVector<f64, PARAMETERS>) -> Piece {
    let orbit = &piece.orbit;
    Piece {
        orbit: Orbit {
            a_km: orbit.a_km + step[0],
            u: wrap(orbit.u + step[1]),
            ex: orbit.ex + step[2],
            ey: orbit.ey + step[3],
            i: orbit.i + step[4],
            raan: wrap(orbit.raan + step[5]),
        },
        a_rate_km_s: piece.a_rate_km_s + step[6],
        ..*piece
    }
}
