//! Elastic laws of revolute joints: force, energy and what they become for small penetrations.

use slidercrank::math::{F64x8, Real};
use slidercrank::model::contact::{Elastic, PowerLaw};
use slidercrank::scene::{Elasticity, JointModel, Revolute, Scene};

/// [m] Clearances of a loose and of a tight joint.
const CLEARANCES: [f64; 2] = [0.5e-3, 20e-6];

/// R_b = 10 mm, L = 20 mm, steel of 207 GPa and 0.3.
fn joint(elasticity: Elasticity, clearance: f64) -> Revolute {
    let mut joint = Scene::default().joint.c;
    (joint.elasticity, joint.radius, joint.clearance, joint.contact.width) = (elasticity, 0.01, clearance, 0.02);
    joint
}

/// Every law in both joints, Hertz's with another exponent, too.
fn laws() -> impl Iterator<Item = (String, f64, Elastic)> {
    CLEARANCES.into_iter().flat_map(|clearance| {
        let named = Elasticity::ALL.iter().map(move |&law| (law.name().to_owned(), joint(law, clearance)));
        let mut power = joint(Elasticity::Hertz, clearance);
        power.contact.exponent = 1.8;
        let all = named.chain([("power".to_owned(), power)]);
        all.map(move |(name, joint)| (name, clearance, Elastic::new(&joint)))
    })
}

/// [J] ∫F dδ by Simpson's rule in √δ, in which the force is smooth.
fn integral(law: &Elastic, depth: f64) -> f64 {
    const PANELS: u32 = 4000;
    let width = depth.sqrt() / f64::from(PANELS);
    let terms = (0..=PANELS).map(|k| {
        let root = width * f64::from(k);
        let weight = if k == 0 || k == PANELS { 1.0 } else { f64::from(2 + 2 * (k % 2)) };
        weight * law.force(root * root) * 2.0 * root
    });
    terms.sum::<f64>() * width / 3.0
}

#[test]
fn energy_is_the_integral_of_the_force() {
    for (name, clearance, law) in laws() {
        assert_eq!((law.force(0.0), law.energy(0.0)), (0.0, 0.0), "{name}");
        for depth in [1e-9, 1e-7, 1e-6, 1.9e-6, 2.1e-6, 1e-5, 4.9e-5, 5.1e-5, 5e-4] {
            let (energy, wanted) = (law.energy(depth), integral(&law, depth));
            // Simpson's error, measured: 2e-12 of the energy. Closed forms lose two digits where they begin.
            let error = (energy / wanted - 1.0).abs();
            assert!(error <= 1e-11, "{name}, c = {clearance} m, {depth} m: {energy:e} J, {wanted:e} J");
        }
    }
}

#[test]
fn small_penetrations_follow_the_power_law_that_is_said() {
    for (name, clearance, law) in laws() {
        let PowerLaw { stiffness, exponent } = law.for_small_penetrations();
        let depth = 1e-6 * clearance;
        let force = law.force(depth) / (stiffness * depth.powf(exponent));
        // The next term of the series is below δ/c.
        assert!((force - 1.0).abs() <= 1e-6, "{name}, c = {clearance} m: {force}");
    }
}

#[test]
fn rows_have_the_bits_of_single_numbers() {
    let depths = [1e-9, 1e-7, 1.9e-6, 2.1e-6, 1e-5, 4.9e-5, 5.1e-5, 5e-4];
    for (name, clearance, law) in laws() {
        let (force, energy) = (law.force(F64x8::of(depths)), law.energy(F64x8::of(depths)));
        assert_eq!(force.numbers(), depths.map(|depth| law.force(depth)), "{name}, c = {clearance} m");
        assert_eq!(energy.numbers(), depths.map(|depth| law.energy(depth)), "{name}, c = {clearance} m");
        assert_eq!(law.force(F64x8::constant(1e-5)).last(), law.force(1e-5), "{name}");
    }
}

#[test]
fn bai_and_zhaos_force_and_energy_are_those_of_an_independent_computation() {
    // F [N] and potential [J], made elsewhere, in nine digits.
    let tables = [
        (0.5e-3, [(169.206554, 6.77147999e-5), (5272.20344, 0.0211876539), (55403.1926, 1.13248459)]),
        (20e-6, [(813.891633, 3.29282963e-4), (19449.6568, 0.0843788860), (122020.209, 2.9045473)]),
    ];
    for (clearance, table) in tables {
        let law = Elastic::new(&joint(Elasticity::BaiZhao, clearance));
        for (depth, (force, energy)) in [1e-6, 1e-5, 5e-5].into_iter().zip(table) {
            let (found, stored) = (law.force(depth), law.energy(depth));
            // Half a unit of the last digit printed, at most 5e-9 of the number.
            assert!((found / force - 1.0).abs() <= 5e-9, "c = {clearance} m, {depth} m: {found} N, not {force}");
            assert!((stored / energy - 1.0).abs() <= 2e-8, "c = {clearance} m, {depth} m: {stored} J, not {energy}");
        }
    }
}

