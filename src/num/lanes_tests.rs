//! Operations in lanes are, bit for bit, those of scalars.

use fearless_simd::{Level, Simd, SimdBase, dispatch};

use super::lanes::load_quads;
use super::{F32Lanes, MAX_LANES, Real, Single, Twice, load_quads_twice};

/// A test that runs with vectors of every width that the processor supports.
pub(crate) trait LaneTest {
    fn run<S: Simd>(&self, simd: S);
}

/// Runs `test` at every level of vector instructions that the processor supports.
pub(crate) fn at_every_level(test: &impl LaneTest) {
    let widest = Level::try_detect().unwrap_or(Level::baseline());
    dispatch!(widest, simd => test.run(simd));
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    {
        if let Some(avx2) = widest.as_avx2() {
            dispatch!(Level::Avx2(avx2), simd => test.run(simd));
        }
        if let Some(sse2) = widest.as_sse2() {
            dispatch!(Level::Sse2(sse2), simd => test.run(simd));
        }
    }
}

/// Stores the numbers of the lanes; those past the last lane are zero.
pub(crate) fn to_array<S: Simd>(vector: F32Lanes<S>) -> [f32; MAX_LANES] {
    let mut lanes = [0.0; MAX_LANES];
    vector.0.store_slice(&mut lanes[..S::f32s::LEN]);
    lanes
}

/// Ordinary numbers, and edge cases at which implementations differ.
const NUMBERS: [f32; MAX_LANES] = [
    0.0,
    -0.0,
    1.0,
    -1.5,
    0.1,
    3.0e38,
    -3.0e38,
    f32::MIN_POSITIVE,
    1.0e-45,
    f32::INFINITY,
    f32::NEG_INFINITY,
    f32::NAN,
    -7.25e-20,
    6.5e19,
    2.0,
    1.000_000_1,
];

/// Whether both have the same bits, or both are NaN.
fn is_same(a: f32, b: f32) -> bool {
    a.to_bits() == b.to_bits() || (a.is_nan() && b.is_nan())
}

type Binary<N> = fn(N, N) -> N;

