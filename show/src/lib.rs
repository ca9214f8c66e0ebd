//! One self-contained HTML page in which a simulated mechanism moves: 3-D picture, timeline, plots.
//!
//! [`page`] takes plain data (what the mechanism is made of, and samples of a run) and returns the page's text. The
//! crate knows nothing of files, of model files or of engines. The page's program is in `web/`; it is built by
//! `npm run build` there and committed, compressed, as `assets/viewer.js.deflate`.
//!
//! ```
//! use gyro_show::{Body, Mechanism, Run, Scene, page};
//!
//! let ball = Body { name: "ball".to_owned(), mass: 1.0, inertia: [0.1, 0.1, 0.1, 0.0, 0.0, 0.0], ..Body::default() };
//! let mechanism = Mechanism { name: "ball".to_owned(), bodies: vec![ball], ..Mechanism::default() };
//! let pose = |t: f64| [0.0, -5.0 * t * t, 0.0, 1.0, 0.0, 0.0, 0.0];
//! let times = vec![0.0, 0.5, 1.0];
//! let poses = vec![times.iter().map(|&t| pose(t)).collect()];
//! let run = Run { times, poses, ..Run::default() };
//! let html = page("a ball falls", &[Scene { name: "run".to_owned(), mechanism, run }], None);
//! assert!(html.starts_with(gyro_show::MARK));
//! ```
#![deny(missing_docs)]

mod channel;
mod live;
mod mechanism;
mod mesh;
mod page;
mod run;

pub use live::{Live, Setting, Slope};
pub use mechanism::{Amount, Body, Effort, Joint, JointEnd, Link, Load, Mechanism, Shape, Support, Touch};
pub use mesh::Mesh;
pub use page::{MARK, page};
pub use run::{Column, Reaction, Run, Scale, Scene};
