//! Smooth lights in the place of many points: clusters of the texels of a reflective shadow map.

use clap::ValueEnum;
use kiddo::{SquaredEuclidean, immutable::float::kdtree::ImmutableKdTree};
use stochastic_light_culling::{
    ClusterSums, Error, FilteredSampling, FrameSeed, GgxLobe, LambertLobe, MipPyramid, Schlick,
    Seed, SphericalGaussian, Vsgl, glam::Vec3, pyramid_len,
};

use super::reflectance::Reflectances;
use crate::scene::{LitPoint, Texel};

/// What texels go to a cluster.
#[derive(Clone, Copy, Debug, Eq, PartialEq, ValueEnum)]
pub enum Clustering {
    /// Those around a texel, from the mip levels of the map: filtered importance sampling
    Fis,
    /// Those that are nearest to its center, in the map and in space
    Kmeans,
}

/// A smooth light that stands for a cluster.
#[derive(Clone, Copy, Debug)]
pub struct Cluster {
    /// Its flux is that of the brightest channel of each light in it.
    pub vsgl: Vsgl,
    /// The flux of each channel over that.
    pub tint: Vec3,
}

/// What reflects light in one way, as the texels of reflective shadow maps: one for each beam of a lamp.
pub struct LightMaps(Vec<LightMap>);

/// The texels of a map, with room for its mip levels.
struct LightMap {
    size: [u32; 2],
    sums: Vec<ClusterSums>,
    /// The reflected flux of each channel in W.
    colors: Vec<Vec3>,
}

/// K of filtered importance sampling: clusters meet edge to edge.
const OVERLAP: f32 = 1.0;

impl LightMaps {
    /// The maps of glossy `points`.
    pub fn glossy(points: &[LitPoint<GgxLobe<Schlick>>]) -> Result<Self, Error> {
        let mut reflectances = Reflectances::default();
        Self::new(points, |point| {
            let reflected = reflectances.of(&point.lobe)?;
            SphericalGaussian::specular(point.lobe.ggx(), reflected, point.lobe.incidence())
        })
    }

    /// The maps of diffuse `points`.
    pub fn diffuse(points: &[LitPoint<LambertLobe>]) -> Result<Self, Error> {
        Self::new(points, |point| {
            SphericalGaussian::diffuse(point.lobe.albedo(), point.normal)
        })
    }

    fn new<L>(
        points: &[LitPoint<L>],
        mut lobe: impl FnMut(&LitPoint<L>) -> Result<SphericalGaussian, Error>,
    ) -> Result<Self, Error> {
        let mut maps: Vec<LightMap> = Vec::new();
        for point in points {
            let lobe = lobe(point)?;
            let Texel { map, size, place } = point.texel;
            while maps.len() <= map as usize {
                // Of another beam's size, if this one lights nothing.
                maps.push(LightMap::new(size)?);
            }
            let map = &mut maps[map as usize];
            if map.size != size {
                *map = LightMap::new(size)?;
            }
            map.add(place, point.position, point.flux, &lobe)?;
        }
        Ok(Self(maps))
    }

    /// About `count` clusters, fewer if there are fewer texels with light. Each map has its share by flux, but one
    /// at least if it has any.
    pub fn clusters(
        &mut self,
        clustering: Clustering,
        count: u32,
        seed: u32,
    ) -> Result<Vec<Cluster>, Error> {
        let flux: Vec<f64> = self.0.iter().map(LightMap::flux).collect();
        let all: f64 = flux.iter().sum();
        let mut clusters = Vec::new();
        for ((map, flux), i) in self.0.iter_mut().zip(flux).zip(1..) {
            if flux > 0.0 {
                let share = (f64::from(count) * flux / all).round().max(1.0) as u32;
                let sampling = FilteredSampling::new(share, OVERLAP)?;
                // Other frames than those of the lights' places.
                let seed = Seed(!seed).frame(i);
                clusters.extend(map.clusters(clustering, &sampling, seed)?);
            }
        }
        Ok(clusters)
    }
}

impl LightMap {
    fn new(size: [u32; 2]) -> Result<Self, Error> {
        let count = pyramid_len(size)?;
        Ok(Self {
            size,
            sums: vec![ClusterSums::EMPTY; count],
            colors: vec![Vec3::ZERO; count],
        })
    }

    fn add(
        &mut self,
        [x, y]: [u32; 2],
        position: Vec3,
        flux: Vec3,
        lobe: &SphericalGaussian,
    ) -> Result<(), Error> {
        let texel = y as usize * self.size[0] as usize + x as usize;
        let brightest = flux.max_element();
        let dark = SphericalGaussian::new(lobe.axis(), 0.0, 0.0)?;
        let sums = ClusterSums::of_light(position, brightest, &dark, lobe)?;
        if sums.flux() > 0.0 {
            self.colors[texel] += flux / brightest * sums.flux() as f32;
            self.sums[texel] += sums;
        }
        Ok(())
    }

