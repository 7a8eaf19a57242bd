//! Where every joint centre of a mechanism with a flexible rod is, how it moves, and how its
//! acceleration depends on the accelerations of the coordinates.
//!
//! Modes move joint centres through one number only, the chord's length L. Places are therefore given
//! over the coordinates x = (rigid coordinates, L): a = J·ẍ + bias, where L̈ = ∂L/∂η·η̈ + bias.

use super::chain::Frame;
use super::sparse::Sparse;
use crate::math::{self, Real, each};
use crate::model::drive::Rotor;
use crate::model::ideal::IdealMechanism;
use crate::model::kinematics::{JointCentres, Turning};
use crate::model::plane::{Rotation, Vec2, perp};
use crate::model::rod::{Chord, Rod, Shape};
use crate::model::state::{Pose, turning_at};
use crate::model::structure::{CRANK, ROD, SLIDER, Topology};
use std::ops::Range;

/// A joint centre.
#[derive(Clone, Copy, Debug)]
pub struct Centre<R, const P: usize> {
    /// [m]
    pub place: Vec2<R>,
    /// [m/s]
    pub velocity: Vec2<R>,
    /// [m/s²] Acceleration at q̈ = 0.
    pub bias: Vec2<R>,
    /// ∂/∂x.
    pub slope: [Vec2<Sparse<R>>; P],
}

/// The angle of a body.
#[derive(Clone, Copy, Debug)]
pub struct Heading<R, const P: usize> {
    /// By the angle.
    pub rotation: Rotation<R>,
    /// [rad]
    pub angle: R,
    /// [rad/s]
    pub speed: R,
    /// [rad/s²] Acceleration at q̈ = 0.
    pub bias: R,
    /// ∂θ/∂x.
    pub slope: [Sparse<R>; P],
}

/// All of them at one instant.
#[derive(Clone, Copy, Debug)]
pub struct Configuration<R, const P: usize> {
    /// Crank, rod, slider.
    pub heading: [Heading<R, P>; 3],
    /// The crank's main journal and pin, the rod's ends, the slider's pin.
    pub crank: Centre<R, P>,
    /// The crank's pin.
    pub crank_pin: Centre<R, P>,
    /// The rod's big end.
    pub big_end: Centre<R, P>,
    /// The rod's small end.
    pub small_end: Centre<R, P>,
    /// The slider's pin.
    pub pin: Centre<R, P>,
}

/// What places need to be known.
#[derive(Clone, Debug)]
pub struct Geometry {
    /// Which joints are ideal, and where the coordinates stand.
    pub frame: Frame,
    /// Lengths, and the height of the pin on an ideal guide.
    pub ideal: IdealMechanism,
    /// The prescribed rotation.
    pub rotor: Rotor,
    /// The rod.
    pub rod: Rod,
}

impl<R: Real, const P: usize> Centre<R, P> {
    const FIXED: Self = Self { place: Vec2::ZERO, velocity: Vec2::ZERO, bias: Vec2::ZERO, slope: [Vec2::NONE; P] };

    /// A point that is not in the rod's chain.
    #[inline(always)]
    fn alone(place: Vec2<R>, velocity: Vec2<R>) -> Self {
        Self { place, velocity, ..Self::FIXED }
    }

    /// The chain's root, whose coordinates come first in x.
    #[inline(always)]
    fn root(place: Vec2<R>, velocity: Vec2<R>) -> Self {
        let mut centre = Self::alone(place, velocity);
        centre.slope[0].x = Sparse::ONE;
        centre.slope[1].y = Sparse::ONE;
        centre
    }

    /// The point `side`·`arm` further, `arm` turning with a body.
    #[inline(always)]
    pub fn along(&self, heading: &Heading<R, P>, side: f64, arm: Vec2<R>) -> Self {
        let arm = arm * side;
        let across = perp(arm);
        let mut slope = self.slope;
        each!(R::PLAIN, k < P => {
            slope[k] = heading.slope[k].times_vector_plus(across, slope[k]);
        });
        Self {
            place: self.place + arm,
            velocity: across.times_plus(heading.speed, self.velocity),
            bias: arm.times_plus(-(heading.speed * heading.speed), across.times_plus(heading.bias, self.bias)),
            slope,
        }
    }

