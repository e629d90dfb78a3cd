//! The lights of a frame: lit points with their share of the flux and their ξ.

use stochastic_light_culling::{
    Direction, Error, GgxLobe, Interleave, LambertLobe, Lobe, Schlick, Seed, Vpl, Xi, glam::Vec3,
};

use crate::scene::{LitPoint, LitPoints, Surface};

/// A virtual point light in one frame.
#[derive(Clone, Copy, Debug)]
pub struct Light<L> {
    /// Its flux is that of the brightest channel, times the weight of its subregion.
    pub vpl: Vpl<L>,
    /// Of the surface that it lies on; it lights nothing below.
    pub normal: Direction,
    /// Each channel's flux over that of the brightest.
    pub tint: Vec3,
    pub xi: Xi,
}

impl<L: Lobe> Light<L> {
    /// Whether `surface` is where this light sends nothing.
    #[inline]
    pub fn has_back_to(&self, surface: &Surface) -> bool {
        self.normal.dot(surface.position - self.vpl.position()) <= 0.0
    }
}

/// All lights of a frame.
pub struct Lights {
    pub glossy: Vec<Light<GgxLobe<Schlick>>>,
    pub diffuse: Vec<Light<LambertLobe>>,
}

impl Lights {
    /// The lights at `points`, each to light one subregion of `interleave`.
    pub fn new(points: &LitPoints, interleave: &Interleave, seed: u32) -> Result<Self, Error> {
        // One row of random numbers for both kinds, so that no two lights share one.
        let first_diffuse = points.glossy.len() as u32;
        Ok(Self {
            glossy: lights(&points.glossy, interleave.weight(), 0, seed)?,
            diffuse: lights(&points.diffuse, interleave.weight(), first_diffuse, seed)?,
        })
    }
}

fn lights<L: Lobe + Copy>(
    points: &[LitPoint<L>],
    weight: f32,
    first: u32,
    seed: u32,
) -> Result<Vec<Light<L>>, Error> {
    let light = |(i, point): (u32, &LitPoint<L>)| {
        let brightest = point.flux.max_element();
        Ok(Light {
            vpl: Vpl::new(point.position, weight * brightest, point.lobe)?,
            normal: point.normal,
            tint: if brightest > 0.0 {
                point.flux / brightest
            } else {
                Vec3::ZERO
            },
            xi: Seed(seed).frame(0).xi(i),
        })
    };
    (first..).zip(points).map(light).collect()
}
