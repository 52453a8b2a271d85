//! Run directories with one arbitrary file: tests code that combines files which each pass their own reader.

use boresight::gate::read_result;
use boresight::report::read_report;

use crate::Sandbox;

/// A file of a run: its path and its contents.
type File = (&'static str, &'static [u8]);

/// Two valid runs: three far-range frames and three docking fields.
const RUNS: [(&str, &[File]); 2] = [
    (
        "far/",
        &[
            ("run.toml", include_bytes!("../corpus/run_file/small.toml")),
            ("score.json", include_bytes!("../corpus/json/small-score.json")),
            ("measurements.csv", include_bytes!("../corpus/csv/small-far-measurements.csv")),
            ("telemetry.csv", include_bytes!("../corpus/csv/small-far-telemetry.csv")),
            ("clusters.parquet", include_bytes!("../corpus/parquet/small-far-clusters.parquet")),
            ("truth/frames.parquet", include_bytes!("../corpus/parquet/small-far-frames.parquet")),
            ("truth/objects.parquet", include_bytes!("../corpus/parquet/small-far-objects.parquet")),
        ],
    ),
    (
        "docking/",
        &[
            ("run.toml", include_bytes!("../corpus/run_file/small-docking.toml")),
            ("setup.toml", include_bytes!("../corpus/setup/small.toml")),
            ("score.json", include_bytes!("../corpus/json/small-docking-score.json")),
            ("measurements.csv", include_bytes!("../corpus/csv/small-docking-measurements.csv")),
            ("motion.csv", include_bytes!("../corpus/csv/small-docking-motion.csv")),
            ("telemetry.csv", include_bytes!("../corpus/csv/small-docking-telemetry.csv")),
            ("features.parquet", include_bytes!("../corpus/parquet/small-docking-features.parquet")),
            ("truth/fields.parquet", include_bytes!("../corpus/parquet/small-docking-fields.parquet")),
        ],
    ),
];

/// Replaces one file of a run: the first line of `bytes` names the file (`far/measurements.csv`), the
/// remainder is its contents.
pub(crate) fn directory(sandbox: &Sandbox, bytes: &[u8]) {
    let mut parts = bytes.splitn(2, |byte| *byte == b'\n');
    let (Some(name), Some(content)) = (parts.next(), parts.next()) else { return };
    for (run, files) in RUNS {
        let Some(name) = name.strip_prefix(run.as_bytes()) else { continue };
        if !files.iter().any(|(file, _)| file.as_bytes() == name) {
            continue;
        }
        for (file, right) in files {
            sandbox.file(&format!("{run}{file}"), if file.as_bytes() == name { content } else { right });
        }
        let directory = sandbox.path().join(run);
        let _ = read_result(&directory, None);
        let _ = read_report(&directory);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// With an invalid base run, the fuzzer would never get past its first error.
    #[test]
    fn the_assembled_run_is_valid() {
        boresight::register_worlds();
        let sandbox = Sandbox::new().unwrap();
        for (run, files) in RUNS {
            files.iter().for_each(|(file, right)| drop(sandbox.file(&format!("{run}{file}"), right)));
            let directory = sandbox.path().join(run);
            read_result(&directory, None).unwrap();
            read_report(&directory).unwrap();
        }
    }
}
