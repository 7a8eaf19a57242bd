//! Outputs of a motion: the solver's numbers as the FMU names them.

use crate::constraints::{Constraints, Solution};
use crate::contact::eccentricity;
use crate::coordinates::{CRANK, ROD, SLIDER, Vector, cross, perp};
use crate::loads::Loads;
use crate::mechanism::{JointModel, Mechanism};
use crate::signals::{
    AccuracyOutputs, CrankOutputs, GuideOutputs, Outputs, RevoluteOutputs, RodOutputs, SliderOutputs,
};
use crate::solver::Reference;

impl Reference {
    /// Everything of the model's §8.
    pub fn outputs(&self) -> Outputs {
        let (motion, bodies) = (&self.motion, &self.bodies);
        let loads = self.loads(self.time, motion);
        let solution = self.constraints.accelerate(bodies, self.time, motion, &loads.generalized);
        let pin = &bodies.journals[2];
        let acceleration = pin.jacobian(motion) * solution.acceleration + pin.drift(motion);
        let (position, velocity) = (pin.position(motion), pin.velocity(motion));
        let crank = CrankOutputs {
            angle: motion.angle(CRANK),
            speed: motion.spin(CRANK),
            acceleration: solution.acceleration[3 * CRANK + 2],
        };
        let ideal = ideal_slider(&self.mechanism, crank);
        let [joint_a, joint_b, joint_c] = [0, 1, 2].map(|k| self.revolute(k, &loads, &solution));
        Outputs {
            slider: SliderOutputs {
                x: position.x,
                v: velocity.x,
                a: acceleration.x,
                y: position.y,
                angle: motion.angle(SLIDER),
            },
            crank,
            rod: RodOutputs {
                angle: motion.angle(ROD),
                speed: motion.spin(ROD),
                deflection: bodies.beam.as_ref().map_or(0.0, |beam| beam.middle.place(&motion.modes()).y),
                stretch: bodies.beam.as_ref().map_or(0.0, |beam| beam.small_end.stretch(&motion.modes())),
            },
            joint_a,
            joint_b,
            joint_c,
            joint_t: self.guide(&loads, &solution),
            drive_torque: self.drive_torque(self.inputs_at(self.time), &solution),
            drive_power: self.drive_torque(self.inputs_at(self.time), &solution) * motion.spin(CRANK),
            accuracy: AccuracyOutputs {
                position: position.x - ideal[0],
                velocity: velocity.x - ideal[1],
                acceleration: acceleration.x - ideal[2],
            },
            energy: self.audit(),
        }
    }

    fn revolute(&self, k: usize, loads: &Loads, solution: &Solution) -> RevoluteOutputs {
        // A and C are named for the force on the journal's body, B for that on the bearing's.
        let named = |on_journal: Vector| if k == 1 { (-on_journal).into() } else { on_journal.into() };
        let Some(contact) = &self.contacts[k] else {
            let reaction = Constraints::revolute_reaction(solution, k);
            return RevoluteOutputs { force: named(reaction), ..RevoluteOutputs::default() };
        };
        let e = eccentricity(&self.bodies.bearings[k], &self.bodies.journals[k], &self.motion);
        RevoluteOutputs {
            force: named(loads.on_journal[k]),
            eccentricity: e.into(),
            penetration: contact.touch(&self.motion, &self.phases[k]).depths[0],
            film_force: loads.films[k].0.norm(),
            film_moment: loads.films[k].1,
            impact_speed: self.touches(&[k]).0,
            impacts: self.touches(&[k]).1,
            contact: self.phases[k].closed(),
        }
    }

    /// Speed of the fastest touch in the last interval, and number since the start.
    fn touches(&self, contacts: &[usize]) -> (f64, i32) {
        let all = self.crossings.iter().filter(|crossing| crossing.begins && contacts.contains(&crossing.contact));
        let mut touches = (0.0_f64, 0);
        for crossing in all {
            touches.1 += 1;
            if crossing.time > self.interval_start {
                touches.0 = touches.0.max(crossing.approach);
            }
        }
        touches
    }

    fn guide(&self, loads: &Loads, solution: &Solution) -> GuideOutputs {
        let motion = &self.motion;
        if self.mechanism.joint.t.model == JointModel::Ideal {
            let (height, couple) = Constraints::guide_reaction(solution);
            let reaction = height * Vector::y();
            let lever = self.bodies.centre.position(motion) - self.bodies.journals[2].position(motion);
            return GuideOutputs {
                force: (loads.on_slider + reaction).into(),
                moment: loads.about_pin + couple + cross(lever, reaction),
                ..GuideOutputs::default()
            };
        }
        let depths = self.contacts[3..]
            .iter()
            .zip(&self.phases[3..])
            .filter_map(|(contact, phase)| contact.as_ref().map(|contact| contact.touch(motion, phase).depths));
        GuideOutputs {
            force: loads.on_slider.into(),
            moment: loads.about_pin,
            penetration: depths.flatten().fold(f64::NEG_INFINITY, f64::max),
            impact_speed: self.touches(&[3, 4, 5, 6]).0,
            impacts: self.touches(&[3, 4, 5, 6]).1,
            contacts: self.phases[3..].iter().flat_map(|phase| phase.inside.map(i32::from)).sum(),
        }
    }
}

/// Position, velocity and acceleration of the ideal mechanism's slider at this crank motion.
fn ideal_slider(mechanism: &Mechanism, crank: CrankOutputs) -> [f64; 3] {
    let height = mechanism.guide.offset - mechanism.slider.centre.y;
    let (sin, cos) = crank.angle.sin_cos();
    let to_pin = mechanism.crank.length * Vector::new(cos, sin);
    let rod_angle = ((height - to_pin.y) / mechanism.rod.length).asin();
    let along_rod = mechanism.rod.length * Vector::new(rod_angle.cos(), rod_angle.sin());
    // Each rate of the rod from: the pin's height, its rate and its acceleration do not change.
    let rod_speed = -crank.speed * to_pin.x / along_rod.x;
    let velocity = crank.speed * perp(to_pin) + rod_speed * perp(along_rod);
    let turning = crank.acceleration * perp(to_pin) - crank.speed.powi(2) * to_pin - rod_speed.powi(2) * along_rod;
    let rod_acceleration = -turning.y / along_rod.x;
    let acceleration = turning + rod_acceleration * perp(along_rod);
    [to_pin.x + along_rod.x, velocity.x, acceleration.x]
}
