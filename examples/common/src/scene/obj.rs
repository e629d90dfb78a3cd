//! Wavefront OBJ.

use std::path::Path;

use stochastic_light_culling::glam::Vec3;

use super::file::{Contents, NamedMaterial, Part, Reflecting};

/// What the file at `path` says. Materials that cannot be read count as none.
pub fn read(path: &Path) -> Result<Contents, String> {
    let options = tobj::LoadOptions {
        single_index: true,
        triangulate: true,
        ignore_points: true,
        ignore_lines: true,
    };
    let (models, materials) = tobj::load_obj(path, &options).map_err(|error| error.to_string())?;
    let materials = materials.unwrap_or_default();
    Ok(Contents {
        parts: models.into_iter().map(|model| part(&model.mesh)).collect(),
        materials: materials.into_iter().map(material).collect(),
        ..Contents::default()
    })
}

fn part(mesh: &tobj::Mesh) -> Part {
    let vectors = |numbers: &[f32]| numbers.chunks_exact(3).map(Vec3::from_slice).collect();
    Part {
        positions: vectors(&mesh.positions),
        normals: vectors(&mesh.normals),
        indices: mesh.indices.clone(),
        material: mesh.material_id,
    }
}

fn material(material: tobj::Material) -> NamedMaterial {
    let color =
        |given: Option<[f32; 3]>, otherwise| given.map_or(Vec3::splat(otherwise), Vec3::from);
    NamedMaterial {
        base: color(material.diffuse, 0.6),
        reflecting: Reflecting::Colours {
            specular: color(material.specular, 0.0),
        },
        emission: color(material.emissive, 0.0),
        name: material.name,
    }
}
