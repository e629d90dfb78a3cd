use core::fmt::Debug;

use fearless_simd::{Select, Simd, SimdBase};
use glam::{Mat3, Vec3};

use super::lanes::{
    self, Ends, LANES, Lanes, apart, apart_at_depths, length_squared, load, scaled, shifted,
};
use crate::tile::{Image, Number};
use crate::{CameraSphere, Stretch, TileTest, math};

/// What a [`LightBatch`](super::LightBatch) can hold: [`Stretch`] and [`CameraSphere`].
///
/// A sphere has fewer numbers and no matrix, so that diffuse lights cost less than glossy ones.
pub trait BatchShape: TileTest + InLanes {}

impl BatchShape for Stretch {}
impl BatchShape for CameraSphere {}

/// A number, many of them, or a vector.
pub trait Lane: Copy + Debug + Send + Sync {}

impl<T: Copy + Debug + Send + Sync> Lane for T {}

/// The tile test over lanes, in the same operations as [`TileTest`].
pub trait InLanes: Copy {
    /// The numbers of a light, each of type `T`.
    type Fields<T: Lane>: Lane + AsRef<[T]> + AsMut<[T]>;
    /// What the lights have in common with all tiles of a row: a part of the test's box.
    type Row<T: Lane>: Lane + AsRef<[T]> + AsMut<[T]>;

    /// Lights that touch nothing.
    const NOWHERE: Self::Fields<Lanes>;
    const NO_ROW: Self::Row<Lanes>;

    fn fields_of<T: Lane>(value: T) -> Self::Fields<T>;
    fn row_of<T: Lane>(value: T) -> Self::Row<T>;
    fn fields(&self) -> Self::Fields<f32>;
    fn from_fields(fields: Self::Fields<f32>) -> Self;

    /// From the nearest to the farthest depth of a tile that the light touches, or a little more.
    fn reach(&self) -> [f32; 2];

    fn row<S: Simd>(
        simd: S,
        fields: &Self::Fields<Lanes>,
        part: usize,
        slopes: Ends<S>,
    ) -> Self::Row<S::f32s>;

    /// Whether the lights do not touch the tile with these slopes across and down, and these depths.
    fn misses<S: Simd>(
        simd: S,
        fields: &Self::Fields<Lanes>,
        part: usize,
        row: &Self::Row<S::f32s>,
        tile: &TileLanes<S>,
    ) -> S::mask32s;

    /// What the exact test takes.
    fn image<N: Number>(fields: &Self::Fields<N>) -> Image<N>;
}

/// A tile, the same in each lane.
#[derive(Clone, Copy)]
pub struct TileLanes<S: Simd> {
    pub(super) across: Ends<S>,
    pub(super) down: Ends<S>,
    pub(super) depths: Ends<S>,
}

impl<S: Simd> TileLanes<S> {
    #[inline(always)]
    pub(super) fn new(simd: S, across: [f32; 2], down: [f32; 2], depths: [f32; 2]) -> Self {
        Self {
            across: lanes::splat(simd, across),
            down: lanes::splat(simd, down),
            depths: lanes::splat(simd, depths),
        }
    }
}

impl InLanes for Stretch {
    /// M₁₁, M₁₂, M₁₃, M₂₁, M₂₂, M₂₃, m, and Mc′.
    type Fields<T: Lane> = [T; 10];
    /// M₁₂y + M₁₃ and M₂₂y + M₂₃, from the least to the greatest.
    type Row<T: Lane> = [T; 4];

    const NOWHERE: [Lanes; 10] = {
        let mut fields = [[0.0; LANES]; 10];
        fields[7] = [f32::INFINITY; LANES];
        fields
    };
    const NO_ROW: [Lanes; 4] = [[0.0; LANES]; 4];

    fn fields_of<T: Lane>(value: T) -> [T; 10] {
        [value; 10]
    }

    fn row_of<T: Lane>(value: T) -> [T; 4] {
        [value; 4]
    }

    fn fields(&self) -> [f32; 10] {
        let [x, y, z] = [
            self.matrix().x_axis,
            self.matrix().y_axis,
            self.matrix().z_axis,
        ];
        let c = self.center();
        [x.x, y.x, z.x, x.y, y.y, z.y, z.z, c.x, c.y, c.z]
    }

    fn from_fields([m_11, m_12, m_13, m_21, m_22, m_23, m, x, y, z]: [f32; 10]) -> Self {
        let matrix = Mat3::from_cols(
            Vec3::new(m_11, m_21, 0.0),
            Vec3::new(m_12, m_22, 0.0),
            Vec3::new(m_13, m_23, m),
        );
        Self::from_parts(matrix, Vec3::new(x, y, z))
    }

    #[inline]
    fn reach(&self) -> [f32; 2] {
        let (m, depth) = (self.matrix().z_axis.z, self.center().z);
        outward([depth - UNIT_REACH, depth + UNIT_REACH].map(|end| end / m))
    }

