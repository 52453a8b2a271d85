//! Fields of an approach as panels: recognised features, and the measured and the true pose.

use std::collections::{BTreeMap, BTreeSet};

use contract::docking::{
    Digitiser, DockingOutcome, DockingSetup, DockingSolution, Field, Lines, Pose, PoseEstimate,
};
use contract::{PixelPoint, Window};
use docking::rows::{
    FeatureRow, FieldRow, FieldTruthRow, SetupFile, read_field_measurements, read_field_telemetry,
};
use docking::scoring::{DockingContext, DockingScorer, TrueField, lens_names};
use docking::video::{FieldOrder, FieldSource, Scan, SequenceOptions, read_listed_field};
use docking::{DockingRenderer, DockingScenario};
use files::{Failure, format_utc};
use run::ScenarioSource;
use scenario::run_file::RunFile;
use score::UnitVerdict;
use show::{Mark, Panel, Pixels, PlateScale, Reduction, Shape, Stretch, Table, Tone, Verdict as Words};
use sim::docking::FieldTruth;
use view::{AnnotatedFrame, Bounds, PixelSource, Source, display_name, not_stored, rows_of, time_words};

use crate::classes::{CIRCLE, CROSS, DOCKING_UNIT, REJECTED_MARK, STATION, TRUE_CENTRE, USED_MARK};

/// Videos of a directory whose telemetry lists no images.
const VIDEOS: [&str; 2] = ["fields.avi", "fields.y4m"];

/// Available data about a field.
struct FieldRecord<'a> {
    name: String,
    row: &'a FieldRow,
    setup: &'a DockingSetup,
    lens: Option<String>,
    truth: Option<FieldTruth>,
    features: Vec<FeatureRow>,
    /// Outcome of the field, `None` without a row; the outer `None` without a table of measurements.
    answer: Option<Option<DockingOutcome>>,
    verdict: Option<UnitVerdict>,
}

/// Returns the panels of some fields, in the given order. Each field is interleaved with the preceding field,
/// if that field holds the other rows.
///
/// # Errors
/// A [`Failure`] that names the field or the file that is missing or cannot be read.
pub(crate) fn panels(source: &Source, numbers: &[u64]) -> Result<Vec<AnnotatedFrame>, Failure> {
    let telemetry = read_field_telemetry(&source.directory.join("telemetry.csv"))?;
    let rows = source.select("field", &telemetry, numbers, |row: &FieldRow| row.field)?;
    let setup = SetupFile::read(&source.directory.join("setup.toml"))?.setup();
    let run_path = source.directory.join("run.toml");
    let run_file = source.has_run.then(|| RunFile::<DockingScenario>::read(&run_path)).transpose()?;
    let name = run_file.as_ref().map_or_else(|| source.name.clone(), |run_file| run_file.name.clone());
    let lenses = lens_names(&setup.cameras);

    let mut truths = rows_of::<FieldTruthRow>(source.file("truth/fields.parquet").as_deref(), numbers)?;
    let features = rows_of::<FeatureRow>(source.beside_measurements("features.parquet").as_deref(), numbers)?;
    let mut answers: Option<BTreeMap<u64, DockingOutcome>> = match &source.measurements {
        Some(path) => {
            let wanted = |(field, _): &(u64, DockingOutcome)| numbers.contains(field);
            Some(read_field_measurements(path)?.into_iter().filter(wanted).collect())
        }
        None => None,
    };
    let partners: Vec<Option<&FieldRow>> = rows.iter().map(|row| partner(&telemetry, row)).collect();
    let needed: BTreeMap<u64, &FieldRow> =
        rows.iter().copied().chain(partners.iter().copied().flatten()).map(|row| (row.field, row)).collect();
    let (fields, pixels) = fields(source, &setup, &telemetry, &needed)?;
    source.check()?;

    let mut shown = Vec::with_capacity(rows.len());
    for (row, partner) in rows.into_iter().zip(partners) {
        let Some(field) = fields.get(&row.field) else {
            return Err(not_stored(source, "field", row.field));
        };
        let truth = truths.remove(&row.field).and_then(|rows| rows.into_iter().next()).map(FieldTruth::from);
        let answer = answers.as_mut().map(|answers| answers.remove(&row.field));
        let judged = (run_file.as_ref()).zip(truth.as_ref()).zip(answer.as_ref());
        let verdict = match judged {
            Some(((run_file, truth), answer)) => verdict(run_file, &setup, truth, answer.as_ref())?,
            None => None,
        };
        let known = FieldRecord {
            name: name.clone(),
            row,
            setup: &setup,
            lens: lenses.get(row.telemetry.camera).cloned(),
            truth,
            features: features.get(&row.field).cloned().unwrap_or_default(),
            answer,
            verdict,
        };
        let by_other = pixels == PixelSource::DrawnAgain
            && run_file.as_ref().is_some_and(|run_file| run_file.mitsuba.is_some());
        shown.push(known.annotated_frame(
            field,
            partner.and_then(|row| fields.get(&row.field)),
            pixels,
            by_other,
        ));
    }
    Ok(shown)
}

