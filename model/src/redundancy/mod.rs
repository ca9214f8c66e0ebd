//! Rows of Φ that say what others say already: found by rank, at several poses of the mechanism.

mod axes;
mod loads;
mod sample;
mod select;
mod trees;

use crate::assemble::projection::{Configuration, Scales, System};
use crate::kinematics::{Equation, Kinematics};
use crate::{AssemblyError, Model, PointAxes, RedundantRow, Row, RowOwner, Start, Support, Tree};
use axes::Poses;
use sample::{Samples, samples};
use select::{Selection, dependencies_move, generic, idle, owners, select};
use trees::TreeRows;

/// What the rank of the constraint rows says about a mechanism.
#[derive(Clone, Debug, PartialEq)]
pub struct Analysis {
    /// Rows that depend on the others, in the order of [`Model::all_rows`]: what [`Model::redundant`] is to hold.
    pub redundant: Vec<RedundantRow>,
    /// Number of independent rows.
    pub rank: usize,
    /// Number of velocities that the independent rows, drivers' rows among them, leave free.
    pub degrees_of_freedom: usize,
    /// Whether the rank at the start itself is less: the mechanism starts in a dead point or where branches meet, and
    /// its velocities and accelerations there are not determined.
    pub singular_start: bool,
}

impl Model {
    /// Number of velocities that the rows leave free: six for each body with coordinates less those of
    /// [`Model::rows`] that are independent.
    ///
    /// Driven coordinates are not free. It is right once redundant rows are known, see [`analyse`].
    pub fn degrees_of_freedom(&self) -> usize {
        let stay = self.redundant.iter().filter(|row| row.stays).count();
        (6 * self.coordinate_bodies().len() + stay).saturating_sub(self.rows().len())
    }
}

/// Finds redundant rows. What [`Model::redundant`] holds already is not looked at.
///
/// The rank of all rows, with lengths by [`Model::size`], is taken at the assembled start and at poses around it that
/// satisfy the joints and couplers (drivers released), and the largest counts: a singular start does not fool it. Rows
/// are kept in this order as long as they are independent: constrained bodies, joints of the trees, couplers, joints
/// that close loops, drivers; so loop-closing joints lose rows first, later joints before earlier ones. Of one joint
/// the rows that are most independent stay, point rows along the axes that [`RedundantRow::axes`] names. Open trees
/// have no redundant rows by construction and cost no more than their start.
///
/// # Errors
/// Those of [`Model::assemble`], whose rows all have to be met, redundant ones too; a driver of a coordinate that is
/// fixed without it; a mechanism that can neither move nor is driven; driven bodies whose motions contradict redundant
/// rows later.
pub fn analyse(model: &Model) -> Result<Analysis, AssemblyError> {
    analyse_with_start(model).map(|(analysis, _)| analysis)
}

