//! The target spacecraft as a source of light.

mod body;
mod facet;
mod mesh;
mod outline;
mod overlaps;
mod plate;
mod shape;
mod sphere;
mod surface;
mod visible;

#[cfg(test)]
mod body_tests;

pub use mesh::{MaterialConfig, MeshConfig};
pub use plate::{BoxConfig, PlateConfig};
pub use shape::{NamedPoint, TargetShape};
pub use surface::SurfaceConfig;

use std::path::Path;

use body::LitBody;
use contract::bounds::{self, require};
use contract::{Icrs, OutOfRange, PixelPoint, Rotation, Target};
use facet::Facet;
use nalgebra::Vector3;
use optics::{ImagePoint, SUN_V_MAG_AT_1_AU};
pub use outline::Outline;
use outline::{Inside, Solid};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use sphere::{LitSphere, lambert_phase};
use truth::constants::AU_KM;
use truth::{States, TargetAttitudeConfig};

/// Maximum number of plates of a body, including those of boxes; a larger body is a mesh.
const MAX_PLATES: usize = 200;

/// The target as modelled for the sensor.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum TargetConfig {
    /// Beacon: a point source of constant brightness, independent of phase angle and shadow.
    Beacon {
        /// Visual magnitude at a distance of 1 km; the flux falls with the square of the distance.
        #[schemars(range(min = -30, max = 30))]
        magnitude_at_1_km: f64,
    },
    /// Diffusely reflecting sphere in sunlight (phase function of a Lambert sphere), drawn resolved: its
    /// centre of brightness moves towards the Sun as the phase angle grows.
    LambertSphere {
        /// Radius, m, positive.
        #[schemars(extend("exclusiveMinimum" = 0, "maximum" = 1000))]
        radius_m: f64,
        /// Diffuse reflectance (Lambert albedo) in V, 0 to 1.
        #[schemars(range(min = 0, max = 1))]
        albedo: f64,
    },
    /// Body of flat plates in sunlight, with an attitude, drawn resolved: its brightness and its centre of
    /// brightness depend on the phase angle. At least one plate, at most 200; a box counts as six.
    Plates {
        /// Attitude of the body frame; if absent, along R, T, N of the target's orbit.
        #[serde(default)]
        attitude: TargetAttitudeConfig,
        /// Boxes with edges along the axes of the body frame.
        #[serde(default)]
        boxes: Vec<BoxConfig>,
        /// Single plates, for example solar panels.
        #[serde(default)]
        plates: Vec<PlateConfig>,
    },
    /// Closed mesh of triangles from a file, in sunlight, with an attitude, drawn resolved.
    Mesh(MeshConfig),
}

impl TargetConfig {
    /// Checks every number, and the file of a mesh.
    ///
    /// # Errors
    /// [`OutOfRange`] for the first number outside its range, or a mesh that is refused.
    pub fn check(&self) -> Result<(), OutOfRange> {
        Spacecraft::new(self).map(|_| ())
    }

    /// Returns the paths of the files that the target is read from, each with its role in a scenario.
    pub fn paths(&mut self) -> Vec<(&'static str, &mut String)> {
        let Self::Mesh(mesh) = self else { return Vec::new() };
        let library = mesh.material_path.as_mut().map(|path| ("target.material_path", path));
        std::iter::once(("target.path", &mut mesh.path)).chain(library).collect()
    }

    /// Returns the attitude of the body frame; `None` for a target without orientation (beacon or sphere).
    pub fn attitude(&self) -> Option<&TargetAttitudeConfig> {
        match self {
            Self::Beacon { .. } | Self::LambertSphere { .. } => None,
            Self::Plates { attitude, .. } | Self::Mesh(MeshConfig { attitude, .. }) => Some(attitude),
        }
    }

    /// Returns the target with another attitude of its body frame; a target without orientation is unchanged.
    #[must_use]
    pub fn with_attitude(&self, attitude: TargetAttitudeConfig) -> Self {
        let mut target = self.clone();
        match &mut target {
            Self::Beacon { .. } | Self::LambertSphere { .. } => {}
            Self::Plates { attitude: own, .. } | Self::Mesh(MeshConfig { attitude: own, .. }) => {
                *own = attitude
            }
        }
        target
    }
}

/// Relative positions of target, chaser and Sun, and the visible fraction of the Sun's disk at the target.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lighting {
    /// Position of the chaser relative to the target, km, ICRS axes.
    pub chaser_km: Vector3<f64>,
    /// Position of the Sun relative to the target, km, ICRS axes.
    pub sun_km: Vector3<f64>,
    /// Fraction of the Sun's disk visible from the target, 0 to 1.
    pub sunlit_fraction: f64,
}

