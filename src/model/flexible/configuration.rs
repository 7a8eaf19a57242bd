//! Where every joint centre of a mechanism with a flexible rod is, how it moves, and how its
//! acceleration depends on the accelerations of the coordinates.
//!
//! Modes move joint centres through one number only, the chord's length L. Places are therefore given
//! over the coordinates x = (rigid coordinates, L): a = J·ẍ + bias, where L̈ = ∂L/∂η·η̈ + bias.

use crate::math::{self, Real};
use crate::model::coordinates::Layout;
use crate::model::drive::Rotor;
use crate::model::ideal::IdealMechanism;
use crate::model::kinematics::{JointCentres, Turning};
use crate::model::mechanism::{CRANK, ROD, SLIDER, Topology};
use crate::model::plane::{Rotation, Vec2, perp};
use crate::model::rod::{Rod, Shape};
use crate::model::state::Pose;

/// Room for x: nine rigid coordinates at most, then L.
pub const PLACES: usize = 10;

/// A joint centre.
#[derive(Clone, Copy, Debug)]
pub struct Centre<R> {
    /// [m]
    pub place: Vec2<R>,
    /// [m/s]
    pub velocity: Vec2<R>,
    /// [m/s²] Acceleration at q̈ = 0.
    pub bias: Vec2<R>,
    /// ∂/∂x.
    pub slope: [Vec2<R>; PLACES],
}

/// The angle of a body.
#[derive(Clone, Copy, Debug)]
pub struct Heading<R> {
    /// By the angle.
    pub rotation: Rotation<R>,
    /// [rad]
    pub angle: R,
    /// [rad/s]
    pub speed: R,
    /// [rad/s²] Acceleration at q̈ = 0.
    pub bias: R,
    /// ∂θ/∂x.
    pub slope: [R; PLACES],
}

/// All of them at one instant.
#[derive(Clone, Copy, Debug)]
pub struct Configuration<R, const K: usize, const F: usize> {
    /// Crank, rod, slider.
    pub heading: [Heading<R>; 3],
    /// The rod.
    pub shape: Shape<R, K, F>,
    /// The crank's main journal and pin, the rod's ends, the slider's pin.
    pub crank: Centre<R>,
    /// The crank's pin.
    pub crank_pin: Centre<R>,
    /// The rod's big end.
    pub big_end: Centre<R>,
    /// The rod's small end.
    pub small_end: Centre<R>,
    /// The slider's pin.
    pub pin: Centre<R>,
}

/// What places need to be known.
#[derive(Clone, Debug)]
pub struct Geometry {
    /// Which joints are ideal.
    pub topology: Topology,
    /// Where the coordinates stand.
    pub layout: Layout,
    /// Lengths, and the height of the pin on an ideal guide.
    pub ideal: IdealMechanism,
    /// The prescribed rotation.
    pub rotor: Rotor,
    /// The rod.
    pub rod: Rod,
}

impl<R: Real> Centre<R> {
    const FIXED: Self = Self { place: Vec2::ZERO, velocity: Vec2::ZERO, bias: Vec2::ZERO, slope: [Vec2::ZERO; PLACES] };

    /// A point whose coordinates, from the place `first` on, are positions themselves.
    #[inline(always)]
    fn root(place: Vec2<R>, velocity: Vec2<R>, first: usize) -> Self {
        let mut centre = Self { place, velocity, ..Self::FIXED };
        centre.slope[first].x = R::ONE;
        centre.slope[first + 1].y = R::ONE;
        centre
    }

    /// The pin on an ideal guide, whose x is a position.
    #[inline(always)]
    fn on_rail(x: R, speed: R, height: f64, coordinate: usize) -> Self {
        let place = Vec2::new(x, R::constant(height));
        let mut centre = Self { place, velocity: Vec2::new(speed, R::ZERO), ..Self::FIXED };
        centre.slope[coordinate].x = R::ONE;
        centre
    }

