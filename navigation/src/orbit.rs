//! Absolute orbits in quasi-nonsingular elements: secular drift due to the Earth's oblateness, states,
//! partial derivatives.
//!
//! The elements (a, u, ex, ey, i, Ω) with u = ω + M and (ex, ey) = e (cos ω, sin ω) are regular for circular
//! orbits and singular for equatorial ones.

use nalgebra::{Matrix3x6, Vector3};

/// Gravitational parameter of the Earth, km³/s² (EGM96: Lemoine et al., NASA/TP-1998-206861).
pub const GM_KM3_S2: f64 = 398_600.441_5;

/// Reference radius of the gravity field, km (EGM96).
pub const RADIUS_KM: f64 = 6_378.136_3;

/// Oblateness of the Earth J2 (EGM96).
pub const J2: f64 = 1.082_626_683_5e-3;

/// Smallest sine of the inclination; below it the node is undefined.
const MIN_SIN_INCLINATION: f64 = 1e-4;

/// Iterations of Newton's method for Kepler's equation.
const KEPLER_ITERATIONS: usize = 30;

/// Wraps an angle to [−π, π].
pub(crate) fn wrap(angle: f64) -> f64 {
    libm::remainder(angle, std::f64::consts::TAU)
}

/// Quasi-nonsingular elements of a geocentric orbit at an instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Orbit {
    /// Semi-major axis a, km.
    pub a_km: f64,
    /// Mean argument of latitude u = ω + M, rad.
    pub u: f64,
    /// Eccentricity vector towards the node, e cos ω.
    pub ex: f64,
    /// Eccentricity vector 90° from the node, e sin ω.
    pub ey: f64,
    /// Inclination i, rad.
    pub i: f64,
    /// Right ascension of the ascending node Ω, rad.
    pub raan: f64,
}

/// Position, km, and velocity, km/s, relative to the Earth's centre, inertial axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct State {
    /// Position, km.
    pub position_km: Vector3<f64>,
    /// Velocity, km/s.
    pub velocity_km_s: Vector3<f64>,
}

/// Secular rates, rad/s.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SecularRates {
    /// Rate of the node Ω.
    pub raan: f64,
    /// Rate of the argument of perigee ω.
    pub perigee: f64,
    /// Rate of the mean argument of latitude u, mean motion included.
    pub u: f64,
}

/// Orbit axes and in-plane quantities, shared by state and partial derivatives.
struct Plane {
    node: Vector3<f64>,
    across: Vector3<f64>,
    normal: Vector3<f64>,
    sin_f: f64,
    cos_f: f64,
    beta: f64,
    a_over_r: f64,
}

impl Orbit {
    /// Mean motion n = √(GM/a³), rad/s.
    pub fn mean_motion(&self) -> f64 {
        (GM_KM3_S2 / (self.a_km * self.a_km * self.a_km)).sqrt()
    }

    /// Squared eccentricity.
    fn e2(&self) -> f64 {
        self.ex * self.ex + self.ey * self.ey
    }

    /// Returns true if the orbit is an ellipse above the ground, not equatorial, and all numbers are finite.
    pub fn is_supported(&self) -> bool {
        let e2 = self.e2();
        let finite = [self.a_km, self.u, self.ex, self.ey, self.i, self.raan].iter().all(|x| x.is_finite());
        finite
            && e2 < 0.81
            && self.a_km * (1.0 - e2.sqrt()) > RADIUS_KM
            && libm::sin(self.i) >= MIN_SIN_INCLINATION
    }

    /// Factor γ = 3/2 J2 (R/p)² n of the secular rates, rad/s.
    pub(crate) fn gamma(&self) -> f64 {
        let over_p = RADIUS_KM / (self.a_km * (1.0 - self.e2()));
        1.5 * J2 * over_p * over_p * self.mean_motion()
    }

    /// Secular rates of first order in J2 (Brouwer 1959, AJ 64, 378; Vallado, *Fundamentals of Astrodynamics
    /// and Applications*, 4th ed., 9.6): Ω' = −γ cos i, ω' = γ (2 − 5/2 sin² i), M' = n + γ η
    /// (1 − 3/2 sin² i) with η² = 1 − e².
    pub fn secular_rates(&self) -> SecularRates {
        let gamma = self.gamma();
        let (sin_i, cos_i) = libm::sincos(self.i);
        let sin2 = sin_i * sin_i;
        let perigee = gamma * (2.0 - 2.5 * sin2);
        let eta = (1.0 - self.e2()).sqrt();
        let anomaly = self.mean_motion() + gamma * eta * (1.0 - 1.5 * sin2);
        SecularRates { raan: -gamma * cos_i, perigee, u: perigee + anomaly }
    }

