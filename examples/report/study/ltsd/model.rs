//! One frame with a model of what glossy surfaces reflect: lights, lists, and receivers, on one core.

use common::frame::{GlossyLight, Subregion, Tiles, timed};
use stochastic_light_culling::{
    BatchBuilder, Bounded, Culler, Direction, Ellipsoid, GgxLobe, Incidence, Interleave,
    LightBatch, LightLists, LtcLobe, PointBlock, ProjectedEllipsoid, RadianceEstimator, Receiver,
    ReceiverBlock, Roulette, Schlick, ShadingBatch, Vpl, Xi, glam::Vec3,
};

use crate::subject::{Gloss, Subject};

/// What glossy surfaces reflect.
pub trait Model: Bounded<Shape = Ellipsoid> + Copy + 'static {
    const NAME: &str;

    fn new(gloss: Gloss, incidence: Incidence) -> Self;

    /// Those of many surfaces.
    fn many(
        gloss: Gloss,
        incidences: impl Iterator<Item = Incidence>,
    ) -> impl Iterator<Item = Self> {
        incidences.map(move |incidence| Self::new(gloss, incidence))
    }
}

impl Model for GgxLobe<Schlick> {
    const NAME: &str = "ggx";

    fn new(gloss: Gloss, incidence: Incidence) -> Self {
        GgxLobe::new(gloss.ggx, gloss.fresnel, incidence)
    }
}

impl Model for LtcLobe {
    const NAME: &str = "ltc";

    fn new(gloss: Gloss, incidence: Incidence) -> Self {
        LtcLobe::new(gloss.ggx, gloss.fresnel, incidence)
    }

    fn many(
        gloss: Gloss,
        incidences: impl Iterator<Item = Incidence>,
    ) -> impl Iterator<Item = Self> {
        LtcLobe::many(incidences.map(move |incidence| (gloss.ggx, gloss.fresnel, incidence)))
    }
}

/// The pixels of a tile that see one depth interval.
pub struct Group {
    subregion: usize,
    tile: [u32; 2],
    interval: u32,
    pixels: Vec<usize>,
}

impl Group {
    pub fn all(subject: &Subject, interleave: &Interleave, tiles: &Tiles) -> Vec<Self> {
        let surfaces = &subject.surfaces;
        let mut groups = Vec::new();
        for (k, subregion) in (0..).zip(tiles.subregions()) {
            for tile in subregion.grid.tiles() {
                for interval in 0..subregion.depths.intervals() {
                    let pixels = subregion.grid.pixels(tile).pixels();
                    // By squares of 4×4, so that those of a vector see much the same lights.
                    let mut pixels: Vec<_> = pixels.collect();
                    pixels.sort_by_key(|[x, y]| [y / 4, x / 4]);
                    let pixels = pixels.into_iter();
                    let pixels = pixels.map(|pixel| interleave.join_pixel(k, pixel));
                    let is_here = |pixel: &[u32; 2]| {
                        let depth = surfaces.at(*pixel).depth;
                        subregion.depths.interval_of(tile, depth) == Some(interval)
                    };
                    groups.push(Self {
                        subregion: k as usize,
                        tile,
                        interval,
                        pixels: pixels.filter(is_here).map(|p| surfaces.index(p)).collect(),
                    });
                }
            }
        }
        groups
    }
}

/// What is lit and seen, whatever the model.
pub struct Setting<'a> {
    pub subject: &'a Subject<'a>,
    pub tiles: &'a Tiles,
    pub groups: &'a [Group],
    pub interleave: Interleave,
    pub lights: &'a [GlossyLight],
    /// Of the lights' surfaces, and of all that is seen.
    pub gloss: [Gloss; 2],
    pub delta: f32,
}

/// The radiance of each pixel, for red, green and blue.
pub type Picture = Vec<[f32; 3]>;

/// A frame, and the milliseconds that each step took.
pub struct Lit {
    pub picture: Picture,
    /// To make the lobes of all lights.
    pub make_ms: f64,
    /// To bound, project and cull the lights of each subregion.
    pub cull_ms: Vec<f64>,
    /// To make the receivers of each subregion, and to sum what they reflect.
    pub shade_ms: Vec<f64>,
    /// Lights in the list of a pixel, and those that it accepts, in the mean over pixels that see a surface.
    pub lights_per_pixel: [f64; 2],
}

/// The lights of one subregion.
struct Part<M> {
    lights: Vec<(Vpl<M>, Xi)>,
    tints: Vec<[f32; 3]>,
}

