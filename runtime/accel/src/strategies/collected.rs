//! Leaves that a traversal has come to, put together by solid and evaluated when it is over: `native` and `collect`.

use arsc_geometry::Aabb;

use crate::level::Solids;
use crate::query::Query;
use crate::strategies::leaf_boxes;
use crate::strategies::operators::{Evaluation, Operators};
use crate::strategies::whole::evaluate;

/// A leaf: the numbers of its solid and of the leaf.
pub type SolidLeaf = (u32, u32);

#[derive(Default)]
pub struct Collected {
    operators: Vec<Operators>,
    /// Leaves without a finite box, ascending: met by every ray.
    everywhere: Vec<SolidLeaf>,
}

impl Collected {
    /// Also returns all other leaves with their boxes.
    pub fn build(solids: &Solids) -> (Collected, Vec<(SolidLeaf, Aabb)>) {
        let (mut collected, mut boxed) = (Collected::default(), vec![]);
        for (number, solid) in solids.numbered() {
            let (boxes, everywhere) = leaf_boxes(solid);
            let boxes = (0..).zip(boxes).filter(|(_, bounds)| !bounds.is_empty());
            boxed.extend(boxes.map(|(leaf, bounds)| ((number, leaf), bounds)));
            collected.everywhere.extend(everywhere.into_iter().map(|leaf| (number, leaf)));
            collected.operators.push(Operators::new(solid, Evaluation::Whole));
        }
        (collected, boxed)
    }

    pub fn bytes(&self) -> usize {
        self.operators.iter().map(Operators::bytes).sum::<usize>() + size_of_val(&self.everywhere[..])
    }

    /// Crosses and evaluates all that has been met since `mark`, up to the parameter `end` of the query's ray.
    pub fn finish(&self, solids: &Solids, mark: usize, end: f64, query: &mut Query) {
        let mut met = std::mem::take(&mut query.scratch.whole.met);
        met.extend(&self.everywhere);
        met[mark..].sort_unstable();
        for group in met[mark..].chunk_by(|a, b| a.0 == b.0) {
            let solid = group[0].0;
            if query.blocked || solids.is_left_out(solid, query) {
                continue;
            }
            let model = &*solids.models[solid as usize];
            let ray = model.near_ray(query.view.ray.origin, query.view.ray.dir, end * query.view.scale);
            evaluate(solids, solid, &self.operators[solid as usize], &ray, query, |line, scratch| {
                for same in group.chunk_by(|a, b| a == b) {
                    scratch.gathered.cross(line, same[0].1);
                }
            });
        }
        met.truncate(mark);
        query.scratch.whole.met = met;
    }
}
