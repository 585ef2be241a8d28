//! A ray under way: what it is after, the frame it is seen in, and what has been found.

use glam::DVec3;

use arsc_embree::{Bounds, Segment, Step};
use arsc_geometry::{Aabb, Crossings, Ray};

use crate::nearest::{Candidate, Nearest};
use crate::strategies::WholeScratch;

/// Room around boxes for single precision rays, relative to the largest coordinate: roundings of origin, direction and
/// slab arithmetic make less than 8 units of 2⁻²⁴.
const SINGLE_PAD: f64 = 1.0 / (1 << 20) as f64;
/// Embree's rays start so many pads early.
const BEHIND: f64 = 512.0;
/// Triangles are grown by so many pads: what a ray that meets them at an angle of some thousandths may be off.
const GROWTH: f64 = 64.0;
/// Coordinates that Embree is given at most; what lies beyond is traced without it.
const LARGEST: f64 = 1e15;

/// What a ray is after.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    Nearest,
    /// Anything at all.
    Occluded,
    /// Every transition of every solid; open surfaces are ignored.
    Collect,
}

/// A ray with what is computed of it once. It is handed on by reference: copies of what has just been written stall.
#[derive(Clone, Copy, Debug)]
pub struct PreparedRay {
    pub origin: DVec3,
    /// Unit.
    pub dir: DVec3,
    pub inverse_dir: DVec3,
    /// `1 / dir²`: one, but for the rounding.
    pub inverse_square: f64,
    /// Not in parallel to any plane of axes: `inverse_dir` is finite.
    pub is_oblique: bool,
}

/// The ray in a frame: the world's, or an instance's.
#[derive(Clone, Copy, Debug)]
pub struct View {
    pub ray: PreparedRay,
    /// Largest coordinate of the origin.
    pub reach: f64,
    /// Lengths here per unit of the ray's `t`, and the reciprocal.
    pub scale: f64,
    pub inverse_scale: f64,
    /// Number of the frame's first solid, and of its first part.
    pub first_solid: u32,
    pub first_part: u32,
    /// Embree's origin is so far ahead (in lengths of the frame).
    shift: f64,
    /// Added to distances that are handed to Embree.
    slack: f64,
}

impl View {
    /// `ray` is in the frame, its `dir` of any length.
    pub fn new(ray: &Ray, first_solid: u32, first_part: u32) -> View {
        let scale = ray.dir.length();
        let unit = Ray { dir: ray.dir / scale, ..*ray };
        View { scale, inverse_scale: 1.0 / scale, first_solid, first_part, ..View::world(&unit) }
    }

    /// `ray` is in the world, its `dir` unit.
    #[inline]
    pub fn world(ray: &Ray) -> View {
        let inverse_dir = ray.dir.recip();
        View {
            ray: PreparedRay {
                origin: ray.origin,
                dir: ray.dir,
                inverse_dir,
                inverse_square: 1.0 / ray.dir.length_squared(),
                // Zero, unless something is infinite.
                is_oblique: (inverse_dir * 0.0).element_sum() == 0.0,
            },
            reach: ray.origin.abs().max_element(),
            scale: 1.0,
            inverse_scale: 1.0,
            first_solid: 0,
            first_part: 0,
            shift: 0.0,
            slack: 0.0,
        }
    }

    /// The single precision segment through what `extent` holds, from close before it; `None` when it is missed.
    #[inline(always)]
    pub fn segment(&mut self, extent: &Extent, limit: f64) -> Option<Segment> {
        let PreparedRay { origin, dir, .. } = self.ray;
        let (low, high) = slab(&extent.bounds, origin, self.ray.inverse_dir);
        let high = high.min(limit * self.scale);
        if !(low <= high && high >= 0.0) {
            return None;
        }
        // From behind, so that rounding does not put a surface ahead of the origin behind it, one seen at a grazing angle
        // included; what is met before the true start is turned down in double precision.
        self.shift = low.max(0.0) - BEHIND * extent.pad;
        self.slack = 2.0 * extent.pad;
        let single = |v: DVec3| v.as_vec3().to_array();
        Some(Segment {
            origin: single(origin + dir * self.shift),
            dir: single(dir),
            t_near: 0.0,
            t_far: self.far(high * self.inverse_scale),
        })
    }

