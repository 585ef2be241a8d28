//! A clear coat, smooth or rough, over an opaque base, with an absorbing film between the two.
//!
//! Both walls are flat in the mean and share their normal; the film has no lateral extent, so that only directions count
//! (Guo, Hasan and Zhao 2018, "Position-free Monte Carlo simulation for arbitrary layered BSDFs"). Light goes in through
//! the coat, is reflected by the base, and goes out or is thrown back by the coat from within, any number of times. A
//! stretch in the film leaves exp(-depth / cos) of it. The base meets the film, not vacuum: metals have their index over the film's.
//!
//! - Smooth over smooth: one mirrored direction, whose series has a closed sum, for s, p and the phase between.
//! - Smooth over Lambert: T T' / n^2 rho / pi / (1 - rho F) with F the mean of what the coat throws back of diffuse light, attenuated twice on its way: closed as well.
//! - The rest: `eval` follows one walk between the walls. At each reflection by the base it adds what goes out to `wi`, by
//!   the exit's own direction (smooth coats), or by the balance of two strategies, the exit drawn from outside and the reflection drawn by the base (rough ones). Its
//!   random numbers are a hash of the two directions: values are noisy around the true ones, and the same each time.
//!
//! Directions are drawn from lobes of known density, whatever the walk does: the coat's reflection; the base's as it looks
//! from outside (a cosine, or facets about as wide as all roughness together with a share of cosine). Weights are `eval` over that density.
//! Dispersion of the coat is left out: its index is that at 587.6 nm. In polarised light the matrices of the events multiply. Seen from behind it is the same.

use std::f64::consts::PI;

use arsc_spectral::{DenseSpectrum, SampledSpectrum, SampledWavelengths, Spectrum};
use glam::DVec3;

use super::rough_conductor::above;
use super::{Bsdf, BsdfSample, MicrofacetShape, Microfacets, RoughDielectric, cosine_direction, cosine_pdf};
use crate::frame::Frame;
use crate::fresnel::{self, Interface};
use crate::polarisation::{DiattenuatingRetarder, Mueller, Polarisation, s_axis};

/// Where the index of a coat is taken, nm.
const INDEX_NM: f64 = 587.6;

/// Reflections by the base that a walk makes at most; roulette ends nearly all of them long before.
const MOST_REFLECTIONS: u32 = 256;

/// Reflections before roulette sets in.
const SURE_REFLECTIONS: u32 = 3;

/// Share of the cosine among the directions drawn for a glossy base.
const COSINE_SHARE: f64 = 0.2;

#[derive(Clone, Debug)]
enum Coat {
    Smooth,
    Rough(Box<RoughDielectric>),
}

/// How directions are drawn for what comes back from the base.
#[derive(Clone, Debug)]
enum BaseLobe {
    Diffuse,
    /// Facets as seen from outside.
    Glossy(Box<Microfacets>),
    /// Both walls are smooth: there is one direction only.
    Mirrored,
}

#[derive(Clone, Debug)]
pub struct Layered {
    coat: Coat,
    index: f64,
    base: Box<Bsdf>,
    /// Absorption coefficient times thickness.
    depth: DenseSpectrum,
    lobe: BaseLobe,
    /// Over a Lambertian base: reflectance / (1 - reflectance F).
    diffuse: Option<DenseSpectrum>,
}

/// A walk's random numbers, from a hash of what it is for (Steele, Lea and Flood 2014, "Fast splittable pseudorandom number
/// generators").
struct Draws(u64);

impl Draws {
    fn new(wo: DVec3, wi: DVec3) -> Draws {
        let mut draws = Draws(0x9e37_79b9_7f4a_7c15);
        for x in [wo.x, wo.y, wo.z, wi.x, wi.y, wi.z] {
            draws.0 ^= x.to_bits();
            draws.next();
        }
        draws
    }

