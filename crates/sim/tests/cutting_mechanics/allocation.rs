//! What a step of a cut allocates: nothing.

use nalgebra::Vector2;
use sim::cutting::material::Material;
use sim::cutting::mechanics::{EdgeMotion, FailureMonitor, Observation, Thresholds};

use super::stroke::{DT_S, SPEED_M_PER_S, cut, disc, food, heel};

#[test]
fn cutting_and_watching_allocate_nothing() {
    let mut cut = cut(&disc(0.03), &Material { rate_exponent: 0.1, flank_shear_pa: 1500.0, ..food(150.0) });
    let mut monitor = FailureMonitor::new(Thresholds::default()).expect("valid");
    let counted = allocation_counter::measure(|| {
        for k in 0..1600 {
            let depth = -0.001 + f64::from(k) * SPEED_M_PER_S * DT_S;
            let motion = EdgeMotion::translating(heel(0.5 * depth, depth), Vector2::new(0.01, SPEED_M_PER_S));
            let step = cut.step(&motion, DT_S).expect("finite");
            let seen = Observation { driven: true, advance_m_per_s: step.advance_m_per_s, ..Observation::default() };
            monitor.observe(&cut, &seen, DT_S);
        }
    });
    assert!(cut.cut_area_m2() > 0.9 * cut.section_area_m2());
    assert_eq!(counted.count_total, 0, "{counted:?}");
}
