//! Demonstrations built in code, without physics: a stick pushes a disc to the left, goes round it, pushes it forward.

use nalgebra::{DMatrix, Point2, Vector2};
use skills::Trajectory;
use skills::demonstration::Demonstration;
use skills::outline::{Outline, PlacedOutline};
use skills::time_law::minimum_jerk;
use skills::tool::{ContactSurface, SurfaceShape, Tool};

/// Index of the surface that pushes to the left.
pub const SIDE: usize = 0;
/// Index of the surface that pushes forward.
pub const HEAD: usize = 1;
/// Radius of the disc that is pushed, m.
pub const RADIUS_M: f64 = 0.012;
/// Speed of a shown push, m/s.
const PUSH_M_PER_S: f64 = 0.02;
/// Speed of the hand between pushes, m/s.
const FREE_M_PER_S: f64 = 0.08;
/// Time in which a hand gets going or stops, s.
const RAMP_S: f64 = 0.1;
/// How far the hand backs off before it goes anywhere else, m.
const BACK_OFF_M: f64 = 0.010;
/// Rates of the two recorders, Hz, and how much later the camera begins, s.
const TOOL_HZ: f64 = 200.0;
const CAMERA_HZ: f64 = 30.0;
const CAMERA_DELAY_S: f64 = 0.013;

/// The stick of assets/tools/stick.toml: 30 mm long, 12 mm wide, with a round head.
pub fn stick() -> Tool {
    let shaft = Outline::Box { width_m: 0.012, height_m: 0.024 };
    let pieces = vec![
        PlacedOutline { shape: shaft, position_m: [0.0, 0.012], angle_rad: 0.0 },
        PlacedOutline { shape: Outline::Disc { radius_m: 0.006 }, position_m: [0.0, 0.024], angle_rad: 0.0 },
    ];
    let side = SurfaceShape::Face { start_m: [-0.006, 0.024], end_m: [-0.006, 0.014] };
    let direction_rad = std::f64::consts::FRAC_PI_2;
    let head = SurfaceShape::Arc { center_m: [0.0, 0.024], radius_m: 0.006, direction_rad, half_angle_rad: 0.08 };
    let surfaces = vec![ContactSurface::new("side", side), ContactSurface::new("head", head)];
    Tool { name: "stick".into(), description: String::new(), mass_kg: 0.004, friction: 0.3, pieces, surfaces }
}

/// The disc that is pushed.
pub fn disc() -> Outline {
    Outline::Disc { radius_m: RADIUS_M }
}

/// What a demonstration shows, and how badly it was recorded.
#[derive(Clone)]
pub struct Script {
    pub start: Point2<f64>,
    pub home: Point2<f64>,
    pub park: Point2<f64>,
    /// Surface and length of each push, m.
    pub pushes: Vec<(usize, f64)>,
    /// Wait before and after each push, s.
    pub pause_s: f64,
    /// Push (index) that is interrupted halfway by a new hold.
    pub renewed: Option<usize>,
    /// Length by which the object is moved by accident on the way to the first push, m.
    pub nudge_m: f64,
    /// Largest error of a camera frame, m, along each axis.
    pub noise_m: f64,
    /// Angle of the tool throughout, rad.
    pub angle_rad: f64,
}

impl Default for Script {
    fn default() -> Self {
        Self {
            start: Point2::new(0.060, 0.055),
            home: Point2::new(0.100, 0.010),
            park: Point2::new(-0.060, 0.020),
            pushes: vec![(SIDE, 0.120), (HEAD, 0.075)],
            pause_s: 0.3,
            renewed: None,
            nudge_m: 0.0,
            noise_m: 0.0,
            angle_rad: 0.0,
        }
    }
}

/// What is true of a demonstration: surface, begin and end (s) and displacement of each push.
pub struct Truth {
    pub pushes: Vec<(usize, f64, f64, Vector2<f64>)>,
}

/// Motion of tool and object, written down as keys that are passed at constant speed.
struct Film {
    time_s: f64,
    tool: Vec<(f64, Point2<f64>)>,
    object: Vec<(f64, Point2<f64>)>,
}

impl Film {
    fn tool_at(&self) -> Point2<f64> {
        self.tool.last().unwrap().1
    }

    fn object_at(&self) -> Point2<f64> {
        self.object.last().unwrap().1
    }

    fn wait(&mut self, duration_s: f64) {
        let (tool, object) = (self.tool_at(), self.object_at());
        self.key(duration_s, tool, object);
    }

    fn key(&mut self, duration_s: f64, tool: Point2<f64>, object: Point2<f64>) {
        self.time_s += duration_s;
        self.tool.push((self.time_s, tool));
        self.object.push((self.time_s, object));
    }

