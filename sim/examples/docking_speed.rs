//! What a field of the scenario `docking` costs, by range: drawing, and the television chain with every artefact. It
//! counts the time of the processor, not of the clock: what else runs on the machine is not in it. Linux only.
//!
//! `cargo run --release -p boresight-sim --example docking_speed`
#![allow(clippy::unwrap_used, reason = "it fails by panicking, as a test does")]

use std::path::Path;

use boresight_sim::docking::{DockingSimulation, DockingSimulator};
use boresight_sim::vector::{Drawer, RadianceImage};

const FIELDS: u64 = 40;

/// What this thread has had of a processor, ms.
fn processor_ms() -> f64 {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap();
    text.split_whitespace().next().unwrap().parse::<f64>().unwrap() / 1e6
}

fn main() {
    let text = include_str!("../../scenarios/docking.toml");
    let mut scenario: toml::Table = toml::from_str(text).unwrap();
    // What says how the simulation is run, not what is simulated.
    for key in ["world", "title", "docking"] {
        scenario.remove(key);
    }
    let simulation: DockingSimulation = scenario.try_into().unwrap();
    let simulator = DockingSimulator::new(&simulation, Path::new(".")).unwrap();
    let mut workspace = simulator.workspace().unwrap();
    println!("range m  camera  draw ms  television ms");
    for range_m in [500.0, 200.0, 50.0, 20.0, 10.0, 5.0, 3.0, 2.0, 1.0] {
        let nearer = |field: &u64| simulator.moment(*field).unwrap().state.range_m() <= range_m;
        let first = (0..simulator.field_count() - FIELDS).find(nearer).unwrap_or(0);
        let camera = simulator.moment(first).unwrap().camera;
        let mut drawer = Drawer::new(&simulator.setup().cameras[camera]).unwrap();
        let mut image = RadianceImage::default();
        let mut mean = [0.0; 2];
        for field in first..first + FIELDS {
            let moment = simulator.moment(field).unwrap();
            let start = processor_ms();
            drawer.draw(simulator.scene(), &moment.lighting, &moment.state.pose, &mut image);
            let drawn = processor_ms();
            simulator.expose_image(&mut workspace, field, &image).unwrap();
            let took = [drawn - start, processor_ms() - drawn];
            mean = [0, 1].map(|i| mean[i] + took[i] / FIELDS as f64);
        }
        println!("{range_m:7}  {camera:6}  {:7.2}  {:13.2}", mean[0], mean[1]);
    }
}
