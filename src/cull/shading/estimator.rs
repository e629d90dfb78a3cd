use fearless_simd::{Level, dispatch};

use super::batch::ShadingBatch;
use super::block::{BlockEstimates, PointBlock, evaluate_block};
use super::decision::{AtPoint, AtReceiver, Decision, InList, PointDecision};
use super::kernel::{Settings, ShadedLight};
use super::pairs::{Receivers, fold_pairs};
use super::point::{Estimate, ShadedPoint};
use super::receiver::{NoReceivers, Receiver, ReceiverBlock};
use crate::base::{Error, number_in};
use crate::cull::culler::{at_most, widest};
use crate::light::Roulette;
use crate::lobe::Lobe;

/// Evaluates lists of lights, many at a time: acceptance, and the estimate of the radiance, of each light.
///
/// Estimates have the bits of the scalar functions: [`Roulette::estimate`] of
/// [`radiant_intensity`](crate::Vpl::radiant_intensity) and distance in the direction of
/// [`Vpl::direction_to`](crate::Vpl::direction_to). They come in the order of the list, and do not depend on
/// the width of the vectors. Lights that are not accepted are not reported, so that visibility and what the
/// surface does with the light are computed for the others alone.
///
/// Clusters ([`Vsgl`](crate::Vsgl)) are evaluated alike: an [`Estimate`] says what of.
///
/// There are two ways. Where points share a list, as those of a tile do, [`at_block`](Self::at_block) takes
/// sixteen of them and is fastest. [`at_points`](Self::at_points) takes points with lists of their own, however
/// short.
///
/// # What decides
///
/// | created by | a light counts | takes lists | δ is a radiance |
/// |---|---|---|---|
/// | [`new`](Self::new) | where it is accepted by the radiance that arrives, whatever the receiver | by bounds of lights, of a [`Culler`](crate::Culler) | that arrives |
/// | [`aware`](Self::aware) | where it is accepted by the radiance that the receiver reflects | by receivers, of [`ReceiverCuller::cull`](crate::ReceiverCuller::cull) | at the eye |
/// | [`listed`](Self::listed) | everywhere, times its weight in the list | drawn for all points of a tile, of [`ReceiverCuller::draw`](crate::ReceiverCuller::draw) | – |
///
/// List and estimator go together: with a list that was made for another way, or for another δ, the mean is wrong.
/// An estimator is a few numbers, and is made in a few nanoseconds: each tile may have one with a δ of its own.
///
/// Nothing allocates. A NaN comes only of what the scalar functions make NaN of.
///
/// ```
/// use stochastic_light_culling::{
///     Direction, Ggx, GgxLobe, Incidence, PointBlock, RadianceEstimator, Roulette, Schlick, Seed,
///     ShadedPoint, ShadingBatch, Vpl, glam::Vec3,
/// };
///
/// // Lights on a floor, and points of a wall.
/// let lobe = GgxLobe::new(Ggx::new(0.4)?, Schlick::new(0.9)?, Incidence::head_on(Direction::Y));
/// let light = |i: u32| Vpl::new(Vec3::new(i as f32, 0.0, 3.0), 0.2, lobe);
/// let lights = (0..10).map(light).collect::<Result<Vec<_>, _>>()?;
/// let point = |i: u32| ShadedPoint {
///     position: Vec3::new(0.1 * i as f32, 2.0, 0.0),
///     normal: Vec3::Z,
/// };
///
/// let (roulette, seed) = (Roulette::new(0.001)?, Seed(0).frame(0));
/// let mut batch = ShadingBatch::new();
/// batch.extend((0..).zip(&lights).map(|(i, light)| (light, seed.xi(i))));
/// let estimator = RadianceEstimator::new(&roulette);
///
/// // The irradiance of each point, from the lights of a list.
/// let list = [0, 1, 4, 5, 9];
/// let cosine = |direction: Vec3| (-direction).dot(Vec3::Z).max(0.0);
/// let mut irradiance = [0.0; 16];
/// let points = PointBlock::take(&mut (0..16).map(point)).expect("sixteen");
/// estimator.at_block(&batch, &list, &points, |estimates| {
///     for (i, estimate) in estimates.iter() {
///         irradiance[i] += estimate.radiance * cosine(estimate.direction);
///     }
/// });
///
/// // The same from a list for each point, and one by one.
/// let mut again = [0.0; 16];
/// let lists = (0..16).map(|i| (point(i), &list[..]));
/// estimator.at_points(&batch, lists, |i, estimate| {
///     again[i] += estimate.radiance * cosine(estimate.direction);
/// });
/// let one_by_one = list.iter().map(|i| {
///     let light = &lights[*i as usize];
///     let (direction, distance_squared) = light.direction_to(point(7).position);
///     let intensity = light.radiant_intensity(direction);
///     roulette.estimate(intensity, distance_squared, seed.xi(*i)) * cosine(direction)
/// });
/// assert!(irradiance[7] > 0.0 && irradiance == again);
/// assert_eq!(irradiance[7], one_by_one.fold(0.0, |sum, more| sum + more));
/// # Ok::<(), stochastic_light_culling::Error>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct RadianceEstimator<D = AtPoint> {
    settings: Settings<D>,
    level: Level,
}

