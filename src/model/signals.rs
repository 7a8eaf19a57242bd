//! Inputs and outputs of the mechanism, as named in the FMU's interface. Their layout is that of C: two builds of the library
//! exchange these values.

use crate::scene::profile::{Profile, Profiles};
use crate::scene::read::SceneFile;
use serde::{Deserialize, Serialize};
use std::cell::Cell;

/// Inputs at one instant.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[repr(C)]
pub struct Inputs<R = f64> {
    /// [N·m] Torque on the crank; ignored with a speed drive.
    pub crank_torque: R,
    /// [N] Force on the slider along +x at its pin centre.
    pub slider_load: R,
}

impl Inputs {
    /// The inputs of a scene at its start.
    pub fn at_start(file: &SceneFile) -> Self {
        let Profiles { crank_torque, slider_load } = &file.inputs;
        let value = |profile: &Profile| profile.value(0.0, file.scene.crank.angle_start);
        Self { crank_torque: value(crank_torque), slider_load: value(slider_load) }
    }

    /// The values of profiles at the start of a step between two times [s], where the crank moves on from `crank`, and the
    /// slopes of their chords.
    pub fn chords(profiles: &Profiles, step: [f64; 2], crank: &CrankOutputs) -> [Self; 2] {
        let Profiles { crank_torque, slider_load } = profiles;
        let [torque, load] = [crank_torque, slider_load].map(|profile| profile.chord(step, crank.angle, crank.speed));
        [
            Self { crank_torque: torque.value, slider_load: load.value },
            Self { crank_torque: torque.slope, slider_load: load.slope },
        ]
    }
}

/// Outputs at one instant.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct Outputs {
    /// Motion of the slider.
    pub slider: SliderOutputs,
    /// Motion of the crank.
    pub crank: CrankOutputs,
    /// Motion of the rod.
    pub rod: RodOutputs,
    /// Main bearing: force of the ground on the crank.
    pub joint_a: RevoluteOutputs,
    /// Crank pin: force of the crank on the rod.
    pub joint_b: RevoluteOutputs,
    /// Slider pin: force of the rod on the slider.
    pub joint_c: RevoluteOutputs,
    /// Guide: force on the slider.
    pub joint_t: GuideOutputs,
    /// [N·m] Torque on the crank: the input, or that of the speed drive.
    pub drive_torque: f64,
    /// [W] Power of that torque.
    pub drive_power: f64,
    /// Deviation of the slider from the ideal rigid mechanism at the same crank motion.
    pub accuracy: AccuracyOutputs,
    /// Energies, works and losses with an audit; all 0 without one.
    pub energy: EnergyOutputs,
    /// Work of the integrator since the start, and its settings in use.
    pub solver: SolverOutputs,
}

/// Motion of the slider.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct SliderOutputs {
    /// [m] Position of the pin's centre along the guide.
    pub x: f64,
    /// [m/s] Velocity of the pin along the guide.
    pub v: f64,
    /// [m/s²] Acceleration of the pin along the guide.
    pub a: f64,
    /// [m] Position of the pin's centre across the guide.
    pub y: f64,
    /// [rad] Tilt of the slider.
    pub angle: f64,
}

/// Motion of the crank.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct CrankOutputs {
    /// [rad] Angle, not wrapped to one turn.
    pub angle: f64,
    /// [rad/s] Angular velocity.
    pub speed: f64,
    /// [rad/s²] Angular acceleration.
    pub acceleration: f64,
}

/// Motion of the rod.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct RodOutputs {
    /// [rad] Angle.
    pub angle: f64,
    /// [rad/s] Angular velocity.
    pub speed: f64,
    /// [m] Deflection at mid-span; 0 for a rigid rod.
    pub deflection: f64,
    /// [m] Change of the distance between its ends; 0 for a rigid rod.
    pub stretch: f64,
}

/// State and force of a revolute joint.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct RevoluteOutputs {
    /// [N] x and y components of the joint force.
    pub force: [f64; 2],
    /// [m] Eccentricity: journal centre minus bearing centre.
    pub eccentricity: [f64; 2],
    /// [m] Penetration; negative if open, 0 for an ideal joint.
    pub penetration: f64,
    /// [N] Force of the oil film's pressure.
    pub film_force: f64,
    /// [N·m] Moment of the oil film on the journal's body, about the journal's centre.
    pub film_moment: f64,
    /// What happened since the last communication point, and since the start.
    pub interval: IntervalOutputs,
    /// Whether the contact is closed.
    pub contact: bool,
}

