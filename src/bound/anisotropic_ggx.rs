//! The bound of an anisotropic GGX lobe: an ellipsoid whose axes follow the lobe.
//!
//! # The surface
//!
//! Let P = diag(α_x, α_y, 1) in the frame (tangent, bitangent, n). With F·G2 at its joint maximum the
//! isosurface is l = r′/(ω_hᵀP⁻²ω_h), r′² = (F·G2/G1)_max G1(ω_i)/(4πμ α_xα_y), or
//!
//! x(m) = r′ (2(ω_i·Pm) Pm − ω_i ‖Pm‖²) for all unit vectors m,
//!
//! as for a single roughness (see `triaxial`). Only the set of half vectors Pm matters, so P can be replaced
//! by any K with K Kᵀ = P². Let ω_t be the direction of the tangential part of ω_i, and ω_w = n × ω_t the
//! normal of the plane of incidence. The triangular K is Km = τm₁ω_t + (σm₁ + νm₂)ω_w + m₃n, where
//!
//! τ² = ω_tᵀP²ω_t, ν = α_xα_y/τ, σ = ω_tᵀP²ω_w/τ.
//!
//! With it no component below is a difference of larger numbers. Collected by the products of components of
//! m, with s = sin θ_i and ω_v = ω_w × ω_u, and in units of r′,
//!
//! x(m) = m₃²ω_u + m₁²x₁ + m₂²x₂ + 2m₁m₃c₁ + 2m₂m₃c₂ + 2m₁m₂c₃,
//!
//! x₁ = −τ²ω_u + 2τσs ω_w − σ²ω_i, x₂ = −ν²ω_i,
//! c₁ = τω_v + μσω_w, c₂ = μνω_w, c₃ = τνs ω_w − νσω_i.
//!
//! # The ellipsoids that enclose it
//!
//! With x̄ = ½(x₁ + x₂), y = m₁² + m₂² and m₃² = 1 − y, for any e > 0,
//!
//! x(m) = ½(ω_u + x̄) − e a + (1 − 2y + e) a + 2m₁m₃c₁ + 2m₂m₃c₂ + (m₁² − m₂²) b + 2m₁m₂c₃,
//!
//! a = ½(ω_u − x̄), b = ½(x₁ − x₂). This is a constant, and a sum of five vectors whose factors satisfy
//!
//! (1 − 2y + e)²/(1+e)² + 4y(1−y)/(1+e) + 4e y²/(1+e)² = 1,
//!
//! for every y. So all points x(m) − (½(ω_u + x̄) − e a) lie in the image of the five-dimensional unit ball
//! under the matrix with the columns
//!
//! (1+e) a, √(1+e) c₁, √(1+e) c₂, (1+e)/(2√e) b, (1+e)/(2√e) c₃,
//!
//! **an enclosing ellipsoid for every e**. b and c₃ are small, of the order of the squared roughness. e makes
//! room for them ahead of the light, where they vanish. Let A be the squared volume of (a, c₁, c₂), and p a
//! quarter of the sum of those with b or c₃ in the place of one of the three. To first order in e, the
//! squared volume of the ellipsoid is (1 + 4e)(A + p/e), which is smallest for 4Ae² + 4pe = p. With this e
//! the volume is within 15 % of the smallest, and mostly within 0.1 %.
//!
//! # Nearly isotropic surfaces
//!
//! The lobe lies within the isotropic one with the larger roughness and the same r′, since ω_hᵀP⁻²ω_h falls
//! as α_x and α_y grow. So the triaxial bound of that isotropic lobe encloses it too. The smaller of both
//! ellipsoids is used; for α_x = α_y it is always the isotropic one.

use super::ellipsoid::Ellipsoids;
use super::principal_axes::{POINT_ROUNDINGS, ellipsoids_along, principal_axes};
use super::shape::{Quads, padded};
use super::triaxial::{ellipsoids_around, ndf_radius_squared};
use super::{BoundStrategy, Bounded, Ellipsoid, Triaxial};
use crate::lobe::{AnisotropicGgxLobe, Fresnel, GgxLobes, MaskingShadowing, SurfaceAxes};
use crate::num::{Double, Real, Single, Vector3, exact_dot};

/// Pays for the rounding of r′ and of its product with a semi-axis.
const SEMI_AXIS_ROUNDINGS: u16 = 24;

