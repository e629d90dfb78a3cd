//! Spherical Gaussians: their identities against quadrature, their sampler, and how well they stand for what
//! surfaces reflect.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use approx::assert_relative_eq;
use proptest::prelude::*;
use stochastic_light_culling::{
    AnisotropicGgx, AnisotropicSphericalGaussian, Direction, Error, Ggx, GgxLobe, Incidence, Lobe,
    NoFresnel, SphericalGaussian, glam::Vec3,
};
use support::generators::{self, cases};
use support::quadrature::integral;
use support::reference::Vector;

/// An SG in double precision, of unit amplitude.
#[derive(Clone, Copy)]
struct Exact {
    axis: Vector,
    sharpness: f64,
}

impl Exact {
    fn of(gaussian: &SphericalGaussian) -> Self {
        Self {
            axis: Vector::from(*gaussian.axis()).unit(),
            sharpness: gaussian.sharpness().into(),
        }
    }

    fn value(self, direction: Vector) -> f64 {
        let apart = direction - self.axis;
        (-0.5 * self.sharpness * apart.dot(apart)).exp()
    }

    fn width(self) -> f64 {
        (1.0 + self.sharpness).sqrt().recip()
    }
}

fn about(axis: Vector, sharpness: f32) -> SphericalGaussian {
    let axis = Direction::new(axis.to_f32()).unwrap();
    SphericalGaussian::new(axis, sharpness, 1.0).unwrap()
}

const SHARPNESSES: [f32; 12] = [
    0.0,
    1e-6,
    1e-3,
    0.1,
    0.7,
    2.0,
    9.0,
    60.0,
    1e3,
    3e4,
    1e6,
    4_194_304.0,
];

const SLANTED: Vector = Vector([0.36, -0.48, 0.8]);

#[test]
fn integral_and_normalisation_agree_with_quadrature() {
    let mut worst = 0.0_f64;
    for sharpness in SHARPNESSES {
        let gaussian = about(SLANTED, sharpness);
        let exact = Exact::of(&gaussian);
        let area = integral(exact.axis, exact.width(), |w| exact.value(w));
        let share = f64::from(gaussian.integral()) / area - 1.0;
        let normal = SphericalGaussian::with_integral(gaussian.axis(), sharpness, 0.7).unwrap();
        let of_normal = f64::from(normal.amplitude()) * area / f64::from(0.7_f32) - 1.0;
        let density = f64::from(gaussian.density(*gaussian.axis())) * area - 1.0;
        for error in [share, of_normal, density] {
            worst = worst.max(error.abs());
            assert!(error.abs() < 1e-6, "λ = {sharpness}: {error:e}");
        }
    }
    println!("integral and normalisation: at most {worst:.1e}");
}