    /// Uniform in [0, 1).
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^= z >> 31;
        // The state takes part in what follows, so that hashing chains.
        self.0 ^= z.rotate_left(17);
        (z >> 11) as f64 / (1u64 << 53) as f64
    }

    fn pair(&mut self) -> [f64; 2] {
        [self.next(), self.next()]
    }
}

impl Layered {
    /// `upper` is a smooth or rough dielectric, `lower` reflects and lets nothing through; `depth` is the film's absorption
    /// coefficient times its thickness. `None` for other parts.
    pub(super) fn new(upper: &Bsdf, lower: &Bsdf, depth: &Spectrum) -> Option<Layered> {
        let (coat, index, coat_alpha) = match upper {
            Bsdf::Dielectric(smooth) => (Coat::Smooth, f64::from(smooth.index().at(INDEX_NM)), 0.0),
            Bsdf::RoughDielectric(rough) => {
                let index = f64::from(rough.index().at(INDEX_NM));
                (Coat::Rough(Box::new(rough.clone())), index, rough.facets.width())
            }
            _ => return None,
        };
        let base = match lower {
            Bsdf::Conductor(metal) => Bsdf::Conductor(metal.within(index)),
            Bsdf::RoughConductor(metal) => Bsdf::RoughConductor(metal.within(index)),
            Bsdf::Lambert(_) | Bsdf::OrenNayar(_) | Bsdf::Phong(_) | Bsdf::Mirror(_) => lower.clone(),
            _ => return None,
        };
        let depth = DenseSpectrum::new(depth).clamped(0.0, f32::MAX);
        let base_alpha = match &base {
            Bsdf::Lambert(_) | Bsdf::OrenNayar(_) => None,
            Bsdf::RoughConductor(metal) => Some(metal.facets.width()),
            Bsdf::Phong(phong) => Some(phong.width()),
            _ => Some(0.0),
        };
        let lobe = match (base_alpha, &coat) {
            (None, _) => BaseLobe::Diffuse,
            (Some(0.0), Coat::Smooth) => BaseLobe::Mirrored,
            (Some(alpha), _) => {
                // Slopes of the base look n times as steep; the coat bends by (n - 1) slopes, in and out.
                let bent = 0.5 * (index - 1.0) * coat_alpha;
                let seen = (index * index * alpha * alpha + 2.0 * bent * bent).sqrt();
                BaseLobe::Glossy(Box::new(Microfacets::new(MicrofacetShape::Ggx, [seen.max(0.01); 2])))
            }
        };
        let diffuse = match (&base, &coat) {
            (Bsdf::Lambert(lambert), Coat::Smooth) => Some(diffuse_gain(lambert.reflectance(), &depth, index)),
            _ => None,
        };
        Some(Layered { coat, index, base: Box::new(base), depth, lobe, diffuse })
    }

    pub(super) fn is_specular(&self) -> bool {
        matches!(self.lobe, BaseLobe::Mirrored)
    }

    pub(super) fn needs_tangent(&self) -> bool {
        let coat = match &self.coat {
            Coat::Smooth => false,
            Coat::Rough(rough) => rough.facets.is_anisotropic(),
        };
        coat || self.base.needs_tangent()
    }

    /// Share of light that a stretch with this cosine leaves.
    fn film(&self, cos: f64, wavelengths: &SampledWavelengths) -> SampledSpectrum {
        match &self.depth {
            DenseSpectrum::Constant(0.0) => SampledSpectrum::ONE,
            depth => depth.sample(wavelengths).map(|depth| (-depth / cos.abs() as f32).exp()),
        }
    }

    /// Probability of drawing the coat's reflection.
    fn coat_probability(&self, cos: f64) -> f64 {
        let reflectance = Interface::new(cos.min(1.0), self.index).reflectance();
        (reflectance / (reflectance + 0.5 * (1.0 - reflectance))).clamp(0.1, 0.9)
    }

