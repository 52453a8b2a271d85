//! What frames and their detection cost, by request: the side of Boresight in `docs/speed/compare.py`, which asks for a little of each in
//! turn with the other simulators. Linux only.
//!
//!     cargo run --release -p boresight-research --bin frame_speed
//!
//! The first line on stdout is the plain frame that all simulators make (camera, detector, stars), as JSON, with the names of
//! what can be timed. Then each line on stdin is a request, and each answer a line of JSON:
//!
//! - `time WORK COUNT`: does the work so often; answers with the processor's time of each, ms, the mean over all.
//! - `write COUNT FILE`: writes plain frames, row after row of 16-bit numbers, lowest byte first.
//! - `clusters WORK`: does the work once; answers with the places of the clusters that the pipeline found, px.

mod plain;
mod works;

use std::error::Error;
use std::io::{BufRead, Write};

use plain::PlainScene;
use serde_json::{Value, json};
use works::{Work, works};

/// What this thread has had of a processor, ms.
fn processor_ms() -> Result<f64, Box<dyn Error>> {
    // The count is brought up to date when the scheduler looks.
    std::thread::yield_now();
    let text = std::fs::read_to_string("/proc/thread-self/schedstat")?;
    let nanoseconds = text.split_whitespace().next().ok_or("/proc/thread-self/schedstat is empty")?;
    Ok(nanoseconds.parse::<f64>()? / 1e6)
}

/// The mean time of a work, ms.
fn time(work: &mut Work, count: u64) -> Result<f64, Box<dyn Error>> {
    let start = processor_ms()?;
    for _ in 0..count {
        work.next()?;
    }
    Ok((processor_ms()? - start) / count as f64)
}

/// The work of a name.
fn named<'a>(works: &'a mut [Work], name: &str) -> Result<&'a mut Work, String> {
    works.iter_mut().find(|work| work.name() == name).ok_or_else(|| format!("there is no work {name:?}"))
}

/// The answer to a request.
fn answer(request: &str, scene: &PlainScene, works: &mut [Work]) -> Result<Value, Box<dyn Error>> {
    let words: Vec<&str> = request.split_whitespace().collect();
    match words[..] {
        ["time", name, count] => {
            let count = count.parse::<u64>()?.max(1);
            Ok(json!({ "cpu_ms": time(named(works, name)?, count)? }))
        }
        ["clusters", name] => Ok(json!({ "clusters": named(works, name)?.clusters()? })),
        ["write", count, file] => {
            let mut painter = scene.painter()?;
            let mut out = std::io::BufWriter::new(std::fs::File::create(file)?);
            for number in 0..count.parse()? {
                for dn in painter.frame(number)? {
                    out.write_all(&dn.to_le_bytes())?;
                }
            }
            out.flush()?;
            Ok(json!({ "file": file }))
        }
        _ => {
            Err(format!("{request:?} is no request: time WORK COUNT, write COUNT FILE or clusters WORK")
                .into())
        }
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let scene = PlainScene::new();
    let mut works = works(&scene)?;
    let names: Vec<&str> = works.iter().map(Work::name).collect();
    println!("{}", json!({ "scene": scene.to_json(), "works": names }));
    for request in std::io::stdin().lock().lines() {
        println!("{}", answer(&request?, &scene, &mut works)?);
    }
    Ok(())
}
