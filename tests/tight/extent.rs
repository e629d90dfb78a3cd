//! The extent of a lobe along a direction: above the surface, and reached by it.

use std::f64::consts::PI;

use proptest::prelude::*;
use stochastic_light_culling::{Direction, Ggx, GgxLobe, Incidence, NoFresnel};
use support::generators;
use support::reference::{self, Vector, smith_g1};

proptest! {
    #![proptest_config(generators::cases(1000))]

    /// The extent along any direction is that of the surface l = r√(πD), found by search.
    #[test]
    fn extent_is_that_of_the_lobe(
        roughness in generators::up_to_one(0.01),
        lit in generators::lit(),
        direction in generators::unit_vector(),
    ) {
        let ggx = Ggx::new(roughness).unwrap();
        let lobe = GgxLobe::new(ggx, NoFresnel, Incidence { normal: lit.normal, incoming: lit.incoming });
        let direction = Direction::new(direction.to_f32()).unwrap();
        let extent = f64::from(lobe.extent(direction));
        let (alpha, mu) = (f64::from(roughness), lit.surface.incident_cosine());
        let radius = (smith_g1(alpha, mu) / (4.0 * PI * mu)).sqrt();

        let along = Vector::from(*direction).unit();
        let most = surface_points(alpha, &lit)
            .map(|x| along.dot(x) * radius)
            .fold(0.0, f64::max);
        prop_assert!(extent >= most, "{extent} {most}");
        // The net is coarse where the lobe bends most.
        prop_assert!(extent <= most + 0.01 * radius / alpha, "{extent} {most}");

        // Along the paper's axes: r/α, αr, r and r√(kμ² + α²).
        let rotation = lobe.rotation();
        let root = ((1.0 - alpha * alpha) * mu * mu + alpha * alpha).sqrt();
        for (axis, exact) in [
            (rotation.x_axis, radius / alpha),
            (-rotation.x_axis, radius * alpha),
            (rotation.y_axis, radius),
            (-rotation.y_axis, radius),
            (rotation.z_axis, radius * root),
        ] {
            let extent = f64::from(lobe.extent(Direction::new(axis).unwrap()));
            // The axes are rounded, by which a long lobe leans over a short extent.
            let lean = 2e-7 * radius / alpha;
            prop_assert!((extent - exact).abs() < 1e-5 * exact + lean, "{extent} {exact}");
            prop_assert!(extent > exact * (1.0 - 1e-9) - lean, "{extent} {exact}");
        }
    }
}

proptest! {
    #![proptest_config(generators::cases(400))]

    /// Where the largest eigenvalue is nearly double, rounding does not take the extent below the surface.
    #[test]
    fn extent_at_a_double_eigenvalue_is_above_and_tight(
        roughness in prop_oneof![2 => Just(1.0_f32), 3 => generators::up_to_one(0.01)],
        normal in generators::unit_vector(),
        cosine in prop_oneof![2 => generators::log_uniform(1e-10, 1.0), 1 => Just(1.0)],
        azimuth in 0.0..2.0 * PI,
        off in generators::unit_vector(),
        size in prop_oneof![Just(0.0), generators::log_uniform(1e-9, 0.1)],
    ) {
        let side = normal.orthogonal();
        let side = side.turned(normal.cross(side), azimuth);
        let incoming = normal * cosine + side * (1.0 - cosine * cosine).sqrt();
        assert_extent_is_tight(roughness, &generators::Lit::new(normal, incoming), off * size)?;
    }
}

#[test]
fn extent_at_grazing_incidence_on_the_roughest_surface() {
    let incoming = Vector([-0.804_205_5, 1.716_676_2e-8, -0.594_351_4]);
    for height in [1e-12, 1e-10, 1e-9, 1.716_676_2e-8, 1e-7, 1e-6, 1e-5] {
        let incoming = Vector([incoming.0[0], height, incoming.0[2]]);
        let lit = generators::Lit::new(Vector([0.0, 1.0, 0.0]), incoming);
        for alpha in [1.0, 1.0 - f32::EPSILON, 1.0 - 1e-5, 0.99] {
            assert_extent_is_tight(alpha, &lit, Vector::ZERO).unwrap();
        }
    }
}

