//! What may be claimed of a case, and how each claim is put to the test.

use crate::law::Play;
use crate::run::{Trace, not_finite, run};
use crate::statistics;
use slidercrank::model::bristles::bristled_contacts;
use slidercrank::model::signals::Outputs;
use slidercrank::scene::read::SceneFile;

/// What must hold of a case.
pub enum Holds {
    /// The energy balance closes, and nothing lost comes back, within this share of the energy turned over.
    Energy(f64),
    /// No joint is pressed in deeper than this many times what its law needs for the greatest force.
    Depth(f64),
    /// It takes no more evaluations of the equations of motion.
    Work(i32),
    /// It moves no faster than this [m/s], and the crank no faster than this [rad/s], in the second half.
    Rests(f64),
    /// It ends before its time, by an error that says this.
    Ends(&'static str),
    /// Means, effective values and peaks agree between two methods at two tolerances each.
    Statistics,
    /// What only this case can claim.
    Also(fn(&SceneFile, &Trace)),
}

/// Runs a case and tests what must hold of it. That every output is a number at every communication point always must.
pub fn check(name: &str, claims: &[Holds]) {
    let file = crate::run::case(name);
    let trace = run(&file);
    let o = trace.last();
    println!("{name}: {} evaluations, {} events", o.solver.evaluations, o.solver.events);
    for (time, outputs) in trace.times.iter().zip(&trace.outputs) {
        assert_eq!(not_finite(outputs), None, "{name}: at {time} s");
    }
    let early_end = claims.iter().any(|claim| matches!(claim, Holds::Ends(_)));
    assert!(early_end || trace.failure.is_none(), "{name}: {:?}", trace.failure);
    for claim in claims {
        match *claim {
            Holds::Energy(share) => energy(name, &file, &trace, share),
            Holds::Depth(times) => depth(name, &file, &trace, times),
            Holds::Work(most) => {
                assert!(o.solver.evaluations <= most, "{name}: {} evaluations", o.solver.evaluations);
            }
            Holds::Rests(speed) => {
                let fastest = |o: &Outputs| o.slider.v.abs().max(o.crank.speed.abs());
                let found = trace.second_half().iter().map(fastest).fold(0.0, f64::max);
                assert!(found <= speed, "{name}: {found:e}");
            }
            Holds::Ends(why) => {
                let failure = trace.failure.as_deref().expect("an end before its time");
                assert!(failure.contains(why), "{name}: {failure}");
            }
            Holds::Statistics => statistics::agree(name, &file),
            Holds::Also(claim) => claim(&file, &trace),
        }
    }
}

/// The balance of a run with an audit. Bristles may give back what they store, so their losses may fall.
fn energy(name: &str, file: &SceneFile, trace: &Trace, share: f64) {
    assert!(file.scene.energy.audit, "{name}: no audit");
    let most = |of: fn(&Outputs) -> f64| trace.greatest(of);
    let heights = trace.outputs.iter().map(|o| o.energy.gravity);
    let gravity = heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), e| (low.min(e), high.max(e)));
    let turned_over = most(|o| o.energy.torque_work)
        + most(|o| o.energy.load_work)
        + most(|o| o.energy.kinetic)
        + most(|o| o.energy.elastic)
        + most(|o| o.energy.contact)
        + gravity.1
        - gravity.0;
    let residual = most(|o| o.energy.residual);
    println!("{name}: residual {residual:.1e} J of {turned_over:.1e} J");
    assert!(residual <= share * turned_over, "{name}: {residual:e} J of {turned_over:e} J");
    let bristles = !bristled_contacts(&file.scene).is_empty();
    let losses: [fn(&Outputs) -> f64; 4] =
        [|o| o.energy.contact_loss, |o| o.energy.viscous_loss, |o| o.energy.modal_loss, |o| o.energy.friction_loss];
    for loss in &losses[..if bristles { 3 } else { 4 }] {
        let mut most = 0.0;
        for (time, outputs) in trace.times.iter().zip(&trace.outputs) {
            most = f64::max(most, loss(outputs));
            let back = most - loss(outputs);
            assert!(back <= share * turned_over, "{name}: {back:e} J of losses came back by {time} s");
        }
    }
}

/// No joint deeper than its law needs.
fn depth(name: &str, file: &SceneFile, trace: &Trace, times: f64) {
    for play in Play::of(&file.scene) {
        let force = trace.greatest(|o| play.force(o));
        let allowed = times * play.depth_of(force);
        let deepest = trace.outputs.iter().map(|o| play.depth(o)).fold(f64::NEG_INFINITY, f64::max);
        println!("{name}, {}: {deepest:.1e} m at {force:.1e} N, law {:.1e} m", play.letter, play.depth_of(force));
        assert!(deepest <= allowed, "{name}, {}: {deepest:e} m, {allowed:e} m allowed", play.letter);
    }
}
