//! Functions by their names.

use crate::groups::Functions;
use gyro_program::Group;
use gyro_program::Kernel;
use std::fmt;

/// A name that no function and no group has.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnknownFunction {
    /// The name.
    pub name: String,
}

/// The word for all groups.
const ALL: &str = "all";

/// The word for those that solvers call.
const SOLVERS: &str = "solvers";

impl Functions {
    /// Groups by their names or by those of functions, each with what it needs; `all` stands for all of them,
    /// `solvers` for [`Functions::of_solvers`]. What solvers and observers of every mechanism need is always there.
    ///
    /// # Errors
    /// The first name that is not known.
    pub fn named<'n>(names: impl IntoIterator<Item = &'n str>) -> Result<Self, UnknownFunction> {
        let of_name = |name: &str| {
            let of_solvers = Self::of_solvers();
            let is_meant = |group: Group| {
                name == ALL || name == SOLVERS && of_solvers.has(group) || group.name() == name
            };
            let of_group = Group::all().filter(|&group| is_meant(group));
            let of_function = Kernel::all().filter(|kernel| kernel.name() == name).map(Kernel::group);
            let groups: Vec<Group> = of_group.chain(of_function).collect();
            if groups.is_empty() { Err(UnknownFunction { name: name.to_owned() }) } else { Ok(groups) }
        };
        let groups: Result<Vec<_>, _> = names.into_iter().map(of_name).collect();
        Ok(Self::of(groups?.concat()))
    }

    /// A line for each group, with its functions, for help texts.
    pub fn help() -> String {
        let mut lines = Vec::new();
        for group in Group::all() {
            let functions = Kernel::all().filter(|kernel| kernel.group() == group).map(Kernel::name);
            let functions = functions.collect::<Vec<_>>().join(", ");
            let (name, what, of) = (group.name(), group.what(), group.trait_name());
            lines.push(format!("{name:18} {what} (trait {of}): {functions}"));
        }
        lines.push(format!("{SOLVERS:18} what solvers, their corrections and linearisations call"));
        lines.push(format!("{ALL:18} all of them"));
        lines.join("\n")
    }
}

impl fmt::Display for UnknownFunction {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let groups: Vec<&str> = Group::all().map(Group::name).chain([SOLVERS, ALL]).collect();
        let functions: Vec<&str> = Kernel::all().map(Kernel::name).collect();
        write!(f, "unknown function `{}`", self.name)?;
        let known: Vec<&str> = groups.iter().chain(&functions).copied().collect();
        if let Some(meant) = gyro_model::meant(&self.name, &known) {
            write!(f, ": did you mean `{meant}`?")?;
        }
        write!(f, "\nthere are the groups {} and the functions {}", groups.join(", "), functions.join(", "))
    }
}

impl std::error::Error for UnknownFunction {}

#[cfg(test)]
mod tests;
