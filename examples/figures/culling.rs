//! The same frame by three bounds, as lights per pixel.

use common::frame::{self, BoundKind, Tiling};
use image::{Rgb, RgbImage};
use plotters::element::PathElement;
use plotters::style::{Color, RGBColor};
use stochastic_light_culling::Error;

use crate::sheet::{Area, FINE, INK, Outcome, Placed, fine, svg as sheet, write};
use crate::stage::{Stage, VPLS, ring};

const BOUNDS: [(BoundKind, &str); 3] = [
    (BoundKind::Sphere, "sphere (2016)"),
    (BoundKind::Spheroid, "spheroid (2017)"),
    (BoundKind::Tight, "tight ellipsoid"),
];
/// The size of a panel, of which a picture has twice as many pixels each way.
const PANEL: [u32; 2] = [320, 180];
const GAP: i32 = 8;
const TOP: i32 = 46;
const TITLE: i32 = 26;
/// The scale ends at 10³ lights.
const DECADES: f64 = 3.0;
/// So few colours that a picture is small, and so many that steps are hardly seen.
const COLORS: f64 = 36.0;

pub fn svg(coarse: u32) -> Result<String, String> {
    let said = |error: Error| error.to_string();
    let scene = ring()?;
    let size = PANEL.map(|side| 2 * side / coarse);
    let stage = Stage::new(&scene, size, 4, 0.001).map_err(said)?;
    let [tiles, pixels] = [16, 1].map(|size| stage.tiles(size));
    let (tiles, pixels) = (tiles.map_err(said)?, pixels.map_err(said)?);
    let tilings =
        [(&tiles, false), (&pixels, true)].map(|(tiles, refined)| Tiling { tiles, refined });
    let frame = stage.frame();
    let mut panels = Vec::new();
    let mut contributing = 0.0;
    for (bound, name) in BOUNDS {
        let lights = &stage.lights.glossy;
        let measured = frame::measure_glossy(&frame, &tilings, &stage.camera, lights, bound, || ());
        for (row, measured) in measured.map_err(said)?.iter().enumerate() {
            let counts = &measured.shaded.evaluated;
            let mean = frame::mean_over_surfaces(&stage.surfaces, counts);
            contributing =
                frame::mean_over_surfaces(&stage.surfaces, &measured.shaded.contributing);
            panels.push((row, name, mean, map(counts, size)));
        }
    }
    let column = |i: usize| GAP + (i / 2) as i32 * (PANEL[0] as i32 + GAP);
    let top = |row: usize| TOP + TITLE + row as i32 * (PANEL[1] as i32 + TITLE + GAP);
    let bottom = top(1) + PANEL[1] as i32 + 2 * GAP;
    let width = GAP + 3 * (PANEL[0] as i32 + GAP);
    let bar_width = (width - 2 * GAP) as u32;
    let bar = bar(bar_width);
    let maps = panels.iter().enumerate();
    let maps = maps.map(|(i, (row, _, _, picture))| Placed {
        picture,
        at: (column(i), top(*row)),
        size: PANEL.into(),
        is_flat: true,
    });
    let bar = Placed {
        picture: &bar,
        at: (GAP, bottom),
        size: (bar_width, 14),
        is_flat: true,
    };
    let placed: Vec<Placed> = maps.chain([bar]).collect();
    sheet((width as u32, bottom as u32 + 46), &placed, |area| {
        let title = format!(
            "Glossy lights that a pixel evaluates: {VPLS} rays, interleaved 4×4; {contributing:.1} contribute"
        );
        write(area, title, (GAP, 12), 17)?;
        for (i, (row, name, mean, _)) in panels.iter().enumerate() {
            let list = if *row == 0 { "16×16 tiles" } else { "pixels" };
            let title = format!("{name}, {list}: {mean:.1}");
            write(area, title, (column(i), top(*row) - TITLE + 5), 16)?;
        }
        scale(area, (GAP, bottom + 14), width - 2 * GAP)
    })
}

/// The colour of a count, on a logarithmic scale from one on; less is black.
fn color(count: f64) -> RGBColor {
    let place = (count.max(0.5).log10() / DECADES).clamp(0.0, 1.0);
    let step = (place * COLORS).round() / COLORS;
    let color = colorous::INFERNO.eval_continuous(0.06 + 0.94 * step);
    if count < 0.5 {
        RGBColor(0, 0, 0)
    } else {
        RGBColor(color.r, color.g, color.b)
    }
}

/// The map at half the size, of the means over four by four pixels: one of each subregion.
fn map(counts: &[u32], [width, height]: [u32; 2]) -> RgbImage {
    RgbImage::from_fn(width / 2, height / 2, |x, y| {
        let rows = (2 * y).min(height - 4)..(2 * y + 4).min(height);
        let around = rows.flat_map(|y| {
            let columns = (2 * x).min(width - 4)..(2 * x + 4).min(width);
            columns.map(move |x| (y * width + x) as usize)
        });
        let sum: u32 = around.map(|pixel| counts[pixel]).sum();
        let RGBColor(red, green, blue) = color(f64::from(sum) / 16.0);
        Rgb([red, green, blue])
    })
}

/// The colours of counts.
fn bar(width: u32) -> RgbImage {
    RgbImage::from_fn(width, 1, |x, _| {
        let place = (f64::from(x) + 0.5) / f64::from(width);
        let RGBColor(red, green, blue) = color(10_f64.powf(DECADES * place));
        Rgb([red, green, blue])
    })
}

/// The numbers below them.
fn scale(area: &Area, (left, top): (i32, i32), width: i32) -> Outcome {
    for count in [1, 3, 10, 30, 100, 300, 1000] {
        let place = f64::from(count).log10() / DECADES;
        let x = left + (f64::from(width - 1) * place) as i32;
        let tick = vec![fine((x, top)), fine((x, top + 6))];
        area.draw(&PathElement::new(tick, INK.stroke_width(FINE as u32)))?;
        let (shift, unit) = match count {
            1 => (0, " light per pixel"),
            1000 => (36, ""),
            _ => (10, ""),
        };
        write(area, format!("{count}{unit}"), (x - shift, top + 8), 15)?;
    }
    Ok(())
}
