//! The contacts of a mechanism as an importer watches them: event indicators, and which contacts are closed.
//!
//! An event indicator is the gap of a contact over its clearance: positive while the contact is open, at most 0 while it
//! is closed. So an event changes no indicator's sign, and a host that compares the signs before and after sees none.
//! An open contact closes where it penetrates by [`HYSTERESIS`] of a noticeable length, a closed one opens where its gap is
//! as wide. The indicator is shifted by as much, so that it is never near 0 after an event. The force at that penetration is
//! some 1e-8 of a noticeable one. A method of ours locates events without that shift.

use crate::integrator::{EventFunction, EventFunctions, MAX_EVENTS, Triggered};
use crate::model::coordinates::event_count;
use crate::model::joint::guide::contact_of_corner;
use crate::model::mechanism_model::MechanismModel;
pub use crate::model::state::CONTACTS;
use crate::model::state::{Conditions, Contacts};
use crate::scene::{JointModel, Scene};
use std::ops::Range;

/// Number of pins, each with a contact.
pub const PINS: usize = 3;
/// Part of a noticeable length.
const HYSTERESIS: f64 = 1e-5;
/// Part of the change point's scale before which no motion goes on.
const MARGIN: f64 = 0.1;

/// The contacts at one instant. Its layout is that of C: two builds of the library exchange it. Contacts of the pins A, B
/// and C come before those of the guide: its four corners, or its two faces.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct ContactReport {
    /// The event indicators, as many as the scene has; those behind them are 0.
    pub indicators: [f64; CONTACTS],
    /// [m] Penetration at each pin and at each corner of the slider, also where faces touch; negative across a gap.
    pub penetration: [f64; CONTACTS],
    /// Whether each contact is closed.
    pub closed: [bool; CONTACTS],
    /// Whether each contact closes or opens at this instant.
    pub changes: [bool; CONTACTS],
}

/// A contact that may close.
struct WatchedContact {
    /// Its place among all contacts.
    place: usize,
    /// Its event functions: of a closed face, the first one holds.
    events: Range<usize>,
    /// [m]
    clearance: f64,
}

/// The contacts of a scene that may close; in a closed loop, its change point.
pub struct ContactWatch {
    contacts: Vec<WatchedContact>,
    indicators: usize,
}

/// A mechanism at an instant.
#[derive(Clone, Copy)]
pub struct Instant<'a> {
    /// Its equations.
    pub model: &'a dyn MechanismModel,
    /// Its discrete states and inputs.
    pub conditions: &'a Conditions,
    /// [s]
    pub time: f64,
    /// Its states.
    pub states: &'a [f64],
}

impl Instant<'_> {
    fn event_functions(&self) -> EventFunctions {
        let mut functions = [EventFunction::default(); MAX_EVENTS];
        self.model.event_functions(self.conditions, self.time, self.states, &mut functions);
        functions
    }
}

impl ContactWatch {
    /// Watches the contacts of a scene.
    pub fn new(scene: &Scene) -> Self {
        Self { contacts: watched(scene), indicators: event_count(scene) }
    }

    /// Number of event indicators.
    pub fn indicators(&self) -> usize {
        self.indicators
    }

    /// Writes the event indicators.
    pub fn write_indicators(&self, at: &Instant<'_>, indicators: &mut [f64]) {
        let functions = at.event_functions();
        if self.contacts.is_empty() {
            // A closed loop, whose event function falls to 0 where the rod stands across the guide.
            indicators.fill(self.change_point(at, &functions).map_or(1.0, |EventFunction { value, .. }| value));
        }
        for (indicator, contact) in indicators.iter_mut().zip(&self.contacts) {
            *indicator = indicator_of(at, contact, &functions);
        }
    }

    /// The contacts between two discrete states, of which those of `at` are shown.
    pub fn report(&self, at: &Instant<'_>, before: &Contacts, after: &Contacts) -> ContactReport {
        let mut report = ContactReport::default();
        self.write_indicators(at, &mut report.indicators[..self.indicators]);
        let evaluation = at.model.evaluation(at.conditions, at.time, at.states);
        report.penetration = at.model.penetration(&evaluation.pose);
        report.closed = at.conditions.contacts.map(|contact| contact.closed);
        for (change, (before, after)) in report.changes.iter_mut().zip(before.iter().zip(after)) {
            *change = before.closed != after.closed;
        }
        report
    }

