//! The part of an engine that this crate does most of: from lights and a depth buffer to lists, and from those
//! to radiance.

use stochastic_light_culling::{
    BatchBuilder, Bounded, Camera, CullCounters, Culler, DepthInterval, Ellipsoid, Error, GgxLobe,
    LightBatch, LightLists, PointBlock, ProjectedEllipsoid, Projection, RadianceEstimator,
    Roulette, Schlick, Seed, ShadingBatch, TileDepths, TileGrid, Vpl, Xi, glam::Vec3,
    rank_along_curve,
};

pub type Light = Vpl<GgxLobe<Schlick>>;

const SEED: u32 = 0;

/// Lights that do not move, and all memory that a frame needs. For views of either projection.
pub struct LightPass<P: Projection> {
    /// Each with the shape of its range, which no frame changes. Sorted so that a light's index is its rank.
    lights: Vec<(Light, Ellipsoid)>,
    roulette: Roulette,
    size: [u32; 2],
    grid: TileGrid,
    tiles: TileDepths,
    batch: LightBatch<ProjectedEllipsoid<P>>,
    culler: Culler<ProjectedEllipsoid<P>>,
    lists: LightLists,
    /// The same lights, with their ξ.
    shading: ShadingBatch<GgxLobe<Schlick>>,
    /// Of each pixel, row by row.
    radiance: Vec<f32>,
}

impl<P: Projection> LightPass<P> {
    /// For views like that of `camera`, of which no more than place and direction may change.
    pub fn new(
        lights: Vec<Light>,
        delta: f32,
        camera: &Camera<P>,
        size: [u32; 2],
        tile_size: u32,
    ) -> Result<Self, Error> {
        let grid = TileGrid::new(size, tile_size)?;
        let roulette = Roulette::new(delta)?;
        let lights = lights.into_iter().map(with_bound).collect();
        let lights = sorted_by_rank(lights, &roulette)?;
        let mut shading = ShadingBatch::new();
        shading.extend((0..).zip(&lights).map(|(i, (light, _))| (light, xi(i, 0))));
        Ok(Self {
            lights,
            roulette,
            size,
            grid,
            tiles: TileDepths::new(&grid, camera, 2)?,
            batch: LightBatch::new(),
            culler: Culler::new(),
            lists: LightLists::new(),
            shading,
            radiance: vec![0.0; size[0] as usize * size[1] as usize],
        })
    }

    /// Lists the lights of each tile for this frame.
    pub fn cull(
        &mut self,
        camera: &Camera<P>,
        depth_buffer: &[f32],
        frame: u32,
    ) -> Result<CullCounters, Error> {
        let width = self.size[0];
        for tile in self.grid.tiles() {
            let pixels = self.grid.pixels(tile).pixels();
            let depths = pixels.map(|[x, y]| depth(camera, depth_buffer[(y * width + x) as usize]));
            self.tiles.set(tile, DepthInterval::modified_half_z(depths));
        }

        for i in 0..self.lights.len() as u32 {
            self.shading.set_xi(i, xi(i, frame));
        }

        let placed = (0..).zip(&self.lights).map(|(index, (light, unit_bound))| {
            let scale = self.roulette.scale(light.flux(), xi(index, frame));
            (index, unit_bound, light.position(), scale)
        });
        self.batch.clear();
        BatchBuilder::new(&self.roulette, camera).add_placed(placed, &mut self.batch);
        self.culler.cull(&self.batch, &self.tiles, &mut self.lists)
    }

