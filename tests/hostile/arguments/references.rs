//! Value references, and the values that go with them.

use super::numbers::NOT_FINITE;
use super::{Argument, array, bad, count, good};
use crate::importers_memory::ImportersMemory;
use crate::invoke::NULL;
use crate::stage::Stage;
use host::vr;
use slidercrank::fmi::slave::variables::VARIABLES;
use slidercrank::fmi::v2::lifecycle::Call::{self, *};
use slidercrank::fmi::v2::lifecycle::{State, Touch};

/// A function that takes value references, and the instance to call it on.
pub struct References<'a> {
    call: Call,
    stage: &'a Stage,
}

/// Two references by name: sound ones, then others, then unknown ones. An empty word stands for no fault.
pub fn pair(
    memory: &ImportersMemory,
    argument: &str,
    sound: [&str; 2],
    others: &[([&str; 2], &str)],
    unknown: &[u32],
) -> Argument {
    let references = |names: [&str; 2]| names.map(vr).to_vec();
    let mut list = array(memory, argument, references(sound), vec![]);
    for (names, words) in others {
        let word = memory.array(references(*names));
        list.values.push(if words.is_empty() { good(word) } else { bad(word, *words) });
    }
    for &unknown in unknown {
        for references in [[unknown, vr(sound[1])], [vr(sound[0]), unknown]] {
            list.values.push(bad(memory.array(references.to_vec()), format!("value reference {unknown}")));
        }
    }
    list
}

impl<'a> References<'a> {
    pub fn of(call: Call, stage: &'a Stage) -> Self {
        Self { call, stage }
    }

    fn list(&self, argument: &str, sound: [&str; 2], others: &[([&str; 2], &str)]) -> Argument {
        let length = u32::try_from(VARIABLES.len()).expect("few variables");
        pair(&self.stage.memory, argument, sound, others, &[length, u32::MAX])
    }

