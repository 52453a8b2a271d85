//! `truth/frames.parquet` and `truth/objects.parquet`.
//!
//! All numbers are 64-bit floats: a score of the files must be bit-identical to the score in memory, and it
//! depends on position, electrons, SNR, radius and cut. Directions of frames are stored as components, which
//! are read back bit for bit; those of objects, which no score uses, as right ascension and declination,
//! accurate to 1e-13 degrees.

use contract::{Body, CameraFrame, Direction, Icrs, PixelPoint, Rotation, Target};
use files::{table, without_dictionary};
use hifitime::Epoch;
use nalgebra::Vector3;
use sim::truth::{FrameTruth, ObjectKind, ObjectTruth, Shadow, Visibility};

table! {
    /// A row of `truth/frames.parquet`.
    pub struct FrameTruthRow for FrameTruth: parquet(frame) {
        /// number of the frame; ascending
        frame: u64,
        /// name of the frame's group (day, portion)
        group: String,
        /// middle of the exposure; for an interlaced frame the middle between its fields, to which the whole
        /// row refers
        time: Epoch = ["time_utc"],
        /// exposure time, s
        exposure_s: f64,
        /// true attitude of the body
        body_from_icrs: Rotation<Body, Icrs> = ["q_sc_j2000_w", "q_sc_j2000_x", "q_sc_j2000_y", "q_sc_j2000_z"],
        /// true attitude of the camera
        camera_from_icrs: Rotation<CameraFrame, Icrs> =
            ["q_cam_j2000_w", "q_cam_j2000_x", "q_cam_j2000_y", "q_cam_j2000_z"],
        /// position of the chaser from the centre of the Earth, km, ICRS axes
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
        /// photoelectrons per second and pixel from zodiacal light, faint stars and stray light: mean over
        /// the detector, without the sensor's constant
        background_e_per_s: f64,
        /// electrons that the frame transfer adds to a pixel in this exposure: mean over the detector, for a
        /// uniform response; 0 without `frame_transfer_s`
        smear_e_per_px: f64,
        /// position of the line of sight in the image, may be off the detector; null behind the camera. The
        /// centre of brightness of a body differs from it and is in `objects.parquet`
        target_position: Option<PixelPoint> = ["target_x_px", "target_y_px"],
        /// `detectable` (SNR 5 or more), `ambiguous` (2 to 5), `invisible`
        target_visibility: Visibility,
        /// true attitude of the target's body; null for a target without one (sphere, beacon)
        target_from_icrs: Option<Rotation<Target, Icrs>> =
            ["q_target_j2000_w", "q_target_j2000_x", "q_target_j2000_y", "q_target_j2000_z"],
    }
}

table! {
    /// A row of `truth/objects.parquet`.
    pub struct ObjectTruthRow for ObjectTruth: parquet(frame) {
        /// number of the frame; ascending
        frame: u64,
        /// `target`, `star`, `planet`, `moon`, `hot_pixel` or `cosmic_ray`
        kind: ObjectKind,
        /// 0 for the target; catalogue number for a star; number from the Sun outwards (1 to 8) for a planet;
        /// 0 for the Moon; row × columns + column for a hot pixel; number in the frame for a cosmic-ray hit
        id: u32,
        /// flux-weighted centre of the object's noise-free image; may be off the detector; for an interlaced
        /// frame the middle between the centres in its fields
        position: PixelPoint = without_dictionary(["x_px", "y_px"]),
        /// astrometric direction: proper motion and parallax applied, no aberration, no deflection; for the
        /// target the line of sight, for the Moon the centre of its disk; null for a hot pixel or cosmic-ray
        /// hit
        astrometric: Option<Direction<Icrs>> = without_dictionary(["ra_deg", "dec_deg"]),
        /// V magnitude; null for a hot pixel or cosmic-ray hit
        magnitude: Option<f64>,
        /// expected electrons on the detector in this exposure, before saturation
        electrons: f64 = without_dictionary(["electrons"]),
        /// expected electrons in the brightest pixel of the object in this exposure, before saturation
        peak_electrons: f64 = without_dictionary(["peak_electrons"]),
        /// √(Σ s²/(s + b + σ²)) over the object's pixels, the signal-to-noise ratio of a matched filter: s
        /// the object's electrons, b sky and dark current, σ² the variance of the readout: noise of pixel,
        /// row and column, and gain²/12 of the converter
        snr: f64 = without_dictionary(["snr"]),
        /// distance from the centre to the farthest pixel centre where s exceeds √(b + σ²), before blooming;
        /// at least 0.5
        radius_px: f64,
        /// additional distance beyond `radius_px` along the columns, up or down, whichever is larger, at
        /// which s exceeds √(b + σ²) after blooming of the object itself; 0 without blooming
        bloom_px: f64,
        /// fraction of the object's electrons outside the transmitted regions, 0 to 1; 0 without regions
        cut: f64,
    }
}
