//! Reading the text form back (see the module `print` for how it looks).
//!
//! Reading checks the form and what a statement refers to (nodes, bsdfs, emitters and materials stand before their
//! use); the rest of the invariants is the verifier's.

use std::fmt;
use std::sync::Arc;

use arsc_diagnostics::{SourceId, Span};
use arsc_geometry::{ClosedMesh, DVec3, Shape, TriangleMesh};
use arsc_spectral::{
    DonaldsonMatrix, Dye, Fluorescence, MerlBrdf, Observer, Raster, Reradiation, Spectrum, WavelengthRange,
};

use crate::args::{Args, float, float_list, floats, index, integer, named};
use crate::camera_text::read_camera;
use crate::image_action::{image_action, tone_map};
use crate::light_text::{environment, light};
use crate::shape_text::shape;
use crate::term::{Cursor, Fault, Term, TermKind};
use crate::{
    Action, ActionAt, Attributes, Bsdf, CutRule, Density, Distribution, Emitter, Facets, Ir, Leaf, Material,
    MaterialId, Medium, Node, NodeId, NodeKind, PathTrace, PhaseFunction, Precedence, Sampler, Sampling, Strategy,
    Surface,
};

/// Why a text is no IR; one-based position, the column counted in characters.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ReadError {
    pub line: usize,
    pub column: usize,
    pub message: String,
}

impl fmt::Display for ReadError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}: {}", self.line, self.column, self.message)
    }
}

impl std::error::Error for ReadError {}

/// Where the content of files comes from, by path: the text form names them only.
pub trait Contents {
    fn mesh(&self, _path: &str) -> Option<Arc<TriangleMesh>> {
        None
    }

    fn brdf(&self, _path: &str) -> Option<Arc<MerlBrdf>> {
        None
    }

    fn image(&self, _path: &str) -> Option<Arc<Raster>> {
        None
    }
}

/// No files.
impl Contents for () {}

/// Reads the text form of an IR that names no files.
///
/// # Errors
/// The first place where the text does not have the form.
pub fn read(text: &str) -> Result<Ir, ReadError> {
    read_with(text, &())
}

/// Reads the text form of an IR.
///
/// # Errors
/// The first place where the text does not have the form, or names a file that there is not.
pub fn read_with(text: &str, contents: &dyn Contents) -> Result<Ir, ReadError> {
    read_statements(text, contents).map_err(|(offset, message)| {
        let before = &text[..offset];
        let line_start = before.rfind('\n').map_or(0, |at| at + 1);
        let line = before.matches('\n').count() + 1;
        ReadError { line, column: before[line_start..].chars().count() + 1, message }
    })
}

fn read_statements(text: &str, contents: &dyn Contents) -> Result<Ir, Fault> {
    let mut cursor = Cursor::new(text);
    cursor.expect("ir")?;
    cursor.expect("1")?;
    let mut ir = Ir {
        nodes: Vec::new(),
        root: NodeId(u32::MAX),
        bsdfs: Vec::new(),
        emitters: Vec::new(),
        media: Vec::new(),
        materials: Vec::new(),
        camera: None,
        actions: Vec::new(),
    };
    while cursor.skip_blank() {
        statement(&mut cursor, &mut ir, contents)?;
    }
    if ir.root.0 == u32::MAX {
        return cursor.fault("there is no `root`");
    }
    Ok(ir)
}

