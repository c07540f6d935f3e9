//! Forces on the elements of an edge and of the flanks behind it, and their sums.

use nalgebra::{Point2, Vector2};

use super::config::Board;
use super::flank_grip::{FlankFriction, FlankGrip};
use super::front::Front;
use super::giving::{Elasticity, Giving};
use super::grid::SectionGrid;
use super::law::Dent;
use super::motion::EdgeMotion;

/// A force in the section's plane and its moment about the knife's origin.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct PlanarWrench {
    pub force: Vector2<f64>,
    pub moment: f64,
}

impl PlanarWrench {
    pub(super) fn add(&mut self, force: Vector2<f64>, at: Point2<f64>, motion: &EdgeMotion) {
        self.force += force;
        self.moment += (at - motion.position).perp(&force);
    }

    /// Power of the wrench on the moving knife, W.
    pub(super) fn power(&self, motion: &EdgeMotion) -> f64 {
        self.force.dot(&motion.velocity_in_section.xy()) + self.moment * motion.angular_velocity_in_section.z
    }
}

/// Forces that oppose motion, bounded as one so that a step cannot reverse it.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Opposing {
    wrench: PlanarWrench,
    /// Sum of force by speed, N s/m: the damping that a step sees.
    damping: f64,
}

impl Opposing {
    /// Adds a force of size `strength` against `direction` (of length one) at a point; `damping` (N s/m) is what a step sees of
    /// it, by the speed of that point.
    pub(super) fn add(
        &mut self,
        strength: f64,
        direction: Vector2<f64>,
        damping: f64,
        at: Point2<f64>,
        motion: &EdgeMotion,
    ) {
        self.wrench.add(direction * -strength, at, motion);
        self.damping += damping;
    }

    /// The sum, made smaller where its damping would take more than the momentum of `mass` in a step of `dt`.
    pub(super) fn bounded(&self, mass: f64, dt: f64) -> PlanarWrench {
        let scale = if self.damping > 0.0 { (mass / (dt * self.damping)).min(1.0) } else { 1.0 };
        PlanarWrench { force: self.wrench.force * scale, moment: self.wrench.moment * scale }
    }
}

/// What one step adds up along the edge.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct EdgeSums {
    /// Elastic forces across the edge.
    pub pressing: PlanarWrench,
    /// Forces along the edge.
    pub opposing: Opposing,
    /// Force across the edge, N.
    pub load: f64,
    /// Stored energy, J.
    pub elastic: f64,
    /// Energy that made cut surface, J.
    pub fracture: f64,
    /// Power that makes a free food give way along the edge, W.
    pub giving: f64,
}

/// The edge at one node: its crack, and what of a free food gives way along the edge there.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct EdgeElement {
    pub giving: Giving,
    /// Force along the edge by the speed of sliding in the last step, N s/m.
    damping: f64,
}

/// How the edge meets the food in one step.
#[derive(Clone, Copy, Debug)]
pub(super) struct EdgeZone {
    /// Force per length that lets the crack run, N/m; infinite before the cut begins.
    pub resistance: f64,
    /// Stiffness of the dent, N/m².
    pub stiffness: f64,
    /// Largest stiffness that one step bears, N/m².
    pub largest_stiffness: f64,
    /// Share s of the slice-push ratio that counts.
    pub efficiency: f64,
    /// What teeth add to it.
    pub tooth_ratio: f64,
    /// Friction along the edge before the cut begins.
    pub friction: f64,
    /// Speed below which forces along the edge fade out, m/s.
    pub creep_speed: f64,
    /// Longest dent as a multiple of the edge's height above the board.
    pub squeeze_ratio: f64,
    /// The board below, if any.
    pub board: Option<Board>,
    /// How a free food gives way along the edge, and for what length of pressing edge, m.
    pub elasticity: Option<(Elasticity, f64)>,
    /// Length of the step, s.
    pub dt: f64,
}

/// The board supports no dent shorter than this, m.
const THINNEST_GAP_M: f64 = 2e-5;

/// Stretch of the edge along x up to which its dent is measured across it: slopes of 60°.
const STEEPEST_DENT: f64 = 2.0;

