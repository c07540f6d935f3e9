//! Damaged URDF texts never panic, whatever the damage.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test stops at the first surprise")]

mod common;

use common::{BRANCHED, PLANAR_3R};
use nalgebra::{DMatrix, DVector};
use proptest::prelude::*;
use robot::Manipulator;

/// Values that numbers in a file are replaced by.
const ODD_VALUES: [&str; 12] = ["nan", "inf", "-inf", "1e308", "-1e308", "1e-320", "0", "-1", "", "1 2", "base", "<"];

/// Reads the text and, if it is accepted, evaluates the model once.
fn exercise(text: &str) {
    let Ok(arm) = Manipulator::from_urdf_str(text) else { return };
    let n = arm.joint_count();
    let mut workspace = arm.workspace();
    workspace.set_state(&DVector::from_element(n, 0.3), &DVector::from_element(n, 0.1)).unwrap();
    let (mut matrix, mut vector) = (DMatrix::zeros(0, 0), DVector::zeros(0));
    workspace.mass_matrix_into(&mut matrix);
    workspace.coriolis_matrix_into(&mut matrix);
    workspace.forward_dynamics_into(&DVector::zeros(n), &mut vector).unwrap();
}

/// The text with its `choice`-th quoted value replaced.
fn with_value(text: &str, choice: usize, value: &str) -> String {
    let mut pieces: Vec<&str> = text.split('"').collect();
    let quoted = pieces.len() / 2;
    pieces[2 * (choice % quoted) + 1] = value;
    pieces.join("\"")
}

proptest! {
    #[test]
    fn replaced_values_never_panic(
        first in 0_usize..1000, second in 0_usize..1000, value in prop::sample::select(&ODD_VALUES[..]),
    ) {
        for text in [PLANAR_3R, BRANCHED] {
            exercise(&with_value(&with_value(text, first, value), second, value));
        }
    }

    #[test]
    fn exchanged_values_never_panic(from in 0_usize..1000, to in 0_usize..1000) {
        let quoted: Vec<&str> = BRANCHED.split('"').skip(1).step_by(2).collect();
        exercise(&with_value(BRANCHED, to, quoted[from % quoted.len()]));
    }

    #[test]
    fn removed_pieces_never_panic(start in 0_usize..4000, length in 0_usize..200) {
        let characters: Vec<char> = BRANCHED.chars().collect();
        let start = start % characters.len();
        let end = (start + length).min(characters.len());
        exercise(&characters[..start].iter().chain(&characters[end..]).collect::<String>());
    }

    #[test]
    fn arbitrary_text_never_panics(text in ".{0,200}") {
        exercise(&text);
    }
}