/// A bushing of bronze, 1 mm thick.
fn bushing(clearance: f64) -> Revolute {
    let mut joint = joint(Elasticity::Winkler, clearance);
    (joint.contact.young.bearing, joint.contact.poisson.bearing) = (110e9, 0.34);
    joint
}

#[test]
fn a_layers_force_and_energy_are_those_of_an_independent_computation() {
    // F [N] and potential [J], made elsewhere, in nine digits.
    let tables = [
        (0.5e-3, [(2851.78408, 1.14113669e-3), (89145.4160, 0.357886442), (949350.688, 19.3149348)]),
        (20e-6, [(13833.4111, 5.58288029e-3), (349622.511, 1.49290444), (2387497.96, 55.4833311)]),
    ];
    for (clearance, table) in tables {
        let law = Elastic::new(&bushing(clearance));
        for (depth, (force, energy)) in [1e-6, 1e-5, 5e-5].into_iter().zip(table) {
            let (found, stored) = (law.force(depth), law.energy(depth));
            assert!((found / force - 1.0).abs() <= 5e-9, "c = {clearance} m, {depth} m: {found} N, not {force}");
            assert!((stored / energy - 1.0).abs() <= 5e-9, "c = {clearance} m, {depth} m: {stored} J, not {energy}");
        }
    }
}

#[test]
fn a_layer_deep_inside_presses_with_half_its_circumference() {
    let (clearance, depth) = (1e-9, 1e-2);
    let law = Elastic::new(&bushing(clearance));
    let stiffness = law.for_small_penetrations().stiffness * clearance.sqrt() * 3.0 / (4.0 * std::f64::consts::SQRT_2);
    let wanted = stiffness * (std::f64::consts::FRAC_PI_2 * (clearance + depth) - 2.0 * clearance);
    assert!((law.force(depth) / wanted - 1.0).abs() < 1e-9, "{} N, not {wanted}", law.force(depth));
}

#[test]
fn a_layer_of_given_stiffness_needs_no_material() {
    let plain = bushing(1e-4);
    let mut given = plain.clone();
    let poisson: f64 = 0.34;
    given.layer.stiffness = (1.0 - poisson) * 110e9 / ((1.0 + poisson) * (1.0 - 2.0 * poisson) * 1e-3);
    (given.layer.thickness, given.contact.poisson.bearing, given.contact.young.journal) = (0.0, 0.5, 1e6);
    assert_eq!(Elastic::new(&plain), Elastic::new(&given));
    let refused = |edit: fn(&mut Revolute)| {
        let mut scene = Scene::default();
        scene.joint.c = bushing(1e-4);
        scene.joint.c.model = JointModel::Clearance;
        scene.check().expect("a bushing");
        edit(&mut scene.joint.c);
        scene.check().expect_err("a layer without stiffness").to_string()
    };
    assert_eq!(
        refused(|joint| joint.layer.thickness = 0.0),
        "joint.C.layer.thickness = 0 is not allowed: above 0 m for elasticity winkler, unless joint.C.layer.stiffness is given"
    );
    assert_eq!(
        refused(|joint| joint.contact.poisson.bearing = 0.495),
        "joint.C.poisson.bearing = 0.495 is not allowed: 0 to 0.49 for elasticity winkler, unless joint.C.layer.stiffness is given"
    );
}

#[test]
fn bai_and_zhaos_force_lies_between_lius_and_three_halves_of_it() {
    for clearance in CLEARANCES {
        let [bai_zhao, liu] = [Elasticity::BaiZhao, Elasticity::Liu].map(|law| Elastic::new(&joint(law, clearance)));
        let ratio = |depth: f64| bai_zhao.force(depth) / liu.force(depth);
        assert!((ratio(1e-9 * clearance) - 1.5).abs() < 1e-9 && (ratio(1e9 * clearance) - 1.0).abs() < 1e-9);
        assert!((ratio(clearance) - 1.25).abs() < 1e-15);
        // F = δ·dF_liu/dδ; the difference quotient errs by the step's square and by rounding over the step.
        for depth in [1e-7, 1e-6, 1e-5, 1e-4] {
            let step = 1e-5 * depth;
            let slope = (liu.force(depth + step) - liu.force(depth - step)) / (2.0 * step);
            assert!((bai_zhao.force(depth) / (depth * slope) - 1.0).abs() < 1e-9, "{clearance} m, {depth} m");
        }
    }
}

#[test]
fn bai_and_zhaos_force_uses_neither_stiffness_nor_exponent() {
    let plain = joint(Elasticity::BaiZhao, 1e-4);
    let mut given = plain.clone();
    (given.contact.stiffness, given.contact.exponent) = (1e9, 2.0);
    assert_eq!(Elastic::new(&plain), Elastic::new(&given));
    let mut scene = Scene::default();
    scene.joint.c = plain;
    (scene.joint.c.model, scene.joint.c.contact.width) = (JointModel::Clearance, 0.0);
    let error = scene.check().expect_err("no force without width").to_string();
    assert_eq!(error, "joint.C.width = 0 is not allowed: above 0 m for elasticity bai_zhao");
}
