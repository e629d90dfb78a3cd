//! Lights splatted one by one: the polyhedron around a light's range is drawn, and each pixel whose
//! surface is inside evaluates the light [Dachsbacher & Stamminger 2006].

use common::frame::{Frame, GlossyLight, Shaded, Sums};
use rayon::prelude::*;
use stochastic_light_culling::{Camera, Proxy, Tight};

use super::{Polyhedron, Raster};

/// The frame with the lights of each subregion drawn into its pixels.
pub fn splat(frame: &Frame, camera: &Camera, lights: &[GlossyLight]) -> Shaded {
    let interleave = &frame.interleave;
    let subregions: Vec<Vec<Sums>> = (0..interleave.subregions())
        .into_par_iter()
        .map(|subregion| splat_subregion(frame, camera, lights, subregion))
        .collect();

    let mut image = Shaded::black(frame.surfaces.surfaces.len());
    for (sums, subregion) in subregions.iter().zip(0..) {
        let [width, _] = interleave.subregion_size(subregion);
        for (sums, i) in sums.iter().zip(0..) {
            let pixel = interleave.join_pixel(subregion, [i % width, i / width]);
            image.set(frame.surfaces.index(pixel), sums);
        }
    }
    image
}

fn splat_subregion(
    frame: &Frame,
    camera: &Camera,
    lights: &[GlossyLight],
    subregion: u32,
) -> Vec<Sums> {
    let interleave = &frame.interleave;
    let [width, height] = interleave.subregion_size(subregion);
    let image_size = frame.surfaces.image_size;
    let slope = |local: [u32; 2]| {
        let pixel = interleave.join_pixel(subregion, local);
        camera.point_in_pixel(image_size, pixel, 1.0)
    };
    let mut raster = Raster::new(
        (0..width).map(|x| [slope([x, 0]).x; 2]).collect(),
        (0..height).map(|y| [slope([0, y]).y; 2]).collect(),
    );
    let mut sums = vec![Sums::default(); (width * height) as usize];
    for local in 0..interleave.lights_in(subregion, lights.len() as u32) {
        let light = &lights[interleave.join_light(subregion, local) as usize];
        let ellipsoid = light.vpl.bound_by(Tight, &frame.roulette, light.xi);
        let Some(polyhedron) = Polyhedron::around(&ellipsoid, Proxy::Icosphere, camera) else {
            continue;
        };
        raster.draw(&polyhedron, |x, y, [near, far]| {
            let pixel = interleave.join_pixel(subregion, [x as u32, y as u32]);
            let surface = frame.surfaces.at(pixel);
            if near <= surface.depth && surface.depth <= far {
                sums[y * width as usize + x].add(frame, light, surface);
            }
        });
    }
    sums
}
