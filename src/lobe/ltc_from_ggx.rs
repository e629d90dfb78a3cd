//! Makes the transformed cosine that resembles a GGX lobe, or that a caller's matrix gives, in each lane.

use core::f64::consts::FRAC_1_PI;

use super::ltc_lobes::LtcLobes;
use super::ltc_majorant::rounding_of_value;
use super::{Fresnel, Ggx, Incidence, ltc_table};
use crate::num::{Double, Real, Single, Vector3, exact_dot};

/// A surface in each lane, and the light that arrives there.
#[derive(Clone, Copy)]
pub(crate) struct GgxSurfaces<N> {
    pub normal: Vector3<N>,
    /// ω_i
    pub incoming: Vector3<N>,
    /// α
    pub roughness: N,
    /// F at normal and at grazing incidence.
    pub reflectances: [N; 2],
}

impl GgxSurfaces<f32> {
    /// The surface as a single lane.
    #[inline(always)]
    pub fn new<F: Fresnel>(ggx: Ggx, fresnel: F, incidence: Incidence) -> Self {
        Self {
            normal: incidence.normal.into(),
            incoming: incidence.incoming.into(),
            roughness: ggx.roughness(),
            reflectances: [fresnel.reflectance(1.0), fresnel.reflectance(0.0)],
        }
    }

    /// The numbers that [`of_numbers`](GgxSurfaces::of_numbers) takes.
    #[cfg(feature = "cull")]
    #[inline(always)]
    pub fn numbers(&self) -> [f32; 9] {
        let (n, w, [head_on, grazing]) = (self.normal, self.incoming, self.reflectances);
        [
            n.x,
            n.y,
            n.z,
            w.x,
            w.y,
            w.z,
            self.roughness,
            head_on,
            grazing,
        ]
    }
}

/// The least share of a cosine above the horizon. Callers' lobes may lie almost wholly below it.
const LEAST_SHARE: f64 = 1e-6;

impl<N: Single> GgxSurfaces<N> {
    #[cfg(feature = "cull")]
    #[inline(always)]
    pub fn of_numbers([n_x, n_y, n_z, w_x, w_y, w_z, roughness, head_on, grazing]: [N; 9]) -> Self {
        Self {
            normal: Vector3::new(n_x, n_y, n_z),
            incoming: Vector3::new(w_x, w_y, w_z),
            roughness,
            reflectances: [head_on, grazing],
        }
    }

    /// The lobes, and the share ρ of the light that each reflects.
    #[inline(always)]
    pub fn lobes(&self) -> (LtcLobes<N>, N) {
        let plane = IncidencePlane::of(self.normal, self.incoming);
        let is_lit = plane.cosine.is_positive();
        if N::is_known_false(is_lit) {
            return (LtcLobes::empty(self.normal), self.roughness.zero());
        }
        // What the table is looked up by needs single precision alone.
        let (alpha, mu, sine) = (
            self.roughness,
            N::narrow(plane.cosine),
            N::narrow(plane.sine),
        );
        let over_root = (mu + 1.0).sqrt().recip();
        let incidence = sine * over_root;
        let (resolved, most_incidence) = resolved(alpha);
        // tan(θ/2) and tan(δ/2), tanδ = α tanθ.
        let slope = alpha * sine;
        let half_delta = slope / (mu + (mu * mu + slope * slope).sqrt());
        let tangents = (incidence * over_root + half_delta) * 0.5;
        let [[a, b, d, e], [n_a, f_a, ..]] = N::per_lane_quads(
            [resolved.sqrt(), incidence.min(most_incidence), tangents, mu],
            is_lit,
            #[inline(always)]
            |[root, incidence, tangents, _], _| {
                let [n_a, f_a] = ltc_table::albedos(root.into(), tangents.into());
                [
                    ltc_table::matrix(root.into(), incidence.into()).map(|x| x as f32),
                    [n_a as f32, f_a as f32, 0.0, 0.0],
                ]
            },
        );
        let [head_on, grazing] = self.reflectances;
        let reflected = head_on * n_a + (grazing - head_on) * f_a;
        // A caller's factor may be NaN.
        let reflected = Real::max(reflected, alpha.zero()).min(alpha.splat(1.0));
        let matrix = Matrix::of([a, resolved * b, resolved * d, resolved * e]);
        // Above ω_u in the plane of incidence n has these coordinates.
        let share = matrix.twice_share_above([-plane.sine, plane.cosine]) * 0.5;
        let lobes = matrix.lobes(
            self.normal,
            [plane.mirror.cross(plane.across), plane.mirror],
            reflected.widen() / share,
        );
        let none = LtcLobes::empty(self.normal);
        let [reflected] = N::select_all(is_lit, [reflected], [alpha.zero()]);
        (LtcLobes::select(is_lit, lobes, none), reflected)
    }
}

/// The roughness and the greatest √(1 − μ) by which the matrix is looked up.
///
/// Across the plane of incidence a lobe is 2αμ wide. Where that is too narrow for directions in single precision, the
/// matrix is that of a greater μ. So rounding moves no image of a direction by more than 1/50 of its length.
#[inline(always)]
fn resolved<N: Single>(alpha: N) -> (N, N) {
    let alpha = Real::max(alpha, alpha.splat(ltc_table::LEAST_ROUGHNESS));
    let least_cosine = alpha.splat(ltc_table::LEAST_WIDTH) / alpha;
    (alpha, least_cosine.one_minus().sqrt())
}

/// The elements m₁₁, m₁₃, m₃₁ and m₃₃ of M⁻¹ in each lane. The middle element is 1, and the others are zero.
#[derive(Clone, Copy)]
pub(super) struct Matrix<D> {
    elements: [D; 4],
    /// m₁₁m₃₃ − m₁₃m₃₁
    pub determinant: D,
}

