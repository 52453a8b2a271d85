//! Fast renderer of docking scenes: converts facets to linear radiance.
//!
//! Every facet is drawn with the exact area that it covers of every pixel (`coverage`), and parts are
//! composited from back to front. Facets within a part are disjoint: their radiance and coverage are added
//! before the part is composited over the image behind it, and neighbouring facets leave no seam. Reflection
//! is Lambertian: ρ (fill + E cos θ/π), where the term of the light source is reduced by the fraction of the
//! pixel that lies in the shadow (`shadow`) of other parts.

mod beam;
mod body;
mod bounds;
mod coverage;
mod lamp;
mod loops;
mod mask;
mod painting;
mod planes;
mod radiance_cache;
mod row_spans;
mod shadow;
mod silhouette;
mod view;

use contract::Camera;
use contract::docking::Pose;
use scene::docking::{DockingScene, Lighting};
use scene::shadow::Source;
use truth::SimError;

use self::body::Body;
use self::coverage::Coverage;
pub use self::mask::MaskPainter;
use self::painting::{Canvas, Painting};
use self::planes::PreparedScene;
pub use self::row_spans::{RowSpans, Span};
use self::shadow::Shadows;
use self::view::{Lens, View};

/// Mean radiance over each pixel of the camera (box filter, without point-spread function), row by row; units
/// of [`Lighting`].
#[derive(Debug, Clone, PartialEq, Default)]
pub struct RadianceImage {
    /// Number of columns of the camera.
    pub columns: usize,
    /// Number of rows of the camera.
    pub rows: usize,
    /// Radiance values, columns × rows.
    pub radiance: Vec<f32>,
}

/// Renderer of docking scenes for one camera.
///
/// Reuses its buffers from image to image, and keeps the outlines of shadow casters while scene and light
/// stay the same. For a given camera, the image depends only on the arguments of [`Drawer::draw`].
#[derive(Debug, Clone)]
pub struct Drawer {
    lens: Lens,
    columns: usize,
    rows: usize,
    prepared: PreparedScene,
    sun_shadows: Shadows,
    lamp_shadows: Shadows,
    coverage: Coverage,
    painting: Painting,
    body: Body,
}

impl Drawer {
    /// Creates a renderer for a camera.
    ///
    /// # Errors
    /// [`SimError`] if the camera's data are invalid.
    pub fn new(camera: &Camera) -> Result<Self, SimError> {
        Ok(Self {
            lens: Lens::new(camera)?,
            columns: camera.columns,
            rows: camera.rows,
            prepared: PreparedScene::default(),
            sun_shadows: Shadows::default(),
            lamp_shadows: Shadows::default(),
            coverage: Coverage::new(camera.columns, camera.rows),
            painting: Painting::default(),
            body: Body::default(),
        })
    }

    /// Draws the scene as seen from `pose` into `image`, which is resized to the camera's dimensions. After
    /// the first image of a scene, and while the Sun's direction stays unchanged, no memory is allocated.
    pub fn draw(
        &mut self,
        scene: &DockingScene,
        lighting: &Lighting,
        pose: &Pose,
        image: &mut RadianceImage,
    ) {
        image.columns = self.columns;
        image.rows = self.rows;
        image.radiance.clear();
        image.radiance.resize(self.columns * self.rows, lighting.sky_radiance as f32);
        if self.prepared.scene != *scene {
            self.prepared = PreparedScene::new(scene);
            self.sun_shadows.forget();
            self.lamp_shadows.forget();
        }
        if let Some(sun) = &lighting.sun {
            self.sun_shadows.update(&self.prepared, Source::Parallel(sun.towards));
        }
        if let Some(lamp) = &lighting.floodlight {
            self.lamp_shadows.update(&self.prepared, Source::Point(lamp.position_m));
        }
        let mut canvas = Canvas {
            view: View::new(&self.lens, pose),
            prepared: &self.prepared,
            coverage: &mut self.coverage,
            radiance: &mut image.radiance,
            columns: self.columns,
            body: &mut self.body,
            in_body: false,
        };
        let ready = &self.prepared.parts;
        for (index, (part, ready_part)) in self.prepared.scene.parts.iter().zip(ready).enumerate() {
            let goes_on = ready.get(index + 1).is_some_and(|next| next.joins_previous);
            canvas.in_body = goes_on || ready_part.joins_previous;
            if goes_on && !ready_part.joins_previous {
                canvas.body.begin(canvas.columns, canvas.radiance.len());
            }
            self.painting.outline(part, ready_part, &canvas);
            if let Some(sun) = &lighting.sun {
                self.painting.prepare_shadows(sun, &mut self.sun_shadows, &canvas);
            }
            self.painting.paint_part(part, lighting, &mut canvas);
            self.painting.shade(part, lighting, &mut self.sun_shadows, &mut canvas);
            if let Some(lamp) = &lighting.floodlight {
                self.painting.illuminate(part, lamp, &mut self.lamp_shadows, &mut canvas);
            }
        }
    }
}
