//! Fluorescence: what a surface re-radiates, dyes of media, and the surface that shows it.
//!
//! Matrices are read as Donaldson's: an entry is the spectral power at the emission wavelength over the power in a band, one
//! step wide, about the excitation wavelength. Where the two wavelengths are the same it is the plain reflectance.

use std::sync::Arc;

use arsc_diagnostics::Diagnostic;
use arsc_diagnostics::codes::sema as codes;
use arsc_ir::{Bsdf, DonaldsonMatrix, Dye, Fluorescence, Reradiation, Spectrum};

use super::materials::{MATERIAL, bsdf};
use super::{Builtin, Param};
use crate::code::Site;
use crate::eval::{Eval, Machine};
use crate::types::SpectrumKind::{Coefficient, Emission, Reflectance};
use crate::types::Type::{self, Angle, Float, Str, Wavelength};
use crate::value::Value;

/// Photons that leave for each that comes: measurements and tables have rounding.
const MOST_PHOTONS: f64 = 1.0 + 1e-3;

/// The bsdf.
pub fn fluorescent() -> Builtin {
    Builtin::new(
        "fluorescent",
        "A diffuse surface that changes the wavelength of light; Lambert's law, or rough as `oren_nayar`.",
    )
    .module(MATERIAL)
    .param(Param::new("reradiation", Type::Reradiation, "what it gives back of the light of each wavelength"))
    .param(Param::new("sigma", Angle, "standard deviation of the facets' slope").degrees(0.0).degrees_below(90.0))
    .runs(Type::Bsdf, |m, args, _| {
        let reradiation = args[0].as_reradiation().as_ref().clone();
        bsdf(m, Bsdf::Fluorescent { reradiation, sigma: args[1].as_float() })
    })
}

/// The spectra.
pub fn builtins() -> Vec<Builtin> {
    let kind = Type::Spectrum;
    let reflectance = || Param::new("reflectance", kind(Reflectance), "of light that keeps its wavelength");
    let emission = || Param::new("emission", kind(Emission), "what the dye emits, in any unit");
    let quantum_yield =
        || Param::new("quantum_yield", Float, "photons emitted for each one absorbed").float(1.0).within(0.0, 1.0);
    let start = |name| Param::new(name, Wavelength, "of the first sample").positive();
    let step = |name| Param::new(name, Wavelength, "from one sample to the next").positive();
    vec![
        Builtin::new("reradiation", "What a surface with a fluorescent dye gives back.")
            .param(reflectance())
            .param(Param::new("absorption", kind(Reflectance), "share of light that the dye takes up"))
            .param(emission())
            .param(quantum_yield())
            .runs(Type::Reradiation, |m, args, site| {
                let dye = dye_of(&args[1..]);
                m.require_non_negative(&args[1], "the absorption", site, 1)?;
                lint_anti_stokes(m, &dye, site, 2);
                let reflectance = args[0].as_spectrum().as_ref().clone();
                checked(Reradiation { reflectance, fluorescence: Fluorescence::Dye(dye) }, site, 1)
            }),
        Builtin::new(
            "gaussian_reradiation",
            "What a surface with a dye gives back that absorbs and emits bell curves.",
        )
        .param(reflectance())
        .param(Param::new("excitation", Wavelength, "where the dye absorbs most").positive())
        .param(Param::new("excitation_width", Wavelength, "standard deviation").positive())
        .param(Param::new("emission", Wavelength, "where it emits most").positive())
        .param(Param::new("emission_width", Wavelength, "standard deviation").positive())
        .param(
            Param::new("strength", Float, "photons emitted for each one that comes, at the peak of absorption")
                .float(0.5)
                .within(0.0, 1.0),
        )
        .runs(Type::Reradiation, |m, args, site| {
            let bell = |i: usize, peak: f64| {
                let (center_nm, sigma_nm) = (args[i].as_float(), args[i + 1].as_float());
                Spectrum::Gaussian { center_nm, sigma_nm, peak }
            };
            let dye = Dye { absorption: bell(1, args[5].as_float()), emission: bell(3, 1.0), quantum_yield: 1.0 };
            lint_anti_stokes(m, &dye, site, 3);
            let reflectance = args[0].as_spectrum().as_ref().clone();
            checked(Reradiation { reflectance, fluorescence: Fluorescence::Dye(dye) }, site, 5)
        }),
        Builtin::new("reradiation_matrix", "A measured (Donaldson) matrix; a row for each excitation wavelength.")
            .param(start("excitation_start"))
            .param(step("excitation_step"))
            .param(start("emission_start"))
            .param(step("emission_step"))
            .param(Param::new(
                "rows",
                Type::list(Type::list(Float)),
                "shares of the light; on the diagonal reflectances",
            ))
            .param(reflectance().optional())
            .runs(Type::Reradiation, |m, args, site| {
                let grid = |i: usize| [args[i].as_float(), args[i + 1].as_float()];
                let rows: Vec<Vec<f64>> =
                    args[4].as_list().iter().map(|row| row.as_list().iter().map(Value::as_float).collect()).collect();
                m.spend_elements(rows.iter().map(Vec::len).sum(), site.span)?;
                matrix(grid(0), grid(2), &rows, &args[5], site, 4)
            }),
        Builtin::new("tabulated_reradiation", "A measured (Donaldson) matrix from a file.")
            .param(Param::new(
                "path",
                Str,
                "CSV file, relative to the module: emission wavelengths in nm as heading, then rows of an excitation \
                 wavelength and the shares of its light; both in equal steps, on the diagonal reflectances",
            ))
            .param(reflectance().optional())
            .runs(Type::Reradiation, from_file),
        Builtin::new("dye", "A fluorescent substance in a medium: `medium(dyes: [dye(…)])`.")
            .param(Param::new("absorption", kind(Coefficient), "absorption coefficient at density 1, per metre"))
            .param(emission())
            .param(quantum_yield())
            .runs(Type::Dye, |m, args, site| {
                let dye = dye_of(args);
                m.require_non_negative(&args[0], "the absorption", site, 0)?;
                lint_anti_stokes(m, &dye, site, 1);
                Ok(Value::Dye(Arc::new(dye)))
            }),
    ]
}