    /// f, without what is mirrored by two smooth walls or by a smooth coat.
    #[inline]
    pub(super) fn eval<P: Polarisation>(&self, wo: DVec3, wi: DVec3, wavelengths: &SampledWavelengths) -> P::Mueller {
        if wo.z * wi.z <= 0.0 || self.is_specular() {
            return P::Mueller::depolariser(SampledSpectrum::ZERO);
        }
        let (side, wo, wi) = upright(wo, wi);
        let value = match (&self.diffuse, &self.coat) {
            (Some(diffuse), _) => self.over_lambert::<P>(diffuse.sample(wavelengths), wo, wi, wavelengths),
            (None, Coat::Smooth) => self.walk::<P>(wo, wi, wavelengths),
            (None, Coat::Rough(rough)) => {
                let coat = rough.eval::<P>(wo, wi, SampledSpectrum::splat(self.index as f32));
                coat.plus(&self.walk::<P>(wo, wi, wavelengths))
            }
        };
        value.to_world(&side)
    }

    fn over_lambert<P: Polarisation>(
        &self,
        gain: SampledSpectrum,
        wo: DVec3,
        wi: DVec3,
        wavelengths: &SampledWavelengths,
    ) -> P::Mueller {
        let (Some((down, enter)), Some((up, _))) = (self.refract::<P>(wo), self.refract::<P>(wi)) else {
            return P::Mueller::depolariser(SampledSpectrum::ZERO);
        };
        let Some((_, leave)) = self.refract::<P>(up) else { return P::Mueller::depolariser(SampledSpectrum::ZERO) };
        let film = self.film(down.z, wavelengths) * self.film(up.z, wavelengths);
        let factor = gain * film * (1.0 / (PI * self.index * self.index)) as f32;
        enter.then(&P::Mueller::depolariser(factor)).then(&leave)
    }

    /// Through the smooth coat, from above or below: where light comes from beyond it, and what becomes of it.
    fn refract<P: Polarisation>(&self, wo: DVec3) -> Option<(DVec3, P::Mueller)> {
        let eta = if wo.z > 0.0 { self.index } else { 1.0 / self.index };
        let interface = Interface::new(wo.z.abs().min(1.0), eta);
        let wi = DVec3::new(-wo.x / eta, -wo.y / eta, -interface.cos_t.copysign(wo.z)).normalize();
        let refraction = interface.refraction();
        let effect = fresnel::gather(|_| refraction, 1.0 / (eta * eta));
        let matrix = P::Mueller::diattenuating_retarder(&effect, s_axis(DVec3::Z, wo), wo, wi);
        (interface.cos_t > 0.0).then_some((wi, matrix))
    }

    /// Reflection by the smooth coat from below.
    fn throw_back<P: Polarisation>(&self, wo: DVec3) -> (DVec3, P::Mueller) {
        let reflection = Interface::new(wo.z.abs().min(1.0), 1.0 / self.index).reflection();
        let sample = BsdfSample::<P>::specular_reflection(wo, &fresnel::gather(|_| reflection, 1.0));
        (sample.wi, sample.weight)
    }

