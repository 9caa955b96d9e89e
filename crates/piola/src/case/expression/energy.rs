//! Expressions of the invariants of a strain, for energies.

use piola_formulas::hyperelastic::{Instruction, Invariant};

use super::engine::Program;
use super::syntax::{self, Tree};
use super::{ExpressionError, Scope};

/// The instructions of an energy: an expression of the invariants `I1`, `I2`, `J`, `I1b` and `I2b` and of what else
/// `scope` knows, with `+ - * / ^`, `exp`, `ln`, `log` and `sqrt`. Other functions may have only parameters as
/// arguments.
///
/// # Errors
/// As [`Expression::parse`](super::Expression::parse), and functions of invariants that have no instruction.
pub fn energy(text: &str, scope: &Scope<'_>) -> Result<Vec<Instruction>, ExpressionError> {
    let tree = syntax::parse(text, &Scope { invariants: true, ..*scope })?;
    let mut instructions = Vec::new();
    lower(&tree, &mut instructions).map_err(|name| {
        let message = format!("`{name}` cannot be applied to an invariant");
        ExpressionError::new(0..text.len(), message, "not supported in an energy")
            .help("an energy may use + - * / ^, exp, ln, log and sqrt")
    })?;
    Ok(instructions)
}

/// Appends the instructions of a tree, or names the function that has none.
fn lower(tree: &Tree, out: &mut Vec<Instruction>) -> Result<(), &'static str> {
    if let Some(value) = constant(tree) {
        out.push(Instruction::Number(value));
        return Ok(());
    }
    match tree {
        Tree::Number(value) => out.push(Instruction::Number(*value)),
        Tree::Variable(name) => {
            let invariant = Invariant::ALL.into_iter().find(|(known, _)| known == name);
            out.push(Instruction::Of(invariant.ok_or(*name)?.1));
        }
        Tree::Negative(inner) => {
            lower(inner, out)?;
            out.push(Instruction::Negate);
        }
        Tree::Binary("^" | "pow", base, exponent) => match constant(exponent) {
            Some(exponent) => {
                lower(base, out)?;
                out.push(Instruction::Power(exponent));
            }
            // exp(b ln a)
            None => {
                lower(base, out)?;
                out.push(Instruction::Logarithm);
                lower(exponent, out)?;
                out.extend([Instruction::Multiply, Instruction::Exponential]);
            }
        },
        Tree::Binary(operator, left, right) => {
            let instruction = match *operator {
                "+" => Instruction::Add,
                "-" => Instruction::Subtract,
                "*" => Instruction::Multiply,
                "/" => Instruction::Divide,
                other => return Err(other),
            };
            lower(left, out)?;
            lower(right, out)?;
            out.push(instruction);
        }
        Tree::Call(name, argument) => {
            let instruction = match *name {
                "exp" => Instruction::Exponential,
                "ln" | "log" => Instruction::Logarithm,
                "sqrt" => Instruction::Root,
                other => return Err(other),
            };
            lower(argument, out)?;
            out.push(instruction);
        }
    }
    Ok(())
}

/// The value of a tree without invariants.
fn constant(tree: &Tree) -> Option<f64> {
    if has_variables(tree) {
        return None;
    }
    Program::new("", tree).ok()?.constant()
}

fn has_variables(tree: &Tree) -> bool {
    match tree {
        Tree::Number(_) => false,
        Tree::Variable(_) => true,
        Tree::Negative(inner) | Tree::Call(_, inner) => has_variables(inner),
        Tree::Binary(_, left, right) => has_variables(left) || has_variables(right),
    }
}