    /// `words` unless variables may be touched so in the stage's state.
    fn unless(&self, touch: Touch, words: &'static str) -> &'static str {
        if touch.allowed(self.stage.state) { "" } else { words }
    }

    pub fn read(&self) -> Vec<Argument> {
        let output = |words| self.unless(Touch::GetOutput, words);
        let seen = Touch::GetOutput.allowed(self.stage.state);
        let (references, values) = match self.call {
            GetReal => {
                let others = [
                    (["gravity", "slider.x"], output("slider.x (output) cannot be read")),
                    (["slider.a", "slider.load"], output("slider.a (output) cannot be read")),
                    // An output that could be told comes before what cannot be.
                    (["slider.a", "solver.steps"], if seen { "solver.steps is of type" } else { "slider.a (output)" }),
                    (["gravity", "solver.steps"], "solver.steps is of type Integer, not Real"),
                    (["joint.C.contact", "gravity"], "joint.C.contact is of type Boolean, not Real"),
                    (["gravity", "drive.mode"], "drive.mode is of type Enumeration, not Real"),
                ];
                let values = array(&self.stage.memory, "value", vec![0.0; 2], vec![]);
                (self.list("vr", ["gravity", "crank.torque"], &others), values)
            }
            GetInteger => {
                let others = [
                    (["drive.mode", "solver.steps"], output("solver.steps (output) cannot be read")),
                    (["drive.mode", "slider.x"], "slider.x is of type Real, not Integer"),
                    (["energy.audit", "drive.mode"], "energy.audit is of type Boolean, not Integer"),
                ];
                let values = array(&self.stage.memory, "value", vec![0_i32; 2], vec![]);
                (self.list("vr", ["drive.mode", "rod.flexible.bending_modes"], &others), values)
            }
            GetBoolean => {
                let others = [
                    (["energy.audit", "joint.C.contact"], output("joint.C.contact (output) cannot be read")),
                    (["energy.audit", "slider.load"], "slider.load is of type Real, not Boolean"),
                    (["drive.mode", "energy.audit"], "drive.mode is of type Enumeration, not Boolean"),
                ];
                let values = array(&self.stage.memory, "value", vec![0_i32; 2], vec![]);
                (self.list("vr", ["energy.audit", "rod.flexible.geometric_stiffness"], &others), values)
            }
            _ => return self.text(),
        };
        vec![references.counted_by(2), count(2), values.counted_by(2)]
    }

    pub fn write(&self) -> Vec<Argument> {
        let parameter = |words| self.unless(Touch::SetParameter, words);
        let (references, values) = match self.call {
            SetReal => {
                let others = [
                    (["slider.load", "gravity"], parameter("gravity (fixed parameter) cannot be set")),
                    (["slider.load", "slider.x"], "slider.x (output) cannot be set"),
                    (["slider.load", "drive.mode"], "drive.mode is of type Enumeration, not Real"),
                    (["energy.audit", "slider.load"], "energy.audit is of type Boolean, not Real"),
                    (["slider.load", "joint.T.contacts"], "joint.T.contacts is of type Integer, not Real"),
                ];
                let references = self.list("vr", ["slider.load", "crank.torque"], &others);
                let faulty = NOT_FINITE.map(|number| (vec![1.0, number], "is not a finite number"));
                let mut values = array(&self.stage.memory, "value", vec![1.0, 2.0], faulty.to_vec());
                for extreme in [f64::MAX, f64::MIN, 5e-324] {
                    values.values.push(good(self.stage.memory.array(vec![extreme, 2.0])));
                }
                (references, values)
            }
            SetInteger => {
                let others = [
                    (["drive.mode", "solver.steps"], "solver.steps (output) cannot be set"),
                    (["drive.mode", "slider.load"], "slider.load is of type Real, not Integer"),
                    (["energy.audit", "drive.mode"], "energy.audit is of type Boolean, not Integer"),
                ];
                let references = self.list("vr", ["drive.mode", "rod.flexible.bending_modes"], &others);
                let faulty = [[0, 1], [3, 1], [i32::MIN, 1], [i32::MAX, 1], [2, -1], [2, 9], [2, i32::MAX]];
                let faulty = faulty.map(|numbers| (numbers.to_vec(), "is out of range; allowed: "));
                let values = array(&self.stage.memory, "value", vec![2_i32, 1], faulty.to_vec());
                (self.settable(references, "drive.mode (fixed parameter) cannot be set"), values)
            }
            SetBoolean => {
                let others = [
                    (["energy.audit", "joint.C.contact"], "joint.C.contact (output) cannot be set"),
                    (["energy.audit", "slider.load"], "slider.load is of type Real, not Boolean"),
                    (["drive.mode", "energy.audit"], "drive.mode is of type Enumeration, not Boolean"),
                ];
                let references = self.list("vr", ["energy.audit", "rod.flexible.geometric_stiffness"], &others);
                let mut values = array(&self.stage.memory, "value", vec![1_i32, 0], vec![]);
                for any in [-1, i32::MIN, i32::MAX] {
                    values.values.push(good(self.stage.memory.array(vec![any, any])));
                }
                (self.settable(references, "energy.audit (fixed parameter) cannot be set"), values)
            }
            _ => return self.text(),
        };
        vec![references.counted_by(2), count(2), values.counted_by(2)]
    }

    /// Refused in any case where the first variable cannot be touched so.
    fn settable(&self, references: Argument, words: &str) -> Argument {
        if Touch::SetParameter.allowed(self.stage.state) { references } else { references.refused_as(words) }
    }

    /// Of functions for strings, of which there are none; so their values are never looked at.
    fn text(&self) -> Vec<Argument> {
        let references = self.list("vr", ["slider.x", "slider.load"], &[]);
        let references = references.refused_as("slider.x is of type Real, not String");
        let values = vec![good(self.stage.memory.array(vec![0_usize; 2])), good(NULL)];
        vec![references.counted_by(2), count(2), values.into()]
    }

    pub fn derivatives(&self) -> Vec<Argument> {
        let (references, values) = if self.call == SetRealInputDerivatives {
            let others = [
                (["slider.load", "slider.x"], "slider.x is not a real input"),
                (["rod.length", "slider.load"], "rod.length is not a real input"),
                (["slider.load", "solver.steps"], "solver.steps is not a real input"),
            ];
            let faulty = NOT_FINITE.map(|number| (vec![number, 1.0], "is not a finite number"));
            let mut values = array(&self.stage.memory, "value", vec![1.0, 2.0], faulty.to_vec());
            values.values.push(good(self.stage.memory.array(vec![f64::MAX, f64::MIN])));
            (self.list("vr", ["slider.load", "crank.torque"], &others), values)
        } else {
            let others = [
                (["slider.x", "slider.load"], "slider.load is not a real output"),
                (["rod.length", "slider.x"], "rod.length is not a real output"),
                (["slider.x", "solver.steps"], "solver.steps is not a real output"),
                (["joint.C.contact", "slider.x"], "joint.C.contact is not a real output"),
            ];
            let values = array(&self.stage.memory, "value", vec![0.0; 2], vec![]);
            (self.list("vr", ["slider.x", "crank.angle"], &others), values)
        };
        let faulty = [0, 2, -1, i32::MIN, i32::MAX].map(|order| (vec![1, order], "only order 1 is known"));
        let orders = array(&self.stage.memory, "order", vec![1_i32, 1], faulty.to_vec());
        vec![references.counted_by(2), count(2), orders.counted_by(2), values.counted_by(2)]
    }

    pub fn sensitivity(&self) -> Vec<Argument> {
        let outputs = [
            (["slider.x", "slider.load"], "slider.load is not a real output"),
            (["rod.length", "slider.x"], "rod.length is not a real output"),
            (["slider.x", "solver.steps"], "solver.steps is not a real output"),
        ];
        let starts = self.stage.state == State::InitializationMode;
        let inputs = [
            (["slider.load", "slider.x"], "slider.x is not a real input"),
            (["rod.length", "slider.load"], if starts { "" } else { "rod.length is not a real input" }),
            (["slider.load", "drive.mode"], "drive.mode is not a real input"),
            (["slider.load", "joint.C.contact"], "joint.C.contact is not a real input"),
            // Named twice it counts twice.
            (["slider.load", "slider.load"], ""),
        ];
        let unknown = self.list("vUnknown_ref", ["slider.x", "slider.a"], &outputs);
        let known = self.list("vKnown_ref", ["slider.load", "crank.torque"], &inputs);
        let faulty = NOT_FINITE.map(|number| (vec![1.0, number], "is not a finite number"));
        let seeds = array(&self.stage.memory, "dvKnown", vec![1.0, 2.0], faulty.to_vec());
        let answers = array(&self.stage.memory, "dvUnknown", vec![0.0; 2], vec![]);
        vec![unknown.counted_by(2), count(2), known.counted_by(4), count(2), seeds.counted_by(4), answers.counted_by(2)]
    }
}
