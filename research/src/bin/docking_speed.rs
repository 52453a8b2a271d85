//! Measures the cost of a field of the scenario `docking`, by range, lens and step: drawing, and the
//! television chain with every artefact. It measures processor time, not elapsed time, and reports the least
//! of several rounds, which excludes other load on the machine. Linux only.
//!
//! `cargo run --release -p boresight-research --bin docking_speed [RANGE_M]`
//!
//! A step cannot be timed from outside: its cost is the difference between a field with and a field without
//! it. The sum is measured on the whole field; it is not a sum of differences.
#![allow(clippy::unwrap_used, reason = "fails by panicking, like a test")]

use std::path::Path;

use contract::docking::Digitiser;
use sim::docking::{DockingSimulation, DockingSimulator, FieldState, FloodlightConfig};
use sim::optics::ImageBlur;
use sim::scene::docking::DockingScene;
use sim::television::TelevisionConfig;
use sim::vector::{Drawer, RadianceImage};

const FIELDS: u64 = 20;
const ROUNDS: usize = 5;
const RANGES_M: [f64; 9] = [500.0, 200.0, 100.0, 50.0, 20.0, 10.0, 5.0, 2.0, 1.0];

/// Processor time of this thread, ms.
fn processor_ms() -> f64 {
    // The kernel updates the counter when the scheduler runs.
    std::thread::yield_now();
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap();
    text.split_whitespace().next().unwrap().parse::<f64>().unwrap() / 1e6
}

/// Least time per field over the rounds, ms.
fn least_ms(fields: &[FieldState], mut work: impl FnMut(&FieldState)) -> f64 {
    let round = || {
        let start = processor_ms();
        fields.iter().for_each(&mut work);
        (processor_ms() - start) / fields.len() as f64
    };
    std::iter::repeat_with(round).take(ROUNDS).fold(f64::INFINITY, f64::min)
}

fn simulation() -> DockingSimulation {
    let text = include_str!("../../../scenarios/docking.toml");
    let mut scenario: toml::Table = toml::from_str(text).unwrap();
    // Keys about the execution of the simulation, not about its content.
    for key in ["world", "title", "docking"] {
        scenario.remove(key);
    }
    scenario.try_into().unwrap()
}

fn fields_at(simulator: &DockingSimulator, range_m: f64) -> Vec<FieldState> {
    let nearer = |field: &u64| simulator.field_state(*field).unwrap().state.range_m() <= range_m;
    let first = (0..simulator.field_count() - FIELDS).find(nearer).unwrap_or(0);
    (first..first + FIELDS).map(|field| simulator.field_state(field).unwrap()).collect()
}

/// Time to draw a scene, ms, and the last image.
fn drawing_ms(drawer: &mut Drawer, scene: &DockingScene, fields: &[FieldState]) -> (f64, RadianceImage) {
    let mut image = RadianceImage::default();
    let ms = least_ms(fields, |field| drawer.draw(scene, &field.lighting, &field.state.pose, &mut image));
    (ms, image)
}

/// Time of all steps after the drawing, except the digitiser, ms.
fn chain_ms(simulation: &DockingSimulation, fields: &[FieldState], image: &RadianceImage) -> f64 {
    let simulator = DockingSimulator::new(simulation, Path::new(".")).unwrap();
    let mut workspace = simulator.workspace().unwrap();
    least_ms(fields, |field| {
        simulator.expose_image(&mut workspace, field.field, image).unwrap();
    })
}

/// Simulation whose television only scales the signal.
fn bare(simulation: &DockingSimulation) -> DockingSimulation {
    let mut bare = simulation.clone();
    bare.television =
        TelevisionConfig { interlace: bare.television.interlace, ..TelevisionConfig::default() };
    bare.television.noise.sigma_dn8 = 0.0;
    bare
}

