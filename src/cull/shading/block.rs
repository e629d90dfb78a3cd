//! Many points that share a list of lights.

use fearless_simd::{Simd, SimdBase};
use glam::Vec3;

use super::batch::ShadingBatch;
use super::decision::{Decision, Drawn, LightList};
use super::kernel::{Evaluated, Lights, Points, Settings, ShadedLight};
use super::point::{Estimate, ShadedPoint};
use super::receiver::ReceiverLanes;
use crate::cull::lanes::{LANES, Lanes, load, parts, store};
use crate::num::{F32Lanes, Vector3};

/// Up to sixteen points, an array for each coordinate.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub struct PointBlock {
    positions: [Lanes; 3],
    normals: [Lanes; 3],
    len: usize,
}

impl PointBlock {
    /// The most points that a block holds.
    pub const LEN: usize = LANES;

    /// Takes up to [`LEN`](Self::LEN) points from the iterator. `None` if it has none.
    ///
    /// ```
    /// use stochastic_light_culling::{PointBlock, glam::Vec3};
    ///
    /// let mut points = (0..20).map(|x| Vec3::new(x as f32, 0.0, 0.0).into());
    /// assert_eq!(PointBlock::take(&mut points).map(|block| block.len()), Some(16));
    /// assert_eq!(PointBlock::take(&mut points).map(|block| block.len()), Some(4));
    /// assert!(PointBlock::take(&mut points).is_none());
    /// ```
    #[inline]
    pub fn take(points: &mut impl Iterator<Item = ShadedPoint>) -> Option<Self> {
        let mut block = Self {
            // At NaN nothing is accepted.
            positions: [[f32::NAN; LANES]; 3],
            normals: [[0.0; LANES]; 3],
            len: 0,
        };
        for point in points.take(LANES) {
            for i in 0..3 {
                block.positions[i][block.len] = point.position[i];
                block.normals[i][block.len] = point.normal[i];
            }
            block.len += 1;
        }
        (block.len > 0).then_some(block)
    }

    /// The number of points, at least 1.
    #[expect(clippy::len_without_is_empty, reason = "it is never empty")]
    #[inline]
    #[must_use]
    pub fn len(&self) -> usize {
        self.len
    }

    /// The x, y and z of the normals. Zero past the last point.
    #[inline]
    #[must_use]
    pub fn normals(&self) -> &[[f32; Self::LEN]; 3] {
        &self.normals
    }

    #[inline(always)]
    fn part<S: Simd>(&self, simd: S, part: usize) -> Points<F32Lanes<S>> {
        Points {
            position: load_vector(simd, &self.positions, part),
            normal: load_vector(simd, &self.normals, part),
        }
    }
}

#[inline(always)]
fn load_vector<S: Simd>(simd: S, [x, y, z]: &[Lanes; 3], part: usize) -> Vector3<F32Lanes<S>> {
    Vector3::new(
        load(simd, x, part),
        load(simd, y, part),
        load(simd, z, part),
    )
}

/// The estimates of a light that a point of a block accepts, an array for each number.
///
/// Where the light is not accepted, numbers other than the radiance mean nothing. Past the last point they may
/// be NaN.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
#[non_exhaustive]
pub struct BlockEstimates {
    /// The estimate of the radiance at each point; zero where the light is not accepted, and past the last
    /// point.
    pub radiance: [f32; PointBlock::LEN],
    /// The radiant intensity towards each point.
    pub intensity: [f32; PointBlock::LEN],
    /// The squared distance of each point, or the least one of the estimator.
    pub distance_squared: [f32; PointBlock::LEN],
    /// The x, y and z of the direction from the light to each point.
    pub direction: [[f32; PointBlock::LEN]; 3],
    /// The sharpness of the light as it arrives at each point: infinite from point lights.
    pub sharpness: [f32; PointBlock::LEN],
    /// The index of the light.
    pub light: u32,
    /// Bit i is set if point i accepts the light.
    pub accepted: u32,
}

impl BlockEstimates {
    pub(super) const NONE: Self = Self {
        radiance: [0.0; LANES],
        intensity: [0.0; LANES],
        distance_squared: [0.0; LANES],
        direction: [[0.0; LANES]; 3],
        sharpness: [f32::INFINITY; LANES],
        light: 0,
        accepted: 0,
    };

    /// The points that accept the light, by their places in the block, each with its estimate.
    #[inline]
    pub fn iter(&self) -> impl Iterator<Item = (usize, Estimate)> {
        (0..LANES)
            .filter(|i| self.accepted >> i & 1 != 0)
            .map(|i| (i, self.estimate(i)))
    }

