//! What the caller supplies: user primitives and hit filters, and the functions that Embree calls for them.

use std::any::Any;
use std::ffi::c_void;
use std::panic::{AssertUnwindSafe, catch_unwind};

use crate::bindings as rtc;
use crate::scene::GeometryId;

/// An axis-aligned box; min must not exceed max, both finite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    pub min: [f32; 3],
    pub max: [f32; 3],
}

/// A hit of a native triangle or quad that a filter is asked about.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Candidate {
    pub geometry: GeometryId,
    pub primitive: u32,
    /// The instance's geometry in the outer scene.
    pub instance: Option<GeometryId>,
    pub t: f32,
    pub u: f32,
    pub v: f32,
}

/// What a callback decided.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Step {
    /// No hit here; the traversal goes on as before.
    Miss,
    /// A hit: look no further than this distance. It must not be below the true one and may be a little above it,
    /// so that coincident primitives are still offered.
    Hit(f32),
}

/// User primitives and filters over the caller's query state.
pub trait Callbacks: Send + Sync + 'static {
    /// What travels with a ray.
    type Query;

    /// Bounds of a user primitive. Called from build threads.
    fn bounds(&self, geometry: GeometryId, primitive: u32) -> Bounds;

    /// Intersects a user primitive with the ray that `query` carries. `instance` as in [`Candidate`].
    fn intersect(
        &self,
        query: &mut Self::Query,
        geometry: GeometryId,
        primitive: u32,
        instance: Option<GeometryId>,
    ) -> Step;

    /// Whether a user primitive blocks the ray that `query` carries.
    fn occluded(
        &self,
        query: &mut Self::Query,
        geometry: GeometryId,
        primitive: u32,
        instance: Option<GeometryId>,
    ) -> bool;

    /// Judges a hit of a native geometry that was added with a filter. Accepts it as it is unless overridden.
    fn filter(&self, query: &mut Self::Query, candidate: Candidate) -> Step {
        let _ = query;
        Step::Hit(candidate.t)
    }

    /// The same for occlusion: whether the candidate blocks the ray.
    fn filter_occluded(&self, query: &mut Self::Query, candidate: Candidate) -> bool {
        let _ = (query, candidate);
        true
    }
}

/// The intersection context with the caller's state behind it. Embree sees the first member only.
#[repr(C)]
pub(crate) struct Context<Q> {
    pub(crate) rtc: rtc::RTCIntersectContext,
    pub(crate) query: *mut Q,
    /// A panic that was caught in a callback.
    pub(crate) panic: Option<Box<dyn Any + Send>>,
}

impl<Q> Context<Q> {
    pub(crate) fn new(query: &mut Q) -> Context<Q> {
        let rtc = rtc::RTCIntersectContext {
            flags: rtc::RTCIntersectContextFlags::RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT,
            filter: None,
            instID: [u32::MAX],
        };
        Context { rtc, query, panic: None }
    }

    /// Runs a callback unless one has panicked; a panic is kept and `None` given.
    fn guard<R>(&mut self, body: impl FnOnce(&mut Q, Option<GeometryId>) -> R) -> Option<R> {
        if self.panic.is_some() {
            return None;
        }
        let instance = (self.rtc.instID[0] != u32::MAX).then(|| GeometryId(self.rtc.instID[0]));
        // SAFETY: `query` was made from a `&mut Q` that `Scene::intersect` or `Scene::occluded` holds exclusively for
        // the whole call; Embree calls back on the same thread, one callback at a time.
        let query = unsafe { &mut *self.query };
        match catch_unwind(AssertUnwindSafe(|| body(query, instance))) {
            Ok(result) => Some(result),
            Err(panic) => {
                self.panic = Some(panic);
                None
            }
        }
    }
}

pub(crate) unsafe extern "C" fn bounds<C: Callbacks>(args: *const rtc::RTCBoundsFunctionArguments) {
    // SAFETY: Embree passes valid arguments; the user pointer is the `C` that the scene owns and keeps in place.
    let (args, callbacks) = unsafe { (&*args, &*((*args).geometryUserPtr as *const GeometryData<C>)) };
    let result = catch_unwind(AssertUnwindSafe(|| callbacks.get().bounds(callbacks.id, args.primID)));
    // SAFETY: `bounds_o` points to one `RTCBounds` to be filled.
    let out = unsafe { &mut *args.bounds_o };
    // A panic leaves an inverted box, which Embree takes for an invalid primitive; `commit` then reports the flag.
    let bounds = result.unwrap_or_else(|_| {
        callbacks.panicked.store(true, std::sync::atomic::Ordering::Relaxed);
        Bounds { min: [f32::INFINITY; 3], max: [f32::NEG_INFINITY; 3] }
    });
    [out.lower_x, out.lower_y, out.lower_z] = bounds.min;
    [out.upper_x, out.upper_y, out.upper_z] = bounds.max;
}

