//! Numbers with their units, and strings with their escapes.

use arsc_diagnostics::{Applicability, Diagnostic, Span, codes};

use super::Builder;
use crate::ast::{ExprKind, Unit};
use crate::grammar::Pair;

/// Suffixes that are not units, and what was probably meant.
const NOT_UNITS: [(&[&str], &str); 6] = [
    (&["degree", "degrees", "d"], "deg"),
    (&["radian", "radians", "r"], "rad"),
    (&["nanometer", "nanometers", "nanometre", "nanometres"], "nm"),
    (&["k", "kelvin", "kelvins"], "K"),
    (&["m", "metre", "metres", "meter", "meters", "units", "f", "f32", "f64"], ""),
    (&["Deg", "DEG"], "deg"),
];

impl<'t> Builder<'t> {
    pub(super) fn number(&mut self, pair: &Pair<'t>) -> ExprKind {
        let text = pair.as_str();
        let span = self.span(pair);
        let length = numeric_length(text);
        let (digits, suffix) = text.split_at(length);
        let digits: String = digits.chars().filter(|&c| c != '_').collect();
        // `1_deg` is `1deg` with a separator too many: units start with a letter.
        let unit = match suffix {
            "" => None,
            "deg" => Some(Unit::Deg),
            "rad" => Some(Unit::Rad),
            "nm" => Some(Unit::Nm),
            "K" => Some(Unit::Kelvin),
            _ => {
                return self
                    .unknown_unit(suffix, Span::new(span.source, span.start as usize + length, span.end as usize));
            }
        };
        let is_int = !digits.contains(['.', 'e', 'E']);
        if unit.is_none() && is_int {
            return match digits.parse() {
                Ok(value) => ExprKind::Int(value),
                Err(_) => {
                    let help = "write it as a float: `1e30`, or `12345678901234567890.0`";
                    self.bad_literal("this integer does not fit into 64 bits", span, "too large", help)
                }
            };
        }
        match (digits.parse::<f64>(), unit) {
            (Ok(value), Some(unit)) if value.is_finite() => ExprKind::Quantity { value, unit },
            (Ok(value), None) if value.is_finite() => ExprKind::Float(value),
            _ => {
                self.bad_literal("this number is too large", span, "not finite", "the largest number is about 1.8e308")
            }
        }
    }

    fn bad_literal(&mut self, message: &str, span: Span, label: &str, help: &str) -> ExprKind {
        self.report(Diagnostic::new(codes::syntax::LITERAL, message).label(span, label).help(help));
        ExprKind::Error
    }

    fn unknown_unit(&mut self, suffix: &str, span: Span) -> ExprKind {
        let shown: String = suffix.chars().take(30).collect();
        let mut diagnostic = Diagnostic::new(codes::syntax::LITERAL, format!("unknown unit `{shown}`"))
            .label(span, "not a unit")
            .help("units are `deg`, `rad`, `nm` and `K`; lengths have none");
        if let Some((_, meant)) = NOT_UNITS.iter().find(|(names, _)| names.contains(&suffix)) {
            diagnostic = diagnostic.suggest(span, *meant, Applicability::MaybeIncorrect);
        }
        self.report(diagnostic);
        ExprKind::Error
    }

    /// The value of a string token, its quotes included in the pair.
    pub(super) fn string(&mut self, pair: &Pair<'t>) -> String {
        let token = pair.as_str();
        let body = &token[1..token.len() - 1];
        let base = self.span(pair).start as usize + 1;
        let mut value = String::with_capacity(body.len());
        let mut at = 0;
        while let Some(offset) = body[at..].find('\\') {
            value.push_str(&body[at..at + offset]);
            at += offset;
            let (character, length) = escape(&body[at..]);
            match character {
                Some(character) => value.push(character),
                None => self.bad_escape(&body[at..at + length], base + at),
            }
            at += length;
        }
        value.push_str(&body[at..]);
        value
    }

    fn bad_escape(&mut self, escape: &str, start: usize) {
        let span = Span::new(self.source, start, start + escape.len());
        self.report(
            Diagnostic::new(codes::syntax::LITERAL, "unknown escape in a string")
                .label(span, "not an escape")
                .help(r#"escapes are `\n`, `\t`, `\"`, `\\` and `\u{1F600}`"#),
        );
    }
}

/// The length of the number without its suffix. An exponent counts only with digits: the `e` of `2em` is a suffix.
fn numeric_length(text: &str) -> usize {
    let bytes = text.as_bytes();
    let run = |from: usize| bytes[from..].iter().take_while(|b| b.is_ascii_digit() || **b == b'_').count();
    let mut end = run(0);
    if bytes.get(end) == Some(&b'.') {
        end += 1 + run(end + 1);
    }
    if matches!(bytes.get(end), Some(b'e' | b'E')) {
        let sign = usize::from(matches!(bytes.get(end + 1), Some(b'+' | b'-')));
        if bytes.get(end + 1 + sign).is_some_and(u8::is_ascii_digit) {
            end += 1 + sign + run(end + 1 + sign);
        }
    }
    end
}

/// The character that an escape at the start of `text` stands for, and the escape's length in bytes.
fn escape(text: &str) -> (Option<char>, usize) {
    let Some(kind) = text.chars().nth(1) else { return (None, text.len()) };
    let simple = match kind {
        'n' => Some('\n'),
        't' => Some('\t'),
        '"' => Some('"'),
        '\\' => Some('\\'),
        _ => None,
    };
    if kind == 'u' && text[2..].starts_with('{') {
        let Some(close) = text.find('}').filter(|&close| close <= 10) else { return (None, 2) };
        let character = u32::from_str_radix(&text[3..close], 16).ok().and_then(char::from_u32);
        return (character, close + 1);
    }
    (simple, 1 + kind.len_utf8())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn suffixes_are_told_from_exponents() {
        for (text, length) in [("1e5", 3), ("1e5deg", 3), ("2em", 1), ("1.5e-3K", 6), ("1_000nm", 5), ("3e", 1)] {
            assert_eq!(numeric_length(text), length, "{text}");
        }
    }

    #[test]
    fn escapes_give_their_character_and_length() {
        assert_eq!(escape(r"\n rest"), (Some('\n'), 2));
        assert_eq!(escape(r"\u{1F600}x"), (Some('\u{1F600}'), 9));
        assert_eq!(escape(r"\u{D800}"), (None, 8));
        assert_eq!(escape(r"\ä"), (None, 3));
        assert_eq!(escape(r"\u{12345678901}"), (None, 2));
    }
}
