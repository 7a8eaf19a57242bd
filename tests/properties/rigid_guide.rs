use super::motion::motion;
use super::scenes::{at, start};
use slidercrank::model::signals::Inputs;
use slidercrank::scene::read::read;
use slidercrank::scene::{FrictionLaw, Method, Scene, DampingLaw};

pub fn guideplay(step: f64) -> Scene {
    let text = include_str!("../../fmu-harness/scenes/guideplay.toml");
    let mut scene = read(text, "guideplay.toml").expect("a shipped scene").scene;
    scene.solver.method = Method::Moreau;
    scene.solver.step = step;
    scene
}

#[test]
fn experiment() {
    for (h, m) in [(1e-5, Method::Moreau), (1e-6, Method::Moreau), (1e-7, Method::Moreau), (1e-6, Method::Verner7)] {
        let mut scene = guideplay(h);
        scene.solver.method = m;
        let mut s = start(&scene, Inputs::default());
        let mut deepest = 0.0f64;
        let mut e0 = 0.0;
        let mut first = None;
        let clock = std::time::Instant::now();
        for i in 1..=20000 {
            let t = 1e-5 * f64::from(i);
            if let Err(e) = s.advance_to(t) { println!("{e}"); break; }
            let o = s.outputs();
            if o.solver.events > 0 && first.is_none() { first = Some((t, o.joint_t.contacts, o.slider.y, o.solver.events)); }
            deepest = deepest.max(o.joint_t.penetration);
            if i % 2000 == 0 || i == 1 {
                let mm = motion(&scene, &mut s);
                let e = mm.kinetic() + mm.weight(scene.gravity);
                if i == 1 { e0 = e; }
                println!("{m:?} {h:e} t={t:.3} y={:+.6e} th={:+.5e} w={:+.4e} E={:+.6e} deep={deepest:.2e} ev={} st={} evals={} wall={:?}", o.slider.y, o.slider.angle, o.crank.speed, e - e0, o.solver.events, o.solver.steps, o.solver.evaluations, clock.elapsed());
            }
        }
        println!("first {first:?}");
    }
}

#[test]
fn trace() {
    let scene = guideplay(1e-6);
    let mut s = start(&scene, Inputs::default());
    let mut last = 0;
    let mut n = 0;
    for i in 1..=20000 {
        let t = 1e-6 * f64::from(i);
        let o = at(&mut s, t);
        if o.solver.events != last || (n > 100 && n < 160) {
            n += 1;
            if n < 130 || n % 50 == 0 { println!("{i} ev={} c={} pen={:.4e} F={:.4e} th={:.2e} M={:.3e}", o.solver.events, o.joint_t.contacts, o.joint_t.penetration, o.joint_t.force[1], o.slider.angle, o.joint_t.moment); }
        }
        last = o.solver.events;
    }
}

#[test]
fn trace2() {
    let scene = guideplay(1e-6);
    let mut s = start(&scene, Inputs::default());
    for i in 9696..=9708 {
        let t = 1e-6 * f64::from(i);
        let o = at(&mut s, t);
        let d = s.output_rates();
        println!("{i} e={} ev={} c={} pen={:.6e} vy={:.6e} F={:.4e} w={:.6e}", scene.joint.t.contact.restitution, o.solver.events, o.joint_t.contacts, o.joint_t.penetration, d.slider.y, o.joint_t.force[1], o.crank.speed);
    }
}
