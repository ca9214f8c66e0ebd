//! Each group of functions can be left out, and then nothing of it is in the module: no function, no trait, no call, no
//! type, no table or derived parameter that nothing reads. What is left is there as before.

use gyro_codegen::{Effort, Functions, Group, Kernel, Module};
use gyro_model::Model;
use std::collections::{BTreeMap, BTreeSet};

/// Seeds of random model files; any will do.
const SEEDS: std::ops::Range<u64> = 3100..3108;

/// A small mechanism that has all groups: a parameter, an input, a frame, a reaction.
const TOOL: &str = include_str!("../../mutants/tool.toml");

fn generated(model: &Model, functions: &Functions) -> Module {
    gyro_codegen::generate_by_effort("page.toml", model, functions, Effort::Quick).expect("a module")
}

/// The items of a module, by their first words, with the names of what they consist of.
fn items(module: &Module) -> BTreeMap<&str, BTreeSet<&str>> {
    let mut items: BTreeMap<&str, BTreeSet<&str>> = BTreeMap::new();
    let mut item = "";
    for line in module.code.lines() {
        let words = line.trim_start();
        let is_named = |kinds: &[&str]| kinds.iter().any(|kind| words.starts_with(kind));
        match line.len() - words.len() {
            0 if is_named(&["impl", "pub ", "const "]) => {
                let end = if is_named(&["const "]) { line.find(':') } else { line.find(" {") };
                item = &line[..end.unwrap_or(line.len())];
                items.entry(item).or_default();
            }
            4 if is_named(&["fn ", "type ", "pub ", "const "]) => {
                let name = words.split(['(', '=', ':', ';', '<', '{']).next().unwrap_or(words);
                items.entry(item).or_default().insert(name.trim_end());
            }
            _ => {}
        }
    }
    items
}

/// The words of a module, each with how often it is there, without comments.
fn words(module: &Module) -> BTreeMap<&str, usize> {
    let mut words = BTreeMap::new();
    let lines = module.code.lines().filter(|line| !line.trim_start().starts_with("//"));
    for word in lines.flat_map(|line| line.split(|c: char| !c.is_alphanumeric() && c != '_')) {
        *words.entry(word).or_insert(0) += 1;
    }
    words
}

/// Whether a group may be there though nobody asked: others call it, or what is told of reactions is proved for its
/// multipliers.
fn may_be_needed(module: &Module, functions: &Functions, group: Group) -> bool {
    let is_called = module.code.contains(&format!("gyro_sim::{}::", group.trait_name()));
    let is_told = functions.has(Group::JointOutputs) && Functions::of([Group::Reactions]).has(group);
    is_called || is_told
}

/// What is in a module of groups that were left out, and what is not there that belongs to none of these.
fn left_behind(full: &Module, module: &Module, functions: &Functions) -> Vec<String> {
    let not_asked: Vec<Group> = Group::all().filter(|&group| !functions.has(group)).collect();
    let may_be = |group: &Group| may_be_needed(module, functions, *group);
    let out: Vec<Group> = not_asked.iter().copied().filter(|group| !may_be(group)).collect();
    let kernels = Kernel::all().filter(|kernel| out.contains(&kernel.group())).map(Kernel::name);
    let names: Vec<String> = kernels.map(|name| name.replace(' ', "_")).collect();
    let found = words(module);
    let traits = out.iter().map(|group| group.trait_name()).filter(|name| found.contains_key(name));
    let is_there = |name: &&str| ["fn ", "::"].iter().any(|by| module.code.contains(&format!("{by}{name}(")));
    let functions = names.iter().map(String::as_str).filter(is_there);
    let named = traits.chain(functions).map(|name| format!("`{name}` is there"));
    named.chain(changed(full, module, &not_asked, &names)).chain(unused(module)).collect()
}

/// Items that are not as they are in the whole module, though they do not belong to what was left out: of these groups,
/// with these functions.
fn changed(full: &Module, module: &Module, not_asked: &[Group], names: &[String]) -> Vec<String> {
    let is_out =
        |item: &str| not_asked.iter().any(|group| item.contains(&format!("::{} for", group.trait_name())));
    let without_joints = not_asked.contains(&Group::Joint);
    let is_kept = |member: &&str| {
        let is_of_function = names.iter().any(|name| member.starts_with(&format!("fn {name}")));
        let is_of_joints = ["pub mod joint", "pub mod body"].iter().any(|word| member.starts_with(word));
        !(is_of_function || without_joints && is_of_joints)
    };
    // Without joint coordinates nothing tells the partition how far from a singular pose it is, so it sees for itself.
    let is_other = |item: &str| is_out(item) || without_joints && item.contains("::Partition for");
    let of = |module| -> BTreeMap<String, BTreeSet<String>> {
        let items = items(module).into_iter().filter(|(item, _)| !is_other(item));
        let members = |of: BTreeSet<&str>| of.into_iter().filter(is_kept).map(str::to_owned).collect();
        items.map(|(item, of)| (item.to_owned(), members(of))).collect()
    };
    let (before, after) = (of(full), of(module));
    let differ = |item: &&String| before.get(*item) != after.get(*item);
    let all: BTreeSet<&String> = before.keys().chain(after.keys()).collect();
    let words =
        |item: &String| format!("`{item}`: {:?}, with all functions {:?}", after.get(item), before.get(item));
    all.into_iter().filter(differ).map(words).collect()
}

/// Constants and derived parameters that nothing reads.
fn unused(module: &Module) -> Vec<String> {
    let words = words(module);
    let constants = module.code.lines().filter_map(|line| line.trim_start().strip_prefix("const "));
    let constants = constants.filter_map(|line| line.split(':').next()).filter(|name| words[name] < 2);
    let size = module.code.split("    derived: [T; ").nth(1).and_then(|text| text.split(']').next());
    let size: usize = size.map_or(0, |size| size.parse().expect("a number"));
    let places = (0..size).map(|place| format!("self.derived[{place}]"));
    let derived = places.filter(|place| !module.code.contains(place));
    constants.map(str::to_owned).chain(derived).map(|name| format!("`{name}` is not used")).collect()
}

/// What is left behind where each of some groups is left out.
fn problems(name: &str, text: &str, groups: &[Group]) -> Vec<String> {
    let model = gyro_model::read_with("page.toml", text, &mut gyro_pages::load).expect("a model file");
    let full = generated(&model, &Functions::all());
    let of_group = |&group: &Group| {
        let functions = Functions::all().without(group);
        let found = left_behind(&full, &generated(&model, &functions), &functions);
        found.into_iter().map(move |what| format!("{name} without `{}`: {what}", group.name()))
    };
    let itself = unused(&full).into_iter().map(|what| format!("{name}: {what}"));
    itself.chain(groups.iter().flat_map(of_group)).collect()
}

#[test]
#[ignore = "takes long: `.ci/steps` runs it"]
fn what_is_left_out_leaves_nothing_behind() {
    let groups: Vec<Group> = Group::all().filter(|&group| group != Group::Mechanism).collect();
    let some = groups.chunks(groups.len().div_ceil(SEEDS.count()));
    let random =
        SEEDS.zip(some).map(|(seed, groups)| (format!("model file {seed}"), gyro_pages::page(seed), groups));
    let models = random.chain([("the tool".to_owned(), TOOL.to_owned(), &groups[..])]);
    let found: Vec<String> = models.flat_map(|(name, text, groups)| problems(&name, &text, groups)).collect();
    assert!(found.is_empty(), "{}", found.join("\n"));
}
