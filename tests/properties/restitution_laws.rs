//! Damping factors and the restitution they deliver, against published tables and by integrating a
//! free impact.

use slidercrank::model::contact::damping::factor;
use slidercrank::scene::DampingLaw;

/// Restitution asked for.
const ASKED: [f64; 11] = [0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95];

/// Restitution delivered, to four places.
const DELIVERED: [(DampingLaw, [f64; 11]); 9] = [
    (
        DampingLaw::HuntCrossley,
        [0.5014, 0.5158, 0.5469, 0.5813, 0.6197, 0.6630, 0.7120, 0.7680, 0.8329, 0.9090, 0.9524],
    ),
    (
        DampingLaw::HerbertMcwhannell,
        [0.4884, 0.4907, 0.5008, 0.5200, 0.5503, 0.5936, 0.6511, 0.7227, 0.8070, 0.9009, 0.9501],
    ),
    (DampingLaw::LeeWang, [0.6746, 0.6867, 0.7120, 0.7390, 0.7680, 0.7992, 0.8329, 0.8693, 0.9090, 0.9524, 0.9756]),
    (
        DampingLaw::LankaraniNikravesh,
        [0.6635, 0.6653, 0.6723, 0.6842, 0.7016, 0.7252, 0.7561, 0.7960, 0.8471, 0.9132, 0.9535],
    ),
    (DampingLaw::Gonthier, [0.0501, 0.1010, 0.2046, 0.3042, 0.3978, 0.4877, 0.5773, 0.6696, 0.7680, 0.8764, 0.9359]),
    (
        DampingLaw::ZhiyingQishao,
        [0.1969, 0.2175, 0.2664, 0.3267, 0.3988, 0.4826, 0.5769, 0.6796, 0.7874, 0.8959, 0.9489],
    ),
    (DampingLaw::Flores, [0.0329, 0.0694, 0.1555, 0.2562, 0.3629, 0.4704, 0.5773, 0.6832, 0.7885, 0.8939, 0.9468]),
    (DampingLaw::HuGuo, [0.0351, 0.0741, 0.1656, 0.2707, 0.3796, 0.4877, 0.5936, 0.6973, 0.7992, 0.8999, 0.9500]),
    (
        DampingLaw::CarvalhoMartins,
        [0.0929, 0.1289, 0.2116, 0.3040, 0.4011, 0.5002, 0.6000, 0.7000, 0.8000, 0.9000, 0.9500],
    ),
];

/// χ of the exact law, to the places printed.
const EXACT: [(f64, f64, f64); 12] = [
    (0.05, 20.000, 5e-4),
    (0.1, 9.9982, 5e-5),
    (0.2, 4.9192, 5e-5),
    (0.3, 3.0871, 5e-5),
    (0.4, 2.0825, 5e-5),
    (0.5, 1.4328, 5e-5),
    (0.6, 0.9749, 5e-5),
    (0.7, 0.6348, 5e-5),
    (0.8, 0.3731, 5e-5),
    (0.9, 0.1665, 5e-5),
    (0.95, 0.0789, 5e-5),
    (0.99, 0.0152, 5e-5),
];

/// Restitution of a free impact at unit mass, stiffness and speed: δ̈ = −δ^p·(1 + χ·δ̇).
pub fn delivered(chi: f64, exponent: f64) -> f64 {
    // Classical Runge-Kutta in the velocity, which falls from 1: dδ/dv = v/a. Energy in δ^(p + 1) would
    // be as smooth; here time steps of 1/2000 of the contact leave 1e-7 where p = 3/2.
    let acceleration = |depth: f64, speed: f64| -depth.max(0.0).powf(exponent) * (1.0 + chi * speed).max(0.0);
    let h = 1e-3;
    let (mut depth, mut speed) = (0.0, 1.0);
    loop {
        let k1 = (speed, acceleration(depth, speed));
        let k2 = (speed + 0.5 * h * k1.1, acceleration(depth + 0.5 * h * k1.0, speed + 0.5 * h * k1.1));
        let k3 = (speed + 0.5 * h * k2.1, acceleration(depth + 0.5 * h * k2.0, speed + 0.5 * h * k2.1));
        let k4 = (speed + h * k3.1, acceleration(depth + h * k3.0, speed + h * k3.1));
        depth += h / 6.0 * (k1.0 + 2.0 * k2.0 + 2.0 * k3.0 + k4.0);
        speed += h / 6.0 * (k1.1 + 2.0 * k2.1 + 2.0 * k3.1 + k4.1);
        if depth <= 0.0 {
            return -speed;
        }
    }
}

