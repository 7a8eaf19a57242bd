//! The energy audit: works and losses, integrated with the motion.
//!
//! An audited mechanism has seven additional first-order states: the works of the torque, the load and the normal
//! forces; the losses of friction, viscous damping with oil films, and modal damping; and the initial energy, which is
//! constant. They depend on the motion and are not in the error norm: an audit changes no bit of the motion.
//!
//! The loss of contacts is the work of normal forces less the elastic energy stored in the contacts. The power of
//! normal forces tends to 0 where a contact without adhesion opens. The loss itself has corners there, which long steps
//! of a smooth motion would miss.

use super::bodies::bodies;
use super::body::Bodies;
use super::contact::{ContactEnergy, Rubbing};
use super::drive::InputSignal;
use super::films::Films;
use super::gravity::free_fall;
use super::jacobian::{Rates, differentiate};
use super::joint::rectangle::CORNERS;
use super::kinematics::BodyRotations;
use super::loads::Loads;
use super::mechanism_model::MechanismModel;
use super::plane::{Vec2, perp};
use super::reactions::reactions;
use super::scalar::Tangent;
use super::signals::EnergyOutputs;
use super::start::StartPose;
use super::state::{CONTACTS, Conditions, Contacts, Evaluation, Pose};
use super::structure::{CRANK, ROD, SLIDER, Topology};
use crate::integrator::{
    Discontinuities, EventFunctions, Events, Jacobian, Linearizable, MAX_EVENTS, MAX_STATES, Ode, Reset,
    SeveralInstants, StateLayout, Triggered, Unilateral,
};
use crate::math::Real;
use crate::scene::Scene;
use std::ops::Range;

/// Number of states that few mechanisms with an audit exceed.
const USUAL: usize = 44;
/// Number of states of an audit.
pub const STATES: usize = 7;
/// Index of the normal forces' work; it starts with the elastic energy at the start.
const NORMAL_WORK: usize = 2;

/// A mechanism with an energy audit.
pub struct Audited {
    model: Box<dyn MechanismModel>,
    /// Scales of all states; 0 for those of the audit, which are not in the error norm.
    scales: Vec<f64>,
    topology: Topology,
    bodies: Bodies,
    gravity: Vec2,
    /// [m] Distance of the slider load from the pin, across the guide.
    load_offset: f64,
    viscous: Viscous,
    films: Films,
}

/// Coefficients of viscous friction of all joints.
struct Viscous {
    /// [N·m·s/rad] Revolute joints A, B, C.
    revolute: [f64; 3],
    /// [N·s/m] Guide T.
    guide: f64,
}

impl Viscous {
    /// [W] Power lost in viscous friction.
    fn loss<R: Real>(&self, pose: &Pose<R>) -> R {
        let Pose { rotations, section_speed, velocity, .. } = pose;
        let relative = [
            rotations.speed[CRANK],
            rotations.speed[CRANK] - section_speed[0],
            rotations.speed[SLIDER] - section_speed[1],
        ];
        let mut loss = R::ZERO;
        for (&damping, speed) in self.revolute.iter().zip(relative) {
            loss += speed * damping * speed;
        }
        loss + velocity.pin.x * self.guide * velocity.pin.x
    }
}

impl Audited {
    /// The `model` of the scene with an audit; it must have at most [`MAX_STATES`] less [`STATES`] states.
    pub fn new(scene: &Scene, model: Box<dyn MechanismModel>) -> Self {
        let joint = &scene.joint;
        let states = model.layout().states;
        let mut scales = vec![0.0; states + STATES];
        scales[..states].copy_from_slice(&model.scales()[..states]);
        Self {
            model,
            scales,
            topology: Topology::of(scene),
            bodies: bodies(scene),
            gravity: free_fall(scene),
            load_offset: scene.slider.load_offset,
            films: Films::new(scene),
            viscous: Viscous { revolute: [joint.a.damping, joint.b.damping, joint.c.damping], guide: joint.t.damping },
        }
    }

    /// Index of the audit's first state.
    fn first(&self) -> usize {
        self.model.layout().states
    }

    /// [J] Kinetic energy, and potential energy of gravity −Σ m·g·r, zero at the origin.
    fn mechanical(&self, evaluation: &Evaluation) -> (f64, f64) {
        let Pose { rotations, place, velocity, .. } = &evaluation.pose;
        let points = [(place.crank, velocity.crank), (place.big_end, velocity.big_end), (place.pin, velocity.pin)];
        let (mut kinetic, mut moment) = (0.0, Vec2::ZERO);
        for k in [CRANK, ROD, SLIDER] {
            if let (ROD, Some(flexible)) = (k, &evaluation.flexible) {
                kinetic += flexible.kinetic;
                moment += flexible.mass_moment;
                continue;
            }
            let body = &self.bodies[k];
            let arm = rotations.rotation[k].apply(body.com);
            let speed = rotations.speed[k];
            let moving = points[k].1 + speed * perp(arm);
            kinetic += 0.5 * (body.mass * moving.norm_squared() + body.inertia * speed * speed);
            moment += body.mass * (points[k].0 + arm);
        }
        (kinetic, -self.gravity.dot(moment))
    }

