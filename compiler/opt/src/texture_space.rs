//! Bsdfs on their way from where they were attached to the leaves, through transforms.
//!
//! A bsdf that varies with places in the space in which it was attached keeps the map that leads there; each transform
//! on the way is composed with it. Others are the same everywhere.

use arsc_geometry::{DAffine3, invert};
use arsc_ir::{Bsdf, Varying};
use rustc_hash::FxHashMap;

use crate::intern::Interner;

/// A bsdf and the map that it was moved by, as bits.
type Move = (u32, [u64; 12]);

/// The source's bsdfs, then moved ones, and the table of those that materials name.
pub(crate) struct TextureSpaces {
    /// By number: the source's first.
    bsdfs: Vec<Bsdf>,
    /// Index in the table; moved ones get theirs when first named.
    index: Vec<Option<u32>>,
    moved: FxHashMap<Move, u32>,
    table: Interner<Bsdf>,
    any_local: bool,
}

impl TextureSpaces {
    pub fn new(bsdfs: &[Bsdf]) -> TextureSpaces {
        let mut table = Interner::new();
        let index = bsdfs.iter().map(|bsdf| Some(table.intern(bsdf.clone()))).collect();
        let any_local = bsdfs.iter().any(|bsdf| local(bsdf).is_some());
        TextureSpaces { bsdfs: bsdfs.to_vec(), index, moved: FxHashMap::default(), table, any_local }
    }

    /// Some bsdf varies in its own space.
    pub fn any_local(&self) -> bool {
        self.any_local
    }

    /// The table that [`TextureSpaces::index`] leads to.
    pub fn into_values(self) -> Vec<Bsdf> {
        self.table.values
    }

    pub fn index(&mut self, bsdf: u32) -> u32 {
        let slot = &mut self.index[bsdf as usize];
        *slot.get_or_insert_with(|| self.table.intern(self.bsdfs[bsdf as usize].clone()))
    }

    /// The bsdf for the space of a child.
    pub fn moved(&mut self, bsdf: u32, parent_from_child: &DAffine3) -> u32 {
        let Some(varying) = local(&self.bsdfs[bsdf as usize]) else { return bsdf };
        let key = (bsdf, parent_from_child.to_cols_array().map(f64::to_bits));
        if let Some(&known) = self.moved.get(&key) {
            return known;
        }
        let new = self.bsdfs.len() as u32;
        self.bsdfs.push(composed(varying, parent_from_child));
        self.index.push(None);
        self.moved.insert(key, new);
        new
    }

    /// As [`TextureSpaces::moved`], for an entry of the table.
    pub fn moved_index(&mut self, index: u32, parent_from_child: &DAffine3) -> u32 {
        match local(&self.table.values[index as usize]) {
            Some(varying) => {
                let bsdf = composed(varying, parent_from_child);
                self.table.intern(bsdf)
            }
            None => index,
        }
    }
}

fn local(bsdf: &Bsdf) -> Option<&Varying> {
    match bsdf {
        Bsdf::Varying(varying) if varying.is_local() => Some(varying),
        _ => None,
    }
}

fn composed(varying: &Varying, parent_from_child: &DAffine3) -> Bsdf {
    let texture_from_object = varying.texture_from_object * *parent_from_child;
    Bsdf::Varying(Varying { texture_from_object, ..varying.clone() }.into())
}

/// Of a map of a node or leaf; one without an inverse is reported elsewhere.
pub(crate) fn inverse(map: &DAffine3) -> DAffine3 {
    invert(map).unwrap_or(DAffine3::IDENTITY)
}
