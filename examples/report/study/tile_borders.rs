//! (l) One decision for all pixels of a tile: what is seen of the tiles' borders, and what removes them.

use std::collections::BTreeMap;

use common::frame::{Frame, GlossyLight, Path, cross_bilateral, redraw};
use common::picture::{Exposure, tone_mapped};
use image::{RgbImage, imageops};
use rayon::prelude::*;
use stochastic_light_culling::{Blind, ReceiverCluster, Seed, TileProbability, Xi, glam::Vec3};

use super::{F0, INTERLEAVE, ROUGHNESS, Study};
use crate::baseline::fewer;
use crate::figure::{Axis, Figure, Line, Look, Panel, Point, Series};
use crate::method::Stage;
use crate::sheet::Sheet;
use crate::subject::{Gloss, Subject};

/// Pixels of a subregion.
const TILE: u32 = 16;
/// Of exponential depth intervals in a factor of e.
const INTERVALS: f32 = 4.0;
const WIDTHS: [u32; 2] = [1, INTERLEAVE];
const FRAMES: [u32; 2] = [1, 16];
/// Lights in the list of a pixel, in the mean: δ is such that there are so many.
const LISTED: f64 = 24.0;
/// The greatest distance of pixels whose errors are compared.
const DISTANCES: usize = 32;

/// Which pixels share a decision, and by which ξ.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Way {
    /// None: each decides by its own probability.
    Pixel,
    /// Those of a tile, by one ξ for each light, from its rank.
    Tile,
    /// The same, by a hashed ξ.
    Hashed,
    /// By the ranked ξ, with a grid that is moved from frame to frame.
    Jittered,
    /// By a ξ hashed from light and tile.
    HashedPerTile,
    /// By a ranked ξ, with a seed for each tile.
    RankedPerTile,
    /// The same, with a grid that is moved from frame to frame.
    JitteredPerTile,
}

impl Way {
    const ALL: [Self; 7] = [
        Self::Pixel,
        Self::Tile,
        Self::Hashed,
        Self::Jittered,
        Self::HashedPerTile,
        Self::RankedPerTile,
        Self::JitteredPerTile,
    ];

    fn name(self) -> &'static str {
        match self {
            Self::Pixel => "by pixel",
            Self::Tile => "by tile",
            Self::Hashed => "by tile, hashed",
            Self::Jittered => "by tile, jittered",
            Self::HashedPerTile => "by tile, hashed per tile",
            Self::RankedPerTile => "by tile, ranked per tile",
            Self::JitteredPerTile => "by tile, ranked per tile, jittered",
        }
    }

    /// By how many pixels the grid of a frame is moved.
    fn offset(self, seed: Seed, frame: u32) -> [u32; 2] {
        match self {
            Self::Jittered | Self::JitteredPerTile => seed
                .frame(frame)
                .hashed_point(0)
                .map(|x| (x * TILE as f32) as u32),
            _ => [0; 2],
        }
    }

    /// The ξ of a light in a tile, for the light's index, its rank within its subregion and its ranked ξ.
    fn xi(self, seed: Seed, frame: u32, tile: u32, [light, rank]: [u32; 2], ranked: Xi) -> Xi {
        match self {
            Self::Pixel | Self::Tile | Self::Jittered => ranked,
            Self::Hashed => seed.frame(frame).hashed_xi(light),
            Self::HashedPerTile => seed.subregion(tile).frame(frame).hashed_xi(light),
            Self::RankedPerTile | Self::JitteredPerTile => {
                seed.subregion(tile).frame(frame).xi_of_rank(rank)
            }
        }
    }
}

/// A depth interval of a tile.
struct Tile {
    subregion: u32,
    /// In the image.
    pixels: Vec<usize>,
    /// The upper bound of the radiance over δ, of each light of the subregion.
    greatest: Vec<f32>,
}

