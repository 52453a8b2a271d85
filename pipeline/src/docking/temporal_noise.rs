//! Noise from field to field: detection of repeated pictures and of mixtures of successive pictures.
//!
//! The noise of a live picture is new in every field. With the noise n_k of field k of variance σ², the
//! difference between two fields has the variance 2σ², and successive differences between fields of the same
//! rows have the correlation −1/2. A picture that is frozen has less new noise than the noise between its own
//! pixels shows and than the fields before had, whatever noise or coding came on top. If a share a of the
//! picture two fields ago remains in each picture (noise reduction, a camera's lag, a codec), the noise is a
//! first-order process, whose differences have the correlation −(1 − a)/2: the picture then is that of an
//! earlier time, 2T a/(1 − a) on average for the time T between fields. Fields that share picture with the
//! other one of their frame (deinterlaced, coded as frames) have less new noise since that one than since the
//! field before of the same rows. A steady motion correlates differences, too, those of fields farther apart
//! as well: this part is subtracted.

use std::collections::VecDeque;

use contract::docking::{Field, Lines};

/// Age of the picture of a field, by its noise.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct PictureAge {
    /// True if the picture is an earlier one, with new noise or coded again.
    pub(crate) is_repeated: bool,
    /// Standard deviation of the time of the picture before that of its field, s.
    pub(crate) sigma_s: f64,
}

/// Ratio of the new noise to the noise between pixels below which a picture is repeated, and above which one
/// is live again after that. A live picture has 0.9 to 1, or more if its noise is blurred or coded; strong
/// noise reduction 0.3; a frozen picture with new noise of half its own 0.2.
const MIN_NEW_NOISE: f64 = 0.3;
const LIVE_NEW_NOISE: f64 = 0.6;

/// This limit between the two fields of a frame: a field made from the other one and coded has none, a strong
/// noise reduction 0.15.
const MIN_NEW_NOISE_IN_FRAME: f64 = 0.1;

/// Share of the picture two fields ago below which none is noticed, and the same for a single pixel: six
/// standard deviations of its estimate.
const MIN_REMAINING: f64 = 0.05;
const MIN_REMAINING_OF_PIXEL: f64 = 9.0;

/// Ratio of new noise below which, and share of unchanged pixels above which, an earlier picture may remain.
/// Live pictures have 0.14 unchanged with noise of 2 of 255 DN, coded ones 0.6 to 0.9.
const MAX_MIXED_NOISE: f64 = 0.97;
const MIN_UNCHANGED: f64 = 0.5;

/// Number of live fields before a picture can count as frozen.
const MIN_LIVE_FIELDS: u32 = 4;

/// Standard deviation of the time of the picture over its mean delay, and its largest value, s: a codec
/// refreshes what has moved.
const SIGMA_PER_DELAY: f64 = 2.0;
const MAX_SIGMA_S: f64 = 0.08;

/// Ratio of the noise that is new since the other field of a frame to the noise between pixels below which
/// the two fields share picture, and the standard deviation of their times then, s: half of the time between
/// them.
const MIN_OWN_NOISE: f64 = 0.85;
const MIXED_SIGMA_S: f64 = 0.01;

/// Longest time between a field and that two, four and six fields before, s.
const MAX_APART_S: f64 = 0.06;
const MAX_FAR_APART_S: f64 = 0.12;
const MAX_FARTHEST_APART_S: f64 = 0.17;

/// Rows from one row that is evaluated to the next.
const ROW_STEP: usize = 4;

/// Range of brightness, and largest difference that counts as noise, as shares of the full scale. Black and
/// white are clipped and have no noise.
const DARKEST: f64 = 0.05;
const BRIGHTEST: f64 = 0.94;
const MAX_NOISE: f64 = 0.08;

/// Smallest number of pixels that determine a ratio or a correlation.
const MIN_PIXELS: usize = 2000;

/// Smallest variance of the noise between pixels, (full scale)², with which a picture is compared: 0.2 of
/// 255 DN.
const MIN_VARIANCE: f64 = 6e-7;

/// Smallest variance of differences, (full scale)², whose correlation is used: 0.14 of 255 DN.
const MIN_DIFFERENCE: f64 = 3e-7;

