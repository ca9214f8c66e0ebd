//! Joint coordinates: the state-space form, and the short way to the maximal accelerations of a state that satisfies
//! the constraints.
//!
//! `layout` orders the coordinates of a spanning tree, but for those that are `determined` by couplers, drivers and
//! loops; `link_kinematics` says how a body moves on its carrier, `whole_angles` where it is, and `maps` leads to
//! maximal coordinates and back. `closure` has the rows of joints that close loops, `loops` how rates keep these
//! closed, `embedding` how all rates of the tree follow fewer unknowns, and `cut_armatures` what armatures of cut
//! joints resist. `coordinates` has all that is derived of
//! them, and `forces` what acts along them. `dynamics` solves for the rates' rates in several ways, `planar` for those
//! of planar mechanisms, `axis_dynamics` in frames of joints, seen as `elementary_joints`: in `axis_frames` that
//! suit them, between which `screw_moves` lead, from the base inertial parameters among their `mass_moments`, with an
//! `articulated_inertia` (in `axis_shared` where joints follow others) or a mass matrix, beside which `axis_loops` has
//! the rows of loops; `axis_inverse` finds forces there, `axis_derivatives` how they change.
//! These are the `candidates`, and `choose` takes the cheapest of those that are accurate, with what follows from it:
//! `motions` of the bodies, `multipliers` and the `jacobian` of the joint form; `on_request` has what controllers of
//! robots ask for, derivatives as `slopes`,
//! and the `regressor`.

mod alone;
mod articulated_inertia;
mod axis_derivatives;
mod axis_dynamics;
mod axis_frames;
mod axis_inverse;
mod axis_loops;
mod axis_shared;
mod candidates;
mod choose;
mod closing_units;
mod closure;
mod coordinates;
mod cut_armatures;
mod determined;
mod dynamics;
mod elementary_joints;
mod embedding;
mod forces;
mod jacobian;
mod large_jacobian;
mod layout;
mod link_kinematics;
mod loops;
mod lower_triangle;
mod maps;
mod mass_moments;
mod motions;
mod multipliers;
mod observed;
mod on_request;
mod planar;
mod regressor;
mod relation;
mod screw_moves;
mod slopes;
mod velocity_rows;
mod whole_angles;
mod zero_orientation;

pub use candidates::Candidates;
pub use choose::JointSpace;
pub use coordinates::Coordinates;
