//! The energy audit: works and losses integrated beside the motion.
//!
//! An audited mechanism has seven first-order states more: the works of torque, load and normal
//! forces, the losses of friction, viscous and modal damping, and, constant, the energy that it started
//! with. They follow from the motion and are not weighed by the error norm: an audit changes no bit of it.
//!
//! What contacts lose is the work that normal forces take less the elastic energy that it leaves in them.
//! That power is 0 while a contact that has no adhesion lets go, where the loss itself has corners that
//! steps of a smooth motion would step over.

use super::bodies::bodies;
use super::body::Bodies;
use super::contact::Account;
use super::drive::InputSignal;
use super::jacobian::differentiate;
use super::joint::rectangle::CORNERS;
use super::plane::perp;
use super::plant::Plant;
use super::reactions::reactions;
use super::scalar::Tangent;
use super::signals::EnergyOutputs;
use super::start::StartPose;
use super::state::{Contacts, Instant, Pose};
use super::structure::{CRANK, ROD, SLIDER, Topology};
use crate::integrator::{
    Discontinuities, EventFunctions, Events, Extent, Jacobian, Linearizable, MAX_STATES, Ode, Reset, SeveralInstants,
    Triggered, Unilateral,
};
use crate::math::Real;
use crate::scene::Scene;

/// Number of states of an audit.
pub const STATES: usize = 7;
/// Place of the normal forces' work, which begins with the elastic energy of the start.
const NORMAL_WORK: usize = 2;

/// A mechanism whose energy is reckoned up.
pub struct Audited {
    plant: Box<dyn Plant>,
    /// Of its own states 0: the error norm does not weigh them.
    scales: Vec<f64>,
    topology: Topology,
    bodies: Bodies,
    gravity: f64,
    viscous: Viscous,
}

/// Viscous friction of all joints.
struct Viscous {
    /// [N·m·s/rad] Of A, B, C.
    revolute: [f64; 3],
    /// [N·s/m]
    guide: f64,
}

impl Viscous {
    /// [W]
    fn loss<R: Real>(&self, pose: &Pose<R>) -> R {
        let Pose { turning, section_speed, velocity, .. } = pose;
        let relative =
            [turning.speed[CRANK], turning.speed[CRANK] - section_speed[0], turning.speed[SLIDER] - section_speed[1]];
        let mut loss = R::ZERO;
        for (&damping, speed) in self.revolute.iter().zip(relative) {
            loss += speed * damping * speed;
        }
        loss + velocity.pin.x * self.guide * velocity.pin.x
    }
}

impl Audited {
    /// `plant` of a scene, which must have room for the audit.
    pub fn new(scene: &Scene, plant: Box<dyn Plant>) -> Self {
        let joint = &scene.joint;
        let states = plant.extent().states;
        let mut scales = vec![0.0; states + STATES];
        scales[..states].copy_from_slice(&plant.scales()[..states]);
        Self {
            plant,
            scales,
            topology: Topology::of(scene),
            bodies: bodies(scene),
            gravity: scene.gravity,
            viscous: Viscous { revolute: [joint.a.damping, joint.b.damping, joint.c.damping], guide: joint.t.damping },
        }
    }

    /// Where the audit's states begin.
    fn first(&self) -> usize {
        self.plant.extent().states
    }

    /// [J] Kinetic energy, and Σ m·g·y.
    fn mechanical(&self, instant: &Instant) -> (f64, f64) {
        let Pose { turning, place, velocity, .. } = &instant.pose;
        let points = [(place.crank, velocity.crank), (place.big_end, velocity.big_end), (place.pin, velocity.pin)];
        let (mut kinetic, mut moment) = (0.0, 0.0);
        for k in [CRANK, ROD, SLIDER] {
            if let (ROD, Some(flexible)) = (k, &instant.flexible) {
                kinetic += flexible.kinetic;
                moment += flexible.mass_height;
                continue;
            }
            let body = &self.bodies[k];
            let arm = turning.rotation[k].apply(body.com);
            let speed = turning.speed[k];
            let moving = points[k].1 + speed * perp(arm);
            kinetic += 0.5 * (body.mass * moving.norm_squared() + body.inertia * speed * speed);
            moment += body.mass * (points[k].0.y + arm.y);
        }
        (kinetic, self.gravity * moment)
    }

    /// [W] Rates of the audit's states.
    fn powers<R: Real>(&self, t: R, instant: &Instant<R>, account: &Account<R>) -> [R; STATES] {
        let Instant { pose, loads, flexible, .. } = instant;
        let torque = if self.topology.speed {
            reactions(self.topology, &self.bodies, self.gravity, instant).torque
        } else {
            self.plant.signal().at(t).crank_torque
        };
        [
            torque * pose.turning.speed[CRANK],
            loads.slider_load * pose.velocity.pin.x,
            account.normal_power,
            account.friction_loss,
            self.viscous.loss(pose),
            flexible.map_or(R::ZERO, |flexible| flexible.elastic.modal_loss),
            R::ZERO,
        ]
    }

