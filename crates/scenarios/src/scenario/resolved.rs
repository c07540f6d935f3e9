//! A checked scenario together with everything that it names: what is common to all kinds of tasks.

use robot::Manipulator;
use serde::de::DeserializeOwned;
use sim::controllers::ControllerConfig;
use skills::field::FieldError;

use super::{Header, Reader, RecordingConfig};
use crate::assets::AssetKind;
use crate::tasks::push::ResolvedPush;
use crate::tasks::spatial::SpatialRobotConfig;
use crate::tasks::{ResolvedTask, TASKS};

/// A file of the assets that a scenario names.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AssetUsed {
    /// Key of the scenario that asked for it.
    pub key: String,
    /// What it is.
    pub kind: AssetKind,
    /// Name of the file, without its ending.
    pub name: String,
    /// Digest of its bytes, before changes that the scenario makes in it.
    pub digest: String,
}

/// A checked scenario together with everything that it names.
#[derive(Clone, Debug)]
pub struct ResolvedScenario {
    /// Name, as the scenario states it, or the file's name without its ending.
    pub name: String,
    /// The arm, as its URDF describes it; without tool, mounting or rotor inertia.
    pub arm: Manipulator,
    /// The scenario file's text, as it was read.
    pub source: String,
    /// The files that it names, in the order in which they were read.
    pub assets: Vec<AssetUsed>,
    /// The scenario with all defaults filled in, the name too, and what else it names: its shape is that of its task.
    pub task: ResolvedTask,
}

impl ResolvedScenario {
    /// Name of the kind of its task: the key of the task's table.
    #[must_use]
    pub fn kind(&self) -> &'static str {
        self.task.part().kind()
    }

    /// The key that names what the arm holds, if the scenario chooses that.
    #[must_use]
    pub fn tool_key(&self) -> Option<&'static str> {
        TASKS.iter().find(|kind| kind.name == self.kind())?.tool_key
    }

    /// Name, title, description and seed.
    #[must_use]
    pub fn header(&self) -> &Header {
        self.file().header()
    }

    /// What the recording holds.
    #[must_use]
    pub fn recording(&self) -> &RecordingConfig {
        self.file().recording()
    }

    /// How near to its goal the object has arrived, m; `None` if the task brings nothing anywhere.
    #[must_use]
    pub fn goal_tolerance_m(&self) -> Option<f64> {
        self.file().goal_tolerance_m()
    }

    /// The scenario as TOML, every default written out, with another seed.
    ///
    /// # Errors
    /// In words, if a value cannot be written.
    pub fn text(&self, seed: u64) -> Result<String, String> {
        self.task.part().text(seed)
    }

    /// What is particular to a push, if it is one.
    #[must_use]
    pub fn as_push(&self) -> Option<&ResolvedPush> {
        self.task.part().as_push()
    }

    pub(crate) fn file(&self) -> &dyn ScenarioFile {
        self.task.part().file()
    }
}

/// What the scenario files of all kinds of tasks have in common.
pub(crate) trait ScenarioFile {
    /// Name, title, description and seed.
    fn header(&self) -> &Header;

    /// The same, to be filled in.
    fn header_mut(&mut self) -> &mut Header;

    /// Which arm is used, and how.
    fn arm(&self) -> ArmKeys<'_>;

    /// What the recording holds.
    fn recording(&self) -> &RecordingConfig;

    /// How near to its goal the object has arrived, m; `None` if the task brings nothing anywhere.
    fn goal_tolerance_m(&self) -> Option<f64> {
        None
    }

    /// Checks every part on its own, and returns at most one refused value of each.
    ///
    /// The number of joints, against which lists of gains are checked, is known only with the arm: that is for the
    /// loader.
    fn refused_values(&self) -> Vec<FieldError>;
}

/// A scenario file that can be loaded.
pub(crate) trait ReadScenario: ScenarioFile + DeserializeOwned {
    /// Reads what the file names besides its arm, and makes the checks that need more than one part of it; what is wrong
    /// is left with the reader. `refused` are the values that were complained about already.
    fn resolve(self, reader: &mut Reader<'_>, refused: &[FieldError]) -> Option<ResolvedTask>;
}

/// What a scenario file says about its arm: the values under `robot` and `controller`.
pub(crate) struct ArmKeys<'a> {
    /// `robot.asset`: name of a URDF file in `assets/robots`, without its ending.
    pub asset: &'a str,
    /// `robot.rotor_inertia_kg_m2`: one number per joint, or none, kg m².
    pub rotor_inertia_kg_m2: &'a [f64],
    /// `robot.tool_frame`: frame of the arm that grips the tool.
    pub tool_frame: &'a str,
    /// `controller`: its gains are one number, or one per joint.
    pub controller: &'a ControllerConfig,
    /// The whole of `robot`, if the arm moves in space.
    pub spatial: Option<&'a SpatialRobotConfig>,
}
