//! Reading and writing variables. Values set together are applied all or none.

use super::super::error::{Error, VariableError};
use super::super::lifecycle::{State, Touch};
use super::super::variables::{Access, VARIABLES, Variable};
use super::Instance;
use crate::scene::parameter::{Kind, Parameter};

/// FMI type of a variable.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Type {
    Real,
    Integer,
    Boolean,
    Enumeration,
}

impl Type {
    fn of(variable: &Variable) -> Self {
        match &variable.access {
            Access::Input { .. } | Access::RealOutput(_) => Self::Real,
            Access::IntegerOutput(_) => Self::Integer,
            Access::BooleanOutput(_) => Self::Boolean,
            Access::Parameter(Parameter { kind, .. }) => match kind {
                Kind::Real { .. } => Self::Real,
                Kind::Integer { .. } => Self::Integer,
                Kind::Boolean { .. } => Self::Boolean,
                Kind::Enumeration { .. } => Self::Enumeration,
            },
        }
    }

    fn name(self) -> &'static str {
        match self {
            Self::Real => "Real",
            Self::Integer => "Integer",
            Self::Boolean => "Boolean",
            Self::Enumeration => "Enumeration",
        }
    }
}

/// The variable of this value reference.
pub(super) fn variable(reference: u32) -> Result<&'static Variable, VariableError> {
    let found = usize::try_from(reference).ok().and_then(|index| VARIABLES.get(index));
    found.ok_or(VariableError::Unknown(reference))
}

/// The variable of this value reference, which must be of one of these types; enumerations pass as
/// integers.
fn typed(reference: u32, asked: Type) -> Result<&'static Variable, VariableError> {
    let variable = variable(reference)?;
    match (Type::of(variable), asked) {
        (Type::Enumeration, Type::Integer) => Ok(variable),
        (is, asked) if is == asked => Ok(variable),
        (is, asked) => Err(VariableError::Type { name: variable.name, is: is.name(), asked: asked.name() }),
    }
}

/// Refuses what the lifecycle does not allow to this kind of variable.
fn check(variable: &Variable, state: State, write: bool) -> Result<(), VariableError> {
    let (causality, get, set) = match variable.access {
        Access::Input { .. } => ("input", Touch::GetInput, Touch::SetInput),
        Access::Parameter(_) => ("fixed parameter", Touch::GetParameter, Touch::SetParameter),
        Access::RealOutput(_) | Access::IntegerOutput(_) | Access::BooleanOutput(_) => {
            ("output", Touch::GetOutput, Touch::SetOutput)
        }
    };
    if (if write { set } else { get }).allowed(state) {
        Ok(())
    } else {
        Err(VariableError::Moment { name: variable.name, write, causality, state })
    }
}

/// Refuses NaN and infinity.
pub(super) fn finite(variable: &Variable, value: f64) -> Result<f64, VariableError> {
    if value.is_finite() { Ok(value) } else { Err(VariableError::NotFinite(variable.name, value)) }
}

/// An output that may be told: loads beyond all measure may leave it without a number.
pub(super) fn told(variable: &Variable, value: f64) -> Result<f64, Error> {
    if value.is_finite() { Ok(value) } else { Err(Error::NoNumber(variable.name, value)) }
}

impl Instance {
    /// `fmi2GetReal`
    pub fn get_real(&mut self, references: &[u32], values: &mut [f64]) -> Result<(), Error> {
        self.get(Type::Real, references, values, |value| value)
    }

    /// `fmi2GetInteger`; enumerations are read by it too.
    pub fn get_integer(&mut self, references: &[u32], values: &mut [i32]) -> Result<(), Error> {
        self.get(Type::Integer, references, values, |value| value as i32)
    }

    /// `fmi2GetBoolean`
    pub fn get_boolean(&mut self, references: &[u32], values: &mut [i32]) -> Result<(), Error> {
        self.get(Type::Boolean, references, values, |value| value as i32)
    }

    /// `fmi2SetReal`
    pub fn set_real(&mut self, references: &[u32], values: &[f64]) -> Result<(), Error> {
        self.set(Type::Real, references, values, |value| value)
    }

    /// `fmi2SetInteger`; enumerations are set by it too.
    pub fn set_integer(&mut self, references: &[u32], values: &[i32]) -> Result<(), Error> {
        self.set(Type::Integer, references, values, f64::from)
    }

    /// `fmi2SetBoolean`
    pub fn set_boolean(&mut self, references: &[u32], values: &[i32]) -> Result<(), Error> {
        self.set(Type::Boolean, references, values, |value| f64::from(u8::from(value != 0)))
    }

    /// `fmi2GetString`, `fmi2SetString`: no variable is a string.
    pub fn touch_string(&self, references: &[u32]) -> Result<(), Error> {
        match references {
            [] => Ok(()),
            [first, ..] => {
                let variable = variable(*first)?;
                let is = Type::of(variable).name();
                Err(VariableError::Type { name: variable.name, is, asked: "String" }.into())
            }
        }
    }

    /// Reads variables of one type, none if one of them is refused. Every value fits an `f64`: reals, 32-bit integers,
    /// Booleans.
    fn get<T>(&mut self, asked: Type, references: &[u32], values: &mut [T], out: fn(f64) -> T) -> Result<(), Error> {
        let mut outputs = false;
        for &reference in references {
            let variable = typed(reference, asked)?;
            check(variable, self.state, false)?;
            outputs |= !matches!(variable.access, Access::Input { .. } | Access::Parameter(_));
        }
        if outputs {
            self.outputs()?;
        }
        for (&reference, value) in references.iter().zip(values) {
            let variable = variable(reference)?;
            *value = out(match &variable.access {
                Access::Input { get, .. } => told(variable, get(&self.inputs.values(self.time())))?,
                Access::RealOutput(get) => told(variable, get(self.outputs()?))?,
                Access::IntegerOutput(get) => f64::from(get(self.outputs()?)),
                Access::BooleanOutput(get) => f64::from(u8::from(get(self.outputs()?))),
                Access::Parameter(parameter) => parameter.value(&self.scene),
            });
        }
        Ok(())
    }

    /// Writes variables of one type: into drafts first, which count once every value is legal.
    fn set<T: Copy>(&mut self, asked: Type, references: &[u32], values: &[T], into: fn(T) -> f64) -> Result<(), Error> {
        // Inputs are set every step: the scene is copied only where one of its parameters is.
        let (mut scene, mut inputs, time) = (None, self.inputs, self.time());
        for (&reference, &value) in references.iter().zip(values) {
            let variable = typed(reference, asked)?;
            check(variable, self.state, true)?;
            let value = finite(variable, into(value))?;
            match &variable.access {
                Access::Input { get, set, .. } => inputs.set_value(*set, *get, time, value),
                Access::Parameter(parameter) => {
                    parameter.write(scene.get_or_insert_with(|| self.scene.clone()), value)?;
                }
                // `check` lets no write to an output pass.
                Access::RealOutput(_) | Access::IntegerOutput(_) | Access::BooleanOutput(_) => {}
            }
        }
        self.inputs = inputs;
        if let Some(scene) = scene {
            self.scene = scene;
        }
        self.inputs_or_scene_changed();
        Ok(())
    }

    /// Drops what no longer holds.
    pub(super) fn inputs_or_scene_changed(&mut self) {
        self.outputs = None;
        if Touch::SetParameter.allowed(self.state) {
            self.simulation = None;
        }
    }
}
