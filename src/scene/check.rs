//! Consistency checks between the parameters of a scene.

use super::closure::{rise, rod_sine};
use super::data::{Contact, Point, Revolute, Scene, Slider};
use super::enumerations::{JointModel, Lubrication, Method, Surface};
use super::error::{SceneError, rule};
use super::parameter::{PARAMETERS, Parameter};
use crate::model_description::number::number;

/// Smallest restitution for a damping law whose factor is unbounded as the restitution tends to 0.
pub const LEAST_RESTITUTION: f64 = 0.02;
/// Largest roughness of a lubricated joint over its clearance.
pub const MAX_ROUGHNESS: f64 = 0.1;
/// Largest Poisson's ratio of an elastic layer; an incompressible layer would be rigid.
const MAX_POISSON_OF_LAYER: f64 = 0.49;

impl Scene {
    /// Checks every parameter's range and the consistency of all parameters. Parameters that an ideal joint does not
    /// use are only checked for their range.
    ///
    /// # Errors
    /// The first parameter that is not allowed.
    pub fn check(&self) -> Result<(), SceneError> {
        let in_range = |parameter: &Parameter| parameter.admit(parameter.value(self)).map_err(SceneError::Range);
        PARAMETERS.iter().try_for_each(in_range)?;
        self.check_method()?;
        let joints = &self.joint;
        // Rigid contacts do not use the parameters of compliant contacts.
        let compliant = self.solver.method != Method::Moreau;
        for (letter, joint) in [("A", &joints.a), ("B", &joints.b), ("C", &joints.c)] {
            if joint.model == JointModel::Ideal {
                continue;
            }
            let radius = joint.radius;
            let below_radius = || format!("below joint.{letter}.radius = {} m", number(radius));
            rule(joint.clearance < radius, letter, "clearance", joint.clearance, below_radius)?;
            let Point { x, y } = joint.eccentricity_start;
            rule(libm::hypot(x, y) < radius, letter, "eccentricity_start.x", x, || {
                format!("with .y = {} m, less than joint.{letter}.radius = {} m away", number(y), number(radius))
            })?;
            if !compliant {
                continue;
            }
            let width = joint.contact.width;
            let elasticity = joint.elasticity;
            rule(!elasticity.has("needs width") || width > 0.0, letter, "width", width, || {
                format!("above 0 m for elasticity {}", elasticity.name())
            })?;
            if elasticity.has("has a layer") && joint.layer.stiffness == 0.0 {
                check_layer(letter, joint)?;
            }
            check_contact(letter, &joint.contact)?;
            if joint.lubrication != Lubrication::None {
                check_oil(letter, joint)?;
            }
        }
        let guide = &joints.t;
        if guide.model == JointModel::Clearance && compliant {
            let width = guide.contact.width;
            let half_space = guide.surface == Surface::Foundation && guide.foundation_stiffness == 0.0;
            rule(!half_space || width > 0.0, "T", "width", width, || {
                "above 0 m for surface foundation, unless joint.T.foundation_stiffness is given".into()
            })?;
            check_contact("T", &guide.contact)?;
        }
        let Slider { load_offset: offset, height, .. } = self.slider;
        if offset.abs() > height {
            let allowed = format!("at most slider.height = {} m to either side of the pin", number(height));
            return Err(SceneError::Conflict { name: "slider.load.offset".into(), value: offset, allowed });
        }
        self.check_modes()?;
        self.check_closure()
    }

    /// Checks the modal table and that it has the requested modes.
    fn check_modes(&self) -> Result<(), SceneError> {
        let flexible = &self.rod.flexible;
        let Some(table) = &flexible.table else {
            return Ok(());
        };
        table.check().map_err(SceneError::Table)?;
        for (kind, asked, given) in [
            ("bending", flexible.bending_modes, table.bending.len()),
            ("axial", flexible.axial_modes, table.axial.len()),
        ] {
            if usize::try_from(asked).is_ok_and(|asked| asked > given) {
                let name = format!("rod.flexible.{kind}_modes");
                let allowed = format!("at most {given}, the {kind} modes of rod.flexible.table");
                return Err(SceneError::Conflict { name, value: f64::from(asked), allowed });
            }
        }
        Ok(())
    }

    /// Checks that the rod reaches the slider's height in the start pose.
    fn check_closure(&self) -> Result<(), SceneError> {
        if rod_sine(self).abs() < 1.0 {
            return Ok(());
        }
        let allowed = format!("above {} m, for the rod to reach the slider at the start", number(rise(self).abs()));
        Err(SceneError::Conflict { name: "rod.length".into(), value: self.rod.length, allowed })
    }
}

