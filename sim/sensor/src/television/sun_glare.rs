//! The Sun in the field of view: its disk, veiling glare, a streak and a ghost.

use contract::PixelPoint;
use contract::docking::Lines;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Effects of the Sun on the picture when it is in the field of view, in units of the white level; all are
/// multiplied by the visible share of its disk.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct SunGlareConfig {
    /// Level of the disk, 0 to 1e4.
    #[schemars(range(min = 0, max = 1e4))]
    pub disk_level: f64,
    /// Veiling glare: level at the centre of the disk, 0 to 10. It falls as 1/(1 + (θ/θ0)²).
    #[schemars(range(min = 0, max = 10))]
    pub veil_level: f64,
    /// θ0 of the veiling glare, degrees, 0.1 to 90.
    #[schemars(range(min = 0.1, max = 90))]
    pub veil_half_angle_deg: f64,
    /// Level of a streak along the column through the Sun, 0 to 10.
    #[schemars(range(min = 0, max = 10))]
    pub streak_level: f64,
    /// Level of the ghost, a disk of three times the Sun's radius, opposite to the Sun about the principal
    /// point, 0 to 10.
    #[schemars(range(min = 0, max = 10))]
    pub ghost_level: f64,
}

impl Default for SunGlareConfig {
    fn default() -> Self {
        Self {
            disk_level: 50.0,
            veil_level: 0.35,
            veil_half_angle_deg: 3.0,
            streak_level: 0.25,
            ghost_level: 0.08,
        }
    }
}

/// Image of the Sun in a camera.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SunImage {
    /// Centre of the disk, px.
    pub centre: PixelPoint,
    /// Position of the ghost, px.
    pub ghost: PixelPoint,
    /// Radius of the disk, px.
    pub radius_px: f64,
    /// Pixels per radian.
    pub focal_px: f64,
    /// Visible share of the disk, 0 to 1.
    pub visible: f64,
}

/// Adds the Sun to the rows of a field.
pub(super) fn add(config: &SunGlareConfig, sun: &SunImage, signal: &mut [f32], columns: usize, lines: Lines) {
    if sun.visible <= 0.0 {
        return;
    }
    let visible = sun.visible as f32;
    let radius = sun.radius_px as f32;
    let (disk, ghost) = (config.disk_level as f32 * visible, config.ghost_level as f32 * visible);
    let (veil, streak) = (config.veil_level as f32 * visible, config.streak_level as f32 * visible);
    let veil_px = (libm::tan(config.veil_half_angle_deg.to_radians().min(1.5)) * sun.focal_px) as f32;
    let per_veil2 = 1.0 / (veil_px * veil_px);
    let (sun_x, sun_y) = (sun.centre.x as f32, sun.centre.y as f32);
    for (k, row) in signal.chunks_exact_mut(columns).enumerate() {
        let y = lines.camera_row(k) as f32;
        let dy2 = (y - sun_y) * (y - sun_y);
        for (x, pixel) in row.iter_mut().enumerate() {
            let dx = x as f32 - sun_x;
            let r2 = dx * dx + dy2;
            // The streak has the width of the disk and soft edges.
            let soft = (1.0 - dx.abs() / radius).max(0.0);
            *pixel += veil / (1.0 + r2 * per_veil2) + streak * soft;
        }
        add_disk(row, y, (sun_x, sun_y), radius, disk);
        add_disk(row, y, (sun.ghost.x as f32, sun.ghost.y as f32), 3.0 * radius, ghost);
    }
}

/// Adds one row of a disk with an edge one pixel wide.
fn add_disk(row: &mut [f32], y: f32, centre: (f32, f32), radius: f32, level: f32) {
    let dy = y - centre.1;
    if dy.abs() > radius + 1.0 {
        return;
    }
    let first = (centre.0 - radius - 1.0).max(0.0) as usize;
    let last = (centre.0 + radius + 2.0).max(0.0) as usize;
    for (x, pixel) in row.iter_mut().enumerate().take(last).skip(first) {
        let dx = x as f32 - centre.0;
        *pixel += level * (radius + 0.5 - (dx * dx + dy * dy).sqrt()).clamp(0.0, 1.0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_disk_has_its_area_and_nothing_is_added_when_it_is_hidden() {
        let bare = SunGlareConfig {
            disk_level: 10.0,
            veil_level: 0.0,
            streak_level: 0.0,
            ghost_level: 0.0,
            ..SunGlareConfig::default()
        };
        let sun = SunImage {
            centre: PixelPoint::new(60.3, 50.8),
            ghost: PixelPoint::new(20.0, 20.0),
            radius_px: 13.6,
            focal_px: 2917.0,
            visible: 1.0,
        };
        let mut signal = vec![0.0_f32; 120 * 100];
        add(&bare, &sun, &mut signal, 120, Lines::All);
        let area = signal.iter().map(|s| f64::from(*s)).sum::<f64>() / 10.0;
        // The linear edge is exact for a straight edge along the pixels, and accurate to 0.1 % for this
        // circle.
        assert!((area / (std::f64::consts::PI * 13.6 * 13.6) - 1.0).abs() < 1e-3, "{area}");
        let before = signal.clone();
        add(&SunGlareConfig::default(), &SunImage { visible: 0.0, ..sun }, &mut signal, 120, Lines::All);
        assert_eq!(signal, before);
    }
}
