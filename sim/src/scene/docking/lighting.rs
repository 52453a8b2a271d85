//! The light on the scene at a moment.

use nalgebra::Vector3;

/// The Sun: parallel light.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sun {
    /// Unit vector from the target towards the Sun, target frame.
    pub towards: Vector3<f64>,
    /// Irradiance of a surface that faces it, in units in which a white Lambertian surface has radiance E/π.
    pub irradiance: f64,
}

/// A lamp on the spacecraft: a point with a cone of light.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Floodlight {
    /// Where it is, m, target frame.
    pub position_m: Vector3<f64>,
    /// Unit vector along its axis, target frame.
    pub axis: Vector3<f64>,
    /// Radiant intensity on the axis: irradiance × m².
    pub intensity: f64,
    /// Half angle inside which the intensity is that of the axis, rad.
    pub inner_half_angle_rad: f64,
    /// Half angle at which it has fallen to zero, linearly in the angle between (Mitsuba's `spot`), rad.
    pub outer_half_angle_rad: f64,
}

/// All light at a moment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lighting {
    /// The Sun; `None` on the night side.
    pub sun: Option<Sun>,
    /// The lamp; `None` when it is off.
    pub floodlight: Option<Floodlight>,
    /// Radiance from everywhere alike (light of the Earth and of the station's own surfaces), same units as E/π. A
    /// surface of reflectance ρ gets radiance ρ × this; nothing shades it.
    pub fill_radiance: f64,
    /// Radiance of the sky between the parts.
    pub sky_radiance: f64,
}
