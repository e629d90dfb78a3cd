//! A closed triangle mesh around a light's range, drawn as the eye sees it.

use stochastic_light_culling::{Camera, Ellipsoid, Proxy, glam::Vec3};

/// From where to where, the first being the lesser.
pub type Span = [f32; 2];

const EMPTY: Span = [f32::INFINITY, f32::NEG_INFINITY];
const ALL: Span = [f32::NEG_INFINITY, f32::INFINITY];

/// What polyhedra are drawn into: a grid of cells, each a rectangle of slopes, or a point.
pub struct Raster {
    /// The slopes across of each column, and down of each row.
    pub columns: Vec<Span>,
    pub rows: Vec<Span>,
    /// The depths at which the polyhedron's surface is met in each cell, row by row.
    depths: Vec<Span>,
}

/// A convex polyhedron in camera space, z being depth.
///
/// A ray through the slopes (x, y) runs along d = (x, y, 1). It meets a triangle in front of the eye where
/// d is on the inner side of the three planes through the eye and an edge, at the depth at which it
/// meets the triangle's own plane [Olano & Greer 1997]: no clipping, wherever the vertices are.
pub struct Polyhedron {
    triangles: Vec<Triangle>,
    holds_eye: bool,
}

struct Triangle {
    /// Normals of the planes through the eye, inward.
    edges: [Vec3; 3],
    /// The depth at d is 1/(n·d).
    normal: Vec3,
    depths: Span,
    /// The slopes across and down that it lies within.
    slopes: [Span; 2],
}

impl Polyhedron {
    /// The `proxy` of `ellipsoid`; none around an empty one.
    pub fn around(ellipsoid: &Ellipsoid, proxy: Proxy, camera: &Camera) -> Option<Self> {
        if ellipsoid.semi_axes().min_element() <= 0.0 {
            return None;
        }
        let vertices: Vec<Vec3> = proxy
            .vertices(ellipsoid)
            .map(|vertex| camera.to_camera_space(vertex))
            .collect();
        let corners = |triangle: &[u16; 3]| triangle.map(|i| vertices[usize::from(i)]);
        let volume = |[a, b, c]: [Vec3; 3]| a.dot(b.cross(c));
        let triangles = proxy.triangles();
        let behind = triangles
            .iter()
            .filter(|triangle| volume(corners(triangle)) < 0.0)
            .count();
        Some(Self {
            // All faces turn the same side to an eye within.
            holds_eye: behind == 0 || behind == triangles.len(),
            triangles: triangles
                .iter()
                .map(|triangle| Triangle::new(corners(triangle)))
                .collect(),
        })
    }
}

impl Raster {
    pub fn new(columns: Vec<Span>, rows: Vec<Span>) -> Self {
        let depths = vec![EMPTY; columns.len() * rows.len()];
        Self {
            columns,
            rows,
            depths,
        }
    }

    /// Calls `visit` with the column and the row of each cell that `polyhedron` is seen in, and with
    /// depths that hold all those at which rays through the cell are inside.
    pub fn draw(&mut self, polyhedron: &Polyhedron, mut visit: impl FnMut(usize, usize, Span)) {
        let width = self.columns.len();
        let (mut all_columns, mut all_rows) = ([width, 0], [self.rows.len(), 0]);
        for triangle in &polyhedron.triangles {
            let columns = cells(&self.columns, triangle.slopes[0]);
            let rows = cells(&self.rows, triangle.slopes[1]);
            if triangle.depths[1] <= 0.0 || columns[0] >= columns[1] || rows[0] >= rows[1] {
                continue;
            }
            for y in rows[0]..rows[1] {
                for x in columns[0]..columns[1] {
                    if let Some(depths) = triangle.within([self.columns[x], self.rows[y]]) {
                        let cell = &mut self.depths[y * width + x];
                        *cell = hull(*cell, depths);
                    }
                }
            }
            let both = |[a, b]: [usize; 2], [c, d]: [usize; 2]| [a.min(c), b.max(d)];
            (all_columns, all_rows) = (both(all_columns, columns), both(all_rows, rows));
        }
        for y in all_rows[0]..all_rows[1] {
            for x in all_columns[0]..all_columns[1] {
                let [near, far] = std::mem::replace(&mut self.depths[y * width + x], EMPTY);
                if near <= far {
                    visit(x, y, [if polyhedron.holds_eye { 0.0 } else { near }, far]);
                }
            }
        }
    }
}

/// The first and the last but one of `cells`, which run up or down, that meet `span`.
fn cells(cells: &[Span], span: Span) -> [usize; 2] {
    let meets = |cell: &Span| cell[0] <= span[1] && span[0] <= cell[1];
    let Some(&[first, _]) = cells.first() else {
        return [0, 0];
    };
    let rises = cells.last().is_some_and(|last| last[0] >= first);
    let is_before = |cell: &Span| {
        if rises {
            cell[1] < span[0]
        } else {
            cell[0] > span[1]
        }
    };
    let start = cells.partition_point(is_before);
    let end = start + cells[start..].partition_point(meets);
    [start, end]
}

fn hull([a, b]: Span, [c, d]: Span) -> Span {
    [a.min(c), b.max(d)]
}

impl Triangle {
    fn new([a, b, c]: [Vec3; 3]) -> Self {
        let volume = a.dot(b.cross(c));
        let edges = [b.cross(c), c.cross(a), a.cross(b)].map(|edge| edge * volume.signum());
        let span = |numbers: [f32; 3]| {
            numbers
                .into_iter()
                .fold(EMPTY, |span, x| hull(span, [x; 2]))
        };
        let depths = span([a.z, b.z, c.z]);
        let slopes = [0, 1].map(|axis| {
            if depths[0] <= 0.0 {
                return ALL;
            }
            span([a, b, c].map(|corner| corner[axis] / corner.z))
        });
        Self {
            edges,
            normal: (edges[0] + edges[1] + edges[2]) / volume.abs().max(f32::MIN_POSITIVE),
            depths,
            slopes,
        }
    }

    /// Depths that hold those at which rays through a rectangle meet the triangle.
    fn within(&self, slopes: [Span; 2]) -> Option<Span> {
        if self.edges.iter().any(|edge| range(*edge, slopes)[1] < 0.0) {
            return None;
        }
        let [least, most] = range(self.normal, slopes);
        if most <= 0.0 {
            return None;
        }
        let [nearest, farthest] = self.depths;
        let far = if least > 0.0 {
            1.0 / least
        } else {
            f32::INFINITY
        };
        Some([1.0 / most, far].map(|depth| depth.clamp(nearest, farthest)))
    }
}

/// The least and the greatest n·(x, y, 1) over a rectangle.
fn range(n: Vec3, [[left, right], [low, high]]: [Span; 2]) -> Span {
    let [x, y] = [[n.x * left, n.x * right], [n.y * low, n.y * high]];
    let [least, most] = [
        x[0].min(x[1]) + y[0].min(y[1]),
        x[0].max(x[1]) + y[0].max(y[1]),
    ];
    [least + n.z, most + n.z]
}
