//! Attributes: what covers a surface, and attaching it.

use arsc_diagnostics::codes::sema as codes;
use arsc_ir::{Attributes, Bsdf, CutRule, Emitter, Leaf, NodeId, NodeKind, Parameter, Precedence};

use super::mixtures::with_parameters;
use super::{Builtin, Param};
use crate::code::Site;
use crate::eval::{Eval, Machine};
use crate::types::SpectrumKind::{Emission, Extinction, Reflectance, RefractiveIndex};
use crate::types::Type::{self, Bool, Float, Solid, Spectrum, Texture, Var};
use crate::types::{Class, TextureKind};
use crate::value::Value;

pub(super) const MATERIAL: &str = "std.material";

pub fn builtins() -> Vec<Builtin> {
    let mut list = attaching();
    list.extend(bsdfs());
    list.push(super::fluorescence::fluorescent());
    list.extend(super::surface_models::builtins());
    list.extend(super::mixtures::builtins());
    list.extend(super::mixtures::reliefs());
    list
}

fn attaching() -> Vec<Builtin> {
    let on = |name, doc| {
        Builtin::new(name, doc)
            .var(Class::Geometry)
            .param(Param::new("shape", Var(0), "what it applies to, with all its parts"))
            .variadic(Param::new(
                "attributes",
                Type::AnyOf(Class::Attribute),
                "bsdfs, emitters, media, or lists of them",
            ))
    };
    vec![
        on("with", "Attaches a bsdf, an emitter, a medium, or several of these. Where parts have their own, the innermost wins.")
            .runs(Var(0), |m, args, site| attach(m, args, Precedence::Inner, site)),
        on("override", "Attaches from outside: wins over everything that the parts have.")
            .runs(Var(0), |m, args, site| attach(m, args, Precedence::Outer, site)),
        Builtin::new(
            "with_face",
            "Attaches a bsdf or an emitter to one face of a primitive, or of all primitives in a solid: it wins there over \
             what `with` gives the whole. The descriptions of the solids number their faces.",
        )
        .param(Param::new("solid", Solid, "what it applies to"))
        .param(Param::new("face", Type::Int, "number of the face, from 0").non_negative())
        .variadic(Param::new("attributes", Type::AnyOf(Class::Attribute), "bsdfs, emitters, or lists of them"))
        .runs(Solid, with_face),
        Builtin::new("cut_with", "Covers the walls that other solids cut into this one by subtraction.")
            .param(Param::new("solid", Solid, "solid that will be cut"))
            .param(Param::new("bsdf", Type::Bsdf, "what covers the walls"))
            .runs(Solid, |m, args, site| {
                let Some(bsdf) = args[1].as_attributes().bsdf else { return Ok(args[0].clone()) };
                let attributes = Attributes { cut: Some(CutRule::Bsdf(bsdf)), ..Attributes::default() };
                apply(m, &args[0], attributes, Precedence::Inner, site)
            }),
        Builtin::new("inherit", "Walls that other solids cut into this one show its own material, not theirs.")
            .param(Param::new("solid", Solid, "solid that will be cut"))
            .runs(Solid, |m, args, site| {
                let attributes = Attributes { cut: Some(CutRule::Inherit), ..Attributes::default() };
                apply(m, &args[0], attributes, Precedence::Inner, site)
            }),
        Builtin::new("emitter", "Lambertian emission from the outer side of a surface.")
            .param(Param::new("radiance", Spectrum(Emission), "W m^-2 sr^-1 nm^-1"))
            .param(Param::new("two_sided", Bool, "open surfaces only: both sides emit").bool(false))
            .runs(Type::Emitter, |m, args, site| {
                m.lint_emission(&args[0], site, 0);
                let radiance = args[0].as_spectrum().as_ref().clone();
                let id = m.emitter(Emitter { radiance, two_sided: args[1].as_bool(), thermal: false });
                Ok(Value::Attributes(Attributes { emitter: Some(id), ..Attributes::default() }))
            }),
        Builtin::new("glow", "Thermal emission: Planck's law times what the surface's own bsdf absorbs, by direction.")
            .param(Param::new("temperature", Float, "kelvin").positive())
            .param(Param::new("two_sided", Bool, "open surfaces only: both sides emit").bool(false))
            .runs(Type::Emitter, |m, args, _| {
                let radiance = arsc_ir::Spectrum::Blackbody { kelvin: args[0].as_float() };
                let id = m.emitter(Emitter { radiance, two_sided: args[1].as_bool(), thermal: true });
                Ok(Value::Attributes(Attributes { emitter: Some(id), ..Attributes::default() }))
            }),
    ]
}