    /// Stores a part.
    #[inline(always)]
    pub(super) fn store<S: Simd>(&mut self, part: usize, evaluated: &Evaluated<S>) {
        let arriving = &evaluated.arriving;
        store(&mut self.radiance, part, evaluated.radiance);
        store(&mut self.intensity, part, arriving.intensity);
        store(&mut self.distance_squared, part, arriving.distance_squared);
        let Vector3 { x, y, z } = arriving.direction;
        for (lanes, vector) in self.direction.iter_mut().zip([x, y, z]) {
            store(lanes, part, vector);
        }
        if let Some(sharpness) = arriving.sharpness {
            store(&mut self.sharpness, part, sharpness);
        }
    }

    #[inline(always)]
    pub(super) fn estimate(&self, i: usize) -> Estimate {
        let [x, y, z] = &self.direction;
        Estimate {
            light: self.light,
            radiance: self.radiance[i],
            intensity: self.intensity[i],
            distance_squared: self.distance_squared[i],
            direction: Vec3::new(x[i], y[i], z[i]),
            sharpness: self.sharpness[i],
        }
    }
}

/// Calls `each` with the lights of `list` that a point of `block` accepts, in the order of the list, and with
/// what the points reflect of it. `receivers_of` gives the receivers of a part.
#[inline(always)]
pub(super) fn evaluate_block<S: Simd, D: Decision, L: ShadedLight, R: ReceiverLanes<S>>(
    simd: S,
    settings: &Settings<D>,
    lights: &ShadingBatch<L>,
    list: D::List<'_>,
    block: &PointBlock,
    receivers_of: impl Fn(usize) -> R,
    mut each: impl FnMut(&BlockEstimates, &Lanes),
) {
    let mut estimates = BlockEstimates::NONE;
    let mut reflected = [0.0; LANES];
    let list = list.with_any_weights();
    let mut quick = QuickTests::default();
    // A bit for each part that a light has left numbers in.
    let mut filled = 0_u32;
    for (turn, light) in list.lights.iter().enumerate() {
        let splat = Lights::broadcast(simd, lights, *light);
        let faintest = settings.decision.faintest(splat.xi);
        estimates.light = *light;
        estimates.accepted = 0;
        for part in 0..parts::<S>() {
            let lobe = lights.lobes.get(*light as usize);
            let points = block.part(simd, part);
            let faintest = faintest.filter(|_| quick.pay());
            let arriving = L::arriving(
                settings.least_distance_squared,
                faintest,
                &splat,
                #[inline(always)]
                |_| lobe,
                &points,
            );
            quick.passed += u32::from(arriving.is_some());
            quick.count += 1;
            let decided = arriving.and_then(
                #[inline(always)]
                |arriving| {
                    let weight = if D::HAS_WEIGHTS {
                        list.weights[turn]
                    } else {
                        1.0
                    };
                    let drawn = Drawn {
                        xi: splat.xi,
                        weight: F32Lanes::new(simd, weight),
                    };
                    settings
                        .decision
                        .decide(arriving, drawn, &receivers_of(part))
                },
            );
            let Some(evaluated) = decided else {
                if parts::<S>() > 1 && filled >> part & 1 != 0 {
                    clear(&mut estimates, &mut reflected, part, S::f32s::LEN);
                    filled &= !(1 << part);
                }
                continue;
            };
            filled |= 1 << part;
            estimates.accepted |= evaluated.accepted << (part * S::f32s::LEN);
            store(&mut reflected, part, evaluated.reflected);
            estimates.store(part, &evaluated);
        }
        if estimates.accepted != 0 {
            each(&estimates, &reflected);
        }
    }
}

/// How many lights of a list have arrived so far, of all, in parts of a block.
#[derive(Default)]
struct QuickTests {
    passed: u32,
    count: u32,
}

impl QuickTests {
    /// Whether it pays to look whether a light is too faint before it is evaluated: unless most arrive.
    #[inline(always)]
    fn pay(&self) -> bool {
        2 * self.passed <= self.count + 8
    }
}

/// Clears what another light has left in a part.
#[inline(always)]
fn clear(estimates: &mut BlockEstimates, reflected: &mut Lanes, part: usize, lanes: usize) {
    let [x, y, z] = &mut estimates.direction;
    let [radiance, intensity, distance] = [
        &mut estimates.radiance,
        &mut estimates.intensity,
        &mut estimates.distance_squared,
    ];
    for numbers in [radiance, intensity, distance, x, y, z, reflected] {
        numbers[part * lanes..][..lanes].fill(0.0);
    }
}
