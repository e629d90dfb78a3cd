//! What is saved is what is read, and what a constructor refuses is refused when read.
#![cfg(feature = "serde")]

use std::fmt::Debug;

use proptest::prelude::*;
use serde_json::{Value, json};
use stochastic_light_culling::{
    AnisotropicGgx, AnisotropicGgxLobe, AnyCamera, Camera, Conductor, ConstantLobe, CullCounters,
    DepthInterval, Dielectric, Direction, DistanceWindow, Error, EvenNoise, FresnelMajorant, Ggx,
    GgxLobe, HeightCorrelated, Incidence, Interleave, LambertLobe, NoFresnel, Orthographic,
    PhongLobe, PixelRectangle, Proxy, Roulette, Schlick, Seed, Separable, SphericalGaussian,
    SpotLobe, TileGrid, TileRectangle, Vpl, Xi,
    glam::{Vec2, Vec3},
};
use support::generators::{self, cases, log_uniform, up_to_one};
use support::with_camera;

/// What can be saved and read.
trait Saved: serde::Serialize + serde::de::DeserializeOwned + PartialEq + Debug {}

impl<T: serde::Serialize + serde::de::DeserializeOwned + PartialEq + Debug> Saved for T {}

fn comes_back<T: Saved>(value: &T) -> Result<(), TestCaseError> {
    let text = serde_json::to_string(value).unwrap();
    let read: T = serde_json::from_str(&text).unwrap();
    prop_assert_eq!(&read, value, "{}", text);
    // What is equal may be of other bits, such as −0; what is printed alike is not.
    prop_assert_eq!(format!("{read:?}"), format!("{value:?}"), "{}", text);
    Ok(())
}

#[track_caller]
fn assert_saved<T: Saved>(value: &T, saved: Value) {
    assert_eq!(serde_json::to_value(value).unwrap(), saved);
    let read: T = serde_json::from_value(saved).unwrap();
    assert_eq!(read, *value);
}

#[track_caller]
fn assert_refused<T: Saved>(saved: Value, reason: &str) {
    let message = serde_json::from_value::<T>(saved).unwrap_err().to_string();
    assert!(message.contains(reason), "{message}");
}

#[test]
fn each_is_saved_under_the_names_of_its_constructor() -> Result<(), Error> {
    assert_saved(&Ggx::new(0.25)?, json!({ "roughness": 0.25 }));
    let brushed = AnisotropicGgx::new(0.5, 0.125)?;
    assert_saved(&brushed, json!({ "roughness": [0.5, 0.125] }));
    assert_saved(&Schlick::new(0.75)?, json!({ "f0": 0.75 }));
    let glass = Dielectric::new(1.5)?;
    assert_saved(&glass, json!({ "relative_index": 1.5 }));
    let gold = Conductor::new(0.125, 3.5)?;
    assert_saved(&gold, json!({ "index": 0.125, "extinction": 3.5 }));
    let paper = LambertLobe::new(0.5, Direction::Y)?;
    let saved_paper = json!({ "albedo": 0.5, "normal": [0.0, 1.0, 0.0] });
    assert_saved(&paper, saved_paper);
    assert_saved(&NoFresnel, Value::Null);
    assert_saved(&HeightCorrelated, Value::Null);
    assert_saved(&Separable, Value::Null);
    assert_saved(&ConstantLobe, Value::Null);
    assert_saved(&Roulette::new(0.0625)?, json!({ "delta": 0.0625 }));
    assert_saved(&Xi::new(0.5)?, json!(0.5));
    assert_saved(&Direction::X, json!([1.0, 0.0, 0.0]));
    let depths = DepthInterval::new(0.5, 8.0)?;
    assert_saved(&depths, json!({ "near": 0.5, "far": 8.0 }));
    let grid = TileGrid::new([640, 480], 16)?;
    let saved_grid = json!({ "image_size": [640, 480], "tile_size": 16 });
    assert_saved(&grid, saved_grid);
    let interleave = Interleave::new([640, 480], 8)?;
    let saved_interleave = json!({ "image_size": [640, 480], "width": 8 });
    assert_saved(&interleave, saved_interleave);
    let (min, max) = ([1, 2], [3, 4]);
    let pixels = PixelRectangle { min, max };
    assert_saved(&pixels, json!({ "min": min, "max": max }));
    let tile = TileRectangle::new(Vec2::new(-0.5, 0.0), Vec2::new(0.5, 1.0))?;
    assert_saved(&tile, json!({ "min": [-0.5, 0.0], "max": [0.5, 1.0] }));
    assert_saved(&Proxy::Icosphere, json!("Icosphere"));
    let glassy = FresnelMajorant {
        base: 0.25,
        rise: 0.75,
    };
    assert_saved(&glassy, json!({ "base": 0.25, "rise": 0.75 }));
    let counted = json!({
        "block_tests": 0, "tile_tests": 0, "box_tests": 0, "empty": 0, "rejected_exactly": 0, "pairs": 0,
    });
    assert_saved(&CullCounters::default(), counted);
    Ok(())
}

