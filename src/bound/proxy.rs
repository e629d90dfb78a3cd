//! Polyhedra around an ellipsoid, for rasterisers.
//!
//! The map from the unit ball to the ellipsoid takes a polyhedron around the ball to one around the
//! ellipsoid, and faces that touch the ball to faces that touch the ellipsoid. There are two polyhedra. One
//! is the regular icosahedron whose faces touch the ball. The other divides each of its faces at the
//! midpoints of the edges. The middle quarter of a face touches the ball already. The twelve original
//! vertices are moved inward until the other three quarters touch it too.

use glam::Vec3;

use super::Ellipsoid;
use crate::num::{UNIT_ROUNDOFF, Vector3, sqrt_f64};

type Vector = [f64; 3];

/// Pays for rounding a vertex to `f32`, in units of u times the farthest component.
const VERTEX_ROUNDINGS: f64 = 2.0;

/// A closed triangle mesh around an [`Ellipsoid`], with which lights are splatted
/// [Dachsbacher & Stamminger 2006]. Each triangle touches the ellipsoid.
///
/// No polyhedron around a ball with as many faces has less than 0.973 (20 faces) or 0.990 (80 faces) of the
/// volume of these [Fejes Tóth 1964, *Regular Figures*].
///
/// ```
/// use stochastic_light_culling::{Bounded, Direction, LambertLobe, Proxy, Tight, glam::Vec3};
///
/// let light = LambertLobe::new(0.8, Direction::Y)?.unit_bound_by(Tight);
/// let positions: Vec<Vec3> = Proxy::Icosphere.vertices(&light).collect();
/// let indices: &[u16] = Proxy::Icosphere.triangles().as_flattened();
/// assert_eq!((positions.len(), indices.len()), (42, 3 * 80));
/// // With fewer vertices, where they cost more than pixels.
/// assert_eq!(Proxy::Icosahedron.vertices(&light).len(), 12);
/// # Ok::<(), stochastic_light_culling::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Proxy {
    /// 20 triangles with 12 vertices: 1.207 times the ellipsoid's volume.
    Icosahedron,
    /// 80 triangles with 42 vertices: 1.049 times the ellipsoid's volume.
    Icosphere,
}

impl Proxy {
    /// The three vertices of each triangle, as indices into [`vertices`](Self::vertices). They are in
    /// counter-clockwise order as seen from outside, in a right-handed space.
    #[must_use]
    pub fn triangles(self) -> &'static [[u16; 3]] {
        match self {
            Self::Icosahedron => &FACES,
            Self::Icosphere => &SUBDIVIDED.triangles,
        }
    }

    /// The vertices of the mesh around `ellipsoid`, rounded outward: 12 or 42 points in the space and unit of
    /// the ellipsoid.
    ///
    /// Far from the origin the mesh is larger by the spacing of `f32` numbers there. All vertices are at the
    /// centre if the ellipsoid is empty. Components that overflow are clamped to the largest `f32` numbers.
    /// Never NaN.
    #[must_use]
    pub fn vertices(
        self,
        ellipsoid: &Ellipsoid,
    ) -> impl ExactSizeIterator<Item = Vec3> + Clone + use<> {
        let vertices: &[Vector] = match self {
            Self::Icosahedron => &VERTICES,
            Self::Icosphere => &SUBDIVIDED.vertices,
        };
        let frame = Frame::around(ellipsoid);
        vertices.iter().map(move |vertex| frame.to_world(*vertex))
    }
}

/// The affine map from the unit ball to an ellipsoid.
#[derive(Clone, Copy)]
struct Frame {
    center: Vector3<f64>,
    columns: [Vector3<f64>; 3],
}

