//! The states of a scene's mechanism by name, in the order in which its equations have them.
//!
//! Names and number follow from the scene alone: from the joints with play, the drive, the rod's modes, the friction laws
//! and the audit. No mechanism is assembled, so that a scene that contradicts itself has names, too.

use super::audit::STATES as SUMS;
use super::bristles::bristled_contacts;
use super::joint::guide::guide_contacts;
use super::structure::{Link, Structure, Topology};
use crate::scene::modal::MAX_MODES;
use crate::scene::{JointModel, Scene};

/// What a state measures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// [m]
    Length,
    /// [rad]
    Angle,
    /// [m/s]
    Velocity,
    /// [rad/s]
    AngularVelocity,
    /// [J]
    Energy,
}

/// What a state's rate follows from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// A position: its rate is the state at this place.
    Position(usize),
    /// The rate of a position: all positions, rates and bristles, and the inputs.
    Rate,
    /// The deflection of a contact's bristles: all positions and rates, and itself.
    Bristle,
    /// A sum of the energy audit: as a rate.
    Sum,
}

/// One state.
#[derive(Clone, Debug, PartialEq)]
pub struct StateVariable {
    /// Such as `crank.angle`.
    pub name: String,
    /// What it is, in a few words.
    pub description: String,
    /// What it measures.
    pub quantity: Quantity,
    /// What its rate follows from.
    pub role: Role,
}

/// Every state of the scene's mechanism.
pub fn state_variables(scene: &Scene) -> Vec<StateVariable> {
    let mut positions = rigid(scene);
    positions.extend(modal(scene));
    let count = positions.len();
    let rates: Vec<StateVariable> = positions.iter().map(Position::rate).collect();
    let positions = positions.into_iter().zip(count..).map(|(position, rate)| position.state(rate));
    positions.chain(rates).chain(bristles(scene)).chain(sums(scene)).collect()
}

/// How many events a host's integrator has to watch: one for each contact that may close; in a closed loop, its change
/// point.
pub fn event_count(scene: &Scene) -> usize {
    let joint = &scene.joint;
    let pins = [&joint.a, &joint.b, &joint.c].iter().filter(|joint| joint.model == JointModel::Clearance).count();
    let guide = if joint.t.model == JointModel::Clearance { guide_contacts(joint.t.surface) } else { 0 };
    (pins + guide).max(1)
}

/// A position, with the name of its rate.
struct Position {
    name: String,
    rate: String,
    description: String,
    turns: bool,
}

impl Position {
    fn state(self, rate: usize) -> StateVariable {
        let Self { name, description, turns, .. } = self;
        let quantity = if turns { Quantity::Angle } else { Quantity::Length };
        StateVariable { name, description, quantity, role: Role::Position(rate) }
    }

    fn rate(&self) -> StateVariable {
        let quantity = if self.turns { Quantity::AngularVelocity } else { Quantity::Velocity };
        let description = format!("Rate of: {}", self.description);
        StateVariable { name: self.rate.clone(), description, quantity, role: Role::Rate }
    }
}

/// Positions of the rigid bodies: the roots of their chains, then angles.
fn rigid(scene: &Scene) -> Vec<Position> {
    let structure = Structure::with_rod(Topology::of(scene), modes(scene) != [0, 0]);
    let mut positions = vec![];
    for (body, link) in [("crank", structure.crank), ("rod", structure.rod), ("slider", structure.slider)] {
        let axes = match link {
            Link::Free(_) => &["x", "y"][..],
            Link::Rail(_) => &["x"],
            _ => &[],
        };
        positions.extend(axes.iter().map(|axis| Position {
            name: format!("{body}.{axis}"),
            rate: format!("{body}.v{axis}"),
            description: format!("Place along {axis} of the chain of bodies that begins with the {body}"),
            turns: false,
        }));
    }
    let angles = [structure.crank_angle, structure.rod_angle, structure.slider_angle];
    for (body, _) in ["crank", "rod", "slider"].into_iter().zip(angles).filter(|(_, angle)| angle.is_some()) {
        positions.push(Position {
            name: format!("{body}.angle"),
            rate: format!("{body}.speed"),
            description: format!("Angle of the {body}"),
            turns: true,
        });
    }
    positions
}

/// Numbers of bending and axial modes.
fn modes(scene: &Scene) -> [usize; 2] {
    let flexible = &scene.rod.flexible;
    [flexible.bending_modes, flexible.axial_modes].map(|modes| usize::try_from(modes).unwrap_or(0).min(MAX_MODES))
}

/// Amplitudes of a flexible rod's modes.
fn modal(scene: &Scene) -> impl Iterator<Item = Position> {
    ["bending", "axial"].into_iter().zip(modes(scene)).flat_map(|(kind, count)| {
        (1..=count).map(move |mode| Position {
            name: format!("rod.{kind}[{mode}]"),
            rate: format!("rod.{kind}_rate[{mode}]"),
            description: format!("Amplitude of the rod's {kind} mode {mode}"),
            turns: false,
        })
    })
}

/// Deflections of the bristles of friction.
fn bristles(scene: &Scene) -> impl Iterator<Item = StateVariable> {
    bristled_contacts(scene).into_iter().map(|(contact, _)| {
        let joint = match contact {
            0 => "A.bristle".to_owned(),
            1 => "B.bristle".to_owned(),
            2 => "C.bristle".to_owned(),
            of_guide => format!("T.bristle[{}]", of_guide - 2),
        };
        StateVariable {
            name: format!("joint.{joint}"),
            description: "Deflection of the bristles of a contact's friction".into(),
            quantity: Quantity::Length,
            role: Role::Bristle,
        }
    })
}

/// Sums of the energy audit, in its order.
fn sums(scene: &Scene) -> impl Iterator<Item = StateVariable> {
    const NAMES: [(&str, &str); SUMS] = [
        ("torque_work", "Work of the torque on the crank"),
        ("load_work", "Work of the load on the slider"),
        ("normal_work", "Work that the normal forces have taken, from the elastic energy of the start on"),
        ("friction_loss", "Lost in friction of contacts"),
        ("viscous_loss", "Lost in viscous friction and oil films"),
        ("modal_loss", "Lost in the damping of the rod's modes"),
        ("start", "Energy at the start, a constant"),
    ];
    NAMES.into_iter().filter(|_| scene.energy.audit).map(|(name, description)| StateVariable {
        name: format!("energy.{name}"),
        description: description.into(),
        quantity: Quantity::Energy,
        role: Role::Sum,
    })
}
