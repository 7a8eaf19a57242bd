//! The joints with clearance of one mechanism: their forces, their event functions, their memory.
//!
//! `clear` says of A, B, C and T which have clearance: a constant of the mechanism's type.

use super::bristles::{Bristles, bristled_contacts};
use super::contact::{Account, ContactMode, ContactParameters};
use super::dynamics::Loads;
use super::joint::guide::{CORNERS, GUIDE_CONTACTS, Guide};
use super::joint::revolute::Revolute;
use super::mechanism::{CRANK, ROD, SLIDER, bodies};
use super::rigid;
use super::scalar::Scalar;
use super::state::{CONTACTS, Contacts, Pose};
use crate::integrator::{ContactLaw, Crossed, GUARDS, Guard, Kinks, Reset};
use crate::math::each;
use crate::scene::Scene;

/// The joints of a scene as contacts.
#[derive(Clone, Debug)]
pub struct Clearances {
    pub(super) revolute: [Revolute; 3],
    pub(super) guide: Guide,
    /// [kg] Of crank, rod and slider.
    mass: [f64; 3],
    /// The contacts with bristles, in the order of their states.
    pub bristles: Vec<usize>,
    /// Restitution and friction of rigid contacts.
    pub(super) laws: [ContactLaw; CONTACTS],
}

impl Clearances {
    /// Of a scene.
    pub fn new(scene: &Scene) -> Self {
        let joint = &scene.joint;
        Self {
            revolute: [&joint.a, &joint.b, &joint.c].map(Revolute::new),
            guide: Guide::new(scene),
            mass: bodies(scene).map(|body| body.mass),
            bristles: bristled_contacts(scene).into_iter().map(|(contact, _)| contact).collect(),
            laws: rigid::laws(scene),
        }
    }

    /// Adds the forces of the closed contacts, whose bristles are deflected by `deflections` [m].
    #[inline(always)]
    pub fn add_loads<R: Scalar>(
        &self,
        clear: [bool; 4],
        contacts: &Contacts,
        pose: &Pose<R>,
        deflections: &[R],
        loads: &mut Loads<R>,
    ) {
        let z = self.deflections(deflections);
        each!(true, joint < 3 => {
            if clear[joint] && contacts[joint].closed {
                let load = self.revolute[joint].load(&contacts[joint], &pose.play(joint), z.revolute[joint]);
                loads.add_contact(joint, &load);
            }
        });
        if clear[3] {
            // On its own: a reference into the loads would keep them all in memory.
            let mut bristle_rate = [R::ZERO; GUIDE_CONTACTS];
            loads.add_guide(&self.guide.load(&contacts[3..], &pose.slider(), &z.guide, &mut bristle_rate));
            loads.bristle_rate.guide = bristle_rate;
        }
    }

    /// Elastic energy of the closed contacts, and the powers that they take.
    pub fn account<R: Scalar>(
        &self,
        clear: [bool; 4],
        contacts: &Contacts,
        pose: &Pose<R>,
        deflections: &[R],
    ) -> Account<R> {
        let z = self.deflections(deflections);
        let mut account = Account::default();
        for (joint, revolute) in self.revolute.iter().enumerate() {
            if clear[joint] && contacts[joint].closed {
                account += revolute.account(&contacts[joint], &pose.play(joint), z.revolute[joint]);
            }
        }
        if clear[3] {
            account += self.guide.account(&contacts[3..], &pose.slider(), &z.guide);
        }
        account
    }

    /// Each contact's share in the states of bristles; 0 for those that have none.
    #[inline(always)]
    fn deflections<R: Scalar>(&self, states: &[R]) -> Bristles<R> {
        let mut z = Bristles::default();
        for (&deflection, &contact) in states.iter().zip(&self.bristles) {
            *z.of(contact) = deflection;
        }
        z
    }

    /// Writes the rates of the bristles' states.
    #[inline(always)]
    pub fn write_bristle_rates<R: Scalar>(&self, rate: &Bristles<R>, rates: &mut [R]) {
        let mut rate = *rate;
        for (place, &contact) in rates.iter_mut().zip(&self.bristles) {
            *place = *rate.of(contact);
        }
    }

    /// Penetration and approach speed of every contact; far open for a joint without clearance.
    #[inline(always)]
    pub fn penetrations(&self, clear: [bool; 4], pose: &Pose) -> [(f64, f64); CONTACTS] {
        let mut all = [(f64::NEG_INFINITY, 0.0); CONTACTS];
        for (joint, revolute) in self.revolute.iter().enumerate() {
            if clear[joint] {
                let play = pose.play(joint);
                all[joint] = (revolute.penetration(&play), revolute.penetration_rate(&play));
            }
        }
        if clear[3] {
            all[3..].copy_from_slice(&self.guide.approaches(&pose.slider()));
        }
        all
    }

