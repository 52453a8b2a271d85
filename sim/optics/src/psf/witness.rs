//! Tests of every shape at 100 sub-pixel phases against independent computations that share only its formula.

use std::f64::consts::PI;

use contract::{Camera, PixelPoint};

use super::{Psf, PsfConfig};
use crate::{ImagePoint, Stamp};

/// Number of pixels per side; the image is centred on the middle pixel.
const SIDE: usize = 41;
const MIDDLE: f64 = 20.0;

/// Gauss's five-point rule on [−1, 1].
const GAUSS: [(f64, f64); 5] = [
    (-0.906_179_845_938_664, 0.236_926_885_056_189),
    (-0.538_469_310_105_683, 0.478_628_670_499_366),
    (0.0, 0.568_888_888_888_889),
    (0.538_469_310_105_683, 0.478_628_670_499_366),
    (0.906_179_845_938_664, 0.236_926_885_056_189),
];

fn phases() -> impl Iterator<Item = PixelPoint> {
    (0..100).map(|i| {
        let (x, y) = (f64::from(i % 10) / 10.0 - 0.47, f64::from(i / 10) / 10.0 - 0.51);
        PixelPoint::new(MIDDLE + x, MIDDLE + y)
    })
}

fn pixels(stamp: &Stamp) -> Vec<f64> {
    let mut pixels = vec![0.0; SIDE * SIDE];
    for (x, y, row) in stamp.rows() {
        pixels[y * SIDE + x..][..row.len()].copy_from_slice(row);
    }
    pixels
}

fn image(psf: &mut Psf, centre: PixelPoint) -> Vec<f64> {
    let mut stamp = Stamp::new();
    psf.stamp(centre, 1.0, 1e-13, (SIDE, SIDE), &mut stamp);
    pixels(&stamp)
}

/// Integrates the flux in each pixel by Gauss's rule: on 2 × 2 parts of pixels near the centre, on other
/// pixels as a whole.
fn integrated(density: impl Fn(f64, f64) -> f64, centre: PixelPoint) -> Vec<f64> {
    let whole = GAUSS.map(|(u, w)| (0.5 * u, 0.5 * w));
    let halves = GAUSS.map(|(u, w)| (0.25 * (u - 1.0), 0.25 * w)).into_iter();
    let halves: Vec<_> = halves.chain(GAUSS.map(|(u, w)| (0.25 * (u + 1.0), 0.25 * w))).collect();
    let pixel = |k: usize| {
        let (x, y) = ((k % SIDE) as f64 - centre.x, (k / SIDE) as f64 - centre.y);
        let nodes: &[(f64, f64)] = if x.abs().max(y.abs()) < 3.0 { &halves } else { &whole };
        let along = |v: f64| nodes.iter().map(|(u, wu)| wu * density(x + u, y + v)).sum::<f64>();
        nodes.iter().map(|(v, wv)| wv * along(*v)).sum()
    };
    (0..SIDE * SIDE).map(pixel).collect()
}

fn flux_and_centroid(pixels: &[f64]) -> (f64, PixelPoint) {
    let (mut flux, mut x, mut y) = (0.0, 0.0, 0.0);
    for (k, value) in pixels.iter().enumerate() {
        flux += value;
        x += value * (k % SIDE) as f64;
        y += value * (k / SIDE) as f64;
    }
    (flux, PixelPoint::new(x / flux, y / flux))
}

/// Checks a shape. The required accuracy is 1e-4 of the flux and 1e-3 px; every shape is better by the factor
/// `margin`.
fn check(config: &PsfConfig, margin: f64, witness: impl Fn(PixelPoint) -> Vec<f64>) {
    let mut psf = Psf::new(config).unwrap();
    let [mut flux, mut centroid, mut pixel] = [0.0_f64; 3];
    for centre in phases() {
        let (ours, truth) = (image(&mut psf, centre), witness(centre));
        let ((our_flux, our_centre), (true_flux, true_centre)) =
            (flux_and_centroid(&ours), flux_and_centroid(&truth));
        flux = flux.max((our_flux - true_flux).abs());
        centroid = centroid.max(our_centre.distance(true_centre));
        let peak = truth.iter().copied().fold(0.0, f64::max);
        let worst = ours.iter().zip(&truth).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        pixel = pixel.max(worst / peak);
    }
    println!("{config:?}: flux {flux:.1e}, centroid {centroid:.1e} px, pixel {pixel:.1e} of the peak");
    assert!(flux < 1e-4 / margin, "{config:?}: flux off by {flux:e}");
    assert!(centroid < 1e-3 / margin, "{config:?}: centroid off by {centroid:e} px");
    assert!(pixel < 1e-4 / margin, "{config:?}: a pixel off by {pixel:e} of the peak");
}

