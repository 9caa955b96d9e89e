//! A text as words that know their line.

use std::str::FromStr;

use super::{Fault, MeshFault};

/// The words of a file that are still to be read.
#[derive(Clone)]
pub(super) struct Words<'a> {
    bytes: &'a [u8],
    at: usize,
    line: u64,
}

impl<'a> Words<'a> {
    pub fn new(bytes: &'a [u8]) -> Self {
        Self { bytes, at: 0, line: 1 }
    }

    /// Line of the last word.
    pub fn line(&self) -> u64 {
        self.line
    }

    /// The next word, if there is one. Bytes that are no text make a word that nothing expects.
    pub fn word(&mut self) -> Option<&'a str> {
        let rest = &self.bytes[self.at..];
        let space = rest.iter().take_while(|byte| byte.is_ascii_whitespace());
        let (mut skipped, mut lines) = (0, 0);
        for byte in space {
            skipped += 1;
            lines += u64::from(*byte == b'\n');
        }
        self.line += lines;
        let rest = &rest[skipped..];
        let length = rest.iter().take_while(|byte| !byte.is_ascii_whitespace()).count();
        self.at += skipped + length;
        (length > 0).then(|| str::from_utf8(&rest[..length]).unwrap_or("\u{fffd}"))
    }

    /// The next word without taking it.
    pub fn peek(&self) -> Option<&'a str> {
        self.clone().word()
    }

    /// The next word, which must be there.
    pub fn some(&mut self, expected: &'static str) -> Result<&'a str, Fault> {
        self.word().ok_or((None, MeshFault::Ends { expected }))
    }

    /// The next word as a number of some kind.
    pub fn number<T: FromStr>(&mut self, expected: &'static str) -> Result<T, Fault> {
        let word = self.some(expected)?;
        word.parse().map_err(|_| self.unexpected(word, expected))
    }

    /// The next word as a number that is finite.
    pub fn real(&mut self, expected: &'static str) -> Result<f64, Fault> {
        let word = self.some(expected)?;
        match word.parse::<f64>() {
            Ok(number) if number.is_finite() => Ok(number),
            _ => Err(self.unexpected(word, expected)),
        }
    }

    /// Takes a word that must be this one.
    pub fn take(&mut self, wanted: &'static str) -> Result<(), Fault> {
        let word = self.some(wanted)?;
        if word.eq_ignore_ascii_case(wanted) { Ok(()) } else { Err(self.unexpected(word, wanted)) }
    }

    /// The rest of the line.
    pub fn rest_of_line(&mut self) -> String {
        let rest = &self.bytes[self.at..];
        let length = rest.iter().take_while(|byte| **byte != b'\n').count();
        self.at += length;
        String::from_utf8_lossy(&rest[..length]).trim().to_owned()
    }

    /// Goes to the start of the next line.
    pub fn end_line(&mut self) {
        self.rest_of_line();
        if !self.is_at_end() {
            (self.at, self.line) = (self.at + 1, self.line + 1);
        }
    }

    /// Whether nothing is left, not even blanks.
    pub fn is_at_end(&self) -> bool {
        self.at >= self.bytes.len()
    }

    /// A fault on the line of the last word.
    pub fn fault(&self, fault: MeshFault) -> Fault {
        (Some(self.line), fault)
    }

    /// The fault that a word is another one than expected.
    pub fn unexpected(&self, got: &str, expected: &'static str) -> Fault {
        let got = got.chars().take(40).collect();
        self.fault(MeshFault::Unexpected { got, expected })
    }
}
