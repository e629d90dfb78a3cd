//! Where to look from, and where to light from, in a room with walls all around.

use stochastic_light_culling::glam::{Vec2, Vec3};

use super::mesh::Extent;
use super::{Fov, Hit, Lamp, Tracer, Viewpoint};

/// How much of what `view` sees is lit by `lamps` and not in the shade, from 0 to 1.
pub fn lit_share(tracer: &Tracer, lamps: &[Lamp], view: &Viewpoint) -> f32 {
    let seen = sights(tracer, lamps, view);
    let lit = seen.iter().flatten().filter(|sight| sight.is_lit).count();
    lit as f32 / (RAYS[0] * RAYS[1]) as f32
}

/// The view from inside `extent` that sees most of what `lamps` light: things with edges, and metal, from afar.
pub fn viewpoint(tracer: &Tracer, lamps: &[Lamp], extent: &Extent) -> Option<Viewpoint> {
    let reach = extent.radius();
    let views = places(extent)
        .into_iter()
        .filter(|place| {
            let room = Room::around(tracer, *place);
            room.is_closed() && room.clearance > 0.04 * reach
        })
        .filter_map(|eye| view_from(tracer, lamps, eye, reach));
    let worth = |view: &Viewpoint| -> f32 {
        let seen = sights(tracer, lamps, view);
        let worth = (seen.iter().enumerate()).map(|(i, sight)| {
            let Some(sight) = sight.as_ref().filter(|sight| sight.is_lit) else {
                return 0.0;
            };
            let is_row_start = i % RAYS[0] as usize == 0;
            let left = (!is_row_start).then(|| seen[i - 1].as_ref()).flatten();
            let is_edge = left.is_some_and(|left| {
                (left.position - sight.position).dot(sight.normal).abs() > 0.05 * reach
            });
            (sight.distance / reach).min(1.0)
                + 2.0 * f32::from(u8::from(is_edge))
                + f32::from(u8::from(sight.stands_out))
        });
        worth.sum()
    };
    let views = views.map(|view| (worth(&view), view));
    let best = views.max_by(|(a, _), (b, _)| a.total_cmp(b));
    best.filter(|(worth, _)| *worth > 0.0).map(|(_, view)| view)
}

/// Below the ceiling in the middle of the largest room of `extent`.
pub fn lamp(tracer: &Tracer, extent: &Extent) -> Option<Lamp> {
    let rooms = places(extent)
        .into_iter()
        .map(|place| (Room::around(tracer, place), place));
    let rooms = rooms.filter(|(room, _)| room.is_closed());
    let largest = rooms.max_by(|(a, _), (b, _)| a.clearance.total_cmp(&b.clearance));
    let (room, place) = largest?;
    let above = tracer.nearest(place, Vec3::Y);
    let height = above.map_or(room.clearance, |hit| hit.distance);
    Some(Lamp::Point {
        position: place + 0.6 * height * Vec3::Y,
        intensity: Vec3::ONE,
    })
}

/// Whether rays in nearly all directions from `place` meet something.
pub fn is_in_a_room(tracer: &Tracer, place: Vec3) -> bool {
    Room::around(tracer, place).is_closed()
}

/// What is around a place.
struct Room {
    /// The distance to the nearest wall.
    clearance: f32,
    /// The share of directions in which there is a wall.
    walls: f32,
}

impl Room {
    fn around(tracer: &Tracer, place: Vec3) -> Self {
        let mut clearance = f32::INFINITY;
        let mut walls = 0.0;
        for direction in directions() {
            if let Some(hit) = tracer.nearest(place, direction) {
                clearance = clearance.min(hit.distance);
                walls += 1.0 / f32::from(DIRECTIONS);
            }
        }
        Self { clearance, walls }
    }

    fn is_closed(&self) -> bool {
        self.walls > 0.75
    }
}

/// From `eye` to the middle of what is lit around it, not far up or down.
fn view_from(tracer: &Tracer, lamps: &[Lamp], eye: Vec3, reach: f32) -> Option<Viewpoint> {
    let around = directions().filter_map(|direction| {
        let hit = tracer.nearest(eye, direction)?;
        is_lit(tracer, lamps, &hit).then_some(hit.position)
    });
    let (sum, count) = around.fold((Vec3::ZERO, 0.0), |(sum, count), lit| {
        (sum + lit, count + 1.0)
    });
    if count == 0.0 {
        return None;
    }
    let ahead = sum / count - eye;
    let level = ahead.with_y(0.0).length();
    let ahead = ahead.with_y(ahead.y.clamp(-0.35 * level, 0.15 * level));
    let ahead = ahead.try_normalize()?;
    Some(Viewpoint {
        eye,
        target: eye + 0.5 * reach * ahead,
        up: Vec3::Y,
        fov: Fov::Shorter(1.0),
        near: 1e-3 * reach,
    })
}

/// What one ray of a coarse picture sees.
struct Sight {
    position: Vec3,
    normal: Vec3,
    distance: f32,
    is_lit: bool,
    stands_out: bool,
}

const RAYS: [u32; 2] = [24, 16];

/// What the rays of a coarse picture see, row by row.
fn sights(tracer: &Tracer, lamps: &[Lamp], view: &Viewpoint) -> Vec<Option<Sight>> {
    let Ok(camera) = view.camera(RAYS) else {
        return Vec::new();
    };
    let to_world = camera.rotation().transpose();
    let pixels = (0..RAYS[1]).flat_map(|y| (0..RAYS[0]).map(move |x| [x, y]));
    pixels
        .map(|pixel| {
            let ray = to_world * camera.point_in_pixel(RAYS, pixel, 1.0);
            let hit = tracer.nearest(view.eye, ray)?;
            Some(Sight {
                position: hit.position,
                normal: hit.plane_normal,
                distance: hit.position.distance(view.eye),
                is_lit: is_lit(tracer, lamps, &hit),
                stands_out: tracer.material(&hit).stands_out(),
            })
        })
        .collect()
}

fn is_lit(tracer: &Tracer, lamps: &[Lamp], hit: &Hit) -> bool {
    let arriving = lamps.iter().filter_map(|lamp| lamp.arriving(hit.position));
    let mut facing = arriving.filter(|light| light.to_light.dot(hit.normal) > 0.02);
    facing.any(|light| tracer.is_lit(hit, light.to_light, light.distance))
}

/// Places all over `extent`.
fn places(extent: &Extent) -> Vec<Vec3> {
    let along = |cells: u16| move |i: u16| (f32::from(i) + 0.5) / f32::from(cells);
    let (x, y) = (along(7), along(5));
    let cells = (0..7).flat_map(|i| (0..5).flat_map(move |j| (0..7).map(move |k| [i, j, k])));
    cells
        .map(|[i, j, k]| extent.min + Vec3::new(x(i), y(j), x(k)) * (extent.max - extent.min))
        .collect()
}

const DIRECTIONS: u16 = 64;

/// Unit vectors spread evenly over the sphere: a Fibonacci lattice.
fn directions() -> impl Iterator<Item = Vec3> {
    (0..DIRECTIONS).map(|i| {
        let y = 1.0 - (2.0 * f32::from(i) + 1.0) / f32::from(DIRECTIONS);
        let turn = Vec2::from_angle(2.399_963_2 * f32::from(i)) * (1.0 - y * y).sqrt();
        Vec3::new(turn.x, y, turn.y)
    })
}
