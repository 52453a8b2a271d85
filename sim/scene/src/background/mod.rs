//! Background light from outside the field's sources: zodiacal light, faint stars, and light of Sun, Earth
//! and Moon scattered in the optics.
//!
//! All of it is smooth: it is evaluated at the nodes of a grid over the detector and interpolated between
//! them.

mod stray;
mod transmittance_table;
mod zodiacal;

pub use stray::StrayLightConfig;

use std::sync::Arc;

use contract::{Camera, CameraFrame, Icrs, OutOfRange, PixelPoint, Rotation, bounds};
use hifitime::Epoch;
use nalgebra::Vector3;
use optics::smooth_field::{NODES, NodeGrid, SmoothField};
use optics::{Projection, Radiometry, SUN_V_MAG_AT_1_AU, Vignetting};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use stray::Ray;
use transmittance_table::TransmittanceTable;
use truth::constants::AU_KM;
use truth::moon::{MOON_MEAN_DISTANCE_KM, MOON_RADIUS_KM};
use truth::{SimError, Switch, clock, moon, shadow};

/// Square degrees per steradian.
const SQUARE_DEGREES_PER_SR: f64 = (180.0 / std::f64::consts::PI) * (180.0 / std::f64::consts::PI);

/// Simulated parts of the background; each is off unless it is named.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct BackgroundConfig {
    /// Zodiacal light, `on` or `off`, as a function of ecliptic latitude and longitude from the Sun.
    pub zodiacal: Switch,
    /// Stars too faint to be drawn, uniform over the sky: S10 (Sun-like stars of V = 10 per square degree), 0
    /// to 1000.
    #[schemars(range(min = 0, max = 1000))]
    pub faint_stars_s10: f64,
    /// Scattered light of the Sun; requires radiometry of kind "spectral".
    pub sun: Option<StrayLightConfig>,
    /// Earth: scattered light of its sunlit part, and occultation of objects behind it; requires radiometry
    /// of kind "spectral".
    pub earth: Option<EarthLightConfig>,
    /// Scattered light of the Moon; requires radiometry of kind "spectral".
    pub moon: Option<StrayLightConfig>,
}

/// Earth as a source of scattered light: a diffuse sunlit sphere, with each part of its disk at a separate
/// angle.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct EarthLightConfig {
    /// Diffuse reflectance (Lambert albedo), clouds included, 0 to 1; 0.3 on average.
    #[schemars(range(min = 0, max = 1))]
    pub albedo: f64,
    /// Scattering of the Earth's light.
    pub scatter: StrayLightConfig,
}

/// All parts are off.
impl Default for BackgroundConfig {
    fn default() -> Self {
        Self { zodiacal: Switch::Off, faint_stars_s10: 0.0, sun: None, earth: None, moon: None }
    }
}

impl BackgroundConfig {
    /// Checks the ranges of all values.
    ///
    /// # Errors
    /// [`OutOfRange`] for the first value outside its range.
    pub fn check(&self) -> Result<(), OutOfRange> {
        bounds::check(self, "background")
    }

    /// Returns true if every part is off.
    fn is_off(&self) -> bool {
        self.zodiacal == Switch::Off
            && self.faint_stars_s10 == 0.0
            && self.sun.is_none()
            && self.earth.is_none()
            && self.moon.is_none()
    }
}

/// Prepared background of a camera.
#[derive(Debug, Clone)]
pub struct Background {
    config: BackgroundConfig,
    grid: Arc<NodeGrid>,
    /// Nodes of the grid, row by row.
    nodes: Vec<Node>,
    /// Transmittance for the Earth's light, which consists of many rays.
    earth_transmittance: Option<Arc<TransmittanceTable>>,
    /// Electrons per second and pixel of 1 S10, per steradian of the pixel.
    s10_e_per_s_sr: f64,
    /// Electrons per second and pixel of the bare detector under sunlight as at 1 au; `None` if the aperture
    /// is unknown.
    bare_sun_e_per_s: Option<f64>,
}

/// Position on the detector, with its direction and solid angle.
#[derive(Debug, Clone, Copy)]
struct Node {
    /// Unit vector in the camera frame.
    direction: Vector3<f64>,
    /// Solid angle of the pixel, sr, times its transmission.
    pixel_sr: f64,
}

