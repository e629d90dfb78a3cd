//! The Fresnel factor of a conductor falls, then rises with the angle. `src/lobe/conductor.rs` has the proof.
//! Here its two identities of polynomials are checked exactly, by integers, and its F against the model.

use std::ops::{Add, Mul, Sub};

use proptest::prelude::*;
use support::generators;
use support::reference::Fresnel;

/// What the formulas of the proof are evaluated with.
trait Number: Copy + From<i32> + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> {}

impl<T> Number for T where T: Copy + From<i32> + Add<Output = T> + Sub<Output = T> + Mul<Output = T> {}

/// An upper bound of the degrees of a polynomial in c, a and b.
#[derive(Clone, Copy)]
struct Degrees([u32; 3]);

impl From<i32> for Degrees {
    fn from(_: i32) -> Self {
        Self([0; 3])
    }
}

impl Add for Degrees {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self(std::array::from_fn(|i| self.0[i].max(other.0[i])))
    }
}

impl Sub for Degrees {
    type Output = Self;
    #[expect(clippy::suspicious_arithmetic_impl, reason = "as of a sum")]
    fn sub(self, other: Self) -> Self {
        self + other
    }
}

impl Mul for Degrees {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        Self(std::array::from_fn(|i| self.0[i] + other.0[i]))
    }
}

/// A function of x = c², and 2mc times its derivative.
#[derive(Clone, Copy)]
struct Function<T> {
    value: T,
    slope: T,
}

impl<T: Number> From<i32> for Function<T> {
    fn from(x: i32) -> Self {
        Self {
            value: x.into(),
            slope: 0.into(),
        }
    }
}

impl<T: Number> Add for Function<T> {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self {
            value: self.value + other.value,
            slope: self.slope + other.slope,
        }
    }
}

impl<T: Number> Sub for Function<T> {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self {
            value: self.value - other.value,
            slope: self.slope - other.slope,
        }
    }
}

impl<T: Number> Mul for Function<T> {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        Self {
            value: self.value * other.value,
            slope: self.slope * other.value + self.value * other.slope,
        }
    }
}

/// The quantities of the proof.
#[derive(Clone, Copy)]
struct Quantities<T> {
    /// c²
    x: T,
    /// s²
    s_squared: T,
    /// |w|²
    m: T,
    /// 2ac
    p: T,
    /// c²m + s⁴
    q: T,
}

impl<T: Number> Quantities<T> {
    /// By the cosine c and w = a + ib.
    fn new([c, a, b]: [T; 3]) -> Self {
        let (x, m) = (c * c, a * a + b * b);
        let s_squared = T::from(1) - x;
        Self {
            x,
            s_squared,
            m,
            p: T::from(2) * a * c,
            q: x * m + s_squared * s_squared,
        }
    }

    /// Numerator and denominator of F.
    fn reflectance(self) -> [T; 2] {
        let Self {
            x,
            s_squared,
            m,
            p,
            q,
        } = self;
        [(m + x - p) * q, (m + x + p) * (q + p * s_squared)]
    }

    /// 2K
    fn twice_k(self) -> T {
        let Self { x, m, p, q, .. } = self;
        let two = T::from(2);
        q * (two + m - x + two * p) + two * x * m * (two - x - m) - x * p * p
    }
}

/// c, a and b as functions of x: dw/dx = 1/(2w).
fn functions<T: Number>([c, a, b]: [T; 3]) -> [Function<T>; 3] {
    let m = a * a + b * b;
    [(c, m), (a, a * c), (b, T::from(0) - b * c)].map(|(value, slope)| Function { value, slope })
}

/// Both sides of the identity for dF/dx.
fn slope_of_reflectance<T: Number>(point: [T; 3]) -> [T; 2] {
    let [numerator, denominator] = Quantities::new(functions(point)).reflectance();
    let Quantities {
        x, s_squared, m, p, ..
    } = Quantities::new(point);
    let [_, a, _] = point;
    [
        numerator.slope * denominator.value - numerator.value * denominator.slope,
        T::from(-2) * a * s_squared * Quantities::new(point).twice_k() * (m + x - p) * (m + x + p),
    ]
}