impl Frame {
    /// The frame of an ellipsoid that contains the sum of `ellipsoid` and a ball that pays for rounding.
    ///
    /// Rounding moves a vertex by at most d = √3u of its largest component, and no point of a triangle by
    /// more. For any t > 0, the ellipsoid with the squared semi-axes (1+t)aᵢ² + (1+1/t)d² contains the sum.
    fn around(ellipsoid: &Ellipsoid) -> Self {
        let wide = |v: Vec3| Vector3::from(v).widen();
        let [light, offset] = ellipsoid.center_parts().map(wide);
        let most = f64::from(f32::MAX);
        let Vector3 { x, y, z } = light + offset;
        let center = [x, y, z].map(|x| x.clamp(-most, most));
        let rotation = ellipsoid.rotation();
        let axes = [rotation.x_axis, rotation.y_axis, rotation.z_axis].map(wide);
        let semi_axes = ellipsoid.semi_axes().min(Vec3::MAX);
        let semi_axes = semi_axes.to_array().map(f64::from);

        let [shortest, longest] =
            [f64::min, f64::max].map(|pick| semi_axes.into_iter().reduce(pick).unwrap_or_default());
        let [x, y, z] = center.map(f64::abs);
        let farthest = x.max(y).max(z) + 2.0 * longest;
        let subnormal = f64::from(f32::from_bits(2));
        let moved = VERTEX_ROUNDINGS * f64::from(UNIT_ROUNDOFF) * farthest + subnormal;
        let share = (moved / shortest).min(1.0);
        // A mirrored frame would turn the triangles inside out. An ellipsoid is symmetric, so an axis may be
        // negated.
        let side = axes[0].cross(axes[1]).dot(axes[2]).signum();
        let columns = [(side, 0), (1.0, 1), (1.0, 2)].map(|(side, i)| {
            let a = semi_axes[i];
            let enlarged = (1.0 + share) * a * a + (1.0 + 1.0 / share) * moved * moved;
            let length = if shortest > 0.0 {
                sqrt_f64(enlarged)
            } else {
                0.0
            };
            axes[i] * (side * length)
        });
        Self {
            center: center.into(),
            columns,
        }
    }

    fn to_world(self, [x, y, z]: Vector) -> Vec3 {
        let [a, b, c] = self.columns;
        let Vector3 { x, y, z } = self.center + a * x + b * y + c * z;
        Vec3::from_array([x, y, z].map(|x| (x as f32).clamp(f32::MIN, f32::MAX)))
    }
}

/// The vertices of the icosahedron around the unit ball are the cyclic permutations of (0, ±A, ±φA), with the
/// golden ratio φ. A = √3/φ², rounded up.
const A: f64 = 0.661_584_538_249_608;
/// φA, rounded up.
const B: f64 = 1.070_466_269_319_271;

const VERTICES: [Vector; 12] = [
    [0.0, -A, -B],
    [-A, -B, 0.0],
    [-B, 0.0, -A],
    [0.0, -A, B],
    [-A, B, 0.0],
    [B, 0.0, -A],
    [0.0, A, -B],
    [A, -B, 0.0],
    [-B, 0.0, A],
    [0.0, A, B],
    [A, B, 0.0],
    [B, 0.0, A],
];

const FACES: [[u16; 3]; 20] = [
    [0, 1, 2],
    [0, 7, 1],
    [0, 2, 6],
    [0, 6, 5],
    [0, 5, 7],
    [1, 8, 2],
    [1, 7, 3],
    [1, 3, 8],
    [2, 4, 6],
    [2, 8, 4],
    [3, 7, 11],
    [3, 9, 8],
    [3, 11, 9],
    [4, 10, 6],
    [4, 8, 9],
    [4, 9, 10],
    [5, 6, 10],
    [5, 11, 7],
    [5, 10, 11],
    [9, 11, 10],
];

struct Subdivided {
    vertices: [Vector; 42],
    triangles: [[u16; 3]; 80],
}

static SUBDIVIDED: Subdivided = subdivided();

const fn subdivided() -> Subdivided {
    /// The factor that moves the vertices of the icosahedron inward so that the outer triangles touch the
    /// unit ball, rounded up.
    const DRAWN_IN: f64 = 0.825_664_548_662_088;
    let mut vertices = [[0.0; 3]; 42];
    let mut triangles = [[0; 3]; 80];
    let mut i = 0;
    while i < 12 {
        let [x, y, z] = VERTICES[i];
        vertices[i] = [DRAWN_IN * x, DRAWN_IN * y, DRAWN_IN * z];
        i += 1;
    }
    // The vertex at the midpoint of each edge, by its two ends in either order.
    let mut middles = [[0_u16; 12]; 12];
    let mut next = 12;
    let mut face = 0;
    while face < 20 {
        let corners = FACES[face];
        let mut between = [0_u16; 3];
        let mut side = 0;
        while side < 3 {
            let (start, end) = (corners[side] as usize, corners[(side + 1) % 3] as usize);
            if middles[start][end] == 0 {
                let ([a, b, c], [x, y, z]) = (VERTICES[start], VERTICES[end]);
                vertices[next as usize] = [0.5 * (a + x), 0.5 * (b + y), 0.5 * (c + z)];
                middles[start][end] = next;
                middles[end][start] = next;
                next += 1;
            }
            between[side] = middles[start][end];
            side += 1;
        }
        let ([a, b, c], [ab, bc, ca]) = (corners, between);
        triangles[4 * face] = [a, ab, ca];
        triangles[4 * face + 1] = [b, bc, ab];
        triangles[4 * face + 2] = [c, ca, bc];
        triangles[4 * face + 3] = [ab, bc, ca];
        face += 1;
    }
    Subdivided {
        vertices,
        triangles,
    }
}
