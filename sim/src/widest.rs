//! Loops on the widest registers of the machine.

/// Does `work` compiled for the widest registers that the machine has: the same steps everywhere, on as many numbers at a time as
/// fit. The compiler neither reorders floating-point operations nor joins them, so the bits do not depend on it.
///
/// All that `work` calls is to be inlined, or it is compiled for any machine.
#[inline(always)]
pub(crate) fn widest<R>(work: impl FnOnce() -> R) -> R {
    struct Work<F>(F);
    impl<R, F: FnOnce() -> R> pulp::WithSimd for Work<F> {
        type Output = R;
        #[inline(always)]
        fn with_simd<S: pulp::Simd>(self, _: S) -> R {
            (self.0)()
        }
    }
    pulp::Arch::new().dispatch(Work(work))
}
