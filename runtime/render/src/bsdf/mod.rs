//! Scattering at surfaces.
//!
//! Local frame: z is the shading normal, on the outer side of the surface; `wo` (towards the viewer) and `wi` (towards
//! the light) are unit vectors that point away from the surface. Values are per wavelength; pdfs are per steradian of
//! `wi`, except that specular lobes state the probability with which they were chosen. Light is traced against its
//! direction: refraction includes the change of radiance by the square of the relative index.
//!
//! A model states what it does to light once, as a depolarising value or a [`DiattenuatingRetarder`]; whether Mueller
//! matrices come of it is up to the mode. Directions and densities never depend on polarisation.
//!
//! Diffuse lobes are two-sided: they reflect on the side where `wo` is. One file per model; the enum keeps the inner
//! loop free of indirect calls and allocation.

mod conductor;
mod dielectric;
mod lambert;
mod mirror;
mod oren_nayar;

use arsc_spectral::{SampledSpectrum, SampledWavelengths, Spectrum};
use glam::DVec3;

use crate::polarisation::{DiattenuatingRetarder, Mueller, Polarisation, s_axis};

pub use conductor::Conductor;
pub use dielectric::Dielectric;
pub use lambert::Lambert;
pub use mirror::Mirror;
pub use oren_nayar::OrenNayar;

/// A scattering model, tabulated for rendering.
#[derive(Clone, Debug)]
pub enum Bsdf {
    Lambert(Lambert),
    OrenNayar(OrenNayar),
    Mirror(Mirror),
    Dielectric(Dielectric),
    Conductor(Conductor),
}

/// A sampled direction.
#[derive(Clone, Copy, Debug)]
pub struct BsdfSample<P: Polarisation> {
    pub wi: DVec3,
    /// f |cos(wi)| / pdf, with the pdf of the hero wavelength.
    pub weight: P::Mueller,
    /// Probability of the sampled event at each wavelength over that at the hero. Zero where another wavelength
    /// would have gone elsewhere: the path goes on with those that remain.
    pub path_pdf: SampledSpectrum,
    /// Per steradian; 1 for specular lobes.
    pub pdf: f64,
    /// The lobe is a Dirac distribution: `eval` does not see it.
    pub specular: bool,
    /// For refraction, the index beyond the interface over the one before it, at the hero wavelength; otherwise 1.
    pub eta: f64,
}

impl Bsdf {
    /// Diffuse reflection; values outside of [0, 1] are limited to it.
    pub fn lambert(reflectance: &Spectrum) -> Bsdf {
        Bsdf::Lambert(Lambert::new(reflectance))
    }

    /// Rough diffuse reflection; `sigma` is the standard deviation of the facet slope angle in radians.
    pub fn oren_nayar(reflectance: &Spectrum, sigma: f64) -> Bsdf {
        Bsdf::OrenNayar(OrenNayar::new(reflectance, sigma))
    }

    /// Mirror reflection with the same reflectance at every angle, limited to [0, 1].
    pub fn mirror(reflectance: &Spectrum) -> Bsdf {
        Bsdf::Mirror(Mirror::new(reflectance))
    }

    /// A smooth interface between vacuum outside and a transparent medium of index `ior` inside.
    pub fn dielectric(ior: &Spectrum) -> Bsdf {
        Bsdf::Dielectric(Dielectric::new(ior))
    }

    /// A smooth metal of index `eta` + i `k`.
    pub fn conductor(eta: &Spectrum, k: &Spectrum) -> Bsdf {
        Bsdf::Conductor(Conductor::new(eta, k))
    }

    /// Every lobe is a Dirac distribution: light sampling is of no use.
    #[inline]
    pub fn is_specular(&self) -> bool {
        matches!(self, Bsdf::Mirror(_) | Bsdf::Dielectric(_) | Bsdf::Conductor(_))
    }

