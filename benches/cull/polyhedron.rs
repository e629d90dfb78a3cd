//! The exact test as one would do it with parry3d: a ball against a convex polyhedron.

use parry3d::math::{Pose, Vector};
use parry3d::query;
use parry3d::shape::{Ball, ConvexPolyhedron};
use stochastic_light_culling::{DepthInterval, ProjectedEllipsoid, TileRectangle};

/// The faces, cut into triangles; corners are numbered by x, y and z, in bits.
const TRIANGLES: [[u32; 3]; 12] = [
    [0, 2, 3],
    [0, 3, 1],
    [4, 5, 7],
    [4, 7, 6],
    [0, 1, 5],
    [0, 5, 4],
    [2, 6, 7],
    [2, 7, 3],
    [0, 4, 6],
    [0, 6, 2],
    [1, 3, 7],
    [1, 7, 5],
];

/// The tile's image.
pub fn of_tile(
    light: &ProjectedEllipsoid,
    rectangle: &TileRectangle,
    depths: &DepthInterval,
) -> ConvexPolyhedron {
    let m = light.matrix();
    let (min, max) = (rectangle.min(), rectangle.max());
    let corner = |i: usize| {
        let (x, y) = ([min.x, max.x][i & 1], [min.y, max.y][i >> 1 & 1]);
        let z = [depths.near(), depths.far()][i >> 2];
        let point = (m.x_axis * x + m.y_axis * y + m.z_axis) * z;
        Vector::new(point.x, point.y, point.z)
    };
    let corners = (0..8).map(corner).collect();
    ConvexPolyhedron::from_convex_mesh(corners, &TRIANGLES).expect("tiles here have a volume")
}

pub fn meets_ball(polyhedron: &ConvexPolyhedron, light: &ProjectedEllipsoid) -> bool {
    let c = light.center();
    let place = Pose::translation(c.x, c.y, c.z);
    query::intersection_test(&place, &Ball::new(1.0), &Pose::identity(), polyhedron)
        .expect("parry3d has this pair of shapes")
}
