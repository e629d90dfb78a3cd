//! A scene's geometry from a file of whichever format.

use std::panic;
use std::path::Path;

use stochastic_light_culling::{Error, Ggx, Schlick, glam::Vec3};

use super::mesh::{Gloss, Material, Mesh, Triangle};
use super::{Lamp, Viewpoint, gltf, obj, smooth};

/// What a file says, before it is checked.
#[derive(Default)]
pub struct Contents {
    pub parts: Vec<Part>,
    pub materials: Vec<NamedMaterial>,
    pub lamps: Vec<Lamp>,
    pub viewpoint: Option<Viewpoint>,
    /// Whether files of this format can have lights and cameras.
    pub has_lights: bool,
}

/// Triangles of one material: three places in `positions` and `normals` for each. No normals, or as
/// many as positions.
pub struct Part {
    pub positions: Vec<Vec3>,
    pub normals: Vec<Vec3>,
    pub indices: Vec<u32>,
    pub material: Option<usize>,
}

pub struct NamedMaterial {
    pub name: String,
    pub base: Vec3,
    pub reflecting: Reflecting,
    pub emission: Vec3,
}

/// How a file says what reflects.
#[derive(Clone, Copy)]
pub enum Reflecting {
    /// By a colour; black if it is diffuse alone.
    Colours { specular: Vec3 },
    /// By a share of metal and a roughness, whose square is α.
    MetallicRoughness { metallic: f32, roughness: f32 },
}

/// What a file says.
pub struct Loaded {
    pub mesh: Mesh,
    pub lamps: Vec<Lamp>,
    pub viewpoint: Option<Viewpoint>,
    /// Whether files of this format can have lights and cameras.
    pub has_lights: bool,
}

/// What the file at `path` says, with the materials named in `glossy` made glossy; without names,
/// those that the file says are; if the file has no materials at all, everything.
pub fn load(path: &Path, glossy: &[String]) -> Result<Loaded, String> {
    let loaded = || {
        let contents = read(path)?;
        Ok(Loaded {
            mesh: mesh(&contents, glossy)?,
            lamps: contents.lamps,
            viewpoint: contents.viewpoint,
            has_lights: contents.has_lights,
        })
    };
    loaded().map_err(|reason: String| format!("scene {}: {reason}", path.display()))
}

fn read(path: &Path) -> Result<Contents, String> {
    let extension = path.extension().unwrap_or_default().to_ascii_lowercase();
    let read = match extension.to_str() {
        Some("obj") => obj::read,
        Some("glb" | "gltf") => gltf::read,
        _ => return Err("is not ring, cornell, or a file called .obj, .glb or .gltf".into()),
    };
    std::fs::File::open(path).map_err(|error| error.to_string())?;
    // The readers index without checks in places, where a broken file makes them panic.
    let report = panic::take_hook();
    panic::set_hook(Box::new(|_| ()));
    let contents = panic::catch_unwind(|| read(path));
    panic::set_hook(report);
    contents.unwrap_or_else(|_| Err("is broken: it contradicts itself".into()))
}

fn mesh(contents: &Contents, glossy: &[String]) -> Result<Mesh, String> {
    let mut mesh = Mesh {
        triangles: Vec::new(),
        materials: materials(&contents.materials, glossy)?,
    };
    let metal = Material::metal(Vec3::new(0.95, 0.79, 0.6));
    let unnamed = mesh.add_material(if contents.materials.is_empty() {
        metal
    } else {
        Material::diffuse(Vec3::splat(0.6))
    });
    for part in &contents.parts {
        let material = part.material.unwrap_or(unnamed);
        mesh.triangles.extend(triangles(part, material)?);
    }
    if mesh.triangles.is_empty() {
        return Err("has no triangles with an area".into());
    }
    Ok(mesh)
}

fn materials(named: &[NamedMaterial], glossy: &[String]) -> Result<Vec<Material>, String> {
    if let Some(missing) = glossy
        .iter()
        .find(|name| named.iter().all(|material| material.name != **name))
    {
        let names: Vec<&str> = named.iter().map(|material| &*material.name).collect();
        return Err(format!(
            "has no material {missing}, only [{}]",
            names.join(", ")
        ));
    }
    named.iter().map(|named| material(named, glossy)).collect()
}

