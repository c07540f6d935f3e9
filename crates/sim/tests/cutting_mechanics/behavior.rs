//! Stages of a cut, and what its forces may never do.

use nalgebra::{Point2, Vector2, Vector3};
use sim::cutting::knife::Edge;
use sim::cutting::material::Material;
use sim::cutting::mechanics::{Board, Cut, CuttingConfig, EdgeMotion, Stage};

use super::stroke::{DT_S, SPEED_M_PER_S, block, cut, disc, food, heel, long_edge, peak_push_n, push};

#[test]
fn a_cut_dents_begins_runs_and_ends_in_this_order() {
    let board = Some(Board::level(0.03));
    let mut cut =
        Cut::new(&block(0.04, 0.03), &food(200.0), &long_edge(), board, &CuttingConfig::default()).expect("valid");
    let mut stages = vec![cut.stage()];
    let above = EdgeMotion::translating(heel(0.0, -0.001), Vector2::zeros());
    stages.push(cut.step(&above, DT_S).expect("finite").stage);
    stages.extend(push(&mut cut, 0.03, SPEED_M_PER_S, 0.0).iter().map(|(_, step)| step.stage));
    stages.dedup();
    assert_eq!(stages, [Stage::Approaching, Stage::Indenting, Stage::Cutting, Stage::Separated]);
}

#[test]
fn a_dull_edge_needs_twice_the_running_force_to_begin_and_then_drops() {
    let blunt = Edge { radius_m: 60e-6, ..long_edge() };
    let mut cut = Cut::new(&block(0.04, 0.03), &food(200.0), &blunt, None, &CuttingConfig::default()).expect("valid");
    let answers = push(&mut cut, 0.01, SPEED_M_PER_S, 0.0);
    // one step of 20 µm of the dent of 0.1 mm per 8 N
    approx::assert_abs_diff_eq!(peak_push_n(&answers), 16.0, epsilon = 1.6);
    let last = answers.last().expect("steps").1.force_in_section.y;
    approx::assert_abs_diff_eq!(last, -8.0, epsilon = 0.08);
    assert!(cut.energy().crush_j > 0.0);
}

#[test]
fn the_skin_of_a_grape_bursts_at_the_measured_force() {
    // Lang and Düring 1990: bursting tension 110 to 420 N/m; the flesh alone takes 0.8 N
    let grape =
        Material { skin_tension_n_per_m: 250.0, indentation_stiffness_pa: 1.6e5, youngs_modulus_pa: 8e4, ..food(40.0) };
    let mut cut = cut(&disc(0.020), &grape);
    let peak = peak_push_n(&push(&mut cut, 0.018, SPEED_M_PER_S, 0.0));
    assert!((1.7..6.4).contains(&peak), "{peak}");
    assert!(cut.depth_m() > 0.01, "and then the flesh is cut");
}

#[test]
fn slicing_begins_a_cut_under_a_smaller_force() {
    let peak = |ratio: f64| {
        let mut cut = cut(&block(0.04, 0.03), &food(200.0));
        peak_push_n(&push(&mut cut, 0.01, SPEED_M_PER_S, ratio))
    };
    assert!(peak(1.0) < 0.65 * peak(0.0), "{} {}", peak(1.0), peak(0.0));
}

#[test]
fn a_biscuit_breaks_at_once_under_its_strength() {
    let biscuit = Material {
        toughness_j_per_m2: 5.0,
        youngs_modulus_pa: 5e7,
        indentation_stiffness_pa: 5e7,
        yield_stress_pa: 1e6,
        brittle_depth_share: Some(0.2),
        ..food(5.0)
    };
    let mut cut = cut(&block(0.06, 0.007), &biscuit);
    let answers = push(&mut cut, 0.0025, 0.002, 0.0);
    // 1 MPa · 0.3 mm · 60 mm = 18 N; one step of 2 µm is 6 N of the rigid load
    let peak = peak_push_n(&answers);
    assert!((12.0..=18.5).contains(&peak), "{peak}");
    let broken = answers.iter().find(|(_, step)| step.stage == Stage::Fractured).expect("it breaks").0;
    approx::assert_abs_diff_eq!(broken, 0.0014, epsilon = 0.0001);
    assert!(cut.ligament_share() > 0.7);
}

#[test]
fn withdrawal_meets_friction_only_and_the_same_cut_goes_on() {
    let sticky = Material { flank_shear_pa: 1500.0, ..food(150.0) };
    let mut cut = cut(&block(0.04, 0.03), &sticky);
    push(&mut cut, 0.015, SPEED_M_PER_S, 0.0);
    let area = cut.cut_area_m2();
    let mut stages = Vec::new();
    for k in 1..=800 {
        let y = 0.015 - f64::from(k) * 2e-5;
        let step =
            cut.step(&EdgeMotion::translating(heel(0.0, y), Vector2::new(0.0, -SPEED_M_PER_S)), DT_S).expect("finite");
        let friction = 2.0 * 1500.0 * 0.04 * y.max(0.0);
        if k > 10 {
            approx::assert_abs_diff_eq!(step.force_in_section.y, friction, epsilon = 0.02);
        }
        stages.push(step.stage);
    }
    stages.dedup();
    assert_eq!(stages, [Stage::Cutting, Stage::InCut, Stage::Withdrawn]);
    assert_eq!(cut.cut_area_m2(), area);
}

