//! What a food is made of, as far as a knife feels it.

use serde::{Deserialize, Serialize};
use skills::field::{FieldError, not_negative, positive, within};

/// Mechanical properties of a food, and where each number comes from.
///
/// Fracture energies of foods lie between 1 and 2000 J/m² (Vincent, "Application of fracture mechanics to the texture of
/// food", 2004; Kachru, Balasubramanian and Kotwaliwale 1995 for banana; Lang and Düring 1990 for the skin of grapes).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Material {
    /// Fracture energy R of a new cut surface at the reference speed, J/m², which is the force per length of edge, N/m.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub toughness_j_per_m2: f64,
    /// Bursting tension of the skin, N/m; 0 for a food without skin.
    #[schemars(range(min = 0.0))]
    pub skin_tension_n_per_m: f64,
    /// Shear stress τ between the flanks of the blade and the food, Pa.
    #[schemars(range(min = 0.0))]
    pub flank_shear_pa: f64,
    /// Young's modulus E, Pa.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub youngs_modulus_pa: f64,
    /// Force per length of edge and depth of the dent before the edge, N/m².
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub indentation_stiffness_pa: f64,
    /// Exponent n of the toughness in the speed of cutting: R (v/v₀)ⁿ; 0.1 for most foods, about 0.5 for cheese.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub rate_exponent: f64,
    /// Speed v₀ at which the toughness was measured, m/s.
    #[serde(default = "default_reference_speed")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub reference_speed_m_per_s: f64,
    /// Share s of the slice-push ratio that lowers the force, from 0 (slicing does not help) to 1 (frictionless law).
    #[serde(default = "default_slice_efficiency")]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub slice_efficiency: f64,
    /// Resistance to a new cut as a multiple of that to a running one, for a sharp edge.
    #[serde(default = "default_initiation_sharp")]
    #[schemars(range(min = 1.0, max = 10.0))]
    pub initiation_factor_sharp: f64,
    /// The same for a dull edge.
    #[serde(default = "default_initiation_dull")]
    #[schemars(range(min = 1.0, max = 10.0))]
    pub initiation_factor_dull: f64,
    /// Compressive stress σ at which the food yields under a dull edge, Pa.
    #[schemars(range(min = 0.0))]
    pub yield_stress_pa: f64,
    /// Depth of a cut, as a share of the section's height, at which a brittle food breaks at once; none for a tough food.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub brittle_depth_share: Option<f64>,
    /// Coefficient of friction on the board.
    #[schemars(range(min = 0.0, max = 2.0))]
    pub board_friction: f64,
    /// Density, kg/m³.
    #[schemars(range(min = DENSITIES[0], max = DENSITIES[1]))]
    pub density_kg_per_m3: f64,
    /// Where each number comes from.
    pub basis: MaterialBasis,
}

/// Where each property's number comes from: a source, or "estimate" with the reason for it.
///
/// What a file may leave out (reference speed, effect of slicing, factors of initiation) is that of most foods, and its basis
/// stands with [`Material`].
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
#[expect(missing_docs, reason = "each field is the basis of the property of the same name, documented in Material")]
pub struct MaterialBasis {
    pub toughness: String,
    pub skin_tension: String,
    pub flank_shear: String,
    pub youngs_modulus: String,
    pub indentation_stiffness: String,
    pub rate_exponent: String,
    pub yield_stress: String,
    pub brittle_depth_share: String,
    pub board_friction: String,
    pub density: String,
}

impl MaterialBasis {
    /// One basis for all numbers, such as that of a reference body.
    #[must_use]
    pub fn of_all(basis: &str) -> Self {
        let text = || basis.to_owned();
        Self {
            toughness: text(),
            skin_tension: text(),
            flank_shear: text(),
            youngs_modulus: text(),
            indentation_stiffness: text(),
            rate_exponent: text(),
            yield_stress: text(),
            brittle_depth_share: text(),
            board_friction: text(),
            density: text(),
        }
    }

    /// Checks that no basis is empty.
    fn validate(&self) -> Result<(), FieldError> {
        let stated = [
            ("toughness", &self.toughness),
            ("skin_tension", &self.skin_tension),
            ("flank_shear", &self.flank_shear),
            ("youngs_modulus", &self.youngs_modulus),
            ("indentation_stiffness", &self.indentation_stiffness),
            ("rate_exponent", &self.rate_exponent),
            ("yield_stress", &self.yield_stress),
            ("brittle_depth_share", &self.brittle_depth_share),
            ("board_friction", &self.board_friction),
            ("density", &self.density),
        ];
        match stated.iter().find(|(_, basis)| basis.trim().is_empty()) {
            None => Ok(()),
            Some((field, _)) => Err(FieldError::new(*field, "no text", "a source, or an estimate with its reason")),
        }
    }
}

/// Speed of most measurements with a blade, m/s.
fn default_reference_speed() -> f64 {
    0.02
}

/// The frictionless law of Atkins, Xu and Jeronimidis 2004.
fn default_slice_efficiency() -> f64 {
    1.0
}

/// Estimate: a sharp edge starts a cut at hardly more than the force that keeps it going.
fn default_initiation_sharp() -> f64 {
    1.1
}

