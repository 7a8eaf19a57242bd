//! The impulses of rigid contacts against all that they might be: every contact open, sticking or slipping either way.

use nalgebra::{DMatrix, DVector};
use slidercrank::integrator::complementarity::{ActiveContacts, MAX_CONTACTS, NORMAL, Pairs, TANGENTIAL};

/// Pseudo-random numbers, the same on every run: xorshift64*, G. Marsaglia 2003, S. Vigna 2016.
struct Dice(u64);

impl Dice {
    /// In −1 .. 1.
    fn throw(&mut self) -> f64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        (self.0.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    /// A whole number below `count`.
    fn below(&mut self, count: usize) -> usize {
        ((0.5 + 0.5 * self.throw()) * count as f64) as usize % count
    }
}

/// A body of `freedoms` unit masses that arrives with the velocities `u`: rows of W, normal and tangential by turns.
struct Impact {
    rows: DMatrix<f64>,
    arriving: DVector<f64>,
    restitution: f64,
    friction: Vec<f64>,
}

impl Impact {
    fn random(dice: &mut Dice, freedoms: usize, count: usize, friction: f64, restitution: f64) -> Self {
        let rows = DMatrix::from_fn(2 * count, freedoms, |_, _| dice.throw());
        let arriving = DVector::from_fn(freedoms, |_, _| 3.0 * dice.throw());
        let friction = (0..count).map(|_| friction * (0.5 + 0.5 * dice.throw())).collect();
        Self { rows, arriving, restitution, friction }
    }

    fn count(&self) -> usize {
        self.friction.len()
    }

    fn delassus(&self) -> DMatrix<f64> {
        &self.rows * self.rows.transpose()
    }

    /// ξ without impulses.
    fn bias(&self) -> DVector<f64> {
        let mut bias = &self.rows * &self.arriving;
        for i in 0..self.count() {
            bias[2 * i] *= 1.0 + self.restitution;
        }
        bias
    }

    fn touching(&self) -> ActiveContacts {
        let mut touching = ActiveContacts { count: self.count(), ..ActiveContacts::default() };
        let (delassus, bias) = (self.delassus(), self.bias());
        for i in 0..2 * self.count() {
            touching.bias[i / 2][i % 2] = bias[i];
            for j in 0..2 * self.count() {
                touching.delassus[i / 2][i % 2][j / 2][j % 2] = delassus[(i, j)];
            }
        }
        touching.friction[..self.count()].copy_from_slice(&self.friction);
        touching
    }

    fn vector(&self, impulses: &Pairs) -> DVector<f64> {
        DVector::from_fn(2 * self.count(), |i, _| impulses[i / 2][i % 2])
    }

    /// Kinetic energy that the impulses take away.
    fn loss(&self, impulses: &Pairs) -> f64 {
        let after = &self.arriving + self.rows.transpose() * self.vector(impulses);
        0.5 * (self.arriving.norm_squared() - after.norm_squared())
    }

    /// By how much the laws are violated, told contact by contact.
    fn violation(&self, impulses: &Pairs) -> f64 {
        let velocity = self.delassus() * self.vector(impulses) + self.bias();
        let mut worst = 0.0f64;
        for i in 0..self.count() {
            let [normal, tangential] = impulses[i];
            let (gap_rate, sliding) = (velocity[2 * i], velocity[2 * i + 1]);
            let most = self.friction[i] * normal;
            worst = worst.max(-normal).max(-gap_rate).max(normal.min(gap_rate)).max(tangential.abs() - most);
            if sliding.abs() > 1e-9 {
                worst = worst.max((tangential + most.copysign(sliding)).abs());
            }
        }
        worst
    }

