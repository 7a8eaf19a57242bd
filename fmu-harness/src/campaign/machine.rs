//! Draws random machines: presses, pumps and engines of plausible sizes, speeds, clearances and loads.
//!
//! Every quantity is drawn from the range of such machines: a crank radius from millimetres to a decimetre, bodies
//! whose masses are proportional to its cube, a mean slider speed up to 12 m/s, clearances from micrometres to half a
//! millimetre, a load of the size of the inertia forces or far above them, a flywheel that keeps the crank turning
//! under the load, and a torque that supplies the load's work. The random number 0 gives the simplest value of each
//! quantity, so that shrinking a scene makes it simpler.

use super::draw::logarithmic;
use proptest::prelude::Strategy;
use slidercrank::scene::profile::{Profile, ProfileArgument, Profiles};
use slidercrank::scene::read::SceneFile;
use slidercrank::scene::run::{End, Run};
use slidercrank::scene::{
    Contact, DampingLaw, DriveMode, Elasticity, FrictionLaw, JointModel, Method, Pair, Point, Revolute, Scene, Surface,
};
use std::f64::consts::{PI, TAU};

/// Maximum number of random numbers for one machine.
const LOTS: usize = 120;
/// Number of points of a turn for the integral of the load's work.
const WORK_POINTS: u32 = 360;
/// Share of the machines that keep the default method; the others draw one with error control.
const DEFAULT_METHOD: f64 = 0.7;
/// Share of the machines with clearance in only one of the pins and the main bearing.
const ONE_PLAY: f64 = 0.5;
/// [kg/m³] Steel.
const DENSITY: f64 = 7850.0;

/// Strategy for scene files of machines with runs of `turns` turns.
pub fn scene_files(turns: f64) -> impl Strategy<Value = SceneFile> {
    vec![0.0..1.0; LOTS].prop_map(move |lots| Lots { lots: lots.into_iter() }.machine(turns))
}

/// Random numbers from 0 to 1. Each is used once.
struct Lots {
    lots: std::vec::IntoIter<f64>,
}

impl Lots {
    fn next(&mut self) -> f64 {
        self.lots.next().unwrap_or_default()
    }

