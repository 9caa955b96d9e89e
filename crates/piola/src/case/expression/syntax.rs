//! From words to a tree: operator precedence with bounded depth.

use std::fmt::Write;
use std::ops::Range;

use super::token::{Token, TokenKind, tokens};
use super::{ExpressionError, MAX_NESTING, Scope, constants, functions};
use crate::case::suggest::nearest;

/// An expression whose names are known.
#[derive(Clone, Debug)]
pub(super) enum Tree {
    Number(f64),
    Variable(&'static str),
    Negative(Box<Tree>),
    Binary(&'static str, Box<Tree>, Box<Tree>),
    Call(&'static str, Box<Tree>),
}

impl Tree {
    /// The expression with brackets around everything, as the evaluator wants it.
    pub(super) fn bracketed(&self) -> String {
        let mut text = String::new();
        self.write(&mut text).expect("writing to a string does not fail");
        text
    }

    fn write(&self, out: &mut String) -> std::fmt::Result {
        match self {
            Self::Number(value) if value.is_sign_negative() => write!(out, "(-({:?}))", -value),
            Self::Number(value) => write!(out, "{value:?}"),
            Self::Variable(name) => out.write_str(name),
            Self::Negative(inner) => {
                out.write_str("(-(")?;
                inner.write(out)?;
                out.write_str("))")
            }
            Self::Binary(operator, left, right) => {
                out.write_str("((")?;
                left.write(out)?;
                write!(out, "){operator}(")?;
                right.write(out)?;
                out.write_str("))")
            }
            Self::Call(name, argument) => {
                write!(out, "({name}(")?;
                argument.write(out)?;
                out.write_str("))")
            }
        }
    }
}

/// Chains like `a + b + c` nest to the left in the tree, so that their length is bounded too.
const MAX_OPERATIONS: usize = 500;

/// Reads the expression `text`.
pub(super) fn parse(text: &str, scope: &Scope<'_>) -> Result<Tree, ExpressionError> {
    let tokens = tokens(text)?;
    if tokens.is_empty() {
        let message = "the expression is empty";
        return Err(ExpressionError::new(0..text.len(), message, "expected an expression"));
    }
    let operations = tokens.iter().filter(|t| matches!(t.kind, TokenKind::Operator(_))).count();
    if operations > MAX_OPERATIONS {
        let message = format!(
            "the expression has {operations} operators, at most {MAX_OPERATIONS} are allowed"
        );
        return Err(ExpressionError::new(0..text.len(), message, "too long"));
    }
    let mut parser = Parser { tokens: &tokens, next: 0, end: text.len(), depth: 0, scope };
    let tree = parser.sum()?;
    match parser.peek() {
        None => Ok(tree),
        Some(token) => Err(parser.no_operator(token)),
    }
}

struct Parser<'a> {
    tokens: &'a [Token<'a>],
    next: usize,
    end: usize,
    depth: usize,
    scope: &'a Scope<'a>,
}

impl<'a> Parser<'a> {
    fn peek(&self) -> Option<&'a Token<'a>> {
        self.tokens.get(self.next)
    }

    fn take(&mut self) -> Option<&'a Token<'a>> {
        let token = self.peek()?;
        self.next += 1;
        Some(token)
    }

