//! Tests of the monitor: places, events and flow of grains that are put where the test wants them.

use rapier3d::math::Vector;
use rapier3d::prelude::*;

use super::*;
use crate::pouring::{Container, ContainerFile, GrainBatch, GrainConfig};
use crate::random::{Purpose, stream};

/// Source at the origin, target half a meter along x, grains without weight.
struct Stage {
    physics: PhysicsWorld,
    grains: Grains,
    monitor: PourMonitor,
}

const IN_SOURCE: [f64; 3] = [0.0, 0.0, 0.05];
const ABOVE_TARGET: [f64; 3] = [0.5, 0.01, 0.12];
const IN_TARGET: [f64; 3] = [0.5, 0.01, 0.05];
const BESIDE: [f64; 3] = [0.25, 0.0, 0.2];
const ON_TABLE: [f64; 3] = [0.25, 0.0, 0.004];

impl Stage {
    fn new(count: usize) -> Self {
        let file: ContainerFile =
            toml::from_str(include_str!("../../../../../assets/containers/wide_cup.toml")).expect("valid");
        let cup = Container::new(&file).expect("valid");
        let mut physics = PhysicsWorld::new();
        physics.gravity = Vector::ZERO;
        physics.integration_parameters.dt = 0.01;
        let grain = GrainConfig { size_variation: 0.0, ..GrainConfig::default() };
        let mut place = |x: f64, tilt: f64| {
            let pose =
                RigidBodyBuilder::fixed().translation(Vector::new(x, 0.0, 0.0)).rotation(Vector::new(0.0, tilt, 0.0));
            let body = physics.insert_body(pose);
            cup.attach(&mut physics, body, &Isometry3::identity(), InteractionGroups::none(), &grain)
        };
        // tilted as far as a stopped flow may be a clog, about its base
        let (source, target) = (place(0.0, 0.8), place(0.5, 0.0));
        let batch = GrainBatch::draw(&grain, count, &mut stream(1, Purpose::Variation, 0)).expect("valid");
        let start = source.world_from_container(&physics) * Point3::from(IN_SOURCE);
        let poses = vec![Isometry3::translation(start.x, start.y, start.z); count];
        let grains = Grains::insert(&mut physics, batch, &poses, InteractionGroups::none()).expect("as many");
        let monitor = PourMonitor::new(MonitorConfig::default(), &physics, &grains, source, Some(target));
        Self { physics, grains, monitor }
    }

    fn put(&mut self, grain: usize, at: [f64; 3], speed: f64) {
        let body = &mut self.physics.bodies[self.grains.handles()[grain]];
        body.set_translation(Vector::from_array(at), true);
        body.set_linvel(Vector::new(0.0, 0.0, speed), true);
    }

    fn look(&mut self, steps: usize) -> Counts {
        (0..steps).for_each(|_| self.monitor.after_step(&self.physics, &self.grains));
        self.monitor.counts()
    }
}

#[test]
fn a_grain_is_in_exactly_one_place() {
    let mut stage = Stage::new(4);
    assert_eq!(stage.look(1), Counts { source: 4, ..Counts::default() });
    stage.put(1, IN_TARGET, 0.0);
    stage.put(2, BESIDE, -1.0);
    stage.put(3, ON_TABLE, 0.0);
    assert_eq!(stage.look(1), Counts { source: 1, target: 1, flying: 1, spilt: 1 });
    let mass: f64 = stage.grains.batch().masses_kg().sum();
    assert!((4.0 * stage.monitor.mass_kg(Place::Flying) - mass).abs() < 1e-15);
}

#[test]
fn a_grain_at_rest_outside_is_spilt_wherever_it_lies_and_one_that_moves_on_is_not() {
    let mut stage = Stage::new(1);
    stage.put(0, BESIDE, 0.0);
    assert_eq!(stage.look(20).flying, 1);
    assert_eq!(stage.look(10).spilt, 1);
    stage.put(0, BESIDE, -0.5);
    assert_eq!(stage.look(1).flying, 1);
}

#[test]
fn landing_and_bouncing_out_are_noted_once_each() {
    let mut stage = Stage::new(1);
    stage.put(0, ABOVE_TARGET, -1.0);
    stage.look(2);
    assert!(stage.monitor.landing().points_m().is_empty());
    stage.put(0, IN_TARGET, -1.0);
    stage.look(3);
    let landed = stage.monitor.landing().points_m().to_vec();
    assert_eq!(landed.len(), 1);
    assert!((landed[0] - nalgebra::Vector2::new(0.0, 0.01)).norm() < 1e-12, "{}", landed[0]);
    stage.put(0, ABOVE_TARGET, 1.0);
    stage.look(3);
    assert_eq!(stage.monitor.bounce_outs(), 1);
    stage.put(0, IN_TARGET, -1.0);
    stage.look(3);
    assert_eq!((stage.monitor.bounce_outs(), stage.monitor.landing().points_m().len()), (1, 1));
}

#[test]
fn flow_is_mass_over_time_and_a_stop_while_tilted_is_one_clog() {
    let mut stage = Stage::new(10);
    // nothing has flowed: waiting is no clog
    stage.look(100);
    assert_eq!(stage.monitor.clogs(), 0);
    // a grain every 0.04 s: five in 0.2 s
    for grain in 0..5 {
        stage.put(grain, BESIDE, -1.0);
        stage.look(4);
    }
    let one = stage.grains.batch().masses_kg().next().expect("ten");
    assert!((stage.monitor.flow_kg_per_s() - 5.0 * one / 0.2).abs() < 1e-9, "{}", stage.monitor.flow_kg_per_s());
    assert_eq!(stage.monitor.flow_kg_per_s(), stage.monitor.peak_flow_kg_per_s());
    stage.look(50);
    assert_eq!(stage.monitor.clogs(), 0);
    stage.look(100);
    assert_eq!(stage.monitor.clogs(), 1, "a stop is one clog however long");
    // one interval with flow: no variation, and the pause after it is not part of the pour
    assert!((stage.monitor.mean_flow_kg_per_s() - 5.0 * one / 0.2).abs() < 1e-9);
    assert!(stage.monitor.flow_variation() < 1e-6);
}

#[test]
fn an_empty_source_does_not_clog() {
    let mut stage = Stage::new(3);
    (0..3).for_each(|grain| stage.put(grain, BESIDE, -1.0));
    stage.look(200);
    assert_eq!(stage.monitor.clogs(), 0);
}

#[test]
fn spread_is_that_of_the_points() {
    let mut landing = LandingSpread::with_room_for(101);
    (0..=100).for_each(|i| landing.note(0.001 * f64::from(i), 0.0));
    assert!((landing.mean_m().x - 0.05).abs() < 1e-12);
    // of a uniform distribution: width/√12, here (n²−1)/12 with n = 101
    assert!((landing.deviation_m().x - 0.001 * (10_200.0_f64 / 12.0).sqrt()).abs() < 1e-9);
    // 95 % of 100 steps, rounded at both ends
    assert!((landing.width_m().x - 0.095).abs() < 0.0011, "{}", landing.width_m().x);
    assert_eq!(landing.width_m().y, 0.0);
}
