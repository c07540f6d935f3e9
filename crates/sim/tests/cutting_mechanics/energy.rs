//! The power identity: without friction, a knife works toughness times area, whatever its motion.

use approx::assert_relative_eq;
use nalgebra::{Point2, Rotation2, Vector2, Vector3};
use rand::RngExt;
use sim::cutting::knife::KnifeFile;
use sim::cutting::mechanics::{Board, Cut, CuttingConfig, EdgeMotion, Stage};
use sim::random::{Purpose, stream};

use super::stroke::{DT_S, SPEED_M_PER_S, block, cut, disc, food, push};

/// Tolerance of the identity in columns and steps.
const IDENTITY: f64 = 0.01;

/// A motion of the knife's frame from angle and place of the point `pivot` of the knife, by central differences.
fn motion(pivot: Point2<f64>, place: impl Fn(f64) -> (Point2<f64>, f64), time: f64) -> EdgeMotion {
    let heel = |time: f64| {
        let (at, angle) = place(time);
        (at - Rotation2::new(angle) * pivot.coords, angle)
    };
    let h = 1e-6;
    let ((before, angle_before), (now, angle_rad), (after, angle_after)) = (heel(time - h), heel(time), heel(time + h));
    let velocity = (after - before) / (2.0 * h);
    EdgeMotion {
        angle_rad,
        angular_velocity_in_section: Vector3::new(0.0, 0.0, (angle_after - angle_before) / (2.0 * h)),
        ..EdgeMotion::translating(now, velocity)
    }
}

fn follow(cut: &mut Cut, pivot: Point2<f64>, place: impl Fn(f64) -> (Point2<f64>, f64), duration: f64) {
    for k in 1..=(duration / DT_S).round() as u32 {
        let motion = motion(pivot, &place, DT_S * f64::from(k));
        cut.step(&motion, DT_S).expect("finite");
    }
}

/// Checks work = R A on the energy that is not stored, and that the parts add up.
fn assert_identity(cut: &Cut, toughness: f64) {
    let energy = cut.energy();
    let spent = energy.work_j - energy.elastic_j - energy.crush_j;
    assert!(cut.cut_area_m2() > 0.3 * cut.section_area_m2(), "{}", cut.cut_area_m2());
    assert_relative_eq!(spent, toughness * cut.cut_area_m2(), max_relative = IDENTITY);
    assert!(energy.balance_j().abs() < IDENTITY * energy.work_j, "{energy:?}");
}

#[test]
fn oblique_pushes_work_toughness_times_area() {
    for angle in [-0.3, -0.1, 0.2, 0.35] {
        let mut cut = cut(&block(0.04, 0.03), &food(200.0));
        let place = |time: f64| (Point2::new(0.004 * time, -0.008 + SPEED_M_PER_S * time), angle);
        follow(&mut cut, Point2::new(0.2, 0.0), place, 2.4);
        assert_identity(&cut, 200.0);
    }
}

#[test]
fn rocking_a_curved_edge_works_toughness_times_area() {
    let file: KnifeFile = toml::from_str(include_str!("../../../../assets/knives/chef.toml")).expect("valid");
    let mut edge = file.knife().expect("valid").edge;
    (edge.radius_m, edge.friction) = (0.0, 0.0);
    for polygons in [block(0.04, 0.03), disc(0.03)] {
        let mut cut = Cut::new(&polygons, &food(200.0), &edge, None, &CuttingConfig::default()).expect("valid");
        let place = |time: f64| {
            let rock = 0.12 * (5.0 * time).sin();
            (Point2::new(0.01 * (5.0 * time).cos(), -0.006 + 0.01 * time), rock)
        };
        follow(&mut cut, Point2::new(0.09, 0.0), place, 3.2);
        assert_identity(&cut, 200.0);
    }
}

#[test]
fn random_strokes_work_toughness_times_area() {
    for seed in 0..12 {
        let mut random = stream(seed, Purpose::Variation, 0);
        let mut draw = |limit: f64| -> f64 { random.random_range(-limit..limit) };
        // sums of sines with a steady sinking: sawing, retreating and rocking
        let waves: Vec<[f64; 4]> = (0..4)
            .map(|k| {
                let frequency = 2.0 + 3.0 * f64::from(k) + draw(1.0);
                [frequency, draw(0.006), draw(0.0015), draw(0.03)]
            })
            .collect();
        let place = |time: f64| {
            let sum = |which: usize| waves.iter().map(|wave| wave[which] * (wave[0] * time).sin()).sum::<f64>();
            (Point2::new(sum(1), -0.008 + 0.012 * time + sum(2)), sum(3))
        };
        let mut cut = cut(&disc(0.03), &food(150.0));
        follow(&mut cut, Point2::new(0.2, 0.0), place, 2.6);
        assert_identity(&cut, 150.0);
    }
}

#[test]
fn a_tip_that_sinks_into_the_food_works_toughness_times_area() {
    // the edge ends in the food: its front is cut like a steep edge
    let mut cut = cut(&block(0.10, 0.03), &food(200.0));
    let place = |time: f64| (Point2::new(0.01 * time, -0.001 + 0.01 * time), 0.0);
    follow(&mut cut, Point2::new(0.4, 0.0), place, 2.4);
    assert_identity(&cut, 200.0);
}

#[test]
fn a_cut_down_to_the_board_works_toughness_times_area_too() {
    let board = Some(Board::level(0.03));
    let edge = super::stroke::long_edge();
    let mut cut = Cut::new(&block(0.04, 0.03), &food(200.0), &edge, board, &CuttingConfig::default()).expect("valid");
    let answers = push(&mut cut, 0.030, SPEED_M_PER_S, 0.0);
    assert_eq!(answers.last().map(|(_, step)| step.stage), Some(Stage::Separated));
    let share = cut.energy().work_j / 0.240;
    // what is torn at the end, less than 2 % of the section, is not paid for
    assert!((0.98..1.0 + IDENTITY).contains(&share), "{share}");
    assert!(cut.quality().torn_area_m2 < 0.02 * cut.section_area_m2());
}

#[test]
fn friction_takes_what_fracture_does_not() {
    let sticky = sim::cutting::material::Material { flank_shear_pa: 2000.0, ..food(200.0) };
    let mut cut = cut(&block(0.04, 0.03), &sticky);
    push(&mut cut, 0.0295, SPEED_M_PER_S, 0.5);
    let energy = cut.energy();
    // flanks: 2 τ ∫ w y ds = 2 τ w h²/2 √(1 + ξ²)
    let friction = 2000.0 * 0.04 * 0.0295 * 0.0295 * 1.25_f64.sqrt();
    assert_relative_eq!(energy.friction_j, friction, max_relative = 0.02);
    assert_relative_eq!(energy.fracture_j, 200.0 * cut.cut_area_m2(), max_relative = IDENTITY);
    assert!(energy.balance_j().abs() < IDENTITY * energy.work_j, "{energy:?}");
    assert!(energy.elastic_j >= 0.0 && energy.crush_j >= 0.0);
}

#[test]
fn a_stroke_above_the_food_works_nothing() {
    let mut cut = cut(&block(0.04, 0.03), &food(200.0));
    let place = |time: f64| (Point2::new(0.05 * time, -0.001), 0.0);
    follow(&mut cut, Point2::new(0.2, 0.0), place, 0.5);
    assert_eq!((cut.energy().work_j, cut.stage()), (0.0, Stage::Approaching));
    let still = EdgeMotion::translating(Point2::new(-0.2, -0.001), Vector2::zeros());
    assert_eq!(cut.step(&still, DT_S).expect("finite").force_in_section, Vector3::zeros());
}
