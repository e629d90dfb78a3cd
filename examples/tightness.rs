//! How tight the bounds are, as a table: volumes of the tight ellipsoid and of the smallest ellipsoid
//! that there is, over the volume of the paper's spheroid.
//!
//! ```text
//! cargo run --release --example tightness -- --csv
//! ```

use std::process::ExitCode;

use clap::Parser;
use common::command::{self, say};
use rayon::prelude::*;
use support::tightness::{self, DIELECTRICS, METALS, Place, Volumes};

/// Volumes of the bounds of a GGX lobe over that of the paper's spheroid.
#[derive(Parser)]
struct Arguments {
    /// One line for each lobe: alpha, incidence_degrees, fresnel, tight, attainable.
    #[arg(long)]
    csv: bool,
}

fn main() -> ExitCode {
    command::run(|arguments: Arguments| {
        run(&arguments);
        Ok(())
    })
}

fn run(arguments: &Arguments) {
    let classes = [("metals", &METALS[..]), ("dielectrics", &DIELECTRICS[..])];
    if arguments.csv {
        say(format_args!(
            "alpha,incidence_degrees,fresnel,tight,attainable"
        ));
    }
    for (name, reflectances) in classes {
        let measured: Vec<(Place, Volumes)> = tightness::grid(reflectances)
            .into_par_iter()
            .map(|place| (place, place.measure()))
            .collect();
        if arguments.csv {
            print_lines(&measured);
        } else {
            print_tables(name, reflectances, &measured);
        }
    }
}

fn print_lines(measured: &[(Place, Volumes)]) {
    for (place, volumes) in measured {
        say(format_args!(
            "{},{},{},{:.4},{:.4}",
            place.roughness, place.degrees, place.f0, volumes.tight, volumes.attainable
        ));
    }
}

fn print_tables(name: &str, reflectances: &[f32], measured: &[(Place, Volumes)]) {
    for f0 in reflectances {
        say(format_args!(
            "F0 = {f0}: tight / attainable, the paper's spheroid being 1"
        ));
        let angles = tightness::DEGREES.map(|degrees| format!("{:>13}", format!("{degrees}°")));
        say(format_args!("{:>7}{}", "α", angles.concat()));
        for roughness in tightness::ROUGHNESSES {
            let row = measured
                .iter()
                .filter(|(place, _)| place.f0 == *f0 && place.roughness == roughness);
            let row = row.map(|(_, v)| format!("{:>7.3}/{:<5.3}", v.tight, v.attainable));
            say(format_args!("{roughness:>7}{}", row.collect::<String>()));
        }
        say(format_args!(""));
    }
    let ratios = || measured.iter().map(|(_, v)| v.tight / v.attainable);
    say(format_args!(
        "{name}: {:.3} times the attainable in the mean, {:.3} at most\n",
        ratios().sum::<f64>() / measured.len() as f64,
        ratios().fold(0.0, f64::max)
    ));
}
