//! Bsdfs with other parameters, for one path: where something varies over a surface.
//!
//! The result holds its spectra at the path's wavelengths alone and owns no memory.

use arsc_spectral::{DenseSpectrum, SampledSpectrum, SampledWavelengths};

use super::{Bsdf, Lambert, Mirror, Phong, RoughConductor, RoughDielectric};

/// Values in place of a bsdf's own; those that it does not have are of no effect.
#[derive(Clone, Copy, Debug, Default)]
pub struct BsdfParameters {
    /// Within [0, 1].
    pub reflectance: Option<SampledSpectrum>,
    pub sigma: Option<f64>,
    pub exponent: Option<f64>,
    pub alpha: Option<[f64; 2]>,
}

impl Bsdf {
    /// The bsdf at these wavelengths with these parameters.
    pub fn with_parameters(&self, parameters: &BsdfParameters, wavelengths: &SampledWavelengths) -> Bsdf {
        let fixed = |spectrum: &DenseSpectrum| DenseSpectrum::Sampled(spectrum.sample(wavelengths));
        let reflectance =
            |own: &DenseSpectrum| parameters.reflectance.map_or_else(|| fixed(own), DenseSpectrum::Sampled);
        match self {
            Bsdf::Lambert(own) => Bsdf::Lambert(Lambert { reflectance: reflectance(&own.reflectance) }),
            Bsdf::Mirror(own) => Bsdf::Mirror(Mirror { reflectance: reflectance(&own.reflectance) }),
            Bsdf::OrenNayar(own) => {
                Bsdf::OrenNayar(own.with_parameters(reflectance(&own.reflectance), parameters.sigma))
            }
            Bsdf::Phong(own) => Bsdf::Phong(Phong {
                reflectance: reflectance(&own.reflectance),
                exponent: parameters.exponent.map_or(own.exponent, Phong::limited),
            }),
            Bsdf::RoughConductor(own) => Bsdf::RoughConductor(RoughConductor {
                eta: fixed(&own.eta),
                k: fixed(&own.k),
                facets: own.facets.with_alpha(parameters.alpha),
            }),
            Bsdf::RoughDielectric(own) => Bsdf::RoughDielectric(RoughDielectric {
                ior: fixed(&own.ior),
                facets: own.facets.with_alpha(parameters.alpha),
            }),
            other => other.clone(),
        }
    }
}
