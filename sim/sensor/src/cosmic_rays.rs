//! Cosmic-ray hits: straight tracks of charge through the sensitive layer.

use contract::bounds::require;
use contract::{Camera, OutOfRange, PixelPoint};
use draws::{Effect, Seed, Stream, normal, uniform};
use hifitime::Epoch;
use nalgebra::Vector3;
use optics::Stamp;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use truth::geographic;

use super::pixel::poisson::poisson;

/// Charged particles that cross the detector.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CosmicRayConfig {
    /// Particles through the detector's face outside the South Atlantic Anomaly, per cm² and second, 0 to
    /// 1e4. The Hubble Space Telescope's CCDs receive about 1 (Miles et al., ApJ 918, 86, 2021).
    #[schemars(range(min = 0, max = 1e4))]
    pub rate_per_cm2_s: f64,
    /// Thickness of the layer from which charge is collected, µm, 0.1 to 1000.
    #[schemars(range(min = 0.1, max = 1000))]
    pub thickness_um: f64,
    /// Time in addition to the exposure in which the detector collects hits, s, 0 to 1000: storage and
    /// readout.
    #[serde(default)]
    #[schemars(range(min = 0, max = 1000))]
    pub readout_s: f64,
    /// Mean charge along a track, electrons per µm, 1 to 1e5. A minimum ionising particle releases about 80
    /// in silicon; slow protons release more.
    #[serde(default = "minimum_ionising")]
    #[schemars(range(min = 1, max = 1e5))]
    pub mean_e_per_um: f64,
    /// Scale of the fluctuation of the charge along a track, electrons per µm, 0 to 1e4: the width ξ of the
    /// Landau distribution. In silicon 4.9 (ξ of 17.8 eV/µm, and 3.65 eV per pair; Particle Data Group,
    /// Passage of particles through matter, Sec. 34.2.9).
    #[serde(default = "landau_width")]
    #[schemars(range(min = 0, max = 1e4))]
    pub landau_e_per_um: f64,
    /// South Atlantic Anomaly; without the table the rate is constant along the orbit.
    #[serde(default)]
    pub south_atlantic: Option<SouthAtlanticConfig>,
}

fn minimum_ionising() -> f64 {
    80.0
}

fn landau_width() -> f64 {
    4.9
}

/// South Atlantic Anomaly: a peak of the rate over the globe, independent of altitude.
///
/// The factor is 1 + (`peak_factor` − 1) exp(−(Δφ/`latitude_sigma_deg`)²/2 − (Δλ/`longitude_sigma_deg`)²/2),
/// with φ the geocentric latitude and λ the longitude. At 540 km the peak is 1100 particles per cm² and
/// second against about 1 outside (Miles et al., ApJ 918, 86, 2021): the default of `peak_factor`. Position
/// and widths are assumptions; the anomaly drifts west by 0.3° per year.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct SouthAtlanticConfig {
    /// Ratio of the rate at the centre to the rate outside, 1 to 1e5.
    #[schemars(range(min = 1, max = 1e5))]
    pub peak_factor: f64,
    /// Latitude of the centre, degrees, −90 to 90.
    #[schemars(range(min = -90, max = 90))]
    pub latitude_deg: f64,
    /// Longitude of the centre, degrees east, −180 to 180.
    #[schemars(range(min = -180, max = 180))]
    pub longitude_deg: f64,
    /// Standard deviation in latitude, degrees, 1 to 90.
    #[schemars(range(min = 1, max = 90))]
    pub latitude_sigma_deg: f64,
    /// Standard deviation in longitude, degrees, 1 to 180.
    #[schemars(range(min = 1, max = 180))]
    pub longitude_sigma_deg: f64,
}

impl Default for SouthAtlanticConfig {
    fn default() -> Self {
        Self {
            peak_factor: 1100.0,
            latitude_deg: -26.0,
            longitude_deg: -53.0,
            latitude_sigma_deg: 9.0,
            longitude_sigma_deg: 18.0,
        }
    }
}

impl SouthAtlanticConfig {
    /// Factor of the rate at a latitude and longitude.
    fn factor(&self, latitude_deg: f64, longitude_deg: f64) -> f64 {
        let turn = longitude_deg - self.longitude_deg;
        let east = turn - 360.0 * (turn / 360.0).round();
        let (v, u) =
            ((latitude_deg - self.latitude_deg) / self.latitude_sigma_deg, east / self.longitude_sigma_deg);
        1.0 + (self.peak_factor - 1.0) * libm::exp(-0.5 * (u * u + v * v))
    }
}

