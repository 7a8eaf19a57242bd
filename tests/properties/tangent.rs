//! The tangent of a motion against differences of neighbouring motions, whose distance is scanned over decades.

use slidercrank::model::signals::{Inputs, Outputs};
use slidercrank::scene::parameter::Parameter;
use slidercrank::scene::read::read;
use slidercrank::scene::{DampingLaw, Elasticity, FrictionLaw, JointModel, Lubrication, Method, Scene, Surface};
use slidercrank::simulation::variation::{Seed, Variation};
use slidercrank::simulation::{Direction, HostedMechanism, Phase, Simulation};

/// Distances of neighbours, in noticeable differences or as shares of a parameter.
const DECADES: [f64; 8] = [1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8];
/// Largest difference on the plateau, relative to the direction.
const AGREEMENT: f64 = 1e-6;
/// The same for outputs, which are forces, too.
const OUTPUT_AGREEMENT: f64 = 1e-4;

fn shipped(name: &str) -> Scene {
    let path = format!("{}/../fmu-harness/scenes/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(&path).expect("a shipped scene");
    let mut scene = read(&text, &path).expect("a sound scene").scene;
    scene.solver.tolerance = 1e-11;
    scene
}

fn parameter(name: &str) -> &'static Parameter {
    Parameter::named(name).expect("a parameter")
}

fn flat(phase: &Phase) -> Vec<f64> {
    phase.states.iter().copied().chain(phase.approach.iter().map(|speed| speed.unwrap_or_default())).collect()
}

/// Differences of order 4 on both sides of 0.
fn difference(step: f64, of: impl Fn(f64) -> Vec<f64>) -> Vec<f64> {
    let [near, far] = [1.0, 2.0].map(|places| (of(places * step), of(-places * step)));
    let terms = near.0.iter().zip(&near.1).zip(far.0.iter().zip(&far.1));
    terms.map(|((a, b), (c, d))| (8.0 * (a - b) - (c - d)) / (12.0 * step)).collect()
}

/// Smallest largest difference between `exact` and the differences of all decades, relative to the size of `exact`, each
/// component in units of its scale. What has shrunk to less than a tenth of a noticeable difference is measured by that: in
/// the differences it drowns in the errors of steps.
fn plateau(exact: &[f64], scales: &[f64], of: impl Fn(f64) -> Vec<f64>) -> f64 {
    let size = exact.iter().zip(scales).map(|(exact, scale)| (exact / scale).abs()).fold(0.1, f64::max);
    let miss = |step: &f64| {
        let found = difference(*step, &of);
        let misses = found.iter().zip(exact).zip(scales).map(|((found, exact), scale)| ((found - exact) / scale).abs());
        misses.fold(0.0, f64::max) / size
    };
    DECADES.iter().map(miss).fold(f64::INFINITY, f64::min)
}

/// Checks the tangent of a motion from the time `from` on over `span` [s] by all states and by `parameters`, and the
/// derivatives of some outputs.
fn check(name: &str, scene: &Scene, from: f64, span: f64, parameters: &[&str]) {
    check_to(AGREEMENT, name, scene, from, span, parameters);
}

