//! Table of the stray-light transmittance, for sources of many rays.

use std::convert::Infallible;
use std::sync::Arc;

use truth::memo::Memo;

use super::stray::StrayLightConfig;

/// Binary logarithm of the number of steps between a number and its double.
const STEPS_LOG2: u32 = 9;
/// Number of octaves. The table begins at sin²(θ/2) = 2^-14, below the smallest angle of the power law, 1°.
const OCTAVES: u32 = 14;
/// Cosine of the angle beyond which the table uses another variable.
const SMOOTH_FROM_COS: f64 = -0.8;
/// Number of steps from this angle to the opposite direction.
const FAR_STEPS: usize = 512;
/// Number of bits in the fraction of an `f64`, and the bias of its exponent.
const FRACTION_BITS: u32 = 52;
const BIAS: u64 = 1023;

/// Point source transmittance over x = sin²(θ/2) = (1 − cos θ)/2, linear between nodes 1/512 or less of x
/// apart.
///
/// Up to some tens of degrees the transmittance varies as x^(−p/2), from which a chord deviates by at most
/// (p/2)(p/2 + 1)/8 · 512⁻². Twice this bound holds everywhere except in the steps of a bend: 1.2e-5 of the
/// transmittance for p = 6, 1.1e-4 for p = 20, the largest. In the step of a bend the error is a quarter of a
/// step times the change of the slope. Beyond 143°, where θ is no smooth function of x, the table is over
/// √(1 + cos θ), in which the transmittance is nearly linear: the error is at most p(p + 1)/8 ·
/// (0.0013/2.5)², 1.4e-5 for p = 20.
#[derive(Debug, Clone)]
pub(super) struct TransmittanceTable {
    values: Vec<f64>,
    /// Values beyond [`SMOOTH_FROM_COS`], starting at the opposite direction.
    far: Vec<f64>,
}

/// Cache of the latest tables.
static MADE: Memo<StrayLightConfig, TransmittanceTable> = Memo::new();

impl TransmittanceTable {
    /// Returns the table of a stray-light configuration, computed once.
    pub(super) fn from_config(config: &StrayLightConfig) -> Arc<Self> {
        let Ok(table) = MADE.get(config.clone(), |config| Ok::<_, Infallible>(Self::new(config)));
        table
    }

    fn new(config: &StrayLightConfig) -> Self {
        let steps = 1 << STEPS_LOG2;
        let value = |i: u32| {
            let octave = f64::from(1_u32 << (OCTAVES - i / steps).min(31));
            let x = (1.0 + f64::from(i % steps) / f64::from(steps)) / octave;
            config.transmittance_at_angle(2.0 * libm::atan2(x.sqrt(), (1.0 - x).max(0.0).sqrt()))
        };
        // One additional node, because interpolation at x = 1 reads the next node.
        let mut values: Vec<f64> = (0..=OCTAVES * steps).map(value).collect();
        values.push(config.transmittance_at_angle(std::f64::consts::PI));
        let far = |i: usize| {
            let root = i as f64 / FAR_STEPS as f64 * (1.0 + SMOOTH_FROM_COS).sqrt();
            config.transmittance_at_angle(libm::acos(root * root - 1.0))
        };
        // One additional node, because rounding may select it near the end.
        Self { values, far: (0..=FAR_STEPS + 1).map(far).collect() }
    }

    /// Transmittance at an angle with the cosine `cos`.
    #[inline(always)]
    pub(super) fn transmittance_at_cos(&self, cos: f64) -> f64 {
        if cos < SMOOTH_FROM_COS {
            let position = ((1.0 + cos.max(-1.0)) / (1.0 + SMOOTH_FROM_COS)).sqrt() * FAR_STEPS as f64;
            return between(&self.far, position as usize, position - position.floor());
        }
        let least = 1.0 / f64::from(1_u32 << OCTAVES);
        let bits = (0.5 - 0.5 * cos).clamp(least, 1.0).to_bits();
        // Exponent and leading bits of the fraction are the index of the node; the remaining bits are the
        // fraction of a step.
        let first = (BIAS - u64::from(OCTAVES)) << STEPS_LOG2;
        let node = ((bits >> (FRACTION_BITS - STEPS_LOG2)) - first) as usize;
        let fraction = (1 << FRACTION_BITS) - 1;
        let part = f64::from_bits(((bits << STEPS_LOG2) & fraction) | (BIAS << FRACTION_BITS)) - 1.0;
        between(&self.values, node, part)
    }
}

/// Interpolates at the fraction `part` between a node and the next.
#[inline(always)]
fn between(values: &[f64], node: usize, part: f64) -> f64 {
    match values.get(node..node + 2) {
        Some([here, next]) => here + part * (next - here),
        _ => 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_agrees_with_the_power_law() {
        for (power, power_inside) in [(3.0, 6.0), (0.0, 20.0), (20.0, 1.5), (0.0, 0.0)] {
            let config = StrayLightConfig { exclusion_deg: 40.0, transmittance: 1e-40, power, power_inside };
            let table = TransmittanceTable::new(&config);
            let half: f64 = 0.5 * f64::max(power, power_inside);
            let bound = 2.0 * half * (half + 1.0) / 8.0 / (512.0 * 512.0) + 1e-9;
            for i in 0..=18_000_i32 {
                let angle = f64::from(i).to_radians() / 100.0;
                let (got, expected) =
                    (table.transmittance_at_cos(libm::cos(angle)), config.transmittance_at_angle(angle));
                // Excludes the steps of the bends: a step is 0.04° wide at 40°, 0.001° at 1°, where the power
                // law ends.
                if (i - 4000).abs() > 10 && i != 100 {
                    assert!((got / expected - 1.0).abs() < bound, "{power}, {angle}: {got} for {expected}");
                }
                assert!((got / expected - 1.0).abs() < 0.006);
            }
        }
    }
}
