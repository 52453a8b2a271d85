//! Worlds whose frames and answers are Python values.

use std::any::Any;
use std::ops::Range;

use arrow_array::RecordBatch;
use boresight::docking::DockingMission;
use boresight::docking::rows::FieldTruthRow;
use boresight::failure::Failure;
use boresight::far_range::rows::{FrameTruthRow, ObjectTruthRow};
use boresight::far_range::{FarRangeMission, SceneTruth};
use boresight::files::Row;
use boresight::frame_jobs::process_in_order;
use boresight::run::world::{ImageOf, TelemetryOf};
use boresight::run::{AnyFactory, AnyMission, AnyWorld, World, WorldFrames};
use contract::docking::{Docking, Field, FieldTelemetry as DockingTelemetry};
use contract::{FarRange, PipelineFactory};
use pipeline::external::Protocol;
use pyo3::prelude::*;
use sim::docking::FieldTruth;

use crate::arrow::batch;
use crate::frame::{FieldTelemetry, Frame, Telemetry};

/// Entries of all worlds, one line each.
fn world_entries<P: PythonFactory>() -> [WorldEntry<P>; 2] {
    [WorldEntry::for_world::<FarRangeMission>(), WorldEntry::for_world::<DockingMission>()]
}

/// Mission of a world, or the unchanged input if it is a mission of another world.
type DowncastMission = Result<Box<dyn AnyPythonWorld>, Box<dyn Any>>;
/// Rows and columns of a frame, and its electrons row by row.
type ExpectedFrame = Result<([usize; 2], Vec<f64>), Failure>;
/// FITS header as text; `None` if no SIP polynomial follows the distortion of the camera.
type FitsHeader = Result<Option<String>, Failure>;

/// World: its code, the conversion of its mission, and the factory of a callable pipeline.
struct WorldEntry<P> {
    code: &'static str,
    take: fn(Box<dyn Any>) -> DowncastMission,
    factory: fn(P) -> AnyFactory,
}

impl<P: PythonFactory> WorldEntry<P> {
    fn for_world<W: PythonWorld>() -> Self {
        Self {
            code: W::CODE,
            take: |prepared| prepared.downcast::<W>().map(|prepared| prepared as Box<dyn AnyPythonWorld>),
            factory: |pipeline| {
                let factory: Box<dyn PipelineFactory<W::Interface> + Send> = pipeline.into_factory();
                AnyFactory::new(factory)
            },
        }
    }
}

/// Returns the object that makes the frames of a scenario.
///
/// # Errors
/// [`Failure::Usage`] if the frames belong to a world without a class in Python.
pub(crate) fn prepare_for_python(
    world: &dyn AnyWorld,
    prepared: Box<dyn AnyMission>,
) -> Result<Box<dyn AnyPythonWorld>, Failure> {
    let mut prepared: Box<dyn Any> = prepared;
    for entry in world_entries::<NoCallable>() {
        match (entry.take)(prepared) {
            Ok(taken) => return Ok(taken),
            Err(other) => prepared = other,
        }
    }
    Err(Failure::Usage(format!("frames of the world {} have no Python class", world.code())))
}

/// Returns the factory of a callable pipeline for a world.
///
/// # Errors
/// [`Failure::Usage`] if the frames of the world have no class in Python.
pub(crate) fn factory<P: PythonFactory>(world: &dyn AnyWorld, pipeline: P) -> Result<AnyFactory, Failure> {
    match world_entries::<P>().into_iter().find(|entry| entry.code == world.code()) {
        Some(entry) => Ok((entry.factory)(pipeline)),
        None => {
            Err(Failure::Usage(format!("the world {} does not support callables as pipelines", world.code())))
        }
    }
}

/// Callable that can be the pipeline of any world.
pub(crate) trait PythonFactory {
    /// Converts the callable to a factory for the interface `I`.
    fn into_factory<I: PythonInterface>(self) -> Box<dyn PipelineFactory<I> + Send>;
}

/// Empty type for entries without a callable.
enum NoCallable {}

impl PythonFactory for NoCallable {
    fn into_factory<I: PythonInterface>(self) -> Box<dyn PipelineFactory<I> + Send> {
        match self {}
    }
}