fn moffat_density(fwhm_px: f64, beta: f64) -> impl Fn(f64, f64) -> f64 {
    let alpha2 = 0.25 * fwhm_px * fwhm_px / (libm::pow(2.0, 1.0 / beta) - 1.0);
    move |x, y| (beta - 1.0) / (PI * alpha2) * libm::pow(1.0 + (x * x + y * y) / alpha2, -beta)
}

#[test]
fn a_moffat_image_is_the_integral_of_its_profile_over_each_pixel() {
    for (fwhm_px, beta) in [(1.2, 1.5), (1.5, 2.5), (2.5, 4.765), (3.0, 20.0)] {
        let density = moffat_density(fwhm_px, beta);
        check(&PsfConfig::Moffat { fwhm_px, beta }, 10.0, |centre| integrated(&density, centre));
    }
}

/// The wings of a bright object make its image large: their relative error must be small.
#[test]
fn the_wings_of_a_moffat_profile_are_right_to_a_part_in_ten_thousand_out_to_150_px() {
    for (fwhm_px, beta) in [(1.2, 1.5), (1.8, 3.0), (2.5, 4.765)] {
        let density = moffat_density(fwhm_px, beta);
        let mut psf = Psf::new(&PsfConfig::Moffat { fwhm_px, beta }).unwrap();
        let mut stamp = Stamp::new();
        psf.stamp(PixelPoint::new(0.2, 0.4), 1.0, 1e-30, (160, 3), &mut stamp);
        let (first, _, row) = stamp.rows().next().unwrap();
        assert!(first == 0 && row.len() > 150, "it begins at {first} and ends after {} px", row.len());
        for (i, value) in row.iter().enumerate().take(151).skip(5) {
            // The mean over a pixel differs from the value at its middle by the second derivative over 24,
            // (2β r⁻²)(2β + 1)/24 along a row, so the truth is integrated.
            let nodes = || GAUSS.iter().map(|(u, w)| (0.5 * u, 0.5 * w));
            let truth: f64 = nodes()
                .map(|(v, wv)| {
                    wv * nodes().map(|(u, wu)| wu * density(i as f64 - 0.2 + u, v - 0.4)).sum::<f64>()
                })
                .sum();
            assert!((value / truth - 1.0).abs() < 1e-4, "β {beta}, {i} px: {value:e}, expected {truth:e}");
        }
    }
}

/// With the transform F(k) of the profile the centroid of pixel-integrated samples is c + Σ (−1)^m/(πm) F(m)
/// sin(2πmc) (Poisson's summation formula). For β = 2.5, F(k) = (1 + x) e^−x with x = 2πkα.
#[test]
fn the_centroid_of_a_moffat_image_follows_its_s_curve() {
    let alpha_px = 0.45;
    let fwhm_px = 2.0 * alpha_px * (libm::pow(2.0, 0.4) - 1.0).sqrt();
    let mut psf = Psf::new(&PsfConfig::Moffat { fwhm_px, beta: 2.5 }).unwrap();
    let mut stamp = Stamp::new();
    let mut largest = 0.0_f64;
    for phase in 0..100 {
        let c = f64::from(phase) / 100.0 - 0.5;
        psf.stamp(PixelPoint::new(200.0 + c, 200.0), 1.0, 1e-16, (401, 401), &mut stamp);
        let (mut flux, mut moment) = (0.0, 0.0);
        for (x, _, row) in stamp.rows() {
            for (i, value) in row.iter().enumerate() {
                flux += value;
                moment += value * ((x + i) as f64 - 200.0);
            }
        }
        let s_curve: f64 = (1..20)
            .map(|m| {
                let k = f64::from(m);
                let x = 2.0 * PI * k * alpha_px;
                let sign = if m % 2 == 0 { 1.0 } else { -1.0 };
                sign / (PI * k) * (1.0 + x) * libm::exp(-x) * libm::sin(2.0 * PI * k * c)
            })
            .sum();
        largest = largest.max(s_curve.abs());
        // The border of the detector, 200 px away, cuts off 1e-8 of the flux.
        assert!((moment / flux - c - s_curve).abs() < 2e-5, "phase {c}: {} off", moment / flux - c - s_curve);
    }
    assert!(largest > 0.05, "there is a curve to follow: {largest}");
}

