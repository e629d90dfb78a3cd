use super::shape::{Quads, Shape};
use crate::light::{Roulette, Vpl, Xi};
use crate::lobe::Lobe;
use crate::num::Single;

/// A way to bound lobes of type `L`.
///
/// [`Tight`], [`Triaxial`], [`Focal`] and [`Paper`] are strategies for some of the lobes of this crate, [`OwnBound`] is
/// one for every lobe.
///
/// ```
/// use stochastic_light_culling::{
///     Bounded, Direction, Ggx, GgxLobe, Incidence, Paper, Schlick, Tight, Triaxial, glam::Vec3,
/// };
///
/// let incidence = Incidence {
///     normal: Direction::Y,
///     incoming: Direction::new(Vec3::new(-3.0, 1.0, 0.0))?,
/// };
/// let plastic = GgxLobe::new(Ggx::new(0.2)?, Schlick::new(0.04)?, incidence);
/// let volume = |semi_axes: Vec3| semi_axes.element_product();
/// let tight = volume(plastic.unit_bound_by(Tight).semi_axes());
/// let triaxial = volume(plastic.unit_bound_by(Triaxial).semi_axes());
/// let paper = plastic.unit_bound_by(Paper);
/// let paper = paper.long_semi_axis() * paper.radius() * paper.radius();
/// assert!(tight < triaxial && triaxial < paper);
/// assert_eq!(plastic.unit_bound(), plastic.unit_bound_by(Tight));
/// # Ok::<(), stochastic_light_culling::Error>(())
/// ```
pub trait BoundStrategy<L: Lobe>: Copy {
    /// The type of the shape.
    type Shape: Shape;

    /// Bounds the unit isosurface {√value(ω)·ω : ω a unit vector} of `lobe`, for a light at the origin, by a
    /// shape that contains it. The shape is empty if the lobe is.
    #[inline]
    fn unit_bound(&self, lobe: &L) -> Self::Shape {
        if lobe.is_empty() {
            return Self::Shape::EMPTY;
        }
        let (quads, per_light) = self.to_quads(lobe);
        Self::Shape::from_lanes(self.unit_bounds::<f32>(&quads, &[per_light]))
    }

    /// The part of a lobe that is not stored as quads.
    #[doc(hidden)]
    type PerLight: Copy;

    /// The number of quads in use.
    #[doc(hidden)]
    const QUADS: usize;

    #[doc(hidden)]
    fn to_quads(&self, lobe: &L) -> (Quads<f32>, Self::PerLight);

    /// Computes [`unit_bound`](Self::unit_bound) in each lane, for lobes that are not empty.
    #[doc(hidden)]
    fn unit_bounds<N: Single>(
        &self,
        quads: &Quads<N>,
        per_light: &[Self::PerLight],
    ) -> <Self::Shape as Shape>::Lanes<N>;
}

/// A lobe with a recommended bound.
///
/// A lobe of another crate implements this trait with the strategy [`OwnBound`]. It can then be batched and
/// culled as the lobes of this crate are:
///
/// ```
/// use stochastic_light_culling::{Bounded, Direction, Lobe, OwnBound, Sphere, glam::Vec3};
///
/// /// Constant intensity within a hemisphere.
/// #[derive(Clone, Copy)]
/// struct Hemisphere(Direction);
///
/// impl Lobe for Hemisphere {
///     fn value(&self, outgoing: Vec3) -> f32 {
///         if self.0.dot(outgoing) > 0.0 { 0.25 } else { 0.0 }
///     }
/// }
///
/// impl Bounded for Hemisphere {
///     type Shape = Sphere;
///     type Strategy = OwnBound;
///
///     fn unit_bound(&self) -> Sphere {
///         Sphere::new(Vec3::ZERO, 0.5).expect("a constant")
///     }
/// }
/// ```
pub trait Bounded: Lobe + Sized + 'static {
    /// The type of the recommended bound.
    type Shape: Shape;

    /// The strategy of [`unit_bound`](Self::unit_bound), which batches use too.
    type Strategy: BoundStrategy<Self, Shape = Self::Shape> + Default;

    /// Bounds the unit isosurface {√value(ω)·ω : ω a unit vector}, for a light at the origin, in the
    /// recommended way. The shape is empty if the lobe is.
    #[must_use]
    fn unit_bound(&self) -> Self::Shape;

    /// Bounds the unit isosurface by `strategy`.
    #[must_use]
    fn unit_bound_by<B: BoundStrategy<Self>>(&self, strategy: B) -> B::Shape {
        strategy.unit_bound(self)
    }
}

