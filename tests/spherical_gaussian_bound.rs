//! The ellipsoid of an SG encloses: a proof by intervals for the polynomials, box by box, and a comparison of
//! the crate's ellipsoids with them. And it is nearly the smallest, found by search.

use std::f64::consts::FRAC_PI_2;

use stochastic_light_culling::{
    Bounded, Direction, Ellipsoid, Focal, SphericalGaussian, glam::Vec3,
};
use support::certificate::{Interval, Slopes, prove_positive};

type Function = Slopes<2>;

/// The share by which the semi-axes are larger than the polynomials say, for the proof.
const ROOM: f64 = 1e-4;

const FRONT: [f64; 4] = [0.3028, -0.1291, -0.1709, 0.084];
const REAR: [f64; 5] = [-5.4278, 23.6406, -35.9794, 20.754, -0.9873];
const ACROSS: [f64; 6] = [0.6901, -1.9974, 2.1405, -0.5452, 0.3361, 0.3834];

fn polynomial(coefficients: &[f64], w: Function) -> Function {
    let horner = |sum, c: &f64| sum * w + Function::constant(*c);
    coefficients.iter().fold(Function::constant(0.0), horner)
}

/// e/w⁴ of the rear e = a − d.
fn rear_over_fourth_power(w: Function) -> Function {
    let u = Function::constant(1.0) - w;
    Function::constant(1.0) + u * polynomial(&REAR, w)
}

/// The distance of the centre, the semi-axis along, and b²/w of the semi-axis b across, for w = 1/(1 + κ).
fn polynomials(w: Function) -> [Function; 3] {
    let u = Function::constant(1.0) - w;
    let front = Function::constant(1.0) + u * polynomial(&FRONT, w);
    let rear = w.squared().squared() * rear_over_fourth_power(w);
    [
        (front - rear) * 0.5,
        (front + rear) * 0.5,
        polynomial(&ACROSS, w),
    ]
}

/// 1 less the level of a point of the surface in the enlarged ellipsoid, squared, times (1 + room)²:
/// (z − d)²/a² + ρ²/b² − (1 + room)². With κ = (1 − w)/w as a number, for w ≥ 1/8, at 1 − cosγ = `s`.
fn excess_of_broad(w: Function, s: Function) -> Function {
    let [center, along, across] = polynomials(w);
    let one = Function::constant(1.0);
    let kappa = (one - w) * w.reciprocal();
    let length = (Function::constant(0.0) - kappa * s).exponential();
    let height = length * (one - s);
    let radius_squared = length.squared() * s * (Function::constant(2.0) - s);
    ((height - center) * along.reciprocal()).squared() + radius_squared * (w * across).reciprocal()
        - Function::constant((1.0 + ROOM).powi(2))
}

/// The same for w ≤ 1/8, at κ(1 − cosγ) = `t`, which stays finite for w → 0: ρ² = l² t(2 − t/κ)/κ, where
/// 1/κ = w/(1 − w).
fn excess_of_narrow(w: Function, t: Function) -> Function {
    let [center, along, across] = polynomials(w);
    let one = Function::constant(1.0);
    let over_u = (one - w).reciprocal();
    let length = (Function::constant(0.0) - t).exponential();
    let share = t * w * over_u;
    let height = length * (one - share);
    let radius_squared_over_w = length.squared() * t * (Function::constant(2.0) - share) * over_u;
    ((height - center) * along.reciprocal()).squared() + radius_squared_over_w * across.reciprocal()
        - Function::constant((1.0 + ROOM).powi(2))
}

/// How many boxes it takes to show that `excess` is negative over a box.
fn boxes(excess: &impl Fn(Function, Function) -> Function, sides: [Interval; 2]) -> usize {
    let zero = Function::constant(0.0);
    let gap = |[x, y]: [Function; 2]| [Some(zero - excess(x, y))];
    prove_positive(sides, 1_000_000, gap).expect("the ellipsoid encloses")
}

/// The polynomials, enlarged by 10⁻⁴, enclose the isosurface for every λ.
///
/// For t = κ(1 − cosγ) ≥ 10.5 and w ≤ 1/8, which the boxes leave out, l ≤ 2.8·10⁻⁵. There the level squared,
/// times (1 + room)², is at most (d/a)² + 2l/a + l²/a² + 2l²t/((1−w)b²/w) with d ≤ a, a > ½ and b²/w > ⅓, the
/// last product falling with t: 1 + 1.2·10⁻⁴ < (1 + room)².
#[test]
fn polynomials_enclose() {
    let side = Interval::new;
    let broad = boxes(&excess_of_broad, [side(0.125, 1.0), side(0.0, 2.0)]);
    let narrow = boxes(&excess_of_narrow, [side(0.0, 0.125), side(0.0, 10.5)]);
    println!("{broad} and {narrow} boxes");
    for i in 0..1000 {
        let w = side(0.125e-3 * f64::from(i), 0.125e-3 * f64::from(i + 1));
        let w = Function::variable(w, 0);
        let [_, along, across] = polynomials(w);
        assert!(along.value.low > 0.5 && across.value.low > 1.0 / 3.0);
        assert!(rear_over_fourth_power(w).value.low >= 0.0);
    }
}

