//! Renders one frame of ARGON and lists its contents:
//! `cargo run --release -p boresight-examples --example frame`.

use boresight::far_range::FarRangeMission;
use boresight::run::ScenarioSource;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    boresight::register_worlds();
    let prepared = FarRangeMission::new(&ScenarioSource::read("argon")?)?;
    let exposure = prepared.simulator().camera()?.expose(8000)?;
    let frame = &exposure.frame;
    println!("{} × {} pixels, {} objects:", frame.columns(), frame.rows(), exposure.objects.len());
    for object in &exposure.objects {
        let (x, y) = (object.position.x, object.position.y);
        println!("{:?} at ({x:.2}, {y:.2}) px, {:.0} electrons", object.kind, object.electrons);
    }
    Ok(())
}