impl Lighting {
    /// Phase angle Sun–target–chaser, rad.
    pub fn phase_rad(&self) -> f64 {
        libm::atan2(self.sun_km.cross(&self.chaser_km).norm(), self.sun_km.dot(&self.chaser_km))
    }

    /// V magnitude of a body from which the chaser receives the share `flux_ratio` of the irradiance of the
    /// unshaded Sun. Infinite if no flux reaches the chaser.
    fn magnitude(&self, flux_ratio: f64) -> f64 {
        let sun_au = self.sun_km.norm() / AU_KM;
        SUN_V_MAG_AT_1_AU - 2.5 * libm::log10(flux_ratio * self.sunlit_fraction / (sun_au * sun_au))
    }
}

/// Target after checks and preparation.
#[derive(Debug, Clone, PartialEq)]
pub struct Spacecraft {
    model: Model,
}

#[derive(Debug, Clone, PartialEq)]
enum Model {
    Beacon {
        magnitude_at_1_km: f64,
    },
    Sphere {
        radius_m: f64,
        albedo: f64,
    },
    /// Plates and boxes, or a mesh.
    Body {
        attitude: TargetAttitudeConfig,
        facets: Vec<Facet>,
        inside: Inside,
    },
}

impl Spacecraft {
    /// Checks and prepares a target; the path of a mesh starts from the working directory.
    ///
    /// # Errors
    /// [`OutOfRange`] for the first number outside its range, or a mesh that is refused.
    pub fn new(config: &TargetConfig) -> Result<Self, OutOfRange> {
        Self::load(config, Path::new(""))
    }

    /// Checks and prepares a target; the path of a mesh starts from `folder`.
    ///
    /// # Errors
    /// [`OutOfRange`] for the first number outside its range, or a mesh that is refused.
    pub fn load(config: &TargetConfig, folder: &Path) -> Result<Self, OutOfRange> {
        bounds::check(config, "target")?;
        let model = match config {
            &TargetConfig::Beacon { magnitude_at_1_km } => Model::Beacon { magnitude_at_1_km },
            &TargetConfig::LambertSphere { radius_m, albedo } => Model::Sphere { radius_m, albedo },
            TargetConfig::Plates { attitude, boxes, plates } => {
                attitude.check()?;
                let mut all = Vec::with_capacity(6 * boxes.len() + plates.len());
                for (i, config) in boxes.iter().enumerate() {
                    all.extend(config.plates().map_err(|error| error.in_entry(i))?);
                }
                for (i, config) in plates.iter().enumerate() {
                    all.push(config.plate().map_err(|error| error.in_entry(i))?);
                }
                require("target.plates", all.len() as f64, "1 to 200, where a box counts as six", |n| {
                    n >= 1.0 && n <= MAX_PLATES as f64
                })?;
                let inside = Inside::Boxes(boxes.iter().map(BoxConfig::brick).collect());
                Model::Body { attitude: attitude.clone(), facets: all, inside }
            }
            TargetConfig::Mesh(mesh) => Model::Body {
                attitude: mesh.attitude.clone(),
                facets: mesh.load(folder)?,
                inside: Inside::Mesh,
            },
        };
        Ok(Self { model })
    }

    /// Attitude of the target's body frame; `None` for a target without orientation (beacon or sphere).
    pub fn attitude(&self, states: &States) -> Option<Rotation<Target, Icrs>> {
        match &self.model {
            Model::Beacon { .. } | Model::Sphere { .. } => None,
            Model::Body { attitude, .. } => Some(attitude.target_from_icrs(states)),
        }
    }