pub(crate) unsafe extern "C" fn intersect<C: Callbacks>(args: *const rtc::RTCIntersectFunctionNArguments) {
    // SAFETY: as in `bounds`; the scene is traced with single rays only, so N is 1, `valid` one mask and `rayhit` one
    // `RTCRayHit`; the context is the first member of a `Context<C::Query>` made by `Scene::intersect`.
    let (args, data, context, rayhit) = unsafe {
        let args = &*args;
        let data = &*(args.geometryUserPtr as *const GeometryData<C>);
        (args, data, &mut *(args.context as *mut Context<C::Query>), &mut *(args.rayhit as *mut rtc::RTCRayHit))
    };
    match context.guard(|query, instance| data.get().intersect(query, data.id, args.primID, instance)) {
        Some(Step::Hit(t)) => {
            rayhit.ray.tfar = t;
            rayhit.hit.geomID = data.id.0;
            rayhit.hit.primID = args.primID;
            rayhit.hit.instID = context.rtc.instID;
        }
        Some(Step::Miss) => {}
        None => rayhit.ray.tfar = f32::NEG_INFINITY,
    }
}

pub(crate) unsafe extern "C" fn occluded<C: Callbacks>(args: *const rtc::RTCOccludedFunctionNArguments) {
    // SAFETY: as in `intersect`, with one `RTCRay`.
    let (args, data, context, ray) = unsafe {
        let args = &*args;
        let data = &*(args.geometryUserPtr as *const GeometryData<C>);
        (args, data, &mut *(args.context as *mut Context<C::Query>), &mut *(args.ray as *mut rtc::RTCRay))
    };
    // After a panic the ray is ended as if blocked.
    let blocked = context.guard(|query, instance| data.get().occluded(query, data.id, args.primID, instance));
    if blocked.unwrap_or(true) {
        ray.tfar = f32::NEG_INFINITY;
    }
}

pub(crate) unsafe extern "C" fn filter<C: Callbacks>(args: *const rtc::RTCFilterFunctionNArguments) {
    // SAFETY: as in `intersect`; with N = 1 the ray and the hit have the layouts of `RTCRay` and `RTCHit`.
    let (data, context, ray, hit, valid) = unsafe {
        let args = &*args;
        let data = &*(args.geometryUserPtr as *const GeometryData<C>);
        let context = &mut *(args.context as *mut Context<C::Query>);
        (data, context, &mut *(args.ray as *mut rtc::RTCRay), &*(args.hit as *const rtc::RTCHit), &mut *args.valid)
    };
    let step = context.guard(|query, instance| data.get().filter(query, candidate(data.id, hit, ray.tfar, instance)));
    match step {
        Some(Step::Hit(t)) => ray.tfar = t,
        Some(Step::Miss) => *valid = 0,
        None => ray.tfar = f32::NEG_INFINITY,
    }
}

pub(crate) unsafe extern "C" fn filter_occluded<C: Callbacks>(args: *const rtc::RTCFilterFunctionNArguments) {
    // SAFETY: as in `filter`.
    let (data, context, ray, hit, valid) = unsafe {
        let args = &*args;
        let data = &*(args.geometryUserPtr as *const GeometryData<C>);
        let context = &mut *(args.context as *mut Context<C::Query>);
        (data, context, &*(args.ray as *const rtc::RTCRay), &*(args.hit as *const rtc::RTCHit), &mut *args.valid)
    };
    let blocked =
        context.guard(|query, instance| data.get().filter_occluded(query, candidate(data.id, hit, ray.tfar, instance)));
    if blocked == Some(false) {
        *valid = 0;
    }
}

fn candidate(geometry: GeometryId, hit: &rtc::RTCHit, t: f32, instance: Option<GeometryId>) -> Candidate {
    Candidate { geometry, primitive: hit.primID, instance, t, u: hit.u, v: hit.v }
}

/// What a geometry's user pointer points to; boxed and owned by its scene.
pub(crate) struct GeometryData<C> {
    pub(crate) id: GeometryId,
    pub(crate) callbacks: *const C,
    pub(crate) panicked: std::sync::atomic::AtomicBool,
}

impl<C> GeometryData<C> {
    fn get(&self) -> &C {
        // SAFETY: `callbacks` points into the `Arc<C>` that the scene (builder) holds as long as its geometries.
        unsafe { &*self.callbacks }
    }

    pub(crate) fn user_pointer(&self) -> *mut c_void {
        self as *const GeometryData<C> as *mut c_void
    }
}
