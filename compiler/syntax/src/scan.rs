//! One linear look over the text before the grammar runs: comments, brackets, quotes and foreign characters.
//!
//! It reports what a grammar reports badly — an opening bracket that is never closed, a string or comment without
//! an end, typographic quotes — and it limits nesting, so that everything behind it may recurse. Where a block was
//! forgotten to be closed it leaves a *stop*, at which the syntax stage ends the item.

use arsc_diagnostics::{Applicability, Diagnostic, SourceId, Span, codes};

use crate::{MAX_FINDINGS, MAX_NESTING};

/// What the scan found.
pub(crate) struct Scan {
    /// Every comment, in order.
    pub comments: Vec<Span>,
    pub diagnostics: Vec<Diagnostic>,
    /// Offsets at which open blocks are taken to be closed, ascending; the last is the length of the text.
    pub stops: Vec<usize>,
    /// Opening brackets whose line looks complete but for the closing one. The grammar sees another character in
    /// their place, so that the damage ends with the line.
    pub masked: Vec<usize>,
    /// The text cannot be given to the grammar: nesting too deep, or no text at all.
    pub unreadable: bool,
}

/// Keywords that start an item and never stand inside of a block.
const ITEM_KEYWORDS: [&str; 5] = ["scene", "camera", "actions", "import", "param"];
/// Keywords that start an item or a statement, never something inside of parentheses.
const STATEMENT_KEYWORDS: [&str; 2] = ["let", "type"];
/// Keywords after which the grammar recurses without a bracket.
const RECURSIVE_KEYWORDS: [&str; 4] = ["fn", "if", "match", "for"];
/// Foreign characters are reported up to this number a file.
const MAX_FOREIGN: usize = 20;

struct Open {
    bracket: u8,
    at: usize,
    /// Keywords since the last separator that make the grammar recurse.
    pending: usize,
}

struct Scanner<'t> {
    source: SourceId,
    text: &'t str,
    bytes: &'t [u8],
    at: usize,
    open: Vec<Open>,
    /// Pending keywords outside of all brackets.
    pending: usize,
    /// Brackets and pending keywords in all.
    nesting: usize,
    /// `list<list<…`: how many in a row.
    angles: usize,
    foreign: usize,
    /// A comment goes on to the end of the text.
    endless_comment: bool,
    found: Scan,
}

/// Looks over the text once.
pub(crate) fn scan(source: SourceId, text: &str) -> Scan {
    let found = Scan {
        comments: Vec::new(),
        diagnostics: Vec::new(),
        stops: Vec::new(),
        masked: Vec::new(),
        unreadable: false,
    };
    let mut scanner = Scanner {
        source,
        text,
        bytes: text.as_bytes(),
        at: 0,
        open: Vec::new(),
        pending: 0,
        nesting: 0,
        angles: 0,
        foreign: 0,
        endless_comment: false,
        found,
    };
    scanner.run();
    scanner.found
}

