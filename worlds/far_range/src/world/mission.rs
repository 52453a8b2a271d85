//! A far-range scenario that is ready to run.

use std::convert::Infallible;
use std::path::Path;
use std::sync::Arc;

use contract::{ListedStar, Setup, bounds};
use files::{Failure, ImageFormat, RunDirectory};
use hifitime::Epoch;
use run::any_world::ScenarioSource;
use scenario::run_file::RunFile;
use scenario::{AttitudeChoice, Stage};
use sim::Simulator;
use sim::catalog::{CatalogConfig, CatalogSource};
use sim::memo::Memo;
use sim::truth::{FrameTruth, ObjectTruth};

use super::dataset::frame_header;
use super::star_list::star_list;
use crate::rows::StarRow;
use crate::scenario::FarRangeScenario;

/// A far-range scenario with its simulator and star list, ready to run.
pub struct FarRangeMission {
    pub(super) simulator: Simulator,
    pub(super) run_file: RunFile<FarRangeScenario>,
    pub(super) setup: Setup,
    pub(super) stars: Vec<StarRow>,
    pub(super) star_epoch: Epoch,
}

/// Ground truth of a frame.
#[derive(Debug, Clone)]
pub struct SceneTruth {
    /// Truth of the frame as a whole.
    pub frame: FrameTruth,
    /// All objects in the frame.
    pub objects: Vec<ObjectTruth>,
}

impl FarRangeMission {
    /// Checks a scenario and prepares its simulator.
    ///
    /// # Errors
    /// A [`Failure`] with the location of the first invalid value.
    pub fn new(source: &ScenarioSource) -> Result<Self, Failure> {
        Self::with_options(source, None, None)
    }

    /// Prepares a scenario as [`FarRangeMission::new`], for a run of the built-in pipeline with one stage's
    /// result replaced by the truth, or with an attitude granted to measurements that have only a centroid.
    ///
    /// # Errors
    /// Those of [`FarRangeMission::new`]; [`Failure::Usage`] for the replacement of regions of interest in a
    /// scenario that has none.
    pub fn with_options(
        source: &ScenarioSource,
        inject: Option<Stage>,
        attitude: Option<AttitudeChoice>,
    ) -> Result<Self, Failure> {
        let mut scenario = source.typed::<FarRangeScenario>("far range")?.clone();
        scenario.score.attitude = attitude.or(scenario.score.attitude);
        if inject == Some(Stage::Roi) && scenario.roi.take().is_none() {
            return Err(Failure::Usage(format!(
                "--inject roi requires a scenario with regions of interest: `{}` has no [roi]",
                source.name
            )));
        }
        let simulator = simulator(source, &scenario)?;
        let run_file = RunFile::new(
            &source.name,
            &scenario,
            source.files()?,
            Some(simulator.catalog().sha256()),
            inject,
        )?;
        let (_, star_epoch) = simulator
            .schedule()
            .frame(0)
            .ok_or_else(|| Failure::Usage(format!("scenario `{}` has no frames", source.name)))?;
        let (stars, listed) = &*uploaded(&scenario, &simulator, star_epoch);
        let setup = setup(&run_file.scenario, listed.clone());
        Ok(Self { simulator, run_file, setup, stars: stars.clone(), star_epoch })
    }

    /// Returns the simulator of the frames.
    pub fn simulator(&self) -> &Simulator {
        &self.simulator
    }

    /// Returns the header of a frame's FITS file as text, with world coordinates; `None` if no SIP polynomial
    /// follows the distortion of the camera.
    ///
    /// # Errors
    /// A [`Failure`] for a frame that cannot be exposed.
    pub fn fits_header(&self, frame: u64) -> Result<Option<String>, Failure> {
        let exposure = self.simulator.camera()?.expose(frame)?;
        let header = frame_header(&self.simulator, &self.run_file, &exposure, true)?;
        if header.wcs.is_none() {
            return Ok(None);
        }
        let name = RunDirectory::frame_name(frame, ImageFormat::Fits);
        Ok(Some(files::fits_header(Path::new(&name), &exposure.frame, &header)?))
    }
}

/// Creates the simulator of a scenario that was read from `source`; every value is checked.
///
/// # Errors
/// A [`Failure`] with the location of the first invalid value.
pub fn simulator(source: &ScenarioSource, scenario: &FarRangeScenario) -> Result<Simulator, Failure> {
    bounds::check(&scenario.star_list, "star_list").map_err(|error| source.out_of_range(&error))?;
    source.check_part("far_range", scenario.far_range.check())?;
    scenario.score.check().map_err(|error| source.out_of_range(&error))?;
    scenario.check_orbit().map_err(|error| source.out_of_range(&error))?;
    let simulation = scenario.simulation().map_err(|failure| match failure {
        Failure::Contract(error) => source.explain(error.into()),
        failure => failure,
    })?;
    Simulator::new(&simulation, &source.folder).map_err(|error| source.explain(error))
}

/// A star list in the form of its file, and in the form passed to a pipeline.
type StarListPair = (Vec<StarRow>, Vec<ListedStar>);

/// Star lists of embedded catalogues, by magnitude limit and epoch.
static UPLOADED: Memo<(CatalogConfig, f64, Epoch), StarListPair> = Memo::new();

fn uploaded(scenario: &FarRangeScenario, simulator: &Simulator, epoch: Epoch) -> Arc<StarListPair> {
    let limit = scenario.star_list.magnitude_limit;
    let list = || {
        let stars = star_list(simulator.catalog(), limit, epoch);
        let listed = stars.iter().map(StarRow::to_listed_star).collect();
        (stars, listed)
    };
    match scenario.catalog.source {
        CatalogSource::Hipparcos2 => {
            let key = (scenario.catalog.clone(), limit, epoch);
            let Ok(shared) = UPLOADED.get(key, |_| Ok::<_, Infallible>(list()));
            shared
        }
        // Not cached, because the file may have changed.
        CatalogSource::File(_) => Arc::new(list()),
    }
}

fn setup(scenario: &FarRangeScenario, stars: Vec<ListedStar>) -> Setup {
    Setup {
        camera: scenario.camera.clone(),
        camera_from_body: scenario.mounting.nominal.camera_from_body(),
        bit_depth: scenario.sensor.bit_depth,
        readout: Some(scenario.readout()),
        calibration: scenario.calibration(),
        zero_suppression_dn: scenario.zero_suppression_dn,
        stars,
    }
}
