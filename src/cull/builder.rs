use core::marker::PhantomData;

use fearless_simd::{Level, dispatch};
use glam::Vec3;

use super::LightBatch;
use super::culler::{at_most, widest};
use super::group::{BatchInput, Clusters, Frame, GROUP, Group, KeptBounds, Lights};
use crate::bound::{BoundStrategy, Bounded};
use crate::light::{Roulette, Vpl, Vsgl, Xi};
use crate::lobe::Lobe;
use crate::project::{Project, ProjectedBound, ProjectedEllipsoid};
use crate::view::{Camera, Perspective, Projection};

/// Adds the lights of a frame to a [`LightBatch`], for a [`Culler`](crate::Culler).
///
/// Bounds, places and projects many lights at a time, several times as fast as the scalar functions. The
/// shapes have the same bits, and the order of the lights is kept. Lights whose bound is empty are left out.
/// Allocates only if the batch must grow.
///
/// ```
/// use stochastic_light_culling::{
///     BatchBuilder, Camera, Direction, Seed, Ggx, GgxLobe, Incidence, LightBatch, NoFresnel,
///     Paper, Roulette, Vpl, glam::Vec3,
/// };
///
/// let lobe = GgxLobe::new(Ggx::new(0.2)?, NoFresnel, Incidence::head_on(Direction::Y));
/// let light = |i: u32| Vpl::new(Vec3::new(i as f32, 0.0, -9.0), 0.5, lobe);
/// let lights = (0..100).map(light).collect::<Result<Vec<_>, _>>()?;
///
/// let roulette = Roulette::new(0.01)?;
/// let camera = Camera::look_at(Vec3::ZERO, Vec3::NEG_Z, Vec3::Y, 1.0, 1.0, 0.1..100.0)?;
/// let seed = Seed(0).frame(7);
/// let builder = BatchBuilder::new(&roulette, &camera);
/// let with_xi = || (0..).zip(&lights).map(|(i, light)| (i, light, seed.xi(i)));
///
/// let mut batch = LightBatch::new();
/// builder.add(with_xi(), &mut batch);
/// let (light, ellipsoid) = batch.iter().nth(41).expect("one of a hundred");
/// let bound = lights[41].bound(&roulette, seed.xi(41));
/// assert_eq!((light, Some(ellipsoid)), (41, bound.project(&camera)));
///
/// // With the bound of the paper.
/// batch.clear();
/// builder.add_by(Paper, with_xi(), &mut batch);
/// # Ok::<(), stochastic_light_culling::Error>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct BatchBuilder<P = Perspective> {
    frame: Frame<P>,
    level: Level,
}

impl<P: Projection> BatchBuilder<P> {
    /// Creates a builder for a frame with `roulette` and `camera`, with the widest vectors of this processor.
    /// Without the feature `std` the processor cannot be queried, and the vectors are those of the
    /// compilation target.
    #[must_use]
    pub fn new(roulette: &Roulette, camera: &Camera<P>) -> Self {
        Self {
            frame: Frame {
                roulette: *roulette,
                camera: *camera,
            },
            level: widest(),
        }
    }

    /// Returns this builder with vectors of at most `lanes` lanes, as
    /// [`Culler::with_lanes`](crate::Culler::with_lanes) does. The shapes are the same.
    #[must_use]
    pub fn with_lanes(self, lanes: usize) -> Self {
        Self {
            level: at_most(lanes),
            ..self
        }
    }

    /// Adds lights with the [recommended bound](Vpl::bound) of their lobe.
    ///
    /// Each item is the index of a light, which lists will hold, the light, and its ξ in this frame.
    pub fn add<'a, L: Bounded<Shape: Project>>(
        &self,
        lights: impl IntoIterator<Item = (u32, &'a Vpl<L>, Xi)>,
        batch: &mut LightBatch<ProjectedBound<L, P>>,
    ) {
        self.add_by(L::Strategy::default(), lights, batch);
    }