fn statement(cursor: &mut Cursor, ir: &mut Ir, contents: &dyn Contents) -> Result<(), Fault> {
    if cursor.peek() == Some('%') {
        let start = cursor.offset;
        if cursor.node()? as usize != ir.nodes.len() {
            return Err((start, format!("expected the next node, `%{}`", ir.nodes.len())));
        }
        cursor.expect("=")?;
        let kind = node_kind(Args::new(cursor.term()?)?, ir, contents)?;
        let origin = span(cursor)?;
        ir.nodes.push(Node { kind, origin });
        return Ok(());
    }
    let start = cursor.offset;
    match cursor.word()? {
        "bsdf" => {
            let term = definition(cursor, 'b', ir.bsdfs.len())?;
            ir.bsdfs.push(bsdf(term, contents)?);
        }
        "emitter" => {
            let term = definition(cursor, 'e', ir.emitters.len())?;
            ir.emitters.push(emitter(term)?);
        }
        "medium" => {
            let term = definition(cursor, 'v', ir.media.len())?;
            ir.media.push(medium(term)?);
        }
        "material" => {
            let term = definition(cursor, 'm', ir.materials.len())?;
            let material = material(term, ir)?;
            ir.materials.push(material);
        }
        "root" => {
            let root = cursor.term()?;
            ir.root = node_id(&root, ir)?;
        }
        "camera" => ir.camera = Some(read_camera(cursor.term()?)?),
        "action" => {
            let action = action(cursor.term()?)?;
            let origin = span(cursor)?;
            ir.actions.push(ActionAt { action, origin });
        }
        word => return Err((start, format!("a statement cannot begin with `{word}`"))),
    }
    Ok(())
}

/// `b3 = term`, where `b3` must be the next of its table.
fn definition<'a>(cursor: &mut Cursor<'a>, prefix: char, next: usize) -> Result<Term<'a>, Fault> {
    cursor.skip_blank();
    let start = cursor.offset;
    if cursor.word()? != format!("{prefix}{next}") {
        return Err((start, format!("expected the next entry, `{prefix}{next}`")));
    }
    cursor.expect("=")?;
    cursor.term()
}

/// `@source:start..end`
fn span(cursor: &mut Cursor) -> Result<Span, Fault> {
    cursor.expect("@")?;
    let source = SourceId(cursor.integer()?);
    cursor.expect(":")?;
    let start = cursor.integer()?;
    cursor.expect("..")?;
    let at = cursor.offset;
    let end = cursor.integer()?;
    if end < start {
        return Err((at, "a span ends before it starts".to_owned()));
    }
    Ok(Span { source, start, end })
}

fn node_id(term: &Term, ir: &Ir) -> Result<NodeId, Fault> {
    match term.kind {
        TermKind::Node(id) if (id as usize) < ir.nodes.len() => Ok(NodeId(id)),
        TermKind::Node(_) => Err((term.offset, "not defined before its use".to_owned())),
        _ => Err((term.offset, "expected a node such as `%0`".to_owned())),
    }
}

pub(crate) fn spectrum(term: Term) -> Result<Spectrum, Fault> {
    let mut args = Args::new(term)?;
    let spectrum = match args.name {
        "constant" => Spectrum::Constant(float(&args.next()?)?),
        "tabulated" => {
            let lambda_nm = float_list(&args.take("lambda_nm")?)?.into();
            Spectrum::Tabulated { lambda_nm, values: float_list(&args.take("values")?)?.into() }
        }
        "blackbody" => Spectrum::Blackbody { kelvin: args.float("kelvin")? },
        "gaussian" => Spectrum::Gaussian {
            center_nm: args.float("center_nm")?,
            sigma_nm: args.float("sigma_nm")?,
            peak: args.float("peak")?,
        },
        "sellmeier" => {
            let (a, b) = (args.float("a")?, float_list(&args.take("b")?)?.into());
            Spectrum::Sellmeier { a, b, c_um2: float_list(&args.take("c_um2")?)?.into() }
        }
        "cauchy" => Spectrum::Cauchy { a: args.float("a")?, b_um2: args.float("b_um2")?, c_um4: args.float("c_um4")? },
        "sigmoid" => Spectrum::Sigmoid { coefficients: floats(&args.next()?)? },
        "absorbance" => Spectrum::Absorbance {
            transmission: Arc::new(spectrum(args.next()?)?),
            thickness: args.float("thickness")?,
        },
        "scaled" => Spectrum::Scaled { factor: float(&args.next()?)?, spectrum: Arc::new(spectrum(args.next()?)?) },
        "product" => Spectrum::Product(Arc::new(spectrum(args.next()?)?), Arc::new(spectrum(args.next()?)?)),
        "sum" => Spectrum::Sum(Arc::new(spectrum(args.next()?)?), Arc::new(spectrum(args.next()?)?)),
        _ => return args.unknown("spectrum"),
    };
    args.end()?;
    Ok(spectrum)
}

