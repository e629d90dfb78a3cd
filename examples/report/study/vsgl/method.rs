//! Ways to light a frame, by points or by smooth lights.

use common::frame::{
    BoundKind, Clustering, Frame, LightMaps, Lights, Measured, Shading, Slicing, SmoothLight,
    Tiles, Tiling, measure_glossy, measure_smooth, smooth_lights, timed,
};
use common::scene::LitPoints;
use rayon::prelude::*;
use stochastic_light_culling::{Interleave, PointBlock, Roulette, ShadedPoint, glam::Vec3};

use crate::figure::{Line, Look};
use crate::subject::{Effort, Gloss, Subject};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Points, culled by the tight bound in lists of pixels.
    Vpl,
    /// All smooth lights at every pixel.
    Vsgl,
    /// Smooth lights, culled in lists of pixels.
    VsglCulled,
    /// All smooth lights, of clusters by k-means.
    Kmeans,
}

impl Kind {
    pub const ALL: [Self; 4] = [Self::Vpl, Self::Vsgl, Self::VsglCulled, Self::Kmeans];

    pub fn name(self) -> &'static str {
        match self {
            Self::Vpl => "vpl",
            Self::Vsgl => "vsgl",
            Self::VsglCulled => "vsgl_culled",
            Self::Kmeans => "kmeans",
        }
    }

    pub fn look(self) -> Look {
        Look {
            color: self as usize,
            line: Line::None,
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Setting {
    pub kind: Kind,
    /// How many rays make points, or how many clusters there are to be.
    pub count: u32,
    /// None where all lights are taken.
    pub delta: Option<f32>,
}

impl Setting {
    pub const fn points(count: u32, delta: f32) -> Self {
        Self {
            kind: Kind::Vpl,
            count,
            delta: Some(delta),
        }
    }

    pub const fn smooth(kind: Kind, count: u32) -> Self {
        Self {
            kind,
            count,
            delta: None,
        }
    }

    pub const fn culled(count: u32, delta: f32) -> Self {
        Self {
            kind: Kind::VsglCulled,
            count,
            delta: Some(delta),
        }
    }

    pub fn all(effort: &Effort) -> Vec<Self> {
        let (rays, clusters): (&[u32], &[u32]) = if effort.is_quick {
            (&[1 << 11], &[64])
        } else {
            (&[1 << 14, 1 << 16, 1 << 18], &[256, 1024])
        };
        let deltas: &[f32] = if effort.is_quick {
            &[1e-3]
        } else {
            &[1e-2, 1e-3, 1e-4]
        };
        let mut all = Vec::new();
        for count in rays {
            all.extend(deltas.iter().map(|delta| Self::points(*count, *delta)));
        }
        for kind in [Kind::Vsgl, Kind::Kmeans] {
            all.extend(clusters.iter().map(|count| Self::smooth(kind, *count)));
        }
        let culled: &[u32] = if effort.is_quick {
            clusters
        } else {
            &[1 << 8, 1 << 10, 1 << 12, 1 << 14]
        };
        // Of smooth lights δ adds noise alone, and little of it.
        let deltas = deltas.iter().filter(|delta| **delta < 1e-2);
        for count in culled {
            all.extend(deltas.clone().map(|delta| Self::culled(*count, *delta)));
        }
        all
    }
}

/// What is kept from frame to frame.
pub struct Stage<'a> {
    pub subject: &'a Subject<'a>,
    pub gloss: Gloss,
    pub interleave: Interleave,
    pixels: Tiles,
}

/// A frame lit in some way.
pub struct Lit {
    pub lights: usize,
    /// To make clusters.
    pub cluster_ms: f64,
    /// To make clusters, bound, cull and shade.
    pub ms: f64,
    pub irradiance: Vec<Vec3>,
}

impl<'a> Stage<'a> {
    pub fn new(subject: &'a Subject<'a>, gloss: Gloss) -> Self {
        let interleave = subject.interleave(1);
        Self {
            subject,
            gloss,
            interleave,
            pixels: subject.tiles(&interleave, 1, Slicing::ModifiedHalfZ),
        }
    }

    /// How many rays the clusters are made of.
    fn map_rays(&self) -> u32 {
        16 * self.subject.effort.vpls
    }

    /// The frame with points and random numbers of its own.
    pub fn light(&self, setting: Setting, frame: u32) -> Lit {
        self.light_moved(setting, frame, 0.0)
    }

    /// The same with the light `moved` aside by so much of its distance.
    pub fn light_moved(&self, setting: Setting, frame: u32, moved: f32) -> Lit {
        let seed = self.subject.seed_of(frame);
        let rays = match setting.kind {
            Kind::Vpl => setting.count,
            _ => self.map_rays(),
        };
        let points = self.subject.points_moved(self.gloss, rays, seed, moved);
        match setting.kind {
            Kind::Vpl => self.by_points(&points, setting, seed),
            _ => self.by_clusters(&points, setting, seed),
        }
    }

    /// With δ so small that all lights are accepted, if there is to be none.
    fn frame(&self, setting: Setting) -> Frame<'a> {
        let delta = setting.delta.unwrap_or(1e-30);
        self.subject.frame(self.interleave, delta)
    }

    fn by_points(&self, points: &LitPoints, setting: Setting, seed: u32) -> Lit {
        let frame = self.frame(setting);
        let lights = Lights::new(points, &self.interleave, &frame.roulette, seed);
        let lights = lights
            .expect("scenes are checked when they are loaded")
            .glossy;
        let camera = &self.subject.camera;
        let tiling = [self.tiling()];
        let measured = measure_glossy(&frame, &tiling, camera, &lights, BoundKind::Tight, || ());
        let measured = measured.expect("fewer pairs than a u32 counts").remove(0);
        Lit::new(lights.len(), 0.0, measured)
    }

    fn by_clusters(&self, points: &LitPoints, setting: Setting, seed: u32) -> Lit {
        let frame = self.frame(setting);
        let clustering = match setting.kind {
            Kind::Kmeans => Clustering::Kmeans,
            _ => Clustering::Fis,
        };
        let map = LightMaps::glossy(&points.glossy);
        let mut map = map.expect("scenes are checked when they are loaded");
        let (lights, cluster_ms) = timed(|| {
            let clusters = map.clusters(clustering, setting.count, seed)?;
            smooth_lights(&clusters, &self.interleave, &frame.roulette, seed)
        });
        let lights = lights.expect("scenes are checked when they are loaded");
        if setting.delta.is_some() {
            let camera = &self.subject.camera;
            let measured = measure_smooth(&frame, &[self.tiling()], camera, &lights, || ());
            let measured = measured.expect("fewer pairs than a u32 counts").remove(0);
            return Lit::new(lights.len(), cluster_ms, measured);
        }
        let (irradiance, ms) = timed(|| self.by_all(&frame.roulette, &lights));
        Lit {
            lights: lights.len(),
            cluster_ms,
            ms: cluster_ms + ms,
            irradiance,
        }
    }

    fn tiling(&self) -> Tiling<'_> {
        Tiling {
            tiles: &self.pixels,
            refined: true,
        }
    }

    /// The irradiance of all lights at all pixels, sixteen at once.
    fn by_all(&self, roulette: &Roulette, lights: &[SmoothLight]) -> Vec<Vec3> {
        let shading = Shading::smooth(roulette, lights);
        let list: Vec<u32> = (0..lights.len() as u32).collect();
        let surfaces = &self.subject.surfaces.surfaces;
        let blocks = surfaces.par_chunks(PointBlock::LEN);
        let of_block = blocks.flat_map_iter(|surfaces| {
            let points = PointBlock::take(&mut surfaces.iter().map(|surface| ShadedPoint {
                position: surface.position,
                normal: surface.normal,
            }));
            let irradiance = points.map_or([Vec3::ZERO; PointBlock::LEN], |points| {
                shading.irradiance(&list, &points, points.normals(), |_| ())
            });
            irradiance.into_iter().take(surfaces.len())
        });
        of_block.collect()
    }
}

impl Lit {
    fn new(lights: usize, cluster_ms: f64, measured: Measured) -> Self {
        let Measured {
            bound_ms,
            cull_ms,
            shade_ms,
            ..
        } = measured;
        Self {
            lights,
            cluster_ms,
            ms: cluster_ms + bound_ms + cull_ms + shade_ms,
            irradiance: measured.shaded.irradiance,
        }
    }
}
