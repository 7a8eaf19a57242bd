//! Impulses of rigid contacts: complementarity in the normal direction, Coulomb friction in the tangential direction.
//!
//! With G = Wᵀ·M⁻¹·W (Delassus matrix) and ξ = G·Λ + b, every contact requires
//! 0 ≤ ξ_N ⟂ Λ_N ≥ 0 and −Λ_T ∈ μ·Λ_N·Sgn(ξ_T).
//! With Λ_T = β⁺ − β⁻ and the sliding speed σ, this is a linear complementarity problem with a copositive matrix, which
//! Lemke's method solves (D. E. Stewart, J. C. Trinkle, Int. J. Numer. Methods Eng. 39 (1996) 2673; M. Anitescu, F. A.
//! Potra, Nonlinear Dynamics 14 (1997) 231):
//! ξ_N ≥ 0 ⟂ Λ_N ≥ 0, σ + ξ_T ≥ 0 ⟂ β⁺ ≥ 0, σ − ξ_T ≥ 0 ⟂ β⁻ ≥ 0, μ·Λ_N − β⁺ − β⁻ ≥ 0 ⟂ σ ≥ 0.
//! G is singular if contacts are redundant. The motion is then unique, but the impulses need not be, and one set of
//! them is returned. Every solution is checked against the contact laws before it is returned.

mod continued;
mod lemke;

pub use lemke::{LinearComplementarity, MAX_UNKNOWNS};

/// Maximum number of contacts: each has a normal impulse, two tangential impulses and a sliding speed as unknowns.
pub const MAX_CONTACTS: usize = MAX_UNKNOWNS / 4;

/// Largest accepted violation of the contact laws, with velocities and impulses scaled to 1.
const MAX_VIOLATION: f64 = 1e-8;
/// Largest accepted violation for contacts that keep their state from the step before.
const MAX_CONTINUED_VIOLATION: f64 = 1e-11;
/// A tangential direction whose response to impulses is below this share of the normal response counts as immovable.
const IMMOVABLE: f64 = 1e-12;
/// Number of covering columns that are tried; the first nearly always succeeds.
const MAX_COVERS: usize = 8;
/// The golden ratio less 1: the fractional parts of its multiples fill 0 to 1 evenly.
const GOLDEN: f64 = 0.618_033_988_749_895;

/// One number for the normal and one for the tangential direction of each contact.
pub type Pairs = [[f64; 2]; MAX_CONTACTS];
/// Index of the normal direction.
pub const NORMAL: usize = 0;
/// Index of the tangential direction.
pub const TANGENTIAL: usize = 1;

/// The contacts that are closed.
#[derive(Clone, Debug, Default)]
pub struct ActiveContacts {
    /// Number of closed contacts; they are the first entries of all lists.
    pub count: usize,
    /// [1/kg] G: `delassus[i][a][j][b]` is the velocity in direction `a` of contact `i` from a unit impulse in
    /// direction `b` of contact `j`. Symmetric, positive semidefinite.
    pub delassus: [[[[f64; 2]; MAX_CONTACTS]; 2]; MAX_CONTACTS],
    /// [m/s] b: velocities without impulses.
    pub bias: Pairs,
    /// Friction coefficient μ of each contact.
    pub friction: [f64; MAX_CONTACTS],
}

/// The problem in dimensionless form: Λ·s/B and ξ/(s·B) replace Λ and ξ, with s = √(diagonal of G) and B the largest
/// scaled bias.
struct Scaled<'a> {
    problem: &'a ActiveContacts,
    scale: Pairs,
    size: f64,
}

impl ActiveContacts {
    /// [N·s] The impulses Λ of all contacts; `None` if no solution is found or the problem is not finite. If impulses
    /// `before` are given, the solver first assumes that every contact sticks, slides or is open as it was with them.
    pub fn impulses(&self, before: &Pairs) -> Option<Pairs> {
        let scaled = Scaled::new(self)?;
        if scaled.size == 0.0 {
            return Some(Pairs::default());
        }
        if before.iter().any(|impulse| impulse[NORMAL] > 0.0) {
            let found = scaled.continued(before).filter(|found| scaled.violation(found) <= MAX_CONTINUED_VIOLATION);
            if let Some(found) = found {
                return Some(scaled.impulses(&found));
            }
        }
        let linear = scaled.linear();
        let solutions =
            (0..MAX_COVERS).filter_map(|cover| linear.solve(|i| 1.0 + cover as f64 * (i as f64 * GOLDEN).fract()));
        let mut found = solutions.map(|z| scaled.signed(&z));
        found.find(|found| scaled.violation(found) <= MAX_VIOLATION).map(|found| scaled.impulses(&found))
    }
}

