//! Places and velocities of the three bodies, as outputs and their rates tell them.

use nalgebra::Vector2;
use slidercrank::model::signals::Outputs;
use slidercrank::scene::Scene;
use slidercrank::simulation::Simulation;

pub type Vec2 = Vector2<f64>;

/// (−v_y, v_x).
pub fn perp(v: Vec2) -> Vec2 {
    Vec2::new(-v.y, v.x)
}

/// a_x·b_y − a_y·b_x.
pub fn cross(a: Vec2, b: Vec2) -> f64 {
    a.x * b.y - a.y * b.x
}

fn turned(angle: f64, x: f64, y: f64) -> Vec2 {
    let (sin, cos) = angle.sin_cos();
    Vec2::new(cos * x - sin * y, sin * x + cos * y)
}

/// A rigid body in motion.
#[derive(Clone, Copy)]
pub struct Body {
    pub mass: f64,
    pub inertia: f64,
    /// Of the centre of mass.
    pub place: Vec2,
    pub velocity: Vec2,
    pub speed: f64,
}

/// The mechanism at one instant.
pub struct Motion {
    pub bodies: [Body; 3],
    /// ė of the joints A, B, C.
    pub eccentricity_rate: [Vec2; 3],
    /// (δ, x and y velocity) of the four corners: upper front, upper rear, lower front, lower rear.
    pub corners: [(f64, Vec2); 4],
    pub outputs: Outputs,
}

/// Reads the instant at the communication point. Rates of eccentricities and of the slider's height and
/// tilt come from `output_rates`, which knows them without differences.
pub fn motion(scene: &Scene, simulation: &mut Simulation) -> Motion {
    let o = simulation.outputs();
    let d = simulation.output_rates();
    let Scene { crank, rod, slider, guide, joint, .. } = scene;
    let vec = |a: [f64; 2]| Vec2::new(a[0], a[1]);
    let [rate_a, rate_b, rate_c] = [d.joint_a.eccentricity, d.joint_b.eccentricity, d.joint_c.eccentricity].map(vec);
    let crank_arm = turned(o.crank.angle, crank.length, 0.0);
    let main = vec(o.joint_a.eccentricity);
    let big_end = main + crank_arm - vec(o.joint_b.eccentricity);
    let big_end_velocity = rate_a + o.crank.speed * perp(crank_arm) - rate_b;
    let com1 = turned(o.crank.angle, crank.com.x, crank.com.y);
    let com2 = turned(o.rod.angle, rod.com.x, rod.com.y);
    let com3 = turned(o.slider.angle, slider.com.x, slider.com.y);
    let pin = Vec2::new(o.slider.x, o.slider.y);
    let pin_velocity = Vec2::new(o.slider.v, d.slider.y);
    let tilt_rate = d.slider.angle;
    let reach = 0.5 * slider.height + joint.t.clearance;
    let corner = |front: f64, side: f64| {
        let (x, y) = (slider.centre.x + 0.5 * front * slider.length, slider.centre.y + 0.5 * side * slider.height);
        let arm = turned(o.slider.angle, x, y);
        let depth = side * (pin.y + arm.y - guide.offset) - reach;
        (depth, pin_velocity + tilt_rate * perp(arm))
    };
    Motion {
        bodies: [
            Body {
                mass: crank.mass,
                inertia: crank.inertia,
                place: main + com1,
                velocity: rate_a + o.crank.speed * perp(com1),
                speed: o.crank.speed,
            },
            Body {
                mass: rod.mass,
                inertia: rod.inertia,
                place: big_end + com2,
                velocity: big_end_velocity + o.rod.speed * perp(com2),
                speed: o.rod.speed,
            },
            Body {
                mass: slider.mass,
                inertia: slider.inertia,
                place: pin + com3,
                velocity: pin_velocity + tilt_rate * perp(com3),
                speed: tilt_rate,
            },
        ],
        eccentricity_rate: [rate_a, rate_b, rate_c],
        corners: [corner(1.0, 1.0), corner(-1.0, 1.0), corner(1.0, -1.0), corner(-1.0, -1.0)],
        outputs: o,
    }
}

impl Motion {
    /// [J] Kinetic energy.
    pub fn kinetic(&self) -> f64 {
        let energy = |b: &Body| 0.5 * (b.mass * b.velocity.norm_squared() + b.inertia * b.speed * b.speed);
        self.bodies.iter().map(energy).sum()
    }

    /// [J] Weight times height.
    pub fn weight(&self, gravity: f64) -> f64 {
        self.bodies.iter().map(|b| b.mass * gravity * b.place.y).sum()
    }

    /// [J] Elastic energy of contacts K·δ^1.5 with these stiffnesses of A, B, C, T.
    pub fn elastic(&self, stiffness: [f64; 4]) -> f64 {
        let o = &self.outputs;
        let energy = |k: f64, depth: f64| 0.4 * k * depth.max(0.0).powf(2.5);
        let revolute = [o.joint_a.penetration, o.joint_b.penetration, o.joint_c.penetration];
        let revolute: f64 = revolute.into_iter().zip(stiffness).map(|(depth, k)| energy(k, depth)).sum();
        let guide: f64 = self.corners.iter().map(|corner| energy(stiffness[3], corner.0)).sum();
        revolute + guide
    }

    /// [kg·m/s] Linear momentum.
    pub fn momentum(&self) -> Vec2 {
        self.bodies.iter().map(|b| b.mass * b.velocity).sum()
    }

    /// [kg·m²/s] Angular momentum about the origin.
    pub fn angular_momentum(&self) -> f64 {
        self.bodies.iter().map(|b| b.mass * cross(b.place, b.velocity) + b.inertia * b.speed).sum()
    }
}
