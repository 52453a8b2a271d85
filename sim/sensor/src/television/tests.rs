use contract::PixelPoint;

use super::*;

const COLUMNS: usize = 96;
const ROWS: usize = 72;
const SEED: Seed = Seed { seed: 11, case: 0 };

/// Picture with a bright square on a grey background.
fn light(lines: Lines) -> Vec<f32> {
    let mut light = vec![0.2_f32; COLUMNS * lines.rows(ROWS)];
    for row in light.chunks_exact_mut(COLUMNS).skip(10).take(12) {
        row[30..50].fill(1.6);
    }
    light
}

fn transmitted(config: &TelevisionConfig, number: u64) -> (Vec<f32>, VideoTruth) {
    transmitted_of(light, config, number)
}

fn transmitted_of(
    light: fn(Lines) -> Vec<f32>,
    config: &TelevisionConfig,
    number: u64,
) -> (Vec<f32>, VideoTruth) {
    let lines = config.interlace.lines(number);
    let mut signal = light(lines);
    let sun = SunImage {
        centre: PixelPoint::new(70.0, 20.0),
        ghost: PixelPoint::new(20.0, 50.0),
        radius_px: 5.0,
        focal_px: 1000.0,
        visible: 1.0,
    };
    let caption = Caption { clock: "14:07:32", camera: "TV-1", range_m: 5.0, range_rate_m_s: -0.1 };
    let label =
        FieldLabel { number, time_s: number as f64 / config.field_rate_hz(), lines, sun: Some(sun), caption };
    let truth = Television::new(config, SEED, COLUMNS, ROWS).transmit(&label, &mut signal);
    (signal, truth)
}

#[test]
fn a_plain_chain_is_linear() {
    let config = TelevisionConfig {
        white_radiance: 2.0,
        pedestal: 0.1,
        noise: VideoNoiseConfig { sigma_dn8: 0.0 },
        ..TelevisionConfig::default()
    };
    let (signal, truth) = transmitted(&config, 0);
    for (signal, light) in signal.iter().zip(light(Lines::Even)) {
        assert!((signal - (0.5 * light + 0.1)).abs() < 1e-6);
    }
    assert_eq!(truth, VideoTruth { contrast: 1.0, brightness: 0.1, lost_lines: 0 });
}

type Change = fn(&mut TelevisionConfig);

const EFFECTS: [(&str, Change); 10] = [
    ("drift", |c| c.drift = Some(DriftConfig::default())),
    ("auto_gain", |c| c.auto_gain = Some(AutoGainConfig::default())),
    ("bloom", |c| c.bloom = Some(BloomConfig::default())),
    ("sun_glare", |c| c.sun_glare = Some(SunGlareConfig::default())),
    ("bandwidth", |c| c.bandwidth = Some(BandwidthConfig::default())),
    ("ringing", |c| c.ringing = Some(RingingConfig::default())),
    ("line_jitter", |c| c.line_jitter = Some(LineJitterConfig { sigma_px: 0.5 })),
    ("lost_lines", |c| c.lost_lines = Some(LostLinesConfig { probability: 0.2 })),
    ("line_level", |c| c.line_level = Some(LineLevelConfig::default())),
    ("overlay", |c| c.overlay = Some(OverlayConfig::default())),
];

#[test]
fn every_effect_changes_the_picture() {
    let plain = transmitted(&TelevisionConfig::default(), 4).0;
    for (name, change) in EFFECTS {
        let mut config = TelevisionConfig::default();
        change(&mut config);
        assert_ne!(transmitted(&config, 4).0, plain, "{name}");
    }
}

