//! The conditions of order of each explicit method, one for each rooted tree (J. C. Butcher, Numerical Methods for
//! Ordinary Differential Equations, 2016, 31).

use slidercrank::integrator::Explicit;
use slidercrank::integrator::methods::{Bs3, Dop853, Dopri5, Rk4, Verner7};
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
    fn stages<M: Explicit>(&self) -> Vec<f64> {
        let branches: Vec<_> = self.0.iter().map(Tree::stages::<M>).collect();
        let inner = |i: usize, branch: &Vec<f64>| sum(&M::TABLEAU.a[i], branch);
        (0..M::TABLEAU.stages).map(|i| branches.iter().map(|branch| inner(i, branch)).product()).collect()
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
fn satisfies<M: Explicit>(weights: &[f64], order: u32, solution: f64) {
    let of_tree = |tree: &Tree| (sum(weights, &tree.stages::<M>()) - solution / tree.density()).abs();
    let defect = |nodes: u32| trees(nodes).iter().map(of_tree).fold(0.0, f64::max);
    for nodes in 1..=order {
        assert!(defect(nodes) < ROUNDING, "{}: {:e} with {nodes} nodes", M::NAME, defect(nodes));
    }
    assert!(defect(order + 1) > 1e-8, "{}", M::NAME);
}

#[test]
fn there_are_as_many_rooted_trees_as_counted() {
    let counts: Vec<_> = (1..=8).map(|nodes| trees(nodes).len()).collect();
    assert_eq!(counts, [1, 1, 2, 4, 9, 20, 48, 115]); // A. Cayley, Philos. Mag. 13 (1857) 172
}

#[test]
fn each_method_satisfies_the_conditions_up_to_its_order() {
    fn solves<M: Explicit>() {
        satisfies::<M>(&M::TABLEAU.b, M::TABLEAU.order, 1.0);
    }
    solves::<Rk4>();
    solves::<Bs3>();
    solves::<Dopri5>();
    solves::<Verner7>();
    solves::<Dop853>();
}

#[test]
fn an_error_estimate_sees_nothing_below_its_order() {
    satisfies::<Bs3>(&Bs3::TABLEAU.error, 2, 0.0);
    satisfies::<Dopri5>(&Dopri5::TABLEAU.error, 4, 0.0);
    satisfies::<Verner7>(&Verner7::TABLEAU.error, 6, 0.0);
    satisfies::<Dop853>(&Dop853::TABLEAU.error, 5, 0.0);
    satisfies::<Dop853>(&Dop853::TABLEAU.coarse_error.expect("it has two"), 3, 0.0);
}
