//! What the engine has besides its light culling: a scene, a camera and a depth buffer.

// glam before 0.33 has these matrices as `Mat4::look_at_rh`, `Mat4::perspective_infinite_reverse_rh` and
// so on.
use stochastic_light_culling::{
    Direction, Error, Ggx, GgxLobe, Incidence, Schlick, Seed, Vpl,
    glam::{
        Mat4, Vec3,
        camera::{lh, rh},
    },
};

/// Whether view space looks along −z or along +z.
#[derive(Clone, Copy, Debug)]
pub enum Handedness {
    Right,
    Left,
}

/// A gold floor between walls that are left out, and its picture.
pub struct World {
    pub size: [u32; 2],
    handedness: Handedness,
    is_orthographic: bool,
    depth_buffer: Vec<f32>,
}

const NEAR: f32 = 0.1;
/// With parallel rays.
const FAR: f32 = 100.0;

impl World {
    pub fn new(size: [u32; 2], handedness: Handedness, is_orthographic: bool) -> Self {
        let depth_buffer = vec![0.0; (size[0] * size[1]) as usize];
        Self {
            size,
            handedness,
            is_orthographic,
            depth_buffer,
        }
    }

    /// The engine's own matrices for view and projection, as they come: with z reversed, and in perspective without a
    /// far plane.
    pub fn matrices(&self, frame: u32) -> (Mat4, Mat4) {
        let aspect = self.size[0] as f32 / self.size[1] as f32;
        let eye = Vec3::new(0.05 * frame as f32, 3.0, 14.0);
        let target = Vec3::new(0.0, 0.5, 0.0);
        // Half the height of a view with parallel rays, and half its width.
        let (y, x) = (8.0, 8.0 * aspect);
        match (self.handedness, self.is_orthographic) {
            (Handedness::Right, false) => (
                rh::view::look_at_mat4(eye, target, Vec3::Y),
                rh::proj::directx::perspective_infinite_reverse(1.0, aspect, NEAR),
            ),
            (Handedness::Left, false) => (
                lh::view::look_at_mat4(eye, target, Vec3::Y),
                lh::proj::directx::perspective_infinite_reverse(1.0, aspect, NEAR),
            ),
            // Planes that are exchanged reverse z.
            (Handedness::Right, true) => (
                rh::view::look_at_mat4(eye, target, Vec3::Y),
                rh::proj::directx::orthographic(-x, x, -y, y, FAR, NEAR),
            ),
            (Handedness::Left, true) => (
                lh::view::look_at_mat4(eye, target, Vec3::Y),
                lh::proj::directx::orthographic(-x, x, -y, y, FAR, NEAR),
            ),
        }
    }

    /// Draws a wall and a floor, as a GPU does. 0 for the sky.
    pub fn draw_depths(&mut self, frame: u32) -> &[f32] {
        let (view, projection) = self.matrices(frame);
        let to_clip = projection * view;
        let from_clip = to_clip.inverse();
        let [width, height] = self.size;
        let pixels = (0..height).flat_map(|y| (0..width).map(move |x| [x, y]));
        for ([x, y], value) in pixels.zip(&mut self.depth_buffer) {
            let x = (2 * x + 1) as f32 / width as f32 - 1.0;
            let y = 1.0 - (2 * y + 1) as f32 / height as f32;
            // The ray from the near plane to one far behind it.
            let [start, end] = [1.0, 0.01].map(|z| from_clip.project_point3(Vec3::new(x, y, z)));
            let ray = end - start;
            let [to_floor, to_wall] = [-start.y / ray.y, (-10.0 - start.z) / ray.z];
            let on_wall = (0.0..4.0).contains(&(start.y + to_wall * ray.y));
            let share = match (to_floor > 0.0 && to_floor < to_wall, on_wall) {
                (true, _) => to_floor,
                (false, true) => to_wall,
                (false, false) => {
                    *value = 0.0;
                    continue;
                }
            };
            let clip = to_clip * (start + share * ray).extend(1.0);
            *value = (clip.z / clip.w).max(0.0);
        }
        &self.depth_buffer
    }
}

/// Points of the floor that a lamp shines on, each of which reflects a share of its 1000 W.
pub fn lights(count: u32, alpha: f32) -> Result<Vec<Vpl<GgxLobe<Schlick>>>, Error> {
    let (ggx, gold) = (Ggx::new(alpha)?, Schlick::new(0.9)?);
    let lamp = Vec3::new(0.0, 6.0, -4.0);
    let light = |i| {
        let random = |frame| Seed(99).frame(frame).hashed_xi(i).get();
        let [x, z] = [1, 2].map(|frame| random(frame) - 0.5);
        let position = Vec3::new(20.0 * x, 0.0, 20.0 * z);
        let incidence = Incidence {
            normal: Direction::Y,
            incoming: Direction::new(lamp - position)?,
        };
        let lobe = GgxLobe::new(ggx, gold, incidence);
        Vpl::new(position, 1000.0 / count as f32, lobe)
    };
    (0..count).map(light).collect()
}