/// Estimate: a dull edge needs twice the force.
fn default_initiation_dull() -> f64 {
    2.0
}

/// Densities that foods have, kg/m³: from puffed cereals to salt.
const DENSITIES: [f64; 2] = [50.0, 2500.0];
/// Edge radius at and below which an edge counts as sharp, m.
const SHARP_EDGE_M: f64 = 10e-6;
/// Edge radius from which an edge counts as dull, m.
const DULL_EDGE_M: f64 = 50e-6;

impl Material {
    /// Resistance to a new cut as a multiple of that to a running one, for an edge of radius `edge_radius_m`:
    /// [`initiation_factor_sharp`](Self::initiation_factor_sharp) up to 10 µm,
    /// [`initiation_factor_dull`](Self::initiation_factor_dull) from 50 µm, linear between.
    #[must_use]
    pub fn initiation_factor(&self, edge_radius_m: f64) -> f64 {
        let dullness = ((edge_radius_m - SHARP_EDGE_M) / (DULL_EDGE_M - SHARP_EDGE_M)).clamp(0.0, 1.0);
        self.initiation_factor_sharp + dullness * (self.initiation_factor_dull - self.initiation_factor_sharp)
    }

    /// Checks every number.
    ///
    /// # Errors
    /// A [`FieldError`] naming the offending value.
    pub fn validate(&self) -> Result<(), FieldError> {
        positive("toughness_j_per_m2", self.toughness_j_per_m2)?;
        not_negative("skin_tension_n_per_m", self.skin_tension_n_per_m)?;
        not_negative("flank_shear_pa", self.flank_shear_pa)?;
        positive("youngs_modulus_pa", self.youngs_modulus_pa)?;
        positive("indentation_stiffness_pa", self.indentation_stiffness_pa)?;
        within("rate_exponent", self.rate_exponent, 0.0, 1.0)?;
        positive("reference_speed_m_per_s", self.reference_speed_m_per_s)?;
        within("slice_efficiency", self.slice_efficiency, 0.0, 1.0)?;
        within("initiation_factor_sharp", self.initiation_factor_sharp, 1.0, 10.0)?;
        within("initiation_factor_dull", self.initiation_factor_dull, 1.0, 10.0)?;
        not_negative("yield_stress_pa", self.yield_stress_pa)?;
        if let Some(share) = self.brittle_depth_share {
            if !(share > 0.0 && share <= 1.0) {
                let expected = "a share of the height, greater than 0 and at most 1, or none for a soft food";
                return Err(FieldError::new("brittle_depth_share", share, expected));
            }
            // a brittle food takes its first load from its strength
            positive("yield_stress_pa", self.yield_stress_pa)?;
        }
        within("board_friction", self.board_friction, 0.0, 2.0)?;
        within("density_kg_per_m3", self.density_kg_per_m3, DENSITIES[0], DENSITIES[1])?;
        self.basis.validate().map_err(|error| error.within("basis"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    const NUMBERS: &str = "toughness_j_per_m2 = 150.0\nskin_tension_n_per_m = 0.0\nflank_shear_pa = 1500.0\n\
        youngs_modulus_pa = 1e5\nindentation_stiffness_pa = 3e5\nrate_exponent = 0.1\nyield_stress_pa = 0.0\n\
        board_friction = 0.4\ndensity_kg_per_m3 = 990.0\n";

    fn banana() -> Material {
        let basis = toml::to_string(&MaterialBasis::of_all("test")).unwrap();
        toml::from_str(&format!("{NUMBERS}[basis]\n{basis}")).unwrap()
    }

    #[test]
    fn what_a_file_leaves_out_is_that_of_most_foods() {
        let banana = banana();
        banana.validate().unwrap();
        assert_eq!(banana.brittle_depth_share, None);
        assert_relative_eq!(banana.reference_speed_m_per_s, 0.02);
        assert_relative_eq!(banana.initiation_factor(2e-6), 1.1);
        assert_relative_eq!(banana.initiation_factor(30e-6), 1.55, epsilon = 1e-12);
        assert_relative_eq!(banana.initiation_factor(1e-3), 2.0);
    }

    #[test]
    fn a_value_out_of_range_is_named() {
        let named = |change: fn(&mut Material)| {
            let mut material = banana();
            change(&mut material);
            material.validate().unwrap_err().field
        };
        assert_eq!(named(|m| m.toughness_j_per_m2 = 0.0), "toughness_j_per_m2");
        assert_eq!(named(|m| m.slice_efficiency = 1.5), "slice_efficiency");
        assert_eq!(named(|m| m.rate_exponent = f64::NAN), "rate_exponent");
        assert_eq!(named(|m| m.brittle_depth_share = Some(0.2)), "yield_stress_pa");
        assert_eq!(named(|m| m.brittle_depth_share = Some(f64::NAN)), "brittle_depth_share");
        assert_eq!(named(|m| m.density_kg_per_m3 = 1.04), "density_kg_per_m3");
        assert_eq!(named(|m| m.basis.density.clear()), "basis.density");
    }

    #[test]
    fn an_unknown_key_is_refused() {
        let error = toml::from_str::<Material>(&format!("{NUMBERS}color = 1")).unwrap_err();
        assert!(error.to_string().contains("unknown field `color`"), "{error}");
    }
}
