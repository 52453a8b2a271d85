//! Numerically integrated orbits of chaser and target.
//!
//! Forces: the Earth's gravity field to degree and order 36 at most, Sun and Moon as point masses, drag,
//! radiation pressure of the Sun, thrust of the chaser. Not modelled: tides of the solid Earth and the
//! oceans, relativity, light of the Earth, attitude-dependent areas, solar and geomagnetic activity.
//!
//! The initial states are osculating. Steps are multiples of a constant from the initial state, divided at
//! manoeuvres and where the Earth's shadow begins and ends; they do not depend on the last time that is
//! needed, so a state is the same in every run of the same orbit. States between the steps are quintic
//! Hermite polynomials through position, velocity and acceleration at both ends: at 45 s in a low orbit
//! within 1e-5 m of the motion.

mod atmosphere;
mod forces;
mod gravity;
mod orientation;
mod runge_kutta;
mod sky;

use contract::{OutOfRange, bounds};
use hifitime::Epoch;
use nalgebra::Vector3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use self::forces::{Forces, Surfaces, Thrust};
use self::gravity::{GravityField, MAX_DEGREE};
use self::orientation::EarthOrientation;
pub use self::orientation::EarthOrientationConfig;
use self::sky::Sky;
use super::clock::format_utc;
use super::manoeuvre::Burn;
use super::orbit::{EGM96_RADIUS_KM, State};
use super::sampled::with_secular_drift;
use super::states::{States, seconds_between};
use crate::Switch;
use crate::memo::Memo;

/// Interval beyond the schedule that is integrated too, s: for times of telemetry and shutter control.
const MARGIN_S: f64 = 3_600.0;
/// Longest interval from the epoch, s: 100 days.
const MAX_SPAN_S: f64 = 100.0 * 86_400.0;
/// Number of parts of a step in which the Earth's shadow begins or ends.
const SHADOW_PARTS: u32 = 32;
/// Smallest distance from the Earth's centre, km: 100 km above the equator.
const LOWEST_KM: f64 = EGM96_RADIUS_KM + 100.0;

/// Forces of numerically integrated orbits.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct NumericalConfig {
    /// Step of the integration, s, 1 to 120.
    #[serde(default = "default_step_s")]
    #[schemars(range(min = 1, max = 120))]
    pub step_s: f64,
    /// Gravity field of the Earth.
    #[serde(default)]
    pub gravity: GravityConfig,
    /// Orientation of the Earth.
    #[serde(default)]
    pub earth: EarthOrientationConfig,
    /// Gravity of the Sun, "on" (the default) or "off".
    #[serde(default)]
    pub sun: Switch,
    /// Gravity of the Moon, "on" (the default) or "off".
    #[serde(default)]
    pub moon: Switch,
    /// Drag; absent: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub drag: Option<DragConfig>,
    /// Radiation pressure of the Sun; absent: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub radiation: Option<RadiationConfig>,
}

impl Default for NumericalConfig {
    fn default() -> Self {
        Self {
            step_s: default_step_s(),
            gravity: GravityConfig::default(),
            earth: EarthOrientationConfig::default(),
            sun: Switch::On,
            moon: Switch::On,
            drag: None,
            radiation: None,
        }
    }
}

fn default_step_s() -> f64 {
    45.0
}

/// Gravity field of the Earth: EGM96.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GravityConfig {
    /// Highest degree, 0 (a point mass) to 36.
    #[schemars(range(min = 0, max = MAX_DEGREE))]
    pub degree: u32,
    /// Highest order, 0 (zonal terms) to the degree.
    #[schemars(range(min = 0, max = MAX_DEGREE))]
    pub order: u32,
}

impl Default for GravityConfig {
    fn default() -> Self {
        Self { degree: 20, order: 20 }
    }
}

/// Drag in the atmosphere of Harris and Priester.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DragConfig {
    /// Drag coefficient times area over mass of the chaser, m²/kg, 0 to 10.
    #[schemars(range(min = 0, max = 10))]
    pub chaser_m2_kg: f64,
    /// Drag coefficient times area over mass of the target, m²/kg, 0 to 10.
    #[schemars(range(min = 0, max = 10))]
    pub target_m2_kg: f64,
    /// Exponent of the density's variation between day and night, from 2 (orbits of low inclination) to 6
    /// (polar orbits, the default).
    #[serde(default = "default_exponent")]
    #[schemars(range(min = 2, max = 6))]
    pub exponent: f64,
}

impl Default for DragConfig {
    /// No drag.
    fn default() -> Self {
        Self { chaser_m2_kg: 0.0, target_m2_kg: 0.0, exponent: default_exponent() }
    }
}

fn default_exponent() -> f64 {
    6.0
}

