//! Mechanisms to compare on: every combination of joints under both drives, and each effect once.

use slidercrank::model::signals::Inputs;
use slidercrank::scene::{
    Contact, DampingLaw, DriveMode, Elasticity, Friction, FrictionLaw, JointModel, Pair, Point, Scene,
};

/// A mechanism with its inputs.
#[derive(Clone)]
pub struct Case {
    pub name: String,
    pub scene: Scene,
    pub inputs: Inputs,
    /// Rates of the inputs.
    pub rates: Inputs,
    /// [s] The run ends here at the latest.
    pub longest: f64,
}

/// The joints with clearance.
pub type Play = [bool; 4];
/// [s]
pub const LONGEST: f64 = 0.02;
pub const NONE: Play = [false; 4];
pub const C: Play = [false, false, true, false];
pub const T: Play = [false, false, false, true];
pub const ALL: Play = [true; 4];

/// The worn pin of the literature: clearance at C, 5000 rpm, from dead centre.
pub fn worn_pin() -> Scene {
    let mut scene = Scene::default();
    scene.drive.mode = DriveMode::Speed;
    scene.crank.speed_start = 5000.0 * std::f64::consts::TAU / 60.0;
    scene.joint.c.model = JointModel::Clearance;
    scene
}

/// A fast mechanism off dead centre with small clearances, so that impacts come soon.
pub fn brisk(mode: DriveMode, play: Play) -> Scene {
    let mut scene = Scene::default();
    scene.drive.mode = mode;
    scene.crank.angle_start = 0.7;
    scene.crank.speed_start = 300.0;
    let model = play.map(|has| if has { JointModel::Clearance } else { JointModel::Ideal });
    let joint = &mut scene.joint;
    (joint.a.model, joint.b.model, joint.c.model, joint.t.model) = (model[0], model[1], model[2], model[3]);
    (joint.a.clearance, joint.b.clearance, joint.c.clearance, joint.t.clearance) = (8e-5, 1e-4, 1.2e-4, 9e-5);
    scene
}

/// The contact data of all four joints.
pub fn each_contact(scene: &mut Scene, change: impl Fn(&mut Contact)) {
    let joint = &mut scene.joint;
    for contact in [&mut joint.a.contact, &mut joint.b.contact, &mut joint.c.contact, &mut joint.t.contact] {
        change(contact);
    }
}

/// All the cases.
pub fn cases() -> Vec<Case> {
    let mut cases = combinations();
    cases.extend(laws());
    cases.extend(frictions());
    cases.extend(contact_variants());
    cases.extend(geometries());
    cases.extend(loadings());
    cases.extend(starts());
    cases
}

pub fn case(name: impl Into<String>, mut scene: Scene, change: impl FnOnce(&mut Scene)) -> Case {
    change(&mut scene);
    scene.solver.tolerance = 1e-10;
    Case { name: name.into(), scene, inputs: Inputs::default(), rates: Inputs::default(), longest: LONGEST }
}

pub fn loaded(mut case: Case, inputs: Inputs, rates: Inputs) -> Case {
    (case.inputs, case.rates) = (inputs, rates);
    case
}

/// All sixteen, driven by torque and by speed.
fn combinations() -> Vec<Case> {
    let mut cases = Vec::new();
    for mode in [DriveMode::Torque, DriveMode::Speed] {
        for bits in 0..16 {
            let play: Play = [0, 1, 2, 3].map(|joint| bits >> joint & 1 == 1);
            let letters: String = "ABCT".chars().zip(play).map(|(j, has)| if has { j } else { '-' }).collect();
            let with = case(format!("{mode:?} {letters}"), brisk(mode, play), |s| {
                s.gravity = 9.81;
                each_contact(s, |c| c.friction.law = FrictionLaw::Ambrosio);
            });
            cases.push(loaded(with, Inputs { crank_torque: 20.0, slider_load: -300.0 }, Inputs::default()));
        }
    }
    cases
}

