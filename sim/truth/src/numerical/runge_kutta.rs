//! Steps of the explicit Runge–Kutta method of order 8 by Dormand and Prince.
//!
//! Coefficients of DOP853 (Hairer, Nørsett & Wanner, *Solving Ordinary Differential Equations I*, 2nd edition
//! 1993, Sec. II.5 and II.10) without its error estimate: steps have a fixed size. All sums have a fixed
//! order, so the bits depend on the arguments only.

use nalgebra::Vector3;

use crate::orbit::State;

/// Number of stages.
const STAGES: usize = 12;

/// Nodes of the stages.
const NODES: [f64; STAGES] = [
    0.0,
    0.052_600_151_958_767_73,
    0.078_900_227_938_151_6,
    0.118_350_341_907_227_4,
    0.281_649_658_092_772_6,
    0.333_333_333_333_333_3,
    0.25,
    0.307_692_307_692_307_7,
    0.651_282_051_282_051_3,
    0.6,
    0.857_142_857_142_857_1,
    1.0,
];

/// Weights of the earlier stages in each stage after the first, as (stage, weight).
const STAGE_WEIGHTS: [&[(usize, f64)]; STAGES - 1] = [
    &[(0, 0.052_600_151_958_767_73)],
    &[(0, 0.019_725_056_984_537_9), (1, 0.059_175_170_953_613_7)],
    &[(0, 0.029_587_585_476_806_85), (2, 0.088_762_756_430_420_54)],
    &[(0, 0.241_365_134_159_266_7), (2, -0.884_549_479_328_286_1), (3, 0.924_834_003_261_792)],
    &[(0, 0.037_037_037_037_037_035), (3, 0.170_828_608_729_473_86), (4, 0.125_467_687_566_822_42)],
    &[(0, 0.037_109_375), (3, 0.170_252_211_019_544_05), (4, 0.060_216_538_980_455_96), (5, -0.017_578_125)],
    &[
        (0, 0.037_092_000_118_504_79),
        (3, 0.170_383_925_712_239_98),
        (4, 0.107_262_030_446_373_28),
        (5, -0.015_319_437_748_624_402),
        (6, 0.008_273_789_163_814_023),
    ],
    &[
        (0, 0.624_110_958_716_075_7),
        (3, -3.360_892_629_446_941_4),
        (4, -0.868_219_346_841_726),
        (5, 27.592_099_699_446_71),
        (6, 20.154_067_550_477_894),
        (7, -43.489_884_181_069_96),
    ],
    &[
        (0, 0.477_662_536_438_264_34),
        (3, -2.488_114_619_971_667_7),
        (4, -0.590_290_826_836_843),
        (5, 21.230_051_448_181_193),
        (6, 15.279_233_632_882_423),
        (7, -33.288_210_968_984_86),
        (8, -0.020_331_201_708_508_627),
    ],
    &[
        (0, -0.937_142_430_085_987_3),
        (3, 5.186_372_428_844_064),
        (4, 1.091_437_348_996_729_5),
        (5, -8.149_787_010_746_927),
        (6, -18.520_065_659_996_96),
        (7, 22.739_487_099_350_505),
        (8, 2.493_605_552_679_652_3),
        (9, -3.046_764_471_898_219_6),
    ],
    &[
        (0, 2.273_310_147_516_538),
        (3, -10.534_495_466_737_25),
        (4, -2.000_872_058_224_862_5),
        (5, -17.958_931_863_118_8),
        (6, 27.948_884_529_419_96),
        (7, -2.858_998_277_135_023_5),
        (8, -8.872_856_933_530_63),
        (9, 12.360_567_175_794_303),
        (10, 0.643_392_746_015_763_6),
    ],
];

/// Weights of the stages in the step.
const WEIGHTS: [(usize, f64); 8] = [
    (0, 0.054_293_734_116_568_765),
    (5, 4.450_312_892_752_409),
    (6, 1.891_517_899_314_500_3),
    (7, -5.801_203_960_010_585),
    (8, 0.311_164_366_957_819_9),
    (9, -0.152_160_949_662_516_1),
    (10, 0.201_365_400_804_030_34),
    (11, 0.044_710_615_727_772_59),
];

/// Returns the state after a step from `state` at `time_s`, whose acceleration is `initial`, km/s².
/// `acceleration` is a function of time, s, and state.
pub(super) fn step(
    time_s: f64,
    step_s: f64,
    state: &State,
    initial: Vector3<f64>,
    mut acceleration: impl FnMut(f64, &State) -> Vector3<f64>,
) -> State {
    let mut velocities = [state.velocity_km_s; STAGES];
    let mut accelerations = [initial; STAGES];
    let advance = |weights: &[(usize, f64)], velocities: &[Vector3<f64>], accelerations: &[Vector3<f64>]| {
        let (mut position, mut velocity) = (Vector3::zeros(), Vector3::zeros());
        for &(stage, weight) in weights {
            position += velocities[stage] * weight;
            velocity += accelerations[stage] * weight;
        }
        State {
            position_km: state.position_km + position * step_s,
            velocity_km_s: state.velocity_km_s + velocity * step_s,
        }
    };
    for (stage, weights) in (1..).zip(STAGE_WEIGHTS) {
        let at_stage = advance(weights, &velocities, &accelerations);
        velocities[stage] = at_stage.velocity_km_s;
        accelerations[stage] = acceleration(time_s + NODES[stage] * step_s, &at_stage);
    }
    advance(&WEIGHTS, &velocities, &accelerations)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Order conditions of the quadrature up to order 8: Σ bᵢ cᵢᵏ = 1/(k + 1); and of the stages: Σⱼ aᵢⱼ =
    /// cᵢ.
    #[test]
    fn the_coefficients_satisfy_the_order_conditions() {
        for k in 0..8_u8 {
            let sum: f64 = WEIGHTS
                .iter()
                .map(|&(stage, weight)| weight * (0..k).map(|_| NODES[stage]).product::<f64>())
                .sum();
            assert!((sum * f64::from(k + 1) - 1.0).abs() < 1e-13, "{k}: {sum}");
        }
        for (node, weights) in NODES.iter().skip(1).zip(STAGE_WEIGHTS) {
            let sum: f64 = weights.iter().map(|(_, weight)| weight).sum();
            assert!((sum - node).abs() < 1e-13, "{node} {sum}");
        }
    }

    /// A harmonic oscillator of 1 rad/s over one revolution: the error falls by 2⁸ for half the step.
    #[test]
    fn the_method_has_order_eight() {
        let error = |steps: u32| {
            let step_s = 2.0 * std::f64::consts::PI / f64::from(steps);
            let mut state = State { position_km: Vector3::x(), velocity_km_s: Vector3::y() };
            for k in 0..steps {
                let start = -state.position_km;
                state = step(f64::from(k) * step_s, step_s, &state, start, |_, state| -state.position_km);
            }
            (state.position_km - Vector3::x()).norm()
        };
        let order = libm::log2(error(8) / error(16));
        assert!((7.7..9.0).contains(&order), "{order}");
    }
}
