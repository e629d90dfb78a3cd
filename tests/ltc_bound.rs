//! The inequalities behind the bound of a transformed cosine: each holds, and they are those that the program
//! chooses.

use std::f64::consts::{FRAC_PI_2, PI};

use support::ltc_inequality::LtcInequality;

#[allow(dead_code, reason = "the test takes parts of it")]
#[path = "../examples/tabulate/ltc.rs"]
mod ltc;
#[allow(dead_code, reason = "the test takes parts of it")]
#[path = "../examples/tabulate/ltc_rows.rs"]
mod ltc_rows;

use ltc_rows::layout::{NUMBERS, PLACES};

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
    let [alpha_1, alpha_2, sine, cosine, nu, q, _] = row.map(f64::from);
    let inequality = LtcInequality {
        alpha_1,
        alpha_2,
        sine,
        cosine,
        nu,
    };
    (inequality, q)
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
    let rows = rows();
    let lobes = ltc_rows::lobes();
    for chosen in [lobes[40], lobes[lobes.len() / 2]] {
        let place = ltc_rows::place(chosen);
        let here: Vec<_> = lobes
            .iter()
            .copied()
            .filter(|lobe| ltc_rows::place(*lobe) == place)
            .collect();
        assert_eq!(
            ltc_rows::row(&here),
            rows[usize::from(TABLE[place])],
            "place {place}"
        );
    }
}
