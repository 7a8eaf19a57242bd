//! Checks whether an integration method supports a scene. Rigid contacts do not support flexible rods, bristles,
//! elastic foundations, oil films and energy audits.

use super::data::{Audit, Point, Scene, Solver};
use super::enumerations::{FrictionLaw, JointModel, Lubrication, Method, Surface};
use super::error::{SceneError, rule};
use crate::model_description::number::number;

impl Scene {
    /// Checks that the method supports the scene.
    ///
    /// # Errors
    /// The first parameter that the method does not support.
    pub(crate) fn check_method(&self) -> Result<(), SceneError> {
        let Solver { method, deadline, .. } = self.solver;
        if deadline > 0.0 && method.has("fixed step") {
            let allowed = format!(
                "0 for method {}, whose steps have a fixed length; solver.step decides how many evaluations they take",
                method.name()
            );
            return Err(SceneError::Conflict { name: "solver.deadline".into(), value: deadline, allowed });
        }
        if method != Method::Moreau {
            return Ok(());
        }
        let flexible = &self.rod.flexible;
        for (name, value, allowed) in [
            ("rod.flexible.bending_modes", flexible.bending_modes, "0 for method moreau, whose bodies are rigid"),
            ("rod.flexible.axial_modes", flexible.axial_modes, "0 for method moreau, whose bodies are rigid"),
            ("energy.audit", i32::from(self.energy.audit), "false for method moreau, whose impacts take no time"),
        ] {
            if value != 0 {
                let (name, value, allowed) = (name.to_owned(), f64::from(value), allowed.to_owned());
                return Err(SceneError::Conflict { name, value, allowed });
            }
        }
        let joints = &self.joint;
        for (letter, [peak, wear]) in [
            ("A", [joints.a.peak, joints.a.wear]),
            ("B", [joints.b.peak, joints.b.wear]),
            ("C", [joints.c.peak, joints.c.wear]),
            ("T", [joints.t.peak, joints.t.wear]),
        ] {
            for (name, Audit { audit }) in [("peak.audit", peak), ("wear.audit", wear)] {
                rule(!audit, letter, name, f64::from(u8::from(audit)), || {
                    "false for method moreau, whose impacts take no time".into()
                })?;
            }
        }
        for (letter, joint) in [("A", &joints.a), ("B", &joints.b), ("C", &joints.c)] {
            if joint.model == JointModel::Clearance {
                check_friction(letter, joint.contact.friction.law)?;
                let oil = joint.lubrication;
                rule(oil == Lubrication::None, letter, "lubrication", f64::from(oil.value()), || {
                    format!("{} (none) for method moreau", Lubrication::None.value())
                })?;
                let Point { x, y } = joint.eccentricity_start;
                rule(libm::hypot(x, y) <= joint.clearance, letter, "eccentricity_start.x", x, || {
                    let (y, clearance) = (number(y), number(joint.clearance));
                    format!("with .y = {y} m, at most joint.{letter}.clearance = {clearance} m away for method moreau")
                })?;
            }
        }
        let guide = &joints.t;
        if guide.model == JointModel::Clearance {
            check_friction("T", guide.contact.friction.law)?;
            let corner = guide.surface == Surface::Corner;
            rule(corner, "T", "surface", f64::from(guide.surface.value()), || {
                format!("{} (corner) for method moreau", Surface::Corner.value())
            })?;
            rule(guide.offset_start.abs() <= guide.clearance, "T", "offset_start", guide.offset_start, || {
                format!("at most joint.T.clearance = {} m either way for method moreau", number(guide.clearance))
            })?;
        }
        Ok(())
    }
}

fn check_friction(letter: &str, law: FrictionLaw) -> Result<(), SceneError> {
    rule(!law.has("bristles"), letter, "friction.law", f64::from(law.value()), || {
        "none or any law but lugre for method moreau, which takes its coefficient for Coulomb's".into()
    })
}

#[cfg(test)]
mod tests {
    use super::super::DampingLaw;
    use super::*;

    /// Clearance in all joints.
    fn worn() -> Scene {
        let mut scene = Scene::default();
        scene.solver.method = Method::Moreau;
        let joint = &mut scene.joint;
        for model in [&mut joint.a.model, &mut joint.b.model, &mut joint.c.model, &mut joint.t.model] {
            *model = JointModel::Clearance;
        }
        scene
    }

    fn refused(edit: impl FnOnce(&mut Scene)) -> String {
        let mut scene = worn();
        edit(&mut scene);
        let error = scene.check().expect_err("more than the method can do").to_string();
        scene.solver.method = Method::Verner7;
        assert_eq!(scene.check(), Ok(()), "another method can");
        error
    }

    #[test]
    fn what_is_not_rigid_is_refused_by_name() {
        assert_eq!(worn().check(), Ok(()));
        let error = refused(|scene| scene.rod.flexible.bending_modes = 2);
        assert_eq!(error, "rod.flexible.bending_modes = 2 is not allowed: 0 for method moreau, whose bodies are rigid");
        let error = refused(|scene| scene.rod.flexible.axial_modes = 1);
        assert!(error.starts_with("rod.flexible.axial_modes = 1 is not allowed: 0 for method moreau"), "{error}");
        let error = refused(|scene| scene.energy.audit = true);
        assert!(error.starts_with("energy.audit = 1 is not allowed: false for method moreau"), "{error}");
        let error = refused(|scene| scene.joint.t.surface = Surface::Foundation);
        assert_eq!(error, "joint.T.surface = 2 is not allowed: 1 (corner) for method moreau");
        let error = refused(|scene| scene.joint.b.contact.friction.law = FrictionLaw::Lugre);
        assert!(error.starts_with("joint.B.friction.law = 5 is not allowed: none or any law but lugre"), "{error}");
        let error = refused(|scene| scene.joint.t.contact.friction.law = FrictionLaw::Lugre);
        assert!(error.starts_with("joint.T.friction.law = 5 is not allowed"), "{error}");
    }

    #[test]
    fn a_start_inside_the_other_body_is_refused() {
        let error = refused(|scene| scene.joint.c.eccentricity_start = Point { x: 4e-4, y: -4e-4 });
        let wanted = "joint.C.eccentricity_start.x = 4e-4 is not allowed: \
                      with .y = -4e-4 m, at most joint.C.clearance = 5e-4 m away for method moreau";
        assert_eq!(error, wanted);
        let error = refused(|scene| scene.joint.t.offset_start = -6e-4);
        assert!(error.starts_with("joint.T.offset_start = -6e-4 is not allowed: at most joint.T.clearance"), "{error}");
    }

    #[test]
    fn what_an_ideal_joint_or_a_compliant_contact_would_use_is_not_looked_at() {
        let mut scene = worn();
        scene.joint.a.contact.law = DampingLaw::Flores;
        scene.joint.a.contact.restitution = 0.0;
        scene.joint.b.contact.friction.law = FrictionLaw::Ambrosio;
        scene.joint.b.contact.friction.v0 = 1.0;
        scene.joint.t.model = JointModel::Ideal;
        scene.joint.t.surface = Surface::Foundation;
        scene.joint.t.contact.friction.law = FrictionLaw::Lugre;
        assert_eq!(scene.check(), Ok(()));
        scene.solver.method = Method::Verner7;
        assert!(scene.check().is_err());
    }
}
