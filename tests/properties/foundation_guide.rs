//! The guide with faces: continuous in the pose, conservative without damping, dissipative with it.

use super::chance::Chance;
use slidercrank::model::contact::ContactState;
use slidercrank::model::joint::guide::{GUIDE_CONTACTS, Guide, Load};
use slidercrank::model::joint::rectangle::SliderPose;
use slidercrank::model::plane::{Rotation, Vec2};
use slidercrank::scene::{DampingLaw, FrictionLaw, JointModel, Scene, Surface};

/// [m]
const LENGTH: f64 = 0.04;
/// [m]
const HEIGHT: f64 = 0.02;
/// [m]
const CLEARANCE: f64 = 1e-4;
/// [N/m²]
const BED: f64 = 2e9;
/// [N/m]
const STIFFNESS: f64 = BED * LENGTH;

fn scene(law: DampingLaw, friction: FrictionLaw) -> Scene {
    let mut scene = Scene::default();
    (scene.slider.length, scene.slider.height) = (LENGTH, HEIGHT);
    (scene.slider.centre.x, scene.slider.centre.y, scene.guide.offset) = (0.003, 0.002, 0.002);
    let guide = &mut scene.joint.t;
    (guide.model, guide.surface) = (JointModel::Clearance, Surface::Foundation);
    (guide.clearance, guide.foundation_stiffness) = (CLEARANCE, BED);
    (guide.contact.law, guide.contact.restitution) = (law, 0.5);
    (guide.contact.friction.law, guide.contact.friction.coefficient) = (friction, 0.3);
    scene
}

/// Bristles that are not there.
const NO_BRISTLES: [f64; GUIDE_CONTACTS] = [0.0; GUIDE_CONTACTS];

fn load(guide: &Guide, states: &[ContactState], pose: &SliderPose) -> Load {
    guide.load(states, pose, &NO_BRISTLES, &mut [0.0; GUIDE_CONTACTS])
}

fn pose(y: f64, tilt: f64) -> SliderPose {
    SliderPose { pin: Vec2::new(0.1, y), rotation: Rotation::new(tilt), ..SliderPose::default() }
}

fn closed(approach: f64) -> [ContactState; 4] {
    let closed = ContactState::closing(approach, 1e-3);
    [closed, closed, ContactState::default(), ContactState::default()]
}

type Path = Box<dyn Fn(f64) -> (f64, f64)>;

/// Paths of height and tilt that begin and end without contact, and the corners met on the way.
fn paths() -> Vec<(&'static str, &'static str, Path)> {
    let turn = std::f64::consts::TAU;
    let peak = move |s: f64| 0.5 * (1.0 - (turn * s).cos());
    vec![
        // Open, a corner, the face, the other corner, open: upper and lower.
        ("upper", " R FR F ", Box::new(move |s| (1.15 * CLEARANCE * peak(s), 1e-3 * (2.0 * turn * s).sin()))),
        ("lower", " r fr f ", Box::new(move |s| (-1.15 * CLEARANCE * peak(s), -1e-3 * (2.0 * turn * s).sin()))),
        // Opposite corners, turned one way and the other.
        ("jammed", " F Fr F  f Rf f ", Box::new(move |s| (0.0, 8e-3 * (turn * s).sin()))),
        // From one face through the jam to the other.
        ("across", " F Fr r ", Box::new(move |s| (1.05 * CLEARANCE * (turn * s).sin(), 6e-3 * peak(s)))),
        // Parallel faces.
        ("flat", " FR ", Box::new(move |s| (1.15 * CLEARANCE * peak(s), 0.0))),
    ]
}

/// Largest change of force and of moment in a step of a path.
fn jumps(load: impl Fn(&SliderPose) -> Load, path: &dyn Fn(f64) -> (f64, f64), steps: usize) -> (f64, f64) {
    let at = |i: usize| {
        let (y, tilt) = path(i as f64 / steps as f64);
        load(&pose(y, tilt))
    };
    let mut worst = (0.0f64, 0.0f64);
    for i in 0..steps {
        let (before, after) = (at(i), at(i + 1));
        worst.0 = worst.0.max((after.force - before.force).norm());
        worst.1 = worst.1.max((after.couple - before.couple).abs());
    }
    worst
}

