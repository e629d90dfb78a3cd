//! (c) Error and nanoseconds of each function.

use std::f64::consts::PI;
use std::hint::black_box;
use std::time::Instant;

use stochastic_light_culling::{
    Bound, Bounded, Camera, CameraSphere, Conductor, DepthInterval, Dielectric, Direction,
    Ellipsoid, Ggx, GgxLobe, HeightCorrelated, LambertLobe, Lobe, MaskingShadowing, NoFresnel,
    PhongLobe, PixelRectangle, Roulette, Schlick, Separable, Sphere, Stretch, TileTest, Xi,
    glam::Vec3,
};

use super::Study;
use crate::figure::{Axis, Figure, Line, Look, Panel, Point, Series};
use crate::reference::{
    Brdf, Fresnel, Masking, Shape, Surface, Vector, ggx_ndf, smith_g1, smith_g2,
};
use crate::sheet::Sheet;
use crate::subject::Effort;

const METAL: f32 = 0.9;
const GLASS: f32 = 1.5;
const GOLD: (f32, f32) = (0.2, 3.5);

/// What the functions are given.
#[derive(Clone, Copy)]
struct Case {
    roughness: f32,
    normal: Direction,
    incoming: Direction,
    outgoing: Direction,
    position: Vec3,
    number: u32,
}

impl Case {
    /// With a roughness from 0.01 to 1, and both directions a degree above the surface or more.
    fn new(number: u32) -> Self {
        let random = |what: u32| 2.0 * Xi::hashed(number, what, 1).get() - 1.0;
        let vector = |what: u32| Vec3::new(random(what), random(what + 1), random(what + 2));
        let direction = |vector| Direction::new(vector).expect("random vectors are not zero");
        let normal = direction(vector(0));
        let above = |what| {
            let other = direction(vector(what));
            let height = other.dot(*normal);
            direction(*other * height.signum() + 0.02 * *normal)
        };
        Self {
            roughness: 10_f32.powf(-1.0 + random(9)),
            normal,
            incoming: above(3),
            outgoing: above(6),
            position: 10.0 * vector(10),
            number,
        }
    }

    fn ggx(&self) -> Ggx {
        Ggx::new(self.roughness).expect("in range")
    }

    fn lobe<F: stochastic_light_culling::Fresnel>(&self, fresnel: F) -> GgxLobe<F> {
        GgxLobe::new(self.ggx(), fresnel, self.normal, self.incoming)
    }

    fn surface(&self) -> Surface {
        let [normal, incoming] = [self.normal, self.incoming].map(|v| Vector::from(*v).unit());
        Surface { normal, incoming }
    }

    fn cosines(&self) -> [f32; 2] {
        [self.incoming, self.outgoing].map(|direction| direction.dot(*self.normal))
    }

    fn exact_cosines(&self) -> [f64; 2] {
        let Surface { normal, incoming } = self.surface();
        [incoming, Vector::from(*self.outgoing).unit()].map(|direction| direction.dot(normal))
    }

    fn half(&self) -> Vector {
        (self.surface().incoming + Vector::from(*self.outgoing).unit()).unit()
    }

    fn half_cosine(&self) -> f64 {
        self.half().dot(self.surface().incoming)
    }

    fn value(&self, brdf: Brdf) -> f64 {
        self.surface()
            .value(brdf, Vector::from(*self.outgoing).unit())
    }

    fn brdf(&self, fresnel: Fresnel) -> Brdf {
        let masking = Masking::HeightCorrelated;
        Brdf::Ggx {
            roughness: self.roughness,
            fresnel,
            masking,
        }
    }

    /// r of the paper's bound for Φ/(δξ) = 1.
    fn radius(&self, fresnel: Fresnel) -> f64 {
        let mu = self.exact_cosines()[0];
        let reflected = fresnel.max_above_surface(mu) * smith_g1(self.roughness.into(), mu);
        (reflected / (4.0 * PI * mu)).sqrt()
    }
}

/// What was measured of a function.
struct Row {
    name: &'static str,
    kind: &'static str,
    ns: f64,
    error: f64,
}

struct Bench {
    cases: Vec<Case>,
    is_quick: bool,
    rows: Vec<Row>,
}

impl Bench {
    /// Times `function` of what `prepare` makes of each case, and compares with `exact` if that says.
    fn add<T, U>(
        &mut self,
        (kind, name): (&'static str, &'static str),
        prepare: impl Fn(&Case) -> T,
        function: impl Fn(&T) -> U,
        error: impl Fn(&Case, U) -> f64,
    ) {
        let inputs: Vec<T> = self.cases.iter().map(prepare).collect();
        let errors = self
            .cases
            .iter()
            .zip(&inputs)
            .map(|(case, input)| error(case, function(input)));
        let error = errors.filter(|error| !error.is_nan()).fold(0.0, f64::max);
        let ns = nanoseconds(&inputs, function, self.is_quick);
        self.rows.push(Row {
            name,
            kind,
            ns,
            error,
        });
    }
}