/// The same, with the start that it begins with.
pub(crate) fn analyse_with_start(model: &Model) -> Result<(Analysis, Start), AssemblyError> {
    // Point rows are along global axes until it is known that others are better.
    let model = &Model { redundant: Vec::new(), ..model.clone() };
    let (assembled, tree) = (model.assemble()?, Tree::of_coordinates(model));
    if model.is_open(&tree) {
        let rank = model.all_rows().len();
        let degrees_of_freedom = (6 * model.coordinate_bodies().len()).saturating_sub(rank);
        let analysis = Analysis { redundant: Vec::new(), rank, degrees_of_freedom, singular_start: false };
        return Ok((analysis, assembled));
    }
    let (kinematics, scales) = (Kinematics::at(model, 0.0), Scales::of(model));
    let start = configuration(&kinematics, &assembled);
    let (released, driven) = (undriven(&kinematics), kinematics.equations());
    let around = samples(&System::new(&kinematics, released, &scales), &start);
    if let Samples::Stuck = around {
        return Err(over_constrained(model, &tree));
    }
    let all = System::new(&kinematics, driven, &scales);
    let (poses, groups) = (around.with(start.clone()), groups(&kinematics, &tree));
    let is_exact = are_met(&System::new(&kinematics, undriven(&kinematics), &scales), &poses);
    let trees = TreeRows::of(model, &tree, kinematics.rows());
    let mut jacobians: Vec<_> = poses.iter().map(|at| all.jacobian(at)).collect();
    let mut motions: Vec<_> = jacobians.iter().map(|jacobian| trees.motions(jacobian)).collect();
    let generic = generic(&motions, &groups);
    let mut pose = 0..;
    motions.retain(|_| generic.contains(&pose.next().expect("endless")));
    let mut pose = 0..;
    jacobians.retain(|_| generic.contains(&pose.next().expect("endless")));
    let at = generic.iter().map(|&pose| &poses[pose]).collect();
    let poses = Poses {
        model,
        kinematics: &kinematics,
        scales: &scales,
        at,
        jacobians,
        motions,
        trees: &trees,
        groups: &groups,
    };
    let (redundant, selection) = selected(poses, is_exact);
    check_drivers(model, &redundant)?;
    check_later(
        &Model { redundant: redundant.clone(), ..model.clone() },
        &scales,
        &selection.dropped,
        &start,
    )?;
    let rank = selection.kept.len();
    let degrees_of_freedom = 6 * model.coordinate_bodies().len() - rank;
    if degrees_of_freedom == 0 && !model.is_driven() {
        return Err(over_constrained(model, &tree));
    }
    let singular_start = generic.first() != Some(&0);
    Ok((Analysis { redundant, rank, degrees_of_freedom, singular_start }, assembled))
}

/// All rows are met if none is off by more than this, lengths in units of the size: half of what corrections leave.
const EXACT: f64 = 2e-15;

/// Whether all rows can be met at these poses, but for rounding.
fn are_met(system: &System<'_>, poses: &[Configuration]) -> bool {
    poses.iter().all(|at| system.residual(&system.project(at)).amax() < EXACT)
}

/// Rows by rank, point rows along global axes or, of the joints of which this is said, along those of the first body.
///
/// Where all rows can be met they stay if the dependency moves; slips of a model file's last digits are left to
/// rows that are dropped.
fn selected(mut poses: Poses<'_>, is_exact: bool) -> (Vec<RedundantRow>, Selection) {
    let mut selection = select(&poses.motions, poses.trees, poses.groups);
    let turning = poses.joints_that_turn(&selection.dropped);
    if !turning.is_empty() {
        poses.motions = poses.turned(&turning);
        selection = select(&poses.motions, poses.trees, poses.groups);
    }
    let rows = poses.kinematics.rows();
    let axes = |row: Row| match row.owner {
        RowOwner::Joint(joint) if turning.contains(&joint) => PointAxes::FirstBody,
        _ => PointAxes::Global,
    };
    let states = idle(&selection, (&poses.motions, poses.trees), rows.len());
    let dropped = selection.dropped.iter().enumerate();
    let shared = dropped.map(|(at, row)| (owners(&states, (at, *row), rows), poses.loads(&states, at)));
    let redundant = selection.dropped.iter().map(|&row| rows[row]).zip(shared);
    let moves = dependencies_move(&selection, (&poses.motions, poses.trees));
    let redundant = redundant.zip(moves).map(|((row, (shared_with, loads)), moves)| {
        let is_joint = |owner: &RowOwner| matches!(owner, RowOwner::Joint(_));
        let of_joints = is_joint(&row.owner) && shared_with.iter().all(is_joint);
        let stays = is_exact && moves && of_joints;
        RedundantRow { row, axes: axes(row), shared_with, loads, stays }
    });
    let redundant = redundant.collect();
    (redundant, selection)
}

fn configuration(kinematics: &Kinematics, start: &Start) -> Configuration {
    // Spherical joints have Euler parameters there and no scalar coordinates.
    let near: Vec<Vec<f64>> = start.joints.iter().map(|joint| joint.position.clone()).collect();
    Configuration { near: kinematics.coordinates(&start.q, &near), q: start.q.clone() }
}

