//! Proves generated mechanisms against the textbook.
//!
//! [`verify`] reads the text of a generated module and decides for each of its functions whether it computes what the
//! description of the mechanism asks for. The text is parsed into straight-line [programs](program); everything around
//! them must be as the [model](gyro_model::Model) determines it. Programs and [textbook](mod@textbook) formulas are
//! evaluated at random [points](point) modulo a large prime: formulas that differ agree there with a probability that
//! is bounded through their [degrees](field::Degree) and is far below 1e-30. The crate knows nothing of the generator.
//!
//! ```
//! # let page = r#"
//! # format = 1
//! # name = "pendulum"
//! # gravity = [0, -9.81, 0]
//! # [[body]]
//! # name = "wall"
//! # fixed = true
//! # [[body]]
//! # name = "rod"
//! # mass = 1
//! # inertia = [1e-4, 0.08, 0.08]
//! # [[joint]]
//! # name = "hinge"
//! # kind = "revolute"
//! # axis = [0, 0, 1]
//! # zero = [1, 0, 0]
//! # first = { body = "wall" }
//! # second = { body = "rod", point = [-0.5, 0, 0] }
//! # "#;
//! use gyro_verifier::{Depth, verify};
//!
//! let model = gyro_model::read("pendulum.toml", page).expect("a good model file");
//! let module = gyro_codegen::generate("pendulum.toml", page).expect("a module");
//! let report = verify(&model, &module.code, &module.constants, Depth::Quick);
//! assert!(report.is_proved(), "{report}");
//!
//! let wrong = module.code.replacen(" - ", " + ", 1);
//! assert!(!verify(&model, &wrong, &module.constants, Depth::Quick).is_proved());
//! ```
//!
//! What is proved and what is assumed is described in `docs/verification.md`.
#![deny(missing_docs)]

pub mod atoms;
mod c_text;
mod clif;
pub mod constants;
mod data_sheet;
pub mod divisors;
pub mod field;
mod finite;
pub mod interpreter;
pub mod joints;
pub mod module;
mod nodes;
mod numeric;
pub mod point;
pub mod program;
pub mod proof;
mod prove;
mod range;
mod rates;
pub mod refusal;
mod report;
pub mod rounding;
mod seed;
mod states;
pub mod structure;
mod tape;
pub mod textbook;
mod verify;

pub use c_text::same_in_c;
pub use clif::{Clif, Written, same_in_clif};
pub use finite::problems as not_finite;
pub use prove::{NotProved, prove, prove_with};
pub use report::{ACCEPTED_LOG10, Finding, Report};
pub use seed::Seed;
pub use verify::{Depth, verify, verify_at, with_proof};
