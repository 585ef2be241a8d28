//! The lexical layer of the text form: terms such as `sphere(radius: 1.0, material: m0)`.
//!
//! Every token keeps its byte offset for errors. Terms nest at most [`MAX_NESTING`] deep.

/// Spectra are the only thing that nests.
pub(crate) const MAX_NESTING: usize = 200;

#[derive(Clone, Debug, PartialEq)]
pub(crate) enum TermKind<'a> {
    /// As written: integers are read exactly.
    Number(&'a str),
    Word(&'a str),
    Text(String),
    /// `%12`
    Node(u32),
    List(Vec<Term<'a>>),
    Call(&'a str, Vec<(Option<&'a str>, Term<'a>)>),
}

#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Term<'a> {
    pub kind: TermKind<'a>,
    pub offset: usize,
}

/// An error at a byte offset.
pub(crate) type Fault = (usize, String);

/// A position in the text.
pub(crate) struct Cursor<'a> {
    text: &'a str,
    pub offset: usize,
}

impl<'a> Cursor<'a> {
    pub fn new(text: &'a str) -> Cursor<'a> {
        Cursor { text, offset: 0 }
    }

    /// Skips spaces, line breaks and `#` comments; true when something is left.
    pub fn skip_blank(&mut self) -> bool {
        loop {
            let rest = &self.text[self.offset..];
            let trimmed = rest.trim_start();
            self.offset += rest.len() - trimmed.len();
            if !trimmed.starts_with('#') {
                return !trimmed.is_empty();
            }
            self.offset += trimmed.find('\n').unwrap_or(trimmed.len());
        }
    }

    pub fn peek(&mut self) -> Option<char> {
        self.skip_blank();
        self.text[self.offset..].chars().next()
    }

    pub fn fault<T>(&self, message: impl Into<String>) -> Result<T, Fault> {
        Err((self.offset, message.into()))
    }

    pub fn accept(&mut self, token: &str) -> bool {
        self.skip_blank();
        let found = self.text[self.offset..].starts_with(token);
        if found {
            self.offset += token.len();
        }
        found
    }

    pub fn expect(&mut self, token: &str) -> Result<(), Fault> {
        if self.accept(token) { Ok(()) } else { self.fault(format!("expected `{token}`")) }
    }

    /// The longest run of characters that satisfy `accepted`.
    fn run(&mut self, accepted: impl Fn(char) -> bool) -> &'a str {
        let rest = &self.text[self.offset..];
        let run = &rest[..rest.find(|c| !accepted(c)).unwrap_or(rest.len())];
        self.offset += run.len();
        run
    }

    pub fn word(&mut self) -> Result<&'a str, Fault> {
        match self.peek() {
            Some(c) if c.is_ascii_alphabetic() || c == '_' => Ok(self.run(|c| c.is_ascii_alphanumeric() || c == '_')),
            _ => self.fault("expected a word"),
        }
    }

    pub fn integer(&mut self) -> Result<u32, Fault> {
        self.skip_blank();
        let start = self.offset;
        self.run(|c| c.is_ascii_digit()).parse().map_err(|_| (start, "expected an integer below 2^32".to_owned()))
    }

    pub fn node(&mut self) -> Result<u32, Fault> {
        self.expect("%")?;
        self.integer()
    }

    pub fn term(&mut self) -> Result<Term<'a>, Fault> {
        self.nested(0)
    }

    fn nested(&mut self, depth: usize) -> Result<Term<'a>, Fault> {
        if depth > MAX_NESTING {
            return self.fault(format!("nested more than {MAX_NESTING} deep"));
        }
        let first = self.peek();
        let offset = self.offset;
        let kind = match first {
            Some('%') => TermKind::Node(self.node()?),
            Some('"') => TermKind::Text(self.text_literal()?),
            Some('[') => {
                self.offset += 1;
                let mut items = Vec::new();
                while !self.accept("]") {
                    items.push(self.nested(depth + 1)?);
                    self.separator("]")?;
                }
                TermKind::List(items)
            }
            Some(c) if c == '-' || c == '+' || c == '.' || c.is_ascii_digit() => {
                TermKind::Number(self.run(|c| c.is_ascii_alphanumeric() || matches!(c, '-' | '+' | '.')))
            }
            _ => {
                let word = self.word()?;
                if self.accept("(") { TermKind::Call(word, self.arguments(depth)?) } else { TermKind::Word(word) }
            }
        };
        Ok(Term { kind, offset })
    }

    fn arguments(&mut self, depth: usize) -> Result<Vec<(Option<&'a str>, Term<'a>)>, Fault> {
        let mut arguments = Vec::new();
        while !self.accept(")") {
            self.skip_blank();
            let start = self.offset;
            let name = match self.word() {
                Ok(word) if self.accept(":") => Some(word),
                _ => {
                    self.offset = start;
                    None
                }
            };
            arguments.push((name, self.nested(depth + 1)?));
            self.separator(")")?;
        }
        Ok(arguments)
    }

    /// A comma, unless the end of the list follows.
    fn separator(&mut self, end: &str) -> Result<(), Fault> {
        self.skip_blank();
        if self.accept(",") || self.text[self.offset..].starts_with(end) {
            return Ok(());
        }
        self.fault(format!("expected `,` or `{end}`"))
    }

    fn text_literal(&mut self) -> Result<String, Fault> {
        let start = self.offset;
        self.offset += 1;
        let mut text = String::new();
        loop {
            text.push_str(self.run(|c| c != '"' && c != '\\'));
            if self.text[self.offset..].starts_with('"') {
                self.offset += 1;
                return Ok(text);
            }
            if self.offset == self.text.len() {
                return Err((start, "the string does not end".to_owned()));
            }
            self.offset += 1;
            text.push(self.escape()?);
        }
    }

    fn escape(&mut self) -> Result<char, Fault> {
        let start = self.offset;
        if let Some(quoted) = self.text[self.offset..].chars().next().filter(|c| matches!(c, '"' | '\\')) {
            self.offset += 1;
            return Ok(quoted);
        }
        if self.text[self.offset..].starts_with("u{") {
            self.offset += 2;
            let digits = self.run(|c| c.is_ascii_hexdigit());
            let scalar = u32::from_str_radix(digits, 16).ok().and_then(char::from_u32);
            if let (Some(c), true) = (scalar, self.text[self.offset..].starts_with('}')) {
                self.offset += 1;
                return Ok(c);
            }
        }
        Err((start, "unknown escape in a string".to_owned()))
    }
}
