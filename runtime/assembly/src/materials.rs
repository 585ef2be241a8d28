//! Materials of the IR → the renderer's, indexed alike.

use std::sync::Arc;

use arsc_ir::{Environment, Ir, NodeKind};
use arsc_render::bsdf::{MicrofacetShape, Microfacets};
use arsc_render::{
    AreaEmitter, Bsdf, ColorTexture, Density, Material, Media, Medium, Parameter, PhaseFunction, SpectrumTerm,
    VaryingBsdf, VaryingPart,
};
use arsc_spectral::{DenseSpectrum, Spectrum};

use crate::AssemblyError;
use crate::geometry::{members, node};

/// One renderer's material for each of [`Ir::materials`].
pub fn lower(ir: &Ir) -> Result<Vec<Material>, AssemblyError> {
    let lower_one = |material: &arsc_ir::Material| {
        let (bsdf, varying) = match material.bsdf.map(|index| entry(&ir.bsdfs, index)).transpose()? {
            Some(arsc_ir::Bsdf::Varying(varying)) => {
                let varying = lower_varying(varying)?;
                (varying.representative().clone(), Some(Box::new(varying)))
            }
            Some(bsdf) => (lower_bsdf(bsdf), None),
            None => (Bsdf::default(), None),
        };
        let emitter = match material.emitter {
            Some(index) => {
                let emitter = entry(&ir.emitters, index)?;
                Some(if emitter.thermal {
                    AreaEmitter::thermal(&emitter.radiance, emitter.two_sided, &bsdf)
                } else {
                    AreaEmitter::new(&emitter.radiance, emitter.two_sided)
                })
            }
            None => None,
        };
        let inside = match material.inside {
            Some(index) => lower_bsdf(entry(&ir.bsdfs, index)?).index().cloned(),
            None => None,
        };
        if let Some(medium) = material.medium {
            entry(&ir.media, medium)?;
        }
        Ok(Material { bsdf, emitter, medium: material.medium, inside, varying })
    };
    ir.materials.iter().map(lower_one).collect()
}

fn entry<T>(table: &[T], index: u32) -> Result<&T, AssemblyError> {
    table.get(index as usize).ok_or(AssemblyError::NotNormal("an attribute is out of range"))
}

fn lower_bsdf(bsdf: &arsc_ir::Bsdf) -> Bsdf {
    match bsdf {
        arsc_ir::Bsdf::Lambert { reflectance } => Bsdf::lambert(reflectance),
        arsc_ir::Bsdf::OrenNayar { reflectance, sigma } => Bsdf::oren_nayar(reflectance, *sigma),
        arsc_ir::Bsdf::Mirror { reflectance } => Bsdf::mirror(reflectance),
        arsc_ir::Bsdf::Dielectric { ior } => Bsdf::dielectric(ior),
        arsc_ir::Bsdf::Conductor { eta, k } => Bsdf::conductor(eta, k),
        arsc_ir::Bsdf::ThinDielectric { ior } => Bsdf::thin_dielectric(ior),
        arsc_ir::Bsdf::Phong { reflectance, exponent } => Bsdf::phong(reflectance, *exponent),
        arsc_ir::Bsdf::RoughConductor { eta, k, facets } => Bsdf::rough_conductor(eta, k, lower_facets(facets)),
        arsc_ir::Bsdf::RoughDielectric { ior, facets } => Bsdf::rough_dielectric(ior, lower_facets(facets)),
        arsc_ir::Bsdf::Polariser { transmittance, angle } => Bsdf::polariser(transmittance, *angle),
        arsc_ir::Bsdf::Retarder { retardance, angle } => Bsdf::retarder(*retardance, *angle),
        arsc_ir::Bsdf::Depolariser { transmittance } => Bsdf::depolariser(transmittance),
        arsc_ir::Bsdf::Fluorescent { reradiation, sigma } => Bsdf::reradiating(reradiation, *sigma),
        arsc_ir::Bsdf::Inert => Bsdf::Inert,
        arsc_ir::Bsdf::Measured { brdf, .. } => Bsdf::measured(brdf.clone()),
        arsc_ir::Bsdf::Layered { coat, base, absorption, thickness } => {
            let (coat, base) = (lower_bsdf(coat), lower_bsdf(base));
            let depth = Spectrum::Scaled { factor: *thickness, spectrum: Arc::new(absorption.clone()) };
            // The verifier has seen to it that these parts fit.
            Bsdf::layered(&coat, &base, &depth).unwrap_or(base)
        }
        // Where a single bsdf is asked for, the first part answers; parts do not vary themselves.
        arsc_ir::Bsdf::Varying(varying) => {
            varying.parts.first().map_or_else(Bsdf::default, |part| lower_bsdf(&part.bsdf))
        }
    }
}

