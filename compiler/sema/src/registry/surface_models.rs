//! Bsdfs of microfacets and lobes, panes and flat optical elements.

use std::sync::Arc;

use arsc_diagnostics::Diagnostic;
use arsc_diagnostics::codes::sema as codes;
use arsc_ir::{Bsdf, Distribution, Expression, Facets, Parameter};
use arsc_texture::{Binary, Unary};

use super::materials::{MATERIAL, bsdf, varying_reflectance};
use super::mixtures::with_parameters;
use super::{Builtin, Param};
use crate::code::Site;
use crate::eval::{Eval, Machine, is_varying};
use crate::types::SpectrumKind::{Coefficient, Extinction, Reflectance, RefractiveIndex};
use crate::types::TextureKind;
use crate::types::Type::{self, Angle, Float, Spectrum, Texture};
use crate::value::Value;

pub fn builtins() -> Vec<Builtin> {
    let mut list = rough();
    list.extend(sheets());
    list.push(layered());
    list.push(measured());
    list
}

fn measured() -> Builtin {
    of("measured", "Isotropic reflection as it was measured (Matusik and others 2003).")
        .param(Param::new("path", Type::Str, "`.binary` file of the MERL form, relative to the script"))
        .runs(Type::Bsdf, |m, args, site| {
            let (path, brdf) = m.measured_brdf(args[0].as_str(), site)?;
            bsdf(m, Bsdf::Measured { path, brdf })
        })
}

fn layered() -> Builtin {
    let absorption = Param::new("absorption", Spectrum(Coefficient), "of the film between the two, per metre");
    of("layered", "A clear coat over an opaque base, with an absorbing film between the two.")
        .param(Param::new("coat", Type::Bsdf, "`dielectric` or `rough_dielectric`"))
        .param(Param::new(
            "base",
            Type::Bsdf,
            "`lambert`, `oren_nayar`, `phong`, `mirror`, `conductor` or `rough_conductor`",
        ))
        .param(absorption.default_value("0", Value::spectrum(arsc_ir::Spectrum::Constant(0.0))))
        .param(Param::new("thickness", Float, "of the film, metres").float(0.0).non_negative())
        .runs(Type::Bsdf, |m, args, site| {
            m.require_non_negative(&args[2], "an absorption coefficient", site, 2)?;
            let part = |m: &Machine<'_>, i: usize| {
                args[i].as_attributes().bsdf.and_then(|id| m.bsdfs.get(id as usize).cloned())
            };
            let Some(coat) = part(m, 0).filter(Bsdf::is_coat) else {
                let help = "use `dielectric(…)` or `rough_dielectric(…)`";
                return Err(unsuited(site, 0, "this bsdf cannot be a coat").help(help).into());
            };
            let Some(base) = part(m, 1).filter(Bsdf::is_base) else {
                let help = "use a plain opaque bsdf, such as `lambert(…)` or `conductor(…)`";
                return Err(unsuited(site, 1, "this bsdf cannot lie under a coat").help(help).into());
            };
            let (absorption, thickness) = (args[2].as_spectrum().as_ref().clone(), args[3].as_float());
            bsdf(m, Bsdf::Layered { coat: Arc::new(coat), base: Arc::new(base), absorption, thickness })
        })
}

fn unsuited(site: &Site, arg: usize, message: &str) -> Diagnostic {
    *site.fail_arg(arg, codes::OUT_OF_RANGE, message, "not of a kind that can be layered here")
}

fn of(name: &'static str, doc: &'static str) -> Builtin {
    Builtin::new(name, doc).module(MATERIAL)
}

fn index() -> Param {
    Param::new("ior", Spectrum(RefractiveIndex), "refractive index")
        .default_value("1.5", Value::spectrum(arsc_ir::Spectrum::Constant(1.5)))
}

fn share(name: &'static str, doc: &'static str) -> Param {
    Param::new(name, Spectrum(Reflectance), doc).default_value("1", Value::spectrum(arsc_ir::Spectrum::Constant(1.0)))
}

/// How rough a surface of microfacets is.
fn with_facets(builtin: Builtin) -> Builtin {
    builtin
        .param(
            Param::new("roughness", Texture(TextureKind::Float), "alpha: width of the facets' slopes")
                .float(0.1)
                .within(0.0, 1.0),
        )
        .param(
            Param::new(
                "across",
                Texture(TextureKind::Float),
                "alpha across the direction of growing u; else as along it",
            )
            .optional()
            .within(0.0, 1.0),
        )
        .param(
            Param::new("distribution", Type::Distribution, "of the facets' normals: `ggx`, `beckmann` or `blinn`")
                .default_value("ggx", Value::Distribution(Distribution::Ggx)),
        )
        .param(
            Param::new(
                "beta",
                Texture(TextureKind::Angle),
                "in place of `roughness`: where Blinn's density has fallen to one half",
            )
            .optional()
            .degrees_between(0.0, 60.0),
        )
}

/// The narrowest lobe, radians.
const MIN_BETA: f64 = 1e-4;

/// From the parameters of [`with_facets`]. ln(1/2) / ln(cos beta) is Blinn's exponent n; alpha is the root of 2 / (n + 2),
/// which makes narrow lobes of all three distributions alike.
fn facets(m: &mut Machine<'_>, args: &[Value], parameters: &mut Vec<Parameter>, site: &Site) -> Eval<Facets> {
    let distribution = args[2].as_distribution();
    if [0, 1, 3].into_iter().any(|i| is_varying(&args[i])) {
        parameters.push(Parameter::Roughness(varying_alpha(m, args, site)?));
        return Ok(Facets { distribution, alpha: [0.1; 2] });
    }
    let roughness = if args[3].is_given() {
        let exponent = 0.5f64.ln() / args[3].as_float().max(MIN_BETA).cos().ln();
        (2.0 / (exponent + 2.0)).sqrt()
    } else {
        args[0].as_float()
    };
    let across = if args[1].is_given() { args[1].as_float() } else { roughness };
    Ok(Facets { distribution, alpha: [roughness, across] })
}

