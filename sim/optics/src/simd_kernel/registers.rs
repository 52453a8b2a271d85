//! Choice of the registers in tests: the result of a kernel depends on none of them.

use std::cell::Cell;

thread_local! {
    static REQUESTED: Cell<Option<pulp::Arch>> = const { Cell::new(None) };
}

/// Returns the registers that the test on this thread requests.
pub(super) fn requested() -> Option<pulp::Arch> {
    REQUESTED.get()
}

/// Returns all registers of the machine, narrowest first.
pub fn registers() -> Vec<pulp::Arch> {
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

/// Asserts that work with kernels has the same result on all registers.
pub fn same_on_all_registers<T: PartialEq>(work: impl Fn() -> T) {
    let on = |registers: pulp::Arch| {
        REQUESTED.set(Some(registers));
        let result = work();
        REQUESTED.set(None);
        result
    };
    let narrowest = on(pulp::Arch::Scalar);
    for registers in registers() {
        assert!(on(registers) == narrowest, "{registers:?}");
    }
}
