//! Emission of surfaces: Lambertian, or in proportion to what they absorb.

use arsc_spectral::{DenseSpectrum, SampledSpectrum, SampledWavelengths, Spectrum, WavelengthRange};
use glam::DVec3;

use crate::absorptance::Absorptance;
use crate::bsdf::Bsdf;
use crate::polarisation::{Polarisation, Stokes, s_axis};

/// Emission towards the side of the geometric normal, or from both.
#[derive(Clone, Debug)]
pub struct AreaEmitter {
    radiance: DenseSpectrum,
    two_sided: bool,
    /// Radiance is multiplied by it, and polarised; without, it is the same in all directions.
    absorptance: Option<Absorptance>,
}

impl AreaEmitter {
    /// Lambertian emission. `radiance` in W m^-2 sr^-1 nm^-1, negative values count as zero. `two_sided` is for open
    /// surfaces: a solid emits outwards.
    pub fn new(radiance: &Spectrum, two_sided: bool) -> AreaEmitter {
        let radiance = DenseSpectrum::new(radiance).clamped(0.0, f32::MAX);
        AreaEmitter { radiance, two_sided, absorptance: None }
    }

    /// Emission of a surface with this bsdf, whose surroundings in equilibrium would have this radiance: Kirchhoff's law.
    pub fn thermal(radiance: &Spectrum, two_sided: bool, bsdf: &Bsdf) -> AreaEmitter {
        AreaEmitter { absorptance: Some(Absorptance::new(bsdf)), ..AreaEmitter::new(radiance, two_sided) }
    }

    /// Radiance towards the direction `wo` from a surface with the geometric normal `ng`.
    #[inline]
    pub fn radiance<P: Polarisation>(&self, wo: DVec3, ng: DVec3, wavelengths: &SampledWavelengths) -> P::Stokes {
        let cos = wo.dot(ng);
        if cos == 0.0 || (cos < 0.0 && !self.two_sided) {
            return P::Stokes::unpolarised(SampledSpectrum::ZERO);
        }
        let radiance = self.radiance.sample(wavelengths);
        let Some(absorptance) = &self.absorptance else { return P::Stokes::unpolarised(radiance) };
        let [mean, excess] = absorptance.at(cos.abs(), wavelengths);
        P::Stokes::linear(radiance * mean, radiance * excess, s_axis(ng, wo), wo)
    }

    pub fn two_sided(&self) -> bool {
        self.two_sided
    }

    /// Power per area over a range of wavelengths, W m^-2; for thermal emission with the emissivity of a few angles and
    /// wavelengths.
    pub fn exitance(&self, range: &WavelengthRange) -> f64 {
        let sides = if self.two_sided { 2.0 } else { 1.0 };
        let emissivity = self.absorptance.as_ref().map_or(1.0, |absorptance| {
            let w = SampledWavelengths::fixed([450.0, 550.0, 650.0, 750.0]);
            let weights = self.radiance.sample(&w);
            let at = |cos: f64| {
                f64::from((absorptance.at(cos, &w)[0] * weights).mean() / weights.mean().max(f32::MIN_POSITIVE))
            };
            // Midpoints in cos^2, which is uniform in power.
            (at(0.35) + at(0.61) + at(0.79) + at(0.94)) / 4.0
        });
        std::f64::consts::PI * sides * emissivity * self.radiance.integral(range)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bsdf::{MicrofacetShape, Microfacets};
    use crate::polarisation::{Polarised, Unpolarised};

    fn constant(value: f64) -> Spectrum {
        Spectrum::Constant(value)
    }

    /// Emission and reflection of a smooth metal fill the whole, for s and for p; the rest is p-polarised.
    #[test]
    fn smooth_metal_emits_what_it_does_not_reflect() {
        let metal = Bsdf::conductor(&constant(2.0), &constant(3.0));
        let emitter = AreaEmitter::thermal(&constant(1.0), false, &metal);
        let w = SampledWavelengths::fixed([420.0, 530.0, 600.0, 700.0]);
        for cos in [0.05, 0.3, 0.8, 1.0f64] {
            let wo = DVec3::new((1.0 - cos * cos).sqrt(), 0.0, cos);
            let emitted = emitter.radiance::<Polarised>(wo, DVec3::Z, &w);
            let reflected = metal.sample::<Polarised>(wo, [0.5; 2], 0.5, &w).expect("a reflection").weight;
            let sum = |i: usize| emitted.s[i].hero() + reflected.m[i][0].hero();
            assert!((sum(0) - 1.0).abs() < 1e-6 && sum(1).abs() < 1e-6, "{emitted:?}");
            assert!(emitted.s[1].hero() <= 1e-6);
            let plain = emitter.radiance::<Unpolarised>(wo, DVec3::Z, &w);
            assert_eq!(plain, emitted.intensity());
        }
    }

    /// Grey paint emits the rest of its reflectance everywhere; glass nothing; metal that is nearly smooth as smooth metal.
    #[test]
    fn tables_agree_with_what_is_known() {
        use crate::polarisation::Stokes;
        let w = SampledWavelengths::fixed([420.0, 530.0, 600.0, 700.0]);
        let of = |bsdf: &Bsdf, cos: f64| {
            let wo = DVec3::new((1.0 - cos * cos).sqrt(), 0.0, cos);
            let light = AreaEmitter::thermal(&constant(1.0), false, bsdf).radiance::<Polarised>(wo, DVec3::Z, &w);
            [light.intensity().hero(), light.s[1].hero()]
        };
        let (eta, k) = (constant(2.0), constant(3.0));
        let almost = Bsdf::rough_conductor(&eta, &k, Microfacets::new(MicrofacetShape::Ggx, [0.005; 2]));
        for cos in [0.3, 0.6, 0.95] {
            let [paint, _] = of(&Bsdf::lambert(&constant(0.3)), cos);
            assert!((paint - 0.7).abs() < 1e-5, "{paint}");
            assert_eq!(of(&Bsdf::dielectric(&constant(1.5)), cos), [0.0, 0.0]);
            let (smooth, rough) = (of(&Bsdf::conductor(&eta, &k), cos), of(&almost, cos));
            assert!((0..2).all(|i| (smooth[i] - rough[i]).abs() < 5e-3), "{cos}: {smooth:?}, {rough:?}");
        }
    }
}
