//! Loops on the widest registers of the machine.

/// Something that is done in loops over many numbers.
pub(crate) trait Work {
    /// What it gives.
    type Output;
    /// Does it. To be inlined always, with all that it calls: what is not is compiled for any machine.
    fn run(self) -> Self::Output;
}

/// Does some work compiled for the widest registers that the machine has: the same steps everywhere, on as many numbers at a time
/// as fit. The compiler neither reorders floating-point operations nor joins them, so the bits do not depend on it.
#[inline(always)]
pub(crate) fn widest<W: Work>(work: W) -> W::Output {
    struct Widest<W>(W);
    impl<W: Work> pulp::WithSimd for Widest<W> {
        type Output = W::Output;
        #[inline(always)]
        fn with_simd<S: pulp::Simd>(self, _: S) -> W::Output {
            self.0.run()
        }
    }
    pulp::Arch::new().dispatch(Widest(work))
}

/// Does `step` with each of `of` and its partner of `with`, as far as both go: by eights, then one by one. The rows of an image of a
/// star are short, shorter than the rounds that the compiler makes of a loop by itself.
#[inline(always)]
pub(crate) fn by_eights<A, B: Copy>(of: &mut [A], with: &[B], step: impl Fn(&mut A, B)) {
    let length = of.len().min(with.len());
    let (of, of_rest) = of[..length].as_chunks_mut::<8>();
    let (with, with_rest) = with[..length].as_chunks::<8>();
    for (of, with) in of.iter_mut().zip(with) {
        for i in 0..8 {
            step(&mut of[i], with[i]);
        }
    }
    for (of, &with) in of_rest.iter_mut().zip(with_rest) {
        step(of, with);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_pair_is_met_once() {
        for (of, with) in [(0, 3), (7, 7), (8, 9), (29, 23), (17, 40)] {
            let mut sums: Vec<usize> = (0..of).collect();
            by_eights(&mut sums, &(0..with).collect::<Vec<usize>>(), |sum, number| *sum += 100 * number + 1);
            let expected: Vec<usize> = (0..of).map(|i| if i < with { 101 * i + 1 } else { i }).collect();
            assert_eq!(sums, expected);
        }
    }
}
