//! What single cases claim beside what all may.

use crate::run::{Trace, inputs, run, start, with};
use slidercrank::model::signals::{Inputs, Outputs};
use slidercrank::scene::read::SceneFile;
use slidercrank::scene::{FrictionLaw, Scene};
use std::f64::consts::{PI, TAU};

/// Contacts neither open nor close in the second half, and the work done there is below a tenth of the whole.
pub fn calms_down(_: &SceneFile, trace: &Trace) {
    let (half, end) = (&trace.second_half()[0].solver, &trace.last().solver);
    assert_eq!(half.events, end.events);
    assert!(half.events <= 40, "{} events", half.events);
}

/// Nothing moves, to the bit.
pub fn stands(_: &SceneFile, trace: &Trace) {
    for outputs in &trace.outputs {
        let moving = [outputs.crank.angle, outputs.crank.speed, outputs.slider.v, outputs.rod.angle, outputs.rod.speed];
        assert_eq!(moving, [0.0; 5]);
    }
}

/// Rounding has the first word, as small as it is, and the load the last.
pub fn stands_and_falls(_: &SceneFile, trace: &Trace) {
    let at = |time: f64| &trace.outputs[trace.times.partition_point(|t| *t < time)];
    assert!((at(0.01).crank.angle - PI).abs() < 1e-9, "{}", at(0.01).crank.angle);
    assert!(trace.greatest(|o| o.crank.speed) > 100.0);
}

/// The journal stays on its bearing's wall and goes round as often as the crank does.
pub fn rolls_round(file: &SceneFile, trace: &Trace) {
    let place = |o: &Outputs| o.joint_a.eccentricity;
    let mut turned = 0.0;
    for pair in trace.outputs.windows(2) {
        let ([x0, y0], [x1, y1]) = (place(&pair[0]), place(&pair[1]));
        turned += (x0 * y1 - y0 * x1).atan2(x0 * x1 + y0 * y1);
        assert!(pair[1].joint_a.contact && pair[1].joint_a.penetration > 0.0);
    }
    let wanted = trace.last().crank.angle - file.scene.crank.angle_start;
    assert!((wanted - 1000.0 * TAU).abs() < 1e-6);
    // It starts on the side that the unbalance points to, and follows it with a lag that friction makes.
    assert!((turned - wanted).abs() < 0.5, "{turned} instead of {wanted} rad");
}

/// Opposite corners bite, and what creeps stays within the speed over which friction is smoothed.
pub fn is_jammed(file: &SceneFile, trace: &Trace) {
    let friction = &file.scene.joint.t.contact.friction;
    for outputs in trace.second_half() {
        assert_eq!(outputs.joint_t.contacts, 2);
        // Two corners on one side could not resist by more than this; pressed against each other they do.
        let [along, across] = outputs.joint_t.force.map(f64::abs);
        assert!(along > 2.0 * friction.coefficient * across, "{along} N along, {across} N across");
        assert!(outputs.slider.v.abs() < friction.v1, "{} m/s", outputs.slider.v);
    }
}

/// What holds it bends, and does not slip.
pub fn sticks(file: &SceneFile, trace: &Trace) {
    let friction = &file.scene.joint.t.contact.friction;
    assert_eq!(friction.law, FrictionLaw::Lugre);
    let bends = friction.static_coefficient / friction.sigma0;
    let x = |o: &Outputs| o.slider.x;
    let moved = trace.second_half().iter().map(|o| (x(o) - x(trace.last())).abs()).fold(0.0, f64::max);
    assert!(moved < 1e-3 * bends, "{moved:e} m of creep, {bends:e} m of bending");
    assert!((x(trace.last()) - x(&trace.outputs[0])).abs() < bends + file.scene.joint.t.clearance);
}

