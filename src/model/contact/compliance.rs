//! Elastic compliance of two bodies in contact.

use crate::scene::Contact;

/// σ_b + σ_j [1/Pa], σ = (1 − ν²)/E.
pub fn compliance(contact: &Contact) -> f64 {
    let sigma = |young: f64, poisson: f64| (1.0 - poisson * poisson) / young;
    sigma(contact.young.bearing, contact.poisson.bearing) + sigma(contact.young.journal, contact.poisson.journal)
}