    /// A reach of the hand through free space.
    fn reach(&mut self, to: Point2<f64>) {
        let (from, object) = (self.tool_at(), self.object_at());
        let duration_s = ((to - from).norm() / FREE_M_PER_S).max(0.1);
        for step in 1..=50 {
            self.key(duration_s / 50.0, from + (to - from) * minimum_jerk(f64::from(step) / 50.0), object);
        }
    }

    /// A push of tool and object together: constant speed between two short ramps.
    fn push(&mut self, way: Vector2<f64>) {
        let (tool, object) = (self.tool_at(), self.object_at());
        let cruise_s = way.norm() / PUSH_M_PER_S - RAMP_S;
        let total_s = cruise_s + 2.0 * RAMP_S;
        for step in 1..=100 {
            let time = total_s * f64::from(step) / 100.0;
            let ramp = |time: f64| 0.5 * time.clamp(0.0, RAMP_S).powi(2) / RAMP_S + (time - RAMP_S).max(0.0);
            let left = (time - RAMP_S - cruise_s).max(0.0);
            let done = (ramp(time) - 0.5 * left * left / RAMP_S) / (cruise_s + RAMP_S);
            self.key(total_s / 100.0, tool + way * done, object + way * done);
        }
    }
}

impl Script {
    /// Plays the script and records it.
    pub fn demonstration(&self, name: &str) -> (Demonstration, Truth) {
        let tool = stick();
        let mut film = Film { time_s: 0.0, tool: vec![(0.0, self.home)], object: vec![(0.0, self.start)] };
        let mut truth = Truth { pushes: Vec::new() };
        film.wait(self.pause_s);
        for (index, &(surface, length)) in self.pushes.iter().enumerate() {
            let contact = tool.surfaces[surface].middle();
            let turn = nalgebra::Rotation2::new(self.angle_rad);
            let normal = turn * contact.normal.into_inner();
            let hold = |center: Point2<f64>, gap: f64| {
                let pose = tool.pose_touching(&contact, &center, RADIUS_M, gap, self.angle_rad);
                Point2::from(pose.translation.vector)
            };
            // round the object by the right, then below it
            if index > 0 && surface == HEAD {
                let at = film.object_at();
                for via in [Vector2::new(0.028, -0.022), Vector2::new(0.028, -0.050)] {
                    film.reach(at + turn * via);
                }
            }
            film.reach(hold(film.object_at(), BACK_OFF_M));
            if index == 0 && self.nudge_m > 0.0 {
                film.reach(hold(film.object_at(), 0.0));
                film.push(normal * self.nudge_m);
                film.wait(0.5);
                film.reach(hold(film.object_at(), BACK_OFF_M));
            }
            film.reach(hold(film.object_at(), 0.0));
            film.wait(self.pause_s);
            let (begin_s, from) = (film.time_s, film.object_at());
            if self.renewed == Some(index) {
                film.push(normal * (length / 2.0));
                film.reach(hold(film.object_at(), BACK_OFF_M));
                film.wait(0.4);
                film.reach(hold(film.object_at(), 0.0));
                film.push(normal * (length / 2.0));
            } else {
                film.push(normal * length);
            }
            truth.pushes.push((surface, begin_s, film.time_s, film.object_at() - from));
            film.wait(self.pause_s);
            film.reach(hold(film.object_at(), BACK_OFF_M));
        }
        film.reach(self.park);
        film.wait(self.pause_s);
        (self.record(name, &film), truth)
    }

    fn record(&self, name: &str, film: &Film) -> Demonstration {
        let sample = |keys: &[(f64, Point2<f64>)], rate_hz: f64, delay_s: f64, noise_m: f64, angle: f64| {
            let samples = DMatrix::from_fn(keys.len(), 2, |row, column| keys[row].1[column]);
            let truth = Trajectory::new(keys.iter().map(|key| key.0).collect(), samples).unwrap();
            let rows = ((film.time_s - delay_s) * rate_hz) as usize;
            let times: Vec<f64> = (0..rows).map(|row| delay_s + row as f64 / rate_hz).collect();
            let samples = DMatrix::from_fn(rows, 3, |row, column| match column {
                2 => angle,
                _ => truth.at(times[row])[column] + noise_m * scatter(2 * row + column),
            });
            Trajectory::new(times, samples).unwrap()
        };
        let tool = sample(&film.tool, TOOL_HZ, 0.0, 0.0, self.angle_rad);
        let object = sample(&film.object, CAMERA_HZ, CAMERA_DELAY_S, self.noise_m, 0.0);
        Demonstration::new(name, tool, object).unwrap()
    }
}

/// Numbers in [-1, 1] without pattern, the same in every run: equidistributed by the golden ratio, then shuffled.
fn scatter(index: usize) -> f64 {
    let mixed = (index as u64).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    let mixed = (mixed ^ (mixed >> 31)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    2.0 * ((mixed >> 11) as f64 / (1_u64 << 53) as f64) - 1.0
}