#[test]
fn lobes_and_lights_are_saved_with_what_they_are_made_of() -> Result<(), Error> {
    let (normal, incoming) = (Direction::Z, Direction::X);
    let (up, aside) = ([0.0, 0.0, 1.0], [1.0, 0.0, 0.0]);
    let gold = GgxLobe::new(
        Ggx::new(0.25)?,
        Schlick::new(0.75)?,
        Incidence { normal, incoming },
    );
    let saved_gold = json!({
        "ggx": { "roughness": 0.25 }, "fresnel": { "f0": 0.75 }, "normal": up, "incoming": aside,
    });
    assert_saved(&gold, saved_gold.clone());
    assert_saved(&gold.separable(), saved_gold.clone());
    let light = Vpl::new(Vec3::new(1.0, -2.0, 0.5), 4.0, gold)?;
    let position = [1.0, -2.0, 0.5];
    let saved_light = json!({ "position": position, "flux": 4.0, "lobe": saved_gold });
    assert_saved(&light, saved_light);

    let grain = AnisotropicGgx::new(0.5, 0.125)?;
    let brushed = AnisotropicGgxLobe::new(
        grain,
        NoFresnel,
        Incidence {
            normal,
            incoming: normal,
        },
        incoming,
    )?;
    let saved_brushed = json!({
        "ggx": { "roughness": [0.5, 0.125] }, "fresnel": null,
        "normal": up, "tangent": aside, "incoming": up,
    });
    assert_saved(&brushed, saved_brushed.clone());
    assert_saved(&brushed.separable(), saved_brushed);

    let plastic = json!({ "albedo": 0.5, "exponent": 40.0, "normal": up, "incoming": aside });
    assert_saved(
        &PhongLobe::new(0.5, 40.0, Incidence { normal, incoming })?,
        plastic,
    );
    let lamp = json!({ "inner_angle": 0.25, "outer_angle": 2.0, "axis": up });
    assert_saved(&SpotLobe::new(0.25, 2.0, normal)?, lamp);
    let even = EvenNoise::new(2.0)?.with_range(0.25, 16.0)?;
    assert_saved(&even, json!({ "typical": 2.0, "range": [0.25, 16.0] }));
    assert_saved(&DistanceWindow::new(20.0)?, json!({ "radius": 20.0 }));
    let spot = json!({ "albedo": 0.5, "exponent": 40.0, "normal": up, "incoming": null });
    assert_saved(&PhongLobe::about(0.5, 40.0, normal)?, spot);
    let gaussian = json!({ "axis": up, "sharpness": 40.0, "amplitude": 0.5 });
    assert_saved(&SphericalGaussian::new(normal, 40.0, 0.5)?, gaussian);
    Ok(())
}

