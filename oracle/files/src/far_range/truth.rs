//! `truth/frames.parquet` and `truth/objects.parquet`.
//!
//! Everything is a 64-bit float: a score from the files must be the score from memory to the bit, and each of
//! position, electrons, SNR, radius and cut decides in it. Directions of frames stand as components, which come back
//! to the bit; those of objects, which no score uses, as right ascension and declination, good to 1e-13 degrees.

use contract::{Body, CameraFrame, Direction, Icrs, PixelPoint, Rotation, Target};
use hifitime::Epoch;
use nalgebra::Vector3;
use sim::truth::{FrameTruth, ObjectKind, ObjectTruth, Shadow, Visibility};

use crate::table::field::words;
use crate::{table, without_dictionary};

words!(Shadow, Visibility, ObjectKind);

table!(for FrameTruth: parquet(frame) {
    /// number of the frame; ascending
    frame: u64,
    /// name of its group (day, portion)
    group: String,
    /// middle of the exposure; of an interlaced frame the middle between its fields, for which all of the row holds
    time: Epoch = ["time_utc"],
    /// exposure time, s
    exposure_s: f64,
    /// true attitude of the body
    body_from_icrs: Rotation<Body, Icrs> = ["q_sc_j2000_w", "q_sc_j2000_x", "q_sc_j2000_y", "q_sc_j2000_z"],
    /// true attitude of the camera
    camera_from_icrs: Rotation<CameraFrame, Icrs> =
        ["q_cam_j2000_w", "q_cam_j2000_x", "q_cam_j2000_y", "q_cam_j2000_z"],
    /// chaser from the centre of the Earth, km, ICRS axes
    position_km: Vector3<f64> = ["position_x_km", "position_y_km", "position_z_km"],
    /// velocity of the chaser about the Earth, km/s, ICRS axes
    velocity_km_s: Vector3<f64> = ["velocity_x_km_s", "velocity_y_km_s", "velocity_z_km_s"],
    /// line of sight from the chaser to the target (the origin of its body frame): unit vector, geometric
    line_of_sight: Direction<Icrs> = ["los_j2000_x", "los_j2000_y", "los_j2000_z"],
    /// distance between chaser and target, km
    range_km: f64,
    /// direction from the chaser to the Sun: unit vector, geometric
    sun: Direction<Icrs> = ["sun_j2000_x", "sun_j2000_y", "sun_j2000_z"],
    /// angle at the target between Sun and chaser, 0 to 180
    phase_deg: f64,
    /// Earth's shadow on the target: `sunlit`, `penumbra`, `umbra`
    shadow: Shadow,
    /// fraction of the Sun's disk seen from the target, 0 to 1
    sunlit_fraction: f64,
    /// photo-electrons a second and pixel of zodiacal light, faint stars and stray light: mean over the detector, without the sensor's
    /// constant
    background_e_per_s: f64,
    /// electrons that the frame transfer adds to a pixel in this exposure: mean over the detector, with an even response; 0 without
    /// `frame_transfer_s`
    smear_e_per_px: f64,
    /// where the line of sight meets the image, may be off the detector; null behind the camera. A body's centre of brightness is
    /// elsewhere: in `objects.parquet`
    target_position: Option<PixelPoint> = ["target_x_px", "target_y_px"],
    /// `detectable` (SNR 5 or more), `ambiguous` (2 to 5), `invisible`
    target_visibility: Visibility,
    /// true attitude of the target's body; null for a target without one (sphere, beacon)
    target_from_icrs: Option<Rotation<Target, Icrs>> =
        ["q_target_j2000_w", "q_target_j2000_x", "q_target_j2000_y", "q_target_j2000_z"],
});

table!(for ObjectTruth: parquet(frame) {
    /// number of the frame; ascending
    frame: u64,
    /// `target`, `star`, `planet`, `moon`, `hot_pixel` or `cosmic_ray`
    kind: ObjectKind,
    /// of the target 0; of a star the catalogue's number; of a planet its number from the Sun outwards (1 to 8); of the Moon 0; of a hot
    /// pixel row × columns + column; of a track its number in the frame
    id: u32,
    /// centre of its image without noise (mean by light); may be off the detector; of an interlaced frame the middle between the
    /// centres in its fields
    position: PixelPoint = without_dictionary(["x_px", "y_px"]),
    /// astrometric direction: proper motion and parallax applied, no aberration, no deflection; of the target the line of sight, of
    /// the Moon the centre of its disk; null for a hot pixel or track
    astrometric: Option<Direction<Icrs>> = without_dictionary(["ra_deg", "dec_deg"]),
    /// V; null for a hot pixel or track
    magnitude: Option<f64>,
    /// expected electrons on the detector in this exposure, before saturation
    electrons: f64 = without_dictionary(["electrons"]),
    /// the same in its brightest pixel
    peak_electrons: f64 = without_dictionary(["peak_electrons"]),
    /// √(Σ s²/(s + b + σ²)) over its pixels: s its electrons, b sky and dark current, σ² the variance of the readout: noise of pixel, row
    /// and column, and gain²/12 of the converter; that of a matched filter
    snr: f64 = without_dictionary(["snr"]),
    /// distance from the centre to the farthest pixel centre where s exceeds √(b + σ²), before blooming; at least 0.5
    radius_px: f64,
    /// how much farther than `radius_px` s exceeds it along the columns after blooming of the object alone, up or down, whichever is
    /// more; 0 without
    bloom_px: f64,
    /// fraction of its electrons outside the transmitted regions, 0 to 1; 0 without regions
    cut: f64,
});
