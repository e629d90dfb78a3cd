//! From lights to what a [`LightBatch`] holds, sixteen at a time.
//!
//! The numbers of sixteen lights are laid side by side, and vectors go over them as the scalar functions
//! go over one light, in the same operations and in the same order, without fused ones: a shape has the
//! bits that they give it. The steps are those of the corridor: `spheroids`, `tight`, `spheres` and
//! `ellipsoids` make bounds of lights, `place` puts them in place, and `view` before the camera.

mod ellipsoids;
mod place;
mod source;
mod spheres;
mod spheroids;
mod tight;
mod vector;
mod view;

use core::ops::Range;

use fearless_simd::{Level, Simd, dispatch};
use glam::Vec3;

use self::source::{Frame, GROUP, Group, Source};
use self::tight::Tight;
use self::view::View;
use super::LightBatch;
use super::culler::{at_most, widest};
use crate::{
    AnisotropicGgxLobe, Bound, Bounded, Camera, ConstantLobe, Ellipsoid, Fresnel, GgxLobe,
    LambertLobe, MaskingShadowing, Roulette, Sphere, Spheroid, Stretch, Vpl, Xi,
};

/// What a [`BatchBuilder`] can make shapes of with their [own bound](Bounded): [`GgxLobe`],
/// [`AnisotropicGgxLobe`], [`LambertLobe`] and [`ConstantLobe`].
pub trait BatchLobe: Bounded + Source<Light = Vpl<Self>, Given = Xi> {}

impl<F: Fresnel, G: MaskingShadowing> BatchLobe for GgxLobe<F, G> {}
impl<F: Fresnel, G: MaskingShadowing> BatchLobe for AnisotropicGgxLobe<F, G> {}
impl BatchLobe for LambertLobe {}
impl BatchLobe for ConstantLobe {}

/// What a [`BatchBuilder`] can put in place: [`Spheroid`], [`Ellipsoid`] and [`Sphere`].
pub trait BatchBound: Bound + Source<Light = Self, Given = (Vec3, f32)> {}

impl BatchBound for Spheroid {}
impl BatchBound for Ellipsoid {}
impl BatchBound for Sphere {}

/// Makes the lights of a frame ready for a [`Culler`](crate::Culler): from lights to a [`LightBatch`] in
/// one pass, several times as fast as one light after the other.
///
/// The shapes are bit by bit those of the scalar functions, in the order in which the lights come; lights
/// that reach nowhere are left out. Nothing is allocated but what the batch needs to grow.
///
/// ```
/// use stochastic_light_culling::{
///     BatchBuilder, Camera, Direction, Ggx, GgxLobe, LightBatch, NoFresnel, Roulette, Stretch, Vpl,
///     Xi, glam::Vec3,
/// };
///
/// let lobe = GgxLobe::new(Ggx::new(0.2)?, NoFresnel, Direction::Y, Direction::Y);
/// let light = |i: u32| Vpl::new(Vec3::new(i as f32, 0.0, -9.0), 0.5, lobe);
/// let lights = (0..100).map(light).collect::<Result<Vec<_>, _>>()?;
///
/// let roulette = Roulette::new(0.01)?;
/// let camera = Camera::look_at(Vec3::ZERO, Vec3::NEG_Z, Vec3::Y, 1.0, 1.0, 0.1..100.0)?;
/// let frame = 7;
/// let xi = |i| Xi::hashed(i, frame, 0);
/// let mut batch = LightBatch::new();
/// BatchBuilder::new(&roulette, &camera)
///     .add((0..).zip(&lights).map(|(i, light)| (i, light, xi(i))), &mut batch);
///
/// let (number, stretch) = batch.iter().nth(41).expect("one of a hundred");
/// let bound = lights[41].bound(&roulette, xi(41));
/// assert_eq!((number, Some(stretch)), (41, Stretch::new(&bound.into(), &camera)));
/// # Ok::<(), stochastic_light_culling::Error>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct BatchBuilder {
    frame: Frame,
    level: Level,
}