/// The product and its integral, for axes as far apart as the wider lobe reaches, and opposite.
#[test]
fn products_agree_with_quadrature() {
    let mut worst = 0.0_f64;
    let every_other = || SHARPNESSES.into_iter().step_by(2).chain([1e6, 4_194_304.0]);
    for first in every_other() {
        for second in every_other() {
            let reach = (1.0 / (1.0 + f64::from(first)) + 1.0 / (1.0 + f64::from(second))).sqrt();
            for off in [0.0, 0.3, 1.0, 4.0, f64::INFINITY] {
                let side = SLANTED.orthogonal();
                let turned = SLANTED.turned(side, (off * reach).min(PI));
                let [a, b] = [about(SLANTED, first), about(turned, second)];
                let [exact_a, exact_b] = [Exact::of(&a), Exact::of(&b)];
                let product = a.product(&b);
                // Where the product is largest.
                let sum = exact_a.axis * exact_a.sharpness + exact_b.axis * exact_b.sharpness;
                let axis = if sum.length() > 1e-9 {
                    sum.unit()
                } else {
                    SLANTED
                };
                let width = (1.0 + sum.length()).sqrt().recip();
                let exact = integral(axis, width, |w| exact_a.value(w) * exact_b.value(w));
                let found = f64::from(a.product_integral(&b));
                // Far apart the product underflows.
                if exact < 1e-30 {
                    assert!(found < 1e-29);
                    continue;
                }
                let error = (found / exact - 1.0).abs();
                worst = worst.max(error);
                assert!(error < 1e-5, "{first} and {second}, {off} apart: {error:e}");
                if product.sharpness() < SphericalGaussian::MAX_SHARPNESS {
                    let value = f64::from(product.amplitude()) * Exact::of(&product).value(SLANTED);
                    let values = exact_a.value(SLANTED) * exact_b.value(SLANTED);
                    // λ and ξ of the product are rounded, which the exponent multiplies.
                    let exponent = -(value.max(1e-300)).ln();
                    let slope = (2.0 * exponent.abs() * f64::from(product.sharpness())).sqrt();
                    let allowed = 1e-6 + 3e-7 * exponent.abs() + 3e-7 * slope;
                    let error = (value / values - 1.0).abs();
                    assert!(
                        values < 1e-25 || error < allowed,
                        "{first}, {second}: {error:e}"
                    );
                }
            }
        }
    }
    println!("integral of products: at most {worst:.1e}");
}

#[test]
fn toksvig_s_rule_is_undone() {
    let mut worst = 0.0_f64;
    for step in 0..=2000 {
        let sharpness = 4_194_304.0 * (-0.03 * f64::from(step)).exp();
        let gaussian = about(SLANTED, sharpness as f32);
        let again = SphericalGaussian::from_mean_direction(gaussian.mean_direction(), 1.0).unwrap();
        let error = f64::from(again.sharpness()) / f64::from(gaussian.sharpness()) - 1.0;
        worst = worst.max(error.abs());
        let turned = Vector::from(*again.axis()) - Vector::from(*gaussian.axis());
        assert!(
            error.abs() < 1e-6 && turned.length() < 2e-7,
            "{sharpness}: {error:e}"
        );
    }
    println!("Toksvig's rule and back: at most {worst:.1e}");
    let flat = about(SLANTED, 0.0).mean_direction();
    let flat = SphericalGaussian::from_mean_direction(flat, 4.0).unwrap();
    assert_eq!(flat.sharpness(), 0.0);
    assert_relative_eq!(f64::from(flat.amplitude()), 1.0 / PI, max_relative = 1e-6);
    let sharp = SphericalGaussian::from_mean_direction([0.0, -1.0, 0.0], 1.0).unwrap();
    assert_eq!(sharp.sharpness(), SphericalGaussian::MAX_SHARPNESS);
    assert_eq!(*sharp.axis(), -Vec3::Y);
    for mean in [
        [1.1, 0.0, 0.0],
        [f64::NAN, 0.0, 0.0],
        [f64::INFINITY, 0.0, 0.0],
    ] {
        let error = SphericalGaussian::from_mean_direction(mean, 1.0);
        assert!(matches!(error, Err(Error::Vector { .. })), "{mean:?}");
    }
}

