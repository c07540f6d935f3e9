//! How a fill leaves the lip and flies to the mouth: depth and speed of the layer that flows over the lip, and its throw.
//!
//! What tilting sets free flows: the fill leaves between the onset and the tilt at which the wall slopes as steeply as the
//! surface stands, a span of atan(R/(H − h)) by the wedge of [`super::Container::onset_rad`], so that the volume flow is
//! Q = volume × rate of tilt / span. It leaves in one of two ways, and the faster one is reckoned with:
//!
//! - A deep fill shears over itself. Its rate depends on little but the size of the grains, γ̇ = 0.5 √(g/d) (GDR MiDi 2004, On dense
//!   granular flows, Eur. Phys. J. E 14, 341–365: heaps and rotating drums), and speed grows linearly with the height above the
//!   bed that rests. Over the lip of a round cup of inner radius R a layer of depth δ is δ − y²/(2R) deep at y beside its
//!   middle; integrated, Q = (8/15) γ̇ √(2R) δ^(5/2), and weighted with the flow, height above the lip (5/7) δ and speed
//!   (4/7) γ̇ δ. Over a spout of width w: Q = ½ γ̇ w δ², (2/3) δ and (2/3) γ̇ δ.
//! - What is left lies on the wall and rolls down it, β = θ − π/2 below the level: as balls from rest with rolling resistance,
//!   v² = 2 · (5/7) g (sin β − μ_r cos β) · H/2, because on average it begins half the wall away. All of it is as fast, so
//!   that Q = (4/3) √(2R) δ^(3/2) v and the height (3/5) δ; over a spout Q = w δ v and δ/2.
//!
//! β is taken once half of the fill has left. From the lip on, grains fall freely, beginning along the wall.

use std::f64::consts::FRAC_PI_2;

use super::container::Container;
use super::task::Fill;

/// Standard gravity as used throughout, m/s².
const GRAVITY: f64 = 9.81;
/// Shear rate of a layer that flows down its own surface, in √(g/d).
const SHEAR_RATE: f64 = 0.5;

/// The layer that flows over a lip.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Stream {
    /// Its depth in the middle, m.
    pub(super) depth_m: f64,
    /// Height of what flows off the lip's lowest point, weighted with the flow, m.
    pub(super) height_m: f64,
    /// Speed of what flows, weighted with the flow, along the wall, m/s.
    pub(super) speed_m_per_s: f64,
    /// Tilt at which half of the fill has left, rad.
    pub(super) middle_rad: f64,
}

impl Stream {
    /// The stream out of `cup` while it tilts at `tilt_rate_rad_per_s`.
    pub(super) fn new(cup: &Container, fill: &Fill, tilt_rate_rad_per_s: f64) -> Self {
        let radius_m = cup.radius_m - cup.wall_m;
        let bed_m = (fill.height_m + cup.wall_m).clamp(0.0, cup.height_m);
        let span_rad = radius_m.atan2(cup.height_m - bed_m);
        let flow = std::f64::consts::PI * radius_m * radius_m * fill.height_m * tilt_rate_rad_per_s / span_rad;
        let middle_rad = cup.onset_rad(fill.height_m, fill.stability_rad) + 0.5 * span_rad;
        let rolled = rolling_speed_m_per_s(middle_rad - FRAC_PI_2, fill.rolling_friction, 0.5 * cup.height_m);
        let shear = SHEAR_RATE * (GRAVITY / fill.grain_m).sqrt();
        let spout_m = (cup.spout_m > 0.0).then_some(cup.spout_width_m);
        let chord = (2.0 * radius_m).sqrt();
        let (depth_m, height, speed) = match spout_m {
            Some(width_m) => ((2.0 * flow / (shear * width_m)).sqrt(), 2.0 / 3.0, 2.0 / 3.0),
            None => ((15.0 / 8.0 * flow / (shear * chord)).powf(0.4), 5.0 / 7.0, 4.0 / 7.0),
        };
        let sheared = Self { depth_m, height_m: height * depth_m, speed_m_per_s: speed * shear * depth_m, middle_rad };
        if sheared.speed_m_per_s > rolled {
            return sheared;
        }
        let (depth_m, height) = match spout_m {
            Some(width_m) => (flow / (width_m * rolled), 0.5),
            None => ((0.75 * flow / (chord * rolled)).powf(2.0 / 3.0), 0.6),
        };
        // one grain lies at least there
        let depth_m = depth_m.max(fill.grain_m);
        Self { depth_m, height_m: height * depth_m, speed_m_per_s: rolled, middle_rad }
    }

    /// Level distance from the lip to where the middle of the stream passes `drop_m` below the lip, m; `tilt_rad` is the
    /// cup's, from upright. The wall points along (sin θ, cos θ), and the stream's middle lies its height off the wall.
    pub(super) fn throw_m(&self, tilt_rad: f64, drop_m: f64) -> f64 {
        let (sin, cos) = tilt_rad.sin_cos();
        let (level, up) = (self.speed_m_per_s * sin, self.speed_m_per_s * cos);
        let fall_m = (drop_m + self.height_m * sin).max(0.0);
        let time_s = (up + (up * up + 2.0 * GRAVITY * fall_m).sqrt()) / GRAVITY;
        level * time_s - self.height_m * cos
    }
}

