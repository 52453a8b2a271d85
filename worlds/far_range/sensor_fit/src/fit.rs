//! The steps in order.

use libm::{log, sqrt};
use rayon::prelude::*;

use crate::defects::{DEAD_RESPONSE, Defect, dead_columns, noisy_limit, ordinary_limits};
use crate::figures::{DefectCounts, Finding, HotPixels, LevelSummary, SaturationLimit, SensorFigures};
use crate::linearity::{LinearityLevel, linearity_error};
use crate::moments::{FrameChange, GoodPixels, PixelMaps, StackMoments, Variance, pixel_maps, stack_moments};
use crate::patterns::{
    DarkSignal, MeasuredStack, offset_pattern, response_pattern, response_sum, rise_pattern, smooth_surface,
};
use crate::photon_transfer::{
    BIAS, CUBIC, CURVATURE, DARK, INVERSE_GAIN, LIGHT, READ_VARIANCE, TransferFit, TransferPoint,
    fit_transfer, linear_signal, signal_of_mean, slope_at, variance_at,
};
use crate::rounding::{ROUNDING_VARIANCE, RoundedNoise, rounding_of_mean, unrounded_variance};
use crate::saturation::{
    FULL_SHARE, MAX_SHARE_OF_ALL, MAX_SHARE_OF_GOOD, StackState, bits_of_full_scale, states_of_levels,
};
use crate::stack::{FrameStack, SensorFitError, SensorFrames};

/// Share of the largest digital number up to which the dark signal of a hot pixel counts.
const MAX_SHARE_OF_HOT: f64 = 0.9;

/// Temporal noise below which its figure is an upper limit, DN (EMVA 1288: a variance of 0.24 DN² with that
/// of the rounding).
const NOISE_LIMIT_DN: f64 = 0.4;

/// Relative difference of a variance from the photon transfer up to which a level is linear.
const LINEAR_VARIANCE: f64 = 0.05;

/// Temporal variance from which means follow offsets to 2 %, DN²: below, the rounding hides or doubles them.
const MIN_VARIANCE_OF_OFFSETS: f64 = 0.22;

/// Standard deviation of the rounding, DN: pixels do not differ less.
const MIN_STEP_DN: f64 = 0.29;

/// Relative changes of the light within a level that are reported.
const MIN_DRIFT: f64 = 1e-3;

/// A stack with everything that is measured of it.
struct Measured<'a> {
    stack: &'a FrameStack,
    kind: &'static str,
    maps: PixelMaps,
    moments: StackMoments,
    state: StackState,
}

impl Measured<'_> {
    fn is_used(&self) -> bool {
        self.state == StackState::Used
    }

    /// True for a used stack without light whose noise carries offsets through the rounding.
    fn shows_offsets(&self) -> bool {
        self.is_used()
            && self.kind != "flat"
            && self.moments.pixel[0] - ROUNDING_VARIANCE > MIN_VARIANCE_OF_OFFSETS
    }

    fn view(&self) -> MeasuredStack<'_> {
        MeasuredStack { time_s: self.stack.time_s, maps: &self.maps, moments: &self.moments }
    }
}

/// Determines the figures of a sensor.
///
/// # Errors
/// [`SensorFitError`] for frames that cannot be stacks of one sensor. A figure that sound frames do not
/// determine is [`Finding::Missing`] instead.
pub fn fit_sensor(frames: &SensorFrames) -> Result<SensorFigures, SensorFitError> {
    frames.check()?;
    let shifted_bits = frames.shifted_bits();
    let shifted;
    let frames = if shifted_bits > 0 {
        shifted = shifted_down(frames, shifted_bits);
        &shifted
    } else {
        frames
    };
    let top = frames.stacks().flat_map(|stack| &stack.frames).flatten().copied().max().unwrap_or(0);
    let mut good = GoodPixels {
        columns: frames.columns,
        rows: frames.rows,
        is_good: vec![true; frames.columns * frames.rows],
    };
    // Moments of all pixels find the defects; those of the good pixels give the figures.
    let mut stacks = measure(frames, &good, top);
    check_order(&stacks)?;
    let (defects, shows_dead) = find_defects(&stacks, &good);
    good.is_good = defects.iter().map(|defect| !defect.is_any()).collect();
    remeasure(&mut stacks, &good, top);
    let transfer = transfer_of(&mut stacks);
    Ok(Fit { frames, shifted_bits, top, good, stacks, defects, shows_dead, transfer }.figures())
}

/// Returns frames with the numbers of the converter instead of shifted ones.
fn shifted_down(frames: &SensorFrames, bits: u32) -> SensorFrames {
    let mut shifted = frames.clone();
    for stack in shifted.bias.iter_mut().chain(&mut shifted.darks).chain(&mut shifted.flats) {
        stack.frames.iter_mut().flatten().for_each(|dn| *dn >>= bits);
    }
    shifted.stored_bits = frames.stored_bits.saturating_sub(bits as u8).max(8);
    shifted
}

/// Returns all stacks with their moments over the good pixels.
fn measure<'a>(frames: &'a SensorFrames, good: &GoodPixels, top: u16) -> Vec<Measured<'a>> {
    let kinds: Vec<(&FrameStack, &'static str)> = (frames.bias.iter().map(|stack| (stack, "bias")))
        .chain(frames.darks.iter().map(|stack| (stack, "dark")))
        .chain(frames.flats.iter().map(|stack| (stack, "flat")))
        .collect();
    let mut stacks: Vec<Measured<'a>> = kinds
        .into_par_iter()
        .map(|(stack, kind)| {
            let maps = pixel_maps(stack);
            let moments = stack_moments(stack, &maps, good, FrameChange::Offset, top);
            Measured { stack, kind, maps, moments, state: StackState::Used }
        })
        .collect();
    set_states(&mut stacks, top, MAX_SHARE_OF_ALL);
    stacks
}

