//! What becomes of the grains: where each one is, how fast they flow, and what goes wrong on the way.

mod config;
mod flow;
mod landing;

use nalgebra::{Isometry3, Point3};
use rapier3d::prelude::PhysicsWorld;

use super::container::AttachedContainer;
use super::grains::Grains;

pub use config::MonitorConfig;
use flow::FlowMeter;
pub use landing::LandingSpread;

/// Where a grain is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// In the container that is poured from.
    Source,
    /// In the container that is poured into.
    Target,
    /// Outside both, moving above the table.
    Flying,
    /// Outside both, on the table or at rest on anything else.
    Spilt,
}

/// How many grains are where. The four numbers add up to the number of grains.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// In the source.
    pub source: usize,
    /// In the target.
    pub target: usize,
    /// On the way.
    pub flying: usize,
    /// Spilt.
    pub spilt: usize,
}

impl Counts {
    /// All grains.
    #[must_use]
    pub fn total(&self) -> usize {
        self.source + self.target + self.flying + self.spilt
    }

    fn of(&mut self, place: Place) -> &mut usize {
        match place {
            Place::Source => &mut self.source,
            Place::Target => &mut self.target,
            Place::Flying => &mut self.flying,
            Place::Spilt => &mut self.spilt,
        }
    }
}

/// What is remembered of one grain.
#[derive(Clone, Copy, Debug)]
struct Trace {
    place: Place,
    /// For how long it has been at rest outside, s.
    rest_s: f64,
    /// Whether it was above the target's mouth plane.
    above_mouth: bool,
    landed: bool,
    /// Since when it has not touched the rim, s; a new touch counts after a pause.
    off_rim_s: f64,
    mass_kg: f64,
}

/// Watches a pour: one pass over the grains and one over the contacts per step, no allocation.
pub struct PourMonitor {
    config: MonitorConfig,
    source: AttachedContainer,
    target: Option<AttachedContainer>,
    traces: Vec<Trace>,
    counts: Counts,
    flow: FlowMeter,
    landing: LandingSpread,
    bounce_outs: usize,
    rim_hits: usize,
    exits: Exits,
}

/// Grains that left the source, and the sum of their speeds, m/s.
#[derive(Clone, Copy, Debug, Default)]
struct Exits {
    count: f64,
    speeds: f64,
}

impl PourMonitor {
    /// Starts to watch grains that are poured from `source`, into `target` if there is one.
    #[must_use]
    pub fn new(
        config: MonitorConfig,
        physics: &PhysicsWorld,
        grains: &Grains,
        source: AttachedContainer,
        target: Option<AttachedContainer>,
    ) -> Self {
        let blank = Trace {
            place: Place::Flying,
            rest_s: 0.0,
            above_mouth: true,
            landed: false,
            off_rim_s: f64::INFINITY,
            mass_kg: 0.0,
        };
        let traces = grains.batch().masses_kg().map(|mass_kg| Trace { mass_kg, ..blank }).collect();
        let flow = FlowMeter::new(&config, grains.batch().masses_kg().sum());
        let landing = LandingSpread::with_room_for(grains.len());
        let (counts, bounce_outs, rim_hits) = (Counts::default(), 0, 0);
        let exits = Exits::default();
        let mut monitor = Self { config, source, target, traces, counts, flow, landing, bounce_outs, rim_hits, exits };
        monitor.look(physics, grains, 0.0);
        // the first look only finds out where everything is
        (monitor.bounce_outs, monitor.rim_hits) = (0, 0);
        monitor.exits = Exits::default();
        monitor.landing.clear();
        monitor.traces.iter_mut().for_each(|trace| trace.landed = false);
        monitor.flow.start();
        monitor
    }

    /// What must be done after each step of the engine.
    pub fn after_step(&mut self, physics: &PhysicsWorld, grains: &Grains) {
        let dt = physics.integration_parameters.dt;
        self.look(physics, grains, dt);
        self.count_rim_hits(physics, grains, dt);
        let tilted = self.source.tilt_rad(physics) > self.config.tilted_rad;
        self.flow.advance(dt, tilted, self.counts.source, self.traces.len());
    }

    fn look(&mut self, physics: &PhysicsWorld, grains: &Grains, dt: f64) {
        let source_from_world = self.source.world_from_container(physics).inverse();
        let target_from_world = self.target.as_ref().map(|target| target.world_from_container(physics).inverse());
        self.counts = Counts::default();
        for (trace, body) in self.traces.iter_mut().zip(grains.bodies(physics)) {
            let at = body.translation();
            let at = Point3::new(at.x, at.y, at.z);
            let speed = body.linvel().length();
            trace.rest_s = if speed < self.config.rest_m_per_s { trace.rest_s + dt } else { 0.0 };
            let in_target = target_from_world.map(|pose| pose * at);
            let held = |container: &AttachedContainer, at: &Point3<f64>| container.container().holds(at);
            let place = if held(&self.source, &(source_from_world * at)) {
                Place::Source
            } else if self.target.as_ref().zip(in_target).is_some_and(|(target, at)| held(target, &at)) {
                Place::Target
            } else if at.z < self.config.spilt_below_m || trace.rest_s >= self.config.rest_s {
                Place::Spilt
            } else {
                Place::Flying
            };
            if let (Some(target), Some(at)) = (&self.target, in_target) {
                let above = at.z > target.container().rim.center_in_container.z;
                if trace.above_mouth && !above && !trace.landed && place != Place::Source {
                    trace.landed = true;
                    self.landing.note(at.x, at.y);
                }
                trace.above_mouth = above;
            }
            self.bounce_outs += usize::from(trace.place == Place::Target && place != Place::Target);
            match (trace.place == Place::Source, place == Place::Source) {
                (true, false) => {
                    self.flow.note(trace.mass_kg);
                    self.exits.count += 1.0;
                    self.exits.speeds += speed;
                }
                (false, true) => self.flow.note(-trace.mass_kg),
                _ => {}
            }
            trace.place = place;
            *self.counts.of(place) += 1;
        }
    }