    /// Embree's distance, rounded up, for the ray's parameter `t`.
    #[inline]
    fn far(&self, t: f64) -> f32 {
        let distance = t * self.scale - self.shift + self.slack;
        ((distance * (1.0 + SINGLE_PAD)) as f32).next_up()
    }
}

/// A box that Embree's primitives lie in, with the room that single precision needs.
#[derive(Clone, Copy, Debug)]
pub struct Extent {
    pub bounds: Aabb,
    pad: f64,
}

impl Extent {
    pub fn new(bounds: Aabb) -> Extent {
        let largest = if bounds.is_empty() { 0.0 } else { bounds.min.abs().max(bounds.max.abs()).max_element() };
        let pad = SINGLE_PAD * largest;
        Extent { bounds: bounds.dilated(pad), pad }
    }

    /// Embree can be given this box.
    pub fn admits(bounds: &Aabb) -> bool {
        bounds.is_finite() && bounds.min.abs().max(bounds.max.abs()).max_element() < LARGEST
    }

    /// A convex polygon grown in its plane by what single precision may be wrong, about its centroid. Slivers are not
    /// stretched without end: they are left to their neighbours.
    pub fn grown<const N: usize>(&self, corners: [DVec3; N]) -> [[f32; 3]; N] {
        const LONGEST: f64 = 1e3;
        let centroid = corners.iter().sum::<DVec3>() / N as f64;
        let to_edge = |i: usize| {
            let (a, b) = (corners[i], corners[(i + 1) % N]);
            let along = (b - a).normalize_or_zero();
            let across = centroid - a;
            (across - along * across.dot(along)).length()
        };
        let nearest = (0..N).map(to_edge).fold(f64::INFINITY, f64::min);
        let scale = (1.0 + GROWTH * self.pad / nearest).min(LONGEST);
        corners.map(|p| (centroid + (p - centroid) * scale).as_vec3().to_array())
    }

    /// The box of a primitive, rounded outwards.
    pub fn single(&self, bounds: &Aabb) -> Bounds {
        let padded = bounds.dilated(self.pad);
        Bounds {
            min: padded.min.to_array().map(|x| (x as f32).next_down()),
            max: padded.max.to_array().map(|x| (x as f32).next_up()),
        }
    }
}

/// Where a line is in a box: parameters of entry and exit, entry above exit when it is missed.
#[inline]
pub fn slab(bounds: &Aabb, origin: DVec3, inverse_dir: DVec3) -> (f64, f64) {
    let (mut near, mut far) = (f64::NEG_INFINITY, f64::INFINITY);
    let mut cut = |min: f64, max: f64, o: f64, inverse: f64| {
        let (a, b) = if inverse < 0.0 { (max, min) } else { (min, max) };
        let (a, b) = ((a - o) * inverse, (b - o) * inverse);
        // False for the NaN of a ray in a face's plane: it counts as within.
        near = if a > near { a } else { near };
        far = if b < far { b } else { far };
    };
    cut(bounds.min.x, bounds.max.x, origin.x, inverse_dir.x);
    cut(bounds.min.y, bounds.max.y, origin.y, inverse_dir.y);
    cut(bounds.min.z, bounds.max.z, origin.z, inverse_dir.z);
    (near, far)
}

/// Roots of costly leaves, kept from one cell to the next.
#[derive(Debug)]
struct RootCache {
    keys: [u64; RootCache::SIZE],
    roots: [Crossings; RootCache::SIZE],
    len: usize,
}

impl RootCache {
    const SIZE: usize = 16;
}

/// Buffers that outlive a ray.
#[derive(Debug)]
pub struct Scratch {
    pub collected: Vec<Candidate>,
    pub whole: WholeScratch,
    kept: Crossings,
    cache: RootCache,
}

