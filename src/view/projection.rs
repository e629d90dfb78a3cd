use core::fmt::Debug;

use glam::{Vec2, Vec3};

use crate::base::Error;
use crate::num::{Single, Vector3};

/// The kind of projection of a [`Camera`](crate::Camera): [`Perspective`](crate::Perspective) or
/// [`Orthographic`](crate::Orthographic).
///
/// For generic code. All that depends on it is compiled for each kind by itself, so that neither pays for the
/// other.
///
/// ```
/// use stochastic_light_culling::{
///     BatchBuilder, Camera, ConstantLobe, Culler, Error, LightBatch, LightLists, ProjectedSphere, Projection,
///     Roulette, Seed, TileDepths, Vpl,
/// };
///
/// /// Lists the lights of a view of either kind.
/// fn cull<P: Projection>(
///     lights: &[Vpl<ConstantLobe>],
///     camera: &Camera<P>,
///     tiles: &TileDepths,
///     culler: &mut Culler<ProjectedSphere<P>>,
///     batch: &mut LightBatch<ProjectedSphere<P>>,
///     lists: &mut LightLists,
/// ) -> Result<(), Error> {
///     let seed = Seed(0).frame(0);
///     batch.clear();
///     let with_xi = (0..).zip(lights).map(|(i, light)| (i, light, seed.xi(i)));
///     BatchBuilder::new(&Roulette::new(0.01)?, camera).add(with_xi, batch);
///     culler.cull(batch, tiles, lists)?;
///     Ok(())
/// }
/// ```
pub trait Projection: sealed::Sealed + Copy + Debug + PartialEq + Send + Sync + 'static {
    /// Whether tiles converge at the eye, so that they are frustums. Else they are boxes.
    #[doc(hidden)]
    const IS_PERSPECTIVE: bool;

    /// Checks the numbers of the projection, and those of the rectangle of all its tiles: middle and half size.
    #[doc(hidden)]
    fn checked(self, half_size: Vec2, middle: Vec2) -> Result<Self, Error>;

    /// Converts a value of the depth buffer to a depth in camera space.
    #[doc(hidden)]
    fn depth(&self, ndc_depth: f32) -> f32;

    /// The point of camera space at `depth` with these coordinates in the rectangles of tiles.
    #[doc(hidden)]
    fn point(coordinates: Vec2, depth: f32) -> Vec3;

    /// `factor` times an upper bound of the distance from the origin of camera space of points in view that are
    /// within `radius` of `center`.
    #[doc(hidden)]
    fn farthest<N: Single>(&self, center: Vector3<N>, radius: N, factor: f32) -> N;
}

pub(super) mod sealed {
    pub trait Sealed {}
}

/// The error of a projection that is refused.
pub(super) fn refused(element: f32, valid: &'static str) -> Error {
    Error::Matrix {
        quantity: "projection matrix",
        element,
        valid,
    }
}