impl<L: Bounded> Vpl<L> {
    /// The recommended bound of all points that accept this light in a frame with `roulette` and `xi`. Empty
    /// if the flux is zero.
    ///
    /// For a light that does not change, keep its [`unit_bound`](Bounded::unit_bound), and place that in each
    /// frame ([`Shape::placed`]).
    #[inline]
    #[must_use]
    pub fn bound(&self, roulette: &Roulette, xi: Xi) -> L::Shape {
        self.bound_by(L::Strategy::default(), roulette, xi)
    }
}

impl<L: Lobe> Vpl<L> {
    /// The bound, by `strategy`, of all points that accept this light in a frame with `roulette` and `xi`.
    /// Empty if the flux is zero.
    #[inline]
    #[must_use]
    pub fn bound_by<B: BoundStrategy<L>>(
        &self,
        strategy: B,
        roulette: &Roulette,
        xi: Xi,
    ) -> B::Shape {
        let scale = roulette.scale(self.flux(), xi);
        strategy
            .unit_bound(self.lobe())
            .placed(self.position(), scale)
    }
}

/// The strategy of the papers: the spheroid of a [`GgxLobe`](crate::GgxLobe)
/// [Tokuyoshi & Harada 2017, Eqs. 9–15], and the spheres of a [`LambertLobe`](crate::LambertLobe)
/// [Tokuyoshi & Harada 2017, Sec. 6] and of a [`ConstantLobe`](crate::ConstantLobe)
/// [Tokuyoshi & Harada 2016].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Paper;

/// The strategy of an ellipsoid in closed form with three different semi-axes, for a
/// [`GgxLobe`](crate::GgxLobe) or an [`AnisotropicGgxLobe`](crate::AnisotropicGgxLobe).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Triaxial;

/// The strategy of the smallest ellipsoid, or nearly: from a table for a [`GgxLobe`](crate::GgxLobe), in
/// closed form for a [`PhongLobe`](crate::PhongLobe), a [`SpotLobe`](crate::SpotLobe), a
/// [`LambertLobe`](crate::LambertLobe) and a [`SphericalGaussian`](crate::SphericalGaussian).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tight;

/// The strategy of a spheroid with one focus at the light, in closed form, for a
/// [`SphericalGaussian`](crate::SphericalGaussian). It encloses by a short proof, and costs fewer operations
/// than [`Tight`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Focal;

/// The strategy that returns the lobe's own [`Bounded::unit_bound`]. A batch computes it light by light, and
/// places and projects it in lanes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct OwnBound;

impl<L: Bounded> BoundStrategy<L> for OwnBound {
    type Shape = L::Shape;

    #[inline]
    fn unit_bound(&self, lobe: &L) -> L::Shape {
        lobe.unit_bound()
    }

    type PerLight = ();

    const QUADS: usize = L::Shape::QUADS;

    #[inline(always)]
    fn to_quads(&self, lobe: &L) -> (Quads<f32>, ()) {
        (lobe.unit_bound().to_quads(), ())
    }

    #[inline(always)]
    fn unit_bounds<N: Single>(&self, quads: &Quads<N>, _: &[()]) -> <L::Shape as Shape>::Lanes<N> {
        L::Shape::from_quads(quads)
    }
}