pub(crate) fn bsdf(term: Term, contents: &dyn Contents) -> Result<Bsdf, Fault> {
    let mut args = Args::new(term)?;
    if args.name == "varying" {
        return crate::varying_text::varying(args, contents).map(|varying| Bsdf::Varying(varying.into()));
    }
    let bsdf = match args.name {
        "lambert" => Bsdf::Lambert { reflectance: spectrum(args.take("reflectance")?)? },
        "oren_nayar" => {
            Bsdf::OrenNayar { reflectance: spectrum(args.take("reflectance")?)?, sigma: args.float("sigma")? }
        }
        "mirror" => Bsdf::Mirror { reflectance: spectrum(args.take("reflectance")?)? },
        "dielectric" => Bsdf::Dielectric { ior: spectrum(args.take("ior")?)? },
        "conductor" => Bsdf::Conductor { eta: spectrum(args.take("eta")?)?, k: spectrum(args.take("k")?)? },
        "inert" => Bsdf::Inert,
        "thin_dielectric" => Bsdf::ThinDielectric { ior: spectrum(args.take("ior")?)? },
        "phong" => Bsdf::Phong { reflectance: spectrum(args.take("reflectance")?)?, exponent: args.float("exponent")? },
        "rough_conductor" => {
            let (eta, k) = (spectrum(args.take("eta")?)?, spectrum(args.take("k")?)?);
            Bsdf::RoughConductor { eta, k, facets: facets(&mut args)? }
        }
        "rough_dielectric" => Bsdf::RoughDielectric { ior: spectrum(args.take("ior")?)?, facets: facets(&mut args)? },
        "polariser" => {
            Bsdf::Polariser { transmittance: spectrum(args.take("transmittance")?)?, angle: args.float("angle")? }
        }
        "retarder" => Bsdf::Retarder { retardance: args.float("retardance")?, angle: args.float("angle")? },
        "layered" => Bsdf::Layered {
            coat: Arc::new(bsdf(args.take("coat")?, contents)?),
            base: Arc::new(bsdf(args.take("base")?, contents)?),
            absorption: spectrum(args.take("absorption")?)?,
            thickness: args.float("thickness")?,
        },
        "measured" => {
            let path: Arc<str> = args.text("path")?.into();
            let brdf = contents.brdf(&path).ok_or_else(|| (args.offset, format!("there is no table `{path}`")))?;
            Bsdf::Measured { path, brdf }
        }
        "depolariser" => Bsdf::Depolariser { transmittance: spectrum(args.take("transmittance")?)? },
        "fluorescent" => {
            let reflectance = spectrum(args.take("reflectance")?)?;
            let fluorescence = fluorescence(args.take("fluorescence")?)?;
            Bsdf::Fluorescent { reradiation: Reradiation { reflectance, fluorescence }, sigma: args.float("sigma")? }
        }
        _ => return args.unknown("bsdf"),
    };
    args.end()?;
    Ok(bsdf)
}

fn facets(args: &mut Args) -> Result<Facets, Fault> {
    let term = args.take("distribution")?;
    let named = |name: &str| Distribution::ALL.into_iter().find(|distribution| distribution.name() == name);
    let TermKind::Word(name) = term.kind else { return Err((term.offset, "expected a distribution".to_owned())) };
    let distribution = named(name).ok_or_else(|| (term.offset, format!("`{name}` is no distribution")))?;
    Ok(Facets { distribution, alpha: floats(&args.take("alpha")?)? })
}

fn fluorescence(term: Term) -> Result<Fluorescence, Fault> {
    let mut args = Args::new(term)?;
    let fluorescence = match args.name {
        "dye" => Fluorescence::Dye(dye(&mut args)?),
        "matrix" => Fluorescence::Matrix(DonaldsonMatrix {
            excitation_nm: floats(&args.take("excitation_nm")?)?,
            emission_nm: floats(&args.take("emission_nm")?)?,
            columns: args.integer("columns")?,
            entries: float_list(&args.take("entries")?)?.into(),
        }),
        _ => return args.unknown("fluorescence"),
    };
    args.end()?;
    Ok(fluorescence)
}

