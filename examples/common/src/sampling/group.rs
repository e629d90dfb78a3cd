//! Eight clusters of lights side by side, and how important each is to a receiver.
//!
//! The importance of a cluster is an estimate of the radiance that the receiver reflects of it to the eye: flux × the
//! light's lobe × the receiver's lobe / squared distance, as [Conty Estevez & Kulla 2018] have it for lamps with cones of
//! emission and for diffuse receivers. Lobes of GGX take the place of cones. A cluster is seen in a cone of directions, and
//! its lights have normals and incoming directions in cones of their own; the distribution of half vectors is widened by
//! them, as [Tokuyoshi et al. 2024] widen it by the variance of Gaussians. A single light has no width, and its importance
//! is what it adds, but for the approximate masking.
//!
//! A cluster that holds a light above both horizons has an importance above zero, whatever is estimated: cosines are
//! bounded from above, and the tails of the distribution never end.

use std::f32::consts::FRAC_1_PI;

use stochastic_light_culling::glam::Vec3;

use super::Profile;
use crate::frame::GlossyLight;

/// How many clusters there are in a group.
pub const WIDTH: usize = 8;

type Lanes = [f32; WIDTH];

/// A cluster of lights, or one light.
#[derive(Clone, Copy, Debug)]
pub struct Cluster {
    pub position: Vec3,
    /// Of a ball around the position that holds those of all lights.
    pub radius: f32,
    pub normal: Vec3,
    pub incoming: Vec3,
    /// How far the normals and the incoming directions are from those two.
    pub chords: [f32; 2],
    pub flux: f32,
    pub alpha: f32,
    pub f0: f32,
}

impl Cluster {
    pub fn of_light(light: &GlossyLight) -> Self {
        let lobe = light.vpl.lobe();
        Self {
            position: light.vpl.position(),
            radius: 0.0,
            normal: *lobe.normal(),
            incoming: *lobe.incoming(),
            chords: [0.0; 2],
            flux: light.vpl.flux(),
            alpha: lobe.ggx().roughness(),
            f0: lobe.fresnel().f0(),
        }
    }

    /// All of `clusters` together, of which there is at least one.
    pub fn union(clusters: &[Self]) -> Self {
        let flux: f32 = clusters.iter().map(|cluster| cluster.flux).sum();
        // Dark lights are not drawn, but have their place.
        let share = |cluster: &Self| cluster.flux / flux.max(f32::MIN_POSITIVE);
        let mean = |of: fn(&Self) -> Vec3| -> Vec3 {
            let sum: Vec3 = clusters.iter().map(|c| share(c) * of(c)).sum();
            sum
        };
        let axis = |of: fn(&Self) -> Vec3| mean(of).normalize_or(of(&clusters[0]));
        let number = |of: fn(&Self) -> f32| clusters.iter().map(|c| share(c) * of(c)).sum::<f32>();
        let farthest = |middle: Vec3, of: fn(&Self) -> (Vec3, f32)| {
            let reach = |cluster: &Self| {
                let (at, around) = of(cluster);
                at.distance(middle) + around
            };
            clusters.iter().map(reach).fold(0.0, f32::max)
        };
        let (position, normal, incoming) = (
            mean(|c| c.position),
            axis(|c| c.normal),
            axis(|c| c.incoming),
        );
        Self {
            position,
            radius: farthest(position, |c| (c.position, c.radius)),
            normal,
            incoming,
            chords: [
                farthest(normal, |c| (c.normal, c.chords[0])),
                farthest(incoming, |c| (c.incoming, c.chords[1])),
            ],
            flux,
            alpha: number(|c| c.alpha),
            f0: number(|c| c.f0),
        }
    }
}

/// Up to eight clusters, an array for each number.
#[derive(Clone, Debug, Default)]
#[repr(C, align(64))]
pub struct Group {
    position: [Lanes; 3],
    radius: Lanes,
    normal: [Lanes; 3],
    incoming: [Lanes; 3],
    chords: [Lanes; 2],
    /// Zero where there is no cluster.
    flux: Lanes,
    alpha: Lanes,
    f0: Lanes,
}

/// Pays for rounding, so that no cosine above zero is lost.
const SLACK: f32 = 1e-5;