/// Interface whose images and telemetry are Python values.
pub(crate) trait PythonInterface: Protocol {
    /// Converts an image to a Python object.
    fn frame(py: Python<'_>, image: Self::Image) -> PyResult<Frame>;

    /// Converts the telemetry to a Python object.
    fn telemetry(py: Python<'_>, telemetry: &Self::Telemetry) -> PyResult<Py<PyAny>>;
}

impl PythonInterface for FarRange {
    fn frame(py: Python<'_>, frame: contract::Frame) -> PyResult<Frame> {
        Frame::from_contract(py, frame)
    }

    fn telemetry(py: Python<'_>, telemetry: &contract::Telemetry) -> PyResult<Py<PyAny>> {
        Ok(Py::new(py, Telemetry::from_contract(telemetry))?.into_any())
    }
}

impl PythonInterface for Docking {
    fn frame(py: Python<'_>, field: Field) -> PyResult<Frame> {
        Frame::from_field(py, field)
    }

    fn telemetry(py: Python<'_>, telemetry: &DockingTelemetry) -> PyResult<Py<PyAny>> {
        Ok(Py::new(py, FieldTelemetry::from_contract(telemetry))?.into_any())
    }
}

/// World whose frames are Python values.
pub(crate) trait PythonWorld: World<Interface: PythonInterface, Truth: Send> {
    /// Truth of a frame, one row, and truth of its objects if the world records objects.
    fn tables(truth: Self::Truth) -> PyResult<(RecordBatch, Option<RecordBatch>)>;

    /// Frame without noise if the world provides it: its rows and columns, and its electrons row by row.
    fn expected(&self, _frame: u64) -> Option<ExpectedFrame> {
        None
    }

    /// Header of the frame's FITS file, if the world has FITS files with world coordinates.
    fn fits_header(&self, _frame: u64) -> Option<FitsHeader> {
        None
    }
}

impl PythonWorld for FarRangeMission {
    fn tables(truth: SceneTruth) -> PyResult<(RecordBatch, Option<RecordBatch>)> {
        let objects = batch(ObjectTruthRow::columns(
            &truth.objects.into_iter().map(ObjectTruthRow).collect::<Vec<_>>(),
        ))?;
        Ok((batch(FrameTruthRow::columns(&[FrameTruthRow(truth.frame)]))?, Some(objects)))
    }

    fn expected(&self, frame: u64) -> Option<ExpectedFrame> {
        let make = || {
            let mut camera = self.simulator().camera()?;
            camera.expose(frame)?;
            let image = camera.expected();
            let (columns, rows) = image.size();
            Ok(([rows, columns], image.iter().collect()))
        };
        Some(make().map_err(|error: sim::SimError| error.into()))
    }

    fn fits_header(&self, frame: u64) -> Option<FitsHeader> {
        Some(Self::fits_header(self, frame))
    }
}

impl PythonWorld for DockingMission {
    fn tables(truth: FieldTruth) -> PyResult<(RecordBatch, Option<RecordBatch>)> {
        Ok((batch(FieldTruthRow::columns(&[FieldTruthRow::from(&truth)]))?, None))
    }
}

/// Finished frame that is not yet converted to a Python value.
pub(crate) type PendingFrame = Box<dyn FnOnce(Python<'_>) -> PyResult<FrameParts> + Send>;

/// Components of a frame of a scenario.
pub(crate) struct FrameParts {
    pub(crate) frame: Frame,
    pub(crate) telemetry: Py<PyAny>,
    pub(crate) truth: RecordBatch,
    pub(crate) objects: Option<RecordBatch>,
}

/// Type-erased [`PythonWorld`].
pub(crate) trait AnyPythonWorld: AnyMission {
    /// Greeting that a program receives before the first frame, a line of JSON.
    fn greeting(&self) -> Result<Vec<u8>, String>;

    /// Makes frames on threads and passes them on in order.
    fn make(
        &self,
        frames: Range<u64>,
        jobs: usize,
        take: &mut dyn FnMut(PendingFrame) -> Result<(), Failure>,
    ) -> Result<(), Failure>;

    /// See [`PythonWorld::expected`].
    fn expected(&self, frame: u64) -> Option<ExpectedFrame>;

    /// See [`PythonWorld::fits_header`].
    fn fits_header(&self, frame: u64) -> Option<FitsHeader>;
}

impl<W: PythonWorld> AnyPythonWorld for W
where
    ImageOf<W>: Send,
    TelemetryOf<W>: Send,
{
    fn greeting(&self) -> Result<Vec<u8>, String> {
        W::Interface::greeting(self.setup())
    }

    fn make(
        &self,
        frames: Range<u64>,
        jobs: usize,
        take: &mut dyn FnMut(PendingFrame) -> Result<(), Failure>,
    ) -> Result<(), Failure> {
        let state = W::State::default();
        let expose =
            |workspace: &mut W::Workspace<'_>, frame| WorldFrames::expose(self, workspace, frame, &state);
        let bytes = self.exposure_bytes() as u64;
        process_in_order(
            frames,
            jobs,
            bytes,
            || self.workspace(),
            expose,
            |exposure| {
                let (image, telemetry, truth) = W::receive(exposure, &state);
                take(Box::new(move |py| {
                    let (truth, objects) = W::tables(truth)?;
                    let telemetry = W::Interface::telemetry(py, &telemetry)?;
                    Ok(FrameParts { frame: W::Interface::frame(py, image)?, telemetry, truth, objects })
                }))
            },
        )
    }

    fn expected(&self, frame: u64) -> Option<ExpectedFrame> {
        PythonWorld::expected(self, frame)
    }

    fn fits_header(&self, frame: u64) -> Option<FitsHeader> {
        PythonWorld::fits_header(self, frame)
    }
}
