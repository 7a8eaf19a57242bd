//! What a scene's parameters must be to each other.

use super::parameter::{PARAMETERS, Parameter, Refusal};
use super::{Contact, DampingLaw, Elasticity, FrictionLaw, JointModel, Point, Scene};
use std::fmt;

/// Least restitution of a damping law whose factor grows without bound towards 0.
pub const LEAST_RESTITUTION: f64 = 0.02;

/// A parameter that does not go with the others.
#[derive(Clone, Debug, PartialEq)]
pub enum SceneError {
    /// A value outside its own range.
    Range(Refusal),
    /// A value that another parameter rules out.
    Conflict {
        /// Name of the parameter.
        name: String,
        /// Its value, in SI units.
        value: f64,
        /// What it must be, in words and numbers.
        allowed: String,
    },
}

impl fmt::Display for SceneError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Range(refusal) => refusal.fmt(f),
            Self::Conflict { name, value, allowed } => {
                write!(f, "{name} = {value:?} is not allowed: {allowed}")
            }
        }
    }
}

impl std::error::Error for SceneError {}

impl SceneError {
    /// Name of the parameter.
    pub fn name(&self) -> &str {
        match self {
            Self::Range(refusal) => refusal.name,
            Self::Conflict { name, .. } => name,
        }
    }
}

impl Scene {
    /// Whether the parameters go together; the first that does not, otherwise. What an ideal joint
    /// does not use is held to its own range only.
    pub fn check(&self) -> Result<(), SceneError> {
        PARAMETERS.iter().try_for_each(|parameter| self.check_range(parameter))?;
        let joints = &self.joint;
        for (letter, joint) in [("A", &joints.a), ("B", &joints.b), ("C", &joints.c)] {
            if joint.model == JointModel::Ideal {
                continue;
            }
            let radius = joint.radius;
            let below_radius = || format!("below joint.{letter}.radius = {radius:?} m");
            rule(joint.clearance < radius, letter, "clearance", joint.clearance, below_radius)?;
            let Point { x, y } = joint.eccentricity_start;
            rule(x.hypot(y) < radius, letter, "eccentricity_start.x", x, || {
                format!("with .y = {y:?} m, less than joint.{letter}.radius = {radius:?} m away")
            })?;
            let width = joint.contact.width;
            let has_width = joint.elasticity != Elasticity::Liu || width > 0.0;
            rule(has_width, letter, "width", width, || "above 0 m for elasticity liu".into())?;
            check_contact(letter, &joint.contact)?;
        }
        if joints.t.model == JointModel::Clearance {
            check_contact("T", &joints.t.contact)?;
        }
        self.check_closure()
    }

    fn check_range(&self, parameter: &Parameter) -> Result<(), SceneError> {
        // On a copy: writing is what knows the range.
        let mut copy = Self::clone(self);
        parameter.write(&mut copy, parameter.value(self)).map_err(SceneError::Range)
    }

    /// The rod must reach the slider's height at the start.
    fn check_closure(&self) -> Result<(), SceneError> {
        let start = |joint: &super::Revolute| match joint.model {
            JointModel::Ideal => 0.0,
            JointModel::Clearance => joint.eccentricity_start.y,
        };
        let joints = &self.joint;
        let big_end = start(&joints.a) + self.crank.length * self.crank.angle_start.sin() - start(&joints.b);
        let offset = match joints.t.model {
            JointModel::Ideal => 0.0,
            JointModel::Clearance => joints.t.offset_start,
        };
        let small_end = self.guide.offset + offset - self.slider.centre.y - start(&joints.c);
        // l·sin θ2 = small_end − big_end; at sin θ2 = ±1 the rod's speed has no bound.
        let rise = (small_end - big_end).abs();
        let length = self.rod.length;
        if rise < length {
            return Ok(());
        }
        let allowed = format!("above {rise:?} m, for the rod to reach the slider at the start");
        Err(SceneError::Conflict { name: "rod.length".into(), value: length, allowed })
    }
}