/// The least time per input of several rounds.
fn nanoseconds<T, U>(inputs: &[T], function: impl Fn(&T) -> U, is_quick: bool) -> f64 {
    let round = || {
        let start = Instant::now();
        for input in inputs {
            black_box(function(black_box(input)));
        }
        1e9 * start.elapsed().as_secs_f64() / inputs.len() as f64
    };
    (0..if is_quick { 10 } else { 200 })
        .map(|_| round())
        .fold(f64::INFINITY, f64::min)
}

fn off(computed: f32, exact: f64) -> f64 {
    // Beyond, f32 has few digits or none.
    if exact.abs() < 1e-30 {
        f64::NAN
    } else {
        (f64::from(computed) / exact - 1.0).abs()
    }
}

pub fn make(effort: &Effort, done: &dyn Fn()) -> Study {
    let count = if effort.is_quick { 1000 } else { 20_000 };
    let mut bench = Bench {
        cases: (0..count).map(Case::new).collect(),
        is_quick: effort.is_quick,
        rows: Vec::new(),
    };
    microfacets(&mut bench);
    fresnel(&mut bench);
    lobes(&mut bench);
    bounds(&mut bench);
    tests(&mut bench);
    done();

    let mut sheet = Sheet::new(&["kind", "function", "ns", "max_relative_error"]);
    let mut series: Vec<Series> = Vec::new();
    for row in &bench.rows {
        sheet.push([
            row.kind.into(),
            row.name.into(),
            row.ns.into(),
            row.error.into(),
        ]);
        // A logarithm must be had of what is exact, too.
        let point = Point::new(row.ns, row.error.max(1e-8)).labelled(row.name);
        match series.last_mut() {
            Some(series) if series.name == row.kind => series.points.push(point),
            _ => series.push(Series {
                name: row.kind.into(),
                look: Look {
                    color: series.len(),
                    line: Line::None,
                },
                points: vec![point],
            }),
        }
    }
    Study {
        name: "functions",
        caption: "Each function over random lights and directions, α from 0.01 to 1, a degree above the horizon or more. The error of a bound \
                  is that of its size, and of a stretch how far points of the ellipsoid land from the \
                  unit sphere, to which it adds a margin on purpose; the error of a test is the share of \
                  tiles that it keeps though an exact one in f64 would not. None is lost.",
        sheet,
        figure: Figure {
            title: "Functions: error against time".into(),
            subtitle: format!("{count} random cases, one core, one at a time"),
            panels: vec![Panel {
                title: "least error at the bottom, least time to the left".into(),
                x: Axis::log("ns"),
                y: Axis::log("largest relative error against f64"),
                series,
            }],
        },
    }
}

fn microfacets(bench: &mut Bench) {
    let kind = "microfacets";
    bench.add(
        (kind, "D"),
        |case| (case.ggx(), *case.incoming + *case.outgoing, *case.normal),
        |(ggx, half, normal)| ggx.ndf_at(*half, *normal),
        |case, d| {
            off(
                d,
                ggx_ndf(case.roughness.into(), case.half(), case.surface().normal),
            )
        },
    );
    bench.add(
        (kind, "G1"),
        |case| (case.ggx(), case.cosines()[0]),
        |(ggx, cosine)| ggx.masking(*cosine),
        |case, g| off(g, smith_g1(case.roughness.into(), case.exact_cosines()[0])),
    );
    bench.add(
        (kind, "G2, height-correlated"),
        |case| (case.ggx(), case.cosines()),
        |(ggx, [i, o])| HeightCorrelated::masking_shadowing(*ggx, *i, *o),
        |case, g| {
            let [i, o] = case.exact_cosines();
            off(
                g,
                smith_g2(case.roughness.into(), Masking::HeightCorrelated, i, o),
            )
        },
    );
    bench.add(
        (kind, "G2, separable"),
        |case| (case.ggx(), case.cosines()),
        |(ggx, [i, o])| Separable::masking_shadowing(*ggx, *i, *o),
        |case, g| {
            let [i, o] = case.exact_cosines();
            off(g, smith_g2(case.roughness.into(), Masking::Separable, i, o))
        },
    );
}