/// What happened in a joint since the last communication point, and since the start.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct IntervalOutputs {
    /// [m/s] Largest approach speed at a touch since the last communication point; 0 if there was none.
    pub impact_speed: f64,
    /// [N] Largest joint force since the last communication point, if it is asked for; 0 otherwise.
    pub force_peak: f64,
    /// [J] Work of friction since the start, if it is asked for; 0 otherwise.
    pub friction_work: f64,
    /// [m] Sliding distance in contact since the start, if it is asked for; 0 otherwise.
    pub sliding: f64,
    /// [J] Normal force times sliding distance since the start, if it is asked for; 0 otherwise.
    pub wear_work: f64,
    /// Number of touches since the start; of the guide those of its corners or faces.
    pub impacts: i32,
}

/// State and force of the guide.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct GuideOutputs {
    /// [N] x and y components of the force on the slider.
    pub force: [f64; 2],
    /// [N·m] Couple about the slider's pin.
    pub moment: f64,
    /// [m] Penetration of the deepest corner; negative if open, 0 for an ideal guide.
    pub penetration: f64,
    /// What happened since the last communication point, and since the start.
    pub interval: IntervalOutputs,
    /// Number of corners in contact.
    pub contacts: i32,
}

/// Motion of the slider less that of the ideal rigid mechanism.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct AccuracyOutputs {
    /// [m] Difference of positions.
    pub position: f64,
    /// [m/s] Difference of velocities.
    pub velocity: f64,
    /// [m/s²] Difference of accelerations.
    pub acceleration: f64,
}

/// [J] Energies, and works and losses since the start.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct EnergyOutputs {
    /// Kinetic energy.
    pub kinetic: f64,
    /// Potential energy: gravity (heights from y = 0), elastic rod and contacts.
    pub potential: f64,
    /// Work of torque and slider load.
    pub input: f64,
    /// Loss in contacts, friction, viscous and modal damping.
    pub dissipated: f64,
    /// Residual of the energy balance: change of (kinetic + potential) − input + dissipated.
    pub residual: f64,
    /// Part of `potential` from gravity.
    pub gravity: f64,
    /// Part of `potential` in the elastic rod.
    pub elastic: f64,
    /// Part of `potential` in the contacts.
    pub contact: f64,
    /// Part of `input` from the torque.
    pub torque_work: f64,
    /// Part of `input` from the slider load.
    pub load_work: f64,
    /// Part of `dissipated` from hysteresis of the contacts.
    pub contact_loss: f64,
    /// Part of `dissipated` from friction of the contacts.
    pub friction_loss: f64,
    /// Part of `dissipated` from viscous friction and oil films.
    pub viscous_loss: f64,
    /// Part of `dissipated` from modal damping.
    pub modal_loss: f64,
}

/// Work of the integrator since the start, and its settings in use.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct SolverOutputs {
    /// Number of accepted steps.
    pub steps: i32,
    /// Number of rejected steps.
    pub rejected: i32,
    /// Number of evaluations of the right-hand side.
    pub evaluations: i32,
    /// Number of openings and closings of contacts.
    pub events: i32,
    /// Number of steps with a larger error than the tolerance allows, for lack of evaluations.
    pub deadline_hits: i32,
    /// Estimated error of position in the last communication step, in clearances.
    pub error_estimate: f64,
    /// Relative tolerance in use.
    pub tolerance_used: f64,
    /// Whether the library for every processor computes, rather than that for newer ones.
    pub portable_used: bool,
}

impl Outputs {
    /// Whether all real outputs are finite.
    pub fn is_finite(&self) -> bool {
        let all = Cell::new(true);
        self.combined(self, |value, _| {
            all.set(all.get() && value.is_finite());
            value
        });
        all.get()
    }

    /// [N] Magnitudes of the forces of A, B, C and T.
    pub fn joint_forces(&self) -> [f64; 4] {
        let Self { joint_a, joint_b, joint_c, joint_t, .. } = self;
        [joint_a.force, joint_b.force, joint_c.force, joint_t.force].map(|[x, y]| (x * x + y * y).sqrt())
    }

    /// What happened in a joint: A, B, C or T by their index.
    pub fn interval_mut(&mut self, joint: usize) -> &mut IntervalOutputs {
        match joint {
            0 => &mut self.joint_a.interval,
            1 => &mut self.joint_b.interval,
            2 => &mut self.joint_c.interval,
            _ => &mut self.joint_t.interval,
        }
    }

