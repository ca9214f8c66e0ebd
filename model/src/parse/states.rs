//! States of one's own.

use super::named_formulas::unlike_numbers;
use super::numbers::number;
use super::reader::Reader;
use super::section::Section;
use super::tables;
use crate::validate::Owner;
use crate::{Formula, Model, Number, Output, OutputKind, Seen, State, StateStart};

/// What starts a state where its rate is zero.
const AT_REST: &str = "rest";

/// All tables of states. Formulas see each by the output of its name.
pub(super) fn open<'t>(
    reader: &mut Reader<'_>,
    page: &Section<'t>,
    outputs: &mut Vec<Output>,
) -> Vec<(Section<'t>, String)> {
    let sections = tables::each(reader, page, "state", Owner::State);
    for (state, (_, name)) in sections.iter().enumerate() {
        unlike_numbers(reader, Owner::State(state), ("state", name));
        outputs.push(Output { name: name.clone(), kind: OutputKind::State { state } });
    }
    sections
}

/// Reads all states. Their rates may be formulas of outputs, which are known by now.
pub(super) fn read(reader: &mut Reader<'_>, sections: Vec<(Section<'_>, String)>) -> Vec<State> {
    let one = |(section, name): (Section<'_>, String)| {
        let start = match section.find(reader, "start") {
            Some(item) if item.value.get_ref().as_str() == Some(AT_REST) => StateStart::AtRest,
            Some(item) => StateStart::At(number(reader, item).unwrap_or(Number::integer(0))),
            None => StateStart::At(Number::integer(0)),
        };
        State { name, start, rate: section.number(reader, "rate") }
    };
    sections.into_iter().map(one).collect()
}

/// Says which states nothing depends on.
pub(super) fn remark_unread(model: &mut Model) {
    let events = model.events.iter().map(|event| &event.of);
    let formulas = model.laws().chain(events).chain(model.formulas.iter().map(|(_, formula)| formula));
    let seen = formulas.flat_map(Formula::sees);
    let seen: Vec<_> =
        seen.chain(model.controllers.iter().flat_map(|controller| controller.outputs.clone())).collect();
    let is_read = |state: usize| {
        seen.iter().any(|seen| match seen {
            Seen::Output { output, .. } => {
                matches!(model.outputs[*output].kind, OutputKind::State { state: of } if of == state)
            }
            _ => false,
        })
    };
    let unread = model.states.iter().enumerate().filter(|(state, _)| !is_read(*state));
    let remarks = unread.map(|(_, State { name, .. })| {
        format!(
            "nothing depends on state `{name}`: it is integrated and listed all the same; name it in a force, in the \
             rate of a state or in an output, or remove it"
        )
    });
    let remarks: Vec<_> = remarks.collect();
    model.remarks.extend(remarks);
}
