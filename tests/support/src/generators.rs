//! Inputs for the property tests, drawn more often where things break: at the ends of each range,
//! near one, at grazing and at normal incidence.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use proptest::prelude::*;
use stochastic_light_culling::{
    Direction, Ellipsoid, Incidence, LtcLobe,
    glam::{Mat3, Mat4, Vec3, Vec4},
};

use crate::reference::{
    Brdf, Fresnel, Masking, Surface, Vector,
    camera::{View, off_centre, orthographic},
};

/// So many cases, or as many as the environment variable PROPTEST_CASES says.
pub fn cases(number: u32) -> ProptestConfig {
    let named = std::env::var_os("PROPTEST_CASES").is_some();
    let default = ProptestConfig::default();
    let cases = if named { default.cases } else { number };
    ProptestConfig { cases, ..default }
}

/// Numbers spread evenly over decades.
pub fn log_uniform(low: f64, high: f64) -> impl Strategy<Value = f64> + Clone {
    let exponent = low.ln()..=high.ln();
    exponent.prop_map(move |x| x.exp().clamp(low, high))
}

/// Numbers in [low, 1]: evenly, over decades, within decades of 1, and the ends.
pub fn up_to_one(low: f64) -> impl Strategy<Value = f32> {
    prop_oneof![
        3 => log_uniform(low, 1.0),
        3 => low..=1.0,
        2 => log_uniform(1e-8, 0.5).prop_map(|gap| 1.0 - gap),
        1 => Just(1.0),
        1 => Just(low),
    ]
    .prop_map(|x| x as f32)
}

/// α in [1e-3, 1].
pub fn roughness() -> impl Strategy<Value = f32> {
    up_to_one(1e-3)
}

/// Unit vectors: any, along the axes, and nearly so.
pub fn unit_vector() -> impl Strategy<Value = Vector> {
    let anywhere = (-1.0..=1.0, 0.0..TAU).prop_map(|(z, angle): (f64, f64)| {
        let radius = (1.0 - z * z).sqrt();
        Vector([radius * angle.cos(), radius * angle.sin(), z])
    });
    let axis = (0..3_usize, any::<bool>()).prop_map(|(i, negative)| {
        let mut axis = Vector::ZERO;
        axis.0[i] = if negative { -1.0 } else { 1.0 };
        axis
    });
    let near_axis = (axis.clone(), anywhere.clone(), log_uniform(1e-8, 0.1))
        .prop_map(|(axis, off, size)| (axis + off * size).unit());
    prop_oneof![4 => anywhere, 1 => axis, 1 => near_axis]
}

/// A lit surface point as the crate is given it, and the same in `f64`.
#[derive(Clone, Copy, Debug)]
pub struct Lit {
    pub normal: Direction,
    pub incoming: Direction,
    pub surface: Surface,
}

impl Lit {
    pub fn new(normal: Vector, incoming: Vector) -> Self {
        let direction = |v: Vector| Direction::new(v.to_f32()).unwrap();
        let (normal, incoming) = (direction(normal), direction(incoming));
        Self {
            normal,
            incoming,
            surface: Surface {
                normal: Vector::from(*normal).unit(),
                incoming: Vector::from(*incoming).unit(),
            },
        }
    }
}

/// Surface points lit from above with μ in (1e-3, 1].
pub fn lit() -> impl Strategy<Value = Lit> {
    (unit_vector(), up_to_one(1.001e-3), 0.0..TAU).prop_map(|(normal, cosine, azimuth)| {
        let tangent = normal.orthogonal();
        let tangent = tangent.turned(normal.cross(tangent), azimuth);
        let incoming = normal.turned(tangent, f64::from(cosine).acos());
        Lit::new(normal, incoming)
    })
}