proptest! {
    #![proptest_config(cases(2000))]

    #[test]
    fn value_agrees_with_the_model(
        axis in generators::unit_vector(),
        sharpness in generators::sharpness(),
        side in generators::unit_vector(),
        off in generators::log_uniform(1e-3, 10.0),
    ) {
        let gaussian = about(axis, sharpness);
        let exact = Exact::of(&gaussian);
        let outgoing = (axis + side * (off * exact.width())).unit().to_f32();
        let value = f64::from(gaussian.value(outgoing));
        let model = exact.value(Vector::from(outgoing).unit());
        // Axis and ω_o are off unit length by 3.5u each, and so is the exponent by 7u; and by ½λ(7u)².
        let exponent = -model.ln();
        let allowed = 2e-7 + 5e-7 * exponent + 2e-13 * f64::from(sharpness);
        prop_assert!((value / model - 1.0).abs() < allowed || model < 1e-37, "{value} {model}");
        prop_assert!(value <= f64::from(gaussian.amplitude()));
        prop_assert_eq!(gaussian.value(Vec3::NAN), 0.0);
    }

    /// The share of directions nearer to the axis than the one that is drawn is the number it is drawn from.
    #[test]
    fn samples_invert_the_distribution(
        axis in generators::unit_vector(),
        sharpness in generators::sharpness(),
        number in generators::up_to_one(1e-6),
        turn in 0.0..=1.0_f32,
    ) {
        let gaussian = about(axis, sharpness);
        let drawn = gaussian.sample([number, turn]);
        let apart = Vector::from(*drawn) - Vector::from(*gaussian.axis());
        let (height, sharpness) = (0.5 * apart.dot(apart), f64::from(sharpness));
        let share = if sharpness < 1e-6 {
            0.5 * height
        } else {
            (-sharpness * height).exp_m1() / (-2.0 * sharpness).exp_m1()
        };
        // The direction is rounded, by a few u, and the axis with it.
        let slope = sharpness * height.sqrt() * 2.0 + 2.0;
        prop_assert!((share - f64::from(number)).abs() < 1e-6 * slope, "{share} {number}");
    }
}

/// The mean of drawn directions is that of the distribution, coth λ − 1/λ along the axis.
#[test]
fn samples_have_the_mean_of_the_distribution() {
    for sharpness in [0.0, 0.5, 3.0, 40.0, 1e5_f32] {
        let gaussian = about(SLANTED, sharpness);
        let number = 64;
        let mut sum = Vector::ZERO;
        for i in 0..number * number {
            let even = |i: i32| (i as f32 + 0.5) / number as f32;
            let drawn = gaussian.sample([even(i / number), even(i % number)]);
            sum = sum + Vector::from(*drawn);
        }
        let mean = sum * f64::from(number * number).recip();
        let exact = match f64::from(sharpness) {
            0.0 => 0.0,
            sharpness => 1.0 / sharpness.tanh() - 1.0 / sharpness,
        };
        let error = mean - SLANTED * exact;
        // The midpoint rule in the first number: its error is of the order of 1/64 over λ.
        assert!(
            error.length() < 0.02 / f64::from(sharpness).max(1.0),
            "{error:?}"
        );
    }
}

/// The x between `low` and `high` where a function with one minimum is least.
fn least(mut low: f64, mut high: f64, f: impl Fn(f64) -> f64) -> f64 {
    for _ in 0..40 {
        let third = (high - low) / 3.0;
        if f(low + third) < f(high - third) {
            high -= third;
        } else {
            low += third;
        }
    }
    0.5 * (low + high)
}

/// λ_d by least squares is 2 within a tenth. With the integral of the lobe, or its mean direction, it is another.
#[test]
fn diffuse_sharpness_is_found_again() {
    let up = Vector([0.0, 0.0, 1.0]);
    let lobe = |sharpness| Exact {
        axis: up,
        sharpness,
    };
    // ∫(cG − cos⁺)² dω is least for c = ∫cos⁺ G/∫G², where it is ∫cos⁺² − (∫cos⁺ G)²/∫G².
    let moments = |sharpness: f64| {
        let g = lobe(sharpness);
        [
            integral(up, 1.0, |w| g.value(w)),
            integral(up, 1.0, |w| g.value(w).powi(2)),
            integral(up, 1.0, |w| g.value(w) * w.0[2].max(0.0)),
        ]
    };
    let with_free_amplitude = least(0.5, 8.0, |sharpness| {
        let [_, squared, mixed] = moments(sharpness);
        -mixed * mixed / squared
    });
    let with_the_integral = least(0.5, 8.0, |sharpness| {
        let [area, squared, mixed] = moments(sharpness);
        squared / (area * area) - 2.0 * mixed / (PI * area)
    });
    // ∫ω cosθ/π dω = ⅔n.
    let with_the_mean = least(0.5, 8.0, |sharpness| {
        (1.0 / sharpness.tanh() - 1.0 / sharpness - 2.0 / 3.0).abs()
    });
    let by_toksvig = SphericalGaussian::from_mean_direction([0.0, 0.0, 2.0 / 3.0], 1.0).unwrap();
    println!(
        "λ_d: least squares {with_free_amplitude:.3}, with the same integral {with_the_integral:.3}, \
         the same mean direction {with_the_mean:.3}, by Toksvig's rule {:.3}",
        by_toksvig.sharpness()
    );
    let used = f64::from(SphericalGaussian::DIFFUSE_SHARPNESS);
    assert!((with_free_amplitude / used - 1.0).abs() < 0.1);
    assert!((with_the_integral - 2.29).abs() < 0.01);
    assert_relative_eq!(f64::from(by_toksvig.sharpness()), used, max_relative = 1e-6);
}