    /// One walk between the walls: an estimate of f for what the base has reflected once or more.
    fn walk<P: Polarisation>(&self, wo: DVec3, wi: DVec3, w: &SampledWavelengths) -> P::Mueller {
        let black = P::Mueller::depolariser(SampledSpectrum::ZERO);
        let mut draws = Draws::new(wo, wi);
        let Some((mut down, mut beta)) = self.go_in::<P>(wo, &mut draws) else { return black };
        let mut sum = black;
        for reflections in 0..MOST_REFLECTIONS {
            beta = beta * self.film(down.z, w);
            if let Some(out) = self.leave_now::<P>(&beta, -down, wi, &mut draws, w) {
                sum = sum.plus(&out);
            }
            let Some(sample) = self.base.sample::<P>(-down, draws.pair(), draws.next(), w) else { break };
            let up = sample.wi;
            beta = beta.then(&(sample.weight * self.film(up.z, w)));
            match &self.coat {
                Coat::Smooth => {
                    let (next, back) = self.throw_back::<P>(-up);
                    (down, beta) = (next, beta.then(&back));
                }
                Coat::Rough(rough) => {
                    if let Some(out) = self.leave_along::<P>(rough, &beta, -down, &sample, wi, w) {
                        sum = sum.plus(&out);
                    }
                    let index = SampledSpectrum::splat(self.index as f32);
                    match rough.sample::<P>(-up, draws.pair(), draws.next(), index) {
                        Some(back) if back.wi.z < 0.0 => (down, beta) = (back.wi, beta.then(&back.weight)),
                        _ => break,
                    }
                }
            }
            if reflections >= SURE_REFLECTIONS {
                let survival = (beta.intensity().max() * (self.index * self.index) as f32).min(0.95);
                // False for NaN as well.
                let survives = draws.next() < f64::from(survival);
                if !survives {
                    break;
                }
                beta = beta * (1.0 / survival);
            }
        }
        sum
    }

    fn go_in<P: Polarisation>(&self, wo: DVec3, draws: &mut Draws) -> Option<(DVec3, P::Mueller)> {
        match &self.coat {
            Coat::Smooth => self.refract::<P>(wo),
            Coat::Rough(rough) => {
                let index = SampledSpectrum::splat(self.index as f32);
                let sample = rough.sample::<P>(wo, draws.pair(), draws.next(), index)?;
                (sample.wi.z < 0.0).then_some((sample.wi, sample.weight))
            }
        }
    }

    /// What the base reflects from the exit's own direction. `wo` points from the base up.
    fn leave_now<P: Polarisation>(
        &self,
        beta: &P::Mueller,
        wo: DVec3,
        wi: DVec3,
        draws: &mut Draws,
        w: &SampledWavelengths,
    ) -> Option<P::Mueller> {
        let index = SampledSpectrum::splat(self.index as f32);
        let (up, leave, weight) = match &self.coat {
            Coat::Smooth => {
                let (down, _) = self.refract::<P>(wi)?;
                let (_, leave) = self.refract::<P>(down)?;
                (-down, leave, 1.0 / (self.index * self.index))
            }
            Coat::Rough(rough) => {
                let sample = rough.sample::<P>(wi, draws.pair(), draws.next(), index)?;
                if sample.wi.z >= 0.0 {
                    return None;
                }
                let up = -sample.wi;
                let by_base = f64::from(self.base.pdf(wo, up, w).hero());
                let weight = up.z.abs() / (sample.pdf + by_base);
                (up, rough.eval::<P>(sample.wi, wi, index), weight)
            }
        };
        if self.base.is_specular() {
            return None;
        }
        let reflected = self.base.eval::<P>(wo, up, w) * self.film(up.z, w);
        let value = beta.then(&reflected).then(&leave) * weight as f32;
        value.intensity().is_valid().then_some(value)
    }

    /// What goes on along a direction that the base has drawn, weighted against [`Layered::leave_now`]. `beta` is up to the
    /// rough coat.
    fn leave_along<P: Polarisation>(
        &self,
        rough: &RoughDielectric,
        beta: &P::Mueller,
        wo: DVec3,
        sample: &BsdfSample<P>,
        wi: DVec3,
        w: &SampledWavelengths,
    ) -> Option<P::Mueller> {
        let index = SampledSpectrum::splat(self.index as f32);
        let down = -sample.wi;
        let weight = if sample.specular {
            1.0
        } else {
            let by_base = f64::from(self.base.pdf(wo, sample.wi, w).hero());
            by_base / (by_base + f64::from(rough.pdf(wi, down, index).hero()))
        };
        let value = beta.then(&rough.eval::<P>(down, wi, index)) * weight as f32;
        value.intensity().is_valid().then_some(value)
    }

