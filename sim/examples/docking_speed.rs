//! What a field of the scenario `docking` costs, by range: drawing, and the television chain with every artefact. Times
//! are the least of several fields, so that what else runs on the machine hardly counts.
//!
//! `cargo run --release -p boresight-sim --example docking_speed`
#![allow(clippy::unwrap_used, reason = "it fails by panicking, as a test does")]

use std::path::Path;
use std::time::Instant;

use boresight_sim::docking::{DockingSimulation, DockingSimulator};
use boresight_sim::vector::{Drawer, RadianceImage};

const FIELDS: u64 = 40;

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
        let mut least = [f64::INFINITY; 2];
        for field in first..first + FIELDS {
            let moment = simulator.moment(field).unwrap();
            let start = Instant::now();
            drawer.draw(simulator.scene(), &moment.lighting, &moment.state.pose, &mut image);
            let drawn = Instant::now();
            simulator.expose_image(&mut workspace, field, &image).unwrap();
            let took = [drawn - start, drawn.elapsed()];
            least = [0, 1].map(|i| least[i].min(took[i].as_secs_f64() * 1e3));
        }
        println!("{range_m:7}  {camera:6}  {:7.2}  {:13.2}", least[0], least[1]);
    }
}
