//! Actions: what is done with the scene. Stack effects were checked by the compiler.

/// How CSG is traced.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Strategy {
    /// Localised cells of each solid as Embree primitives.
    Local,
    /// Every leaf of a solid, then the whole tree: the slow, obvious oracle.
    Tree,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Exposure {
    /// From the log-average luminance of the image.
    Auto,
    /// In stops: radiances are multiplied by 2^ev.
    Ev(f64),
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
    PathTrace {
        samples: u32,
        max_depth: u32,
        seed: u64,
    },
    /// `image<spectral> → image<display>`
    ToneMap {
        exposure: Exposure,
    },
    /// `image<spectral> → image<spectral>`
    WriteExr {
        path: String,
    },
    /// `image<display> → image<display>`
    WritePng {
        path: String,
    },
    Dup,
    Swap,
    Drop,
    Over,
}
