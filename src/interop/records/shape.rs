//! Bounds and projected shapes in the memory layout of shaders.

use bytemuck::{Pod, Zeroable};

use crate::bound::Ellipsoid;
use crate::project::{ProjectedEllipsoid, ProjectedSphere};

/// A [`ProjectedEllipsoid`] and the index of its light, for a storage buffer.
///
/// 48 bytes, with the offsets of this structure in WGSL, which are those of GLSL's std430:
///
/// ```wgsl
/// struct Ellipsoid {
///     x_and_y_axes: vec4<f32>, // offset  0: M₁₁, M₂₁, M₁₂, M₂₂
///     z_axis: vec3<f32>,       // offset 16: M₁₃, M₂₃, m
///     light: u32,              // offset 28
///     center: vec3<f32>,       // offset 32: Mc′
///     unused: u32,             // offset 44
/// }
/// ```
///
/// The elements of M that are not listed are zero. The record holds all that the box test of the paper needs:
/// products, sums, minima and maxima. That test touches whatever [`touches`](crate::ProjectedEllipsoid::touches)
/// does, and other tiles too. With its depths cut to those of the ellipsoid, (Mc′_z ± 1)/m widened by some
/// roundings, it touches fewer.
///
/// A shader that does the same operations may decide differently where a tile and a light just touch or just
/// miss, since shading languages allow compilers to contract and reorder operations and to flush subnormal
/// numbers. The ellipsoid was enlarged for one rounding of each operation. Contraction leaves out some of
/// them and loses no light. There is no such guarantee for operations that are reordered or not correctly
/// rounded.
///
/// ```
/// use stochastic_light_culling::{Camera, Ellipsoid, GpuEllipsoid, glam::{Mat3, Vec3}};
///
/// let camera = Camera::look_at(Vec3::ZERO, -Vec3::Z, Vec3::Y, 1.0, 1.0, 0.1..100.0)?;
/// let ellipsoid = Ellipsoid::new(Vec3::new(0.0, 0.0, -8.0), Mat3::IDENTITY, Vec3::ONE)?;
/// let projected = ellipsoid.project(&camera).expect("not empty");
/// let records = [GpuEllipsoid::new(&projected, 7)];
/// let bytes: &[u8] = bytemuck::cast_slice(&records);
/// assert_eq!(bytes[28..32], 7_u32.to_ne_bytes());
/// let GpuEllipsoid { x_and_y_axes, z_axis, center, unused, .. } = records[0];
/// assert_eq!(center, [0.0, 0.0, 8.0 * z_axis[2]]);
/// assert_eq!((x_and_y_axes[1], unused), (0.0, 0));
/// # Ok::<(), stochastic_light_culling::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct GpuEllipsoid {
    /// M₁₁, M₂₁, M₁₂, M₂₂: the images of the x and y axes of camera space, whose third components are 0.
    pub x_and_y_axes: [f32; 4],
    /// M₁₃, M₂₃, m: the image of the depth axis.
    pub z_axis: [f32; 3],
    /// The index of the light.
    pub light: u32,
    /// Mc′, the centre of the unit sphere.
    pub center: [f32; 3],
    /// Zero. Free for other uses.
    pub unused: u32,
}

impl GpuEllipsoid {
    /// Creates the record of `ellipsoid`, the bound of the light with index `light`.
    #[must_use]
    pub fn new<P>(ellipsoid: &ProjectedEllipsoid<P>, light: u32) -> Self {
        let m = ellipsoid.matrix();
        Self {
            x_and_y_axes: [m.x_axis.x, m.x_axis.y, m.y_axis.x, m.y_axis.y],
            z_axis: m.z_axis.to_array(),
            light,
            center: ellipsoid.center().to_array(),
            unused: 0,
        }
    }
}

