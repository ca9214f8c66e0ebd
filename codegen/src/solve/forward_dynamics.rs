//! Forward dynamics: solves eq. (17) for the trees of a mechanism through the null space of the joints, by several
//! methods of which the cheapest accurate one is taken.

use crate::derive::Textbook;
use crate::derive::dynamics::Dynamics;
use crate::derive::kinematics::Kinematics;
use crate::derive::system::System;
use crate::expr::definitions::Expansion;
use crate::expr::graph::{ExprId, Graph};
use crate::expr::rounding::choose;
use crate::expr::schedule::Operations;
use crate::expr::spatial_vector::SpatialVector;
use crate::expr::symbol::Symbol;
use crate::solve::Solution;
use crate::solve::articulated_body::{Basis, EliminatedTree, Excitation};
use crate::solve::cancellation::{self, Trials};
use crate::solve::dependence::Yielding;
use crate::solve::gram_schmidt::{self, GramSchmidtTree};
use crate::solve::loop_closure::{self, CutRotor};
use crate::solve::motion_subspace::MotionSubspace;
use crate::solve::multipliers;
use crate::solve::reduced_mass_matrix::ReducedTree;
use std::collections::{BTreeMap, BTreeSet};

/// With more rates than this a reduced mass matrix is seldom shorter.
const MAX_REDUCED: usize = 4;

/// The trees of a mechanism, ready to be solved.
#[derive(Debug)]
pub struct ForwardDynamics {
    subspaces: Vec<MotionSubspace>,
    /// In each basis that is tried.
    eliminated: Vec<EliminatedTree>,
    /// Of small open trees.
    reduced: Option<ReducedTree>,
    /// In each basis that is tried, where digits are at stake.
    gram_schmidt: Vec<GramSchmidtTree>,
    /// The rows that no joint of the trees owns.
    loop_rows: Vec<usize>,
    /// The armatures that no joint of the trees has.
    cut_rotors: Vec<CutRotor>,
    /// What dependent rows yield, in symbols that need no expansion.
    yielding: Yielding,
}

impl ForwardDynamics {
    pub fn of(system: &mut System, kinematics: &Kinematics, yielding: Yielding) -> Self {
        let links = system.tree.links.clone();
        let subspaces: Vec<_> =
            links.iter().map(|&link| MotionSubspace::of(system, kinematics, link)).collect();
        let loop_rows = system.loop_closure_rows();
        let mut eliminated = vec![EliminatedTree::new(system, subspaces.clone(), Basis::Mixed)];
        // Near a singular pose rounding decides which branch a linkage follows, so loops keep the one form that was
        // tested on such poses.
        let (mut reduced, mut gram_schmidt) = (None, Vec::new());
        if loop_rows.is_empty() {
            let in_global_frame: Vec<_> =
                subspaces.iter().map(|subspace| subspace.in_global_frame(system)).collect();
            let in_own_frames: Vec<_> =
                subspaces.iter().map(|subspace| subspace.in_own_frames(system)).collect();
            let n_rates: usize = subspaces.iter().map(|subspace| subspace.free.len()).sum();
            if (2..=gram_schmidt::MAX_RATES).contains(&rates_of_largest(&subspaces))
                && cancellation::may_matter(system)
            {
                gram_schmidt.push(GramSchmidtTree::new(system, subspaces.clone(), Basis::Mixed));
                gram_schmidt.push(GramSchmidtTree::new(system, in_own_frames.clone(), Basis::Own));
            }
            if n_rates <= MAX_REDUCED {
                reduced = Some(ReducedTree::new(system, in_global_frame.clone(), &subspaces));
            }
            eliminated.push(EliminatedTree::new(system, in_global_frame, Basis::Global));
            eliminated.push(EliminatedTree::new(system, in_own_frames, Basis::Own));
        }
        let cut_rotors = CutRotor::all(system);
        Self { subspaces, eliminated, reduced, gram_schmidt, loop_rows, cut_rotors, yielding }
    }

