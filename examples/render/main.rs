//! The main example: a glossy caustic by stochastic light culling, as pictures and a table.
//!
//! ```text
//! cargo run --release --example render -- --help
//! ```
//!
//! direct light → lit points → lights with their ranges → lists for tiles → shading → denoising,
//! once with each bound, and all lights at once for reference.

mod arguments;
mod look;
mod output;
mod positions;
mod receivers;
mod smooth;

use std::process::ExitCode;

use common::command::{self, say};
use common::finish::Finish;
use common::folder::make_folder;
use common::frame::{self, Frame, Lights, Measured, Reference, Slicing, Tiles, Tiling, timed};
use common::picture::{Exposure, tone_mapped, write_png};
use common::progress::progress;
use common::scene::{self, LitPoints, Scene, SurfaceBuffer, Tracer};
use stochastic_light_culling::{Camera, Error, Interleave, TileGrid, glam::Vec3};

use arguments::{Arguments, Clusters, ReferenceKind};
use output::{Request, Results, Row};

fn main() -> ExitCode {
    command::run(|arguments: Arguments| render(&arguments))
}

/// The whole corridor. Whatever can be refused is, before anything is written.
fn render(arguments: &Arguments) -> Result<(), String> {
    let said = |error: Error| error.to_string();
    let clusters = arguments.smooth()?;
    let interleave = Interleave::new(arguments.size, arguments.interleave).map_err(said)?;
    TileGrid::new(arguments.size, arguments.tile).map_err(said)?;
    let gloss = arguments.gloss().map_err(said)?;
    let wanted = arguments.look.wanted(&arguments.glossy);
    let scene = Scene::load(&arguments.scene, &wanted)?;
    let scene = scene.with_gloss(arguments.alpha, arguments.f0);
    let camera = scene.viewpoint.camera(arguments.size).map_err(said)?;
    let tracer = Tracer::new(&scene.mesh);
    let (surfaces, surfaces_ms) = timed(|| SurfaceBuffer::new(&tracer, &camera, arguments.size));
    positions::check(arguments, &scene, &camera, &surfaces)?;
    make_folder(&arguments.out)?;
    if let Some(note) = &scene.note {
        eprintln!("note: {note}");
    }

    let (points, points_ms) = timed(|| {
        let photons = scene::trace_photons(&tracer, &scene.lamps, arguments.vpls, arguments.seed);
        LitPoints::new(&photons, &scene.mesh.materials, gloss.ggx, gloss.fresnel)
    });
    let points = points.map_err(said)?;
    let lights =
        Lights::new(&points, &interleave, &arguments.delta, arguments.seed).map_err(said)?;
    let [tiles, pixels] = [arguments.tile, 1].map(|size| {
        Tiles::new(
            &surfaces,
            &camera,
            &interleave,
            size,
            Slicing::ModifiedHalfZ,
        )
    });
    let (tiles, pixels) = (tiles.map_err(said)?, pixels.map_err(said)?);
    let tilings =
        [(&tiles, false), (&pixels, true)].map(|(tiles, refined)| Tiling { tiles, refined });
    let frame = Frame {
        surfaces: &surfaces,
        interleave,
        roulette: arguments.delta,
        least_distance_squared: 4.0 * points.footprint,
    };

    let mut steps = vec![("G-buffer".into(), surfaces_ms), ("VPLs".into(), points_ms)];
    let (glossy, diffuse) = if let Some(clusters) = clusters {
        let measured = smooth::measure(arguments, clusters, &frame, &tilings, &camera, &points)?;
        steps.push(("clusters".into(), measured.cluster_ms));
        (measured.glossy, measured.diffuse)
    } else {
        measure(arguments, &frame, &tilings, &camera, &lights)?
    };
    let bounds = glossy
        .iter()
        .filter(|measured| !measured.refined)
        .map(|m| (format!("bound {}", m.bound.name()), m.bound_ms));
    steps.extend(bounds);
    steps.push(("bound diffuse".into(), diffuse.bound_ms));

    let (images, denoise_ms) = timed(|| denoised(arguments, &frame, &glossy, &diffuse));
    steps.push(("denoise".into(), denoise_ms));
    let finish = Finish {
        scene: &scene,
        tracer: &tracer,
        camera: &camera,
        frame: &frame,
        lights: &lights,
        gloss,
        seed: arguments.seed,
    };
    let (finished, finish_ms) = timed(|| finished(&finish, &images));
    steps.push(("finish".into(), finish_ms));
    let finished = finished.map_err(said)?;
    let (reference, reference_ms) = timed(|| reference(arguments, &frame, &lights));
    let reference = reference.map_err(said)?;
    if reference.is_some() {
        steps.push(("reference".into(), reference_ms));
    }

    let view = receivers::View {
        scene: &scene,
        camera: &camera,
        frame: &frame,
        lights: &lights.glossy,
        tiles: [&tiles, &pixels],
        gloss,
    };
    let of_receivers = match clusters {
        Some(_) => Vec::new(),
        None => receivers::measure(arguments, &view)?,
    };

    let picture = tone_mapped(arguments.size, &finished, Exposure::of(&finished));
    write_png(&arguments.out, "picture.png", &picture)?;
    write_pictures(arguments, &frame, &images, &glossy, reference.as_ref())?;
    let (mut glossy, diffuse) = rows(&surfaces, &images, &glossy, &diffuse, reference.as_ref());
    glossy.extend(of_receivers);
    let results = Results {
        glossy,
        diffuse,
        steps,
    };
    report(arguments, clusters, &scene, &results);
    Ok(())
}