fn check_to(agreement: f64, name: &str, scene: &Scene, from: f64, span: f64, parameters: &[&str]) {
    let inputs = Inputs { crank_torque: 3.0, slider_load: -20.0 };
    let mut simulation = Simulation::start(scene, inputs).expect("a start");
    simulation.advance_to(from).expect("a motion");
    let start = simulation.phase();
    let scales = simulation.phase_scales();
    let n = start.states.len();
    let rows: Vec<f64> = scales.states.iter().copied().chain(start.approach.iter().map(|_| scales.approach)).collect();
    let mut seeds: Vec<Seed> = (0..n).map(Seed::State).collect();
    seeds.extend(parameters.iter().map(|name| Seed::Parameter(parameter(name))));
    seeds.extend([Seed::CrankTorque, Seed::SliderLoad]);
    let mut variation = Variation::start(scene, inputs, &seeds).expect("a start");
    variation.place(&start);
    variation.advance_to(from + span).expect("a motion");
    let directions = variation.directions().expect("no grazing");
    let derivatives = variation.output_derivatives().expect("no grazing");
    let is_oiled = scene.joint.b.lubrication != Lubrication::None;
    let touches = start.approach.iter().any(Option::is_some) || variation.outputs().solver.events > 0;
    assert!(touches || is_oiled, "{name}: a force in the window");
    let observed = |outputs: &Outputs| vec![outputs.slider.x, outputs.slider.v, outputs.joint_c.force[0]];
    let outputs = variation.outputs();
    let [x, y] = outputs.joint_c.force;
    let size = [outputs.slider.x, outputs.slider.v, x.hypot(y)];
    for (column, seed) in seeds.iter().enumerate() {
        let (unit, what) = match seed {
            Seed::State(place) => (scales.states[*place], format!("state {place}")),
            Seed::Parameter(parameter) => (parameter.value(scene), parameter.name.to_owned()),
            Seed::CrankTorque => (inputs.crank_torque, "torque".to_owned()),
            _ => (inputs.slider_load, "load".to_owned()),
        };
        let run = |share: f64| {
            let (mut scene, mut moved, mut inputs) = (scene.clone(), start.clone(), inputs);
            match seed {
                Seed::State(place) => moved.states[*place] += share * unit,
                Seed::Parameter(parameter) => parameter.write(&mut scene, unit * (1.0 + share)).expect("a value"),
                Seed::CrankTorque => inputs.crank_torque *= 1.0 + share,
                _ => inputs.slider_load *= 1.0 + share,
            }
            let mut simulation = Simulation::start(&scene, inputs).expect("a start");
            simulation.place(&moved);
            simulation.advance_to(from + span).expect("a motion");
            simulation
        };
        let exact: Vec<f64> = directions.column(column).iter().map(|slope| slope * unit).collect();
        if exact.iter().all(|slope| *slope == 0.0) {
            assert_eq!(flat(&run(0.1).phase()), flat(&run(0.0).phase()), "{name}, {what}: has an influence");
            continue;
        }
        let miss = plateau(&exact, &rows, |share| flat(&run(share).phase()));
        assert!(miss < agreement, "{name}, {what}: states miss by {miss:e}");
        if is_oiled {
            continue; // The forces of oil follow the velocities, and so the errors of steps, too closely for differences.
        }
        let exact: Vec<f64> = observed(&derivatives[column]).iter().map(|slope| slope * unit).collect();
        // Each output by itself.
        for (place, exact) in exact.iter().enumerate() {
            let negligible = 1e-2 * size[place].abs();
            let scale = exact.abs().max(negligible).max(f64::MIN_POSITIVE);
            let miss = plateau(&[*exact], &[scale], |share| vec![observed(&run(share).outputs())[place]]);
            assert!(
                miss < OUTPUT_AGREEMENT,
                "{name}, {what}: output {place} misses by {miss:e} of {exact:e}, {size:?}"
            );
        }
    }
}

#[test]
fn one_play() {
    check(
        "wornpin",
        &shipped("wornpin"),
        3e-3,
        5e-4,
        &["joint.C.clearance", "rod.length", "joint.C.young.bearing", "slider.mass"],
    );
}

#[test]
fn a_flexible_rod() {
    check("flexrod", &shipped("flexrod"), 3e-3, 3e-4, &["joint.C.clearance", "rod.length", "rod.flexible.density"]);
}

#[test]
fn four_plays() {
    check(
        "allplay",
        &shipped("allplay"),
        3e-3,
        5e-4,
        &["joint.A.clearance", "guide.offset", "rod.length", "crank.length"],
    );
    check_to(
        2e-5,
        "press",
        &shipped("press"),
        3e-3,
        5e-4,
        &["joint.B.clearance", "gravity", "slider.mass", "rod.length", "crank.length"],
    );
}

/// Within 7e-9 m/s of the speed at which damping takes a force away, long before its contact opens, all differences that
/// double precision allows reach across, unless they are taken along that speed. Both ends of the slider are in contact
/// there, at 34.4 ms; the next impact makes an error a hundred times as large.
#[test]
fn a_force_that_dies_away_long_before_its_contact_opens() {
    let (scene, end) = (shipped("guideplay"), 0.0402);
    for (name, measured) in [("crank.length", 2e-4), ("rod.length", 2e-4)] {
        let parameter = parameter(name);
        let mut variation =
            Variation::start(&scene, Inputs::default(), &[Seed::Parameter(parameter)]).expect("a start");
        variation.advance_to(end).expect("a motion");
        let exact = variation.output_derivatives().expect("no grazing")[0].slider.v;
        let speed = |change: f64| {
            let mut moved = scene.clone();
            parameter.write(&mut moved, parameter.value(&scene) + change).expect("a value");
            let mut simulation = Simulation::start(&moved, Inputs::default()).expect("a start");
            simulation.advance_to(end).expect("a motion");
            vec![simulation.outputs().slider.v]
        };
        let found = difference(1e-6 * parameter.value(&scene), speed)[0];
        assert!((found / exact - 1.0).abs() < measured, "{name}: {exact:e}, by differences {found:e}");
    }
}

