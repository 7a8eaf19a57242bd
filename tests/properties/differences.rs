//! Derivatives by differences, with an estimate of their own error.

/// Halvings of the first increment.
const LEVELS: usize = 7;
/// Each increment is this share of the one before.
const SHARE: f64 = 0.5;

/// A derivative, and how wrong it may be.
#[derive(Clone, Copy, Debug)]
pub struct Derivative {
    pub value: f64,
    pub error: f64,
}

/// f'(0) of every component of `f`, by central differences extrapolated to the increment 0 from
/// `first` on; of the columns of the extrapolation the entry that changes least (C. J. F. Ridders, Adv. Eng. Softw. 4
/// (1982) 75).
pub fn derivatives(first: f64, f: impl Fn(f64) -> Vec<f64>) -> Vec<Derivative> {
    let mut increment = first;
    let mut before: Vec<Vec<f64>> = vec![];
    let mut best: Vec<Derivative> = vec![];
    for level in 0..LEVELS {
        let (plus, minus) = (f(increment), f(-increment));
        let mut row = vec![plus.iter().zip(&minus).map(|(p, m)| (p - m) / (2.0 * increment)).collect::<Vec<f64>>()];
        best.resize(plus.len(), Derivative { value: f64::NAN, error: f64::INFINITY });
        let mut power = 1.0;
        for column in 0..level {
            power *= SHARE * SHARE;
            let better: Vec<f64> = row[column].iter().zip(&before[column]).map(|(new, old)| (new - power * old) / (1.0 - power)).collect();
            for (i, &value) in better.iter().enumerate() {
                let error = f64::max((value - row[column][i]).abs(), (value - before[column][i]).abs());
                // Equal to the bit by chance, it is still a difference of rounded numbers.
                let rounding = f64::EPSILON * plus[i].abs().max(minus[i].abs()) / increment;
                if error + rounding < best[i].error {
                    best[i] = Derivative { value, error: error + rounding };
                }
            }
            row.push(better);
        }
        before = row;
        increment *= SHARE;
    }
    best
}