/// The rows of the table for glossy lights, and for diffuse ones.
fn rows(
    surfaces: &SurfaceBuffer,
    [glossy_image, diffuse_image]: &[Vec<Vec3>; 2],
    glossy: &[Measured],
    diffuse: &Measured,
    reference: Option<&Reference>,
) -> (Vec<Row>, Row) {
    let error = |image: &[Vec3], of: fn(&Reference) -> &[Vec3]| {
        let reference = reference?;
        let pixels = &reference.pixels;
        Some(frame::rmse(surfaces, image, pixels, of(reference)))
    };
    let glossy_error = error(glossy_image, |reference| &reference.glossy);
    let diffuse_error = error(diffuse_image, |reference| &reference.diffuse);
    let of_glossy = glossy
        .iter()
        .map(|measured| row(surfaces, measured, glossy_error));
    (of_glossy.collect(), row(surfaces, diffuse, diffuse_error))
}

/// The frame by its glossy lights, with each bound asked for, and by its diffuse lights.
fn measure(
    arguments: &Arguments,
    frame: &Frame,
    tilings: &[Tiling; 2],
    camera: &Camera,
    lights: &Lights,
) -> Result<(Vec<Measured>, Measured), String> {
    let said = |error: Error| error.to_string();
    let bounds = arguments.bounds();
    let runs = tilings.len() * bounds.len() + 1;
    let bar = progress("shading", frame.interleaved_rows().len() * runs);
    let done = || bar.inc(1);
    let mut glossy = Vec::new();
    for bound in bounds {
        let lights = &lights.glossy;
        let measured = frame::measure_glossy(frame, tilings, camera, lights, bound, done);
        glossy.extend(measured.map_err(said)?);
    }
    let diffuse = frame::measure_diffuse(frame, &tilings[..1], camera, &lights.diffuse, done);
    let diffuse = diffuse.map_err(said)?.remove(0);
    bar.finish_and_clear();

    // Which lights are accepted does not depend on what encloses them, or a bound has lost one.
    for measured in &glossy[1..] {
        let unlike = measured.shaded.pixels_unlike(&glossy[0].shaded);
        if unlike > 0 {
            let [a, b] = [&glossy[0], measured].map(|measured| measured.bound.name());
            return Err(format!(
                "bounds {a} and {b} light {unlike} pixels differently"
            ));
        }
    }
    Ok((glossy, diffuse))
}

/// The irradiance of glossy and of diffuse lights, without noise if possible.
fn denoised(
    arguments: &Arguments,
    frame: &Frame,
    glossy: &[Measured],
    diffuse: &Measured,
) -> [Vec<Vec3>; 2] {
    let noisy = [&glossy[0], diffuse].map(|measured| &*measured.shaded.irradiance);
    if arguments.no_denoise {
        return noisy.map(<[Vec3]>::to_vec);
    }
    let bar = progress("denoising", arguments.size[1] as usize);
    let images = frame::cross_bilateral(frame.surfaces, noisy, || bar.inc(1));
    bar.finish_and_clear();
    images
}

/// The radiance of the picture that is lit by these glossy and diffuse lights too.
fn finished(finish: &Finish, [glossy, diffuse]: &[Vec<Vec3>; 2]) -> Result<Vec<Vec3>, Error> {
    let both = glossy.iter().zip(diffuse);
    let irradiance: Vec<Vec3> = both.map(|(glossy, diffuse)| glossy + diffuse).collect();
    let bar = progress("finishing", finish.frame.surfaces.image_size[1] as usize);
    let picture = finish.radiance(&irradiance, || bar.inc(1));
    bar.finish_and_clear();
    picture
}