/// Noise is independent of the picture: the same numbers are added with and without an effect.
#[test]
fn an_effect_leaves_the_draws_of_noise_as_they_were() {
    for (name, change) in EFFECTS {
        let with = |sigma_dn8| {
            let mut config =
                TelevisionConfig { noise: VideoNoiseConfig { sigma_dn8 }, ..TelevisionConfig::default() };
            change(&mut config);
            // The overlay covers the noise: it must not reach the pixels that are compared.
            transmitted(&config, 4).0
        };
        let plain = |sigma_dn8| {
            let noise = VideoNoiseConfig { sigma_dn8 };
            transmitted(&TelevisionConfig { noise, ..TelevisionConfig::default() }, 4).0
        };
        let (noisy, clean, noisy_plain, clean_plain) = (with(2.0), with(0.0), plain(2.0), plain(0.0));
        let mut looked_at = 0;
        for i in 0..noisy.len() {
            if name == "overlay" && clean[i] != clean_plain[i] {
                continue;
            }
            looked_at += 1;
            let (here, there) = (noisy[i] - clean[i], noisy_plain[i] - clean_plain[i]);
            // Rounding of f32 sums.
            assert!((here - there).abs() < 1e-6, "{name} at {i}: {here} {there}");
        }
        assert!(looked_at > noisy.len() / 2);
    }
}

/// Numbers of the rows of a field in which two pictures differ.
fn changed_rows(a: &[f32], b: &[f32]) -> Vec<usize> {
    let rows = a.chunks_exact(COLUMNS).zip(b.chunks_exact(COLUMNS)).enumerate();
    rows.filter(|(_, (a, b))| a != b).map(|(k, _)| k).collect()
}

/// Picture in which all rows differ and every row reveals a shift.
fn uneven_light(lines: Lines) -> Vec<f32> {
    let mut light = light(lines);
    for (i, light) in light.iter_mut().enumerate() {
        let (x, y) = (i % COLUMNS, i / COLUMNS);
        *light += 0.005 * y as f32 + 0.01 * (x * (x + y) % 23) as f32;
    }
    light
}

/// An effect does not change the draws of lost lines: the same rows are lost, and the same ones show the same
/// snow.
#[test]
fn an_effect_leaves_the_lines_that_are_lost_as_they_were() {
    let picture = |change: Change, lost: Option<LostLinesConfig>| {
        let mut config = TelevisionConfig::default();
        change(&mut config);
        config.lost_lines = lost;
        transmitted_of(uneven_light, &config, 4).0
    };
    let lost = |change| {
        changed_rows(&picture(change, Some(LostLinesConfig { probability: 0.2 })), &picture(change, None))
    };
    let alone = lost(|_| ());
    assert!(alone.len() > 3, "{alone:?}");
    for (name, change) in EFFECTS {
        assert_eq!(lost(change), alone, "{name}");
    }
}

/// An effect does not change the shifts of lines. An effect before the jitter changes the picture, which is
/// then shifted by the same amounts; an effect after the jitter changes shifted and unshifted pictures
/// equally.
#[test]
fn an_effect_leaves_the_shifts_of_lines_as_they_were() {
    let jitter = LineJitterConfig { sigma_px: 0.5 };
    let picture = |change: Change, line_jitter: Option<LineJitterConfig>| {
        let noise = VideoNoiseConfig { sigma_dn8: 0.0 };
        let mut config = TelevisionConfig { noise, ..TelevisionConfig::default() };
        change(&mut config);
        config.line_jitter = line_jitter;
        transmitted_of(uneven_light, &config, 4).0
    };
    let (plain, plain_shifted) = (picture(|_| (), None), picture(|_| (), Some(jitter)));
    for (name, change) in EFFECTS {
        let (still, shifted) = (picture(change, None), picture(change, Some(jitter)));
        let comes_after = ["lost_lines", "overlay"].contains(&name);
        let mut expected = still.clone();
        jitter.apply(&SEED, 4, Lines::Even, &mut expected, COLUMNS, &mut Vec::new());
        let mut compared = 0;
        for i in 0..shifted.len() {
            if comes_after && still[i] != plain[i] {
                continue;
            }
            compared += 1;
            let expected = if comes_after { plain_shifted[i] } else { expected[i] };
            // Rounding of f32 sums.
            assert!((shifted[i] - expected).abs() < 1e-5, "{name} at {i}: {} {expected}", shifted[i]);
        }
        assert!(compared > shifted.len() / 2, "{name}");
    }
}

