//! Compresses plotly.js, which is embedded in the executable.

use std::env;
use std::fs;
use std::io::{self, Write};
use std::path::Path;

use flate2::Compression;
use flate2::write::ZlibEncoder;

const BUNDLE: &str = "third_party/plotly/plotly-cartesian.min.js";

fn main() -> io::Result<()> {
    println!("cargo::rerun-if-changed={BUNDLE}");
    let folder = env::var_os("OUT_DIR").ok_or_else(|| io::Error::other("OUT_DIR is not set"))?;
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::best());
    encoder.write_all(&fs::read(BUNDLE)?)?;
    fs::write(Path::new(&folder).join("plotly.js.zlib"), encoder.finish()?)
}