    /// Returns the target's outline seen from `chaser_km` (relative to the target, ICRS axes), with the
    /// attitude `target_from_icrs`; `None` for a point source.
    pub fn outline(
        &self,
        chaser_km: &Vector3<f64>,
        target_from_icrs: Option<Rotation<Target, Icrs>>,
    ) -> Option<Outline<'_>> {
        let solid = match &self.model {
            Model::Beacon { .. } => return None,
            Model::Sphere { radius_m, .. } => Solid::Sphere(*radius_m),
            Model::Body { facets, inside, .. } => Solid::Facets(facets, inside),
        };
        Some(Outline::new(solid, chaser_km, target_from_icrs.unwrap_or_else(Rotation::identity)))
    }

    /// Rejects a camera that, in this frame, is practically at the target's centre or inside the target.
    /// `path` is that of the relative motion in the scenario.
    pub fn check_separation(&self, path: &str, states: &States, frame: u64) -> Result<(), OutOfRange> {
        let (line_of_sight_km, range_m) = (states.line_of_sight_km(), states.range_km() * 1000.0);
        let refused = |expected: &str| {
            let value = format!("{range_m:.3} m from the target's centre at frame {frame}");
            Err(OutOfRange::new(path, value, expected))
        };
        if range_m.is_nan() || range_m < 1.0 {
            return refused("a separation of 1 m or more");
        }
        match self.outline(&-line_of_sight_km, self.attitude(states)) {
            Some(outline) if outline.holds_camera() => refused("a camera outside the target"),
            _ => Ok(()),
        }
    }

    /// Returns the target's appearance with the attitude `target_from_icrs`, which point sources ignore.
    pub fn appearance(
        &self,
        lighting: &Lighting,
        target_from_icrs: Option<Rotation<Target, Icrs>>,
    ) -> Appearance {
        let range_km = lighting.chaser_km.norm();
        match &self.model {
            Model::Beacon { magnitude_at_1_km } => Appearance {
                magnitude: magnitude_at_1_km + 5.0 * libm::log10(range_km),
                lit: LitShape::Point,
            },
            Model::Sphere { radius_m, albedo } => {
                let ratio = radius_m / (range_km * 1000.0);
                let flux_ratio = 2.0 / 3.0 * albedo * lambert_phase(lighting.phase_rad()) * ratio * ratio;
                let (eye_m, sun) = (lighting.chaser_km * 1000.0, lighting.sun_km.normalize());
                let lit = LitSphere::new(*radius_m, eye_m, sun).map_or(LitShape::Point, LitShape::Sphere);
                Appearance { magnitude: lighting.magnitude(flux_ratio), lit }
            }
            Model::Body { facets, .. } => {
                let turn = target_from_icrs.unwrap_or_else(Rotation::identity);
                let sun = turn.rotate(&lighting.sun_km).normalize();
                let lit = LitBody::new(facets, turn.rotate(&lighting.chaser_km) * 1000.0, sun);
                Appearance { magnitude: lighting.magnitude(lit.flux_ratio()), lit: LitShape::Body(lit) }
            }
        }
    }
}

/// Appearance of the target at one instant.
#[derive(Debug, Clone, PartialEq)]
pub struct Appearance {
    magnitude: f64,
    lit: LitShape,
}

/// Origin of the target's light.
#[derive(Debug, Clone, PartialEq)]
enum LitShape {
    /// Point source at the origin of the body frame.
    Point,
    Sphere(LitSphere),
    Body(LitBody),
}

impl Appearance {
    /// V magnitude; `None` if no flux reaches the camera.
    pub fn magnitude(&self) -> Option<f64> {
        self.magnitude.is_finite().then_some(self.magnitude)
    }

    /// Appends the points of the undistorted image, about `count_limit` at most. `project` maps the body
    /// frame, m, to the image. The shares add up to 1, except for the share of points without an image.
    pub fn image(
        &self,
        project: &impl Fn(&Vector3<f64>) -> Option<PixelPoint>,
        count_limit: usize,
        points: &mut Vec<ImagePoint>,
    ) {
        match &self.lit {
            LitShape::Body(body) => body.image(project, count_limit, points),
            LitShape::Sphere(sphere) => sphere.image(project, count_limit, points),
            LitShape::Point => {
                points.extend(project(&Vector3::zeros()).map(|position| ImagePoint { position, share: 1.0 }));
            }
        }
    }