    /// Returns the mean elements `seconds` later.
    pub fn propagate(&self, seconds: f64) -> Self {
        let rates = self.secular_rates();
        let (sin, cos) = libm::sincos(rates.perigee * seconds);
        Self {
            u: wrap(self.u + rates.u * seconds),
            ex: cos * self.ex - sin * self.ey,
            ey: sin * self.ex + cos * self.ey,
            raan: wrap(self.raan + rates.raan * seconds),
            ..*self
        }
    }

    /// Solves Kepler's equation u = F − ex sin F + ey cos F for the eccentric argument of latitude F
    /// (Broucke and Cefola 1972, Celestial Mechanics 5, 303).
    fn eccentric_argument(&self) -> f64 {
        let mut f = self.u;
        for _ in 0..KEPLER_ITERATIONS {
            let (sin, cos) = libm::sincos(f);
            let step = (f - self.ex * sin + self.ey * cos - self.u) / (1.0 - self.ex * cos - self.ey * sin);
            f -= step;
            if step.abs() < 1e-15 * (1.0 + f.abs()) {
                break;
            }
        }
        f
    }

    fn plane(&self) -> Plane {
        let (sin_raan, cos_raan) = libm::sincos(self.raan);
        let (sin_i, cos_i) = libm::sincos(self.i);
        let (sin_f, cos_f) = libm::sincos(self.eccentric_argument());
        Plane {
            node: Vector3::new(cos_raan, sin_raan, 0.0),
            across: Vector3::new(-sin_raan * cos_i, cos_raan * cos_i, sin_i),
            normal: Vector3::new(sin_raan * sin_i, -cos_raan * sin_i, cos_i),
            sin_f,
            cos_f,
            beta: 1.0 / (1.0 + (1.0 - self.e2()).sqrt()),
            a_over_r: 1.0 / (1.0 - self.ex * cos_f - self.ey * sin_f),
        }
    }

    /// In-plane position and its derivative with respect to F, in units of a, along node and across.
    fn in_plane(&self, plane: &Plane) -> ([f64; 2], [f64; 2]) {
        let Self { ex, ey, .. } = self;
        let Plane { sin_f, cos_f, beta, .. } = plane;
        let (xx, yy, xy) = (1.0 - ey * ey * beta, 1.0 - ex * ex * beta, ex * ey * beta);
        (
            [xx * cos_f + xy * sin_f - ex, yy * sin_f + xy * cos_f - ey],
            [xy * cos_f - xx * sin_f, yy * cos_f - xy * sin_f],
        )
    }

    /// Position and velocity of these elements as osculating elements.
    pub fn state(&self) -> State {
        let plane = self.plane();
        let ([x, y], [dx, dy]) = self.in_plane(&plane);
        let rate = self.a_km * self.mean_motion() * plane.a_over_r;
        State {
            position_km: (plane.node * x + plane.across * y) * self.a_km,
            velocity_km_s: (plane.node * dx + plane.across * dy) * rate,
        }
    }

    /// Partial derivatives of the position, km, with respect to (a in km, u, ex, ey, i, Ω). Terms of second
    /// order in the eccentricity are omitted.
    pub fn position_partials(&self) -> Matrix3x6<f64> {
        let plane = self.plane();
        let Plane { node, across, normal, sin_f, cos_f, beta, a_over_r } = &plane;
        let ([x, y], [dx, dy]) = self.in_plane(&plane);
        let Self { a_km, ex, ey, .. } = self;
        let position = (node * x + across * y) * *a_km;
        // ∂F/∂ex = (a/r) sin F, ∂F/∂ey = −(a/r) cos F from Kepler's equation.
        let (f_ex, f_ey) = (a_over_r * sin_f, -a_over_r * cos_f);
        let along = |x: f64, y: f64| (node * x + across * y) * *a_km;
        let by_ex = along(
            ey * beta * sin_f - 1.0 + dx * f_ex,
            ey * beta * cos_f - 2.0 * ex * beta * sin_f + dy * f_ex,
        );
        let by_ey = along(
            ex * beta * sin_f - 2.0 * ey * beta * cos_f + dx * f_ey,
            ex * beta * cos_f - 1.0 + dy * f_ey,
        );
        Matrix3x6::from_columns(&[
            position / *a_km,
            along(dx, dy) * *a_over_r,
            by_ex,
            by_ey,
            normal * (y * a_km),
            Vector3::new(-position.y, position.x, 0.0),
        ])
    }

