//! The flips of Figs. 6 and 9: what was shown with the stick, what is asked of the L-shaped tool, and how a way is measured.

use nalgebra::{DMatrix, DVector, Isometry2, Point2, Rotation2, Vector2};
use skills::demonstration::Demonstration;
use skills::outline::{Outline, separation_m};
use skills::segmentation::pushes;
use skills::tool::Tool;
use skills::tool_flipping::{FlipTask, ShownFlip, ToolFlip};
use skills::{Dmp, DmpConfig, MovementPrimitive, RolloutRequest, Trajectory};

use super::{Study, StudyError};

/// Duration of a flip, s, and samples along it.
const DURATION_S: f64 = 2.0;
pub const SAMPLES: usize = 201;
/// Clearance of the virtual object movement, m: what the human keeps beyond it is the tool's own way.
pub const MARGIN_M: f64 = 0.0035;
/// Radius of the object in the paper's Fig. 6, m: 1.5, where Table 1 has 1.2 (cm).
pub const FIGURE_RADIUS_M: f64 = 0.015;

/// Flips as they were shown, each over its own clock.
pub struct ShownFlips {
    /// Poses of the stick between its two pushes, world frame.
    pub tool_world: Vec<Vec<Isometry2<f64>>>,
    /// Where the object rested meanwhile.
    pub object_world: Vec<Point2<f64>>,
}

/// Skills of the same demonstrations.
pub struct FlipSkills {
    /// Divided into the tool's own way and a virtual object movement, Prop. 2.
    pub divided: ToolFlip,
    /// One primitive of the tool's pose relative to the object.
    pub classic: Dmp,
}

impl ShownFlips {
    /// The ways between the two pushes of all demonstrations.
    pub fn of(study: &Study<'_>) -> Result<Self, StudyError> {
        let scenario = study.push;
        let mut shown = Self { tool_world: Vec::new(), object_world: Vec::new() };
        for demonstration in &study.run()?.demonstrations {
            let aligned = Demonstration::aligned(demonstration);
            let fragments = pushes(&aligned, &scenario.demonstration_tool, &scenario.scenario.object.shape);
            let [first, second, ..] = fragments.as_slice() else { continue };
            let rows = first.end().saturating_sub(1)..second.first() + 1;
            let Some(poses) = aligned.tool.get(rows.clone()).filter(|poses| poses.len() > 1) else { continue };
            let places = aligned.object.get(rows).unwrap_or_default();
            let sum: Vector2<f64> = places.iter().map(|place| place.coords).sum();
            shown.object_world.push(Point2::from(sum / places.len().max(1) as f64));
            shown.tool_world.push(poses.to_vec());
        }
        Ok(shown)
    }

    /// Learns both skills.
    pub fn learn(&self, tool: &Tool, object: &Outline) -> Result<FlipSkills, StudyError> {
        let mut flips = Vec::new();
        let mut paths = Vec::new();
        for (poses, center) in self.tool_world.iter().zip(&self.object_world) {
            let (Some(first), Some(last)) = (poses.first(), poses.last()) else { continue };
            let contact = |pose: &Isometry2<f64>| {
                let place = pose.inverse_transform_point(center);
                let nearest = tool.nearest_surface(&place).and_then(|(index, _)| tool.surfaces.get(index));
                nearest.map(|surface| surface.nearest(&place))
            };
            let (Some(before), Some(after)) = (contact(first), contact(last)) else { continue };
            flips.push(ShownFlip {
                tool,
                object,
                object_world: Isometry2::translation(center.x, center.y),
                tool_world: poses,
                contacts: [before, after],
            });
            let relative =
                poses.iter().map(|pose| (pose.translation.vector - center.coords).push(pose.rotation.angle()));
            let columns: Vec<_> = relative.collect();
            let samples = DMatrix::from_fn(columns.len(), 3, |row, column| columns[row][column]);
            paths.push(Trajectory::uniform(DURATION_S / (columns.len() - 1) as f64, samples)?);
        }
        Ok(FlipSkills {
            divided: ToolFlip::learn(&DmpConfig::default(), &flips, MARGIN_M)?,
            classic: Dmp::learn(&DmpConfig::default(), &paths)?,
        })
    }
}

