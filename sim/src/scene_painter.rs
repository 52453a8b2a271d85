//! Expected image of a scene: background and sources, on the pixels of the detector.

use contract::PixelPoint;
use nalgebra::Vector3;
use optics::{ImagePoint, Psf, Stamp};
use render::draw::ExpectedImage;
use render::painter::Painter;
use scene::Source;
use truth::ObjectKind;

use crate::Simulator;
use crate::scene_view::{FrameViews, SceneView};

/// Maximum number of points in the image of a source: those of its body multiplied by those of its trail.
const POINTS: usize = 1 << 18;
/// Maximum number of points in the image of the Moon: a disk of 1150 px has a point in every pixel.
pub(crate) const MOON_POINTS: usize = 1 << 20;
/// Displacement of an image within its rows below which a rolling shutter does not deform it, px.
const STILL_PX: f64 = 1e-4;
/// Largest time at which a position is extrapolated, in halves of the readout: sources far off the detector.
const MAX_TIME: f64 = 2.0;
/// Largest number of steps to the row of a source.
const ROW_STEPS: usize = 50;

/// Painter of scenes, with the buffers that frames reuse.
#[derive(Debug)]
pub(crate) struct ScenePainter {
    painter: Painter,
    /// Background of an interlaced scene, electrons per second, pixel by pixel: of the first field, and of
    /// the second.
    backgrounds: [Vec<f64>; 2],
    /// Images of an object at other times: in the first and the second field, or before and after the row of
    /// its centre.
    others: [Stamp; 2],
    /// Image of an object at the time of the row of its centre.
    own: Stamp,
}

impl ScenePainter {
    pub(crate) fn new(psf: Psf) -> Self {
        Self {
            painter: Painter::new(psf),
            backgrounds: [Vec::new(), Vec::new()],
            others: [Stamp::new(), Stamp::new()],
            own: Stamp::new(),
        }
    }

    /// Returns the point-spread function.
    pub(crate) fn psf(&self) -> &Psf {
        self.painter.psf()
    }

    /// Adds the background of a frame to its image.
    pub(crate) fn add_background(
        &mut self,
        middle: &SceneView,
        drawn: &FrameViews,
        exposure_s: f64,
        image: &mut ExpectedImage,
    ) {
        match drawn {
            // A smooth background does not change noticeably during the readout of a frame.
            FrameViews::Single | FrameViews::Rows(_) => {
                if let Some(background) = &middle.background {
                    image.set_smooth(background.smooth(), exposure_s);
                }
            }
            FrameViews::Fields(interlace, fields) => {
                let [first, second] = &**fields;
                let [background, later] = &mut self.backgrounds;
                if first.background_e_per_s(background) && second.background_e_per_s(later) {
                    interlace.weave(background, later, image.size().0);
                    image.set_field(Some(background), exposure_s);
                }
            }
        }
    }

    /// Adds all sources of a frame to its image, and sets the position of each in `middle` to the centre of
    /// its image.
    pub(crate) fn add_sources(
        &mut self,
        simulator: &Simulator,
        middle: &mut SceneView,
        drawn: &FrameViews,
        exposure_s: f64,
        image: &mut ExpectedImage,
    ) {
        for index in 0..middle.sources.len() {
            let image_of_source = image.add_painted(|stamp| match drawn {
                FrameViews::Single => self.paint_source(simulator, middle, index, exposure_s, stamp),
                FrameViews::Fields(interlace, fields) => {
                    let [first, second] = &**fields;
                    let mut others = std::mem::take(&mut self.others);
                    self.paint_source(simulator, first, index, exposure_s, &mut others[0]);
                    self.paint_source(simulator, second, index, exposure_s, &mut others[1]);
                    stamp.weave(&others[0], &others[1], |row| interlace.is_first(row));
                    self.others = others;
                }
                FrameViews::Rows(views) => {
                    self.paint_row_by_row(simulator, middle, views, index, exposure_s, stamp);
                }
            });
            middle.sources[index].position = image_of_source.centre();
        }
    }

    /// Draws into `stamp` the image of a source of a scene, electrons.
    fn paint_source(
        &mut self,
        simulator: &Simulator,
        view: &SceneView,
        index: usize,
        exposure_s: f64,
        stamp: &mut Stamp,
    ) {
        let source = view.sources[index];
        self.paint_moved(simulator, view, &source, source.position, exposure_s, stamp);
    }

