//! The same bits twice, after a restore, and for any split of the communication interval; and an input
//! that changes at a communication point changes there and nowhere else.

use slidercrank::model::signals::{Inputs, Outputs};
use slidercrank::scene::{DriveMode, FrictionLaw, JointModel, Method, Point, Scene};
use slidercrank::simulation::{Simulation, Snapshot};

/// Pseudo-random numbers, the same on every run: xorshift64*, G. Marsaglia 2003, S. Vigna 2016.
struct Dice(u64);

impl Dice {
    /// In 0 .. 1.
    fn throw(&mut self) -> f64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        (self.0.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 11) as f64 / (1u64 << 53) as f64
    }
}

const METHODS: [Method; 4] = [Method::Verner7, Method::Dopri5, Method::Dop853, Method::Rk4];
const LAWS: [FrictionLaw; 4] = [FrictionLaw::Ambrosio, FrictionLaw::Tanh, FrictionLaw::Stribeck, FrictionLaw::None];
/// [s] Length of a run: a third of a turn and some impacts of every joint.
const END: f64 = 0.012;

/// A mechanism without symmetry of each of the thirty-two topologies, under one method.
fn mechanisms(method: Method) -> impl Iterator<Item = (String, Scene)> {
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

const INPUTS: Inputs = Inputs { crank_torque: 4.0, slider_load: -60.0 };

fn start(scene: &Scene) -> Simulation {
    scene.check().expect("a legal scene");
    Simulation::start(scene, 0.0, INPUTS).expect("a scene whose loop closes")
}

fn advance(simulation: &mut Simulation, t: f64) {
    simulation.advance_to(t).expect("a motion without trouble");
}

fn outputs_at(simulation: &mut Simulation, t: f64) -> Outputs {
    advance(simulation, t);
    simulation.outputs()
}

/// Every bit of the outputs: `Debug` prints floats so that they read back the same, signs of zero too.
fn bits(outputs: &Outputs) -> String {
    format!("{outputs:?}")
}

/// All that is remembered, bit for bit.
fn memory(simulation: &Simulation) -> (Vec<u64>, Vec<u64>) {
    let Snapshot { reals, integers } = simulation.snapshot();
    (reals.into_iter().map(f64::to_bits).collect(), integers)
}

#[test]
fn the_same_bits_twice() {
    for (name, scene) in METHODS.into_iter().flat_map(mechanisms) {
        let [one, other] = [(); 2].map(|()| {
            let mut simulation = start(&scene);
            advance(&mut simulation, END);
            (bits(&simulation.outputs()), memory(&simulation))
        });
        assert_eq!(one, other, "{name}");
    }
}

#[test]
fn contacts_and_events_go_on_in_these_runs() {
    for (name, scene) in METHODS.into_iter().flat_map(mechanisms) {
        let events = outputs_at(&mut start(&scene), END).solver.events;
        let clear = name.chars().rev().take_while(|letter| "ABCT".contains(*letter)).count();
        assert!(events >= 2 * clear as i32, "{name}: {events} events");
    }
}

/// From `from` to END in steps of any length, from one bit of time to the whole.
fn split(dice: &mut Dice, from: f64) -> Vec<f64> {
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

#[test]
fn the_same_bits_for_any_split_of_the_interval() {
    let mut dice = Dice(0x5EED);
    for (name, scene) in METHODS.into_iter().flat_map(mechanisms) {
        let mut whole = start(&scene);
        advance(&mut whole, END);
        let wanted = (bits(&whole.outputs()), memory(&whole));
        for _ in 0..4 {
            let mut simulation = start(&scene);
            for t in split(&mut dice, 0.0) {
                advance(&mut simulation, t);
                // Whether and what is asked on the way makes no difference.
                match dice.throw() {
                    x if x < 0.3 => drop(simulation.outputs()),
                    x if x < 0.4 => drop(simulation.output_rates()),
                    x if x < 0.5 => drop(simulation.output_sensitivity(INPUTS)),
                    x if x < 0.6 => simulation.set_inputs(INPUTS, Inputs::default()),
                    _ => {}
                }
            }
            assert_eq!((bits(&simulation.outputs()), memory(&simulation)), wanted, "{name}");
        }
    }
}

#[test]
fn the_same_bits_on_the_way_whatever_was_asked_before() {
    let mut dice = Dice(0xD1CE);
    for (name, scene) in mechanisms(Method::Verner7) {
        let mut walker = start(&scene);
        for t in split(&mut dice, 0.0) {
            let mut jumper = start(&scene);
            assert_eq!(bits(&outputs_at(&mut walker, t)), bits(&outputs_at(&mut jumper, t)), "{name} at {t}");
        }
    }
}

#[test]
fn a_restored_run_is_one_that_never_stopped() {
    let mut dice = Dice(0xCAFE);
    for (name, scene) in METHODS.into_iter().flat_map(mechanisms) {
        let mut whole = start(&scene);
        let mut saved = vec![];
        let times = split(&mut dice, 0.0);
        for &t in &times {
            advance(&mut whole, t);
            if dice.throw() < 0.3 {
                saved.push((t, whole.snapshot(), bits(&whole.outputs())));
            }
            if dice.throw() < 0.2 {
                let change = Inputs { crank_torque: 3.0 * dice.throw(), slider_load: 0.0 };
                whole.set_inputs(change, Inputs { crank_torque: 0.0, slider_load: 10.0 });
                saved.clear();
            }
        }
        let wanted = (bits(&whole.outputs()), memory(&whole));
        for (t, snapshot, outputs) in saved {
            let mut again = Simulation::restore(&scene, &snapshot).expect("its own state");
            assert_eq!((again.time(), bits(&again.outputs())), (t, outputs), "{name} at {t}");
            assert_eq!(again.snapshot(), snapshot, "{name} at {t}");
            for t in split(&mut dice, t) {
                advance(&mut again, t);
            }
            assert_eq!((bits(&again.outputs()), memory(&again)), wanted, "{name} from {t}");
        }
    }
}

#[test]
fn a_snapshot_of_another_mechanism_is_refused() {
    let all: Vec<(String, Scene)> = mechanisms(Method::Verner7).collect();
    for (name, scene) in &all {
        let snapshot = start(scene).snapshot();
        for (other_name, other) in &all {
            let same_size =
                Simulation::start(other, 0.0, INPUTS).expect("a start").snapshot().reals.len() == snapshot.reals.len();
            let restored = Simulation::restore(other, &snapshot);
            assert_eq!(restored.is_ok(), same_size, "{name} as {other_name}");
        }
    }
    let (_, scene) = &all[31];
    let whole = start(scene).snapshot();
    for cut in 0..whole.reals.len() {
        let snapshot = Snapshot { reals: whole.reals[..cut].to_vec(), integers: whole.integers.clone() };
        assert!(Simulation::restore(scene, &snapshot).is_err(), "{cut} reals");
    }
    let mut long = whole;
    long.integers.push(0);
    assert!(Simulation::restore(scene, &long).is_err());
}

#[test]
fn setting_the_same_inputs_changes_nothing() {
    for torque in [4.0, 0.0, 1e-300] {
        let same = Inputs { crank_torque: torque, slider_load: 0.1 };
        for (name, scene) in mechanisms(Method::Verner7) {
            let begin = || Simulation::start(&scene, 0.0, same).expect("a start");
            let (mut quiet, mut talkative) = (begin(), begin());
            for i in 1..=200 {
                let t = END * f64::from(i) / 200.0;
                advance(&mut quiet, t);
                advance(&mut talkative, t);
                talkative.set_inputs(same, Inputs::default());
                assert_eq!(bits(&quiet.outputs()), bits(&talkative.outputs()), "{name}, torque {torque} at {t}");
            }
        }
    }
}

#[test]
fn a_slope_that_goes_on_changes_nothing() {
    // Powers of two, so that value + rate·time is exact.
    let rate = Inputs { crank_torque: 1024.0, slider_load: -4096.0 };
    let at = |t: f64| Inputs { crank_torque: 1.0 + 1024.0 * t, slider_load: -4096.0 * t };
    let step = 1.0 / 8192.0;
    for (name, scene) in mechanisms(Method::Verner7) {
        let mut quiet = Simulation::start(&scene, 0.0, at(0.0)).expect("a start");
        quiet.set_inputs(at(0.0), rate);
        let mut talkative = Simulation::start(&scene, 0.0, at(0.0)).expect("a start");
        for i in 0..100 {
            let t = step * f64::from(i);
            talkative.set_inputs(at(t), rate);
            advance(&mut talkative, t + step);
        }
        advance(&mut quiet, 100.0 * step);
        assert_eq!(bits(&quiet.outputs()), bits(&talkative.outputs()), "{name}");
    }
}

/// Largest difference of two runs' states of motion, each over its size.
fn apart(one: &Outputs, other: &Outputs) -> f64 {
    let pairs = [
        (one.slider.x, other.slider.x, 0.1),
        (one.slider.v, other.slider.v, 10.0),
        (one.slider.y, other.slider.y, 0.01),
        (one.crank.angle, other.crank.angle, 1.0),
        (one.crank.speed, other.crank.speed, 180.0),
        (one.rod.angle, other.rod.angle, 1.0),
        (one.rod.speed, other.rod.speed, 100.0),
    ];
    pairs.into_iter().map(|(one, other, size)| (one - other).abs() / size).fold(0.0, f64::max)
}

#[test]
fn an_input_that_changes_does_so_exactly_at_its_communication_point() {
    let mut dice = Dice(0xF00D);
    let later = Inputs { crank_torque: -30.0, slider_load: 900.0 };
    for (name, scene) in METHODS.into_iter().flat_map(mechanisms) {
        for change in [0.001_234_567, 0.005, 0.009_999_9] {
            // With other splits before and after the change: the same bits.
            let runs = [0, 1, 2].map(|splits| {
                let mut simulation = start(&scene);
                for t in split(&mut dice, 0.0).into_iter().filter(|&t| t < change && splits > 0) {
                    advance(&mut simulation, t);
                }
                advance(&mut simulation, change);
                let before = simulation.outputs();
                simulation.set_inputs(later, Inputs::default());
                let after = simulation.outputs();
                // Before it the state is interpolated, after it it is the end of a step of its own: both know
                // it to the tolerance of 1e-6 of 10 µm and what the interpolation may miss; measured 1e-7.
                // Five microseconds are long for an impact.
                let bound = if scene.solver.method == Method::Rk4 { 1e-4 } else { 1e-6 };
                assert!(apart(&before, &after) < bound, "{name}: jumps by {:e}", apart(&before, &after));
                for t in split(&mut dice, change).into_iter().filter(|_| splits > 1) {
                    advance(&mut simulation, t);
                }
                advance(&mut simulation, END);
                (bits(&simulation.outputs()), memory(&simulation))
            });
            assert!(runs[0] == runs[1] && runs[1] == runs[2], "{name}, change at {change}");
        }
    }
}

#[test]
fn in_free_flight_the_load_s_impulse_counts_from_the_change_on() {
    // A slider alone on an ideal guide: v = F·t/m from the change on, and x accordingly.
    let mut scene = Scene::default();
    scene.joint.c.model = JointModel::Clearance;
    (scene.joint.c.radius, scene.joint.c.clearance) = (0.2, 0.1);
    for method in METHODS {
        scene.solver.method = method;
        for change in [0.0, 1e-9, 0.003_3, 0.007_777] {
            let mut simulation = Simulation::start(&scene, 0.0, Inputs::default()).expect("a start");
            advance(&mut simulation, change);
            simulation.set_inputs(Inputs { crank_torque: 0.0, slider_load: 14.0 }, Inputs::default());
            // 14 N, 0.14 kg: 100 m/s²; then 1000 N/s on top, from 0.002 s after the change.
            let second = change + 0.002;
            advance(&mut simulation, second);
            simulation.set_inputs(
                Inputs { crank_torque: 0.0, slider_load: 14.0 },
                Inputs { crank_torque: 0.0, slider_load: 1400.0 },
            );
            for t in [0.5e-3, 1e-3, 4e-3] {
                let o = outputs_at(&mut simulation, second + t);
                let (u, jerk) = (0.002 + t, 1e4);
                let v = 100.0 * u + 0.5 * jerk * t * t;
                let x = 0.17 + 50.0 * u * u + jerk * t * t * t / 6.0;
                assert!((o.slider.v - v).abs() < 1e-13 && (o.slider.x - x).abs() < 1e-15, "{method:?} at {t}: {o:?}");
                assert!((o.slider.a - 100.0 - jerk * t).abs() < 1e-11, "{method:?} at {t}: {}", o.slider.a);
            }
        }
    }
}

#[test]
fn a_slope_is_the_limit_of_many_small_changes() {
    // A host that knows no slopes, holding the value of each interval's middle.
    let (value, rate) = (2.0, 900.0);
    let load = |t: f64| Inputs { crank_torque: value + rate * t, slider_load: -60.0 };
    for (name, mut scene) in mechanisms(Method::Verner7).filter(|(name, _)| name.contains("Torque")) {
        scene.solver.tolerance = 1e-9;
        let end = 0.002;
        let mut sloped = Simulation::start(&scene, 0.0, load(0.0)).expect("a start");
        sloped.set_inputs(load(0.0), Inputs { crank_torque: rate, slider_load: 0.0 });
        let wanted = outputs_at(&mut sloped, end);
        let errors = [20, 80].map(|count| {
            let mut stepped = Simulation::start(&scene, 0.0, load(0.0)).expect("a start");
            for i in 0..count {
                let h = end / f64::from(count);
                stepped.set_inputs(load(h * (f64::from(i) + 0.5)), Inputs::default());
                advance(&mut stepped, h * f64::from(i + 1));
            }
            apart(&wanted, &stepped.outputs())
        });
        // The middle's rule: sixteen times less for a quarter of the step.
        assert!(errors[1] < errors[0] / 8.0 + 1e-9 && errors[0] < 1e-3, "{name}: {errors:?}");
        let drive = outputs_at(&mut sloped, end).drive_torque;
        assert!((drive - load(end).crank_torque).abs() < 1e-14, "{name}: the torque itself is an output");
    }
}

#[test]
fn outputs_use_the_inputs_of_the_interval_that_ends_until_new_ones_are_set() {
    for (name, mut scene) in mechanisms(Method::Verner7) {
        scene.slider.com = Point::default();
        let mut simulation = start(&scene);
        let before = outputs_at(&mut simulation, 0.004);
        let others = Inputs { crank_torque: 4.0, slider_load: 500.0 };
        let [first, second, third] = [others, INPUTS, others].map(|inputs| {
            simulation.set_inputs(inputs, Inputs::default());
            Outputs { solver: before.solver, ..simulation.outputs() }
        });
        assert!(apart(&before, &first) < 1e-6, "{name}: the state stays");
        // m·a = F_C + F_T + load: 560 N more, at once; to and fro brings the same bits back.
        let load = |o: &Outputs| 0.14 * o.slider.a - o.joint_c.force[0] - o.joint_t.force[0];
        assert!((load(&before) + 60.0).abs() < 1e-9 && (load(&first) - 500.0).abs() < 1e-9, "{name}: {}", load(&first));
        assert!((load(&second) + 60.0).abs() < 1e-9, "{name}: {}", load(&second));
        assert_eq!(bits(&first), bits(&third), "{name}");
    }
}