fn attach(m: &mut Machine<'_>, args: &[Value], precedence: Precedence, site: &Site) -> Eval {
    let mut bundle = Attributes::default();
    merge(m, &args[1], &mut bundle, site)?;
    if bundle == Attributes::default() {
        return Ok(args[0].clone());
    }
    apply(m, &args[0], bundle, precedence, site)
}

fn with_face(m: &mut Machine<'_>, args: &[Value], site: &Site) -> Eval {
    let mut bundle = Attributes::default();
    merge(m, &args[2], &mut bundle, site)?;
    if bundle.medium.is_some() {
        let message = "a medium fills a solid, not one of its faces";
        return Err(Box::new(site.fail(codes::CONFLICTING_ATTRIBUTES, message).help("attach it by `with`")));
    }
    let face = u32::try_from(args[1].as_int()).unwrap_or(u32::MAX);
    if let Some(count) = face_count(m, args[0].as_node())
        && face >= count
    {
        let label = if count == 1 { "has one face, 0".to_owned() } else { format!("faces go from 0 to {}", count - 1) };
        return Err(site.fail_arg(1, codes::OUT_OF_RANGE, "this solid has no such face", label));
    }
    if bundle == Attributes::default() {
        return Ok(args[0].clone());
    }
    apply(m, &args[0], Attributes { face: Some(face), ..bundle }, Precedence::Inner, site)
}

/// Number of faces of a primitive, placed and covered or not.
fn face_count(m: &Machine<'_>, mut node: NodeId) -> Option<u32> {
    loop {
        match &m.nodes[node.index()].kind {
            NodeKind::Transform { child, .. } | NodeKind::Attributes { child, .. } => node = *child,
            NodeKind::Leaf(leaf) => match &**leaf {
                Leaf::Solid { shape, .. } => return Some(shape.face_count()),
                Leaf::Surface { .. } => return None,
            },
            _ => return None,
        }
    }
}

/// Collects nested lists of attributes into one bundle.
fn merge(m: &mut Machine<'_>, value: &Value, bundle: &mut Attributes, site: &Site) -> Eval<()> {
    if let Value::List(list) = value {
        m.spend_elements(list.len(), site.span)?;
        return list.iter().try_for_each(|element| merge(m, element, bundle, site));
    }
    let new = value.as_attributes();
    let twice = |what| {
        Box::new(
            site.fail(codes::CONFLICTING_ATTRIBUTES, format!("two {what} are attached at once"))
                .help("attach one; `override` replaces what parts already have"),
        )
    };
    if new.bsdf.is_some() && bundle.bsdf.is_some() {
        return Err(twice("bsdfs"));
    }
    if new.emitter.is_some() && bundle.emitter.is_some() {
        return Err(twice("emitters"));
    }
    if new.medium.is_some() && bundle.medium.is_some() {
        return Err(twice("media"));
    }
    bundle.bsdf = bundle.bsdf.or(new.bsdf);
    bundle.emitter = bundle.emitter.or(new.emitter);
    bundle.medium = bundle.medium.or(new.medium);
    bundle.cut = bundle.cut.or(new.cut);
    Ok(())
}

fn apply(m: &mut Machine<'_>, value: &Value, attributes: Attributes, precedence: Precedence, site: &Site) -> Eval {
    if let Value::List(list) = value {
        m.spend_elements(list.len(), site.span)?;
        let covered: Eval<Vec<Value>> = list.iter().map(|x| apply(m, x, attributes, precedence, site)).collect();
        return covered.map(Value::list);
    }
    if attributes.medium.is_some() && is_surface(m, value.as_node()) {
        let failure = site.fail(codes::NOT_A_SOLID, "a medium fills solids, but this surface has no inside");
        return Err(Box::new(failure.help("use a closed solid, such as `box(…)` or `half_space()`")));
    }
    let kind = NodeKind::Attributes { attributes, precedence, child: value.as_node() };
    m.node(kind, site.span).map(Value::Node)
}