/// Radiation pressure of the Sun on a sphere.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RadiationConfig {
    /// Radiation pressure coefficient (1 for an absorbing sphere) times area over mass of the chaser, m²/kg,
    /// 0 to 10.
    #[schemars(range(min = 0, max = 10))]
    pub chaser_m2_kg: f64,
    /// Radiation pressure coefficient times area over mass of the target, m²/kg, 0 to 10.
    #[schemars(range(min = 0, max = 10))]
    pub target_m2_kg: f64,
}

impl NumericalConfig {
    /// Checks all values; `path` is that of the configuration.
    ///
    /// # Errors
    /// [`OutOfRange`] for the first invalid value.
    pub fn check(&self, path: &str) -> Result<(), OutOfRange> {
        bounds::check(self, path)?;
        let GravityConfig { degree, order } = self.gravity;
        if order > degree {
            let expected = format!("at most the degree, {degree}");
            return Err(OutOfRange::new(format!("{path}.gravity.order"), order, expected));
        }
        Ok(())
    }

    fn surfaces(&self, side: Side) -> Surfaces {
        let choose = |chaser, target| match side {
            Side::Chaser => chaser,
            Side::Target => target,
        };
        Surfaces {
            drag_m2_kg: self.drag.map_or(0.0, |drag| choose(drag.chaser_m2_kg, drag.target_m2_kg)),
            exponent: self.drag.map_or(default_exponent(), |drag| drag.exponent),
            radiation_m2_kg: self
                .radiation
                .map_or(0.0, |radiation| choose(radiation.chaser_m2_kg, radiation.target_m2_kg)),
        }
    }
}

/// Spacecraft of a pair.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Side {
    Chaser,
    Target,
}

/// State at the end of a step, with its acceleration.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Knot {
    time_s: f64,
    state: State,
    acceleration_km_s2: Vector3<f64>,
}

/// State from which an orbit is integrated.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct InitialState {
    /// Seconds since the epoch.
    pub(super) time_s: f64,
    /// State at that time.
    pub(super) state: State,
    /// Field of the configuration that gives the orbit, for messages.
    pub(super) path: &'static str,
}

/// States from which the orbits of both spacecraft are integrated.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct InitialStates {
    /// Epoch of the trajectory.
    pub(super) epoch: Epoch,
    /// Field of the configuration that gives the epoch, for messages.
    pub(super) epoch_path: &'static str,
    /// Chaser.
    pub(super) chaser: InitialState,
    /// Target.
    pub(super) target: InitialState,
}

/// Integrated orbits of both spacecraft.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct NumericalStates {
    /// Covered interval, seconds since the epoch.
    span_s: [f64; 2],
    /// In order of time; at a discontinuity two knots at the same time.
    chaser: Vec<Knot>,
    target: Vec<Knot>,
}

/// Cache of integrated orbits.
static INTEGRATED: Memo<(InitialStates, NumericalConfig, Vec<Burn>, [f64; 2]), NumericalStates> = Memo::new();

impl NumericalStates {
    /// Integrates the orbits for times from `first` to `last`, or returns the earlier result for equal
    /// arguments. `config` is checked; `burns` are the manoeuvres of the chaser as executed, in order of
    /// time, after its initial state.
    ///
    /// # Errors
    /// [`OutOfRange`] for a time that the ephemerides do not cover, or for an orbit that comes below 100 km.
    pub(super) fn compute(
        initial: &InitialStates,
        config: &NumericalConfig,
        burns: Vec<Burn>,
        [first, last]: [Epoch; 2],
    ) -> Result<std::sync::Arc<Self>, OutOfRange> {
        let InitialStates { epoch, chaser, target, .. } = initial;
        let (first_s, last_s) = (seconds_between(*epoch, first), seconds_between(*epoch, last));
        let span_s = [
            first_s.min(chaser.time_s).min(target.time_s) - MARGIN_S,
            last_s.max(chaser.time_s).max(target.time_s) + MARGIN_S,
        ];
        if span_s.iter().any(|time_s| time_s.abs() > MAX_SPAN_S) {
            return Err(OutOfRange::new(
                "schedule",
                format!("{} to {}", format_utc(first), format_utc(last)),
                format!("frames within 100 days of the epoch of the orbits, {}", format_utc(*epoch)),
            ));
        }
        let key = (*initial, config.clone(), burns, span_s);
        INTEGRATED
            .get(key, |(initial, config, burns, span_s)| Self::integrate(initial, config, burns, *span_s))
    }

