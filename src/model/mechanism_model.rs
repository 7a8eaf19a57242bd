//! Interface between a simulation and a mechanism, apart from the integrator's interface.

use super::contact::{ContactEnergy, Rubbing};
use super::drive::InputSignal;
use super::joint::rectangle::CORNERS;
use super::loads::Loads;
use super::scalar::Tangent;
use super::signals::EnergyOutputs;
use super::start::StartPose;
use super::state::{CONTACTS, Conditions, Contacts, Evaluation, Pose};
use crate::integrator::{Impulses, Unilateral};
use std::ops::Range;

/// A mechanism in minimal coordinates.
pub trait MechanismModel: Unilateral<Discrete = Conditions> + Send {
    /// Writes the state of a start pose; `y` must be zeros.
    fn write_start(&self, pose: &StartPose, y: &mut [f64]);

    /// The contact states at a start state: contacts with penetration are closed.
    fn start_contacts(&self, t: f64, y: &[f64]) -> Contacts;

    /// The evaluation of an instant.
    fn evaluation(&self, conditions: &Conditions, t: f64, y: &[f64]) -> Evaluation;

    /// Writes the rates and returns the evaluation, at about the cost of the rates alone.
    fn rates_and_evaluation(&self, conditions: &Conditions, t: f64, y: &[f64], rates: &mut [f64]) -> Evaluation {
        self.rates(conditions, t, y, rates);
        self.evaluation(conditions, t, y)
    }

    /// The evaluation of an instant with rigid contacts under the contact forces of `impulses`.
    fn evaluation_under(&self, _: &Impulses, inputs: &InputSignal, t: f64, y: &[f64]) -> Evaluation {
        self.evaluation(&Conditions::without_contacts(*inputs), t, y)
    }

    /// Writes the rates with rigid contacts under the contact forces of `impulses`.
    fn rates_under(&self, _: &Impulses, inputs: &InputSignal, t: f64, y: &[f64], rates: &mut [f64]) {
        self.rates(&Conditions::without_contacts(*inputs), t, y, rates);
    }

    /// [m] Penetration in joints A, B, C and at the guide's corners; −∞ for an ideal joint.
    fn penetration(&self, pose: &Pose) -> [f64; 3 + CORNERS];

    /// Elastic energy of the closed contacts and the powers that they absorb.
    fn contact_energy(&self, _: &Contacts, _: &Pose, _: &[f64]) -> ContactEnergy {
        ContactEnergy::default()
    }

    /// Sliding and forces of the closed contacts; zero in the open ones.
    fn rubbing(&self, contacts: &Contacts, pose: &Pose, y: &[f64]) -> [Rubbing; CONTACTS];

    /// Loads from inputs, friction and contacts at a pose and the state `y`.
    fn loads(&self, conditions: &Conditions, t: f64, pose: &Pose, y: &[f64]) -> Loads;

    /// Angles, places and velocities at the state `y`.
    fn pose(&self, t: f64, y: &[f64]) -> Pose;

    /// Penetration [m] and approach speed [m/s] of every contact at a pose; −∞ and 0 for a joint without clearance.
    fn approaches(&self, pose: &Pose) -> [(f64, f64); CONTACTS];

    /// [`MechanismModel::approaches`] with derivatives.
    fn tangent_approaches(&self, pose: &Pose<Tangent>) -> [(Tangent, Tangent); CONTACTS];

    /// The bristle states of a contact, which its opening sets to 0; empty without bristles.
    fn bristles_of(&self, contact: usize) -> Range<usize>;

    /// [m/s] The smallest approach speed that a contact remembers.
    fn speed_floor(&self, contact: usize) -> f64;

    /// Writes the rates with derivatives.
    fn tangent_rates(&self, conditions: &Conditions, t: Tangent, y: &[Tangent], rates: &mut [Tangent]);

    /// [`MechanismModel::rates_and_evaluation`] with derivatives.
    fn tangent_evaluation(
        &self,
        conditions: &Conditions,
        t: Tangent,
        y: &[Tangent],
        rates: &mut [Tangent],
    ) -> Evaluation<Tangent>;

    /// [`MechanismModel::contact_energy`] with derivatives.
    fn tangent_contact_energy(
        &self,
        contacts: &Contacts,
        pose: &Pose<Tangent>,
        y: &[Tangent],
    ) -> ContactEnergy<Tangent>;

    /// Energies, works and losses; all 0 without an audit.
    fn energies(&self, _: &Contacts, _: &Evaluation, _: &[f64]) -> EnergyOutputs {
        EnergyOutputs::default()
    }
}
