//! Spectra, by kind.

use std::sync::Arc;

use arsc_diagnostics::codes::sema as codes;
use arsc_ir::Spectrum;

use super::{Builtin, Param};
use crate::code::Site;
use crate::eval::{Eval, Machine};
use crate::types::SpectrumKind::{self, Coefficient, Emission, Extinction, Reflectance, RefractiveIndex};
use crate::types::Type::{self, Float, Str, Temperature, Wavelength};
use crate::value::Value;

pub fn builtins() -> Vec<Builtin> {
    let mut list = reflectances();
    list.extend(emissions());
    list.extend(indices());
    list.extend(tables());
    list
}

fn kind(kind: SpectrumKind) -> Type {
    Type::Spectrum(kind)
}

fn reflectances() -> Vec<Builtin> {
    let component = |name| Param::new(name, Float, "linear sRGB component").within(0.0, 1.0);
    vec![
        Builtin::new("rgb", "A smooth reflectance with this linear sRGB colour under D65 (Jakob and Hanika 2019).")
            .param(component("r"))
            .param(component("g"))
            .param(component("b"))
            .runs(kind(Reflectance), |_, args, _| {
                let rgb = std::array::from_fn(|i| args[i].as_float());
                Ok(Value::spectrum(Spectrum::Sigmoid { coefficients: arsc_spectral::uplift_rgb(rgb) }))
            }),
        Builtin::new("constant_reflectance", "The same at every wavelength.")
            .param(Param::new("value", Float, "reflectance").non_negative())
            .runs(kind(Reflectance), |_, args, _| Ok(Value::spectrum(Spectrum::Constant(args[0].as_float())))),
    ]
}

fn emissions() -> Vec<Builtin> {
    vec![
        Builtin::new("constant_emission", "The same at every wavelength.")
            .param(Param::new("value", Float, "per nanometre").non_negative())
            .runs(kind(Emission), |_, args, _| Ok(Value::spectrum(Spectrum::Constant(args[0].as_float())))),
        Builtin::new("blackbody", "Planck's law: radiance in W m^-2 sr^-1 nm^-1.")
            .param(Param::new("temperature", Temperature, "of the body").positive())
            .runs(kind(Emission), |_, args, _| Ok(Value::spectrum(Spectrum::Blackbody { kelvin: args[0].as_float() }))),
        Builtin::new("gaussian_emission", "A bell curve about a wavelength.")
            .param(Param::new("center", Wavelength, "wavelength of the peak").positive())
            .param(Param::new("width", Wavelength, "standard deviation").positive())
            .param(Param::new("peak", Float, "value at the peak").float(1.0).non_negative())
            .runs(kind(Emission), |_, args, _| {
                let (center_nm, sigma_nm) = (args[0].as_float(), args[1].as_float());
                Ok(Value::spectrum(Spectrum::Gaussian { center_nm, sigma_nm, peak: args[2].as_float() }))
            }),
    ]
}

fn indices() -> Vec<Builtin> {
    let triple = |name, doc| Param::new(name, Type::tuple([Float, Float, Float]), doc);
    vec![
        Builtin::new("sellmeier", "n² = 1 + Σ b L² / (L² - c), L in micrometres.")
            .param(triple("b", "strengths"))
            .param(triple("c", "squares of resonances, square micrometres").non_negative())
            .runs(kind(RefractiveIndex), |m, args, site| {
                let of = |i: usize| std::array::from_fn(|j| args[i].as_tuple()[j].as_float());
                let value = Value::spectrum(Spectrum::Sellmeier { b: of(0), c_um2: of(1) });
                m.require_positive(&value, "the refractive index", site, 0)?;
                Ok(value)
            }),
        Builtin::new("cauchy", "n = a + b / L² + c / L⁴, L in micrometres.")
            .param(Param::new("a", Float, "index for long waves"))
            .param(Param::new("b", Float, "square micrometres").float(0.0))
            .param(Param::new("c", Float, "micrometres to the fourth").float(0.0))
            .runs(kind(RefractiveIndex), |m, args, site| {
                let (a, b_um2, c_um4) = (args[0].as_float(), args[1].as_float(), args[2].as_float());
                let value = Value::spectrum(Spectrum::Cauchy { a, b_um2, c_um4 });
                m.require_positive(&value, "the refractive index", site, 0)?;
                Ok(value)
            }),
    ]
}

