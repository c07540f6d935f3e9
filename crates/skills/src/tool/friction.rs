//! Friction of a tool's pieces, where surfaces state a friction of their own.
//!
//! A simulated collider has one friction all over. A piece therefore takes the friction of the surfaces that it carries,
//! and they must agree.

use super::{ContactSurface, Tool};
use crate::field::FieldError;

/// Places along a surface at which the pieces below it are looked for; a hollow lies on some tens of pieces.
const PLACES: u32 = 256;
/// Pieces that are this little further away than the nearest carry the surface too: they end in one line.
const IN_LINE_M: f64 = 1e-9;

impl Tool {
    /// Returns the coefficient of friction of each piece with the object: that of the surfaces on it, else the tool's.
    #[must_use]
    pub fn piece_frictions(&self) -> Vec<f64> {
        let mut frictions = vec![self.friction; self.pieces.len()];
        for surface in self.surfaces.iter().filter(|surface| surface.friction.is_some()) {
            for (friction, carries) in frictions.iter_mut().zip(self.carriers(surface)) {
                if carries {
                    *friction = surface.friction_or(self.friction);
                }
            }
        }
        frictions
    }

    /// Checks that surfaces on one piece have one friction.
    pub(super) fn check_friction(&self) -> Result<(), FieldError> {
        if self.surfaces.iter().all(|surface| surface.friction.is_none()) {
            return Ok(());
        }
        let frictions = self.piece_frictions();
        for (index, surface) in self.surfaces.iter().enumerate() {
            let own = surface.friction_or(self.friction);
            let carriers = frictions.iter().zip(self.carriers(surface)).filter(|(_, carries)| *carries);
            if let Some((other, _)) = carriers.into_iter().find(|(friction, _)| **friction != own) {
                let found = format!("{own} of the surface '{}' on a piece of which another has {other}", surface.name);
                let expected = "one friction for all surfaces on a piece; cut the piece between them";
                return Err(FieldError::new(format!("surfaces.{index}.friction"), found, expected));
            }
        }
        Ok(())
    }

    /// Whether each piece carries the surface: is nearest to it in more than a point.
    fn carriers(&self, surface: &ContactSurface) -> Vec<bool> {
        let mut carriers = vec![false; self.pieces.len()];
        for place in 0..PLACES {
            let place_m = surface.length_m() * ((f64::from(place) + 0.5) / f64::from(PLACES) - 0.5);
            let point = surface.contact_at(place_m).point;
            let nearest = self.signed_distance_m(&point);
            for (carries, piece) in carriers.iter_mut().zip(&self.pieces) {
                *carries |= piece.signed_distance_m(&point) <= nearest + IN_LINE_M;
            }
        }
        carriers
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::outline::{Outline, PlacedOutline};
    use crate::tool::SurfaceShape;

    /// Two boxes of 20 x 10 mm side by side with a common upper side at y = 5 mm.
    fn two_boxes() -> Tool {
        let shape = Outline::Box { width_m: 0.02, height_m: 0.01 };
        let piece = |x| PlacedOutline { shape: shape.clone(), position_m: [x, 0.0], angle_rad: 0.0 };
        let face = |from: f64, to: f64| SurfaceShape::Face { start_m: [from, 0.005], end_m: [to, 0.005] };
        let left = ContactSurface::new("left", face(0.0, -0.02));
        let right = ContactSurface::new("right", face(0.02, 0.0));
        Tool {
            name: "two".into(),
            description: String::new(),
            mass_kg: 0.01,
            friction: 0.3,
            pieces: vec![piece(-0.01), piece(0.01)],
            surfaces: vec![left, right],
        }
    }

    #[test]
    fn a_piece_has_the_friction_of_its_surface() {
        let mut tool = two_boxes();
        assert_eq!(tool.piece_frictions(), [0.3, 0.3]);
        tool.surfaces[0].friction = Some(0.7);
        assert_eq!(tool.validate(), Ok(()));
        assert_eq!(tool.piece_frictions(), [0.7, 0.3]);
    }

    #[test]
    fn a_surface_over_two_pieces_gives_both_its_friction() {
        let mut tool = two_boxes();
        let shape = SurfaceShape::Face { start_m: [0.02, 0.005], end_m: [-0.02, 0.005] };
        tool.surfaces = vec![ContactSurface { friction: Some(0.1), ..ContactSurface::new("top", shape) }];
        assert_eq!((tool.validate(), tool.piece_frictions()), (Ok(()), vec![0.1, 0.1]));
    }

    #[test]
    fn surfaces_on_one_piece_must_agree_on_its_friction() {
        let mut tool = two_boxes();
        let below = SurfaceShape::Face { start_m: [-0.015, -0.005], end_m: [-0.005, -0.005] };
        tool.surfaces.push(ContactSurface { friction: Some(0.7), ..ContactSurface::new("below", below) });
        let error = tool.validate().unwrap_err();
        assert!(error.field == "surfaces.0.friction" && error.found.contains("'left'"), "{error}");
        tool.surfaces[0].friction = Some(0.7);
        assert_eq!(tool.validate(), Ok(()));
    }

    #[test]
    fn the_allowed_angle_is_that_of_the_friction_cone_unless_stated() {
        let mut surface = two_boxes().surfaces.remove(0);
        assert_eq!((surface.friction_or(0.3), surface.allowed_angle_rad(0.3)), (0.3, 0.3_f64.atan()));
        surface.friction = Some(1.0);
        assert_eq!(surface.allowed_angle_rad(0.3), std::f64::consts::FRAC_PI_4);
        surface.allowed_angle_rad = Some(0.0);
        assert_eq!(surface.allowed_angle_rad(0.3), 0.0);
        surface.allowed_angle_rad = Some(1.6);
        assert_eq!(surface.validate().unwrap_err().field, "allowed_angle_rad");
        surface.friction = Some(-0.1);
        assert_eq!(surface.validate().unwrap_err().field, "friction");
    }
}
