//! Mechanisms with a flexible rod, elastic faces, lugre's bristles, and an account of energy.

use crate::scenes::{ALL, C, Case, NONE, Play, T, brisk, case, each_contact, loaded, worn_pin};
use slidercrank::model::signals::Inputs;
use slidercrank::scene::{Contact, DampingLaw, DriveMode, FrictionLaw, Lubrication, Point, Scene, Surface};

const A: Play = [true, false, false, false];
const B: Play = [false, true, false, false];
const AB: Play = [true, true, false, false];
const BC: Play = [false, true, true, false];
const BT: Play = [false, true, false, true];
const CT: Play = [false, false, true, true];
const ABC: Play = [true, true, true, false];
const DRIVES: [DriveMode; 2] = [DriveMode::Torque, DriveMode::Speed];
/// [s] Some periods of the softest bending.
const SHORT: f64 = 2e-3;

/// A soft beam of steel's density, with that many modes.
pub fn flexible(scene: &mut Scene, bending_modes: i32, axial_modes: i32) {
    let f = &mut scene.rod.flexible;
    (f.bending_modes, f.axial_modes) = (bending_modes, axial_modes);
    (f.young, f.damping_ratio, f.geometric_stiffness) = (20e9, 0.02, true);
}

/// Bristles soft enough for their equation to be no stiffer than the contacts'.
pub fn lugre(contact: &mut Contact) {
    let friction = &mut contact.friction;
    friction.law = FrictionLaw::Lugre;
    (friction.coefficient, friction.static_coefficient) = (0.1, 0.15);
    (friction.sigma0, friction.sigma1, friction.sigma2) = (1e4, 1.0, 1e-3);
    friction.v_stribeck = 0.1;
}

fn rubbing(contact: &mut Contact) {
    contact.friction.law = FrictionLaw::Ambrosio;
}

fn faces(scene: &mut Scene) {
    scene.joint.t.surface = Surface::Foundation;
    scene.joint.t.foundation_stiffness = 2e9;
}

fn short(name: String, scene: Scene, change: impl FnOnce(&mut Scene)) -> Case {
    let case = case(name, scene, change);
    let inputs = Inputs { crank_torque: 20.0, slider_load: -300.0 };
    loaded(Case { longest: SHORT, ..case }, inputs, Inputs::default())
}

fn letters(play: Play) -> String {
    "ABCT".chars().zip(play).map(|(joint, has)| if has { joint } else { '-' }).collect()
}

/// Both drives.
fn driven(name: &str, play: Play, change: impl Fn(&mut Scene)) -> [Case; 2] {
    DRIVES.map(|mode| short(format!("{name}, {mode:?} {}", letters(play)), brisk(mode, play), &change))
}

/// Both drives, and every one of these joints.
fn each(name: &str, plays: &[Play], change: impl Fn(&mut Scene)) -> Vec<Case> {
    plays.iter().flat_map(|&play| driven(name, play, &change)).collect()
}

