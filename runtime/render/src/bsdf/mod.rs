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
mod fluorescent;
mod lambert;
mod layered;
mod measured;
mod microfacets;
mod mirror;
mod oren_nayar;
mod parameters;
mod phong;
mod rough_conductor;
mod rough_dielectric;
mod sheet;
mod thin_dielectric;

use std::sync::Arc;

use arsc_spectral::{DenseSpectrum, MerlBrdf, Reradiation, SampledSpectrum, SampledWavelengths, Spectrum};
use glam::DVec3;

use crate::polarisation::{DiattenuatingRetarder, Mueller, Polarisation, s_axis};

pub use conductor::Conductor;
pub use dielectric::Dielectric;
pub use fluorescent::{Fluorescent, FluorescentEvent};
pub use lambert::Lambert;
pub use layered::Layered;
pub use measured::Measured;
pub use microfacets::{MicrofacetShape, Microfacets};
pub use mirror::Mirror;
pub use oren_nayar::OrenNayar;
pub use parameters::BsdfParameters;
pub use phong::Phong;
pub use rough_conductor::RoughConductor;
pub use rough_dielectric::RoughDielectric;
pub use sheet::Sheet;
pub use thin_dielectric::ThinDielectric;

/// A scattering model, tabulated for rendering.
#[derive(Clone, Debug)]
pub enum Bsdf {
    Lambert(Lambert),
    OrenNayar(OrenNayar),
    Mirror(Mirror),
    Dielectric(Dielectric),
    Conductor(Conductor),
    ThinDielectric(ThinDielectric),
    Phong(Phong),
    RoughConductor(RoughConductor),
    RoughDielectric(RoughDielectric),
    Sheet(Sheet),
    /// Diffuse; as a bsdf what keeps its wavelength, see [`Bsdf::fluorescent`] for the rest.
    Fluorescent(Box<Fluorescent>),
    Layered(Box<Layered>),
    Measured(Box<Measured>),
    /// No interface: light goes straight on.
    Inert,
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

    /// A thin pane of clear glass: nothing is bent.
    pub fn thin_dielectric(ior: &Spectrum) -> Bsdf {
        Bsdf::ThinDielectric(ThinDielectric::new(ior))
    }

    /// A glossy lobe cos^n about the mirrored direction; `exponent` is limited to [0, 1e7].
    pub fn phong(reflectance: &Spectrum, exponent: f64) -> Bsdf {
        Bsdf::Phong(Phong::new(reflectance, exponent))
    }

    /// A rough metal of index `eta` + i `k`.
    pub fn rough_conductor(eta: &Spectrum, k: &Spectrum, facets: Microfacets) -> Bsdf {
        Bsdf::RoughConductor(RoughConductor::new(eta, k, facets))
    }

    /// A rough interface between vacuum outside and a transparent medium of index `ior` inside.
    pub fn rough_dielectric(ior: &Spectrum, facets: Microfacets) -> Bsdf {
        Bsdf::RoughDielectric(RoughDielectric::new(ior, facets))
    }

    /// A coat over a base, with an absorbing film between: `upper` a smooth or rough dielectric, `lower` Lambert, Oren–Nayar, Phong, mirror or
    /// metal; `depth` is the film's absorption coefficient times its thickness. `None` for other parts.
    pub fn layered(upper: &Bsdf, lower: &Bsdf, depth: &Spectrum) -> Option<Bsdf> {
        Layered::new(upper, lower, depth).map(|layered| Bsdf::Layered(Box::new(layered)))
    }

    /// Measured reflection.
    pub fn measured(brdf: Arc<MerlBrdf>) -> Bsdf {
        Bsdf::Measured(Box::new(Measured::new(brdf)))
    }

    /// A sheet that lets the field along its axis through, `transmittance` of its power. The axis stands at `angle`, radians,
    /// from the direction of growing u, towards that of the normal crossed with it.
    pub fn polariser(transmittance: &Spectrum, angle: f64) -> Bsdf {
        Bsdf::Sheet(Sheet::polariser(transmittance, angle))
    }

    /// A sheet that delays the field across its fast axis, at `angle`, by `retardance` radians at every wavelength.
    pub fn retarder(retardance: f64, angle: f64) -> Bsdf {
        Bsdf::Sheet(Sheet::retarder(retardance, angle))
    }

    /// A sheet from which light comes unpolarised.
    pub fn depolariser(transmittance: &Spectrum) -> Bsdf {
        Bsdf::Sheet(Sheet::depolariser(transmittance))
    }

    /// Diffuse reflection and re-radiation; `sigma` as for [`Bsdf::oren_nayar`], 0 for Lambert's law.
    pub fn reradiating(reradiation: &Reradiation, sigma: f64) -> Bsdf {
        Bsdf::Fluorescent(Box::new(Fluorescent::new(reradiation, sigma)))
    }

