//! The page of a sweep: what it was, its figures, indices and errors.

use super::super::loaded::Loaded;
use super::cloud::{self, escaped};
use super::column;
use super::gathered::{Gathered, draws};
use super::statistics;
use crate::words::number;
use std::fmt::Write as _;

/// The page's size in bytes, at most, as far as figures make it up.
const LARGEST: usize = 295_000;

/// Light or dark, as the reader has it.
const STYLE: &str = ":root { color-scheme: light dark; } body { font: 15px sans-serif; max-width: 75em; margin: 2em auto; \
    padding: 0 1em; } pre { background: #8882; padding: 1em; overflow-x: auto; } table { display: block; overflow-x: auto; } \
    td, th { padding: 0.1em 1em 0.1em 0; text-align: left; font-weight: normal; } svg { max-width: 100%; height: auto; }";

/// One HTML file that needs no other, unless a figure is too large for it.
pub(super) fn page(loaded: &Loaded, gathered: &Gathered, figures: &[(&'static str, String)]) -> String {
    let mut html = format!(
        "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>{0}</title>\n<style>{STYLE}</style></head>\n\
         <body><h1>{0}</h1>\n",
        escaped(&loaded.name)
    );
    let _ = write!(
        html,
        "<pre>{}</pre>\n<pre>{}</pre>\n",
        escaped(&loaded.text),
        escaped(&gathered.text(loaded))
    );
    if let Some(indices) = gathered.indices() {
        html += "<h2>Indices of sensitivity</h2>\n<table><tr><th></th><th>of</th><th>own part</th><th>in all</th></tr>\n";
        for (name, of) in loaded.study.numbers.iter().zip(&indices) {
            for ((draw, first), total) in draws(loaded).iter().zip(&of.first).zip(&of.total) {
                let [name, draw] = [&column(name), draw].map(|text| escaped(text));
                let [first, total] = [first, total].map(|part| number(*part, 3));
                let _ =
                    writeln!(html, "<tr><td>{draw}</td><td>{name}</td><td>{first}</td><td>{total}</td></tr>");
            }
        }
        html += "</table>\n";
    }
    let [targets, numbers] = gathered.columns(loaded, 1);
    if !numbers.is_empty() {
        html += &statistics::table(&targets, &numbers, gathered.stride);
        let _ = write!(html, "<h2>histograms</h2>\n{}", cloud::histograms(&numbers));
    }
    for (name, svg) in figures {
        // What would make the page too large stands beside it.
        let svg = match html.len() + svg.len() < LARGEST {
            true => svg.clone(),
            false => format!("<img src=\"{name}.svg\" alt=\"{name}\">"),
        };
        let _ = write!(html, "<h2>{name}</h2>\n{svg}\n");
    }
    html += "</body></html>\n";
    html
}