    /// The point `side`·`arm` further, `arm` turning with a body.
    #[inline(always)]
    fn along(&self, heading: &Heading<R>, side: f64, arm: Vec2<R>) -> Self {
        let arm = arm * side;
        let across = perp(arm);
        Self {
            place: self.place + arm,
            velocity: self.velocity + heading.speed * across,
            bias: self.bias + heading.bias * across - heading.speed * heading.speed * arm,
            slope: std::array::from_fn(|k| self.slope[k] + heading.slope[k] * across),
        }
    }

    /// The other end of the rod, forwards or backwards; L stands at `chord`.
    #[inline(always)]
    fn across_rod<const K: usize, const F: usize>(
        &self,
        rod: &Heading<R>,
        shape: &Shape<R, K, F>,
        chord: usize,
        side: f64,
    ) -> Self {
        let axis = rod.rotation.axis(side);
        let mut end = self.along(rod, 1.0, shape.chord * axis);
        end.velocity += shape.chord_rate * axis;
        end.bias += shape.chord_bias * axis + shape.chord_rate * 2.0 * rod.speed * perp(axis);
        end.slope[chord] += axis;
        end
    }

    /// A point of a body, `arm` [m] away in its axes.
    #[inline(always)]
    pub fn carried(&self, heading: &Heading<R>, arm: Vec2) -> Self {
        self.along(heading, 1.0, heading.rotation.apply(arm))
    }

    /// [m/s²] At the accelerations `forced` of x, the bias of L apart.
    pub fn acceleration(&self, forced: &[R; PLACES]) -> Vec2<R> {
        self.slope.iter().zip(forced).fold(self.bias, |sum, (slope, a)| sum + *a * *slope)
    }
}

impl<R: Real> Heading<R> {
    /// Of a slider on an ideal guide.
    const NONE: Self =
        Self { rotation: Rotation::NONE, angle: R::ZERO, speed: R::ZERO, bias: R::ZERO, slope: [R::ZERO; PLACES] };

    #[inline(always)]
    fn new(angle: R, speed: R, coordinate: Option<usize>) -> Self {
        let mut slope = [R::ZERO; PLACES];
        if let Some(k) = coordinate {
            slope[k] = R::ONE;
        }
        Self { rotation: Rotation::new(angle), angle, speed, bias: R::ZERO, slope }
    }

    /// [rad/s²] At the accelerations `forced` of x, the bias of L apart.
    pub fn acceleration(&self, forced: &[R; PLACES]) -> R {
        self.bias + self.slope.iter().zip(forced).fold(R::ZERO, |sum, (slope, a)| sum + *slope * *a)
    }
}

impl Geometry {
    /// Number of coordinates that are not modal.
    pub fn rigid(&self) -> usize {
        if self.topology.is_closed() { usize::from(!self.topology.speed) } else { self.topology.freedoms() }
    }

    /// Where the modal coordinates stand.
    pub fn modes(&self) -> std::ops::Range<usize> {
        let rigid = self.rigid();
        rigid..rigid + self.rod.modes()
    }

    /// Accelerations of x at `forced` of the coordinates, the bias of L apart.
    pub fn accelerations<R: Real, const K: usize, const F: usize>(
        &self,
        shape: &Shape<R, K, F>,
        forced: &[R],
    ) -> [R; PLACES] {
        let rigid = self.rigid();
        let mut all = [R::ZERO; PLACES];
        all[..rigid].copy_from_slice(&forced[..rigid]);
        for (slope, a) in shape.chord_slope.iter().zip(&forced[self.modes()]) {
            all[rigid] += *slope * *a;
        }
        all
    }

