//! Bsdfs that vary over a surface: what they are at a hit.
//!
//! The expressions of a material are one list of steps, equal ones once, evaluated at the hit. One part is then chosen in
//! proportion to the weights, and stands for the whole at this event: light sampling and scattering see a single bsdf whose
//! value, density and samples agree. Radiance is linear in the bsdf, so that the mean is that of the weighted sum, with any
//! mixture of smooth and rough parts. Nothing is allocated at a hit; spectra are taken at the path's wavelengths.

use std::cell::RefCell;
use std::sync::Arc;

use arsc_accel::{Hit, Scene};
use arsc_spectral::{ColourBasis, DenseSpectrum, SampledSpectrum, SampledWavelengths, srgb};
use arsc_texture::{Dual, Expression, ExpressionGraph, ImageMap, Inputs, Needs, Step, evaluate, evaluate_gradients};
use glam::{DAffine3, DVec2, DVec3};

use crate::bsdf::{Bsdf, BsdfParameters};
use crate::frame::Frame;

/// One of several bsdfs at a point, with what varies in it.
#[derive(Clone, Debug)]
pub struct VaryingPart {
    /// Relative to the sum over the parts; negative values count as 0.
    pub weight: Expression,
    pub bsdf: Bsdf,
    pub parameters: Vec<Parameter>,
}

/// A parameter of a bsdf that varies; values are limited to what the bsdf allows.
#[derive(Clone, Debug)]
pub enum Parameter {
    /// The sum of terms.
    Reflectance(Vec<SpectrumTerm>),
    /// Of Oren and Nayar's model, radians.
    Sigma(Expression),
    /// Of the Phong lobe.
    Exponent(Expression),
    /// Of microfacets, along and across the direction of growing u.
    Roughness([Expression; 2]),
    /// Of any: how far the surface seems to stand out along its normal, in the space of the expressions.
    Height(Expression),
    /// Of any: the shading normal along growing u, across it, and along the normal.
    Normal([Expression; 3]),
}

/// Weight times spectrum, times a colour that varies if there is one.
#[derive(Clone, Debug)]
pub struct SpectrumTerm {
    pub weight: Expression,
    pub spectrum: DenseSpectrum,
    pub color: Option<ColorTexture>,
}

/// A reflectance of a colour that varies.
#[derive(Clone, Debug)]
pub enum ColorTexture {
    /// Linear sRGB, limited to [0, 1].
    Rgb([Expression; 3]),
    /// A picture at surface coordinates.
    Image { image: Arc<ImageMap>, uv: [Expression; 2] },
}

#[derive(Clone, Debug)]
struct TermSlot {
    weight: u32,
    spectrum: DenseSpectrum,
    color: Option<ColorSlot>,
}

#[derive(Clone, Debug)]
enum ColorSlot {
    Rgb([u32; 3]),
    Image { image: Arc<ImageMap>, uv: [u32; 2] },
}

/// Positions of steps in place of expressions.
#[derive(Clone, Debug)]
enum Slot {
    Reflectance(Vec<TermSlot>),
    Sigma(u32),
    Exponent(u32),
    Roughness([u32; 2]),
}

#[derive(Clone, Debug)]
struct Part {
    weight: u32,
    bsdf: Bsdf,
    slots: Vec<Slot>,
    relief: Relief,
}

/// What bends the shading normal.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Relief {
    None,
    Height(u32),
    Normal([u32; 3]),
}

/// A bsdf that varies.
#[derive(Clone, Debug)]
pub struct VaryingBsdf {
    steps: Vec<Step>,
    images: Vec<Arc<ImageMap>>,
    needs: Needs,
    parts: Vec<Part>,
    texture_from_object: DAffine3,
}

thread_local! {
    /// Values of steps.
    static VALUES: RefCell<Vec<f64>> = const { RefCell::new(Vec::new()) };
    /// With derivatives.
    static DUALS: RefCell<Vec<Dual>> = const { RefCell::new(Vec::new()) };
}

