//! The exponential function in double precision, of sums and products alone: in lanes as for one number, and
//! the same bits on every processor and with either float backend.
//!
//! Both functions take x/1024, sum Taylor's series, and undo the division by ten steps: squares for eˣ, and
//! z ↦ z(z + 2) for eˣ − 1. Each step doubles what the relative error was, so that 2⁻⁵³ becomes 2⁻⁴² at most:
//! exact for an `f32`. The steps of eˣ − 1 even leave its relative error, which does not grow with them.

use super::Double;

/// The least argument that counts, −200: e⁻²⁰⁰ times the largest `f32` is still less than half the smallest.
const LEAST: f64 = -200.0;
/// 2⁻¹⁰
const SHARE: f64 = 1.0 / 1024.0;
/// The steps that undo it.
const STEPS: u32 = 10;

/// (eᶻ − 1)/z for |z| ≤ 0.2, by nine terms of Taylor's series: off by less than 0.2⁹/10! = 2·10⁻¹³.
#[inline(always)]
fn series<D: Double>(z: D) -> D {
    /// 1/9!, …, 1/2!
    const TERMS: [f64; 8] = [
        1.0 / 362_880.0,
        1.0 / 40_320.0,
        1.0 / 5_040.0,
        1.0 / 720.0,
        1.0 / 120.0,
        1.0 / 24.0,
        1.0 / 6.0,
        1.0 / 2.0,
    ];
    let mut sum = z.zero();
    for term in TERMS {
        sum = (sum + term) * z;
    }
    sum + 1.0
}

/// eˣ for x ≤ 0, to 10⁻⁹ of itself. Below −200 it is e⁻²⁰⁰, and so for NaN.
#[inline(always)]
pub(crate) fn exponential<D: Double>(x: D) -> D {
    let z = x.max(x.splat(LEAST)) * SHARE;
    let mut power = z * series(z) + 1.0;
    for _ in 0..STEPS {
        power = power * power;
    }
    power
}

/// 1 − e⁻ʸ for y ≥ 0, to 10⁻¹¹ of itself, however small. It is 1 for NaN.
#[inline(always)]
pub(crate) fn one_minus_exponential<D: Double>(y: D) -> D {
    let z = (-y).max(y.splat(LEAST)) * SHARE;
    let mut less_one = z * series(z);
    for _ in 0..STEPS {
        less_one = less_one * (less_one + 2.0);
    }
    -less_one
}

#[cfg(test)]
mod tests {
    use super::{exponential, one_minus_exponential};

    /// e to the power of an integer, by products.
    fn whole_power(n: u32) -> f64 {
        (0..n).fold(1.0, |power, _| power / core::f64::consts::E)
    }

    #[test]
    fn both_agree_with_powers_of_e() {
        for n in 0..=200 {
            let power = whole_power(n);
            let x = -f64::from(n);
            assert!((exponential(x) / power - 1.0).abs() < 1e-9, "{n}");
            assert!((one_minus_exponential(-x) - (1.0 - power)).abs() < 1e-11);
        }
        assert_eq!(exponential(0.0), 1.0);
        assert_eq!(one_minus_exponential(0.0), 0.0);
        assert!(exponential(f64::NEG_INFINITY) < 1e-86);
        assert!(exponential(f64::NAN) < 1e-86);
        assert_eq!(one_minus_exponential(f64::INFINITY), 1.0);
    }

    /// e⁻ʸ = (1 − tanh ½y)/(1 + tanh ½y) is no help; its series is, for small y.
    #[test]
    fn small_arguments_lose_no_digits() {
        for i in 0..300 {
            let y = 0.01 / f64::from(1_u32 << (i % 30)) / if i < 150 { 1.0 } else { 1e40 };
            let exact = y * (1.0 - y / 2.0 * (1.0 - y / 3.0 * (1.0 - y / 4.0 * (1.0 - y / 5.0))));
            assert!(
                (one_minus_exponential(y) / exact - 1.0).abs() < 1e-11,
                "{y}"
            );
        }
    }
}