/// Bounds the lobe by an ellipsoid that is about as narrow along each of its axes as the lobe is. F and G2
/// are at their joint maximum ([`max_reflected`](AnisotropicGgxLobe::max_reflected)).
///
/// But for rounding, it is never larger than the paper's [`Spheroid`](crate::Spheroid) around this lobe for
/// the larger of α_x and α_y. For α_x = α_y it is the triaxial bound of a [`GgxLobe`](crate::GgxLobe).
impl<F: Fresnel, G: MaskingShadowing> BoundStrategy<AnisotropicGgxLobe<F, G>> for Triaxial {
    type Shape = Ellipsoid;

    type PerLight = F;

    const QUADS: usize = 4;

    #[inline(always)]
    fn to_quads(&self, lobe: &AnisotropicGgxLobe<F, G>) -> (Quads<f32>, F) {
        let isotropic = lobe.at_any_azimuth();
        let ([along, across], tangent) = (lobe.ggx().roughness(), lobe.tangent());
        let [normal, incoming, smoother] = isotropic.quads();
        let tangent_and_smoother = [tangent.x, tangent.y, tangent.z, smoother[0]];
        let quads = [
            normal,
            incoming,
            tangent_and_smoother,
            [along, across, 0.0, 0.0],
        ];
        (padded(quads), *lobe.fresnel())
    }

    #[inline(always)]
    fn unit_bounds<N: Single>(&self, quads: &Quads<N>, fresnels: &[F]) -> Ellipsoids<N> {
        let [x, y, z, smoother] = quads[2];
        let [along, across, ..] = quads[3];
        let tangent = Vector3::new(x, y, z);
        let isotropic = GgxLobes::from_quads([quads[0], quads[1], [smoother; 4]]);
        let is_isotropic = along.eq(across);
        let radius_squared = ndf_radius_squared::<N, F, G>(&isotropic, fresnels);
        if N::is_known_false(!is_isotropic) {
            return ellipsoids_around(&isotropic, smoother, radius_squared.sqrt());
        }
        let scale = (radius_squared / (along * across)).sqrt();
        let rougher = along.max(across);
        let radius = N::select(is_isotropic, radius_squared.sqrt(), scale * rougher);
        let around_rougher = ellipsoids_around(&isotropic, rougher, radius);

        let following = Incidence::new(&isotropic, tangent, [along, across]).ellipsoids(scale);
        let is_smaller = volume(&following).le(volume(&around_rougher));
        Ellipsoids::select(is_smaller & !is_isotropic, following, around_rougher)
    }
}

impl<F: Fresnel, G: MaskingShadowing> Bounded for AnisotropicGgxLobe<F, G> {
    type Shape = Ellipsoid;
    type Strategy = Triaxial;

    fn unit_bound(&self) -> Ellipsoid {
        self.unit_bound_by(Triaxial)
    }
}

#[inline(always)]
fn volume<N: Single>(ellipsoids: &Ellipsoids<N>) -> N::Double {
    let Vector3 { x, y, z } = ellipsoids.semi_axes.widen();
    x * y * z
}

/// The plane of incidence and the roughness along it, in each lane.
struct Incidence<D> {
    /// ω_u, ω_v, ω_w.
    frame: [Vector3<D>; 3],
    /// μ.
    cosine: D,
    /// sin θ_i.
    sine: D,
    /// τ, σ, ν.
    roughness: [D; 3],
}

impl<D: Double> Incidence<D> {
    #[inline(always)]
    fn new<N: Single<Double = D>>(
        lobe: &GgxLobes<N>,
        tangent: Vector3<N>,
        [along, across]: [N; 2],
    ) -> Self {
        let [tangent, bitangent, normal] = SurfaceAxes::new(lobe.normal, tangent).axes;
        let (n, incoming) = (lobe.normal.widen(), lobe.incoming.widen());
        let lengths = n.length() * incoming.length();
        // From the f32 vectors, whose products are exact: that of the unit vectors could be mostly rounding.
        let cosine = exact_dot(lobe.normal, lobe.incoming) / lengths;
        let product = n.cross(incoming);
        let length = product.length();
        // At normal incidence the plane is arbitrary.
        let is_oblique = length.is_positive();
        let across_plane = Vector3::select(is_oblique, product / length, bitangent);
        let (along_plane, sine) = (across_plane.cross(normal), length / lengths);

        let (alpha_x, alpha_y) = (along.widen(), across.widen());
        let (x, y) = (tangent.dot(along_plane), bitangent.dot(along_plane));
        let in_plane = Vector3::new(alpha_x * x, alpha_y * y, x.zero()).length();
        let difference = (alpha_y - alpha_x) * (alpha_y + alpha_x);
        Self {
            frame: [
                Vector3::combine([(cosine, normal), (-sine, along_plane)]),
                Vector3::combine([(sine, normal), (cosine, along_plane)]),
                across_plane,
            ],
            cosine,
            sine,
            roughness: [
                in_plane,
                difference * x * y / in_plane,
                alpha_x * alpha_y / in_plane,
            ],
        }
    }

