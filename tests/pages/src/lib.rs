//! Random model files: correct mechanisms with everything that the format has, written as people and programs write
//! them.
//!
//! Trees of one to four bodies with joints of all kinds, roots that are fixed, driven, free or held by rows of their
//! own, planar linkages and other loops, couplers, drivers, forces and outputs; numbers that a program printed, that
//! somebody shortened, that differ by less than a float can tell. A start is planted: joints that close loops are put
//! where the bodies already are. So no model file should be refused by anybody.
//!
//! ```
//! let text = gyro_pages::page(7);
//! let model = gyro_model::read_with("page.toml", &text, &mut gyro_pages::load).expect("a correct model file");
//! assert!(model.assemble().is_ok());
//! ```
#![deny(missing_docs)]

mod bodies;
mod bushings;
mod closing;
mod dice;
mod elements;
mod laws;
mod linkages;
mod loops;
mod page;
mod pairs;
mod ready;
mod rubbing;
mod scenes;
mod touching;
mod vector;

use dice::Dice;
use page::Page;

pub use rubbing::rubbing;
pub use scenes::scene;

/// The model file of a seed, always the same: some numbers are written as results of arithmetic.
pub fn page(seed: u64) -> String {
    let mut page = Page::new(seed);
    page.ways = Some(Dice::new(!seed));
    text(page, seed)
}

/// The same mechanism with all numbers and parameters written plainly.
pub fn plain_page(seed: u64) -> String {
    text(Page::new(seed), seed)
}

fn text(mut page: Page, seed: u64) -> String {
    page.tree();
    let chain = (page.is_closed && page.dice.once_in(2)).then(|| page.chain());
    page.drivers();
    if page.is_closed {
        for _ in 0..page.dice.pick(&[0, 0, 1, 2, 3]) {
            page.coupler();
        }
        match chain {
            Some(chain) => page.close_chain(&chain),
            None => page.close(),
        }
        if page.dice.once_in(8) {
            page.close();
        }
    }
    page.rollings(seed);
    page.pairs(seed);
    let places = loops::places(&page.read());
    page.forces(&places);
    page.outputs();
    if page.is_closed && page.rotors.once_in(3) {
        page.hold_all();
    }
    page.elastic_outputs();
    page.laws(seed);
    page.curves(seed);
    page.bushings(seed);
    page.ready(seed);
    page.touching(seed);
    page.rates(seed);
    page.read();
    page.text()
}

/// The one table that model files name.
///
/// # Errors
/// Any other.
pub fn load(name: &str) -> Result<String, String> {
    if name == "t.csv" { Ok(TABLE.to_owned()) } else { Err(format!("there is no {name}")) }
}

/// The text of `t.csv`.
pub const TABLE: &str = "t,x\n0,0\n0.5,0.1\n1,0.3333333333333333\n2,-0.25\n";
