//! One JSON object for scripts.

use serde_json::{Value, json};

use super::{Request, Results, Row};

/// The object, on one line.
pub fn json(request: &Request, results: &Results) -> String {
    let methods: Vec<Value> = results.glossy.iter().map(row).collect();
    json!({
        "scene": request.scene,
        "alpha": request.alpha.map(as_typed),
        "f0": request.f0.map(as_typed),
        "vpls": request.vpls,
        "delta": as_typed(request.delta),
        "size": request.size,
        "seed": request.seed,
        "methods": methods,
        "diffuse": row(&results.diffuse),
        "lights": if request.clusters.is_some() { "vsgl" } else { "vpl" },
        "clusters": request.clusters.map(|clusters| clusters.count),
        "clustering": request.clusters.map(|clusters| clusters.name()),
    })
    .to_string()
}

fn row(row: &Row) -> Value {
    json!({
        "bound": row.bound,
        "refined": row.refined,
        "lights_per_pixel": row.lights_per_pixel,
        "contributing_per_pixel": row.contributing_per_pixel,
        "false_positives_per_pixel": row.false_positives_per_pixel(),
        "cull_ms": row.cull_ms,
        "shade_ms": row.shade_ms,
        "rmse": row.rmse,
    })
}

/// The shortest decimal number that means this `f32`: 0.1, not 0.10000000149.
fn as_typed(number: f32) -> f64 {
    number.to_string().parse().unwrap_or(f64::from(number))
}
