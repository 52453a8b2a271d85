//! Hostile input for every reader of the project.
//!
//! A [`Target`] passes bytes to the readers of its format. A reader may reject them; it must not panic,
//! abort, hang, or allocate more memory than the bytes justify. In the tests, what it accepts is also
//! written, and is the same when it is read again. `fuzz/corpus/` contains a directory of inputs for each
//! target, replayed by `cargo test`; `fuzz/run` derives new inputs from them with libFuzzer, guided by
//! coverage, on the stable compiler.

mod answers;
mod flight_dynamics;
mod images;
mod runs;
mod sandbox;
mod server;
mod tables;
mod texts;
mod videos;
mod written;

pub use sandbox::Sandbox;

/// A fuzz target: one or more readers of the same kind of bytes.
#[derive(Debug, Clone, Copy)]
pub struct Target {
    /// Name of the target and of its directory in the corpus.
    pub name: &'static str,
    /// Description of the input.
    pub reads: &'static str,
    run: fn(&Sandbox, &[u8]),
}

impl Target {
    const fn new(name: &'static str, reads: &'static str, run: fn(&Sandbox, &[u8])) -> Self {
        Self { name, reads, run }
    }

    /// Passes `bytes` to the target.
    pub fn run(&self, sandbox: &Sandbox, bytes: &[u8]) {
        boresight::register_worlds();
        (self.run)(sandbox, bytes);
    }

    /// Returns the target with the given name.
    pub fn named(name: &str) -> Option<&'static Self> {
        TARGETS.iter().find(|target| target.name == name)
    }
}

/// All targets, ordered by name.
pub const TARGETS: &[Target] = &[
    Target::new("aem", "attitude ephemeris messages of CCSDS", flight_dynamics::aem),
    Target::new("answer", "a line of output of an external pipeline, both worlds", answers::answer),
    Target::new("avi", "AVI, uncompressed and Motion-JPEG", videos::avi),
    Target::new("baseline", "baseline.toml with matching rows", tables::baseline),
    Target::new("baseline_rows", "rows.parquet of a baseline", tables::baseline_rows),
    Target::new("calibration", "calibrations of OpenCV, ROS and Kalibr, YAML and JSON", texts::calibration),
    Target::new("camera", "camera.toml of a dataset", texts::camera),
    Target::new("catalogue_csv", "a star catalogue, CSV", texts::catalogue_csv),
    Target::new("catalogue_dat", "a star catalogue, hip2.dat or hip_main.dat", texts::catalogue_dat),
    Target::new(
        "csv",
        "measurements, telemetry, stars, motion, dispersions, maps of the sky, navigation, CSV",
        tables::csv,
    ),
    Target::new("dataset", "telemetry.csv that names images", tables::dataset),
    Target::new("exr", "OpenEXR: frames, expectations, radiances", images::exr),
    Target::new("fits", "FITS", images::fits),
    Target::new("http", "bytes on a connection to the monitor", server::http),
    Target::new("json", "scores, summaries, study records and reports, JSON", texts::json),
    Target::new("mesh_glb", "meshes in binary glTF", texts::mesh_glb),
    Target::new("mesh_obj", "meshes in Wavefront OBJ, and their materials, MTL", texts::mesh_obj),
    Target::new("oem", "orbit ephemeris messages of CCSDS", flight_dynamics::oem),
    Target::new("opm", "orbit parameter messages of CCSDS", flight_dynamics::opm),
    Target::new("parquet", "truth, features, clusters and cases, Parquet", tables::parquet),
    Target::new("png", "PNG with corrected checksums", images::png),
    Target::new("preset", "cameras of `boresight sky`, TOML", texts::preset),
    Target::new("psf", "a sampled point-spread function", texts::psf),
    Target::new("raw", "raw video", videos::raw),
    Target::new("requirements", "requirements on visibility, TOML", texts::requirements),
    Target::new("run_directory", "a run directory with one replaced file", runs::directory),
    Target::new("run_file", "run.toml", texts::run_file),
    Target::new("scenario", "scenarios of both worlds, TOML", texts::scenario),
    Target::new("setup", "setup.toml of a docking dataset", texts::setup),
    Target::new("simulator", "valid scenarios, built into simulators", texts::simulator),
    Target::new("spk", "SPICE kernels of positions", flight_dynamics::spk),
    Target::new("study", "studies, TOML", texts::study),
    Target::new("target", "docking targets, TOML", texts::target),
    Target::new("tdm", "tracking data messages of CCSDS", flight_dynamics::tdm),
    Target::new("tiff", "TIFF", images::tiff),
    Target::new("tle", "two-line elements", flight_dynamics::tle),
    Target::new("y4m", "YUV4MPEG2", videos::y4m),
];
