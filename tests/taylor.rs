//! What the certificate of the tight bound calculates with: each operation on functions over a box contains
//! what it stands for, to the last of what it says it is off by.

use fastrand::Rng;
use support::certificate::{
    Angles, Interval, Real, Taylor, root,
    taylor::{PerVariable, VARIABLES},
};

const CASES: usize = 2000;

/// Between −1 and 1, and often at an end.
fn side(rng: &mut Rng) -> f64 {
    match rng.u8(..3) {
        0 => -1.0,
        1 => 1.0,
        _ => 2.0 * rng.f64() - 1.0,
    }
}

fn polynomial(form: &Taylor, u: &PerVariable) -> f64 {
    let mut value = form.constant;
    for i in 0..VARIABLES {
        value += form.linear[i] * u[i];
        for k in 0..3 {
            value += form.quadratic[k][i] * u[i] * u[(i + k) % VARIABLES];
        }
    }
    value
}

fn rest(form: &Taylor) -> f64 {
    form.rest.iter().sum()
}

/// A form about `constant` that varies by about `size`, with squares and products, a rest, or both.
fn form(rng: &mut Rng, constant: f64, size: f64) -> Taylor {
    let (polynomial, rest) = [(1.0, 0.0), (0.0, 1.0), (0.8, 0.2)][rng.usize(..3)];
    let mut sum = Taylor::constant(constant);
    for i in 0..VARIABLES {
        let pair = [i, rng.usize(..VARIABLES)];
        let [a, b] = pair.map(|i| {
            let reach = size.sqrt() * rng.f64();
            Taylor::variable(Interval::new(-reach, reach), i)
        });
        let [first, second] = [0, 1].map(|_| 0.3 * polynomial * side(rng));
        sum = sum + a * (size.sqrt() * first) + a * b * second;
    }
    let shares = [0.2; VARIABLES];
    sum.widened(rest * size * rng.f64(), shares)
}

/// Checks `result` against `exact`, of functions that the `inputs` contain.
fn check(
    rng: &mut Rng,
    name: &str,
    inputs: &[Taylor],
    result: &Taylor,
    is_within: impl Fn(&[f64], f64, f64) -> bool,
) {
    for _ in 0..40 {
        let u: PerVariable = std::array::from_fn(|_| side(rng));
        let values: Vec<f64> = inputs
            .iter()
            .map(|input| polynomial(input, &u) + side(rng) * rest(input))
            .collect();
        let (value, off) = (
            polynomial(result, &u),
            rest(result) + 1e-14 * result.reach(),
        );
        assert!(
            is_within(&values, value, off),
            "{name} of {values:?} at {u:?}: {value} ± {off} of {result:?}"
        );
    }
}

/// An operation on one function, in forms and in numbers, where it is smooth for this much around 1.
type Operation = (&'static str, f64, fn(Taylor) -> Taylor, fn(f64) -> f64);

#[test]
fn functions_of_one_contain() {
    let operations: [Operation; 6] = [
        ("square", 3.0, Real::square, |x| x * x),
        ("reciprocal", 0.3, |x| x.reciprocal(), |x| 1.0 / x),
        ("root", 0.3, Real::sqrt, f64::sqrt),
        (
            "reciprocal root",
            0.3,
            |x| x.reciprocal_root(),
            |x| 1.0 / x.sqrt(),
        ),
        ("fifth power", 1.0, |x| x.fifth_power(), |x| x.powi(5)),
        ("multiple", 3.0, |x| x * -1.7, |x| x * -1.7),
    ];
    let mut rng = Rng::with_seed(1);
    for (name, size, of_form, of_number) in operations {
        let mut finite = 0;
        for _ in 0..CASES {
            let scale = 10.0_f64.powf(4.0 * rng.f64() - 2.0);
            let input = form(&mut rng, 1.0, size) * scale;
            let result = of_form(input);
            if !result.is_finite() {
                continue;
            }
            finite += 1;
            check(&mut rng, name, &[input], &result, |x, value, off| {
                let exact = of_number(x[0]);
                (exact - value).abs() <= off + 1e-13 * exact.abs()
            });
        }
        assert!(finite > CASES / 2, "{name}: {finite} of {CASES} are finite");
    }
}

#[test]
fn sums_and_products_contain() {
    type Binary = (
        &'static str,
        fn(Taylor, Taylor) -> Taylor,
        fn(f64, f64) -> f64,
    );
    let operations: [Binary; 3] = [
        ("sum", |x, y| x + y, |x, y| x + y),
        ("difference", |x, y| x - y, |x, y| x - y),
        ("product", |x, y| x * y, |x, y| x * y),
    ];
    let mut rng = Rng::with_seed(2);
    for (name, of_forms, of_numbers) in operations {
        for _ in 0..CASES {
            let inputs = [0, 1].map(|_| {
                let constant = side(&mut rng);
                form(&mut rng, constant, 3.0)
            });
            let result = of_forms(inputs[0], inputs[1]);
            check(&mut rng, name, &inputs, &result, |x, value, off| {
                (of_numbers(x[0], x[1]) - value).abs() <= off + 1e-13
            });
        }
    }
}

/// Where the number has a root, the other side of zero included in the form.
#[test]
fn what_stands_in_for_a_root_is_no_less() {
    let mut rng = Rng::with_seed(3);
    for _ in 0..CASES {
        let constant = side(&mut rng);
        let input = form(&mut rng, constant, 1.0);
        if input.range().high <= 0.0 {
            continue;
        }
        let (result, _) = root(&input);
        check(&mut rng, "root", &[input], &result, |x, value, off| {
            x[0] < 0.0 || value + off >= x[0].sqrt()
        });
    }
}

/// Over boxes of any size, at the corner too where τ has no derivative.
#[test]
fn angles_contain() {
    let mut rng = Rng::with_seed(5);
    for _ in 0..CASES {
        let width = 0.5_f64.powi(rng.i32(2..10));
        let mut side_of = |least: f64, most: f64| {
            let low = (least + (most - least) * rng.f64()).min(most - width);
            Interval::new(low, low + width)
        };
        let (x, mut y) = (side_of(0.0, 1.0), side_of(0.0, 2.0));
        if rng.u8(..4) == 0 {
            y = Interval::new(1.0 - 0.3 * width, 1.0 + 0.7 * width);
        }
        let (tau, sigma) = Angles::new(x, y).taylor(x, y);
        for _ in 0..10 {
            let [a, b] = [side(&mut rng), side(&mut rng)];
            let there = [(x, a), (y, b)].map(|(at, u)| at.middle() + 0.5 * u * at.width());
            let [x, y] = there.map(Interval::at);
            let exact = Angles::new(x, y);
            let u = [a, b, 0.0, 0.0, 0.0];
            for (form, exact) in [(tau, exact.tau), (sigma, exact.sigma)] {
                let off = (polynomial(&form, &u) - exact.middle()).abs();
                assert!(off <= rest(&form) + 1e-13, "{off} at {there:?}: {form:?}");
            }
        }
    }
}

#[test]
fn range_and_most_contain() {
    let mut rng = Rng::with_seed(4);
    for _ in 0..CASES {
        let input = form(&mut rng, 0.0, 2.0);
        let (Interval { low, high }, most) = (input.range(), input.most());
        let same = Taylor::constant(0.0);
        check(&mut rng, "range", &[input], &same, |x, _, _| {
            low <= x[0] && x[0] <= high && x[0] <= most
        });
    }
}
