//! Who draws a docking scene: the fast renderer, or Mitsuba, its judge.

use contract::docking::DockingSetup;
use serde::{Deserialize, Serialize};
use sim::docking::{DockingSimulator, DockingWorkspace, FieldExposure};

use crate::failure::Failure;
use crate::mitsuba::{MitsubaOptions, MitsubaRenderer, VARIANT, VERSION};

/// What draws the light that falls on the detector. The television chain after it is the same, draw by draw.
#[derive(Debug, Default)]
pub enum DockingRenderer {
    /// The fast renderer ([`sim::vector`]).
    #[default]
    Fast,
    /// Mitsuba 3, an image at a time.
    Mitsuba(Box<MitsubaImages>),
}

/// Mitsuba, and how its images are made.
#[derive(Debug)]
pub struct MitsubaImages {
    renderer: MitsubaRenderer,
    settings: MitsubaRecord,
}

/// What images by Mitsuba depend on besides the scenario: the table `[mitsuba]` of `run.toml`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MitsubaRecord {
    /// Its version.
    pub version: String,
    /// Its variant.
    pub variant: String,
    /// Rays a pixel.
    pub rays_per_px: u32,
}

impl DockingRenderer {
    /// Mitsuba with these options; it is not looked for yet.
    ///
    /// # Errors
    /// A [`Failure`] for options outside their ranges, and a cache that cannot be made.
    pub fn mitsuba(options: MitsubaOptions) -> Result<Self, Failure> {
        let settings = MitsubaRecord {
            version: VERSION.to_owned(),
            variant: VARIANT.to_owned(),
            rays_per_px: options.settings.samples,
        };
        let renderer = MitsubaRenderer::new(options)?;
        Ok(Self::Mitsuba(Box::new(MitsubaImages { renderer, settings })))
    }

    /// The word used on the command line and in `score.json`.
    pub fn code(&self) -> &'static str {
        match self {
            Self::Fast => "fast",
            Self::Mitsuba(_) => "mitsuba",
        }
    }

    /// What images depend on besides the scenario; `None` for the fast renderer.
    pub fn record(&self) -> Option<&MitsubaRecord> {
        match self {
            Self::Fast => None,
            Self::Mitsuba(images) => Some(&images.settings),
        }
    }

    /// Draws a field and makes its video signal; `setup` is that of the simulator.
    ///
    /// # Errors
    /// A [`Failure`] when there is no such field, or Mitsuba gives no image.
    pub fn expose(
        &self,
        simulator: &DockingSimulator,
        setup: &DockingSetup,
        workspace: &mut DockingWorkspace,
        field: u64,
    ) -> Result<FieldExposure, Failure> {
        let Self::Mitsuba(images) = self else { return Ok(simulator.expose(workspace, field)?) };
        let moment = simulator.moment(field)?;
        let (lighting, pose) = (&moment.lighting, &moment.state.pose);
        let camera = &setup.cameras[moment.camera];
        let image = images.renderer.radiance(simulator.scene(), lighting, pose, camera)?;
        Ok(simulator.expose_image(workspace, field, &image)?)
    }
}