impl RadianceEstimator {
    /// Creates an estimator that decides by the radiance that arrives, with the widest vectors of this processor.
    /// Without the feature `std` the processor cannot be queried, and the vectors are those of the compilation
    /// target.
    #[must_use]
    pub fn new(roulette: &Roulette) -> Self {
        let roulette = *roulette;
        Self::deciding(AtPoint { roulette })
    }
}

impl RadianceEstimator<AtReceiver> {
    /// Creates an estimator that decides by the radiance that a receiver reflects to the eye, of which δ is then
    /// the scale. Otherwise as [`new`](RadianceEstimator::new).
    ///
    /// Lights are accepted that reflect much, and the estimate of what one reflects is never below δ. So glossy
    /// receivers take few lights, and see no light that is much brighter than the others.
    ///
    /// [`BlockEstimates::radiance`] and [`Estimate::radiance`] are L/p here, too, so that other surfaces may reflect
    /// them: a coat, or a colour.
    ///
    /// ```
    /// use stochastic_light_culling::{
    ///     Direction, LambertLobe, Lobe, RadianceEstimator, Receiver, Roulette, ShadingBatch, Vpl, Xi,
    ///     glam::Vec3,
    /// };
    ///
    /// let lobe = LambertLobe::new(0.5, Direction::Y)?;
    /// let receiver = Receiver { position: Vec3::ZERO, lobe };
    /// let lamp = Vpl::point(2.0 * Vec3::Y, 1.0)?;
    /// let mut lights = ShadingBatch::new();
    /// lights.push(&lamp, Xi::new(0.1)?);
    ///
    /// // It sends ¼ W/m², of which the receiver reflects 0.04 to the eye: an eighth of δ.
    /// let reflected = 0.25 * lobe.value(Vec3::Y);
    /// let estimator = RadianceEstimator::aware(&Roulette::new(8.0 * reflected)?);
    /// let counts = |sum, _, _: &_, reflected| sum + reflected;
    /// let sum = estimator.fold_reflected_at_points(&lights, [(receiver, &[0][..])], 0.0, counts);
    /// assert_eq!(sum, 8.0 * reflected);
    ///
    /// // It is rejected with seven of eight ξ.
    /// lights.set_xi(0, Xi::new(0.2)?);
    /// let sum = estimator.fold_reflected_at_points(&lights, [(receiver, &[0][..])], 0.0, counts);
    /// assert_eq!(sum, 0.0);
    /// # Ok::<(), stochastic_light_culling::Error>(())
    /// ```
    #[must_use]
    pub fn aware(roulette: &Roulette) -> Self {
        let roulette = *roulette;
        Self::deciding(AtReceiver { roulette })
    }
}

