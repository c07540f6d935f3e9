//! The gain study against the numbers of another program: RK4 of the equations of motion at 0.5 ms, torques held for 1 ms.

use robot::Manipulator;
use sim::spatial::gain_study::{Condition, StudiedGains, bare_arm_divergence_s, gain_study, report};

const GRIP: &str = "panda_hand_tcp";
/// Share by which the two programs may differ: they share the motion but not the start, which was told only in part.
const SHARE: f64 = 0.25;

fn panda() -> Manipulator {
    Manipulator::from_urdf_str(include_str!("../../../../assets/robots/panda.urdf")).expect("a valid file")
}

#[test]
fn errors_are_those_of_an_independent_integration() {
    let expected = [
        (StudiedGains::Paper, Condition::Perfect, 0.10),
        (StudiedGains::Paper, Condition::Inertia { share: -0.2 }, 140.0),
        (StudiedGains::Paper, Condition::Inertia { share: 0.1 }, 69.0),
        (StudiedGains::Paper, Condition::Payload, 103.0),
        (StudiedGains::Paper, Condition::PushDown, 191.0),
        (StudiedGains::Paper, Condition::PushSideways, 215.0),
        (StudiedGains::G2, Condition::Inertia { share: -0.2 }, 12.0),
        (StudiedGains::G2, Condition::Payload, 10.0),
        (StudiedGains::G2, Condition::PushSideways, 19.0),
        (StudiedGains::G3, Condition::PushDown, 6.8),
        (StudiedGains::G3, Condition::PushSideways, 6.3),
        (StudiedGains::G4, Condition::PushDown, 2.7),
    ];
    for (gains, condition, millimeters) in expected {
        let study = gain_study(&panda(), GRIP, &[gains], &[condition]).expect("a Panda can do it");
        let run = study.runs.first().expect("one run");
        let found = 1000.0 * run.tip_error_m;
        assert!(
            (found / millimeters - 1.0).abs() < SHARE,
            "{gains:?} {condition:?}: {found} mm, expected {millimeters}"
        );
        assert!(!run.diverged && run.peak_torque_nm < 87.0, "{run:?}");
    }
}

#[test]
fn the_gains_stiffness_and_settling_are_those_of_an_independent_integration() {
    let study = gain_study(&panda(), GRIP, &[StudiedGains::Paper, StudiedGains::G2], &[]).expect("a Panda can do it");
    for (summary, tip, settling_s) in
        [(study.summaries[0], [561.0, 45.0, 45.0], 1.71), (study.summaries[1], [7117.0, 545.0, 504.0], 0.49)]
    {
        for (found, expected) in summary.tip_stiffness_n_per_m.iter().zip(tip) {
            assert!((found / expected - 1.0).abs() < 0.1, "{summary:?}");
        }
        assert!((summary.settling_s.expect("settles") / settling_s - 1.0).abs() < 0.1, "{summary:?}");
    }
}

#[test]
fn the_study_repeats_itself_to_the_bit() {
    let conditions = [Condition::Scatter { draw: 2 }, Condition::Everything];
    let study = || gain_study(&panda(), GRIP, &[StudiedGains::G2], &conditions).expect("a Panda can do it");
    assert_eq!(study(), study());
}

#[test]
fn limits_of_the_motors_are_never_met_on_the_motion() {
    let study = gain_study(&panda(), GRIP, &[StudiedGains::G3], &[Condition::Perfect, Condition::TorqueLimits]);
    let runs = study.expect("a Panda can do it").runs;
    assert_eq!(runs[0].tip_error_m, runs[1].tip_error_m);
}

#[test]
fn a_bare_arm_diverges_under_the_papers_damping_and_not_under_less() {
    let diverges = |damping| bare_arm_divergence_s(&panda(), GRIP, damping).expect("a Panda can do it");
    assert_eq!(diverges(8.0), None);
    assert!(diverges(9.5).is_some());
    assert!(diverges(10.0) < diverges(9.5), "{:?} {:?}", diverges(10.0), diverges(9.5));
}

#[test]
fn another_arm_is_refused() {
    let planar = include_str!("../../../../assets/robots/planar_3r.urdf");
    let planar = Manipulator::from_urdf_str(planar).expect("a valid file");
    let error = gain_study(&planar, "flange", &StudiedGains::ALL, &Condition::ALL).expect_err("refused").to_string();
    assert!(error.contains("an arm of 3 joints"), "{error}");
}

#[test]
#[ignore = "writes the document docs/arm.md to standard output, 20 s: \
            cargo test --release -p sim --test spatial -- --ignored --nocapture the_whole_study"]
fn the_whole_study() {
    println!("{}", report(&panda(), GRIP).expect("a Panda can do it"));
}