    /// Uniform in a range.
    fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.next()
    }

    /// Logarithmically uniform in a range.
    fn about(&mut self, low: f64, high: f64) -> f64 {
        logarithmic(low, high, self.next())
    }

    /// True with this probability.
    fn chance(&mut self, probability: f64) -> bool {
        self.next() > 1.0 - probability
    }

    fn one_of<T: Copy>(&mut self, all: &[T]) -> T {
        all[((self.next() * all.len() as f64) as usize).min(all.len() - 1)]
    }

    fn machine(&mut self, turns: f64) -> SceneFile {
        let mut scene = Scene::default();
        self.bodies(&mut scene);
        self.joints(&mut scene);
        self.rod(&mut scene);
        let slider_load = self.load(&scene);
        let crank_torque = self.drive(&mut scene, &slider_load);
        let solver = &mut scene.solver;
        if !self.chance(DEFAULT_METHOD) {
            let adaptive: Vec<Method> =
                Method::ALL.iter().copied().filter(|method| !method.has("fixed step")).collect();
            solver.method = self.one_of(&adaptive);
        }
        solver.tolerance = self.about(1e-3, 1e-9);
        scene.energy.audit = self.chance(0.1);
        let run = Run { end: End::Turns(turns), step: TAU / scene.crank.speed_start.abs() / self.about(36.0, 720.0) };
        let inputs = Profiles { crank_torque: Profile::Constant(crank_torque), slider_load };
        SceneFile { name: "drawn".into(), description: String::new(), scene, run, inputs }
    }

    /// Lengths, masses and speed.
    fn bodies(&mut self, scene: &mut Scene) {
        let r = self.about(5e-3, 0.15);
        let length = r * self.within(2.5, 8.0);
        let mass = DENSITY * (r * self.about(0.5, 3.0)).powi(3);
        let slider = &mut scene.slider;
        slider.mass = mass;
        slider.length = r * self.about(0.6, 4.0);
        slider.height = slider.length * self.within(0.3, 1.0);
        slider.inertia = mass * (slider.length.powi(2) + slider.height.powi(2)) / 12.0;
        slider.centre = Point { x: slider.length * self.within(0.0, 0.3), y: 0.0 };
        slider.com = slider.centre;
        let rod = &mut scene.rod;
        rod.length = length;
        rod.mass = mass * self.within(0.15, 0.8);
        rod.inertia = rod.mass * length * length / 12.0 * self.within(0.8, 1.3);
        rod.com = Point { x: length * self.within(0.3, 0.6), y: 0.0 };
        let crank = &mut scene.crank;
        crank.length = r;
        crank.mass = mass * self.within(0.5, 3.0);
        crank.inertia = crank.mass * r * r * self.within(0.3, 2.0);
        crank.com = Point { x: r * self.within(0.0, 0.6), y: 0.0 };
        // A mean slider speed of 2·r·ω/π.
        let speed = self.about(0.05, 12.0) * PI / (2.0 * r);
        crank.speed_start = if self.chance(0.1) { -speed } else { speed };
        crank.angle_start = self.within(0.0, TAU);
        if self.chance(0.3) {
            scene.guide.offset = r * self.within(-0.2, 0.2);
        }
        if self.chance(0.5) {
            scene.gravity = 9.81;
        }
    }

    fn joints(&mut self, scene: &mut Scene) {
        let r = scene.crank.length;
        let choice = if self.chance(ONE_PLAY) {
            1 << self.one_of(&[2, 1, 0])
        } else {
            self.one_of(&[8, 15, 14, 13, 12, 11, 10, 9, 7, 6, 5, 3, 0])
        };
        let model = |joint: usize| if choice >> joint & 1 == 1 { JointModel::Clearance } else { JointModel::Ideal };
        let joints = &mut scene.joint;
        for (number, joint) in [&mut joints.a, &mut joints.b, &mut joints.c].into_iter().enumerate() {
            joint.model = model(number);
            self.pin(joint, r);
        }
        let guide = &mut joints.t;
        guide.model = model(3);
        guide.clearance = self.about(5e-6, 3e-4);
        guide.corner_radius = self.about(5e-4, 2e-2);
        guide.surface = if self.chance(0.3) { Surface::Foundation } else { Surface::Corner };
        if self.chance(0.2) {
            guide.damping = self.about(0.1, 100.0);
        }
        self.contact(&mut guide.contact, r);
    }

    fn pin(&mut self, joint: &mut Revolute, r: f64) {
        joint.radius = (r * self.within(0.15, 0.7)).max(2e-3);
        joint.clearance = self.about(5e-6, 5e-4).min(0.02 * joint.radius);
        joint.elasticity = if self.chance(0.25) { Elasticity::Liu } else { Elasticity::Hertz };
        if self.chance(0.2) {
            joint.damping = self.about(1e-4, 1.0);
        }
        self.contact(&mut joint.contact, r);
    }

    fn contact(&mut self, contact: &mut Contact, r: f64) {
        let modulus = |lot: f64| logarithmic(70e9, 210e9, 1.0 - lot);
        contact.young = Pair { bearing: modulus(self.next()), journal: modulus(self.next()) };
        contact.width = r * self.within(0.3, 1.5);
        contact.law = if self.chance(0.5) { self.one_of(DampingLaw::ALL) } else { DampingLaw::default() };
        contact.restitution = self.within(0.95, 0.3);
        let laws = [
            FrictionLaw::None,
            FrictionLaw::Ambrosio,
            FrictionLaw::Ambrosio,
            FrictionLaw::Tanh,
            FrictionLaw::Stribeck,
            FrictionLaw::Lugre,
        ];
        let friction = &mut contact.friction;
        friction.law = self.one_of(&laws);
        friction.coefficient = self.about(0.005, 0.2);
        friction.static_coefficient = friction.coefficient * self.within(1.0, 2.0);
    }

    /// One machine in five has a rod that bends.
    fn rod(&mut self, scene: &mut Scene) {
        let (bends, bending, axial) = (self.chance(0.2), self.within(1.0, 5.0), self.within(0.0, 3.0));
        let (slenderness, damping) = (self.about(12.0, 40.0), self.about(0.003, 0.03));
        if !bends {
            return;
        }
        let height = scene.rod.length / slenderness;
        let flexible = &mut scene.rod.flexible;
        (flexible.bending_modes, flexible.axial_modes) = (bending as i32, axial as i32);
        (flexible.area, flexible.second_moment) = (height * height, height.powi(4) / 12.0);
        flexible.damping_ratio = damping;
    }

    /// [N] Load on the slider: none, constant, a blow near bottom dead centre with the snap-through after it, a pump's
    /// load, or a load that oscillates over time.
    fn load(&mut self, scene: &Scene) -> Profile {
        let crank = &scene.crank;
        let inertia = scene.slider.mass * crank.length * crank.speed_start.powi(2);
        let size = inertia.max(scene.slider.mass * 9.81) * self.about(0.1, 10.0);
        let kind = self.next();
        let at = |degrees: f64, share: f64| [degrees.to_radians(), share * size];
        let over_turn = |points: Vec<[f64; 2]>| Profile::Points { against: ProfileArgument::CrankAngle, points };
        let forwards = crank.speed_start > 0.0;
        match (kind * 5.0) as usize {
            0 => Profile::Constant(0.0),
            1 => Profile::Constant(self.within(1.0, -1.0) * size),
            2 => {
                let (touch, end) = (self.within(300.0, 345.0), self.within(350.0, 358.0));
                let snap = self.within(0.0, 0.4);
                let blow =
                    [[touch, 0.0], [0.5 * (touch + end), -1.0], [end, -0.9], [end + 0.5, snap], [end + 1.9, 0.0]];
                let mirrored = |[degrees, share]: [f64; 2]| at(if forwards { degrees } else { 360.0 - degrees }, share);
                let mut points: Vec<[f64; 2]> = blow.into_iter().map(mirrored).collect();
                points.sort_by(|one, other| one[0].total_cmp(&other[0]));
                over_turn(points)
            }
            3 => {
                let rise = self.within(2.0, 30.0);
                let (out, back) = if forwards { (-1.0, 0.1) } else { (0.1, -1.0) };
                over_turn(vec![at(0.0, out), at(rise, back), at(180.0, back), at(180.0 + rise, out)])
            }
            _ => {
                let period = TAU / crank.speed_start.abs() * self.about(0.3, 7.0);
                let span = period * 400.0;
                let step = period / 8.0;
                let points = (0..(span / step) as u32).map(|i| {
                    let time = f64::from(i) * step;
                    [time, size * (TAU * time / period).sin()]
                });
                Profile::Points { against: ProfileArgument::Time, points: points.take(64).collect() }
            }
        }
    }

    /// [N·m] Torque of a torque drive that supplies the load's mean work. Adds a flywheel to the crank.
    fn drive(&mut self, scene: &mut Scene, load: &Profile) -> f64 {
        let (prescribed, wheel, share) = (self.chance(0.5), self.about(5.0, 100.0), self.within(1.0, 1.2));
        if prescribed {
            scene.drive.mode = DriveMode::Speed;
            return 0.0;
        }
        scene.drive.mode = DriveMode::Torque;
        let (crank, rod) = (&mut scene.crank, &scene.rod);
        let r = crank.length;
        // ẋ/ω of the ideal mechanism.
        let transfer = |angle: f64| {
            let height = r * angle.sin() - scene.guide.offset;
            let along = (rod.length.powi(2) - height * height).max(0.0).sqrt();
            -r * angle.sin() - height * r * angle.cos() / along
        };
        let work = |i: u32| {
            let angle = TAU * (f64::from(i) + 0.5) / f64::from(WORK_POINTS);
            load.value(0.0, angle) * transfer(angle) * TAU / f64::from(WORK_POINTS)
        };
        let over_turn = !matches!(load, Profile::Points { against: ProfileArgument::Time, .. });
        let done: f64 = if over_turn { (0..WORK_POINTS).map(work).sum() } else { 0.0 };
        // The flywheel stores many times the slider's energy and the energy that the load exchanges in a turn.
        let swing = 4.0 * r * greatest(load) / crank.speed_start.powi(2);
        crank.inertia += wheel * (scene.slider.mass * r * r).max(swing);
        -done / TAU * share
    }
}

/// [N] Largest absolute value of the load.
fn greatest(load: &Profile) -> f64 {
    match load {
        Profile::Constant(value) => value.abs(),
        Profile::Points { points, .. } => points.iter().map(|[_, value]| value.abs()).fold(0.0, f64::max),
    }
}
