//! Convex pieces of a knife, and the mass they have together.

use nalgebra::{Matrix3, Point3};
use parry3d::math::Vector;
use parry3d::shape::{ConvexPolyhedron, Shape};

/// Corners of a convex piece in the knife's frame, m.
pub type Piece = Vec<Point3<f64>>;

/// Mass of a rigid body and where it lies.
#[derive(Clone, Debug, PartialEq)]
pub struct MassOf {
    /// Mass, kg.
    pub mass_kg: f64,
    /// Center of mass in the knife's frame, m.
    pub center_in_knife: Point3<f64>,
    /// Inertia about the center of mass, axes of the knife, kg m².
    pub inertia_in_knife_kg_m2: Matrix3<f64>,
}

impl MassOf {
    /// Mass of the hull of `piece` at `density_kg_per_m3`; none if the corners span no volume.
    #[must_use]
    pub fn hull(piece: &Piece, density_kg_per_m3: f64) -> Option<Self> {
        let corners: Vec<Vector> = piece.iter().map(|point| Vector::new(point.x, point.y, point.z)).collect();
        let properties = ConvexPolyhedron::from_convex_hull(&corners)?.mass_properties(density_kg_per_m3);
        let center = properties.local_com;
        let inertia = properties.reconstruct_inertia_matrix().to_cols_array();
        let mass_kg = properties.mass();
        (mass_kg.is_finite() && mass_kg > 0.0).then(|| Self {
            mass_kg,
            center_in_knife: Point3::new(center.x, center.y, center.z),
            inertia_in_knife_kg_m2: Matrix3::from_column_slice(&inertia),
        })
    }

    /// Mass of both bodies together, by the parallel-axis theorem.
    #[must_use]
    pub fn and(&self, other: &Self) -> Self {
        let mass_kg = self.mass_kg + other.mass_kg;
        let weighted = self.center_in_knife.coords * self.mass_kg + other.center_in_knife.coords * other.mass_kg;
        let center_in_knife = Point3::from(weighted / mass_kg);
        let about = |body: &Self| {
            let arm = body.center_in_knife - center_in_knife;
            let steiner = Matrix3::identity() * arm.norm_squared() - arm * arm.transpose();
            body.inertia_in_knife_kg_m2 + steiner * body.mass_kg
        };
        Self { mass_kg, center_in_knife, inertia_in_knife_kg_m2: about(self) + about(other) }
    }

    /// The same body at another mass.
    #[must_use]
    pub fn scaled_to(&self, mass_kg: f64) -> Self {
        let inertia_in_knife_kg_m2 = self.inertia_in_knife_kg_m2 * (mass_kg / self.mass_kg);
        Self { mass_kg, center_in_knife: self.center_in_knife, inertia_in_knife_kg_m2 }
    }
}

/// Corners of a box between two opposite ones.
pub(super) fn cuboid(low: [f64; 3], high: [f64; 3]) -> Piece {
    let pick = |corner: usize, axis: usize| if corner >> axis & 1 == 0 { low[axis] } else { high[axis] };
    (0..8).map(|corner| Point3::new(pick(corner, 0), pick(corner, 1), pick(corner, 2))).collect()
}