impl VaryingBsdf {
    /// `texture_from_object` leads from the object space of the leaf to the space of the expressions. `None` without parts.
    pub fn new(parts: Vec<VaryingPart>, texture_from_object: DAffine3) -> Option<VaryingBsdf> {
        let mut graph = ExpressionGraph::default();
        let mut put = |expression: &Expression| graph.insert(expression).0;
        let mut compiled = Vec::new();
        for part in parts {
            let weight = put(&part.weight);
            let (mut slots, mut relief) = (Vec::new(), Relief::None);
            for parameter in part.parameters {
                slots.push(match parameter {
                    Parameter::Reflectance(terms) => {
                        let term = |term: SpectrumTerm| TermSlot {
                            weight: put(&term.weight),
                            spectrum: term.spectrum,
                            color: term.color.map(|color| match color {
                                ColorTexture::Rgb(rgb) => ColorSlot::Rgb(rgb.map(|c| put(&c))),
                                ColorTexture::Image { image, uv } => {
                                    ColorSlot::Image { image, uv: uv.map(|c| put(&c)) }
                                }
                            }),
                        };
                        Slot::Reflectance(terms.into_iter().map(term).collect())
                    }
                    Parameter::Sigma(sigma) => Slot::Sigma(put(&sigma)),
                    Parameter::Exponent(exponent) => Slot::Exponent(put(&exponent)),
                    Parameter::Roughness(alpha) => Slot::Roughness(alpha.map(|alpha| put(&alpha))),
                    Parameter::Height(height) => {
                        relief = Relief::Height(put(&height));
                        continue;
                    }
                    Parameter::Normal(normal) => {
                        relief = Relief::Normal(normal.map(|component| put(&component)));
                        continue;
                    }
                });
            }
            compiled.push(Part { weight, bsdf: part.bsdf, slots, relief });
        }
        let (steps, images) = (graph.steps().to_vec(), graph.images().to_vec());
        let mut needs = Needs::of(&steps);
        needs.local |= compiled.iter().any(|part| matches!(part.relief, Relief::Height(_)));
        (!compiled.is_empty()).then_some(VaryingBsdf { steps, images, needs, parts: compiled, texture_from_object })
    }

    /// The part that answers for all when a question has no place: an interface if there is one, else the first that does
    /// something to light.
    pub fn representative(&self) -> &Bsdf {
        let interface = self.bsdfs().find(|bsdf| bsdf.index().is_some());
        interface.or_else(|| self.bsdfs().find(|bsdf| bsdf.has_interface())).unwrap_or(&self.parts[0].bsdf)
    }

    pub(crate) fn bsdfs(&self) -> impl Iterator<Item = &Bsdf> {
        self.parts.iter().map(|part| &part.bsdf)
    }

    /// The bsdf at a hit: a part as it is, or with its parameters in `owned`. `u` picks the part; what is left of it is
    /// uniform again. The hit gets the part's shading normal.
    pub(crate) fn at<'a>(
        &'a self,
        geometry: &Scene,
        hit: &mut Hit,
        u: &mut f64,
        wavelengths: &SampledWavelengths,
        owned: &'a mut Option<Bsdf>,
    ) -> &'a Bsdf {
        let inputs = self.inputs(geometry, hit);
        VALUES.with_borrow_mut(|values| {
            evaluate(&self.steps, &self.images, &inputs, values);
            let part = self.choose(values, u);
            let ns = match part.relief {
                Relief::None => hit.ns,
                Relief::Height(height) => self.raised_normal(geometry, hit, &inputs, height),
                Relief::Normal(normal) => mapped_normal(geometry, hit, normal.map(|step| values[step as usize])),
            };
            // A normal that points into the surface is of no use.
            if ns.dot(hit.ng) > 0.0 {
                hit.ns = ns;
            }
            if part.slots.is_empty() {
                return &part.bsdf;
            }
            &*owned.insert(part.resolve(values, wavelengths))
        })
    }

    /// What the expressions read at a hit.
    fn inputs(&self, geometry: &Scene, hit: &Hit) -> Inputs {
        let mut inputs = Inputs { world_p: hit.p, world_normal: hit.ns, ..Inputs::default() };
        if self.needs.local {
            let map = self.texture_from_object * geometry.object_from_world(hit.part);
            inputs.p = map.transform_point3(hit.p);
            inputs.normal = (map.matrix3.inverse().transpose() * hit.ns).normalize_or(hit.ns);
        }
        if self.needs.color {
            inputs.color = vertex_color(geometry, hit);
        }
        if self.needs.uv {
            inputs.uv = geometry.parametrize(hit).uv;
        }
        inputs
    }

    /// The normal of the surface raised by a height: n - grad h, for lengths in the space of the texture (Blinn 1978,
    /// "Simulation of wrinkled surfaces").
    fn raised_normal(&self, geometry: &Scene, hit: &Hit, inputs: &Inputs, height: u32) -> DVec3 {
        let texture_from_world = self.texture_from_object * geometry.object_from_world(hit.part);
        let world_from_texture = texture_from_world.matrix3.inverse();
        let frame = Frame::new(inputs.normal);
        let along = [frame.x, frame.y].map(|tangent| {
            let world_p = world_from_texture * tangent;
            let uv = if self.needs.uv { uv_slope(geometry, hit, inputs.uv, world_p) } else { DVec2::ZERO };
            Inputs { p: tangent, world_p, uv, ..Inputs::default() }
        });
        let slope = DUALS.with_borrow_mut(|values| {
            evaluate_gradients(&self.steps[..=height as usize], &self.images, inputs, &along, values);
            values.last().map_or(DVec2::ZERO, |value| value.1)
        });
        let raised = inputs.normal - frame.x * slope.x - frame.y * slope.y;
        (texture_from_world.matrix3.transpose() * raised).try_normalize().unwrap_or(hit.ns)
    }

    fn choose(&self, values: &[f64], u: &mut f64) -> &Part {
        if let [only] = &self.parts[..] {
            return only;
        }
        let weight = |part: &Part| values[part.weight as usize].max(0.0);
        let sum: f64 = self.parts.iter().map(weight).sum();
        let mut rest = *u * sum;
        for part in &self.parts {
            let weight = weight(part);
            if rest < weight {
                *u = (rest / weight).clamp(0.0, 1.0 - f64::EPSILON);
                return part;
            }
            rest -= weight;
        }
        // Rounding, or no weight at all.
        let last = self.parts.iter().rev().find(|part| weight(part) > 0.0);
        last.unwrap_or(&self.parts[0])
    }
}