pub fn flexible_cases() -> Vec<Case> {
    let rod = |bending_modes: i32, axial_modes: i32| {
        move |s: &mut Scene| {
            s.gravity = 9.81;
            flexible(s, bending_modes, axial_modes);
            each_contact(s, rubbing);
        }
    };
    let changed = |change: fn(&mut Scene)| {
        move |s: &mut Scene| {
            rod(2, 1)(s);
            change(s);
        }
    };
    [
        each("bending", &[NONE, C, A, B, T, AB, BC, BT, CT, ABC, ALL], rod(2, 0)),
        each("bending and stretching", &[NONE, C, B, T, BC, ALL], rod(3, 1)),
        each("stretching", &[NONE, C, BC], rod(0, 2)),
        each("one bending mode", &[NONE, C], rod(1, 0)),
        each("no foreshortening", &[NONE, C, ALL], changed(|s| s.rod.flexible.geometric_stiffness = false)),
        each("undamped", &[NONE, BC], changed(|s| s.rod.flexible.damping_ratio = 0.0)),
        each("strongly damped", &[NONE, BC], changed(|s| s.rod.flexible.damping_ratio = 0.7)),
        each(
            "viscous",
            &[NONE, T, BC, ALL],
            changed(|s| {
                let joint = &mut s.joint;
                (joint.a.damping, joint.b.damping, joint.c.damping, joint.t.damping) = (5e-3, 2e-2, 3e-2, 20.0);
            }),
        ),
        each(
            "offset guide",
            &[NONE, C, BT],
            changed(|s| {
                (s.guide.offset, s.slider.centre) = (0.02, Point { x: 0.006, y: -0.004 });
            }),
        ),
        each(
            "unbalanced",
            &[NONE, ALL],
            changed(|s| {
                (s.crank.com, s.slider.com) = (Point { x: 0.011, y: 0.006 }, Point { x: -0.007, y: 0.003 });
                s.rod.com = Point { x: 0.3, y: 0.2 };
            }),
        ),
        each(
            "falling aslant, loaded off centre",
            &[NONE, A, B, C, T, AB, BC, CT, ALL],
            changed(|s| {
                (s.gravity, s.gravity_angle, s.energy.audit) = (300.0, 0.7, true);
                (s.crank.com, s.slider.com) = (Point { x: 0.011, y: 0.006 }, Point { x: -0.007, y: 0.003 });
                s.slider.load_offset = -0.012;
            }),
        ),
        each(
            "eccentric start",
            &[BC, ALL],
            changed(|s| {
                s.joint.b.eccentricity_start = Point { x: -5e-5, y: 4e-5 };
                s.joint.c.eccentricity_start = Point { x: -1.25e-4, y: 2e-5 };
                s.joint.t.offset_start = 9.4e-5;
            }),
        ),
        each(
            "strong friction",
            &[BC],
            changed(|s| {
                each_contact(s, |c| {
                    (c.friction.law, c.friction.coefficient, c.friction.v1) = (FrictionLaw::Tanh, 0.3, 0.1);
                })
            }),
        ),
        vec![short("flexible worn pin".to_string(), worn_pin(), |s| {
            flexible(s, 2, 0);
            s.rod.flexible.young = 207e9;
        })],
    ]
    .concat()
}

pub fn face_cases() -> Vec<Case> {
    let bed = |change: fn(&mut Scene)| {
        move |s: &mut Scene| {
            faces(s);
            change(s);
        }
    };
    [
        each("faces", &[T, BT, CT, ALL], bed(|_| ())),
        each("faces rubbing", &[T, CT, ALL], bed(|s| each_contact(s, rubbing))),
        each("half-space", &[T, CT], bed(|s| s.joint.t.foundation_stiffness = 0.0)),
        each(
            "broad half-space",
            &[T],
            bed(|s| {
                (s.joint.t.foundation_stiffness, s.joint.t.contact.width) = (0.0, 0.1);
            }),
        ),
        each(
            "dead faces",
            &[T, ALL],
            bed(|s| {
                each_contact(s, |c| {
                    (c.restitution, c.law) = (0.5, DampingLaw::Flores);
                    rubbing(c);
                })
            }),
        ),
        each(
            "clipping faces",
            &[T, CT],
            bed(|s| each_contact(s, |c| (c.restitution, c.law) = (0.05, DampingLaw::Flores))),
        ),
        each("unlimited faces", &[T, CT], bed(|s| each_contact(s, |c| (c.ratio_limit, c.restitution) = (0.0, 0.5)))),
        each(
            "pressed flat",
            &[T, CT],
            bed(|s| {
                (s.gravity, s.joint.t.offset_start) = (9.81, -9.2e-5);
                each_contact(s, rubbing);
            }),
        ),
        each(
            "tilting",
            &[T, CT],
            bed(|s| {
                s.slider.centre = Point { x: 0.012, y: 0.004 };
                (s.slider.com, s.guide.offset) = (Point { x: -0.007, y: 0.003 }, 0.01);
                each_contact(s, rubbing);
            }),
        ),
        each("lugre on faces", &[T, CT], bed(|s| each_contact(s, lugre))),
        each(
            "faces with a flexible rod",
            &[T, CT],
            bed(|s| {
                flexible(s, 2, 1);
                each_contact(s, rubbing);
            }),
        ),
    ]
    .concat()
}

