//! The ellipsoid of a cluster encloses: a proof over boxes for the table, and samples of the crate's ellipsoids.
//! And it is nearly the smallest, found by search.

use std::f64::consts::{FRAC_PI_2, TAU};

use proptest::prelude::*;
use stochastic_light_culling::{
    BatchBuilder, Camera, Direction, Ellipsoid, LightBatch, Roulette, SphericalGaussian, Vpl, Vsgl,
    Xi, glam::Vec3,
};
use support::certificate::ClusterCell;
use support::generators::{self, cases, log_uniform};
use support::reference::{Cluster, Shape, Vector};

#[allow(dead_code, reason = "the tests take parts of it")]
#[path = "../examples/tabulate/cluster.rs"]
mod fit;

const BYTES: &[u8] = include_bytes!("../src/bound/cluster.bin");

/// `examples/tabulate -- --cluster` makes it.
#[test]
fn table_is_reproduced() {
    assert!(fit::table() == BYTES);
}

/// `examples/tabulate -- --prove` proves all cells.
#[test]
fn table_encloses() {
    let cells = ClusterCell::all();
    for cell in cells.iter().skip(2).step_by(9) {
        let boxes = cell.prove(300_000).expect("an ellipsoid encloses");
        println!("{boxes} boxes");
    }
}

/// A frame's δξ for a light whose r = √(c/(δξ)) is `range`.
fn roulette_for(light: &Vsgl, range: f64) -> (Roulette, Xi) {
    let least = f64::from(light.lobe().amplitude()) / (range * range);
    (Roulette::new(least as f32).unwrap(), Xi::new(1.0).unwrap())
}

/// A light and its r. The spread is any share of that, up to where the light reaches nothing.
fn light() -> impl Strategy<Value = (Vsgl, f64)> {
    let sharpness =
        prop_oneof![1 => Just(0.0), 1 => Just(4_194_304.0), 8 => log_uniform(1e-3, 4e6)];
    let share = prop_oneof![
        1 => Just(0.0),
        // Of the largest spread at which the light reaches anything.
        3 => log_uniform(1e-7, 1e-1).prop_map(|x| 1.0 - x),
        8 => log_uniform(1e-6, 1.0),
    ];
    (
        generators::unit_vector(),
        sharpness,
        share,
        log_uniform(1e-8, 1e8),
        generators::position(),
    )
        .prop_map(|(axis, sharpness, share, range, position)| {
            let axis = Direction::new(axis.to_f32()).unwrap();
            let lobe = SphericalGaussian::new(axis, sharpness as f32, 0.7).unwrap();
            let most = if sharpness > 1e-6 {
                -(-2.0 * sharpness).exp_m1() / sharpness
            } else {
                2.0
            };
            let spread = most.sqrt() * share * range;
            (Vsgl::new(position, spread as f32, lobe).unwrap(), range)
        })
}

/// About the axis, at all angles that the lobe's width makes interesting.
fn direction_about(axis: Vector, sharpness: f64, tangent: f64, turn: f64) -> Vector {
    let side = axis.orthogonal();
    let side = side.turned(axis.cross(side), turn);
    let angle = 2.0 * (tangent.tan() / (1.0 + sharpness).sqrt()).atan();
    axis.turned(side, angle).unit()
}

proptest! {
    #![proptest_config(cases(2048))]

    /// Every point that accepts the light is inside: of the model, and of the crate's own numbers.
    #[test]
    fn ellipsoid_encloses(
        (light, range) in light(),
        tangent in 0.0..FRAC_PI_2,
        turn in 0.0..TAU,
    ) {
        let (roulette, xi) = roulette_for(&light, range);
        let bound = Shape::from(light.bound(&roulette, xi));
        let cluster = Cluster::from(&light);
        let direction = direction_about(cluster.axis, cluster.sharpness, tangent, turn);
        let reach = cluster.reach(direction, f64::from(roulette.delta()));
        let position = Vector::from(light.position());
        if reach > 0.0 {
            let level = bound.level(position, direction * reach);
            prop_assert!(level <= 1.0, "{level}");
        }
        for share in [0.5, 0.999, 1.0, 1.000_001] {
            let point = light.position() + (direction * (reach * share)).to_f32();
            if roulette.accepts(light.scalar_irradiance(point), 1.0, xi) {
                let level = bound.level(position, Vector::from(point) - position);
                prop_assert!(level <= 1.0, "accepted at {point}: {level}");
            }
        }
    }

    /// Nothing is NaN, and the ellipsoid lies in the sphere that is promised.
    #[test]
    fn ellipsoid_is_no_larger_than_promised((light, range) in light()) {
        let (roulette, xi) = roulette_for(&light, range);
        let bound = light.bound(&roulette, xi);
        prop_assert!(bound.center().is_finite() && bound.semi_axes().is_finite());
        let farthest = f64::from(bound.center_parts()[1].length() + bound.semi_axes().max_element());
        prop_assert!(1.1 * range >= farthest, "{bound:?}");
    }
}

