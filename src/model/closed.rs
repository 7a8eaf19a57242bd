//! The closed loop: all joints ideal, one degree of freedom, no contact.

use super::contact::Account;
use super::drive::{InputSignal, RotaryDamper, Rotor, add_viscous, rotary_dampers, viscous_guide};
use super::dynamics::Loads;
use super::ideal::{IdealMechanism, IdealMotion};
use super::jacobian::differentiate;
use super::joint::guide::CORNERS;
use super::kinematics::{JointCentres, Turning};
use super::mechanism::{Bodies, CRANK, ROD, SLIDER, bodies};
use super::plane::{Rotation, Vec2, perp};
use super::plant::{Plant, ROOM};
use super::scalar::Tangent;
use super::scales::Scale;
use super::stages::in_registers;
use super::start::StartPose;
use super::state::{Contacts, Instant, Pose};
use crate::integrator::{
    EventFunctions, Events, Extent, Jacobian, Linearizable, Ode, SeveralInstants, Tableau, Unilateral,
};
use crate::math::{self, Real, Row};
use crate::scene::Scene;

/// The ideal mechanism with its constants and its inputs.
#[derive(Clone, Debug)]
pub struct Closed<const SPEED: bool, const N: usize> {
    bodies: Bodies,
    gravity: f64,
    ideal: IdealMechanism,
    rotor: Rotor,
    rotary_dampers: Vec<RotaryDamper>,
    guide_damping: Option<f64>,
    signal: InputSignal,
    scales: [f64; N],
    longest_step: f64,
}

impl<const SPEED: bool, const N: usize> Closed<SPEED, N> {
    /// Number of positions.
    const P: usize = if SPEED { 0 } else { 1 };

    /// Assembles the mechanism of a scene that starts at `time` [s].
    pub fn assemble(scene: &Scene, time: f64) -> Self {
        const { assert!(N == 2 * Self::P || N >= ROOM) };
        let scale = Scale::of(scene);
        let mut scales = [0.0; N];
        for (weight, of) in scales.iter_mut().zip([scale.length, scale.length * scale.frequency]) {
            *weight = of;
        }
        Self {
            bodies: bodies(scene),
            gravity: scene.gravity,
            ideal: IdealMechanism::new(scene),
            rotor: Rotor::new(scene, time),
            rotary_dampers: rotary_dampers(scene),
            guide_damping: Some(scene.joint.t.damping).filter(|&damping| damping != 0.0),
            signal: InputSignal::default(),
            scales,
            longest_step: scale.longest_step,
        }
    }

    #[inline(always)]
    fn crank<R: Real>(&self, t: R, y: &[R]) -> (R, R) {
        if SPEED { (self.rotor.at(t), R::constant(self.rotor.speed)) } else { (y[0], y[Self::P]) }
    }

    #[inline(always)]
    fn loads<R: Real>(&self, t: R, speed: &[R; 3], pin_speed: R) -> Loads<R> {
        let inputs = self.signal.at(t);
        let slider_load = inputs.slider_load;
        let mut loads = Loads { pin: Vec2::new(slider_load, R::ZERO), slider_load, ..Loads::default() };
        if !SPEED {
            loads.crank_couple = inputs.crank_torque;
        }
        add_viscous(&self.rotary_dampers, speed, &[speed[ROD]; 2], &mut loads);
        if let Some(damping) = self.guide_damping {
            loads.add_guide(&viscous_guide(damping, pin_speed));
        }
        loads
    }

    /// [rad/s²] Crank acceleration: the principle of virtual power with K_i = ∂ṙ_i/∂θ̇.
    #[inline(always)]
    fn acceleration<R: Real>(&self, crank: Rotation<R>, speed: R, motion: &IdealMotion<R>, loads: &Loads<R>) -> R {
        let [first, second, third] = &self.bodies;
        let ratio = motion.rod_ratio;
        let rod_speed = ratio * speed;
        let crank_arm = crank.axis(first.length);
        let crank_com = perp(crank.apply(first.com));
        let rod_com = motion.rod.apply(second.com);
        let rod_jacobian = perp(crank_arm) + ratio * perp(rod_com);
        let rod_bias = -speed * speed * crank_arm + motion.rod_bias * perp(rod_com) - rod_speed * rod_speed * rod_com;
        let inertia = crank_com.norm_squared() * first.mass
            + first.inertia
            + ratio * second.inertia * ratio
            + rod_jacobian.norm_squared() * second.mass
            + motion.x_ratio * third.mass * motion.x_ratio;
        let couples = loads.couples();
        let power = couples[CRANK] + couples[ROD] * ratio + loads.pin.x * motion.x_ratio
            - (crank_com.y * first.mass + rod_jacobian.y * second.mass) * self.gravity
            - ratio * second.inertia * motion.rod_bias
            - rod_jacobian.dot(rod_bias) * second.mass
            - motion.x_ratio * third.mass * motion.x_bias;
        power / inertia
    }

    #[inline(always)]
    fn write_rates<R: Real>(&self, t: R, y: &[R], rates: &mut [R]) {
        if SPEED {
            return;
        }
        let (angle, speed) = self.crank(t, y);
        let crank = Rotation::new(angle);
        let motion = self.ideal.motion(crank, speed);
        let speeds = [speed, motion.rod_ratio * speed, R::ZERO];
        let loads = self.loads(t, &speeds, motion.x_ratio * speed);
        rates[0] = speed;
        rates[Self::P] = self.acceleration(crank, speed, &motion, &loads);
    }

