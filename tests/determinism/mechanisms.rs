//! Mechanisms of every topology, ways to cut up their runs, and their bits.

use slidercrank::model::signals::{Inputs, Outputs};
use slidercrank::scene::{DampingLaw, DriveMode, FrictionLaw, JointModel, Method, Scene};
use slidercrank::simulation::{Simulation, Snapshot};

/// Pseudo-random numbers, the same on every run: xorshift64*, G. Marsaglia 2003, S. Vigna 2016.
pub struct Dice(pub u64);

impl Dice {
    /// In 0 .. 1.
    pub fn throw(&mut self) -> f64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        (self.0.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 11) as f64 / (1u64 << 53) as f64
    }
}

pub const METHODS: [Method; 8] = [
    Method::Automatic,
    Method::Verner7,
    Method::Cong8,
    Method::Dopri5,
    Method::Dop853,
    Method::Radau13,
    Method::Rk4,
    Method::Moreau,
];
pub const LAWS: [FrictionLaw; 4] = [FrictionLaw::Ambrosio, FrictionLaw::Tanh, FrictionLaw::Stribeck, FrictionLaw::None];
/// [s] Length of a run: a third of a turn and some impacts of every joint.
pub const END: f64 = 0.012;

/// A mechanism without symmetry of each of the thirty-two topologies, under one method.
pub fn mechanisms(method: Method) -> impl Iterator<Item = (String, Scene)> {
    (0..32).map(move |bits: usize| {
        let mut scene = Scene { gravity: 9.81, ..Scene::default() };
        (scene.crank.angle_start, scene.crank.speed_start) = (0.4, 180.0);
        (scene.crank.com.y, scene.rod.com.y, scene.slider.com.y) = (-0.007, 0.005, 0.004);
        (scene.slider.com.x, scene.slider.centre.y, scene.guide.offset) = (0.006, 0.002, 0.015);
        scene.solver.method = method;
        scene.solver.tolerance = 1e-6;
        scene.solver.step = 5e-6;
        if bits & 16 != 0 {
            scene.drive.mode = DriveMode::Speed;
        }
        let joint = &mut scene.joint;
        let models = [&mut joint.a.model, &mut joint.b.model, &mut joint.c.model, &mut joint.t.model];
        let mut name = format!("{method:?}, {:?} drive, ", scene.drive.mode);
        for (i, (model, letter)) in models.into_iter().zip("ABCT".chars()).enumerate() {
            if bits >> i & 1 == 1 {
                *model = JointModel::Clearance;
                name.push(letter);
            }
        }
        (joint.a.damping, joint.t.damping) = (1e-4, 0.5);
        let contacts = [&mut joint.a.contact, &mut joint.b.contact, &mut joint.c.contact, &mut joint.t.contact];
        for (contact, law) in contacts.into_iter().zip(LAWS) {
            contact.friction.law = law;
        }
        (name, scene)
    })
}

/// The same with a pin so tight that its motion is stiff, and contacts that hardly ring, under the method that changes.
pub fn stiff() -> impl Iterator<Item = (String, Scene)> {
    mechanisms(Method::Automatic).map(|(name, mut scene)| {
        let joint = &mut scene.joint;
        joint.c.damping = 1e3;
        for contact in [&mut joint.a.contact, &mut joint.b.contact, &mut joint.c.contact, &mut joint.t.contact] {
            (contact.law, contact.restitution) = (DampingLaw::Flores, 0.05);
        }
        (format!("stiff, {name}"), scene)
    })
}

/// [1/s] A fraction of the evaluations that these mechanisms take.
const DEADLINE: f64 = 5e5;

/// The same within a deadline, which they cannot keep at their tolerance.
pub fn hurried() -> impl Iterator<Item = (String, Scene)> {
    [Method::Automatic, Method::Dop853].into_iter().flat_map(mechanisms).map(|(name, mut scene)| {
        scene.solver.deadline = DEADLINE;
        (format!("deadline, {name}"), scene)
    })
}

pub const INPUTS: Inputs = Inputs { crank_torque: 4.0, slider_load: -60.0 };

pub fn start(scene: &Scene) -> Simulation {
    scene.check().expect("a legal scene");
    Simulation::start(scene, INPUTS).expect("a scene whose loop closes")
}

pub fn advance(simulation: &mut Simulation, t: f64) {
    simulation.advance_to(t).expect("a motion without trouble");
}

pub fn outputs_at(simulation: &mut Simulation, t: f64) -> Outputs {
    advance(simulation, t);
    simulation.outputs()
}

/// Every bit of the outputs: `Debug` prints floats so that they read back the same, signs of zero too.
pub fn bits(outputs: &Outputs) -> String {
    format!("{outputs:?}")
}

/// Outputs and memory, bit for bit. An interval begins here: what counts from the last communication point is left out.
pub fn reached(simulation: &mut Simulation) -> (String, (Vec<u64>, Vec<u64>)) {
    simulation.begin_interval();
    (bits(&simulation.outputs()), memory(simulation))
}

/// All that is remembered, bit for bit.
pub fn memory(simulation: &Simulation) -> (Vec<u64>, Vec<u64>) {
    let Snapshot { reals, integers } = simulation.snapshot();
    (reals.into_iter().map(f64::to_bits).collect(), integers)
}

/// From `from` to END in steps of any length, from one bit of time to the whole.
pub fn split(dice: &mut Dice, from: f64) -> Vec<f64> {
    let mut times = vec![];
    let mut t = from;
    while t < END {
        let step = END * 10f64.powf(-17.0 * dice.throw());
        // Long ones often, so that the run comes to an end.
        let step = if dice.throw() < 0.5 { step } else { END * 0.1 * dice.throw() };
        t = (t + step).max(t.next_up()).min(END);
        times.push(t);
    }
    times
}
