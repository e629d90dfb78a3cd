//! The isosurface of a lobe, and what encloses it, cut by two planes.

use std::f32::consts::PI;

use plotters::element::{PathElement, Polygon};
use plotters::style::{Color, RGBColor};
use stochastic_light_culling::glam::{Mat3, Vec2, Vec3};
use stochastic_light_culling::{
    Direction, Ellipsoid, Error, Ggx, GgxLobe, Incidence, Lobe, Paper, Roulette, Schlick, Tight,
    Vpl, Xi,
};

use crate::section::{Plane, circle};
use crate::sheet::{Area, FINE, INK, Outcome, fine, svg as sheet, write};

const ROUGHNESS: f32 = 0.3;
const F0: f32 = 0.9;
const INCIDENCE_DEGREES: f32 = 50.0;
const SIZE: (u32, u32) = (940, 492);

/// Colours that remain different to most eyes [Okabe & Ito 2008].
const LOBE: RGBColor = RGBColor(230, 159, 0);
const COLORS: [RGBColor; 3] = [
    RGBColor(0, 114, 178),
    RGBColor(0, 158, 115),
    RGBColor(213, 94, 0),
];
const NAMES: [&str; 3] = ["sphere (2016)", "spheroid (2017)", "tight ellipsoid"];

/// A lobe of unit range, and its three bounds.
struct Shapes {
    lobe: GgxLobe<Schlick>,
    bounds: [Ellipsoid; 3],
    volume: f32,
}

pub fn svg() -> Result<String, String> {
    let shapes = Shapes::new().map_err(|error| error.to_string())?;
    let mirror = *shapes.lobe.mirror_direction();
    let planes = [
        Plane {
            right: Vec3::X,
            up: Vec3::Y,
        },
        Plane {
            right: Vec3::Z,
            up: mirror,
        },
    ];
    sheet(SIZE, &[], |area| {
        let title = format!(
            "Where a gold light reaches: GGX, α = {ROUGHNESS}, F0 = {F0}, lit at {INCIDENCE_DEGREES}°"
        );
        write(area, title, (14, 12), 19)?;
        // Side by side at one scale, with the light at the same height.
        let radius = shapes.bounds[0].semi_axes().x;
        let scale = 180.0 / radius;
        let left = View {
            origin: (235, 256),
            scale,
        };
        let right = View {
            origin: (700, 256),
            scale,
        };
        left.draw(area, &shapes, &planes[0])?;
        right.draw(area, &shapes, &planes[1])?;
        left.surface(area, &shapes)?;
        write(area, "in the plane of incidence", (130, 44), 16)?;
        write(
            area,
            "in the plane across it, along the mirror direction",
            (520, 44),
            16,
        )?;
        labels(area, &shapes)
    })
}

impl Shapes {
    fn new() -> Result<Self, Error> {
        let angle = INCIDENCE_DEGREES.to_radians();
        let incoming = Direction::new(Vec3::new(-angle.sin(), angle.cos(), 0.0))?;
        let normal = Direction::Y;
        let incidence = Incidence { normal, incoming };
        let lobe = GgxLobe::new(Ggx::new(ROUGHNESS)?, Schlick::new(F0)?, incidence);
        let (roulette, xi) = (Roulette::new(1.0)?, Xi::new(1.0)?);
        let light = Vpl::new(Vec3::ZERO, 1.0, lobe)?;
        let spheroid = light.bound_by(Paper, &roulette, xi);
        let sphere = spheroid.sphere_at_focus();
        Ok(Self {
            bounds: [
                Ellipsoid::new(
                    sphere.center(),
                    Mat3::IDENTITY,
                    Vec3::splat(sphere.radius()),
                )?,
                spheroid.into(),
                light.bound_by(Tight, &roulette, xi),
            ],
            volume: volume(&lobe),
            lobe,
        })
    }