    /// Solves eq. (17): for the multipliers, and for the accelerations if these are asked for.
    pub fn solve(&self, system: &mut System, textbook: &Textbook, is_solved: bool) -> Solution {
        let Textbook { kinematics, dynamics } = textbook;
        let solved = if is_solved { self.accelerations(system, textbook) } else { Vec::new() };
        Solution { solved, lambda: multipliers::of(system, kinematics, dynamics, &self.subspaces) }
    }

    fn accelerations(&self, system: &mut System, textbook: &Textbook) -> Vec<ExprId> {
        let candidates = self.candidates(system, &textbook.kinematics, &textbook.dynamics);
        let admitted = candidates.admitted(system);
        cheapest(system, admitted)
    }

    fn candidates(&self, system: &mut System, kinematics: &Kinematics, dynamics: &Dynamics) -> Candidates {
        let of_eliminated = |tree: &EliminatedTree| {
            let subspaces = tree.joints.iter().map(|joint| &joint.subspace);
            let excitation = Excitation::by_forces(system, dynamics, subspaces);
            let free = tree.respond(&mut system.graph, &excitation).motions;
            let rows = (&self.loop_rows[..], &kinematics.gamma[..]);
            let (graph, rotors) = (&mut system.graph, (&self.cut_rotors[..], &self.yielding));
            let (motions, multipliers) = loop_closure::close(graph, kinematics, tree, rows, rotors, free);
            listed(&motions).into_iter().chain(multipliers).collect()
        };
        let eliminated = self.eliminated.iter().map(of_eliminated).collect();
        let reduced = self.reduced.as_ref().map(|tree| listed(&tree.accelerations(system, dynamics)));
        let of_gram_schmidt = |tree: &GramSchmidtTree| {
            let excitation = Excitation::by_forces(system, dynamics, &tree.subspaces);
            listed(&tree.respond(&mut system.graph, &excitation).motions)
        };
        Candidates {
            eliminated,
            reduced,
            gram_schmidt: self.gram_schmidt.iter().map(of_gram_schmidt).collect(),
        }
    }

    /// The smallest (δr, δπ') of each moving body, in the metric of the masses, that change the rows by
    /// [`Symbol::Change`]: eq. (17) without forces and with these changes for γ.
    pub fn projection(&self, system: &mut System, kinematics: &Kinematics) -> Vec<ExprId> {
        let graph = &mut system.graph;
        let changes: Vec<_> =
            (0..kinematics.phi.len()).map(|row| graph.symbol(Symbol::Change(row))).collect();
        let projected = self.eliminated.iter().map(|tree| {
            let forced = tree.joints.iter().map(|joint| joint.subspace.forced_by(graph, &changes)).collect();
            let excitation =
                Excitation { forced, ..Excitation::none(tree.n_moving_bodies(), tree.joints.len()) };
            let free = tree.respond(graph, &excitation).motions;
            let (motions, _) = loop_closure::close(
                graph,
                kinematics,
                tree,
                (&self.loop_rows, &changes),
                (&self.cut_rotors, &self.yielding),
                free,
            );
            listed(&motions)
        });
        let mut projected: Vec<_> = projected.collect();
        projected.extend(self.reduced.as_ref().map(|tree| listed(&tree.project(graph, &changes))));
        cheapest(system, projected)
    }
}

/// The forms of the accelerations that are compared.
struct Candidates {
    /// By elimination from body to body, in each basis.
    eliminated: Vec<Vec<ExprId>>,
    /// Through the reduced mass matrix.
    reduced: Option<Vec<ExprId>>,
    /// By Gram–Schmidt, in each basis; none unless cancellation may matter.
    gram_schmidt: Vec<Vec<ExprId>>,
}

impl Candidates {
    /// Those that are accurate enough to be taken if they are the cheapest.
    fn admitted(self, system: &mut System) -> Vec<Vec<ExprId>> {
        let Self { eliminated, reduced, gram_schmidt } = self;
        if let Some(keeping) = gram_schmidt.first() {
            let others = eliminated.into_iter().chain(reduced).collect();
            let mut admitted = accurate(system, others, keeping);
            admitted.extend(gram_schmidt);
            return admitted;
        }
        // Elimination is more accurate where a body spins fast, which is worth a quarter of the operations.
        let saves_a_quarter = |reduced: &Vec<ExprId>| {
            let cost = |form: &Vec<ExprId>| cost(&system.graph, form);
            eliminated.iter().all(|eliminated| 4 * cost(reduced) < 3 * cost(eliminated))
        };
        match reduced.filter(saves_a_quarter) {
            Some(reduced) => vec![reduced],
            None => eliminated,
        }
    }
}

