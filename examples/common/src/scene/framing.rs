//! Where to look at a file's mesh from, and where to light it from, if the file does not say.

use stochastic_light_culling::glam::Vec3;

use super::file::Loaded;
use super::mesh::{Extent, Material, Mesh};
use super::{Focus, Lamp, Scene, Tracer, Viewpoint, Wanted, emitters, indoors, trace_photons};

/// The irradiance of what lamps shine on.
const IRRADIANCE: f32 = 0.08;
/// The radiance of what shines by itself, at most: brighter than a white surface of that irradiance.
const EMISSION: f32 = 0.12;
/// How much of a view must be lit.
const LIT_SHARE: f32 = 0.05;

/// The scene of the file called `name`: y is up, and what is glossy is in the middle.
pub fn frame(name: &str, loaded: Loaded, wanted: &Wanted) -> Result<Scene, String> {
    let Loaded {
        mut mesh,
        lamps,
        viewpoint,
        has_lights,
    } = loaded;
    let whole = mesh.extent().ok_or("scene has no triangles")?;
    let is_bare = lamps.is_empty() && viewpoint.is_none();
    let stands_out = |triangle| mesh.material_of(triangle).stands_out();
    if is_bare && mesh.triangles.iter().all(stands_out) {
        add_floor(&mut mesh, &whole);
    }
    let shiny = mesh.extent_of(Material::stands_out);
    let focus = shiny.unwrap_or(whole);
    let emitters = emitters::lamps(&mesh, &whole, focus.center());
    show_emission(&mut mesh);

    let tracer = Tracer::new(&mesh);
    let framing = Framing {
        tracer: &tracer,
        whole,
        focus,
        is_coated: shiny.is_some() && mesh.materials.iter().all(|m| m.gloss.is_none()),
    };
    let lit = framing.lit(wanted, &lamps, emitters);
    let outside = framing.outside(shiny.is_some());
    let own = viewpoint.map(|view| framing.at_what_it_sees(view));
    let first = own.unwrap_or(outside).changed(wanted);
    let shows = |lit: &&Lit| indoors::lit_share(&tracer, &lit.lamps, &first) >= LIT_SHARE;
    let good = lit.iter().find(shows);
    let is_dark = good.is_none();
    let Some(Lit { lamps, how }) = good.or(lit.last()).cloned() else {
        return Err("scene has no lights".into());
    };
    let is_fixed = own.is_some() || wanted.eye.is_some();
    let inside = (is_dark && !is_fixed).then(|| indoors::viewpoint(&tracer, &lamps, &whole));
    let inside = inside.flatten().map(|view| view.changed(wanted));

    let seen = if inside.is_some() {
        "inside"
    } else {
        "outside"
    };
    let note = match (is_fixed, how) {
        (true, None) => None,
        (true, Some(how)) => Some(format!("no light: it is lit {how}")),
        (false, None) => Some(format!("no camera: it is seen from {seen}")),
        (false, Some(how)) => Some(format!(
            "no camera and no light: it is seen from {seen}, and lit {how}"
        )),
    };
    let note = note.filter(|_| has_lights);
    Ok(Scene {
        viewpoint: inside.unwrap_or(first),
        lamps,
        note: note.map(|lacks| format!("scene {name} has {lacks}")),
        mesh,
    })
}

/// Lamps, and how they light the scene if nobody has said so.
#[derive(Clone)]
struct Lit {
    lamps: Vec<Lamp>,
    how: Option<&'static str>,
}

struct Framing<'a> {
    tracer: &'a Tracer<'a>,
    whole: Extent,
    /// What is worth looking at.
    focus: Extent,
    /// Whether that is what a file calls glossy, without a roughness of its own.
    is_coated: bool,
}

