//! The fast renderer of docking scenes: facets in, linear radiance out.
//!
//! Every facet is drawn by the exact area that it covers of every pixel (`coverage`), and parts are laid over each other from
//! the back. Within a part facets are disjoint, so that their light and their coverage add up before the part is laid over
//! what lies behind: neighbours leave no seam. Light is Lambert's: ρ (fill + E cos θ/π), where the light's part is weakened
//! by the share of the pixel that lies in the shadow (`shadow`) of other parts.

mod beam;
mod body;
mod bounds;
mod clip;
mod coverage;
mod lamp;
mod loops;
mod painting;
mod planes;
mod radiance_cache;
mod shadow;
mod silhouette;
mod source;
mod view;

use contract::Camera;
use contract::docking::Pose;

use self::body::Body;
use self::coverage::Coverage;
use self::painting::{Canvas, Painting};
use self::planes::PreparedScene;
use self::shadow::Shadows;
use self::source::Source;
use self::view::{Lens, View};
use crate::SimError;
use crate::scene::docking::{DockingScene, Lighting};

/// Mean radiance over each pixel of the camera (box filter, no point spread), row by row; units of [`Lighting`].
#[derive(Debug, Clone, PartialEq, Default)]
pub struct RadianceImage {
    /// Columns of the camera.
    pub columns: usize,
    /// Rows of the camera.
    pub rows: usize,
    /// columns × rows values.
    pub radiance: Vec<f32>,
}

/// Draws docking scenes as one camera sees them.
///
/// It keeps its buffers from image to image, and the outlines of what casts shadows as long as scene and light stay the same.
/// What it draws depends on nothing but the arguments of [`Drawer::draw`].
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
    /// For a camera.
    ///
    /// # Errors
    /// [`SimError`] when the camera's data are not allowed.
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

    /// Draws the scene as seen from `pose` into `image`, which is made the camera's size. From the first image of a scene
    /// on, with the Sun in its place, nothing is allocated.
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