    /// What the texels reflect in all, in W.
    fn flux(&self) -> f64 {
        let texels = self.size[0] as usize * self.size[1] as usize;
        self.sums[..texels].iter().map(ClusterSums::flux).sum()
    }

    fn clusters(
        &mut self,
        clustering: Clustering,
        sampling: &FilteredSampling,
        seed: FrameSeed,
    ) -> Result<Vec<Cluster>, Error> {
        let map = MipPyramid::build(self.size, &mut self.sums)?;
        let colors = MipPyramid::build(self.size, &mut self.colors)?;
        Ok(match clustering {
            Clustering::Fis => filtered(&map, &colors, sampling, seed),
            Clustering::Kmeans => nearest(&map, &colors, sampling.count(), seed),
        })
    }
}

impl Cluster {
    fn new(sums: &ClusterSums, color: Vec3) -> Option<Self> {
        let flux = sums.flux();
        (flux > 0.0).then(|| Self {
            vsgl: sums.glossy(),
            tint: color / flux as f32,
        })
    }

    /// The cluster with `factor` times the flux.
    pub(super) fn brightened(&self, factor: f32) -> Result<Vsgl, Error> {
        let lobe = self.vsgl.lobe();
        let amplitude = (factor * lobe.amplitude()).min(f32::MAX);
        let lobe = SphericalGaussian::new(lobe.axis(), lobe.sharpness(), amplitude)?;
        Vsgl::new(self.vsgl.position(), self.vsgl.spread(), lobe)
    }
}

fn filtered(
    map: &MipPyramid<ClusterSums>,
    colors: &MipPyramid<Vec3>,
    sampling: &FilteredSampling,
    seed: FrameSeed,
) -> Vec<Cluster> {
    let cluster = |i| {
        let sample = map.sample(sampling, seed.point(i))?;
        let color = colors.mean_at(sample.position, sample.level) * sample.texels;
        Cluster::new(&map.cluster(&sample), color)
    };
    (0..sampling.count()).filter_map(cluster).collect()
}

/// Clusters of the texels that are nearest to each of `count` centers, which are drawn by flux and not moved
/// [Dong et al. 2009; Tokuyoshi 2016].
fn nearest(
    map: &MipPyramid<ClusterSums>,
    colors: &MipPyramid<Vec3>,
    count: u32,
    seed: FrameSeed,
) -> Vec<Cluster> {
    let [width, height] = map.size().map(|side| side as usize);
    let (Some((_, sums)), Some((_, colors))) = (map.level(0), colors.level(0)) else {
        return Vec::new();
    };
    // In units of the standard deviation, in space and of an evenly lit map.
    let scale = 1.0 / map.total().glossy().spread().max(f32::MIN_POSITIVE);
    let place = |texel: usize| {
        let position = scale * sums[texel].glossy().position();
        let [u, v] = [
            (texel % width) as f32 / width as f32,
            (texel / width) as f32 / height as f32,
        ];
        let in_map = [u, v].map(|x| x * 6.0_f32.sqrt());
        [position.x, position.y, position.z, in_map[0], in_map[1]]
    };
    let mut centers: Vec<usize> = (0..count)
        .filter_map(|i| {
            let [x, y] = map.position_by_flux(seed.point(i))?;
            let [x, y] = [(x, width), (y, height)]
                .map(|(at, side)| ((at * side as f32) as usize).min(side - 1));
            Some(y * width + x)
        })
        .collect();
    centers.sort_unstable();
    centers.dedup();
    if centers.is_empty() {
        return Vec::new();
    }
    let places: Vec<[f32; 5]> = centers.iter().map(|center| place(*center)).collect();
    let tree = ImmutableKdTree::<f32, u64, 5, 32>::new_from_slice(&places);
    let mut clusters = vec![(ClusterSums::EMPTY, Vec3::ZERO); centers.len()];
    for (texel, (sums, color)) in sums.iter().zip(colors).enumerate() {
        if sums.flux() > 0.0 {
            let nearest = tree.nearest_one::<SquaredEuclidean>(&place(texel));
            let cluster = &mut clusters[nearest.item as usize];
            cluster.0 += *sums;
            cluster.1 += *color;
        }
    }
    let clusters = clusters.iter();
    clusters
        .filter_map(|(sums, color)| Cluster::new(sums, *color))
        .collect()
}
