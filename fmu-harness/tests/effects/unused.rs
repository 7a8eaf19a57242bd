//! A parameter of an effect that a scene does not call for changes no bit of a run.

use fmu_harness::scenes::{Scenario, ladder};
use slidercrank::model::signals::Inputs;
use slidercrank::scene::parameter::{Kind, PARAMETERS, Parameter};
use slidercrank::scene::{Contact, DampingLaw, Elasticity, FrictionLaw, JointModel, Lubrication, Scene, Surface};
use slidercrank::simulation::{Simulation, Snapshot};

/// [s] Length of a run: some impacts of every joint.
const SPAN: f64 = 3e-3;
/// A run with so many parameters that do nothing shows that the loop looks at them.
const FEWEST: usize = 20;

#[test]
fn a_parameter_of_an_effect_that_is_off_changes_no_bit() {
    for (name, scene) in scenes() {
        let bits = run(&scene);
        let mut tried = 0;
        for parameter in PARAMETERS.iter().filter(|parameter| is_unused(parameter.name, &scene)) {
            for value in others(parameter, &scene) {
                let mut changed = scene.clone();
                parameter.write(&mut changed, value).expect("a legal value");
                if changed.check().is_ok() {
                    assert!(run(&changed) == bits, "{name}: {} = {value}", parameter.name);
                    tried += 1;
                }
            }
        }
        assert!(tried >= FEWEST, "{name}: only {tried} runs");
    }
}

/// The ladder, and scenes with laws that it does not have.
fn scenes() -> Vec<(String, Scene)> {
    let found = |name: String| {
        let scene = Scenario::find(&name).expect("a legal scene").file.scene;
        (name, scene)
    };
    let mut all: Vec<(String, Scene)> = ladder().into_iter().map(found).collect();
    let mut add = |name: &str, edit: fn(&mut Contact)| {
        let mut scene = Scenario::find("effects/05-friction").expect("a legal scene").file.scene;
        let joint = &mut scene.joint;
        let contacts = [&mut joint.a.contact, &mut joint.b.contact, &mut joint.c.contact, &mut joint.t.contact];
        contacts.into_iter().for_each(edit);
        all.push((name.to_owned(), scene));
    };
    add("tanh", |contact| contact.friction.law = FrictionLaw::Tanh);
    add("stribeck", |contact| contact.friction.law = FrictionLaw::Stribeck);
    add("lugre", |contact| (contact.friction.law, contact.friction.sigma0) = (FrictionLaw::Lugre, 1e3));
    add("hertz", |contact| contact.law = DampingLaw::Hertz);
    add("given stiffness", |contact| contact.stiffness = 1e10);
    let mut liu = all[4].1.clone();
    liu.joint.b.elasticity = Elasticity::Liu;
    liu.joint.t.surface = Surface::Foundation;
    liu.joint.t.foundation_stiffness = 1e9;
    let mut bai_zhao = liu.clone();
    bai_zhao.joint.b.elasticity = Elasticity::BaiZhao;
    let mut winkler = liu.clone();
    winkler.joint.b.elasticity = Elasticity::Winkler;
    let mut given_layer = winkler.clone();
    given_layer.joint.b.layer.stiffness = 1e14;
    all.push(("winkler".into(), winkler));
    all.push(("winkler of a given stiffness".into(), given_layer));
    let mut oil = all[4].1.clone();
    oil.joint.b.lubrication = Lubrication::ShortBearing;
    all.push(("oil".into(), oil));
    all.push(("liu and a given foundation".into(), liu));
    all.push(("bai_zhao and a given foundation".into(), bai_zhao));
    all
}

/// Everything that is remembered and everything that comes out, bit for bit.
fn run(scene: &Scene) -> (Vec<u64>, Vec<u64>, String) {
    let mut simulation = Simulation::start(scene, Inputs::default()).expect("a closed loop");
    simulation.advance_to(SPAN).expect("a motion without trouble");
    let Snapshot { reals, integers } = simulation.snapshot();
    // `Debug` prints floats so that they read back the same, signs of zero too.
    (reals.into_iter().map(f64::to_bits).collect(), integers, format!("{:?}", simulation.outputs()))
}