/// Largest correlation of successive differences of noise. Differences that the motion makes have a larger
/// one.
const MAX_CORRELATION: f64 = 0.05;

/// Fields in memory.
const MEMORY: usize = 6;

/// Comparison of each field with the ones before it.
#[derive(Debug, Clone, Default)]
pub(crate) struct TemporalNoise {
    last: VecDeque<PastField>,
    is_frozen: bool,
    /// Number of fields so far that had new noise: a picture without noise is not frozen.
    live_fields: u32,
    /// True if the last field shared picture with the other one of its frame.
    was_mixed: bool,
}

#[derive(Debug, Clone)]
struct PastField {
    lines: Lines,
    time_s: f64,
    dn: Vec<u16>,
}

impl PastField {
    /// Returns the value of a pixel, DN.
    fn value(&self, at: usize) -> f64 {
        f64::from(self.dn[at])
    }
}

/// Sums over the flat pixels of a field.
#[derive(Debug, Clone, Copy, Default)]
struct Sums {
    pixels: usize,
    /// Number of pixels without a difference to the field before.
    unchanged: usize,
    /// Σ of the difference to the field before, and of its square, clipped.
    difference: f64,
    squares: f64,
    /// Σ of the square of the difference between a pixel and the mean of its neighbours.
    between_pixels: f64,
}

impl TemporalNoise {
    /// Adds a field and compares it with the last fields.
    pub(crate) fn add(&mut self, field: &Field, time_s: f64) -> PictureAge {
        let image = field.image();
        let now = PastField { lines: field.lines(), time_s, dn: image.dn().to_vec() };
        let size = (image.columns(), image.rows());
        let full_scale = f64::from(image.full_scale_dn());
        let age = self.age(&now, size, full_scale);
        self.last.push_front(now);
        self.last.truncate(MEMORY);
        age
    }

    fn age(&mut self, now: &PastField, size: (usize, usize), full_scale: f64) -> PictureAge {
        let is_comparable = |before: &&PastField, apart_s: f64| {
            let elapsed_s = now.time_s - before.time_s;
            before.dn.len() == now.dn.len() && elapsed_s > 0.0 && elapsed_s <= apart_s
        };
        let other_rows = self.last.front().filter(|other| other.lines != now.lines);
        let in_frame = other_rows
            .filter(|other| is_comparable(other, MAX_APART_S))
            .and_then(|other| new_noise(&FlatPixels::new(now, other, size, full_scale)));
        let is_live = self.live_fields >= MIN_LIVE_FIELDS;
        let is_copy = in_frame.is_some_and(|new| is_live && new.ratio < MIN_NEW_NOISE_IN_FRAME)
            || other_rows.is_some_and(|other| other.dn == now.dn);
        let mut same_rows = self.last.iter().filter(|before| before.lines == now.lines);
        let before = same_rows.next().filter(|before| is_comparable(before, MAX_APART_S));
        let earlier = same_rows.next().filter(|earlier| is_comparable(earlier, MAX_FAR_APART_S));
        let first = same_rows.next().filter(|first| is_comparable(first, MAX_FARTHEST_APART_S));
        let Some(before) = before else {
            (self.is_frozen, self.live_fields, self.was_mixed) = (false, 0, false);
            return PictureAge { is_repeated: is_copy, sigma_s: 0.0 };
        };
        let flat = FlatPixels::new(now, before, size, full_scale);
        let new = new_noise(&flat);
        let ratio = new.map(|new| new.ratio);
        self.is_frozen = match ratio {
            Some(ratio) if self.is_frozen => ratio < LIVE_NEW_NOISE,
            Some(ratio) => is_live && ratio < MIN_NEW_NOISE,
            None => false,
        };
        self.live_fields += u32::from(ratio.is_some_and(|ratio| ratio >= LIVE_NEW_NOISE));
        let is_mixed = in_frame.is_some_and(|new| new.ratio < MIN_OWN_NOISE);
        let mixed_s = if is_mixed || self.was_mixed { MIXED_SIGMA_S } else { 0.0 };
        self.was_mixed = is_mixed;
        // With too few fields: a first-order process of white noise has the share 1 − ratio.
        let share = new.filter(NewNoise::may_be_mixed).and_then(|new| {
            earlier
                .zip(first)
                .and_then(|(earlier, first)| remaining(&flat, earlier, first))
                .or(Some(1.0 - new.ratio))
        });
        let remaining_s = share.map_or(0.0, |share| sigma_s(share, now.time_s - before.time_s));
        PictureAge { is_repeated: self.is_frozen || is_copy, sigma_s: libm::hypot(remaining_s, mixed_s) }
    }
}