impl Scanner<'_> {
    fn run(&mut self) {
        while self.at < self.bytes.len() && !self.found.unreadable {
            self.step();
        }
        if !self.found.unreadable {
            self.close_all(self.bytes.len());
            self.found.stops.push(self.bytes.len());
        }
    }

    fn step(&mut self) {
        let byte = self.bytes[self.at];
        match byte {
            b'/' if self.follows(b'/') => self.line_comment(),
            b'/' if self.follows(b'*') => self.block_comment(),
            b'"' => self.string(),
            b'(' | b'[' | b'{' => self.open(byte),
            b')' | b']' | b'}' => self.close(byte),
            b'a'..=b'z' | b'A'..=b'Z' | b'_' | b'0'..=b'9' => self.word(),
            b',' | b';' => {
                self.separate();
                self.at += 1;
            }
            b'<' => {
                self.angles += 1;
                self.at += 1;
                if self.angles > MAX_NESTING {
                    self.too_deep(self.at - 1, "`<` are nested too deeply");
                }
            }
            b' ' | b'\t' | b'\r' | b'\n' => self.at += 1,
            0..=0x1f | 0x7f => self.control_character(),
            0x80.. => self.foreign_character(),
            _ => {
                self.angles = 0;
                self.at += 1;
            }
        }
    }

    fn follows(&self, byte: u8) -> bool {
        self.bytes.get(self.at + 1) == Some(&byte)
    }

    fn span(&self, start: usize, end: usize) -> Span {
        Span::new(self.source, start, end)
    }

    fn line_comment(&mut self) {
        let start = self.at;
        let length = self.bytes[start..].iter().position(|&b| b == b'\n').unwrap_or(self.bytes.len() - start);
        let end = start + self.text[start..start + length].trim_end_matches('\r').len();
        self.found.comments.push(self.span(start, end));
        self.at = start + length;
    }

    fn block_comment(&mut self) {
        let start = self.at;
        let mut depth = 0;
        loop {
            match (self.bytes.get(self.at), self.bytes.get(self.at + 1)) {
                (None, _) => {
                    self.endless_comment = true;
                    self.report(
                        Diagnostic::new(codes::syntax::UNTERMINATED, "a comment is not closed")
                            .label(self.span(start, start + 2), "starts here")
                            .help("close it with `*/`; block comments nest"),
                    );
                    break;
                }
                (Some(b'/'), Some(b'*')) => {
                    depth += 1;
                    self.at += 2;
                    if depth > MAX_NESTING {
                        return self.too_deep(start, "comments are nested too deeply");
                    }
                }
                (Some(b'*'), Some(b'/')) => {
                    depth -= 1;
                    self.at += 2;
                    if depth == 0 {
                        break;
                    }
                }
                _ => self.at += 1,
            }
        }
        self.found.comments.push(self.span(start, self.at));
    }

    fn string(&mut self) {
        let start = self.at;
        self.at += 1;
        while let Some(&byte) = self.bytes.get(self.at) {
            match byte {
                b'"' => {
                    self.at += 1;
                    return;
                }
                b'\n' => break,
                b'\\' if self.bytes.get(self.at + 1).is_some_and(|&next| next != b'\n') => self.at += 2,
                _ => self.at += 1,
            }
        }
        self.at = self.at.min(self.bytes.len());
        self.report(
            Diagnostic::new(codes::syntax::UNTERMINATED, "a string is not closed")
                .label(self.span(start, start + 1), "starts here")
                .label(self.span(self.at, self.at), "and does not end on this line")
                .help("close it with `\"`; a line break inside of a string is written `\\n`"),
        );
        // The string has swallowed the closing brackets of this line.
        let line = self.text[..start].rfind('\n').map_or(0, |at| at + 1);
        while self.open.last().is_some_and(|open| open.bracket != b'{' && open.at >= line) {
            let swallowed = self.pop().map(|open| open.at);
            self.found.masked.extend(swallowed);
        }
    }

    fn word(&mut self) {
        let start = self.at;
        let is_word = |b: &u8| b.is_ascii_alphanumeric() || *b == b'_';
        self.at += self.bytes[start..].iter().position(|b| !is_word(b)).unwrap_or(self.bytes.len() - start);
        let word = &self.text[start..self.at];
        let at_line_start = start == 0 || self.bytes[start - 1] == b'\n';
        if at_line_start && !self.open.is_empty() && self.starts_item(word) {
            self.close_all(start);
            self.found.stops.push(start);
        }
        if RECURSIVE_KEYWORDS.contains(&word) {
            *self.open.last_mut().map_or(&mut self.pending, |open| &mut open.pending) += 1;
            self.nest(start);
        } else if STATEMENT_KEYWORDS.contains(&word) || ITEM_KEYWORDS.contains(&word) {
            self.separate();
        }
    }

    /// Whether a word in the first column shows that the open brackets have been forgotten.
    fn starts_item(&self, word: &str) -> bool {
        let next = self.text[self.at..].trim_start_matches([' ', '\t']).bytes().next();
        let declares = next.is_some_and(|b| b.is_ascii_alphabetic() || matches!(b, b'_' | b'{' | b'"' | b'('));
        let in_parentheses = self.open.last().is_some_and(|open| open.bracket != b'{');
        // `fn name` declares, `fn (` is a lambda.
        let declares_fn = word == "fn" && next.is_some_and(|b| b.is_ascii_alphabetic());
        let is_statement = STATEMENT_KEYWORDS.contains(&word) || declares_fn;
        declares && (ITEM_KEYWORDS.contains(&word) || in_parentheses && is_statement)
    }

    fn report(&mut self, diagnostic: Diagnostic) {
        if self.found.diagnostics.len() < MAX_FINDINGS {
            self.found.diagnostics.push(diagnostic);
        }
    }

    fn nest(&mut self, at: usize) {
        self.nesting += 1;
        if self.nesting > MAX_NESTING {
            self.too_deep(at, "this is nested too deeply");
        }
    }

    fn separate(&mut self) {
        let pending = self.open.last_mut().map_or(&mut self.pending, |open| &mut open.pending);
        self.nesting -= std::mem::take(pending);
        self.angles = 0;
    }

    fn too_deep(&mut self, at: usize, message: &str) {
        self.report(
            Diagnostic::new(codes::syntax::NESTING, message)
                .label(self.span(at, at + 1), format!("more than {MAX_NESTING} levels"))
                .help("give inner parts a name with `let` or `fn`"),
        );
        self.found.unreadable = true;
    }

    fn open(&mut self, bracket: u8) {
        self.angles = 0;
        self.open.push(Open { bracket, at: self.at, pending: 0 });
        self.nest(self.at);
        self.at += 1;
    }

    fn close(&mut self, bracket: u8) {
        let opening = match bracket {
            b')' => b'(',
            b']' => b'[',
            _ => b'{',
        };
        // A `)` or `]` looks for its partner within the innermost `{ … }` only.
        let partner = self
            .open
            .iter()
            .rposition(|open| open.bracket == opening || bracket != b'}' && open.bracket == b'{')
            .filter(|&i| self.open[i].bracket == opening);
        match partner {
            Some(partner) => {
                while self.open.len() > partner + 1 {
                    self.report_unclosed(Some(self.at));
                }
                self.pop();
            }
            None => {
                let text = (bracket as char).to_string();
                self.report(
                    Diagnostic::new(codes::syntax::BRACKET, format!("`{text}` closes nothing"))
                        .label(self.span(self.at, self.at + 1), format!("no `{}` is open here", opening as char))
                        .suggest(self.span(self.at, self.at + 1), "", Applicability::MaybeIncorrect),
                );
            }
        }
        if bracket == b'}' {
            self.separate();
        }
        self.angles = 0;
        self.at += 1;
    }

    fn pop(&mut self) -> Option<Open> {
        let open = self.open.pop()?;
        self.nesting -= 1 + open.pending;
        Some(open)
    }

    fn close_all(&mut self, at: usize) {
        // Of many open brackets the innermost is the cause; the others follow from it. A comment without an end has
        // swallowed the closing ones.
        if !self.open.is_empty() && !self.endless_comment {
            self.report_unclosed((at < self.bytes.len()).then_some(at));
        }
        self.open.clear();
        self.pending = 0;
        self.nesting = 0;
    }

    /// Reports the innermost open bracket and takes it away. `at` is what showed that it is not closed.
    fn report_unclosed(&mut self, at: Option<usize>) {
        let Some(open) = self.pop() else { return };
        let (opening, closing) = match open.bracket {
            b'(' => ('(', ')'),
            b'[' => ('[', ']'),
            _ => ('{', '}'),
        };
        let mut diagnostic = Diagnostic::new(codes::syntax::BRACKET, format!("`{opening}` is not closed"))
            .label(self.span(open.at, open.at + 1), "opened here");
        if open.bracket != b'{' {
            let end = self.end_of_line_content(open.at);
            if !self.text[open.at..end]
                .ends_with(['(', '[', '{', ',', '=', ':', '+', '-', '*', '/', '|', '&', '>', '<'])
            {
                self.found.masked.push(open.at);
            }
            diagnostic = diagnostic.label(self.span(end, end), format!("`{closing}` may be missing here"));
        } else if let Some(at) = at {
            diagnostic = diagnostic.label(self.span(at, at + 1), format!("`{closing}` is missing before this"));
        } else {
            diagnostic = diagnostic.help(format!("add the closing `{closing}`"));
        }
        self.report(diagnostic);
    }

    /// Where the text of a line ends, without a comment and the space before it.
    fn end_of_line_content(&self, at: usize) -> usize {
        let line_end = self.bytes[at..].iter().position(|&b| b == b'\n').map_or(self.bytes.len(), |n| at + n);
        let comment = self.found.comments.iter().rev().map(|c| c.start as usize).take_while(|&start| start > at);
        let end = comment.filter(|&start| start < line_end).last().unwrap_or(line_end);
        let content = self.text[at..end].trim_end();
        let content = content.strip_suffix(';').unwrap_or(content);
        at + content.len()
    }

    fn control_character(&mut self) {
        self.report(
            Diagnostic::new(codes::syntax::NOT_TEXT, "the file holds a control character: it is not a script")
                .label(self.span(self.at, self.at + 1), format!("character U+{:04X}", self.bytes[self.at]))
                .help("a scene script is plain UTF-8 text"),
        );
        self.found.unreadable = true;
    }

    fn foreign_character(&mut self) {
        let Some(character) = self.text[self.at..].chars().next() else { return };
        let start = self.at;
        self.at += character.len_utf8();
        if character == '\u{FEFF}' && start == 0 {
            return;
        }
        self.foreign += 1;
        if self.foreign > MAX_FOREIGN {
            return;
        }
        let span = self.span(start, self.at);
        let known = FOREIGN.iter().find(|(characters, ..)| characters.contains(character));
        let mut diagnostic =
            Diagnostic::new(codes::syntax::CHARACTER, format!("the character `{character}` has no meaning here"))
                .label(span, format!("U+{:04X}", u32::from(character)));
        diagnostic = match known {
            Some((_, replacement, help)) => {
                diagnostic.help(*help).suggest(span, *replacement, Applicability::MaybeIncorrect)
            }
            None => diagnostic.help(
                "names are made of ASCII letters, digits and `_`; other characters belong in strings and comments",
            ),
        };
        self.report(diagnostic);
        // The rest of a run of such characters says nothing new.
        let rest = &self.text[self.at..];
        self.at += rest.find(|c: char| c.is_ascii()).unwrap_or(rest.len());
    }
}

/// Characters that word processors make of others: what they stand for, and what to say.
const FOREIGN: [(&str, &str, &str); 8] = [
    ("“”„‟«»‘’‚‛", "\"", "strings stand in straight double quotes: `\"`"),
    ("–—−‐‑", "-", "minus is the ASCII character `-`"),
    ("×·⋅", "*", "multiplication is `*`"),
    ("÷", "/", "division is `/`"),
    ("≤", "<=", "write `<=`"),
    ("≥", ">=", "write `>=`"),
    ("°", "deg", "angles are written `45deg`"),
    ("\u{A0}\u{2002}\u{2003}\u{2009}\u{202F}\u{3000}\u{200B}", " ", "this is an unusual space: use the ASCII one"),
];
