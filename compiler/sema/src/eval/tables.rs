//! Tables of samples in text form.
//!
//! `#` begins a comment line; the first row of words names the columns, the first column is the wavelength in
//! nanometres; rows of numbers follow, separated by commas, semicolons or blanks.

use std::sync::Arc;

use arsc_diagnostics::codes::sema as codes;

use super::{Eval, Machine};
use crate::code::Site;
use crate::registry::asset_failure;

#[derive(Clone)]
pub struct Table {
    pub lambda_nm: Arc<[f64]>,
    /// Names of all columns but the first.
    pub columns: Vec<String>,
    pub values: Vec<Arc<[f64]>>,
}

impl Machine<'_> {
    /// The table in a file next to the calling module; read once.
    pub fn table(&mut self, path: &str, site: &Site) -> Eval<Table> {
        let key = (site.span.source, path.to_owned());
        if let Some(table) = self.tables.get(&key) {
            return Ok(table.clone());
        }
        let text = self.assets.text(site.span.source, path).map_err(|error| asset_failure(site, path, &error))?;
        self.spend_elements(text.len() / 8, site.span)?;
        let table = parse(&text).map_err(|message| site.fail_arg(0, codes::TABLE, message, "in this file"))?;
        self.tables.insert(key, table.clone());
        Ok(table)
    }
}

fn parse(text: &str) -> Result<Table, String> {
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

fn assemble(columns: Option<Vec<String>>, rows: &[Vec<f64>]) -> Result<Table, String> {
    let width = rows.first().map_or(0, Vec::len);
    if width < 2 {
        return Err("the table needs rows of a wavelength and at least one value".into());
    }
    let columns = columns.unwrap_or_else(|| (0..width).map(|i| i.to_string()).collect());
    if columns.len() != width {
        return Err(format!("the heading names {} columns, but rows have {width}", columns.len()));
    }
    let column = |i: usize| -> Arc<[f64]> { rows.iter().map(|row| row[i]).collect() };
    Ok(Table { lambda_nm: column(0), columns: columns[1..].to_vec(), values: (1..width).map(column).collect() })
}

#[cfg(test)]
mod tests {
    use super::parse;

    #[test]
    fn reads_headings_comments_and_rows() {
        let table = parse("# origin\nlambda_nm,a,b\n400,0.1,0.2\n500, 0.3, 0.4\n").ok().unwrap();
        assert_eq!(table.columns, ["a", "b"]);
        assert_eq!(*table.lambda_nm, [400.0, 500.0]);
        assert_eq!(*table.values[1], [0.2, 0.4]);
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