fn lower_varying(varying: &arsc_ir::Varying) -> Result<VaryingBsdf, AssemblyError> {
    let part = |part: &arsc_ir::Part| VaryingPart {
        weight: part.weight.clone(),
        bsdf: lower_bsdf(&part.bsdf),
        parameters: part.parameters.iter().map(lower_parameter).collect(),
    };
    let parts = varying.parts.iter().map(part).collect();
    VaryingBsdf::new(parts, varying.texture_from_object).ok_or(AssemblyError::NotNormal("a varying bsdf has no parts"))
}

fn lower_color(color: &arsc_ir::ColorTexture) -> ColorTexture {
    match color {
        arsc_ir::ColorTexture::Rgb(rgb) => ColorTexture::Rgb(rgb.clone()),
        arsc_ir::ColorTexture::Image { image, uv } => ColorTexture::Image { image: image.clone(), uv: uv.clone() },
    }
}

fn lower_parameter(parameter: &arsc_ir::Parameter) -> Parameter {
    match parameter {
        arsc_ir::Parameter::Reflectance(texture) => {
            let term = |term: &arsc_ir::SpectrumTerm| SpectrumTerm {
                weight: term.weight.clone(),
                spectrum: DenseSpectrum::new(&term.spectrum),
                color: term.color.as_ref().map(lower_color),
            };
            Parameter::Reflectance(texture.terms.iter().map(term).collect())
        }
        arsc_ir::Parameter::Sigma(sigma) => Parameter::Sigma(sigma.clone()),
        arsc_ir::Parameter::Exponent(exponent) => Parameter::Exponent(exponent.clone()),
        arsc_ir::Parameter::Roughness(alpha) => Parameter::Roughness(alpha.clone()),
        arsc_ir::Parameter::Height(height) => Parameter::Height(height.clone()),
        arsc_ir::Parameter::Normal(normal) => Parameter::Normal(normal.clone()),
    }
}

/// The media, and the one of the scene's space: that of the first member that says.
pub fn lower_media(ir: &Ir) -> Result<Media, AssemblyError> {
    let mut atmosphere = None;
    for &member in members(ir)? {
        if let NodeKind::Environment(environment) = &node(ir, member)?.kind
            && let Environment::Medium { medium } = **environment
        {
            entry(&ir.media, medium)?;
            atmosphere = atmosphere.or(Some(medium));
        }
    }
    Ok(Media { media: ir.media.iter().map(lower_medium).collect(), atmosphere })
}

fn lower_medium(medium: &arsc_ir::Medium) -> Medium {
    let phase = match medium.phase {
        arsc_ir::PhaseFunction::Isotropic => PhaseFunction::Isotropic,
        arsc_ir::PhaseFunction::HenyeyGreenstein { g } => PhaseFunction::HenyeyGreenstein { g },
        arsc_ir::PhaseFunction::Rayleigh { depolarisation } => PhaseFunction::Rayleigh { depolarisation },
    };
    let density = match medium.density {
        arsc_ir::Density::Uniform => Density::Uniform,
        arsc_ir::Density::Gaussian { center, sigma } => Density::Gaussian { center, sigma },
        arsc_ir::Density::Exponential { ground, height } => Density::Exponential { ground, height },
    };
    Medium::new(&medium.absorption, &medium.scattering, &medium.emission, phase, density).with_dyes(&medium.dyes)
}

fn lower_facets(facets: &arsc_ir::Facets) -> Microfacets {
    let shape = match facets.distribution {
        arsc_ir::Distribution::Ggx => MicrofacetShape::Ggx,
        arsc_ir::Distribution::Beckmann => MicrofacetShape::Beckmann,
        arsc_ir::Distribution::Blinn => MicrofacetShape::Blinn,
    };
    Microfacets::new(shape, facets.alpha)
}