#[test]
fn play_in_the_guide() {
    let scene = shipped("guideplay");
    check(
        "guideplay",
        &scene,
        1e-2,
        4e-3,
        &["joint.T.clearance", "joint.T.friction.coefficient", "rod.length", "crank.length"],
    );
    let mut faces = scene;
    faces.joint.t.surface = Surface::Foundation;
    // The step of another method in one of two neighbours would be the larger part of their difference.
    faces.solver.method = Method::Verner7;
    faces.solver.tolerance = 1e-12;
    // Where a face lies flat, neighbours must be near for the first order, and their differences drown in rounding. At the
    // first landing there is no tilt.
    for from in [2e-3, 7e-3] {
        check_to(2e-5, "faces", &faces, from, 1e-3, &["joint.T.clearance"]);
    }
}

#[test]
fn bristles_layers_and_an_implicit_method() {
    let mut scene = shipped("wornpin");
    let contact = &mut scene.joint.c.contact;
    (contact.friction.law, contact.friction.coefficient) = (FrictionLaw::Lugre, 0.04);
    contact.law = DampingLaw::Flores;
    scene.joint.c.elasticity = Elasticity::Liu;
    scene.solver.method = Method::Rodas4;
    scene.solver.tolerance = 1e-9;
    check("bristles", &scene, 3e-3, 2e-4, &["joint.C.friction.sigma0", "joint.C.clearance"]);
}

#[test]
fn oil() {
    check("oilpress", &shipped("oilpress"), 1e-3, 1e-4, &["joint.B.viscosity", "joint.B.clearance"]);
}

#[test]
fn what_decays_within_a_long_step_is_gone_at_its_end() {
    // Oil slows what moves against it within microseconds, and implicit steps are a hundred times as long.
    let mut scene = shipped("oilpress");
    scene.solver.tolerance = 1e-6;
    for (from, end) in [(5e-3, 6e-3), (10.1e-3, 11.1e-3), (14e-3, 15e-3), (28e-3, 28.1e-3)] {
        let mut simulation = Simulation::start(&scene, Inputs::default()).expect("a start");
        simulation.advance_to(from).expect("a motion");
        let snapshot = simulation.snapshot();
        let (start, scales) = (simulation.phase(), simulation.phase_scales().states);
        let seeds: Vec<Seed> = (0..scales.len()).map(Seed::State).collect();
        let mut variation = Variation::resume(&scene, &snapshot, &seeds).expect("the state");
        variation.advance_to(end).expect("a motion");
        let directions = variation.directions().expect("no grazing");
        let fine = shipped("oilpress");
        for (column, seed) in directions.column_iter().zip(&seeds) {
            let Seed::State(place) = *seed else { continue };
            let exact: Vec<f64> = column.iter().take(scales.len()).map(|slope| slope * scales[place]).collect();
            let miss = plateau(&exact, &scales, |share| {
                let mut moved = start.clone();
                moved.states[place] += share * scales[place];
                let mut simulation = Simulation::start(&fine, Inputs::default()).expect("a start");
                simulation.place(&moved);
                simulation.advance_to(end).expect("a motion");
                simulation.phase().states
            });
            assert!(miss < 1e-3, "state {place} from {from} s: {miss:e}");
        }
    }
}

