//! Rows of a study: each case once, in order, with a unique seed.

use std::collections::BTreeSet;
use std::fs::File;

use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::record::RowAccessor;

use crate::support::Bench;

const STUDY: &str = r#"
title = "one frame of ARGON"
scenario = "argon"
seed = 5
frames = "2000..2001"
[stop]
cases = 4
[[vary]]
path = "psf.sigma_px"
distribution = { kind = "normal", mean = 0.8, sigma = 0.1 }
"#;

/// Cases with the same seed would be a single case, counted repeatedly: every interval would be too narrow.
#[test]
fn cases_are_in_order_and_each_has_a_seed_of_its_own() {
    let bench = Bench::new();
    bench.write("study.toml", STUDY);
    bench.boresight("study run study.toml --out out --shards 2").done();
    let file = File::open(bench.path("out/cases.parquet")).unwrap();
    let reader = SerializedFileReader::new(file).unwrap();
    let rows = reader.get_row_iter(None).unwrap().map(Result::unwrap);
    let (cases, seeds): (Vec<u64>, BTreeSet<u64>) = rows
        .map(|row| {
            let names: Vec<&String> = row.get_column_iter().take(2).map(|(name, _)| name).collect();
            assert_eq!(names, ["case", "seed"]);
            (row.get_ulong(0).unwrap(), row.get_ulong(1).unwrap())
        })
        .unzip();
    assert_eq!(cases, [0, 1, 2, 3]);
    assert_eq!(seeds.len(), 4, "{seeds:?}");
}
