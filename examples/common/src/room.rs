//! A room as a glTF file: two lamps, a floor that shines, a ball like a mirror, and some things to see in it.

use gltf::binary::{Glb, Header};
use parry3d::shape::{Ball, Cuboid};
use serde_json::{Value, json};
use stochastic_light_culling::glam::{Quat, Vec3};

/// What the file is to have besides meshes.
#[derive(Clone, Copy, Debug)]
pub struct Room {
    pub has_camera: bool,
    pub has_lights: bool,
}

/// Width, height and depth in metres; the floor is at y = 0, its middle at the origin.
const SIZE: Vec3 = Vec3::new(6.0, 3.0, 5.0);
/// The two lamps.
const BULB: Vec3 = Vec3::new(-1.3, 2.15, -0.4);
const SPOT: Vec3 = Vec3::new(2.5, 2.75, 1.2);

/// Shapes that all meshes are made of: places in the list of accessors.
#[derive(Clone, Copy)]
enum Shape {
    Ball = 0,
    Cube = 3,
    Square = 5,
}

impl Room {
    /// The bytes of the file.
    pub fn glb(self) -> Result<Vec<u8>, String> {
        let mut file = File::default();
        file.add_shapes();
        self.add_nodes(&mut file);
        file.glb()
    }

    fn add_nodes(self, file: &mut File) {
        let paint = |file: &mut File, name: &str, color: [f32; 3]| {
            file.add_material(name, color, 0.0, 0.9, [0.0; 3])
        };
        let white = paint(file, "white", [0.72, 0.70, 0.66]);
        let blue = paint(file, "blue", [0.15, 0.32, 0.48]);
        let red = paint(file, "red", [0.62, 0.16, 0.10]);
        let floor = file.add_material("varnish", [0.36, 0.19, 0.09], 0.0, 0.3, [0.0; 3]);
        let mirror = file.add_material("mirror", [0.95, 0.95, 0.96], 1.0, 0.12, [0.0; 3]);
        let copper = file.add_material("copper", [0.95, 0.60, 0.46], 1.0, 0.4, [0.0; 3]);
        let glaze = file.add_material("glaze", [0.75, 0.55, 0.10], 0.0, 0.25, [0.0; 3]);
        let warm = file.add_material("warm lamp", [0.8; 3], 0.0, 1.0, [1.0, 0.75, 0.45]);
        let cold = file.add_material("cold lamp", [0.8; 3], 0.0, 1.0, [0.7, 0.85, 1.0]);

        // Squares face up, and are turned to face the inside.
        let half = 0.5 * SIZE;
        let about_x = Quat::from_rotation_x;
        let about_z = Quat::from_rotation_z;
        let right_angle = std::f32::consts::FRAC_PI_2;
        let walls = [
            (floor, Vec3::ZERO, Quat::IDENTITY, [SIZE.x, SIZE.z]),
            (
                white,
                SIZE.y * Vec3::Y,
                about_x(2.0 * right_angle),
                [SIZE.x, SIZE.z],
            ),
            (
                white,
                Vec3::new(0.0, half.y, -half.z),
                about_x(right_angle),
                [SIZE.x, SIZE.y],
            ),
            (
                white,
                Vec3::new(0.0, half.y, half.z),
                about_x(-right_angle),
                [SIZE.x, SIZE.y],
            ),
            (
                blue,
                Vec3::new(-half.x, half.y, 0.0),
                about_z(-right_angle),
                [SIZE.y, SIZE.z],
            ),
            (
                red,
                Vec3::new(half.x, half.y, 0.0),
                about_z(right_angle),
                [SIZE.y, SIZE.z],
            ),
        ];
        for (material, place, turn, [width, depth]) in walls {
            let size = Vec3::new(width, 1.0, depth);
            file.add_thing(Shape::Square, material, place, turn, size);
        }
        let upright = Quat::from_rotation_y;
        let things = [
            (Shape::Ball, mirror, [0.75, 0.7, -0.9], 0.0, [0.7; 3]),
            (Shape::Cube, copper, [-1.2, 0.6, -1.3], 0.5, [0.8, 1.2, 0.8]),
            (Shape::Ball, glaze, [-0.35, 0.3, 0.25], 0.0, [0.3; 3]),
            (Shape::Cube, white, [2.1, 0.25, -0.3], -0.4, [0.9, 0.5, 0.9]),
            (Shape::Ball, warm, BULB.to_array(), 0.0, [0.12; 3]),
            (
                Shape::Cube,
                cold,
                (SPOT + 0.06 * Vec3::Y).to_array(),
                0.0,
                [0.24, 0.04, 0.24],
            ),
        ];
        for (shape, material, place, turn, size) in things {
            file.add_thing(shape, material, place.into(), upright(turn), size.into());
        }

        if self.has_lights {
            file.add_light(
                BULB,
                Vec3::NEG_Y,
                &json!({
                    "type": "point", "color": [1.0, 0.75, 0.45], "intensity": 60.0,
                }),
            );
            file.add_light(
                SPOT,
                Vec3::new(0.4, 0.3, -0.8) - SPOT,
                &json!({
                    "type": "spot", "color": [0.7, 0.85, 1.0], "intensity": 300.0,
                    "spot": {"innerConeAngle": 0.35, "outerConeAngle": 0.6},
                }),
            );
        }
        if self.has_camera {
            file.add_camera(Vec3::new(-0.5, 1.45, 2.35), Vec3::new(0.1, 0.95, -1.0), 1.0);
        }
    }
}

