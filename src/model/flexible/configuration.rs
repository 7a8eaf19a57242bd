//! Where every joint centre of a mechanism with a flexible rod is, how it moves, and how its
//! acceleration depends on the accelerations of the coordinates: a = J·q̈ + bias.

use crate::math;
use crate::model::coordinates::Layout;
use crate::model::drive::Rotor;
use crate::model::ideal::IdealMechanism;
use crate::model::kinematics::{JointCentres, Turning};
use crate::model::mechanism::{CRANK, ROD, SLIDER, Topology};
use crate::model::plane::{Rotation, Vec2, perp};
use crate::model::rod::{Rod, Shape};
use crate::model::state::Pose;

/// A joint centre.
#[derive(Clone, Copy, Debug)]
pub struct Centre<const Q: usize> {
    /// [m]
    pub place: Vec2,
    /// [m/s]
    pub velocity: Vec2,
    /// [m/s²] Acceleration at q̈ = 0.
    pub bias: Vec2,
    /// ∂x/∂q and ∂y/∂q.
    pub slope: [[f64; Q]; 2],
}

/// The angle of a body.
#[derive(Clone, Copy, Debug)]
pub struct Heading<const Q: usize> {
    /// By the angle.
    pub rotation: Rotation,
    /// [rad]
    pub angle: f64,
    /// [rad/s]
    pub speed: f64,
    /// [rad/s²] Acceleration at q̈ = 0.
    pub bias: f64,
    /// ∂θ/∂q.
    pub slope: [f64; Q],
}

/// All of them at one instant.
#[derive(Clone, Copy, Debug)]
pub struct Configuration<const Q: usize, const K: usize, const F: usize> {
    /// Crank, rod, slider.
    pub heading: [Heading<Q>; 3],
    /// The rod.
    pub shape: Shape<K, F>,
    /// The crank's main journal and pin, the rod's ends, the slider's pin.
    pub crank: Centre<Q>,
    /// The crank's pin.
    pub crank_pin: Centre<Q>,
    /// The rod's big end.
    pub big_end: Centre<Q>,
    /// The rod's small end.
    pub small_end: Centre<Q>,
    /// The slider's pin.
    pub pin: Centre<Q>,
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

impl<const Q: usize> Centre<Q> {
    const FIXED: Self = Self {
        place: Vec2::new(0.0, 0.0),
        velocity: Vec2::new(0.0, 0.0),
        bias: Vec2::new(0.0, 0.0),
        slope: [[0.0; Q]; 2],
    };

    /// A point whose coordinates are positions themselves.
    fn root(place: Vec2, velocity: Vec2, coordinates: [Option<usize>; 2]) -> Self {
        let mut centre = Self { place, velocity, ..Self::FIXED };
        for (row, coordinate) in centre.slope.iter_mut().zip(coordinates) {
            if let Some(k) = coordinate {
                row[k] = 1.0;
            }
        }
        centre
    }

    /// The point `side`·`arm` further, `arm` turning with a body.
    fn along(mut self, heading: &Heading<Q>, side: f64, arm: Vec2) -> Self {
        let arm = side * arm;
        let across = perp(arm);
        self.place += arm;
        self.velocity += heading.speed * across;
        self.bias += heading.bias * across - heading.speed * heading.speed * arm;
        for k in 0..Q {
            self.slope[0][k] += across.x * heading.slope[k];
            self.slope[1][k] += across.y * heading.slope[k];
        }
        self
    }

    /// The other end of the rod, forwards or backwards.
    fn across_rod<const K: usize, const F: usize>(
        self,
        rod: &Heading<Q>,
        shape: &Shape<K, F>,
        modes: std::ops::Range<usize>,
        side: f64,
    ) -> Self {
        let axis = rod.rotation.axis(1.0);
        let mut end = self.along(rod, side, shape.chord * axis);
        end.velocity += side * shape.chord_rate * axis;
        end.bias += side * (shape.chord_bias * axis + 2.0 * shape.chord_rate * rod.speed * perp(axis));
        for (k, slope) in modes.zip(shape.chord_slope) {
            end.slope[0][k] += side * slope * axis.x;
            end.slope[1][k] += side * slope * axis.y;
        }
        end
    }

    /// A point of a body, `arm` [m] away in its axes.
    pub fn carried(&self, heading: &Heading<Q>, arm: Vec2) -> Self {
        self.along(heading, 1.0, heading.rotation.apply(arm))
    }

    /// [m/s²] At the accelerations `forced` of the coordinates.
    pub fn acceleration(&self, forced: &[f64]) -> Vec2 {
        let sum = |row: &[f64; Q]| row.iter().zip(forced).map(|(slope, a)| slope * a).sum::<f64>();
        self.bias + Vec2::new(sum(&self.slope[0]), sum(&self.slope[1]))
    }
}

impl<const Q: usize> Heading<Q> {
    fn new(angle: f64, speed: f64, coordinate: Option<usize>) -> Self {
        let mut slope = [0.0; Q];
        if let Some(k) = coordinate {
            slope[k] = 1.0;
        }
        Self { rotation: Rotation::new(angle), angle, speed, bias: 0.0, slope }
    }

