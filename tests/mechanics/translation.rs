//! Scenes in the words of the reference, and what it says in the product's.

use reference_mechanism::{Mechanism, Outputs as Found, signals};
use serde::Deserialize;
use slidercrank::model::signals::{
    AccuracyOutputs, CrankOutputs, EnergyOutputs, GuideOutputs, Inputs, IntervalOutputs, Outputs, RevoluteOutputs,
    RodOutputs, SliderOutputs, SolverOutputs,
};
use slidercrank::scene::{DampingLaw, Elasticity, FrictionLaw, Scene};

/// Field by field, by name: the scene must have every field that the reference asks for, and the reference every item
/// that the scene chooses.
pub fn mechanism(scene: &Scene) -> Mechanism {
    assert!(scene.rod.flexible.table.is_none(), "the reference has no modes but the beam's own");
    let data = toml::Value::try_from(scene).expect("a scene is data");
    Mechanism::deserialize(data).expect("what the reference knows")
}

pub fn inputs(inputs: Inputs) -> signals::Inputs {
    signals::Inputs { crank_torque: inputs.crank_torque, slider_load: inputs.slider_load }
}

/// The solver's counts, which the reference has not, are left at 0.
pub fn outputs(found: &Found) -> Outputs {
    let Found { slider, crank, rod, joint_a, joint_b, joint_c, joint_t, drive_torque, drive_power, accuracy, energy } =
        *found;
    Outputs {
        slider: SliderOutputs { x: slider.x, v: slider.v, a: slider.a, y: slider.y, angle: slider.angle },
        crank: CrankOutputs { angle: crank.angle, speed: crank.speed, acceleration: crank.acceleration },
        rod: RodOutputs { angle: rod.angle, speed: rod.speed, deflection: rod.deflection, stretch: rod.stretch },
        joint_a: revolute(joint_a),
        joint_b: revolute(joint_b),
        joint_c: revolute(joint_c),
        joint_t: GuideOutputs {
            force: joint_t.force,
            moment: joint_t.moment,
            penetration: joint_t.penetration,
            interval: interval(joint_t.impact_speed, joint_t.impacts),
            contacts: joint_t.contacts,
        },
        drive_torque,
        drive_power,
        accuracy: AccuracyOutputs {
            position: accuracy.position,
            velocity: accuracy.velocity,
            acceleration: accuracy.acceleration,
        },
        energy: energies(energy),
        solver: SolverOutputs::default(),
    }
}

fn revolute(joint: signals::RevoluteOutputs) -> RevoluteOutputs {
    RevoluteOutputs {
        force: joint.force,
        eccentricity: joint.eccentricity,
        penetration: joint.penetration,
        film_force: joint.film_force,
        film_moment: joint.film_moment,
        interval: interval(joint.impact_speed, joint.impacts),
        contact: joint.contact,
    }
}

fn interval(impact_speed: f64, impacts: i32) -> IntervalOutputs {
    IntervalOutputs { impact_speed, impacts, ..IntervalOutputs::default() }
}

fn energies(energy: signals::EnergyOutputs) -> EnergyOutputs {
    EnergyOutputs {
        kinetic: energy.kinetic,
        potential: energy.potential,
        input: energy.input,
        dissipated: energy.dissipated,
        residual: energy.residual,
        gravity: energy.gravity,
        elastic: energy.elastic,
        contact: energy.contact,
        torque_work: energy.torque_work,
        load_work: energy.load_work,
        contact_loss: energy.contact_loss,
        friction_loss: energy.friction_loss,
        viscous_loss: energy.viscous_loss,
        modal_loss: energy.modal_loss,
    }
}

#[test]
fn the_declared_scene_is_the_mechanism_that_the_reference_starts_from() {
    assert_eq!(mechanism(&Scene::default()), Mechanism::default());
}

#[test]
fn the_reference_knows_every_law() {
    let told = |change: &dyn Fn(&mut Scene)| {
        let mut scene = Scene::default();
        change(&mut scene);
        mechanism(&scene).joint
    };
    for &law in DampingLaw::ALL {
        assert_eq!(format!("{:?}", told(&|s| s.joint.b.contact.law = law).b.contact.law), format!("{law:?}"));
    }
    for &law in FrictionLaw::ALL {
        let friction = told(&|s| s.joint.t.contact.friction.law = law).t.contact.friction;
        assert_eq!(format!("{:?}", friction.law), format!("{law:?}"));
    }
    for &law in Elasticity::ALL {
        assert_eq!(format!("{:?}", told(&|s| s.joint.a.elasticity = law).a.elasticity), format!("{law:?}"));
    }
}