    /// [W] Rates of the audit's states.
    #[inline(never)]
    fn powers<R: Real>(
        &self,
        inputs: &InputSignal,
        t: R,
        evaluation: &Evaluation<R>,
        contact_energy: &ContactEnergy<R>,
    ) -> [R; STATES] {
        let Evaluation { pose, loads, flexible, .. } = evaluation;
        let torque = if self.topology.speed {
            reactions(self.topology, &self.bodies, self.gravity, evaluation).torque
        } else {
            inputs.at(t).crank_torque
        };
        let BodyRotations { rotation, speed, .. } = &pose.rotations;
        let turning = rotation[SLIDER].cos * self.load_offset * speed[SLIDER];
        [
            torque * speed[CRANK],
            loads.slider_load * (pose.velocity.pin.x - turning),
            contact_energy.normal_power,
            contact_energy.friction_loss,
            self.viscous.loss(pose) + self.films.loss(pose),
            flexible.map_or(R::ZERO, |flexible| flexible.elastic.modal_loss),
            R::ZERO,
        ]
    }

    /// [J] Kinetic and potential energies; works and losses are 0.
    fn stored(&self, evaluation: &Evaluation, contact_energy: &ContactEnergy) -> EnergyOutputs {
        let (kinetic, gravity) = self.mechanical(evaluation);
        let elastic = evaluation.flexible.map_or(0.0, |flexible| flexible.elastic.energy);
        let contact = contact_energy.energy;
        EnergyOutputs {
            kinetic,
            gravity,
            elastic,
            contact,
            potential: gravity + elastic + contact,
            ..EnergyOutputs::default()
        }
    }
}

impl Ode for Audited {
    type Discrete = Conditions;

    fn layout(&self) -> StateLayout {
        let layout = self.model.layout();
        StateLayout { states: layout.states + STATES, ..layout }
    }

    fn rates(&self, conditions: &Conditions, t: f64, y: &[f64], rates: &mut [f64]) {
        let first = self.first();
        let evaluation = self.model.rates_and_evaluation(conditions, t, &y[..first], &mut rates[..first]);
        let contact_energy = self.model.contact_energy(&conditions.contacts, &evaluation.pose, &y[..first]);
        rates[first..][..STATES].copy_from_slice(&self.powers(&conditions.inputs, t, &evaluation, &contact_energy));
    }

    fn scales(&self) -> &[f64] {
        &self.scales
    }

    fn longest_step(&self) -> f64 {
        self.model.longest_step()
    }
}

impl SeveralInstants for Audited {
    /// The steps are those of the motion without audit.
    fn suits_blocks(&self) -> bool {
        self.model.suits_blocks()
    }
}

impl Linearizable for Audited {
    /// The steps are those of the motion without audit.
    fn rates_are_cheap(&self) -> bool {
        self.model.rates_are_cheap()
    }

    /// The rows of the audit's states are exact, too; their columns are 0.
    fn jacobian(&self, conditions: &Conditions, t: f64, y: &[f64], jacobian: &mut Jacobian) {
        let first = self.first();
        let rates: &Rates<'_> = &|t, y, rates| self.tangent_rates(conditions, t, y, rates);
        // Arrays for as many states as a rod of eight modes has leave room on a small stack.
        if first + STATES <= USUAL {
            differentiate::<USUAL>(first + STATES, first, t, y, jacobian, rates);
        } else {
            differentiate::<MAX_STATES>(first + STATES, first, t, y, jacobian, rates);
        }
    }
}

impl Events for Audited {
    fn event_count(&self) -> usize {
        self.model.event_count()
    }

    fn event_functions(&self, conditions: &Conditions, t: f64, y: &[f64], functions: &mut EventFunctions) {
        self.model.event_functions(conditions, t, &y[..self.first()], functions);
    }

    fn is_dead_end(&self, event: usize) -> bool {
        self.model.is_dead_end(event)
    }

    fn discontinuities(&self, conditions: &Conditions, t: f64, y: &[f64], functions: &mut Discontinuities) {
        self.model.discontinuities(conditions, t, &y[..self.first()], functions);
    }

    fn highest_events(&self) -> &[f64; MAX_EVENTS] {
        self.model.highest_events()
    }

    fn event_scale(&self) -> f64 {
        self.model.event_scale()
    }