#[test]
fn a_penetration_follows_the_eccentricity_of_a_centred_journal() {
    let scene = shipped("wornpin");
    let check = |e: [f64; 2], found: f64, slope: [f64; 2]| {
        let exact = (e[0] * slope[0] + e[1] * slope[1]) / e[0].hypot(e[1]);
        assert!((found - exact).abs() <= 1e-4 * slope[0].hypot(slope[1]), "{found} {exact}");
    };
    let seeds: Vec<Seed> = (0..4).map(Seed::State).collect();
    let mut variation = Variation::start(&scene, Inputs::default(), &seeds).expect("a start");
    variation.advance_to(1e-6).expect("a motion");
    let e = variation.outputs().joint_c.eccentricity;
    assert!(e[0].hypot(e[1]) < 1e-8, "a centred journal: {e:?}");
    for derivative in variation.output_derivatives().expect("no grazing") {
        check(e, derivative.joint_c.penetration, derivative.joint_c.eccentricity);
    }
    // A host's own integrator, with the journal nearer to the middle still.
    let mut hosted = HostedMechanism::start(&scene, Inputs::default()).expect("a start");
    hosted.states_mut()[0] += 1e-10 - hosted.outputs().joint_c.eccentricity[0];
    let e = hosted.outputs().joint_c.eccentricity;
    let count = hosted.states().len();
    for state in 0..count {
        let mut direction = Direction { states: vec![0.0; count], inputs: Inputs::default() };
        direction.states[state] = 1.0;
        let derivative = hosted.outputs_along(&direction);
        check(e, derivative.joint_c.penetration, derivative.joint_c.eccentricity);
    }
}

#[test]
fn forces_of_a_film_that_is_hardly_squeezed_have_derivatives() {
    let mut scene = shipped("oilpress");
    scene.solver.tolerance = 1e-12;
    let end = scene.crank.speed_start.recip() * 1_f64.to_radians();
    let names = ["joint.A.viscosity", "joint.A.radius", "rod.mass"];
    let seeds: Vec<Seed> = names.iter().map(|name| Seed::Parameter(parameter(name))).collect();
    let mut variation = Variation::start(&scene, Inputs::default(), &seeds).expect("a start");
    variation.advance_to(end).expect("a motion");
    for (name, derivative) in names.iter().zip(variation.output_derivatives().expect("no grazing")) {
        let (parameter, [x, y]) = (parameter(name), derivative.joint_a.force);
        let value = parameter.value(&scene);
        let exact = [derivative.joint_a.film_force, x, y].map(|slope| slope * value);
        let size = x.hypot(y) * value.abs();
        let miss = plateau(&exact, &[size; 3], |share| {
            let mut scene = scene.clone();
            parameter.write(&mut scene, value * (1.0 + share)).expect("a value");
            let mut simulation = Simulation::start(&scene, Inputs::default()).expect("a start");
            simulation.advance_to(end).expect("a motion");
            let outputs = simulation.outputs().joint_a;
            vec![outputs.film_force, outputs.force[0], outputs.force[1]]
        });
        assert!(miss < 1e-5, "{name}: {miss:e}");
    }
}

#[test]
fn parameters_change_the_start_too() {
    let mut scene = shipped("wornpin");
    scene.joint.c.eccentricity_start.x = 1e-4;
    let names = ["crank.angle_start", "crank.length", "joint.C.clearance", "rod.com.x"];
    let seeds: Vec<Seed> = names.iter().map(|name| Seed::Parameter(parameter(name))).collect();
    scene.crank.angle_start = 0.3;
    let end = 8e-4;
    let mut variation = Variation::start(&scene, Inputs::default(), &seeds).expect("a start");
    variation.advance_to(end).expect("a motion");
    assert!(variation.outputs().solver.events > 0, "an impact");
    let derivatives = variation.output_derivatives().expect("no grazing");
    for (seed, derivative) in seeds.iter().zip(derivatives) {
        let Seed::Parameter(parameter) = seed else { continue };
        let value = parameter.value(&scene);
        let miss = plateau(&[derivative.slider.x * value], &[derivative.slider.x * value], |share| {
            let mut scene = scene.clone();
            parameter.write(&mut scene, value * (1.0 + share)).expect("a value");
            let mut simulation = Simulation::start(&scene, Inputs::default()).expect("a start");
            simulation.advance_to(end).expect("a motion");
            vec![simulation.outputs().slider.x]
        });
        assert!(miss < AGREEMENT, "{}: {miss:e}", parameter.name);
    }
}