impl Group {
    pub fn new(clusters: &[Cluster]) -> Self {
        let mut group = Self {
            alpha: [1.0; WIDTH],
            ..Self::default()
        };
        for (i, cluster) in clusters.iter().take(WIDTH).enumerate() {
            for (lanes, vector) in [
                (&mut group.position, cluster.position),
                (&mut group.normal, cluster.normal),
                (&mut group.incoming, cluster.incoming),
            ] {
                for (lanes, number) in lanes.iter_mut().zip(vector.to_array()) {
                    lanes[i] = number;
                }
            }
            group.radius[i] = cluster.radius;
            group.chords[0][i] = cluster.chords[0];
            group.chords[1][i] = cluster.chords[1];
            group.flux[i] = cluster.flux;
            group.alpha[i] = cluster.alpha;
            group.f0[i] = cluster.f0;
        }
        group
    }

    /// The importance of each cluster to the receiver at `point`.
    #[inline(always)]
    pub fn importances(
        &self,
        point: Vec3,
        profile: &Profile,
        least_distance_squared: f32,
    ) -> Lanes {
        let mut importances = [0.0; WIDTH];
        for (i, importance) in importances.iter_mut().enumerate() {
            let at = |lanes: &[Lanes; 3]| [lanes[0][i], lanes[1][i], lanes[2][i]];
            let way = sub(at(&self.position), point.to_array());
            let squared = dot(way, way).max(1e-30);
            let inverse = 1.0 / squared.sqrt();
            let to_light = way.map(|x| x * inverse);
            let cone = (self.radius[i] * inverse).min(2.0);
            let [normals, incomings] = [self.chords[0][i], self.chords[1][i]];

            let light = Lobe {
                normal: at(&self.normal),
                incoming: at(&self.incoming),
                normals,
                alpha: self.alpha[i],
                f0: self.f0[i],
            };
            let from_light = to_light.map(|x| -x);
            let (emitted, _) = light.value(from_light, cone, cone + incomings);
            let receiver = Lobe {
                normal: profile.normal.to_array(),
                incoming: profile.to_eye.to_array(),
                normals: 0.0,
                alpha: profile.alpha,
                f0: profile.f0,
            };
            let (glossy, cosine) = receiver.value(to_light, cone, cone);
            let reflected = profile.diffuse * cosine + profile.glossy * glossy;
            let around = self.radius[i] * self.radius[i];
            let distance = squared.max(0.5 * around).max(least_distance_squared);
            *importance = self.flux[i] * emitted * reflected / distance;
        }
        importances
    }
}

/// Lobes of GGX that differ little.
struct Lobe {
    normal: [f32; 3],
    incoming: [f32; 3],
    /// How far normals are from `normal`.
    normals: f32,
    alpha: f32,
    f0: f32,
}

impl Lobe {
    /// About the value in a cone of directions around `outgoing`, where the half vectors' sums are as wide as `halves`; and
    /// the greatest cosine of a direction of the cone, not negative.
    #[inline(always)]
    fn value(&self, outgoing: [f32; 3], cone: f32, halves: f32) -> (f32, f32) {
        let cosine = (dot(self.normal, outgoing) + cone + self.normals + SLACK).min(1.0);
        let cosine = cosine.max(0.0);
        let half = add(self.incoming, outgoing);
        let squared = dot(half, half).max(1e-6);
        let inverse = 1.0 / squared;
        let across = cross(half, self.normal);
        let sine = (dot(across, across) * inverse).min(1.0);
        // Half of it would be the variance of slopes if all lights were at the edge. By trial, all of it has at most the
        // error of a half, a quarter and a tenth in equal time: fewer clusters are thought dim that hold a bright light.
        let widening = halves * halves * inverse + self.normals * self.normals;
        let alpha = (self.alpha * self.alpha + widening).min(1.0);
        let slope = alpha * (1.0 - sine) + sine;
        let distribution = FRAC_1_PI * alpha / (slope * slope);
        let grazing = (1.0 - 0.5 * squared.sqrt()).max(0.0);
        let grazing_squared = grazing * grazing;
        let fresnel = self.f0 + (1.0 - self.f0) * grazing_squared * grazing_squared * grazing;
        // Masking and shadowing as [Hammon 2017] approximates them.
        let incident = dot(self.normal, self.incoming).max(1e-3);
        let product = 2.0 * incident * cosine;
        let masking = product + (incident + cosine - product) * self.alpha;
        let value = distribution * fresnel * cosine / (2.0 * masking);
        (value, cosine)
    }
}

#[inline(always)]
fn dot(a: [f32; 3], b: [f32; 3]) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[inline(always)]
fn add(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

#[inline(always)]
fn sub(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

#[inline(always)]
fn cross(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}
