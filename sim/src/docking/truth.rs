//! The truth about a field.

use contract::PixelPoint;
use contract::docking::{Lines, Pose};
use hifitime::Epoch;
use nalgebra::Vector3;

use super::GlintImage;
use crate::television::VideoTruth;

/// The truth about one field, at its own moment; one row of a truth table. Coordinates are the camera's pixels, also for a
/// field; the frames are those of [`Pose`].
#[derive(Debug, Clone, PartialEq)]
pub struct FieldTruth {
    /// Number of the field.
    pub field: u64,
    /// Its moment, s since the beginning.
    pub time_s: f64,
    /// Its moment.
    pub time: Epoch,
    /// The rows that it holds.
    pub lines: Lines,
    /// Which camera took it, 0-based.
    pub camera: usize,
    /// d and φ.
    pub pose: Pose,
    /// dd/dt, m/s.
    pub velocity_m_s: Vector3<f64>,
    /// dφ/dt, rad/s.
    pub phi_rate_rad_s: Vector3<f64>,
    /// ρ = |d|, m.
    pub range_m: f64,
    /// u = dρ/dt, m/s; negative when closing.
    pub range_rate_m_s: f64,
    /// α, passive pitch, rad.
    pub passive_pitch_rad: f64,
    /// β, passive yaw, rad.
    pub passive_yaw_rad: f64,
    /// Unit vector towards the Sun, target frame; `None` on the night side.
    pub sun: Option<Vector3<f64>>,
    /// Whether the lamp is on.
    pub floodlight: bool,
    /// Image of the centre of the cross's front face, with distortion; `None` behind the camera or far outside the picture.
    pub cross_centre: Option<PixelPoint>,
    /// Image of the disk's centre, likewise.
    pub disk_centre: Option<PixelPoint>,
    /// f r/x3 of the circle of the marks: f along columns, in px, x3 the distance of the disk's centre along the optical
    /// axis. Without tilt it is the circle's radius in an image without distortion.
    pub circle_radius_px: Option<f64>,
    /// Bit i: every corner of mark i is in the picture.
    pub marks_in_field: u64,
    /// Bit i: some of mark i lacks the light of a source that shines on the target's front, the Sun's or the lamp's (sampled
    /// at 5 × 5 places, its border included); 0 when no source does.
    pub marks_shadowed: u64,
    /// Bit i: neither Sun nor lamp shines on any of mark i (same places).
    pub marks_dark: u64,
    /// Bit i: something, the cross most often, stands between the camera and some of mark i (same places).
    pub marks_hidden: u64,
    /// Share of the plate that the Sun or the lamp shines on (sampled at 96 places).
    pub plate_lit: f64,
    /// Whether the whole cross is in the picture.
    pub cross_in_field: bool,
    /// Whether the whole target, plate and marks and cross, is in the picture.
    pub target_in_field: bool,
    /// Image of the Sun's centre when some of its disk is in the picture and not hidden.
    pub sun_image: Option<PixelPoint>,
    /// Share of the Sun's disk that nothing hides; 0 where it is not in the picture.
    pub sun_visible: f64,
    /// Bit i: glint i of the scenario shines into the picture.
    pub glints_shining: u64,
    /// The brightest glint in the picture, if any.
    pub glint: Option<GlintImage>,
    /// What the television chain did.
    pub video: VideoTruth,
}
