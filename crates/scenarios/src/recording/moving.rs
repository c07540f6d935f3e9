//! What moves in the scene: poses of tool and object, the arm, what the camera sees, contacts, the current action.

use nalgebra::{Isometry2, Vector2};
use rerun::{Arrows2D, LineStrips2D, Points2D, RecordingStream, RecordingStreamResult, Transform3D};
use sim::planar::SceneDescription;

use super::row::Row;
use super::scene;
use super::shapes::{self, plain};
use super::times::Times;

/// The object's own friction on the table draws an arrow as long as this share of the map's width.
const FORCE_SHARE: f64 = 0.15;

/// No arrow is longer than this share of the map's width.
const LONGEST_SHARE: f64 = 0.4;

/// Half size of the mark for what the camera sees, as a share of the object's radius.
const SEEN_SHARE: f64 = 0.4;

/// Poses of one body that wait.
struct Poses {
    path: &'static str,
    translations: Vec<[f32; 3]>,
    quaternions: Vec<[f32; 4]>,
}

/// Rows of what moves in the scene.
pub(super) struct Moving {
    object: Poses,
    tool: Poses,
    arm: Vec<[f32; 2]>,
    arm_lengths: Vec<usize>,
    seen: Vec<[[f32; 2]; 2]>,
    seen_lengths: Vec<usize>,
    contact_points: Vec<[f32; 2]>,
    contact_forces: Vec<[f32; 2]>,
    contact_lengths: Vec<usize>,
    phases: Phases,
    seen_half_m: f64,
    arrow_m_per_n: f64,
    longest_m: f64,
}

/// Actions that began.
struct Phases {
    names: Vec<String>,
    place: [f32; 2],
    current: Option<usize>,
    times: Times,
    begun: Vec<usize>,
}

impl Moving {
    /// Room for `rows` rows of `scene`.
    pub(super) fn new(scene: &SceneDescription, rows: usize) -> Self {
        let map = &scene.world.map;
        let width_m = scene::width_m(map);
        let friction_n = scene.object.mass_kg * scene.world.gravity_m_per_s2 * scene.object.table_friction.max(0.01);
        Self {
            object: Poses::new("/plane/object", rows),
            tool: Poses::new("/plane/tool", rows),
            arm: Vec::with_capacity(rows * (scene.arm.joints.len() + 2)),
            arm_lengths: Vec::with_capacity(rows),
            seen: Vec::with_capacity(2 * rows),
            seen_lengths: Vec::with_capacity(rows),
            contact_points: Vec::with_capacity(4 * rows),
            contact_forces: Vec::with_capacity(4 * rows),
            contact_lengths: Vec::with_capacity(rows),
            phases: Phases {
                names: scene.phases.clone(),
                place: [(map.min_m[0] + 0.5 * width_m) as f32, (map.max_m[1] + 0.03 * width_m) as f32],
                current: None,
                times: Times::default(),
                begun: Vec::new(),
            },
            seen_half_m: SEEN_SHARE * scene.object.shape.radius_m(),
            arrow_m_per_n: FORCE_SHARE * width_m / friction_n,
            longest_m: LONGEST_SHARE * width_m,
        }
    }

    /// Adds a row.
    pub(super) fn push(&mut self, row: &Row) {
        self.object.push(&row.world_from_object);
        self.tool.push(&row.world_from_tool);
        self.arm.extend(row.joint_points_world.iter().map(plain));
        self.arm_lengths.push(row.joint_points_world.len());
        let seen = row.world_from_object_seen.map(|pose| shapes::cross(&pose, self.seen_half_m));
        self.seen.extend(seen.iter().flatten());
        self.seen_lengths.push(seen.map_or(0, |strokes| strokes.len()));
        for contact in &row.contacts {
            self.contact_points.push(plain(&contact.point_world));
            self.contact_forces.push(self.arrow(&contact.force_world_n));
        }
        self.contact_lengths.push(row.contacts.len());
        self.phases.push(row);
    }

    /// The arrow of a force, in the scene's meters.
    fn arrow(&self, force_n: &Vector2<f64>) -> [f32; 2] {
        let arrow = (force_n * self.arrow_m_per_n).cap_magnitude(self.longest_m);
        [arrow.x as f32, arrow.y as f32]
    }