fn by_range(simulation: &DockingSimulation, simulator: &DockingSimulator, ranges_m: &[f64]) {
    let scene = simulator.scene();
    let empty = DockingScene { parts: Vec::new() };
    let mut unshaded = scene.clone();
    unshaded.parts.iter_mut().for_each(|part| part.casts_shadow = false);
    let mut lamp = simulation.clone();
    lamp.lighting.floodlight = Some(FloodlightConfig::default());
    let lamp = DockingSimulator::new(&lamp, Path::new(".")).unwrap();
    println!(
        "range m  lens  sky   facets  shadows  drawn  (with a lamp)   blur  truth  artefacts  digitiser  whole field, ms"
    );
    for &range_m in ranges_m {
        let fields = fields_at(simulator, range_m);
        for (lens, camera) in simulator.setup().cameras.iter().enumerate() {
            let mut drawer = Drawer::new(camera).unwrap();
            let (sky, _) = drawing_ms(&mut drawer, &empty, &fields);
            let (facets, _) = drawing_ms(&mut drawer, &unshaded, &fields);
            let (drawn, image) = drawing_ms(&mut drawer, scene, &fields);
            let (with_lamp, _) = drawing_ms(&mut drawer, scene, &fields_at(&lamp, range_m));
            let (mut blur, mut kept) = (ImageBlur::new(simulation.lens.blur_sigma_px), Vec::new());
            let blurred = least_ms(&fields, |field| {
                kept = Vec::new();
                blur.blur(&image.radiance, image.columns, field.lines, &mut kept);
            });
            let plain = chain_ms(&bare(simulation), &fields, &image);
            let chain = chain_ms(simulation, &fields, &image);
            let mut workspace = simulator.workspace().unwrap();
            let exposure = simulator.expose_image(&mut workspace, fields[0].field, &image).unwrap();
            let digitised = least_ms(&fields, |_| {
                exposure.video.digitise(&Digitiser::default());
            });
            println!(
                "{range_m:7}  {lens:4}  {sky:4.2}  {:6.2}  {:7.2}  {drawn:5.2}  {with_lamp:13.2}  {blurred:5.2}  {:5.2}  {:9.2}  {digitised:9.2}  {:11.2}",
                facets - sky,
                drawn - facets,
                plain - blurred,
                chain - plain,
                drawn + chain + digitised,
            );
        }
    }
}

type Switch = fn(&mut TelevisionConfig);

const ARTEFACTS: [(&str, Switch); 11] = [
    ("noise", |tv| tv.noise.sigma_dn8 = 0.0),
    ("drift", |tv| tv.drift = None),
    ("automatic gain", |tv| tv.auto_gain = None),
    ("bloom", |tv| tv.bloom = None),
    ("sun glare", |tv| tv.sun_glare = None),
    ("bandwidth, ringing", |tv| (tv.bandwidth, tv.ringing) = (None, None)),
    ("line jitter", |tv| tv.line_jitter = None),
    ("lost lines", |tv| tv.lost_lines = None),
    ("line level", |tv| tv.line_level = None),
    ("overlay", |tv| tv.overlay = None),
    ("none of them", |_| ()),
];

fn by_artefact(simulation: &DockingSimulation, simulator: &DockingSimulator, range_m: f64) {
    let fields = fields_at(simulator, range_m);
    let mut drawer = Drawer::new(&simulator.setup().cameras[fields[0].camera]).unwrap();
    let (_, image) = drawing_ms(&mut drawer, simulator.scene(), &fields);
    let all = chain_ms(simulation, &fields, &image);
    println!("\nartefact at {range_m} m      costs ms");
    for (name, switch_off) in ARTEFACTS {
        let mut without = simulation.clone();
        switch_off(&mut without.television);
        println!("{name:22}  {:8.3}", all - chain_ms(&without, &fields, &image));
    }
}

fn main() {
    let simulation = simulation();
    let simulator = DockingSimulator::new(&simulation, Path::new(".")).unwrap();
    let chosen: Option<f64> = std::env::args().nth(1).map(|range| range.parse().unwrap());
    let ranges_m = chosen.map_or(RANGES_M.to_vec(), |range_m| vec![range_m]);
    by_range(&simulation, &simulator, &ranges_m);
    by_artefact(&simulation, &simulator, chosen.unwrap_or(5.0));
}