/// Corners in contact along a path, one after another: F and R of the upper face, f and r of the lower.
fn met(guide: &Guide, path: &dyn Fn(f64) -> (f64, f64), steps: usize) -> String {
    let mut met: Vec<String> = vec![];
    for i in 0..=steps {
        let (y, tilt) = path(i as f64 / steps as f64);
        let depths = guide.penetrations(&pose(y, tilt));
        let touching = depths.into_iter().zip("FRfr".chars()).filter(|(depth, _)| *depth > 0.0);
        met.push(touching.map(|(_, letter)| letter).collect());
    }
    met.dedup();
    met.join(" ")
}

/// The largest that a point of the slider moves across the guide in a step of a path.
fn stride(path: &dyn Fn(f64) -> (f64, f64), steps: usize) -> f64 {
    let reach = (0.5 * LENGTH + 0.003).hypot(0.5 * HEIGHT + 0.002);
    let at = |i: usize| path(i as f64 / steps as f64);
    let moved = (0..steps).map(|i| (at(i + 1).0 - at(i).0).abs() + reach * (at(i + 1).1 - at(i).1).abs());
    moved.fold(0.0, f64::max)
}

#[test]
fn force_and_moment_are_continuous_from_open_through_corner_and_face_and_jam() {
    const STEPS: usize = 20_000;
    let guide = Guide::new(&scene(DampingLaw::Hertz, FrictionLaw::None));
    for (name, way, path) in paths() {
        assert_eq!(met(&guide, path.as_ref(), STEPS), way, "{name}");
        let (force, moment) = jumps(|pose| load(&guide, &closed(1.0), pose), path.as_ref(), STEPS);
        // max(0, δ) changes by at most what δ does, at most on both faces; a moment has an arm below
        // a + 3 mm, which turns with the slider by less than a stride.
        let stride = stride(path.as_ref(), STEPS);
        let bound = 2.0 * STIFFNESS * stride;
        let deepest = 2e-4;
        assert!(force > 0.0 && force <= bound, "{name}: force jumps by {force} N, bound {bound} N");
        let bound = bound * (0.5 * LENGTH + 0.003 + deepest);
        assert!(moment <= bound, "{name}: moment jumps by {moment} N·m, bound {bound} N·m");
    }
}

#[test]
fn damping_and_friction_are_continuous_too() {
    const STEPS: usize = 20_000;
    let guide = Guide::new(&scene(DampingLaw::LankaraniNikravesh, FrictionLaw::Tanh));
    let (velocity, spin) = (Vec2::new(-0.004, 0.02), 3.0);
    let moving = |pose: &SliderPose| SliderPose { pin_velocity: velocity, speed: spin, ..*pose };
    for (name, _, path) in paths() {
        let (force, moment) = jumps(|pose| load(&guide, &closed(0.1), &moving(pose)), path.as_ref(), STEPS);
        // Damping's factor is below 1 + χ = 1.57 (s ≤ 1) and friction's ratio below 0.3. Where the centre
        // of pressure moves by x, the mean depth times x stays below a stride times a, twice: that times
        // ω·χ/δ̇⁻ is what damping adds. Friction adds 0.3·ω/v1 times the height of the centre, 2 %.
        let stride = stride(path.as_ref(), STEPS);
        let factor = 1.57 + 2.0 * (0.5 * LENGTH) * spin * 0.57 / 0.1;
        let bound = 2.0 * STIFFNESS * stride * factor * 1.3 * 1.02;
        assert!(force > 0.0 && force <= bound, "{name}: force jumps by {force} N, bound {bound} N");
        let bound = bound * 2.0 * (0.5 * LENGTH + 0.003 + 0.5 * HEIGHT);
        assert!(moment <= bound, "{name}: moment jumps by {moment} N·m, bound {bound} N·m");
    }
}

#[test]
fn a_law_that_switches_from_corner_to_plane_jumps() {
    const STEPS: usize = 20_000;
    let scene = scene(DampingLaw::Hertz, FrictionLaw::None);
    let faces = Guide::new(&scene);
    let corners = Guide::new(&Scene {
        joint: {
            let mut joint = scene.joint.clone();
            joint.t.surface = Surface::Corner;
            joint
        },
        ..scene
    });
    let point = ContactState::closing(1.0, 1e-3);
    let switching = |pose: &SliderPose| {
        let [front, rear, ..] = corners.penetrations(pose);
        let mut load = Load::default();
        if front > 0.0 && rear > 0.0 {
            load.force.y = -STIFFNESS * 0.5 * (front + rear);
        } else {
            let mode = |depth: f64| if depth > 0.0 { point } else { ContactState::default() };
            load = self::load(&corners, &[front, rear].map(mode), pose);
        }
        load
    };
    let (name, _, path) = paths().swap_remove(0);
    let bound = 2.0 * STIFFNESS * stride(path.as_ref(), STEPS);
    let (plain, _) = jumps(switching, path.as_ref(), STEPS);
    let (ours, _) = jumps(|pose| load(&faces, &closed(1.0), pose), path.as_ref(), STEPS);
    println!("{name}: {plain:.1} N against {ours:.1} N a step");
    assert!(plain > 20.0 * bound && ours <= bound, "{plain} N, {ours} N, bound {bound} N");
}

