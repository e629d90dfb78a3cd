//! What surfaces reflect of light that arrives as a spherical Gaussian, against quadrature: both approximations
//! for glossy surfaces, and the one for diffuse surfaces.
//!
//! `cargo test --test reflected_gaussian -- --nocapture` prints the tables.

use std::f64::consts::{FRAC_PI_2, PI};

use stochastic_light_culling::{
    Direction, Ggx, GgxLobe, Incidence, LambertLobe, NoFresnel, SphericalGaussian, glam::Vec3,
};
use support::quadrature::integral;
use support::reference::{Brdf, Fresnel, Masking, Surface, Vector};

fn value(gaussian: &SphericalGaussian, direction: Vector) -> f64 {
    let apart = direction - Vector::from(*gaussian.axis()).unit();
    let exponent = 0.5 * f64::from(gaussian.sharpness()) * apart.dot(apart);
    f64::from(gaussian.amplitude()) * (-exponent).exp()
}

fn unit_light(axis: Vector, sharpness: f32) -> SphericalGaussian {
    let axis = Direction::new(axis.to_f32()).unwrap();
    SphericalGaussian::with_integral(axis, sharpness, 1.0).unwrap()
}

/// In the plane y = 0, at `angle` to the normal.
fn in_plane(angle: f64) -> Vector {
    Vector([angle.sin(), 0.0, angle.cos()])
}

const UP: Vector = Vector([0.0, 0.0, 1.0]);

/// A GGX surface that is looked at from `theta` off its normal, and the same in double precision.
fn seen_from(theta: f64, roughness: f32) -> (GgxLobe, impl Fn(Vector) -> f64) {
    let view = in_plane(theta);
    let incidence = Incidence {
        normal: Direction::Z,
        incoming: Direction::new(view.to_f32()).unwrap(),
    };
    let lobe = GgxLobe::new(Ggx::new(roughness).unwrap(), NoFresnel, incidence);
    let surface = Surface {
        normal: UP,
        incoming: view,
    };
    let brdf = Brdf::Ggx {
        roughness,
        fresnel: Fresnel::None,
        masking: Masking::HeightCorrelated,
    };
    (lobe, move |w| surface.value(brdf, w))
}

/// [∫vg/the NDF filter, the ASG's/∫vg] − 1, and ∫vg over the largest of all tilts.
fn errors(theta: f64, roughness: f32, sharpness: f32, axis: Vector) -> ([f64; 2], f64) {
    let (lobe, reflected) = seen_from(theta, roughness);
    let light = unit_light(axis, sharpness);
    let width = (1.0 + f64::from(sharpness)).sqrt().recip();
    let mirror = in_plane(-theta);
    let (about, width) = if f64::from(roughness) < width {
        (mirror, f64::from(roughness))
    } else {
        (axis, width)
    };
    let exact = integral(about, width, |w| reflected(w) * value(&light, w));
    let found = [
        lobe.product_integral(&light),
        lobe.product_integral_by_asg(&light),
    ];
    (found.map(|found| f64::from(found) / exact - 1.0), exact)
}

/// The table of relative errors over roughness, sharpness and tilt of the light's axis off the mirror
/// direction, away from the viewer's plane; and the promises of the documentation.
#[test]
fn glossy_reflection_against_quadrature() {
    let tilts = [0.0, 0.1, 0.3, 0.6, 1.0];
    let mut sums = [[0.0_f64; 2]; 2];
    println!(
        "relative errors: α, λ, view off the normal; by tilts {tilts:?} rad: NDF filter | ASG"
    );
    for roughness in [0.02, 0.05, 0.1, 0.2, 0.4, 0.8_f32] {
        for sharpness in [1.0, 10.0, 100.0, 1e3, 1e5_f32] {
            for theta in [0.1, 0.8, 1.4] {
                let row = tilts.map(|tilt| {
                    let across = Vector([0.0, 1.0, 0.0]);
                    errors(
                        theta,
                        roughness,
                        sharpness,
                        in_plane(-theta).turned(across, tilt),
                    )
                });
                let column = |which: usize| row.map(|(errors, _)| errors[which]);
                println!(
                    "{roughness:5} {sharpness:8} {theta:4}: {:7.3?} | {:7.3?}",
                    column(0),
                    column(1)
                );
                let largest = row.iter().map(|(_, exact)| *exact).fold(0.0, f64::max);
                for (errors, exact) in row {
                    assert!(
                        errors
                            .iter()
                            .all(|error| error.is_finite() && *error >= -1.0)
                    );
                    assert!(errors[0] > -1.0 + 1e-9 || exact < 1e-30, "never black");
                    // Weighted by how much it is, of the largest in the row.
                    let weight = exact / largest;
                    let near = usize::from(theta > 1.0);
                    for (sum, error) in sums[near].iter_mut().zip(errors) {
                        *sum = sum.max(error.abs() * weight);
                    }
                    if sharpness >= 10.0 && exact > 0.3 * largest && theta < 1.0 {
                        assert!(errors[0].abs() < 0.4, "{errors:?}");
                    }
                }
            }
        }
    }
    println!(
        "largest error over the largest of a row: [NDF filter, ASG] up to 0.8 rad: {:.3?}; at 1.4: {:.3?}",
        sums[0], sums[1]
    );
    assert!(sums[0][0] < 0.5, "{sums:?}");
}

