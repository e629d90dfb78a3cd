use alloc::vec::Vec;

use glam::Vec3;

use crate::view::Camera;

/// Sorts lights from near to far, the order in which a [`LightBatch`](crate::LightBatch) is culled fastest.
///
/// Keeps its memory, so that frames after the first do not allocate. Takes a few nanoseconds per light.
///
/// ```
/// use stochastic_light_culling::{Camera, DepthOrder, glam::Vec3};
///
/// let camera = Camera::look_at(Vec3::ZERO, Vec3::NEG_Z, Vec3::Y, 1.0, 1.0, 0.1..100.0)?;
/// let positions = [-20.0, -3.0, 5.0, -7.0].map(|z| Vec3::new(1.0, 2.0, z));
/// let mut order = DepthOrder::new();
/// assert_eq!(order.of(positions, &camera), [2, 1, 3, 0]);
/// # Ok::<(), stochastic_light_culling::Error>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct DepthOrder {
    depths: Vec<f32>,
    /// The start in `order` of the lights of each step of depth.
    starts: Vec<u32>,
    order: Vec<u32>,
}

/// A step of depth is 2⁻⁷ of the power of two below it.
const MANTISSA_BITS: u32 = 7;
/// All depths below 2⁻⁸ of the farthest are one step.
const OCTAVES: u32 = 8;
/// The number of steps.
const STEPS: usize = ((OCTAVES << MANTISSA_BITS) + 1) as usize;

impl DepthOrder {
    /// Creates the order of no lights. Does not allocate.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            depths: Vec::new(),
            starts: Vec::new(),
            order: Vec::new(),
        }
    }

    /// Sorts `positions` of world space by their depth for `camera`, and returns their indices.
    ///
    /// Depths are compared to about one per cent. Positions whose depths are nearer to each other than that
    /// keep their order, and so do those behind the camera or nearer than 1/256 of the farthest depth. A
    /// position whose depth is NaN counts as one behind the camera. Positions after the first 2³² − 1, whose
    /// indices are not `u32`, are left out.
    pub fn of(&mut self, positions: impl IntoIterator<Item = Vec3>, camera: &Camera) -> &[u32] {
        let forward = camera.rotation().row(2);
        let [anchor, anchor_image] = camera.anchor();
        let depth = |position: Vec3| {
            let depth = forward.dot(position - anchor) + anchor_image.z;
            // Zero for a depth that is negative, −0 or NaN.
            if depth > 0.0 { depth } else { 0.0 }
        };
        self.depths.clear();
        let counted = positions.into_iter().take(u32::MAX as usize);
        self.depths.extend(counted.map(depth));

        let farthest = self.depths.iter().copied().fold(0.0, f32::max);
        let step = Step::new(farthest);
        self.starts.clear();
        self.starts.resize(STEPS + 1, 0);
        for depth in &self.depths {
            self.starts[step.of(*depth) + 1] += 1;
        }
        let mut start = 0;
        for lights in &mut self.starts {
            start += *lights;
            *lights = start;
        }
        self.order.resize(self.depths.len(), 0);
        for (light, depth) in (0..).zip(&self.depths) {
            let next = &mut self.starts[step.of(*depth)];
            self.order[*next as usize] = light;
            *next += 1;
        }
        &self.order
    }
}

/// Converts depths to steps.
///
/// The bits of positive floats have the order of the floats, and equal steps within a power of two.
struct Step {
    /// The bits of the depth at which the first step begins.
    first: u32,
}

impl Step {
    fn new(farthest: f32) -> Self {
        let octaves = OCTAVES << (f32::MANTISSA_DIGITS - 1);
        Self {
            first: farthest.to_bits().saturating_sub(octaves),
        }
    }

    /// The step of a `depth`. Less than [`STEPS`] for a depth of at most the farthest.
    fn of(&self, depth: f32) -> usize {
        let bits = depth.to_bits().saturating_sub(self.first);
        (bits >> (f32::MANTISSA_DIGITS - 1 - MANTISSA_BITS)) as usize
    }
}
