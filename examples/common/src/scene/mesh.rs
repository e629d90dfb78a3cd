//! Triangles and what they are made of.

use stochastic_light_culling::{Ggx, Schlick, glam::Vec3};

/// What a surface reflects: a diffuse part, and for glossy ones a GGX part of the colour `tint`.
#[derive(Clone, Debug)]
pub struct Material {
    pub albedo: Vec3,
    pub tint: Vec3,
    pub glossy: bool,
    /// Its own roughness and reflectance, if it has any.
    pub gloss: Option<Gloss>,
    /// The radiance of what shines by itself, in the units of the file that it comes from.
    pub emission: Vec3,
    /// The share of light that a coat leaves to what is below it, and zero of bare metal.
    below_coat: f32,
    base: Vec3,
}

/// How a surface reflects as GGX.
#[derive(Clone, Copy, Debug)]
pub struct Gloss {
    pub ggx: Ggx,
    pub fresnel: Schlick,
    /// Of the lights on it. They stand for those between them too, and would each throw a spot of its own if they were
    /// as smooth as a mirror.
    pub light_ggx: Ggx,
}

impl Gloss {
    pub fn new(ggx: Ggx, fresnel: Schlick) -> Self {
        Self {
            ggx,
            fresnel,
            light_ggx: ggx,
        }
    }
}

impl Material {
    pub fn diffuse(albedo: Vec3) -> Self {
        Self {
            albedo,
            tint: Vec3::ZERO,
            glossy: false,
            gloss: None,
            emission: Vec3::ZERO,
            below_coat: 1.0,
            base: albedo,
        }
    }

    /// A GGX coat of the colour `tint` over a diffuse `base`, which gets what the coat leaves.
    pub fn glossy(base: Vec3, tint: Vec3) -> Self {
        Self::coated(base, tint, 1.0 - tint.max_element())
    }

    /// As [`Self::glossy`], with the share of `base` that is left. As a light and in the picture of indirect light
    /// it is never quite nothing, so that bare metal can be told from a hole.
    pub fn coated(base: Vec3, tint: Vec3, below_coat: f32) -> Self {
        Self {
            albedo: base * below_coat.max(0.15),
            tint,
            glossy: true,
            below_coat,
            ..Self::diffuse(base)
        }
    }

    /// Bare metal of one colour.
    pub fn metal(tint: Vec3) -> Self {
        Self::glossy(tint, tint)
    }

    pub fn is_emissive(&self) -> bool {
        self.emission.max_element() > 0.0
    }

    /// Whether it is worth looking at: what files call glossy, and metal.
    pub fn stands_out(&self) -> bool {
        self.glossy && (self.gloss.is_none() || self.below_coat < 0.5)
    }

    /// The diffuse albedo as it is: zero of bare metal.
    pub fn true_albedo(&self) -> Vec3 {
        self.base * self.below_coat.max(0.0)
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
            .reduce(|a, b| a.with(&b))
    }

    /// The box around both.
    pub fn with(&self, other: &Self) -> Self {
        Self {
            min: self.min.min(other.min),
            max: self.max.max(other.max),
        }
    }

    /// Whether the two boxes are no farther apart than `distance` along any axis.
    pub fn is_near(&self, other: &Self, distance: f32) -> bool {
        let gap = (other.min - self.max).max(self.min - other.max);
        gap.max_element() <= distance
    }

    pub fn center(&self) -> Vec3 {
        0.5 * (self.min + self.max)
    }

    /// The radius of the sphere around it.
    pub fn radius(&self) -> f32 {
        0.5 * (self.max - self.min).length()
    }
}
