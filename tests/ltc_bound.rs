//! The inequalities behind the bound of a transformed cosine: each holds, and they are those that the program
//! chooses. What a value in single precision reaches is inside, too.

use std::f64::consts::{FRAC_PI_2, PI};

use proptest::prelude::*;
use stochastic_light_culling::{Bounded, Direction, Lobe, LtcLobe, Vpl, glam::Vec3};
use support::generators::{self, cases, unit_vector};
use support::ltc_inequality::LtcInequality;
use support::reference::{Brdf, Shape, Vector, ltc_rows, ltc_value};

#[allow(dead_code, reason = "the test takes parts of it")]
#[path = "../examples/tabulate/ltc.rs"]
mod ltc;
#[allow(dead_code, reason = "the test takes parts of it")]
#[path = "../examples/tabulate/ltc_rows.rs"]
mod ltc_rows;

use ltc_rows::layout::{NUMBERS, PLACES};
use ltc_rows::{FINENESS, Place};

const TABLE: &[u8] = include_bytes!("../src/bound/ltc_rows.bin");

fn rows() -> Vec<[f32; NUMBERS]> {
    let numbers: Vec<f32> = TABLE[PLACES..]
        .chunks_exact(4)
        .map(|bytes| f32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]))
        .collect();
    let rows = numbers.chunks_exact(NUMBERS);
    rows.map(|row| row.try_into().expect("as many")).collect()
}

/// The inequality of a row, and its q.
fn inequality(row: [f32; NUMBERS]) -> (LtcInequality, f64) {
    let [alpha_1, alpha_2, sine, cosine, nu, q, _] = row;
    let inequality = LtcInequality::from_numbers([alpha_1, alpha_2, sine, cosine, nu]);
    (inequality, q.into())
}

#[test]
fn every_row_is_proved() {
    let rows = rows();
    assert!(TABLE[..PLACES].iter().all(|i| usize::from(*i) < rows.len()));
    for (i, row) in rows.into_iter().enumerate() {
        let (inequality, q) = inequality(row);
        let share = row[NUMBERS - 1];
        assert!(0.0 < share && share <= 0.9, "row {i}");
        let LtcInequality {
            alpha_1,
            alpha_2,
            sine,
            cosine,
            nu,
        } = inequality;
        assert!(alpha_1 > 0.0 && alpha_2 >= 0.0 && sine >= 0.0 && cosine > 0.0);
        assert!(nu > 0.0 && nu <= 1.0 && (sine.hypot(cosine) - 1.0).abs() < 1e-7);
        assert!(inequality.proved_q(20_000) <= q, "row {i}");
    }
}

/// Independent of the proof: over directions, of which the proof takes the angle alone.
#[test]
fn rows_hold_for_directions_and_are_no_larger_than_need_be() {
    const STEPS: u32 = 320;
    for (i, row) in rows().into_iter().enumerate() {
        let (inequality, q) = inequality(row);
        let LtcInequality {
            alpha_1,
            alpha_2,
            sine,
            cosine,
            nu,
        } = inequality;
        let mut most = 0.0_f64;
        for k in 0..=STEPS {
            // Denser near û.
            let share = f64::from(k) / f64::from(STEPS);
            let (s, c) = ((FRAC_PI_2 + sine.atan2(cosine)) * share * share).sin_cos();
            for l in 0..=STEPS {
                let (across, along) = (PI * f64::from(l) / f64::from(STEPS)).sin_cos();
                // û turned by an angle towards a perpendicular.
                let direction = [
                    sine * c + cosine * s * along,
                    s * across,
                    cosine * c - sine * s * along,
                ];
                let [x, y, p] = direction;
                if p < 0.0 {
                    continue;
                }
                let g = sine * x + cosine * p;
                let aside = cosine * x - sine * p;
                let root = p.sqrt() - alpha_1 * p - alpha_2 * g;
                if root > 0.0 {
                    most = most.max(root * root / (y * y + aside * aside + nu * g * g));
                }
            }
        }
        assert!(most <= q, "row {i}: {most} over {q}");
        assert!(most >= 0.97 * q, "row {i}: {most} far below {q}");
    }
}