impl Setting<'_> {
    /// The frame by lists.
    pub fn light<M: Model>(&self) -> Lit {
        let roulette = Roulette::new(self.delta).expect("the studies choose it in range");
        let (parts, make_ms) = timed(|| self.parts::<M>());
        let builder = BatchBuilder::new(&roulette, &self.subject.camera);
        let mut culler = Culler::<ProjectedEllipsoid>::new();
        let mut lists: Vec<LightLists> = parts.iter().map(|_| LightLists::new()).collect();
        let mut batch = LightBatch::new();
        let mut cull = || -> Vec<f64> {
            let frame = parts.iter().zip(self.tiles.subregions()).zip(&mut lists);
            let one = |((part, subregion), lists): ((&Part<M>, &Subregion), &mut LightLists)| {
                batch.clear();
                let with_xi = (0..).zip(&part.lights);
                let with_xi = with_xi.map(|(i, (vpl, xi))| (i, vpl, *xi));
                builder.add(with_xi, &mut batch);
                culler
                    .cull(&batch, &subregion.depths, lists)
                    .expect("fewer pairs than a u32 counts");
            };
            frame.map(one_timed(one)).collect()
        };
        // The first time makes room. Like a later frame, the second does not.
        cull();
        let cull_ms = cull();
        let (picture, lights_per_pixel, shade_ms) =
            self.shade(&parts, &roulette, |subregion, tile, interval| {
                lists[subregion].of(tile, interval).to_vec()
            });
        Lit {
            picture,
            make_ms,
            cull_ms,
            shade_ms,
            lights_per_pixel,
        }
    }

    /// The frame by all lights, with none left to chance.
    pub fn exact<M: Model>(&self) -> Picture {
        let roulette = Roulette::new(1e-30).expect("in range");
        let parts = self.parts::<M>();
        let all = |subregion: usize, _, _| (0..parts[subregion].lights.len() as u32).collect();
        self.shade(&parts, &roulette, all).0
    }

    fn parts<M: Model>(&self) -> Vec<Part<M>> {
        let (interleave, count) = (&self.interleave, self.lights.len() as u32);
        let part = |subregion| {
            let lights = || {
                let locals = 0..interleave.lights_in(subregion, count);
                let indices = locals.map(|local| interleave.join_light(subregion, local));
                indices.map(|index| &self.lights[index as usize])
            };
            let incidences = lights().map(|light| light.vpl.lobe().incidence());
            let lobes = M::many(self.gloss[0], incidences);
            let made = lights().zip(lobes).map(|(light, lobe)| {
                let vpl = Vpl::new(light.vpl.position(), light.vpl.flux(), lobe);
                (vpl.expect("it was one"), light.xi)
            });
            Part {
                lights: made.collect(),
                tints: lights().map(|light| light.tint.into()).collect(),
            }
        };
        (0..interleave.subregions()).map(part).collect()
    }

    /// The position of each pixel's surface, and how light from the eye would arrive there.
    fn seen(&self) -> Vec<(Vec3, Incidence)> {
        let eye = self.subject.camera.to_world_space(Vec3::ZERO);
        let direction = |v| Direction::new(v).unwrap_or(Direction::Y);
        let surfaces = self.subject.surfaces.surfaces.iter();
        surfaces
            .map(|surface| {
                let incidence = Incidence {
                    normal: direction(surface.normal),
                    incoming: direction(eye - surface.position),
                };
                (surface.position, incidence)
            })
            .collect()
    }

    /// Sums over the list of each tile and depth interval, sixteen receivers at a time.
    fn shade<M: Model>(
        &self,
        parts: &[Part<M>],
        roulette: &Roulette,
        list_of: impl Fn(usize, [u32; 2], u32) -> Vec<u32>,
    ) -> (Picture, [f64; 2], Vec<f64>) {
        let seen = self.seen();
        let frame = self.subject.frame(self.interleave, self.delta);
        let estimator = RadianceEstimator::new(roulette)
            .with_least_distance_squared(frame.least_distance_squared)
            .expect("a mean of areas");
        let mut picture = vec![[0.0; 3]; seen.len()];
        let mut counts = [0_u64; 3];
        let mut batch = ShadingBatch::new();
        let is_same = |a: &Group, b: &Group| a.subregion == b.subregion;
        let subregions = self.groups.chunk_by(is_same);
        let mut shade = |groups: &[Group]| {
            let part = &parts[groups[0].subregion];
            batch.clear();
            batch.extend(part.lights.iter().map(|(vpl, xi)| (vpl, *xi)));
            for group in groups {
                let list = list_of(group.subregion, group.tile, group.interval);
                counts[0] += group.pixels.len() as u64;
                counts[1] += (group.pixels.len() * list.len()) as u64;
                let surfaces = || group.pixels.iter().map(|pixel| &seen[*pixel]);
                let lobes = M::many(self.gloss[1], surfaces().map(|(_, incidence)| *incidence));
                let mut receivers = surfaces().zip(lobes).map(|((position, _), lobe)| Receiver {
                    position: *position,
                    lobe,
                });
                for pixels in group.pixels.chunks(PointBlock::LEN) {
                    let Some(block) = ReceiverBlock::take(&mut receivers) else {
                        continue;
                    };
                    let mut sums = [[0.0; PointBlock::LEN]; 3];
                    estimator.reflected_at_block(&batch, &list, &block, |light, reflected| {
                        counts[2] += u64::from(light.accepted.count_ones());
                        let tint = part.tints[light.light as usize];
                        for (sums, tint) in sums.iter_mut().zip(tint) {
                            for (sum, reflected) in sums.iter_mut().zip(reflected) {
                                *sum += reflected * tint;
                            }
                        }
                    });
                    for (lane, pixel) in pixels.iter().enumerate() {
                        picture[*pixel] = sums.map(|sums| sums[lane]);
                    }
                }
            }
        };
        let shade_ms = subregions.map(one_timed(&mut shade)).collect();
        let [pixels, listed, accepted] = counts.map(|count| count as f64);
        let per_pixel = [listed, accepted].map(|count| count / pixels.max(1.0));
        (picture, per_pixel, shade_ms)
    }
}

/// The milliseconds that `step` takes, for each that it is called with.
fn one_timed<T>(mut step: impl FnMut(T)) -> impl FnMut(T) -> f64 {
    move |item| timed(|| step(item)).1
}
