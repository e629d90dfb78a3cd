//! All lights, one frame by roulette, the mean of many, and ranges that end where light is faint.

use common::frame::{self, BoundKind, GlossyLight, Reference, Tiles, Tiling, redraw};
use common::picture::{Exposure, tone_mapped};
use stochastic_light_culling::glam::Vec3;
use stochastic_light_culling::{Error, Seed, Xi};

use crate::sheet::{Placed, svg as sheet, write};
use crate::stage::{SEED, Stage, VPLS, ring};

/// The size of a panel.
const PANEL: [u32; 2] = [464, 261];
const GAP: i32 = 8;
const TOP: i32 = 40;
const TITLE: i32 = 26;
const DELTA: f32 = 0.003;
const FRAMES: u32 = 64;

pub fn svg(coarse: u32) -> Result<String, String> {
    let scene = ring()?;
    let size = PANEL.map(|side| side / coarse);
    let stage = Stage::new(&scene, size, 1, DELTA).map_err(|error| error.to_string())?;
    let lit = lit(&stage).map_err(|error| error.to_string())?;
    let surfaces = &stage.surfaces.surfaces;
    let radiance = |irradiance: &Vec<Vec3>| -> Vec<Vec3> {
        let seen = surfaces.iter().zip(irradiance);
        seen.map(|(surface, irradiance)| surface.reflected(*irradiance))
            .collect()
    };
    let pictures = lit
        .each_ref()
        .map(|(name, irradiance, lights)| (*name, radiance(irradiance), *lights));
    let exposure = Exposure::of(&pictures[0].1);
    let sum = |radiance: &[Vec3]| -> f64 {
        radiance
            .iter()
            .map(|rgb| f64::from(rgb.element_sum()))
            .sum()
    };
    let whole = sum(&pictures[0].1);
    let images = pictures
        .each_ref()
        .map(|(_, radiance, _)| tone_mapped(size, radiance, exposure));
    let at = |i: usize| {
        let (column, row) = ((i % 2) as i32, (i / 2) as i32);
        let x = GAP + column * (PANEL[0] as i32 + GAP);
        (x, TOP + TITLE + row * (PANEL[1] as i32 + TITLE + GAP))
    };
    let placed: Vec<Placed> = (images.iter().enumerate())
        .map(|(i, picture)| Placed {
            picture,
            at: at(i),
            size: PANEL.into(),
            is_flat: false,
        })
        .collect();
    let end = at(3);
    let sheet_size = (
        end.0 as u32 + PANEL[0] + GAP as u32,
        end.1 as u32 + PANEL[1] + GAP as u32,
    );
    sheet(sheet_size, &placed, |area| {
        let title =
            format!("Light from the ring alone, {VPLS} rays, δ = {DELTA} W/(m²·sr), not denoised");
        write(area, title, (GAP, 10), 18)?;
        for (i, (name, radiance, lights)) in pictures.iter().enumerate() {
            let share = 100.0 * sum(radiance) / whole;
            let lights = format!("{lights:.1}");
            let lights = lights.trim_end_matches(".0");
            let title = format!("{name}: {lights} lights a pixel, {share:.1} % of the light");
            write(area, title, (at(i).0, at(i).1 - TITLE + 5), 16)?;
        }
        Ok(())
    })
}

/// A name, the irradiance, and how many lights a pixel evaluates for it.
type Lit = (&'static str, Vec<Vec3>, f64);

/// The irradiance in four ways, and the lights that a pixel evaluates for it.
fn lit(stage: &Stage) -> Result<[Lit; 4], Error> {
    let frame = stage.frame();
    let pixels = stage.surfaces.surfaces.len();
    let all = Reference::new(&frame, &stage.lights, 1, || ())?.images(pixels);
    let [all, _] = all.unwrap_or_default();
    let tiles = stage.tiles(8)?;
    let mut lights = stage.lights.glossy.clone();
    let (first, per_pixel) = culled(stage, &tiles, &lights)?;
    let mut mean = vec![Vec3::ZERO; pixels];
    for number in 0..FRAMES {
        redraw(&mut lights, &stage.interleave, Seed(SEED), number);
        for (sum, light) in mean.iter_mut().zip(culled(stage, &tiles, &lights)?.0) {
            *sum += light / FRAMES as f32;
        }
    }
    // At ξ = 1 no light reaches farther than where it is certain.
    let certain = Xi::new(1.0)?;
    let clamped = lights.iter().map(|light| GlossyLight {
        xi: certain,
        ..*light
    });
    let (clamped, of_clamped) = culled(stage, &tiles, &clamped.collect::<Vec<_>>())?;
    Ok([
        ("all lights", all, stage.lights.glossy.len() as f64),
        ("one frame", first, per_pixel),
        ("mean of 64 frames", mean, per_pixel),
        ("ranges that end at δ", clamped, of_clamped),
    ])
}

fn culled(stage: &Stage, tiles: &Tiles, lights: &[GlossyLight]) -> Result<(Vec<Vec3>, f64), Error> {
    let tiling = [Tiling {
        tiles,
        refined: false,
    }];
    let bound = BoundKind::Tight;
    let measured =
        frame::measure_glossy(&stage.frame(), &tiling, &stage.camera, lights, bound, || ())?;
    let shaded = &measured[0].shaded;
    let per_pixel = frame::mean_over_surfaces(&stage.surfaces, &shaded.evaluated);
    Ok((shaded.irradiance.clone(), per_pixel))
}