/// It goes on past the change points of ten turns.
pub fn goes_round(file: &SceneFile, trace: &Trace) {
    let turned = (trace.last().crank.angle - file.scene.crank.angle_start).abs();
    // The mean speed is below that of the start: the slider is at rest there.
    assert!(turned > 5.0 * TAU, "{turned} rad");
}

/// Under P of its Euler load a rod sags by 1/(1 − P) of what it does without, and swings about that as far again.
pub fn sags_and_swings(file: &SceneFile, trace: &Trace) {
    let flexible = &file.scene.rod.flexible;
    let (l, weight) = (file.scene.rod.length, flexible.density * flexible.area * file.scene.gravity);
    let bending = flexible.young * flexible.second_moment;
    let share = -file.inputs.slider_load.value(0.0, 0.0) * (l / PI).powi(2) / bending;
    // The sine that a uniform load bends a beam to: 4/π of the load on its first mode.
    let unloaded = 4.0 / PI * weight / bending * (l / PI).powi(4);
    let (found, wanted) = (trace.greatest(|o| o.rod.deflection), 2.0 * unloaded / (1.0 - share));
    println!("{share} of the Euler load: {found:e} m, {wanted:e} m expected");
    // Large deflections stiffen it: by (π·w/l)²/8 of the Euler load, against the 1 − P that is left of it.
    let stiffer = (PI * found / l).powi(2) / 8.0 / (1.0 - share);
    assert!((found / wanted - 1.0).abs() < 0.01 + stiffer, "{found:e} m, {wanted:e} m expected");
}

/// Long steps and short ones give the same bits.
pub fn any_step_will_do(file: &SceneFile, trace: &Trace) {
    let mut simulation = start(file);
    let end = *trace.times.last().expect("a run has a start");
    let mut points = vec![0.1 * end, 0.37 * end, 0.371 * end];
    points.extend((1..100).map(|i| end * (0.5 + 0.5 * f64::from(i) / 100.0)));
    points.push(end);
    for time in points {
        simulation.advance_to(time).expect("a motion without trouble");
    }
    // What counts from the last communication point is left out.
    let of_motion = |outputs: &Outputs| {
        let mut outputs = *outputs;
        (0..4).for_each(|joint| outputs.interval_mut(joint).impact_speed = 0.0);
        outputs.solver.error_estimate = 0.0;
        format!("{outputs:?}")
    };
    assert_eq!(of_motion(&simulation.outputs()), of_motion(trace.last()));
    assert_eq!(simulation.outputs().solver.rejected, trace.last().solver.rejected);
}

/// A start in the middle of a contact gives back its energy and not more.
pub fn lets_go(_: &SceneFile, trace: &Trace) {
    let stored = trace.outputs[0].energy.contact;
    assert!(stored > 1e3, "{stored} J");
    let released = trace.greatest(|o| o.energy.kinetic);
    assert!(released > 0.5 * stored && released < stored * (1.0 + 1e-7), "{released} J of {stored} J");
}

/// A finer tolerance tells the same motion up to the spike, and the same work of the torque in all.
pub fn has_one_spike(file: &SceneFile, trace: &Trace) {
    let finer = run(&with(file, |scene| scene.solver.tolerance = 1e-8));
    let before = trace.times.partition_point(|t| *t < 2e-3);
    let (one, other) = (&trace.outputs[before], &finer.outputs[before]);
    assert!((one.slider.x - other.slider.x).abs() < 1e-8);
    let work = |trace: &Trace| trace.last().energy.torque_work;
    assert!((work(trace) / work(&finer) - 1.0).abs() < 1e-3, "{} J, {} J", work(trace), work(&finer));
}