    /// The other end of the rod, forwards or backwards; L stands at `chord`.
    #[inline(always)]
    fn across_rod(&self, rod: &Heading<R, P>, chord: &Chord<R>, place: usize, side: f64) -> Self {
        let axis = rod.rotation.axis(side);
        let mut end = self.along(rod, 1.0, chord.length * axis);
        end.velocity += chord.rate * axis;
        end.bias += chord.bias * axis + chord.rate * 2.0 * rod.speed * perp(axis);
        end.slope[place] += Sparse::ONE.times(axis);
        end
    }

    /// A point of a body, `arm` [m] away in its axes.
    #[inline(always)]
    pub fn carried(&self, heading: &Heading<R, P>, arm: Vec2) -> Self {
        self.along(heading, 1.0, heading.rotation.apply(arm))
    }

    /// [m/s²] At the accelerations `forced` of x, the bias of L apart.
    pub fn acceleration(&self, forced: &[R; P]) -> Vec2<R> {
        self.slope
            .iter()
            .zip(forced)
            .fold(self.bias, |sum, (slope, a)| sum + Vec2::new(slope.x.value(), slope.y.value()) * *a)
    }
}

impl<R: Real, const P: usize> Heading<R, P> {
    /// Of a body.
    #[inline(always)]
    fn new(turning: &Turning<R>, body: usize, coordinate: Option<usize>) -> Self {
        let mut slope = [Sparse::Zero; P];
        if let Some(k) = coordinate {
            slope[k] = Sparse::ONE;
        }
        let Turning { rotation, angle, speed } = turning;
        Self { rotation: rotation[body], angle: angle[body], speed: speed[body], bias: R::ZERO, slope }
    }

    /// [rad/s²] At the accelerations `forced` of x, the bias of L apart.
    pub fn acceleration(&self, forced: &[R; P]) -> R {
        self.bias + self.slope.iter().zip(forced).fold(R::ZERO, |sum, (slope, a)| sum + slope.value() * *a)
    }
}

impl Geometry {
    /// Where the modal coordinates stand.
    #[inline(always)]
    pub fn modes(&self, frame: Frame) -> Range<usize> {
        let rigid = frame.structure.positions;
        rigid..rigid + self.rod.modes()
    }

    /// Accelerations of x at `forced` of the coordinates, the bias of L apart.
    pub fn accelerations<R: Real, const P: usize, const K: usize, const F: usize>(
        &self,
        frame: Frame,
        shape: &Shape<R, K, F>,
        forced: &[R],
    ) -> [R; P] {
        let mut all = frame.chain.gather(forced);
        for (slope, a) in shape.chord_slope.iter().zip(&forced[self.modes(frame)]) {
            all[frame.chain.size] += *slope * *a;
        }
        all
    }

