//! Outputs of an instant.

use super::bodies::bodies;
use super::body::Bodies;
use super::films::Films;
use super::gravity::free_fall;
use super::ideal::IdealMechanism;
use super::joint::guide::contact_of_corner;
use super::joint::rectangle::CORNERS;
use super::joint_set::Pin;
use super::loads::Loads;
use super::plane::Vec2;
use super::reactions::{Reactions, reactions};
use super::rod::Elastic;
use super::signals::{
    AccuracyOutputs, CrankOutputs, GuideOutputs, IntervalOutputs, Outputs, RevoluteOutputs, RodOutputs, SliderOutputs,
};
use super::state::{Conditions, Contacts, Evaluation, Pose};
use super::structure::{CRANK, ROD, SLIDER, Topology};
use super::touches::{GUIDE, JOINTS, Touches};
use crate::scene::{Scene, Surface};

/// Computes the outputs of instants.
#[derive(Clone, Debug)]
pub struct Observer {
    topology: Topology,
    bodies: Bodies,
    gravity: Vec2,
    films: Films,
    ideal: IdealMechanism,
    surface: Surface,
}

impl Observer {
    /// An observer of a scene's mechanism.
    pub fn new(scene: &Scene) -> Self {
        Self {
            topology: Topology::of(scene),
            bodies: bodies(scene),
            gravity: free_fall(scene),
            films: Films::new(scene),
            ideal: IdealMechanism::new(scene),
            surface: scene.joint.t.surface,
        }
    }

    /// [m] Eccentricities of joints with clearance, at whose zeros penetrations are not smooth; 0 for ideal joints.
    pub fn eccentricities(&self, pose: &Pose) -> [Vec2; 3] {
        let Topology { a, b, c, .. } = self.topology;
        let of = |pin: Pin, ideal: bool| if ideal { Vec2::default() } else { pose.journal(pin).eccentricity };
        [of(Pin::MainBearing, a), of(Pin::CrankPin, b), of(Pin::SliderPin, c)]
    }

    /// [m/s] Velocities that squeeze oil films, at whose zeros the films' loads are not smooth; 0 for missing films.
    pub fn squeeze_velocities(&self, pose: &Pose) -> [Vec2; 3] {
        let mut velocities = [Vec2::default(); 3];
        velocities.iter_mut().zip(self.films.squeeze_velocities(pose)).for_each(|(place, own)| *place = own);
        velocities
    }

    /// All outputs except the integrator's counters. `torque_input` [N·m] is the input of the crank torque.
    pub fn outputs(
        &self,
        evaluation: &Evaluation,
        conditions: &Conditions,
        penetration: &[f64; 3 + CORNERS],
        torque_input: f64,
    ) -> Outputs {
        let Conditions { contacts, touches, .. } = conditions;
        let Evaluation { pose, acceleration, angle_acceleration, .. } = evaluation;
        let rotations = &pose.rotations;
        let r = reactions(self.topology, &self.bodies, self.gravity, evaluation);
        let elastic = evaluation.flexible.map_or(Elastic::default(), |flexible| flexible.elastic);
        let Topology { a, b, c, t, speed } = self.topology;
        let interval = |joint: usize| {
            let Touches { largest, count, .. } = touches[joint];
            let impacts = i32::try_from(count).unwrap_or(i32::MAX);
            IntervalOutputs { impact_speed: largest, impacts, ..IntervalOutputs::default() }
        };
        let eccentricities = self.eccentricities(pose);
        let joint = |pin: Pin, ideal: bool, force: Vec2| {
            let film = self.films.load(pin, pose);
            RevoluteOutputs {
                force: force.into(),
                eccentricity: eccentricities[pin as usize].into(),
                penetration: if ideal { 0.0 } else { penetration[pin as usize] },
                film_force: film.force.norm(),
                film_moment: film.journal_couple,
                interval: interval(pin as usize),
                contact: contacts[pin as usize].closed,
            }
        };
        let drive_torque = if speed { r.torque } else { torque_input };
        Outputs {
            slider: SliderOutputs {
                x: pose.place.pin.x,
                v: pose.velocity.pin.x,
                a: acceleration.pin.x,
                y: pose.place.pin.y,
                angle: rotations.angle[SLIDER],
            },
            crank: CrankOutputs {
                angle: rotations.angle[CRANK],
                speed: rotations.speed[CRANK],
                acceleration: angle_acceleration[CRANK],
            },
            rod: RodOutputs {
                angle: rotations.angle[ROD],
                speed: rotations.speed[ROD],
                deflection: elastic.deflection,
                stretch: elastic.stretch,
            },
            joint_a: joint(Pin::MainBearing, a, r.a),
            joint_b: joint(Pin::CrankPin, b, r.b),
            joint_c: joint(Pin::SliderPin, c, r.c),
            joint_t: GuideOutputs { interval: interval(GUIDE), ..self.guide(t, &r, contacts, penetration) },
            drive_torque,
            drive_power: drive_torque * rotations.speed[CRANK],
            accuracy: self.accuracy(evaluation),
            ..Outputs::default()
        }
    }