/// The time and the energy of an hour of free running, against the period as an integral.
pub fn keeps_time(file: &SceneFile, trace: &Trace) {
    let scene = &file.scene;
    let energy = 0.5 * reduced_inertia(scene, 0.0) * scene.crank.speed_start.powi(2);
    let slowness = |angle: f64| (reduced_inertia(scene, angle) / (2.0 * energy)).sqrt();
    // The trapezoidal rule is exact to rounding for a smooth period; Simpson's is for what is left of a turn.
    let n = 4096;
    let period = (0..n).map(|i| slowness(TAU * f64::from(i) / f64::from(n))).sum::<f64>() * TAU / f64::from(n);
    let turns = (trace.last().crank.angle / TAU).floor();
    let rest = trace.last().crank.angle - turns * TAU;
    let h = rest / f64::from(n);
    let weight = |i: i32| if i == 0 || i == n { 1.0 } else { f64::from(2 + 2 * (i % 2)) };
    let remainder = (0..=n).map(|i| weight(i) * slowness(h * f64::from(i))).sum::<f64>() * h / 3.0;
    let end = trace.times.last().expect("a run has a start");
    let slip = (turns * period + remainder - end) / end;
    let drift = trace.greatest(|o| o.energy.residual) / energy;
    println!("{turns} turns: energy off by {drift:.1e}, time by {slip:.1e}");
    // Half of an energy error is one of speed. Energy errs by the tolerance in a turn at most, here by far less.
    assert!(drift < 1e-6 && slip.abs() < 1e-6, "energy {drift:e}, time {slip:e}");
}

/// [kg·m²] Of the ideal mechanism, from its kinetic energy at unit speed.
fn reduced_inertia(scene: &Scene, angle: f64) -> f64 {
    let (r, l) = (scene.crank.length, scene.rod.length);
    let (sin, cos) = angle.sin_cos();
    let rod_sin = -r * sin / l;
    let rod_cos = (1.0 - rod_sin * rod_sin).sqrt();
    let rod_speed = -r * cos / (l * rod_cos);
    let arm = scene.rod.com.x;
    let rod_velocity = [-r * sin - arm * rod_sin * rod_speed, r * cos + arm * rod_cos * rod_speed];
    let pin_speed = -r * sin - l * rod_sin * rod_speed;
    scene.crank.inertia
        + scene.crank.mass * scene.crank.com.x.powi(2)
        + scene.rod.inertia * rod_speed * rod_speed
        + scene.rod.mass * (rod_velocity[0].powi(2) + rod_velocity[1].powi(2))
        + scene.slider.mass * pin_speed * pin_speed
}

/// Each jump ends a step, and inputs that are taken back before time goes on leave every bit of the motion alone.
pub fn jumps_count(file: &SceneFile, trace: &Trace) {
    let points = trace.times.len() as i32 - 1;
    assert!(trace.last().solver.steps >= points, "{} steps", trace.last().solver.steps);
    let mut simulation = start(file);
    for (time, outputs) in trace.times[1..].iter().zip(&trace.outputs) {
        let inputs = inputs(file, simulation.time(), outputs.crank.angle);
        let others = Inputs { slider_load: inputs.slider_load + 1e6, ..inputs };
        for inputs in [others, inputs, others, inputs] {
            simulation.set_inputs(inputs, Inputs::default());
        }
        simulation.advance_to(*time).expect("a motion without trouble");
    }
    let found = simulation.outputs();
    assert_eq!(format!("{:?}", found.slider), format!("{:?}", trace.last().slider));
}

/// No journal is beyond its bearing's wall while its contact is open. The place at the end is where six methods agree at
/// tolerances from 1e-6 to 1e-10; without the second touch it would be half as far from the wall.
pub fn touches_are_noticed(_: &SceneFile, trace: &Trace) {
    let open = trace.outputs.iter().map(|o| &o.joint_a).filter(|a| !a.contact);
    let deepest = open.map(|a| a.penetration).fold(f64::NEG_INFINITY, f64::max);
    assert!(deepest < 1e-9, "{deepest:e} m deep and open");
    let end = &trace.last().joint_a;
    assert_eq!(end.interval.impacts, 2);
    assert!((end.penetration + 103.388e-6).abs() < 2e-9, "{:e} m", end.penetration);
}