/// The root e of χ(1 + e) = ln((1 + χ)/(1 − χ·e)), by bisection.
pub fn delivered_exactly(chi: f64) -> f64 {
    let excess = |e: f64| (chi.ln_1p() - (-chi * e).ln_1p()) - chi * (1.0 + e);
    let (mut low, mut high) = (0.0, if chi > 1.0 { 1.0 / chi } else { 1.0 });
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if excess(middle) > 0.0 { high = middle } else { low = middle }
    }
    low
}

#[test]
fn each_law_delivers_the_restitution_of_the_table() {
    let mut worst = 0.0f64;
    for (law, table) in DELIVERED {
        for (asked, printed) in ASKED.into_iter().zip(table) {
            let found = delivered(factor(law, asked), 1.5);
            worst = worst.max((found - printed).abs());
            // Half a unit of the last place, and 5e-7 for the integration.
            assert!((found - printed).abs() <= 0.5005e-4, "{law:?} at {asked}: {found}, printed {printed}");
        }
    }
    println!("largest difference from four printed places: {worst:.1e}");
}

#[test]
fn the_exact_law_is_the_published_root_and_delivers_what_is_asked_for() {
    for (asked, printed, half_unit) in EXACT {
        let found = factor(DampingLaw::ZhangSharf, asked);
        assert!((found - printed).abs() <= half_unit, "at {asked}: {found}, printed {printed}");
    }
    let mut worst = 0.0f64;
    for asked in ASKED {
        for exponent in [1.0, 1.5, 2.2] {
            let found = delivered(factor(DampingLaw::ZhangSharf, asked), exponent);
            worst = worst.max((found - asked).abs());
        }
        let root = delivered_exactly(factor(DampingLaw::ZhangSharf, asked));
        // At e = 0.05 the root hangs on 1 − χ·e = 2e-9.
        assert!((root - asked).abs() < 1e-9, "at {asked}: {root}");
    }
    println!("exact law, integrated: {worst:.1e}");
    assert!(worst < 2e-6, "{worst:e}");
}

#[test]
fn hertz_and_full_restitution_have_no_damping() {
    for &(_, value) in DampingLaw::ITEMS {
        let law = DampingLaw::from_value(value).expect("a law");
        assert_eq!(factor(law, 1.0), 0.0, "{law:?}");
    }
    assert!(ASKED.iter().all(|&asked| factor(DampingLaw::Hertz, asked) == 0.0));
}

#[test]
fn near_full_restitution_all_laws_but_two_agree() {
    // χ → (3/2)(1 − e), from which a law departs with (1 − e)²; Lee and Wang's is half of that, and
    // Gonthier's and Flores's are 4/3 and 16/15 of it.
    let asked = 1.0 - 1e-4;
    for &(_, value) in DampingLaw::ITEMS.iter().filter(|item| item.1 != DampingLaw::Hertz.value()) {
        let law = DampingLaw::from_value(value).expect("a law");
        let share = match law {
            DampingLaw::LeeWang => 0.5,
            DampingLaw::Gonthier => 4.0 / 3.0,
            DampingLaw::Flores => 16.0 / 15.0,
            _ => 1.0,
        };
        let found = factor(law, asked) / (1.5e-4 * share);
        assert!((found - 1.0).abs() < 3e-4, "{law:?}: {found}");
    }
}

#[test]
fn the_exact_law_has_no_step_where_its_series_takes_over() {
    let chi = |short: f64| factor(DampingLaw::ZhangSharf, 1.0 - short) / short;
    let mut last = chi(1e-7);
    for i in 1..=4000 {
        let short = 1e-7 * 10f64.powf(f64::from(i) / 1000.0);
        let next = chi(short);
        // χ/(1 − e) = 3/2·(1 + O(1 − e)) rises slowly; the root's rounding is 2e-16/χ² of it.
        let bound = 0.01 * short + 1e-15 / (short * short) + 1e-9;
        assert!((next - last).abs() < bound, "at 1 − {short:e}: {last} then {next}");
        last = next;
    }
}