/// Returns the preceding row of the telemetry, if its field holds the other rows of the camera.
fn partner<'a>(telemetry: &'a [FieldRow], row: &FieldRow) -> Option<&'a FieldRow> {
    let place = telemetry.binary_search_by_key(&row.field, |row| row.field).ok()?;
    let before = telemetry.get(place.checked_sub(1)?)?;
    let is_other = matches!((before.lines, row.lines), (Lines::Even, Lines::Odd) | (Lines::Odd, Lines::Even));
    let follows = before.field + 1 == row.field && before.telemetry.camera == row.telemetry.camera;
    (is_other && follows).then_some(before)
}

/// Returns the required fields: stored fields or, if none are stored, fields drawn again.
fn fields(
    source: &Source,
    setup: &DockingSetup,
    telemetry: &[FieldRow],
    needed: &BTreeMap<u64, &FieldRow>,
) -> Result<(BTreeMap<u64, Field>, PixelSource), Failure> {
    let mut fields = BTreeMap::new();
    if needed.values().all(|row| row.file.is_some()) {
        for row in needed.values() {
            fields.extend(read_listed_field(&source.directory, row, setup)?.map(|field| (row.field, field)));
        }
        return Ok((fields, PixelSource::Stored));
    }
    let names_none = telemetry.iter().all(|row| row.file.is_none());
    if names_none && VIDEOS.iter().any(|name| source.file(name).is_some()) {
        let mut waiting: BTreeSet<u64> = needed.keys().copied().collect();
        // The options do not apply to a directory with telemetry.
        let options = SequenceOptions {
            scan: Scan::Interlaced(FieldOrder::Top),
            scan_is_stated: false,
            camera: 0,
            frame_rate_hz: None,
            raw: None,
            digitiser: Digitiser::default(),
        };
        for field in FieldSource::open(&source.directory, setup, &options)? {
            let (field, _) = field?;
            if waiting.remove(&field.number()) {
                fields.insert(field.number(), field);
            }
            if waiting.is_empty() {
                break;
            }
        }
        return Ok((fields, PixelSource::Stored));
    }
    if !source.has_run {
        let missing = needed.values().find(|row| row.file.is_none()).map_or(0, |row| row.field);
        return Err(not_stored(source, "field", missing));
    }
    let run = ScenarioSource::read(&source.directory.join("run.toml").to_string_lossy())?;
    let simulator = docking::simulator(&run, run.typed("boresight show")?)?;
    let mut workspace = simulator.workspace()?;
    for row in needed.values() {
        let exposure = DockingRenderer::Fast.expose(&simulator, setup, &mut workspace, row.field)?;
        fields.insert(row.field, exposure.video.digitise(&row.telemetry.digitiser));
    }
    Ok((fields, PixelSource::DrawnAgain))
}

/// Returns the verdict on one field.
fn verdict(
    run_file: &RunFile<DockingScenario>,
    setup: &DockingSetup,
    truth: &FieldTruth,
    answer: Option<&DockingOutcome>,
) -> Result<Option<UnitVerdict>, Failure> {
    let mut scorer = DockingScorer::new(DockingContext {
        scenario: run_file.name.clone(),
        seed: run_file.scenario.seed,
        version: run_file.version.clone(),
        renderer: run_file.mitsuba.as_ref().map_or("fast", |_| "mitsuba").to_owned(),
        warm_up_frames: 0,
        setup: setup.clone(),
    });
    let rows = setup.cameras.get(truth.camera).map_or(0, |camera| camera.rows);
    let field = TrueField::new(truth, setup.target.marks.len(), rows);
    scorer
        .add(&field, answer)
        .map_err(|error| Failure::Usage(format!("field {} cannot be scored: {error}", truth.field)))?;
    Ok(scorer.units().units.into_iter().next())
}

