//! (d) Volumes of the bounds over that of the smallest ellipsoid, and nanoseconds.

use std::hint::black_box;
use std::time::Instant;

use common::frame::BoundKind;
use rayon::prelude::*;
use stochastic_light_culling::{Bounded, Ellipsoid, GgxLobe, Paper, Schlick, Tight, Triaxial};
use support::tightness::{DEGREES, DIELECTRICS, METALS, Place, ROUGHNESSES, Volumes, grid, volume};

use super::Study;
use crate::figure::{Axis, Figure, Line, Look, Panel, Point, Series};
use crate::method::Method;
use crate::sheet::Sheet;
use crate::statistics::{Mean, median};
use crate::subject::Effort;

pub fn make(effort: &Effort, done: &dyn Fn()) -> Study {
    let mut sheet = Sheet::new(&[
        "alpha",
        "incidence_degrees",
        "fresnel",
        "tight",
        "attainable",
        "triaxial",
        "enclosing",
        "sphere",
    ]);
    let mut summary = Sheet::new(&[
        "lobes",
        "bound",
        "ns",
        "over_attainable_mean",
        "over_attainable_most",
    ]);
    let mut panels = Vec::new();
    for (name, reflectances) in [
        ("metals, F0 0.5 to 1", &METALS[..]),
        ("dielectrics, F0 0.02 to 0.1", &DIELECTRICS),
    ] {
        let stride = if effort.is_quick { 7 } else { 1 };
        let places: Vec<Place> = grid(reflectances).into_iter().step_by(stride).collect();
        let measured: Vec<(Place, Volumes)> = places
            .par_iter()
            .map(|place| (*place, place.measure()))
            .collect();
        for (place, volumes) in &measured {
            sheet.push([
                place.roughness.into(),
                place.degrees.into(),
                place.f0.into(),
                volumes.tight.into(),
                volumes.attainable.into(),
                over_spheroid(BoundKind::Triaxial, *place).into(),
                over_spheroid(BoundKind::Enclosing, *place).into(),
                over_spheroid(BoundKind::Sphere, *place).into(),
            ]);
        }
        let lobes: Vec<GgxLobe<Schlick>> = places.iter().map(|place| place.lobe()).collect();
        let mut series = Vec::new();
        for bound in BoundKind::ALL {
            let ratio = |(place, volumes): &(Place, Volumes)| {
                over_spheroid(bound, *place) / volumes.attainable
            };
            let ratios: Vec<f64> = measured.iter().map(ratio).collect();
            let [least, most] = [f64::min, f64::max]
                .map(|pick| ratios.iter().copied().reduce(pick).unwrap_or(f64::NAN));
            let ns = nanoseconds(bound, &lobes, effort.is_quick);
            summary.push([
                name.into(),
                bound.name().into(),
                ns.into(),
                Mean::of(&ratios).mean.into(),
                most.into(),
            ]);
            let look = Method::Culled {
                bound,
                refined: false,
            }
            .look();
            let point = Point::new(ns, median(&ratios)).within([least, most]);
            series.push(Series {
                name: bound.name().into(),
                look: Look {
                    line: Line::None,
                    ..look
                },
                points: vec![point.labelled(bound.name())],
            });
        }
        panels.push(Panel {
            title: name.into(),
            x: Axis::log("ns per light"),
            y: Axis::log("volume over that of the smallest ellipsoid"),
            series,
        });
    }
    done();
    Study {
        name: "tightness",
        caption: "The middle of all lobes of the grid, and bars from the least to the greatest.",
        sheet,
        summary: Some(summary),
        picture: None,
        figure: Figure {
            title: "How tight the bounds are, against their cost".into(),
            subtitle: format!(
                "α from {} to {}, incidence from {}° to {}°",
                ROUGHNESSES[0],
                ROUGHNESSES[ROUGHNESSES.len() - 1],
                DEGREES[0],
                DEGREES[DEGREES.len() - 1]
            ),
            panels,
        },
    }
}

/// The volume over that of the paper's spheroid.
fn over_spheroid(bound: BoundKind, place: Place) -> f64 {
    let lobe = place.lobe();
    let spheroid = lobe.unit_bound_by(Paper);
    let ball = |radius: f32| f64::from(radius).powi(3);
    let volume = match bound {
        BoundKind::Sphere => ball(spheroid.sphere_at_focus().radius()),
        BoundKind::Enclosing => ball(spheroid.enclosing_sphere().radius()),
        BoundKind::Spheroid => return 1.0,
        BoundKind::Triaxial => volume(&lobe.unit_bound_by(Triaxial)),
        BoundKind::Tight => volume(&lobe.unit_bound_by(Tight)),
    };
    volume / support::tightness::volume(&spheroid.into())
}

/// The time to make a bound, the least of several rounds.
fn nanoseconds(bound: BoundKind, lobes: &[GgxLobe<Schlick>], is_quick: bool) -> f64 {
    fn time<T>(
        lobes: &[GgxLobe<Schlick>],
        is_quick: bool,
        bound: impl Fn(&GgxLobe<Schlick>) -> T,
    ) -> f64 {
        let round = || {
            let start = Instant::now();
            for lobe in lobes {
                black_box(bound(black_box(lobe)));
            }
            1e9 * start.elapsed().as_secs_f64() / lobes.len() as f64
        };
        (0..if is_quick { 20 } else { 2000 })
            .map(|_| round())
            .fold(f64::INFINITY, f64::min)
    }
    let spheroid = |lobe: &GgxLobe<Schlick>| lobe.unit_bound_by(Paper);
    match bound {
        BoundKind::Sphere => time(lobes, is_quick, |lobe| spheroid(lobe).sphere_at_focus()),
        BoundKind::Enclosing => time(lobes, is_quick, |lobe| spheroid(lobe).enclosing_sphere()),
        BoundKind::Spheroid => time(lobes, is_quick, |lobe| Ellipsoid::from(spheroid(lobe))),
        BoundKind::Triaxial => time(lobes, is_quick, |lobe| lobe.unit_bound_by(Triaxial)),
        BoundKind::Tight => time(lobes, is_quick, |lobe| lobe.unit_bound_by(Tight)),
    }
}
