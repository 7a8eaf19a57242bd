//! Minimal coordinates: where each root and angle stands in the state vector.
//!
//! Positions come first, in this order and only those that the topology leaves: the roots of the
//! crank's chain (x, y), the rod's (x, y) and the slider's (x on an ideal guide, x and y when it floats
//! alone), then the angles of crank (unless prescribed), rod and slider (unless guided ideally).
//! Their rates follow in the same order. A closed loop has the crank's angle alone.

use super::kinematics::Roots;
use super::mechanism::{CRANK, ROD, SLIDER, Topology};
use super::plane::Vec2;
use crate::math::{Real, each};

/// Places of the coordinates among the positions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Layout {
    topology: Topology,
    rod: usize,
    slider: usize,
    angles: usize,
}

impl Layout {
    /// Of a topology.
    pub const fn new(topology: Topology) -> Self {
        if topology.is_closed() {
            return Self { topology, rod: 0, slider: 0, angles: 0 };
        }
        let rod = if topology.crank_floats() { 2 } else { 0 };
        let slider = rod + if topology.rod_floats() { 2 } else { 0 };
        let on_slider = if topology.t {
            1
        } else if topology.slider_floats() {
            2
        } else {
            0
        };
        Self { topology, rod, slider, angles: slider + on_slider }
    }

    /// Place of the angle of body `k`, if it is a coordinate.
    #[inline(always)]
    pub const fn angle(&self, k: usize) -> Option<usize> {
        let Topology { t, speed, .. } = self.topology;
        let after_crank = self.angles + if speed { 0 } else { 1 };
        match k {
            CRANK if !speed => Some(self.angles),
            ROD if !self.topology.is_closed() => Some(after_crank),
            SLIDER if !t => Some(after_crank + 1),
            _ => None,
        }
    }

    /// The roots in a list of positions (or of rates, or of accelerations).
    #[inline(always)]
    pub fn roots<R: Real>(&self, list: &[R]) -> Roots<R> {
        let mut roots = Roots::default();
        if self.topology.crank_floats() {
            roots.crank = Vec2::new(list[0], list[1]);
        }
        if self.topology.rod_floats() {
            roots.rod = Vec2::new(list[self.rod], list[self.rod + 1]);
        }
        if self.topology.t {
            roots.slider.x = list[self.slider];
        } else if self.topology.slider_floats() {
            roots.slider = Vec2::new(list[self.slider], list[self.slider + 1]);
        }
        roots
    }

    /// Writes the roots into such a list.
    #[inline(always)]
    pub fn set_roots<R: Real>(&self, roots: &Roots<R>, list: &mut [R]) {
        if self.topology.crank_floats() {
            (list[0], list[1]) = (roots.crank.x, roots.crank.y);
        }
        if self.topology.rod_floats() {
            (list[self.rod], list[self.rod + 1]) = (roots.rod.x, roots.rod.y);
        }
        if self.topology.t {
            list[self.slider] = roots.slider.x;
        } else if self.topology.slider_floats() {
            (list[self.slider], list[self.slider + 1]) = (roots.slider.x, roots.slider.y);
        }
    }

    /// Writes the angles (or their rates or accelerations) into such a list.
    #[inline(always)]
    pub fn set_angles<R: Real>(&self, angles: &[R; 3], list: &mut [R]) {
        each!(true, k < 3 => {
            if let Some(place) = self.angle(k) {
                list[place] = angles[k];
            }
        });
    }
}