fn check_contact(letter: &str, contact: &Contact) -> Result<(), SceneError> {
    let (law, restitution) = (contact.law, contact.restitution);
    let grows = matches!(law, DampingLaw::Gonthier | DampingLaw::ZhangSharf | DampingLaw::Flores | DampingLaw::HuGuo);
    let bounded = !grows || restitution >= LEAST_RESTITUTION;
    rule(bounded, letter, "restitution", restitution, || format!("{LEAST_RESTITUTION} to 1 for law {}", law.name()))?;
    let friction = &contact.friction;
    let rises = friction.law != FrictionLaw::Ambrosio || friction.v0 < friction.v1;
    rule(rises, letter, "friction.v0", friction.v0, || {
        format!("below joint.{letter}.friction.v1 = {:?} m/s for law ambrosio", friction.v1)
    })
}

fn rule(holds: bool, letter: &str, what: &str, value: f64, allowed: impl FnOnce() -> String) -> Result<(), SceneError> {
    if holds {
        return Ok(());
    }
    let name = format!("joint.{letter}.{what}");
    Err(SceneError::Conflict { name, value, allowed: allowed() })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refused(edit: impl FnOnce(&mut Scene)) -> String {
        let mut scene = Scene::default();
        edit(&mut scene);
        scene.check().expect_err("a scene that contradicts itself").to_string()
    }

    #[test]
    fn the_declared_scene_is_legal() {
        assert_eq!(Scene::default().check(), Ok(()));
    }

    #[test]
    fn an_ideal_joint_ignores_its_contact() {
        let mut scene = Scene::default();
        scene.joint.b.clearance = 0.02;
        scene.joint.b.contact.restitution = 0.0;
        scene.joint.b.contact.law = DampingLaw::Flores;
        scene.joint.b.eccentricity_start.y = 0.1;
        assert_eq!(scene.check(), Ok(()));
    }

    #[test]
    fn a_conflict_names_parameter_value_and_what_is_allowed() {
        let clearance = |scene: &mut Scene| scene.joint.c.model = JointModel::Clearance;
        let error = refused(|scene| {
            clearance(scene);
            scene.joint.c.clearance = 0.01;
        });
        assert_eq!(error, "joint.C.clearance = 0.01 is not allowed: below joint.C.radius = 0.01 m");
        let error = refused(|scene| {
            clearance(scene);
            scene.joint.c.contact.law = DampingLaw::HuGuo;
            scene.joint.c.contact.restitution = 0.01;
        });
        assert_eq!(error, "joint.C.restitution = 0.01 is not allowed: 0.02 to 1 for law hu_guo");
        let error = refused(|scene| {
            clearance(scene);
            scene.joint.c.contact.friction.law = FrictionLaw::Ambrosio;
            scene.joint.c.contact.friction.v0 = 0.02;
        });
        assert!(error.starts_with("joint.C.friction.v0 = 0.02 is not allowed"), "{error}");
        let error = refused(|scene| {
            clearance(scene);
            scene.joint.c.elasticity = Elasticity::Liu;
            scene.joint.c.contact.width = 0.0;
        });
        assert!(error.starts_with("joint.C.width = 0.0 is not allowed"), "{error}");
    }

    #[test]
    fn a_value_outside_its_range_is_refused() {
        let error = refused(|scene| scene.rod.mass = -1.0);
        assert_eq!(error, "rod.mass = -1 is not allowed: 1e-9 to 10000000.0 kg");
        let error = refused(|scene| scene.gravity = f64::NAN);
        assert!(error.starts_with("gravity = NaN is not allowed"), "{error}");
    }

    #[test]
    fn a_rod_that_does_not_reach_is_refused_and_eccentricities_count() {
        let error = refused(|scene| scene.guide.offset = 0.12);
        assert!(error.starts_with("rod.length = 0.12 is not allowed: above 0.12 m"), "{error}");
        let mut scene = Scene::default();
        scene.guide.offset = 0.12;
        scene.joint.a.model = JointModel::Clearance;
        scene.joint.a.eccentricity_start.y = 1e-4;
        assert_eq!(scene.check(), Ok(()));
    }
}