    fn integrate(
        initial: &InitialStates,
        config: &NumericalConfig,
        burns: &[Burn],
        span_s: [f64; 2],
    ) -> Result<Self, OutOfRange> {
        let InitialStates { epoch, chaser, target, .. } = *initial;
        let orientation = EarthOrientation::new(&config.earth, epoch);
        orientation.check_covers(span_s)?;
        let sky = Sky::new(epoch, span_s)?;
        let GravityConfig { degree, order } = config.gravity;
        let arc = |side: Side, start: InitialState, burns: &[Burn]| {
            let forces = Forces {
                field: GravityField::new(degree as usize, order as usize),
                orientation: &orientation,
                sky: &sky,
                sun: config.sun,
                moon: config.moon,
                surfaces: config.surfaces(side),
            };
            Integration { forces, step_s: config.step_s, origin_s: 0.0, knots: Vec::new() }
                .run(start, burns, span_s)
                .map_err(|time_s| {
                    let side = if time_s < 0.0 { "before" } else { "after" };
                    let value =
                        format!("an orbit that comes below 100 km {:.0} s {side} the epoch", time_s.abs());
                    OutOfRange::new(start.path, value, "an orbit above 100 km until the end of the schedule")
                })
        };
        // Two threads: each orbit is a function of its own arguments, so the bits are the same as of one.
        let (chaser_knots, target_knots) = std::thread::scope(|scope| {
            let other = scope.spawn(|| arc(Side::Chaser, chaser, burns));
            let target_knots = arc(Side::Target, target, &[]);
            (other.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)), target_knots)
        });
        Ok(Self { span_s, chaser: chaser_knots?, target: target_knots? })
    }

    /// Integrated interval, seconds since the epoch.
    pub(super) fn coverage_s(&self) -> std::ops::RangeInclusive<f64> {
        let [start, end] = self.span_s;
        start..=end
    }

    /// States `time_s` seconds after the epoch; at an impulse, the states just after it. Outside the coverage
    /// the nearest state continues with secular drift.
    pub(super) fn states_at(&self, time_s: f64) -> States {
        let [start, end] = self.span_s;
        let inside = time_s.clamp(start, end);
        let at = |knots: &[Knot]| {
            let state = interpolated(knots, inside);
            if inside == time_s { state } else { with_secular_drift(state, time_s - inside) }
        };
        States { time_s, chaser: at(&self.chaser), target: at(&self.target) }
    }
}

/// Integration of one orbit.
struct Integration<'a> {
    forces: Forces<'a>,
    step_s: f64,
    /// Time of the initial state, seconds since the epoch.
    origin_s: f64,
    knots: Vec<Knot>,
}

