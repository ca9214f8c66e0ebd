//! A page of headings, text, tables and figures, written as Markdown and as HTML.

use super::chart::escaped;
use std::fmt::Write as _;

#[derive(Clone, Debug, Default)]
pub(crate) struct Page {
    blocks: Vec<Block>,
}

#[derive(Clone, Debug)]
enum Block {
    Heading(usize, String),
    Text(String),
    Table(Vec<String>, Vec<Vec<String>>),
    /// Name of the file, what is seen, and the SVG text.
    Figure(String, String, String),
    /// Name of another HTML page, and what is seen there; in HTML only.
    Frame(String, String),
}

impl Page {
    pub(crate) fn heading(&mut self, level: usize, text: impl Into<String>) {
        self.blocks.push(Block::Heading(level, text.into()));
    }

    /// A paragraph; `code` in backquotes and `[words](address)` are understood.
    pub(crate) fn text(&mut self, text: impl Into<String>) {
        self.blocks.push(Block::Text(text.into()));
    }

    pub(crate) fn table(&mut self, head: &[&str], rows: Vec<Vec<String>>) {
        self.blocks.push(Block::Table(head.iter().map(|s| (*s).to_owned()).collect(), rows));
    }

    pub(crate) fn figure(&mut self, file: String, caption: impl Into<String>, svg: String) {
        self.blocks.push(Block::Figure(file, caption.into(), svg));
    }

    /// Another page beside this one, within it.
    pub(crate) fn frame(&mut self, file: impl Into<String>, caption: impl Into<String>) {
        self.blocks.push(Block::Frame(file.into(), caption.into()));
    }

    /// The figures: file names and texts.
    pub(crate) fn figures(&self) -> impl Iterator<Item = (&str, &str)> {
        self.blocks.iter().filter_map(|block| match block {
            Block::Figure(file, _, svg) => Some((file.as_str(), svg.as_str())),
            _ => None,
        })
    }

    pub(crate) fn markdown(&self) -> String {
        let mut text = String::new();
        for block in &self.blocks {
            match block {
                Block::Heading(level, words) => {
                    let _ = writeln!(text, "{} {words}\n", "#".repeat(*level));
                }
                Block::Text(words) => {
                    let _ = writeln!(text, "{words}\n");
                }
                Block::Table(head, rows) => {
                    let line = |cells: &[String]| {
                        let cells: Vec<String> = cells.iter().map(|cell| cell.replace('|', "\\|")).collect();
                        format!("| {} |\n", cells.join(" | "))
                    };
                    text += &line(head);
                    text += &format!("|{}\n", "---|".repeat(head.len()));
                    text.extend(rows.iter().map(|row| line(row)));
                    text.push('\n');
                }
                Block::Figure(file, caption, _) => {
                    let _ = writeln!(text, "![{caption}](images/{file})\n\n*{caption}*\n");
                }
                Block::Frame(..) => {}
            }
        }
        text.truncate(text.trim_end().len());
        text + "\n"
    }

    /// One file with everything in it, but for pages in frames.
    pub(crate) fn html(&self, title: &str) -> String {
        let mut text = format!(
            "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
             <title>{}</title>\n<style>\n{STYLE}</style>\n</head>\n<body>\n",
            escaped(title)
        );
        for block in &self.blocks {
            match block {
                Block::Heading(level, words) => {
                    let _ = writeln!(text, "<h{level}>{}</h{level}>", inline(words));
                }
                Block::Text(words) => {
                    let _ = writeln!(text, "<p>{}</p>", inline(words));
                }
                Block::Table(head, rows) => {
                    text += "<table>\n<tr>";
                    text.extend(head.iter().map(|cell| format!("<th>{}</th>", inline(cell))));
                    text += "</tr>\n";
                    for row in rows {
                        text += "<tr>";
                        text.extend(row.iter().map(|cell| format!("<td>{}</td>", inline(cell))));
                        text += "</tr>\n";
                    }
                    text += "</table>\n";
                }
                Block::Figure(_, caption, svg) => {
                    let _ = writeln!(
                        text,
                        "<figure>\n{svg}<figcaption>{}</figcaption>\n</figure>",
                        inline(caption)
                    );
                }
                Block::Frame(file, caption) => {
                    let (file, caption) = (escaped(file), escaped(caption));
                    let _ = writeln!(
                        text,
                        "<iframe src=\"{file}\" title=\"{caption}\"></iframe>\n<p><a href=\"{file}\">{caption}</a></p>"
                    );
                }
            }
        }
        text + "</body>\n</html>\n"
    }
}

const STYLE: &str =
    "body { font: 15px/1.5 sans-serif; color: #222; max-width: 1320px; margin: 2em auto; padding: 0 1em; }
table { border-collapse: collapse; margin: 1em 0; }
th, td { border-bottom: 1px solid #ddd; padding: 0.25em 0.8em; text-align: left; }
th { border-bottom: 2px solid #999; }
figure { margin: 1.5em 0; }
figure svg { max-width: 100%; height: auto; }
figcaption { color: #555; }
iframe { width: 100%; height: 640px; border: 1px solid #ddd; }
code { background: #f3f3f3; padding: 0 0.25em; }
";

/// Backquotes, stars and links of Markdown in HTML.
fn inline(words: &str) -> String {
    let mut text = escaped(words);
    for (mark, element) in [("**", "b"), ("`", "code")] {
        let parts: Vec<String> = text.split(mark).map(str::to_owned).collect();
        text = parts.iter().enumerate().fold(String::new(), |all, (k, part)| match k % 2 {
            1 => format!("{all}<{element}>{part}</{element}>"),
            _ => all + part,
        });
    }
    links(&text)
}

fn links(text: &str) -> String {
    let Some((before, rest)) = text.split_once('[') else { return text.to_owned() };
    let link = rest.split_once("](").and_then(|(words, rest)| Some((words, rest.split_once(')')?)));
    match link {
        Some((words, (address, rest))) if !words.contains('[') => {
            // Each form of a page points to the same form of others.
            let address =
                address.strip_suffix(".md").map_or(address.to_owned(), |page| format!("{page}.html"));
            format!("{before}<a href=\"{address}\">{words}</a>{}", links(rest))
        }
        _ => format!("{before}[{}", links(rest)),
    }
}

#[cfg(test)]
mod tests;