/// Speed of balls that roll from rest down a slope (rad) for `way_m`, m/s: 5/7 of gravity's share goes into it, less what
/// rolling resistance takes; 0 where they stand.
fn rolling_speed_m_per_s(slope_rad: f64, rolling_friction: f64, way_m: f64) -> f64 {
    let (sin, cos) = slope_rad.sin_cos();
    (2.0 * 5.0 / 7.0 * GRAVITY * (sin - rolling_friction * cos) * way_m).max(0.0).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn stream(speed_m_per_s: f64, height_m: f64) -> Stream {
        Stream { depth_m: 0.01, height_m, speed_m_per_s, middle_rad: FRAC_PI_2 }
    }

    #[test]
    fn a_level_wall_throws_by_speed_times_the_root_of_twice_the_fall_over_gravity() {
        // 44.145 mm take 0.094868 s; from 5 mm above the wall it is the sum that is fallen
        let throw_m = stream(0.2, 0.005).throw_m(FRAC_PI_2, 0.044_145 - 0.005);
        assert!((throw_m - 0.2 * (2.0 * 0.044_145_f64 / 9.81).sqrt()).abs() < 1e-12, "{throw_m}");
    }

    #[test]
    fn a_steep_wall_throws_as_a_stepped_flight_does() {
        let (stream, tilt, drop_m) = (stream(0.3, 0.006), 1.9_f64, 0.03);
        let (mut x, mut z) = (-stream.height_m * tilt.cos(), drop_m + stream.height_m * tilt.sin());
        let (vx, mut vz) = (0.3 * tilt.sin(), 0.3 * tilt.cos());
        let step_s = 1e-6;
        while z > 0.0 {
            x += vx * step_s;
            z += vz * step_s - 0.5 * 9.81 * step_s * step_s;
            vz -= 9.81 * step_s;
        }
        assert!((stream.throw_m(tilt, drop_m) - x).abs() < 1e-6, "{x}");
    }

    /// Flow, height and speed weighted with it, by quadrature over the opening: at height z of a layer D deep, `speed(z)`.
    fn over_the_opening(stream: &Stream, radius_m: f64, speed: impl Fn(f64) -> f64) -> (f64, f64, f64) {
        let half_m = (2.0 * radius_m * stream.depth_m).sqrt();
        let (mut flow, mut moment, mut momentum) = (0.0, 0.0, 0.0);
        let cells = 1000;
        for cell in 0..cells {
            let y = half_m * (2.0 * (f64::from(cell) + 0.5) / f64::from(cells) - 1.0);
            let bottom = y * y / (2.0 * radius_m);
            let depth = stream.depth_m - bottom;
            for layer in 0..cells {
                let z = depth * (f64::from(layer) + 0.5) / f64::from(cells);
                let part = speed(z) * 2.0 * half_m * depth / f64::from(cells * cells);
                flow += part;
                moment += part * (bottom + z);
                momentum += part * speed(z);
            }
        }
        (flow, moment / flow, momentum / flow)
    }

    /// The quadrature's own error.
    const CELLS: f64 = 1e-5;

    #[test]
    fn the_layer_carries_the_flow_that_tilting_sets_free() {
        let (cup, rate, radius_m) = (Container::default(), 0.5, 0.035);
        // a full cup shears over itself, a third of it rolls along the wall
        for (height_m, rolls) in [(0.06, false), (0.028, true)] {
            let fill = Fill { height_m, ..Fill::default() };
            let stream = Stream::new(&cup, &fill, rate);
            let shear = 0.5 * (9.81_f64 / fill.grain_m).sqrt();
            let speed = |z: f64| if rolls { stream.speed_m_per_s } else { shear * z };
            let (flow, middle_m, speed_m_per_s) = over_the_opening(&stream, radius_m, speed);
            let volume = std::f64::consts::PI * radius_m * radius_m * fill.height_m;
            let span = (radius_m / (cup.height_m - cup.wall_m - fill.height_m)).atan();
            assert!((flow / (volume * rate / span) - 1.0).abs() < CELLS, "{rolls}: {flow}");
            assert!((middle_m / stream.height_m - 1.0).abs() < CELLS, "{rolls}: {middle_m}");
            assert!((speed_m_per_s / stream.speed_m_per_s - 1.0).abs() < CELLS, "{rolls}: {speed_m_per_s}");
            assert!((stream.middle_rad - cup.onset_rad(height_m, fill.stability_rad) - span / 2.0).abs() < 1e-12);
        }
    }

    #[test]
    fn balls_roll_as_fast_as_their_energy_says() {
        // 10 degrees, 100 mm, no resistance: m g h = 7/10 m v²
        let drop_m = 0.1 * 10_f64.to_radians().sin();
        let free = rolling_speed_m_per_s(10_f64.to_radians(), 0.0, 0.1);
        assert!((free - (10.0 / 7.0 * 9.81 * drop_m).sqrt()).abs() < 1e-12, "{free}");
        // and on a slope less than their resistance not at all
        assert_eq!(rolling_speed_m_per_s(0.09, 0.1, 0.1), 0.0);
    }

    #[test]
    fn a_narrow_spout_makes_the_stream_deeper_and_slow_tilting_makes_a_sheared_one_slower() {
        let fill = Fill { height_m: 0.06, ..Fill::default() };
        let cup = Container::default();
        let beaker = Container { spout_m: 0.014, spout_width_m: 0.018, ..cup };
        let [plain, spout, slow] =
            [(&cup, 0.3), (&beaker, 0.3), (&cup, 0.25)].map(|(c, rate)| Stream::new(c, &fill, rate));
        assert!(spout.depth_m > plain.depth_m && spout.speed_m_per_s > plain.speed_m_per_s, "{spout:?} {plain:?}");
        // depth and speed go with the flow to the power of 2/5
        assert!((slow.speed_m_per_s / plain.speed_m_per_s - (0.25_f64 / 0.3).powf(0.4)).abs() < 1e-9, "{slow:?}");
    }
}
