//! The closing table for people.

use super::{Request, Results, Row};

/// The table, as the captions of the paper's Figs. 9 and 10 have it, and the time of the other steps.
pub fn table(request: &Request, results: &Results) -> String {
    let [width, height] = request.size;
    let of = |number: Option<f32>| number.map_or("the file's".into(), |number| number.to_string());
    let mut lines = vec![
        format!(
            "{}, {width}×{height}, {} rays, {}α = {}, F0 = {}, δ = {}",
            request.scene,
            request.vpls,
            clusters(request),
            of(request.alpha),
            of(request.f0),
            request.delta
        ),
        String::new(),
        format!(
            "{:27} {:>12} {:>12} {:>15} {:>10} {:>9} {:>9}",
            "", "lights/pixel", "contributing", "false positives", "RMSE", "cull ms", "shade ms"
        ),
    ];
    let glossy = results.glossy.iter().map(|row| line("glossy", row));
    lines.extend(glossy);
    lines.push(line("diffuse", &results.diffuse));
    lines.push(String::new());
    let steps = results.steps.iter();
    let steps: Vec<String> = steps.map(|(step, ms)| format!("{step} {ms:.1}")).collect();
    lines.push(format!("ms: {}", steps.join(", ")));
    lines.join("\n")
}

fn clusters(request: &Request) -> String {
    let Some(clusters) = request.clusters else {
        return String::new();
    };
    format!("{} clusters by {}, ", clusters.count, clusters.name())
}

fn line(kind: &str, row: &Row) -> String {
    let rmse = row
        .rmse
        .map_or_else(|| "–".into(), |rmse| format!("{rmse:.5}"));
    let refined = if row.refined { ", refined" } else { "" };
    format!(
        "{:27} {:>12.1} {:>12.1} {:>15.1} {rmse:>10} {:>9.1} {:>9.1}",
        format!("{kind}, {}{refined}", row.bound),
        row.lights_per_pixel,
        row.contributing_per_pixel,
        row.false_positives_per_pixel(),
        row.cull_ms,
        row.shade_ms,
    )
}
