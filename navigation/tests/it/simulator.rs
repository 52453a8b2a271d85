//! Independent simulator of campaigns: both satellites are integrated numerically in Cartesian coordinates
//! with the acceleration of J2. It shares no dynamics with the navigators.

#![allow(dead_code, reason = "each program uses a part of it")]

use std::f64::consts::TAU;

use boresight_navigation::orbit::{GM_KM3_S2, J2, Orbit, RADIUS_KM, State};
use boresight_navigation::{Osculation, relative};
use contract::navigation::{
    AngleErrors, ChaserOrbit, Covariance6, DifferentialDrag, Event, LineOfSightErrors,
    LineOfSightMeasurement, ManoeuvreReport, NavigationSetup, PriorOrbit, RelativeElements, RelativeEstimate,
    ReportedState, SlowDisplacement, SlowError,
};
use contract::{Direction, Rotation};
use hifitime::{Epoch, Unit};
use nalgebra::{Vector3, Vector6};
use rand_distr::{Distribution, StandardNormal};
use rand_xoshiro::Xoshiro256PlusPlus;
use rand_xoshiro::rand_core::SeedableRng;

/// Step of the integration, s; all events are at its multiples.
pub(crate) const STEP_S: f64 = 5.0;

/// A campaign to simulate.
#[derive(Debug, Clone)]
pub(crate) struct Campaign {
    /// Mean orbit of the target at the epoch.
    pub(crate) target: Orbit,
    /// Expected relative elements at the epoch, and the σ of the prior, m.
    pub(crate) relative: RelativeElements,
    pub(crate) prior_sigma_m: Option<[f64; 6]>,
    /// Planned manoeuvres: seconds, (R, T, N) m/s.
    pub(crate) manoeuvres: Vec<(f64, [f64; 3])>,
    /// Errors of the manoeuvres: σ relative to the size and absolute, m/s.
    pub(crate) manoeuvre_sigma: (f64, f64),
    /// Times of the measurements, s: (first, interval, count).
    pub(crate) schedule: Vec<(f64, f64, usize)>,
    /// White, slow (per sinusoid, with periods) and constant errors, arcsec.
    pub(crate) white_arcsec: f64,
    pub(crate) slow: Vec<(f64, f64)>,
    /// Errors of the navigator's dynamics as angles, stated and not drawn: σ, arcsec, and period, s.
    pub(crate) theory: Vec<(f64, f64)>,
    /// First-order Gauss–Markov errors on each axis: σ, arcsec, and memory, s.
    pub(crate) irregular: Vec<(f64, f64)>,
    pub(crate) constant_arcsec: f64,
    /// Displacements of the measured point of the target.
    pub(crate) displacements: Vec<SlowDisplacement>,
    /// Fraction of measurements that are outliers, with errors of degrees.
    pub(crate) outliers: f64,
    /// Errors of the reported states of the chaser, m and m/s.
    pub(crate) state_sigma: (f64, f64),
    /// Rate of aδa, m per day, and its σ in the setup.
    pub(crate) drag_m_per_day: (f64, f64),
    /// Factor of all drawn errors, not of the stated ones.
    pub(crate) drawn: f64,
}

/// Simulated campaign.
pub(crate) struct Flight {
    pub(crate) setup: NavigationSetup,
    pub(crate) events: Vec<Event>,
    /// True relative states (position m, velocity in the rotating frame m/s) at multiples of the step.
    states: Vec<(State, State)>,
    pub(crate) true_relative: RelativeElements,
    pub(crate) true_manoeuvres: Vec<ManoeuvreReport>,
}

pub(crate) fn epoch() -> Epoch {
    Epoch::from_gregorian_utc_at_midnight(2012, 4, 23)
}

pub(crate) fn at(seconds: f64) -> Epoch {
    epoch() + Unit::Second * seconds
}

