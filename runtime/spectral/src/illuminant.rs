//! White points by name: the CIE's illuminants, temperatures and chromaticities.
//!
//! Chromaticities are computed from the tables of `stdlib/data` for the CIE 1931 observer. A temperature is that of
//! daylight from 4000 K on and of a black body below.

use std::sync::Arc;

use crate::observer::numeric_rows;
use crate::{Spectrum, chromaticity, daylight_chromaticity, xyz_of_radiance};

/// Temperatures that are accepted, kelvin.
const KELVIN: [f64; 2] = [1000.0, 25000.0];

macro_rules! table {
    ($name:literal) => {
        include_str!(concat!("../../../stdlib/data/", $name, ".csv"))
    };
}

/// Tables with one column for each name.
const TABLES: &[(&[&str], &str)] = &[
    (&["A"], table!("a")),
    (&["B"], table!("b")),
    (&["C"], table!("c")),
    (&["D50"], table!("d50")),
    (&["D55"], table!("d55")),
    (&["D65"], table!("d65")),
    (&["D75"], table!("d75")),
    (&["FL1", "FL2", "FL3", "FL4", "FL5", "FL6", "FL7", "FL8", "FL9", "FL10", "FL11", "FL12"], table!("fl")),
    (&["HP1", "HP2", "HP3", "HP4", "HP5"], table!("hp")),
    (&["LED-B1", "LED-B2", "LED-B3", "LED-B4", "LED-B5", "LED-BH1", "LED-RGB1", "LED-V1", "LED-V2"], table!("led")),
];

/// Chromaticity x, y of a white: the name of an illuminant (`D50`, `A`, `E`, `FL11`, `LED-B3`, …, in any case), a
/// temperature such as `5600K`, or `x,y`. The error lists what there is.
pub fn white_point(name: &str) -> Result<[f64; 2], String> {
    let name = name.trim();
    if name.eq_ignore_ascii_case("E") {
        return Ok([1.0 / 3.0; 2]);
    }
    if let Some(kelvin) = name.strip_suffix(['K', 'k']).and_then(|number| number.trim().parse::<f64>().ok()) {
        let [low, high] = KELVIN;
        return if (low..=high).contains(&kelvin) {
            Ok(white_of_temperature(kelvin))
        } else {
            Err(format!("a white point has from {low} K to {high} K"))
        };
    }
    if let Some((x, y)) = name.split_once(',') {
        let both = x.trim().parse::<f64>().ok().zip(y.trim().parse::<f64>().ok());
        return match both {
            Some((x, y)) if x > 0.0 && y > 0.0 && x + y < 1.0 => Ok([x, y]),
            _ => Err("a chromaticity is x,y with x, y > 0 and x + y < 1".into()),
        };
    }
    for (names, text) in TABLES {
        if let Some(column) = names.iter().position(|known| known.eq_ignore_ascii_case(name)) {
            return Ok(chromaticity_of_column(text, column, names.len()));
        }
    }
    let names: Vec<&str> = TABLES.iter().flat_map(|(names, _)| names.iter().copied()).collect();
    Err(format!(
        "no white point is called `{name}`: there are E, {}, temperatures such as 5600K, and x,y",
        names.join(", ")
    ))
}

/// Chromaticity of daylight, below 4000 K of a black body.
pub fn white_of_temperature(kelvin: f64) -> [f64; 2] {
    if kelvin >= crate::DAYLIGHT_KELVIN[0] {
        daylight_chromaticity(kelvin)
    } else {
        chromaticity(xyz_of_radiance(&Spectrum::Blackbody { kelvin }))
    }
}

fn chromaticity_of_column(text: &str, column: usize, columns: usize) -> [f64; 2] {
    let rows: Vec<(f64, f64)> = match columns {
        1 => numeric_rows::<2>(text).iter().map(|row| (row[0], row[1])).collect(),
        5 => numeric_rows::<6>(text).iter().map(|row| (row[0], row[column + 1])).collect(),
        9 => numeric_rows::<10>(text).iter().map(|row| (row[0], row[column + 1])).collect(),
        _ => numeric_rows::<13>(text).iter().map(|row| (row[0], row[column + 1])).collect(),
    };
    let lambda_nm: Arc<[f64]> = rows.iter().map(|row| row.0).collect();
    let values: Arc<[f64]> = rows.iter().map(|row| row.1).collect();
    chromaticity(xyz_of_radiance(&Spectrum::Tabulated { lambda_nm, values }))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Published chromaticities (CIE 15:2018, tables T.3, T.8 and the annexes of the LED illuminants).
    #[test]
    fn chromaticities_are_the_published_ones() {
        for (name, x, y) in [
            ("A", 0.44758, 0.40745),
            ("C", 0.31006, 0.31616),
            ("d50", 0.34567, 0.35850),
            ("D65", 0.31272, 0.32903),
            ("FL2", 0.3721, 0.3751),
            ("FL11", 0.3805, 0.3769),
            ("HP1", 0.5330, 0.4150),
            ("LED-B3", 0.3756, 0.3723),
            ("E", 0.33333, 0.33333),
            ("2856K", 0.44758, 0.40745),
            ("6504 K", 0.3127, 0.3291),
            ("0.3, 0.31", 0.3, 0.31),
        ] {
            let [found_x, found_y] = white_point(name).unwrap();
            assert!((found_x - x).abs() < 2e-4 && (found_y - y).abs() < 2e-4, "{name}: {found_x} {found_y}");
        }
    }

    #[test]
    fn what_is_no_white_is_refused() {
        for name in ["", "D66", "5K", "nanK", "infK", "1e9K", "0.9,0.9", "0,0.3", "a,b", "0.3,0.3,0.3"] {
            assert!(white_point(name).is_err(), "{name}");
        }
        assert!(white_point("F").unwrap_err().contains("FL12"));
    }
}