    /// Kinetic and potential energies alone.
    fn stored(&self, instant: &Instant, account: &Account) -> EnergyOutputs {
        let (kinetic, gravity) = self.mechanical(instant);
        let elastic = instant.flexible.map_or(0.0, |flexible| flexible.elastic.energy);
        let contact = account.energy;
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
    type Discrete = Contacts;

    fn extent(&self) -> Extent {
        let Extent { positions, weighed, states } = self.plant.extent();
        Extent { positions, weighed, states: states + STATES }
    }

    fn rates(&self, contacts: &Contacts, t: f64, y: &[f64], rates: &mut [f64]) {
        let first = self.first();
        let instant = self.plant.rates_and_instant(contacts, t, &y[..first], &mut rates[..first]);
        let account = self.plant.account(contacts, &instant.pose, &y[..first]);
        rates[first..][..STATES].copy_from_slice(&self.powers(t, &instant, &account));
    }

    fn scales(&self) -> &[f64] {
        &self.scales
    }

    fn longest_step(&self) -> f64 {
        self.plant.longest_step()
    }
}

impl SeveralInstants for Audited {
    /// As without the audit, whose steps these are.
    fn suits_blocks(&self) -> bool {
        self.plant.suits_blocks()
    }
}

impl Linearizable for Audited {
    /// The audit's own rows are exact, too; its columns are 0.
    fn jacobian(&self, contacts: &Contacts, t: f64, y: &[f64], jacobian: &mut Jacobian) {
        let first = self.first();
        differentiate::<MAX_STATES>(first + STATES, first, t, y, jacobian, &|t, y, rates| {
            self.tangent_rates(contacts, t, y, rates);
        });
    }
}

impl Events for Audited {
    fn event_count(&self) -> usize {
        self.plant.event_count()
    }

    fn event_functions(&self, contacts: &Contacts, t: f64, y: &[f64], functions: &mut EventFunctions) {
        self.plant.event_functions(contacts, t, &y[..self.first()], functions);
    }

    fn is_dead_end(&self, event: usize) -> bool {
        self.plant.is_dead_end(event)
    }

    fn discontinuities(&self, contacts: &Contacts, t: f64, y: &[f64], functions: &mut Discontinuities) {
        self.plant.discontinuities(contacts, t, &y[..self.first()], functions);
    }

    fn event_scale(&self) -> f64 {
        self.plant.event_scale()
    }

    fn reset(&self, contacts: &Contacts, t: f64, y: &mut [f64], triggered: &Triggered) -> Reset<Contacts> {
        let first = self.first();
        self.plant.reset(contacts, t, &mut y[..first], triggered)
    }
}

impl Unilateral for Audited {}

impl Plant for Audited {
    fn write_start(&self, pose: &StartPose, y: &mut [f64]) {
        let first = self.first();
        let (own, sums) = y.split_at_mut(first);
        self.plant.write_start(pose, own);
        let t = self.plant.start_time();
        let contacts = self.plant.start_contacts(t, own);
        let instant = self.plant.instant(&contacts, t, own);
        let stored = self.stored(&instant, &self.plant.account(&contacts, &instant.pose, own));
        sums[NORMAL_WORK] = stored.contact;
        sums[STATES - 1] = stored.kinetic + stored.potential;
    }

    fn start_contacts(&self, t: f64, y: &[f64]) -> Contacts {
        self.plant.start_contacts(t, &y[..self.first()])
    }

    fn set_signal(&mut self, signal: InputSignal) {
        self.plant.set_signal(signal);
    }

    fn signal(&self) -> &InputSignal {
        self.plant.signal()
    }

    fn start_time(&self) -> f64 {
        self.plant.start_time()
    }

    fn set_start_time(&mut self, time: f64) {
        self.plant.set_start_time(time);
    }

    fn instant(&self, contacts: &Contacts, t: f64, y: &[f64]) -> Instant {
        self.plant.instant(contacts, t, &y[..self.first()])
    }

    fn penetration(&self, pose: &Pose) -> [f64; 3 + CORNERS] {
        self.plant.penetration(pose)
    }

    fn account(&self, contacts: &Contacts, pose: &Pose, y: &[f64]) -> Account {
        self.plant.account(contacts, pose, &y[..self.first()])
    }

    fn tangent_rates(&self, contacts: &Contacts, t: Tangent, y: &[Tangent], rates: &mut [Tangent]) {
        let first = self.first();
        self.plant.tangent_rates(contacts, t, &y[..first], &mut rates[..first]);
        let (instant, account) = self.plant.tangent_instant(contacts, t, &y[..first]);
        rates[first..][..STATES].copy_from_slice(&self.powers(t, &instant, &account));
    }

    fn tangent_instant(&self, contacts: &Contacts, t: Tangent, y: &[Tangent]) -> (Instant<Tangent>, Account<Tangent>) {
        self.plant.tangent_instant(contacts, t, &y[..self.first()])
    }

    fn energies(&self, contacts: &Contacts, instant: &Instant, y: &[f64]) -> EnergyOutputs {
        let account = self.plant.account(contacts, &instant.pose, &y[..self.first()]);
        let stored = self.stored(instant, &account);
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
