//! Random scenes: a friendly family in general position and a hostile one full of coincidences.

use arsc_diagnostics::{SourceId, Span};
use arsc_geometry::{DAffine3, DVec3, Shape};
use arsc_ir::{Attributes, Bsdf, Builder, CutRule, Ir, Light, NodeId, Precedence, Spectrum};
use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64Mcg;

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Family {
    /// Positions and sizes from a continuum.
    Friendly,
    /// Sizes and positions on a coarse lattice: coincident faces, tangents, duplicates; mirrored maps.
    Lattice,
}

/// A random scene, its objects within about 6 `scale` of the origin.
pub fn scene(seed: u64, family: Family, scale: f64) -> Ir {
    let mut scene = Scene {
        rng: Pcg64Mcg::seed_from_u64(seed),
        family,
        b: Builder::new(),
        at: Span::new(SourceId(0), 0, 1),
        made: Vec::new(),
    };
    for i in 0..6 {
        let reflectance = Spectrum::Constant(0.1 * f64::from(i));
        scene.b.bsdf(if i < 5 {
            Bsdf::Lambert { reflectance }
        } else {
            Bsdf::Dielectric { ior: Spectrum::Constant(1.5) }
        });
    }
    let objects = scene.rng.random_range(1..6);
    let operands = (0..objects)
        .map(|_| {
            let depth = scene.rng.random_range(0..5);
            let object = scene.solid(depth);
            if scene.rng.random_bool(0.1) {
                let light = scene.b.light(Light::Point { intensity: Spectrum::Constant(1.0) }, scene.at);
                scene.b.union(vec![light, object], scene.at)
            } else {
                object
            }
        })
        .collect();
    let root = scene.b.union(operands, scene.at);
    let root = if scale == 1.0 {
        root
    } else {
        // The scene's union stays the root: scale its objects.
        let NodeId(last) = root;
        let NodeIds(objects) = NodeIds::of(&scene.b, last);
        let map = DAffine3::from_scale(DVec3::splat(scale));
        let scaled = objects.into_iter().map(|object| scene.b.transform(map, object, scene.at)).collect();
        scene.b.union(scaled, scene.at)
    };
    scene.b.finish(root)
}

struct NodeIds(Vec<NodeId>);

impl NodeIds {
    fn of(b: &Builder, id: u32) -> NodeIds {
        let ir = b.clone().finish(NodeId(id));
        NodeIds(ir.kind(NodeId(id)).children().to_vec())
    }
}

struct Scene {
    rng: Pcg64Mcg,
    family: Family,
    b: Builder,
    at: Span,
    /// Solids so far, to be used again.
    made: Vec<NodeId>,
}

impl Scene {
    fn length(&mut self) -> f64 {
        match self.family {
            Family::Friendly => self.rng.random_range(0.2..2.0),
            Family::Lattice => f64::from(self.rng.random_range(1..4)) * 0.5,
        }
    }

    fn position(&mut self) -> DVec3 {
        DVec3::from_array(std::array::from_fn(|_| match self.family {
            Family::Friendly => self.rng.random_range(-3.0..3.0),
            Family::Lattice => f64::from(self.rng.random_range(-3..4)) * 0.5,
        }))
    }

    fn map(&mut self) -> DAffine3 {
        let mut map = DAffine3::from_translation(self.position());
        if self.rng.random_bool(0.3) {
            let quarter = std::f64::consts::FRAC_PI_2 * f64::from(self.rng.random_range(0..4));
            let angle = if self.family == Family::Friendly { self.rng.random_range(0.0..6.0) } else { quarter };
            map *= DAffine3::from_axis_angle([DVec3::X, DVec3::Y, DVec3::Z][self.rng.random_range(0..3)], angle);
        }
        if self.rng.random_bool(0.3) {
            let signs = DVec3::from_array(std::array::from_fn(|_| if self.rng.random_bool(0.3) { -1.0 } else { 1.0 }));
            let size = DVec3::new(self.length(), self.length(), self.length());
            map *= DAffine3::from_scale(signs * size.clamp(DVec3::splat(0.4), DVec3::splat(2.0)));
        }
        map
    }

    fn leaf(&mut self) -> NodeId {
        let (a, b, c) = (self.length(), self.length(), self.length());
        let shape = match self.rng.random_range(0..16) {
            0..5 => Shape::Sphere { radius: a },
            5..10 => Shape::Box { min: DVec3::ZERO, max: DVec3::new(a, b, c) },
            10..12 => Shape::Cylinder { radius: a, height: b },
            12 => Shape::Cone { base_radius: a, top_radius: 0.0, height: c },
            13 => Shape::Torus { major: a, minor: b * 0.3 },
            14 => Shape::HalfSpace,
            _ => Shape::InfiniteCylinder { radius: a },
        };
        let map = self.map();
        let leaf = self.b.solid(shape, map, self.at);
        let bsdf = if self.rng.random_bool(0.03) { 5 } else { self.rng.random_range(0..5) };
        self.cover(leaf, Attributes { bsdf: Some(bsdf), ..Attributes::default() }, 0.5)
    }

    fn cover(&mut self, id: NodeId, attributes: Attributes, probability: f64) -> NodeId {
        if !self.rng.random_bool(probability) {
            return id;
        }
        let precedence = if self.rng.random_bool(0.2) { Precedence::Outer } else { Precedence::Inner };
        self.b.attributes(attributes, precedence, id, self.at)
    }

    fn solid(&mut self, depth: u32) -> NodeId {
        if depth == 0 {
            return self.leaf();
        }
        if !self.made.is_empty() && self.rng.random_bool(0.15) {
            let again = self.made[self.rng.random_range(0..self.made.len())];
            let map = self.map();
            return if self.rng.random_bool(0.7) { self.b.transform(map, again, self.at) } else { again };
        }
        let operands: Vec<NodeId> = (0..self.rng.random_range(2..5)).map(|_| self.solid(depth - 1)).collect();
        let node = match self.rng.random_range(0..10) {
            0..5 => self.b.union(operands, self.at),
            5..7 => self.b.intersection(operands, self.at),
            _ => self.b.difference(operands, self.at),
        };
        let cut = match self.rng.random_range(0..3) {
            0 => Some(CutRule::Inherit),
            1 => Some(CutRule::Bsdf(self.rng.random_range(0..5))),
            _ => None,
        };
        let bsdf = self.rng.random_bool(0.5).then(|| self.rng.random_range(0..5));
        let node = self.cover(node, Attributes { bsdf, cut, ..Attributes::default() }, 0.2);
        let node = if self.rng.random_bool(0.3) {
            let map = self.map();
            self.b.transform(map, node, self.at)
        } else {
            node
        };
        self.made.push(node);
        node
    }
}
