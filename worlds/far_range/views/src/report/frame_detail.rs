//! Frames of a far-range run, rendered anew one by one: frame N can be rendered independently of the other
//! frames of the run.

use ::report::RunFiles;
use ::report::figures::least_to_most;
use ::report::figures::words::display_name;
use ::report::page::picture::{Mark, Picture, Pixels, RowMapping, Shape, Stretch, window_around};
use ::report::read::rows_of_each;
use contract::{Cluster, Label, Outcome, PixelPoint, Window};
use far_range::rows::FrameCluster;
use far_range::scoring::{FrameVerdict, Verdict};
use far_range::simulator;
use files::Failure;
use run::ScenarioSource;
use sim::truth::{ObjectKind, ObjectTruth, Visibility};
use sim::{Exposure, Simulator};

use super::run::{FarRangeRun, shown_time};

/// The simulator of a run, and the file of the pipeline's clusters.
pub struct FrameDetail {
    simulator: Result<Simulator, String>,
    clusters: Option<std::path::PathBuf>,
}

impl FrameDetail {
    /// Opens the frames of a run. If its scenario can no longer be simulated (a file that it names
    /// is missing), there are no pictures, and [`FrameDetail::reason`] returns the reason.
    ///
    /// # Errors
    /// A [`Failure`] when `run.toml` cannot be read.
    pub fn open(files: &RunFiles) -> Result<Self, Failure> {
        let path = files.path("run.toml");
        let source = ScenarioSource::read(&path.to_string_lossy())?;
        let simulator = simulator(&source, source.typed("the report of a far-range run")?);
        Ok(Self {
            simulator: simulator.map_err(|failure| failure.to_string()),
            clusters: files.beside("clusters.parquet"),
        })
    }

    /// Returns the reason why there are no pictures.
    pub fn reason(&self) -> Option<&str> {
        self.simulator.as_ref().err().map(String::as_str)
    }

    /// Returns pictures of the given rows of a run, in their order.
    ///
    /// # Errors
    /// A [`Failure`] when a frame cannot be rendered, or the clusters cannot be read.
    pub fn pictures(&self, run: &FarRangeRun, rows: &[usize]) -> Result<Vec<Picture>, Failure> {
        let Ok(simulator) = &self.simulator else { return Ok(Vec::new()) };
        let mut camera = simulator.camera()?;
        let clusters = self.clusters_of(run, rows)?;
        let picture = |(&row, clusters): (&usize, Vec<Cluster>)| {
            let exposure = camera.expose(run.truths[row].frame)?;
            let mut picture = framed(&exposure, run.outcomes[row].as_ref(), &clusters)?;
            picture.title = title(&run.verdicts[row]);
            picture.caption = caption(run, row, &exposure);
            Ok(picture)
        };
        rows.iter().zip(clusters).map(picture).collect()
    }

    /// Returns a picture of the whole detector for a row of a run.
    ///
    /// # Errors
    /// Those of [`FrameDetail::pictures`].
    pub fn full_frame(&self, run: &FarRangeRun, row: usize) -> Result<Option<Picture>, Failure> {
        let Ok(simulator) = &self.simulator else { return Ok(None) };
        let exposure = simulator.camera()?.expose(run.truths[row].frame)?;
        let clusters = self.clusters_of(run, &[row])?.remove(0);
        let mut picture = picture_of(&exposure, &[], 0.0)?;
        draw_over(&mut picture, &exposure, run.outcomes[row].as_ref(), &clusters);
        picture.title = title(&run.verdicts[row]);
        picture.caption = caption(run, row, &exposure);
        Ok(Some(picture))
    }

    /// Returns one picture of several rows of a run, with the maximum of each pixel.
    ///
    /// # Errors
    /// A [`Failure`] when a frame cannot be rendered.
    pub fn overlaid(&self, run: &FarRangeRun, rows: &[usize]) -> Result<Option<Picture>, Failure> {
        let (Ok(simulator), Some(&first), Some(&last)) = (&self.simulator, rows.first(), rows.last()) else {
            return Ok(None);
        };
        let mut camera = simulator.camera()?;
        let (mut brightest, mut marks): (Vec<u16>, Vec<Mark>) = (Vec::new(), Vec::new());
        for &row in rows {
            let exposure = camera.expose(run.truths[row].frame)?;
            brightest.resize(exposure.frame.dn().len(), 0);
            for (brightest, dn) in brightest.iter_mut().zip(exposure.frame.dn()) {
                *brightest = (*brightest).max(*dn);
            }
            // Small circles: circles of the size of the target's image would hide its track.
            let small = |target| Mark { shape: Shape::Circle(4.0), ..true_mark(target) };
            marks.extend(target(&exposure).map(small));
        }
        let size = &run.run_file.scenario.camera;
        let (columns, rows_px) = (size.columns, size.rows);
        let whole = Window { x: 0, y: 0, columns, rows: rows_px };
        let pixels = Pixels { columns, rows: rows_px, dn: &brightest };
        let mut picture = Picture::new(pixels, whole, RowMapping::WHOLE, Stretch::Stars)?;
        picture.title = format!("{} images, superimposed.", rows.len());
        picture.caption = format!(
            "Frames {} to {}, {} to {} (UTC), {}.",
            run.truths[first].frame,
            run.truths[last].frame,
            shown_time(&run.truths[first]),
            shown_time(&run.truths[last]),
            least_to_most(run.truths[first..=last].iter().map(|truth| truth.range_km), "km")
        );
        picture.marks = marks;
        Ok(Some(picture))
    }

