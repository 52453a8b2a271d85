//! Measures the rate at which the target is recognised: the built-in pipeline on blocks of fields over the
//! approach of the docking scenario, with every artefact of the scenario, or on clean random poses at one
//! distance.
//!
//!     cargo run --release -p boresight-research --bin docking_recognition -- [--every 400] [--block 8]
//!     [--from 0] [--to 25169]
//!         [--lens wide] [--poses 100 --range 20] [--out DIR]
//!
//! Each block begins with a new pipeline. Printed per bin of range and per lens: the number of fields with
//! the target wholly in the image, the numbers of measured and of wrong fields, the reasons for the
//! unmeasured fields, and the time per field. With `--out` the fields that were not measured, or measured
//! wrongly, are written to DIR with the recognised features drawn over them.

mod drawing;
mod tally;

use std::error::Error;
use std::path::{Path, PathBuf};
use std::time::Instant;

use contract::PipelineFactory;
use contract::docking::Digitiser;
use draws::{Effect, Seed, uniform};
use pipeline::docking::{DockingConfig, DockingFactory};
use sim::docking::{DockingSimulation, DockingSimulator};
use sim::television::{Interlace, TelevisionConfig, VideoNoiseConfig};
use sim::truth::approach::{ApproachConfig, ConstantVelocityConfig};
use tally::{Entry, Tally};

struct Arguments {
    every: u64,
    block: u64,
    from: u64,
    to: u64,
    wide: bool,
    poses: Option<u64>,
    range_m: f64,
    out: Option<PathBuf>,
    is_verbose: bool,
}

fn arguments() -> Result<Arguments, Box<dyn Error>> {
    let mut arguments = Arguments {
        every: 400,
        block: 8,
        from: 0,
        to: u64::MAX,
        wide: false,
        poses: None,
        range_m: 20.0,
        out: None,
        is_verbose: false,
    };
    let mut words = std::env::args().skip(1);
    while let Some(option) = words.next() {
        if option == "--verbose" {
            arguments.is_verbose = true;
            continue;
        }
        let value = words.next().ok_or_else(|| format!("{option} has no value"))?;
        match option.as_str() {
            "--every" => arguments.every = value.parse::<u64>()?.max(1),
            "--block" => arguments.block = value.parse()?,
            "--from" => arguments.from = value.parse()?,
            "--to" => arguments.to = value.parse()?,
            "--lens" => arguments.wide = value == "wide",
            "--poses" => arguments.poses = Some(value.parse()?),
            "--range" => arguments.range_m = value.parse()?,
            "--out" => arguments.out = Some(value.into()),
            _ => return Err(format!("{option} is not an option").into()),
        }
    }
    Ok(arguments)
}

/// Built-in scenario; with `wide`, seen by its wide lens only.
fn simulation(wide: bool) -> Result<DockingSimulation, Box<dyn Error>> {
    let mut table: toml::Table = boresight::docking::STARTING_POINT.parse()?;
    for key in ["world", "title", "docking"] {
        table.remove(key);
    }
    let mut simulation: DockingSimulation = table.try_into()?;
    if wide {
        simulation.cameras.remove(0);
    }
    Ok(simulation)
}

/// Sharp, progressive field of a random pose, with little noise.
fn clean(simulation: &DockingSimulation, range_m: f64, number: u64) -> DockingSimulation {
    let mut stream = Seed { seed: 1, case: 0 }.stream(number, Effect::AttitudeControl, 0);
    let mut symmetric = |size: f64| size * (2.0 * uniform(&mut stream) - 1.0);
    let approach = ApproachConfig::ConstantVelocity(ConstantVelocityConfig {
        position_m: [symmetric(0.03 * range_m), symmetric(0.03 * range_m), range_m],
        velocity_m_s: [0.0; 3],
        phi_deg: [symmetric(3.0), symmetric(3.0), symmetric(3.0)],
        phi_rate_deg_s: [0.0; 3],
        duration_s: 0.0,
    });
    let mut lighting = simulation.lighting.clone();
    if let Some(sun) = &mut lighting.sun {
        (sun.azimuth_deg, sun.elevation_deg) = (symmetric(50.0), symmetric(30.0));
    }
    DockingSimulation {
        seed: number,
        approach,
        lighting,
        television: TelevisionConfig {
            interlace: Interlace::Off,
            noise: VideoNoiseConfig { sigma_dn8: 2.0 },
            ..TelevisionConfig::default()
        },
        ..simulation.clone()
    }
}

fn block(
    simulator: &DockingSimulator,
    fields: std::ops::Range<u64>,
    arguments: &Arguments,
    name: &str,
    tally: &mut Tally,
) -> Result<(), Box<dyn Error>> {
    let factory = DockingFactory::new(DockingConfig::default())?;
    let mut workspace = simulator.workspace()?;
    let setup = simulator.setup();
    let mut pipeline = factory.build(&setup)?;
    let mut digitiser = Digitiser::default();
    for (place, field) in fields.enumerate() {
        let exposure = simulator.expose(&mut workspace, field)?;
        let digitised = exposure.video.digitise(&digitiser);
        let before = Instant::now();
        let outcome = pipeline.process(&digitised, &exposure.telemetry(digitiser));
        let seconds = before.elapsed().as_secs_f64();
        let entry = Entry::new(&setup, &exposure.truth, &outcome, seconds, place == 0);
        if arguments.is_verbose {
            println!("{field} {entry} {:.2} {:.2}", digitiser.contrast, digitiser.brightness);
        }
        if let Some(folder) = arguments.out.as_ref().filter(|_| !entry.is_good()) {
            std::fs::create_dir_all(folder)?;
            drawing::write(&folder.join(format!("{name}{field:05}.png")), &digitised, &outcome)?;
        }
        tally.add(entry);
        digitiser = outcome.digitiser.unwrap_or(digitiser);
    }
    Ok(())
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments = arguments()?;
    let simulation = simulation(arguments.wide)?;
    let mut tally = Tally::default();
    if let Some(poses) = arguments.poses {
        for number in 0..poses {
            let still = clean(&simulation, arguments.range_m, number);
            let simulator = DockingSimulator::new(&still, Path::new("."))?;
            block(&simulator, 0..1, &arguments, &format!("{number:04}-"), &mut tally)?;
        }
    } else {
        let simulator = DockingSimulator::new(&simulation, Path::new("."))?;
        let end = arguments.to.min(simulator.field_count());
        for first in (arguments.from..end).step_by(usize::try_from(arguments.every)?) {
            block(&simulator, first..(first + arguments.block).min(end), &arguments, "", &mut tally)?;
        }
    }
    println!("{tally}");
    Ok(())
}
