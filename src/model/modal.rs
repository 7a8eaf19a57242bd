//! M(q)·q̈ = Q of a chain with a flexible rod: the terms that modal coordinates add to the equations of
//! [`dynamics`](super::dynamics).
//!
//! ```text
//!      far = 1, the rod hangs by its big end                 far = −1, by its small end
//!
//!                 chord, length L ─> e                        e <─ chord, length L
//!      o───────────────────────────o          o───────────────────────────o
//!    hangs here    ρ, first      others      others                     hangs here,
//!    (big end)   moment D        hang here   hang here                  on the rail
//! ```
//!
//! The rod's frame has its origin at the big end and its x axis e along the chord (A. A. Shabana, Dynamics of Multibody
//! Systems, 5.3). ρ is the position of a point of the rod in that frame, D = ∫ρ dm, and L the length of the chord. A
//! mode η_a moves each point by ∂ρ/∂η_a and the far joint, with all bodies that hang there, by far·L_a·e, L_a =
//! ∂L/∂η_a. The origin of places is the joint by which the rod hangs: ρ' = ρ + big_end·L·e. With κ of [`RodInChain`], h
//! = D + κ·L·e, and per unit of η_a:
//!
//! - P_a = ∂D/∂η_a + κ·L_a·e is the momentum of the chain in the frame's axes;
//! - M_θa = T_a + big_end·(L·∂D_y/∂η_a − D_y·L_a) couples η_a with the rod's angle; T_a is the moment of momentum of
//!   the rod about its big end (`with_angle`);
//! - M_ka = far·L_a·e·perp(h_k) couples η_a with the angle of a body k beyond the far joint, and perp(throw)·P_a with
//!   that of a crank on which the rod hangs;
//! - M_ab = m_ab + big_end·(L_b·∂D_x/∂η_a + L_a·∂D_x/∂η_b) + |κ|·L_a·L_b couples two modes.
//!
//! Modal velocities require additional forces at zero accelerations: at the far joint for far·((L̈ − θ̇²·L)·e +
//! 2·θ̇·L̇·perp(e)), and in the rod those of [`Inertia`].
//!
//! A root other than the ground shares momentum p_k with each coordinate and is eliminated: p_k·p_l/m is subtracted
//! from M_kl and p_k·(F − B)/m from Q_k, with the force F on the chain and the force B that its motion at zero
//! accelerations requires; only the x components count for a root on a rail. In a closed loop the rod's angle follows,
//! θ̈2 = ρ·θ̈1 + λ·Σ L_a·η̈_a + σ: its equation, times ρ and λ·L_a, is added to the others.

#![allow(clippy::needless_range_loop)] // several arrays are read by the number of one mode

use super::bodies::{AugmentedBodies, RodInChain};
use super::condensation::ModalEquations;
use super::dynamics::{Accelerations, Equations};
use super::ideal::IdealMotion;
use super::kinematics::{Arms, BodyRotations};
use super::loads::Loads;
use super::plane::{Rotation, Vec2, cross, perp};
use super::rod::{Arrays, CompiledCounts, Inertia, Shape, in_registers};
use super::structure::{CRANK, Link, ROD, SLIDER, Structure};
use crate::math::{Real, unroll};

/// A deformed rod at one instant.
pub(super) struct BentRod<'a, R, const K: usize, const F: usize> {
    /// Modes of the rod.
    pub modes: Arrays<'a, K, F>,
    /// Position of the rod in its chain.
    pub chain: RodInChain,
    /// Deformation of the rod.
    pub shape: &'a Shape<R, K, F>,
    /// Inertia of the rod.
    pub inertia: &'a mut Inertia<R, K>,
    /// [m] Modal coordinates.
    pub eta: &'a [R],
    /// [m/s] Rates of the modal coordinates.
    pub rate: &'a [R],
}

/// Kind of the root of the chain with the rod.
#[derive(Clone, Copy)]
enum Root {
    Ground,
    Rail,
    Free,
}

impl Root {
    /// The root in this structure.
    const fn of(of: &Structure) -> Self {
        match (of.rod, of.crank) {
            (Link::After, _) => Self::Rail,
            (Link::Free(_), _) | (Link::Before, Link::Free(_)) => Self::Free,
            _ => Self::Ground,
        }
    }

    /// u·v in the directions in which the root moves.
    #[inline(always)]
    fn product<R: Real>(self, u: Vec2<R>, v: Vec2<R>) -> R {
        match self {
            Self::Ground => R::ZERO,
            Self::Rail => u.x * v.x,
            Self::Free => u.dot(v),
        }
    }