/// The tiles of a grid that is moved by `offset` pixels.
fn tiles(frame: &Frame, lights: &[GlossyLight], offset: [u32; 2]) -> Vec<Tile> {
    let interleave = &frame.interleave;
    let width = frame.surfaces.image_size[0];
    let mut groups = BTreeMap::<_, Vec<usize>>::new();
    for (i, surface) in frame.surfaces.surfaces.iter().enumerate() {
        if !surface.is_sky() {
            let pixel = [i as u32 % width, i as u32 / width];
            let (subregion, local) = interleave.split_pixel(pixel);
            let [x, y] = [0, 1].map(|i| (local[i] + offset[i]) / TILE);
            let interval = (surface.depth.ln() * INTERVALS).floor() as i32;
            let group = groups.entry((subregion, y, x, interval));
            group.or_default().push(i);
        }
    }
    let groups: Vec<_> = groups.into_iter().collect();
    let tile = |((subregion, ..), pixels): ((u32, u32, u32, i32), Vec<usize>)| {
        let positions = pixels.iter().map(|i| frame.surfaces.surfaces[*i].position);
        let receivers = ReceiverCluster::of(positions.map(|position| (position, Blind)));
        let receivers = receivers.expect("a group has a pixel");
        let count = interleave.lights_in(subregion, lights.len() as u32);
        let greatest = |local: u32| {
            let light = &lights[interleave.join_light(subregion, local) as usize].vpl;
            let least = frame.least_distance_squared;
            receivers.greatest_radiance(light, &frame.roulette, least)
        };
        Tile {
            subregion,
            pixels,
            greatest: (0..count).map(greatest).collect(),
        }
    };
    groups.into_par_iter().map(tile).collect()
}

/// The δ that gives a pixel [`LISTED`] lights in the mean, for tiles whose δ is less.
fn delta_of_lists(tiles: &[Tile], delta: f32) -> f32 {
    let pixels = tiles.iter().map(|tile| tile.pixels.len()).sum::<usize>();
    let listed = |delta: f64| {
        let of_tile = |tile: &Tile| {
            let drawn = tile
                .greatest
                .iter()
                .map(|of| (f64::from(*of) / delta).min(1.0));
            drawn.sum::<f64>() * tile.pixels.len() as f64
        };
        tiles.par_iter().map(of_tile).sum::<f64>() / pixels.max(1) as f64
    };
    // How many times greater.
    let (mut low, mut high) = (1.0_f64, 1e8_f64);
    for _ in 0..30 {
        let middle = (low * high).sqrt();
        if listed(middle) > LISTED {
            low = middle;
        } else {
            high = middle;
        }
    }
    delta * high as f32
}

/// The irradiance of all pixels in a frame, and the lights in the list of a pixel.
fn light(
    way: Way,
    frame: &Frame,
    lights: &[GlossyLight],
    tiles: &[Tile],
    (seed, number): (Seed, u32),
) -> (Vec<Vec3>, f64) {
    let interleave = &frame.interleave;
    let lit = tiles.par_iter().enumerate().map(|(index, tile)| {
        let drawn = (0..).zip(&tile.greatest).filter_map(|(local, greatest)| {
            let p = TileProbability::bound().probability(*greatest, 0.0);
            let i = interleave.join_light(tile.subregion, local);
            let light = &lights[i as usize];
            let xi = way.xi(seed, number, index as u32, [i, local], light.xi);
            (p > 0.0 && xi.get() <= p).then_some((light, 1.0 / p))
        });
        let drawn: Vec<_> = drawn.collect();
        let at = |pixel: &usize| {
            let surface = &frame.surfaces.surfaces[*pixel];
            let mut sum = Vec3::ZERO;
            for (light, weight) in &drawn {
                let path = Path::new(light, surface, frame.least_distance_squared);
                let radiance = if way == Way::Pixel {
                    let Path {
                        intensity,
                        distance_squared,
                        ..
                    } = path;
                    frame
                        .roulette
                        .estimate(intensity, distance_squared, light.xi)
                } else {
                    path.intensity / path.distance_squared * weight
                };
                sum += radiance * path.cosine * light.tint;
            }
            (*pixel, sum)
        };
        let sums: Vec<_> = tile.pixels.iter().map(at).collect();
        (sums, drawn.len() * tile.pixels.len())
    });
    let lit: Vec<_> = lit.collect();
    let mut image = vec![Vec3::ZERO; frame.surfaces.surfaces.len()];
    let (mut listed, mut pixels) = (0, 0);
    for (sums, count) in lit {
        listed += count;
        pixels += sums.len();
        for (pixel, sum) in sums {
            image[pixel] = sum;
        }
    }
    (image, listed as f64 / pixels.max(1) as f64)
}

