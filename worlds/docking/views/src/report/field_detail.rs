//! Fields of a docking run, drawn anew one by one, with the recognised features.

use std::path::PathBuf;

use ::report::RunFiles;
use ::report::figures::words::{capital, display_name};
use ::report::page::picture::{Mark, Picture, Pixels, RowMapping, Shape, Stretch};
use ::report::read::rows_of_each;
use contract::docking::{DockingOutcome, DockingSetup, DockingSolution};
use contract::{PixelPoint, Window};
use docking::rows::FeatureRow;
use docking::{DockingRenderer, simulator};
use files::Failure;
use run::ScenarioSource;
use sim::docking::{DockingSimulator, FieldTruth};

use super::DockingRun;

/// Smallest width of a picture, px.
const MIN_PICTURE_WIDTH_PX: f64 = 160.0;

/// The simulator of a run, and the file of the recognised features.
pub struct FieldDetail {
    simulator: Result<(DockingSimulator, DockingSetup), String>,
    features: Option<PathBuf>,
}

impl FieldDetail {
    /// Opens the fields of a run directory. If its scenario can no longer be simulated, there are no
    /// pictures, and [`FieldDetail::reason`] returns the reason.
    ///
    /// # Errors
    /// A [`Failure`] when `run.toml` cannot be read.
    pub fn open(files: &RunFiles) -> Result<Self, Failure> {
        let path = files.path("run.toml");
        let source = ScenarioSource::read(&path.to_string_lossy())?;
        let simulator = simulator(&source, source.typed("the report of a docking run")?);
        Ok(Self {
            simulator: simulator
                .map(|simulator| {
                    let setup = simulator.setup();
                    (simulator, setup)
                })
                .map_err(|failure| failure.to_string()),
            features: files.beside("features.parquet"),
        })
    }

    /// Returns the reason why there are no pictures.
    pub fn reason(&self) -> Option<&str> {
        self.simulator.as_ref().err().map(String::as_str)
    }

    /// Returns pictures of the given rows of a run, in their order.
    ///
    /// # Errors
    /// A [`Failure`] when a field cannot be drawn, or the features cannot be read.
    pub fn pictures(&self, run: &DockingRun, rows: &[usize]) -> Result<Vec<Picture>, Failure> {
        let Ok((simulator, setup)) = &self.simulator else { return Ok(Vec::new()) };
        let mut workspace = simulator.workspace()?;
        let fields: Vec<u64> = rows.iter().map(|&row| run.truths[row].field).collect();
        let features = rows_of_each::<FeatureRow>(self.features.as_deref(), &fields)?;
        let mut pictures = Vec::with_capacity(rows.len());
        for (&row, features) in rows.iter().zip(features) {
            let (truth, unit) = (&run.truths[row], &run.verdicts[row]);
            let exposure = DockingRenderer::Fast.expose(simulator, setup, &mut workspace, truth.field)?;
            let field = exposure.video.digitise(&run.telemetry[row].telemetry.digitiser);
            let image = field.image();
            let lines =
                RowMapping { first: field.lines().camera_row(0) as f64, pitch: field.lines().step() as f64 };
            let window = window(truth, &features, (image.columns(), image.rows()), lines);
            let pixels = Pixels { columns: image.columns(), rows: image.rows(), dn: image.dn() };
            let mut picture = Picture::new(pixels, window, lines, Stretch::Linear)?;
            picture.title = match (unit.verdict.as_str(), &unit.cause) {
                ("success", _) => "Measured.".to_owned(),
                ("range_only", _) => "Range only.".to_owned(),
                (verdict, Some(cause)) => format!("{}: {}.", capital(verdict), display_name(cause)),
                (verdict, None) => format!("{}.", capital(verdict)),
            };
            picture.caption = format!(
                "Field {}, {:.2} s, {}, true ρ {:.3} m, {}.",
                truth.field,
                truth.time_s,
                unit.group,
                truth.range_m,
                answer_words(run.outcomes[row].as_ref())
            );
            picture.marks.extend(true_marks(truth));
            picture.marks.extend(features.iter().map(feature_mark));
            pictures.push(picture);
        }
        Ok(pictures)
    }
}