#[test]
fn forces_hold_a_free_knife_but_never_turn_it_round() {
    // a knife of the assumed mass that coasts into foods of every kind: friction and fracture only brake
    for (toughness, shear) in [(5.0, 0.0), (150.0, 1500.0), (700.0, 50_000.0)] {
        for velocity in [Vector2::new(0.0, 0.3), Vector2::new(0.4, 0.1), Vector2::new(-0.02, 0.2)] {
            let sticky = Material { flank_shear_pa: shear, ..food(toughness) };
            let mut cut = cut(&block(0.04, 0.03), &sticky);
            let (mut at, mut v) = (heel(0.0, -0.0005), velocity);
            let mass = CuttingConfig::default().effective_mass_kg;
            for _ in 0..3000 {
                at += v * DT_S;
                let step = cut.step(&EdgeMotion::translating(at, v), DT_S).expect("finite");
                v += step.force_in_section.xy() / mass * DT_S;
                assert!(v.x * velocity.x.signum() >= -1e-9, "slid back: {v:?}");
                // the dent springs back by at most its own energy
                let stored = 0.5 * toughness * 0.04 * 2e-4;
                assert!(v.y >= -(2.0 * stored / mass).sqrt(), "thrown back: {v:?}");
                assert!(v.norm() <= velocity.norm() + 1e-9);
            }
        }
    }
}

#[test]
fn the_cut_surface_follows_a_blade_that_is_led_aside_and_pushes_back_beyond_its_freedom() {
    let mut cut = cut(&block(0.04, 0.03), &food(200.0));
    let mut sideways = Vec::new();
    for k in 1..=1400 {
        let depth = f64::from(k) * 2e-5;
        let straight = EdgeMotion::translating(heel(0.0, depth), Vector2::new(0.0, SPEED_M_PER_S));
        let step = cut.step(&EdgeMotion { lateral_m: 0.1 * depth, ..straight }, DT_S).expect("finite");
        sideways.push((0.1 * depth, step.force_in_section.z));
    }
    assert!(sideways.iter().all(|&(aside, force)| if aside <= 0.001 { force == 0.0 } else { force < 0.0 }));
    // a surface that leans 1 in 10, without roughness
    let quality = cut.quality();
    approx::assert_abs_diff_eq!(quality.tilt_rad, 0.1_f64.atan(), epsilon = 1e-3);
    assert!(quality.mean_deviation_m < 1e-5, "{quality:?}");
}

#[test]
fn the_same_motion_gives_the_same_bits() {
    let run = || {
        let mut cut = cut(&disc(0.03), &Material { rate_exponent: 0.1, flank_shear_pa: 1500.0, ..food(150.0) });
        push(&mut cut, 0.029, SPEED_M_PER_S, 0.7)
    };
    assert_eq!(run(), run());
}

#[test]
fn results_do_not_depend_on_step_and_cells() {
    let work = |cell_m: f64, dt: f64| {
        let config = CuttingConfig { cell_m, ..CuttingConfig::default() };
        let mut cut = Cut::new(&disc(0.03), &food(150.0), &long_edge(), None, &config).expect("valid");
        let steps = (0.0305 / (SPEED_M_PER_S * dt)).round() as u32;
        for k in 1..=steps {
            let y = f64::from(k) * dt * SPEED_M_PER_S;
            let motion = EdgeMotion::translating(heel(0.0, y), Vector2::new(0.0, SPEED_M_PER_S));
            cut.step(&motion, dt).expect("finite");
        }
        cut.energy().work_j
    };
    let reference = work(0.00025, 0.001);
    for (cell, dt) in [(0.0005, 0.001), (0.0001, 0.001), (0.00025, 0.00025), (0.00025, 0.002)] {
        approx::assert_relative_eq!(work(cell, dt), reference, max_relative = 0.01);
    }
}

#[test]
fn a_motion_that_is_not_finite_is_refused_by_name() {
    let mut cut = cut(&block(0.04, 0.03), &food(200.0));
    let still = EdgeMotion::translating(Point2::origin(), Vector2::zeros());
    let broken = EdgeMotion { velocity_in_section: Vector3::new(0.0, f64::NAN, 0.0), ..still };
    let message = cut.step(&broken, DT_S).expect_err("refused").to_string();
    assert!(message.contains("speed of the knife (m/s) was NaN"), "{message}");
    let message = cut.step(&still, 0.0).expect_err("refused").to_string();
    assert!(message.contains("time step (s) was 0"), "{message}");
}
