//! Lines of prose: Markdown, and the comments of Rust files.

use std::fs;
use std::path::{Path, PathBuf};

/// The longest line of prose, in characters.
const WIDTH: usize = 120;

/// All hand-written files below a folder that end like this.
pub fn files(root: &Path, extension: &str) -> Vec<PathBuf> {
    /// What is generated, built, or no part of the project.
    const SKIPPED: [&str; 6] = ["target", "generated", "golden", "out", "report", "node_modules"];
    let mut found = Vec::new();
    let mut open = vec![root.to_owned()];
    while let Some(folder) = open.pop() {
        let entries = fs::read_dir(&folder).unwrap_or_else(|e| panic!("{}: {e}", folder.display()));
        for path in entries.map(|entry| entry.expect("an entry").path()) {
            let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
            let is_skipped = name.starts_with('.') || SKIPPED.contains(&name);
            // The source of `cargo xtask report` is hand-written.
            let is_source = path.ends_with("src/report");
            if path.is_dir() && (!is_skipped || is_source) {
                open.push(path);
            } else if path.is_file() && path.extension().is_some_and(|own| own == extension) {
                found.push(path);
            }
        }
    }
    found.sort();
    found
}

/// The numbers of the lines of a Markdown text that are too long: tables, code, lines that hold a link and what a tool
/// writes between `<!-- begin NAME -->` and `<!-- end NAME -->` are excepted.
pub fn long_in_markdown(text: &str) -> Vec<usize> {
    let (mut is_code, mut is_written_by_a_tool) = (false, false);
    let too_long = |(index, line): (usize, &str)| {
        let is_fence = line.trim_start().starts_with("```");
        is_code ^= is_fence;
        is_written_by_a_tool |= line.starts_with("<!-- begin ");
        is_written_by_a_tool &= !line.starts_with("<!-- end ");
        let is_table = line.trim_start().starts_with('|');
        let is_excepted = is_code || is_fence || is_written_by_a_tool || is_table || line.contains("](");
        (!is_excepted && is_long(line)).then_some(index + 1)
    };
    text.lines().enumerate().filter_map(too_long).collect()
}

/// The numbers of the lines of a Rust text that hold a comment and nothing else and are too long: tables and code in
/// them are excepted.
pub fn long_in_comments(text: &str) -> Vec<usize> {
    let mut is_code = false;
    let too_long = |(index, line): (usize, &str)| {
        let words = line.trim_start();
        let Some(words) = words.strip_prefix("//") else {
            is_code = false;
            return None;
        };
        let words = words.trim_start_matches(['/', '!']).trim_start();
        let is_fence = words.starts_with("```");
        is_code ^= is_fence;
        (!is_code && !is_fence && !words.starts_with('|') && is_long(line)).then_some(index + 1)
    };
    text.lines().enumerate().filter_map(too_long).collect()
}

fn is_long(line: &str) -> bool {
    line.chars().count() > WIDTH
}