/// A file as it grows.
#[derive(Default)]
struct File {
    bytes: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
    materials: Vec<Value>,
    meshes: Vec<Value>,
    lights: Vec<Value>,
    cameras: Vec<Value>,
    nodes: Vec<Value>,
}

impl File {
    fn glb(self) -> Result<Vec<u8>, String> {
        let indices: Vec<usize> = (0..self.nodes.len()).collect();
        let mut document = json!({
            "asset": {"version": "2.0", "generator": env!("CARGO_PKG_NAME")},
            "scene": 0,
            "scenes": [{"nodes": indices}],
            "nodes": self.nodes,
            "meshes": self.meshes,
            "materials": self.materials,
            "accessors": self.accessors,
            "bufferViews": self.views,
            "buffers": [{"byteLength": self.bytes.len()}],
        });
        if !self.cameras.is_empty() {
            document["cameras"] = self.cameras.into();
        }
        if !self.lights.is_empty() {
            document["extensionsUsed"] = json!(["KHR_lights_punctual"]);
            document["extensions"] = json!({"KHR_lights_punctual": {"lights": self.lights}});
        }
        let glb = Glb {
            header: Header {
                magic: *b"glTF",
                version: 2,
                length: 0, // set when it is written
            },
            json: document.to_string().into_bytes().into(),
            bin: Some(self.bytes.into()),
        };
        glb.to_vec().map_err(|error| error.to_string())
    }

    /// Balls have normals; of what is flat, readers make them.
    fn add_shapes(&mut self) {
        let (points, triangles) = Ball::new(1.0).to_trimesh(40, 20);
        let points: Vec<[f32; 3]> = points.into_iter().map(Into::into).collect();
        self.add_vectors(&points);
        self.add_vectors(&points);
        self.add_indices(&triangles);
        let half = Vec3::splat(0.5).to_array().into();
        let (points, triangles) = Cuboid::new(half).to_trimesh();
        let points: Vec<[f32; 3]> = points.into_iter().map(Into::into).collect();
        self.add_vectors(&points);
        self.add_indices(&triangles);
        self.add_vectors(&[
            [-0.5, 0.0, -0.5],
            [-0.5, 0.0, 0.5],
            [0.5, 0.0, 0.5],
            [0.5, 0.0, -0.5],
        ]);
        self.add_indices(&[[0, 1, 2], [0, 2, 3]]);
    }

