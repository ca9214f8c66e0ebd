//! The modules of a crate, a file each, and which of them use which.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;
use syn::visit::{self, Visit};
use syn::{Attribute, Item, UseTree};

/// Modules by their paths inside the crate.
#[derive(Debug, Default)]
pub struct Modules {
    /// What each uses, itself left out.
    pub uses: BTreeMap<String, BTreeSet<String>>,
}

impl Modules {
    /// Reads all files under a crate's `src`. What is only compiled for tests, and the root that declares the modules,
    /// is left out.
    pub fn of(source: &Path) -> Self {
        let mut files = BTreeMap::new();
        read(source, "", &mut files);
        let names: BTreeSet<String> = files.keys().cloned().collect();
        let uses = files.iter().map(|(module, file)| (module.clone(), used(module, file, &names))).collect();
        Self { uses }
    }
}

/// Which files and folders right under a crate's `src` use which, also by names that the root has from them.
pub fn stages(source: &Path) -> BTreeMap<String, BTreeSet<String>> {
    let mut files = BTreeMap::new();
    read(source, "", &mut files);
    let first = |module: &str| module.split("::").next().unwrap_or(module).to_owned();
    let tops: BTreeSet<String> = files.keys().map(|module| first(module)).collect();
    let root = fs::read_to_string(source.join("lib.rs")).expect("a root");
    let mut of_root = Vec::new();
    for item in syn::parse_file(&root).expect("Rust").items {
        if let Item::Use(item) = item {
            collect(&item.tree, &mut Vec::new(), &mut of_root);
        }
    }
    let from: BTreeMap<String, String> = of_root
        .iter()
        .map(|path| if path[0] == "self" { &path[1..] } else { &path[..] })
        .filter(|path| tops.contains(&path[0]))
        .map(|path| (path[path.len() - 1].clone(), path[0].clone()))
        .collect();
    let mut found: BTreeMap<String, BTreeSet<String>> =
        tops.iter().map(|top| (top.clone(), BTreeSet::new())).collect();
    let is_test = |module: &str| module.split("::").any(|part| part == "tests");
    for (module, file) in files.iter().filter(|(module, _)| !is_test(module)) {
        let (top, mut paths) = (first(module), Paths::default());
        paths.visit_file(file);
        let named = paths.found.iter().filter_map(|path| in_root(module, path));
        let stage = |name: String| from.get(&name).cloned().or_else(|| tops.get(&name).cloned());
        let others = named.filter_map(stage).filter(|stage| *stage != top);
        found.entry(top.clone()).or_default().extend(others.collect::<Vec<_>>());
    }
    found
}

/// The name that a path has in the root of its crate.
fn in_root(module: &str, path: &[String]) -> Option<String> {
    let above = path.iter().take_while(|name| *name == "super").count();
    match path.first()?.as_str() {
        "crate" => path.get(1).cloned(),
        "super" if above == module.split("::").count() => path.get(above).cloned(),
        _ => None,
    }
}

fn read(folder: &Path, path: &str, files: &mut BTreeMap<String, syn::File>) {
    let entries = fs::read_dir(folder).unwrap_or_else(|e| panic!("{}: {e}", folder.display()));
    for entry in entries.map(|entry| entry.expect("an entry").path()) {
        let stem = entry.file_stem().and_then(|stem| stem.to_str()).expect("a name").to_owned();
        let inside = if path.is_empty() { stem.clone() } else { format!("{path}::{stem}") };
        if entry.is_dir() {
            // Generated modules use nothing of the crate that they are in.
            if stem != "generated" {
                read(&entry, &inside, files);
            }
        } else if entry.extension().is_some_and(|extension| extension == "rs") {
            let module = match stem.as_str() {
                "lib" | "main" if path.is_empty() => continue,
                "mod" => path.to_owned(),
                _ => inside,
            };
            let text = fs::read_to_string(&entry).expect("a file");
            files.insert(module, syn::parse_file(&text).expect("Rust"));
        }
    }
}

