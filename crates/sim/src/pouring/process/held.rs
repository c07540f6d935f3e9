//! A container as the tool of an arm: gripped round its wall from the side.

use nalgebra::{Isometry3, Matrix3, Rotation3, Translation3, UnitQuaternion, Vector3};
use serde::{Deserialize, Serialize};
use skills::field::{FieldError, finite, within};

use crate::pouring::container::Container;
use crate::spatial::{Drawing, DrawnShape, HeldTool, Rgba, TriangleMesh};

/// How a two-finger hand holds a cup: fingers on both sides of the wall, the hand's approach across the axis.
///
/// The gripping frame is that of the hand: z out of the hand, y along the way of the fingers. It lies on the cup's axis.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Grip {
    /// Height of the fingers above the underside of the cup, m; half of the cup's height if absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub height_m: Option<f64>,
    /// Direction in which the hand points: angle about the cup's axis from its lip, rad. At ±π/2 the cup tilts about the
    /// hand's own axis, by the last joint alone.
    pub approach_rad: f64,
    /// Whether the hand is turned half round about its own axis.
    pub flipped: bool,
}

impl Default for Grip {
    fn default() -> Self {
        Self { height_m: None, approach_rad: -std::f64::consts::FRAC_PI_2, flipped: false }
    }
}

impl Grip {
    /// Checks the numbers.
    ///
    /// # Errors
    /// A [`FieldError`] naming the offending value.
    pub fn validate(&self) -> Result<(), FieldError> {
        finite("approach_rad", &[self.approach_rad])?;
        self.height_m.map_or(Ok(()), |height_m| within("height_m", height_m, 0.0, 1.0))
    }

    /// Pose of the cup in the gripping frame, `grip_from_tool`.
    #[must_use]
    pub fn grip_from_cup(&self, cup: &Container) -> Isometry3<f64> {
        let height_m = self.height_m.unwrap_or(0.5 * cup.rim.center_in_container.z);
        let (sin, cos) = self.approach_rad.sin_cos();
        let approach = Vector3::new(cos, sin, 0.0);
        let closing = Vector3::new(sin, -cos, 0.0) * if self.flipped { -1.0 } else { 1.0 };
        let axes = Matrix3::from_columns(&[closing.cross(&approach), closing, approach]);
        let turn = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(axes));
        Isometry3::from_parts(Translation3::new(0.0, 0.0, height_m), turn).inverse()
    }
}

/// A container in the hand, empty: its frame is the tool's. It has no pieces of its own, because
/// [`super::PouringProcess`] lends the container's colliders, with the friction of walls for grains, to the hand.
#[must_use]
pub fn held_container(container: &Container, grip_from_tool: &Isometry3<f64>, color: Rgba) -> HeldTool {
    let mass = container.mass_properties();
    HeldTool {
        name: container.name.clone(),
        mass_kg: mass.mass_kg,
        center_of_mass_m: mass.center_m,
        inertia_kg_m2: mass.inertia_kg_m2,
        grip_from_tool: *grip_from_tool,
        pieces: Vec::new(),
        drawings: vec![container_drawing(container, &Isometry3::identity(), color)],
    }
}

/// How a container looks, placed at `body_from_container`.
#[must_use]
pub fn container_drawing(container: &Container, body_from_container: &Isometry3<f64>, color: Rgba) -> Drawing {
    let mesh = container.looks();
    let mesh = TriangleMesh { vertices: mesh.points, triangles: mesh.triangles, ..TriangleMesh::default() };
    Drawing { shape: DrawnShape::Mesh(mesh), body_from_shape: *body_from_container, color }
}

#[cfg(test)]
mod tests {
    use nalgebra::Point3;

    use super::*;
    use crate::pouring::{ContainerFile, Profile, Straight};

    fn cup() -> Container {
        let file = ContainerFile {
            name: "cup".into(),
            description: String::new(),
            mass_kg: 0.08,
            friction: 0.3,
            restitution: 0.5,
            wall_m: 0.003,
            facets: 32,
            profile: Profile::Straight(Straight { radius_m: 0.035, height_m: 0.09 }),
            spout: None,
        };
        Container::new(&file).unwrap()
    }

    #[test]
    fn the_hand_points_across_the_cup_and_its_fingers_close_along_the_way_of_pouring() {
        let cup = cup();
        for flipped in [false, true] {
            let grip = Grip { flipped, ..Grip::default() };
            let cup_from_grip = grip.grip_from_cup(&cup).inverse();
            // the hand comes from the cup's left, looking along −y; its fingers move along x, the lip's direction
            assert!((cup_from_grip * Vector3::z() + Vector3::y()).norm() < 1e-12);
            assert!((cup_from_grip * Vector3::y()).cross(&Vector3::x()).norm() < 1e-12);
            assert!((cup_from_grip * Point3::origin() - Point3::new(0.0, 0.0, 0.0465)).norm() < 1e-12);
        }
    }

    #[test]
    fn a_held_cup_weighs_what_its_file_states_and_is_round() {
        let held = held_container(&cup(), &Isometry3::identity(), [1.0; 4]);
        assert_eq!(held.mass_kg, 0.08);
        let center = held.center_of_mass_m;
        // a thin wall about its middle and a floor below: a little under half of 93 mm
        assert!(center.x.abs() < 1e-9 && center.y.abs() < 1e-9 && (0.035..0.0465).contains(&center.z), "{center}");
        let inertia = held.inertia_kg_m2;
        assert!((inertia[(0, 0)] / inertia[(1, 1)] - 1.0).abs() < 1e-6, "{inertia}");
        // all mass lies within 38.2 mm of the axis and most of it beyond 35
        assert!(inertia[(2, 2)] < 0.08 * 0.0382_f64.powi(2) && inertia[(2, 2)] > 0.6 * 0.08 * 0.035_f64.powi(2));
        assert!(held.validate().is_ok());
    }
}