impl RadianceEstimator<InList> {
    /// Creates an estimator that decides nothing: every light of a [`WeightedList`](crate::WeightedList) counts, with
    /// its weight there. Otherwise as [`new`](RadianceEstimator::new).
    ///
    /// ```
    /// use stochastic_light_culling::{
    ///     PointBlock, RadianceEstimator, ShadingBatch, Vpl, WeightedList, Xi, glam::Vec3,
    /// };
    ///
    /// // Two lamps, of which the second was drawn with the probability ¼. Their ξ have had their use.
    /// let mut lights = ShadingBatch::new();
    /// for height in [1.0, 2.0] {
    ///     lights.push(&Vpl::point(height * Vec3::Y, 1.0)?, Xi::new(1.0)?);
    /// }
    /// let list = WeightedList { lights: &[0, 1], weights: &[1.0, 4.0] };
    /// let block = PointBlock::take(&mut [Vec3::ZERO.into()].into_iter()).expect("one");
    /// let mut irradiance = 0.0;
    /// RadianceEstimator::listed().at_block(&lights, list, &block, |estimates| {
    ///     irradiance += estimates.radiance[0];
    /// });
    /// assert_eq!(irradiance, 1.0 + 4.0 * 0.25);
    /// # Ok::<(), stochastic_light_culling::Error>(())
    /// ```
    #[must_use]
    pub fn listed() -> Self {
        Self::deciding(InList)
    }
}

impl<D> RadianceEstimator<D> {
    fn deciding(decision: D) -> Self {
        Self {
            settings: Settings {
                decision,
                least_distance_squared: 0.0,
            },
            level: widest(),
        }
    }

    /// Returns this estimator with squared distances taken to be at least `least`, in the squared unit of
    /// length. It keeps virtual lights, which stand for a patch of a surface, from becoming brighter than the
    /// patch. Directions do not change. The range of a light shrinks where it was smaller, so bounds stay
    /// valid. Clusters, whose light stays finite by their spread, are not changed.
    ///
    /// # Errors
    ///
    /// [`Error::Number`] if `least` is negative, infinite or NaN.
    pub fn with_least_distance_squared(self, least: f32) -> Result<Self, Error> {
        let least = number_in("least squared distance", least, "in [0, ∞)", 0.0..=f32::MAX)?;
        Ok(Self {
            settings: Settings {
                least_distance_squared: least,
                ..self.settings
            },
            ..self
        })
    }

    /// Returns this estimator with vectors of at most `lanes` lanes, as
    /// [`Culler::with_lanes`](crate::Culler::with_lanes) does. The estimates are the same.
    #[must_use]
    pub fn with_lanes(self, lanes: usize) -> Self {
        Self {
            level: at_most(lanes),
            ..self
        }
    }
}

/// Points that are lit.
impl<D: PointDecision> RadianceEstimator<D> {
    /// Evaluates the lights of `list` at the points of `block`. Calls `each` with every light that one of them
    /// accepts, in the order of the list.
    ///
    /// `each` is compiled for the vectors of this processor where it is inlined. A loop in it over all sixteen
    /// radiances, of which those of other points are zero, is then a few instructions.
    ///
    /// # Panics
    ///
    /// If `list` holds an index of no light, or has fewer weights than lights.
    #[inline]
    pub fn at_block<L: ShadedLight>(
        &self,
        lights: &ShadingBatch<L>,
        list: D::List<'_>,
        block: &PointBlock,
        mut each: impl FnMut(&BlockEstimates),
    ) {
        let settings = &self.settings;
        dispatch!(self.level, simd => evaluate_block(
            simd,
            settings,
            lights,
            list,
            block,
            #[inline(always)]
            |_| NoReceivers,
            #[inline(always)]
            |estimates: &BlockEstimates, _: &[f32; PointBlock::LEN]| each(estimates),
        ));
    }