pub fn fresnel() -> impl Strategy<Value = Fresnel> {
    let f0 = prop_oneof![
        3 => 0.0..=1.0_f32,
        1 => 0.0..0.1_f32,
        1 => Just(0.0_f32),
        1 => Just(1.0_f32)
    ];
    let index = || {
        prop_oneof![
            2 => 1.0..3.0_f32,
            2 => 0.3..1.0_f32,
            1 => log_uniform(1e-3, 1e3).prop_map(|x| x as f32),
            1 => log_uniform(1e-6, 1e-2).prop_map(|gap| (1.0 + gap) as f32),
            1 => log_uniform(1e-6, 1e-2).prop_map(|gap| (1.0 - gap) as f32),
        ]
    };
    let extinction = prop_oneof![
        3 => 0.0..10.0_f32,
        1 => log_uniform(1e-6, 1e2).prop_map(|x| x as f32),
        1 => Just(0.0_f32)
    ];
    prop_oneof![
        Just(Fresnel::None),
        f0.prop_map(Fresnel::Schlick),
        index().prop_map(Fresnel::Dielectric),
        (index(), extinction).prop_map(|(eta, kappa)| Fresnel::Conductor(eta, kappa)),
    ]
}

pub fn ggx_brdf() -> impl Strategy<Value = Brdf> {
    let masking = prop_oneof![
        Just(Masking::HeightCorrelated),
        Just(Masking::Separable),
        Just(Masking::MaskedAlone)
    ];
    (roughness(), fresnel(), masking).prop_map(|(roughness, fresnel, masking)| Brdf::Ggx {
        roughness,
        fresnel,
        masking,
    })
}

/// α_x and α_y: equal, nearly so, and decades apart.
pub fn two_roughnesses() -> impl Strategy<Value = [f32; 2]> {
    let near = (roughness(), log_uniform(1e-7, 0.1))
        .prop_map(|(alpha, gap)| [alpha, (f64::from(alpha) * (1.0 - gap)).max(1e-3) as f32]);
    prop_oneof![
        4 => [roughness(), roughness()],
        1 => near,
        1 => roughness().prop_map(|alpha| [alpha; 2]),
    ]
}

/// The tangent may be parallel to the normal: see [`Brdf::laid_on`].
pub fn anisotropic_brdf() -> impl Strategy<Value = Brdf> {
    let tangent = unit_vector().prop_map(|v| Direction::new(v.to_f32()).unwrap());
    (two_roughnesses(), tangent, ggx_brdf()).prop_map(|(roughness, tangent, brdf)| {
        let Brdf::Ggx {
            fresnel, masking, ..
        } = brdf
        else {
            unreachable!("a GGX lobe is what was asked for")
        };
        Brdf::Anisotropic {
            roughness,
            tangent,
            fresnel,
            masking,
        }
    })
}

/// Phong's exponent: over decades, near 2, where the bound changes its form, and both ends.
pub fn exponent() -> impl Strategy<Value = f32> {
    let near_two = (log_uniform(1e-7, 1.0), any::<bool>())
        .prop_map(|(gap, above)| if above { 2.0 + gap } else { 2.0 - gap });
    let exponent = prop_oneof![
        3 => log_uniform(1e-3, 1_048_576.0),
        2 => 0.0..2.0,
        2 => near_two,
        1 => log_uniform(1e-40, 1e-3),
        1 => Just(2.0),
        1 => Just(0.0),
        1 => Just(1_048_576.0),
    ];
    exponent.prop_map(|x: f64| x as f32)
}

/// Inner and outer half angle of a spot light, from 10⁻³ rad to 180°: hard edges, none, and those about 90°.
pub fn cone_angles() -> impl Strategy<Value = [f32; 2]> {
    let about_half = (log_uniform(1e-7, 1.0), any::<bool>())
        .prop_map(|(gap, above)| FRAC_PI_2 + if above { gap } else { -gap });
    let outer = prop_oneof![
        2 => log_uniform(1e-3, PI),
        4 => 1e-3..PI,
        2 => about_half,
        1 => Just(FRAC_PI_2),
        1 => Just(PI),
    ];
    let share = prop_oneof![
        4 => 0.0..=1.0,
        1 => Just(0.0),
        1 => Just(1.0),
        1 => log_uniform(1e-7, 0.5).prop_map(|gap| 1.0 - gap),
    ];
    (outer, share).prop_map(|(outer, share)| {
        let outer = (outer as f32).min(std::f32::consts::PI);
        [(share as f32 * outer).min(outer), outer]
    })
}

/// The sharpness of an SG: over decades, and both ends.
pub fn sharpness() -> impl Strategy<Value = f32> {
    let sharpness = prop_oneof![
        4 => log_uniform(1e-3, 4_194_304.0),
        2 => 0.0..20.0,
        1 => log_uniform(1e-40, 1e-3),
        1 => Just(0.0),
        1 => Just(4_194_304.0),
    ];
    sharpness.prop_map(|x: f64| x as f32)
}