    /// Draws into `stamp` the image of a source of a scene, electrons. Its body has the points that it has in
    /// `view` about `centre`, moved to the position of the source.
    fn paint_moved(
        &mut self,
        simulator: &Simulator,
        view: &SceneView,
        source: &Source,
        centre: PixelPoint,
        exposure_s: f64,
        stamp: &mut Stamp,
    ) {
        let transmission = simulator.vignetting.transmission(source.position);
        let electrons = source.electrons_per_s * exposure_s * transmission;
        let resolve = |along: usize, body: &mut Vec<ImagePoint>| match (source.kind, &view.state.moon) {
            (ObjectKind::Target, _) => {
                let project = |point_m: &Vector3<f64>| view.state.project(point_m, &simulator.projection);
                view.state.appearance.image(&project, POINTS / along, body);
            }
            (ObjectKind::Moon, Some(moon)) => {
                let limit = MOON_POINTS / along;
                moon.image(view.state.camera_from_icrs, &simulator.projection, limit, body);
            }
            _ => body.push(ImagePoint { position: centre, share: 1.0 }),
        };
        if let Some(vibration) = &simulator.vibration {
            vibration.points(source.position, &simulator.projection, self.painter.blur_mut());
        }
        let detector = simulator.projection.detector();
        self.painter.paint(source, centre, electrons, resolve, detector, stamp);
    }

    /// Draws into `stamp` the image of a source under a rolling shutter, electrons: each row of the detector
    /// shows the source at the row's own time. `ends` are the scenes at the first and the last row.
    fn paint_row_by_row(
        &mut self,
        simulator: &Simulator,
        middle: &SceneView,
        ends: &[SceneView; 2],
        index: usize,
        exposure_s: f64,
        stamp: &mut Stamp,
    ) {
        let (_, rows) = simulator.projection.detector();
        let [first, last] = ends;
        let moving = MovingSource {
            first: &first.sources[index],
            middle: &middle.sources[index],
            last: &last.sources[index],
            rows,
        };
        let centre = middle.sources[index].position;
        let own_row = moving.own_row();
        let mut own = std::mem::take(&mut self.own);
        self.paint_moved(simulator, middle, &moving.at_row(own_row), centre, exposure_s, &mut own);
        // Rows from the centre to the farther end of the image.
        let span = own.window().map_or(0.0, |window| {
            let (top, bottom) = (window.y as f64, (window.y + window.rows) as f64 - 1.0);
            (own_row - top).abs().max((bottom - own_row).abs())
        });
        let [before, after] = [own_row - span, own_row + span].map(|row| moving.at_row(row));
        if before.position.distance(after.position) < STILL_PX {
            std::mem::swap(stamp, &mut own);
        } else {
            let mut others = std::mem::take(&mut self.others);
            self.paint_moved(simulator, middle, &before, centre, exposure_s, &mut others[0]);
            self.paint_moved(simulator, middle, &after, centre, exposure_s, &mut others[1]);
            stamp.interpolate_rows([&others[0], &own, &others[1]], own_row, span);
            self.others = others;
        }
        self.own = own;
    }
}

/// Source whose image moves during the readout of a rolling shutter.
struct MovingSource<'a> {
    /// At mid-exposure of the first row, of the middle and of the last row.
    first: &'a Source,
    middle: &'a Source,
    last: &'a Source,
    rows: usize,
}

impl MovingSource<'_> {
    /// Returns the source at mid-exposure of a row: positions follow the parabola through the three times.
    fn at_row(&self, row: f64) -> Source {
        let half = 0.5 * (self.rows as f64 - 1.0).max(1.0);
        // From −1 at the first row to 1 at the last.
        let t = (row / half - 1.0).clamp(-MAX_TIME, MAX_TIME);
        let [begin, end] =
            [0, 1].map(|end| parabola(self.first.ends[end], self.middle.ends[end], self.last.ends[end], t));
        let position = parabola(self.first.position, self.middle.position, self.last.position, t);
        Source { position, ends: [begin, end], ..*self.middle }
    }

    /// Returns the row in which the source is when that row is exposed. Iterates row → time → row; the image
    /// moves by much less than a row per row.
    fn own_row(&self) -> f64 {
        let mut row = self.middle.position.y;
        for _ in 0..ROW_STEPS {
            let next = self.at_row(row).position.y;
            if (next - row).abs() < 1e-9 {
                return next;
            }
            row = next;
        }
        row
    }
}

/// Returns the point at time `t` of the parabola through the points at −1, 0 and 1.
fn parabola(before: PixelPoint, middle: PixelPoint, after: PixelPoint, t: f64) -> PixelPoint {
    let along = |a: f64, b: f64, c: f64| b + t * 0.5 * (c - a) + t * t * (0.5 * (a + c) - b);
    PixelPoint::new(along(before.x, middle.x, after.x), along(before.y, middle.y, after.y))
}
