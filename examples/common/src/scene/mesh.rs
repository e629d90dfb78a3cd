//! Triangles and what they are made of.

use stochastic_light_culling::glam::Vec3;

/// What a surface reflects: a diffuse part, and for glossy ones a GGX part of the colour `tint`.
#[derive(Clone, Debug)]
pub struct Material {
    pub albedo: Vec3,
    pub tint: Vec3,
    pub glossy: bool,
    /// Whether it shines by itself: where a file's light comes from.
    pub emissive: bool,
}

impl Material {
    pub fn diffuse(albedo: Vec3) -> Self {
        Self {
            albedo,
            tint: Vec3::ZERO,
            glossy: false,
            emissive: false,
        }
    }

    /// A GGX coat of the colour `tint` over a diffuse `base`, which gets what the coat leaves: never
    /// quite nothing, so that bare metal can be told from a hole in its own picture.
    pub fn glossy(base: Vec3, tint: Vec3) -> Self {
        Self {
            albedo: base * (1.0 - tint.max_element()).max(0.15),
            tint,
            glossy: true,
            emissive: false,
        }
    }

    /// Bare metal of one colour.
    pub fn metal(tint: Vec3) -> Self {
        Self::glossy(tint, tint)
    }
}

/// A triangle, counter-clockwise seen from outside, with a unit normal at each corner.
#[derive(Clone, Debug)]
pub struct Triangle {
    pub corners: [Vec3; 3],
    pub normals: [Vec3; 3],
    /// The place of its material in [`Mesh::materials`].
    pub material: usize,
}

impl Triangle {
    /// The plane triangle; `None` if its area is zero or too small for an `f32`.
    pub fn flat(corners: [Vec3; 3], material: usize) -> Option<Self> {
        let normal = twice_area(corners).try_normalize()?;
        Some(Self {
            corners,
            normals: [normal; 3],
            material,
        })
    }

    /// The normal of its plane; not its smooth one.
    pub fn plane_normal(&self) -> Vec3 {
        twice_area(self.corners).normalize_or_zero()
    }
}

/// The vector along the normal that is as long as twice the area.
pub fn twice_area([a, b, c]: [Vec3; 3]) -> Vec3 {
    (b - a).cross(c - a)
}

/// All triangles of a scene.
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    pub triangles: Vec<Triangle>,
    pub materials: Vec<Material>,
}

impl Mesh {
    pub fn add_material(&mut self, material: Material) -> usize {
        self.materials.push(material);
        self.materials.len() - 1
    }

    /// The plane quadrilateral with these corners in order.
    pub fn add_quad(&mut self, [a, b, c, d]: [Vec3; 4], material: usize) {
        let halves = [[a, b, c], [a, c, d]];
        let triangles = halves.map(|corners| Triangle::flat(corners, material));
        self.triangles.extend(triangles.into_iter().flatten());
    }

    pub fn material_of(&self, triangle: &Triangle) -> &Material {
        &self.materials[triangle.material]
    }

    /// The box around all triangles.
    pub fn extent(&self) -> Option<Extent> {
        Extent::around(&self.triangles)
    }

    /// The box around those of which `chosen` holds.
    pub fn extent_of(&self, chosen: impl Fn(&Material) -> bool) -> Option<Extent> {
        let of_them = |triangle: &&Triangle| chosen(self.material_of(triangle));
        Extent::around(self.triangles.iter().filter(of_them))
    }
}

/// An axis-aligned box.
#[derive(Clone, Copy, Debug)]
pub struct Extent {
    pub min: Vec3,
    pub max: Vec3,
}

impl Extent {
    pub fn around<'a>(triangles: impl IntoIterator<Item = &'a Triangle>) -> Option<Self> {
        triangles
            .into_iter()
            .flat_map(|triangle| triangle.corners)
            .map(|corner| Self {
                min: corner,
                max: corner,
            })
            .reduce(|a, b| Self {
                min: a.min.min(b.min),
                max: a.max.max(b.max),
            })
    }

    pub fn center(&self) -> Vec3 {
        0.5 * (self.min + self.max)
    }

    /// The radius of the sphere around it.
    pub fn radius(&self) -> f32 {
        0.5 * (self.max - self.min).length()
    }
}
