//! Why a statement or item does not follow the grammar, in words for its author.
//!
//! The grammar is run once more on the statement alone; how far it came and what it tried there gives the place and
//! the general message. Slips that people bring from other languages are recognised by the words around the place.

use std::collections::BTreeSet;

use arsc_diagnostics::{Applicability, Diagnostic, SourceId, Span, closest, codes};
use pest::Parser;
use pest::error::{ErrorVariant, InputLocation};

use crate::grammar::{Grammar, Rule};

const KEYWORDS: [&str; 16] = [
    "actions", "as", "camera", "else", "false", "fn", "for", "if", "import", "in", "let", "match", "param", "scene",
    "true", "type",
];

/// Makes the diagnostic for what `rule` could not read in `text[start..end]`.
pub(crate) fn diagnose(source: SourceId, text: &str, rule: Rule, start: usize, end: usize) -> Diagnostic {
    let slice = &text[start..end];
    let failure = Failure::find(rule, slice);
    let token = token(&slice[failure.at..]);
    let span = |from: usize, to: usize| Span::new(source, start + from, start + to);
    // What is missing is missed behind the last token, not where the next line begins.
    let place = match token {
        "" => span(slice[..failure.at].trim_end().len(), slice[..failure.at].trim_end().len()),
        token => span(failure.at, failure.at + token.len()),
    };
    let context = Context { slice, at: failure.at, token, top_level: rule == Rule::strict_item };
    if let Some(slip) = context.slip() {
        let mut diagnostic =
            Diagnostic::new(codes::syntax::SYNTAX, slip.message).label(place, slip.label).help(slip.help);
        if let Some((from, to, replacement)) = slip.replace {
            diagnostic = diagnostic.suggest(span(from, to), replacement, Applicability::MaybeIncorrect);
        }
        return diagnostic;
    }
    let expected = context.expected(&failure.tried);
    let found = context.found();
    let message = match expected.as_str() {
        "" => format!("{found} is not expected here"),
        expected => format!("expected {expected}, found {found}"),
    };
    let diagnostic = Diagnostic::new(codes::syntax::SYNTAX, message)
        .label(place, if token.is_empty() { "something is missing here" } else { "not expected here" });
    match context.help() {
        Some(help) => diagnostic.help(help),
        None => diagnostic,
    }
}

/// Help for two statements on one line: the text of the first, and what follows it.
pub(crate) fn adjacent_help(before: &str, after: &str) -> Option<String> {
    let first = leading_word(before);
    if let Some(help) = foreign_word(first) {
        return Some(help.to_string());
    }
    match leading_word(after) {
        "and" => return Some("write `&&`".to_string()),
        "or" => return Some("write `||`".to_string()),
        _ => {}
    }
    if let Some(help) = parted_unit(before, after) {
        return Some(help);
    }
    if after.starts_with("{ <") {
        return Some(format!("a shape is a call: `{}(…)`, and vectors are written `(x, y, z)`", last_word(before)));
    }
    if after.starts_with('{') && before.ends_with(')') {
        return Some(match first {
            "union" | "difference" | "intersection" => {
                format!("operands are arguments: `{first}(a, b)`, or operators: `a | b`, `a & b`, `a - b`")
            }
            "translate" | "rotate" | "scale" | "mirror" | "color" | "multmatrix" => {
                format!("write `shape |> {first}(…)`")
            }
            _ => "a call takes no block: its arguments stand in the parentheses".to_string(),
        });
    }
    let transforms = ["translate", "rotate", "rotate_x", "rotate_y", "rotate_z", "scale", "mirror", "with"];
    (transforms.contains(&first) && before.ends_with(')')).then(|| format!("write `shape |> {first}(…)`"))
}

/// `45 deg`: what to write, if a number and its unit stand apart.
pub(crate) fn parted_unit(before: &str, after: &str) -> Option<String> {
    let unit = leading_word(after);
    let number = &before[before.trim_end_matches(|c: char| c.is_ascii_digit() || c == '.').len()..];
    let is_parted = ["deg", "rad", "nm", "K"].contains(&unit) && number.starts_with(|c: char| c.is_ascii_digit());
    is_parted.then(|| format!("a unit stands right behind its number: `{number}{unit}`"))
}

