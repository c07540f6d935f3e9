//! The study as a document.

use robot::Manipulator;

use super::condition::Condition;
use super::gains::StudiedGains;
use super::runs::{bare_arm_divergence_s, gain_study};
use crate::error::SimError;

/// Dampings ξ, N m s/rad, that are tried on the arm without rotor inertia.
const BARE_ARM_DAMPINGS: [f64; 3] = [8.0, 9.5, 10.0];

const INTRODUCTION: &str = "\
# The arm under the paper's controller

How closely a Panda carries its hand along a motion under the impedance controller of Eq. (34), with the sign of the torque in
Eq. (33) mended, for several gains and several ways in which the moving arm differs from the controller's model. The hand, 25°
below the horizontal, moves 0.30 m sideways and 0.10 m up and turns by 110° about its approach axis in 3 s (minimum jerk), then
holds for 1 s. The arm moves in the physics engine, with the inertias of Gaz et al. (2019) and the rotor inertias of MuJoCo
Menagerie's FR3; torques are held for 1 ms. Joint friction is Coulomb and viscous friction fitted to the sigmoids of Gaz et al.
Motors give any torque but where limits are named.

Gains, ke in 1/s and ξ in N m s/rad: paper 3 and 10; G1 10 and 10; G2 10 and 40 ×4 / 10 / 10 / 5; G3 20 and 60 ×4 / 15 / 15 / 8;
G4 30 and 100 ×4 / 25 / 25 / 12.
";

const READING: &str = "\
A perfect model tells gains apart by fractions of a millimeter. What an arm meets in a kitchen, a payload that nobody weighed,
a model that is a tenth off, a knife that pushes back with 10 N, moves the tool by 7 to 23 cm under the paper's gains, by half
a centimeter to two under G2 and by 2 to 7 mm under G3. Hence G2 for free motion and G3 for cutting; the force of a known process and
the weight of a known load belong into the controller.
";

/// Runs the whole study with `arm`, a Panda without rotor inertias whose frame `grip` is the hand's center, and writes it up in
/// Markdown.
///
/// # Errors
/// As [`gain_study`].
pub fn report(arm: &Manipulator, grip: &str) -> Result<String, SimError> {
    let study = gain_study(arm, grip, &StudiedGains::ALL, &Condition::ALL)?;
    let tables = study.to_markdown();
    let mut bare = String::from(
        "Without rotor inertia the wrist is so light that damping held for a millisecond overshoots. On the same motion with ke = 3, a\n\
         perfect model and the check of stability left out:\n\n| ξ, N m s/rad | outcome |\n| --- | --- |\n",
    );
    for damping in BARE_ARM_DAMPINGS {
        let outcome = bare_arm_divergence_s(arm, grip, damping)?
            .map_or_else(|| "stable".into(), |time_s| format!("diverges, 1 rad off at {time_s:.2} s"));
        bare.push_str(&format!("| {damping} | {outcome} |\n"));
    }
    Ok(format!("{INTRODUCTION}\n{tables}\n{READING}\n## The bare arm\n\n{bare}"))
}
