//! The bounds past the paper are as tight as they are said to be, and never above its spheroid: the
//! triaxial one within a few per cent of the least volume of its family and touched by the surface that it
//! is derived for, the tight one and that of a grain nearly the smallest ellipsoids there are.

use std::f64::consts::PI;

use proptest::prelude::*;
use rayon::prelude::*;
use stochastic_light_culling::{
    AnisotropicGgx, AnisotropicGgxLobe, Bounded, Direction, Ellipsoid, Ggx, GgxLobe, Incidence,
    NoFresnel, Paper, Tight, Triaxial, glam::Vec3,
};
use support::generators;
use support::reference::{
    self, Fresnel, GivenFresnel, Masking, Shape, SurfaceFrame, Vector, anisotropic_g2,
    anisotropic_ndf, smith_g1, smith_g2,
};
use support::tightness::{self, volume};

fn spheroid_volume<F: stochastic_light_culling::Fresnel>(lobe: &GgxLobe<F>) -> f64 {
    volume(&Ellipsoid::from(lobe.unit_bound_by(Paper)))
}

/// The mean and the largest of the tight bound's volumes over the smallest there are, and the largest
/// over the paper's.
fn tightness(reflectances: &[f32]) -> [f64; 3] {
    // A third of the grid, which still has every roughness and every angle; the whole of it is
    // `examples/tightness`.
    let places: Vec<_> = tightness::grid(reflectances)
        .into_iter()
        .step_by(3)
        .collect();
    let volumes: Vec<_> = places
        .into_par_iter()
        .map(tightness::Place::measure)
        .collect();
    let ratios = || volumes.iter().map(|v| v.tight / v.attainable);
    let most = |numbers: &mut dyn Iterator<Item = f64>| numbers.fold(0.0, f64::max);
    [
        ratios().sum::<f64>() / volumes.len() as f64,
        most(&mut ratios()),
        most(&mut volumes.iter().map(|v| v.tight)),
    ]
}

#[test]
fn volume_is_near_the_least_for_metals() {
    let [mean, most, over_paper] = tightness(&tightness::METALS);
    println!("mean {mean}, most {most}, over the paper's at most {over_paper}");
    assert!(mean <= 1.15 && most <= 1.25, "mean {mean}, most {most}");
    assert!(over_paper <= 1.001, "{over_paper}");
}

#[test]
fn volume_is_near_the_least_for_dielectrics() {
    let [mean, most, over_paper] = tightness(&tightness::DIELECTRICS);
    println!("mean {mean}, most {most}, over the paper's at most {over_paper}");
    assert!(mean <= 1.2 && most <= 1.5, "mean {mean}, most {most}");
    assert!(over_paper <= 1.001, "{over_paper}");
}

/// Volume of the triaxial ellipsoid over the paper's spheroid, against the least of the family (F = 1),
/// found by search.
#[test]
fn triaxial_volume_is_near_the_least_of_the_family() {
    let degrees = [10.0_f32, 30.0, 45.0, 60.0, 75.0, 85.0];
    let least = [
        (0.5, [0.991, 0.928, 0.863, 0.799, 0.752, 0.735]),
        (0.2, [0.986, 0.892, 0.784, 0.658, 0.526, 0.460]),
        (0.1, [0.985, 0.881, 0.751, 0.587, 0.396, 0.276]),
        (0.05, [0.985, 0.874, 0.730, 0.545, 0.326, 0.174]),
        (0.01, [0.985, 0.868, 0.712, 0.509, 0.272, 0.102]),
    ];
    for (roughness, row) in least {
        for (degrees, least) in degrees.into_iter().zip(row) {
            let angle = degrees.to_radians();
            let incoming = Vec3::new(angle.sin(), 0.0, angle.cos());
            let lit = generators::Lit::new(Vector::from(Vec3::Z), incoming.into());
            let said = say(roughness, Fresnel::None, &lit);
            let ratio = volume(&said.triaxial) / said.spheroid_volume;
            assert!(
                ratio > least - 6e-4 && ratio < 1.03 * least + 6e-4,
                "α = {roughness}, {degrees}°: {ratio}, least {least}"
            );
        }
    }
}

