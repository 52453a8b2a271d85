//! Far-range frames as panels: stars, target and other objects in the image, the outcome, the transmitted
//! regions.

use std::collections::BTreeMap;

use contract::{Camera, Cluster, Frame, Outcome, PixelPoint, Telemetry, Window};
use far_range::FarRangeScenario;
use far_range::rows::{
    CameraFile, FrameCluster, FrameTruthRow, ObjectTruthRow, TelemetryRow, read_measurements, read_telemetry,
};
use far_range::scoring::{GrantedAttitude, ScoreContext, Scorer, Verdict};
use files::{Failure, FileError, format_utc};
use run::ScenarioSource;
use scenario::run_file::RunFile;
use show::{
    Class, Mark, Panel, Pixels, PlateScale, Reduction, Shape, Stretch, Table, Tone, Verdict as Words,
};
use sim::Simulator;
use sim::optics::Projection;
use sim::truth::{FrameTruth, ObjectKind, ObjectTruth, Visibility};
use view::{AnnotatedFrame, Bounds, PixelSource, Source, display_name, not_stored, rows_of, time_words};

use crate::classes::{COSMIC_RAY, HOT_PIXEL, PLANET, STAR};

/// Distance to the target within which a region or a measurement is included in the close-up, px.
const NEAR_PX: f64 = 40.0;
/// Fraction of electrons outside the regions above which an object is not marked in the picture.
const MAX_CUT: f64 = 0.99;

/// Available data about a frame.
struct FrameRecord {
    name: String,
    telemetry: Telemetry,
    group: Option<String>,
    truth: Option<FrameTruth>,
    objects: Vec<ObjectTruth>,
    /// Outcome of the frame, `None` without a row; the outer `None` without a table of measurements.
    answer: Option<Option<Outcome>>,
    verdict: Option<Verdict>,
}

/// Returns the panels of some frames, in the given order.
///
/// # Errors
/// A [`Failure`] that names the frame or the file that is missing or cannot be read.
pub(crate) fn panels(source: &Source, numbers: &[u64]) -> Result<Vec<AnnotatedFrame>, Failure> {
    let telemetry = read_telemetry(&source.directory.join("telemetry.csv"))?;
    let rows = source.select("frame", &telemetry, numbers, |row: &TelemetryRow| row.frame)?;
    let camera = CameraFile::read(&source.directory.join("camera.toml"))?;
    let run_path = source.directory.join("run.toml");
    let run_file = source.has_run.then(|| RunFile::<FarRangeScenario>::read(&run_path)).transpose()?;
    let name = run_file.as_ref().map_or_else(|| source.name.clone(), |run_file| run_file.name.clone());

    let truths = rows_of::<FrameTruthRow>(source.file("truth/frames.parquet").as_deref(), numbers)?;
    let objects = rows_of::<ObjectTruthRow>(source.file("truth/objects.parquet").as_deref(), numbers)?;
    let mut answers = answers(source, &camera.camera, numbers)?;
    let images = images(source, &camera, &rows)?;
    source.check()?;

    let mut shown = Vec::with_capacity(rows.len());
    for (row, (frame, pixels)) in rows.into_iter().zip(images) {
        let truth = truths.get(&row.frame).and_then(|rows| rows.first()).map(|row| row.0.clone());
        let objects: Vec<ObjectTruth> =
            objects.get(&row.frame).into_iter().flatten().map(|row| row.0.clone()).collect();
        let answer = answers.as_mut().map(|answers| answers.remove(&row.frame));
        let judged = (run_file.as_ref()).zip(truth.as_ref()).zip(answer.as_ref());
        let verdict = match judged {
            Some(((run_file, truth), answer)) => Some(verdict(run_file, truth, &objects, answer.as_ref())?),
            None => None,
        };
        let known = FrameRecord {
            name: name.clone(),
            telemetry: row.telemetry,
            group: truth.as_ref().map(|truth| truth.group.clone()),
            truth,
            objects,
            answer,
            verdict,
        };
        shown.push(known.annotated_frame(&camera.camera, frame, pixels));
    }
    Ok(shown)
}

