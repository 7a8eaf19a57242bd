//! Derivatives by differences, with an estimate of their own error.

/// Increments, each half of the one before: a corner as near as 1e-5 of the first has no share in the last ones.
const LEVELS: usize = 20;
/// Weights of the differences over ±1, ±2, ±3 increments: exact on polynomials of degree six (B. Fornberg,
/// Math. Comp. 51 (1988) 699, table 1).
const WEIGHTS: [f64; 3] = [3.0 / 4.0, -3.0 / 20.0, 1.0 / 60.0];

/// A derivative, and how wrong it may be.
#[derive(Clone, Copy, Debug)]
pub struct Derivative {
    pub value: f64,
    pub error: f64,
}

/// f'(0) of every component of `f`, whose values are rounded by `noise`: of the increments from `first` on the one whose
/// difference differs least from those of its neighbours.
pub fn derivatives(first: f64, noise: &[f64], f: impl Fn(f64) -> Vec<f64>) -> Vec<Derivative> {
    let increments: Vec<f64> = (0..LEVELS).map(|level| first * 0.5f64.powi(level as i32)).collect();
    let slopes: Vec<Vec<f64>> = increments
        .iter()
        .map(|h| {
            let mut sum = vec![0.0; noise.len()];
            for (k, weight) in WEIGHTS.iter().enumerate() {
                let reach = h * (k + 1) as f64;
                let (plus, minus) = (f(reach), f(-reach));
                for ((sum, plus), minus) in sum.iter_mut().zip(plus).zip(minus) {
                    *sum += weight * (plus - minus) / h;
                }
            }
            sum
        })
        .collect();
    (0..noise.len())
        .map(|i| {
            let at = |level: usize| {
                let [longer, value, shorter] = [level - 1, level, level + 1].map(|level| slopes[level][i]);
                let apart = (value - longer).abs().max((value - shorter).abs());
                Derivative { value, error: apart + noise[i] / increments[level] }
            };
            (1..LEVELS - 1).map(at).min_by(|a, b| a.error.total_cmp(&b.error)).expect("some increments")
        })
        .collect()
}