    /// [N] Magnitudes of the forces of A, B, C and T.
    pub fn joint_forces(&self, evaluation: &Evaluation) -> [f64; JOINTS] {
        let Reactions { a, b, c, t, .. } = reactions(self.topology, &self.bodies, self.gravity, evaluation);
        [a, b, c, t].map(Vec2::norm)
    }

    /// [N] As [`joint_forces`](Self::joint_forces), of joints with clearance alone: they need no accelerations.
    pub fn clearance_forces(loads: &Loads) -> [f64; JOINTS] {
        [loads.crank, loads.big_end, loads.small_end, loads.guide.force].map(Vec2::norm)
    }

    /// Sets the time derivatives of those outputs whose derivatives the evaluation contains.
    pub fn set_known_rates(&self, evaluation: &Evaluation, rates: &mut Outputs) {
        let Evaluation { pose, acceleration, angle_acceleration, .. } = evaluation;
        let speed = &pose.rotations.speed;
        let Topology { a, b, c, .. } = self.topology;
        rates.slider.x = pose.velocity.pin.x;
        rates.slider.v = acceleration.pin.x;
        rates.slider.y = pose.velocity.pin.y;
        rates.slider.angle = speed[SLIDER];
        rates.crank.angle = speed[CRANK];
        rates.crank.speed = angle_acceleration[CRANK];
        rates.rod.angle = speed[ROD];
        rates.rod.speed = angle_acceleration[ROD];
        let joints = [&mut rates.joint_a, &mut rates.joint_b, &mut rates.joint_c];
        for (pin, (joint, ideal)) in Pin::ALL.into_iter().zip(joints.into_iter().zip([a, b, c])) {
            if !ideal {
                joint.eccentricity = pose.journal(pin).rate.into();
            }
        }
        let accuracy = self.accuracy(evaluation);
        rates.accuracy.position = accuracy.velocity;
        rates.accuracy.velocity = accuracy.acceleration;
    }

    fn guide(&self, ideal: bool, r: &Reactions, contacts: &Contacts, penetration: &[f64; 3 + CORNERS]) -> GuideOutputs {
        let deepest = penetration[3..].iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let touching = penetration[3..].iter().zip(contact_of_corner(self.surface)).filter(|(depth, contact)| {
            contacts[3 + contact].closed && (self.surface == Surface::Corner || **depth > 0.0)
        });
        GuideOutputs {
            force: r.t.into(),
            moment: r.moment,
            penetration: if ideal { 0.0 } else { deepest },
            contacts: touching.map(|_| 1).sum(),
            ..GuideOutputs::default()
        }
    }

    /// The slider's deviation from the ideal mechanism at the same crank angle, speed and acceleration; zero where the
    /// ideal mechanism cannot be assembled.
    fn accuracy(&self, evaluation: &Evaluation) -> AccuracyOutputs {
        let rotations = &evaluation.pose.rotations;
        let speed = rotations.speed[CRANK];
        let ideal = self.ideal.motion(rotations.rotation[CRANK], speed);
        let exists = ideal.rod.cos > 0.0; // false for NaN, too
        if !exists {
            return AccuracyOutputs::default();
        }
        let acceleration = ideal.x_ratio * evaluation.angle_acceleration[CRANK] + ideal.x_bias;
        AccuracyOutputs {
            position: evaluation.pose.place.pin.x - ideal.x,
            velocity: evaluation.pose.velocity.pin.x - ideal.x_ratio * speed,
            acceleration: evaluation.acceleration.pin.x - acceleration,
        }
    }
}
