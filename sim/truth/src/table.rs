//! Truth table: one row per frame, and one row per object in a frame.

use contract::{Body, CameraFrame, Direction, Icrs, PixelPoint, Rotation, Target};
use hifitime::Epoch;
use nalgebra::Vector3;

/// Position of the target relative to the Earth's shadow.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shadow {
    /// The whole disk of the Sun is visible from the target.
    Sunlit,
    /// Part of the Sun's disk is visible.
    Penumbra,
    /// The Sun is completely hidden.
    Umbra,
}

impl Shadow {
    /// Returns the word used in files.
    pub fn code(self) -> &'static str {
        match self {
            Self::Sunlit => "sunlit",
            Self::Penumbra => "penumbra",
            Self::Umbra => "umbra",
        }
    }

    /// Parses a [`Shadow::code`]; `None` for any other text.
    pub fn parse(code: &str) -> Option<Self> {
        [Self::Sunlit, Self::Penumbra, Self::Umbra].into_iter().find(|shadow| shadow.code() == code)
    }
}

/// Visibility class of an object, determined only by its signal-to-noise ratio.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Visibility {
    /// SNR of 5 or more: a matched filter detects the object.
    Detectable,
    /// SNR from 2 to 5: neither a detection nor a miss counts as an error.
    Ambiguous,
    /// SNR below 2.
    Invisible,
}

impl Visibility {
    /// Returns the class of a signal-to-noise ratio.
    pub fn from_snr(snr: f64) -> Self {
        match snr {
            s if s >= 5.0 => Self::Detectable,
            s if s >= 2.0 => Self::Ambiguous,
            _ => Self::Invisible,
        }
    }

    /// Returns the word used in files.
    pub fn code(self) -> &'static str {
        match self {
            Self::Detectable => "detectable",
            Self::Ambiguous => "ambiguous",
            Self::Invisible => "invisible",
        }
    }

    /// Parses a [`Visibility::code`]; `None` for any other text.
    pub fn parse(code: &str) -> Option<Self> {
        [Self::Detectable, Self::Ambiguous, Self::Invisible].into_iter().find(|class| class.code() == code)
    }
}

/// Ground truth about a whole frame.
#[derive(Debug, Clone, PartialEq)]
pub struct FrameTruth {
    /// Number of the frame in the scenario.
    pub frame: u64,
    /// Name of the group (a day, a portion) that the frame belongs to.
    pub group: String,
    /// Middle of the exposure; for an interlaced frame, the middle between the mid-exposure times of its two
    /// fields. All other values of the table refer to this time.
    pub time: Epoch,
    /// Exposure time, s; for an interlaced frame, of each field.
    pub exposure_s: f64,
    /// True attitude of the chaser.
    pub body_from_icrs: Rotation<Body, Icrs>,
    /// True attitude of the camera.
    pub camera_from_icrs: Rotation<CameraFrame, Icrs>,
    /// Position of the chaser relative to the centre of the Earth, km, ICRS axes.
    pub position_km: Vector3<f64>,
    /// Velocity of the chaser relative to the centre of the Earth, km/s, ICRS axes.
    pub velocity_km_s: Vector3<f64>,
    /// Geometric line of sight to the origin of the target's body frame.
    pub line_of_sight: Direction<Icrs>,
    /// Distance to the target, km.
    pub range_km: f64,
    /// Direction from the chaser to the Sun.
    pub sun: Direction<Icrs>,
    /// Angle at the target between the Sun and the chaser, degrees.
    pub phase_deg: f64,
    /// Shadow of the Earth on the target.
    pub shadow: Shadow,
    /// Fraction of the Sun's disk visible from the target, in [0, 1].
    pub sunlit_fraction: f64,
    /// Photoelectrons per second and pixel from zodiacal light, faint stars and stray light, mean over the
    /// detector; excludes the constant background of the sensor.
    pub background_e_per_s: f64,
    /// Electrons of smear per pixel, mean over the detector, for a uniform pixel response: the signal that a
    /// frame-transfer CCD collects while its image moves. The electrons of objects exclude smear. 0 without
    /// `sensor::SensorConfig::frame_transfer_s`.
    pub smear_e_per_px: f64,
    /// True attitude of the target's body; `None` for a target without a body.
    pub target_from_icrs: Option<Rotation<Target, Icrs>>,
    /// Pixel position of the line of sight; `None` behind the camera. The position may lie off the detector.
    /// The centre of brightness of a body is displaced towards its sunlit side: see [`ObjectTruth::position`]
    /// of the target.
    pub target_position: Option<PixelPoint>,
    /// Visibility class of the target.
    pub target_visibility: Visibility,
}