    /// Adds lights as [`add`](Self::add) does, with the bound of [`strategy`](Vpl::bound_by).
    pub fn add_by<'a, L: Lobe + 'static, B: BoundStrategy<L, Shape: Project>>(
        &self,
        strategy: B,
        lights: impl IntoIterator<Item = (u32, &'a Vpl<L>, Xi)>,
        batch: &mut LightBatch<<B::Shape as Project>::Projected<P>>,
    ) {
        let lights = lights.into_iter();
        let lights = lights.map(|(index, light, xi)| (index, (light, xi)));
        self.fill(Lights::bounded_by(strategy), lights, batch);
    }

    /// Adds clusters of lights, with their [bound](Vsgl::bound).
    ///
    /// Each item is the index of a light, which lists will hold, the light, and its ξ in this frame. Clusters may share
    /// a batch with lights that are bounded by ellipsoids.
    ///
    /// ```
    /// use stochastic_light_culling::{
    ///     BatchBuilder, Camera, Direction, LightBatch, Roulette, Seed, SphericalGaussian, Vsgl, glam::Vec3,
    /// };
    ///
    /// let lobe = SphericalGaussian::with_integral(Direction::Y, 8.0, 0.5)?;
    /// let light = |i: u32| Vsgl::new(Vec3::new(i as f32, 0.0, -9.0), 0.3, lobe);
    /// let lights = (0..100).map(light).collect::<Result<Vec<_>, _>>()?;
    ///
    /// let (roulette, seed) = (Roulette::new(0.01)?, Seed(0).frame(7));
    /// let camera = Camera::look_at(Vec3::ZERO, Vec3::NEG_Z, Vec3::Y, 1.0, 1.0, 0.1..100.0)?;
    /// let mut batch = LightBatch::new();
    /// let with_xi = (0..).zip(&lights).map(|(i, light)| (i, light, seed.xi(i)));
    /// BatchBuilder::new(&roulette, &camera).add_vsgls(with_xi, &mut batch);
    ///
    /// let (light, ellipsoid) = batch.iter().nth(41).expect("one of a hundred");
    /// let bound = lights[41].bound(&roulette, seed.xi(41));
    /// assert_eq!((light, Some(ellipsoid)), (41, bound.project(&camera)));
    /// # Ok::<(), stochastic_light_culling::Error>(())
    /// ```
    pub fn add_vsgls<'a>(
        &self,
        lights: impl IntoIterator<Item = (u32, &'a Vsgl, Xi)>,
        batch: &mut LightBatch<ProjectedEllipsoid<P>>,
    ) {
        let lights = lights.into_iter();
        let lights = lights.map(|(index, light, xi)| (index, (light, xi)));
        self.fill(Clusters, lights, batch);
    }

    /// Adds bounds that are kept from frame to frame.
    ///
    /// Each item is the index of a light, which lists will hold, its bound, and the position and the scale
    /// with which the bound is [placed](crate::Shape::placed). For the
    /// [unit bound](Bounded::unit_bound) of a light, these are its position and [`Roulette::scale`].
    pub fn add_placed<'a, B: Project>(
        &self,
        bounds: impl IntoIterator<Item = (u32, &'a B, Vec3, f32)>,
        batch: &mut LightBatch<B::Projected<P>>,
    ) {
        let bounds = bounds.into_iter();
        let bounds =
            bounds.map(|(index, bound, position, scale)| (index, (bound, position, scale)));
        self.fill(KeptBounds(PhantomData), bounds, batch);
    }

    /// Collects items in groups, and adds the shapes of each group.
    fn fill<'a, I: BatchInput>(
        &self,
        input: I,
        items: impl Iterator<Item = (u32, I::Item<'a>)>,
        batch: &mut LightBatch<<I::Shape as Project>::Projected<P>>,
    ) {
        let mut items = items.filter(|(_, item)| I::may_reach(*item));
        let Some((light, item)) = items.next() else {
            return;
        };
        let mut group = Group::splat(input, item);
        group.set(0, light, item);
        let mut count = 1;
        for (light, item) in items {
            if count == GROUP {
                self.flush(&group, count, batch);
                count = 0;
            }
            group.set(count, light, item);
            count += 1;
        }
        self.flush(&group, count, batch);
    }

    /// Adds the shapes of the first `count` items of a group to the batch.
    fn flush<I: BatchInput>(
        &self,
        group: &Group<I>,
        count: usize,
        batch: &mut LightBatch<<I::Shape as Project>::Projected<P>>,
    ) {
        dispatch!(self.level, simd => group.append_to(simd, count, &self.frame, batch));
    }
}