    /// All solutions that some choice of open, sticking, slipping forward and backward gives.
    fn all(&self) -> Vec<Pairs> {
        let (delassus, bias) = (self.delassus(), self.bias());
        let mut found = vec![];
        for choice in 0..4usize.pow(self.count() as u32) {
            // Impulses are `basis` times as many unknowns as equations.
            let mut unknowns: Vec<DVector<f64>> = vec![];
            let mut equations = vec![];
            for i in 0..self.count() {
                let unit = |normal: f64, tangential: f64| {
                    let mut vector = DVector::zeros(2 * self.count());
                    (vector[2 * i], vector[2 * i + 1]) = (normal, tangential);
                    vector
                };
                match choice / 4usize.pow(i as u32) % 4 {
                    0 => {}
                    1 => {
                        unknowns.extend([unit(1.0, 0.0), unit(0.0, 1.0)]);
                        equations.extend([2 * i, 2 * i + 1]);
                    }
                    way => {
                        unknowns.push(unit(1.0, if way == 2 { -self.friction[i] } else { self.friction[i] }));
                        equations.push(2 * i);
                    }
                }
            }
            if unknowns.is_empty() {
                found.push(Pairs::default());
                continue;
            }
            let basis = DMatrix::from_columns(&unknowns);
            let full = &delassus * &basis;
            let matrix = DMatrix::from_fn(equations.len(), equations.len(), |r, c| full[(equations[r], c)]);
            let right = DVector::from_fn(equations.len(), |r, _| -bias[equations[r]]);
            let Some(solution) = matrix.lu().solve(&right) else { continue };
            let vector = basis * solution;
            let mut impulses = Pairs::default();
            (0..2 * self.count()).for_each(|i| impulses[i / 2][i % 2] = vector[i]);
            found.push(impulses);
        }
        found.retain(|impulses| self.violation(impulses) < 1e-9);
        found
    }
}

fn apart(a: &Pairs, b: &Pairs) -> f64 {
    a.as_flattened().iter().zip(b.as_flattened()).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

#[test]
fn impulses_are_among_all_that_there_are() {
    let mut dice = Dice(0xC0_FFEE);
    let (mut alone, mut one_of_several, mut none) = (0, 0, 0);
    for case in 0..6000 {
        let count = 1 + dice.below(3);
        let freedoms = 2 * count + dice.below(3);
        let friction = [0.0, 0.05, 0.5, 2.0][case % 4];
        let impact = Impact::random(&mut dice, freedoms, count, friction, [0.0, 0.4, 1.0][case % 3]);
        let all = impact.all();
        let Some(found) = impact.touching().impulses(&Pairs::default()) else {
            assert!(all.is_empty(), "case {case}: {} solutions, none found", all.len());
            none += 1;
            continue;
        };
        assert!(impact.violation(&found) < 1e-7, "case {case}: {:e}", impact.violation(&found));
        let least = all.iter().map(|other| apart(&found, other)).fold(f64::INFINITY, f64::min);
        let size = 1.0 + found.as_flattened().iter().fold(0.0f64, |size, impulse| size.max(impulse.abs()));
        assert!(least < 1e-6 * size, "case {case}: {least:e} from the nearest of {}", all.len());
        if all.iter().all(|other| apart(&found, other) < 1e-6 * size) { alone += 1 } else { one_of_several += 1 }
    }
    println!("{alone} alone, {one_of_several} one of several, {none} without a solution");
    assert!(alone > 5000 && none == 0, "{alone} alone, {none} without a solution");
}

#[test]
fn redundant_contacts_have_impulses_too() {
    // Fewer freedoms than contacts: copies of a contact, contacts face to face, and contacts at random.
    let mut dice = Dice(0xFACE);
    let mut worst = 0.0f64;
    for case in 0..100_000 {
        let count = 2 + dice.below(MAX_CONTACTS - 1);
        let freedoms = 1 + dice.below(9);
        let friction = [0.0, 0.03, 0.3, 1.0, 5.0][case % 5];
        let mut impact = Impact::random(&mut dice, freedoms, count, friction, 0.0);
        for _ in 0..dice.below(count) {
            let (from, to) = (dice.below(count), dice.below(count));
            let side = if dice.throw() < 0.0 { -1.0 } else { 1.0 };
            for part in [NORMAL, TANGENTIAL] {
                let row = side * impact.rows.row(2 * from + part);
                impact.rows.set_row(2 * to + part, &row);
            }
        }
        if case % 7 == 0 {
            impact.arriving.fill(0.0);
        }
        let found = impact.touching().impulses(&Pairs::default());
        let found = found.unwrap_or_else(|| unreachable!("case {case}: {count} contacts, {freedoms} freedoms"));
        worst = worst.max(impact.violation(&found));
        assert!(impact.violation(&found) < 1e-6, "case {case}: {:e}", impact.violation(&found));
        assert!(impact.loss(&found) > -1e-9, "case {case}: gains {:e}", -impact.loss(&found));
    }
    println!("redundant contacts violate their laws by {worst:.1e}");
}

#[test]
fn contacts_that_go_on_as_they_were_have_the_same_impulses() {
    let mut dice = Dice(0xBEEF);
    let mut largest = 0.0f64;
    for case in 0..5000 {
        let count = 1 + dice.below(4);
        let mut impact = Impact::random(&mut dice, 2 * count + 1, count, [0.0, 0.1, 0.4][case % 3], 0.5);
        let before = impact.touching().impulses(&Pairs::default()).expect("independent contacts have impulses");
        // A little later, or something else altogether: the laws are the same.
        let change = [1e-6, 3.0][case % 2];
        impact.arriving.iter_mut().for_each(|velocity| *velocity += change * dice.throw());
        let found = impact.touching().impulses(&before).expect("impulses");
        let anew = impact.touching().impulses(&Pairs::default()).expect("impulses");
        assert!(impact.violation(&found) < 1e-7, "case {case}: {:e}", impact.violation(&found));
        if impact.all().len() == 1 {
            largest = largest.max(apart(&found, &anew));
        }
    }
    assert!(largest < 1e-6, "{largest:e}");
}