/// Kind of an object in the image.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum ObjectKind {
    /// The target spacecraft.
    Target,
    /// A star of the catalogue; `id` is its number in the catalogue.
    Star,
    /// A planet; `id` is its number from the Sun outwards, 1 to 8.
    Planet,
    /// The Moon; `id` is 0.
    Moon,
    /// A hot pixel; `id` is row × columns + column.
    HotPixel,
    /// A cosmic-ray hit; `id` counts the hits of the frame from 0.
    CosmicRay,
}

impl ObjectKind {
    /// Returns the word used in files.
    pub fn code(self) -> &'static str {
        match self {
            Self::Target => "target",
            Self::Star => "star",
            Self::Planet => "planet",
            Self::Moon => "moon",
            Self::HotPixel => "hot_pixel",
            Self::CosmicRay => "cosmic_ray",
        }
    }

    /// Parses an [`ObjectKind::code`]; `None` for any other text.
    pub fn parse(code: &str) -> Option<Self> {
        [Self::Target, Self::Star, Self::Planet, Self::Moon, Self::HotPixel, Self::CosmicRay]
            .into_iter()
            .find(|kind| kind.code() == code)
    }
}

/// Ground truth about one object in one frame.
#[derive(Debug, Clone, PartialEq)]
pub struct ObjectTruth {
    /// Number of the frame.
    pub frame: u64,
    /// Kind of the object.
    pub kind: ObjectKind,
    /// Number within the kind; 0 for the target and the Moon.
    pub id: u32,
    /// Centre of the object's image: energy centroid of the image on a uniform, unlimited detector; for a
    /// cosmic-ray hit, the middle of its track on the detector. In an interlaced frame, the middle between
    /// the centres in the two fields.
    pub position: PixelPoint,
    /// Direction with proper motion and parallax applied, without aberration; `None` for objects that
    /// originate in the detector.
    pub astrometric: Option<Direction<Icrs>>,
    /// Visual magnitude; `None` for objects that originate in the detector.
    pub magnitude: Option<f64>,
    /// Expected electrons of the object that the detector collects in this exposure, before saturation. The
    /// response of each pixel is applied, and dead pixels contribute nothing. Signal that a frame transfer
    /// smears over the columns is excluded.
    pub electrons: f64,
    /// Expected electrons in the object's brightest pixel, before saturation.
    pub peak_electrons: f64,
    /// Matched-filter signal-to-noise ratio over the object's pixels: sqrt(Σ s²/(s + b + σ²)), where σ² is
    /// the variance of the readout: noise of pixel, row and column, and gain²/12 for the converter's
    /// rounding. s is limited to the range between the background and saturation of the pixel, and is
    /// therefore 0 where the background by itself saturates the pixel.
    pub snr: f64,
    /// Radius within which the object's image exceeds the noise of one pixel (σ of the background), px; at
    /// least 0.5. For an object that overflows, the image before blooming counts.
    pub radius_px: f64,
    /// Distance beyond `radius_px` to which the object's image, after blooming, exceeds that noise along the
    /// columns, up or down, whichever is larger, px; 0 when nothing blooms.
    pub bloom_px: f64,
    /// Fraction of the object's electrons outside the transmitted regions, in [0, 1]; 0 when all are
    /// transmitted. For an object that overflows, the electrons count at their positions after blooming.
    pub cut: f64,
}