impl Background {
    /// Returns true if the Earth is part of the scene: it shines, and hides objects behind it.
    pub fn has_earth(&self) -> bool {
        self.config.earth.is_some()
    }

    /// Prepares the background of a camera; `None` if every part is off.
    ///
    /// # Errors
    /// [`SimError::OutOfRange`] for a number outside its range, and for stray light if the aperture is
    /// unknown.
    pub fn new(
        config: &BackgroundConfig,
        camera: &Camera,
        projection: &Projection,
        radiometry: &Radiometry,
    ) -> Result<Option<Self>, SimError> {
        config.check()?;
        if config.is_off() {
            return Ok(None);
        }
        let pixel_m2 = camera.pixel_width_um * camera.pixel_height_um * 1e-12;
        let to_sun = libm::pow(10.0, -0.4 * SUN_V_MAG_AT_1_AU);
        let bare_sun_e_per_s =
            radiometry.bare_sunlight_e_per_s_m2().map(|e_per_s_m2| e_per_s_m2 * to_sun * pixel_m2);
        let stray = config.sun.is_some() || config.earth.is_some() || config.moon.is_some();
        if stray && bare_sun_e_per_s.is_none() {
            return Err(OutOfRange::new(
                "radiometry.kind",
                "zero_point",
                "spectral, because stray light of background.sun, .earth, .moon depends on the aperture",
            )
            .into());
        }
        let (columns, rows) = projection.detector();
        let grid = Arc::new(NodeGrid::new(columns, rows));
        let nodes = (0..NODES * NODES)
            .map(|i| {
                let (x, y) = grid.node_position(i);
                Node::new(projection, x, y).ok_or_else(|| {
                    OutOfRange::new(
                        "camera",
                        format!("no direction for pixel ({x}, {y})"),
                        "a camera whose every pixel has a direction",
                    )
                })
            })
            .collect::<Result<Vec<_>, _>>()?;
        Ok(Some(Self {
            earth_transmittance: config
                .earth
                .as_ref()
                .map(|earth| TransmittanceTable::from_config(&earth.scatter)),
            config: config.clone(),
            grid,
            nodes,
            s10_e_per_s_sr: radiometry.sunlit(10.0) * SQUARE_DEGREES_PER_SR,
            bare_sun_e_per_s,
        }))
    }

    /// Returns this background behind optics with vignetting: light of the sky is reduced like that of a
    /// star. Stray light is not reduced, because it enters by other paths.
    pub fn vignetted(mut self, vignetting: &Vignetting) -> Self {
        for (i, node) in self.nodes.iter_mut().enumerate() {
            let (x, y) = self.grid.node_position(i);
            node.pixel_sr *= vignetting.transmission(PixelPoint::new(x, y));
        }
        self
    }

    /// Computes the background at `time` for an observer at `position_km` from the centre of the Earth, with
    /// the Sun at `sun_km` from the observer, ICRS axes.
    ///
    /// Directions are geometric: aberration (0.006°) is negligible in a smooth field.
    pub fn field(
        &self,
        time: Epoch,
        position_km: &Vector3<f64>,
        sun_km: &Vector3<f64>,
        camera_from_icrs: Rotation<CameraFrame, Icrs>,
    ) -> BackgroundField {
        let sun = sun_km.normalize();
        let (sun_rays, earth_rays, moon_rays) = self.rays(time, position_km, sun_km);
        let icrs_from_camera = camera_from_icrs.inverse();
        let e_per_s = std::array::from_fn(|i| {
            let Node { direction, pixel_sr } = self.nodes[i];
            let direction = icrs_from_camera.rotate(&direction);
            let mut s10 = self.config.faint_stars_s10;
            if self.config.zodiacal == Switch::On {
                s10 += zodiacal::zodiacal_s10(&direction, &sun);
            }
            let mut suns = 0.0;
            for (stray, rays) in
                [(self.config.sun.as_ref(), &sun_rays), (self.config.moon.as_ref(), &moon_rays)]
            {
                let Some(stray) = stray else { continue };
                for ray in rays {
                    suns += ray.suns * stray.transmittance(&direction, &ray.direction);
                }
            }
            if let Some(transmittance) = &self.earth_transmittance {
                for ray in &earth_rays {
                    suns += ray.suns * transmittance.transmittance_at_cos(direction.dot(&ray.direction));
                }
            }
            s10 * self.s10_e_per_s_sr * pixel_sr + suns * self.bare_sun_e_per_s.unwrap_or(0.0)
        });
        BackgroundField { e_per_s: SmoothField::new(Arc::clone(&self.grid), e_per_s) }
    }

