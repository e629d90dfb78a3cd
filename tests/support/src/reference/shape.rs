//! Ellipsoids by their centre, axes and semi-axes.

use stochastic_light_culling::{Ellipsoid, Sphere, Spheroid};

use super::Vector;

#[derive(Clone, Copy, Debug)]
pub struct Shape {
    /// Of the centre from `origin`, kept apart so that nothing cancels.
    pub offset: Vector,
    pub origin: Vector,
    pub axes: [Vector; 3],
    pub semi_axes: [f64; 3],
}

impl Shape {
    /// How far out `point`, relative to `light`, lies: below 1 inside, 1 on the surface.
    pub fn level(&self, light: Vector, point: Vector) -> f64 {
        let x = (light - self.origin) + (point - self.offset);
        (0..3)
            .map(|i| (self.axes[i].dot(x) / self.semi_axes[i]).powi(2))
            .sum::<f64>()
            .sqrt()
    }

    /// The point with coordinates `unit` in units of the semi-axes, in the world.
    pub fn point(&self, unit: Vector) -> Vector {
        let axis = |i: usize| self.axes[i] * (self.semi_axes[i] * unit.0[i]);
        self.origin + (self.offset + (axis(0) + (axis(1) + axis(2))))
    }
}

const WORLD_AXES: [Vector; 3] = [
    Vector([1.0, 0.0, 0.0]),
    Vector([0.0, 1.0, 0.0]),
    Vector([0.0, 0.0, 1.0]),
];

impl From<Sphere> for Shape {
    fn from(sphere: Sphere) -> Self {
        Self {
            offset: Vector::ZERO,
            origin: sphere.center().into(),
            axes: WORLD_AXES,
            semi_axes: [f64::from(sphere.radius()); 3],
        }
    }
}

impl From<Spheroid> for Shape {
    /// By the paper's Eqs. 13–15.
    fn from(spheroid: Spheroid) -> Self {
        let (r, alpha) = (
            f64::from(spheroid.radius()),
            f64::from(spheroid.roughness()),
        );
        let axis = Vector::from(*spheroid.axis()).unit();
        let side = axis.orthogonal();
        Self {
            offset: axis * ((1.0 - alpha * alpha) / (2.0 * alpha) * r),
            origin: spheroid.focus().into(),
            axes: [axis, side, axis.cross(side)],
            semi_axes: [(1.0 + alpha * alpha) / (2.0 * alpha) * r, r, r],
        }
    }
}

impl From<Ellipsoid> for Shape {
    /// The columns of the rotation are taken as they are: their lengths go into the semi-axes.
    fn from(ellipsoid: Ellipsoid) -> Self {
        let rotation = ellipsoid.rotation();
        let columns = [rotation.x_axis, rotation.y_axis, rotation.z_axis].map(Vector::from);
        let semi_axes = ellipsoid.semi_axes().to_array().map(f64::from);
        let [origin, offset] = ellipsoid.center_parts().map(Vector::from);
        Self {
            offset,
            origin,
            axes: columns.map(Vector::unit),
            semi_axes: std::array::from_fn(|i| semi_axes[i] * columns[i].length()),
        }
    }
}
