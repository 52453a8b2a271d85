//! Point-spread functions compared with stamps drawn by GalSim: golden/README.md.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use boresight_optics::{Psf, PsfConfig, Stamp};
use contract::PixelPoint;

/// A line of stamps.csv; its columns are documented in golden/psf/make_stamps.py.
struct Reference {
    kind: String,
    config: PsfConfig,
    centre: PixelPoint,
    size: usize,
    shares: Vec<f64>,
}

fn references() -> Vec<Reference> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../golden/psf/stamps.csv");
    let text = fs::read_to_string(path).unwrap_or_else(|error| panic!("the reference is missing: {error}"));
    text.lines().map(reference).collect()
}

fn reference(line: &str) -> Reference {
    let cells: Vec<&str> = line.split(',').collect();
    let parameters: Vec<f64> = cells[1].split(' ').map(|cell| cell.parse().unwrap()).collect();
    let config = match (cells[0], parameters.as_slice()) {
        ("gaussian", &[sigma_px]) => PsfConfig::Gaussian { sigma_px },
        ("moffat", &[fwhm_px, beta]) => PsfConfig::Moffat { fwhm_px, beta },
        ("airy", &[lambda_n, obscuration]) => PsfConfig::Airy { lambda_n_px: [lambda_n; 2], obscuration },
        ("defocus", &[radius_px, sigma_px]) => PsfConfig::Defocus { radius_px, sigma_px },
        other => panic!("a stamp of {other:?}"),
    };
    Reference {
        kind: cells[0].to_owned(),
        config,
        centre: PixelPoint::new(cells[2].parse().unwrap(), cells[3].parse().unwrap()),
        size: cells[4].parse().unwrap(),
        shares: cells[5..].iter().map(|cell| cell.parse().unwrap()).collect(),
    }
}

#[test]
fn stamps_are_those_of_galsim() {
    let mut worst: BTreeMap<String, f64> = BTreeMap::new();
    for reference in references() {
        let Reference { kind, config, centre, size, shares } = reference;
        assert_eq!(shares.len(), size * size);
        let mut stamp = Stamp::new();
        Psf::new(&config).unwrap().stamp(centre, 1.0, 1e-12, (size, size), &mut stamp);
        let mut ours = vec![0.0; size * size];
        for (x, y, row) in stamp.rows() {
            ours[y * size + x..][..row.len()].copy_from_slice(row);
        }
        let peak = shares.iter().copied().fold(0.0, f64::max);
        for (k, (a, b)) in ours.iter().zip(&shares).enumerate() {
            let difference = (a - b).abs() / peak;
            let entry = worst.entry(kind.clone()).or_default();
            *entry = entry.max(difference);
            // Required by the issue of this simulator; GalSim and the simulator's tables are each accurate to
            // about 1e-5.
            assert!(
                difference < 1e-4,
                "{config:?} at {centre:?}, pixel ({}, {}): {a:e}, GalSim {b:e}, {difference:e} of the peak",
                k % size,
                k / size
            );
        }
    }
    println!("largest differences, of the peak: {worst:?}");
    assert_eq!(worst.len(), 4, "every kind was compared");
}

/// In the wings, a tolerance of 1e-4 of the peak is too loose: the wings are compared relative to their own
/// values.
#[test]
fn the_wings_of_a_moffat_image_are_those_of_galsim() {
    let wide: Vec<Reference> = references().into_iter().filter(|stamp| stamp.size > 60).collect();
    assert_eq!(wide.len(), 1);
    for Reference { config, centre, size, shares, .. } in wide {
        let mut stamp = Stamp::new();
        Psf::new(&config).unwrap().stamp(centre, 1.0, 1e-12, (size, size), &mut stamp);
        let mut ours = vec![0.0; size * size];
        for (x, y, row) in stamp.rows() {
            ours[y * size + x..][..row.len()].copy_from_slice(row);
        }
        let mut faintest = f64::INFINITY;
        for (k, (share, expected)) in ours.iter().zip(&shares).enumerate() {
            let radius = centre.distance(PixelPoint::new((k % size) as f64, (k / size) as f64));
            if radius <= 30.0 {
                // GalSim's image is periodic over some hundred pixels and rounded at 1e-9 of the flux.
                let tolerance = 0.01 * expected + 2e-9;
                assert!(
                    (share - expected).abs() < tolerance,
                    "{radius} px out: {share:e}, GalSim {expected:e}"
                );
                faintest = faintest.min(*expected);
            }
        }
        assert!(faintest > 4e-9, "the tolerance would hide a wing of {faintest:e}");
    }
}