/// The reference of the kind asked for, or of that which can be afforded.
fn reference(
    arguments: &Arguments,
    frame: &Frame,
    lights: &Lights,
) -> Result<Option<Reference>, Error> {
    /// How many lights at how many pixels: half a minute on two cores.
    const BUDGET: f64 = 6e9;
    let all_lights = (lights.glossy.len() + lights.diffuse.len()) as f64;
    let work = frame.surfaces.surfaces.len() as f64 * all_lights;
    let kind = arguments.reference.unwrap_or(if work <= BUDGET {
        ReferenceKind::Full
    } else {
        ReferenceKind::Sampled
    });
    let stride = match kind {
        ReferenceKind::Off => return Ok(None),
        ReferenceKind::Full => 1,
        ReferenceKind::Sampled => {
            sampling_stride((8.0 * work / BUDGET).sqrt(), arguments.interleave)
        }
    };
    let bar = progress("reference", Reference::pixels(frame, stride).len());
    let reference = Reference::new(frame, lights, stride, || bar.inc(1));
    bar.finish_and_clear();
    reference.map(Some)
}

/// The least stride from `least` that meets pixels of all subregions alike.
fn sampling_stride(least: f64, interleave: u32) -> usize {
    fn common_divisor(a: usize, b: usize) -> usize {
        if b == 0 { a } else { common_divisor(b, a % b) }
    }
    let mut stride = (least.ceil() as usize).max(2);
    while common_divisor(stride, interleave as usize) > 1 {
        stride += 1;
    }
    stride
}

fn write_pictures(
    arguments: &Arguments,
    frame: &Frame,
    [glossy_image, diffuse_image]: &[Vec<Vec3>; 2],
    glossy: &[Measured],
    reference: Option<&Reference>,
) -> Result<(), String> {
    let surfaces = &frame.surfaces.surfaces;
    let radiance = |glossy: &[Vec3], diffuse: &[Vec3]| -> Vec<Vec3> {
        let both = glossy.iter().zip(diffuse);
        let seen = surfaces.iter().zip(both);
        seen.map(|(surface, (glossy, diffuse))| surface.reflected(glossy + diffuse))
            .collect()
    };
    let (folder, size) = (&*arguments.out, arguments.size);
    let image = radiance(glossy_image, diffuse_image);
    let exposure = Exposure::of(&image);
    write_png(folder, "indirect.png", &tone_mapped(size, &image, exposure))?;
    for measured in glossy {
        let refined = if measured.refined { "-refined" } else { "" };
        let name = format!("lights-{}{refined}.png", measured.bound.name());
        let map = output::heat_map(size, &measured.shaded.evaluated);
        write_png(folder, &name, &map)?;
    }
    if let Some([glossy, diffuse]) =
        reference.and_then(|reference| reference.images(surfaces.len()))
    {
        let image = radiance(&glossy, &diffuse);
        let picture = tone_mapped(size, &image, exposure);
        write_png(folder, "reference.png", &picture)?;
    }
    Ok(())
}

fn row(surfaces: &SurfaceBuffer, measured: &Measured, rmse: Option<f64>) -> Row {
    let shaded = &measured.shaded;
    Row {
        bound: measured.bound.name(),
        refined: measured.refined,
        lights_per_pixel: frame::mean_over_surfaces(surfaces, &shaded.evaluated),
        contributing_per_pixel: frame::mean_over_surfaces(surfaces, &shaded.contributing),
        cull_ms: measured.cull_ms,
        shade_ms: measured.shade_ms,
        rmse,
    }
}

/// The table on standard output, or on standard error with JSON on standard output.
fn report(arguments: &Arguments, clusters: Option<Clusters>, scene: &Scene, results: &Results) {
    let default = |number: f32| (!scene.has_own_gloss()).then_some(number);
    let request = Request {
        scene: &arguments.scene,
        alpha: arguments
            .alpha
            .map_or(default(0.1), |ggx| Some(ggx.roughness())),
        f0: arguments
            .f0
            .map_or(default(0.9), |fresnel| Some(fresnel.f0())),
        vpls: arguments.vpls,
        clusters,
        delta: arguments.delta.delta(),
        size: arguments.size,
        seed: arguments.seed,
    };
    let table = output::table(&request, results);
    if arguments.json {
        eprintln!("{table}");
        say(format_args!("{}", output::json(&request, results)));
    } else {
        let pictures = arguments.out.display();
        say(format_args!("{table}\n\npictures: {pictures}"));
    }
}