    /// The part of an acceleration in the directions in which the root moves.
    #[inline(always)]
    fn part<R: Real>(self, free: Vec2<R>) -> Vec2<R> {
        match self {
            Self::Ground => Vec2::ZERO,
            Self::Rail => Vec2::new(free.x, R::ZERO),
            Self::Free => free,
        }
    }

    /// The part of gravity in the directions in which the root does not move.
    #[inline(always)]
    fn held(self, gravity: Vec2) -> Vec2 {
        match self {
            Self::Ground => gravity,
            Self::Rail => Vec2::new(0.0, gravity.y),
            Self::Free => Vec2::ZERO,
        }
    }
}

impl<R: Real, const K: usize, const F: usize> BentRod<'_, R, K, F> {
    /// Solves the equations of motion: returns the accelerations of roots and angles and writes those of the modal
    /// coordinates into `modal` [m/s²]. `constant` are the augmented bodies with the undeformed rod.
    #[inline(always)]
    #[expect(clippy::too_many_arguments, reason = "inlined")]
    pub fn accelerate<C: CompiledCounts>(
        &mut self,
        of: &Structure,
        constant: &AugmentedBodies,
        gravity: Vec2,
        rotations: &BodyRotations<R>,
        arms: &Arms<Vec2<R>>,
        closing: &IdealMotion<R>,
        loads: &Loads<R>,
        modal: &mut [R],
    ) -> Accelerations<R> {
        let Self { modes, chain, shape, ref inertia, .. } = *self;
        let n = C::COUNTS.unwrap_or(modes.counts).modes().min(K);
        let RodInChain { far, big_end, first: kappa, second, .. } = chain;
        let length = shape.chord.length;
        let bodies = chain.augmented(of, constant, length, inertia.first, inertia.about_origin);
        let mut equations = Equations::new(of, &bodies, gravity, rotations, loads, |number| number);
        let forces = equations.gather(of, arms, loads);
        let mut roots = forces.fall(of, constant, gravity);
        let Equations { m, q1, q2, q3, .. } = &mut equations;

        let [r1, r2, r3] = rotations.rotation;
        let [w1, w2, w3] = rotations.speed;
        let (s1, s2, s3) = (w1 * w1, w2 * w2, w3 * w3);
        let [with_crank, with_slider] = [of.coupled[0], of.coupled[1]];
        let inwards = of.rod == Link::After;
        let (h2, axis): (Vec2<R>, _) = (r2.apply(bodies.moment[ROD]), r2.axis(R::ONE));
        let (mut h1, mut h3) = (Vec2::<R>::ZERO, Vec2::<R>::ZERO);
        if with_crank {
            h1 = r1.apply(bodies.moment[CRANK]);
        }
        if with_slider {
            h3 = r3.apply(bodies.moment[SLIDER]);
        }

        // Forces that the modal velocities require of the chain.
        let stretching = shape.chord.bias;
        let sliding = w2 * shape.chord.rate * 2.0; // Coriolis
        let first = inertia.first;
        let own = inertia.force + first * s2;
        let extra: Vec2<R> =
            r2.apply(Vec2::new(stretching.multiply_add(kappa, own.x), sliding.multiply_add(kappa, own.y)));
        let own_moment = first.x * sliding - first.y * stretching + length * own.y;
        *q2 -= (sliding * second).multiply_add(length, own_moment.multiply_add(big_end, inertia.couple));
        let far_extra: Vec2<R> = r2.apply(Vec2::new(stretching * far, sliding * far));
        let mut hanging = Vec2::<R>::ZERO; // acceleration of the joint by which the rod hangs, against the root
        let mut beyond = Vec2::<R>::ZERO; // centrifugal force of bodies beyond the far joint
        let mut asked = extra - h2 * s2;
        if with_crank {
            asked = h1.multiply_add(-s1, asked);
            if inwards {
                *q1 -= cross(h1, far_extra);
                beyond = h1 * -s1;
            } else {
                *q1 -= cross(arms.throw, extra);
                hanging = arms.throw * -s1;
            }
        }
        if with_slider {
            *q3 -= cross(h3, far_extra);
            beyond = h3 * -s3;
            asked = h3.multiply_add(-s3, asked);
        }

        // Acceleration of the root, and its elimination from the equations of the angles.
        let (root, per_mass) = (Root::of(of), constant.per_mass[ROD]);
        let on_root = match (root, of.rod) {
            (Root::Rail, _) => forces.rail,
            (_, Link::Free(_)) => forces.rod,
            _ => forces.crank,
        };
        let free = (on_root - asked) * per_mass;
        let (p1, p2, p3) = (perp(h1), perp(h2), perp(h3));
        let (per1, per2, per3) = (p1 * per_mass, p2 * per_mass, p3 * per_mass);
        if !matches!(root, Root::Ground) {
            *q2 -= root.product(p2, free);
            m.d2 -= root.product(p2, per2);
            if with_crank {
                *q1 -= root.product(p1, free);
                m.d1 -= root.product(p1, per1);
                m.m12 -= root.product(p1, per2);
            }
            if with_slider {
                *q3 -= root.product(p3, free);
                m.d3 -= root.product(p3, per3);
                m.m23 -= root.product(p3, per2);
            }
            if with_crank && with_slider {
                m.m13 -= root.product(p1, per3);
            }
        }

        // In a closed loop the rod's angle follows the crank's angle and the modes.
        let turns_crank = with_crank && !of.topology.speed;
        let (rod_inertia, rod_couple) = (m.d2, *q2);
        let following = closing.rod_ratio.multiply_add(m.d2, m.m12);
        if of.closed {
            m.d1 = closing.rod_ratio.multiply_add(m.m12 + following, m.d1);
            *q1 = (-following).multiply_add(closing.rod_bias, closing.rod_ratio.multiply_add(*q2, *q1));
            (m.m12, m.d2, *q2) = (R::ZERO, R::ONE, R::ZERO);
        }

        let along = (-s2).multiply_add(length, stretching); // acceleration of the far joint along the chord
        let chain = Chain {
            root,
            closed: of.closed,
            inwards,
            angles: [turns_crank, !of.closed, with_slider],
            rod: chain,
            per_mass,
            rotation: r2,
            length,
            first,
            along,
            sliding,
            resting: hanging + root.part(free) - root.held(gravity),
            across: perp(arms.throw),
            p1,
            p2,
            p3,
            by_length: axis.dot(forces.far_end - beyond) * far - along.multiply_add(second, inertia.force.x * big_end),
            crank_by_length: axis.dot(p1) * far,
            slider_by_length: axis.dot(p3) * far,
            closing: *closing,
            rod_inertia,
            rod_couple,
            following,
        };
        let (mut all, momentum) = self.modal_equations::<C>(&chain, &loads.end_couple);
        let per = all.condense::<C>(&mut equations);
        let Equations { m, q1, q2, q3, .. } = equations;
        let mut angle =
            if of.slider_angle.is_some() { m.solve(of, [q1, q2, q3]) } else { m.solve_crank_and_rod(of, [q1, q2]) };
        let found = all.accelerations::<C>(&per, angle);
        let mut lengthening = R::ZERO;
        unroll!(C::KNOWN, a < n, K => {
            modal[a] = found[a];
            lengthening = found[a].multiply_add(shape.chord_slope[a], lengthening);
        });
        if of.closed {
            let with_crank = closing.rod_ratio.multiply_add(angle[CRANK], closing.rod_bias);
            angle[ROD] = closing.rod_per_length.multiply_add(lengthening, with_crank);
        }
        match of.slider {
            Link::Rail(_) if !inwards => {
                roots.slider.x = forces.rail.x.multiply_add(constant.per_mass[SLIDER], R::constant(gravity.x));
            }
            _ => {}
        }
        if !matches!(root, Root::Ground) {
            let mut own = free - per2 * angle[ROD];
            if with_crank {
                own = per1.multiply_add(-angle[CRANK], own);
            }
            if with_slider {
                own = per3.multiply_add(-angle[SLIDER], own);
            }
            unroll!(C::KNOWN, a < n, K => {
                own = Vec2::new(momentum.x[a], momentum.y[a]).multiply_add(-(found[a] * per_mass), own);
            });
            let falling = own + gravity;
            match (root, of.rod) {
                (Root::Rail, _) => roots.slider.x = falling.x,
                (_, Link::Free(_)) => roots.rod = falling,
                _ => roots.crank = falling,
            }
        }
        Accelerations { roots, angle }
    }

    /// The equations of the modal coordinates with their couplings, and the momentum of each mode. `end_couple` are the
    /// couples [N·m] on the rod's end sections. The matrix takes the place of the rod's modal inertia.
    #[inline(always)]
    fn modal_equations<C: CompiledCounts>(
        &mut self,
        chain: &Chain<R>,
        end_couple: &[R; 2],
    ) -> (ModalEquations<'_, R, K>, Vec2<[R; K]>) {
        let Self { modes, shape, eta, rate, .. } = self;
        let Inertia { first_slope: first, with_angle, modal: matrix, modal_force, .. } = &mut *self.inertia;
        let n = C::COUNTS.unwrap_or(modes.counts).modes().min(K);
        let whole = const { R::PLAIN && !C::KNOWN };
        let count = in_registers::<R, C>(n, K);
        let slope = &shape.chord_slope;
        let own = |a: usize| Vec2::new(first.x[a], first.y[a]);
        let mut momentum = Vec2::new([R::ZERO; K], [R::ZERO; K]);
        let (mut with_rod, mut right) = ([R::ZERO; K], [R::ZERO; K]);
        unroll!(C::KNOWN, a < n, K => {
            right[a] = modes.force(a, eta[a], rate[a], end_couple) - modal_force[a];
        });
        unroll!(C::KNOWN, a < count, K => {
            let along = chain.momentum(slope[a], own(a));
            (momentum.x[a], momentum.y[a]) = (along.x, along.y);
            with_rod[a] = chain.with_rod(slope[a], own(a), with_angle[a]);
            right[a] = chain.force(slope[a], own(a), along, right[a]);
        });
        let mut with = [[R::ZERO; K]; 3];
        let [turns_crank, turns_rod, turns_slider] = chain.angles;
        if chain.closed {
            unroll!(C::KNOWN, a < count, K => {
                right[a] = chain.closed_force(slope[a], with_rod[a], right[a]);
            });
        }
        if turns_crank {
            unroll!(C::KNOWN, a < count, K => {
                let along = Vec2::new(momentum.x[a], momentum.y[a]);
                with[CRANK][a] = chain.with_crank(slope[a], along, with_rod[a]);
            });
            chain.move_root::<C, K>(chain.p1, &momentum, &mut with[CRANK], count);
        }
        if turns_rod {
            with[ROD] = with_rod;
            chain.move_root::<C, K>(chain.p2, &momentum, &mut with[ROD], count);
        }
        if turns_slider {
            unroll!(C::KNOWN, a < count, K => {
                with[SLIDER][a] = slope[a] * chain.slider_by_length;
            });
            chain.move_root::<C, K>(chain.p3, &momentum, &mut with[SLIDER], count);
        }
        unroll!(C::KNOWN, a < n, K => {
            let (row, end) = (&mut matrix[a], if whole { count } else { a + 1 });
            unroll!(C::KNOWN, b < end, K => {
                row[b] = chain.inertia([slope[a], slope[b]], [first.x[a], first.x[b]], row[b]);
            });
            if chain.closed {
                unroll!(C::KNOWN, b < end, K => {
                    row[b] = chain.closed_inertia([slope[a], slope[b]], [with_rod[a], with_rod[b]], row[b]);
                });
            }
            chain.move_root::<C, K>(Vec2::new(momentum.x[a], momentum.y[a]), &momentum, row, end);
        });
        (ModalEquations { size: n, angles: chain.angles, matrix, with, right }, momentum)
    }
}