/// Returns the outcomes of some frames, each with its clusters; `None` if there are no measurements.
fn answers(
    source: &Source,
    camera: &Camera,
    numbers: &[u64],
) -> Result<Option<BTreeMap<u64, Outcome>>, FileError> {
    let Some(path) = &source.measurements else { return Ok(None) };
    let wanted = |(frame, _): &(u64, Outcome)| numbers.contains(frame);
    let mut answers: BTreeMap<u64, Outcome> =
        read_measurements(path, camera)?.into_iter().filter(wanted).collect();
    let clusters = source.beside_measurements("clusters.parquet");
    for (frame, rows) in rows_of::<FrameCluster>(clusters.as_deref(), numbers)? {
        if let Some(answer) = answers.get_mut(&frame) {
            answer.clusters = rows.into_iter().map(|row| row.cluster).collect::<Vec<Cluster>>();
        }
    }
    Ok(Some(answers))
}

/// Returns the images of some rows: stored images and, where none is stored, frames drawn again.
fn images(
    source: &Source,
    camera: &CameraFile,
    rows: &[&TelemetryRow],
) -> Result<Vec<(Frame, PixelSource)>, Failure> {
    let mut simulator: Option<Simulator> = None;
    let mut images = Vec::with_capacity(rows.len());
    for row in rows {
        if let Some(frame) = camera.read_listed(&source.directory, row)? {
            images.push((frame, PixelSource::Stored));
            continue;
        }
        if !source.has_run {
            return Err(not_stored(source, "frame", row.frame));
        }
        let simulator = match &simulator {
            Some(simulator) => simulator,
            None => {
                let run = ScenarioSource::read(&source.directory.join("run.toml").to_string_lossy())?;
                &*simulator.insert(far_range::simulator(&run, run.typed("boresight show")?)?)
            }
        };
        images.push((simulator.camera()?.expose(row.frame)?.frame, PixelSource::DrawnAgain));
    }
    Ok(images)
}

/// Returns the verdict on one frame.
fn verdict(
    run_file: &RunFile<FarRangeScenario>,
    truth: &FrameTruth,
    objects: &[ObjectTruth],
    answer: Option<&Outcome>,
) -> Result<Verdict, Failure> {
    let camera = &run_file.scenario.camera;
    let projection = Projection::new(camera)?;
    let mut scorer = Scorer::new(ScoreContext {
        scenario: run_file.name.clone(),
        seed: run_file.scenario.seed,
        version: run_file.version.clone(),
        inject: None,
        columns: camera.columns,
        rows: camera.rows,
        limits: far_range::limits(&run_file.scenario),
        warm_up_frames: 0,
        unproject: Box::new(|point| projection.unproject(point)),
    });
    let judged = scorer.add(truth, objects, answer, GrantedAttitude::None);
    judged
        .map(|judged| judged.verdict)
        .map_err(|error| Failure::Usage(format!("frame {} cannot be scored: {error}", truth.frame)))
}

impl FrameRecord {
    fn annotated_frame(&self, camera: &Camera, frame: Frame, source: PixelSource) -> AnnotatedFrame {
        let number = frame.number();
        let regions = frame.windows().map(<[Window]>::to_vec);
        let (columns, rows) = (frame.columns(), frame.rows());
        let full_scale_dn = frame.full_scale_dn();
        let pixels = Pixels { columns, rows, dn: frame.into_dn(), full_scale_dn };
        let time = time_words(&format_utc(self.telemetry.time));
        let verdict = self.verdict_words();
        let (code, cause) = match self.verdict {
            None => (None, None),
            Some(Verdict::Correct { .. }) => (Some("correct"), None),
            Some(Verdict::Wrong { cause, .. }) => (Some("wrong"), Some(cause.code())),
            Some(Verdict::Missed { cause }) => (Some("missed"), Some(cause.code())),
        };
        let panel = Panel {
            view: pixels.full_window(),
            close_up: self.close_up(regions.as_deref(), columns, rows),
            pixels,
            regions,
            stretch: Stretch::Asinh,
            reduction: Reduction::Brightest,
            scale: PlateScale { focal_length_px: camera.focal_length_px().0, range_m: None },
            marks: self.marks(),
            title: format!("{}, frame {number}", self.name),
            short_title: match &self.group {
                Some(group) => format!("frame {number}, {group}"),
                None => format!("frame {number}"),
            },
            verdict,
            tables: self.tables(&time, source),
            caption: self.caption(&time),
        };
        AnnotatedFrame {
            panel,
            frame: number,
            time: format_utc(self.telemetry.time),
            pixels: source,
            verdict: code.map(str::to_owned),
            cause: cause.map(str::to_owned),
        }
    }

