//! Loops compiled for the widest registers of the machine.

use pulp::Simd;

/// Number of values in an `Eight`: as many as the widest existing registers hold.
pub const LANES: usize = 8;

/// Work done in loops over many numbers.
pub trait SimdKernel {
    /// Result of the work.
    type Output;
    /// Performs the work. Must always be inlined, with all functions that it calls: a function that is not
    /// inlined is compiled for a generic machine.
    fn run<S: Simd>(self, simd: S) -> Self::Output;
}

/// Performs work compiled for the widest registers of the machine: the same steps everywhere, on as many
/// numbers at a time as fit. No operation is fused with another or reordered; the resulting bits are
/// therefore independent of the registers.
#[inline(always)]
pub fn run_widest<W: SimdKernel>(work: W) -> W::Output {
    struct Widest<W>(W);
    impl<W: SimdKernel> pulp::WithSimd for Widest<W> {
        type Output = W::Output;
        #[inline(always)]
        fn with_simd<S: Simd>(self, simd: S) -> W::Output {
            self.0.run(simd)
        }
    }
    arch().dispatch(Widest(work))
}

/// Returns the widest registers of the machine; in tests, the registers that the test requests.
#[inline(always)]
pub fn arch() -> pulp::Arch {
    #[cfg(any(test, feature = "registers"))]
    if let Some(requested) = registers::requested() {
        return requested;
    }
    pulp::Arch::new()
}

/// Eight numbers side by side, in as few registers as the machine allows: compilers often turn short loops
/// into operations on one number at a time.
#[derive(Clone, Copy)]
pub struct F64x8<S: Simd> {
    simd: S,
    /// Registers; only the first ones, as many as eight numbers fill, are used.
    registers: [S::f64s; LANES],
}

impl<S: Simd> F64x8<S> {
    const REGISTERS: usize = LANES / S::F64_LANES;

    /// Returns eight copies of a number.
    #[inline(always)]
    pub fn splat(simd: S, number: f64) -> Self {
        Self { simd, registers: [simd.splat_f64s(number); LANES] }
    }

    /// Returns the numbers of an array.
    #[inline(always)]
    pub fn from_array(simd: S, numbers: &[f64; LANES]) -> Self {
        let mut registers = [simd.splat_f64s(0.0); LANES];
        for (register, numbers) in registers.iter_mut().zip(S::as_simd_f64s(numbers).0) {
            *register = *numbers;
        }
        Self { simd, registers }
    }

    /// Returns the numbers of an array, converted.
    #[inline(always)]
    pub fn from_f32(simd: S, numbers: &[f32; LANES]) -> Self {
        Self::from_array(simd, &std::array::from_fn(|lane| f64::from(numbers[lane])))
    }

    /// Writes the numbers to an array.
    #[inline(always)]
    pub fn store(self, numbers: &mut [f64; LANES]) {
        for (register, numbers) in self.registers.iter().zip(S::as_mut_simd_f64s(numbers).0) {
            *numbers = *register;
        }
    }

    /// Returns the numbers as an array.
    #[inline(always)]
    pub(crate) fn to_array(self) -> [f64; LANES] {
        let mut numbers = [0.0; LANES];
        self.store(&mut numbers);
        numbers
    }

    #[inline(always)]
    fn zip_with(mut self, other: Self, step: impl Fn(S, S::f64s, S::f64s) -> S::f64s) -> Self {
        for i in 0..Self::REGISTERS {
            self.registers[i] = step(self.simd, self.registers[i], other.registers[i]);
        }
        self
    }

    /// Adds each pair.
    #[inline(always)]
    pub(crate) fn plus(self, other: Self) -> Self {
        self.zip_with(other, |simd, a, b| simd.add_f64s(a, b))
    }

    /// Multiplies each pair.
    #[inline(always)]
    pub fn times(self, other: Self) -> Self {
        self.zip_with(other, |simd, a, b| simd.mul_f64s(a, b))
    }

    /// Divides each pair.
    #[inline(always)]
    pub(crate) fn over(self, other: Self) -> Self {
        self.zip_with(other, |simd, a, b| simd.div_f64s(a, b))
    }

    /// Returns the larger number of each pair; the number of `other` if either is not a number.
    #[inline(always)]
    pub fn max(self, other: Self) -> Self {
        self.zip_with(other, |simd, a, b| simd.select_f64s(simd.greater_than_f64s(a, b), a, b))
    }

    /// Returns the smaller number of each pair; the number of `other` if either is not a number.
    #[inline(always)]
    pub(crate) fn min(self, other: Self) -> Self {
        self.zip_with(other, |simd, a, b| simd.select_f64s(simd.less_than_f64s(a, b), a, b))
    }

    /// Replaces each number less than `limit` by 0.
    #[inline(always)]
    pub(crate) fn zero_below(self, limit: Self) -> Self {
        let none = self.simd.splat_f64s(0.0);
        // The addition changes no number. Without it, storing numbers back to their origin becomes a masked
        // store, which some machines perform one number at a time.
        self.zip_with(limit, |simd, a, limit| {
            simd.select_f64s(simd.less_than_f64s(a, limit), none, simd.add_f64s(a, none))
        })
    }

    /// Returns the sum, added in a fixed order.
    #[inline(always)]
    pub(crate) fn sum(self) -> f64 {
        let [a, b, c, d, e, f, g, h] = self.to_array();
        ((a + b) + (c + d)) + ((e + f) + (g + h))
    }

    /// Returns the largest number, at least 0.
    #[inline(always)]
    pub fn largest(self) -> f64 {
        self.to_array().into_iter().fold(0.0, f64::max)
    }
}

#[cfg(any(test, feature = "registers"))]
pub mod registers;
#[cfg(test)]
mod tests;
