//! Branches of periodic points of maps whose bifurcations are known in closed form.

use super::ball::{E, G, doubling};
use anyhow::{Context, Result};
use fmu_harness::dynamics::continuation::{Bifurcation, Branch, Continuation};
use fmu_harness::dynamics::orbit::{Orbit, Return, ReturnMap, multipliers};
use nalgebra::{DMatrix, DVector, Matrix2, Vector2};
use slidercrank::simulation::Phase;
use std::f64::consts::{FRAC_PI_3, PI, TAU};

/// Noticeable differences of these maps.
const SCALES: [f64; 2] = [1e-3; 2];

/// An image, and its derivatives by the point and by the parameter.
type Image = (Vector2<f64>, Matrix2<f64>, Vector2<f64>);

/// A map of the plane.
struct Plane {
    name: &'static str,
    map: fn(f64, Vector2<f64>) -> Option<Image>,
}

impl ReturnMap for Plane {
    fn name(&self) -> &str {
        self.name
    }

    fn scales(&self) -> &[f64] {
        &SCALES
    }

    fn apply(&self, value: f64, phase: &Phase, turns: usize) -> Result<Return> {
        let start = Vector2::from_row_slice(&phase.states);
        let (mut point, mut by_point, mut by_value) = (start, Matrix2::identity(), Vector2::zeros());
        let mut halfway = start;
        for turn in 1..=turns {
            let (image, slope, push) = (self.map)(value, point).context("no image")?;
            (point, by_point, by_value) = (image, slope * by_point, slope * by_value + push);
            if turn == turns / 2 {
                halfway = point;
            }
        }
        let scaled = |v: Vector2<f64>| DVector::from_column_slice((v / SCALES[0]).as_slice());
        let by_unknowns = DMatrix::from_column_slice(2, 2, by_point.as_slice());
        let orbit = Orbit {
            value,
            phase: phase.clone(),
            turns,
            multipliers: multipliers(&by_unknowns),
            apart: scaled(halfway - start),
            visits: vec![],
            events: 0,
        };
        let (miss, by_parameter) = (scaled(point - start), scaled(by_value));
        Ok(Return { miss, by_unknowns, by_parameter, unknowns: vec![0, 1], orbit })
    }
}

/// The branches through the periodic point near `start` at the first value.
fn branches(map: &Plane, [from, to]: [f64; 2], start: [f64; 2], doublings: usize) -> Vec<Branch> {
    let phase = Phase { time: 0.0, states: start.to_vec(), approach: vec![] };
    let start = map.solve(from, &phase, 1).expect("a fixed point");
    Continuation { map, from, to, doublings }.follow(start, |_| {}).expect("branches")
}

/// Asserts that a branch has these bifurcations in this order, at these values to within 1e-8.
fn assert_found(branch: &Branch, known: &[(Bifurcation, f64)]) {
    let found: Vec<_> = branch.found.iter().map(|found| (found.kind, found.orbit.value)).collect();
    assert_eq!(found.len(), known.len(), "{found:?} for {known:?}");
    for ((kind, value), (known, at)) in found.iter().zip(known) {
        assert!(kind == known && (value - at).abs() < 1e-8, "{kind} at {value} for {known} at {at}");
    }
}

/// x' = a − x² + b·y, y' = x (M. Hénon, Commun. Math. Phys. 50 (1976) 69). A fixed point has x² + (1 − b)·x = a and the
/// multipliers μ² + 2·x·μ − b = 0: μ = 1 where 2·x = −(1 − b), and μ = −1 where 2·x = 1 − b.
fn henon(a: f64, p: Vector2<f64>) -> Option<Image> {
    let image = Vector2::new(a - p.x * p.x + B * p.y, p.x);
    Some((image, Matrix2::new(-2.0 * p.x, B, 1.0, 0.0), Vector2::new(1.0, 0.0)))
}

const B: f64 = 0.3;