proptest! {
    #![proptest_config(cases(64))]

    /// A batch holds, bit by bit, the shapes that each light has by itself.
    #[test]
    fn batches_hold_the_same(lights in prop::collection::vec(light(), 0..150), delta in log_uniform(1e-12, 1e12)) {
        let (roulette, xi) = (Roulette::new(delta as f32).unwrap(), Xi::new(0.37).unwrap());
        let lights: Vec<_> = lights.into_iter().map(|(light, _)| light).collect();
        let bounds = lights.iter().map(|light| light.bound(&roulette, xi).project(&camera()));
        let expected: Vec<_> = (0..).zip(bounds).filter_map(|(i, shape)| Some((i, shape?))).collect();
        for lanes in [16, 8, 4] {
            let mut batch = LightBatch::new();
            let builder = BatchBuilder::new(&roulette, &camera()).with_lanes(lanes);
            builder.add_vsgls((0..).zip(&lights).map(|(i, light)| (i, light, xi)), &mut batch);
            prop_assert_eq!(&batch.iter().collect::<Vec<_>>(), &expected);
        }
    }
}

fn volume(ellipsoid: &Ellipsoid) -> f64 {
    let semi_axes = ellipsoid.semi_axes().to_array();
    semi_axes.into_iter().map(f64::from).product()
}

fn light_of(sharpness: f32, spread: f64) -> Vsgl {
    let lobe = SphericalGaussian::new(Direction::Z, sharpness, 1.0).unwrap();
    Vsgl::new(Vec3::ZERO, spread as f32, lobe).unwrap()
}

/// Volume over that of the smallest ellipsoid around {E ≥ δξ}, r = 1, over sharpness and spread.
#[test]
fn ellipsoid_is_nearly_the_smallest() {
    let mut ratios = Vec::new();
    println!("volume over the smallest, by A/r² = 0, 0.001, 0.01, 0.03, 0.1, 0.3, 0.5, 0.8, 0.95");
    for sharpness in [
        0.01, 0.1, 0.3, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 100.0, 1e3, 1e4, 1e6_f32,
    ] {
        let lambda = f64::from(sharpness);
        // Where A/r² reaches 1 − e^{−2λ}, the light reaches nothing.
        let most = -(-2.0 * lambda).exp_m1();
        let row = [0.0, 0.001, 0.01, 0.03, 0.1, 0.3, 0.5, 0.8, 0.95].map(|share: f64| {
            let light = light_of(sharpness, (most * share / lambda).sqrt());
            let (roulette, xi) = roulette_for(&light, 1.0);
            let cluster = Cluster::from(&light);
            let points: Vec<_> = (0..=600)
                .map(|i| {
                    let tangent = FRAC_PI_2 * f64::from(i) / 600.0;
                    let direction = direction_about(cluster.axis, lambda, tangent, 0.0);
                    let reach = cluster.reach(direction, 1.0);
                    let height = reach * direction.dot(cluster.axis);
                    [height, reach * reach - height * height]
                })
                .collect();
            let [front, rear, across] = fit::smallest(&points, [1.0, 0.0], -1.0);
            volume(&light.bound(&roulette, xi)) / (0.5 * (front + rear) * across)
        });
        println!("{sharpness:9}: {row:6.3?}");
        ratios.extend(row);
    }
    ratios.sort_by(f64::total_cmp);
    let (median, worst) = (ratios[ratios.len() / 2], ratios[ratios.len() - 1]);
    println!("median {median:.3}, worst {worst:.3}");
    assert!(ratios[0] > 0.999);
    assert!(median < 1.1 && worst < 1.2);
}