fn airy_density([lx, ly]: [f64; 2], obscuration: f64) -> impl Fn(f64, f64) -> f64 {
    let eps2 = obscuration * obscuration;
    let jinc = |v: f64| if v < 1e-8 { 1.0 } else { 2.0 * libm::j1(v) / v };
    move |x, y| {
        let v = PI * libm::hypot(x / lx, y / ly);
        let amplitude = (jinc(v) - eps2 * jinc(obscuration * v)) / (1.0 - eps2);
        0.25 * PI * (1.0 - eps2) / (lx * ly) * amplitude * amplitude
    }
}

#[test]
fn an_airy_image_is_the_integral_of_its_pattern_over_each_pixel() {
    for (lambda_n_px, obscuration) in [([0.8, 0.8], 0.0), ([1.2, 1.25], 0.0), ([1.5, 1.5], 0.35)] {
        let density = airy_density(lambda_n_px, obscuration);
        check(&PsfConfig::Airy { lambda_n_px, obscuration }, 10.0, |centre| integrated(&density, centre));
    }
}

/// The flux within r is 1 − J₀²(v) − J₁²(v) (Lord Rayleigh 1881; Born & Wolf 1999, Eq. 8.5.18): 83.8 % within
/// the first dark ring, where pixels cut by the circle do not matter.
#[test]
fn the_flux_within_the_dark_rings_of_an_airy_image_is_rayleighs() {
    let mut psf = Psf::new(&PsfConfig::Airy { lambda_n_px: [8.0, 8.0], obscuration: 0.0 }).unwrap();
    let pixels = image(&mut psf, PixelPoint::new(MIDDLE, MIDDLE));
    // The first two zeros of J₁.
    for v in [3.831_705_970_2, 7.015_586_669_8] {
        let radius_px = v / PI * 8.0;
        let inside: f64 = (0..SIDE * SIDE)
            .filter(|k| libm::hypot((k % SIDE) as f64 - MIDDLE, (k / SIDE) as f64 - MIDDLE) < radius_px)
            .map(|k| pixels[k])
            .sum();
        let expected = 1.0 - libm::j0(v) * libm::j0(v);
        assert!((inside - expected).abs() < 1e-4, "within {radius_px} px {inside}, expected {expected}");
    }
}

/// The disk as 64 × 25 points, each a Gaussian with its closed integral over the pixels: Gauss's rule along
/// the radius, equal angles around.
#[test]
fn a_defocused_image_is_a_disk_of_gaussians() {
    for (radius_px, sigma_px) in [(2.0, 0.5), (4.3, 0.7), (0.8, 0.6)] {
        let mut gaussian = Psf::new(&PsfConfig::Gaussian { sigma_px }).unwrap();
        let disk: Vec<(f64, f64, f64)> = (0..25 * 64)
            .map(|i| {
                let ((u, weight), part, angle) =
                    (GAUSS[i % 5], (i / 5 % 5) as f64, (i / 25) as f64 * PI / 32.0);
                let radius = radius_px * (part + 0.5 + 0.5 * u) / 5.0;
                let (sin, cos) = libm::sincos(angle);
                let share = 2.0 * radius / (radius_px * radius_px) * weight * 0.5 * radius_px / 5.0 / 64.0;
                (radius * cos, radius * sin, share)
            })
            .collect();
        let mut centres = Vec::new();
        let witness = std::cell::RefCell::new((&mut gaussian, &mut centres, Stamp::new()));
        check(&PsfConfig::Defocus { radius_px, sigma_px }, 10.0, |centre| {
            let (gaussian, points, stamp) = &mut *witness.borrow_mut();
            points.clear();
            points.extend(disk.iter().map(|&(x, y, share)| ImagePoint {
                position: PixelPoint::new(centre.x + x, centre.y + y),
                share,
            }));
            gaussian.stamp_extended(points, 1.0, 1e-13, (SIDE, SIDE), stamp);
            pixels(stamp)
        });
    }
}

