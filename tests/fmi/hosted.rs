//! Model exchange with a small host: the classical Runge-Kutta method, events by bisection of the indicators' signs. Every
//! mechanism moves as it does in co-simulation.

use host::vr;
use slidercrank::fmi::slave::states::exchange;
use slidercrank::fmi::slave::{Error, Permission, Slave, ValueType};
use slidercrank::model_description::exchange::{FIRST_DERIVATIVE, FIRST_STATE};
use slidercrank::scene::read::read;
use slidercrank::scene::{FrictionLaw, JointModel, Method, Scene, Surface};

/// [s] The host's step, a hundredth of an impact.
const H: f64 = 1e-6;
/// [s] Some impacts long, too short for their roundings to grow.
const END: f64 = 1.2e-3;
const EVERYTHING: Permission = Permission { inputs: true, outputs: true, parameters: true, state: "any" };

struct Host {
    slave: Slave,
    t: f64,
    y: Vec<f64>,
    indicators: Vec<f64>,
    events: usize,
}

fn signs(indicators: &[f64]) -> Vec<bool> {
    indicators.iter().map(|indicator| *indicator > 0.0).collect()
}

impl Host {
    fn start(scene: &Scene) -> Self {
        let mut slave = Slave::for_exchange(scene.clone()).expect("equations for another integrator");
        slave.initialize().expect("a start");
        let mut y = vec![0.0; slave.state_count().expect("states")];
        slave.write_states(&mut y).expect("states");
        let indicators = vec![0.0; slave.indicator_count().expect("indicators")];
        let mut host = Self { slave, t: 0.0, y, indicators, events: 0 };
        host.slave.update_discrete_states().expect("an update");
        host.indicators = host.indicators_here();
        host
    }

    fn place(&mut self, t: f64, y: &[f64]) {
        self.slave.set_time(t).expect("a time");
        self.slave.set_states(y).expect("states");
    }

    fn indicators_here(&mut self) -> Vec<f64> {
        let mut indicators = vec![0.0; self.indicators.len()];
        self.slave.write_indicators(&mut indicators).expect("indicators");
        indicators
    }

    fn rates(&mut self, t: f64, y: &[f64]) -> Vec<f64> {
        let mut rates = vec![0.0; y.len()];
        self.place(t, y);
        self.slave.write_derivatives(&mut rates).expect("finite rates");
        rates
    }

    /// The state after a step of `h`.
    fn stepped(&mut self, h: f64) -> Vec<f64> {
        let (t, y) = (self.t, self.y.clone());
        let along = |k: &[f64], part: f64| -> Vec<f64> { y.iter().zip(k).map(|(y, k)| y + part * h * k).collect() };
        let k1 = self.rates(t, &y);
        let k2 = self.rates(t + 0.5 * h, &along(&k1, 0.5));
        let k3 = self.rates(t + 0.5 * h, &along(&k2, 0.5));
        let k4 = self.rates(t + h, &along(&k3, 1.0));
        let sum = |i: usize| k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i];
        (0..y.len()).map(|i| y[i] + h / 6.0 * sum(i)).collect()
    }

    fn indicators_after(&mut self, h: f64) -> (Vec<f64>, Vec<f64>) {
        let y = self.stepped(h);
        let t = self.t + h;
        self.place(t, &y);
        (self.indicators_here(), y)
    }

    /// To `t`, or to the first event before.
    fn step_to(&mut self, t: f64) {
        let before = signs(&self.indicators);
        let (mut low, mut high) = (0.0, t - self.t);
        let (mut indicators, mut y) = self.indicators_after(high);
        if signs(&indicators) != before {
            while high - low > 1e-13 {
                let middle = 0.5 * (low + high);
                let (there, state) = self.indicators_after(middle);
                if signs(&there) == before {
                    low = middle;
                } else {
                    (high, indicators, y) = (middle, there, state);
                }
            }
        }
        let due = signs(&indicators) != before;
        self.t = if due { self.t + high } else { t };
        self.place(self.t, &y);
        assert_eq!(self.slave.update_is_due().expect("an answer"), due, "a step that is completed tells the same");
        if due {
            let update = self.slave.update_discrete_states().expect("an update");
            assert!(!update.dead_end);
            self.events += 1;
            // What a host compares next has the sign that it has seen, and is not 0.
            let after = self.indicators_here();
            assert_eq!(signs(&after), signs(&indicators), "at {} s", self.t);
            assert!(after.iter().all(|indicator| indicator.abs() > 1e-9), "{after:?}");
            assert!(!self.slave.update_is_due().expect("an answer"), "one iteration is enough");
            if update.states_changed {
                self.slave.write_states(&mut y).expect("states");
            }
        }
        self.y = y;
        self.indicators = self.indicators_here();
    }

    fn run(&mut self, end: f64) {
        while self.t < end {
            self.step_to((self.t + H).min(end));
        }
    }
}

