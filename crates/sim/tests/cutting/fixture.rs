//! The Panda with a knife in its hand, a board before it, and scripts of straight strokes.

use nalgebra::{DVector, Isometry3, Translation3, UnitQuaternion, Vector3, Vector6};
use robot::Manipulator;
use sim::controllers::{Impedance, ImpedanceConfig};
use sim::cutting::food::{Food, FoodFile};
use sim::cutting::knife::{Knife, KnifeFile};
use sim::cutting::mechanics::{CuttingConfig, Thresholds};
use sim::cutting::scene::{CuttingBoard, CuttingProcess, CuttingRecord, CuttingSetup, held_knife, knife_from_tool};
use sim::spatial::{
    ArmConfig, EngineConfig, Episode, Event, HeldTool, Observer, SceneDescription, SpatialReference, SpatialSetup,
    SpatialWorld, arm_with_tool, check_reach, simulate, standard_gravity,
};

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};

pub const READY: [f64; 7] = [0.0, -FRAC_PI_4, 0.0, -3.0 * FRAC_PI_4, 0.0, FRAC_PI_2, FRAC_PI_4];
/// Rotor inertias of the successor of the Panda, as MuJoCo Menagerie gives them, kg m².
pub const ROTORS: [f64; 7] = [0.195, 0.195, 0.195, 0.195, 0.074, 0.074, 0.074];
pub const PERIOD_S: f64 = 0.001;
/// Middle of the board's upper side, m.
pub const BOARD: [f64; 3] = [0.5, 0.0, 0.15];

pub const CYLINDER: &str = include_str!("../../../../assets/foods/cylinder.toml");
pub const BLOCK: &str = include_str!("../../../../assets/foods/block.toml");
pub const BANANA: &str = include_str!("../../../../assets/foods/banana.toml");
pub const BISCUIT: &str = include_str!("../../../../assets/foods/biscuit.toml");
pub const GRAPE: &str = include_str!("../../../../assets/foods/grape.toml");
pub const MEATBALL: &str = include_str!("../../../../assets/foods/meatball.toml");
pub const STRAWBERRY: &str = include_str!("../../../../assets/foods/strawberry.toml");

pub fn food(text: &str) -> Food {
    toml::from_str::<FoodFile>(text).expect("a food file").food().expect("a food")
}

/// A knife with a straight edge of 180 mm.
pub fn cleaver() -> Knife {
    let text = include_str!("../../../../assets/knives/cleaver.toml");
    toml::from_str::<KnifeFile>(text).expect("a knife file").knife().expect("a knife")
}

/// Gains that suit free motions of the Panda. Under 10 N at the knife they give way by 4 mm downwards and 4 mm forwards, and
/// by 10 mrad about the blade's normal: the heel strikes the board before the tip is through.
pub fn soft() -> ImpedanceConfig {
    let damping_nm_s_per_rad = vec![60.0, 60.0, 60.0, 60.0, 15.0, 15.0, 8.0];
    ImpedanceConfig { error_gain_per_s: 20.0, damping_nm_s_per_rad }
}

/// Seven times as stiff: half a millimeter under 10 N.
pub fn stiff() -> ImpedanceConfig {
    let damping_nm_s_per_rad = vec![150.0, 150.0, 150.0, 150.0, 40.0, 40.0, 20.0];
    ImpedanceConfig { error_gain_per_s: 60.0, damping_nm_s_per_rad }
}

/// A food in the middle of the board, turned by `turn` about the vertical: by a quarter, its axis is the blade's normal.
pub fn setup(food: Food, turn: f64) -> CuttingSetup {
    let (low, _) = food.solid.bounds();
    let [x, y, z] = BOARD;
    let upright = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), turn);
    CuttingSetup {
        food,
        world_from_food: Isometry3::from_parts(Translation3::new(x, y, z - low.z), upright),
        knife: cleaver(),
        board: CuttingBoard {
            world_from_board: Isometry3::translation(x, y, z),
            half_extents_m: [0.15, 0.2, 0.01],
            friction: 0.4,
        },
        config: CuttingConfig::default(),
        // the knife is driven a millimeter below the board, so that it presses on it in the end
        thresholds: Thresholds { board_force_n: 60.0, ..Thresholds::default() },
        planned: Vec::new(),
    }
}

/// Edge along the world's x, cutting down, blade's normal along y; `height` above the board.
pub fn upright(x: f64, y: f64, height: f64) -> Isometry3<f64> {
    let down = UnitQuaternion::from_axis_angle(&Vector3::x_axis(), -FRAC_PI_2);
    Isometry3::from_parts(Translation3::new(BOARD[0] + x, BOARD[1] + y, BOARD[2] + height), down)
}

/// The knife in the Panda's hand: the blade points forward while the hand points down.
pub fn held(knife: &Knife) -> HeldTool {
    let hand_from_knife = Isometry3::rotation(Vector3::x() * FRAC_PI_2) * knife.knife_from_grip.inverse();
    held_knife(knife, hand_from_knife * knife_from_tool(knife))
}

pub fn panda(tool: &HeldTool, gravity: &Vector3<f64>) -> Manipulator {
    let arm = Manipulator::from_urdf_str(include_str!("../../../../assets/robots/panda.urdf")).expect("a valid file");
    arm_with_tool(&arm, "panda_hand_tcp", tool, &Isometry3::identity(), gravity, &ROTORS).expect("a valid arm")
}

/// Poses one after the other, each reached by a straight minimum-jerk motion in so many seconds.
#[derive(Clone)]
pub struct Script {
    pub poses: Vec<(f64, Isometry3<f64>)>,
    /// Added to each pose: tool frame, m.
    pub wobble: fn(f64) -> Vector3<f64>,
    /// Wrench that is fed forward.
    pub expected: Vector6<f64>,
}

