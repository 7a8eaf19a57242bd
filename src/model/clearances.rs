//! The joints with clearance of a mechanism: their contact forces, event functions, and contact states.
//!
//! The argument `play` says which joints have clearance. It is that of the mechanism's
//! [`Structure`](super::structure::Structure), which may be a compile-time constant.

use super::bodies::bodies;
use super::bristles::bristled_contacts;
use super::contact::{ContactEnergy, ContactParameters, ContactState, Rubbing};
use super::films::Films;
use super::joint::guide::{GUIDE_CONTACTS, Guide};
use super::joint::rectangle::CORNERS;
use super::joint::revolute::Revolute;
use super::joint_set::{JointSet, Pin};
use super::loads::Loads;
use super::scalar::Scalar;
use super::state::{CONTACTS, Conditions, Contacts, Pose};
use super::structure::{CRANK, ROD, SLIDER};
use super::touches::Touches;
use crate::integrator::{ContactLaw, Discontinuities, EventFunctions, MAX_EVENTS, Reset, Triggered};
use crate::scene::{Contact, FrictionLaw, JointModel, Scene};

/// The joints of a scene with their contact parameters.
#[derive(Clone, Debug)]
pub struct Clearances {
    pub(super) revolute: [Revolute; 3],
    pub(super) guide: Guide,
    /// The oil films of the lubricated joints.
    pub(super) films: Films,
    /// [kg] Masses of crank, rod and slider.
    mass: [f64; 3],
    /// The contacts with bristles, by their index among all contacts, in the order of their states.
    pub bristles: Vec<usize>,
    /// For each contact, the index of its bristles among the bristle states.
    bristle: [Option<usize>; CONTACTS],
    /// Restitution, friction and clearance of rigid contacts.
    pub(super) laws: [ContactLaw; CONTACTS],
}

/// Restitution, friction coefficient and clearance of every contact of a scene; of a friction law, the (kinetic) coefficient
/// is taken.
fn laws(scene: &Scene) -> [ContactLaw; CONTACTS] {
    let law = |contact: &Contact, clearance: f64| ContactLaw {
        restitution: contact.restitution,
        friction: if contact.friction.law == FrictionLaw::None { 0.0 } else { contact.friction.coefficient },
        clearance,
    };
    let joint = &scene.joint;
    let mut laws = [law(&joint.t.contact, joint.t.clearance); CONTACTS];
    for (place, joint) in laws.iter_mut().zip([&joint.a, &joint.b, &joint.c]) {
        *place = law(&joint.contact, joint.clearance);
    }
    laws
}

/// [m] Penetrations at which journals have left their bearings, in the order of the event functions: the centres are as far
/// apart as both radii together. No contact law holds there. The event function of an open contact is its gap, which is at
/// most the clearance.
pub fn deepest_journals(scene: &Scene) -> [f64; MAX_EVENTS] {
    let joint = &scene.joint;
    let with_play = [&joint.a, &joint.b, &joint.c].into_iter().filter(|joint| joint.model == JointModel::Clearance);
    let mut deepest = [f64::INFINITY; MAX_EVENTS];
    for (place, joint) in deepest.iter_mut().zip(with_play) {
        *place = (2.0 * (joint.radius - joint.clearance)).max(joint.clearance);
    }
    deepest
}

impl Clearances {
    /// The joints of a scene.
    pub fn new(scene: &Scene) -> Self {
        let joint = &scene.joint;
        let bristles: Vec<usize> = bristled_contacts(scene).into_iter().map(|(contact, _)| contact).collect();
        Self {
            revolute: [&joint.a, &joint.b, &joint.c].map(Revolute::new),
            guide: Guide::new(scene),
            films: Films::new(scene),
            mass: bodies(scene).map(|body| body.mass),
            bristle: std::array::from_fn(|contact| bristles.iter().position(|&bristled| bristled == contact)),
            bristles,
            laws: laws(scene),
        }
    }

    /// Adds the forces of the closed contacts. `deflections` [m] are those of the bristles, and their rates [m/s] are
    /// written to `deflection_rates`. Both lists are in the order of the bristle states, and empty without bristles.
    #[inline(always)]
    pub fn add_loads<R: Scalar>(
        &self,
        play: JointSet,
        contacts: &Contacts,
        pose: &Pose<R>,
        deflections: &[R],
        deflection_rates: &mut [R],
        loads: &mut Loads<R>,
    ) {
        if !self.bristles.is_empty() {
            deflection_rates[..self.bristles.len()].fill(R::ZERO);
        }
        // The calls are written out: in a loop the compiler would keep the loads in memory.
        self.add_pin(Pin::MainBearing, play, contacts, pose, deflections, deflection_rates, loads);
        self.add_pin(Pin::CrankPin, play, contacts, pose, deflections, deflection_rates, loads);
        self.add_pin(Pin::SliderPin, play, contacts, pose, deflections, deflection_rates, loads);
        if play.guide {
            let (mut z, mut rates) = ([R::ZERO; GUIDE_CONTACTS], [R::ZERO; GUIDE_CONTACTS]);
            let bristled = self.bristle[3].is_some();
            if bristled {
                z = self.guide_deflections(deflections);
            }
            loads.add_guide(&self.guide.load(&contacts[3..], &pose.slider(), &z, &mut rates));
            if bristled {
                for (place, rate) in self.bristle[3..].iter().zip(rates) {
                    if let Some(place) = *place {
                        deflection_rates[place] = rate;
                    }
                }
            }
        }
    }

