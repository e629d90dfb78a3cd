//! The bounds and projections of a group of lights, in vectors.
//!
//! The fields of the lights are transposed to lanes. The vectors then run the generic functions that the
//! scalar functions run for one light, so the results have the same bits.

use core::marker::PhantomData;

use fearless_simd::{Simd, SimdBase};
use glam::Vec3;

use super::LightBatch;
use super::lanes::{LANES, mask_of_first};
use crate::bound::{
    BoundStrategy, Ellipsoid, Ellipsoids, MAX_QUADS, Quads, Shape, ShapeLanes, around_clusters,
    quads_of_cluster,
};
use crate::light::{Roulette, Vpl, Vsgl, Xi};
use crate::lobe::Lobe;
use crate::num::{F32Lanes, Quad, Real, Single, Twice, Vector3, load_quads_twice};
use crate::project::{Project, Projected};
use crate::view::{Camera, Projection};

/// A kind of input that a batch is built from.
pub(super) trait BatchInput: Copy {
    /// A light, or a bound and its placement.
    type Item<'a>: Copy;
    /// The bound of an item.
    type Shape: Project;
    /// The part of an item that is not numeric.
    type PerLight: Copy;

    /// The number of quads in use.
    const QUADS: usize;

    /// Whether the unit bound of an item may be other than empty. Items for which this is false are skipped
    /// early. Those with a scale of zero are few, and skipped in lanes.
    fn may_reach(item: Self::Item<'_>) -> bool;

    fn placement(item: Self::Item<'_>) -> Placement;

    /// The numeric part of an item as quads, and the other part.
    fn to_quads(self, item: Self::Item<'_>) -> (Quads<f32>, Self::PerLight);

    /// The bounds at unit scale of lights at the origin that will have the scale `scale`, on which the shape may
    /// depend.
    fn unit_bounds<N: Single>(
        self,
        quads: &Quads<N>,
        per_light: &[Self::PerLight],
        scale: N,
    ) -> <Self::Shape as Shape>::Lanes<N>;

    /// The scales of items with this flux and frame parameter.
    fn scale<N: Single>(roulette: &Roulette, flux: N, parameter: N) -> N;
}

/// The position of a bound, and the numbers from which its scale is computed.
pub(super) struct Placement {
    position: Vec3,
    /// Φ
    flux: f32,
    /// The parameter of the frame: ξ, or the scale itself.
    parameter: f32,
}

/// Lights that are bounded by a strategy.
pub(super) struct Lights<L, B>(B, PhantomData<L>);

impl<L, B: Copy> Clone for Lights<L, B> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<L, B: Copy> Copy for Lights<L, B> {}

impl<L, B> Lights<L, B> {
    pub fn bounded_by(strategy: B) -> Self {
        Self(strategy, PhantomData)
    }
}

impl<L: Lobe + 'static, B: BoundStrategy<L, Shape: Project>> BatchInput for Lights<L, B> {
    type Item<'a> = (&'a Vpl<L>, Xi);
    type Shape = B::Shape;
    type PerLight = B::PerLight;

    const QUADS: usize = B::QUADS;

    #[inline(always)]
    fn may_reach((light, _): (&Vpl<L>, Xi)) -> bool {
        !light.lobe().is_empty()
    }

    #[inline(always)]
    fn placement((light, xi): (&Vpl<L>, Xi)) -> Placement {
        Placement {
            position: light.position(),
            flux: light.flux(),
            parameter: xi.get(),
        }
    }

    #[inline(always)]
    fn to_quads(self, (light, _): (&Vpl<L>, Xi)) -> (Quads<f32>, B::PerLight) {
        self.0.to_quads(light.lobe())
    }

    #[inline(always)]
    fn unit_bounds<N: Single>(
        self,
        quads: &Quads<N>,
        per_light: &[B::PerLight],
        _: N,
    ) -> <B::Shape as Shape>::Lanes<N> {
        self.0.unit_bounds(quads, per_light)
    }

    #[inline(always)]
    fn scale<N: Single>(roulette: &Roulette, flux: N, xi: N) -> N {
        roulette.scale_in_lanes(flux, xi)
    }
}

/// Clusters of lights.
#[derive(Clone, Copy)]
pub(super) struct Clusters;

impl BatchInput for Clusters {
    type Item<'a> = (&'a Vsgl, Xi);
    type Shape = Ellipsoid;
    type PerLight = ();

    const QUADS: usize = 2;

    #[inline(always)]
    fn may_reach((light, _): (&Vsgl, Xi)) -> bool {
        !light.lobe().is_empty()
    }

    #[inline(always)]
    fn placement((light, xi): (&Vsgl, Xi)) -> Placement {
        Placement {
            position: light.position(),
            flux: light.lobe().amplitude(),
            parameter: xi.get(),
        }
    }

    #[inline(always)]
    fn to_quads(self, (light, _): (&Vsgl, Xi)) -> (Quads<f32>, ()) {
        (quads_of_cluster(light), ())
    }

    #[inline(always)]
    fn unit_bounds<N: Single>(self, quads: &Quads<N>, _: &[()], scale: N) -> Ellipsoids<N> {
        around_clusters(quads, scale)
    }

    #[inline(always)]
    fn scale<N: Single>(roulette: &Roulette, amplitude: N, xi: N) -> N {
        roulette.scale_in_lanes(amplitude, xi)
    }
}

/// Bounds that are kept from frame to frame.
#[derive(Clone, Copy)]
pub(super) struct KeptBounds<B>(pub PhantomData<B>);

