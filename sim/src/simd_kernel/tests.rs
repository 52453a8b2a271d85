use std::cell::Cell;
use std::path::Path;

use super::*;
use crate::truth::TrajectorySource;
use crate::{PixelSelection, Simulation, Simulator};

// Simulation that the integration tests use.
#[path = "../../tests/it/argon.rs"]
mod argon;

thread_local! {
    static REQUESTED: Cell<Option<pulp::Arch>> = const { Cell::new(None) };
}

/// Returns the registers that the test on this thread requests.
pub(super) fn requested() -> Option<pulp::Arch> {
    REQUESTED.get()
}

/// Returns all registers of the machine, narrowest first.
pub(crate) fn registers() -> Vec<pulp::Arch> {
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

/// All bits of a frame, of its expected image, and of its truth and telemetry.
type Bits = (Vec<u16>, Vec<u64>, String);

/// Frames of the first, third and fifth day, drawn first only where the camera needs them and then
/// completely.
fn bits_of_frames(simulation: &Simulation) -> Vec<Bits> {
    let simulator = Simulator::new(simulation, Path::new("")).unwrap();
    let mut bits = Vec::new();
    for drawing in [PixelSelection::Needed, PixelSelection::All] {
        let mut camera = simulator.camera().unwrap().with_pixel_selection(drawing);
        for number in [300, 5000, 14_000] {
            let exposure = camera.expose(number).unwrap();
            let expected = camera.expected().iter().map(f64::to_bits).collect();
            // Debug prints enough digits to distinguish a number from its neighbours, and the sign of 0.
            let text = format!("{:?} {:?} {:?}", exposure.truth, exposure.telemetry, exposure.objects);
            bits.push((exposure.frame.dn().to_vec(), expected, text));
        }
    }
    bits
}

/// Asserts that work that calls [`arch`] has the same result on all registers.
pub(crate) fn same_on_all_registers<T: PartialEq>(work: impl Fn() -> T) {
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

/// The fast path takes the steps of the slow path on wider registers.
#[test]
fn frames_are_the_same_bits_on_all_registers() {
    let argon = argon::simulation();
    for simulation in [Simulation { roi: None, ..argon.clone() }, argon] {
        same_on_all_registers(|| bits_of_frames(&simulation));
    }
}

/// All operations, on numbers whose results depend on the order of rounding.
struct All<'a>(&'a [[f64; LANES]; 3]);

impl SimdKernel for All<'_> {
    type Output = Vec<u64>;
    fn run<S: Simd>(self, simd: S) -> Vec<u64> {
        let [a, b, c] = self.0.each_ref().map(|numbers| F64x8::from_array(simd, numbers));
        let narrow = self.0[0].map(|number| number as f32);
        let eights = [
            a.plus(b),
            a.times(b).plus(c),
            a.over(b),
            a.max(b),
            b.zero_below(c),
            F64x8::from_f32(simd, &narrow),
            F64x8::splat(simd, 0.1),
        ];
        let folded = [a.plus(b).sum(), b.largest()];
        eights.into_iter().flat_map(F64x8::to_array).chain(folded).map(f64::to_bits).collect()
    }
}

#[test]
fn eight_lanes_agree_with_single_numbers_on_any_registers() {
    let numbers = [0, 1, 2]
        .map(|k| std::array::from_fn(|i| libm::sin((8 * k + i) as f64) * libm::pow(10.0, (i % 3) as f64)));
    let [a, b, c] = numbers;
    let each = |step: &dyn Fn(usize) -> f64| (0..LANES).map(step).collect::<Vec<f64>>();
    let mut expected: Vec<f64> = [
        each(&|i| a[i] + b[i]),
        each(&|i| a[i] * b[i] + c[i]),
        each(&|i| a[i] / b[i]),
        each(&|i| a[i].max(b[i])),
        each(&|i| if b[i] < c[i] { 0.0 } else { b[i] }),
        each(&|i| f64::from(a[i] as f32)),
        each(&|_| 0.1),
    ]
    .concat();
    let s: Vec<f64> = each(&|i| a[i] + b[i]);
    expected.push(((s[0] + s[1]) + (s[2] + s[3])) + ((s[4] + s[5]) + (s[6] + s[7])));
    expected.push(b.into_iter().fold(0.0, f64::max));
    let expected: Vec<u64> = expected.into_iter().map(f64::to_bits).collect();
    assert_eq!(run_widest(All(&numbers)), expected);
    assert_eq!(All(&numbers).run(pulp::Scalar::new()), expected);
}
