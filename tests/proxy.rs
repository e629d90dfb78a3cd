//! A proxy contains its ellipsoid, touches it with every triangle, and is a closed surface.

use std::collections::HashMap;
use std::f64::consts::PI;

use proptest::prelude::*;
use stochastic_light_culling::{
    Bounded, Direction, Ellipsoid, PhongLobe, Proxy,
    glam::{Mat3, Vec3},
};
use support::generators;
use support::reference::{Shape, Vector};

const PROXIES: [Proxy; 2] = [Proxy::Icosahedron, Proxy::Icosphere];

/// The triangles of `proxy` around `ellipsoid`, relative to the exact centre.
fn triangles(proxy: Proxy, ellipsoid: &Ellipsoid) -> Vec<[Vector; 3]> {
    let [light, offset] = ellipsoid.center_parts().map(Vector::from);
    let vertices: Vec<Vector> = proxy
        .vertices(ellipsoid)
        .map(|vertex| (Vector::from(vertex) - light) - offset)
        .collect();
    let corners = |triangle: &[u16; 3]| triangle.map(|i| vertices[usize::from(i)]);
    proxy.triangles().iter().map(corners).collect()
}

/// How far the plane of each triangle lies outside the ellipsoid around the origin: its distance over the
/// ellipsoid's extent along its normal. Negative if the triangle faces inward.
fn clearances(proxy: Proxy, ellipsoid: &Ellipsoid) -> Vec<f64> {
    let shape = Shape::from(*ellipsoid);
    let clearance = |[a, b, c]: [Vector; 3]| {
        let normal = (b - a).cross(c - a).unit();
        let extent = (0..3).map(|i| (shape.semi_axes[i] * shape.axes[i].dot(normal)).powi(2));
        normal.dot(a) / extent.sum::<f64>().sqrt()
    };
    triangles(proxy, ellipsoid)
        .into_iter()
        .map(clearance)
        .collect()
}

/// The solid angle of all triangles about `point`, over 4π: 1 inside, 0 outside
/// [Van Oosterom & Strackee 1983].
fn times_around(triangles: &[[Vector; 3]], point: Vector) -> f64 {
    let half_angle = |corners: &[Vector; 3]| {
        let [a, b, c] = corners.map(|corner| corner - point);
        let [x, y, z] = [a, b, c].map(Vector::length);
        let across = a.dot(b.cross(c));
        across.atan2(x * y * z + a.dot(b) * z + b.dot(c) * x + c.dot(a) * y)
    };
    triangles.iter().map(half_angle).sum::<f64>() / (2.0 * PI)
}

proptest! {
    #![proptest_config(generators::cases(1000))]

    #[test]
    fn every_triangle_touches(
        ellipsoid in generators::ellipsoid(),
        mirrored in any::<bool>(),
    ) {
        let mut rotation = ellipsoid.rotation();
        if mirrored {
            rotation.z_axis = -rotation.z_axis;
        }
        // As near the origin as for a vertex to be more than rounding.
        let near = 1e-2 * ellipsoid.semi_axes().max_element() * Vec3::new(0.3, -1.0, 0.7);
        let ellipsoid = Ellipsoid::new(near, rotation, ellipsoid.semi_axes()).unwrap();
        for proxy in PROXIES {
            for clearance in clearances(proxy, &ellipsoid) {
                prop_assert!((1.0..1.0003).contains(&clearance), "{proxy:?}: {clearance}");
            }
        }
    }

    /// Wherever the ellipsoid is, if the rounding of a vertex were as large as itself.
    #[test]
    fn the_ellipsoid_is_inside(
        ellipsoid in generators::ellipsoid(),
        sample in prop::collection::vec(generators::unit_vector(), 20),
    ) {
        let shape = Shape::from(ellipsoid);
        for proxy in PROXIES {
            let triangles = triangles(proxy, &ellipsoid);
            for unit in &sample {
                let point = shape.point(*unit) - (shape.origin + shape.offset);
                let times = times_around(&triangles, point);
                prop_assert!((times - 1.0).abs() < 1e-3, "{proxy:?}: {times} around {unit:?}");
            }
        }
    }
}

