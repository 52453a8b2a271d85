//! The transmittance of a stray light law from a table, for sources of many rays.

use std::convert::Infallible;
use std::sync::Arc;

use super::stray::StrayLightConfig;
use crate::memo::Memo;

/// Steps between a number and its double.
const STEPS_LOG2: u32 = 9;
/// The table begins at sin²(θ/2) = 2^-14, below the nearest angle that the law follows, 1°.
const OCTAVES: u32 = 14;
/// Cosine of the angle beyond which the law is told by another variable.
const SMOOTH_FROM_COS: f64 = -0.8;
/// Steps from there to the opposite direction.
const FAR_STEPS: usize = 512;
/// Bits of the fraction of an `f64`, and the bias of its exponent.
const FRACTION_BITS: u32 = 52;
const BIAS: u64 = 1023;

/// The point source transmittance over x = sin²(θ/2) = (1 − cos θ)/2, straight between nodes 1/512 or less of x apart.
///
/// Up to some tens of degrees the law goes as x^(−p/2), of which a chord is off by at most (p/2)(p/2 + 1)/8 · 512⁻²; twice that
/// holds everywhere but in the steps of a bend: 1.2e-5 of the transmittance for p = 6, 1.1e-4 for p = 20, the largest. In the step
/// of a bend it is a quarter of a step times the change of the slope. Beyond 143°, where θ is no smooth function of x, the table is
/// over √(1 + cos θ), of which it is nearly a straight one: off by at most p(p + 1)/8 · (0.0013/2.5)², 1.4e-5 for p = 20.
#[derive(Debug, Clone)]
pub(super) struct TransmittanceTable {
    values: Vec<f64>,
    /// Beyond [`SMOOTH_FROM_COS`], from the opposite direction on.
    far: Vec<f64>,
}

/// The latest that were made.
static MADE: Memo<StrayLightConfig, TransmittanceTable> = Memo::new();

impl TransmittanceTable {
    /// That of a law, made once.
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
        // One node more than there are: after x = 1 nothing follows.
        let mut values: Vec<f64> = (0..=OCTAVES * steps).map(value).collect();
        values.push(config.transmittance_at_angle(std::f64::consts::PI));
        let far = |i: usize| {
            let root = i as f64 / FAR_STEPS as f64 * (1.0 + SMOOTH_FROM_COS).sqrt();
            config.transmittance_at_angle(libm::acos(root * root - 1.0))
        };
        // One more: before it ends, rounding may ask for it.
        Self { values, far: (0..=FAR_STEPS + 1).map(far).collect() }
    }

    /// The transmittance at an angle of cosine `cos`.
    #[inline(always)]
    pub(super) fn transmittance_at_cos(&self, cos: f64) -> f64 {
        if cos < SMOOTH_FROM_COS {
            let position = ((1.0 + cos.max(-1.0)) / (1.0 + SMOOTH_FROM_COS)).sqrt() * FAR_STEPS as f64;
            return between(&self.far, position as usize, position - position.floor());
        }
        let least = 1.0 / f64::from(1_u32 << OCTAVES);
        let bits = (0.5 - 0.5 * cos).clamp(least, 1.0).to_bits();
        // Exponent and leading bits of the fraction count the nodes; the other bits tell the part of a step.
        let first = (BIAS - u64::from(OCTAVES)) << STEPS_LOG2;
        let node = ((bits >> (FRACTION_BITS - STEPS_LOG2)) - first) as usize;
        let fraction = (1 << FRACTION_BITS) - 1;
        let part = f64::from_bits(((bits << STEPS_LOG2) & fraction) | (BIAS << FRACTION_BITS)) - 1.0;
        between(&self.values, node, part)
    }
}

/// `part` of the way from a node to the next.
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
    fn the_table_is_the_law() {
        for (power, power_inside) in [(3.0, 6.0), (0.0, 20.0), (20.0, 1.5), (0.0, 0.0)] {
            let config = StrayLightConfig { exclusion_deg: 40.0, transmittance: 1e-40, power, power_inside };
            let table = TransmittanceTable::new(&config);
            let half: f64 = 0.5 * f64::max(power, power_inside);
            let bound = 2.0 * half * (half + 1.0) / 8.0 / (512.0 * 512.0) + 1e-9;
            for i in 0..=18_000_i32 {
                let angle = f64::from(i).to_radians() / 100.0;
                let (got, expected) =
                    (table.transmittance_at_cos(libm::cos(angle)), config.transmittance_at_angle(angle));
                // Without the steps of the bends: a step is 0.04° wide at 40°, 0.001° at 1°, where the law ends.
                if (i - 4000).abs() > 10 && i != 100 {
                    assert!((got / expected - 1.0).abs() < bound, "{power}, {angle}: {got} for {expected}");
                }
                assert!((got / expected - 1.0).abs() < 0.006);
            }
        }
    }
}
