//! The guide with clearance: the slider, a rectangle, between two lines.
//!
//! Corner k is at the offset (±a, ±b) from the rectangle's centre. An upper corner penetrates by y_k − (h + b + c_T), a
//! lower corner by (h − b − c_T) − y_k. The contacts are the surface's: either each corner (`corners`, from which
//! contact of faces and jamming follow), or each face on an elastic foundation (`foundation`). The scene selects the
//! surface and its laws.

use super::corners::Corners;
use super::foundation::{self, Faces};
use super::rectangle::{CORNERS, Rectangle, SliderPose, Surface, SurfaceContact};
use crate::integrator::{Discontinuities, EventFunction, Triggered};
use crate::math::Real;
use crate::model::contact::{ContactEnergy, ContactParameters, ContactState, Elastic, Forces, Hertz, Linear, Rubbing};
use crate::model::plane::{Rotation, Vec2, cross};
use crate::scene;

/// Maximum number of contacts of the slider with the guide.
pub const GUIDE_CONTACTS: usize = CORNERS;

/// The guide's load on the slider, reduced to the pin.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Load<R = f64> {
    /// [N] Force.
    pub force: Vec2<R>,
    /// [N·m] Couple about the pin.
    pub couple: R,
}

/// The guide with clearance.
#[derive(Clone, Copy, Debug)]
pub struct Guide {
    /// The slider's rectangle and the two lines.
    pub(super) rectangle: Rectangle,
    /// Contact parameters, the same for every contact.
    pub contact: ContactParameters,
    surface: scene::Surface,
}

/// One number for the bristles of each contact.
type Bristles<R> = [R; GUIDE_CONTACTS];

/// Evaluates an expression with `S` as the guide's surface: `of_surface!(guide, S => …)`.
macro_rules! of_surface {
    ($guide:expr, $surface:ident => $what:expr) => {
        match $guide.surface {
            scene::Surface::Corner => {
                type $surface = Corners;
                $what
            }
            scene::Surface::Foundation => {
                type $surface = Faces;
                $what
            }
        }
    };
}

/// Returns the force [N] on the slider and writes the couple [N·m]. The slider's pose is passed in registers, except
/// for the pin's abscissa, which has no influence.
#[expect(clippy::too_many_arguments, reason = "what goes by registers stands alone")]
#[inline(never)]
fn load<R: Real, S: Surface>(
    g: &Guide,
    states: &[ContactState],
    height: R,
    pin_velocity: Vec2<R>,
    rotation: Rotation<R>,
    speed: R,
    z: &Bristles<R>,
    bristle_rate: &mut Bristles<R>,
    couple: &mut R,
) -> Vec2<R> {
    let pose = &SliderPose { pin: Vec2::new(R::ZERO, height), pin_velocity, rotation, speed };
    let mut load = Load::default();
    for (k, state) in states.iter().enumerate().take(S::CONTACTS) {
        if state.closed {
            let SurfaceContact { arm, normal, depth, rate, sliding } = S::touch(&g.rectangle, k, pose);
            let Forces { normal: pressure, tangential, bristle_rate: moving } =
                g.contact.forces(state.per_approach, depth, rate, z[k], || sliding);
            bristle_rate[k] = moving;
            let force = Vec2::new(-tangential, pressure * normal);
            load.force += force;
            load.couple += cross(arm, force);
        }
    }
    *couple = load.couple;
    load.force
}

fn approaches<R: Real, S: Surface>(guide: &Guide, pose: &SliderPose<R>) -> [(R, R); CORNERS] {
    let none = (R::constant(f64::NEG_INFINITY), R::ZERO);
    std::array::from_fn(|k| if k < S::CONTACTS { S::approach(&guide.rectangle, k, pose) } else { none })
}

fn contact_energy<R: Real, S: Surface>(
    g: &Guide,
    states: &[ContactState],
    pose: &SliderPose<R>,
    z: &Bristles<R>,
) -> ContactEnergy<R> {
    let mut sum = ContactEnergy::default();
    for (k, state) in states.iter().enumerate().take(S::CONTACTS).filter(|(_, state)| state.closed) {
        let SurfaceContact { depth, rate, sliding, .. } = S::touch(&g.rectangle, k, pose);
        let contact_energy = g.contact.contact_energy(state.per_approach, depth, rate, z[k], sliding);
        sum += ContactEnergy { energy: S::energy(&g.rectangle, &g.contact.elastic, k, pose), ..contact_energy };
    }
    sum
}

