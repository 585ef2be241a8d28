//! The text form of an IR: one statement a line, children before parents.
//!
//! ```text
//! ir 1
//! bsdf b0 = lambert(reflectance: constant(0.4))
//! medium v0 = medium(absorption: constant(0.1), scattering: constant(2.0), emission: constant(0.0), phase: isotropic(), density: uniform())
//! material m0 = material(bsdf: b0)
//! %0 = sphere(radius: 1.0, material: m0) @0:10..19
//! %1 = box(min: [0.0, 0.0, 0.0], max: [1.0, 1.0, 1.0], at: [0.0, 0.0, 2.5], material: m0) @0:30..35
//! %2 = union(%0, %1) @0:10..35
//! root %2
//! camera perspective(fov: 0.6, eye: […], target: […], up: […], resolution: [700, 700], filter: box(radius: 0.5))
//! action write_png(path: "out.png") @0:50..60
//! ```
//!
//! Floats are written as the shortest text that reads back as the same number. `at` is a translation, `map` a general
//! affine map (the images of x, y, z, then the translation); neither: the identity. `@source:start..end` is the
//! provenance. [`crate::read`] reads it back; the grammar is in `docs/reference/ir.md`.

use std::fmt::{self, Display, Formatter, Write};

use arsc_diagnostics::Span;
use arsc_geometry::DVec3;
use arsc_spectral::{DonaldsonMatrix, Dye, Fluorescence, Spectrum};

use crate::image_action::print_tone_map;
use crate::shape_text::open_shape;
use crate::write::{Call, Float, Floats};
use crate::{
    Action, Attributes, Bsdf, CutRule, Density, Emitter, Facets, Ir, Leaf, Material, Medium, NodeId, NodeKind,
    PhaseFunction, Precedence, Sampler, Sampling, Surface,
};

impl Display for Ir {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        writeln!(f, "ir 1")?;
        for (id, bsdf) in self.bsdfs.iter().enumerate() {
            writeln!(f, "bsdf b{id} = {}", Text(bsdf))?;
        }
        for (id, emitter) in self.emitters.iter().enumerate() {
            writeln!(f, "emitter e{id} = {}", Text(emitter))?;
        }
        for (id, medium) in self.media.iter().enumerate() {
            writeln!(f, "medium v{id} = {}", Text(medium))?;
        }
        for (id, material) in self.materials.iter().enumerate() {
            writeln!(f, "material m{id} = {}", Text(material))?;
        }
        for (id, node) in self.nodes.iter().enumerate() {
            writeln!(f, "%{id} = {} {}", Text(&node.kind), Text(&node.origin))?;
        }
        writeln!(f, "root {}", Text(&self.root))?;
        if let Some(camera) = &self.camera {
            writeln!(f, "camera {}", Text(camera))?;
        }
        for action in &self.actions {
            writeln!(f, "action {} {}", Text(&action.action), Text(&action.origin))?;
        }
        Ok(())
    }
}

/// Something as the text form writes it.
pub(crate) struct Text<'a, T>(pub &'a T);

/// A string literal: only `"`, `\` and control characters are escaped.
pub(crate) struct Quoted<'a>(pub &'a str);

impl Display for Quoted<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_char('"')?;
        for c in self.0.chars() {
            match c {
                '"' | '\\' => write!(f, "\\{c}")?,
                c if c.is_control() => write!(f, "\\u{{{:x}}}", c as u32)?,
                c => f.write_char(c)?,
            }
        }
        f.write_char('"')
    }
}

impl Display for Text<'_, Span> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Span { source, start, end } = *self.0;
        write!(f, "@{}:{start}..{end}", source.0)
    }
}

impl Display for Text<'_, NodeId> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, "%{}", self.0.0)
    }
}

