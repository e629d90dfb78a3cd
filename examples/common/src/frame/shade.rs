//! Irradiance of each pixel from the lights in its list.

use std::ops::Range;

use rayon::prelude::*;
use stochastic_light_culling::{
    BlockEstimates, Estimate, Lobe, PointBlock, RadianceEstimator, Roulette, ShadedLight,
    ShadedPoint, ShadingBatch, Vsgl, glam::Vec3,
};

use super::{Frame, Light, SmoothLight};
use crate::scene::Surface;

/// For each pixel of an image, row by row: irradiance, the lights whose lobe was evaluated, and those
/// of them that were accepted.
#[derive(Clone, Debug)]
pub struct Shaded {
    pub irradiance: Vec<Vec3>,
    pub evaluated: Vec<u32>,
    pub contributing: Vec<u32>,
}

impl Shaded {
    /// An image of `count` pixels without light.
    pub fn black(count: usize) -> Self {
        Self {
            irradiance: vec![Vec3::ZERO; count],
            evaluated: vec![0; count],
            contributing: vec![0; count],
        }
    }

    pub fn set(&mut self, pixel: usize, sums: &Sums) {
        self.irradiance[pixel] = sums.irradiance;
        self.evaluated[pixel] = sums.evaluated;
        self.contributing[pixel] = sums.contributing;
    }

    /// At how many pixels the irradiance or the lights accepted differ in any bit.
    pub fn pixels_unlike(&self, other: &Self) -> usize {
        let bits = |irradiance: &Vec3| irradiance.to_array().map(f32::to_bits);
        let irradiance = self.irradiance.iter().zip(&other.irradiance);
        let contributing = self.contributing.iter().zip(&other.contributing);
        irradiance
            .zip(contributing)
            .filter(|((a, b), (m, n))| bits(a) != bits(b) || m != n)
            .count()
    }
}

/// One pixel's sums.
#[derive(Clone, Copy, Default)]
pub struct Sums {
    pub irradiance: Vec3,
    pub evaluated: u32,
    pub contributing: u32,
}

impl Sums {
    /// Adds what `light` sends to `surface`, if that accepts it.
    ///
    /// Sums over the same lights in the same order are the same, whatever else was passed over.
    #[inline]
    pub fn add<L: Lobe>(&mut self, frame: &Frame, light: &Light<L>, surface: &Surface) {
        self.evaluated += 1;
        let path = Path::new(light, surface, frame.least_distance_squared);
        let (intensity, distance_squared) = (path.intensity, path.distance_squared);
        let radiance = (frame.roulette).estimate(intensity, distance_squared, light.xi);
        // Zero where the light is not accepted.
        self.contributing += u32::from(radiance > 0.0);
        self.irradiance += radiance * path.cosine * light.tint;
    }
}

/// Shades all pixels by the lists that `list_of` gives for a pixel of a subregion and the depth of its surface;
/// calls `done` after each row of a subregion.
///
/// If pixels side by side share lists, as those of a tile do, lights are evaluated at sixteen of them at once,
/// else several pixels with their lists at once. The sums are the same.
pub fn shade<'a, L: Lobe + Copy + Sync>(
    frame: &Frame,
    share_lists: bool,
    lights: &[Light<L>],
    list_of: impl Fn((u32, [u32; 2]), f32) -> Option<&'a [u32]> + Sync,
    done: impl Fn() + Sync,
) -> Shaded {
    let mut image = Shaded::black(frame.surfaces.surfaces.len());
    let (shading, all) = (
        Shading::new(frame, lights),
        0..frame.interleave.subregions(),
    );
    shading.shade_subregions(frame, all, share_lists, list_of, &mut image, done);
    image
}

/// Counts for each pixel of some subregions of `image` how many lights of its list it evaluates: those whose surface
/// faces it.
pub fn count_facing<'a, L: Lobe + Sync>(
    frame: &Frame,
    subregions: Range<u32>,
    lights: &[Light<L>],
    list_of: impl Fn((u32, [u32; 2]), f32) -> Option<&'a [u32]> + Sync,
    image: &mut Shaded,
) {
    let width = frame.surfaces.image_size[0] as usize;
    let rows = image.evaluated.par_chunks_mut(width).enumerate();
    rows.for_each(|(y, evaluated)| {
        for (x, evaluated) in evaluated.iter_mut().enumerate() {
            let pixel = [x as u32, y as u32];
            let local = frame.interleave.split_pixel(pixel);
            if subregions.contains(&local.0) {
                let surface = frame.surfaces.at(pixel);
                let list = list_of(local, surface.depth).unwrap_or_default();
                let faces = |i: &&u32| !lights[**i as usize].has_back_to(surface);
                *evaluated = list.iter().filter(faces).count() as u32;
            }
        }
    });
}

