//! Building an IR: cheap pushes, children first.

use arsc_diagnostics::Span;
use arsc_geometry::{DAffine3, Shape};

use crate::{
    Attributes, Bsdf, Camera, Emitter, Environment, Ir, Leaf, Light, Medium, Node, NodeId, NodeKind, Precedence,
    Surface,
};

/// Collects nodes; [`Builder::finish`] names the root.
#[derive(Clone, Debug)]
pub struct Builder {
    ir: Ir,
}

impl Default for Builder {
    fn default() -> Builder {
        Builder::new()
    }
}

impl Builder {
    pub fn new() -> Builder {
        Builder {
            ir: Ir {
                nodes: Vec::new(),
                root: NodeId(0),
                bsdfs: Vec::new(),
                emitters: Vec::new(),
                media: Vec::new(),
                materials: Vec::new(),
                camera: None,
                actions: Vec::new(),
            },
        }
    }

    /// Nodes so far, for limits.
    pub fn len(&self) -> usize {
        self.ir.nodes.len()
    }

    pub fn is_empty(&self) -> bool {
        self.ir.nodes.is_empty()
    }

    pub fn push(&mut self, kind: NodeKind, origin: Span) -> NodeId {
        self.ir.push(Node { kind, origin })
    }

    pub fn solid(&mut self, shape: Shape, parent_from_object: DAffine3, origin: Span) -> NodeId {
        self.push(NodeKind::Leaf(Box::new(Leaf::Solid { shape, parent_from_object, material: None })), origin)
    }

    pub fn surface(&mut self, surface: Surface, parent_from_object: DAffine3, origin: Span) -> NodeId {
        self.push(NodeKind::Leaf(Box::new(Leaf::Surface { surface, parent_from_object, material: None })), origin)
    }

    pub fn union(&mut self, operands: Vec<NodeId>, origin: Span) -> NodeId {
        self.push(NodeKind::Union(operands), origin)
    }

    pub fn intersection(&mut self, operands: Vec<NodeId>, origin: Span) -> NodeId {
        self.push(NodeKind::Intersection(operands), origin)
    }

    pub fn difference(&mut self, operands: Vec<NodeId>, origin: Span) -> NodeId {
        self.push(NodeKind::Difference(operands), origin)
    }

    pub fn transform(&mut self, parent_from_child: DAffine3, child: NodeId, origin: Span) -> NodeId {
        self.push(NodeKind::Transform { parent_from_child: Box::new(parent_from_child), child }, origin)
    }

    pub fn attributes(
        &mut self,
        attributes: Attributes,
        precedence: Precedence,
        child: NodeId,
        origin: Span,
    ) -> NodeId {
        self.push(NodeKind::Attributes { attributes, precedence, child }, origin)
    }

    pub fn light(&mut self, light: Light, origin: Span) -> NodeId {
        self.push(NodeKind::Light(Box::new(light)), origin)
    }

    pub fn environment(&mut self, environment: Environment, origin: Span) -> NodeId {
        self.push(NodeKind::Environment(Box::new(environment)), origin)
    }

    /// Index for [`Attributes::bsdf`]. Not interned: `propagate_attributes` merges equal ones.
    pub fn bsdf(&mut self, bsdf: Bsdf) -> u32 {
        self.ir.bsdfs.push(bsdf);
        self.ir.bsdfs.len() as u32 - 1
    }

    /// Index for [`Attributes::emitter`].
    pub fn emitter(&mut self, emitter: Emitter) -> u32 {
        self.ir.emitters.push(emitter);
        self.ir.emitters.len() as u32 - 1
    }

    /// Index for [`Attributes::medium`].
    pub fn medium(&mut self, medium: Medium) -> u32 {
        self.ir.media.push(medium);
        self.ir.media.len() as u32 - 1
    }

    pub fn camera(&mut self, camera: Camera) {
        self.ir.camera = Some(camera);
    }

    pub fn action(&mut self, action: crate::Action, origin: Span) {
        self.ir.actions.push(crate::ActionAt { action, origin });
    }

    pub fn finish(mut self, root: NodeId) -> Ir {
        self.ir.root = root;
        self.ir
    }
}
