//! The maps against numbers of an independent program (Python, NumPy): `data/sigmoid.json`.

use approx::assert_relative_eq;
use serde_json::Value;
use skills::corridor::Bounds;
use skills::corridor_map::{
    CorridorMap, CorridorMapConfig, LogitFamily, MForm, MotionEnds, NormalForm, Proximal, Validity, extended_logit,
};

/// Both programs work in double precision on numbers of order one to ten.
const VECTORS: f64 = 1e-9;
const DELTA: f64 = 0.01;

fn file() -> Value {
    serde_json::from_str(include_str!("../data/sigmoid.json")).unwrap()
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap()
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(number).collect()
}

fn close(found: f64, expected: f64) {
    assert_relative_eq!(found, expected, max_relative = VECTORS, epsilon = VECTORS);
}

fn case_ends(case: &Value) -> MotionEnds {
    let at = |name: &str| number(&case[name]);
    MotionEnds {
        start: at("x0"),
        start_bounds: Bounds::still(at("L0"), at("H0")),
        goal: at("g"),
        goal_bounds: Bounds::still(at("Lg"), at("Hg")),
    }
}

#[test]
fn the_normal_form_agrees_with_the_reference() {
    for case in file()["cases"].as_array().unwrap() {
        let ends = case_ends(case);
        close(ends.shares().0, number(&case["p0"]));
        close(ends.shares().1, number(&case["pg"]));
        let map = NormalForm::solve(&ends, DELTA).unwrap();
        if case["degenerate"] == Value::Bool(true) {
            // any k is a solution; the tangent of σ is taken
            assert_eq!((map.k(), map.k_high()), (4.0, 0.5));
            continue;
        }
        close(map.k(), number(&case["k"]));
        close(map.k_high(), number(&case["kH"]));
        close(1.0 - map.k_high(), number(&case["kL"]));
        assert_eq!(Validity::of(&ends).holds(), case["valid"].as_bool().unwrap());
        let middle = &case["mid"];
        let bounds = Bounds::still(number(&middle["L"]), number(&middle["H"]));
        let columns = [&middle["x"], &middle["xu"], &middle["x_back"]].map(numbers);
        for ((x, unconstrained), back) in columns[0].iter().zip(&columns[1]).zip(&columns[2]) {
            close(map.unconstrained(&bounds, 0.5, *x), *unconstrained);
            close(map.constrained(&bounds, 0.5, *unconstrained), *back);
        }
    }
}

#[test]
fn the_family_and_its_inverse_agree_with_the_reference() {
    for member in file()["family"].as_array().unwrap() {
        let [lower, upper, progress, x, unconstrained, back] =
            ["L", "H", "rho", "x", "xu", "x_back_strict"].map(|name| numbers(&member[name]));
        let bounds: Vec<Bounds> = lower.iter().zip(&upper).map(|(l, h)| Bounds::still(*l, *h)).collect();
        let last = x.len() - 1;
        let ends = MotionEnds { start: x[0], start_bounds: bounds[0], goal: x[last], goal_bounds: bounds[last] };
        let at = |name: &str| number(&member[name]);
        let (blend, strength, delta) = (at("a"), at("S_over_W"), at("delta"));
        let map = LogitFamily::new(blend, strength, delta, &ends).unwrap();
        close(map.offsets().0, at("b0"));
        close(map.offsets().1, at("bg"));
        for row in 0..x.len() {
            close(map.unconstrained(&bounds[row], progress[row], x[row]), unconstrained[row]);
            close(map.constrained(&bounds[row], progress[row], unconstrained[row]), back[row]);
        }
        // the two kinds that are configured are members
        let kind = match blend {
            1.0 => CorridorMapConfig::MForm(MForm { strength }),
            0.0 => CorridorMapConfig::Proximal(Proximal { strength }),
            _ => continue,
        };
        let selected = kind.map(&ends, delta).unwrap();
        close(selected.map.unconstrained(&bounds[2], progress[2], x[2]), unconstrained[2]);
    }
}

#[test]
fn the_continued_logit_agrees_with_the_reference() {
    let vectors = &file()["ext_logit"];
    for (p, y) in numbers(&vectors["p"]).iter().zip(numbers(&vectors["y"])) {
        close(extended_logit(*p, number(&vectors["delta"])), y);
    }
}