/// The chain's part of the modal equations: numbers that are the same for all modes. In its methods `slope` is L_a of a
/// mode and `own` is ∂D/∂η_a.
struct Chain<R> {
    root: Root,
    closed: bool,
    inwards: bool,
    /// Which of the angles of crank, rod and slider are coordinates that the modes are coupled with.
    angles: [bool; 3],
    rod: RodInChain,
    /// [1/kg] Inverse mass of the chain.
    per_mass: f64,
    rotation: Rotation<R>,
    /// [m] Length L of the chord.
    length: R,
    /// [kg·m] First moment D of the rod about its big end.
    first: Vec2<R>,
    /// [m/s²] L̈ − θ̇²·L at η̈ = 0.
    along: R,
    /// [m/s²] 2·θ̇·L̇.
    sliding: R,
    /// [m/s²] Acceleration of the joint by which the rod hangs, at zero accelerations of the coordinates, less the
    /// part of gravity in whose direction the root cannot fall.
    resting: Vec2<R>,
    /// [m] perp(throw).
    across: Vec2<R>,
    /// [kg·m] Momentum per unit of the angular velocities of crank, rod and slider.
    p1: Vec2<R>,
    p2: Vec2<R>,
    p3: Vec2<R>,
    /// [N] Force along the chord.
    by_length: R,
    /// [kg·m] Coupling of the crank's angle with the length of the chord, if the crank hangs on the rod.
    crank_by_length: R,
    /// [kg·m] Coupling of the slider's angle with the length of the chord.
    slider_by_length: R,
    closing: IdealMotion<R>,
    /// In a closed loop: [kg·m²] M_22, [N·m] Q_2 and [kg·m²] M_12 + ρ·M_22.
    rod_inertia: R,
    rod_couple: R,
    following: R,
}