    /// The estimate of the light that arrives at what each pixel shows, from the lights of its list: what a
    /// shader does next. Row by row, zero for sky.
    pub fn shade(&mut self, camera: &Camera<P>, depth_buffer: &[f32]) -> &[f32] {
        let Self { size, tiles, .. } = self;
        let estimator = RadianceEstimator::new(&self.roulette);
        self.radiance.fill(0.0);
        for (tile, interval) in self.grid.tiles().flat_map(|tile| [(tile, 0), (tile, 1)]) {
            let list = self.lists.of(tile, interval);
            if list.is_empty() {
                continue;
            }
            let mut pixels = self.grid.pixels(tile).pixels().filter_map(|pixel| {
                let index = (pixel[1] * size[0] + pixel[0]) as usize;
                let depth = depth(camera, depth_buffer[index]);
                let point = camera.point_in_pixel(*size, pixel, depth);
                let is_here = tiles.interval_of(tile, depth) == Some(interval);
                is_here.then(|| (index, camera.to_world_space(point)))
            });
            loop {
                let mut indices = [0; PointBlock::LEN];
                let mut points = pixels
                    .by_ref()
                    .zip(&mut indices)
                    .map(|((i, point), index)| {
                        *index = i;
                        point.into()
                    });
                let Some(points) = PointBlock::take(&mut points) else {
                    break;
                };
                let mut sums = [0.0; PointBlock::LEN];
                estimator.at_block(&self.shading, list, &points, |estimates| {
                    for (sum, radiance) in sums.iter_mut().zip(estimates.radiance) {
                        *sum += radiance;
                    }
                });
                for (index, sum) in indices.iter().zip(sums).take(points.len()) {
                    self.radiance[*index] = sum;
                }
            }
        }
        &self.radiance
    }

    /// The same for a single pixel.
    pub fn radiance(&self, camera: &Camera<P>, depth_buffer: &[f32], pixel: [u32; 2]) -> f32 {
        let index = (pixel[1] * self.size[0] + pixel[0]) as usize;
        let depth = depth(camera, depth_buffer[index]);
        let tile = self.grid.tile_of(pixel);
        let Some(interval) = self.tiles.interval_of(tile, depth) else {
            return 0.0; // sky
        };
        let point = camera.to_world_space(camera.point_in_pixel(self.size, pixel, depth));
        let list = self.lists.of(tile, interval);
        RadianceEstimator::new(&self.roulette).fold_at_points(
            &self.shading,
            [(point.into(), list)],
            0.0,
            |sum, _, estimate| sum + estimate.radiance,
        )
    }

    /// Lights that reach anything at all in this frame.
    pub fn lights_in_reach(&self) -> usize {
        self.batch.len()
    }

    /// How many lights each depth interval of each tile has.
    pub fn list_lengths(&self) -> impl Iterator<Item = u32> + Clone + '_ {
        self.lists.ranges().iter().map(|[start, end]| end - start)
    }
}

/// The depth of what the depth buffer has this value of. Infinite for sky, which lies at the far plane, if there is one.
fn depth<P: Projection>(camera: &Camera<P>, value: f32) -> f32 {
    if value > 0.0 {
        camera.depth(value)
    } else {
        f32::INFINITY
    }
}

fn with_bound(light: Light) -> (Light, Ellipsoid) {
    (light, light.lobe().unit_bound())
}

/// Sorts lights along a curve through the places that they shine on, so that lights side by side have ξ that
/// are spread.
fn sorted_by_rank(
    lights: Vec<(Light, Ellipsoid)>,
    roulette: &Roulette,
) -> Result<Vec<(Light, Ellipsoid)>, Error> {
    let one = Xi::new(1.0)?;
    let center = |(light, unit_bound): &(Light, Ellipsoid)| {
        let scale = roulette.scale(light.flux(), one);
        unit_bound.placed(light.position(), scale).center()
    };
    let centers: Vec<Vec3> = lights.iter().map(center).collect();
    let (mut ranks, mut scratch) = (vec![0; lights.len()], vec![0; 2 * lights.len()]);
    rank_along_curve(&centers, &mut ranks, &mut scratch)?;
    let mut sorted = lights.clone();
    for (light, rank) in lights.into_iter().zip(ranks) {
        sorted[rank as usize] = light;
    }
    Ok(sorted)
}

/// The ξ of the light with this rank, new in each frame, for culling and for shading.
fn xi(rank: u32, frame: u32) -> Xi {
    Seed(SEED).frame(frame).xi_of_rank(rank)
}