/// Returns the digital numbers of a whole frame: the rows of the field, interleaved with those of the
/// preceding field or, if there is none, with repeated rows of the field itself.
fn woven(field: &Field, before: Option<&Field>) -> Vec<u16> {
    let columns = field.image().columns().max(1);
    let mut dn = vec![0; columns * field.camera_rows()];
    let mut lay = |from: &[u16], row: usize| {
        if let Some(to) = dn.chunks_exact_mut(columns).nth(row) {
            to.iter_mut().zip(from).for_each(|(to, from)| *to = *from);
        }
    };
    for (k, from) in field.image().dn().chunks_exact(columns).enumerate() {
        let row = field.lines().camera_row(k);
        lay(from, row);
        match field.lines() {
            Lines::Even => lay(from, row + 1),
            Lines::Odd => {
                lay(from, row - 1);
                lay(from, row + 1);
            }
            Lines::All => {}
        }
    }
    if let Some(before) = before {
        for (k, from) in before.image().dn().chunks_exact(columns).enumerate() {
            lay(from, before.lines().camera_row(k));
        }
    }
    dn
}

impl FieldRecord<'_> {
    fn annotated_frame(
        &self,
        field: &Field,
        before: Option<&Field>,
        source: PixelSource,
        by_other: bool,
    ) -> AnnotatedFrame {
        let number = field.number();
        let (columns, rows) = (field.image().columns(), field.camera_rows());
        let full_scale_dn = field.image().full_scale_dn();
        let pixels = Pixels { columns, rows, dn: woven(field, before), full_scale_dn };
        let camera = self.setup.cameras.get(self.row.telemetry.camera);
        let true_range_m = self.truth.as_ref().map(|truth| truth.range_m);
        let range_m = true_range_m.or_else(|| self.estimate().map(|best| best.pose.position_m.norm()));
        let lens = self.lens.as_ref().map_or_else(String::new, |lens| format!(", lens {lens}"));
        let panel = Panel {
            view: pixels.full_window(),
            close_up: self.close_up(columns, rows),
            pixels,
            regions: None,
            stretch: Stretch::Full,
            reduction: Reduction::Mean,
            scale: PlateScale {
                focal_length_px: camera.map_or(1.0, |camera| camera.focal_length_px().0),
                range_m,
            },
            marks: self.marks(),
            title: format!("{}, field {number}", self.name),
            short_title: format!("field {number}{lens}"),
            verdict: self.verdict_words(),
            tables: self.tables(before, source, by_other),
            caption: self.caption(),
        };
        let utc = self.truth.as_ref().map(|truth| format_utc(truth.time));
        AnnotatedFrame {
            panel,
            frame: number,
            time: utc.unwrap_or_else(|| format!("{} s", self.row.telemetry.time_s)),
            pixels: source,
            verdict: self.verdict.as_ref().map(|unit| unit.verdict.clone()),
            cause: self.verdict.as_ref().and_then(|unit| unit.cause.clone()),
        }
    }

    fn estimate(&self) -> Option<&PoseEstimate> {
        let answer = self.answer.as_ref()?.as_ref()?;
        answer.any_measurement().map(|measurement| &measurement.best)
    }

    fn marks(&self) -> Vec<Mark> {
        let truth = self.truth.as_ref();
        let centre = |at: Option<PixelPoint>| {
            let shape = Shape::Saltire { arm: 9.0 };
            at.map(|at| Mark { at, shape, class: TRUE_CENTRE, label: None })
        };
        let circle = self.features.iter().find(|row| row.kind == "circle").and_then(|row| row.radius_px);
        // Marks of neighbouring features leave a gap between them, even if the target is small.
        let half = (0.11 * circle.filter(|radius| radius.is_finite()).unwrap_or(0.0)).clamp(3.5, 8.0);
        let features = self.features.iter().filter_map(|row| feature_mark(row, half));
        let truths = [truth.and_then(|truth| truth.disk_centre), truth.and_then(|truth| truth.cross_centre)];
        features.chain(truths.into_iter().filter_map(centre)).collect()
    }

    /// Returns the surroundings of the target, from recognised features or from the truth.
    fn close_up(&self, columns: usize, rows: usize) -> Option<Window> {
        let circle = self.features.iter().find(|row| row.kind == "circle");
        let recognised = circle.map(|row| (PixelPoint::new(row.position[0], row.position[1]), row.radius_px));
        let truth = self.truth.as_ref();
        let of_truth = || truth.and_then(|truth| Some((truth.disk_centre?, truth.circle_radius_px)));
        let (centre, radius_px) =
            recognised.or_else(of_truth).filter(|(at, _)| at.is_on_detector(columns, rows))?;
        let reach = 1.8 * radius_px.filter(|radius| radius.is_finite()).unwrap_or(0.0).max(10.0);
        let mut bounds = Bounds::from_point(centre);
        bounds.add(PixelPoint::new(centre.x - reach, centre.y - reach));
        bounds.add(PixelPoint::new(centre.x + reach, centre.y + reach));
        Some(bounds.window(columns, rows))
    }

    fn verdict_words(&self) -> Option<Words> {
        let unit = self.verdict.as_ref()?;
        let tone = match unit.verdict.as_str() {
            "success" => Tone::Good,
            "range_only" | "doubtful" => Tone::Partial,
            _ => Tone::Bad,
        };
        let cause =
            unit.cause.as_ref().map_or_else(String::new, |cause| format!(": {}", display_name(cause)));
        Some(Words { words: format!("{}{cause}", display_name(&unit.verdict)), tone })
    }

    /// Returns the reason why the outcome has no pose.
    fn reason(&self) -> Option<String> {
        match self.answer.as_ref()? {
            None => Some("no row".to_owned()),
            Some(answer) => match &answer.solution {
                DockingSolution::NoSolution(reason) => Some(display_name(&reason.to_string())),
                _ => None,
            },
        }
    }

    fn tables(&self, before: Option<&Field>, source: PixelSource, by_other: bool) -> Vec<Table> {
        let mut table = Table::default();
        if let Some(truth) = &self.truth {
            table.push("time, UTC", time_words(&format_utc(truth.time)));
        }
        table.push("since start", format!("{:.2} s", self.row.telemetry.time_s));
        if let Some(lens) = &self.lens {
            table.push("lens", lens.as_str());
        }
        let with = before.map_or_else(String::new, |before| format!(", others of field {}", before.number()));
        table.push("rows", format!("{}{with}", self.row.lines.code()));
        table.push("pixels", source.words());
        if by_other {
            table.push("renderer", "fast (run: Mitsuba)");
        }
        let used =
            |usage: &str| self.features.iter().filter(|row| row.kind == "mark" && row.usage == usage).count();
        if self.features.iter().any(|row| row.kind == "mark") {
            table.push("marks", format!("{} used, {} rejected", used("used"), used("rejected")));
        }
        if let Some(reason) = self.reason() {
            table.push("outcome", reason);
        }
        let mut tables = vec![table];
        let truth = self.truth.as_ref().map(|truth| Parameters::from_pose(&truth.pose));
        let mut pose = Table::default();
        if let Some(best) = self.estimate() {
            let (measured, sigmas) = (Parameters::from_pose(&best.pose), Parameters::sigmas(best));
            for (i, (name, value)) in NAMES.into_iter().zip(measured.0).enumerate() {
                let sigma = sigmas.0.get(i).copied().unwrap_or(0.0);
                let digits = decimals(sigma);
                let truth = truth.as_ref().and_then(|truth| truth.0.get(i));
                let truth = truth.map_or_else(String::new, |truth| format!("{truth:.digits$}"));
                pose.push_pair(name, with_sigma(value, sigma), truth);
            }
        } else {
            let range = self.range_alone();
            for (i, name) in NAMES.into_iter().enumerate() {
                let truth = truth.as_ref().and_then(|truth| truth.0.get(i));
                let truth = truth.map_or_else(String::new, |truth| format!("{truth:.3}"));
                // The outline determines d3.
                let value = range.clone().filter(|_| i == D3).unwrap_or_default();
                if !truth.is_empty() || !value.is_empty() {
                    pose.push_pair(name, value, truth);
                }
            }
        }
        if !pose.rows.is_empty() {
            let head = if self.truth.is_some() { ["measured", "truth"] } else { ["measured", ""] };
            pose.head = Some(head.map(str::to_owned));
            tables.push(pose);
        }
        tables
    }

    fn caption(&self) -> Vec<String> {
        let truth = self.truth.as_ref().map(|truth| Parameters::from_pose(&truth.pose).0);
        let Some(best) = self.estimate() else {
            return match (self.range_alone(), self.reason(), truth) {
                (Some(range), _, Some(truth)) => {
                    let [_, _, _, d3, ..] = truth;
                    vec![format!("d3 {range} m, truth {d3:.2} m")]
                }
                (Some(range), _, None) => vec![format!("d3 {range} m")],
                (None, reason, Some([range, ..])) => {
                    let reason = reason.map_or_else(String::new, |reason| format!("{reason}, "));
                    vec![format!("{reason}true range {range:.3} m")]
                }
                (None, reason, None) => reason.into_iter().collect(),
            };
        };
        let [range, .., pitch, yaw, roll] = Parameters::from_pose(&best.pose).0;
        let [range_sigma, .., pitch_sigma, yaw_sigma, roll_sigma] = Parameters::sigmas(best).0;
        let angle_sigma = pitch_sigma.max(yaw_sigma).max(roll_sigma);
        let digits = decimals(angle_sigma);
        let angles =
            |[pitch, yaw, roll]: [f64; 3]| format!("{pitch:.digits$}, {yaw:.digits$}, {roll:.digits$}");
        let sigma = if angle_sigma > 0.0 { format!(" ± {angle_sigma:.digits$}") } else { String::new() };
        let mut lines = vec![
            format!("range {} m", with_sigma(range, range_sigma)),
            format!("pitch, yaw, roll {}{sigma}°", angles([pitch, yaw, roll])),
        ];
        if let Some([range, .., pitch, yaw, roll]) = truth {
            let range_digits = decimals(range_sigma);
            if let Some(line) = lines.first_mut() {
                *line += &format!(", truth {range:.range_digits$} m");
            }
            lines.push(format!("           truth {}°", angles([pitch, yaw, roll])));
        }
        lines
    }

    /// Returns the range of an outcome that contains only a range, m.
    fn range_alone(&self) -> Option<String> {
        match self.answer.as_ref()?.as_ref()?.solution {
            DockingSolution::RangeOnly { range_m, sigma_m } => Some(with_sigma(range_m, sigma_m)),
            _ => None,
        }
    }
}

