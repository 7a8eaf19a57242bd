//! The programs for each scene, with their tolerances or step sizes.

use slidercrank::model::rod::Rod;
use slidercrank::scene::{
    Contact, DampingLaw, DriveMode, Elasticity, FrictionLaw, JointModel, Lubrication, Scene, Surface,
};
use std::f64::consts::FRAC_PI_2;

/// The kind of a program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A C program with SUNDIALS and our equations.
    Sundials,
    /// A Python file in the environment of the peers.
    Python(&'static str),
    /// A C++ program with Siconos.
    Siconos,
}

/// One method of one program.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Program {
    /// Name of the program in tables.
    pub peer: &'static str,
    /// Name of the method in tables.
    pub method: &'static str,
    /// How the program is run.
    pub kind: Kind,
    /// The program's own name for the method.
    pub word: &'static str,
    /// Tolerances, or steps [s] of a method with fixed steps, from loose to tight.
    pub ladder: &'static [f64],
    /// Whether its contacts are rigid.
    pub rigid: bool,
    /// Differences of its model.
    pub note: Option<&'static str>,
}

const TOLERANCES: &[f64] = &[1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10];
const FEWER: &[f64] = &[1e-2, 1e-4, 1e-6, 1e-8, 1e-10];

const fn sundials(method: &'static str, word: &'static str) -> Program {
    let (peer, kind, ladder) = ("SUNDIALS", Kind::Sundials, TOLERANCES);
    Program { peer, method, kind, word, ladder, rigid: false, note: Some("our equations, through C") }
}

const fn scipy(word: &'static str) -> Program {
    let (peer, kind, ladder) = ("SciPy", Kind::Python("wornpin.py"), FEWER);
    Program {
        peer,
        method: word,
        kind,
        word,
        ladder,
        rigid: false,
        note: Some("own equations in numba; steps of at most 10 µs, since longer ones miss short flights"),
    }
}

const SUNDIALS: [Program; 5] = [
    sundials("CVODE Adams", "adams"),
    sundials("CVODE BDF", "bdf"),
    sundials("ARKODE order 4", "erk4"),
    sundials("ARKODE order 5", "erk5"),
    sundials("ARKODE order 8", "erk8"),
];

const SCIPY: [Program; 3] = [scipy("DOP853"), scipy("LSODA"), scipy("Radau")];

const fn exudyn(method: &'static str, word: &'static str) -> Program {
    let (peer, kind) = ("Exudyn", Kind::Python("exudyn_journal.py"));
    let ladder = &[1e-5, 5e-6, 2e-6, 1e-6, 5e-7, 2e-7];
    let note = Some("a sphere in a hollow sphere; fixed steps");
    Program { peer, method, kind, word, ladder, rigid: false, note }
}

const EXUDYN: [Program; 2] =
    [exudyn("RK44, touches located", "RK44"), exudyn("generalized-alpha", "generalized-alpha")];

const fn mujoco(method: &'static str, word: &'static str) -> Program {
    let (peer, kind, ladder) = ("MuJoCo", Kind::Python("mujoco_ideal.py"), &[1e-3, 5e-4, 2e-4, 1e-4, 5e-5, 2e-5, 1e-5]);
    let note = Some("loop closed by a soft constraint; fixed steps");
    Program { peer, method, kind, word, ladder, rigid: false, note }
}

const MUJOCO: [Program; 2] = [mujoco("RK4", "RK4"), mujoco("implicit", "implicit")];

const fn heyoka(method: &'static str, word: &'static str, note: &'static str) -> Program {
    let (peer, kind) = ("heyoka", Kind::Python("heyoka_mechanism.py"));
    let ladder = &[1e-2, 1e-4, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12, 1e-14];
    Program { peer, method, kind, word, ladder, rigid: false, note: Some(note) }
}

const HEYOKA: [Program; 2] = [
    heyoka("compiled part", "compiled", "equations of its own; without Python between events, without compilation"),
    heyoka("whole", "whole", "equations of its own; events handled in Python, without compilation"),
];

const fn diffsol(method: &'static str, word: &'static str, note: &'static str) -> Program {
    let (peer, kind, ladder) = ("diffsol", Kind::Python("diffsol_mechanism.py"), TOLERANCES);
    Program { peer, method, kind, word, ladder, rigid: false, note: Some(note) }
}

const DIFFSOL: [Program; 3] = [
    diffsol(
        "Tsitouras 5(4)",
        "tsit45",
        "equations as for heyoka; without Python between events, without compilation; steps counted",
    ),
    diffsol(
        "Tsitouras, whole",
        "tsit45-whole",
        "equations as for heyoka; events handled in Python, without compilation; steps counted",
    ),
    diffsol("BDF", "bdf", "as Tsitouras 5(4)"),
];

const SICONOS: Program = Program {
    peer: "Siconos",
    method: "Moreau-Jean",
    kind: Kind::Siconos,
    word: "moreau",
    ladder: &[1e-4, 5e-5, 2e-5, 1e-5, 5e-6, 2e-6, 1e-6, 5e-7],
    rigid: true,
    note: Some("rigid impacts; fixed steps"),
};

/// The programs that support the scene.
pub fn of(scene: &Scene) -> Vec<&'static Program> {
    let joint = &scene.joint;
    let clear =
        [joint.a.model, joint.b.model, joint.c.model, joint.t.model].map(|model| model == JointModel::Clearance);
    let speed = scene.drive.mode == DriveMode::Speed;
    let mut all: Vec<&Program> = SUNDIALS.iter().collect();
    if Rod::new(scene).is_some() {
        return all;
    }
    if expressions_know(scene, clear, speed) {
        all.extend(HEYOKA.iter().chain(&DIFFSOL));
    }
    // The others know gravity across the guide alone.
    if (scene.gravity != 0.0 && scene.gravity_angle != -FRAC_PI_2) || is_unusual(scene) {
        return all;
    }
    if clear == [false, false, true, false] && speed {
        all.extend(&SCIPY);
        all.extend(&EXUDYN);
    }
    if clear == [false; 4] && !speed {
        all.extend(&MUJOCO);
    }
    if clear == [false, false, false, true] && !speed {
        all.push(&SICONOS);
    }
    all
}

/// Whether the scene has oil, or a load beside the pin, which no program knows.
fn is_unusual(scene: &Scene) -> bool {
    let joint = &scene.joint;
    let oil = [&joint.a, &joint.b, &joint.c].map(|joint| joint.lubrication != Lubrication::None);
    scene.slider.load_offset != 0.0 || oil.contains(&true)
}

/// Whether the expressions of the programs on heyoka and diffsol have the laws of all contacts, and there is something to
/// integrate.
fn expressions_know(scene: &Scene, clear: [bool; 4], speed: bool) -> bool {
    let joint = &scene.joint;
    let contacts = [&joint.a.contact, &joint.b.contact, &joint.c.contact, &joint.t.contact];
    let law = |(contact, _): (&Contact, bool)| {
        let friction = [FrictionLaw::None, FrictionLaw::Ambrosio].contains(&contact.friction.law);
        friction && contact.law != DampingLaw::ZhangSharf
    };
    let shapes = [joint.a.elasticity, joint.b.elasticity, joint.c.elasticity].map(|own| own == Elasticity::Hertz);
    let shapes = shapes.into_iter().chain([joint.t.surface == Surface::Corner]);
    let known = clear.into_iter().zip(shapes).all(|(clear, shape)| shape || !clear);
    known
        && !is_unusual(scene)
        && contacts.into_iter().zip(clear).filter(|(_, clear)| *clear).all(law)
        && !(speed && clear == [false; 4])
}
