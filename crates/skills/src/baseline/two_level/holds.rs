//! Holds that can push along a segment, and the choice among them along a path.

use nalgebra::{Isometry2, Point2, UnitComplex, Vector2};

use super::{Hold, Obstruction, Segment, ToolTurning, TwoLevelConfig, TwoLevelProblem};
use crate::outline::separation_m;
use crate::tool::Contact;

/// Distance between two looks along a segment, m: the clearance changes no faster than the tool moves.
const LOOK_M: f64 = 0.002;

/// The holds that push along a segment; if none does, those that face it best, with what is in their way.
pub(super) fn offers(
    config: &TwoLevelConfig,
    problem: &TwoLevelProblem<'_>,
    from: &Point2<f64>,
    to: &Point2<f64>,
) -> Vec<Segment> {
    let push_angle_rad = config.push_angle_rad(problem.tool);
    let mut offers = Vec::new();
    for (surface, shape) in problem.tool.surfaces.iter().enumerate() {
        for index in 0..config.places {
            // evenly over the usable part, each in the middle of its share
            let place_m = shape.length_m() * ((index as f64 + 0.5) / config.places as f64 - 0.5);
            let hold = hold(config, problem, (surface, shape.contact_at(place_m), place_m), (from, to));
            let obstruction = if hold.angle_rad > push_angle_rad {
                Some(Obstruction::Heading { least_rad: hold.angle_rad })
            } else {
                problem.obstruction(&hold, config.clearance_m)
            };
            offers.push(Segment { from_world: *from, to_world: *to, hold, obstruction });
        }
    }
    if offers.iter().any(|offer| offer.obstruction.is_none()) {
        offers.retain(|offer| offer.obstruction.is_none());
    } else {
        name_what_is_missing(&mut offers);
    }
    offers
}

/// Normals that differ by less face a segment alike, rad.
const ALIKE_RAD: f64 = 1e-9;

/// Leaves the offers that face the segment best, with the reason why no other pushes either: barred poses if a surface
/// faces along it, else the least angle.
fn name_what_is_missing(offers: &mut Vec<Segment>) {
    let mut barred = offers.iter().filter_map(|offer| offer.obstruction);
    let barred = barred.find(|reason| !matches!(reason, Obstruction::Heading { .. }));
    let least_rad = offers.iter().map(|offer| offer.hold.angle_rad).fold(f64::INFINITY, f64::min);
    let reason = barred.unwrap_or(Obstruction::Heading { least_rad });
    offers.retain(|offer| offer.hold.angle_rad <= least_rad + ALIKE_RAD);
    offers.iter_mut().for_each(|offer| offer.obstruction = Some(reason));
}

fn hold(
    config: &TwoLevelConfig,
    problem: &TwoLevelProblem<'_>,
    (surface, contact, place_m): (usize, Contact, f64),
    (from, to): (&Point2<f64>, &Point2<f64>),
) -> Hold {
    let heading: Vector2<f64> = to - from;
    let normal = contact.normal.into_inner();
    let tool_rad = match config.turning {
        ToolTurning::Fixed { angle_rad } => angle_rad,
        ToolTurning::WithHeading => normal.perp(&heading).atan2(normal.dot(&heading)),
    };
    let pose = |center| problem.tool.pose_touching(&contact, center, problem.object_radius_m, 0.0, tool_rad);
    Hold {
        surface,
        place_m,
        angle_rad: (UnitComplex::new(tool_rad) * normal).angle(&heading),
        world_from_tool_start: pose(from),
        world_from_tool_end: pose(to),
    }
}

impl TwoLevelProblem<'_> {
    /// What keeps the tool from going along with a hold; it moves straight, without turning.
    fn obstruction(&self, hold: &Hold, clearance_m: f64) -> Option<Obstruction> {
        let (start, end) = (hold.world_from_tool_start, hold.world_from_tool_end);
        let (from, to) = (start.translation.vector, end.translation.vector);
        if [from, to].iter().any(|origin| !self.is_in_workspace(origin)) {
            return Some(Obstruction::Workspace);
        }
        let looks = ((to - from).norm() / LOOK_M).ceil().max(1.0) as usize;
        let half_look_m = (to - from).norm() / looks as f64 / 2.0;
        let is_clear = |look: usize| {
            let at = from + (to - from) * (look as f64 / looks as f64);
            self.clearance_m(&Isometry2::from_parts(at.into(), start.rotation)) >= clearance_m + half_look_m
        };
        (!(0..=looks).all(is_clear)).then_some(Obstruction::Obstacle)
    }

    fn is_in_workspace(&self, origin: &Vector2<f64>) -> bool {
        self.workspace_m.is_none_or(|(min, max)| (0..2).all(|axis| (min[axis]..=max[axis]).contains(&origin[axis])))
    }

    fn clearance_m(&self, world_from_tool: &Isometry2<f64>) -> f64 {
        let pieces = self.tool.pieces.iter().flat_map(|piece| self.obstacles.iter().map(move |other| (piece, other)));
        pieces
            .filter_map(|(piece, other)| {
                separation_m(&piece.shape, &(world_from_tool * piece.pose()), &other.shape, &other.pose())
            })
            .fold(f64::INFINITY, f64::min)
    }
}

/// Cost of a way through the offers: changes of surface, changes of place, sum of squared angles.
type Cost = (usize, usize, f64);

/// One offer per segment with the least cost, compared from left to right.
pub(super) fn fewest_changes(offers: &[Vec<Segment>]) -> Vec<Segment> {
    let own = |offer: &Segment| (0, 0, offer.hold.angle_rad.powi(2));
    let mut costs: Vec<Vec<Cost>> = Vec::with_capacity(offers.len());
    let mut befores: Vec<Vec<usize>> = Vec::with_capacity(offers.len());
    for (index, here) in offers.iter().enumerate() {
        let earlier = index.checked_sub(1).and_then(|before| offers.get(before).zip(costs.get(before)));
        let reached = here.iter().map(|offer| match earlier {
            None => (own(offer), 0),
            Some((before, costs)) => {
                let steps =
                    before.iter().zip(costs).map(|(from, cost)| sum(*cost, sum(change(from, offer), own(offer))));
                steps
                    .enumerate()
                    .map(|(from, cost)| (cost, from))
                    .min_by(|a, b| compare(&a.0, &b.0))
                    .unwrap_or((own(offer), 0))
            }
        });
        let (cost, before) = reached.unzip();
        costs.push(cost);
        befores.push(before);
    }
    let last = costs.last().into_iter().flatten().enumerate().min_by(|a, b| compare(a.1, b.1));
    let mut at = last.map_or(0, |(best, _)| best);
    let mut chosen = Vec::with_capacity(offers.len());
    for (here, before) in offers.iter().zip(&befores).rev() {
        chosen.extend(here.get(at));
        at = before.get(at).copied().unwrap_or(0);
    }
    chosen.reverse();
    chosen
}

fn change(from: &Segment, to: &Segment) -> Cost {
    let is_other_surface = from.hold.surface != to.hold.surface;
    let is_other_place = is_other_surface || from.hold.place_m.total_cmp(&to.hold.place_m).is_ne();
    (usize::from(is_other_surface), usize::from(is_other_place), 0.0)
}

fn sum(a: Cost, b: Cost) -> Cost {
    (a.0 + b.0, a.1 + b.1, a.2 + b.2)
}

fn compare(a: &Cost, b: &Cost) -> std::cmp::Ordering {
    (a.0, a.1).cmp(&(b.0, b.1)).then(a.2.total_cmp(&b.2))
}
