//! Accelerations of a spacecraft near the Earth.

use nalgebra::Vector3;

use super::atmosphere::density_kg_m3;
use super::gravity::GravityField;
use super::orientation::{EARTH_RATE_RAD_S, EarthOrientation};
use super::sky::Sky;
use crate::Switch;
use crate::constants::{AU_KM, LIGHT_SPEED_KM_S};
use crate::manoeuvre::ManoeuvreAxes;
use crate::orbit::State;
use crate::shadow::sunlit_fraction;

/// Gravitational parameter of the Sun, km³/s² (IAU 2015 Resolution B3, nominal).
pub(super) const SUN_GM_KM3_S2: f64 = 1.327_124_4e11;
/// Gravitational parameter of the Moon, km³/s² (DE440: Park et al. 2021, AJ 161, 105).
pub(super) const MOON_GM_KM3_S2: f64 = 4_902.800_118;
/// Irradiance of the Sun at 1 au, W/m² (IAU 2015 Resolution B3, nominal).
const SOLAR_IRRADIANCE_W_M2: f64 = 1_361.0;

/// Surface forces on one spacecraft.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Surfaces {
    /// Drag coefficient × area / mass, m²/kg.
    pub(super) drag_m2_kg: f64,
    /// Exponent of the density's variation between day and night.
    pub(super) exponent: f64,
    /// Radiation pressure coefficient × area / mass, m²/kg.
    pub(super) radiation_m2_kg: f64,
}

/// Thrust during a burn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Thrust {
    /// Axes of the acceleration.
    pub(super) axes: ManoeuvreAxes,
    /// Acceleration, km/s².
    pub(super) acceleration_km_s2: Vector3<f64>,
}

/// All forces on one spacecraft.
#[derive(Debug, Clone)]
pub(super) struct Forces<'a> {
    pub(super) field: GravityField,
    pub(super) orientation: &'a EarthOrientation,
    pub(super) sky: &'a Sky,
    pub(super) sun: Switch,
    pub(super) moon: Switch,
    pub(super) surfaces: Surfaces,
}

impl Forces<'_> {
    /// Acceleration, km/s², along ICRS axes.
    pub(super) fn acceleration(
        &mut self,
        time_s: f64,
        state: &State,
        thrust: Option<Thrust>,
    ) -> Vector3<f64> {
        let orientation = self.orientation.at(time_s);
        let (position, velocity) = (&state.position_km, &state.velocity_km_s);
        let fixed_km = orientation.itrs_from_icrs * position;
        let field = self.field.acceleration(&fixed_km);
        let mut sum = orientation.itrs_from_icrs.tr_mul(&field);
        let bodies = self.sky.at(time_s);
        if self.sun == Switch::On {
            sum += tide(SUN_GM_KM3_S2, &bodies.sun_km, position);
        }
        if self.moon == Switch::On {
            sum += tide(MOON_GM_KM3_S2, &bodies.moon_km, position);
        }
        let Surfaces { drag_m2_kg, exponent, radiation_m2_kg } = self.surfaces;
        if drag_m2_kg > 0.0 {
            let sun = orientation.itrs_from_icrs * bodies.sun_km;
            let density = density_kg_m3(&fixed_km, &sun, exponent);
            // The atmosphere rotates with the Earth.
            let relative = velocity - (orientation.pole * EARTH_RATE_RAD_S).cross(position);
            // kg/m³ · m²/kg = 1/m = 1000/km.
            sum -= relative * (0.5 * density * drag_m2_kg * 1000.0 * relative.norm());
        }
        if radiation_m2_kg > 0.0 {
            let lit = sunlit_fraction(position, &bodies.sun_km);
            let from_sun = position - bodies.sun_km;
            let distance = from_sun.norm();
            // W/m² over m/s is N/m²; m/s² to km/s².
            let pressure = SOLAR_IRRADIANCE_W_M2 / (LIGHT_SPEED_KM_S * 1000.0);
            let at_1_au = pressure * radiation_m2_kg * 1e-3;
            sum += from_sun * (lit * at_1_au * AU_KM * AU_KM / (distance * distance * distance));
        }
        if let Some(thrust) = thrust {
            sum += thrust.axes.to_icrs(state, &thrust.acceleration_km_s2);
        }
        sum
    }

    /// Fraction of the Sun's disk that is visible; 1 if it has no effect on the forces.
    pub(super) fn sunlit(&self, time_s: f64, position_km: &Vector3<f64>) -> f64 {
        if self.surfaces.radiation_m2_kg > 0.0 {
            sunlit_fraction(position_km, &self.sky.at(time_s).sun_km)
        } else {
            1.0
        }
    }
}

/// Acceleration by a distant body, relative to the Earth's (Montenbruck & Gill 2000, Eq. 3.37).
fn tide(gm_km3_s2: f64, body_km: &Vector3<f64>, position_km: &Vector3<f64>) -> Vector3<f64> {
    let to_body = body_km - position_km;
    let (near, far) = (to_body.norm(), body_km.norm());
    (to_body / (near * near * near) - body_km / (far * far * far)) * gm_km3_s2
}