fn fresnel(bench: &mut Bench) {
    fn add<F: stochastic_light_culling::Fresnel>(
        bench: &mut Bench,
        [of_f, of_max]: [&'static str; 2],
        fresnel: F,
        exact: Fresnel,
    ) {
        bench.add(
            ("Fresnel", of_f),
            |case| case.half_cosine() as f32,
            |cosine| fresnel.reflectance(*cosine),
            |case, f| off(f, exact.at(f64::from(case.half_cosine() as f32))),
        );
        bench.add(
            ("Fresnel", of_max),
            |case| case.lobe(fresnel),
            GgxLobe::max_fresnel,
            |case, f| off(f, exact.max_above_surface(case.exact_cosines()[0])),
        );
    }
    let schlick = Schlick::new(METAL).expect("in range");
    add(
        bench,
        ["F, Schlick", "F_max, Schlick"],
        schlick,
        Fresnel::Schlick(METAL),
    );
    let glass = Dielectric::new(GLASS).expect("in range");
    add(
        bench,
        ["F, dielectric", "F_max, dielectric"],
        glass,
        Fresnel::Dielectric(GLASS),
    );
    let gold = Conductor::new(GOLD.0, GOLD.1).expect("in range");
    add(
        bench,
        ["F, conductor", "F_max, conductor"],
        gold,
        Fresnel::Conductor(GOLD.0, GOLD.1),
    );
}

fn lobes(bench: &mut Bench) {
    let kind = "lobes, f·cos";
    bench.add(
        (kind, "GGX"),
        |case| (case.lobe(NoFresnel), *case.outgoing),
        |(lobe, outgoing)| lobe.value(*outgoing),
        |case, value| off(value, case.value(case.brdf(Fresnel::None))),
    );
    bench.add(
        (kind, "GGX, Schlick"),
        |case| {
            (
                case.lobe(Schlick::new(METAL).expect("in range")),
                *case.outgoing,
            )
        },
        |(lobe, outgoing)| lobe.value(*outgoing),
        |case, value| off(value, case.value(case.brdf(Fresnel::Schlick(METAL)))),
    );
    bench.add(
        (kind, "Lambert"),
        |case| {
            (
                LambertLobe::new(0.8, case.normal).expect("in range"),
                *case.outgoing,
            )
        },
        |(lobe, outgoing)| lobe.value(*outgoing),
        |case, value| off(value, case.value(Brdf::Lambert { albedo: 0.8 })),
    );
    let exponent = |case: &Case| 2.0 / (case.roughness * case.roughness).max(1e-2);
    bench.add(
        (kind, "Phong"),
        |case| {
            let lobe = PhongLobe::new(0.8, exponent(case), case.normal, case.incoming);
            (lobe.expect("in range"), *case.outgoing)
        },
        |(lobe, outgoing)| lobe.value(*outgoing),
        |case, value| {
            off(
                value,
                case.value(Brdf::Phong {
                    albedo: 0.8,
                    exponent: exponent(case),
                }),
            )
        },
    );
}

fn bounds(bench: &mut Bench) {
    let kind = "bounds";
    let metal = Schlick::new(METAL).expect("in range");
    let exact = |case: &Case| case.radius(Fresnel::Schlick(METAL));
    bench.add(
        (kind, "sphere at light"),
        |case| case.lobe(metal),
        |lobe| lobe.unit_bound().sphere_at_focus(),
        |case, sphere: Sphere| off(sphere.radius(), exact(case) / f64::from(case.roughness)),
    );
    bench.add(
        (kind, "enclosing sphere"),
        |case| case.lobe(metal),
        |lobe| lobe.unit_bound().enclosing_sphere(),
        |case, sphere: Sphere| {
            let alpha = f64::from(case.roughness);
            off(
                sphere.radius(),
                exact(case) * (1.0 + alpha * alpha) / (2.0 * alpha),
            )
        },
    );
    bench.add(
        (kind, "spheroid"),
        |case| case.lobe(metal),
        |lobe| lobe.unit_bound(),
        |case, spheroid| off(spheroid.radius(), exact(case)),
    );
    bench.add(
        (kind, "scale r, roulette"),
        |case| Xi::hashed(case.number, 0, 2),
        |xi| Roulette::new(1e-3).expect("in range").scale(2.0, *xi),
        |case, scale| {
            let xi = Xi::hashed(case.number, 0, 2).get();
            off(scale, (2.0 / (f64::from(1e-3_f32) * f64::from(xi))).sqrt())
        },
    );
    stretch(bench, "stretch of spheroid", |lobe| {
        lobe.unit_bound().into()
    });
    stretch(bench, "triaxial + stretch", GgxLobe::triaxial_bound);
    stretch(bench, "tight + stretch", GgxLobe::tight_bound);
}

fn camera() -> Camera {
    let eye = Vec3::new(0.0, 5.0, 25.0);
    Camera::look_at(eye, Vec3::ZERO, Vec3::Y, 1.0, 16.0 / 9.0, 0.1..100.0).expect("in range")
}

/// Makes the stretch of a bound, and checks where it takes the ends of the axes.
fn stretch(
    bench: &mut Bench,
    name: &'static str,
    unit: impl Fn(&GgxLobe<Schlick>) -> Ellipsoid + Copy,
) {
    let camera = camera();
    let metal = Schlick::new(METAL).expect("in range");
    let placed =
        move |(case, lobe): &(Case, GgxLobe<Schlick>)| unit(lobe).placed(case.position, 1.0);
    bench.add(
        ("bounds", name),
        |case| (*case, case.lobe(metal)),
        |input| (placed(input), Stretch::new(&placed(input), &camera)),
        |_, (ellipsoid, stretch)| {
            let Some(stretch) = stretch else {
                return f64::NAN;
            };
            let shape = Shape::from(ellipsoid);
            let to_camera = camera.rotation();
            let rows = [to_camera.row(0), to_camera.row(1), to_camera.row(2)].map(Vector::from);
            let eye = Vector::from(camera.to_world_space(Vec3::ZERO));
            let columns = [
                stretch.matrix().x_axis,
                stretch.matrix().y_axis,
                stretch.matrix().z_axis,
            ];
            let columns = columns.map(Vector::from);
            let off_sphere = |unit: [f64; 3]| {
                let seen = shape.point(Vector(unit)) - eye;
                let seen = rows.map(|row| row.dot(seen));
                let image = columns[0] * seen[0] + columns[1] * seen[1] + columns[2] * seen[2]
                    - Vector::from(stretch.center());
                (image.length() - 1.0).abs()
            };
            let axes = (0..3).flat_map(|i| [1.0, -1.0].map(|end| (i, end)));
            let ends = axes.map(|(i, end)| {
                let mut unit = [0.0; 3];
                unit[i] = end;
                off_sphere(unit)
            });
            ends.fold(0.0, f64::max)
        },
    );
}

fn tests(bench: &mut Bench) {
    let camera = camera();
    let size = [640, 360];
    let tile = move |case: &Case| {
        let [x, y] = [1, 2].map(|what| Xi::hashed(case.number, what, 3).get());
        let min = [(x * 39.0) as u32 * 16, (y * 21.0) as u32 * 16];
        let rectangle = camera.tile_rectangle(
            size,
            PixelRectangle {
                min,
                max: min.map(|pixel| pixel + 16),
            },
        );
        let near = 10.0 + 25.0 * Xi::hashed(case.number, 3, 3).get();
        (
            rectangle,
            DepthInterval::new(near, near + 2.0).expect("in range"),
        )
    };
    let metal = Schlick::new(METAL).expect("in range");
    let stretched = move |case: &Case| {
        let unit = case.lobe(metal).tight_bound();
        let scale = 30.0 * case.roughness.max(0.03);
        let stretch = Stretch::new(&unit.placed(case.position, scale), &camera);
        stretch.map(|stretch| (stretch, tile(case)))
    };
    let in_vain = |share: f64| move |_: &Case, _: bool| share;
    let cases: Vec<_> = bench.cases.iter().filter_map(stretched).collect();
    let kept = |test: &dyn Fn(&Stretch, &(_, _)) -> bool| {
        cases
            .iter()
            .filter(|(stretch, tile)| test(stretch, tile))
            .count() as f64
    };
    let touched = kept(&|stretch, (rectangle, depths)| {
        let image = crate::reference::Frustum::new(stretch.matrix(), rectangle, depths);
        image.distance(Vector::from(stretch.center())) < 1.0
    });
    let by_box = kept(&|stretch, (rectangle, depths)| stretch.touches(rectangle, depths));
    let exactly = kept(&|stretch, (rectangle, depths)| stretch.touches_exactly(rectangle, depths));
    let share = |kept: f64| (kept - touched) / kept.max(1.0);
    let input = move |case: &Case| (stretched(case).map(|(stretch, _)| stretch), tile(case));
    bench.add(
        ("tests", "box"),
        input,
        |(stretch, (rectangle, depths))| {
            stretch.is_some_and(|stretch| stretch.touches(rectangle, depths))
        },
        in_vain(share(by_box)),
    );
    bench.add(
        ("tests", "exact, after box"),
        input,
        |(stretch, (rectangle, depths))| {
            stretch.is_some_and(|stretch| {
                stretch.touches(rectangle, depths) && stretch.touches_exactly(rectangle, depths)
            })
        },
        in_vain(share(exactly)),
    );
    bench.add(
        ("tests", "sphere"),
        |case| {
            let sphere = Sphere::new(case.position, 1.0).expect("in range");
            (CameraSphere::new(&sphere, &camera), tile(case))
        },
        |(sphere, (rectangle, depths))| {
            sphere.is_some_and(|sphere| sphere.touches(rectangle, depths))
        },
        |_, _| f64::NAN,
    );
}