fn material(named: &NamedMaterial, glossy: &[String]) -> Result<Material, String> {
    let reflecting = match named.reflecting {
        Reflecting::Colours { specular } => specular,
        Reflecting::MetallicRoughness {
            metallic,
            roughness,
        } => Vec3::new(metallic, roughness, 0.0),
    };
    let colors = [named.base, reflecting, named.emission];
    if let Some(color) = colors.into_iter().find(|color| !color.is_finite()) {
        return Err(format!("material {} has a colour {color}", named.name));
    }
    let base = named.base.clamp(Vec3::ZERO, Vec3::ONE);
    let is_named = || glossy.contains(&named.name);
    let reflecting = match named.reflecting {
        Reflecting::Colours { specular } => {
            let specular = specular.clamp(Vec3::ZERO, Vec3::ONE);
            let has_coat = specular.max_element() > 0.0;
            let is_glossy = if glossy.is_empty() {
                has_coat
            } else {
                is_named()
            };
            is_glossy.then(|| Material::glossy(base, if has_coat { specular } else { base }))
        }
        Reflecting::MetallicRoughness {
            metallic,
            roughness,
        } if glossy.is_empty() || is_named() => {
            Some(metallic_roughness(base, metallic, roughness)?)
        }
        Reflecting::MetallicRoughness { .. } => None,
    };
    let mut material = reflecting.unwrap_or_else(|| Material::diffuse(base));
    material.emission = named.emission.max(Vec3::ZERO);
    Ok(material)
}

/// The material of these parameters of glTF 2.0, which says what α and the reflectance are.
fn metallic_roughness(base: Vec3, metallic: f32, roughness: f32) -> Result<Material, String> {
    /// Of all that does not conduct.
    const DIELECTRIC: Vec3 = Vec3::splat(0.04);
    /// The least α: the lobe of a perfect mirror is no number.
    const MIRROR: f32 = 0.01;
    /// That of lights, with some ten thousand of them in a room.
    const SMOOTHEST_LIGHT: f32 = 0.1;
    let said = |error: Error| error.to_string();
    let metallic = metallic.clamp(0.0, 1.0);
    let f0 = DIELECTRIC.lerp(base, metallic);
    let brightest = f0.max_element();
    let ggx = |least: f32| Ggx::new((roughness * roughness).clamp(least, 1.0)).map_err(said);
    let gloss = Gloss {
        light_ggx: ggx(SMOOTHEST_LIGHT)?,
        ..Gloss::new(ggx(MIRROR)?, Schlick::new(brightest).map_err(said)?)
    };
    let tint = f0 / brightest.max(f32::MIN_POSITIVE);
    let mut material = Material::coated(base, tint, 1.0 - metallic);
    material.gloss = Some(gloss);
    Ok(material)
}

/// The triangles of `part` but for those without an area.
fn triangles(part: &Part, material: usize) -> Result<Vec<Triangle>, String> {
    // Beyond, products of four coordinates leave the range of f32.
    const FARTHEST: f32 = 1e9;
    let usable = |position: &Vec3| position.abs().cmple(Vec3::splat(FARTHEST)).all();
    if let Some(position) = part.positions.iter().find(|position| !usable(position)) {
        return Err(format!(
            "has a vertex at {position}, but must be finite and within 10⁹"
        ));
    }
    let count = part.positions.len();
    if let Some(index) = part.indices.iter().find(|index| **index as usize >= count) {
        return Err(format!("has a face with vertex {index} of {count}"));
    }
    let mut triangles: Vec<([u32; 3], Triangle)> = part
        .indices
        .chunks_exact(3)
        .filter_map(|corners| {
            let indices = [corners[0], corners[1], corners[2]];
            let positions = indices.map(|i| part.positions[i as usize]);
            Some((indices, Triangle::flat(positions, material)?))
        })
        .collect();
    if part.normals.len() == count {
        for (indices, triangle) in &mut triangles {
            let plane = triangle.normals;
            let given = indices.map(|i| part.normals[i as usize].try_normalize());
            triangle.normals = [0, 1, 2].map(|i| given[i].unwrap_or(plane[i]));
        }
    } else {
        smooth::smooth(&mut triangles, count);
    }
    Ok(triangles
        .into_iter()
        .map(|(_, triangle)| triangle)
        .collect())
}