    /// The contacts of a mechanism whose importer integrates: those change that are due.
    pub fn report_due(&self, at: &Instant<'_>) -> ContactReport {
        let contacts = &at.conditions.contacts;
        let mut report = self.report(at, contacts, contacts);
        let functions = at.event_functions();
        for contact in self.contacts.iter().filter(|contact| is_due(at, contact, &functions)) {
            report.changes[contact.place] = true;
        }
        report
    }

    /// Which event functions make a contact close or open that has not done so although its indicator says it.
    pub fn due(&self, at: &Instant<'_>) -> Triggered {
        let functions = at.event_functions();
        let mut triggered: Triggered = [false; MAX_EVENTS];
        for contact in self.contacts.iter().filter(|contact| is_due(at, contact, &functions)) {
            triggered[contact.events.start] = true;
        }
        triggered
    }

    /// Whether the motion goes on from here.
    pub fn leads_no_further(&self, at: &Instant<'_>) -> bool {
        let change_point = self.change_point(at, &at.event_functions());
        change_point.is_some_and(|EventFunction { value, rate }| value <= 0.0 && rate < 0.0)
    }

    /// A closed loop's distance to its change point, where it has one.
    fn change_point(&self, at: &Instant<'_>, functions: &EventFunctions) -> Option<EventFunction> {
        let EventFunction { value, rate } = functions[0];
        let has_one = self.contacts.is_empty() && at.model.event_count() > 0;
        has_one.then(|| EventFunction { value: value - MARGIN * at.model.event_scale(), rate })
    }
}

fn indicator_of(at: &Instant<'_>, contact: &WatchedContact, functions: &EventFunctions) -> f64 {
    let shift = HYSTERESIS * at.model.event_scale();
    let functions = &functions[contact.events.clone()];
    let gap = if at.conditions.contacts[contact.place].closed {
        -functions[0].value - shift
    } else {
        functions.iter().map(|function| function.value).fold(f64::INFINITY, f64::min) + shift
    };
    gap / contact.clearance
}

fn is_due(at: &Instant<'_>, contact: &WatchedContact, functions: &EventFunctions) -> bool {
    let closed = at.conditions.contacts[contact.place].closed;
    let indicator = indicator_of(at, contact, functions);
    if closed { indicator > 0.0 } else { indicator <= 0.0 }
}

/// The contacts of a scene that may close, by their places among all.
pub fn contacts(scene: &Scene) -> Vec<usize> {
    watched(scene).into_iter().map(|contact| contact.place).collect()
}

/// What has this event function, in words.
pub fn subject_of_event(scene: &Scene, event: usize) -> String {
    let contact = watched(scene).into_iter().find(|contact| contact.events.contains(&event));
    contact.map_or_else(|| "the rod across the guide".into(), |contact| subject(contact.place))
}

/// A contact in words. Those of the guide are its corners or, where faces touch, its two faces.
pub fn subject(contact: usize) -> String {
    match ["A", "B", "C"].get(contact) {
        Some(joint) => format!("joint {joint}'s contact"),
        None => format!("joint T's contact {}", contact + 1 - PINS),
    }
}

/// The contacts of a scene that may close, in the order of their event functions.
fn watched(scene: &Scene) -> Vec<WatchedContact> {
    let joint = &scene.joint;
    let mut all: Vec<WatchedContact> = vec![];
    for (place, revolute) in [&joint.a, &joint.b, &joint.c].into_iter().enumerate() {
        if revolute.model == JointModel::Clearance {
            let event = all.len();
            all.push(WatchedContact { place, events: event..event + 1, clearance: revolute.clearance });
        }
    }
    if joint.t.model == JointModel::Clearance {
        let first = all.len();
        for (corner, contact) in contact_of_corner(joint.t.surface).into_iter().enumerate() {
            let (place, event) = (PINS + contact, first + corner);
            match all.last_mut() {
                Some(last) if last.place == place => last.events.end = event + 1,
                _ => all.push(WatchedContact { place, events: event..event + 1, clearance: joint.t.clearance }),
            }
        }
    }
    all
}
