//! Materials of the IR → the renderer's, indexed alike.

use arsc_ir::Ir;
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
        arsc_ir::Bsdf::Inert => return Err(AssemblyError::Settings("media are not rendered yet".into())),
    })
}