/// The tails of the filter are those of the filtered NDF, and so too bright by the quotient of its squared roughness
/// and the NDF's.
#[test]
fn tails_are_too_bright_by_what_the_filter_adds() {
    let across = Vector([0.0, 1.0, 0.0]);
    for (roughness, sharpness) in [(0.02, 100.0), (0.02, 1e3), (0.1, 100.0), (0.1, 1e3_f32)] {
        let axis = in_plane(-0.1).turned(across, 1.0);
        let ([filter, _], _) = errors(0.1, roughness, sharpness, axis);
        let squared = f64::from(roughness).powi(2);
        let expected = 1.0 + (1.0 - squared) / (2.0 * f64::from(sharpness) * squared);
        let share = (filter + 1.0) / expected;
        println!(
            "{roughness} {sharpness}: {:.3} times, {share:.3} of {expected:.3}",
            filter + 1.0
        );
        assert!((0.8..1.05).contains(&share));
    }
}

/// At the horizon and beyond it the filter follows, where the ASG is black.
#[test]
fn light_below_the_horizon_is_not_lost_by_the_filter() {
    println!("α, λ, axis: integral, NDF filter and ASG over it");
    for roughness in [0.1, 0.3, 1.0] {
        for sharpness in [1.0, 5.0, 30.0] {
            for angle in [-1.3, -1.6, -1.9] {
                let ([filter, asg], exact) = errors(1.0, roughness, sharpness, in_plane(angle));
                println!(
                    "{roughness} {sharpness:4} {angle}: {exact:.3e} {:.3} {:.3}",
                    filter + 1.0,
                    asg + 1.0
                );
                assert!(filter > -0.9 && filter < 8.0);
                if angle < -FRAC_PI_2 {
                    assert_eq!(asg, -1.0);
                }
            }
        }
    }
}

/// Light from one direction is what the lobe's value says.
#[test]
fn sharp_light_is_reflected_as_by_the_lobe() {
    for roughness in [0.1, 0.3, 0.9] {
        let (lobe, reflected) = seen_from(0.5, roughness);
        for angle in [-1.0, -0.5, 0.0, 0.5_f64] {
            let light = unit_light(in_plane(angle), 4e6);
            let exact = reflected(in_plane(angle));
            let found = f64::from(lobe.product_integral(&light));
            // The filter's masking is that of the viewer's side alone.
            assert!((found / exact - 1.0).abs() < 0.3, "{found} {exact}");
            let asg = f64::from(lobe.product_integral_by_asg(&light));
            assert!(
                angle != -0.5 || (asg / exact - 1.0).abs() < 0.01,
                "{asg} {exact}"
            );
        }
    }
    let below = Incidence {
        normal: Direction::Z,
        incoming: Direction::new(Vec3::new(1.0, 0.0, -0.1)).unwrap(),
    };
    let dark = GgxLobe::new(Ggx::new(0.2).unwrap(), NoFresnel, below);
    let light = unit_light(UP, 30.0);
    assert_eq!(dark.product_integral(&light), 0.0);
    assert_eq!(dark.product_integral_by_asg(&light), 0.0);
    // From behind the surface, opposite to the viewer.
    let (lobe, _) = seen_from(0.5, 0.2);
    let opposite = SphericalGaussian::with_integral(-lobe.incoming(), 30.0, 1.0).unwrap();
    assert_eq!(lobe.product_integral(&opposite), 0.0);
}

/// The error of the diffuse reflection, as a share of the reflection of light from the normal.
#[test]
fn diffuse_reflection_against_quadrature() {
    let lobe = LambertLobe::new(1.0, Direction::Z).unwrap();
    println!("error over 1/π; light's axis off the normal: 0, 0.5, 1, 1.4, π/2, 1.8, 2.4 rad");
    for sharpness in [0.0, 1.0, 3.0, 10.0, 30.0, 100.0, 1e4_f32] {
        let angles = [0.0, 0.5, 1.0, 1.4, FRAC_PI_2, 1.8, 2.4];
        let errors = angles.map(|angle| {
            let light = unit_light(in_plane(angle), sharpness);
            let width = (1.0 + f64::from(sharpness)).sqrt().recip();
            let exact = integral(in_plane(angle), width, |w| {
                w.0[2].max(0.0) / PI * value(&light, w)
            });
            (f64::from(lobe.product_integral(&light)) - exact) * PI
        });
        println!("{sharpness:6}: {errors:6.3?}");
        // cos⁺ of a mean is off from the mean of cos⁺ by the width of the light, at most.
        let width = (1.0 + f64::from(sharpness)).sqrt().recip();
        assert!(
            errors.iter().all(|error| error.abs() < 0.9 * width),
            "{errors:?}"
        );
    }
}

#[test]
fn share_above_a_surface_agrees_with_quadrature() {
    let mut worst = 0.0_f64;
    for sharpness in [0.0, 0.1, 1.0, 2.0, 3.0, 6.0, 10.0, 30.0, 100.0, 1e4_f32] {
        for step in 0..=20 {
            let angle = PI * f64::from(step) / 20.0;
            let light = unit_light(in_plane(angle), sharpness);
            let width = (1.0 + f64::from(sharpness)).sqrt().recip();
            let exact = integral(in_plane(angle), width, |w| {
                if w.0[2] > 0.0 { value(&light, w) } else { 0.0 }
            });
            worst = worst.max((f64::from(light.share_above(Direction::Z)) - exact).abs());
        }
    }
    println!("share above: off by at most {worst:.4}");
    assert!(worst < 0.025);
}
