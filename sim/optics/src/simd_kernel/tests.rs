use super::*;

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