    /// Takes the next word if it is one of `operators`, and names it.
    fn operator(&mut self, operators: &[&'static str]) -> Option<&'static str> {
        let TokenKind::Operator(found) = self.peek()?.kind else { return None };
        let operator = operators.iter().copied().find(|known| known.starts_with(found))?;
        self.next += 1;
        Some(operator)
    }

    fn sum(&mut self) -> Result<Tree, ExpressionError> {
        let mut left = self.product()?;
        while let Some(operator) = self.operator(&["+", "-"]) {
            left = Tree::Binary(operator, Box::new(left), Box::new(self.product()?));
        }
        Ok(left)
    }

    fn product(&mut self) -> Result<Tree, ExpressionError> {
        let mut left = self.signed()?;
        while let Some(operator) = self.operator(&["*", "/"]) {
            left = Tree::Binary(operator, Box::new(left), Box::new(self.signed()?));
        }
        Ok(left)
    }

    /// A sign binds weaker than a power: `-x^2` is `-(x^2)`.
    fn signed(&mut self) -> Result<Tree, ExpressionError> {
        match self.operator(&["+", "-"]) {
            None => self.power(),
            Some("-") => Ok(Tree::Negative(Box::new(self.nested(Self::signed)?))),
            Some(_) => self.nested(Self::signed),
        }
    }

    fn power(&mut self) -> Result<Tree, ExpressionError> {
        let base = self.operand()?;
        match self.operator(&["^"]) {
            None => Ok(base),
            Some(operator) => {
                let exponent = self.nested(Self::signed)?;
                Ok(Tree::Binary(operator, Box::new(base), Box::new(exponent)))
            }
        }
    }

    /// Goes one level deeper, down to a limit that keeps the stack small.
    fn nested(
        &mut self,
        part: fn(&mut Self) -> Result<Tree, ExpressionError>,
    ) -> Result<Tree, ExpressionError> {
        if self.depth == MAX_NESTING {
            let start = self.peek().map_or(self.end, |token| token.span.start);
            let message = format!("the expression is nested deeper than {MAX_NESTING} levels");
            return Err(ExpressionError::new(start..start + 1, message, "too deep"));
        }
        self.depth += 1;
        let result = part(self);
        self.depth -= 1;
        result
    }

    fn operand(&mut self) -> Result<Tree, ExpressionError> {
        let Some(token) = self.take() else { return Err(self.no_operand()) };
        match token.kind {
            TokenKind::Number(value) => Ok(Tree::Number(value)),
            TokenKind::Open => {
                let inner = self.nested(Self::sum)?;
                self.close(token)?;
                Ok(inner)
            }
            TokenKind::Name(name) => match self.peek().map(|next| next.kind) {
                Some(TokenKind::Open) => self.call(name, &token.span),
                _ => self.name(name, &token.span),
            },
            TokenKind::Operator(_) | TokenKind::Close | TokenKind::Comma => {
                self.next -= 1;
                Err(self.no_operand())
            }
        }
    }

    /// Takes the bracket that closes `open`.
    fn close(&mut self, open: &Token<'_>) -> Result<(), ExpressionError> {
        match self.peek() {
            Some(token) if token.kind == TokenKind::Close => {
                self.next += 1;
                Ok(())
            }
            None => {
                let message = "this bracket is never closed";
                Err(ExpressionError::new(open.span.clone(), message, "not closed")
                    .help("add a `)`"))
            }
            Some(token) => Err(self.no_operator(token)),
        }
    }

    fn call(&mut self, name: &str, span: &Range<usize>) -> Result<Tree, ExpressionError> {
        let known = functions().iter().find(|function| function.name == name);
        let Some(function) = known else { return Err(self.no_function(name, span)) };
        let Some(open) = self.take() else { return Err(self.no_operand()) };
        let mut arguments = vec![self.nested(Self::sum)?];
        while self.peek().is_some_and(|token| token.kind == TokenKind::Comma) {
            self.next += 1;
            arguments.push(self.nested(Self::sum)?);
        }
        self.close(open)?;
        let count = arguments.len();
        let mut arguments = arguments.into_iter();
        match (function.arguments, count, arguments.next(), arguments.next()) {
            (1, 1, Some(argument), None) => Ok(Tree::Call(function.name, Box::new(argument))),
            (2, 2, Some(left), Some(right)) => {
                Ok(Tree::Binary(function.name, Box::new(left), Box::new(right)))
            }
            (needed, ..) => {
                let message = format!("`{name}` takes {needed} argument(s), got {count}");
                let label = format!("takes {needed}");
                let end = self.tokens[self.next - 1].span.end;
                Err(ExpressionError::new(span.start..end, message, label))
            }
        }
    }

    fn name(&self, name: &str, span: &Range<usize>) -> Result<Tree, ExpressionError> {
        if self.scope.variable(name).is_some() {
            let known = ["x", "y", "z", "t"].into_iter().find(|variable| *variable == name);
            return known.map(Tree::Variable).ok_or_else(|| self.no_name(name, span));
        }
        if let Some(name) = self.scope.invariant(name) {
            if self.scope.parameter(name).is_some() {
                let message =
                    format!("`{name}` is an invariant of the strain and also a parameter");
                let error = ExpressionError::new(span.clone(), message, "which of the two?");
                return Err(error.help("give the parameter another name"));
            }
            return Ok(Tree::Variable(name));
        }
        match self.scope.parameter(name) {
            None => {}
            Some(Some(value)) => return Ok(Tree::Number(value)),
            Some(None) => {
                let message = format!("the parameter `{name}` has no value");
                let error = ExpressionError::new(span.clone(), message, "no value");
                return Err(ExpressionError { is_consequence: true, ..error });
            }
        }
        let constant = constants().iter().find(|(known, _)| *known == name);
        constant.map(|(_, value)| Tree::Number(*value)).ok_or_else(|| self.no_name(name, span))
    }

    fn no_name(&self, name: &str, span: &Range<usize>) -> ExpressionError {
        let label = "not known here";
        let error = |message| ExpressionError::new(span.clone(), message, label);
        let axes = self.scope.axes;
        match name {
            "x" | "y" | "z" | "t" if axes == 0 && self.scope.invariants => error(format!(
                "`{name}` cannot be used here: an energy depends on the strain alone"
            ))
            .help("I1, I2, J, I1b and I2b are known here"),
            "x" | "y" | "z" | "t" if axes == 0 => {
                error(format!("`{name}` cannot be used here: the value must be one number"))
                    .help("only parameters, numbers and functions are known here")
            }
            "y" | "z" => error(format!("there is no `{name}` in {axes}D")),
            "t" => error("`t` cannot be used here: the value does not change with time".to_owned()),
            "e" => error("`e` is not known".to_owned()).help("write `exp(1)`"),
            _ if functions().iter().any(|function| function.name == name) => {
                let message = format!("the function `{name}` needs its argument in brackets");
                error(message).help(format!("write `{name}(...)`"))
            }
            _ => self.suggest(error(format!("`{name}` is not known")), name),
        }
    }

    fn no_function(&self, name: &str, span: &Range<usize>) -> ExpressionError {
        let is_number = self.scope.variable(name).is_some() || self.scope.parameter(name).is_some();
        let error = ExpressionError::new(
            span.clone(),
            format!("there is no function `{name}`"),
            "not a function",
        );
        if is_number {
            return error.help(format!("write `{name} * (...)` for a product"));
        }
        let names = functions().iter().map(|function| function.name);
        match nearest(name, names.clone()) {
            Some(near) => error.help(format!("did you mean `{near}`?")),
            None => error.help(format!("there are {}", names.collect::<Vec<_>>().join(", "))),
        }
    }

    fn suggest(&self, error: ExpressionError, name: &str) -> ExpressionError {
        match nearest(name, self.scope.names()) {
            Some(near) => error.help(format!("did you mean `{near}`?")),
            None => error.help("define numbers with a name in [parameters]"),
        }
    }

    /// Where a number should be, there is something else.
    fn no_operand(&self) -> ExpressionError {
        let after = self.next.checked_sub(1).and_then(|last| self.tokens.get(last));
        match self.peek() {
            Some(token) => {
                let message = "expected a number, a name or a bracket here";
                ExpressionError::new(token.span.clone(), message, "not expected here")
            }
            None => {
                let message = "the expression ends where a number, a name or a bracket should be";
                let span = after.map_or(0..self.end, |token| token.span.clone());
                ExpressionError::new(span, message, "something is missing after this")
            }
        }
    }

    /// Where an operator should be, there is something else.
    fn no_operator(&self, token: &Token<'_>) -> ExpressionError {
        let span = token.span.clone();
        match token.kind {
            TokenKind::Close => {
                ExpressionError::new(span, "no bracket is open here", "closes nothing")
                    .help("remove this `)`")
            }
            TokenKind::Comma => {
                ExpressionError::new(span, "a comma only separates arguments of a function", "")
                    .help("write a point in numbers: `0.5`")
            }
            _ => ExpressionError::new(span, "an operator is missing here", "missing operator")
                .help("write `*` for a product; numbers have no units, all are in SI units"),
        }
    }
}