impl Excitation {
    /// The applied forces and the rows of the joints, whose subspaces come root first.
    fn by_forces<'f>(
        system: &mut System,
        dynamics: &Dynamics,
        subspaces: impl IntoIterator<Item = &'f MotionSubspace>,
    ) -> Self {
        let n_moving_bodies = system.moving_bodies.len();
        let subspaces: Vec<_> = subspaces.into_iter().collect();
        let forced: Vec<_> = subspaces.iter().map(|subspace| subspace.bias).collect();
        let bias = (0..n_moving_bodies)
            .map(|moving_body| dynamics.minus_applied_force(&mut system.graph, moving_body))
            .collect();
        let along = |subspace: &&MotionSubspace| vec![subspace.held_back; subspace.armature.len()];
        Self { bias, forced, along: subspaces.iter().map(along).collect() }
    }
}

/// The number of rates of the largest tree.
fn rates_of_largest(subspaces: &[MotionSubspace]) -> usize {
    let (mut roots, mut rates) = (BTreeMap::new(), BTreeMap::<usize, usize>::new());
    for subspace in subspaces {
        let root = subspace.parent.map_or(subspace.moving_body, |parent| roots[&parent.moving_body]);
        roots.insert(subspace.moving_body, root);
        *rates.entry(root).or_default() += subspace.free.len();
    }
    rates.into_values().max().unwrap_or(0)
}

fn cost(graph: &Graph, form: &[ExprId]) -> usize {
    Operations::recurring(graph, form).total()
}

/// The form of the fewest operations, symbols being one each, of those that round well.
fn cheapest(system: &System, mut forms: Vec<Vec<ExprId>>) -> Vec<ExprId> {
    let mut graph = system.graph.clone();
    let mut expansion = Expansion::new(&system.definitions);
    let expanded: Vec<_> = forms.iter().map(|form| expansion.all(&mut graph, form)).collect();
    let expanded: Vec<_> = expanded.iter().map(Vec::as_slice).collect();
    forms.swap_remove(choose(&graph, &expanded, |form| cost(&graph, &forms[form])))
}

/// The forms of the accelerations of an open tree that lose no accuracy against `keeping`, which is known to cancel
/// nothing.
fn accurate(system: &mut System, forms: Vec<Vec<ExprId>>, keeping: &[ExprId]) -> Vec<Vec<ExprId>> {
    let mut expansion = Expansion::new(&system.definitions);
    let keeping = expansion.all(&mut system.graph, keeping);
    let expanded: Vec<_> = forms.iter().map(|form| expansion.all(&mut system.graph, form)).collect();
    let all: Vec<_> = expanded.iter().flatten().chain(&keeping).copied().collect();
    let trials = Trials::draw(system, &all, &BTreeSet::new(), (&[], &BTreeMap::new()));
    let forms = forms.into_iter().zip(expanded);
    forms
        .filter(|(_, form)| trials.is_accurate(&system.graph, form, &keeping))
        .map(|(form, _)| form)
        .collect()
}