/// Volume over that of the smallest ellipsoid around the lobe (F = 1), found by Khachiyan's algorithm and
/// given in units of r′³: incidence in and at 45° to the tangent's plane, and across it.
#[test]
fn ellipsoid_of_the_grain_is_near_the_smallest() {
    let azimuths = [0.0_f32, 45.0, 90.0];
    let smallest = [
        ([0.5, 0.25], 30.0_f32, [7.8008e-2, 7.9746e-2, 7.8197e-2]),
        ([0.5, 0.25], 60.0, [6.5289e-2, 6.3357e-2, 3.887e-2]),
        ([0.5, 0.25], 85.0, [5.6395e-2, 5.1683e-2, 2.3784e-2]),
        ([0.4, 0.05], 30.0, [1.1493e-2, 2.0654e-2, 2.3396e-2]),
        ([0.4, 0.05], 60.0, [9.1355e-3, 2.2003e-2, 1.3118e-2]),
        ([0.4, 0.05], 85.0, [7.2146e-3, 1.9614e-2, 1.1053e-3]),
        ([0.1, 0.02], 30.0, [9.0685e-4, 9.9082e-4, 1.0139e-3]),
        ([0.1, 0.02], 60.0, [5.7025e-4, 6.747e-4, 5.7505e-4]),
        ([0.1, 0.02], 85.0, [2.018e-4, 3.3763e-4, 1.0026e-4]),
    ];
    let mut sum = 0.0;
    for (roughness, degrees, row) in smallest {
        for (azimuth, smallest) in azimuths.into_iter().zip(row) {
            let (angle, azimuth) = (degrees.to_radians(), azimuth.to_radians());
            let along = Vec3::new(azimuth.cos(), azimuth.sin(), 0.0);
            let incoming = along * angle.sin() + Vec3::Z * angle.cos();
            let lit = generators::Lit::new(Vector::from(Vec3::Z), incoming.into());
            let lobe = grained(roughness, NoFresnel, &lit, Vector::from(Vec3::X));
            let [alpha_x, alpha_y] = roughness.map(f64::from);
            let (g1, mu) = (smith_of_grain(&lobe, &lit), lit.surface.incident_cosine());
            let scale = (g1 / (4.0 * PI * mu * alpha_x * alpha_y)).sqrt();
            let ratio = volume(&lobe.unit_bound()) / (smallest * scale.powi(3));
            assert!(
                ratio > 0.999 && ratio < 1.5,
                "α = {roughness:?}, {degrees}°, {azimuth}: {ratio} of the smallest"
            );
            sum += ratio;
        }
    }
    assert!(sum / 27.0 < 1.12, "{} on average", sum / 27.0);
}

/// The largest F·G2/G1 over the hemisphere, by search in the plane of incidence and head-on.
fn exact_max_reflected(roughness: f32, fresnel: Fresnel, masking: Masking, mu: f64) -> f64 {
    let (alpha, angle) = (f64::from(roughness), mu.min(1.0).acos());
    (0..4000)
        .map(|i| 0.5 * PI * f64::from(i) / 4000.0)
        .map(|outgoing| {
            let share = smith_g2(alpha, masking, mu, outgoing.cos()) / smith_g1(alpha, mu);
            let widest = fresnel.at((0.5 * (angle + outgoing)).cos());
            let narrowest = fresnel.at((0.5 * (angle - outgoing)).cos());
            share * widest.max(narrowest)
        })
        .fold(0.0, f64::max)
}

/// What a lobe says: its largest F·G2/G1, the two ellipsoids past the paper, and the volume of the
/// paper's.
struct Said {
    max_reflected: f64,
    triaxial: Ellipsoid,
    tight: Ellipsoid,
    spheroid_volume: f64,
}

fn say(roughness: f32, fresnel: Fresnel, lit: &generators::Lit) -> Said {
    let fresnel = GivenFresnel::try_from(fresnel).unwrap();
    let ggx = Ggx::new(roughness).unwrap();
    let lobe = GgxLobe::new(
        ggx,
        fresnel,
        Incidence {
            normal: lit.normal,
            incoming: lit.incoming,
        },
    );
    Said {
        max_reflected: lobe.max_reflected().into(),
        triaxial: lobe.unit_bound_by(Triaxial),
        tight: lobe.unit_bound_by(Tight),
        spheroid_volume: spheroid_volume(&lobe),
    }
}

