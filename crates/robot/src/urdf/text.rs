//! The text itself: markup scanned, cleaned, and parsed.

use crate::error::RobotError;
use crate::urdf::clean::clean;
use crate::urdf::markup::Document;
use crate::warning::Warning;

/// Parses the text; warnings tell what was mended or left out.
pub(crate) fn parse(xml: &str) -> Result<(urdf_rs::Robot, Vec<Warning>), RobotError> {
    let text = xml.strip_prefix('\u{feff}').unwrap_or(xml);
    let document = Document::scan(text)
        .map_err(|flaw| RobotError::NotUrdf { reason: format!("line {}: {}", flaw.line, flaw.found) })?;
    let (copy, warnings) = clean(&document)?;
    let robot = urdf_rs::read_from_string(&copy).map_err(|error| RobotError::NotUrdf { reason: error.to_string() })?;
    Ok((robot, warnings))
}