impl Default for Scratch {
    fn default() -> Scratch {
        let cache =
            RootCache { keys: [0; RootCache::SIZE], roots: [const { Crossings::NONE }; RootCache::SIZE], len: 0 };
        Scratch { collected: Vec::new(), whole: WholeScratch::default(), kept: Crossings::NONE, cache }
    }
}

impl Scratch {
    fn clear(&mut self) {
        self.collected.clear();
        self.whole.clear();
        self.cache.len = 0;
    }

    /// The roots of leaf `key`, solved once per ray (as long as there is room: the oldest are given up).
    pub fn roots(&mut self, key: u64, solve: impl FnOnce() -> Crossings) -> &Crossings {
        let cache = &mut self.cache;
        let filled = cache.len.min(RootCache::SIZE);
        let known = cache.keys[..filled].iter().position(|&k| k == key);
        let i = known.unwrap_or_else(|| {
            let i = cache.len % RootCache::SIZE;
            cache.keys[i] = key;
            cache.roots[i] = solve();
            cache.len += 1;
            i
        });
        &cache.roots[i]
    }

    /// Whether [`Scratch::roots`] has those of leaf `key`.
    pub fn has_roots(&self, key: u64) -> bool {
        self.cache.keys[..self.cache.len.min(RootCache::SIZE)].contains(&key)
    }

    /// Keeps crossings until the next are kept.
    pub fn keep(&mut self, crossings: Crossings) -> &Crossings {
        self.kept = crossings;
        &self.kept
    }
}

/// The state that travels with a ray through Embree.
pub struct Query {
    pub mode: Mode,
    /// In the world.
    pub ray: Ray,
    pub view: View,
    pub nearest: Nearest,
    pub blocked: bool,
    /// Blocked unless the ray turns out to start within a union.
    pub tentative: bool,
    /// What was found of some union does not hold: its leaves must be evaluated together.
    pub unclear: bool,
    /// Leaves of unions are only asked whether the ray starts in them, and nothing else is asked anything.
    pub probing: bool,
    /// Leaves of unions are only taken note of.
    pub gathering: bool,
    /// Only this solid is asked, and no surface.
    pub only: Option<u32>,
    pub scratch: Box<Scratch>,
    /// Leaves (in every cell anew) and surfaces that were tested.
    pub tests: u32,
}

impl Query {
    /// `slack` is the greatest tolerance of any solid.
    pub fn new(mode: Mode, ray: &Ray, slack: f64, mut scratch: Box<Scratch>) -> Query {
        scratch.clear();
        Query {
            mode,
            ray: *ray,
            view: View::world(ray),
            nearest: Nearest::new(ray.t_max, slack),
            blocked: false,
            tentative: false,
            unclear: false,
            gathering: false,
            probing: false,
            only: None,
            scratch,
            tests: 0,
        }
    }

    /// Takes note of a candidate; false when nothing behind it along the same primitive can matter.
    #[inline]
    pub fn offer(&mut self, candidate: Candidate) -> bool {
        let within = candidate.t > 0.0 && candidate.t < self.ray.t_max;
        match self.mode {
            Mode::Nearest => {
                self.nearest.offer(candidate);
                candidate.t <= 0.0
            }
            Mode::Occluded => {
                self.blocked |= within;
                !within
            }
            Mode::Collect => {
                if within {
                    self.scratch.collected.push(candidate);
                }
                true
            }
        }
    }

    /// Beyond this parameter nothing matters any more.
    #[inline]
    pub fn limit(&self) -> f64 {
        self.nearest.limit()
    }

    /// An occluded ray, or a probe, need go no further.
    #[inline]
    pub fn ends(&self) -> bool {
        self.blocked || self.unclear || (self.tentative && !self.probing)
    }

    /// What Embree is told after a primitive; `before` is the limit from before it.
    #[inline]
    pub fn step(&self, before: f64) -> Step {
        if self.unclear {
            return Step::Hit(f32::NEG_INFINITY);
        }
        let now = self.limit();
        if now < before { Step::Hit(self.view.far(now)) } else { Step::Miss }
    }
}
