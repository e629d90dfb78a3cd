//! Frames to look at.

use common::picture::{Exposure, tone_mapped};
use image::{RgbImage, imageops};

use super::method::{Kind, Setting, Stage};
use super::{F0, roughnesses};
use crate::subject::{Gloss, Subject};

/// A row for each of the lowest roughnesses: points, smooth lights, those culled, and those of k-means.
pub fn make(subject: &Subject) -> RgbImage {
    let effort = &subject.effort;
    let [rays, count] = if effort.is_quick {
        [1 << 11, 64]
    } else {
        [1 << 14, 1024]
    };
    let settings = [
        Setting::points(rays, 1e-4),
        Setting::smooth(Kind::Vsgl, count),
        Setting::culled(4 * count, 1e-4),
        Setting::smooth(Kind::Kmeans, count),
    ];
    let lowest = roughnesses(effort);
    let lowest = &lowest[lowest.len().saturating_sub(3)..];
    let [width, height] = effort.size;
    let mut picture = RgbImage::new(settings.len() as u32 * width, lowest.len() as u32 * height);
    for (row, roughness) in (0..).zip(lowest) {
        let stage = Stage::new(subject, Gloss::new(*roughness, F0));
        let mut exposure = None;
        for (column, setting) in (0..).zip(settings) {
            let radiance = subject.radiance(&stage.light(setting, 0).irradiance);
            let exposure = *exposure.get_or_insert_with(|| Exposure::of(&radiance));
            let image = tone_mapped([width, height], &radiance, exposure);
            let place = [column * width, row * height].map(i64::from);
            imageops::replace(&mut picture, &image, place[0], place[1]);
        }
    }
    picture
}