/// An open surface, placed and covered or not.
fn is_surface(m: &Machine<'_>, mut node: NodeId) -> bool {
    loop {
        match &m.nodes[node.index()].kind {
            NodeKind::Transform { child, .. } | NodeKind::Attributes { child, .. } => node = *child,
            NodeKind::Leaf(leaf) => return matches!(**leaf, Leaf::Surface { .. }),
            _ => return false,
        }
    }
}

pub(super) fn bsdf(m: &mut Machine<'_>, bsdf: Bsdf) -> Eval {
    let id = m.bsdf(bsdf);
    Ok(Value::Attributes(Attributes { bsdf: Some(id), ..Attributes::default() }))
}

fn bsdfs() -> Vec<Builtin> {
    let of = |name, doc| Builtin::new(name, doc).module(MATERIAL);
    let reflectance = || Param::new("reflectance", varying_reflectance(), "share of light that is scattered back");
    vec![
        of("lambert", "Ideal diffuse reflection.").param(reflectance()).runs(Type::Bsdf, |m, args, site| {
            let mut parameters = Vec::new();
            let reflectance = m.reflectance_parameter(&args[0], &mut parameters, site, 0)?;
            with_parameters(m, Bsdf::Lambert { reflectance }, parameters)
        }),
        of("oren_nayar", "Rough diffuse reflection (Oren and Nayar 1994).")
            .param(reflectance())
            .param(
                Param::new("sigma", Texture(TextureKind::Angle), "standard deviation of the facets' slope")
                    .degrees(17.0)
                    .degrees_below(90.0),
            )
            .runs(Type::Bsdf, |m, args, site| {
                let mut parameters = Vec::new();
                let reflectance = m.reflectance_parameter(&args[0], &mut parameters, site, 0)?;
                let at = site.args[1];
                let sigma = m.number_parameter(&args[1], 0.0, Parameter::Sigma, &mut parameters, at)?;
                with_parameters(m, Bsdf::OrenNayar { reflectance, sigma }, parameters)
            }),
        of("mirror", "Ideal mirror, the same at every angle.")
            .param(reflectance().default_value("1", Value::spectrum(arsc_ir::Spectrum::Constant(1.0))))
            .runs(Type::Bsdf, |m, args, site| {
                let mut parameters = Vec::new();
                let reflectance = m.reflectance_parameter(&args[0], &mut parameters, site, 0)?;
                with_parameters(m, Bsdf::Mirror { reflectance }, parameters)
            }),
        of("dielectric", "Smooth clear glass: this index inside, vacuum outside.")
            .param(
                Param::new("ior", Spectrum(RefractiveIndex), "refractive index")
                    .default_value("1.5", Value::spectrum(arsc_ir::Spectrum::Constant(1.5))),
            )
            .runs(Type::Bsdf, |m, args, site| {
                m.require_positive(&args[0], "a refractive index", site, 0)?;
                bsdf(m, Bsdf::Dielectric { ior: args[0].as_spectrum().as_ref().clone() })
            }),
        of("conductor", "Smooth metal of complex refractive index eta + i k.")
            .param(Param::new("eta", Spectrum(RefractiveIndex), "real part"))
            .param(Param::new("k", Spectrum(Extinction), "imaginary part"))
            .runs(Type::Bsdf, |m, args, site| {
                m.require_positive(&args[0], "a refractive index", site, 0)?;
                let (eta, k) = (args[0].as_spectrum().as_ref().clone(), args[1].as_spectrum().as_ref().clone());
                bsdf(m, Bsdf::Conductor { eta, k })
            }),
        of("inert", "No interface: light passes straight on. Solids with a medium and without a bsdf have it.")
            .runs(Type::Bsdf, |m, _, _| bsdf(m, Bsdf::Inert)),
    ]
}

/// The type of reflectances that may vary over the surface.
pub(super) fn varying_reflectance() -> Type {
    Texture(TextureKind::Spectrum(Reflectance))
}
