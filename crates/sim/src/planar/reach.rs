//! Where an arm can hold its tool: inverse kinematics on a grid of poses, asked when needed and remembered.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::fmt;

use nalgebra::{DVector, Isometry2};
use robot::{InverseKinematics, InverseKinematicsOptions, Manipulator, TaskRows};
use skills::transfer::Reach;

use super::simulation::in_base;
use crate::error::SimError;

/// Distance of two places of the grid, m.
const GRID_M: f64 = 0.005;
/// Angles of a tool that are told apart, rad; holds of one tool differ by less than a degree.
const ANGLE_RAD: f64 = 0.01;
/// Steps and attempts of one solution: what is not found from a neighbor's posture soon is out of reach.
const STEPS: usize = 60;
const RESTARTS: usize = 2;

/// Reach of an arm: a pose counts as reached if the four poses of the grid around it are.
pub struct ArmReach {
    model: Manipulator,
    solver: RefCell<Solver>,
}

struct Solver {
    kinematics: InverseKinematics,
    /// Posture of the last pose that was reached: the next one is mostly near it.
    posture: DVector<f64>,
    known: BTreeMap<[i64; 3], bool>,
}

impl ArmReach {
    /// Prepares to ask where `model` can hold its frame `flange`.
    ///
    /// # Errors
    /// A [`SimError`] if the arm has no such frame.
    pub fn new(model: &Manipulator, flange: &str) -> Result<Self, SimError> {
        let options = InverseKinematicsOptions {
            steps: STEPS,
            restarts: RESTARTS,
            position_tolerance_m: 1e-6,
            angle_tolerance_rad: 1e-6,
            ..InverseKinematicsOptions::default()
        };
        let kinematics = InverseKinematics::new(model, model.frame(flange)?, TaskRows::PlanarPose, options)?;
        let middle = model.joints().iter().map(|joint| joint.limits.clamp(0.0));
        let posture = DVector::from_iterator(model.joint_count(), middle);
        Ok(Self { model: model.clone(), solver: RefCell::new(Solver { kinematics, posture, known: BTreeMap::new() }) })
    }

    fn is_reached(&self, node: [i64; 3]) -> bool {
        let mut solver = self.solver.borrow_mut();
        if let Some(reached) = solver.known.get(&node) {
            return *reached;
        }
        let [x, y, angle] = node.map(|index| index as f64);
        let pose = Isometry2::new(nalgebra::Vector2::new(x * GRID_M, y * GRID_M), angle * ANGLE_RAD);
        let start = solver.posture.clone();
        let solution = solver.kinematics.solve(&in_base(&self.model, &pose), &start);
        let reached = solution.is_ok();
        if let Ok(solution) = solution {
            solver.posture = solution.q;
        }
        solver.known.insert(node, reached);
        reached
    }
}

impl fmt::Debug for ArmReach {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let known = self.solver.try_borrow().map_or(0, |solver| solver.known.len());
        formatter.debug_struct("ArmReach").field("known_poses", &known).finish_non_exhaustive()
    }
}

impl Reach for ArmReach {
    fn holds(&self, world_from_tool: &Isometry2<f64>) -> bool {
        let (place, angle) = (world_from_tool.translation.vector / GRID_M, world_from_tool.rotation.angle());
        let angle = (angle / ANGLE_RAD).round() as i64;
        let corner =
            |offset: [f64; 2]| [(place.x.floor() + offset[0]) as i64, (place.y.floor() + offset[1]) as i64, angle];
        [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]].into_iter().all(|offset| self.is_reached(corner(offset)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Links of 240, 220 and 60 mm, the base at the origin, the flange along +y at angle 0.
    fn reach() -> ArmReach {
        let model = Manipulator::from_urdf_str(include_str!("../../../../assets/robots/planar_3r.urdf")).unwrap();
        ArmReach::new(&model, "flange").unwrap()
    }

    fn pose(x: f64, y: f64, angle_rad: f64) -> Isometry2<f64> {
        Isometry2::new(nalgebra::Vector2::new(x, y), angle_rad)
    }

    #[test]
    fn the_wrist_reaches_as_far_as_two_links_and_no_farther() {
        let reach = reach();
        // the wrist is 60 mm behind the flange and reaches 460 mm
        assert!(reach.holds(&pose(0.10, 0.36, 0.0)) && reach.holds(&pose(0.0, 0.505, 0.0)));
        assert!(!reach.holds(&pose(0.0, 0.53, 0.0)));
        // turned back, the same place is out of reach of the wrist
        assert!(!reach.holds(&pose(0.0, 0.43, std::f64::consts::PI)));
    }

    #[test]
    fn a_place_counts_only_if_all_places_of_the_grid_around_it_do() {
        let reach = reach();
        // between a row that is reached and one that is not: the stretched arm ends at 520 mm
        assert!(!reach.holds(&pose(0.0, 0.522, 0.0)));
        assert_eq!(reach.holds(&pose(0.101, 0.361, 0.0)), reach.holds(&pose(0.104, 0.364, 0.004)));
    }

    #[test]
    fn what_was_asked_once_is_remembered() {
        let reach = reach();
        reach.holds(&pose(0.102, 0.362, 0.0));
        let known = reach.solver.borrow().known.len();
        assert_eq!(known, 4);
        reach.holds(&pose(0.103, 0.363, 0.001));
        assert_eq!(reach.solver.borrow().known.len(), known);
        assert!(format!("{reach:?}").contains("known_poses: 4"));
    }
}
