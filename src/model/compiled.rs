//! The constant structures that get code of their own.
//!
//! The equations of motion are compiled once a number, for every structure. With one play in a pin, or none, that is not
//! enough: there is little to compute, and asking what hangs on what takes as long. So for these seven structures the same
//! source is compiled again, with the structure a constant, of which nothing is left to ask.
//!
//! What a step's stages hand on to one another must not pass through memory in other portions than it is read in; so the
//! loop over them is compiled with the equations in it.

use super::mechanism::Mechanism;
use super::stages::in_registers;
use super::state::Contacts;
use super::structure::{Structure, Topology};
use crate::integrator::{EventFunctions, Tableau};
use crate::math::Row;

/// Writes the rates of eight states at their times.
type RatesOfEight = fn(&Mechanism, &Contacts, Row, &[Row], &mut [Row]);
/// Writes the rates of a state, and the event functions.
type Ends = fn(&Mechanism, &Contacts, f64, &[f64], &mut [f64], &mut EventFunctions);
/// See [`Ode::stages`](crate::integrator::Ode::stages).
type Stages = fn(&Mechanism, &Tableau, &Contacts, f64, &[f64], f64, &mut [f64]) -> bool;

/// What steps are made of, compiled for one structure or for all.
#[derive(Clone, Copy, Debug)]
pub struct Compiled {
    /// Rates of eight states.
    pub rates_of_eight: RatesOfEight,
    /// Rates and event functions of one.
    pub ends: Ends,
    /// Rates at the stages of a step.
    pub stages: Stages,
}

/// The code for a structure.
pub fn compiled(structure: &Structure) -> Compiled {
    /// That of these ideal joints (main bearing, crank pin, slider pin) beside an ideal guide, and of the prescribed speed.
    macro_rules! own {
        ($(($a:literal $b:literal $c:literal $speed:literal))*) => {
            match structure.topology {
                $(Topology { a: $a, b: $b, c: $c, t: true, speed: $speed } => {
                    const OWN: Structure =
                        Structure::new(Topology { a: $a, b: $b, c: $c, t: true, speed: $speed });
                    Compiled {
                        rates_of_eight: |mechanism, contacts, t, y, rates| {
                            mechanism.rates(&OWN, contacts, t, y, rates);
                        },
                        ends: |mechanism, contacts, t, y, rates, guards| {
                            mechanism.rates_and_guards(&OWN, contacts, t, y, rates, guards);
                        },
                        stages: |mechanism, tableau, contacts, t, y, h, k| {
                            in_registers::<{ 2 * OWN.positions }>(tableau, t, y, h, k, |t, y, rates| {
                                mechanism.rates(&OWN, contacts, t, y, rates);
                            })
                        },
                    }
                })*
                _ => Compiled {
                    rates_of_eight: Mechanism::rates_of_eight,
                    ends: Mechanism::ends,
                    stages: |_, _, _, _, _, _, _| false,
                },
            }
        };
    }
    own!(
        (true true true false)
        (true true false true)  (true false true true)  (false true true true)
        (true true false false) (true false true false) (false true true false)
    )
}