    /// The configuration of `positions` and `rates` at `t`.
    #[inline(always)]
    pub fn configuration<R: Real, const K: usize, const F: usize>(
        &self,
        t: R,
        positions: &[R],
        rates: &[R],
    ) -> Configuration<R, K, F> {
        let Topology { a, b, c, t: guided, speed } = self.topology;
        let closed = self.topology.is_closed();
        let modes = self.modes();
        let shape = self.rod.shape(&positions[modes.clone()], &rates[modes.clone()]);
        let chord = modes.start;
        let angle = |k: usize| {
            let place = self.layout.angle(k);
            Heading::new(place.map_or(R::ZERO, |i| positions[i]), place.map_or(R::ZERO, |i| rates[i]), place)
        };
        let driven = || Heading::new(self.rotor.at(t), R::constant(self.rotor.speed), None);
        let crank = if speed { driven() } else { angle(CRANK) };
        let slider = if guided { Heading::NONE } else { angle(SLIDER) };
        let rod = if closed { self.closing_rod(&crank, &shape, chord) } else { angle(ROD) };
        let (roots, moving) = (self.layout.roots(positions), self.layout.roots(rates));
        let throw = crank.rotation.axis(self.ideal.crank);
        // Roots stand in the order crank, rod, slider.
        let rod_root = if self.topology.crank_floats() { 2 } else { 0 };
        let slider_root = rod_root + if self.topology.rod_floats() { 2 } else { 0 };
        let on_rail = || Centre::on_rail(roots.slider.x, moving.slider.x, self.ideal.height, slider_root);
        let crank_root = || if a { Centre::FIXED } else { Centre::root(roots.crank, moving.crank, 0) };

        let (crank_centre, crank_pin, big_end, small_end, pin);
        if c && guided && !closed {
            pin = on_rail();
            small_end = pin;
            big_end = pin.across_rod(&rod, &shape, chord, -1.0);
            if b {
                crank_pin = big_end;
                crank_centre = big_end.along(&crank, -1.0, throw);
            } else {
                crank_centre = crank_root();
                crank_pin = crank_centre.along(&crank, 1.0, throw);
            }
        } else {
            crank_centre = crank_root();
            crank_pin = crank_centre.along(&crank, 1.0, throw);
            big_end = if b { crank_pin } else { Centre::root(roots.rod, moving.rod, rod_root) };
            small_end = big_end.across_rod(&rod, &shape, chord, 1.0);
            pin = if c {
                small_end
            } else if guided {
                on_rail()
            } else {
                Centre::root(roots.slider, moving.slider, slider_root)
            };
        }
        Configuration { heading: [crank, rod, slider], shape, crank: crank_centre, crank_pin, big_end, small_end, pin }
    }

    /// The rod's angle where all joints are ideal: r·sin θ1 + L·sin θ2 = height, differentiated twice.
    fn closing_rod<R: Real, const K: usize, const F: usize>(
        &self,
        crank: &Heading<R>,
        shape: &Shape<R, K, F>,
        chord: usize,
    ) -> Heading<R> {
        let IdealMechanism { crank: r, height, .. } = self.ideal;
        let (l, rate) = (shape.chord, shape.chord_rate);
        let sin = (-(crank.rotation.sin * r) + height) / l;
        let cos = ((-sin + 1.0) * (sin + 1.0)).sqrt();
        let per_reach = (l * cos).recip();
        let throw = crank.rotation.cos * r;
        let speed = -(throw * crank.speed + sin * rate) * per_reach;
        let bias = (crank.rotation.sin * r * crank.speed * crank.speed - throw * crank.bias + l * sin * speed * speed
            - rate * 2.0 * cos * speed
            - sin * shape.chord_bias)
            * per_reach;
        let mut slope = crank.slope.map(|slope| -throw * slope * per_reach);
        slope[chord] -= sin * per_reach;
        Heading { rotation: Rotation { cos, sin }, angle: math::atan2(sin, cos), speed, bias, slope }
    }
}

impl<R: Real, const K: usize, const F: usize> Configuration<R, K, F> {
    /// Places and velocities without their slopes.
    pub fn pose(&self) -> Pose<R> {
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
            section_speed: self.shape.slope_rate.map(|rate| rod.speed + rate),
        }
    }

    /// One vector of every joint centre.
    pub fn each(&self, of: impl Fn(&Centre<R>) -> Vec2<R>) -> JointCentres<R> {
        JointCentres {
            crank: of(&self.crank),
            crank_pin: of(&self.crank_pin),
            big_end: of(&self.big_end),
            small_end: of(&self.small_end),
            pin: of(&self.pin),
        }
    }
}
