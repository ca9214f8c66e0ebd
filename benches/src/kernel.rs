//! What is measured: something that is called over and over. The program by which `cargo xtask performance` runs chains
//! has this file, too, without the rest of the crate.

use std::fmt;

/// Something to be measured.
pub struct Kernel<'a> {
    /// What it computes.
    pub what: &'static str,
    /// Who computes it.
    pub side: &'static str,
    /// Additions, multiplications and divisions, where they are known: + − × ÷ one each.
    pub flops: Option<u64>,
    /// Calls it so many times.
    repeat: Box<dyn FnMut(u64) + 'a>,
}

impl fmt::Debug for Kernel<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}, {}", self.what, self.side)
    }
}

impl<'a> Kernel<'a> {
    /// A kernel that calls this.
    pub fn new(
        what: &'static str,
        side: &'static str,
        flops: Option<u64>,
        mut call: impl FnMut() + 'a,
    ) -> Self {
        Self { what, side, flops, repeat: Box::new(move |times| (0..times).for_each(|_| call())) }
    }

    /// Calls it so many times.
    pub fn repeat(&mut self, times: u64) {
        (self.repeat)(times);
    }
}
