//! As a joint's clearance goes to zero its mechanism tends to the one in which it is ideal.

use super::motion::Vec2;
use super::scenes::{Play, at, at_tolerance, contacts, crooked, letters, revolutes, speed_driven, start, with_play};
use slidercrank::model::signals::{Inputs, Outputs};
use slidercrank::scene::Scene;

/// The clearance in all four joints, and stiffnesses with which penetrations fall in proportion to it.
fn with_clearance(mut scene: Scene, clearance: f64) -> Scene {
    for joint in revolutes(&mut scene) {
        joint.clearance = clearance;
    }
    scene.joint.t.clearance = clearance;
    for contact in contacts(&mut scene) {
        contact.stiffness = 1e10 * (1e-3 / clearance).powf(1.5);
        contact.restitution = 0.5;
    }
    at_tolerance(scene, 1e-7)
}

/// Times over three quarters of a turn.
fn times() -> impl Iterator<Item = f64> {
    (1..=3000).map(|i| 1e-5 * f64::from(i))
}

/// Largest differences over the run in position of the slider [m] and in rod angle [rad].
fn difference(play: Play, clearance: f64) -> [f64; 2] {
    let scene = speed_driven(crooked());
    let (mut ideal, mut clear) = (start(&scene, Inputs::default()), {
        let scene = with_clearance(with_play(scene.clone(), play), clearance);
        start(&scene, Inputs::default())
    });
    let mut worst = [0.0f64; 2];
    for t in times() {
        let [one, other]: [Outputs; 2] = [at(&mut ideal, t), at(&mut clear, t)];
        let place = Vec2::new(one.slider.x - other.slider.x, one.slider.y - other.slider.y);
        worst[0] = worst[0].max(place.norm());
        worst[1] = worst[1].max((one.rod.angle - other.rod.angle).abs());
    }
    worst
}

#[test]
fn the_error_falls_in_proportion_to_the_clearance() {
    for i in 0..4 {
        let mut play = [false; 4];
        play[i] = true;
        let clearances = [1e-3, 2.5e-4, 6.25e-5, 1.5625e-5];
        let errors = clearances.map(|clearance| difference(play, clearance));
        let ratios: Vec<f64> = errors.iter().zip(clearances).map(|(error, c)| error[0] / c).collect();
        let turns: Vec<f64> = errors.iter().zip(clearances).map(|(error, c)| error[1] * 0.12 / c).collect();
        println!("{}: error/clearance {ratios:.3?}, of the rod's end {turns:.3?}", letters(play));
        // The journal touches its bearing: the slider is off by the clearance, the penetration, and what the
        // rod's slope makes of both.
        assert!(ratios.iter().all(|&ratio| 0.1 < ratio && ratio < 2.5), "{}: {ratios:?}", letters(play));
        assert!(turns.iter().all(|&ratio| ratio < 2.5), "{}: {turns:?}", letters(play));
        // 64 times less clearance, 64 times less error; how deep the deepest impact is differs by a percent.
        let fall = errors[0][0] / errors[3][0];
        assert!((60.0..68.0).contains(&fall), "{}: falls by {fall}", letters(play));
    }
}

#[test]
fn all_joints_together_tend_to_the_ideal_mechanism() {
    let errors = [1e-3, 1.25e-4, 1.5625e-5].map(|clearance| difference([true; 4], clearance)[0] / clearance);
    println!("ABCT: error/clearance {errors:.3?}");
    assert!(errors.iter().all(|&ratio| 3.0 < ratio && ratio < 6.0), "{errors:?}");
}

#[test]
fn the_mean_force_of_a_tight_joint_is_the_ideal_reaction() {
    for i in 0..4 {
        let mut play = [false; 4];
        play[i] = true;
        let scene = speed_driven(crooked());
        let mut ideal = start(&scene, Inputs::default());
        let mut clear = start(&with_clearance(with_play(scene, play), 1e-5), Inputs::default());
        // Impulses over a quarter of a turn, sampled finely enough for the impacts.
        let h = 1e-6;
        let (mut wanted, mut found, mut size) = (Vec2::zeros(), Vec2::zeros(), 0.0);
        for step in 0..10_000 {
            let t = h * (f64::from(step) + 0.5);
            let [one, other] = [at(&mut ideal, t), at(&mut clear, t)];
            let force =
                |o: &Outputs| Vec2::from([o.joint_a.force, o.joint_b.force, o.joint_c.force, o.joint_t.force][i]);
            wanted += h * force(&one);
            found += h * force(&other);
            size += h * force(&one).norm();
        }
        let error = (found - wanted).norm() / size;
        println!("{}: impulse off by {error:.1e}", letters(play));
        // At either end of the interval a rebound may be under way: m·Δv, Δv ~ 0.05 m/s, of 1 N·s; measured.
        assert!(error < 0.03, "{}: {error:e}", letters(play));
    }
}
