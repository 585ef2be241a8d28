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

/// Seconds: `90`, `90s`, `1.5min`, `1h30m`.
pub fn duration(text: &str) -> Result<f64, String> {
    let mut seconds = 0.0;
    let mut rest = text.trim();
    while !rest.is_empty() {
        let digits = rest.find(|c: char| !c.is_ascii_digit() && c != '.').unwrap_or(rest.len());
        let (number, behind) = rest.split_at(digits);
        if number.is_empty() {
            seconds = f64::NAN;
            break;
        }
        let behind = behind.trim_start();
        let letters = behind.find(|c: char| !c.is_ascii_alphabetic()).unwrap_or(behind.len());
        let (unit, behind) = behind.split_at(letters);
        let factor = match unit {
            "s" => 1.0,
            "" if behind.is_empty() => 1.0,
            "m" | "min" => 60.0,
            "h" => 3600.0,
            _ => f64::NAN,
        };
        seconds += number.parse::<f64>().map_or(f64::NAN, |number| number * factor);
        rest = behind.trim_start();
    }
    if seconds > 0.0 && seconds.is_finite() {
        Ok(seconds)
    } else {
        Err("expected a time, for example 60s, 5min or 1h30m".into())
    }
}

/// A share above 0, at most 1: `0.01` or `1%`.
pub fn noise(text: &str) -> Result<f64, String> {
    let text = text.trim();
    let (number, factor) = text.strip_suffix('%').map_or((text, 1.0), |number| (number.trim(), 0.01));
    let share = number.parse::<f64>().map(|number| number * factor);
    share.ok().filter(|share| *share > 0.0 && *share <= 1.0).ok_or("expected a share, for example 0.01 or 1%".into())
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
        let times = [("90", 90.0), ("1.5 min", 90.0), ("1h30m", 5400.0), ("2min 5s", 125.0)];
        let _ = times.map(|(text, seconds)| assert_eq!(duration(text), Ok(seconds), "{text}"));
        let _ =
            ["", "0s", "-3s", "s", "3d", "1 2", "1.2.3s", "inf"].map(|text| assert!(duration(text).is_err(), "{text}"));
        assert_eq!([noise("0.01"), noise("2 %")], [Ok(0.01), Ok(0.02)]);
        let _ = ["0", "-1%", "2", "NaN", "%"].map(|text| assert!(noise(text).is_err(), "{text}"));
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
