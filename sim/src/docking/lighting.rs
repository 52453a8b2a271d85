//! Lighting of the scene as a function of time and pose.

use contract::OutOfRange;
use contract::bounds::{self, require};
use contract::docking::Pose;
use nalgebra::{Rotation3, Unit, Vector3};
use scene::docking::{Assembly, Facet, Floodlight, Lighting, Part, Sun};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use truth::approach::target_from_camera;

use super::glint::GlintConfig;

/// Maximum distance of a shade's corners from its plane, m.
const FLATNESS_M: f64 = 1e-6;

/// Lighting of the scene. Without a Sun it is the night side.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct LightingConfig {
    /// Sun; absent on the night side.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sun: Option<SunConfig>,
    /// Lamp beside the camera; absent if the lamp is off.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub floodlight: Option<FloodlightConfig>,
    /// Radiance of a white surface illuminated by Earth and station, equally from all directions, in the
    /// units of irradiance/π, 0 to 1e6.
    #[schemars(range(min = 0, max = 1e6))]
    pub fill_radiance: f64,
    /// Radiance of the sky, in the units of irradiance/π, 0 to 1e6.
    #[schemars(range(min = 0, max = 1e6))]
    pub sky_radiance: f64,
    /// Obstacles outside the picture between the Sun and the target; at most 64.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    #[schemars(length(max = 64))]
    pub shades: Vec<ShadeConfig>,
    /// Small shiny fittings that reflect the Sun; at most 64.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    #[schemars(length(max = 64))]
    pub glints: Vec<GlintConfig>,
}

/// Sun in the target frame: s = (cos e sin a, sin e, cos e cos a) for its azimuth a and elevation e, rotating
/// about an axis.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SunConfig {
    /// Initial azimuth, from y3 towards y1, degrees, −360 to 360: at 0 the Sun shines on the disk, at 180 on
    /// its back.
    #[schemars(range(min = -360, max = 360))]
    pub azimuth_deg: f64,
    /// Initial elevation, towards y2, degrees, −90 to 90.
    #[schemars(range(min = -90, max = 90))]
    pub elevation_deg: f64,
    /// Rate about the axis, right-handed, degrees per second, −10 to 10; a station in orbit turns at 0.065.
    #[serde(default)]
    #[schemars(range(min = -10, max = 10))]
    pub rate_deg_s: f64,
    /// Axis of rotation, target frame, of any length but 0.
    #[serde(default = "default_axis")]
    #[schemars(inner(range(min = -1e6, max = 1e6)))]
    pub rate_axis: [f64; 3],
    /// Irradiance of a surface that faces the Sun, 1e-6 to 1e6; at π a white surface has the radiance 1.
    #[serde(default = "default_irradiance")]
    #[schemars(range(min = 1e-6, max = 1e6))]
    pub irradiance: f64,
}

fn default_axis() -> [f64; 3] {
    [0.0, 1.0, 0.0]
}

fn default_irradiance() -> f64 {
    std::f64::consts::PI
}

/// Lamp that is fixed to the camera and shines along its optical axis.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct FloodlightConfig {
    /// Position in the camera frame (along columns, along rows, along the optical axis), m, each −10 to 10.
    #[schemars(inner(range(min = -10, max = 10)))]
    pub offset_m: [f64; 3],
    /// Radiant intensity on the axis, irradiance × m², 0 to 1e9; a white surface at a distance of
    /// √(intensity/π) has the radiance 1.
    #[schemars(range(min = 0, max = 1e9))]
    pub intensity: f64,
    /// Half angle of the full beam, degrees, 0 to 89.
    #[schemars(range(min = 0, max = 89))]
    pub inner_half_angle_deg: f64,
    /// Half angle at which the beam ends, degrees, larger than the inner half angle and at most 89.
    #[schemars(extend("exclusiveMinimum" = 0, "maximum" = 89))]
    pub outer_half_angle_deg: f64,
}

impl Default for FloodlightConfig {
    fn default() -> Self {
        Self {
            offset_m: [0.25, 0.10, 0.0],
            intensity: 40.0,
            inner_half_angle_deg: 12.0,
            outer_half_angle_deg: 30.0,
        }
    }
}