#[test]
fn henon_s_map_folds_and_doubles_its_period_where_it_is_known_to() {
    use Bifurcation::{Fold, PeriodDoubling};
    let map = Plane { name: "a", map: henon };
    let (fold, doubled) = (-0.25 * (1.0 - B).powi(2), 0.75 * (1.0 - B).powi(2));
    // Down to the fold and back up with the saddle, whose multiplier of −b/μ never is −1.
    let down = branches(&map, [0.3, -0.5], [0.4, 0.4], 0);
    assert_found(&down[0], &[(Fold, fold)]);
    let last = down[0].orbits.last().expect("a motion");
    assert!(last.value > 0.3 && !last.is_stable(), "{}", last.value);
    // The points of period 2 have x₁ + x₂ = 1 − b and x₁·x₂ = (1 − b)² − a, and the trace 4·x₁·x₂ + 2·b of determinant b².
    let up = branches(&map, [0.3, 1.0], [0.4, 0.4], 2);
    let again = (1.0 - B).powi(2) + 0.25 * (1.0 + B).powi(2);
    assert_found(&up[0], &[(PeriodDoubling, doubled)]);
    assert_eq!(up.iter().map(|branch| branch.turns).collect::<Vec<_>>(), [1, 2, 4]);
    assert_found(&up[1], &[(PeriodDoubling, again)]);
    for orbit in &up[1].orbits {
        let [x, y] = [orbit.phase.states[0], orbit.phase.states[1]];
        assert!((x + y - (1.0 - B)).abs() < 1e-7 && (x * y - (1.0 - B).powi(2) + orbit.value).abs() < 1e-7);
        assert_eq!(orbit.is_stable(), orbit.value < again, "{}", orbit.value);
    }
}

/// Motions of period 2 and 4 of Hénon's map, followed towards the doublings that they come from.
#[test]
fn a_branch_that_begins_on_a_doubled_motion_goes_on_in_half_its_period() {
    use Bifurcation::{Fold, PeriodDoubling};
    let map = Plane { name: "a", map: henon };
    let (fold, doubled) = (-0.25 * (1.0 - B).powi(2), 0.75 * (1.0 - B).powi(2));
    let again = (1.0 - B).powi(2) + 0.25 * (1.0 + B).powi(2);
    for (from, period, turns) in [(0.6, 2, &[2, 1, 1][..]), (0.95, 4, &[4, 2, 2, 1, 1])] {
        // The motion on which a settled one repeats, taken for one of twice the period.
        let mut point = Vector2::new(0.4, 0.4);
        for _ in 0..20_000 {
            point = henon(from, point).expect("an image").0;
        }
        let phase = Phase { time: 0.0, states: point.as_slice().to_vec(), approach: vec![] };
        let start = map.shortest(map.solve(from, &phase, 2 * period).expect("a periodic point"));
        assert_eq!(start.orbit.turns, period);
        for doublings in [0, 1] {
            let continuation = Continuation { map: &map, from, to: -0.5, doublings };
            let branches = continuation.follow(start.clone(), |_| {}).expect("branches");
            assert_eq!(branches.iter().map(|branch| branch.turns).collect::<Vec<_>>(), turns, "{doublings}");
            let (longer, of_one) = branches.split_at(branches.len() - 2);
            let (there, back) = (&of_one[0], &of_one[1]);
            assert_found(there, &[(PeriodDoubling, doubled), (Fold, fold)]);
            assert_found(back, &[]);
            assert!(back.orbits.iter().all(|orbit| !orbit.is_stable() && orbit.value > doubled - 1e-9));
            assert_found(&longer[0], &[]);
            assert!(longer[0].orbits.iter().all(Orbit::is_stable));
            let met: Vec<f64> = longer.iter().filter_map(|branch| branch.meets).collect();
            let known = if period == 4 { &[again, doubled][..] } else { &[doubled] };
            assert_eq!(met.len(), known.len());
            assert!(met.iter().zip(known).all(|(met, known)| (met - known).abs() < 1e-8), "{met:?} for {known:?}");
        }
    }
}

/// Hénon's map over p with a = 3·(1 − b)²/4 + (1 − p²)/10: its period doubles at p = −1 and halves at p = 1.
fn bubble(p: f64, point: Vector2<f64>) -> Option<Image> {
    let (image, by_point, by_a) = henon(0.75 * (1.0 - B).powi(2) + 0.1 * (1.0 - p * p), point)?;
    Some((image, by_point, -0.2 * p * by_a))
}

#[test]
fn a_doubled_branch_ends_at_the_doubling_that_it_meets_and_is_followed_once() {
    let map = Plane { name: "p", map: bubble };
    for [from, to] in [[-1.5, 1.5], [1.5, -1.3]] {
        let branches = branches(&map, [from, to], [0.2, 0.2], 2);
        assert_eq!(branches.iter().map(|branch| branch.turns).collect::<Vec<_>>(), [1, 2]);
        assert_found(&branches[0], &[from.signum(), -from.signum()].map(|p| (Bifurcation::PeriodDoubling, p)));
        assert_found(&branches[1], &[]);
        let meets = branches[1].meets.expect("a doubling");
        assert!((meets + from.signum()).abs() < 1e-8, "{meets}: {}", branches[1].end);
        for orbit in &branches[1].orbits {
            // x₁ − x₂ = √(4·a − 3·(1 − b)²), of which 0 is period 1.
            let apart = (0.4 * (1.0 - orbit.value * orbit.value)).sqrt() / SCALES[0];
            assert!((orbit.apart[0].abs() - apart).abs() < 1e-3 * apart, "{}: {}", orbit.value, orbit.apart);
        }
    }
}