/// Both sides of the identity for dK/dx, with `weight` in the place of 3.
fn slope_of_k<T: Number>(point: [T; 3], weight: i32) -> [T; 2] {
    let twice_k = Quantities::new(functions(point)).twice_k();
    let Quantities {
        x, s_squared, m, p, ..
    } = Quantities::new(point);
    let [c, _, b] = point;
    let [one, two] = [1, 2].map(T::from);
    [
        c * twice_k.slope - two * (one + m - p) * twice_k.value,
        T::from(-4) * (T::from(weight) + two * s_squared) * x * b * b
            - two * s_squared * (one + m + s_squared) * (x * m + s_squared + s_squared * m),
    ]
}

/// The side of the grid. A polynomial whose degrees are smaller is zero if it vanishes on it.
const GRID: std::ops::RangeInclusive<i32> = -7..=7;

/// The number of points of the grid at which both sides differ.
fn differences(sides: impl Fn([i128; 3]) -> [i128; 2]) -> usize {
    let points = GRID.flat_map(|c| GRID.flat_map(move |a| GRID.map(move |b| [c, a, b])));
    points
        .filter(|point| {
            let [left, right] = sides(point.map(i128::from));
            left != right
        })
        .count()
}

#[test]
fn identities_hold() {
    let variables = [0, 1, 2].map(|index| Degrees(std::array::from_fn(|i| u32::from(i == index))));
    let sides = [slope_of_reflectance(variables), slope_of_k(variables, 3)];
    for Degrees(degrees) in sides.into_iter().flatten() {
        println!("degrees {degrees:?}");
        assert!(
            degrees
                .into_iter()
                .all(|degree| degree < GRID.count() as u32)
        );
    }
    assert_eq!(differences(slope_of_reflectance), 0);
    assert_eq!(differences(|point| slope_of_k(point, 3)), 0);
    // What is not so is refuted.
    assert!(differences(|point| slope_of_k(point, 4)) > 0);
}

/// The root with positive real part of n² − s², as the proof takes it.
fn root([eta, kappa]: [f64; 2], cosine: f64) -> [f64; 2] {
    let real = eta * eta - kappa * kappa - (1.0 - cosine * cosine);
    let (modulus, half) = (real.hypot(2.0 * eta * kappa), eta * kappa);
    let larger = (0.5 * (modulus + real.abs())).sqrt();
    if real > 0.0 {
        [larger, half / larger]
    } else {
        [half / larger, larger]
    }
}

proptest! {
    #![proptest_config(generators::cases(5000))]

    #[test]
    fn quotient_is_the_reflectance(
        eta in generators::log_uniform(1e-3, 1e3),
        kappa in generators::log_uniform(1e-3, 1e3),
        cosine in 0.0..=1.0_f64,
    ) {
        let [eta, kappa] = [eta, kappa].map(|x| x as f32);
        let [a, b] = root([eta, kappa].map(f64::from), cosine);
        let [numerator, denominator] = Quantities::new([cosine, a, b]).reflectance();
        let exact = Fresnel::Conductor(eta, kappa).at(cosine);
        let quotient = numerator / denominator;
        prop_assert!((quotient - exact).abs() <= 1e-9, "{quotient} {exact}");
    }

    /// No F lies above both of its neighbours; 10⁻¹² is for rounding.
    #[test]
    fn no_angle_between_two_reflects_more(
        fresnel in generators::fresnel(),
        mut cosines in [0.0..=1.0_f64, 0.0..=1.0_f64, 0.0..=1.0_f64],
    ) {
        cosines.sort_by(f64::total_cmp);
        let [first, between, last] = cosines.map(|cosine| fresnel.at(cosine));
        prop_assert!(between <= first.max(last) + 1e-12, "{first} {between} {last}");
    }
}
