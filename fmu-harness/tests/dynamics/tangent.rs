//! All exponents, where they are known, and periodic motions against simulated ones.

use super::lorenz::Lorenz;
use anyhow::Result;
use fmu_harness::dynamics::exponents::{Exponents, Measurement, TangentFlow};
use fmu_harness::dynamics::orbit::ReturnMap;
use fmu_harness::dynamics::poincare::PoincareMap;
use fmu_harness::dynamics::portrait::Plan;
use fmu_harness::dynamics::tangent::all_states;
use fmu_harness::dynamics::{Flow, Machine};
use fmu_harness::scenes::Scenario;
use fmu_harness::sensitivity::{Experiment, Sensitivities, Wanted, differences, parameters};
use nalgebra::DMatrix;
use slidercrank::integrator::methods::named;
use slidercrank::integrator::tangent::{Crossing, Tangents, Variational};
use slidercrank::integrator::{Integrator, Settings, System, WorkLimit};
use slidercrank::scene::DriveMode;
use slidercrank::scene::parameter::Parameter;
use slidercrank::scene::profile::{Profile, ProfileArgument};
use slidercrank::scene::read::SceneFile;

impl Variational for Lorenz {
    type Discrete = ();

    fn system(&self) -> &dyn System<Discrete = ()> {
        self
    }

    fn crossings(&self, (): &(), (): &(), _: f64, _: &[f64]) -> Vec<Crossing<()>> {
        vec![]
    }

    fn differ(&self, (): &(), (): &()) -> bool {
        false
    }
}

struct Tangent {
    integrator: Integrator<()>,
    tangents: Tangents<()>,
    time: f64,
}

impl TangentFlow for Tangent {
    fn time(&self) -> f64 {
        self.time
    }

    fn advance(&mut self, time: f64) -> Result<()> {
        let Self { integrator, tangents, .. } = self;
        integrator.advance_watched(&Lorenz, time, &mut |integrator| tangents.follow(&Lorenz, integrator))?;
        integrator.truncate(&Lorenz, time);
        tangents.shorten(&Lorenz, integrator);
        self.time = time;
        Ok(())
    }

    fn directions(&mut self) -> Result<DMatrix<f64>> {
        Ok(self.tangents.directions().expect("no events").clone())
    }

    fn set_directions(&mut self, directions: &DMatrix<f64>) {
        self.tangents.set_directions(directions.clone());
    }
}

#[test]
fn all_exponents_of_lorenz_are_found() {
    let settings = Settings { tolerance: 1e-9, fixed_step: 0.0, effort: WorkLimit::ANY };
    let start = [1.0, 1.0, 20.0];
    let integrator = Integrator::start(&Lorenz, named("verner7", 3).expect("a method"), settings, 0.0, &start, ());
    let (all, none) = (DMatrix::identity(3, 3), DMatrix::zeros(0, 3));
    let tangents = Tangents::new(&Lorenz, integrator.state(), all, none, vec![1.0; 3], 1e-8);
    let mut flow = Tangent { integrator, tangents, time: 0.0 };
    let exponents = Measurement { interval: 0.5, count: 4000, settling: 100 }.run(&mut flow, || {}).expect("exponents");
    // J. C. Sprott, Chaos and Time-Series Analysis, Oxford 2003, appendix A; the sum is the trace of the Jacobian.
    for (exponent, known) in exponents.all.iter().zip([0.9056, 0.0, -14.5723]) {
        let apart = (exponent.value - known).abs();
        assert!(apart < (4.0 * exponent.error).max(5e-3) && exponent.error < 0.02, "{} for {known}", exponent.value);
    }
    let trace = -(10.0 + 1.0 + 8.0 / 3.0);
    assert!((exponents.sum() - trace).abs() < 1e-6, "{}", exponents.sum());
    assert!((exponents.dimension() - 2.062).abs() < 5e-3, "{}", exponents.dimension());
}

fn wornpin(clearance: f64) -> slidercrank::scene::read::SceneFile {
    let mut file = Scenario::find("wornpin").expect("a shipped scene").file;
    file.scene.joint.c.clearance = clearance;
    file
}

