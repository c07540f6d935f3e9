//! A cutting scenario with the food, the knife and the demonstration that it names.

use sim::cutting::food::FoodFile;
use sim::cutting::knife::{Knife, KnifeFile};
use skills::cutting::SavedCut;
use skills::field::FieldError;
use skills::primitive::pose::PoseTrajectory;

use super::actual::Actual;
use super::config::Wanted;
use super::places::extent_m;
use super::scenario::CutScenario;
use super::showing::DemonstrationsConfig;
use super::{CutTask, KIND};
use crate::assets::AssetKind;
use crate::scenario::named::{TomlAsset, field_problem};
use crate::scenario::{ReadScenario, Reader, ResolvedScenario, ScenarioFile, SkillsFile};
use crate::tasks::{ResolvedTask, Runnable, TaskPart, written};

/// What a checked scenario of a cut holds.
#[derive(Clone, Debug)]
pub struct ResolvedCut {
    /// The scenario with all defaults filled in, the name too.
    pub scenario: CutScenario,
    /// The food as its file and the scenario state it.
    pub food: FoodFile,
    /// The knife.
    pub knife: Knife,
    /// The food of the demonstration.
    pub shown_food: FoodFile,
    /// The knife of the demonstration.
    pub shown_knife: Knife,
    /// The recorded poses of the knife, if the scenario names such.
    pub recorded: Option<PoseTrajectory>,
    /// The skill that the scenario names instead of a demonstration.
    pub learned: Option<SkillsFile<SavedCut>>,
}

impl TomlAsset for FoodFile {
    type File = Self;
    const KIND: AssetKind = AssetKind::Food;
    const EXAMPLE: (&'static str, &'static str) =
        ("assets/foods/banana.toml", include_str!("../../../../../assets/foods/banana.toml"));

    fn from_file(file: Self) -> Result<Self, FieldError> {
        // lengths that make no solid are found here, not in the middle of a run
        file.food()?;
        Ok(file)
    }
}

impl TomlAsset for KnifeFile {
    type File = Self;
    const KIND: AssetKind = AssetKind::Knife;
    const EXAMPLE: (&'static str, &'static str) =
        ("assets/knives/chef.toml", include_str!("../../../../../assets/knives/chef.toml"));

    fn from_file(file: Self) -> Result<Self, FieldError> {
        file.knife()?;
        Ok(file)
    }
}

impl TaskPart for ResolvedCut {
    fn kind(&self) -> &'static str {
        KIND.name
    }

    fn file(&self) -> &dyn ScenarioFile {
        &self.scenario
    }

    fn text(&self, seed: u64) -> Result<String, String> {
        written(&self.scenario, seed)
    }

    fn start<'a>(&'a self, scenario: &'a ResolvedScenario, seed: u64) -> Box<dyn Runnable + 'a> {
        Box::new(CutTask::new(scenario, self, seed))
    }
}

impl ReadScenario for CutScenario {
    fn resolve(self, reader: &mut Reader<'_>, refused: &[FieldError]) -> Option<ResolvedTask> {
        let food: Option<FoodFile> = reader.asset("food.asset", &self.food.asset);
        let knife = read_knife(reader, "knife.asset", &self.knife.asset);
        let [(food_key, shown_food), (knife_key, shown_knife)] = self.demonstrations.names();
        let food = food.map(|file| self.food.changed(&file));
        let shown_food = shown_food.map_or_else(|| food.clone(), |name| reader.asset(food_key, name));
        let shown_knife = shown_knife.map_or_else(|| knife.clone(), |name| read_knife(reader, knife_key, name));
        let recorded = match &self.demonstrations {
            DemonstrationsConfig::Synthetic(_) | DemonstrationsConfig::Learned { .. } => Some(None),
            DemonstrationsConfig::Recorded(recording) => {
                reader.poses("demonstrations.recorded.asset", &recording.asset).map(Some)
            }
        };
        let learned = match &self.demonstrations {
            DemonstrationsConfig::Synthetic(_) | DemonstrationsConfig::Recorded(_) => Some(None),
            DemonstrationsConfig::Learned { asset } => {
                let restore = |_: &mut _, file: SkillsFile<SavedCut>| Some(file.skills.clone().restore().map(|_| file));
                reader.skills("demonstrations.learned.asset", asset, restore).map(Some)
            }
        };
        let cut = ResolvedCut {
            food: food?,
            knife: knife?,
            shown_food: shown_food?,
            shown_knife: shown_knife?,
            recorded: recorded?,
            learned: learned?,
            scenario: self,
        };
        if refused.is_empty()
            && let Err(error) = cut.check()
        {
            reader.problems.push(field_problem(reader.context, error));
            return None;
        }
        Some(ResolvedTask::Cut(Box::new(cut)))
    }
}

fn read_knife(reader: &mut Reader<'_>, key: &str, name: &str) -> Option<Knife> {
    // what the reader accepted makes a knife
    reader.asset::<KnifeFile>(key, name)?.knife().ok()
}

impl ResolvedCut {
    /// Name of the file of the food that the demonstration was or is to be shown with.
    pub(super) fn shown_food_name(&self) -> &str {
        let [(_, food), _] = self.scenario.demonstrations.names();
        food.unwrap_or(&self.scenario.food.asset)
    }

    /// Name of the file of the knife that the demonstration was or is to be shown with.
    pub(super) fn shown_knife_name(&self) -> &str {
        let [_, (_, knife)] = self.scenario.demonstrations.names();
        knife.unwrap_or(&self.scenario.knife.asset)
    }

    /// Checks what needs more than one part of the scenario: that the food can be made, and that all cuts meet it.
    fn check(&self) -> Result<(), FieldError> {
        let scenario = &self.scenario;
        let actual = Actual::new(scenario, &self.food, scenario.scenario.seed).map_err(|error| error.within("food"))?;
        let (length_m, _) = extent_m(&actual.believed.food, &actual.believed.world_from_food);
        if let Wanted::AtM(places_m) = &scenario.cut().wanted {
            for (index, &place_m) in places_m.iter().enumerate() {
                let expected = format!("less than {length_m:.4}, the length of the food `{}`", self.food.name);
                if place_m >= length_m {
                    return Err(FieldError::new(format!("task.cut.wanted.at_m.{index}"), place_m, expected));
                }
            }
        }
        let board = &scenario.board;
        let [x, y] = scenario.cut().food_at_m;
        let [cx, cy, _] = board.center_m;
        if (x - cx).abs() > 0.5 * board.size_m[0] || (y - cy).abs() > 0.5 * board.size_m[1] {
            let found = format!("[{x}, {y}], beside the board");
            let [low_x, high_x] = [cx - 0.5 * board.size_m[0], cx + 0.5 * board.size_m[0]];
            let [low_y, high_y] = [cy - 0.5 * board.size_m[1], cy + 0.5 * board.size_m[1]];
            let expected = format!("x from {low_x:.3} to {high_x:.3} and y from {low_y:.3} to {high_y:.3}");
            return Err(FieldError::new("task.cut.food_at_m", found, expected));
        }
        Ok(())
    }
}
