//! Bsdfs of microfacets and lobes, panes and flat optical elements.

use arsc_ir::{Bsdf, Distribution, Facets};

use super::materials::{MATERIAL, bsdf};
use super::{Builtin, Param};
use crate::types::SpectrumKind::{Extinction, Reflectance, RefractiveIndex};
use crate::types::Type::{self, Angle, Float, Spectrum};
use crate::value::Value;

pub fn builtins() -> Vec<Builtin> {
    let mut list = rough();
    list.extend(sheets());
    list
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
        .param(Param::new("roughness", Float, "alpha: width of the facets' slopes").float(0.1).within(0.0, 1.0))
        .param(
            Param::new("across", Float, "alpha across the direction of growing u; else as along it")
                .optional()
                .within(0.0, 1.0),
        )
        .param(
            Param::new("distribution", Type::Distribution, "of the facets' normals: `ggx`, `beckmann` or `blinn`")
                .default_value("ggx", Value::Distribution(Distribution::Ggx)),
        )
        .param(
            Param::new("beta", Angle, "in place of `roughness`: where Blinn's density has fallen to one half")
                .optional()
                .degrees_between(0.0, 60.0),
        )
}

/// The narrowest lobe, radians.
const MIN_BETA: f64 = 1e-4;

/// From the parameters of [`with_facets`]. ln(1/2) / ln(cos beta) is Blinn's exponent n; alpha is the root of 2 / (n + 2),
/// which makes narrow lobes of all three distributions alike.
fn facets(args: &[Value]) -> Facets {
    let roughness = if args[3].is_given() {
        let exponent = 0.5f64.ln() / args[3].as_float().max(MIN_BETA).cos().ln();
        (2.0 / (exponent + 2.0)).sqrt()
    } else {
        args[0].as_float()
    };
    let across = if args[1].is_given() { args[1].as_float() } else { roughness };
    Facets { distribution: args[2].as_distribution(), alpha: [roughness, across] }
}

fn rough() -> Vec<Builtin> {
    let conductor = of("rough_conductor", "Rough metal of complex refractive index eta + i k (Torrance and Sparrow).")
        .param(Param::new("eta", Spectrum(RefractiveIndex), "real part"))
        .param(Param::new("k", Spectrum(Extinction), "imaginary part"));
    let dielectric = of("rough_dielectric", "Rough glass: this index inside, vacuum outside (Walter and others 2007).");
    let phong = of("phong", "A glossy lobe about the mirrored direction (Lafortune and Willems 1994).")
        .param(Param::new("reflectance", Spectrum(Reflectance), "share of light that is scattered back"))
        .param(Param::new("exponent", Float, "of the cosine").float(50.0).within(0.0, 1e7));
    vec![
        with_facets(conductor).runs(Type::Bsdf, |m, args, site| {
            m.require_positive(&args[0], "a refractive index", site, 0)?;
            let (eta, k) = (args[0].as_spectrum().as_ref().clone(), args[1].as_spectrum().as_ref().clone());
            bsdf(m, Bsdf::RoughConductor { eta, k, facets: facets(&args[2..]) })
        }),
        with_facets(dielectric.param(index())).runs(Type::Bsdf, |m, args, site| {
            m.require_positive(&args[0], "a refractive index", site, 0)?;
            let ior = args[0].as_spectrum().as_ref().clone();
            bsdf(m, Bsdf::RoughDielectric { ior, facets: facets(&args[1..]) })
        }),
        phong.runs(Type::Bsdf, |m, args, site| {
            m.lint_reflectance(&args[0], site, 0);
            let reflectance = args[0].as_spectrum().as_ref().clone();
            bsdf(m, Bsdf::Phong { reflectance, exponent: args[1].as_float() })
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
