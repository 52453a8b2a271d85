//! The one interface that outsiders implement.

use crate::{
    Body, Camera, CameraFrame, ContractError, Frame, ListedStar, Outcome, Readout, Rotation, Telemetry,
};

/// An image-processing pipeline under test.
///
/// Built fresh for each sequence of frames, and given them in order; it may remember what it likes in between.
/// Frames may be missing. It must answer every frame, and what it answers must hold no NaN: see
/// [`crate::conformance`].
pub trait Pipeline: Send {
    /// Answers one frame.
    fn process(&mut self, frame: &Frame, telemetry: &Telemetry) -> Outcome;
}

/// What a pipeline knows before the first frame.
#[derive(Debug, Clone, PartialEq)]
pub struct Setup {
    /// Nominal camera.
    pub camera: Camera,
    /// Nominal mounting of the camera, as calibrated on ground.
    pub camera_from_body: Rotation<CameraFrame, Body>,
    /// Bits of the analogue-digital converter.
    pub bit_depth: u8,
    /// Gain, bias, read noise and saturation as calibrated; `None` when they are not known.
    pub readout: Option<Readout>,
    /// Pixels up to this digital number arrive as 0, whatever they were; `None`: every pixel arrives as it was.
    pub zero_suppression_dn: Option<u16>,
    /// The uploaded star list, ordered by `id`.
    pub stars: Vec<ListedStar>,
}

/// Builds pipelines, one a sequence.
pub trait PipelineFactory: Sync {
    /// Name, for tables and logs.
    fn name(&self) -> String;

    /// A fresh pipeline that has seen no frame.
    ///
    /// # Errors
    /// [`ContractError::CannotBuild`] when the setup or the pipeline's own configuration does not allow it.
    fn build(&self, setup: &Setup) -> Result<Box<dyn Pipeline>, ContractError>;
}