/// All rows of positions but the drivers'.
fn undriven(kinematics: &Kinematics) -> Vec<Equation> {
    let is_driver = |equation: &Equation| matches!(equation, Equation::Rows(RowOwner::Driver(_)));
    kinematics.of_positions().into_iter().filter(|equation| !is_driver(equation)).collect()
}

/// The rows of each owner that is not of the trees, in the order in which they are preferred.
fn groups(kinematics: &Kinematics, tree: &Tree) -> Vec<Vec<usize>> {
    let rank = |owner: RowOwner| match owner {
        RowOwner::Body(_) => None,
        RowOwner::Joint(joint) if !tree.loop_joints.contains(&joint) => None,
        RowOwner::Coupler(_) => Some(1),
        RowOwner::Joint(_) => Some(2),
        RowOwner::Driver(_) => Some(3),
    };
    let rows: Vec<(usize, &Row)> = kinematics.rows().iter().enumerate().collect();
    let groups = rows.chunk_by(|a, b| a.1.owner == b.1.owner);
    let groups = groups.filter_map(|group| Some((rank(group[0].1.owner)?, group)));
    let mut groups: Vec<(usize, Vec<usize>)> =
        groups.map(|(rank, group)| (rank, group.iter().map(|(row, _)| *row).collect())).collect();
    groups.sort_by_key(|(rank, _)| *rank);
    groups.into_iter().map(|(_, group)| group).collect()
}

/// A driver's row is never dropped: its motion in time would be ignored.
fn check_drivers(model: &Model, redundant: &[RedundantRow]) -> Result<(), AssemblyError> {
    for RedundantRow { row, shared_with, .. } in redundant {
        if let RowOwner::Driver(driver) = row.owner {
            let with = shared_with.iter().map(|&owner| model.named(owner)).collect();
            return Err(AssemblyError::Driver { driver, name: model.drivers[driver].name.clone(), with });
        }
    }
    Ok(())
}

/// Steps of the run after which redundant rows on driven bodies are looked at again: a motion may begin so smoothly
/// that nothing shows at once.
const LATER: [f64; 3] = [3.0, 10.0, 30.0];

/// Rows between driven bodies may hold at the start and not later, when only the rows that are kept are heeded.
fn check_later(
    model: &Model,
    scales: &Scales,
    dropped: &[usize],
    start: &Configuration,
) -> Result<(), AssemblyError> {
    if dropped.is_empty() || model.bodies.iter().all(|body| body.support != Support::Driven) {
        return Ok(());
    }
    let mut at = start.clone();
    for time in LATER.map(|steps| steps * model.simulation.step) {
        let kinematics = Kinematics::at(model, time);
        let kept = System::new(&kinematics, kinematics.equations(), scales).without(dropped);
        at = kept.project(&at);
        if !kept.is_met(&at) {
            // A pose that cannot be reached says nothing about the rows that were dropped.
            return Ok(());
        }
        let all = System::new(&kinematics, kinematics.equations(), scales);
        let exact = all.project(&at);
        if !all.is_met(&exact) {
            let worst = all.residual(&at).iamax();
            let (row, phi) = (kinematics.rows()[worst], kinematics.phi(&at.q, &at.near));
            let (owner, name) = (row.owner, model.named(row.owner));
            return Err(AssemblyError::Contradiction {
                owner,
                name,
                time,
                residual: phi[worst],
                unit: row.unit,
            });
        }
        at = exact;
    }
    Ok(())
}

fn over_constrained(model: &Model, tree: &Tree) -> AssemblyError {
    let joints = tree.loop_joints.iter().map(|&joint| RowOwner::Joint(joint));
    let owners: Vec<RowOwner> = joints.chain((0..model.couplers.len()).map(RowOwner::Coupler)).collect();
    AssemblyError::OverConstrained {
        owner: *owners.last().expect("an open tree is not analysed"),
        closing: owners.into_iter().map(|owner| model.named(owner)).collect(),
    }
}
