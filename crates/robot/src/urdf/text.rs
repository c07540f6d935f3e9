//! The text itself: comments out, xacro refused, XML parsed.

use crate::error::RobotError;

/// What only a xacro source contains. A leftover `xmlns:xacro` declaration is harmless and not listed.
const XACRO_SIGNS: [&str; 3] = ["<xacro:", "${", "$("];

/// Parses the text.
pub(crate) fn parse(xml: &str) -> Result<urdf_rs::Robot, RobotError> {
    let plain = without_comments(xml);
    if let Some(sign) = XACRO_SIGNS.iter().find(|sign| plain.contains(**sign)) {
        return Err(RobotError::Xacro { found: (*sign).to_owned() });
    }
    urdf_rs::read_from_string(&plain).map_err(|error| RobotError::NotUrdf { reason: error.to_string() })
}

/// Leaves comments out but keeps their line breaks, so that the parser's line numbers stay right.
fn without_comments(xml: &str) -> String {
    let mut plain = String::with_capacity(xml.len());
    let mut rest = xml;
    while let Some((before, after)) = rest.split_once("<!--") {
        plain.push_str(before);
        let (comment, remaining) = after.split_once("-->").unwrap_or((after, ""));
        plain.extend(comment.chars().filter(|character| *character == '\n'));
        rest = remaining;
    }
    plain.push_str(rest);
    plain
}
