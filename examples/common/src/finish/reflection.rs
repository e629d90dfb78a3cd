//! What a glossy surface shows of other surfaces: rays drawn in proportion to its visible microfacets.

use std::f32::consts::{FRAC_1_PI, PI, TAU};

use stochastic_light_culling::{Direction, Fresnel, Ggx, GgxLobe, Schlick, glam::Vec2, glam::Vec3};

use super::gather::Gather;
use super::material::Reflector;
use super::{Finish, backdrop};
use crate::scene::{Hit, Purpose, uniform};

/// Reflections of reflections, at most.
const BOUNCES: u32 = 4;
/// Rays of each of a pixel's samples.
const RAYS: u32 = 2;
/// The least α at which a surface seen in another one shows a lamp.
const SMOOTHEST: f32 = 0.3;

/// `radiance`, at most as bright as `brightest`: what is met by chance is no spark then.
pub fn dimmed(radiance: Vec3, brightest: f32) -> Vec3 {
    radiance * (brightest / radiance.max_element()).min(1.0)
}

/// The radiance of a reflection, at most: that of a lamp.
const BRIGHTEST: f32 = 0.12;
/// Of indirect light in it, at most: that of a white surface near a lamp.
const BRIGHTEST_INDIRECT: f32 = 0.03;

/// Where a reflection is seen.
pub struct Path {
    pub pixel: u32,
    pub column: usize,
    pub sample: u32,
    /// What it counts for in its pixel.
    pub share: f32,
}

impl Finish<'_> {
    /// The radiance that `reflector` at `hit` reflects from other surfaces, but for their indirect light, which is to
    /// be gathered.
    pub(super) fn reflection(
        &self,
        path: &Path,
        hit: &Hit,
        reflector: &Reflector,
        gathers: &mut Vec<Gather>,
    ) -> Vec3 {
        let rays = (0..RAYS).map(|ray| {
            let sample = path.sample * RAYS + ray;
            let radiance = self.ray(path, sample, hit, reflector, gathers);
            dimmed(radiance, BRIGHTEST * path.share / RAYS as f32)
        });
        rays.sum()
    }

    /// The irradiance of the sky on the surface at `hit`, by some rays.
    pub(super) fn sky(&self, path: &Path, hit: &Hit) -> Vec3 {
        let (right, up) = hit.normal.any_orthonormal_pair();
        let index = !path.pixel;
        let ray = |ray: u32| {
            let random = spread(index, path.sample * RAYS + ray, self.seed);
            // In proportion to the cosine: over the disc below the hemisphere [Malley].
            let disc = Vec2::from_angle(TAU * random.x) * random.y.sqrt();
            let height = (1.0 - random.y).max(0.0).sqrt();
            let direction = disc.x * right + disc.y * up + height * hit.normal;
            let hidden = self.tracer.nearest(hit.off_surface(), direction).is_some();
            if hidden {
                Vec3::ZERO
            } else {
                backdrop(direction)
            }
        };
        let sum: Vec3 = (0..RAYS).map(ray).sum();
        sum * (PI / RAYS as f32)
    }

    fn ray(
        &self,
        path: &Path,
        sample: u32,
        hit: &Hit,
        reflector: &Reflector,
        gathers: &mut Vec<Gather>,
    ) -> Vec3 {
        let mut sum = Vec3::ZERO;
        let mut weight = Vec3::splat(path.share / RAYS as f32);
        let least = 1e-3 * weight.x;
        let mut start = (hit.off_surface(), hit.plane_normal);
        let mut at = (reflector.lobe, reflector.tint);
        for bounce in 0..BOUNCES {
            let (Some(lobe), tint) = at else { break };
            let random = spread(path.pixel.wrapping_mul(BOUNCES) + bounce, sample, self.seed);
            let Some((direction, reflectance)) = sampled(&lobe, random) else {
                break;
            };
            weight *= tint * reflectance;
            if weight.max_element() < least {
                break;
            }
            // A smooth normal may send it into the surface that it stands for.
            let below = direction.dot(start.1).min(0.0);
            let direction = direction - 2.0 * below * start.1;
            let Some(next) = self.tracer.nearest(start.0, direction) else {
                sum += weight * backdrop(direction);
                break;
            };
            let material = self.tracer.material(&next);
            sum += weight * material.emission;
            let (Ok(normal), Ok(to_eye)) =
                (Direction::new(next.normal), Direction::new(-direction))
            else {
                break;
            };
            let reflector = Reflector::new(material, self.gloss, normal, to_eye);
            at = (reflector.lobe, reflector.tint);
            start = (next.off_surface(), next.plane_normal);
            if let Ok(smoothest) = Ggx::new(SMOOTHEST) {
                sum += weight * self.direct(&next, &reflector.smoothed(smoothest));
            }
            let diffuse = weight * material.true_albedo() * FRAC_1_PI;
            if diffuse.max_element() > 0.0 {
                sum += diffuse * self.sky(path, &next);
            }
            gathers.push(Gather {
                column: path.column,
                brightest: BRIGHTEST_INDIRECT * path.share / RAYS as f32,
                weight: diffuse,
                position: next.position,
                normal: next.normal,
            });
        }
        sum
    }
}

/// The `sample`-th point of a sequence that is spread evenly over the unit square [Roberts 2018], shifted by chance.
fn spread(index: u32, sample: u32, seed: u32) -> Vec2 {
    let shift = [Purpose::ReflectionX, Purpose::ReflectionY].map(|p| uniform(index, p, seed));
    let step = Vec2::new(0.754_877_7, 0.569_840_3);
    (Vec2::from(shift) + sample as f32 * step).fract()
}

/// A direction that the lobe reflects to, from the visible normals of GGX [Dupuy & Benyoub 2023], and its reflectance
/// with separable masking; none below the horizon.
fn sampled(lobe: &GgxLobe<Schlick>, random: Vec2) -> Option<(Vec3, f32)> {
    let (normal, incoming) = (*lobe.normal(), *lobe.incoming());
    let (right, up) = normal.any_orthonormal_pair();
    let roughness = lobe.ggx().roughness();
    let stretch = Vec3::new(roughness, roughness, 1.0);
    let local = Vec3::new(incoming.dot(right), incoming.dot(up), incoming.dot(normal));
    let hemisphere = (local * stretch).normalize();
    let z = (1.0 - random.y) * (1.0 + hemisphere.z) - hemisphere.z;
    let around = Vec2::from_angle(TAU * random.x) * (1.0 - z * z).max(0.0).sqrt();
    let half = (around.extend(z) + hemisphere) * stretch;
    let half = half.with_z(half.z.max(0.0)).try_normalize()?;
    let half = half.x * right + half.y * up + half.z * normal;
    let cosine = incoming.dot(half);
    let outgoing = (2.0 * cosine * half - incoming).normalize();
    let masking = lobe.ggx().masking(outgoing.dot(normal));
    let reflectance = lobe.fresnel().reflectance(cosine.clamp(0.0, 1.0)) * masking;
    (outgoing.dot(normal) > 0.0).then_some((outgoing, reflectance))
}
