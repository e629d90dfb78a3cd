//! The lights of a frame: lit points with their share of the flux and their ξ.

use stochastic_light_culling::{
    Direction, Error, FrameSeed, GgxLobe, Interleave, LambertLobe, Lobe, Roulette, Schlick, Seed,
    Vpl, Xi, glam::Vec3, rank_along_curve,
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
    /// The lights at `points`, each to light one subregion of `interleave`. Their order is that of ranks: lights
    /// side by side shine on places near each other.
    pub fn new(
        points: &LitPoints,
        interleave: &Interleave,
        roulette: &Roulette,
        seed: u32,
    ) -> Result<Self, Error> {
        let weight = interleave.weight();
        // At ξ = 1, where each point reflects the same radiance.
        let xi = Xi::new(1.0)?;
        let mut glossy = ordered(lights(&points.glossy, weight)?, |vpl| {
            vpl.bound(roulette, xi).center()
        })?;
        let mut diffuse = ordered(lights(&points.diffuse, weight)?, |vpl| {
            vpl.bound(roulette, xi).center()
        })?;
        // Seeds apart, so that no two lights of a subregion share a ξ.
        redraw(&mut glossy, interleave, Seed(seed), 0);
        redraw(&mut diffuse, interleave, Seed(!seed), 0);
        Ok(Self { glossy, diffuse })
    }
}

/// Sorts `lights` along a curve through the points that `place` gives them.
pub fn ordered<L: Copy>(
    lights: Vec<Light<L>>,
    place: impl Fn(&Vpl<L>) -> Vec3,
) -> Result<Vec<Light<L>>, Error> {
    let places: Vec<Vec3> = lights.iter().map(|light| place(&light.vpl)).collect();
    let (mut ranks, mut scratch) = (vec![0; lights.len()], vec![0; 2 * lights.len()]);
    rank_along_curve(&places, &mut ranks, &mut scratch)?;
    let mut sorted = lights.clone();
    for (light, rank) in lights.into_iter().zip(ranks) {
        sorted[rank as usize] = light;
    }
    Ok(sorted)
}

/// Gives each light its ξ for a frame, by its rank within its subregion.
pub fn redraw<L>(lights: &mut [Light<L>], interleave: &Interleave, seed: Seed, frame: u32) {
    let seeds: Vec<FrameSeed> = (0..interleave.subregions())
        .map(|subregion| seed.subregion(subregion).frame(frame))
        .collect();
    for (i, light) in (0..).zip(lights) {
        let (subregion, rank) = interleave.split_light(i);
        light.xi = seeds[subregion as usize].xi_of_rank(rank);
    }
}

fn lights<L: Lobe + Copy>(points: &[LitPoint<L>], weight: f32) -> Result<Vec<Light<L>>, Error> {
    let xi = Xi::new(1.0)?;
    let light = |point: &LitPoint<L>| {
        let brightest = point.flux.max_element();
        Ok(Light {
            vpl: Vpl::new(point.position, weight * brightest, point.lobe)?,
            normal: point.normal,
            tint: if brightest > 0.0 {
                point.flux / brightest
            } else {
                Vec3::ZERO
            },
            xi,
        })
    };
    points.iter().map(light).collect()
}
