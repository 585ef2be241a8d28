//! Why a scene cannot be built.

use arsc_geometry::PlaceError;

/// Geometry that cannot be traced. The compiler rejects such scenes with better words; this is the last line.
#[derive(Debug, thiserror::Error)]
pub enum AccelError {
    #[error("solid {solid}: leaf {leaf} cannot be placed")]
    Leaf { solid: u32, leaf: u32, source: PlaceError },
    #[error("solid {solid}: the tree names leaf {leaf}, but there are {leaves}")]
    LeafOutOfRange { solid: u32, leaf: u32, leaves: usize },
    #[error("surface {surface}: {reason}")]
    Surface { surface: u32, reason: &'static str },
    #[error("instance {instance}: the map has no finite inverse")]
    Instance { instance: u32 },
    #[error("the scene has more parts than can be numbered")]
    TooManyParts,
    #[error(transparent)]
    Embree(#[from] arsc_embree::EmbreeError),
}
