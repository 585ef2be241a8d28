//! Participating media: coefficients, phase functions, densities, and what they make together.

use std::sync::Arc;

use arsc_diagnostics::codes::sema as codes;
use arsc_ir::{Attributes, Density, Environment, Medium, NodeKind, PhaseFunction, Spectrum};
use arsc_spectral::{TABLE_MAX_NM, TABLE_MIN_NM};

use super::{Builtin, Param};
use crate::eval::Eval;
use crate::types::SpectrumKind::{Coefficient, Emission, Extinction, Reflectance};
use crate::types::Type::{self, Float, Int, Point};
use crate::value::Value;

const MODULE: &str = "std.medium";

pub fn builtins() -> Vec<Builtin> {
    let mut list = media();
    list.extend(coefficients());
    list.extend(phase_functions());
    list.extend(densities());
    list
}

fn of(name: &'static str, doc: &'static str) -> Builtin {
    Builtin::new(name, doc).module(MODULE)
}

fn media() -> Vec<Builtin> {
    let zero = || Value::spectrum(Spectrum::Constant(0.0));
    let coefficient = |name, doc| Param::new(name, Type::Spectrum(Coefficient), doc).default_value("0", zero());
    vec![
        of("medium", "What absorbs, scatters and glows within a solid: `shape |> with(medium(…))`.")
            .param(coefficient("absorption", "absorption coefficient at density 1, per metre"))
            .param(coefficient("scattering", "scattering coefficient at density 1, per metre"))
            .param(
                Param::new("phase", Type::PhaseFunction, "directions of scattered light")
                    .default_value("isotropic()", Value::PhaseFunction(PhaseFunction::Isotropic)),
            )
            .param(
                Param::new("density", Type::Density, "factor on the coefficients, by place")
                    .default_value("uniform()", Value::Density(Arc::new(Density::Uniform))),
            )
            .param(
                Param::new("emission", Type::Spectrum(Emission), "radiance of an absorbing layer of great depth")
                    .default_value("constant_emission(0)", zero()),
            )
            .param(
                Param::new("dyes", Type::list(Type::Dye), "fluorescent substances in it")
                    .default_value("[]", Value::list(Vec::new())),
            )
            .runs(Type::Medium, |m, args, site| {
                for (i, what) in [(0, "the absorption coefficient"), (1, "the scattering coefficient")] {
                    m.require_non_negative(&args[i], what, site, i)?;
                }
                let spectrum = |i: usize| args[i].as_spectrum().as_ref().clone();
                let medium = m.medium(Medium {
                    absorption: spectrum(0),
                    scattering: spectrum(1),
                    emission: spectrum(4),
                    dyes: args[5].as_list().iter().map(|dye| dye.as_dye().as_ref().clone()).collect(),
                    phase: args[2].as_phase_function(),
                    density: args[3].as_density().as_ref().clone(),
                });
                Ok(Value::Attributes(Attributes { medium: Some(medium), ..Attributes::default() }))
            }),
        of("atmosphere", "Fills all space that no solid fills. Of several the first counts.")
            .param(Param::new("medium", Type::Medium, "what fills it"))
            .runs(Type::Environment, |m, args, site| {
                let medium = args[0].as_attributes().medium.unwrap_or_default();
                m.node(NodeKind::Environment(Box::new(Environment::Medium { medium })), site.span).map(Value::Node)
            }),
    ]
}

fn coefficients() -> Vec<Builtin> {
    let coefficient = Type::Spectrum(Coefficient);
    vec![
        of("absorption_colour", "The absorption that leaves this share of light after a distance.")
            .param(Param::new("transmittance", Type::Spectrum(Reflectance), "share that is left"))
            .param(Param::new("distance", Float, "metres that light has gone then").float(1.0).positive())
            .runs(coefficient.clone(), |_, args, site| {
                let (transmittance, distance) = (args[0].as_spectrum().clone(), args[1].as_float());
                let absorption = |lambda_nm| (-transmittance.eval(lambda_nm).ln() / distance).max(0.0);
                let lowest = wavelengths().map(|lambda_nm| transmittance.eval(lambda_nm)).fold(f64::INFINITY, f64::min);
                if lowest <= 0.0 {
                    let message = "the transmittance must be positive from 360nm to 830nm";
                    return Err(site.fail_arg(0, codes::OUT_OF_RANGE, message, "not positive everywhere"));
                }
                Ok(tabulated(absorption))
            }),
        of("absorption_of", "The absorption of matter with this imaginary part of the index: 4 pi k / wavelength.")
            .param(Param::new("k", Type::Spectrum(Extinction), "imaginary part of the index of refraction"))
            .runs(coefficient, |_, args, _| {
                let k = args[0].as_spectrum().clone();
                Ok(tabulated(|lambda_nm| 4.0 * std::f64::consts::PI * k.eval(lambda_nm).max(0.0) / (lambda_nm * 1e-9)))
            }),
    ]
}

