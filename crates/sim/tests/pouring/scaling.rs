//! How the cost of a step grows with the number of grains: with what each grain touches, or with what all of them occupy.

use nalgebra::Isometry3;
use rapier3d::math::Pose;
use rapier3d::prelude::*;
use sim::pouring::*;

use super::scene::{filling, straight, world};
use super::settings::cpu_s;

/// Cups beside each other in one world, equally filled.
struct Cups {
    physics: PhysicsWorld,
    batches: Vec<Grains>,
}

impl Cups {
    /// Every cup is as full as the shipped one is with 300 grains.
    fn new(cups: usize, grains_in_each: usize) -> Self {
        let scale = (grains_in_each as f64 / 300.0).cbrt();
        let engine = GrainEngineConfig::default();
        let cup = straight(0.035 * scale, 0.09 * scale);
        let filling = filling(&cup, &GrainConfig::default(), &engine, grains_in_each, 1);
        let (mut physics, all) = (world(&engine), InteractionGroups::all());
        let batches = (0..cups).map(|place| {
            let at = Isometry3::translation(0.5 * place as f64, 0.0, 0.0);
            let body = physics.insert_body(RigidBodyBuilder::fixed().pose(Pose::from(at)));
            cup.attach(&mut physics, body, &Isometry3::identity(), all, filling.batch.config());
            Grains::insert_filling(&mut physics, &filling, &at, all).expect("filled")
        });
        let batches = batches.collect();
        Self { physics, batches }
    }

    fn step(&mut self) {
        for grains in &mut self.batches {
            grains.before_step(&mut self.physics);
        }
        self.physics.step();
    }

    /// Pairs that the engine keeps, and points that push, for each grain.
    fn contacts(&self) -> (f64, f64) {
        let grains: usize = self.batches.iter().map(Grains::len).sum();
        let pairs = || self.physics.narrow_phase.contact_pairs();
        let points = pairs().flat_map(ContactPair::solver_manifolds).flat_map(|manifold| &manifold.points);
        let pushing = points.filter(|point| point.data.impulse > 0.0).count();
        (pairs().count() as f64 / grains as f64, pushing as f64 / grains as f64)
    }
}

/// Cups and grains in each, as `WIELD_CUPS=10x100` says, else a series.
fn series() -> Vec<(usize, usize)> {
    let number = |text: &str| text.parse().expect("a number of cups, x, a number of grains");
    match std::env::var("WIELD_CUPS") {
        Ok(text) => text.split_once('x').map(|(cups, grains)| (number(cups), number(grains))).into_iter().collect(),
        Err(_) => vec![(1, 100), (1, 300), (1, 1000), (10, 100), (30, 100), (100, 100)],
    }
}

/// Grains in cups that do not touch each other have the same work to do, each, as those in one cup. What a step costs
/// more for each of them is therefore not work but memory: instructions counted by
/// `WIELD_CUPS=1x1000 WIELD_STEPS=60 valgrind --tool=cachegrind --cache-sim=yes TEST_PROGRAM --ignored scaling::` stay the same.
#[test]
#[ignore = "half a minute: cargo test --release --workspace --test pouring -- --ignored --nocapture scaling::"]
fn the_work_for_each_grain_is_the_same_in_one_cup_and_in_a_hundred() {
    let steps: usize = std::env::var("WIELD_STEPS").map_or(300, |text| text.parse().expect("a number of steps"));
    let mut contacts = Vec::new();
    for (cups, grains_in_each) in series() {
        let mut world = Cups::new(cups, grains_in_each);
        let start_s = cpu_s();
        (0..steps).for_each(|_| world.step());
        let cost_us = 1e6 * (cpu_s() - start_s) / (steps * cups * grains_in_each) as f64;
        let (pairs, pushing) = world.contacts();
        println!(
            "{cups:3} x {grains_in_each:4} grains: {cost_us:.2} us, {pairs:.2} pairs and {pushing:.2} pushing points each"
        );
        contacts.push(pushing);
    }
    // a grain at rest is held by two to three points, whatever the number; the walls' share shrinks with the cup's size
    assert!(contacts.iter().all(|pushing| (2.2..2.6).contains(pushing)), "{contacts:?}");
}