impl Campaign {
    /// ARGON's orbit, manoeuvres and schedule (`scenarios/argon.toml`), every `stride`-th measurement.
    pub(crate) fn argon(stride: usize) -> Self {
        let day = 86_400.0;
        let manoeuvres = vec![
            (31_490.0, [0.0, -0.01318, 0.0]),
            (34_485.0, [0.0, -0.00535, 0.0]),
            (day + 2_080.0, [0.0, 0.00445, 0.05393]),
            (day + 5_075.0, [0.0, -0.01363, 0.0]),
            (2.0 * day + 2_660.0, [0.0, -0.00943, -0.05554]),
            (2.0 * day + 5_655.0, [0.0, 0.01071, 0.0]),
            (2.0 * day + 80_645.0, [0.0, -0.00945, -0.05545]),
            (2.0 * day + 83_645.0, [0.0, 0.01298, 0.0]),
            (4.0 * day + 830.0, [0.0, 0.01335, 0.04505]),
            (4.0 * day + 3_825.0, [0.0, -0.0058, 0.0]),
        ];
        let days = [
            (25_200.0, 1634),
            (day + 21_600.0, 2978),
            (2.0 * day + 21_595.0, 3319),
            (3.0 * day + 1_800.0, 5415),
            (4.0 * day + 43_200.0, 2731),
        ];
        Self {
            target: Orbit {
                a_km: 7130.0,
                u: 0.0,
                ex: 0.0,
                ey: 0.003,
                i: 98.28_f64.to_radians(),
                raan: 126.4_f64.to_radians(),
            },
            relative: RelativeElements {
                a_dlambda_m: -32_000.0,
                a_dey_m: 400.0,
                a_diy_m: 400.0,
                ..RelativeElements::default()
            },
            prior_sigma_m: Some([1.0, 500.0, 30.0, 30.0, 30.0, 30.0]),
            manoeuvres,
            manoeuvre_sigma: (0.01, 5e-5),
            schedule: days
                .into_iter()
                .map(|(first, count)| (first, 15.0 * stride as f64, count / stride))
                .collect(),
            white_arcsec: 53.5,
            slow: vec![(20.0 / 2.0_f64.sqrt(), 5930.0), (20.0 / 2.0_f64.sqrt(), 3100.0)],
            theory: Vec::new(),
            irregular: Vec::new(),
            constant_arcsec: 20.0,
            displacements: Vec::new(),
            outliers: 0.0,
            state_sigma: (5.0, 0.02),
            drag_m_per_day: (0.0, 0.0),
            drawn: 1.0,
        }
    }

    /// Campaign of [`Campaign::argon`] with the errors of the built-in pipeline's best mode: centres of 1″ in
    /// axes from stars, and a centre of brightness that wanders by 7″ and repeats with the orbit by 2″. At
    /// this accuracy terms of second order in J2 count, which the navigator omits: 5 m with half and 4 m with
    /// a quarter of the period of the orbit for one satellite, 0.7″ for two.
    pub(crate) fn precise(stride: usize) -> Self {
        Self {
            white_arcsec: 1.0,
            slow: vec![(2.1, 5992.0)],
            theory: vec![(0.7, 2996.0), (0.7, 1498.0)],
            irregular: vec![(7.0, 5900.0)],
            constant_arcsec: 1.0,
            ..Self::argon(stride)
        }
    }

    /// Campaign of [`Campaign::precise`] with a centre of brightness that is displaced by centimetres instead
    /// of arcseconds: a constant part, one with the period of the orbit, and a remainder.
    pub(crate) fn displaced(stride: usize) -> Self {
        let part = |sigma: f64, memory_s: f64, period_s: Option<f64>| SlowDisplacement {
            sigma_m: [sigma; 2],
            memory_s,
            period_s,
        };
        Self {
            slow: Vec::new(),
            irregular: Vec::new(),
            displacements: vec![
                part(0.11, 5e6, None),
                part(0.12, 5e6, Some(5992.0)),
                part(0.05, 1000.0, None),
            ],
            ..Self::precise(stride)
        }
    }

