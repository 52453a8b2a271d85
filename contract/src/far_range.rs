//! What a far-range pipeline receives and answers.

use crate::{
    Body, Calibration, Camera, CameraFrame, Frame, Interface, ListedStar, NoSolution, Outcome, Readout,
    Rotation, Solution, Telemetry,
};

/// The interface of far-range pipelines: star fields with a distant spacecraft.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FarRange;

impl Interface for FarRange {
    type Setup = Setup;
    type Image = Frame;
    type Telemetry = Telemetry;
    type Outcome = Outcome;

    const IMAGE: &'static str = "frame";

    fn number(frame: &Frame) -> u64 {
        frame.number()
    }

    fn failed(reason: String) -> Outcome {
        Outcome::none(NoSolution::Failed(reason))
    }

    fn failure(outcome: &Outcome) -> Option<&str> {
        match &outcome.solution {
            Solution::NoSolution(NoSolution::Failed(reason)) => Some(reason),
            _ => None,
        }
    }
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
    /// Point-spread function, detector, brightness scale and attitude knowledge as calibrated.
    pub calibration: Calibration,
    /// Pixels up to this digital number arrive as 0, whatever they were; `None`: every pixel arrives as it was.
    pub zero_suppression_dn: Option<u16>,
    /// The uploaded star list, ordered by `id`.
    pub stars: Vec<ListedStar>,
}