/// The relative error, in the square mean, of the SG and of the ASG that stand for a GGX lobe with F = 1.
#[test]
fn specular_fits_have_the_errors_that_are_documented() {
    println!("relative error of the SG for GGX lobes; α down, θ across: 0°, 30°, 60°, 80°");
    for roughness in [0.02, 0.05, 0.1, 0.2, 0.4, 0.7, 1.0_f32] {
        let ggx = Ggx::new(roughness).unwrap();
        let errors = [0.0, 30.0, 60.0, 80.0_f64].map(|degrees| {
            let incoming = Vector([degrees.to_radians().sin(), 0.0, degrees.to_radians().cos()]);
            let incidence = Incidence {
                normal: Direction::Z,
                incoming: Direction::new(incoming.to_f32()).unwrap(),
            };
            let lobe = GgxLobe::new(ggx, NoFresnel, incidence);
            let mirror = Vector::from(*lobe.mirror_direction()).unit();
            let width = f64::from(roughness);
            let value = |w: Vector| f64::from(lobe.value(w.to_f32()));
            let reflected = integral(mirror, width, value);
            let gaussian = SphericalGaussian::specular(ggx, 1.0, incidence).unwrap();
            let difference = integral(mirror, width, |w| {
                (value(w) - reflected * f64::from(gaussian.value(w.to_f32()))).powi(2)
            });
            (difference / integral(mirror, width, |w| value(w).powi(2))).sqrt()
        });
        println!("{roughness:5}: {errors:.3?}");
        if roughness <= 0.1 {
            assert!(errors[0] < 0.35 && errors[1] < 0.35, "{errors:?}");
        }
    }
    let below = Incidence {
        normal: Direction::Z,
        incoming: Direction::new(Vec3::new(1.0, 0.0, -0.1)).unwrap(),
    };
    let dark = SphericalGaussian::specular(Ggx::new(0.2).unwrap(), 1.0, below).unwrap();
    assert!(dark.is_empty() && dark.value(*dark.axis()) == 0.0);
}

