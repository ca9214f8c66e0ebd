//! Of a firmware's ELF file: sizes of sections, symbols, and the stack that each function takes.

use gyro_cli::failure::Failure;
use gyro_cli::programs::io_failure;
use object::elf::FileHeader32;
use object::read::elf::ElfFile;
use object::{Bytes, LittleEndian, Object, ObjectSection, ObjectSymbol, U32Bytes};
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// A 32-bit little-endian ELF file, as the linker writes it for these chips.
pub(crate) struct Elf {
    sizes: BTreeMap<String, u64>,
    symbols: Vec<(u64, String)>,
    lengths: BTreeMap<String, u64>,
    stack_sizes: BTreeMap<u64, u64>,
}

impl Elf {
    pub(crate) fn read(path: &Path) -> Result<Self, Failure> {
        let data = fs::read(path).map_err(|e| io_failure(path, &e))?;
        Self::parse(&data).map_err(|e| Failure::Run(format!("{}: {e}", path.display())))
    }

    fn parse(data: &[u8]) -> object::Result<Self> {
        let file: ElfFile<'_, FileHeader32<LittleEndian>> = ElfFile::parse(data)?;
        let mut sizes = BTreeMap::new();
        for section in file.sections() {
            sizes.insert(section.name()?.to_owned(), section.size());
        }
        let (mut symbols, mut lengths) = (Vec::new(), BTreeMap::new());
        for symbol in file.symbols() {
            // The lowest bit of an address says that the code is Thumb's.
            symbols.push((symbol.address() & !1, symbol.name()?.to_owned()));
            lengths.insert(symbol.name()?.to_owned(), symbol.size());
        }
        symbols.retain(|(_, name)| !name.is_empty());
        let stack = file.section_by_name(".stack_sizes").map_or(Ok(&[][..]), |section| section.data())?;
        Ok(Self { sizes, symbols, lengths, stack_sizes: stack_sizes(stack) })
    }

    /// Bytes of a section; none if there is none.
    pub(crate) fn size(&self, section: &str) -> u64 {
        self.sizes.get(section).copied().unwrap_or(0)
    }

    /// Bytes of the functions whose mangled names contain this; none if there are none, as they were inlined.
    pub(crate) fn length(&self, name: &str) -> Option<u64> {
        let found = self.lengths.iter().filter(|(mangled, length)| mangled.contains(name) && **length > 0);
        found.map(|(_, length)| *length).reduce(|sum, length| sum + length)
    }

    /// Address and name of all symbols.
    pub(crate) fn symbols(&self) -> &[(u64, String)] {
        &self.symbols
    }

    /// Bytes of stack of the function at each address, of those that say so.
    pub(crate) fn stack_sizes(&self) -> &BTreeMap<u64, u64> {
        &self.stack_sizes
    }
}

/// The compiler's section of stack sizes: of each function its address, and its bytes of stack as a LEB128 number.
fn stack_sizes(section: &[u8]) -> BTreeMap<u64, u64> {
    let mut section = Bytes(section);
    let mut sizes = BTreeMap::new();
    while let (Ok(address), Ok(size)) = (section.read::<U32Bytes<LittleEndian>>(), section.read_uleb128()) {
        // Functions that were put together are listed under one address.
        let most = sizes.entry(u64::from(address.get(LittleEndian)) & !1).or_insert(0);
        *most = size.max(*most);
    }
    sizes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_largest_stack_of_an_address_counts() {
        let section = [1, 0x80, 0, 0, 0xe5, 0x8e, 0x26, 0, 0x80, 0, 0, 8];
        assert_eq!(stack_sizes(&section), BTreeMap::from([(0x8000, 624_485)]));
    }

    #[test]
    fn what_is_not_an_elf_file_is_refused() {
        assert!(Elf::parse(b"#!/bin/sh").is_err());
        assert!(Elf::parse(b"\x7fELF\x01\x01").is_err());
    }
}
