//! The frame by smooth lights, each in the place of a cluster of points.

use common::frame::{self, Frame, LightMaps, Measured, SmoothLight, Tiling, smooth_lights, timed};
use common::progress::progress;
use common::scene::LitPoints;
use stochastic_light_culling::{Camera, Error};

use crate::arguments::{Arguments, Clusters};

pub struct Smooth {
    pub glossy: Vec<Measured>,
    pub diffuse: Measured,
    /// What it took to make lights of points.
    pub cluster_ms: f64,
}

/// The frame by clusters of glossy points, and by clusters of diffuse points. The rays from the light are the texels
/// of reflective shadow maps, one for each beam of a lamp, from which clusters are drawn.
pub fn measure(
    arguments: &Arguments,
    clusters: Clusters,
    frame: &Frame,
    tilings: &[Tiling; 2],
    camera: &Camera,
    points: &LitPoints,
) -> Result<Smooth, String> {
    let lights = || -> Result<[Vec<SmoothLight>; 2], Error> {
        let maps = [
            LightMaps::glossy(&points.glossy)?,
            LightMaps::diffuse(&points.diffuse)?,
        ];
        let mut lights = [(); 2].map(|()| Vec::new());
        for (mut map, lights) in maps.into_iter().zip(&mut lights) {
            let clusters = map.clusters(clusters.clustering, clusters.count, arguments.seed)?;
            *lights = smooth_lights(
                &clusters,
                &frame.interleave,
                &frame.roulette,
                arguments.seed,
            )?;
        }
        Ok(lights)
    };
    let said = |error: Error| error.to_string();
    let (lights, cluster_ms) = timed(lights);
    let [glossy, diffuse] = lights.map_err(said)?;

    let bar = progress("shading", 3 * frame.interleaved_rows().len());
    let done = || bar.inc(1);
    let glossy = frame::measure_smooth(frame, tilings, camera, &glossy, done);
    let diffuse = frame::measure_smooth(frame, &tilings[..1], camera, &diffuse, done);
    bar.finish_and_clear();
    Ok(Smooth {
        glossy: glossy.map_err(said)?,
        diffuse: diffuse.map_err(said)?.remove(0),
        cluster_ms,
    })
}
