//! Options of the generalizing primitive.

use serde::{Deserialize, Serialize};

use super::rule::Rule;
use crate::field::{FieldError, within};
use crate::primitive::{DmpConfig, DmpForm};

/// What is made of the errors that leaving demonstrations out shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Selection {
    /// Rules share the answer in inverse proportion to the square of their mean squared error (default): on few
    /// demonstrations the best rule is best by chance, and errors of different rules partly cancel.
    #[default]
    Blended,
    /// The rule of the least error answers alone; without errors the first one.
    Chosen,
}

/// Options of the generalizing primitive.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct GeneralizingConfig {
    /// Options of the DMP that learns each demonstration; its form is the residual one.
    pub dmp: DmpConfig,
    /// Rules to choose from, each at most once; all by default.
    pub rules: Vec<Rule>,
    /// How they are chosen from.
    pub selection: Selection,
    /// Shrinkage of [`Rule::Linear`] to no dependence, relative to the spread of the shown displacements, 1e-6 to 1e6.
    #[schemars(range(min = 1e-6, max = 1e6))]
    pub shrinkage: f64,
    /// Width of the neighborhood of [`Rule::Local`] in spreads of the shown displacements, 0.01 to 100.
    #[schemars(range(min = 0.01, max = 100.0))]
    pub neighborhood: f64,
}

impl Default for GeneralizingConfig {
    fn default() -> Self {
        Self {
            dmp: DmpConfig::default(),
            rules: vec![Rule::Translation, Rule::Similarity, Rule::Linear, Rule::Local],
            selection: Selection::default(),
            shrinkage: 1.0,
            neighborhood: 0.5,
        }
    }
}

impl GeneralizingConfig {
    /// Checks every option.
    ///
    /// # Errors
    /// A [`FieldError`] with the field relative to this struct, such as `dmp.bases`.
    pub fn validate(&self) -> Result<(), FieldError> {
        self.dmp.validate().map_err(|error| error.within("dmp"))?;
        if self.dmp.form != DmpForm::Residual {
            let expected = "residual, the form whose shape is told apart from start and goal";
            return Err(FieldError::new("dmp.form", format!("{:?}", self.dmp.form), expected));
        }
        if self.rules.is_empty() {
            return Err(FieldError::new("rules", "no rule", "at least one rule"));
        }
        for (index, rule) in self.rules.iter().enumerate() {
            if self.rules.iter().take(index).any(|other| other == rule) {
                return Err(FieldError::new("rules", format!("{} twice", rule.name()), "each rule at most once"));
            }
        }
        within("shrinkage", self.shrinkage, 1e-6, 1e6)?;
        within("neighborhood", self.neighborhood, 0.01, 100.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::primitive::PrimitiveConfig;

    #[test]
    fn an_invalid_option_is_named_by_its_path() {
        let field = |config: GeneralizingConfig| PrimitiveConfig::Generalizing(config).validate().unwrap_err().field;
        let valid = GeneralizingConfig::default;
        assert_eq!(PrimitiveConfig::Generalizing(valid()).validate(), Ok(()));
        assert_eq!(field(GeneralizingConfig { rules: vec![], ..valid() }), "generalizing.rules");
        let twice = vec![Rule::Linear, Rule::Linear];
        assert_eq!(field(GeneralizingConfig { rules: twice, ..valid() }), "generalizing.rules");
        assert_eq!(field(GeneralizingConfig { shrinkage: 0.0, ..valid() }), "generalizing.shrinkage");
        assert_eq!(field(GeneralizingConfig { neighborhood: f64::NAN, ..valid() }), "generalizing.neighborhood");
        let dmp = DmpConfig { bases: 1, ..DmpConfig::default() };
        assert_eq!(field(GeneralizingConfig { dmp, ..valid() }), "generalizing.dmp.bases");
        let dmp = DmpConfig { form: DmpForm::Scaled, ..DmpConfig::default() };
        assert_eq!(field(GeneralizingConfig { dmp, ..valid() }), "generalizing.dmp.form");
    }

    #[test]
    fn rules_and_selection_are_named_in_a_file() {
        let text = r#"{"generalizing": {"rules": ["linear", "translation"], "selection": "chosen"}}"#;
        let PrimitiveConfig::Generalizing(config) = serde_json::from_str(text).unwrap() else { panic!("another kind") };
        assert_eq!(config.rules, [Rule::Linear, Rule::Translation]);
        assert_eq!(config.selection, Selection::Chosen);
        assert!(serde_json::from_str::<GeneralizingConfig>(r#"{"rule": []}"#).is_err());
    }
}
