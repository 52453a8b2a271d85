//! `truth/frames.parquet` and `truth/objects.parquet`.
//!
//! Everything is a 64-bit float: a score from the files must be the score from memory to the bit, and each of
//! position, electrons, SNR, radius and cut decides in it. Directions of frames stand as components, which come back
//! to the bit; those of objects, which no score uses, as right ascension and declination, good to 1e-13 degrees.

use contract::{Angle, Direction, Icrs, PixelPoint, Rotation};
use hifitime::{Duration, Epoch};
use nalgebra::Vector3;
use sim::truth::{FrameTruth, ObjectKind, ObjectTruth, Shadow, Visibility};

use super::parquet_table::{Columns, Row};
use super::table_column::{Cells, Column, Nanoseconds};
use super::{FileError, unit};

const BODY: [&str; 4] = ["q_sc_j2000_w", "q_sc_j2000_x", "q_sc_j2000_y", "q_sc_j2000_z"];
const CAMERA: [&str; 4] = ["q_cam_j2000_w", "q_cam_j2000_x", "q_cam_j2000_y", "q_cam_j2000_z"];
const TARGET: [&str; 4] = ["q_target_j2000_w", "q_target_j2000_x", "q_target_j2000_y", "q_target_j2000_z"];
const POSITION: [&str; 3] = ["position_x_km", "position_y_km", "position_z_km"];
const VELOCITY: [&str; 3] = ["velocity_x_km_s", "velocity_y_km_s", "velocity_z_km_s"];
const LINE_OF_SIGHT: [&str; 3] = ["los_j2000_x", "los_j2000_y", "los_j2000_z"];
const SUN: [&str; 3] = ["sun_j2000_x", "sun_j2000_y", "sun_j2000_z"];

pub(super) fn numbers<R>(rows: &[R], name: &'static str, value: impl Fn(&R) -> f64) -> Column {
    Column::new(name, rows.iter().map(value))
}

pub(super) fn optional_numbers<R>(
    rows: &[R],
    name: &'static str,
    value: impl Fn(&R) -> Option<f64>,
) -> Column {
    Column::nullable(name, rows.iter().map(value))
}

pub(super) fn words<R>(rows: &[R], name: &'static str, value: impl Fn(&R) -> &str) -> Column {
    Column::texts(name, rows.iter().map(value))
}

/// UTC times; leap seconds are not counted.
pub(super) fn times<R>(rows: &[R], name: &'static str, time: impl Fn(&R) -> Epoch) -> Column {
    let nanoseconds = |row| Nanoseconds(time(row).to_unix_duration().total_nanoseconds() as i64);
    Column::new(name, rows.iter().map(nanoseconds))
}

/// The time that [`times`] wrote.
pub(super) fn epoch(Nanoseconds(since_1970): Nanoseconds) -> Epoch {
    Epoch::from_unix_duration(Duration::from_total_nanoseconds(i128::from(since_1970)))
}

/// Numbers that stand together, one column each, all of them there or none.
pub(super) fn optional_components<R, const N: usize>(
    rows: &[R],
    names: [&'static str; N],
    values: impl Fn(&R) -> Option<[f64; N]>,
) -> impl Iterator<Item = Column> {
    let column = |(i, name)| optional_numbers(rows, name, |row| values(row)?.get(i).copied());
    names.into_iter().enumerate().map(column).collect::<Vec<_>>().into_iter()
}

/// Numbers that stand together, one column each.
#[expect(clippy::indexing_slicing, reason = "both are of N, and `i` is below it")]
pub(super) fn components<R, const N: usize>(
    rows: &[R],
    names: [&'static str; N],
    values: impl Fn(&R) -> [f64; N],
) -> impl Iterator<Item = Column> {
    let column = |i: usize| numbers(rows, names[i], |row| values(row)[i]);
    (0..N).map(column).collect::<Vec<_>>().into_iter()
}

pub(super) fn columns_f64<'a, const N: usize>(
    columns: &'a Columns<'_>,
    names: [&str; N],
) -> Result<[&'a [f64]; N], FileError> {
    let mut slices: [&[f64]; N] = [&[]; N];
    for (slice, name) in slices.iter_mut().zip(names) {
        *slice = columns.f64(name)?;
    }
    Ok(slices)
}

/// Columns that stand together, all of them there or none.
#[expect(clippy::indexing_slicing, reason = "there are as many columns as names, N")]
pub(super) fn optional_columns_f64<'a, const N: usize>(
    columns: &'a Columns<'_>,
    names: [&str; N],
) -> Result<[&'a Cells<f64>; N], FileError> {
    let mut cells = Vec::with_capacity(N);
    for name in names {
        cells.push(columns.optional_f64(name)?);
    }
    Ok(std::array::from_fn(|i| cells[i]))
}