    /// The configuration of `positions` and `rates` at `t`.
    #[inline(always)]
    pub fn configuration<R: Real, const P: usize>(
        &self,
        frame: Frame,
        t: R,
        positions: &[R],
        rates: &[R],
        chord: &Chord<R>,
    ) -> Configuration<R, P> {
        let Frame { structure, chain } = frame;
        let (place, Topology { a, b, c, t: guided, .. }) = (chain.size, structure.topology);
        let closed = structure.closed;
        let turning = turning_at(&structure, &self.rotor, t, positions, rates);
        let crank = Heading::new(&turning, CRANK, chain.angle[CRANK]);
        let slider = Heading::new(&turning, SLIDER, chain.angle[SLIDER]);
        let rod =
            if closed { self.closing_rod(&crank, chord, place) } else { Heading::new(&turning, ROD, chain.angle[ROD]) };
        let (mut roots, moving) = (structure.roots(positions), structure.roots(rates));
        let throw = crank.rotation.axis(self.ideal.crank);
        if guided {
            roots.slider.y = R::constant(self.ideal.height);
        }

        let (crank_centre, crank_pin, big_end, small_end, pin);
        if c && guided && !closed {
            let mut on_rail = Centre::alone(roots.slider, moving.slider);
            on_rail.slope[0].x = Sparse::ONE;
            pin = on_rail;
            small_end = on_rail;
            big_end = pin.across_rod(&rod, chord, place, -1.0);
            if b {
                crank_pin = big_end;
                crank_centre = big_end.along(&crank, -1.0, throw);
            } else {
                crank_centre = Centre::alone(roots.crank, moving.crank);
                crank_pin = crank_centre.along(&crank, 1.0, throw);
            }
        } else {
            crank_centre = if a {
                Centre::FIXED
            } else if b {
                Centre::root(roots.crank, moving.crank)
            } else {
                Centre::alone(roots.crank, moving.crank)
            };
            crank_pin = crank_centre.along(&crank, 1.0, throw);
            big_end = if b { crank_pin } else { Centre::root(roots.rod, moving.rod) };
            small_end = big_end.across_rod(&rod, chord, place, 1.0);
            pin = if c { small_end } else { Centre::alone(roots.slider, moving.slider) };
        }
        Configuration { heading: [crank, rod, slider], crank: crank_centre, crank_pin, big_end, small_end, pin }
    }

    /// The rod's angle where all joints are ideal: r·sin θ1 + L·sin θ2 = height, differentiated twice.
    #[inline(always)]
    fn closing_rod<R: Real, const P: usize>(
        &self,
        crank: &Heading<R, P>,
        chord: &Chord<R>,
        place: usize,
    ) -> Heading<R, P> {
        let IdealMechanism { crank: r, height, .. } = self.ideal;
        let Chord { length: l, rate, bias: stretching, .. } = *chord;
        let sin = (-(crank.rotation.sin * r) + height) / l;
        let cos = ((-sin + 1.0) * (sin + 1.0)).sqrt();
        let per_reach = (l * cos).recip();
        let throw = crank.rotation.cos * r;
        let speed = -(throw * crank.speed + sin * rate) * per_reach;
        let bias = (crank.rotation.sin * r * crank.speed * crank.speed - throw * crank.bias + l * sin * speed * speed
            - rate * 2.0 * cos * speed
            - sin * stretching)
            * per_reach;
        let mut slope = crank.slope;
        each!(R::PLAIN, k < P => {
            slope[k] = slope[k].map(|slope| -throw * slope * per_reach);
        });
        slope[place] = Sparse::Is(-(sin * per_reach));
        Heading { rotation: Rotation { cos, sin }, angle: math::atan2(sin, cos), speed, bias, slope }
    }
}

impl<R: Real, const P: usize> Configuration<R, P> {
    /// Places and velocities without their slopes.
    #[inline(always)]
    pub fn pose(&self, slope_rate: [R; 2]) -> Pose<R> {
        let [crank, rod, slider] = &self.heading;
        let turning = Turning {
            angle: [crank.angle, rod.angle, slider.angle],
            speed: [crank.speed, rod.speed, slider.speed],
            rotation: [crank.rotation, rod.rotation, slider.rotation],
        };
        Pose {
            turning,
            place: self.each(|centre| centre.place),
            velocity: self.each(|centre| centre.velocity),
            section_speed: slope_rate.map(|rate| rod.speed + rate),
        }
    }

    /// One vector of every joint centre.
    #[inline(always)]
    pub fn each(&self, of: impl Fn(&Centre<R, P>) -> Vec2<R>) -> JointCentres<R> {
        JointCentres {
            crank: of(&self.crank),
            crank_pin: of(&self.crank_pin),
            big_end: of(&self.big_end),
            small_end: of(&self.small_end),
            pin: of(&self.pin),
        }
    }
}