/// A flip that is asked for: how it is called, and its task.
pub struct Asked<'a> {
    /// Angles on the object, and their reading.
    pub name: String,
    /// Surfaces from and to.
    pub surfaces: String,
    /// The task.
    pub task: FlipTask<'a>,
}

/// Fig. 6(c), (d): first and last angle on the object at which the tool touches it, "1/3 rad" read as such and as π/3 rad
/// (the π may be lost in print), for both flips of the L-shaped tool.
pub fn asked<'a>(tool: &'a Tool, object: &'a Outline) -> Vec<Asked<'a>> {
    let mut all = Vec::new();
    for (unit_rad, unit) in [(1.0, ""), (std::f64::consts::PI, "π")] {
        for (angles, (letter, first)) in
            [([1.0 / 3.0, -1.0 / 3.0], ("c", "1/3")), ([1.0 / 12.0, -1.0 / 3.0], ("d", "1/12"))]
        {
            for pair in tool.surfaces.windows(2) {
                let [from, to] = pair else { continue };
                let mut task = FlipTask {
                    tool,
                    object,
                    object_world: Isometry2::identity(),
                    contacts: [from.middle(), to.middle()],
                    tool_angles_rad: [0.0; 2],
                    duration_s: DURATION_S,
                };
                for (index, on_object) in angles.into_iter().enumerate() {
                    let normal = task.contacts[index].normal;
                    // a contact at angle φ of the object pushes along φ + π
                    let touched_rad = normal.y.atan2(normal.x) - std::f64::consts::PI;
                    task.tool_angles_rad[index] = on_object * unit_rad - touched_rad;
                }
                // the shorter turn of the tool
                let [first_rad, second_rad] = task.tool_angles_rad;
                task.tool_angles_rad[1] = first_rad + Rotation2::new(second_rad - first_rad).angle();
                all.push(Asked {
                    name: format!("({letter}) {first}{unit} to −1/3{unit} rad"),
                    surfaces: format!("{} to {}", from.name, to.name),
                    task,
                });
            }
        }
    }
    all
}

/// Poses along a flip, evenly in time.
pub fn poses(flip: &skills::tool_flipping::Flip) -> Vec<Isometry2<f64>> {
    let at = |index: usize| flip.duration_s() * index as f64 / (SAMPLES - 1) as f64;
    (0..SAMPLES).map(|index| flip.tool_in_world(at(index)).pose()).collect()
}

/// The classic primitive from pose to pose about an object at the origin.
pub fn classic(skill: &Dmp, from: &Isometry2<f64>, to: &Isometry2<f64>) -> Result<Vec<Isometry2<f64>>, StudyError> {
    let turn = (from.rotation.inverse() * to.rotation).angle();
    let angle = from.rotation.angle();
    let vector = |pose: &Isometry2<f64>, angle: f64| {
        DVector::from_column_slice(&[pose.translation.x, pose.translation.y, angle])
    };
    let step_s = DURATION_S / (SAMPLES - 1) as f64;
    let request = RolloutRequest::new(vector(from, angle), vector(to, angle + turn), DURATION_S, step_s);
    let rollout = skill.rollout(&request)?.into_positions();
    Ok(rollout.samples().row_iter().map(|row| Isometry2::new(Vector2::new(row[0], row[1]), row[2])).collect())
}

/// Least clearance of the tool along poses about an object at the origin, m, and the index of the pose with it.
pub fn clearance_m(task: &FlipTask<'_>, poses: &[Isometry2<f64>]) -> (f64, usize) {
    let at = |pose: &Isometry2<f64>| {
        let pieces = task.tool.pieces.iter();
        let gaps = pieces
            .filter_map(|piece| separation_m(&piece.shape, &(pose * piece.pose()), task.object, &task.object_world));
        gaps.fold(f64::INFINITY, f64::min)
    };
    let all = poses.iter().enumerate().map(|(index, pose)| (at(pose), index));
    all.min_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or((f64::INFINITY, 0))
}

/// Larger extent of the grip's places along x and y, m.
pub fn range_m(poses: &[Isometry2<f64>]) -> f64 {
    let places = poses.iter().map(|pose| pose.translation.vector);
    let low = places.clone().fold(Vector2::repeat(f64::INFINITY), |low, place| low.inf(&place));
    let high = places.fold(Vector2::repeat(f64::NEG_INFINITY), |high, place| high.sup(&place));
    (high - low).max()
}
