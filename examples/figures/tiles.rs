//! Tiles over a frame, the ellipsoids of some lights, and the tiles that one of them may touch.

use common::finish::Finish;
use common::frame::{self, BoundKind, Tiling};
use common::picture::{Exposure, tone_mapped};
use common::scene::Gloss;
use plotters::element::{PathElement, Rectangle};
use plotters::style::{Color, RGBColor, WHITE};
use stochastic_light_culling::glam::{Mat3, Vec2, Vec3};
use stochastic_light_culling::{
    Camera, Ellipsoid, Error, Ggx, ProjectedEllipsoid, Schlick, Tight, TileGrid,
};

use crate::section::circle;
use crate::sheet::{Area, FINE, Outcome, Placed, fine, svg as sheet, write};
use crate::stage::{SEED, Stage, ring};

const SIZE: [u32; 2] = [928, 522];
const TILE: u32 = 29;
const TITLE: i32 = 34;
const SHOWN: RGBColor = RGBColor(86, 180, 233);
const CHOSEN: RGBColor = RGBColor(255, 214, 90);

pub fn svg(coarse: u32) -> Result<String, String> {
    let said = |error: Error| error.to_string();
    let scene = ring()?;
    let size = SIZE.map(|side| side / coarse);
    let stage = Stage::new(&scene, size, 1, 0.001).map_err(said)?;
    let picture = finished(&stage, &scene, size).map_err(said)?;

    let tiles = stage.tiles(TILE / coarse).map_err(said)?;
    let view = &tiles.subregions()[0];
    let lights: Vec<Ellipsoid> = (stage.lights.glossy.iter())
        .map(|light| light.vpl.bound_by(Tight, &stage.roulette, light.xi))
        .collect();
    // Those that are whole in the picture.
    let whole = |ellipsoid: &&Ellipsoid| {
        let outline = outline(&stage.camera, ellipsoid);
        let is_inside = |(x, y): &(i32, i32)| {
            let (right, bottom) = fine((SIZE[0] as i32 + 6, SIZE[1] as i32 + TITLE));
            (fine((6, TITLE)).0..right).contains(x) && (fine((6, TITLE)).1..bottom).contains(y)
        };
        !outline.is_empty() && outline.iter().all(is_inside)
    };
    let is_long = |ellipsoid: &&Ellipsoid| ellipsoid.semi_axes().max_element() > 0.2;
    let shown: Vec<&Ellipsoid> = lights.iter().filter(is_long).filter(whole).collect();
    let step = (shown.len() / 16).max(1);
    let shown: Vec<&Ellipsoid> = shown.into_iter().step_by(step).collect();
    let touched = |ellipsoid: &Ellipsoid| -> Vec<[u32; 2]> {
        let Some(projected) = ellipsoid.project(&stage.camera) else {
            return Vec::new();
        };
        let touches = |tile: &[u32; 2]| touches(&projected, &stage.camera, view, *tile);
        view.grid.tiles().filter(touches).collect()
    };
    let by_tiles = shown
        .iter()
        .map(|ellipsoid| (touched(ellipsoid), *ellipsoid));
    let chosen = by_tiles.max_by_key(|(tiles, _)| tiles.len());
    let placed = Placed {
        picture: &picture,
        at: (6, TITLE),
        size: SIZE.into(),
        is_flat: false,
    };
    let count = stage.lights.glossy.len();
    sheet(
        (SIZE[0] + 12, SIZE[1] + TITLE as u32 + 6),
        &[placed],
        |area| {
            let Some((tiles, chosen)) = chosen else {
                return Ok(());
            };
            let title = format!(
                "Ranges of {} of {count} lights on the ring; one of them may touch {} of {} tiles",
                shown.len(),
                tiles.len(),
                view.grid.tiles().count(),
            );
            write(area, title, (8, 8), 18)?;
            for tile in &tiles {
                fill(area, &view.grid, *tile, coarse)?;
            }
            grid(area)?;
            for ellipsoid in &shown {
                line(area, outline(&stage.camera, ellipsoid), SHOWN, 2)?;
            }
            line(area, outline(&stage.camera, chosen), CHOSEN, 3)
        },
    )
}

/// Whether a light may light what a tile sees.
fn touches(
    projected: &ProjectedEllipsoid,
    camera: &Camera,
    view: &frame::Subregion,
    tile: [u32; 2],
) -> bool {
    let rectangle = camera.tile(&view.grid, tile);
    let intervals = (0..view.depths.intervals()).filter_map(|i| view.interval(tile, i));
    let mut intervals = intervals;
    intervals.any(|depths| projected.touches(&rectangle, &depths))
}

