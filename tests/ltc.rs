//! Linearly transformed cosines: their table is what the fit makes, and they are as close to GGX as their
//! documentation says.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use proptest::prelude::*;
use stochastic_light_culling::{
    Bounded, Conductor, Dielectric, Direction, Error, Fresnel, Ggx, Incidence, Lobe, LtcLobe,
    NoFresnel, Schlick, glam::DVec3,
};
use support::generators::{self, cases};
use support::ggx_nodes::albedos;
use support::ltc_errors::LtcErrors;
use support::reference::{Shape, Smallest, Vector, ltc_rows, ltc_value};

#[allow(dead_code, reason = "the tests take parts of it")]
#[path = "../examples/tabulate/ltc.rs"]
mod fit;

const TABLE: &[u8] = include_bytes!("../src/lobe/ltc.bin");
const KNOTS: usize = 64;

fn incidence(degrees: f64) -> Incidence {
    let (sine, cosine) = degrees.to_radians().sin_cos();
    Incidence {
        normal: Direction::Z,
        incoming: Direction::new(DVec3::new(-sine, 0.0, cosine).as_vec3()).unwrap(),
    }
}

fn lobe(alpha: f64, degrees: f64, f0: f32) -> LtcLobe {
    let ggx = Ggx::new(alpha as f32).unwrap();
    LtcLobe::new(ggx, Schlick::new(f0).unwrap(), incidence(degrees))
}

fn bytes_at(element: usize, count: usize) -> Vec<u16> {
    let bytes = &TABLE[2 * element..2 * (element + count)];
    bytes
        .chunks(2)
        .map(|b| u16::from_le_bytes([b[0], b[1]]))
        .collect()
}

/// `examples/tabulate -- --ltc` makes the whole.
#[test]
fn knots_are_reproduced() {
    assert_eq!(TABLE.len(), 2 * 6 * KNOTS * KNOTS);
    for j in [0, 1, 31, 55, 63] {
        for (i, counts) in fit::column(j).into_iter().enumerate() {
            assert_eq!(bytes_at((i * KNOTS + j) * 4, 4), counts, "knot ({i}, {j})");
        }
    }
    for (i, j) in [(0, 0), (0, 40), (7, 31), (30, 63), (63, 12), (63, 63)] {
        let element = 4 * KNOTS * KNOTS + (i * KNOTS + j) * 2;
        assert_eq!(
            bytes_at(element, 2),
            fit::albedo_counts(&fit::layout::MATRICES, i, j),
            "albedos at ({i}, {j})"
        );
    }
}

#[test]
fn errors_are_as_documented() {
    const ROUGHNESSES: [f64; 6] = [1.0, 0.7, 0.4, 0.2, 0.1, 0.05];
    // By angle of incidence, for F = 1 and F0 = 0.04.
    let most = [
        (0.0, 1.0, [0.031, 0.025, 0.028, 0.015, 0.0035, 0.0005]),
        (60.0, 1.0, [0.055, 0.065, 0.098, 0.07, 0.042, 0.023]),
        (85.0, 1.0, [0.16, 0.17, 0.29, 0.28, 0.21, 0.125]),
        (60.0, 0.04, [0.31, 0.39, 0.425, 0.335, 0.2, 0.1]),
        (85.0, 0.04, [0.74, 0.76, 0.72, 0.57, 0.4, 0.235]),
    ];
    for (degrees, f0, row) in most {
        println!("{degrees}°, F0 = {f0}:");
        for (alpha, most) in ROUGHNESSES.into_iter().zip(row) {
            let LtcErrors {
                relative_l2: error,
                energy,
                ..
            } = LtcErrors::of(alpha, degrees, f0, 96).unwrap();
            println!("  α = {alpha}: {error:.5}, with {energy:.4} of the energy");
            assert!(error <= most, "α = {alpha}, {degrees}°, F0 = {f0}: {error}");
        }
    }
}

proptest! {
    #![proptest_config(cases(300))]

    /// For F = 1 the energy is nearly that of GGX, and hardly more, for any roughness and incidence.
    #[test]
    fn energy_is_that_of_ggx(
        alpha in generators::up_to_one(1e-5),
        mu in generators::up_to_one(1e-4),
    ) {
        let mu = f64::from(mu);
        let incoming = DVec3::new(-(1.0 - mu * mu).sqrt(), 0.0, mu).as_vec3();
        let incidence = Incidence { normal: Direction::Z, incoming: Direction::new(incoming).unwrap() };
        let lobe = LtcLobe::new(Ggx::new(alpha).unwrap(), NoFresnel, incidence);
        let [exact, _] = albedos(f64::from(alpha), mu);
        let ratio = f64::from(lobe.reflected()) / exact;
        prop_assert!(0.99 < ratio && ratio < 1.01, "{ratio}");
    }
}

