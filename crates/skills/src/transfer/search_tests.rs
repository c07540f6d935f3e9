//! The search for phases: the paper's task, its exactness against an exhaustive one, and the reasons when there is no way.

use approx::assert_relative_eq;
use proptest::prelude::*;

use super::super::fixtures::{DISC, block, ell, of_family, workplace};
use super::*;
use crate::outline::{Outline, PlacedOutline};
use crate::tool::Tool;
use crate::tool::family::{Hook, Tee, ToolShape};
use crate::transfer::{Everywhere, NoPhases, RectangularReach, explain};

/// A few roundings of lengths of some decimeters.
const ROUNDING_M: f64 = 1e-12;

fn names<'a>(tool: &'a Tool, phases: &Phases) -> Vec<&'a str> {
    phases.phases.iter().map(|phase| tool.surfaces[phase.hold.surface].name.as_str()).collect()
}

#[test]
fn the_papers_task_takes_three_phases_bottom_tip_top() {
    let (tool, obstacles) = (ell(), [block(0.03, 0.04, [0.0, 0.10])]);
    let workplace = workplace(&tool, &DISC, &obstacles);
    let config = SearchConfig::default();
    let (start, goal) = (Point2::new(0.06, 0.08), Point2::new(-0.055, 0.11));
    let mut search = PhaseSearch::new(&workplace, &config, &[], start, goal).unwrap();
    let found = search.solve().unwrap();
    assert_eq!(names(&tool, &found), ["bottom", "tip", "top"]);
    let corners: Vec<_> = found.phases.iter().map(|phase| phase.to_world).collect();
    assert_relative_eq!(found.phases[0].from_world, start, epsilon = ROUNDING_M);
    assert_relative_eq!(corners[2], goal, epsilon = ROUNDING_M);
    // the lane under the obstacle begins 12 + 15 mm below it; a cell lies half its side deeper, and on a whole one
    assert!(corners[0].y <= 0.053 - 0.0005 && corners[0].y > 0.053 - 0.002, "{corners:?}");
    for pair in found.phases.windows(2) {
        assert_relative_eq!(pair[0].to_world, pair[1].from_world, epsilon = ROUNDING_M);
    }
}

/// Costs of all states by relaxing every edge until nothing changes.
fn exhaustive(search: &mut PhaseSearch<'_>) -> f64 {
    let holds = search.holds.len();
    let mut costs = vec![f64::INFINITY; search.world.grid.len() * holds];
    for hold in 0..holds {
        if search.is_start([0, 0], hold) {
            let state = search.state([0, 0], hold).unwrap();
            costs[state as usize] = search.config.off_center * search.holds[hold].place_m.abs();
        }
    }
    loop {
        let mut changed = false;
        for state in 0..costs.len() as u32 {
            let (cell, hold) = search.place(state);
            let cost = costs[state as usize];
            if cost.is_infinite() {
                continue;
            }
            let mut edges = Vec::new();
            if let Some((next, length_m)) = search.pushed(cell, hold) {
                let dearer = 1.0 + search.config.deviation_per_m2 * search.world.squared_deviation(next);
                edges.push((search.state(next, hold).unwrap(), length_m * dearer));
            }
            for other in 0..holds {
                if let Some(switch) = search.switch_cost(cell, hold, other).filter(|_| search.is_held(cell, other)) {
                    edges.push((search.state(cell, other).unwrap(), switch));
                }
            }
            for (to, price) in edges {
                if cost + price < costs[to as usize] - ROUNDING_M {
                    costs[to as usize] = cost + price;
                    changed = true;
                }
            }
        }
        if !changed {
            break;
        }
    }
    let goal = search.goal;
    (0..holds)
        .filter_map(|hold| search.state(goal, hold))
        .map(|state| costs[state as usize])
        .fold(f64::INFINITY, f64::min)
}