fn tables() -> Vec<Builtin> {
    let from_file = |name, doc| {
        Builtin::new(name, doc)
            .param(Param::new("path", Str, "CSV file, relative to the module: `lambda_nm`, then columns; `#` comments"))
            .param(Param::new("column", Str, "heading of the column; the second one if not given").optional())
    };
    let samples = |name, doc| {
        let pair = Type::tuple([Wavelength, Float]);
        Builtin::new(name, doc).param(Param::new("samples", Type::list(pair), "pairs, wavelengths increasing"))
    };
    vec![
        from_file("tabulated_reflectance", "A reflectance from a table, linear between its rows.")
            .runs(kind(Reflectance), |m, args, site| from_table(m, args, site, Reflectance)),
        from_file("tabulated_emission", "An emission from a table, linear between its rows.")
            .runs(kind(Emission), |m, args, site| from_table(m, args, site, Emission)),
        from_file("tabulated_index", "A refractive index from a table, linear between its rows.")
            .runs(kind(RefractiveIndex), |m, args, site| from_table(m, args, site, RefractiveIndex)),
        from_file("tabulated_extinction", "An extinction from a table, linear between its rows.")
            .runs(kind(Extinction), |m, args, site| from_table(m, args, site, Extinction)),
        from_file("tabulated_coefficient", "A coefficient of a medium from a table, linear between its rows.")
            .runs(kind(Coefficient), |m, args, site| from_table(m, args, site, Coefficient)),
        samples("reflectance", "A reflectance from pairs such as `(550nm, 0.4)`, linear between them.")
            .runs(kind(Reflectance), |m, args, site| from_samples(m, args, site, Reflectance)),
        samples("emission", "An emission from pairs such as `(550nm, 0.4)`, linear between them.")
            .runs(kind(Emission), |m, args, site| from_samples(m, args, site, Emission)),
        samples("refractive_index", "A refractive index from pairs such as `(550nm, 1.5)`, linear between them.")
            .runs(kind(RefractiveIndex), |m, args, site| from_samples(m, args, site, RefractiveIndex)),
        samples("extinction", "An extinction from pairs such as `(550nm, 2.1)`, linear between them.")
            .runs(kind(Extinction), |m, args, site| from_samples(m, args, site, Extinction)),
        samples("coefficient", "Absorption or scattering per metre from pairs such as `(550nm, 0.1)`.")
            .runs(kind(Coefficient), |m, args, site| from_samples(m, args, site, Coefficient)),
    ]
}

fn from_table(m: &mut Machine<'_>, args: &[Value], site: &Site, kind: SpectrumKind) -> Eval {
    let path = args[0].as_str();
    let table = m.table(path, site)?;
    let column = if args[1].is_given() {
        let wanted = args[1].as_str();
        table.columns.iter().position(|name| **name == **wanted).ok_or_else(|| {
            let known: Vec<&str> = table.columns.iter().map(String::as_str).collect();
            let mut failure =
                *site.fail_arg(1, codes::TABLE, format!("the table has no column `{wanted}`"), "named here");
            failure.help = arsc_diagnostics::closest(wanted, known).map(|near| format!("did you mean `{near}`?"));
            failure
        })?
    } else {
        0
    };
    check_knots(m, &table.lambda_nm, site)?;
    let values = table.values[column].clone();
    check_values(&values, kind, site)?;
    Ok(Value::spectrum(Spectrum::Tabulated { lambda_nm: table.lambda_nm.clone(), values }))
}

fn from_samples(m: &mut Machine<'_>, args: &[Value], site: &Site, kind: SpectrumKind) -> Eval {
    let list = args[0].as_list();
    let column = |i: usize| -> Arc<[f64]> { list.iter().map(|pair| pair.as_tuple()[i].as_float()).collect() };
    let (lambda_nm, values) = (column(0), column(1));
    check_knots(m, &lambda_nm, site)?;
    check_values(&values, kind, site)?;
    Ok(Value::spectrum(Spectrum::Tabulated { lambda_nm, values }))
}

fn check_knots(m: &mut Machine<'_>, lambda_nm: &[f64], site: &Site) -> Eval<()> {
    if lambda_nm.is_empty() {
        return Err(site.fail_arg(0, codes::EMPTY_LIST, "a spectrum needs at least one sample", "there is none"));
    }
    if let Some(pair) = lambda_nm.windows(2).find(|pair| pair[0] >= pair[1]) {
        let message = format!("wavelengths must increase, but {}nm follows {}nm", pair[1], pair[0]);
        return Err(site.fail_arg(0, codes::TABLE, message, "these samples"));
    }
    m.lint_wavelengths(lambda_nm, site, 0);
    Ok(())
}

fn check_values(values: &[f64], kind: SpectrumKind, site: &Site) -> Eval<()> {
    let lowest = values.iter().copied().fold(f64::INFINITY, f64::min);
    let too_low = if kind == RefractiveIndex { lowest <= 0.0 } else { lowest < 0.0 };
    if too_low {
        let message = format!("a spectrum of this kind must not be negative, but one value is {lowest}");
        return Err(site.fail_arg(0, codes::OUT_OF_RANGE, message, "these samples"));
    }
    Ok(())
}