/// All exponents of a worn pin, of which the largest is asserted to be that of two trajectories, and the standard error of their
/// difference.
fn agreeing(plan: &Plan, clearance: f64) -> (Exponents, f64) {
    let portrait = plan.portrait(&wornpin(clearance), || {}).expect("a portrait");
    let exponents = portrait.exponents.expect("asked for").expect("a tangent");
    let (one, other) = (&exponents.all[0], &portrait.exponent);
    let error = one.error.hypot(other.error);
    assert!((one.value - other.value).abs() < 4.0 * error, "{} {} {error}", one.value, other.value);
    (exponents, error)
}

#[test]
fn the_largest_exponent_of_the_worn_pin_is_that_of_two_trajectories() {
    let plan = Plan { transient: 20, turns: 200, section: 0.0, per_turn: 25, tangent_turns: 200 };
    let (exponents, error) = agreeing(&plan, 0.5e-3);
    assert!(error < 0.1 * exponents.all[0].value, "{} {error}", exponents.all[0].value);
    assert!(exponents.sum() < 0.0 && exponents.all.len() == 4);
    assert!(exponents.left_out * 10 < exponents.intervals, "{}", exponents.left_out);
}

/// A contact that stays closed remembers its approach speed for ever, which is no part of the motion.
#[test]
fn neighbours_of_a_periodic_motion_approach_it_as_the_tangent_says() {
    let plan = Plan { transient: 60, turns: 60, section: 0.0, per_turn: 25, tangent_turns: 60 };
    let (exponents, error) = agreeing(&plan, 0.02e-3);
    let largest = exponents.all[0].value;
    assert!(largest < -10.0 && error < 0.2 * largest.abs(), "{largest} {error}");
}

#[test]
fn a_periodic_motion_is_the_simulated_one_and_its_multipliers_are_how_neighbours_come_nearer() {
    let file = wornpin(0.02e-3);
    let parameter = Parameter::named("joint.C.clearance").expect("a parameter");
    let map = PoincareMap::new(&file, parameter, 0.3).expect("a map");
    let plan = Plan { transient: 40, turns: 20, section: 0.3, per_turn: 1, tangent_turns: 0 };
    let found = plan.periodic(&map, 0.02e-3).expect("a periodic motion");
    let orbit = &found.orbit;
    assert!(orbit.is_stable() && orbit.turns == 1, "{:?}", orbit.multipliers);
    // A neighbour after one period against the linear map.
    let change = nalgebra::DVector::from_fn(found.unknowns.len(), |i, _| if i % 2 == 0 { 1e-4 } else { -1e-4 });
    let moved = map.moved(&orbit.phase, &found.unknowns, &change);
    let image = map.apply(orbit.value, &moved, 1).expect("a return");
    // The miss is image minus point.
    let grown = &image.miss + &change - &found.miss;
    let linear = &found.by_unknowns * &change;
    assert!((&grown - &linear).amax() < 1e-3 * linear.amax().max(1e-3 * change.amax()), "{grown} {linear}");
    // The simulated motion comes to the same passage.
    let mut machine = Machine::start(&map.file(0.02e-3).expect("a scene")).expect("a machine");
    machine.advance_turned(0.3 + 60.0 * std::f64::consts::TAU).expect("a motion");
    let (simulated, closed) = (machine.outputs(), orbit.visits[0].outputs);
    assert!((simulated.slider.v - closed.slider.v).abs() < 1e-6 * closed.slider.v.abs().max(1.0));
    assert!(machine.time() > 0.0);
}

