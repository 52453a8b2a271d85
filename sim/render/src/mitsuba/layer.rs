//! Layers of a scene's light, one image per kind of light.

use contract::bounds::require;
use nalgebra::{Rotation3, Unit, Vector3};
use scene::docking::{Floodlight, Lighting, Sun};
use truth::SimError;

use super::matrix::matrix;

/// Kind of light. The radiance of a scene is the sum of its layers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Layer {
    /// Parallel light, reflected once, with shadows.
    Sun(Sun),
    /// Spotlight, reflected once, with shadows.
    Floodlight(Floodlight),
    /// Unshadowed light from all directions, and the sky: surfaces emit their reflectance × `fill_radiance`.
    Fill {
        /// Value of [`Lighting::fill_radiance`].
        fill_radiance: f64,
        /// Value of [`Lighting::sky_radiance`].
        sky_radiance: f64,
    },
}

impl Layer {
    /// Returns the layers of a lighting, without dark layers.
    ///
    /// # Errors
    /// [`SimError::OutOfRange`] for a number that is not finite or negative, a direction without length, and
    /// a cone whose angles are not 0 ≤ inner < outer < π/2.
    pub fn from_lighting(lighting: &Lighting) -> Result<Vec<Self>, SimError> {
        let light = |v: f64| v >= 0.0;
        require("lighting.fill_radiance", lighting.fill_radiance, "0 or more", light)?;
        require("lighting.sky_radiance", lighting.sky_radiance, "0 or more", light)?;
        let mut layers = Vec::new();
        if let Some(sun) = lighting.sun {
            require("lighting.sun.irradiance", sun.irradiance, "0 or more", light)?;
            require("lighting.sun.towards", sun.towards.norm(), "a vector of nonzero length", |v| v > 0.0)?;
            layers.push(Self::Sun(sun));
        }
        if let Some(lamp) = lighting.floodlight {
            let (inner, outer) = (lamp.inner_half_angle_rad, lamp.outer_half_angle_rad);
            require("lighting.floodlight.intensity", lamp.intensity, "0 or more", light)?;
            require("lighting.floodlight.axis", lamp.axis.norm(), "a vector of nonzero length", |v| v > 0.0)?;
            require("lighting.floodlight.position_m", lamp.position_m.sum(), "finite numbers", |_| true)?;
            require("lighting.floodlight.inner_half_angle_rad", inner, "0 or more", light)?;
            let wider = |v: f64| v > inner && v < std::f64::consts::FRAC_PI_2;
            require(
                "lighting.floodlight.outer_half_angle_rad",
                outer,
                "more than inner_half_angle_rad, below π/2",
                wider,
            )?;
            layers.push(Self::Floodlight(lamp));
        }
        if lighting.fill_radiance > 0.0 || lighting.sky_radiance > 0.0 {
            let Lighting { fill_radiance, sky_radiance, .. } = *lighting;
            layers.push(Self::Fill { fill_radiance, sky_radiance });
        }
        Ok(layers)
    }