/// From absorption, emission and quantum yield.
fn dye_of(args: &[Value]) -> Dye {
    let spectrum = |i: usize| args[i].as_spectrum().as_ref().clone();
    Dye { absorption: spectrum(0), emission: spectrum(1), quantum_yield: args[2].as_float() }
}

/// No more photons come than there are; `arg` is to blame.
fn checked(reradiation: Reradiation, site: &Site, arg: usize) -> Eval {
    let (share, nm) = reradiation.largest_share();
    if share <= MOST_PHOTONS {
        return Ok(Value::Reradiation(Arc::new(reradiation)));
    }
    let share = (share * 1e3).round() / 1e3;
    let mut failure = *site.fail_arg(
        arg,
        codes::OUT_OF_RANGE,
        format!("the surface makes {share} photons of one at {nm}nm"),
        "with what is reflected",
    );
    failure = failure.help("what is reflected and what is absorbed, or emitted, must not exceed 1 together");
    Err(Box::new(failure))
}

fn lint_anti_stokes(m: &mut Machine<'_>, dye: &Dye, site: &Site, arg: usize) {
    if let Some([absorbed, emitted]) = dye.mean_photon_energies()
        && emitted > absorbed
    {
        let around = |energy: f64| format!("{:.0}nm", 1.0 / energy);
        m.lint(
            Diagnostic::new(codes::ANTI_STOKES, "the dye emits light of more energy than it absorbs")
                .label(site.args[arg], format!("about {}, absorbed about {}", around(emitted), around(absorbed)))
                .help("fluorescence goes to longer wavelengths"),
        );
    }
}