#[test]
fn derivatives_by_the_speed_hold_after_many_turns() {
    let mut scene = shipped("wornpin");
    scene.joint.c.model = JointModel::Ideal;
    let seeds = ["crank.speed_start", "crank.angle_start"].map(|name| Seed::Parameter(parameter(name)));
    scene.crank.angle_start = 100.0;
    let (mut variation, end) = (Variation::start(&scene, Inputs::default(), &seeds).expect("a start"), 20.0);
    variation.advance_to(end).expect("a motion");
    // The slider's position depends on the angle alone.
    let by_angle = variation.outputs().slider.v / scene.crank.speed_start;
    let derivatives = variation.output_derivatives().expect("no grazing");
    for (derivative, exact) in derivatives.iter().zip([by_angle * end, by_angle]) {
        assert!((derivative.slider.x / exact - 1.0).abs() < 1e-6, "{} {exact}", derivative.slider.x);
    }
}

#[test]
fn what_has_no_influence_has_a_derivative_of_exactly_0() {
    let scene = shipped("wornpin");
    let names = ["joint.A.clearance", "joint.B.restitution", "crank.mass", "rod.flexible.young"];
    let seeds: Vec<Seed> = names.iter().map(|name| Seed::Parameter(parameter(name))).collect();
    let mut variation = Variation::start(&scene, Inputs::default(), &seeds).expect("a start");
    variation.advance_to(1e-3).expect("a motion");
    assert!(variation.outputs().solver.events > 0, "an impact");
    assert!(variation.directions().expect("no grazing").iter().all(|slope| *slope == 0.0));
    for derivative in variation.output_derivatives().expect("no grazing") {
        assert_eq!(derivative.joint_c.force, [0.0; 2]);
    }
}

#[test]
fn a_tangent_changes_no_bit_of_the_motion() {
    for name in ["wornpin", "press"] {
        let scene = shipped(name);
        let mut simulation = Simulation::start(&scene, Inputs::default()).expect("a start");
        let mut variation = Variation::start(&scene, Inputs::default(), &[Seed::State(0)]).expect("a start");
        for time in [5e-4, 2e-3] {
            simulation.advance_to(time).expect("a motion");
            variation.advance_to(time).expect("a motion");
            let (ours, theirs) = (simulation.outputs(), variation.outputs());
            assert_eq!(
                (ours.slider, ours.joint_c, ours.solver.evaluations),
                (theirs.slider, theirs.joint_c, theirs.solver.evaluations)
            );
        }
    }
}

#[test]
fn volume_grows_by_the_mean_divergence() {
    // Without damping by the approach speed a contact remembers nothing, and all rates are continuous: the saltations
    // have determinant 1.
    let mut scene = shipped("guideplay");
    scene.joint.t.contact.restitution = 1.0;
    scene.joint.t.damping = 3.0;
    scene.joint.a.damping = 0.01;
    let seeds: Vec<Seed> = (0..6).map(Seed::State).collect();
    let mut variation = Variation::start(&scene, Inputs::default(), &seeds).expect("a start");
    // Simpson's rule; the communication points are near enough for the contacts.
    let (span, steps) = (2e-2, 20_000_u32);
    let step = span / f64::from(steps);
    let mut sum = 0.0;
    for k in 0..=steps {
        if k > 0 {
            variation.advance_to(f64::from(k) * step).expect("a motion");
        }
        let weight = if k == 0 || k == steps { 1.0 } else { f64::from(2 + 2 * (k % 2)) };
        sum += weight * variation.divergence() * step / 3.0;
    }
    assert!(variation.outputs().solver.events > 2, "impacts");
    let directions = variation.directions().expect("no grazing");
    let volume = directions.rows(0, 6).into_owned().determinant().ln();
    assert!(sum < -0.01 && (volume - sum).abs() < 1e-4 * sum.abs(), "{volume} {sum}");
}

#[test]
fn what_has_no_tangent_says_so() {
    let mut scene = shipped("guideplay");
    let of = |name: &str| [Seed::Parameter(parameter(name))];
    let refusal = |scene: &Scene, seeds: &[Seed]| {
        Variation::start(scene, Inputs::default(), seeds).err().expect("a refusal").to_string()
    };
    assert!(refusal(&scene, &of("solver.method")).contains("solver.method is not a real number"));
    scene.joint.t.contact.restitution = 1.0;
    assert!(refusal(&scene, &of("joint.T.restitution")).contains("joint.T.restitution = 1"));
    scene.solver.method = Method::Moreau;
    assert!(refusal(&scene, &[]).contains("moreau"));
}
