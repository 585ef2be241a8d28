//! Tracing single rays.

use std::panic::resume_unwind;

use crate::bindings as rtc;
use crate::callbacks::{Callbacks, Context};
use crate::scene::{GeometryId, Scene};

/// The ray as Embree sees it: single precision, `t_near <= t <= t_far`, the direction of any length but zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment {
    pub origin: [f32; 3],
    pub dir: [f32; 3],
    pub t_near: f32,
    pub t_far: f32,
}

impl Segment {
    #[inline]
    fn is_traceable(&self) -> bool {
        // Zero for finite numbers, no number for others: one comparison for all.
        let [[a, b, c], [d, e, f]] = [self.origin, self.dir];
        let is_finite = 0.0 * a + 0.0 * b + 0.0 * c + (0.0 * d + 0.0 * e + 0.0 * f) == 0.0;
        is_finite && self.t_near >= 0.0 && self.t_far >= self.t_near
    }

    #[inline]
    fn ray(&self) -> rtc::RTCRay {
        rtc::RTCRay {
            org_x: self.origin[0],
            org_y: self.origin[1],
            org_z: self.origin[2],
            tnear: self.t_near,
            dir_x: self.dir[0],
            dir_y: self.dir[1],
            dir_z: self.dir[2],
            time: 0.0,
            tfar: self.t_far,
            mask: u32::MAX,
            id: 0,
            flags: 0,
        }
    }
}

/// The last hit that was accepted, in Embree's precision. `u` and `v` mean nothing for user geometry.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NativeHit {
    pub t: f32,
    pub u: f32,
    pub v: f32,
    pub geometry: GeometryId,
    pub primitive: u32,
    pub instance: Option<GeometryId>,
}

impl<C: Callbacks> Scene<C> {
    /// The nearest hit. Rays that are not finite, or have `t_far < t_near`, meet nothing.
    #[inline]
    pub fn intersect(&self, segment: &Segment, query: &mut C::Query) -> Option<NativeHit> {
        if !segment.is_traceable() {
            return None;
        }
        let mut context = Context::new(query);
        let mut rayhit = rtc::RTCRayHit {
            ray: segment.ray(),
            hit: rtc::RTCHit { geomID: u32::MAX, primID: u32::MAX, instID: [u32::MAX], ..Default::default() },
        };
        // SAFETY: the scene is committed; `rayhit` has Embree's layout and alignment by its generated type; the context is
        // the first member of a `Context<C::Query>`, which is what this scene's callbacks expect; both live for the call.
        unsafe { rtc::rtcIntersect1(self.raw, (&raw mut context).cast(), &mut rayhit) };
        if let Some(panic) = context.panic {
            resume_unwind(panic);
        }
        let hit = &rayhit.hit;
        (hit.geomID != u32::MAX).then(|| NativeHit {
            t: rayhit.ray.tfar,
            u: hit.u,
            v: hit.v,
            geometry: GeometryId(hit.geomID),
            primitive: hit.primID,
            instance: (hit.instID[0] != u32::MAX).then_some(GeometryId(hit.instID[0])),
        })
    }

    /// Whether anything blocks the segment. Rays that are not finite are not blocked.
    #[inline]
    pub fn occluded(&self, segment: &Segment, query: &mut C::Query) -> bool {
        if !segment.is_traceable() {
            return false;
        }
        let mut context = Context::new(query);
        let mut ray = segment.ray();
        // SAFETY: as in `intersect`.
        unsafe { rtc::rtcOccluded1(self.raw, (&raw mut context).cast(), &mut ray) };
        if let Some(panic) = context.panic {
            resume_unwind(panic);
        }
        ray.tfar < 0.0
    }
}
