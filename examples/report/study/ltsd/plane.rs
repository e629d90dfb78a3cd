//! A plane below a point light [Xia et al. 2023, Fig. 3].

use stochastic_light_culling::{
    Camera, Direction, GgxLobe, Incidence, LtcLobe, Schlick, glam::Vec3,
};

use super::model::Model;
use super::{Study, relative_l2, rmse};
use crate::figure::{Axis, Figure, Line, Look, Panel, Point, Series};
use crate::sheet::Sheet;
use crate::subject::{Effort, Gloss};

const ROUGHNESSES: [f32; 8] = [0.05, 0.1, 0.2, 0.3, 0.4, 0.6, 0.8, 1.0];
/// The metal's comes first.
const REFLECTANCES: [f32; 2] = [0.9, 0.04];
/// A light of 1 W/sr.
const LIGHT: Vec3 = Vec3::new(0.0, 1.0, 0.0);
const EYE: Vec3 = Vec3::new(0.0, 2.0, 2.0);

pub fn make(effort: &Effort) -> Study {
    let size = if effort.is_quick {
        [80, 60]
    } else {
        [800, 600]
    };
    let mut sheet = Sheet::new(&["alpha", "rmse"]);
    let mut summary = Sheet::new(&["f0", "alpha", "rmse", "largest radiance", "relative_l2"]);
    let mut series = Vec::new();
    for (color, f0) in REFLECTANCES.into_iter().enumerate() {
        let mut points = Vec::new();
        for alpha in ROUGHNESSES {
            let gloss = Gloss::new(alpha, f0);
            let ggx = picture::<GgxLobe<Schlick>>(gloss, size);
            let ltc = picture::<LtcLobe>(gloss, size);
            let error = rmse(ltc.iter().zip(&ggx), 1.0);
            let largest = ggx.iter().flatten().copied().fold(0.0, f32::max);
            points.push(Point::new(f64::from(alpha), error));
            summary.push([
                f0.into(),
                alpha.into(),
                error.into(),
                largest.into(),
                relative_l2(ltc.iter().zip(&ggx)).into(),
            ]);
            if color == 0 {
                sheet.push([alpha.into(), error.into()]);
            }
        }
        series.push(Series {
            name: format!("F0 = {f0}"),
            look: Look {
                color,
                line: Line::Solid,
            },
            points,
        });
    }
    Study {
        name: "ltsd_plane",
        caption: "A plane, a point light of 1 W/sr one unit above it, and an eye at 45°. The root mean \
                  squared error of the picture by transformed cosines, of linear values up to 1, for F0 = 0.9 \
                  in the file. The last column is over the whole range of radiances.",
        sheet,
        summary: Some(summary),
        picture: None,
        figure: Figure {
            title: "Transformed cosines against GGX: a plane".into(),
            subtitle: format!("{}×{}", size[0], size[1]),
            panels: vec![Panel {
                title: "one point light".into(),
                x: Axis::log("roughness α"),
                y: Axis::log("RMSE"),
                series,
            }],
        },
    }
}

/// The radiance of each pixel.
fn picture<M: Model>(gloss: Gloss, size: [u32; 2]) -> Vec<[f32; 3]> {
    let aspect = size[0] as f32 / size[1] as f32;
    let camera = Camera::look_at(EYE, Vec3::ZERO, Vec3::Y, 0.8, aspect, 0.1..100.0)
        .expect("the numbers are in range");
    let to_world = camera.rotation().transpose();
    let (rows, columns) = (0..size[1], 0..size[0]);
    rows.flat_map(|y| columns.clone().map(move |x| [x, y]))
        .map(|pixel| {
            let ray = to_world * camera.point_in_pixel(size, pixel, 1.0);
            // The whole picture is below the horizon.
            let point = EYE - ray * (EYE.y / ray.y);
            let incidence = Incidence {
                normal: Direction::Y,
                incoming: Direction::new(EYE - point).expect("it is above the plane"),
            };
            let way = LIGHT - point;
            let lobe = M::new(gloss, incidence);
            [lobe.value(way.normalize()) / way.length_squared(); 3]
        })
        .collect()
}
