//! Inputs and outputs of a far-range pipeline.

use crate::{
    Body, Calibration, Camera, CameraFrame, Frame, Interface, ListedStar, NoSolution, Outcome, Readout,
    Rotation, Solution, Telemetry,
};

/// Interface of far-range pipelines: star fields with a distant spacecraft.
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
        Outcome::without_solution(NoSolution::Failed(reason))
    }

    fn failure(outcome: &Outcome) -> Option<&str> {
        match &outcome.solution {
            Solution::NoSolution(NoSolution::Failed(reason)) => Some(reason),
            _ => None,
        }
    }
}

/// Data that a far-range pipeline receives before the first frame.
#[derive(Debug, Clone, PartialEq)]
pub struct Setup {
    /// Nominal camera.
    pub camera: Camera,
    /// Nominal mounting of the camera, as calibrated on the ground.
    pub camera_from_body: Rotation<CameraFrame, Body>,
    /// Bit depth of the analogue-digital converter.
    pub bit_depth: u8,
    /// Calibrated gain, bias, read noise and saturation; `None` if unknown.
    pub readout: Option<Readout>,
    /// Calibrated point-spread function, detector, brightness scale and attitude knowledge.
    pub calibration: Calibration,
    /// Threshold of the zero suppression, DN: pixels up to this value are transmitted as 0; `None` if every
    /// pixel is transmitted unchanged.
    pub zero_suppression_dn: Option<u16>,
    /// Uploaded star list, ordered by `id`.
    pub stars: Vec<ListedStar>,
}
