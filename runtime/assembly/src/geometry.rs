//! Geometry of the IR's normal form → [`SceneGeometry`].
//!
//! Order is kept: where the faces of solids coincide the earlier part shows, and the numbers of solids and materials
//! that `arsc probe` prints are those of the normal form. Only emissive surfaces go behind the other surfaces: of two
//! that coincide the later one shows, and so does a lamp in the plane of a ceiling, wherever it was written. A node that
//! several parents share is copied into each solid; what is placed by a `Transform` becomes an instance of one shared
//! solid.

use std::collections::HashMap;
use std::sync::Arc;

use arsc_accel::{Csg, CsgLeaf, FaceMaterial, Instance, MaterialIndex, SceneGeometry, Solid, Surface, SurfaceShape};
use arsc_ir::{Ir, Leaf, MaterialId, NodeId, NodeKind};
use glam::DVec2;

use crate::AssemblyError;

/// Lowers the members of the root that can be hit; lights and environments are left to [`crate::lights`].
pub fn lower(ir: &Ir) -> Result<SceneGeometry, AssemblyError> {
    let mut lowering = Lowering { ir, geometry: SceneGeometry::default(), shared: HashMap::new() };
    for &member in members(ir)? {
        lowering.member(member)?;
    }
    let mut geometry = lowering.geometry;
    let emits = |surface: &Surface| {
        ir.materials.get(surface.material.0 as usize).is_some_and(|material| material.emitter.is_some())
    };
    geometry.surfaces.sort_by_key(emits);
    for (base, material) in (0..).map(MaterialIndex).zip(&ir.materials) {
        let other = |&(face, id): &(u32, MaterialId)| FaceMaterial { base, face, material: MaterialIndex(id.0) };
        geometry.faces.extend(material.faces.iter().map(other));
    }
    Ok(geometry)
}

/// The independent parts of the scene.
pub fn members(ir: &Ir) -> Result<&[NodeId], AssemblyError> {
    match &node(ir, ir.root)?.kind {
        NodeKind::Group(members) => Ok(members),
        _ => Err(AssemblyError::NotNormal("the root is no group")),
    }
}

pub fn node(ir: &Ir, id: NodeId) -> Result<&arsc_ir::Node, AssemblyError> {
    ir.nodes.get(id.0 as usize).ok_or(AssemblyError::NotNormal("a node is out of range"))
}

struct Lowering<'a> {
    ir: &'a Ir,
    geometry: SceneGeometry,
    /// Solids of instances, looked up only.
    shared: HashMap<NodeId, Arc<Solid>>,
}

impl Lowering<'_> {
    fn member(&mut self, id: NodeId) -> Result<(), AssemblyError> {
        match &node(self.ir, id)?.kind {
            NodeKind::Leaf(leaf) if matches!(**leaf, Leaf::Surface { .. }) => {
                let surface = self.surface(leaf)?;
                self.geometry.surfaces.push(surface);
            }
            NodeKind::Transform { parent_from_child, child } => {
                if !matches!(node(self.ir, *child)?.kind, NodeKind::Light(_) | NodeKind::Environment(_)) {
                    let solid = self.shared_solid(*child)?;
                    self.geometry.instances.push(Instance { solid, world_from_object: **parent_from_child });
                }
            }
            NodeKind::Light(_) | NodeKind::Environment(_) => {}
            _ => {
                let solid = self.solid(id)?;
                self.geometry.solids.push(solid);
            }
        }
        Ok(())
    }

    fn shared_solid(&mut self, id: NodeId) -> Result<Arc<Solid>, AssemblyError> {
        if let Some(solid) = self.shared.get(&id) {
            return Ok(solid.clone());
        }
        let solid = Arc::new(self.solid(id)?);
        self.shared.insert(id, solid.clone());
        Ok(solid)
    }

    fn solid(&self, root: NodeId) -> Result<Solid, AssemblyError> {
        let mut leaves = Vec::new();
        let tree = self.tree(root, &mut leaves)?;
        Ok(Solid { tree, leaves })
    }

    /// Recursive: the depth of trees is bounded by the compiler, and callers run on a large stack.
    fn tree(&self, id: NodeId, leaves: &mut Vec<CsgLeaf>) -> Result<Csg, AssemblyError> {
        let mut all = |ids: &[NodeId]| ids.iter().map(|&id| self.tree(id, leaves)).collect::<Result<Vec<Csg>, _>>();
        match &node(self.ir, id)?.kind {
            NodeKind::Leaf(leaf) => {
                let Leaf::Solid { shape, parent_from_object, material } = &**leaf else {
                    return Err(AssemblyError::NotNormal("a surface is an operand of a Boolean"));
                };
                let material = material_index(*material)?;
                leaves.push(CsgLeaf { shape: shape.clone(), world_from_object: *parent_from_object, material });
                Ok(Csg::Leaf(leaves.len() as u32 - 1))
            }
            NodeKind::Union(operands) => all(operands).map(Csg::Union),
            NodeKind::Intersection(operands) => all(operands).map(Csg::Intersection),
            NodeKind::Difference(operands) => {
                let mut operands = all(operands)?.into_iter();
                let first = operands.next().ok_or(AssemblyError::NotNormal("a difference has no operand"))?;
                let rest: Vec<Csg> = operands.collect();
                match <[Csg; 1]>::try_from(rest) {
                    Ok([only]) => Ok(Csg::Difference(Box::new(first), Box::new(only))),
                    Err(rest) if rest.is_empty() => Ok(first),
                    Err(rest) => Ok(Csg::Difference(Box::new(first), Box::new(Csg::Union(rest)))),
                }
            }
            _ => Err(AssemblyError::NotNormal("a node that is no solid is an operand of a Boolean")),
        }
    }

    fn surface(&mut self, leaf: &Leaf) -> Result<Surface, AssemblyError> {
        let Leaf::Surface { surface, parent_from_object, material } = leaf else {
            return Err(AssemblyError::NotNormal("a solid stands where a surface is due"));
        };
        let shape = match surface {
            arsc_ir::Surface::Triangle(corners) => SurfaceShape::Triangle(*corners),
            arsc_ir::Surface::Quad(corners) => SurfaceShape::Quad(*corners),
            arsc_ir::Surface::Rectangle { width, depth } => {
                SurfaceShape::Rectangle { size: DVec2::new(*width, *depth) }
            }
            arsc_ir::Surface::Disk { radius } => SurfaceShape::Disk { radius: *radius },
            arsc_ir::Surface::Plane => SurfaceShape::Plane,
            arsc_ir::Surface::Mesh { mesh, .. } => SurfaceShape::Mesh(mesh.clone()),
        };
        Ok(Surface { shape, world_from_object: *parent_from_object, material: material_index(*material)? })
    }
}

fn material_index(material: Option<MaterialId>) -> Result<MaterialIndex, AssemblyError> {
    material.map(|id| MaterialIndex(id.0)).ok_or(AssemblyError::NotNormal("a leaf has no material"))
}