/// Writes the flux of a Gaussian of 0.9 px in cells of a quarter of a pixel, centred away from the middle of
/// the file.
fn gaussian_file(folder: &tempfile::TempDir, oversampling: f64) -> PsfConfig {
    let edge =
        |i: usize, at: f64| libm::erf((i as f64 / oversampling - at) / (0.9 * std::f64::consts::SQRT_2));
    let along = |i: usize, at: f64| edge(i + 1, at) - edge(i, at);
    let row =
        |j: usize| (0..60).map(|i| (7.0 * along(i, 7.613) * along(j, 6.871)).to_string()).collect::<Vec<_>>();
    let text: Vec<String> = (0..56).map(|j| row(j).join(",")).collect();
    let path = folder.path().join("psf.csv");
    std::fs::write(&path, text.join("\n")).unwrap();
    PsfConfig::Sampled { path: path.to_string_lossy().into_owned(), oversampling }
}

#[test]
fn a_sampled_gaussian_is_the_gaussian_wherever_it_is_centred_in_its_file() {
    let folder = tempfile::tempdir().unwrap();
    let mut gaussian = Psf::new(&PsfConfig::Gaussian { sigma_px: 0.9 }).unwrap();
    let witness = std::cell::RefCell::new(&mut gaussian);
    // 3.6 cells per standard deviation: Lagrange's polynomial leaves an error of 4e-5 of the peak.
    check(&gaussian_file(&folder, 4.0), 2.0, |centre| image(&mut witness.borrow_mut(), centre));
}

#[test]
fn a_file_that_is_no_flux_matrix_is_refused_with_the_position() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("psf.csv");
    for (text, expected) in [
        ("1,2,3\n1,x,3\n1,2,3", "line 2, cell 2 is `x`"),
        ("1,2,3\n1,-2,3\n1,2,3", "line 2, cell 2 is `-2`"),
        ("1,2,3\n1,2\n1,2,3", "line 2 has 2 cells"),
        ("1,2,3\n1,2,3", "2 rows"),
        ("0,0,0\n0,0,0\n0,0,0", "sum is 0"),
        ("", "0 rows"),
    ] {
        std::fs::write(&path, text).unwrap();
        let config = PsfConfig::Sampled { path: path.to_string_lossy().into_owned(), oversampling: 2.0 };
        let message = Psf::new(&config).unwrap_err().to_string();
        assert!(message.contains("psf.csv") && message.contains(expected), "{message}");
    }
    let config = PsfConfig::Sampled { path: "nowhere.csv".into(), oversampling: 2.0 };
    assert!(Psf::load(&config, folder.path()).unwrap_err().to_string().contains("nowhere.csv"));
}

/// Camera of 41 × 41 pixels with the principal point in the middle: ρ = 1 in every corner.
fn camera() -> Camera {
    Camera {
        columns: SIDE,
        rows: SIDE,
        focal_length_mm: 20.0,
        pixel_width_um: 8.0,
        pixel_height_um: 8.0,
        principal_x_px: MIDDLE,
        principal_y_px: MIDDLE,
        radial: [0.0; 3],
        tangential: [0.0; 2],
    }
}

/// A shape widened in its coordinates and integrated over unchanged pixels equals a shape of larger sizes.
#[test]
fn an_image_off_the_centre_is_wider_with_the_same_flux() {
    let folder = tempfile::tempdir().unwrap();
    let file = gaussian_file(&folder, 4.0);
    let PsfConfig::Sampled { path, .. } = &file else { unreachable!("a file was asked for") };
    let pairs = |s: f64| {
        [
            (PsfConfig::Gaussian { sigma_px: 0.7 }, PsfConfig::Gaussian { sigma_px: 0.7 * s }),
            (
                PsfConfig::Moffat { fwhm_px: 1.5, beta: 3.0 },
                PsfConfig::Moffat { fwhm_px: 1.5 * s, beta: 3.0 },
            ),
            (
                PsfConfig::Airy { lambda_n_px: [0.9, 1.0], obscuration: 0.2 },
                PsfConfig::Airy { lambda_n_px: [0.9 * s, s], obscuration: 0.2 },
            ),
            (
                PsfConfig::Defocus { radius_px: 1.4, sigma_px: 0.4 },
                PsfConfig::Defocus { radius_px: 1.4 * s, sigma_px: 0.4 * s },
            ),
            (file.clone(), PsfConfig::Sampled { path: path.clone(), oversampling: 4.0 / s }),
        ]
    };
    for growth in [0.8, -0.4] {
        let at = PixelPoint::new(MIDDLE + 7.3, MIDDLE - 6.1);
        // ρ² = (7.3² + 6.1²)/(2 · 20.5²).
        let scale = 1.0 + growth * (7.3 * 7.3 + 6.1 * 6.1) / (2.0 * 20.5 * 20.5);
        for (narrow, wide) in pairs(scale) {
            let ours = image(&mut Psf::new(&narrow).unwrap().with_growth(growth, &camera()), at);
            let expected = image(&mut Psf::new(&wide).unwrap(), at);
            for (a, b) in ours.iter().zip(&expected) {
                // The limits of a mixture or a table do not scale with the image.
                assert!((a - b).abs() < 1e-5, "{narrow:?} at scale {scale}: {a:e}, expected {b:e}");
            }
        }
    }
}

