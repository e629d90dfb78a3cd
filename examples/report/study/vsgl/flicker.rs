//! How a picture of a still scene changes as the light moves.

use stochastic_light_culling::glam::Vec3;

use super::method::{Kind, Setting, Stage};
use super::truth::mean_squared;

/// Of one setting at one roughness.
pub struct Flicker<'a> {
    pub scene: &'a str,
    pub roughness: f32,
    pub setting: Setting,
    /// The root of the mean squared change from frame to frame, over the mean radiance.
    pub change: f64,
    /// That of the second difference, over √6: what noise of one frame would make it.
    pub unsteady: f64,
}

/// How far the light moves in a frame, over its distance.
const STEP: f32 = 1e-3;

/// A setting of each kind, as in the table.
fn settings(is_quick: bool) -> [Setting; 4] {
    let [rays, culled, all] = if is_quick {
        [1 << 11, 64, 64]
    } else {
        [1 << 14, 1 << 12, 1 << 8]
    };
    [
        Setting::points(rays, 1e-3),
        Setting::culled(culled, 1e-3),
        Setting::smooth(Kind::Vsgl, all),
        Setting::smooth(Kind::Kmeans, all),
    ]
}

pub fn measure<'a>(stage: &Stage<'a>) -> Vec<Flicker<'a>> {
    let is_quick = stage.subject.effort.is_quick;
    let of_setting = |setting| {
        let frames: Vec<Vec<Vec3>> = (0..if is_quick { 3_u8 } else { 4 })
            .map(|frame| {
                let moved = f32::from(frame) * STEP;
                stage.light_moved(setting, 0, moved).irradiance
            })
            .collect();
        let pixels: Vec<usize> = (0..frames[0].len()).collect();
        let mean = |squares: Vec<f64>| squares.iter().sum::<f64>() / squares.len() as f64;
        let changes = frames
            .windows(2)
            .map(|pair| mean_squared(stage.subject, &pixels, &pair[0], &pair[1]));
        let bends = frames.windows(3).map(|three| {
            let middle: Vec<Vec3> = (three[0].iter().zip(&three[2]))
                .map(|(a, b)| 0.5 * (a + b))
                .collect();
            // The second difference is twice that from the middle.
            4.0 / 6.0 * mean_squared(stage.subject, &pixels, &middle, &three[1])
        });
        let brightness = stage.subject.brightness(&pixels, &frames[0]);
        Flicker {
            scene: stage.subject.name,
            roughness: stage.gloss.ggx.roughness(),
            setting,
            change: mean(changes.collect()).sqrt() / brightness,
            unsteady: mean(bends.collect()).sqrt() / brightness,
        }
    };
    settings(is_quick).map(of_setting).into()
}