/// Operations that must give the same bits in lanes as for scalars.
fn operations<N: Single>() -> [(&'static str, Binary<N>); 22] {
    fn selected<N: Single>(mask: N::Mask, a: N, b: N) -> N {
        N::select(mask, a, b)
    }
    fn in_double<N: Single>(a: N, b: N, f: fn(N::Double, N::Double) -> N::Double) -> N {
        N::narrow(f(a.widen(), b.widen()))
    }
    [
        ("sum", |a, b| a + b),
        ("difference", |a, b| a - b),
        ("product", |a, b| a * b),
        ("quotient", |a, b| a / b),
        ("max", Real::max),
        ("min", Real::min),
        ("abs", |a, _| a.abs()),
        ("sqrt", |a, _| a.sqrt()),
        ("copysign", Real::copysign),
        ("negation", |a, _| -a),
        ("one_minus", |a, _| a.one_minus()),
        ("gt", |a, b| selected(a.gt(b), a, b)),
        ("le", |a, b| selected(a.le(b), a, b)),
        ("eq", |a, b| selected(a.eq(b), a, b)),
        ("is_finite", |a, b| selected(a.is_finite(), a, b)),
        ("double product", |a, b| in_double(a, b, |a, b| a * b)),
        ("double max", |a, b| in_double(a, b, Real::max)),
        ("double min", |a, b| in_double(a, b, Real::min)),
        ("double gt", |a, b| selected(a.widen().gt(b.widen()), a, b)),
        ("per lane", |a, b| N::per_lane([a, b], |_, [a, b]| a - b)),
        ("power", |a, _| a.power_in_last_bits()),
        ("with power", |a, b| a.with_power_in_last_bits(b.abs())),
    ]
}

struct SameAsScalars;

impl LaneTest for SameAsScalars {
    fn run<S: Simd>(&self, simd: S) {
        let operations = operations::<F32Lanes<S>>()
            .into_iter()
            .zip(self::operations::<f32>());
        for ((name, in_lanes), (_, alone)) in operations {
            for start in (0..MAX_LANES).step_by(S::f32s::LEN) {
                let a = F32Lanes::new(simd, 0.0).load(&NUMBERS[start..]);
                for b in NUMBERS {
                    let found = to_array(in_lanes(a, F32Lanes::new(simd, b)));
                    for (a, found) in NUMBERS[start..][..S::f32s::LEN].iter().zip(found) {
                        let expected = alone(*a, b);
                        assert!(is_same(found, expected), "{name} of {a} and {b}: {found}");
                    }
                }
            }
        }
    }
}

#[test]
fn lanes_do_what_scalars_do() {
    at_every_level(&SameAsScalars);
}

struct TwiceTheSame;

impl LaneTest for TwiceTheSame {
    fn run<S: Simd>(&self, simd: S) {
        let operations = operations::<Twice<F32Lanes<S>>>()
            .into_iter()
            .zip(self::operations::<F32Lanes<S>>());
        let reversed: [f32; MAX_LANES] = core::array::from_fn(|i| NUMBERS[MAX_LANES - 1 - i]);
        let same = |a, b| {
            to_array::<S>(a)
                .into_iter()
                .zip(to_array(b))
                .all(|(a, b)| is_same(a, b))
        };
        for ((name, of_both), (_, of_one)) in operations {
            for start in (0..MAX_LANES).step_by(S::f32s::LEN) {
                let like = F32Lanes::new(simd, 0.0);
                let (a, b) = (like.load(&NUMBERS[start..]), like.load(&reversed[start..]));
                for c in NUMBERS.map(|c| F32Lanes::new(simd, c)) {
                    let Twice(first, second) = of_both(Twice(a, b), Twice(c, a));
                    assert!(same(first, of_one(a, c)), "{name}");
                    assert!(same(second, of_one(b, a)), "{name}");
                }
            }
        }
    }
}

#[test]
fn twice_does_what_each_of_two_does() {
    at_every_level(&TwiceTheSame);
}

struct NumberedOn;

impl LaneTest for NumberedOn {
    fn run<S: Simd>(&self, simd: S) {
        let (lanes, zero) = (S::f32s::LEN, F32Lanes::new(simd, 0.0));
        let both = Twice(zero, zero);
        let place = |lane: usize| lane as f32;
        let gathered = both.gather(place);
        let per_lane = Single::per_lane([both], |lane, [zero]| place(lane) + zero);
        let numbers: [f32; 2 * MAX_LANES] = core::array::from_fn(place);
        let quads = numbers.map(|number| [number, 0.5, number + 100.0, number + 200.0]);
        let [x, half, z, w] = load_quads_twice(simd, &quads[..2 * lanes]);
        let sums = Single::per_lane_quads([x, half, z, w], z.gt(w), |[x, half, z, w], flag| {
            [[x, half, z, w], [x + half, z + w, f32::from(flag), 0.0]]
        });
        let all = [gathered, per_lane, both.load(&numbers), x, sums[0][0]];
        for (lane, number) in numbers[..2 * lanes].iter().enumerate() {
            let of = |Twice(first, second)| {
                [to_array::<S>(first), to_array(second)][lane / lanes][lane % lanes]
            };
            assert_eq!(all.map(of), [*number; 5]);
            let expected = [number + 0.5, 2.0 * number + 300.0, 0.0, 0.0];
            assert_eq!(sums[1].map(of), expected);
        }
    }
}

#[test]
fn the_lanes_of_a_second_vector_are_numbered_on() {
    at_every_level(&NumberedOn);
}

#[test]
fn the_second_operand_is_taken_for_nan() {
    for (a, b) in [(f32::NAN, 2.0), (2.0, f32::NAN)] {
        assert!(is_same(Real::max(a, b), b) && is_same(Real::min(a, b), b));
    }
}

#[test]
fn the_last_bits_keep_the_next_power_of_two() {
    let (first, last) = (1.0 / 65_536.0, 16_384.0);
    let below = [(0.0, first), (1e-30, first), (first, first)];
    let within = [
        (1.6e-5, 2.0 * first),
        (0.25, 0.25),
        (0.26, 0.5),
        (last, last),
    ];
    let above = [last + 1.0, f32::MAX, f32::INFINITY].map(|least| (least, f32::INFINITY));
    for (least, expected) in below.into_iter().chain(within).chain(above) {
        for number in [0.1_f32, 1.0, 3.7e9, -2.5e-20] {
            let with_power = number.with_power_in_last_bits(least);
            assert_eq!(with_power.power_in_last_bits(), expected, "{least}");
            assert!(with_power.to_bits().abs_diff(number.to_bits()) < 32);
        }
    }
}

struct Transposed;

impl LaneTest for Transposed {
    fn run<S: Simd>(&self, simd: S) {
        let quads = core::array::from_fn::<_, MAX_LANES, _>(|i| {
            core::array::from_fn(|j| (10 * i + j) as f32)
        });
        for (j, vector) in load_quads(simd, &quads[..S::f32s::LEN])
            .into_iter()
            .enumerate()
        {
            for (i, number) in to_array(vector)[..S::f32s::LEN].iter().enumerate() {
                assert_eq!(*number, (10 * i + j) as f32);
            }
        }
    }
}

#[test]
fn quads_are_transposed() {
    at_every_level(&Transposed);
}
