//! Tables, curves and the picture of the study.

use common::picture::{Exposure, tone_mapped};
use image::{RgbImage, imageops};
use stochastic_light_culling::glam::Vec3;

use super::errors::DISTANCES;
use super::way::Way;
use super::{FRAMES, Row};
use crate::figure::{Axis, Line, Look, Panel, Point, Series};
use crate::sheet::Sheet;
use crate::study::INTERLEAVE;
use crate::subject::Subject;

/// A row for each way.
pub fn sheet_of(subject: &Subject, columns: Vec<(Way, Vec<Vec<Vec3>>)>) -> RgbImage {
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

pub fn sheet(rows: &[Row]) -> Sheet {
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

pub fn summary(rows: &[Row]) -> Sheet {
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

pub fn panels(subject: &Subject, rows: &[Row]) -> Vec<Panel> {
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
