//! Tables for people, and one JSON object for scripts.

use std::fmt::{Display, LowerExp};

use serde_json::json;

use crate::cell::{ALPHAS, Cell, DISTANCES, MUS, RANGES};
use crate::quantities::{Quantities, SYMBOLS};
use crate::tally::{Mean, Tally};
use crate::thin_tiles;

type Measured = [(Cell, Tally)];

/// The object, on one line.
pub fn json(measured: &Measured) -> String {
    let whole = Tally::of(measured.iter().map(|(_, tally)| tally));
    let [ndf, g1, fresnel, fresnel_max, range] = whole.errors;
    json!({
        "cases": whole.cases,
        "lost": whole.lost,
        "lost_by_direct_port": whole.port_lost_cases,
        "mean_volume_inflation": rough(measured).inflation.get().unwrap_or(0.0),
        "max_relative_error": {
            "ndf": ndf,
            "g1": g1,
            "fresnel": fresnel,
            "fresnel_max": fresnel_max,
            "range": range,
        },
    })
    .to_string()
}

/// The cases of α ≥ 0.01.
fn rough(measured: &Measured) -> Tally {
    let rough = measured.iter().filter(|(cell, _)| cell.alpha >= 0.01);
    Tally::of(rough.map(|(_, tally)| tally))
}

/// All tables, and what their numbers are of.
pub fn text(measured: &Measured, thin: &[thin_tiles::Row]) -> String {
    let whole = Tally::of(measured.iter().map(|(_, tally)| tally));
    let rough = rough(measured);
    let mut lines = vec![format!(
        "{} cases, {} lost; the direct port loses {} ({} % of those it can test).\n{DOMAIN}",
        whole.cases,
        whole.lost,
        whole.port_lost_cases,
        percent(whole.port_lost),
    )];
    lines.push(heading("α"));
    let near = |tally: &Tally| tally.inflation;
    let any = |tally: &Tally| tally.inflation_any_origin;
    lines.extend(rows(measured, &ALPHAS, |cell| cell.alpha, 0.0, near));
    lines.push(heading("μ"));
    lines.extend(rows(measured, &MUS, |cell| cell.mu, 0.01, near));
    lines.push(heading("distance"));
    lines.extend(rows(measured, &DISTANCES, |cell| cell.distance, 0.01, any));
    lines.push(heading("range"));
    lines.extend(rows(measured, &RANGES, |cell| cell.range, 0.01, near));
    lines.push(format!(
        "\nMean volume added, α ≥ 0.01, in %\n\
         eye and world's origin no farther from the light than 10³ r:    {}\n\
         the same with the far reach r/α for r:                          {}\n\
         eye no farther than 10³ r, the origin up to 10⁶ ranges away:    {}",
        percent(rough.inflation),
        percent(rough.inflation_by_reach),
        percent(rough.inflation_any_origin),
    ));
    lines.push(thin_text(thin));
    lines.join("\n")
}

const DOMAIN: &str = "
Each case is a light and a tile around a point that it reaches in exact arithmetic, on the isosurface
but for 10⁻¹⁵ of the distance: GGX, any Fresnel factor (refractive indices from 10⁻³ to 10³), both
masking functions, δ from 10⁻⁶ to 10³, ξ from 2⁻³², the eye at 10⁻³ to 10⁶ times the light's reach.
  lost      cases in which the spheroid or one of its spheres is found not to touch the tile
  port      the share of lights that a direct f32 port loses, in %; conductors left out
  volume    what the tested ellipsoid has more than the exact spheroid, in %: mean where neither the
            eye nor the world's origin is farther from the light than 10³ r, and r/α ≤ 10¹³; in the
            table by distance wherever the origin is; in all tables but the first for α ≥ 0.01
  D, …      the largest relative errors of D (of the half vector as rounded to f32), G1 (of μ as
            rounded), F (of cosθ_h as rounded), F_max and r (of the directions, made unit exactly),
            against double-double, where the exact value is at least 10⁻³⁰; F_max and r of the crate
            are rounded up on purpose, r by what a tilt of its rounded axis costs, 5·10⁻⁸/2α
  distance  of the light from the world's origin over its range
  range     how far the light reaches at the peak of its lobe, r/α for F = 1
r is the short semi-axis of the bounding spheroid.";

fn heading(name: &str) -> String {
    let symbols = SYMBOLS.map(|symbol| format!("{symbol:>8}")).concat();
    format!(
        "\n{:>10} {:>5} {:>8} {:>10}  crate:{symbols}  port:{symbols}",
        name, "lost", "port", "volume"
    )
}

/// One row for each of `values` of one axis, over all others; volumes for roughness from `least_alpha`.
fn rows<T: PartialEq + Copy + Display + LowerExp>(
    measured: &Measured,
    values: &[T],
    axis: impl Fn(&Cell) -> T,
    least_alpha: f32,
    inflation: impl Fn(&Tally) -> Mean,
) -> Vec<String> {
    let row = |value: &T| {
        let of = |least: f32| {
            let cells = measured
                .iter()
                .filter(|(cell, _)| axis(cell) == *value && cell.alpha >= least);
            Tally::of(cells.map(|(_, tally)| tally))
        };
        let tally = of(0.0);
        format!(
            "{:>10} {:>5} {:>8} {:>10}        {}       {}",
            format!("{value:e}"),
            tally.lost,
            percent(tally.port_lost),
            percent(inflation(&of(least_alpha))),
            errors(&tally.errors),
            errors(&tally.port_errors),
        )
    };
    values.iter().map(row).collect()
}

fn errors(errors: &Quantities<f64>) -> String {
    errors.map(|error| format!("{error:>8.0e}")).concat()
}

fn percent(mean: Mean) -> String {
    mean.get().map_or_else(
        || "–".into(),
        |mean| match 100.0 * mean {
            large if large >= 1000.0 => format!("{large:.1e}"),
            share => format!("{share:.3}"),
        },
    )
}

fn thin_text(thin: &[thin_tiles::Row]) -> String {
    let mut lines = vec![
        "\nPoints 0.1 % inside the isosurface, in the thinnest tiles; F = 1, range 1, the light at\n\
         distance 1 from the origin, μ from 0.1 to 0.95, the eye at 0.1 to 10 times the reach:"
            .into(),
        format!(
            "{:>10} {:>21} {:>21}\n{:>10} {:>10} {:>10} {:>10} {:>10}",
            "", "about the peak", "any direction", "α", "lost, %", "port, %", "lost, %", "port, %"
        ),
    ];
    lines.extend(thin.iter().map(|row| {
        let share = |lost| format!("{:>10.3}", 100.0 * lost as f64 / row.cases as f64);
        let shares = row.lost.as_flattened().iter().copied().map(share);
        let shares: Vec<String> = shares.collect();
        format!("{:>10} {}", row.alpha, shares.join(" "))
    }));
    lines.join("\n")
}