/// How far the grammar came, and the rules that it tried there.
struct Failure {
    at: usize,
    tried: BTreeSet<Rule>,
}

impl Failure {
    fn find(rule: Rule, slice: &str) -> Failure {
        let Err(error) = Grammar::parse(rule, slice) else {
            return Failure { at: slice.len(), tried: BTreeSet::new() };
        };
        let at = match error.location {
            InputLocation::Pos(at) | InputLocation::Span((at, _)) => at.min(slice.len()),
        };
        let tried = match error.variant {
            ErrorVariant::ParsingError { positives, .. } => positives.into_iter().collect(),
            ErrorVariant::CustomError { .. } => BTreeSet::new(),
        };
        Failure { at, tried }
    }
}

/// A recognised slip: what to say, and what to replace (relative to the statement).
struct Slip {
    message: &'static str,
    label: &'static str,
    help: String,
    replace: Option<(usize, usize, String)>,
}

impl Slip {
    fn new(message: &'static str, label: &'static str, help: impl Into<String>) -> Option<Slip> {
        Some(Slip { message, label, help: help.into(), replace: None })
    }

    fn replacing(
        message: &'static str,
        label: &'static str,
        help: &str,
        replace: (usize, usize, &str),
    ) -> Option<Slip> {
        let (from, to, text) = replace;
        Some(Slip { message, label, help: help.to_string(), replace: Some((from, to, text.to_string())) })
    }
}

struct Context<'t> {
    slice: &'t str,
    at: usize,
    token: &'t str,
    top_level: bool,
}