    /// Flies the campaign with the draws of a seed.
    pub(crate) fn fly(&self, seed: u64) -> Flight {
        let mut stream = Xoshiro256PlusPlus::seed_from_u64(seed);
        let mut normal = || -> f64 {
            let drawn: f64 = StandardNormal.sample(&mut stream);
            self.drawn * drawn
        };
        // Truth: the relative orbit is drawn from the prior.
        let mut relative = self.relative.vector();
        if let Some(sigmas) = self.prior_sigma_m {
            relative += Vector6::from(sigmas).map(|sigma| sigma * normal());
        }
        let true_relative = RelativeElements::from_vector(&relative);
        let chaser = chaser_of(&self.target, &true_relative);
        let mut states =
            vec![(Osculation::FirstOrder.state(&chaser), Osculation::FirstOrder.state(&self.target))];
        let mut true_manoeuvres = Vec::new();
        let reports: Vec<ManoeuvreReport> = self
            .manoeuvres
            .iter()
            .map(|(seconds, dv)| {
                let dv = Vector3::from(*dv);
                let sigma = dv.map(|dv| libm::hypot(self.manoeuvre_sigma.0 * dv, self.manoeuvre_sigma.1));
                let flown = dv + sigma.map(|sigma| sigma * normal());
                let report = ManoeuvreReport { time: at(*seconds), dv_rtn_m_s: dv, sigma_rtn_m_s: sigma };
                true_manoeuvres.push(ManoeuvreReport { dv_rtn_m_s: flown, ..report });
                report
            })
            .collect();
        let last = self.schedule.iter().map(|(first, interval, n)| first + interval * *n as f64);
        let last = last.fold(0.0, f64::max) + 7200.0;
        let drag_km_s2 = {
            // aδȧ = 2 f_T/n, along the chaser's velocity.
            let n = self.target.mean_motion();
            0.5 * n * self.drag_m_per_day.0 / 86_400.0 * 1e-3
        };
        let mut index = 0;
        while (index as f64) * STEP_S < last {
            let (chaser, target) = states[index];
            let mut chaser = step(&chaser, drag_km_s2);
            let target = step(&target, 0.0);
            index += 1;
            for (k, (seconds, _)) in self.manoeuvres.iter().enumerate() {
                if (seconds / STEP_S).round() as usize == index {
                    let [r, t, n] = axes(&chaser);
                    let dv = true_manoeuvres[k].dv_rtn_m_s * 1e-3;
                    chaser.velocity_km_s += r * dv.x + t * dv.y + n * dv.z;
                }
            }
            states.push((chaser, target));
        }
        let arcsec = (1.0_f64 / 3600.0).to_radians();
        let lines: Vec<[f64; 4]> =
            self.slow.iter().map(|(sigma, _)| [0; 4].map(|_: i32| sigma * arcsec * normal())).collect();
        let constant = Vector3::new(normal(), normal(), normal()) * (self.constant_arcsec * arcsec);
        let mut events: Vec<Event> = reports.iter().map(|report| Event::Manoeuvre(*report)).collect();
        let mut wander = vec![[0.0; 2]; self.irregular.len()];
        let mut displaced: Vec<[[f64; 2]; 2]> = Vec::new();
        for displacement in &self.displacements {
            displaced.push(displacement.sigma_m.map(|sigma| [sigma * normal(), sigma * normal()]));
        }
        let mut previous_s = f64::NEG_INFINITY;
        let mut frame = 0;
        for (first, interval, count) in &self.schedule {
            for k in 0..*count {
                let seconds = first + interval * k as f64;
                for ((sigma, memory), value) in self.irregular.iter().zip(&mut wander) {
                    let decay = libm::exp((previous_s - seconds) / memory);
                    let fresh = sigma * arcsec * (1.0 - decay * decay).sqrt();
                    *value = value.map(|value| decay * value + fresh * normal());
                }
                for (displacement, states) in self.displacements.iter().zip(&mut displaced) {
                    let dt = (seconds - previous_s).min(1e9);
                    let decay = libm::exp(-dt / displacement.memory_s);
                    let (sin, cos) = libm::sincos(displacement.period_s.map_or(0.0, |p| TAU * dt / p));
                    for (state, sigma) in states.iter_mut().zip(displacement.sigma_m) {
                        let fresh = sigma * (1.0 - decay * decay).sqrt();
                        let turned = [cos * state[0] - sin * state[1], sin * state[0] + cos * state[1]];
                        *state = turned.map(|value| decay * value + fresh * normal());
                    }
                }
                previous_s = seconds;
                let (chaser, target) = &states[(seconds / STEP_S).round() as usize];
                let [r, t, n] = axes(chaser);
                // Boresight along the velocity, columns along −N, rows along −R.
                let camera: Rotation<_, _> = Rotation::from_axes(&-n, &-r, &t);
                let sight: Vector3<f64> = target.position_km - chaser.position_km;
                let los = camera.rotate(&sight);
                // A dispersed chaser may come too near or pass the target, which then leaves the image.
                if los.z < 0.94 * los.norm() {
                    continue;
                }
                let mut angles = [libm::atan2(los.x, los.z), libm::atan2(los.y, los.z)];
                for ((_, period), line) in self.slow.iter().zip(&lines) {
                    let (sin, cos) = libm::sincos(TAU * seconds / period);
                    angles[0] += line[0] * cos + line[1] * sin;
                    angles[1] += line[2] * cos + line[3] * sin;
                }
                for value in &wander {
                    angles = [angles[0] + value[0], angles[1] + value[1]];
                }
                for states in &displaced {
                    let [x, y] = [states[0][0], states[1][0]].map(|metres| metres * 1e-3 / los.norm());
                    angles = [angles[0] + x, angles[1] + y];
                }
                angles = angles.map(|angle| angle + self.white_arcsec * arcsec * normal());
                if libm::fabs(normal()) < outlier_threshold(self.outliers) {
                    angles = angles.map(|angle| angle + 0.05 * normal());
                }
                let measured = Vector3::new(libm::tan(angles[0]), libm::tan(angles[1]), 1.0);
                let measured = measured + constant.cross(&measured);
                let direction = camera.inverse().rotate(&measured);
                events.push(Event::LineOfSight(LineOfSightMeasurement {
                    frame,
                    time: at(seconds),
                    line_of_sight: Direction::from_vector(direction).expect("a direction"),
                    camera_from_icrs: camera,
                    covariance: None,
                    attitude_source: None,
                }));
                frame += 1;
            }
        }
        events.sort_by_key(Event::time);
        let reported: Vec<ReportedState> = states
            .iter()
            .enumerate()
            .step_by(24)
            .map(|(index, (chaser, _))| ReportedState {
                time: at(index as f64 * STEP_S),
                position_km: chaser.position_km
                    + Vector3::new(normal(), normal(), normal()) * (self.state_sigma.0 * 1e-3),
                velocity_km_s: chaser.velocity_km_s
                    + Vector3::new(normal(), normal(), normal()) * (self.state_sigma.1 * 1e-3),
                position_sigma_m: self.state_sigma.0,
                velocity_sigma_m_s: self.state_sigma.1,
            })
            .collect();
        let periodic = self.slow.iter().chain(&self.theory).map(|(sigma, period)| SlowError {
            sigma_arcsec: [*sigma; 2],
            memory_s: 1e8,
            period_s: Some(*period),
        });
        let irregular = self.irregular.iter().map(|(sigma, memory_s)| SlowError {
            sigma_arcsec: [*sigma; 2],
            memory_s: *memory_s,
            period_s: None,
        });
        let errors = AngleErrors {
            white_arcsec: [self.white_arcsec; 2],
            slow: periodic.chain(irregular).collect(),
            constant_arcsec: [self.constant_arcsec; 3],
        };
        let prior = self.prior_sigma_m.map(|sigmas| PriorOrbit {
            elements: self.relative,
            covariance: Covariance6::from_sigmas(sigmas).expect("positive"),
        });
        let setup = NavigationSetup {
            epoch: epoch(),
            chaser_orbit: ChaserOrbit::States(reported),
            camera_from_body: Rotation::identity(),
            prior,
            errors: LineOfSightErrors {
                with_stars: AngleErrors::default(),
                without_stars: errors,
                displacements: self.displacements.clone(),
            },
            drag: DifferentialDrag { a_da_rate_m_per_day: 0.0, sigma_m_per_day: self.drag_m_per_day.1 },
        };
        Flight { setup, events, states, true_relative, true_manoeuvres }
    }
}