/// How errors of pixels go together.
#[derive(Clone, Default)]
struct Errors {
    /// Of squared errors over the squared mean, a sum for each picture.
    relative_squares: Vec<f64>,
    /// For each distance: products of errors of two pixels in a row, and the mean of their squares.
    products: [[f64; 2]; DISTANCES],
    /// Squared steps of the error between neighbours of a subregion across a border, and within tiles.
    steps: [[f64; 2]; 2],
}

impl Errors {
    /// Adds a picture, made with a grid that is moved by `offset`. Errors are relative to the light that there is,
    /// and to its mean, so that neither bright nor dark pixels decide alone.
    fn add(&mut self, frame: &Frame, image: &[Vec3], truth: &[Vec3], offset: [u32; 2]) {
        let interleave = &frame.interleave;
        let [width, height] = frame.surfaces.image_size.map(|n| n as usize);
        let seen = |i: usize| !frame.surfaces.surfaces[i].is_sky();
        let brightness = |light: Vec3| f64::from(light.element_sum()) / 3.0;
        let pixels: Vec<usize> = (0..image.len()).filter(|i| seen(*i)).collect();
        let count = pixels.len().max(1) as f64;
        let mean = pixels.iter().map(|i| brightness(truth[*i])).sum::<f64>() / count;
        let error = |i: usize| brightness(image[i]) - brightness(truth[i]);
        let squares = pixels.iter().map(|i| error(*i).powi(2)).sum::<f64>() / count;
        self.relative_squares.push(squares / (mean * mean));

        let relative = |i: usize| error(i) / (brightness(truth[i]) + mean);
        let errors: Vec<Option<f64>> = (0..image.len())
            .map(|i| seen(i).then(|| relative(i)))
            .collect();
        let step = interleave.width() as usize;
        for (i, one) in errors.iter().enumerate() {
            let (Some(one), [x, y]) = (one, [i % width, i / width]) else {
                continue;
            };
            for distance in 1..=DISTANCES.min(width - 1 - x) {
                if let Some(other) = errors[i + distance] {
                    let [product, square] = &mut self.products[distance - 1];
                    *product += one * other;
                    *square += 0.5 * (one * one + other * other);
                }
            }
            let local = interleave.split_pixel([x as u32, y as u32]).1;
            let neighbours = [(x + step < width, step), (y + step < height, step * width)];
            for (axis, (has_one, away)) in neighbours.into_iter().enumerate() {
                if let (true, Some(other)) = (has_one, errors.get(i + away).copied().flatten()) {
                    let is_last = (local[axis] + offset[axis]) % TILE == TILE - 1;
                    let [square, pairs] = &mut self.steps[usize::from(!is_last)];
                    *square += (one - other).powi(2);
                    *pairs += 1.0;
                }
            }
        }
    }

    fn relative_rmse(&self) -> f64 {
        let count = self.relative_squares.len().max(1) as f64;
        (self.relative_squares.iter().sum::<f64>() / count).sqrt()
    }

    /// The squared step across a border over that within tiles: 1 where no border shows.
    fn border_contrast(&self) -> f64 {
        let [across, within] = self.steps.map(|[square, pairs]| square / pairs.max(1.0));
        across / within
    }

    fn correlation(&self, distance: usize) -> f64 {
        let [product, square] = self.products[distance - 1];
        product / square
    }
}

/// Pictures of one way.
struct Row<'a> {
    scene: &'a str,
    width: u32,
    is_denoised: bool,
    frames: u32,
    way: Way,
    lights_per_pixel: f64,
    errors: Errors,
}