/// Without spread it is the bound of the point light.
#[test]
fn no_spread_is_a_point_light() {
    let roulette = Roulette::new(0.01).unwrap();
    let xi = Xi::new(0.3).unwrap();
    for sharpness in [0.0, 0.5, 3.0, 100.0, 4e6_f32] {
        let lobe = SphericalGaussian::new(Direction::Y, sharpness, 0.25).unwrap();
        let position = Vec3::new(3.0, -1.0, 7.0);
        let bound = Vsgl::new(position, 0.0, lobe).unwrap().bound(&roulette, xi);
        let of_point = Vpl::new(position, 1.0, lobe).unwrap().bound(&roulette, xi);
        let same = |a: Vec3, b: Vec3| (a - b).abs().max_element() <= 1e-6 * b.abs().max_element();
        assert!(same(bound.center(), of_point.center()));
        assert!(same(bound.semi_axes(), of_point.semi_axes()), "{bound:?}");
        assert_eq!(bound.rotation(), of_point.rotation());
    }
    // With a spread that no point resolves it is nearly that, up to the table's room.
    for sharpness in [0.5, 3.0, 100.0, 4e6_f32] {
        let (roulette, xi) = roulette_for(&light_of(sharpness, 0.0), 1.0);
        let spread = volume(&light_of(sharpness, 1e-9).bound(&roulette, xi));
        let point = volume(&light_of(sharpness, 0.0).bound(&roulette, xi));
        assert!((spread / point - 1.0).abs() < 0.15, "{}", spread / point);
    }
}

/// λ = 0: a ball. Too wide a spread, or no amplitude: nothing.
#[test]
fn constant_wide_and_dark_clusters() {
    let at = |light: Vsgl| {
        let (roulette, xi) = roulette_for(&light, 1.0);
        light.bound(&roulette, xi)
    };
    let ball = at(light_of(0.0, 0.5));
    let semi_axes = ball.semi_axes();
    assert!(semi_axes.max_element() / semi_axes.min_element() < 1.001);
    assert!(ball.center().length() < 0.001);
    // l² = 1 − e^{−2l²/σ²}
    let reach = Cluster::from(&light_of(0.0, 0.5)).reach(Vector([0.0, 0.0, 1.0]), 1.0);
    assert!((1.0..1.02).contains(&(f64::from(semi_axes.x) / reach)));

    // E(0) = c(1 − e^{−2λ})/A.
    for sharpness in [0.01, 1.0, 30.0, 1e6_f32] {
        let most = (-(-2.0 * f64::from(sharpness)).exp_m1() / f64::from(sharpness)).sqrt();
        assert!(
            at(light_of(sharpness, 1.05 * most)).is_empty(),
            "{sharpness}"
        );
        assert!(!at(light_of(sharpness, 0.999 * most)).is_empty());
    }
    assert!(at(light_of(3.0, 1e15)).is_empty());
    let dark = SphericalGaussian::new(Direction::Z, 3.0, 0.0).unwrap();
    let dark = Vsgl::new(Vec3::ONE, 1.0, dark).unwrap();
    let (roulette, xi) = (Roulette::new(1.0).unwrap(), Xi::new(1.0).unwrap());
    assert!(dark.bound(&roulette, xi).is_empty());
    assert_eq!(dark.bound(&roulette, xi).project(&camera()), None);
}

fn camera() -> Camera {
    Camera::look_at(Vec3::ZERO, Vec3::Z, Vec3::Y, 1.0, 1.0, 0.1..10.0).unwrap()
}

/// The largest and the least of everything: numbers come out, or an infinite range.
#[test]
fn extreme_clusters_have_bounds() {
    for amplitude in [1e-38, 1.0, f32::MAX] {
        for delta in [f32::from_bits(1), 1.0, f32::MAX] {
            for sharpness in [0.0, 1e-30, 1.0, 4_194_304.0] {
                for spread in [0.0, f32::from_bits(1), 1e-20, 1.0, 1e15] {
                    let lobe = SphericalGaussian::new(Direction::Z, sharpness, amplitude).unwrap();
                    let light = Vsgl::new(Vec3::splat(1e30), spread, lobe).unwrap();
                    let roulette = Roulette::new(delta).unwrap();
                    for xi in [f32::MIN_POSITIVE, 1.0] {
                        let bound = light.bound(&roulette, Xi::new(xi).unwrap());
                        assert!(!bound.semi_axes().is_nan() && !bound.center().is_nan());
                        assert!(bound.semi_axes().min_element() >= 0.0);
                    }
                }
            }
        }
    }
}
