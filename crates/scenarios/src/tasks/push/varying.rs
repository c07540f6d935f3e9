//! What is really there in a run that differs from its scenario, and what is told of it.

use nalgebra::{Isometry2, Vector2};
use sim::planar::ObjectConfig;
use skills::tool::Tool;

use super::{ResolvedPush, Variation, VariationConfig};
use crate::outcome::Measure;

/// Object and tool as they are, not as planner and controller believe them to be.
pub struct Actual {
    /// The object.
    pub object: ObjectConfig,
    /// Where it starts.
    pub world_from_object: Isometry2<f64>,
    /// The tool.
    pub tool: Tool,
    drawn: Variation,
}

impl Actual {
    /// What is there in the run of a scenario with `seed`.
    pub fn new(push: &ResolvedPush, seed: u64) -> Self {
        let drawn = push.scenario.variation.draw(seed);
        let mut object = push.scenario.object.clone();
        object.mass_kg *= drawn.mass;
        object.table_friction *= drawn.table_friction;
        let mut tool = push.tool.clone();
        tool.friction *= drawn.tool_friction;
        for friction in tool.surfaces.iter_mut().filter_map(|surface| surface.friction.as_mut()) {
            *friction *= drawn.tool_friction;
        }
        let config = push.scenario.push();
        let start = Vector2::from(config.start_m) + Vector2::from(drawn.start_m);
        Self { object, world_from_object: Isometry2::new(start, config.start_angle_rad), tool, drawn }
    }

    /// What differs, as far as `config` lets it.
    pub fn measures(&self, config: &VariationConfig) -> Vec<Measure> {
        let [x_mm, y_mm] = self.drawn.start_m.map(|offset_m| offset_m * 1e3);
        let (table, tool) = (self.object.table_friction, self.tool.friction);
        let differs = |bound: f64, name: &str, label: &str, value: f64, unit: &str| {
            (bound > 0.0).then(|| Measure::reported(name, label, value, unit))
        };
        [
            differs(
                config.table_friction_share,
                "varied_table_friction",
                "friction of the table, as drawn",
                table,
                "1",
            ),
            differs(config.tool_friction_share, "varied_tool_friction", "friction of the tool, as drawn", tool, "1"),
            differs(config.mass_share, "varied_mass_g", "mass of the object, as drawn", self.object.mass_kg * 1e3, "g"),
            differs(config.start_m, "varied_start_x_mm", "start of the object off its place, x", x_mm, "mm"),
            differs(config.start_m, "varied_start_y_mm", "start of the object off its place, y", y_mm, "mm"),
        ]
        .into_iter()
        .flatten()
        .collect()
    }
}
