//! What a simulation asks of a mechanism besides its rates.

use super::contact::Account;
use super::drive::InputSignal;
use super::joint::rectangle::CORNERS;
use super::scalar::Tangent;
use super::signals::EnergyOutputs;
use super::start::StartPose;
use super::state::{Contacts, Instant, Pose};
use crate::integrator::{Impulses, Unilateral};

/// A mechanism in minimal coordinates.
pub trait Plant: Unilateral<Discrete = Contacts> + Send {
    /// Writes the state of a start pose in place of zeros.
    fn write_start(&self, pose: &StartPose, y: &mut [f64]);

    /// The contacts of a state that no motion has led to: those that penetrate are closed.
    fn start_contacts(&self, t: f64, y: &[f64]) -> Contacts;

    /// Inputs from a communication point on.
    fn set_signal(&mut self, signal: InputSignal);

    /// The inputs in force.
    fn signal(&self) -> &InputSignal;

    /// [s] t0, from which a prescribed crank angle counts.
    fn start_time(&self) -> f64;

    /// Sets t0.
    fn set_start_time(&mut self, time: f64);

    /// Everything about one instant.
    fn instant(&self, contacts: &Contacts, t: f64, y: &[f64]) -> Instant;

    /// The rates of a state and everything about that instant, at the cost of about one of them.
    fn rates_and_instant(&self, contacts: &Contacts, t: f64, y: &[f64], rates: &mut [f64]) -> Instant {
        self.rates(contacts, t, y, rates);
        self.instant(contacts, t, y)
    }

    /// Everything about one instant of a motion with rigid contacts, whose forces are those of `impulses`.
    fn instant_under(&self, _: &Impulses, t: f64, y: &[f64]) -> Instant {
        self.instant(&Contacts::default(), t, y)
    }

    /// The rates of that instant.
    fn rates_under(&self, _: &Impulses, t: f64, y: &[f64], rates: &mut [f64]) {
        self.rates(&Contacts::default(), t, y, rates);
    }

    /// [m] Penetration in the joints A, B, C and of the guide's corners at a pose, −∞ in an ideal joint.
    fn penetration(&self, pose: &Pose) -> [f64; 3 + CORNERS];

    /// Elastic energy of the closed contacts, and the powers that they take.
    fn account(&self, _: &Contacts, _: &Pose, _: &[f64]) -> Account {
        Account::default()
    }

    /// The rates with derivatives.
    fn tangent_rates(&self, contacts: &Contacts, t: Tangent, y: &[Tangent], rates: &mut [Tangent]);

    /// [`Plant::instant`] and [`Plant::account`] with derivatives.
    fn tangent_instant(&self, contacts: &Contacts, t: Tangent, y: &[Tangent]) -> (Instant<Tangent>, Account<Tangent>);

    /// Energies, works and losses; 0 without an audit.
    fn energies(&self, _: &Contacts, _: &Instant, _: &[f64]) -> EnergyOutputs {
        EnergyOutputs::default()
    }
}
