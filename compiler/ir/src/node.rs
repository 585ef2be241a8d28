//! Geometry nodes.

use std::sync::Arc;

use arsc_diagnostics::Span;
use arsc_geometry::{DAffine3, DVec3, Shape, TriangleMesh};

use crate::{Attributes, Environment, Light, MaterialId};

/// Index into [`crate::Ir::nodes`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct NodeId(pub u32);

#[derive(Clone, Debug, PartialEq)]
pub struct Node {
    pub kind: NodeKind,
    pub origin: Span,
}

/// Which attribute wins where both an inner and an outer one are given.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Precedence {
    /// `with(…)`: the one closest to the leaf.
    Inner,
    /// `override(…)`: this one, whatever is inside.
    Outer,
}

/// A node of the scene graph. Directed acyclic: a node may have several parents.
#[derive(Clone, Debug, PartialEq)]
pub enum NodeKind {
    Leaf(Box<Leaf>),
    Union(Vec<NodeId>),
    Intersection(Vec<NodeId>),
    /// The first without all the others; at least one operand.
    Difference(Vec<NodeId>),
    /// Parts side by side with no Boolean between them: each is traced as if alone.
    Group(Vec<NodeId>),
    Transform {
        parent_from_child: Box<DAffine3>,
        child: NodeId,
    },
    Attributes {
        attributes: Attributes,
        precedence: Precedence,
        child: NodeId,
    },
    /// In the frame of its ancestors' transforms.
    Light(Box<Light>),
    Environment(Box<Environment>),
}

/// A placed primitive.
#[derive(Clone, Debug, PartialEq)]
pub enum Leaf {
    Solid { shape: Shape, parent_from_object: DAffine3, material: Option<MaterialId> },
    Surface { surface: Surface, parent_from_object: DAffine3, material: Option<MaterialId> },
}

/// Open geometry in object space.
#[derive(Clone, Debug, PartialEq)]
pub enum Surface {
    /// Counter-clockwise as seen from the side of the normal.
    Triangle([DVec3; 3]),
    /// A planar quadrilateral, counter-clockwise as seen from the side of the normal.
    Quad([DVec3; 4]),
    /// In the plane z = 0, centred, normal +z.
    Rectangle { width: f64, depth: f64 },
    /// In the plane z = 0, centred, normal +z.
    Disk { radius: f64 },
    /// z = 0, normal +z.
    Plane,
    /// A triangle mesh from a file; the path is relative to the root script's folder. Its content comes along.
    Mesh { path: Arc<str>, mesh: Arc<TriangleMesh> },
}
