//! How far the lobes themselves are from GGX, over roughness and angle of incidence.

use image::{Rgb, RgbImage};
use rayon::prelude::*;
use support::ltc_errors::LtcErrors;

use super::Study;
use crate::figure::{Axis, Figure, Line, Look, Panel, Point, Series};
use crate::sheet::Sheet;
use crate::subject::Effort;

/// Without a Fresnel factor, and a dielectric.
const REFLECTANCES: [f64; 2] = [1.0, 0.04];
/// Those of the figure and of the table for people.
const ROUGHNESSES: [f64; 6] = [1.0, 0.7, 0.4, 0.2, 0.1, 0.05];
const DEGREES: [f64; 6] = [0.0, 30.0, 45.0, 60.0, 75.0, 85.0];
/// Pixels of the picture to a cell.
const CELL: u32 = 6;
/// Between two errors lies a black line.
const LINES: [f64; 6] = [0.01, 0.02, 0.05, 0.1, 0.2, 0.5];

/// The errors of a cell of the grid over √α and √(1 − cosθ).
struct Cell {
    place: [usize; 2],
    f0: f64,
    alpha: f64,
    degrees: f64,
    errors: LtcErrors,
}

pub fn make(effort: &Effort) -> Study {
    let (size, nodes) = if effort.is_quick { (8, 24) } else { (64, 64) };
    let cells: Vec<Cell> = (0..REFLECTANCES.len() * size * size)
        .into_par_iter()
        .map(|at| {
            let place = [at / size % size, at % size];
            // In the middle of cells, where interpolation counts.
            let [root, share] = place.map(|i| (i as f64 + 0.5) / size as f64);
            let (alpha, degrees) = (root * root, (1.0 - share * share).acos().to_degrees());
            let f0 = REFLECTANCES[at / (size * size)];
            Cell {
                place,
                f0,
                alpha,
                degrees,
                errors: errors(alpha, degrees, f0, nodes),
            }
        })
        .collect();
    let mut sheet = Sheet::new(&[
        "alpha",
        "incidence_degrees",
        "f0",
        "relative_l2",
        "rmse",
        "energy",
    ]);
    for cell in &cells {
        sheet.push([
            rounded(cell.alpha),
            rounded(cell.degrees),
            cell.f0.into(),
            rounded(cell.errors.relative_l2),
            rounded(cell.errors.rmse),
            rounded(cell.errors.energy),
        ]);
    }
    Study {
        name: "ltsd_fit",
        caption: "The relative L2 error of a transformed cosine over the hemisphere. Right in the picture is \
                  rougher, by √α from 0 to 1, and up is more grazing, by √(1 − cosθ) from 0 to 1; left is \
                  F = 1, right F0 = 0.04. From dark to bright the error grows from 0.1 % to 100 %, with a \
                  line at 1, 2, 5, 10, 20 and 50 %. In the table, the energy is that of the lobe over \
                  GGX's, least and most over all cells.",
        summary: Some(summary(&cells, nodes)),
        picture: Some(picture(&cells, size)),
        figure: figure(nodes),
        sheet,
    }
}

fn errors(alpha: f64, degrees: f64, f0: f64, nodes: usize) -> LtcErrors {
    LtcErrors::of(alpha, degrees, f0, nodes).expect("the study chooses them in range")
}

/// With four digits, which are as many as mean something.
fn rounded(x: f64) -> crate::sheet::Cell {
    format!("{x:.3e}").parse::<f64>().unwrap_or(x).into()
}

/// By angle, and the energy.
fn summary(cells: &[Cell], nodes: usize) -> Sheet {
    let mut sheet = Sheet::new(&[
        "f0",
        "incidence_degrees",
        "α = 1",
        "0.7",
        "0.4",
        "0.2",
        "0.1",
        "0.05",
        "least energy",
        "most energy",
    ]);
    for f0 in REFLECTANCES {
        let energies = || {
            cells
                .iter()
                .filter(|cell| cell.f0 == f0)
                .map(|cell| cell.errors.energy)
        };
        for degrees in DEGREES {
            let [a, b, c, d, e, f] =
                ROUGHNESSES.map(|alpha| errors(alpha, degrees, f0, nodes).relative_l2.into());
            let ends = [
                energies().fold(f64::INFINITY, f64::min),
                energies().fold(0.0, f64::max),
            ];
            let [least, most] = ends.map(|energy| format!("{energy:.4}").into());
            sheet.push([f0.into(), degrees.into(), a, b, c, d, e, f, least, most]);
        }
    }
    sheet
}

fn picture(cells: &[Cell], size: usize) -> RgbImage {
    let side = CELL * size as u32;
    let mut picture = RgbImage::from_pixel(2 * side + CELL, side, Rgb([255; 3]));
    let class = |error: f64| LINES.iter().filter(|line| **line <= error).count();
    let at =
        |panel: usize, [i, j]: [usize; 2]| cells[(panel * size + i) * size + j].errors.relative_l2;
    for (k, cell) in cells.iter().enumerate() {
        let (panel, [i, j]) = (k / (size * size), cell.place);
        let error = cell.errors.relative_l2;
        let share = ((error / 1e-3).log10() / 3.0).clamp(0.0, 1.0);
        let color = colorous::VIRIDIS.eval_continuous(share).as_array();
        let left = panel as u32 * (side + CELL) + CELL * i as u32;
        let top = side - CELL * (j as u32 + 1);
        // The first column and the last row of pixels of a cell tell it from its neighbours.
        let differs = |other: [usize; 2]| class(at(panel, other)) != class(error);
        let [at_left, at_foot] = [
            i > 0 && differs([i.saturating_sub(1), j]),
            j > 0 && differs([i, j.saturating_sub(1)]),
        ];
        for x in 0..CELL {
            for y in 0..CELL {
                let is_line = at_left && x == 0 || at_foot && y == CELL - 1;
                let color = if is_line { [0; 3] } else { color };
                picture.put_pixel(left + x, top + y, Rgb(color));
            }
        }
    }
    picture
}

fn figure(nodes: usize) -> Figure {
    let panels = REFLECTANCES.map(|f0| Panel {
        title: if f0 == 1.0 {
            "F = 1".into()
        } else {
            format!("F0 = {f0}")
        },
        x: Axis::linear("angle of incidence (°)"),
        y: Axis::log("relative L2 error"),
        series: ROUGHNESSES
            .iter()
            .enumerate()
            .map(|(color, alpha)| Series {
                name: format!("α = {alpha}"),
                look: Look {
                    color,
                    line: Line::Solid,
                },
                points: (0..18)
                    .map(|i| 5.0 * f64::from(i))
                    .map(|degrees| {
                        Point::new(degrees, errors(*alpha, degrees, f0, nodes).relative_l2)
                    })
                    .collect(),
            })
            .collect(),
    });
    Figure {
        title: "Transformed cosines against GGX: the lobes".into(),
        subtitle: "over the hemisphere, height-correlated masking, Schlick's factor".into(),
        panels: panels.into(),
    }
}
