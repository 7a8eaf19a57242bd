//! Outputs by name.

use anyhow::{Context, Result, ensure};
use slidercrank::fmi::slave::variables::{Access, VARIABLES};
use slidercrank::model::signals::{EnergyOutputs, Outputs};

/// Refuses a name that no column of a run has: neither an output of any type nor a vector with the components x and y.
///
/// # Errors
/// If there is no such output.
pub fn check_column(name: &str) -> Result<()> {
    let found = components(name, |access| match access {
        Access::RealOutput(_) | Access::IntegerOutput(_) | Access::BooleanOutput(_) => Some(()),
        _ => None,
    });
    ensure!(found.is_some(), "`{name}` is neither an output nor a vector of two");
    Ok(())
}

/// What `of` takes from the variable of this name, or from those of the components x and y.
fn components<T>(name: &str, of: impl Fn(&Access) -> Option<T>) -> Option<Vec<T>> {
    let find =
        |name: &str| VARIABLES.iter().find(|variable| variable.name == name).and_then(|variable| of(&variable.access));
    match find(name) {
        Some(one) => Some(vec![one]),
        None => ["x", "y"].iter().map(|axis| find(&format!("{name}.{axis}"))).collect(),
    }
}

/// A real output, or a vector with the components x and y, whose length is taken.
#[derive(Clone, Debug, PartialEq)]
pub struct Output {
    components: Vec<fn(&Outputs) -> f64>,
}

impl Output {
    /// The output of a name, such as `slider.a` or `joint.C.force`.
    ///
    /// # Errors
    /// If there is no such real output.
    pub fn named(name: &str) -> Result<Self> {
        let components = components(name, |access| match access {
            Access::RealOutput(get) => Some(*get),
            _ => None,
        });
        let components =
            components.with_context(|| format!("`{name}` is neither a real output nor a vector of two"))?;
        Ok(Self { components })
    }

    /// Whether it tells what happened since an earlier communication point.
    pub fn is_of_an_interval(&self) -> bool {
        self.is_among_the_nans_of(&Outputs::undetermined())
    }

    /// Whether it sums what happened since the start.
    pub fn is_a_sum(&self) -> bool {
        let nan = f64::NAN;
        let energy = EnergyOutputs {
            input: nan,
            dissipated: nan,
            residual: nan,
            torque_work: nan,
            load_work: nan,
            contact_loss: nan,
            friction_loss: nan,
            viscous_loss: nan,
            modal_loss: nan,
            ..EnergyOutputs::default()
        };
        self.is_among_the_nans_of(&Outputs { energy, ..Outputs::default() })
    }

    fn is_among_the_nans_of(&self, outputs: &Outputs) -> bool {
        self.components.iter().any(|get| get(outputs).is_nan())
    }

    /// Its value.
    pub fn value(&self, outputs: &Outputs) -> f64 {
        match self.components[..] {
            [get] => get(outputs),
            _ => self.components.iter().map(|get| get(outputs).powi(2)).sum::<f64>().sqrt(),
        }
    }

    /// Its derivative, given those of the outputs.
    pub fn slope(&self, outputs: &Outputs, slopes: &Outputs) -> f64 {
        match self.components[..] {
            [get] => get(slopes),
            _ => {
                let length = self.value(outputs);
                let product: f64 = self.components.iter().map(|get| get(outputs) * get(slopes)).sum();
                if length > 0.0 { product / length } else { 0.0 }
            }
        }
    }
}
