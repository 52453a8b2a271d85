//! Illumination of the scene at one instant.

use nalgebra::Vector3;

/// The Sun, a source of parallel light.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sun {
    /// Unit vector from the target towards the Sun, target frame.
    pub towards: Vector3<f64>,
    /// Irradiance of a surface that faces the Sun, in units in which a white Lambertian surface has radiance
    /// E/π.
    pub irradiance: f64,
}

/// Lamp on the spacecraft: a point source with a cone of light.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Floodlight {
    /// Position, m, target frame.
    pub position_m: Vector3<f64>,
    /// Unit vector along the axis of the cone, target frame.
    pub axis: Vector3<f64>,
    /// Radiant intensity on the axis: irradiance × m².
    pub intensity: f64,
    /// Half angle of the inner cone, within which the intensity equals that on the axis, rad.
    pub inner_half_angle_rad: f64,
    /// Half angle at which the intensity reaches zero, rad. Between the two half angles it falls linearly
    /// with angle (Mitsuba's `spot`).
    pub outer_half_angle_rad: f64,
}

/// All light sources at one instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lighting {
    /// The Sun; `None` on the night side.
    pub sun: Option<Sun>,
    /// The lamp; `None` when it is off.
    pub floodlight: Option<Floodlight>,
    /// Uniform radiance from all directions (from the Earth and the station's surfaces), in the units of E/π.
    /// It gives a surface of reflectance ρ the radiance ρ × `fill_radiance`; nothing shades it.
    pub fill_radiance: f64,
    /// Radiance of the sky visible between the parts.
    pub sky_radiance: f64,
}
