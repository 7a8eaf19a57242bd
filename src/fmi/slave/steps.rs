//! Steps to their end, or to an earlier one: at an event, or with a step of the method; and both sides of an event.

use super::course::Course;
use super::engine::Stops;
use super::{Error, Slave};
use crate::simulation::Side;

impl Slave {
    /// [s] The communication point reached, counted from the start.
    pub fn reached(&self) -> f64 {
        self.elapsed()
    }

    /// [s] A time of the importer's, counted from the start.
    pub fn counted_from_start(&self, time: f64) -> f64 {
        time - self.settings.experiment.start
    }

    /// Moves the slave to `end`, counted from the start, or as far as it gets.
    pub fn advance_to(&mut self, end: f64) -> Result<(), Error> {
        self.advance_with(end, Stops::Nowhere).map(drop)
    }

    /// Moves the slave to `end`, counted from the start, or to the first stop before it, and tells whether a contact has
    /// closed or opened there. The trajectory is the same whatever the stops.
    pub fn advance_with(&mut self, end: f64, stops: Stops) -> Result<bool, Error> {
        // The lifecycle lets no step into model exchange.
        let Course::Own(simulation) = self.live()? else { return Err(Error::Interface) };
        let outcome = simulation.advance(end, stops);
        self.settings.inputs.move_on();
        self.outputs = None;
        let start = self.settings.experiment.start;
        Ok(outcome.map_err(|error| error.counted_from(start))?)
    }

    /// Reads outputs and their derivatives from now on on this side of the events at the communication point, until time
    /// moves.
    pub fn look(&mut self, side: Side) -> Result<(), Error> {
        if let Course::Own(simulation) = self.live()? {
            simulation.look(side);
        }
        self.outputs = None;
        Ok(())
    }
}
