//! Faces of leaves that differ from the rest: other materials, and lamps on some faces only.

use std::collections::HashMap;

use crate::{FaceMaterial, MaterialIndex, PartId};

/// Materials by face, and the faces that parts are sampled on.
#[derive(Default)]
pub(crate) struct Faces {
    /// By the leaf's material: faces, ascending, with their own.
    materials: Vec<Vec<(u32, MaterialIndex)>>,
    /// Parts that are sampled on these faces alone; looked up only.
    sampled: HashMap<PartId, Vec<u32>>,
}

impl Faces {
    pub(crate) fn new(list: &[FaceMaterial]) -> Faces {
        let mut materials: Vec<Vec<(u32, MaterialIndex)>> = Vec::new();
        for face in list {
            let base = face.base.0 as usize;
            materials.resize_with(materials.len().max(base + 1), Vec::new);
            materials[base].push((face.face, face.material));
        }
        materials.iter_mut().for_each(|faces| faces.sort_unstable());
        Faces { materials, sampled: HashMap::new() }
    }

    /// The faces of leaves of this material that show another.
    pub(crate) fn of(&self, base: MaterialIndex) -> &[(u32, MaterialIndex)] {
        self.materials.get(base.0 as usize).map_or(&[], |faces| faces)
    }

    /// What a face of a leaf of this material shows.
    #[inline]
    pub(crate) fn material(&self, base: MaterialIndex, face: u32) -> MaterialIndex {
        let faces = self.of(base);
        if faces.is_empty() {
            return base;
        }
        faces.binary_search_by_key(&face, |entry| entry.0).map_or(base, |i| faces[i].1)
    }

    pub(crate) fn sample_only(&mut self, part: PartId, faces: Vec<u32>) {
        self.sampled.insert(part, faces);
    }

    /// The faces that the part is sampled on, if not on all.
    pub(crate) fn sampled(&self, part: PartId) -> Option<&[u32]> {
        if self.sampled.is_empty() { None } else { self.sampled.get(&part).map(|faces| &faces[..]) }
    }
}
