//! `truth/fields.parquet`: the truth about each field. Angles are degrees, as everywhere in files.

use contract::PixelPoint;
use contract::docking::{Lines, Pose};
use nalgebra::Vector3;
use sim::docking::{FieldTruth, GlintImage};
use sim::television::VideoTruth;

use super::super::FileError;
use super::super::parquet_table::{Columns, Row};
use super::super::table_column::{Cells, Column};
use super::super::truth::{
    columns_f64, components, epoch, numbers, optional_at, optional_columns_f64, optional_components,
    optional_numbers, times, words,
};

const POSITION: [&str; 3] = ["d1_m", "d2_m", "d3_m"];
const PHI: [&str; 3] = ["phi1_deg", "phi2_deg", "phi3_deg"];
const VELOCITY: [&str; 3] = ["d1_rate_m_s", "d2_rate_m_s", "d3_rate_m_s"];
const PHI_RATE: [&str; 3] = ["phi1_rate_deg_s", "phi2_rate_deg_s", "phi3_rate_deg_s"];
const SUN: [&str; 3] = ["sun_y1", "sun_y2", "sun_y3"];
const CROSS: [&str; 2] = ["cross_x_px", "cross_y_px"];
const DISK: [&str; 2] = ["disk_x_px", "disk_y_px"];
const GLINT: [&str; 4] = ["glint", "glint_x_px", "glint_y_px", "glint_light"];
const SUN_IMAGE: [&str; 2] = ["sun_x_px", "sun_y_px"];

/// The truth as it comes back from the file: angles have changed their unit twice, which may move their last bit. A score
/// of the run is made of these, so that one of the files is the same to the bit.
pub fn truth_as_filed(mut truth: FieldTruth) -> FieldTruth {
    let as_filed = |angle: f64| angle.to_degrees().to_radians();
    truth.pose.phi_rad.apply(|angle| *angle = as_filed(*angle));
    truth.phi_rate_rad_s.apply(|rate| *rate = as_filed(*rate));
    truth.passive_pitch_rad = as_filed(truth.passive_pitch_rad);
    truth.passive_yaw_rad = as_filed(truth.passive_yaw_rad);
    truth
}

fn flags<R>(rows: &[R], name: &'static str, value: impl Fn(&R) -> bool) -> Column {
    Column::new(name, rows.iter().map(value))
}

fn point(point: Option<PixelPoint>) -> Option<[f64; 2]> {
    point.map(|point| [point.x, point.y])
}

impl Row for FieldTruth {
    const FRAME: &'static str = "field";

    fn columns(rows: &[Self]) -> Vec<Column> {
        let bits = |name, value: fn(&Self) -> u64| Column::new(name, rows.iter().map(value));
        let mut columns = vec![
            bits("field", |row| row.field),
            times(rows, "time_utc", |row| row.time),
            numbers(rows, "time_s", |row| row.time_s),
            words(rows, "lines", |row| row.lines.code()),
            Column::new("camera", rows.iter().map(|row| row.camera as u32)),
        ];
        columns.extend(components(rows, POSITION, |row| row.pose.position_m.into()));
        columns.extend(components(rows, PHI, |row| row.pose.phi_rad.map(f64::to_degrees).into()));
        columns.extend(components(rows, VELOCITY, |row| row.velocity_m_s.into()));
        columns.extend(components(rows, PHI_RATE, |row| row.phi_rate_rad_s.map(f64::to_degrees).into()));
        columns.extend([
            numbers(rows, "rho_m", |row| row.range_m),
            numbers(rows, "u_m_s", |row| row.range_rate_m_s),
            numbers(rows, "alpha_deg", |row| row.passive_pitch_rad.to_degrees()),
            numbers(rows, "beta_deg", |row| row.passive_yaw_rad.to_degrees()),
        ]);
        columns.extend(optional_components(rows, SUN, |row| row.sun.map(Into::into)));
        columns.push(flags(rows, "floodlight", |row| row.floodlight));
        columns.extend(optional_components(rows, CROSS, |row| point(row.cross_centre)));
        columns.extend(optional_components(rows, DISK, |row| point(row.disk_centre)));
        columns.extend([
            optional_numbers(rows, "circle_radius_px", |row| row.circle_radius_px),
            bits("marks_in_field", |row| row.marks_in_field),
            bits("marks_shadowed", |row| row.marks_shadowed),
            bits("marks_dark", |row| row.marks_dark),
            bits("marks_hidden", |row| row.marks_hidden),
            bits("glints_shining", |row| row.glints_shining),
            numbers(rows, "plate_lit", |row| row.plate_lit),
            flags(rows, "cross_in_field", |row| row.cross_in_field),
            flags(rows, "target_in_field", |row| row.target_in_field),
        ]);
        columns.extend(optional_components(rows, SUN_IMAGE, |row| point(row.sun_image)));
        columns.extend([numbers(rows, "sun_visible", |row| row.sun_visible)]);
        columns.extend(optional_components(rows, GLINT, |row| {
            row.glint.map(|glint| [glint.index as f64, glint.centre.x, glint.centre.y, glint.light])
        }));
        columns.extend([
            numbers(rows, "video_contrast", |row| row.video.contrast),
            numbers(rows, "video_brightness", |row| row.video.brightness),
            Column::new("lost_lines", rows.iter().map(|row| row.video.lost_lines)),
        ]);
        columns
    }