/// Returns the window around the recognised circle, or else around the true target; the whole field if
/// neither is in it.
fn window(
    truth: &FieldTruth,
    features: &[FeatureRow],
    (columns, rows): (usize, usize),
    lines: RowMapping,
) -> Window {
    let circle = features.iter().find(|row| row.kind == "circle");
    let recognised = circle.map(|row| (row.position, row.radius_px.unwrap_or(0.0)));
    let of_truth =
        truth.disk_centre.map(|centre| ([centre.x, centre.y], truth.circle_radius_px.unwrap_or(0.0)));
    let whole = Window { x: 0, y: 0, columns, rows };
    let Some(([x, y], radius)) = recognised.or(of_truth) else { return whole };
    let row = (y - lines.first) / lines.pitch;
    if !(x > 0.0 && x < columns as f64 && row > 0.0 && row < rows as f64 && radius.is_finite()) {
        return whole;
    }
    let side = |middle: f64, length: f64, limit: usize| {
        let length = (length.ceil() as usize).clamp(1, limit);
        let start = (middle - length as f64 / 2.0).round().max(0.0) as usize;
        (start.min(limit - length), length)
    };
    let width = (4.2 * radius).max(MIN_PICTURE_WIDTH_PX);
    let (x, columns) = side(x, width, columns);
    let (y, rows) = side(row, 0.75 * width / lines.pitch, rows);
    Window { x, y, columns, rows }
}

fn true_marks(truth: &FieldTruth) -> impl Iterator<Item = Mark> {
    let mark = |at: Option<PixelPoint>, arm: f64, what: &str| {
        let title = |at: &PixelPoint| format!("{what}, true: ({:.2}, {:.2}) px", at.x, at.y);
        at.map(|at| Mark { at, shape: Shape::Cross(arm), class: "truth", title: title(&at) })
    };
    let circle = truth.disk_centre.zip(truth.circle_radius_px).map(|(at, radius)| Mark {
        at,
        shape: Shape::Circle(radius.max(0.5)),
        class: "truth",
        title: format!("circle of the marks, truth without tilt: radius {radius:.2} px"),
    });
    mark(truth.cross_centre, 5.0, "centre of the cross")
        .into_iter()
        .chain(mark(truth.disk_centre, 3.0, "centre of the disk"))
        .chain(circle)
}

fn feature_mark(row: &FeatureRow) -> Mark {
    let at = PixelPoint::new(row.position[0], row.position[1]);
    let place = format!("({:.2}, {:.2}) px", at.x, at.y);
    let (shape, class, title) = match row.kind.as_str() {
        "cross" => (Shape::Cross(9.0), "measured", format!("cross, recognised: {place}")),
        "mark" => {
            let class = if row.usage == "used" { "measured" } else { "other" };
            (Shape::Circle(3.0), class, format!("mark {}, {}: {place}", row.index, display_name(&row.usage)))
        }
        kind => {
            let radius = row.radius_px.filter(|radius| radius.is_finite()).unwrap_or(3.0);
            let class = if kind == "circle" { "measured" } else { "cluster" };
            let title = format!("{}, recognised: {place}, radius {radius:.2} px", display_name(kind));
            (Shape::Circle(radius.max(0.5)), class, title)
        }
    };
    Mark { at, shape, class, title }
}

/// Describes the outcome of a field in words.
fn answer_words(outcome: Option<&DockingOutcome>) -> String {
    match outcome.map(|outcome| &outcome.solution) {
        None => "no outcome".to_owned(),
        Some(DockingSolution::Measured(measured)) => {
            format!("ρ measured {:.3} m", measured.best.pose.position_m.norm())
        }
        Some(DockingSolution::Doubtful { measurement, doubt }) => {
            format!("{doubt}, ρ measured {:.3} m", measurement.best.pose.position_m.norm())
        }
        Some(DockingSolution::RangeOnly { range_m, .. }) => format!("range only {range_m:.2} m"),
        Some(DockingSolution::NoSolution(reason)) => match reason.to_string() {
            // A reason in the pipeline's wording.
            text if text.contains(' ') => format!("the pipeline reports: {text}"),
            code => format!("the pipeline reports: {}", display_name(&code)),
        },
    }
}