/// A lobe with a grain along `tangent`, or at right angles to a normal that is parallel to that.
fn grained<F: stochastic_light_culling::Fresnel>(
    [along, across]: [f32; 2],
    fresnel: F,
    lit: &generators::Lit,
    tangent: Vector,
) -> AnisotropicGgxLobe<F> {
    let ggx = AnisotropicGgx::new(along, across).unwrap();
    let on = |tangent: Vector| {
        let tangent = Direction::new(tangent.to_f32()).unwrap();
        AnisotropicGgxLobe::new(
            ggx,
            fresnel,
            Incidence {
                normal: lit.normal,
                incoming: lit.incoming,
            },
            tangent,
        )
    };
    on(tangent)
        .or_else(|_| on(lit.surface.normal.orthogonal()))
        .unwrap()
}

/// G1(ω_i)
fn smith_of_grain<F, G>(lobe: &AnisotropicGgxLobe<F, G>, lit: &generators::Lit) -> f64
where
    F: stochastic_light_culling::Fresnel,
{
    let frame = SurfaceFrame::new(lit.surface.normal, lobe.tangent());
    let incoming = frame.slopes(lit.surface.incoming);
    let head_on = [0.0; 2];
    anisotropic_g2(
        lobe.ggx().roughness(),
        Masking::Separable,
        incoming,
        head_on,
    )
}

