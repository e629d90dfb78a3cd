//! Families of lobes, and caps of directions, of any numbers.

use std::fmt::Debug;

use stochastic_light_culling::{
    AnisotropicGgx, AnisotropicGgxLobe, Cap, Direction, Fresnel, FresnelMajorant, Ggx, GgxLobe,
    Incidence, LambertLobe, LobeFamily, LobeSum, LtcLobe, NoFresnel, PhongLobe, ReceiverLobe,
    SphericalGaussian,
};

use crate::bits::Bits;
use crate::construct::directions;

pub fn families(bits: &mut Bits) {
    match bits.byte() % 6 {
        0 => family(bits, lambert),
        1 => family(bits, glossy),
        2 => family(bits, |bits| {
            let roughness = [bits.number(), bits.number()];
            let ggx = AnisotropicGgx::new(roughness[0], roughness[1]).ok()?;
            let (incidence, [tangent, _]) = (incidence(bits)?, directions(bits)?);
            AnisotropicGgxLobe::new(ggx, NoFresnel, incidence, tangent).ok()
        }),
        3 => family(bits, |bits| {
            let numbers = [bits.number(), bits.number()];
            PhongLobe::new(numbers[0], numbers[1], incidence(bits)?).ok()
        }),
        4 => {
            family(bits, |bits| {
                let [axis, _] = directions(bits)?;
                SphericalGaussian::new(axis, bits.number(), bits.number()).ok()
            });
            family(bits, |bits| {
                let (elements, incidence) = ([(); 4].map(|()| bits.number()), incidence(bits)?);
                LtcLobe::with_matrix(elements, bits.number(), incidence).ok()
            });
        }
        _ => family(bits, |bits| {
            let weights = [bits.number(), bits.number()];
            LobeSum::weighted(weights, lambert(bits)?, glossy(bits)?).ok()
        }),
    }
}

fn incidence(bits: &mut Bits) -> Option<Incidence> {
    let [normal, incoming] = directions(bits)?;
    Some(Incidence { normal, incoming })
}

fn lambert(bits: &mut Bits) -> Option<LambertLobe> {
    let [normal, _] = directions(bits)?;
    LambertLobe::new(bits.number(), normal).ok()
}

/// A factor that is its own majorant, or 1 where that means nothing.
#[derive(Clone, Copy, Debug)]
struct WildMajorant([f32; 2]);

impl Fresnel for WildMajorant {
    fn reflectance(&self, half_angle_cosine: f32) -> f32 {
        let [base, rise] = self.0;
        if base >= 1e-30 && (0.0..=f32::MAX).contains(&rise) {
            (base + rise * (1.0 - half_angle_cosine).powi(5)).min(1.0)
        } else {
            1.0
        }
    }

    fn majorant(&self) -> FresnelMajorant {
        let [base, rise] = self.0;
        FresnelMajorant { base, rise }
    }
}

fn glossy(bits: &mut Bits) -> Option<GgxLobe<WildMajorant>> {
    let wild = WildMajorant([bits.number(), bits.number()]);
    let ggx = Ggx::new(bits.number()).ok()?;
    Some(GgxLobe::new(ggx, wild, incidence(bits)?))
}

fn family<L: ReceiverLobe + Debug>(bits: &mut Bits, lobe: impl Fn(&mut Bits) -> Option<L>) {
    let lobes = [lobe(bits), lobe(bits)];
    let families = || lobes.iter().flatten().map(L::family);
    let Some(family) = L::Family::union(families()) else {
        return;
    };
    assert_eq!(L::Family::union([family].into_iter()), Some(family));
    let axis = Direction::new(bits.vector()).unwrap_or(Direction::X);
    let caps = [
        Cap::new(axis, bits.number()),
        Cap::new(axis, 0.0),
        Ok(Cap::all()),
        Ok(Cap::of_sphere(bits.vector(), bits.vector(), bits.number())),
    ];
    for cap in caps.into_iter().flatten() {
        let most = family.greatest_within(&cap);
        assert!(most >= 0.0, "{most} in {cap:?}: {family:?}");
        for lobe in lobes.iter().flatten() {
            let (alone, value) = (lobe.maximum_within(&cap), lobe.value(*cap.axis()));
            assert!(
                value <= alone && value <= most,
                "{value} {alone} {most} {lobe:?}"
            );
        }
    }
    let both = Cap::union(caps.into_iter().flatten()).expect("there is one at least");
    assert!(both.chord() <= 2.0);
}
