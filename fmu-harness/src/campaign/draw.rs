//! Draws random scenes from all legal values of all parameters.
//!
//! Every parameter draws two numbers: the first selects a kind of value, the second a value of that kind. Smaller first
//! numbers select simpler kinds, so that shrinking a scene leads to the declared values, parameter by parameter.

use super::usual::usual;
use proptest::prelude::{Strategy, any, prop_oneof};
use proptest::strategy::Just;
use slidercrank::scene::parameter::{Kind, Parameter};
use slidercrank::scene::profile::{Profile, ProfileArgument, Profiles};
use slidercrank::scene::read::SceneFile;
use slidercrank::scene::run::{End, Run};
use slidercrank::scene::{Audit, FrictionLaw, Lubrication, Method, PARAMETERS, Scene, Surface};
use std::f64::consts::TAU;

/// The two numbers, each from 0 to 1.
type Lot = (f64, f64);

/// Share of the parameters that keep their declared value.
const DECLARED: f64 = 0.6;
/// Largest share of parameters with any value of their range, in the most extreme scene.
const ANYWHERE: f64 = 0.06;
/// Largest share of parameters at an end of their range, in the most extreme scene.
const AT_AN_END: f64 = 0.02;
/// Share of enumerations, numbers of modes and switches that keep their declared value.
const PLAIN: f64 = 0.35;
/// [s] Maximum length of a run, for slow cranks.
const LONGEST: f64 = 1e3;
/// Maximum number of decades of a range that begins at 0.
const DECADES: f64 = 14.0;
/// Minimum and maximum number of communication points.
const POINTS: [f64; 2] = [20.0, 400.0];

/// Strategy for scene files with runs of `turns` turns. Not all scenes are legal.
pub fn scene_files(turns: f64) -> impl Strategy<Value = SceneFile> {
    let lots = vec![(0.0..1.0, 0.0..1.0); PARAMETERS.len()];
    let inputs = [profile(100.0), profile(1e4)];
    (0.0..1.0, lots, inputs, 0.0..1.0, 0.0..1.0).prop_map(move |(wildness, lots, inputs, span, step)| {
        let mut scene = Scene::default();
        for (parameter, lot) in PARAMETERS.iter().zip(lots) {
            let value = value(parameter, &scene, wildness, lot);
            // If rounding puts a value outside its range, the parameter keeps the declared value.
            let _ = parameter.write(&mut scene, value);
        }
        (scene.solver.max_evaluations, scene.solver.deadline) = (0, 0.0);
        if scene.solver.method == Method::Moreau {
            stiffen(&mut scene);
        }
        let turning = scene.crank.speed_start.abs();
        let end = match turns * TAU / turning {
            time if time < LONGEST => End::Turns(turns),
            _ => End::Time(logarithmic(1e-3, 1.0, span)),
        };
        let mut run = Run { end, step: 1.0 };
        run.step = run.stop(&scene) / logarithmic(POINTS[0], POINTS[1], step).round();
        let [crank_torque, slider_load] = inputs.map(|drawn| drawn.profile(run.stop(&scene)));
        let inputs = Profiles { crank_torque, slider_load };
        SceneFile { name: "drawn".into(), description: String::new(), scene, run, inputs }
    })
}

/// Removes the effects that rigid contacts do not support; otherwise hardly any scene with them would be legal.
fn stiffen(scene: &mut Scene) {
    (scene.rod.flexible.bending_modes, scene.rod.flexible.axial_modes) = (0, 0);
    scene.energy.audit = false;
    let joint = &mut scene.joint;
    for joint in [&mut joint.a, &mut joint.b, &mut joint.c] {
        joint.lubrication = Lubrication::None;
        (joint.peak, joint.wear) = (Audit::default(), Audit::default());
    }
    (joint.t.peak, joint.t.wear) = (Audit::default(), Audit::default());
    joint.t.surface = Surface::Corner;
    for contact in [&mut joint.a.contact, &mut joint.b.contact, &mut joint.c.contact, &mut joint.t.contact] {
        if contact.friction.law == FrictionLaw::Lugre {
            contact.friction.law = FrictionLaw::Stribeck;
        }
    }
}

