//! How well the tool reached and held its goal.

use robot::Manipulator;
use sim::spatial::Episode;

use super::scenario::ReachScenario;
use crate::outcome::{Limit, Measure};
use crate::tasks::spatial::arm_measures;

const MM: f64 = 1e3;
const MRAD: f64 = 1e3;

/// All measures of a run.
pub(super) fn measures(scenario: &ReachScenario, model: &Manipulator, episode: &Episode) -> Vec<Measure> {
    let limits = &scenario.limits;
    let last = episode.samples.last();
    let mut measures = vec![
        Measure::judged(
            "final_tool_error_mm",
            "tool to its goal at the end",
            last.map(|sample| sample.tool_error_m() * MM),
            "mm",
            Limit::AtMost(limits.tool_error_m * MM),
        ),
        Measure::judged(
            "final_tool_angle_error_mrad",
            "turn of the tool to its goal at the end",
            last.map(|sample| sample.tool_angle_error_rad() * MRAD),
            "mrad",
            Limit::AtMost(limits.tool_angle_error_rad * MRAD),
        ),
    ];
    measures.extend(arm_measures(episode, model));
    if let Some(limit_m) = limits.largest_tool_error_m {
        let largest = episode.samples.iter().map(|sample| sample.tool_error_m()).fold(0.0, f64::max);
        measures.retain(|measure| measure.name != "tool_error_max_mm");
        let limit = Limit::AtMost(limit_m * MM);
        measures.push(Measure::judged(
            "tool_error_max_mm",
            "tool to its reference, largest",
            largest * MM,
            "mm",
            limit,
        ));
    }
    measures
}