    /// The ellipsoids of the module documentation, for r′ = `scale`.
    #[inline(always)]
    fn ellipsoids<N: Single<Double = D>>(&self, scale: N) -> Ellipsoids<N> {
        let (center, columns) = self.image_of_ball();
        let [a, b, c, d, e] = columns;
        let principal = principal_axes([
            [a.x, b.x, c.x, d.x, e.x],
            [a.y, b.y, c.y, d.y, e.y],
            [a.z, b.z, c.z, d.z, e.z],
        ]);
        let roundings = (POINT_ROUNDINGS, SEMI_AXIS_ROUNDINGS);
        ellipsoids_along(&self.frame, center, principal, scale, roundings)
    }

    /// The centre and the five columns of the module documentation, in the frame (ω_u, ω_v, ω_w).
    #[inline(always)]
    fn image_of_ball(&self) -> (Vector3<D>, [Vector3<D>; 5]) {
        let (mu, s) = (self.cosine, self.sine);
        let [tau, sigma, nu] = self.roughness;
        let (zero, one) = (mu.zero(), mu.splat(1.0));
        let ahead = Vector3::new(one, zero, zero);
        let across = Vector3::new(zero, zero, one);
        let incoming = Vector3::new((mu - s) * (mu + s), s * 2.0 * mu, zero);
        let (half, minus_half) = (mu.splat(0.5), mu.splat(-0.5));

        let x_1 = Vector3::combine([
            (-tau * tau, ahead),
            (tau * 2.0 * sigma * s, across),
            (-sigma * sigma, incoming),
        ]);
        let x_2 = incoming * (-nu * nu);
        let mean = Vector3::combine([(half, x_1), (half, x_2)]);
        let long = Vector3::combine([(half, ahead), (minus_half, mean)]);
        let sides = [
            Vector3::new(zero, tau, mu * sigma),
            Vector3::new(zero, zero, mu * nu),
        ];
        let bends = [
            Vector3::combine([(half, x_1), (minus_half, x_2)]),
            Vector3::combine([(tau * nu * s, across), (-nu * sigma, incoming)]),
        ];

        let e = enlargement(long, sides, bends);
        let center = Vector3::combine([(half, ahead), (half, mean), (-e, long)]);
        let side = (e + 1.0).sqrt();
        let bend = (e + 1.0) / (e.sqrt() * 2.0);
        let column = |factor: D, vector: Vector3<D>| Vector3::combine([(factor, vector)]);
        let columns = [
            column(e + 1.0, long),
            column(side, sides[0]),
            column(side, sides[1]),
            column(bend, bends[0]),
            column(bend, bends[1]),
        ];
        (center, columns)
    }
}

/// The positive e of nearly the smallest volume.
#[inline(always)]
fn enlargement<D: Double>(
    long: Vector3<D>,
    [first, second]: [Vector3<D>; 2],
    bends: [Vector3<D>; 2],
) -> D {
    let faces = [first.cross(second), second.cross(long), long.cross(first)];
    let squared = |a: Vector3<D>, b: Vector3<D>| {
        let product = a.dot(b);
        product * product
    };
    let of_faces =
        |a: Vector3<D>| squared(a, faces[0]) + squared(a, faces[1]) + squared(a, faces[2]);
    let whole = squared(long, faces[0]);
    let p = (of_faces(bends[0]) + of_faces(bends[1])) * 0.25;
    let e = p / ((p + (p * (p + whole)).sqrt()) * 2.0);
    // If b and c₃ vanish, any e is valid, but 0/0 is not.
    e.max(e.splat(1e-100))
}
