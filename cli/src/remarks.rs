//! Remarks on a model: redundant rows, and other warnings.

use crate::failure::Failure;
use crate::words::count;
use gyro_model::{Model, OutputKind, RedundantRow, RowOwner};
use std::io::{IsTerminal, Write as _};
use std::sync::atomic::{AtomicBool, Ordering};

/// Remarks of one kind that are made of a model file.
const MOST: usize = 10;

/// Says on standard error what of a model file is nearly exact, and which rows were dropped; refuses the model file if
/// that is to be an error.
pub(crate) fn report_redundant(model: &Model, page: &str, strict: bool) -> Result<(), Failure> {
    model.remarks.iter().take(MOST).for_each(|words| note(&format!("{page}: {words}")));
    let lines: Vec<String> = model.redundant.iter().map(|row| describe(model, row)).collect();
    if lines.is_empty() {
        return Ok(());
    }
    if strict {
        let rows = count(lines.len() as u64, "redundant constraint row");
        return Err(Failure::Usage(format!("{page} has {rows}, refused by --strict:\n{}", lines.join("\n"))));
    }
    dropped(model).iter().for_each(|words| warn(&format!("{page}: {words}")));
    Ok(())
}

/// Says something on standard output. Whoever closes the pipe has read enough; any other loss of output is a failure.
pub(crate) fn say(text: &str) -> Result<(), Failure> {
    let mut stdout = std::io::stdout();
    match stdout.write_all(text.as_bytes()).and_then(|()| stdout.flush()) {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => {
            Err(Failure::Run(format!("standard output cannot be written: {error}")))
        }
        _ => Ok(()),
    }
}

/// Says something on standard error.
pub(crate) fn warn(words: &str) {
    line(&format!("warning: {words}"));
}

/// Writes a line to standard error, on terminals over the line that tells of progress.
fn line(words: &str) {
    let over = if std::io::stderr().is_terminal() { "\r\x1b[2K" } else { "" };
    // Nobody is left to be told if standard error is closed.
    let _ = writeln!(std::io::stderr(), "{over}{words}");
}

static IS_QUIET: AtomicBool = AtomicBool::new(false);

/// Has notes and progress left out from now on.
pub(crate) fn be_quiet() {
    IS_QUIET.store(true, Ordering::Relaxed);
}

pub(crate) fn is_quiet() -> bool {
    IS_QUIET.load(Ordering::Relaxed)
}

/// Says on standard error what is going on.
pub(crate) fn note(words: &str) {
    if !is_quiet() {
        line(&format!("note: {words}"));
    }
}

/// The message about a redundant row: whose it is, what it says, and whose multipliers are not unique without it.
pub(crate) fn describe(model: &Model, dropped: &RedundantRow) -> String {
    let row = dropped.row;
    let shared: Vec<String> =
        dropped.shared_with.iter().filter(|other| **other != row.owner).map(|o| owner(model, *o)).collect();
    let with = if shared.is_empty() { "its other rows".to_owned() } else { shared.join(", ") };
    let dropped = if dropped.stays { "" } else { " and is dropped" };
    format!("{} depends on {with}{dropped}; how these share a load is not unique", model.row_named(row))
}

/// One sentence about all redundant rows: which are dropped, which stay, and what of reactions is not unique.
pub(crate) fn dropped(model: &Model) -> Option<String> {
    if model.redundant.is_empty() {
        return None;
    }
    let of = |stays: bool, [one, several]: [&str; 2]| {
        let rows = model.redundant.iter().filter(|redundant| redundant.stays == stays);
        let rows: Vec<String> = rows.map(|redundant| model.row_named(redundant.row)).collect();
        let what = if rows.len() == 1 { one } else { several };
        (!rows.is_empty()).then(|| format!("{} {what}", rows.join(", ")))
    };
    let dropped = ["depends on others and is dropped", "depend on others and are dropped"];
    let staying = [
        "depends on others in another way at each pose and stays",
        "depend on others in another way at each pose and stay",
    ];
    let rows: Vec<String> = [of(false, dropped), of(true, staying)].into_iter().flatten().collect();
    let names = OutputKind::Reaction { joint: 0 }.columns();
    let mut shared: Vec<(String, Vec<String>)> = Vec::new();
    for (joint, described) in model.joints.iter().enumerate() {
        let own = names.iter().zip(not_unique(model, joint)).filter(|(_, is_shared)| *is_shared);
        let own: Vec<&str> = own.map(|((name, _), _)| *name).collect();
        if own.is_empty() {
            continue;
        }
        let (own, name) = (own.join(", "), format!("`{}`", described.name));
        match shared.iter_mut().find(|(numbers, _)| *numbers == own) {
            Some((_, joints)) => joints.push(name),
            None => shared.push((own, vec![name])),
        }
    }
    let loads: Vec<String> =
        shared.iter().map(|(numbers, joints)| format!("{numbers} of {}", joints.join(", "))).collect();
    let loads = if loads.is_empty() {
        "all reactions are unique".to_owned()
    } else {
        format!("of the reactions these are not unique: {}", loads.join("; "))
    };
    Some(format!("{}; the motion is the same, and {loads}", rows.join("; ")))
}

/// Which numbers of a joint's reaction are not unique.
pub(crate) fn not_unique(model: &Model, joint: usize) -> [bool; 6] {
    let loads = model.redundant.iter().flat_map(|dropped| &dropped.loads).filter(|(of, _)| *of == joint);
    loads.fold([false; 6], |all, (_, changed)| std::array::from_fn(|k| all[k] || changed[k]))
}

/// Whether a number of an output is made of multipliers that are not unique.
pub(crate) fn is_not_unique(model: &Model, output: &OutputKind, number: usize) -> bool {
    let owner = match output {
        OutputKind::Reaction { joint } => return not_unique(model, *joint)[number],
        OutputKind::Driver { driver } => RowOwner::Driver(*driver),
        OutputKind::Coupler { coupler } => RowOwner::Coupler(*coupler),
        _ => return false,
    };
    model.redundant.iter().any(|dropped| dropped.row.owner == owner || dropped.shared_with.contains(&owner))
}

/// An owner of rows by kind and name.
pub(crate) fn owner(model: &Model, owner: RowOwner) -> String {
    let (kind, name) = kind_and_name(model, owner);
    format!("{kind} `{name}`")
}

/// Kind and name of an owner of rows.
pub(crate) fn kind_and_name(model: &Model, owner: RowOwner) -> (&'static str, &str) {
    match owner {
        RowOwner::Body(index) => ("body", &model.bodies[index].name),
        RowOwner::Joint(index) => ("joint", &model.joints[index].name),
        RowOwner::Coupler(index) => (model.couplers[index].word(), &model.couplers[index].name),
        RowOwner::Driver(index) => ("driver", &model.drivers[index].name),
    }
}