impl Context<'_> {
    fn before(&self) -> &str {
        self.slice[..self.at].trim_end()
    }

    fn slip(&self) -> Option<Slip> {
        self.assignment().or_else(|| self.foreign_operator()).or_else(|| self.number()).or_else(|| self.top_level())
    }

    /// `x = 5`, `x += 1`, `if a = b`, `for (i = …)`.
    fn assignment(&self) -> Option<Slip> {
        if self.token != "=" {
            return None;
        }
        let before = self.before();
        if leading_word(self.slice) == "for" {
            return Slip::new(
                "a loop takes its values from a range or a list",
                "not part of a loop",
                "write `for i in 0..n { … }`",
            );
        }
        if before.ends_with(['+', '-', '*', '/', '%', '|', '&']) {
            return Slip::new("values do not change", "assignment", "give the new value a new name with `let`");
        }
        if before == leading_word(self.slice) {
            let message = "a name is bound with `let`";
            return Slip::replacing(message, "assignment", "write `let name = value`", (0, 0, "let "));
        }
        let (message, help) = ("`=` binds names; it does not compare", "equality is `==`");
        Slip::replacing(message, "not a comparison", help, (self.at, self.at + 1, "=="))
    }

    /// Characters and words with a meaning in other languages.
    fn foreign_operator(&self) -> Option<Slip> {
        let replace = |message, help, text| {
            Slip::replacing(message, "not an operator here", help, (self.at, self.at + self.token.len(), text))
        };
        match self.token {
            "?" => Slip::new("there is no `? :` operator", "not an operator", "write `if condition { a } else { b }`"),
            "#" if leading_word(&self.slice[self.at + 1..]) == "include" => Slip::new(
                "there are no directives",
                "not a comment",
                "modules are loaded with `import \"file.arsl\" { name }`; comments start with `//`",
            ),
            "#" if ["declare", "local", "define"].contains(&leading_word(&self.slice[self.at + 1..])) => Slip::new(
                "there are no directives",
                "not a comment",
                "names are bound with `let name = value`; comments start with `//`",
            ),
            "<" => Slip::new("`<` only compares", "nothing to compare before it", "vectors are written `(x, y, z)`"),
            "#" => replace("comments start with `//`", "write `// comment`", "//"),
            "^" => replace("powers are written `**`", "write `a ** b`", "**"),
            "~" | "\\" | "`" => Slip::new("this character has no meaning here", "unknown", "remove it"),
            "'" => Slip::new("strings stand in double quotes", "not a quote", "write `\"text\"`"),
            "$" => Slip::new("names do not start with `$`", "unknown", "curved shapes are exact: they need no `$fn`"),
            "_" => Slip::new("`_` has no value", "only a pattern", "give the value a name"),
            "and" => replace("logical and is written `&&`", "write `a && b`", "&&"),
            "or" => replace("logical or is written `||`", "write `a || b`", "||"),
            "!" => Slip::new("`!` stands before its operand", "not a postfix operator", "unequal is `!=`"),
            _ => None,
        }
    }

    /// `1.` and `.5`: the grammar stops at the point, or behind it where it looks for a field's name.
    fn number(&self) -> Option<Slip> {
        let point = match self.slice[..self.at].strip_suffix('.') {
            Some(before) => before.len(),
            None if self.token == "." => self.at,
            None => return None,
        };
        let is_digit = |c: Option<char>| c.is_some_and(|c| c.is_ascii_digit());
        if is_digit(self.slice[..point].chars().next_back()) {
            let replace = (point + 1, point + 1, "0");
            let number = &self.slice[self.slice[..point].trim_end_matches(|c: char| c.is_ascii_digit()).len()..point];
            let help = format!("write `{number}.0`");
            return Slip::replacing("a number ends with a digit", "no digit after the point", &help, replace);
        }
        if is_digit(self.slice[point + 1..].chars().next()) {
            let replace = (point, point, "0");
            return Slip::replacing(
                "a number starts with a digit",
                "no digit before the point",
                "write `0.5`",
                replace,
            );
        }
        None
    }

    /// What stands at the top level and is no item.
    fn top_level(&self) -> Option<Slip> {
        let word = leading_word(self.slice);
        // Spaces that the grammar does not know, a no-break space say, may stand before the word.
        let start = self.slice.len() - self.slice.trim_start().len();
        if !self.top_level || self.at > start {
            return None;
        }
        let message = "expected a declaration at the top level";
        if let Some(help) = foreign_word(word) {
            return Slip::new(message, "not a declaration", help);
        }
        let items = ["import", "param", "let", "fn", "type", "scene", "camera", "actions", "allow"];
        if let Some(item) = closest(word, items).filter(|item| *item != word) {
            return Slip::replacing(
                message,
                "misspelt?",
                &format!("items begin with a keyword such as `{item}`"),
                (start, start + word.len(), item),
            );
        }
        if self.slice[start + word.len()..].trim_start().starts_with('=') && !word.is_empty() {
            return Slip::replacing(
                "a name is bound with `let`",
                "assignment",
                "write `let name = value`",
                (start, start, "let "),
            );
        }
        Slip::new(message, "not a declaration", "shapes and lights go into `scene { … }`, values into `let name = …`")
    }

    fn found(&self) -> String {
        match self.token {
            "" => "the end of the statement".to_string(),
            "\"" => "a string".to_string(),
            token if KEYWORDS.contains(&token) => format!("the keyword `{token}`"),
            token => format!("`{}`", token.chars().take(30).collect::<String>()),
        }
    }

    /// What the rules that were tried mean to an author, in the order of usefulness.
    fn expected(&self, tried: &BTreeSet<Rule>) -> String {
        let mut words: Vec<&str> = Vec::new();
        let has = |rules: &[Rule]| rules.iter().any(|rule| tried.contains(rule));
        let mut say = |condition: bool, word: &'static str| {
            if condition && !words.contains(&word) {
                words.push(word);
            }
        };
        use Rule::*;
        say(has(&[expr, operand, prefix, arg]), "an expression");
        say(has(&[pattern, literal_pattern, tuple_pattern, wildcard]), "a pattern");
        say(has(&[type_expr, type_fn, type_tuple, type_record, type_name]), "a type");
        say(
            has(&[ident, import_name, record_field, fn_param, std_path]) && !has(&[expr, operand, pattern, type_expr]),
            "a name",
        );
        say(has(&[colon]), "`:`");
        say(has(&[equals]), "`=`");
        say(has(&[kw_in]), "`in`");
        say(has(&[fat_arrow]), "`=>`");
        say(has(&[fn_params]), "`(`");
        say(has(&[block, fn_body]) && !has(&[expr, operand]), "`{`");
        match self.innermost_bracket() {
            Some('(') if !has(&[expr, operand]) && words.is_empty() => return "`,` or `)`".to_string(),
            Some('[') if !has(&[expr, operand]) && words.is_empty() => return "`,` or `]`".to_string(),
            _ => {}
        }
        if words.is_empty() && has(&[infix, call, index, field]) {
            return "an operator or a new line".to_string();
        }
        words.truncate(3);
        match words.split_last() {
            Some((last, rest)) if !rest.is_empty() => format!("{} or {last}", rest.join(", ")),
            Some((only, _)) => (*only).to_string(),
            None => String::new(),
        }
    }

    fn help(&self) -> Option<String> {
        if KEYWORDS.contains(&self.token) {
            return Some(format!("`{}` is a keyword and cannot be a name", self.token));
        }
        foreign_word(leading_word(self.slice)).map(str::to_string)
    }

    /// The innermost bracket that is open at the place, strings and comments left out.
    fn innermost_bracket(&self) -> Option<char> {
        let mut open = Vec::new();
        let mut rest = &self.slice[..self.at];
        while let Some(first) = rest.chars().next() {
            let mut length = first.len_utf8();
            match first {
                '(' | '[' | '{' => open.push(first),
                ')' | ']' | '}' => drop(open.pop()),
                '"' => length = string_length(rest),
                '/' if rest.starts_with("//") => length = rest.find('\n').unwrap_or(rest.len()),
                '/' if rest.starts_with("/*") => length = rest.find("*/").map_or(rest.len(), |at| at + 2),
                _ => {}
            }
            rest = &rest[length..];
        }
        open.pop()
    }
}