fn finished(
    stage: &Stage,
    scene: &common::scene::Scene,
    size: [u32; 2],
) -> Result<image::RgbImage, Error> {
    let frame = stage.frame();
    let pixels = stage.tiles(16)?;
    let tiling = [Tiling {
        tiles: &pixels,
        refined: false,
    }];
    let lights = &stage.lights;
    let tight = BoundKind::Tight;
    let glossy =
        frame::measure_glossy(&frame, &tiling, &stage.camera, &lights.glossy, tight, || ())?;
    let diffuse = frame::measure_diffuse(&frame, &tiling, &stage.camera, &lights.diffuse, || ())?;
    let noisy = [&glossy[0], &diffuse[0]].map(|measured| &*measured.shaded.irradiance);
    let [glossy, diffuse] = frame::cross_bilateral(&stage.surfaces, noisy, || ());
    let irradiance: Vec<Vec3> = glossy.iter().zip(diffuse).map(|(a, b)| a + b).collect();
    let finish = Finish {
        scene,
        tracer: &stage.tracer,
        camera: &stage.camera,
        frame: &frame,
        lights,
        gloss: Gloss::new(Ggx::new(0.1)?, Schlick::new(0.9)?),
        seed: SEED,
    };
    let radiance = finish.radiance(&irradiance, || ())?;
    // Darker than it is, so that lines are seen on it.
    let dimmed: Vec<Vec3> = radiance.iter().map(|radiance| 0.45 * radiance).collect();
    Ok(tone_mapped(size, &dimmed, Exposure::of(&radiance)))
}

fn fill(area: &Area, grid: &TileGrid, tile: [u32; 2], coarse: u32) -> Outcome {
    let pixels = grid.pixels(tile);
    let at = |[x, y]: [u32; 2]| fine(((x * coarse) as i32 + 6, (y * coarse) as i32 + TITLE));
    let ends = [at(pixels.min), at(pixels.max)];
    area.draw(&Rectangle::new(ends, CHOSEN.mix(0.4).filled()))
}

fn grid(area: &Area) -> Outcome {
    let (width, height) = (SIZE[0] as i32, SIZE[1] as i32);
    let faint = WHITE.mix(0.35).stroke_width(FINE as u32);
    for x in (0..=width).step_by(TILE as usize) {
        let line = [(6 + x, TITLE), (6 + x, TITLE + height)].map(fine);
        area.draw(&PathElement::new(line, faint))?;
    }
    for y in (0..=height).step_by(TILE as usize) {
        let line = [(6, TITLE + y), (6 + width, TITLE + y)].map(fine);
        area.draw(&PathElement::new(line, faint))?;
    }
    Ok(())
}

fn line(area: &Area, points: Vec<(i32, i32)>, color: RGBColor, width: i32) -> Outcome {
    let style = color.stroke_width((FINE * width) as u32);
    area.draw(&PathElement::new(points, style))
}

/// The outline of an ellipsoid as the camera sees it: the image of the circle on which lines from the eye touch the
/// unit sphere that it is an image of. Nothing if the eye is inside, or part of it is behind the eye.
fn outline(camera: &Camera, ellipsoid: &Ellipsoid) -> Vec<(i32, i32)> {
    let axes = ellipsoid.rotation() * Mat3::from_diagonal(ellipsoid.semi_axes());
    let eye = axes.inverse() * (camera.to_world_space(Vec3::ZERO) - ellipsoid.center());
    let distance = eye.length();
    if distance <= 1.0 {
        return Vec::new();
    }
    let toward = eye / distance;
    let (right, up) = toward.any_orthonormal_pair();
    let radius = (1.0 - 1.0 / (distance * distance)).sqrt();
    // The slopes of the upper right corner of the picture, whose middle is the viewing direction.
    let corner = 2.0 * camera.point_in_pixel([2, 2], [1, 0], 1.0).truncate();
    let half = 0.5 * FINE as f32 * Vec2::new(SIZE[0] as f32, SIZE[1] as f32);
    let (left, top) = fine((6, TITLE));
    let points = circle().map(|unit| {
        let on_sphere = toward / distance + radius * (unit.x * right + unit.y * up);
        let seen = camera.to_camera_space(ellipsoid.center() + axes * on_sphere);
        let place = seen.truncate() / seen.z / corner;
        let pixel = half + half * Vec2::new(place.x, -place.y);
        (seen.z > 0.0).then_some((left + pixel.x as i32, top + pixel.y as i32))
    });
    points.collect::<Option<_>>().unwrap_or_default()
}