    /// Returns the osculating elements of a state; `None` for a state without a supported orbit.
    pub fn from_state(state: &State) -> Option<Self> {
        let (r, v) = (&state.position_km, &state.velocity_km_s);
        let distance = r.norm();
        let momentum = r.cross(v);
        let normal = momentum / momentum.norm();
        let sin_i = libm::hypot(normal.x, normal.y);
        let node = Vector3::new(-normal.y, normal.x, 0.0) / sin_i;
        let across = normal.cross(&node);
        let eccentricity = v.cross(&momentum) / GM_KM3_S2 - r / distance;
        let (ex, ey) = (eccentricity.dot(&node), eccentricity.dot(&across));
        let a_km = 1.0 / (2.0 / distance - v.norm_squared() / GM_KM3_S2);
        // Eccentric argument from the position: the inverse of `in_plane`, X + ex = (1 − β ey²) cos F + …
        let eta = (1.0 - ex * ex - ey * ey).max(0.0).sqrt();
        let beta = 1.0 / (1.0 + eta);
        let (x, y) = (r.dot(&node) / a_km + ex, r.dot(&across) / a_km + ey);
        let (xx, yy, xy) = (1.0 - ey * ey * beta, 1.0 - ex * ex * beta, ex * ey * beta);
        let f = libm::atan2(xx * y - xy * x, yy * x - xy * y);
        let (sin_f, cos_f) = libm::sincos(f);
        let orbit = Self {
            a_km,
            u: wrap(f - ex * sin_f + ey * cos_f),
            ex,
            ey,
            i: libm::atan2(sin_i, normal.z),
            raan: libm::atan2(node.y, node.x),
        };
        orbit.is_supported().then_some(orbit)
    }
}

impl State {
    /// Returns the axes R, T, N of the state as the rows of a rotation matrix.
    pub fn rtn_axes(&self) -> [Vector3<f64>; 3] {
        let radial = self.position_km.normalize();
        let normal = self.position_km.cross(&self.velocity_km_s).normalize();
        [radial, normal.cross(&radial), normal]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    prop_compose! {
        pub(crate) fn any_orbit(max_e: f64)(
            perigee in 6600.0_f64..9000.0, e in 0.0..max_e, i in 0.05_f64..3.0,
            angles in [-3.1_f64..3.1, -3.1_f64..3.1, -3.1_f64..3.1],
        ) -> Orbit {
            let [u, perigee_angle, raan] = angles;
            let (sin, cos) = libm::sincos(perigee_angle);
            Orbit { a_km: perigee / (1.0 - e), u, ex: e * cos, ey: e * sin, i, raan }
        }
    }

    proptest! {
        #[test]
        fn elements_come_back_through_their_state(orbit in any_orbit(0.8)) {
            let back = Orbit::from_state(&orbit.state()).unwrap();
            prop_assert!((back.a_km / orbit.a_km - 1.0).abs() < 1e-11);
            for (got, expected) in [(back.ex, orbit.ex), (back.ey, orbit.ey), (back.i, orbit.i)] {
                prop_assert!((got - expected).abs() < 1e-11, "{got} {expected}");
            }
            prop_assert!(wrap(back.u - orbit.u).abs() < 2e-11 && wrap(back.raan - orbit.raan).abs() < 1e-11);
        }

        #[test]
        fn energy_and_momentum_are_those_of_the_elements(orbit in any_orbit(0.8)) {
            let State { position_km: r, velocity_km_s: v } = orbit.state();
            let energy = 0.5 * v.norm_squared() - GM_KM3_S2 / r.norm();
            prop_assert!((energy * -2.0 * orbit.a_km / GM_KM3_S2 - 1.0).abs() < 1e-12);
            let momentum = (GM_KM3_S2 * orbit.a_km * (1.0 - orbit.e2())).sqrt();
            prop_assert!((r.cross(&v).norm() / momentum - 1.0).abs() < 1e-12);
        }

        #[test]
        fn partials_are_the_slopes_of_the_position(orbit in any_orbit(0.004)) {
            let partials = orbit.position_partials();
            let steps = [1e-3, 1e-7, 1e-7, 1e-7, 1e-7, 1e-7];
            for (column, step) in steps.into_iter().enumerate() {
                let at = |sign: f64| {
                    let mut o = orbit;
                    *[&mut o.a_km, &mut o.u, &mut o.ex, &mut o.ey, &mut o.i, &mut o.raan][column] +=
                        sign * step;
                    o.state().position_km
                };
                let slope = (at(1.0) - at(-1.0)) / (2.0 * step);
                let error = (partials.column(column) - slope).norm() / slope.norm().max(1.0);
                // Omitted: 2e-5 of second order in the eccentricity; the difference quotient has 1e-8.
                prop_assert!(error < 4e-5, "{column}: {error}");
            }
        }
    }

    /// Published nodal rate of a sun-synchronous orbit: 360° in 365.2422 days at 800 km and 98.6°.
    #[test]
    fn the_node_of_a_sun_synchronous_orbit_follows_the_sun() {
        let orbit =
            Orbit { a_km: RADIUS_KM + 800.0, u: 0.0, ex: 0.0, ey: 0.0, i: 98.6_f64.to_radians(), raan: 0.0 };
        let sun = 360.0_f64.to_radians() / (365.2422 * 86400.0);
        assert!((orbit.secular_rates().raan / sun - 1.0).abs() < 5e-3);
    }
}