/// The pixels of a subregion's row that see a surface.
#[derive(Default)]
struct Row<'a> {
    pixels: Vec<Pixel<'a>>,
    sums: Vec<Sums>,
}

struct Pixel<'a> {
    /// Its place in the row of the image.
    column: usize,
    surface: &'a Surface,
    list: &'a [u32],
}

impl Pixel<'_> {
    /// Lit from all sides, so that lights are counted wherever they are.
    fn point(&self) -> ShadedPoint {
        self.surface.position.into()
    }
}

impl<'a> Row<'a> {
    /// Collects the pixels from the `first` on.
    fn collect<'l>(
        &mut self,
        frame: &'a Frame,
        [first, y]: [u32; 2],
        list_of: impl Fn((u32, [u32; 2]), f32) -> Option<&'l [u32]>,
    ) where
        'l: 'a,
    {
        self.pixels.clear();
        let width = frame.surfaces.image_size[0];
        // Divided once a row.
        let (subregion, local) = frame.interleave.split_pixel([first, y]);
        let columns = (first..width).step_by(frame.interleave.width() as usize);
        for (x, column) in columns.zip(local[0]..) {
            let surface = frame.surfaces.at([x, y]);
            let pixel = (subregion, [column, local[1]]);
            if let Some(list) = list_of(pixel, surface.depth) {
                self.pixels.push(Pixel {
                    column: x as usize,
                    surface,
                    list,
                });
            }
        }
        self.sums.clear();
        self.sums.resize(self.pixels.len(), Sums::default());
    }
}

/// The lights of a frame, ready to be evaluated.
pub struct Shading<L> {
    estimator: RadianceEstimator,
    batch: ShadingBatch<L>,
    tints: Vec<Vec3>,
}

impl<L: Lobe + Copy> Shading<L> {
    pub fn new(frame: &Frame, lights: &[Light<L>]) -> Self {
        Self::with_roulette(frame, &frame.roulette, lights)
    }

    /// With a roulette other than that of the frame.
    pub fn with_roulette(frame: &Frame, roulette: &Roulette, lights: &[Light<L>]) -> Self {
        let estimator = RadianceEstimator::new(roulette);
        let mut batch = ShadingBatch::new();
        batch.extend(lights.iter().map(|light| (&light.vpl, light.xi)));
        Self {
            // A mean of areas is finite and not negative.
            estimator: estimator
                .with_least_distance_squared(frame.least_distance_squared)
                .unwrap_or(estimator),
            batch,
            tints: lights.iter().map(|light| light.tint).collect(),
        }
    }
}

impl Shading<Vsgl> {
    /// Of smooth lights, with a roulette other than that of the frame perhaps.
    pub fn smooth(roulette: &Roulette, lights: &[SmoothLight]) -> Self {
        let mut batch = ShadingBatch::<Vsgl>::new();
        batch.extend(lights.iter().map(|light| (&light.vsgl, light.xi)));
        Self {
            estimator: RadianceEstimator::new(roulette),
            batch,
            tints: lights.iter().map(|light| light.tint).collect(),
        }
    }
}

