//! Colours of terms: terms have one colour if they are alike as far as some steps around them reach, constants, signs
//! and indices of variables left out.

use super::terms::{Place, Terms};
use rustc_hash::FxHasher;
use std::hash::{Hash, Hasher};

/// Colours by this many steps from operands and users.
pub fn colours(terms: &Terms, n_steps: usize) -> Vec<u64> {
    let mut colours: Vec<u64> = terms.all.iter().map(|term| hash(&(term.kind, term.is_root))).collect();
    for _ in 0..n_steps {
        let mut users = Vec::new();
        colours = (0..terms.all.len()).map(|place| refined(terms, &colours, place, &mut users)).collect();
    }
    colours
}

/// `users` is room for those of the term.
fn refined(terms: &Terms, colours: &[u64], place: Place, users: &mut Vec<(u64, bool)>) -> u64 {
    let term = &terms.all[place];
    let mut operands = [0; 2];
    let operands = &mut operands[..term.operands.len()];
    operands.iter_mut().zip(&*term.operands).for_each(|(colour, operand)| *colour = colours[operand.term]);
    if term.kind.is_commutative() {
        operands.sort_unstable();
    }
    let as_operand = |&user: &Place| {
        let user_term = &terms.all[user];
        let is_first = user_term.operands[0].term == place;
        (colours[user], !user_term.kind.is_commutative() && is_first)
    };
    users.clear();
    users.extend(term.users.iter().map(as_operand));
    users.sort_unstable();
    hash(&(colours[place], operands, users))
}

fn hash(value: &impl Hash) -> u64 {
    let mut hasher = FxHasher::default();
    value.hash(&mut hasher);
    hasher.finish()
}
