//! Many variables read with one call a type.

use super::description::{Kind, Variable};
use super::library::{Instance, Status};

/// Variables to read together, and their values when last read. Texts have no number and read as 0.
#[derive(Default)]
pub struct Selection {
    real: Group<f64>,
    integer: Group<i32>,
    enumeration: Group<i32>,
    boolean: Group<i32>,
    values: Vec<f64>,
}

/// Those of one C type: references, places in the selection, and the buffer of one call.
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
    /// Selects `variables`, in their order.
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

    /// The getters of FMI 2.0 or 3.0, each once if there is something to ask; the first complaint, if any.
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

    /// As last read.
    pub fn values(&self) -> &[f64] {
        &self.values
    }
}