/// The integral of the value over the hemisphere is [`LtcLobe::reflected`]: over directions that M maps
/// evenly spread ones to, of which those below the horizon do not count.
#[test]
fn reflected_is_the_integral_above_the_horizon() {
    for alpha in [1.0, 0.5, 0.2, 0.05, 0.001] {
        for degrees in [0.0, 30.0, 60.0, 85.0, 89.9] {
            let lobe = lobe(alpha, degrees, 0.5);
            let [first, third] = ltc_rows(&lobe);
            let second = third.cross(first);
            let columns = [second.cross(third), second, first.cross(second)];
            let mut sum = 0.0;
            let steps = 400;
            for i in 0..steps {
                for j in 0..steps {
                    let share = (f64::from(i) + 0.5) / f64::from(steps);
                    let azimuth = TAU * (f64::from(j) + 0.5) / f64::from(steps);
                    let (radius, height) = (share.sqrt(), (1.0 - share).sqrt());
                    let outgoing = (columns[0] * (radius * azimuth.cos())
                        + columns[1] * (radius * azimuth.sin())
                        + columns[2] * height)
                        .unit();
                    if outgoing.0[2] <= 0.0 {
                        continue;
                    }
                    // The density of these directions, from rows alone.
                    let transformed = Vector([first, second, third].map(|row| row.dot(outgoing)));
                    let determinant = second.dot(second);
                    let density = transformed.0[2] * determinant
                        / (PI * transformed.dot(transformed).powi(2));
                    sum += f64::from(lobe.value(outgoing.to_f32())) / density;
                }
            }
            let integral = sum / f64::from(steps * steps);
            let ratio = integral / f64::from(lobe.reflected());
            // The nodes at the horizon, and the rounding of directions to f32.
            let allowed = if alpha < 0.01 { 0.02 } else { 0.003 };
            assert!(
                (ratio - 1.0).abs() < allowed,
                "α = {alpha}, {degrees}°: {ratio}"
            );
        }
    }
}

/// [Xia et al. 2023, Eq. 13] would have the same value for exchanged directions.
#[test]
fn the_fit_is_not_reciprocal() {
    let exchanged = |alpha: f64, [first, second]: [f64; 2]| {
        let value = |from: f64, to: f64| {
            let (sine, cosine) = to.to_radians().sin_cos();
            let outgoing = DVec3::new(sine, 0.0, cosine).as_vec3();
            f64::from(lobe(alpha, from, 1.0).value(outgoing)) / cosine
        };
        value(first, second) / value(second, first)
    };
    let near = exchanged(0.2, [20.0, 40.0]);
    let far = exchanged(0.2, [30.0, 80.0]);
    println!("{near} between 20° and 40°, {far} between 30° and 80°");
    assert!((near - 1.0).abs() > 0.001 && (far - 1.0).abs() > 0.1);
}

/// A dielectric and a conductor count by their reflectance at normal and at grazing incidence.
#[test]
fn fresnel_factors_count_by_their_ends() {
    fn reflected<F: Fresnel>(fresnel: F) -> f32 {
        LtcLobe::new(Ggx::new(0.3).unwrap(), fresnel, incidence(50.0)).reflected()
    }
    let dielectric = Dielectric::new(1.5).unwrap();
    let conductor = Conductor::new(0.2, 3.0).unwrap();
    for (found, f0) in [
        (reflected(NoFresnel), 1.0),
        (reflected(dielectric), dielectric.reflectance(1.0)),
        (reflected(conductor), conductor.reflectance(1.0)),
    ] {
        let schlick = reflected(Schlick::new(f0).unwrap());
        assert!(
            (found / schlick - 1.0).abs() < 1e-6,
            "{found} and {schlick}"
        );
    }
}

#[test]
fn lobes_that_reflect_nothing_are_empty() {
    for degrees in [90.001, 120.0, 180.0] {
        let lobe = lobe(0.3, degrees, 0.5);
        assert!(lobe.is_empty() && lobe.unit_bound().is_empty());
        assert_eq!([lobe.reflected(), lobe.amplitude()], [0.0; 2]);
        assert_eq!(lobe.value(*Direction::Z), 0.0);
    }
    let grazing = Incidence {
        normal: Direction::Z,
        incoming: Direction::X,
    };
    assert!(LtcLobe::new(Ggx::new(0.3).unwrap(), NoFresnel, grazing).is_empty());
    let dark = LtcLobe::with_matrix([1.0, 0.0, 0.0, 1.0], 0.0, incidence(0.0)).unwrap();
    assert!(dark.is_empty() && dark.unit_bound().is_empty());
}

