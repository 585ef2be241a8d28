//! Spectra in closed form.

use arsc_ir::Spectrum;
use arsc_spectral::{DAYLIGHT_KELVIN, daylight, normalised};

use super::super::{Builtin, Param};
use super::kind;
use crate::code::Site;
use crate::eval::{Eval, Machine};
use crate::types::SpectrumKind::{Coefficient, Emission, Reflectance, RefractiveIndex, Transmission};
use crate::types::Type::{self, Float, Temperature, Wavelength};
use crate::value::Value;
use arsc_diagnostics::codes::sema as codes;

pub fn builtins() -> Vec<Builtin> {
    let mut list = vec![
        Builtin::new("constant_reflectance", "The same at every wavelength.")
            .param(Param::new("value", Float, "reflectance").non_negative())
            .runs(kind(Reflectance), constant),
        Builtin::new("constant_transmission", "The same at every wavelength.")
            .param(Param::new("value", Float, "transmission").within(0.0, 1.0))
            .runs(kind(Transmission), constant),
        Builtin::new("constant_emission", "The same at every wavelength.")
            .param(Param::new("value", Float, "per nanometre").non_negative())
            .runs(kind(Emission), constant),
        bell("gaussian_reflectance").runs(kind(Reflectance), gaussian),
        bell("gaussian_transmission").runs(kind(Transmission), gaussian),
        bell("gaussian_emission").runs(kind(Emission), gaussian),
        bell("gaussian_coefficient").runs(kind(Coefficient), gaussian),
    ];
    list.extend(sources());
    list.extend(indices());
    list.push(
        Builtin::new(
            "coefficient_of",
            "The coefficient of absorption of a medium that transmits this much over a thickness.",
        )
        .param(Param::new("transmission", kind(Transmission), "of the thickness, without its surfaces"))
        .param(Param::new("thickness", Float, "metres").positive())
        .runs(kind(Coefficient), |_, args, _| {
            let (transmission, thickness) = (args[0].as_spectrum().clone(), args[1].as_float());
            Ok(Value::spectrum(Spectrum::Absorbance { transmission, thickness }))
        }),
    );
    list
}

fn constant(_: &mut Machine<'_>, args: &[Value], _: &Site) -> Eval {
    Ok(Value::spectrum(Spectrum::Constant(args[0].as_float())))
}

fn bell(name: &'static str) -> Builtin {
    Builtin::new(name, "A bell curve about a wavelength.")
        .param(Param::new("center", Wavelength, "wavelength of the peak").positive())
        .param(Param::new("width", Wavelength, "standard deviation").positive())
        .param(Param::new("peak", Float, "value at the peak").float(1.0).non_negative())
}

fn gaussian(_: &mut Machine<'_>, args: &[Value], _: &Site) -> Eval {
    let (center_nm, sigma_nm) = (args[0].as_float(), args[1].as_float());
    Ok(Value::spectrum(Spectrum::Gaussian { center_nm, sigma_nm, peak: args[2].as_float() }))
}

fn sources() -> Vec<Builtin> {
    let temperature = |doc| Param::new("temperature", Temperature, doc);
    vec![
        Builtin::new("blackbody", "Planck's law: radiance in W m^-2 sr^-1 nm^-1.")
            .param(temperature("of the body").positive())
            .runs(kind(Emission), |_, args, _| Ok(Value::spectrum(Spectrum::Blackbody { kelvin: args[0].as_float() }))),
        Builtin::new("incandescent", "The colour of a black body, as bright as `equal_energy`.")
            .param(temperature("of the body").within(1000.0, 1e6))
            .runs(kind(Emission), |_, args, _| {
                Ok(Value::spectrum(normalised(Spectrum::Blackbody { kelvin: args[0].as_float() })))
            }),
        Builtin::new("daylight", "The CIE's daylight, as bright as `equal_energy`; D65 is that of 6504 K.")
            .param(temperature("correlated colour temperature").within(DAYLIGHT_KELVIN[0], DAYLIGHT_KELVIN[1]))
            .runs(kind(Emission), |_, args, _| Ok(Value::spectrum(daylight(args[0].as_float())))),
    ]
}

fn indices() -> Vec<Builtin> {
    let list = |name, doc| Param::new(name, Type::list(Float), doc);
    vec![
        Builtin::new("sellmeier", "n² = a + Σ b L² / (L² - c), L in micrometres.")
            .param(list("b", "strengths"))
            .param(list("c", "squares of resonances, square micrometres; as many"))
            .param(Param::new("a", Float, "without resonances").float(1.0))
            .runs(kind(RefractiveIndex), |m, args, site| {
                let of = |i: usize| args[i].as_list().iter().map(Value::as_float).collect::<Vec<f64>>();
                let (b, c_um2) = (of(0), of(1));
                if b.len() != c_um2.len() {
                    let message = format!("{} strengths for {} resonances", b.len(), c_um2.len());
                    return Err(site.fail_arg(1, codes::OUT_OF_RANGE, message, "as many as `b` are needed"));
                }
                let a = args[2].as_float();
                let value = Value::spectrum(Spectrum::Sellmeier { a, b: b.into(), c_um2: c_um2.into() });
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