    /// [rad/s²] At the accelerations `forced` of the coordinates.
    pub fn acceleration(&self, forced: &[f64]) -> f64 {
        self.bias + self.slope.iter().zip(forced).map(|(slope, a)| slope * a).sum::<f64>()
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

    /// The configuration of `positions` and `rates` at `t`.
    pub fn configuration<const Q: usize, const K: usize, const F: usize>(
        &self,
        t: f64,
        positions: &[f64],
        rates: &[f64],
    ) -> Configuration<Q, K, F> {
        let Topology { a, b, c, t: guided, speed } = self.topology;
        let modes = self.modes();
        let shape = self.rod.shape(&positions[modes.clone()], &rates[modes.clone()]);
        let place = |k: usize| self.layout.angle(k);
        let angle = |k: usize| {
            Heading::new(place(k).map_or(0.0, |i| positions[i]), place(k).map_or(0.0, |i| rates[i]), place(k))
        };
        let crank = if speed { Heading::new(self.rotor.at(t), self.rotor.speed, None) } else { angle(CRANK) };
        let slider = angle(SLIDER);
        let rod = if self.topology.is_closed() { self.closing_rod(&crank, &shape, modes.clone()) } else { angle(ROD) };
        let (roots, moving) = (self.layout.roots(positions), self.layout.roots(rates));
        let two = |first: usize| [Some(first), Some(first + 1)];
        let throw = crank.rotation.axis(self.ideal.crank);
        // Roots stand in the order crank, rod, slider.
        let rod_root = if self.topology.crank_floats() { 2 } else { 0 };
        let slider_root = rod_root + if self.topology.rod_floats() { 2 } else { 0 };
        let root = |place: Vec2, velocity: Vec2, first: usize| Centre::root(place, velocity, two(first));

        let (crank_centre, crank_pin, big_end, small_end, pin);
        if c && guided && !self.topology.is_closed() {
            let on_rail = Vec2::new(roots.slider.x, self.ideal.height);
            pin = Centre::root(on_rail, Vec2::new(moving.slider.x, 0.0), [Some(slider_root), None]);
            small_end = pin;
            big_end = pin.across_rod(&rod, &shape, modes, -1.0);
            if b {
                crank_pin = big_end;
                crank_centre = big_end.along(&crank, -1.0, throw);
            } else {
                crank_centre = if a { Centre::FIXED } else { root(roots.crank, moving.crank, 0) };
                crank_pin = crank_centre.along(&crank, 1.0, throw);
            }
        } else {
            crank_centre = if a { Centre::FIXED } else { root(roots.crank, moving.crank, 0) };
            crank_pin = crank_centre.along(&crank, 1.0, throw);
            big_end = if b { crank_pin } else { root(roots.rod, moving.rod, rod_root) };
            small_end = big_end.across_rod(&rod, &shape, modes, 1.0);
            pin = if c {
                small_end
            } else if guided {
                let on_rail = Vec2::new(roots.slider.x, self.ideal.height);
                Centre::root(on_rail, Vec2::new(moving.slider.x, 0.0), [Some(slider_root), None])
            } else {
                root(roots.slider, moving.slider, slider_root)
            };
        }
        Configuration { heading: [crank, rod, slider], shape, crank: crank_centre, crank_pin, big_end, small_end, pin }
    }

    /// The rod's angle where all joints are ideal: r·sin θ1 + L·sin θ2 = height, differentiated twice.
    fn closing_rod<const Q: usize, const K: usize, const F: usize>(
        &self,
        crank: &Heading<Q>,
        shape: &Shape<K, F>,
        modes: std::ops::Range<usize>,
    ) -> Heading<Q> {
        let IdealMechanism { crank: r, height, .. } = self.ideal;
        let (l, rate) = (shape.chord, shape.chord_rate);
        let sin = (height - r * crank.rotation.sin) / l;
        let cos = ((1.0 - sin) * (1.0 + sin)).sqrt();
        let per_reach = 1.0 / (l * cos);
        let throw = r * crank.rotation.cos;
        let speed = -(throw * crank.speed + sin * rate) * per_reach;
        let bias = (r * crank.rotation.sin * crank.speed * crank.speed - throw * crank.bias + l * sin * speed * speed
            - 2.0 * rate * cos * speed
            - sin * shape.chord_bias)
            * per_reach;
        let mut slope = crank.slope.map(|slope| -throw * slope * per_reach);
        for (k, chord) in modes.zip(shape.chord_slope) {
            slope[k] -= sin * chord * per_reach;
        }
        Heading { rotation: Rotation { cos, sin }, angle: math::atan2(sin, cos), speed, bias, slope }
    }
}

impl<const Q: usize, const K: usize, const F: usize> Configuration<Q, K, F> {
    /// Places and velocities without their slopes.
    pub fn pose(&self) -> Pose {
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
    pub fn each(&self, of: impl Fn(&Centre<Q>) -> Vec2) -> JointCentres {
        JointCentres {
            crank: of(&self.crank),
            crank_pin: of(&self.crank_pin),
            big_end: of(&self.big_end),
            small_end: of(&self.small_end),
            pin: of(&self.pin),
        }
    }
}
