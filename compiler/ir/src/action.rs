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

/// How the samples of a pixel are spread.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Sampler {
    #[default]
    Sobol,
    Halton,
    Independent,
}

impl Sampler {
    pub const ALL: [Sampler; 3] = [Sampler::Sobol, Sampler::Halton, Sampler::Independent];

    /// As scripts write it.
    pub const fn name(self) -> &'static str {
        match self {
            Sampler::Sobol => "sobol",
            Sampler::Halton => "halton",
            Sampler::Independent => "independent",
        }
    }
}

/// How many samples, and which.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sampling {
    /// Camera paths per pixel; with a noise threshold or a time limit, at most.
    pub samples: u32,
    pub seed: u64,
    pub sampler: Sampler,
    /// Relative noise that is enough; positive.
    pub noise: Option<f64>,
    /// Seconds after which the render ends with what it has; positive.
    pub time_limit: Option<f64>,
}

impl Sampling {
    /// So many samples of the usual kind.
    pub const fn of(samples: u32) -> Sampling {
        Sampling { samples, seed: 0, sampler: Sampler::Sobol, noise: None, time_limit: None }
    }
}

/// What `path_trace` is asked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathTrace {
    pub sampling: Sampling,
    pub max_depth: u32,
    pub wavelengths: WavelengthRange,
    /// Width of the picture's bands, nm; positive.
    pub band_nm: f64,
    pub observer: Observer,
    /// Keep track of polarisation.
    pub polarised: bool,
    /// Channels of what is seen first beside the picture.
    pub features: bool,
}

impl Default for PathTrace {
    fn default() -> PathTrace {
        PathTrace {
            sampling: Sampling::of(64),
            max_depth: 20,
            wavelengths: WavelengthRange::VISIBLE,
            band_nm: 10.0,
            observer: Observer::Cie1931,
            polarised: false,
            features: false,
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
    /// `scene → scene image<spectral>`: how open the space above surfaces is within a distance.
    AmbientOcclusion {
        distance: f64,
        sampling: Sampling,
    },
    /// `scene → scene image<spectral>`: surfaces in their colours, lit from the camera.
    Preview {
        sampling: Sampling,
        features: bool,
    },
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