    /// Light that reaches the aperture from Sun, Earth and Moon; no rays from sources that are off.
    fn rays(
        &self,
        time: Epoch,
        position_km: &Vector3<f64>,
        sun_km: &Vector3<f64>,
    ) -> (Vec<Ray>, Vec<Ray>, Vec<Ray>) {
        let sun_direction = sun_km.normalize();
        let sun_au = sun_km.norm() / AU_KM;
        let suns = 1.0 / (sun_au * sun_au);
        let earth_to_sun_km = position_km + sun_km;
        let (mut sun_rays, mut earth_rays, mut moon_rays) = (Vec::new(), Vec::new(), Vec::new());
        if self.config.sun.is_some() {
            let seen = shadow::sunlit_fraction(position_km, &earth_to_sun_km);
            sun_rays.push(Ray { direction: sun_direction, suns: suns * seen });
        }
        if let Some(earth) = &self.config.earth {
            let sun = earth_to_sun_km.normalize();
            stray::earth_rays(position_km, &sun, suns, earth.albedo, &mut earth_rays);
        }
        if self.config.moon.is_some() {
            let moon_km = moon::moon_position_km(clock::tdb_j2000_s(time));
            let to_moon_km = moon_km - position_km;
            let moon_to_sun_km = earth_to_sun_km - moon_km;
            let phase_deg =
                libm::atan2(moon_to_sun_km.cross(&-to_moon_km).norm(), moon_to_sun_km.dot(&-to_moon_km))
                    .to_degrees();
            let nearness = MOON_MEAN_DISTANCE_KM / to_moon_km.norm();
            let magnitude = moon::moon_magnitude(phase_deg) - SUN_V_MAG_AT_1_AU;
            let seen = shadow::visible_fraction(position_km, &moon_km, MOON_RADIUS_KM);
            moon_rays.push(Ray {
                direction: to_moon_km.normalize(),
                suns: suns * seen * nearness * nearness * libm::pow(10.0, -0.4 * magnitude),
            });
        }
        (sun_rays, earth_rays, moon_rays)
    }
}

impl Node {
    /// Direction and solid angle of the pixel at (x, y); `None` if the pixel has no direction.
    fn new(projection: &Projection, x: f64, y: f64) -> Option<Self> {
        let at = |dx: f64, dy: f64| {
            projection.unproject(PixelPoint::new(x + dx, y + dy)).map(|direction| *direction.vector())
        };
        let across = at(0.5, 0.0)? - at(-0.5, 0.0)?;
        let down = at(0.0, 0.5)? - at(0.0, -0.5)?;
        Some(Self { direction: at(0.0, 0.0)?, pixel_sr: across.cross(&down).norm() })
    }
}

/// Background of one frame: electrons per second in each pixel, bilinear between the nodes of a grid.
#[derive(Debug, Clone, PartialEq)]
pub struct BackgroundField {
    e_per_s: SmoothField,
}

impl BackgroundField {
    /// Photoelectrons per second and pixel, averaged over the detector.
    pub fn mean_e_per_s(&self) -> f64 {
        self.e_per_s.mean()
    }

    /// Photoelectrons per second as a field over the detector.
    pub fn smooth(&self) -> &SmoothField {
        &self.e_per_s
    }

    /// Computes the photoelectrons per second of every pixel, row by row; replaces the contents of `out`.
    pub fn electrons_per_s(&self, out: &mut Vec<f64>) {
        let (columns, rows) = self.e_per_s.size();
        out.clear();
        out.resize(columns * rows, 0.0);
        for (y, row) in out.chunks_exact_mut(columns.max(1)).enumerate() {
            self.e_per_s.span(0, y, row);
        }
    }
}

#[cfg(test)]
mod tests;
