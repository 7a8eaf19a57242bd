//! Reads many variables with one call for each type.

use super::description::{Kind, Variable};
use super::library::{Instance, Status};

/// Variables that are read together, with the values last read. Strings have no numerical value and are read as 0.
#[derive(Default)]
pub struct Selection {
    real: Group<f64>,
    integer: Group<i32>,
    enumeration: Group<i32>,
    boolean: Group<i32>,
    values: Vec<f64>,
}

/// The variables of one C type: value references, positions in the selection, and a buffer for the call.
#[derive(Default)]
struct Group<T> {
    references: Vec<u32>,
    places: Vec<usize>,
    values: Vec<T>,
}

impl<T: Copy + Default> Group<T> {
    fn push(&mut self, reference: u32, place: usize) {
        self.references.push(reference);
        self.places.push(place);
        self.values.push(T::default());
    }

    fn read(
        &mut self,
        call: impl FnOnce(&[u32], &mut [T]) -> Status,
        number: fn(T) -> f64,
        into: &mut [f64],
    ) -> Status {
        if self.references.is_empty() {
            return Status::Ok;
        }
        let status = call(&self.references, &mut self.values);
        self.places.iter().zip(&self.values).for_each(|(place, value)| into[*place] = number(*value));
        status
    }
}

impl Selection {
    /// Selects `variables` in this order.
    pub fn new<'a>(variables: impl IntoIterator<Item = &'a Variable>) -> Self {
        let mut selection = Self::default();
        for (place, variable) in variables.into_iter().enumerate() {
            selection.values.push(0.0);
            match variable.kind {
                Kind::Real => selection.real.push(variable.reference, place),
                Kind::Integer => selection.integer.push(variable.reference, place),
                Kind::Enumeration => selection.enumeration.push(variable.reference, place),
                Kind::Boolean => selection.boolean.push(variable.reference, place),
                Kind::String | Kind::Other => {}
            }
        }
        selection
    }

    /// Calls the get function of each type that the selection has. Returns the first status that is not OK, if there is
    /// one.
    pub(super) fn read_from(&mut self, instance: &mut Instance) -> Status {
        let Self { real, integer, enumeration, boolean, values } = self;
        let calls = [
            real.read(|references, buffer| instance.get_real(references, buffer), |value| value, values),
            integer.read(|references, buffer| instance.get_integer(references, buffer), f64::from, values),
            enumeration.read(|references, buffer| instance.get_enumeration(references, buffer), f64::from, values),
            boolean.read(
                |references, buffer| instance.get_boolean(references, buffer),
                |value| f64::from(value != 0),
                values,
            ),
        ];
        calls.into_iter().find(|status| *status != Status::Ok).unwrap_or(Status::Ok)
    }

    /// The values last read.
    pub fn values(&self) -> &[f64] {
        &self.values
    }
}