#[test]
fn the_cost_equals_that_of_an_exhaustive_search() {
    let tool = ell();
    let obstacles = [block(0.03, 0.04, [0.0, 0.10])];
    let workplace = workplace(&tool, &DISC, &obstacles);
    let config = SearchConfig { cell_m: 0.006, places: 3, ..SearchConfig::default() };
    let reference = [Point2::new(0.06, 0.08), Point2::new(0.0, 0.03), Point2::new(-0.055, 0.11)];
    let mut solved = 0;
    for (start, goal) in [
        ([0.06, 0.08], [-0.055, 0.11]),
        ([0.06, 0.08], [-0.03, 0.03]),
        ([0.05, 0.06], [0.05, 0.03]),
        ([0.07, 0.12], [0.05, 0.04]),
        ([-0.06, 0.05], [-0.06, 0.15]),
        ([-0.06, 0.05], [0.06, 0.05]),
    ] {
        let mut search = PhaseSearch::new(&workplace, &config, &reference, start.into(), goal.into()).unwrap();
        let expected = exhaustive(&mut search);
        let found = search.solve().map_or(f64::INFINITY, |phases| phases.cost_m);
        assert!(found == expected || (found - expected).abs() < 1e-9, "{start:?} to {goal:?}: {found}, not {expected}");
        solved += usize::from(found.is_finite());
    }
    // the tool has no surface that pushes to the right
    assert_eq!(solved, 5);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]
    #[test]
    fn the_cost_is_that_of_an_exhaustive_search_on_random_maps(
        start in [-0.07f64..0.07, 0.02f64..0.16], goal in [-0.07f64..0.07, 0.02f64..0.16], turn in -3.0f64..3.0,
        blocks in prop::collection::vec([0.01f64..0.05, 0.01f64..0.05, -0.06f64..0.06, 0.03f64..0.15], 0..3),
        kind in 0usize..3, deviation_per_m2 in 0.0f64..3000.0, switch_cost_m in 0.001f64..0.1,
    ) {
        let shapes: [&dyn ToolShape; 2] = [&Tee::default(), &Hook::default()];
        let tool = shapes.get(kind).map_or_else(ell, |shape| of_family("tool", *shape));
        let obstacles: Vec<PlacedOutline> = blocks.iter().map(|[w, h, x, y]| block(*w, *h, [*x, *y])).collect();
        let place = Workplace {
            tool_angle_rad: turn, object_margin_m: 0.004, reach: &Everywhere, ..workplace(&tool, &DISC, &obstacles)
        };
        let config =
            SearchConfig { cell_m: 0.009, places: 2, deviation_per_m2, switch_cost_m, ..SearchConfig::default() };
        let reference = [Point2::from(start), Point2::new(0.0, 0.03), Point2::from(goal)];
        let mut search = PhaseSearch::new(&place, &config, &reference, start.into(), goal.into()).unwrap();
        prop_assume!(!search.is_at_goal());
        let expected = exhaustive(&mut search);
        let found = search.solve().map_or(f64::INFINITY, |phases| phases.cost_m);
        prop_assert!(found == expected || (found - expected).abs() < 1e-9, "{found}, not {expected}");
    }
}

#[test]
fn what_is_given_up_changes_the_phases_and_never_makes_them_cheaper() {
    let tool = ell();
    let workplace = workplace(&tool, &DISC, &[]);
    let config = SearchConfig::default();
    for barring in [Barring::Start, Barring::End, Barring::Change(0), Barring::ChangeNearby(0)] {
        let mut search =
            PhaseSearch::new(&workplace, &config, &[], Point2::new(0.05, 0.10), Point2::new(-0.05, 0.05)).unwrap();
        let first = search.solve().unwrap();
        search.bar(&first, barring);
        let second = search.solve().unwrap();
        assert!(second.cost_m >= first.cost_m && second.phases != first.phases, "{barring:?}");
    }
}

#[test]
fn too_many_states_and_a_start_at_the_goal_are_refused() {
    let tool = ell();
    let place = workplace(&tool, &DISC, &[]);
    let (start, goal) = (Point2::new(0.05, 0.10), Point2::new(-0.05, 0.05));
    let fine = SearchConfig { cell_m: 1e-4, places: 21, ..SearchConfig::default() };
    let refused = PhaseSearch::new(&place, &fine, &[], start, goal).err().unwrap();
    assert!(refused.field == "cell_m" && refused.to_string().contains("holds"), "{refused}");
    let config = SearchConfig::default();
    assert!(PhaseSearch::new(&place, &config, &[], start, start).unwrap().solve().is_none());
    let reason = explain(&place, &config, start, start + Vector2::repeat(1e-4));
    assert!(matches!(reason, NoPhases::AtGoal { .. }), "{reason}");
}

#[test]
fn a_barred_switch_is_not_taken_again() {
    let tool = ell();
    let workplace = workplace(&tool, &DISC, &[]);
    let config = SearchConfig::default();
    let mut search =
        PhaseSearch::new(&workplace, &config, &[], Point2::new(0.05, 0.10), Point2::new(-0.05, 0.05)).unwrap();
    let first = search.solve().unwrap();
    search.bar(&first, Barring::ChangeNearby(0));
    let second = search.solve().unwrap();
    assert!(second.cost_m >= first.cost_m);
    assert_ne!(first.phases[..2], second.phases[..2]);
}

