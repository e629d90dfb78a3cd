use alloc::vec::Vec;

use super::kernel::ShadedLight;
use crate::cull::lanes::LANES;
use crate::cull::records::Line;
use crate::light::{Vpl, Vsgl, Xi};
use crate::lobe::{FIRST_NUMBERS, Lobe};

/// The numbers in a line of a light.
pub(super) const LINE: usize = LANES;
/// Where in the first line of a light its lobe's numbers begin. Before them are position and Φ.
pub(super) const LOBE: usize = 4;
/// Where in the first line ξ is.
pub(super) const XI: usize = LOBE + FIRST_NUMBERS;

/// The lights of a frame with their ξ, ready for a [`RadianceEstimator`](crate::RadianceEstimator): lights
/// [`Vpl`] with lobes of type `L`, or clusters, if `L` is [`Vsgl`].
///
/// A light has the index of its turn: the first that is pushed has index 0. It takes 64 bytes, or 128 with an
/// [`AnisotropicGgxLobe`](crate::AnisotropicGgxLobe). A lobe that is evaluated light by light, that of a
/// caller or one with a caller's Fresnel factor, is kept beside them. Lights that do not change are pushed
/// once, and get a new ξ in each frame ([`set_xi`](Self::set_xi)).
///
/// ```
/// use stochastic_light_culling::{ConstantLobe, Seed, ShadingBatch, Vpl, glam::Vec3};
///
/// let (lamp, seed) = (Vpl::new(Vec3::ZERO, 100.0, ConstantLobe)?, Seed(0));
/// let mut lights = ShadingBatch::new();
/// lights.extend([(&lamp, seed.frame(0).xi(0))]);
/// lights.set_xi(0, seed.frame(1).xi(0));
/// assert_eq!(lights.len(), 1);
/// # Ok::<(), stochastic_light_culling::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct ShadingBatch<L> {
    /// [`lines_per_light`](Self::lines_per_light) of each light.
    pub(super) lines: Vec<Line>,
    /// The lobes, if they are more than their numbers.
    pub(in crate::cull) lobes: Vec<L>,
}

impl<L: ShadedLight> ShadingBatch<L> {
    /// Creates an empty batch.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            lines: Vec::new(),
            lobes: Vec::new(),
        }
    }

    #[inline(always)]
    pub(super) fn lines_per_light() -> usize {
        L::lines()
    }

    /// The number of lights.
    #[must_use]
    pub fn len(&self) -> usize {
        self.lines.len() / Self::lines_per_light()
    }

    /// Whether there are no lights.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.lines.is_empty()
    }

    /// Removes all lights. Keeps the memory for the next frame.
    pub fn clear(&mut self) {
        self.lines.clear();
        self.lobes.clear();
    }

    /// Changes the ξ of a light.
    ///
    /// # Panics
    ///
    /// If there is no light with the index `light`.
    #[inline]
    pub fn set_xi(&mut self, light: u32, xi: Xi) {
        self.lines[light as usize * Self::lines_per_light()].0[XI] = xi.get();
    }

    /// The index of a light's first line.
    #[inline(always)]
    pub(super) fn first_line(light: u32) -> usize {
        light as usize * Self::lines_per_light()
    }
}

impl<L: Lobe + Clone> ShadingBatch<L> {
    /// Adds a light with its ξ in this frame. Allocates only if the batch must grow.
    #[inline]
    pub fn push(&mut self, light: &Vpl<L>, xi: Xi) {
        let (lobe, p) = (light.lobe(), light.position());
        let numbers = lobe.numbers();
        let (first, rest) = numbers.split_at(FIRST_NUMBERS);
        let mut line = [0.0; LINE];
        line[..LOBE].copy_from_slice(&[p.x, p.y, p.z, light.flux()]);
        line[LOBE..XI].copy_from_slice(first);
        line[XI] = xi.get();
        self.lines.push(Line(line));
        if Self::lines_per_light() > 1 {
            let mut line = [0.0; LINE];
            line.copy_from_slice(rest);
            self.lines.push(Line(line));
        }
        if L::has_more_than_numbers() {
            self.lobes.push(lobe.clone());
        }
    }
}

impl<L: ShadedLight> Default for ShadingBatch<L> {
    fn default() -> Self {
        Self::new()
    }
}

impl<'a, L: Lobe + Clone + 'a> Extend<(&'a Vpl<L>, Xi)> for ShadingBatch<L> {
    fn extend<I: IntoIterator<Item = (&'a Vpl<L>, Xi)>>(&mut self, lights: I) {
        let lights = lights.into_iter();
        self.lines
            .reserve(lights.size_hint().0 * Self::lines_per_light());
        for (light, xi) in lights {
            self.push(light, xi);
        }
    }
}

/// Clusters of lights.
impl ShadingBatch<Vsgl> {
    /// Adds a cluster with its ξ in this frame. It takes 64 bytes. Allocates only if the batch must grow.
    #[inline]
    pub fn push_vsgl(&mut self, light: &Vsgl, xi: Xi) {
        let (p, lobe) = (light.position(), light.lobe());
        let axis = lobe.axis();
        let mut line = [0.0; LINE];
        line[..LOBE].copy_from_slice(&[p.x, p.y, p.z, lobe.amplitude()]);
        let numbers = [axis.x, axis.y, axis.z, lobe.sharpness(), light.spread()];
        line[LOBE..LOBE + numbers.len()].copy_from_slice(&numbers);
        line[XI] = xi.get();
        self.lines.push(Line(line));
    }
}

impl<'a> Extend<(&'a Vsgl, Xi)> for ShadingBatch<Vsgl> {
    fn extend<I: IntoIterator<Item = (&'a Vsgl, Xi)>>(&mut self, lights: I) {
        let lights = lights.into_iter();
        self.lines.reserve(lights.size_hint().0);
        for (light, xi) in lights {
            self.push_vsgl(light, xi);
        }
    }
}
