//! Expected image of a scene: background and sources, on the pixels of the detector.

use nalgebra::Vector3;
use optics::{ImagePoint, Psf, Stamp};
use render::draw::ExpectedImage;
use render::painter::Painter;
use truth::ObjectKind;

use crate::Simulator;
use crate::scene_view::{FrameViews, SceneView};

/// Maximum number of points in the image of a source: those of its body multiplied by those of its trail.
const POINTS: usize = 1 << 18;
/// Maximum number of points in the image of the Moon: a disk of 1150 px has a point in every pixel.
pub(crate) const MOON_POINTS: usize = 1 << 20;

/// Painter of scenes, with the buffers that frames reuse.
#[derive(Debug)]
pub(crate) struct ScenePainter {
    painter: Painter,
    /// Background of an interlaced scene, electrons per second, pixel by pixel: of the first field, and of
    /// the second.
    backgrounds: [Vec<f64>; 2],
    /// Image of an object in the scene of the first and of the second field.
    halves: [Stamp; 2],
}

impl ScenePainter {
    pub(crate) fn new(psf: Psf) -> Self {
        Self {
            painter: Painter::new(psf),
            backgrounds: [Vec::new(), Vec::new()],
            halves: [Stamp::new(), Stamp::new()],
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
            FrameViews::Single => {
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
        let Self { painter, halves: [of_first, of_second], .. } = self;
        for index in 0..middle.sources.len() {
            let image_of_source = image.add_painted(|stamp| match drawn {
                FrameViews::Single => paint_source(painter, simulator, middle, index, exposure_s, stamp),
                FrameViews::Fields(interlace, fields) => {
                    let [first, second] = &**fields;
                    paint_source(painter, simulator, first, index, exposure_s, of_first);
                    paint_source(painter, simulator, second, index, exposure_s, of_second);
                    stamp.weave(of_first, of_second, |row| interlace.is_first(row));
                }
            });
            middle.sources[index].position = image_of_source.centre();
        }
    }
}

/// Draws into `stamp` the image of a source of a scene, electrons.
fn paint_source(
    painter: &mut Painter,
    simulator: &Simulator,
    view: &SceneView,
    index: usize,
    exposure_s: f64,
    stamp: &mut Stamp,
) {
    let source = &view.sources[index];
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
        _ => body.push(ImagePoint { position: source.position, share: 1.0 }),
    };
    painter.paint(source, electrons, resolve, simulator.projection.detector(), stamp);
}