    #[inline]
    pub(super) fn pdf(&self, wo: DVec3, wi: DVec3) -> f64 {
        if wo.z * wi.z <= 0.0 {
            return 0.0;
        }
        let q = self.coat_probability(wo.z.abs());
        let coat = match &self.coat {
            Coat::Smooth => 0.0,
            Coat::Rough(rough) => mirrored_pdf(&rough.facets, wo, wi),
        };
        let base = match &self.lobe {
            BaseLobe::Mirrored => return 0.0,
            BaseLobe::Diffuse => cosine_pdf(wo, wi),
            BaseLobe::Glossy(facets) => {
                COSINE_SHARE * cosine_pdf(wo, wi) + (1.0 - COSINE_SHARE) * mirrored_pdf(facets, wo, wi)
            }
        };
        q * coat + (1.0 - q) * base
    }

    #[inline]
    pub(super) fn sample<P: Polarisation>(
        &self,
        wo: DVec3,
        u: [f64; 2],
        u_lobe: f64,
        wavelengths: &SampledWavelengths,
    ) -> Option<BsdfSample<P>> {
        if wo.z == 0.0 {
            return None;
        }
        if self.is_specular() {
            let effect = self.mirrored(wo.z.abs().min(1.0), wavelengths);
            return Some(BsdfSample::specular_reflection(wo, &effect));
        }
        let q = self.coat_probability(wo.z.abs());
        let wi = match (&self.coat, &self.lobe) {
            (Coat::Smooth, _) if u_lobe < q => {
                let reflection = Interface::new(wo.z.abs().min(1.0), self.index).reflection();
                return Some(BsdfSample::specular_reflection(wo, &fresnel::gather(|_| reflection, 1.0 / q)));
            }
            (Coat::Rough(rough), _) if u_lobe < q => mirrored_direction(&rough.facets, wo, u),
            (_, BaseLobe::Glossy(facets)) if u_lobe < q + (1.0 - q) * (1.0 - COSINE_SHARE) => {
                mirrored_direction(facets, wo, u)
            }
            _ => cosine_direction(wo, u)?,
        };
        let pdf = self.pdf(wo, wi);
        if pdf.is_nan() || pdf <= 0.0 {
            return None;
        }
        let weight = self.eval::<P>(wo, wi, wavelengths) * (wi.z.abs() / pdf) as f32;
        Some(BsdfSample { wi, weight, path_pdf: SampledSpectrum::ONE, pdf, specular: false, eta: 1.0 })
    }

    /// Two smooth walls: the sum over all reflections between them.
    fn mirrored(&self, cos: f64, wavelengths: &SampledWavelengths) -> DiattenuatingRetarder {
        let outside = Interface::new(cos, self.index);
        let cos_film = outside.cos_t;
        let inside = Interface::new(cos_film, 1.0 / self.index);
        let base = match &*self.base {
            Bsdf::Conductor(metal) => metal.reflection(cos_film, wavelengths),
            Bsdf::Mirror(mirror) => DiattenuatingRetarder::mirror(mirror.reflectance(wavelengths)),
            // No other base is smooth.
            _ => DiattenuatingRetarder::neutral(SampledSpectrum::ZERO),
        };
        let film = self.film(cos_film, wavelengths);
        let twice = film * film;
        let through = outside.refraction();
        let lane = |lane: usize| {
            let of = |spectrum: SampledSpectrum| f64::from(spectrum.0.to_array()[lane]);
            let [a, b, c, s] = [base.a, base.b, base.c, base.s].map(of);
            series(outside.reflection(), through, inside.reflection(), [a, b, c, s].map(|x| x * of(twice)))
        };
        fresnel::gather(lane, 1.0)
    }
}