fn used(module: &str, file: &syn::File, names: &BTreeSet<String>) -> BTreeSet<String> {
    let mut paths = Paths::default();
    paths.visit_file(file);
    let modules = paths.found.iter().filter_map(|path| resolved(module, path, names));
    modules.filter(|used| used != module).collect()
}

/// The module that a path leads into.
fn resolved(module: &str, path: &[String], names: &BTreeSet<String>) -> Option<String> {
    let mut from: Vec<&str> = module.split("::").collect();
    let mut rest = path.iter().map(String::as_str).peekable();
    match rest.next()? {
        "crate" => from.clear(),
        "self" => {}
        "super" => {
            from.pop();
            while rest.next_if_eq(&"super").is_some() {
                from.pop();
            }
        }
        _ => return None,
    }
    from.extend(rest);
    (1..=from.len()).rev().map(|length| from[..length].join("::")).find(|name| names.contains(name))
}

/// All paths of a file that begin with `crate`, `self` or `super`.
#[derive(Default)]
struct Paths {
    found: Vec<Vec<String>>,
}

impl<'f> Visit<'f> for Paths {
    fn visit_item(&mut self, item: &'f Item) {
        let attributes: &[Attribute] = match item {
            Item::Mod(item) => &item.attrs,
            Item::Use(item) => &item.attrs,
            Item::Fn(item) => &item.attrs,
            Item::Impl(item) => &item.attrs,
            _ => &[],
        };
        let is_test = |attribute: &Attribute| {
            attribute.path().is_ident("test")
                || attribute.parse_args::<syn::Ident>().is_ok_and(|name| name == "test")
        };
        if !attributes.iter().any(is_test) {
            visit::visit_item(self, item);
        }
    }

    fn visit_use_tree(&mut self, tree: &'f UseTree) {
        collect(tree, &mut Vec::new(), &mut self.found);
    }

    fn visit_path(&mut self, path: &'f syn::Path) {
        self.found.push(path.segments.iter().map(|segment| segment.ident.to_string()).collect());
        visit::visit_path(self, path);
    }
}

fn collect(tree: &UseTree, before: &mut Vec<String>, found: &mut Vec<Vec<String>>) {
    match tree {
        UseTree::Path(path) => {
            before.push(path.ident.to_string());
            collect(&path.tree, before, found);
            before.pop();
        }
        UseTree::Group(group) => group.items.iter().for_each(|tree| collect(tree, before, found)),
        UseTree::Name(name) => found.push(with(before, &name.ident.to_string())),
        UseTree::Rename(rename) => found.push(with(before, &rename.ident.to_string())),
        UseTree::Glob(_) => found.push(before.clone()),
    }
}

fn with(before: &[String], last: &str) -> Vec<String> {
    before.iter().cloned().chain([last.to_owned()]).collect()
}

/// The sets of modules of which each leads to all others of its set.
pub fn circles(uses: &BTreeMap<String, BTreeSet<String>>) -> Vec<Vec<String>> {
    let reachable = |start: &String| {
        let (mut reached, mut open) = (BTreeSet::new(), vec![start.clone()]);
        while let Some(module) = open.pop() {
            for used in uses.get(&module).into_iter().flatten() {
                if reached.insert(used.clone()) {
                    open.push(used.clone());
                }
            }
        }
        reached
    };
    let reached: BTreeMap<&String, BTreeSet<String>> = uses.keys().map(|m| (m, reachable(m))).collect();
    let circle = |module: &String| -> BTreeSet<String> {
        let back = |other: &&String| reached.get(other).is_some_and(|further| further.contains(module));
        reached[module].iter().filter(back).cloned().collect()
    };
    let found: BTreeSet<BTreeSet<String>> = uses.keys().map(circle).filter(|c| !c.is_empty()).collect();
    found.into_iter().map(|circle| circle.into_iter().collect()).collect()
}