    /// Estimates the share of the flux in the brightest pixel, where a point source has the share `psf_share`
    /// in its brightest pixel.
    pub fn peak_share(&self, project: &impl Fn(&Vector3<f64>) -> Option<PixelPoint>, psf_share: f64) -> f64 {
        let share = match &self.lit {
            LitShape::Body(body) => body.peak_share(project, psf_share),
            LitShape::Sphere(sphere) => sphere.peak_share(project, psf_share),
            LitShape::Point => None,
        };
        share.unwrap_or(psf_share)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SPHERE: TargetConfig = TargetConfig::LambertSphere { radius_m: 1.0, albedo: 0.9 };

    /// Magnitude of a target without an attitude.
    fn magnitude(
        config: &TargetConfig,
        range_km: f64,
        sun_distance_km: f64,
        phase_rad: f64,
        sunlit_fraction: f64,
    ) -> f64 {
        let (sin, cos) = libm::sincos(phase_rad);
        let lighting = Lighting {
            chaser_km: Vector3::x() * range_km,
            sun_km: Vector3::new(cos, sin, 0.0) * sun_distance_km,
            sunlit_fraction,
        };
        Spacecraft::new(config).unwrap().appearance(&lighting, None).magnitude
    }

    #[test]
    fn the_phase_law_has_its_known_values() {
        assert_eq!(lambert_phase(0.0), 1.0);
        assert!((lambert_phase(std::f64::consts::FRAC_PI_2) - 1.0 / std::f64::consts::PI).abs() < 1e-15);
        assert!(lambert_phase(std::f64::consts::PI) < 1e-15);
    }

    /// A white Lambert sphere reflects all incident light: the integral of the phase function over all
    /// directions times the geometric albedo 2/3 must equal the Bond albedo 1, so 2 ∫ Φ sin α dα = 3/2.
    #[test]
    fn a_white_sphere_reflects_all_that_it_receives() {
        let n = 10_000;
        let step = std::f64::consts::PI / n as f64;
        let integral: f64 = (0..n)
            .map(|i| {
                let alpha = (i as f64 + 0.5) * step;
                lambert_phase(alpha) * libm::sin(alpha) * step
            })
            .sum();
        // Midpoint rule: error of order step² = 1e-7.
        assert!((2.0 * integral - 1.5).abs() < 1e-6, "{integral}");
    }

    #[test]
    fn ten_times_the_distance_is_five_magnitudes() {
        let near = magnitude(&SPHERE, 3.0, AU_KM, 1.0, 1.0);
        let far = magnitude(&SPHERE, 30.0, AU_KM, 1.0, 1.0);
        assert!((far - near - 5.0).abs() < 1e-12);
    }

    #[test]
    fn half_the_sun_is_three_quarters_of_a_magnitude() {
        let lit = magnitude(&SPHERE, 3.0, AU_KM, 1.0, 1.0);
        let half = magnitude(&SPHERE, 3.0, AU_KM, 1.0, 0.5);
        assert!((half - lit - 2.5 * libm::log10(2.0)).abs() < 1e-12);
    }

    #[test]
    fn in_umbra_the_flux_is_zero() {
        assert_eq!(magnitude(&SPHERE, 3.0, AU_KM, 1.0, 0.0), f64::INFINITY);
    }

    #[test]
    fn a_beacon_fades_with_distance_and_ignores_the_sun() {
        let beacon = TargetConfig::Beacon { magnitude_at_1_km: 2.0 };
        assert_eq!(magnitude(&beacon, 1.0, AU_KM, 0.0, 1.0), 2.0);
        assert_eq!(magnitude(&beacon, 10.0, AU_KM, 3.0, 0.0), 7.0);
    }

    /// White sphere of 1 m at a distance of 1 km, full phase, at 1 au: −26.76 − 2.5 log10(2/3 · 1e-6) =
    /// −11.32.
    #[test]
    fn a_sphere_has_the_magnitude_of_its_closed_form() {
        let white = TargetConfig::LambertSphere { radius_m: 1.0, albedo: 1.0 };
        assert!((magnitude(&white, 1.0, AU_KM, 0.0, 1.0) + 11.3198).abs() < 1e-4);
        // At twice the distance from the Sun the sphere has a quarter of the flux.
        let far = magnitude(&white, 1.0, 2.0 * AU_KM, 0.0, 1.0) - magnitude(&white, 1.0, AU_KM, 0.0, 1.0);
        assert!((far - 5.0 * libm::log10(2.0)).abs() < 1e-12);
    }

    #[test]
    fn a_black_sphere_and_one_at_new_phase_have_no_flux() {
        let black = TargetConfig::LambertSphere { radius_m: 1.0, albedo: 0.0 };
        assert_eq!(magnitude(&black, 1.0, AU_KM, 0.0, 1.0), f64::INFINITY);
        // Φ(π) evaluates to 4e-17 instead of 0, which is still too faint to matter.
        assert!(magnitude(&SPHERE, 1.0, AU_KM, std::f64::consts::PI, 1.0) > 25.0);
    }

    #[test]
    fn numbers_out_of_range_are_named() {
        let message = |config: TargetConfig| config.check().unwrap_err().to_string();
        assert!(
            message(TargetConfig::LambertSphere { radius_m: 0.0, albedo: 0.5 })
                .contains("target.radius_m is 0")
        );
        assert!(
            message(TargetConfig::LambertSphere { radius_m: 1.0, albedo: 1.1 }).contains("target.albedo")
        );
        assert!(message(TargetConfig::Beacon { magnitude_at_1_km: f64::NAN }).contains("magnitude_at_1_km"));
    }
}
