//! Flexible rod, elastic faces, lugre and audit: closed forms and the energy balance.

use crate::mechanisms::{ALL, NONE, brisk, each_contact, flexible, lugre};
use reference_mechanism::mechanism::{DampingLaw, DriveMode, JointModel, Surface};
use reference_mechanism::{Inputs, Mechanism, Outputs, Reference};
use std::f64::consts::PI;

const TOLERANCE: f64 = 1e-12;

fn started(mechanism: &Mechanism, inputs: Inputs) -> Reference {
    Reference::start(mechanism, 0.0, inputs, TOLERANCE)
}

fn after(mechanism: &Mechanism, load: f64, time: f64) -> Outputs {
    let mut reference = started(mechanism, Inputs { crank_torque: 0.0, slider_load: load });
    reference.advance_to(time);
    reference.outputs()
}

/// Held straight at dead centre under gravity.
fn held(bending_modes: i32, axial_modes: i32, foreshortening: bool) -> Mechanism {
    let mut mechanism = Mechanism::default();
    (mechanism.drive.mode, mechanism.gravity) = (DriveMode::Speed, 9.81);
    flexible(&mut mechanism, bending_modes, axial_modes);
    mechanism.rod.flexible.geometric_stiffness = foreshortening;
    mechanism.rod.flexible.damping_ratio = 0.0;
    mechanism
}

/// [N·m²] and [kg/m] of the rod.
fn stiffness_and_mass(mechanism: &Mechanism) -> (f64, f64) {
    let f = &mechanism.rod.flexible;
    (f.young * f.second_moment, f.density * f.area)
}

/// [rad/s] Of the simply supported beam's bending mode.
fn bending_frequency(mechanism: &Mechanism, mode: f64) -> f64 {
    let (stiffness, mass) = stiffness_and_mass(mechanism);
    (mode * PI / mechanism.rod.length).powi(2) * (stiffness / mass).sqrt()
}

#[test]
fn a_rod_sags_as_its_modes_of_a_beam_do() {
    let mut mechanism = held(3, 0, false);
    mechanism.rod.flexible.damping_ratio = 1.0;
    let (stiffness, mass) = stiffness_and_mass(&mechanism);
    let l = mechanism.rod.length;
    // q_i = 4·ρA·g·l⁴/((iπ)⁵·EI) for odd i; mid-span takes 1 and −1 of the first two.
    let sag = |i: f64| 4.0 * mass * mechanism.gravity * l.powi(4) / ((i * PI).powi(5) * stiffness);
    let found = after(&mechanism, 0.0, 40.0 / bending_frequency(&mechanism, 1.0)).rod.deflection;
    let exact = -(sag(1.0) - sag(3.0));
    // (1 + 40)·exp(−40) of the sag is still to come.
    assert!((found / exact - 1.0).abs() < 1e-10, "{found} is not {exact}");
    // The whole series: 5ql⁴/384EI, of which mode 5 lacks 1/5⁵.
    let textbook = -5.0 * mass * mechanism.gravity * l.powi(4) / (384.0 * stiffness);
    assert!((found / textbook - 1.0).abs() < 4e-4, "{found} is not {textbook}");
}

/// A load put on at once overshoots by as much again, half a period later.
#[test]
fn a_rod_rings_with_the_frequency_of_a_beam() {
    for foreshortening in [false, true] {
        let mechanism = held(1, 0, foreshortening);
        let half_period = PI / bending_frequency(&mechanism, 1.0);
        let [half, whole] = [1.0, 2.0].map(|k| after(&mechanism, 0.0, k * half_period).rod.deflection);
        let (stiffness, mass) = stiffness_and_mass(&mechanism);
        let sag = -4.0 * mass * mechanism.gravity * mechanism.rod.length.powi(4) / (PI.powi(5) * stiffness);
        // Foreshortening moves the slider by w'²: 1e-9 of the span.
        assert!((half / (2.0 * sag) - 1.0).abs() < 1e-8, "{half} is not twice {sag}");
        assert!((whole / sag).abs() < 1e-8, "{whole} remains of {sag}");
    }
}

/// One fixed-free mode that carries the slider: ω² = k/(ρAl/2 + m), k = EA·π²/(8l).
#[test]
fn a_rod_stretches_with_the_slider_at_its_end() {
    let mut mechanism = held(0, 1, true);
    mechanism.gravity = 0.0;
    let (f, l) = (&mechanism.rod.flexible, mechanism.rod.length);
    let stiffness = f.young * f.area * PI * PI / (8.0 * l);
    let half_period = PI * ((f.density * f.area * l / 2.0 + mechanism.slider.mass) / stiffness).sqrt();
    let stretch = after(&mechanism, 500.0, half_period).rod.stretch;
    // The change of the frame's own pose is nil: the rod lies on the x axis.
    assert!((stretch / (2.0 * 500.0 / stiffness) - 1.0).abs() < 1e-8, "{stretch}");
}