fn string_length(text: &str) -> usize {
    let mut escaped = true; // The opening quote does not close.
    for (at, c) in text.char_indices() {
        match c {
            _ if escaped => escaped = false,
            '\\' => escaped = true,
            '"' => return at + 1,
            _ => {}
        }
    }
    text.len()
}

/// Words that declare something in other languages.
fn foreign_word(word: &str) -> Option<&'static str> {
    Some(match word {
        "module" | "function" | "def" | "func" => "functions are declared with `fn name(parameter: type) { … }`",
        "var" | "const" | "mut" | "auto" => "names are bound with `let name = value`",
        "include" | "use" | "require" | "from" => "modules are loaded with `import \"file.arsl\" { name }`",
        "return" => "the last expression of a block is its value: leave `return` out",
        "while" | "loop" => "loops run over ranges and lists: `for i in 0..n { … }`",
        "elif" | "elsif" | "elseif" => "write `else if`",
        "switch" | "case" => "write `match value { pattern => result, … }`",
        "not" => "logical not is written `!`",
        "struct" | "record" | "class" => "record types are declared with `type name = { field: type }`",
        _ => return None,
    })
}

fn last_word(text: &str) -> &str {
    &text[text.trim_end_matches(|c: char| c.is_ascii_alphanumeric() || c == '_').len()..]
}

fn leading_word(text: &str) -> &str {
    let text = text.trim_start();
    let end = text.find(|c: char| !(c.is_ascii_alphanumeric() || c == '_')).unwrap_or(text.len());
    &text[..end]
}

/// The token at the start of a text: a word, an operator of one character, `"` for a string; empty at the end.
fn token(text: &str) -> &str {
    let word = leading_word(text);
    match text.chars().next() {
        None => "",
        Some(c) if c.is_whitespace() => "",
        Some('/') if text.starts_with("//") => "",
        Some(_) if !word.is_empty() && text.starts_with(word) => word,
        Some(c) => &text[..c.len_utf8()],
    }
}
