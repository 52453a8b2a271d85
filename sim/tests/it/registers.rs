//! Frames are the same bits on all registers of the machine.

use std::path::Path;

use boresight_sim::optics::simd_kernel::registers::same_on_all_registers;
use boresight_sim::{PixelSelection, Simulation, Simulator};

use crate::argon;

/// All bits of a frame, of its expected image, and of its truth and telemetry.
type Bits = (Vec<u16>, Vec<u64>, String);

/// Frames of the first, third and fifth day, drawn first only where the camera needs them and then
/// completely.
fn bits_of_frames(simulation: &Simulation) -> Vec<Bits> {
    let simulator = Simulator::new(simulation, Path::new("")).unwrap();
    let mut bits = Vec::new();
    for drawing in [PixelSelection::Needed, PixelSelection::All] {
        let mut camera = simulator.camera().unwrap().with_pixel_selection(drawing);
        for number in [300, 5000, 14_000] {
            let exposure = camera.expose(number).unwrap();
            let expected = camera.expected().iter().map(f64::to_bits).collect();
            // Debug prints enough digits to distinguish a number from its neighbours, and the sign of 0.
            let text = format!("{:?} {:?} {:?}", exposure.truth, exposure.telemetry, exposure.objects);
            bits.push((exposure.frame.dn().to_vec(), expected, text));
        }
    }
    bits
}

/// The fast path takes the steps of the slow path on wider registers.
#[test]
fn frames_are_the_same_bits_on_all_registers() {
    let argon = argon::simulation();
    for simulation in [Simulation { roi: None, ..argon.clone() }, argon] {
        same_on_all_registers(|| bits_of_frames(&simulation));
    }
}
