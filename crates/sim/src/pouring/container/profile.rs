//! The meridian of a hollow of revolution: its radius over height.

use nalgebra::Point3;

/// Radius over height, piecewise linear, from the floor to the rim.
#[derive(Clone, Debug)]
pub(crate) struct Meridian {
    /// Height and radius, m, from the floor up.
    corners: Vec<(f64, f64)>,
}

impl Meridian {
    /// A meridian of at least two corners of rising height.
    pub(super) fn new(corners: Vec<(f64, f64)>) -> Self {
        assert!(corners.len() >= 2, "a meridian has a floor and a rim");
        Self { corners }
    }

    /// Its straight parts: (height, radius) below and above.
    pub(super) fn parts(&self) -> impl Iterator<Item = ((f64, f64), (f64, f64))> + Clone + '_ {
        self.corners.iter().copied().zip(self.corners.iter().copied().skip(1))
    }

    /// Height of the inner floor, m.
    pub(crate) fn floor_m(&self) -> f64 {
        self.corners.first().map_or(0.0, |corner| corner.0)
    }

    /// Height of the rim, m.
    pub(crate) fn top_m(&self) -> f64 {
        self.corners.last().map_or(0.0, |corner| corner.0)
    }

    /// Radius at the floor, m.
    pub(crate) fn floor_radius_m(&self) -> f64 {
        self.corners.first().map_or(0.0, |corner| corner.1)
    }

    /// Radius at the rim, m.
    pub(crate) fn mouth_radius_m(&self) -> f64 {
        self.corners.last().map_or(0.0, |corner| corner.1)
    }

    /// The least radius, m.
    pub(crate) fn least_radius_m(&self) -> f64 {
        self.corners.iter().map(|corner| corner.1).fold(f64::INFINITY, f64::min)
    }

    /// Whether a point lies between floor and rim and within the radius there.
    pub(crate) fn contains(&self, point: &Point3<f64>) -> bool {
        let distance_squared = point.x * point.x + point.y * point.y;
        self.parts().any(|((z0, r0), (z1, r1))| {
            let radius = r0 + (r1 - r0) * (point.z - z0) / (z1 - z0);
            (z0..=z1).contains(&point.z) && distance_squared <= radius * radius
        })
    }

    /// Volume between the floor and height `z_m`, m³: a sum of frusta.
    pub(crate) fn volume_m3(&self, z_m: f64) -> f64 {
        let frustum = |((z0, r0), (z1, r1)): ((f64, f64), (f64, f64))| {
            let height = (z_m.min(z1) - z0).max(0.0);
            let top = r0 + (r1 - r0) * height / (z1 - z0);
            std::f64::consts::PI * height / 3.0 * (r0 * r0 + r0 * top + top * top)
        };
        self.parts().map(frustum).sum()
    }
}