    /// The value f(wo, wi) in sr^-1 without the cosine; zero for specular lobes.
    #[inline]
    pub fn eval<P: Polarisation>(&self, wo: DVec3, wi: DVec3, wavelengths: &SampledWavelengths) -> P::Mueller {
        P::Mueller::depolariser(match self {
            Bsdf::Lambert(lambert) => lambert.eval(wo, wi, wavelengths),
            Bsdf::OrenNayar(oren_nayar) => oren_nayar.eval(wo, wi, wavelengths),
            Bsdf::Mirror(_) | Bsdf::Dielectric(_) | Bsdf::Conductor(_) => SampledSpectrum::ZERO,
        })
    }

    /// Density per steradian with which [`Bsdf::sample`] gives `wi`; zero for specular lobes.
    #[inline]
    pub fn pdf(&self, wo: DVec3, wi: DVec3) -> f64 {
        match self {
            Bsdf::Lambert(_) | Bsdf::OrenNayar(_) => cosine_pdf(wo, wi),
            Bsdf::Mirror(_) | Bsdf::Dielectric(_) | Bsdf::Conductor(_) => 0.0,
        }
    }

    /// A direction; `u` picks it within a lobe, `u_lobe` picks the lobe. `None` where nothing is scattered.
    #[inline]
    pub fn sample<P: Polarisation>(
        &self,
        wo: DVec3,
        u: [f64; 2],
        u_lobe: f64,
        wavelengths: &SampledWavelengths,
    ) -> Option<BsdfSample<P>> {
        match self {
            Bsdf::Lambert(lambert) => lambert.sample(wo, u, wavelengths),
            Bsdf::OrenNayar(oren_nayar) => oren_nayar.sample(wo, u, wavelengths),
            Bsdf::Mirror(mirror) => mirror.sample(wo, wavelengths),
            Bsdf::Dielectric(dielectric) => dielectric.sample(wo, u_lobe, wavelengths),
            Bsdf::Conductor(conductor) => conductor.sample(wo, wavelengths),
        }
    }
}

/// The default of a scene: grey, reflectance 1/2.
impl Default for Bsdf {
    fn default() -> Bsdf {
        Bsdf::lambert(&Spectrum::Constant(0.5))
    }
}

/// Density of cosine sampling on the side of `wo`.
#[inline]
fn cosine_pdf(wo: DVec3, wi: DVec3) -> f64 {
    if wo.z * wi.z > 0.0 { wi.z.abs() * std::f64::consts::FRAC_1_PI } else { 0.0 }
}

/// A cosine-distributed direction on the side of `wo`; `None` where either one grazes.
#[inline]
fn cosine_direction(wo: DVec3, u: [f64; 2]) -> Option<DVec3> {
    let mut wi = crate::warp::cosine_hemisphere(u);
    if wo.z == 0.0 || wi.z == 0.0 {
        return None;
    }
    if wo.z < 0.0 {
        wi.z = -wi.z;
    }
    Some(wi)
}

impl<P: Polarisation> BsdfSample<P> {
    /// Reflection by a smooth surface, the same event at every wavelength.
    #[inline]
    fn specular_reflection(wo: DVec3, effect: &DiattenuatingRetarder) -> BsdfSample<P> {
        let wi = DVec3::new(-wo.x, -wo.y, wo.z);
        let weight = P::Mueller::diattenuating_retarder(effect, s_axis(DVec3::Z, wo), wo, wi);
        BsdfSample { wi, weight, path_pdf: SampledSpectrum::ONE, pdf: 1.0, specular: true, eta: 1.0 }
    }

    /// A direction drawn from a density per steradian that is the same at every wavelength; what it scatters is
    /// depolarised.
    #[inline]
    fn diffuse(wi: DVec3, weight: SampledSpectrum, pdf: f64) -> BsdfSample<P> {
        let weight = P::Mueller::depolariser(weight);
        BsdfSample { wi, weight, path_pdf: SampledSpectrum::ONE, pdf, specular: false, eta: 1.0 }
    }
}
