//! Faces on elastic foundations: closed forms against quadrature and exact arithmetic, stiffness of the
//! half-space.

use super::chance::Chance;
use slidercrank::model::joint::foundation::{ContactZone, FacePenetration, half_space_stiffness};

/// ∫max(0, δ)/(2a), ∫x·max(0, δ)/(2a) and ∫max(0, δ)²/(2a) by the midpoint rule.
fn quadrature(bed: &FacePenetration, cells: usize) -> [f64; 3] {
    let mut sums = [0.0; 3];
    for i in 0..cells {
        let x = bed.half * ((2 * i + 1) as f64 / cells as f64 - 1.0);
        let depth = (bed.middle + bed.slope * x).max(0.0);
        for (sum, term) in sums.iter_mut().zip([depth, x * depth, depth * depth]) {
            *sum += term / cells as f64;
        }
    }
    sums
}

#[test]
fn closed_forms_are_the_integrals() {
    const CELLS: usize = 20_000;
    let mut chance = Chance(7);
    let mut kinds = [0; 3];
    for _ in 0..1000 {
        let half = 10f64.powf(chance.between(-3.0, 0.0));
        let rise = 10f64.powf(chance.between(-8.0, -4.0));
        let bed =
            FacePenetration { half, middle: rise * chance.between(-1.5, 1.5), slope: chance.sign() * rise / half };
        let ContactZone { mean, centre } = bed.pressed();
        let [wanted, moment, square] = quadrature(&bed, CELLS);
        // Exact in a cell that is all in or all out; the cell that the edge of the pressed part lies in
        // errs by the square of δ's change in a cell, and x·δ and δ² by their curvature.
        let cell = 2.0 * rise / CELLS as f64;
        let share = 1.0 / CELLS as f64;
        assert!((mean - wanted).abs() <= cell * share + 1e-13 * rise, "{bed:?}: {mean:e}, {wanted:e}");
        assert!(
            (mean * centre - moment).abs() <= half * 2.0 * cell * share + 1e-13 * rise * half,
            "{bed:?}: {centre:e}"
        );
        assert!((bed.mean_square() - square).abs() <= cell * cell + 1e-13 * rise * rise, "{bed:?}: {square:e}");
        kinds[usize::from(mean > 0.0) + usize::from(bed.middle >= rise)] += 1;
    }
    assert!(kinds.into_iter().all(|count| count > 100), "open, partly and wholly pressed: {kinds:?}");
}

/// Mean, centre and mean square of a bed whose half is 1 and whose ends are at these multiples of a
/// unit, from integers that hold them exactly.
fn exact(front: i128, rear: i128) -> [f64; 3] {
    let ratio = |n: i128, d: i128| n as f64 / d as f64;
    let (deep, shallow) = (front.max(rear), front.min(rear));
    let sign = if front >= rear { 1.0 } else { -1.0 };
    if deep <= 0 {
        [0.0, sign, 0.0]
    } else if shallow >= 0 {
        let (sum, difference) = (deep + shallow, deep - shallow);
        [ratio(sum, 2), sign * ratio(difference, 3 * sum), ratio(deep * deep + deep * shallow + shallow * shallow, 3)]
    } else {
        let spread = deep - shallow;
        // (half − length/3), length = 2·deep/spread.
        let centre = ratio(3 * spread - 2 * deep, 3 * spread);
        [ratio(deep * deep, 2 * spread), sign * centre, ratio(deep * deep, 1) * ratio(deep, 3 * spread)]
    }
}