#[test]
fn a_brighter_object_reaches_farther_and_no_pixel_above_the_floor_is_beyond() {
    let folder = tempfile::tempdir().unwrap();
    for config in [
        PsfConfig::Gaussian { sigma_px: 0.7 },
        PsfConfig::Moffat { fwhm_px: 1.5, beta: 3.0 },
        PsfConfig::Airy { lambda_n_px: [0.9, 1.0], obscuration: 0.0 },
        PsfConfig::Defocus { radius_px: 1.4, sigma_px: 0.4 },
        gaussian_file(&folder, 4.0),
    ] {
        let mut psf = Psf::new(&config).unwrap();
        assert_eq!(psf.reach_px(0.0, Psf::FLOOR_E), 0.0);
        let mut last_px = 0.0;
        for electrons in [1.0, 1e2, 1e3] {
            let reach_px = psf.reach_px(electrons, Psf::FLOOR_E);
            assert!(reach_px >= last_px, "{config:?}: {reach_px} px, {last_px} px when fainter");
            last_px = reach_px;
            for (k, share) in image(&mut psf, PixelPoint::new(MIDDLE, MIDDLE)).iter().enumerate() {
                let away = ((k % SIDE) as f64 - MIDDLE).abs().max(((k / SIDE) as f64 - MIDDLE).abs());
                let inside = away <= reach_px || electrons * share < Psf::FLOOR_E;
                assert!(inside, "{config:?}, {electrons} e⁻: {} at {away} px", electrons * share);
            }
        }
    }
}

#[test]
fn the_peak_share_is_that_of_a_pixel_that_the_image_is_centred_on() {
    for config in [
        PsfConfig::Moffat { fwhm_px: 1.5, beta: 3.0 },
        PsfConfig::Airy { lambda_n_px: [0.9, 1.0], obscuration: 0.2 },
        PsfConfig::Defocus { radius_px: 1.4, sigma_px: 0.4 },
    ] {
        let mut psf = Psf::new(&config).unwrap();
        let peak = image(&mut psf, PixelPoint::new(MIDDLE, MIDDLE)).into_iter().fold(0.0, f64::max);
        assert!((psf.peak_share() - peak).abs() < 1e-12, "{config:?}: {}, drawn {peak}", psf.peak_share());
    }
}

#[test]
fn numbers_out_of_range_are_refused_with_their_path() {
    for (config, field) in [
        (PsfConfig::Moffat { fwhm_px: 0.0, beta: 3.0 }, "psf.fwhm_px"),
        (PsfConfig::Moffat { fwhm_px: 1.0, beta: 1.0 }, "psf.beta"),
        (PsfConfig::Airy { lambda_n_px: [1.0, f64::NAN], obscuration: 0.0 }, "psf.lambda_n_px"),
        (PsfConfig::Airy { lambda_n_px: [1.0, 1.0], obscuration: 1.0 }, "psf.obscuration"),
        (PsfConfig::Defocus { radius_px: 60.0, sigma_px: 1.0 }, "psf.radius_px"),
        (PsfConfig::Defocus { radius_px: 20.0, sigma_px: 0.1 }, "psf.sigma_px"),
        (PsfConfig::Sampled { path: "x.csv".into(), oversampling: 0.5 }, "psf.oversampling"),
    ] {
        let message = Psf::new(&config).unwrap_err().to_string();
        assert!(message.contains(field), "{message}");
    }
}
