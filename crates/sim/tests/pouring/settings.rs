//! The engine's settings beside each other on the validation cases: what the choice of the defaults rests on.

use nalgebra::Point3;
use rapier3d::prelude::*;
use sim::pouring::*;

use super::heap::{grain, heap_angle_deg};
use super::scene::{Scene, container, filling, straight, world};
use super::silo::{discharge_per_s, mankoc_per_s};

/// Time that this thread has had a processor, s; other programs on the machine do not count.
pub fn cpu_s() -> f64 {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").expect("a Linux machine");
    text.split(' ').next().and_then(|first| first.parse::<f64>().ok()).expect("nanoseconds") * 1e-9
}

/// Cost per grain and step, r.m.s. speed and mean contact overlap of 300 grains at rest in the cup.
fn rest(engine: &GrainEngineConfig) -> (f64, f64, f64) {
    let source = container("source_cup");
    let filling = filling(&source, &GrainConfig::default(), engine, 300, 2);
    let mut physics = world(engine);
    let body = physics.insert_body(RigidBodyBuilder::fixed());
    let all = InteractionGroups::all();
    source.attach(&mut physics, body, &nalgebra::Isometry3::identity(), all, filling.batch.config());
    let mut grains =
        Grains::insert_filling(&mut physics, &filling, &nalgebra::Isometry3::identity(), all).expect("filled");
    let start = cpu_s();
    for _ in 0..500 {
        grains.before_step(&mut physics);
        physics.step();
    }
    let cost = (cpu_s() - start) / (500.0 * 300.0);
    let squares: f64 = grains.bodies(&physics).map(|body| body.linvel().length_squared()).sum();
    let depth = |pair: &ContactPair| pair.find_deepest_contact().map_or(0.0, |(_, contact)| -contact.dist);
    let deepest = physics.narrow_phase.contact_pairs().map(depth).fold(0.0, f64::max);
    (1e6 * cost, (squares / 300.0).sqrt(), 1e3 * deepest)
}

#[test]
#[ignore = "minutes: cargo test --release -p sim --test pouring -- --ignored --nocapture settings_side_by_side"]
fn settings_side_by_side() {
    let base = GrainEngineConfig::default();
    let soft = |a: f64, b: f64, base: &GrainEngineConfig| GrainEngineConfig {
        contact_frequency_hz: a,
        static_contact_frequency_hz: b,
        ..base.clone()
    };
    let named = [
        ("default", base.clone()),
        ("length unit 0.02", GrainEngineConfig { length_unit_m: 0.02, ..base.clone() }),
        ("recycling flipped", GrainEngineConfig { contact_recycling: !base.contact_recycling, ..base.clone() }),
        ("200/400 Hz", soft(200.0, 400.0, &base)),
        ("480/480 Hz", soft(480.0, 480.0, &base)),
        ("simplified friction", GrainEngineConfig { friction: FrictionScheme::Simplified, ..base.clone() }),
        ("2 substeps", GrainEngineConfig { substeps: 2, ..base.clone() }),
        ("1 ms, 2 substeps", GrainEngineConfig { substeps: 2, time_step_s: 0.001, ..base.clone() }),
        ("1 ms, 1 substep", GrainEngineConfig { substeps: 1, time_step_s: 0.001, ..base.clone() }),
    ];
    for (name, engine) in named {
        let (cost, rms, depth) = rest(&engine);
        let heap: f64 = (0..2).map(|seed| heap_angle_deg(&engine, &grain(0.1), 440, seed)).sum::<f64>() / 2.0;
        let rate = discharge_per_s(&engine, 5.0, 600, 1) / mankoc_per_s(5.0, 0.006);
        println!(
            "{name:20} {cost:5.2} us/grain/step, rest {rms:8.1e} m/s, overlap {depth:.3} mm, heap {heap:.1} deg, flow {rate:.3} of the law"
        );
        assert!(depth < 1.0 && rms < 0.1, "{name} does not rest");
    }
}

/// Processor time per grain and step in a cup that is as full with any number of grains: at rest, and poured in 2 s.
fn costs_us(count: usize) -> (f64, f64) {
    let scale = (count as f64 / 300.0).cbrt();
    let engine = GrainEngineConfig::default();
    let cup = straight(0.035 * scale, 0.09 * scale);
    let filling = filling(&cup, &GrainConfig::default(), &engine, count, 1);
    let lip = Point3::new(0.0, 0.0, 0.4);
    let mut scene = Scene::new(&cup, &filling, None, &engine, lip);
    let mut cost = |steps: u32, end_rad: f64| {
        let start = cpu_s();
        (0..steps).for_each(|step| scene.step(lip, end_rad * f64::from(step) / f64::from(steps)));
        1e6 * (cpu_s() - start) / f64::from(steps) / count as f64
    };
    (cost(200, 0.0), cost(1000, 130.0_f64.to_radians()))
}

/// What is left per grain and step of 2 ms, of which an arm takes 80 us, for 300 grains in real time.
const MOST_US: f64 = (2000.0 - 80.0) / 300.0;

#[test]
#[ignore = "half a minute: cargo test --release -p sim --test pouring -- --ignored --nocapture three_hundred_grains"]
fn three_hundred_grains_run_faster_than_real_time_beside_an_arm() {
    for count in [100, 300, 1000] {
        let (rest, poured) = costs_us(count);
        println!("{count} grains: {rest:.2} us per grain and step at rest, {poured:.2} us poured");
        assert!(count != 300 || rest.max(poured) < MOST_US, "{rest} and {poured} us, {MOST_US} allowed");
    }
}
