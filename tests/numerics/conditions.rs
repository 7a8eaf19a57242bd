//! The conditions of order of each explicit method, one for each rooted tree (J. C. Butcher, Numerical Methods for
//! Ordinary Differential Equations, 2016, 31).

use slidercrank::integrator::Tableau;
use slidercrank::integrator::methods::{BS3, DOP853, DOPRI5, RK4, VERNER7};
use std::collections::BTreeSet;

/// A rooted tree: what hangs on its root, in order.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Tree(Vec<Tree>);

impl Tree {
    /// All trees with one node more.
    fn grown(&self) -> Vec<Tree> {
        let at_root = Tree([self.0.clone(), vec![Tree(vec![])]].concat());
        let further = self.0.iter().enumerate().flat_map(|(i, branch)| {
            branch.grown().into_iter().map(move |grown| {
                let mut branches = self.0.clone();
                branches[i] = grown;
                Tree(branches)
            })
        });
        let sorted = |mut tree: Tree| {
            tree.0.sort();
            tree
        };
        std::iter::once(at_root).chain(further).map(sorted).collect()
    }

    fn nodes(&self) -> f64 {
        1.0 + self.0.iter().map(Tree::nodes).sum::<f64>()
    }

    /// γ
    fn density(&self) -> f64 {
        self.nodes() * self.0.iter().map(Tree::density).product::<f64>()
    }

    /// What the stages of a method make of it.
    fn stages(&self, tableau: &Tableau) -> Vec<f64> {
        let branches: Vec<_> = self.0.iter().map(|branch| branch.stages(tableau)).collect();
        let inner = |i: usize, branch: &Vec<f64>| sum(&tableau.a[i], branch);
        (0..tableau.stages).map(|i| branches.iter().map(|branch| inner(i, branch)).product()).collect()
    }
}

fn sum(weights: &[f64], stages: &[f64]) -> f64 {
    weights.iter().zip(stages).map(|(weight, stage)| weight * stage).sum()
}

/// All trees with so many nodes.
fn trees(nodes: u32) -> BTreeSet<Tree> {
    let first = BTreeSet::from([Tree(vec![])]);
    (1..nodes).fold(first, |trees, _| trees.iter().flat_map(Tree::grown).collect())
}

/// Rows of the higher methods hold coefficients of up to 200, rounded to double precision.
const ROUNDING: f64 = 1e-13;

/// Over the trees of up to `order` nodes, and no further, these weights sum up to `solution` times what an exact solution
/// has.
fn satisfies(tableau: &Tableau, weights: &[f64], order: u32, solution: f64) {
    let of_tree = |tree: &Tree| (sum(weights, &tree.stages(tableau)) - solution / tree.density()).abs();
    let defect = |nodes: u32| trees(nodes).iter().map(of_tree).fold(0.0, f64::max);
    for nodes in 1..=order {
        assert!(defect(nodes) < ROUNDING, "{}: {:e} with {nodes} nodes", tableau.name, defect(nodes));
    }
    assert!(defect(order + 1) > 1e-8, "{}", tableau.name);
}

#[test]
fn there_are_as_many_rooted_trees_as_counted() {
    let counts: Vec<_> = (1..=8).map(|nodes| trees(nodes).len()).collect();
    assert_eq!(counts, [1, 1, 2, 4, 9, 20, 48, 115]); // A. Cayley, Philos. Mag. 13 (1857) 172
}

#[test]
fn each_method_satisfies_the_conditions_up_to_its_order() {
    fn solves(tableau: &Tableau) {
        satisfies(tableau, &tableau.b, tableau.order, 1.0);
    }
    solves(&RK4);
    solves(&BS3);
    solves(&DOPRI5);
    solves(&VERNER7);
    solves(&DOP853);
}

#[test]
fn an_error_estimate_sees_nothing_below_its_order() {
    satisfies(&BS3, &BS3.error, 2, 0.0);
    satisfies(&DOPRI5, &DOPRI5.error, 4, 0.0);
    satisfies(&VERNER7, &VERNER7.error, 6, 0.0);
    satisfies(&DOP853, &DOP853.error, 5, 0.0);
    satisfies(&DOP853, &DOP853.coarse_error.expect("it has two"), 3, 0.0);
}
