//! Ways beside today's best blind one, in equal time.

use super::super::Study;
use super::curve::{Curve, Step};
use super::time::{Measured, of_receivers};
use super::way::{Setting, TODAY, Way};
use crate::figure::{Axis, Figure, Panel, Point, Series};
use crate::sheet::Sheet;
use crate::subject::Subject;

pub fn in_equal_time(subjects: &[Subject], all: &[Measured]) -> Study {
    let mut sheet = Sheet::new(&[
        "scene",
        "receiver",
        "method",
        "variance_gain",
        "variance_gain_low",
        "variance_gain_high",
        "ms",
        "sigma_gain",
        "median_over_todays",
        "median_over_one_delta",
    ]);
    let mut panels = Vec::new();
    for subject in subjects {
        let mut series: Vec<Series> = Vec::new();
        for measured in all.iter().filter(|m| std::ptr::eq(m.subject, subject)) {
            for gain in gains(measured) {
                let name = gain.way.name();
                sheet.push([
                    subject.name.into(),
                    measured.material.name().into(),
                    name.clone().into(),
                    gain.variance[1].into(),
                    gain.variance[0].into(),
                    gain.variance[2].into(),
                    gain.ms.into(),
                    gain.sigma.into(),
                    gain.median.into(),
                    gain.median_over_one_delta.into(),
                ]);
                let [low, middle, high] = gain.variance;
                let Some(at) = measured.material.place() else {
                    continue;
                };
                let point = Point::new(at, middle).within([low, high]);
                match series.iter_mut().find(|series| series.name == name) {
                    Some(series) => series.points.push(point),
                    None => series.push(Series {
                        name,
                        look: gain.way.look(),
                        points: vec![point],
                    }),
                }
            }
        }
        for series in &mut series {
            series.points.sort_by(|a, b| a.x.total_cmp(&b.x));
        }
        panels.push(Panel {
            title: subject.name.into(),
            x: Axis::log("roughness of the receiver (Lambert at 1)"),
            y: Axis::log("variance of the blind way over this"),
            series,
        });
    }
    Study {
        name: "receivers_equal_time",
        caption: "How much less variance each way has than today's best blind one, in the time that this takes with \
                  δ = 0.0001. Above 1 is better; bars are 95 % confidence. A way is left out where its coarsest setting \
                  takes longer, or its finest less long. Sigma and median: the same for the sum of standard deviations, \
                  squared, and the relative error of the median pixel over that of the blind way, or of the same way with \
                  one δ.",
        sheet,
        summary: None,
        picture: None,
        figure: Figure {
            title: "Variance in equal time, by what receivers are made of".into(),
            subtitle: of_receivers(subjects, ", but for “all lights”"),
            panels,
        },
    }
}

/// δ of today's way whose time all others have: a pixel then accepts several lights. With ten times as much the picture
/// is noise, whichever the way.
const DELTA_OF_EQUAL_TIME: f32 = 1e-4;

/// A way beside today's, in equal time.
struct Gain {
    way: Way,
    ms: f64,
    /// The lower end of what is likely, the estimate, and the upper end.
    variance: [f64; 3],
    sigma: f64,
    median: f64,
    /// NaN if the way has one δ.
    median_over_one_delta: f64,
}

fn gains(measured: &Measured) -> Vec<Gain> {
    let today = measured.curves.iter().find(|curve| curve.way == TODAY);
    let usual = today.and_then(|curve| {
        let is_usual = |step: &&Step| match step.setting {
            Setting::Delta(delta) => delta <= 1.01 * DELTA_OF_EQUAL_TIME,
            Setting::Samples(_) => false,
        };
        curve.steps.iter().find(is_usual)
    });
    let (Some(today), Some(usual)) = (today, usual) else {
        return Vec::new();
    };
    // A step that takes as long is at the end of its curve's part.
    let ms = usual.ms;
    let Some(blind) = today.at(ms) else {
        return Vec::new();
    };
    let gain = |curve: &Curve| {
        let at = curve.at(ms)?;
        let log = blind.log_mse[0] - at.log_mse[0];
        let error = 1.96 * blind.log_mse[1].hypot(at.log_mse[1]);
        let is_itself = curve.way == TODAY;
        let with_one_delta = curve.way.with_one_delta().and_then(|way| {
            let mut curves = measured.curves.iter();
            curves.find(|curve| curve.way == way)?.at(ms)
        });
        let variance =
            [-1.0, 0.0, 1.0].map(|side| (log + if is_itself { 0.0 } else { side * error }).exp());
        Some(Gain {
            way: curve.way,
            ms,
            variance,
            sigma: (blind.sigma / at.sigma).powi(2),
            median: at.median / blind.median,
            median_over_one_delta: with_one_delta.map_or(f64::NAN, |one| at.median / one.median),
        })
    };
    measured.curves.iter().filter_map(gain).collect()
}
