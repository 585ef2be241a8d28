//! Actions: what is done with the scene. Stack effects were checked by the compiler.

use arsc_spectral::tone::ToneMap;
use arsc_spectral::{Observer, WavelengthRange};

use crate::ImageAction;

/// How CSG is traced; all give the same picture (docs/csg.md).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Strategy {
    /// Localised cells of each solid as Embree primitives.
    Local,
    /// One KD tree over all leaves of the scene, without Embree; whole trees.
    Native,
    /// Embree over leaves, whole trees afterwards.
    Collect,
    /// Solids as Embree primitives, their operator trees with boxes.
    Tree,
    /// Solids as Embree primitives, a KD tree over the leaves of each.
    Kd,
    /// `Kd` for solids with mesh operands, else `Tree`.
    Hybrid,
    /// `Kd`, evaluating only what changes along the ray.
    Incremental,
}

impl Strategy {
    pub const ALL: [Strategy; 7] = [
        Strategy::Local,
        Strategy::Native,
        Strategy::Collect,
        Strategy::Tree,
        Strategy::Kd,
        Strategy::Hybrid,
        Strategy::Incremental,
    ];

    /// As scripts write it.
    pub const fn name(self) -> &'static str {
        match self {
            Strategy::Local => "local",
            Strategy::Native => "native",
            Strategy::Collect => "collect",
            Strategy::Tree => "tree",
            Strategy::Kd => "kd",
            Strategy::Hybrid => "hybrid",
            Strategy::Incremental => "incremental",
        }
    }
}

/// What `path_trace` is asked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathTrace {
    /// Camera paths per pixel.
    pub samples: u32,
    pub max_depth: u32,
    pub seed: u64,
    pub wavelengths: WavelengthRange,
    /// Width of the picture's bands, nm; positive.
    pub band_nm: f64,
    pub observer: Observer,
    /// Keep track of polarisation.
    pub polarised: bool,
}

impl Default for PathTrace {
    fn default() -> PathTrace {
        PathTrace {
            samples: 64,
            max_depth: 20,
            seed: 0,
            wavelengths: WavelengthRange::VISIBLE,
            band_nm: 10.0,
            observer: Observer::Cie1931,
            polarised: false,
        }
    }
}

#[derive(Clone, Debug, PartialEq)]
pub enum Action {
    /// `scene → scene`: names the strategy for what follows.
    Accelerate {
        strategy: Strategy,
    },
    /// `scene → scene`: prints the bounds of the scene and of its solids.
    BoundingBoxes,
    /// `scene → scene`: prints the light sources and their powers.
    CollectLights,
    /// `scene → scene image<spectral>`
    PathTrace(PathTrace),
    /// `image<spectral> → image<display>`
    ToneMap {
        tone: ToneMap,
        /// One wavelength in grey instead of the colours.
        slice_nm: Option<f64>,
    },
    Image(ImageAction),
    /// `image<spectral> → image<spectral>`
    WriteExr {
        path: String,
    },
    /// `image<display> → image<display>`
    WritePng {
        path: String,
        sixteen_bit: bool,
    },
    /// `image<display> → image<display>`
    WriteTiff {
        path: String,
        sixteen_bit: bool,
    },
    /// `image<spectral> → image<spectral>`: the bands as text.
    WriteCsv {
        path: String,
    },
    Dup,
    Swap,
    Drop,
    Over,
}

impl Action {
    /// The file that it writes, below the output folder.
    pub fn output(&self) -> Option<&String> {
        match self {
            Action::WriteExr { path }
            | Action::WritePng { path, .. }
            | Action::WriteTiff { path, .. }
            | Action::WriteCsv { path } => Some(path),
            _ => None,
        }
    }
}