impl Flight {
    /// True position, m, and velocity in the rotating frame, m/s, of the chaser in the target's R, T, N.
    pub(crate) fn truth(&self, seconds: f64) -> Vector6<f64> {
        let (chaser, target) = &self.states[(seconds / STEP_S).round() as usize];
        let axes = axes(target);
        let offset = (chaser.position_km - target.position_km) * 1000.0;
        let velocity = (chaser.velocity_km_s - target.velocity_km_s) * 1000.0;
        let momentum = target.position_km.cross(&target.velocity_km_s);
        let velocity = velocity - (momentum / target.position_km.norm_squared()).cross(&offset);
        let [x, y, z] = axes.map(|axis| axis.dot(&offset));
        let [u, v, w] = axes.map(|axis| axis.dot(&velocity));
        Vector6::new(x, y, z, u, v, w)
    }

    /// Errors of an estimate: estimated minus true.
    pub(crate) fn error(&self, estimate: &RelativeEstimate) -> Vector6<f64> {
        let (p, v) = (estimate.position_m, estimate.velocity_m_s);
        let seconds = (estimate.time - epoch()).to_seconds();
        Vector6::new(p.x, p.y, p.z, v.x, v.y, v.z) - self.truth(seconds)
    }
}

/// Threshold of a normal draw that a fraction of draws is below in absolute value, linear for small values.
fn outlier_threshold(fraction: f64) -> f64 {
    fraction * (TAU / 4.0).sqrt()
}

