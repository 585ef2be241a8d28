//! What a scene is made of, before it is built.

use std::sync::Arc;

use glam::{DAffine3, DVec2, DVec3};

use arsc_geometry::{Shape, TriangleMesh};

/// The caller's number for a material.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct MaterialIndex(pub u32);

/// How solids are traced. All give the same picture (docs/csg.md).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Strategy {
    /// Cells with simplified expressions as Embree user primitives.
    #[default]
    Local,
    /// One KD tree of our own over the whole scene, without Embree; all hits to the end of the ray, then whole trees.
    Native,
    /// Embree finds the leaves along the ray, then whole trees.
    Collect,
    /// Each solid one Embree user primitive; its operator tree with boxes at the nodes.
    Tree,
    /// Each solid one Embree user primitive; a KD tree over its leaves.
    Kd,
    /// `Kd` for solids with meshes as operands, `Tree` for the others.
    Hybrid,
    /// `Kd` that evaluates only what changes along the ray: the strongest opponent of `Local`.
    Incremental,
    /// Every leaf, and the whole expression at every crossing: what tests compare the others with.
    Oracle,
}

impl Strategy {
    /// Those that a script may name.
    pub const ALL: [Strategy; 7] = [
        Strategy::Local,
        Strategy::Native,
        Strategy::Collect,
        Strategy::Tree,
        Strategy::Kd,
        Strategy::Hybrid,
        Strategy::Incremental,
    ];

    /// As scripts and the command line write it.
    pub fn name(self) -> &'static str {
        match self {
            Strategy::Local => "local",
            Strategy::Native => "native",
            Strategy::Collect => "collect",
            Strategy::Tree => "tree",
            Strategy::Kd => "kd",
            Strategy::Hybrid => "hybrid",
            Strategy::Incremental => "incremental",
            Strategy::Oracle => "oracle",
        }
    }
}

/// A Boolean tree; leaves index [`Solid::leaves`].
#[derive(Clone, Debug, PartialEq)]
pub enum Csg {
    Leaf(u32),
    Union(Vec<Csg>),
    Intersection(Vec<Csg>),
    /// The first without the second.
    Difference(Box<Csg>, Box<Csg>),
}

/// A shape in its place.
#[derive(Clone, Debug, PartialEq)]
pub struct CsgLeaf {
    pub shape: Shape,
    pub world_from_object: DAffine3,
    pub material: MaterialIndex,
}

/// A closed solid.
#[derive(Clone, Debug, PartialEq)]
pub struct Solid {
    pub tree: Csg,
    pub leaves: Vec<CsgLeaf>,
}

/// Open geometry in object space.
#[derive(Clone, Debug, PartialEq)]
pub enum SurfaceShape {
    Triangle([DVec3; 3]),
    Quad([DVec3; 4]),
    /// z = 0, centred, normal +z.
    Rectangle {
        size: DVec2,
    },
    /// z = 0, centred, normal +z.
    Disk {
        radius: f64,
    },
    /// z = 0, normal +z.
    Plane,
    Mesh(Arc<TriangleMesh>),
}

#[derive(Clone, Debug, PartialEq)]
pub struct Surface {
    pub shape: SurfaceShape,
    pub world_from_object: DAffine3,
    pub material: MaterialIndex,
}

/// A placed copy of a solid: the leaves' `world_from_object` are relative to it.
#[derive(Clone, Debug, PartialEq)]
pub struct Instance {
    pub solid: Arc<Solid>,
    pub world_from_object: DAffine3,
}

/// On leaves of material `base`, this face shows another material.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FaceMaterial {
    pub base: MaterialIndex,
    pub face: u32,
    pub material: MaterialIndex,
}

/// Everything that can be hit.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SceneGeometry {
    pub solids: Vec<Solid>,
    pub surfaces: Vec<Surface>,
    pub instances: Vec<Instance>,
    /// Where faces of a leaf are covered otherwise than the rest of it.
    pub faces: Vec<FaceMaterial>,
}