    /// Hands all rows to the stream.
    pub(super) fn send(&mut self, stream: &RecordingStream, times: &Times) -> RecordingStreamResult<()> {
        self.object.send(stream, times)?;
        self.tool.send(stream, times)?;
        self.send_arm(stream, times)?;
        let seen = LineStrips2D::update_fields().with_strips(self.seen.iter().copied());
        stream.send_columns("/plane/seen", times.columns(), seen.columns(self.seen_lengths.iter().copied())?)?;
        let lengths = || self.contact_lengths.iter().copied();
        let points = Points2D::update_fields().with_positions(self.contact_points.iter().copied());
        stream.send_columns("/plane/contacts", times.columns(), points.columns(lengths())?)?;
        let forces = Arrows2D::update_fields()
            .with_origins(self.contact_points.iter().copied())
            .with_vectors(self.contact_forces.iter().copied());
        stream.send_columns("/plane/contacts/forces", times.columns(), forces.columns(lengths())?)?;
        self.phases.hand_over(stream)
    }

    fn send_arm(&self, stream: &RecordingStream, times: &Times) -> RecordingStreamResult<()> {
        let mut rest = self.arm.as_slice();
        let links = self.arm_lengths.iter().map(|length| {
            let (points, others) = rest.split_at_checked(*length).unwrap_or((rest, &[]));
            rest = others;
            points.to_vec()
        });
        let links = LineStrips2D::update_fields().with_strips(links.collect::<Vec<_>>());
        stream.send_columns("/plane/arm", times.columns(), links.columns_of_unit_batches()?)?;
        let joints = Points2D::update_fields().with_positions(self.arm.iter().copied());
        stream.send_columns("/plane/arm/joints", times.columns(), joints.columns(self.arm_lengths.iter().copied())?)
    }

    /// Forgets all rows and keeps their room.
    pub(super) fn clear(&mut self) {
        self.object.clear();
        self.tool.clear();
        self.arm.clear();
        self.arm_lengths.clear();
        self.seen.clear();
        self.seen_lengths.clear();
        self.contact_points.clear();
        self.contact_forces.clear();
        self.contact_lengths.clear();
    }
}

impl Poses {
    fn new(path: &'static str, rows: usize) -> Self {
        Self { path, translations: Vec::with_capacity(rows), quaternions: Vec::with_capacity(rows) }
    }

    fn push(&mut self, pose: &Isometry2<f64>) {
        let (sin, cos) = (0.5 * pose.rotation.angle()).sin_cos();
        self.translations.push([pose.translation.x as f32, pose.translation.y as f32, 0.0]);
        self.quaternions.push([0.0, 0.0, sin as f32, cos as f32]);
    }

    fn send(&self, stream: &RecordingStream, times: &Times) -> RecordingStreamResult<()> {
        let poses = Transform3D::update_fields()
            .with_many_translation(self.translations.iter().copied())
            .with_many_quaternion(self.quaternions.iter().map(|xyzw| rerun::Quaternion::from_xyzw(*xyzw)));
        stream.send_columns(self.path, times.columns(), poses.columns_of_unit_batches()?)
    }

    fn clear(&mut self) {
        self.translations.clear();
        self.quaternions.clear();
    }
}

impl Phases {
    fn push(&mut self, row: &Row) {
        if self.current != Some(row.phase) {
            self.current = Some(row.phase);
            self.times.push(row.step, row.time_s);
            self.begun.push(row.phase);
        }
    }

    fn label(&self, phase: usize) -> String {
        let name = self.names.get(phase).map_or("?", String::as_str);
        format!("action {} of {}: {name}", phase + 1, self.names.len())
    }

    fn hand_over(&mut self, stream: &RecordingStream) -> RecordingStreamResult<()> {
        if self.begun.is_empty() {
            return Ok(());
        }
        let labels: Vec<_> = self.begun.iter().map(|phase| self.label(*phase)).collect();
        let texts = Points2D::update_fields().with_positions(labels.iter().map(|_| self.place)).with_labels(labels);
        stream.send_columns("/plane/phase", self.times.columns(), texts.columns_of_unit_batches()?)?;
        self.times.clear();
        self.begun.clear();
        Ok(())
    }
}
