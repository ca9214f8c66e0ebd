//! The little of an ELF file that is of interest: sections, symbols, and the stack that each function takes.
//!
//! 32 bits, little-endian, as the linker writes it for these chips.

use crate::failure::Failure;
use crate::programs::io_failure;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

pub(crate) struct Elf {
    data: Vec<u8>,
    sections: Vec<Section>,
}

struct Section {
    name: String,
    offset: usize,
    size: usize,
    /// The section that this one refers to.
    link: usize,
}

/// Size of an entry of the symbol table, and of the table of sections.
const SYMBOL: usize = 16;
const HEADER: usize = 40;

impl Elf {
    pub(crate) fn read(path: &Path) -> Result<Self, Failure> {
        let data = fs::read(path).map_err(|e| io_failure(path, &e))?;
        Self::parse(data).ok_or_else(|| Failure::Run(format!("{} is not as expected", path.display())))
    }

    fn parse(data: Vec<u8>) -> Option<Self> {
        if !data.starts_with(b"\x7fELF\x01\x01") {
            return None;
        }
        let [table, number, names] = [word(&data, 32)?, half(&data, 48)?, half(&data, 50)?];
        let header = |index: usize, field: usize| word(&data, table + HEADER * index + 4 * field);
        let mut sections = Vec::new();
        for index in 0..number {
            let name = string(&data, header(names, 4)? + header(index, 0)?)?;
            let (offset, size, link) = (header(index, 4)?, header(index, 5)?, header(index, 6)?);
            sections.push(Section { name, offset, size, link });
        }
        Some(Self { data, sections })
    }

    fn section(&self, name: &str) -> Option<&Section> {
        self.sections.iter().find(|section| section.name == name)
    }

    /// Bytes of a section; none if there is none.
    pub(crate) fn size(&self, section: &str) -> usize {
        self.section(section).map_or(0, |section| section.size)
    }

    /// Address and name of all symbols; the lowest bit of an address says that the code is Thumb's, and is dropped.
    pub(crate) fn symbols(&self) -> Vec<(usize, String)> {
        let Some(table) = self.section(".symtab") else { return Vec::new() };
        let strings = self.sections.get(table.link).map_or(0, |section| section.offset);
        let symbol = |index: usize| {
            let at = table.offset + SYMBOL * index;
            let name = string(&self.data, strings + word(&self.data, at)?)?;
            Some((word(&self.data, at + 4)? & !1, name))
        };
        (0..table.size / SYMBOL).filter_map(symbol).filter(|(_, name)| !name.is_empty()).collect()
    }

    /// Bytes of stack of the function at each address, of those that say so.
    pub(crate) fn stack_sizes(&self) -> BTreeMap<usize, u64> {
        let Some(section) = self.section(".stack_sizes") else { return BTreeMap::new() };
        let (mut at, end) = (section.offset, section.offset + section.size);
        let mut sizes = BTreeMap::new();
        while at + 4 < end {
            let Some(address) = word(&self.data, at) else { break };
            let (size, next) = leb128(&self.data, at + 4);
            // Functions that were put together are listed under one address.
            let most = sizes.entry(address & !1).or_insert(0);
            *most = size.max(*most);
            at = next;
        }
        sizes
    }
}

fn word(data: &[u8], at: usize) -> Option<usize> {
    let bytes = data.get(at..at + 4)?.try_into().ok()?;
    usize::try_from(u32::from_le_bytes(bytes)).ok()
}

fn half(data: &[u8], at: usize) -> Option<usize> {
    Some(usize::from(u16::from_le_bytes(data.get(at..at + 2)?.try_into().ok()?)))
}

fn string(data: &[u8], at: usize) -> Option<String> {
    let bytes = data.get(at..)?.split(|byte| *byte == 0).next()?;
    Some(String::from_utf8_lossy(bytes).into_owned())
}

/// A number in groups of seven bits, the low ones first, and where the next begins.
fn leb128(data: &[u8], mut at: usize) -> (u64, usize) {
    let (mut value, mut shift) = (0, 0);
    while let Some(byte) = data.get(at) {
        value |= u64::from(byte & 0x7f) << shift;
        (at, shift) = (at + 1, shift + 7);
        if byte & 0x80 == 0 || shift > 56 {
            break;
        }
    }
    (value, at)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_in_groups_of_seven_bits() {
        assert_eq!(leb128(&[0xe5, 0x8e, 0x26, 0xff], 0), (624_485, 3));
        assert_eq!(leb128(&[0x08], 0), (8, 1));
    }

    #[test]
    fn what_is_not_an_elf_file_is_refused() {
        assert!(Elf::parse(b"#!/bin/sh".to_vec()).is_none());
        assert!(Elf::parse(b"\x7fELF\x01\x01".to_vec()).is_none());
    }
}