    /// A grain that touches the target at the height of its rim, after a pause without such a touch.
    fn count_rim_hits(&mut self, physics: &PhysicsWorld, grains: &Grains, dt: f64) {
        let Some(target) = &self.target else { return };
        let target_from_world = target.world_from_container(physics).inverse();
        let rim_m = target.container().rim.center_in_container.z;
        self.traces.iter_mut().for_each(|trace| trace.off_rim_s += dt);
        for pair in physics.narrow_phase.contact_pairs() {
            let other = match (pair.collider1 == target.collider(), pair.collider2 == target.collider()) {
                (true, false) => pair.collider2,
                (false, true) => pair.collider1,
                _ => continue,
            };
            let Some(index) = grains.index_of(other) else { continue };
            let Some(body) = grains.handles().get(index).and_then(|handle| physics.bodies.get(*handle)) else {
                continue;
            };
            let reach = grains.batch().diameters_m().get(index).map_or(0.0, |diameter| 0.5 * diameter);
            let height = height_in(&target_from_world, body) - rim_m;
            let pushes = || pair.solver_manifolds().iter().flat_map(|m| &m.points).any(|p| p.data.impulse > 0.0);
            // 1.2: contacts act a little before the surfaces meet
            if !(-0.2 * reach..=1.2 * reach).contains(&height) || !pushes() {
                continue;
            }
            if let Some(trace) = self.traces.get_mut(index) {
                self.rim_hits += usize::from(trace.off_rim_s > self.config.rim_pause_s);
                trace.off_rim_s = 0.0;
            }
        }
    }

    /// How many grains are where.
    #[must_use]
    pub fn counts(&self) -> Counts {
        self.counts
    }

    /// Where each grain is, in their order.
    pub fn places(&self) -> impl Iterator<Item = Place> + '_ {
        self.traces.iter().map(|trace| trace.place)
    }

    /// Mass in a place, kg.
    #[must_use]
    pub fn mass_kg(&self, place: Place) -> f64 {
        self.traces.iter().filter(|trace| trace.place == place).map(|trace| trace.mass_kg).sum()
    }

    /// The container that is poured from.
    #[must_use]
    pub fn source(&self) -> &AttachedContainer {
        &self.source
    }

    /// The container that is poured into.
    #[must_use]
    pub fn target(&self) -> Option<&AttachedContainer> {
        self.target.as_ref()
    }

    /// Mass flow out of the source over the last finished interval, kg/s.
    #[must_use]
    pub fn flow_kg_per_s(&self) -> f64 {
        self.flow.last_kg_per_s()
    }

    /// The greatest flow of any finished interval, kg/s.
    #[must_use]
    pub fn peak_flow_kg_per_s(&self) -> f64 {
        self.flow.peak_kg_per_s()
    }

    /// The mean flow between the first and the last interval with flow, kg/s.
    #[must_use]
    pub fn mean_flow_kg_per_s(&self) -> f64 {
        self.flow.mean_kg_per_s()
    }

    /// Standard deviation over mean of the intervals between the first and the last with flow.
    #[must_use]
    pub fn flow_variation(&self) -> f64 {
        self.flow.variation()
    }

    /// Mean speed of the grains as they leave the source, m/s; 0 if none did.
    #[must_use]
    pub fn exit_speed_m_per_s(&self) -> f64 {
        self.exits.speeds / self.exits.count.max(1.0)
    }

    /// How many times the flow stopped while the source was tilted and not yet empty.
    #[must_use]
    pub fn clogs(&self) -> usize {
        self.flow.clogs()
    }

    /// How many times a grain left the target again.
    #[must_use]
    pub fn bounce_outs(&self) -> usize {
        self.bounce_outs
    }

    /// How many times a grain hit the target's rim.
    #[must_use]
    pub fn rim_hits(&self) -> usize {
        self.rim_hits
    }

    /// Where the grains came down through the target's mouth plane.
    #[must_use]
    pub fn landing(&self) -> &LandingSpread {
        &self.landing
    }
}

fn height_in(target_from_world: &Isometry3<f64>, body: &rapier3d::prelude::RigidBody) -> f64 {
    let at = body.translation();
    (target_from_world * Point3::new(at.x, at.y, at.z)).z
}

#[cfg(test)]
#[path = "monitor_tests.rs"]
mod tests;
