//! The frame by what its surfaces reflect to the eye, by culling and roulette that know of them and that do not.

use std::f32::consts::FRAC_1_PI;

use common::frame::{Frame, GlossyLight, Reference, Tiles};
use common::picture::{Exposure, tone_mapped, write_png};
use common::reflect::{
    Decided, Division, Known, Palette, Reflected, Roulettes, Scenery, Sums, receivers_of,
};
use common::scene::{Gloss, Material, Scene, Surface};
use stochastic_light_culling::{
    BlockEstimates, Camera, Error, Estimate, GgxLobe, Incidence, LambertLobe, LobeSum, PointBlock,
    Receiver, Roulette, Schlick, TileProbability, glam::Vec3,
};

use crate::arguments::{Arguments, ReferenceKind};
use crate::output::Row;

/// What a surface reflects: light that a coat and its base reflect.
type Lobe = LobeSum<LambertLobe, GgxLobe<Schlick>>;

/// A frame, and what it is seen by.
pub struct View<'a> {
    pub scene: &'a Scene,
    pub camera: &'a Camera,
    pub frame: &'a Frame<'a>,
    pub lights: &'a [GlossyLight],
    /// Tiles of the size that is asked for, and of one pixel.
    pub tiles: [&'a Tiles; 2],
    /// Of glossy materials without one of their own.
    pub gloss: Gloss,
}

/// A surface: its diffuse albedo, and the colour and gloss of its coat.
struct Coated {
    albedo: Vec3,
    tint: Vec3,
    gloss: Gloss,
}

impl Coated {
    fn new(material: &Material, gloss: Gloss, coat: Option<Gloss>) -> Self {
        match coat {
            // What the coat leaves goes to the base.
            Some(gloss) => Self {
                albedo: material.albedo * (1.0 - gloss.fresnel.f0()),
                tint: Vec3::ONE,
                gloss,
            },
            None => Self {
                albedo: material.true_albedo(),
                tint: if material.glossy {
                    material.tint
                } else {
                    Vec3::ZERO
                },
                gloss: material.gloss.unwrap_or(gloss),
            },
        }
    }

    /// The lobe in the brightest channels.
    fn lobe(&self, incidence: Incidence) -> Result<Lobe, Error> {
        let share = |color: Vec3| color.max_element().clamp(0.0, 1.0);
        let base = LambertLobe::new(share(self.albedo), incidence.normal)?;
        let coat = GgxLobe::new(self.gloss.ggx, self.gloss.fresnel, incidence);
        LobeSum::weighted([1.0, share(self.tint)], base, coat)
    }
}

/// The colours of base and coat at each pixel.
struct Colors<'a> {
    surfaces: &'a [Surface],
    /// Of each material: what its base reflects in all directions, and both colours over that of their brightest
    /// channel.
    materials: Vec<(f32, [Vec3; 2])>,
}

impl Colors<'_> {
    /// What a pixel reflects of a light that arrives with `radiance` from `direction`, of which it reflects the share
    /// `reflected` in the brightest channels.
    #[inline(always)]
    fn at(&self, pixel: usize, radiance: f32, direction: Vec3, reflected: f32) -> Vec3 {
        let surface = &self.surfaces[pixel];
        let (base, [of_base, of_coat]) = self.materials[surface.material];
        let cosine = (-direction).dot(surface.normal).max(0.0);
        let diffuse = (radiance * base * cosine).min(reflected);
        of_base * diffuse + of_coat * (reflected - diffuse)
    }
}

impl Palette for Colors<'_> {
    fn add(
        &self,
        pixels: &[usize],
        estimates: &BlockEstimates,
        reflected: &[f32; PointBlock::LEN],
        tint: Vec3,
        sums: &mut Sums,
    ) {
        let [x, y, z] = &estimates.direction;
        for (i, pixel) in pixels.iter().enumerate() {
            if reflected[i] > 0.0 {
                let direction = Vec3::new(x[i], y[i], z[i]);
                let color = self.at(*pixel, estimates.radiance[i], direction, reflected[i]);
                for (sums, more) in sums.iter_mut().zip((color * tint).to_array()) {
                    sums[i] += more;
                }
            }
        }
    }

    fn colored(&self, pixel: usize, estimate: &Estimate, reflected: f32, tint: Vec3) -> Vec3 {
        tint * self.at(pixel, estimate.radiance, estimate.direction, reflected)
    }
}

