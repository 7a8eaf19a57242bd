//! Who competes on which scene, with which ladder of tolerances or steps.

use slidercrank::scene::{DriveMode, JointModel, Scene};

/// What a competitor runs on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// C program on SUNDIALS and our equations.
    Sundials,
    /// A Python file in the environment of the peers.
    Python(&'static str),
    /// C++ program on Siconos.
    Siconos,
}

/// One method of one competitor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Program {
    /// Shown.
    pub peer: &'static str,
    /// Shown.
    pub method: &'static str,
    /// How it is run.
    pub kind: Kind,
    /// Its own name for the method.
    pub word: &'static str,
    /// From loose to tight.
    pub ladder: &'static [f64],
    /// Its model is not ours: its error is taken against its own finest run.
    pub own_model: bool,
    /// Where it differs.
    pub note: Option<&'static str>,
}

const TOLERANCES: &[f64] = &[1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10];
const FEWER: &[f64] = &[1e-2, 1e-4, 1e-6, 1e-8, 1e-10];

const fn sundials(method: &'static str, word: &'static str) -> Program {
    let (peer, kind, ladder) = ("SUNDIALS", Kind::Sundials, TOLERANCES);
    Program { peer, method, kind, word, ladder, own_model: false, note: Some("our equations, through C") }
}

const fn scipy(word: &'static str) -> Program {
    let (peer, kind, ladder) = ("SciPy", Kind::Python("wornpin.py"), FEWER);
    Program { peer, method: word, kind, word, ladder, own_model: false, note: Some("equations of its own in numba") }
}

const SUNDIALS: [Program; 5] = [
    sundials("CVODE Adams", "adams"),
    sundials("CVODE BDF", "bdf"),
    sundials("ARKODE order 4", "erk4"),
    sundials("ARKODE order 5", "erk5"),
    sundials("ARKODE order 8", "erk8"),
];

const SCIPY: [Program; 3] = [scipy("DOP853"), scipy("LSODA"), scipy("Radau")];

/// The competitors that know the scene.
pub fn of(scene: &Scene) -> Vec<&'static Program> {
    let joint = &scene.joint;
    let clear =
        [joint.a.model, joint.b.model, joint.c.model, joint.t.model].map(|model| model == JointModel::Clearance);
    let speed = scene.drive.mode == DriveMode::Speed;
    let mut all: Vec<&Program> = SUNDIALS.iter().collect();
    if clear == [false, false, true, false] && speed {
        all.extend(&SCIPY);
    }
    all
}
