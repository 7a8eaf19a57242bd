//! Outputs by name, and how far two runs of them lie apart.

use slidercrank::model::signals::{EnergyOutputs, Outputs, RevoluteOutputs};
use slidercrank::scene::Scene;

/// What an output measures: outputs of one kind share the scale below which they count as 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    Length,
    Speed,
    Acceleration,
    Angle,
    AngularSpeed,
    AngularAcceleration,
    Force,
    Moment,
    Energy,
    Power,
    /// What should be 0 of the energy that turns over.
    Residual,
}

/// An output's name, kind and value.
pub type Signal = (&'static str, Kind, f64);

/// Every real output of the mechanism.
pub fn signals(o: &Outputs) -> Vec<Signal> {
    let mut all = vec![
        ("slider.x", Kind::Length, o.slider.x),
        ("slider.v", Kind::Speed, o.slider.v),
        ("slider.a", Kind::Acceleration, o.slider.a),
        ("slider.y", Kind::Length, o.slider.y),
        ("slider.angle", Kind::Angle, o.slider.angle),
        ("crank.angle", Kind::Angle, o.crank.angle),
        ("crank.speed", Kind::AngularSpeed, o.crank.speed),
        ("crank.acceleration", Kind::AngularAcceleration, o.crank.acceleration),
        ("rod.angle", Kind::Angle, o.rod.angle),
        ("rod.speed", Kind::AngularSpeed, o.rod.speed),
        ("rod.deflection", Kind::Length, o.rod.deflection),
        ("rod.stretch", Kind::Length, o.rod.stretch),
        ("joint.T.force.x", Kind::Force, o.joint_t.force[0]),
        ("joint.T.force.y", Kind::Force, o.joint_t.force[1]),
        ("joint.T.moment", Kind::Moment, o.joint_t.moment),
        ("joint.T.penetration", Kind::Length, o.joint_t.penetration),
        ("drive.torque", Kind::Moment, o.drive_torque),
        ("drive.power", Kind::Power, o.drive_power),
        ("joint.T.impact.speed", Kind::Speed, o.joint_t.interval.impact_speed),
        ("accuracy.position", Kind::Length, o.accuracy.position),
        ("accuracy.velocity", Kind::Speed, o.accuracy.velocity),
        ("accuracy.acceleration", Kind::Acceleration, o.accuracy.acceleration),
    ];
    let names = [
        [
            "joint.A.force.x",
            "joint.A.force.y",
            "joint.A.eccentricity.x",
            "joint.A.eccentricity.y",
            "joint.A.penetration",
            "joint.A.film.force",
            "joint.A.film.moment",
            "joint.A.impact.speed",
        ],
        [
            "joint.B.force.x",
            "joint.B.force.y",
            "joint.B.eccentricity.x",
            "joint.B.eccentricity.y",
            "joint.B.penetration",
            "joint.B.film.force",
            "joint.B.film.moment",
            "joint.B.impact.speed",
        ],
        [
            "joint.C.force.x",
            "joint.C.force.y",
            "joint.C.eccentricity.x",
            "joint.C.eccentricity.y",
            "joint.C.penetration",
            "joint.C.film.force",
            "joint.C.film.moment",
            "joint.C.impact.speed",
        ],
    ];
    for (name, joint) in names.into_iter().zip([&o.joint_a, &o.joint_b, &o.joint_c]) {
        all.extend([
            (name[0], Kind::Force, joint.force[0]),
            (name[1], Kind::Force, joint.force[1]),
            (name[2], Kind::Length, joint.eccentricity[0]),
            (name[3], Kind::Length, joint.eccentricity[1]),
            (name[4], Kind::Length, joint.penetration),
            (name[5], Kind::Force, joint.film_force),
            (name[6], Kind::Moment, joint.film_moment),
            (name[7], Kind::Speed, joint.interval.impact_speed),
        ]);
    }
    all.extend(energies(&o.energy));
    all
}

fn energies(e: &EnergyOutputs) -> [Signal; 14] {
    let energy = |name, value| (name, Kind::Energy, value);
    [
        energy("energy.kinetic", e.kinetic),
        energy("energy.potential", e.potential),
        energy("energy.input", e.input),
        energy("energy.dissipated", e.dissipated),
        ("energy.residual", Kind::Residual, e.residual),
        energy("energy.gravity", e.gravity),
        energy("energy.elastic", e.elastic),
        energy("energy.contact", e.contact),
        energy("energy.torque_work", e.torque_work),
        energy("energy.load_work", e.load_work),
        energy("energy.contact_loss", e.contact_loss),
        energy("energy.friction_loss", e.friction_loss),
        energy("energy.viscous_loss", e.viscous_loss),
        energy("energy.modal_loss", e.modal_loss),
    ]
}

/// Contacts of A, B, C (0 or 1), the number of corners in contact, and the touches of each joint since the start.
pub fn flags(o: &Outputs) -> [i32; 8] {
    let Outputs { joint_a: a, joint_b: b, joint_c: c, joint_t: t, .. } = o;
    let closed = |joint: &RevoluteOutputs| i32::from(joint.contact);
    [
        closed(a),
        closed(b),
        closed(c),
        t.contacts,
        a.interval.impacts,
        b.interval.impacts,
        c.interval.impacts,
        t.interval.impacts,
    ]
}

/// The greatest distance of one output over a run.
#[derive(Clone, Copy, Debug)]
pub struct Distance {
    pub output: &'static str,
    /// Greatest difference over the greatest |output|, or over what counts as 0 of its kind.
    pub relative: f64,
    /// [s] Where the difference is greatest.
    pub time: f64,
    /// There.
    pub values: [f64; 2],
}

/// The distance of each output between two runs at the same `times`; the first run gives scales.
pub fn distances(scene: &Scene, times: &[f64], first: &[Outputs], second: &[Outputs]) -> Vec<Distance> {
    let [first, second] = [first, second].map(|run| run.iter().map(signals).collect::<Vec<_>>());
    let count = first[0].len();
    (0..count)
        .map(|k| {
            let (output, kind, _) = first[0][k];
            let amplitude = first.iter().map(|signals| signals[k].2.abs()).fold(0.0, f64::max);
            let scale = amplitude.max(negligible(kind, scene, &first));
            let (at, difference) = first
                .iter()
                .zip(&second)
                .map(|(a, b)| (a[k].2 - b[k].2).abs())
                .enumerate()
                // A NaN is as far as can be.
                .map(|(at, d)| (at, if d.is_nan() { f64::INFINITY } else { d }))
                .max_by(|a, b| a.1.total_cmp(&b.1))
                .unwrap_or((0, f64::INFINITY));
            let values = [first[at][k].2, second[at][k].2];
            Distance { output, relative: difference / scale, time: times[at], values }
        })
        .collect()
}

/// An output whose greatest value is below this is taken for 0, and held to 1e-6 of this: what
/// round-off leaves of the mechanism's own size. Round-off of 1e-16 in a sum of such quantities,
/// some hundred steps long, is 1e-14 of that size; it must stay below 1e-6 of what is given here.
fn negligible(kind: Kind, scene: &Scene, run: &[Vec<Signal>]) -> f64 {
    let greatest = |kinds: &[Kind]| {
        let all = run.iter().flatten().filter(|(_, kind, _)| kinds.contains(kind));
        all.map(|(_, _, value)| value.abs()).fold(0.0, f64::max)
    };
    let length = scene.crank.length + scene.rod.length;
    let force = greatest(&[Kind::Force]).max(greatest(&[Kind::Moment]) / length);
    let size = match kind {
        Kind::Length => length,
        Kind::Angle => 1.0,
        Kind::Speed => greatest(&[kind]).max(length * greatest(&[Kind::AngularSpeed])),
        Kind::AngularSpeed => greatest(&[kind]).max(greatest(&[Kind::Speed]) / length),
        Kind::Acceleration => greatest(&[kind]).max(length * greatest(&[Kind::AngularAcceleration])),
        Kind::AngularAcceleration => greatest(&[kind]).max(greatest(&[Kind::Acceleration]) / length),
        Kind::Force => force,
        Kind::Moment => force * length,
        Kind::Power => greatest(&[Kind::Moment]) * greatest(&[Kind::AngularSpeed]),
        // Without an audit all are 0 on both sides.
        Kind::Energy => greatest(&[kind]).max(1.0),
        Kind::Residual => return greatest(&[Kind::Energy]).max(1.0),
    };
    1e-6 * size
}