pub fn make(subjects: &[Subject], done: &dyn Fn()) -> Study {
    let small: Vec<Subject> = subjects.iter().map(Subject::half_as_large).collect();
    let (mut rows, mut picture) = (Vec::new(), None);
    for subject in &small {
        let mut columns = Vec::new();
        for width in WIDTHS {
            let stage = Stage::new(subject, Gloss::new(ROUGHNESS, F0), width);
            for way in Way::ALL {
                let (of_way, images) = measure(&stage, way);
                rows.extend(of_way);
                columns.push((way, images));
            }
        }
        picture.get_or_insert_with(|| sheet_of(subject, columns));
        done();
    }
    let panels = small.iter().flat_map(|subject| panels(subject, &rows));
    let [width, height] = small[0].effort.size;
    Study {
        name: "tile_borders",
        caption: "Lights drawn for tiles of 16×16 pixels, without knowing receivers, with the δ that gives a pixel a \
                  list of 24 lights; of these lists each pixel accepts by its own probability, or takes all. The figure has the correlation \
                  of the errors of two pixels of one frame, by their distance: a tile shows as one that stays high \
                  up to 16 pixels, or up to 64 with interleaving. In the table, border contrast is the mean squared \
                  step of the error across a border of tiles over that within, 1 where no border shows. The picture \
                  has a row for each way, in the order of the table: one frame, the magnitude of its error and the \
                  mean of 16 frames; then one frame of 4×4 subregions, denoised.",
        sheet: sheet(&rows),
        summary: Some(summary(&rows)),
        picture,
        figure: Figure {
            title: "Lights drawn for tiles: how far errors go together".into(),
            subtitle: format!(
                "{width}×{height}, {} rays, α = {ROUGHNESS}, F0 = {F0}, lists of {LISTED} lights, glossy lights alone",
                small[0].effort.vpls
            ),
            panels: panels.collect(),
        },
    }
}

/// Measures frames, and means of frames, without and with denoising. Returns some of the pictures too.
fn measure<'a>(stage: &Stage<'a>, way: Way) -> (Vec<Row<'a>>, Vec<Vec<Vec3>>) {
    let subject = stage.subject;
    // The least δ that there may be.
    let frame = stage.frame(1e-6);
    let mut lights = stage.lights(0);
    let frame = stage.frame(delta_of_lists(
        &tiles(&frame, &lights, [0; 2]),
        frame.roulette.delta(),
    ));
    let all = fewer::light(&frame, &lights, 1, 0);
    let [denoised] = cross_bilateral(&subject.surfaces, [&all], || ());
    let truths = [all, denoised];
    let mut errors = [(); 2].map(|()| FRAMES.map(|_| Errors::default()));
    let (mut images, mut listed) = (Vec::new(), 0.0);
    let unmoved = tiles(&frame, &lights, [0; 2]);
    let seeds = if subject.effort.is_quick { 2 } else { 4 };
    for seed in 0..seeds {
        let seed = Seed(subject.seed_of(seed));
        let mut sum = vec![Vec3::ZERO; truths[0].len()];
        for number in 0..FRAMES[1] {
            redraw(&mut lights, &stage.interleave, seed, number);
            let offset = way.offset(seed, number);
            let (image, count) = if offset == [0; 2] {
                light(way, &frame, &lights, &unmoved, (seed, number))
            } else {
                let moved = tiles(&frame, &lights, offset);
                light(way, &frame, &lights, &moved, (seed, number))
            };
            listed += count / f64::from(seeds * FRAMES[1]);
            for (sum, image) in sum.iter_mut().zip(image) {
                *sum += image;
            }
            let Some(i) = FRAMES.iter().position(|frames| *frames == number + 1) else {
                continue;
            };
            let mean: Vec<Vec3> = sum.iter().map(|sum| sum / FRAMES[i] as f32).collect();
            let [denoised] = cross_bilateral(&subject.surfaces, [&mean], || ());
            // A mean has borders of its own where no grid moves.
            let offset = if i == 0 { offset } else { [0; 2] };
            errors[0][i].add(&frame, &mean, &truths[0], offset);
            errors[1][i].add(&frame, &denoised, &truths[1], offset);
            if images.len() < 4 {
                images.extend([mean, denoised]);
            }
        }
    }
    let mut rows = Vec::new();
    for (is_denoised, errors) in [false, true].into_iter().zip(errors) {
        for (frames, errors) in FRAMES.into_iter().zip(errors) {
            rows.push(Row {
                scene: subject.name,
                width: stage.interleave.width(),
                is_denoised,
                frames,
                way,
                lights_per_pixel: listed,
                errors,
            });
        }
    }
    images.push(truths[0].clone());
    (rows, images)
}

