//! Ways to light receivers.

use common::frame::{Frame, GlossyLight, Reference, Slicing, Tiles, timed};
use common::reflect::{Decided, Division, Known, Receiving, Roulettes, Scenery, Shown, White};
use common::sampling::{LightTrees, Profiled, shade_by_tree, shade_resampled};
use stochastic_light_culling::{Interleave, Receiver, Seed, TileProbability, glam::Vec3};

use crate::figure::{Line, Look};
use crate::subject::Subject;

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Way {
    Culled {
        roulettes: Roulettes,
        tile: u32,
        /// Whether a tile has a δ in proportion to what it shows.
        is_even: bool,
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
pub const TODAY: Way = culled(Known::Nothing, Decided::ByPixel, 1);

const fn culled(known: Known, decided: Decided, tile: u32) -> Way {
    Way::Culled {
        roulettes: Roulettes { known, decided },
        tile,
        is_even: false,
    }
}

impl Way {
    pub fn all() -> Vec<Self> {
        let bound = Decided::ByTile(TileProbability::bound());
        let mean = Decided::ByTile(TileProbability::default());
        let even = |known| Self::Culled {
            roulettes: Roulettes {
                known,
                decided: mean,
            },
            tile: USUAL_TILE,
            is_even: true,
        };
        vec![
            TODAY,
            culled(Known::Receivers, Decided::ByPixel, 4),
            culled(Known::Nothing, bound, USUAL_TILE),
            culled(Known::Nothing, mean, USUAL_TILE),
            even(Known::Nothing),
            culled(Known::Receivers, bound, USUAL_TILE),
            culled(Known::Receivers, mean, USUAL_TILE),
            even(Known::Receivers),
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
    pub const ALL_LIGHTS: Self = culled(Known::Nothing, Decided::ByPixel, 16);

    pub fn name(self) -> String {
        let all = |is_interleaved| if is_interleaved { "" } else { ", all lights" };
        match self {
            Self::Culled {
                roulettes, is_even, ..
            } => {
                let known = match roulettes.known {
                    Known::Nothing => "blind",
                    Known::Receivers => "aware",
                };
                match roulettes.decided {
                    _ if is_even => format!("{known}, δ by tile"),
                    Decided::ByPixel => format!("{known} exact"),
                    Decided::ByTile(p) if p == TileProbability::bound() => {
                        format!("{known} by tile, bound")
                    }
                    Decided::ByTile(_) => format!("{known} by tile, rms"),
                }
            }
            Self::Tree { is_interleaved } => format!("light tree{}", all(is_interleaved)),
            Self::Resampled { is_interleaved } => format!("RIS of 32{}", all(is_interleaved)),
        }
    }

    pub fn look(self) -> Look {
        let (color, is_dashed) = match self {
            Self::Culled {
                roulettes, is_even, ..
            } => {
                let color = match (roulettes.known, roulettes.decided) {
                    (Known::Nothing, _) if is_even => 5,
                    (Known::Receivers, _) if is_even => 2,
                    (Known::Nothing, Decided::ByPixel) => 6,
                    (Known::Receivers, Decided::ByPixel) => 0,
                    (Known::Nothing, Decided::ByTile(_)) => 7,
                    (Known::Receivers, Decided::ByTile(_)) => 1,
                };
                let bound = Decided::ByTile(TileProbability::bound());
                (color, roulettes.decided == bound)
            }
            Self::Tree { is_interleaved } => (3, !is_interleaved),
            Self::Resampled { is_interleaved } => (4, !is_interleaved),
        };
        let line = if is_dashed { Line::Dashed } else { Line::Solid };
        Look { color, line }
    }

    /// The same with one δ for all tiles, if it has a δ for each.
    pub fn with_one_delta(self) -> Option<Self> {
        match self {
            Self::Culled {
                roulettes, tile, ..
            } if self.is_even() => Some(culled(roulettes.known, roulettes.decided, tile)),
            _ => None,
        }
    }

    pub fn is_even(self) -> bool {
        matches!(self, Self::Culled { is_even: true, .. })
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
        let (steps, fall) = if is_quick { (4, 1.0) } else { (7, 0.75) };
        let deltas = |first: f64, steps: i32, fall: f64| -> Vec<Setting> {
            let step = |i: i32| first * 10_f64.powf(-fall * f64::from(i));
            (0..steps).map(|i| Setting::Delta(step(i) as f32)).collect()
        };
        let samples = [1, 4].map(Setting::Samples).into();
        match self {
            Self::Culled { roulettes, .. } => match roulettes.known {
                Known::Nothing => deltas(0.1, steps, fall),
                Known::Receivers => deltas(10.0 * mean, steps, fall),
            },
            Self::Tree { .. } => deltas(10.0 * mean, 3, 1.0),
            Self::Resampled { .. } => samples,
        }
    }
}

/// A frame by one of the ways.
pub struct Picture {
    /// Of all pixels.
    pub radiance: Vec<Vec3>,
    pub ms: f64,
    /// If there are tiles.
    pub shown: Option<Shown>,
}

impl Picture {
    /// Without tiles.
    fn timed(light: impl FnOnce() -> Vec<Vec3>) -> Self {
        let (radiance, ms) = timed(light);
        Self {
            radiance,
            ms,
            shown: None,
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
        let sizes = [1, 4, 8, 16];
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

    /// Lights all pixels. A way that needs what tiles showed `before` has that of other seeds.
    pub fn light<R: Receiving + Profiled>(
        &self,
        (way, setting): (Way, Setting),
        receivers: &[Option<Receiver<R>>],
        lights: &[GlossyLight],
        seed: Seed,
        before: Option<&Shown>,
    ) -> Picture {
        match (way, setting) {
            (
                Way::Culled {
                    roulettes, tile, ..
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
                    before,
                };
                let lit = scenery.light(roulettes, Division { tiles, parts: 1 });
                let lit = lit.expect("fewer pairs than a u32 counts");
                Picture {
                    ms: lit.ms(),
                    radiance: lit.radiance,
                    shown: Some(lit.shown),
                }
            }
            (Way::Tree { .. }, Setting::Delta(delta)) => Picture::timed(|| {
                let frame = self.frame(delta);
                let trees = LightTrees::new(&frame, lights);
                shade_by_tree(&frame, lights, &trees, receivers, delta, seed)
            }),
            (Way::Resampled { .. }, Setting::Samples(samples)) => Picture::timed(|| {
                shade_resampled(&self.frame(1.0), lights, receivers, samples, seed)
            }),
            _ => unreachable!("each way has settings of its own"),
        }
    }
}
