//! Entries of the refractiveindex.info database: the part of YAML that they are written in.
//!
//! Below `DATA:` stands a list of entries, each beginning with `- type:`: `tabulated n`, `tabulated k` or `tabulated nk`
//! with rows of numbers after `data: |`, or `formula 1` to `formula 9` with `wavelength_range:` and `coefficients:`. Wavelengths
//! are in micrometres. What else there is in a file is passed over. Columns are `n` and `k`; of two entries for one, the
//! first counts. Formulas: [`arsc_spectral::dispersion`].

use arsc_ir::Spectrum;
use arsc_spectral::dispersion;

/// An entry as it is read.
#[derive(Default)]
struct Entry {
    kind: String,
    rows: Vec<Vec<f64>>,
    range_um: Option<[f64; 2]>,
    coefficients: Option<Vec<f64>>,
    /// Rows of numbers are expected.
    in_data: bool,
}

pub fn parse(text: &str) -> Result<Vec<(String, Spectrum)>, String> {
    let mut lines = text.lines().enumerate().skip_while(|(_, line)| line.trim_end() != "DATA:");
    if lines.next().is_none() {
        return Err("the file has no section `DATA:`".into());
    }
    let mut entries: Vec<Entry> = Vec::new();
    for (i, line) in lines {
        let word = line.trim();
        if !line.starts_with([' ', '-']) && !word.is_empty() && !word.starts_with('#') {
            // The next section.
            break;
        }
        if let Some(kind) = word.strip_prefix("- type:") {
            entries.push(Entry { kind: kind.trim().to_owned(), ..Entry::default() });
        } else if let Some(entry) = entries.last_mut() {
            read_line(entry, word).map_err(|message| format!("line {}: {message}", i + 1))?;
        }
    }
    let mut columns: Vec<(String, Spectrum)> = Vec::new();
    for entry in &entries {
        for (name, spectrum) in spectra(entry)? {
            if columns.iter().all(|(known, _)| known != name) {
                columns.push((name.to_owned(), spectrum));
            }
        }
    }
    columns.sort_by(|a, b| b.0.cmp(&a.0));
    if columns.is_empty() { Err("the file has neither n nor k".into()) } else { Ok(columns) }
}

fn read_line(entry: &mut Entry, line: &str) -> Result<(), String> {
    if line.is_empty() || line.starts_with('#') {
        return Ok(());
    }
    if let Some((key, value)) = line.split_once(':') {
        entry.in_data = key == "data";
        match key {
            "coefficients" => entry.coefficients = Some(numbers(value)?),
            "wavelength_range" => {
                let range = numbers(value)?.try_into().map_err(|_| "a range has two ends".to_owned())?;
                entry.range_um = Some(range);
            }
            _ => {}
        }
        return Ok(());
    }
    if entry.in_data {
        entry.rows.push(numbers(line)?);
    }
    Ok(())
}

fn numbers(text: &str) -> Result<Vec<f64>, String> {
    let number = |word: &str| word.parse().ok().filter(|x: &f64| x.is_finite());
    text.split_whitespace().map(|word| number(word).ok_or_else(|| format!("`{word}` is no number"))).collect()
}

/// The columns that an entry gives.
fn spectra(entry: &Entry) -> Result<Vec<(&'static str, Spectrum)>, String> {
    if let Some(number) = entry.kind.strip_prefix("formula ") {
        let coefficients = entry.coefficients.as_ref().ok_or("the formula has no coefficients")?;
        let range_nm = entry.range_um.ok_or("the formula has no wavelength range")?.map(|um| um * 1e3);
        let spectrum = number.parse().ok().and_then(|n| dispersion::spectrum(n, coefficients, range_nm));
        let spectrum = spectrum.ok_or_else(|| format!("formula {number} has no values from 200 to 1100 nm"))?;
        return Ok(vec![("n", spectrum)]);
    }
    let names: &[&'static str] = match entry.kind.as_str() {
        "tabulated n" => &["n"],
        "tabulated k" => &["k"],
        "tabulated nk" => &["n", "k"],
        _ => return Ok(Vec::new()),
    };
    if entry.rows.is_empty() || entry.rows.iter().any(|row| row.len() != names.len() + 1) {
        return Err(format!("`{}` needs rows of {} numbers", entry.kind, names.len() + 1));
    }
    let column = |i: usize, unit: f64| entry.rows.iter().map(|row| row[i] * unit).collect();
    let lambda_nm: std::sync::Arc<[f64]> = column(0, 1e3);
    let spectrum = |i: usize| Spectrum::Tabulated { lambda_nm: lambda_nm.clone(), values: column(i + 1, 1.0) };
    Ok(names.iter().enumerate().map(|(i, name)| (*name, spectrum(i))).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEAD: &str = "# comment\nREFERENCES: |\n    Somebody: a paper\nDATA:\n";

    #[test]
    fn reads_formulas_beside_tables() {
        let text = format!(
            "{HEAD}  - type: formula 2\n    wavelength_range: 0.3 2.5\n    coefficients: 0 1.03961212 0.00600069867 \
             0.231792344 0.0200179144 1.01046945 103.560653\n  - type: tabulated k\n    data: |\n        0.300 2.8e-06\n        \
             0.310 1.4e-06\nSPECS:\n    n_is_absolute: false\n    nd: 1.5168\n"
        );
        let columns = parse(&text).unwrap();
        assert_eq!(columns.iter().map(|(name, _)| name.as_str()).collect::<Vec<_>>(), ["n", "k"]);
        assert!((columns[0].1.eval(587.56) - 1.5168).abs() < 5e-6);
        assert!((columns[1].1.eval(305.0) - 2.1e-6).abs() < 1e-12);
    }

    #[test]
    fn reads_tables_of_n_and_k() {
        let columns =
            parse(&format!("{HEAD}  - type: tabulated nk\n    data: |\n      0.5 1.0 2.0\n      0.6 2.0 4.0\n"));
        let columns = columns.unwrap();
        assert!((columns[0].1.eval(550.0) - 1.5).abs() < 1e-12 && (columns[1].1.eval(550.0) - 3.0).abs() < 1e-12);
    }

    #[test]
    fn refuses_what_is_no_entry() {
        for (text, part) in [
            ("", "no section"),
            (HEAD, "neither n nor k"),
            ("DATA:\n  - type: formula 12\n    wavelength_range: 0.3 2\n    coefficients: 1\n", "formula 12 has no"),
            ("DATA:\n  - type: formula 1\n    coefficients: 1\n", "no wavelength range"),
            ("DATA:\n  - type: formula 1\n    wavelength_range: 0.3\n", "line 3: a range has two ends"),
            ("DATA:\n  - type: tabulated n\n    data: |\n      0.5 foo\n", "line 4: `foo` is no number"),
            ("DATA:\n  - type: tabulated nk\n    data: |\n      0.5 1\n", "needs rows of 3"),
        ] {
            let message = parse(text).err().unwrap_or_default();
            assert!(message.contains(part), "{text:?} gives {message:?}");
        }
    }
}