impl<R: Real> Chain<R> {
    /// [kg] p_a = rot(θ2)·P_a: momentum per unit of the modal velocity.
    #[inline(always)]
    fn momentum(&self, slope: R, own: Vec2<R>) -> Vec2<R> {
        self.rotation.apply(Vec2::new(slope.multiply_add(self.rod.first, own.x), own.y))
    }

    /// [kg·m] M_θa: coupling with the rod's angle.
    #[inline(always)]
    fn with_rod(&self, slope: R, own: Vec2<R>, with_angle: R) -> R {
        (self.length * own.y - self.first.y * slope).multiply_add(self.rod.big_end, with_angle)
    }

    /// [kg·m] Coupling with the crank's angle while the root rests.
    #[inline(always)]
    fn with_crank(&self, slope: R, momentum: Vec2<R>, with_rod: R) -> R {
        if self.closed {
            let follows = self.closing.rod_per_length * slope;
            let open = self.closing.rod_ratio.multiply_add(with_rod, self.across.dot(momentum));
            self.following.multiply_add(follows, open)
        } else if self.inwards {
            slope * self.crank_by_length
        } else {
            self.across.dot(momentum)
        }
    }

    /// Subtracts p·p_a/m, the part of a root that moves, from the first `count` entries of a list: `p` is the momentum
    /// of a coordinate, `momentum` that of each mode.
    #[inline(always)]
    fn move_root<C: CompiledCounts, const K: usize>(
        &self,
        p: Vec2<R>,
        momentum: &Vec2<[R; K]>,
        list: &mut [R; K],
        count: usize,
    ) {
        let p = p * -self.per_mass;
        match self.root {
            Root::Ground => {}
            Root::Rail => unroll!(C::KNOWN, a < count, K => {
                list[a] = p.x.multiply_add(momentum.x[a], list[a]);
            }),
            Root::Free => unroll!(C::KNOWN, a < count, K => {
                list[a] = p.x.multiply_add(momentum.x[a], p.y.multiply_add(momentum.y[a], list[a]));
            }),
        }
    }