/// The elements of a matrix that a caller may give to a transformed cosine.
pub fn ltc_matrix() -> impl Strategy<Value = [f32; 4]> {
    let length = || log_uniform(0.1, 1e5);
    let between = up_to_one(2e-4).prop_map(|share| 0.5 * std::f64::consts::PI * f64::from(share));
    let any = (0.0..TAU, between, length(), length()).prop_map(|(angle, between, first, third)| {
        let row = |angle: f64, length: f64| [angle.cos(), angle.sin()].map(|x| x * length);
        let ([a, b], [c, d]) = (row(angle, first), row(angle + between, third));
        [a, b, c, d].map(|x| x as f32)
    });
    any.prop_filter("it is nearly singular", |elements| {
        LtcLobe::with_matrix(*elements, 1.0, Incidence::head_on(Direction::Z)).is_ok()
    })
}

/// Transformed cosines: fitted to GGX, and of callers' own matrices.
pub fn ltc() -> impl Strategy<Value = Brdf> {
    let share = || prop_oneof![3 => 0.001..=1.0_f32, 1 => Just(1.0_f32)];
    let fitted = (up_to_one(1e-6), share()).prop_map(|(alpha, f0)| Brdf::ltc(alpha, f0, None));
    let own = (ltc_matrix(), share()).prop_map(|(m, share)| Brdf::ltc(1.0, share, Some(m)));
    prop_oneof![2 => fitted, 1 => own]
}

pub fn brdf() -> impl Strategy<Value = Brdf> {
    let albedo = || prop_oneof![3 => 0.001..=1.0_f32, 1 => Just(1.0_f32)];
    let phong = (albedo(), exponent());
    let gaussian = (log_uniform(1e-6, 1e6), sharpness());
    prop_oneof![
        4 => ggx_brdf(),
        4 => anisotropic_brdf(),
        2 => albedo().prop_map(|albedo| Brdf::Lambert { albedo }),
        4 => ltc(),
        4 => phong.prop_map(|(albedo, exponent)| Brdf::Phong { albedo, exponent }),
        4 => gaussian.prop_map(|(amplitude, sharpness)| Brdf::SphericalGaussian {
            amplitude: amplitude as f32,
            sharpness,
        }),
        1 => Just(Brdf::Constant),
        4 => cone_angles().prop_map(Brdf::spot),
    ]
}

/// Flux, δ and ξ with Φ/(δξ) over 12 decades.
pub fn roulette() -> impl Strategy<Value = (f32, f32, f32)> {
    let xi = prop_oneof![3 => 1e-3..=1.0, 1 => log_uniform(2.3e-10, 1.0), 1 => Just(1.0)];
    (log_uniform(1e-6, 1e6), log_uniform(1e-3, 1e3), xi)
        .prop_map(|(quotient, delta, xi)| ((quotient * delta * xi) as f32, delta as f32, xi as f32))
}

/// Light positions: at the origin, and up to 1e4 in any direction.
pub fn position() -> impl Strategy<Value = Vec3> {
    prop_oneof![
        1 => Just(Vec3::ZERO),
        3 => (unit_vector(), log_uniform(1e-3, 1e4)).prop_map(|(v, s)| (v * s).to_f32()),
    ]
}

/// Views of either projection.
pub fn any_view() -> impl Strategy<Value = View> {
    prop_oneof![view(), orthographic_view()]
}

/// Views of either handedness, anywhere, with fields of view to 170°, symmetric and off-centre, and
/// clip depths that rise, fall, and reach to infinity.
pub fn view() -> impl Strategy<Value = View> {
    let clip_depth = prop_oneof![
        Just([1.001, -0.1001]),
        Just([0.0, 0.1]),
        Just([1.0, -0.1]),
        Just([-0.001, 0.1001]),
        Just([1.002, -0.2002]),
    ];
    (any::<bool>(), edges(), edges(), clip_depth).prop_flat_map(
        |(left_handed, horizontal, vertical, clip_depth)| {
            let projection = off_centre(left_handed, horizontal, vertical, clip_depth);
            placed(left_handed, projection)
        },
    )
}