/// Asserts that derivatives of a run's quantities are difference quotients of neighbouring runs within a share of them.
fn assert_differences<const N: usize>(
    file: &SceneFile,
    wanted: &[&str],
    names: [&str; N],
    share: f64,
) -> Sensitivities {
    let experiment = Experiment { file, turns: 0.2, transient: 0.0, counted: false };
    let wanted: Vec<Wanted> = wanted.iter().map(|text| text.parse().expect("a quantity")).collect();
    let names = names.map(|name| parameters(name).expect("a parameter")[0]);
    let found = experiment.run(&wanted, &names).expect("a run");
    for (k, parameter) in names.into_iter().enumerate() {
        let differences = differences(&experiment, &wanted, parameter).expect("neighbours");
        for (row, difference) in found.rows.iter().zip(differences) {
            let slope = row.slopes.as_ref().expect("no grazing")[k];
            let (text, name) = (&row.wanted.text, parameter.name);
            assert!((slope - difference).abs() <= share * difference.abs(), "{text}, {name}: {slope} {difference}");
        }
    }
    found
}

#[test]
fn sensitivities_are_the_differences_of_neighbouring_runs() {
    let file = Scenario::find("wornpin").expect("a shipped scene").file;
    let wanted = ["accuracy.position@50deg", "joint.C.force:peak", "slider.v:mean", "joint.C.force.x:range"];
    let found = assert_differences(&file, &wanted, ["joint.C.clearance", "slider.mass"], 1e-3);
    assert!(found.growth > 0.0 && found.reach.iter().all(|reach| *reach > 0.0));
}

/// Between the communication points the inputs follow the crank, and forces and accelerations follow the inputs at once.
#[test]
fn inputs_over_the_crank_angle_have_their_share_in_every_derivative() {
    let over = |points: &[[f64; 2]]| Profile::Points { against: ProfileArgument::CrankAngle, points: points.into() };
    for (name, mode) in
        ["ideal", "wornpin"].into_iter().flat_map(|name| [DriveMode::Speed, DriveMode::Torque].map(|mode| (name, mode)))
    {
        let mut file = Scenario::find(name).expect("a shipped scene").file;
        file.scene.drive.mode = mode;
        file.inputs.slider_load = over(&[[0.2, 0.0], [0.6, -3000.0], [0.9, -500.0], [1.3, -4000.0]]);
        file.inputs.crank_torque = over(&[[0.1, 0.0], [0.5, 80.0], [1.4, 20.0]]);
        file.run.step = 5e-5;
        let wanted = ["slider.a", "joint.C.force.x", "drive.torque", "slider.v"];
        assert_differences(&file, &wanted, ["crank.speed_start", "crank.angle_start"], 1e-5);
        assert_differences(&file, &["joint.C.force.x@40deg", "slider.a@40deg"], ["slider.mass", "crank.length"], 1e-5);
    }
}

/// Each neighbour has dead centres of its own.
#[test]
fn a_quantity_at_a_dead_centre_has_its_derivative_there() {
    let mut file = Scenario::find("ideal").expect("a shipped scene").file;
    file.scene.guide.offset = 0.1 * file.scene.rod.length;
    let dimensions = ["crank.length", "rod.length", "guide.offset", "slider.centre.y"];
    file.scene.crank.angle_start = 2.8;
    assert_differences(&file, &["crank.angle@tdc", "slider.a@tdc", "joint.C.force.x@tdc"], dimensions, 1e-5);
    file.scene.crank.angle_start = -0.3;
    let found =
        assert_differences(&file, &["crank.angle@bdc", "slider.a@bdc", "joint.T.force.y@bdc"], dimensions, 1e-5);
    let slopes = found.rows[0].slopes.as_ref().expect("slopes");
    // sin θ is the offset over the length of crank and rod in line.
    let (crank, rod, offset) = (file.scene.crank.length, file.scene.rod.length, file.scene.guide.offset);
    let straight = ((rod + crank).powi(2) - offset.powi(2)).sqrt();
    let exact = [-offset / (rod + crank), -offset / (rod + crank), 1.0, -1.0].map(|rise| rise / straight);
    for (slope, exact) in slopes.iter().zip(exact) {
        assert!((slope - exact).abs() < 1e-12 * exact.abs(), "{slopes:?} {exact}");
    }
}