impl Display for Text<'_, Spectrum> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self.0 {
            Spectrum::Constant(value) => Call::new(f, "constant")?.value(Float(*value))?.end(),
            Spectrum::Tabulated { lambda_nm, values } => {
                Call::new(f, "tabulated")?.arg("lambda_nm", Floats(lambda_nm))?.arg("values", Floats(values))?.end()
            }
            Spectrum::Blackbody { kelvin } => Call::new(f, "blackbody")?.float("kelvin", *kelvin)?.end(),
            Spectrum::Gaussian { center_nm, sigma_nm, peak } => Call::new(f, "gaussian")?
                .float("center_nm", *center_nm)?
                .float("sigma_nm", *sigma_nm)?
                .float("peak", *peak)?
                .end(),
            Spectrum::Sellmeier { a, b, c_um2 } => {
                Call::new(f, "sellmeier")?.float("a", *a)?.arg("b", Floats(b))?.arg("c_um2", Floats(c_um2))?.end()
            }
            Spectrum::Cauchy { a, b_um2, c_um4 } => {
                Call::new(f, "cauchy")?.float("a", *a)?.float("b_um2", *b_um2)?.float("c_um4", *c_um4)?.end()
            }
            Spectrum::Sigmoid { coefficients } => Call::new(f, "sigmoid")?.value(Floats(coefficients))?.end(),
            Spectrum::Absorbance { transmission, thickness } => {
                Call::new(f, "absorbance")?.value(Text(&**transmission))?.float("thickness", *thickness)?.end()
            }
            Spectrum::Scaled { factor, spectrum } => {
                Call::new(f, "scaled")?.value(Float(*factor))?.value(Text(&**spectrum))?.end()
            }
            Spectrum::Product(a, b) => Call::new(f, "product")?.value(Text(&**a))?.value(Text(&**b))?.end(),
            Spectrum::Sum(a, b) => Call::new(f, "sum")?.value(Text(&**a))?.value(Text(&**b))?.end(),
        }
    }
}

impl Display for Text<'_, Bsdf> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self.0 {
            Bsdf::Lambert { reflectance } => Call::new(f, "lambert")?.arg("reflectance", Text(reflectance))?.end(),
            Bsdf::OrenNayar { reflectance, sigma } => {
                Call::new(f, "oren_nayar")?.arg("reflectance", Text(reflectance))?.float("sigma", *sigma)?.end()
            }
            Bsdf::Mirror { reflectance } => Call::new(f, "mirror")?.arg("reflectance", Text(reflectance))?.end(),
            Bsdf::Dielectric { ior } => Call::new(f, "dielectric")?.arg("ior", Text(ior))?.end(),
            Bsdf::Conductor { eta, k } => Call::new(f, "conductor")?.arg("eta", Text(eta))?.arg("k", Text(k))?.end(),
            Bsdf::Inert => Call::new(f, "inert")?.end(),
            Bsdf::ThinDielectric { ior } => Call::new(f, "thin_dielectric")?.arg("ior", Text(ior))?.end(),
            Bsdf::Phong { reflectance, exponent } => {
                Call::new(f, "phong")?.arg("reflectance", Text(reflectance))?.float("exponent", *exponent)?.end()
            }
            Bsdf::RoughConductor { eta, k, facets } => {
                facets_of(Call::new(f, "rough_conductor")?.arg("eta", Text(eta))?.arg("k", Text(k))?, facets)?.end()
            }
            Bsdf::RoughDielectric { ior, facets } => {
                facets_of(Call::new(f, "rough_dielectric")?.arg("ior", Text(ior))?, facets)?.end()
            }
            Bsdf::Polariser { transmittance, angle } => {
                Call::new(f, "polariser")?.arg("transmittance", Text(transmittance))?.float("angle", *angle)?.end()
            }
            Bsdf::Retarder { retardance, angle } => {
                Call::new(f, "retarder")?.float("retardance", *retardance)?.float("angle", *angle)?.end()
            }
            Bsdf::Varying(varying) => write!(f, "{}", Text(&**varying)),
            Bsdf::Measured { path, .. } => Call::new(f, "measured")?.arg("path", Quoted(path))?.end(),
            Bsdf::Layered { coat, base, absorption, thickness } => Call::new(f, "layered")?
                .arg("coat", Text(&**coat))?
                .arg("base", Text(&**base))?
                .arg("absorption", Text(absorption))?
                .float("thickness", *thickness)?
                .end(),
            Bsdf::Depolariser { transmittance } => {
                Call::new(f, "depolariser")?.arg("transmittance", Text(transmittance))?.end()
            }
            Bsdf::Fluorescent { reradiation, sigma } => Call::new(f, "fluorescent")?
                .arg("reflectance", Text(&reradiation.reflectance))?
                .arg("fluorescence", Text(&reradiation.fluorescence))?
                .float("sigma", *sigma)?
                .end(),
        }
    }
}

fn facets_of<'a, 'b>(call: Call<'a, 'b>, facets: &Facets) -> Result<Call<'a, 'b>, fmt::Error> {
    call.arg("distribution", facets.distribution.name())?.arg("alpha", Floats(&facets.alpha))
}

impl Display for Text<'_, Emitter> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Emitter { radiance, two_sided, thermal } = self.0;
        let name = if *thermal { "thermal_emitter" } else { "emitter" };
        Call::new(f, name)?.arg("radiance", Text(radiance))?.arg("two_sided", two_sided)?.end()
    }
}

