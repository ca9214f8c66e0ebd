//! How things of a module are called in C.

use crate::Precision;
use std::collections::BTreeMap;

/// Names of one exported mechanism.
#[derive(Debug)]
pub(crate) struct Names {
    /// The model's name, which begins the name of everything that can be seen from elsewhere.
    pub(crate) prefix: String,
    pub(crate) precision: Precision,
    constants: BTreeMap<Vec<String>, String>,
}

impl Names {
    /// With the named places; where two names would be put together to the same one, the later gets a number.
    pub(crate) fn new(prefix: &str, precision: Precision, indices: &[(Vec<String>, usize)]) -> Self {
        let mut names = Self { prefix: prefix.to_owned(), precision, constants: BTreeMap::new() };
        for (path, _) in indices {
            let first = names.upper(&path.join("_"));
            let is_taken = |name: &String| names.constants.values().any(|known| known == name);
            let numbered = (2..).map(|n: usize| format!("{first}_{n}"));
            let name = std::iter::once(first.clone()).chain(numbered).find(|name| !is_taken(name));
            names.constants.extend(name.map(|name| (path.clone(), name)));
        }
        names
    }

    /// A macro or constant.
    pub(crate) fn upper(&self, name: &str) -> String {
        format!("{}_{}", self.prefix, name).to_uppercase()
    }

    /// A function or type.
    pub(crate) fn own(&self, name: &str) -> String {
        format!("{}_{name}", self.prefix)
    }

    /// The name of a place, `["input", "torque"]`, in any case.
    pub(crate) fn constant(&self, path: &[&str]) -> String {
        let (last, above) = path.split_last().expect("a place has a name");
        let path: Vec<String> =
            above.iter().map(|part| (*part).to_owned()).chain([last.to_uppercase()]).collect();
        self.constants.get(&path).cloned().unwrap_or_else(|| self.upper(&path.join("_")))
    }

    /// A local variable or an argument; the leading underscore of one that is not read is Rust's.
    pub(crate) fn variable(&self, name: &str) -> String {
        name.trim_start_matches('_').to_owned()
    }

    /// A text that is written for a mechanism called `gyro`, for this one.
    pub(crate) fn applied(&self, template: &str) -> String {
        // The type itself has no further word.
        let text = template.replace("const gyro *", "const \u{1} *");
        let text = text.replace("GYRO_", &self.upper("")).replace("gyro_", &self.own(""));
        text.replace('\u{1}', &self.prefix)
    }
}
