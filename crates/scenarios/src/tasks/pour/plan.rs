//! Plans of a pour: by the skill of choice, certified against the containers as they collide, within the arm's reach.

use sim::pouring::VesselClearance;
use skills::pouring::{Fill, PourPlan, PourSkill, PourTask as Asked};
use skills::spatial::certified_clearance;

use super::config::PourSkillKind;
use super::vessel::{standing, upright};
use super::{Planned, PourTask, held, refused};
use crate::tasks::StageError;
use crate::tasks::spatial::{Aim, HeldArm};

/// Distance within which a certificate meets what is sampled, m.
const RESOLUTION_M: f64 = 5e-4;

/// Plans the pour of a scenario.
pub(super) fn plan(task: &PourTask<'_>, skill: &PourSkill) -> Result<Planned, StageError> {
    let (file, vessels) = (task.file(), task.pour);
    let config = file.pour();
    let drawn = file.variation.draw(task.seed);
    let world_from_target = standing(drawn.place_m(file.target.place_m));
    let mouth = vessels.target.mouth(&world_from_target);
    let asked = Asked {
        start: upright(config.start_m, config.start_angle_rad, &mouth.center_world),
        source: vessels.source.cup(),
        fill: Fill {
            height_m: vessels.source.fill_height_m(file.grains.fill, &file.grains.bean),
            stability_rad: file.grains.stability_rad,
            grain_m: file.grains.bean.diameter_m,
            rolling_friction: file.grains.bean.rolling_friction,
        },
        mouth,
        direction_rad: None,
        options: config.options.clone(),
    };
    let clearance = VesselClearance::new(&vessels.source.container, &vessels.target.container, &world_from_target);
    let (pour, clearance_m) = match config.skill {
        PourSkillKind::Constrained => {
            let pour = skill.plan(&asked).map_err(refused)?;
            let clearance_m = certified(&pour, &clearance, config.options.least_clearance_m)?;
            (pour, Some(clearance_m))
        }
        PourSkillKind::PlainDmp => (skill.plain_dmp(&asked).map_err(refused)?, None),
    };
    let tool = held(vessels);
    let arm = HeldArm::new(&task.scenario.arm, &file.robot, &tool, task.seed)?;
    let remedy = "move the container nearer, or turn the cup in the hand (source.grip)";
    let aim = Aim { task: super::KIND.name, arm: &file.robot.asset, held: "the underside of the cup", remedy };
    let ready = arm.ready(&pour.plan, &file.controller, &file.engine.arm(), &aim)?;
    Ok(Planned { pour, ready, tool, world_from_target, clearance_m, drawn })
}

/// Certifies that cup and target, as they collide, keep clear of each other in the whole plan, m.
fn certified(pour: &PourPlan, vessels: &VesselClearance, least_m: f64) -> Result<f64, StageError> {
    let mut smallest_m = f64::INFINITY;
    let actions = pour.plan.actions();
    // the last action is the first one backward
    for action in actions.iter().take(actions.len().saturating_sub(1)) {
        let found = certified_clearance(&action.track, vessels.reach_m(), RESOLUTION_M, least_m, |pose| {
            vessels.distance_m(pose)
        });
        if found.bound_m < least_m {
            return Err(StageError::Infeasible(format!(
                "plan pour: in '{}' the cup comes within {:.4} m of the target at {:.2} s; expected at least {least_m} m; \
                 raise task.pour.options.margin_m or gap_m",
                action.name, found.sampled_m, found.at_s
            )));
        }
        smallest_m = smallest_m.min(found.bound_m);
    }
    Ok(smallest_m)
}