    fn reset(&self, conditions: &Conditions, t: f64, y: &mut [f64], triggered: &Triggered) -> Reset<Conditions> {
        let first = self.first();
        self.model.reset(conditions, t, &mut y[..first], triggered)
    }
}

impl Unilateral for Audited {}

impl MechanismModel for Audited {
    fn write_start(&self, pose: &StartPose, y: &mut [f64]) {
        let first = self.first();
        let (own, sums) = y.split_at_mut(first);
        self.model.write_start(pose, own);
        let contacts = self.model.start_contacts(0.0, own);
        // Stored energy does not depend on the inputs.
        let conditions = Conditions::without_inputs(contacts);
        let evaluation = self.model.evaluation(&conditions, 0.0, own);
        let stored = self.stored(&evaluation, &self.model.contact_energy(&contacts, &evaluation.pose, own));
        sums[NORMAL_WORK] = stored.contact;
        sums[STATES - 1] = stored.kinetic + stored.potential;
    }

    fn start_contacts(&self, t: f64, y: &[f64]) -> Contacts {
        self.model.start_contacts(t, &y[..self.first()])
    }

    fn evaluation(&self, conditions: &Conditions, t: f64, y: &[f64]) -> Evaluation {
        self.model.evaluation(conditions, t, &y[..self.first()])
    }

    fn penetration(&self, pose: &Pose) -> [f64; 3 + CORNERS] {
        self.model.penetration(pose)
    }

    fn contact_energy(&self, contacts: &Contacts, pose: &Pose, y: &[f64]) -> ContactEnergy {
        self.model.contact_energy(contacts, pose, &y[..self.first()])
    }

    fn rubbing(&self, contacts: &Contacts, pose: &Pose, y: &[f64]) -> [Rubbing; CONTACTS] {
        self.model.rubbing(contacts, pose, &y[..self.first()])
    }

    fn loads(&self, conditions: &Conditions, t: f64, pose: &Pose, y: &[f64]) -> Loads {
        self.model.loads(conditions, t, pose, &y[..self.first()])
    }

    fn pose(&self, t: f64, y: &[f64]) -> Pose {
        self.model.pose(t, &y[..self.first()])
    }

    fn approaches(&self, pose: &Pose) -> [(f64, f64); CONTACTS] {
        self.model.approaches(pose)
    }

    fn tangent_approaches(&self, pose: &Pose<Tangent>) -> [(Tangent, Tangent); CONTACTS] {
        self.model.tangent_approaches(pose)
    }

    fn bristles_of(&self, contact: usize) -> Range<usize> {
        self.model.bristles_of(contact)
    }

    fn speed_floor(&self, contact: usize) -> f64 {
        self.model.speed_floor(contact)
    }

    fn tangent_rates(&self, conditions: &Conditions, t: Tangent, y: &[Tangent], rates: &mut [Tangent]) {
        let first = self.first();
        let evaluation = self.model.tangent_evaluation(conditions, t, &y[..first], &mut rates[..first]);
        let contact_energy = self.model.tangent_contact_energy(&conditions.contacts, &evaluation.pose, &y[..first]);
        rates[first..][..STATES].copy_from_slice(&self.powers(&conditions.inputs, t, &evaluation, &contact_energy));
    }

    fn tangent_evaluation(
        &self,
        conditions: &Conditions,
        t: Tangent,
        y: &[Tangent],
        rates: &mut [Tangent],
    ) -> Evaluation<Tangent> {
        let first = self.first();
        self.model.tangent_evaluation(conditions, t, &y[..first], &mut rates[..first])
    }

    fn tangent_contact_energy(
        &self,
        contacts: &Contacts,
        pose: &Pose<Tangent>,
        y: &[Tangent],
    ) -> ContactEnergy<Tangent> {
        self.model.tangent_contact_energy(contacts, pose, &y[..self.first()])
    }

    fn energies(&self, contacts: &Contacts, evaluation: &Evaluation, y: &[f64]) -> EnergyOutputs {
        let contact_energy = self.model.contact_energy(contacts, &evaluation.pose, &y[..self.first()]);
        let stored = self.stored(evaluation, &contact_energy);
        let first = self.first();
        let mut sums = [0.0; STATES];
        sums.copy_from_slice(&y[first..first + STATES]);
        let [torque_work, load_work, normal_work, friction_loss, viscous_loss, modal_loss, start] = sums;
        let contact_loss = normal_work - stored.contact;
        let input = torque_work + load_work;
        let dissipated = contact_loss + friction_loss + viscous_loss + modal_loss;
        EnergyOutputs {
            input,
            dissipated,
            residual: stored.kinetic + stored.potential - start - input + dissipated,
            torque_work,
            load_work,
            contact_loss,
            friction_loss,
            viscous_loss,
            modal_loss,
            ..stored
        }
    }
}
