//! Methods, with the series of tolerances or step sizes for each.

use crate::host::Setting;
use slidercrank::scene::Method;

/// Property of a method that uses `solver.step` instead of `solver.tolerance`.
pub const FIXED_STEP: &str = "fixed step";
/// Property of a method with rigid contacts: it computes a different motion, so it has no error.
pub const RIGID_CONTACTS: &str = "rigid contacts";

/// Tolerances, two per decade.
const TOLERANCES: [f64; 15] =
    [1e-3, 3e-4, 1e-4, 3e-5, 1e-5, 3e-6, 1e-6, 3e-7, 1e-7, 3e-8, 1e-8, 3e-9, 1e-9, 3e-10, 1e-10];
/// [s] Step sizes, three per decade.
const STEPS: [f64; 9] = [5e-5, 2e-5, 1e-5, 5e-6, 2e-6, 1e-6, 5e-7, 2e-7, 1e-7];
/// A quick overview uses one of so many tolerances or step sizes; of the tolerances, 1e-4 is the first.
const QUICK: [usize; 2] = [4, 2];

/// Tolerance, step size or budget of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Rung {
    /// `solver.tolerance`.
    Tolerance(f64),
    /// [s] `solver.step`.
    Step(f64),
    /// [1/s] `solver.deadline`, at the tolerance that the FMU was packaged with.
    Deadline(f64),
}

impl Rung {
    /// Its value.
    pub fn number(self) -> f64 {
        match self {
            Self::Tolerance(number) | Self::Step(number) | Self::Deadline(number) => number,
        }
    }

    /// Name of the FMU's parameter.
    pub fn parameter(self) -> &'static str {
        match self {
            Self::Tolerance(_) => "solver.tolerance",
            Self::Step(_) => "solver.step",
            Self::Deadline(_) => "solver.deadline",
        }
    }
}

/// `verner7 at tolerance 1e-6`.
pub fn told(method: Method, rung: Rung) -> String {
    match rung {
        Rung::Tolerance(tolerance) => format!("{} at tolerance {tolerance:e}", method.name()),
        Rung::Step(step) => format!("{} at steps of {} µs", method.name(), step * 1e6),
        Rung::Deadline(deadline) => format!("{} within {deadline:.2e} evaluations/s", method.name()),
    }
}

/// Settings of the FMU.
pub fn settings(method: Method, rung: Rung) -> Vec<Setting> {
    let set = |name: &str, value: String| Setting { name: name.into(), value };
    vec![set("solver.method", method.name().into()), set(rung.parameter(), format!("{:e}", rung.number()))]
}

/// The methods that solve the scene's equations, and the methods that solve different ones.
pub fn methods() -> (Vec<Method>, Vec<Method>) {
    Method::ALL.iter().partition(|method| !method.has(RIGID_CONTACTS))
}

/// Tolerances or step sizes of a method, from coarse to fine; only some of them if `quick`.
pub fn rungs(method: Method, quick: bool) -> Vec<Rung> {
    let [tolerances, steps] = if quick { QUICK } else { [1, 1] };
    if method.has(FIXED_STEP) {
        STEPS.into_iter().step_by(steps).map(Rung::Step).collect()
    } else {
        TOLERANCES.into_iter().skip(tolerances / 2).step_by(tolerances).map(Rung::Tolerance).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_property_of_a_method_is_known_here() {
        let declared = slidercrank::model_description::load().expect("the declaration");
        let methods = declared.enumerations.iter().find(|own| own.name == "Method").expect("the methods");
        let properties = methods.items.iter().flat_map(|item| &item.properties);
        for property in properties {
            assert!([FIXED_STEP, RIGID_CONTACTS].contains(&property.as_str()), "{property}");
        }
    }

    #[test]
    fn no_method_is_forgotten_and_ladders_go_down() {
        let (same, others) = methods();
        assert_eq!(same.len() + others.len(), Method::ITEMS.len());
        assert!(same.contains(&Method::default()));
        for method in same {
            for quick in [false, true] {
                let rungs = rungs(method, quick);
                assert!(rungs.len() >= 4 && rungs.windows(2).all(|pair| pair[0].number() > pair[1].number()));
            }
        }
        assert!(rungs(Method::default(), true).contains(&Rung::Tolerance(1e-6)));
    }
}
