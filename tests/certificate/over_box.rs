//! The isosurface over a box of parameters and half vectors.

use std::array::from_fn;

use super::angles::{Angles, half, half_jet};
use super::cell::Box5;
use super::interval::Interval;
use super::jet::{Jet, VARIABLES};
use super::lobe::{Lobe, Point, f0, fifth_of_rest, fifth_of_rest_jet, level, masked, phi};
use super::real::Real;

const ONE: Interval = Interval {
    low: 1.0,
    high: 1.0,
};

/// s² and ζ.
pub type Squared<T> = (T, [T; 3]);

fn lobe_and_point(angles: &Angles, b: &Box5, sign: f64) -> (Lobe<Interval>, Point<Interval>) {
    let alpha = b[0].square();
    let ((c, s), (cd, sd)) = (half(angles.tau), half(angles.sigma));
    let ((cp, sp), (cq, sq)) = (half(b[3]), half(b[4]));
    let rl = (c.square() + (alpha * s).square()).sqrt();
    let aol = alpha_over_root(angles, sd, s, alpha, rl);
    let m = [cq * cp * sign, sq, cq * sp];
    let lobe = Lobe {
        alpha,
        c,
        s,
        cd,
        sd,
        rl,
        aol,
    };
    let point = lobe.point(spread(alpha, m[2]), m);
    (lobe, point)
}

/// α/√L, in whichever form is none of 0/0.
fn alpha_over_root<T: Real>(angles: &Angles, sd: T, s: T, alpha: T, rl: T) -> T {
    let ratio = if angles.tau.low > 0.25 {
        sd / s
    } else {
        alpha / rl
    };
    ratio.within(0.0, 1.0)
}

/// N = α² + (1 − α²)m₃², which rises with both.
fn spread(alpha: Interval, m3: Interval) -> Interval {
    let at = |alpha: f64, m3: f64| {
        let (alpha, m3) = (Interval::at(alpha).square(), Interval::at(m3).square());
        alpha + (ONE - alpha) * m3
    };
    let high = at(alpha.high.min(1.0), m3.high.min(1.0)).high;
    Interval::new(at(alpha.low, m3.low).low.max(0.0), high)
}

/// An upper bound of ‖y‖² over the box; none if all of it is below the horizon.
///
/// With the largest s: an ellipsoid that contains the light and sζ contains all between them.
pub fn highest_level(
    angles: &Angles,
    b: &Box5,
    sign: f64,
    ellipsoid: &[Interval; 6],
) -> Option<f64> {
    let (lobe, point) = lobe_and_point(angles, b, sign);
    if point.e.high <= 0.0 {
        return None;
    }
    // G2/G1 = (1 + cosδ)/(1 + cosδ r), r² = k + (α/μ_o)² ≥ 1, which falls with cosδ and r.
    let w = Interval::at(lobe.aol.low) * Interval::at(point.n.low) / Interval::at(point.e.high);
    let r = (ONE - lobe.alpha.square() + Interval::at(w.low.max(0.0)).square()).sqrt();
    let (cd, r) = (Interval::at(lobe.cd.low), Interval::at(r.low.max(1.0)));
    let masking = Interval::at(((ONE + cd) / (ONE + cd * r)).high);
    let fresnel = phi(f0(b[2]), fifth_of_rest(point.t), fifth_of_rest(lobe.c));
    let s = (Interval::at(fresnel.high) * masking).sqrt().high;
    Some(level(Interval::at(s), point.z, ellipsoid).high)
}

/// s² and ζ at a point, s² negative below the horizon.
pub fn squared(angles: &Angles, b: &Box5, sign: f64) -> Squared<Interval> {
    let (lobe, point) = lobe_and_point(angles, b, sign);
    let fresnel = phi(f0(b[2]), fifth_of_rest(point.t), fifth_of_rest(lobe.c));
    (fresnel * masked(&lobe, &point), point.z)
}

