//! Ways to light receivers.

use common::frame::{Frame, GlossyLight, Reference, Slicing, Tiles, timed};
use common::reflect::{Decided, Division, Known, Receiving, Roulettes, Scenery, White};
use common::sampling::{LightTrees, Profiled, shade_by_tree, shade_resampled};
use stochastic_light_culling::{Interleave, Receiver, Seed, TileProbability, glam::Vec3};

use crate::figure::{Line, Look};
use crate::subject::Subject;

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Way {
    Culled {
        roulettes: Roulettes,
        tile: u32,
        parts: u32,
    },
    /// By importance in a light tree, out of the lights of the pixel's subregion or of all lights.
    Tree { is_interleaved: bool },
    /// Of 32 candidates each.
    Resampled { is_interleaved: bool },
}

/// How fine a way is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Setting {
    Delta(f32),
    /// How many lights a pixel keeps.
    Samples(usize),
}

/// In pixels.
const USUAL_TILE: u32 = 8;

/// What is best today: each pixel has a list by the tight bound, and decides by the light that arrives.
pub const TODAY: Way = culled(Known::Nothing, Decided::ByPixel, 1, 1);

const fn culled(known: Known, decided: Decided, tile: u32, parts: u32) -> Way {
    let roulettes = Roulettes {
        known,
        decided,
        own_delta: false,
    };
    Way::Culled {
        roulettes,
        tile,
        parts,
    }
}

impl Way {
    pub fn all() -> Vec<Self> {
        let bound = Decided::ByTile(TileProbability::bound());
        let mean = Decided::ByTile(TileProbability::default());
        let own_delta = Self::Culled {
            roulettes: Roulettes {
                known: Known::Receivers,
                decided: mean,
                own_delta: true,
            },
            tile: USUAL_TILE,
            parts: 2,
        };
        vec![
            TODAY,
            culled(Known::Receivers, Decided::ByPixel, 4, 1),
            culled(Known::Nothing, bound, USUAL_TILE, 1),
            culled(Known::Nothing, mean, USUAL_TILE, 1),
            culled(Known::Receivers, bound, USUAL_TILE, 2),
            culled(Known::Receivers, mean, USUAL_TILE, 2),
            own_delta,
            culled(Known::Receivers, mean, 4, 2),
            culled(Known::Receivers, mean, 16, 4),
            Self::Tree {
                is_interleaved: true,
            },
            Self::Tree {
                is_interleaved: false,
            },
            Self::Resampled {
                is_interleaved: true,
            },
            Self::Resampled {
                is_interleaved: false,
            },
        ]
    }

    /// All lights of a tile, if δ lets it.
    pub const ALL_LIGHTS: Self = culled(Known::Nothing, Decided::ByPixel, 16, 1);

    pub fn name(self) -> String {
        let all = |is_interleaved| if is_interleaved { "" } else { ", all lights" };
        match self {
            Self::Culled {
                roulettes, tile, ..
            } => {
                let known = match roulettes.known {
                    Known::Nothing => "blind",
                    Known::Receivers => "aware",
                };
                match roulettes.decided {
                    _ if roulettes.own_delta => format!("{known}, rms, own δ"),
                    Decided::ByPixel => format!("{known} exact"),
                    Decided::ByTile(p) if p == TileProbability::bound() => {
                        format!("{known} by tile, bound")
                    }
                    Decided::ByTile(_) if tile == USUAL_TILE => format!("{known} by tile, rms"),
                    Decided::ByTile(_) => format!("{known}, rms, {tile}×{tile}"),
                }
            }
            Self::Tree { is_interleaved } => format!("light tree{}", all(is_interleaved)),
            Self::Resampled { is_interleaved } => format!("RIS of 32{}", all(is_interleaved)),
        }
    }

    pub fn look(self) -> Look {
        let (color, is_dashed) = match self {
            Self::Culled {
                roulettes, tile, ..
            } => {
                let color = match (roulettes.known, roulettes.decided) {
                    (Known::Receivers, Decided::ByTile(_)) if tile < USUAL_TILE => 5,
                    (Known::Receivers, Decided::ByTile(_)) if tile > USUAL_TILE => 5,
                    (Known::Nothing, Decided::ByPixel) => 6,
                    (Known::Receivers, Decided::ByPixel) => 0,
                    (Known::Nothing, Decided::ByTile(_)) => 7,
                    (Known::Receivers, Decided::ByTile(_)) => 1,
                };
                let bound = Decided::ByTile(TileProbability::bound());
                let color = if roulettes.own_delta { 2 } else { color };
                (color, roulettes.decided == bound || roulettes.own_delta)
            }
            Self::Tree { is_interleaved } => (3, !is_interleaved),
            Self::Resampled { is_interleaved } => (4, !is_interleaved),
        };
        let line = if is_dashed { Line::Dashed } else { Line::Solid };
        Look { color, line }
    }

