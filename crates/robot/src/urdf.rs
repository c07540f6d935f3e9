//! From the text of a URDF file to a [`Manipulator`].

mod build;
mod checks;
mod clean;
mod inertials;
mod markup;
mod mimics;
mod schema;
mod text;
mod tree;
mod values;

pub(crate) use inertials::principal_moments;

use crate::error::RobotError;
use crate::manipulator::Manipulator;

#[cfg(test)]
mod tests;

/// Cleans, parses, checks and merges.
pub(crate) fn read(xml: &str) -> Result<Manipulator, RobotError> {
    let (robot, warnings) = text::parse(xml)?;
    checks::check_links(&robot)?;
    checks::check_joints(&robot)?;
    let tree = tree::Tree::new(&robot)?;
    build::build(&robot, &tree, warnings)
}
