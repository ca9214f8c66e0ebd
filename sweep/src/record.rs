//! Blocks of scenarios as bytes with a checksum: what programs answer and what files hold.
//!
//! ```text
//! length of the rest u32 | CRC-32 of the rest u32 | first scenario u64 | scenarios u32 | numbers f64 … | errors
//! ```
//! Little-endian. An error is its row u32, its length u32 and UTF-8 text.

use std::io::{self, Read};

/// Some scenarios that follow each other.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Block {
    /// Number of the first scenario.
    pub first: u64,
    /// How many there are.
    pub count: u32,
    /// What was kept of them, scenario after scenario.
    pub numbers: Vec<f64>,
    /// Rows that failed, in their order, and why.
    pub errors: Vec<(u32, String)>,
}

/// A record longer than this, in bytes, is none.
const LONGEST: u32 = 1 << 30;

/// Bytes before the numbers.
const HEAD: usize = 12;

impl Block {
    /// The bytes of the block.
    pub fn encode(&self) -> Vec<u8> {
        let mut bytes = vec![0; 8];
        bytes.extend(self.first.to_le_bytes());
        bytes.extend(self.count.to_le_bytes());
        self.numbers.iter().for_each(|number| bytes.extend(number.to_le_bytes()));
        for (row, words) in &self.errors {
            bytes.extend(row.to_le_bytes());
            bytes.extend(u32::try_from(words.len()).unwrap_or(0).to_le_bytes());
            bytes.extend(words.as_bytes());
        }
        let length = u32::try_from(bytes.len() - 8).expect("blocks are shorter than a gigabyte");
        bytes[..4].copy_from_slice(&length.to_le_bytes());
        let sum = crc32fast::hash(&bytes[8..]);
        bytes[4..8].copy_from_slice(&sum.to_le_bytes());
        bytes
    }

    /// Reads the bytes of a block with so many numbers in each row.
    ///
    /// # Errors
    /// `InvalidData` if they are not as they were written.
    pub fn decode(bytes: &[u8], width: usize) -> io::Result<Self> {
        let wrong = || io::Error::new(io::ErrorKind::InvalidData, "a block is damaged");
        let (head, rest) = bytes.split_at_checked(8).ok_or_else(wrong)?;
        let word =
            |at: usize| -> u32 { u32::from_le_bytes(head[at..at + 4].try_into().expect("four bytes")) };
        if word(0) as usize != rest.len() || word(4) != crc32fast::hash(rest) || rest.len() < HEAD {
            return Err(wrong());
        }
        let first = u64::from_le_bytes(rest[..8].try_into().expect("eight bytes"));
        let count = u32::from_le_bytes(rest[8..HEAD].try_into().expect("four bytes"));
        let length = (count as usize).checked_mul(8 * width).ok_or_else(wrong)?;
        let (numbers, mut errors) = rest[HEAD..].split_at_checked(length).ok_or_else(wrong)?;
        let numbers = numbers.chunks_exact(8);
        let numbers = numbers.map(|b| f64::from_le_bytes(b.try_into().expect("eight bytes"))).collect();
        let mut block = Self { first, count, numbers, errors: Vec::new() };
        while !errors.is_empty() {
            let (head, rest) = errors.split_at_checked(8).ok_or_else(wrong)?;
            let [row, length] =
                [0, 4].map(|at| u32::from_le_bytes(head[at..at + 4].try_into().expect("four bytes")));
            let (words, rest) = rest.split_at_checked(length as usize).ok_or_else(wrong)?;
            block.errors.push((row, String::from_utf8(words.to_vec()).map_err(|_| wrong())?));
            errors = rest;
        }
        Ok(block)
    }

    /// The rows: numbers, and the error if there is one.
    pub fn rows(&self) -> impl Iterator<Item = (u64, &[f64], Option<&str>)> {
        let width = self.numbers.len() / (self.count as usize).max(1);
        let mut errors = self.errors.iter().peekable();
        (0..self.count).map(move |row| {
            let at = row as usize * width;
            let error = errors.next_if(|(failed, _)| *failed == row).map(|(_, words)| words.as_str());
            (self.first + u64::from(row), &self.numbers[at..at + width], error)
        })
    }
}

/// The bytes of the next block, checked; `None` at the end.
///
/// # Errors
/// `UnexpectedEof` or `InvalidData` if the last block is not whole; that of the input.
pub fn next(input: &mut impl Read) -> io::Result<Option<Vec<u8>>> {
    let mut head = [0; 8];
    match input.read(&mut head[..1])? {
        0 => return Ok(None),
        _ => input.read_exact(&mut head[1..])?,
    }
    let word = |at: usize| u32::from_le_bytes(head[at..at + 4].try_into().expect("four bytes"));
    let damaged = || io::Error::new(io::ErrorKind::InvalidData, "a block is damaged");
    if word(0) > LONGEST {
        return Err(damaged());
    }
    let mut bytes = head.to_vec();
    let read = input.take(u64::from(word(0))).read_to_end(&mut bytes)?;
    if read != word(0) as usize {
        return Err(io::ErrorKind::UnexpectedEof.into());
    }
    if crc32fast::hash(&bytes[8..]) != word(4) {
        return Err(damaged());
    }
    Ok(Some(bytes))
}

#[cfg(test)]
mod tests;
