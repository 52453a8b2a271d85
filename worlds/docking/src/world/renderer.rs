//! Renderer of a docking scene: the fast renderer, or Mitsuba, its reference.
use std::any::Any;

use contract::docking::DockingSetup;
use files::Failure;
#[cfg(feature = "mitsuba")]
use mitsuba::{MitsubaOptions, MitsubaRenderer, VARIANT, VERSION};
use run::RendererChoice;
use scenario::run_file::MitsubaRecord;
use sim::docking::{DockingSimulator, DockingWorkspace, FieldExposure};

/// Renderer of the radiance at the detector. The television chain after it is the same, including every
/// random draw.
#[derive(Debug, Default)]
pub enum DockingRenderer {
    /// The fast renderer ([`sim::vector`]).
    #[default]
    Fast,
    /// Mitsuba 3, one image at a time.
    #[cfg(feature = "mitsuba")]
    Mitsuba(Box<MitsubaImages>),
}

/// Mitsuba with its settings.
#[cfg(feature = "mitsuba")]
#[derive(Debug)]
pub struct MitsubaImages {
    renderer: MitsubaRenderer,
    settings: MitsubaRecord,
}

impl DockingRenderer {
    /// Creates the chosen renderer.
    ///
    /// # Errors
    /// Those of [`DockingRenderer::mitsuba`].
    pub fn new(choice: RendererChoice) -> Result<Self, Failure> {
        match choice {
            RendererChoice::BuiltIn => Ok(Self::Fast),
            RendererChoice::Other { word, options } => Self::other(word, options),
        }
    }

    /// Creates the renderer with this name and options of its type.
    fn other(word: &str, options: Box<dyn Any + Send>) -> Result<Self, Failure> {
        #[cfg(feature = "mitsuba")]
        let options = match options.downcast::<MitsubaOptions>() {
            Ok(options) => return Self::mitsuba(*options),
            Err(options) => options,
        };
        drop(options);
        Err(Failure::Usage(format!("--renderer {word} cannot draw docking scenes")))
    }

    /// Creates a Mitsuba renderer with these options; Mitsuba is not searched for yet.
    ///
    /// # Errors
    /// A [`Failure`] for options outside their ranges, or a cache that cannot be created.
    #[cfg(feature = "mitsuba")]
    pub fn mitsuba(options: MitsubaOptions) -> Result<Self, Failure> {
        let settings = MitsubaRecord {
            version: VERSION.to_owned(),
            variant: VARIANT.to_owned(),
            rays_per_px: options.settings.samples,
        };
        let renderer = MitsubaRenderer::new(options)?;
        Ok(Self::Mitsuba(Box::new(MitsubaImages { renderer, settings })))
    }

    /// Returns the name on the command line and in `score.json`.
    pub fn code(&self) -> &'static str {
        match self {
            Self::Fast => "fast",
            #[cfg(feature = "mitsuba")]
            Self::Mitsuba(_) => "mitsuba",
        }
    }

    /// Returns the settings, besides the scenario, that the images depend on; `None` for the fast renderer.
    pub fn record(&self) -> Option<&MitsubaRecord> {
        match self {
            Self::Fast => None,
            #[cfg(feature = "mitsuba")]
            Self::Mitsuba(images) => Some(&images.settings),
        }
    }

    /// Draws a field and returns its video signal; `setup` is that of the simulator.
    ///
    /// # Errors
    /// A [`Failure`] when the field does not exist, or Mitsuba provides no image.
    #[allow(clippy::indexing_slicing, reason = "the simulator names a camera of its own setup")]
    #[cfg_attr(not(feature = "mitsuba"), expect(unused_variables, reason = "only Mitsuba needs the setup"))]
    pub fn expose(
        &self,
        simulator: &DockingSimulator,
        setup: &DockingSetup,
        workspace: &mut DockingWorkspace,
        field: u64,
    ) -> Result<FieldExposure, Failure> {
        match self {
            Self::Fast => Ok(simulator.expose(workspace, field)?),
            #[cfg(feature = "mitsuba")]
            Self::Mitsuba(images) => {
                let moment = simulator.field_state(field)?;
                let (lighting, pose) = (&moment.lighting, &moment.state.pose);
                let camera = &setup.cameras[moment.camera];
                let image = images.renderer.radiance(simulator.scene(), lighting, pose, camera)?;
                Ok(simulator.expose_image(workspace, field, &image)?)
            }
        }
    }
}