/// An elastic layer whose stiffness follows from its material: its thickness and Poisson's ratio.
fn check_layer(letter: &str, joint: &Revolute) -> Result<(), SceneError> {
    let (law, thickness, poisson) = (joint.elasticity.name(), joint.layer.thickness, joint.contact.poisson.bearing);
    rule(thickness > 0.0, letter, "layer.thickness", thickness, || {
        format!("above 0 m for elasticity {law}, unless joint.{letter}.layer.stiffness is given")
    })?;
    rule(poisson <= MAX_POISSON_OF_LAYER, letter, "poisson.bearing", poisson, || {
        format!("0 to {MAX_POISSON_OF_LAYER} for elasticity {law}, unless joint.{letter}.layer.stiffness is given")
    })
}

/// A lubricated joint: the length of its bearing and the roughness of its surfaces.
fn check_oil(letter: &str, joint: &Revolute) -> Result<(), SceneError> {
    let (width, roughness, most) = (joint.contact.width, joint.roughness, MAX_ROUGHNESS * joint.clearance);
    rule(width > 0.0, letter, "width", width, || "above 0 m for lubrication short_bearing".into())?;
    rule(roughness > 0.0 && roughness <= most, letter, "roughness", roughness, || {
        format!("above 0 m, at most {} m, a tenth of joint.{letter}.clearance, with lubrication", number(most))
    })
}

fn check_contact(letter: &str, contact: &Contact) -> Result<(), SceneError> {
    let (law, restitution) = (contact.law, contact.restitution);
    let bounded = !law.has("grows without bound") || restitution >= LEAST_RESTITUTION;
    rule(bounded, letter, "restitution", restitution, || format!("{LEAST_RESTITUTION} to 1 for law {}", law.name()))?;
    let friction = &contact.friction;
    let (law, name) = (friction.law, friction.law.name());
    let rises = !law.has("ramp") || friction.v0 < friction.v1;
    rule(rises, letter, "friction.v0", friction.v0, || {
        format!("below joint.{letter}.friction.v1 = {} m/s for law {name}", number(friction.v1))
    })?;
    // A bristle law divides by its steady-state coefficient, which lies between the kinetic and the static one.
    let bristles = law.has("bristles");
    let (kinetic, still) = (friction.coefficient, friction.static_coefficient);
    rule(!bristles || kinetic > 0.0, letter, "friction.coefficient", kinetic, || format!("above 0 for law {name}"))?;
    rule(!bristles || still >= kinetic, letter, "friction.static_coefficient", still, || {
        format!("at least joint.{letter}.friction.coefficient = {} for law {name}", number(kinetic))
    })
}

#[cfg(test)]
mod tests {
    use super::super::{DampingLaw, Elasticity, FrictionLaw};
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
        assert!(error.starts_with("joint.C.width = 0 is not allowed"), "{error}");
    }

    #[test]
    fn lugre_needs_friction_that_does_not_grow_with_speed() {
        let lugre = |kinetic: f64, still: f64| {
            move |scene: &mut Scene| {
                scene.joint.t.model = JointModel::Clearance;
                let friction = &mut scene.joint.t.contact.friction;
                friction.law = FrictionLaw::Lugre;
                (friction.coefficient, friction.static_coefficient) = (kinetic, still);
            }
        };
        let error = refused(lugre(0.0, 0.1));
        assert_eq!(error, "joint.T.friction.coefficient = 0 is not allowed: above 0 for law lugre");
        let error = refused(lugre(0.1, 0.05));
        let wanted = "joint.T.friction.static_coefficient = 0.05 is not allowed: \
                      at least joint.T.friction.coefficient = 0.1 for law lugre";
        assert_eq!(error, wanted);
        let mut scene = Scene::default();
        lugre(0.1, 0.1)(&mut scene);
        assert_eq!(scene.check(), Ok(()));
        lugre(0.1, 0.05)(&mut scene);
        scene.joint.t.model = JointModel::Ideal;
        assert_eq!(scene.check(), Ok(()), "an ideal guide has no friction");
    }

    #[test]
    fn a_half_space_needs_a_width() {
        let wide = |width: f64, stiffness: f64| {
            let mut scene = Scene::default();
            scene.joint.t.model = JointModel::Clearance;
            scene.joint.t.surface = Surface::Foundation;
            scene.joint.t.contact.width = width;
            scene.joint.t.foundation_stiffness = stiffness;
            scene
        };
        let error = wide(0.0, 0.0).check().expect_err("a face without width").to_string();
        assert!(error.starts_with("joint.T.width = 0 is not allowed: above 0 m for surface foundation"), "{error}");
        assert_eq!(wide(0.0, 1e9).check(), Ok(()));
        assert_eq!(wide(1e-3, 0.0).check(), Ok(()));
        let mut corners = wide(0.0, 0.0);
        corners.joint.t.surface = Surface::Corner;
        assert_eq!(corners.check(), Ok(()));
    }

    #[test]
    fn a_value_outside_its_range_is_refused() {
        let error = refused(|scene| scene.rod.mass = -1.0);
        assert_eq!(error, "rod.mass = -1 is not allowed: 1e-12 to 1e7 kg");
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