fn rubbing<S: Surface>(g: &Guide, states: &[ContactState], pose: &SliderPose, z: &Bristles<f64>) -> [Rubbing; CORNERS] {
    std::array::from_fn(|k| {
        if k >= S::CONTACTS || !states[k].closed {
            return Rubbing::default();
        }
        let SurfaceContact { depth, rate, sliding, .. } = S::touch(&g.rectangle, k, pose);
        g.contact.rubbing(states[k].per_approach, depth, rate, z[k], sliding)
    })
}

impl Guide {
    /// The guide of a scene.
    pub fn new(scene: &scene::Scene) -> Self {
        let joint = &scene.joint.t;
        let elastic = match joint.surface {
            scene::Surface::Corner => Elastic::Hertz(Hertz::corner(joint)),
            scene::Surface::Foundation => Elastic::Linear(Linear { stiffness: foundation::stiffness(scene) }),
        };
        Self {
            rectangle: Rectangle::new(scene),
            contact: ContactParameters::new(&joint.contact, elastic),
            surface: joint.surface,
        }
    }

    /// [m] Penetration of every corner; negative if open.
    pub fn penetrations(&self, pose: &SliderPose) -> [f64; CORNERS] {
        self.rectangle.corners.map(|corner| corner.touch(pose).depth)
    }

    /// Largest penetration [m] of every contact, and its approach speed [m/s] should it close now; −∞ and 0 for a
    /// contact that does not exist.
    pub fn approaches<R: Real>(&self, pose: &SliderPose<R>) -> [(R, R); CORNERS] {
        of_surface!(self, S => approaches::<R, S>(self, pose))
    }

    /// The event functions at which contacts close or open.
    pub fn event_functions(&self, states: &[ContactState], pose: &SliderPose) -> [EventFunction; CORNERS] {
        of_surface!(self, S => S::event_functions(&self.rectangle, states, pose))
    }

    /// Adds the functions whose zeros are derivative discontinuities of the closed contacts' forces.
    pub fn discontinuities(&self, states: &[ContactState], pose: &SliderPose, discontinuities: &mut Discontinuities) {
        for (k, state) in states.iter().enumerate().filter(|(_, state)| state.closed) {
            let SurfaceContact { rate, sliding, .. } = of_surface!(self, S => S::touch(&self.rectangle, k, pose));
            self.contact.discontinuities(state, rate, sliding, discontinuities);
        }
    }

    /// Converts event functions that have fallen into contacts of the joints and the guide that change.
    pub fn contacts_of(&self, crossed: &Triggered) -> Triggered {
        let mut contacts = *crossed;
        contacts[3..].fill(false);
        for (corner, contact) in contact_of_corner(self.surface).into_iter().enumerate() {
            contacts[3 + contact] |= crossed[3 + corner];
        }
        contacts
    }

    /// The load of the closed contacts at the bristle deflections `z` [m]; writes the rates of the deflections [m/s].
    #[inline(always)]
    pub fn load<R: Real>(
        &self,
        states: &[ContactState],
        pose: &SliderPose<R>,
        z: &[R; GUIDE_CONTACTS],
        bristle_rate: &mut [R; GUIDE_CONTACTS],
    ) -> Load<R> {
        if states.iter().any(|state| state.closed) {
            let SliderPose { pin, pin_velocity, rotation, speed } = *pose;
            let mut couple = R::ZERO;
            let force = of_surface!(self, S => {
                load::<R, S>(self, states, pin.y, pin_velocity, rotation, speed, z, bristle_rate, &mut couple)
            });
            Load { force, couple }
        } else {
            Load::default()
        }
    }

    /// Energy and powers of the closed contacts at the bristle deflections `z` [m].
    pub fn contact_energy<R: Real>(
        &self,
        states: &[ContactState],
        pose: &SliderPose<R>,
        z: &[R; GUIDE_CONTACTS],
    ) -> ContactEnergy<R> {
        of_surface!(self, S => contact_energy::<R, S>(self, states, pose, z))
    }

    /// Sliding and forces of the closed contacts at the bristle deflections `z` [m].
    pub fn rubbing(&self, states: &[ContactState], pose: &SliderPose, z: &[f64; GUIDE_CONTACTS]) -> [Rubbing; CORNERS] {
        of_surface!(self, S => rubbing::<S>(self, states, pose, z))
    }
}

/// Number of contacts of the slider with the guide.
pub fn guide_contacts(surface: scene::Surface) -> usize {
    contact_of_corner(surface)[CORNERS - 1] + 1
}

/// The contact of the guide to which each corner belongs.
pub fn contact_of_corner(surface: scene::Surface) -> [usize; CORNERS] {
    match surface {
        scene::Surface::Corner => Corners::CONTACT_OF_CORNER,
        scene::Surface::Foundation => Faces::CONTACT_OF_CORNER,
    }
}
