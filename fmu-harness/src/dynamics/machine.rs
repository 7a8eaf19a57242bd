//! The mechanism of a scene with its inputs as a flow, simulated in this process.

use super::{Flow, Point};
use anyhow::{Context, Result, bail, ensure};
use slidercrank::model::signals::{Inputs, Outputs};
use slidercrank::scene::profile::{Profile, Profiles};
use slidercrank::scene::read::SceneFile;
use slidercrank::scene::{DriveMode, JointModel, Scene};
use slidercrank::simulation::{Phase, PhaseScales, Simulation};
use std::f64::consts::TAU;

/// Number of steps per turn in the search for a crank angle.
const LOOKS: f64 = 400.0;
/// Share of the way to an angle that a step goes at most: an impact may speed the crank up meanwhile.
const SHARE: f64 = 0.8;
/// [rad] Distance from an angle from which one step leads there, and the largest miss.
const NEAR: f64 = 1e-6;
/// A crank counts as stopped if a turn takes this many times as long as at the start speed.
const SLOWEST: f64 = 100.0;

/// A simulation that a [`Machine`] runs.
pub trait Simulated {
    /// [s] The time reached.
    fn time(&self) -> f64;
    /// Advances to `time` [s].
    ///
    /// # Errors
    /// If it cannot go on.
    fn advance_to(&mut self, time: f64) -> Result<()>;
    /// Outputs at the time reached.
    fn outputs(&mut self) -> Outputs;
    /// First time derivatives of the real outputs at the time reached.
    fn output_rates(&mut self) -> Outputs;
    /// Sets the inputs to the chords of the profiles from the time reached to `until` [s].
    fn apply(&mut self, inputs: &Profiles, until: f64);
    /// The point of phase space at the time reached.
    fn phase(&mut self) -> Phase;
    /// Continues from another point of phase space.
    fn place(&mut self, phase: &Phase);
}

/// A running mechanism.
pub struct Machine<S = Simulation> {
    pub(super) simulation: S,
    scene: Scene,
    inputs: Profiles,
    /// [s] Time between two updates of changing inputs.
    step: Option<f64>,
    /// [s] Where the present lines of the inputs end.
    next_look: f64,
    scales: PhaseScales,
}

/// Motion of the crank in the direction of its start speed.
struct Crank {
    /// [rad] Angle since the start.
    turned: f64,
    /// [rad/s]
    speed: f64,
    /// [rad/s²]
    acceleration: f64,
}

impl Crank {
    /// [s] Time in which it turns on by `angle` [rad] at its speed and acceleration, if it does not slow down.
    fn time(&self, angle: f64) -> f64 {
        if angle == 0.0 {
            return 0.0;
        }
        // ω·t + α·t²/2 = angle
        let Self { speed, acceleration, .. } = self;
        2.0 * angle / (speed + (speed * speed + 2.0 * acceleration.max(0.0) * angle).sqrt())
    }
}

impl Machine {
    /// Starts a scene.
    ///
    /// # Errors
    /// If it cannot start, or its crank does not turn.
    pub fn start(file: &SceneFile) -> Result<Self> {
        let simulation = Simulation::start(&file.scene, Inputs::at_start(file))?;
        let scales = simulation.phase_scales();
        Self::of(file, simulation, scales)
    }

    /// Advances to the next instant at which a contact closes or opens, or to `time`. Returns whether there was an
    /// event.
    ///
    /// # Errors
    /// If it cannot go on.
    pub fn advance_to_event(&mut self, time: f64) -> Result<bool> {
        while self.time() < time {
            let look = self.next_look;
            let event = self.simulation.advance_to_event(look.min(time))?;
            if self.time() >= look {
                self.look();
            }
            if event {
                return Ok(true);
            }
        }
        Ok(false)
    }
}

impl<S: Simulated> Machine<S> {
    /// The machine of a scene that `simulation` simulates.
    ///
    /// # Errors
    /// If its crank does not turn.
    pub fn of(file: &SceneFile, simulation: S, scales: PhaseScales) -> Result<Self> {
        let SceneFile { scene, inputs, run, .. } = file;
        ensure!(
            scene.crank.speed_start != 0.0,
            "crank.speed_start = 0 rad/s: turns cannot be counted if the crank does not turn"
        );
        let changes = |profile: &Profile| !matches!(profile, Profile::Constant(_));
        let step = (changes(&inputs.crank_torque) || changes(&inputs.slider_load)).then_some(run.step);
        let (scene, inputs) = (scene.clone(), inputs.clone());
        let mut machine = Self { simulation, scene, inputs, step, next_look: f64::INFINITY, scales };
        machine.look();
        Ok(machine)
    }

    /// Its scene.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// [s] Time of one turn at the start speed.
    pub fn turn(&self) -> f64 {
        TAU / self.scene.crank.speed_start.abs()
    }

    /// Outputs in the current state.
    pub fn outputs(&mut self) -> Outputs {
        self.simulation.outputs()
    }

    /// First time derivatives of the real outputs in the current state.
    pub fn output_rates(&mut self) -> Outputs {
        self.simulation.output_rates()
    }

    /// 1 or −1, the direction of the start speed.
    fn direction(&self) -> f64 {
        self.scene.crank.speed_start.signum()
    }

    /// [rad] Angle since the start, positive in the direction of the start speed.
    pub fn turned(&mut self) -> f64 {
        self.crank().turned
    }

