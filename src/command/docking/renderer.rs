//! Option `--renderer` of docking scenarios.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use files::Failure;
use run::RendererChoice;

use crate::command::options::Selection;

/// Renderer of a docking scene.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, ValueEnum)]
pub(in crate::command) enum RendererName {
    /// The fast renderer
    #[default]
    Fast,
    /// Mitsuba 3.9.1, the reference for the fast renderer; seconds to minutes per field
    Mitsuba,
}

/// Renderer of a docking scene, and location of Mitsuba.
#[derive(Debug, Default, Args)]
#[command(next_help_heading = "Docking images")]
pub(in crate::command) struct RendererOptions {
    /// Renderer of a docking scenario
    #[arg(long, value_name = "RENDERER", value_enum, default_value_t)]
    renderer: RendererName,
    /// Command of Mitsuba, split as by a shell; default: BORESIGHT_MITSUBA, or `mitsuba`, or `uvx`
    #[arg(long, value_name = "COMMAND")]
    mitsuba: Option<String>,
    /// Folder for Mitsuba's images; default: `boresight/mitsuba` in the user's cache
    #[arg(long, value_name = "DIR")]
    mitsuba_cache: Option<PathBuf>,
    /// Rays of Mitsuba per pixel, a square number up to 4096; default: 256
    #[arg(long, value_name = "N")]
    mitsuba_rays: Option<u32>,
}

impl RendererOptions {
    fn check_fast(&self) -> Result<(), Failure> {
        let given = [
            ("--mitsuba", self.mitsuba.is_some()),
            ("--mitsuba-cache", self.mitsuba_cache.is_some()),
            ("--mitsuba-rays", self.mitsuba_rays.is_some()),
        ];
        match given.iter().find(|(_, is_given)| *is_given) {
            Some((option, _)) => Err(Failure::Usage(format!("{option} applies only to --renderer mitsuba"))),
            None => Ok(()),
        }
    }

    /// Returns the requested renderer.
    pub(in crate::command) fn renderer(&self) -> Result<RendererChoice, Failure> {
        if self.renderer == RendererName::Fast {
            self.check_fast()?;
            return Ok(RendererChoice::BuiltIn);
        }
        self.mitsuba_renderer()
    }

    #[cfg(feature = "mitsuba")]
    fn mitsuba_renderer(&self) -> Result<RendererChoice, Failure> {
        let mut options = mitsuba::MitsubaOptions {
            command: self.mitsuba.clone(),
            cache: self.mitsuba_cache.clone(),
            ..mitsuba::MitsubaOptions::default()
        };
        options.settings.samples = self.mitsuba_rays.unwrap_or(options.settings.samples);
        Ok(RendererChoice::Other { word: "mitsuba", options: Box::new(options) })
    }

    #[cfg(not(feature = "mitsuba"))]
    fn mitsuba_renderer(&self) -> Result<RendererChoice, Failure> {
        Err(crate::command::missing_feature("mitsuba"))
    }

    /// Returns the number of threads: one if each image uses several threads.
    pub(in crate::command) fn jobs(&self, selection: &Selection) -> usize {
        match (self.renderer, selection.jobs) {
            (RendererName::Mitsuba, None) => 1,
            _ => selection.jobs(),
        }
    }
}
