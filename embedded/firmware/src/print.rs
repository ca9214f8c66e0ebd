//! Printing without `core::fmt`, which can panic and is larger than the simulation.

use crate::board;

/// A line of text.
pub fn line(words: &str) {
    text(words);
    text("\n");
}

/// Text.
pub fn text(words: &str) {
    words.bytes().for_each(byte);
}

/// A whole number.
pub fn number(value: u32) {
    if value > 9 {
        number_above_nine(value / 10);
    }
    byte(digit(value % 10));
}

/// All digits but the last, the first of them first.
fn number_above_nine(value: u32) {
    let mut unit = 1;
    while value / unit > 9 {
        unit *= 10;
    }
    while unit > 0 {
        byte(digit(value / unit % 10));
        unit /= 10;
    }
}

/// A number with its sign.
pub fn signed(value: i32) {
    if value < 0 {
        byte(b'-');
    }
    number(value.unsigned_abs());
}

/// Sixteen hexadecimal digits.
pub fn bits(value: u64) {
    for place in (0..16).rev() {
        byte(digit((value >> (4 * place)) as u32 & 15));
    }
}

fn digit(value: u32) -> u8 {
    let value = value as u8;
    if value < 10 { b'0' + value } else { b'a' - 10 + value }
}

fn byte(value: u8) {
    board::write(&[value, 0]);
}
