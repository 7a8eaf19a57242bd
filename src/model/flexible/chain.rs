//! The chain of bodies that ideal joints connect with the rod: the coordinates x that its matrix is over.
//!
//! A crank or a slider that only joints with clearance hold against the rod has no inertia in common with it, and
//! accelerates by itself.

use crate::math::Real;
use crate::model::structure::Structure;
use crate::model::structure::Topology;

/// Most places in x: two of a root, three angles, L.
pub const PLACES: usize = 6;

/// Where the coordinates of the rod's chain stand in x: its root, if it has one, and angles. L comes after them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Chain {
    /// How many there are.
    pub size: usize,
    /// Their places among the positions.
    positions: [usize; PLACES],
    /// Those of the angles of crank, rod and slider.
    pub angle: [Option<usize>; 3],
}

/// Which joints a mechanism with a flexible rod has, and where its coordinates stand; modal ones come after the others.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Frame {
    /// Of the coordinates that are not modal.
    pub structure: Structure,
    /// Which of them are in x.
    pub chain: Chain,
}

impl Frame {
    /// Of a topology.
    pub const fn new(topology: Topology) -> Self {
        let structure = Structure::new(topology);
        Self { structure, chain: Chain::new(&structure) }
    }

    /// How many coordinates x has.
    pub const fn places(self) -> usize {
        self.chain.size + 1
    }
}

impl Chain {
    const NONE: Self = Self { size: 0, positions: [0; PLACES], angle: [None; 3] };

    /// Of a topology.
    pub const fn new(structure: &Structure) -> Self {
        let topology = structure.topology;
        let Topology { b, c, t, .. } = topology;
        let (mut chain, mut next) = (Self::NONE, 0);
        let rail = (t && !topology.is_closed(), 1, c);
        let roots = [
            (topology.crank_floats(), 2, b),
            (topology.rod_floats(), 2, true),
            (topology.slider_floats(), 2, false),
            rail,
        ];
        let mut k = 0;
        while k < roots.len() {
            let (there, count, connected) = roots[k];
            let end = if there { next + count } else { next };
            while next < end {
                if connected {
                    chain.append(next);
                }
                next += 1;
            }
            k += 1;
        }
        let connected = [b, true, c];
        let mut body = 0;
        while body < connected.len() {
            if let (Some(position), true) = (structure.angle(body), connected[body]) {
                chain.angle[body] = Some(chain.size);
                chain.append(position);
            }
            body += 1;
        }
        chain
    }

    const fn append(&mut self, position: usize) {
        self.positions[self.size] = position;
        self.size += 1;
    }

    /// Those of a list in the order of the positions.
    #[inline(always)]
    pub fn gather<R: Real, const P: usize>(&self, list: &[R]) -> [R; P] {
        let mut chain = [R::ZERO; P];
        for (place, &position) in chain.iter_mut().zip(&self.positions[..self.size]) {
            *place = list[position];
        }
        chain
    }

    /// Writes them into such a list.
    #[inline(always)]
    pub fn scatter<R: Real>(&self, chain: &[R], list: &mut [R]) {
        for (place, &position) in chain.iter().zip(&self.positions[..self.size]) {
            list[position] = *place;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The chain of a mechanism with these ideal joints, driven by a torque.
    fn chain(a: bool, b: bool, c: bool, t: bool) -> Chain {
        let topology = Topology { a, b, c, t, speed: false };
        Chain::new(&Structure::new(topology))
    }

    #[test]
    fn a_rod_between_clearances_is_a_chain_of_its_own() {
        // Positions: roots of crank, rod and slider, then the three angles.
        assert_eq!(
            chain(false, false, false, false),
            Chain { size: 3, positions: [2, 3, 7, 0, 0, 0], angle: [None, Some(2), None] }
        );
        // Without the crank's root, and with the slider on its guide.
        assert_eq!(
            chain(true, false, false, true),
            Chain { size: 3, positions: [0, 1, 4, 0, 0, 0], angle: [None, Some(2), None] }
        );
    }

    #[test]
    fn a_chain_has_what_ideal_joints_connect() {
        assert_eq!(chain(false, true, true, false).size, 5);
        assert_eq!(chain(true, true, true, true), Chain { size: 1, angle: [Some(0), None, None], ..Chain::NONE });
        // On the guide hang rod and crank: x, and their angles.
        assert_eq!(
            chain(false, true, true, true),
            Chain { size: 3, positions: [0, 1, 2, 0, 0, 0], angle: [Some(1), Some(2), None] }
        );
        // The slider's x is not the rod's.
        assert_eq!(
            chain(true, true, false, true),
            Chain { size: 2, positions: [1, 2, 0, 0, 0, 0], angle: [Some(0), Some(1), None] }
        );
    }
}
