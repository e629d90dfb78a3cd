//! The frame by smooth lights: clusters, bounded, culled and shaded.

use rayon::prelude::*;
use stochastic_light_culling::{
    BatchBuilder, Camera, Error, Interleave, LightBatch, ProjectedEllipsoid, Roulette, Seed, Vsgl,
    Xi, glam::Vec3, rank_along_curve,
};

use super::bounds::BoundKind;
use super::cull::Cullers;
use super::{Cluster, Frame, Measured, Shaded, Shading, Tiling, timed};

/// A cluster in one frame.
#[derive(Clone, Copy, Debug)]
pub struct SmoothLight {
    /// Its flux is weighted for its subregion.
    pub vsgl: Vsgl,
    /// Each channel's flux over that of the brightest.
    pub tint: Vec3,
    pub xi: Xi,
}

/// The lights of `clusters`, each to light one subregion of `interleave`, in the order of their ranks.
pub fn smooth_lights(
    clusters: &[Cluster],
    interleave: &Interleave,
    roulette: &Roulette,
    seed: u32,
) -> Result<Vec<SmoothLight>, Error> {
    // At ξ = 1, where each light has the same irradiance.
    let xi = Xi::new(1.0)?;
    let shines_on = |cluster: &Cluster| cluster.vsgl.bound(roulette, xi).center();
    let places: Vec<Vec3> = clusters.iter().map(shines_on).collect();
    let (mut ranks, mut scratch) = (vec![0; places.len()], vec![0; 2 * places.len()]);
    rank_along_curve(&places, &mut ranks, &mut scratch)?;
    let mut order: Vec<usize> = (0..clusters.len()).collect();
    order.sort_unstable_by_key(|i| ranks[*i]);
    let light = |(i, cluster): (u32, usize)| {
        let (subregion, rank) = interleave.split_light(i);
        let cluster = &clusters[cluster];
        Ok(SmoothLight {
            vsgl: cluster.brightened(interleave.weight())?,
            tint: cluster.tint,
            // Another seed than that of points, which may share a subregion with clusters.
            xi: Seed(seed.wrapping_add(0x5eed))
                .subregion(subregion)
                .frame(0)
                .xi_of_rank(rank),
        })
    };
    (0..).zip(order).map(light).collect()
}

/// The frame by smooth lights, with each of `tilings`; calls `done` after each row of a subregion.
pub fn measure_smooth(
    frame: &Frame,
    tilings: &[Tiling],
    camera: &Camera,
    lights: &[SmoothLight],
    done: impl Fn() + Sync,
) -> Result<Vec<Measured>, Error> {
    let (batches, bound_ms) = timed(|| batches(frame, camera, lights));
    let measured = |tiling: &Tiling| {
        let subregions = tiling.tiles.subregions();
        let mut cullers = Cullers::new(subregions.len());
        let mut cull = || cullers.cull(subregions, &batches);
        // The first time makes room for the lists. Like a later frame, the second does not.
        cull()?;
        let (culled, cull_ms) = timed(cull);
        culled?;
        let list_of = |pixel, depth| {
            let place = tiling.tiles.place_of(pixel, depth)?;
            Some(cullers.lists[place.subregion].of(place.tile, place.interval))
        };
        let mut shaded = Shaded::black(frame.surfaces.surfaces.len());
        let ((), shade_ms) = timed(|| {
            let (all, by_list) = (0..frame.interleave.subregions(), !tiling.refined);
            let shading = Shading::smooth(&frame.roulette, lights);
            shading.shade_subregions(frame, all, by_list, list_of, &mut shaded, &done);
        });
        Ok(Measured {
            bound: BoundKind::Tight,
            refined: tiling.refined,
            bound_ms,
            cull_ms,
            shade_ms,
            shaded,
        })
    };
    tilings.iter().map(measured).collect()
}

/// The lights of each subregion, by index.
fn batches(
    frame: &Frame,
    camera: &Camera,
    lights: &[SmoothLight],
) -> Vec<LightBatch<ProjectedEllipsoid>> {
    let count = lights.len() as u32;
    (0..frame.interleave.subregions())
        .into_par_iter()
        .map(|subregion| {
            let mut batch = LightBatch::new();
            let indices = (0..frame.interleave.lights_in(subregion, count))
                .map(|local| frame.interleave.join_light(subregion, local));
            let with_xi = indices.map(|i| {
                let light = &lights[i as usize];
                (i, &light.vsgl, light.xi)
            });
            BatchBuilder::new(&frame.roulette, camera).add_vsgls(with_xi, &mut batch);
            batch
        })
        .collect()
}
