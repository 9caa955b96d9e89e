//! The words of an expression.

use std::ops::Range;

use super::{ExpressionError, MAX_LENGTH};

/// A word and its bytes.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Token<'a> {
    pub kind: TokenKind<'a>,
    pub span: Range<usize>,
}

/// The kinds of word.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum TokenKind<'a> {
    Number(f64),
    Name(&'a str),
    /// One of `+ - * / ^`.
    Operator(char),
    Open,
    Close,
    Comma,
}

/// Splits `text` into words.
pub(super) fn tokens(text: &str) -> Result<Vec<Token<'_>>, ExpressionError> {
    if text.len() > MAX_LENGTH {
        let message =
            format!("the expression has {} bytes, at most {MAX_LENGTH} are allowed", text.len());
        return Err(ExpressionError::new(0..text.len(), message, "too long")
            .help("name parts of it in [parameters]"));
    }
    let mut tokens = Vec::new();
    let mut offset = 0;
    while let Some(first) = text[offset..].chars().next() {
        let rest = &text[offset..];
        let (kind, length) = match first {
            ' ' | '\t' | '\n' | '\r' => {
                offset += 1;
                continue;
            }
            '(' => (TokenKind::Open, 1),
            ')' => (TokenKind::Close, 1),
            ',' => (TokenKind::Comma, 1),
            '*' if rest.starts_with("**") => {
                let message = "`**` is not an operator";
                return Err(ExpressionError::new(offset..offset + 2, message, "not an operator")
                    .help("write `^` for a power"));
            }
            '+' | '-' | '*' | '/' | '^' => (TokenKind::Operator(first), 1),
            '0'..='9' | '.' => number(rest, offset)?,
            c if c.is_alphabetic() || c == '_' => {
                let length = rest.find(|c: char| !(c.is_alphanumeric() || c == '_'));
                let length = length.unwrap_or(rest.len());
                (TokenKind::Name(&rest[..length]), length)
            }
            other => return Err(unexpected(other, offset)),
        };
        tokens.push(Token { kind, span: offset..offset + length });
        offset += length;
    }
    Ok(tokens)
}

/// Reads digits, a point with digits, and an exponent at the start of `rest`.
fn number(rest: &str, offset: usize) -> Result<(TokenKind<'_>, usize), ExpressionError> {
    let bytes = rest.as_bytes();
    let digits = |from: usize| bytes[from..].iter().take_while(|b| b.is_ascii_digit()).count();
    let mut length = digits(0);
    if bytes.get(length) == Some(&b'.') {
        length += 1 + digits(length + 1);
    }
    if matches!(bytes.get(length), Some(b'e' | b'E')) {
        let sign = usize::from(matches!(bytes.get(length + 1), Some(b'+' | b'-')));
        let exponent = digits((length + 1 + sign).min(bytes.len()));
        if exponent > 0 {
            length += 1 + sign + exponent;
        }
    }
    let text = &rest[..length];
    let span = offset..offset + length;
    match text.parse::<f64>() {
        Ok(value) if value.is_finite() => Ok((TokenKind::Number(value), length)),
        Ok(_) => {
            let message = format!("`{text}` is larger than any number that can be computed with");
            Err(ExpressionError::new(span, message, "too large"))
        }
        Err(_) => {
            Err(ExpressionError::new(span, format!("`{text}` is not a number"), "not a number"))
        }
    }
}

fn unexpected(found: char, offset: usize) -> ExpressionError {
    let span = offset..offset + found.len_utf8();
    let shown = found.escape_debug();
    let error = ExpressionError::new(
        span,
        format!("`{shown}` has no meaning in an expression"),
        "not expected here",
    );
    match found {
        '<' | '>' | '=' | '?' | ':' | '!' | '&' | '|' => error
            .help("there are no comparisons: `step(t - 1)` is 0 before t = 1 and 1 from there on"),
        '×' | '·' => error.help("write `*`"),
        '÷' => error.help("write `/`"),
        '−' | '–' => error.help("write `-`"),
        '[' | '{' => error.help("write `(`"),
        ']' | '}' => error.help("write `)`"),
        '%' => error.help("write `mod(a, b)`"),
        '@' => error.help("a Python function cannot be used here: write a number"),
        _ => error,
    }
}
