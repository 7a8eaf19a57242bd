//! What a simulation asks of a mechanism besides its rates.

use super::contact::Account;
use super::drive::InputSignal;
use super::joint::guide::CORNERS;
use super::scalar::Tangent;
use super::signals::EnergyOutputs;
use super::start::StartPose;
use super::state::{Contacts, Instant, Pose};
use crate::integrator::{Impulses, Unilateral};

/// A mechanism in minimal coordinates.
pub trait Plant<const N: usize>: Unilateral<N, Modes = Contacts> + Send {
    /// The state of a start pose.
    fn start(&self, pose: &StartPose) -> [f64; N];

    /// The contacts of a state that no motion has led to: those that penetrate are closed.
    fn start_contacts(&self, t: f64, y: &[f64; N]) -> Contacts;

    /// Inputs from a communication point on.
    fn set_signal(&mut self, signal: InputSignal);

    /// The inputs in force.
    fn signal(&self) -> &InputSignal;

    /// [s] t0, from which a prescribed crank angle counts.
    fn start_time(&self) -> f64;

    /// Sets t0.
    fn set_start_time(&mut self, time: f64);

    /// Everything about one instant.
    fn instant(&self, contacts: &Contacts, t: f64, y: &[f64; N]) -> Instant;

    /// The rates of a state and everything about that instant, at the cost of about one of them.
    fn rates_and_instant(&self, contacts: &Contacts, t: f64, y: &[f64; N], rates: &mut [f64; N]) -> Instant {
        self.rates(contacts, t, y, rates);
        self.instant(contacts, t, y)
    }

    /// Everything about one instant of a motion with rigid contacts, whose forces are those of `impulses`.
    fn instant_under(&self, _: &Impulses<N>, t: f64, y: &[f64; N]) -> Instant {
        self.instant(&Contacts::default(), t, y)
    }

    /// The rates of that instant.
    fn rates_under(&self, _: &Impulses<N>, t: f64, y: &[f64; N], rates: &mut [f64; N]) {
        self.rates(&Contacts::default(), t, y, rates);
    }

    /// [m] Penetration in the joints A, B, C and of the guide's corners at a pose, −∞ in an ideal joint.
    fn penetration(&self, pose: &Pose) -> [f64; 3 + CORNERS];

    /// Elastic energy of the closed contacts, and the powers that they take.
    fn account(&self, _: &Contacts, _: &Pose, _: &[f64; N]) -> Account {
        Account::default()
    }

    /// [`Problem::rates`] with derivatives.
    fn tangent_rates(&self, contacts: &Contacts, t: Tangent, y: &[Tangent; N], rates: &mut [Tangent; N]);

    /// [`Plant::instant`] and [`Plant::account`] with derivatives.
    fn tangent_instant(
        &self,
        contacts: &Contacts,
        t: Tangent,
        y: &[Tangent; N],
    ) -> (Instant<Tangent>, Account<Tangent>);

    /// Energies, works and losses; 0 without an audit.
    fn energies(&self, _: &Contacts, _: &Instant, _: &[f64; N]) -> EnergyOutputs {
        EnergyOutputs::default()
    }
}
