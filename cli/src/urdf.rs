//! `gyro import`: a robot of the Unified Robot Description Format as a model file.
//!
//! ```text
//! arm.urdf ─robot─▶ links and joints ─merge─▶ bodies ─page─▶ arm.toml
//! ```

mod angle;
mod density;
mod document;
mod element;
mod frames;
mod inertia;
mod left_out;
mod merge;
mod names;
mod numbers;
mod page;
mod robot;
mod shapes;
mod wrenches;

use crate::args::ImportArgs;
use crate::failure::Failure;
use crate::files;
use crate::folder;
use crate::invocation;
use crate::words::{capped, count};
use crate::write::{self, Known};
use gyro_model::Model;
use merge::Root;
use std::fmt::Write as _;
use std::io::Write as _;
use std::path::{Path, PathBuf};

/// How imported model files begin.
const MARKS: [&str; 3] =
    ["# Written by gyro import", "# Written by cargo xtask import", "# Written by gyro_sim.from_urdf"];

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
    /// Links whose frames are outputs, or `all`.
    frames: &'a [String],
    /// Where the model file will be, unless here.
    folder: Option<&'a Path>,
    /// Whether numbers stay as they are where others are likely meant, and inertias that no body has.
    as_written: bool,
    /// Density of the shapes of links whose file has no inertia, kg/m3.
    density: Option<f64>,
    /// Names of elements that are left out.
    ignored: &'a [String],
    /// What writes the model file.
    tool: &'a str,
}

/// Writes the model file and says what has no counterpart on it.
pub(crate) fn import(args: &ImportArgs) -> Result<(), Failure> {
    let out = place(args);
    if out.exists() && !args.force {
        let out = out.display();
        return Err(Failure::Usage(format!(
            "{out} exists: choose another place with --out, or give --force"
        )));
    }
    let marks = MARKS.map(Known::Mark);
    let known = marks.into_iter().find(|mark| write::check(&out, *mark).is_ok()).unwrap_or(marks[0]);
    write::check(&out, known)?;
    let (page, mut remarks) = converted(args, &format!("{} import", invocation::program()))?;
    let model = gyro_model::read(&out.display().to_string(), &page).map_err(Failure::ModelFile)?;
    write::write(&out, &page, known)?;
    remarks.extend(model.remarks.iter().cloned());
    // What was said is only about a file that is there already.
    let _ = std::io::stdout().write_all(report(&out, &model, &remarks).as_bytes());
    Ok(())
}

/// Where the model file goes.
fn place(args: &ImportArgs) -> PathBuf {
    let beside = args.file.with_extension("toml");
    let name = beside.file_name().unwrap_or_default().to_string_lossy();
    args.out.as_ref().map_or_else(|| beside.clone(), |out| folder::file(out, &name))
}

/// The model file and what is not in it.
pub(crate) fn converted(args: &ImportArgs, tool: &str) -> Result<(String, Vec<String>), Failure> {
    let file = args.file.display().to_string();
    let bytes = files::bytes(&args.file, files::LARGEST_MODEL_FILE)
        .map_err(|e| Failure::Usage(format!("{file} cannot be read: {e}")))?;
    write::note_input(&args.file);
    // Comments of robots are in any encoding.
    let text = String::from_utf8_lossy(&bytes);
    let root = if args.floating { Root::Floating } else { Root::Fixed };
    let shown = args.file.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let ImportArgs { motors, armature, limits, as_written, density, .. } = *args;
    let out = place(args);
    let folder = out.parent();
    let (wrenches, ignored, frames) = (&args.wrenches, &args.ignore, &args.frames);
    let wishes = Wishes {
        root,
        motors,
        armature,
        limits,
        wrenches,
        frames,
        folder,
        as_written,
        density,
        ignored,
        tool,
    };
    convert(&file, &shown, &text, wishes).map_err(Failure::Usage)
}

/// The model file of a robot and what is not on it; or every mistake of the file, a line for each.
fn convert(file: &str, shown: &str, text: &str, wishes: Wishes<'_>) -> Result<(String, Vec<String>), String> {
    let joined = |problems: Vec<String>| capped(&problems);
    let mut robot = robot::read(file, text, wishes).map_err(joined)?;
    if let Some(density) = wishes.density {
        density::weigh(file, &mut robot, density).map_err(joined)?;
    }
    let merged = merge::merge(file, &robot, wishes).map_err(joined)?;
    let of_all = wishes.frames == [frames::ALL];
    for (option, links) in
        [("--wrenches", wishes.wrenches), ("--frames", if of_all { &[] } else { wishes.frames })]
    {
        wrenches::check(file, &robot, &merged, (option, links)).map_err(joined)?;
    }
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
