//! Microfacets, Fresnel factors and lobes.

use stochastic_light_culling::{
    Conductor, Dielectric, GgxLobe, HeightCorrelated, LambertLobe, Lobe, MaskingShadowing,
    NoFresnel, PhongLobe, Schlick, Separable,
};
use support::reference::{Brdf, Fresnel, Masking, ggx_ndf, smith_g1, smith_g2};

use super::{Bench, Case, METAL, off};

const GLASS: f32 = 1.5;
const GOLD: (f32, f32) = (0.2, 3.5);

pub fn microfacets(bench: &mut Bench) {
    let kind = "microfacets";
    bench.add(
        (kind, "D"),
        |case| (case.ggx(), *case.incoming + *case.outgoing, *case.normal),
        |(ggx, half, normal)| ggx.ndf_at(*half, *normal),
        |case, d| {
            off(
                d,
                ggx_ndf(case.roughness.into(), case.half(), case.surface().normal),
            )
        },
    );
    bench.add(
        (kind, "G1"),
        |case| (case.ggx(), case.cosines()[0]),
        |(ggx, cosine)| ggx.masking(*cosine),
        |case, g| off(g, smith_g1(case.roughness.into(), case.exact_cosines()[0])),
    );
    bench.add(
        (kind, "G2, height-correlated"),
        |case| (case.ggx(), case.cosines()),
        |(ggx, [i, o])| HeightCorrelated::masking_shadowing(*ggx, *i, *o),
        |case, g| {
            let [i, o] = case.exact_cosines();
            off(
                g,
                smith_g2(case.roughness.into(), Masking::HeightCorrelated, i, o),
            )
        },
    );
    bench.add(
        (kind, "G2, separable"),
        |case| (case.ggx(), case.cosines()),
        |(ggx, [i, o])| Separable::masking_shadowing(*ggx, *i, *o),
        |case, g| {
            let [i, o] = case.exact_cosines();
            off(g, smith_g2(case.roughness.into(), Masking::Separable, i, o))
        },
    );
}

pub fn fresnel(bench: &mut Bench) {
    fn add<F: stochastic_light_culling::Fresnel>(
        bench: &mut Bench,
        [of_f, of_max]: [&'static str; 2],
        fresnel: F,
        exact: Fresnel,
    ) {
        bench.add(
            ("Fresnel", of_f),
            |case| case.half_cosine() as f32,
            |cosine| fresnel.reflectance(*cosine),
            |case, f| off(f, exact.at(f64::from(case.half_cosine() as f32))),
        );
        bench.add(
            ("Fresnel", of_max),
            |case| case.lobe(fresnel),
            GgxLobe::max_fresnel,
            |case, f| off(f, exact.max_above_surface(case.exact_cosines()[0])),
        );
    }
    let schlick = Schlick::new(METAL).expect("in range");
    add(
        bench,
        ["F, Schlick", "F_max, Schlick"],
        schlick,
        Fresnel::Schlick(METAL),
    );
    let glass = Dielectric::new(GLASS).expect("in range");
    add(
        bench,
        ["F, dielectric", "F_max, dielectric"],
        glass,
        Fresnel::Dielectric(GLASS),
    );
    let gold = Conductor::new(GOLD.0, GOLD.1).expect("in range");
    add(
        bench,
        ["F, conductor", "F_max, conductor"],
        gold,
        Fresnel::Conductor(GOLD.0, GOLD.1),
    );
}

pub fn lobes(bench: &mut Bench) {
    let kind = "lobes, f·cos";
    bench.add(
        (kind, "GGX"),
        |case| (case.lobe(NoFresnel), *case.outgoing),
        |(lobe, outgoing)| lobe.value(*outgoing),
        |case, value| off(value, case.value(case.brdf(Fresnel::None))),
    );
    bench.add(
        (kind, "GGX, Schlick"),
        |case| {
            (
                case.lobe(Schlick::new(METAL).expect("in range")),
                *case.outgoing,
            )
        },
        |(lobe, outgoing)| lobe.value(*outgoing),
        |case, value| off(value, case.value(case.brdf(Fresnel::Schlick(METAL)))),
    );
    bench.add(
        (kind, "Lambert"),
        |case| {
            (
                LambertLobe::new(0.8, case.normal).expect("in range"),
                *case.outgoing,
            )
        },
        |(lobe, outgoing)| lobe.value(*outgoing),
        |case, value| off(value, case.value(Brdf::Lambert { albedo: 0.8 })),
    );
    let exponent = |case: &Case| 2.0 / (case.roughness * case.roughness).max(1e-2);
    bench.add(
        (kind, "Phong"),
        |case| {
            let lobe = PhongLobe::new(0.8, exponent(case), case.incidence());
            (lobe.expect("in range"), *case.outgoing)
        },
        |(lobe, outgoing)| lobe.value(*outgoing),
        |case, value| {
            off(
                value,
                case.value(Brdf::Phong {
                    albedo: 0.8,
                    exponent: exponent(case),
                }),
            )
        },
    );
}