impl<'a> Scaled<'a> {
    /// `None` if a number is not finite or a normal direction does not respond to impulses.
    fn new(problem: &'a ActiveContacts) -> Option<Self> {
        let mut scale = [[1.0; 2]; MAX_CONTACTS];
        let mut size = 0.0f64;
        for (i, scale) in scale.iter_mut().enumerate().take(problem.count) {
            let diagonal = |part: usize| problem.delassus[i][part][i][part];
            let [normal, tangent] = [diagonal(NORMAL), diagonal(TANGENTIAL)];
            let answers = normal > 0.0 && normal.is_finite() && tangent.is_finite();
            if !answers {
                return None;
            }
            scale[NORMAL] = normal.sqrt();
            scale[TANGENTIAL] = tangent.max(IMMOVABLE * normal).sqrt();
            for (bias, scale) in problem.bias[i].iter().zip(scale) {
                size = size.max((bias / *scale).abs());
            }
        }
        size.is_finite().then_some(Self { problem, scale, size })
    }

    fn count(&self) -> usize {
        self.problem.count
    }

    /// Friction coefficient between scaled impulses.
    fn friction(&self, i: usize) -> f64 {
        self.problem.friction[i] * self.scale[i][TANGENTIAL] / self.scale[i][NORMAL]
    }

    fn delassus(&self, i: usize, a: usize, j: usize, b: usize) -> f64 {
        self.problem.delassus[i][a][j][b] / (self.scale[i][a] * self.scale[j][b])
    }

    fn bias(&self, i: usize, part: usize) -> f64 {
        self.problem.bias[i][part] / (self.scale[i][part] * self.size)
    }

    /// The impulses among the unknowns of the linear problem, each as contact, direction and sign: all Λ_N, then β⁺ and
    /// β⁻ of every contact with friction. The sliding speeds follow them.
    fn parts(&self) -> impl Iterator<Item = (usize, usize, f64)> + '_ {
        let normal = (0..self.count()).map(|i| (i, NORMAL, 1.0));
        normal.chain(self.with_friction().flat_map(|i| [(i, TANGENTIAL, 1.0), (i, TANGENTIAL, -1.0)]))
    }

    /// The indices of the contacts with friction.
    fn with_friction(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.count()).filter(|&i| self.problem.friction[i] > 0.0)
    }

    fn linear(&self) -> LinearComplementarity {
        let forces = self.parts().count();
        let mut linear = LinearComplementarity {
            size: forces + self.with_friction().count(),
            matrix: [[0.0; MAX_UNKNOWNS]; MAX_UNKNOWNS],
            vector: [0.0; MAX_UNKNOWNS],
        };
        for (row, (i, a, side)) in self.parts().enumerate() {
            linear.vector[row] = side * self.bias(i, a);
            for (column, (j, b, other)) in self.parts().enumerate() {
                linear.matrix[row][column] = side * other * self.delassus(i, a, j, b);
            }
        }
        for (k, i) in self.with_friction().enumerate() {
            let (sigma, beta) = (forces + k, self.count() + 2 * k);
            linear.matrix[sigma][i] = self.friction(i);
            for beta in [beta, beta + 1] {
                linear.matrix[sigma][beta] = -1.0;
                linear.matrix[beta][sigma] = 1.0;
            }
        }
        linear
    }

    /// Scaled impulses from the unknowns of the linear problem.
    fn signed(&self, z: &[f64; MAX_UNKNOWNS]) -> Pairs {
        let mut impulses = Pairs::default();
        for ((i, part, side), z) in self.parts().zip(z) {
            impulses[i][part] += side * z;
        }
        impulses
    }

    /// Largest violation of the contact laws, as the distance of Λ from its projection on the admissible set: Λ_N −
    /// max(0, Λ_N − ξ_N) and Λ_T − clamp(Λ_T − ξ_T, ±μ·Λ_N). Both vanish at a solution and nowhere else.
    fn violation(&self, impulses: &Pairs) -> f64 {
        let mut worst = 0.0f64;
        for (i, impulse) in impulses.iter().enumerate().take(self.count()) {
            let velocity = |part: usize| {
                let row = (0..self.count()).flat_map(|j| [(j, NORMAL), (j, TANGENTIAL)]);
                self.bias(i, part) + row.map(|(j, b)| self.delassus(i, part, j, b) * impulses[j][b]).sum::<f64>()
            };
            let normal = impulse[NORMAL].min(velocity(NORMAL));
            let most = self.friction(i) * impulse[NORMAL].max(0.0);
            let tangent = impulse[TANGENTIAL] - (impulse[TANGENTIAL] - velocity(TANGENTIAL)).clamp(-most, most);
            for violation in [normal.abs(), tangent.abs()] {
                worst = if violation.is_nan() { f64::INFINITY } else { worst.max(violation) };
            }
        }
        worst
    }

    fn impulses(&self, scaled: &Pairs) -> Pairs {
        let mut impulses = Pairs::default();
        for ((impulse, scaled), scale) in impulses.iter_mut().zip(scaled).zip(self.scale).take(self.count()) {
            impulse[NORMAL] = scaled[NORMAL] * self.size / scale[NORMAL];
            impulse[TANGENTIAL] = scaled[TANGENTIAL] * self.size / scale[TANGENTIAL];
        }
        impulses
    }
}