/// The same over a box, with derivatives.
pub fn squared_jet(angles: &Angles, b: &Box5, sign: f64) -> Squared<Jet> {
    let alpha = Jet::variable(b[0], 0).square();
    let (tau, sigma) = angles.jets(b[0], b[1]);
    let ((c, s), (cd, sd)) = (half_jet(tau), half_jet(sigma));
    let (cp, sp) = half_jet(Jet::variable(b[3], 3));
    let (cq, sq) = half_jet(Jet::variable(b[4], 4));
    let rl = root_jet(c, alpha * s, cd, sd);
    let aol = alpha_over_root(angles, sd, s, alpha, rl);
    let m = [cq * cp * sign, sq, cq * sp];
    let lobe = Lobe {
        alpha,
        c,
        s,
        cd,
        sd,
        rl,
        aol,
    };
    let point = lobe.point(spread_jet(alpha, m[2]), m);
    let (et, ec) = (fifth_of_rest_jet(point.t), fifth_of_rest_jet(c));
    (fresnel_jet(b[2], et, ec) * masked(&lobe, &point), point.z)
}

/// √L = √(c² + α²s²), of which c and αs are the shares cosδ and sinδ.
fn root_jet(c: Jet, alpha_s: Jet, cd: Jet, sd: Jet) -> Jet {
    let root = |x: Interval, y: Interval| (x.square() + y.square()).sqrt();
    let value = root(c.value, alpha_s.value);
    let (cd, sd) = (cd.value, sd.value);
    Jet {
        value,
        middle: root(c.middle, alpha_s.middle),
        first: from_fn(|i| c.first[i] * cd + alpha_s.first[i] * sd),
        second: from_fn(|i| {
            let turn = c.first[i] * sd - alpha_s.first[i] * cd;
            cd * c.second[i] + sd * alpha_s.second[i] + turn.square() / value
        }),
    }
    .centred()
}

fn spread_jet(alpha: Jet, m3: Jet) -> Jet {
    let (a, m) = (alpha.square(), m3.square());
    let (of_a, of_m) = (ONE - m.value, ONE - a.value);
    Jet {
        value: spread(alpha.value, m3.value),
        middle: a.middle + (ONE - a.middle) * m.middle,
        // α and m₃ have no variable in common.
        first: from_fn(|i| a.first[i] * of_a + m.first[i] * of_m),
        second: from_fn(|i| a.second[i] * of_a + m.second[i] * of_m),
    }
    .centred()
}

/// F/F(μ) = (F0 + (1−F0) e_t)/(F0 + (1−F0) e_c), whose F0 = z⁴ only the third variable moves, and
/// whose e_t and e_c it does not.
fn fresnel_jet(z: Interval, et: Jet, ec: Jet) -> Jet {
    let f0_of_z = f0(z);
    let value = phi(f0_of_z, et.value, ec.value);
    let rest = ONE - f0_of_z;
    let below = (f0_of_z + rest * ec.value).within(f0_of_z.low, 1.0);
    let by_t = rest / below;
    let by_c = -(by_t * value);
    let by_tc = -by_t.square();
    let by_cc = by_t.square() * value * 2.0;
    let mut jet = Jet {
        value,
        middle: phi(f0(Interval::at(z.middle())), et.middle, ec.middle),
        first: from_fn(|i| et.first[i] * by_t + ec.first[i] * by_c),
        second: from_fn(|i| {
            by_t * et.second[i]
                + by_c * ec.second[i]
                + by_tc * et.first[i] * ec.first[i] * 2.0
                + by_cc * ec.first[i].square()
        }),
    };
    let half_width = Jet::variable(z, 2).first[2];
    let f0_first = z.square() * z * 4.0 * half_width;
    let f0_second = z.square() * 12.0 * half_width.square();
    let by_f = (ec.value - et.value) / below.square();
    let by_ff = -(by_f * (ONE - ec.value) / below) * 2.0;
    jet.first[2] = by_f * f0_first;
    jet.second[2] = by_ff * f0_first.square() + by_f * f0_second;
    jet.centred()
}

/// ∂²/∂x_i² of ‖y‖² at its least, less what is above zero, for an s of (s² + q)/(2√q), which is never
/// below s.
pub fn bends((squared, z): Squared<Jet>, q: f64, ellipsoid: &[Jet; 6]) -> [f64; VARIABLES] {
    let s = (squared + Jet::constant(q)) * (0.5 / q.sqrt());
    level(s, z, ellipsoid)
        .second
        .map(|second| (-second.low).max(0.0))
}