/// Returns the standard deviation of the time of a picture in which a share of the one before by `period_s`
/// remains, s.
fn sigma_s(share: f64, period_s: f64) -> f64 {
    if share < MIN_REMAINING {
        return 0.0;
    }
    let delay_s = if share < 1.0 { period_s * share / (1.0 - share) } else { f64::INFINITY };
    (SIGMA_PER_DELAY * delay_s).min(MAX_SIGMA_S)
}

/// Noise of a field that is new since another one.
#[derive(Debug, Clone, Copy)]
struct NewNoise {
    /// Its variance over that of the noise between pixels.
    ratio: f64,
    /// Share of the pixels that are unchanged.
    unchanged: f64,
}

impl NewNoise {
    /// Returns true if a part of an earlier picture may remain: less noise is new than in a live picture, or
    /// a codec has copied most pixels. Otherwise the motion makes successive differences alike.
    fn may_be_mixed(&self) -> bool {
        self.ratio < MAX_MIXED_NOISE || self.unchanged > MIN_UNCHANGED
    }
}

/// Returns the noise that is new since the other field of a pair; `None` if there is too little of it.
fn new_noise(flat: &FlatPixels<'_>) -> Option<NewNoise> {
    let (now, before, full_scale) = (flat.now, flat.before, flat.full_scale);
    let mut sums = Sums { pixels: flat.indices.len(), ..Sums::default() };
    for &at in &flat.indices {
        let difference = flat.clipped(now.value(at) - before.value(at));
        let beside = 0.5 * (now.value(at - 1) + now.value(at + 1));
        let between = flat.clipped(now.value(at) - beside);
        sums.unchanged += usize::from(difference == 0.0);
        sums.difference += difference;
        sums.squares += difference * difference;
        sums.between_pixels += between * between;
    }
    if sums.pixels < MIN_PIXELS {
        return None;
    }
    let count = sums.pixels as f64;
    let mean = sums.difference / count;
    // Var(n_k − n_j) = 2σ²; Var[n(x) − (n(x − 1) + n(x + 1))/2] = 1.5σ².
    let new = (sums.squares / count - mean * mean) / 2.0;
    let between = sums.between_pixels / count / 1.5;
    (between > MIN_VARIANCE * full_scale * full_scale)
        .then(|| NewNoise { ratio: new / between, unchanged: sums.unchanged as f64 / count })
}

/// Returns the share of the picture two fields ago that remains, 1 + 2r for the correlation r of successive
/// differences without the part of a steady motion; `None` without noise to tell. `flat` is of the field and
/// the one before it; `earlier` and `first` precede these. All have the same rows.
fn remaining(flat: &FlatPixels<'_>, earlier: &PastField, first: &PastField) -> Option<f64> {
    let (now, before, full_scale) = (flat.now, flat.before, flat.full_scale);
    let pixels = flat.indices.len();
    let (mut successive, mut apart, mut squares) = (0.0, 0.0, [0.0; 2]);
    for &at in &flat.indices {
        let latest = flat.clipped(now.value(at) - before.value(at));
        let last = flat.clipped(before.value(at) - earlier.value(at));
        let one_before = flat.clipped(earlier.value(at) - first.value(at));
        successive += latest * last;
        apart += latest * one_before;
        squares[0] += latest * latest;
        squares[1] += last * last;
    }
    // Differences that are not successive have no noise in common but that of what remains, whose product is
    // negative.
    let of_motion = f64::max(apart, 0.0);
    let [latest, last] = squares;
    let noise = (latest * last).sqrt() - of_motion;
    let products = successive - of_motion;
    let smallest = MIN_DIFFERENCE * full_scale * full_scale * pixels as f64;
    let is_noise = pixels >= MIN_PIXELS && noise > smallest && products <= MAX_CORRELATION * noise;
    let share = 1.0 + 2.0 * products / noise;
    let is_significant = share * (pixels as f64).sqrt() > MIN_REMAINING_OF_PIXEL;
    is_noise.then_some(if is_significant { share } else { 0.0 })
}

