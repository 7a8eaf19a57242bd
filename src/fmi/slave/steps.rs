//! Steps of a slave, which may stop early at an event or at the end of a method's step, and the two sides of an event.

use super::access::finite_number;
use super::course::Course;
use super::engine::Stops;
use super::error::VariableError;
use super::states::indicator_place;
use super::{Error, Slave};
use crate::model::joint::guide::contact_of_corner;
use crate::model::joint::rectangle::CORNERS;
use crate::scene::{JointModel, Surface};
use crate::simulation::{ContactReport, PINS, Side, contacts};

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

    /// Begins a communication interval whose outputs, such as the largest approach speed, count over all stops at a
    /// method's steps.
    pub fn begin_interval(&mut self) -> Result<(), Error> {
        let Course::Own(simulation) = self.live()? else { return Err(Error::Interface) };
        // An advance to the point reached moves nothing.
        let reached = simulation.time();
        Ok(simulation.advance(reached, Stops::Nowhere).map(drop)?)
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

    /// The contacts at this instant. Those change that close or open at the events here or, where the importer integrates,
    /// at the next update.
    pub fn contacts(&mut self) -> Result<ContactReport, Error> {
        Ok(self.live()?.contacts())
    }

    /// [m] Penetration of each corner of the slider into the guide, 0 for an ideal guide, and whether the corner touches.
    pub fn corners(&mut self) -> Result<[(f64, bool); CORNERS], Error> {
        let mut corners = [(0.0, false); CORNERS];
        let joint = &self.settings.scene.joint.t;
        if joint.model == JointModel::Ideal {
            return Ok(corners);
        }
        let surface = joint.surface;
        let ContactReport { penetration, closed, .. } = self.contacts()?;
        for ((corner, depth), contact) in corners.iter_mut().zip(&penetration[PINS..]).zip(contact_of_corner(surface)) {
            // A face touches with those of its corners that are in the guide.
            let touches = closed[PINS + contact] && (surface == Surface::Corner || *depth > 0.0);
            *corner = (finite_number("penetration of a corner", *depth)?, touches);
        }
        Ok(corners)
    }

    /// Whether the packaged scene, whose clocks are declared, or the present one has this contact.
    pub fn has_clock(&self, contact: usize) -> bool {
        [&self.packaged, &self.settings.scene].into_iter().any(|scene| contacts(scene).contains(&contact))
    }

    /// An event indicator of the packaged scene, whichever side integrates.
    pub fn indicator(&mut self, place: usize) -> Result<f64, Error> {
        let place = indicator_place(&self.packaged, &self.settings.scene, place)
            .ok_or(VariableError::Absent("event indicator of this number"))?;
        finite_number("an event indicator", self.contacts()?.indicators[place])
    }
}
