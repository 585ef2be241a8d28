//! What is no solid of the world itself, for `native`: a KD tree of our own over flat surfaces, single triangles and
//! instances, as a renderer without Embree has it. Instances hold trees of their own.

use arsc_geometry::Aabb;

use crate::Budget;
use crate::query::Query;
use crate::strategies::scene_tree::SceneTree;

/// A box of the tree.
#[derive(Clone, Copy, Debug)]
pub enum Item {
    Flat { surface: u32 },
    Triangle { surface: u32, triangle: u32 },
    Instance { instance: u32 },
}

#[derive(Default)]
pub struct Plain {
    tree: SceneTree,
    items: Vec<Item>,
}

impl Plain {
    pub fn build(items: Vec<(Item, Aabb)>) -> Plain {
        let tree = SceneTree::build(items.iter().map(|&(_, bounds)| bounds), &Budget::UNLIMITED);
        Plain { tree, items: items.into_iter().map(|(item, _)| item).collect() }
    }

    /// Calls `visit` for all that the ray may meet, to its end.
    pub fn visit(&self, query: &mut Query, mut visit: impl FnMut(Item, &mut Query)) {
        let mut found = std::mem::take(&mut query.scratch.whole.items);
        found.clear();
        self.tree.visit(&query.view, query.ray.t_max, &mut query.scratch.whole.mailbox, |number| found.push(number));
        for &number in &found {
            if !query.blocked {
                visit(self.items[number as usize], query);
            }
        }
        query.scratch.whole.items = found;
    }

    pub fn bytes(&self) -> usize {
        self.tree.bytes() + size_of_val(&self.items[..])
    }
}