/// Each damping law, in a bearing and at the corners.
fn laws() -> Vec<Case> {
    DampingLaw::ALL
        .iter()
        .map(|&law| {
            case(format!("law {law:?}"), brisk(DriveMode::Speed, [false, false, true, true]), |s| {
                each_contact(s, |c| (c.law, c.restitution) = (law, 0.45));
            })
        })
        .collect()
}

fn frictions() -> Vec<Case> {
    let rubbing = |name: &str, change: &dyn Fn(&mut Friction)| {
        case(name, brisk(DriveMode::Torque, [true, false, true, true]), |s| {
            each_contact(s, |c| {
                c.friction.coefficient = 0.1;
                change(&mut c.friction);
            });
        })
    };
    vec![
        rubbing("friction ambrosio", &|f| f.law = FrictionLaw::Ambrosio),
        rubbing("friction ambrosio, wide ramp", &|f| (f.law, f.v0, f.v1) = (FrictionLaw::Ambrosio, 0.2, 2.0)),
        rubbing("friction tanh", &|f| (f.law, f.v1) = (FrictionLaw::Tanh, 0.1)),
        rubbing("friction stribeck", &|f| {
            (f.law, f.static_coefficient, f.v1, f.v_stribeck) = (FrictionLaw::Stribeck, 0.2, 0.1, 1.0);
        }),
    ]
}

fn contact_variants() -> Vec<Case> {
    let varied = |name: &str, change: &dyn Fn(&mut Contact)| {
        case(name, brisk(DriveMode::Torque, [false, true, true, true]), |s| each_contact(s, change))
    };
    vec![
        varied("exponent 1.1", &|c| (c.exponent, c.stiffness) = (1.1, 5e8)),
        varied("exponent 1", &|c| (c.exponent, c.stiffness) = (1.0, 2e8)),
        varied("exponent 2.2, exact law", &|c| {
            (c.exponent, c.stiffness, c.law, c.restitution) = (2.2, 3e13, DampingLaw::ZhangSharf, 0.3);
        }),
        varied("stiffness given", &|c| c.stiffness = 4e9),
        varied("materials differ", &|c| {
            (c.young, c.poisson) = (Pair { bearing: 110e9, journal: 210e9 }, Pair { bearing: 0.34, journal: 0.28 });
        }),
        varied("ratio without limit", &|c| (c.ratio_limit, c.law, c.restitution) = (0.0, DampingLaw::HuGuo, 0.3)),
        varied("ratio limit negative", &|c| (c.ratio_limit, c.restitution) = (-1.0, 0.5)),
        varied("ratio limit 0.5", &|c| (c.ratio_limit, c.restitution) = (0.5, 0.5)),
        varied("low restitution, clips", &|c| (c.law, c.restitution) = (DampingLaw::Flores, 0.05)),
        varied("high speed floor", &|c| c.speed_floor = 0.5),
        case("liu in A, B, C", brisk(DriveMode::Torque, ALL), |s| {
            for joint in [&mut s.joint.a, &mut s.joint.b, &mut s.joint.c] {
                (joint.elasticity, joint.contact.width) = (Elasticity::Liu, 0.015);
                joint.contact.exponent = 2.0;
            }
        }),
        case("liu with zhiying-qishao, rubbing", brisk(DriveMode::Speed, C), |s| {
            s.joint.c.elasticity = Elasticity::Liu;
            (s.joint.c.contact.law, s.joint.c.contact.friction.law) =
                (DampingLaw::ZhiyingQishao, FrictionLaw::Ambrosio);
        }),
        case("bai-zhao with zhiying-qishao, unlimited, rubbing", brisk(DriveMode::Speed, C), |s| {
            let joint = &mut s.joint.c;
            (joint.elasticity, joint.contact.ratio_limit) = (Elasticity::BaiZhao, 0.0);
            (joint.contact.law, joint.contact.friction.law) = (DampingLaw::ZhiyingQishao, FrictionLaw::Ambrosio);
        }),
        case("winkler in A, B, C: of the bearing's material, thin, given", brisk(DriveMode::Torque, ALL), |s| {
            for joint in [&mut s.joint.a, &mut s.joint.b, &mut s.joint.c] {
                (joint.elasticity, joint.contact.width) = (Elasticity::Winkler, 0.015);
                (joint.contact.young.bearing, joint.contact.poisson.bearing) = (5e9, 0.4);
            }
            (s.joint.b.layer.thickness, s.joint.c.layer.stiffness) = (2e-4, 3e12);
            s.joint.a.contact.friction.law = FrictionLaw::Ambrosio;
        }),
        case("four different joints", brisk(DriveMode::Torque, ALL), |s| {
            let j = &mut s.joint;
            (j.a.radius, j.b.radius, j.c.radius) = (0.02, 0.015, 0.008);
            (j.a.contact.law, j.b.contact.law, j.c.contact.law, j.t.contact.law) =
                (DampingLaw::HuGuo, DampingLaw::Gonthier, DampingLaw::LeeWang, DampingLaw::Flores);
            (j.a.contact.friction.law, j.b.contact.friction.law) = (FrictionLaw::Tanh, FrictionLaw::Stribeck);
            (j.c.contact.restitution, j.t.contact.restitution) = (0.7, 0.4);
            j.t.corner_radius = 4e-3;
        }),
    ]
}

