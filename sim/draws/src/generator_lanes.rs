//! Random words for bulk draws: eight generators side by side, which a machine with wide registers steps
//! together.

use pulp::Simd;

use crate::streams::{GOLDEN_GAMMA, Streams, split_mix};

/// Number of generators.
pub const LANES: usize = 8;

/// Eight generators xoshiro256++ (Blackman & Vigna 2019), stepped together.
///
/// Word i is number i / 8 of generator i % 8. Generator 0 is the stream with this index; generator l is keyed
/// by the four numbers 4 l … 4 l + 3 of the SplitMix64 whose first four numbers key generator 0.
#[derive(Debug, Clone)]
pub struct GeneratorLanes {
    state: [[u64; LANES]; 4],
}

impl GeneratorLanes {
    /// Creates the generators for an index of one effect in one frame. An index uses either these or its
    /// stream.
    #[inline(always)]
    pub fn from_streams(streams: &Streams, index: u64) -> Self {
        let base = streams.key_at(index);
        let state = std::array::from_fn(|part| {
            std::array::from_fn(|lane| {
                let number = (4 * lane + part) as u64;
                split_mix(base.wrapping_add(GOLDEN_GAMMA.wrapping_mul(number)))
            })
        });
        Self { state }
    }

    /// Next word of every generator.
    #[inline(always)]
    pub fn next_words(&mut self) -> [u64; LANES] {
        let [s0, s1, s2, s3] = &mut self.state;
        let mut words = [0; LANES];
        for lane in 0..LANES {
            words[lane] = s0[lane].wrapping_add(s3[lane]).rotate_left(23).wrapping_add(s0[lane]);
            let shifted = s1[lane] << 17;
            s2[lane] ^= s0[lane];
            s3[lane] ^= s1[lane];
            s1[lane] ^= s2[lane];
            s0[lane] ^= s3[lane];
            s2[lane] ^= shifted;
            s3[lane] = s3[lane].rotate_left(45);
        }
        words
    }

    /// Steps every generator `times` times and passes the number of each step and its words to `visit`.
    ///
    /// It must be called in a separate function ([`Simd::vectorize`]): inside a larger function the
    /// generators would not stay in registers.
    #[inline(always)]
    pub fn steps<S: Simd>(&mut self, _: S, times: usize, mut visit: impl FnMut(usize, [u64; LANES])) {
        #[cfg(target_arch = "x86_64")]
        if std::any::TypeId::of::<S>() == std::any::TypeId::of::<pulp::x86::V3>()
            && let Some(registers) = pulp::x86::V3::try_new()
        {
            return avx2::steps(registers, self, times, visit);
        }
        for step in 0..times {
            visit(step, self.next_words());
        }
    }
}

/// Steps written in AVX2 instructions: AVX2 has no rotation, and the compiler computes one of the rotations
/// for each number separately.
#[cfg(target_arch = "x86_64")]
mod avx2 {
    use pulp::x86::V3;
    use pulp::{cast, u64x4};

    use super::{GeneratorLanes, LANES};

    /// Number of registers for one part of the state of all generators.
    const REGISTERS: usize = 2;

    #[inline(always)]
    pub(super) fn steps(
        v: V3,
        lanes: &mut GeneratorLanes,
        times: usize,
        mut visit: impl FnMut(usize, [u64; LANES]),
    ) {
        let mut state: [[u64x4; REGISTERS]; 4] = lanes.state.map(cast);
        for step in 0..times {
            let [s0, s1, s2, s3] = &mut state;
            let mut words = [u64x4(0, 0, 0, 0); REGISTERS];
            for i in 0..REGISTERS {
                let sum = v.wrapping_add_u64x4(s0[i], s3[i]);
                let rotated = v.or_u64x4(v.shl_const_u64x4::<23>(sum), v.shr_const_u64x4::<41>(sum));
                words[i] = v.wrapping_add_u64x4(rotated, s0[i]);
                let shifted = v.shl_const_u64x4::<17>(s1[i]);
                s2[i] = v.xor_u64x4(s2[i], s0[i]);
                s3[i] = v.xor_u64x4(s3[i], s1[i]);
                s1[i] = v.xor_u64x4(s1[i], s2[i]);
                s0[i] = v.xor_u64x4(s0[i], s3[i]);
                s2[i] = v.xor_u64x4(s2[i], shifted);
                s3[i] = v.or_u64x4(v.shl_const_u64x4::<45>(s3[i]), v.shr_const_u64x4::<19>(s3[i]));
            }
            visit(step, cast(words));
        }
        lanes.state = state.map(cast);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Effect, Seed, Stream};
    use rand::Rng;
    use rand_xoshiro::rand_core::SeedableRng;

