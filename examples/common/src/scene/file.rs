//! A scene's geometry from a file of whichever format.

use std::panic;
use std::path::Path;

use stochastic_light_culling::glam::Vec3;

use super::mesh::{Material, Mesh, Triangle};
use super::{gltf, obj, smooth};

/// What a file says, before it is checked.
#[derive(Default)]
pub struct Contents {
    pub parts: Vec<Part>,
    pub materials: Vec<NamedMaterial>,
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
    pub specular: Vec3,
    pub emission: Vec3,
}

/// The mesh in the file at `path`, with the materials named in `glossy` made glossy; without names,
/// those with a specular colour; if the file has no materials at all, everything.
pub fn load(path: &Path, glossy: &[String]) -> Result<Mesh, String> {
    let name = path.display();
    let contents = read(path).map_err(|reason| format!("scene {name}: {reason}"))?;
    mesh(&contents, glossy).map_err(|reason| format!("scene {name}: {reason}"))
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
    let colors = [named.base, named.specular, named.emission];
    if let Some(color) = colors.into_iter().find(|color| !color.is_finite()) {
        return Err(format!("material {} has a colour {color}", named.name));
    }
    let [base, specular] = [named.base, named.specular].map(|c| c.clamp(Vec3::ZERO, Vec3::ONE));
    let has_coat = specular.max_element() > 0.0;
    let is_glossy = if glossy.is_empty() {
        has_coat
    } else {
        glossy.contains(&named.name)
    };
    let reflecting = if is_glossy {
        Material::glossy(base, if has_coat { specular } else { base })
    } else {
        Material::diffuse(base)
    };
    let emissive = named.emission.max_element() > 0.0;
    Ok(Material {
        emissive,
        ..reflecting
    })
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