impl EdgeZone {
    /// Lets the crack of one node run, whose edge is `at` this place of the section, and adds the forces on it.
    pub(super) fn act(
        &self,
        node: usize,
        front: &mut Front,
        element: &mut EdgeElement,
        at: Point2<f64>,
        motion: &EdgeMotion,
        sums: &mut EdgeSums,
    ) {
        let (slope, width) = (front.slope[node], front.width[node]);
        let stretch = (1.0 + slope * slope).sqrt();
        let velocity = motion.velocity_at(at.x, at.y);
        let along = Vector2::new(1.0, slope) / stretch;
        let passing = velocity.dot(&along);
        let slide = self.elasticity.as_ref().map_or(passing, |(elasticity, length)| {
            element.giving.follow(passing, element.damping, width / length, elasticity)
        });
        let gap_to_board = self.board.map_or(f64::INFINITY, |board| board.depth_at(at.x) - at.y);
        let begun = self.resistance.is_finite();
        let (stiffness, gap) = (self.stiffness_above(gap_to_board, begun), gap_to_board.max(THINNEST_GAP_M));
        let slip = self.efficiency * slide.abs() * self.dt * stretch;
        // a dent is as deep across the edge whatever its slope, but the blade's steep ends are rigid
        let lean = stretch.min(STEEPEST_DENT);
        let capacity = self.resistance * lean / stiffness;
        let mut advance = 0.0;
        if begun {
            advance = Dent { gap: front.dent[node], capacity, slip, tooth_ratio: self.tooth_ratio }.advance();
            front.crack[node] += advance;
            front.dent[node] -= advance;
        }
        let dent = front.dent[node];
        let traction = stiffness * dent / lean;
        sums.pressing.add(Vector2::new(slope, -1.0) * (traction * width), at, motion);
        sums.load += traction * width * stretch;
        sums.elastic += 0.5 * traction * dent * width;
        sums.fracture += traction * advance * width;
        if begun && stiffness > self.stiffness {
            // the dent stiffens as the edge nears the board: the rest of the gradient of its energy
            sums.pressing.add(Vector2::new(0.0, -0.5 * traction * dent / gap * width), at, motion);
        }
        let tangential = if advance > 0.0 {
            traction * slip / advance
        } else if begun {
            0.0
        } else {
            self.friction * traction
        };
        let strength = tangential * width * stretch * (velocity.norm() / self.creep_speed).min(1.0);
        let damping = if strength > 0.0 && slide != 0.0 { strength / slide.abs() } else { 0.0 };
        let (strength, seen) = match &self.elasticity {
            // what the spring holds now: a crack that stops from one step to the next is no blow
            Some((elasticity, length)) => {
                let before = std::mem::replace(&mut element.damping, damping);
                (before * slide.abs(), elasticity.damping_in_series(before, width / length))
            }
            None => (strength, damping),
        };
        if strength > 0.0 {
            sums.opposing.add(strength, along * slide.signum(), seen, at, motion);
            sums.giving += strength * slide.signum() * (passing - slide);
            if begun {
                sums.fracture += strength * slide.abs() * self.dt;
            }
        }
    }

    /// Stiffness of the dent at a height above the board: the dent is shorter than that height allows.
    fn stiffness_above(&self, gap_to_board: f64, begun: bool) -> f64 {
        let squeezed = self.resistance / (self.squeeze_ratio * gap_to_board.max(THINNEST_GAP_M));
        let wanted = if begun { self.stiffness.max(squeezed) } else { self.stiffness };
        wanted.min(self.largest_stiffness)
    }
}

/// Friction on the flanks.
#[derive(Clone, Copy, Debug)]
pub(super) struct FlankStress {
    /// Shear stress on both flanks together, Pa.
    pub shear: f64,
    /// Speed below which it fades out, m/s.
    pub creep_speed: f64,
    /// How a free food gives way along the flanks, and for what area, m².
    pub elasticity: Option<(Elasticity, f64)>,
}

/// The blade inside the food in one column of the section.
#[derive(Clone, Copy, Debug)]
pub(super) struct FlankPatch {
    /// Area of one flank, m².
    pub area: f64,
    /// Depth of its lower end, m.
    pub depth: f64,
}

/// What one step adds up over the flanks.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct FlankSums {
    /// Friction of both flanks.
    pub opposing: Opposing,
    /// Area of the blade in the cut, m².
    pub area: f64,
    /// Its middle times the area.
    moment_of_area: Vector2<f64>,
}

impl FlankSums {
    /// Adds `area` of blade in one column down to `depth`.
    pub(super) fn add(
        &mut self,
        column: usize,
        grid: &SectionGrid,
        FlankPatch { area, depth }: FlankPatch,
        stress: &FlankStress,
        grip: &mut FlankGrip,
        motion: &EdgeMotion,
    ) {
        let x = 0.5 * (grid.x(column) + grid.x(column + 1));
        let at = Point2::new(x, depth - 0.5 * area / grid.pitch());
        self.area += area;
        self.moment_of_area += at.coords * area;
        let FlankStress { shear, creep_speed, .. } = *stress;
        let (mut velocity, whole) = (motion.velocity_at(at.x, at.y), shear * area);
        let elasticity = stress.elasticity.as_ref().map(|(elasticity, all)| (elasticity, area / all));
        if let Some((elasticity, share)) = elasticity {
            velocity = grip.slide(velocity, &FlankFriction { strength: whole, creep_speed, share }, elasticity);
        }
        let speed = velocity.norm();
        if speed > 0.0 {
            let strength = whole * (speed / creep_speed).min(1.0);
            let damping = strength / speed;
            let seen = elasticity.map_or(damping, |(elasticity, share)| elasticity.damping_in_series(damping, share));
            self.opposing.add(strength, velocity / speed, seen, at, motion);
        }
    }

    /// Middle of the blade's part in the cut.
    pub(super) fn middle(&self) -> Point2<f64> {
        Point2::from(self.moment_of_area / self.area.max(f64::MIN_POSITIVE))
    }
}