impl Integration<'_> {
    /// Integrates from the initial state backward and forward; the error is the time at which the orbit comes
    /// below [`LOWEST_KM`]. The burns begin after the initial state.
    fn run(
        mut self,
        InitialState { time_s: origin_s, state, .. }: InitialState,
        burns: &[Burn],
        [start_s, end_s]: [f64; 2],
    ) -> Result<Vec<Knot>, f64> {
        self.origin_s = origin_s;
        self.begin(origin_s, state, None);
        let mut grid = 0.0;
        while self.last().time_s > start_s {
            grid -= 1.0;
            self.advance_to(self.grid_s(grid), None)?;
        }
        let mut knots = std::mem::take(&mut self.knots);
        knots.reverse();
        // The first knot is made again by the forward integration.
        knots.pop();

        self.begin(origin_s, state, None);
        // Number of the next time of the grid.
        let mut grid = 1.0;
        for burn in burns {
            if burn.start_s > end_s {
                break;
            }
            self.advance_over(&mut grid, burn.start_s, None)?;
            let Knot { time_s, state, .. } = self.last();
            if burn.duration_s > 0.0 {
                let acceleration_km_s2 = burn.dv_km_s / burn.duration_s;
                let thrust = Some(Thrust { axes: burn.axes, acceleration_km_s2 });
                self.begin(time_s, state, thrust);
                self.advance_over(&mut grid, burn.start_s + burn.duration_s, thrust)?;
                let Knot { time_s, state, .. } = self.last();
                self.begin(time_s, state, None);
            } else {
                let velocity_km_s = state.velocity_km_s + burn.axes.to_icrs(&state, &burn.dv_km_s);
                self.begin(time_s, State { velocity_km_s, ..state }, None);
            }
        }
        while self.last().time_s < end_s {
            self.advance_to(self.grid_s(grid), None)?;
            grid += 1.0;
        }
        knots.append(&mut self.knots);
        Ok(knots)
    }

    /// Time `number` steps after the initial state, seconds since the epoch.
    fn grid_s(&self, number: f64) -> f64 {
        self.origin_s + number * self.step_s
    }

    fn last(&self) -> Knot {
        self.knots.last().copied().unwrap_or(Knot {
            time_s: f64::NAN,
            state: State { position_km: Vector3::zeros(), velocity_km_s: Vector3::zeros() },
            acceleration_km_s2: Vector3::zeros(),
        })
    }

    /// Adds a knot from which the next step starts.
    fn begin(&mut self, time_s: f64, state: State, thrust: Option<Thrust>) {
        let acceleration_km_s2 = self.forces.acceleration(time_s, &state, thrust);
        self.knots.push(Knot { time_s, state, acceleration_km_s2 });
    }

    /// Steps along the grid to `time_s`, which need not be a time of the grid.
    fn advance_over(&mut self, grid: &mut f64, time_s: f64, thrust: Option<Thrust>) -> Result<(), f64> {
        while self.grid_s(*grid) < time_s {
            self.advance_to(self.grid_s(*grid), thrust)?;
            *grid += 1.0;
        }
        if self.last().time_s < time_s {
            self.advance_to(time_s, thrust)?;
        }
        if self.grid_s(*grid) == time_s {
            *grid += 1.0;
        }
        Ok(())
    }

    /// Advances to `time_s` in one step, or in [`SHADOW_PARTS`] if the shadow begins or ends in it.
    fn advance_to(&mut self, time_s: f64, thrust: Option<Thrust>) -> Result<(), f64> {
        let before = self.last();
        let after = self.step(&before, time_s, thrust)?;
        let middle = interpolated(&[before, after], 0.5 * (before.time_s + time_s));
        let fractions = [
            self.forces.sunlit(before.time_s, &before.state.position_km),
            self.forces.sunlit(0.5 * (before.time_s + time_s), &middle.position_km),
            self.forces.sunlit(time_s, &after.state.position_km),
        ];
        let steady = fractions.iter().all(|f| *f >= 1.0) || fractions.iter().all(|f| *f <= 0.0);
        if steady {
            self.knots.push(after);
            return Ok(());
        }
        let part_s = (time_s - before.time_s) / f64::from(SHADOW_PARTS);
        for part in 1..=SHADOW_PARTS {
            let end_s = if part == SHADOW_PARTS { time_s } else { before.time_s + f64::from(part) * part_s };
            let next = self.step(&self.last(), end_s, thrust)?;
            self.knots.push(next);
        }
        Ok(())
    }

    fn step(&mut self, from: &Knot, time_s: f64, thrust: Option<Thrust>) -> Result<Knot, f64> {
        let forces = &mut self.forces;
        let step_s = time_s - from.time_s;
        let state =
            runge_kutta::step(from.time_s, step_s, &from.state, from.acceleration_km_s2, |time_s, state| {
                forces.acceleration(time_s, state, thrust)
            });
        // The comparison is false for NaN.
        if state.position_km.norm() >= LOWEST_KM {
            let acceleration_km_s2 = forces.acceleration(time_s, &state, thrust);
            Ok(Knot { time_s, state, acceleration_km_s2 })
        } else {
            Err(time_s)
        }
    }
}

/// State between two knots: the quintic polynomial through position, velocity and acceleration at both, and
/// its derivative. At a discontinuity the later knot applies.
fn interpolated(knots: &[Knot], time_s: f64) -> State {
    let next = knots.partition_point(|knot| knot.time_s <= time_s).min(knots.len() - 1);
    let (a, b) = (&knots[next.saturating_sub(1)], &knots[next]);
    let h = b.time_s - a.time_s;
    if time_s <= a.time_s || h <= 0.0 {
        return a.state;
    }
    if time_s >= b.time_s {
        return b.state;
    }
    let s = (time_s - a.time_s) / h;
    // In powers of s relative to the motion of constant acceleration from a; the residuals at b determine the
    // coefficients of s³, s⁴ and s⁵.
    let (v0, a0) = (a.state.velocity_km_s * h, a.acceleration_km_s2 * (h * h));
    let position = b.state.position_km - a.state.position_km - v0 - a0 * 0.5;
    let velocity = b.state.velocity_km_s * h - v0 - a0;
    let acceleration = b.acceleration_km_s2 * (h * h) - a0;
    let c3 = position * 10.0 - velocity * 4.0 + acceleration * 0.5;
    let c4 = position * -15.0 + velocity * 7.0 - acceleration;
    let c5 = position * 6.0 - velocity * 3.0 + acceleration * 0.5;
    State {
        position_km: a.state.position_km + (v0 + (a0 * 0.5 + (c3 + (c4 + c5 * s) * s) * s) * s) * s,
        velocity_km_s: (v0 + (a0 + (c3 * 3.0 + (c4 * 4.0 + c5 * (5.0 * s)) * s) * s) * s) / h,
    }
}

#[cfg(test)]
mod tests;
