//! The registry of builtins: one table that the checker, the evaluator and the reference manual all read.
//!
//! A family per file. Parameters are in the order of positional arguments; the shape that a transform or attribute
//! applies to comes first, so that `shape |> f(…)` works.

mod actions;
mod cameras;
mod csg;
mod filters;
mod fluorescence;
mod image_actions;
mod lights;
mod lists;
mod materials;
mod math;
mod media;
mod mixtures;
mod outlines;
mod param;
mod solids;
mod spectra;
mod surface_models;
mod surfaces;
mod text;
mod textures;
mod transforms;
mod vectors;

use std::sync::OnceLock;

use rustc_hash::FxHashMap;

use crate::code::Site;
use crate::eval::{Eval, Machine};
use crate::types::{Class, Type};
use crate::value::Value;

pub use csg::flatten as flatten_nodes;
pub use lists::compare;
pub use param::{Constraint, Default, Param};
pub use surfaces::{asset_failure, shortened};

/// Index into [`Registry::builtins`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct BuiltinId(pub u32);

/// The module of what needs no import.
pub const PRELUDE: &str = "prelude";

/// No module that can be imported: what builtins of the prelude become when an argument varies over a surface.
pub const TEXTURE_OVERLOADS: &str = "texture";

/// What a builtin does with its arguments, one per parameter; a variadic one gets the rest as a list.
pub type Run = fn(&mut Machine<'_>, &[Value], &Site) -> Eval;

#[derive(Clone, Copy)]
pub enum Implementation {
    Now(Run),
    /// Specified, checked, not built yet: what is missing, as in "… is not implemented yet".
    Later(&'static str),
}

pub struct Builtin {
    pub name: &'static str,
    pub family: &'static str,
    /// [`PRELUDE`] or `std.…`.
    pub module: &'static str,
    pub doc: &'static str,
    pub params: Vec<Param>,
    /// The last parameter takes any number of arguments, by position.
    pub variadic: bool,
    /// Classes of the signature's type variables.
    pub bounds: Vec<Class>,
    pub result: Type,
    pub implementation: Implementation,
}

impl Builtin {
    fn new(name: &'static str, doc: &'static str) -> Builtin {
        Builtin {
            name,
            family: "",
            module: PRELUDE,
            doc,
            params: Vec::new(),
            variadic: false,
            bounds: Vec::new(),
            result: Type::unit(),
            implementation: Implementation::Later(name),
        }
    }

    fn param(mut self, param: Param) -> Builtin {
        self.params.push(param);
        self
    }

    fn variadic(mut self, param: Param) -> Builtin {
        self.params.push(param);
        self.variadic = true;
        self
    }

    /// Declares the next type variable.
    fn var(mut self, class: Class) -> Builtin {
        self.bounds.push(class);
        self
    }

    fn module(mut self, module: &'static str) -> Builtin {
        self.module = module;
        self
    }

    fn runs(mut self, result: Type, run: Run) -> Builtin {
        self.result = result;
        self.implementation = Implementation::Now(run);
        self
    }

    fn later(mut self, result: Type, what: &'static str) -> Builtin {
        self.result = result;
        self.implementation = Implementation::Later(what);
        self
    }

    /// How many arguments must be given.
    pub fn required(&self) -> usize {
        self.params.iter().filter(|param| matches!(param.default, Default::Required)).count()
    }
}

/// A named value of the prelude.
pub struct Constant {
    pub name: &'static str,
    pub doc: &'static str,
    pub ty: Type,
    pub value: Value,
}

/// The builtins of one file.
type Family = fn() -> Vec<Builtin>;

pub struct Registry {
    pub builtins: Vec<Builtin>,
    pub constants: Vec<Constant>,
    by_name: FxHashMap<(&'static str, &'static str), BuiltinId>,
}

impl Registry {
    /// The table, built on first use.
    pub fn get() -> &'static Registry {
        static REGISTRY: OnceLock<Registry> = OnceLock::new();
        REGISTRY.get_or_init(Registry::build)
    }

    fn build() -> Registry {
        let families: [(&'static str, Family); 17] = [
            ("Solids", solids::builtins),
            ("Surfaces", surfaces::builtins),
            ("Boolean operations", csg::builtins),
            ("Transforms", transforms::builtins),
            ("Attributes and materials", materials::builtins),
            ("Participating media", media::builtins),
            ("Spectra", spectra::builtins),
            ("Lights and environments", lights::builtins),
            ("Cameras", cameras::builtins),
            ("Reconstruction filters", filters::builtins),
            ("Actions", actions::builtins),
            ("Lists", lists::builtins),
            ("Numbers", math::builtins),
            ("Vectors", vectors::builtins),
            ("Text and random numbers", text::builtins),
            ("Textures", textures::builtins),
            ("Functions of textures", textures::overloads),
        ];
        let mut builtins = Vec::new();
        for (family, list) in families {
            builtins.extend(list().into_iter().map(|builtin| Builtin { family, ..builtin }));
        }
        let by_name = builtins
            .iter()
            .enumerate()
            .map(|(i, builtin)| ((builtin.module, builtin.name), BuiltinId(i as u32)))
            .collect();
        Registry { builtins, constants: math::constants(), by_name }
    }

    pub fn builtin(&self, id: BuiltinId) -> &Builtin {
        &self.builtins[id.0 as usize]
    }

    pub fn find(&self, module: &str, name: &str) -> Option<BuiltinId> {
        self.by_name.get(&(module, name)).copied()
    }

    /// What a builtin of the prelude becomes when an argument varies over a surface.
    pub fn texture_overload(&self, builtin: &Builtin) -> Option<(BuiltinId, &Builtin)> {
        let id = self.find(TEXTURE_OVERLOADS, builtin.name).filter(|_| builtin.module == PRELUDE)?;
        Some((id, self.builtin(id)))
    }

    /// A builtin of the prelude that a std module also gives, for it belongs to its subject.
    pub fn find_prelude_of(&self, module: &str, name: &str) -> Option<BuiltinId> {
        let family = match module {
            "std.material" => "Attributes and materials",
            "std.medium" => "Participating media",
            "std.spectra" => "Spectra",
            "std.light" => "Lights and environments",
            "std.solid" => "Solids",
            "std.cameras" => "Cameras",
            "std.action" => "Actions",
            "std.texture" => "Textures",
            _ => return None,
        };
        self.find(PRELUDE, name).filter(|id| self.builtin(*id).family == family)
    }

    pub fn constant(&self, name: &str) -> Option<&Constant> {
        self.constants.iter().find(|constant| constant.name == name)
    }

    /// Names that `module` gives.
    pub fn names(&self, module: &str) -> impl Iterator<Item = &'static str> {
        let constants = self.constants.iter().filter(move |_| module == PRELUDE).map(|constant| constant.name);
        self.builtins
            .iter()
            .filter(move |builtin| builtin.module == module)
            .map(|builtin| builtin.name)
            .chain(constants)
    }

    /// The std module that gives `name`, if one does.
    pub fn std_module_of(&self, name: &str) -> Option<&'static str> {
        self.builtins
            .iter()
            .find(|builtin| builtin.name == name && builtin.module.starts_with("std."))
            .map(|b| b.module)
    }
}