proptest! {
    #![proptest_config(generators::cases(1000))]

    #[test]
    fn joint_maximum_bounds_and_is_nearly_attained(
        roughness in generators::roughness(),
        fresnel in generators::fresnel(),
        lit in generators::lit(),
    ) {
        let mu = lit.surface.incident_cosine();
        let exact = exact_max_reflected(roughness, fresnel, Masking::HeightCorrelated, mu);
        let said = say(roughness, fresnel, &lit).max_reflected;
        prop_assert!(said >= exact - 1e-20, "{said} {exact}");
        // Of factors that rise slowly; one that rises from nothing to all within a segment has only its
        // value at the segment's end.
        let is_slow = match fresnel {
            Fresnel::None | Fresnel::Schlick(_) => true,
            Fresnel::Dielectric(eta) => (1.25..4.0).contains(&eta),
            Fresnel::Conductor(_, kappa) => kappa > 1.0,
        };
        prop_assert!(!is_slow || said <= 1.6 * exact, "{said} {exact}");
    }

    #[test]
    fn ellipsoids_are_not_above_the_spheroid_and_the_triaxial_one_is_touched(
        roughness in generators::up_to_one(0.01),
        fresnel in generators::fresnel(),
        lit in generators::lit(),
    ) {
        let said = say(roughness, fresnel, &lit);
        prop_assume!(said.max_reflected > 1e-15);
        prop_assert!(volume(&said.tight) <= 1.001 * said.spheroid_volume);
        prop_assert!(volume(&said.triaxial) <= 1.001 * said.spheroid_volume);
        // The tight one's axes are orthonormal, so that its semi-axes mean what they say: to eleven roundings
        // of a length, and to as many of a right angle.
        let rotation = said.tight.rotation();
        let axes = [rotation.x_axis, rotation.y_axis, rotation.z_axis].map(Vector::from);
        for (i, j) in [(0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (2, 0)] {
            let off = axes[i].dot(axes[j]) - f64::from(u8::from(i == j));
            prop_assert!(off.abs() <= 22.0 * f64::from(f32::EPSILON) / 2.0, "{i} {j}: {off}");
        }

        // The surface l = r√(πD) with r² = (F G2/G1)_max G1/(4πμ), everywhere.
        let (alpha, mu) = (f64::from(roughness), lit.surface.incident_cosine());
        let radius_squared = said.max_reflected * smith_g1(alpha, mu) / (4.0 * PI * mu);
        let shape = Shape::from(said.triaxial);
        // Touched where the amplitude of the derivation's sinusoids is: a dense net finds it nearly.
        let most = surface_points(alpha, &lit)
            .map(|x| shape.level(Vector::ZERO, x * radius_squared.sqrt()))
            .fold(0.0, f64::max);
        prop_assert!(most <= 1.0, "left at {most}");
        prop_assert!(most > 0.99, "reached only to {most}");
    }

    #[test]
    fn grain_of_equal_roughness_is_none(
        roughness in generators::roughness(),
        fresnel in generators::fresnel(),
        lit in generators::lit(),
        tangent in generators::unit_vector(),
    ) {
        let fresnel = GivenFresnel::try_from(fresnel).unwrap();
        let plain = GgxLobe::new(Ggx::new(roughness).unwrap(), fresnel, Incidence { normal: lit.normal, incoming: lit.incoming });
        let grained = grained([roughness; 2], fresnel, &lit, tangent);
        prop_assert_eq!(grained.unit_bound(), plain.unit_bound_by(Triaxial));
        prop_assert_eq!(grained.separable().unit_bound(), plain.separable().unit_bound_by(Triaxial));
    }

    #[test]
    fn ellipsoid_of_the_grain_is_touched_and_not_above_the_spheroid_of_the_rougher(
        roughness in [generators::up_to_one(0.01), generators::up_to_one(0.01)],
        fresnel in generators::fresnel(),
        lit in generators::lit(),
        tangent in generators::unit_vector(),
    ) {
        let fresnel = GivenFresnel::try_from(fresnel).unwrap();
        let lobe = grained(roughness, fresnel, &lit, tangent);
        let reflected = f64::from(lobe.max_reflected());
        prop_assume!(reflected > 1e-15);
        let bound = lobe.unit_bound();

        // The surface l = r′/(ω_hᵀP⁻²ω_h), everywhere.
        let g1 = smith_of_grain(&lobe, &lit);
        let [alpha_x, alpha_y] = roughness.map(f64::from);
        let mu = lit.surface.incident_cosine();
        let scale = (reflected * g1 / (4.0 * PI * mu * alpha_x * alpha_y)).sqrt();
        let rougher = alpha_x.max(alpha_y);
        let spheroid = scale.powi(3) * rougher * rougher * 0.5 * (1.0 + rougher * rougher);
        prop_assert!(volume(&bound) <= 1.001 * spheroid);

        let shape = Shape::from(bound);
        let normal = lit.surface.normal;
        let frame = SurfaceFrame::new(normal, lobe.tangent());
        let peak = PI * alpha_x * alpha_y;
        let most = lit.surface.mirrored_by_facets(roughness, lobe.tangent())
            .chain([lit.surface.mirror()])
            .map(|outgoing| {
                let half = (outgoing + lit.surface.incoming).unit();
                let density = anisotropic_ndf(roughness, frame.slopes(half), half.dot(normal));
                shape.level(Vector::ZERO, outgoing * (scale * (peak * density).sqrt()))
            })
            .fold(0.0, f64::max);
        prop_assert!(most <= 1.0, "left at {most}");
        prop_assert!(most > 0.98, "reached only to {most}");
    }

    /// F·G2/G1 at any azimuth is below what the bound takes it to be.
    #[test]
    fn joint_maximum_of_a_grain_bounds(
        roughness in generators::two_roughnesses(),
        fresnel in generators::fresnel(),
        lit in generators::lit(),
        tangent in generators::unit_vector(),
        outgoing in prop::collection::vec(generators::unit_vector(), 40),
    ) {
        let given = GivenFresnel::try_from(fresnel).unwrap();
        let lobe = grained(roughness, given, &lit, tangent);
        let frame = SurfaceFrame::new(lit.surface.normal, lobe.tangent());
        let g1 = smith_of_grain(&lobe, &lit);
        for outgoing in outgoing {
            if outgoing.dot(lit.surface.normal) <= 0.0 {
                continue;
            }
            let half = (outgoing + lit.surface.incoming).unit();
            let [i, o] = [lit.surface.incoming, outgoing].map(|v| frame.slopes(v));
            let g2 = anisotropic_g2(roughness, Masking::HeightCorrelated, i, o);
            let share = fresnel.at(half.dot(lit.surface.incoming).min(1.0)) * g2 / g1;
            let said = f64::from(lobe.max_reflected());
            prop_assert!(said >= share - 1e-20, "{said} {share}");
        }
    }

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
fn surface_points(alpha: f64, lit: &generators::Lit) -> impl Iterator<Item = Vector> {
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
