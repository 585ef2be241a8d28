//! Tables of samples in text form: CSV and SPD.
//!
//! `#` begins a comment line; the first row of words names the columns, the first column is the wavelength in
//! nanometres; rows of numbers follow, separated by commas, semicolons or blanks.

use std::sync::Arc;

use arsc_ir::Spectrum;

pub fn parse(text: &str) -> Result<Vec<(String, Spectrum)>, String> {
    let mut columns: Option<Vec<String>> = None;
    let mut rows: Vec<Vec<f64>> = Vec::new();
    for (i, line) in text.lines().enumerate() {
        let line = line.trim();
        if line.is_empty() || line.starts_with('#') {
            continue;
        }
        let fields: Vec<&str> = line.split([',', ';', ' ', '\t']).filter(|field| !field.is_empty()).collect();
        let numbers: Option<Vec<f64>> =
            fields.iter().map(|field| field.parse().ok().filter(|x: &f64| x.is_finite())).collect();
        match numbers {
            Some(numbers) if rows.first().is_none_or(|first| first.len() == numbers.len()) => rows.push(numbers),
            Some(numbers) => {
                return Err(format!("line {} has {} columns, not {}", i + 1, numbers.len(), rows[0].len()));
            }
            None if rows.is_empty() && columns.is_none() => {
                columns = Some(fields.iter().map(|field| field.to_string()).collect());
            }
            None => return Err(format!("line {} is not a row of numbers", i + 1)),
        }
    }
    assemble(columns, &rows)
}

fn assemble(columns: Option<Vec<String>>, rows: &[Vec<f64>]) -> Result<Vec<(String, Spectrum)>, String> {
    let width = rows.first().map_or(0, Vec::len);
    if width < 2 {
        return Err("the table needs rows of a wavelength and at least one value".into());
    }
    let columns = columns.unwrap_or_else(|| (0..width).map(|i| i.to_string()).collect());
    if columns.len() != width {
        return Err(format!("the heading names {} columns, but rows have {width}", columns.len()));
    }
    let column = |i: usize| -> Arc<[f64]> { rows.iter().map(|row| row[i]).collect() };
    let lambda_nm = column(0);
    let spectrum = |i: usize| Spectrum::Tabulated { lambda_nm: lambda_nm.clone(), values: column(i) };
    Ok(columns.into_iter().enumerate().skip(1).map(|(i, name)| (name, spectrum(i))).collect())
}

#[cfg(test)]
mod tests {
    use super::parse;

    #[test]
    fn reads_headings_comments_and_rows() {
        let table = parse("# origin\nlambda_nm,a,b\n400,0.1,0.2\n500, 0.3, 0.4\n").ok().unwrap();
        let names: Vec<&str> = table.iter().map(|(name, _)| name.as_str()).collect();
        assert_eq!(names, ["a", "b"]);
        assert_eq!((table[0].1.eval(400.0), table[1].1.eval(450.0)), (0.1, 0.30000000000000004));
    }

    /// The form of `.spd` files: pairs divided by blanks, without a heading.
    #[test]
    fn reads_spd_files() {
        let table = parse("# lamp\n400 0.5\n500\t1.5\n").ok().unwrap();
        assert_eq!(table.len(), 1);
        assert_eq!(table[0].1.eval(450.0), 1.0);
    }

    #[test]
    fn refuses_what_is_no_table() {
        for (text, part) in [
            ("", "needs rows"),
            ("400,1\n500\n", "line 2 has 1 columns"),
            ("l,a\n400,NaN\n", "line 2 is not"),
            ("400,1\nfoo,2\n", "line 2 is not"),
            ("l,a,b\n400,1\n", "names 3 columns"),
        ] {
            let message = parse(text).err().unwrap_or_default();
            assert!(message.contains(part), "{text:?} gives {message:?}");
        }
    }
}
