//! Steps of a slave, which may stop early at an event or at the end of a method's step, and the two sides of an event.

use super::course::Course;
use super::engine::Stops;
use super::{Error, Slave};
use crate::simulation::Side;

impl Slave {
    /// [s] The communication point reached, as time since the start.
    pub fn reached(&self) -> f64 {
        self.elapsed()
    }

    /// [s] A time of the importer as time since the start.
    pub fn counted_from_start(&self, time: f64) -> f64 {
        time - self.settings.experiment.start
    }

    /// Advances to `end`, a time since the start, or as far as possible.
    pub fn advance_to(&mut self, end: f64) -> Result<(), Error> {
        self.advance_with(end, Stops::Nowhere).map(drop)
    }

    /// Advances to `end`, a time since the start, or to the first stop before it. Returns whether a contact has closed
    /// or opened there. The trajectory does not depend on the stops.
    pub fn advance_with(&mut self, end: f64, stops: Stops) -> Result<bool, Error> {
        // The life cycle allows no steps in model exchange.
        let Course::Own(simulation) = self.live()? else { return Err(Error::Interface) };
        let outcome = simulation.advance(end, stops);
        self.settings.inputs.move_on();
        self.outputs = None;
        let start = self.settings.experiment.start;
        Ok(outcome.map_err(|error| error.counted_from(start))?)
    }

    /// Selects the side of the events at this communication point on which outputs and their derivatives are read,
    /// until the next step.
    pub fn look(&mut self, side: Side) -> Result<(), Error> {
        if let Course::Own(simulation) = self.live()? {
            simulation.look(side);
        }
        self.outputs = None;
        Ok(())
    }
}