    #[inline(always)]
    #[expect(clippy::too_many_arguments, reason = "inlined")]
    fn add_pin<R: Scalar>(
        &self,
        pin: Pin,
        play: JointSet,
        contacts: &Contacts,
        pose: &Pose<R>,
        deflections: &[R],
        deflection_rates: &mut [R],
        loads: &mut Loads<R>,
    ) {
        let state = &contacts[pin as usize];
        if play.contains(pin) && state.closed {
            let place = self.bristle[pin as usize];
            let z = place.map_or(R::ZERO, |place| deflections[place]);
            let load = self.revolute[pin as usize].load(state, &pose.journal(pin), z);
            loads.add_contact(pin, &load);
            if let Some(place) = place {
                deflection_rates[place] = load.bristle_rate;
            }
        }
    }

    /// Elastic energy of the closed contacts and the powers that they absorb.
    pub fn contact_energy<R: Scalar>(
        &self,
        play: JointSet,
        contacts: &Contacts,
        pose: &Pose<R>,
        deflections: &[R],
    ) -> ContactEnergy<R> {
        let mut contact_energy = ContactEnergy::default();
        for pin in play.pins() {
            let state = &contacts[pin as usize];
            if state.closed {
                let z = self.bristle[pin as usize].map_or(R::ZERO, |place| deflections[place]);
                contact_energy += self.revolute[pin as usize].contact_energy(state, &pose.journal(pin), z);
            }
        }
        if play.guide {
            contact_energy +=
                self.guide.contact_energy(&contacts[3..], &pose.slider(), &self.guide_deflections(deflections));
        }
        contact_energy
    }

    /// Sliding and forces of the closed contacts; zero in the open ones.
    pub fn rubbing(
        &self,
        play: JointSet,
        contacts: &Contacts,
        pose: &Pose,
        deflections: &[f64],
    ) -> [Rubbing; CONTACTS] {
        let mut all = [Rubbing::default(); CONTACTS];
        for pin in play.pins() {
            let state = &contacts[pin as usize];
            if state.closed {
                let z = self.bristle[pin as usize].map_or(0.0, |place| deflections[place]);
                all[pin as usize] = self.revolute[pin as usize].rubbing(state, &pose.journal(pin), z);
            }
        }
        if play.guide {
            let z = self.guide_deflections(deflections);
            all[3..].copy_from_slice(&self.guide.rubbing(&contacts[3..], &pose.slider(), &z));
        }
        all
    }

    /// The bristle deflections [m] of the guide's contacts; 0 without bristles.
    #[inline(always)]
    fn guide_deflections<R: Scalar>(&self, deflections: &[R]) -> [R; GUIDE_CONTACTS] {
        let mut z = [R::ZERO; GUIDE_CONTACTS];
        for (z, place) in z.iter_mut().zip(&self.bristle[3..]) {
            if let Some(place) = *place {
                *z = deflections[place];
            }
        }
        z
    }

    /// Penetration [m] and approach speed [m/s] of every contact; −∞ and 0 for a joint without clearance.
    #[inline(always)]
    pub fn penetrations<R: Scalar>(&self, play: JointSet, pose: &Pose<R>) -> [(R, R); CONTACTS] {
        let mut all = [(R::constant(f64::NEG_INFINITY), R::ZERO); CONTACTS];
        for pin in play.pins() {
            let (revolute, journal) = (&self.revolute[pin as usize], pose.journal(pin));
            all[pin as usize] = (revolute.penetration(&journal), revolute.penetration_rate(&journal));
        }
        if play.guide {
            all[3..].copy_from_slice(&self.guide.approaches(&pose.slider()));
        }
        all
    }

    /// [m] Penetration in joints A, B, C and at the guide's corners; −∞ for an ideal joint.
    pub fn depths(&self, play: JointSet, pose: &Pose) -> [f64; 3 + CORNERS] {
        let mut depths = self.penetrations(play, pose).map(|(depth, _)| depth);
        if play.guide {
            depths[3..].copy_from_slice(&self.guide.penetrations(&pose.slider()));
        }
        depths
    }

    /// Number of event functions; an ideal joint has none.
    #[inline(always)]
    pub fn event_count(&self, play: JointSet) -> usize {
        play.pins().count() + if play.guide { CORNERS } else { 0 }
    }

