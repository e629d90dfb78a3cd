//! The distance to a tile's image by its features: its faces, cut into triangles, and their sides.

use stochastic_light_culling::{DepthInterval, TileRectangle, glam::Mat3};

use super::Vector;

/// Corners of the faces; those of the tile are numbered by x, y and z, in bits.
const FACES: [[usize; 4]; 6] = [
    [0, 1, 3, 2],
    [4, 5, 7, 6],
    [0, 1, 5, 4],
    [2, 3, 7, 6],
    [0, 2, 6, 4],
    [1, 3, 7, 5],
];

#[derive(Clone, Copy, Debug)]
pub struct Frustum {
    matrix: [Vector; 3],
    /// From the least to the greatest x/z, y/z and z, or x, y and z.
    sides: [[f64; 2]; 3],
    corners: [Vector; 8],
    is_orthographic: bool,
}

impl Frustum {
    /// The image of a tile under `matrix`, whose third row is (0, 0, m).
    pub fn new(matrix: Mat3, tile: &TileRectangle, depths: &DepthInterval) -> Self {
        Self::of(matrix, tile, depths, false)
    }

    /// The same of a tile that is a box.
    pub fn of_box(matrix: Mat3, tile: &TileRectangle, depths: &DepthInterval) -> Self {
        Self::of(matrix, tile, depths, true)
    }

    fn of(
        matrix: Mat3,
        tile: &TileRectangle,
        depths: &DepthInterval,
        is_orthographic: bool,
    ) -> Self {
        let matrix = [matrix.x_axis, matrix.y_axis, matrix.z_axis].map(Vector::from);
        let sides = [
            [tile.min().x, tile.max().x],
            [tile.min().y, tile.max().y],
            [depths.near(), depths.far()],
        ]
        .map(|side| side.map(f64::from));
        let corner = |i: usize| {
            let [x, y, z] = std::array::from_fn(|axis| sides[axis][i >> axis & 1]);
            let [a, b, d] = matrix;
            if is_orthographic {
                a * x + b * y + d * z
            } else {
                (a * x + b * y + d) * z
            }
        };
        Self {
            matrix,
            sides,
            corners: std::array::from_fn(corner),
            is_orthographic,
        }
    }

    /// How far its farthest corner is from the origin.
    pub fn extent(&self) -> f64 {
        let lengths = self.corners.iter().map(|corner| corner.length());
        lengths.fold(0.0, f64::max)
    }

    pub fn distance(&self, point: Vector) -> f64 {
        if self.holds(point) {
            return 0.0;
        }
        let faces = FACES.map(|face| face.map(|i| self.corners[i]));
        let triangles = faces
            .into_iter()
            .flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]);
        let distances = triangles.map(|triangle| to_triangle(triangle, point));
        distances.fold(f64::MAX, f64::min)
    }

    /// Whether `point` is the image of a point of the tile.
    fn holds(&self, point: Vector) -> bool {
        let [Vector([a0, a1, _]), Vector([b0, b1, _]), d] = self.matrix;
        let z = point.0[2] / d.0[2];
        let Vector([p0, p1, _]) = point - d * z;
        let area = a0 * b1 - a1 * b0;
        let per_slope = if self.is_orthographic { 1.0 } else { z };
        let x = (p0 * b1 - p1 * b0) / area / per_slope;
        let y = (a0 * p1 - a1 * p0) / area / per_slope;
        let coordinates = [x, y, z];
        let mut sides = self.sides.iter().zip(coordinates);
        sides.all(|([min, max], x)| *min <= x && x <= *max)
    }
}

fn to_triangle([a, b, c]: [Vector; 3], point: Vector) -> f64 {
    let sides = [(a, b), (b, c), (c, a)];
    let normal = (b - a).cross(c - a);
    let is_above = |(a, b): (Vector, Vector)| normal.cross(b - a).dot(point - a) > 0.0;
    if sides.into_iter().all(is_above) {
        return (normal.dot(point - a) / normal.length()).abs();
    }
    let distances = sides.map(|(a, b)| to_segment(a, b - a, point));
    distances.into_iter().fold(f64::MAX, f64::min)
}

fn to_segment(start: Vector, way: Vector, point: Vector) -> f64 {
    let along = way.dot(point - start) / way.dot(way);
    // Of no length if that is NaN.
    (point - (start + way * along.clamp(0.0, 1.0).max(0.0))).length()
}
