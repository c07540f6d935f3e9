//! A clean copy of a URDF text: only what is used, on the lines where it stood, in the form that the parser takes.
//!
//! Files in use hold much that no arm needs (plugins, transmissions, extensions with undeclared prefixes) and small flaws
//! that other readers forgive (commas in vectors, limits without effort, textures without a file). The copy leaves the
//! former out and mends the latter; whatever could change the arm is told as a [`Warning`].

use std::collections::{BTreeMap, BTreeSet};

use crate::error::RobotError;
use crate::urdf::markup::{Attribute, Document, Element};
use crate::urdf::schema::{Absent, AttributeRule, ElementRule, JOINT_TYPES, KNOWN_BUT_UNUSED, ROBOT, SHAPES};
use crate::urdf::values::{excerpt, expand_defaults, expected, mend};
use crate::warning::Warning;

/// Returns the clean copy.
pub(crate) fn clean(document: &Document<'_>) -> Result<(String, Vec<Warning>), RobotError> {
    let root = document.root();
    refuse_xacro(document)?;
    if root.name != ROBOT.name {
        return Err(RobotError::NotRobot { line: root.line, found: excerpt(root.name) });
    }
    let prefixes = document.elements.iter().flat_map(|element| &element.attributes);
    let prefixes = prefixes.filter_map(|attribute| attribute.name.strip_prefix("xmlns:")).collect();
    let mut copy =
        Copy { document, prefixes, text: String::new(), line: 1, warnings: Vec::new(), left_out: BTreeMap::new() };
    copy.add(root, &ROBOT, "the robot")?;
    Ok((copy.text, copy.warnings))
}

fn refuse_xacro(document: &Document<'_>) -> Result<(), RobotError> {
    match document.elements.iter().find(|element| element.name.starts_with("xacro:")) {
        Some(found) => Err(RobotError::Xacro { found: format!("<{}>", excerpt(found.name)), line: found.line }),
        None => Ok(()),
    }
}

struct Copy<'d, 'a> {
    document: &'d Document<'a>,
    /// Prefixes that the file declares anywhere.
    prefixes: BTreeSet<&'a str>,
    text: String,
    /// The line at the end of `text`.
    line: usize,
    warnings: Vec<Warning>,
    /// Which warning tells of a child that is left out, by the names of parent and child.
    left_out: BTreeMap<(&'static str, &'a str), usize>,
}

impl<'d, 'a> Copy<'d, 'a> {
    /// Copies an element that the schema knows; `owner` is the link, joint or material it belongs to.
    fn add(&mut self, element: &'d Element<'a>, rule: &'static ElementRule, owner: &str) -> Result<(), RobotError> {
        let named = element.attribute("name").filter(|_| ["link", "joint"].contains(&rule.name));
        let named = named.map(|name| format!("{} `{}`", rule.name, excerpt(name)));
        let owner = named.as_deref().unwrap_or(owner);
        while self.line < element.line {
            self.push("\n");
        }
        self.push(&format!("<{}", rule.name));
        for attribute in rule.attributes {
            self.add_attribute(element, attribute, owner)?;
        }
        self.push(">");
        check_joint_type(element, rule)?;
        self.add_children(element, rule, owner)?;
        self.push(&format!("</{}>", rule.name));
        Ok(())
    }

    fn add_children(
        &mut self,
        element: &'d Element<'a>,
        rule: &'static ElementRule,
        owner: &str,
    ) -> Result<(), RobotError> {
        let document = self.document;
        let mut present: Vec<&'static str> = Vec::new();
        for child in document.children(element) {
            let Some(child_rule) = rule.children.iter().find(|known| known.name == child.name) else {
                self.leave_out(child, rule.name);
                continue;
            };
            // a geometry has one shape, whichever it is
            let slot = if rule.name == "geometry" { "shape" } else { child_rule.name };
            if !child_rule.several && present.contains(&slot) {
                let element = described(child, owner);
                self.warnings.push(Warning::ElementRepeated { element, line: child.line });
                continue;
            }
            if let Some(found) = self.shape_flaw(child) {
                let (element, line) = (described(child, owner), child.line);
                self.warnings.push(Warning::ShapeIgnored { element, line, found });
                continue;
            }
            present.push(slot);
            self.add(child, child_rule, owner)?;
        }
        match rule.required.iter().find(|name| !present.contains(name)) {
            Some(&child) => {
                Err(RobotError::MissingElement { line: element.line, element: described(element, owner), child })
            }
            None => Ok(()),
        }
    }