#[test]
fn matrices_that_cannot_be_inverted_are_errors() {
    let with = |matrix, magnitude| LtcLobe::with_matrix(matrix, magnitude, incidence(40.0));
    for matrix in [
        [0.0; 4],
        [1.0, 2.0, 2.0, 4.0],
        [1.0, 0.0, 0.0, -1.0],
        [1e7, 0.0, 0.0, 1.0],
        [1.0, f32::NAN, 0.0, 1.0],
        [f32::INFINITY, 0.0, 0.0, 1.0],
        // In single precision little is left of the shortest image of a direction.
        [1e5, 0.0, 0.0, 1e-2],
        [0.039, 0.0, 0.0963, 2.79e-5],
    ] {
        assert!(
            matches!(with(matrix, 0.5), Err(Error::Matrix { .. })),
            "{matrix:?}"
        );
    }
    assert!(with([1e3, 0.0, 0.0, 1e-1], 0.5).is_ok());
    for magnitude in [-0.1, 1.1, f32::NAN] {
        let error = with([1.0, 0.0, 0.0, 1.0], magnitude);
        assert!(matches!(error, Err(Error::Number { .. })), "{magnitude}");
    }
}

/// The volume of the bound over that of the smallest ellipsoid around the isosurface, with and without the
/// part below the horizon.
fn volumes(lobe: &LtcLobe) -> [f64; 2] {
    let bound = Shape::from(lobe.unit_bound());
    let own: f64 = bound.semi_axes.iter().product();
    let [first, third] = ltc_rows(lobe);
    let second = third.cross(first);
    let columns = [second.cross(third), first.cross(second)];
    let across = second.unit();
    let (ahead, aside) = (third.unit(), across.cross(third.unit()));
    let (mut whole, mut above) = (Vec::new(), Vec::new());
    for i in 0..60 {
        for j in 0..60 {
            let polar = FRAC_PI_2 * (f64::from(i) + 0.5) / 60.0;
            let azimuth = PI * (f64::from(j) + 0.5) / 60.0;
            let outgoing = (columns[0] * (polar.sin() * azimuth.cos())
                + second * (polar.sin() * azimuth.sin())
                + columns[1] * polar.cos())
            .unit();
            let point = outgoing * ltc_value(lobe, outgoing).sqrt();
            // In units of the bound's semi-axes, more or less, which no volume ratio depends on.
            let place = [ahead, aside, across].map(|axis| axis.dot(point));
            whole.push(place);
            if outgoing.0[2] > 0.0 {
                above.push(place);
            }
        }
    }
    whole.push([0.0; 3]);
    above.push([0.0; 3]);
    [whole, above].map(|points| own / Smallest::around(points, 1e-3).volume())
}

/// Over every sixth knot of √α and of √(1 − μ), and for each of √α over the last two before grazing incidence and beyond.
#[test]
fn volume_is_near_the_least() {
    let (mut sums, mut most, mut count) = ([0.0; 2], [0.0_f64; 2], 0.0);
    let mut grazing = 0.0_f64;
    let degrees_of = |j: usize| (1.0 - (j as f64 / 63.0).powi(2)).acos().to_degrees();
    let alpha_of = |i: usize| (i as f64 / 63.0).powi(2);
    for i in (3..KNOTS).step_by(6) {
        for j in (0..KNOTS - 1).step_by(6) {
            let ratios = volumes(&lobe(alpha_of(i), degrees_of(j), 1.0));
            for k in 0..2 {
                sums[k] += ratios[k];
                most[k] = most[k].max(ratios[k]);
            }
            count += 1.0;
        }
    }
    for alpha in (1..KNOTS).map(alpha_of) {
        for j in [KNOTS - 3, KNOTS - 2] {
            let [whole, _] = volumes(&lobe(alpha, degrees_of(j), 1.0));
            most[0] = most[0].max(whole);
        }
        for degrees in [87.0, 88.0, 89.0, 89.5, 89.9] {
            grazing = grazing.max(volumes(&lobe(alpha, degrees, 1.0))[0]);
        }
    }
    let means = sums.map(|sum| sum / count);
    println!(
        "mean {means:?}, most {most:?}: the whole isosurface, and its part above the horizon; {grazing:?} from 87°"
    );
    assert!(means[0] <= 1.035 && most[0] <= 1.1, "{means:?} {most:?}");
    assert!(grazing <= 1.15, "{grazing}");
}
