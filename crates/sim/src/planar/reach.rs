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
