//! Views of a point that a light reaches, and tiles around it.

use std::f64::consts::TAU;

use fastrand::Rng;
use stochastic_light_culling::{
    Camera, DepthInterval, PixelRectangle, TileRectangle,
    glam::{Mat4, Vec2, Vec4},
};
use twofloat::TwoFloat as Real;

use super::{Reach, chance, log_uniform, unit_vector};
use crate::reference::Vector;
use crate::reference::camera::{View, off_centre};
use crate::reference::exact::{Exact, outward};

/// A tile with a point in it that a light reaches.
#[derive(Clone, Copy, Debug)]
pub struct Tile {
    pub camera: Camera,
    pub rectangle: TileRectangle,
    pub depths: DepthInterval,
}

impl Tile {
    /// A point that `light` reaches, from a random view, and the thinnest tile that holds it, or one
    /// not much larger.
    ///
    /// `None` if the point drawn lies in a direction that the light does not shine in, or outside the
    /// view.
    pub fn draw(rng: &mut Rng, light: &impl Reach) -> Option<Self> {
        let outgoing = light.outgoing(rng);
        let distance = log_uniform(rng, 1e-3, 1e6);
        // Inside by more than the error of double-double, and by less than anything else here.
        let (tile, view) = Self::thin(rng, light, outgoing, 1e-15, distance)?;
        Some(if rng.bool() {
            tile.widened(rng, view)
        } else {
            tile
        })
    }

    /// The thinnest tile that holds the point in the direction `outgoing`, inside the isosurface by
    /// the share `inside`, seen from `distance` times how far the light reaches there; and all that
    /// the eye sees.
    pub fn thin(
        rng: &mut Rng,
        light: &impl Reach,
        outgoing: Exact,
        inside: f64,
        distance: f64,
    ) -> Option<(Self, TileRectangle)> {
        let reach = light.reach(outgoing);
        if reach.hi() < 1e-30 {
            return None;
        }
        let way = outgoing * (reach * (1.0 - inside));
        let start = Exact::from(light.position());
        let view = draw_view(rng, start + way, reach.hi() * distance);
        let mut seen = (start + way).before(&view);
        let mut depths = outward(seen.0[2]);
        if chance(rng, 0.3) {
            // No thickness at all: the point on the way from the light whose depth is an f32.
            let start_depth = start.before(&view).0[2];
            let whole = seen.0[2] - start_depth;
            let depth = depths[usize::from(whole.hi() < 0.0)];
            let share = (Real::from(f64::from(depth)) - start_depth) / whole;
            if share.hi() > 0.0 && share <= Real::from(1.0) {
                seen = (start + way * share).before(&view);
                depths = [depth; 2];
            }
        }
        if depths[0] <= 0.0 {
            return None;
        }
        let [x, y] = [0, 1].map(|i| outward(seen.0[i] / seen.0[2]));
        let tile = Self {
            camera: Camera::new(view.from_world, view.projection).ok()?,
            rectangle: TileRectangle::new(Vec2::new(x[0], y[0]), Vec2::new(x[1], y[1])).ok()?,
            depths: DepthInterval::new(depths[0], depths[1]).ok()?,
        };
        let all = tile.camera.tile_rectangle(
            [1, 1],
            PixelRectangle {
                min: [0, 0],
                max: [1, 1],
            },
        );
        let rectangle = tile.rectangle;
        let in_view = all.min().cmple(rectangle.min()) & rectangle.max().cmple(all.max());
        in_view.all().then_some((tile, all))
    }

    /// With room on each side, up to the whole view and all depths.
    fn widened(self, rng: &mut Rng, view: TileRectangle) -> Self {
        let mut share = || {
            if rng.bool() {
                log_uniform(rng, 1e-7, 1.0) as f32
            } else {
                0.0
            }
        };
        let (min, max) = (self.rectangle.min(), self.rectangle.max());
        let low = min + Vec2::new(share(), share()) * (view.min() - min);
        let high = max + Vec2::new(share(), share()) * (view.max() - max);
        let near = self.depths.near() * (1.0 - share());
        let far = self.depths.far() * (1.0 + 10.0 * share());
        Self {
            rectangle: TileRectangle::new(low.min(min), high.max(max)).expect("in order"),
            depths: DepthInterval::new(near, far).unwrap_or(self.depths),
            ..self
        }
    }
}

/// A view from `distance` with `point` in it, or nearly, at fields of view to 170°.
fn draw_view(rng: &mut Rng, point: Exact, distance: f64) -> View {
    let edges = |rng: &mut Rng| {
        let [a, b] = [(); 2].map(|()| log_uniform(rng, 0.05, 11.4));
        match rng.u8(0..4) {
            0 => [-a, b],
            1 => [a, a + b],
            _ => [-a, a],
        }
    };
    let left_handed = rng.bool();
    let (horizontal, vertical) = (edges(rng), edges(rng));
    let forward = unit_vector(rng);
    let side = forward.orthogonal();
    let right = side.turned(forward.cross(side), rng.f64() * TAU);
    let z = forward * if left_handed { 1.0 } else { -1.0 };
    let rotation = Mat4::from_cols(
        right.to_f32().extend(0.0),
        forward.cross(right).to_f32().extend(0.0),
        z.to_f32().extend(0.0),
        Vec4::W,
    );
    let narrowed = |edges: [f64; 2]| edges.map(|x| x as f32);
    let mut view = View {
        from_world: rotation.transpose(),
        projection: off_centre(
            left_handed,
            narrowed(horizontal),
            narrowed(vertical),
            [0.0, 1.0],
        ),
        left_handed,
    };
    let [u, v] = [horizontal, vertical].map(|[a, b]| a + (b - a) * rng.f64());
    let wanted = Vector([u * distance, v * distance, distance]);
    let turned = Vector(point.before(&view).0.map(|x| x.hi()));
    let mut offset = wanted - turned;
    if !left_handed {
        offset.0[2] = -offset.0[2];
    }
    view.from_world.w_axis = offset.to_f32().extend(1.0);
    view
}
