//! `cargo xtask import`: a robot of the Unified Robot Description Format as a model file.
//!
//! ```text
//! arm.urdf ─robot─▶ links and joints ─merge─▶ bodies ─page─▶ arm.toml
//! ```

mod angle;
mod element;
mod inertia;
mod merge;
mod names;
mod page;
mod robot;
mod shapes;
mod wrenches;

use crate::args::ImportArgs;
use crate::failure::Failure;
use crate::files;
use crate::words::{capped, count};
use crate::write::{self, Known};
use gyro_model::Model;
use merge::Root;
use std::fmt::Write as _;
use std::io::Write as _;
use std::path::Path;

/// How an imported model file begins.
const MARK: &str = "# Written by cargo xtask import";

/// What is made of a robot.
#[derive(Clone, Copy, Debug)]
struct Wishes<'a> {
    root: Root,
    /// A motor with an input for each joint.
    motors: bool,
    /// An armature for each joint.
    armature: Option<f64>,
    /// Stops for joints with limits.
    limits: bool,
    /// Links that a force and a torque act on.
    wrenches: &'a [String],
    /// Where the model file will be, unless here.
    folder: Option<&'a Path>,
}

/// Writes the model file and says what has no counterpart on it.
pub(crate) fn import(args: &ImportArgs) -> Result<(), Failure> {
    let out = args.out.clone().unwrap_or_else(|| args.file.with_extension("toml"));
    if out.exists() && !args.force {
        let out = out.display();
        return Err(Failure::Usage(format!(
            "{out} exists: choose another place with --out, or give --force"
        )));
    }
    write::check(&out, Known::Mark(MARK))?;
    let (page, mut remarks) = converted(args)?;
    let model = gyro_model::read(&out.display().to_string(), &page).map_err(Failure::ModelFile)?;
    write::write(&out, &page, Known::Mark(MARK))?;
    remarks.extend(model.nearly_exact.iter().cloned());
    // What was said is only about a file that is there already.
    let _ = std::io::stdout().write_all(report(&out, &model, &remarks).as_bytes());
    Ok(())
}

/// The model file and what is not in it.
pub(crate) fn converted(args: &ImportArgs) -> Result<(String, Vec<String>), Failure> {
    let file = args.file.display().to_string();
    let text = files::input(&args.file, files::LARGEST_MODEL_FILE)
        .map_err(|e| Failure::Usage(format!("{file} cannot be read: {e}")))?;
    xml::check(text.as_bytes()).map_err(|words| Failure::Usage(format!("{file}: {words}")))?;
    let root = if args.floating { Root::Floating } else { Root::Fixed };
    let shown = args.file.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let ImportArgs { motors, armature, limits, .. } = *args;
    let folder = args.out.as_ref().unwrap_or(&args.file).parent();
    let wishes = Wishes { root, motors, armature, limits, wrenches: &args.wrenches, folder };
    convert(&file, &shown, &text, wishes).map_err(Failure::Usage)
}

/// The model file of a robot and what is not on it; or every mistake of the file, a line for each.
fn convert(file: &str, shown: &str, text: &str, wishes: Wishes<'_>) -> Result<(String, Vec<String>), String> {
    let joined = |problems: Vec<String>| capped(&problems);
    let robot = robot::read(file, text).map_err(joined)?;
    let merged = merge::merge(file, &robot, wishes.root).map_err(joined)?;
    wrenches::check(file, &robot, &merged, wishes.wrenches).map_err(joined)?;
    let mut remarks = robot.remarks.clone();
    remarks.extend(merged.remarks.iter().cloned());
    let page = page::write(shown, &robot, (&merged, wishes), &mut remarks);
    Ok((page, remarks))
}

fn report(out: &Path, model: &Model, remarks: &[String]) -> String {
    let number = |n: usize, noun: &str| count(n as u64, noun);
    let n_bodies = model.coordinate_bodies().len();
    let mut text = format!(
        "wrote {}: {n_bodies} moving {}, {}, {}, {}\n",
        out.display(),
        if n_bodies == 1 { "body" } else { "bodies" },
        number(model.joints.len(), "joint"),
        number(model.couplers.len(), "coupler"),
        number(model.forces.len(), "force"),
    );
    if !remarks.is_empty() {
        text.push_str("what differs from the robot:\n");
    }
    for remark in capped(remarks).lines() {
        let _ = writeln!(text, "  {remark}");
    }
    text
}

#[cfg(test)]
mod tests;
