//! Mechanisms drawn by lot: combinations of effects that nobody thought of.

use crate::scenes::{Case, LONGEST};
use slidercrank::model::signals::Inputs;
use slidercrank::scene::{Contact, DampingLaw, DriveMode, Elasticity, FrictionLaw, JointModel, Point, Scene, Surface};

/// SplitMix64 (Steele, Lea, Flood 2014).
struct Lot(u64);

impl Lot {
    /// In [0, 1).
    fn share(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.share()
    }

    fn about(&mut self, greatest: f64) -> f64 {
        self.between(-greatest, greatest)
    }

    fn chance(&mut self, share: f64) -> bool {
        self.share() < share
    }

    fn one_of<T: Copy>(&mut self, items: &[T]) -> T {
        items[(self.share() * items.len() as f64) as usize]
    }

    fn point(&mut self, greatest: f64) -> Point {
        Point { x: self.about(greatest), y: self.about(greatest) }
    }

    fn model(&mut self) -> JointModel {
        self.one_of(&[JointModel::Ideal, JointModel::Clearance])
    }

    fn contact(&mut self, contact: &mut Contact) {
        contact.law = self.one_of(DampingLaw::ALL);
        contact.restitution = self.between(0.05, 1.0);
        contact.ratio_limit = self.one_of(&[1.0, 1.0, 1.0, 0.0, 0.5, 2.0]);
        contact.speed_floor = self.one_of(&[1e-3, 1e-3, 1e-2, 0.1]);
        if self.chance(0.2) {
            contact.exponent = self.between(1.0, 2.0);
            // The same force at 10 µm as Hertz's 5e10 N/m^1.5.
            contact.stiffness = 5e10 * 1e-5_f64.powf(1.5 - contact.exponent);
        }
        let friction = &mut contact.friction;
        friction.law = self.one_of(&[
            FrictionLaw::None,
            FrictionLaw::Ambrosio,
            FrictionLaw::Tanh,
            FrictionLaw::Stribeck,
            FrictionLaw::Lugre,
        ]);
        friction.coefficient = self.between(0.01, 0.2);
        friction.static_coefficient = friction.coefficient + self.between(0.0, 0.1);
        (friction.v0, friction.v1) = self.one_of(&[(1e-3, 1e-2), (0.01, 0.1), (0.1, 0.5)]);
        friction.v_stribeck = self.one_of(&[0.01, 0.1, 1.0]);
        friction.sigma0 = self.one_of(&[1e3, 1e4, 3e4]);
        friction.sigma1 = self.one_of(&[0.0, 1.0, 30.0]);
        friction.sigma2 = self.one_of(&[0.0, 1e-3]);
    }
}

/// The mechanism of this number.
pub fn drawn(number: u64) -> Case {
    let mut lot = Lot(number);
    let mut s = Scene::default();
    s.solver.tolerance = 1e-10;
    s.drive.mode = lot.one_of(&[DriveMode::Torque, DriveMode::Speed]);
    s.gravity = lot.one_of(&[0.0, 9.81, 100.0]);
    s.crank.angle_start = lot.between(0.0, std::f64::consts::TAU);
    s.crank.speed_start = lot.one_of(&[1.0, -1.0]) * lot.between(0.0, 400.0);
    s.crank.com = lot.point(0.01);
    s.rod.com = Point { x: lot.between(0.02, 0.1), y: lot.about(0.005) };
    s.slider.com = lot.point(0.008);
    s.slider.centre = lot.point(0.008);
    s.guide.offset = lot.about(0.02);
    let joint = &mut s.joint;
    for revolute in [&mut joint.a, &mut joint.b, &mut joint.c] {
        revolute.model = lot.model();
        revolute.damping = lot.one_of(&[0.0, 2e-3]);
        revolute.clearance = 2e-5 * 15_f64.powf(lot.share());
        revolute.elasticity = lot.one_of(&[Elasticity::Hertz, Elasticity::Hertz, Elasticity::Liu]);
        let direction = lot.between(0.0, std::f64::consts::TAU);
        let share = if lot.chance(0.1) { 1.03 } else { lot.between(0.0, 0.9) };
        let distance = share * revolute.clearance;
        revolute.eccentricity_start = Point { x: distance * direction.cos(), y: distance * direction.sin() };
        lot.contact(&mut revolute.contact);
    }
    let guide = &mut joint.t;
    guide.model = lot.model();
    guide.damping = lot.one_of(&[0.0, 5.0]);
    guide.clearance = 2e-5 * 15_f64.powf(lot.share());
    guide.offset_start = lot.about(0.9) * guide.clearance;
    lot.contact(&mut guide.contact);
    guide.surface = lot.one_of(&[Surface::Corner, Surface::Foundation]);
    guide.foundation_stiffness = lot.one_of(&[0.0, 1e8, 2e9]);
    guide.contact.width = lot.between(0.01, 0.1);
    s.energy.audit = lot.chance(0.5);
    if lot.chance(0.5) {
        let f = &mut s.rod.flexible;
        f.bending_modes = lot.one_of(&[0, 1, 2, 3]);
        f.axial_modes = lot.one_of(&[0, 1, 2]);
        f.young = 1e10 * 20_f64.powf(lot.share());
        f.area = lot.between(1e-4, 3e-4);
        f.second_moment = lot.between(1e-9, 5e-9);
        f.damping_ratio = lot.one_of(&[0.0, 0.01, 0.3]);
        f.geometric_stiffness = lot.chance(0.7);
    }
    let inputs = Inputs { crank_torque: lot.about(50.0), slider_load: lot.about(2000.0) };
    let rates = if lot.chance(0.7) {
        Inputs::default()
    } else {
        Inputs { crank_torque: lot.about(1e4), slider_load: lot.about(1e5) }
    };
    Case { name: format!("drawn {number}"), scene: s, inputs, rates, longest: LONGEST }
}