    /// Returns a close picture of the first of the rows for which `is_wanted` accepts the fraction of the
    /// target's electrons that its region cuts off.
    ///
    /// # Errors
    /// A [`Failure`] when a frame cannot be rendered.
    pub fn first_region(
        &self,
        run: &FarRangeRun,
        rows: impl Iterator<Item = usize>,
        is_wanted: impl Fn(f64) -> bool,
    ) -> Result<Option<Picture>, Failure> {
        let Ok(simulator) = &self.simulator else { return Ok(None) };
        let mut camera = simulator.camera()?;
        for row in rows {
            let exposure = camera.expose(run.truths[row].frame)?;
            let Some(target) = target(&exposure).filter(|target| is_wanted(target.cut)) else { continue };
            let (x, y) =
                (target.position.x.round().max(0.0) as usize, target.position.y.round().max(0.0) as usize);
            let windows = exposure.frame.windows().unwrap_or_default();
            let Some(region) = windows.iter().find(|w| w.contains(x, y)) else { continue };
            let corner =
                |dx: usize, dy: usize| PixelPoint::new((region.x + dx) as f64, (region.y + dy) as f64);
            let around = [corner(0, 0), corner(region.columns - 1, region.rows - 1), target.position];
            let mut picture = picture_of(&exposure, &around, 6.0)?;
            picture.title = if target.cut < 0.02 { "Whole.".to_owned() } else { "Truncated.".to_owned() };
            picture.caption = format!(
                "Frame {}, {}, {:.2} km: {:.0} % of the target's electrons are cut off.",
                exposure.truth.frame,
                exposure.truth.group,
                exposure.truth.range_km,
                100.0 * target.cut
            );
            picture.marks = regions(&exposure);
            picture.marks.push(true_mark(target));
            picture.marks.extend(answer_mark(run.outcomes[row].as_ref()));
            // Drawn over the measured position, and smaller: if the two agree, both remain visible.
            picture.marks.push(Mark { shape: Shape::Cross(2.5), ..true_mark(target) });
            return Ok(Some(picture));
        }
        Ok(None)
    }

    /// Returns the clusters of the given rows, in their order.
    fn clusters_of(&self, run: &FarRangeRun, rows: &[usize]) -> Result<Vec<Vec<Cluster>>, Failure> {
        let frames: Vec<u64> = rows.iter().map(|&row| run.truths[row].frame).collect();
        let found = rows_of_each::<FrameCluster>(self.clusters.as_deref(), &frames)?;
        let clusters = |rows: Vec<FrameCluster>| rows.into_iter().map(|row| row.cluster).collect();
        Ok(found.into_iter().map(clusters).collect())
    }
}

/// Describes the verdict on a frame in words.
fn title(verdict: &FrameVerdict) -> String {
    match verdict.verdict {
        Verdict::Correct { .. } => "Correct.".to_owned(),
        Verdict::Missed { cause } => format!("Missed: {}.", display_name(cause.code())),
        Verdict::Wrong { cause, taken, .. } => {
            format!("Wrong: {}; taken: {}.", display_name(cause.code()), display_name(taken.code()))
        }
    }
}

/// Describes the frame: number, group, range and exposure time.
fn caption(run: &FarRangeRun, row: usize, exposure: &Exposure) -> String {
    let verdict = &run.verdicts[row];
    format!(
        "Frame {}, {}, {:.2} km, exposure {:.4} s{}.",
        verdict.frame,
        verdict.group,
        exposure.truth.range_km,
        exposure.truth.exposure_s,
        distance(run.outcomes[row].as_ref(), exposure)
    )
}