/// Names that mean a value where a type of few values is wanted: `exposure: auto`.
pub fn choices(ty: &Type) -> &'static [(&'static str, Value)] {
    const STRATEGIES: [(&str, Value); Strategy::ALL.len()] = [
        (Strategy::Local.name(), Value::Strategy(Strategy::Local)),
        (Strategy::Native.name(), Value::Strategy(Strategy::Native)),
        (Strategy::Collect.name(), Value::Strategy(Strategy::Collect)),
        (Strategy::Tree.name(), Value::Strategy(Strategy::Tree)),
        (Strategy::Kd.name(), Value::Strategy(Strategy::Kd)),
        (Strategy::Hybrid.name(), Value::Strategy(Strategy::Hybrid)),
        (Strategy::Incremental.name(), Value::Strategy(Strategy::Incremental)),
    ];
    const OBSERVERS: [(&str, Value); 4] = [
        (Observer::ALL[0].name(), Value::Observer(Observer::ALL[0])),
        (Observer::ALL[1].name(), Value::Observer(Observer::ALL[1])),
        (Observer::ALL[2].name(), Value::Observer(Observer::ALL[2])),
        (Observer::ALL[3].name(), Value::Observer(Observer::ALL[3])),
    ];
    const DISTRIBUTIONS: [(&str, Value); Distribution::ALL.len()] = [
        (Distribution::Ggx.name(), Value::Distribution(Distribution::Ggx)),
        (Distribution::Beckmann.name(), Value::Distribution(Distribution::Beckmann)),
        (Distribution::Blinn.name(), Value::Distribution(Distribution::Blinn)),
    ];
    const SKY_MODELS: [(&str, Value); SkyModel::ALL.len()] = [
        (SkyModel::HosekWilkie.name(), Value::SkyModel(SkyModel::HosekWilkie)),
        (SkyModel::Preetham.name(), Value::SkyModel(SkyModel::Preetham)),
    ];
    const ACROSS: [(&str, Value); Across::ALL.len()] = [
        (Across::Shorter.name(), Value::Across(Across::Shorter)),
        (Across::Horizontal.name(), Value::Across(Across::Horizontal)),
        (Across::Vertical.name(), Value::Across(Across::Vertical)),
        (Across::Diagonal.name(), Value::Across(Across::Diagonal)),
    ];
    const MAPPINGS: [(&str, Value); FisheyeMapping::ALL.len()] = [
        (FisheyeMapping::Equidistant.name(), Value::FisheyeMapping(FisheyeMapping::Equidistant)),
        (FisheyeMapping::EqualArea.name(), Value::FisheyeMapping(FisheyeMapping::EqualArea)),
    ];
    const SAMPLERS: [(&str, Value); Sampler::ALL.len()] = [
        (Sampler::Sobol.name(), Value::Sampler(Sampler::Sobol)),
        (Sampler::Halton.name(), Value::Sampler(Sampler::Halton)),
        (Sampler::Independent.name(), Value::Sampler(Sampler::Independent)),
    ];
    use arsc_ir::{Across, Distribution, Exposure, FisheyeMapping, Observer, Sampler, SkyModel, Strategy};
    match ty {
        Type::Exposure => &[("auto", Value::Exposure(Exposure::Auto))],
        Type::Across => &ACROSS,
        Type::FisheyeMapping => &MAPPINGS,
        Type::Sampler => &SAMPLERS,
        Type::Observer => &OBSERVERS,
        Type::Strategy => &STRATEGIES,
        Type::Distribution => &DISTRIBUTIONS,
        Type::SkyModel => &SKY_MODELS,
        _ => &[],
    }
}