/// The ways to draw lights, by the names that they have in the table.
fn ways() -> [(&'static str, Roulettes, bool); 4] {
    let way = |known, decided| Roulettes { known, decided };
    let by_tile = Decided::ByTile(TileProbability::default());
    [
        ("blind", way(Known::Nothing, Decided::ByPixel), true),
        ("blind tile", way(Known::Nothing, by_tile), false),
        ("aware", way(Known::Receivers, Decided::ByPixel), false),
        ("aware tile", way(Known::Receivers, by_tile), false),
    ]
}

/// The frame in each way, a row of the table for each, and pictures of the last and of all lights.
///
/// δ is arriving radiance for ways that know nothing of receivers. For the others it is that which a white diffuse surface
/// makes of it, 1/π times as much.
pub fn measure(arguments: &Arguments, view: &View) -> Result<Vec<Row>, String> {
    let said = |error: Error| error.to_string();
    let coat = arguments.coat().map_err(said)?;
    if coat.is_none() && !view.scene.has_own_gloss() {
        return Ok(Vec::new());
    }
    let surfaces = view.frame.surfaces;
    let coated: Vec<Coated> = (view.scene.mesh.materials.iter())
        .map(|material| Coated::new(material, view.gloss, coat))
        .collect();
    let lobe = |pixel: usize, incidence| {
        coated[surfaces.surfaces[pixel].material]
            .lobe(incidence)
            .ok()
    };
    let receivers: Vec<Option<Receiver<Lobe>>> = receivers_of(surfaces, view.camera, lobe)
        .into_iter()
        .map(|receiver| {
            let Receiver { position, lobe } = receiver?;
            lobe.map(|lobe| Receiver { position, lobe })
        })
        .collect();
    let light = |delta: f32, roulettes, tiles: &Tiles| -> Result<Reflected, Error> {
        let frame = Frame {
            surfaces,
            interleave: view.frame.interleave,
            roulette: Roulette::new(delta)?,
            least_distance_squared: view.frame.least_distance_squared,
        };
        let over_brightest = |color: Vec3| color / color.max_element().max(f32::MIN_POSITIVE);
        let scenery = Scenery {
            frame: &frame,
            camera: view.camera,
            lights: view.lights,
            receivers: &receivers,
            palette: Colors {
                surfaces: &surfaces.surfaces,
                materials: (coated.iter())
                    .map(|coated| {
                        let base = coated.albedo.max_element().clamp(0.0, 1.0) * FRAC_1_PI;
                        (base, [coated.albedo, coated.tint].map(over_brightest))
                    })
                    .collect(),
            },
            before: None,
        };
        scenery.light(roulettes, Division { tiles, parts: 1 })
    };

    let [tiles, pixels] = view.tiles;
    let delta = arguments.delta.delta();
    let mut lit = Vec::new();
    for (name, roulettes, is_refined) in ways() {
        let delta = match roulettes.known {
            Known::Nothing => delta,
            Known::Receivers => (delta * FRAC_1_PI).max(f32::MIN_POSITIVE),
        };
        let division = if is_refined { pixels } else { tiles };
        lit.push((
            name,
            is_refined,
            light(delta, roulettes, division).map_err(said)?,
        ));
    }
    // For so small a δ nothing is left to chance.
    let all = match arguments.reference {
        Some(ReferenceKind::Off) => None,
        _ => Some(light(1e-30, ways()[0].1, tiles).map_err(said)?.radiance),
    };
    if let Some((_, _, last)) = lit.last() {
        let exposure = Exposure::of(all.as_ref().unwrap_or(&last.radiance));
        let pictures = [
            ("receivers.png", Some(&last.radiance)),
            ("receivers-all.png", all.as_ref()),
        ];
        for (name, radiance) in pictures {
            if let Some(radiance) = radiance {
                let picture = tone_mapped(arguments.size, radiance, exposure);
                write_png(&arguments.out, name, &picture)?;
            }
        }
    }
    let seen = Reference::pixels(view.frame, 1);
    let rows = lit.into_iter().map(|(name, refined, lit)| {
        let error = |all: &Vec<Vec3>| {
            let squared = |pixel: &usize| {
                f64::from((lit.radiance[*pixel] - all[*pixel]).length_squared()) / 3.0
            };
            (seen.iter().map(squared).sum::<f64>() / seen.len().max(1) as f64).sqrt()
        };
        Row {
            bound: name,
            refined,
            lights_per_pixel: common::frame::mean_over_surfaces(surfaces, &lit.evaluated),
            contributing_per_pixel: common::frame::mean_over_surfaces(surfaces, &lit.contributing),
            cull_ms: lit.cull_ms,
            shade_ms: lit.shade_ms,
            rmse: all.as_ref().map(error),
        }
    });
    Ok(rows.collect())
}