impl<D: Double> Matrix<D> {
    #[inline(always)]
    pub fn of<N: Single<Double = D>>([m11, m13, m31, m33]: [N; 4]) -> Self {
        let (m11, m13, m31, m33) = (m11.widen(), m13.widen(), m31.widen(), m33.widen());
        Self {
            elements: [m11, m13, m31, m33],
            determinant: m11 * m33 - m13 * m31,
        }
    }

    /// The most by which rounding moves the image of a direction in the value, over a lower bound of the length of that
    /// image, for a positive determinant.
    pub fn rounding(&self) -> D {
        let squares = self.squared_lengths();
        let [first, _, third] = squares;
        let one = first.splat(1.0);
        // Of the greatest singular value the root is an upper bound.
        let least = (one / (first + third).sqrt()).min(one);
        rounding_of_value(squares) * self.determinant / least
    }

    /// The squared lengths of the rows as they are stored, times 1/(m₁₁m₃₃ − m₁₃m₃₁).
    #[inline(always)]
    fn squared_lengths(&self) -> [D; 3] {
        let [m11, m13, m31, m33] = self.elements;
        let second = m11.splat(1.0) / (self.determinant * self.determinant);
        [
            (m11 * m11 + m13 * m13) * second,
            second,
            (m31 * m31 + m33 * m33) * second,
        ]
    }

    /// The product of the lengths of both rows.
    pub fn lengths(&self) -> D {
        let [m11, m13, m31, m33] = self.elements;
        ((m11 * m11 + m13 * m13) * (m31 * m31 + m33 * m33)).sqrt()
    }

    /// Twice the share of a transformed cosine above the horizon, for the coordinates of n.
    ///
    /// M⁻¹ maps the upper hemisphere to {ω : (Mᵀn)·ω > 0}, and the cosine of a lune integrates to π(1 + c)/2,
    /// where c is the third component of the unit vector along Mᵀn. Both components below are those of Mᵀn times
    /// the determinant. They do not vanish together.
    #[inline(always)]
    pub fn twice_share_above(&self, [x, z]: [D; 2]) -> D {
        let [m11, m13, m31, m33] = self.elements;
        let (first, third) = (x * m33 - z * m31, z * m11 - x * m13);
        let length = (first * first + third * third).sqrt();
        (third / length + 1.0).max(length.splat(2.0 * LEAST_SHARE))
    }

    /// The lobes whose integrals over the whole sphere are `magnitude`, in the frame of two unit vectors in the plane
    /// of incidence.
    ///
    /// M⁻¹ is multiplied by a factor, which changes the lobe by its third power alone, so that the second row becomes
    /// the cross product of the others: 1/(m₁₁m₃₃ − m₁₃m₃₁).
    #[inline(always)]
    pub fn lobes<N: Single<Double = D>>(
        &self,
        normal: Vector3<N>,
        [x, z]: [Vector3<D>; 2],
        magnitude: D,
    ) -> LtcLobes<N> {
        let [m11, m13, m31, m33] = self.elements;
        let factor = m11.splat(1.0) / self.determinant;
        // The first row has the component m₁₁m₃₃ − m₁₃m₃₁ across the third, over the length of that.
        let over = m11.splat(1.0) / (m31 * m31 + m33 * m33);
        let across = x * (over * m33) - z * (over * m31);
        let third = x * (factor * m31) + z * (factor * m33);
        let lobes = LtcLobes {
            normal,
            amplitude: N::narrow(magnitude * FRAC_1_PI * factor * factor),
            across: Vector3::narrow(across),
            third: Vector3::narrow(third),
            shear: N::narrow((m11 * m31 + m13 * m33) * over),
        };
        lobes.with_image_error(self.squared_lengths())
    }
}

/// The plane of incidence in each lane.
pub(super) struct IncidencePlane<D> {
    /// n
    pub normal: Vector3<D>,
    /// ω_u
    pub mirror: Vector3<D>,
    /// ω_u × n, of unit length
    pub across: Vector3<D>,
    /// μ
    pub cosine: D,
    /// √(1 − μ²)
    pub sine: D,
}

impl<D: Double> IncidencePlane<D> {
    #[inline(always)]
    pub fn of<N: Single<Double = D>>(normal: Vector3<N>, incoming: Vector3<N>) -> Self {
        let (n, w) = (normal.widen(), incoming.widen());
        let over = (over_length(n), over_length(w));
        let (n, w) = (n * over.0, w * over.1);
        let cross = n.cross(w);
        let sine = cross.length();
        let is_oblique = sine.is_positive();
        let across = cross * (sine.splat(1.0) / sine);
        let across = if D::is_known_false(!is_oblique) {
            across
        } else {
            // At normal incidence the plane is arbitrary.
            let (any, _) = normal.any_orthonormal_pair();
            let perpendicular = n.cross(any.widen());
            let length = perpendicular.length();
            Vector3::select(
                is_oblique,
                across,
                perpendicular * (sine.splat(1.0) / length),
            )
        };
        Self {
            normal: n,
            mirror: n * (n.dot(w) * 2.0) - w,
            across,
            cosine: exact_dot(normal, incoming) * (over.0 * over.1),
            sine,
        }
    }
}

/// 1/‖v‖ for a direction, whose length differs from 1 by 2.4·10⁻⁷ at most: a step of Newton's method leaves 10⁻¹³.
#[inline(always)]
fn over_length<D: Double>(v: Vector3<D>) -> D {
    -(v.length_squared() * 0.5) + 1.5
}
