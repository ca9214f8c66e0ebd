use super::{PRELUDE, names_of_parts};
use crate::keys::{ELEMENT, Kind, ROLLING, SURFACES, Table};

/// What stands in braces, up to the first dot or the equals sign.
fn paths(text: &str) -> Vec<&str> {
    let parts = text.split('{').skip(1).filter_map(|rest| rest.split_once('}'));
    let quoted = |key| text.split(key).skip(1).filter_map(|rest| rest.split_once('"'));
    parts
        .chain(quoted("given = \""))
        .chain(quoted("each = \""))
        .filter_map(|(path, _)| path.split(['.', '=']).next())
        .collect()
}

fn parts(table: &Table, kind: &Kind) -> String {
    let begins = names_of_parts(table, kind).map(|word| format!("[[{word}."));
    let parts = PRELUDE.split("\n\n").filter(|part| begins.iter().any(|begin| part.contains(begin)));
    parts.collect::<Vec<_>>().join("\n\n")
}

#[test]
fn every_kind_has_parts_that_use_its_keys_and_no_others() {
    let kinds =
        [&ELEMENT, &ROLLING].into_iter().flat_map(|table| table.kinds.iter().map(move |kind| (table, kind)));
    for (table, kind) in kinds {
        let parts = parts(table, kind);
        let mut used = paths(&parts);
        assert!(used.contains(&"name"), "{}", kind.word);
        if used.contains(&"on") {
            used.extend(["joint", "coordinate"]);
        }
        let known = |path: &&&str| !["name", "on", "k", "before", "count", "from", "to"].contains(*path);
        for path in used.iter().filter(|path| known(path)) {
            assert!(kind.key(path).is_some(), "{} has no key {path}", kind.word);
        }
        for key in kind.keys {
            assert!(used.contains(&key.name), "the key {} of {} is of no use", key.name, kind.word);
        }
    }
}

#[test]
fn the_prelude_has_no_parts_of_other_kinds() {
    let headers = PRELUDE.lines().filter_map(|line| line.strip_prefix("[["));
    for header in headers {
        let word = header.split('.').next().unwrap();
        let is_of = |table: &Table, kind: &Kind| names_of_parts(table, kind).iter().any(|name| name == word);
        let is_known = [&ELEMENT, &ROLLING, &SURFACES]
            .iter()
            .any(|table| table.kinds.iter().any(|kind| is_of(table, kind)));
        assert!(is_known, "{word}");
    }
}
