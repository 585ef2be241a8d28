//! Spectra in samples: pairs, regular lists, columns of files.

use std::sync::Arc;

use arsc_diagnostics::codes::sema as codes;
use arsc_ir::Spectrum;

use super::super::{Builtin, Param};
use super::kind;
use crate::code::Site;
use crate::eval::{Eval, Machine};
use crate::types::SpectrumKind::{self, Coefficient, Emission, Extinction, Reflectance, RefractiveIndex, Transmission};
use crate::types::Type::{self, Float, Str, Wavelength};
use crate::value::Value;

pub fn builtins() -> Vec<Builtin> {
    vec![
        tabulated("tabulated_reflectance", "A reflectance from a file.")
            .runs(kind(Reflectance), |m, args, site| from_file(m, args, site, Reflectance)),
        tabulated("tabulated_transmission", "A transmission from a file.")
            .runs(kind(Transmission), |m, args, site| from_file(m, args, site, Transmission)),
        tabulated("tabulated_emission", "An emission from a file.")
            .runs(kind(Emission), |m, args, site| from_file(m, args, site, Emission)),
        tabulated("tabulated_index", "A refractive index from a file.")
            .runs(kind(RefractiveIndex), |m, args, site| from_file(m, args, site, RefractiveIndex)),
        tabulated("tabulated_extinction", "An extinction from a file.")
            .runs(kind(Extinction), |m, args, site| from_file(m, args, site, Extinction)),
        tabulated("tabulated_coefficient", "A coefficient of a medium from a file.")
            .runs(kind(Coefficient), |m, args, site| from_file(m, args, site, Coefficient)),
        pairs("reflectance", "A reflectance from pairs such as `(550nm, 0.4)`, linear between them.")
            .runs(kind(Reflectance), |m, args, site| from_pairs(m, args, site, Reflectance)),
        pairs("transmission", "A transmission from pairs such as `(550nm, 0.4)`, linear between them.")
            .runs(kind(Transmission), |m, args, site| from_pairs(m, args, site, Transmission)),
        pairs("emission", "An emission from pairs such as `(550nm, 0.4)`, linear between them.")
            .runs(kind(Emission), |m, args, site| from_pairs(m, args, site, Emission)),
        pairs("refractive_index", "A refractive index from pairs such as `(550nm, 1.5)`, linear between them.")
            .runs(kind(RefractiveIndex), |m, args, site| from_pairs(m, args, site, RefractiveIndex)),
        pairs("extinction", "An extinction from pairs such as `(550nm, 2.1)`, linear between them.")
            .runs(kind(Extinction), |m, args, site| from_pairs(m, args, site, Extinction)),
        pairs("coefficient", "Absorption or scattering per metre from pairs such as `(550nm, 0.1)`.")
            .runs(kind(Coefficient), |m, args, site| from_pairs(m, args, site, Coefficient)),
        Builtin::new(
            "regular",
            "Pairs for a spectrum in regular samples: `reflectance(regular(400nm, 10nm, [0.1, 0.2]))`.",
        )
        .param(Param::new("start", Wavelength, "of the first sample").positive())
        .param(Param::new("step", Wavelength, "from one sample to the next").positive())
        .param(Param::new("values", Type::list(Float), "the samples"))
        .runs(Type::list(pair()), regular),
    ]
}

fn pair() -> Type {
    Type::tuple([Wavelength, Float])
}

fn pairs(name: &'static str, doc: &'static str) -> Builtin {
    Builtin::new(name, doc).param(Param::new("samples", Type::list(pair()), "pairs, wavelengths increasing"))
}

fn tabulated(name: &'static str, doc: &'static str) -> Builtin {
    Builtin::new(name, doc)
        .param(Param::new(
            "path",
            Str,
            "file, relative to the module: CSV or SPD (a wavelength in nm, then values, in each line; `#` comments), or \
             YAML as of refractiveindex.info",
        ))
        .param(Param::new("column", Str, "heading of the column; `n` or `k` of a YAML file; the first if not given").optional())
}

fn regular(m: &mut Machine<'_>, args: &[Value], site: &Site) -> Eval {
    let (start, step, values) = (args[0].as_float(), args[1].as_float(), args[2].as_list());
    m.spend_elements(values.len(), site.span)?;
    let pair = |(i, value): (usize, &Value)| {
        Value::Tuple([Value::Float(start + step * i as f64), Value::Float(value.as_float())].into())
    };
    Ok(Value::list(values.iter().enumerate().map(pair).collect()))
}

fn from_file(m: &mut Machine<'_>, args: &[Value], site: &Site, kind: SpectrumKind) -> Eval {
    let table = m.table(args[0].as_str(), site)?;
    let column = if args[1].is_given() {
        let wanted = args[1].as_str();
        table.columns.iter().position(|(name, _)| **name == **wanted).ok_or_else(|| {
            let known: Vec<&str> = table.columns.iter().map(|(name, _)| name.as_str()).collect();
            let mut failure =
                *site.fail_arg(1, codes::TABLE, format!("the table has no column `{wanted}`"), "named here");
            let near = arsc_diagnostics::closest(wanted, known.iter().copied());
            failure.help = near.map(|near| format!("did you mean `{near}`?")).or_else(|| match known[..] {
                [] => None,
                _ if known.len() <= 8 => Some(format!("there is {}", known.join(", "))),
                _ => None,
            });
            failure
        })?
    } else {
        // A file of n and k has its k second.
        let k = table.columns.iter().position(|(name, _)| name == "k").filter(|_| kind == Extinction);
        k.unwrap_or(0)
    };
    let spectrum = table.columns[column].1.clone();
    if let Spectrum::Tabulated { lambda_nm, values } = &spectrum {
        check_knots(m, lambda_nm, site)?;
        check_values(values, kind, site)?;
    }
    let value = Value::spectrum(spectrum);
    if kind == RefractiveIndex {
        m.require_positive(&value, "the refractive index", site, 0)?;
    }
    Ok(value)
}

fn from_pairs(m: &mut Machine<'_>, args: &[Value], site: &Site, kind: SpectrumKind) -> Eval {
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
        let what = Type::Spectrum(kind).with_article().replace('`', "").replace('_', " ");
        let bound = if kind == RefractiveIndex { "be positive" } else { "not be negative" };
        let message = format!("{what} must {bound}, but one value is {lowest}");
        return Err(site.fail_arg(0, codes::OUT_OF_RANGE, message, "these samples"));
    }
    Ok(())
}