    fn target(&self) -> Option<&ObjectTruth> {
        self.objects.iter().find(|object| object.kind == ObjectKind::Target)
    }

    /// Returns the true position of the target: its centroid or, for a target without signal in the image,
    /// the line of sight.
    fn target_position(&self) -> Option<PixelPoint> {
        let of_frame = || self.truth.as_ref().and_then(|truth| truth.target_position);
        self.target().map(|target| target.position).or_else(of_frame)
    }

    fn answer_position(&self) -> Option<PixelPoint> {
        let answer = self.answer.as_ref()?.as_ref()?;
        answer.measurement().map(|measurement| measurement.position)
    }

    /// Returns the marks. Later marks cover earlier ones; bright stars are labelled first.
    fn marks(&self) -> Vec<Mark> {
        let mut objects: Vec<&ObjectTruth> = self
            .objects
            .iter()
            .filter(|object| object.kind != ObjectKind::Target && object.cut < MAX_CUT)
            .filter(|object| Visibility::from_snr(object.snr) == Visibility::Detectable)
            .collect();
        objects.sort_by(|a, b| {
            a.kind.cmp(&b.kind).then(b.electrons.total_cmp(&a.electrons)).then(a.id.cmp(&b.id))
        });
        let mut marks: Vec<Mark> = objects.into_iter().filter_map(object_mark).collect();
        let around = |radius_px, least| Shape::Around { radius_px, least };
        let radius_px = self.target().map_or(0.0, |target| target.radius_px);
        marks.extend(self.target_position().map(|at| Mark {
            at,
            shape: around(radius_px, 13.0),
            class: Class::TARGET,
            label: None,
        }));
        let cross = Shape::Cross { arm: 11.0 };
        marks.extend(self.answer_position().map(|at| Mark {
            at,
            shape: cross,
            class: Class::ANSWER,
            label: None,
        }));
        marks
    }

    /// Returns the surroundings of the target or, if its position is unknown or off the detector, those of
    /// the measurement.
    fn close_up(&self, regions: Option<&[Window]>, columns: usize, rows: usize) -> Option<Window> {
        let on_detector = |at: &PixelPoint| at.is_on_detector(columns, rows);
        let answer = self.answer_position().filter(on_detector);
        let centre = self.target_position().filter(on_detector).or(answer)?;
        let mut bounds = Bounds::from_point(centre);
        let is_near = |at: &PixelPoint| at.distance(centre) < NEAR_PX;
        answer.filter(is_near).into_iter().for_each(|at| bounds.add(at));
        for region in regions.unwrap_or_default() {
            let low = PixelPoint::new(region.x as f64, region.y as f64);
            let high = PixelPoint::new(low.x + region.columns as f64 - 1.0, low.y + region.rows as f64 - 1.0);
            let gap = |at: f64, low: f64, high: f64| (low - at).max(at - high).max(0.0);
            let distance = gap(centre.x, low.x, high.x).max(gap(centre.y, low.y, high.y));
            // The region of the target; a region of the whole detector does not count.
            if distance < 4.0 && high.x - low.x < 4.0 * NEAR_PX && high.y - low.y < 4.0 * NEAR_PX {
                bounds.add(low);
                bounds.add(high);
            }
        }
        Some(bounds.window(columns, rows))
    }

    fn verdict_words(&self) -> Option<Words> {
        let (words, tone) = match self.verdict? {
            Verdict::Correct { .. } => ("correct".to_owned(), Tone::Good),
            Verdict::Missed { cause } => (format!("missed: {}", display_name(cause.code())), Tone::Bad),
            Verdict::Wrong { cause, taken, .. } => (
                format!("wrong: {}, taken: {}", display_name(cause.code()), display_name(taken.code())),
                Tone::Bad,
            ),
        };
        Some(Words { words, tone })
    }

    /// Returns the measured minus the true position, px.
    fn error_px(&self) -> Option<(f64, f64)> {
        let (answer, truth) = self.answer_position().zip(self.target_position())?;
        Some((answer.x - truth.x, answer.y - truth.y))
    }