    /// [m] Penetration in the joints A, B, C and of the guide's corners; −∞ in an ideal joint.
    pub fn depths(&self, clear: [bool; 4], pose: &Pose) -> [f64; 3 + CORNERS] {
        let mut depths = self.penetrations(clear, pose).map(|(depth, _)| depth);
        if clear[3] {
            depths[3..].copy_from_slice(&self.guide.penetrations(&pose.slider()));
        }
        depths
    }

    /// How many event functions there are; an ideal joint has none.
    #[inline(always)]
    pub fn guard_count(&self, clear: [bool; 4]) -> usize {
        guard_place(clear, 3) + if clear[3] { CORNERS } else { 0 }
    }

    /// Writes the event functions.
    #[inline(always)]
    pub fn guards(&self, clear: [bool; 4], contacts: &Contacts, pose: &Pose, guards: &mut [Guard; GUARDS]) {
        each!(true, joint < 3 => {
            if clear[joint] {
                guards[guard_place(clear, joint)] = self.revolute[joint].guard(&contacts[joint], &pose.play(joint));
            }
        });
        if clear[3] {
            let place = guard_place(clear, 3);
            guards[place..place + CORNERS].copy_from_slice(&self.guide.guards(&contacts[3..], &pose.slider()));
        }
    }

    /// Adds the kinks of the closed contacts' forces.
    pub fn kinks(&self, clear: [bool; 4], contacts: &Contacts, pose: &Pose, kinks: &mut Kinks) {
        for (joint, revolute) in self.revolute.iter().enumerate() {
            if clear[joint] && contacts[joint].closed {
                revolute.kinks(&contacts[joint], &pose.play(joint), kinks);
            }
        }
        if clear[3] {
            self.guide.kinks(&contacts[3..], &pose.slider(), kinks);
        }
    }

    /// The contacts after the `crossed` ones have closed or opened; `bristles` of those that open are
    /// straight again.
    pub fn cross(
        &self,
        clear: [bool; 4],
        contacts: &Contacts,
        pose: &Pose,
        crossed: &Crossed,
        bristles: &mut [f64],
    ) -> Reset<Contacts> {
        let penetrations = self.penetrations(clear, pose);
        let mut reset = Reset { discrete: *contacts, impact: None };
        let crossed = self.guide.contacts_of(&by_joint(clear, crossed));
        for (index, mode) in reset.discrete.iter_mut().enumerate().filter(|(i, _)| crossed[*i]) {
            if mode.closed {
                *mode = ContactMode::default();
                for (deflection, _) in bristles.iter_mut().zip(&self.bristles).filter(|(_, c)| **c == index) {
                    *deflection = 0.0;
                }
                continue;
            }
            let contact = self.contact(index);
            *mode = ContactMode::closing(penetrations[index].1, contact.speed_floor);
            let time = contact.contact_time(self.lighter_mass(index), mode.approach);
            reset.impact = Some(reset.impact.map_or(time, |shorter: f64| shorter.min(time)));
        }
        reset
    }

    /// The contacts of a pose that no motion has led to: those that penetrate are closed.
    pub fn start(&self, clear: [bool; 4], pose: &Pose) -> Contacts {
        let mut contacts = Contacts::default();
        for (index, (mode, (depth, rate))) in contacts.iter_mut().zip(self.penetrations(clear, pose)).enumerate() {
            if depth > 0.0 {
                *mode = ContactMode::closing(rate, self.contact(index).speed_floor);
            }
        }
        contacts
    }

    fn contact(&self, index: usize) -> &ContactParameters {
        if index < 3 { &self.revolute[index].contact } else { &self.guide.contact }
    }

    /// [kg] The lighter of the bodies that meet in a contact.
    fn lighter_mass(&self, index: usize) -> f64 {
        match index {
            0 => self.mass[CRANK],
            1 => self.mass[CRANK].min(self.mass[ROD]),
            2 => self.mass[ROD].min(self.mass[SLIDER]),
            _ => self.mass[SLIDER],
        }
    }
}

/// Where the event functions of a joint begin.
#[inline(always)]
fn guard_place(clear: [bool; 4], joint: usize) -> usize {
    clear.into_iter().take(joint).filter(|&clear| clear).count()
}

/// The same, where A, B, C and the guide's corners have places whether they have clearance or not.
fn by_joint(clear: [bool; 4], crossed: &Crossed) -> Crossed {
    let mut all = [false; GUARDS];
    for joint in (0..3).filter(|&joint| clear[joint]) {
        all[joint] = crossed[guard_place(clear, joint)];
    }
    if clear[3] {
        all[3..3 + CORNERS].copy_from_slice(&crossed[guard_place(clear, 3)..][..CORNERS]);
    }
    all
}