    /// What changes the wavelength of light.
    #[inline]
    pub fn fluorescent(&self) -> Option<&Fluorescent> {
        match self {
            Bsdf::Fluorescent(fluorescent) => Some(fluorescent),
            _ => None,
        }
    }

    /// Every lobe is a Dirac distribution: light sampling is of no use.
    #[inline]
    pub fn is_specular(&self) -> bool {
        match self {
            Bsdf::Lambert(_)
            | Bsdf::OrenNayar(_)
            | Bsdf::Phong(_)
            | Bsdf::RoughConductor(_)
            | Bsdf::RoughDielectric(_)
            | Bsdf::Fluorescent(_) => false,
            Bsdf::Measured(_) => false,
            Bsdf::Layered(layered) => layered.is_specular(),
            Bsdf::Mirror(_)
            | Bsdf::Dielectric(_)
            | Bsdf::Conductor(_)
            | Bsdf::ThinDielectric(_)
            | Bsdf::Sheet(_)
            | Bsdf::Inert => true,
        }
    }

    /// The x axis of the local frame matters: it must be the direction of growing u.
    #[inline]
    pub fn needs_tangent(&self) -> bool {
        match self {
            Bsdf::RoughConductor(rough) => rough.facets.is_anisotropic(),
            Bsdf::RoughDielectric(rough) => rough.facets.is_anisotropic(),
            Bsdf::Sheet(sheet) => sheet.has_axis(),
            Bsdf::Layered(layered) => layered.needs_tangent(),
            _ => false,
        }
    }

    /// The value f(wo, wi) in sr^-1 without the cosine; zero for specular lobes.
    #[inline]
    pub fn eval<P: Polarisation>(&self, wo: DVec3, wi: DVec3, wavelengths: &SampledWavelengths) -> P::Mueller {
        self.eval_between::<P>(None, wo, wi, wavelengths)
    }

    /// Density per steradian with which [`Bsdf::sample`] gives `wi`, were each of the wavelengths the hero; zero for
    /// specular lobes.
    #[inline]
    pub fn pdf(&self, wo: DVec3, wi: DVec3, wavelengths: &SampledWavelengths) -> SampledSpectrum {
        self.pdf_between(None, wo, wi, wavelengths)
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
        self.sample_between(None, wo, u, u_lobe, wavelengths)
    }

    /// As [`Bsdf::eval`]; `relative` is the index behind the wall over the one before it, `None` for a solid in vacuum.
    #[inline]
    pub fn eval_between<P: Polarisation>(
        &self,
        relative: Option<SampledSpectrum>,
        wo: DVec3,
        wi: DVec3,
        wavelengths: &SampledWavelengths,
    ) -> P::Mueller {
        let depolarised = match self {
            Bsdf::Fluorescent(both) => return both.elastic().eval::<P>(wo, wi, wavelengths),
            Bsdf::RoughConductor(rough) => return rough.eval::<P>(wo, wi, wavelengths),
            Bsdf::Layered(layered) => return layered.eval::<P>(wo, wi, wavelengths),
            Bsdf::RoughDielectric(rough) => return rough.eval::<P>(wo, wi, rough.ior(relative, wavelengths)),
            Bsdf::Lambert(lambert) => lambert.eval(wo, wi, wavelengths),
            Bsdf::OrenNayar(oren_nayar) => oren_nayar.eval(wo, wi, wavelengths),
            Bsdf::Phong(phong) => phong.eval(wo, wi, wavelengths),
            Bsdf::Measured(measured) => measured.eval(wo, wi, wavelengths),
            _ => SampledSpectrum::ZERO,
        };
        P::Mueller::depolariser(depolarised)
    }

    /// As [`Bsdf::pdf`], between two media.
    #[inline]
    pub fn pdf_between(
        &self,
        relative: Option<SampledSpectrum>,
        wo: DVec3,
        wi: DVec3,
        wavelengths: &SampledWavelengths,
    ) -> SampledSpectrum {
        let same = |pdf: f64| SampledSpectrum::splat(pdf as f32);
        match self {
            Bsdf::Lambert(_) | Bsdf::OrenNayar(_) | Bsdf::Fluorescent(_) => same(cosine_pdf(wo, wi)),
            Bsdf::Phong(phong) => same(phong.pdf(wo, wi)),
            Bsdf::RoughConductor(rough) => same(rough.pdf(wo, wi)),
            Bsdf::Layered(layered) => same(layered.pdf(wo, wi)),
            Bsdf::Measured(measured) => same(measured.pdf(wo, wi)),
            Bsdf::RoughDielectric(rough) => rough.pdf(wo, wi, rough.ior(relative, wavelengths)),
            _ => SampledSpectrum::ZERO,
        }
    }