fn get(slave: &mut Slave, name: &str) -> f64 {
    let mut value = [f64::NAN];
    slave.get(ValueType::Real, EVERYTHING, &[vr(name)], &mut value, |value| value).expect("an output");
    value[0]
}

/// The sixteen mechanisms, and what else has states or contacts.
fn scenes() -> Vec<(String, Scene)> {
    let base = || {
        let mut scene = Scene { gravity: 9.81, ..Scene::default() };
        (scene.crank.angle_start, scene.crank.speed_start) = (0.7, 300.0);
        (scene.solver.method, scene.solver.tolerance) = (Method::Dop853, 1e-10);
        scene
    };
    let worn = |bits: u32| {
        let mut scene = base();
        let joint = &mut scene.joint;
        let models = [&mut joint.a.model, &mut joint.b.model, &mut joint.c.model, &mut joint.t.model];
        for (bit, model) in models.into_iter().enumerate() {
            *model = if bits >> bit & 1 == 1 { JointModel::Clearance } else { JointModel::Ideal };
        }
        scene
    };
    let mut all: Vec<(String, Scene)> = (0..16).map(|bits| (format!("joints {bits:04b}"), worn(bits))).collect();
    let mut lugre = worn(0b1100);
    lugre.joint.c.contact.friction.law = FrictionLaw::Lugre;
    lugre.joint.t.contact.friction.law = FrictionLaw::Lugre;
    // Bristles that the host's explicit method can follow.
    for friction in [&mut lugre.joint.c.contact.friction, &mut lugre.joint.t.contact.friction] {
        (friction.sigma0, friction.sigma1) = (1e3, 3.0);
    }
    let mut faces = worn(0b1000);
    faces.joint.t.surface = Surface::Foundation;
    let mut flexible = worn(0b0100);
    (flexible.rod.flexible.bending_modes, flexible.rod.flexible.axial_modes) = (2, 1);
    let mut audited = worn(0b0100);
    audited.energy.audit = true;
    for (name, scene) in [("bristles", lugre), ("faces", faces), ("flexible rod", flexible), ("audit", audited)] {
        all.push((name.to_owned(), scene));
    }
    all
}

#[test]
fn every_mechanism_moves_as_in_co_simulation() {
    let mut events = 0;
    for (name, scene) in scenes() {
        let mut host = Host::start(&scene);
        host.run(END);
        let mut own = Slave::new(scene.clone(), None);
        own.initialize().expect("a start");
        own.advance_to(END).expect("a run");
        // The accuracy is the host's: h⁴ of an impact's 1e-4 s, grown by the impacts that follow.
        for (output, bound) in [("slider.x", 1e-8), ("crank.angle", 1e-7), ("slider.v", 1e-4), ("crank.speed", 1e-3)] {
            let (hosted, own) = (get(&mut host.slave, output), get(&mut own, output));
            assert!((hosted - own).abs() < bound, "{name}: {output} {hosted} for {own}, {} events", host.events);
        }
        if scene.energy.audit {
            let residual = get(&mut host.slave, "energy.residual");
            assert!(residual.abs() < 1e-6 * get(&mut host.slave, "energy.kinetic"), "{residual} J");
        }
        events += host.events;
    }
    println!("{events} events");
    assert!(events > 40, "{events} events: nothing was tried");
}