/// Flat polygon that is invisible to cameras and casts a shadow: part of the station or of the spacecraft.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ShadeConfig {
    /// Corners in order, target frame, m, each coordinate −1000 to 1000; 3 to 64 corners, coplanar within 1
    /// µm.
    #[schemars(length(min = 3, max = 64), inner(inner(range(min = -1000, max = 1000))))]
    pub corners_m: Vec<[f64; 3]>,
}

impl ShadeConfig {
    /// Converts the shade to a part of the scene.
    ///
    /// # Errors
    /// [`OutOfRange`] for corners that do not form a flat polygon.
    fn part(&self, index: usize) -> Result<Part, OutOfRange> {
        let refused = |expected| {
            let value = format!("{:?}", self.corners_m);
            Err(OutOfRange::new("lighting.shades[].corners_m", value, expected))
        };
        let outer: Vec<Vector3<f64>> = self.corners_m.iter().map(|corner| Vector3::from(*corner)).collect();
        // Newell's normal: its length is twice the area.
        let area = outer
            .iter()
            .zip(outer.iter().cycle().skip(1))
            .fold(Vector3::zeros(), |sum, (a, b)| sum + a.cross(b));
        let Some(normal) = Unit::try_new(area, 1e-6).map(Unit::into_inner) else {
            return refused("a polygon with a nonzero area");
        };
        if outer.iter().any(|corner| (corner - outer[0]).dot(&normal).abs() > FLATNESS_M) {
            return refused("corners in one plane");
        }
        Ok(Part {
            name: format!("shade {index}"),
            assembly: Assembly::Station,
            facets: vec![Facet { outer, holes: Vec::new(), normal, reflectance: 0.0 }],
            casts_shadow: true,
            visible: false,
        })
    }
}

impl LightingConfig {
    /// Checks the ranges of all values.
    ///
    /// # Errors
    /// [`OutOfRange`] for the first value outside its range.
    pub fn check(&self) -> Result<(), OutOfRange> {
        bounds::check(self, "lighting")?;
        if let Some(sun) = &self.sun {
            let length = Vector3::from(sun.rate_axis).norm();
            require("lighting.sun.rate_axis (length)", length, "1e-6 to 1e6", |n| (1e-6..=1e6).contains(&n))?;
        }
        if let Some(FloodlightConfig { inner_half_angle_deg, outer_half_angle_deg, .. }) = self.floodlight {
            let (path, expected) =
                ("lighting.floodlight.outer_half_angle_deg", "more than inner_half_angle_deg, at most 89");
            require(path, outer_half_angle_deg, expected, |a| a > inner_half_angle_deg)?;
        }
        for (index, glint) in self.glints.iter().enumerate() {
            glint.check().map_err(|error| error.in_entry(index))?;
        }
        self.shade_parts().map(|_| ())
    }

    /// Converts the shades to parts of the scene.
    ///
    /// # Errors
    /// [`OutOfRange`] for a shade that is not a flat polygon.
    pub(super) fn shade_parts(&self) -> Result<Vec<Part>, OutOfRange> {
        self.shades
            .iter()
            .enumerate()
            .map(|(index, shade)| shade.part(index).map_err(|error| error.in_entry(index)))
            .collect()
    }

    /// Lighting at a time, for a camera at `pose`.
    pub fn lighting_at(&self, time_s: f64, pose: &Pose) -> Lighting {
        Lighting {
            sun: self.sun.map(|sun| Sun { towards: sun.towards(time_s), irradiance: sun.irradiance }),
            floodlight: self.floodlight.map(|lamp| lamp.floodlight_at(pose)),
            fill_radiance: self.fill_radiance,
            sky_radiance: self.sky_radiance,
        }
    }
}

impl SunConfig {
    /// Unit vector from the target towards the Sun, target frame.
    fn towards(&self, time_s: f64) -> Vector3<f64> {
        let (sin_a, cos_a) = libm::sincos(self.azimuth_deg.to_radians());
        let (sin_e, cos_e) = libm::sincos(self.elevation_deg.to_radians());
        let start = Vector3::new(cos_e * sin_a, sin_e, cos_e * cos_a);
        let angle = self.rate_deg_s.to_radians() * time_s;
        let axis = Unit::new_normalize(Vector3::from(self.rate_axis));
        Rotation3::from_axis_angle(&axis, angle) * start
    }
}

