//! glTF 2.0, as text or binary.

use std::collections::HashSet;
use std::path::Path;

use gltf::{Node, Primitive, buffer, mesh::Mode};
use stochastic_light_culling::glam::{Mat3, Mat4, Vec3};

use super::file::{Contents, NamedMaterial, Part, Reflecting};
use super::gltf_lights as lights;

/// What the file at `path` says, in its default scene. Of textures their factors are taken.
pub fn read(path: &Path) -> Result<Contents, String> {
    let one_line = |error: gltf::Error| error.to_string().replace('\n', " ");
    let file = gltf::Gltf::open(path).map_err(one_line)?;
    let buffers =
        gltf::import_buffers(&file.document, path.parent(), file.blob).map_err(one_line)?;
    let mut reader = Reader {
        buffers: &buffers,
        contents: Contents {
            materials: file.document.materials().map(|m| material(&m)).collect(),
            has_lights: true,
            ..Contents::default()
        },
        visited: HashSet::new(),
    };
    let scene = file.document.default_scene();
    let scene = scene.or_else(|| file.document.scenes().next());
    for node in scene.ok_or("has no scene")?.nodes() {
        reader.visit(&node, Mat4::IDENTITY)?;
    }
    Ok(reader.contents)
}

struct Reader<'a> {
    buffers: &'a [buffer::Data],
    contents: Contents,
    visited: HashSet<usize>,
}

impl Reader<'_> {
    /// The meshes, the lights and the first camera of `node` and of those below it.
    fn visit(&mut self, node: &Node, above: Mat4) -> Result<(), String> {
        if !self.visited.insert(node.index()) {
            return Err(format!("node {} has two parents", node.index()));
        }
        let to_world = above * Mat4::from_cols_array_2d(&node.transform().matrix());
        for primitive in node.mesh().iter().flat_map(gltf::Mesh::primitives) {
            if primitive.mode() == Mode::Triangles {
                let part = self.part(&primitive, to_world)?;
                self.contents.parts.push(part);
            }
        }
        if let Some(light) = node.light() {
            self.contents.lamps.extend(lights::lamp(&light, to_world)?);
        }
        if let (Some(camera), None) = (node.camera(), self.contents.viewpoint) {
            self.contents.viewpoint = lights::viewpoint(&camera, to_world)?;
        }
        node.children()
            .try_for_each(|child| self.visit(&child, to_world))
    }

    fn part(&self, primitive: &Primitive, to_world: Mat4) -> Result<Part, String> {
        let reader = primitive.reader(|buffer| self.buffers.get(buffer.index()).map(|b| &**b));
        let positions = reader.read_positions();
        let positions: Vec<Vec3> = positions
            .ok_or("has a mesh whose positions cannot be read")?
            .map(|position| to_world.transform_point3(position.into()))
            .collect();
        let normal_to_world = Mat3::from_mat4(to_world).inverse().transpose();
        let normals = reader.read_normals().into_iter().flatten();
        let indices = match (primitive.indices(), reader.read_indices()) {
            (None, _) => (0..positions.len() as u32).collect(),
            (Some(_), Some(indices)) => indices.into_u32().collect(),
            (Some(_), None) => return Err("has a mesh whose indices cannot be read".into()),
        };
        Ok(Part {
            normals: normals
                .map(|normal| normal_to_world * Vec3::from(normal))
                .collect(),
            positions,
            indices,
            material: primitive.material().index(),
        })
    }
}

fn material(material: &gltf::Material) -> NamedMaterial {
    let surface = material.pbr_metallic_roughness();
    let [red, green, blue, _] = surface.base_color_factor();
    NamedMaterial {
        name: material.name().unwrap_or_default().to_owned(),
        base: Vec3::new(red, green, blue),
        reflecting: Reflecting::MetallicRoughness {
            metallic: surface.metallic_factor(),
            roughness: surface.roughness_factor(),
        },
        emission: material.emissive_factor().into(),
    }
}
