//! Ways to light a frame by its glossy lights.

use common::frame::{
    BoundKind, Frame, GlossyLight, Slicing, Tiles, Tiling, measure_glossy, redraw, timed,
};
use stochastic_light_culling::{Interleave, Seed, Xi, glam::Vec3};

use crate::baseline::{cluster, splat};
use crate::figure::{Line, Look};
use crate::statistics::median;
use crate::subject::{Gloss, Subject};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// Lists for tiles of 16×16 pixels, or for pixels.
    Culled { bound: BoundKind, refined: bool },
    /// The polyhedron of 80 triangles around the tight ellipsoid of each light, drawn pixel by pixel
    /// [Dachsbacher & Stamminger 2006].
    Splatted,
    /// The polyhedron of 20 triangles, drawn conservatively into tiles and 32 slices
    /// [Örtegren & Persson 2016].
    Clustered,
    /// Without roulette, lights end where their radiance falls to δ: biased.
    Clamped,
}

/// The paper's own.
pub const PAPERS: Method = Method::Culled {
    bound: BoundKind::Spheroid,
    refined: false,
};

impl Method {
    /// Those that share δ's meaning, and are unbiased.
    pub fn culling() -> Vec<Self> {
        let by_bound = |bound| [false, true].map(|refined| Self::Culled { bound, refined });
        BoundKind::ALL
            .into_iter()
            .flat_map(by_bound)
            .chain([Self::Splatted, Self::Clustered])
            .collect()
    }

    pub fn name(self) -> String {
        match self {
            Self::Culled {
                bound,
                refined: false,
            } => bound.name().into(),
            Self::Culled {
                bound,
                refined: true,
            } => format!("{}, refined", bound.name()),
            Self::Splatted => "splatting, 80 triangles".into(),
            Self::Clustered => "raster clusters, 20 tri.".into(),
            Self::Clamped => "clamped range (biased)".into(),
        }
    }

    pub fn look(self) -> Look {
        let line = |refined| if refined { Line::Dashed } else { Line::Solid };
        match self {
            Self::Culled { bound, refined } => Look {
                color: bound as usize,
                line: line(refined),
            },
            Self::Splatted => Look {
                color: 5,
                line: Line::Solid,
            },
            Self::Clustered => Look {
                color: 5,
                line: Line::Dashed,
            },
            Self::Clamped => Look {
                color: 7,
                line: Line::Solid,
            },
        }
    }
}

/// What is kept from frame to frame.
pub struct Stage<'a> {
    pub subject: &'a Subject<'a>,
    pub gloss: Gloss,
    pub interleave: Interleave,
    tiles: Tiles,
    pixels: Tiles,
    clusters: Tiles,
}

/// A frame lit in some way.
pub struct Lit {
    /// To bound, cull and shade.
    pub ms: f64,
    pub irradiance: Vec<Vec3>,
}

impl<'a> Stage<'a> {
    pub fn new(subject: &'a Subject<'a>, gloss: Gloss, interleave_width: u32) -> Self {
        let interleave = subject.interleave(interleave_width);
        let tiles = |size, slicing| subject.tiles(&interleave, size, slicing);
        Self {
            subject,
            gloss,
            interleave,
            tiles: tiles(16, Slicing::ModifiedHalfZ),
            pixels: tiles(1, Slicing::ModifiedHalfZ),
            clusters: tiles(16, Slicing::Slices(cluster::SLICES)),
        }
    }

    pub fn frame(&self, delta: f32) -> Frame<'a> {
        self.subject.frame(self.interleave, delta)
    }

    /// The glossy lights of the `repetition`-th frame, with other places and other ξ than in the rest.
    pub fn lights(&self, repetition: u32) -> Vec<GlossyLight> {
        self.lights_of(self.subject.effort.vpls, repetition)
    }

    pub fn lights_of(&self, vpls: u32, repetition: u32) -> Vec<GlossyLight> {
        let seed = self.subject.seed_of(repetition);
        self.subject
            .lights(self.gloss, vpls, &self.interleave, seed)
            .glossy
    }

    /// The same lights in as many frames as there are repetitions: only ξ differs.
    pub fn frames(&self) -> Vec<Vec<GlossyLight>> {
        let lights = self.lights(0);
        // Seeds and not frames, for errors of frames are not independent.
        let again = |repetition| {
            let mut lights = lights.clone();
            let seed = Seed(self.subject.seed_of(repetition));
            redraw(&mut lights, &self.interleave, seed, 0);
            lights
        };
        (0..self.subject.effort.seeds).map(again).collect()
    }

    /// The frame with these lights.
    pub fn light(&self, method: Method, delta: f32, lights: &[GlossyLight]) -> Lit {
        let frame = self.frame(delta);
        match method {
            Method::Culled { bound, refined } => {
                let tiles = if refined { &self.pixels } else { &self.tiles };
                self.culled(&frame, bound, Tiling { tiles, refined }, lights)
            }
            Method::Clamped => {
                let xi = Xi::new(1.0).expect("in range");
                let clamped: Vec<GlossyLight> = lights
                    .iter()
                    .map(|light| GlossyLight { xi, ..*light })
                    .collect();
                let tiling = Tiling {
                    tiles: &self.tiles,
                    refined: false,
                };
                self.culled(&frame, BoundKind::Spheroid, tiling, &clamped)
            }
            Method::Splatted => {
                let (shaded, ms) = timed(|| splat::splat(&frame, &self.subject.camera, lights));
                Lit {
                    ms,
                    irradiance: shaded.irradiance,
                }
            }
            Method::Clustered => {
                let (shaded, ms) =
                    timed(|| cluster::light(&frame, &self.subject.camera, &self.clusters, lights));
                Lit {
                    ms,
                    irradiance: shaded.irradiance,
                }
            }
        }
    }

    fn culled(
        &self,
        frame: &Frame,
        bound: BoundKind,
        tiling: Tiling,
        lights: &[GlossyLight],
    ) -> Lit {
        let camera = &self.subject.camera;
        let mut measured = measure_glossy(frame, &[tiling], camera, lights, bound, || ())
            .expect("fewer pairs than a u32 counts");
        let measured = measured.remove(0);
        Lit {
            ms: measured.bound_ms + measured.cull_ms + measured.shade_ms,
            irradiance: measured.shaded.irradiance,
        }
    }

    /// The median of so many `times` that `method` takes.
    pub fn milliseconds(&self, method: Method, delta: f32, times: u32) -> f64 {
        let lights = self.lights(0);
        let times: Vec<f64> = (0..times)
            .map(|_| self.light(method, delta, &lights).ms)
            .collect();
        median(&times)
    }
}