/// The values of [`optional_columns_f64`] in a row.
pub(super) fn optional_at<const N: usize>(columns: &[&Cells<f64>; N], row: usize) -> Option<[f64; N]> {
    let mut values = [0.0; N];
    for (value, cells) in values.iter_mut().zip(columns) {
        *value = cells.get(row)?;
    }
    Some(values)
}

#[expect(
    clippy::indexing_slicing,
    reason = "`row` is below the number of rows of the batch, which all its columns have"
)]
fn at<const N: usize>(slices: &[&[f64]; N], row: usize) -> [f64; N] {
    slices.map(|slice| slice[row])
}

impl Row for FrameTruth {
    fn columns(rows: &[Self]) -> Vec<Column> {
        let mut columns = vec![
            Column::new("frame", rows.iter().map(|row| row.frame)),
            words(rows, "group", |row| &row.group),
            times(rows, "time_utc", |row| row.time),
            numbers(rows, "exposure_s", |row| row.exposure_s),
        ];
        columns.extend(components(rows, BODY, |row| row.body_from_icrs.wxyz()));
        columns.extend(components(rows, CAMERA, |row| row.camera_from_icrs.wxyz()));
        columns.extend(components(rows, POSITION, |row| row.position_km.into()));
        columns.extend(components(rows, VELOCITY, |row| row.velocity_km_s.into()));
        columns.extend(components(rows, LINE_OF_SIGHT, |row| (*row.line_of_sight.vector()).into()));
        columns.push(numbers(rows, "range_km", |row| row.range_km));
        columns.extend(components(rows, SUN, |row| (*row.sun.vector()).into()));
        columns.extend([
            numbers(rows, "phase_deg", |row| row.phase_deg),
            words(rows, "shadow", |row| row.shadow.code()),
            numbers(rows, "sunlit_fraction", |row| row.sunlit_fraction),
            numbers(rows, "background_e_per_s", |row| row.background_e_per_s),
            numbers(rows, "smear_e_per_px", |row| row.smear_e_per_px),
            optional_numbers(rows, "target_x_px", |row| row.target_position.map(|p| p.x)),
            optional_numbers(rows, "target_y_px", |row| row.target_position.map(|p| p.y)),
            words(rows, "target_visibility", |row| row.target_visibility.code()),
        ]);
        columns.extend(optional_components(rows, TARGET, |row| row.target_from_icrs.map(|turn| turn.wxyz())));
        columns
    }

    #[expect(
        clippy::indexing_slicing,
        reason = "`row` is below the number of rows of the batch, which all its columns have"
    )]
    fn rows(columns: &Columns<'_>) -> Result<Vec<Self>, FileError> {
        let (frame, group) = (columns.u64("frame")?, columns.text("group")?);
        let time = columns.times("time_utc")?;
        let [exposure_s, range_km, phase_deg, sunlit_fraction, background_e_per_s, smear_e_per_px] =
            columns_f64(
                columns,
                [
                    "exposure_s",
                    "range_km",
                    "phase_deg",
                    "sunlit_fraction",
                    "background_e_per_s",
                    "smear_e_per_px",
                ],
            )?;
        let (body, camera) = (columns_f64(columns, BODY)?, columns_f64(columns, CAMERA)?);
        let (position, velocity) = (columns_f64(columns, POSITION)?, columns_f64(columns, VELOCITY)?);
        let (line_of_sight, sun) = (columns_f64(columns, LINE_OF_SIGHT)?, columns_f64(columns, SUN)?);
        let target_x = columns.optional_f64("target_x_px")?;
        let target_y = columns.optional_f64("target_y_px")?;
        let target = optional_columns_f64(columns, TARGET)?;
        let direction = |slices: &[&[f64]; 3], name: &str, row| {
            let xyz = at(slices, row);
            unit::direction(xyz).ok_or_else(|| columns.error(row, name, format!("{xyz:?}"), unit::EXPECTED))
        };
        (0..columns.len())
            .map(|row| {
                let target_wxyz = optional_at(&target, row);
                let x_and_y = target_x.get(row).zip(target_y.get(row));
                Ok(Self {
                    frame: frame[row],
                    group: group.value(row).to_owned(),
                    time: epoch(time[row]),
                    exposure_s: exposure_s[row],
                    body_from_icrs: rotation(columns, &body, BODY[0], row)?,
                    camera_from_icrs: rotation(columns, &camera, CAMERA[0], row)?,
                    position_km: Vector3::from(at(&position, row)),
                    velocity_km_s: Vector3::from(at(&velocity, row)),
                    line_of_sight: direction(&line_of_sight, LINE_OF_SIGHT[0], row)?,
                    range_km: range_km[row],
                    sun: direction(&sun, SUN[0], row)?,
                    phase_deg: phase_deg[row],
                    shadow: columns.word("shadow", row, Shadow::parse)?,
                    sunlit_fraction: sunlit_fraction[row],
                    background_e_per_s: background_e_per_s[row],
                    smear_e_per_px: smear_e_per_px[row],
                    target_from_icrs: target_wxyz
                        .map(|wxyz| unit_quaternion(columns, wxyz, TARGET[0], row))
                        .transpose()?,
                    target_position: x_and_y.map(|(x, y)| PixelPoint::new(x, y)),
                    target_visibility: columns.word("target_visibility", row, Visibility::parse)?,
                })
            })
            .collect()
    }

    fn frame(&self) -> u64 {
        self.frame
    }
}