/// A pull F raises ω² by F/(EI·π²/l²) and lowers the sag as much, Euler's load being negative.
#[test]
fn a_pull_stiffens_the_bent_rod_and_only_through_foreshortening() {
    for (foreshortening, pull) in [(true, 0.5), (true, -0.5), (false, 0.5)] {
        let mechanism = held(1, 0, foreshortening);
        let (stiffness, mass) = stiffness_and_mass(&mechanism);
        let load = pull * stiffness * (PI / mechanism.rod.length).powi(2);
        let stiffer: f64 = if foreshortening { 1.0 + pull } else { 1.0 };
        let half_period = PI / (bending_frequency(&mechanism, 1.0) * stiffer.sqrt());
        let sag = -4.0 * mass * mechanism.gravity * mechanism.rod.length.powi(4) / (PI.powi(5) * stiffness * stiffer);
        let found = after(&mechanism, load, half_period).rod.deflection;
        // The slider's mass takes part with w'²: 1e-9.
        assert!((found / (2.0 * sag) - 1.0).abs() < 1e-7, "{found} is not twice {sag}");
    }
}

#[test]
fn a_stiff_rod_moves_like_a_rigid_one() {
    let mechanism = |young: f64| {
        let mut mechanism = brisk(DriveMode::Speed, NONE);
        flexible(&mut mechanism, 2, 1);
        mechanism.rod.flexible.young = young;
        mechanism
    };
    let mut rigid = mechanism(0.0);
    let f = std::mem::take(&mut rigid.rod.flexible);
    let l = rigid.rod.length;
    rigid.rod.mass = f.density * f.area * l;
    rigid.rod.inertia = rigid.rod.mass * l * l / 12.0;
    (rigid.rod.com.x, rigid.rod.com.y) = (l / 2.0, 0.0);
    let run = |mechanism: &Mechanism| {
        let mut reference = started(mechanism, Inputs::default());
        (1..=100).map(|k| (reference.advance_to(1e-5 * f64::from(k)), reference.outputs().slider.x).1).collect()
    };
    let exact: Vec<f64> = run(&rigid);
    let [soft, stiff] = [1e10, 16e10].map(|young| {
        let found: Vec<f64> = run(&mechanism(young));
        found.iter().zip(&exact).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    });
    // In proportion to 1/E, but for the phase of what rings.
    assert!(soft < 1e-4 && stiff < soft / 12.0 && stiff > soft / 20.0, "{soft}, {stiff}");
}

#[test]
fn more_quadrature_points_change_nothing() {
    let mut mechanism = brisk(DriveMode::Torque, NONE);
    flexible(&mut mechanism, 3, 1);
    let few = started(&mechanism, Inputs::default());
    let many = Reference::start_with(&mechanism, 0.0, Inputs::default(), TOLERANCE, 60);
    let [few, many] = [few, many].map(|mut reference| {
        reference.advance_to(5e-4);
        reference.outputs()
    });
    let near = |a: f64, b: f64, what: &str| assert!((a / b - 1.0).abs() < 1e-10, "{what}: {a} with few, {b} with many");
    near(few.rod.deflection, many.rod.deflection, "deflection");
    near(few.rod.stretch, many.rod.stretch, "stretch");
    near(few.slider.a, many.slider.a, "acceleration");
}

/// Every loss and every store at once.
#[test]
fn the_audit_balances() {
    for mode in [DriveMode::Torque, DriveMode::Speed] {
        for surface in [Surface::Corner, Surface::Foundation] {
            let mut mechanism = brisk(mode, ALL);
            (mechanism.gravity, mechanism.energy.audit, mechanism.joint.t.surface) = (9.81, true, surface);
            flexible(&mut mechanism, 2, 1);
            each_contact(&mut mechanism, lugre);
            let joint = &mut mechanism.joint;
            (joint.a.damping, joint.b.damping, joint.c.damping, joint.t.damping) = (5e-3, 4e-3, 3e-3, 20.0);
            let mut reference = started(&mechanism, Inputs { crank_torque: 30.0, slider_load: -400.0 });
            reference.advance_to(5e-4);
            let energy = reference.outputs().energy;
            let losses = [energy.contact_loss, energy.friction_loss, energy.viscous_loss, energy.modal_loss];
            assert!(losses.iter().all(|&loss| loss > 1e-6), "{losses:?}");
            // Some thousand steps, each within 1e-12 J and 1e-12 m/s times momenta of 10 kg·m/s.
            assert!(energy.residual.abs() < 1e-8, "{energy:?}");
        }
    }
}

#[test]
fn energy_stays_with_a_flexible_rod_on_elastic_faces() {
    let mut mechanism = brisk(DriveMode::Torque, ALL);
    flexible(&mut mechanism, 3, 1);
    (mechanism.gravity, mechanism.rod.flexible.damping_ratio, mechanism.joint.t.surface) =
        (9.81, 0.0, Surface::Foundation);
    mechanism.joint.t.model = JointModel::Clearance;
    each_contact(&mut mechanism, |contact| contact.law = DampingLaw::Hertz);
    let mut reference = started(&mechanism, Inputs::default());
    let start = reference.energy();
    reference.advance_to(6e-4);
    assert!(reference.crossings().len() > 5, "there are impacts to lose energy in");
    let lost = reference.energy() / start - 1.0;
    assert!(lost.abs() < 1e-9, "{lost:e} of the energy is lost");
}