impl BatchBuilder {
    /// A builder for a frame with `roulette` that `camera` sees, with the widest vectors that this
    /// processor has; without the feature `std`, that the target is compiled for.
    pub fn new(roulette: &Roulette, camera: &Camera) -> Self {
        Self {
            frame: Frame {
                roulette: *roulette,
                view: View::new(camera),
            },
            level: widest(),
        }
    }

    /// The same builder with vectors of at most `lanes` lanes, as
    /// [`Culler::with_lanes`](crate::Culler::with_lanes) has it.
    pub fn with_lanes(self, lanes: usize) -> Self {
        Self {
            level: at_most(lanes),
            ..self
        }
    }

    /// Adds lights, each given by the number that lists will call it, itself, and its ξ in this frame,
    /// with the [bound](Vpl::bound) of their lobe. That of anisotropic lights is found one by one, and put
    /// in place and before the camera in vectors.
    pub fn add<'a, L: BatchLobe + 'a>(
        &self,
        lights: impl IntoIterator<Item = (u32, &'a Vpl<L>, Xi)>,
        batch: &mut LightBatch<L::Shape>,
    ) {
        self.fill::<L>(lights.into_iter(), batch);
    }

    /// Adds lights as [`add`](Self::add) does, with their [tight bound](Vpl::tight_bound). Its table is read
    /// for one light after the other, and all else is found in vectors.
    pub fn add_tight<'a, F: Fresnel + 'a, G: MaskingShadowing + 'a>(
        &self,
        lights: impl IntoIterator<Item = (u32, &'a Vpl<GgxLobe<F, G>>, Xi)>,
        batch: &mut LightBatch<Stretch>,
    ) {
        self.fill::<Tight<F, G>>(lights.into_iter(), batch);
    }

    /// Adds bounds that are kept from frame to frame, each given by the number that lists will call it,
    /// itself, and the position and the scale that it is [placed](Bound::placed) with: for a light's
    /// [unit bound](Bounded::unit_bound) these are its position and [`Roulette::scale`].
    pub fn add_placed<'a, B: BatchBound + 'a>(
        &self,
        bounds: impl IntoIterator<Item = (u32, &'a B, Vec3, f32)>,
        batch: &mut LightBatch<B::Shape>,
    ) {
        let bounds = bounds.into_iter();
        let bounds =
            bounds.map(|(number, bound, position, scale)| (number, bound, (position, scale)));
        self.fill::<B>(bounds, batch);
    }

    /// Gathers lights and adds them, such that each sixteen fill up a chunk.
    fn fill<'a, T: Source<Light: 'a>>(
        &self,
        lights: impl Iterator<Item = (u32, &'a T::Light, T::Given)>,
        batch: &mut LightBatch<T::Shape>,
    ) {
        let mut lights = lights.filter(|(_, light, given)| T::may_reach(light, *given));
        let Some((number, light, given)) = lights.next() else {
            return;
        };
        let mut group = Group::<T>::splat(light, given);
        let mut first = batch.next_lane();
        group.set(first, number, light, given);
        let mut end = first + 1;
        for (number, light, given) in lights {
            if end == GROUP {
                self.flush(&mut group, first..end, batch);
                first = batch.next_lane();
                end = first;
            }
            group.set(end, number, light, given);
            end += 1;
        }
        self.flush(&mut group, first..end, batch);
    }

    /// Adds the lights of these lanes of a group.
    fn flush<T: Source>(
        &self,
        group: &mut Group<T>,
        lanes: Range<usize>,
        batch: &mut LightBatch<T::Shape>,
    ) {
        dispatch!(self.level, simd => shape(simd, group, &lanes, &self.frame, batch));
    }
}

/// Makes shapes of the lights in these lanes.
#[inline(always)]
fn shape<S: Simd, T: Source>(
    simd: S,
    group: &mut Group<T>,
    lanes: &Range<usize>,
    frame: &Frame,
    batch: &mut LightBatch<T::Shape>,
) {
    group.shape(simd, lanes, frame);
    group.append_to(batch, lanes.end);
}