/// The components of the motions of all moving bodies.
fn listed(motions: &[SpatialVector]) -> Vec<ExprId> {
    motions.iter().flat_map(|motion| motion.t.into_iter().chain(motion.rho)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::definitions::Expansion;
    use crate::expr::evaluate::{evaluate, random_state};

    /// A thousand operations on numbers of order one, and a solve.
    const ROUNDING: f64 = 1e-9;

    /// Through the reduced mass matrix, by elimination and by Gram–Schmidt, in every basis, the accelerations are
    /// the same.
    fn check(page: &str) {
        let model = gyro_model::read("page.toml", page).expect("a model file without mistakes");
        let mut system = System::new(&model);
        let kinematics = Kinematics::derive(&mut system);
        let dynamics = Dynamics::derive(&mut system);
        let trees = ForwardDynamics::of(&mut system, &kinematics, Yielding::new());
        let mut forms = Vec::new();
        for tree in &trees.eliminated {
            let subspaces = tree.joints.iter().map(|joint| &joint.subspace);
            let excitation = Excitation::by_forces(&mut system, &dynamics, subspaces);
            forms.push(listed(&tree.respond(&mut system.graph, &excitation).motions));
        }
        for basis in [Basis::Mixed, Basis::Own] {
            let subspaces = trees.subspaces.iter().map(|subspace| match basis {
                Basis::Own => subspace.in_own_frames(&mut system),
                _ => subspace.clone(),
            });
            let subspaces = subspaces.collect();
            let tree = GramSchmidtTree::new(&mut system, subspaces, basis);
            let excitation = Excitation::by_forces(&mut system, &dynamics, &tree.subspaces);
            forms.push(listed(&tree.respond(&mut system.graph, &excitation).motions));
        }
        let reduced = trees.reduced.as_ref().expect("few rates");
        forms.push(listed(&reduced.accelerations(&mut system, &dynamics)));
        let mut expansion = Expansion::new(&system.definitions);
        let forms: Vec<_> = forms.iter().map(|form| expansion.all(&mut system.graph, form)).collect();
        for seed in 0..10 {
            let values: Vec<_> =
                forms.iter().map(|form| evaluate(&system.graph, form, random_state(seed))).collect();
            let size = values[0].iter().fold(0.0, |size: f64, x| size.max(x.abs()));
            for (a, b) in values.iter().flat_map(|other| values[0].iter().zip(other)) {
                assert!((a - b).abs() <= ROUNDING * size, "{a} {b} of {size}");
            }
        }
    }

    /// A rod that slides and turns at its end, its moments tunable, and `others`: nothing of its moments is lost beside
    /// those of its mass at its length.
    fn keeps_digits(others: &str) {
        let page = format!(
            "format = 1\nname = \"rod\"\n[parameters]\nmoment = 0.033\n[[body]]\nname = \"wall\"\nfixed = true\n\
             [[body]]\nname = \"rod\"\nmass = 1.2\ninertia = [0.057, \"moment\", 0.033]\n\
             [[joint]]\nname = \"j\"\nkind = \"point_on_line\"\n\
             first = {{ body = \"rod\", point = [0, -1.2, 0], axis = [1, 0, 0], zero = [0, 0, 1] }}\nsecond = {{ body = \"wall\" }}\n\
             [[force]]\nname = \"pull\"\nkind = \"spring\"\njoint = \"j\"\nstiffness = 1\n{others}"
        );
        let model = gyro_model::read("page.toml", &page).expect("a model file without mistakes");
        let mut system = System::new(&model);
        let textbook = Textbook::derive(&mut system);
        let trees = ForwardDynamics::of(&mut system, &textbook.kinematics, Yielding::new());
        let form = trees.solve(&mut system, &textbook, true).solved;
        let tree = GramSchmidtTree::new(&mut system, trees.subspaces.clone(), Basis::Mixed);
        let excitation = Excitation::by_forces(&mut system, &textbook.dynamics, &tree.subspaces);
        let keeping = listed(&tree.respond(&mut system.graph, &excitation).motions);
        let kept = accurate(&mut system, vec![form], &keeping);
        assert_eq!(kept.len(), 1, "beside {others:?}");
    }

    #[test]
    fn a_tree_keeps_its_digits_whatever_else_there_is() {
        let free = |name| {
            format!(
                "[[body]]\nname = \"{name}\"\nfree = true\nmass = 1\ninertia = [1, 1, 1]\nposition = [9, 9, 9]\n"
            )
        };
        keeps_digits("");
        keeps_digits(&free("one"));
        keeps_digits(&[free("one"), free("two")].concat());
    }

    #[test]
    fn a_reduced_mass_matrix_and_orthogonal_motions_give_what_elimination_gives() {
        check(include_str!("../../../models/gyroscope-misalignments.toml"));
        check(include_str!("../../../models/heavy-top.toml"));
        check(include_str!("../../../tests/models/universal.toml"));
        check(include_str!("../../../tests/models/cylindrical.toml"));
    }
}
