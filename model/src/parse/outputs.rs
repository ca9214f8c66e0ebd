//! Outputs: what is to be computed besides the motion.

use super::couplings::{Level, level};
use super::formulas::Inputs;
use super::laws;
use super::lookup::wrong_within;
use super::reader::Reader;
use super::section::{Item, Section};
use super::{references, tables};
use crate::validate::{Owner, Side};
use crate::{BodyFrame, Formula, Number, Output, OutputKind, Relative, Seen};

/// Outputs that are formulas, by their places: they are read once all names are known.
pub(super) type Pending<'t> = Vec<(usize, Item<'t>, &'t str)>;

/// Reads all outputs.
pub(super) fn read<'t>(reader: &mut Reader<'_>, page: &Section<'t>) -> (Vec<Output>, Pending<'t>) {
    let sections = tables::each(reader, page, "output", Owner::Output).into_iter();
    let mut pending = Pending::new();
    let outputs = sections.enumerate().map(|(index, (mut section, name))| {
        let kind = section.read_kind(reader, |_, _| None).map_or("energy", |kind| kind.word);
        if ["formula", "rate"].contains(&kind) {
            let of = section.find(reader, "of").and_then(|item| Some((index, item, item.text(reader)?)));
            pending.extend(of);
        }
        Output { name, kind: output(reader, (&section, index), kind) }
    });
    (outputs.collect(), pending)
}

/// Reads the formulas of outputs.
pub(super) fn read_formulas(reader: &mut Reader<'_>, pending: Pending<'_>, outputs: &mut [Output]) {
    let known = reader.visible.clone();
    let kinds = reader.outputs.clone();
    let refuse = |name: &str, seen: Seen| {
        let Seen::Output { output, .. } = seen else { return None };
        matches!(kinds[output], OutputKind::Formula(_)).then(|| {
            [
                format!("`{name}` is an output by formula"),
                "not known yet".to_owned(),
                "write a [[formula]] with a name, and name it in both outputs".to_owned(),
            ]
        })
    };
    let refuse_in_rate = |name: &str, seen: Seen| {
        (seen != Seen::Time && level(&kinds, seen) == Level::Other).then(|| {
            [
                format!("an output of kind \"rate\" cannot depend on `{name}`"),
                "neither a joint coordinate, its rate nor seen from a frame".to_owned(),
                "write a formula of `t`, joint coordinates, their rates, and numbers of [[output]]s of kind \"relative\""
                    .to_owned(),
            ]
        })
    };
    for (index, item, text) in pending {
        let own = &mut outputs[index].kind;
        let is_rate = matches!(own, OutputKind::Rate(_));
        let refuse: &dyn Fn(&str, Seen) -> _ = if is_rate { &refuse_in_rate } else { &refuse };
        match laws::with_names(reader, &known, Inputs::Known, refuse, |named| named.formula(text)) {
            Ok(formula) => {
                *own = if is_rate { OutputKind::Rate(formula) } else { OutputKind::Formula(formula) }
            }
            Err(fault) => wrong_within(reader, item, text, fault),
        }
    }
}

fn output(reader: &mut Reader<'_>, (section, place): (&Section<'_>, usize), kind: &str) -> OutputKind {
    let mut index = |what| references::index(reader, section, what);
    match kind {
        "reaction" => OutputKind::Reaction { joint: index("joint") },
        "driver" => OutputKind::Driver { driver: index("driver") },
        "coupler" => OutputKind::Coupler { coupler: index("coupler") },
        "constraint" => {
            let own = index("constraint");
            OutputKind::Coupler { coupler: reader.named("coupler").len() + own }
        }
        "spring" => OutputKind::Spring { force: index("force") },
        "link" => OutputKind::Link { force: index("force") },
        "bushing" => OutputKind::Bushing { force: index("force") },
        "power" => OutputKind::Power,
        "energy" => OutputKind::Energy,
        "formula" => OutputKind::Formula(Formula::seen("t", Seen::Time)),
        "rate" => OutputKind::Rate(Formula::seen("t", Seen::Time)),
        "velocity" => OutputKind::Velocity(frame(reader, section)),
        "acceleration" => OutputKind::Acceleration(frame(reader, section)),
        "inertial" => OutputKind::Inertial(frame(reader, section)),
        "relative" => {
            let frames =
                Side::BOTH.map(|side| frame_at(reader, section, (Owner::OutputEnd(place, side), side)));
            OutputKind::Relative(Box::new(Relative { frames }))
        }
        _ => OutputKind::Pose(frame(reader, section)),
    }
}

/// The frame in a table under `first` or `second`.
pub(super) fn frame_at(
    reader: &mut Reader<'_>,
    section: &Section<'_>,
    (owner, side): (Owner, Side),
) -> BodyFrame {
    let title = format!("`{}` of {}", side.key(), section.title);
    match section.inner(reader, side.key(), (owner, &title)) {
        Some(end) => frame(reader, &end),
        None => {
            BodyFrame { body: references::NOTHING, point: [0; 3].map(Number::integer), orientation: None }
        }
    }
}

/// A frame of a body.
pub(super) fn frame(reader: &mut Reader<'_>, section: &Section<'_>) -> BodyFrame {
    BodyFrame {
        body: references::index(reader, section, "body"),
        point: section.vector(reader, "point"),
        orientation: section.given_vector(reader, "orientation"),
    }
}