/// Names of [`Parameters`].
const NAMES: [&str; 7] = ["range, m", "d1, m", "d2, m", "d3, m", "pitch, °", "yaw, °", "roll, °"];
/// Index of d3 in the names.
const D3: usize = 3;

/// Range and position, m, and the rotation vector, degrees.
struct Parameters([f64; 7]);

impl Parameters {
    fn from_pose(pose: &Pose) -> Self {
        let (d, phi) = (&pose.position_m, &pose.phi_rad);
        let [pitch, yaw, roll] = [phi.x, phi.y, phi.z].map(f64::to_degrees);
        Self([d.norm(), d.x, d.y, d.z, pitch, yaw, roll])
    }

    /// Returns the standard deviations; the one of the range is taken along the direction of the position.
    fn sigmas(best: &PoseEstimate) -> Self {
        let (d, covariance) = (&best.pose.position_m, &best.covariance);
        let range = d.norm();
        let of_position = covariance.fixed_view::<3, 3>(0, 0);
        let variance = if range > 0.0 { (of_position * d).dot(d) / (range * range) } else { 0.0 };
        let root = |variance: f64| variance.max(0.0).sqrt();
        let [d1, d2, d3, pitch, yaw, roll] = <[f64; 6]>::from(covariance.diagonal().map(root));
        Self([root(variance), d1, d2, d3, pitch.to_degrees(), yaw.to_degrees(), roll.to_degrees()])
    }
}

