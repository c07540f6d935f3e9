//! `wield gains`: how closely an arm carries its hand under the controller's gains, in several conditions.

use std::path::{Path, PathBuf};

use robot::Manipulator;
use sim::spatial::gain_study;

use super::{Exit, assets_for, panics, say, say_aside, say_error, unwritable};
use crate::assets::AssetKind;
use crate::files::{probe, write_whole};

pub const AFTER_HELP: &str = "\
The arm moves its hand along one motion under five sets of gains, with a perfect model, with wrong inertias, with an unknown
mass in the hand, with 10 N at the tip, with joint friction, with limits of torque and its rate, and with all of these.

Examples:
  wield gains                            the table for the Panda, on the screen
  wield gains --out docs/arm.md          the same, into a file

Exit codes: 0 success, 2 bad input, 3 the study could not be computed, or the file not written.";

/// Options of `wield gains`.
#[derive(Debug, clap::Args)]
pub struct GainsArguments {
    /// Arm, a file in the folder of robots; it must have the Panda's joints
    #[arg(long, value_name = "NAME", default_value = "panda")]
    robot: String,
    /// Frame of the arm that is the hand's center
    #[arg(long, value_name = "FRAME", default_value = "panda_hand_tcp")]
    frame: String,
    /// File to write, in Markdown; the screen if absent
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
}

/// Reads the arm, runs the study, prints or writes it.
pub fn execute(arguments: &GainsArguments, assets: Option<&Path>) -> Exit {
    let arm = match arm(&arguments.robot, &arguments.frame, assets) {
        Ok(arm) => arm,
        Err(reason) => {
            say_error(&reason);
            return Exit::BadInput;
        }
    };
    if let Some((file, error)) = arguments.out.as_ref().and_then(|file| Some((file, probe(file).err()?))) {
        say_error(&unwritable(file, &error, "--out"));
        return Exit::BadInput;
    }
    let (gains, conditions) = (gain_study::StudiedGains::ALL.len(), gain_study::Condition::ALL.len());
    say_aside(&format!(
        "moving the arm under {gains} sets of gains in {conditions} conditions; this takes some ten seconds"
    ));
    let study = panics::catch(|| gain_study::report(&arm, &arguments.frame).map_err(|error| error.to_string()));
    let text = match study {
        Ok(Ok(text)) => text,
        Ok(Err(reason)) | Err(reason) => {
            say_error(&format!("study gains: {reason}"));
            return Exit::Crashed;
        }
    };
    let Some(file) = &arguments.out else { return say(&text) };
    match write_whole(file, text.as_bytes()) {
        Ok(()) => say(&format!("results: {}\n", file.display())),
        Err(error) => {
            say_error(&format!("write {}: {error}", file.display()));
            Exit::Crashed
        }
    }
}

fn arm(name: &str, frame: &str, assets: Option<&Path>) -> Result<Manipulator, String> {
    let path = assets_for(assets, None)
        .path(AssetKind::Robot, name)
        .map_err(|error| format!("read robot `{name}`: {error}; name one that `wield list robots` shows"))?;
    let text = std::fs::read_to_string(&path).map_err(|error| format!("read {}: {error}", path.display()))?;
    let arm = Manipulator::from_urdf_str(&text).map_err(|error| format!("{}: {error}", path.display()))?;
    arm.frame(frame).map_err(|error| format!("{}: {error}; name another with --frame", path.display()))?;
    match arm.joint_count() {
        7 => Ok(arm),
        found => {
            Err(format!("{}: found {found} joints; expected the Panda's 7, for which the gains are", path.display()))
        }
    }
}