    fn add_vectors(&mut self, vectors: &[[f32; 3]]) {
        let end = |start: f32, pick: fn(f32, f32) -> f32| {
            let fold = |end: [f32; 3], v: &[f32; 3]| [0, 1, 2].map(|i| pick(end[i], v[i]));
            vectors.iter().fold([start; 3], fold)
        };
        let ends = [
            end(f32::INFINITY, f32::min),
            end(f32::NEG_INFINITY, f32::max),
        ];
        let bytes = vectors.as_flattened().iter().flat_map(|x| x.to_le_bytes());
        let view = self.add_view(bytes.collect());
        self.accessors.push(json!({
            "bufferView": view, "componentType": 5126, "type": "VEC3",
            "count": vectors.len(), "min": ends[0], "max": ends[1],
        }));
    }

    fn add_indices(&mut self, triangles: &[[u32; 3]]) {
        let indices = triangles.as_flattened().iter();
        let bytes = indices
            .clone()
            .flat_map(|index| (*index as u16).to_le_bytes());
        let view = self.add_view(bytes.collect());
        self.accessors.push(json!({
            "bufferView": view, "componentType": 5123, "type": "SCALAR", "count": indices.len(),
        }));
    }

    fn add_view(&mut self, bytes: Vec<u8>) -> usize {
        self.views.push(json!({
            "buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len(),
        }));
        self.bytes.extend(bytes);
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        self.views.len() - 1
    }

    fn add_material(
        &mut self,
        name: &str,
        color: [f32; 3],
        metallic: f64,
        roughness: f64,
        emission: [f32; 3],
    ) -> usize {
        let [red, green, blue] = color;
        self.materials.push(json!({
            "name": name,
            "pbrMetallicRoughness": {
                "baseColorFactor": decimal([red, green, blue, 1.0]),
                "metallicFactor": metallic,
                "roughnessFactor": roughness,
            },
            "emissiveFactor": decimal(emission),
        }));
        self.materials.len() - 1
    }

    fn add_thing(&mut self, shape: Shape, material: usize, place: Vec3, turn: Quat, size: Vec3) {
        let first = shape as usize;
        let (attributes, indices) = match shape {
            Shape::Ball => (json!({"POSITION": first, "NORMAL": first + 1}), first + 2),
            Shape::Cube | Shape::Square => (json!({"POSITION": first}), first + 1),
        };
        let primitive = json!({"attributes": attributes, "indices": indices, "material": material});
        self.meshes.push(json!({"primitives": [primitive]}));
        self.nodes.push(json!({
            "mesh": self.meshes.len() - 1,
            "translation": decimal(place.to_array()),
            "rotation": decimal(turn.to_array()),
            "scale": decimal(size.to_array()),
        }));
    }

    /// Lights and cameras look along −z.
    fn add_light(&mut self, place: Vec3, direction: Vec3, light: &Value) {
        let turn = Quat::from_rotation_arc(Vec3::NEG_Z, direction.normalize());
        self.nodes.push(json!({
            "translation": decimal(place.to_array()),
            "rotation": decimal(turn.to_array()),
            "extensions": {"KHR_lights_punctual": {"light": self.lights.len()}},
        }));
        self.lights.push(light.clone());
    }

    fn add_camera(&mut self, eye: Vec3, target: Vec3, yfov: f64) {
        let away = (eye - target).normalize();
        let level = away.with_y(0.0).normalize();
        let turn = Quat::from_rotation_arc(level, away) * Quat::from_rotation_arc(Vec3::Z, level);
        self.nodes.push(json!({
            "translation": decimal(eye.to_array()),
            "rotation": decimal(turn.to_array()),
            "camera": self.cameras.len(),
        }));
        self.cameras.push(json!({
            "type": "perspective", "perspective": {"yfov": yfov, "znear": 0.05},
        }));
    }
}

/// The shortest decimal numbers that mean these `f32`.
fn decimal<const N: usize>(numbers: [f32; N]) -> Vec<f64> {
    let shortest = |x: f32| x.to_string().parse().unwrap_or(f64::from(x));
    numbers.map(shortest).into()
}
