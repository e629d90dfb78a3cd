//! The inequalities behind the bound of a transformed cosine: each holds, and they are those that the program
//! chooses. What a value in single precision reaches is inside, too.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use proptest::prelude::*;
use stochastic_light_culling::{
    Bounded, Direction, Ggx, Incidence, Lobe, LtcLobe, NoFresnel, Vpl, glam::Vec3,
};
use support::generators::{self, cases, log_uniform, unit_vector};
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
        let level = farthest_that_counts(&brdf, [normal, incoming], &ways);
        prop_assert!(level <= 1.0, "{level}");
    }

    /// The same where a lobe is narrowest.
    #[test]
    fn what_counts_near_grazing_incidence_is_inside(
        (alpha, cosine) in (log_uniform(1e-6, 2e-2), log_uniform(1e-6, 1e-1)),
        incidence in (unit_vector(), 0.0..TAU),
        ways in prop::collection::vec(unit_vector(), 100),
    ) {
        let brdf = Brdf::ltc(alpha as f32, 0.5, None);
        let level = farthest_that_counts(&brdf, directions(incidence, cosine), &ways);
        prop_assert!(level <= 1.0, "{level}");
    }

    /// The same of callers' matrices, which may be narrower.
    #[test]
    fn what_counts_of_a_narrow_matrix_is_inside(
        (width, cosine) in (log_uniform(8e-6, 2e-5), log_uniform(0.1, 1.0)),
        (upper, lower) in (0.0..=0.02, -0.7..=0.0),
        incidence in (unit_vector(), 0.0..TAU),
        ways in prop::collection::vec(unit_vector(), 100),
    ) {
        let alpha = width / cosine;
        let matrix = [cosine, alpha * upper, alpha * lower, 2.0 * width].map(|x| x as f32);
        let head_on = Incidence::head_on(Direction::Z);
        prop_assume!(LtcLobe::with_matrix(matrix, 0.5, head_on).is_ok());
        let brdf = Brdf::ltc(1.0, 0.5, Some(matrix));
        let level = farthest_that_counts(&brdf, directions(incidence, 0.5), &ways);
        prop_assert!(level <= 1.0, "{level}");
    }
}

/// The normal, and the direction with this cosine in the plane that is turned by an angle.
fn directions((normal, turn): (Vector, f64), cosine: f64) -> [Vector; 2] {
    let side = normal.orthogonal();
    let along = side * turn.cos() + normal.cross(side) * turn.sin();
    [
        normal,
        normal * cosine + along * (1.0 - cosine * cosine).sqrt(),
    ]
}

/// The highest level of a point that counts, found near where bound and isosurface touch.
fn farthest_that_counts(brdf: &Brdf, directions: [Vector; 2], ways: &[Vector]) -> f64 {
    let [normal, incoming] = directions.map(|v| Direction::new(v.to_f32()).unwrap());
    let Brdf::Ltc { lobe, .. } = brdf.lit_by(normal, incoming) else {
        panic!("another lobe");
    };
    if lobe.is_empty() {
        return 0.0;
    }
    let search = Search::new(lobe);
    let exact = search.direction(search.contact(ways));
    let vpl = Vpl::new(Vec3::ZERO, 1.0, lobe).unwrap();
    let mut highest = 0.0_f64;
    // Neighbours round differently.
    for (step, aside) in (0..8).flat_map(|step| ways.iter().map(move |way| (step * step, *way))) {
        let way = (exact + aside * (f64::from(step) * 6e-8)).unit();
        let rough = f64::from(vpl.radiant_intensity(way.to_f32()));
        for ulps in -3..=3 {
            let point = (way * (rough.sqrt() * (1.0 + 6e-8 * f64::from(ulps)))).to_f32();
            let (direction, squared) = vpl.direction_to(point);
            if vpl.radiant_intensity(direction) >= squared {
                let level = search.bound.level(Vector([0.0; 3]), Vector::from(point));
                assert!(level.is_finite(), "{level} of {lobe:?}");
                highest = highest.max(level);
            }
        }
    }
    highest
}

/// Found by the first of the tests above, when the matrix was that of 89.994°.
#[test]
fn narrow_lobe_at_grazing_incidence_is_inside() {
    let directions = [
        [
            0.280_838_272_437_383_6,
            -0.745_145_764_624_452_8,
            0.604_886_480_421_430_3,
        ],
        [
            -0.245_952_576_879_455_7,
            0.553_227_050_150_535_3,
            0.795_893_938_228_010_7,
        ],
    ];
    let brdf = Brdf::ltc(0.000_746_218_2, 0.001, None);
    let ways = [Vector([1.0, 0.0, 0.0])];
    let level = farthest_that_counts(&brdf, directions.map(Vector), &ways);
    assert!(level <= 1.0, "{level}");
}

#[test]
fn fitted_matrices_are_well_conditioned() {
    let steps = 300;
    let logarithmic = |least: f64, i: u32| least.powf(1.0 - f64::from(i) / f64::from(steps));
    let mut most = 0.0_f64;
    for (i, j) in (0..=steps).flat_map(|i| (0..=steps).map(move |j| (i, j))) {
        let (alpha, cosine) = (logarithmic(9.6e-7, i), logarithmic(1e-7, j));
        let incoming = Vec3::new((1.0 - cosine * cosine).sqrt() as f32, 0.0, cosine as f32);
        let incidence = Incidence {
            normal: Direction::Z,
            incoming: Direction::new(incoming).unwrap(),
        };
        let lobe = LtcLobe::new(Ggx::new(alpha as f32).unwrap(), NoFresnel, incidence);
        let [first, third] = ltc_rows(&lobe);
        let second = third.cross(first);
        let squares = [first, second, third].map(|row| row.dot(row));
        let [x, y, z] = squares;
        // In the plane of incidence the product of both singular values is that of the other rows' cross product.
        let least_image = y.sqrt().min((y / (x + z)).sqrt());
        let moved = 8.0 * (x + y + z).sqrt() + 4.0 * (x + y).sqrt();
        most = most.max(moved * f64::powi(2.0, -24) / least_image);
    }
    println!("rounding moves an image by up to {most} of its length");
    assert!(most <= 0.02, "{most}");
}