/// Measures the moments again, over the good pixels, with the light of the frames made equal.
fn remeasure(stacks: &mut [Measured<'_>], good: &GoodPixels, top: u16) {
    let bias = dark_level(stacks);
    stacks.par_iter_mut().for_each(|measured| {
        let change = if measured.kind == "flat" { FrameChange::Factor(bias) } else { FrameChange::Offset };
        measured.moments = stack_moments(measured.stack, &measured.maps, good, change, top);
    });
    set_states(stacks, top, MAX_SHARE_OF_GOOD);
}

/// Mean of the stack without light that has the shortest exposure; 0 without one.
fn dark_level(stacks: &[Measured<'_>]) -> f64 {
    let dark = stacks.iter().filter(|measured| measured.kind != "flat");
    dark.min_by(|a, b| a.stack.time_s.total_cmp(&b.stack.time_s)).map_or(0.0, |found| found.moments.mean)
}

/// Sets the use of every stack.
fn set_states(stacks: &mut [Measured<'_>], top: u16, max_share: f64) {
    let bias = dark_level(stacks);
    for kind in ["bias", "dark", "flat"] {
        let indices: Vec<usize> = (0..stacks.len()).filter(|index| stacks[*index].kind == kind).collect();
        let levels: Vec<(f64, &StackMoments)> = indices
            .iter()
            .map(|index| &stacks[*index])
            .map(|measured| {
                let rises = if kind == "flat" { measured.stack.exposure() } else { measured.stack.time_s };
                (rises, &measured.moments)
            })
            .collect();
        let mut states = states_of_levels(&levels, bias, top, max_share);
        if kind != "flat" {
            // Darks are not expected to fill the wells: only ends of the converter matter.
            for state in &mut states {
                if matches!(state, StackState::BeyondSaturation | StackState::NearSaturation) {
                    *state = StackState::Used;
                }
            }
        }
        for (index, state) in indices.into_iter().zip(states) {
            stacks[index].state = state;
        }
    }
}

/// Checks that darks are not darker than the bias, and that flats are brighter than darks of their time.
fn check_order(stacks: &[Measured<'_>]) -> Result<(), SensorFitError> {
    let median = |measured: &Measured<'_>| {
        let mut values = measured.maps.mean.clone();
        let middle = values.len() / 2;
        f64::from(*values.select_nth_unstable_by(middle, f32::total_cmp).1)
    };
    let levels: Vec<(&Measured<'_>, f64)> =
        stacks.iter().map(|measured| (measured, median(measured))).collect();
    let of_kind = |kind: &'static str| levels.iter().filter(move |(measured, _)| measured.kind == kind);
    // The noise of a mean over all pixels is far below a digital number; drifts of an offset are not.
    let is_above = |brighter: f64, darker: f64, noise: f64| brighter > darker - noise;
    let fault = |brighter: &(&Measured<'_>, f64), darker: &(&Measured<'_>, f64), expected| {
        Err(SensorFitError::Order {
            brighter: brighter.0.stack.name.clone(),
            brighter_dn: brighter.1,
            darker: darker.0.stack.name.clone(),
            darker_dn: darker.1,
            expected,
        })
    };
    for bias in of_kind("bias") {
        let noise = 1.0 + sqrt(bias.0.moments.pixel[0]);
        for other in of_kind("dark").chain(of_kind("flat")) {
            if !is_above(other.1, bias.1, noise) {
                return fault(other, bias, "dark and flat frames brighter than the bias");
            }
        }
    }
    for flat in of_kind("flat") {
        for dark in of_kind("dark").filter(|dark| dark.0.stack.time_s <= flat.0.stack.time_s) {
            let noise = 1.0 + sqrt(dark.0.moments.pixel[0]);
            if !is_above(flat.1, dark.1, noise) {
                return fault(flat, dark, "flat frames brighter than dark ones of no longer exposure");
            }
        }
    }
    Ok(())
}

/// Views of the stacks of some kinds that are used.
fn used_views<'a>(stacks: &'a [Measured<'_>], is_flat: bool) -> Vec<MeasuredStack<'a>> {
    let wanted = stacks.iter().filter(|m| (m.kind == "flat") == is_flat && m.is_used());
    wanted.map(Measured::view).collect()
}

/// Finds hot, dead, odd and noisy pixels; false with them if dead ones do not stand out of the noise.
fn find_defects(stacks: &[Measured<'_>], good: &GoodPixels) -> (Vec<Defect>, bool) {
    let pixels = good.is_good.len();
    let mut defects = vec![Defect::default(); pixels];
    let mut shows_dead = false;
    let dark_stacks = used_views(stacks, false);
    let flats = used_views(stacks, true);
    let dark = DarkSignal::new(&dark_stacks);
    if let Some(dark) = &dark {
        // Offsets beside those of the others of the row and the column: in the stack of the shortest
        // exposure, which shows them least mixed with dark current.
        let shortest = dark_stacks.iter().min_by(|a, b| a.time_s.total_cmp(&b.time_s));
        if let Some(stack) = shortest {
            let floor = sqrt(stack.moments.pixel[0] / stack.moments.frames as f64).max(MIN_STEP_DN);
            let offsets = without_lines(&stack.maps.mean, good);
            mark(&offsets, floor, [true, true], |pixel| defects[pixel].noisy = true);
        }
        if let Some(rise) = &dark.rise {
            let longest = dark_stacks.iter().map(|stack| stack.time_s).fold(0.0, f64::max);
            mark(rise, MIN_STEP_DN / longest.max(1e-9), [false, true], |pixel| defects[pixel].hot = true);
        }
    }
    if let (Some(dark), false) = (&dark, flats.is_empty()) {
        shows_dead = mark_responses(dark, &flats, good, &mut defects);
    }
    for measured in stacks.iter().filter(|measured| measured.is_used()) {
        let limit = noisy_limit(measured.stack.frames.len() as f64 - 1.0);
        // A twelfth stands for the rounding where no noise is visible.
        let mean = robust_mean(&measured.maps.variance).max(1.0 / 12.0);
        for (defect, variance) in defects.iter_mut().zip(&measured.maps.variance) {
            defect.noisy |= f64::from(*variance) > limit * mean && !defect.hot;
        }
    }
    (defects, shows_dead)
}

/// Returns an image without the means of its rows and columns.
fn without_lines(image: &[f32], good: &GoodPixels) -> Vec<f32> {
    let (mut rows, mut columns) = (vec![0.0_f64; good.rows], vec![0.0_f64; good.columns]);
    for (pixel, value) in image.iter().enumerate() {
        rows[pixel / good.columns] += f64::from(*value) / good.columns as f64;
        columns[pixel % good.columns] += f64::from(*value) / good.rows as f64;
    }
    let mean = rows.iter().sum::<f64>() / good.rows as f64;
    let line = |pixel: usize| rows[pixel / good.columns] + columns[pixel % good.columns] - mean;
    image.iter().enumerate().map(|(pixel, value)| (f64::from(*value) - line(pixel)) as f32).collect()
}

/// Marks pixels beyond the lower or the upper limit of the ordinary ones.
fn mark(values: &[f32], floor: f64, sides: [bool; 2], mut put: impl FnMut(usize)) {
    let [low, high] = ordinary_limits(values.iter().copied(), values.len(), floor);
    for (pixel, value) in values.iter().enumerate() {
        let value = f64::from(*value);
        if (sides[0] && value < low) || (sides[1] && value > high) {
            put(pixel);
        }
    }
}

/// Median of values that lie on steps: interpolated within the step of the middle.
fn grouped_median(values: &[f64], step: f64) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let Some(middle) = sorted.get(sorted.len() / 2).copied() else { return 0.0 };
    let below = sorted.partition_point(|value| *value < middle - 0.5 * step) as f64;
    let inside = sorted.partition_point(|value| *value < middle + 0.5 * step) as f64 - below;
    let centre = sorted.iter().skip(below as usize).take(inside as usize).sum::<f64>() / inside;
    centre + step * ((0.5 * sorted.len() as f64 - below) / inside - 0.5)
}

/// Marks dead pixels and those of an odd response. Returns false if a pixel without response does not stand
/// out of the noise.
fn mark_responses(
    dark: &DarkSignal,
    flats: &[MeasuredStack<'_>],
    good: &GoodPixels,
    defects: &mut [Defect],
) -> bool {
    let sum = response_sum(dark, flats);
    let mut fitted = good.clone();
    let mut ratios = sum.clone();
    // The second surface leaves out the dead pixels of the first.
    for _ in 0..2 {
        let surface = smooth_surface(&sum, &fitted);
        for (pixel, ratio) in ratios.iter_mut().enumerate() {
            *ratio = if surface[pixel] > 0.0 { sum[pixel] / surface[pixel] } else { 1.0 };
            fitted.is_good[pixel] = (0.5..1.5).contains(ratio);
        }
    }
    // A pixel without response must lie beyond the noise of the others to be seen.
    let [low, high] = ordinary_limits(ratios.iter().copied(), ratios.len(), 1e-4);
    for (defect, ratio) in defects.iter_mut().zip(&ratios) {
        let ratio = f64::from(*ratio);
        // A hot pixel that fills its well has no response left, but is not dead.
        defect.dead = ratio < DEAD_RESPONSE.min(low) && !defect.hot;
        defect.odd_response = (ratio < low || ratio > high) && !defect.hot && !defect.dead;
    }
    low > 0.0
}

/// Mean of the values below forty times their mean: few extreme ones do not move it.
fn robust_mean(values: &[f32]) -> f64 {
    let mean = |limit: f64| {
        let kept = values.iter().map(|value| f64::from(*value)).filter(|value| *value <= limit);
        let (sum, count) = kept.fold((0.0, 0.0), |(sum, count), value| (sum + value, count + 1.0));
        sum / f64::max(count, 1.0)
    };
    let mut sorted = values.to_vec();
    let place = sorted.len() * 9 / 10;
    let high = f64::from(*sorted.select_nth_unstable_by(place, f32::total_cmp).1);
    // The nine tenths' quantile of χ² of one degree is 2.7 times its mean.
    mean(15.0 * high.max(1e-9))
}

/// Relative scatter of the light between frames of one level beyond the noise.
fn light_drift(stacks: &[Measured<'_>], bias: f64) -> f64 {
    let (mut excess, mut degrees, mut is_seen) = (0.0, 0.0, false);
    for measured in stacks.iter().filter(|measured| measured.kind == "flat" && measured.is_used()) {
        let [found, expected] = measured.moments.frame_mean;
        let signal = measured.moments.mean - bias;
        let freedom = measured.stack.frames.len() as f64 - 1.0;
        // 12 times the variance: once in 2000 with one degree of freedom.
        is_seen |= found > 12.0 * expected;
        excess += freedom * (found - expected) / (signal * signal);
        degrees += freedom;
    }
    if is_seen && excess > 0.0 { sqrt(excess / degrees) } else { 0.0 }
}

/// Variance of the offset of a whole frame beyond the noise, DN², pooled over the stacks without light.
fn offset_drift_variance(stacks: &[Measured<'_>]) -> f64 {
    let (mut excess, mut degrees, mut is_seen) = (0.0, 0.0, false);
    for measured in stacks.iter().filter(|measured| measured.kind != "flat") {
        let [found, expected] = measured.moments.frame_mean;
        let freedom = measured.stack.frames.len() as f64 - 1.0;
        is_seen |= found > 12.0 * expected;
        excess += freedom * (found - expected);
        degrees += freedom;
    }
    if is_seen && excess > 0.0 { excess / degrees } else { 0.0 }
}

/// Adjusts the photon transfer; levels whose variance a partial cut lowers are left out, brightest first.
fn transfer_of(stacks: &mut [Measured<'_>]) -> Option<TransferFit> {
    let drift = light_drift(stacks, dark_level(stacks));
    let offset_variance = offset_drift_variance(stacks);
    loop {
        let points = |without: Option<usize>| -> Vec<TransferPoint> {
            let used = stacks.iter().enumerate();
            let used = used.filter(|(index, measured)| measured.is_used() && Some(*index) != without);
            used.map(|(_, measured)| transfer_point(measured, offset_variance)).collect()
        };
        let fit = fit_transfer(&points(None), drift);
        let flats = stacks.iter().enumerate().filter(|(_, m)| m.kind == "flat" && m.is_used());
        let lit: Vec<usize> = flats.map(|(index, _)| index).collect();
        let brightest =
            lit.iter().copied().max_by(|a, b| stacks[*a].moments.mean.total_cmp(&stacks[*b].moments.mean));
        let Some(brightest) = brightest.filter(|_| lit.len() >= 4) else { return fit };
        let below = fit_transfer(&points(Some(brightest)), drift);
        let Some(below) = below else { return fit };
        let stack = stacks[brightest].stack;
        let expected = below.derived(|values| {
            Some(variance_at(values, linear_signal(values, stack.exposure(), stack.time_s)))
        });
        let point = transfer_point(&stacks[brightest], offset_variance);
        let (Some([expected, error]), Some([variance, sigma])) = (expected, point.variance) else {
            return fit;
        };
        let lowered = expected - variance;
        if lowered < 5.0 * sqrt(error * error + sigma * sigma) || lowered < 0.02 * expected {
            return fit;
        }
        stacks[brightest].state = StackState::NearSaturation;
    }
}

/// Moments of a stack for the photon transfer.
fn transfer_point(measured: &Measured<'_>, offset_variance: f64) -> TransferPoint {
    let moments = &measured.moments;
    let rounding = rounding_of_mean(moments.mean, moments.total[0]);
    let offset = offset_variance / moments.frames as f64;
    let mean_sigma = sqrt(moments.mean_sigma * moments.mean_sigma + rounding * rounding + offset);
    let noise = RoundedNoise {
        mean: [moments.mean, moments.mean_sigma],
        temporal: moments.pixel,
        total: moments.total,
    };
    TransferPoint {
        exposure: measured.stack.exposure(),
        time_s: measured.stack.time_s,
        mean: [moments.mean, mean_sigma.max(1e-9)],
        variance: unrounded_variance(&noise).filter(|[_, sigma]| *sigma > 0.0),
    }
}

/// Everything from which the figures follow.
struct Fit<'a> {
    frames: &'a SensorFrames,
    shifted_bits: u32,
    top: u16,
    good: GoodPixels,
    stacks: Vec<Measured<'a>>,
    defects: Vec<Defect>,
    /// True if a pixel without response stands out of the noise.
    shows_dead: bool,
    transfer: Option<TransferFit>,
}

const NEEDS_DARK: &str = "needs dark frames of two exposure times, or of one and bias frames";
const NEEDS_FLATS: &str = "needs flat frames below saturation, and bias or dark frames";
const NEEDS_NOISE: &str = "needs bias or dark frames whose noise is above half a digital number: below, the rounding \
                           hides offsets; a converter setting with fewer electrons per number shows them";
const NEEDS_GAIN: &str = "needs the gain";

impl Fit<'_> {
    /// Computes all figures.
    fn figures(&self) -> SensorFigures {
        let gain = self.gain();
        let gain_e = match &gain {
            Finding::Value { value, sigma } => Some([*value, *sigma]),
            _ => None,
        };
        let electrons = |finding: Finding| match (gain_e, finding) {
            (_, missing @ Finding::Missing(_)) => missing,
            (Some(gain), finding) => finding.times(gain),
            (None, _) => Finding::missing(NEEDS_GAIN),
        };
        // Flats without a gain are not known to be below saturation.
        let of_light = |finding: Finding| match finding {
            missing @ Finding::Missing(_) => missing,
            _ if gain_e.is_none() => Finding::missing(NEEDS_GAIN),
            finding => finding,
        };
        let read_noise_dn = self.read_noise_dn();
        let [row, column] = self.line_noise();
        let [dsnu, column_offset, row_offset] = self.offset_patterns();
        let (saturation_dn, largest_linear_dn) = self.saturation();
        let (full_well_e, limit) = self.full_well(gain_e);
        let drift = light_drift(&self.stacks, dark_level(&self.stacks));
        let counts = self.defect_counts(gain_e);
        SensorFigures {
            size: [self.frames.columns, self.frames.rows],
            bit_depth: self.bit_depth(),
            shifted_bits: self.shifted_bits,
            bias_dn: self.parameter(BIAS, "needs bias or dark frames, not cut at 0"),
            read_noise_e: electrons(read_noise_dn.clone()),
            read_noise_dn,
            row_noise_e: electrons(row),
            column_noise_e: electrons(column),
            dark_current_e_per_s: self.dark_current(gain_e),
            dark_current_spread_e_per_s: electrons(self.dark_spread()),
            dsnu_e: electrons(dsnu),
            column_offset_e: electrons(column_offset),
            row_offset_e: electrons(row_offset),
            prnu_fraction: of_light(self.response_spread()),
            saturation_e: self.electrons_of_level(&saturation_dn, gain_e),
            full_well_e,
            saturation_dn: of_light(saturation_dn),
            largest_linear_dn: of_light(largest_linear_dn),
            end_e: self.end_e(gain_e),
            limit,
            linearity_error_percent: of_light(self.linearity()),
            non_linearity: self.non_linearity(gain_e),
            light_drift: drift,
            defects: counts,
            levels: self.levels(),
            notes: self.notes(drift),
            gain_e_per_dn: gain,
        }
    }

    fn of_kind(&self, kind: &'static str) -> impl Iterator<Item = &Measured<'_>> {
        self.stacks.iter().filter(move |measured| measured.kind == kind)
    }

    fn has_cut(&self, kind: &'static str, state: StackState) -> bool {
        self.of_kind(kind).any(|measured| measured.state == state)
    }

    /// Value of a parameter of the photon transfer.
    fn parameter(&self, parameter: usize, reason: &str) -> Finding {
        let found = self.transfer.as_ref().and_then(|transfer| transfer.parameter(parameter));
        match found {
            Some([value, sigma]) if self.has_dark() => Finding::Value { value, sigma },
            _ => Finding::missing(reason),
        }
    }

    /// True if a stack without light is used.
    fn has_dark(&self) -> bool {
        self.stacks.iter().any(|measured| measured.kind != "flat" && measured.is_used())
    }

    /// Electrons per digital number: 1/p.
    fn gain(&self) -> Finding {
        let flats = self.of_kind("flat").count();
        let used = self.of_kind("flat").filter(|measured| measured.is_used()).count();
        if flats > 0 && used == 0 {
            return Finding::missing("every flat level is cut: darker flats determine it");
        }
        let Some(transfer) = &self.transfer else { return Finding::missing(NEEDS_FLATS) };
        let Some([p, sigma]) = transfer.parameter(INVERSE_GAIN) else {
            return Finding::missing(NEEDS_FLATS);
        };
        // Noise that does not rise with the signal is not that of electrons.
        if p < 5.0 * sigma {
            return Finding::missing(format!(
                "the noise does not rise with the signal ({p:.2e} ± {sigma:.1e} DN per electron), as in saturated \
                 or processed frames: unprocessed flats below saturation determine it"
            ));
        }
        Finding::Value { value: 1.0 / p, sigma: sigma / (p * p) }
    }

    /// Temporal noise of a pixel without charge: the root of r, or the limit of EMVA 1288.
    fn read_noise_dn(&self) -> Finding {
        let dark = self.stacks.iter().filter(|measured| measured.kind != "flat");
        let mut dark = dark.filter(|measured| measured.is_used()).peekable();
        if dark.peek().is_none() {
            return Finding::missing("needs bias or dark frames, not cut at 0");
        }
        let Some([variance, sigma]) =
            self.transfer.as_ref().and_then(|transfer| transfer.parameter(READ_VARIANCE))
        else {
            return Finding::Below(NOISE_LIMIT_DN);
        };
        let shortest = dark.min_by(|a, b| a.stack.time_s.total_cmp(&b.stack.time_s));
        let is_visible = shortest.is_some_and(|measured| transfer_point(measured, 0.0).variance.is_some());
        match Finding::root_of_variance([variance, sigma]) {
            Finding::Below(limit) => Finding::Below(limit),
            value if is_visible => value,
            _ => Finding::Below(NOISE_LIMIT_DN),
        }
    }

    /// Temporal noise of rows and columns, DN, pooled over the stacks without light.
    fn line_noise(&self) -> [Finding; 2] {
        let [columns, rows] = [self.frames.columns, self.frames.rows].map(|length| length as f64);
        [
            self.pooled_line_noise(|moments| moments.row, columns, rows),
            self.pooled_line_noise(|moments| moments.column, rows, columns),
        ]
    }

    /// Pools the noise of `lines` rows or columns of a length.
    fn pooled_line_noise(&self, of: fn(&StackMoments) -> Variance, length: f64, lines: f64) -> Finding {
        let shown = self.stacks.iter().filter(|measured| measured.shows_offsets());
        let stacks: Vec<&StackMoments> = shown.map(|measured| &measured.moments).collect();
        if stacks.is_empty() {
            return Finding::missing(NEEDS_NOISE);
        }
        let (mut variance, mut weights) = (0.0_f64, 0.0);
        // Weights by the expected scatter of a mean square; those by the found one would favour low ones.
        for _ in 0..3 {
            let weight = |moments: &StackMoments| {
                let expected = variance.max(0.0) + moments.pixel[0] / length;
                (moments.frames as f64 - 1.0) * (lines - 1.0) / (2.0 * expected * expected)
            };
            weights = stacks.iter().map(|moments| weight(moments)).sum();
            variance = stacks.iter().map(|moments| weight(moments) * of(moments)[0]).sum::<f64>() / weights;
        }
        Finding::root_of_variance([variance, 1.0 / sqrt(weights)])
    }

    /// DSNU1288 of the shortest exposure without light, and its parts of columns and rows, DN.
    fn offset_patterns(&self) -> [Finding; 3] {
        let dark = self.stacks.iter().filter(|m| m.kind != "flat" && m.is_used());
        let Some(shortest) = dark.min_by(|a, b| a.stack.time_s.total_cmp(&b.stack.time_s)) else {
            return [(); 3].map(|()| Finding::missing("needs bias or dark frames, not cut at 0"));
        };
        if !shortest.shows_offsets() {
            return [(); 3].map(|()| Finding::missing(NEEDS_NOISE));
        }
        let pattern = offset_pattern(&shortest.view(), &self.good);
        [pattern.total(), pattern.column, pattern.row].map(Finding::root_of_variance)
    }

    /// Dark current: c/p.
    fn dark_current(&self, gain: Option<[f64; 2]>) -> Finding {
        let Some(transfer) = &self.transfer else { return Finding::missing(NEEDS_DARK) };
        if !transfer.is_adjusted[DARK] {
            return Finding::missing(NEEDS_DARK);
        }
        if gain.is_none() {
            return Finding::missing(NEEDS_GAIN);
        }
        let Some([value, sigma]) = transfer.derived(|values| Some(values[DARK] / values[INVERSE_GAIN]))
        else {
            return Finding::missing(NEEDS_DARK);
        };
        // The mean of the pixels is that of the sensor's distribution to its spread over √N.
        let spread = match self.dark_spread() {
            Finding::Value { value, .. } => value / transfer.values[INVERSE_GAIN],
            _ => 0.0,
        };
        let sigma = sqrt(sigma * sigma + spread * spread / self.good.count() as f64);
        if value < 2.0 * sigma {
            return Finding::Below(value.max(0.0) + 2.0 * sigma);
        }
        Finding::Value { value, sigma }
    }

    /// Standard deviation of the dark currents of ordinary pixels, DN/s.
    fn dark_spread(&self) -> Finding {
        let dark = self.stacks.iter().filter(|measured| measured.kind != "flat" && measured.is_used());
        let longest = dark.max_by(|a, b| a.stack.time_s.total_cmp(&b.stack.time_s));
        if longest.is_some_and(|measured| !measured.shows_offsets()) {
            return Finding::missing(NEEDS_NOISE);
        }
        let stacks = used_views(&self.stacks, false);
        let pattern = DarkSignal::new(&stacks).and_then(|dark| rise_pattern(&dark, &stacks, &self.good));
        let Some(pattern) = pattern else { return Finding::missing(NEEDS_DARK) };
        // The longest exposure, which determines the rise, sees it by the slope of the response.
        let slope = longest.zip(self.transfer.as_ref()).map_or(1.0, |(longest, transfer)| {
            slope_at(&transfer.values, transfer.values[DARK] * longest.stack.time_s)
        });
        Finding::root_of_variance(pattern.over(slope.max(0.05)).pixel)
    }

    /// PRNU1288 of all flats that are used.
    fn response_spread(&self) -> Finding {
        let (dark_stacks, flats) = (used_views(&self.stacks, false), used_views(&self.stacks, true));
        let (Some(transfer), Some(dark)) = (&self.transfer, DarkSignal::new(&dark_stacks)) else {
            return Finding::missing(NEEDS_FLATS);
        };
        if flats.is_empty() || !transfer.is_adjusted[LIGHT] {
            return Finding::missing(NEEDS_FLATS);
        }
        // The response of a pixel changes its mean by the slope of the response at the level.
        let values = &transfer.values;
        let signal: f64 = self
            .of_kind("flat")
            .filter(|measured| measured.is_used())
            .map(|measured| {
                let stack = measured.stack;
                let u = linear_signal(values, stack.exposure(), stack.time_s);
                let light = values[LIGHT] * stack.exposure();
                measured.moments.frames as f64 * light * slope_at(values, u)
            })
            .sum();
        let pattern = response_pattern(&dark, &dark_stacks, &flats, &self.good, signal);
        Finding::root_of_variance(pattern.total())
    }

    /// Saturation of EMVA 1288, and the largest linear level, DN.
    fn saturation(&self) -> (Finding, Finding) {
        let flats: Vec<&Measured<'_>> = self.of_kind("flat").collect();
        let largest = flats.iter().max_by(|a, b| a.moments.pixel[0].total_cmp(&b.moments.pixel[0]));
        let is_passed = largest.is_some_and(|largest| {
            flats.iter().any(|flat| {
                flat.stack.exposure() > largest.stack.exposure()
                    && matches!(flat.state, StackState::Converter | StackState::BeyondSaturation)
            })
        });
        let reason = "no level is beyond the largest variance: brighter flats determine it";
        let saturation = match largest {
            Some(largest) if is_passed => {
                // The level of the largest variance lies within half of the step to its neighbours.
                let mean = largest.moments.mean;
                let steps = flats.iter().map(|flat| flat.moments.mean - mean);
                let up = steps.clone().filter(|step| *step > 0.0).fold(f64::INFINITY, f64::min);
                let down = steps.filter(|step| *step < 0.0).fold(f64::NEG_INFINITY, f64::max);
                let range = [up, -down].into_iter().filter(|step| step.is_finite()).fold(0.0, f64::max);
                Finding::Value { value: mean, sigma: range / sqrt(12.0) }
            }
            _ => Finding::missing(reason),
        };
        let linear = self.transfer.as_ref().and_then(|transfer| {
            let is_linear = |measured: &&Measured<'_>| {
                let stack = measured.stack;
                let u = linear_signal(&transfer.values, stack.exposure(), stack.time_s);
                let expected = variance_at(&transfer.values, u);
                let found = transfer_point(measured, 0.0).variance.map_or(0.0, |[variance, _]| variance);
                measured.state != StackState::Converter && (found / expected - 1.0).abs() < LINEAR_VARIANCE
            };
            let levels = self.of_kind("flat").filter(is_linear);
            levels.max_by(|a, b| a.moments.mean.total_cmp(&b.moments.mean))
        });
        let linear = linear.map_or_else(
            || Finding::missing(NEEDS_FLATS),
            |found| Finding::Value { value: found.moments.mean, sigma: found.moments.mean_sigma },
        );
        (saturation, linear)
    }

    /// Electrons of a mean, by the inverse of the response.
    fn electrons_of_level(&self, level: &Finding, gain: Option<[f64; 2]>) -> Finding {
        let (Finding::Value { value, sigma }, Some(transfer)) = (level, &self.transfer) else {
            return level.clone();
        };
        if gain.is_none() {
            return Finding::missing(NEEDS_GAIN);
        }
        let electrons = |values: &[f64; 7]| Some(signal_of_mean(values, *value)? / values[INVERSE_GAIN]);
        let Some([found, error]) = transfer.derived(electrons) else {
            return Finding::missing("the response does not reach it without bending back");
        };
        let slope = signal_of_mean(&transfer.values, *value).map_or(1.0, |u| slope_at(&transfer.values, u));
        let of_level = sigma / (slope.max(0.05) * transfer.values[INVERSE_GAIN]);
        Finding::Value { value: found, sigma: sqrt(error * error + of_level * of_level) }
    }

    /// Mean of the full wells, DN, from the levels at which nearly all pixels are full.
    fn full_level(&self) -> Option<[f64; 2]> {
        let transfer = self.transfer.as_ref()?;
        let (mut sum, mut weights) = (0.0, 0.0);
        for flat in self.of_kind("flat").filter(|flat| flat.state == StackState::BeyondSaturation) {
            let u = linear_signal(&transfer.values, flat.stack.exposure(), flat.stack.time_s);
            let expected = variance_at(&transfer.values, u) - transfer.values[READ_VARIANCE];
            let found = flat.moments.pixel[0] - transfer.values[READ_VARIANCE];
            if found < FULL_SHARE * expected {
                // The median leaves out the pixels that are not full yet.
                let good = flat.maps.mean.iter().zip(&self.good.is_good).filter(|(_, good)| **good);
                let means: Vec<f64> = good.map(|(mean, _)| f64::from(*mean)).collect();
                let median = grouped_median(&means, 1.0 / flat.moments.frames as f64);
                let sampling = 1.25 * sqrt(flat.moments.total[0] / means.len() as f64);
                let rounding = rounding_of_mean(flat.moments.mean, flat.moments.total[0]);
                let variance = sampling * sampling + rounding * rounding;
                sum += median / variance;
                weights += 1.0 / variance;
            }
        }
        (weights > 0.0).then(|| [sum / weights, 1.0 / sqrt(weights)])
    }

    /// Full well, and what ends the response.
    fn full_well(&self, gain: Option<[f64; 2]>) -> (Finding, Option<SaturationLimit>) {
        if let Some([value, sigma]) = self.full_level() {
            let level = Finding::Value { value, sigma };
            return (self.electrons_of_level(&level, gain), Some(SaturationLimit::FullWell));
        }
        if self.has_cut("flat", StackState::Converter) {
            let reason = match self.converter_end(gain) {
                Some(end_e) => {
                    format!("the converter ends first, at {end_e:.0} electrons: a full well is above")
                }
                None => "the converter ends first".to_owned(),
            };
            return (Finding::Missing(reason), Some(SaturationLimit::Converter));
        }
        (Finding::missing("no level fills the wells: brighter flats determine it"), None)
    }

    /// Electrons at the largest number of the converter.
    fn converter_end(&self, gain: Option<[f64; 2]>) -> Option<f64> {
        let top = Finding::Value { value: f64::from(self.top), sigma: 0.0 };
        self.electrons_of_level(&top, gain).value()
    }

    /// Curvature of the response per DN of signal, of the parabola through the brightest level that is used.
    fn curvature(&self) -> Option<[f64; 2]> {
        let transfer = self.transfer.as_ref().filter(|transfer| transfer.is_adjusted[CURVATURE])?;
        let flats = self.of_kind("flat").filter(|flat| flat.is_used());
        let brightest = flats.max_by(|a, b| a.stack.exposure().total_cmp(&b.stack.exposure()))?.stack;
        transfer.derived(|values| {
            let u = linear_signal(values, brightest.exposure(), brightest.time_s);
            Some(values[CURVATURE] + values[CUBIC] * u)
        })
    }

    /// Electrons at the full well or, where none is seen, at the largest number of the converter.
    fn end_e(&self, gain: Option<[f64; 2]>) -> Option<f64> {
        let full_well = self.full_well(gain).0.value();
        let transfer = self.transfer.as_ref()?;
        let rise = f64::from((1_u32 << self.bit_depth().0) - 1) - transfer.values[BIAS];
        // Root of u − k u² = rise, in a form that is also valid for k = 0.
        let root = 1.0 - 4.0 * self.curvature().map_or(0.0, |[k, _]| k) * rise;
        let at_top = if root > 0.0 { 2.0 * rise / (1.0 + sqrt(root)) } else { 2.0 * rise };
        full_well.or_else(|| gain.map(|[gain, _]| gain * at_top))
    }

    fn linearity(&self) -> Finding {
        let Some(transfer) = &self.transfer else { return Finding::missing(NEEDS_FLATS) };
        let values = &transfer.values;
        let levels: Vec<LinearityLevel> = self
            .of_kind("flat")
            .filter(|flat| matches!(flat.state, StackState::Used | StackState::NearSaturation))
            .map(|flat| {
                let signal = flat.moments.mean - values[BIAS] - values[DARK] * flat.stack.time_s;
                let point = transfer_point(flat, 0.0);
                let noise = point.mean[1] / signal.abs().max(1e-9);
                let relative_sigma = sqrt(noise * noise + transfer.light_scatter * transfer.light_scatter);
                LinearityLevel { exposure: flat.stack.exposure(), signal, relative_sigma }
            })
            .collect();
        let saturation = self.saturation().0.value().map(|level| level - values[BIAS]);
        let brightest = levels.iter().map(|level| level.signal).fold(0.0, f64::max);
        // Without a saturated level, the brightest one is the end of the range.
        linearity_error(&levels, saturation.unwrap_or(brightest / 0.95 * (1.0 + 1e-9)))
    }

    /// Share of its signal that a pixel loses at the full well or the end of the converter.
    fn non_linearity(&self, gain: Option<[f64; 2]>) -> Finding {
        let Some([curvature, sigma]) = self.curvature() else {
            return Finding::missing("needs three levels of light, or two and bias or dark frames");
        };
        let (Some(end_e), Some([gain, _])) = (self.end_e(gain), gain) else {
            return Finding::missing(NEEDS_GAIN);
        };
        let end_dn = end_e / gain;
        if sigma * end_dn > 0.1 {
            return Finding::missing("the light of the levels scatters: a steadier lamp determines it");
        }
        Finding::Value { value: curvature * end_dn, sigma: sigma * end_dn }
    }

    fn bit_depth(&self) -> (u8, bool) {
        let is_seen = self.stacks.iter().any(|measured| measured.state == StackState::Converter);
        match bits_of_full_scale(self.top) {
            Some(bits) if is_seen => (bits, true),
            _ => (self.frames.stored_bits.clamp(8, 16), false),
        }
    }

    fn defect_counts(&self, gain: Option<[f64; 2]>) -> DefectCounts {
        let count = |is: fn(&Defect) -> bool| self.defects.iter().filter(|defect| is(defect)).count();
        let columns = dead_columns(&self.defects, self.frames.columns);
        let has_response = self.shows_dead;
        let dark = DarkSignal::new(&used_views(&self.stacks, false));
        let has_rise = dark.is_some_and(|dark| dark.rise.is_some());
        let in_columns = |(pixel, defect): &(usize, &Defect)| {
            defect.dead && columns.contains(&(pixel % self.frames.columns))
        };
        let dead_in_columns = self.defects.iter().enumerate().filter(in_columns).count();
        DefectCounts {
            pixels: self.defects.len(),
            hot: has_rise.then(|| count(|defect| defect.hot)),
            hot_currents: gain.and_then(|[gain, _]| self.hot_currents(gain)),
            dead: has_response.then(|| count(|defect| defect.dead) - dead_in_columns),
            dead_columns: has_response.then_some(columns.len()),
            odd_response: has_response.then(|| count(|defect| defect.odd_response)),
            noisy: count(|defect| defect.noisy),
        }
    }

    /// Dark currents of the hot pixels above the mean: each from its longest exposure that is not cut.
    fn hot_currents(&self, gain: f64) -> Option<HotPixels> {
        let mut stacks: Vec<&Measured<'_>> =
            self.stacks.iter().filter(|m| m.kind != "flat" && m.is_used()).collect();
        stacks.sort_by(|a, b| a.stack.time_s.total_cmp(&b.stack.time_s));
        let (shortest, others) = stacks.split_first()?;
        let limit = MAX_SHARE_OF_HOT * f64::from((1_u32 << self.bit_depth().0) - 1);
        let mut currents = Vec::new();
        for (pixel, _) in self.defects.iter().enumerate().filter(|(_, defect)| defect.hot && !defect.dead) {
            let rise = |of: &&&Measured<'_>| {
                let level = f64::from(of.maps.mean[pixel]) - of.moments.mean;
                let start = f64::from(shortest.maps.mean[pixel]) - shortest.moments.mean;
                (level - start) / (of.stack.time_s - shortest.stack.time_s)
            };
            let is_longer = |of: &&&Measured<'_>| of.stack.time_s > shortest.stack.time_s;
            let longer = others.iter().filter(is_longer);
            let mut uncut = longer.clone().filter(|of| f64::from(of.maps.mean[pixel]) < limit);
            // A pixel that is cut in every stack has at least the current of the shortest.
            let current = uncut.next_back().or_else(|| longer.clone().next()).map(|of| rise(&of))?;
            currents.push(gain * current);
        }
        currents.retain(|current| *current > 0.0);
        currents.sort_by(f64::total_cmp);
        let median_e_per_s = *currents.get(currents.len() / 2)?;
        let logs: Vec<f64> = currents.iter().map(|current| log(*current)).collect();
        let mean = logs.iter().sum::<f64>() / logs.len() as f64;
        let variance =
            logs.iter().map(|value| (value - mean) * (value - mean)).sum::<f64>() / logs.len() as f64;
        Some(HotPixels { median_e_per_s, spread: sqrt(variance), threshold_e_per_s: *currents.first()? })
    }

    fn levels(&self) -> Vec<LevelSummary> {
        let summary = |measured: &Measured<'_>| LevelSummary {
            name: measured.stack.name.clone(),
            kind: measured.kind,
            time_s: measured.stack.time_s,
            light: measured.stack.light,
            frames: measured.stack.frames.len(),
            mean_dn: measured.moments.mean,
            variance_dn2: measured.moments.pixel[0],
            state: measured.state.words(),
        };
        self.stacks.iter().map(summary).collect()
    }

    /// Statements about frames that limit the figures.
    fn notes(&self, drift: f64) -> Vec<String> {
        let mut notes = Vec::new();
        if self.shifted_bits > 0 {
            notes.push(format!(
                "the low {} bits of all numbers are 0: they are taken as shifted up, and digital numbers here \
                 are those of the converter",
                self.shifted_bits
            ));
        }
        if drift > MIN_DRIFT {
            notes.push(format!(
                "the light changes by {:.2} % between frames of one level: the gain allows for it, the \
                 linearity does not improve on it",
                100.0 * drift
            ));
        }
        if self.of_kind("flat").filter(|flat| flat.is_used()).count() == 1 {
            notes.push(
                "one flat level is used: the figures assume that it is below saturation and the response a line; \
                 more levels show both"
                    .to_owned(),
            );
        }
        for measured in self.stacks.iter().filter(|measured| measured.state == StackState::AtZero) {
            notes.push(format!(
                "{}: {:.1} % of the numbers are 0, which cuts mean and noise; a higher bias is needed",
                measured.stack.name,
                100.0 * measured.moments.share_at_zero
            ));
        }
        if let Some(transfer) = &self.transfer {
            if transfer.light_scatter > drift.max(MIN_DRIFT) {
                notes.push(format!(
                    "the means of the flat levels scatter by {:.2} % about a smooth response to the stated \
                     light: its times or levels are not exact",
                    100.0 * transfer.light_scatter
                ));
            }
            if transfer.variance_factor > 1.0 {
                notes.push(format!(
                    "the variances scatter {:.1} times as much as their errors about the photon transfer: \
                     errors are raised by it",
                    transfer.variance_factor
                ));
            }
        }
        notes
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_median_on_steps_is_that_of_the_values_before_rounding() {
        // Uniform values from 10 to 13 rounded to thirds: their median is 11.5.
        let values: Vec<f64> =
            (0..3000).map(|i| (3.0 * (10.0 + f64::from(i) / 1000.0)).round() / 3.0).collect();
        assert!((grouped_median(&values, 1.0 / 3.0) - 11.5).abs() < 0.01);
        assert!((grouped_median(&[5.0; 9], 1.0) - 5.0).abs() < 1e-12);
    }

    #[test]
    fn lines_leave_an_image_and_its_pixels_stay() {
        let good = GoodPixels { columns: 30, rows: 20, is_good: vec![true; 600] };
        let image: Vec<f32> = (0..600).map(|i| (i / 30) as f32 * 2.0 + (i % 30) as f32 * 3.0).collect();
        assert!(without_lines(&image, &good).iter().all(|value| value.abs() < 1e-3));
    }
}