#[test]
fn closed_forms_lose_no_digits() {
    let large = 1 << 50;
    let mut chance = Chance(11);
    let mut ends = vec![
        // Nearly parallel: a tilt of one unit in 2^50 of the depth.
        (large + 1, large - 1),
        (large - 1, large + 1),
        (large, large),
        // One corner just touches, the other is far out; or just touches too.
        (1, 1 - large),
        (1 - large, 1),
        (1, -1),
        (1, 1),
        // The second corner just touches.
        (large, 0),
        (large, 2),
        (large, -2),
        (0, large),
        (-2, large),
        // It does not, or the first does not yet: the centre is where pressure begins.
        (0, 0),
        (0, -large),
    ];
    for _ in 0..100_000 {
        let mut end = || (chance.sign() * 2f64.powf(chance.between(0.0, 49.0))) as i128 * 2;
        ends.push((end(), end()));
    }
    for (front, rear) in ends {
        let unit = 2f64.powi(-70);
        let (middle, rise) = ((front + rear) / 2, (front - rear) / 2);
        let bed = FacePenetration { half: 1.0, middle: middle as f64 * unit, slope: rise as f64 * unit };
        let ContactZone { mean, centre } = bed.pressed();
        let [wanted_mean, wanted_centre, wanted_square] = exact(front, rear);
        for (name, found, wanted) in [
            ("mean", mean, wanted_mean * unit),
            ("centre", centre, wanted_centre),
            ("mean square", bed.mean_square(), wanted_square * unit * unit),
        ] {
            // A handful of operations, each rounded once.
            let bound = 8.0 * f64::EPSILON * wanted.abs();
            assert!((found - wanted).abs() <= bound, "{front}, {rear}: {name} {found:e}, not {wanted:e}");
        }
    }
}

#[test]
fn a_face_turned_round_is_pressed_alike() {
    let mut chance = Chance(13);
    for _ in 0..10_000 {
        let bed =
            FacePenetration { half: 0.02, middle: chance.between(-1e-5, 1e-5), slope: chance.between(-1e-3, 1e-3) };
        let other = FacePenetration { slope: -bed.slope, ..bed };
        let (one, two) = (bed.pressed(), other.pressed());
        assert_eq!((one.mean, one.centre), (two.mean, -two.centre));
        assert_eq!(bed.mean_square(), other.mean_square());
        assert!(one.centre.abs() <= bed.half);
    }
}

#[test]
fn a_square_on_the_half_space() {
    // m(1) = (4·asinh 1 + (2/3)(2 − 2^1.5))/π, asinh 1 = ln(1 + √2).
    let m = (4.0 * (1.0 + 2f64.sqrt()).ln() + 2.0 / 3.0 * (2.0 - 2f64.powf(1.5))) / std::f64::consts::PI;
    assert!((m - 0.9464).abs() < 1e-4, "{m}");
    let compliance = 2.0 * (1.0 - 0.09) / 207e9;
    let wanted = 0.03 / (m * compliance);
    let found = half_space_stiffness(0.03, 0.03, compliance);
    assert!((found - wanted).abs() < 1e-14 * wanted, "{found:e}, not {wanted:e}");
}

#[test]
fn a_long_strip_on_the_half_space() {
    for r in [1e2f64, 1e4, 1e6] {
        // asinh r = ln 2r + 1/(4r²), asinh(1/r) = 1/r − 1/(6r³), and 1 + r³ − (1 + r²)^1.5 = 1 − 3r/2 − 3/(8r),
        // each up to 1/r³: π·r^1.5·m = 2r·ln 2r + r + 2/3 + (1/2 − 1/3 − 1/4)/r.
        let sum = 2.0 * r * (2.0 * r).ln() + r + 2.0 / 3.0 - 1.0 / (12.0 * r);
        let wanted = std::f64::consts::PI * r / sum; // per length and 1/compliance
        for (length, width) in [(1.0, 1.0 / r), (1.0 / r, 1.0)] {
            let found = half_space_stiffness(length, width, 1.0);
            // The rest is of the order 1/r³ in a sum of 2r·ln 2r.
            let bound = 1.0 / r.powi(4) + 16.0 * f64::EPSILON;
            assert!((found / wanted - 1.0).abs() < bound, "{r}: {found:e}, not {wanted:e}");
        }
    }
}