    /// Whether a pixel has the lights of its subregion alone.
    pub fn is_interleaved(self) -> bool {
        match self {
            Self::Culled { .. } => true,
            Self::Tree { is_interleaved } | Self::Resampled { is_interleaved } => is_interleaved,
        }
    }

    /// From coarse to fine, where receivers reflect the radiance `mean` in the mean.
    pub fn settings(self, mean: f64, is_quick: bool) -> Vec<Setting> {
        let (steps, fall) = if is_quick { (4, 1.0) } else { (9, 0.5) };
        let deltas = |first: f64| -> Vec<Setting> {
            let step = |i: i32| first * 10_f64.powf(-fall * f64::from(i));
            (0..steps).map(|i| Setting::Delta(step(i) as f32)).collect()
        };
        let samples = [1, 2, 4, 8].map(Setting::Samples).into();
        match self {
            Self::Culled { roulettes, .. } => match roulettes.known {
                Known::Nothing => deltas(0.1),
                Known::Receivers => deltas(10.0 * mean),
            },
            Self::Tree { .. } => deltas(10.0 * mean),
            Self::Resampled { .. } => samples,
        }
    }
}

/// Receivers in a frame, with or without interleaving.
pub struct Stage<'a> {
    pub subject: &'a Subject<'a>,
    pub interleave: Interleave,
    pub lights: Vec<GlossyLight>,
    /// For each size of a tile.
    tiles: Vec<(u32, Tiles)>,
}

impl<'a> Stage<'a> {
    pub fn new(subject: &'a Subject<'a>, interleave: Interleave, lights: Vec<GlossyLight>) -> Self {
        let sizes = [1, 2, 4, 8, 16];
        let tiles = |size| {
            let tiles = subject.tiles(&interleave, size, Slicing::ModifiedHalfZ);
            (size, tiles)
        };
        Self {
            subject,
            interleave,
            lights,
            tiles: sizes.map(tiles).into(),
        }
    }

    pub fn frame(&self, delta: f32) -> Frame<'a> {
        self.subject.frame(self.interleave, delta)
    }

    /// The tiles of one of the sizes that ways have.
    pub fn tiles(&self, size: u32) -> &Tiles {
        let of_size = self.tiles.iter().find(|(of_these, _)| *of_these == size);
        &of_size.expect("one of the sizes").1
    }

    /// The pixels that are compared.
    pub fn compared<R>(&self, receivers: &[Option<Receiver<R>>]) -> Vec<usize> {
        let pixels = Reference::pixels(&self.frame(1.0), self.subject.stride());
        let is_seen = |pixel: &usize| receivers[*pixel].is_some();
        pixels.into_iter().filter(is_seen).collect()
    }

    /// The radiance of all pixels, and the milliseconds that it takes.
    pub fn light<R: Receiving + Profiled>(
        &self,
        way: Way,
        setting: Setting,
        receivers: &[Option<Receiver<R>>],
        lights: &[GlossyLight],
        seed: Seed,
    ) -> (Vec<Vec3>, f64) {
        match (way, setting) {
            (
                Way::Culled {
                    roulettes,
                    tile,
                    parts,
                },
                Setting::Delta(delta),
            ) => {
                let tiles = self.tiles(tile);
                let scenery = Scenery {
                    frame: &self.frame(delta),
                    camera: &self.subject.camera,
                    lights,
                    receivers,
                    palette: White,
                };
                let lit = scenery.light(roulettes, Division { tiles, parts });
                let lit = lit.expect("fewer pairs than a u32 counts");
                let ms = lit.ms();
                (lit.radiance, ms)
            }
            (Way::Tree { .. }, Setting::Delta(delta)) => timed(|| {
                let frame = self.frame(delta);
                let trees = LightTrees::new(&frame, lights);
                shade_by_tree(&frame, lights, &trees, receivers, delta, seed)
            }),
            (Way::Resampled { .. }, Setting::Samples(samples)) => {
                timed(|| shade_resampled(&self.frame(1.0), lights, receivers, samples, seed))
            }
            _ => unreachable!("each way has settings of its own"),
        }
    }
}