fn geometries() -> Vec<Case> {
    let shaped = |name: &str, play: Play, change: &dyn Fn(&mut Scene)| {
        [DriveMode::Torque, DriveMode::Speed].map(|mode| {
            case(format!("{name}, {mode:?}"), brisk(mode, play), |s| {
                each_contact(s, |c| c.friction.law = FrictionLaw::Ambrosio);
                change(s);
            })
        })
    };
    let unbalanced = |s: &mut Scene| {
        s.crank.com = Point { x: 0.011, y: 0.006 };
        s.rod.com = Point { x: 0.045, y: -0.004 };
        s.slider.com = Point { x: -0.007, y: 0.003 };
        s.gravity = 9.81;
    };
    let everything = |s: &mut Scene| {
        unbalanced(s);
        s.guide.offset = -0.013;
        s.slider.centre = Point { x: 0.009, y: -0.005 };
        (s.joint.a.damping, s.joint.b.damping, s.joint.c.damping, s.joint.t.damping) = (2e-3, 3e-3, 1e-3, 8.0);
    };
    [
        shaped("offset guide", [true, false, true, false], &|s| s.guide.offset = 0.02),
        shaped("offset guide with play", T, &|s| s.guide.offset = 0.02),
        shaped("unbalanced, ideal", NONE, &unbalanced),
        shaped("unbalanced", [false, true, false, true], &unbalanced),
        shaped("slider off centre", [false, false, true, true], &|s| s.slider.centre = Point { x: 0.012, y: 0.004 }),
        shaped("slider off centre, ideal guide", [true, true, false, false], &|s| {
            s.slider.centre = Point { x: 0.012, y: 0.004 };
        }),
        shaped("everything off, ideal", NONE, &everything),
        shaped("everything off", ALL, &everything),
    ]
    .into_iter()
    .flatten()
    .collect()
}

