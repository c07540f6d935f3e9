//! What moves in a spatial scene: links, tool, force, the task's bodies, grains.

use nalgebra::{Isometry3, Vector3};
use rerun::{Arrows3D, Clear, Points3D, RecordingStream, RecordingStreamResult, Transform3D};
use sim::spatial::{BodyDrawing, SceneDescription};

use super::row::Row;
use super::scene::link_path;
use super::shapes::{self, plain, plain_vector};
use crate::recording::curves::part;
use crate::recording::times::{SIM_TIME, STEP, Times};

/// A force of 10 N draws an arrow of a tenth of a meter.
const ARROW_M_PER_N: f64 = 0.01;
/// No arrow is longer than this, m.
const LONGEST_ARROW_M: f64 = 0.4;

/// Poses of one body that wait.
struct Poses {
    path: String,
    translations: Vec<[f32; 3]>,
    quaternions: Vec<rerun::Quaternion>,
}

/// Rows of what moves in the scene.
pub(super) struct Moving {
    links: Vec<Poses>,
    tool: Poses,
    force_origins: Vec<[f32; 3]>,
    forces: Vec<[f32; 3]>,
    bodies: Vec<Poses>,
    /// Number of shapes of each of them.
    body_shapes: Vec<usize>,
    grains: Vec<[f32; 3]>,
    grain_lengths: Vec<usize>,
    has_grains: bool,
    rows: usize,
}

impl Moving {
    /// Room for `rows` rows of `scene`.
    pub(super) fn new(scene: &SceneDescription, rows: usize) -> Self {
        let grains = scene.grains.as_ref().map_or(0, |grains| grains.half_sizes_m.len());
        let links = scene.arm.links.iter().enumerate();
        Self {
            links: links.map(|(index, link)| Poses::new(link_path(index, &link.name), rows)).collect(),
            tool: Poses::new("/world/tool".into(), rows),
            force_origins: Vec::with_capacity(rows),
            forces: Vec::with_capacity(rows),
            bodies: Vec::new(),
            body_shapes: Vec::new(),
            grains: Vec::with_capacity(grains * rows),
            grain_lengths: Vec::with_capacity(rows),
            has_grains: grains > 0,
            rows,
        }
    }

    /// Adds a row.
    pub(super) fn push(&mut self, row: &Row) {
        for (poses, pose) in self.links.iter_mut().zip(&row.links) {
            poses.push(pose);
        }
        self.tool.push(&row.world_from_tool);
        self.force_origins.push(plain_vector(&row.world_from_tool.translation.vector));
        self.forces.push(arrow(&row.tool_wrench.fixed_rows::<3>(0).into_owned()));
        for (poses, pose) in self.bodies.iter_mut().zip(&row.bodies) {
            poses.push(pose);
        }
        if self.has_grains {
            self.grains.extend(row.grain_centers.iter().map(plain));
            self.grain_lengths.push(row.grain_centers.len());
        }
    }

    /// Hands all rows to the stream.
    pub(super) fn send(&mut self, stream: &RecordingStream, times: &Times) -> RecordingStreamResult<()> {
        for poses in self.links.iter().chain(&self.bodies).chain([&self.tool]) {
            poses.send(stream, times)?;
        }
        let force = Arrows3D::update_fields()
            .with_origins(self.force_origins.iter().copied())
            .with_vectors(self.forces.iter().copied());
        stream.send_columns("/world/force", times.columns(), force.columns_of_unit_batches()?)?;
        if self.has_grains {
            let grains = Points3D::update_fields().with_positions(self.grains.iter().copied());
            let columns = grains.columns(self.grain_lengths.iter().copied())?;
            stream.send_columns("/world/grains", times.columns(), columns)?;
        }
        Ok(())
    }

    /// Forgets all rows and keeps their room.
    pub(super) fn clear(&mut self) {
        self.links.iter_mut().chain(&mut self.bodies).chain([&mut self.tool]).for_each(Poses::clear);
        self.force_origins.clear();
        self.forces.clear();
        self.grains.clear();
        self.grain_lengths.clear();
    }

    /// Draws the task's bodies anew from a moment on; those that are gone vanish. No row may wait.
    pub(super) fn change_bodies(
        &mut self,
        stream: &RecordingStream,
        step: i64,
        time_s: f64,
        bodies: &[BodyDrawing],
    ) -> RecordingStreamResult<()> {
        stream.set_time_sequence(STEP, step);
        stream.set_duration_secs(SIM_TIME, time_s);
        let sent = self.draw_bodies(stream, bodies);
        // rows carry their own times
        stream.reset_time();
        sent
    }

    fn draw_bodies(&mut self, stream: &RecordingStream, bodies: &[BodyDrawing]) -> RecordingStreamResult<()> {
        let paths: Vec<String> = bodies.iter().map(|body| format!("/world/bodies/{}", part(&body.name))).collect();
        for (old, drawn) in self.bodies.iter().zip(&self.body_shapes) {
            if !paths.contains(&old.path) {
                stream.log(old.path.as_str(), &Clear::recursive())?;
                continue;
            }
            // what is drawn anew may have fewer shapes, or others; its pose stays
            for index in 0..*drawn {
                stream.log(shapes::shape_path(&old.path, index), &Clear::flat())?;
            }
        }
        for (path, body) in paths.iter().zip(bodies) {
            shapes::send(stream, path, &body.drawings)?;
        }
        self.body_shapes = bodies.iter().map(|body| body.drawings.len()).collect();
        self.bodies = paths.into_iter().map(|path| Poses::new(path, self.rows)).collect();
        Ok(())
    }
}

/// The arrow of a force, in the scene's meters.
fn arrow(force_n: &Vector3<f64>) -> [f32; 3] {
    plain_vector(&(force_n * ARROW_M_PER_N).cap_magnitude(LONGEST_ARROW_M))
}

impl Poses {
    fn new(path: String, rows: usize) -> Self {
        Self { path, translations: Vec::with_capacity(rows), quaternions: Vec::with_capacity(rows) }
    }

    fn push(&mut self, pose: &Isometry3<f64>) {
        self.translations.push(plain_vector(&pose.translation.vector));
        self.quaternions.push(shapes::quaternion(pose));
    }

    fn send(&self, stream: &RecordingStream, times: &Times) -> RecordingStreamResult<()> {
        // a body that has no pose in some row has none in any
        if self.translations.len() != times.len() {
            return Ok(());
        }
        let poses = Transform3D::update_fields()
            .with_many_translation(self.translations.iter().copied())
            .with_many_quaternion(self.quaternions.iter().copied());
        stream.send_columns(self.path.as_str(), times.columns(), poses.columns_of_unit_batches()?)
    }

    fn clear(&mut self) {
        self.translations.clear();
        self.quaternions.clear();
    }
}
