//! Views of a point that a light reaches, and tiles around it.

use std::f64::consts::TAU;

use fastrand::Rng;
use stochastic_light_culling::{
    Camera, DepthInterval, Error, Orthographic, Perspective, PixelRectangle, Projection,
    TileRectangle,
    glam::{Mat4, Vec2, Vec4},
};
use twofloat::TwoFloat as Real;

use super::{Reach, chance, log_uniform, unit_vector};
use crate::reference::Vector;
use crate::reference::camera::{View, off_centre, orthographic};
use crate::reference::exact::{Exact, outward};

/// A tile with a point in it that a light reaches.
#[derive(Clone, Copy, Debug)]
pub struct Tile<P = Perspective> {
    pub camera: Camera<P>,
    pub rectangle: TileRectangle,
    pub depths: DepthInterval,
}

impl<P: Drawn> Tile<P> {
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
        let view = P::draw_view(rng, start + way, reach.hi() * distance);
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
        let [x, y] = P::coordinates(seen).map(outward);
        let tile = Self {
            camera: P::camera(&view).ok()?,
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

/// A kind of projection whose views can be drawn.
pub trait Drawn: Projection {
    /// A view from `distance` with `point` in it, or nearly.
    fn draw_view(rng: &mut Rng, point: Exact, distance: f64) -> View;

    fn camera(view: &View) -> Result<Camera<Self>, Error>;

    /// The coordinates in a tile's rectangle of a point of camera space.
    fn coordinates(seen: Exact) -> [Real; 2];
}

/// Fields of view to 170°.
impl Drawn for Perspective {
    fn draw_view(rng: &mut Rng, point: Exact, distance: f64) -> View {
        let [horizontal, vertical] = [edges(rng), edges(rng)];
        let left_handed = rng.bool();
        let [across, down] = [horizontal, vertical].map(narrowed);
        let view = View {
            from_world: draw_rotation(rng, left_handed),
            projection: off_centre(left_handed, across, down, [0.0, 1.0]),
            left_handed,
        };
        let [u, v] = [horizontal, vertical].map(|edges| between(rng, edges));
        moved(view, point, [u * distance, v * distance, distance])
    }

    fn camera(view: &View) -> Result<Camera, Error> {
        Camera::new(view.from_world, view.projection)
    }

    fn coordinates(seen: Exact) -> [Real; 2] {
        let [x, y, depth] = seen.0;
        [x / depth, y / depth]
    }
}

/// Of the width of `distance`, about, and as deep as that, shallower or deeper. The near plane is anywhere.
impl Drawn for Orthographic {
    fn draw_view(rng: &mut Rng, point: Exact, distance: f64) -> View {
        let edges = |rng: &mut Rng| edges(rng).map(|edge| edge * distance);
        let [horizontal, vertical] = [edges(rng), edges(rng)];
        let left_handed = rng.bool();
        let depth_per_ndc = distance * log_uniform(rng, 1e-3, 1e3);
        let [a, b] = [1.0 / depth_per_ndc, 5.0 * rng.f64() - 3.0].map(|x| x as f32);
        let [across, down] = [horizontal, vertical].map(narrowed);
        let view = View {
            from_world: draw_rotation(rng, left_handed),
            projection: orthographic(left_handed, across, down, [a, b]),
            left_handed,
        };
        let [x, y] = [horizontal, vertical].map(|edges| between(rng, edges));
        moved(
            view,
            point,
            [x, y, between(rng, [1.0, 3.0]) * depth_per_ndc],
        )
    }

    fn camera(view: &View) -> Result<Camera<Self>, Error> {
        Camera::orthographic(view.from_world, view.projection)
    }

    fn coordinates(seen: Exact) -> [Real; 2] {
        let [x, y, _] = seen.0;
        [x, y]
    }
}

/// The edges of a view at depth 1, in one direction.
fn edges(rng: &mut Rng) -> [f64; 2] {
    let [a, b] = [(); 2].map(|()| log_uniform(rng, 0.05, 11.4));
    match rng.u8(0..4) {
        0 => [-a, b],
        1 => [a, a + b],
        _ => [-a, a],
    }
}

fn narrowed(edges: [f64; 2]) -> [f32; 2] {
    edges.map(|x| x as f32)
}

fn between(rng: &mut Rng, [a, b]: [f64; 2]) -> f64 {
    a + (b - a) * rng.f64()
}

/// Any rotation from world space to view space.
fn draw_rotation(rng: &mut Rng, left_handed: bool) -> Mat4 {
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
    rotation.transpose()
}

/// The view from where `point` is at this place of camera space, to rounding.
fn moved(mut view: View, point: Exact, place: [f64; 3]) -> View {
    let turned = Vector(point.before(&view).0.map(|x| x.hi()));
    let mut offset = Vector(place) - turned;
    if !view.left_handed {
        offset.0[2] = -offset.0[2];
    }
    view.from_world.w_axis = offset.to_f32().extend(1.0);
    view
}