/// The value of a parameter for two random numbers. Earlier parameters of the scene already have their values.
fn value(parameter: &Parameter, scene: &Scene, wildness: f64, (kind, place): Lot) -> f64 {
    let wild = wildness * wildness;
    let at_an_end = 1.0 - AT_AN_END * wild;
    let anywhere = at_an_end - ANYWHERE * wild;
    match parameter.kind {
        Kind::Real { start, .. } if kind < DECLARED => start,
        Kind::Real { start, .. } if kind < anywhere => usual(parameter.name, start, scene, place),
        Kind::Real { min, max, .. } if kind < at_an_end => within(min, max, place),
        Kind::Real { min, max, .. } => [min, max, 0.0_f64.clamp(min, max)][(place * 3.0) as usize],
        _ if kind < PLAIN => parameter.start(),
        // Small numbers of modes are frequent, large ones rare.
        Kind::Integer { min, max, .. } if kind > DECLARED => {
            f64::from(min) + (place * place * f64::from(max - min + 1)).floor()
        }
        Kind::Integer { start, .. } => f64::from(start),
        Kind::Boolean { .. } => f64::from(u8::from(place >= 0.5)),
        Kind::Enumeration { items, .. } => f64::from(items[(place * items.len() as f64) as usize].1),
    }
}

/// A value of a range; wide ranges are logarithmic.
fn within(min: f64, max: f64, place: f64) -> f64 {
    let tiny = |most: f64| most * 10_f64.powf(-DECADES);
    if min > 0.0 {
        return if max > 100.0 * min { logarithmic(min, max, place) } else { min + place * (max - min) };
    }
    if min == 0.0 {
        return if max > 1.0 { logarithmic(tiny(max), max, place) } else { place * max };
    }
    let signed = 2.0 * place - 1.0;
    let most = if signed < 0.0 { -min } else { max };
    logarithmic(tiny(most), most, signed.abs()).copysign(signed)
}

/// Logarithmic interpolation between two positive numbers.
pub fn logarithmic(low: f64, high: f64, place: f64) -> f64 {
    (low * (high / low).powf(place)).clamp(low.min(high), high.max(low))
}

/// A randomly drawn input.
#[derive(Clone, Debug)]
enum Drawn {
    Constant(f64),
    Over(ProfileArgument, Vec<f64>),
}

impl Drawn {
    /// The profile with points evenly spaced over the run or over the turn.
    fn profile(self, span: f64) -> Profile {
        match self {
            Self::Constant(value) => Profile::Constant(value),
            Self::Over(against, values) => {
                let range = if against == ProfileArgument::Time { span } else { TAU };
                let count = values.len() as f64;
                let place = |i: usize| range * (i as f64 + 0.5) / count;
                Profile::Points {
                    against,
                    points: values.iter().enumerate().map(|(i, value)| [place(i), *value]).collect(),
                }
            }
        }
    }
}

/// An input, mostly of a usual size, rarely of any size.
fn profile(size: f64) -> impl Strategy<Value = Drawn> {
    let wild = (any::<bool>(), 0.0..1.0).prop_map(|(negative, place)| {
        let value = logarithmic(1.0, 1e18, place);
        if negative { -value } else { value }
    });
    let value = prop_oneof![30 => (-1.0..1.0).prop_map(move |share| share * size), 1 => wild, 1 => Just(f64::MAX)];
    let against = prop_oneof![Just(ProfileArgument::Time), Just(ProfileArgument::CrankAngle)];
    let over = (against, proptest::collection::vec((-1.0..1.0).prop_map(move |share| share * size), 2..7));
    prop_oneof![
        3 => Just(Drawn::Constant(0.0)),
        3 => value.prop_map(Drawn::Constant),
        3 => over.prop_map(|(against, values)| Drawn::Over(against, values)),
    ]
}
