//! Hosts that do anything allowed in any order, by chance: what a run came to is what its own history leads to.

use crate::face::{Face, Handle};
use crate::scenes::{MECHANISMS, hosted};
use crate::{brief, tried};
use host::vr;
use proptest::prelude::*;
use proptest::test_runner::{Config, RngSeed, TestRunner};
use slidercrank::fmi::v2::Status;

/// What a host does.
#[derive(Clone, Debug)]
enum Act {
    Set(&'static str, f64),
    Slope(&'static str, f64),
    /// Of this length [s].
    Step(f64),
    /// Reads everything there is.
    Look,
    Sensitivity,
    Save,
    /// Goes back to one of the saved states.
    Back(prop::sample::Index),
    /// Goes on in another instance, from bytes.
    Carry,
    /// Does what is refused.
    Blunder,
    /// Tries a step that cannot be done, and takes it back.
    Overload,
}

fn act() -> impl Strategy<Value = Act> {
    let input = || prop::sample::select(&["slider.load", "crank.torque"][..]);
    prop_oneof![
        3 => (input(), -50.0..50.0).prop_map(|(name, value)| Act::Set(name, value)),
        2 => (input(), -1e4..1e4).prop_map(|(name, value)| Act::Slope(name, value)),
        8 => (-9.0..-3.5).prop_map(|power| Act::Step(10f64.powf(power))),
        2 => Just(Act::Look),
        1 => Just(Act::Sensitivity),
        2 => Just(Act::Save),
        3 => any::<prop::sample::Index>().prop_map(Act::Back),
        1 => Just(Act::Carry),
        1 => Just(Act::Blunder),
        1 => Just(Act::Overload),
    ]
}

/// A run, with all that was done to it and not taken back.
struct Run<F> {
    slave: F,
    here: Place,
    history: Vec<Act>,
    saved: Vec<(Handle, Place)>,
}

/// Where a run is.
#[derive(Clone, Copy)]
struct Place {
    /// [s] Communication point.
    point: f64,
    /// How much of the history led here.
    history: usize,
    /// Inputs were set here that nobody has seen the effect of.
    unseen: bool,
}

impl<F: Face> Run<F> {
    fn new(mechanism: usize) -> Self {
        let here = Place { point: 0.0, history: 0, unseen: false };
        Self { slave: MECHANISMS[mechanism].running(), here, history: vec![], saved: vec![] }
    }

    fn act(&mut self, act: &Act) {
        let slave = &self.slave;
        match act {
            Act::Set(name, value) => assert_eq!(slave.set(name, *value), Status::Ok),
            Act::Slope(name, value) => assert_eq!(slave.set_slope(name, *value).unwrap_or(Status::Ok), Status::Ok),
            Act::Step(size) => self.here.point = slave.steps(self.here.point, *size, 1),
            Act::Look => drop(slave.everything()),
            Act::Sensitivity => {
                slave.sensitivity(vr("slider.a"), &[vr("slider.load")], &[1.0]).expect("an answer");
            }
            Act::Save => self.saved.push((slave.save(), self.here)),
            Act::Back(index) => self.back(index),
            Act::Carry => self.carry(),
            Act::Blunder => blunder(slave, self.here.point),
            Act::Overload => overload(slave, self.here.point),
        }
        // Who looks after setting an input makes the integrator end its step here; any other look leaves no trace.
        let counts = match act {
            Act::Set(..) | Act::Slope(..) | Act::Step(_) => true,
            Act::Look | Act::Sensitivity => self.here.unseen,
            _ => return,
        };
        self.here.unseen = matches!(act, Act::Set(..) | Act::Slope(..));
        if counts {
            self.history.push(act.clone());
            self.here.history += 1;
        }
    }

    /// To a saved state; those of the future that is taken back are freed.
    fn back(&mut self, index: &prop::sample::Index) {
        if self.saved.is_empty() {
            return;
        }
        let (state, place) = self.saved[index.index(self.saved.len())];
        assert_eq!(self.slave.restore(state), Status::Ok);
        self.here = place;
        self.history.truncate(place.history);
        for (mut state, _) in self.saved.extract_if(.., |(_, saved)| saved.history > place.history) {
            assert_eq!(self.slave.forget(&mut state), Status::Ok);
        }
    }

    /// To another instance, which knows none of the old one's saved states.
    fn carry(&mut self) {
        let other = F::new();
        let state = other.deserialize(&self.slave.memory()).expect("sound bytes");
        assert_eq!(other.restore(state), Status::Ok);
        self.saved.clear();
        self.slave = other;
    }
}

/// Refused calls of several kinds.
fn blunder(slave: &impl Face, point: f64) {
    for (number, status) in slave.blunders(point).into_iter().enumerate() {
        assert_eq!(status, Status::Error, "{number}: {:?}", slave.lines());
    }
    slave.lines();
}

/// A step under loads that overflow where they are divided by a mass, and back.
fn overload<F: Face>(slave: &F, point: f64) {
    let mut before = slave.save();
    assert_eq!((slave.set("slider.load", 1.7e308), slave.set("crank.torque", -1.7e308)), (Status::Ok, Status::Ok));
    // A mechanism at a prescribed speed has nothing that they could move.
    let status = slave.step(point, 1e-4 * F::pace());
    assert!([F::FAILED, Status::Discard, Status::Ok].contains(&status), "{status:?} {:?}", slave.lines());
    assert_eq!((slave.restore(before), slave.forget(&mut before)), (Status::Ok, Status::Ok));
    slave.lines();
}

fn a_run_with_any_detours_is_the_run_without_them_to_the_bit<F: Face>() {
    let cases = if brief() { 3 } else { tried(2_000 / F::ONE_IN as u32) };
    let config = Config { cases, rng_seed: RngSeed::Fixed(0x5EED), failure_persistence: None, ..Config::default() };
    let hosts = (prop::sample::select(hosted::<F>()), prop::collection::vec(act(), 1..60));
    let outcome = TestRunner::new(config).run(&hosts, |(mechanism, acts)| {
        let (mut run, mut straight) = (Run::<F>::new(mechanism), Run::<F>::new(mechanism));
        acts.iter().for_each(|act| run.act(act));
        run.history.iter().for_each(|act| straight.act(act));
        prop_assert_eq!(run.slave.everything(), straight.slave.everything());
        prop_assert!(run.slave.memory() == straight.slave.memory(), "other bytes");
        Ok(())
    });
    outcome.unwrap_or_else(|failure| panic!("{failure}"));
}

on_each_face! {
    a_run_with_any_detours_is_the_run_without_them_to_the_bit
}