    /// Writes the event functions of all joints with clearance.
    #[inline(always)]
    pub fn event_functions(
        &self,
        play: JointSet,
        contacts: &Contacts,
        pose: &Pose,
        event_functions: &mut EventFunctions,
    ) {
        let mut place = 0;
        self.add_event_function(Pin::MainBearing, play, contacts, pose, event_functions, &mut place);
        self.add_event_function(Pin::CrankPin, play, contacts, pose, event_functions, &mut place);
        self.add_event_function(Pin::SliderPin, play, contacts, pose, event_functions, &mut place);
        if play.guide {
            event_functions[place..place + CORNERS]
                .copy_from_slice(&self.guide.event_functions(&contacts[3..], &pose.slider()));
        }
    }

    #[inline(always)]
    fn add_event_function(
        &self,
        pin: Pin,
        play: JointSet,
        contacts: &Contacts,
        pose: &Pose,
        event_functions: &mut EventFunctions,
        place: &mut usize,
    ) {
        if play.contains(pin) {
            event_functions[*place] =
                self.revolute[pin as usize].event_function(&contacts[pin as usize], &pose.journal(pin));
            *place += 1;
        }
    }

    /// Adds the functions whose zeros are derivative discontinuities of the closed contacts' forces.
    pub fn discontinuities(
        &self,
        play: JointSet,
        contacts: &Contacts,
        pose: &Pose,
        discontinuities: &mut Discontinuities,
    ) {
        for pin in play.pins() {
            let state = &contacts[pin as usize];
            if state.closed {
                self.revolute[pin as usize].discontinuities(state, &pose.journal(pin), discontinuities);
            }
        }
        self.films.discontinuities(pose, discontinuities);
        if play.guide {
            self.guide.discontinuities(&contacts[3..], &pose.slider(), discontinuities);
        }
    }

    /// The conditions after the contacts in `crossed` have closed or opened at the time `t` [s]. The `bristles` of a
    /// contact that opens are reset to 0. The impact lasts as long as the shortest contact time of the contacts that close.
    pub fn cross(
        &self,
        play: JointSet,
        conditions: &Conditions,
        t: f64,
        pose: &Pose,
        crossed: &Triggered,
        bristles: &mut [f64],
    ) -> Reset<Conditions> {
        let penetrations = self.penetrations(play, pose);
        let mut reset = Reset { discrete: *conditions, impact: None };
        let Conditions { contacts, touches, .. } = &mut reset.discrete;
        let crossed = self.guide.contacts_of(&by_contact(play, crossed));
        for (index, state) in contacts.iter_mut().enumerate().filter(|(i, _)| crossed[*i]) {
            if state.closed {
                *state = ContactState::default();
                for (deflection, _) in bristles.iter_mut().zip(&self.bristles).filter(|(_, c)| **c == index) {
                    *deflection = 0.0;
                }
                continue;
            }
            let contact = self.contact(index);
            *state = ContactState::closing(penetrations[index].1, contact.speed_floor);
            touches[Touches::joint(index)].add(t, penetrations[index].1);
            let time = contact.contact_time(self.lighter_mass(index), state.approach);
            reset.impact = Some(reset.impact.map_or(time, |shorter: f64| shorter.min(time)));
        }
        reset
    }

    /// The contact states at a start pose: contacts with penetration are closed.
    pub fn start(&self, play: JointSet, pose: &Pose) -> Contacts {
        let mut contacts = Contacts::default();
        for (index, (state, (depth, rate))) in contacts.iter_mut().zip(self.penetrations(play, pose)).enumerate() {
            if depth > 0.0 {
                *state = ContactState::closing(rate, self.contact(index).speed_floor);
            }
        }
        contacts
    }

    /// [m/s] The smallest approach speed that a contact remembers.
    pub fn speed_floor(&self, index: usize) -> f64 {
        self.contact(index).speed_floor
    }

    fn contact(&self, index: usize) -> &ContactParameters {
        if index < 3 { &self.revolute[index].contact } else { &self.guide.contact }
    }

    /// [kg] The smaller mass of the two bodies in a contact.
    fn lighter_mass(&self, index: usize) -> f64 {
        match index {
            0 => self.mass[CRANK],
            1 => self.mass[CRANK].min(self.mass[ROD]),
            2 => self.mass[ROD].min(self.mass[SLIDER]),
            _ => self.mass[SLIDER],
        }
    }
}

/// Reorders `crossed`, which lists the event functions of joints with clearance only, by the index of the contact.
fn by_contact(play: JointSet, crossed: &Triggered) -> Triggered {
    let mut all = [false; MAX_EVENTS];
    let mut next = 0;
    for pin in play.pins() {
        all[pin as usize] = crossed[next];
        next += 1;
    }
    if play.guide {
        all[3..3 + CORNERS].copy_from_slice(&crossed[next..][..CORNERS]);
    }
    all
}
