//! Changes of hold: the flip from one phase to the next, clear of object, obstacles and the bounds of the reach.

use nalgebra::{Isometry2, Point2};

use super::barring::Barring;
use super::chaining::{Chain, Obstructed};
use super::phases::{Phase, Phases};
use super::refusal::TransferError;
use super::sweep::first_near;
use crate::error::SkillError;
use crate::plan::Track;
use crate::tool::Contact;
use crate::tool_flipping::{Flip, FlipOptions, FlipTask, WayRound};

/// A flip that is slowed is slowed by this factor more, since other motions of it are compared then.
const SLOWER: f64 = 1.2;
/// Looks at a flip by which its length is measured.
const LOOKS: usize = 200;
/// Distance between two looks at whether a flip stays within reach, m: that of the places at which a reach is known.
const REACH_LOOK_M: f64 = 0.005;

impl Chain<'_> {
    /// The flips between phases, with the motions of the tool.
    ///
    /// # Errors
    /// The first change that is not there, with the reason.
    pub(super) fn changes(&self, phases: &Phases) -> Result<Vec<(Flip, Track)>, Obstructed> {
        let pairs = phases.phases.windows(2).enumerate();
        pairs
            .map(|(index, pair)| {
                self.change(pair).map_err(|error| {
                    // what a tool cannot do among obstacles it may do elsewhere
                    let at = match error {
                        TransferError::FlipNearObstacle { .. } | TransferError::FlipOutOfReach { .. } => {
                            Barring::ChangeNearby(index)
                        }
                        _ => Barring::Change(index),
                    };
                    Obstructed { at: Some(at), error }
                })
            })
            .collect()
    }

    /// A flip from one hold to the next, by the shorter way round if it is free, else by the other one.
    fn change(&self, pair: &[Phase]) -> Result<(Flip, Track), TransferError> {
        let mut refusal = None;
        for way_round in [WayRound::Shorter, WayRound::Counterclockwise, WayRound::Clockwise] {
            match self.change_by(pair, way_round) {
                Ok(found) => return Ok(found),
                Err(error) => refusal = Some(worse(refusal, error)),
            }
        }
        let center = pair.first().map_or_else(Point2::origin, |before| before.to_world);
        Err(refusal.unwrap_or(TransferError::NoWay { what: "the next hold".into(), x_m: center.x, y_m: center.y }))
    }

    fn change_by(&self, pair: &[Phase], way_round: WayRound) -> Result<(Flip, Track), TransferError> {
        let ([before, after], [Some(first), Some(second)]) =
            (pair, [self.contact(pair.first(), 0.0), self.contact(pair.last(), self.config.approach_gap_m)])
        else {
            let (operation, expected) = ("change hold", "2 phases with a surface each".to_owned());
            return Err(SkillError::RowCount { operation, found: pair.len(), expected }.into());
        };
        let task = FlipTask {
            tool: self.workplace.tool,
            object: self.workplace.object,
            object_world: Isometry2::new(before.to_world.coords, self.workplace.object_angle_rad),
            contacts: [first, second],
            tool_angles_rad: [before.hold.tool_angle_rad, after.hold.tool_angle_rad],
            duration_s: 1.0,
        };
        let options = FlipOptions { way_round, ..self.config.flip.clone() };
        let flip = task.flip(&options)?;
        let duration_s = self.whole_steps_s(length_m(&flip) / self.free_speed_m_per_s);
        let mut flip = flip.with_duration_s(duration_s)?;
        let mut track = flip.tool_track(self.time_step_s)?;
        // a jump of an acceleration shrinks with the square of the duration: a sharper turn takes longer
        let excess = track.largest_jump().velocity_m_per_s / self.largest_bend_m_per_s();
        if excess > 1.0 {
            flip = flip.with_duration_s(self.whole_steps_s(duration_s * excess.sqrt() * SLOWER))?;
            track = flip.tool_track(self.time_step_s)?;
        }
        self.check_clear(&track, before.to_world)?;
        Ok((flip, track))
    }

    /// The contact of a phase, with a gap to the object.
    fn contact(&self, phase: Option<&Phase>, gap_m: f64) -> Option<Contact> {
        let hold = &phase?.hold;
        let mut contact = self.workplace.tool.surfaces.get(hold.surface)?.contact_at(hold.place_m);
        contact.point += contact.normal.into_inner() * gap_m;
        Some(contact)
    }

    /// Checks that a change of hold keeps the margin from obstacles, between its motions too, and stays within reach.
    fn check_clear(&self, track: &Track, center: Point2<f64>) -> Result<(), TransferError> {
        let (x_m, y_m) = (center.x, center.y);
        let margin_m = self.config.tool_margin_m;
        if !self.workplace.tool_passes
            && let Some(near) = first_near(track, self.shapes.tool_lever_m(), margin_m, |pose| {
                self.shapes.tool_clearance_up_to_m(pose, f64::INFINITY)
            })
        {
            return Err(TransferError::FlipNearObstacle { x_m, y_m, clearance_m: near.clearance_m, margin_m });
        }
        if self.is_reached(track) { Ok(()) } else { Err(TransferError::FlipOutOfReach { x_m, y_m }) }
    }

    /// Whether the actuator can follow a track, looked at every few millimeters.
    pub(super) fn is_reached(&self, track: &Track) -> bool {
        let mut looked: Option<Point2<f64>> = None;
        let last = track.motions().len().saturating_sub(1);
        track.motions().iter().enumerate().all(|(row, motion)| {
            let far = looked.is_none_or(|place| (motion.point() - place).norm() >= REACH_LOOK_M);
            if !far && row != last {
                return true;
            }
            looked = Some(motion.point());
            self.workplace.reach.holds(&motion.pose())
        })
    }
}

/// Of two reasons why a change fails, the one that may not hold elsewhere.
fn worse(first: Option<TransferError>, second: TransferError) -> TransferError {
    match first {
        Some(first @ (TransferError::FlipNearObstacle { .. } | TransferError::FlipOutOfReach { .. })) => first,
        Some(first) if matches!(second, TransferError::Flip(_)) => first,
        _ => second,
    }
}

/// Length of a flip's way of the tool, m.
fn length_m(flip: &Flip) -> f64 {
    let place = |look: usize| flip.tool_in_world(flip.duration_s() * look as f64 / LOOKS as f64).point();
    (0..LOOKS).map(|look| (place(look + 1) - place(look)).norm()).sum()
}