/// The knots of tables.
fn wavelengths() -> impl Iterator<Item = f64> {
    (TABLE_MIN_NM as u32..=TABLE_MAX_NM as u32).map(f64::from)
}

/// A function of wavelength as a table with a knot every nanometre that can be rendered.
fn tabulated(value_at: impl Fn(f64) -> f64) -> Value {
    let lambda_nm: Arc<[f64]> = wavelengths().collect();
    let values = lambda_nm.iter().map(|&lambda_nm| value_at(lambda_nm)).collect();
    Value::spectrum(Spectrum::Tabulated { lambda_nm, values })
}

fn phase(phase: PhaseFunction) -> Eval {
    Ok(Value::PhaseFunction(phase))
}

fn phase_functions() -> Vec<Builtin> {
    vec![
        of("isotropic", "Scatters equally into all directions.")
            .runs(Type::PhaseFunction, |_, _, _| phase(PhaseFunction::Isotropic)),
        of("henyey_greenstein", "Scatters forwards or backwards (Henyey and Greenstein 1941).")
            .param(Param::new("g", Float, "mean cosine: 0 isotropic, positive forwards").within(-0.999, 0.999))
            .runs(Type::PhaseFunction, |_, args, _| phase(PhaseFunction::HenyeyGreenstein { g: args[0].as_float() })),
        of("rayleigh", "Scattering by particles much smaller than the wavelength.")
            .param(
                Param::new("depolarisation", Float, "of light scattered at a right angle; air: 0.03")
                    .float(0.0)
                    .within(0.0, 0.5),
            )
            .runs(Type::PhaseFunction, |_, args, _| {
                phase(PhaseFunction::Rayleigh { depolarisation: args[0].as_float() })
            }),
    ]
}

fn density(density: Density) -> Eval {
    Ok(Value::Density(Arc::new(density)))
}

fn densities() -> Vec<Builtin> {
    vec![
        of("uniform", "The same everywhere.").runs(Type::Density, |_, _, _| density(Density::Uniform)),
        of("gaussian_density", "A ball that fades out: exp(-distance² / (2 sigma²)). Positions are the scene's.")
            .param(
                Param::new("center", Point, "where it is densest")
                    .default_value("(0, 0, 0)", Value::Vec3(glam::DVec3::ZERO)),
            )
            .param(Param::new("sigma", Float, "standard deviation, metres").float(1.0).positive())
            .runs(Type::Density, |_, args, _| {
                density(Density::Gaussian { center: args[0].as_vec3(), sigma: args[1].as_float() })
            }),
        of("exponential_density", "Falls off with height: 1 up to `ground`, above it exp(-(z - ground) / height).")
            .param(Param::new("height", Float, "in which it falls to 1/e, metres").positive())
            .param(Param::new("ground", Float, "level below which it is 1").float(0.0))
            .runs(Type::Density, |_, args, _| {
                density(Density::Exponential { height: args[0].as_float(), ground: args[1].as_float() })
            }),
        of("grid_density", "Samples on a grid from a file of single-precision numbers, low byte first, x fastest.")
            .param(Param::new("path", Type::Str, "raw file, relative to the script"))
            .param(Param::new("resolution", Type::tuple([Int, Int, Int]), "cells along x, y and z").positive())
            .param(Param::new("min", Point, "lowest corner of the box"))
            .param(Param::new("max", Point, "highest corner"))
            .later(Type::Density, "the density on a grid"),
    ]
}
