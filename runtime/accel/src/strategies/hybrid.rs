//! What the thesis settled on (section 4.2): solids with a mesh among their operands get a KD tree over their leaves, all
//! others are traced through the operator tree with its boxes; plain geometry is Embree's own. The thesis had to: its
//! operator tree could not be traced with meshes.

use arsc_geometry::Shape;

use crate::Budget;
use crate::solid::SolidModel;
use crate::strategies::whole::Structure;

pub fn structure(solid: &SolidModel, budget: &Budget) -> Structure {
    let has_mesh = solid.leaves.iter().any(|leaf| matches!(leaf.shape(), Shape::Mesh(_)));
    if has_mesh { Structure::kd(solid, budget) } else { Structure::tree(solid, budget) }
}
