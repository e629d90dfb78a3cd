//! What it costs to leave the receiver's BRDF out of the probability: the paper's Fig. 12.
//!
//! A light that adds c with probability p has the variance c²(1/p − 1). With p from the light's
//! radiance L alone, p = min(L/δ, 1); a culling that knew the receiver could take p = min(c/δ', 1). Both
//! variances are sums over all lights: nothing is drawn.

use common::frame::{Frame, GlossyLight, Path};
use common::scene::Surface;
use rayon::prelude::*;
use stochastic_light_culling::{Direction, GgxLobe, Incidence, LambertLobe, Lobe, glam::Vec3};

use super::super::{DELTA, F0, ROUGHNESS, Study, of_frames};
use crate::figure::{Axis, Figure, Line, Look, Panel, Point, Series};
use crate::sheet::Sheet;
use crate::subject::{Gloss, Subject};

const ROUGHNESSES: [f32; 7] = [1.0, 0.5, 0.25, 0.12, 0.06, 0.03, 0.015];

#[derive(Clone, Copy, Debug)]
enum Receiver {
    Diffuse,
    Glossy(f32),
}

/// The radiance of a light at a surface, and what of it reaches the eye.
#[derive(Clone, Copy)]
struct Arrival {
    radiance: f64,
    reflected: f64,
}

pub fn make(subjects: &[Subject], done: &dyn Fn()) -> Study {
    let mut sheet = Sheet::new(&[
        "scene",
        "receiver",
        "receiver_alpha",
        "lights_per_pixel",
        "relative_deviation",
        "relative_deviation_knowing_receiver",
        "ratio_of_variances",
    ]);
    let mut panels = Vec::new();
    for subject in subjects {
        let mut series = [
            ("by the light alone", 1, Line::Solid),
            ("knowing the receiver", 0, Line::Solid),
        ]
        .map(|(name, color, line)| Series {
            name: name.into(),
            look: Look { color, line },
            points: Vec::new(),
        });
        let receivers = ROUGHNESSES.map(Receiver::Glossy);
        for receiver in [Receiver::Diffuse].into_iter().chain(receivers) {
            let pixels = arrivals(subject, receiver);
            let [blind, knowing, lights] = deviations(&pixels);
            let (name, roughness) = match receiver {
                Receiver::Diffuse => ("Lambert", f64::NAN),
                Receiver::Glossy(roughness) => ("GGX", f64::from(roughness)),
            };
            sheet.push([
                subject.name.into(),
                name.into(),
                roughness.into(),
                lights.into(),
                blind.into(),
                knowing.into(),
                (blind / knowing).powi(2).into(),
            ]);
            for (series, deviation) in series.iter_mut().zip([blind, knowing]) {
                series.points.push(Point::new(roughness, deviation));
            }
        }
        done();
        panels.push(Panel {
            title: subject.name.into(),
            x: Axis::log("roughness of the receiver"),
            y: Axis::log("standard deviation over the mean"),
            series: series.into(),
        });
    }
    Study {
        name: "receivers",
        caption: "The deviation that roulette alone adds at a pixel, were the floor and all else a metal of \
                  that roughness. The lower curve evaluates as many lights. What lies between them is \
                  what the receiver's BRDF is worth, and what the paper's Fig. 12 shows.",
        sheet,
        summary: None,
        picture: None,
        figure: Figure {
            title: "Glossy receivers: the noise of a probability without their BRDF".into(),
            subtitle: of_frames(subjects, &format!("δ = {DELTA}, glossy lights alone")),
            panels,
        },
    }
}

/// For each of some pixels, all lights.
fn arrivals(subject: &Subject, receiver: Receiver) -> Vec<Vec<Arrival>> {
    let whole = subject.interleave(1);
    let frame = subject.frame(whole, DELTA);
    let vpls = subject.effort.vpls;
    let lights = subject
        .lights(Gloss::new(ROUGHNESS, F0), vpls, &whole, subject.seed_of(0))
        .glossy;
    let eye = subject.camera.to_world_space(Vec3::ZERO);
    let seen: Vec<&Surface> = subject
        .surfaces
        .surfaces
        .iter()
        .filter(|surface| !surface.is_sky())
        .collect();
    let some = seen.len().div_ceil(1000);
    seen.into_par_iter()
        .step_by(some)
        .filter_map(|surface| {
            let normal = Direction::new(surface.normal).ok()?;
            // By reciprocity, as lit from where the eye is.
            let incidence = Incidence {
                normal,
                incoming: Direction::new(eye - surface.position).ok()?,
            };
            Some(match receiver {
                Receiver::Diffuse => {
                    let lobe = LambertLobe::new(0.8, normal).expect("in range");
                    arrivals_at(&frame, &lights, surface, &lobe)
                }
                Receiver::Glossy(roughness) => {
                    let Gloss { ggx, fresnel } = Gloss::new(roughness, F0);
                    let lobe = GgxLobe::new(ggx, fresnel, incidence);
                    arrivals_at(&frame, &lights, surface, &lobe)
                }
            })
        })
        .collect()
}

fn arrivals_at(
    frame: &Frame,
    lights: &[GlossyLight],
    surface: &Surface,
    lobe: &impl Lobe,
) -> Vec<Arrival> {
    let arrival = |light: &GlossyLight| {
        let path = Path::new(light, surface, frame.least_distance_squared);
        let radiance = f64::from(path.intensity / path.distance_squared);
        let to_light = (light.vpl.position() - surface.position).normalize_or_zero();
        let reflected = radiance * f64::from(lobe.value(to_light));
        (radiance > 0.0).then_some(Arrival {
            radiance,
            reflected,
        })
    };
    lights.iter().filter_map(arrival).collect()
}

/// The standard deviations, over the mean, of roulette by the light alone and knowing the receiver; and
/// how many lights a pixel accepts in the mean, the same for both.
fn deviations(pixels: &[Vec<Arrival>]) -> [f64; 3] {
    let by_light = |arrival: &Arrival| (arrival.radiance / f64::from(DELTA)).min(1.0);
    let accepted = |p: &dyn Fn(&Arrival) -> f64| -> f64 {
        pixels.iter().flatten().map(p).sum::<f64>() / pixels.len().max(1) as f64
    };
    let lights = accepted(&by_light);
    let (mut low, mut high) = (1e-20_f64, 1e10_f64);
    for _ in 0..100 {
        let middle = (low * high).sqrt();
        if accepted(&|arrival| (arrival.reflected / middle).min(1.0)) > lights {
            low = middle;
        } else {
            high = middle;
        }
    }
    let by_both = |arrival: &Arrival| (arrival.reflected / high).min(1.0);
    let deviation = |p: &dyn Fn(&Arrival) -> f64| {
        let variance = |arrival: &Arrival| match p(arrival) {
            p if p > 0.0 => arrival.reflected * arrival.reflected * (1.0 / p - 1.0),
            _ => 0.0,
        };
        let count = pixels.len().max(1) as f64;
        let variance = pixels.iter().flatten().map(variance).sum::<f64>() / count;
        let mean = pixels
            .iter()
            .flatten()
            .map(|arrival| arrival.reflected)
            .sum::<f64>()
            / count;
        variance.sqrt() / mean
    };
    [deviation(&by_light), deviation(&by_both), lights]
}