/// A [`ProjectedSphere`] for a storage or uniform buffer: 16 bytes, a `vec4<f32>`.
///
/// The index of its light is not part of it, and can be its position in the buffer.
///
/// ```
/// use stochastic_light_culling::{Camera, GpuSphere, Sphere, glam::Vec3};
///
/// let camera = Camera::look_at(Vec3::ZERO, -Vec3::Z, Vec3::Y, 1.0, 1.0, 0.1..100.0)?;
/// let sphere = Sphere::new(Vec3::new(0.0, 0.0, -8.0), 1.0)?;
/// let record = sphere.project(&camera).map(|sphere| GpuSphere::from(&sphere));
/// let record = record.expect("not empty");
/// assert_eq!(record.center, [0.0, 0.0, 8.0]);
/// assert_eq!(bytemuck::bytes_of(&record)[12..], record.radius_squared.to_ne_bytes());
/// # Ok::<(), stochastic_light_culling::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct GpuSphere {
    /// The centre in camera space; offset 0.
    pub center: [f32; 3],
    /// The square of the radius, infinite for a sphere that fills space; offset 12.
    pub radius_squared: f32,
}

impl<P> From<&ProjectedSphere<P>> for GpuSphere {
    fn from(sphere: &ProjectedSphere<P>) -> Self {
        Self {
            center: sphere.center().to_array(),
            radius_squared: sphere.radius_squared(),
        }
    }
}

/// An [`Ellipsoid`] in world space, for shaders that project it: `SlcBound`, 96 bytes.
///
/// For lobes that have no shader, bounded on the CPU: `slc_project` takes it to camera space.
///
/// ```
/// use stochastic_light_culling::{Ellipsoid, GpuBound, glam::{Mat3, Vec3}};
///
/// let ellipsoid = Ellipsoid::new(Vec3::X, Mat3::IDENTITY, Vec3::new(1.0, 2.0, 4.0))?;
/// let record = GpuBound::from(&ellipsoid);
/// assert_eq!((record.light, record.semi_axes), ([1.0, 0.0, 0.0], [1.0, 2.0, 4.0]));
/// # Ok::<(), stochastic_light_culling::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct GpuBound {
    /// The position of the light; offset 0.
    pub light: [f32; 3],
    /// Zero.
    pub padding: f32,
    /// From the light to the centre; offset 16.
    pub offset: [f32; 3],
    /// Zero.
    pub padding_of_offset: f32,
    /// The directions of the axes, unit vectors, each with a zero after it: a `mat3x3f`; offset 32.
    pub axes: [[f32; 4]; 3],
    /// The semi-axes, at most 10³⁰, which stands for all of space; zeros if there is nothing; offset 80.
    pub semi_axes: [f32; 3],
    /// Zero.
    pub padding_of_semi_axes: f32,
}

impl From<&Ellipsoid> for GpuBound {
    fn from(ellipsoid: &Ellipsoid) -> Self {
        // Shaders take it for everything, and may have no infinity.
        const LARGEST: f32 = 1e30;
        let [light, offset] = ellipsoid.center_parts().map(|part| part.to_array());
        let semi_axes = ellipsoid.semi_axes().to_array();
        let axes = ellipsoid.rotation().to_cols_array_2d();
        Self {
            light,
            padding: 0.0,
            offset,
            padding_of_offset: 0.0,
            axes: axes.map(|[x, y, z]| [x, y, z, 0.0]),
            semi_axes: semi_axes.map(|length| length.min(LARGEST)),
            padding_of_semi_axes: 0.0,
        }
    }
}

/// A shape that a shader has projected to camera space: `SlcProjected`, 64 bytes.
///
/// What the kernels of bounds write and those of culling read, in the order of the lights. To read it back, or to size
/// a buffer. A shape that reaches nothing has a `near` greater than its `far`.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct GpuProjected {
    /// M₁₁, M₂₁, M₁₂, M₂₂; offset 0.
    pub x_and_y_axes: [f32; 4],
    /// M₁₃, M₂₃, m; offset 16.
    pub z_axis: [f32; 3],
    /// The least depth; offset 28.
    pub near: f32,
    /// Mc′, the centre of the unit sphere; offset 32.
    pub center: [f32; 3],
    /// The greatest depth; offset 44.
    pub far: f32,
    /// The least and the greatest x/z, and the same of y/z; offset 48.
    pub slopes: [f32; 4],
}
