//! Arguments that several subcommands share, and how their values are read.

use std::path::PathBuf;

use crate::check::{LimitArgs, LintArgs};

/// Where the scene comes from.
#[derive(clap::Args, Clone, Debug, Default)]
pub struct SceneArgs {
    /// The script, or `-` for standard input
    pub scene: PathBuf,

    /// Sets a `param` of the script; the value is an expression such as 512, 45deg or "text"
    #[arg(long = "set", value_name = "NAME=VALUE", value_parser = assignment)]
    pub set: Vec<(String, String)>,

    /// Lets the script read files below DIR too, besides its own folder
    #[arg(long, value_name = "DIR")]
    pub allow_read: Vec<PathBuf>,

    #[command(flatten)]
    pub lints: LintArgs,

    #[command(flatten)]
    pub limits: LimitArgs,
}

/// `name=value`
pub fn assignment(text: &str) -> Result<(String, String), String> {
    match text.split_once('=') {
        Some((name, value)) if !name.trim().is_empty() && !value.trim().is_empty() => {
            Ok((name.trim().to_owned(), value.trim().to_owned()))
        }
        _ => Err("expected NAME=VALUE".into()),
    }
}

/// Largest picture side: guards against a slip of the finger that would ask for terabytes.
const LARGEST_SIDE: u32 = 65_536;

/// `WIDTHxHEIGHT`, pixels.
pub fn resolution(text: &str) -> Result<[u32; 2], String> {
    let sides = text.split_once(['x', 'X']).and_then(|(w, h)| Some([w.trim().parse().ok()?, h.trim().parse().ok()?]));
    match sides {
        Some([w, h]) if (1..=LARGEST_SIDE).contains(&w) && (1..=LARGEST_SIDE).contains(&h) => Ok([w, h]),
        _ => Err(format!("expected WIDTHxHEIGHT with sides from 1 to {LARGEST_SIDE}, for example 640x480")),
    }
}

/// Bytes: a number with K, M, G or T (thousands) behind it, or nothing.
pub fn size(text: &str) -> Result<usize, String> {
    let text = text.trim().trim_end_matches(['B', 'b']);
    let (digits, unit) = match text.char_indices().last() {
        Some((at, letter)) if letter.is_ascii_alphabetic() => (&text[..at], letter.to_ascii_uppercase()),
        _ => (text, ' '),
    };
    let factor = [(' ', 1.0), ('K', 1e3), ('M', 1e6), ('G', 1e9), ('T', 1e12)].into_iter().find(|(u, _)| *u == unit);
    let number = digits.trim().parse::<f64>().ok().filter(|n| n.is_finite() && *n >= 0.0);
    match (factor, number) {
        (Some((_, factor)), Some(number)) => Ok((number * factor) as usize),
        _ => Err("expected a number of bytes, for example 64k, 500M or 2G".into()),
    }
}

/// `x0,y0,x1,y1`, pixels from the upper left corner, the end excluded.
pub fn crop(text: &str) -> Result<[u32; 4], String> {
    let numbers: Option<Vec<u32>> = text.split(',').map(|n| n.trim().parse().ok()).collect();
    match numbers.as_deref() {
        Some(&[x0, y0, x1, y1]) if x0 < x1 && y0 < y1 => Ok([x0, y0, x1, y1]),
        _ => Err("expected x0,y0,x1,y1 with x0 < x1 and y0 < y1, for example 0,0,320,240".into()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_read_and_slips_refused() {
        assert_eq!(resolution("640x480"), Ok([640, 480]));
        for slip in ["640", "0x10", "640x", "x480", "-1x5", "99999x2", "1e3x2"] {
            assert!(resolution(slip).is_err(), "{slip}");
        }
        assert_eq!(crop("1,2,3,4"), Ok([1, 2, 3, 4]));
        for slip in ["1,2,3", "3,2,1,4", "1,2,3,4,5", "", "1,2,3,2"] {
            assert!(crop(slip).is_err(), "{slip}");
        }
        assert_eq!((size("12"), size("1.5k"), size("2 MB")), (Ok(12), Ok(1500), Ok(2_000_000)));
        for slip in ["", "M", "-1", "1x", "nan", "1e400"] {
            assert!(size(slip).is_err(), "{slip}");
        }
        assert_eq!(assignment("a = b=c"), Ok(("a".into(), "b=c".into())));
        assert!(assignment("a").is_err() && assignment("=1").is_err() && assignment("a=").is_err());
    }
}
