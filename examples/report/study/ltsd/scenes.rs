//! Frames of scenes, and of the ring with more and more lights [Xia et al. 2023, Fig. 4, Fig. 5].

use common::frame::Slicing;
use stochastic_light_culling::{GgxLobe, LtcLobe, Schlick};

use super::model::{Group, Lit, Model, Picture, Setting};
use super::{Study, relative_l2, rmse};
use crate::figure::{Axis, Figure, Line, Look, Panel, Point, Series};
use crate::sheet::{Cell, Sheet};
use crate::study::{DELTA, F0, INTERLEAVE, ROUGHNESS, of_any_rays};
use crate::subject::{Gloss, Subject};

/// Of all that is seen.
const RECEIVER: f32 = 0.25;

/// Both models of one frame.
struct Compared {
    /// GGX, then transformed cosines: milliseconds to make, to cull and to shade, and the ratio of the mean over
    /// frames to that without roulette.
    models: [Timed; 2],
    rmse: f64,
    relative_l2: f64,
}

struct Timed {
    name: &'static str,
    make_ms: f64,
    cull_ms: f64,
    shade_ms: f64,
    lights_per_pixel: [f64; 2],
    brightness: f64,
}

impl Timed {
    /// The least times of `rounds`, subregion by subregion; their pictures have other ξ and the same mean as `exact`.
    fn of<M: Model>(rounds: &[Lit], exact: &Picture) -> Self {
        let least = |of: &dyn Fn(&Lit) -> f64| rounds.iter().map(of).fold(f64::INFINITY, f64::min);
        let sum_of_least = |steps: fn(&Lit) -> &[f64]| {
            let subregions = 0..steps(&rounds[0]).len();
            subregions.map(|i| least(&|lit| steps(lit)[i])).sum()
        };
        let sum = |picture: &Picture| picture.iter().flatten().map(|x| f64::from(*x)).sum::<f64>();
        let mean = rounds.iter().map(|lit| sum(&lit.picture)).sum::<f64>() / rounds.len() as f64;
        Self {
            name: M::NAME,
            make_ms: least(&|lit| lit.make_ms),
            cull_ms: sum_of_least(|lit| &lit.cull_ms),
            shade_ms: sum_of_least(|lit| &lit.shade_ms),
            lights_per_pixel: rounds[0].lights_per_pixel,
            brightness: mean / sum(exact),
        }
    }
}

impl Compared {
    fn new(subject: &Subject, rays: u32, [f0, receiver_f0]: [f32; 2]) -> Self {
        let interleave = subject.interleave(INTERLEAVE);
        let tiles = subject.tiles(&interleave, 16, Slicing::ModifiedHalfZ);
        let groups = Group::all(subject, &interleave, &tiles);
        let gloss = [Gloss::new(ROUGHNESS, f0), Gloss::new(RECEIVER, receiver_f0)];
        let frames: Vec<_> = (0..subject.effort.times)
            .map(|repetition| {
                let seed = subject.seed_of(0);
                let mut lights = subject.lights(gloss[0], rays, &interleave, seed).glossy;
                let seed = stochastic_light_culling::Seed(seed);
                common::frame::redraw(&mut lights, &interleave, seed, repetition);
                lights
            })
            .collect();
        let setting = |lights| Setting {
            subject,
            tiles: &tiles,
            groups: &groups,
            interleave,
            lights,
            gloss,
            delta: DELTA,
        };
        // In turn, so that both meet the same disturbances.
        let (mut ggx, mut ltc) = (Vec::new(), Vec::new());
        for lights in &frames {
            ggx.push(setting(lights).light::<GgxLobe<Schlick>>());
            ltc.push(setting(lights).light::<LtcLobe>());
        }
        let whole = setting(&frames[0]);
        let (exact, other) = (whole.exact::<GgxLobe<Schlick>>(), whole.exact::<LtcLobe>());
        let white = white(&exact);
        let seen = |picture: &Picture| -> Picture {
            let seen = picture.iter().zip(&subject.surfaces.surfaces);
            seen.filter(|(_, surface)| !surface.is_sky())
                .map(|(radiance, _)| *radiance)
                .collect()
        };
        let [exact_seen, other_seen] = [&exact, &other].map(seen);
        Self {
            rmse: rmse(other_seen.iter().zip(&exact_seen), white),
            relative_l2: relative_l2(other_seen.iter().zip(&exact_seen)),
            models: [
                Timed::of::<GgxLobe<Schlick>>(&ggx, &exact),
                Timed::of::<LtcLobe>(&ltc, &other),
            ],
        }
    }

    /// The share of GGX's time that transformed cosines save, of shading, and of culling and shading.
    fn saved(&self) -> [f64; 2] {
        let saved = |time: fn(&Timed) -> f64| {
            let [ggx, ltc] = [0, 1].map(|i| time(&self.models[i]));
            1.0 - ltc / ggx
        };
        [
            saved(|model| model.shade_ms),
            saved(|model| model.cull_ms + model.shade_ms),
        ]
    }

    /// The rows of a file, of which `first` is the first cell.
    fn write(&self, first: &Cell, sheet: &mut Sheet) {
        for model in &self.models {
            // A model is as far from itself as roulette makes it, which is not what is asked.
            let rmse = if model.name == "ggx" { 0.0 } else { self.rmse };
            sheet.push([
                first.clone(),
                model.name.into(),
                model.cull_ms.into(),
                model.shade_ms.into(),
                rmse.into(),
            ]);
        }
    }

