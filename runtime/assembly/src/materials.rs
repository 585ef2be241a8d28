//! Materials of the IR → the renderer's, indexed alike.

use arsc_ir::Ir;
use arsc_render::bsdf::{MicrofacetShape, Microfacets};
use arsc_render::{AreaEmitter, Bsdf, Material};

use crate::AssemblyError;

/// One renderer's material for each of [`Ir::materials`].
pub fn lower(ir: &Ir) -> Result<Vec<Material>, AssemblyError> {
    let lower_one = |material: &arsc_ir::Material| {
        let bsdf = match material.bsdf {
            Some(index) => lower_bsdf(entry(&ir.bsdfs, index)?)?,
            None => Bsdf::default(),
        };
        let emitter = match material.emitter {
            Some(index) => {
                let emitter = entry(&ir.emitters, index)?;
                Some(AreaEmitter::new(&emitter.radiance, emitter.two_sided))
            }
            None => None,
        };
        Ok(Material { bsdf, emitter })
    };
    ir.materials.iter().map(lower_one).collect()
}

fn entry<T>(table: &[T], index: u32) -> Result<&T, AssemblyError> {
    table.get(index as usize).ok_or(AssemblyError::NotNormal("an attribute is out of range"))
}

fn lower_bsdf(bsdf: &arsc_ir::Bsdf) -> Result<Bsdf, AssemblyError> {
    Ok(match bsdf {
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
        arsc_ir::Bsdf::Inert => return Err(AssemblyError::Settings("media are not rendered yet".into())),
    })
}

fn lower_facets(facets: &arsc_ir::Facets) -> Microfacets {
    let shape = match facets.distribution {
        arsc_ir::Distribution::Ggx => MicrofacetShape::Ggx,
        arsc_ir::Distribution::Beckmann => MicrofacetShape::Beckmann,
        arsc_ir::Distribution::Blinn => MicrofacetShape::Blinn,
    };
    Microfacets::new(shape, facets.alpha)
}