fn from_file(m: &mut Machine<'_>, args: &[Value], site: &Site) -> Eval {
    let table = m.table(args[0].as_str(), site)?;
    let fail = |message: String| Err(site.fail_arg(0, codes::TABLE, message, "in this file"));
    let mut emission_nm = Vec::new();
    for (heading, _) in &table.columns {
        match heading.parse::<f64>() {
            Ok(nm) if nm.is_finite() => emission_nm.push(nm),
            _ => {
                return fail(format!(
                    "the heading `{}` is no wavelength",
                    heading.chars().take(20).collect::<String>()
                ));
            }
        }
    }
    let columns: Vec<(&[f64], &[f64])> = table
        .columns
        .iter()
        .filter_map(|(_, spectrum)| match spectrum {
            Spectrum::Tabulated { lambda_nm, values } => Some((&**lambda_nm, &**values)),
            _ => None,
        })
        .collect();
    let Some((excitation_nm, _)) = columns.first().filter(|_| columns.len() == emission_nm.len()) else {
        return fail("the file is no matrix".into());
    };
    let (Some(excitation), Some(emission)) = (regular(excitation_nm), regular(&emission_nm)) else {
        return fail("the wavelengths of a matrix must increase in equal steps".into());
    };
    let row = |i: usize| columns.iter().map(|(_, values)| values[i]).collect();
    let rows: Vec<Vec<f64>> = (0..excitation_nm.len()).map(row).collect();
    matrix(excitation, emission, &rows, &args[1], site, 0)
}

/// Start and step of a regular grid of at least two positive wavelengths.
fn regular(nm: &[f64]) -> Option<[f64; 2]> {
    let (first, step) = (*nm.first()?, nm.get(1)? - nm[0]);
    let even = |(i, x): (usize, &f64)| (x - (first + step * i as f64)).abs() <= 1e-6 * step;
    (first > 0.0 && step > 0.0 && nm.iter().enumerate().all(even)).then_some([first, step])
}

/// Splits a matrix into the reflectance on its diagonal and the rest; `arg` is where it comes from.
fn matrix(
    excitation: [f64; 2],
    emission: [f64; 2],
    rows: &[Vec<f64>],
    reflectance: &Value,
    site: &Site,
    arg: usize,
) -> Eval {
    let columns = rows.first().map_or(0, Vec::len);
    if columns == 0 {
        return Err(site.fail_arg(arg, codes::EMPTY_LIST, "a matrix needs rows of entries", "there are none"));
    }
    if let Some(row) = rows.iter().position(|row| row.len() != columns) {
        let message = format!("row {} of the matrix has {} entries, not {columns}", row + 1, rows[row].len());
        return Err(site.fail_arg(arg, codes::TABLE, message, "in this matrix"));
    }
    let lowest = rows.iter().flatten().copied().fold(f64::INFINITY, f64::min);
    if lowest < 0.0 {
        let message = format!("shares of light must not be negative, but one is {lowest}");
        return Err(site.fail_arg(arg, codes::OUT_OF_RANGE, message, "in this matrix"));
    }
    let mut entries: Vec<f64> = rows.concat();
    let (mut lambda_nm, mut values) = (Vec::new(), Vec::new());
    for row in 0..rows.len() {
        let mu = excitation[0] + excitation[1] * row as f64;
        let column = (mu - emission[0]) / emission[1];
        if column > -0.5 && (column - column.round()).abs() < 1e-6 && (column.round() as usize) < columns {
            let entry = &mut entries[row * columns + column.round() as usize];
            lambda_nm.push(mu);
            values.push(std::mem::take(entry));
        }
    }
    let reflectance = match (reflectance.is_given(), lambda_nm.is_empty()) {
        (true, _) => reflectance.as_spectrum().as_ref().clone(),
        (false, false) => Spectrum::Tabulated { lambda_nm: lambda_nm.into(), values: values.into() },
        (false, true) => {
            let message = "no emission wavelength is an excitation wavelength: the reflectance is not known";
            let failure = *site.fail_arg(arg, codes::TABLE, message, "this matrix has no diagonal");
            return Err(Box::new(failure.help("give it: `reflectance: …`")));
        }
    };
    let matrix = DonaldsonMatrix { excitation_nm: excitation, emission_nm: emission, columns, entries: entries.into() };
    checked(Reradiation { reflectance, fluorescence: Fluorescence::Matrix(matrix) }, site, arg)
}
