//! Topology of the mechanism and layout of its coordinates.
//!
//! Any clearance opens the loop. The bodies that ideal joints still connect form open chains, and each body hangs on
//! its predecessor on the path from the root of its chain:
//!
//! ```text
//!             crank          rod            slider
//!    ground ────A──── ─────── B ─────── C ─────── ════T════ rail
//! ```
//!
//! | [`Link`] | the body hangs on |
//! |---|---|
//! | `Ground` | the ground, by the main bearing |
//! | `Before` | the body to its left, by their ideal pin |
//! | `After` | the body to its right, whose own way to its root is the guide |
//! | `Rail` | the ideal guide, on which its pin has one coordinate |
//! | `Free` | nothing: two coordinates hold the centre of mass of the chain that it begins |
//!
//! For example, with clearance in the slider pin the crank hangs on the ground, the rod on the crank and the slider on
//! its rail. With clearance in the main bearing the slider hangs on its rail, the rod on the slider and the crank on
//! the rod.
//!
//! The minimal coordinates are those of the roots in the order crank (x, y), rod (x, y), slider (x on its rail,
//! otherwise x, y), followed by the angles of crank (unless the drive prescribes it), rod and slider (unless its guide
//! is ideal). Their rates follow in the same order. If all joints are ideal the loop is closed: the chain hangs on the
//! ground, the guide makes the rod's angle a function of the crank's angle, and the latter is the only coordinate.
//!
//! The modal coordinates of a flexible rod follow all other coordinates. The centre of mass of a chain with such a rod
//! moves relative to the bodies as the rod deforms; the root of such a floating chain is its first joint.

use super::joint_set::JointSet;
use super::plane::Vec2;
use crate::math::Real;
use crate::scene::{DriveMode, JointModel, Scene};

/// Index of the crank in lists of bodies.
pub const CRANK: usize = 0;
/// Index of the rod in lists of bodies.
pub const ROD: usize = 1;
/// Index of the slider in lists of bodies.
pub const SLIDER: usize = 2;

/// Which joints are ideal, and whether the crank angle is prescribed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Topology {
    /// Whether the main bearing is ideal.
    pub a: bool,
    /// Whether the crank pin is ideal.
    pub b: bool,
    /// Whether the slider pin is ideal.
    pub c: bool,
    /// Whether the guide is ideal.
    pub t: bool,
    /// Whether the crank angle is prescribed.
    pub speed: bool,
}

impl Topology {
    /// The topology of a scene.
    pub fn of(scene: &Scene) -> Self {
        let ideal = |model| model == JointModel::Ideal;
        Self {
            a: ideal(scene.joint.a.model),
            b: ideal(scene.joint.b.model),
            c: ideal(scene.joint.c.model),
            t: ideal(scene.joint.t.model),
            speed: scene.drive.mode == DriveMode::Speed,
        }
    }

    /// Whether all joints are ideal.
    pub const fn is_closed(self) -> bool {
        self.a && self.b && self.c && self.t
    }

    /// Whether the chain that contains the crank floats.
    pub const fn crank_floats(self) -> bool {
        let on_rail = self.b && self.c && self.t;
        !(self.a || on_rail)
    }

    /// Whether the rod floats, alone or with the slider.
    pub const fn rod_floats(self) -> bool {
        let on_rail = self.c && self.t;
        !(self.b || on_rail)
    }

    /// Whether the slider floats alone.
    pub const fn slider_floats(self) -> bool {
        !self.t && !self.c
    }

    /// Whether the only clearance is in a pin. With several contacts, or with those of the slider's corners, steps in
    /// blocks have no advantage.
    pub const fn has_one_pin_clearance(self) -> bool {
        self.a as u8 + self.b as u8 + self.c as u8 == 2 && self.t
    }
}

/// The predecessor of a body; see the [module](self).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Link {
    /// The ground.
    Ground,
    /// The last joint of the body before it.
    Before,
    /// The first joint of the body after it.
    After,
    /// The rail: index of the coordinate.
    Rail(usize),
    /// None: index of the first coordinate of the chain's centre of mass.
    Free(usize),
}

impl Link {
    #[inline(always)]
    fn root<R: Real>(self, list: &[R]) -> Vec2<R> {
        match self {
            Self::Free(at) => Vec2::new(list[at], list[at + 1]),
            Self::Rail(at) => Vec2::new(list[at], R::ZERO),
            _ => Vec2::ZERO,
        }
    }

    #[inline(always)]
    fn set_root<R: Real>(self, root: Vec2<R>, list: &mut [R]) {
        match self {
            Self::Free(at) => (list[at], list[at + 1]) = (root.x, root.y),
            Self::Rail(at) => list[at] = root.x,
            _ => {}
        }
    }
}

/// Contributions of the chains' roots: positions, velocities or accelerations of floating centres of mass and of the
/// pin on an ideal guide.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Roots<V> {
    /// Root of the chain that contains the crank, if it floats.
    pub crank: V,
    /// Root of the chain that begins with the rod, if it floats.
    pub rod: V,
    /// Root of the slider: its pin on an ideal guide, or its centre of mass if it floats alone.
    pub slider: V,
}