    fn tables(&self, time: &str, source: PixelSource) -> Vec<Table> {
        let mut table = Table::default();
        table.push("time, UTC", time);
        if let Some(group) = &self.group {
            table.push("group", group.as_str());
        }
        table.push("exposure", exposure_words(self.telemetry.exposure_s));
        table.push("pixels", source.words());
        if let Some(truth) = &self.truth {
            table.push("range", format!("{:.3} km", truth.range_km));
            table.push("phase angle", format!("{:.1}°", truth.phase_deg));
        }
        if let Some(target) = self.target() {
            table.push("target SNR", format!("{:.1}", target.snr));
            table.push("cut", format!("{:.0} % of its signal", 100.0 * target.cut));
        }
        let point = |at: PixelPoint| format!("{:.2}, {:.2} px", at.x, at.y);
        if let Some(at) = self.target_position() {
            table.push("truth", point(at));
        }
        match &self.answer {
            Some(Some(answer)) => {
                let position = self.answer_position().map_or_else(
                    || match &answer.solution {
                        contract::Solution::NoSolution(reason) => display_name(&reason.to_string()),
                        contract::Solution::Detected(_) => String::new(),
                    },
                    point,
                );
                table.push("measured", position);
                if let Some((x, y)) = self.error_px() {
                    table.push("error", format!("{x:+.2}, {y:+.2} px"));
                }
                if let Some(stars) = answer.n_stars {
                    table.push("stars", format!("{stars} identified"));
                }
            }
            Some(None) => table.push("measured", "no row"),
            None => {}
        }
        vec![table]
    }

    fn caption(&self, time: &str) -> Vec<String> {
        let first = format!("{time} UTC, exposure {}", exposure_words(self.telemetry.exposure_s));
        let mut parts = Vec::new();
        if let Some(truth) = &self.truth {
            parts.push(format!("range {:.2} km", truth.range_km));
        }
        if let Some(target) = self.target() {
            parts.push(format!("SNR {:.0}", target.snr));
            if target.cut >= 0.005 {
                parts.push(format!("{:.0} % cut", 100.0 * target.cut));
            }
        }
        let error = self.error_px().map(|(x, y)| format!("error {x:+.2}, {y:+.2} px"));
        vec![first, parts.join(", "), error.unwrap_or_default()]
    }
}

/// Returns the mark of an object other than the target.
fn object_mark(object: &ObjectTruth) -> Option<Mark> {
    let (class, least, label) = match object.kind {
        ObjectKind::Target => return None,
        ObjectKind::Star => (STAR, 7.0, Some(format!("HIP {}", object.id))),
        ObjectKind::Planet => (PLANET, 9.0, Some(planet(object.id))),
        ObjectKind::Moon => (PLANET, 9.0, Some("Moon".to_owned())),
        ObjectKind::HotPixel => (HOT_PIXEL, 6.0, None),
        ObjectKind::CosmicRay => (COSMIC_RAY, 6.0, None),
    };
    Some(Mark {
        at: object.position,
        shape: Shape::Around { radius_px: object.radius_px.min(40.0), least },
        class,
        label,
    })
}

/// Returns the name of a planet from its number, counted from the Sun outwards.
fn planet(number: u32) -> String {
    const NAMES: [&str; 8] = ["Mercury", "Venus", "Earth", "Mars", "Jupiter", "Saturn", "Uranus", "Neptune"];
    let name = usize::try_from(number).ok().and_then(|number| NAMES.get(number.checked_sub(1)?));
    name.map_or_else(|| format!("planet {number}"), |name| (*name).to_owned())
}

fn exposure_words(exposure_s: f64) -> String {
    if exposure_s < 1.0 { format!("{:.1} ms", 1000.0 * exposure_s) } else { format!("{exposure_s:.3} s") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn planets_and_exposures_are_words() {
        assert_eq!(
            (planet(2).as_str(), planet(0).as_str(), planet(9).as_str()),
            ("Venus", "planet 0", "planet 9")
        );
        assert_eq!((exposure_words(0.2102).as_str(), exposure_words(2.0).as_str()), ("210.2 ms", "2.000 s"));
    }
}
