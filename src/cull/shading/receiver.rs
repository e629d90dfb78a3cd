//! Surface points that reflect light to the eye.

use fearless_simd::{Simd, SimdBase};
use glam::Vec3;

use super::block::PointBlock;
use super::kernel::Arriving;
use super::point::ShadedPoint;
use crate::cull::lanes::{LANES, Lanes, load};
use crate::lobe::{Lobe, LobeNumbers};
use crate::num::F32Lanes;

/// A surface point that reflects light to the eye.
///
/// A BRDF is reciprocal: the light that goes from ω to the eye is f·max(ω·n, 0) times that which arrives from
/// ω. So a receiver has the lobe of light that arrives from the eye, and the lobe's value towards a light is
/// the share of its radiance that the eye sees. What of the lobe does not depend on the light is computed
/// once for the point.
///
/// A transformed cosine is not quite reciprocal. At a receiver its table is looked up by the direction to the
/// eye, and it is then the sum of [Xia et al. 2023, Eq. 11].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Receiver<R> {
    /// Its position in world space. A receiver with a NaN or infinite coordinate accepts no light.
    pub position: Vec3,
    /// The lobe of light that arrives from the eye.
    pub lobe: R,
}

impl<R: Lobe> Receiver<R> {
    /// The point, with the normal of the lobe's surface.
    #[inline]
    pub(super) fn point(&self) -> ShadedPoint {
        ShadedPoint {
            position: self.position,
            normal: self.lobe.horizon_normal().map_or(Vec3::ZERO, Vec3::from),
        }
    }
}

/// Up to sixteen receivers, an array for each number.
#[derive(Clone, Debug)]
pub struct ReceiverBlock<R> {
    points: PointBlock,
    numbers: LobeNumbers<Lanes>,
    /// The lobes, if they are more than their numbers.
    lobes: [Option<R>; LANES],
}

impl<R: Lobe> ReceiverBlock<R> {
    /// Takes up to [`PointBlock::LEN`] receivers from the iterator. `None` if it has none.
    ///
    /// ```
    /// use stochastic_light_culling::{ConstantLobe, Receiver, ReceiverBlock, glam::Vec3};
    ///
    /// let receiver = |x| Receiver { position: Vec3::new(x as f32, 0.0, 0.0), lobe: ConstantLobe };
    /// let mut receivers = (0..20).map(receiver);
    /// let sizes = [0, 1].map(|_| ReceiverBlock::take(&mut receivers).map(|block| block.points().len()));
    /// assert_eq!(sizes, [Some(16), Some(4)]);
    /// assert!(ReceiverBlock::take(&mut receivers).is_none());
    /// ```
    #[inline]
    pub fn take(receivers: &mut impl Iterator<Item = Receiver<R>>) -> Option<Self> {
        let mut numbers = [[0.0; LANES]; _];
        let mut lobes = [const { None }; LANES];
        let mut lane = 0;
        let mut points = receivers.take(LANES).map(|receiver| {
            let point = receiver.point();
            let used = &mut numbers[..R::numbers_in_use()];
            for (lanes, number) in used.iter_mut().zip(receiver.lobe.numbers()) {
                lanes[lane] = number;
            }
            if R::has_more_than_numbers() {
                lobes[lane] = Some(receiver.lobe);
            }
            lane += 1;
            point
        });
        let points = PointBlock::take(&mut points)?;
        Some(Self {
            points,
            numbers,
            lobes,
        })
    }

    /// The positions of the receivers, with the normals of their lobes.
    #[inline]
    #[must_use]
    pub fn points(&self) -> &PointBlock {
        &self.points
    }

    /// A part of the receivers.
    #[inline(always)]
    pub(super) fn part<S: Simd>(&self, simd: S, part: usize) -> impl ReceiverLanes<S> {
        PartOfBlock {
            block: self,
            simd,
            part,
        }
    }
}

/// The lobes of the points in all lanes, if they have any.
pub trait ReceiverLanes<S: Simd> {
    /// The value of each point's lobe for what arrives there: that towards a point light, or the mean over the
    /// light of a cluster. `None` for points without a lobe.
    fn value(&self, arriving: &Arriving<S>) -> Option<F32Lanes<S>>;
}

/// Points without a lobe, which reflect nothing.
pub(super) struct NoReceivers;

impl<S: Simd> ReceiverLanes<S> for NoReceivers {
    #[inline(always)]
    fn value(&self, _: &Arriving<S>) -> Option<F32Lanes<S>> {
        None
    }
}

/// A part of a block. Its numbers are loaded where they are used, which is not at every light.
struct PartOfBlock<'b, S, R> {
    block: &'b ReceiverBlock<R>,
    simd: S,
    part: usize,
}

impl<S: Simd, R: Lobe> ReceiverLanes<S> for PartOfBlock<'_, S, R> {
    #[inline(always)]
    fn value(&self, arriving: &Arriving<S>) -> Option<F32Lanes<S>> {
        let mut numbers = [F32Lanes::new(self.simd, 0.0); _];
        for (vector, lanes) in numbers.iter_mut().zip(&self.block.numbers) {
            *vector = load(self.simd, lanes, self.part);
        }
        let first = self.part * S::f32s::LEN;
        Some(value::<S, R>(
            &numbers,
            #[inline(always)]
            |lane| self.block.lobes[first + lane].as_ref(),
            arriving,
        ))
    }
}

/// The value of the lobe of the receiver in each lane for what arrives.
#[inline(always)]
pub(super) fn value<'a, S: Simd, R: Lobe + 'a>(
    numbers: &LobeNumbers<F32Lanes<S>>,
    lobe_of: impl Fn(usize) -> Option<&'a R>,
    arriving: &Arriving<S>,
) -> F32Lanes<S> {
    let from = -arriving.direction;
    match arriving.sharpness {
        None => R::value_in_lanes(numbers, lobe_of, from),
        Some(sharpness) => R::mean_in_lanes(numbers, lobe_of, from, sharpness),
    }
}