    /// Name of the layer, for messages.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Sun(_) => "sun",
            Self::Floodlight(_) => "floodlight",
            Self::Fill { .. } => "fill",
        }
    }

    /// Emitter that lights the whole scene. It uses `<rgb>`, never `<spectrum>`, which would be interpreted
    /// as a spectrum relative to D65 and be coloured.
    pub(super) fn emitter(&self) -> String {
        match self {
            Self::Sun(Sun { towards, irradiance }) => {
                // Mitsuba's direction is the direction of propagation.
                let [x, y, z] = (-towards.normalize()).into();
                format!(
                    "  <emitter type=\"directional\">\n    <vector name=\"direction\" x=\"{x}\" y=\"{y}\" z=\"{z}\"/>\n    \
                     {}\n  </emitter>\n",
                    rgb("irradiance", *irradiance)
                )
            }
            Self::Floodlight(lamp) => format!(
                "  <emitter type=\"spot\">\n    <transform name=\"to_world\"><matrix value=\"{}\"/></transform>\n    {}\n    \
                 <float name=\"beam_width\" value=\"{}\"/>\n    <float name=\"cutoff_angle\" value=\"{}\"/>\n  \
                 </emitter>\n",
                matrix(&axes_along(&lamp.axis), &lamp.position_m),
                rgb("intensity", lamp.intensity),
                lamp.inner_half_angle_rad.to_degrees(),
                lamp.outer_half_angle_rad.to_degrees(),
            ),
            Self::Fill { sky_radiance, .. } => {
                format!("  <emitter type=\"constant\">{}</emitter>\n", rgb("radiance", *sky_radiance))
            }
        }
    }

    /// Material of a surface of given reflectance.
    pub(super) fn surface(&self, reflectance: f64) -> String {
        match self {
            Self::Sun(_) | Self::Floodlight(_) => {
                format!("<bsdf type=\"diffuse\">{}</bsdf>", rgb("reflectance", reflectance))
            }
            Self::Fill { fill_radiance, .. } => {
                format!("<emitter type=\"area\">{}</emitter>", rgb("radiance", reflectance * fill_radiance))
            }
        }
    }

    /// Path length of the integrator: 2 for light that a surface reflects once, 1 for emitting surfaces.
    pub(super) fn max_depth(&self) -> u32 {
        match self {
            Self::Sun(_) | Self::Floodlight(_) => 2,
            Self::Fill { .. } => 1,
        }
    }
}

/// Rotation whose third column is along `axis`; the other two columns are irrelevant to a cone.
fn axes_along(axis: &Vector3<f64>) -> Rotation3<f64> {
    let up = if axis.x.abs() < 0.5 * axis.norm() { Vector3::x_axis() } else { Vector3::y_axis() };
    Rotation3::face_towards(axis, &Unit::into_inner(up))
}

fn rgb(name: &str, value: f64) -> String {
    format!("<rgb name=\"{name}\" value=\"{value}, {value}, {value}\"/>")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn night() -> Lighting {
        Lighting { sun: None, floodlight: None, fill_radiance: 0.0, sky_radiance: 0.0 }
    }

    #[test]
    fn layers_without_light_are_omitted() {
        assert_eq!(Layer::from_lighting(&night()).unwrap(), []);
        let sun = Sun { towards: Vector3::z(), irradiance: 1.0 };
        let day = Lighting { sun: Some(sun), fill_radiance: 0.1, ..night() };
        let names: Vec<_> = Layer::from_lighting(&day).unwrap().iter().map(Layer::name).collect();
        assert_eq!(names, ["sun", "fill"]);
    }

    #[test]
    fn an_invalid_light_is_refused_by_name() {
        let sun = Sun { towards: Vector3::zeros(), irradiance: 1.0 };
        let error = Layer::from_lighting(&Lighting { sun: Some(sun), ..night() }).unwrap_err().to_string();
        assert!(error.contains("lighting.sun.towards"), "{error}");
        let error =
            Layer::from_lighting(&Lighting { fill_radiance: f64::NAN, ..night() }).unwrap_err().to_string();
        assert!(error.contains("lighting.fill_radiance"), "{error}");
        let lamp = Floodlight {
            position_m: Vector3::zeros(),
            axis: Vector3::z(),
            intensity: 1.0,
            inner_half_angle_rad: 0.3,
            outer_half_angle_rad: 0.3,
        };
        let error =
            Layer::from_lighting(&Lighting { floodlight: Some(lamp), ..night() }).unwrap_err().to_string();
        assert!(error.contains("outer_half_angle_rad is 0.3"), "{error}");
    }

    #[test]
    fn sunlight_travels_away_from_the_sun_and_a_lamp_shines_along_its_axis() {
        let sun = Layer::Sun(Sun { towards: Vector3::new(0.0, 0.0, 2.0), irradiance: 1.5 });
        assert!(sun.emitter().contains("x=\"-0\" y=\"-0\" z=\"-1\""), "{}", sun.emitter());
        for axis in [Vector3::new(0.1, 0.2, -1.0), Vector3::x(), Vector3::new(0.0, -1.0, 0.0)] {
            let third = axes_along(&axis) * Vector3::z();
            assert!((third - axis.normalize()).norm() < 1e-12, "{axis}");
        }
    }
}
