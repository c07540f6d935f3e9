//! What comparisons tell of a two-level plan: phases, changes of contact, jumps inside phases, unreachable segments.

use serde::Serialize;

use super::{SAME_HEADING_RAD, Segment, TwoLevelPlan};

/// A run of segments that one surface pushes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Phase {
    /// Index of the contact surface in the tool's list.
    pub surface: usize,
    /// Index of its first segment.
    pub first: usize,
    /// Number of its segments.
    pub segments: usize,
}

/// A row of the paper's Table 2.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct TwoLevelMeasures {
    /// Maximal runs of one surface.
    pub phases: usize,
    /// Changes of surface.
    pub switches: usize,
    /// Trajectory points at which the contact is chosen anew, start and goal included: straight runs + 1.
    pub trajectory_points: usize,
    /// Joints inside a phase at which the pose of the tool jumps: its place on the surface or its angle changes.
    pub pose_jumps: usize,
    /// Joints inside a phase at which the direction of motion jumps by more than a degree.
    pub heading_jumps: usize,
    /// Segments that the tool cannot push along.
    pub unreachable: usize,
}

impl TwoLevelMeasures {
    /// Whether the tool's trajectory is continuous with its velocity inside every phase.
    #[must_use]
    pub fn is_continuous(&self) -> bool {
        self.pose_jumps == 0 && self.heading_jumps == 0
    }
}

/// Poses that differ by less are one, m and rad.
const SAME_POSE: f64 = 1e-6;

impl TwoLevelPlan {
    /// Maximal runs of one surface, in their order.
    #[must_use]
    pub fn phases(&self) -> Vec<Phase> {
        let mut phases: Vec<Phase> = Vec::new();
        for (first, segment) in self.segments.iter().enumerate() {
            match phases.last_mut() {
                Some(phase) if phase.surface == segment.hold.surface => phase.segments += 1,
                _ => phases.push(Phase { surface: segment.hold.surface, first, segments: 1 }),
            }
        }
        phases
    }

    /// The measures of the plan.
    #[must_use]
    pub fn measures(&self) -> TwoLevelMeasures {
        let phases = self.phases().len();
        let joints = || self.segments.windows(2).map(|pair| (&pair[0], &pair[1]));
        let inside = || joints().filter(|(before, after)| before.hold.surface == after.hold.surface);
        TwoLevelMeasures {
            phases,
            switches: phases.saturating_sub(1),
            trajectory_points: joints().filter(turns).count() + 2,
            pose_jumps: inside().filter(pose_jumps).count(),
            heading_jumps: inside().filter(turns).count(),
            unreachable: self.segments.iter().filter(|segment| segment.obstruction.is_some()).count(),
        }
    }
}

fn turns((before, after): &(&Segment, &Segment)) -> bool {
    let way = |segment: &Segment| segment.to_world - segment.from_world;
    way(before).angle(&way(after)) > SAME_HEADING_RAD
}

fn pose_jumps((before, after): &(&Segment, &Segment)) -> bool {
    let gap = before.hold.world_from_tool_end.inverse() * after.hold.world_from_tool_start;
    gap.translation.vector.norm() > SAME_POSE || gap.rotation.angle().abs() > SAME_POSE
}
