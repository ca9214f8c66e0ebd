//! The mechanism at run time: poses, rows, forces and outputs as the textbook has them, for all forms of the solve.

pub(crate) mod applied;
pub(crate) mod armatures;
pub(crate) mod constraints;
pub(crate) mod course;
pub(crate) mod energy;
pub(crate) mod forces;
pub(crate) mod gradient;
pub(crate) mod joint;
pub(crate) mod kinds;
pub(crate) mod law;
pub(crate) mod lowered;
pub(crate) mod measure;
pub(crate) mod motion;
pub(crate) mod observed;
pub(crate) mod outputs;
pub(crate) mod path;
pub(crate) mod place;
pub(crate) mod primitives;
pub(crate) mod readings;
pub(crate) mod rotor;
pub(crate) mod rounding;
pub(crate) mod rows;
pub(crate) mod scene;
pub(crate) mod textbook;
pub(crate) mod turns;