impl FloodlightConfig {
    fn floodlight_at(&self, pose: &Pose) -> Floodlight {
        let target_from_camera = target_from_camera(pose);
        Floodlight {
            position_m: pose.position_m + target_from_camera * Vector3::from(self.offset_m),
            axis: target_from_camera * Vector3::z(),
            intensity: self.intensity,
            inner_half_angle_rad: self.inner_half_angle_deg.to_radians(),
            outer_half_angle_rad: self.outer_half_angle_deg.to_radians(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SUN: SunConfig = SunConfig {
        azimuth_deg: 30.0,
        elevation_deg: 0.0,
        rate_deg_s: 0.5,
        rate_axis: [0.0, 2.0, 0.0],
        irradiance: 3.0,
    };

    #[test]
    fn the_sun_turns_about_its_axis() {
        let (sin, cos) = libm::sincos(30.0_f64.to_radians());
        assert!((SUN.towards(0.0) - Vector3::new(sin, 0.0, cos)).norm() < 1e-15);
        // Right-handed about y2: the azimuth increases from y3 towards y1.
        assert!((SUN.towards(120.0) - Vector3::x()).norm() < 1e-15);
        let up = SunConfig { azimuth_deg: 0.0, elevation_deg: 90.0, rate_deg_s: 0.0, ..SUN };
        assert!((up.towards(5.0) - Vector3::y()).norm() < 1e-15);
    }

    #[test]
    fn the_lamp_moves_with_the_camera() {
        let lamp = FloodlightConfig { offset_m: [0.2, 0.1, 0.3], ..FloodlightConfig::default() };
        let pose = Pose { position_m: Vector3::new(1.0, 2.0, 8.0), phi_rad: Vector3::zeros() };
        let at = lamp.floodlight_at(&pose);
        // Columns run along y1, rows opposite to y2, and the optical axis opposite to y3.
        assert!((at.position_m - Vector3::new(1.2, 1.9, 7.7)).norm() < 1e-15);
        assert_eq!(at.axis, -Vector3::z());
        // A positive yaw φ2 turns the axis towards +y1: A's third column is (φ2, φ1, −1) to first order.
        let turned = lamp.floodlight_at(&Pose { phi_rad: Vector3::new(0.0, 1e-3, 0.0), ..pose });
        assert!((turned.axis - Vector3::new(1e-3, 0.0, -1.0)).norm() < 1e-6);
    }

    #[test]
    fn bad_values_are_refused_with_their_path() {
        let refused = |config: LightingConfig, path: &str| {
            let message = config.check().unwrap_err().to_string();
            assert!(message.starts_with(path), "{message}");
        };
        let sun = |sun| LightingConfig { sun: Some(sun), ..LightingConfig::default() };
        refused(sun(SunConfig { elevation_deg: 91.0, ..SUN }), "lighting.sun.elevation_deg");
        refused(sun(SunConfig { rate_axis: [0.0; 3], ..SUN }), "lighting.sun.rate_axis");
        refused(sun(SunConfig { irradiance: f64::NAN, ..SUN }), "lighting.sun.irradiance");
        let lamp = FloodlightConfig { outer_half_angle_deg: 5.0, ..FloodlightConfig::default() };
        let night = LightingConfig { floodlight: Some(lamp), ..LightingConfig::default() };
        refused(night, "lighting.floodlight.outer_half_angle_deg");
        refused(
            LightingConfig { fill_radiance: -1.0, ..LightingConfig::default() },
            "lighting.fill_radiance",
        );
        let shade = |corners: &[[f64; 3]]| {
            let good = ShadeConfig { corners_m: vec![[0.0, 0.0, 9.0], [1.0, 0.0, 9.0], [0.0, 1.0, 9.0]] };
            let shades = vec![good, ShadeConfig { corners_m: corners.to_vec() }];
            LightingConfig { shades, ..LightingConfig::default() }
        };
        refused(shade(&[[0.0; 3]; 2]), "lighting.shades[1].corners_m");
        refused(shade(&[[0.0; 3]; 3]), "lighting.shades[1].corners_m");
        let bent = [[0.0, 0.0, 1.0], [1.0, 0.0, 1.0], [1.0, 1.0, 1.5], [0.0, 1.0, 1.0]];
        refused(shade(&bent), "lighting.shades[1].corners_m");
    }
}
