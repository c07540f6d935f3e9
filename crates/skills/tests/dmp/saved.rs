//! A learned primitive written to a file and read back.

use nalgebra::DVector;
use skills::regression::{Lwr, RegressionConfig};
use skills::{Dmp, DmpConfig, DmpForm, MovementPrimitive, RolloutRequest, SavedDmp, SkillError};

use super::accuracy::compared;

fn learned(config: &DmpConfig) -> Dmp {
    Dmp::learn(config, &[compared(3)]).unwrap()
}

fn saved() -> SavedDmp {
    learned(&DmpConfig { bases: 12, ..DmpConfig::default() }).saved()
}

fn field(saved: SavedDmp) -> String {
    match saved.restore() {
        Err(SkillError::InvalidConfig(error)) => error.field,
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_primitive_read_back_from_text_rolls_out_to_the_same_bits() {
    let lwr = RegressionConfig::Lwr(Lwr {});
    let configs = [
        DmpConfig::default(),
        DmpConfig { form: DmpForm::Scaled, bases: 31, alpha: 17.3, gamma: 3.9, ..DmpConfig::default() },
        DmpConfig { form: DmpForm::Eq1Literal, regression: lwr, overlap: Some(0.37), ..DmpConfig::default() },
    ];
    for config in configs {
        let dmp = learned(&config);
        let text = serde_json::to_string(&dmp.saved()).unwrap();
        let restored = serde_json::from_str::<SavedDmp>(&text).unwrap().restore().unwrap();
        assert_eq!(restored, dmp);
        let goal = DVector::from_vec(vec![0.3, -1.0, 2.0]);
        let request = RolloutRequest { settle_s: 0.2, ..RolloutRequest::new(DVector::zeros(3), goal, 1.7, 0.0123) };
        let bits = |dmp: &Dmp| -> Vec<u64> {
            let rollout = dmp.rollout(&request).unwrap();
            let tables = [rollout.positions().samples(), rollout.velocities(), rollout.accelerations()];
            tables.into_iter().flat_map(|table| table.iter().map(|value| value.to_bits())).collect()
        };
        assert_eq!(bits(&restored), bits(&dmp));
    }
}

#[test]
fn saved_numbers_out_of_range_are_refused_by_name() {
    assert_eq!(field(SavedDmp { alpha: 0.0, ..saved() }), "alpha");
    assert_eq!(field(SavedDmp { gamma: f64::NAN, ..saved() }), "gamma");
    assert_eq!(field(SavedDmp { overlap: 1.0, ..saved() }), "overlap");
    assert_eq!(field(SavedDmp { end_speed: -1.0, ..saved() }), "end_speed");
    let mut infinite = saved();
    infinite.weights[3][1] = f64::INFINITY;
    assert_eq!(field(infinite), "weights[3]");
}

#[test]
fn weights_of_another_shape_are_refused() {
    let mut ragged = saved();
    ragged.weights[5].pop();
    assert_eq!(field(ragged), "weights[5]");
    assert_eq!(field(SavedDmp { weights: vec![vec![1.0]], ..saved() }), "weights");
    assert_eq!(field(SavedDmp { weights: vec![vec![]; 4], ..saved() }), "weights[0]");
}

#[test]
fn an_unknown_key_and_a_missing_one_are_refused() {
    let mut value = serde_json::to_value(saved()).unwrap();
    value["colour"] = 1.into();
    assert!(serde_json::from_value::<SavedDmp>(value.clone()).is_err());
    value.as_object_mut().unwrap().remove("colour");
    assert!(serde_json::from_value::<SavedDmp>(value.clone()).is_ok());
    value.as_object_mut().unwrap().remove("gamma");
    assert!(serde_json::from_value::<SavedDmp>(value).is_err());
}