impl Script {
    pub fn from(start: Isometry3<f64>) -> Self {
        Self { poses: vec![(0.0, start)], wobble: |_| Vector3::zeros(), expected: Vector6::zeros() }
    }

    pub fn to(mut self, duration_s: f64, pose: Isometry3<f64>) -> Self {
        let end = self.duration_s();
        self.poses.push((end + duration_s, pose));
        self
    }

    pub fn duration_s(&self) -> f64 {
        self.poses.last().map_or(0.0, |last| last.0)
    }

    fn pose(&self, time_s: f64) -> Isometry3<f64> {
        let next = self.poses.iter().position(|(end, _)| time_s < *end).unwrap_or(self.poses.len() - 1).max(1);
        let ((from_s, from), (to_s, to)) = (self.poses[next - 1], self.poses[next]);
        let u = ((time_s - from_s) / (to_s - from_s)).clamp(0.0, 1.0);
        let share = u * u * u * (10.0 - 15.0 * u + 6.0 * u * u);
        let aside = (self.wobble)(time_s);
        Isometry3::from_parts(
            Translation3::from(from.translation.vector.lerp(&to.translation.vector, share)),
            from.rotation.slerp(&to.rotation, share),
        ) * Translation3::from(aside)
    }

    pub fn reference(&self, time_s: f64) -> SpatialReference {
        let h = 1e-4;
        let at = |time: f64| self.pose(time);
        let (before, now, after) = (at(time_s - h), at(time_s), at(time_s + h));
        let linear =
            |one: &Isometry3<f64>, other: &Isometry3<f64>| (other.translation.vector - one.translation.vector) / h;
        let angular =
            |one: &Isometry3<f64>, other: &Isometry3<f64>| (other.rotation * one.rotation.inverse()).scaled_axis() / h;
        let join = |a: Vector3<f64>, b: Vector3<f64>| Vector6::new(a.x, a.y, a.z, b.x, b.y, b.z);
        SpatialReference {
            velocity: 0.5 * join(linear(&before, &after), angular(&before, &after)),
            acceleration: join(
                (linear(&now, &after) - linear(&before, &now)) / h,
                (angular(&now, &after) - angular(&before, &now)) / h,
            ),
            expected_wrench: self.expected,
            phase: 0,
            finished: time_s >= self.duration_s(),
            world_from_tool: now,
        }
    }
}

/// A finished run.
pub struct Outcome {
    pub episode: Episode,
    pub record: CuttingRecord,
    pub events: Vec<String>,
    pub names: Vec<String>,
}

#[derive(Default)]
struct Listener {
    events: Vec<String>,
    names: Vec<String>,
}

impl Observer for Listener {
    fn event(&mut self, event: &Event) {
        self.events.push(format!("{:.3} {}", event.time_s, event.text));
    }

    fn bodies(&mut self, _: f64, bodies: &[sim::spatial::BodyDrawing]) {
        self.names = bodies.iter().map(|body| body.name.clone()).collect();
    }
}

/// What differs between runs.
#[derive(Clone)]
pub struct Options {
    pub gains: ImpedanceConfig,
    pub engine: EngineConfig,
    pub gravity: Vector3<f64>,
    pub arm: ArmConfig,
}

impl Default for Options {
    fn default() -> Self {
        Self { gains: stiff(), engine: EngineConfig::default(), gravity: standard_gravity(), arm: ArmConfig::default() }
    }
}

pub fn run_with(setup: &CuttingSetup, script: &Script, options: &Options) -> Outcome {
    let tool = held(&setup.knife);
    let model = panda(&tool, &options.gravity);
    let mut world = SpatialWorld::new(&options.engine, &options.gravity).expect("a valid scene");
    let mut process = CuttingProcess::insert(&mut world, setup).expect("a valid setup");
    let mut source = |time_s: f64, _: &Isometry3<f64>| script.reference(time_s);
    let near = DVector::from_column_slice(&READY);
    let q = check_reach(&model, &near, script.duration_s(), &mut source).expect("within reach");
    let spatial = SpatialSetup {
        plant: &model,
        model: &model,
        tool: &tool,
        arm: &options.arm,
        scene: &SceneDescription::default(),
        engine: &options.engine,
        settle_s: 0.3,
        longest_s: 60.0,
    };
    let mut controller = Impedance::new(&options.gains, 7).expect("valid gains");
    let mut listener = Listener::default();
    let episode =
        simulate(&spatial, world, &q, &mut source, &mut controller, &mut process, &mut listener).expect("a finite run");
    Outcome { episode, record: process.record(), events: listener.events, names: listener.names }
}

pub fn run(setup: &CuttingSetup, script: &Script) -> Outcome {
    run_with(setup, script, &Options::default())
}

/// Height above the board from which the knife goes on slowly, m, and for how long, s.
const GENTLY: (f64, f64) = (0.004, 0.8);

/// Down on the food at `y` in `seconds`, gently to `past` below the board, and up again.
pub fn press(y: f64, top: f64, past: f64, seconds: f64) -> Script {
    stroke(Script::from(upright(0.0, y, top)), upright(0.0, y, 0.0), top, past, seconds)
}

/// The same after other strokes, in the plane of `at` on the board.
pub fn stroke(script: Script, at: Isometry3<f64>, top: f64, past: f64, seconds: f64) -> Script {
    let place = |height: f64| Isometry3::translation(0.0, 0.0, height) * at;
    let above = GENTLY.0.max(-past);
    let down = script.to(seconds, place(above)).to(GENTLY.1, place(-past)).to(0.3, place(-past));
    down.to(0.8, place(top))
}
