//! The page of a sweep: what it was, its figures, indices and errors.

use super::super::loaded::Loaded;
use super::column;
use super::gathered::{Gathered, draws};
use crate::words::number;
use std::fmt::Write as _;

/// One HTML file that needs no other.
pub(super) fn page(loaded: &Loaded, gathered: &Gathered, figures: &[(&'static str, String)]) -> String {
    let mut html = format!(
        "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>{0}</title>\n<style>body {{ font: 15px \
         sans-serif; max-width: 60em; margin: 2em auto; }} pre {{ background: #f4f4f4; padding: 1em; }} td, th {{ padding: \
         0.1em 1em 0.1em 0; text-align: left; }}</style></head>\n<body><h1>{0}</h1>\n",
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
    for (name, svg) in figures {
        let _ = write!(html, "<h2>{name}</h2>\n{svg}\n");
    }
    html += "</body></html>\n";
    html
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}
