//! Light passes over one view: by an engine's windows, by roulette, and of all lights.

use rayon::prelude::*;
use stochastic_light_culling::{
    BatchBuilder, Bounded, BoxTest, Camera, Culler, DepthInterval, DistanceWindow, Error,
    LightBatch, LightLists, Lobe, Perspective, PointBlock, Project, ProjectedBound,
    RadianceEstimator, Roulette, Seed, ShadedPoint, ShadingBatch, TileDepths, TileGrid, Xi,
    glam::Vec3,
};

use crate::street::{Lamps, Surface};

/// The radius of a lamp, within which it gets no brighter.
const LAMP_RADIUS: f32 = 0.05;

/// What is seen, and the tiles of the picture.
pub struct View {
    pub camera: Camera,
    pub grid: TileGrid,
    pub tiles: TileDepths,
    pub surfaces: Vec<Option<Surface>>,
}

impl View {
    pub fn new(
        camera: Camera,
        size: [u32; 2],
        surfaces: Vec<Option<Surface>>,
    ) -> Result<Self, Error> {
        let grid = TileGrid::new(size, 8)?;
        let mut tiles = TileDepths::new(&grid, &camera, 2)?;
        for tile in grid.tiles() {
            let index = |[x, y]: [u32; 2]| (y * size[0] + x) as usize;
            let pixels = grid.pixels(tile).pixels();
            let depths =
                pixels.map(|pixel| surfaces[index(pixel)].map_or(f32::INFINITY, |s| s.depth));
            tiles.set(tile, DepthInterval::modified_half_z(depths));
        }
        Ok(Self {
            camera,
            grid,
            tiles,
            surfaces,
        })
    }

    /// What each tile's points see by the sum of `shade` of them, with the list of each of their intervals.
    fn light(
        &self,
        lists: Option<&LightLists>,
        shade: impl Fn(&[u32], &[(usize, Surface)], &mut [Vec3]) + Sync,
    ) -> (Vec<Vec3>, u64) {
        let width = self.grid.image_size()[0];
        let tiles: Vec<_> = self.grid.tiles().collect();
        let of_tile =
            |tile: &[u32; 2]| {
                let mut lit = Vec::new();
                let mut evaluated = 0;
                for interval in 0..2 {
                    let pixels = self.grid.pixels(*tile).pixels();
                    let points: Vec<_> = pixels
                        .map(|[x, y]| (y * width + x) as usize)
                        .filter_map(|i| Some((i, self.surfaces[i]?)))
                        .filter(|(_, s)| self.tiles.interval_of(*tile, s.depth) == Some(interval))
                        .collect();
                    let list = lists.map_or(&[][..], |lists| lists.of(*tile, interval));
                    let mut sums = vec![Vec3::ZERO; points.len()];
                    shade(list, &points, &mut sums);
                    evaluated += (list.len() * points.len()) as u64;
                    lit.extend(points.iter().zip(sums).map(|((i, surface), sum)| {
                        (*i, sum * surface.albedo / std::f32::consts::PI)
                    }));
                }
                (lit, evaluated)
            };
        let tiles: Vec<_> = tiles.par_iter().map(of_tile).collect();
        let mut picture = vec![Vec3::ZERO; self.surfaces.len()];
        let mut evaluated = 0;
        for (lit, count) in tiles {
            evaluated += count;
            for (i, radiance) in lit {
                picture[i] = radiance;
            }
        }
        (picture, evaluated)
    }
}

/// The radiance of each pixel, and how many lights were evaluated for all of them.
pub struct Picture {
    pub radiance: Vec<Vec3>,
    pub evaluated: u64,
}

impl Picture {
    pub fn add(&mut self, other: &Self) {
        for (sum, more) in self.radiance.iter_mut().zip(&other.radiance) {
            *sum += *more;
        }
        self.evaluated += other.evaluated;
    }
}

/// A frame by roulette: `seed` is another for each kind of lamp.
pub fn by_roulette<L>(
    view: &View,
    lamps: &Lamps<L>,
    roulette: &Roulette,
    seed: u32,
    frame: u32,
) -> Result<Picture, Error>
where
    L: Bounded<Shape: Project> + Copy + Sync,
    ProjectedBound<L>: BoxTest,
{
    let mut batch = LightBatch::new();
    let seed = Seed(seed).frame(frame);
    let with_xi = || {
        (0..)
            .zip(lamps.lights.iter().zip(&lamps.ranks))
            .map(|(i, (lamp, rank))| (i, lamp, seed.xi_of_rank(*rank)))
    };
    BatchBuilder::new(roulette, &view.camera).add(with_xi(), &mut batch);
    let mut lists = LightLists::new();
    Culler::new().cull(&batch, &view.tiles, &mut lists)?;
    let mut shading = ShadingBatch::new();
    shading.extend(with_xi().map(|(_, lamp, xi)| (lamp, xi)));
    estimate(view, lamps, roulette, Some(&lists), &shading)
}