    /// Evaluates at each of `points` the lights of its list. Calls `each` with the turn of the point, 0 for
    /// the first, and the estimate of every light that it accepts: point by point, in the order of the lists.
    ///
    /// A vector holds lights of several points where lists are short.
    ///
    /// # Panics
    ///
    /// If a list holds an index of no light, or has fewer weights than lights.
    #[inline]
    pub fn at_points<'l, L: ShadedLight>(
        &self,
        lights: &ShadingBatch<L>,
        points: impl IntoIterator<Item = (ShadedPoint, D::List<'l>)>,
        mut each: impl FnMut(usize, &Estimate),
    ) {
        self.fold_at_points(lights, points, (), |(), turn, estimate| {
            each(turn, estimate);
        });
    }

    /// Folds what [`at_points`](Self::at_points) would report into a state, beginning with `init`, and returns
    /// the last state.
    ///
    /// The state stays in registers, where what a closure borrows is in memory. This makes sums over long lists
    /// faster.
    ///
    /// ```
    /// use stochastic_light_culling::{
    ///     ConstantLobe, RadianceEstimator, Roulette, ShadedPoint, ShadingBatch, Vpl, Xi, glam::Vec3,
    /// };
    ///
    /// let mut lights = ShadingBatch::new();
    /// lights.push(&Vpl::new(Vec3::Z, 1.0, ConstantLobe)?, Xi::new(1.0)?);
    /// let estimator = RadianceEstimator::new(&Roulette::new(0.01)?);
    /// let point = ShadedPoint::from(Vec3::ZERO);
    /// let sum = estimator.fold_at_points(&lights, [(point, &[0, 0][..])], 0.0, |sum, _, estimate| {
    ///     sum + estimate.radiance
    /// });
    /// assert_eq!(sum, 0.5 / std::f32::consts::PI);
    /// # Ok::<(), stochastic_light_culling::Error>(())
    /// ```
    ///
    /// # Panics
    ///
    /// If a list holds an index of no light, or has fewer weights than lights.
    #[inline]
    pub fn fold_at_points<'l, L: ShadedLight, A>(
        &self,
        lights: &ShadingBatch<L>,
        points: impl IntoIterator<Item = (ShadedPoint, D::List<'l>)>,
        init: A,
        mut each: impl FnMut(A, usize, &Estimate) -> A,
    ) -> A {
        let settings = &self.settings;
        let points = points.into_iter().map(
            #[inline(always)]
            |(point, list)| (point, (), list),
        );
        dispatch!(self.level, simd => fold_pairs::<_, D, L, NoReceivers, A>(
            simd,
            settings,
            lights,
            points,
            init,
            #[inline(always)]
            |state, turn, estimate: &Estimate, _| each(state, turn, estimate),
        ))
    }
}