/// Topology and layout of the coordinates of a mechanism.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Structure {
    /// Ideal joints and drive.
    pub topology: Topology,
    /// The joints with clearance.
    pub play: JointSet,
    /// Whether all joints are ideal.
    pub closed: bool,
    /// Whether the rod is flexible.
    pub flexible: bool,
    /// Predecessor of the crank.
    pub crank: Link,
    /// Predecessor of the rod.
    pub rod: Link,
    /// Predecessor of the slider.
    pub slider: Link,
    /// Index of the crank's angle; `None` if it is prescribed.
    pub crank_angle: Option<usize>,
    /// Index of the rod's angle; `None` if the loop is closed.
    pub rod_angle: Option<usize>,
    /// Index of the slider's angle; `None` if the slider does not tilt.
    pub slider_angle: Option<usize>,
    /// Number of positions without modal coordinates.
    pub positions: usize,
    /// For crank, rod and slider, whether the body's chain floats and has its centre of mass as its root.
    pub floats: [bool; 3],
    /// For crank, rod and slider, whether the body's angle moves centres of mass relative to a root that does not
    /// float.
    pub weighs: [bool; 3],
    /// For the pairs crank–rod, rod–slider and crank–slider, whether the angles are coupled in the mass matrix.
    pub coupled: [bool; 3],
    /// Whether there is oil or a load beside the slider's pin. The code of constant structures has neither.
    pub rare_loads: bool,
}

impl Structure {
    /// The structure of a topology with a rigid rod.
    pub const fn new(topology: Topology) -> Self {
        Self::with_rod(topology, false)
    }

    /// The structure of a topology with a flexible or rigid rod.
    pub const fn with_rod(topology: Topology, flexible: bool) -> Self {
        let Topology { a, b, c, t, speed } = topology;
        let closed = topology.is_closed();
        // In a closed loop the guide does not carry a root: it removes a coordinate.
        let t = t && !closed;
        let (rail_rod, rail_crank) = (c && t, b && c && t);
        let mut next = Places { next: 0 };
        let crank = match (topology.crank_floats(), rail_crank) {
            (true, _) => Link::Free(next.take(2)),
            (false, true) => Link::After,
            (false, false) => Link::Ground,
        };
        let rod = match (topology.rod_floats(), rail_rod) {
            (true, _) => Link::Free(next.take(2)),
            (false, true) => Link::After,
            (false, false) => Link::Before,
        };
        let slider = match (t, c) {
            (true, _) => Link::Rail(next.take(1)),
            (false, true) => Link::Before,
            (false, false) => Link::Free(next.take(2)),
        };
        let crank_angle = if speed { None } else { Some(next.take(1)) };
        let rod_angle = if closed { None } else { Some(next.take(1)) };
        let slider_angle = if t || closed { None } else { Some(next.take(1)) };
        let crank_floats = topology.crank_floats();
        let rod_floats = topology.rod_floats() || (crank_floats && b);
        let slider_floats = topology.slider_floats() || (rod_floats && c && !t);
        Self {
            topology,
            play: JointSet { main_bearing: !a, crank_pin: !b, slider_pin: !c, guide: !topology.t },
            closed,
            flexible,
            crank,
            rod,
            slider,
            crank_angle,
            rod_angle,
            slider_angle,
            positions: next.next,
            floats: [crank_floats && !(flexible && b), rod_floats && !flexible, slider_floats && !(flexible && c)],
            weighs: [a || rail_crank, (a && b) || rail_rod, a && b && c && !topology.t],
            coupled: [b, c && !topology.t, b && c && !topology.t],
            rare_loads: false,
        }
    }

    /// Index of the angle of body `k`; `None` if it is not a coordinate.
    #[inline(always)]
    pub const fn angle(&self, k: usize) -> Option<usize> {
        match k {
            CRANK => self.crank_angle,
            ROD => self.rod_angle,
            _ => self.slider_angle,
        }
    }

    /// The roots in a list of positions, of their rates, or of accelerations; 0 for roots that do not exist.
    #[inline(always)]
    pub fn roots<R: Real>(&self, list: &[R]) -> Roots<Vec2<R>> {
        Roots { crank: self.crank.root(list), rod: self.rod.root(list), slider: self.slider.root(list) }
    }

    /// Writes the roots into a list of positions, of their rates, or of accelerations.
    #[inline(always)]
    pub fn set_roots<R: Real>(&self, roots: &Roots<Vec2<R>>, list: &mut [R]) {
        self.crank.set_root(roots.crank, list);
        self.rod.set_root(roots.rod, list);
        self.slider.set_root(roots.slider, list);
    }

    /// Writes the angles of crank, rod and slider, their rates, or their accelerations into such a list.
    #[inline(always)]
    pub fn set_angles<R: Real>(&self, [crank, rod, slider]: [R; 3], list: &mut [R]) {
        if let Some(place) = self.crank_angle {
            list[place] = crank;
        }
        if let Some(place) = self.rod_angle {
            list[place] = rod;
        }
        if let Some(place) = self.slider_angle {
            list[place] = slider;
        }
    }
}

/// Allocates successive indices of a list.
struct Places {
    next: usize,
}

impl Places {
    const fn take(&mut self, count: usize) -> usize {
        self.next += count;
        self.next - count
    }
}
