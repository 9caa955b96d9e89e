use super::*;
use proptest::prelude::*;

const PARAMETERS: &[(&str, f64)] = &[("speed", -2.5), ("length", 0.5)];

fn with<T>(use_scope: impl FnOnce(&Scope<'_>) -> T) -> T {
    let parameters: Vec<_> =
        PARAMETERS.iter().map(|(name, v)| ((*name).to_owned(), Some(*v))).collect();
    use_scope(&Scope { axes: 3, time: true, ..Scope::of_parameters(&parameters) })
}

fn parse(text: &str) -> Result<Expression, ExpressionError> {
    with(|scope| Expression::parse(text, scope))
}

fn value(text: &str) -> f64 {
    parse(text).unwrap().eval([0.3, -0.7, 1.9], 0.25)
}

#[test]
fn follows_the_usual_precedence() {
    let (x, y, z, t): (f64, f64, f64, f64) = (0.3, -0.7, 1.9, 0.25);
    for (text, expected) in [
        ("1 + 2 * 3", 7.0),
        ("1 - 2 - 3", -4.0),
        ("8 / 4 / 2", 1.0),
        ("8 / 4 * 2", 4.0),
        ("-2^2", -4.0),
        ("2^3^2", 512.0),
        ("2^-1", 0.5),
        ("--2", 2.0),
        ("2 * -3", -6.0),
        ("-1e3 * t", -250.0),
        ("1.5E-2", 0.015),
        (".5 + 2.", 2.5),
        ("-x^2", -x * x),
        ("min(1, max(2, 3))", 1.0),
        ("1 + min(min(1, 2), min(0, 4)) * 2", 1.0),
        ("speed * length", -1.25),
        ("-speed", 2.5),
        ("speed^2", 6.25),
        ("sin(pi / 6)", 0.5),
        ("x * y + z / t", x * y + z / t),
        ("atan2(y, x)", y.atan2(x)),
        ("mod(-1, 3)", 2.0),
        ("pow(2, 10)", 1024.0),
        ("step(t - 0.25)", 1.0),
        ("step(t - 0.26)", 0.0),
        ("sign(0) + sign(-3)", -1.0),
        ("ln(exp(2)) + log(exp(1))", 3.0),
    ] {
        let got = value(text);
        assert!((got - expected).abs() <= 1e-15 * expected.abs().max(1.0), "{text} = {got}");
    }
}

#[test]
fn squares_are_rounded_like_products() {
    // The power function of the system differs from the product in about one of a thousand.
    let (square, of_square) = (parse("x^2").unwrap(), parse("pow(x, 1 + 1)").unwrap());
    for number in 1..20_000 {
        let x = f64::from(number) * 1.37e-3;
        assert_eq!(square.eval([x, 0.0, 0.0], 0.0), x * x, "at {x}");
        assert_eq!(of_square.eval([x, 0.0, 0.0], 0.0), x * x, "at {x}");
    }
}

#[test]
fn knows_what_it_depends_on() {
    let moving = parse("x * t").unwrap();
    assert!(moving.depends_on(Variable::X) && moving.depends_on(Variable::T));
    assert!(!moving.depends_on(Variable::Y) && moving.depends_on_position());
    assert_eq!(moving.as_constant(), None);
    assert_eq!(parse("2 * speed").unwrap().as_constant(), Some(-5.0));
    assert!(!parse("t").unwrap().depends_on_position());
}

#[test]
fn can_be_shared_between_threads() {
    fn shared<T: Send + Sync + Clone>() {}
    shared::<Expression>();
}

#[test]
fn every_function_has_the_rate_of_a_difference_quotient() {
    let step = 1e-5;
    let mut texts: Vec<String> = functions()
        .iter()
        .map(|f| match f.arguments {
            1 => format!("{}(0.2 + 0.5 * t + x * t^2)", f.name),
            _ => format!("{}(0.2 + t, 1.3 - t * x)", f.name),
        })
        .collect();
    texts.extend(["t^3", "2^t", "x^2 * t / (1 + t)", "-t", "sqrt(0) + t"].map(String::from));
    for text in texts {
        let expression = parse(&text).unwrap();
        let at = |t: f64| expression.eval([0.3, 0.0, 0.0], t);
        let quotient = (at(0.25 + step) - at(0.25 - step)) / (2.0 * step);
        let rate = expression.rate([0.3, 0.0, 0.0], 0.25);
        // The quotient's own error is step^2 times a third derivative of order one, and round-off.
        assert!((rate - quotient).abs() < 1e-8, "{text}: {rate} against {quotient}");
    }
}

#[test]
fn says_what_is_wrong_and_where() {
    for (text, span, message) in [
        ("", 0..0, "the expression is empty"),
        ("  ", 0..2, "the expression is empty"),
        ("2 * spede", 4..9, "`spede` is not known"),
        ("sn(x)", 0..2, "there is no function `sn`"),
        ("x(2)", 0..1, "there is no function `x`"),
        ("2 x", 2..3, "an operator is missing here"),
        ("2 +", 2..3, "the expression ends where a number, a name or a bracket should be"),
        ("2 + * 3", 4..5, "expected a number, a name or a bracket here"),
        ("(1 + 2", 0..1, "this bracket is never closed"),
        ("1 + 2)", 5..6, "no bracket is open here"),
        ("1,5", 1..2, "a comma only separates arguments of a function"),
        ("sin x", 0..3, "the function `sin` needs its argument in brackets"),
        ("sin(x, y)", 0..9, "`sin` takes 1 argument(s), got 2"),
        ("min(x)", 0..6, "`min` takes 2 argument(s), got 1"),
        ("sin()", 4..5, "expected a number, a name or a bracket here"),
        ("t > 1", 2..3, "`>` has no meaning in an expression"),
        ("2 ** 3", 2..4, "`**` is not an operator"),
        ("1e999", 0..5, "`1e999` is larger than any number that can be computed with"),
        (".", 0..1, "`.` is not a number"),
        ("1 / 0", 0..5, "the value of `1 / 0` is inf, which is not a finite number"),
        ("2 * é", 4..6, "`é` is not known"),
    ] {
        let error = parse(text).expect_err(text);
        assert_eq!((error.span, error.message.as_str()), (span, message), "for `{text}`");
    }
    assert_eq!(parse("2 * spede").unwrap_err().help.unwrap(), "did you mean `speed`?");
    assert_eq!(parse("sqr(2)").unwrap_err().help.unwrap(), "did you mean `sqrt`?");
}

#[test]
fn knows_only_the_variables_of_its_scope() {
    let flat = Scope { axes: 2, ..Scope::of_parameters(&[]) };
    assert!(Expression::parse("x + y", &flat).is_ok());
    let error = Expression::parse("z", &flat).unwrap_err();
    assert_eq!(error.message, "there is no `z` in 2D");
    assert!(Expression::parse("t", &flat).unwrap_err().message.contains("with time"));
    let none = Scope { axes: 0, ..flat };
    assert!(Expression::parse("x", &none).unwrap_err().message.contains("one number"));
}

#[test]
fn pathological_texts_are_refused_and_never_overflow_the_stack() {
    let deep = 100_000;
    for text in [
        "(".repeat(deep),
        format!("{}1{}", "(".repeat(deep), ")".repeat(deep)),
        format!("{}1", "-".repeat(deep)),
        "1+".repeat(deep),
        "2^".repeat(2000),
        format!("{}1", "-".repeat(400)),
        format!("{}1{}", "(".repeat(1500), ")".repeat(1500)),
        format!("{}1{}", "sin(".repeat(800), ")".repeat(800)),
    ] {
        assert!(parse(&text).is_err());
    }
    let longest = vec!["x"; 501].join("+");
    assert_eq!(parse(&longest).unwrap().eval([1.0; 3], 0.0), 501.0);
    let nested = format!("{}x{}", "(1+".repeat(64), ")".repeat(64));
    assert_eq!(parse(&nested).unwrap().eval([1.0; 3], 0.0), 65.0);
}

/// A random expression as text with its value, computed alongside and not by the parser.
fn pairs() -> impl Strategy<Value = (String, f64)> {
    let leaf = prop_oneof![
        (0.0..10.0f64).prop_map(|v| (format!("{v}"), v)),
        Just(("x".to_owned(), 0.3)),
        Just(("speed".to_owned(), -2.5)),
        (1e-9..1e-3f64).prop_map(|v| (format!("{v:e}"), v)),
    ];
    leaf.prop_recursive(6, 40, 2, |inner| {
        (inner.clone(), inner, 0..8usize).prop_map(|((a, va), (b, vb), form)| match form {
            0 => (format!("({a} + {b})"), va + vb),
            1 => (format!("({a}-{b})"), va - vb),
            2 => (format!("({a})*({b})"), va * vb),
            3 => (format!("(({a}) / ({b}))"), va / vb),
            4 => (format!("max({a}, {b})"), if va >= vb || vb.is_nan() { va } else { vb }),
            5 => (format!("(-({a}))"), -va),
            6 => (format!("cos({a})"), va.cos()),
            _ => (format!("({a})^2"), va * va),
        })
    })
}

proptest! {
    #[test]
    fn agrees_with_rust((text, expected) in pairs()) {
        match parse(&format!("0 * t + {text}")) {
            Ok(expression) => {
                let got = expression.eval([0.3, 0.0, 0.0], 0.0);
                prop_assert!(got == expected || (got.is_nan() && !expected.is_finite()) || got == expected + 0.0,
                    "{text}: {got} {expected}");
            }
            Err(error) => prop_assert!(!expected.is_finite(), "{text}: {error}"),
        }
    }

    #[test]
    fn never_panics(text in "\\PC{0,40}") {
        let _ = parse(&text);
    }

    #[test]
    fn never_panics_on_likely_characters(text in "[-+*/^(),.0-9a-z eE]{0,40}") {
        if let Ok(expression) = parse(&text) {
            let _ = expression.eval([0.1, 0.2, 0.3], 0.4);
            let _ = expression.rate([0.1, 0.2, 0.3], 0.4);
        }
    }
}

/// Functions of time alone are kept: more of them than there is room for, at times that come and go, on several threads.
#[test]
fn functions_of_time_have_their_own_values() {
    let all: Vec<Expression> =
        (0..40).map(|k| parse(&format!("{k} + sin({k} * t) + t^2")).unwrap()).collect();
    let expected = |k: usize, t: f64| k as f64 + (k as f64 * t).sin() + t * t;
    let rate = |k: usize, t: f64| k as f64 * (k as f64 * t).cos() + 2.0 * t;
    std::thread::scope(|scope| {
        for first in 0..3 {
            let all = &all;
            scope.spawn(move || {
                for t in [0.3, 0.7, 0.3, -0.0, 0.0, 0.7] {
                    for k in (0..all.len()).chain([first, first]) {
                        let near = |one: f64, other: f64| {
                            (one - other).abs() < 1e-12 * (1.0 + other.abs())
                        };
                        assert!(near(all[k].eval([1.0; 3], t), expected(k, t)), "{k} at {t}");
                        assert!(near(all[k].rate([2.0; 3], t), rate(k, t)), "{k} at {t}");
                        assert_eq!(all[k].derivative(Variable::X, [2.0; 3], t), 0.0);
                    }
                }
            });
        }
    });
}
