//! Scripts with a few words exchanged: whatever comes out, analysis ends without a panic, and a scene without an
//! error is a valid IR.

mod common;

use arsc_sema::{Limits, Options};
use common::Session;

/// Words, numbers, strings and signs, with the blanks before them.
fn tokens(text: &str) -> Vec<String> {
    let mut tokens: Vec<String> = Vec::new();
    let mut chars = text.chars().peekable();
    while let Some(c) = chars.next() {
        let mut token = String::from(c);
        let word = |c: char| c.is_alphanumeric() || c == '_';
        if word(c) {
            while let Some(next) = chars.next_if(|&next| word(next)) {
                token.push(next);
            }
        } else if c == '"' {
            for next in chars.by_ref() {
                token.push(next);
                if next == '"' {
                    break;
                }
            }
        } else if c == '/' && chars.peek() == Some(&'/') {
            while chars.next_if(|&next| next != '\n').is_some() {}
            continue;
        }
        tokens.push(token);
    }
    tokens
}

fn class(token: &str) -> u8 {
    match token.as_bytes().first() {
        Some(b'0'..=b'9') => 1,
        Some(b'"') => 2,
        Some(b'a'..=b'z' | b'A'..=b'Z' | b'_') => 3,
        _ => 4,
    }
}

/// Numerical Recipes' linear congruential generator: enough to choose words.
struct Choices(u64);

impl Choices {
    fn below(&mut self, n: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as usize % n
    }
}

fn corpus() -> Vec<String> {
    let root = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");
    let page = std::fs::read_to_string(format!("{root}/docs/reference/language.md")).unwrap();
    let examples = page.split("```arsl\n").skip(1).map(|block| block.split("```").next().unwrap().to_owned());
    let scenes = ["boolean_operators", "cornell_box", "phyllotaxis"];
    let scenes = scenes.map(|name| std::fs::read_to_string(format!("{root}/scenes/{name}.arsl")).unwrap());
    examples.chain(scenes).filter(|text| !text.contains("parts/wheel.arsl")).collect()
}

fn mutant(corpus: &[Vec<String>], pool: &[String], choices: &mut Choices) -> String {
    let mut tokens = corpus[choices.below(corpus.len())].clone();
    for _ in 0..1 + choices.below(4) {
        let i = choices.below(tokens.len());
        match choices.below(8) {
            0 => drop(tokens.remove(i)),
            1 => tokens.insert(i, pool[choices.below(pool.len())].clone()),
            _ => {
                let other = &pool[choices.below(pool.len())];
                if class(other) == class(&tokens[i]) {
                    tokens[i] = other.clone();
                }
            }
        }
    }
    tokens.concat()
}

fn analyse(text: &str) -> bool {
    let limits = Limits { steps: 20_000, recursion: 50, nodes: 5_000, elements: 20_000 };
    let mut session = Session::default();
    let Some(analysed) = session.analyse_any(text, Options { limits, ..Options::default() }) else { return false };
    let failed = analysed.diagnostics.iter().any(|d| d.is_error());
    assert!(analysed.ir.is_some() != failed, "an IR and errors, or neither");
    if let Some(ir) = &analysed.ir {
        arsc_ir::verify(ir).unwrap_or_else(|faults| panic!("{faults:?}"));
    }
    !failed
}

/// `MUTANTS=100000 cargo test -p arsc-sema --test mutants` looks further, with other choices.
#[test]
fn mutants_do_no_harm() {
    let count: usize = std::env::var("MUTANTS").ok().and_then(|text| text.parse().ok()).unwrap_or(1_000);
    let corpus: Vec<Vec<String>> = corpus().iter().map(|text| tokens(text)).collect();
    let pool: Vec<String> =
        corpus.iter().flatten().filter(|token| class(token) != 4 || token.trim() != "").cloned().collect();
    let mut choices = Choices(count as u64);
    let mut fine = 0;
    for i in 0..count {
        let text = mutant(&corpus, &pool, &mut choices);
        let shown = text.clone();
        let run = std::thread::Builder::new().stack_size(64 << 20).spawn(move || analyse(&text)).unwrap().join();
        match run {
            Ok(ok) => fine += usize::from(ok),
            Err(_) => panic!("mutant {i}:\n{shown}"),
        }
    }
    // Too few, and the mutants would test the parser only.
    assert!(fine > count / 20, "{fine} of {count} are without errors");
}