/// r + t t b / (1 - r' b), for elements a, b, c, s of the outer reflection, of going through (either way), of the inner
/// reflection, and of the base with the film.
fn series(outer: [f64; 4], through: [f64; 4], inner: [f64; 4], base: [f64; 4]) -> [f64; 4] {
    let along = |e: [f64; 4], sign: f64| e[0] + sign * e[1];
    let power = |sign: f64| {
        let (t, b) = (along(through, sign), along(base, sign));
        along(outer, sign) + t * t * b / (1.0 - along(inner, sign) * b).max(f64::MIN_POSITIVE)
    };
    let product = |[a, b]: [f64; 2], [c, d]: [f64; 2]| [a * c - b * d, a * d + b * c];
    let phase = |e: [f64; 4]| [e[2], e[3]];
    let once = product(product(phase(through), phase(through)), phase(base));
    let again = product(phase(inner), phase(base));
    let rest = [1.0 - again[0], -again[1]];
    let norm = (rest[0] * rest[0] + rest[1] * rest[1]).max(f64::MIN_POSITIVE);
    let sum = product(once, [rest[0] / norm, -rest[1] / norm]);
    let (s, p) = (power(1.0), power(-1.0));
    [0.5 * (s + p), 0.5 * (s - p), outer[2] + sum[0], outer[3] + sum[1]]
}

/// The frame in which both directions are above the surface, and the two in it.
fn upright(wo: DVec3, wi: DVec3) -> (Frame, DVec3, DVec3) {
    let sign = 1f64.copysign(wo.z);
    let frame = Frame { x: DVec3::X, y: DVec3::Y * sign, z: DVec3::Z * sign };
    (frame, frame.to_local(wo), frame.to_local(wi))
}

fn mirrored_pdf(facets: &Microfacets, wo: DVec3, wi: DVec3) -> f64 {
    let h = (above(wo) + above(wi)).normalize();
    let pdf = facets.pdf(above(wo), h) / (4.0 * above(wo).dot(h));
    if pdf.is_finite() { pdf } else { 0.0 }
}

fn mirrored_direction(facets: &Microfacets, wo: DVec3, u: [f64; 2]) -> DVec3 {
    let mut h = facets.sample(above(wo), u);
    h.z = h.z.copysign(wo.z);
    (h * (2.0 * wo.dot(h)) - wo).normalize()
}

/// Points of the quadrature on either side.
const NODES: usize = 256;

/// rho / (1 - rho F), F being the integral of 2 mu R(mu) exp(-2 depth / mu) over mu from 0 to 1, for the coat from within:
/// midpoints on either side of the critical angle, denser towards it, where the reflectance has a kink.
fn diffuse_gain(reflectance: &DenseSpectrum, depth: &DenseSpectrum, index: f64) -> DenseSpectrum {
    let critical = (1.0 - 1.0 / (index * index)).max(0.0).sqrt();
    let mut nodes = Vec::with_capacity(2 * NODES);
    for [low, high] in [[0.0, critical], [critical, 1.0]] {
        for i in 0..NODES {
            let t = (i as f64 + 0.5) / NODES as f64;
            let (mu, slope) = if low == 0.0 {
                (high * (1.0 - t * t), high * 2.0 * t)
            } else {
                (low + (high - low) * t * t, (high - low) * 2.0 * t)
            };
            let reflected = Interface::new(mu.min(1.0), 1.0 / index).reflectance();
            nodes.push((mu, 2.0 * mu * reflected * slope / NODES as f64));
        }
    }
    let back = |depth: f64| nodes.iter().map(|(mu, weight)| weight * (-2.0 * depth / mu).exp()).sum::<f64>();
    let clear = back(0.0);
    DenseSpectrum::from_fn(|lambda_nm| {
        let (rho, depth) = (f64::from(reflectance.at(lambda_nm)), f64::from(depth.at(lambda_nm)));
        rho / (1.0 - rho * if depth == 0.0 { clear } else { back(depth) })
    })
}