/// Pixels of a pair of fields in which differences are noise: small, neither black nor white nor beside an
/// edge, in every fourth row; of those, the half with the smallest differences to their neighbours.
struct FlatPixels<'a> {
    now: &'a PastField,
    before: &'a PastField,
    /// Indices, ascending.
    indices: Vec<usize>,
    full_scale: f64,
}

impl<'a> FlatPixels<'a> {
    fn new(
        now: &'a PastField,
        before: &'a PastField,
        (columns, rows): (usize, usize),
        full_scale: f64,
    ) -> Self {
        // Sums of two fields: they halve the noise and keep the picture.
        let both = |row: usize| -> Vec<u32> {
            let range = row * columns..(row + 1) * columns;
            let dn = |field: &'a PastField| field.dn.get(range.clone()).unwrap_or_default();
            dn(now).iter().zip(dn(before)).map(|(a, b)| u32::from(*a) + u32::from(*b)).collect()
        };
        let grey = 2.0 * DARKEST..2.0 * BRIGHTEST;
        let mut steep: Vec<(usize, u32)> = Vec::with_capacity(columns * rows / ROW_STEP);
        for row in (1..rows.saturating_sub(1)).step_by(ROW_STEP) {
            let [above, middle, below] = [row - 1, row, row + 1].map(both);
            for (column, beside) in middle.windows(3).enumerate() {
                let [left, value, right] = *beside else { continue };
                let column = column + 1;
                let at = row * columns + column;
                // A field that is black, or much brighter than the one before, differs by more than noise.
                let is_noise = (now.value(at) - before.value(at)).abs() <= MAX_NOISE * full_scale;
                if is_noise && grey.contains(&(f64::from(value) / full_scale)) {
                    let slope = left.abs_diff(right) + above[column].abs_diff(below[column]);
                    steep.push((at, slope));
                }
            }
        }
        let mut slopes: Vec<u32> = steep.iter().map(|(_, slope)| *slope).collect();
        let half = slopes.len() / 2;
        let limit = if half == 0 { None } else { Some(*slopes.select_nth_unstable(half).1) };
        let is_flat = |(_, slope): &&(usize, u32)| limit.is_some_and(|limit| *slope <= limit);
        let indices = steep.iter().filter(is_flat).map(|(at, _)| *at).collect();
        Self { now, before, indices, full_scale }
    }

    /// Returns the difference of two values, DN, limited to what counts as noise.
    fn clipped(&self, difference: f64) -> f64 {
        let limit = MAX_NOISE * self.full_scale;
        difference.clamp(-limit, limit)
    }
}

#[cfg(test)]
mod tests {
    use super::super::synthetic;
    use super::*;

    /// Returns a normal number, from the sum of twelve uniform ones of a linear congruential sequence.
    fn normal(state: &mut u64) -> f64 {
        let mut uniform = || {
            *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (*state >> 33) as f64 / (1_u64 << 31) as f64
        };
        (0..12).map(|_| uniform()).sum::<f64>() - 6.0
    }

    const SIDE: (usize, usize) = (768, 288);

    /// Returns the noise of a picture, DN.
    fn noise(seed: u64, sigma_dn: f64) -> Vec<f64> {
        let mut state = seed;
        (0..SIDE.0 * SIDE.1).map(|_| sigma_dn * normal(&mut state)).collect()
    }

    /// Returns a field of a grey picture with tiles.
    fn field(noise: &[f64], lines: Lines) -> Field {
        synthetic::drawn(lines, |x, y| {
            let tile = if (x / 60 + y / 80) % 2 == 0 { 90.0 } else { 120.0 };
            (tile + noise[(y / 2) * SIDE.0 + x]).round().clamp(0.0, 255.0) as u16
        })
    }