#[test]
fn a_field_alone_is_the_field_of_the_run() {
    let config = TelevisionConfig::all();
    let mut chain = Television::new(&config, SEED, COLUMNS, ROWS);
    let caption = Caption { clock: "00:00:00", camera: "TV-1", range_m: 5.0, range_rate_m_s: 0.0 };
    let expose = |chain: &mut Television, number: u64| {
        let lines = config.interlace.lines(number);
        let label = FieldLabel { number, time_s: 0.02 * number as f64, lines, sun: None, caption };
        let mut signal = light(lines);
        let truth = chain.transmit(&label, &mut signal);
        (signal, truth)
    };
    let run: Vec<_> = (0..6).map(|number| expose(&mut chain, number)).collect();
    for number in [5, 2] {
        let mut fresh = Television::new(&config, SEED, COLUMNS, ROWS);
        assert_eq!(expose(&mut fresh, number), run[number as usize]);
    }
}

#[test]
fn fields_alternate_and_progressive_frames_hold_every_row() {
    let lines = |interlace: Interlace| [0, 1, 2].map(|field| interlace.lines(field));
    assert_eq!(lines(Interlace::TopFirst), [Lines::Even, Lines::Odd, Lines::Even]);
    assert_eq!(lines(Interlace::BottomFirst), [Lines::Odd, Lines::Even, Lines::Odd]);
    assert_eq!(lines(Interlace::Off), [Lines::All; 3]);
    let off = TelevisionConfig { interlace: Interlace::Off, ..TelevisionConfig::default() };
    assert_eq!((off.field_rate_hz(), TelevisionConfig::default().field_rate_hz()), (25.0, 50.0));
}

#[test]
fn bad_values_are_refused_with_their_path() {
    let refused = |path: &str, change: Change| {
        let mut config = TelevisionConfig::all();
        change(&mut config);
        let message = config.check().unwrap_err().to_string();
        assert!(message.starts_with(path), "{message}");
    };
    assert!(TelevisionConfig::all().check().is_ok());
    refused("television.frame_rate_hz", |c| c.frame_rate_hz = 0.0);
    refused("television.white_radiance", |c| c.white_radiance = f64::NAN);
    refused("television.pedestal", |c| c.pedestal = 2.0);
    refused("television.clip_level", |c| c.clip_level = 0.5);
    refused("television.noise.sigma_dn8", |c| c.noise.sigma_dn8 = -1.0);
    refused("television.drift.periods_s", |c| {
        c.drift = Some(DriftConfig { periods_s: vec![], ..DriftConfig::default() })
    });
    refused("television.auto_gain.least", |c| {
        c.auto_gain = Some(AutoGainConfig { least: 0.0, ..AutoGainConfig::default() });
    });
    refused("television.bloom.sigma_px", |c| c.bloom = Some(BloomConfig { share: 0.1, sigma_px: 1.0 }));
    refused("television.sun_glare.disk_level", |c| {
        c.sun_glare = Some(SunGlareConfig { disk_level: -1.0, ..SunGlareConfig::default() });
    });
    refused("television.bandwidth.sigma_px", |c| c.bandwidth = Some(BandwidthConfig { sigma_px: 99.0 }));
    refused("television.ringing.period_px", |c| {
        c.ringing = Some(RingingConfig { period_px: 0.0, ..RingingConfig::default() });
    });
    refused("television.line_jitter.sigma_px", |c| c.line_jitter = Some(LineJitterConfig { sigma_px: 2.0 }));
    refused("television.lost_lines.probability", |c| {
        c.lost_lines = Some(LostLinesConfig { probability: 1.5 })
    });
    refused("television.line_level.hum_period_rows", |c| {
        c.line_level = Some(LineLevelConfig { hum_period_rows: 0.0, ..LineLevelConfig::default() });
    });
    refused("television.overlay.level", |c| c.overlay.get_or_insert_default().level = f64::INFINITY);
    refused("television.overlay.range_error", |c| c.overlay.get_or_insert_default().range_error = 1.0);
    refused("television.overlay.range_rate_error_m_s", |c| {
        c.overlay.get_or_insert_default().range_rate_error_m_s = -1.0;
    });
}