    /// Zeros, and NaN for outputs that tell what happened in an interval or in a joint since the start: the state does not
    /// determine them, and they have no derivative.
    pub fn undetermined() -> Self {
        let nan = f64::NAN;
        let happened = IntervalOutputs {
            impact_speed: nan,
            force_peak: nan,
            friction_work: nan,
            sliding: nan,
            wear_work: nan,
            impacts: 0,
        };
        let mut outputs = Self::default();
        for joint in 0..4 {
            *outputs.interval_mut(joint) = happened;
        }
        outputs.solver.error_estimate = nan;
        outputs
    }

    /// Applies `combine` to each real output of both; integers and Booleans are 0 and false.
    pub fn combined(&self, other: &Self, combine: impl Fn(f64, f64) -> f64 + Copy) -> Self {
        let pair = |a: [f64; 2], b: [f64; 2]| [combine(a[0], b[0]), combine(a[1], b[1])];
        let interval = |a: &IntervalOutputs, b: &IntervalOutputs| IntervalOutputs {
            impact_speed: combine(a.impact_speed, b.impact_speed),
            force_peak: combine(a.force_peak, b.force_peak),
            friction_work: combine(a.friction_work, b.friction_work),
            sliding: combine(a.sliding, b.sliding),
            wear_work: combine(a.wear_work, b.wear_work),
            impacts: 0,
        };
        let revolute = |a: &RevoluteOutputs, b: &RevoluteOutputs| RevoluteOutputs {
            force: pair(a.force, b.force),
            eccentricity: pair(a.eccentricity, b.eccentricity),
            penetration: combine(a.penetration, b.penetration),
            film_force: combine(a.film_force, b.film_force),
            film_moment: combine(a.film_moment, b.film_moment),
            interval: interval(&a.interval, &b.interval),
            contact: false,
        };
        let (a, b) = (self, other);
        Self {
            slider: SliderOutputs {
                x: combine(a.slider.x, b.slider.x),
                v: combine(a.slider.v, b.slider.v),
                a: combine(a.slider.a, b.slider.a),
                y: combine(a.slider.y, b.slider.y),
                angle: combine(a.slider.angle, b.slider.angle),
            },
            crank: CrankOutputs {
                angle: combine(a.crank.angle, b.crank.angle),
                speed: combine(a.crank.speed, b.crank.speed),
                acceleration: combine(a.crank.acceleration, b.crank.acceleration),
            },
            rod: RodOutputs {
                angle: combine(a.rod.angle, b.rod.angle),
                speed: combine(a.rod.speed, b.rod.speed),
                deflection: combine(a.rod.deflection, b.rod.deflection),
                stretch: combine(a.rod.stretch, b.rod.stretch),
            },
            joint_a: revolute(&a.joint_a, &b.joint_a),
            joint_b: revolute(&a.joint_b, &b.joint_b),
            joint_c: revolute(&a.joint_c, &b.joint_c),
            joint_t: GuideOutputs {
                force: pair(a.joint_t.force, b.joint_t.force),
                moment: combine(a.joint_t.moment, b.joint_t.moment),
                penetration: combine(a.joint_t.penetration, b.joint_t.penetration),
                interval: interval(&a.joint_t.interval, &b.joint_t.interval),
                contacts: 0,
            },
            drive_torque: combine(a.drive_torque, b.drive_torque),
            drive_power: combine(a.drive_power, b.drive_power),
            accuracy: AccuracyOutputs {
                position: combine(a.accuracy.position, b.accuracy.position),
                velocity: combine(a.accuracy.velocity, b.accuracy.velocity),
                acceleration: combine(a.accuracy.acceleration, b.accuracy.acceleration),
            },
            energy: EnergyOutputs {
                kinetic: combine(a.energy.kinetic, b.energy.kinetic),
                potential: combine(a.energy.potential, b.energy.potential),
                input: combine(a.energy.input, b.energy.input),
                dissipated: combine(a.energy.dissipated, b.energy.dissipated),
                residual: combine(a.energy.residual, b.energy.residual),
                gravity: combine(a.energy.gravity, b.energy.gravity),
                elastic: combine(a.energy.elastic, b.energy.elastic),
                contact: combine(a.energy.contact, b.energy.contact),
                torque_work: combine(a.energy.torque_work, b.energy.torque_work),
                load_work: combine(a.energy.load_work, b.energy.load_work),
                contact_loss: combine(a.energy.contact_loss, b.energy.contact_loss),
                friction_loss: combine(a.energy.friction_loss, b.energy.friction_loss),
                viscous_loss: combine(a.energy.viscous_loss, b.energy.viscous_loss),
                modal_loss: combine(a.energy.modal_loss, b.energy.modal_loss),
            },
            solver: SolverOutputs::default(),
        }
    }
}