    #[test]
    fn every_lane_is_the_named_generator() {
        let streams = Seed { seed: 42, case: 3 }.streams(7, Effect::PixelNoise);
        let mut lanes = GeneratorLanes::from_streams(&streams, 99);
        let mut alone: Vec<Stream> = (0..LANES as u64)
            .map(|lane| {
                let key = streams.key_at(99).wrapping_add(GOLDEN_GAMMA.wrapping_mul(4 * lane));
                Stream::seed_from_u64(key)
            })
            .collect();
        let mut first = streams.stream_at(99);
        for _ in 0..1000 {
            let words = lanes.next_words();
            assert_eq!(words[0], first.next_u64());
            for (word, stream) in words.iter().zip(&mut alone) {
                assert_eq!(*word, stream.next_u64());
            }
        }
    }

    #[test]
    fn steps_are_the_same_on_all_registers() {
        struct Steps(GeneratorLanes);
        impl pulp::WithSimd for Steps {
            type Output = Vec<[u64; LANES]>;
            fn with_simd<S: Simd>(mut self, simd: S) -> Self::Output {
                let mut words_of_steps = Vec::new();
                for times in [1, 8, 0, 3] {
                    self.0.steps(simd, times, |step, words| {
                        assert!(step < times);
                        words_of_steps.push(words);
                    });
                    self.0.steps(simd, times, |_, _| ());
                }
                words_of_steps
            }
        }
        let streams = Seed { seed: 42, case: 3 }.streams(7, Effect::PixelNoise);
        let mut lanes = GeneratorLanes::from_streams(&streams, 99);
        let all: Vec<_> = (0..24).map(|_| lanes.next_words()).collect();
        let expected = [&all[..1], &all[2..10], &all[18..21]].concat();
        for registers in registers() {
            assert_eq!(
                registers.dispatch(Steps(GeneratorLanes::from_streams(&streams, 99))),
                expected,
                "{registers:?}"
            );
        }
        assert_eq!(pulp::Arch::Scalar.dispatch(Steps(GeneratorLanes::from_streams(&streams, 99))), expected);
    }

    /// Returns all registers of the machine, narrowest first.
    fn registers() -> Vec<pulp::Arch> {
        let mut all = vec![pulp::Arch::Scalar];
        #[cfg(target_arch = "x86_64")]
        {
            all.extend(pulp::x86::V3::try_new().map(pulp::Arch::V3));
            all.extend(pulp::x86::V4::try_new().map(pulp::Arch::V4));
        }
        #[cfg(not(target_arch = "x86_64"))]
        all.push(pulp::Arch::new());
        all
    }

    /// Words of neighbouring lanes, and of one lane at neighbouring indices, differ in half of their bits.
    #[test]
    fn neighbouring_lanes_and_positions_share_bits_only_by_chance() {
        let streams = Seed { seed: 1, case: 0 }.streams(0, Effect::PixelNoise);
        let (mut differ, mut bits) = (0_u64, 0_u64);
        for index in 0..500 {
            let (mut here, mut next) = (
                GeneratorLanes::from_streams(&streams, index),
                GeneratorLanes::from_streams(&streams, index + 1),
            );
            for _ in 0..5 {
                let (a, b) = (here.next_words(), next.next_words());
                for lane in 0..LANES {
                    differ += u64::from((a[lane] ^ a[(lane + 1) % LANES]).count_ones());
                    differ += u64::from((a[lane] ^ b[lane]).count_ones());
                    bits += 128;
                }
            }
        }
        // Binomial with standard deviation sqrt(bits)/2; the limit is four of them.
        assert!((differ as f64 - bits as f64 / 2.0).abs() < 2.0 * (bits as f64).sqrt(), "{differ} of {bits}");
    }
}