    fn lines(k: usize) -> Lines {
        if k.is_multiple_of(2) { Lines::Even } else { Lines::Odd }
    }

    /// Returns the results for fields with noise.
    fn ages(noises: &[Vec<f64>]) -> Vec<PictureAge> {
        let mut temporal = TemporalNoise::default();
        noises
            .iter()
            .enumerate()
            .map(|(k, noise)| temporal.add(&field(noise, lines(k)), 0.02 * k as f64))
            .collect()
    }

    fn sum(a: &[f64], a_share: f64, b: &[f64], b_share: f64) -> Vec<f64> {
        a.iter().zip(b).map(|(a, b)| a_share * a + b_share * b).collect()
    }

    #[test]
    fn a_live_picture_is_new() {
        let noises: Vec<Vec<f64>> = (0..8).map(|k| noise(k + 1, 2.0)).collect();
        assert!(ages(&noises).iter().all(|age| *age == PictureAge::default()));
    }

    #[test]
    fn a_frozen_picture_with_new_noise_is_repeated_until_it_is_live() {
        let live = |k: usize| noise(k as u64 + 1, 2.0);
        let frozen = |k: usize| sum(&live(6 + k % 2), 1.0, &noise(100 + k as u64, 1.0), 1.0);
        let noises: Vec<Vec<f64>> =
            (0..8).map(live).chain((8..14).map(frozen)).chain((14..17).map(live)).collect();
        let repeated: Vec<bool> = ages(&noises).iter().map(|age| age.is_repeated).collect();
        assert_eq!(repeated.iter().filter(|is_repeated| **is_repeated).count(), 6, "{repeated:?}");
        assert!(repeated[8..14].iter().all(|is_repeated| *is_repeated), "{repeated:?}");
    }

    /// All pixels of a black field, or after a step of the brightness, differ by the same amount: this is no
    /// lack of noise.
    #[test]
    fn a_live_picture_after_a_black_field_or_a_step_of_brightness_is_new() {
        let offset = |k: usize| match k {
            6 | 11 => -300.0,
            14.. => 60.0,
            _ => 0.0,
        };
        let noises: Vec<Vec<f64>> = (0..20)
            .map(|k| noise(k as u64 + 1, 2.0).iter().map(|noise| noise + offset(k)).collect())
            .collect();
        let repeated: Vec<bool> = ages(&noises).iter().map(|age| age.is_repeated).collect();
        assert!(repeated.iter().all(|is_repeated| !is_repeated), "{repeated:?}");
    }

    #[test]
    fn a_field_made_from_the_other_one_of_its_frame_is_repeated() {
        let live: Vec<Vec<f64>> = (0..4).map(|k| noise(k + 1, 2.0)).collect();
        let noises: Vec<Vec<f64>> = (0..8).map(|k| live[k / 2].clone()).collect();
        let repeated: Vec<bool> = ages(&noises).iter().map(|age| age.is_repeated).collect();
        assert!((0..8).all(|k| repeated[k] == (k % 2 == 1)), "{repeated:?}");
    }

    #[test]
    fn the_delay_of_an_averaged_picture_is_found() {
        // Half of the picture two fields ago remains: 0.04 s on average.
        let mut noises: Vec<Vec<f64>> = (0..2).map(|k| noise(k + 1, 4.0)).collect();
        for k in 2..16 {
            noises.push(sum(&noise(k as u64 + 1, 4.0), 0.5, &noises[k - 2], 0.5));
        }
        let sigma_s = ages(&noises)[15].sigma_s;
        assert!((0.03..=MAX_SIGMA_S).contains(&sigma_s), "{sigma_s}");
        assert!(!ages(&noises)[15].is_repeated);
    }

    #[test]
    fn a_picture_without_noise_is_not_judged() {
        let still: Vec<Vec<f64>> = (0..6).map(|k| vec![f64::from(k % 2); SIDE.0 * SIDE.1]).collect();
        assert!(ages(&still).iter().all(|age| *age == PictureAge::default()));
    }
}