impl Display for Text<'_, Dye> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Dye { absorption, emission, quantum_yield } = self.0;
        let call = Call::new(f, "dye")?.arg("absorption", Text(absorption))?.arg("emission", Text(emission))?;
        call.float("quantum_yield", *quantum_yield)?.end()
    }
}

impl Display for Text<'_, Fluorescence> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self.0 {
            Fluorescence::Dye(dye) => write!(f, "{}", Text(dye)),
            Fluorescence::Matrix(DonaldsonMatrix { excitation_nm, emission_nm, columns, entries }) => {
                Call::new(f, "matrix")?
                    .arg("excitation_nm", Floats(excitation_nm))?
                    .arg("emission_nm", Floats(emission_nm))?
                    .arg("columns", columns)?
                    .arg("entries", Floats(entries))?
                    .end()
            }
        }
    }
}

impl Display for Text<'_, Vec<Dye>> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_char('[')?;
        for (i, dye) in self.0.iter().enumerate() {
            write!(f, "{}{}", if i > 0 { ", " } else { "" }, Text(dye))?;
        }
        f.write_char(']')
    }
}

impl Display for Text<'_, Medium> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Medium { absorption, scattering, emission, dyes, phase, density } = self.0;
        let mut call = Call::new(f, "medium")?
            .arg("absorption", Text(absorption))?
            .arg("scattering", Text(scattering))?
            .arg("emission", Text(emission))?;
        if !dyes.is_empty() {
            call = call.arg("dyes", Text(dyes))?;
        }
        call.arg("phase", Text(phase))?.arg("density", Text(density))?.end()
    }
}

impl Display for Text<'_, PhaseFunction> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match *self.0 {
            PhaseFunction::Isotropic => Call::new(f, "isotropic")?.end(),
            PhaseFunction::HenyeyGreenstein { g } => Call::new(f, "henyey_greenstein")?.float("g", g)?.end(),
            PhaseFunction::Rayleigh { depolarisation } => {
                Call::new(f, "rayleigh")?.float("depolarisation", depolarisation)?.end()
            }
        }
    }
}

impl Display for Text<'_, Density> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self.0 {
            Density::Uniform => Call::new(f, "uniform")?.end(),
            Density::Gaussian { center, sigma } => {
                Call::new(f, "gaussian")?.point("center", *center)?.float("sigma", *sigma)?.end()
            }
            Density::Exponential { ground, height } => {
                Call::new(f, "exponential")?.float("ground", *ground)?.float("height", *height)?.end()
            }
        }
    }
}

impl Display for Text<'_, Material> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Material { bsdf, emitter, medium, inside, ref faces } = *self.0;
        let call = Call::new(f, "material")?.index("bsdf", "b", bsdf)?.index("emitter", "e", emitter)?;
        let call = call.index("medium", "v", medium)?.index("inside", "b", inside)?;
        faces.iter().try_fold(call, |call, (face, id)| call.value(format_args!("face({face}, m{})", id.0)))?.end()
    }
}

impl Display for Text<'_, NodeKind> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let operands = |f: &mut Formatter<'_>, name: &str, children: &[NodeId]| {
            let call = children.iter().try_fold(Call::new(f, name)?, |call, child| call.value(Text(child)))?;
            call.end()
        };
        match self.0 {
            NodeKind::Leaf(leaf) => write!(f, "{}", Text(&**leaf)),
            NodeKind::Union(children) => operands(f, "union", children),
            NodeKind::Intersection(children) => operands(f, "intersection", children),
            NodeKind::Difference(children) => operands(f, "difference", children),
            NodeKind::Group(children) => operands(f, "group", children),
            NodeKind::Transform { parent_from_child, child } => {
                Call::new(f, "transform")?.value(Text(child))?.map(parent_from_child)?.end()
            }
            NodeKind::Attributes { attributes: Attributes { bsdf, emitter, medium, cut, face }, precedence, child } => {
                let name = match precedence {
                    Precedence::Inner => "with",
                    Precedence::Outer => "override",
                };
                let call = Call::new(f, name)?.value(Text(child))?;
                let call = call.index("bsdf", "b", *bsdf)?.index("emitter", "e", *emitter)?;
                let call = call.index("medium", "v", *medium)?.index("face", "", *face)?;
                match cut {
                    None => call.end(),
                    Some(CutRule::Inherit) => call.arg("cut", "inherit")?.end(),
                    Some(CutRule::Bsdf(bsdf)) => call.index("cut", "b", Some(*bsdf))?.end(),
                }
            }
            NodeKind::Light(light) => write!(f, "{}", Text(&**light)),
            NodeKind::Environment(environment) => write!(f, "{}", Text(&**environment)),
        }
    }
}