fn loadings() -> Vec<Case> {
    let viscous = |s: &mut Scene| {
        (s.joint.a.damping, s.joint.b.damping, s.joint.c.damping, s.joint.t.damping) = (5e-3, 4e-3, 3e-3, 20.0);
    };
    let upright = |s: &mut Scene| {
        (s.gravity, s.gravity_angle, s.energy.audit) = (300.0, 0.0, true);
        s.crank.com = Point { x: 0.011, y: 0.006 };
        s.rod.com = Point { x: 0.045, y: -0.004 };
        s.slider.com = Point { x: -0.007, y: 0.003 };
    };
    let aslant = |s: &mut Scene| {
        upright(s);
        (s.gravity_angle, s.guide.offset) = (0.7, 0.01);
    };
    let off_centre = |s: &mut Scene| (s.slider.load_offset, s.energy.audit) = (0.015, true);
    let ramped = |case| {
        let inputs = Inputs { crank_torque: 30.0, slider_load: 500.0 };
        loaded(case, inputs, Inputs { crank_torque: -8e3, slider_load: -2e5 })
    };
    vec![
        case("viscous, ideal", brisk(DriveMode::Torque, NONE), viscous),
        case("viscous, ideal, Speed", brisk(DriveMode::Speed, NONE), viscous),
        case("viscous", brisk(DriveMode::Torque, ALL), viscous),
        case("gravity alone, from rest", brisk(DriveMode::Torque, ALL), |s| {
            (s.gravity, s.crank.speed_start) = (500.0, 0.0);
        }),
        case("falling along the guide, ideal", brisk(DriveMode::Torque, NONE), upright),
        case("falling along the guide, Speed", brisk(DriveMode::Speed, NONE), upright),
        case("falling along the guide", brisk(DriveMode::Torque, [false, true, true, false]), upright),
        case("falling aslant", brisk(DriveMode::Torque, ALL), aslant),
        case("falling aslant, guide with play", brisk(DriveMode::Torque, T), aslant),
        case("falling aslant, main bearing with play", brisk(DriveMode::Torque, [true, false, false, false]), aslant),
        case("falling aslant, crank pin with play", brisk(DriveMode::Speed, [false, true, false, false]), aslant),
        case("falling aslant, slider pin with play", brisk(DriveMode::Torque, C), aslant),
        ramped(case("loaded off centre, ideal", brisk(DriveMode::Torque, NONE), off_centre)),
        ramped(case("loaded off centre, guide with play", brisk(DriveMode::Torque, T), off_centre)),
        ramped(case("loaded off centre", brisk(DriveMode::Torque, ALL), off_centre)),
        ramped(case("ramped inputs, ideal", brisk(DriveMode::Torque, NONE), |_| ())),
        ramped(case("ramped inputs", brisk(DriveMode::Torque, ALL), |_| ())),
        ramped(case("ramped inputs, Speed", brisk(DriveMode::Speed, C), |_| ())),
        loaded(
            case("pressed from rest", brisk(DriveMode::Torque, ALL), |s| s.crank.speed_start = 0.0),
            Inputs { crank_torque: 40.0, slider_load: -2000.0 },
            Inputs::default(),
        ),
        case("crank turning back", brisk(DriveMode::Speed, ALL), |s| s.crank.speed_start = -250.0),
        case("crank held", brisk(DriveMode::Speed, [false, true, true, true]), |s| {
            (s.crank.speed_start, s.gravity) = (0.0, 800.0);
        }),
    ]
}

fn starts() -> Vec<Case> {
    let eccentric = |s: &mut Scene| {
        s.joint.a.eccentricity_start = Point { x: 3e-5, y: -2e-5 };
        s.joint.b.eccentricity_start = Point { x: -5e-5, y: 4e-5 };
        s.joint.c.eccentricity_start = Point { x: 1e-5, y: 9e-5 };
        s.joint.t.offset_start = -6e-5;
    };
    let touching = |s: &mut Scene| {
        s.joint.b.eccentricity_start = Point { x: 7e-5, y: -8e-5 };
        s.joint.c.eccentricity_start = Point { x: -1.25e-4, y: 2e-5 };
        s.joint.t.offset_start = 9.4e-5;
        each_contact(s, |c| c.friction.law = FrictionLaw::Tanh);
    };
    let mut cases = vec![
        case("worn pin", worn_pin(), |_| ()),
        case("worn pin, rubbing", worn_pin(), |s| s.joint.c.contact.friction.law = FrictionLaw::Ambrosio),
        case("eccentric start of ideal joints", brisk(DriveMode::Torque, NONE), eccentric),
    ];
    for mode in [DriveMode::Torque, DriveMode::Speed] {
        let smooth = brisk(mode, [false, true, true, false]);
        cases.push(case(format!("start in contact without friction, {mode:?}"), smooth, |s| {
            touching(s);
            each_contact(s, |c| c.friction.law = FrictionLaw::None);
        }));
        cases.push(case(format!("eccentric start, {mode:?}"), brisk(mode, ALL), eccentric));
        cases.push(case(format!("start in contact, {mode:?}"), brisk(mode, ALL), touching));
        cases.push(case(
            format!("start in contact, B and C, {mode:?}"),
            brisk(mode, [false, true, true, false]),
            touching,
        ));
    }
    cases
}