    fn everything<R: Real>(&self, t: R, y: &[R]) -> Instant<R> {
        let (angle, speed) = self.crank(t, y);
        let crank = Rotation::new(angle);
        let motion = self.ideal.motion(crank, speed);
        let rod_speed = motion.rod_ratio * speed;
        let speeds = [speed, rod_speed, R::ZERO];
        let loads = self.loads(t, &speeds, motion.x_ratio * speed);
        let acceleration = if SPEED { R::ZERO } else { self.acceleration(crank, speed, &motion, &loads) };
        let rod_acceleration = motion.rod_ratio * acceleration + motion.rod_bias;
        let crank_arm = crank.axis(self.bodies[CRANK].length);
        let at = |crank_pin: Vec2<R>, pin: Vec2<R>| JointCentres {
            crank: Vec2::ZERO,
            crank_pin,
            big_end: crank_pin,
            small_end: pin,
            pin,
        };
        let along = |x: R| Vec2::new(x, R::ZERO);
        let turning = Turning {
            angle: [angle, math::atan2(motion.rod.sin, motion.rod.cos), R::ZERO],
            speed: speeds,
            rotation: [crank, motion.rod, Rotation::NONE],
        };
        let pose = Pose {
            turning,
            section_speed: [rod_speed; 2],
            place: at(crank_arm, Vec2::new(motion.x, R::constant(self.ideal.height))),
            velocity: at(speed * perp(crank_arm), along(motion.x_ratio * speed)),
        };
        let mut angle_acceleration = [R::ZERO; 3];
        angle_acceleration[CRANK] = acceleration;
        angle_acceleration[ROD] = rod_acceleration;
        angle_acceleration[SLIDER] = R::ZERO;
        Instant {
            pose,
            acceleration: at(
                acceleration * perp(crank_arm) - speed * speed * crank_arm,
                along(motion.x_ratio * acceleration + motion.x_bias),
            ),
            angle_acceleration,
            loads,
            flexible: None,
        }
    }
}

impl<const SPEED: bool, const N: usize> Ode for Closed<SPEED, N> {
    type Discrete = Contacts;

    fn extent(&self) -> Extent {
        Extent::second_order(2 * Self::P)
    }

    #[inline(always)] // into the loop over stages
    fn rates(&self, _: &Contacts, t: f64, y: &[f64], rates: &mut [f64]) {
        self.write_rates(t, y, rates);
    }

    fn stages(&self, tableau: &Tableau, contacts: &Contacts, t: f64, y: &[f64], h: f64, k: &mut [f64]) -> bool {
        in_registers::<N>(tableau, t, y, h, k, |t, y, rates| self.rates(contacts, t, y, rates))
    }

    fn scales(&self) -> &[f64] {
        &self.scales
    }

    fn longest_step(&self) -> f64 {
        self.longest_step
    }
}

impl<const SPEED: bool, const N: usize> SeveralInstants for Closed<SPEED, N> {
    fn rates_in_row(&self, _: &Contacts, t: &Row, y: &[Row], rates: &mut [Row]) {
        self.write_rates(*t, y, rates);
    }
}

impl<const SPEED: bool, const N: usize> Linearizable for Closed<SPEED, N> {
    fn jacobian(&self, contacts: &Contacts, t: f64, y: &[f64], jacobian: &mut Jacobian) {
        let states = 2 * Self::P;
        differentiate::<N>(states, states, t, y, jacobian, &|t, y, rates| self.tangent_rates(contacts, t, y, rates));
    }
}

impl<const SPEED: bool, const N: usize> Events for Closed<SPEED, N> {
    fn event_count(&self) -> usize {
        usize::from(self.ideal.has_change_point())
    }

    fn event_functions(&self, _: &Contacts, t: f64, y: &[f64], functions: &mut EventFunctions) {
        if self.ideal.has_change_point() {
            let (angle, speed) = self.crank(t, y);
            functions[0] = self.ideal.change_point(Rotation::new(angle), speed, self.ideal.rod, 0.0);
        }
    }

    fn is_dead_end(&self, _: usize) -> bool {
        true
    }

    fn event_scale(&self) -> f64 {
        IdealMechanism::CHANGE_POINT_SCALE
    }
}

impl<const SPEED: bool, const N: usize> Unilateral for Closed<SPEED, N> {}

impl<const SPEED: bool, const N: usize> Plant for Closed<SPEED, N> {
    fn write_start(&self, pose: &StartPose, y: &mut [f64]) {
        for (state, start) in y.iter_mut().take(2 * Self::P).zip([pose.angle[CRANK], pose.speed[CRANK]]) {
            *state = start;
        }
    }

    fn start_contacts(&self, _: f64, _: &[f64]) -> Contacts {
        Contacts::default()
    }

    fn set_signal(&mut self, signal: InputSignal) {
        self.signal = signal;
    }

    fn signal(&self) -> &InputSignal {
        &self.signal
    }

    fn start_time(&self) -> f64 {
        self.rotor.start_time
    }

    fn set_start_time(&mut self, time: f64) {
        self.rotor.start_time = time;
    }

    fn instant(&self, _: &Contacts, t: f64, y: &[f64]) -> Instant {
        self.everything(t, y)
    }

    fn penetration(&self, _: &Pose) -> [f64; 3 + CORNERS] {
        [f64::NEG_INFINITY; 3 + CORNERS]
    }

    fn tangent_rates(&self, _: &Contacts, t: Tangent, y: &[Tangent], rates: &mut [Tangent]) {
        self.write_rates(t, y, rates);
    }

    fn tangent_instant(&self, _: &Contacts, t: Tangent, y: &[Tangent]) -> (Instant<Tangent>, Account<Tangent>) {
        (self.everything(t, y), Account::default())
    }
}