    /// Advances until the crank has turned by `angle` [rad] since the start, in the direction of the start speed. A crank that
    /// turns back by a whole turn on the way does not reach it.
    ///
    /// # Errors
    /// If it cannot go on, or the crank does not reach the angle.
    pub fn advance_turned(&mut self, angle: f64) -> Result<()> {
        if self.scene.drive.mode == DriveMode::Speed {
            return self.advance(angle / self.scene.crank.speed_start.abs());
        }
        let (look, mut crank) = (self.turn() / LOOKS, self.crank());
        let least = crank.turned - TAU;
        let latest = self.time() + SLOWEST * self.turn() * (1.0 + (angle - crank.turned) / TAU);
        while self.time() < latest && crank.turned > least {
            let left = angle - crank.turned;
            let lands = left < NEAR;
            let ahead = if lands { left.max(0.0) } else { (left * SHARE).min(TAU / LOOKS) };
            self.advance(self.time() + crank.time(ahead).min(look))?;
            crank = self.crank();
            let past = crank.turned - angle;
            if lands && past > -NEAR {
                ensure!(past < NEAR, "the crank jumps past an angle by {past:.1e} rad at {} s", self.time());
                return Ok(());
            }
        }
        bail!("the crank does not turn on: at {} s it has made {:.3} turns", self.time(), self.turned() / TAU)
    }

    fn crank(&mut self) -> Crank {
        let (direction, crank) = (self.direction(), self.outputs().crank);
        let turned = direction * (crank.angle - self.scene.crank.angle_start);
        Crank { turned, speed: direction * crank.speed, acceleration: direction * crank.acceleration }
    }

    /// The point of phase space.
    pub fn phase(&mut self) -> Phase {
        self.simulation.phase()
    }

    /// [m/s] Approach speed of the closed contact in joint A, B or C (index 0, 1, 2).
    pub fn approach(&mut self, joint: usize) -> Option<f64> {
        self.simulation.phase().approach.get(joint).copied().flatten()
    }

    /// Takes over the state of another machine with the same joints, at the same crank angle.
    pub fn take_over<O: Simulated>(&mut self, other: &mut Machine<O>) {
        let mut phase = other.simulation.phase();
        if self.scene.drive.mode == DriveMode::Speed {
            phase.time = other.turned() / self.scene.crank.speed_start.abs();
        }
        self.set_phase(&phase);
    }

    /// Continues from another point of phase space, with the inputs there.
    pub(super) fn set_phase(&mut self, phase: &Phase) {
        self.simulation.place(phase);
        self.look();
    }

    /// Sets the inputs to straight lines from the time reached to the next multiple of the step, whatever times are asked
    /// for.
    pub(super) fn look(&mut self) {
        if let Some(step) = self.step {
            self.next_look = ((self.time() / step + 1e-6).floor() + 1.0) * step;
            self.simulation.apply(&self.inputs, self.next_look);
        }
    }
}

impl Simulated for Simulation {
    fn time(&self) -> f64 {
        self.time()
    }

    fn advance_to(&mut self, time: f64) -> Result<()> {
        Ok(self.advance_to(time)?)
    }

    fn outputs(&mut self) -> Outputs {
        self.outputs()
    }

    fn output_rates(&mut self) -> Outputs {
        self.output_rates()
    }

    fn apply(&mut self, inputs: &Profiles, until: f64) {
        let crank = self.outputs().crank;
        let [values, rates] = Inputs::chords(inputs, [self.time(), until], &crank);
        self.set_inputs(values, rates);
    }

    fn phase(&mut self) -> Phase {
        self.phase()
    }

    fn place(&mut self, phase: &Phase) {
        self.place(phase);
    }
}

/// Name and clearance [m] of every joint that has clearance.
pub fn clearances(scene: &Scene) -> Vec<(char, f64)> {
    let joint = &scene.joint;
    let all = [
        ('A', joint.a.model, joint.a.clearance),
        ('B', joint.b.model, joint.b.clearance),
        ('C', joint.c.model, joint.c.clearance),
        ('T', joint.t.model, joint.t.clearance),
    ];
    let there = all.into_iter().filter(|(_, model, _)| *model == JointModel::Clearance);
    there.map(|(name, _, clearance)| (name, clearance)).collect()
}

impl<S: Simulated> Flow for Machine<S> {
    fn time(&self) -> f64 {
        self.simulation.time()
    }

    fn advance(&mut self, time: f64) -> Result<()> {
        while self.time() < time {
            let look = self.next_look;
            self.simulation.advance_to(look.min(time)).with_context(|| format!("after {} s", self.time()))?;
            if look <= time {
                self.look();
            }
        }
        Ok(())
    }

    fn point(&mut self) -> Point {
        let Phase { time, states, approach } = self.simulation.phase();
        let states = states.iter().zip(&self.scales.states).map(|(state, scale)| state / scale);
        let approach_scale = self.scales.approach;
        let speeds = approach.iter().flatten().map(|speed| speed / approach_scale);
        Point {
            time,
            coordinates: states.chain(speeds).collect(),
            remembered: approach.iter().flatten().count(),
            modes: approach.iter().map(Option::is_some).collect(),
        }
    }

    fn place(&mut self, point: &Point) {
        let (states, speeds) = point.coordinates.split_at(self.scales.states.len());
        let mut speeds = speeds.iter().map(|speed| speed * self.scales.approach);
        self.set_phase(&Phase {
            time: point.time,
            states: states.iter().zip(&self.scales.states).map(|(state, scale)| state * scale).collect(),
            approach: point.modes.iter().map(|closed| closed.then(|| speeds.next()).flatten()).collect(),
        });
    }
}