/// Describes the distance of the measured position from the target.
fn distance(outcome: Option<&Outcome>, exposure: &Exposure) -> String {
    let measured = outcome.and_then(Outcome::measurement);
    match measured.zip(target(exposure)) {
        Some((measured, target)) => {
            format!(", measurement {:.2} px from the target", measured.position.distance(target.position))
        }
        None => String::new(),
    }
}

fn target(exposure: &Exposure) -> Option<&ObjectTruth> {
    exposure.objects.iter().find(|object| object.kind == ObjectKind::Target)
}

/// Returns a picture around the target and the measured position, with all marks of the frame.
fn framed(exposure: &Exposure, outcome: Option<&Outcome>, clusters: &[Cluster]) -> Result<Picture, Failure> {
    let measured = outcome.and_then(Outcome::measurement).map(|measured| measured.position);
    let points: Vec<PixelPoint> =
        target(exposure).map(|target| target.position).into_iter().chain(measured).collect();
    let mut picture = picture_of(exposure, &points, 36.0)?;
    draw_over(&mut picture, exposure, outcome, clusters);
    Ok(picture)
}

/// Draws regions, clusters, detectable objects, target and measured position over a picture of a frame.
fn draw_over(picture: &mut Picture, exposure: &Exposure, outcome: Option<&Outcome>, clusters: &[Cluster]) {
    let window = picture.window;
    let is_shown = |at: PixelPoint| {
        let inside =
            |at: f64, from: usize, count: usize| at > from as f64 - 1.0 && at < (from + count) as f64;
        inside(at.x, window.x, window.columns) && inside(at.y, window.y, window.rows)
    };
    picture.marks = regions(exposure);
    let clusters = clusters.iter().filter(|cluster| is_shown(cluster.position));
    picture.marks.extend(clusters.map(cluster_mark));
    let others = exposure.objects.iter().filter(|object| {
        object.kind != ObjectKind::Target
            && is_shown(object.position)
            && Visibility::from_snr(object.snr) == Visibility::Detectable
    });
    picture.marks.extend(others.map(other_mark));
    picture.marks.extend(target(exposure).map(true_mark));
    picture.marks.extend(answer_mark(outcome));
}

fn picture_of(exposure: &Exposure, points: &[PixelPoint], margin_px: f64) -> Result<Picture, Failure> {
    let frame = &exposure.frame;
    let (columns, rows) = (frame.columns(), frame.rows());
    let window = window_around(points, margin_px, columns, rows);
    Picture::new(Pixels { columns, rows, dn: frame.dn() }, window, RowMapping::WHOLE, Stretch::Stars)
}

fn regions(exposure: &Exposure) -> Vec<Mark> {
    let windows = exposure.frame.windows().unwrap_or_default();
    windows.iter().map(|window| Mark::region(window, "transmitted region")).collect()
}

fn true_mark(target: &ObjectTruth) -> Mark {
    Mark {
        at: target.position,
        shape: Shape::Circle(target.radius_px.max(4.0) + 2.0),
        class: "truth",
        title: format!(
            "target, true: ({:.2}, {:.2}) px, {:.0} electrons, SNR {:.1}, {:.0} % cut",
            target.position.x,
            target.position.y,
            target.electrons,
            target.snr,
            100.0 * target.cut
        ),
    }
}

fn answer_mark(outcome: Option<&Outcome>) -> Option<Mark> {
    let at = outcome?.measurement()?.position;
    let title = format!("measurement: ({:.2}, {:.2}) px", at.x, at.y);
    Some(Mark { at, shape: Shape::Cross(6.0), class: "measured", title })
}

fn other_mark(object: &ObjectTruth) -> Mark {
    let is_star = object.kind == ObjectKind::Star;
    let magnitude = object.magnitude.map_or_else(String::new, |magnitude| format!(", V {magnitude:.1}"));
    Mark {
        at: object.position,
        shape: Shape::Circle(object.radius_px.clamp(2.5, 12.0)),
        class: if is_star { "star" } else { "other" },
        title: format!(
            "{} {}{magnitude}, SNR {:.1}",
            display_name(object.kind.code()),
            object.id,
            object.snr
        ),
    }
}

fn cluster_mark(cluster: &Cluster) -> Mark {
    let half = 4.0;
    let taken = match cluster.label {
        Label::Star(id) => format!("star {id}"),
        label => label.code().to_owned(),
    };
    Mark {
        at: PixelPoint::new(cluster.position.x - half, cluster.position.y - half),
        shape: Shape::Rectangle { width: 2.0 * half, height: 2.0 * half },
        class: "cluster",
        title: format!("cluster of {} px, classified as: {taken}", cluster.pixels),
    }
}