/// Turns are counted from where the crank starts.
#[test]
fn where_turns_are_counted_the_end_of_the_window_moves_with_the_start() {
    let file = Scenario::find("ideal").expect("a shipped scene").file;
    let experiment = Experiment { file: &file, turns: 0.2, transient: 0.0, counted: true };
    let wanted = ["slider.x", "crank.angle"].map(|text| text.parse().expect("a quantity"));
    let parameter = parameters("crank.angle_start").expect("a parameter")[0];
    let found = experiment.run(&wanted, &[parameter]).expect("a run");
    let differences = differences(&experiment, &wanted, parameter).expect("neighbours");
    for (row, difference) in found.rows.iter().zip(differences) {
        let slope = row.slopes.as_ref().expect("slopes")[0];
        assert!((slope - difference).abs() <= 1e-6 * difference.abs(), "{}: {slope} {difference}", row.wanted.text);
    }
    assert!((found.rows[1].slopes.as_ref().expect("slopes")[0] - 1.0).abs() < 1e-12);
}

#[test]
fn neighbours_of_another_speed_run_as_long() {
    let file = Scenario::find("ideal").expect("a shipped scene").file;
    let found = assert_differences(&file, &["slider.x", "slider.v"], ["crank.speed_start", "slider.mass"], 1e-6);
    let slopes = found.rows[0].slopes.as_ref().expect("slopes");
    // The slider's position depends on the angle alone.
    let exact = found.time / file.scene.crank.speed_start * found.rows[1].value;
    assert!((slopes[0] - exact).abs() < 1e-9 * exact.abs(), "{slopes:?} {exact}");
}

#[test]
fn the_largest_force_has_its_derivative_where_it_turns_beside_an_impact_and_in_a_corner() {
    let shipped = |name: &str| Scenario::find(name).expect("a shipped scene").file;
    // The derivative at constant time changes by its own size within 200 ns.
    assert_differences(&shipped("flexrod"), &["joint.C.force:peak"], ["crank.length", "rod.length"], 1e-4);
    // In a corner; the derivatives of either side are -5.8e7 and 1.6e3.
    let wanted = ["joint.C.force.x:max", "joint.T.force.y:min"];
    let found = assert_differences(&shipped("press"), &wanted, ["crank.length", "slider.mass"], 1e-3);
    let slopes = found.rows[0].slopes.as_ref().expect("slopes");
    assert!(slopes[0] > 0.0 && slopes[1] < 1e3, "{slopes:?}");
}

/// Extremes that lie on a sample, means over whole turns and dead centres, all in closed form.
#[test]
fn quantities_of_the_ideal_mechanism_are_exact() {
    let [crank, rod] = ["crank.length", "rod.length"].map(|name| parameters(name).expect("a parameter")[0]);
    for speed in [500.0, 314.159, -523.6] {
        let mut file = Scenario::find("ideal").expect("a shipped scene").file;
        file.scene.crank.speed_start = speed;
        let (r, l) = (file.scene.crank.length, file.scene.rod.length);
        let chord = (l * l - r * r).sqrt();
        let least = [l - r, -1.0, 1.0];
        let tilt = [(r / l).asin(), 1.0 / chord, -r / (l * chord)];
        // x = r·cos θ + √(l² − r²·sin² θ): the mean of x² is l².
        let length = [l, 0.0, 1.0];
        let none = [0.0; 3];
        let cases =
            [("slider.x:min", least), ("rod.angle:max", tilt), ("slider.a:mean", none), ("slider.x:rms", length)];
        let wanted: Vec<Wanted> = cases.iter().map(|(text, _)| text.parse().expect("a quantity")).collect();
        let experiment = Experiment { file: &file, turns: 1.0, transient: 0.0, counted: false };
        let found = experiment.run(&wanted, &[crank, rod]).expect("a run");
        for (row, (text, exact)) in found.rows.iter().zip(cases) {
            let slopes = row.slopes.as_ref().expect("no events");
            for (found, exact) in [row.value, slopes[0], slopes[1]].into_iter().zip(exact) {
                assert!((found - exact).abs() < 1e-7 * exact.abs().max(1.0), "{speed}, {text}: {found}, not {exact}");
            }
        }
    }
    let mut file = Scenario::find("ideal").expect("a shipped scene").file;
    (file.scene.slider.centre.y, file.scene.guide.offset) = (0.02, 0.005);
    let wanted = ["slider.v@bdc", "slider.v@tdc"].map(|text| text.parse().expect("a quantity"));
    let experiment = Experiment { file: &file, turns: 1.0, transient: 0.0, counted: false };
    let speeds = experiment.values(&wanted).expect("a run");
    assert!(speeds.iter().all(|speed| speed.abs() < 1e-9), "{speeds:?}");
}