fn dye(args: &mut Args) -> Result<Dye, Fault> {
    let (absorption, emission) = (spectrum(args.take("absorption")?)?, spectrum(args.take("emission")?)?);
    Ok(Dye { absorption, emission, quantum_yield: args.float("quantum_yield")? })
}

/// `[dye(…), …]`
fn dyes(term: Term) -> Result<Vec<Dye>, Fault> {
    let TermKind::List(items) = term.kind else { return Err((term.offset, "expected a list of dyes".to_owned())) };
    let one = |term: Term| {
        let offset = term.offset;
        match fluorescence(term)? {
            Fluorescence::Dye(dye) => Ok(dye),
            Fluorescence::Matrix(_) => Err((offset, "a medium has dyes only".to_owned())),
        }
    };
    items.into_iter().map(one).collect()
}

fn emitter(term: Term) -> Result<Emitter, Fault> {
    let mut args = Args::new(term)?;
    let thermal = match args.name {
        "emitter" => false,
        "thermal_emitter" => true,
        _ => return args.unknown("emitter"),
    };
    let emitter =
        Emitter { radiance: spectrum(args.take("radiance")?)?, two_sided: args.boolean("two_sided")?, thermal };
    args.end()?;
    Ok(emitter)
}

fn medium(term: Term) -> Result<Medium, Fault> {
    let mut args = Args::new(term)?;
    if args.name != "medium" {
        return args.unknown("medium");
    }
    let medium = Medium {
        absorption: spectrum(args.take("absorption")?)?,
        scattering: spectrum(args.take("scattering")?)?,
        emission: spectrum(args.take("emission")?)?,
        dyes: args.optional("dyes").map_or(Ok(Vec::new()), dyes)?,
        phase: phase_function(args.take("phase")?)?,
        density: density(args.take("density")?)?,
    };
    args.end()?;
    Ok(medium)
}

fn phase_function(term: Term) -> Result<PhaseFunction, Fault> {
    let mut args = Args::new(term)?;
    let phase = match args.name {
        "isotropic" => PhaseFunction::Isotropic,
        "henyey_greenstein" => PhaseFunction::HenyeyGreenstein { g: args.float("g")? },
        "rayleigh" => PhaseFunction::Rayleigh { depolarisation: args.float("depolarisation")? },
        _ => return args.unknown("phase function"),
    };
    args.end()?;
    Ok(phase)
}

fn density(term: Term) -> Result<Density, Fault> {
    let mut args = Args::new(term)?;
    let density = match args.name {
        "uniform" => Density::Uniform,
        "gaussian" => Density::Gaussian { center: args.point("center")?, sigma: args.float("sigma")? },
        "exponential" => Density::Exponential { ground: args.float("ground")?, height: args.float("height")? },
        _ => return args.unknown("density"),
    };
    args.end()?;
    Ok(density)
}

fn material(term: Term, ir: &Ir) -> Result<Material, Fault> {
    let mut args = Args::new(term)?;
    if args.name != "material" {
        return args.unknown("material");
    }
    let bsdf = args.index("bsdf", 'b', ir.bsdfs.len())?;
    let emitter = args.index("emitter", 'e', ir.emitters.len())?;
    let medium = args.index("medium", 'v', ir.media.len())?;
    let inside = args.index("inside", 'b', ir.bsdfs.len())?;
    let mut faces = Vec::new();
    while !args.rest.is_empty() {
        let mut face = Args::new(args.next()?)?;
        if face.name != "face" {
            return face.unknown("face");
        }
        let number = integer(&face.next()?)?;
        faces.push((number, MaterialId(index(&face.next()?, 'm', ir.materials.len())?)));
        face.end()?;
    }
    Ok(Material { bsdf, emitter, medium, inside, faces })
}