/// Orthographic views of either handedness, anywhere and of any size, symmetric and off-centre, with near planes
/// before and behind the camera, and depths to \[0, 1\] and \[−1, 1\] that rise and fall.
pub fn orthographic_view() -> impl Strategy<Value = View> {
    let size = log_uniform(1e-3, 1e3).prop_map(|x| x as f32);
    let edges = (size.clone(), edges(), edges()).prop_map(|(size, horizontal, vertical)| {
        [horizontal, vertical].map(|edges| edges.map(|edge| edge * size))
    });
    let near = prop_oneof![1 => Just(0.0_f32), 2 => -1e3..1e3_f32];
    // NDC z at the near and the far plane.
    let ends = prop_oneof![
        Just([0.0, 1.0]),
        Just([1.0, 0.0]),
        Just([-1.0, 1.0]),
        Just([1.0, -1.0_f32])
    ];
    (any::<bool>(), edges, (near, size, ends)).prop_flat_map(
        |(faces_forward, [horizontal, vertical], (near, length, [at_near, at_far]))| {
            let per_depth = (at_far - at_near) / length;
            // Depths rise with NDC z.
            let left_handed = faces_forward == (per_depth > 0.0);
            let forward = if per_depth > 0.0 { 1.0 } else { -1.0 };
            let depths = [per_depth.abs(), at_near - forward * near * per_depth.abs()];
            placed(
                left_handed,
                orthographic(left_handed, horizontal, vertical, depths),
            )
        },
    )
}

/// The edges of a view at depth 1, in one direction.
fn edges() -> impl Strategy<Value = [f32; 2]> {
    let slope = || log_uniform(0.05, 11.4).prop_map(|x| x as f32);
    prop_oneof![
        2 => slope().prop_map(|s| [-s, s]),
        1 => (slope(), slope()).prop_map(|(a, b)| [-a, b]),
        1 => (slope(), 0.1..2.0_f32).prop_map(|(a, b)| [a, a + b]),
    ]
}

/// Views with this projection, anywhere.
fn placed(left_handed: bool, projection: Mat4) -> impl Strategy<Value = View> {
    let place = (
        unit_vector(),
        0.0..TAU,
        unit_vector(),
        log_uniform(1e-3, 1e3),
    );
    (any::<bool>(), place).prop_map(move |(mirrored, (forward, roll, way, distance))| {
        let side = forward.orthogonal();
        let right = side.turned(forward.cross(side), roll);
        let up = forward.cross(right) * if mirrored { -1.0 } else { 1.0 };
        let z = forward * if left_handed { 1.0 } else { -1.0 };
        let rotation = Mat4::from_cols(
            right.to_f32().extend(0.0),
            up.to_f32().extend(0.0),
            z.to_f32().extend(0.0),
            Vec4::W,
        );
        let mut view = rotation.transpose();
        view.w_axis = (way * distance).to_f32().extend(1.0);
        View {
            from_world: view,
            projection,
            left_handed,
        }
    })
}

/// Ellipsoids with semi-axes within a ratio of 50, as α = 0.01 makes them, anywhere.
pub fn ellipsoid() -> impl Strategy<Value = Ellipsoid> {
    let ratio = || prop_oneof![2 => log_uniform(0.02, 1.0), 1 => Just(1.0)];
    let axes = (unit_vector(), unit_vector());
    (position(), axes, log_uniform(1e-3, 1e3), ratio(), ratio()).prop_map(
        |(center, axes, longest, second, third)| {
            let semi_axes = [longest, longest * second, longest * third].map(|x| x as f32);
            ellipsoid_with(center, axes, Vec3::from_array(semi_axes))
        },
    )
}

/// The ellipsoid whose first axis is the first of `axes` and whose second is near the other.
pub fn ellipsoid_with(center: Vec3, axes: (Vector, Vector), semi_axes: Vec3) -> Ellipsoid {
    let u = axes.0;
    let w = match u.cross(axes.1) {
        cross if cross.length() > 1e-3 => cross.unit(),
        _ => u.orthogonal(),
    };
    let rotation = Mat3::from_cols(u.to_f32(), w.cross(u).to_f32(), w.to_f32());
    Ellipsoid::new(center, rotation, semi_axes).unwrap()
}