/// Number of decimals that shows two digits of a standard deviation; three without a standard deviation.
fn decimals(sigma: f64) -> usize {
    if !(sigma.is_finite() && sigma > 0.0) {
        return 3;
    }
    (1.0 - libm::log10(sigma).floor()).clamp(0.0, 5.0) as usize
}

/// Formats a value with its standard deviation.
fn with_sigma(value: f64, sigma: f64) -> String {
    let digits = decimals(sigma);
    if sigma.is_finite() && sigma > 0.0 {
        format!("{value:.digits$} ± {sigma:.digits$}")
    } else {
        format!("{value:.digits$}")
    }
}

/// Returns the mark of a feature, or `None` for a feature that was not seen. `half` is half the side of the
/// squares, px.
fn feature_mark(row: &FeatureRow, half: f64) -> Option<Mark> {
    let at = PixelPoint::new(row.position[0], row.position[1]);
    let circle =
        || row.radius_px.filter(|radius| radius.is_finite()).map(|radius_px| Shape::Circle { radius_px });
    let (shape, class) = match (row.kind.as_str(), row.usage.as_str()) {
        ("cross", _) => (Shape::Cross { arm: 15.0 }, CROSS),
        ("circle", _) => (circle()?, CIRCLE),
        ("station", _) => (circle()?, STATION),
        ("docking_unit", _) => (circle()?, DOCKING_UNIT),
        ("mark", "used") => (Shape::Square { half }, USED_MARK),
        ("mark", "rejected") => (Shape::Square { half }, REJECTED_MARK),
        _ => return None,
    };
    Some(Mark { at, shape, class, label: None })
}