    #[inline(always)]
    fn row<S: Simd>(simd: S, fields: &[Lanes; 10], part: usize, slopes: Ends<S>) -> [S::f32s; 4] {
        let [_, m_12, m_13, _, m_22, m_23, ..] = fields;
        let x = scaled::<S>(load(simd, m_12, part), slopes);
        let y = scaled::<S>(load(simd, m_22, part), slopes);
        let [m_13, m_23] = [load(simd, m_13, part), load(simd, m_23, part)];
        [x[0] + m_13, x[1] + m_13, y[0] + m_23, y[1] + m_23]
    }

    #[inline(always)]
    fn misses<S: Simd>(
        simd: S,
        fields: &[Lanes; 10],
        part: usize,
        row: &[S::f32s; 4],
        tile: &TileLanes<S>,
    ) -> S::mask32s {
        let [m_11, _, _, m_21, _, _, m, x, y, z] = fields;
        let [row_x, row_y] = [[row[0], row[1]], [row[2], row[3]]];
        let across = shifted::<S>(scaled::<S>(load(simd, m_11, part), tile.across), row_x);
        let down = shifted::<S>(scaled::<S>(load(simd, m_21, part), tile.across), row_y);
        let m = load(simd, m, part);
        let x = apart_at_depths::<S>(load(simd, x, part), across, tile.depths);
        let y = apart_at_depths::<S>(load(simd, y, part), down, tile.depths);
        let z = apart::<S>(
            load(simd, z, part),
            [m * tile.depths[0], m * tile.depths[1]],
        );
        length_squared::<S>(x, y, z).simd_gt(S::f32s::splat(simd, 1.0))
    }

    #[inline(always)]
    fn image<N: Number>(fields: &[N; 10]) -> Image<N> {
        let [m_11, m_12, m_13, m_21, m_22, m_23, m, x, y, z] = *fields;
        let one = m.constant(1.0);
        Image {
            a: [m_11, m_21],
            b: [m_12, m_22],
            d: [m_13, m_23, m],
            center: [x, y, z],
            radius: one,
            radius_squared: one,
        }
    }
}

impl InLanes for CameraSphere {
    /// The centre, and the square of the radius.
    type Fields<T: Lane> = [T; 4];
    type Row<T: Lane> = [T; 0];

    // However large the tile, no distance is less than this.
    const NOWHERE: [Lanes; 4] = [[0.0; LANES], [0.0; LANES], [0.0; LANES], [-1.0; LANES]];
    const NO_ROW: [Lanes; 0] = [];

    fn fields_of<T: Lane>(value: T) -> [T; 4] {
        [value; 4]
    }

    fn row_of<T: Lane>(_: T) -> [T; 0] {
        []
    }

    fn fields(&self) -> [f32; 4] {
        let c = self.center();
        [c.x, c.y, c.z, self.radius_squared()]
    }

    fn from_fields([x, y, z, radius_squared]: [f32; 4]) -> Self {
        Self::from_parts(Vec3::new(x, y, z), radius_squared)
    }

    #[inline]
    fn reach(&self) -> [f32; 2] {
        let radius = math::round_up(math::sqrt(self.radius_squared()), 4);
        outward([self.center().z - radius, self.center().z + radius])
    }

    #[inline(always)]
    fn row<S: Simd>(_: S, _: &[Lanes; 4], _: usize, _: Ends<S>) -> [S::f32s; 0] {
        []
    }

    #[inline(always)]
    fn misses<S: Simd>(
        simd: S,
        fields: &[Lanes; 4],
        part: usize,
        _: &[S::f32s; 0],
        tile: &TileLanes<S>,
    ) -> S::mask32s {
        let [x, y, z, radius_squared] = fields;
        let x = apart_at_depths::<S>(load(simd, x, part), tile.across, tile.depths);
        let y = apart_at_depths::<S>(load(simd, y, part), tile.down, tile.depths);
        let z = apart::<S>(load(simd, z, part), tile.depths);
        length_squared::<S>(x, y, z).simd_gt(load(simd, radius_squared, part))
    }

    #[inline(always)]
    fn image<N: Number>(fields: &[N; 4]) -> Image<N> {
        let [x, y, z, radius_squared] = *fields;
        Image::of_sphere([x, y, z], radius_squared)
    }
}

/// The unit sphere's reach in m z, enlarged by what the test rounds there: m z, and its difference from the
/// centre. [`SHARE`] covers the part of it that grows with the depth.
pub(super) const UNIT_REACH: f32 = 1.0 + 4.0 * math::UNIT_ROUNDOFF;

const SHARE: f32 = 8.0 * math::UNIT_ROUNDOFF;

/// `range`, a few roundings wider; everything where it is not a range.
#[inline]
fn outward([near, far]: [f32; 2]) -> [f32; 2] {
    let (near, far) = (near - SHARE * near.abs(), far + SHARE * far.abs());
    if near <= far {
        [near, far]
    } else {
        [f32::NEG_INFINITY, f32::INFINITY]
    }
}

/// The same in lanes.
#[inline(always)]
pub(super) fn outward_of<S: Simd>(simd: S, [near, far]: Ends<S>) -> Ends<S> {
    let (near, far) = (near - near.abs() * SHARE, far + far.abs() * SHARE);
    let is_range = near.simd_le(far);
    let [first, last] = lanes::splat(simd, [f32::NEG_INFINITY, f32::INFINITY]);
    [is_range.select(near, first), is_range.select(far, last)]
}
