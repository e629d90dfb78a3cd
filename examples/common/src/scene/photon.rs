//! Direct light: what a reflective shadow map holds, one photon for each of its texels.

use rayon::prelude::*;
use stochastic_light_culling::{Direction, Incidence, glam::Vec3};

use super::random::{Purpose, uniform};
use super::{Spot, Tracer};

/// Where light from the spot arrives, and how much.
#[derive(Clone, Copy, Debug)]
pub struct Photon {
    pub position: Vec3,
    pub incidence: Incidence,
    /// In W, for red, green and blue.
    pub flux: Vec3,
    /// The area of surface that the photon stands for.
    pub footprint: f32,
    pub material: usize,
}

/// The photons of `count` rays, one through each cell of a grid over the spot's window, in random
/// order.
pub fn trace_photons(tracer: &Tracer, spot: &Spot, count: u32, seed: u32) -> Vec<Photon> {
    let grid = Grid::new(count);
    let mut photons: Vec<(f32, Photon)> = (0..count)
        .into_par_iter()
        .filter_map(|ray| {
            let jitter = [Purpose::JitterX, Purpose::JitterY].map(|p| uniform(ray, p, seed));
            let (x, y, area) = grid.point(ray, jitter);
            let photon = trace_photon(tracer, spot, [x, y], area)?;
            Some((uniform(ray, Purpose::Shuffle, seed), photon))
        })
        .collect();
    photons.sort_by(|(a, _), (b, _)| a.total_cmp(b));
    photons.into_iter().map(|(_, photon)| photon).collect()
}

fn trace_photon(tracer: &Tracer, spot: &Spot, [x, y]: [f32; 2], area: f32) -> Option<Photon> {
    let (ray, density) = spot.ray(x, y);
    let hit = tracer.nearest(spot.position, ray)?;
    let solid_angle = density * area;
    let cosine = -hit.plane_normal.dot(ray.normalize());
    let distance_squared = hit.position.distance_squared(spot.position);
    Some(Photon {
        position: hit.position,
        incidence: Incidence {
            normal: Direction::new(hit.normal).ok()?,
            incoming: Direction::new(-ray).ok()?,
        },
        flux: spot.intensity * solid_angle,
        footprint: distance_squared * solid_angle / cosine.max(0.1),
        material: hit.material,
    })
}

/// The square \[−1, 1\]² cut into cells, rows of almost equally many, nearly as wide as high.
struct Grid {
    cells: u32,
    rows: u32,
}

impl Grid {
    fn new(cells: u32) -> Self {
        let rows = (f64::from(cells).sqrt().round() as u32).max(1);
        Self { cells, rows }
    }

    /// The first cell of `row`.
    fn start(&self, row: u32) -> u32 {
        (u64::from(row) * u64::from(self.cells) / u64::from(self.rows)) as u32
    }

    /// The point at `jitter`, in (0, 1]², of a cell, and the cell's area.
    fn point(&self, cell: u32, jitter: [f32; 2]) -> (f32, f32, f32) {
        let row = ((u64::from(cell) + 1) * u64::from(self.rows)).div_ceil(u64::from(self.cells));
        let row = row as u32 - 1;
        let (start, end) = (self.start(row), self.start(row + 1));
        let columns = (end - start) as f32;
        let x = ((cell - start) as f32 + jitter[0]) / columns;
        let y = (row as f32 + jitter[1]) / self.rows as f32;
        let area = 4.0 / (columns * self.rows as f32);
        (2.0 * x - 1.0, 2.0 * y - 1.0, area)
    }
}