/// x' = r·x·(1 − y), y' = x (J. Maynard Smith, Mathematical Ideas in Biology, Cambridge 1968). The fixed point 1 − 1/r has
/// μ² − μ + r − 1 = 0: two complex multipliers of modulus √(r − 1), which are exp(±iπ/3) at r = 2.
fn delayed(r: f64, p: Vector2<f64>) -> Option<Image> {
    let image = Vector2::new(r * p.x * (1.0 - p.y), p.x);
    Some((image, Matrix2::new(r * (1.0 - p.y), -r * p.x, 1.0, 0.0), Vector2::new(p.x * (1.0 - p.y), 0.0)))
}

#[test]
fn the_delayed_logistic_map_has_its_neimark_sacker_bifurcation_at_2() {
    let map = Plane { name: "r", map: delayed };
    let found = branches(&map, [1.6, 2.4], [0.375, 0.375], 1);
    assert_eq!(found.len(), 1);
    assert_found(&found[0], &[(Bifurcation::NeimarkSacker, 2.0)]);
    let multiplier = found[0].found[0].orbit.largest();
    assert!((multiplier.norm() - 1.0).abs() < 1e-8 && (multiplier.arg().abs() - FRAC_PI_3).abs() < 1e-8);
    for orbit in &found[0].orbits {
        assert!((orbit.largest().norm() - (orbit.value - 1.0).sqrt()).abs() < 1e-8);
    }
}

/// The bouncing ball of [`ball`](super::ball) from one impact to the next: phase of the table and speed after impact.
fn bounce(gamma: f64, p: Vector2<f64>) -> Option<Image> {
    let amplitude = gamma * G / (TAU * TAU);
    let table = |t: f64| {
        let (sin, cos) = (TAU * t).sin_cos();
        [amplitude * sin, amplitude * TAU * cos, -amplitude * TAU * TAU * sin]
    };
    let (launch, speed) = (table(p.x), p.y);
    let mut flight = 2.0 * speed / G;
    for _ in 0..30 {
        let there = table(p.x + flight);
        let gap = launch[0] + speed * flight - 0.5 * G * flight * flight - there[0];
        flight -= gap / (speed - G * flight - there[1]);
    }
    let there = table(p.x + flight);
    let arrival = speed - G * flight;
    let meeting = arrival - there[1];
    // Changes of the flight by launch, speed and Γ; of the time of impact; and of the speed after it.
    let flights = [there[1] - launch[1], -flight, (there[0] - launch[0]) / gamma].map(|change| change / meeting);
    let later = [1.0 + flights[0], flights[1], flights[2]];
    let own = [0.0, 1.0, 0.0];
    let pushed = [0.0, 0.0, there[1] / gamma];
    let faster: [f64; 3] =
        std::array::from_fn(|i| (1.0 + E) * (there[2] * later[i] + pushed[i]) - E * (own[i] - G * flights[i]));
    let image = Vector2::new(p.x + flight - 1.0, (1.0 + E) * there[1] - E * arrival);
    let slope = Matrix2::new(later[0], later[1], faster[0], faster[1]);
    (meeting < 0.0).then_some((image, slope, Vector2::new(later[2], faster[2])))
}

#[test]
fn the_bouncing_ball_begins_in_a_fold_and_doubles_its_period_where_it_is_known_to() {
    let map = Plane { name: "gamma", map: bounce };
    let begins = PI * (1.0 - E) / (1.0 + E);
    let start = [(begins / 0.6).acos() / TAU, 0.5 * G];
    let down = branches(&map, [0.6, 0.1], start, 0);
    assert_found(&down[0], &[(Bifurcation::Fold, begins)]);
    let up = branches(&map, [0.6, 1.1], start, 0);
    assert_found(&up[0], &[(Bifurcation::PeriodDoubling, doubling())]);
    for orbit in &up[0].orbits {
        let size = orbit.multipliers.iter().map(|multiplier| multiplier.norm()).product::<f64>();
        assert!((size - E * E).abs() < 1e-8, "{size}");
    }
}
