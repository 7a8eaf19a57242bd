//! The effects that a scene has, and the effects that it does not have.

use crate::precision::ladder::{FIXED_STEP, RIGID_CONTACTS};
use crate::report::table::Table;
use crate::report::units::{Shown, grouped, significant};
use slidercrank::scene::profile::{Profile, ProfileArgument};
use slidercrank::scene::read::SceneFile;
use slidercrank::scene::{
    Audit, Contact, DampingLaw, DriveMode, FrictionLaw, JointModel, Lubrication, Revolute, Scene, Surface,
};
use slidercrank::simulation::Size;
use std::f64::consts::{FRAC_PI_2, TAU};

/// [rad/s] One turn per minute.
const RPM: f64 = TAU / 60.0;

/// Table of effects with their models. An effect that the scene does not have is a dash.
pub fn table(file: &SceneFile) -> Table {
    let scene = &file.scene;
    let mut table = Table::default();
    table.row(["effect", "called for"]);
    table.row(["drive", &drive(file)]);
    let rigid = scene.solver.method.has(RIGID_CONTACTS);
    let joint = &scene.joint;
    for (name, joint) in [("main bearing A", &joint.a), ("crank pin B", &joint.b), ("slider pin C", &joint.c)] {
        table.row([name, &revolute(joint, rigid)]);
    }
    table.row(["guide T", &guide(scene, rigid)]);
    let flexible = &scene.rod.flexible;
    let modes = flexible.bending_modes + flexible.axial_modes > 0;
    let source = if flexible.table.is_some() { "a table's" } else { "a uniform beam's" };
    let told = format!(
        "{source}: {} bending, {} axial modes, damping ratio {}",
        flexible.bending_modes, flexible.axial_modes, flexible.damping_ratio
    );
    table.row(["elastic rod", &dashed(modes, told)]);
    table.row(["gravity", &dashed(scene.gravity != 0.0, gravity(scene))]);
    let viscous = [joint.a.damping, joint.b.damping, joint.c.damping, joint.t.damping];
    let of = viscous.iter().zip("ABCT".chars()).filter(|(damping, _)| **damping != 0.0);
    let of: Vec<String> = of.map(|(_, joint)| joint.to_string()).collect();
    table.row(["viscous friction", &dashed(!of.is_empty(), format!("in {}", of.join(", ")))]);
    table.row(["load on the slider", &load(&file.inputs.slider_load)]);
    let audits = [
        ("A", joint.a.peak, joint.a.wear),
        ("B", joint.b.peak, joint.b.wear),
        ("C", joint.c.peak, joint.c.wear),
        ("T", joint.t.peak, joint.t.wear),
    ];
    let of = |asked: fn(&(&'static str, Audit, Audit)) -> bool| -> Vec<&str> {
        audits.iter().filter(|audits| asked(audits)).map(|(name, ..)| *name).collect()
    };
    let peaks = of(|(_, peak, _)| peak.audit);
    table.row(["largest forces", &dashed(!peaks.is_empty(), format!("of {}", peaks.join(", ")))]);
    let wear = of(|(.., wear)| wear.audit);
    table.row(["sliding and wear", &dashed(!wear.is_empty(), format!("in {}", wear.join(", ")))]);
    table.row(["energy audit", &dashed(scene.energy.audit, "energies, works and losses beside the motion".into())]);
    let solver = &scene.solver;
    let fixed = solver.method.has(FIXED_STEP);
    let how = if fixed { format!("steps of {} s", solver.step) } else { format!("tolerance {:e}", solver.tolerance) };
    table.row(["method", &format!("{}, {how}", solver.method.name())]);
    let deadline = format!("{:e} evaluations per second", solver.deadline);
    table.row(["deadline", &dashed(solver.deadline > 0.0, deadline)]);
    table
}

/// A sentence with the size of the model.
pub fn sentence(size: &Size) -> String {
    let Size { degrees_of_freedom, states, event_functions } = size;
    let [freedoms, states, events] = [degrees_of_freedom, states, event_functions].map(|count| grouped(*count as f64));
    format!(
        "Degrees of freedom: {freedoms}. States: {states}. Event functions: {events}. What has a dash exists nowhere in \
         the equations: no state, no event function, no term."
    )
}

fn dashed(called_for: bool, told: String) -> String {
    if called_for { told } else { "–".into() }
}

fn drive(file: &SceneFile) -> String {
    let crank = &file.scene.crank;
    let rpm = crank.speed_start / RPM;
    match file.scene.drive.mode {
        DriveMode::Speed => format!("at a speed of {} rpm", significant(rpm)),
        DriveMode::Torque => {
            let torque = match &file.inputs.crank_torque {
                Profile::Constant(torque) => format!("of {} N·m", significant(*torque)),
                Profile::Points { against, .. } => format!("over {}", against.name()),
            };
            format!("by a torque {torque}, from {} rpm", significant(rpm))
        }
    }
}

fn gravity(scene: &Scene) -> String {
    let angle = scene.gravity_angle.to_degrees();
    let direction = match scene.gravity_angle {
        across if across == -FRAC_PI_2 => "across the guide".to_owned(),
        0.0 => "along the guide".to_owned(),
        _ => format!("at {}° from the guide", significant(angle)),
    };
    format!("{} m/s² {direction}", scene.gravity)
}

fn load(profile: &Profile) -> String {
    match profile {
        Profile::Constant(0.0) => "–".into(),
        Profile::Constant(load) => Shown::of("N", *load).print(*load),
        Profile::Points { against, points } => {
            let peak = points.iter().map(|[_, load]| load.abs()).fold(0.0, f64::max);
            let over = if *against == ProfileArgument::Time { "time" } else { "the crank's angle" };
            format!("over {over}, at most {}", Shown::of("N", peak).print(peak))
        }
    }
}

fn revolute(joint: &Revolute, rigid: bool) -> String {
    match joint.model {
        JointModel::Ideal => "ideal".into(),
        JointModel::Clearance => {
            let dry = play(joint.clearance, joint.elasticity.name(), &joint.contact, rigid);
            match joint.lubrication {
                Lubrication::None => dry,
                oil => {
                    let roughness = Shown::of("m", joint.roughness).print(joint.roughness);
                    format!("{dry}; oil {} of {} Pa·s, roughness {roughness}", oil.name(), significant(joint.viscosity))
                }
            }
        }
    }
}

fn guide(scene: &Scene, rigid: bool) -> String {
    let guide = &scene.joint.t;
    let surface = match guide.surface {
        Surface::Corner => "four corners",
        Surface::Foundation => "two elastic faces",
    };
    match guide.model {
        JointModel::Ideal => "ideal".into(),
        JointModel::Clearance => play(guide.clearance, surface, &guide.contact, rigid),
    }
}

fn play(clearance: f64, elastic: &str, contact: &Contact, rigid: bool) -> String {
    let clearance = Shown::of("m", clearance).print(clearance);
    let restitution = contact.restitution;
    let normal = match contact.law {
        _ if rigid => format!("rigid, restitution {restitution}"),
        DampingLaw::Hertz => format!("{elastic}, undamped"),
        law => format!("{elastic}, {} with restitution {restitution}", law.name()),
    };
    let friction = &contact.friction;
    let friction = match friction.law {
        FrictionLaw::None => "no friction".to_owned(),
        law => format!("friction {} of {}", law.name(), friction.coefficient),
    };
    format!("clearance {clearance}; {normal}; {friction}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenes::Scenario;

    fn told(scene: &str) -> Vec<Vec<String>> {
        table(&Scenario::find(scene).expect("a shipped scene").file).lines().to_vec()
    }

    #[test]
    fn what_a_scene_does_without_has_a_dash() {
        let worn = told("wornpin");
        let dashes: Vec<&str> = worn.iter().filter(|line| line[1] == "–").map(|line| line[0].as_str()).collect();
        assert_eq!(
            dashes,
            [
                "elastic rod",
                "gravity",
                "viscous friction",
                "load on the slider",
                "largest forces",
                "sliding and wear",
                "energy audit",
                "deadline"
            ]
        );
        assert_eq!(
            worn[4],
            ["slider pin C", "clearance 500.0 µm; hertz, lankarani_nikravesh with restitution 0.9; no friction"]
        );
        assert_eq!(worn[1][1], "at a speed of 5000 rpm");
    }

    #[test]
    fn what_a_scene_has_is_told() {
        let press = told("press");
        let line = |lines: &[Vec<String>], name: &str| {
            lines.iter().find(|line| line[0] == name).map(|line| line[1].clone()).expect("a line")
        };
        assert!(line(&press, "load on the slider").starts_with("over the crank's angle, at most "), "{press:?}");
        assert!(line(&press, "drive").starts_with("by a torque of "), "{press:?}");
        assert!(line(&told("effects/10-lugre"), "guide T").ends_with("; friction ambrosio of 0.03"));
        assert_eq!(line(&told("effects/11-audit"), "energy audit"), "energies, works and losses beside the motion");
    }
}