/// `examples/tabulate -- --ltc-bound` makes the whole.
#[test]
fn rows_are_reproduced() {
    let (rows, coarse) = (rows(), ltc_rows::coarse_places());
    for i in [30, coarse.len() - 20] {
        assert_eq!(ltc_rows::row(&coarse[i]), rows[i], "row {i}");
    }
    let places = Place::all(FINENESS[1]);
    for place in places.iter().step_by(17) {
        let (best, index) = (place.best(&rows).0, place.index);
        assert_eq!(best, usize::from(TABLE[index]), "place {index}");
    }
}

/// The directions of a lobe, as M maps others to them, and how far out the isosurface is there.
struct Search {
    lobe: LtcLobe,
    bound: Shape,
    /// Those of M, times the determinant.
    columns: [Vector; 3],
}

impl Search {
    fn new(lobe: LtcLobe) -> Self {
        let [first, third] = ltc_rows(&lobe);
        let second = third.cross(first);
        Self {
            lobe,
            bound: lobe.unit_bound().into(),
            columns: [second.cross(third), second, first.cross(second)],
        }
    }

    fn direction(&self, x: Vector) -> Vector {
        let [first, second, third] = self.columns;
        let Vector([x, y, z]) = x;
        (first * x + second * y + third * z.abs()).unit()
    }

    /// Below 1 inside the bound; zero below the horizon.
    fn level(&self, x: Vector) -> f64 {
        let way = self.direction(x);
        if way.dot(Vector::from(*self.lobe.normal())) <= 0.0 {
            return 0.0;
        }
        let point = way * ltc_value(&self.lobe, way).sqrt();
        self.bound.level(Vector([0.0; 3]), point)
    }

    /// Near where bound and isosurface touch: the best of `starts`, and then by ever smaller steps.
    fn contact(&self, starts: &[Vector]) -> Vector {
        let mut best = (Vector([0.0, 0.0, 1.0]), 0.0);
        let mut size = 0.1;
        let steps = starts.iter().cycle().take(600);
        for (i, start) in starts.iter().chain(steps).enumerate() {
            let x = if i < starts.len() {
                *start
            } else {
                best.0 + *start * size
            };
            let level = self.level(x);
            if level > best.1 {
                best = (x, level);
            } else if i >= starts.len() {
                size *= 0.985;
            }
        }
        best.0
    }
}

proptest! {
    #![proptest_config(cases(1500))]

    /// The value, as it rounds, reaches no point outside the bound.
    #[test]
    fn what_counts_as_it_rounds_is_inside(
        brdf in generators::ltc(),
        [normal, incoming] in [unit_vector(), unit_vector()],
        ways in prop::collection::vec(unit_vector(), 100),
    ) {
        let [normal, incoming] = [normal, incoming].map(|v| Direction::new(v.to_f32()).unwrap());
        let Brdf::Ltc { lobe, roughness, .. } = brdf.lit_by(normal, incoming) else {
            return Ok(());
        };
        if lobe.is_empty() || roughness < 1e-4 {
            return Ok(());
        }
        let search = Search::new(lobe);
        let exact = search.direction(search.contact(&ways));
        let vpl = Vpl::new(Vec3::ZERO, 1.0, lobe).unwrap();
        // Neighbours round differently.
        for (step, aside) in (0..8).flat_map(|step| ways.iter().map(move |way| (step * step, *way))) {
            let way = (exact + aside * (f64::from(step) * 6e-8)).unit();
            let rough = f64::from(vpl.radiant_intensity(way.to_f32()));
            for ulps in -3..=3 {
                let point = (way * (rough.sqrt() * (1.0 + 6e-8 * f64::from(ulps)))).to_f32();
                let (direction, squared) = vpl.direction_to(point);
                if vpl.radiant_intensity(direction) >= squared {
                    let level = search.bound.level(Vector([0.0; 3]), Vector::from(point));
                    prop_assert!(level <= 1.0, "{level} of {lobe:?}");
                }
            }
        }
    }
}
