//! From the text of a URDF file to a [`Manipulator`].

mod build;
mod checks;
mod text;
mod tree;

use crate::error::RobotError;
use crate::manipulator::Manipulator;

#[cfg(test)]
mod tests;

/// Parses, checks and merges.
pub(crate) fn read(xml: &str) -> Result<Manipulator, RobotError> {
    let robot = text::parse(xml)?;
    checks::check_links(&robot)?;
    checks::check_joints(&robot)?;
    let tree = tree::Tree::new(&robot)?;
    Ok(build::build(&robot, &tree))
}