    /// The isosurface in the unit `direction` from the light.
    fn reach(&self, direction: Vec3) -> f32 {
        self.lobe.value(direction).sqrt()
    }
}

/// The volume inside the isosurface: a third of the integral of its cube, over the hemisphere.
fn volume(lobe: &GgxLobe<Schlick>) -> f32 {
    const STEPS: u16 = 400;
    let step = 1.0 / f32::from(STEPS);
    let at = |i: u16| (f32::from(i) + 0.5) * step;
    let cells = (0..STEPS).flat_map(|i| (0..STEPS).map(move |j| (at(i), at(j))));
    let cubes = cells.map(|(height, turn)| {
        let around = Vec2::from_angle(2.0 * PI * turn) * (1.0 - height * height).sqrt();
        lobe.value(Vec3::new(around.x, height, around.y)).powf(1.5)
    });
    let sum: f32 = cubes.sum();
    sum * step * step * 2.0 * PI / 3.0
}

/// Where a plane is drawn.
struct View {
    origin: (i32, i32),
    scale: f32,
}

impl View {
    fn at(&self, point: Vec2) -> (i32, i32) {
        let pixel = FINE as f32 * self.scale * point;
        let (x, y) = fine(self.origin);
        (x + pixel.x.round() as i32, y - pixel.y.round() as i32)
    }

    fn draw(&self, area: &Area, shapes: &Shapes, plane: &Plane) -> Outcome {
        let inside =
            circle().map(|unit| unit * shapes.reach(unit.x * plane.right + unit.y * plane.up));
        let inside: Vec<_> = inside.map(|point| self.at(point)).collect();
        area.draw(&Polygon::new(inside, LOBE.mix(0.45).filled()))?;
        for (bound, color) in shapes.bounds.iter().zip(COLORS) {
            let outline: Vec<_> = plane.cut(bound).into_iter().map(|p| self.at(p)).collect();
            area.draw(&PathElement::new(
                outline,
                color.stroke_width(2 * FINE as u32),
            ))?;
        }
        Ok(())
    }

    /// The surface that the light is on, and where its light comes from.
    fn surface(&self, area: &Area, shapes: &Shapes) -> Outcome {
        let (x, y) = self.origin;
        let pen = |width: i32| INK.stroke_width((FINE * width) as u32);
        let ground = [(x - 215, y), (x + 215, y)].map(fine);
        area.draw(&PathElement::new(ground, pen(2)))?;
        let incoming = shapes.lobe.incoming().truncate() / self.scale;
        let from = self.at(150.0 * incoming);
        let head = |turn: f32| self.at(Vec2::from_angle(turn).rotate(14.0 * incoming));
        let arrow = vec![from, fine((x, y)), head(0.35), head(-0.35), fine((x, y))];
        area.draw(&PathElement::new(arrow, pen(1)))?;
        write(area, "arriving", (x - 190, y - 94), 15)?;
        write(area, "surface", (x - 212, y + 5), 15)
    }
}

/// The names of the shapes, and their volumes over that of the isosurface.
fn labels(area: &Area, shapes: &Shapes) -> Outcome {
    let volumes = shapes.bounds.map(|bound| {
        let [a, b, c] = bound.semi_axes().to_array();
        4.0 / 3.0 * PI * a * b * c / shapes.volume
    });
    let line = |column: i32, color: RGBColor, label: String| -> Outcome {
        let (x, y) = (14 + 232 * column, 468);
        let ends = [(x, y), (x + 26, y)].map(fine);
        area.draw(&PathElement::new(ends, color.stroke_width(5 * FINE as u32)))?;
        write(area, label, (x + 34, y - 10), 16)
    };
    line(0, LOBE, "lit volume: 1".into())?;
    for ((column, name), (color, volume)) in (1..).zip(NAMES).zip(COLORS.into_iter().zip(volumes)) {
        line(column, color, format!("{name}: {volume:.1}"))?;
    }
    Ok(())
}