    #[expect(
        clippy::indexing_slicing,
        reason = "`row` is below the number of rows of the batch, which all its columns have"
    )]
    fn rows(columns: &Columns<'_>) -> Result<Vec<Self>, FileError> {
        let (field, camera) = (columns.u64("field")?, columns.u32("camera")?);
        let time = columns.times("time_utc")?;
        let [time_s, rho, u, alpha, beta, plate_lit, sun_visible, contrast, brightness] = columns_f64(
            columns,
            [
                "time_s",
                "rho_m",
                "u_m_s",
                "alpha_deg",
                "beta_deg",
                "plate_lit",
                "sun_visible",
                "video_contrast",
                "video_brightness",
            ],
        )?;
        let (d, phi) = (columns_f64(columns, POSITION)?, columns_f64(columns, PHI)?);
        let (velocity, phi_rate) = (columns_f64(columns, VELOCITY)?, columns_f64(columns, PHI_RATE)?);
        let sun = optional_columns_f64(columns, SUN)?;
        let [cross, disk, sun_image] = [
            optional_columns_f64(columns, CROSS)?,
            optional_columns_f64(columns, DISK)?,
            optional_columns_f64(columns, SUN_IMAGE)?,
        ];
        let glint = optional_columns_f64(columns, GLINT)?;
        let circle = columns.optional_f64("circle_radius_px")?;
        let (in_field, shadowed) = (columns.u64("marks_in_field")?, columns.u64("marks_shadowed")?);
        let (marks_dark, marks_hidden) = (columns.u64("marks_dark")?, columns.u64("marks_hidden")?);
        let glints_shining = columns.u64("glints_shining")?;
        let floodlight = columns.flags("floodlight")?;
        let cross_in_field = columns.flags("cross_in_field")?;
        let target_in_field = columns.flags("target_in_field")?;
        let lost_lines = columns.u32("lost_lines")?;
        let vector = |slices: &[&[f64]; 3], row: usize| Vector3::from(slices.map(|slice| slice[row]));
        let point =
            |cells: &[&Cells<f64>; 2], row| optional_at(cells, row).map(|[x, y]| PixelPoint::new(x, y));
        (0..columns.len())
            .map(|row| {
                let phi_rad = vector(&phi, row).map(f64::to_radians);
                Ok(Self {
                    field: field[row],
                    time_s: time_s[row],
                    time: epoch(time[row]),
                    lines: columns.word("lines", row, Lines::parse)?,
                    camera: camera[row] as usize,
                    pose: Pose { position_m: vector(&d, row), phi_rad },
                    velocity_m_s: vector(&velocity, row),
                    phi_rate_rad_s: vector(&phi_rate, row).map(f64::to_radians),
                    range_m: rho[row],
                    range_rate_m_s: u[row],
                    passive_pitch_rad: alpha[row].to_radians(),
                    passive_yaw_rad: beta[row].to_radians(),
                    sun: optional_at(&sun, row).map(Vector3::from),
                    floodlight: floodlight[row],
                    cross_centre: point(&cross, row),
                    disk_centre: point(&disk, row),
                    circle_radius_px: circle.get(row),
                    marks_in_field: in_field[row],
                    marks_shadowed: shadowed[row],
                    marks_dark: marks_dark[row],
                    marks_hidden: marks_hidden[row],
                    glints_shining: glints_shining[row],
                    plate_lit: plate_lit[row],
                    cross_in_field: cross_in_field[row],
                    target_in_field: target_in_field[row],
                    sun_image: point(&sun_image, row),
                    sun_visible: sun_visible[row],
                    glint: optional_at(&glint, row).map(|[index, x, y, light]| GlintImage {
                        index: index as usize,
                        centre: PixelPoint::new(x, y),
                        light,
                    }),
                    video: VideoTruth {
                        contrast: contrast[row],
                        brightness: brightness[row],
                        lost_lines: lost_lines[row],
                    },
                })
            })
            .collect()
    }

    fn frame(&self) -> u64 {
        self.field
    }
}