    /// The rows for people.
    fn summarise(&self, first: &Cell, f0: [f32; 2], sheet: &mut Sheet) {
        let saved = self.saved();
        for model in &self.models {
            let of_ltc = |value: f64| {
                if model.name == "ggx" {
                    "".into()
                } else {
                    Cell::from(value)
                }
            };
            let [listed, accepted] = model.lights_per_pixel;
            sheet.push([
                first.clone(),
                f0[0].into(),
                model.name.into(),
                listed.into(),
                accepted.into(),
                model.make_ms.into(),
                model.cull_ms.into(),
                model.shade_ms.into(),
                of_ltc(100.0 * saved[0]),
                of_ltc(100.0 * saved[1]),
                of_ltc(self.rmse),
                of_ltc(self.relative_l2),
                format!("{:.4}", model.brightness).into(),
            ]);
        }
    }
}

const SUMMARY: [&str; 13] = [
    "picture",
    "f0",
    "model",
    "lights per pixel",
    "accepted",
    "make ms",
    "cull ms",
    "shade ms",
    "saved, shading %",
    "saved, with culling %",
    "rmse",
    "relative_l2",
    "mean over exact",
];

/// The radiance that is shown white: all but the brightest 2 % of the lit pixels are darker.
fn white(picture: &Picture) -> f32 {
    let mut brightest: Vec<f32> = picture
        .iter()
        .map(|rgb| rgb.iter().copied().fold(0.0, f32::max))
        .filter(|radiance| *radiance > 0.0)
        .collect();
    brightest.sort_by(f32::total_cmp);
    *brightest.get(brightest.len() * 98 / 100).unwrap_or(&1.0)
}

/// Metals in all scenes, and dielectrics in the table for people.
pub fn of_scenes(subjects: &[Subject]) -> Study {
    let mut sheet = Sheet::new(&["scene", "model", "cull_ms", "shade_ms", "rmse"]);
    let mut summary = Sheet::new(&SUMMARY);
    let mut panels = Vec::new();
    for subject in subjects {
        let mut series = Vec::new();
        for (f0, name) in [(F0, "metals"), (0.04, "dielectrics")] {
            let compared = Compared::new(subject, subject.effort.vpls, [f0; 2]);
            let cell = Cell::from(subject.name);
            compared.summarise(&cell, [f0; 2], &mut summary);
            if f0 == F0 {
                compared.write(&cell, &mut sheet);
            }
            for (color, model) in compared.models.iter().enumerate() {
                series.push(Series {
                    name: format!("{}, {name}", model.name),
                    look: Look {
                        color,
                        line: if f0 == F0 { Line::Solid } else { Line::Dashed },
                    },
                    points: vec![Point::new(model.cull_ms, model.shade_ms)],
                });
            }
        }
        panels.push(Panel {
            title: subject.name.into(),
            x: Axis::linear("bound and cull (ms)"),
            y: Axis::linear("shade (ms)"),
            series,
        });
    }
    Study {
        name: "ltsd_scenes",
        caption: "All that is seen reflects as glossily as the lights' surfaces do, by the same model. \
                  The error is that of pictures by all lights, without roulette, of linear values up to 1, where all but 2 % \
                  of the lit pixels are darker than 1. On one core, the least time of each subregion in several frames, with tiles of 16×16 pixels; \
                  the time to make receivers counts as shading.",
        sheet,
        summary: Some(summary),
        picture: None,
        figure: Figure {
            title: "Transformed cosines against GGX: scenes".into(),
            subtitle: of_any_rays(
                subjects,
                &format!(
                    "receivers α = {RECEIVER}, δ = {DELTA}, {} rays, interleaved {INTERLEAVE}×{INTERLEAVE}",
                    subjects[0].effort.vpls
                ),
            ),
            panels,
        },
    }
}

/// The first scene, the ring unless another is asked for, with more and more lights.
pub fn of_ring(subject: &Subject) -> Study {
    let mut sheet = Sheet::new(&["vpls", "model", "cull_ms", "shade_ms", "rmse"]);
    let mut summary = Sheet::new(&SUMMARY);
    let sides = if subject.effort.is_quick {
        [16, 32, 64]
    } else {
        [128, 256, 512_u32]
    };
    let mut series = [0, 1].map(|color| Series {
        name: String::new(),
        look: Look {
            color,
            line: Line::Solid,
        },
        points: Vec::new(),
    });
    for side in sides {
        let compared = Compared::new(subject, side * side, [F0; 2]);
        compared.write(&(side * side).into(), &mut sheet);
        let name = format!("{}, {side}² rays", subject.name);
        compared.summarise(&name.into(), [F0; 2], &mut summary);
        for (series, model) in series.iter_mut().zip(&compared.models) {
            series.name = model.name.into();
            let ms = model.cull_ms + model.shade_ms;
            series.points.push(Point::new(f64::from(side * side), ms));
        }
    }
    Study {
        name: "ltsd_ring",
        caption: "As before, with 128², 256² and 512² rays.",
        sheet,
        summary: Some(summary),
        picture: None,
        figure: Figure {
            title: "Transformed cosines against GGX: the number of lights".into(),
            subtitle: of_any_rays(
                std::slice::from_ref(subject),
                &format!(
                    "receivers α = {RECEIVER}, δ = {DELTA}, interleaved {INTERLEAVE}×{INTERLEAVE}"
                ),
            ),
            panels: vec![Panel {
                title: subject.name.into(),
                x: Axis::log("rays from the light"),
                y: Axis::log("bound + cull + shade (ms)"),
                series: series.into(),
            }],
        },
    }
}