fn node_kind(mut args: Args, ir: &Ir, contents: &dyn Contents) -> Result<NodeKind, Fault> {
    let kind = match args.name {
        "union" => NodeKind::Union(operands(&mut args, ir)?),
        "intersection" => NodeKind::Intersection(operands(&mut args, ir)?),
        "difference" => NodeKind::Difference(operands(&mut args, ir)?),
        "group" => NodeKind::Group(operands(&mut args, ir)?),
        "transform" => {
            let child = node_id(&args.next()?, ir)?;
            NodeKind::Transform { parent_from_child: Box::new(args.map()?), child }
        }
        "with" => attributes(&mut args, ir, Precedence::Inner)?,
        "override" => attributes(&mut args, ir, Precedence::Outer)?,
        _ => {
            if let Some(light) = light(&mut args)? {
                NodeKind::Light(Box::new(light))
            } else if let Some(environment) = environment(&mut args, ir, contents)? {
                NodeKind::Environment(Box::new(environment))
            } else {
                NodeKind::Leaf(Box::new(leaf(&mut args, ir, contents)?))
            }
        }
    };
    args.end()?;
    Ok(kind)
}

fn operands(args: &mut Args, ir: &Ir) -> Result<Vec<NodeId>, Fault> {
    let mut operands = Vec::with_capacity(args.rest.len());
    while !args.rest.is_empty() {
        operands.push(node_id(&args.next()?, ir)?);
    }
    Ok(operands)
}

fn attributes(args: &mut Args, ir: &Ir, precedence: Precedence) -> Result<NodeKind, Fault> {
    let child = node_id(&args.next()?, ir)?;
    let bsdf = args.index("bsdf", 'b', ir.bsdfs.len())?;
    let emitter = args.index("emitter", 'e', ir.emitters.len())?;
    let medium = args.index("medium", 'v', ir.media.len())?;
    let cut = match args.optional("cut") {
        None => None,
        Some(Term { kind: TermKind::Word("inherit"), .. }) => Some(CutRule::Inherit),
        Some(term) => Some(CutRule::Bsdf(index(&term, 'b', ir.bsdfs.len())?)),
    };
    let face = args.optional("face").map(|term| integer(&term)).transpose()?;
    Ok(NodeKind::Attributes { attributes: Attributes { bsdf, emitter, medium, cut, face }, precedence, child })
}

fn leaf(args: &mut Args, ir: &Ir, contents: &dyn Contents) -> Result<Leaf, Fault> {
    let solid = if args.name == "mesh_solid" { Some(mesh_solid(args, contents)?) } else { shape(args)? };
    if let Some(shape) = solid {
        let parent_from_object = args.map()?;
        let material = args.index("material", 'm', ir.materials.len())?.map(MaterialId);
        return Ok(Leaf::Solid { shape, parent_from_object, material });
    }
    let surface = surface(args, contents)?;
    let parent_from_object = args.map()?;
    let material = args.index("material", 'm', ir.materials.len())?.map(MaterialId);
    Ok(Leaf::Surface { surface, parent_from_object, material })
}

fn mesh_solid(args: &mut Args, contents: &dyn Contents) -> Result<Shape, Fault> {
    let (path, mesh) = mesh(args, contents)?;
    match ClosedMesh::new(path, (*mesh).clone()) {
        Ok((mesh, _)) => Ok(Shape::Mesh(Arc::new(mesh))),
        Err(error) => Err((args.offset, error.to_string())),
    }
}

/// The path of a mesh, and its content.
fn mesh(args: &mut Args, contents: &dyn Contents) -> Result<(Arc<str>, Arc<TriangleMesh>), Fault> {
    let path: Arc<str> = args.text("path")?.into();
    let mesh = contents.mesh(&path).ok_or_else(|| (args.offset, format!("there is no mesh `{path}`")))?;
    Ok((path, mesh))
}

