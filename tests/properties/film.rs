//! Journals in oil: printed transients of a free journal, and where a loaded one comes to rest.

use super::scenes::{at, at_tolerance, inputs, speed_driven, start, with_play};
use slidercrank::scene::{DampingLaw, Lubrication, Point, Scene};
use std::f64::consts::PI;

/// A crank of 4 kg that turns at 150 rad/s in its main bearing under `gravity` [m/s²], with a rod and a slider that
/// weigh nothing. R = L = 20 mm, c = 0.1 mm.
fn journal(gravity: f64, eccentricity: [f64; 2], viscosity: f64, roughness: f64) -> Scene {
    let mut scene = with_play(Scene { gravity, gravity_angle: -1.9, ..Scene::default() }, [true, false, false, false]);
    (scene.crank.mass, scene.crank.com, scene.crank.speed_start) = (4.0, Point::default(), 150.0);
    (scene.rod.mass, scene.rod.inertia, scene.slider.mass, scene.slider.inertia) = (1e-12, 1e-15, 1e-12, 1e-15);
    let a = &mut scene.joint.a;
    (a.radius, a.contact.width, a.clearance) = (0.02, 0.02, 1e-4);
    (a.contact.law, a.contact.restitution, a.contact.ratio_limit) = (DampingLaw::Flores, 0.4, 0.0);
    (a.lubrication, a.viscosity, a.roughness) = (Lubrication::ShortBearing, viscosity, roughness);
    a.eccentricity_start = Point { x: eccentricity[0], y: eccentricity[1] };
    scene.energy.audit = true;
    at_tolerance(speed_driven(scene), 1e-12)
}

fn near(found: f64, wanted: f64, tolerance: f64, what: &str) {
    assert!((found - wanted).abs() <= tolerance * wanted.abs(), "{what}: {found:e}, not {wanted:e}");
}

#[test]
fn a_free_journal_swims_in_its_film() {
    let scene = journal(150.0, [20e-6, 30e-6], 0.03, 1e-6);
    let outputs = at(&mut start(&scene, inputs(0.0, 0.0)), 6e-3);
    near(outputs.joint_a.eccentricity[0], -8.80760793e-6, 1e-7, "e_x");
    near(outputs.joint_a.eccentricity[1], -73.4243553e-6, 1e-7, "e_y");
    near(outputs.joint_a.film_force, 603.133003, 1e-7, "film.force");
    near(outputs.joint_a.film_moment, -0.0718417395, 1e-7, "film.moment");
    near(outputs.energy.dissipated, 0.117326729, 1e-7, "energy.dissipated");
    assert_eq!((outputs.joint_a.interval.impacts, outputs.joint_a.interval.impact_speed), (0, 0.0));
}

#[test]
fn a_journal_falls_through_thin_oil_onto_the_wall() {
    let scene = journal(1000.0, [0.0, -20e-6], 0.004, 4e-6);
    let mut simulation = start(&scene, inputs(0.0, 0.0));
    assert!(simulation.advance_to_event(1e-3).expect("a fall"));
    near(simulation.time(), 0.433143234e-3, 1e-7, "touch");
    let touching = simulation.outputs();
    near(touching.joint_a.interval.impact_speed, 0.0906987792, 1e-7, "approach speed");
    assert_eq!(touching.joint_a.interval.impacts, 1);
    let outputs = at(&mut simulation, 3e-3);
    near(outputs.joint_a.eccentricity[0], -29.8182904e-6, 1e-6, "e_x");
    near(outputs.joint_a.eccentricity[1], -88.6136150e-6, 1e-6, "e_y");
    near(outputs.joint_a.penetration, 5.49600639e-6, 1e-6, "penetration");
    near(outputs.joint_a.film_force, 104.346389, 1e-6, "film.force");
}

/// Ocvirk's locus of static equilibrium: a load W turns the eccentricity by an attitude angle against the spin.
#[test]
fn a_loaded_journal_settles_on_the_locus_of_equilibrium() {
    for ratio in [0.5f64, 0.7, 0.9] {
        let (viscosity, radius, length, c, spin) = (0.03, 0.02, 0.02, 1e-4, 150.0);
        let k: f64 = viscosity * radius * length * length * length / (4.0 * c * c) * spin;
        let square = ratio * ratio;
        let load = k * ratio / (1.0 - square).powi(2) * (16.0 * square + PI * PI * (1.0 - square)).sqrt();
        let attitude = (0.25 * PI * (1.0 - square).sqrt() / ratio).atan();
        let gravity = load / 4.0;
        // From near the equilibrium, since a journal far from it whirls for long.
        let place = |ratio: f64| {
            let angle = -1.9 + attitude;
            [ratio * c * angle.cos(), ratio * c * angle.sin()]
        };
        let mut simulation = start(&journal(gravity, place(0.98 * ratio), viscosity, 1e-7), inputs(0.0, 0.0));
        let outputs = at(&mut simulation, 1.0);
        let [x, y] = outputs.joint_a.eccentricity;
        let wanted = place(ratio);
        assert!((x - wanted[0]).hypot(y - wanted[1]) < 1e-8 * c, "{ratio}: {x:e}, {y:e}, not {wanted:?}");
        near(outputs.joint_a.film_force, load, 1e-7, "film.force");
    }
}

#[test]
fn what_lubrication_asks_for_is_named() {
    let refused = |change: fn(&mut Scene)| {
        let mut scene = journal(150.0, [0.0; 2], 0.03, 1e-6);
        change(&mut scene);
        scene.check().expect_err("not allowed").to_string()
    };
    assert!(refused(|scene| scene.joint.a.roughness = 2e-5).starts_with("joint.A.roughness = 2e-5 is not allowed"));
    assert!(refused(|scene| scene.joint.a.roughness = 0.0).starts_with("joint.A.roughness = 0 is not allowed"));
    assert!(refused(|scene| scene.joint.a.contact.width = 0.0).starts_with("joint.A.width = 0 is not allowed"));
    // A dry joint does not look at them, nor an ideal one.
    let mut dry = journal(150.0, [0.0; 2], 0.03, 2e-5);
    dry.joint.a.lubrication = Lubrication::None;
    assert_eq!(dry.check(), Ok(()));
}
