//! Operations from the data sheets at the heads of generated modules.

/// A module's text.
#[derive(Clone, Copy, Debug)]
pub(crate) struct DataSheet(pub(crate) &'static str);

impl DataSheet {
    /// The operations of some functions together, as the sheet counts them.
    ///
    /// # Panics
    /// If the sheet says nothing of one of them.
    pub(crate) fn flops(self, functions: &[&str]) -> u64 {
        let total = self.cells("function").iter().position(|cell| *cell == "total");
        let total = total.expect("a data sheet has a column of totals");
        let of = |function: &&str| -> u64 {
            let cells = self.cells(function);
            let cell = cells.get(total).unwrap_or_else(|| panic!("no data sheet has `{function}`"));
            cell.parse().unwrap_or_else(|_| panic!("`{function}` has `{cell}` operations"))
        };
        functions.iter().map(of).sum()
    }

    /// The row of the table that begins so.
    fn cells(self, first: &str) -> Vec<&'static str> {
        let rows = self.0.lines().filter_map(|line| line.strip_prefix("//! |"));
        let rows = rows.map(|row| row.split('|').map(str::trim).collect::<Vec<_>>());
        rows.into_iter().find(|cells| cells.first() == Some(&first)).unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn totals_are_added_up() {
        let sheet = DataSheet(
            "//! | function | computes | + − | total |\n//! |---|---|---|---|\n//! | phi | Φ | 1 | 3 |\n//! | nu | ν | 2 | 40 |\n",
        );
        assert_eq!(sheet.flops(&["phi"]), 3);
        assert_eq!(sheet.flops(&["phi", "nu"]), 43);
        assert!(std::panic::catch_unwind(|| sheet.flops(&["gamma"])).is_err());
    }
}
