//! The truth table: one row a frame, one row an object in a frame.

use contract::{Body, CameraFrame, Direction, Icrs, PixelPoint, Rotation, Target};
use hifitime::Epoch;
use nalgebra::Vector3;

/// Whether the Earth's shadow is on the target.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shadow {
    /// The whole Sun is seen.
    Sunlit,
    /// A part of the Sun is seen.
    Penumbra,
    /// Nothing of the Sun is seen.
    Umbra,
}

impl Shadow {
    /// The word used in files.
    pub fn code(self) -> &'static str {
        match self {
            Self::Sunlit => "sunlit",
            Self::Penumbra => "penumbra",
            Self::Umbra => "umbra",
        }
    }

    /// Reads [`Shadow::code`].
    pub fn parse(code: &str) -> Option<Self> {
        [Self::Sunlit, Self::Penumbra, Self::Umbra].into_iter().find(|shadow| shadow.code() == code)
    }
}

/// Whether an object can be detected, decided by its signal-to-noise ratio and by nothing else.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Visibility {
    /// SNR of 5 or more: a matched filter finds it.
    Detectable,
    /// SNR from 2 to 5: neither finding nor missing it is a fault.
    Ambiguous,
    /// SNR below 2.
    Invisible,
}

impl Visibility {
    /// The class of a signal-to-noise ratio.
    pub fn from_snr(snr: f64) -> Self {
        match snr {
            s if s >= 5.0 => Self::Detectable,
            s if s >= 2.0 => Self::Ambiguous,
            _ => Self::Invisible,
        }
    }

    /// The word used in files.
    pub fn code(self) -> &'static str {
        match self {
            Self::Detectable => "detectable",
            Self::Ambiguous => "ambiguous",
            Self::Invisible => "invisible",
        }
    }

    /// Reads [`Visibility::code`].
    pub fn parse(code: &str) -> Option<Self> {
        [Self::Detectable, Self::Ambiguous, Self::Invisible].into_iter().find(|class| class.code() == code)
    }
}

/// The truth about a frame as a whole.
#[derive(Debug, Clone, PartialEq)]
pub struct FrameTruth {
    /// Number of the frame in the scenario.
    pub frame: u64,
    /// Name of the group (a day, a portion) it belongs to.
    pub group: String,
    /// Middle of the exposure; of an interlaced frame the middle between those of its two fields. All else in this table is
    /// as it was then.
    pub time: Epoch,
    /// Exposure time, s; of an interlaced frame that of each field.
    pub exposure_s: f64,
    /// True attitude of the chaser.
    pub body_from_icrs: Rotation<Body, Icrs>,
    /// True attitude of the camera.
    pub camera_from_icrs: Rotation<CameraFrame, Icrs>,
    /// Position of the chaser from the centre of the Earth, km, ICRS axes.
    pub position_km: Vector3<f64>,
    /// Velocity of the chaser about the Earth, km/s, ICRS axes.
    pub velocity_km_s: Vector3<f64>,
    /// Geometric line of sight to the target: to the origin of its body frame.
    pub line_of_sight: Direction<Icrs>,
    /// Distance to the target, km.
    pub range_km: f64,
    /// Direction to the Sun from the chaser.
    pub sun: Direction<Icrs>,
    /// Angle at the target between the Sun and the chaser, degrees.
    pub phase_deg: f64,
    /// Shadow of the Earth on the target.
    pub shadow: Shadow,
    /// Fraction of the Sun's disk seen from the target, in [0, 1].
    pub sunlit_fraction: f64,
    /// Photo-electrons a second and pixel of zodiacal light, faint stars and stray light, the mean over the detector; without
    /// the constant of the sensor.
    pub background_e_per_s: f64,
    /// Electrons of smear in a pixel, the mean over the detector, with an even response: light that a frame-transfer CCD
    /// collects while its image moves. Objects have none of it in their own electrons. 0 without
    /// [`crate::sensor::SensorConfig::frame_transfer_s`].
    pub smear_e_per_px: f64,
    /// True attitude of the target's body; `None` for a target without one.
    pub target_from_icrs: Option<Rotation<Target, Icrs>>,
    /// Where the line of sight meets the image; `None` behind the camera. It may lie off the detector. The centre of
    /// brightness of a body is elsewhere, towards its sunlit side: [`ObjectTruth::position`] of the target has it.
    pub target_position: Option<PixelPoint>,
    /// Visibility class of the target.
    pub target_visibility: Visibility,
}

/// What kind of thing an object in the image is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum ObjectKind {
    /// The target spacecraft.
    Target,
    /// A star of the catalogue; `id` is its number there.
    Star,
    /// A planet; `id` is its number from the Sun outwards, 1 to 8.
    Planet,
    /// The Moon; `id` is 0.
    Moon,
    /// A hot pixel; `id` is row × columns + column.
    HotPixel,
    /// The track of a charged particle; `id` counts those of the frame from 0.
    CosmicRay,
}

impl ObjectKind {
    /// The word used in files.
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

    /// Reads [`ObjectKind::code`].
    pub fn parse(code: &str) -> Option<Self> {
        [Self::Target, Self::Star, Self::Planet, Self::Moon, Self::HotPixel, Self::CosmicRay]
            .into_iter()
            .find(|kind| kind.code() == code)
    }
}

/// The truth about one object in one frame.
#[derive(Debug, Clone, PartialEq)]
pub struct ObjectTruth {
    /// Number of the frame.
    pub frame: u64,
    /// What it is.
    pub kind: ObjectKind,
    /// Number within its kind; 0 for the target and the Moon.
    pub id: u32,
    /// Where the centre of its image is (energy centroid of the image that an even, unlimited detector would have; the
    /// middle of a particle's track on the detector). In an interlaced frame the middle between those of its two fields.
    pub position: PixelPoint,
    /// Direction without aberration, proper motion and parallax applied; `None` for what the detector makes.
    pub astrometric: Option<Direction<Icrs>>,
    /// Visual magnitude; `None` for what the detector makes.
    pub magnitude: Option<f64>,
    /// Expected electrons of the object that the detector collects in this exposure, before saturation: each pixel's
    /// response counts, dead pixels count nothing. Light that a frame transfer smears over its columns is not in it.
    pub electrons: f64,
    /// Expected electrons in its brightest pixel, before saturation.
    pub peak_electrons: f64,
    /// Matched-filter signal-to-noise ratio over its own pixels: sqrt(Σ s²/(s + b + σ²)), where σ² is the variance of the
    /// readout: noise of pixel, row and column, and gain²/12 of the converter's rounding. Of s counts what the pixel has room
    /// for above the background before it saturates: 0 where the background alone fills it.
    pub snr: f64,
    /// Radius within which its image exceeds the noise of one pixel (σ of background), px; at least 0.5. Of an object that
    /// overflows, the image is that before blooming.
    pub radius_px: f64,
    /// How much farther than `radius_px` its image exceeds that noise along its columns after blooming, up or down, whichever
    /// is more, px; 0 when nothing blooms.
    pub bloom_px: f64,
    /// Fraction of its electrons outside the transmitted regions, in [0, 1]; 0 when all is transmitted. Of an object that
    /// overflows, the electrons are counted where they are after blooming.
    pub cut: f64,
}