/// All lights at all points, each with its whole light.
pub fn of_all<L: Lobe + Copy + Sync>(view: &View, lamps: &Lamps<L>) -> Result<Picture, Error> {
    // At this δ every light that lights a point at all is certain.
    let roulette = Roulette::new(1e-20)?;
    let mut shading = ShadingBatch::new();
    let one = Xi::new(1.0)?;
    shading.extend(lamps.lights.iter().map(|lamp| (lamp, one)));
    estimate(view, lamps, &roulette, None, &shading)
}

fn estimate<L: Lobe + Sync>(
    view: &View,
    lamps: &Lamps<L>,
    roulette: &Roulette,
    lists: Option<&LightLists>,
    shading: &ShadingBatch<L>,
) -> Result<Picture, Error> {
    let estimator = RadianceEstimator::new(roulette);
    let estimator = estimator.with_least_distance_squared(LAMP_RADIUS * LAMP_RADIUS)?;
    let all: Vec<u32> = (0..lamps.lights.len() as u32).collect();
    let (radiance, evaluated) = view.light(lists, |list, points, sums| {
        let list = if lists.is_some() { list } else { &all };
        let mut rest = points.iter().map(|(_, s)| ShadedPoint {
            position: s.position,
            normal: s.normal,
        });
        let mut start = 0;
        while let Some(block) = PointBlock::take(&mut rest) {
            estimator.at_block(shading, list, &block, |estimates| {
                for (i, estimate) in estimates.iter() {
                    let cosine = -estimate.direction.dot(points[start + i].1.normal);
                    let colour = lamps.colours[estimate.light as usize];
                    sums[start + i] += colour * (estimate.radiance * cosine.max(0.0));
                }
            });
            start += block.len();
        }
    });
    Ok(Picture {
        radiance,
        evaluated,
    })
}

/// An engine's lights, each with a window that ends where its illuminance falls to `cut`. `bound` holds all of a
/// lobe up to the radius.
pub fn by_windows<L, B>(
    view: &View,
    lamps: &Lamps<L>,
    cut: f32,
    peak: f32,
    bound: impl Fn(&L) -> B,
) -> Result<Picture, Error>
where
    L: Lobe + Copy + Sync,
    B: Project,
    B::Projected<Perspective>: BoxTest,
{
    let window = |i: usize| DistanceWindow::new((peak * lamps.lights[i].flux() / cut).sqrt());
    let windows = (0..lamps.lights.len())
        .map(window)
        .collect::<Result<Vec<_>, _>>()?;
    let bounds: Vec<B> = lamps.lights.iter().map(|lamp| bound(lamp.lobe())).collect();
    let placed = (0..).zip(&lamps.lights).zip(bounds.iter().zip(&windows));
    let placed = placed.map(|((i, lamp), (bound, window))| {
        (i, bound, lamp.position(), window.limit(peak, f32::MAX))
    });
    let mut batch = LightBatch::new();
    let roulette = Roulette::new(cut)?; // has no part in this
    BatchBuilder::new(&roulette, &view.camera).add_placed(placed, &mut batch);
    let mut lists = LightLists::new();
    Culler::new().cull(&batch, &view.tiles, &mut lists)?;
    let (radiance, evaluated) = view.light(Some(&lists), |list, points, sums| {
        for ((_, surface), sum) in points.iter().zip(sums) {
            for i in list {
                let (lamp, window) = (&lamps.lights[*i as usize], &windows[*i as usize]);
                let (direction, squared) = lamp.direction_to(surface.position);
                let cosine = -direction.dot(surface.normal);
                if cosine > 0.0 {
                    let intensity = lamp.radiant_intensity(direction) * window.factor(squared);
                    let illuminance = intensity / squared.max(LAMP_RADIUS * LAMP_RADIUS);
                    *sum += lamps.colours[*i as usize] * (illuminance * cosine);
                }
            }
        }
    });
    Ok(Picture {
        radiance,
        evaluated,
    })
}
