use alloc::vec::Vec;

use glam::Vec3;

use crate::view::Camera;

/// The order of lights from near to far, in which a [`LightBatch`](crate::LightBatch) is culled fastest.
///
/// Holds the memory that it works in, so that frames after the first allocate nothing. Costs a few
/// nanoseconds for a light.
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
    /// Where the lights of each step of depth begin.
    starts: Vec<u32>,
    order: Vec<u32>,
}

/// Depths are told apart in steps of 2⁻⁷ of the power of two below them, down to 2⁻⁸ of the farthest.
const MANTISSA_BITS: u32 = 7;
const OCTAVES: u32 = 8;
const STEPS: usize = ((OCTAVES << MANTISSA_BITS) + 1) as usize;

impl DepthOrder {
    /// An order of no lights.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            depths: Vec::new(),
            starts: Vec::new(),
            order: Vec::new(),
        }
    }

    /// The indices of `positions`, in world space, by their depth before `camera`, to about one per cent:
    /// the order of those that are nearer to each other is kept, and so is that of those nearer than
    /// 1/256 of the farthest one, or behind the eye. Positions past the first 2³² − 1, whose indices no
    /// `u32` counts, are left out.
    pub fn of(&mut self, positions: impl IntoIterator<Item = Vec3>, camera: &Camera) -> &[u32] {
        let forward = camera.rotation().row(2);
        let [anchor, seen] = camera.anchor();
        let depth = |position: Vec3| {
            let depth = forward.dot(position - anchor) + seen.z;
            // Not so for what lies behind, for −0, and for what is too far away to be a number.
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
            let place = &mut self.starts[step.of(*depth)];
            self.order[*place as usize] = light;
            *place += 1;
        }
        &self.order
    }
}

/// The bits of positive floats are in their order, and take equal steps within a power of two.
struct Step {
    first: u32,
}

impl Step {
    fn new(farthest: f32) -> Self {
        let octaves = OCTAVES << (f32::MANTISSA_DIGITS - 1);
        Self {
            first: farthest.to_bits().saturating_sub(octaves),
        }
    }

    /// Less than [`STEPS`] for what is not farther than the farthest.
    fn of(&self, depth: f32) -> usize {
        let bits = depth.to_bits().saturating_sub(self.first);
        (bits >> (f32::MANTISSA_DIGITS - 1 - MANTISSA_BITS)) as usize
    }
}
