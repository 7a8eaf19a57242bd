//! What a simulation asks of a mechanism besides its rates.

use super::contact::ContactEnergy;
use super::drive::InputSignal;
use super::joint::rectangle::CORNERS;
use super::scalar::Tangent;
use super::signals::EnergyOutputs;
use super::start::StartPose;
use super::state::{Conditions, Contacts, Evaluation, Pose};
use crate::integrator::{Impulses, Unilateral};

/// A mechanism in minimal coordinates.
pub trait MechanismModel: Unilateral<Discrete = Conditions> + Send {
    /// Writes the state of a start pose in place of zeros.
    fn write_start(&self, pose: &StartPose, y: &mut [f64]);

    /// The contacts of a state that no motion has led to: those that penetrate are closed.
    fn start_contacts(&self, t: f64, y: &[f64]) -> Contacts;

    /// Everything about one instant.
    fn evaluation(&self, conditions: &Conditions, t: f64, y: &[f64]) -> Evaluation;

    /// The rates of a state and everything about that instant, at the cost of about one of them.
    fn rates_and_evaluation(&self, conditions: &Conditions, t: f64, y: &[f64], rates: &mut [f64]) -> Evaluation {
        self.rates(conditions, t, y, rates);
        self.evaluation(conditions, t, y)
    }

    /// Everything about one instant of a motion with rigid contacts, whose forces are those of `impulses`.
    fn evaluation_under(&self, _: &Impulses, inputs: &InputSignal, t: f64, y: &[f64]) -> Evaluation {
        self.evaluation(&Conditions::without_contacts(*inputs), t, y)
    }

    /// The rates of that instant.
    fn rates_under(&self, _: &Impulses, inputs: &InputSignal, t: f64, y: &[f64], rates: &mut [f64]) {
        self.rates(&Conditions::without_contacts(*inputs), t, y, rates);
    }

    /// [m] Penetration in the joints A, B, C and of the guide's corners at a pose, −∞ in an ideal joint.
    fn penetration(&self, pose: &Pose) -> [f64; 3 + CORNERS];

    /// Elastic energy of the closed contacts, and the powers that they take.
    fn contact_energy(&self, _: &Contacts, _: &Pose, _: &[f64]) -> ContactEnergy {
        ContactEnergy::default()
    }

    /// The rates with derivatives.
    fn tangent_rates(&self, conditions: &Conditions, t: Tangent, y: &[Tangent], rates: &mut [Tangent]);

    /// [`MechanismModel::rates_and_evaluation`] and [`MechanismModel::contact_energy`] with derivatives.
    fn tangent_evaluation(
        &self,
        conditions: &Conditions,
        t: Tangent,
        y: &[Tangent],
        rates: &mut [Tangent],
    ) -> (Evaluation<Tangent>, ContactEnergy<Tangent>);

    /// Energies, works and losses; 0 without an audit.
    fn energies(&self, _: &Contacts, _: &Evaluation, _: &[f64]) -> EnergyOutputs {
        EnergyOutputs::default()
    }
}