#[test]
fn a_restored_run_goes_on_to_the_bit() {
    for (name, scene) in scenes().into_iter().rev().step_by(3) {
        let mut host = Host::start(&scene);
        host.run(0.5 * END);
        let (settings, snapshot) = host.slave.save();
        let (t, y) = (host.t, host.y.clone());
        host.run(END);
        let mut other = Host::start(&scene);
        other.slave.restore(&settings, snapshot.as_ref()).expect("its own state");
        (other.t, other.y) = (t, y);
        other.indicators = other.indicators_here();
        other.run(END);
        let bits = |y: &[f64]| y.iter().map(|y| y.to_bits()).collect::<Vec<_>>();
        assert_eq!(bits(&host.y), bits(&other.y), "{name}");
    }
}

/// Derivatives against differences of the derivatives themselves, and the declared dependencies against both.
#[test]
fn derivatives_along_states_are_differences_and_declared() {
    let mut compared = 0;
    for (name, scene) in scenes() {
        let exchange = exchange(&scene).expect("model exchange");
        let mut host = Host::start(&scene);
        host.run(0.6e-3);
        let (t, y) = (host.t, host.y.clone());
        let n = y.len();
        let mut nominals = vec![0.0; n];
        host.slave.write_nominals(&mut nominals).expect("nominals");
        let rates = (FIRST_DERIVATIVE..).take(n).collect::<Vec<_>>();
        for (known, reference) in (0..n).zip(FIRST_STATE..) {
            host.place(t, &y);
            let mut along = vec![0.0; n];
            host.slave
                .directional_derivative(EVERYTHING, &rates, &[reference], &[1.0], &mut along)
                .expect("derivatives");
            let half = 1e-3 * nominals[known];
            let at = |host: &mut Host, step: f64| {
                let mut moved = y.clone();
                moved[known] += step;
                host.rates(t, &moved)
            };
            let (before, after) = (at(&mut host, -half), at(&mut host, half));
            for i in 0..n {
                let difference = (after[i] - before[i]) / (2.0 * half);
                let scale = nominals[i] / nominals[known] * 1e4 + before[i].abs() * 1e-9 / half;
                let error = (along[i] - difference).abs();
                assert!(
                    error <= 1e-5 * difference.abs() + 1e-4 * scale,
                    "{name}: {i} by {known}: {} {difference}",
                    along[i]
                );
                assert!(
                    along[i] == 0.0 || exchange.states[i].feels.contains(&known),
                    "{name}: {i} by {known} undeclared"
                );
                compared += usize::from(along[i] != 0.0);
            }
        }
        let mut by_load = vec![0.0; n];
        host.slave
            .directional_derivative(EVERYTHING, &rates, &[vr("slider.load")], &[1.0], &mut by_load)
            .expect("derivatives");
        for (by_load, state) in by_load.iter().zip(&exchange.states) {
            assert!(*by_load == 0.0 || state.feels_inputs, "{name}: {}", state.name);
        }
    }
    assert!(compared > 300, "{compared} derivatives that are not 0: nothing was tried");
}

/// Numbers of a mechanism at its start, with a parameter set.
fn at_start(scene: &Scene, unknowns: &[u32], known: &str, value: f64) -> Vec<f64> {
    let mut slave = Slave::for_exchange(scene.clone()).expect("equations for another integrator");
    slave.set(ValueType::Real, EVERYTHING, &[vr(known)], &[value], |value| value).expect("a legal value");
    let mut values = vec![0.0; unknowns.len()];
    slave.get(ValueType::Real, EVERYTHING, unknowns, &mut values, |value| value).expect("numbers");
    values
}