/// Linear sRGB of the mesh's vertices, interpolated; white where there are none.
fn vertex_color(geometry: &Scene, hit: &Hit) -> DVec3 {
    let Some(corners) = geometry.vertex_colors(hit) else { return DVec3::ONE };
    let linear = |color: [u8; 3]| DVec3::from_array(color.map(|c| srgb::decode(f64::from(c) / 255.0)));
    corners.into_iter().map(|(color, weight)| linear(color) * weight).sum()
}

/// Change of the surface coordinates per length of a tangent. A difference: coordinates are smooth but for seams.
fn uv_slope(geometry: &Scene, hit: &Hit, uv: DVec2, tangent: DVec3) -> DVec2 {
    // Far above rounding, far below features.
    let step = 1e7 * hit.p_error / tangent.length();
    let moved = geometry.parametrize(&Hit { p: hit.p + tangent * step, ..*hit }).uv;
    let change = moved - uv;
    (change - change.round()) / step
}

fn mapped_normal(geometry: &Scene, hit: &Hit, [u, v, n]: [f64; 3]) -> DVec3 {
    let frame = Frame::with_tangent(hit.ns, geometry.parametrize(hit).dpdu);
    frame.to_world(DVec3::new(u, v, n)).try_normalize().unwrap_or(hit.ns)
}

impl Part {
    fn resolve(&self, values: &[f64], wavelengths: &SampledWavelengths) -> Bsdf {
        let at = |step: u32| values[step as usize];
        let mut parameters = BsdfParameters::default();
        for slot in &self.slots {
            match slot {
                Slot::Reflectance(terms) => parameters.reflectance = Some(blend(terms, values, wavelengths)),
                Slot::Sigma(sigma) => parameters.sigma = Some(at(*sigma)),
                Slot::Exponent(exponent) => parameters.exponent = Some(at(*exponent)),
                Slot::Roughness(alpha) => parameters.alpha = Some(alpha.map(at)),
            }
        }
        self.bsdf.with_parameters(&parameters, wavelengths)
    }
}

/// The sum of weighted spectra, limited to [0, 1].
fn blend(terms: &[TermSlot], values: &[f64], wavelengths: &SampledWavelengths) -> SampledSpectrum {
    let mut sum = SampledSpectrum::ZERO;
    let at = |step: u32| values[step as usize];
    for term in terms {
        let weight = at(term.weight) as f32;
        if weight != 0.0 {
            let spectrum = term.spectrum.sample(wavelengths) * weight;
            sum += match &term.color {
                None => spectrum,
                Some(ColorSlot::Rgb(rgb)) => {
                    let rgb = rgb.map(|c| at(c).clamp(0.0, 1.0) as f32);
                    spectrum * ColourBasis::reflectance().sample(rgb, wavelengths)
                }
                Some(ColorSlot::Image { image, uv: [u, v] }) => {
                    spectrum * image.reflectance(DVec2::new(at(*u), at(*v)), wavelengths)
                }
            };
        }
    }
    // Opposite infinities of single precision leave no number: black.
    sum.map(|value| if value.is_nan() { 0.0 } else { value.clamp(0.0, 1.0) })
}
