//! What a run leaves behind: pictures, a table and JSON.

use clap::ValueEnum;

mod heat_map;
mod json;
mod table;

use crate::arguments::Clusters;

pub use heat_map::heat_map;
pub use json::json;
pub use table::table;

/// What one bound came to.
pub struct Row {
    pub bound: &'static str,
    /// Whether lights were culled by pixels, not by tiles.
    pub refined: bool,
    pub lights_per_pixel: f64,
    pub contributing_per_pixel: f64,
    pub cull_ms: f64,
    pub shade_ms: f64,
    /// None without a reference.
    pub rmse: Option<f64>,
}

impl Row {
    pub fn false_positives_per_pixel(&self) -> f64 {
        self.lights_per_pixel - self.contributing_per_pixel
    }
}

/// What a run was asked for.
pub struct Request<'a> {
    pub scene: &'a str,
    /// None if materials have their own, as with `f0`.
    pub alpha: Option<f32>,
    pub f0: Option<f32>,
    pub vpls: u32,
    /// None for points.
    pub clusters: Option<Clusters>,
    pub delta: f32,
    pub size: [u32; 2],
    pub seed: u32,
}

impl Clusters {
    /// As the command line has it.
    fn name(&self) -> String {
        let value = self.clustering.to_possible_value();
        value.map_or_else(String::new, |value| value.get_name().into())
    }
}

/// What came of it.
pub struct Results {
    pub glossy: Vec<Row>,
    pub diffuse: Row,
    /// The time of each step that is not in a row, in ms, in order.
    pub steps: Vec<(String, f64)>,
}