    /// As [`Bsdf::sample`], between two media.
    #[inline]
    pub fn sample_between<P: Polarisation>(
        &self,
        relative: Option<SampledSpectrum>,
        wo: DVec3,
        u: [f64; 2],
        u_lobe: f64,
        wavelengths: &SampledWavelengths,
    ) -> Option<BsdfSample<P>> {
        match self {
            Bsdf::Lambert(lambert) => lambert.sample(wo, u, wavelengths),
            Bsdf::OrenNayar(oren_nayar) => oren_nayar.sample(wo, u, wavelengths),
            Bsdf::Mirror(mirror) => mirror.sample(wo, wavelengths),
            Bsdf::Dielectric(dielectric) => match relative {
                None => dielectric.sample(wo, u_lobe, wavelengths),
                Some(relative) => dielectric::sample(relative, wo, u_lobe),
            },
            Bsdf::Conductor(conductor) => conductor.sample(wo, wavelengths),
            Bsdf::ThinDielectric(pane) => pane.sample(wo, u_lobe, wavelengths),
            Bsdf::Phong(phong) => phong.sample(wo, u, wavelengths),
            Bsdf::RoughConductor(rough) => rough.sample(wo, u, wavelengths),
            Bsdf::RoughDielectric(rough) => rough.sample(wo, u, u_lobe, rough.ior(relative, wavelengths)),
            Bsdf::Sheet(sheet) => sheet.sample(wo, wavelengths),
            Bsdf::Fluorescent(both) => both.elastic().sample(wo, u, u_lobe, wavelengths),
            Bsdf::Layered(layered) => layered.sample(wo, u, u_lobe, wavelengths),
            Bsdf::Measured(measured) => measured.sample(wo, u, u_lobe, wavelengths),
            Bsdf::Inert => Some(BsdfSample::straight_on(wo)),
        }
    }

    /// Light passes through a closed wall of it, so that it matters what fills the solid.
    pub fn is_transmissive(&self) -> bool {
        matches!(self, Bsdf::ThinDielectric(_) | Bsdf::Sheet(_) | Bsdf::Inert) || self.index().is_some()
    }

    /// It does something to light.
    pub fn has_interface(&self) -> bool {
        !matches!(self, Bsdf::Inert)
    }

    /// Index of refraction of what a solid of it holds.
    #[inline]
    pub fn index(&self) -> Option<&DenseSpectrum> {
        match self {
            Bsdf::Dielectric(dielectric) => Some(dielectric.index()),
            Bsdf::RoughDielectric(rough) => Some(rough.index()),
            _ => None,
        }
    }
}

/// The default of a scene: grey, reflectance 1/2.
impl Default for Bsdf {
    fn default() -> Bsdf {
        Bsdf::lambert(&Spectrum::Constant(0.5))
    }
}

/// Index of a transparent medium, held to [0.01, 100]; a medium of index 1 is invisible.
fn index_of_glass(ior: &Spectrum) -> DenseSpectrum {
    limited_index(DenseSpectrum::new(ior))
}

fn limited_index(ior: DenseSpectrum) -> DenseSpectrum {
    ior.clamped(1e-2, 1e2)
}

/// Real and imaginary part of the index of a metal; the real part is large enough to keep Fresnel's equations away from 0/0.
fn index_of_metal(eta: &Spectrum, k: &Spectrum) -> [DenseSpectrum; 2] {
    [DenseSpectrum::new(eta).clamped(1e-3, 1e3), DenseSpectrum::new(k).clamped(0.0, 1e3)]
}

/// The same index over that of a transparent medium.
fn relative_to(index: f64, eta: &DenseSpectrum, k: &DenseSpectrum) -> [DenseSpectrum; 2] {
    [eta, k].map(|part| DenseSpectrum::from_fn(|lambda_nm| f64::from(part.at(lambda_nm)) / index))
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

    /// Light that goes on without being bent.
    #[inline]
    fn straight(wo: DVec3, weight: P::Mueller) -> BsdfSample<P> {
        BsdfSample { wi: -wo, weight, path_pdf: SampledSpectrum::ONE, pdf: 1.0, specular: true, eta: 1.0 }
    }

    /// No event at all.
    fn straight_on(wo: DVec3) -> BsdfSample<P> {
        let neutral = DiattenuatingRetarder::neutral(SampledSpectrum::ONE);
        let weight = P::Mueller::diattenuating_retarder(&neutral, s_axis(DVec3::Z, wo), wo, -wo);
        BsdfSample { wi: -wo, weight, path_pdf: SampledSpectrum::ONE, pdf: 1.0, specular: true, eta: 1.0 }
    }

    /// A direction drawn from a density per steradian that is the same at every wavelength; what it scatters is
    /// depolarised.
    #[inline]
    fn diffuse(wi: DVec3, weight: SampledSpectrum, pdf: f64) -> BsdfSample<P> {
        let weight = P::Mueller::depolariser(weight);
        BsdfSample { wi, weight, path_pdf: SampledSpectrum::ONE, pdf, specular: false, eta: 1.0 }
    }
}