fn rotation<To, From>(
    columns: &Columns<'_>,
    slices: &[&[f64]; 4],
    name: &str,
    row: usize,
) -> Result<Rotation<To, From>, FileError> {
    unit_quaternion(columns, at(slices, row), name, row)
}

fn unit_quaternion<To, From>(
    columns: &Columns<'_>,
    wxyz: [f64; 4],
    name: &str,
    row: usize,
) -> Result<Rotation<To, From>, FileError> {
    Rotation::from_wxyz(wxyz)
        .map_err(|error| columns.error(row, name, format!("{wxyz:?}"), format!("a unit quaternion: {error}")))
}

impl Row for ObjectTruth {
    fn columns(rows: &[Self]) -> Vec<Column> {
        vec![
            Column::new("frame", rows.iter().map(|row| row.frame)),
            words(rows, "kind", |row| row.kind.code()),
            Column::new("id", rows.iter().map(|row| row.id)),
            numbers(rows, "x_px", |row| row.position.x).seldom_repeating(),
            numbers(rows, "y_px", |row| row.position.y).seldom_repeating(),
            optional_numbers(rows, "ra_deg", |row| row.astrometric.map(|d| d.ra().degrees()))
                .seldom_repeating(),
            optional_numbers(rows, "dec_deg", |row| row.astrometric.map(|d| d.dec().degrees()))
                .seldom_repeating(),
            optional_numbers(rows, "magnitude", |row| row.magnitude),
            numbers(rows, "electrons", |row| row.electrons).seldom_repeating(),
            numbers(rows, "peak_electrons", |row| row.peak_electrons).seldom_repeating(),
            numbers(rows, "snr", |row| row.snr).seldom_repeating(),
            numbers(rows, "radius_px", |row| row.radius_px),
            numbers(rows, "bloom_px", |row| row.bloom_px),
            numbers(rows, "cut", |row| row.cut),
        ]
    }

    #[expect(
        clippy::indexing_slicing,
        reason = "`row` is below the number of rows of the batch, which all its columns have"
    )]
    fn rows(columns: &Columns<'_>) -> Result<Vec<Self>, FileError> {
        let (frame, id) = (columns.u64("frame")?, columns.u32("id")?);
        let names = ["x_px", "y_px", "electrons", "peak_electrons", "snr", "radius_px", "bloom_px", "cut"];
        let [x, y, electrons, peak_electrons, snr, radius_px, bloom_px, cut] = columns_f64(columns, names)?;
        let ra_deg = columns.optional_f64("ra_deg")?;
        let dec_deg = columns.optional_f64("dec_deg")?;
        let magnitude = columns.optional_f64("magnitude")?;
        ra_deg
            .iter()
            .zip(dec_deg.iter())
            .zip(magnitude.iter())
            .enumerate()
            .map(|(row, ((ra, dec), magnitude))| {
                Ok(Self {
                    frame: frame[row],
                    kind: columns.word("kind", row, ObjectKind::parse)?,
                    id: id[row],
                    position: PixelPoint::new(x[row], y[row]),
                    astrometric: ra.zip(dec).map(|(ra, dec)| direction(ra, dec)),
                    magnitude,
                    electrons: electrons[row],
                    peak_electrons: peak_electrons[row],
                    snr: snr[row],
                    radius_px: radius_px[row],
                    bloom_px: bloom_px[row],
                    cut: cut[row],
                })
            })
            .collect()
    }

    fn frame(&self) -> u64 {
        self.frame
    }
}

fn direction(ra_deg: f64, dec_deg: f64) -> Direction<Icrs> {
    Direction::from_ra_dec(Angle::from_degrees(ra_deg), Angle::from_degrees(dec_deg))
}