/// A row for each way.
fn sheet_of(subject: &Subject, columns: Vec<(Way, Vec<Vec<Vec3>>)>) -> RgbImage {
    let [width, height] = subject.effort.size;
    let mut picture = RgbImage::new(4 * width, Way::ALL.len() as u32 * height);
    let exposure = Exposure::of(&subject.radiance(&columns[0].1[4]));
    for (i, (way, images)) in columns.into_iter().enumerate() {
        let row = Way::ALL.iter().position(|of| *of == way).unwrap_or(0) as u32;
        let is_interleaved = i >= Way::ALL.len();
        let truth = &images[4];
        let error = images[0].iter().zip(truth).map(|(a, b)| (a - b).abs());
        let shown = if is_interleaved {
            vec![(3, images[1].clone())]
        } else {
            vec![
                (0, images[0].clone()),
                (1, error.collect()),
                (2, images[2].clone()),
            ]
        };
        for (column, image) in shown {
            let image = tone_mapped([width, height], &subject.radiance(&image), exposure);
            let place = [column * width, row * height].map(i64::from);
            imageops::replace(&mut picture, &image, place[0], place[1]);
        }
    }
    picture
}

fn yes_or_no(is_so: bool) -> &'static str {
    if is_so { "yes" } else { "no" }
}

fn sheet(rows: &[Row]) -> Sheet {
    let mut sheet = Sheet::new(&[
        "scene",
        "interleave",
        "denoised",
        "frames",
        "method",
        "lights_per_pixel",
        "relative_rmse",
        "border_contrast",
        "distance",
        "correlation",
    ]);
    for row in rows {
        for distance in 1..=DISTANCES {
            sheet.push([
                row.scene.into(),
                row.width.into(),
                yes_or_no(row.is_denoised).into(),
                row.frames.into(),
                row.way.name().into(),
                row.lights_per_pixel.into(),
                row.errors.relative_rmse().into(),
                row.errors.border_contrast().into(),
                (distance as u32).into(),
                row.errors.correlation(distance).into(),
            ]);
        }
    }
    sheet
}

fn summary(rows: &[Row]) -> Sheet {
    let mut sheet = Sheet::new(&[
        "scene",
        "interleave",
        "denoised",
        "frames",
        "method",
        "lights per pixel",
        "RMSE over mean",
        "border contrast",
        "correlation at 8 pixels",
        "at 24",
    ]);
    for row in rows {
        let number = |value: f64| format!("{value:.3}");
        sheet.push([
            row.scene.into(),
            row.width.into(),
            yes_or_no(row.is_denoised).into(),
            row.frames.into(),
            row.way.name().into(),
            format!("{:.1}", row.lights_per_pixel).into(),
            number(row.errors.relative_rmse()).into(),
            number(row.errors.border_contrast()).into(),
            number(row.errors.correlation(8)).into(),
            number(row.errors.correlation(24)).into(),
        ]);
    }
    sheet
}

fn panels(subject: &Subject, rows: &[Row]) -> Vec<Panel> {
    let shown = [(1, false), (INTERLEAVE, false), (INTERLEAVE, true)];
    let panel = |(width, is_denoised)| {
        let of_panel = rows.iter().filter(|row| {
            (row.scene, row.frames) == (subject.name, FRAMES[0])
                && (row.width, row.is_denoised) == (width, is_denoised)
                && !matches!(row.way, Way::Jittered | Way::JitteredPerTile)
        });
        let series = of_panel.map(|row| Series {
            name: row.way.name().into(),
            look: Look {
                color: row.way as usize,
                line: Line::Solid,
            },
            points: (1..=DISTANCES)
                .map(|distance| Point::new(distance as f64, row.errors.correlation(distance)))
                .collect(),
        });
        let denoised = if is_denoised { ", denoised" } else { "" };
        Panel {
            title: format!("{}, {width}×{width}{denoised}", subject.name),
            x: Axis::linear("distance in pixels"),
            y: Axis::linear("correlation of errors"),
            series: series.collect(),
        }
    };
    shown.into_iter().map(panel).collect()
}