/// Other values that a parameter may have.
fn others(parameter: &Parameter, scene: &Scene) -> Vec<f64> {
    let value = parameter.value(scene);
    let candidates = match parameter.kind {
        Kind::Real { .. } => vec![if value == 0.0 { 1e-3 } else { 1.25 * value }],
        Kind::Integer { .. } => vec![value + 1.0],
        Kind::Boolean { .. } => vec![1.0 - value],
        Kind::Enumeration { items, .. } => items.iter().map(|(_, item)| f64::from(*item)).collect(),
    };
    candidates.into_iter().filter(|other| *other != value && parameter.admit(*other).is_ok()).collect()
}

/// Whether the parameter belongs to an effect that the scene does not call for.
fn is_unused(parameter: &str, scene: &Scene) -> bool {
    let joints = &scene.joint;
    if let Some(own) = parameter.strip_prefix("rod.flexible.") {
        return scene.rod.flexible.bending_modes + scene.rod.flexible.axial_modes == 0 && !own.ends_with("_modes");
    }
    if let Some(own) = parameter.strip_prefix("joint.T.") {
        let faces = joints.t.surface == Surface::Foundation;
        let half_space = faces && joints.t.foundation_stiffness == 0.0;
        return if joints.t.model == JointModel::Ideal {
            is_of_clearance(own)
        } else {
            match own {
                "foundation_stiffness" => !faces,
                "corner_radius" => faces || joints.t.contact.stiffness > 0.0,
                "stiffness" | "exponent" => faces,
                "width" => !half_space,
                own if is_material(own) => {
                    if faces {
                        !half_space
                    } else {
                        joints.t.contact.stiffness > 0.0
                    }
                }
                own => is_unused_by_laws(own, &joints.t.contact),
            }
        };
    }
    for (letter, joint) in [("A", &joints.a), ("B", &joints.b), ("C", &joints.c)] {
        let Some(own) = parameter.strip_prefix("joint.").and_then(|name| name.strip_prefix(letter)) else { continue };
        let own = own.trim_start_matches('.');
        let conformal = joint.elasticity != Elasticity::Hertz;
        let dry = joint.lubrication == Lubrication::None;
        let layer = joint.elasticity == Elasticity::Winkler;
        let layer_of_material = layer && joint.layer.stiffness == 0.0;
        return if joint.model == JointModel::Ideal {
            is_of_clearance(own)
        } else {
            match own {
                "width" => !conformal && dry,
                "viscosity" | "roughness" => dry,
                "stiffness" | "exponent" => conformal,
                "layer.stiffness" => !layer,
                "layer.thickness" => !layer_of_material,
                own if is_material(own) && layer => !layer_of_material || own.ends_with("journal"),
                own if is_material(own) => !conformal && joint.contact.stiffness > 0.0,
                own => is_unused_by_laws(own, &joint.contact),
            }
        };
    }
    match parameter {
        // The beam's stand in their place.
        "rod.mass" | "rod.inertia" | "rod.com.x" | "rod.com.y" => {
            scene.rod.flexible.bending_modes + scene.rod.flexible.axial_modes > 0
        }
        // The slider in an ideal guide neither touches it nor turns.
        "slider.length" | "slider.height" | "slider.inertia" => joints.t.model == JointModel::Ideal,
        "gravity.angle" => scene.gravity == 0.0,
        "solver.step" => true,
        "solver.deadline_interval" => scene.solver.deadline == 0.0,
        _ => false,
    }
}

/// Everything of a joint but the choice itself, and the viscous friction and the audits that an ideal one has too.
fn is_of_clearance(own: &str) -> bool {
    own != "model" && own != "damping" && !own.ends_with(".audit")
}

fn is_material(own: &str) -> bool {
    own.starts_with("young.") || own.starts_with("poisson.")
}

fn is_unused_by_laws(own: &str, contact: &Contact) -> bool {
    if let Some(own) = own.strip_prefix("friction.") {
        let used: &[&str] = match contact.friction.law {
            FrictionLaw::None => &[],
            FrictionLaw::Ambrosio => &["coefficient", "v0", "v1"],
            FrictionLaw::Tanh => &["coefficient", "v1"],
            FrictionLaw::Stribeck => &["coefficient", "static_coefficient", "v1", "v_stribeck"],
            FrictionLaw::Lugre => &["coefficient", "static_coefficient", "v_stribeck", "sigma0", "sigma1", "sigma2"],
        };
        return own != "law" && !used.contains(&own);
    }
    contact.law == DampingLaw::Hertz && ["restitution", "ratio_limit", "speed_floor"].contains(&own)
}
