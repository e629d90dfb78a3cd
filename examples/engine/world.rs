//! What the engine has besides its light culling: a scene, a camera and a depth buffer.

// glam before 0.33 has these matrices as `Mat4::look_at_rh`, `Mat4::perspective_infinite_reverse_rh` and
// so on.
use stochastic_light_culling::{
    Camera, Direction, Error, Ggx, GgxLobe, Incidence, Schlick, Seed, Vpl,
    glam::{
        Vec3,
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
    depth_buffer: Vec<f32>,
}

const NEAR: f32 = 0.1;

impl World {
    pub fn new(size: [u32; 2], handedness: Handedness) -> Self {
        let depth_buffer = vec![0.0; (size[0] * size[1]) as usize];
        Self {
            size,
            handedness,
            depth_buffer,
        }
    }

    /// The engine's own matrices, with z reversed and no far plane, as they come.
    pub fn camera(&self, frame: u32) -> Result<Camera, Error> {
        let aspect = self.size[0] as f32 / self.size[1] as f32;
        let eye = Vec3::new(0.05 * frame as f32, 3.0, 14.0);
        let target = Vec3::new(0.0, 0.5, 0.0);
        let (view, projection) = match self.handedness {
            Handedness::Right => (
                rh::view::look_at_mat4(eye, target, Vec3::Y),
                rh::proj::directx::perspective_infinite_reverse(1.0, aspect, NEAR),
            ),
            Handedness::Left => (
                lh::view::look_at_mat4(eye, target, Vec3::Y),
                lh::proj::directx::perspective_infinite_reverse(1.0, aspect, NEAR),
            ),
        };
        Camera::new(view, projection)
    }

    /// Draws a wall and a floor, as a GPU does: near/z, and 0 for the sky.
    pub fn draw_depths(&mut self, camera: &Camera) -> &[f32] {
        let eye = camera.to_world_space(Vec3::ZERO);
        let [width, height] = self.size;
        let pixels = (0..height).flat_map(|y| (0..width).map(move |x| [x, y]));
        for (pixel, ndc_depth) in pixels.zip(&mut self.depth_buffer) {
            let at_one = camera.point_in_pixel(self.size, pixel, 1.0);
            let ray = camera.to_world_space(at_one) - eye;
            let to_floor = -eye.y / ray.y;
            let to_wall = (-10.0 - eye.z) / ray.z;
            let on_wall = (0.0..4.0).contains(&(eye.y + to_wall * ray.y));
            let depth = match (to_floor > 0.0 && to_floor < to_wall, on_wall) {
                (true, _) => to_floor,
                (false, true) => to_wall,
                (false, false) => f32::INFINITY,
            };
            *ndc_depth = NEAR / depth;
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