/// Near the mirror direction the ASG is exp(−x²/α_x² − y²/α_y²) in the slopes of the half vector.
#[test]
fn specular_asg_follows_the_half_vector() {
    let mut random = fastrand::Rng::with_seed(3);
    for _ in 0..300 {
        let roughness = [(); 2].map(|()| 0.01 + 0.3 * random.f32());
        let (theta, phi) = (1.45 * random.f64(), TAU * random.f64());
        let view = Vector([
            theta.sin() * phi.cos(),
            theta.sin() * phi.sin(),
            theta.cos(),
        ]);
        let incidence = Incidence {
            normal: Direction::Z,
            incoming: Direction::new(view.to_f32()).unwrap(),
        };
        let ggx = AnisotropicGgx::new(roughness[0], roughness[1]).unwrap();
        let lobe = AnisotropicSphericalGaussian::specular(ggx, incidence, Direction::X).unwrap();
        let mirror = Vector([-view.0[0], -view.0[1], view.0[2]]);
        let side = mirror
            .cross(Vector([random.f64(), random.f64(), random.f64()]))
            .unit();
        let step = 0.05 * f64::from(roughness[0].min(roughness[1])) * view.0[2];
        // Both ways, for what is of odd order.
        let [ndf, value] = [0, 1].map(|which| {
            [step, -step]
                .into_iter()
                .map(|step| {
                    let direction = (mirror + side * step).unit();
                    let half = (view + direction).unit();
                    let slopes = [half.0[0], half.0[1]].map(|x| x / half.0[2]);
                    let squares = (slopes[0] / f64::from(roughness[0])).powi(2)
                        + (slopes[1] / f64::from(roughness[1])).powi(2);
                    if which == 0 {
                        squares
                    } else {
                        -f64::from(lobe.value(direction.to_f32())).ln()
                    }
                })
                .sum::<f64>()
        });
        // ω·ξ_z adds ½ step² to each.
        assert!(
            (value - step * step - ndf).abs() < 0.02 * ndf + 1e-6,
            "{value} {ndf}"
        );
        let peak = f64::from(lobe.value(*lobe.axis()));
        assert_relative_eq!(peak, 1.0, max_relative = 1e-6);
    }
}

/// The error of the product integral of an ASG with an SG: within 5 % where it is documented to be, and never
/// above the integral of either.
#[test]
fn product_integral_of_an_asg_agrees_with_quadrature() {
    println!("relative error of the product integral; tilt across: 0, 0.1, 0.3, 0.6, 1.2 rad");
    for bandwidths in [
        [0.5, 0.5],
        [5.0, 5.0],
        [5.0, 50.0],
        [30.0, 400.0],
        [1e3, 1e3_f32],
    ] {
        for sharpness in [0.2, 2.0, 20.0, 200.0, 1e4_f32] {
            for azimuth in [0.0, 0.8, FRAC_PI_2] {
                let lobe =
                    AnisotropicSphericalGaussian::new(Direction::Z, Direction::X, bandwidths, 1.0)
                        .unwrap();
                let tilts = [0.0, 0.1, 0.3, 0.6, 1.2];
                let mut largest = 0.0_f64;
                let errors = tilts.map(|tilt: f64| {
                    let axis = Vector([
                        tilt.sin() * azimuth.cos(),
                        tilt.sin() * azimuth.sin(),
                        tilt.cos(),
                    ]);
                    let gaussian = about(axis, sharpness);
                    let exact_gaussian = Exact::of(&gaussian);
                    let [x, y] = bandwidths.map(f64::from);
                    // About the narrower of the two.
                    let (about, width) = if f64::from(sharpness) > x {
                        (exact_gaussian.axis, exact_gaussian.width())
                    } else {
                        (Vector([0.0, 0.0, 1.0]), (0.5 / (1.0 + y)).sqrt())
                    };
                    let exact = integral(about, width, |w| {
                        let [a, b, c] = w.0;
                        c.max(0.0) * (-x * a * a - y * b * b).exp() * exact_gaussian.value(w)
                    });
                    let found = f64::from(lobe.product_integral(&gaussian));
                    assert!(
                        found <= PI * 1.000_001
                            && found <= f64::from(gaussian.integral()) * 1.000_001
                    );
                    largest = largest.max(exact);
                    // Where it is small, for its own largest, the error does not count.
                    if exact < 0.05 * largest {
                        0.0
                    } else {
                        found / exact - 1.0
                    }
                });
                println!("η {bandwidths:?}, λ {sharpness}, azimuth {azimuth:.1}: {errors:.3?}");
                if bandwidths[0] >= 5.0 {
                    assert!(
                        errors[..3].iter().all(|error| error.abs() < 0.055),
                        "{errors:?}"
                    );
                }
            }
        }
    }
}