#[cfg(test)]
mod tests {
    use contract::Frame;
    use nalgebra::{Matrix6, Vector3};

    use super::*;

    fn field(number: u64, lines: Lines, value: u16) -> Field {
        let rows = lines.rows(5);
        let dn = (0..rows).flat_map(|k| [value + k as u16; 2]).collect();
        Field::new(Frame::new(number, 2, rows, 8, dn, None).unwrap(), lines, 5).unwrap()
    }

    fn rows(dn: &[u16]) -> Vec<u16> {
        dn.chunks_exact(2).map(|row| row[0]).collect()
    }

    #[test]
    fn two_fields_are_woven_row_by_row_and_one_alone_fills_its_gaps() {
        let (even, odd) = (field(0, Lines::Even, 10), field(1, Lines::Odd, 20));
        assert_eq!(rows(&woven(&odd, Some(&even))), [10, 20, 11, 21, 12]);
        assert_eq!(rows(&woven(&even, Some(&odd))), [10, 20, 11, 21, 12]);
        assert_eq!(rows(&woven(&even, None)), [10, 10, 11, 11, 12]);
        assert_eq!(rows(&woven(&odd, None)), [20, 20, 21, 21, 21]);
        assert_eq!(rows(&woven(&field(0, Lines::All, 1), None)), [1, 2, 3, 4, 5]);
    }

    #[test]
    fn a_value_has_as_many_decimals_as_its_sigma_deserves() {
        assert_eq!(with_sigma(20.19634, 0.0123), "20.196 ± 0.012");
        assert_eq!(with_sigma(398.372, 4.21), "398.4 ± 4.2");
        assert_eq!(with_sigma(398.372, 42.1), "398 ± 42");
        assert_eq!(with_sigma(1.5, 0.0), "1.500");
        assert_eq!(with_sigma(1.5, f64::NAN), "1.500");
        assert_eq!(with_sigma(1.5, 1e-12), "1.50000 ± 0.00000");
    }

    /// For a camera on the axis, the range has the σ of d3; for a camera beside the axis, the σ along the
    /// line of sight.
    #[test]
    fn the_sigma_of_the_range_is_along_the_line_of_sight() {
        let variances = [0.01, 0.04, 0.09, 1e-4, 4e-4, 9e-4];
        let sigma = |position_m: Vector3<f64>| {
            let pose = Pose { position_m, phi_rad: Vector3::zeros() };
            let covariance = Matrix6::from_diagonal(&nalgebra::Vector6::from(variances));
            Parameters::sigmas(&PoseEstimate { pose, covariance }).0
        };
        assert!((sigma(Vector3::new(0.0, 0.0, 5.0))[0] - 0.3).abs() < 1e-12);
        assert!(
            (sigma(Vector3::new(3.0, 0.0, 4.0))[0] - (0.36 * 0.01 + 0.64 * 0.09_f64).sqrt()).abs() < 1e-12
        );
        assert_eq!(sigma(Vector3::zeros())[0], 0.0);
        assert!((sigma(Vector3::x())[6] - 0.03_f64.to_degrees()).abs() < 1e-12);
    }
}
