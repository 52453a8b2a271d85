//! Truth of a field.

use contract::PixelPoint;
use contract::docking::{Lines, Pose};
use hifitime::Epoch;
use nalgebra::Vector3;
use sensor::television::VideoTruth;

use super::GlintImage;

/// Truth of one field, at the time of the field; one row of a truth table. Coordinates are pixels of the
/// camera, also for a field; the frames are those of [`Pose`].
#[derive(Debug, Clone, PartialEq)]
pub struct FieldTruth {
    /// Number of the field.
    pub field: u64,
    /// Time of the field, s since the beginning.
    pub time_s: f64,
    /// Time of the field.
    pub time: Epoch,
    /// Camera rows that the field holds.
    pub lines: Lines,
    /// Index of the camera that took the field, 0-based.
    pub camera: usize,
    /// Pose: d and φ.
    pub pose: Pose,
    /// Velocity dd/dt, m/s.
    pub velocity_m_s: Vector3<f64>,
    /// Angular rates dφ/dt, rad/s.
    pub phi_rate_rad_s: Vector3<f64>,
    /// Range ρ = |d|, m.
    pub range_m: f64,
    /// Range rate u = dρ/dt, m/s; negative when closing.
    pub range_rate_m_s: f64,
    /// Passive pitch α, rad.
    pub passive_pitch_rad: f64,
    /// Passive yaw β, rad.
    pub passive_yaw_rad: f64,
    /// Unit vector towards the Sun, target frame; `None` on the night side.
    pub sun: Option<Vector3<f64>>,
    /// True if the lamp is on.
    pub floodlight: bool,
    /// Image of the centre of the cross's front face, with distortion; `None` behind the camera or far
    /// outside the picture.
    pub cross_centre: Option<PixelPoint>,
    /// Image of the disk's centre, with distortion; `None` behind the camera or far outside the picture.
    pub disk_centre: Option<PixelPoint>,
    /// f r/x3 of the circle of the marks: f along columns, px, x3 the distance of the disk's centre along the
    /// optical axis. Without tilt it is the circle's radius in an image without distortion.
    pub circle_radius_px: Option<f64>,
    /// Bit i is set if every corner of mark i is in the picture.
    pub marks_in_field: u64,
    /// Bit i is set if part of mark i is shadowed from a source that shines on the target's front, the Sun or
    /// the lamp (sampled at 5 × 5 points, including the border); 0 if no source does.
    pub marks_shadowed: u64,
    /// Bit i is set if neither Sun nor lamp shines on any part of mark i (sampled at the points of
    /// `marks_shadowed`).
    pub marks_dark: u64,
    /// Bit i is set if an object, most often the cross, lies between the camera and part of mark i (sampled
    /// at the points of `marks_shadowed`).
    pub marks_hidden: u64,
    /// Fraction of the plate illuminated by the Sun or the lamp (sampled at 96 points).
    pub plate_lit: f64,
    /// True if the whole cross is in the picture.
    pub cross_in_field: bool,
    /// True if the whole target (plate, marks and cross) is in the picture.
    pub target_in_field: bool,
    /// Image of the Sun's centre if part of the Sun's disk is in the picture and not hidden.
    pub sun_image: Option<PixelPoint>,
    /// Unobstructed fraction of the Sun's disk; 0 if the Sun is not in the picture.
    pub sun_visible: f64,
    /// Bit i is set if glint i of the scenario shines into the picture.
    pub glints_shining: u64,
    /// Brightest glint in the picture, if any.
    pub glint: Option<GlintImage>,
    /// Truth of the television chain: the applied contrast, brightness and lost lines.
    pub video: VideoTruth,
}