impl CosmicRayConfig {
    /// Checks the bound on the number of hits in a frame.
    pub(super) fn check(&self) -> Result<(), OutOfRange> {
        let Some(bump) = &self.south_atlantic else { return Ok(()) };
        let expected = "at most 1e5 particles per cm² and second (value: factor × rate_per_cm2_s)";
        let peak = self.rate_per_cm2_s * bump.peak_factor;
        require("sensor.cosmic_rays.south_atlantic.peak_factor", peak, expected, |v| v <= 1e5)
    }
}

/// Maximum number of hits in a frame: each hit has a row in the truth table.
const MAX_HITS: f64 = 1e5;

/// Generator of the cosmic-ray hits on a camera's detector.
#[derive(Debug, Clone, PartialEq)]
pub struct CosmicRays {
    config: CosmicRayConfig,
    columns: usize,
    rows: usize,
    pixel_width_um: f64,
    pixel_height_um: f64,
}

/// Track of one particle: its entry, its extent across the detector and its charge. It may leave the
/// detector.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CosmicRayHit {
    start: PixelPoint,
    /// Displacement from the entry to the exit, in columns and rows.
    across: (f64, f64),
    /// Charge of the whole track, electrons.
    electrons: f64,
}

impl CosmicRays {
    /// Creates the generator from a configuration that was checked with its sensor.
    pub fn new(config: &CosmicRayConfig, camera: &Camera) -> Self {
        Self {
            config: config.clone(),
            columns: camera.columns,
            rows: camera.rows,
            pixel_width_um: camera.pixel_width_um,
            pixel_height_um: camera.pixel_height_um,
        }
    }

    /// Particles per cm² and second at `position_km`, relative to the Earth's centre in ICRS axes.
    pub fn rate_per_cm2_s(&self, time: Epoch, position_km: &Vector3<f64>) -> f64 {
        let factor = self.config.south_atlantic.map_or(1.0, |bump| {
            let (latitude, longitude) = geographic(time, position_km);
            bump.factor(latitude.degrees(), longitude.degrees())
        });
        self.config.rate_per_cm2_s * factor
    }

    /// Rejects a configuration with more expected hits in a frame than the maximum, at the highest rate and
    /// an exposure of `longest_s`.
    pub fn check_hits(&self, longest_s: f64) -> Result<(), OutOfRange> {
        let peak = self.config.south_atlantic.map_or(1.0, |bump| bump.peak_factor);
        let hits = self.mean_hits(longest_s, self.config.rate_per_cm2_s * peak);
        let value = format!("{} ({hits:.3e} hits in a frame of {longest_s} s)", self.config.rate_per_cm2_s);
        let expected = "at most 1e5 hits per frame: highest rate × area × (longest exposure + readout_s)";
        let refused = || OutOfRange::new("sensor.cosmic_rays.rate_per_cm2_s", value, expected);
        if hits <= MAX_HITS { Ok(()) } else { Err(refused()) }
    }

    /// Mean number of hits in a frame.
    fn mean_hits(&self, exposure_s: f64, rate_per_cm2_s: f64) -> f64 {
        let area_cm2 =
            1e-8 * self.pixel_width_um * self.pixel_height_um * self.columns as f64 * self.rows as f64;
        rate_per_cm2_s * area_cm2 * (exposure_s + self.config.readout_s)
    }

    /// Returns the tracks of a frame. The first `n` tracks are the same for every rate.
    pub fn hits(&self, seed: &Seed, frame: u64, exposure_s: f64, rate_per_cm2_s: f64) -> Vec<CosmicRayHit> {
        let mean = self.mean_hits(exposure_s, rate_per_cm2_s);
        let streams = seed.streams(frame, Effect::CosmicRays);
        let count = poisson(mean, &mut streams.stream_at(0)) as u64;
        (1..=count).map(|number| self.draw_hit(&mut streams.stream_at(number))).collect()
    }

    /// Returns one particle of an isotropic flux. It crosses the face at a uniformly distributed position, at
    /// an angle θ from the normal with the density 2 cos θ of cos θ (the face seen from θ is smaller by cos
    /// θ). Its charge per µm follows the Moyal distribution (Phil. Mag. 46, 1955), an approximation of the
    /// Landau distribution: the mean plus ξ (m − γ − ln 2), where m = −ln z² of a standard normal z has the
    /// Moyal density.
    fn draw_hit(&self, stream: &mut Stream) -> CosmicRayHit {
        const MOYAL_MEAN: f64 = 1.270_362_845_461_478;
        let x = self.columns as f64 * uniform(stream) - 0.5;
        let y = self.rows as f64 * uniform(stream) - 0.5;
        let cos2 = uniform(stream);
        let depth_um = self.config.thickness_um;
        let across_um = depth_um * ((1.0 - cos2) / cos2).sqrt();
        let (sin, cos) = libm::sincos(2.0 * std::f64::consts::PI * uniform(stream));
        let z = normal(stream);
        let moyal = -libm::log((z * z).max(f64::MIN_POSITIVE));
        let e_per_um = self.config.mean_e_per_um + self.config.landau_e_per_um * (moyal - MOYAL_MEAN);
        CosmicRayHit {
            start: PixelPoint::new(x, y),
            across: (across_um * cos / self.pixel_width_um, across_um * sin / self.pixel_height_um),
            electrons: e_per_um.max(0.0) * depth_um / cos2.sqrt(),
        }
    }