fn surface(args: &mut Args, contents: &dyn Contents) -> Result<Surface, Fault> {
    fn corners<const N: usize>(args: &mut Args) -> Result<[DVec3; N], Fault> {
        let mut corners = [DVec3::ZERO; N];
        for corner in &mut corners {
            *corner = DVec3::from_array(floats(&args.next()?)?);
        }
        Ok(corners)
    }
    Ok(match args.name {
        "triangle" => Surface::Triangle(corners(args)?),
        "quad" => Surface::Quad(corners(args)?),
        "rectangle" => Surface::Rectangle { width: args.float("width")?, depth: args.float("depth")? },
        "disk" => Surface::Disk { radius: args.float("radius")? },
        "plane" => Surface::Plane,
        "mesh" => {
            let (path, mesh) = mesh(args, contents)?;
            Surface::Mesh { path, mesh }
        }
        _ => return args.unknown("node"),
    })
}

fn sampling(args: &mut Args) -> Result<Sampling, Fault> {
    let sampler = args.optional("sampler").map(|term| named(&term, &Sampler::ALL, Sampler::name)).transpose()?;
    let optional = |args: &mut Args, name: &str| args.optional(name).map(|term| float(&term)).transpose();
    Ok(Sampling {
        samples: args.integer("samples")?,
        seed: args.integer("seed")?,
        sampler: sampler.unwrap_or_default(),
        noise: optional(args, "noise")?,
        time_limit: optional(args, "time_limit")?,
    })
}

/// An argument that may be left out where it is false.
fn flag(args: &mut Args, name: &str) -> Result<bool, Fault> {
    if args.rest.iter().any(|(given, _)| *given == Some(name)) { args.boolean(name) } else { Ok(false) }
}

fn action(term: Term) -> Result<Action, Fault> {
    let mut args = Args::new(term)?;
    let action = match args.name {
        "accelerate" => Action::Accelerate { strategy: strategy(&args.take("strategy")?)? },
        "bounding_boxes" => Action::BoundingBoxes,
        "collect_lights" => Action::CollectLights,
        "path_trace" => Action::PathTrace(PathTrace {
            sampling: sampling(&mut args)?,
            features: flag(&mut args, "features")?,
            max_depth: args.integer("max_depth")?,
            wavelengths: wavelengths(&args.take("wavelengths")?)?,
            band_nm: args.float("band_nm")?,
            observer: observer(&args.take("observer")?)?,
            polarised: args.boolean("polarised")?,
        }),
        "ambient_occlusion" => {
            Action::AmbientOcclusion { distance: args.float("distance")?, sampling: sampling(&mut args)? }
        }
        "preview" => Action::Preview { sampling: sampling(&mut args)?, features: flag(&mut args, "features")? },
        "tone_map" => {
            let (tone, slice_nm) = tone_map(&mut args)?;
            Action::ToneMap { tone, slice_nm }
        }
        "write_exr" => Action::WriteExr { path: args.text("path")? },
        "write_png" => Action::WritePng { path: args.text("path")?, sixteen_bit: sixteen_bit(&mut args)? },
        "write_tiff" => Action::WriteTiff { path: args.text("path")?, sixteen_bit: sixteen_bit(&mut args)? },
        "write_csv" => Action::WriteCsv { path: args.text("path")? },
        "dup" => Action::Dup,
        "swap" => Action::Swap,
        "drop" => Action::Drop,
        "over" => Action::Over,
        _ => match image_action(&mut args)? {
            Some(action) => Action::Image(action),
            None => return args.unknown("action"),
        },
    };
    args.end()?;
    Ok(action)
}

fn sixteen_bit(args: &mut Args) -> Result<bool, Fault> {
    if args.rest.is_empty() { Ok(false) } else { args.boolean("sixteen_bit") }
}

fn strategy(term: &Term) -> Result<Strategy, Fault> {
    named(term, &Strategy::ALL, Strategy::name)
}

fn wavelengths(term: &Term) -> Result<WavelengthRange, Fault> {
    let [min_nm, max_nm] = floats(term)?;
    WavelengthRange::new(min_nm, max_nm).ok_or_else(|| (term.offset, "no range of wavelengths".to_owned()))
}

fn observer(term: &Term) -> Result<Observer, Fault> {
    named(term, &Observer::ALL, Observer::name)
}

#[cfg(test)]
mod tests;