impl Framing<'_> {
    /// How the scene may be lit: as asked for, as the file says, or where it shines by itself; else from above, and
    /// last from inside.
    fn lit(&self, wanted: &Wanted, lamps: &[Lamp], emitters: Vec<Lamp>) -> Vec<Lit> {
        let unscaled = |lamp: Lamp, how| Lit {
            lamps: vec![lamp],
            how: Some(how),
        };
        let (lamps, how) = if !wanted.lights.is_empty() {
            let lights = wanted.lights.iter().map(|light| self.lamp_at(*light));
            (lights.collect(), None)
        } else if !lamps.is_empty() {
            (lamps.to_vec(), None)
        } else if !emitters.is_empty() {
            let how = "by what shines by itself";
            if let ([emitter], true) = (&emitters[..], self.is_coated) {
                return vec![unscaled(self.aimed_from(emitter), how)];
            }
            (emitters, Some(how))
        } else {
            let above = unscaled(self.lamp_at(self.above()), "from above");
            let inside = indoors::lamp(self.tracer, &self.whole).map(|lamp| Lit {
                lamps: self.exposed(&[lamp]),
                how: Some("from inside"),
            });
            return [Some(above), inside].into_iter().flatten().collect();
        };
        vec![Lit {
            lamps: self.exposed(&lamps),
            how,
        }]
    }

    /// A light just outside `lamp`, for what is glossy alone.
    fn aimed_from(&self, lamp: &Lamp) -> Lamp {
        let center = lamp.position().unwrap_or(self.whole.center());
        let toward = (self.focus.center() - center).normalize_or(Vec3::NEG_Y);
        self.aimed(center + 0.02 * self.whole.radius() * toward)
    }

    /// A light that shines in all directions of a room, and else on what is worth it.
    fn lamp_at(&self, position: Vec3) -> Lamp {
        if indoors::is_in_a_room(self.tracer, position) {
            let distance = position.distance(self.focus.center());
            return Lamp::Point {
                position,
                intensity: Vec3::splat(IRRADIANCE * distance * distance),
            };
        }
        self.aimed(position)
    }

    fn aimed(&self, position: Vec3) -> Lamp {
        let focus = Focus {
            center: self.focus.center(),
            radius: self.focus.radius(),
            irradiance: Vec3::splat(IRRADIANCE),
        };
        focus.lamp_at(position)
    }

    /// `lamps`, brighter or darker by one factor, so that what they light has the same irradiance on average in all
    /// scenes, and δ the same meaning.
    fn exposed(&self, lamps: &[Lamp]) -> Vec<Lamp> {
        let photons = trace_photons(self.tracer, lamps, 4096, 1);
        let flux: f32 = photons.iter().map(|p| p.flux.max_element()).sum();
        let area: f32 = photons.iter().map(|photon| photon.footprint).sum();
        let factor = IRRADIANCE * area / flux;
        let is_number = factor.is_finite() && factor > 0.0;
        let factor = if is_number { factor } else { 1.0 };
        lamps.iter().map(|lamp| lamp.brighter(factor)).collect()
    }

    /// From the side above, but below what is there.
    fn above(&self) -> Vec3 {
        let direction = Vec3::new(1.0, 0.9, -0.5).normalize();
        let free = 0.9 * free_length(self.tracer, &self.focus, direction);
        self.focus.center() + (4.0 * self.focus.radius()).min(free) * direction
    }

    /// From above at a slant, or level from +z where there is a ceiling.
    fn outside(&self, is_shiny: bool) -> Viewpoint {
        let focus = &self.focus;
        // From the top of what is glossy, else from the middle of everything, straight up.
        let height = if is_shiny {
            focus.max.y + 0.01 * focus.radius()
        } else {
            focus.center().y
        };
        let top = focus.center().with_y(height);
        let has_ceiling = self.tracer.nearest(top, Vec3::Y).is_some();
        let (seen, to_eye) = if has_ceiling {
            (&self.whole, Vec3::Z)
        } else {
            (focus, Vec3::new(0.0, 0.8, 1.0).normalize())
        };
        // The sphere around a box is larger than it looks from most sides.
        Viewpoint::around(seen.center(), 0.75 * seen.radius(), to_eye, 0.6)
    }

    /// `view`, with what its middle ray meets as the target.
    fn at_what_it_sees(&self, view: Viewpoint) -> Viewpoint {
        let ahead = (view.target - view.eye).normalize_or(Vec3::NEG_Z);
        let met = self.tracer.nearest(view.eye, ahead);
        let distance = met.map_or(self.whole.radius(), |hit| hit.distance);
        Viewpoint {
            target: view.eye + distance * ahead,
            ..view
        }
    }
}

/// Brings what shines by itself to a radiance that can be shown beside what it lights.
fn show_emission(mesh: &mut Mesh) {
    let brightest = mesh.materials.iter().map(|m| m.emission.max_element());
    let brightest = brightest.fold(0.0, f32::max);
    if brightest > 0.0 {
        for material in &mut mesh.materials {
            material.emission *= EMISSION / brightest;
        }
    }
}

/// A floor beneath `extent`, far larger than it.
fn add_floor(mesh: &mut Mesh, extent: &Extent) {
    let material = mesh.add_material(Material::diffuse(Vec3::splat(0.6)));
    // Not flush with the lowest triangle, which it would flicker through.
    let height = extent.min.y - 1e-3 * extent.radius();
    let middle = extent.center().with_y(height);
    let [x, z] = [Vec3::X, Vec3::Z].map(|axis| 12.0 * extent.radius() * axis);
    mesh.add_quad(
        [z - x, z + x, x - z, -x - z].map(|corner| middle + corner),
        material,
    );
}

/// How far it is from the middle of `extent` to what is beyond it in the unit `direction`.
fn free_length(tracer: &Tracer, extent: &Extent, direction: Vec3) -> f32 {
    let start = extent.radius() * 1.01;
    tracer
        .nearest(extent.center() + start * direction, direction)
        .map_or(f32::INFINITY, |hit| start + hit.distance)
}