    /// [N] Q_a in an open chain; `own_force` is the force that the rod itself exerts on the mode.
    #[inline(always)]
    fn force(&self, slope: R, own: Vec2<R>, momentum: Vec2<R>, own_force: R) -> R {
        let force = slope.multiply_add(self.by_length, own_force);
        let force = own.x.multiply_add(self.along, own.y * self.sliding).multiply_add(-self.rod.big_end, force);
        force - momentum.dot(self.resting)
    }

    /// [N] Q_a with the rod's angle eliminated in a closed loop; `open` is that of the open chain.
    #[inline(always)]
    fn closed_force(&self, slope: R, with_rod: R, open: R) -> R {
        let follows = self.closing.rod_per_length * slope;
        let inertia = self.rod_inertia.multiply_add(follows, with_rod);
        (-inertia).multiply_add(self.closing.rod_bias, follows.multiply_add(self.rod_couple, open))
    }

    /// [kg] M_ab of two modes while the root rests; `own_x` are the x components of their ∂D/∂η, and `own_inertia` is
    /// m_ab of the rod.
    #[inline(always)]
    fn inertia(&self, slope: [R; 2], own_x: [R; 2], own_inertia: R) -> R {
        let [a, b] = slope;
        let crossed = own_x[0].multiply_add(b, own_x[1] * a);
        crossed.multiply_add(self.rod.big_end, (a * b).multiply_add(self.rod.second, own_inertia))
    }

    /// [kg] M_ab of two modes with the rod's angle eliminated in a closed loop; `open` is that of the open chain.
    #[inline(always)]
    fn closed_inertia(&self, slope: [R; 2], with_rod: [R; 2], open: R) -> R {
        let [a, b] = [self.closing.rod_per_length * slope[0], self.closing.rod_per_length * slope[1]];
        let crossed = a.multiply_add(with_rod[1], b * with_rod[0]);
        open + (a * b).multiply_add(self.rod_inertia, crossed)
    }
}
