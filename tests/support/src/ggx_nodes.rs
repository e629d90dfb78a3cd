//! A quadrature of GGX lobes over the hemisphere, with height-correlated masking.
//!
//! Light comes from (−√(1−μ²), 0, μ), and the normal is (0, 0, 1).

use std::f64::consts::PI;

/// Nodes along each of two coordinates, of each of two sets, for albedos.
const NODES_OF_ALBEDOS: usize = 64;

/// n_A and f_A: the integrals of the GGX lobe for F = 1 and F = (1 − cosθ_h)⁵.
pub fn albedos(alpha: f64, mu: f64) -> [f64; 2] {
    let mut sums = [0.0; 2];
    for node in nodes(alpha, mu, NODES_OF_ALBEDOS) {
        sums[0] += node.weight * node.value;
        sums[1] += node.weight * node.value * node.grazing;
    }
    sums
}

/// A direction of a quadrature over the hemisphere, half of it, since the lobe is symmetric.
#[derive(Clone, Copy, Debug)]
pub struct Node {
    pub outgoing: [f64; 3],
    pub weight: f64,
    /// The GGX lobe for F = 1.
    pub value: f64,
    /// (1 − cosθ_h)⁵
    pub grazing: f64,
}

/// Two sets of nodes, which follow the visible normals of this roughness and of a four times larger one, with
/// the balance heuristic between them [Veach & Guibas 1995; Dupuy & Benyoub 2023].
pub fn nodes(alpha: f64, mu: f64, count: usize) -> Vec<Node> {
    let sets = [
        Facets::new(alpha, mu),
        Facets::new((4.0 * alpha).min(1.0), mu),
    ];
    let each = 1.0 / (count * count) as f64;
    let mut nodes = Vec::with_capacity(2 * count * count);
    for set in &sets {
        for i in 0..count {
            for j in 0..count {
                let place = [i, j].map(|i| (i as f64 + 0.5) / count as f64);
                let half = set.normal(place);
                let cosine = half[0] * sets[0].incoming[0] + half[2] * sets[0].incoming[2];
                let outgoing =
                    std::array::from_fn(|k| 2.0 * cosine * half[k] - sets[0].incoming[k]);
                if outgoing[2] > 0.0 {
                    let density = sets[0].density(half) + sets[1].density(half);
                    nodes.push(Node {
                        outgoing,
                        weight: each / density,
                        value: sets[0].value(half, outgoing[2]),
                        grazing: (1.0 - cosine).max(0.0).powi(5),
                    });
                }
            }
        }
    }
    nodes
}

/// A GGX microsurface and the direction that light comes from.
struct Facets {
    alpha: f64,
    incoming: [f64; 3],
    /// The incoming direction on the surface stretched to α = 1.
    stretched: [f64; 3],
    /// √((1−α²)μ² + α²)
    root: f64,
}

impl Facets {
    fn new(alpha: f64, mu: f64) -> Self {
        let sine = (1.0 - mu * mu).max(0.0).sqrt();
        let length = (alpha * sine).hypot(mu);
        Self {
            alpha,
            incoming: [-sine, 0.0, mu],
            stretched: [-alpha * sine / length, 0.0, mu / length],
            root: ((1.0 - alpha * alpha) * mu * mu + alpha * alpha).sqrt(),
        }
    }

    /// A visible normal. The first coordinate is denser where normals are far from the peak.
    fn normal(&self, [rare, azimuth]: [f64; 2]) -> [f64; 3] {
        let [x, _, z] = self.stretched;
        let height = rare.powi(3) * (1.0 + z) - z;
        let radius = (1.0 - height * height).max(0.0).sqrt();
        let (sine, cosine) = (PI * azimuth).sin_cos();
        let facet = [
            self.alpha * (radius * cosine + x),
            self.alpha * radius * sine,
            (height + z).max(0.0),
        ];
        let length = facet.iter().map(|x| x * x).sum::<f64>().sqrt();
        facet.map(|x| x / length)
    }

    /// D
    fn ndf(&self, [x, y, z]: [f64; 3]) -> f64 {
        let squared = self.alpha * self.alpha;
        let spread = squared * z * z + x * x + y * y;
        squared / (PI * spread * spread)
    }

    /// The density of directions that these normals reflect to.
    fn density(&self, half: [f64; 3]) -> f64 {
        let facet = [half[0] / self.alpha, half[1] / self.alpha, half[2]];
        let squared: f64 = facet.iter().map(|x| x * x).sum();
        let dot = facet[0] * self.stretched[0] + facet[2] * self.stretched[2];
        let rare_cubed = 2.0 * dot * facet[2] / squared / (1.0 + self.stretched[2]);
        let visible = self.ndf(half) * 0.5 / (self.incoming[2] + self.root);
        visible / (3.0 * rare_cubed.max(1e-300).powf(2.0 / 3.0))
    }

    /// f·μ_o for F = 1.
    fn value(&self, half: [f64; 3], mu_o: f64) -> f64 {
        let (alpha, mu) = (self.alpha, self.incoming[2]);
        let root = ((1.0 - alpha * alpha) * mu_o * mu_o + alpha * alpha).sqrt();
        self.ndf(half) * 0.5 * mu_o / (mu_o * self.root + mu * root)
    }
}
