//! Equal values get one index: bsdfs, emitters, media and materials.

use std::hash::{Hash, Hasher};

use arsc_ir::{Bsdf, Density, Emitter, Facets, Material, Medium, PhaseFunction, Spectrum};
use rustc_hash::{FxHashMap, FxHasher};

/// A value whose floats are compared as numbers and hashed by their bits.
pub(crate) trait Structural: PartialEq {
    fn structural_hash(&self, hasher: &mut FxHasher);
}

/// A table without equal entries.
#[derive(Default)]
pub(crate) struct Interner<T> {
    pub values: Vec<T>,
    by_hash: FxHashMap<u64, Vec<u32>>,
}

impl<T: Structural> Interner<T> {
    pub fn new() -> Interner<T> {
        Interner { values: Vec::new(), by_hash: FxHashMap::default() }
    }

    pub fn intern(&mut self, value: T) -> u32 {
        let mut hasher = FxHasher::default();
        value.structural_hash(&mut hasher);
        let bucket = self.by_hash.entry(hasher.finish()).or_default();
        if let Some(&index) = bucket.iter().find(|&&index| self.values[index as usize] == value) {
            return index;
        }
        let index = self.values.len() as u32;
        bucket.push(index);
        self.values.push(value);
        index
    }
}

/// Adding zero makes -0 and 0, which compare equal, hash alike. The low bits of short numbers are zeros, and the hasher
/// multiplies, which carries nothing down to them: the high bits go there, too.
pub(crate) fn hash_f64(value: f64, hasher: &mut FxHasher) {
    let bits = (value + 0.0).to_bits();
    (bits ^ bits >> 32).hash(hasher);
}

fn hash_all(values: &[f64], hasher: &mut FxHasher) {
    values.len().hash(hasher);
    for &value in values {
        hash_f64(value, hasher);
    }
}

/// A few samples tell tables apart well enough; equality is checked on the whole.
fn hash_samples(values: &[f64], hasher: &mut FxHasher) {
    values.len().hash(hasher);
    for &value in values.iter().step_by(values.len() / 8 + 1) {
        hash_f64(value, hasher);
    }
}

impl Structural for Spectrum {
    fn structural_hash(&self, hasher: &mut FxHasher) {
        std::mem::discriminant(self).hash(hasher);
        match self {
            Spectrum::Constant(value) => hash_f64(*value, hasher),
            Spectrum::Tabulated { lambda_nm, values } => {
                hash_samples(lambda_nm, hasher);
                hash_samples(values, hasher);
            }
            Spectrum::Blackbody { kelvin } => hash_f64(*kelvin, hasher),
            Spectrum::Gaussian { center_nm, sigma_nm, peak } => hash_all(&[*center_nm, *sigma_nm, *peak], hasher),
            Spectrum::Sellmeier { a, b, c_um2 } => {
                hash_f64(*a, hasher);
                hash_all(b, hasher);
                hash_all(c_um2, hasher);
            }
            Spectrum::Cauchy { a, b_um2, c_um4 } => hash_all(&[*a, *b_um2, *c_um4], hasher),
            Spectrum::Sigmoid { coefficients } => hash_all(coefficients, hasher),
            // One level is enough: the rest is compared.
            Spectrum::Absorbance { thickness, .. } => hash_f64(*thickness, hasher),
            Spectrum::Scaled { factor, .. } => hash_f64(*factor, hasher),
            Spectrum::Product(..) | Spectrum::Sum(..) => {}
        }
    }
}

impl Structural for Bsdf {
    fn structural_hash(&self, hasher: &mut FxHasher) {
        std::mem::discriminant(self).hash(hasher);
        match self {
            Bsdf::Lambert { reflectance } | Bsdf::Mirror { reflectance } => reflectance.structural_hash(hasher),
            Bsdf::OrenNayar { reflectance, sigma } => {
                reflectance.structural_hash(hasher);
                hash_f64(*sigma, hasher);
            }
            Bsdf::Dielectric { ior } => ior.structural_hash(hasher),
            Bsdf::Conductor { eta, k } => {
                eta.structural_hash(hasher);
                k.structural_hash(hasher);
            }
            Bsdf::Inert => {}
            Bsdf::Measured { path, .. } => path.hash(hasher),
            Bsdf::ThinDielectric { ior } => ior.structural_hash(hasher),
            Bsdf::Phong { reflectance, exponent } => {
                reflectance.structural_hash(hasher);
                hash_f64(*exponent, hasher);
            }
            Bsdf::RoughConductor { eta, k, facets } => {
                eta.structural_hash(hasher);
                k.structural_hash(hasher);
                facets.structural_hash(hasher);
            }
            Bsdf::RoughDielectric { ior, facets } => {
                ior.structural_hash(hasher);
                facets.structural_hash(hasher);
            }
            Bsdf::Polariser { transmittance, angle } => {
                transmittance.structural_hash(hasher);
                hash_f64(*angle, hasher);
            }
            Bsdf::Retarder { retardance, angle } => hash_all(&[*retardance, *angle], hasher),
            Bsdf::Depolariser { transmittance } => transmittance.structural_hash(hasher),
            Bsdf::Layered { coat, base, absorption, thickness } => {
                coat.structural_hash(hasher);
                base.structural_hash(hasher);
                absorption.structural_hash(hasher);
                hash_f64(*thickness, hasher);
            }
            Bsdf::Varying(varying) => {
                varying.parts.iter().for_each(|part| part.bsdf.structural_hash(hasher));
                hash_all(&varying.texture_from_object.to_cols_array(), hasher);
            }
            Bsdf::Fluorescent { reradiation, sigma } => {
                reradiation.reflectance.structural_hash(hasher);
                hash_f64(*sigma, hasher);
            }
        }
    }
}

impl Structural for Facets {
    fn structural_hash(&self, hasher: &mut FxHasher) {
        self.distribution.hash(hasher);
        hash_all(&self.alpha, hasher);
    }
}

impl Structural for Emitter {
    fn structural_hash(&self, hasher: &mut FxHasher) {
        self.radiance.structural_hash(hasher);
        self.two_sided.hash(hasher);
        self.thermal.hash(hasher);
    }
}

impl Structural for Medium {
    fn structural_hash(&self, hasher: &mut FxHasher) {
        self.absorption.structural_hash(hasher);
        self.scattering.structural_hash(hasher);
        match self.phase {
            PhaseFunction::Isotropic => {}
            PhaseFunction::HenyeyGreenstein { g: x } | PhaseFunction::Rayleigh { depolarisation: x } => {
                hash_f64(x, hasher);
            }
        }
        match &self.density {
            Density::Uniform => {}
            Density::Gaussian { center, sigma } => hash_all(&[center.x, center.y, center.z, *sigma], hasher),
            Density::Exponential { ground, height } => hash_all(&[*ground, *height], hasher),
        }
    }
}

impl Structural for Material {
    fn structural_hash(&self, hasher: &mut FxHasher) {
        (self.bsdf, self.emitter, self.medium, self.inside, &self.faces).hash(hasher);
    }
}