/// Receivers, which reflect light to the eye.
impl<D: Decision> RadianceEstimator<D> {
    /// Evaluates the lights of `list` at the receivers of `block`. Calls `each` with every light that one of
    /// them accepts, in the order of the list, and with the radiance that each receiver reflects of it to the
    /// eye: the estimate of the radiance times the [`value`](Lobe::value) of the receiver's lobe towards the
    /// light. It is zero where the light is not accepted, and past the last receiver.
    ///
    /// Of a cluster ([`Vsgl`](crate::Vsgl)) it is the receiver's `product_integral` with the light as it arrives, but
    /// for rounding: by the filtered NDF for a [`GgxLobe`](crate::GgxLobe::product_integral), by the product for
    /// a [`SphericalGaussian`](crate::SphericalGaussian::product_integral), and by the value towards the axis, as for a
    /// [`LambertLobe`](crate::LambertLobe::product_integral), for every other lobe. A cluster whose light arrives
    /// along an axis below the horizon is left out, though some of it may arrive from above.
    ///
    /// Lights below a receiver's horizon are left out before they are evaluated. If a material reflects
    /// colours alike but for a factor, multiply the sum by it, not each light.
    ///
    /// ```
    /// use stochastic_light_culling::{
    ///     Direction, Ggx, GgxLobe, Incidence, Lobe, NoFresnel, RadianceEstimator, Receiver, ReceiverBlock,
    ///     Roulette, ShadingBatch, Vpl, Xi, glam::Vec3,
    /// };
    ///
    /// // A floor with a lamp above it, seen from elsewhere.
    /// let (lamp, eye) = (Vec3::new(1.0, 2.0, 0.0), Vec3::new(-3.0, 2.0, 0.0));
    /// let mut lights = ShadingBatch::new();
    /// lights.push(&Vpl::point(lamp, 10.0)?, Xi::new(0.5)?);
    /// let receiver = |x: u32| -> Result<_, stochastic_light_culling::Error> {
    ///     let position = Vec3::new(x as f32 * 0.2 - 2.0, 0.0, 0.0);
    ///     let incidence = Incidence { normal: Direction::Y, incoming: Direction::new(eye - position)? };
    ///     Ok(Receiver { position, lobe: GgxLobe::new(Ggx::new(0.2)?, NoFresnel, incidence) })
    /// };
    /// let receivers = (0..16).map(receiver).collect::<Result<Vec<_>, _>>()?;
    /// let block = ReceiverBlock::take(&mut receivers.iter().copied()).expect("there are sixteen");
    ///
    /// let roulette = Roulette::new(0.001)?;
    /// let mut sums = [0.0; 16];
    /// RadianceEstimator::new(&roulette).reflected_at_block(&lights, &[0], &block, |_, reflected| {
    ///     for (sum, reflected) in sums.iter_mut().zip(reflected) {
    ///         *sum += reflected;
    ///     }
    /// });
    /// // The highlight is about half way, where the mirror direction meets the lamp, but nearer to the lamp.
    /// let brightest = (0..16).max_by(|i, j| sums[*i].total_cmp(&sums[*j]));
    /// assert_eq!(brightest, Some(6));
    /// # Ok::<(), stochastic_light_culling::Error>(())
    /// ```
    ///
    /// # Panics
    ///
    /// If `list` holds an index of no light, or has fewer weights than lights.
    #[inline]
    pub fn reflected_at_block<L: ShadedLight, R: Lobe>(
        &self,
        lights: &ShadingBatch<L>,
        list: D::List<'_>,
        block: &ReceiverBlock<R>,
        mut each: impl FnMut(&BlockEstimates, &[f32; PointBlock::LEN]),
    ) {
        let (settings, points) = (&self.settings, block.points());
        dispatch!(self.level, simd => evaluate_block(
            simd,
            settings,
            lights,
            list,
            points,
            #[inline(always)]
            |part| block.part(simd, part),
            #[inline(always)]
            |estimates: &BlockEstimates, reflected: &[f32; PointBlock::LEN]| {
                each(estimates, reflected);
            },
        ));
    }

    /// Evaluates at each of `receivers` the lights of its list. Folds the accepted ones as
    /// [`fold_at_points`](Self::fold_at_points) does, each with the radiance that the receiver reflects of it to
    /// the eye, as in [`reflected_at_block`](Self::reflected_at_block).
    ///
    /// # Panics
    ///
    /// If a list holds an index of no light, or has fewer weights than lights.
    #[inline]
    pub fn fold_reflected_at_points<'l, L: ShadedLight, R: Lobe + Clone, A>(
        &self,
        lights: &ShadingBatch<L>,
        receivers: impl IntoIterator<Item = (Receiver<R>, D::List<'l>)>,
        init: A,
        mut each: impl FnMut(A, usize, &Estimate, f32) -> A,
    ) -> A {
        let (settings, each) = (&self.settings, &mut each);
        let receivers = receivers.into_iter().map(
            #[inline(always)]
            |(receiver, list)| (receiver.point(), receiver.lobe, list),
        );
        dispatch!(self.level, simd => {
            fold_pairs::<_, D, L, Receivers<_, R>, A>(simd, settings, lights, receivers, init, each)
        })
    }
}