impl Display for Text<'_, Leaf> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let (call, map, material) = match self.0 {
            Leaf::Solid { shape, parent_from_object, material } => {
                (open_shape(f, shape)?, parent_from_object, material)
            }
            Leaf::Surface { surface, parent_from_object, material } => {
                (open_surface(f, surface)?, parent_from_object, material)
            }
        };
        call.map(map)?.index("material", "m", material.map(|id| id.0))?.end()
    }
}

fn open_surface<'a, 'b>(f: &'a mut Formatter<'b>, surface: &Surface) -> Result<Call<'a, 'b>, fmt::Error> {
    let corners = |call: Call<'a, 'b>, corners: &[DVec3]| {
        corners.iter().try_fold(call, |call, corner| call.value(Floats(&corner.to_array())))
    };
    match surface {
        Surface::Triangle(points) => corners(Call::new(f, "triangle")?, points),
        Surface::Quad(points) => corners(Call::new(f, "quad")?, points),
        Surface::Rectangle { width, depth } => {
            Call::new(f, "rectangle")?.float("width", *width)?.float("depth", *depth)
        }
        Surface::Disk { radius } => Call::new(f, "disk")?.float("radius", *radius),
        Surface::Plane => Call::new(f, "plane"),
        Surface::Mesh { path, .. } => Call::new(f, "mesh")?.arg("path", Quoted(path)),
    }
}

/// Leaves the call open for more; arguments that have their usual value are left out.
fn sampling<'a, 'b>(call: Call<'a, 'b>, sampling: &Sampling) -> Result<Call<'a, 'b>, fmt::Error> {
    let mut call = call.arg("samples", sampling.samples)?.arg("seed", sampling.seed)?;
    if sampling.sampler != Sampler::Sobol {
        call = call.arg("sampler", sampling.sampler.name())?;
    }
    if let Some(noise) = sampling.noise {
        call = call.float("noise", noise)?;
    }
    match sampling.time_limit {
        Some(seconds) => call.float("time_limit", seconds),
        None => Ok(call),
    }
}

/// An argument that is there when it is true.
fn flag<'a, 'b>(call: Call<'a, 'b>, name: &str, value: bool) -> Result<Call<'a, 'b>, fmt::Error> {
    if value { call.arg(name, true) } else { Ok(call) }
}

/// A file of a display picture; 8 bit go without saying.
fn written(f: &mut Formatter<'_>, name: &str, path: &str, sixteen_bit: bool) -> fmt::Result {
    let call = Call::new(f, name)?.arg("path", Quoted(path))?;
    if sixteen_bit { call.arg("sixteen_bit", true)?.end() } else { call.end() }
}

impl Display for Text<'_, Action> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self.0 {
            Action::Accelerate { strategy } => Call::new(f, "accelerate")?.arg("strategy", strategy.name())?.end(),
            Action::BoundingBoxes => f.write_str("bounding_boxes()"),
            Action::CollectLights => f.write_str("collect_lights()"),
            Action::PathTrace(trace) => sampling(Call::new(f, "path_trace")?, &trace.sampling)
                .and_then(|call| flag(call, "features", trace.features))?
                .arg("max_depth", trace.max_depth)?
                .arg("wavelengths", Floats(&[trace.wavelengths.min_nm(), trace.wavelengths.max_nm()]))?
                .float("band_nm", trace.band_nm)?
                .arg("observer", trace.observer.name())?
                .arg("polarised", trace.polarised)?
                .end(),
            Action::AmbientOcclusion { distance, sampling: of } => {
                sampling(Call::new(f, "ambient_occlusion")?.float("distance", *distance)?, of)?.end()
            }
            Action::Preview { sampling: of, features } => {
                flag(sampling(Call::new(f, "preview")?, of)?, "features", *features)?.end()
            }
            Action::ToneMap { tone, slice_nm } => print_tone_map(f, tone, *slice_nm),
            Action::Image(action) => Text(action).fmt(f),
            Action::WriteExr { path } => Call::new(f, "write_exr")?.arg("path", Quoted(path))?.end(),
            Action::WritePng { path, sixteen_bit } => written(f, "write_png", path, *sixteen_bit),
            Action::WriteTiff { path, sixteen_bit } => written(f, "write_tiff", path, *sixteen_bit),
            Action::WriteCsv { path } => Call::new(f, "write_csv")?.arg("path", Quoted(path))?.end(),
            Action::Dup => f.write_str("dup()"),
            Action::Swap => f.write_str("swap()"),
            Action::Drop => f.write_str("drop()"),
            Action::Over => f.write_str("over()"),
        }
    }
}
