//! `arsc explain`: what a code means, or the list of all codes.

use std::io::Write;

use arsc_diagnostics::{Code, closest, codes};

use crate::exit::Exit;

#[derive(clap::Args, Debug)]
pub struct Args {
    /// A code such as E0101 or arsl::E0101, or a lint's name; without it all codes are listed
    code: Option<String>,
}

pub fn run(args: &Args) -> Exit {
    let text = match &args.code {
        None => list(),
        Some(name) => match find(name) {
            Some(code) => page(code),
            None => {
                let names = codes::all().flat_map(|code| [code.id(), code.name()]);
                let meant = closest(name, names).map_or(String::new(), |meant| format!("; did you mean `{meant}`?"));
                eprintln!("error: there is no code `{name}`{meant}");
                return Exit::CouldNotRun;
            }
        },
    };
    // A reader that has seen enough, such as `head`, is no error.
    let _ = std::io::stdout().write_all(text.as_bytes());
    Exit::Clean
}

fn find(name: &str) -> Option<Code> {
    let id = name.strip_prefix("arsl::").unwrap_or(name);
    codes::find(id).or_else(|| codes::find(&id.to_ascii_uppercase()))
}

fn page(code: Code) -> String {
    code.page().map_or_else(|| format!("{code}: {}\n", code.summary()), str::to_string)
}

fn list() -> String {
    let mut codes: Vec<Code> = codes::all().collect();
    codes.sort_by_key(|code| code.id());
    let width = codes.iter().map(|code| code.name().len()).max().unwrap_or(0);
    codes.iter().map(|code| format!("{}  {:width$}  {}\n", code.id(), code.name(), code.summary())).collect()
}