    /// Sets `stamp` to the image of a track. The charge is uniform along the track; each pixel receives the
    /// charge of the length inside it. Charge off the detector is dropped.
    pub fn stamp(&self, hit: &CosmicRayHit, stamp: &mut Stamp) {
        let (dx, dy) = hit.across;
        // Share of the track's length at which it leaves the detector; it starts inside.
        let leaves = |at: f64, by: f64, size: usize| {
            let edge = if by > 0.0 { size as f64 - 0.5 } else { -0.5 };
            if by == 0.0 { 1.0 } else { ((edge - at) / by).clamp(0.0, 1.0) }
        };
        let inside = leaves(hit.start.x, dx, self.columns).min(leaves(hit.start.y, dy, self.rows));
        let (dx, dy, electrons) = (dx * inside, dy * inside, hit.electrons * inside);
        let (columns, rows) = (self.columns.saturating_sub(1), self.rows.saturating_sub(1));
        let pixel = |at: f64, last: usize| (at.round().max(0.0) as usize).min(last);
        let (x0, x1) = (pixel(hit.start.x, columns), pixel(hit.start.x + dx, columns));
        let (y0, y1) = (pixel(hit.start.y, rows), pixel(hit.start.y + dy, rows));
        let centre = PixelPoint::new(hit.start.x + 0.5 * dx, hit.start.y + 0.5 * dy);
        stamp.reset(centre, (x0.min(x1), x0.max(x1) + 1), (y0.min(y1), y0.max(y1) + 1));
        // Steps from one pixel border to the next.
        let border = |pixel: usize, at: f64, by: f64| match by {
            b if b > 0.0 => (pixel as f64 + 0.5 - at) / b,
            b if b < 0.0 => (pixel as f64 - 0.5 - at) / b,
            _ => f64::INFINITY,
        };
        let (mut x, mut y, mut done) = (x0, y0, 0.0);
        while (x, y) != (x1, y1) {
            let (to_x, to_y) = (border(x, hit.start.x, dx), border(y, hit.start.y, dy));
            // Rounding errors must not lead past the last pixel.
            let along_x = if x == x1 { false } else { y == y1 || to_x <= to_y };
            let next = if along_x { to_x } else { to_y }.clamp(done, 1.0);
            stamp.add(x, y, electrons * (next - done));
            done = next;
            match along_x {
                true => x = if dx > 0.0 { x + 1 } else { x - 1 },
                false => y = if dy > 0.0 { y + 1 } else { y - 1 },
            }
        }
        stamp.add(x1, y1, electrons * (1.0 - done));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pixel::distribution::tests::{chi_square_p, histogram};
    use statrs::distribution::{Discrete, Poisson};

    const SEED: Seed = Seed { seed: 3, case: 0 };

    fn rays() -> CosmicRays {
        CosmicRays {
            config: CosmicRayConfig {
                rate_per_cm2_s: 1.0,
                thickness_um: 20.0,
                readout_s: 0.5,
                mean_e_per_um: 80.0,
                landau_e_per_um: 4.9,
                south_atlantic: None,
            },
            columns: 752,
            rows: 580,
            pixel_width_um: 8.6,
            pixel_height_um: 8.3,
        }
    }

    fn sum(stamp: &Stamp) -> f64 {
        stamp.rows().flat_map(|(_, _, row)| row).sum()
    }

    #[test]
    fn hits_are_poisson_with_the_rate_times_area_times_time() {
        let rays = rays();
        let counts = histogram((0..20_000).map(|frame| rays.hits(&SEED, frame, 9.5, 1.0).len()));
        // 10 s on 0.6467 cm × 0.4814 cm.
        let law = Poisson::new(10.0 * 0.064672 * 10.0 * 0.04814 * 10.0).unwrap();
        let expected: Vec<f64> = (0..counts.len() as u64 + 10).map(|k| law.pmf(k)).collect();
        assert!(chi_square_p(&counts, &expected) > 1e-4);
    }

    fn many() -> Vec<CosmicRayHit> {
        (0..40_000).map(|index| rays().draw_hit(&mut SEED.stream(1, Effect::CosmicRays, index))).collect()
    }

    #[test]
    fn lengths_follow_from_isotropy() {
        // P(tan θ > t) = 1/(1 + t²); twenty bins of equal probability.
        let bin = |hit: &CosmicRayHit| {
            let tangent = libm::hypot(hit.across.0 * 8.6, hit.across.1 * 8.3) / 20.0;
            ((20.0 / (1.0 + tangent * tangent)) as usize).min(19)
        };
        let counts = histogram(many().iter().map(bin));
        assert!(chi_square_p(&counts, &[0.05; 20]) > 1e-4);
    }

    #[test]
    fn charge_follows_moyals_distribution_and_grows_with_the_path() {
        let bin = |hit: &CosmicRayHit| {
            let across_um = libm::hypot(hit.across.0 * 8.6, hit.across.1 * 8.3);
            let e_per_um = hit.electrons / libm::hypot(across_um, 20.0);
            // The cumulative distribution function of the Moyal distribution is erfc(exp(−m/2)/√2).
            let moyal = (e_per_um - 80.0) / 4.9 + 1.270362845;
            let below = libm::erfc(libm::exp(-0.5 * moyal) * std::f64::consts::FRAC_1_SQRT_2);
            ((20.0 * below) as usize).min(19)
        };
        let counts = histogram(many().iter().map(bin));
        assert!(chi_square_p(&counts, &[0.05; 20]) > 1e-4);
    }

    #[test]
    fn a_stamp_holds_the_charge_of_its_track_evenly_along_it() {
        let rays = rays();
        let mut stamp = Stamp::new();
        for (start, across) in [
            ((100.2, 50.1), (0.0, 0.0)),
            ((100.2, 50.1), (7.3, 4.9)),
            ((100.2, 50.1), (-7.3, 0.0)),
            ((100.5, 50.5), (3.0, -3.0)),
            ((0.0, 0.0), (0.1, 300.0)),
        ] {
            let hit = CosmicRayHit { start: PixelPoint::new(start.0, start.1), across, electrons: 1000.0 };
            rays.stamp(&hit, &mut stamp);
            assert!((sum(&stamp) - 1000.0).abs() < 1e-9, "{hit:?}");
            // The centre of charge is the middle of the track, to within half a pixel along each axis, the
            // resolution of a pixel.
            let (mut x, mut y) = (0.0, 0.0);
            for (column, row, electrons) in stamp.rows() {
                for (i, e) in electrons.iter().enumerate() {
                    x += (column + i) as f64 * e / 1000.0;
                    y += row as f64 * e / 1000.0;
                }
            }
            assert!(PixelPoint::new(x, y).distance(stamp.centre()) < 0.71, "{hit:?}: {x}, {y}");
        }
        // Four whole pixels and two half pixels along a row.
        let hit = CosmicRayHit { start: PixelPoint::new(10.0, 10.0), across: (5.0, 0.0), electrons: 1000.0 };
        rays.stamp(&hit, &mut stamp);
        let row: Vec<f64> = stamp.rows().next().unwrap().2.to_vec();
        assert_eq!(row.len(), 6);
        assert!(
            row.iter().zip([100.0, 200.0, 200.0, 200.0, 200.0, 100.0]).all(|(a, b)| (a - b).abs() < 1e-9)
        );
    }

    #[test]
    fn a_track_that_leaves_the_detector_leaves_its_charge_there() {
        let mut stamp = Stamp::new();
        let hit = CosmicRayHit { start: PixelPoint::new(749.5, 10.0), across: (8.0, 0.0), electrons: 800.0 };
        rays().stamp(&hit, &mut stamp);
        assert!((sum(&stamp) - 200.0).abs() < 1e-9);
        for hit in many() {
            rays().stamp(&hit, &mut stamp);
            assert!(sum(&stamp) <= hit.electrons * (1.0 + 1e-12));
        }
    }

    #[test]
    fn the_anomaly_is_a_bump_at_its_position() {
        let bump = SouthAtlanticConfig::default();
        assert_eq!(bump.factor(-26.0, -53.0), 1100.0);
        assert!((bump.factor(-26.0 + 9.0, -53.0) - (1.0 + 1099.0 * libm::exp(-0.5))).abs() < 1e-9);
        assert!((bump.factor(-26.0, 307.0 - 18.0) - (1.0 + 1099.0 * libm::exp(-0.5))).abs() < 1e-9);
        assert!((bump.factor(50.0, 100.0) - 1.0).abs() < 1e-9);
    }
}
