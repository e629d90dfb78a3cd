//! Direct light: what a reflective shadow map holds, one photon for each of its texels.

use rayon::prelude::*;
use stochastic_light_culling::{Direction, Incidence, glam::Vec3};

use super::beam::Beam;
use super::random::{Purpose, uniform};
use super::{Lamp, Tracer};

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
    pub texel: Texel,
}

/// Which ray of a lamp it is: a texel of a reflective shadow map.
#[derive(Clone, Copy, Debug, Default)]
pub struct Texel {
    /// The number of the map: each beam of a lamp has one.
    pub map: u32,
    /// Its width and height. Some rows have a column less; their last texel sees nothing.
    pub size: [u32; 2],
    /// Column and row.
    pub place: [u32; 2],
}

/// The photons of `count` rays, in random order. Each of the beams of `lamps` has its share by power, one ray
/// through each cell of a grid.
pub fn trace_photons(tracer: &Tracer, lamps: &[Lamp], count: u32, seed: u32) -> Vec<Photon> {
    let extent = tracer.extent();
    let beams: Vec<Beam> = lamps
        .iter()
        .flat_map(|lamp| Beam::of(lamp, &extent))
        .collect();
    let mut photons: Vec<(f32, Photon)> = Vec::new();
    let starts = starts(&beams, count);
    for (map, (beam, of_beam)) in (0..).zip(beams.iter().zip(starts.windows(2))) {
        let (start, end) = (of_beam[0], of_beam[1]);
        let grid = Grid::new(end - start);
        photons.par_extend((start..end).into_par_iter().filter_map(|ray| {
            let jitter = [Purpose::JitterX, Purpose::JitterY].map(|p| uniform(ray, p, seed));
            let (x, y, area) = grid.point(ray - start, jitter);
            let texel = Texel {
                map,
                size: grid.size(),
                place: grid.place(ray - start),
            };
            let photon = trace_photon(tracer, beam, [x, y], area)?;
            let photon = Photon { texel, ..photon };
            Some((uniform(ray, Purpose::Shuffle, seed), photon))
        }));
    }
    photons.sort_by(|(a, _), (b, _)| a.total_cmp(b));
    photons.into_iter().map(|(_, photon)| photon).collect()
}

/// The first of `count` rays for each beam, and `count`.
fn starts(beams: &[Beam], count: u32) -> Vec<u32> {
    let powers: Vec<f64> = beams.iter().map(|beam| beam.power().into()).collect();
    let sum: f64 = powers.iter().sum();
    let mut before = 0.0;
    let start = |power: &f64| {
        let start = f64::from(count) * before / sum;
        before += power;
        start.round() as u32
    };
    let starts: Vec<u32> = powers.iter().map(start).collect();
    [&starts[..], &[count]].concat()
}

fn trace_photon(tracer: &Tracer, beam: &Beam, [x, y]: [f32; 2], area: f32) -> Option<Photon> {
    let ray = beam.ray(x, y, area);
    if ray.flux.max_element() <= 0.0 {
        return None;
    }
    let hit = tracer.nearest_unlit(ray.origin, ray.direction)?;
    let cosine = -hit.plane_normal.dot(ray.direction.normalize());
    let distance_squared = hit.position.distance_squared(ray.origin);
    Some(Photon {
        position: hit.position,
        incidence: Incidence {
            normal: Direction::new(hit.normal).ok()?,
            incoming: Direction::new(-ray.direction).ok()?,
        },
        flux: ray.flux,
        footprint: (distance_squared * ray.solid_angle + ray.area) / cosine.max(0.1),
        material: hit.material,
        texel: Texel::default(),
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

    /// The number of columns, where a row has most, and of rows.
    fn size(&self) -> [u32; 2] {
        [self.cells.div_ceil(self.rows), self.rows]
    }

    /// Column and row of a cell.
    fn place(&self, cell: u32) -> [u32; 2] {
        let row = ((u64::from(cell) + 1) * u64::from(self.rows)).div_ceil(u64::from(self.cells));
        let row = row as u32 - 1;
        [cell - self.start(row), row]
    }

    /// The point at `jitter`, in (0, 1]², of a cell, and the cell's area.
    fn point(&self, cell: u32, jitter: [f32; 2]) -> (f32, f32, f32) {
        let [column, row] = self.place(cell);
        let columns = (self.start(row + 1) - self.start(row)) as f32;
        let x = (column as f32 + jitter[0]) / columns;
        let y = (row as f32 + jitter[1]) / self.rows as f32;
        let area = 4.0 / (columns * self.rows as f32);
        (2.0 * x - 1.0, 2.0 * y - 1.0, area)
    }
}