#[test]
fn lights_and_cameras_that_no_constructor_accepts_are_not_read() -> Result<(), Error> {
    let lamp = json!({ "position": [0.0, 1e300, 0.0], "flux": 1.0, "lobe": null });
    assert_refused::<Vpl<ConstantLobe>>(lamp, "light position is [0, inf, 0]");
    let dark = json!({ "position": [0.0, 1.0, 0.0], "flux": -1.0, "lobe": null });
    assert_refused::<Vpl<ConstantLobe>>(dark, "flux Φ is -1");
    let up = [0.0, 0.0, 1.0];
    let mirror =
        json!({ "ggx": { "roughness": 0.0 }, "fresnel": null, "normal": up, "incoming": up });
    assert_refused::<GgxLobe>(mirror, "roughness α is 0");
    let bald = json!({
        "ggx": { "roughness": [0.5, 0.125] }, "fresnel": null,
        "normal": up, "tangent": up, "incoming": up,
    });
    assert_refused::<AnisotropicGgxLobe>(bald, "tangent is [0, 0, 1]");
    let blunt = json!({ "albedo": 0.5, "exponent": -1.0, "normal": up, "incoming": up });
    assert_refused::<PhongLobe>(blunt, "Phong exponent is -1");
    let inside_out = json!({ "inner_angle": 2.0, "outer_angle": 0.25, "axis": up });
    assert_refused::<SpotLobe>(inside_out, "inner cone angle is 2");
    let hollow = json!({ "axis": up, "sharpness": 40.0, "amplitude": -0.5 });
    assert_refused::<SphericalGaussian>(hollow, "SG amplitude is -0.5");
    let reversed = json!({ "min": [0.0, 0.0], "max": [1.0, -1.0] });
    assert_refused::<TileRectangle>(reversed, "corner of a tile is [1, -1, 1]");

    let camera = Camera::look_at(Vec3::ONE, Vec3::ZERO, Vec3::Y, 1.0, 1.5, 0.1..100.0)?;
    let saved = serde_json::to_value(camera).unwrap();
    for (field, wrong, reason) in [
        (
            "rotation",
            json!([[1.1, 0.0, 0.0], [0.0, 1.0, 0.0], up]),
            "view matrix is not usable",
        ),
        (
            "translation",
            json!([0.0, 1e300, 0.0]),
            "translation of the view is [0, inf, 0]",
        ),
        (
            "slope_scale",
            json!([300.0, 1.0]),
            "the corners of the view",
        ),
        (
            "slope_offset",
            json!([0.0, 1e300]),
            "the corners of the view",
        ),
        ("depth_numerator", json!(0.0), "near and far planes"),
        ("depth_offset", json!(1e300), "near and far planes"),
    ] {
        let mut broken = saved.clone();
        broken[field] = wrong;
        assert_refused::<Camera>(broken, reason);
    }

    let (eye, up) = (Vec3::ONE, Vec3::Y);
    let camera = Camera::orthographic_look_at(eye, Vec3::ZERO, up, 4.0, 1.5, -1.0..9.0)?;
    let saved = serde_json::to_value(camera).unwrap();
    for (field, wrong, reason) in [
        (
            "rotation",
            json!([[1.1, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]),
            "view matrix is not usable",
        ),
        (
            "translation",
            json!([0.0, 0.0, 1e300]),
            "translation of the view",
        ),
        ("scale", json!([0.0, 1.0]), "width and height"),
        ("offset", json!([0.0, 1e300]), "width and height"),
        ("depth_per_ndc", json!(-1.0), "near and far planes"),
    ] {
        let mut broken = saved.clone();
        broken[field] = wrong;
        assert_refused::<Camera<Orthographic>>(broken, reason);
    }
    // One kind is not read as the other.
    assert!(serde_json::from_value::<Camera>(saved).is_err());
    Ok(())
}

#[test]
fn what_no_constructor_accepts_is_not_read() {
    assert_refused::<Ggx>(json!({ "roughness": 2.0 }), "roughness α is 2, but must be");
    assert_refused::<Ggx>(json!({ "roughness": 1e300 }), "roughness α is inf");
    assert_refused::<Ggx>(json!({}), "missing field `roughness`");
    // What JSON has in the place of NaN.
    assert_refused::<Ggx>(json!({ "roughness": null }), "invalid type: null");
    let rough_across = json!({ "roughness": [0.5, -1.0] });
    assert_refused::<AnisotropicGgx>(rough_across, "roughness α_y is -1");
    assert_refused::<Schlick>(json!({ "f0": 1.5 }), "reflectance F0 is 1.5");
    assert_refused::<Dielectric>(json!({ "relative_index": 0.0 }), "refractive index η is 0");
    let gain = json!({ "index": 1.5, "extinction": -1.0 });
    assert_refused::<Conductor>(gain, "extinction coefficient κ is -1");
    let bright = json!({ "albedo": 1.5, "normal": [0.0, 1.0, 0.0] });
    assert_refused::<LambertLobe>(bright, "albedo is 1.5");
    let nowhere = json!({ "albedo": 0.5, "normal": [0.0, 0.0, 0.0] });
    assert_refused::<LambertLobe>(nowhere, "direction is [0, 0, 0]");
    assert_refused::<Roulette>(json!({ "delta": 0.0 }), "variance parameter δ is 0");
    assert_refused::<Xi>(json!(0.0), "random number ξ is 0");
    assert_refused::<Direction>(json!([0.0, 0.0, 0.0]), "direction is [0, 0, 0]");
    assert_refused::<Direction>(json!([0.0, 1e300, 0.0]), "direction is [0, inf, 0]");
    let backward = json!({ "near": 2.0, "far": 1.0 });
    assert_refused::<DepthInterval>(backward, "far depth is 1");
    let no_tiles = json!({ "image_size": [640, 480], "tile_size": 0 });
    assert_refused::<TileGrid>(no_tiles, "tile size is 0×0");
    let no_image = json!({ "image_size": [0, 480], "width": 1 });
    assert_refused::<Interleave>(no_image, "image size is 0×480");
}

/// A number that JSON cannot write, but other formats can.
#[test]
fn not_a_number_is_not_read() {
    use serde::Deserialize;
    use serde::de::value::{Error, MapDeserializer};

    let map = MapDeserializer::<_, Error>::new([("roughness", f32::NAN)].into_iter());
    let message = Ggx::deserialize(map).unwrap_err().to_string();
    assert!(message.contains("roughness α is NaN"), "{message}");
}

/// Directions that others have written are of unit length once they are read.
#[test]
fn directions_of_any_length_are_read() {
    let read: Direction = serde_json::from_value(json!([0.0, 3.0, 4.0])).unwrap();
    assert_eq!(read, Direction::new(Vec3::new(0.0, 3.0, 4.0)).unwrap());
}

proptest! {
    #![proptest_config(cases(2000))]

    #[test]
    fn materials_come_back(
        roughness in [up_to_one(1e-6), up_to_one(1e-6)],
        f0 in 0.0..=1.0_f32,
        index in log_uniform(1.1e-9, 0.9e9),
        extinction in log_uniform(1.1e-12, 0.9e9),
    ) {
        comes_back(&Ggx::new(roughness[0]).unwrap())?;
        comes_back(&AnisotropicGgx::new(roughness[0], roughness[1]).unwrap())?;
        comes_back(&Schlick::new(f0).unwrap())?;
        comes_back(&Dielectric::new(index as f32).unwrap())?;
        comes_back(&Conductor::new(index as f32, extinction as f32).unwrap())?;
    }

    #[test]
    fn settings_come_back(
        delta in log_uniform(1e-45, 3e38),
        light in any::<u32>(),
        width in 1..64_u32,
        size in [64..5000_u32, 64..5000_u32],
    ) {
        comes_back(&Roulette::new(delta as f32).unwrap())?;
        comes_back(&Seed(0).frame(0).xi(light))?;
        comes_back(&Interleave::new(size, width).unwrap())?;
        comes_back(&TileGrid::new(size, width).unwrap())?;
    }

    /// To the last bit, although a unit vector that is made one again can change.
    #[test]
    fn directions_come_back(vector in generators::unit_vector(), scale in log_uniform(1e-30, 1e30)) {
        let [x, y, z] = vector.0.map(|x| (scale * x) as f32);
        let direction = Direction::new(Vec3::new(x, y, z)).unwrap();
        comes_back(&direction)?;
        comes_back(&-direction)?;
    }

    #[test]
    fn lobes_and_lights_come_back(
        lit in generators::lit(),
        roughness in generators::two_roughnesses(),
        f0 in 0.0..=1.0_f32,
        tangent in generators::unit_vector(),
        exponent in generators::exponent(),
        position in generators::position(),
        flux in log_uniform(1e-38, 1e38),
    ) {
        let (normal, incoming) = (lit.normal, lit.incoming);
        let [along, across] = roughness;
        let (smooth, grain) = (Ggx::new(along).unwrap(), AnisotropicGgx::new(along, across).unwrap());
        let lobe = GgxLobe::new(smooth, Schlick::new(f0).unwrap(), Incidence { normal, incoming });
        comes_back(&Vpl::new(position, flux as f32, lobe).unwrap())?;
        comes_back(&Vpl::new(position, flux as f32, lobe.separable()).unwrap())?;
        let phong = PhongLobe::new(f0, exponent, Incidence { normal, incoming }).unwrap();
        comes_back(&Vpl::new(position, flux as f32, phong).unwrap())?;
        comes_back(&PhongLobe::about(f0, exponent, normal).unwrap())?;
        comes_back(&SpotLobe::new(f0 * along, along, normal).unwrap())?;
        comes_back(&SphericalGaussian::new(normal, exponent, f0).unwrap())?;
        let tangent = Direction::new(tangent.to_f32()).unwrap();
        if let Ok(lobe) = AnisotropicGgxLobe::new(grain, NoFresnel, Incidence { normal, incoming }, tangent) {
            comes_back(&lobe)?;
            comes_back(&lobe.separable())?;
        }
    }

    /// Of either handedness, off-centre and with any depths.
    #[test]
    fn cameras_come_back(view in generators::any_view(), fov in 1e-3..3.1_f32) {
        let camera = AnyCamera::new(view.from_world, view.projection).unwrap();
        comes_back(&camera)?;
        with_camera!(&camera, camera => comes_back(camera))?;
        comes_back(&Camera::look_at(Vec3::ONE, Vec3::ZERO, Vec3::Y, fov, 1.5, 0.1..f32::INFINITY).unwrap())?;
    }
}
