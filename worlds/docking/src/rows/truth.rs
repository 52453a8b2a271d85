//! `truth/fields.parquet`: ground truth of each field. Angles are in degrees, as in all files.

use contract::PixelPoint;
use contract::docking::Lines;
use files::{table, value, words};
use hifitime::Epoch;
use nalgebra::Vector3;
use sim::docking::{FieldTruth, GlintImage};
use sim::television::VideoTruth;

use super::pose::{self, POSE, PoseCells};

/// Returns the truth as it would be read back from the file: angles are converted twice, which may change
/// their last bit. The score of a run is computed from this truth, which makes it bit-identical to a score of
/// the files.
pub fn truth_as_filed(truth: FieldTruth) -> FieldTruth {
    FieldTruth { pose: pose::as_filed(&truth.pose), ..FieldTruthRow::from(&truth).into() }
}

/// Camera rows of a field, as a word.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LinesWord(pub Lines);

impl LinesWord {
    fn code(self) -> &'static str {
        self.0.code()
    }

    fn parse(word: &str) -> Option<Self> {
        Lines::parse(word).map(Self)
    }
}

words!(LinesWord);

/// A glint in cells.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GlintCells(pub GlintImage);

value!(
    GlintCells: [f64; 4],
    |glint| [glint.0.index as f64, glint.0.centre.x, glint.0.centre.y, glint.0.light],
    |[index, x, y, light]| {
        Ok(Self(GlintImage { index: index as usize, centre: PixelPoint::new(x, y), light }))
    }
);

table! {
    /// A row of `truth/fields.parquet`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct FieldTruthRow: parquet(field) {
        /// number of the field; ascending
        field: u64,
        /// time of the field
        time_utc: Epoch,
        /// time of the field, s since the beginning
        time_s: f64,
        /// camera rows of the field: `even` (0, 2, 4 …), `odd`, `all`
        lines: LinesWord,
        /// index of the camera that took the field, from 0
        camera: usize,
        /// true pose: d and φ
        pose: PoseCells = POSE,
        /// time derivative of d
        velocity_m_s: Vector3<f64> = ["d1_rate_m_s", "d2_rate_m_s", "d3_rate_m_s"],
        /// time derivative of φ
        phi_rate_deg_s: Vector3<f64> = ["phi1_rate_deg_s", "phi2_rate_deg_s", "phi3_rate_deg_s"],
        /// ρ: distance between the camera and the centre of the target's disk
        rho_m: f64,
        /// u: time derivative of ρ, negative when closing
        u_m_s: f64,
        /// α: passive pitch
        alpha_deg: f64,
        /// β: passive yaw
        beta_deg: f64,
        /// unit vector towards the Sun, target frame; null on the night side
        sun: Option<Vector3<f64>> = ["sun_y1", "sun_y2", "sun_y3"],
        /// true if the lamp is on
        floodlight: bool,
        /// image of the centre of the cross's front face; null if it has no image
        cross_centre: Option<PixelPoint> = ["cross_x_px", "cross_y_px"],
        /// image of the disk's centre; null if it has no image
        disk_centre: Option<PixelPoint> = ["disk_x_px", "disk_y_px"],
        /// radius that the circle of the marks has in an image without tilt and distortion
        circle_radius_px: Option<f64>,
        /// bit i: all of mark i is in the image
        marks_in_field: u64,
        /// bit i: part of mark i is shadowed from a source that illuminates the front of the target
        marks_shadowed: u64,
        /// bit i: no source illuminates any part of mark i
        marks_dark: u64,
        /// bit i: part of mark i is hidden by an object in front of it
        marks_hidden: u64,
        /// bit i: glint i of the scenario is visible in the image
        glints_shining: u64,
        /// fraction of the plate that the Sun or the lamp illuminates
        plate_lit: f64,
        /// true if the whole cross is in the image
        cross_in_field: bool,
        /// true if the whole target is in the image
        target_in_field: bool,
        /// image of the Sun's centre; null unless part of its disk is in the image and not hidden
        sun_image: Option<PixelPoint> = ["sun_x_px", "sun_y_px"],
        /// unhidden fraction of the Sun's disk; 0 if the Sun is not in the image
        sun_visible: f64,
        /// brightest glint in the image: its number in the scenario, its position, and its radiance
        /// integrated over the image (radiance × px²); null if there is none
        glint: Option<GlintCells> = ["glint", "glint_x_px", "glint_y_px", "glint_light"],
        /// signal above the pedestal for a radiance of the white level
        video_contrast: f64,
        /// signal of a black scene
        video_brightness: f64,
        /// number of lines lost in transmission
        lost_lines: u32,
    }
}

impl From<&FieldTruth> for FieldTruthRow {
    fn from(truth: &FieldTruth) -> Self {
        Self {
            field: truth.field,
            time_utc: truth.time,
            time_s: truth.time_s,
            lines: LinesWord(truth.lines),
            camera: truth.camera,
            pose: PoseCells(truth.pose),
            velocity_m_s: truth.velocity_m_s,
            phi_rate_deg_s: truth.phi_rate_rad_s.map(f64::to_degrees),
            rho_m: truth.range_m,
            u_m_s: truth.range_rate_m_s,
            alpha_deg: truth.passive_pitch_rad.to_degrees(),
            beta_deg: truth.passive_yaw_rad.to_degrees(),
            sun: truth.sun,
            floodlight: truth.floodlight,
            cross_centre: truth.cross_centre,
            disk_centre: truth.disk_centre,
            circle_radius_px: truth.circle_radius_px,
            marks_in_field: truth.marks_in_field,
            marks_shadowed: truth.marks_shadowed,
            marks_dark: truth.marks_dark,
            marks_hidden: truth.marks_hidden,
            glints_shining: truth.glints_shining,
            plate_lit: truth.plate_lit,
            cross_in_field: truth.cross_in_field,
            target_in_field: truth.target_in_field,
            sun_image: truth.sun_image,
            sun_visible: truth.sun_visible,
            glint: truth.glint.map(GlintCells),
            video_contrast: truth.video.contrast,
            video_brightness: truth.video.brightness,
            lost_lines: truth.video.lost_lines,
        }
    }
}

impl From<FieldTruthRow> for FieldTruth {
    fn from(row: FieldTruthRow) -> Self {
        Self {
            field: row.field,
            time: row.time_utc,
            time_s: row.time_s,
            lines: row.lines.0,
            camera: row.camera,
            pose: row.pose.0,
            velocity_m_s: row.velocity_m_s,
            phi_rate_rad_s: row.phi_rate_deg_s.map(f64::to_radians),
            range_m: row.rho_m,
            range_rate_m_s: row.u_m_s,
            passive_pitch_rad: row.alpha_deg.to_radians(),
            passive_yaw_rad: row.beta_deg.to_radians(),
            sun: row.sun,
            floodlight: row.floodlight,
            cross_centre: row.cross_centre,
            disk_centre: row.disk_centre,
            circle_radius_px: row.circle_radius_px,
            marks_in_field: row.marks_in_field,
            marks_shadowed: row.marks_shadowed,
            marks_dark: row.marks_dark,
            marks_hidden: row.marks_hidden,
            glints_shining: row.glints_shining,
            plate_lit: row.plate_lit,
            cross_in_field: row.cross_in_field,
            target_in_field: row.target_in_field,
            sun_image: row.sun_image,
            sun_visible: row.sun_visible,
            glint: row.glint.map(|cells| cells.0),
            video: VideoTruth {
                contrast: row.video_contrast,
                brightness: row.video_brightness,
                lost_lines: row.lost_lines,
            },
        }
    }
}
