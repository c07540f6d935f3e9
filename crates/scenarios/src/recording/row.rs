//! One row of a recording: a sample copied into memory of its own, and which samples become rows.

use nalgebra::{Isometry2, Point2, Vector2};
use sim::planar::{ContactForce, Party, Sample, SceneDescription};

/// Contacts for which there is room from the start.
const CONTACTS: usize = 64;

/// A sample in memory of its own, with the largest forces since the row before.
#[derive(Clone, Debug)]
pub(super) struct Row {
    pub(super) step: u64,
    pub(super) time_s: f64,
    pub(super) phase: usize,
    pub(super) world_from_tool: Isometry2<f64>,
    pub(super) world_from_tool_reference: Isometry2<f64>,
    pub(super) world_from_object: Isometry2<f64>,
    pub(super) world_from_object_expected: Isometry2<f64>,
    pub(super) world_from_object_seen: Option<Isometry2<f64>>,
    pub(super) object_believed_world: Option<Point2<f64>>,
    pub(super) q_rad: Vec<f64>,
    pub(super) dq_rad_per_s: Vec<f64>,
    pub(super) q_reference_rad: Vec<f64>,
    pub(super) torque_nm: Vec<f64>,
    pub(super) joint_points_world: Vec<Point2<f64>>,
    pub(super) contacts: Vec<ContactForce>,
    /// Largest force of the tool on the object since the row before, N.
    pub(super) push_peak_n: f64,
    /// Largest sum of the obstacles' forces on object and tool since the row before, N.
    pub(super) obstacle_peak_n: f64,
    /// Whether something was copied that no row holds yet.
    pub(super) waits: bool,
}

impl Row {
    /// An empty row with room for the arm of `scene`.
    pub(super) fn new(scene: &SceneDescription) -> Self {
        let joints = || Vec::with_capacity(scene.arm.joints.len());
        Self {
            step: 0,
            time_s: 0.0,
            phase: 0,
            world_from_tool: Isometry2::identity(),
            world_from_tool_reference: Isometry2::identity(),
            world_from_object: Isometry2::identity(),
            world_from_object_expected: Isometry2::identity(),
            world_from_object_seen: None,
            object_believed_world: None,
            q_rad: joints(),
            dq_rad_per_s: joints(),
            q_reference_rad: joints(),
            torque_nm: joints(),
            joint_points_world: Vec::with_capacity(scene.arm.joints.len() + 2),
            contacts: Vec::with_capacity(CONTACTS),
            push_peak_n: 0.0,
            obstacle_peak_n: 0.0,
            waits: false,
        }
    }

    /// Copies a sample; forces grow until [`Row::written`].
    pub(super) fn copy(&mut self, sample: &Sample<'_>) {
        self.step = sample.step;
        self.time_s = sample.time_s;
        self.phase = sample.phase;
        self.world_from_tool = sample.world_from_tool;
        self.world_from_tool_reference = sample.world_from_tool_reference;
        self.world_from_object = sample.world_from_object;
        self.world_from_object_expected = sample.world_from_object_expected;
        self.world_from_object_seen = sample.world_from_object_seen;
        self.object_believed_world = sample.object_believed_world;
        replace(&mut self.q_rad, sample.q_rad);
        replace(&mut self.dq_rad_per_s, sample.dq_rad_per_s);
        replace(&mut self.q_reference_rad, sample.q_reference_rad);
        replace(&mut self.torque_nm, sample.torque_nm);
        replace(&mut self.joint_points_world, sample.joint_points_world);
        replace(&mut self.contacts, sample.contacts);
        self.push_peak_n = self.push_peak_n.max(push_force_n(sample.contacts));
        self.obstacle_peak_n = self.obstacle_peak_n.max(obstacle_force_n(sample.contacts));
        self.waits = true;
    }

    /// Marks the row as written: the forces of the next one begin anew.
    pub(super) fn written(&mut self) {
        self.push_peak_n = 0.0;
        self.obstacle_peak_n = 0.0;
        self.waits = false;
    }
}

fn replace<T: Copy>(memory: &mut Vec<T>, values: &[T]) {
    memory.clear();
    memory.extend_from_slice(values);
}

fn push_force_n(contacts: &[ContactForce]) -> f64 {
    let forces = contacts.iter().filter_map(|contact| contact.force_on_n(Party::Object, Party::Tool));
    forces.sum::<Vector2<f64>>().norm()
}

fn obstacle_force_n(contacts: &[ContactForce]) -> f64 {
    let touches = |contact: &&ContactForce| contact.parties.iter().any(|party| matches!(party, Party::Obstacle(_)));
    contacts.iter().filter(touches).map(|contact| contact.force_world_n.norm()).sum()
}

/// Chooses the samples that become rows.
#[derive(Clone, Copy, Debug)]
pub(super) struct Decimator {
    every: u64,
}

impl Decimator {
    /// About `rate_hz` rows per second out of one sample per `control_period_s`, but never more rows than samples.
    pub(super) fn new(rate_hz: f64, control_period_s: f64) -> Self {
        let samples = (1.0 / (rate_hz * control_period_s)).round();
        // casts saturate: a rate of zero keeps the first sample and the last
        Self { every: if samples.is_nan() { 1 } else { (samples as u64).max(1) } }
    }

    /// Whether the sample of this control step becomes a row.
    pub(super) fn wants(self, step: u64) -> bool {
        step.is_multiple_of(self.every)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tenth_of_the_samples_becomes_rows() {
        let decimator = Decimator::new(100.0, 0.001);
        assert_eq!((0..1000).filter(|step| decimator.wants(*step)).count(), 100);
    }

    #[test]
    fn a_rate_above_that_of_the_samples_keeps_all_and_zero_the_first() {
        let count = |rate: f64| (0..50).filter(|step| Decimator::new(rate, 0.001).wants(*step)).count();
        assert_eq!((count(1e6), count(0.0), count(f64::NAN)), (50, 1, 50));
    }
}