/// Outputs, states and their derivatives by start values and by inputs, in initialization mode.
#[test]
fn derivatives_by_start_values_are_differences() {
    let knowns = [
        "crank.speed_start",
        "crank.angle_start",
        "crank.length",
        "rod.mass",
        "slider.inertia",
        "gravity",
        "slider.load",
    ];
    let (mut compared, mut jumps) = (0, 0);
    for (name, scene) in scenes() {
        let states = exchange(&scene).expect("model exchange").states.len() as u32;
        let places = (FIRST_STATE..).take(states as usize).chain((FIRST_DERIVATIVE..).take(states as usize));
        let unknowns: Vec<u32> = places.chain(["slider.v", "slider.a", "joint.C.force.x"].map(vr)).collect();
        let mut slaves = [
            Slave::for_exchange(scene.clone()).expect("equations for another integrator"),
            Slave::new(scene.clone(), None),
        ];
        for known in knowns {
            let here = get(&mut slaves[0], known);
            let half = 1e-5 * here.abs().max(0.1);
            let [before, after] = [here - half, here + half].map(|value| at_start(&scene, &unknowns, known, value));
            let mut along = [vec![0.0; unknowns.len()], vec![0.0; unknowns.len()]];
            for (slave, along) in slaves.iter_mut().zip(&mut along) {
                match slave.directional_derivative(EVERYTHING, &unknowns, &[vr(known)], &[1.0], along) {
                    Err(Error::NoDerivative(_)) => along.fill(f64::NAN),
                    outcome => outcome.unwrap_or_else(|error| panic!("{name}, {known}: {error}")),
                }
            }
            if along[0][0].is_nan() {
                jumps += 1;
                continue;
            }
            for (at, reference) in unknowns.iter().enumerate() {
                let difference = (after[at] - before[at]) / (2.0 * half);
                let bound = 1e-4 * difference.abs() + 1e-9 * (before[at].abs() + 1.0) / half;
                for along in &along {
                    let error = (along[at] - difference).abs();
                    assert!(error <= bound, "{name}: {reference} by {known}: {} {difference}", along[at]);
                }
                compared += usize::from(along[0][at] != 0.0);
            }
        }
    }
    assert!(compared > 500 && jumps < 20, "{compared} derivatives that are not 0, {jumps} jumps");
}

#[test]
fn what_is_zero_but_for_rounding_has_a_derivative_by_start_values() {
    let mut scene = read(include_str!("../../fmu-harness/scenes/seed.toml"), "seed.toml").expect("a sound scene").scene;
    // Between journals in the middle of their bearings no force turns the rod.
    scene.crank.angle_start = 1.1;
    let states = exchange(&scene).expect("model exchange").states.len() as u32;
    let unknowns: Vec<u32> = (FIRST_DERIVATIVE..).take(states as usize).collect();
    let mut slave = Slave::for_exchange(scene).expect("equations for another integrator");
    for known in ["crank.angle_start", "crank.speed_start", "crank.length"] {
        let mut along = vec![f64::NAN; unknowns.len()];
        let told = slave.directional_derivative(EVERYTHING, &unknowns, &[vr(known)], &[1.0], &mut along);
        assert_eq!(told, Ok(()), "{known}");
        assert!(along.iter().all(|slope| slope.is_finite()) && along.iter().any(|slope| *slope != 0.0), "{along:?}");
    }
}

#[test]
fn rigid_contacts_have_no_equations_for_another_integrator() {
    let mut scene = Scene::default();
    scene.solver.method = Method::Moreau;
    let refusal = Slave::for_exchange(scene).err().expect("a refusal").to_string();
    assert!(refusal.contains("solver.method"), "{refusal}");
}

#[test]
fn a_loop_that_comes_to_its_change_point_ends_the_simulation() {
    let mut scene = Scene::default();
    (scene.crank.length, scene.rod.length, scene.crank.speed_start) = (0.05, 0.04, 10.0);
    let mut host = Host::start(&scene);
    let mut ended = false;
    for step in 1..100_000 {
        let y = host.stepped(1e-5);
        host.t = f64::from(step) * 1e-5;
        host.place(host.t, &y);
        host.y = y;
        if host.indicators_here()[0] <= 0.0 {
            ended = host.slave.update_discrete_states().expect("an update").dead_end;
            break;
        }
    }
    assert!(ended);
}