impl<L: ShadedLight> Shading<L> {
    /// Shades the pixels of some subregions of `image`, as [`shade`] does all.
    pub fn shade_subregions<'a>(
        &self,
        frame: &Frame,
        subregions: Range<u32>,
        share_lists: bool,
        list_of: impl Fn((u32, [u32; 2]), f32) -> Option<&'a [u32]> + Sync,
        image: &mut Shaded,
        done: impl Fn() + Sync,
    ) where
        L: Sync,
    {
        let width = frame.surfaces.image_size[0] as usize;
        let irradiance = image.irradiance.par_chunks_mut(width);
        let evaluated = image.evaluated.par_chunks_mut(width);
        let contributing = image.contributing.par_chunks_mut(width);
        let rows = irradiance.zip(evaluated).zip(contributing).enumerate();
        rows.for_each_init(Row::default, |row, (y, out)| {
            let ((irradiance, evaluated), contributing) = out;
            // Neighbours in a subregion share most of their lights; those in the image, none.
            for first in (0..frame.interleave.width()).map(|phase| [phase, y as u32]) {
                if !subregions.contains(&frame.interleave.split_pixel(first).0) {
                    continue;
                }
                row.collect(frame, first, &list_of);
                if share_lists {
                    self.shade_by_list(row);
                } else {
                    self.shade_pixel_by_pixel(row);
                }
                for (pixel, sums) in row.pixels.iter().zip(&row.sums) {
                    irradiance[pixel.column] = sums.irradiance;
                    evaluated[pixel.column] = pixel.list.len() as u32;
                    contributing[pixel.column] = sums.contributing;
                }
                done();
            }
        });
    }

    /// Adds the lights of each pixel's list to its sums.
    fn shade_pixel_by_pixel(&self, row: &mut Row) {
        let Row { pixels, sums } = row;
        let points = pixels.iter().map(|pixel| (pixel.point(), pixel.list));
        let add = |(mut last, mut sum): (usize, Sums), i: usize, estimate: &Estimate| {
            if i != last {
                sums[last] = sum;
                (last, sum) = (i, Sums::default());
            }
            let cosine = (-estimate.direction).dot(pixels[i].surface.normal).max(0.0);
            let tint = self.tints[estimate.light as usize];
            sum.contributing += 1;
            sum.irradiance += estimate.radiance * cosine * tint;
            (last, sum)
        };
        let first = (0, Sums::default());
        let (last, sum) = self
            .estimator
            .fold_at_points(&self.batch, points, first, add);
        if let Some(last) = sums.get_mut(last) {
            *last = sum;
        }
    }

    /// As [`Self::shade_pixel_by_pixel`], up to sixteen pixels with the same list at once.
    fn shade_by_list(&self, row: &mut Row) {
        let Row { pixels, sums } = row;
        // Two neighbours may see different depths of their tile, which have lists of their own.
        let mut order: Vec<usize> = (0..pixels.len()).collect();
        order.sort_by_key(|i| (pixels[*i].list.as_ptr(), pixels[*i].list.len()));
        let is_same = |a: &usize, b: &usize| std::ptr::eq(pixels[*a].list, pixels[*b].list);
        for group in order.chunk_by(is_same) {
            let list = pixels[group[0]].list;
            for group in group.chunks(PointBlock::LEN) {
                let with_normal = |i: &usize| ShadedPoint {
                    normal: pixels[*i].surface.normal,
                    ..pixels[*i].point()
                };
                let normals = PointBlock::take(&mut group.iter().map(with_normal));
                let points = PointBlock::take(&mut group.iter().map(|i| pixels[*i].point()));
                let (Some(points), Some(normals)) = (points, normals) else {
                    continue;
                };
                let mut contributing = [0; PointBlock::LEN];
                let irradiance = self.irradiance(list, &points, normals.normals(), |estimates| {
                    for (i, contributing) in contributing.iter_mut().enumerate() {
                        *contributing += estimates.accepted >> i & 1;
                    }
                });
                for (k, i) in group.iter().enumerate() {
                    sums[*i].irradiance = irradiance[k];
                    sums[*i].contributing = contributing[k];
                }
            }
        }
    }

    /// The irradiance of surfaces with these normals at the points of a block. Calls `accepted` with each light
    /// that one of them accepts.
    #[inline]
    pub fn irradiance(
        &self,
        list: &[u32],
        points: &PointBlock,
        [n_x, n_y, n_z]: &[[f32; PointBlock::LEN]; 3],
        mut accepted: impl FnMut(&BlockEstimates),
    ) -> [Vec3; PointBlock::LEN] {
        let mut sums = [[0.0; PointBlock::LEN]; 3];
        self.estimator
            .at_block(&self.batch, list, points, |estimates| {
                let tint = self.tints[estimates.light as usize].to_array();
                let [x, y, z] = &estimates.direction;
                for i in 0..PointBlock::LEN {
                    let cosine = -x[i] * n_x[i] + -y[i] * n_y[i] + -z[i] * n_z[i];
                    let arriving = estimates.radiance[i] * if cosine > 0.0 { cosine } else { 0.0 };
                    for (sums, tint) in sums.iter_mut().zip(tint) {
                        sums[i] += arriving * tint;
                    }
                }
                accepted(estimates);
            });
        let [x, y, z] = sums;
        std::array::from_fn(|i| Vec3::new(x[i], y[i], z[i]))
    }
}

/// The way from a light to a surface.
pub struct Path {
    pub intensity: f32,
    pub distance_squared: f32,
    /// Of the angle of arrival; zero from behind.
    pub cosine: f32,
}

impl Path {
    #[inline]
    pub fn new<L: Lobe>(light: &Light<L>, surface: &Surface, least_distance_squared: f32) -> Self {
        // Of no length where the two coincide: no direction, hence no light.
        let (direction, true_distance_squared) = light.vpl.direction_to(surface.position);
        Self {
            intensity: light.vpl.radiant_intensity(direction),
            distance_squared: true_distance_squared.max(least_distance_squared),
            cosine: (-direction).dot(surface.normal).max(0.0),
        }
    }

    #[inline]
    pub fn irradiance(&self) -> f32 {
        self.intensity / self.distance_squared * self.cosine
    }
}