#[test]
fn a_turned_tool_reaches_its_goal_exactly() {
    let tool = ell();
    let turn = 0.3;
    let workplace = Workplace { tool_angle_rad: turn, reach: &Everywhere, ..workplace(&tool, &DISC, &[]) };
    let config = SearchConfig::default();
    let mut search =
        PhaseSearch::new(&workplace, &config, &[], Point2::new(0.05, 0.10), Point2::new(-0.03, 0.06)).unwrap();
    let found = search.solve().unwrap();
    let end = found.phases.last().unwrap().to_world;
    assert_relative_eq!(end, Point2::new(-0.03, 0.06), epsilon = ROUNDING_M);
    assert!(search.holds().iter().all(|hold| (hold.tool_angle_rad - turn).abs() < ROUNDING_M));
    for phase in &found.phases {
        let along = (phase.to_world - phase.from_world).normalize();
        assert_relative_eq!(along, phase.hold.direction, epsilon = 1e-9);
        // the tool's own normal points there
        let normal = tool.surfaces[phase.hold.surface].contact_at(phase.hold.place_m).normal;
        assert_relative_eq!(phase.hold.center_from_tool.rotation * normal.into_inner(), along, epsilon = 1e-9);
    }
}

#[test]
fn a_box_is_pushed_by_faces_that_lie_flat_against_it() {
    let tool = ell();
    let square = Outline::Box { width_m: 0.024, height_m: 0.024 };
    let config = SearchConfig::default();
    let straight = workplace(&tool, &square, &[]);
    let turned = Workplace { object_angle_rad: 0.4, ..workplace(&tool, &square, &[]) };
    let (start, goal) = (Point2::new(0.05, 0.10), Point2::new(-0.03, 0.06));
    assert!(PhaseSearch::new(&straight, &config, &[], start, goal).unwrap().solve().is_some());
    assert!(PhaseSearch::new(&turned, &config, &[], start, goal).unwrap().holds().is_empty());
    assert!(matches!(explain(&turned, &config, start, goal), NoPhases::Holds { surfaces: 3, .. }));
}

#[test]
fn no_way_is_explained_by_the_constraint_that_closes_it() {
    let tool = ell();
    let config = SearchConfig::default();
    let (start, goal) = (Point2::new(0.06, 0.08), Point2::new(-0.055, 0.11));
    let reason = |workplace: &Workplace<'_>, start: Point2<f64>, goal: Point2<f64>| {
        assert!(PhaseSearch::new(workplace, &config, &[], start, goal).unwrap().solve().is_none());
        explain(workplace, &config, start, goal)
    };
    let free = workplace(&tool, &DISC, &[]);
    assert!(matches!(reason(&free, goal, start), NoPhases::Directions { .. }));
    let wall = [block(0.01, 0.18, [0.0, 0.09])];
    let walled = reason(&workplace(&tool, &DISC, &wall), start, goal);
    assert!(matches!(walled, NoPhases::Closed { constraint: "the obstacles", .. }), "{walled}");
    let near = RectangularReach { min_m: [-0.12, 0.0], max_m: [0.05, 0.16] };
    let short = reason(&Workplace { reach: &near, ..workplace(&tool, &DISC, &[]) }, start, goal);
    assert!(matches!(short, NoPhases::Closed { constraint: "the reach of the arm", .. }), "{short}");
    let outside = reason(&free, start, Point2::new(-0.085, 0.11));
    assert!(matches!(outside, NoPhases::OutsideMap { place: "goal", .. }), "{outside}");
    let there = [block(0.02, 0.02, [-0.055, 0.11])];
    let occupied = reason(&workplace(&tool, &DISC, &there), start, goal);
    assert!(matches!(occupied, NoPhases::Place { place: "goal", .. }), "{occupied}");
    // the lane of 35 mm lets the disc of 24 mm through, but not with 15 mm between it and the block
    let gate = [block(0.01, 0.145, [0.0, 0.1075])];
    let narrow = reason(&workplace(&tool, &DISC, &gate), start, goal);
    assert!(matches!(narrow, NoPhases::Closed { constraint: "the safe margin of the object", .. }), "{narrow}");
}