impl<B: Project> BatchInput for KeptBounds<B> {
    type Item<'a> = (&'a B, Vec3, f32);
    type Shape = B;
    type PerLight = ();

    const QUADS: usize = B::QUADS;

    #[inline(always)]
    fn may_reach((bound, ..): (&B, Vec3, f32)) -> bool {
        !bound.is_empty()
    }

    #[inline(always)]
    fn placement((_, position, scale): (&B, Vec3, f32)) -> Placement {
        Placement {
            position,
            flux: 0.0,
            parameter: scale,
        }
    }

    #[inline(always)]
    fn to_quads(self, (bound, ..): (&B, Vec3, f32)) -> (Quads<f32>, ()) {
        (bound.to_quads(), ())
    }

    #[inline(always)]
    fn unit_bounds<N: Single>(self, quads: &Quads<N>, _: &[()], _: N) -> B::Lanes<N> {
        B::from_quads(quads)
    }

    #[inline(always)]
    fn scale<N: Single>(_: &Roulette, _: N, scale: N) -> N {
        scale
    }
}

/// The parameters that all lights of a frame share.
#[derive(Clone, Copy, Debug)]
pub(super) struct Frame<P> {
    pub roulette: Roulette,
    pub camera: Camera<P>,
}

/// The number of lights of a group.
pub(super) const GROUP: usize = 4 * LANES;

/// A group of lights, and the projected shapes that are computed from them.
#[repr(C, align(64))]
pub(super) struct Group<I: BatchInput> {
    input: I,
    /// The position and Φ of each light. Not yet transposed, since a quad is copied at once.
    placements: [Quad<f32>; GROUP],
    quads: [[Quad<f32>; GROUP]; MAX_QUADS],
    parameters: [f32; GROUP],
    per_light: [I::PerLight; GROUP],
    lights: [u32; GROUP],
}

impl<I: BatchInput> Group<I> {
    /// Creates a group with `item` in all lanes.
    #[inline(always)]
    pub fn splat(input: I, item: I::Item<'_>) -> Self {
        let Placement {
            position: p,
            flux,
            parameter,
        } = I::placement(item);
        let (item_quads, per_light) = input.to_quads(item);
        let mut quads = [[[0.0; 4]; GROUP]; MAX_QUADS];
        for (lanes, quad) in quads[..I::QUADS].iter_mut().zip(item_quads) {
            *lanes = [quad; GROUP];
        }
        Self {
            input,
            placements: [[p.x, p.y, p.z, flux]; GROUP],
            quads,
            parameters: [parameter; GROUP],
            per_light: [per_light; GROUP],
            lights: [0; GROUP],
        }
    }

    /// Stores an item in `lane` < [`GROUP`].
    #[inline(always)]
    pub fn set(&mut self, lane: usize, light: u32, item: I::Item<'_>) {
        let lane = lane % GROUP;
        let Placement {
            position: p,
            flux,
            parameter,
        } = I::placement(item);
        self.placements[lane] = [p.x, p.y, p.z, flux];
        let (quads, per_light) = self.input.to_quads(item);
        for (lanes, quad) in self.quads[..I::QUADS].iter_mut().zip(&quads) {
            lanes[lane] = *quad;
        }
        self.parameters[lane] = parameter;
        self.per_light[lane] = per_light;
        self.lights[lane] = light;
    }

    /// Projects the first `count` items, of which there is at least one, and adds the shapes that are not empty
    /// to `batch`.
    #[inline(always)]
    pub fn append_to<S: Simd, P: Projection>(
        &self,
        simd: S,
        count: usize,
        frame: &Frame<P>,
        batch: &mut LightBatch<<I::Shape as Project>::Projected<P>>,
    ) {
        batch.make_room(batch.len() + GROUP);
        for first in (0..count).step_by(2 * S::f32s::LEN) {
            let (fields, reaches) = self.project(simd, first, frame);
            let left = count - first;
            let wanted = Twice(
                mask_of_first(simd, left),
                mask_of_first(simd, left.saturating_sub(S::f32s::LEN)),
            );
            batch.append(simd, wanted & reaches, &self.lights[first..], &fields);
        }
    }

    /// Projects two vectors of items. Returns the fields of the shapes, and which of them are not empty.
    #[inline(always)]
    fn project<S: Simd, P: Projection>(
        &self,
        simd: S,
        first: usize,
        frame: &Frame<P>,
    ) -> (Fields<I, S, P>, Twice<S::mask32s>) {
        let lanes = first..first + 2 * S::f32s::LEN;
        let [x, y, z, flux] = load_quads_twice(simd, &self.placements[lanes.clone()]);
        let mut quads = [[x.zero(); 4]; MAX_QUADS];
        for (vectors, quads) in quads[..I::QUADS].iter_mut().zip(&self.quads) {
            *vectors = load_quads_twice(simd, &quads[lanes.clone()]);
        }
        let parameter = flux.load(&self.parameters[lanes.clone()]);
        let scale = I::scale(&frame.roulette, flux, parameter);
        let unit = self
            .input
            .unit_bounds(&quads, &self.per_light[lanes], scale);
        let reaches = !unit.is_empty() & scale.is_positive();
        let placed = unit.placed(Vector3::new(x, y, z), scale);
        (I::Shape::project_lanes(placed, &frame.camera), reaches)
    }
}

/// The fields of the projected shapes of two vectors of items.
type Fields<I, S, P> =
    <<<I as BatchInput>::Shape as Project>::Projected<P> as Projected>::Fields<Twice<F32Lanes<S>>>;
