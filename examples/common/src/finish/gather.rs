//! The indirect light at points that no pixel sees, and so no tile has a list for.

use stochastic_light_culling::{
    Error, GgxLobe, LambertLobe, Lobe, PointBlock, Roulette, Schlick, ShadedPoint, glam::Vec3,
};

use super::reflection::dimmed;
use crate::frame::{Frame, Light, Lights, Shading};

/// How many lights a point is lit by, of each kind.
const LIGHTS: usize = 256;

/// A point whose irradiance is wanted.
pub struct Gather {
    /// The column of its pixel.
    pub column: usize,
    /// The radiance that it adds there, at most.
    pub brightest: f32,
    /// That radiance for an irradiance of one.
    pub weight: Vec3,
    pub position: Vec3,
    pub normal: Vec3,
}

/// The lights of a frame, of which each point takes a part.
pub struct Gatherer {
    glossy: Part<GgxLobe<Schlick>>,
    diffuse: Part<LambertLobe>,
}

impl Gatherer {
    pub fn new(frame: &Frame, lights: &Lights) -> Result<Self, Error> {
        Ok(Self {
            glossy: Part::new(frame, &lights.glossy)?,
            diffuse: Part::new(frame, &lights.diffuse)?,
        })
    }

    /// The weighted irradiance of `gathers`, each with its column. Other `phase`s take other lights.
    pub fn gather(&self, gathers: &[Gather], phase: u32) -> Vec<(usize, Vec3)> {
        let mut gathered = Vec::with_capacity(gathers.len());
        // Points from all over the row, so that a pixel is lit by many parts.
        let blocks = gathers.len().div_ceil(PointBlock::LEN);
        for block in 0..blocks {
            let gathers = || gathers[block..].iter().step_by(blocks);
            let mut points = gathers().map(|gather| ShadedPoint {
                position: gather.position,
                normal: gather.normal,
            });
            let Some(points) = PointBlock::take(&mut points) else {
                continue;
            };
            // A step that shares no divisor with the usual numbers of parts.
            let part = block + 13 * phase as usize;
            let glossy = self.glossy.irradiance(&points, part);
            let diffuse = self.diffuse.irradiance(&points, part);
            for (i, gather) in gathers().enumerate() {
                let radiance = gather.weight * (glossy[i] + diffuse[i]);
                gathered.push((gather.column, dimmed(radiance, gather.brightest)));
            }
        }
        gathered
    }
}

/// Lists of lights of one kind, each of them all over the scene.
struct Part<L> {
    shading: Shading<L>,
    lists: Vec<Vec<u32>>,
    /// What a light counts for more, since it stands for those of the other lists.
    weight: f32,
}

impl<L: Lobe + Copy> Part<L> {
    fn new(frame: &Frame, lights: &[Light<L>]) -> Result<Self, Error> {
        // So small that what is not accepted, or more than it is, makes no difference.
        let roulette = Roulette::new(1e-30)?;
        let count = lights.len().div_ceil(LIGHTS).max(1);
        // Lights side by side in their order are near each other.
        let list = |first: usize| (first as u32..lights.len() as u32).step_by(count).collect();
        let sparse = Frame {
            // A light stands for so much more of its surface.
            least_distance_squared: frame.least_distance_squared * count as f32,
            ..*frame
        };
        Ok(Self {
            shading: Shading::with_roulette(&sparse, &roulette, lights),
            lists: (0..count).map(list).collect(),
            // Each light is weighted for one subregion, too.
            weight: count as f32 / frame.interleave.weight(),
        })
    }

    fn irradiance(&self, points: &PointBlock, part: usize) -> [Vec3; PointBlock::LEN] {
        let list = &self.lists[part % self.lists.len()];
        let irradiance = self
            .shading
            .irradiance(list, points, points.normals(), |_| ());
        irradiance.map(|irradiance| irradiance * self.weight)
    }
}
