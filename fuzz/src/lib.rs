//! Hostile input for every reader of the project.
//!
//! A [`Target`] takes bytes and hands them to what reads such bytes. It may refuse them; it may not panic, abort, hang, or reserve more
//! than the bytes justify. `fuzz/corpus/` holds a folder of inputs for each target, replayed by `cargo test`; `fuzz/run` makes new
//! ones of them with libFuzzer, guided by coverage, on the stable compiler.

mod answers;
mod images;
mod runs;
mod sandbox;
mod server;
mod tables;
mod texts;
mod videos;

pub use sandbox::Sandbox;

/// What reads some kind of bytes.
#[derive(Debug, Clone, Copy)]
pub struct Target {
    /// Name, and that of its folder in the corpus.
    pub name: &'static str,
    /// What it is fed with.
    pub reads: &'static str,
    run: fn(&Sandbox, &[u8]),
}

impl Target {
    const fn new(name: &'static str, reads: &'static str, run: fn(&Sandbox, &[u8])) -> Self {
        Self { name, reads, run }
    }

    /// Feeds it.
    pub fn run(&self, sandbox: &Sandbox, bytes: &[u8]) {
        (self.run)(sandbox, bytes);
    }

    /// The target of a name.
    pub fn named(name: &str) -> Option<&'static Self> {
        TARGETS.iter().find(|target| target.name == name)
    }
}

/// Every target, by name.
pub const TARGETS: &[Target] = &[
    Target::new("answer", "a line of an external pipeline, of both worlds", answers::answer),
    Target::new("avi", "AVI, uncompressed and Motion-JPEG", videos::avi),
    Target::new("baseline", "baseline.toml beside rows that fit", tables::baseline),
    Target::new("baseline_rows", "rows.parquet of a baseline", tables::baseline_rows),
    Target::new("camera", "camera.toml of a dataset", texts::camera),
    Target::new("catalogue_csv", "a star catalogue, CSV", texts::catalogue_csv),
    Target::new("catalogue_dat", "a star catalogue, hip2.dat or hip_main.dat", texts::catalogue_dat),
    Target::new(
        "csv",
        "measurements, telemetry, stars, motion, dispersions and maps of the sky, CSV",
        tables::csv,
    ),
    Target::new("dataset", "telemetry.csv that names images", tables::dataset),
    Target::new("exr", "OpenEXR: frames, expectations, radiances", images::exr),
    Target::new("fits", "FITS", images::fits),
    Target::new("http", "bytes on a connection to the monitor", server::http),
    Target::new("json", "scores, summaries, study records and reports, JSON", texts::json),
    Target::new("parquet", "truth, features, clusters and cases, Parquet", tables::parquet),
    Target::new("png", "PNG, checksums put right", images::png),
    Target::new("psf", "a sampled point-spread function", texts::psf),
    Target::new("raw", "raw video", videos::raw),
    Target::new("requirements", "requirements on visibility, TOML", texts::requirements),
    Target::new("run_directory", "a file of a run that is put together with the others", runs::directory),
    Target::new("run_file", "run.toml", texts::run_file),
    Target::new("scenario", "scenarios of both worlds, TOML", texts::scenario),
    Target::new("setup", "setup.toml of a docking dataset", texts::setup),
    Target::new("simulator", "scenarios that are right, made into simulators", texts::simulator),
    Target::new("study", "studies, TOML", texts::study),
    Target::new("target", "docking targets, TOML", texts::target),
    Target::new("tiff", "TIFF", images::tiff),
    Target::new("y4m", "YUV4MPEG2", videos::y4m),
];
