//! Cutting a demonstration into pushes and the ways between them, by what object and tool do.
//!
//! The paper divides and aligns its demonstrations by hand; here a push is a run of rows in which the object moves, and
//! its contact surface is the one nearest to the object. Pushes with the same surface that follow each other are one
//! push with a new hold in between. Begin and end of a push are known to about the width of the smoothing: a push that
//! sets in or ends at once is found within 0.1 s.

use nalgebra::Point2;

use crate::demonstration::Aligned;
use crate::outline::Outline;
use crate::tool::Tool;

/// Rows of an aligned demonstration in which one contact surface moves the object.
#[derive(Clone, Debug, PartialEq)]
pub struct PushFragment {
    /// Index of the contact surface.
    pub surface: usize,
    /// Runs of rows (first, one past the last) in which the object moves; more than one if the hold was renewed.
    pub runs: Vec<(usize, usize)>,
}

/// The object moves while it is faster than this share of its usual speed under a push; it stops below half of it.
const MOVING_SHARE: f64 = 0.4;
/// Slowest push that can be told from the camera's noise, m/s.
const SLOWEST_PUSH_M_PER_S: f64 = 0.004;
/// Motions shorter than this are nudges, not pushes, m.
const SHORTEST_PUSH_M: f64 = 0.004;
/// The object is at the tool while they are nearer than this, m: camera bias and smoothing.
const AT_TOOL_M: f64 = 0.006;

impl PushFragment {
    /// First row of the push.
    #[must_use]
    pub fn first(&self) -> usize {
        self.runs.first().map_or(0, |run| run.0)
    }

    /// One past the last row of the push.
    #[must_use]
    pub fn end(&self) -> usize {
        self.runs.last().map_or(0, |run| run.1)
    }

    /// Places of the object while it moves, the waits for a new hold cut out.
    #[must_use]
    pub fn object_path(&self, aligned: &Aligned) -> Vec<Point2<f64>> {
        self.runs.iter().filter_map(|&(from, to)| aligned.object.get(from..to)).flatten().copied().collect()
    }
}

/// Finds the pushes of a demonstration with `tool` on an object of outline `object`, in their order.
#[must_use]
pub fn pushes(aligned: &Aligned, tool: &Tool, object: &Outline) -> Vec<PushFragment> {
    let at_tool: Vec<bool> = aligned
        .tool
        .iter()
        .zip(&aligned.object)
        .map(|(pose, center)| {
            let gap = tool.signed_distance_m(&pose.inverse_transform_point(center)) - object.radius_m();
            gap < AT_TOOL_M
        })
        .collect();
    let mut fragments: Vec<PushFragment> = Vec::new();
    for run in moving_runs(&aligned.object_speed_m_per_s(), &at_tool) {
        let way = aligned.object.get(run.0).zip(aligned.object.get(run.1 - 1)).map_or(0.0, |(a, b)| (b - a).norm());
        let Some(surface) = surface_of_run(aligned, tool, run).filter(|_| way >= SHORTEST_PUSH_M) else { continue };
        match fragments.last_mut() {
            Some(last) if last.surface == surface => last.runs.push(run),
            _ => fragments.push(PushFragment { surface, runs: vec![run] }),
        }
    }
    fragments
}

/// Runs of rows in which the object moves at the tool, with hysteresis.
fn moving_runs(speed: &[f64], at_tool: &[bool]) -> Vec<(usize, usize)> {
    let mut under_tool: Vec<f64> = speed.iter().zip(at_tool).filter(|(_, at)| **at).map(|(speed, _)| *speed).collect();
    under_tool.sort_by(f64::total_cmp);
    // the upper quartile is a usual pushing speed even if the tool rests at the object for half of the time
    let usual = under_tool.get(under_tool.len() * 3 / 4).copied().unwrap_or(0.0);
    let start = (MOVING_SHARE * usual).max(SLOWEST_PUSH_M_PER_S);
    let mut runs = Vec::new();
    let mut begun = None;
    for (row, (speed, at)) in speed.iter().zip(at_tool).enumerate() {
        match begun {
            None if *speed > start && *at => begun = Some(row),
            Some(first) if *speed < start / 2.0 || !at => {
                runs.push((first, row));
                begun = None;
            }
            _ => {}
        }
    }
    runs.extend(begun.map(|first| (first, speed.len())));
    runs
}

/// The surface nearest to the object in most rows of a run.
fn surface_of_run(aligned: &Aligned, tool: &Tool, run: (usize, usize)) -> Option<usize> {
    let mut votes = vec![0_usize; tool.surfaces.len()];
    for (pose, center) in aligned.tool.get(run.0..run.1)?.iter().zip(aligned.object.get(run.0..run.1)?) {
        let (surface, _) = tool.nearest_surface(&pose.inverse_transform_point(center))?;
        if let Some(vote) = votes.get_mut(surface) {
            *vote += 1;
        }
    }
    votes.iter().enumerate().max_by_key(|(_, votes)| **votes).map(|(surface, _)| surface)
}