/// The ball of a needle 10⁶ times as long as wide, and of one whose vertices are all rounding.
#[test]
fn needles_are_inside() {
    let tilted = Direction::new(Vec3::new(0.3, 0.5, -0.8)).unwrap();
    let (v, w) = tilted.any_orthonormal_pair();
    let rotation = Mat3::from_cols(*tilted, v, w);
    for center in [Vec3::ZERO, Vec3::new(3e5, -1e6, 10.0)] {
        let needle = Ellipsoid::new(center, rotation, Vec3::new(1e3, 1e-3, 1e-3)).unwrap();
        let shape = Shape::from(needle);
        for proxy in PROXIES {
            let triangles = triangles(proxy, &needle);
            for end in [-1.0, 1.0] {
                for axis in 0..3 {
                    let mut unit = Vector::ZERO;
                    unit.0[axis] = end;
                    let point = shape.point(unit) - (shape.origin + shape.offset);
                    assert!((times_around(&triangles, point) - 1.0).abs() < 1e-3);
                }
            }
        }
    }
}

#[test]
fn meshes_are_closed_and_wound_outward() {
    let ball = Ellipsoid::new(Vec3::ZERO, Mat3::IDENTITY, Vec3::ONE).unwrap();
    for (proxy, vertices, faces) in [(Proxy::Icosahedron, 12, 20), (Proxy::Icosphere, 42, 80)] {
        assert_eq!(proxy.vertices(&ball).len(), vertices);
        assert_eq!(proxy.triangles().len(), faces);
        // Each edge is run along once in either direction, and all vertices are used.
        let mut runs = HashMap::new();
        for triangle in proxy.triangles() {
            for side in 0..3 {
                *runs
                    .entry((triangle[side], triangle[(side + 1) % 3]))
                    .or_insert(0) += 1;
            }
        }
        assert!(runs.values().all(|times| *times == 1));
        assert!(
            runs.keys()
                .all(|(start, end)| runs.contains_key(&(*end, *start)))
        );
        let mut starts: Vec<_> = runs.keys().map(|(start, _)| usize::from(*start)).collect();
        starts.sort_unstable();
        starts.dedup();
        assert!(starts.into_iter().eq(0..vertices));
        // Euler: V − E + F = 2.
        assert_eq!(vertices + faces, runs.len() / 2 + 2);
        assert!(
            clearances(proxy, &ball)
                .iter()
                .all(|clearance| *clearance > 0.0)
        );
    }
}

/// Against the least volume of any polyhedron with so many faces around a ball of volume 4π/3,
/// (f − 2) sin 2ω (3 tan²ω − 1) with ω = πf/(6f − 12) [Fejes Tóth 1964]: as a scale, within 1 %.
#[test]
fn no_polyhedron_of_so_many_faces_is_much_smaller() {
    let ball = Ellipsoid::new(Vec3::ZERO, Mat3::IDENTITY, Vec3::ONE).unwrap();
    for proxy in PROXIES {
        let volume: f64 = triangles(proxy, &ball)
            .into_iter()
            .map(|[a, b, c]| a.dot(b.cross(c)) / 6.0)
            .sum();
        let faces = proxy.triangles().len() as f64;
        let omega = PI * faces / (6.0 * (faces - 2.0));
        let least = (faces - 2.0) * (2.0 * omega).sin() * (3.0 * omega.tan().powi(2) - 1.0);
        let scale = (volume / least).cbrt();
        assert!((1.0..1.01).contains(&scale), "{proxy:?}: {scale}");
    }
}

#[test]
fn edges_of_the_range() {
    let lobe = PhongLobe::about(1.0, 100.0, Direction::Z).unwrap();
    let place = Vec3::new(1.0, 2.0, 3.0);
    for proxy in PROXIES {
        let at = |scale| proxy.vertices(&lobe.unit_bound().placed(place, scale));
        assert!(
            at(0.0).all(|vertex| vertex == place),
            "of nothing, the centre"
        );
        for scale in [f32::from_bits(1), f32::MIN_POSITIVE, 1e37, f32::MAX] {
            assert!(at(scale).all(Vec3::is_finite), "at scale {scale}");
        }
    }
}
