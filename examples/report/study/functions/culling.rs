//! Bounds, stretches and tests of tiles.

use stochastic_light_culling::{
    Bounded, Camera, DepthInterval, Ellipsoid, GgxLobe, Paper, ProjectedEllipsoid, Roulette,
    Schlick, Seed, Sphere, Tight, TileGrid, Triaxial, glam::Vec3,
};
use support::reference::{Fresnel, Frustum, Shape, Vector};

use super::{Bench, Case, METAL, off};

pub fn bounds(bench: &mut Bench) {
    let kind = "bounds";
    let metal = Schlick::new(METAL).expect("in range");
    let exact = |case: &Case| case.radius(Fresnel::Schlick(METAL));
    bench.add(
        (kind, "sphere at light"),
        |case| case.lobe(metal),
        |lobe| lobe.unit_bound_by(Paper).sphere_at_focus(),
        |case, sphere: Sphere| off(sphere.radius(), exact(case) / f64::from(case.roughness)),
    );
    bench.add(
        (kind, "enclosing sphere"),
        |case| case.lobe(metal),
        |lobe| lobe.unit_bound_by(Paper).enclosing_sphere(),
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
        |lobe| lobe.unit_bound_by(Paper),
        |case, spheroid| off(spheroid.radius(), exact(case)),
    );
    let seed = Seed(2).frame(0);
    bench.add(
        (kind, "scale r, roulette"),
        |case| seed.hashed_xi(case.index),
        |xi| Roulette::new(1e-3).expect("in range").scale(2.0, *xi),
        |case, scale| {
            let xi = seed.hashed_xi(case.index).get();
            off(scale, (2.0 / (f64::from(1e-3_f32) * f64::from(xi))).sqrt())
        },
    );
    stretch(bench, "stretch of spheroid", |lobe| {
        lobe.unit_bound_by(Paper).into()
    });
    stretch(bench, "triaxial + stretch", |lobe| {
        lobe.unit_bound_by(Triaxial)
    });
    stretch(bench, "tight + stretch", |lobe| lobe.unit_bound_by(Tight));
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
        |input| {
            let ellipsoid = placed(input);
            (ellipsoid, ellipsoid.project(&camera))
        },
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

pub fn tests(bench: &mut Bench) {
    let camera = camera();
    let grid = TileGrid::new([640, 360], 16).expect("not empty");
    let tile = move |case: &Case| {
        let random = |frame| Seed(3).frame(frame).hashed_xi(case.index).get();
        let [x, y] = [random(1) * 39.0, random(2) * 21.0];
        let near = 10.0 + 25.0 * random(3);
        (
            camera.tile(&grid, [x as u32, y as u32]),
            DepthInterval::new(near, near + 2.0).expect("in range"),
        )
    };
    let metal = Schlick::new(METAL).expect("in range");
    let stretched = move |case: &Case| {
        let unit = case.lobe(metal).unit_bound_by(Tight);
        let scale = 30.0 * case.roughness.max(0.03);
        let stretch = unit.placed(case.position, scale).project(&camera);
        stretch.map(|stretch| (stretch, tile(case)))
    };
    let unneeded = |share: f64| move |_: &Case, _: bool| share;
    let cases: Vec<_> = bench.cases.iter().filter_map(stretched).collect();
    let kept = |test: &dyn Fn(&ProjectedEllipsoid, &(_, _)) -> bool| {
        cases
            .iter()
            .filter(|(stretch, tile)| test(stretch, tile))
            .count() as f64
    };
    let touched = kept(&|stretch, (rectangle, depths)| {
        let image = Frustum::new(stretch.matrix(), rectangle, depths);
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
        unneeded(share(by_box)),
    );
    bench.add(
        ("tests", "exact, after box"),
        input,
        |(stretch, (rectangle, depths))| {
            stretch.is_some_and(|stretch| {
                stretch.touches(rectangle, depths) && stretch.touches_exactly(rectangle, depths)
            })
        },
        unneeded(share(exactly)),
    );
    bench.add(
        ("tests", "sphere"),
        |case| {
            let sphere = Sphere::new(case.position, 1.0).expect("in range");
            (sphere.project(&camera), tile(case))
        },
        |(sphere, (rectangle, depths))| {
            sphere.is_some_and(|sphere| sphere.touches(rectangle, depths))
        },
        |_, _| f64::NAN,
    );
}
