//! The tool in the hand: a rigid body with colliders and a look, gripped by a frame of the arm.

use nalgebra::{Isometry3, Matrix3, Point3, Vector3};
use rapier3d::geometry::SharedShape;
use robot::Manipulator;
use skills::field::{FieldError, finite, not_negative};

use super::drawing::Drawing;
use crate::error::SimError;

/// Name of the frame that a held tool adds to the arm's model: the tool's own frame.
pub(crate) const TOOL_FRAME: &str = "tool";

/// One convex piece of a held tool.
#[derive(Clone)]
pub struct ToolPiece {
    /// The solid in its own frame.
    pub shape: SharedShape,
    /// Pose of the piece in the tool's frame.
    pub tool_from_piece: Isometry3<f64>,
    /// Coefficient of friction of its faces.
    pub friction: f64,
}

/// A rigid tool that the arm holds.
#[derive(Clone)]
pub struct HeldTool {
    /// Name, as reports call it.
    pub name: String,
    /// Mass, kg.
    pub mass_kg: f64,
    /// Center of mass in the tool's frame, m.
    pub center_of_mass_m: Point3<f64>,
    /// Inertia about the center of mass in the tool's axes, kg m².
    pub inertia_kg_m2: Matrix3<f64>,
    /// Pose of the tool's frame in the frame of the arm that grips it.
    pub grip_from_tool: Isometry3<f64>,
    /// What collides; empty for a tool whose contact a process handles.
    pub pieces: Vec<ToolPiece>,
    /// How it looks, placed in the tool's frame.
    pub drawings: Vec<Drawing>,
}

impl HeldTool {
    /// No tool at all: the gripping frame itself.
    #[must_use]
    pub fn none() -> Self {
        Self {
            name: "bare hand".into(),
            mass_kg: 0.0,
            center_of_mass_m: Point3::origin(),
            inertia_kg_m2: Matrix3::zeros(),
            grip_from_tool: Isometry3::identity(),
            pieces: Vec::new(),
            drawings: Vec::new(),
        }
    }

    /// Checks that poses, friction and mass are numbers that a body can have.
    ///
    /// # Errors
    /// A [`FieldError`] naming the offending value.
    pub fn validate(&self) -> Result<(), FieldError> {
        finite("grip_from_tool", self.grip_from_tool.to_homogeneous().as_slice())?;
        not_negative("mass_kg", self.mass_kg)?;
        finite("center_of_mass_m", self.center_of_mass_m.coords.as_slice())?;
        finite("inertia_kg_m2", self.inertia_kg_m2.as_slice())?;
        for (index, piece) in self.pieces.iter().enumerate() {
            let at = |error: FieldError| error.within(format!("pieces.{index}"));
            finite("tool_from_piece", piece.tool_from_piece.to_homogeneous().as_slice()).map_err(at)?;
            not_negative("friction", piece.friction).map_err(at)?;
        }
        Ok(())
    }
}

/// Model of an arm that carries a tool: the tool is part of the body that holds the frame `grip`, its frame is named `tool`.
///
/// `rotor_inertia_kg_m2` has one entry per joint, or none for a bare arm.
///
/// # Errors
/// [`SimError::Robot`] if a frame is unknown, the arm has a frame named `tool` already, or the rotor inertias do not fit;
/// [`SimError::Field`] if a number of the tool cannot be used.
pub fn arm_with_tool(
    arm: &Manipulator,
    grip: &str,
    tool: &HeldTool,
    world_from_base: &Isometry3<f64>,
    gravity_in_world: &Vector3<f64>,
    rotor_inertia_kg_m2: &[f64],
) -> Result<Manipulator, SimError> {
    tool.validate().map_err(|error| error.within(format!("tool `{}`", tool.name)))?;
    finite("world_from_base", world_from_base.to_homogeneous().as_slice())?;
    finite("gravity_in_world", gravity_in_world.as_slice())?;
    let mut model = arm.clone();
    let frame = model.add_frame(TOOL_FRAME, model.frame(grip)?, tool.grip_from_tool)?;
    let mut model = model.attach_payload(frame, tool.mass_kg, tool.center_of_mass_m.coords, tool.inertia_kg_m2)?;
    model.mount(*world_from_base, *gravity_in_world);
    if !rotor_inertia_kg_m2.is_empty() {
        model.set_rotor_inertia(rotor_inertia_kg_m2)?;
    }
    Ok(model)
}