/// The same, step by step.
fn varying_alpha(m: &mut Machine<'_>, args: &[Value], site: &Site) -> Eval<[Expression; 2]> {
    let roughness = if args[3].is_given() {
        let beta = m.texture_map2(Binary::Max, &args[3], &Value::Float(MIN_BETA));
        let cos = m.texture_map(Unary::Cos, &beta);
        let ln = m.texture_map(Unary::Ln, &cos);
        let exponent = m.texture_map2(Binary::Divide, &Value::Float(0.5f64.ln()), &ln);
        let sum = m.texture_map2(Binary::Add, &exponent, &Value::Float(2.0));
        let square = m.texture_map2(Binary::Divide, &Value::Float(2.0), &sum);
        m.texture_map(Unary::Sqrt, &square)
    } else {
        args[0].clone()
    };
    let across = if args[1].is_given() { args[1].clone() } else { roughness.clone() };
    let (along, across) = (m.scalar(&roughness), m.scalar(&across));
    Ok([m.expression(along, site.span)?, m.expression(across, site.span)?])
}

fn rough() -> Vec<Builtin> {
    let conductor = of("rough_conductor", "Rough metal of complex refractive index eta + i k (Torrance and Sparrow).")
        .param(Param::new("eta", Spectrum(RefractiveIndex), "real part"))
        .param(Param::new("k", Spectrum(Extinction), "imaginary part"));
    let dielectric = of("rough_dielectric", "Rough glass: this index inside, vacuum outside (Walter and others 2007).");
    let phong = of("phong", "A glossy lobe about the mirrored direction (Lafortune and Willems 1994).")
        .param(Param::new("reflectance", varying_reflectance(), "share of light that is scattered back"))
        .param(Param::new("exponent", Texture(TextureKind::Float), "of the cosine").float(50.0).within(0.0, 1e7));
    vec![
        with_facets(conductor).runs(Type::Bsdf, |m, args, site| {
            m.require_positive(&args[0], "a refractive index", site, 0)?;
            let (eta, k) = (args[0].as_spectrum().as_ref().clone(), args[1].as_spectrum().as_ref().clone());
            let mut parameters = Vec::new();
            let facets = facets(m, &args[2..], &mut parameters, site)?;
            with_parameters(m, Bsdf::RoughConductor { eta, k, facets }, parameters)
        }),
        with_facets(dielectric.param(index())).runs(Type::Bsdf, |m, args, site| {
            m.require_positive(&args[0], "a refractive index", site, 0)?;
            let ior = args[0].as_spectrum().as_ref().clone();
            let mut parameters = Vec::new();
            let facets = facets(m, &args[1..], &mut parameters, site)?;
            with_parameters(m, Bsdf::RoughDielectric { ior, facets }, parameters)
        }),
        phong.runs(Type::Bsdf, |m, args, site| {
            let mut parameters = Vec::new();
            let reflectance = m.reflectance_parameter(&args[0], &mut parameters, site, 0)?;
            let exponent = m.number_parameter(&args[1], 1.0, Parameter::Exponent, &mut parameters, site.args[1])?;
            with_parameters(m, Bsdf::Phong { reflectance, exponent }, parameters)
        }),
    ]
}

/// For open surfaces.
fn sheets() -> Vec<Builtin> {
    let angle = |doc| Param::new("angle", Angle, doc).degrees(0.0);
    vec![
        of("thin_dielectric", "A thin pane of clear glass, for open surfaces: nothing is bent.").param(index()).runs(
            Type::Bsdf,
            |m, args, site| {
                m.require_positive(&args[0], "a refractive index", site, 0)?;
                bsdf(m, Bsdf::ThinDielectric { ior: args[0].as_spectrum().as_ref().clone() })
            },
        ),
        of("polariser", "A linear polariser, for open surfaces: lets the field along its axis through.")
            .param(angle("of the axis, from the direction of growing u"))
            .param(share("transmittance", "of light along the axis"))
            .runs(Type::Bsdf, |m, args, site| {
                m.lint_reflectance(&args[1], site, 1);
                let transmittance = args[1].as_spectrum().as_ref().clone();
                bsdf(m, Bsdf::Polariser { transmittance, angle: args[0].as_float() })
            }),
        of("retarder", "A wave plate, for open surfaces: delays the field across its fast axis.")
            .param(Param::new("retardance", Angle, "delay in the phase, at every wavelength").degrees(90.0))
            .param(angle("of the fast axis, from the direction of growing u"))
            .runs(Type::Bsdf, |m, args, _| {
                bsdf(m, Bsdf::Retarder { retardance: args[0].as_float(), angle: args[1].as_float() })
            }),
        of("depolariser", "A sheet from which light comes unpolarised, for open surfaces.")
            .param(share("transmittance", "share of light that passes"))
            .runs(Type::Bsdf, |m, args, site| {
                m.lint_reflectance(&args[0], site, 0);
                bsdf(m, Bsdf::Depolariser { transmittance: args[0].as_spectrum().as_ref().clone() })
            }),
    ]
}
