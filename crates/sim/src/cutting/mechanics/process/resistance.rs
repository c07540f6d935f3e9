//! What an edge has to overcome: the toughness at its speed, and the load under which a cut begins.

use super::Cut;

/// Angle by which skin dips under the edge when it bursts, rad: estimate, which gives the forces measured on grapes.
const SKIN_ANGLE_RAD: f64 = std::f64::consts::FRAC_PI_6;
/// Width on which an edge crushes a brittle food before it breaks, m: size of the pores of biscuits, estimate.
const BRITTLE_WIDTH_M: f64 = 0.0003;
/// The power law of the speed holds within this factor of the reference speed.
const RATE_RANGE: f64 = 100.0;

impl Cut {
    /// Resistance to a running crack, N/m: R (v/v₀)ⁿ + (1 + μ) σ 2ρ, ρ the radius of the edge.
    pub(super) fn resistance_n_per_m(&self) -> f64 {
        let material = &self.material;
        let speed = self.rate_speed_m_per_s / material.reference_speed_m_per_s;
        let rate = speed.clamp(1.0 / RATE_RANGE, RATE_RANGE).powf(material.rate_exponent);
        material.toughness_j_per_m2 * rate + self.bluntness_n_per_m()
    }

    /// What a blunt edge or a wire adds by crushing (law of wire cutting: linear in the diameter), N/m.
    fn bluntness_n_per_m(&self) -> f64 {
        (1.0 + self.edge.friction) * self.material.yield_stress_pa * 2.0 * self.edge.radius_m
    }

    /// Load per length at which a cut begins under a mean dent, N/m; slicing lowers it as it lowers a running cut's.
    pub(super) fn initiation_n_per_m(&self, dent: f64) -> f64 {
        let material = &self.material;
        let load = if self.brittle() {
            material.yield_stress_pa * BRITTLE_WIDTH_M.max(2.0 * self.edge.radius_m)
        } else {
            let skin = 2.0 * material.skin_tension_n_per_m * SKIN_ANGLE_RAD.sin();
            let running = material.initiation_factor(self.edge.radius_m) * self.resistance_n_per_m();
            running.max(skin)
        };
        let ratio = material.slice_efficiency * self.slid_m / dent.max(f64::MIN_POSITIVE) + self.edge.tooth_ratio;
        load / (1.0 + ratio * ratio)
    }

    pub(super) fn mean_dent(&self, width: f64) -> f64 {
        self.front.engaged().map(|node| self.front.dent[node] * self.front.width[node]).sum::<f64>() / width
    }

    /// Length of the edge that presses, along the edge, m.
    pub(super) fn pressing_length(&self) -> f64 {
        let length = |node: usize| self.front.width[node] * (1.0 + self.front.slope[node].powi(2)).sqrt();
        self.front.engaged().map(length).sum()
    }
}