/// Chaser of relative elements: fixed-point iteration of the navigator's inverse map, which is tested alone.
fn chaser_of(target: &Orbit, elements: &RelativeElements) -> Orbit {
    let a_m = target.a_km * 1000.0;
    let (sin, cos) = libm::sincos(target.i);
    let raan = elements.a_diy_m / a_m / sin;
    let chaser = Orbit {
        a_km: target.a_km + elements.a_da_m * 1e-3,
        u: target.u + elements.a_dlambda_m / a_m - raan * cos,
        ex: target.ex + elements.a_dex_m / a_m,
        ey: target.ey + elements.a_dey_m / a_m,
        i: target.i + elements.a_dix_m / a_m,
        raan: target.raan + raan,
    };
    let back = relative::between(&chaser, target).vector() - elements.vector();
    assert!(back.norm() < 1e-6, "{back}");
    chaser
}

fn axes(state: &State) -> [Vector3<f64>; 3] {
    let r = state.position_km.normalize();
    let n = state.position_km.cross(&state.velocity_km_s).normalize();
    [r, n.cross(&r), n]
}

/// Acceleration of the oblate Earth (Vallado, *Fundamentals of Astrodynamics*, 8.7.1), and a constant one
/// along the velocity, km/s².
fn acceleration(r: &Vector3<f64>, v: &Vector3<f64>, along: f64) -> Vector3<f64> {
    let r2 = r.norm_squared();
    let r1 = r2.sqrt();
    let k = 1.5 * J2 * GM_KM3_S2 * RADIUS_KM * RADIUS_KM / (r2 * r2 * r1);
    let z2 = 5.0 * r.z * r.z / r2;
    -r * (GM_KM3_S2 / (r2 * r1))
        + Vector3::new(r.x * (z2 - 1.0), r.y * (z2 - 1.0), r.z * (z2 - 3.0)) * k
        + v.normalize() * along
}

/// One step of the classical Runge–Kutta method of fourth order.
fn step(state: &State, along: f64) -> State {
    let (r, v) = (state.position_km, state.velocity_km_s);
    let h = STEP_S;
    let f = |r: &Vector3<f64>, v: &Vector3<f64>| (*v, acceleration(r, v, along));
    let (a1, b1) = f(&r, &v);
    let (a2, b2) = f(&(r + a1 * (h / 2.0)), &(v + b1 * (h / 2.0)));
    let (a3, b3) = f(&(r + a2 * (h / 2.0)), &(v + b2 * (h / 2.0)));
    let (a4, b4) = f(&(r + a3 * h), &(v + b3 * h));
    State {
        position_km: r + (a1 + (a2 + a3) * 2.0 + a4) * (h / 6.0),
        velocity_km_s: v + (b1 + (b2 + b3) * 2.0 + b4) * (h / 6.0),
    }
}
