//! A skill library as plain data, to be written to a file and read again.

use nalgebra::{Point2, Vector2};
use serde::{Deserialize, Serialize};

use super::intention::Intention;
use super::library::{ObjectOperatingSkill, SkillLibrary, ToolFlippingSkill};
use crate::error::SkillError;
use crate::field::{FieldError, finite, positive};
use crate::primitive::{PrimitiveConfig, RestoreError, SavedPrimitive};
use crate::tool::Tool;

/// Everything that defines a [`SkillLibrary`]; what is restored rolls out to the same bits.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SavedLibrary {
    /// Kind of the primitives, for ways that no demonstration shows.
    pub primitive: PrimitiveConfig,
    /// Where the object was to go, whatever the tool.
    pub intention: SavedIntention,
    /// The pushes, in their order.
    pub pushes: Vec<SavedPush>,
    /// The ways of the tool before, between and after them: one more than there are pushes.
    pub flips: Vec<SavedFlip>,
}

/// Everything that defines an [`Intention`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SavedIntention {
    /// Mean displacement of the object over the demonstrations, world axes, m.
    pub displacement_m: [f64; 2],
    /// Mean duration of its motion, s.
    pub duration_s: f64,
    /// A few points of each path that was shown, world axes, m.
    pub shown_m: Vec<Vec<[f64; 2]>>,
    /// Path of the object's center from start to goal, world axes, m.
    pub path: SavedPrimitive,
}

/// Everything that defines an [`ObjectOperatingSkill`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SavedPush {
    /// Name of the contact surface that was used.
    pub surface: String,
    /// Mean displacement of the object over the demonstrations, world axes, m.
    pub displacement_m: [f64; 2],
    /// Mean duration in the demonstrations, s.
    pub duration_s: f64,
    /// Path of the object's center, world axes, m.
    pub path: SavedPrimitive,
}

/// Everything that defines a [`ToolFlippingSkill`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SavedFlip {
    /// Mean length of the way in the demonstrations, m.
    pub length_m: f64,
    /// Place of the tool's origin relative to the object's center, world axes, m.
    pub path: SavedPrimitive,
}

impl SkillLibrary {
    /// Takes down the library, which was learned with `tool`.
    #[must_use]
    pub fn saved(&self, tool: &Tool) -> SavedLibrary {
        let name = |surface: usize| tool.surfaces.get(surface).map_or_else(String::new, |surface| surface.name.clone());
        let push = |skill: &ObjectOperatingSkill| SavedPush {
            surface: name(skill.surface),
            displacement_m: skill.displacement.into(),
            duration_s: skill.duration_s,
            path: skill.primitive.saved(),
        };
        let flip = |skill: &ToolFlippingSkill| SavedFlip { length_m: skill.length_m, path: skill.primitive.saved() };
        SavedLibrary {
            primitive: self.primitive.clone(),
            intention: SavedIntention {
                displacement_m: self.intention.displacement.into(),
                duration_s: self.intention.duration_s,
                shown_m: self
                    .intention
                    .shown
                    .iter()
                    .map(|path| path.iter().map(|point| [point.x, point.y]).collect())
                    .collect(),
                path: self.intention.primitive.saved(),
            },
            pushes: self.pushes.iter().map(push).collect(),
            flips: self.flips.iter().map(flip).collect(),
        }
    }
}

impl SavedLibrary {
    /// Builds the library anew, for `tool` or another one whose surfaces have the same names.
    ///
    /// # Errors
    /// A [`RestoreError`] if a value cannot be that of a learned skill.
    pub fn restore(self, tool: &Tool) -> Result<SkillLibrary, RestoreError> {
        self.validate()?;
        let restored = |path: String, saved: SavedPrimitive| {
            let primitive = saved.restore().map_err(|source| RestoreError::Primitive { path: path.clone(), source })?;
            match primitive.dimension() {
                2 => Ok(primitive),
                found => {
                    let source = SkillError::Dimension { operation: "restore primitive", found, expected: 2 };
                    Err(RestoreError::Primitive { path, source })
                }
            }
        };
        let mut pushes = Vec::new();
        for (index, push) in self.pushes.into_iter().enumerate() {
            pushes.push(ObjectOperatingSkill {
                surface: surface_index(tool, index, &push.surface)?,
                primitive: restored(format!("pushes.{index}.path"), push.path)?,
                displacement: Vector2::from(push.displacement_m),
                duration_s: push.duration_s,
            });
        }
        let mut flips = Vec::new();
        for (index, flip) in self.flips.into_iter().enumerate() {
            let primitive = restored(format!("flips.{index}.path"), flip.path)?;
            flips.push(ToolFlippingSkill { primitive, length_m: flip.length_m });
        }
        let intention = Intention {
            primitive: restored("intention.path".into(), self.intention.path)?,
            displacement: Vector2::from(self.intention.displacement_m),
            duration_s: self.intention.duration_s,
            shown: self
                .intention
                .shown_m
                .into_iter()
                .map(|path| path.into_iter().map(Point2::from).collect())
                .collect(),
            unconstrained: Vec::new(),
        };
        Ok(SkillLibrary { pushes, flips, intention, primitive: self.primitive })
    }

    fn validate(&self) -> Result<(), FieldError> {
        self.primitive.validate().map_err(|error| error.within("primitive"))?;
        let within = |error: FieldError| error.within("intention");
        finite("displacement_m", &self.intention.displacement_m).map_err(within)?;
        positive("duration_s", self.intention.duration_s).map_err(within)?;
        for (index, path) in self.intention.shown_m.iter().enumerate() {
            finite(&format!("shown_m.{index}"), path.as_flattened()).map_err(within)?;
        }
        if self.pushes.is_empty() {
            return Err(FieldError::new("pushes", "an empty list", "at least one push"));
        }
        if self.flips.len() != self.pushes.len() + 1 {
            let expected = format!("{}, one more than there are pushes", self.pushes.len() + 1);
            return Err(FieldError::new("flips", format!("{} ways", self.flips.len()), expected));
        }
        for (index, push) in self.pushes.iter().enumerate() {
            let within = |error: FieldError| error.within(format!("pushes.{index}"));
            finite("displacement_m", &push.displacement_m).map_err(within)?;
            positive("duration_s", push.duration_s).map_err(within)?;
        }
        for (index, flip) in self.flips.iter().enumerate() {
            positive("length_m", flip.length_m).map_err(|error| error.within(format!("flips.{index}")))?;
        }
        Ok(())
    }
}

fn surface_index(tool: &Tool, index: usize, name: &str) -> Result<usize, FieldError> {
    tool.surfaces.iter().position(|surface| surface.name == name).ok_or_else(|| {
        let known: Vec<String> = tool.surfaces.iter().map(|surface| format!("`{}`", surface.name)).collect();
        let expected = format!("one of {}, the surfaces of the tool `{}`", known.join(", "), tool.name);
        FieldError::new(format!("pushes.{index}.surface"), format!("{name:?}"), expected)
    })
}