#[test]
fn force_times_velocity_is_what_the_springs_take_up_and_damping_takes_more() {
    let guides = [(DampingLaw::Hertz, 0.0), (DampingLaw::LankaraniNikravesh, 0.5625), (DampingLaw::Flores, 1.6)]
        .map(|(law, chi)| [FrictionLaw::None, FrictionLaw::Ambrosio].map(|f| (Guide::new(&scene(law, f)), chi, f)));
    let mut chance = Chance(17);
    let (mut damped, mut clipped) = (0, 0);
    for (guide, chi, friction) in guides.into_iter().flatten().cycle().take(60_000) {
        let (y, tilt) = (chance.between(-1.5e-4, 1.5e-4), chance.between(-8e-3, 8e-3));
        let (velocity, spin) =
            (Vec2::new(chance.between(-1.0, 1.0), chance.between(-0.2, 0.2)), chance.between(-9.0, 9.0));
        let now = SliderPose { pin_velocity: velocity, speed: spin, ..pose(y, tilt) };
        let states = closed(0.1);
        let energy =
            |t: f64| guide.contact_energy(&states, &pose(y + velocity.y * t, tilt + spin * t), &NO_BRISTLES).energy;
        let stored = |h: f64| (energy(h) - energy(-h)) / (2.0 * h);
        // Central differences, extrapolated; the energy is smooth but for a jump of its third derivative.
        let h = 1e-8;
        let stored = (4.0 * stored(h) - stored(2.0 * h)) / 3.0;
        let load = load(&guide, &states, &now);
        let power = load.force.dot(velocity) + load.couple * spin;
        let lost = -power - stored;
        let bound = 1e-6 * (energy(0.0) / 1e-4 + STIFFNESS * 1e-6 * velocity.norm());
        assert!(lost >= -bound, "gives back {:e} W of {stored:e} W", -lost);
        if chi == 0.0 && friction == FrictionLaw::None {
            assert!(lost <= bound, "takes {lost:e} W of {stored:e} W");
        } else {
            damped += usize::from(lost > 10.0 * bound);
            clipped += usize::from(load.force.norm() == 0.0 && energy(0.0) > 0.0);
        }
    }
    assert!(damped > 10_000 && clipped > 100, "{damped} damped, {clipped} clipped");
}

#[test]
fn a_closed_face_has_one_guard_and_an_open_one_a_guard_for_each_corner() {
    let guide = Guide::new(&scene(DampingLaw::Hertz, FrictionLaw::None));
    let mut chance = Chance(19);
    for _ in 0..10_000 {
        let (y, tilt) = (chance.between(-1.5e-4, 1.5e-4), chance.between(-8e-3, 8e-3));
        let spin = chance.between(-9.0, 9.0);
        let now = SliderPose { speed: spin, pin_velocity: Vec2::new(0.0, chance.between(-1.0, 1.0)), ..pose(y, tilt) };
        let depth = guide.penetrations(&now);
        let open = guide.event_functions(&[ContactState::default(); 4], &now);
        assert_eq!(open.map(|event| event.value), depth.map(|depth| -depth));
        let shut = guide.event_functions(&closed(1.0), &now);
        let approaches = guide.approaches(&now);
        for face in 0..2 {
            let [front, rear] = [2 * face, 2 * face + 1];
            let deeper = if depth[front] > depth[rear] { front } else { rear };
            assert_eq!((shut[front].value, shut[front].rate), (depth[deeper], -open[deeper].rate));
            assert_eq!((shut[rear].value, shut[rear].rate), (1.0, 0.0));
            // The larger approach speed, whichever corner touches.
            assert_eq!(approaches[face], (depth[deeper], (-open[front].rate).max(-open[rear].rate)));
            assert_eq!(approaches[2 + face], (f64::NEG_INFINITY, 0.0));
        }
    }
}