    fn add_attribute(&mut self, element: &Element<'a>, rule: &AttributeRule, owner: &str) -> Result<(), RobotError> {
        let mut written = element.attributes.iter().filter(|attribute| attribute.name == rule.name);
        let Some(Attribute { value, .. }) = written.next() else {
            return match rule.absent {
                Absent::Fine => Ok(()),
                Absent::Means(value) => {
                    self.push(&format!(" {}=\"{value}\"", rule.name));
                    Ok(())
                }
                Absent::Refused => {
                    let element_described = described(element, owner);
                    Err(RobotError::MissingAttribute {
                        line: element.line,
                        element: element_described,
                        attribute: rule.name,
                    })
                }
            };
        };
        if written.next().is_some() {
            let reason = format!("line {}: {} has `{}` twice", element.line, described(element, owner), rule.name);
            return Err(RobotError::NotUrdf { reason });
        }
        let expanded = expand_defaults(value);
        if expanded.contains("${") || expanded.contains("$(") {
            return Err(RobotError::Xacro { found: excerpt(&expanded), line: element.line });
        }
        let Some(mended) = mend(&expanded, rule.value) else {
            return Err(RobotError::NotNumbers {
                line: element.line,
                element: described(element, owner),
                attribute: rule.name,
                found: excerpt(value),
                expected: expected(rule.value),
            });
        };
        if mended != *value {
            self.warnings.push(Warning::ValueMended {
                line: element.line,
                element: described(element, owner),
                attribute: rule.name,
                found: excerpt(value),
                used: excerpt(&mended),
            });
        }
        let quote = if mended.contains('"') { '\'' } else { '"' };
        self.push(&format!(" {}={quote}{mended}{quote}", rule.name));
        Ok(())
    }

    /// Why a visual or collision has no shape that can be used; `None` for all other elements.
    fn shape_flaw(&self, element: &Element<'a>) -> Option<String> {
        if !["visual", "collision"].contains(&element.name) {
            return None;
        }
        let Some(geometry) = self.document.children(element).find(|child| child.name == "geometry") else {
            return Some("no <geometry>".to_owned());
        };
        let mut shapes = self.document.children(geometry);
        match shapes.find(|shape| SHAPES.iter().any(|known| known.name == shape.name)) {
            Some(mesh)
                if mesh.name == "mesh" && mesh.attribute("filename").is_none_or(|name| name.trim().is_empty()) =>
            {
                Some("a mesh without a file name".to_owned())
            }
            Some(_) => None,
            None => match self.document.children(geometry).next() {
                Some(other) => Some(format!("<{}>", excerpt(other.name))),
                None => Some("an empty <geometry>".to_owned()),
            },
        }
    }

    /// Passes over an element that the schema does not know.
    fn leave_out(&mut self, element: &Element<'a>, parent: &'static str) {
        let undeclared_prefix =
            element.name.split_once(':').map(|(prefix, _)| prefix).filter(|prefix| !self.prefixes.contains(prefix));
        let expected = KNOWN_BUT_UNUSED.contains(&element.name);
        let extension = element.name.contains(':') && undeclared_prefix.is_none();
        if expected || extension {
            return;
        }
        if let Some(&place) = self.left_out.get(&(parent, element.name)) {
            if let Some(Warning::ElementIgnored { times, .. }) = self.warnings.get_mut(place) {
                *times += 1;
            }
            return;
        }
        self.left_out.insert((parent, element.name), self.warnings.len());
        self.warnings.push(Warning::ElementIgnored {
            line: element.line,
            element: excerpt(element.name),
            parent,
            undeclared_prefix: undeclared_prefix.map(excerpt),
            times: 1,
        });
    }

    fn push(&mut self, piece: &str) {
        self.line += piece.bytes().filter(|byte| *byte == b'\n').count();
        self.text.push_str(piece);
    }
}

fn check_joint_type(element: &Element<'_>, rule: &ElementRule) -> Result<(), RobotError> {
    let kind = element.attribute("type").unwrap_or_default();
    if rule.name != "joint" || JOINT_TYPES.contains(&kind) {
        return Ok(());
    }
    let joint = element.attribute("name").map(excerpt).unwrap_or_default();
    Err(RobotError::UnknownJointType { line: element.line, joint, found: excerpt(kind) })
}

/// The element and whose it is: "<mass> of link `arm`".
fn described(element: &Element<'_>, owner: &str) -> String {
    let itself = ["link", "joint"].contains(&element.name) && element.attribute("name").is_some();
    if itself { owner.to_owned() } else { format!("<{}> of {owner}", element.name) }
}