fn gaussian(sharpness: f32) -> SphericalGaussian {
    SphericalGaussian::new(Direction::Z, sharpness, 1.0).unwrap()
}

/// Sharpnesses over the whole range.
fn sharpnesses() -> impl Iterator<Item = f32> {
    let decades = (-70..=220).map(|i| 2.0_f32.powf(0.1 * i as f32));
    [0.0, 1e-40, SphericalGaussian::MAX_SHARPNESS]
        .into_iter()
        .chain(decades)
        .filter(|sharpness| *sharpness <= SphericalGaussian::MAX_SHARPNESS)
}

/// The crate's ellipsoid has the centre of the polynomials, and semi-axes that are larger by more than the room
/// of the proof and what the difference of the centres can cost.
#[test]
fn ellipsoids_are_those_of_the_polynomials() {
    for sharpness in sharpnesses() {
        let kappa = 0.5 * f64::from(sharpness);
        let w = 1.0 / (1.0 + kappa);
        let [center, along, across] = polynomials(Function::constant(w)).map(|f| f.value.middle());
        let across = (w * across).sqrt();
        let ellipsoid = gaussian(sharpness).unit_bound();
        let found = ellipsoid.semi_axes().to_array().map(f64::from);
        let shift = (f64::from(ellipsoid.center().z) - center).abs();
        assert!(ellipsoid.center().truncate() == Vec3::ZERO.truncate());
        for (found, exact) in found.into_iter().zip([along, across, across]) {
            let least = exact * (1.0 + ROOM) + shift * exact / along;
            assert!(found >= least, "λ = {sharpness}: {found} < {least}");
        }
    }
}

fn volume(ellipsoid: &Ellipsoid) -> f64 {
    let semi_axes = ellipsoid.semi_axes().to_array();
    semi_axes.into_iter().map(f64::from).product()
}

/// The least value of a convex function.
fn least(mut low: f64, mut high: f64, f: impl Fn(f64) -> f64) -> f64 {
    for _ in 0..50 {
        let third = (high - low) / 3.0;
        if f(low + third) <= f(high - third) {
            high -= third;
        } else {
            low += third;
        }
    }
    f(0.5 * (low + high))
}

/// The least ab² of a spheroid around l = e^{−κ(1−cosγ)}, by search over a and the centre; b is then what
/// encloses.
fn least_volume(kappa: f64) -> f64 {
    let samples: Vec<[f64; 2]> = (0..=1200)
        .map(|i| {
            // Even where the lobe is thin; up to γ = π.
            let share = f64::from(i) / 1200.0;
            let tangent = (FRAC_PI_2 * share).tan() / (1.0 + kappa).sqrt();
            let versine = 2.0 * tangent * tangent / (1.0 + tangent * tangent);
            let length = (-kappa * versine).exp();
            [
                length * (1.0 - versine),
                length * length * versine * (2.0 - versine),
            ]
        })
        .collect();
    // In 1/a and c/a the condition on b is convex.
    let volume = |inverse: f64, shift: f64| {
        let across_squared = samples.iter().map(|[height, squared]| {
            let rest = 1.0 - (inverse * height - shift).powi(2);
            if *squared < 1e-14 && rest > -1e-12 {
                0.0
            } else if rest <= 0.0 {
                f64::INFINITY
            } else {
                squared / rest
            }
        });
        across_squared.fold(0.0, f64::max) / inverse
    };
    least(0.5, 2.0, |inverse| {
        let rear = (-2.0 * kappa).exp();
        let low = (inverse - 1.0).max(0.0);
        least(low, (1.0 - inverse * rear).max(low), |shift| {
            volume(inverse, shift)
        })
    })
}

/// Volume over that of the smallest ellipsoid: at most 1.01, and 1.2 for the spheroid with its focus at the
/// light.
#[test]
fn ellipsoid_of_a_gaussian_is_nearly_the_smallest() {
    let mut worst = [0.0_f64; 2];
    for sharpness in [
        0.0, 1e-3, 0.03, 0.1, 0.2, 0.4, 0.7, 1.0, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0, 5.0, 6.0, 8.0,
        10.0, 14.0, 20.0, 30.0, 50.0, 100.0, 300.0, 1e3, 1e4, 1e5, 1e6,
    ] {
        let lobe = gaussian(sharpness);
        let least = least_volume(0.5 * f64::from(sharpness));
        let tight = volume(&lobe.unit_bound()) / least;
        let focal = volume(&lobe.unit_bound_by(Focal).into()) / least;
        println!("λ = {sharpness}: {tight:.5} and {focal:.5} of the smallest");
        assert!(tight > 0.9999 && focal > 0.9999);
        worst = [worst[0].max(tight), worst[1].max(focal)];
    }
    println!("at most {worst:?}");
    assert!(worst[0] < 1.01 && worst[1] < 1.2, "{worst:?}");
}
