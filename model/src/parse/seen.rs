//! Numbers of the mechanism that controllers and events see, by the names that they have in the table of a run.

use super::names;
use super::reader::Reader;
use super::section::Item;
use crate::controller::visible;
use crate::{Output, Seen};

/// Names, each with what it is.
pub(super) type Known = Vec<(String, Seen)>;

/// All there are.
pub(super) fn known(reader: &Reader<'_>, outputs: &[Output]) -> Known {
    let joints = reader.named("joint").iter().zip(&reader.joint_kinds).enumerate();
    let named = joints.filter_map(|(index, (name, kind))| Some((index, name.as_deref()?, (*kind)?)));
    visible(named, outputs)
}

/// What a word names.
pub(super) fn named(reader: &mut Reader<'_>, item: Item<'_>, word: &str, known: &Known) -> Option<Seen> {
    if let Some(place) = names::column(word, known.iter().map(|(name, _)| name.as_str())) {
        return Some(known[place].1);
    }
    if reader.named("joint").contains(&None) || reader.joint_kinds.contains(&None) {
        reader.doubt(item.place);
        return None;
    }
    let names: Vec<&str> = known.iter().map(|(name, _)| name.as_str()).collect();
    let parts: Vec<&str> =
        names.iter().copied().filter(|name| name.split(['.', ' ']).next() == Some(word)).collect();
    let joint = reader.has_joint(word);
    let (message, label, help) = match (parts.as_slice(), names.as_slice()) {
        ([_, ..], _) => (
            format!("`{word}` is not one number"),
            "has several numbers",
            format!("write one of {}", names::list(&parts)),
        ),
        ([], _) if joint => (
            format!("joint `{word}` has no coordinate that a controller could see"),
            "no coordinate here",
            "add an [[output]] of the body that it turns, and name a number of it".to_owned(),
        ),
        ([], []) => (
            format!("there is nothing called `{word}` to be seen"),
            "no such output",
            "add an [[output]] with this name".to_owned(),
        ),
        ([], names) => (
            format!("there is no output `{word}`"),
            "no such output",
            format!("{}, or add an [[output]]", names::instead(word, names)),
        ),
    };
    item.wrong(reader, [message, label.to_owned(), help]);
    None
}