pub fn lugre_cases() -> Vec<Case> {
    let bristly = |change: fn(&mut Scene)| {
        move |s: &mut Scene| {
            each_contact(s, lugre);
            change(s);
        }
    };
    let one_only = |s: &mut Scene| {
        each_contact(s, rubbing);
        lugre(&mut s.joint.c.contact);
    };
    [
        each("lugre", &[A, B, C, T, CT, ALL], bristly(|_| ())),
        each("lugre in C, ambrosio elsewhere", &[ALL], one_only),
        each("lugre with a flexible rod", &[BC, ALL], bristly(|s| flexible(s, 2, 0))),
        each(
            "lugre with much damping",
            &[C],
            bristly(|s| {
                each_contact(s, |c| (c.friction.sigma1, c.friction.v_stribeck) = (30.0, 1.0));
            }),
        ),
        each(
            "lugre clipping",
            &[C],
            bristly(|s| {
                each_contact(s, |c| (c.restitution, c.law) = (0.05, DampingLaw::Flores));
            }),
        ),
        each(
            "lugre started in contact",
            &[C, T],
            bristly(|s| {
                s.joint.c.eccentricity_start = Point { x: -1.25e-4, y: 2e-5 };
                s.joint.t.offset_start = 9.4e-5;
            }),
        ),
        each("lugre as declared, slow", &[C], |s| {
            s.joint.c.contact.friction.law = FrictionLaw::Lugre;
            (s.crank.speed_start, s.joint.c.clearance, s.gravity) = (20.0, 2e-5, 9.81);
        }),
    ]
    .concat()
}

/// Journals in thin oil on rough surfaces: films that are neither stiff nor weak beside the contacts.
pub fn oil_cases() -> Vec<Case> {
    let oiled = |change: fn(&mut Scene)| {
        move |s: &mut Scene| {
            for joint in [&mut s.joint.a, &mut s.joint.b, &mut s.joint.c] {
                (joint.lubrication, joint.viscosity) = (Lubrication::ShortBearing, 2e-3);
                joint.roughness = 0.04 * joint.clearance;
            }
            s.energy.audit = true;
            change(s);
        }
    };
    [
        each("oil", &[A, B, C, BC, ALL], oiled(|_| ())),
        each("oil and friction", &[C, BC], oiled(|s| each_contact(s, rubbing))),
        each("oil around a flexible rod", &[B, C, ALL], oiled(|s| flexible(s, 2, 1))),
        each(
            "thicker oil, rough surfaces, unbalanced",
            &[C, ABC],
            oiled(|s| {
                for joint in [&mut s.joint.a, &mut s.joint.b, &mut s.joint.c] {
                    (joint.viscosity, joint.roughness) = (0.02, 0.1 * joint.clearance);
                }
                (s.crank.com, s.slider.com) = (Point { x: 0.011, y: 0.006 }, Point { x: -0.007, y: 0.003 });
            }),
        ),
        each(
            "no viscosity left",
            &[C],
            oiled(|s| {
                for joint in [&mut s.joint.a, &mut s.joint.b, &mut s.joint.c] {
                    joint.viscosity = 0.0;
                }
            }),
        ),
    ]
    .concat()
}

pub fn audit_cases() -> Vec<Case> {
    let audited = |change: fn(&mut Scene)| {
        move |s: &mut Scene| {
            (s.energy.audit, s.gravity) = (true, 9.81);
            (s.joint.a.damping, s.joint.b.damping, s.joint.c.damping, s.joint.t.damping) = (5e-3, 4e-3, 3e-3, 20.0);
            each_contact(s, rubbing);
            change(s);
        }
    };
    [
        each("audit", &[NONE, A, B, C, T, ALL], audited(|_| ())),
        each(
            "audit of liu and stribeck",
            &[ABC],
            audited(|s| {
                for joint in [&mut s.joint.a, &mut s.joint.b, &mut s.joint.c] {
                    joint.elasticity = slidercrank::scene::Elasticity::Liu;
                    (joint.contact.friction.law, joint.contact.friction.v1) = (FrictionLaw::Stribeck, 0.1);
                }
            }),
        ),
        each(
            "audit of an eccentric start",
            &[ALL],
            audited(|s| {
                s.joint.b.eccentricity_start = Point { x: 7e-5, y: -8e-5 };
                s.joint.t.offset_start = 9.4e-5;
            }),
        ),
        each("audit of faces", &[T, CT], audited(faces)),
        each("audit of lugre", &[C, ALL], audited(|s| each_contact(s, lugre))),
        each("audit of a flexible rod", &[NONE, C, ALL], audited(|s| flexible(s, 2, 1))),
        each(
            "audit of everything",
            &[ALL],
            audited(|s| {
                faces(s);
                flexible(s, 3, 1);
                each_contact(s, lugre);
            }),
        ),
    ]
    .concat()
}
