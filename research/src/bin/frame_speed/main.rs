//! Measures the cost of frames and their detection, on request: Boresight's side of
//! `docs/evidence/speed/compare.py`, which requests small amounts of work from each simulator in turn. Linux
//! only.
//!
//!     cargo run --release -p boresight-research --bin frame_speed
//!
//! The first line on stdout is the plain frame that all simulators make (camera, detector, stars), as JSON,
//! with the names of the tasks that can be timed. Then each line on stdin is a request, and each answer is a
//! line of JSON:
//!
//! - `time WORK COUNT`: repeats the task COUNT times; answers with the processor time per repetition, ms, the
//!   mean over all.
//! - `write COUNT FILE`: writes plain frames, row after row of 16-bit numbers, lowest byte first.
//! - `clusters WORK`: runs the task once; answers with the positions of the clusters that the pipeline found,
//!   px.

mod plain;
mod works;

use std::error::Error;
use std::io::{BufRead, Write};

use plain::PlainScene;
use serde_json::{Value, json};
use works::{Work, works};

/// Processor time of this thread, ms.
fn processor_ms() -> Result<f64, Box<dyn Error>> {
    // The kernel updates the counter when the scheduler runs.
    std::thread::yield_now();
    let text = std::fs::read_to_string("/proc/thread-self/schedstat")?;
    let nanoseconds = text.split_whitespace().next().ok_or("/proc/thread-self/schedstat is empty")?;
    Ok(nanoseconds.parse::<f64>()? / 1e6)
}

/// Mean time of a task, ms.
fn time(work: &mut Work, count: u64) -> Result<f64, Box<dyn Error>> {
    let start = processor_ms()?;
    for _ in 0..count {
        work.next()?;
    }
    Ok((processor_ms()? - start) / count as f64)
}

/// Returns the task with the given name.
fn named<'a>(works: &'a mut [Work], name: &str) -> Result<&'a mut Work, String> {
    works.iter_mut().find(|work| work.name() == name).ok_or_else(|| format!("there is no work {name:?}"))
}

/// Returns the answer to a request.
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