/// The extents near ±ω_u and ±ω_i, `off` them, are no less than the surface and what the eigenvalue says,
/// and no more than the latter but for rounding.
fn assert_extent_is_tight(
    roughness: f32,
    lit: &generators::Lit,
    off: Vector,
) -> Result<(), TestCaseError> {
    let lobe = GgxLobe::new(
        Ggx::new(roughness).unwrap(),
        NoFresnel,
        Incidence {
            normal: lit.normal,
            incoming: lit.incoming,
        },
    );
    if lobe.incident_cosine() <= 0.0 {
        return Ok(());
    }
    let (alpha, mu) = (f64::from(roughness), lit.surface.incident_cosine());
    let radius = (smith_g1(alpha, mu) / (4.0 * PI * mu)).sqrt();
    let points: Vec<Vector> = surface_points(alpha, lit).step_by(7).collect();
    let (mirror, incoming) = (lit.surface.mirror(), lit.surface.incoming);
    for near in [mirror, mirror * -1.0, incoming, incoming * -1.0] {
        let direction = Direction::new((near + off).to_f32()).unwrap();
        let along = Vector::from(*direction).unit();
        let extent = f64::from(lobe.extent(direction));
        let most = points.iter().map(|x| along.dot(*x)).fold(0.0, f64::max) * radius;
        prop_assert!(extent >= most, "{extent} {most} towards {direction:?}");
        let exact = radius / alpha * largest_eigenvalue(alpha, &lit.surface, along);
        prop_assert!(extent >= exact, "{extent} {exact} towards {direction:?}");
        prop_assert!(
            extent <= exact * (1.0 + 3e-6),
            "{extent} {exact} towards {direction:?}"
        );
    }
    Ok(())
}

/// The largest eigenvalue of P(ω_i dᵀ + d ω_iᵀ − (d·ω_i) 1)P with P = α 1 + (1 − α) n nᵀ, by rotations that
/// make it diagonal.
fn largest_eigenvalue(alpha: f64, surface: &reference::Surface, d: Vector) -> f64 {
    let (n, w) = (surface.normal, surface.incoming);
    let cosine = d.dot(w);
    let p = |i: usize, j: usize| (1.0 - alpha) * n.0[i] * n.0[j] + if i == j { alpha } else { 0.0 };
    let m =
        |i: usize, j: usize| w.0[i] * d.0[j] + d.0[i] * w.0[j] - if i == j { cosine } else { 0.0 };
    let mut q = [[0.0; 3]; 3];
    for (i, j) in (0..9).map(|at| (at / 3, at % 3)) {
        let terms = (0..9).map(|at| p(i, at / 3) * m(at / 3, at % 3) * p(at % 3, j));
        q[i][j] = terms.sum();
    }
    for _ in 0..12 {
        for [i, j] in [[0, 1], [0, 2], [1, 2]] {
            let angle = 0.5 * (2.0 * q[i][j]).atan2(q[i][i] - q[j][j]);
            let (sin, cos) = angle.sin_cos();
            for row in &mut q {
                (row[i], row[j]) = (cos * row[i] + sin * row[j], cos * row[j] - sin * row[i]);
            }
            let [a, b] = [q[i], q[j]];
            for k in 0..3 {
                (q[i][k], q[j][k]) = (cos * a[k] + sin * b[k], cos * b[k] - sin * a[k]);
            }
        }
    }
    q[0][0].max(q[1][1]).max(q[2][2])
}

/// Points of the surface l = r√(πD) for r = 1: a net over its half vectors.
pub fn surface_points(alpha: f64, lit: &generators::Lit) -> impl Iterator<Item = Vector> {
    let reference::Surface { normal, incoming } = lit.surface;
    let tangent = match normal.cross(incoming) {
        cross if cross.length() > 1e-9 => cross.unit().cross(normal),
        _ => normal.orthogonal(),
    };
    let across = normal.cross(tangent);
    (0..400 * 120).map(move |i| {
        let (t, phi) = (
            PI * (f64::from(i / 120) + 0.5) / 800.0,
            PI * f64::from(i % 120) / 60.0,
        );
        let side = tangent * phi.cos() + across * phi.sin();
        let half = normal.turned(side, (alpha * t.tan()).atan());
        let outgoing = half * (2.0 * half.dot(incoming)) - incoming;
        outgoing * (PI * reference::ggx_ndf(alpha, half, normal)).sqrt()
    })
}