#[test]
fn lengths_many_times_a_clearance_have_exact_derivatives() {
    let mut file = wornpin(20e-6);
    // What a length does to the start and what it does to the forces cancel but for 3e-4 of either.
    file.scene.solver.tolerance = 1e-11;
    assert_differences(&file, &["slider.x", "slider.v"], ["rod.length", "crank.length"], 1e-4);
}

#[test]
fn what_is_no_quantity_is_refused_by_name() {
    for (text, part) in [
        ("slider.q", "slider.q"),
        ("joint.C.force.peak", "tells of an interval"),
        ("slider.x@noon", "noon"),
        ("slider.x:most", "most"),
        ("joint.C.contact", "joint.C.contact"),
    ] {
        let refusal = format!("{:#}", text.parse::<Wanted>().expect_err("a refusal"));
        assert!(refusal.contains(part), "{refusal}");
    }
    assert!(parameters("joint.*.clearance").expect("four").len() == 4);
    assert!(parameters("joint.*.clearence").is_err() && parameters("solver.method").is_err());
}

/// A contact that remembers nothing keeps its damping from one touch to the next, and its force begins and ends at 0: events
/// leave volumes alone, and they shrink as the divergence of the rates says (J. Liouville).
#[test]
fn without_memory_the_sum_of_the_exponents_of_the_flexible_rod_is_the_mean_divergence() {
    let (sum, divergence) = volumes(100.0);
    assert!((sum / divergence - 1.0).abs() < 1e-5, "{sum} {divergence}");
    // With the approach speed in memory it is not.
    let (sum, divergence) = volumes(1e-3);
    assert!((sum / divergence - 1.0).abs() > 0.05, "{sum} {divergence}");
}

/// [1/s] Mean growth of volumes of states over two turns of `flexrod`, and the mean divergence, with this floor of the
/// approach speed [m/s].
fn volumes(speed_floor: f64) -> (f64, f64) {
    const PARTS: usize = 50;
    const SAMPLES: usize = 160;
    let mut file = Scenario::find("flexrod").expect("a shipped scene").file;
    file.scene.joint.c.contact.speed_floor = speed_floor;
    let mut machine = Machine::start(&file).expect("a machine");
    machine.advance(5.0 * machine.turn()).expect("a motion");
    let mut moving = Machine::with_tangent(&file, &all_states(&file).expect("states")).expect("a tangent");
    moving.take_over(&mut machine);
    let length = 2.0 * moving.turn() / (PARTS * SAMPLES) as f64;
    let (mut growth, mut divergence, mut time) = (0.0, 0.0, Flow::time(&moving));
    let (rows, columns) = moving.directions().expect("directions").shape();
    let mut directions = DMatrix::identity(rows, columns);
    for _ in 0..PARTS {
        moving.set_directions(&directions);
        for _ in 0..SAMPLES {
            Flow::advance(&mut moving, time + 0.5 * length).expect("a motion");
            divergence += moving.variation().divergence() * length;
            time += length;
        }
        Flow::advance(&mut moving, time).expect("a motion");
        let factors = moving.directions().expect("no grazing").qr();
        growth += factors.r().diagonal().iter().map(|length| length.abs().ln()).sum::<f64>();
        directions = factors.q();
    }
    let span = length * (PARTS * SAMPLES) as f64;
    (growth / span, divergence / span)
}
