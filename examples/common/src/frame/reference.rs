//! The irradiance of all lights, with none left to chance: what the frame is an estimate of.

use rayon::prelude::*;
use stochastic_light_culling::{Error, Lobe, PointBlock, Roulette, ShadedPoint, glam::Vec3};

use super::shade::Shading;
use super::{Frame, Light, Lights};

/// The irradiance at some pixels, glossy and diffuse lights apart.
pub struct Reference {
    /// Every so many pixels across and down.
    pub stride: usize,
    /// Places in the image, row by row.
    pub pixels: Vec<usize>,
    pub glossy: Vec<Vec3>,
    pub diffuse: Vec<Vec3>,
}

impl Reference {
    /// At every `stride`-th pixel across and down that is not sky; calls `done` after each.
    pub fn new(
        frame: &Frame,
        lights: &Lights,
        stride: usize,
        done: impl Fn() + Sync,
    ) -> Result<Self, Error> {
        let pixels = Self::pixels(frame, stride);
        let glossy = AllLights::new(frame, &lights.glossy)?;
        let diffuse = AllLights::new(frame, &lights.diffuse)?;
        let both: Vec<[Vec3; 2]> = pixels
            .par_chunks(PointBlock::LEN)
            .flat_map_iter(|pixels| {
                let (glossy, diffuse) = (glossy.irradiance(pixels), diffuse.irradiance(pixels));
                for _ in pixels {
                    done();
                }
                glossy.zip(diffuse).map(Into::into)
            })
            .collect();
        Ok(Self {
            stride,
            pixels,
            glossy: both.iter().map(|[glossy, _]| *glossy).collect(),
            diffuse: both.iter().map(|[_, diffuse]| *diffuse).collect(),
        })
    }

    /// The irradiance of glossy and of diffuse lights for all of `count` pixels, black for sky; `None`
    /// if only some pixels were taken.
    pub fn images(&self, count: usize) -> Option<[Vec<Vec3>; 2]> {
        if self.stride > 1 {
            return None;
        }
        Some([&self.glossy, &self.diffuse].map(|irradiance| {
            let mut image = vec![Vec3::ZERO; count];
            for (pixel, irradiance) in self.pixels.iter().zip(irradiance) {
                image[*pixel] = *irradiance;
            }
            image
        }))
    }

    /// The places of the pixels that [`Self::new`] would take.
    pub fn pixels(frame: &Frame, stride: usize) -> Vec<usize> {
        let [width, height] = frame.surfaces.image_size;
        let rows = (0..height).step_by(stride);
        rows.flat_map(|y| (0..width).step_by(stride).map(move |x| [x, y]))
            .map(|pixel| frame.surfaces.index(pixel))
            .filter(|index| !frame.surfaces.surfaces[*index].is_sky())
            .collect()
    }
}

/// All lights of one kind, each to be evaluated at all pixels.
struct AllLights<'a, L> {
    frame: &'a Frame<'a>,
    shading: Shading<L>,
    list: Vec<u32>,
}

impl<'a, L: Lobe + Copy> AllLights<'a, L> {
    fn new(frame: &'a Frame, lights: &[Light<L>]) -> Result<Self, Error> {
        // So small that what is not accepted, or more than it is, makes no difference.
        let roulette = Roulette::new(1e-30)?;
        Ok(Self {
            frame,
            shading: Shading::with_roulette(frame, &roulette, lights),
            list: (0..lights.len() as u32).collect(),
        })
    }

    /// The irradiance at up to sixteen surfaces of the frame.
    fn irradiance(&self, pixels: &[usize]) -> impl Iterator<Item = Vec3> + use<L> {
        let surfaces = pixels
            .iter()
            .map(|pixel| &self.frame.surfaces.surfaces[*pixel]);
        let points = PointBlock::take(&mut surfaces.map(|surface| ShadedPoint {
            position: surface.position,
            normal: surface.normal,
        }));
        let irradiance = points.map_or([Vec3::ZERO; PointBlock::LEN], |points| {
            (self.shading).irradiance(&self.list, &points, points.normals(), |_| ())
        });
        // Each light is weighted for one subregion, and here lights them all.
        let weight = self.frame.interleave.weight();
        let irradiance = irradiance.into_iter().take(pixels.len());
        irradiance.map(move |irradiance| irradiance / weight)
    }
}
